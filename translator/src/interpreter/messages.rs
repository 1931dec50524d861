//! What peers say, and whose turn it is to be heard.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::evaluate::Substitution;
use super::story::with_values;
use super::{Environment, Event, Interpreter, Key, Origin, Value};
use crate::syntax::ast::{Atom, Expression, Operator, Performative, TriggerKind};
use crate::types::CType;

/// A belief or goal, and the peer that it comes from.
pub(super) type Said = (String, usize);

/// What peers have said.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Mail {
    /// The peer that the agent is.
    pub(super) me: usize,
    /// The last values of beliefs, and whether they are believed still.
    told: BTreeMap<Said, (bool, Vec<Value>)>,
    /// When that was told, if the age is asked for anywhere.
    told_at: BTreeMap<Said, Value>,
    /// Beliefs that have changed since that was noticed.
    changed: BTreeSet<Said>,
    asked: BTreeMap<Said, VecDeque<Vec<Value>>>,
    /// The peers that are heard first.
    asked_turn: usize,
    told_turn: usize,
    /// For each goal that pre-empts.
    urgent_turns: BTreeMap<String, usize>,
}

impl Mail {
    /// Forgets what waits, not what is believed.
    pub(super) fn clear(&mut self) {
        self.changed.clear();
        self.asked.clear();
        (self.asked_turn, self.told_turn) = (0, 0);
        self.urgent_turns.clear();
    }

    pub(super) fn is_asked(&self, said: &Said) -> bool {
        self.asked.get(said).is_some_and(|waiting| !waiting.is_empty())
    }

    /// Whether a change waits, and what was told is believed then or not.
    pub(super) fn has_changed(&self, said: &Said, believed: bool) -> bool {
        self.changed.contains(said)
            && self.told.get(said).is_some_and(|(held, _)| *held == believed)
    }

    /// What is believed.
    pub(super) fn told(&self) -> impl Iterator<Item = (&str, usize, &[Value])> {
        let held = self.told.iter().filter(|(_, (held, _))| *held);
        held.map(|((name, sender), (_, values))| (name.as_str(), *sender, values.as_slice()))
    }

    /// Forgets all that was said.
    pub(super) fn reset(&mut self) {
        *self = Self { me: self.me, ..Self::default() };
    }
}

impl Interpreter {
    /// Decides which of its peers the agent is, and resets it.
    pub fn be(&mut self, peer: usize) {
        self.mail.me = peer;
        self.init();
    }

    /// A message arrives. False if it is refused: it is not declared, this peer may not send it, no plan achieves its goal,
    /// or too many goals of it wait.
    pub fn receive(
        &mut self,
        from: usize,
        performative: Performative,
        name: &str,
        values: Vec<Value>,
        environment: &mut dyn Environment,
    ) -> bool {
        let Some(message) = self.configuration.message(performative, name) else { return false };
        if from == self.mail.me || !message.senders.contains(&from) {
            return false;
        }
        let goal = (Operator::Add, TriggerKind::Achieve, name.to_owned());
        if performative.declared() == Performative::Achieve && !self.has_plans(&goal) {
            return false;
        }
        let (room, said) = (message.room, (name.to_owned(), from));
        match performative {
            Performative::Tell => {
                if self.is_news(from, performative, name, &values) {
                    self.mail.changed.insert(said.clone());
                }
                if self.asks_age(&said) {
                    let now = self
                        .clock()
                        .and_then(|(clock, ctype)| environment.call(&clock, &[], &ctype));
                    self.mail.told_at.extend(now.map(|now| (said.clone(), now)));
                }
                self.mail.told.insert(said, (true, values));
            }
            Performative::Untell => {
                if let Some((held, _)) = self.mail.told.get_mut(&said)
                    && std::mem::take(held)
                {
                    self.mail.changed.insert(said);
                }
            }
            Performative::Achieve => {
                let waiting = self.mail.asked.entry(said).or_default();
                if waiting.len() == room {
                    self.refused = self.refused.saturating_add(1);
                    return false;
                }
                waiting.push_back(values);
            }
            Performative::Unachieve => _ = self.mail.asked.remove(&said),
        }
        true
    }

    /// Whether a peer that says this, if that is accepted, asks for something or changes what is believed.
    pub fn is_news(
        &self,
        from: usize,
        performative: Performative,
        name: &str,
        values: &[Value],
    ) -> bool {
        let told = self.mail.told.get(&(name.to_owned(), from)).filter(|(held, _)| *held);
        match performative {
            Performative::Tell => !told.is_some_and(|(_, old)| Value::all_equal(old, values)),
            Performative::Untell => told.is_some(),
            Performative::Achieve => true,
            Performative::Unachieve => false,
        }
    }

    /// The values of an event with its source, if its plans are told; the agent or its environment has caused it.
    pub(super) fn own(&self, kind: TriggerKind, name: &str, mut values: Vec<Value>) -> Vec<Value> {
        if self.configuration.is_sourced(kind, name) {
            values.push(peer(self.mail.me));
        }
        values
    }

    /// The types of an event's values, and its source if its plans are told.
    pub(super) fn event_types(&self, key: &Key) -> Vec<CType> {
        let mut types = self.types(&key.2);
        types.extend(self.configuration.is_sourced(key.1, &key.2).then(CType::peer));
        types
    }

    /// The next peer that waits with a goal, from this one on, and what it gives the goal.
    fn next_asked(&mut self, goal: &str, sender: usize) -> Option<Event> {
        let waiting = self.mail.asked.get_mut(&(goal.to_owned(), sender));
        let mut arguments = waiting.and_then(VecDeque::pop_front)?;
        arguments.push(peer(sender));
        let key = (Operator::Add, TriggerKind::Achieve, goal.to_owned());
        Some(Event { key, arguments, origin: Origin::Agent })
    }

    /// The next event of a goal that pre-empts.
    pub(super) fn next_urgent(&mut self, goal: &str) -> Option<Event> {
        let peers = self.configuration.peers.len();
        let first = self.mail.urgent_turns.get(goal).copied().unwrap_or_default();
        let (sender, event) = in_turn(first, peers)
            .find_map(|sender| Some((sender, self.next_asked(goal, sender)?)))?;
        self.mail.urgent_turns.insert(goal.to_owned(), (sender + 1) % peers);
        Some(event)
    }

    /// The next message that has plans: goals first, then beliefs that were told or taken back.
    pub(super) fn next_message(&mut self) -> Option<Event> {
        let configuration = std::sync::Arc::clone(&self.configuration);
        let peers = configuration.peers.len();
        let names = |performative| {
            let all = configuration.messages.iter();
            all.filter(move |message| message.performative == performative)
                .map(|message| message.name.text.clone())
        };
        for sender in in_turn(self.mail.asked_turn, peers) {
            // What pre-empts has been looked for before.
            for name in names(Performative::Achieve) {
                if let Some(event) = self.next_asked(&name, sender) {
                    self.mail.asked_turn = (sender + 1) % peers;
                    return Some(event);
                }
            }
        }
        while !self.mail.changed.is_empty() {
            let said = in_turn(self.mail.told_turn, peers).find_map(|sender| {
                let mut names = names(Performative::Tell).map(|name| (name, sender));
                names.find(|said| self.mail.changed.contains(said))
            })?;
            self.mail.changed.remove(&said);
            let Some((held, values)) = self.mail.told.get(&said) else { continue };
            let operator = if *held { Operator::Add } else { Operator::Delete };
            let mut arguments = values.clone();
            arguments.push(peer(said.1));
            let key = (operator, TriggerKind::Belief, said.0.clone());
            let other = (Operator::Add, TriggerKind::Belief, said.0.clone());
            let opposite = (Operator::Delete, TriggerKind::Belief, said.0);
            // Without any plans nobody notices.
            if self.has_plans(&other) || self.has_plans(&opposite) {
                self.mail.told_turn = (said.1 + 1) % peers;
            }
            if self.has_plans(&key) {
                return Some(Event { key, arguments, origin: Origin::Agent });
            }
        }
        None
    }

    /// Such goals that peers ask for, without their order of service.
    pub(super) fn asked_for(&self, is_such: impl Fn(&str) -> bool) -> Vec<String> {
        let asked = self.mail.asked.iter().filter(|((goal, _), _)| is_such(goal));
        let goals = asked.flat_map(|((goal, sender), waiting)| {
            waiting.iter().map(move |values| {
                let head = with_values(&format!("+!{goal}"), values);
                format!("{head}[source({})]", self.peer_text(&peer(*sender)))
            })
        });
        goals.collect()
    }

    /// What waits of what peers said and does not pre-empt, without its order of service.
    pub(super) fn said(&self) -> Vec<String> {
        let configuration = &self.configuration;
        let name = |number: usize| configuration.peers.get(number).map_or("?", |peer| &peer.text);
        let preempts = |goal: &str| configuration.preemptive.iter().any(|t| t.name.text == goal);
        let asked = self.asked_for(|goal| !preempts(goal)).into_iter();
        let changed = self.mail.changed.iter().filter(|(belief, _)| {
            [Operator::Add, Operator::Delete]
                .into_iter()
                .any(|operator| self.has_plans(&(operator, TriggerKind::Belief, belief.clone())))
        });
        let changed = changed
            .map(|(belief, sender)| format!("a change of {belief}[source({})]", name(*sender)));
        asked.chain(changed).collect()
    }

    /// The name of a peer.
    pub(super) fn peer_text(&self, value: &Value) -> String {
        let number = match value {
            Value::Integer(number) => usize::try_from(*number).ok(),
            _ => None,
        };
        let peer = number.and_then(|number| self.configuration.peers.get(number));
        peer.map_or_else(|| value.to_string(), |peer| peer.text.clone())
    }

    /// The peer that the agent is.
    pub(super) fn me(&self) -> Value {
        peer(self.mail.me)
    }

    /// All peers but the agent, in their order.
    pub(super) fn other_peers(&self) -> Vec<Value> {
        let all = 0..self.configuration.peers.len();
        all.filter(|number| *number != self.mail.me).map(peer).collect()
    }

    /// The peer of a name without arguments; `self` is the agent.
    pub(super) fn peer_named(&self, atom: &Atom) -> Option<Value> {
        if self.configuration.peers.is_empty() || !atom.arguments.is_empty() {
            return None;
        }
        let number = match atom.name.text.as_str() {
            "self" => Some(self.mail.me),
            name => self.configuration.peer(name),
        };
        number.map(peer)
    }

    /// A belief that peers tell.
    pub(super) fn told<'a>(&self, condition: &'a Expression) -> Option<&'a Atom> {
        let Expression::Atom(atom) = condition else { return None };
        self.configuration.message(Performative::Tell, &atom.name.text).map(|_| atom)
    }

    /// Matches a belief and the rest of its context: one's own, then those of the peers in their order.
    pub(super) fn found(
        &self,
        atom: &Atom,
        rest: &[&Expression],
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Substitution> {
        let name = &atom.name.text;
        // What is one's own has no age.
        let own = self.beliefs.get(name).filter(|_| atom.age.is_none());
        let own = own.map(|values| (self.mail.me, values));
        let told = (0..self.configuration.peers.len()).filter_map(|sender| {
            let (held, values) = self.mail.told.get(&(name.clone(), sender))?;
            held.then_some((sender, values))
        });
        let types = self.types(name);
        // A peer that is named is the only one that is looked at, besides what is one's own.
        let named = match atom.source.as_deref() {
            Some(Expression::Atom(source)) => self.peer_named(source),
            _ => None,
        };
        let told =
            told.filter(|(sender, _)| named.as_ref().is_none_or(|named| *named == peer(*sender)));
        for (sender, values) in own.into_iter().chain(told) {
            let found = peer(sender);
            // Who is known already is compared before the arguments are evaluated.
            let mut theta = theta.clone();
            let source = atom.source.as_deref();
            let is_known = match source {
                Some(Expression::Variable(name)) => theta.get(&name.text).is_some(),
                _ => true,
            };
            let mut matches = || {
                if let Some(source) = source.filter(|_| is_known) {
                    self.match_pattern(source, &found, &CType::peer(), &mut theta, environment)?;
                }
                for ((pattern, value), ctype) in atom.arguments.iter().zip(values).zip(&types) {
                    self.match_pattern(pattern, value, ctype, &mut theta, environment)?;
                }
                if let Some(source) = source.filter(|_| !is_known) {
                    self.match_pattern(source, &found, &CType::peer(), &mut theta, environment)?;
                }
                match &atom.age {
                    Some(wanted) => {
                        let told_at = self.mail.told_at.get(&(name.clone(), sender));
                        self.match_age(wanted, told_at, &mut theta, environment)
                    }
                    None => Some(()),
                }
            };
            if matches().is_none() {
                continue;
            }
            if let Some(theta) = self.conjunction(rest, &theta, environment) {
                return Some(theta);
            }
        }
        None
    }
}

fn peer(number: usize) -> Value {
    Value::Integer(i128::try_from(number).unwrap_or(i128::MAX))
}

/// All peers, beginning with this one.
fn in_turn(first: usize, peers: usize) -> impl Iterator<Item = usize> {
    (0..peers).map(move |offset| (first + offset) % peers)
}
