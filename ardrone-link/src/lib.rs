//! The AR.Drone 2.0's own protocol, without sockets or clocks.
//!
//! - [`at`]: AT commands (UDP 5556), typed, encoded and decoded.
//! - [`navdata`]: what the drone says (UDP 5554), decoded to SI values and encoded again.
//! - [`configuration`]: the text that the drone sends on its control port (TCP 5559).
//! - [`settings`]: the configuration's keys with their types, units and ranges.
//! - [`session`]: the client's side of the conversation as a pure state machine: wake-up,
//!   configuration with acknowledge, sequence rules, watchdogs, loss and restart.
//! - [`health`]: what the errors of a datagram socket mean.
//!
//! - `net`, with the feature of that name: a client on real sockets, by tokio.
//!
//! Both directions are coded here, so that a pilot and a simulated drone share one definition of
//! the wire. Wire units end at this crate's edge: everything inside is metres, seconds and degrees.
//!
//! ```
//! use ardrone_link::at::{Command, Datagram, Ref};
//!
//! let mut datagram = Datagram::new();
//! datagram.push(1, &Command::Ref(Ref::TakeOff))?;
//! assert_eq!(datagram.as_bytes(), b"AT*REF=1,290718208\r");
//! # Ok::<(), ardrone_link::at::EncodeError>(())
//! ```
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

/// The README's examples are compiled here; the first is flown by the system tests.
#[cfg(all(doctest, feature = "net"))]
#[doc = include_str!("../README.md")]
pub struct Readme;

pub mod at;
pub mod configuration;
pub mod health;
pub mod navdata;
#[cfg(feature = "net")]
#[expect(clippy::disallowed_methods, reason = "the client has sockets and a clock")]
pub mod net;
pub mod session;
pub mod settings;

pub use at::{Identity, Motion};
pub use configuration::Configuration;
pub use navdata::{ControlState, Demo, DroneState, Navdata, NavdataOption, Packet};
#[cfg(feature = "net")]
pub use net::{
    Client, ClientBuilder, ClientError, ConfigureError, Events, FlightError, Packets, ReadyError,
    Refusal, StartError, Steering, WaitError,
};
pub use session::{Event, FlightOrder, Order, Session, SessionConfig};
pub use settings::{NavdataMode, Setting, SettingError};

/// The drone's address on its own network.
pub const DRONE_HOST: &str = "192.168.1.1";
/// UDP: AT commands to the drone.
pub const AT_PORT: u16 = 5556;
/// UDP: navdata, answered to the address that woke it.
pub const NAVDATA_PORT: u16 = 5554;
/// TCP: the configuration dump.
pub const CONTROL_PORT: u16 = 5559;
/// TCP: live video.
pub const VIDEO_PORT: u16 = 5555;
/// TCP: FTP with the firmware's version.
pub const FTP_PORT: u16 = 5551;
/// The datagram that makes the drone send navdata to its sender.
pub const WAKE_UP: [u8; 4] = [1, 0, 0, 0];

/// Where a drone is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DroneAddress {
    /// Name or address.
    pub host: String,
    /// UDP, AT commands.
    pub at_port: u16,
    /// UDP, navdata.
    pub navdata_port: u16,
    /// TCP, configuration.
    pub control_port: u16,
}

impl Default for DroneAddress {
    fn default() -> Self {
        Self {
            host: DRONE_HOST.to_owned(),
            at_port: AT_PORT,
            navdata_port: NAVDATA_PORT,
            control_port: CONTROL_PORT,
        }
    }
}

/// Whether a datagram socket's error is only of the moment: there is nothing to read, or the other
/// side is not there now. Silence is judged by the session.
pub fn is_passing(error: &std::io::Error) -> bool {
    use std::io::ErrorKind::{
        ConnectionRefused, ConnectionReset, HostUnreachable, Interrupted, NetworkDown,
        NetworkUnreachable, WouldBlock,
    };
    matches!(
        error.kind(),
        WouldBlock
            | Interrupted
            | ConnectionRefused
            | ConnectionReset
            | HostUnreachable
            | NetworkUnreachable
            | NetworkDown
    )
}
