//! Mission agents: AgentSpeak in place of a flight plan.
//!
//! A mission agent flies nothing itself. In each tick it gives the pilot at most an order, as an operator would
//! ([`Operator::AGENT`](autopilot::vehicle::Operator::AGENT)), and the pilot, whose own agent is proved, and the safety layer fly. It
//! talks with the agents of other vehicles by lines of text, which may be lost or late.
//!
//! The agents are those in `agents/`, which the build translates to C; `agents/boundary.conf` declares what they sense and
//! order.
#![deny(unsafe_code)]

mod boundary;
mod built_in;
mod mission;

pub use boundary::{Line, MAX_LINE, SAID_AGAIN_WITHIN, Said, kind, sender, text};
pub use built_in::{NoAgent, names};
pub use mission::{MissionAgent, Misunderstood};
