//! The client's task: runs the session on its sockets.

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

use bytes::Bytes;
use tokio::sync::{broadcast, mpsc, watch};
use tokio::time::{Instant, Interval, MissedTickBehavior, interval};

use super::error::ClientError;
use super::limits::{BUFFER_BYTES, TICK};
use super::orders::{Orders, Reply, Seen};
use super::readiness::{ConfigureReply, Readiness, ReadyReply};
use super::wire::Wire;
use crate::WAKE_UP;
use crate::at::{Config, Motion};
use crate::navdata::{ControlState, Navdata};
use crate::session::{self, Event, Output, Session, Transmit};

/// Landing orders sent when the client ends; several, because a datagram may be lost.
pub(super) const PARTING_ORDERS: u32 = 10;
/// Maximum ticks for sending them if the system refuses.
const PARTING_TICKS: u32 = 3 * PARTING_ORDERS;

/// A request to the task, with the channel for its reply.
#[derive(Debug)]
pub(super) enum Request {
    Ready(ReadyReply),
    Configure(Config, ConfigureReply),
    TakeOff(Reply),
    Land(Reply),
    FlatTrim,
    EmergencyStop(Reply),
    EmergencyReset(Reply),
    #[cfg(test)]
    Panic,
}

/// Steering that begins at a given time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steered {
    pub(super) at: Instant,
    pub(super) duration: Duration,
    pub(super) motion: Motion,
}

/// State available to the client's methods without asking the task.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Status {
    pub(super) airborne: bool,
    pub(super) standing: bool,
    pub(super) ended: Option<ClientError>,
}

pub(super) struct Link {
    pub(super) session: Session,
    pub(super) orders: Orders,
    pub(super) readiness: Readiness,
    pub(super) at: Wire,
    pub(super) navdata: Wire,
    pub(super) control: mpsc::Receiver<Bytes>,
    pub(super) requests: mpsc::UnboundedReceiver<Request>,
    pub(super) steering: watch::Receiver<Option<Steered>>,
    pub(super) status: watch::Sender<Status>,
    pub(super) events: broadcast::Sender<Event>,
    pub(super) packets: watch::Sender<Option<Bytes>>,
    /// Control state in the newest packet.
    pub(super) control_state: Option<ControlState>,
    /// Charge in the newest packet that contains it.
    pub(super) battery_percent: Option<u32>,
    /// Receiving failed: it is not tried again before the next tick.
    pub(super) rests: bool,
}

/// Events that wake the task.
enum Input {
    Tick,
    Request(Request),
    Control(Bytes),
    Navdata(io::Result<usize>),
}

impl Link {
    pub(super) async fn run(mut self) -> Result<(), ClientError> {
        let start = Instant::now();
        let mut clock = interval(TICK);
        clock.set_missed_tick_behavior(MissedTickBehavior::Skip);
        let end = self.fly(start, &mut clock).await;
        self.dismiss(end.clone().err().unwrap_or(ClientError::Closed));
        // The landing is ordered whatever ended the flight.
        self.part(start, &mut clock).await;
        end
    }

    /// Runs until the client is dropped.
    async fn fly(&mut self, start: Instant, clock: &mut Interval) -> Result<(), ClientError> {
        let mut buffer = [0_u8; BUFFER_BYTES];
        loop {
            // Ticks have priority, however much navdata arrive, then orders, then navdata.
            let input = tokio::select! {
                biased;
                _ = clock.tick() => Input::Tick,
                request = self.requests.recv() => match request {
                    Some(request) => Input::Request(request),
                    None => return Ok(()),
                },
                Some(block) = self.control.recv() => Input::Control(block),
                received = self.navdata.socket.recv(&mut buffer), if !self.rests => {
                    Input::Navdata(received)
                }
            };
            let now = start.elapsed();
            let ticks = matches!(input, Input::Tick);
            if ticks {
                self.take_in_steering(start);
            }
            // After a panic of the session the landing must still be ordered.
            let handled = catch_unwind(AssertUnwindSafe(|| self.handle(now, input, &buffer)));
            let wake_up = handled.map_err(|_| ClientError::Task)?;
            if ticks {
                self.send(now, wake_up).await;
            }
            if self.navdata.mend(now).await {
                self.navdata.send(now, &WAKE_UP).await;
            }
        }
    }

    fn take_in_steering(&mut self, start: Instant) {
        // An error means that the client was dropped, which ends the loop.
        if self.steering.has_changed().unwrap_or(false)
            && let Some(Steered { at, duration, motion }) = *self.steering.borrow_and_update()
        {
            self.orders.steer(at.saturating_duration_since(start), duration, motion);
        }
    }

    /// Handles an event; returns whether the drone must be woken up.
    fn handle(&mut self, now: Duration, input: Input, buffer: &[u8]) -> bool {
        let mut packet: &[u8] = &[];
        match input {
            Input::Tick => {
                self.rests = false;
                let order = self.orders.order(now, &self.seen(now));
                self.session.handle(now, session::Input::Tick(order));
            }
            Input::Request(request) => self.ask(now, request),
            Input::Control(block) => self.session.handle(now, session::Input::Control(&block)),
            Input::Navdata(received) => match self.navdata.judge(now, received) {
                Some(length) => {
                    packet = &buffer[..length];
                    self.session.handle(now, session::Input::Navdata(packet));
                }
                None => self.rests = true,
            },
        }
        let wake_up = self.take_in(now, packet);
        self.report(now);
        wake_up
    }

    fn ask(&mut self, now: Duration, request: Request) {
        match request {
            Request::Ready(reply) => self.readiness.wait(now, reply),
            Request::Configure(config, reply) => {
                if self.readiness.change(now, self.session.is_ready(), &config, reply) {
                    self.request(now, session::Request::Setting(config));
                }
            }
            Request::TakeOff(reply) => self.orders.take_off(now, &self.seen(now), reply),
            Request::Land(reply) => self.orders.land(now, reply),
            Request::FlatTrim => self.request(now, session::Request::FlatTrim),
            Request::EmergencyStop(reply) => {
                self.request(now, session::Request::EmergencyStop);
                self.orders.stop(now, reply);
            }
            Request::EmergencyReset(reply) => {
                self.request(now, session::Request::EmergencyReset);
                self.orders.reset(now, reply);
            }
            #[cfg(test)]
            Request::Panic => panic!("something is wrong"),
        }
    }

    fn request(&mut self, now: Duration, request: session::Request) {
        self.session.handle(now, session::Input::Request(request));
    }

    /// Takes in the session's outputs after an input; `packet` is its navdata datagram, if any. Returns whether
    /// the drone must be woken up. The command is sent by [`Self::send`].
    fn take_in(&mut self, now: Duration, packet: &[u8]) -> bool {
        let mut wake_up = false;
        while let Some(output) = self.session.poll() {
            match output {
                Output::Transmit(Transmit::Command(_)) => {}
                Output::Transmit(Transmit::WakeUp) => wake_up = true,
                Output::Navdata(Navdata { demo, .. }) => {
                    self.control_state = demo.map(|demo| demo.control_state);
                    self.battery_percent =
                        demo.map(|demo| demo.battery_percent).or(self.battery_percent);
                    self.packets.send_replace(Some(Bytes::copy_from_slice(packet)));
                }
                Output::Damaged(error) => tracing::debug!("{error}"),
                Output::Event(event) => self.pass_on(now, event),
            }
        }
        wake_up
    }

    /// Passes on an event to those who wait for it.
    fn pass_on(&mut self, now: Duration, event: Event) {
        self.orders.event(&event, &self.seen(now));
        self.readiness.event(&event);
        if event == Event::LinkLost {
            // The last packet may not be valid any more.
            self.packets.send_replace(None);
        }
        // Without subscriptions there is no receiver.
        _ = self.events.send(event);
    }

    /// Updates everything that depends on the drone's state.
    fn report(&mut self, now: Duration) {
        let seen = self.seen(now);
        self.orders.observe(now, &seen);
        self.readiness.observe(now, seen.ready, seen.alive);
        let airborne = self.orders.is_airborne();
        let standing = seen.alive && seen.stands();
        self.status.send_if_modified(|status| {
            let new = Status { airborne, standing, ended: None };
            std::mem::replace(status, new.clone()) != new
        });
    }

    fn seen(&self, now: Duration) -> Seen {
        Seen {
            alive: self.session.is_alive(),
            ready: self.session.is_ready(),
            state: self.session.state(),
            control_state: self.control_state,
            battery_percent: self.battery_percent,
            heard_at: self.session.silence(now).map(|silence| now.saturating_sub(silence)),
        }
    }

    async fn send(&mut self, now: Duration, wake_up: bool) {
        let datagram = self.session.datagram();
        if !datagram.is_empty() {
            self.at.send(now, datagram).await;
        }
        self.at.mend(now).await;
        if wake_up {
            self.navdata.send(now, &WAKE_UP).await;
        }
    }

    /// Fails every wait, before the last datagrams are sent, so that callers learn of the end early.
    fn dismiss(&mut self, reason: ClientError) {
        self.status.send_replace(Status { ended: Some(reason), ..Status::default() });
        self.packets.send_replace(None);
        self.requests.close();
        while self.requests.try_recv().is_ok() {}
        self.orders.end();
        self.readiness.end();
    }

    /// Orders the landing repeatedly.
    async fn part(&mut self, start: Instant, clock: &mut Interval) {
        let mut parted = 0;
        for _ in 0..PARTING_TICKS {
            clock.tick().await;
            let now = start.elapsed();
            self.session.handle(now, session::Input::Part);
            let datagram = self.session.datagram();
            // A drone that was never sent anything must not be landed: another client may fly it.
            if datagram.is_empty() || parted == PARTING_ORDERS {
                return;
            }
            parted += u32::from(self.at.send(now, datagram).await);
            self.at.mend(now).await;
        }
    }
}
