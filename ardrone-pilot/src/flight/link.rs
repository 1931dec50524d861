//! The sockets of a flight. No error of theirs ends it.

use std::fmt;
use std::io;
use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::time::Duration;

use ardrone_link::health::SocketHealth;
use ardrone_link::{DroneAddress, WAKE_UP};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::net::sockopt::set_socket_recv_buffer_size;

/// What the system keeps of navdata between two looks. A tick looks at more datagrams than fit, so none
/// is ever older than a tick.
const KEPT_BYTES: usize = 128 << 10;
/// Navdata that have not come for so long may have lost their socket.
const NAVDATA_PATIENCE: Duration = Duration::from_millis(200);

/// One of the two ways to the drone.
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

/// What is wrong on this side of the link. The flight goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trouble {
    /// The system refused a datagram.
    Refused {
        /// On which way.
        port: Port,
        /// What kind of error that was.
        kind: io::ErrorKind,
        /// Its number, if it has one.
        number: Option<i32>,
    },
    /// More datagrams come from the drone's address than are looked at.
    Flood,
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused { port, kind, number } => {
                let error = number.map_or(io::Error::from(*kind), io::Error::from_raw_os_error);
                write!(f, "the system refuses {port}: {error}; trying on")
            }
            Self::Flood => f.write_str("navdata come faster than they can be looked at"),
        }
    }
}

/// The sockets to one drone.
#[derive(Debug)]
pub(super) struct Link {
    at: Wire,
    navdata: Wire,
    /// When a datagram last came.
    heard_at: Option<Duration>,
    /// Nothing can be received until the next tick.
    rests: bool,
    trouble: Option<Trouble>,
    bound_anew: u64,
}

impl Link {
    /// # Errors
    /// What the system says if no socket can be had.
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

    /// Sends a datagram of AT commands; returns whether the system took it.
    pub(super) fn send(&mut self, now: Duration, datagram: &[u8]) -> bool {
        let sent = self.at.send(datagram);
        let sent = self.judge(Port::At, now, sent).is_some();
        if self.mend(Port::At, now) && self.is_silent(now) {
            self.bind_navdata_anew();
        }
        sent
    }

    /// Asks for navdata.
    pub(super) fn wake_up(&mut self, now: Duration) {
        let sent = self.navdata.send(&WAKE_UP);
        self.judge(Port::Navdata, now, sent);
        if self.mend(Port::Navdata, now) {
            self.ask_again();
        }
    }

    /// The next datagram of navdata; never waits.
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
            // It is not asked for ever what it does not know.
            self.rests = true;
            if self.mend(Port::Navdata, now) {
                self.ask_again();
            }
        }
        length
    }

    /// Sleeps until navdata arrive or the time is over.
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

    /// Nothing more is received before [`Link::begin_tick`].
    pub(super) fn rest(&mut self) {
        self.rests = true;
    }

    /// A tick begins.
    pub(super) fn begin_tick(&mut self) {
        self.rests = false;
    }

    /// What somebody should be told of.
    pub(super) fn poll_trouble(&mut self) -> Option<Trouble> {
        self.trouble.take()
    }

    /// Calls that failed on either socket, and how often one was bound anew.
    pub(super) fn failures(&self) -> (u64, u64) {
        (self.at.health.errors() + self.navdata.health.errors(), self.bound_anew)
    }

    fn wire(&mut self, port: Port) -> &mut Wire {
        match port {
            Port::At => &mut self.at,
            Port::Navdata => &mut self.navdata,
        }
    }

    /// What came of a call, if it succeeded.
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

    /// Binds a socket anew if it needs that; returns whether it did.
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

    /// The drone sends navdata to the socket that asked last.
    fn ask_again(&mut self) {
        // The session asks on while nothing comes.
        _ = self.navdata.send(&WAKE_UP);
    }
}

/// A socket that hears only the drone: the system drops datagrams from anybody else.
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

    /// Takes a new socket in place of this one; returns whether one could be had.
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
        // A larger one only keeps what is older.
        _ = set_socket_recv_buffer_size(&socket, KEPT_BYTES);
    }
    Ok(socket)
}

/// Sleeps for this time.
pub(super) fn sleep(time: Duration) {
    std::thread::sleep(time);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drone that only listens.
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
        let told = link.poll_trouble().unwrap();
        assert!(matches!(told, Trouble::Refused { port: Port::At, .. }), "{told}");
        // Before anybody can send again.
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
        // Nobody listens: the system tells it with the next call.
        drop((at, navdata));
        link.wake_up(Duration::ZERO);
        let start = crate::flight::clock();
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
