//! Tests that are made from an agent's text, executed on its C, and what of the C they reach.

mod difference;
mod gcov;
mod independence;
mod search;
mod values;
mod world;

use std::fmt::Write as _;

use translator::interpreter::Value;
use translator::{Act, GeneratedFile, ROUNDED, TESTS, TranslateError, scripted};

pub(crate) use self::difference::{Differing, differing, places, shorter};
pub use self::gcov::{Counts, LineCount, Share};
pub use self::independence::Independence;
use self::search::{Found, search};
use crate::agent::Agent;
use crate::headers::HeaderError;
use crate::run::{Runs as _, Session, call_name, replay, test_acts};
use crate::tool::{ToolError, run, write};

/// Why there is no coverage.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CoverageError {
    /// The agent has errors, or cannot be tested because only the environment can create its values.
    #[error(transparent)]
    Translate(#[from] TranslateError),
    /// A header of the agent's own.
    #[error(transparent)]
    Header(#[from] HeaderError),
    /// A tool is missing or failed.
    #[error(transparent)]
    Tool(#[from] ToolError),
    /// A test of one's own cannot be executed, or the agent does something else.
    #[error("{0}")]
    Test(String),
}

/// A test that somebody wrote.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnTest {
    /// Its name, for people and as a file.
    pub name: String,
    /// A transcript of `asl2c run`.
    pub transcript: String,
}

/// A test: the environment's calls, and what the agent must do.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Test {
    /// The name of a test that somebody wrote; `None` for one that was made.
    pub own: Option<String>,
    /// A transcript for `asl2c run`.
    pub transcript: String,
    /// First lines of the plans that are chosen in it, in the agent's text.
    pub plans: Vec<usize>,
    /// Names of the agent's properties that it breaks in this test, whatever was proved.
    pub broken: Vec<String>,
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

/// Makes tests that reach as much of an agent as is found, and executes them, and those that somebody wrote, on its C.
///
/// # Errors
/// See [`CoverageError`].
pub fn cover(agent: &Agent, own: &[OwnTest]) -> Result<Coverage, CoverageError> {
    let mut found = search(&agent.configuration, &agent.text)?;
    let mut broken_by_own = Vec::new();
    for test in own {
        let (executable, broken) = executable(agent, test)?;
        found.push(executable);
        broken_by_own.push(broken);
    }
    let first_own = found.len() - own.len();
    let files = program(agent, &found)?;
    let (said, counts) = executed(&files)?;
    let mut tests = Vec::new();
    for ((index, test), difference) in found.iter().enumerate().zip(differences(&found, &said)) {
        let plans = test.plans.iter().map(|place| line(&agent.text, *place)).collect();
        let by_own =
            index.checked_sub(first_own).and_then(|i| own.get(i).zip(broken_by_own.get(i)));
        let (transcript, broken) = match by_own {
            Some((own, broken)) => (own.transcript.clone(), broken.clone()),
            None => transcript(agent, index + 1, test)?,
        };
        let own = by_own.map(|(own, _)| own.name.clone());
        tests.push(Test { own, transcript, plans, broken, difference });
    }
    let independence = Independence::new(&counts, &files[0].text);
    let program = files.into_iter().rev().find(|file| file.name == TESTS).unwrap_or_default();
    Ok(Coverage { tests, program, counts, independence })
}

/// A test that somebody wrote, if the agent does what it says, and the properties that break in it.
fn executable(agent: &Agent, test: &OwnTest) -> Result<(Found, Vec<String>), CoverageError> {
    let OwnTest { name, transcript } = test;
    let mut session = Session::new(&agent.configuration, &agent.text)?;
    let replayed = replay(&mut session, name, transcript);
    if replayed.errors > 0 {
        let shown = replayed.shown;
        return Err(CoverageError::Test(format!(
            "{name}: the agent does something else:\n{shown}"
        )));
    }
    let acts = test_acts(name, transcript, agent.configuration.declarations());
    let acts = acts.map_err(CoverageError::Test)?;
    let too_long = || CoverageError::Test(format!("{name}: a step is too long"));
    let found = search::given(&agent.configuration, &agent.text, &acts)?.ok_or_else(too_long)?;
    Ok((found, replayed.broken))
}

/// The agent's C and a program that executes the tests on it.
fn program(agent: &Agent, tests: &[Found]) -> Result<Vec<GeneratedFile>, CoverageError> {
    let acts: Vec<Vec<Act>> = tests.iter().map(|test| test.acts.clone()).collect();
    let mut files = scripted(&agent.configuration, &agent.text, &acts)?;
    files.extend(agent.own_headers(&files)?);
    Ok(files)
}

/// The first difference of each test in the trace of all.
fn differences(tests: &[Found], said: &str) -> Vec<Option<String>> {
    let mut traces = said.split("# ").skip(1);
    let difference = |(number, test): (usize, &Found)| {
        let expected = format!("{number}\n{}", test.trace);
        difference(&expected, traces.next().unwrap_or_default())
    };
    (1..).zip(tests).map(difference).collect()
}

/// Compiles and runs the program. Returns its trace and the counts of the C.
fn executed(files: &[GeneratedFile]) -> Result<(String, Counts), ToolError> {
    let no_folder = |source| ToolError::Io { what: "no temporary folder".to_owned(), source };
    let folder = tempfile::tempdir().map_err(no_folder)?;
    let folder = folder.path();
    files.iter().try_for_each(|file| write(folder, &file.name, &file.text))?;
    let c = &files[0].name;
    let compiled = ["-std=c99", ROUNDED, "-O0", "-w", "-I."];
    run(folder, "gcc", &[&compiled[..], &["--coverage", "-c", c, "-o", "agent.o"]].concat())?;
    run(folder, "gcc", &[&compiled[..], &["-c", TESTS, "-o", "tests.o"]].concat())?;
    // An action may be called `open` or `write`: what counts must not call it in place of the system's.
    run(folder, "ld", &["-r", "agent.o", "tests.o", "-o", "closed.o"])?;
    run(folder, "objcopy", &["--keep-global-symbol=main", "closed.o"])?;
    run(folder, "gcc", &["--coverage", "closed.o", "-o", "tests"])?;
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

/// The test as a transcript, with the output of the reference interpreter, and the properties that break in it.
fn transcript(
    agent: &Agent,
    number: usize,
    test: &Found,
) -> Result<(String, Vec<String>), TranslateError> {
    let mut session = Session::new(&agent.configuration, &agent.text)?;
    let mut broken = Vec::new();
    let mut text = format!("// Test {number}, made by asl2c.\n");
    for act in &test.acts {
        let line = act_line(act);
        // Writing to a string cannot fail.
        _ = writeln!(text, "> {line}");
        // The line has been executed before, by the search.
        for shown in session.execute(&line).unwrap_or_default() {
            _ = writeln!(text, "{shown}");
        }
        broken.extend_from_slice(session.broken());
    }
    Ok((text, broken))
}

fn act_line(act: &Act) -> String {
    let list =
        |values: &[Value]| values.iter().map(Value::to_string).collect::<Vec<_>>().join(", ");
    match act {
        Act::Raise(event, values) => format!("{}({});", call_name(event), list(values)),
        Act::Set(belief, values) => format!("set_{belief}({});", list(values)),
        Act::Receive(performative, about, values) => {
            format!("receive_{}_{about}({});", performative.name(), list(values))
        }
        Act::Be(peer) => format!("init({peer});"),
        Act::Answer(function, values) => format!("{function}_result = {};", list(values)),
        Act::Clear => "clear();".to_owned(),
        Act::Step => "next_step();".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lamp() -> Agent {
        let configuration =
            "settings { input = lamp.asl; output = lamp.c; header = lamp.h; basics = b.h; };
            includes { #include <stdbool.h>
            #include <stdint.h> };
            basics { void shine(int32_t); void warn(void); bool dark(void); };
            types { light(int32_t); level(int32_t); limit(int32_t); };
            settables { level; }; triggerables { +!light; };";
        let text = "limit(4711).\n+!light(X) : dark & level(Y) & limit(Max) & Y < Max <- shine(X); !light(Y).\n\
            +!light(3) <- warn.\n+!light(_).\n";
        let configuration = translator::parse_configuration("lamp.conf", configuration).unwrap();
        let text = text.to_owned();
        Agent { configuration, written: String::new(), text, path: "lamp.conf".into() }
    }

    #[test]
    fn tests_reach_what_can_be_reached() {
        let found = cover(&lamp(), &[]).unwrap();
        assert!(found.tests.iter().all(|test| test.difference.is_none()), "{:?}", found.tests);
        let plans: std::collections::BTreeSet<usize> =
            found.tests.iter().flat_map(|test| test.plans.iter().copied()).collect();
        assert_eq!(plans, [2, 3, 4].into());
        let missed = found.counts.lines.iter().filter(|line| line.count == 0);
        // The counters would have to overflow.
        assert!(missed.count() <= 1, "{:?}", found.counts);
        assert!(found.tests.iter().any(|test| test.transcript.contains("4711")));
        // The same ones each time.
        assert_eq!(cover(&lamp(), &[]).unwrap(), found);
    }

    /// Functions that the library calls which counts: the tests neither fail nor lose their counts by it.
    #[test]
    fn actions_may_have_names_of_the_system() {
        let configuration =
            "settings { input = door.asl; output = door.c; header = door.h; basics = b.h; };
            basics { void open(void); void close(void); void write(void); void getpid(void); void fcntl(void); };
            types { go(void); }; triggerables { +!go; };";
        let configuration = translator::parse_configuration("door.conf", configuration).unwrap();
        let text = "+!go <- open; write; getpid; fcntl; close.\n".to_owned();
        let door = Agent { configuration, written: String::new(), text, path: "door.conf".into() };
        let found = cover(&door, &[]).unwrap();
        assert!(found.tests.iter().all(|test| test.difference.is_none()), "{:?}", found.tests);
        assert!(found.counts.lines.iter().any(|line| line.count > 0));
    }

    #[test]
    fn a_test_of_ones_own_is_executed_if_the_agent_does_what_it_says() {
        let of = |transcript: &str| {
            let own =
                OwnTest { name: "own.transcript".to_owned(), transcript: transcript.to_owned() };
            cover(&lamp(), &[own])
        };
        let found = of("> // A test.\n> achieve_light(3); step 1\nwarn()\n").unwrap();
        let last = found.tests.last().unwrap();
        assert_eq!((last.own.as_deref(), &last.difference), (Some("own.transcript"), &None));
        assert_eq!(last.plans, [3]);
        for (wrong, said) in [
            ("> achieve_light(3); step 1\nshine(3)\n", "`warn()` instead of `shine(3)`"),
            ("> init();\n", "not a test of the C"),
            ("> achieve_dark();\n", "there is no `achieve_dark`"),
        ] {
            let error = of(wrong).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn a_changed_c_fails_tests() {
        let agent = lamp();
        let found = search(&agent.configuration, &agent.text).unwrap();
        let files = program(&agent, &found).unwrap();
        let judged = |from: &str, to: &str| {
            let mut files = files.clone();
            let changed = files[0].text.replacen(from, to, 1);
            assert!(from == to || changed != files[0].text, "{from}:\n{}", files[0].text);
            files[0].text = changed;
            let (said, _) = executed(&files).unwrap();
            differences(&found, &said).into_iter().flatten().next()
        };
        assert_eq!(judged("", ""), None);
        for (from, to) in [
            ("var_Y < var_Max", "var_Y <= var_Max"),
            ("value1 = dark()", "value1 = !dark()"),
            ("warn();", ""),
            ("shine(var_X);", "shine(var_Y);"),
            ("agent.belief_level_1 = argument1;", ""),
        ] {
            let difference = judged(from, to).expect(from);
            assert!(difference.contains("instead of"), "{difference}");
        }
    }
}
