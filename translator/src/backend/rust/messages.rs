//! Messages in the Rust bindings: who the peers are, what they say as values and as lines of text, and what arrives.
//!
//! A line is `VERSION SENDER MESSAGE`, for instance `91c4… leader tell at(1.5, 2.0, wingman)`. What is generated needs the
//! standard library's `core` only, and allocates nothing.

use super::leaves::{Leaf, leaves, longest};
use super::templates::{
    ARGUMENT, DECIMAL, DIGITS, ENVELOPE, ERRORS, FLOAT, HEXADECIMAL, INTEGER, PEER, READING, REST,
    of_bits,
};
use super::{arguments, camel_case, lent, safe_type, snake_case, typed_parameters};
use crate::backend::c::{Received, received, symbol_prefix};
use crate::backend::writer::Writer;
use crate::configuration::{Basic, Configuration, MessagesVersion, sending};
use crate::program::Program;
use crate::syntax::ast::Performative;
use crate::types::{CType, TypeKind};

/// What only bindings of agents with messages have, besides `Peer`: structs cannot be called so.
pub(crate) const OWN_TYPES: [&str; 6] =
    ["Message", "MessageError", "Envelope", "Rest", "Digits32", "Digits64"];

/// The variant of a message: `TellAt`.
pub(crate) fn variant(performative: Performative, name: &str) -> String {
    camel_case(&format!("{}_{name}", performative.name()))
}

/// The agents that talk with each other.
pub(super) fn peers(writer: &mut Writer, program: &Program) {
    if !program.has_peers() {
        return;
    }
    writer.line("/// The agents that talk with each other; among arguments a peer is its number.");
    writer.line("#[repr(u8)]");
    writer.line("#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]");
    writer.open_here("pub enum Peer");
    for peer in &program.configuration.peers {
        writer.line(format!("/// `{}`", peer.text));
        writer.line(format!("{},", camel_case(&peer.text)));
    }
    writer.close("}");
    writer.line("");
}

/// The messages as values and as text.
pub(super) fn messages(writer: &mut Writer, program: &Program) {
    let Some(version) = program.configuration.messages_version() else { return };
    let functions = received(program);
    names_of_peers(writer, &program.configuration);
    constants(writer, &program.configuration, version, &functions);
    values(writer, &functions);
    errors(writer, &functions);
    written(writer, &program.configuration, &functions);
    lines(writer, ENVELOPE);
    read(writer, &program.configuration, &functions);
}

fn lines(writer: &mut Writer, text: &str) {
    text.lines().for_each(|line| writer.line(line));
    writer.line("");
}

fn names_of_peers(writer: &mut Writer, configuration: &Configuration) {
    let peers = || configuration.peers.iter().map(|peer| (camel_case(&peer.text), &peer.text));
    writer.open_here("impl Peer");
    writer.line("/// All peers: each stands at its number.");
    let all: Vec<String> = peers().map(|(peer, _)| format!("Self::{peer}")).collect();
    writer.line(format!("pub const ALL: [Self; {}] = [{}];", all.len(), all.join(", ")));
    writer.line("");
    writer.line("/// Its name in agents, and in lines of text.");
    writer.open_here("pub const fn name(self) -> &'static str");
    writer.open_here("match self");
    for (peer, name) in peers() {
        writer.line(format!("Self::{peer} => \"{name}\","));
    }
    writer.close("}");
    writer.close("}");
    writer.close("}");
    writer.line("");
    lines(writer, PEER);
}

fn constants(
    writer: &mut Writer,
    configuration: &Configuration,
    version: MessagesVersion,
    functions: &[Received],
) {
    let digits = version.to_string();
    let groups: Vec<&str> = (0..4).map(|group| &digits[4 * group..4 * group + 4]).collect();
    writer.line(format!("/// The version of the sections `peers` and `messages`: `{digits}`."));
    writer.line("///");
    writer.line("/// Agents with other ones take the same words for something else: they refuse each other.");
    writer.line(format!("pub const MESSAGES_VERSION: u64 = 0x{};", groups.join("_")));
    writer.line("");
    let peer = configuration.peers.iter().map(|peer| peer.text.len()).max().unwrap_or(0);
    let message = functions.iter().map(|function| longest_text(configuration, function)).max();
    let longest = digits.len() + 1 + peer + 1 + message.unwrap_or(0);
    writer.line("/// The number of bytes in the longest line that is read.");
    writer.line(format!("pub const LONGEST_LINE: usize = {longest};"));
    writer.line("");
}

/// The types of what a message says, behind the sender.
fn said(function: &Received) -> &[CType] {
    function.types.get(1..).unwrap_or(&[])
}

/// `tell at`
fn head(function: &Received) -> String {
    format!("{} {}", function.performative.name(), function.about)
}

fn variant_of(function: &Received) -> String {
    variant(function.performative, &function.about)
}

/// Whether a message of this kind can be read: C may keep a string for ever, and one that was read does not stay so long.
fn is_read(function: &Received) -> bool {
    said(function).iter().all(|ctype| ctype.kind != TypeKind::Text)
}

/// The number of bytes in the longest text of a message that is read.
fn longest_text(configuration: &Configuration, function: &Received) -> usize {
    if !is_read(function) {
        return 0;
    }
    let (leaves, after) = leaves(configuration, said(function));
    if leaves.is_empty() {
        return head(function).len();
    }
    let values = leaves.iter().map(|leaf| leaf.before.len() + longest(configuration, &leaf.ctype));
    head(function).len() + values.sum::<usize>() + after.len()
}

/// The type of an argument in the enum: a peer is a peer there.
fn value_type(ctype: &CType) -> String {
    if ctype.is_peer() { "Peer".to_owned() } else { safe_type(ctype) }
}

fn values(writer: &mut Writer, functions: &[Received]) {
    writer.line("/// What peers say to each other.");
    writer.line("#[derive(Debug, Clone, Copy, PartialEq)]");
    writer.open_here("pub enum Message");
    for function in functions {
        let types: Vec<String> = said(function).iter().map(value_type).collect();
        writer.line(format!("/// `{}`", head(function)));
        let types =
            if types.is_empty() { String::new() } else { format!("({})", types.join(", ")) };
        writer.line(format!("{}{types},", variant_of(function)));
    }
    writer.close("}");
    writer.line("");
}

fn errors(writer: &mut Writer, functions: &[Received]) {
    let has_strings = functions.iter().any(|function| !is_read(function));
    // Where there are no strings, there is no error of them.
    let kept = ERRORS.lines().filter(|line| has_strings || !line.starts_with('$'));
    let kept = kept.map(|line| line.trim_start_matches('$'));
    lines(writer, &kept.collect::<Vec<_>>().join("\n"));
}

/// Whether any message has an argument for which this holds.
fn any_leaf<'a>(
    configuration: &Configuration,
    functions: impl Iterator<Item = &'a Received>,
    holds: &dyn Fn(&CType) -> bool,
) -> bool {
    let mut all = functions.flat_map(|function| leaves(configuration, said(function)).0);
    all.any(|leaf| holds(&leaf.ctype))
}

/// How messages become text.
fn written(writer: &mut Writer, configuration: &Configuration, functions: &[Received]) {
    writer.open_here("impl core::fmt::Display for Message");
    writer.line("/// In one line, which [`Message::from_str`](core::str::FromStr) reads.");
    writer.open_here("fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result");
    writer.open_here("match *self");
    for function in functions {
        let (variant, head) = (variant_of(function), head(function));
        let (leaves, after) = leaves(configuration, said(function));
        if leaves.is_empty() {
            writer.line(format!("Self::{variant} => f.write_str(\"{head}\"),"));
            continue;
        }
        let names: Vec<String> = (0..said(function).len()).map(super::argument).collect();
        let (mut form, mut values) = (head, Vec::new());
        for leaf in &leaves {
            form.push_str(&doubled(&leaf.before));
            match leaf.spelled() {
                Some(value) => {
                    form.push_str(if leaf.ctype.kind == TypeKind::Text {
                        r#"\"{}\""#
                    } else {
                        "{}"
                    });
                    values.push(format!(", {value}"));
                }
                None => form.extend(["{", &leaf.place(), "}"]),
            }
        }
        form.push_str(&doubled(&after));
        let values = values.concat();
        writer.open_here(format!("Self::{variant}({}) =>", names.join(", ")));
        writer.line(format!("write!(f, \"{form}\"{values})"));
        writer.close("}");
    }
    writer.close("}");
    writer.close("}");
    writer.close("}");
    writer.line("");
    for bits in [32, 64] {
        let kind = if bits == 32 { TypeKind::Float32 } else { TypeKind::Float64 };
        if any_leaf(configuration, functions.iter(), &|ctype| ctype.kind == kind) {
            lines(writer, &of_bits(bits, DIGITS));
        }
    }
}

/// Braces in a text that is written by `write!`.
fn doubled(text: &str) -> String {
    text.replace('{', "{{").replace('}', "}}")
}

/// How text becomes messages.
fn read(writer: &mut Writer, configuration: &Configuration, functions: &[Received]) {
    let read = || functions.iter().filter(|function| is_read(function));
    let has_arguments = read().any(|function| !said(function).is_empty());
    lines(writer, REST);
    writer.open_here("impl<'a> Rest<'a>");
    READING.lines().for_each(|line| writer.line(line));
    if has_arguments {
        writer.line("");
        ARGUMENT.lines().for_each(|line| writer.line(line));
    }
    writer.line("");
    writer.line("/// Reads a message, behind which there is nothing.");
    writer.open_here("fn message(&mut self) -> Result<Message, MessageError>");
    writer.line("let column = self.column;");
    writer.line("let performative = self.word(&[' ']);");
    writer.line("self.take(\" \");");
    writer.line("let name = self.word(&[' ', '(', ',', ')']);");
    writer.open_here("let message = match (performative, name)");
    for function in functions {
        arm(writer, configuration, function);
    }
    writer.line("_ => return Err(MessageError::UnknownMessage { column }),");
    writer.close("};");
    writer.open_here("if self.text.is_empty()");
    writer.line("Ok(message)");
    writer.dedent();
    writer.open_here("} else");
    writer.line("Err(MessageError::Trailing { column: self.column })");
    writer.close("}");
    writer.close("}");
    writer.close("}");
    writer.line("");
    helpers(writer, configuration, functions);
}

/// The functions that read digits.
fn helpers(writer: &mut Writer, configuration: &Configuration, functions: &[Received]) {
    lines(writer, HEXADECIMAL);
    let is_needed = |holds: &dyn Fn(&CType) -> bool| {
        any_leaf(configuration, functions.iter().filter(|function| is_read(function)), holds)
    };
    if is_needed(&|ctype| ctype.integer_bits().is_some() && !ctype.is_peer()) {
        lines(writer, INTEGER);
    }
    if is_needed(&CType::is_float) {
        lines(writer, DECIMAL);
    }
    for (kind, bits) in [(TypeKind::Float32, 32), (TypeKind::Float64, 64)] {
        if is_needed(&|ctype| ctype.kind == kind) {
            lines(writer, &of_bits(bits, FLOAT));
        }
    }
}

/// How one message is read, behind its name.
fn arm(writer: &mut Writer, configuration: &Configuration, function: &Received) {
    let (performative, about) = (function.performative.name(), &function.about);
    let variant = variant_of(function);
    let pattern = format!("(\"{performative}\", \"{about}\")");
    if !is_read(function) {
        writer.line(format!("{pattern} => return Err(MessageError::Unreadable {{ column }}),"));
        return;
    }
    let (leaves, after) = leaves(configuration, said(function));
    if leaves.is_empty() {
        writer.line(format!("{pattern} => Message::{variant},"));
        return;
    }
    writer.open_here(format!("{pattern} =>"));
    for values in leaves.chunk_by(|one, other| one.argument == other.argument) {
        let [first, ..] = values else { continue };
        let name = super::argument(first.argument);
        if first.field.is_none() {
            writer.line(format!("let {name} = {};", taken(first)));
            continue;
        }
        let ctype = &said(function)[first.argument];
        writer.open_here(format!("let {name} = {}", camel_case(&ctype.name)));
        for value in values {
            let field = value.field.as_deref().unwrap_or_default();
            writer.line(format!("{field}: {},", taken(value)));
        }
        writer.close("};");
    }
    writer.line(format!("self.close(\"{after}\")?;"));
    let names: Vec<String> = (0..said(function).len()).map(super::argument).collect();
    writer.line(format!("Message::{variant}({})", names.join(", ")));
    writer.close("}");
}

/// The expression that reads a value: `self.argument(", ", read_f64)?`
fn taken(leaf: &Leaf) -> String {
    let Leaf { before, ctype, .. } = leaf;
    let read = match ctype.kind {
        TypeKind::Float32 => "read_f32",
        TypeKind::Float64 => "read_f64",
        TypeKind::Signed { .. } | TypeKind::Unsigned { .. } if !ctype.is_peer() => "read_integer",
        // Each of these has one text only.
        _ => "|text| text.parse().ok()",
    };
    format!("self.argument(\"{before}\", {read})?")
}

/// The message that a basic action sends, if it is one that sends.
pub(super) fn sent(program: &Program, basic: &Basic) -> Option<Received> {
    let name = &basic.name.text;
    let function = |function: &Received| sending(function.performative, &function.about) == *name;
    received(program).into_iter().find(function)
}

/// The method of the environment for all that the agent says.
pub(super) fn send(writer: &mut Writer, program: &Program) {
    if program.configuration.messages_version().is_some() {
        writer.line("/// The agent says this to a peer.");
        writer.line("fn send(&mut self, to: Peer, message: Message);");
    }
}

/// Passes on to the environment what C sends.
pub(super) fn pass_on(writer: &mut Writer, message: &Received) {
    let names: Vec<String> =
        (0..said(message).len()).map(|index| super::argument(index + 1)).collect();
    writer.line(
        "// In C a peer is a number; the agent knows no other numbers than those of its peers.",
    );
    let peers = names.iter().zip(said(message)).filter(|(_, ctype)| ctype.is_peer());
    let peers = std::iter::once(super::argument(0)).chain(peers.map(|(name, _)| name.clone()));
    for peer in peers {
        writer.line(format!("let Ok({peer}) = Peer::try_from({peer}) else {{ return }};"));
    }
    let values = if names.is_empty() { String::new() } else { format!("({})", names.join(", ")) };
    let (to, variant) = (super::argument(0), variant_of(message));
    writer.line(format!("environment.send({to}, Message::{variant}{values})"));
}

/// The methods for messages that arrive.
pub(super) fn receive(writer: &mut Writer, program: &Program) {
    let prefix = symbol_prefix(program);
    let functions = received(program);
    for function in &functions {
        let name = &function.name;
        writer.line("");
        writer.line(format!("/// {} The first argument is the sender.", function.comment()));
        writer.line("#[must_use = \"a refused message is lost\"]");
        let lends = if function.asks_time { ", environment: &mut dyn Environment" } else { "" };
        writer.open_here(format!(
            "pub fn {}(&mut self{lends}{}) -> bool",
            snake_case(name),
            typed_parameters(&function.types)
        ));
        let arguments = arguments(&function.types);
        let call = format!("{prefix}{name}(&raw mut self.state{arguments})");
        if function.asks_time {
            lent(writer, &call, "accepted");
        } else {
            writer.line("// SAFETY: the state is initialised and exclusively borrowed.");
            writer.line(format!("unsafe {{ {call} }}"));
        }
        writer.close("}");
    }
    if !functions.is_empty() {
        receive_any(writer, &functions);
    }
}

/// The method for all messages.
fn receive_any(writer: &mut Writer, functions: &[Received]) {
    writer.line("");
    writer.line("/// A peer says this. Returns whether it was accepted, as the method of this message does.");
    writer.line("/// The environment is asked for the time, if the agent asks how old it is.");
    writer.line("#[must_use = \"a refused message is lost\"]");
    writer.open_here(
        "pub fn receive(&mut self, environment: &mut dyn Environment, from: Peer, message: Message) -> bool",
    );
    writer.line("let from = from as u8;");
    if !functions.iter().any(|function| function.asks_time) {
        writer.line("_ = environment;");
    }
    writer.open_here("match message");
    for function in functions {
        let names: Vec<String> = (0..said(function).len()).map(super::argument).collect();
        let bound =
            if names.is_empty() { String::new() } else { format!("({})", names.join(", ")) };
        let passed = names.iter().zip(said(function));
        let passed = passed.map(|(name, ctype)| {
            if ctype.is_peer() { format!(", {name} as u8") } else { format!(", {name}") }
        });
        let passed: String = passed.collect();
        let lent = if function.asks_time { "environment, " } else { "" };
        writer.open_here(format!("Message::{}{bound} =>", variant_of(function)));
        writer.line(format!("self.{}({lent}from{passed})", snake_case(&function.name)));
        writer.close("}");
    }
    writer.close("}");
    writer.close("}");
}
