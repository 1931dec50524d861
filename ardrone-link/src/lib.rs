//! The AR.Drone 2.0's protocol, without sockets or clocks.
//!
//! - [`at`]: AT commands (UDP 5556), typed, encoded and decoded.
//! - [`navdata`]: the drone's telemetry (UDP 5554), decoded to SI values and encoded again.
//! - [`configuration`]: the text that the drone sends on its control port (TCP 5559).
//! - [`settings`]: configuration keys with their types, units and ranges.
//! - [`session`]: the client's side of the protocol as a pure state machine: wake-up, configuration with
//!   acknowledgement, sequence numbers, watchdogs, loss and restart of the drone.
//! - [`video`]: the live video (TCP 5555): pictures from the stream, without decoding them.
//! - [`selftest`]: asks a drone on the ground what is assumed of it here.
//! - [`health`]: evaluation of socket errors.
//!
//! - `net`, with the feature of that name: a client on real sockets, using tokio.
//!
//! Both directions are implemented here, so that an autopilot and a simulated drone share one definition of
//! the wire format. Wire units do not leave this crate: its types use metres, seconds and degrees, apart from fields of
//! navdata that have no unit in their name, which are the firmware's own numbers.
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

/// Compiles the README's examples; the first one is also flown by the system tests.
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
pub mod selftest;
pub mod session;
pub mod settings;
pub mod video;

pub use at::{Identity, Motion};
pub use configuration::Configuration;
pub use navdata::{ControlState, Demo, DroneState, Navdata, NavdataOption, Packet};
#[cfg(feature = "net")]
pub use net::{
    Client, ClientBuilder, ClientError, ConfigureError, Events, FlightError, Packets, ReadyError,
    Refusal, StartError, Steering, VideoNews, VideoStream, WaitError,
};
pub use session::{Event, FlightOrder, Input, Order, Output, Session, SessionConfig};
pub use settings::{NavdataMode, Setting, SettingError};

/// The drone's address on its own network.
pub const DRONE_HOST: &str = "192.168.1.1";
/// UDP: AT commands to the drone.
pub const AT_PORT: u16 = 5556;
/// UDP: navdata, sent to the address that last sent [`WAKE_UP`].
pub const NAVDATA_PORT: u16 = 5554;
/// TCP: the configuration dump.
pub const CONTROL_PORT: u16 = 5559;
/// TCP: live video.
pub const VIDEO_PORT: u16 = 5555;
/// TCP: FTP, with the firmware's version in the file `version.txt`.
pub const FTP_PORT: u16 = 5551;
/// The datagram that makes the drone send navdata to its sender.
pub const WAKE_UP: [u8; 4] = [1, 0, 0, 0];

/// Network address of a drone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DroneAddress {
    /// Host name or IP address.
    pub host: String,
    /// UDP port for AT commands.
    pub at_port: u16,
    /// UDP port of the navdata.
    pub navdata_port: u16,
    /// TCP port of the configuration.
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

/// Whether a socket error is only temporary: there is nothing to read, or the drone is not there at the
/// moment. The session monitors the drone's silence.
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
