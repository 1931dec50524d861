//! The drawing of the safety case: a tree from left to right.

use std::fmt::Write as _;

use super::page::{Kind, Page, TOP};

const WIDTH: usize = 270;
const GAP: usize = 36;
const LINE: usize = 14;
/// Characters in a line of a box.
const COLUMNS: usize = 44;
const BETWEEN: usize = 8;
const MARGIN: usize = 12;

/// A box that has its place.
struct Placed {
    middle: usize,
    bottom: usize,
}

/// The drawing, as SVG.
pub(crate) fn draw(page: &Page) -> String {
    let mut tree = String::new();
    let mut deepest = 0;
    let placed = place(page, TOP, 0, MARGIN, &mut tree, &mut deepest);
    let width = MARGIN * 2 + (deepest + 1) * (WIDTH + GAP) - GAP;
    let height = placed.bottom + MARGIN;
    format!(
        "<!-- Written by `cargo xtask case` from safety-case.md. -->\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{tree}</svg>\n"
    )
}

/// Draws a node and all below it, from `top` on.
fn place(
    page: &Page,
    id: &str,
    depth: usize,
    top: usize,
    tree: &mut String,
    deepest: &mut usize,
) -> Placed {
    *deepest = depth.max(*deepest);
    let Some(node) = page.nodes.get(id) else { return Placed { middle: top, bottom: top } };
    let (begin, name) = match &node.kind {
        Kind::Test(name) => (format!("{id} test"), name.as_str()),
        Kind::Proof(name) => (format!("{id} proof"), name.as_str()),
        Kind::Run(name) => (format!("{id} run"), name.as_str()),
        _ => (id.to_owned(), ""),
    };
    let says = wrap(&plain(&node.text));
    let named = wrap(name);
    let name_lines = if name.is_empty() { 0 } else { named.len() };
    let own = (1 + says.len() + name_lines) * LINE + 10;

    let mut bottom = top;
    let mut middles = Vec::new();
    for below in &node.below {
        let placed = place(page, below, depth + 1, bottom, tree, deepest);
        middles.push(placed.middle);
        bottom = placed.bottom + BETWEEN;
    }
    bottom = bottom.saturating_sub(BETWEEN).max(top);
    // What is higher than all below it begins at the top.
    let between = match (middles.first(), middles.last()) {
        (Some(first), Some(last)) => usize::midpoint(*first, *last),
        _ => top + own / 2,
    };
    let y = between.saturating_sub(own / 2).max(top);
    let middle = y + own / 2;
    let x = MARGIN + depth * (WIDTH + GAP);
    let (from, to) = (x + WIDTH, x + WIDTH + GAP);
    for end in middles {
        let bend = from + GAP / 2;
        let line = format!("M{from} {middle}H{bend}V{end}H{to}");
        _ = writeln!(tree, "<path d=\"{line}\" fill=\"none\" stroke=\"#888\"/>");
    }
    shape(tree, &node.kind, (x, y), own);
    let mut line_y = y + LINE + 3;
    let mut line = |text: &str, style: &str| {
        let text = escaped(text);
        _ = writeln!(tree, "<text x=\"{}\" y=\"{line_y}\"{style}>{text}</text>", x + 12);
        line_y += LINE;
    };
    line(&begin, " font-weight=\"bold\"");
    says.iter().for_each(|text| line(text, ""));
    named.iter().take(name_lines).for_each(|text| line(text, " fill=\"#555\" font-size=\"10\""));
    Placed { middle, bottom: bottom.max(y + own) }
}

/// The outline of a box, by what it is.
fn shape(tree: &mut String, kind: &Kind, (x, y): (usize, usize), height: usize) {
    let (fill, round, dashes) = match kind {
        Kind::Goal => ("#eef", 0, ""),
        Kind::Strategy => ("#fff", 0, ""),
        Kind::Test(_) => ("#efe", 14, ""),
        Kind::Proof(_) => ("#cfc", 14, ""),
        Kind::Run(_) => ("#dfd", 14, ""),
        Kind::Assumption => ("#fe9", 14, " stroke-dasharray=\"5 3\""),
        Kind::Context => ("#eee", 6, ""),
    };
    let style = format!("fill=\"{fill}\" stroke=\"black\"{dashes}");
    if *kind == Kind::Strategy {
        let (right, bottom) = (x + WIDTH, y + height);
        let corners = format!("{},{y} {right},{y} {},{bottom} {x},{bottom}", x + 10, right - 10);
        _ = writeln!(tree, "<polygon points=\"{corners}\" {style}/>");
        return;
    }
    let place = format!("x=\"{x}\" y=\"{y}\" width=\"{WIDTH}\" height=\"{height}\"");
    _ = writeln!(tree, "<rect {place} rx=\"{round}\" {style}/>");
}

/// The first sentence, without marks.
fn plain(text: &str) -> String {
    let first = text.split_once(". ").map_or(text, |(first, _)| first);
    first.trim_end_matches('.').replace(['`', '*', '[', ']'], "")
}

/// Lines of a text, broken where names can be, too.
fn wrap(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for part in text.split_inclusive([' ', '_', ':', '/']) {
        let length = |line: &String| line.chars().count();
        if let Some(last) = lines.last_mut() {
            if length(last) + part.trim_end().chars().count() <= COLUMNS {
                last.push_str(part);
            } else {
                lines.push(part.to_owned());
            }
        }
    }
    lines
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
