//! Tests that are made from an agent's text, executed on its C, and what of the C they reach.

mod gcov;
mod independence;
mod search;
mod values;
mod world;

use std::fmt::Write as _;
use std::path::Path;

use translator::interpreter::Value;
use translator::{Act, GeneratedFile, TESTS, TranslateError, scripted};

pub use self::gcov::{Counts, LineCount, Share};
pub use self::independence::Independence;
use self::search::{Found, search};
use crate::agent::Agent;
use crate::run::{Session, call_name};
use crate::tool::{ToolError, run, write};

/// Why there is no coverage.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CoverageError {
    /// The agent has errors, or cannot be tested because only the environment can create its values.
    #[error(transparent)]
    Translate(#[from] TranslateError),
    /// A tool is missing or failed.
    #[error(transparent)]
    Tool(#[from] ToolError),
}

/// A test: the environment's calls, and what the agent must do.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Test {
    /// A transcript for `asl2c run`.
    pub transcript: String,
    /// First lines of the plans that are chosen in it, in the agent's text.
    pub plans: Vec<usize>,
    /// The first difference between the C and what it must do, if there is one.
    pub difference: Option<String>,
}

/// Coverage of an agent's C by tests.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Coverage {
    /// The tests.
    pub tests: Vec<Test>,
    /// The program that executes them on the C.
    pub program: GeneratedFile,
    /// Counts of the C.
    pub counts: Counts,
    /// Conditions of the C that are shown to decide independently of others.
    pub independence: Independence,
}

/// Makes tests that reach as much of an agent as is found, and executes them on its C. `include` is the folder with the
/// configuration's own headers.
///
/// # Errors
/// See [`CoverageError`].
pub fn cover(agent: &Agent, include: &Path) -> Result<Coverage, CoverageError> {
    let found = search(&agent.configuration, &agent.text)?;
    let acts: Vec<Vec<Act>> = found.iter().map(|test| test.acts.clone()).collect();
    let files = scripted(&agent.configuration, &agent.text, &acts)?;
    let (said, counts) = executed(&files, include)?;
    let traces: Vec<&str> = said.split("# ").skip(1).collect();
    let mut tests = Vec::new();
    for (index, test) in found.iter().enumerate() {
        let number = index + 1;
        let expected = format!("{number}\n{}", test.trace);
        let plans = test.plans.iter().map(|place| line(&agent.text, *place)).collect();
        tests.push(Test {
            transcript: transcript(agent, number, test)?,
            plans,
            difference: difference(&expected, traces.get(index).copied().unwrap_or_default()),
        });
    }
    let independence = Independence::new(&counts, &files[0].text);
    let program = files.into_iter().rev().find(|file| file.name == TESTS).unwrap_or_default();
    Ok(Coverage { tests, program, counts, independence })
}

/// Compiles and runs the program. Returns its trace and the counts of the C.
fn executed(files: &[GeneratedFile], include: &Path) -> Result<(String, Counts), ToolError> {
    let no_folder = |source| ToolError::Io { what: "no temporary folder".to_owned(), source };
    let folder = tempfile::tempdir().map_err(no_folder)?;
    let folder = folder.path();
    files.iter().try_for_each(|file| write(folder, &file.name, &file.text))?;
    // Made absolute, because the compiler is run in another folder. A bare file name has no folder.
    let include = if include.as_os_str().is_empty() { Path::new(".") } else { include };
    let include = std::path::absolute(include).unwrap_or_else(|_| include.to_owned());
    let include = format!("-I{}", include.display());
    let c = &files[0].name;
    let compiled = ["-std=c99", "-O0", "-w", "-I.", &include];
    run(folder, "gcc", &[&compiled[..], &["--coverage", "-c", c, "-o", "agent.o"]].concat())?;
    run(folder, "gcc", &[&compiled[..], &["-c", TESTS, "-o", "tests.o"]].concat())?;
    run(folder, "gcc", &["--coverage", "agent.o", "tests.o", "-o", "tests"])?;
    let said = run(folder, "./tests", &[])?;
    let counted = run(folder, "gcov", &[&Counts::OPTIONS[..], &["agent.gcda"]].concat())?;
    let counts = Counts::parse(&counted, c).map_err(|error| ToolError::Failed {
        program: "gcov".to_owned(),
        said: error.to_string(),
    })?;
    Ok((said, counts))
}

/// Where two traces differ first.
fn difference(expected: &str, found: &str) -> Option<String> {
    if expected == found {
        return None;
    }
    let lines = expected.lines().zip(found.lines());
    let same = lines.take_while(|(expected, found)| expected == found).count();
    let at = |text: &str| text.lines().nth(same).unwrap_or("the end").to_owned();
    Some(format!("line {}: `{}` instead of `{}`", same + 1, at(found), at(expected)))
}

/// The number of the line with a byte.
fn line(text: &str, place: usize) -> usize {
    text.bytes().take(place).filter(|byte| *byte == b'\n').count() + 1
}

/// The test as a transcript, with the output of the reference interpreter.
fn transcript(agent: &Agent, number: usize, test: &Found) -> Result<String, TranslateError> {
    let mut session = Session::new(&agent.configuration, &agent.text)?;
    let mut text = format!("// Test {number}, made by asl2c.\n");
    for act in &test.acts {
        let line = act_line(act);
        // Writing to a string cannot fail.
        _ = writeln!(text, "> {line}");
        // The line has been executed before, by the search.
        for shown in session.execute(&line).unwrap_or_default() {
            _ = writeln!(text, "{shown}");
        }
    }
    Ok(text)
}

fn act_line(act: &Act) -> String {
    let list =
        |values: &[Value]| values.iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
    match act {
        Act::Raise(event, values) => format!("{}({});", call_name(event), list(values)),
        Act::Set(belief, values) => format!("set_{belief}({});", list(values)),
        Act::Answer(function, values) => format!("{function}_result = {};", list(values)),
        Act::Clear => "clear();".to_owned(),
        Act::Step => "next_step();".to_owned(),
    }
}
