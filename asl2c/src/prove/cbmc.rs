//! Runs CBMC, the model checker for C.

use std::io::{Read as _, Seek as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
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
        Ok(Self { path, version })
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
        chosen: &[usize],
        checks: Checks,
    ) -> Result<(Vec<Failure>, Vec<usize>), ProveError> {
        let unwinding: &[&str] = if checks == Checks::All { &["--unwind", "2"] } else { &[] };
        let text = self.run(folder, function, checks, unwinding)?;
        is_proved(&text)?;
        let mut others = Vec::new();
        let mut failing = Vec::new();
        for line in text.lines().filter_map(|line| line.strip_suffix(": FAILURE")) {
            // "[induction.assertion.1] line 12 candidate 3"
            let (name, said) = line.split_once(']').unwrap_or((line, line));
            let said = said.trim();
            let said = match said.strip_prefix("line ") {
                Some(rest) => rest.split_once(' ').map_or(rest, |(_, text)| text),
                None => said,
            };
            match said.strip_prefix("candidate ").and_then(|index| index.parse::<usize>().ok()) {
                Some(index) => failing.push(index),
                None => others.push(Failure {
                    name: name.trim_start_matches('[').to_owned(),
                    said: said.to_owned(),
                }),
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

    /// Its output, standard error last.
    fn run(
        &self,
        folder: &Path,
        function: &str,
        checks: Checks,
        arguments: &[&str],
    ) -> Result<String, ProveError> {
        let output = self
            .command(folder, function, checks)
            .args(arguments)
            .output()
            .map_err(in_file("cannot run", &self.path))?;
        let mut text = String::from_utf8_lossy(&output.stdout).into_owned();
        text.push_str(&String::from_utf8_lossy(&output.stderr));
        Ok(text)
    }

    fn command(&self, folder: &Path, function: &str, checks: Checks) -> Command {
        let mut command = Command::new(&self.path);
        command.args([HARNESS, "--function", function]).args(options(checks)).current_dir(folder);
        command
    }

    /// Searches for counterexamples from the initial state, up to this number of transitions; `None` on a
    /// timeout.
    pub(super) fn ways(
        &self,
        folder: &Path,
        wanted: &[&Failure],
        transitions: u32,
        until: Instant,
    ) -> Result<Option<Vec<Trace>>, ProveError> {
        let is_property = |failure: &&Failure| failure.property().is_some();
        let only_properties = wanted.iter().all(is_property);
        let checks = if only_properties { Checks::Properties } else { Checks::All };
        // A file, because the output may exceed the capacity of a pipe while the process is waited for.
        let mut said = tempfile::tempfile().map_err(in_file("cannot make", folder))?;
        let output = said.try_clone().map_err(in_file("cannot make", folder))?;
        let mut child = self
            .command(folder, "main", checks)
            .args(["--trace", "--json-ui"])
            // Each transition has its own objects.
            .args(["--object-bits", "20"])
            .args(["--unwindset", &format!("main.0:{transitions}"), "--no-unwinding-assertions"])
            .args(wanted.iter().flat_map(|failure| ["--property", failure.name.as_str()]))
            .stdout(output)
            .stderr(Stdio::null())
            .spawn()
            .map_err(in_file("cannot run", &self.path))?;
        while child.try_wait().map_err(in_file("cannot wait for", &self.path))?.is_none() {
            if Instant::now() >= until {
                // It may have ended already.
                _ = child.kill();
                child.wait().map_err(in_file("cannot wait for", &self.path))?;
                return Ok(None);
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let mut text = String::new();
        let read = said.rewind().and_then(|()| said.read_to_string(&mut text));
        read.map_err(in_file("cannot read the output of", &self.path))?;
        traces(&text).map(Some).ok_or_else(|| ProveError::NoResult { output: end(&text) })
    }
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
    fn an_assertion_is_found_by_its_property() {
        let listed = "\nProperty step.assertion.1:\n  file harness.c line 5 function step\n  property one\n  a == 1u\n\n\
                      Property step.assertion.2:\n  file harness.c line 7 function step\n  property one_more\n  b == 1u\n";
        assert_eq!(assertion(listed, "one"), Some("step.assertion.1"));
        assert_eq!(assertion(listed, "one_more"), Some("step.assertion.2"));
        assert_eq!(assertion(listed, "more"), None);
    }
}
