//! Several vehicles in one simulated time, that tell each other where they are.
//!
//! The same configuration gives the same flights, bit for bit.

mod random;

use std::collections::VecDeque;
use std::time::Duration;

use ardrone_pilot::drive::{self, Driver, POLL, Passed, Simulated};
use autopilot::outcome::Outcome;
use autopilot::separation::Neighbour;
use autopilot::vehicle::{
    self, CannotFly, FlightEvent, Input, Operator, OperatorOrder, Start, TICK, Telemetry, Vehicle,
    VehicleConfig,
};
use kinematics::world_from_body;
use mock_drone::firmware::Phase;
use mock_drone::{Standing, Truth, WorldConfig};
use nalgebra::{Vector2, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// No two in the air may be nearer to each other across, in truth.
pub const NEAREST_M: f64 = 0.8;

/// A drone that has not been heard for this long flies on as it was ordered last: until it is heard again, and for a while.
const HEARD: Duration = Duration::from_millis(300);
const RUNS_AWAY: Duration = Duration::from_secs(8);

/// One vehicle of a fleet.
#[derive(Debug, Clone)]
pub struct Member {
    /// Where it stands at the start, in the common frame.
    pub start: Start,
    /// Its plan, whose targets are places in the common frame.
    pub plan: String,
    /// The drone, the air around it, and the faults of both.
    pub world: WorldConfig,
    /// Its vehicle; number and start are set.
    pub pilot: VehicleConfig,
    /// Orders of its operator with their times, in the order of time.
    pub orders: Vec<(Duration, OperatorOrder)>,
}

/// How messages between vehicles travel, and whether more than messages does.
#[derive(Debug, Clone, Copy, Default)]
pub struct Air {
    /// Share of them that is lost.
    pub loss: f64,
    /// Delay of each.
    pub delay: Duration,
    /// From when to when none arrives.
    pub silent: Option<[Duration; 2]>,
    /// From when on the first vehicle tells a wrong place, and how far that is off.
    pub lie: Option<(Duration, Vector2<f64>)>,
    /// Seed of the losses.
    pub seed: u64,
    /// Whether the drones share the air: each feels the wash of those above, and hears the ultrasound of those nearby.
    pub is_shared: bool,
}

/// Vehicles in one room.
#[derive(Debug, Clone, Default)]
pub struct Fleet {
    /// The vehicles.
    pub members: Vec<Member>,
    /// The messages between them.
    pub air: Air,
}

/// What became of one vehicle.
#[derive(Debug, Clone, PartialEq)]
pub struct MemberFlight {
    /// How its flight ended; none if it did not within the limit.
    pub outcome: Option<Outcome>,
    /// When.
    pub ended: Duration,
    /// Its events with their times.
    pub events: Vec<(Duration, FlightEvent)>,
    /// How wrong it was of its height while it flew, at most.
    pub height_error_m: f64,
    /// Likewise the height that its drone reported.
    pub reported_height_error_m: f64,
}

/// Two vehicles in the air, and how near they were to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Their numbers.
    pub who: [usize; 2],
    /// When.
    pub at: Duration,
    /// Their distance across, in truth.
    pub across_m: f64,
}

/// The flights of a fleet.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetFlight {
    /// Those of the vehicles, in their order.
    pub members: Vec<MemberFlight>,
    /// Where they are at the end, in truth.
    pub places_m: Vec<Vector3<f64>>,
    /// The least distance of two in the air whose drones are heard; none if there never were two.
    pub nearest: Option<Nearest>,
    /// Likewise if one of them was not heard by its pilot, or not long ago: it flies on as it was ordered last, and nobody can
    /// stop it.
    pub runaway: Option<Nearest>,
    /// Whether all were on the ground at the end.
    pub is_down: bool,
}

impl FleetFlight {
    /// Whether all have flown their plans to the end.
    pub fn is_complete(&self) -> bool {
        self.members.iter().all(|member| member.outcome == Some(Outcome::Completed))
    }

    /// How near two came to each other whose drones were heard.
    pub fn nearest_m(&self) -> f64 {
        self.nearest.map_or(f64::INFINITY, |nearest| nearest.across_m)
    }

    /// Whether no two of them came too near to each other, and all came down.
    pub fn keeps_apart(&self) -> bool {
        self.is_down && self.nearest_m() >= NEAREST_M
    }

    /// When the last one was down.
    pub fn duration(&self) -> Duration {
        self.members.iter().map(|member| member.ended).max().unwrap_or_default()
    }
}

struct Flying {
    driver: Driver<Simulated>,
    flight: MemberFlight,
    orders: VecDeque<(Duration, OperatorOrder)>,
    /// When its drone was last not heard for too long.
    unheard_at: Option<Duration>,
    /// What was told to it, with the time of arrival.
    mail: VecDeque<(Duration, Neighbour)>,
}

impl Flying {
    /// Its true place in the common frame.
    fn place_m(&self) -> Vector3<f64> {
        self.driver.world().presence().position_m
    }

    fn is_up(&self) -> bool {
        let Truth { phase, position_m, .. } = self.driver.world().truth();
        !matches!(phase, Phase::Landed) && position_m.z > 0.1
    }

    /// Whether its pilot hears its drone, and did so for a while.
    fn is_heard(&self, now: Duration) -> bool {
        self.unheard_at.is_none_or(|at| now > at + RUNS_AWAY)
    }

    /// Whether it flies no more, and nothing is ordered.
    fn is_over(&self) -> bool {
        let is_ended = self.flight.outcome.is_some() && self.driver.vehicle.is_at_rest();
        is_ended && self.orders.is_empty()
    }

    /// Passes on what is due. What is refused changes nothing.
    fn receive(&mut self, now: Duration) {
        while self.orders.front().is_some_and(|(at, _)| *at <= now) {
            if let Some((_, order)) = self.orders.pop_front() {
                _ = self.driver.order(Operator::TERMINAL, order);
            }
        }
        while self.mail.front().is_some_and(|(at, _)| *at <= now) {
            if let Some((_, neighbour)) = self.mail.pop_front() {
                _ = self.driver.handle(Input::Neighbour(neighbour), |_, _| {});
            }
        }
    }

    /// Lets it do what is due; returns whether it has ticked.
    fn step(&mut self) -> bool {
        let flight = &mut self.flight;
        let ticked = self.driver.step(|at, passed| match passed {
            Passed::Told(Telemetry::Event(event)) => flight.events.push((at, event)),
            Passed::Told(Telemetry::Ended(outcome, _)) => {
                (flight.outcome, flight.ended) = (Some(outcome), at);
            }
            _ => {}
        });
        let decided = self.driver.vehicle.decision().filter(|_| ticked);
        if let Some(decision) = decided.filter(|decision| decision.phase == vehicle::Phase::Flying)
        {
            let height_m = self.driver.world().truth().position_m.z;
            let off_m = (decision.state.position_m.z - height_m).abs();
            self.flight.height_error_m = self.flight.height_error_m.max(off_m);
            let reported_m = self.driver.vehicle.status(self.driver.now()).altitude_m;
            let off_m = (reported_m.unwrap_or(height_m) - height_m).abs();
            self.flight.reported_height_error_m = self.flight.reported_height_error_m.max(off_m);
        }
        let now = self.driver.now();
        if self.driver.vehicle.status(now).navdata_age.is_some_and(|age| age > HEARD) {
            self.unheard_at = Some(now);
        }
        self.driver.pass();
        ticked
    }
}

impl Fleet {
    /// Flies all plans to their ends, or for so long.
    ///
    /// # Errors
    /// [`CannotFly`] if a plan cannot be flown.
    ///
    /// # Panics
    /// If a plan is none.
    pub fn fly(&self, limit: Duration) -> Result<FleetFlight, CannotFly> {
        self.fly_watched(limit, |_, _| {})
    }

    /// As [`Fleet::fly`]; `watch` gets the true places in the common frame in every tick.
    ///
    /// # Errors
    /// As [`Fleet::fly`].
    ///
    /// # Panics
    /// As [`Fleet::fly`].
    pub fn fly_watched(
        &self,
        limit: Duration,
        mut watch: impl FnMut(Duration, &[Vector3<f64>]),
    ) -> Result<FleetFlight, CannotFly> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.air.seed);
        let mut flying = Vec::new();
        let systems = || (1..).take(self.members.len());
        for (system, member) in systems().zip(&self.members) {
            let peers = systems().filter(|peer| *peer != system).collect();
            let mut config = VehicleConfig { system, peers, ..member.pilot.clone() };
            config.starts_at(Some(member.start));
            let vehicle = Vehicle::flying(crate::plan(&member.plan), &config)?;
            let Start { place_m, heading_deg, .. } = member.start;
            let start = Standing { place_m, heading_deg };
            let world = WorldConfig { start, ..member.world.clone() };
            flying.push(Flying {
                driver: Driver::new(vehicle, &world),
                flight: MemberFlight {
                    outcome: None,
                    ended: limit,
                    events: Vec::new(),
                    height_error_m: 0.0,
                    reported_height_error_m: 0.0,
                },
                orders: member.orders.iter().cloned().collect(),
                unheard_at: None,
                mail: VecDeque::new(),
            });
        }
        let mut nearest = [None; 2];
        let mut now = Duration::ZERO;
        while now < limit && !flying.iter().all(Flying::is_over) {
            if self.air.is_shared {
                drive::share_air(flying.iter_mut().map(|member| &mut member.driver));
            }
            let mut told = Vec::new();
            for (number, member) in flying.iter_mut().enumerate() {
                member.receive(now);
                if member.step() {
                    told.extend(member.driver.vehicle.as_neighbour(now).map(|of| (number, of)));
                }
            }
            for (from, mut neighbour) in told {
                if let Some((_, off_m)) = self.air.lie.filter(|(at, _)| from == 0 && now >= *at) {
                    neighbour.place_m += off_m;
                }
                for (number, member) in flying.iter_mut().enumerate() {
                    let is_silent =
                        self.air.silent.is_some_and(|[from, to]| (from..to).contains(&now));
                    let is_lost = rng.random::<f64>() < self.air.loss;
                    if number != from && !is_lost && !is_silent {
                        member.mail.push_back((now + self.air.delay, neighbour));
                    }
                }
            }
            if now.as_millis().is_multiple_of(TICK.as_millis()) {
                let places_m: Vec<_> = flying.iter().map(Flying::place_m).collect();
                watch(now, &places_m);
                nearest = nearer(nearest, now, &flying, &places_m);
            }
            now += POLL;
        }
        let is_down = !flying.iter().any(Flying::is_up);
        let places_m = flying.iter().map(Flying::place_m).collect();
        let members = flying.into_iter().map(|member| member.flight).collect();
        let [nearest, runaway] = nearest;
        Ok(FleetFlight { members, places_m, nearest, runaway, is_down })
    }
}

/// The least distances until now: of two that are heard, and of others.
fn nearer(
    known: [Option<Nearest>; 2],
    at: Duration,
    flying: &[Flying],
    places_m: &[Vector3<f64>],
) -> [Option<Nearest>; 2] {
    let up: Vec<usize> = (0..flying.len()).filter(|number| flying[*number].is_up()).collect();
    let pairs = || up.iter().flat_map(|a| up.iter().map(move |b| [*a, *b])).filter(|[a, b]| a < b);
    [true, false].map(|heard| {
        let of = pairs().filter(|pair| pair.iter().all(|one| flying[*one].is_heard(at)) == heard);
        let distances = of.map(|[a, b]| {
            let across: Vector2<f64> = places_m[a].xy() - places_m[b].xy();
            Nearest { who: [a, b], at, across_m: across.norm() }
        });
        let known = known[usize::from(!heard)].into_iter();
        known.chain(distances).min_by(|a, b| a.across_m.total_cmp(&b.across_m))
    })
}

/// Vehicles on a circle, each of which flies to the opposite place: through one point.
pub fn crossing(count: usize, radius_m: f64, seed: u64) -> Fleet {
    let members = (0..count).map(|number| {
        #[expect(clippy::cast_precision_loss, reason = "a fleet is small")]
        let angle_deg = 360.0 * number as f64 / count as f64;
        let place_m = world_from_body(Vector2::new(0.0, -radius_m), angle_deg);
        let mut world = WorldConfig::default();
        world.drone.seed = seed * 100 + number as u64;
        let [x_m, y_m] = (-place_m).into();
        Member {
            start: Start { place_m, heading_deg: angle_deg, deviation_m: 0.0 },
            plan: format!("takeoff\ngoto {x_m} {y_m} 0.5 0\nland\n"),
            world,
            pilot: VehicleConfig::default(),
            orders: Vec::new(),
        }
    });
    Fleet { members: members.collect(), air: Air { seed, ..Air::default() } }
}
