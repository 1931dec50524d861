//! What peers say: any of it at any time, and senders in turn.

use super::logic::not;
use super::{Emission, Waiting};
use crate::configuration::ExternalTrigger;
use crate::program::{Asked, Said, Told};
use crate::syntax::ast::Operator;

/// A kind of messages that wait: those of one sender are served in their order, senders in turn.
struct Kind {
    turn: String,
    /// For each sender: whether something waits, what taking it changes, and its event.
    slots: Vec<(usize, String, String, Waiting)>,
}

impl Emission<'_> {
    fn is_noticed(told: &Told) -> bool {
        told.added.is_some() || told.removed.is_some()
    }

    /// Such goals that peers ask for.
    fn asked(&self, turn: String, is_such: impl Fn(&Asked) -> bool) -> Kind {
        let asked = self.program.asked.iter().enumerate().filter(|(_, asked)| is_such(asked));
        let asked = asked.map(|(index, asked)| {
            let count = format!("asked_{index}");
            (asked.sender, format!("{count} > 0"), format!("{count}--"), Waiting::Asked(index))
        });
        Kind { turn, slots: asked.collect() }
    }

    /// What does not pre-empt.
    fn kinds(&self) -> [Kind; 2] {
        let told = self.program.told.iter().enumerate();
        let told = told.filter(|(_, told)| Self::is_noticed(told)).map(|(index, told)| {
            let flag = format!("told_{index}");
            (told.sender, flag.clone(), format!("{flag} = false"), Waiting::Told(index))
        });
        [
            self.asked("asked_turn".to_owned(), |asked| !asked.preemptive),
            Kind { turn: "told_turn".to_owned(), slots: told.collect() },
        ]
    }

    pub(super) fn declare_messages(&mut self) {
        if !self.program.has_peers() {
            return;
        }
        self.writer.line("byte asked_turn, told_turn; /* the sender that is heard first */");
        for goal in self.program.urgent() {
            self.writer.line(format!("byte urgent_turn_{goal};"));
        }
        for index in 0..self.program.asked.len() {
            self.writer.line(format!("byte asked_{index};"));
        }
        for (index, told) in self.program.told.iter().enumerate() {
            if Self::is_noticed(told) {
                self.writer.line(format!("bool told_{index};"));
            }
        }
    }

    /// Transitions of the environment: a peer says something.
    pub(super) fn say_something(&mut self) {
        for (index, asked) in self.program.asked.iter().enumerate() {
            self.writer.line(format!(":: asked_{index} < {} -> asked_{index}++;", asked.room));
            self.on_said(Said::Asked(index), Operator::Add);
            self.say(&format!("asks {index}"));
            self.writer.line("goto finished");
            self.writer.line(format!(":: asked_{index} > 0 ->"));
            self.before_taking_back(Said::Asked(index), Operator::Add);
            self.writer.line(format!("asked_{index} = 0;"));
            self.say(&format!("unasks {index}"));
            self.writer.line("goto finished");
        }
        for (index, told) in self.program.told.iter().enumerate() {
            let held = self.held(told.belief);
            let guard = if Self::is_noticed(told) { "true".to_owned() } else { not(&held) };
            self.writer.line(format!(":: {guard} ->"));
            self.believe_told(index);
            self.say(&format!("tells {index}"));
            self.writer.line("goto finished");
            self.writer.line(format!(":: {held} ->"));
            self.forget_told(index);
            self.say(&format!("untells {index}"));
            self.writer.line("goto finished");
        }
    }

    /// A peer tells a belief, with any values.
    pub(super) fn believe_told(&mut self, index: usize) {
        let told = &self.program.told[index];
        if Self::is_noticed(told) {
            let said = Said::Told(index);
            self.before_taking_back(said, Operator::Delete);
            // The same value is not a change.
            let held = self.held(told.belief);
            let has_values = !self.program.belief(told.belief).types.is_empty();
            let change = if has_values { "true".to_owned() } else { not(&held) };
            self.writer.line("if");
            self.writer.line(format!(":: {change} -> told_{index} = true;"));
            self.on_said(said, Operator::Add);
            self.writer.line("skip");
            self.writer.line(format!(":: {held}"));
            self.writer.line("fi;");
        }
        self.believe(told.belief);
    }

    /// A peer takes back a belief that is held.
    pub(super) fn forget_told(&mut self, index: usize) {
        let told = &self.program.told[index];
        let (belief, said) = (told.belief, Said::Told(index));
        if Self::is_noticed(told) {
            self.before_taking_back(said, Operator::Add);
            self.writer.line(format!("told_{index} = true;"));
        }
        self.forget(belief);
        self.on_said(said, Operator::Delete);
    }

    /// Whether a peer has said what causes this event, and waits, as an expression.
    pub(super) fn waits_to_be_heard(&self, event: &ExternalTrigger) -> String {
        match self.program.said(event) {
            Some(Said::Asked(index)) => format!("asked_{index} > 0"),
            Some(Said::Told(index)) => {
                let held = self.held(self.program.told[index].belief);
                let held = if event.operator == Operator::Add { held } else { not(&held) };
                format!("(told_{index} && {held})")
            }
            None => "false".to_owned(),
        }
    }

    /// Takes what the next sender says, if anybody has said something. `before` is what waits with a higher priority.
    pub(super) fn take_messages(&mut self, before: &mut Vec<String>) {
        for kind in self.kinds() {
            self.take_in_turn(&kind, "", before);
        }
    }

    /// Takes this goal, which pre-empts, if a peer asks for it.
    pub(super) fn take_urgent(&mut self, goal: &str, before: &mut Vec<String>) {
        let turn = format!("urgent_turn_{goal}");
        let kind = self.asked(turn, |asked| asked.preemptive && asked.name == goal);
        self.take_in_turn(&kind, " posted = 0; limited = 0;", before);
    }

    fn take_in_turn(&mut self, kind: &Kind, first: &str, before: &mut Vec<String>) {
        let peers = self.program.configuration.peers.len();
        let Kind { turn, slots } = kind;
        if slots.is_empty() {
            return;
        }
        let waiting: Vec<&str> = slots.iter().map(|(_, waiting, ..)| waiting.as_str()).collect();
        let waiting = format!("({})", waiting.join(" || "));
        let mut all = before.clone();
        all.push(waiting.clone());
        self.writer.line(format!(":: {} ->{first}", all.join(" && ")));
        self.writer.line("do");
        for sender in 0..peers {
            let next = (sender + 1) % peers;
            let mut guard = vec![format!("{turn} == {sender}")];
            for (_, waiting, taken, event) in slots.iter().filter(|(own, ..)| *own == sender) {
                let number = self.number(*event);
                self.writer.line(format!(
                    ":: {} && {waiting} -> {taken}; event = {number}; {turn} = {next}; break",
                    guard.join(" && ")
                ));
                guard.push(format!("!({waiting})"));
            }
            self.writer.line(format!(":: {} -> {turn} = {next}", guard.join(" && ")));
        }
        self.writer.line("od");
        before.push(format!("!{waiting}"));
    }

    /// Handles what a peer told or took back.
    pub(super) fn handle_told(&mut self, index: usize) {
        let told = &self.program.told[index];
        let (belief, added, removed) = (told.belief, told.added, told.removed);
        let sender = told.sender.to_string();
        let held = self.held(belief);
        self.writer.line("if");
        self.writer.line(format!(":: {held} ->"));
        self.run_from_or_take(added, &sender);
        self.writer.line(":: else ->");
        self.run_from_or_take(removed, &sender);
        self.writer.line("fi");
    }
}
