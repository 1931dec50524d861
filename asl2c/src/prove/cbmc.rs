//! Runs CBMC, the model checker for C.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use translator::HARNESS;

use super::goals::{Goals, Place};
use super::trace::{Trace, traces};
use super::{Checks, ProveError, in_file, write};
use crate::tool::finished;

/// The program.
pub const CBMC: &str = "cbmc";
/// Earlier versions have other options.
const OLDEST: u32 = 6;
/// A program that takes longer to tell its version is none that proves.
const SPEAKS: Duration = Duration::from_secs(10);

/// A CBMC that can be run.
#[derive(Debug, Clone)]
pub struct Cbmc {
    path: PathBuf,
    version: String,
    stop: Arc<AtomicBool>,
}

/// An assertion that is not proved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    /// CBMC's name of it: `step.assertion.1`.
    pub(crate) name: String,
    /// CBMC's description, without the line.
    pub(crate) said: String,
}

impl Failure {
    /// Its property.
    pub(crate) fn property(&self) -> Option<&str> {
        self.said.strip_prefix(PROPERTY)
    }

    /// Whether it is an assertion of a text, and not a check of CBMC's own.
    pub(crate) fn is_asserted(&self) -> bool {
        self.name.contains(".assertion.")
    }
}

/// What CBMC printed. Errors are kept apart: in the middle of a line they would hide a result.
#[derive(Debug)]
struct Said {
    /// Its exit status; `None` if a signal ended it.
    status: Option<i32>,
    output: String,
    errors: String,
}

/// Exit status if everything holds, or there was nothing to prove.
const ALL_HOLDS: i32 = 0;
/// Exit status if an assertion fails.
const SOMETHING_FAILS: i32 = 10;

/// What CBMC says of the assertions of a program, without the goals of known truth that stand beside them.
#[derive(Debug)]
struct Judged {
    /// Each assertion, and whether it holds; `None` behind an error at run time, which ends the executions that go there.
    assertions: Vec<(Failure, Option<bool>)>,
    /// Whether some execution is known to come to the end of the function, or to an assertion that fails.
    comes_somewhere: bool,
}

impl Cbmc {
    /// Finds a CBMC: the given one, or that on the path.
    ///
    /// # Errors
    /// [`ProveError::Missing`] if there is none, it is older than version 6 or does not tell its version in 10 s, or gcc, its
    /// C preprocessor, is missing.
    pub fn find(named: Option<&Path>) -> Result<Self, ProveError> {
        let missing = |reason: String| ProveError::Missing { reason };
        let path = named.unwrap_or(Path::new(CBMC));
        // Made absolute, because it is run in another folder.
        let path = if path.components().count() > 1 {
            path.canonicalize().map_err(|error| missing(format!("{}: {error}", path.display())))?
        } else {
            path.to_owned()
        };
        let asked = Instant::now();
        let output = finished(Command::new(&path).arg("--version"), |_| asked.elapsed() > SPEAKS);
        let output = output.map_err(|_| missing("CBMC cannot be run".to_owned()))?;
        let silent = || missing(format!("{} does not tell its version", path.display()));
        let output = output.ok_or_else(silent)?;
        let version = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        let major = version.split('.').next().and_then(|major| major.parse::<u32>().ok());
        if major.is_none_or(|major| major < OLDEST) {
            return Err(missing(format!("{} is `{version}`", path.display())));
        }
        if Command::new("gcc").arg("--version").output().is_err() {
            return Err(missing(
                "gcc, which CBMC uses as its preprocessor, cannot be run".to_owned(),
            ));
        }
        Ok(Self { path, version, stop: Arc::default() })
    }

    /// Ends all proofs once the flag is set: a program that is asked to end leaves no CBMC behind.
    #[must_use]
    pub fn stopped_by(mut self, stop: Arc<AtomicBool>) -> Self {
        self.stop = stop;
        self
    }

    /// Fails once the proofs were ended.
    ///
    /// # Errors
    /// [`ProveError::Stopped`] if the flag of [`Self::stopped_by`] is set.
    pub fn check_stop(&self) -> Result<(), ProveError> {
        if self.stop.load(Ordering::Relaxed) { Err(ProveError::Stopped) } else { Ok(()) }
    }

    /// Its version.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Checks a function of the harness in a folder. Returns the failures other than candidates, and the
    /// candidates that hold. Each of the `expected` assertions must be judged.
    pub(super) fn check(
        &self,
        folder: &Path,
        function: &str,
        (chosen, unwinding): (&[usize], usize),
        checks: Checks,
        expected: &[String],
    ) -> Result<(Vec<Failure>, Vec<usize>), ProveError> {
        let mut arguments: Vec<String> = options(checks).map(str::to_owned).into();
        if checks == Checks::All {
            arguments.extend(["--unwind".to_owned(), unwinding.to_string()]);
        }
        let judged =
            self.judged(folder, (HARNESS, function), &arguments, Place::Around, || false)?;
        let Judged { assertions, comes_somewhere } = judged.ok_or(ProveError::Stopped)?;
        if !comes_somewhere {
            let function = function.to_owned();
            return Err(ProveError::Vacuous { function });
        }
        let is_judged = |said: &str| assertions.iter().any(|(assertion, _)| assertion.said == said);
        let candidates = chosen.iter().map(|index| format!("{CANDIDATE}{index}"));
        if let Some(missing) =
            expected.iter().cloned().chain(candidates).find(|said| !is_judged(said))
        {
            return Err(self.untrusted(format!("it does not judge `{missing}`")));
        }
        let mut others = Vec::new();
        let mut failing = Vec::new();
        for (found, _) in assertions.into_iter().filter(|(_, holds)| *holds != Some(true)) {
            let candidate = found.said.strip_prefix(CANDIDATE);
            match candidate.and_then(|index| index.parse::<usize>().ok()) {
                Some(index) => failing.push(index),
                None => others.push(found),
            }
        }
        let left = chosen.iter().copied().filter(|index| !failing.contains(index)).collect();
        Ok((others, left))
    }

    /// Whether a function of the harness can violate a property; the rest is not checked.
    pub(super) fn violates(
        &self,
        folder: &Path,
        function: &str,
        property: &str,
    ) -> Result<bool, ProveError> {
        let is_wanted = |said: &str| said.strip_prefix(PROPERTY) == Some(property);
        let (judged, said) = self.judged_alone(folder, function, is_wanted)?;
        match judged.assertions.as_slice() {
            [(_, Some(holds))] => Ok(!holds),
            _ => Err(said.no_result()),
        }
    }

    /// The candidates that a function of the harness keeps; the rest is not checked.
    pub(super) fn kept(
        &self,
        folder: &Path,
        function: &str,
        chosen: &[usize],
    ) -> Result<Vec<usize>, ProveError> {
        let is_wanted = |said: &str| said.starts_with(CANDIDATE);
        let (judged, said) = self.judged_alone(folder, function, is_wanted)?;
        if judged.assertions.len() != chosen.len() {
            return Err(said.no_result());
        }
        let is_kept = |index: &usize| {
            let candidate = format!("{CANDIDATE}{index}");
            judged
                .assertions
                .iter()
                .any(|(found, holds)| found.said == candidate && *holds == Some(true))
        };
        Ok(chosen.iter().copied().filter(is_kept).collect())
    }

    /// What is said of some assertions of a function, without what they do not need.
    fn judged_alone(
        &self,
        folder: &Path,
        function: &str,
        is_wanted: impl Fn(&str) -> bool,
    ) -> Result<(Judged, Said), ProveError> {
        let goals = Goals::new(Place::Before);
        let place = (HARNESS, function);
        let mut list = self.program(folder, place, &goals)?;
        list.args(options(Checks::Properties)).arg("--show-properties");
        let listed = self.said(&mut list, || false)?.ok_or(ProveError::Stopped)?;
        let names =
            assertions(&listed.output, |said| is_wanted(said) || goals.number(said).is_some());
        let mut check = self.program(folder, place, &goals)?;
        check.args(options(Checks::Properties)).arg("--slice-formula");
        check.args(names.iter().flat_map(|name| ["--property", name]));
        let said = self.said(&mut check, || false)?.ok_or(ProveError::Stopped)?;
        Ok((self.judge(&goals, &said)?, said))
    }

    /// What is said of all assertions of a function; `None` if it was given up.
    fn judged(
        &self,
        folder: &Path,
        place: (&str, &str),
        arguments: &[String],
        goals: Place,
        give_up: impl Fn() -> bool,
    ) -> Result<Option<Judged>, ProveError> {
        let goals = Goals::new(goals);
        let mut command = self.program(folder, place, &goals)?;
        let said = self.said(command.args(arguments), give_up)?;
        said.map(|said| self.judge(&goals, &said)).transpose()
    }

    /// Reads a result, and refuses that of a tool which contradicts itself or misjudges the goals.
    fn judge(&self, goals: &Goals, said: &Said) -> Result<Judged, ProveError> {
        let all_holds = said.output.contains("VERIFICATION SUCCESSFUL");
        let something_fails = said.output.contains("VERIFICATION FAILED");
        match (said.status, all_holds, something_fails) {
            (Some(SOMETHING_FAILS), false, true) | (Some(ALL_HOLDS), true, false) => {}
            (_, false, false) => return Err(said.no_result()),
            (status, ..) => {
                let status = status.map_or("a signal".to_owned(), |status| status.to_string());
                let why = format!("its exit status, {status}, is not that of the result it prints");
                return Err(self.untrusted(why));
            }
        }
        let mut known = Vec::new();
        let mut assertions = Vec::new();
        let lines = said.output.lines().skip_while(|line| *line != RESULTS);
        for (assertion, holds) in lines.filter_map(judgement) {
            match goals.number(&assertion.said) {
                Some(number) => known.push((number, holds)),
                None => assertions.push((assertion, holds)),
            }
        }
        let holds = |number| known.iter().find(|(other, _)| *other == number)?.1;
        goals.judge(holds).map_err(|why| self.untrusted(why.to_owned()))?;
        let all = known.iter().map(|known| known.1).chain(assertions.iter().map(|other| other.1));
        let failed = all.clone().filter(|holds| *holds == Some(false)).count();
        let fails = assertions.iter().any(|(_, holds)| *holds == Some(false));
        if all.clone().any(|holds| holds.is_none()) && !fails {
            return Err(said.no_result());
        }
        let counted = format!("** {failed} of {} failed", known.len() + assertions.len());
        // It lists and counts nothing if there is nothing to prove.
        let is_counted = known.len() + assertions.len() == 0
            || said.output.lines().any(|line| line.starts_with(&counted));
        if !is_counted || all_holds != (failed == 0) {
            return Err(self.untrusted("it counts other results than it lists".to_owned()));
        }
        let comes_somewhere = goals.reaches_end(holds) || (fails && !goals.excludes_end(holds));
        Ok(Judged { assertions, comes_somewhere })
    }

    fn untrusted(&self, why: String) -> ProveError {
        ProveError::Untrusted { path: self.path.clone(), why }
    }

    /// CBMC for a function of a file, and goals beside it. They are written to the folder.
    fn program(
        &self,
        folder: &Path,
        (file, function): (&str, &str),
        goals: &Goals,
    ) -> Result<Command, ProveError> {
        write(folder, &goals.file(), &goals.program(file, function))?;
        Ok(self.command(folder, &goals.file(), goals.function()))
    }

    /// CBMC for a function of a file.
    fn command(&self, folder: &Path, file: &str, function: &str) -> Command {
        let mut command = Command::new(&self.path);
        command.args([file, "-I.", "--function", function]).current_dir(folder);
        command
    }

    /// Checks all assertions, run-time errors and bounds of loops of a function, with more arguments; `None`
    /// if it was given up. Without goals beside it, it may only be asked what another proof asks again.
    pub(crate) fn failures(
        &self,
        folder: &Path,
        place: (&str, &str),
        arguments: &[String],
        goals: Place,
        give_up: impl Fn() -> bool,
    ) -> Result<Option<Vec<Failure>>, ProveError> {
        let judged = self.judged(folder, place, arguments, goals, give_up)?;
        let failing = |Judged { assertions, .. }: Judged| {
            let failing = assertions.into_iter().filter(|(_, holds)| *holds == Some(false));
            failing.map(|(failure, _)| failure).collect()
        };
        Ok(judged.map(failing))
    }

    /// The traces to all assertions of a function that fail; `None` if it was given up.
    pub(super) fn traces(
        &self,
        folder: &Path,
        (file, function): (&str, &str),
        arguments: &[String],
        give_up: impl Fn() -> bool,
    ) -> Result<Option<Vec<Trace>>, ProveError> {
        // Without the goals of known truth: what is shown is executed, and their random numbers would lead to other
        // traces each time.
        let mut command = self.command(folder, file, function);
        command.args(["--trace", "--json-ui", "--object-bits", "20"]).args(arguments);
        let Some(said) = self.said(&mut command, give_up)? else { return Ok(None) };
        let found = traces(&said.output).ok_or_else(|| said.no_result())?;
        let expected = if found.is_empty() { ALL_HOLDS } else { SOMETHING_FAILS };
        if said.status != Some(expected) {
            let why = "its exit status is not that of the traces it prints";
            return Err(self.untrusted(why.to_owned()));
        }
        Ok(Some(found))
    }

    /// What it prints; `None` if it was given up, or all proofs were ended.
    fn said(
        &self,
        command: &mut Command,
        give_up: impl Fn() -> bool,
    ) -> Result<Option<Said>, ProveError> {
        let give_up = || give_up() || self.check_stop().is_err();
        let output = finished(command, |_| give_up()).map_err(in_file("cannot run", &self.path))?;
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Ok(output.map(|output| Said {
            status: output.status.code(),
            output: text(&output.stdout),
            errors: text(&output.stderr),
        }))
    }

    /// The branches of a file that a function of the harness cannot take.
    pub(super) fn dead(
        &self,
        folder: &Path,
        function: &str,
        file: &str,
    ) -> Result<DeadBranches, ProveError> {
        let goals = Goals::new(Place::Before);
        write(folder, &goals.file(), &goals.branches(HARNESS, function))?;
        let mut command = self.command(folder, &goals.file(), goals.function());
        command.args(options(Checks::Properties)).args(["--cover", "branch"]);
        let said = self.said(&mut command, || false)?.ok_or(ProveError::Stopped)?;
        if said.status != Some(ALL_HOLDS) || !said.output.contains(" covered (") {
            return Err(said.no_result());
        }
        let known = dead_branches(&said.output, &goals.file());
        let never = |line: usize, value: bool| {
            if value { &known.never_true } else { &known.never_false }.contains(&line)
        };
        goals.judge_branches(never).map_err(|why| self.untrusted(why.to_owned()))?;
        Ok(dead_branches(&said.output, file))
    }

    /// Searches for counterexamples from the initial state, up to this number of transitions; `None` on a
    /// timeout.
    pub(super) fn ways(
        &self,
        folder: &Path,
        wanted: &[&Failure],
        transitions: u32,
        until: Option<Instant>,
    ) -> Result<Option<Vec<Trace>>, ProveError> {
        let is_property = |failure: &&Failure| failure.property().is_some();
        let only_properties = wanted.iter().all(is_property);
        let checks = if only_properties { Checks::Properties } else { Checks::All };
        let mut arguments: Vec<String> = options(checks).map(str::to_owned).into();
        arguments.extend(["--unwindset".to_owned(), format!("main.0:{transitions}")]);
        arguments.push("--no-unwinding-assertions".to_owned());
        let names = wanted.iter().flat_map(|failure| ["--property", failure.name.as_str()]);
        arguments.extend(names.map(str::to_owned));
        let late = || until.is_some_and(|until| Instant::now() >= until);
        match self.traces(folder, (HARNESS, "main"), &arguments, late)? {
            Some(traces) => Ok(Some(traces)),
            None => self.check_stop().map(|()| None),
        }
    }
}

impl Said {
    /// The error of an output without a result.
    fn no_result(&self) -> ProveError {
        // gcc, as the preprocessor, or CBMC itself, which says what is wrong in the line before: one of them says where.
        let mut before = "";
        for line in self.errors.lines().chain(self.output.lines()).map(str::trim) {
            let is_last = matches!(line, "PARSING ERROR" | "CONVERSION ERROR");
            if is_last || line.contains("fatal error: ") {
                let said = if is_last && !before.is_empty() { before } else { line };
                return ProveError::NotCompiled { said: said.to_owned() };
            }
            before = line;
        }
        let lines: Vec<&str> = self.output.lines().chain(self.errors.lines()).collect();
        ProveError::NoResult { output: lines[lines.len().saturating_sub(20)..].join("\n") }
    }
}

/// Before the results in CBMC's output.
const RESULTS: &str = "** Results:";
/// Begins the description of a property's assertion.
const PROPERTY: &str = "property ";
/// Begins the description of an assertion of a candidate for the invariant.
const CANDIDATE: &str = "candidate ";

/// An assertion in a line of CBMC, `[induction.assertion.1] line 12 candidate 3: FAILURE`, and whether it holds; `None`
/// for what CBMC has not decided.
fn judgement(line: &str) -> Option<(Failure, Option<bool>)> {
    let (name, rest) = line.strip_prefix('[')?.split_once("] ")?;
    let (said, result) = rest.rsplit_once(": ")?;
    let said = match said.strip_prefix("line ") {
        Some(rest) => rest.split_once(' ').map_or(rest, |(_, text)| text),
        None => said,
    };
    let holds = match result {
        "SUCCESS" => Some(true),
        "FAILURE" => Some(false),
        _ => None,
    };
    Some((Failure { name: name.to_owned(), said: said.to_owned() }, holds))
}

/// Branches of the C that no execution takes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct DeadBranches {
    /// Functions that are never entered.
    pub(crate) functions: BTreeSet<String>,
    /// Lines whose condition is never true; the condition of a label is that the value is another one.
    pub(crate) never_true: BTreeSet<usize>,
    /// Lines whose condition is never false.
    pub(crate) never_false: BTreeSet<usize>,
}

/// Reads the goals of `--cover branch`. Conditions are jumps over what they guard, so a branch that is taken is one whose
/// condition is false; that of a label is a jump to what it guards.
fn dead_branches(text: &str, file: &str) -> DeadBranches {
    let mut dead = DeadBranches::default();
    for line in text.lines().filter_map(|line| line.strip_suffix(": FAILED")) {
        let Some((_, place)) = line.split_once(&format!(" file {file} line ")) else { continue };
        let mut words = place.split(' ');
        let (Some(number), Some("function"), Some(function)) =
            (words.next().and_then(|word| word.parse().ok()), words.next(), words.next())
        else {
            continue;
        };
        if place.ends_with("entry point") {
            dead.functions.insert(function.to_owned());
        } else if place.ends_with("branch true") {
            dead.never_false.insert(number);
        } else if place.ends_with("branch false") {
            dead.never_true.insert(number);
        }
    }
    dead
}

/// CBMC's names of assertions, from its list: the name, the place and the description, a line each.
fn assertions(listed: &str, wanted: impl Fn(&str) -> bool) -> Vec<&str> {
    let mut name = None;
    let mut found = Vec::new();
    for line in listed.lines() {
        if let Some(next) = line.strip_prefix("Property ") {
            name = next.strip_suffix(':');
        } else if let Some(name) = name.filter(|_| wanted(line.trim())) {
            found.push(name);
        }
    }
    found
}

fn options(checks: Checks) -> [&'static str; 1] {
    match checks {
        Checks::Properties => ["--no-standard-checks"],
        Checks::All => ["--conversion-check"],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_covered_is_dead() {
        let text = "[f.coverage.1] file harness.c line 9 function f block 1 branch true: FAILED\n\
            [g.coverage.1] file a.c line 3 function g entry point: FAILED\n\
            [h.coverage.2] file a.c line 7 function h block 1 branch false: SATISFIED\n\
            [h.coverage.3] file a.c line 7 function h block 1 branch true: FAILED\n\
            [h.coverage.4] file a.c line 8 function h block 2 branch false: FAILED\n";
        let dead = dead_branches(text, "a.c");
        assert_eq!(dead.functions, ["g".to_owned()].into());
        assert_eq!((dead.never_false, dead.never_true), ([7].into(), [8].into()));
    }

    /// What comes behind an error at run time is not judged: it is neither shown, nor CBMC's failure.
    #[test]
    fn what_is_not_judged_is_not_shown() {
        let cbmc = Cbmc { path: CBMC.into(), version: String::new(), stop: Arc::default() };
        let judge = |assertions: [&str; 3]| {
            let failed = assertions.iter().filter(|result| **result == "FAILURE").count();
            let results = assertions.map(|result| format!("[x.assertion.1] line 1 y: {result}"));
            let (results, word) =
                (results.join("\n"), if failed > 0 { "FAILED" } else { "SUCCESSFUL" });
            let output = format!(
                "{RESULTS}\n{results}\n** {failed} of 3 failed (1 iterations)\nVERIFICATION {word}"
            );
            let status = Some(if failed > 0 { SOMETHING_FAILS } else { ALL_HOLDS });
            let said = Said { status, output, errors: String::new() };
            let judged = cbmc.judge(&Goals::new(Place::Nowhere), &said);
            judged.map(|judged| judged.assertions.into_iter().map(|(_, holds)| holds).collect())
        };
        let judged = judge(["SUCCESS", "FAILURE", "UNKNOWN"]);
        assert_eq!(judged.unwrap(), vec![Some(true), Some(false), None]);
        let judged: Result<Vec<_>, _> = judge(["SUCCESS", "SUCCESS", "UNKNOWN"]);
        assert!(matches!(judged, Err(ProveError::NoResult { .. })));
    }

    #[test]
    fn an_assertion_is_found_by_its_property() {
        let listed = "\nProperty step.assertion.1:\n  file harness.c line 5 function step\n  property one\n  a == 1u\n\n\
                      Property step.assertion.2:\n  file harness.c line 7 function step\n  property one_more\n  b == 1u\n";
        let named = |name: &str| assertions(listed, |said| said == format!("property {name}"));
        assert_eq!(named("one"), ["step.assertion.1"]);
        assert_eq!(named("one_more"), ["step.assertion.2"]);
        assert_eq!(named("more"), [""; 0]);
    }
}
