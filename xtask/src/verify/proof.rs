//! Proves properties of an agent on its C, for every environment and any number of steps.
//!
//! CBMC checks one transition from any state that satisfies an invariant. The invariant is found by starting
//! with many candidates and dropping those that do not hold initially or that some transition breaks, until
//! the rest is inductive (Flanagan and Leino, "Houdini", FME 2001).

use std::path::Path;
use std::process::Command;

use translator::{HARNESS, Obligations, Promise, obligations, parse_configuration};

use super::mutants::RUN_TIME;
use super::{Agent, VerifyError, in_file, write};

/// Result of the proof of one agent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Verdict {
    /// Each property, and whether it holds in every environment for any number of steps.
    pub(super) properties: Vec<(Promise, bool)>,
    /// Run-time errors that could not be excluded, as reported by the tools.
    pub(super) run_time: Vec<String>,
    /// The candidates that are invariant.
    pub(super) invariant: Vec<String>,
    /// Number of candidates.
    pub(super) candidates: usize,
}

impl Verdict {
    /// Whether everything was proved.
    pub(super) fn holds(&self) -> bool {
        self.run_time.is_empty() && self.properties.iter().all(|(_, holds)| *holds)
    }

    /// Properties that were not proved.
    pub(super) fn broken(&self) -> Vec<&str> {
        let properties = self.properties.iter().filter(|(_, holds)| !holds);
        let run_time = (!self.run_time.is_empty()).then_some(RUN_TIME);
        properties.map(|(promise, _)| promise.name.as_str()).chain(run_time).collect()
    }
}

/// Proves the properties of an agent with CBMC; `folder` is for generated files, and `change` may modify them
/// (for mutants). If a nearly valid invariant is known, only its conditions are tried. With `enough`, it
/// suffices to find that this property is not proved, which then also holds with fewer conditions.
pub(super) fn prove(
    agent: &Agent<'_>,
    cbmc: &Path,
    folder: &Path,
    checks: Checks,
    known: &[String],
    enough: Option<&str>,
    change: impl Fn(&str) -> Option<String>,
) -> Result<Verdict, VerifyError> {
    let parsed = parse_configuration(agent.name, agent.configuration)?;
    let obligations = obligations(&parsed, agent.text)?;
    std::fs::create_dir_all(folder).map_err(in_file("cannot make", folder))?;
    for file in &obligations.files {
        let text = change(&file.text);
        write(folder, &file.name, text.as_ref().unwrap_or(&file.text))?;
    }
    let checker = Checker { cbmc, folder, obligations: &obligations };
    let candidates = obligations.candidates();
    let tried = |index: &usize| known.is_empty() || known.contains(&candidates[*index]);
    let tried: Vec<usize> = (0..candidates.len()).filter(tried).collect();
    let mut chosen = checker.check("base", &tried, Checks::Properties)?.1;
    let mut results = loop {
        let (results, left) = checker.check("induction", &chosen, Checks::Properties)?;
        let found =
            |name: &str| results.iter().any(|said| said.strip_prefix("property ") == Some(name));
        if left.len() == chosen.len() || enough.is_some_and(found) {
            break results;
        }
        chosen = left;
    };
    if checks == Checks::All {
        results = checker.check("induction", &chosen, checks)?.0;
    }
    let mut run_time = Vec::new();
    let mut properties: Vec<(Promise, bool)> =
        obligations.properties.iter().map(|promise| (promise.clone(), true)).collect();
    for failure in results {
        match failure.strip_prefix("property ") {
            Some(name) => {
                for property in properties.iter_mut().filter(|property| property.0.name == name) {
                    property.1 = false;
                }
            }
            None => run_time.push(failure),
        }
    }
    let invariant = chosen.into_iter().map(|index| candidates[index].clone()).collect();
    Ok(Verdict { properties, run_time, invariant, candidates: candidates.len() })
}

/// Checks besides the candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Checks {
    /// The properties only.
    Properties,
    /// The properties and all run-time errors.
    All,
}

struct Checker<'a> {
    cbmc: &'a Path,
    folder: &'a Path,
    obligations: &'a Obligations,
}

impl Checker<'_> {
    /// Checks a function of the harness under an invariant: returns the failures other than candidates, and
    /// the indices of candidates that fail.
    fn check(
        &self,
        function: &str,
        chosen: &[usize],
        checks: Checks,
    ) -> Result<(Vec<String>, Vec<usize>), VerifyError> {
        let invariant = self.obligations.invariant(chosen);
        write(self.folder, &invariant.name, &invariant.text)?;
        let output = Command::new(self.cbmc)
            .args([HARNESS, "--function", function])
            .args(match checks {
                Checks::Properties => ["--no-standard-checks"].as_slice(),
                Checks::All => ["--conversion-check", "--unwind", "2"].as_slice(),
            })
            .current_dir(self.folder)
            .output()
            .map_err(in_file("cannot run", self.cbmc))?;
        let text = String::from_utf8_lossy(&output.stdout);
        if !text.contains("VERIFICATION SUCCESSFUL") && !text.contains("VERIFICATION FAILED") {
            let said = format!("{text}{}", String::from_utf8_lossy(&output.stderr));
            let lines: Vec<&str> = said.lines().collect();
            let end = lines[lines.len().saturating_sub(20)..].join("\n");
            return Err(VerifyError::Tool { tool: "CBMC", output: end });
        }
        let mut others = Vec::new();
        let mut failing = Vec::new();
        for failure in text.lines().filter_map(|line| line.strip_suffix(": FAILURE")) {
            // "[induction.assertion.1] line 12 candidate 3"
            let said = failure.split_once(']').map_or(failure, |(_, rest)| rest.trim());
            let said = match said.strip_prefix("line ") {
                Some(rest) => rest.split_once(' ').map_or(rest, |(_, text)| text),
                None => said,
            };
            match said.strip_prefix("candidate ").and_then(|index| index.parse::<usize>().ok()) {
                Some(index) => failing.push(index),
                None => others.push(said.to_owned()),
            }
        }
        let left = chosen.iter().copied().filter(|index| !failing.contains(index)).collect();
        Ok((others, left))
    }
}
