//! Runs CBMC, the model checker for C.

use std::collections::BTreeSet;
use std::io::{Read as _, Seek as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use translator::HARNESS;

use super::trace::{Trace, traces};
use super::{Checks, ProveError, in_file};

/// The program.
pub const CBMC: &str = "cbmc";
/// Earlier versions have other options.
const OLDEST: u32 = 6;

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
        self.said.strip_prefix("property ")
    }
}

/// What of CBMC's output is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Said {
    /// Only standard output.
    Output,
    /// Also standard error.
    All,
}

impl Cbmc {
    /// Finds a CBMC: the given one, or that on the path.
    ///
    /// # Errors
    /// [`ProveError::Missing`] if there is none, it is too old, or its C preprocessor is missing.
    pub fn find(named: Option<&Path>) -> Result<Self, ProveError> {
        let missing = |reason: String| ProveError::Missing { reason };
        let path = named.unwrap_or(Path::new(CBMC));
        // Made absolute, because it is run in another folder.
        let path = if path.components().count() > 1 {
            path.canonicalize().map_err(|error| missing(format!("{}: {error}", path.display())))?
        } else {
            path.to_owned()
        };
        let output = Command::new(&path).arg("--version").output();
        let output = output.map_err(|_| missing("CBMC cannot be run".to_owned()))?;
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

    /// Whether the proofs were ended.
    ///
    /// # Errors
    /// [`ProveError::Stopped`].
    pub fn check_stop(&self) -> Result<(), ProveError> {
        if self.stop.load(Ordering::Relaxed) { Err(ProveError::Stopped) } else { Ok(()) }
    }

    /// Its version.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Checks a function of the harness in a folder. Returns the failures other than candidates, and the
    /// candidates that hold.
    pub(super) fn check(
        &self,
        folder: &Path,
        function: &str,
        (chosen, unwinding): (&[usize], usize),
        checks: Checks,
    ) -> Result<(Vec<Failure>, Vec<usize>), ProveError> {
        let unwinding = unwinding.to_string();
        let bound: &[&str] = if checks == Checks::All { &["--unwind", &unwinding] } else { &[] };
        let text = self.run(folder, function, checks, bound)?;
        is_proved(&text)?;
        let mut others = Vec::new();
        let mut failing = Vec::new();
        for found in text.lines().filter_map(failure) {
            let candidate = found.said.strip_prefix("candidate ");
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
        let run = |arguments: &[&str]| self.run(folder, function, Checks::Properties, arguments);
        let listed = run(&["--show-properties"])?;
        let name = assertion(&listed, property)
            .ok_or_else(|| ProveError::NoResult { output: end(&listed) })?;
        Ok(!is_proved(&run(&["--slice-formula", "--property", name])?)?)
    }

    /// Its output and errors.
    fn run(
        &self,
        folder: &Path,
        function: &str,
        checks: Checks,
        arguments: &[&str],
    ) -> Result<String, ProveError> {
        let mut command = self.command(folder, function, checks);
        let text = self.output(command.args(arguments), Said::All, || false)?;
        text.ok_or(ProveError::Stopped)
    }

    fn command(&self, folder: &Path, function: &str, checks: Checks) -> Command {
        let mut command = self.program(folder, HARNESS, function);
        command.args(options(checks));
        command
    }

    /// CBMC for a function of a file.
    fn program(&self, folder: &Path, file: &str, function: &str) -> Command {
        let mut command = Command::new(&self.path);
        command.args([file, "--function", function]).current_dir(folder);
        command
    }

    /// Checks all assertions, run-time errors and bounds of loops of a function, with more arguments; `None`
    /// if it was given up.
    pub(crate) fn failures(
        &self,
        folder: &Path,
        (file, function): (&str, &str),
        arguments: &[String],
        give_up: impl Fn() -> bool,
    ) -> Result<Option<Vec<Failure>>, ProveError> {
        let mut command = self.program(folder, file, function);
        let Some(text) = self.output(command.args(arguments), Said::Output, give_up)? else {
            return Ok(None);
        };
        is_proved(&text)?;
        Ok(Some(text.lines().filter_map(failure).collect()))
    }

    /// The traces to all assertions of a function that fail; `None` if it was given up.
    pub(super) fn traces(
        &self,
        folder: &Path,
        (file, function): (&str, &str),
        arguments: &[String],
        give_up: impl Fn() -> bool,
    ) -> Result<Option<Vec<Trace>>, ProveError> {
        let mut command = self.program(folder, file, function);
        command.args(["--trace", "--json-ui", "--object-bits", "20"]).args(arguments);
        let Some(text) = self.output(&mut command, Said::Output, give_up)? else { return Ok(None) };
        traces(&text).map(Some).ok_or_else(|| ProveError::NoResult { output: end(&text) })
    }

    /// What it prints; `None` if it was given up, or all proofs were ended.
    fn output(
        &self,
        command: &mut Command,
        said: Said,
        give_up: impl Fn() -> bool,
    ) -> Result<Option<String>, ProveError> {
        let no_file = |source| ProveError::Io { what: "no temporary file".to_owned(), source };
        // A file, because the output may exceed the capacity of a pipe while the process is waited for.
        let mut printed = tempfile::tempfile().map_err(no_file)?;
        let output = || printed.try_clone().map_err(no_file);
        let errors = match said {
            Said::All => output()?.into(),
            Said::Output => Stdio::null(),
        };
        let mut child = command
            .stdout(output()?)
            .stderr(errors)
            .spawn()
            .map_err(in_file("cannot run", &self.path))?;
        while child.try_wait().map_err(in_file("cannot wait for", &self.path))?.is_none() {
            if give_up() || self.check_stop().is_err() {
                // It may have ended already.
                _ = child.kill();
                child.wait().map_err(in_file("cannot wait for", &self.path))?;
                return Ok(None);
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        let mut bytes = Vec::new();
        let read = printed.rewind().and_then(|()| printed.read_to_end(&mut bytes));
        read.map_err(in_file("cannot read the output of", &self.path))?;
        Ok(Some(String::from_utf8_lossy(&bytes).into_owned()))
    }

    /// The branches of a file that a function of the harness cannot take.
    pub(super) fn dead(
        &self,
        folder: &Path,
        function: &str,
        file: &str,
    ) -> Result<DeadBranches, ProveError> {
        let text = self.run(folder, function, Checks::Properties, &["--cover", "branch"])?;
        if !text.contains(" covered (") {
            return Err(ProveError::NoResult { output: end(&text) });
        }
        Ok(dead_branches(&text, file))
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
        let mut command = self.command(folder, "main", checks);
        command
            .args(["--trace", "--json-ui"])
            // Each transition has its own objects.
            .args(["--object-bits", "20"])
            .args(["--unwindset", &format!("main.0:{transitions}"), "--no-unwinding-assertions"])
            .args(wanted.iter().flat_map(|failure| ["--property", failure.name.as_str()]));
        let late = || until.is_some_and(|until| Instant::now() >= until);
        let Some(text) = self.output(&mut command, Said::Output, late)? else {
            return self.check_stop().map(|()| None);
        };
        traces(&text).map(Some).ok_or_else(|| ProveError::NoResult { output: end(&text) })
    }
}

/// The failure in a line of CBMC: `[induction.assertion.1] line 12 candidate 3: FAILURE`.
fn failure(line: &str) -> Option<Failure> {
    let line = line.strip_suffix(": FAILURE")?;
    let (name, said) = line.split_once(']').unwrap_or((line, line));
    let said = said.trim();
    let said = match said.strip_prefix("line ") {
        Some(rest) => rest.split_once(' ').map_or(rest, |(_, text)| text),
        None => said,
    };
    Some(Failure { name: name.trim_start_matches('[').to_owned(), said: said.to_owned() })
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

/// Whether CBMC's output says that all assertions hold.
fn is_proved(text: &str) -> Result<bool, ProveError> {
    if text.contains("VERIFICATION FAILED") {
        Ok(false)
    } else if text.contains("VERIFICATION SUCCESSFUL") {
        Ok(true)
    } else {
        Err(ProveError::NoResult { output: end(text) })
    }
}

/// CBMC's name of a property's assertion, from its list: the name, the place and the property, a line each.
fn assertion<'a>(listed: &'a str, property: &str) -> Option<&'a str> {
    let mut name = None;
    for line in listed.lines() {
        if let Some(next) = line.strip_prefix("Property ") {
            name = next.strip_suffix(':');
        } else if line.trim().strip_prefix("property ") == Some(property) {
            return name;
        }
    }
    None
}

fn options(checks: Checks) -> &'static [&'static str] {
    match checks {
        Checks::Properties => &["--no-standard-checks"],
        Checks::All => &["--conversion-check"],
    }
}

/// The last lines.
fn end(said: &str) -> String {
    let lines: Vec<&str> = said.lines().collect();
    lines[lines.len().saturating_sub(20)..].join("\n")
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

    #[test]
    fn an_assertion_is_found_by_its_property() {
        let listed = "\nProperty step.assertion.1:\n  file harness.c line 5 function step\n  property one\n  a == 1u\n\n\
                      Property step.assertion.2:\n  file harness.c line 7 function step\n  property one_more\n  b == 1u\n";
        assert_eq!(assertion(listed, "one"), Some("step.assertion.1"));
        assert_eq!(assertion(listed, "one_more"), Some("step.assertion.2"));
        assert_eq!(assertion(listed, "more"), None);
    }
}
