//! Drives a vehicle with a simulated drone; the counterpart of [`flight`](crate::flight) in simulated time.

use std::time::Duration;

use ardrone_link::WAKE_UP;
use autopilot::Vehicle;
use autopilot::vehicle::{Input, Operator, OperatorOrder, Output, Refused, TICK, Transmit};
use mock_drone::{Message, World, WorldConfig};

/// Interval of handling navdata; the drone's own steps are finer.
pub const POLL: Duration = Duration::from_millis(5);

/// A vehicle and its world, with their common time.
#[derive(Debug)]
pub struct Driver {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// The drone and the air around it.
    pub world: World,
    now: Duration,
    next_tick: Duration,
}

/// Inputs and outputs of the vehicle, as a recording contains them.
#[derive(Debug)]
pub enum Passed<'a> {
    /// From the drone's navdata port.
    Navdata(&'a [u8]),
    /// From the drone's control port.
    Control(&'a str),
    /// An output of the vehicle; datagrams have been delivered.
    Output(Output<'a>),
}

impl Driver {
    /// A driver at time zero.
    pub fn new(vehicle: Vehicle, world: &WorldConfig) -> Self {
        let world = World::new(world);
        Self { vehicle, world, now: Duration::ZERO, next_tick: Duration::ZERO }
    }

    /// Time since the beginning.
    pub fn now(&self) -> Duration {
        self.now
    }

    /// Gives an operator's order.
    ///
    /// # Errors
    /// [`Refused`] if the vehicle refuses it.
    pub fn order(&mut self, by: Operator, order: OperatorOrder) -> Result<(), Refused> {
        self.vehicle.order(self.now, by, order)
    }

    /// Handles all input of the present time, and ticks if a tick is due; returns whether it was. Time does
    /// not advance, so that the state after the tick can be inspected.
    pub fn step(&mut self, mut tee: impl FnMut(Passed<'_>)) -> bool {
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
            return false;
        }
        self.vehicle.tick(now);
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
        true
    }

    /// Simulates a program that does not run: the world advances, and input is queued. Returns whether a tick
    /// was missed.
    pub fn stall(&mut self) -> bool {
        self.world.advance(self.now);
        self.is_tick_due()
    }

    /// Advances the time.
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
