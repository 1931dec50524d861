//! What an agent costs: memory, call depth, and how often a step calls each action.

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

/// What an agent costs. It is written out by its `Display`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Report {
    figures: Vec<(&'static str, String)>,
    /// Name, fewest and most calls in a step that handles an event.
    actions: Vec<(String, u32, u32)>,
    classes: Vec<(String, u32, u32)>,
    frames: Frames,
    /// The deepest stack, if a compiler has said how large each frame is.
    stack: Option<(String, u64)>,
    /// The instructions of the longest path, if a compiler has made some.
    path: Option<(String, u64)>,
    /// The instructions of the costliest step that was found.
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
        // Functions that only contexts call do nothing; the clock and the trace function are asked by ourselves.
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

    /// Adds the deepest stack of `next_step()`. `frame_bytes` are the sizes of the functions'
    /// frames in the generated C file, as `compiler` gives them; functions that it has put into
    /// others are not among them.
    pub fn add_stack(&mut self, compiler: &str, frame_bytes: &HashMap<String, u64>) {
        self.stack = Some((compiler.to_owned(), self.frames.deepest(frame_bytes)));
    }

    /// The linker's name of `next_step()`.
    pub fn entry(&self) -> &str {
        self.frames.next_step()
    }

    /// Adds the instructions of the longest path through `next_step()`, as `compiler` has made them.
    pub fn add_path(&mut self, compiler: &str, instructions: u64) {
        self.path = Some((compiler.to_owned(), instructions));
    }

    /// Adds the instructions of the costliest step that was found by running the same code.
    pub fn add_costliest(&mut self, instructions: u64) {
        self.costliest = Some(instructions);
    }
}

/// What so many instructions take of a tick of 30 ms, on a slow machine.
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
    figures.push(("plans that nothing triggers", program.left_out.to_string()));
    let lines: Vec<String> =
        never_applicable(program).map(|plan| format!("line {}", plan.lines.0)).collect();
    let never = if lines.is_empty() { "0".to_owned() } else { lines.join(", ") };
    figures.push(("plans never applicable", never));
    if let Some(id) = events.iter().max_by_key(|id| costs[id.0].depth) {
        // next_step, handle_event, then a trigger's function and a plan's for each level.
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
    let preemptive = program.external.iter().filter(|external| external.preemptive).count();
    figures.push(("pre-empting events", preemptive.to_string()));
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
                writeln!(formatter, "  {name:<26}{fewest} to {most}")?;
            }
        }
        Ok(())
    }
}
