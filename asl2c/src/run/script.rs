//! The lines of a script: calls of the agent's interface, results of its functions, and commands.

use diagnostic::{Diagnostic, Span, closest};
use translator::Act;
use translator::configuration::{Configuration, ExternalTrigger};
use translator::interpreter::Value;
use translator::syntax::ast::{Operator, Performative, TriggerKind};
use translator::types::{CType, TypeKind};

use super::values::{fields, parse};

/// One statement.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Statement {
    /// `achieve_g(1);`
    Raise(ExternalTrigger, Vec<Value>),
    /// `set_b(1);`
    Set(String, Vec<Value>),
    /// `receive_tell_b(wingman, 1);`
    Receive(Performative, String, Vec<Value>),
    /// `init(wingman);`
    Be(usize),
    /// `f_result = 1, 2;`
    Answer(String, Vec<Value>),
    /// `init();`
    Init,
    /// `clear();`
    Clear,
    /// `next_step();` and `step 3`
    Step(u32),
    /// `run`
    Run(u32),
    /// `mind`
    Mind,
    /// `undo`
    Undo(u32),
    /// `help`
    Help,
    /// `quit`
    Quit,
}

/// The line of a script as what the environment does; `mind` does nothing.
///
/// # Errors
/// As for [`Runs::execute`](super::Runs::execute), and if the line has something that no environment does.
pub(crate) fn acts(line: &str, configuration: &Configuration) -> Result<Vec<Act>, Diagnostic> {
    let mut acts = Vec::new();
    for statement in parse_line(line, configuration)? {
        match statement {
            Statement::Raise(event, values) => acts.push(Act::Raise(event, values)),
            Statement::Set(belief, values) => acts.push(Act::Set(belief, values)),
            Statement::Receive(performative, about, values) => {
                acts.push(Act::Receive(performative, about, values));
            }
            Statement::Be(peer) => acts.push(Act::Be(peer)),
            Statement::Answer(function, values) => acts.push(Act::Answer(function, values)),
            Statement::Clear => acts.push(Act::Clear),
            Statement::Step(count) => acts.extend((0..count).map(|_| Act::Step)),
            Statement::Mind => {}
            Statement::Init
            | Statement::Run(_)
            | Statement::Undo(_)
            | Statement::Help
            | Statement::Quit => {
                let message = "only the prompt and scripts know this, not a test of the C";
                return Err(Diagnostic::error(message, 0..line.len())
                    .help("a test calls the agent's interface, sets results, and makes steps"));
            }
        }
    }
    Ok(acts)
}

/// Commands besides calls and results.
const COMMANDS: [&str; 6] = ["step", "run", "mind", "undo", "help", "quit"];
/// Calls that exist for every agent.
const CALLS: [&str; 3] = ["next_step", "init", "clear"];
/// Maximum number of steps of one command.
const MOST: u32 = 10_000;
/// Default maximum number of steps of `run`.
const USUAL: u32 = 1000;
/// Maximum nesting of struct values.
const DEEPEST: u32 = 16;

/// Whether a line is empty or a comment.
pub(crate) fn is_skipped(line: &str) -> bool {
    let line = line.trim();
    line.is_empty() || line.starts_with("//")
}

/// All possible beginnings of a line: calls with an opening parenthesis, results with `=`, commands.
pub(super) fn words(configuration: &Configuration) -> Vec<String> {
    let mut words: Vec<String> =
        raised(configuration).map(|(name, _)| format!("{name}(")).collect();
    words.extend(configuration.settables.iter().map(|name| format!("set_{}(", name.text)));
    words.extend(configuration.receiving().into_iter().map(|(name, ..)| format!("{name}(")));
    words.extend(functions(configuration).map(|(name, _)| format!("{name}_result = ")));
    words.extend(CALLS.map(|call| format!("{call}();")));
    words.extend(COMMANDS.map(str::to_owned));
    words
}

/// The external events, each with the name of its call.
fn raised(configuration: &Configuration) -> impl Iterator<Item = (String, &ExternalTrigger)> {
    let events = configuration.triggerables.iter();
    events.map(|event| (call_name(event), event))
}

/// `achieve_land` for `+!land`.
pub(crate) fn call_name(event: &ExternalTrigger) -> String {
    let verb = match (event.operator, event.kind) {
        (Operator::Add, TriggerKind::Achieve) => "achieve",
        (Operator::Add, _) => "add",
        (Operator::Delete, _) => "del",
    };
    format!("{verb}_{}", event.name.text)
}

fn functions(configuration: &Configuration) -> impl Iterator<Item = (&str, &CType)> {
    let basics = configuration.basics.iter().filter(|basic| basic.result.kind != TypeKind::Void);
    basics.map(|basic| (basic.name.text.as_str(), &basic.result))
}

/// Parses the statements of a line; spans of errors are relative to its beginning.
pub(super) fn parse_line(
    line: &str,
    configuration: &Configuration,
) -> Result<Vec<Statement>, Diagnostic> {
    let mut parser = Parser { line, at: 0, configuration };
    let mut statements = Vec::new();
    loop {
        parser.skip();
        while parser.eat(";") {}
        if parser.is_at_end() {
            return Ok(statements);
        }
        statements.push(parser.statement()?);
        if !parser.is_at_end() && !parser.eat(";") {
            return Err(parser.expected("`;` or the end of the line"));
        }
    }
}

struct Parser<'a> {
    line: &'a str,
    at: usize,
    configuration: &'a Configuration,
}

impl<'a> Parser<'a> {
    fn rest(&self) -> &'a str {
        self.line.get(self.at..).unwrap_or_default()
    }

    fn skip(&mut self) {
        let rest = self.rest();
        self.at += rest.len() - rest.trim_start().len();
        if self.rest().starts_with("//") {
            self.at = self.line.len();
        }
    }

    fn is_at_end(&mut self) -> bool {
        self.skip();
        self.at >= self.line.len()
    }

    fn eat(&mut self, mark: &str) -> bool {
        self.skip();
        let found = self.rest().starts_with(mark);
        self.at += if found { mark.len() } else { 0 };
        found
    }

    /// A word, or any text up to a blank or a mark.
    fn word(&mut self) -> (&'a str, Span) {
        self.skip();
        let rest = self.rest();
        let end = rest.find(|c: char| c.is_whitespace() || "(){},;=\"".contains(c));
        let word = &rest[..end.unwrap_or(rest.len())];
        let start = self.at;
        self.at += word.len();
        (word, start..self.at)
    }

    fn expected(&mut self, what: &str) -> Diagnostic {
        self.skip();
        let length = self.rest().chars().next().map_or(0, char::len_utf8);
        Diagnostic::error(format!("expected {what}"), self.at..self.at + length)
    }

    fn statement(&mut self) -> Result<Statement, Diagnostic> {
        let (word, span) = self.word();
        if word.is_empty() {
            return Err(self.expected("a call, a result or a command").help(self.all()));
        }
        let configuration = self.configuration;
        let raised = raised(configuration).find(|(name, _)| name == word);
        if let Some((_, event)) = raised {
            let types = match event.operator {
                Operator::Add => parameters(configuration, &event.name.text),
                // The belief is removed whatever its values, so it has no arguments.
                Operator::Delete => &[],
            };
            return Ok(Statement::Raise(event.clone(), self.arguments(types)?));
        }
        let set = word
            .strip_prefix("set_")
            .and_then(|name| configuration.settables.iter().find(|settable| settable.text == name));
        if let Some(belief) = set {
            let types = parameters(configuration, &belief.text);
            return Ok(Statement::Set(belief.text.clone(), self.arguments(types)?));
        }
        let received = configuration.receiving();
        if let Some((_, performative, message)) = received.iter().find(|(name, ..)| name == word) {
            let values = self.arguments(&message.said(*performative))?;
            return Ok(Statement::Receive(*performative, message.name.text.clone(), values));
        }
        if word == "init" && !configuration.peers.is_empty() {
            let values = self.arguments(&[CType::peer()])?;
            let peer = match values.as_slice() {
                [Value::Integer(peer)] => usize::try_from(*peer).ok(),
                _ => None,
            };
            let peer = peer.filter(|peer| *peer < configuration.peers.len());
            return peer.map(Statement::Be).ok_or_else(|| {
                Diagnostic::error("there is no such peer", span)
                    .help("name it as in the section `peers`")
            });
        }
        let answer = word
            .strip_suffix("_result")
            .and_then(|name| functions(configuration).find(|(function, _)| *function == name));
        if let Some((name, ctype)) = answer {
            return self.answers(name, ctype);
        }
        self.command(word, &span)
    }

    fn command(&mut self, word: &str, span: &Span) -> Result<Statement, Diagnostic> {
        let call = |parser: &mut Self, statement| parser.arguments(&[]).map(|_| statement);
        match word {
            "next_step" => call(self, Statement::Step(1)),
            "init" => call(self, Statement::Init),
            "clear" => call(self, Statement::Clear),
            "step" => Ok(Statement::Step(self.number(1)?)),
            "run" => Ok(Statement::Run(self.number(USUAL)?)),
            "undo" => Ok(Statement::Undo(self.number(1)?)),
            "mind" => Ok(Statement::Mind),
            "help" => Ok(Statement::Help),
            "quit" | "exit" => Ok(Statement::Quit),
            function if self.is_function(function) => {
                let error = Diagnostic::error(format!("`{function}` is a function"), span.clone());
                Err(error.help(format!("`{function}_result = ..;` sets what it returns")))
            }
            _ => {
                let words = words(self.configuration);
                let names =
                    words.iter().map(|word| word.trim_end_matches(['(', ')', ';', '=', ' ']));
                let error = Diagnostic::error(format!("there is no `{word}`"), span.clone());
                Err(match closest(word, names) {
                    Some(near) => error.help(format!("did you mean `{near}`?")),
                    None => error.help(self.all()),
                })
            }
        }
    }

    fn is_function(&self, name: &str) -> bool {
        let mut basics = self.configuration.basics.iter();
        basics.any(|basic| basic.name.text == name && basic.result.kind != TypeKind::Void)
    }

    fn all(&self) -> String {
        let words = words(self.configuration);
        let words = words.iter().map(|word| word.trim_end_matches(['(', ')', ';', '=', ' ']));
        format!("there are {}", words.collect::<Vec<_>>().join(", "))
    }

    fn number(&mut self, usual: u32) -> Result<u32, Diagnostic> {
        if self.is_at_end() || self.rest().starts_with(';') {
            return Ok(usual);
        }
        let (word, span) = self.word();
        word.parse()
            .ok()
            .filter(|number| (1..=MOST).contains(number))
            .ok_or_else(|| Diagnostic::error(format!("expected a number from 1 to {MOST}"), span))
    }

    fn answers(&mut self, name: &str, ctype: &CType) -> Result<Statement, Diagnostic> {
        if !self.eat("=") {
            return Err(self.expected("`=`").help("results are set: `f_result = 1;`"));
        }
        let mut values = vec![self.value(ctype, 0)?];
        while self.eat(",") {
            values.push(self.value(ctype, 0)?);
        }
        Ok(Statement::Answer(name.to_owned(), values))
    }

    fn arguments(&mut self, types: &[CType]) -> Result<Vec<Value>, Diagnostic> {
        if !self.eat("(") {
            return Err(self.expected("`(`"));
        }
        let mut values = Vec::new();
        for (index, ctype) in types.iter().enumerate() {
            if index > 0 && !self.eat(",") {
                return Err(self.expected(&format!("`,` and {} more", types.len() - index)));
            }
            values.push(self.value(ctype, 0)?);
        }
        if !self.eat(")") {
            return Err(self.expected("`)`").help(match types.len() {
                0 => "it has no arguments".to_owned(),
                1 => "it has one argument".to_owned(),
                count => format!("it has {count} arguments"),
            }));
        }
        Ok(values)
    }

    fn value(&mut self, ctype: &CType, depth: u32) -> Result<Value, Diagnostic> {
        if ctype.kind == TypeKind::Struct && depth < DEEPEST && self.eat("{") {
            let types = fields(ctype, self.configuration);
            let mut values = Vec::new();
            for (index, field) in types.iter().enumerate() {
                if index > 0 && !self.eat(",") {
                    return Err(self.expected("`,` and the next field"));
                }
                values.push(self.value(field, depth + 1)?);
            }
            return if self.eat("}") {
                Ok(Value::Struct(values))
            } else {
                Err(self.expected("`}`"))
            };
        }
        if matches!(ctype.kind, TypeKind::Text | TypeKind::Opaque) && self.eat("\"") {
            return self.text();
        }
        let (word, span) = self.word();
        if ctype.is_peer()
            && let Some(number) = peer(word, self.configuration)
        {
            return Ok(Value::Integer(i128::try_from(number).unwrap_or(i128::MAX)));
        }
        let wrong = |what: String| Diagnostic::error(format!("expected {what}"), span.clone());
        parse(word, ctype).map_err(|what| {
            let error = wrong(what);
            if word.is_empty() {
                error
            } else {
                error.label(format!("not of type `{}`", ctype.name))
            }
        })
    }

    /// A string after its opening quote, with the escapes of agents.
    fn text(&mut self) -> Result<Value, Diagnostic> {
        let start = self.at;
        let mut text = String::new();
        let mut characters = self.rest().char_indices();
        while let Some((index, character)) = characters.next() {
            match character {
                '"' => {
                    self.at = start + index + 1;
                    return Ok(Value::Text(text));
                }
                '\\' => text.push(match characters.next() {
                    Some((_, same @ ('"' | '\\'))) => same,
                    Some((_, 'n')) => '\n',
                    Some((_, 't')) => '\t',
                    other => {
                        let length = other.map_or(0, |(_, character)| character.len_utf8());
                        let span = start + index..start + index + 1 + length;
                        return Err(Diagnostic::error("unknown escape in a text", span)
                            .help("the escapes are `\\\"`, `\\\\`, `\\n` and `\\t`"));
                    }
                }),
                _ => text.push(character),
            }
        }
        Err(Diagnostic::error("the text has no end", start - 1..self.line.len()))
    }
}

/// A peer by its name, or by that of its constant in C.
fn peer(word: &str, configuration: &Configuration) -> Option<usize> {
    let is_it = |peer: &str| word == peer || word == format!("PEER_{}", peer.to_uppercase());
    configuration.peers.iter().position(|peer| is_it(&peer.text))
}

pub(crate) fn parameters<'a>(configuration: &'a Configuration, name: &str) -> &'a [CType] {
    let declared = configuration.predicates.iter().find(|other| other.name.text == name);
    declared.map_or(&[], |declared| &declared.parameters)
}
