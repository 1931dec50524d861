//! Flights in simulated time: the same pilot, a simulated drone, no sockets, no clock.
//!
//! The same configuration gives the same flight, bit for bit, thousands of times faster than real.

use std::time::Duration;

use ardrone_link::WAKE_UP;
use ardrone_link::at::EncodeError;
use ardrone_link::settings::SettingError;
use ardrone_pilot::recording::{Record, Timing};
use autopilot::outcome::Outcome;
use autopilot::pilot::{
    FlightEvent, FlightReport, Input, Output, Pilot, PilotConfig, PilotOrder, Status, TICK,
    Transmit,
};
use autopilot::plan::Plan;
use mock_drone::{Message, Truth, World, WorldConfig};

/// A world to fly in.
#[derive(Debug, Clone, Default)]
pub struct Simulation {
    /// The drone, the air around it, and what goes wrong with both.
    pub world: WorldConfig,
    /// The pilot.
    pub pilot: PilotConfig,
    /// What the person at the controls orders, and when, in the order of time.
    pub orders: Vec<(Duration, PilotOrder)>,
    /// When the pilot's program does not run, and for how long: it neither hears nor says anything,
    /// and then finds all that came meanwhile. In the order of time.
    pub stalls: Vec<(Duration, Duration)>,
    /// How long the drone is watched after the flight, when it hears nothing more.
    pub aftermath: Duration,
}

/// A flight that was simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedFlight {
    /// How it ended.
    pub outcome: Outcome,
    /// What the pilot says of it.
    pub report: FlightReport,
    /// What happened, and when.
    pub events: Vec<(Duration, FlightEvent)>,
    /// What the simulation knows: the truth at the end of each waypoint's stay.
    pub truth_at_waypoints: Vec<Truth>,
    /// The truth at the end of the aftermath.
    pub final_truth: Truth,
    /// Simulated time from the start to the flight's end.
    pub duration: Duration,
}

/// A tick of a simulated flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// Since the start.
    pub now: Duration,
    /// What really happens.
    pub truth: Truth,
    /// What the pilot knows.
    pub status: Status,
}

/// Why a flight could not be simulated.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// The limits cannot be sent to a drone.
    #[error(transparent)]
    Config(#[from] SettingError),
    /// See [`Pilot::tick`].
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// The flight went on for an hour.
    #[error("the flight did not end within {} s", .limit.as_secs())]
    Endless {
        /// How long it was watched.
        limit: Duration,
    },
}

/// Navdata is taken in at this interval; the drone's own steps are finer.
const POLL: Duration = Duration::from_millis(5);
/// No battery lasts that long.
const LIMIT: Duration = Duration::from_hours(1);

impl Simulation {
    /// Flies `plan` to its end.
    ///
    /// # Errors
    /// [`SimulationError`]; a flight that goes wrong is no error but an [`Outcome`].
    pub fn fly(&self, plan: Plan) -> Result<SimulatedFlight, SimulationError> {
        self.fly_watched(plan, |_| {})
    }

    /// As [`Simulation::fly`]; `watch` sees every tick.
    ///
    /// # Errors
    /// As [`Simulation::fly`].
    pub fn fly_watched(
        &self,
        plan: Plan,
        watch: impl FnMut(&Moment),
    ) -> Result<SimulatedFlight, SimulationError> {
        let mut watch = watch;
        self.run(plan, |moment, _| watch(moment), |_| {})
    }

    /// As [`Simulation::fly_watched`]; `watch` sees the world too, from which it may ask what would
    /// happen if.
    ///
    /// # Errors
    /// As [`Simulation::fly`].
    pub fn fly_in_world(
        &self,
        plan: Plan,
        watch: impl FnMut(&Moment, &World),
    ) -> Result<SimulatedFlight, SimulationError> {
        self.run(plan, watch, |_| {})
    }

    /// As [`Simulation::fly`]; `record` gets every entry of a flight log.
    ///
    /// # Errors
    /// As [`Simulation::fly`].
    pub fn fly_recorded(
        &self,
        plan: Plan,
        record: impl FnMut(Record),
    ) -> Result<SimulatedFlight, SimulationError> {
        self.run(plan, |_, _| {}, record)
    }

    fn run(
        &self,
        plan: Plan,
        mut watch: impl FnMut(&Moment, &World),
        mut record: impl FnMut(Record),
    ) -> Result<SimulatedFlight, SimulationError> {
        let mut pilot = Pilot::new(plan, &self.pilot)?;
        let mut world = World::new(&self.world);
        let mut events = Vec::new();
        let mut truth_at_waypoints = Vec::new();
        let mut now = Duration::ZERO;
        let mut next_tick = Duration::ZERO;
        let mut orders = self.orders.iter().peekable();
        while now < LIMIT {
            if self.is_stalled(now) {
                world.advance(now);
                if now >= next_tick {
                    next_tick += TICK;
                    let moment = Moment { now, truth: world.truth(), status: pilot.status(now) };
                    watch(&moment, &world);
                }
                now += POLL;
                continue;
            }
            while let Some((_, order)) = orders.next_if(|(at, _)| now >= *at) {
                pilot.handle(now, Input::Order(*order));
                record(Record::Order { at: now, order: *order });
            }
            world.advance(now);
            while let Some(message) = world.receive(now) {
                match message {
                    Message::Navdata(packet) => {
                        pilot.handle(now, Input::Navdata(&packet));
                        record(Record::Navdata { at: now, packet: packet.to_vec() });
                    }
                    Message::Control(dump) => {
                        pilot.handle(now, Input::Control(dump.as_bytes()));
                        record(Record::Control { at: now, bytes: dump.into_bytes() });
                    }
                }
            }
            if now >= next_tick {
                next_tick += TICK;
                pilot.tick(now)?;
                let mut ended = None;
                let mut reached = false;
                while let Some(output) = pilot.poll() {
                    match output {
                        Output::Transmit(Transmit::Command { datagram, decision }) => {
                            world.send_at(now, datagram);
                            if let Some(decision) = decision.copied() {
                                let (timing, datagram) = (Timing::default(), datagram.to_vec());
                                record(Record::Tick { decision, timing, datagram });
                            }
                        }
                        Output::Transmit(Transmit::WakeUp) => world.send_wake_up(now, &WAKE_UP),
                        Output::Event(event) => {
                            record(Record::Event { at: now, event: event.clone() });
                            events.push((now, event));
                        }
                        Output::Waypoint(_) => reached = true,
                        Output::Ended(outcome) => ended = Some(outcome.clone()),
                    }
                }
                let moment = Moment { now, truth: world.truth(), status: pilot.status(now) };
                watch(&moment, &world);
                if reached {
                    truth_at_waypoints.push(world.truth());
                }
                if let Some(outcome) = ended {
                    record(Record::Outcome { at: now, outcome: outcome.clone() });
                    let end = now + self.aftermath;
                    let mut later = now;
                    while later < end {
                        later += TICK;
                        world.advance(later);
                        let status = pilot.status(now);
                        watch(&Moment { now: later, truth: world.truth(), status }, &world);
                    }
                    return Ok(SimulatedFlight {
                        outcome,
                        report: pilot.report().clone(),
                        events,
                        truth_at_waypoints,
                        final_truth: world.truth(),
                        duration: now,
                    });
                }
            }
            now += POLL;
        }
        Err(SimulationError::Endless { limit: LIMIT })
    }

    fn is_stalled(&self, now: Duration) -> bool {
        self.stalls.iter().any(|(at, time)| (*at..*at + *time).contains(&now))
    }
}
