//! The flight log: everything that was heard, decided and sent, as an MCAP file.
//!
//! The tick hands [`Record`]s over a bounded channel and never waits: what the disk is too slow for is
//! counted, not kept. A thread writes; what it has flushed survives whatever happens to the process.

mod messages;
mod order;
mod reader;
mod recorder;
mod topic;
mod writer;

use std::time::Duration;

pub use messages::{
    Agent, Bytes, ChosenPlan, Command, DecodedNavdata, Estimate, Place, Tick, Timing,
};
pub use order::{Order, OrderError};
pub use reader::{Entry, LARGEST_FILE_BYTES, Log, LogError};
pub use recorder::{Recorded, Recorder, Recording, RecordingError};
pub use writer::LogWriter;

use autopilot::outcome::Outcome;
use autopilot::plan::ZOrigin;
use autopilot::vehicle::{Decision, FlightEvent, Operator, OperatorOrder};

/// Names of attachments.
const AGENT_FILE: &str = "autopilot.asl";
const PLAN_FILE: &str = "plan.txt";
const SETTINGS_FILE: &str = "pilot.toml";
/// What a log line is about: its `name`.
const EVENT: &str = "event";
const OUTCOME: &str = "outcome";
/// The format that is written: what the messages are and mean. 1 had no number, and zeros for a place that is not
/// known; 1 and 2 had one flight each, and orders without an operator.
const FORMAT: u32 = 3;
/// The name of the metadata.
const FLIGHT: &str = "flight";

/// What is flown, and how.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Header {
    /// When the flight's clock was zero, since the Unix epoch.
    pub start: Duration,
    /// The plan's file name.
    pub plan_name: String,
    /// The plan.
    pub plan: String,
    /// The settings that hold, as TOML.
    pub settings: String,
    /// Where z = 0 of the plan is.
    pub z_origin: ZOrigin,
    /// What was flown: an address, or the mock drone.
    pub drone: String,
}

/// An entry of the log.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in each tick")]
pub enum Record {
    /// A datagram from the navdata port.
    Navdata {
        /// When it was taken in.
        at: Duration,
        /// The datagram.
        packet: Vec<u8>,
    },
    /// Bytes from the control port.
    Control {
        /// When they were taken in.
        at: Duration,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// An operator's order.
    Order {
        /// When it was taken in.
        at: Duration,
        /// Who gave it.
        by: Operator,
        /// What was ordered.
        order: OperatorOrder,
    },
    /// Something happened.
    Event {
        /// When.
        at: Duration,
        /// What.
        event: FlightEvent,
    },
    /// How the flight ended.
    Outcome {
        /// When.
        at: Duration,
        /// How.
        outcome: Outcome,
    },
    /// Something else to be read by people.
    Note {
        /// When it was said.
        at: Duration,
        /// What.
        text: String,
    },
    /// A tick.
    Tick {
        /// What was known and decided.
        decision: Decision,
        /// How the tick went.
        timing: Timing,
        /// What was sent.
        datagram: Vec<u8>,
    },
}
