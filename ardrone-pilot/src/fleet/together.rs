//! A fleet flown on simulated drones, in simulated time: whether those that fly alone as planned can fly so together.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::plan::Plan;
use autopilot::separation::Neighbour;
use autopilot::vehicle::{CannotFly, Input, Telemetry, Vehicle};
use kinematics::Pose;
use nalgebra::Vector2;

use mission_agent::Said;

use super::members::{Fleet, FleetError, Member};
use crate::drive::{self, Driver, POLL, Passed, Simulated};
use crate::simulation::{self, SimulatedFlight};

/// Longest simulated time; no battery lasts that long.
const LONGEST: Duration = Duration::from_mins(20);
/// Interval of the places.
const TRACK: Duration = Duration::from_millis(100);

/// A fleet's simulated flights: each alone, and all together.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedFleet {
    /// In the order of the fleet, without those that fly nothing by themselves.
    pub members: Vec<SimulatedMember>,
    /// Each two, how near they come to each other in the air.
    pub meetings: Vec<Meeting>,
}

/// A vehicle's simulated flights.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedMember {
    /// Its place in the fleet.
    pub number: usize,
    /// Its flight if it were alone; `None` for one with an agent, which is alone with nobody to talk to.
    pub alone: Option<SimulatedFlight>,
    /// How its flight with the others ended; `None` if it did not within 20 minutes.
    pub outcome: Option<Outcome>,
    /// Time in the air with the others.
    pub duration: Duration,
    /// Where it truly was in the air with the others, ten times a second.
    pub track_m: Vec<Vector2<f64>>,
    /// What its agent said to others, and when.
    pub said: Vec<(Duration, Said)>,
}

/// How near two vehicles come to each other, across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Their places in the fleet.
    pub who: [usize; 2],
    /// The least distance in metres if each flew as if it were alone, and when that would be since their take-off; `None` unless
    /// both fly plans.
    pub alone: Option<(f64, Duration)>,
    /// The least distance while both are in the air and kept apart; infinite if they never are at the same time.
    pub together_m: f64,
}

struct Flying {
    number: usize,
    /// It flies something by itself; who does not stands there, and is heard.
    has_a_mission: bool,
    /// Of one that has a plan.
    alone: Option<SimulatedFlight>,
    system: u8,
    driver: Driver<Simulated>,
    outcome: Option<Outcome>,
    said: Vec<(Duration, Said)>,
    /// Where it was in each tenth of a second: nowhere on the ground.
    places_m: Vec<Option<Vector2<f64>>>,
}

impl Flying {
    fn begin(number: usize, member: &Member) -> Result<Self, FleetError> {
        let (Member { config, plan, .. }, world) = (member, member.world());
        let fly = |plan: &Plan| simulation::fly(plan.clone(), config, &world);
        let vehicle = match plan {
            Some(plan) => Vehicle::flying(plan.clone(), config)?,
            None => Vehicle::new(config).map_err(CannotFly::from)?,
        };
        let mut driver = Driver::new(vehicle, &world);
        driver.agent = member.new_agent()?;
        Ok(Self {
            number,
            has_a_mission: member.has_a_mission(),
            alone: plan.as_ref().map(fly).transpose()?,
            system: config.system,
            driver,
            outcome: None,
            said: Vec::new(),
            places_m: Vec::new(),
        })
    }

    fn goes_on(&self) -> bool {
        self.has_a_mission && self.outcome.is_none()
    }

    /// What it tells the others in a tick.
    fn step(&mut self, now: Duration) -> Option<Neighbour> {
        let (mut ended, mut said) = (None, Vec::new());
        let ticked = self.driver.step(|at, passed| match passed {
            Passed::Told(Telemetry::Ended(outcome, _)) => ended = Some(outcome),
            Passed::Said(line) => said.push((at, line)),
            _ => {}
        });
        self.said.append(&mut said);
        match &self.driver.agent {
            None => self.outcome = self.outcome.take().or(ended),
            Some(agent) if agent.is_over(&self.driver.vehicle) => {
                let flown = self.driver.vehicle.outcome().cloned();
                self.outcome.get_or_insert(flown.unwrap_or(Outcome::Completed));
            }
            Some(_) => {}
        }
        if now >= TRACK * u32::try_from(self.places_m.len()).unwrap_or(u32::MAX) {
            let is_up = self.driver.vehicle.decision().is_some_and(simulation::is_in_the_air);
            self.places_m.push(is_up.then(|| self.driver.world().presence().position_m.xy()));
        }
        let told = ticked.then(|| self.driver.vehicle.as_neighbour(now)).flatten();
        self.driver.pass();
        told
    }
}

/// Flies the plans of a fleet; many times faster than real time.
///
/// # Errors
/// [`FleetError`] if a plan, the limits or an agent are refused.
pub fn fly(fleet: &Fleet) -> Result<SimulatedFleet, FleetError> {
    let members = fleet.members.iter().enumerate();
    let begun = members.map(|(number, member)| Flying::begin(number, member));
    let flying = fly_together(begun.collect::<Result<_, _>>()?);
    let mut meetings = Vec::new();
    for (number, one) in flying.iter().enumerate() {
        meetings.extend(flying.iter().skip(number + 1).filter_map(|other| meeting([one, other])));
    }
    Ok(SimulatedFleet { members: flying.into_iter().filter_map(simulated).collect(), meetings })
}

/// Flies all in one air until each has ended.
fn fly_together(mut flying: Vec<Flying>) -> Vec<Flying> {
    let mut now = Duration::ZERO;
    while now < LONGEST && flying.iter().any(Flying::goes_on) {
        drive::share_air(flying.iter_mut().map(|one| &mut one.driver));
        drive::deliver(flying.iter_mut().map(|one| &mut one.driver));
        let told: Vec<Neighbour> = flying.iter_mut().filter_map(|one| one.step(now)).collect();
        for one in &mut flying {
            for neighbour in told.iter().filter(|told| told.system != one.system) {
                // What is not believed is avoided as one that is not heard.
                _ = one.driver.handle(Input::Neighbour(*neighbour), |_, _| {});
            }
        }
        now += POLL;
    }
    flying
}

fn simulated(flying: Flying) -> Option<SimulatedMember> {
    let Flying { number, has_a_mission, alone, outcome, places_m, said, .. } = flying;
    let track_m: Vec<_> = places_m.into_iter().flatten().collect();
    let duration = TRACK * u32::try_from(track_m.len()).unwrap_or(u32::MAX);
    has_a_mission.then_some(SimulatedMember { number, alone, outcome, duration, track_m, said })
}

/// `None` of two that would never be in the air at the same time.
fn meeting(flying: [&Flying; 2]) -> Option<Meeting> {
    let place_m = |(_, pose): &(Duration, Pose)| Vector2::new(pose.x_m, pose.y_m);
    let alone = match flying.map(|one| one.alone.as_ref()) {
        [Some(a), Some(b)] => {
            let both = a.track.iter().zip(&b.track);
            let apart = both.map(|(a, b)| ((place_m(a) - place_m(b)).norm(), a.0));
            Some(apart.min_by(|a, b| a.0.total_cmp(&b.0))?)
        }
        _ => None,
    };
    let [a, b] = flying.map(|one| one.places_m.iter());
    let both = a.zip(b).filter_map(|(a, b)| Some(((*a)? - (*b)?).norm()));
    let together_m = both.fold(f64::INFINITY, f64::min);
    Some(Meeting { who: flying.map(|one| one.number), alone, together_m })
}
