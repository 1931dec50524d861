//! The configuration: the environment of the agent, and the output files.
//!
//! The format is that of the paper "From AgentSpeak to C" (`agents/paper.asl` names its authors), with more sections: each
//! has a name and braces, and its declarations end in semicolons.
//!
//! ```text
//! settings { input = pilot.asl; output = pilot.c; header = pilot.h; basics = actions.h; };
//! includes { #include <stdbool.h> };
//! structs { place_t { double x; double y; }; };
//! basics { void sendLand(void); bool closeEnough(double, double); };
//! peers { leader, wingman };
//! messages { tell low from any; achieve inspect(double, double) from leader, 4; };
//! classes { at_command: sendLand; };
//! types { position(double, double); land(void); };
//! settables { position; };
//! perceived { position; };
//! triggerables { +!land; };
//! preemptive { +!land; };
//! properties { one_command: exactly_one(at_command); };
//! ```
//!
//! Sections may appear in any order and may be missing or empty, except `settings`. `version 1;` may stand before them.

mod c_type;
mod declarations;
mod messages;
mod outputs;
mod parser;
mod properties;
pub(crate) mod scanner;
mod settings;
mod version;

use std::collections::{BTreeMap, BTreeSet};

use diagnostic::Span;

pub use parser::{SECTIONS, parse};
pub use properties::{CallBound, Cause, Comparison, DeclaredProperty, Formula, Operand, Property};
pub use scanner::VERSION;
pub use settings::SETTINGS;
pub use version::MessagesVersion;

use crate::syntax::ast::{Name, Operator, Performative, TriggerKind};
use crate::types::CType;

/// A parsed configuration. Places in it are byte ranges of its text.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Configuration {
    /// File names and options.
    pub settings: Settings,
    /// The `#include` lines, copied to the generated headers.
    pub includes: Vec<String>,
    /// Struct types.
    pub structs: Vec<Struct>,
    /// Basic actions and functions, which the environment provides; the trace function of the settings is one of them.
    pub basics: Vec<Basic>,
    /// Actions that are counted together, such as those that send a command.
    pub classes: Vec<ActionClass>,
    /// The agents that talk with each other, this one among them. Their order gives their numbers, from 0.
    pub peers: Vec<Name>,
    /// What they say.
    pub messages: Vec<Message>,
    /// Beliefs and goals with the types of their arguments, those that only `messages` declares among them.
    pub predicates: Vec<Predicate>,
    /// Beliefs with a `set_b` function.
    pub settables: Vec<Name>,
    /// Settables whose change raises the event `+b`.
    pub perceived: Vec<Name>,
    /// Events that the environment can raise.
    pub triggerables: Vec<ExternalTrigger>,
    /// External events that abort the pending event; the first one has priority.
    pub preemptive: Vec<ExternalTrigger>,
    /// Properties that must hold in every environment.
    pub properties: Vec<Property>,
}

impl Configuration {
    /// The fields of a struct, by the name of its type; none if no such struct is declared.
    pub(crate) fn fields(&self, name: &str) -> &[(Name, CType)] {
        let declared = self.structs.iter().find(|declared| declared.name.text == name);
        declared.map_or(&[], |declared| &declared.fields)
    }

    /// The number of a peer, from 0; `None` if there is no such peer.
    pub fn peer(&self, name: &str) -> Option<usize> {
        self.peers.iter().position(|peer| peer.text == name)
    }

    /// The declaration of what peers say of a belief or a goal, if there is one. `untell` is declared by `tell`, `unachieve` by
    /// `achieve`.
    pub fn message(&self, performative: Performative, name: &str) -> Option<&Message> {
        let declared = performative.declared();
        let is_it =
            |message: &&Message| message.performative == declared && message.name.text == name;
        self.messages.iter().find(is_it)
    }

    /// The actions that send messages: `send_tell_at(peer, double, double)`, `send_untell_at(peer)`.
    pub fn sending(&self) -> Vec<Basic> {
        let mut actions = Vec::new();
        for message in &self.messages {
            for performative in Performative::ALL {
                if performative.declared() == message.performative {
                    actions.push(Basic {
                        name: Name {
                            text: sending(performative, &message.name.text),
                            span: message.name.span.clone(),
                        },
                        result: CType::named("void"),
                        parameters: message.said(performative),
                        span: message.span.clone(),
                    });
                }
            }
        }
        actions
    }

    /// The functions for messages that arrive, each with its C name (`receive_tell_at`), what it does and its declaration.
    pub fn receiving(&self) -> Vec<(String, Performative, &Message)> {
        let mut functions = Vec::new();
        for message in &self.messages {
            for performative in Performative::ALL {
                if performative.declared() == message.performative {
                    let name = format!("receive_{}_{}", performative.name(), message.name.text);
                    functions.push((name, performative, message));
                }
            }
        }
        functions
    }

    /// Whether the plans of a trigger are told who caused its event, the agent itself or a peer.
    pub(crate) fn is_sourced(&self, kind: TriggerKind, name: &str) -> bool {
        match kind {
            TriggerKind::Belief => self.message(Performative::Tell, name).is_some(),
            TriggerKind::Achieve => self.message(Performative::Achieve, name).is_some(),
            TriggerKind::Test => false,
        }
    }

    /// Possible paths of each file in `includes`, relative to the folder of the outputs: beside the headers
    /// that include it, and in that folder.
    pub(crate) fn included_files(&self) -> BTreeSet<String> {
        let headers = [&self.settings.header, &self.settings.basics];
        let folders = headers.map(|file| file.rsplit_once('/').map_or("", |(folder, _)| folder));
        let names = self.includes.iter().filter_map(|line| {
            let quoted = line.strip_prefix("#include")?.trim();
            quoted.get(1..quoted.len().checked_sub(1)?)
        });
        names
            .flat_map(|name| {
                folders.into_iter().chain([""]).map(move |folder| plain_path(folder, name))
            })
            .collect()
    }
}

/// The path of a file relative to a folder, normalized.
fn plain_path(folder: &str, file: &str) -> String {
    if file.starts_with('/') {
        return file.to_owned();
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(file.split('/')) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => _ = parts.pop(),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

/// The section `settings`. File names are relative to the folder of the outputs, except that of the input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// The AgentSpeak source, relative to the folder of the configuration.
    pub input: String,
    /// The C file.
    pub output: String,
    /// The header with the agent's interface.
    pub header: String,
    /// The header with the basic actions that the environment provides.
    pub basics: String,
    /// The file with the Rust bindings, if requested.
    pub rust: Option<Name>,
    /// The trace matrix, written under this name with `.csv` and `.json`, if requested.
    pub matrix: Option<String>,
    /// The trace function, which is called with the number of each chosen plan, if requested.
    pub trace: Option<Name>,
    /// The function that returns the time in milliseconds, for agents that wait, have deadlines or ask for an age.
    pub clock: Option<Name>,
    /// Whether the agent's state is static or passed in.
    pub instance: Instance,
    /// Number of external events that may wait, 1 to 64; 1 by default.
    pub inbox: u32,
    /// Whether deferred goals share the queue of external events, as the paper's `max_events` has it.
    pub queue: bool,
    /// Place of each setting's value, by the name of the setting.
    pub places: BTreeMap<String, Span>,
}

impl Settings {
    /// The output files, each with the setting that names it; `matrix` names two.
    pub fn outputs(&self) -> Vec<(&'static str, String)> {
        let mut outputs = vec![
            ("output", self.output.clone()),
            ("header", self.header.clone()),
            ("basics", self.basics.clone()),
        ];
        outputs.extend(self.rust.iter().map(|rust| ("rust", rust.text.clone())));
        let matrix =
            self.matrix.iter().flat_map(|name| [format!("{name}.csv"), format!("{name}.json")]);
        outputs.extend(matrix.map(|name| ("matrix", name)));
        outputs
    }

    /// Prefix of every external symbol if the state is stored like this: with the state passed in, several agents can be
    /// linked into one program.
    pub(crate) fn symbol_prefix(&self, instance: Instance) -> String {
        if instance == Instance::Static {
            return String::new();
        }
        let file = self.output.rsplit('/').next().unwrap_or_default();
        let stem = file.split('.').next().unwrap_or_default();
        let stem: String =
            stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        let stem = stem.trim_start_matches(|c: char| c.is_ascii_digit() || c == '_');
        if stem.is_empty() { "agent_".to_owned() } else { format!("{stem}_") }
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            input: String::new(),
            output: String::new(),
            header: String::new(),
            basics: String::new(),
            rust: None,
            matrix: None,
            trace: None,
            clock: None,
            instance: Instance::Static,
            inbox: 1,
            queue: false,
            places: BTreeMap::new(),
        }
    }
}

/// Storage of the agent's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instance {
    /// In the C file: one agent per process, the paper's `next_step(void)`.
    Static,
    /// In a struct that the caller owns and passes to each function.
    Context,
}

/// A struct type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Struct {
    /// The type's name.
    pub name: Name,
    /// Names and types of its fields: numbers and bool.
    pub fields: Vec<(Name, CType)>,
}

/// A function that the environment provides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Basic {
    /// The C function's name.
    pub name: Name,
    /// Type of its result.
    pub result: CType,
    /// Types of its parameters.
    pub parameters: Vec<CType>,
    /// The whole declaration; of an action that sends a message, that of the message.
    pub span: Span,
}

/// Actions that are counted together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ActionClass {
    /// Their common name.
    pub name: Name,
    /// The basic actions.
    pub actions: Vec<Name>,
    /// How they are written if not one by one.
    pub all_but: Option<AllBut>,
}

/// `all CLASS but NAME, NAME`: the actions of a class without some.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AllBut {
    /// A class that is declared before.
    pub class: Name,
    /// Actions, and classes that are declared before.
    pub but: Vec<Name>,
}

/// A message that peers may send: `tell at(double, double) from any;`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// [`Performative::Tell`] or [`Performative::Achieve`]; each can be taken back.
    pub performative: Performative,
    /// The belief or goal.
    pub name: Name,
    /// The types of its arguments.
    pub parameters: Vec<CType>,
    /// Who may send it, as numbers of peers in ascending order.
    pub senders: Vec<usize>,
    /// The senders as they are written; none for `any`.
    pub named: Vec<Name>,
    /// How many goals of one sender may wait, 1 to 64. 1 for what is told, of which the newest counts.
    pub room: usize,
    /// The whole declaration.
    pub span: Span,
}

/// Name of the action that sends a message: `send_tell_at`.
pub(crate) fn sending(performative: Performative, name: &str) -> String {
    format!("send_{}_{name}", performative.name())
}

impl Message {
    /// The types of what arrives or is sent: the other peer, and for `tell` and `achieve` the arguments.
    pub fn said(&self, performative: Performative) -> Vec<CType> {
        let arguments = self.parameters.iter().filter(|_| performative.has_arguments());
        std::iter::once(CType::peer()).chain(arguments.cloned()).collect()
    }
}

/// A belief or goal declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Predicate {
    /// The name used in the agent.
    pub name: Name,
    /// The types of its arguments.
    pub parameters: Vec<CType>,
    /// The whole declaration, in `types` or in `messages`.
    pub span: Span,
}

/// `+!g`, `+b` or `-b` in `triggerables`, `preemptive` or a property.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExternalTrigger {
    /// `+` or `-`
    pub operator: Operator,
    /// A belief or an achievement goal.
    pub kind: TriggerKind,
    /// Its name.
    pub name: Name,
    /// The peer that causes it, in properties; otherwise it is the agent's environment.
    pub source: Option<Name>,
    /// The whole entry.
    pub span: Span,
}
