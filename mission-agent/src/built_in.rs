//! The agents that are built in. This is the only file with `unsafe` code: the bindings that the translator generates, each
//! block with a comment on its soundness.

use crate::boundary::{MAX_LINE, Step};
use crate::mission::Misunderstood;

/// An agent behind the boundary that all have.
pub(crate) trait Translated: std::fmt::Debug + Send {
    /// One deliberation cycle.
    fn step(&mut self, step: &mut Step<'_>);

    /// A peer says something.
    fn hear(&mut self, step: &mut Step<'_>, line: &str) -> Result<(), Misunderstood>;

    /// Its number among its peers.
    fn me(&self) -> u8;

    /// The names of all its peers, its own among them.
    fn peers(&self) -> &'static [&'static str];
}

/// Makes an agent that is one of its peers.
type New = fn(&str) -> Result<Box<dyn Translated>, NoAgent>;

/// Why there is no such agent.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoAgent {
    /// None is built in under this name.
    #[error("no agent is called `{name}`: built in are {}", names().collect::<Vec<_>>().join(", "))]
    Unknown {
        /// The name that was asked for.
        name: String,
    },
    /// It talks with others by their names, and the vehicle's is not among them.
    #[error("the agent `{agent}` is one of {}, and no `{vehicle}`", .peers.join(", "))]
    NoPeer {
        /// The agent.
        agent: &'static str,
        /// The vehicle.
        vehicle: String,
        /// Who it can be.
        peers: &'static [&'static str],
    },
}

/// The names of the agents that are built in.
pub fn names() -> impl Iterator<Item = &'static str> {
    ALL.iter().map(|(name, _)| *name)
}

/// A new agent for a vehicle.
pub(crate) fn new(name: &str, vehicle: &str) -> Result<Box<dyn Translated>, NoAgent> {
    let found = ALL.iter().find(|(built_in, _)| *built_in == name);
    let (_, new) = found.ok_or_else(|| NoAgent::Unknown { name: name.to_owned() })?;
    new(vehicle)
}

/// The module of an agent: its bindings, with its environment and its interface.
macro_rules! built_in {
    ($kind:ident $name:ident $text:literal [$($belief:ident),*] [$($method:ident($($argument:ident: $type:ty),*) -> $result:ty),*]) => {
        mod $name {
            use super::{MAX_LINE, Misunderstood, NoAgent, Step, Translated};

            #[allow(
                unsafe_code,
                dead_code,
                unreachable_pub,
                clippy::pedantic,
                reason = "generated: the Rust side of the C boundary, of which each agent uses a part"
            )]
            mod bindings {
                include!(concat!(env!("OUT_DIR"), "/", $text, "/", $text, ".rs"));
            }

            impl bindings::Environment for Step<'_> {
                #[allow(unused_variables, reason = "some agents are set no beliefs")]
                fn update_beliefs(&mut self, beliefs: &mut bindings::Beliefs<'_>) {
                    $(built_in! { @set beliefs $belief self })*
                }
                $(fn $method(&mut self $(, $argument: $type)*) -> $result {
                    Step::$method(self $(, $argument)*)
                })*
                built_in! { @send $kind }
            }

            built_in! { @agent $kind $text }
        }
    };
    (@set $beliefs:ident charge $step:ident) => {
        if let Some((percent,)) = $step.charge() {
            $beliefs.set_charge(percent);
        }
    };
    (@set $beliefs:ident position $step:ident) => {
        if let Some((x_m, y_m, z_m, yaw_deg)) = $step.position() {
            $beliefs.set_position(x_m, y_m, z_m, yaw_deg);
        }
    };
    (@send silent) => {};
    (@send talks) => {
        fn send(&mut self, to: bindings::Peer, message: bindings::Message) {
            // Its number was that of a peer when it was made.
            if let Ok(from) = bindings::Peer::try_from(self.me) {
                self.say(to.name(), &bindings::Envelope { from, message });
            }
        }
    };
    (@agent silent $text:literal) => {
        #[allow(clippy::unnecessary_wraps, reason = "as those that talk")]
        pub(super) fn new(_: &str) -> Result<Box<dyn Translated>, NoAgent> {
            Ok(Box::new(bindings::Agent::new()))
        }

        impl Translated for bindings::Agent {
            fn step(&mut self, step: &mut Step<'_>) {
                self.next_step(step);
            }

            fn hear(&mut self, _: &mut Step<'_>, _: &str) -> Result<(), Misunderstood> {
                Err(Misunderstood::DoesNotTalk)
            }

            fn me(&self) -> u8 {
                0
            }

            fn peers(&self) -> &'static [&'static str] {
                &[]
            }
        }
    };
    (@agent talks $text:literal) => {
        const PEERS: &[&str] = &{
            let mut names = [""; bindings::Peer::ALL.len()];
            let mut number = 0;
            while number < names.len() {
                names[number] = bindings::Peer::ALL[number].name();
                number += 1;
            }
            names
        };

        const _: () = assert!(bindings::LONGEST_LINE <= MAX_LINE, "its messages are too long");

        #[derive(Debug)]
        struct Talks {
            agent: bindings::Agent,
            me: bindings::Peer,
        }

        pub(super) fn new(vehicle: &str) -> Result<Box<dyn Translated>, NoAgent> {
            let no_peer = |_| {
                let vehicle = vehicle.to_owned();
                NoAgent::NoPeer { agent: $text, vehicle, peers: PEERS }
            };
            let me: bindings::Peer = vehicle.parse().map_err(no_peer)?;
            Ok(Box::new(Talks { agent: bindings::Agent::new(me), me }))
        }

        impl Translated for Talks {
            fn step(&mut self, step: &mut Step<'_>) {
                self.agent.next_step(step);
            }

            fn hear(&mut self, step: &mut Step<'_>, line: &str) -> Result<(), Misunderstood> {
                let read: Result<bindings::Envelope, bindings::MessageError> = line.parse();
                match read {
                    Ok(bindings::Envelope { from, .. }) if from == self.me => Err(Misunderstood::Oneself),
                    Ok(bindings::Envelope { from, message }) => {
                        let accepted = self.agent.receive(step, from, message);
                        if accepted { Ok(()) } else { Err(Misunderstood::Refused) }
                    }
                    Err(bindings::MessageError::OtherVersion { ours, theirs }) => {
                        Err(Misunderstood::OtherVersion { ours, theirs })
                    }
                    Err(_) => Err(Misunderstood::NoMessage),
                }
            }

            fn me(&self) -> u8 {
                self.me as u8
            }

            fn peers(&self) -> &'static [&'static str] {
                PEERS
            }
        }
    };
}

include!(concat!(env!("OUT_DIR"), "/agents.rs"));
