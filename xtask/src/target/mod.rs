//! The gallery's agents and the shipped one on a Cortex-M4: size, stack, longest path, and their traces under QEMU.

mod changes;
mod report;

use std::path::Path;

use asl2c::{Agent, OnTarget, TargetError, on_host, on_target};

use self::changes::changes;
use crate::parallel;

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
pub(crate) enum MeasureError {
    /// An agent cannot be read.
    #[error(transparent)]
    Read(#[from] asl2c::ReadError),
    /// An agent was rejected by the translator.
    #[error(transparent)]
    Translate(#[from] translator::TranslateError),
    /// The target.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The page.
    #[error("cannot write {REPORT}: {0}")]
    Write(std::io::Error),
}

const AGENTS: [(&str, &str); 8] = [
    ("autopilot", "autopilot/agent/autopilot.conf"),
    ("paper", "translator/agents/paper.conf"),
    ("lift", "translator/agents/lift.conf"),
    ("traffic_light", "translator/agents/traffic_light.conf"),
    ("infusion", "translator/agents/infusion.conf"),
    ("rover", "translator/agents/rover.conf"),
    ("inspection", "translator/agents/inspection.conf"),
    ("relief", "translator/agents/relief.conf"),
];
const REPORT: &str = "docs/cortex-m4.md";
/// Steps of each agent on both machines.
const STEPS: u32 = 10_000;
/// Changes of each agent's C.
const CHANGES: usize = 8;

/// Results of an agent.
#[derive(Debug)]
struct Measured {
    name: &'static str,
    found: OnTarget,
    /// Functions of the environment that the steps have called, of all.
    called: (usize, usize),
    /// Changes of one character that the trace shows, of all that compile.
    seen: (usize, usize),
}

impl Measured {
    /// Whether the traces are equal, no step exceeded a bound, and changes are seen.
    fn is_good(&self) -> bool {
        let OnTarget { bounds, observed, difference, .. } = &self.found;
        let within = bounds.first().is_some_and(|step| {
            observed.stack <= step.stack
                && step.instructions.as_ref().is_ok_and(|most| observed.instructions <= *most)
        });
        difference.is_none() && within && self.seen.0 > 0
    }
}

/// Measures all agents. Returns the report, and writes it to a file if all is good.
pub(crate) fn run() -> Result<(String, bool), MeasureError> {
    let measured = parallel::map(&AGENTS, |(name, path)| measure(name, Path::new(path)))?;
    let good = measured.iter().all(Measured::is_good);
    let mut lines = report::lines(&measured);
    if good {
        std::fs::write(REPORT, report::markdown(&measured)).map_err(MeasureError::Write)?;
    } else {
        lines += "Not all is as it must be: ";
        lines += REPORT;
        lines += " is left as it was\n";
    }
    Ok((lines, good))
}

/// Runs an agent on both machines, and derives its bounds.
pub(crate) fn measure_agent(agent: &Agent) -> Result<OnTarget, MeasureError> {
    let exercise = translator::exercise(&agent.configuration, &agent.text)?;
    Ok(on_target(&exercise, &exercise, STEPS)?)
}

fn measure(name: &'static str, path: &Path) -> Result<Measured, MeasureError> {
    let agent = Agent::read(path)?;
    let exercise = translator::exercise(&agent.configuration, &agent.text)?;
    let found = on_target(&exercise, &exercise, STEPS)?;
    let trace = on_host(&exercise, STEPS)?;
    let basics = &agent.configuration.declarations().basics;
    let calls = |name: &str| {
        let call = format!("{name}(");
        trace.lines().any(|line| line.starts_with(&call))
    };
    let called = basics.iter().filter(|basic| calls(&basic.name.text)).count();
    let mut seen = (0, 0);
    for c in changes(&exercise.files[0].text, CHANGES) {
        let mut changed = exercise.clone();
        changed.files[0].text = c;
        match on_host(&changed, STEPS) {
            Ok(other) => seen.0 += usize::from(other != trace),
            // It compiles, but does not end well.
            Err(TargetError::Failed { program, .. }) if program != "gcc" => seen.0 += 1,
            // Some comparisons of constants do not compile.
            Err(TargetError::Failed { .. }) => continue,
            Err(error) => return Err(error.into()),
        }
        seen.1 += 1;
    }
    Ok(Measured { name, found, called: (called, basics.len()), seen })
}
