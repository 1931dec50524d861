//! What peers say: any of it at any time, and senders in turn.

use super::logic::not;
use super::{Emission, Waiting};
use crate::program::Told;

/// A kind of messages that wait: those of one sender are served in their order, senders in turn.
struct Kind {
    turn: &'static str,
    /// For each sender: whether something waits, what taking it changes, and its event.
    slots: Vec<(usize, String, String, Waiting)>,
}

impl Emission<'_> {
    fn is_noticed(told: &Told) -> bool {
        told.added.is_some() || told.removed.is_some()
    }

    fn kinds(&self) -> [Kind; 2] {
        let asked = self.program.asked.iter().enumerate();
        let asked = asked.map(|(index, asked)| {
            let count = format!("asked_{index}");
            (asked.sender, format!("{count} > 0"), format!("{count}--"), Waiting::Asked(index))
        });
        let told = self.program.told.iter().enumerate();
        let told = told.filter(|(_, told)| Self::is_noticed(told)).map(|(index, told)| {
            let flag = format!("told_{index}");
            (told.sender, flag.clone(), format!("{flag} = false"), Waiting::Told(index))
        });
        [
            Kind { turn: "asked_turn", slots: asked.collect() },
            Kind { turn: "told_turn", slots: told.collect() },
        ]
    }

    pub(super) fn declare_messages(&mut self) {
        if !self.program.has_peers() {
            return;
        }
        self.writer.line("byte asked_turn, told_turn; /* the sender that is heard first */");
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
            self.say(&format!("asks {index}"));
            self.writer.line("goto finished");
            self.writer.line(format!(":: asked_{index} > 0 -> asked_{index} = 0;"));
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
            // The same value is not a change.
            let held = self.held(told.belief);
            let has_values = !self.program.belief(told.belief).types.is_empty();
            let change = if has_values { "true".to_owned() } else { not(&held) };
            self.writer.line("if");
            self.writer.line(format!(":: {change} -> told_{index} = true"));
            self.writer.line(format!(":: {held}"));
            self.writer.line("fi;");
        }
        self.believe(told.belief);
    }

    /// A peer takes back a belief that is held.
    pub(super) fn forget_told(&mut self, index: usize) {
        let told = &self.program.told[index];
        if Self::is_noticed(told) {
            self.writer.line(format!("told_{index} = true;"));
        }
        self.forget(told.belief);
    }

    /// Takes what the next sender says, if anybody has said something. `before` is what waits with a higher priority.
    pub(super) fn take_messages(&mut self, before: &mut Vec<String>) {
        let peers = self.program.configuration.peers.len();
        for Kind { turn, slots } in self.kinds() {
            if slots.is_empty() {
                continue;
            }
            let waiting: Vec<&str> =
                slots.iter().map(|(_, waiting, ..)| waiting.as_str()).collect();
            let waiting = format!("({})", waiting.join(" || "));
            let mut all = before.clone();
            all.push(waiting.clone());
            self.writer.line(format!(":: {} ->", all.join(" && ")));
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
