//! Puts the agents of a system together, and checks that they fit.

use diagnostic::{Diagnostic, closest};

use super::{AgentAction, AgentCause, Channels, ParsedSystem, ROOM, SystemFormula, SystemProperty};
use crate::code::Code;
use crate::configuration::{DeclaredProperty, ExternalTrigger};
use crate::gather::gather;
use crate::program::{Program, trigger_text};
use crate::syntax::ast::Name;
use crate::{ParsedConfiguration, TranslateError, check};

/// A system whose agents can be translated and fit each other.
#[derive(Debug)]
#[non_exhaustive]
pub struct System {
    /// The agents, in the order in which they make their steps when the system is run.
    pub members: Vec<Member>,
    /// What lies between two of them, in each direction.
    pub channels: Channels,
    /// The properties of the whole.
    pub properties: Vec<SystemProperty>,
    /// All that is checked, as text: the properties, and that channels suffice if their losses are bounded.
    pub(crate) declared: Vec<DeclaredProperty>,
}

/// An agent of a system.
#[derive(Debug)]
#[non_exhaustive]
pub struct Member {
    /// The peer that it is.
    pub name: String,
    /// The number of that peer.
    pub peer: usize,
    /// Its configuration.
    pub configuration: ParsedConfiguration,
    /// Its text.
    pub text: String,
    pub(crate) program: Program,
}

impl Member {
    /// Whether a call is one of an action, or of a class of actions.
    pub fn is_call_of(&self, action: &str, call: &str) -> bool {
        let classes = &self.program.configuration.classes;
        match classes.iter().find(|class| class.name.text == action) {
            Some(class) => class.actions.iter().any(|member| member.text == call),
            None => action == call,
        }
    }

    fn calls(&self) -> impl Iterator<Item = &str> {
        let configuration = &self.program.configuration;
        let classes = configuration.classes.iter().map(|class| class.name.text.as_str());
        configuration.basics.iter().map(|basic| basic.name.text.as_str()).chain(classes)
    }

    fn raises(&self, event: &ExternalTrigger) -> bool {
        self.program.raised(event).is_some()
    }
}

impl System {
    /// The index of the agent with this name.
    pub fn member(&self, name: &str) -> Option<usize> {
        self.members.iter().position(|member| member.name == name)
    }

    /// The index of the agent that is a peer.
    pub fn peer(&self, number: usize) -> Option<usize> {
        self.members.iter().position(|member| member.peer == number)
    }

    /// The number of the property that channels suffice, if that is one.
    pub(crate) fn room_number(&self) -> Option<usize> {
        self.channels.losses.map(|_| self.properties.len() + 1)
    }
}

/// Puts agents together: the configuration of each, and its text, in the order of [`ParsedSystem::agents`].
///
/// # Errors
/// [`TranslateError::Refused`] if an agent cannot be translated, or is none of its own peers, if they do not have the same
/// peers and messages, if a peer has no agent, or if a property names what does not exist, or two actions of one agent that
/// are never together.
pub fn compose(
    system: &ParsedSystem,
    agents: Vec<(ParsedConfiguration, String)>,
) -> Result<System, TranslateError> {
    let mut errors = Vec::new();
    let mut members = Vec::new();
    for (agent, (configuration, text)) in system.agents().iter().zip(agents) {
        let instance = configuration.declarations().settings.instance;
        let (program, _) = check(&configuration, &text, instance)?;
        let Some(peer) = configuration.declarations().peer(&agent.peer.text) else {
            let message = format!("`{}` is no peer of its agent", agent.peer.text);
            let help = format!("name it in the section `peers` of `{}`", agent.configuration);
            errors.push(Code::NotDeclared.at(message, agent.peer.span.clone()).help(help));
            continue;
        };
        let name = agent.peer.text.clone();
        members.push(Member { name, peer, configuration, text, program });
    }
    if errors.is_empty() {
        same_messages(system, &members, &mut errors);
    }
    let properties = system.declared.properties.clone();
    let mut declared: Vec<DeclaredProperty> =
        properties.iter().map(|property| property.declared(&system.text)).collect();
    declared.extend(system.declared.channels.losses.map(|_| DeclaredProperty {
        name: ROOM.to_owned(),
        requirements: Vec::new(),
        formula: "no message is sent into a full channel, where it is lost".to_owned(),
    }));
    let composed = System { members, channels: system.declared.channels, properties, declared };
    if errors.is_empty() {
        composed.properties.iter().for_each(|property| composed.resolve(property, &mut errors));
    }
    if errors.is_empty() {
        return Ok(composed);
    }
    Err(TranslateError::Refused(gather([(errors, system.source())])))
}

/// All agents have the peers and messages of the first, and each peer is one of them.
fn same_messages(system: &ParsedSystem, members: &[Member], errors: &mut Vec<Diagnostic>) {
    let Some((first, others)) = members.split_first() else { return };
    let own = first.configuration.declarations();
    let names = |peers: &[Name]| peers.iter().map(|peer| peer.text.clone()).collect::<Vec<_>>();
    for (agent, member) in system.agents().iter().skip(1).zip(others) {
        let declared = member.configuration.declarations();
        let what = if names(&declared.peers) != names(&own.peers) {
            "peers"
        } else if declared.canonical_messages() != own.canonical_messages() {
            "messages"
        } else {
            continue;
        };
        let message = format!("`{}` has other {what} than `{}`", member.name, first.name);
        errors.push(Code::OtherPeers.at(message, agent.peer.span.clone()).help(
            "agents that talk have the same sections `peers`, in the same order, and `messages`",
        ));
    }
    let missing =
        own.peers.iter().filter(|peer| members.iter().all(|member| member.name != peer.text));
    let missing: Vec<String> = missing.map(|peer| format!("`{}`", peer.text)).collect();
    if errors.is_empty() && !missing.is_empty() {
        let place = system.agents().first().map_or(0..0, |first| first.peer.span.clone());
        let message = format!("the system has no agent {}", missing.join(", "));
        errors
            .push(Code::OtherPeers.at(message, place).help("each peer is an agent of the system"));
    }
}

impl System {
    /// Checks that what a property names exists.
    fn resolve(&self, property: &SystemProperty, errors: &mut Vec<Diagnostic>) {
        let actions = property.formula.actions();
        for action in &actions {
            errors.extend(self.resolve_action(action).err());
        }
        match &property.formula {
            SystemFormula::Within { cause: AgentCause::Event(agent, event), .. } => {
                match self.named(agent) {
                    Ok(member) if !member.raises(event) => {
                        let text = trigger_text(event.operator, event.kind, &event.name.text);
                        let message = format!("nothing raises `{text}` of `{}`", agent.text);
                        errors.push(Code::NotTriggerable.at(message, event.span.clone()).help(
                            "name an event of the section `triggerables` of its configuration",
                        ));
                    }
                    Ok(_) => {}
                    Err(error) => errors.push(error),
                }
            }
            SystemFormula::Within { .. } => {}
            SystemFormula::NeverTogether(_) => {
                for (index, action) in actions.iter().enumerate() {
                    let agent = &action.agent;
                    if actions[..index].iter().any(|other| other.agent.text == agent.text) {
                        let message = format!("`{}` is named twice", agent.text);
                        errors.push(Code::DeclaredTwice.at(message, agent.span.clone()).help(
                            "for actions of one agent, make a class of them, or write `at_most_one` in its configuration",
                        ));
                    }
                }
            }
        }
    }

    fn named(&self, agent: &Name) -> Result<&Member, Diagnostic> {
        let found = self.members.iter().find(|member| member.name == agent.text);
        found.ok_or_else(|| {
            let message = format!("the system has no agent `{}`", agent.text);
            let names: Vec<&str> = self.members.iter().map(|member| member.name.as_str()).collect();
            Code::NotDeclared
                .at(message, agent.span.clone())
                .help(format!("there are {}", names.join(", ")))
        })
    }

    fn resolve_action(&self, action: &AgentAction) -> Result<(), Diagnostic> {
        let member = self.named(&action.agent)?;
        let name = &action.action.text;
        if member.calls().any(|call| call == name) {
            return Ok(());
        }
        let message = format!("`{}` never calls `{name}`", member.name);
        let error = Code::NotDeclared.at(message, action.action.span.clone());
        Err(match closest(name, member.calls()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(
                "name an action, a class of actions, or a message that it sends: `send_tell_b`",
            ),
        })
    }
}
