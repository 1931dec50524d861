//! Random streams of operators' orders, 1 to 400 of them each second. However fast they come, and from however many
//! operators, the drone stays inside its fence and off the floor, and orders that stop it never lead further than the
//! worst single one of them does from the same motion. Only the truth is judged.

mod orders;

use std::fmt;
use std::time::Duration;

use autopilot::Plan;
use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::{Operator, OperatorOrder, Station, VehicleConfig};
use mock_drone::firmware::Phase;
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, Truth, WorldConfig};
use nalgebra::Vector3;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use self::orders::{Moving, direction, give, nonsense, present, rate, seconds, stopping};

use crate::airframes::AIRFRAMES;
use crate::sim::{Simulation, SimulationError};
use crate::trial;

/// The fence of half of the flights.
const FENCE: FlightLimits = FlightLimits { ceiling_m: 2.5, ..trial::FENCE };
/// The border of the other half: it has a corner that points in.
pub const L_M: [[f64; 2]; 6] =
    [[-3.0, -3.0], [1.5, -3.0], [1.5, 1.2], [4.0, 1.2], [4.0, 4.0], [-3.0, 4.0]];
/// The drone holds its position above the start by then.
const BEGINS: Duration = Duration::from_secs(11);
/// Time after the stream in which the drone comes to rest, before it is landed.
const SETTLES: Duration = Duration::from_secs(5);
/// Time for a landing in the stream, to the ground.
const LANDS_WITHIN: Duration = Duration::from_secs(12);
/// Distance allowed outside the fence, as in the campaign.
const OUTSIDE_M: f64 = 0.5;
/// How much further than the worst single order the stream may lead: gusts and noise are not the same in both flights.
const FURTHER_M: f64 = 0.3;
/// Steady wind at most, in m/s: all airframes can brake against it.
const WIND_M_S: f64 = 0.6;

/// Most of the datagrams that are lost, each way.
const LOSS: f64 = 0.1;

/// Other operators at this machine, one elsewhere, and a ground station.
const PROGRAM: Operator = Operator::PROGRAM;
const PAGE: Operator = Operator { station: Station::Browser, number: 1, local: false };
const GROUND_STATION: Operator =
    Operator { station: Station::Mavlink, number: 0xff_be, local: true };

const START: OperatorOrder = OperatorOrder::Start { when_ready: true };

type Given = (Duration, Operator, OperatorOrder);

/// Where a stream of orders led.
#[derive(Debug, Clone, PartialEq)]
pub struct Flown {
    /// Determines everything.
    pub seed: u64,
    /// Its index in [`AIRFRAMES`].
    pub airframe: usize,
    /// Largest distance outside the fence, in metres, beyond the error of the drone's own sensors; negative inside.
    pub outside_m: f64,
    /// How much further the drone went than after the worst single order, from the first order to stop on, in metres.
    pub further_m: f64,
    /// How often it touched the floor before it was to land.
    pub touches: u32,
    /// A landing in the stream was not completed in time, or was taken back.
    pub landing_ignored: bool,
    /// The stream.
    what: String,
}

impl Flown {
    /// Whether something happened that must not.
    pub fn is_bad(&self) -> bool {
        self.outside_m > OUTSIDE_M
            || self.further_m > FURTHER_M
            || self.touches > 0
            || self.landing_ignored
    }
}

impl fmt::Display for Flown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, outside_m, further_m, what, .. } = self;
        let name = AIRFRAMES[self.airframe].name;
        write!(
            f,
            "seed {seed} on {name}: {outside_m:.2} m outside, {further_m:.2} m further than "
        )?;
        write!(f, "a single order, {what}")?;
        if self.touches > 0 {
            write!(f, ", touched the floor {} times", self.touches)?;
        }
        if self.landing_ignored { write!(f, ", landing ignored") } else { Ok(()) }
    }
}

/// Flies the stream of a seed.
///
/// # Errors
/// [`SimulationError`] if the flight never ends.
pub fn fly(seed: u64) -> Result<Flown, SimulationError> {
    let stream = Stream::of(seed);
    let course = stream.course(stream.moves.iter().chain(&stream.stops).cloned().collect())?;
    let mut single_m = f64::NEG_INFINITY;
    // Whatever replaces what the drone does begins with a hold, and what changes nothing else may go on with the mission.
    for kind in stream.kinds.iter().chain([&OperatorOrder::Hold, &START]) {
        let once = (stream.stops_at, stream.by, kind.clone());
        let single = stream.course(stream.moves.iter().cloned().chain([once]).collect())?;
        single_m = single_m.max(single.reach_m);
    }
    // A landing is no order to hold, and drifts.
    let compared = stream.lands_at.is_none() && stream.moved_at_stop(&course);
    Ok(Flown {
        seed,
        airframe: stream.airframe,
        outside_m: course.outside_m,
        further_m: if compared { course.reach_m - single_m } else { 0.0 },
        touches: course.touches,
        landing_ignored: course.landing_ignored,
        what: stream.what.clone(),
    })
}

/// Descriptions of the streams in which something happened that must not.
///
/// # Errors
/// As [`fly`].
pub fn bad(seeds: impl IntoIterator<Item = u64>) -> Result<Vec<String>, SimulationError> {
    let mut found = Vec::new();
    for seed in seeds {
        let flown = fly(seed)?;
        found.extend(flown.is_bad().then(|| flown.to_string()));
    }
    Ok(found)
}

/// A stream of orders that move the drone, then one of orders that stop it.
struct Stream {
    airframe: usize,
    simulation: Simulation,
    plan: Plan,
    /// Who orders it to stop.
    by: Operator,
    moves: Vec<Given>,
    stops_at: Duration,
    stops: Vec<Given>,
    /// Kinds of orders among those that stop it.
    kinds: Vec<OperatorOrder>,
    ends: Duration,
    lands_at: Option<Duration>,
    what: String,
}

/// The true course of a flight.
struct Course {
    outside_m: f64,
    /// Largest distance in the direction of the motion at the first order to stop.
    reach_m: f64,
    /// Speed at the first order to stop, in m/s.
    speed_m_s: f64,
    touches: u32,
    landing_ignored: bool,
}

impl Stream {
    fn of(seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let random = &mut random;
        let airframe = usize::try_from(seed % 4).unwrap_or_default();
        let wind_m_s =
            if random.random_bool(0.5) { random.random_range(0.0..WIND_M_S) } else { 0.0 };
        let drone = DroneConfig {
            seed,
            profile: (AIRFRAMES[airframe].profile)(),
            sensors: if random.random_bool(0.5) {
                SensorModel::nominal()
            } else {
                SensorModel::hard()
            },
            wind_m_s: direction(random) * wind_m_s,
            ..DroneConfig::default()
        };
        let others: &[Operator] = match random.random_range(0..4) {
            0 => &[Operator::TERMINAL, PROGRAM],
            1 => &[Operator::TERMINAL, PAGE],
            _ => &[Operator::TERMINAL],
        };
        // Numbers of their own: the streams of a seed stay what they were without these.
        let further = &mut ChaCha8Rng::seed_from_u64(seed ^ 0x6c69_6e6b);
        let loss = if further.random_bool(0.5) { further.random_range(0.0..LOSS) } else { 0.0 };
        let is_low = further.random_bool(0.2);
        let others = if further.random_bool(0.3) { &[GROUND_STATION] } else { others };
        let by = others[0];
        let stops_at = BEGINS + seconds(random, 0.6, 4.0);
        let moving = Moving::of(random, by);
        let moves_1_s = rate(random);
        let mut moves = moving.begin(BEGINS);
        give(random, others, BEGINS, stops_at, moves_1_s, &mut moves, |random| {
            moving.order(random)
        });
        let mut kinds = Vec::new();
        for _ in 0..random.random_range(1..4) {
            kinds.push(stopping(random));
        }
        let ends = stops_at + seconds(random, 1.0, 4.0);
        let stops_1_s = rate(random);
        let mut stops = vec![(stops_at, by, kinds[0].clone())];
        give(random, others, stops_at, ends, stops_1_s, &mut stops, |random| {
            if random.random_bool(0.15) {
                nonsense(random)
            } else {
                kinds[random.random_range(0..kinds.len())].clone()
            }
        });
        let lands_at = random.random_bool(0.15).then(|| {
            let at =
                stops_at + (ends.saturating_sub(stops_at)).mul_f64(random.random_range(0.0..1.0));
            stops.push((at, others[others.len() - 1], OperatorOrder::Land));
            at
        });
        moves.extend(present(by, BEGINS, ends + SETTLES));
        let names: Vec<_> = kinds.iter().map(OperatorOrder::name).collect();
        let what = format!(
            "{moving:?} at {moves_1_s:.0} Hz, from {:.2} s on {} at {stops_1_s:.0} Hz by {by} and {} others, wind \
             {wind_m_s:.1} m/s, {:.0} % lost{}",
            stops_at.as_secs_f64(),
            names.join(" "),
            others.len() - 1,
            100.0 * loss,
            if is_low { ", from near the floor" } else { "" },
        );
        // Each airframe flies in both.
        let fence = if (seed / 4).is_multiple_of(2) { in_an_l() } else { FENCE };
        let link = LinkFaults { loss, ..LinkFaults::default() };
        let up_m = if is_low { -0.5 } else { 0.3 };
        let simulation = Simulation {
            world: WorldConfig { drone, link, ..WorldConfig::default() },
            pilot: VehicleConfig { limits: fence, ..VehicleConfig::default() },
            ..Simulation::default()
        };
        let plan =
            plan(&format!("takeoff\ngoto 0 0 {up_m} 0\nsetStayTime 90\ngoto 0 0 {up_m} 0\nland\n"));
        Self { airframe, simulation, plan, by, moves, stops_at, stops, kinds, ends, lands_at, what }
    }

    /// Whether the drone flew when it was first ordered to stop, so that the way that it needs means something.
    fn moved_at_stop(&self, course: &Course) -> bool {
        course.speed_m_s > 0.3 && self.ends > self.stops_at
    }

    fn course(&self, mut orders: Vec<Given>) -> Result<Course, SimulationError> {
        let lands_at = self.ends + SETTLES;
        orders.push((lands_at, Operator::TERMINAL, OperatorOrder::Land));
        orders.sort_by_key(|(at, ..)| *at);
        let ordered_to_land = orders
            .iter()
            .find(|(.., order)| *order == OperatorOrder::Land)
            .map_or(lands_at, |(at, ..)| *at);
        let simulation = Simulation { others: orders, ..self.simulation.clone() };
        let mut course = Course {
            outside_m: f64::NEG_INFINITY,
            reach_m: f64::NEG_INFINITY,
            speed_m_s: 0.0,
            touches: 0,
            landing_ignored: false,
        };
        let mut touched_before = None;
        let mut begins: Option<(Vector3<f64>, Vector3<f64>)> = None;
        simulation.fly_watched(self.plan.clone(), |moment| {
            let truth = &moment.truth;
            let is_up = matches!(truth.phase, Phase::Flying | Phase::Landing);
            if moment.now > ordered_to_land + LANDS_WITHIN && is_up {
                course.landing_ignored = true;
            }
            if !is_up || moment.now >= ordered_to_land {
                return;
            }
            course.outside_m =
                course.outside_m.max(outside_m(truth, &self.simulation.pilot.limits));
            if moment.now >= BEGINS {
                let before = *touched_before.get_or_insert(truth.floor_contacts);
                course.touches = truth.floor_contacts - before;
            }
            if moment.now >= self.stops_at {
                let (from_m, way) = *begins.get_or_insert_with(|| {
                    course.speed_m_s = truth.velocity_m_s.norm();
                    let way = truth.velocity_m_s.try_normalize(1e-6);
                    (truth.position_m, way.unwrap_or_else(Vector3::zeros))
                });
                course.reach_m = course.reach_m.max((truth.position_m - from_m).dot(&way));
            }
        })?;
        Ok(course)
    }
}

/// As the campaign's judge measures it.
fn outside_m(truth: &Truth, fence: &FlightLimits) -> f64 {
    let across_m = fence.border.outside_m(truth.position_m.xy());
    let above_m = truth.position_m.z - fence.ceiling_m;
    across_m.max(above_m) - truth.drift_m().norm()
}

/// The fence with the border [`L_M`].
///
/// # Panics
/// Never: it is one.
fn in_an_l() -> FlightLimits {
    let border = Border::polygon(&L_M).unwrap_or_else(|error| panic!("{error}"));
    FlightLimits { border, ..FENCE }
}

/// Its targets are inside both fences.
fn plan(text: &str) -> Plan {
    Plan::parse_within("stream", text, &FENCE).unwrap_or_else(|error| panic!("{error}"))
}
