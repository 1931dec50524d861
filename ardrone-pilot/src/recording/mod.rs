//! The flight log: all inputs, decisions and outputs, as an MCAP file.
//!
//! The tick passes [`Record`]s through a bounded channel and never waits; if the disk is too slow, records
//! are dropped and counted. A separate thread writes the file. Flushed records survive a crash of the
//! process.

mod compressed_video;
mod messages;
mod neighbour;
mod order;
mod pictures;
mod reader;
mod recorder;
mod topic;
mod writer;

use std::fmt;
use std::time::Duration;

pub use messages::{
    Agent, AgentMessage, Bytes, ChosenPlan, Command, DecodedNavdata, Estimate, GpsPosition,
    Mission, Place, Progress, Tag, Tags, Tick, Timing,
};
pub use neighbour::Neighbour;
pub use order::Order;
pub use pictures::{RecordedPicture, pictures};
pub use reader::{Entry, LARGEST_FILE_BYTES, Log, LogError};
pub use recorder::{Recorded, Recorder, Recording, RecordingError, VideoRecorder};
pub use writer::LogWriter;

use autopilot::plan::ZOrigin;
use autopilot::separation;
use autopilot::vehicle::{
    Decision, Input, Operator, OperatorOrder, Telemetry, Transmit, VehicleName,
};
use mission_agent::{Line, Said};
use time::UtcDateTime;

use crate::drive::Passed;

/// Names of attachments.
const AGENT_FILE: &str = "autopilot.asl";
const PLAN_FILE: &str = "plan.txt";
const SETTINGS_FILE: &str = "pilot.toml";
/// The `name` of a log line: what it is about.
const EVENT: &str = "event";
const OUTCOME: &str = "outcome";
/// Version of the message format.
const FORMAT: u32 = 7;
/// Name of the metadata record.
const FLIGHT: &str = "flight";

/// Description of the recorded flight.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Header {
    /// The vehicle's name.
    pub vehicle: VehicleName,
    /// Origin of the flight's time, since the Unix epoch.
    pub start: Duration,
    /// The plan's file name.
    pub plan_name: String,
    /// The plan.
    pub plan: String,
    /// The mission agent that has the place of a plan; empty without one.
    pub mission_agent: String,
    /// The settings in effect, as TOML.
    pub settings: String,
    /// Origin of the plan's heights.
    pub z_origin: ZOrigin,
    /// The drone: an address, or the mock drone.
    pub drone: String,
}

/// An entry of the log. Times count from the start of the flight ([`Header::start`]).
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in each tick")]
pub enum Record {
    /// A datagram from the navdata port.
    Navdata {
        /// Time of handling.
        at: Duration,
        /// The datagram.
        packet: Vec<u8>,
    },
    /// Bytes from the control port.
    Control {
        /// Time of handling.
        at: Duration,
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// An operator's order.
    Order {
        /// Time of handling.
        at: Duration,
        /// The operator.
        by: Operator,
        /// The order.
        order: OperatorOrder,
    },
    /// What another vehicle told of itself.
    Neighbour {
        /// Time of handling.
        at: Duration,
        /// What.
        neighbour: separation::Neighbour,
    },
    /// What the vehicle told: events, missions and outcomes.
    Telemetry {
        /// Its time.
        at: Duration,
        /// What.
        telemetry: Telemetry,
    },
    /// What the vehicle's agent said to that of another one.
    Said {
        /// Its time.
        at: Duration,
        /// To whom, and what.
        said: Said,
    },
    /// What was said to the vehicle's agent.
    Heard {
        /// Its time.
        at: Duration,
        /// What.
        line: Line,
    },
    /// Another event, as text.
    Note {
        /// Its time.
        at: Duration,
        /// Its text.
        text: String,
    },
    /// A picture of the camera.
    Picture {
        /// Time of its arrival.
        at: Duration,
        /// The encoded picture.
        picture: bytes::Bytes,
    },
    /// A tick.
    Tick {
        /// The decision.
        decision: Decision,
        /// Timing of the tick.
        timing: Timing,
        /// The datagram that was sent.
        datagram: Vec<u8>,
    },
}

/// Name of the log of a flight that starts then, since the Unix epoch: `2026-11-21T13-45-07Z-ardrone.mcap`. Names that sort by
/// time, differ for each vehicle, and are valid on any file system.
pub fn file_name(start: Duration, vehicle: impl fmt::Display) -> String {
    let start = UtcDateTime::UNIX_EPOCH + start;
    let (date, time) = (start.date(), start.time());
    format!(
        "{:04}-{:02}-{:02}T{:02}-{:02}-{:02}Z-{vehicle}.mcap",
        date.year(),
        u8::from(date.month()),
        date.day(),
        time.hour(),
        time.minute(),
        time.second()
    )
}

impl Record {
    /// The entry for what passes a vehicle, if there is one; `copy` copies bytes, and may have no room for them.
    pub fn of(
        at: Duration,
        passed: &Passed<'_>,
        copy: impl FnOnce(&[u8]) -> Option<Vec<u8>>,
    ) -> Option<Self> {
        Some(match passed {
            Passed::Input(Input::Navdata(packet), _) => Self::Navdata { at, packet: copy(packet)? },
            Passed::Input(Input::Control(bytes), _) => Self::Control { at, bytes: bytes.to_vec() },
            // Even if it was refused: a replay refuses it again.
            Passed::Input(Input::Order(by, order), _) => {
                Self::Order { at, by: *by, order: order.clone() }
            }
            Passed::Input(Input::Neighbour(neighbour), _) => {
                Self::Neighbour { at, neighbour: *neighbour }
            }
            Passed::Sent { transmit: Transmit::Command { datagram, decision }, late, work } => {
                let ms = |time: &Duration| time.as_secs_f64() * 1e3;
                let timing = Timing { late_ms: ms(late), work_ms: ms(work) };
                Self::Tick { decision: *(*decision)?, timing, datagram: copy(datagram)? }
            }
            Passed::Told(
                telemetry
                @ (Telemetry::Event(_) | Telemetry::Mission { .. } | Telemetry::Ended(..)),
            ) => Self::Telemetry { at, telemetry: telemetry.clone() },
            Passed::Said(said) => Self::Said { at, said: *said },
            Passed::Heard(heard) => Self::Heard { at, line: heard.line },
            // The rest can be seen in the ticks.
            Passed::Misunderstood(_)
            | Passed::Unsaid(..)
            | Passed::Input(Input::Tick | Input::Part, _)
            | Passed::Sent { transmit: Transmit::WakeUp, .. }
            | Passed::Told(_) => return None,
        })
    }
}
