//! Whether each piece of evidence against the sensors is needed: the pilot without one of them, flown with failing sensors,
//! with healthy ones, and where a single rule keeps the drone safe.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::workspace::Workspace;
use super::{MutantsError, cargo, chosen};
use crate::compare::{self, Change, Line};
use crate::edit::{Mutant, edit};
use crate::files::cannot;

const ESTIMATOR: &str = "estimator/src/lib.rs";
const BELIEF: &str = "estimator/src/belief.rs";
const REPETITION: &str = "estimator/src/repetition.rs";
const RESPONSE: &str = "estimator/src/response.rs";
const HEADING: &str = "estimator/src/heading.rs";
const VERTICAL: &str = "estimator/src/vertical.rs";

/// A piece of evidence, and the edit that switches it off.
type Evidence = Mutant<()>;

const fn without(
    name: &'static str,
    file: &'static str,
    from: &'static str,
    to: &'static str,
) -> Evidence {
    Mutant { name, first: edit(file, from, to), more: &[], expected: () }
}

/// All pieces of evidence.
const EVIDENCE: &[Evidence] = &[
    without(
        "a value that repeats itself",
        REPETITION,
        "if lasts && !may_rest(quantity) {",
        "if lasts && at_s < f64::MIN {",
    ),
    without(
        "a value that stops again and again",
        BELIEF,
        "ENOUGH_S * f64::from(u8::from(begins))",
        "0.0 * ENOUGH_S * f64::from(u8::from(begins))",
    ),
    without(
        "an impossible value",
        ESTIMATOR,
        "&[Some(against(Cause::Value)(quantity))]",
        "&[Some(against(Cause::Value)(quantity)).filter(|_| lateness_s < f64::MIN)]",
    ),
    without(
        "a velocity that jumps",
        ESTIMATOR,
        "let believed = judged != Judged::Rejected;",
        "let believed = judged != Judged::Rejected || step_s >= 0.0;",
    ),
    without(
        "orders that were not heard explain a velocity",
        ESTIMATOR,
        "unheard_m_s: &unheard }",
        "unheard_m_s: &unheard[..0] }",
    ),
    without(
        "a heading that steps",
        HEADING,
        "let stepped = surprise_deg > MAX_SURPRISE_DEG ",
        "let stepped = surprise_deg > MAX_SURPRISE_DEG.max(f64::MAX) ",
    ),
    without(
        "an unlikely echo",
        VERTICAL,
        "if is_close && !self.agreeing.is_nearer_to(surprise_m) {",
        "if is_close || surprise_m.is_finite() {",
    ),
    without(
        "steps of heading and floor that come too often",
        BELIEF,
        "Self::Step => STEP_S,",
        "Self::Step => 0.0 * STEP_S,",
    ),
    without(
        "noise",
        ESTIMATOR,
        "self.watch_noise(made_s, sample).map(",
        "self.watch_noise(made_s, sample).filter(|_| made_s < f64::MIN).map(",
    ),
    without(
        "a dead velocity",
        RESPONSE,
        "if self.axes.iter().any(Axis::is_dead) {",
        "if self.axes.iter().any(Axis::is_dead) && step_s < f64::MIN {",
    ),
    without(
        "the response of the climb",
        RESPONSE,
        "} else if self.climb.is_missing() {",
        "} else if self.climb.is_missing() && step_s < f64::MIN {",
    ),
    without(
        "the response of the turn",
        RESPONSE,
        "} else if self.turn.is_missing() {",
        "} else if self.turn.is_missing() && step_s < f64::MIN {",
    ),
    without(
        "an altitude of the floor in flight",
        ESTIMATOR,
        "by_sticks && sample.altitude_m < ON_FLOOR_M;",
        "by_sticks && sample.altitude_m + ON_FLOOR_M < f64::MIN;",
    ),
    without(
        "lateness",
        ESTIMATOR,
        "let is_news = lateness_s <= GAP_S;",
        "let is_news = lateness_s <= GAP_S.max(f64::MAX);",
    ),
    without(
        "what the drone reports of its sensors",
        ESTIMATOR,
        "sample.reported_lost.filter(|_| sample.airborne)",
        "sample.reported_lost.filter(|_| sample.airborne && arrival_s < f64::MIN)",
    ),
];

/// How much is flown with each variant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flights {
    /// Seeds of each failure in each situation on each airframe.
    pub(crate) seeds: u64,
    /// Random failures.
    pub(crate) random: u64,
    /// Healthy flights.
    pub(crate) healthy: u64,
}

/// What came of a variant's flights.
#[derive(Debug)]
struct Flown {
    /// With failing sensors.
    lines: Vec<Line>,
    /// How many healthy ones were landed without need.
    landed: u64,
    /// How many did not end as they must where a single rule keeps the drone safe.
    broken: u64,
}

impl Flown {
    /// Whether it is worse than another: more were led too far, more healthy ones landed, or more rules broken.
    fn is_worse_than(&self, other: &Self) -> bool {
        Change::of_judged(&other.lines, &self.lines).led_further()
            || self.landed > other.landed
            || self.broken > other.broken
    }
}

/// Flies the pilot as it is, and without each piece of evidence that has `only` in its name. The second value is whether
/// each is missed.
pub(crate) fn run(flights: Flights, only: Option<&str>) -> Result<(String, bool), MutantsError> {
    let (evidence, workspace) = chosen(EVIDENCE.iter(), only)?;
    let with_all = flown(&workspace, "the code as it is", flights)?;
    let mut text = format!(
        "{:<50}{:>9}{:>8}{:>8}{:>10}{:>11}{:>9}{:>8}  most in\n{:<50}{:>9}{:>8}{:>8}{:>10}{:>11}{:>9}{:>8}\n",
        "without",
        "too far",
        "newly",
        "no",
        "noticed",
        "reaction",
        "healthy",
        "rules", //
        "",
        "",
        "",
        "longer",
        "",
        "median, s",
        "landed",
        "broken",
    );
    text += &row("(nothing)", &with_all, &with_all);
    print(&text);
    let mut is_each_missed = true;
    for evidence in evidence {
        let changed = workspace.changed(evidence)?;
        workspace.put(&changed)?;
        let without_it = flown(&workspace, evidence.name, flights);
        workspace.restore(&changed)?;
        let line = match without_it {
            Ok(without_it) => {
                let is_missed = without_it.is_worse_than(&with_all);
                is_each_missed &= is_missed;
                let line = row(evidence.name, &with_all, &without_it);
                if is_missed { line } else { format!("{}  NOT MISSED\n", line.trim_end()) }
            }
            // Without its flights nothing is known of it.
            Err(MutantsError::BreaksOff { what, .. }) => {
                is_each_missed = false;
                format!("{:<50}BREAKS OFF: {what}\n", evidence.name)
            }
            Err(error) => return Err(error),
        };
        print(&line);
        text += &line;
    }
    Ok((text, is_each_missed))
}

/// Prints at once, because the whole run takes a while.
fn print(text: &str) {
    _ = io::Write::write_all(&mut io::stderr(), text.as_bytes());
}

fn row(name: &str, with_all: &Flown, without_it: &Flown) -> String {
    let change = Change::of_judged(&with_all.lines, &without_it.lines);
    let most = compare::most_newly_too_far(&with_all.lines, &without_it.lines);
    let mut text = format!("{name:<50}{}", change.after());
    _ = write!(text, "{:>9}{:>8}  {most}", without_it.landed, without_it.broken);
    text.truncate(text.trim_end().len());
    text + "\n"
}

/// Builds the workspace's copy and flies with it.
fn flown(workspace: &Workspace, name: &str, flights: Flights) -> Result<Flown, MutantsError> {
    let built = cargo(workspace.root())
        .args(["build", "--release", "--locked", "--quiet", "-p", "xtask"])
        .env("CARGO_TARGET_DIR", workspace.target())
        // Debug information would only slow the build.
        .env("CARGO_PROFILE_RELEASE_DEBUG", "false")
        .output()
        .map_err(cannot("run", Path::new("cargo")))?;
    if !built.status.success() {
        let text = String::from_utf8_lossy(&built.stderr).into_owned();
        return Err(MutantsError::Build { name: name.to_owned(), text });
    }
    let xtask = workspace.target().join("release/xtask");
    let run = |arguments: &[String]| {
        let output = Command::new(&xtask).args(arguments).output();
        let output = output.map_err(cannot("run", &xtask))?;
        // 1 only says that something was found.
        if matches!(output.status.code(), Some(0 | 1)) {
            return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
        }
        let what = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        Err(MutantsError::BreaksOff { name: name.to_owned(), what })
    };
    let csv: PathBuf = workspace.target().join("ablation.csv");
    let [seeds, random, healthy] =
        [flights.seeds, flights.random, flights.healthy].map(|number| number.to_string());
    let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>();
    let mut failing = words(&["sensors", "--seeds", &seeds, "--random", &random, "--csv"]);
    failing.push(csv.display().to_string());
    run(&failing)?;
    let breaks_off = |what: String| MutantsError::BreaksOff { name: name.to_owned(), what };
    let lines = compare::read(&csv).map_err(|error| breaks_off(error.to_string()))?;
    let report = run(&words(&["healthy", "--flights", &healthy]))?;
    let landed = counted(&report, "landed without need");
    let landed = landed.ok_or_else(|| breaks_off("no healthy flights".to_owned()))?;
    let broken = counted(&run(&words(&["rules"]))?, "did not end as they must");
    let broken = broken.ok_or_else(|| breaks_off("no flights for the rules".to_owned()))?;
    Ok(Flown { lines, landed, broken })
}

/// The number at the beginning of the line of a report that ends with `what`.
fn counted(report: &str, what: &str) -> Option<u64> {
    let line = report.lines().rev().find(|line| line.ends_with(what))?;
    line.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_piece_of_evidence_can_be_switched_off() {
        let workspace = Workspace::here(Path::new(".."));
        for evidence in EVIDENCE {
            let changed = workspace.changed(evidence).unwrap_or_else(|error| panic!("{error}"));
            for (file, text) in changed {
                assert_ne!(text, std::fs::read_to_string(Path::new("..").join(file)).unwrap());
            }
        }
    }

    #[test]
    fn what_a_report_counts_is_at_the_beginning_of_its_line() {
        let report = "a\n\n12 of 300 landed without need\ndone in 1 s\n";
        assert_eq!(counted(report, "landed without need"), Some(12));
        assert_eq!(counted(report, "must"), None);
    }

    #[test]
    fn evidence_is_missed_if_failures_lead_further_or_more_is_landed_or_broken() {
        let flown = |too_far: bool, landed: u64, broken: u64| {
            let line = Line { too_far, judged: true, ..Line::default() };
            Flown { lines: vec![line], landed, broken }
        };
        let with_all = flown(false, 5, 1);
        for (without_it, is_missed) in [
            (flown(false, 5, 1), false),
            (flown(false, 4, 0), false),
            (flown(true, 5, 1), true),
            (flown(false, 6, 1), true),
            (flown(false, 5, 2), true),
        ] {
            assert_eq!(without_it.is_worse_than(&with_all), is_missed, "{without_it:?}");
        }
    }
}
