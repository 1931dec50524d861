//! Cost of an agent: memory, call depth, and number of calls of each action in a step.

mod calls;
mod memory;

use std::collections::HashMap;
use std::fmt;

use self::calls::{Cost, besides, costs, events};
use self::memory::{Frames, state_bytes};
use crate::backend::c::symbol_prefix;
use crate::coverage::never_applicable;
use crate::program::{BasicId, HandlerId, Program};
use crate::types::TypeKind;

/// Cost of an agent. `Display` formats it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Report {
    figures: Vec<(&'static str, String)>,
    /// Name, minimum and maximum number of calls in a step that handles an event.
    actions: Vec<(String, u64, u64)>,
    classes: Vec<(String, u64, u64)>,
    frames: Frames,
    /// Maximum stack, if a compiler has reported the frame sizes.
    stack: Option<(String, u64)>,
    /// Instructions of the longest path, if the code was compiled.
    path: Option<(String, u64)>,
    /// Instructions of the costliest step that was found.
    costliest: Option<u64>,
}

impl Report {
    pub(crate) fn new(program: &Program) -> Self {
        let costs = costs(program);
        let events = events(program);
        let configuration = &program.configuration;
        let besides = besides(program);
        let bounds = |counter: usize| {
            let bounds = events.iter().map(|id| costs[id.0].calls()[counter]);
            let (fewest, most) = bounds
                .reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)))
                .unwrap_or((0, 0));
            (fewest.saturating_add(besides[counter].0), most.saturating_add(besides[counter].1))
        };
        let actions = configuration.basics.iter().enumerate();
        // Functions in contexts have no effects; generated code calls the clock and the trace function
        // itself.
        let called = program.called_in_bodies();
        let settings = &configuration.settings;
        let ours: Vec<&str> =
            settings.clock.iter().chain(&settings.trace).map(|name| name.text.as_str()).collect();
        let actions = actions.filter(|(index, basic)| {
            let acts = basic.result.kind == TypeKind::Void || called.contains(&BasicId(*index));
            acts && !ours.contains(&basic.name.text.as_str())
        });
        let count = configuration.basics.len();
        let with_bounds = |name: &str, counter: usize| {
            let (fewest, most) = bounds(counter);
            (name.to_owned(), fewest, most)
        };
        let next_step = format!("{}next_step", symbol_prefix(program));
        Self {
            figures: figures(program, &costs, &events),
            actions: actions.map(|(index, basic)| with_bounds(&basic.name.text, index)).collect(),
            classes: configuration
                .classes
                .iter()
                .enumerate()
                .map(|(index, class)| with_bounds(&class.name.text, count + index))
                .collect(),
            frames: Frames::new(program, next_step),
            stack: None,
            path: None,
            costliest: None,
        }
    }

    /// Adds the maximum stack of `next_step()`, without that of the actions. `frame_bytes` are the frame sizes of the
    /// functions in the generated C file by name, as reported by `compiler`; inlined functions are missing.
    pub fn add_stack(&mut self, compiler: &str, frame_bytes: &HashMap<String, u64>) {
        self.stack = Some((compiler.to_owned(), self.frames.deepest(frame_bytes)));
    }

    /// Linker symbol of `next_step()`.
    pub fn entry(&self) -> &str {
        self.frames.next_step()
    }

    /// Adds the instructions of the longest path through `next_step()`, as compiled by `compiler`.
    pub fn add_path(&mut self, compiler: &str, instructions: u64) {
        self.path = Some((compiler.to_owned(), instructions));
    }

    /// Adds the instructions of the costliest step that was found by running the same code.
    pub fn add_costliest(&mut self, instructions: u64) {
        self.costliest = Some(instructions);
    }
}

/// A number of calls. They double with each level of goals, and are not counted any further than that.
fn bound(calls: u64) -> String {
    if calls == u64::MAX { format!("{calls} or more") } else { calls.to_string() }
}

/// Share of a 30 ms tick that this number of instructions takes on a slow machine.
fn share_percent(instructions: u64) -> f64 {
    const PER_TICK: f64 = 0.03 * 1e9;
    100.0 * instructions as f64 / PER_TICK
}

fn figures(program: &Program, costs: &[Cost], events: &[HandlerId]) -> Vec<(&'static str, String)> {
    let at_most = |count: usize| format!("at most {count}");
    let settings = &program.configuration.settings;
    let mut figures = vec![
        ("plans", program.plans().count().to_string()),
        ("triggers", program.handlers().count().to_string()),
    ];
    figures.push(("plans never triggered", program.left_out.to_string()));
    let lines: Vec<String> =
        never_applicable(program).map(|plan| format!("line {}", plan.lines.0)).collect();
    let never = if lines.is_empty() { "0".to_owned() } else { lines.join(", ") };
    figures.push(("plans never applicable", never));
    if let Some(id) = events.iter().max_by_key(|id| costs[id.0].depth) {
        // next_step, handle_event, then the functions of a trigger and of a plan for each level.
        let frames = 2 + 2 * costs[id.0].depth;
        let trigger = program.handler(*id).text();
        figures.push(("deepest chain of calls", format!("{frames} functions, from `{trigger}`")));
    }
    figures.push(("state", format!("{} bytes on a 64-bit machine", state_bytes(program))));
    figures.push(("posted events", at_most(1)));
    figures.push(("external events waiting", at_most(settings.inbox as usize)));
    let deferred = program.deferred.len();
    let room = if settings.queue && deferred > 0 { program.deferred_room } else { deferred };
    figures.push(("deferred goals waiting", at_most(room)));
    let preemptive = program.external.iter().filter(|external| external.preemptive).count()
        + program.asked.iter().filter(|asked| asked.preemptive).count();
    figures.push(("pre-empting events", preemptive.to_string()));
    if program.has_peers() {
        let rooms = program.asked.iter().map(|asked| asked.room).sum();
        figures.push(("goals of peers waiting", at_most(rooms)));
    }
    if let Some(version) = program.configuration.messages_version() {
        figures.push(("version of the messages", version.to_string()));
    }
    figures
}

impl fmt::Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (label, value) in &self.figures {
            writeln!(formatter, "{label:<28}{value}")?;
        }
        if let Some((compiler, bytes)) = &self.stack {
            let label = "stack of next_step()";
            writeln!(formatter, "{label:<28}{bytes} bytes and what the actions take ({compiler})")?;
        }
        if let Some((compiler, instructions)) = &self.path {
            let label = "longest path of next_step()";
            writeln!(
                formatter,
                "{label:<28}{instructions} instructions and what the actions take ({compiler}); \
                 {:.4} % of 30 ms at a thousand million a second",
                share_percent(*instructions)
            )?;
        }
        if let Some(instructions) = self.costliest {
            let label = "costliest step found";
            writeln!(
                formatter,
                "{label:<28}{instructions} instructions of the same code (callgrind)"
            )?;
        }
        for (title, rows) in [
            ("calls in a step that handles an event", &self.actions),
            ("calls of any action of a class", &self.classes),
        ] {
            if !rows.is_empty() {
                writeln!(formatter, "\n{title}")?;
            }
            for (name, fewest, most) in rows {
                let (fewest, most) = (bound(*fewest), bound(*most));
                writeln!(formatter, "  {name:<26}{fewest} to {most}")?;
            }
        }
        Ok(())
    }
}
