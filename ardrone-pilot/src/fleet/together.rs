//! A fleet flown on simulated drones, in simulated time: whether those that fly alone as planned can fly so together.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::plan::Plan;
use autopilot::separation::Neighbour;
use autopilot::vehicle::{CannotFly, Input, Telemetry, Vehicle};
use kinematics::Pose;
use nalgebra::Vector2;

use super::members::{Fleet, Member};
use crate::drive::{self, Driver, POLL, Passed, Simulated};
use crate::simulation::{self, SimulatedFlight};

/// Longest simulated time; no battery lasts that long.
const LONGEST: Duration = Duration::from_mins(20);
/// Interval of the places.
const TRACK: Duration = Duration::from_millis(100);

/// A fleet's simulated flights: each alone, and all together.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedFleet {
    /// In the order of the fleet, without those that have no plan.
    pub members: Vec<SimulatedMember>,
    /// Each two, how near they come to each other in the air.
    pub meetings: Vec<Meeting>,
}

/// A vehicle's simulated flights.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedMember {
    /// Its place in the fleet.
    pub number: usize,
    /// Its flight if it were alone.
    pub alone: SimulatedFlight,
    /// How its flight with the others ended; `None` if it did not within 20 minutes.
    pub outcome: Option<Outcome>,
    /// Time in the air with the others.
    pub duration: Duration,
    /// Where it truly was in the air with the others, ten times a second.
    pub track_m: Vec<Vector2<f64>>,
}

/// How near two vehicles come to each other, across.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Their places in the fleet.
    pub who: [usize; 2],
    /// If each flew as if it were alone.
    pub alone_m: f64,
    /// When that would be, since their take-off.
    pub at: Duration,
    /// As they are kept apart.
    pub together_m: f64,
}

struct Flying {
    number: usize,
    /// Nothing of one that has no plan: it stands there, and is heard.
    alone: Option<SimulatedFlight>,
    system: u8,
    driver: Driver<Simulated>,
    outcome: Option<Outcome>,
    /// Where it was in each tenth of a second: nowhere on the ground.
    places_m: Vec<Option<Vector2<f64>>>,
}

impl Flying {
    fn begin(number: usize, member: &Member) -> Result<Self, CannotFly> {
        let (Member { config, plan, .. }, world) = (member, member.world());
        let fly = |plan: &Plan| simulation::fly(plan.clone(), config, &world);
        let vehicle = match plan {
            Some(plan) => Vehicle::flying(plan.clone(), config)?,
            None => Vehicle::new(config).map_err(CannotFly::from)?,
        };
        Ok(Self {
            number,
            alone: plan.as_ref().map(fly).transpose()?,
            system: config.system,
            driver: Driver::new(vehicle, &world),
            outcome: None,
            places_m: Vec::new(),
        })
    }

    fn goes_on(&self) -> bool {
        self.alone.is_some() && self.outcome.is_none()
    }

    /// What it tells the others in a tick.
    fn step(&mut self, now: Duration) -> Option<Neighbour> {
        let outcome = &mut self.outcome;
        let ticked = self.driver.step(|_, passed| {
            if let Passed::Told(Telemetry::Ended(ended, _)) = passed {
                *outcome = Some(ended);
            }
        });
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
/// [`CannotFly`] if a plan or the limits are refused.
pub fn fly(fleet: &Fleet) -> Result<SimulatedFleet, CannotFly> {
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
    let Flying { number, alone, outcome, places_m, .. } = flying;
    let track_m: Vec<_> = places_m.into_iter().flatten().collect();
    let duration = TRACK * u32::try_from(track_m.len()).unwrap_or(u32::MAX);
    Some(SimulatedMember { number, alone: alone?, outcome, duration, track_m })
}

/// `None` of two that would never be in the air at the same time.
fn meeting(flying: [&Flying; 2]) -> Option<Meeting> {
    let place_m = |(_, pose): &(Duration, Pose)| Vector2::new(pose.x_m, pose.y_m);
    let [a, b] = flying.map(|one| Some(one.alone.as_ref()?.track.iter()));
    let apart = a?.zip(b?).map(|(a, b)| ((place_m(a) - place_m(b)).norm(), a.0));
    let (alone_m, at) = apart.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let [a, b] = flying.map(|one| one.places_m.iter());
    let both = a.zip(b).filter_map(|(a, b)| Some(((*a)? - (*b)?).norm()));
    let together_m = both.fold(f64::INFINITY, f64::min);
    Some(Meeting { who: flying.map(|one| one.number), alone_m, at, together_m })
}
