//! Sockets of a flight. A socket error never ends the flight.

use std::fmt;
use std::io;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::Duration;

use ardrone_link::health::SocketHealth;
use ardrone_link::{DroneAddress, WAKE_UP};
use mission_agent::Misunderstood;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::net::sockopt::set_socket_recv_buffer_size;

use crate::drive::NoRoom;

/// Size of the navdata socket's receive buffer. It holds fewer datagrams than a tick reads, so no datagram is
/// ever older than one tick.
const KEPT_BYTES: usize = 128 << 10;
/// After this time without navdata the socket is suspected to be broken.
const NAVDATA_PATIENCE: Duration = Duration::from_millis(200);

/// A UDP channel to the drone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Port {
    /// AT commands.
    At,
    /// Navdata.
    Navdata,
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::At => "AT commands",
            Self::Navdata => "navdata",
        })
    }
}

/// A problem of the network, or of what agents say. The flight goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trouble {
    /// The system refused a datagram.
    Refused {
        /// The channel.
        port: Port,
        /// Kind of the error.
        kind: io::ErrorKind,
        /// The system's error number, if any.
        number: Option<i32>,
    },
    /// More datagrams arrive from the drone's address than a tick reads.
    Flood,
    /// The agent of another vehicle has said what this one does not understand.
    Misunderstood(Misunderstood),
    /// So many lines that the agent said are lost, since that was told last.
    Unsaid(NoRoom, u64),
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused { port, kind, number } => {
                let error = number.map_or(io::Error::from(*kind), io::Error::from_raw_os_error);
                write!(f, "the system refuses {port}: {error}; retrying")
            }
            Self::Flood => f.write_str("navdata arrive faster than they can be processed"),
            Self::Misunderstood(problem) => {
                write!(f, "the agent of another vehicle is not understood: {problem}")
            }
            Self::Unsaid(why, 1) => write!(f, "the agent says a line that is lost: {why}"),
            Self::Unsaid(why, count) => {
                write!(f, "the agent says {count} lines that are lost: {why}")
            }
        }
    }
}

/// The sockets to one drone.
#[derive(Debug)]
pub(super) struct Link {
    at: Wire,
    navdata: Wire,
    /// Arrival of the newest datagram.
    heard_at: Option<Duration>,
    /// Nothing more is received until the next tick.
    rests: bool,
    trouble: Option<Trouble>,
    bound_anew: u64,
}

impl Link {
    /// # Errors
    /// The system's error if no socket can be opened.
    pub(super) fn new(host: IpAddr, drone: &DroneAddress) -> io::Result<Self> {
        Ok(Self {
            at: Wire::new(Port::At, SocketAddr::new(host, drone.at_port))?,
            navdata: Wire::new(Port::Navdata, SocketAddr::new(host, drone.navdata_port))?,
            heard_at: None,
            rests: false,
            trouble: None,
            bound_anew: 0,
        })
    }

    /// Sends a datagram of AT commands; returns whether the system accepted it.
    pub(super) fn send(&mut self, now: Duration, datagram: &[u8]) -> bool {
        let sent = self.at.send(datagram);
        let sent = self.judge(Port::At, now, sent).is_some();
        if self.mend(Port::At, now) && self.is_silent(now) {
            self.bind_navdata_anew();
        }
        sent
    }

    /// Requests navdata.
    pub(super) fn wake_up(&mut self, now: Duration) {
        let sent = self.navdata.send(&WAKE_UP);
        self.judge(Port::Navdata, now, sent);
        if self.mend(Port::Navdata, now) {
            self.ask_again();
        }
    }

    /// The next navdata datagram; never blocks.
    pub(super) fn receive(&mut self, now: Duration, buffer: &mut [u8]) -> Option<usize> {
        if self.rests {
            return None;
        }
        let received = self.navdata.socket.recv(buffer);
        let failed = received.as_ref().is_err_and(|error| {
            !matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted)
        });
        let length = self.judge(Port::Navdata, now, received);
        if length.is_some() {
            self.heard_at = Some(now);
        } else if failed {
            // Stops until the next tick, because an unknown error could repeat without end.
            self.rests = true;
            if self.mend(Port::Navdata, now) {
                self.ask_again();
            }
        }
        length
    }

    /// Sleeps until navdata arrive or `time` has passed.
    pub(super) fn wait(&mut self, time: Duration) {
        let timeout = Timespec {
            tv_sec: i64::try_from(time.as_secs()).unwrap_or(i64::MAX),
            tv_nsec: i64::from(time.subsec_nanos()),
        };
        if !self.rests {
            let mut sockets = [PollFd::new(&self.navdata.socket, PollFlags::IN)];
            match poll(&mut sockets, Some(&timeout)) {
                Ok(_) | Err(rustix::io::Errno::INTR) => return,
                Err(_) => self.rests = true,
            }
        }
        sleep(time);
    }

    /// Stops receiving until [`Link::begin_tick`].
    pub(super) fn rest(&mut self) {
        self.rests = true;
    }

    /// Marks the begin of a tick.
    pub(super) fn begin_tick(&mut self) {
        self.rests = false;
    }

    /// The next problem to report.
    pub(super) fn poll_trouble(&mut self) -> Option<Trouble> {
        self.trouble.take()
    }

    /// Failed calls on both sockets, and how often one was reopened.
    pub(super) fn failures(&self) -> (u64, u64) {
        (self.at.health.errors() + self.navdata.health.errors(), self.bound_anew)
    }

    fn wire(&mut self, port: Port) -> &mut Wire {
        match port {
            Port::At => &mut self.at,
            Port::Navdata => &mut self.navdata,
        }
    }

    /// Evaluates the result of a call; returns its value if it succeeded.
    fn judge(&mut self, port: Port, now: Duration, result: io::Result<usize>) -> Option<usize> {
        let health = &mut self.wire(port).health;
        match result {
            Ok(length) => {
                health.succeeded();
                Some(length)
            }
            Err(error) => {
                if health.failed(now, &error) {
                    let (kind, number) = (error.kind(), error.raw_os_error());
                    self.trouble = Some(Trouble::Refused { port, kind, number });
                }
                None
            }
        }
    }

    /// Reopens a socket if necessary; returns whether it did.
    fn mend(&mut self, port: Port, now: Duration) -> bool {
        let wire = self.wire(port);
        let mended = wire.health.rebind_due(now) && wire.bind_anew();
        self.bound_anew += u64::from(mended);
        mended
    }

    fn is_silent(&self, now: Duration) -> bool {
        self.heard_at.is_none_or(|heard_at| now.saturating_sub(heard_at) >= NAVDATA_PATIENCE)
    }

    fn bind_navdata_anew(&mut self) {
        if self.navdata.bind_anew() {
            self.bound_anew += 1;
            self.ask_again();
        }
    }

    /// Requests navdata again, because the drone sends them to the socket that asked last.
    fn ask_again(&mut self) {
        // The session repeats the request while no navdata come.
        _ = self.navdata.send(&WAKE_UP);
    }
}

/// A connected socket: the system drops datagrams from any other address.
#[derive(Debug)]
struct Wire {
    drone: SocketAddr,
    port: Port,
    socket: UdpSocket,
    health: SocketHealth,
}

impl Wire {
    fn new(port: Port, drone: SocketAddr) -> io::Result<Self> {
        let socket = connected(port, drone)?;
        Ok(Self { drone, port, socket, health: SocketHealth::default() })
    }

    fn send(&self, datagram: &[u8]) -> io::Result<usize> {
        self.socket.send(datagram)
    }

    /// Replaces this socket by a new one; returns whether that succeeded.
    fn bind_anew(&mut self) -> bool {
        let socket = connected(self.port, self.drone);
        socket.map(|socket| self.socket = socket).is_ok()
    }
}

fn connected(port: Port, drone: SocketAddr) -> io::Result<UdpSocket> {
    let socket = UdpSocket::bind(("0.0.0.0", 0))?;
    socket.connect(drone)?;
    socket.set_nonblocking(true)?;
    if port == Port::Navdata {
        // A larger buffer would only keep older datagrams.
        _ = set_socket_recv_buffer_size(&socket, KEPT_BYTES);
    }
    Ok(socket)
}

/// Sleeps for `time`.
pub(super) fn sleep(time: Duration) {
    std::thread::sleep(time);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drone that only receives.
    fn drone() -> (UdpSocket, UdpSocket, Link) {
        let bind = || UdpSocket::bind(("127.0.0.1", 0)).unwrap();
        let (at, navdata) = (bind(), bind());
        let port = |socket: &UdpSocket| socket.local_addr().unwrap().port();
        let address = DroneAddress {
            at_port: port(&at),
            navdata_port: port(&navdata),
            ..DroneAddress::default()
        };
        let link = Link::new(IpAddr::from([127, 0, 0, 1]), &address).unwrap();
        (at, navdata, link)
    }

    #[test]
    fn sockets_that_fail_are_bound_anew_and_navdata_asked_for_again() {
        let (at, navdata, mut link) = drone();
        let before =
            [link.at.socket.local_addr().unwrap(), link.navdata.socket.local_addr().unwrap()];
        let lost = || Err(io::Error::from(io::ErrorKind::AddrNotAvailable));
        let now = Duration::from_secs(1);
        assert_eq!(link.judge(Port::At, now, lost()), None);
        let reported = link.poll_trouble().unwrap();
        assert!(matches!(reported, Trouble::Refused { port: Port::At, .. }), "{reported}");
        // Before another call can succeed.
        assert!(link.mend(Port::At, now) && link.is_silent(now));
        link.bind_navdata_anew();
        let after =
            [link.at.socket.local_addr().unwrap(), link.navdata.socket.local_addr().unwrap()];
        assert!(before[0] != after[0] && before[1] != after[1]);
        assert!(link.send(now, b"AT*REF=1,290717696\r"));
        let mut buffer = [0; 100];
        assert_eq!(at.recv_from(&mut buffer).unwrap().1.port(), after[0].port());
        let (length, from) = navdata.recv_from(&mut buffer).unwrap();
        assert_eq!((&buffer[..length], from.port()), (&WAKE_UP[..], after[1].port()));
        assert_eq!(link.failures(), (1, 2));
    }

    #[test]
    fn a_socket_that_cannot_receive_is_not_asked_for_ever() {
        let (at, navdata, mut link) = drone();
        // Nobody listens any more: the system reports it with the next call.
        drop((at, navdata));
        link.wake_up(Duration::ZERO);
        let start = crate::flight::real_time::clock();
        let time = Duration::from_millis(50);
        link.wait(time);
        let mut buffer = [0; 100];
        assert_eq!(link.receive(Duration::ZERO, &mut buffer), None);
        assert!(link.rests);
        link.wait(time);
        assert!(start.elapsed() >= time, "it sleeps");
        link.begin_tick();
        assert!(!link.rests);
    }
}
