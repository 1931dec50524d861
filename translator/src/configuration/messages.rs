//! Sections about agents that talk: who they are, and what they say.

use std::collections::HashSet;

use super::parser::Parser;
use super::scanner::Parsed;
use super::{Message, Predicate};
use crate::code::Code;
use crate::syntax::ast::{Name, Performative};
use crate::types::{CType, TypeKind};

/// Peers are numbered in a byte, and each message has memory for each of its senders.
const MOST_PEERS: usize = 64;
/// Words of the language, which no peer can have as its name.
const NO_PEERS: [&str; 6] = ["self", "any", "true", "false", "not", "mod"];
/// Goals of one sender that may wait.
const MOST_WAITING: usize = 64;

impl Parser<'_> {
    /// `peers { leader, wingman };`, from behind the brace on.
    pub(super) fn peers(&mut self) -> Parsed<()> {
        let first = self.scanner.word("a peer")?;
        for name in self.names(first, "a peer")? {
            let same = |other: &Name| other.text.eq_ignore_ascii_case(&name.text);
            let starts_lower = name.text.starts_with(|c: char| c.is_ascii_lowercase());
            if self.configuration.peers.iter().any(same) {
                let message = format!("a second peer `{}`", name.text);
                self.diagnostics.push(
                    Code::DeclaredTwice
                        .at(message, name.span)
                        .help("in C a peer has its name in capitals: give each another one"),
                );
                continue;
            }
            // It is a peer nevertheless, so that what it says is no error.
            if !starts_lower || NO_PEERS.contains(&name.text.as_str()) {
                let message = format!("`{}` cannot be the name of a peer", name.text);
                self.diagnostics.push(
                    Code::ReservedName
                        .at(message, name.span.clone())
                        .help("it begins with a lower-case letter, and is no word of the language"),
                );
            }
            self.configuration.peers.push(name);
        }
        self.scanner.expect("}")
    }

    /// `tell at(double, double) from any;`, `achieve inspect(double, double) from leader, 4;`. The senders are found later, as
    /// the section `peers` may follow.
    pub(super) fn message(&mut self) -> Parsed<()> {
        let word = self.scanner.word("`tell` or `achieve`")?;
        let start = word.span.start;
        let performative = match word.text.as_str() {
            "tell" => Performative::Tell,
            "achieve" => Performative::Achieve,
            other => {
                let message = format!("expected `tell` or `achieve`, found `{other}`");
                return Err(Code::Syntax.at(message, word.span));
            }
        };
        let name = self.scanner.word("a belief or a goal")?;
        self.scanner.skip_blanks()?;
        let parameters =
            if self.scanner.rest().starts_with('(') { self.parameters()? } else { Vec::new() };
        let from = self.scanner.word("`from` and the senders")?;
        if from.text != "from" {
            let message = format!("expected `from` and the senders, found `{}`", from.text);
            return Err(Code::Syntax.at(message, from.span));
        }
        let mut names = vec![self.scanner.word("a peer, or `any`")?];
        let mut room = 1;
        self.scanner.skip_blanks()?;
        while self.scanner.take(",") {
            self.scanner.skip_blanks()?;
            if performative == Performative::Achieve
                && self.scanner.rest().starts_with(|c: char| c.is_ascii_digit())
            {
                room = self.room()?;
                break;
            }
            names.push(self.scanner.word("a peer")?);
            self.scanner.skip_blanks()?;
        }
        let span = start..self.scanner.position;
        self.scanner.expect(";")?;
        // All of them, if none is named.
        let is_any = matches!(names.as_slice(), [only] if only.text == "any");
        let named = if is_any { Vec::new() } else { names };
        let senders = Vec::new();
        let message = Message { performative, name, parameters, senders, named, room, span };
        self.messages.push(message);
        Ok(())
    }

    /// How many goals of one sender may wait.
    fn room(&mut self) -> Parsed<usize> {
        let start = self.scanner.position;
        let rest = self.scanner.rest();
        let length = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        self.scanner.position += length;
        let number = rest[..length].parse().ok();
        number.filter(|number| (1..=MOST_WAITING).contains(number)).ok_or_else(|| {
            Code::Limit
                .at("not a number of goals that may wait", start..start + length)
                .help(format!("from 1 to {MOST_WAITING} of each sender"))
        })
    }

    /// Finds the senders of all messages, checks the sections `peers` and `messages`, and declares each belief and goal that
    /// messages are about.
    pub(super) fn resolve_messages(&mut self) {
        if self.configuration.peers.len() > MOST_PEERS {
            let place = self.configuration.peers[MOST_PEERS].span.clone();
            let message = format!("more than {MOST_PEERS} peers");
            self.diagnostics.push(Code::Limit.at(message, place));
        }
        if self.configuration.peers.is_empty() {
            for message in std::mem::take(&mut self.messages) {
                self.diagnostics.push(
                    Code::NotDeclared
                        .at("there are no peers that could say this", message.name.span)
                        .help("name them: `peers { leader, wingman };`"),
                );
            }
            return;
        }
        self.resolve_peers();
        let mut known: HashSet<(Performative, String)> = HashSet::new();
        for mut message in std::mem::take(&mut self.messages) {
            if !known.insert((message.performative, message.name.text.clone())) {
                let said = format!(
                    "a second message `{} {}`",
                    message.performative.name(),
                    message.name.text
                );
                self.diagnostics.push(
                    Code::DeclaredTwice
                        .at(said, message.name.span)
                        .help("name all senders in one declaration"),
                );
                continue;
            }
            message.senders = self.senders(&message.named);
            self.declare_predicate(&message);
            self.configuration.messages.push(message);
        }
    }

    fn senders(&mut self, names: &[Name]) -> Vec<usize> {
        if names.is_empty() {
            return (0..self.configuration.peers.len()).collect();
        }
        let mut numbers = Vec::new();
        for name in names {
            match self.configuration.peer(&name.text) {
                Some(number) if numbers.contains(&number) => self.diagnostics.push(
                    Code::DeclaredTwice
                        .at(format!("`{}` is named twice", name.text), name.span.clone()),
                ),
                Some(number) => numbers.push(number),
                None => self.diagnostics.push(
                    Code::NotDeclared
                        .at(format!("`{}` is not a peer", name.text), name.span.clone())
                        .help("name it in the section `peers`, or write `any`"),
                ),
            }
        }
        numbers.sort_unstable();
        numbers
    }

    /// A message declares its belief or goal. Where it is declared already, it is the same.
    fn declare_predicate(&mut self, message: &Message) {
        let predicates = &mut self.configuration.predicates;
        match predicates.iter().find(|other| other.name.text == message.name.text) {
            Some(other) if other.parameters != message.parameters => self.diagnostics.push(
                Code::WrongType
                    .at(
                        format!("`{}` has other arguments elsewhere", message.name.text),
                        message.span.clone(),
                    )
                    .help("a belief or goal has the same arguments in `types` and in all messages"),
            ),
            Some(_) => {}
            None => predicates.push(Predicate {
                name: message.name.clone(),
                parameters: message.parameters.clone(),
                span: message.span.clone(),
            }),
        }
    }

    /// `peer` is a type where there are peers.
    fn resolve_peers(&mut self) {
        let resolve = |ctype: &mut CType| {
            // It may be written as in C.
            if ["peer", "peer_t"].contains(&ctype.name.as_str()) && ctype.kind == TypeKind::Opaque {
                *ctype = CType::peer();
            }
        };
        for basic in &mut self.configuration.basics {
            resolve(&mut basic.result);
            basic.parameters.iter_mut().for_each(resolve);
        }
        for predicate in &mut self.configuration.predicates {
            predicate.parameters.iter_mut().for_each(resolve);
        }
        for message in &mut self.messages {
            message.parameters.iter_mut().for_each(resolve);
        }
    }
}
