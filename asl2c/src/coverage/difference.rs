//! Looks for an execution in which another C file does not do what an agent's text says: the tests that are made from the
//! text are executed on it, and one that fails is shortened.

use translator::interpreter::Interpreter;
use translator::{Act, GeneratedFile, ROUNDED, TESTS, scripted};

use super::search::{self, search};
use super::world::Execution;
use super::{CoverageError, act_line};
use crate::agent::Agent;
use crate::run::test_acts;
use crate::tool::{ToolError, output, run, write};

/// An execution from the start, at whose end the C differs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Differing {
    /// A script for `asl2c run`.
    pub(crate) lines: Vec<String>,
    /// Number of events, beliefs that are set, and steps.
    pub(crate) transitions: u32,
    /// What differs.
    pub(crate) said: String,
}

/// Attempts to shorten an execution, all in one program.
const MOST_ATTEMPTS: usize = 200;

/// Shortest prefix of a test that shows a difference.
struct Failed {
    acts: Vec<Act>,
    said: String,
}

/// Finds a short execution in which the C differs from the agent; `None` if all tests pass.
pub(crate) fn differing(agent: &Agent, c: &str) -> Result<Option<Differing>, CoverageError> {
    let found = search(&agent.configuration, &agent.text)?;
    let attempts = found.into_iter().map(|test| test.acts).collect();
    shortened(agent, attempts, c)
}

/// Leaves out what an execution does not need for the C to differ; `None` if it does not differ.
pub(crate) fn shorter(
    agent: &Agent,
    lines: &[String],
    c: &str,
) -> Result<Option<Differing>, CoverageError> {
    let configuration = agent.configuration.declarations();
    match test_acts("way", &lines.join("\n"), configuration) {
        Ok(acts) => shortened(agent, vec![acts], c),
        // The script is our own, so this cannot happen; the way is as good as it was.
        Err(_) => Ok(None),
    }
}

/// Short executions of the agent to different states, with the next event, and as a beginning for
/// [`translator::comparison_after`].
pub(crate) fn places(agent: &Agent) -> Result<Vec<(String, Vec<Act>)>, CoverageError> {
    Ok(search::places(&agent.configuration, &agent.text)?)
}

fn shortened(
    agent: &Agent,
    mut attempts: Vec<Vec<Act>>,
    c: &str,
) -> Result<Option<Differing>, CoverageError> {
    let mut best: Option<Failed> = None;
    loop {
        let failed = failed(agent, &attempts, c)?;
        let Some(shortest) = failed.into_iter().min_by_key(|failed| failed.acts.len()) else {
            break;
        };
        if best.as_ref().is_some_and(|best| best.acts.len() <= shortest.acts.len()) {
            break;
        }
        attempts = with_less(&shortest.acts);
        best = Some(shortest);
    }
    Ok(best.map(|Failed { acts, said }| {
        let transitions = acts.iter().filter(|act| !matches!(act, Act::Answer(..))).count();
        let transitions = u32::try_from(transitions).unwrap_or(u32::MAX);
        Differing { lines: acts.iter().map(act_line).collect(), transitions, said }
    }))
}

/// The acts without some of them, in all parts of halved length.
fn with_less(acts: &[Act]) -> Vec<Vec<Act>> {
    let mut attempts = Vec::new();
    let mut length = acts.len() / 2;
    while length > 0 {
        for from in (0..acts.len()).step_by(length) {
            let until = (from + length).min(acts.len());
            attempts.push([&acts[..from], &acts[until..]].concat());
        }
        length /= 2;
    }
    // The shortest parts last: one act each.
    attempts.reverse();
    attempts.truncate(MOST_ATTEMPTS);
    attempts
}

/// Those of the executions in which the C differs, up to there.
fn failed(agent: &Agent, attempts: &[Vec<Act>], c: &str) -> Result<Vec<Failed>, CoverageError> {
    let interpreter = Interpreter::new(&agent.configuration, &agent.text)?;
    let first = Execution::new(interpreter, agent.configuration.declarations());
    let mut tests: Vec<(Vec<Act>, String)> = Vec::new();
    for acts in attempts {
        let mut execution = first.clone();
        if acts.iter().all(|act| execution.execute(act)) {
            let trace = execution.take_seen().trace + &execution.at_the_end();
            tests.push((acts.clone(), trace));
        }
    }
    let acts: Vec<Vec<Act>> = tests.iter().map(|(acts, _)| acts.clone()).collect();
    let mut files = scripted(&agent.configuration, &agent.text, &acts)?;
    c.clone_into(&mut files[0].text);
    files.extend(agent.own_headers(&files)?);
    let said = executed(&files, acts.len())?;
    // After a crash the traces of further tests are missing, and the last one ends early.
    let traces = said.split("# ").skip(1);
    Ok(tests
        .into_iter()
        .zip(traces)
        .filter_map(|((mut acts, expected), trace)| {
            let trace = trace.split_once('\n').map_or("", |(_, trace)| trace);
            let (end, said) = difference(&acts, &expected, trace)?;
            acts.truncate(end);
            Some(Failed { acts, said })
        })
        .collect())
}

/// Executes each test in a process of its own, because C may have more state than the agent's. It may not end: each has
/// seconds and blocks of 512 bytes to print, and is the last one if it fails.
fn executing(tests: usize) -> String {
    format!(
        "ulimit -t 10; ulimit -f 200000; test=0; while [ $test -lt {tests} ]; do test=$((test + 1)); ./tests $test || \
         break; done > trace"
    )
}

/// Compiles and runs the tests. Returns their trace, as far as they come.
fn executed(files: &[GeneratedFile], tests: usize) -> Result<String, ToolError> {
    let io = |what: &str| {
        let what = what.to_owned();
        move |source| ToolError::Io { what, source }
    };
    let folder = tempfile::tempdir().map_err(io("no temporary folder"))?;
    let folder = folder.path();
    files.iter().try_for_each(|file| write(folder, &file.name, &file.text))?;
    let c = &files[0].name;
    run(folder, "gcc", &["-std=c99", ROUNDED, "-O0", "-w", "-I.", c, TESTS, "-o", "tests"])?;
    // Its status does not matter: a crash is a difference, too.
    output(folder, "sh", &["-c", &executing(tests)])?;
    let trace = std::fs::read(folder.join("trace")).map_err(io("cannot read the trace"))?;
    Ok(String::from_utf8_lossy(&trace).into_owned())
}

/// The number of acts up to the first difference of two traces, and what differs. Each act but an answer has a line that
/// begins with `>`.
fn difference(acts: &[Act], expected: &str, found: &str) -> Option<(usize, String)> {
    if expected == found {
        return None;
    }
    let same = expected
        .lines()
        .zip(found.lines())
        .take_while(|(expected, found)| expected == found)
        .count();
    let (wanted, got) = (expected.lines().nth(same), found.lines().nth(same));
    let is_call = |line: Option<&str>| line.is_some_and(|line| line.starts_with('>'));
    let before = expected.lines().take(same).filter(|line| line.starts_with('>')).count();
    let calls = before + usize::from(is_call(wanted) && is_call(got));
    let places = acts.iter().enumerate().filter(|(_, act)| !matches!(act, Act::Answer(..)));
    let end = places.map(|(place, _)| place + 1).nth(calls.saturating_sub(1)).unwrap_or(acts.len());
    let name = |line: &str| {
        let line = line.trim_start_matches("> ");
        line.split('(').next().unwrap_or(line).to_owned()
    };
    let said = match (wanted, got) {
        (_, None) => "it fails, or does not come to an end".to_owned(),
        (Some(wanted), Some(got)) if is_call(Some(wanted)) && is_call(Some(got)) => {
            format!("another result of {}", name(wanted))
        }
        (Some(wanted), Some(got)) if is_call(Some(got)) => {
            format!("no call of {}", name(wanted))
        }
        (Some(wanted), Some(got)) if name(wanted) == name(got) => {
            format!("another value for {}", name(wanted))
        }
        (_, Some(got)) => format!("a call of {} that the agent does not make here", name(got)),
    };
    Some((end, said))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_act_that_differs_is_the_last_one() {
        let acts = [Act::Step, Act::Answer("f".to_owned(), Vec::new()), Act::Step, Act::Clear];
        let expected =
            "> next_step()\non()\n> next_step()\noff(1)\n> clear()\n> can_add_event() = true\n";
        let of = |found: &str| difference(&acts, expected, found);
        assert_eq!(of(expected), None);
        let changed = |from: &str, to: &str| of(&expected.replacen(from, to, 1)).unwrap();
        assert_eq!(changed("on()\n", ""), (1, "no call of on".to_owned()));
        assert_eq!(changed("off(1)", "off(2)"), (3, "another value for off".to_owned()));
        let more = "a call of on that the agent does not make here".to_owned();
        assert_eq!(changed("off(1)\n", "off(1)\non()\n"), (3, more.clone()));
        assert_eq!(changed("on()\n", "on()\non()\n"), (1, more));
        assert_eq!(changed("= true", "= false"), (4, "another result of can_add_event".to_owned()));
        let ends = "it fails, or does not come to an end".to_owned();
        assert_eq!(of("> next_step()\non()\n> next_step()\n"), Some((3, ends)));
    }

    #[test]
    fn parts_are_left_out_the_smallest_first() {
        let acts = [Act::Step, Act::Clear, Act::Step, Act::Clear];
        let attempts = with_less(&acts);
        assert_eq!(attempts.len(), 6);
        assert_eq!(attempts[0], [Act::Step, Act::Clear, Act::Step]);
        assert!(attempts.contains(&vec![Act::Step, Act::Clear]));
    }
}
