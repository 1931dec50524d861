//! Several vehicles in one simulated time, that tell each other where they are.
//!
//! The same configuration gives the same flights, bit for bit.

mod air;
mod hand;
mod judge;
mod kinds;
mod meetings;
mod random;

use std::collections::{BTreeSet, VecDeque};
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::time::Duration;

use ardrone_pilot::drive::{self, Driver, POLL, Passed, Simulated};
use autopilot::outcome::Outcome;
use autopilot::separation::Neighbour;
use autopilot::vehicle::{
    self, CannotFly, FlightEvent, Input, Operator, OperatorOrder, Start, TICK, Telemetry, Transmit,
    Vehicle, VehicleConfig,
};
use mock_drone::firmware::Phase;
use mock_drone::{Standing, Truth, WorldConfig};
use nalgebra::{Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use self::air::Mail;
pub use self::air::{Air, Falsehood, Lie, Partition};
use self::hand::Hand;
use self::judge::Seen;
pub use self::judge::{Least, NEAREST_M, Nearest};
pub use self::meetings::{corridor, crossing, liar, take_off};
use crate::airframes::strongest_wind_m_s;
use crate::campaign::Injected;

/// Time after the last flight in which drones that nobody steers must land by themselves.
const AFTERMATH: Duration = Duration::from_secs(45);

/// One vehicle of a fleet.
#[derive(Debug, Clone)]
pub struct Member {
    /// Where it stands at the start, in the common frame.
    pub start: Start,
    /// Where it truly stands, if its start is not exact.
    pub stands: Option<Start>,
    /// Its plan, whose targets are places in the common frame.
    pub plan: String,
    /// The drone, the air around it, and the faults of both.
    pub world: WorldConfig,
    /// Its vehicle; number and start are set.
    pub pilot: VehicleConfig,
    /// Orders of its operator with their times, in the order of time.
    pub orders: Vec<(Duration, OperatorOrder)>,
    /// It is flown by somebody else's program: it hears of nobody and keeps away from nobody, but its place is told.
    pub is_foreign: bool,
    /// Faults of the campaign of single flights.
    pub(crate) injected: Injected,
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

impl MemberFlight {
    /// Whether it has flown its plan to the end.
    pub fn is_complete(&self) -> bool {
        self.outcome == Some(Outcome::Completed)
    }
}

/// The flights of a fleet.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetFlight {
    /// Those of the vehicles, in their order.
    pub members: Vec<MemberFlight>,
    /// Where they are at the end, in truth.
    pub places_m: Vec<Vector3<f64>>,
    /// How near they came to each other.
    pub least: Least,
    /// Whether all were on the ground at the end.
    pub is_down: bool,
    /// The kinds of faults that had begun before the end.
    pub kinds: BTreeSet<&'static str>,
    /// Hash of all datagrams to the drones, with their times.
    pub datagrams: u64,
}

impl FleetFlight {
    /// Whether all have flown their plans to the end.
    pub fn is_complete(&self) -> bool {
        self.members.iter().all(MemberFlight::is_complete)
    }

    /// How near two came to each other for which there is no excuse.
    pub fn nearest_m(&self) -> f64 {
        self.least.judged.map_or(f64::INFINITY, |nearest| nearest.across_m)
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
    hand: Hand,
    mail: Mail,
    /// The message with which it began to tell what is not so.
    lie: Option<Neighbour>,
    /// How far the place that it told last is from the one it knows.
    told_off_m: Vector2<f64>,
    sent: DefaultHasher,
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
        while let Some(neighbour) = self.mail.take(now) {
            _ = self.driver.handle(Input::Neighbour(neighbour), |_, _| {});
        }
    }

    /// Lets it do what is due; returns whether it has ticked.
    fn step(&mut self) -> bool {
        let (flight, sent) = (&mut self.flight, &mut self.sent);
        let ticked = self.driver.step(|at, passed| match passed {
            Passed::Sent { transmit: Transmit::Command { datagram, .. }, .. } => {
                (at, datagram).hash(sent);
            }
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
        ticked
    }

    /// What it tells the others, if it does in this tick.
    fn tells(&mut self, now: Duration, number: usize, air: &Air) -> Option<Neighbour> {
        let truth = self.driver.vehicle.as_neighbour(now)?;
        let told = air.told(now, number, truth, &mut self.lie);
        self.told_off_m = told.place_m - truth.place_m;
        Some(told)
    }

    /// This vehicle for the judge.
    fn seen(&mut self, now: Duration, number: usize, air: &Air) -> Seen {
        let status = self.driver.vehicle.status(now);
        let truth = self.driver.world().truth();
        self.hand.watch(now, &truth, status.navdata_age);
        let lies = air.is_credible_lie(now, number);
        let off_m = if lies { self.told_off_m } else { Vector2::zeros() };
        let is_wrong = lies || self.hand.injected.has_lied(now);
        let told_m = status.pose.map(|pose| Vector2::new(pose.x_m, pose.y_m) + off_m);
        Seen {
            place_m: self.place_m(),
            told_m: told_m.filter(|_| is_wrong),
            is_up: self.is_up(),
            is_lost: self.hand.is_lost(now),
        }
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
            let hears = |peer: &u8| *peer != system && !member.is_foreign;
            let peers = systems().filter(hears).collect();
            let mut config = VehicleConfig { system, peers, ..member.pilot.clone() };
            config.starts_at(Some(member.start));
            let vehicle = Vehicle::flying(crate::plan(&member.plan), &config)?;
            let Start { place_m, heading_deg, .. } = member.stands.unwrap_or(member.start);
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
                hand: Hand::new(
                    member.injected.clone(),
                    strongest_wind_m_s(&member.world.drone.profile),
                    member.world.drone.wind_m_s.norm(),
                ),
                mail: Mail::default(),
                lie: None,
                told_off_m: Vector2::zeros(),
                sent: DefaultHasher::new(),
            });
        }
        let mut least = Least::default();
        let mut now = Duration::ZERO;
        let mut over_at = None;
        while now < limit {
            if flying.iter().all(Flying::is_over) {
                let over_at = *over_at.get_or_insert(now);
                if now >= over_at + AFTERMATH || !flying.iter().any(Flying::is_up) {
                    break;
                }
            }
            if self.air.is_shared {
                drive::share_air(flying.iter_mut().map(|member| &mut member.driver));
            }
            let mut told = Vec::new();
            for (number, member) in flying.iter_mut().enumerate() {
                if member.hand.injected.is_stalled(now) {
                    member.driver.stall();
                } else {
                    member.receive(now);
                    if member.step() {
                        told.extend(member.tells(now, number, &self.air).map(|of| (number, of)));
                    }
                }
                member.driver.pass();
            }
            for (from, neighbour) in told {
                let hears = |to: usize| to != from && !self.members[to].is_foreign;
                for (to, member) in flying.iter_mut().enumerate().filter(|(to, _)| hears(*to)) {
                    if let Some(at) = self.air.arrives(now, [from, to], &mut rng) {
                        member.mail.put(at, neighbour);
                    }
                }
            }
            if now.as_millis().is_multiple_of(TICK.as_millis()) {
                let seen = flying.iter_mut().enumerate();
                let seen: Vec<_> =
                    seen.map(|(number, member)| member.seen(now, number, &self.air)).collect();
                let places_m: Vec<_> = seen.iter().map(|seen| seen.place_m).collect();
                watch(now, &places_m);
                least.watch(now, &seen);
            }
            now += POLL;
        }
        let is_down = !flying.iter().any(Flying::is_up);
        let places_m = flying.iter().map(Flying::place_m).collect();
        let mut all = DefaultHasher::new();
        for member in &flying {
            member.sent.finish().hash(&mut all);
        }
        let kinds = self.kinds(now, flying.iter().map(|member| &member.hand.injected));
        let members = flying.into_iter().map(|member| member.flight).collect();
        Ok(FleetFlight { members, places_m, least, is_down, kinds, datagrams: all.finish() })
    }
}
