//! Inputs, outputs and configuration of the `MAVLink` vehicle.

use std::time::Duration;

use autopilot::plan::FlightLimits;
use autopilot::vehicle::{Operator, OperatorOrder, Refused, StationPatience, Telemetry};

use crate::place::Origin;
use crate::signing::Key;

/// Whose autopilot it claims to be. Modes are numbered as PX4's in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Autopilot {
    /// None that is known: the truth. QGroundControl then shows no buttons for guided flight.
    #[default]
    Generic,
    /// PX4: QGroundControl shows its buttons, and asks for PX4's parameters.
    Px4,
}

/// Configuration of a [`MavlinkVehicle`](super::MavlinkVehicle).
#[derive(Debug, Clone, PartialEq)]
pub struct Config {
    /// Number of the vehicle's system, 1 to 250.
    pub system: u8,
    /// Whose autopilot it claims to be.
    pub autopilot: Autopilot,
    /// Where the start of a flight lies on the globe.
    pub origin: Origin,
    /// The fence of the vehicle.
    pub limits: FlightLimits,
    /// Largest horizontal speed of a mission, in m/s.
    pub max_speed_m_s: f64,
    /// What a silent station means, as told by parameters.
    pub station: StationPatience,
    /// Take no orders.
    pub view_only: bool,
    /// Claim to have a GPS, for which many a client waits.
    pub pretend_gps: bool,
    /// Sign what is sent, and accept nothing that is not signed with this key.
    pub key: Option<Key>,
    /// Time since 1970 at the beginning of the vehicle's time.
    pub unix_time: Duration,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            system: 1,
            autopilot: Autopilot::default(),
            origin: Origin::default(),
            limits: FlightLimits::default(),
            max_speed_m_s: 2.2,
            station: StationPatience::default(),
            view_only: false,
            pretend_gps: false,
            key: None,
            unix_time: Duration::ZERO,
        }
    }
}

/// An order that waits for its answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ticket(pub(super) u32);

/// What arrives.
#[derive(Debug)]
pub enum Input<'a> {
    /// A datagram from one of the peers. What is no frame in it is ignored, and if there is a key, what is not signed with it.
    Datagram {
        /// Number of the peer, which is its own as long as it is not gone.
        peer: u8,
        /// Whether it comes from this machine.
        local: bool,
        /// The datagram.
        bytes: &'a [u8],
    },
    /// A peer is forgotten; its number will be that of another.
    PeerGone(u8),
    /// What the vehicle tells.
    Telemetry(&'a Telemetry),
    /// The vehicle's answer to an order, each of which has one.
    Answer {
        /// The order's.
        ticket: Ticket,
        /// Accepted or not.
        answer: Result<(), Refused>,
    },
}

/// Whom a datagram is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum To {
    /// Every peer.
    All,
    /// One of them.
    Peer(u8),
}

/// What is to be done.
#[derive(Debug)]
pub enum Output<'a> {
    /// A datagram to send.
    Datagram {
        /// Its receivers.
        to: To,
        /// Its content, one frame.
        bytes: &'a [u8],
    },
    /// An order to give to the vehicle, whose answer is [`Input::Answer`].
    Order {
        /// Comes back with the answer.
        ticket: Ticket,
        /// The operator.
        by: Operator,
        /// The order.
        order: OperatorOrder,
    },
}
