//! Flights in simulated time: the same pilot, a simulated drone, no sockets, no clock.
//!
//! The same configuration gives the same flight, bit for bit, thousands of times faster than real.

use std::collections::VecDeque;
use std::ops::Range;
use std::time::Duration;

use ardrone_link::at::{ConfigError, Datagram, EncodeError};
use mock_drone::{Drone, DroneConfig, Truth};

use crate::outcome::Outcome;
use crate::pilot::{FlightEvent, FlightReport, Pilot, PilotConfig, TICK};
use crate::plan::Plan;

/// A world to fly in.
#[derive(Debug, Clone, Default)]
pub struct Simulation {
    /// The drone.
    pub drone: DroneConfig,
    /// The pilot.
    pub pilot: PilotConfig,
    /// Time that each datagram is on its way, in either direction.
    pub delay: Duration,
    /// Spans of time in which every datagram is lost.
    pub outages: Vec<Range<Duration>>,
    /// When the person at the keyboard orders the landing.
    pub landing_ordered_at: Option<Duration>,
    /// When the drone is switched off and on again.
    pub restart_at: Option<Duration>,
    /// When something stops one of the drone's propellers.
    pub propeller_blocked_at: Option<Duration>,
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
    /// The truth at the end.
    pub final_truth: Truth,
    /// Simulated time from the start to the end.
    pub duration: Duration,
}

/// Why a flight could not be simulated.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// The limits cannot be sent to a drone.
    #[error(transparent)]
    Config(#[from] ConfigError),
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
        let mut pilot = Pilot::new(plan, &self.pilot)?;
        let mut world = World {
            simulation: self,
            drone: Drone::new(&self.drone),
            booted: Duration::ZERO,
            up: VecDeque::new(),
            down: VecDeque::new(),
        };
        let mut datagram = Datagram::new();
        let mut events = Vec::new();
        let mut truth_at_waypoints = Vec::new();
        let mut now = Duration::ZERO;
        let mut next_tick = Duration::ZERO;
        let mut restart_at = self.restart_at;
        let mut landing_ordered_at = self.landing_ordered_at;
        let mut propeller_blocked_at = self.propeller_blocked_at;
        while now < LIMIT {
            if restart_at.take_if(|at| now >= *at).is_some() {
                world.drone = Drone::new(&self.drone);
                world.booted = now;
            }
            if propeller_blocked_at.take_if(|at| now >= *at).is_some() {
                world.drone.block_propeller();
            }
            if landing_ordered_at.take_if(|at| now >= *at).is_some() {
                pilot.order_landing(now);
            }
            world.live(now);
            while let Some(message) = world.receive(now) {
                match message {
                    Down::Navdata(packet) => pilot.handle_navdata(now, &packet),
                    Down::Control(dump) => pilot.handle_control(now, dump.as_bytes()),
                }
            }
            if now >= next_tick {
                next_tick += TICK;
                pilot.tick(now, &mut datagram)?;
                if !datagram.as_bytes().is_empty() {
                    world.send(now, Up::Commands(datagram.as_bytes().to_vec()));
                }
                if pilot.wake_up_due(now) {
                    world.send(now, Up::WakeUp);
                }
                while let Some(event) = pilot.poll_event() {
                    events.push((now, event));
                }
                let reached = pilot.report().waypoints.len();
                if reached > truth_at_waypoints.len() {
                    truth_at_waypoints.push(world.drone.truth());
                }
                if let Some(outcome) = pilot.outcome() {
                    return Ok(SimulatedFlight {
                        outcome: outcome.clone(),
                        report: pilot.report().clone(),
                        events,
                        truth_at_waypoints,
                        final_truth: world.drone.truth(),
                        duration: now,
                    });
                }
            }
            now += POLL;
        }
        Err(SimulationError::Endless { limit: LIMIT })
    }
}

/// The drone and the air between it and the pilot.
struct World<'a> {
    simulation: &'a Simulation,
    drone: Drone,
    /// When the drone was switched on.
    booted: Duration,
    up: VecDeque<(Duration, Up)>,
    down: VecDeque<(Duration, Down)>,
}

enum Up {
    Commands(Vec<u8>),
    WakeUp,
}

enum Down {
    Navdata(Vec<u8>),
    Control(String),
}

impl World<'_> {
    fn send(&mut self, now: Duration, message: Up) {
        if !self.is_out(now) {
            self.up.push_back((now + self.simulation.delay, message));
        }
    }

    /// Delivers what has reached the drone and lets it live until `now`.
    fn live(&mut self, now: Duration) {
        while let Some((due, message)) = self.up.pop_front_if(|(due, _)| *due <= now) {
            let drone_time = due.saturating_sub(self.booted);
            match message {
                // What the drone does not understand it ignores, as the real one does.
                Up::Commands(datagram) => drop(self.drone.handle_at(drone_time, &datagram)),
                Up::WakeUp => self.drone.handle_wake_up(drone_time),
            }
        }
        self.drone.advance(now.saturating_sub(self.booted));
        let arrival = now + self.simulation.delay;
        let out = self.is_out(now);
        while let Some(packet) = self.drone.poll_navdata() {
            if !out {
                self.down.push_back((arrival, Down::Navdata(packet.to_vec())));
            }
        }
        if let Some(dump) = self.drone.poll_control() {
            self.down.push_back((arrival, Down::Control(dump)));
        }
    }

    fn receive(&mut self, now: Duration) -> Option<Down> {
        self.down.pop_front_if(|(due, _)| *due <= now).map(|(_, message)| message)
    }

    fn is_out(&self, now: Duration) -> bool {
        self.simulation.outages.iter().any(|outage| outage.contains(&now))
    }
}
