//! MAVLink: ground stations and programs of others see the drone as one of theirs.
//!
//! All of MAVLink is in the pure [`MavlinkVehicle`](mavlink_vehicle::MavlinkVehicle). Here is its shell: one UDP
//! socket and a clock, and no access to the flight except its [`Controls`]. No client can affect the tick: what arrives is
//! bounded in each 20 ms, and orders go the way of all others.
//!
//! The program speaks first, to the remotes that it is told, and answers whoever else speaks MAVLink to its port. If all
//! remotes are on this machine, the socket cannot be reached from elsewhere.

mod peers;
mod server;

use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicU64, Ordering};

use autopilot::vehicle::Telemetry;
use crossbeam_channel::{Sender, bounded};
use mavlink_vehicle::Config;

use self::server::Server;
use crate::flight::{Content, Controls, Message};
use crate::runtime::Runtime;

/// Messages of the flight that may wait to be told: a second of the fastest.
const BEHIND: usize = 256;

/// Most remotes that can be spoken to, which leaves places for others who speak first.
pub const MOST_REMOTES: usize = 4;

/// Why there is no MAVLink.
#[derive(Debug, thiserror::Error)]
pub enum MavlinkError {
    /// No socket.
    #[error("cannot open a socket for MAVLink at {address}")]
    Bind {
        /// Where it should be.
        address: SocketAddr,
        /// The system's error.
        source: std::io::Error,
    },
    /// The socket cannot be used.
    #[error("cannot use the socket for MAVLink")]
    Socket(#[source] std::io::Error),
}

/// A bound socket, reserved before the flight begins.
#[derive(Debug)]
pub struct Listener {
    socket: UdpSocket,
    remotes: Vec<SocketAddr>,
}

impl Listener {
    /// Opens the socket from which these remotes are spoken to: their IPv4 addresses. Those beyond [`MOST_REMOTES`] are left out.
    ///
    /// # Errors
    /// [`MavlinkError::Bind`] if the system has no socket for it.
    pub fn bind(mut remotes: Vec<SocketAddr>) -> Result<Self, MavlinkError> {
        remotes.truncate(MOST_REMOTES);
        let here = remotes.iter().all(|remote| remote.ip().is_loopback());
        let host = if here { Ipv4Addr::LOCALHOST } else { Ipv4Addr::UNSPECIFIED };
        let address = SocketAddr::from((host, 0));
        let error = |source| MavlinkError::Bind { address, source };
        let socket = UdpSocket::bind(address).map_err(error)?;
        socket.set_nonblocking(true).map_err(error)?;
        Ok(Self { socket, remotes })
    }

    /// Starts the vehicle; the time of its configuration is set here.
    ///
    /// # Errors
    /// [`MavlinkError::Socket`] if the runtime cannot use the socket.
    pub fn open(
        self,
        runtime: &Runtime,
        config: Config,
        controls: Controls,
    ) -> Result<MavlinkServer, MavlinkError> {
        let (telemetry, told) = bounded(BEHIND);
        let server = Server::start(runtime, self.socket, &self.remotes, config, controls, told)
            .map_err(MavlinkError::Socket)?;
        Ok(MavlinkServer { telemetry, missed: AtomicU64::new(0), _server: server })
    }
}

/// The vehicle as MAVLink's clients see it. Dropping it tells them the last news, and ends.
#[derive(Debug)]
pub struct MavlinkServer {
    telemetry: Sender<Telemetry>,
    /// Messages for which there was no room.
    missed: AtomicU64,
    _server: Server,
}

impl MavlinkServer {
    /// Takes in a message of the flight; never blocks.
    pub fn show(&self, message: &Message) {
        // The rest the status says, or it is of no interest to others.
        let Content::Telemetry(_, telemetry, _) = &message.content else { return };
        if self.telemetry.try_send(telemetry.clone()).is_err() {
            self.missed.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl Drop for MavlinkServer {
    fn drop(&mut self) {
        if let missed @ 1.. = self.missed.load(Ordering::Relaxed) {
            tracing::warn!("MAVLink was too slow: {missed} messages of the flight were lost");
        }
    }
}
