//! A relay in front of the drone that records the pilot's datagrams, floods it, or keeps its control port
//! busy.

use std::io::Write as _;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, UdpSocket};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ardrone_link::DroneAddress;
use ardrone_link::at::{Command, Motion, Ref, decode};
use mock_drone::server::{MockDrone, Ports};
use mock_drone::{Truth, WorldConfig};

/// A datagram of the pilot.
#[derive(Debug, Clone)]
pub(crate) struct Said {
    pub(crate) at: Instant,
    pub(crate) commands: Vec<(u32, Command)>,
}

impl Said {
    fn says(&self, wanted: &Command) -> bool {
        self.commands.iter().any(|(_, command)| command == wanted)
    }

    /// Whether it contains only a landing order and centred sticks.
    pub(crate) fn parts(&self) -> bool {
        self.commands.len() == 2
            && self.says(&Command::Ref(Ref::Land))
            && self.says(&Command::Pcmd(Motion::Hover))
    }
}

/// A simulated drone with the relay in front of it.
pub(crate) struct Relay {
    mock: MockDrone,
    shared: Arc<Shared>,
    address: DroneAddress,
    threads: Vec<JoinHandle<()>>,
}

#[derive(Default)]
struct Shared {
    said: Mutex<Vec<Said>>,
    /// Address of the pilot's navdata socket.
    pilot: Mutex<Option<SocketAddr>>,
    /// Until when the pilot is flooded.
    flood: Mutex<Option<Instant>>,
    /// Number of datagrams of the flood.
    flooded: AtomicU64,
    busy: AtomicBool,
    over: AtomicBool,
}

const LOOK: Duration = Duration::from_millis(20);

fn socket() -> UdpSocket {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    socket.set_read_timeout(Some(LOOK)).unwrap();
    socket
}

impl Relay {
    /// Starts a drone in this world behind a relay.
    pub(crate) fn start(world: &WorldConfig) -> Self {
        let mock = MockDrone::start(world, Ports::LOOPBACK).unwrap();
        let ports = mock.ports();
        let shared = Arc::new(Shared::default());
        let (at, navdata, drone) = (socket(), socket(), socket());
        let control = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let address = DroneAddress {
            host: ports.host.to_string(),
            at_port: at.local_addr().unwrap().port(),
            navdata_port: navdata.local_addr().unwrap().port(),
            control_port: control.local_addr().unwrap().port(),
        };
        drone.connect((ports.host, ports.navdata)).unwrap();
        let (navdata, drone) = (Arc::new(navdata), Arc::new(drone));
        let spawn = |work: fn(&Shared, &UdpSocket, &UdpSocket), a: Arc<_>, b: Arc<_>| {
            let shared = Arc::clone(&shared);
            std::thread::spawn(move || work(&shared, &a, &b))
        };
        let out = socket();
        out.connect((ports.host, ports.at)).unwrap();
        let threads = vec![
            spawn(relay_commands, Arc::new(at), Arc::new(out)),
            spawn(relay_wake_up, Arc::clone(&navdata), Arc::clone(&drone)),
            spawn(relay_navdata, Arc::clone(&navdata), Arc::clone(&drone)),
            spawn(flood, navdata, drone),
            {
                let shared = Arc::clone(&shared);
                std::thread::spawn(move || keep_busy(&shared, &control, ports.control))
            },
        ];
        Self { mock, shared, address, threads }
    }

    /// Address of the drone for the pilot.
    pub(crate) fn address(&self) -> &DroneAddress {
        &self.address
    }

    pub(crate) fn truth(&self) -> Truth {
        self.mock.truth()
    }

    /// All datagrams of the pilot.
    pub(crate) fn said(&self) -> Vec<Said> {
        self.shared.said.lock().unwrap().clone()
    }

    /// Sends the pilot invalid datagrams from the drone's address, as fast as possible.
    pub(crate) fn flood(&self, duration: Duration) {
        *self.shared.flood.lock().unwrap() = Some(Instant::now() + duration);
    }

    pub(crate) fn floods(&self) -> bool {
        self.shared.flood.lock().unwrap().is_some()
    }

    /// Number of datagrams of floods until now.
    pub(crate) fn flooded(&self) -> u64 {
        self.shared.flooded.load(Ordering::Relaxed)
    }

    /// From the next connection on, the control port sends data without end.
    pub(crate) fn keep_control_port_busy(&self) {
        self.shared.busy.store(true, Ordering::Relaxed);
    }
}

impl Drop for Relay {
    fn drop(&mut self) {
        self.shared.over.store(true, Ordering::Relaxed);
        for thread in self.threads.drain(..) {
            thread.join().unwrap();
        }
    }
}

impl Shared {
    fn goes_on(&self) -> bool {
        !self.over.load(Ordering::Relaxed)
    }
}

fn relay_commands(shared: &Shared, at: &UdpSocket, drone: &UdpSocket) {
    let mut buffer = [0; 2048];
    while shared.goes_on() {
        let Ok(length) = at.recv(&mut buffer) else { continue };
        let said = Instant::now();
        // The drone may have ended.
        _ = drone.send(&buffer[..length]);
        let commands = decode(&buffer[..length]).map(Result::unwrap).collect();
        shared.said.lock().unwrap().push(Said { at: said, commands });
    }
}

fn relay_wake_up(shared: &Shared, pilot: &UdpSocket, drone: &UdpSocket) {
    let mut buffer = [0; 2048];
    while shared.goes_on() {
        let Ok((length, from)) = pilot.recv_from(&mut buffer) else { continue };
        *shared.pilot.lock().unwrap() = Some(from);
        _ = drone.send(&buffer[..length]);
    }
}

fn relay_navdata(shared: &Shared, pilot: &UdpSocket, drone: &UdpSocket) {
    let mut buffer = [0; 8192];
    while shared.goes_on() {
        let Ok(length) = drone.recv(&mut buffer) else { continue };
        let to = *shared.pilot.lock().unwrap();
        if let Some(to) = to {
            _ = pilot.send_to(&buffer[..length], to);
        }
    }
}

fn flood(shared: &Shared, pilot: &UdpSocket, _: &UdpSocket) {
    while shared.goes_on() {
        let (to, until) = (*shared.pilot.lock().unwrap(), *shared.flood.lock().unwrap());
        let (Some(to), Some(until)) = (to, until) else {
            std::thread::sleep(LOOK);
            continue;
        };
        while Instant::now() < until {
            _ = pilot.send_to(&[0x55; 400], to);
            shared.flooded.fetch_add(1, Ordering::Relaxed);
        }
        *shared.flood.lock().unwrap() = None;
    }
}

/// Relays the control port, or sends data without end.
fn keep_busy(shared: &Shared, listener: &TcpListener, drone: u16) {
    listener.set_nonblocking(true).unwrap();
    while shared.goes_on() {
        let Ok((mut pilot, _)) = listener.accept() else {
            std::thread::sleep(LOOK);
            continue;
        };
        pilot.set_nonblocking(false).unwrap();
        pilot.set_write_timeout(Some(LOOK)).unwrap();
        if shared.busy.load(Ordering::Relaxed) {
            // Until the pilot disconnects.
            while shared.goes_on() {
                match pilot.write_all(&[b'x'; 4096]) {
                    Ok(()) => {}
                    Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => {}
                    Err(_) => break,
                }
            }
            continue;
        }
        let Ok(mut drone) = std::net::TcpStream::connect((Ipv4Addr::LOCALHOST, drone)) else {
            continue;
        };
        drone.set_read_timeout(Some(LOOK)).unwrap();
        let mut buffer = [0; 4096];
        while shared.goes_on() {
            match std::io::Read::read(&mut drone, &mut buffer) {
                Ok(0) => break,
                Ok(length) => {
                    if pilot.write_all(&buffer[..length]).is_err() {
                        break;
                    }
                }
                Err(_) => {}
            }
        }
    }
}
