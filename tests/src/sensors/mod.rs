//! Single sensor failures: how far a drone is led astray when one measured quantity is wrong.
//!
//! Each flight has a healthy twin with the same seed, which is identical up to the fault. The fault therefore
//! starts at the intended moment, and the undisturbed course is known.

mod random;

use std::fmt;
use std::time::Duration;

use ardrone_link::at::Motion;
use autopilot::Plan;
use autopilot::outcome::Outcome;
use autopilot::vehicle::{TICK, VehicleConfig};
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::{Action, Scenario, When};
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, Quantity, SensorFault, Truth, WorldConfig};
use nalgebra::{Vector2, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

pub use random::{RandomFlight, random, random_of};

use crate::airframes::Model;
use crate::sim::{Moment, Simulation, SimulationError};
use crate::trial::{FENCE, FOR_EVER};
use crate::{alone, place_in_navdata_frame};

/// Largest allowed distance outside the fence after a single fault, in metres.
pub const MOST_OUTSIDE_M: f64 = 3.0;
/// Largest allowed distance from the target or from the way to it, in metres.
pub const MOST_AWAY_M: f64 = 1.5;
/// Allowed distance beyond that of the drone's own hover and landing, in metres, where wind makes those drift
/// further than the limits above: nothing can do better.
pub const OWN_MARGIN_M: f64 = 0.3;
/// Longest allowed contact with the floor.
pub const MOST_SCRAPING: Duration = Duration::from_secs(3);

/// The first step of each plan.
const TAKE_OFF: usize = 0;
/// The step of each plan in which a sensor fails: its second `goto`, after its setting.
const STEP: usize = 3;
/// Hover height after take-off, in metres.
const HOVER_M: f64 = 0.85;
const AFTERMATH: Duration = Duration::from_secs(30);

/// Activity of the drone when a sensor fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Situation {
    /// Holding position in a wind of 0.5 m/s.
    Holding,
    /// Flying to a target 3 m to the right.
    Moving,
    /// Climbing by 1.4 m.
    Climbing,
    /// Descending by 1.8 m.
    Descending,
    /// Turning by 150 degrees.
    Turning,
}

impl Situation {
    /// All situations.
    pub const ALL: [Self; 5] =
        [Self::Holding, Self::Moving, Self::Climbing, Self::Descending, Self::Turning];

    /// The plan, and start and end of the motion in its step [`STEP`].
    fn plan(self) -> (Plan, [Vector3<f64>; 2]) {
        let at = |right_m, up_m| Vector3::new(right_m, 0.0, HOVER_M + up_m);
        let (text, between) = match self {
            Self::Holding => (
                "takeoff\ngoto 0 0 0.5 0\nsetStayTime 30\ngoto 0 0 0.5 0\nland\n",
                [at(0.0, 0.5), at(0.0, 0.5)],
            ),
            Self::Moving => (
                "takeoff\ngoto 0 0 0.5 0\nsetStayTime 10\ngoto 3 0 0.5 0\nland\n",
                [at(0.0, 0.5), at(3.0, 0.5)],
            ),
            Self::Climbing => (
                "takeoff\ngoto 0 0 0 0\nsetStayTime 10\ngoto 0 0 1.4 0\nland\n",
                [at(0.0, 0.0), at(0.0, 1.4)],
            ),
            Self::Descending => (
                "takeoff\ngoto 0 0 1.4 0\nsetStayTime 10\ngoto 0 0 -0.4 0\nland\n",
                [at(0.0, -0.4), at(0.0, 1.4)],
            ),
            Self::Turning => (
                "takeoff\ngoto 0 0 0.5 0\nsetStayTime 10\ngoto 0 0 0.5 150\nland\n",
                [at(0.0, 0.5), at(0.0, 0.5)],
            ),
        };
        let plan =
            Plan::parse_within("sensors", text, &FENCE).unwrap_or_else(|error| panic!("{error}"));
        (plan, between)
    }
}

impl fmt::Display for Situation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holding => "holding",
            Self::Moving => "moving",
            Self::Climbing => "climbing",
            Self::Descending => "descending",
            Self::Turning => "turning",
        })
    }
}

/// Quantities that become noisy together, or have a wrong gain together, and the deviations of their noise.
const NOISE: [(&str, &[Quantity], [f64; 3]); 4] = [
    ("velocity", &[Quantity::VelocityRight, Quantity::VelocityForward], [0.1, 0.4, 1.0]),
    ("altitude", &[Quantity::Altitude], [0.1, 0.4, 1.0]),
    ("yaw", &[Quantity::Yaw], [2.0, 6.0, 20.0]),
    ("roll and pitch", &[Quantity::Roll, Quantity::Pitch], [2.0, 6.0, 20.0]),
];
/// Wrong gains.
const GAINS: [f64; 7] = [-1.0, 0.2, 0.4, 0.7, 1.5, 2.0, 3.0];

/// A sensor failure with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Name for reports.
    pub name: String,
    /// Faults that begin at the same time and do not end.
    pub faults: Vec<(Quantity, SensorFault)>,
}

impl Failure {
    /// Whether navdata can reveal the failure. A velocity that drifts, or that is frozen but noisy, cannot be
    /// distinguished from a rising wind while the drone holds its position, and one that is late by half a
    /// second only degrades the control. How far these lead is reported but not judged.
    pub fn shows(&self) -> bool {
        self.faults.iter().any(|(quantity, fault)| shows(*quantity, *fault))
    }
}

fn shows(quantity: Quantity, fault: SensorFault) -> bool {
    !matches!(
        (quantity, fault),
        (
            Quantity::VelocityRight | Quantity::VelocityForward,
            SensorFault::Ramp(_) | SensorFault::DeadAt(_) | SensorFault::Late(_)
        )
    ) && !is_weaker_airframe(quantity, fault)
}

/// A velocity that shows too little is that of a weaker airframe or of stronger drag, and is found late if at all. One with
/// the wrong sign looks like a storm.
fn is_weaker_airframe(quantity: Quantity, fault: SensorFault) -> bool {
    let is_velocity = matches!(quantity, Quantity::VelocityRight | Quantity::VelocityForward);
    is_velocity && matches!(fault, SensorFault::Gain(gain) if gain < 1.0)
}

/// Every quantity with every fault, one at a time; then all sensors frozen, with the drone's clock running
/// and without.
pub fn failures() -> Vec<Failure> {
    let mut failures = Vec::new();
    for quantity in Quantity::ALL {
        for (name, fault) in faults(quantity) {
            let name = format!("{} {name}", name_of(quantity));
            failures.push(Failure { name, faults: vec![(quantity, fault)] });
        }
    }
    for (name, quantities, deviations) in NOISE {
        for deviation in deviations {
            let faults = quantities.iter().map(|q| (*q, SensorFault::Noise(deviation))).collect();
            failures.push(Failure { name: format!("{name} noise {deviation}"), faults });
        }
    }
    for (name, quantities, _) in NOISE {
        for gain in GAINS {
            let faults = quantities.iter().map(|q| (*q, SensorFault::Gain(gain))).collect();
            failures.push(Failure { name: format!("{name} gain {gain}"), faults });
        }
    }
    let frozen = |quantities: &[Quantity]| {
        quantities.iter().map(|quantity| (*quantity, SensorFault::Stuck)).collect()
    };
    failures.push(Failure { name: "all frozen".to_owned(), faults: frozen(&Quantity::SENSED) });
    let name = "all frozen, clock too".to_owned();
    failures.push(Failure { name, faults: frozen(&Quantity::ALL) });
    failures
}

fn name_of(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::VelocityRight => "velocity right",
        Quantity::VelocityForward => "velocity forward",
        Quantity::Altitude => "altitude",
        Quantity::Yaw => "yaw",
        Quantity::Roll => "roll",
        Quantity::Pitch => "pitch",
        Quantity::Clock => "clock",
    }
}

fn faults(quantity: Quantity) -> Vec<(&'static str, SensorFault)> {
    let (jump, ramp) = match quantity {
        Quantity::VelocityRight | Quantity::VelocityForward | Quantity::Altitude => (0.8, 0.2),
        Quantity::Yaw => (60.0, 10.0),
        Quantity::Roll | Quantity::Pitch => (10.0, 3.0),
        Quantity::Clock => (10.0, 0.5),
    };
    let mut faults = vec![("stuck", SensorFault::Stuck)];
    if quantity != Quantity::Clock {
        faults.push(("stuck at 0", SensorFault::StuckAt(0.0)));
        faults.push(("dead at 0", SensorFault::DeadAt(0.0)));
    }
    faults.push(("jump up", SensorFault::Offset(jump)));
    faults.push(("jump down", SensorFault::Offset(-jump)));
    faults.push(("ramp up", SensorFault::Ramp(ramp)));
    faults.push(("ramp down", SensorFault::Ramp(-ramp)));
    if quantity.is_float() {
        faults.push(("not a number", SensorFault::NotANumber));
    }
    faults.push(("late", SensorFault::Late(Duration::from_millis(500))));
    faults
}

/// How far a drone was led astray.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Excursion {
    /// Largest distance outside the fence, corrected by the error of healthy sensors.
    pub outside_m: f64,
    /// Largest distance from its target or from the way to it, horizontally or upwards.
    pub away_m: f64,
    /// Time of floor contact while it was to fly.
    pub scraping: Duration,
    /// Whether it was still in the air at the end.
    pub airborne: bool,
}

impl Excursion {
    /// Whether it is too far, given that the drone's own hover and landing alone lead to `own`.
    pub fn is_too_far(&self, own: &Self) -> bool {
        self.outside_m > MOST_OUTSIDE_M
            || self.away_m > MOST_AWAY_M.max(own.away_m + OWN_MARGIN_M)
            || self.scraping > MOST_SCRAPING
            || self.airborne
    }

    fn see(&mut self, truth: &Truth, between: [Vector3<f64>; 2]) {
        // The error of healthy sensors cannot be known in flight.
        let place_m = place_in_navdata_frame(truth);
        let across_m = FENCE.border.outside_m(place_m.xy());
        self.outside_m = self.outside_m.max(across_m).max(place_m.z - FENCE.ceiling_m);
        let [from, to] = between;
        let nearest = nearest_on_way(place_m.xy(), from.xy(), to.xy());
        let above_m = (place_m.z - from.z.max(to.z)).max(0.0);
        self.away_m = self.away_m.max((place_m.xy() - nearest).norm().hypot(above_m));
        if truth.phase == Phase::Flying && truth.position_m.z <= 0.0 {
            self.scraping += TICK;
        }
    }
}

fn nearest_on_way(place: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> Vector2<f64> {
    let way = to - from;
    let length = way.norm_squared();
    let share = if length > 0.0 { (place - from).dot(&way) / length } else { 0.0 };
    from + way * share.clamp(0.0, 1.0)
}

/// A flight with a failure.
#[derive(Debug, Clone, PartialEq)]
pub struct Flown {
    /// How far the failure led the drone astray.
    pub excursion: Excursion,
    /// Time from the failure until the drone was let hover or land before its plan had ended; `None` if nobody noticed.
    pub reaction: Option<Duration>,
    /// The pilot's account of it.
    pub outcome: Outcome,
}

/// Sees when a failure is answered.
#[derive(Debug, Clone, Copy, Default)]
struct Answer {
    at: Option<Duration>,
    /// The plan has come to its own landing.
    is_over: bool,
}

impl Answer {
    fn see(&mut self, moment: &Moment) {
        let step = moment.status.step;
        self.is_over |= step.is_some_and(|step| step > STEP);
        let answers = match moment.truth.phase {
            // While it takes off it hovers by itself.
            Phase::Flying => {
                moment.truth.motion == Motion::Hover && step.is_none_or(|step| step > TAKE_OFF)
            }
            Phase::Landing => true,
            _ => false,
        };
        if answers && !self.is_over {
            self.at.get_or_insert(moment.now);
        }
    }
}

/// Flies with a failure that begins at a time.
fn flown(
    faulty: &Simulation,
    plan: Plan,
    at: Duration,
    between: [Vector3<f64>; 2],
) -> Result<Flown, SimulationError> {
    let (mut excursion, mut answer) = (Excursion::default(), Answer::default());
    let flight = faulty.fly_watched(plan, |moment| {
        if moment.now >= at {
            excursion.see(&moment.truth, between);
            answer.see(moment);
        }
    })?;
    excursion.airborne = !matches!(flight.final_truth.phase, Phase::Landed | Phase::Emergency);
    let reaction = answer.at.map(|answered| answered.saturating_sub(at));
    Ok(Flown { excursion, reaction, outcome: flight.outcome })
}

/// Flights that are identical up to the fault.
#[derive(Debug, Clone, PartialEq)]
pub struct Siblings {
    /// Time of the fault.
    pub at: Duration,
    /// The drone's own hover for two seconds, then its own landing: the best that can be achieved.
    pub own: Excursion,
    /// With each of the failures, in their order.
    pub flown: Vec<Flown>,
}

/// Flies every situation with each failure, and returns descriptions of detectable failures that led the
/// drone too far.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
///
/// # Panics
/// If a healthy flight ends before the sensor could fail.
pub fn led_astray(airframe: Model, seed: u64) -> Result<Vec<String>, SimulationError> {
    let Model { name, profile } = airframe;
    let failures = failures();
    let mut found = Vec::new();
    for situation in Situation::ALL {
        let siblings = fly(profile(), situation, seed, &failures)?
            .unwrap_or_else(|| panic!("{name} {situation}, seed {seed}: never came so far"));
        for (failure, Flown { excursion, .. }) in failures.iter().zip(&siblings.flown) {
            if failure.shows() && excursion.is_too_far(&siblings.own) {
                found.push(format!("{name} {situation} {seed}: {}: {excursion:?}", failure.name));
            }
        }
    }
    Ok(found)
}

/// Flies a situation with each of the failures; `None` if the healthy drone is landed before a sensor could fail, which
/// says nothing of failures.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
pub fn fly(
    profile: Profile,
    situation: Situation,
    seed: u64,
    failures: &[Failure],
) -> Result<Option<Siblings>, SimulationError> {
    let (plan, between) = situation.plan();
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x7365_6e73);
    let healthy = simulation(profile, situation, seed, &mut random);
    let Some(began) = healthy.fly(plan.clone())?.start_of_step(STEP) else { return Ok(None) };
    let into = match situation {
        Situation::Holding => random.random_range(3.0..6.0),
        _ => random.random_range(0.2..1.5),
    };
    let at = began + Duration::from_secs_f64(into);
    let own = own_hover_and_landing(&healthy, &plan, at, between)?;
    let flown = failures.iter().map(|failure| {
        let mut scenario = Scenario::default();
        for (quantity, fault) in &failure.faults {
            let action = Action::Sensor(*quantity, *fault, FOR_EVER);
            scenario = scenario.and(When::SinceStart(at), action);
        }
        let mut faulty = healthy.clone();
        faulty.world.scenario = scenario;
        flown(&faulty, plan.clone(), at, between)
    });
    let flown = flown.collect::<Result<_, SimulationError>>()?;
    Ok(Some(Siblings { at, own, flown }))
}

/// How far the drone goes by itself, if it is ordered to hover at a time and to land two seconds later.
fn own_hover_and_landing(
    healthy: &Simulation,
    plan: &Plan,
    at: Duration,
    between: [Vector3<f64>; 2],
) -> Result<Excursion, SimulationError> {
    let mut own = Excursion::default();
    healthy.fly_in_world(plan.clone(), |moment, world| {
        if moment.now >= at && moment.now < at + TICK {
            alone::flies_on_and_lands(world.drone(), Duration::ZERO, |truth| {
                own.see(truth, between);
            });
        }
    })?;
    Ok(own)
}

fn simulation(
    profile: Profile,
    situation: Situation,
    seed: u64,
    random: &mut ChaCha8Rng,
) -> Simulation {
    let wind_m_s = if situation == Situation::Holding {
        let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
        Vector2::new(sin, cos) * 0.5
    } else {
        Vector2::zeros()
    };
    // Good days and bad ones by turns.
    let sensors = if seed.is_multiple_of(2) { SensorModel::hard() } else { SensorModel::nominal() };
    let drone = DroneConfig { profile, seed, wind_m_s, sensors, ..DroneConfig::default() };
    Simulation {
        world: WorldConfig { drone, ..WorldConfig::default() },
        pilot: VehicleConfig { limits: FENCE, ..VehicleConfig::default() },
        aftermath: AFTERMATH,
        ..Simulation::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reaction_is_one_to_the_failure_and_not_the_end_of_the_plan() {
        let none = Failure { name: String::new(), faults: Vec::new() };
        let stuck = vec![(Quantity::VelocityRight, SensorFault::Stuck)];
        let stuck = Failure { name: String::new(), faults: stuck };
        for situation in Situation::ALL {
            let siblings =
                fly(Profile::rec(), situation, 1, &[none.clone(), stuck.clone()]).unwrap().unwrap();
            let [healthy, stuck] = siblings.flown.try_into().unwrap();
            assert_eq!((healthy.reaction, healthy.outcome), (None, Outcome::Completed));
            let reaction_s = stuck.reaction.map(|reaction| reaction.as_secs_f64());
            assert!(
                reaction_s.is_some_and(|reaction_s| (0.2..1.0).contains(&reaction_s)),
                "{situation}: {reaction_s:?}"
            );
        }
    }
}
