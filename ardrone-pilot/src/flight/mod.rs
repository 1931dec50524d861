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

mod link;
#[cfg(test)]
mod operators;
mod orders;
mod services;

use std::io;
use std::net::{IpAddr, SocketAddr, ToSocketAddrs as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ardrone_link::DroneAddress;
use ardrone_link::settings::SettingError;
use crossbeam_channel::{Receiver, Sender, bounded};

use self::link::{Link, sleep};
pub use self::link::{Port, Trouble};
pub use self::orders::Controls;
use self::orders::{Orders, Request};
pub(crate) use self::services::EndSignals;
use self::services::Services;
use crate::realtime::Realtime;
use crate::recording::{Recorder, Timing};
use crate::timing::{TickHealth, TickRecorder, TickSummary};
use autopilot::outcome::Outcome;
use autopilot::plan::{MissionId, Plan, Step};
use autopilot::vehicle::{
    CannotFly, FlightEvent, FlightReport, Input, NotReady, Operator, OperatorOrder, Output,
    Refused, Stage, Status, TICK, Transmit, Vehicle, VehicleConfig, Waypoint,
};

/// Messages of a flight in progress.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in flight")]
pub enum Message {
    /// Real-time scheduling granted to the flight's thread.
    Realtime(Realtime),
    /// Something happened.
    Event(Duration, FlightEvent),
    /// A target was reached and held for its stay time.
    Waypoint(Waypoint),
    /// A local network problem; the flight goes on.
    Trouble(Duration, Trouble),
    /// Status, several times a second.
    Status(Duration, Status, TickHealth),
    /// The mission has changed; all its steps.
    Mission {
        /// Name of the loaded plan; empty without one.
        name: String,
        /// The number that its maker gave it; none for a plan, and once it is extended.
        id: Option<MissionId>,
        /// All its steps.
        steps: Vec<Step>,
    },
    /// The reasons not to take off have changed; all of them.
    Readiness(Duration, Vec<NotReady>),
    /// A flight has ended and the vehicle stays. The end of a flight with which the program exits is returned
    /// by [`Flight::finish`] instead.
    Ended(Duration, Outcome, Box<FlightReport>),
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
    /// The drone's host name cannot be resolved.
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

/// A flight in progress. Dropping it lands the drone and waits for the ground.
#[derive(Debug)]
pub struct Flight {
    messages: Receiver<Message>,
    controls: Controls,
    thread: Option<JoinHandle<Result<FinishedFlight, FlightError>>>,
}

/// Ticks between status messages.
const STATUS_TICKS: u32 = 3;
/// Capacity of the message channel.
const MESSAGES: usize = 256;
/// Receive buffer, larger than any navdata packet.
const BUFFER_BYTES: usize = 8192;
/// Ticks in which a flight that ends in the air orders the landing.
const PARTING_ORDERS: u32 = 10;
/// Limit on these ticks if the system refuses datagrams.
const PARTING_TICKS: u32 = 3 * PARTING_ORDERS;
/// Maximum datagrams read in a tick; more than the socket's buffer holds.
const DATAGRAMS_PER_TICK: u32 = 1000;
/// Datagrams read even by a tick that is late.
const DATAGRAMS_IF_LATE: u32 = 32;
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
    /// Starts a vehicle, and records it if there is a recorder. With a plan it flies the plan and ends;
    /// without one, it stays until an operator quits. Ctrl-C, any other end signal, and a closed terminal
    /// land and exit; a second one exits at once, with the landing ordered.
    ///
    /// # Errors
    /// [`FlightError`] if the drone's address cannot be resolved, or a socket or thread cannot be had.
    pub fn start(
        plan: Option<Plan>,
        config: &VehicleConfig,
        drone: &DroneAddress,
        recorder: Option<Recorder>,
    ) -> Result<Self, FlightError> {
        let stay = if plan.is_some() { Stay::UntilFlown } else { Stay::UntilLeft };
        let vehicle = match plan {
            Some(plan) => Vehicle::flying(plan, config)?,
            None => Vehicle::new(config)?,
        };
        let address = resolve(&drone.host)?;
        let link = Link::new(address, drone).map_err(FlightError::Socket)?;
        let (orders, controls) = Orders::new();
        let control_port = SocketAddr::new(address, drone.control_port);
        let services = Services::start(control_port, controls.clone())?;
        let (sender, messages) = bounded(MESSAGES);
        let tick = TickLoop::new(vehicle, stay, link, orders, services, recorder, sender);
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

fn resolve(host: &str) -> Result<IpAddr, FlightError> {
    let error = |source| FlightError::Address { host: host.to_owned(), source };
    let mut addresses = (host, 0).to_socket_addrs().map_err(error)?;
    let address = addresses.find(SocketAddr::is_ipv4);
    address
        .map(|address| address.ip())
        .ok_or_else(|| error(io::Error::new(io::ErrorKind::NotFound, "it has no IPv4 address")))
}

/// Origin of the flight's time.
fn clock() -> Instant {
    Instant::now()
}

/// When the tick loop ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stay {
    /// After the first flight.
    UntilFlown,
    /// After a request to exit, once the drone is down.
    UntilLeft,
}

struct TickLoop {
    vehicle: Vehicle,
    stay: Stay,
    link: Link,
    orders: Orders,
    services: Services,
    recorder: Option<Recorder>,
    messages: Sender<Message>,
    dropped_messages: u64,
    ticks: TickRecorder,
    realtime: Realtime,
    start: Instant,
    /// Deadline of the next tick.
    deadline: Duration,
    buffer: Vec<u8>,
    intake: Intake,
    summary: LinkSummary,
    /// A flood was reported; once per flight is enough.
    flood_reported: bool,
    /// A first request to exit was handled.
    stopping: bool,
}

/// Remaining number of datagrams that a tick may read and record.
#[derive(Debug, Clone, Copy)]
struct Intake {
    taken: u32,
    recorded: u32,
    refused: u32,
}

impl Intake {
    const NOTHING: Self = Self { taken: 0, recorded: 0, refused: 0 };

    /// Whether a datagram may be recorded; `good` if it was valid.
    fn records(&mut self, good: bool) -> bool {
        let room = self.recorded < RECORDED_PER_TICK && (good || self.refused < REFUSED_PER_TICK);
        self.recorded += u32::from(room);
        self.refused += u32::from(room && !good);
        room
    }
}

impl TickLoop {
    fn new(
        vehicle: Vehicle,
        stay: Stay,
        link: Link,
        orders: Orders,
        services: Services,
        recorder: Option<Recorder>,
        messages: Sender<Message>,
    ) -> Self {
        Self {
            vehicle,
            stay,
            link,
            orders,
            services,
            recorder,
            messages,
            dropped_messages: 0,
            ticks: TickRecorder::default(),
            realtime: Realtime::default(),
            start: clock(),
            deadline: Duration::ZERO,
            buffer: vec![0_u8; BUFFER_BYTES],
            intake: Intake::NOTHING,
            summary: LinkSummary::default(),
            flood_reported: false,
            stopping: false,
        }
    }

    /// Runs the loop to its end. `before` is called with the number of each tick.
    ///
    /// However the flight ends, its last datagrams order the landing, unless the drone is known to be down.
    fn run(mut self, before: impl FnMut(u32)) -> Result<FinishedFlight, FlightError> {
        self.realtime = Realtime::acquire();
        self.send(Message::Realtime(self.realtime));
        self.start = clock();
        // After a panic only the session is used, which a panic elsewhere cannot leave inconsistent.
        let flown = catch_unwind(AssertUnwindSafe(|| self.fly(before)));
        let end = flown.map_err(|_| FlightError::Panicked);
        let down = match &end {
            Ok(_) if self.stay == Stay::UntilLeft => self.vehicle.is_at_rest(),
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
        if !down {
            self.part();
        }
        end.map(|outcome| self.finished(outcome, down))
    }

    fn fly(&mut self, mut before: impl FnMut(u32)) -> Outcome {
        let mut held_up = false;
        let mut count = 0_u32;
        loop {
            let now = self.start.elapsed();
            if let Some(rest) = self.deadline.checked_sub(now).filter(|rest| !rest.is_zero()) {
                self.link.wait(rest);
                let woken = self.start.elapsed();
                self.take_in_navdata();
                held_up = woken < self.deadline && self.start.elapsed() >= self.deadline;
                continue;
            }
            let skipped = skip_missed(&mut self.deadline, now);
            let late = now.saturating_sub(self.deadline);
            self.ticks.begin(now, self.deadline, skipped, std::mem::take(&mut held_up));
            self.deadline += TICK;
            before(count);
            self.link.begin_tick();
            self.intake = Intake::NOTHING;
            self.take_in_late_navdata();
            self.take_in_services(now);
            self.tick();
            self.ticks.end();
            self.record_tick(late, self.start.elapsed().saturating_sub(now));
            self.report(now, count.is_multiple_of(STATUS_TICKS));
            count = count.wrapping_add(1);
            if let Some(outcome) = self.end() {
                return outcome;
            }
            // A second stop does not wait for the ground.
            if self.orders.stops() >= 2 {
                return Outcome::LeftLanding;
            }
        }
    }

    /// The outcome, if the end of the first flight or a request to exit ends the loop.
    fn end(&self) -> Option<Outcome> {
        let outcome = self.vehicle.outcome();
        match self.stay {
            Stay::UntilFlown => outcome.cloned(),
            Stay::UntilLeft if self.orders.stops() == 0 => None,
            // The landing of a lost drone is never confirmed.
            Stay::UntilLeft => {
                (self.vehicle.is_at_rest() || outcome.is_some()).then_some(Outcome::Interrupted)
            }
        }
    }

    /// Decides and sends, and measures each stage.
    fn tick(&mut self) {
        let start = self.start;
        let now = start.elapsed();
        let mut last = now;
        let mut done = |ticks: &mut TickRecorder, stage| {
            let now = start.elapsed();
            ticks.spend(stage, now.saturating_sub(last));
            last = now;
        };
        self.vehicle.tick_timed(now, |stage| done(&mut self.ticks, stage));
        while let Some(transmit) = self.vehicle.poll_transmit() {
            match transmit {
                Transmit::Command { datagram, .. } => {
                    self.link.send(now, datagram);
                }
                Transmit::WakeUp => self.link.wake_up(now),
            }
        }
        done(&mut self.ticks, Stage::Send);
    }

    /// Handles incoming navdata until the next tick is due.
    fn take_in_navdata(&mut self) {
        let begun = self.start.elapsed();
        let mut now = begun;
        while now < self.deadline {
            if self.intake.taken >= DATAGRAMS_PER_TICK {
                // Leaves the rest of the tick to other threads.
                self.link.rest();
                self.summary.flooded_ticks += 1;
                if !std::mem::replace(&mut self.flood_reported, true) {
                    self.warn(now, Trouble::Flood);
                }
                break;
            }
            if !self.take_in_datagram(now) {
                break;
            }
            now = self.start.elapsed();
        }
        self.ticks.spend(Stage::Estimate, now.saturating_sub(begun));
    }

    /// Handles navdata that arrived before a tick that is late, so that it does not decide without them.
    fn take_in_late_navdata(&mut self) {
        let now = self.start.elapsed();
        for _ in 0..DATAGRAMS_IF_LATE {
            if !self.take_in_datagram(now) {
                break;
            }
        }
        self.ticks.spend(Stage::Estimate, self.start.elapsed().saturating_sub(now));
    }

    /// Returns whether there was a datagram.
    fn take_in_datagram(&mut self, now: Duration) -> bool {
        let Some(length) = self.link.receive(now, &mut self.buffer) else { return false };
        self.intake.taken += 1;
        let packet = self.buffer.get(..length).unwrap_or_default();
        let before = self.vehicle.link_statistics().received;
        self.vehicle.handle(now, Input::Navdata(packet));
        let good = self.vehicle.link_statistics().received > before;
        if let Some(recorder) = &mut self.recorder {
            if self.intake.records(good) {
                recorder.navdata(now, packet);
            } else {
                self.summary.unrecorded += 1;
            }
        }
        true
    }

    fn take_in_services(&mut self, now: Duration) {
        for bytes in self.services.poll_control() {
            self.vehicle.handle(now, Input::Control(&bytes));
            if let Some(recorder) = &mut self.recorder {
                recorder.control(now, &bytes);
            }
        }
        for Request { by, order, answer } in self.orders.poll() {
            let answered = obey(&mut self.vehicle, self.recorder.as_mut(), now, by, order);
            if let Some(answer) = answer {
                answer(answered);
            }
        }
        if self.orders.stops() > 0 && !std::mem::replace(&mut self.stopping, true) {
            let (by, land) = (Operator::TERMINAL, OperatorOrder::Land);
            // Landing is never refused.
            _ = obey(&mut self.vehicle, self.recorder.as_mut(), now, by, land);
        }
    }

    fn record_tick(&mut self, late: Duration, work: Duration) {
        // While the drone is not spoken to nothing is decided: the last decision is an old one.
        if self.vehicle.datagram().is_empty() {
            return;
        }
        if let (Some(recorder), Some(decision)) = (&mut self.recorder, self.vehicle.decision()) {
            let ms = |time: Duration| time.as_secs_f64() * 1e3;
            let timing = Timing { late_ms: ms(late), work_ms: ms(work) };
            recorder.tick(*decision, timing, self.vehicle.datagram());
        }
    }

    fn report(&mut self, now: Duration, with_status: bool) {
        while let Some(output) = self.vehicle.poll() {
            let message = match output {
                Output::Event(event) => {
                    if let Some(recorder) = &mut self.recorder {
                        recorder.event(now, event.clone());
                    }
                    Message::Event(now, event)
                }
                Output::Waypoint(waypoint) => Message::Waypoint(waypoint),
                Output::Mission { name, id, steps } => {
                    if let Some(recorder) = &mut self.recorder {
                        recorder.mission(now, name.to_owned(), steps.to_vec());
                    }
                    Message::Mission { name: name.to_owned(), id, steps: steps.to_vec() }
                }
                Output::Readiness(reasons) => Message::Readiness(now, reasons.to_vec()),
                Output::Ended(outcome) if self.stay == Stay::UntilLeft => {
                    let outcome = outcome.clone();
                    if let Some(recorder) = &mut self.recorder {
                        recorder.outcome(now, outcome.clone());
                    }
                    Message::Ended(now, outcome, Box::new(self.vehicle.report().clone()))
                }
                // Sent already; the end is reported by `finish`.
                Output::Transmit(_) | Output::Ended(_) => continue,
            };
            self.send(message);
        }
        if let Some(trouble) = self.link.poll_trouble() {
            self.warn(now, trouble);
        }
        if with_status {
            let health = self.ticks.health();
            self.send(Message::Status(now, self.vehicle.status(now), health));
        }
    }

    fn send(&mut self, message: Message) {
        if self.messages.try_send(message).is_err() {
            self.dropped_messages += 1;
        }
    }

    /// Reports a problem that does not end the flight.
    fn warn(&mut self, now: Duration, trouble: Trouble) {
        if let Some(recorder) = &mut self.recorder {
            recorder.note(now, trouble.to_string());
        }
        self.send(Message::Trouble(now, trouble));
    }

    /// Orders the landing in ticks of its own, without waiting for anything else. It uses only the session,
    /// so it works without the agent and the estimator.
    fn part(&mut self) {
        let mut parted = 0;
        for _ in 0..PARTING_TICKS {
            let now = self.start.elapsed();
            skip_missed(&mut self.deadline, now);
            sleep(self.deadline.saturating_sub(now));
            self.deadline += TICK;
            let now = self.start.elapsed();
            self.vehicle.part(now);
            let Some(Transmit::Command { datagram, .. }) = self.vehicle.poll_transmit() else {
                // Nothing was ever sent to this drone.
                break;
            };
            parted += u32::from(self.link.send(now, datagram));
            if parted == PARTING_ORDERS {
                break;
            }
        }
        // A drone that is down was landed; that it was told so once more is nothing to tell.
        if let (Some(recorder), 1.., false) =
            (&mut self.recorder, parted, self.vehicle.is_at_rest())
        {
            let note = format!(
                "the program ended before the drone was down; the last {parted} datagrams ordered it to land"
            );
            recorder.note(self.start.elapsed(), note);
        }
    }

    fn finished(&mut self, outcome: Outcome, is_down: bool) -> FinishedFlight {
        if let Some(recorder) = &mut self.recorder
            && self.stay == Stay::UntilFlown
        {
            recorder.outcome(self.start.elapsed(), outcome.clone());
        }
        let (errors, bound_anew) = self.link.failures();
        FinishedFlight {
            outcome,
            is_down,
            report: self.vehicle.report().clone(),
            ticks: self.ticks.summary(self.realtime),
            dropped_messages: self.dropped_messages,
            lost_records: self.recorder.as_ref().map_or(0, Recorder::lost),
            link: LinkSummary { errors, bound_anew, ..self.summary },
        }
    }
}

/// Passes on an order and records it even if it is refused: a replay refuses it again.
fn obey(
    vehicle: &mut Vehicle,
    recorder: Option<&mut Recorder>,
    now: Duration,
    by: Operator,
    order: OperatorOrder,
) -> Result<(), Refused> {
    if let Some(recorder) = recorder {
        recorder.order(now, by, order.clone());
    }
    vehicle.order(now, by, order)
}

/// Moves the deadline to the last one that has passed; returns the number missed before it.
fn skip_missed(deadline: &mut Duration, now: Duration) -> u64 {
    let mut skipped = 0;
    while *deadline + TICK <= now {
        *deadline += TICK;
        skipped += 1;
    }
    skipped
}

#[cfg(test)]
mod tests {
    use mock_drone::WorldConfig;
    use mock_drone::firmware::Phase;
    use mock_drone::server::{MockDrone, Ports};

    use super::*;

    #[test]
    fn missed_deadlines_are_counted_and_skipped() {
        let ms = Duration::from_millis;
        let mut deadline = ms(30);
        assert_eq!(skip_missed(&mut deadline, ms(59)), 0);
        assert_eq!(deadline, ms(30));
        assert_eq!(skip_missed(&mut deadline, ms(125)), 3);
        assert_eq!(deadline, ms(120));
    }

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
        let (orders, controls) = Orders::new();
        let control_port = SocketAddr::new(ports.host, ports.control);
        let services = Services::start(control_port, controls.clone()).unwrap();
        let (sender, messages) = bounded(MESSAGES);
        let stay = Stay::UntilFlown;
        (TickLoop::new(vehicle, stay, link, orders, services, None, sender), controls, messages)
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
    fn a_tick_records_what_matters_of_a_flood() {
        let mut intake = Intake::NOTHING;
        let garbage = (0..1000).filter(|_| intake.records(false)).count();
        let packets = (0..1000).filter(|_| intake.records(true)).count();
        assert_eq!((garbage, packets), (8, 56));
    }
}
