//! Flights in real time, over UDP.
//!
//! The tick has a thread of its own that sleeps in `ppoll` on the navdata socket until an absolute
//! deadline, so navdata is taken in when it arrives and ticks don't drift. A missed deadline is
//! counted and skipped, never caught up: the drone wants the newest command once. Everything slow
//! (signals, the control port, whoever watches) is on other threads behind bounded channels that
//! drop rather than block.

mod services;

use std::io;
use std::net::{IpAddr, SocketAddr, ToSocketAddrs as _, UdpSocket};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ardrone_link::at::{Datagram, EncodeError};
use ardrone_link::settings::SettingError;
use ardrone_link::{DroneAddress, WAKE_UP, is_passing};
use crossbeam_channel::{Receiver, Sender, bounded};
use rustix::event::{PollFd, PollFlags, Timespec, poll};

use self::services::{Input, Services};
use crate::outcome::Outcome;
use crate::pilot::{
    FlightEvent, FlightReport, Pilot, PilotConfig, PilotOrder, Status, TICK, Waypoint,
};
use crate::plan::Plan;
use crate::realtime::Realtime;
use crate::recording::{Recorder, Timing};
use crate::timing::{Stage, TickHealth, TickRecorder, TickSummary};

/// What the flight tells while it lasts.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "a box would be asked for in flight")]
pub enum Message {
    /// What the system gives the flight's thread.
    Realtime(Realtime),
    /// Something happened.
    Event(Duration, FlightEvent),
    /// A target was reached and stayed at.
    Waypoint(Waypoint),
    /// Where things stand, some times a second.
    Status(Duration, Status, TickHealth),
}

/// A flight that is over.
#[derive(Debug, Clone, PartialEq)]
pub struct FinishedFlight {
    /// How it ended.
    pub outcome: Outcome,
    /// What the pilot says of it.
    pub report: FlightReport,
    /// How regular the ticks were.
    pub ticks: TickSummary,
    /// Messages that were dropped because nobody took them in time.
    pub dropped_messages: u64,
    /// Entries of the flight log that the disk was too slow for.
    pub lost_records: u64,
}

/// Why a flight could not be started or went wrong in a way that is no flight's fault.
#[derive(Debug, thiserror::Error)]
pub enum FlightError {
    /// The drone's name has no address.
    #[error("cannot find the drone `{host}`: {source}")]
    Address {
        /// What was asked for.
        host: String,
        /// What the system says.
        source: io::Error,
    },
    /// A socket failed.
    #[error("network: {0}")]
    Socket(#[source] io::Error),
    /// A thread could not be started.
    #[error("cannot start a thread: {0}")]
    Thread(#[source] io::Error),
    /// The limits cannot be sent to a drone.
    #[error(transparent)]
    Config(#[from] SettingError),
    /// See [`Pilot::tick`].
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// The flight's thread panicked.
    #[error("internal error: the flight thread panicked; the drone's own watchdog lands it")]
    Panicked,
}

/// A flight that goes on.
#[derive(Debug)]
pub struct Flight {
    messages: Receiver<Message>,
    controls: Controls,
    thread: JoinHandle<Result<FinishedFlight, FlightError>>,
}

/// The pilot's hand on a flight that goes on.
#[derive(Debug, Clone)]
pub struct Controls {
    inputs: Sender<Input>,
}

impl Controls {
    /// Orders something; returns whether the flight could be told. A flight that is over cannot.
    pub fn order(&self, order: PilotOrder) -> bool {
        self.inputs.try_send(Input::Order(order)).is_ok()
    }

    /// Does what Ctrl-C does: lands, and the second time leaves at once with the landing ordered.
    pub fn stop(&self) -> bool {
        self.inputs.try_send(Input::Stop).is_ok()
    }
}

/// How often whoever watches is told where things stand.
const STATUS_TICKS: u32 = 3;
/// Messages that may wait for whoever watches.
const MESSAGES: usize = 256;
/// Longer than any navdata packet.
const BUFFER_BYTES: usize = 8192;
/// When the process ends in the air, the landing is ordered this many times.
const PARTING_ORDERS: u32 = 10;

impl Flight {
    /// Starts flying `plan`, and records it if there is a recorder. Ctrl-C, SIGTERM and a closed terminal land; a second one ends
    /// the flight at once, with the landing ordered.
    ///
    /// # Errors
    /// [`FlightError`] if the drone has no address or no socket or thread can be had.
    pub fn start(
        plan: Plan,
        config: &PilotConfig,
        drone: &DroneAddress,
        recorder: Option<Recorder>,
    ) -> Result<Self, FlightError> {
        let pilot = Pilot::new(plan, config)?;
        let address = resolve(&drone.host)?;
        let connect = |port| connected_socket(SocketAddr::new(address, port));
        let at = connect(drone.at_port).map_err(FlightError::Socket)?;
        let navdata = connect(drone.navdata_port).map_err(FlightError::Socket)?;
        let (services, inputs) = Services::start(SocketAddr::new(address, drone.control_port))?;
        let (sender, messages) = bounded(MESSAGES);
        let mut tick = TickLoop {
            pilot,
            at,
            navdata,
            services,
            recorder,
            messages: sender,
            dropped_messages: 0,
            ticks: TickRecorder::default(),
            realtime: Realtime::default(),
            waypoints: 0,
            stops: 0,
        };
        let thread = std::thread::Builder::new()
            .name("flight".to_owned())
            .spawn(move || tick.run())
            .map_err(FlightError::Thread)?;
        Ok(Self { messages, controls: Controls { inputs }, thread })
    }

    /// What the flight tells; ends when the flight does.
    pub fn messages(&self) -> impl Iterator<Item = Message> + '_ {
        self.messages.iter()
    }

    /// What orders this flight, from any thread.
    pub fn controls(&self) -> Controls {
        self.controls.clone()
    }

    /// Waits for the end.
    ///
    /// # Errors
    /// [`FlightError`] if the flight's thread failed.
    pub fn finish(self) -> Result<FinishedFlight, FlightError> {
        self.thread.join().map_err(|_| FlightError::Panicked)?
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

/// A socket that hears only the drone: the system drops datagrams from anybody else.
fn connected_socket(drone: SocketAddr) -> io::Result<UdpSocket> {
    #[allow(clippy::disallowed_methods, reason = "this is the shell")]
    let socket = UdpSocket::bind(("0.0.0.0", 0))?;
    socket.connect(drone)?;
    socket.set_nonblocking(true)?;
    Ok(socket)
}

/// The flight's clock.
fn clock() -> Instant {
    #[allow(clippy::disallowed_methods, reason = "this is the shell")]
    Instant::now()
}

struct TickLoop {
    pilot: Pilot,
    at: UdpSocket,
    navdata: UdpSocket,
    services: Services,
    recorder: Option<Recorder>,
    messages: Sender<Message>,
    dropped_messages: u64,
    ticks: TickRecorder,
    realtime: Realtime,
    waypoints: usize,
    /// How often the end was asked for.
    stops: u32,
}

impl TickLoop {
    fn run(&mut self) -> Result<FinishedFlight, FlightError> {
        self.realtime = Realtime::acquire();
        self.say(Message::Realtime(self.realtime));
        let start = clock();
        let mut datagram = Datagram::new();
        let mut buffer = vec![0_u8; BUFFER_BYTES];
        let mut deadline = Duration::ZERO;
        let mut held_up = false;
        let mut count = 0_u32;
        loop {
            let now = start.elapsed();
            if let Some(rest) = deadline.checked_sub(now).filter(|rest| !rest.is_zero()) {
                self.wait(rest)?;
                let woken = start.elapsed();
                self.take_in_navdata(start, &mut buffer)?;
                let done = start.elapsed();
                self.ticks.spend(Stage::Estimate, done.saturating_sub(woken));
                held_up = woken < deadline && done >= deadline;
                continue;
            }
            let skipped = skip_missed(&mut deadline, now);
            let late = now.saturating_sub(deadline);
            self.ticks.begin(now, deadline, skipped, std::mem::take(&mut held_up));
            deadline += TICK;
            self.take_in_services(now);
            self.tick(start, &mut datagram)?;
            self.ticks.end();
            self.record_tick(late, start.elapsed().saturating_sub(now), &datagram);
            self.tell(now, count.is_multiple_of(STATUS_TICKS));
            count = count.wrapping_add(1);
            if let Some(outcome) = self.pilot.outcome().cloned() {
                return Ok(self.finished(start.elapsed(), outcome));
            }
            if self.stops >= 2 {
                return self.leave(start, &mut datagram);
            }
        }
    }

    /// Decides and sends, and takes the time of each stage.
    fn tick(&mut self, start: Instant, datagram: &mut Datagram) -> Result<(), FlightError> {
        let now = start.elapsed();
        let mut last = now;
        let mut done = |ticks: &mut TickRecorder, stage| {
            let now = start.elapsed();
            ticks.spend(stage, now.saturating_sub(last));
            last = now;
        };
        self.pilot.tick_timed(now, datagram, |stage| done(&mut self.ticks, stage))?;
        if !datagram.as_bytes().is_empty() {
            tolerate(self.at.send(datagram.as_bytes()))?;
        }
        if self.pilot.wake_up_due(now) {
            tolerate(self.navdata.send(&WAKE_UP))?;
        }
        done(&mut self.ticks, Stage::Send);
        Ok(())
    }

    /// Sleeps until navdata arrives or the time is over.
    fn wait(&self, time: Duration) -> Result<(), FlightError> {
        let timeout = Timespec {
            tv_sec: i64::try_from(time.as_secs()).unwrap_or(i64::MAX),
            tv_nsec: i64::from(time.subsec_nanos()),
        };
        let mut sockets = [PollFd::new(&self.navdata, PollFlags::IN)];
        match poll(&mut sockets, Some(&timeout)) {
            Ok(_) | Err(rustix::io::Errno::INTR) => Ok(()),
            Err(error) => Err(FlightError::Socket(error.into())),
        }
    }

    fn take_in_navdata(&mut self, start: Instant, buffer: &mut [u8]) -> Result<(), FlightError> {
        while let Some(length) = tolerate(self.navdata.recv(buffer))? {
            let packet = buffer.get(..length).unwrap_or_default();
            let now = start.elapsed();
            self.pilot.handle_navdata(now, packet);
            if let Some(recorder) = &mut self.recorder {
                recorder.navdata(now, packet);
            }
        }
        Ok(())
    }

    fn take_in_services(&mut self, now: Duration) {
        while let Some(input) = self.services.poll() {
            match input {
                Input::Control(bytes) => {
                    self.pilot.handle_control(now, &bytes);
                    if let Some(recorder) = &mut self.recorder {
                        recorder.control(now, &bytes);
                    }
                }
                Input::Order(order) => self.order(now, order),
                Input::Stop => {
                    self.stops += 1;
                    if self.stops == 1 {
                        self.order(now, PilotOrder::Land);
                    }
                }
            }
        }
    }

    fn order(&mut self, now: Duration, order: PilotOrder) {
        self.pilot.order(now, order);
        if let Some(recorder) = &mut self.recorder {
            recorder.order(now, order);
        }
    }

    fn record_tick(&mut self, late: Duration, work: Duration, datagram: &Datagram) {
        if let (Some(recorder), Some(decision)) = (&mut self.recorder, self.pilot.decision()) {
            let ms = |time: Duration| time.as_secs_f64() * 1e3;
            let timing = Timing { late_ms: ms(late), work_ms: ms(work) };
            recorder.tick(*decision, timing, datagram.as_bytes());
        }
    }

    fn tell(&mut self, now: Duration, with_status: bool) {
        while let Some(event) = self.pilot.poll_event() {
            if let Some(recorder) = &mut self.recorder {
                recorder.event(now, event.clone());
            }
            self.say(Message::Event(now, event));
        }
        while let Some(waypoint) = self.pilot.report().waypoints.get(self.waypoints).copied() {
            self.waypoints += 1;
            self.say(Message::Waypoint(waypoint));
        }
        if with_status {
            let health = self.ticks.health();
            self.say(Message::Status(now, self.pilot.status(now), health));
        }
    }

    fn say(&mut self, message: Message) {
        if self.messages.try_send(message).is_err() {
            self.dropped_messages += 1;
        }
    }

    /// The second Ctrl-C: the landing is ordered a few times more, and nobody waits for it.
    fn leave(
        &mut self,
        start: Instant,
        datagram: &mut Datagram,
    ) -> Result<FinishedFlight, FlightError> {
        for _ in 0..PARTING_ORDERS {
            self.tick(start, datagram)?;
            self.record_tick(Duration::ZERO, Duration::ZERO, datagram);
            self.wait(TICK)?;
        }
        Ok(self.finished(start.elapsed(), Outcome::Interrupted))
    }

    fn finished(&mut self, now: Duration, outcome: Outcome) -> FinishedFlight {
        if let Some(recorder) = &mut self.recorder {
            recorder.outcome(now, outcome.clone());
        }
        FinishedFlight {
            outcome,
            report: self.pilot.report().clone(),
            ticks: self.ticks.summary(self.realtime),
            dropped_messages: self.dropped_messages,
            lost_records: self.recorder.as_ref().map_or(0, Recorder::lost),
        }
    }
}

/// Moves the deadline to the last one that has passed; returns how many were missed before it.
fn skip_missed(deadline: &mut Duration, now: Duration) -> u64 {
    let mut skipped = 0;
    while *deadline + TICK <= now {
        *deadline += TICK;
        skipped += 1;
    }
    skipped
}

/// A drone that is not there now does not end the flight.
fn tolerate(result: io::Result<usize>) -> Result<Option<usize>, FlightError> {
    match result {
        Err(error) if is_passing(&error) => Ok(None),
        result => result.map(Some).map_err(FlightError::Socket),
    }
}

#[cfg(test)]
mod tests {
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
}
