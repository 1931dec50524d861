//! A vehicle over a simulated drone: the loop that in real time is `ardrone_pilot::flight`.

use std::time::Duration;

use ardrone_link::WAKE_UP;
use ardrone_link::at::EncodeError;
use autopilot::Vehicle;
use autopilot::vehicle::{Input, Operator, OperatorOrder, Output, Refused, TICK, Transmit};
use mock_drone::{Message, World, WorldConfig};

/// Navdata is taken in at this interval; the drone's own steps are finer.
pub(crate) const POLL: Duration = Duration::from_millis(5);

/// A vehicle, its drone, and the time of both.
#[derive(Debug)]
pub struct Driver {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// The drone and its air.
    pub world: World,
    now: Duration,
    next_tick: Duration,
}

/// Everything that goes in and comes out: what a recording is made of.
#[derive(Debug)]
pub enum Passed<'a> {
    /// From the drone's navdata port.
    Navdata(&'a [u8]),
    /// From the drone's control port.
    Control(&'a str),
    /// What the vehicle says, after it was sent if it is to be sent.
    Output(Output<'a>),
}

impl Driver {
    /// At the beginning of time.
    pub fn new(vehicle: Vehicle, world: &WorldConfig) -> Self {
        let world = World::new(world);
        Self { vehicle, world, now: Duration::ZERO, next_tick: Duration::ZERO }
    }

    /// Since the beginning.
    pub fn now(&self) -> Duration {
        self.now
    }

    /// An operator orders something.
    ///
    /// # Errors
    /// Why the vehicle refuses.
    pub fn order(&mut self, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        self.vehicle.order(self.now, by, order)
    }

    /// Takes in what has come by now, and ticks if that is due; returns whether it was. Time has not gone on
    /// yet, so that everything can be looked at as the tick has left it.
    ///
    /// # Errors
    /// See [`Vehicle::tick`].
    pub fn step(&mut self, mut tee: impl FnMut(Passed<'_>)) -> Result<bool, EncodeError> {
        let now = self.now;
        self.world.advance(now);
        while let Some(message) = self.world.receive(now) {
            match &message {
                Message::Navdata(packet) => {
                    self.vehicle.handle(now, Input::Navdata(packet));
                    tee(Passed::Navdata(packet));
                }
                Message::Control(dump) => {
                    self.vehicle.handle(now, Input::Control(dump.as_bytes()));
                    tee(Passed::Control(dump));
                }
            }
        }
        if !self.is_tick_due() {
            return Ok(false);
        }
        self.vehicle.tick(now)?;
        while let Some(output) = self.vehicle.poll() {
            match &output {
                Output::Transmit(Transmit::Command { datagram, .. }) => {
                    self.world.send_at(now, datagram);
                }
                Output::Transmit(Transmit::WakeUp) => self.world.send_wake_up(now, &WAKE_UP),
                _ => {}
            }
            tee(Passed::Output(output));
        }
        Ok(true)
    }

    /// The program does not run: the drone lives on, and what comes waits. Returns whether a tick was missed.
    pub fn stall(&mut self) -> bool {
        self.world.advance(self.now);
        self.is_tick_due()
    }

    /// Time goes on.
    pub fn pass(&mut self) {
        self.now += POLL;
    }

    fn is_tick_due(&mut self) -> bool {
        let due = self.now >= self.next_tick;
        if due {
            self.next_tick += TICK;
        }
        due
    }
}
