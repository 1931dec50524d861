//! Two simulated drones of ours cross the place of a third one, which another program flies, in one air and in real time:
//! `beside told node fly_beside.js`.
//!
//! The other program flies the drone at 127.0.0.1 with its own ports, and says nothing to ours. With `told` somebody tells them
//! where that drone is (here: the simulation, in each tick), and they must keep away from it and arrive; with `untold` nobody does.
//! Prints how near they came to it, in truth; fails if that is too near, or if one of the three did not fly its flight.
#![allow(clippy::print_stdout, clippy::disallowed_methods, reason = "it flies in real time")]

use std::error::Error;
use std::net::{Ipv4Addr, SocketAddr, UdpSocket};
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use ardrone_link::WAKE_UP;
use ardrone_pilot::drive::{Driver, Passed, Surroundings, Take};
use autopilot::Vehicle;
use autopilot::outcome::Outcome;
use autopilot::separation::{Neighbour, Presence};
use autopilot::vehicle::{Input, Start, Telemetry, Transmit, Ultrasound, VehicleConfig};
use mock_drone::firmware::Phase;
use mock_drone::server::{Air, MockDrone, Ports};
use mock_drone::{Standing, WorldConfig};
use nalgebra::Vector2;
use system_tests::fleet::NEAREST_M;
use system_tests::plan;

const LIMIT: Duration = Duration::from_secs(50);
/// The foreign drone's number among the vehicles.
const FOREIGN: u8 = 3;
/// Ours fly through the place of the foreign one, one after the other, while it is up.
const STARTS_M: [[f64; 2]; 2] = [[-3.5, 0.0], [0.0, -6.0]];

/// A drone on sockets.
struct Udp {
    start: Instant,
    socket: UdpSocket,
    at: SocketAddr,
    navdata: SocketAddr,
}

impl Surroundings for Udp {
    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    fn wait(&mut self, _until: Duration) {}

    fn receive(&mut self, now: Duration, _until: Option<Duration>, mut take: impl Take) {
        let mut datagram = [0; 4096];
        while let Ok(length) = self.socket.recv(&mut datagram) {
            // What is refused changes nothing.
            _ = take(now, Input::Navdata(&datagram[..length]));
        }
    }

    fn send(&mut self, _now: Duration, transmit: Transmit<'_>) {
        // What is lost comes again in the next tick.
        _ = match transmit {
            Transmit::Command { datagram, .. } => self.socket.send_to(datagram, self.at),
            Transmit::WakeUp => self.socket.send_to(&WAKE_UP, self.navdata),
        };
    }
}

fn world([x_m, y_m]: [f64; 2]) -> WorldConfig {
    let start = Standing { place_m: Vector2::new(x_m, y_m), heading_deg: 0.0 };
    WorldConfig { start, ..WorldConfig::default() }
}

/// A vehicle that flies through the middle to the opposite place, and its drone.
fn ours(air: &Air, number: u8, is_told: bool) -> Result<(MockDrone, Driver<Udp>), Box<dyn Error>> {
    let place_m = STARTS_M[usize::from(number) - 1];
    let drone = MockDrone::start_in(air, &world(place_m), Ports::LOOPBACK)?;
    let peers = (1..=FOREIGN).filter(|peer| *peer != number && (is_told || *peer != FOREIGN));
    let mut config = VehicleConfig {
        system: number,
        peers: peers.collect(),
        ultrasound: Some(Ultrasound::Slow),
        // Nobody reads the control port here.
        read_back: false,
        ..VehicleConfig::default()
    };
    config.starts_at(Some(Start { place_m: place_m.into(), ..Start::default() }));
    let [x_m, y_m] = place_m.map(|m| -m);
    let text = format!("takeoff\ngoto {x_m} {y_m} 0.5 0\nland\n");
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
    socket.set_nonblocking(true)?;
    let Ports { host, at, navdata, .. } = drone.ports();
    let [at, navdata] = [at, navdata].map(|port| SocketAddr::new(host, port));
    let udp = Udp { start: Instant::now(), socket, at, navdata };
    Ok((drone, Driver::over(Vehicle::flying(plan(&text), &config)?, udp)))
}

fn is_up(drone: &MockDrone) -> bool {
    let truth = drone.truth();
    truth.phase != Phase::Landed && truth.position_m.z > 0.1
}

fn run() -> Result<bool, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let is_told = arguments.next().as_deref() == Some("told");
    let program = arguments.next().ok_or("usage: beside told|untold PROGRAM [ARGUMENT..]")?;
    let air = Air::default();
    let foreign =
        MockDrone::start_in(&air, &world([0.0; 2]), Ports::standard(Ipv4Addr::LOCALHOST.into()))?;
    let mut client = Command::new(program).args(arguments).spawn()?;
    let (mut drones, mut drivers) = (Vec::new(), Vec::new());
    for number in 1..FOREIGN {
        let (drone, driver) = ours(&air, number, is_told)?;
        drones.push(drone);
        drivers.push(driver);
    }
    let start = Instant::now();
    let (mut nearest_m, mut met, mut ended) = (f64::INFINITY, false, [const { None }; 2]);
    while start.elapsed() < LIMIT && ended.contains(&None) {
        let truth = foreign.truth();
        let presence = if is_up(&foreign) { Presence::Flies } else { Presence::Stands };
        let mut told = Vec::new();
        for (driver, ended) in drivers.iter_mut().zip(&mut ended) {
            // It takes off when the foreign drone is up.
            if !met && !is_up(&foreign) {
                continue;
            }
            met = true;
            driver.step(|_, passed| {
                if let Passed::Told(Telemetry::Ended(outcome, _)) = passed {
                    *ended = Some(outcome);
                }
            });
            told.extend(driver.vehicle.as_neighbour(driver.now()));
        }
        told.extend(is_told.then(|| Neighbour {
            system: FOREIGN,
            at: Duration::ZERO,
            place_m: truth.position_m.xy(),
            velocity_m_s: truth.velocity_m_s.xy(),
            uncertainty_m: 0.1,
            separation_m: 0.0,
            presence,
            claim: None,
        }));
        for driver in &mut drivers {
            for neighbour in &told {
                let heard = Neighbour { at: driver.now(), ..*neighbour };
                // A vehicle does not hear itself.
                _ = driver.handle(Input::Neighbour(heard), |_, _| {});
            }
        }
        for (drone, place_m) in drones.iter().zip(STARTS_M) {
            let place_m = drone.truth().position_m.xy() + Vector2::from(place_m);
            if is_up(drone) && is_up(&foreign) {
                nearest_m = f64::min(nearest_m, (place_m - truth.position_m.xy()).norm());
            }
        }
        std::thread::sleep(Duration::from_millis(3));
    }
    let flown = client.wait()?.success();
    let arrived = ended.iter().all(|outcome| *outcome == Some(Outcome::Completed));
    println!("{nearest_m:.2} m from the one that another program flew; ours: {ended:?}");
    Ok(flown && arrived && nearest_m >= NEAREST_M)
}

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            println!("{error}");
            ExitCode::FAILURE
        }
    }
}
