//! The page of the figures, `docs/figures.md`, and the drawing of their history.

use std::fmt::Write as _;

use super::record::{History, Record, split};
use super::{KINDS, Kind, Loss};

/// The page, as Markdown.
pub(super) fn page(history: &History) -> String {
    let mut text = String::from(INTRODUCTION);
    let Some(last) = history.last() else { return text };
    _ = writeln!(text, "## Of version {}\n", last.version);
    text += "| what | of | value | a loss is |\n|---|---|---|---|\n";
    for kind in KINDS {
        for (key, value) in &last.figures.0 {
            let Some((of_kind, of)) = split(key) else { continue };
            if !std::ptr::eq(kind, of_kind) {
                continue;
            }
            let unit = kind.unit;
            let noise = kind.noise_of(*value);
            let loss = match kind.loss {
                Loss::NotJudged => "not judged".to_owned(),
                Loss::More => format!("more than {}", short(value + noise)),
                Loss::Less => format!("less than {}", short(value - noise)),
            };
            _ = writeln!(text, "| {} | {of} | {value} {unit} | {loss} |", kind.name);
        }
    }
    text
}

/// Few digits, for people.
fn short(value: f64) -> String {
    let digits = if value.abs() < 10.0 { 3 } else { 1 };
    format!("{value:.digits$}")
}

const PANEL: [usize; 2] = [300, 130];
const COLUMNS: usize = 3;
const MARGIN: usize = 14;
const COLOURS: [&str; 6] = ["#195faa", "#c4512d", "#2f8f4e", "#8a5bb5", "#a08215", "#4f4f4f"];

/// A small drawing for each kind that was recorded more than once, with a line for each figure: its values over the records, as shares of the latest one.
pub(super) fn drawing(history: &History) -> String {
    let [width, height] = PANEL;
    let kinds: Vec<&Kind> = KINDS.iter().filter(|kind| changes(history, kind)).collect();
    let rows = kinds.len().div_ceil(COLUMNS);
    let (all_width, all_height) = (COLUMNS * width + MARGIN, rows * height + MARGIN + 20);
    let mut panels = String::new();
    for (number, kind) in kinds.into_iter().enumerate() {
        let corner = [MARGIN + number % COLUMNS * width, MARGIN + 20 + number / COLUMNS * height];
        panel(history, kind, corner, &mut panels);
    }
    let versions: Vec<String> = history.0.iter().map(Record::name).collect();
    format!(
        "<!-- Written by `cargo xtask figures` from figures.json. -->\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{all_width}\" height=\"{all_height}\" \
         viewBox=\"0 0 {all_width} {all_height}\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{MARGIN}\" y=\"20\">Each as a share of its latest value. From left to right: {}</text>\n{panels}</svg>\n",
        versions.join(", ")
    )
}

/// Whether a figure was recorded more than once.
fn changes(history: &History, kind: &Kind) -> bool {
    let measures = |key: &String| split(key).is_some_and(|(of, _)| std::ptr::eq(of, kind));
    history.0.iter().filter(|record| record.figures.0.keys().any(measures)).count() > 1
}

fn panel(history: &History, kind: &Kind, [x, y]: [usize; 2], panels: &mut String) {
    let Some(last) = history.last() else { return };
    let is_of_kind = |key: &str| split(key).is_some_and(|(of, _)| std::ptr::eq(of, kind));
    let lines: Vec<Vec<(usize, f64)>> = last
        .figures
        .0
        .iter()
        .filter(|(key, _)| is_of_kind(key))
        .map(|(key, latest)| {
            let values = history.0.iter().map(|record| record.figures.0.get(key));
            let shares = values.enumerate().filter_map(|(at, value)| {
                let value = value?;
                Some((at, if *latest == 0.0 { 1.0 } else { value / latest }))
            });
            shares.collect()
        })
        .collect();
    let shares = || lines.iter().flatten().map(|(_, share)| *share);
    let (low, high) = (shares().fold(0.9, f64::min), shares().fold(1.1, f64::max));
    let (width, height) = ((PANEL[0] - 5 * MARGIN) as f64, (PANEL[1] - 40) as f64);
    let (left, top) = ((x + 2 * MARGIN) as f64, y as f64 + 18.0);
    let y_of = |share: f64| top + height * (high - share) / (high - low);
    _ = writeln!(panels, "<text x=\"{x}\" y=\"{}\">{}</text>", y + 11, kind.name);
    for share in [low, 1.0, high] {
        let y = y_of(share);
        _ = writeln!(
            panels,
            "<path d=\"M{left} {y:.1}h{width}\" stroke=\"#ccc\"/><text x=\"{}\" y=\"{:.1}\" \
             text-anchor=\"end\" fill=\"#666\" font-size=\"9\">{share:.2}</text>",
            left - 4.0,
            y + 3.0
        );
    }
    let steps = history.0.len().saturating_sub(1).max(1) as f64;
    for (line, colour) in lines.iter().zip(COLOURS.iter().cycle()) {
        let points: Vec<(f64, f64)> = line
            .iter()
            .map(|(at, share)| (left + width * *at as f64 / steps, y_of(*share)))
            .collect();
        let path: Vec<String> = points.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
        _ = writeln!(
            panels,
            "<path d=\"M{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.5\"/>",
            path.join("L")
        );
        for (x, y) in points {
            _ = writeln!(panels, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\" fill=\"{colour}\"/>");
        }
    }
}

const INTRODUCTION: &str = "\
# Figures

`cargo xtask figures` measures what is promised of the system, and compares it with [the last record](figures.json); it fails
if anything was lost. Continuous integration runs it for every change, but for the first build, which takes minutes and is measured for a
release. A loss that is meant is recorded with the change that causes it (`cargo xtask figures --record`), and seen in its difference; so is a
gain, which is told, so that it is not lost again unseen. What is worse by noise alone keeps its recorded value: small losses, each
recorded for the next one to be compared with, would add up unseen.

What is a loss depends on how much a figure varies where nothing has changed. Flights are simulated: they are the same each time. Instructions are
counted (by valgrind, of a development build without incremental files), and are the same on each machine, up to the compiler's version. Of what depends on the
machine, the first build is divided by the work of a reference that is compiled beside it, and the lateness of ticks is judged by how much it exceeds that of
a thread beside it that only sleeps, the least of up to three flights; the rest is shown, and not judged. What is recorded and not
measured, or measured and not recorded, is a loss.

![The history of all figures, one small drawing for each](figures.svg)

";
