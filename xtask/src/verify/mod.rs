//! Proves the properties of an agent on its C, for every environment and any number of steps.
//!
//! CBMC checks one transition from any state that satisfies an invariant. The invariant is found by
//! dropping, from many candidates, those that do not hold in the beginning or that some transition
//! breaks, until the rest proves itself (Flanagan and Leino, "Houdini", FME 2001). Frama-C's EVA follows
//! the agent's whole life and reports what could be an error at run time.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use translator::{HARNESS, Obligations, Promise, TranslateError, obligations, parse_configuration};

use crate::mutants::{MUTANTS, Mutant, Place, RUN_TIME};
use crate::parallel;

/// Why nothing could be said.
#[derive(Debug, thiserror::Error)]
pub(crate) enum VerifyError {
    /// A file or a program.
    #[error("{what}: {source}")]
    Io {
        /// What was tried.
        what: String,
        /// What the system says.
        source: io::Error,
    },
    /// The agent is refused.
    #[error("{0}")]
    Translate(#[from] TranslateError),
    /// A tool said something else than a result.
    #[error("{tool} did not come to a result:\n{output}")]
    Tool {
        /// Which.
        tool: &'static str,
        /// The end of what it said.
        output: String,
    },
}

/// What was proved of one agent, and what was not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Verdict {
    /// Each property, and whether it holds in every environment, however long the agent runs.
    pub(crate) properties: Vec<(Promise, bool)>,
    /// Errors at run time that could not be excluded, as the tools say it.
    pub(crate) run_time: Vec<String>,
    /// How many of the candidates are invariant, of how many.
    pub(crate) invariant: (usize, usize),
}

impl Verdict {
    /// Whether everything was proved.
    pub(crate) fn holds(&self) -> bool {
        self.run_time.is_empty() && self.properties.iter().all(|(_, holds)| *holds)
    }

    /// What was not proved.
    fn broken(&self) -> Vec<&str> {
        let properties = self.properties.iter().filter(|(_, holds)| !holds);
        let run_time = (!self.run_time.is_empty()).then_some(RUN_TIME);
        properties.map(|(promise, _)| promise.name.as_str()).chain(run_time).collect()
    }
}

/// An agent to be verified: its configuration and its text.
pub(crate) struct Agent<'a> {
    /// The name of the configuration's file.
    pub(crate) name: &'a str,
    /// The configuration.
    pub(crate) configuration: &'a str,
    /// The agent.
    pub(crate) text: &'a str,
}

/// Proves what can be proved of an agent with a CBMC; `folder` is for generated files, and `change`
/// may spoil them.
fn prove(
    agent: &Agent<'_>,
    cbmc: &Path,
    folder: &Path,
    checks: Checks,
    change: impl Fn(&str) -> Option<String>,
) -> Result<Verdict, VerifyError> {
    let parsed = parse_configuration(agent.name, agent.configuration)?;
    let obligations = obligations(parsed, agent.text)?;
    std::fs::create_dir_all(folder).map_err(in_file("cannot make", folder))?;
    for file in &obligations.files {
        let text = change(&file.text);
        write(folder, &file.name, text.as_ref().unwrap_or(&file.text))?;
    }
    let checker = Checker { cbmc, folder, obligations: &obligations };
    let all: Vec<usize> = (0..obligations.candidates()).collect();
    let mut chosen = checker.check("base", &all, Checks::Properties)?.1;
    let mut results = loop {
        let (results, left) = checker.check("induction", &chosen, Checks::Properties)?;
        if left.len() == chosen.len() {
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
    Ok(Verdict { properties, run_time, invariant: (chosen.len(), obligations.candidates()) })
}

/// What is looked at besides the candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Checks {
    /// The properties.
    Properties,
    /// And whatever could be an error at run time.
    All,
}

struct Checker<'a> {
    cbmc: &'a Path,
    folder: &'a Path,
    obligations: &'a Obligations,
}

impl Checker<'_> {
    /// Checks a function of the harness with an invariant: what fails besides candidates, and the
    /// candidates that do not.
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

fn write(folder: &Path, name: &str, text: &str) -> Result<(), VerifyError> {
    let path = folder.join(name);
    std::fs::write(&path, text).map_err(in_file("cannot write", &path))
}

fn in_file(what: &str, path: &Path) -> impl FnOnce(io::Error) -> VerifyError {
    let what = format!("{what} {}", path.display());
    move |source| VerifyError::Io { what, source }
}

/// Where the tools and generated files are.
fn folder(name: &str) -> PathBuf {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    target.join(name)
}

/// What Frama-C's EVA cannot exclude in the agent's whole life, from `init()` on.
fn run_time_alarms(folder: &Path) -> Result<Vec<String>, VerifyError> {
    let folder = folder.canonicalize().map_err(in_file("cannot find", folder))?;
    let output = Command::new(FRAMA_C)
        .args(["-eva", "-eva-precision", "1", "-machdep", "gcc_x86_64"])
        // Numbers that are none may come from outside; literals need not be exact.
        .args(["-warn-special-float", "none", "-kernel-warn-key", "parser:decimal-float=inactive"])
        .arg(HARNESS)
        .current_dir(&folder)
        // It asks the environment where it is.
        .env("PWD", &folder)
        .output()
        .map_err(in_file("cannot run", Path::new(FRAMA_C)))?;
    let text = String::from_utf8_lossy(&output.stdout);
    if !text.contains("ANALYSIS SUMMARY") {
        return Err(VerifyError::Tool { tool: "Frama-C", output: text.into_owned() });
    }
    let mut lines = text.lines();
    let mut alarms = Vec::new();
    while let Some(line) = lines.next() {
        if let Some(place) = line.strip_prefix("[eva:alarm] ") {
            let place = place.trim_end_matches(" Warning: ").trim_end_matches(':');
            alarms.push(format!("{place} {}", lines.next().unwrap_or_default().trim()));
        }
    }
    Ok(alarms)
}

const FRAMA_C: &str = "frama-c";
const CONFIGURATION: &str = include_str!("../../autopilot/agent/autopilot.conf");
const AGENT: &str = include_str!("../../autopilot/agent/autopilot.asl");
const REPORT: &str = "docs/verification.md";

/// Verifies the shipped agent and its mutants, tells, and writes it down.
pub(crate) fn run() -> Result<(String, bool), VerifyError> {
    let tools = folder("tools");
    let script = Path::new("xtask/tools/cbmc.sh");
    let fetched =
        Command::new(script).arg(&tools).status().map_err(in_file("cannot run", script))?;
    if !fetched.success() {
        return Ok(("skipped: there is no CBMC here\n".to_owned(), true));
    }
    let cbmc = tools.join("cbmc");
    let cbmc = cbmc.canonicalize().map_err(in_file("cannot find", &cbmc))?;
    let frama_c = version(FRAMA_C, "-version");
    let agent = Agent { name: "autopilot.conf", configuration: CONFIGURATION, text: AGENT };
    let generated = folder("verify").join("autopilot");
    let mut verdict = prove(&agent, &cbmc, &generated, Checks::All, |_| None)?;
    if frama_c.is_some() {
        verdict.run_time.extend(run_time_alarms(&generated)?);
    }
    let mutants = mutants(&cbmc, frama_c.is_some())?;
    let good = verdict.holds() && mutants.iter().all(|(mutant, broken)| caught(mutant, broken));
    let cbmc = version(cbmc, "--version");
    let report = Report { verdict, mutants, cbmc, frama_c };
    write(Path::new(""), REPORT, &report.markdown())?;
    Ok((report.lines(), good))
}

/// What a tool calls itself; nothing if it is not there.
fn version(tool: impl AsRef<std::ffi::OsStr>, option: &str) -> Option<String> {
    let output = Command::new(tool).arg(option).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

fn caught(mutant: &Mutant, broken: &[String]) -> bool {
    broken.iter().any(|name| name == mutant.breaks)
}

/// What each mutant breaks. Without Frama-C those that err at run time are left out.
fn mutants(cbmc: &Path, frama_c: bool) -> Result<Vec<(&'static Mutant, Vec<String>)>, VerifyError> {
    let tried = |number: &usize| frama_c || MUTANTS[*number].breaks != RUN_TIME;
    let numbers: Vec<usize> = (0..MUTANTS.len()).filter(tried).collect();
    let broken = parallel::map(&numbers, |number| {
        let mutant = &MUTANTS[number];
        let changed =
            |place, text: &str| mutant.apply(place, text).unwrap_or_else(|| text.to_owned());
        let configuration = changed(Place::Configuration, CONFIGURATION);
        let text = changed(Place::Agent, AGENT);
        let agent = Agent { name: "mutant.conf", configuration: &configuration, text: &text };
        let folder = folder("verify").join(format!("mutant{number}"));
        let runs_wrong = mutant.breaks == RUN_TIME;
        let checks = if runs_wrong { Checks::All } else { Checks::Properties };
        let spoil = |file: &str| mutant.apply(Place::C, file);
        let mut verdict = prove(&agent, cbmc, &folder, checks, spoil)?;
        if runs_wrong {
            verdict.run_time.extend(run_time_alarms(&folder)?);
        }
        Ok::<_, VerifyError>(verdict.broken().into_iter().map(str::to_owned).collect::<Vec<_>>())
    })?;
    Ok(numbers.into_iter().map(|number| &MUTANTS[number]).zip(broken).collect())
}

/// All that was found.
struct Report {
    verdict: Verdict,
    mutants: Vec<(&'static Mutant, Vec<String>)>,
    cbmc: Option<String>,
    frama_c: Option<String>,
}

impl Report {
    /// For the terminal.
    fn lines(&self) -> String {
        let mut text =
            String::from("The shipped agent, in every environment, for any number of steps\n");
        for (promise, holds) in &self.verdict.properties {
            _ = writeln!(text, "  {:<28}{}", promise.name, proved(*holds));
        }
        _ = writeln!(
            text,
            "  {:<28}{}",
            "no error at run time",
            proved(self.verdict.run_time.is_empty())
        );
        for error in &self.verdict.run_time {
            _ = writeln!(text, "    possible: {error}");
        }
        if self.frama_c.is_none() {
            text += "  skipped: there is no Frama-C here\n";
        }
        text += "Mutants, each of which must break what it is made for\n";
        for (mutant, broken) in &self.mutants {
            let how = if caught(mutant, broken) { "caught: " } else { "NOT CAUGHT; broken: " };
            _ = writeln!(text, "  {:<54}{how}{}", mutant.name, broken.join(", "));
        }
        text
    }

    /// For `docs/verification.md`.
    fn markdown(&self) -> String {
        let mut text = String::from(INTRODUCTION);
        text += "| property | requirement | must hold | |\n|---|---|---|---|\n";
        for (promise, holds) in &self.verdict.properties {
            let Promise { name, requirements, formula } = promise;
            let requirements = requirements.join(", ");
            _ = writeln!(text, "| `{name}` | {requirements} | `{formula}` | {} |", proved(*holds));
        }
        let run_time = proved(self.verdict.run_time.is_empty());
        _ = writeln!(
            text,
            "| no error at run time | | no access outside an object, no overflow, no division by zero, no \
             conversion that loses, no uninitialised read | {run_time} |"
        );
        let (invariant, candidates) = self.verdict.invariant;
        let none = || "not there".to_owned();
        _ = writeln!(
            text,
            "\nThe invariant has {invariant} conditions, found among {candidates} candidates. CBMC {}; \
             Frama-C {}.\n",
            self.cbmc.clone().unwrap_or_else(none),
            self.frama_c.clone().unwrap_or_else(none),
        );
        text += MUTANTS_INTRODUCTION;
        text += "| mutant | breaks |\n|---|---|\n";
        for (mutant, broken) in &self.mutants {
            let not = if caught(mutant, broken) { "" } else { "**not caught**; " };
            _ = writeln!(text, "| {} | {not}{} |", mutant.name, broken.join(", "));
        }
        text += LIMITS;
        text
    }
}

fn proved(holds: bool) -> &'static str {
    if holds { "proved" } else { "NOT PROVED" }
}

const INTRODUCTION: &str = "\
# Verification

`cargo xtask verify` proves what must hold of the shipped agent
([`autopilot.asl`](../autopilot/agent/autopilot.asl), [`autopilot.conf`](../autopilot/agent/autopilot.conf)),
shows that the proof can fail, and writes this page.

The proof is of the generated C, in an environment that may do anything at any time: raise every event with
any arguments, believe any values (numbers that are none among them), answer every question differently each
time it is asked. It has no bound on the length of the flight: CBMC shows that one transition (an event
raised, a belief set, or a step) from *any* state that satisfies an invariant keeps the invariant and every
property, and that the first state satisfies it. The invariant is found, not written: from candidates made of
the agent's events and beliefs those are dropped that the first state or some transition breaks, until the
rest proves itself. Frama-C's EVA follows the whole life of the same C from `init()` on.

Properties stand in the configuration; [the language guide](agentspeak.md#properties) tells what they mean.

";

const MUTANTS_INTRODUCTION: &str = "\
## The proof can fail

Each of these mutants is the shipped agent, its configuration or its C with one mistake in it, and breaks
what it is made to break.

";

const LIMITS: &str = "
## What is assumed, and what is not proved

- The C is translated with the agent's state passed in, as the autopilot uses it; of `instance = static` the
  same plans and cycle are proved, not the other way of reaching the state.
- CBMC, Frama-C, the C compiler and the Rust around the agent are trusted. What the environment does with an
  AT command is not part of the proof: that is the guard's, the session's and the drone's
  ([safety.md](safety.md)), and tested.
- That an empty battery is *noticed* is not a property here but the first plan of `+!watch`, which every plan
  in the air asks first; the property says that what was noticed leads down.
- Time is free in the proof: that a take-off is given up after 10 s is tested, not proved.
- How the tests cover the agent's plans is not measured yet; nor are the properties checked on a model of the
  agent itself (SPIN), from which a failure could be told in the agent's own words.

The stack of a step and its longest path, in instructions over all paths of the compiled C, are in
`asl2c --report autopilot/agent/autopilot.conf`.
";
