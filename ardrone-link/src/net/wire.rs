//! The client's sockets: two for datagrams, and the reader of the control port.

use std::io;
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr};
use std::time::Duration;

use bytes::Bytes;
use tokio::io::AsyncReadExt as _;
use tokio::net::{TcpStream, UdpSocket};
use tokio::sync::mpsc;
use tokio::time::{sleep, timeout};

use super::limits::{BUFFER_BYTES, TICK};
use crate::health::SocketHealth;

/// Interval between attempts to connect to the control port.
const CONTROL_RETRY: Duration = Duration::from_millis(500);

/// A connected socket that receives only from the drone and survives errors.
pub(super) struct Wire {
    name: &'static str,
    drone: SocketAddr,
    pub(super) socket: UdpSocket,
    health: SocketHealth,
}

impl Wire {
    pub(super) async fn new(name: &'static str, drone: SocketAddr) -> io::Result<Self> {
        let socket = connected(drone).await?;
        Ok(Self { name, drone, socket, health: SocketHealth::default() })
    }

    /// Sends a datagram; returns whether the system accepted it.
    pub(super) async fn send(&mut self, now: Duration, datagram: &[u8]) -> bool {
        let sent = timeout(TICK, self.socket.send(datagram)).await;
        let sent = sent.unwrap_or_else(|_| Err(io::ErrorKind::WouldBlock.into()));
        self.judge(now, sent).is_some()
    }

    /// Returns the length that a call returned if it succeeded, and counts its error otherwise.
    pub(super) fn judge(&mut self, now: Duration, result: io::Result<usize>) -> Option<usize> {
        match result {
            Ok(length) => {
                self.health.succeeded();
                Some(length)
            }
            Err(error) => {
                if self.health.failed(now, &error) {
                    tracing::warn!("the system refuses {}: {error}; retrying", self.name);
                }
                None
            }
        }
    }

    /// Reopens the socket if necessary; returns whether it did.
    pub(super) async fn mend(&mut self, now: Duration) -> bool {
        if !self.health.rebind_due(now) {
            return false;
        }
        connected(self.drone).await.map(|socket| self.socket = socket).is_ok()
    }
}

/// A connected socket: the system drops datagrams from any other address.
async fn connected(drone: SocketAddr) -> io::Result<UdpSocket> {
    let any: SocketAddr = match drone {
        SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
        SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
    };
    let socket = UdpSocket::bind(any).await?;
    socket.connect(drone).await?;
    Ok(socket)
}

/// Reads the control port until `out` has no receiver. It reconnects again and again, because the drone may
/// disappear and come back.
pub(super) async fn read_control(address: SocketAddr, out: mpsc::Sender<Bytes>) {
    tokio::select! {
        // An idle connection must not outlive the client.
        () = out.closed() => {}
        () = forward_control(address, &out) => {}
    }
}

async fn forward_control(address: SocketAddr, out: &mpsc::Sender<Bytes>) {
    let mut buffer = [0_u8; BUFFER_BYTES];
    loop {
        match TcpStream::connect(address).await {
            Ok(mut stream) => {
                while let Ok(length @ 1..) = stream.read(&mut buffer).await {
                    if out.send(Bytes::copy_from_slice(&buffer[..length])).await.is_err() {
                        return;
                    }
                }
            }
            Err(error) => tracing::debug!("no control port yet: {error}"),
        }
        sleep(CONTROL_RETRY).await;
    }
}
