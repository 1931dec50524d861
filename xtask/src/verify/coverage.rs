//! Coverage of the agent by the simulated test flights: gcov measures the C, and the trace matrix leads back
//! to plans and requirements.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::Command;

use asl2c::{Counts, Share};
use serde::Deserialize;

use super::VerifyError;
use super::mutants::C;
use crate::files::{self, cannot, target_folder};

/// Test filters: flights in simulated time, and the agent's own tests.
const TESTS: [&str; 5] = ["agent::", "simulated::", "safety::", "faults::", "estimate::"];

/// Set where the agent's C counts what it executes.
const COUNTS: &str = "AGENT_COVERAGE";

/// The programs with counters are built here: they must not take the place of those without.
const BUILT: &str = "coverage";

/// Which lines of the C implement which plan.
const TRACE: &str = "trace.json";

/// Locked by `.ci/run` until its tests have counted.
const LOCK: &str = "coverage.lock";

/// Coverage of one plan.
#[derive(Debug, Clone)]
pub(super) struct PlanCoverage {
    /// Its first line in the agent.
    pub(super) line: usize,
    /// Its triggering event.
    pub(super) trigger: String,
    /// Its label, if it has one.
    pub(super) label: String,
    /// Requirements that it implements.
    pub(super) requirements: Vec<String>,
    /// How often it was chosen.
    pub(super) chosen: u64,
    /// Covered outcomes of its conditions: each can be true and false.
    pub(super) outcomes: Share,
}

/// Coverage of the agent.
#[derive(Debug, Clone)]
pub(super) struct Coverage {
    /// Each plan, in the order of the source.
    pub(super) plans: Vec<PlanCoverage>,
    /// Covered outcomes of all conditions of the C, including those of the deliberation cycle.
    pub(super) outcomes: Share,
    /// Covered lines of the C.
    pub(super) lines: Share,
}

impl Coverage {
    /// Share of plans that were chosen.
    pub(super) fn chosen(&self) -> Share {
        let mut share = Share::default();
        self.plans.iter().for_each(|plan| share.count(plan.chosen > 0));
        share
    }

    /// By requirement: share of its plans that were chosen, and of the outcomes of their conditions.
    pub(super) fn by_requirement(&self) -> BTreeMap<&str, (Share, Share)> {
        let mut shares: BTreeMap<&str, (Share, Share)> = BTreeMap::new();
        for plan in &self.plans {
            for requirement in &plan.requirements {
                let (chosen, outcomes) = shares.entry(requirement).or_default();
                chosen.count(plan.chosen > 0);
                outcomes.add(plan.outcomes);
            }
        }
        shares
    }
}

/// Builds with counters, and runs, the tests that are meant to exercise the agent.
pub(super) fn measure() -> Result<Coverage, VerifyError> {
    let built = target_folder(BUILT);
    for path in agents(&built)?.iter().flat_map(|agent| &agent.counts) {
        std::fs::remove_file(path).map_err(cannot("remove", path))?;
    }
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut tests = Command::new(&cargo);
    // Of the whole workspace: of two packages alone, dependencies have other features, and would be built again.
    tests.args(["test", "--locked", "--quiet", "--workspace", "--lib", "--test", "system", "--"]);
    tests.args(TESTS);
    tests.env(COUNTS, "1").env("CARGO_TARGET_DIR", &built);
    let output = tests.output();
    let output = output.map_err(cannot("run", Path::new(&cargo)))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        return Err(VerifyError::Tool { tool: "cargo test", output: text });
    }
    read(&built)
}

/// What tests have counted that somebody else builds, in this target folder, and runs, and who holds the lock so long.
pub(super) fn counted(built: &Path) -> Result<Coverage, VerifyError> {
    let lock = target_folder(LOCK);
    let done = File::create(&lock).map_err(cannot("make", &lock))?;
    done.lock().map_err(cannot("wait for", &lock))?;
    read(built)
}

/// The agent's C as one of its builds left it: cargo builds it once for each set of features.
struct Built {
    folder: PathBuf,
    /// Files of its counters; there are none if none of its programs ran.
    counts: Vec<PathBuf>,
}

/// The builds of the agent in a target folder.
fn agents(built: &Path) -> Result<Vec<Built>, VerifyError> {
    let builds = built.join("debug/build");
    if !builds.exists() {
        return Ok(Vec::new());
    }
    let folders = listed(&builds)?.into_iter().map(|build| build.join("out"));
    let folders = folders.filter(|folder| folder.join(TRACE).exists() && folder.join(C).exists());
    folders
        .map(|folder| {
            let mut counts = listed(&folder)?;
            counts.retain(|path| path.extension().is_some_and(|extension| extension == "gcda"));
            Ok(Built { folder, counts })
        })
        .collect()
}

fn listed(folder: &Path) -> Result<Vec<PathBuf>, VerifyError> {
    let entries = std::fs::read_dir(folder).map_err(cannot("read", folder))?;
    Ok(entries.filter_map(Result::ok).map(|entry| entry.path()).collect())
}

/// The coverage by all programs that ran. Counts that do not belong to the C beside them are an error: of those gcov only
/// complains, and prints none.
fn read(built: &Path) -> Result<Coverage, VerifyError> {
    let mut whole: Option<(Counts, PathBuf)> = None;
    for agent in agents(built)?.into_iter().filter(|agent| !agent.counts.is_empty()) {
        let mut gcov = Command::new("gcov");
        let output =
            gcov.args(Counts::OPTIONS).args(&agent.counts).current_dir(&agent.folder).output();
        let output = output.map_err(cannot("run", Path::new("gcov")))?;
        let counts =
            Counts::parse(&String::from_utf8_lossy(&output.stdout), C).map_err(odd("gcov"))?;
        let is_the_same = whole.as_ref().is_none_or(|(others, _)| counts.is_of_the_same(others));
        if !counts.lines.iter().any(|line| line.count > 0) || !is_the_same {
            let output = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(VerifyError::Tool { tool: "gcov", output });
        }
        match &mut whole {
            Some((others, _)) => others.add(&counts),
            None => whole = Some((counts, agent.folder)),
        }
    }
    let Some((counts, folder)) = whole else {
        let output = format!("no test has counted what the agent executes, in {}", built.display());
        return Err(VerifyError::Tool { tool: "cargo test", output });
    };
    let read = |name: &str| files::read(&folder.join(name));
    let rows: Vec<Row> = serde_json::from_str(&read(TRACE)?).map_err(odd("asl2c"))?;
    Ok(assign(&counts, &rows, &read(C)?))
}

fn odd(tool: &'static str) -> impl FnOnce(serde_json::Error) -> VerifyError {
    move |error| VerifyError::Tool { tool, output: error.to_string() }
}

/// A row of the trace matrix: a plan and one of its requirements.
#[derive(Debug, Deserialize)]
struct Row {
    requirement: String,
    plan: usize,
    label: String,
    trigger: String,
    source: Place,
    c: Place,
}

#[derive(Debug, Deserialize)]
struct Place {
    lines: [usize; 2],
}

/// Assigns counts to plans. A plan is chosen where its function calls the trace function.
fn assign(counts: &Counts, rows: &[Row], source: &str) -> Coverage {
    let traces: Vec<bool> = source.lines().map(|line| line.contains("tracePlan(")).collect();
    let mut plans: Vec<PlanCoverage> = Vec::new();
    let mut last = None;
    for row in rows {
        let requirement = Some(row.requirement.clone()).filter(|text| !text.is_empty());
        if last == Some(row.plan) {
            if let Some(plan) = plans.last_mut() {
                plan.requirements.extend(requirement);
            }
            continue;
        }
        last = Some(row.plan);
        let [first, end] = row.c.lines;
        let part = first..=end;
        let mut inside = counts.lines.iter().filter(|line| part.contains(&line.line));
        let chosen = inside.find(|line| traces.get(line.line - 1) == Some(&true));
        plans.push(PlanCoverage {
            line: row.source.lines[0],
            trigger: row.trigger.clone(),
            label: row.label.clone(),
            requirements: requirement.into_iter().collect(),
            chosen: chosen.map_or(0, |line| line.count),
            outcomes: counts.outcomes(&part),
        });
    }
    let whole = 1..=usize::MAX;
    Coverage { plans, outcomes: counts.outcomes(&whole), lines: counts.statements(&whole) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_has_the_counts_of_its_lines() {
        let counts = r#"{ "files": [{ "file": "x/autopilot.c", "lines": [
            { "line_number": 2, "count": 9, "branches": [{ "count": 9 }, { "count": 0 }] },
            { "line_number": 3, "count": 4, "branches": [] },
            { "line_number": 5, "count": 0, "branches": [{ "count": 0 }, { "count": 0 }] } ] }] }"#;
        let row = |requirement: &str| {
            format!(
                r#"{{ "requirement": "{requirement}", "plan": 0, "label": "l", "trigger": "+!g",
                "source": {{ "lines": [7, 9] }}, "c": {{ "lines": [1, 4] }} }}"#
            )
        };
        let rows = format!("[{}, {}]", row("A"), row("B"));
        let source = "f\n{ if (a)\ntracePlan(self, 0U);\n}\nif (b)\n";
        let coverage = assign(
            &Counts::parse(counts, "autopilot.c").unwrap(),
            &serde_json::from_str::<Vec<Row>>(&rows).unwrap(),
            source,
        );
        let [plan] = &coverage.plans[..] else { panic!("{coverage:?}") };
        assert_eq!((plan.line, plan.chosen), (7, 4));
        assert_eq!(plan.outcomes, Share { ran: 1, all: 2 });
        assert_eq!(plan.requirements, ["A", "B"]);
        assert_eq!(coverage.outcomes, Share { ran: 1, all: 4 });
        assert_eq!(coverage.lines, Share { ran: 2, all: 3 });
        assert_eq!(coverage.by_requirement()["B"].0, Share { ran: 1, all: 1 });
    }
}
