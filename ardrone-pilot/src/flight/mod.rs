//! Flights in real time, over UDP.
//!
//! The tick has its own thread, which sleeps in `ppoll` on the navdata socket until an absolute deadline:
//! navdata are handled when they arrive, and ticks do not drift. A missed deadline is counted and skipped,
//! never caught up, because the drone needs only the newest command. Everything slow (signals, the control
//! port, displays) runs on other threads behind bounded channels that drop rather than block. Landing,
//! cutting the motors and stopping are counters, which cannot be full. The work of a tick is bounded,
//! whatever arrives.
//!
//! Whatever ends a flight before the drone is down – an error, a panic or a second Ctrl-C – the last
//! datagrams order the landing. A socket error never ends the flight.

mod control_port;
mod link;
#[cfg(test)]
mod operators;
mod orders;
mod real_time;
mod room;
mod said;
mod unsaid;

use std::io;
use std::net::{IpAddr, SocketAddr, ToSocketAddrs as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::JoinHandle;
use std::time::Duration;

use ardrone_link::DroneAddress;
use ardrone_link::settings::SettingError;
use crossbeam_channel::{Receiver, Sender, bounded};

use self::control_port::ControlPort;
use self::link::{Link, sleep};
pub use self::link::{Port, Trouble};
pub use self::orders::Controls;
use self::orders::Orders;
pub(crate) use self::orders::answer_of_all;
use self::real_time::{RealTime, clock};
pub use self::room::{Placed, Places, RemoteAgents, Seat};
use self::said::SaidLast;
use self::unsaid::Unsaid;
use crate::drive::{Driver, Heard, Passed};
use crate::realtime::Realtime;
use crate::recording::Recorder;
use crate::runtime::Runtime;
use crate::timing::{TickHealth, TickSummary};
use autopilot::outcome::Outcome;
use autopilot::plan::Plan;
use autopilot::separation::Presence;
use autopilot::vehicle::{
    CannotFly, FlightReport, Input, Operator, OperatorOrder, Output, Telemetry, Transmit, Vehicle,
    VehicleConfig, VehicleName,
};
use mission_agent::{Line, MissionAgent, Said};

/// A message of a flight in progress.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    /// Whose it is.
    pub vehicle: VehicleName,
    /// What it says.
    pub content: Content,
}

/// What a [`Message`] says.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in flight")]
pub enum Content {
    /// Real-time scheduling granted to the flight's thread.
    Realtime(Realtime),
    /// What the vehicle tells, and the timing of the ticks. The end of a flight with which the program exits is not among
    /// it: it is returned by [`Flight::finish`].
    Telemetry(Duration, Telemetry, TickHealth),
    /// A problem of the network; the flight goes on.
    Trouble(Duration, Trouble),
    /// The agent of a vehicle that is flown elsewhere says something to this one's.
    Heard {
        /// When it is heard.
        at: Duration,
        /// It.
        line: Line,
        /// The same was heard, with other numbers perhaps, shortly before.
        again: bool,
    },
    /// The vehicle's agent says something to that of another one.
    Said {
        /// When.
        at: Duration,
        /// To whom, and what.
        said: Said,
        /// It has said the same, with other numbers perhaps, shortly before.
        again: bool,
    },
}

/// Statistics of the local end of the link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct LinkSummary {
    /// Datagrams that the system refused to send or to receive.
    pub errors: u64,
    /// How often a socket was reopened because of that.
    pub bound_anew: u64,
    /// Ticks in which more datagrams arrived than a tick reads.
    pub flooded_ticks: u64,
    /// Datagrams missing from the flight log because too many arrived.
    pub unrecorded: u64,
}

/// Result of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct FinishedFlight {
    /// Whose it was.
    pub vehicle: VehicleName,
    /// Outcome; for a vehicle that stayed, the outcome of leaving it.
    pub outcome: Outcome,
    /// Whether the drone was confirmed to be down at the end.
    pub is_down: bool,
    /// Report of the last flight.
    pub report: FlightReport,
    /// Timing of the ticks.
    pub ticks: TickSummary,
    /// Messages that were dropped because they were not received in time.
    pub dropped_messages: u64,
    /// Log entries that were dropped because the disk was too slow.
    pub lost_records: u64,
    /// Statistics of the local end of the link.
    pub link: LinkSummary,
}

/// Why a flight could not be started, or failed for a reason unrelated to flying.
#[derive(Debug, thiserror::Error)]
pub enum FlightError {
    /// The drone's host name cannot be resolved, or has no IPv4 address.
    #[error("cannot find the drone `{host}`")]
    Address {
        /// The host name.
        host: String,
        /// The system's error.
        source: io::Error,
    },
    /// A socket could not be opened.
    #[error("network")]
    Socket(#[source] io::Error),
    /// A thread could not be started.
    #[error("cannot start a thread")]
    Thread(#[source] io::Error),
    /// The limits cannot be encoded as drone settings.
    #[error(transparent)]
    Config(#[from] SettingError),
    /// The plan does not fit the configuration.
    #[error(transparent)]
    Plan(#[from] CannotFly),
    /// The flight's thread panicked.
    #[error("internal error: the flight thread panicked; its last datagrams ordered the landing")]
    Panicked,
}

/// What a flight is connected to besides its drone.
#[derive(Debug, Default)]
pub struct Connections {
    /// Records it.
    pub recorder: Option<Recorder>,
    /// Gives its orders, if it has no plan.
    pub agent: Option<MissionAgent>,
    /// Where the agents of vehicles elsewhere are reached.
    pub remote_agents: Option<Box<dyn RemoteAgents>>,
    /// Its place among other vehicles.
    pub seat: Option<Seat>,
}

/// A flight in progress. Dropping it lands the drone and waits for the ground, for at most 45 s; after that the flight exits
/// with the landing ordered.
#[derive(Debug)]
pub struct Flight {
    messages: Receiver<Message>,
    controls: Controls,
    thread: Option<JoinHandle<Result<FinishedFlight, FlightError>>>,
}

/// Capacity of the message channel.
const MESSAGES: usize = 256;
/// Ticks in which a flight that ends in the air orders the landing.
const PARTING_ORDERS: u32 = 10;
/// Limit on these ticks if the system refuses datagrams.
const PARTING_TICKS: u32 = 3 * PARTING_ORDERS;
/// Maximum datagrams recorded in a tick.
const RECORDED_PER_TICK: u32 = 64;
/// Maximum of these that may be invalid.
const REFUSED_PER_TICK: u32 = 8;
/// Longest wait for the landing when a flight is dropped; after it the flight exits with the landing ordered.
const LANDING_PATIENCE: Duration = Duration::from_secs(45);
/// Longest time for a flight to end after it was told to exit at once.
const PARTING_PATIENCE: Duration = Duration::from_secs(3);
/// Interval at which a dropped flight checks whether it has ended.
const LOOK: Duration = Duration::from_millis(20);

impl Flight {
    /// Starts a vehicle. With a plan it flies the plan and ends;
    /// without one, it stays until an operator quits. A signal to the [`Runtime`] lands and exits; a second one exits at once,
    /// with the landing ordered.
    ///
    /// # Errors
    /// [`FlightError`] if the plan or the limits are refused, the drone's host has no IPv4 address, or a socket or thread cannot
    /// be had.
    pub fn start(
        runtime: &Runtime,
        plan: Option<Plan>,
        config: &VehicleConfig,
        drone: &DroneAddress,
        connections: Connections,
    ) -> Result<Self, FlightError> {
        let Connections { recorder, seat, agent, remote_agents } = connections;
        let stay = match (&plan, &agent) {
            (Some(_), _) => Stay::UntilFlown,
            (None, Some(_)) => Stay::UntilOver,
            (None, None) => Stay::UntilLeft,
        };
        let vehicle = match plan {
            Some(plan) => Vehicle::flying(plan, config)?,
            None => Vehicle::new(config)?,
        };
        let address = resolve(&drone.host)?;
        let link = Link::new(address, drone).map_err(FlightError::Socket)?;
        let (orders, controls) = Orders::new(vehicle.name(), runtime.ending().begin_flight());
        let control_port = ControlPort::read(runtime, SocketAddr::new(address, drone.control_port));
        let (sender, messages) = bounded(MESSAGES);
        let surroundings = RealTime::new(link, orders, control_port, seat, remote_agents);
        let mut tick = TickLoop::new(vehicle, stay, surroundings, recorder, sender);
        tick.driver.agent = agent;
        let thread = std::thread::Builder::new()
            .name("flight".to_owned())
            .spawn(move || tick.run(|_| {}))
            .map_err(FlightError::Thread)?;
        Ok(Self { messages, controls, thread: Some(thread) })
    }

    /// Messages of the flight; the iterator ends with the flight.
    pub fn messages(&self) -> impl Iterator<Item = Message> + '_ {
        self.messages.iter()
    }

    /// A handle for giving orders from any thread.
    pub fn controls(&self) -> Controls {
        self.controls.clone()
    }

    /// Waits for the end.
    ///
    /// # Errors
    /// [`FlightError`] if the flight's thread failed.
    pub fn finish(mut self) -> Result<FinishedFlight, FlightError> {
        let Some(thread) = self.thread.take() else { return Err(FlightError::Panicked) };
        thread.join().map_err(|_| FlightError::Panicked)?
    }

    /// Waits for the end for at most `patience`; returns whether the flight has ended.
    fn ends_within(&self, patience: Duration) -> bool {
        let start = clock();
        let ended = || self.thread.as_ref().is_none_or(JoinHandle::is_finished);
        while !ended() && start.elapsed() < patience {
            sleep(LOOK);
        }
        ended()
    }
}

impl Drop for Flight {
    /// The owner has failed or does not care any more: the drone must not be left in the air.
    fn drop(&mut self) {
        if self.thread.is_none() {
            return;
        }
        // A flight that has ended refuses this.
        _ = self.controls.order(Operator::TERMINAL, OperatorOrder::Land);
        self.controls.stop();
        if !self.ends_within(LANDING_PATIENCE) {
            // A second stop exits at once.
            self.controls.stop();
            self.ends_within(PARTING_PATIENCE);
        }
    }
}

/// The address of a host.
///
/// # Errors
/// [`FlightError::Address`] if it has none.
pub(crate) fn resolve(host: &str) -> Result<IpAddr, FlightError> {
    let error = |source| FlightError::Address { host: host.to_owned(), source };
    let mut addresses = (host, 0).to_socket_addrs().map_err(error)?;
    let address = addresses.find(SocketAddr::is_ipv4);
    address
        .map(|address| address.ip())
        .ok_or_else(|| error(io::Error::new(io::ErrorKind::NotFound, "it has no IPv4 address")))
}

/// When the tick loop ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(clippy::enum_variant_names, reason = "each says how long")]
enum Stay {
    /// After the first flight.
    UntilFlown,
    /// After a request to exit, once the drone is down.
    UntilLeft,
    /// Likewise, or when the agent wants nothing more.
    UntilOver,
}

struct TickLoop {
    driver: Driver<RealTime>,
    stay: Stay,
    tee: Tee,
}

/// Passes on all that passes the vehicle, without ever waiting: to the flight log, and to those who watch.
struct Tee {
    vehicle: VehicleName,
    recorder: Option<Recorder>,
    recorded: Recorded,
    /// Datagrams missing from the flight log because too many arrived.
    unrecorded: u64,
    messages: Sender<Message>,
    dropped_messages: u64,
    tells_end: bool,
    /// It has been told that a line of another agent was not understood.
    misunderstood: bool,
    /// What its agent has said.
    said: SaidLast,
    heard: SaidLast,
    /// What of that is lost.
    unsaid: Unsaid,
    /// Timing of the ticks since the last status.
    health: TickHealth,
}

/// Datagrams recorded in this tick.
#[derive(Debug, Clone, Copy, Default)]
struct Recorded {
    all: u32,
    refused: u32,
}

impl Recorded {
    /// Whether a datagram may be recorded; `good` if it was valid.
    fn has_room(&mut self, good: bool) -> bool {
        let room = self.all < RECORDED_PER_TICK && (good || self.refused < REFUSED_PER_TICK);
        self.all += u32::from(room);
        self.refused += u32::from(room && !good);
        room
    }
}

impl Tee {
    fn pass(&mut self, at: Duration, passed: Passed<'_>) {
        match passed {
            Passed::Input(Input::Navdata(_), good) if !self.recorded.has_room(good) => {
                self.unrecorded += u64::from(self.recorder.is_some());
                return;
            }
            _ => {}
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.pass(at, &passed);
        }
        match passed {
            Passed::Told(Telemetry::Ended(..)) if !self.tells_end => {}
            Passed::Told(telemetry) => {
                let is_status = matches!(telemetry, Telemetry::Status(_));
                self.send(Content::Telemetry(at, telemetry, self.health));
                if is_status {
                    self.health.lateness = Duration::ZERO;
                }
            }
            Passed::Said(said) => {
                let again = self.said.is_said_again(at, said);
                self.send(Content::Said { at, said, again });
            }
            Passed::Unsaid(why, count) => self.unsaid.add(why, count),
            Passed::Misunderstood(problem) => {
                // Once: who does not understand one line does not understand the next one either.
                if !std::mem::replace(&mut self.misunderstood, true) {
                    self.warn(at, Trouble::Misunderstood(problem));
                }
            }
            Passed::Heard(Heard { line, is_far: true }) => {
                // Who says it is in the line.
                let again = self.heard.is_said_again(at, Said { to: "", line });
                self.send(Content::Heard { at, line, again });
            }
            // Who has said it shows it.
            Passed::Heard(_) | Passed::Input(..) | Passed::Sent { .. } => {}
        }
    }

    /// Reports a problem that does not end the flight.
    fn warn(&mut self, at: Duration, trouble: Trouble) {
        self.note(at, trouble.to_string());
        self.send(Content::Trouble(at, trouble));
    }

    /// Tells what of its agent's lines was lost, if that is due by then.
    fn tell_unsaid(&mut self, at: Duration, by: Duration) {
        while let Some((why, count)) = self.unsaid.due(by) {
            self.warn(at, Trouble::Unsaid(why, count));
        }
    }

    fn note(&mut self, at: Duration, text: String) {
        if let Some(recorder) = &mut self.recorder {
            recorder.note(at, text);
        }
    }

    fn send(&mut self, content: Content) {
        let message = Message { vehicle: self.vehicle, content };
        if self.messages.try_send(message).is_err() {
            self.dropped_messages += 1;
        }
    }
}

impl TickLoop {
    fn new(
        vehicle: Vehicle,
        stay: Stay,
        surroundings: RealTime,
        recorder: Option<Recorder>,
        messages: Sender<Message>,
    ) -> Self {
        let tee = Tee {
            vehicle: vehicle.name(),
            recorder,
            recorded: Recorded::default(),
            unrecorded: 0,
            messages,
            dropped_messages: 0,
            tells_end: stay == Stay::UntilLeft,
            misunderstood: false,
            said: SaidLast::default(),
            heard: SaidLast::default(),
            unsaid: Unsaid::default(),
            health: TickHealth::default(),
        };
        Self { driver: Driver::over(vehicle, surroundings), stay, tee }
    }

    /// Runs the loop to its end. `after` is called with the number of each tick.
    ///
    /// However the flight ends, its last datagrams order the landing, unless the drone is known to be down.
    fn run(mut self, after: impl FnMut(u32)) -> Result<FinishedFlight, FlightError> {
        let realtime = Realtime::acquire();
        self.tee.send(Content::Realtime(realtime));
        self.driver.surroundings.restart();
        // After a panic only the session is used, which a panic elsewhere cannot leave inconsistent.
        let flown = catch_unwind(AssertUnwindSafe(|| self.fly(after)));
        let end = flown.map_err(|_| FlightError::Panicked);
        let down = match &end {
            Ok(_) if self.stay != Stay::UntilFlown => self.driver.vehicle.is_at_rest(),
            Ok(outcome) => {
                matches!(
                    outcome,
                    Outcome::Completed
                        | Outcome::Contradicted { .. }
                        | Outcome::PreflightRefused { .. }
                )
            }
            Err(_) => false,
        };
        let told = self.driver.vehicle.as_neighbour(self.driver.now());
        if down || told.is_some_and(|told| told.presence == Presence::Stands) {
            self.driver.surroundings.park();
        }
        if !down {
            self.part();
        }
        end.map(|outcome| self.finished(outcome, down, realtime))
    }

    fn fly(&mut self, mut after: impl FnMut(u32)) -> Outcome {
        let mut count = 0_u32;
        loop {
            let Self { driver, tee, .. } = self;
            if !driver.step(|at, passed| tee.pass(at, passed)) {
                driver.pass();
                continue;
            }
            after(count);
            count = count.wrapping_add(1);
            tee.recorded = Recorded::default();
            driver.surroundings.tell(driver.vehicle.as_neighbour(driver.now()));
            let health = driver.surroundings.end_tick();
            tee.health.skipped = health.skipped;
            tee.health.lateness = tee.health.lateness.max(health.lateness);
            while let Some(trouble) = driver.surroundings.poll_trouble() {
                tee.warn(driver.now(), trouble);
            }
            tee.tell_unsaid(driver.now(), driver.now());
            let stops = driver.surroundings.stops();
            if let Some(outcome) = self.end(stops) {
                return outcome;
            }
            // A second stop does not wait for the ground.
            if stops >= 2 {
                return Outcome::LeftLanding;
            }
            self.driver.pass();
        }
    }

    /// The outcome, if the end of the first flight or a request to exit ends the loop.
    fn end(&self, stops: u32) -> Option<Outcome> {
        let outcome = self.driver.vehicle.outcome();
        match self.stay {
            Stay::UntilFlown => outcome.cloned(),
            Stay::UntilLeft if stops == 0 => None,
            Stay::UntilOver if stops == 0 => {
                let agent = self.driver.agent.as_ref();
                let is_over = agent.is_some_and(|agent| agent.is_over(&self.driver.vehicle));
                // One that has not flown had nothing to fly.
                is_over.then(|| outcome.cloned().unwrap_or(Outcome::Completed))
            }
            Stay::UntilLeft | Stay::UntilOver => {
                match (outcome, self.driver.vehicle.is_at_rest()) {
                    // The landing of a lost drone is never confirmed, and whoever leaves has not ordered it.
                    (Some(Outcome::LinkLost), false) => Some(Outcome::LinkLost),
                    (Some(_), _) => Some(Outcome::Interrupted),
                    (None, true) => Some(Outcome::CalledOff),
                    (None, false) => None,
                }
            }
        }
    }

    /// Orders the landing in ticks of its own, without waiting for anything else. It uses only the session,
    /// so it works without the agent and the estimator.
    fn part(&mut self) {
        let mut parted = 0;
        for _ in 0..PARTING_TICKS {
            sleep(self.driver.next_tick().saturating_sub(self.driver.now()));
            let now = self.driver.now();
            let Driver { vehicle, surroundings, .. } = &mut self.driver;
            // A tick is never refused.
            _ = vehicle.handle(now, Input::Part);
            let Some(Output::Transmit(Transmit::Command { datagram, .. })) = vehicle.poll() else {
                // Nothing was ever sent to this drone.
                break;
            };
            parted += u32::from(surroundings.send_datagram(now, datagram));
            if parted == PARTING_ORDERS {
                break;
            }
        }
        // A drone that is down was landed; that it was told so once more is nothing to tell.
        if parted > 0 && !self.driver.vehicle.is_at_rest() {
            let note = format!(
                "the program ended before the drone was down; the last {parted} datagrams ordered it to land"
            );
            self.tee.note(self.driver.now(), note);
        }
    }

    fn finished(&mut self, outcome: Outcome, is_down: bool, realtime: Realtime) -> FinishedFlight {
        let now = self.driver.now();
        let Self { driver: Driver { vehicle, surroundings, .. }, tee, stay } = self;
        let report = vehicle.report().clone();
        tee.tell_unsaid(now, Duration::MAX);
        // The vehicle has not told the end of a flight that is left; one that stays is left without a flight.
        if *stay == Stay::UntilFlown
            && vehicle.outcome().is_none()
            && let Some(recorder) = &mut tee.recorder
        {
            let ended = Telemetry::Ended(outcome.clone(), std::sync::Arc::new(report.clone()));
            recorder.pass(now, &Passed::Told(ended));
        }
        FinishedFlight {
            vehicle: tee.vehicle,
            outcome,
            is_down,
            report,
            ticks: surroundings.summary(realtime),
            dropped_messages: tee.dropped_messages,
            lost_records: tee.recorder.as_ref().map_or(0, Recorder::lost),
            link: LinkSummary { unrecorded: tee.unrecorded, ..surroundings.link_summary() },
        }
    }
}

#[cfg(test)]
mod tests {
    use mock_drone::WorldConfig;
    use mock_drone::firmware::Phase;
    use mock_drone::server::{MockDrone, Ports};

    use super::*;
    use crate::runtime::SecondSignal;

    #[test]
    fn a_drone_without_address_is_named() {
        let error = resolve("no such host").unwrap_err();
        assert!(error.to_string().contains("no such host"));
    }

    /// A tick loop connected to a mock drone.
    fn over(mock: &MockDrone) -> (TickLoop, Controls, Receiver<Message>) {
        let ports = mock.ports();
        let address = DroneAddress {
            host: ports.host.to_string(),
            at_port: ports.at,
            navdata_port: ports.navdata,
            control_port: ports.control,
        };
        let plan = Plan::parse("plan", "takeoff\nsetStayTime 60\ngoto 0 1 0 0\nland\n").unwrap();
        let vehicle = Vehicle::flying(plan, &VehicleConfig::default()).unwrap();
        let link = Link::new(ports.host, &address).unwrap();
        let runtime = Runtime::start(SecondSignal::IsPassedOn).unwrap();
        let (orders, controls) = Orders::new(vehicle.name(), runtime.ending().begin_flight());
        let control_port = ControlPort::read(&runtime, SocketAddr::new(ports.host, ports.control));
        let (sender, messages) = bounded(MESSAGES);
        let stay = Stay::UntilFlown;
        let surroundings = RealTime::new(link, orders, control_port, None, None);
        (TickLoop::new(vehicle, stay, surroundings, None, sender), controls, messages)
    }

    #[test]
    fn a_panic_in_the_air_orders_the_landing() {
        let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
        let (tick, _controls, _messages) = over(&mock);
        let mut flown = 0;
        let result = tick.run(|_| {
            flown += u32::from(mock.truth().phase == Phase::Flying);
            assert!(flown < 30, "something is wrong");
        });
        assert!(matches!(result, Err(FlightError::Panicked)), "{result:?}");
        assert!(matches!(mock.truth().phase, Phase::Landing | Phase::Landed), "{:?}", mock.truth());
    }

    #[test]
    fn what_agents_elsewhere_say_is_told_and_no_line_of_one_here() {
        let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
        let (mut tick, _controls, messages) = over(&mock);
        let line = Line::from("0123456789abcdef right tell at(1.0, 2.0)").unwrap();
        for (ms, is_far) in [(0, false), (30, true), (60, true), (90, false)] {
            tick.tee.pass(Duration::from_millis(ms), Passed::Heard(Heard { line, is_far }));
        }
        let heard: Vec<Content> = messages.try_iter().map(|message| message.content).collect();
        let at = Duration::from_millis;
        assert_eq!(
            heard,
            [
                Content::Heard { at: at(30), line, again: false },
                Content::Heard { at: at(60), line, again: true },
            ]
        );
        assert_eq!(mission_agent::sender(&line), "right");
        assert_eq!(mission_agent::text(&line), "tell at(1.0, 2.0)");
    }

    #[test]
    fn a_tick_records_what_matters_of_a_flood() {
        let mut recorded = Recorded::default();
        let garbage = (0..1000).filter(|_| recorded.has_room(false)).count();
        let packets = (0..1000).filter(|_| recorded.has_room(true)).count();
        assert_eq!((garbage, packets), (8, 56));
    }
}
