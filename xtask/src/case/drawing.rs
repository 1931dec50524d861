//! The drawing of the safety case: a tree from left to right.

use std::fmt::Write as _;

use super::page::{Kind, Nodes, TOP};

const WIDTH: usize = 270;
const GAP: usize = 36;
const LINE: usize = 14;
const BETWEEN: usize = 8;
const MARGIN: usize = 12;
/// Characters in a line of a box.
const COLUMNS: usize = 42;

/// The drawing, as SVG.
pub(crate) fn draw(nodes: &Nodes) -> String {
    let mut tree = String::new();
    let (_, [right, bottom]) = place(nodes, TOP, [MARGIN, MARGIN], &mut tree);
    let [width, height] = [right + MARGIN, bottom + MARGIN];
    format!(
        "<!-- Written by `cargo xtask case` from safety-case.md. -->\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{tree}</svg>\n"
    )
}

/// Draws a node and all below it from a corner on; returns where its middle is, and the other corner of all.
fn place(nodes: &Nodes, id: &str, [x, top]: [usize; 2], tree: &mut String) -> (usize, [usize; 2]) {
    let Some(node) = nodes.get(id) else { return (top, [x, top]) };
    let (kind, name) = match &node.kind {
        Kind::Test(name) => (" test", name.as_str()),
        Kind::Proof(name) => (" proof", name.as_str()),
        Kind::Run(name) => (" run", name.as_str()),
        _ => ("", ""),
    };
    // What an experiment would be is on the page.
    let says = plain(node.text.split(" *Experiment:*").next().unwrap_or_default());
    let mut lines = vec![(format!("{id}{kind}"), " font-weight=\"bold\"")];
    lines.extend(wrap(&says).into_iter().map(|line| (line, "")));
    lines.extend(wrap(name).into_iter().map(|line| (line, " fill=\"#555\" font-size=\"10\"")));
    let own = lines.len() * LINE + 10;

    let [mut right, mut bottom] = [x + WIDTH, top];
    let mut middles = Vec::new();
    for below in &node.below {
        let (middle, corner) = place(nodes, below, [x + WIDTH + GAP, bottom], tree);
        middles.push(middle);
        right = right.max(corner[0]);
        bottom = corner[1] + BETWEEN;
    }
    let between = middles.first().zip(middles.last()).map(|(a, b)| usize::midpoint(*a, *b));
    let y = between.unwrap_or_default().saturating_sub(own / 2).max(top);
    let middle = y + own / 2;
    for end in middles {
        let (from, bend, to) = (x + WIDTH, x + WIDTH + GAP / 2, x + WIDTH + GAP);
        let line = format!("M{from} {middle}H{bend}V{end}H{to}");
        _ = writeln!(tree, "<path d=\"{line}\" fill=\"none\" stroke=\"#888\"/>");
    }
    let (fill, round, more) = match node.kind {
        Kind::Goal => ("#e8eeff", 0, ""),
        // A parallelogram.
        Kind::Strategy => (
            "#fff",
            0,
            " transform=\"skewX(-8)\" transform-origin=\"center\" style=\"transform-box:fill-box\"",
        ),
        Kind::Context => ("#eee", 6, ""),
        Kind::Assumption => ("#ffe98a", 14, " stroke-dasharray=\"5 3\""),
        Kind::Test(_) | Kind::Run(_) => ("#eaffea", 14, ""),
        Kind::Proof(_) => ("#b9f0b9", 14, ""),
    };
    let outline = format!("x=\"{x}\" y=\"{y}\" width=\"{WIDTH}\" height=\"{own}\" rx=\"{round}\"");
    _ = writeln!(tree, "<rect {outline} fill=\"{fill}\" stroke=\"black\"{more}/>");
    for (number, (line, style)) in (1..).zip(&lines) {
        let text = line.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let (x, y) = (x + 12, y + number * LINE + 3);
        _ = writeln!(tree, "<text x=\"{x}\" y=\"{y}\"{style}>{text}</text>");
    }
    (middle, [right, bottom.saturating_sub(BETWEEN).max(y + own)])
}

/// A text without marks, and of links the words only.
fn plain(text: &str) -> String {
    let mut parts = text.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    let rest = parts.filter_map(|part| part.split_once(')')).map(|(_, rest)| rest);
    rest.fold(first, |plain, rest| plain + rest).replace(['`', '*', '['], "")
}

/// Lines of a text, which is broken where names can be, too.
fn wrap(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in text.split_inclusive([' ', '_', ':', '/']) {
        match lines.last_mut() {
            Some(last) if last.len() + part.trim_end().len() <= COLUMNS => last.push_str(part),
            _ => lines.push(part.to_owned()),
        }
    }
    lines
}
