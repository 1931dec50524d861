//! Measures what is promised of the system, and compares it with what was recorded last: `docs/figures.json`.

mod cadence;
mod counted;
mod measure;
mod page;
mod programs;
mod record;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::ValueEnum;

use self::record::{Figures, History, Record};
use crate::files::{FileError, root, write};

/// What to measure.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Keep what was measured as the latest record, and write the page anew
    #[arg(long)]
    record: bool,
    /// Measure only these parts
    #[arg(long, value_name = "PARTS", value_enum, value_delimiter = ',')]
    only: Vec<Part>,
    /// Count the tests in this output of `cargo test --workspace`, instead of running them
    #[arg(long, value_name = "LOG")]
    tests: Option<PathBuf>,
    /// Count the proofs in this output of `cargo xtask verify`, instead of proving
    #[arg(long, value_name = "LOG")]
    proofs: Option<PathBuf>,
    /// Write what was measured to this file, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Measure nothing, and write page and drawing anew from the records
    #[arg(long, conflicts_with_all = ["record", "only", "tests", "proofs", "json"])]
    draw: bool,
    /// Do the work whose instructions are counted; run under valgrind
    #[arg(long, hide = true)]
    work: bool,
}

/// What is measured together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Part {
    /// Plans in simulated time
    Flights,
    /// Positions held over tags
    Tags,
    /// Instructions of a tick, of decoding and of translating
    Instructions,
    /// How regular commands are, in real time
    Cadence,
    /// The shipped agent on a Cortex-M4
    Agent,
    /// What is proved of it
    Proofs,
    /// Crates and lines
    Code,
    /// The first build, from nothing: takes minutes
    Build,
    /// How many tests there are
    Tests,
}

/// Which way is a loss.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Loss {
    /// More is worse.
    More,
    /// Less is worse.
    Less,
    /// It depends on the machine, or on what was built: it is shown, and not judged.
    NotJudged,
}

/// What a figure measures.
#[derive(Debug)]
struct Kind {
    part: Part,
    name: &'static str,
    unit: &'static str,
    loss: Loss,
    /// A difference up to this share of the recorded value plus `noise` is none.
    share: f64,
    noise: f64,
}

const fn kind(part: Part, name: &'static str, unit: &'static str, loss: Loss) -> Kind {
    // Simulated flights are the same on each machine, but for the last digits of its mathematical functions.
    Kind { part, name, unit, loss, share: 0.02, noise: 0.0 }
}

const METRES: f64 = 0.001;

#[rustfmt::skip]
static KINDS: &[Kind] = &[
    kind(Part::Flights, "plans completed", "%", Loss::Less),
    kind(Part::Flights, "time between the stays", "s", Loss::More),
    Kind { noise: METRES, ..kind(Part::Flights, "overshoot, mean", "m", Loss::More) },
    Kind { noise: METRES, ..kind(Part::Flights, "distance in the late part of stays, rms", "m", Loss::More) },
    kind(Part::Tags, "flights over tags that end as meant", "%", Loss::Less),
    Kind { noise: METRES, ..kind(Part::Tags, "distance from the target over tags, rms", "m", Loss::More) },
    Kind { noise: METRES, ..kind(Part::Tags, "error of the estimate over tags, rms", "m", Loss::More) },
    Kind { noise: METRES, ..kind(Part::Tags, "distance of a landing from its tag, worst", "m", Loss::More) },
    // Other flags of the compiler cut crates elsewhere, which moved the count of a function by 8 %.
    Kind { share: 0.10, ..kind(Part::Instructions, "instructions", "", Loss::More) },
    kind(Part::Cadence, "lateness of ticks, 99 of 100", "ms", Loss::NotJudged),
    kind(Part::Cadence, "ticks skipped", "", Loss::NotJudged),
    // Without a real-time priority, beside other programs, a thread that works is later than one that only sleeps: up to 6.9 ms
    // were seen.
    Kind { noise: 7.4, ..kind(Part::Cadence, "lateness of ticks beyond the machine's", "ms", Loss::More) },
    Kind { noise: 3.0, ..kind(Part::Cadence, "ticks skipped beyond the machine's", "", Loss::More) },
    Kind { share: 0.05, ..kind(Part::Agent, "code on a Cortex-M4", "bytes", Loss::More) },
    kind(Part::Agent, "state", "bytes", Loss::More),
    Kind { share: 0.05, ..kind(Part::Agent, "stack of a step", "bytes", Loss::More) },
    Kind { share: 0.05, ..kind(Part::Agent, "longest path of a step", "instructions", Loss::More) },
    kind(Part::Agent, "lines of C", "", Loss::More),
    Kind { share: 0.0, ..kind(Part::Proofs, "proved on the C", "", Loss::Less) },
    Kind { share: 0.0, ..kind(Part::Proofs, "hold of the model", "", Loss::Less) },
    kind(Part::Code, "crates of ardrone-pilot", "", Loss::More),
    kind(Part::Code, "lines of Rust", "", Loss::NotJudged),
    kind(Part::Code, "lines of tests", "", Loss::NotJudged),
    kind(Part::Code, "lines of pages", "", Loss::NotJudged),
    Kind { share: 0.10, ..kind(Part::Build, "first build, times the work of a reference", "", Loss::More) },
    kind(Part::Build, "first build, by the clock", "s", Loss::NotJudged),
    Kind { share: 0.0, ..kind(Part::Tests, "tests passed", "", Loss::Less) },
];

/// Why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub(crate) enum FiguresError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{}: {source}", path.display())]
    Json { path: PathBuf, source: serde_json::Error },
    #[error("{program} cannot be run: {source}")]
    Run { program: String, source: std::io::Error },
    #[error("{program} failed: {said}")]
    Failed { program: String, said: String },
}

const HISTORY: &str = "docs/figures.json";
const PAGE: &str = "docs/figures.md";
const DRAWING: &str = "docs/figures.svg";

/// Measures, compares, and records if that is wanted. Returns what to print, and whether nothing was lost.
pub(crate) fn run(arguments: &Arguments) -> Result<(String, bool), Box<dyn std::error::Error>> {
    if arguments.work {
        counted::work()?;
        return Ok((String::new(), true));
    }
    let path = root().join(HISTORY);
    if arguments.draw {
        draw(&History::read(&path)?)?;
        return Ok((String::new(), true));
    }
    let parts: &[Part] =
        if arguments.only.is_empty() { Part::value_variants() } else { &arguments.only };
    let mut figures = Figures::default();
    for part in parts {
        measure::measure(*part, arguments, &mut figures)?;
    }
    let mut record = Record::new(figures);
    if let Some(path) = &arguments.json {
        write(path, &record.json())?;
    }
    let mut history = History::read(&path)?;
    // Without a record everything is one that nobody knows of.
    let last = history.last().cloned().unwrap_or_else(|| Record::new(Figures::default()));
    let (mut text, lost) = record.against(&last, parts);
    if arguments.record {
        record.keep_of(&last, parts);
        history.push(record);
        write(&path, &history.json())?;
        draw(&history)?;
        _ = writeln!(text, "recorded in {HISTORY}");
    }
    Ok((text, arguments.record || !lost))
}

/// Writes page and drawing.
fn draw(history: &History) -> Result<(), FiguresError> {
    write(&root().join(PAGE), &page::page(history))?;
    Ok(write(&root().join(DRAWING), &page::drawing(history))?)
}
