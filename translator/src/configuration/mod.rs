//! The configuration: what the environment offers the agent, and where the output goes.
//!
//! The format is the paper's: named sections in braces, declarations that end in semicolons.
//!
//! ```text
//! settings { input = pilot.asl; output = pilot.c; header = pilot.h; basics = actions.h; };
//! includes { #include <stdbool.h> };
//! structs { place_t { double x; double y; }; };
//! basics { void sendLand(void); bool closeEnough(double, double); };
//! classes { at_command: sendLand; };
//! types { position(double, double); land(void); };
//! settables { position; };
//! perceived { position; };
//! triggerables { +!land; };
//! preemptive { +!land; };
//! properties { one_command: exactly_one(at_command); };
//! ```
//!
//! Sections may stand in any order and may be left out or empty, except `settings`.

mod c_type;
mod declarations;
mod outputs;
mod parser;
mod properties;
mod scanner;
mod settings;

use std::collections::{BTreeMap, BTreeSet};

use diagnostic::Span;

pub use parser::parse;
pub use properties::{CallBound, Cause, Comparison, Formula, Operand, Property};

use crate::syntax::ast::{Name, Operator, TriggerKind};
use crate::types::CType;

/// A parsed configuration.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Configuration {
    /// File names and options.
    pub settings: Settings,
    /// Preprocessor lines, copied to the generated headers.
    pub includes: Vec<String>,
    /// Struct types.
    pub structs: Vec<Struct>,
    /// Basic actions and functions.
    pub basics: Vec<Basic>,
    /// Actions that are counted together, such as those that send a command.
    pub classes: Vec<ActionClass>,
    /// Beliefs and goals with the types of their arguments.
    pub predicates: Vec<Predicate>,
    /// Beliefs with a `set_b` function.
    pub settables: Vec<Name>,
    /// Settables whose change raises `+b`.
    pub perceived: Vec<Name>,
    /// Events that the environment can raise.
    pub triggerables: Vec<ExternalTrigger>,
    /// External events that abort what runs, in order of priority.
    pub preemptive: Vec<ExternalTrigger>,
    /// What must hold in every environment.
    pub properties: Vec<Property>,
}

impl Configuration {
    /// Where a compiler may look for each file of `includes`, relative to the folder of the outputs: beside the
    /// headers that include it, and there.
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

/// The path of a file seen from a folder, without `.`, `//` and what `..` takes back.
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

/// The `settings` section.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// The AgentSpeak source, relative to the configuration.
    pub input: String,
    /// The C file, relative to the output folder.
    pub output: String,
    /// The header with the agent's interface.
    pub header: String,
    /// The header with the basic actions that the environment provides.
    pub basics: String,
    /// The Rust side of the boundary, if wanted.
    pub rust: Option<Name>,
    /// The trace matrix, written as this name with `.csv` and `.json`, if wanted.
    pub matrix: Option<String>,
    /// The function that is told which plan was chosen, if wanted.
    pub trace: Option<Name>,
    /// The function that tells the time in milliseconds, for agents that wait.
    pub clock: Option<Name>,
    /// Whether the agent's state is static or passed in.
    pub instance: Instance,
    /// External events that can wait at the same time.
    pub inbox: u32,
    /// Whether deferred goals wait in the same queue as external events, the paper's `max_events`.
    pub queue: bool,
    /// Where the value of each setting stands.
    pub places: BTreeMap<String, Span>,
}

impl Settings {
    /// The files that are written, with the setting that names each.
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

    /// What stands before every external symbol of this form: with its state passed in, several agents can be
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

/// Where the agent's state lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instance {
    /// In the C file: one agent a process, the paper's `next_step(void)`.
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
    /// What it returns.
    pub result: CType,
    /// What it takes.
    pub parameters: Vec<CType>,
    /// The whole declaration.
    pub span: Span,
}

/// Actions that are counted together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ActionClass {
    /// What they are called together.
    pub name: Name,
    /// The basic actions.
    pub actions: Vec<Name>,
}

/// A belief or goal declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Predicate {
    /// The name used in the agent.
    pub name: Name,
    /// The types of its arguments.
    pub parameters: Vec<CType>,
    /// The whole declaration.
    pub span: Span,
}

/// `+!g`, `+b` or `-b` in `triggerables` or `preemptive`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExternalTrigger {
    /// `+` or `-`
    pub operator: Operator,
    /// A belief or an achievement goal.
    pub kind: TriggerKind,
    /// Its name.
    pub name: Name,
    /// The whole entry.
    pub span: Span,
}
