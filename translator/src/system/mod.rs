//! Systems: several agents that talk, the channels between them, and properties of the whole.
//!
//! ```text
//! agents { first: relief.conf; second: relief.conf; };
//! channels { capacity = 2; losses = 1; delay = 2; };
//! properties {
//!   one_at_a_time [REL-4]: never_together(first.flyToPlace, second.flyToPlace);
//!   is_relieved [REL-5]: within(8, first.send_tell_low, second.flyToPlace);
//! };
//! ```
//!
//! In each round every agent makes one step, in any order. A message is under way until it arrives or is lost; those of
//! one peer to another may overtake each other.

mod compose;
mod parser;

pub use compose::{Member, System, compose};
use diagnostic::{Diagnostic, Source, Span};
pub use parser::{CHANNELS, SECTIONS, begins_system};

use crate::TranslateError;
use crate::code::not_read;
use crate::configuration::{ExternalTrigger, Property};
use crate::gather::gather;
use crate::syntax::ast::Name;

/// The ending of the names of files that describe systems.
pub const ENDING: &str = "system";

/// The property that every system has whose losses are bounded: what a full channel loses is not counted.
pub const ROOM: &str = "channels_suffice";

/// A parsed description of a system, whose names are not resolved.
#[derive(Debug, Clone)]
pub struct ParsedSystem {
    name: String,
    text: String,
    declared: Declared,
}

/// What a text declares.
#[derive(Debug, Clone, Default)]
struct Declared {
    agents: Vec<Agent>,
    channels: Channels,
    properties: Vec<SystemProperty>,
}

/// An agent of a system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Agent {
    /// The peer that it is.
    pub peer: Name,
    /// Path of its configuration, relative to the system's file.
    pub configuration: String,
    /// The place of that path.
    pub place: Span,
}

/// What lies between two agents, in each direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Channels {
    /// How many messages can be under way, 1 to 16; what is sent when there are as many is lost.
    pub capacity: u32,
    /// How many messages can be lost one after the other, at most 16; `None`: any number.
    pub losses: Option<u32>,
    /// How many rounds a message can be under way after that in which it was sent, at most 16; `None`: any number.
    pub delay: Option<u32>,
}

impl Default for Channels {
    fn default() -> Self {
        Self { capacity: 2, losses: None, delay: None }
    }
}

/// A property of a whole system.
pub type SystemProperty = Property<SystemFormula>;

/// Formula of a system's property.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SystemFormula {
    /// `never_together(a.x, b.y)`: no two of the actions are called in the same round.
    NeverTogether(Vec<AgentAction>),
    /// `within(n, a.cause, b.x, c.y)`: after the cause one of the actions is called, in the rest of its round or in one of the
    /// next `n`.
    Within {
        /// Maximum number of rounds after that of the cause.
        rounds: u32,
        /// The cause.
        cause: AgentCause,
        /// The required actions.
        answers: Vec<AgentAction>,
    },
}

/// `first.hover`: an action of an agent, or a class of its actions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AgentAction {
    /// The agent.
    pub agent: Name,
    /// The action or class.
    pub action: Name,
}

/// What requires an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AgentCause {
    /// `first.+!g`: the environment raised an event of an agent, and it was accepted.
    Event(Name, ExternalTrigger),
    /// An agent called an action.
    Action(AgentAction),
}

impl SystemFormula {
    /// The actions that the formula refers to: for [`Self::Within`] the cause, if it is one, then the answers.
    pub fn actions(&self) -> Vec<&AgentAction> {
        match self {
            Self::NeverTogether(actions) => actions.iter().collect(),
            Self::Within { cause: AgentCause::Action(cause), answers, .. } => {
                std::iter::once(cause).chain(answers).collect()
            }
            Self::Within { answers, .. } => answers.iter().collect(),
        }
    }
}

impl ParsedSystem {
    /// What can be read of a text, and all errors; `name` is its file's name for messages.
    pub fn read(name: &str, text: &str) -> (Self, Vec<Diagnostic>) {
        let (declared, diagnostics) = parser::parse(text);
        (Self { name: name.to_owned(), text: text.to_owned(), declared }, diagnostics)
    }

    /// The text that was parsed.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The agents, in the order in which they make their steps when the system is run.
    pub fn agents(&self) -> &[Agent] {
        &self.declared.agents
    }

    /// The properties of the whole.
    pub fn properties(&self) -> &[SystemProperty] {
        &self.declared.properties
    }

    /// An error at the configuration of this agent, which cannot be read for this reason.
    pub fn not_read(&self, agent: &Agent, reason: &str) -> TranslateError {
        let found = not_read(&agent.configuration, reason, agent.place.clone());
        TranslateError::Refused(gather([(vec![found], self.source())]))
    }

    fn source(&self) -> Source<'_> {
        Source { name: &self.name, text: &self.text }
    }
}

/// Parses the description of a system; `name` is its file's name for messages.
///
/// # Errors
/// [`TranslateError::Refused`] with all errors.
pub fn parse_system(name: &str, text: &str) -> Result<ParsedSystem, TranslateError> {
    let (parsed, diagnostics) = ParsedSystem::read(name, text);
    if diagnostics.is_empty() {
        return Ok(parsed);
    }
    Err(TranslateError::Refused(gather([(diagnostics, parsed.source())])))
}
