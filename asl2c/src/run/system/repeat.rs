//! Repeats a counterexample of the model, which has no values, with agents that have them.
//!
//! A search in depth: the values of events and beliefs, and the results of functions in each step, are chosen so that
//! every agent chooses the plans of the counterexample.

use rand::seq::SliceRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use translator::configuration::Configuration;
use translator::interpreter::Value;
use translator::types::{CType, TypeKind};
use translator::{Move, UnderWay};

use super::{Now, State, SystemSession};
use crate::run::script::{call_name, parameters};
use crate::run::transcript::Runs as _;
use crate::run::values::{numbers, zero};

/// Lines that are executed at most. A counterexample without values that fit cannot be told from one whose values are rare.
const MOST: u32 = 40_000;
/// Those of them that are tried one after the other; then values are chosen at random.
const IN_ORDER: u32 = 5_000;
/// Choices at one place.
const MOST_CHOICES: usize = 64;

/// A script in which the agents do what a counterexample of the model says and a property is violated, if values for it are
/// found.
pub fn repeat(session: &mut SystemSession<'_>, moves: &[Move], property: &str) -> Option<String> {
    let mut search = Search {
        session,
        moves,
        property,
        left: IN_ORDER,
        // The same script each time.
        random: ChaCha8Rng::seed_from_u64(1),
        is_random: false,
        lines: Vec::new(),
    };
    let start = search.state();
    let mut found = search.from(0);
    search.is_random = true;
    search.left = MOST - IN_ORDER;
    while !found && search.left > 0 && !moves.is_empty() {
        search.restore(start.clone());
        found = search.from(0);
    }
    found.then(|| search.lines.join("\n") + "\n")
}

struct Search<'s, 'a> {
    session: &'s mut SystemSession<'a>,
    moves: &'s [Move],
    property: &'s str,
    left: u32,
    random: ChaCha8Rng,
    /// Whether values are chosen at random, and never again before a new start.
    is_random: bool,
    lines: Vec<String>,
}

impl Search<'_, '_> {
    /// Repeats the moves from this one on. If it fails, the session is as before.
    fn from(&mut self, index: usize) -> bool {
        let Some(next) = self.moves.get(index) else { return false };
        let mut choices = self.choices(next);
        if self.is_random {
            // What has not changed is the most plausible.
            let fixed = usize::from(self.random.random::<bool>()).min(choices.len());
            choices[fixed..].shuffle(&mut self.random);
        }
        for line in choices {
            if self.left == 0 {
                return false;
            }
            self.left -= 1;
            let before = self.state();
            let count = self.lines.len();
            let fits = self.session.execute(&line).is_ok() && self.is_as(next);
            self.lines.push(line);
            let is_broken = self.session.broken().iter().any(|name| name == self.property);
            if fits && (is_broken || self.from(index + 1)) {
                return true;
            }
            self.lines.truncate(count);
            self.restore(before);
            if fits && self.is_random {
                return false;
            }
        }
        false
    }

    fn state(&self) -> (Vec<State>, Now) {
        (self.session.states(), self.session.now.clone())
    }

    fn restore(&mut self, before: (Vec<State>, Now)) {
        self.session.restore(before);
        self.session.before.clear();
    }

    /// Whether the agent that has made its step has chosen the plans.
    fn is_as(&self, wanted: &Move) -> bool {
        let Move::Step(member, plans) = wanted else { return true };
        let story = &self.session.agents[*member].now.world.story;
        let chosen = story.iter().filter(|told| told.text.starts_with("plan "));
        let chosen: Vec<usize> = chosen.filter_map(|told| told.line).collect();
        chosen.len() == plans.len()
            && chosen.iter().zip(plans).all(|(line, (first, last))| (first..=last).contains(&line))
    }

    /// Lines that may be the move.
    fn choices(&self, next: &Move) -> Vec<String> {
        let system = self.session.system;
        let configuration = |member: usize| system.members[member].configuration.declarations();
        match next {
            Move::Raise(member, event) => self.calls(
                *member,
                &call_name(event),
                parameters(configuration(*member), &event.name.text),
            ),
            Move::Set(member, belief) => self.calls(
                *member,
                &format!("set_{belief}"),
                parameters(configuration(*member), belief),
            ),
            Move::Arrives(message) => self.channel("deliver", message),
            Move::IsLost(message) => self.channel("lose", message),
            Move::Step(member, _) => {
                let declared = configuration(*member);
                let functions =
                    declared.basics.iter().filter(|basic| basic.result.kind != TypeKind::Void);
                let functions: Vec<(&str, Vec<String>)> = functions
                    .map(|basic| {
                        (basic.name.text.as_str(), self.values(*member, &basic.result, declared))
                    })
                    .collect();
                let name = &system.members[*member].name;
                // First the results that the functions have already.
                let unchanged = format!("{name}: next_step();");
                let chosen = combinations(
                    &functions.iter().map(|(_, values)| values.len()).collect::<Vec<_>>(),
                );
                let lines = chosen.into_iter().map(|choice| {
                    let results =
                        functions.iter().zip(choice).map(|((function, values), chosen)| {
                            format!("{function}_result = {}; ", values[chosen])
                        });
                    format!("{name}: {}next_step();", results.collect::<String>())
                });
                std::iter::once(unchanged).chain(lines).collect()
            }
        }
    }

    /// Calls of an agent's function with possible values.
    fn calls(&self, member: usize, function: &str, types: &[CType]) -> Vec<String> {
        let of = &self.session.system.members[member];
        let declared = of.configuration.declarations();
        let values: Vec<Vec<String>> =
            types.iter().map(|ctype| self.values(member, ctype, declared)).collect();
        let counts: Vec<usize> = values.iter().map(Vec::len).collect();
        let calls = combinations(&counts).into_iter().map(|choice| {
            let arguments =
                values.iter().zip(choice).map(|(values, chosen)| values[chosen].clone());
            format!("{}: {function}({});", of.name, arguments.collect::<Vec<_>>().join(", "))
        });
        calls.collect()
    }

    /// The oldest message of this kind.
    fn channel(&self, command: &str, wanted: &UnderWay) -> Vec<String> {
        let between = self.session.now.network.between(wanted.from, wanted.to);
        let place = between.enumerate().find(|(_, (_, message))| {
            (message.performative, &message.about) == (wanted.performative, &wanted.about)
        });
        let Some((place, _)) = place else { return Vec::new() };
        let (from, to) = (self.session.name(wanted.from), self.session.name(wanted.to));
        let number = if place == 0 { String::new() } else { format!(" {}", place + 1) };
        vec![format!("{command} {from} {to}{number}")]
    }

    /// Values of a type that may make a difference: those in the agent's text, and their neighbours.
    fn values(&self, member: usize, ctype: &CType, declared: &Configuration) -> Vec<String> {
        match ctype.kind {
            TypeKind::Bool => vec!["false".to_owned(), "true".to_owned()],
            _ if ctype.is_peer() => declared.peers.iter().map(|peer| peer.text.clone()).collect(),
            TypeKind::Signed { .. } | TypeKind::Unsigned { .. } => {
                let (low, high) = ctype.integer_range().unwrap_or((0, 1));
                let numbers = numbers(&self.session.system.members[member].text);
                let mut near: Vec<i128> = numbers
                    .filter_map(|number| number.parse::<i128>().ok())
                    .flat_map(|number| [number, number - 1, number + 1])
                    .chain([0, 1])
                    .filter(|number| (low..=high).contains(number))
                    .collect();
                near.sort_unstable();
                near.dedup();
                near.iter().map(i128::to_string).collect()
            }
            TypeKind::Float32 | TypeKind::Float64 => {
                let numbers = numbers(&self.session.system.members[member].text);
                let mut near: Vec<f64> = numbers
                    .filter_map(|number| number.parse::<f64>().ok())
                    .flat_map(|number| [number, number - 1.0, number + 1.0])
                    .chain([0.0])
                    .collect();
                near.sort_unstable_by(f64::total_cmp);
                near.dedup();
                near.into_iter().map(|number| Value::Float(number).to_string()).collect()
            }
            // Their values are never compared.
            TypeKind::Text | TypeKind::Opaque => vec!["\"\"".to_owned()],
            TypeKind::Struct => {
                vec![zero(ctype, declared).to_string()]
            }
            TypeKind::Void => Vec::new(),
        }
    }
}

/// Ways to choose one of so many values at each place.
fn combinations(counts: &[usize]) -> Vec<Vec<usize>> {
    let all = counts.iter().fold(1_usize, |all, count| all.saturating_mul(*count));
    // If there are too many, they are taken evenly.
    let taken = all.min(MOST_CHOICES);
    let choice = |index: usize| {
        let mut rest = index * (all / taken.max(1)).max(1);
        let chosen = counts.iter().map(|count| {
            let chosen = rest % count;
            rest /= count;
            chosen
        });
        chosen.collect()
    };
    (0..taken).map(choice).collect()
}
