//! Inputs and outputs of a session.

use crate::at::{Config, Motion};
use crate::configuration::Configuration;
use crate::navdata::{Navdata, NavdataError};

/// An input of a session.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Input<'a> {
    /// A datagram from the drone's navdata port.
    Navdata(&'a [u8]),
    /// Bytes from the drone's control port.
    Control(&'a [u8]),
    /// The beginning of a tick, every 30 ms, with the order that it carries out. Nothing is sent until
    /// navdata arrive, because the drone may already be flying: any REF would land it or compete with its
    /// pilot. A REF that could lift the drone is left out while the drone is silent for 300 ms or more.
    Tick(Order),
    /// A tick without a command, for a drone that another pilot flies: its silence is still detected.
    Listen,
    /// A tick of a program that is about to exit: landing and centred sticks. A requested cut of the motors
    /// continues. Nothing is sent to a drone that was never sent anything, because another client may fly it.
    Part,
    /// A request, which takes effect in the next tick.
    Request(Request),
}

/// A request to a session.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Request {
    /// Change one more key once the session is ready and earlier requests are complete; it replaces an
    /// earlier value. The result is [`Event::Configured`] or [`Event::ConfigurationTimedOut`]. From then on
    /// it is one of the settings, which are applied again after a loss or a restart.
    Setting(Config),
    /// Apply all settings again, because another client may have changed them. The session is not ready until
    /// this is complete.
    AllSettings,
    /// Set the level reference in the next tick. The drone must stand on level ground; in flight the request
    /// is dropped.
    FlatTrim,
    /// Cut the motors at once, wherever the drone is: **it falls**. Repeated until the drone reports that
    /// they are cut, for 5 s at most.
    EmergencyStop,
    /// Make sure that the next tick's commands are obeyed, whatever numbers another client has used: the drone does not do
    /// what it was told. Repeat it as long as that lasts. Each time a delayed old datagram may be obeyed, too.
    Insist,
    /// Clear an emergency so that the drone can fly again. Repeated until the drone reports none, for 5 s at most. Use it
    /// only on the ground, after a person has inspected the drone.
    EmergencyReset,
}

/// Something to send to the drone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transmit<'a> {
    /// The datagram of this tick, to the AT port.
    Command(&'a [u8]),
    /// [`crate::WAKE_UP`], to the navdata port.
    WakeUp,
}

/// An output of a session.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Output<'a> {
    /// A datagram for the drone.
    Transmit(Transmit<'a>),
    /// An event, in the order of occurrence.
    Event(Event),
    /// New navdata. Packets that are older than the last one, and repetitions of it, are only counted.
    Navdata(Navdata),
    /// A damaged packet was dropped.
    Damaged(NavdataError),
}

/// The client's order for one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// The REF level.
    pub flight: FlightOrder,
    /// The PCMD arguments.
    pub motion: Motion,
}

impl Order {
    /// Land, or stay on the ground, with the sticks at rest.
    pub const LAND: Self = Self { flight: FlightOrder::Land, motion: Motion::Hover };
}

/// Take-off and landing level of an order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlightOrder {
    /// Land, or stay on the ground.
    Land,
    /// Take off.
    TakeOff,
    /// Stay in the air. Never takes off: after a restart or a loss of the drone it is sent as
    /// [`FlightOrder::Land`].
    StayAirborne,
}

/// An event of a session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// First navdata since the start or since a loss.
    Connected,
    /// The drone acknowledged a configuration key.
    Configured {
        /// `section:name`
        key: String,
    },
    /// The drone did not acknowledge a configuration key within 2 s. The next key follows.
    ConfigurationTimedOut {
        /// `section:name`
        key: String,
    },
    /// The configuration was read back over the control port.
    ConfigurationRead(Configuration),
    /// The configuration could not be read back within 6 s.
    ConfigurationNotRead,
    /// The handshake is complete: each setting was acknowledged or timed out, and the configuration, where it is asked for,
    /// was read back or could not be. The events before it say which.
    Ready,
    /// No navdata for [`loss_timeout`](super::SessionConfig::loss_timeout).
    LinkLost,
    /// The drone has restarted: its state is reset, take-off orders are withdrawn.
    DroneRestarted,
    /// The drone has left the ground.
    Airborne,
    /// The drone is on the ground again. Not said of one that falls with its motors cut.
    Landed,
    /// The drone has not left the ground within [`take_off_timeout`](super::SessionConfig::take_off_timeout).
    TakeOffTimedOut,
    /// The emergency bit rose: the motors are cut.
    Emergency,
    /// The emergency bit fell.
    EmergencyCleared,
}

/// Counters of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Packets accepted.
    pub received: u64,
    /// Packets dropped because they were old or repeated.
    pub stale: u64,
    /// Packets dropped because they were damaged.
    pub damaged: u64,
}
