//! Interpretation of SPIN's replays: counterexamples in the agents' terms.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::backend::promela::{MARK, NETWORK, Waiting, events, kinds};
use crate::configuration::ExternalTrigger;
use crate::program::{Program, trigger_text};
use crate::syntax::ast::{Name, Performative};
use crate::system::System;

/// A line of a counterexample, or of the interpreter's log, in the agent's terms.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct CounterexampleStep {
    /// Nesting depth: 0 for the environment and for steps, 1 for events and plans, 2 for the actions of plans. In the
    /// interpreter's log, what a formula's plans do is below the formula: 3, 4, and so on.
    pub depth: usize,
    /// The line of the agent's source, counted from 1, if there is one.
    pub line: Option<usize>,
    /// Description.
    pub text: String,
}

impl CounterexampleStep {
    /// A line with these parts.
    pub fn new(depth: usize, line: Option<usize>, text: String) -> Self {
        Self { depth, line, text }
    }
}

impl fmt::Display for CounterexampleStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let indentation = "  ".repeat(self.depth);
        match self.line {
            Some(line) => write!(f, "{indentation}line {line}: {}", self.text),
            None => write!(f, "{indentation}{}", self.text),
        }
    }
}

/// Something that happens in a counterexample of a system. Agents are indices into [`System::members`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Move {
    /// The environment raises an event of an agent.
    Raise(usize, ExternalTrigger),
    /// The environment sets a belief of an agent.
    Set(usize, String),
    /// A message arrives.
    Arrives(UnderWay),
    /// A message is lost.
    IsLost(UnderWay),
    /// An agent makes its step; the first and last lines of the plans that it chooses, counted from 1.
    Step(usize, Vec<(usize, usize)>),
}

/// A message that is under way. Sender and receiver are indices into [`System::members`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnderWay {
    /// The sender.
    pub from: usize,
    /// The receiver.
    pub to: usize,
    /// What it is.
    pub performative: Performative,
    /// The belief or goal.
    pub about: String,
}

/// A line of a replay: who it is about, what happens, and numbers that depend on that.
struct Line<'a> {
    who: &'a str,
    what: &'a str,
    numbers: Vec<usize>,
}

fn lines(replay: &str) -> Vec<Line<'_>> {
    let marked = replay.lines().filter_map(|line| line.trim().strip_prefix(MARK));
    marked
        .filter_map(|line| {
            let (who, rest) = line.split_once(' ')?;
            let mut words = rest.split_whitespace();
            let what = words.next()?;
            Some(Line { who, what, numbers: words.filter_map(|n| n.parse().ok()).collect() })
        })
        .collect()
}

/// The counterexample of one agent.
pub(crate) fn of_agent(program: &Program, replay: &str) -> Vec<CounterexampleStep> {
    let lines = lines(replay);
    let mut happenings: Vec<CounterexampleStep> = Vec::new();
    let mut steps = 0_usize;
    let mut idle_from = None;
    for (index, Line { what, numbers, .. }) in lines.iter().enumerate() {
        if *what != "step" {
            happenings.extend(happening(program, what, numbers));
            continue;
        }
        steps += 1;
        let next = lines.get(index + 1).map(|line| line.what);
        let handles = next == Some("event");
        let text = match idle_from.filter(|_| !handles) {
            // Consecutive steps without an event share one line.
            Some(first) => {
                happenings.pop();
                format!("steps {first} to {steps}: no event is pending")
            }
            None if handles => format!("step {steps}"),
            None => format!("step {steps}: no event is pending"),
        };
        happenings.push(CounterexampleStep::new(0, None, text));
        let alone = next.is_none_or(|next| next == "step");
        idle_from = (!handles && alone).then(|| idle_from.unwrap_or(steps));
    }
    happenings
}

/// The counterexample of a system: what happens to each agent is below its name.
pub(crate) fn of_system(system: &System, replay: &str) -> Vec<CounterexampleStep> {
    let lines = lines(replay);
    let mut round = 1_usize;
    let mut happenings = Vec::new();
    for (index, Line { who, what, numbers }) in lines.iter().enumerate() {
        let member = member(system, who);
        let text = match (member, *what) {
            (None, "round") => {
                round += 1;
                // It is the end of the counterexample, too.
                let is_last = index + 1 == lines.len();
                if is_last { "the round ends".to_owned() } else { format!("round {round}") }
            }
            (None, _) => match under_way(system, numbers) {
                Some(message) => format!("{} is lost", message.text(system)),
                None => continue,
            },
            (Some(to), "hears") => match heard(system, to, numbers) {
                Some(message) => message.text(system),
                None => continue,
            },
            (Some(member), "step") => {
                let handles = lines.get(index + 1).is_some_and(|next| next.what == "event");
                let idle = if handles { "" } else { ": no event is pending" };
                format!("{} makes its step{idle}", system.members[member].name)
            }
            (Some(member), _) => {
                let of = &system.members[member];
                let found = happening(&of.program, what, numbers);
                happenings.extend(found.map(|mut happening| {
                    if happening.depth == 0 {
                        happening.text = format!("{}: {}", of.name, happening.text);
                    }
                    happening
                }));
                continue;
            }
        };
        happenings.push(CounterexampleStep::new(0, None, text));
    }
    if !happenings.is_empty() {
        happenings.insert(0, CounterexampleStep::new(0, None, "round 1".to_owned()));
    }
    happenings
}

/// What happens in the counterexample of a system, for those who repeat it.
pub(crate) fn moves(system: &System, replay: &str) -> Vec<Move> {
    let lines = lines(replay);
    let mut moves = Vec::new();
    for Line { who, what, numbers } in &lines {
        let Some(member) = member(system, who) else {
            moves.extend(under_way(system, numbers).map(Move::IsLost));
            continue;
        };
        let program = &system.members[member].program;
        let first = numbers.first().copied();
        match (*what, first) {
            ("hears", _) => moves.extend(heard(system, member, numbers).map(Move::Arrives)),
            ("step", _) => moves.push(Move::Step(member, Vec::new())),
            ("raise", Some(number)) => {
                let Some(Waiting::External(index)) =
                    number.checked_sub(1).and_then(|n| events(program).get(n).copied())
                else {
                    continue;
                };
                let external = &program.external[index];
                let name = Name { text: external.name.clone(), span: 0..0 };
                let (operator, kind) = (external.operator, external.kind);
                moves.push(Move::Raise(
                    member,
                    ExternalTrigger { operator, kind, name, source: None, span: 0..0 },
                ));
            }
            ("set", Some(belief)) => {
                let belief = program.beliefs.get(belief);
                moves.extend(belief.map(|belief| Move::Set(member, belief.name.clone())));
            }
            ("plan", Some(number)) => {
                if let (Some(Move::Step(_, plans)), Some((.., plan))) =
                    (moves.last_mut(), program.plans().nth(number))
                {
                    plans.push(plan.lines);
                }
            }
            _ => {}
        }
    }
    moves
}

/// The agent that a line is about.
fn member(system: &System, who: &str) -> Option<usize> {
    if who == NETWORK { None } else { system.peer(who.parse().ok()?) }
}

/// A lost message: sender, receiver, kind.
fn under_way(system: &System, numbers: &[usize]) -> Option<UnderWay> {
    let [from, to, kind, ..] = numbers else { return None };
    let (performative, about) = *kinds(system).get(*kind)?;
    let (from, to) = (system.peer(*from)?, system.peer(*to)?);
    Some(UnderWay { from, to, performative, about: about.to_owned() })
}

/// A message that has arrived: sender, kind.
fn heard(system: &System, to: usize, numbers: &[usize]) -> Option<UnderWay> {
    let [from, kind, ..] = numbers else { return None };
    under_way(system, &[*from, system.members[to].peer, *kind])
}

impl UnderWay {
    /// `first -> second: tell low`
    fn text(&self, system: &System) -> String {
        let name = |member: usize| system.members[member].name.as_str();
        let (from, to) = (name(self.from), name(self.to));
        format!("{from} -> {to}: {} {}", self.performative.name(), self.about)
    }
}

fn happening(program: &Program, what: &str, numbers: &[usize]) -> Option<CounterexampleStep> {
    let at = |depth, line, text| Some(CounterexampleStep { depth, line, text });
    let first = numbers.first().copied();
    match what {
        "raise" => at(0, None, format!("the environment raises {}", event(program, first?)?)),
        "set" => {
            let belief = program.beliefs.get(first?)?;
            at(0, None, format!("the environment sets `{}`", belief.name))
        }
        "asks" | "unasks" => {
            let asked = program.asked.get(first?)?;
            let peer = &program.configuration.peers.get(asked.sender)?.text;
            let what = if what == "asks" { "asks for" } else { "no longer asks for" };
            at(0, None, format!("{peer} {what} `{}`", asked.name))
        }
        "tells" | "untells" => {
            let told = program.told.get(first?)?;
            let peer = &program.configuration.peers.get(told.sender)?.text;
            let what = if what == "tells" { "tells" } else { "takes back" };
            at(0, None, format!("{peer} {what} `{}`", told.name))
        }
        "event" => at(1, None, format!("handles {}", event(program, first?)?)),
        "plan" => {
            let (_, _, plan) = program.plans().nth(first?)?;
            let head = plan.source.split("<-").next().unwrap_or_default();
            let head = head.split_whitespace().collect::<Vec<_>>().join(" ");
            at(1, Some(plan.lines.0), format!("plan {head}"))
        }
        "action" => {
            let basic = program.configuration.basics.get(first?)?;
            at(2, numbers.get(1).copied().filter(|line| *line > 0), basic.name.text.clone())
        }
        "fails" => at(2, first, "fails".to_owned()),
        "unplanned" => {
            let handler = program.handlers.get(first?)?;
            at(1, None, format!("no plan for {} applies", handler.text()))
        }
        _ => None,
    }
}

/// Description of an event by its number, with its cause.
fn event(program: &Program, number: usize) -> Option<String> {
    let handler = |id| program.handler(id).text();
    Some(match events(program).get(number.checked_sub(1)?)? {
        Waiting::Posted(id) => handler(*id),
        Waiting::Overdue(id) => format!("the deadline of {}", handler(*id)),
        Waiting::Perceived(_, id) => format!("{}, which was perceived", handler(*id)),
        Waiting::Asked(index) => {
            let asked = program.asked.get(*index)?;
            let peer = &program.configuration.peers.get(asked.sender)?.text;
            format!("+!{}[source({peer})]", asked.name)
        }
        Waiting::Told(index) => {
            let told = program.told.get(*index)?;
            let peer = &program.configuration.peers.get(told.sender)?.text;
            format!("what {peer} said of `{}`", told.name)
        }
        Waiting::External(index) => {
            let external = program.external.get(*index)?;
            trigger_text(external.operator, external.kind, &external.name)
        }
        Waiting::Deferred(id) => format!("{}, which was deferred", handler(*id)),
    })
}
