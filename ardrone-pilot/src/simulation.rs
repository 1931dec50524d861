//! A plan flown by the vehicle on a simulated drone, in simulated time: what to expect before it is flown.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::plan::Plan;
use autopilot::vehicle::{
    CannotFly, Decision, FlightEvent, Phase, TagConfig, Telemetry, Vehicle, VehicleConfig,
};
use kinematics::Pose;
use mock_drone::{FloorTag, Standing, WorldConfig};

use crate::drive::{Driver, Passed};

/// Longest simulated time; no battery lasts that long.
const LONGEST: Duration = Duration::from_mins(20);
/// Interval of the places of the track.
const TRACK: Duration = Duration::from_millis(100);

/// A simulated flight.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedFlight {
    /// How it ended; `None` if it did not within 20 minutes.
    pub outcome: Option<Outcome>,
    /// Index of the last step that was begun, counted from 0; `None` if none was.
    pub step: Option<usize>,
    /// Time in the air.
    pub duration: Duration,
    /// The charge that it took, as measured by voltage.
    pub battery_percent: f64,
    /// The true place of the drone every tenth of a second since the vehicle perceived that it left the ground, with
    /// this time.
    pub track: Vec<(Duration, Pose)>,
    /// What the vehicle warned of, with this time.
    pub warnings: Vec<(Duration, FlightEvent)>,
}

/// A world that begins where the drone stands in the common frame, with the tags of the settings and of a plan, or with one
/// below the start if there are none; without any if tags are not in use.
pub fn world(config: &VehicleConfig, plan: Option<&Plan>) -> WorldConfig {
    let start = config.estimator.start.unwrap_or_default();
    let standing = Standing { place_m: start.place_m, heading_deg: start.heading_deg };
    let mut world = WorldConfig { start: standing, ..WorldConfig::default() };
    let Some(TagConfig { surveyed, .. }) = &config.estimator.tags else { return world };
    for tag in surveyed.iter().flatten().chain(plan.iter().flat_map(|plan| plan.tags())) {
        let heading_deg = tag.heading_deg.unwrap_or(0.0) - start.heading_deg;
        let [x_m, y_m] = start.seen_from_here(tag.place_m).into();
        world.tags.push(FloorTag::new(x_m, y_m, heading_deg));
    }
    if world.tags.is_empty() {
        world.tags.push(FloorTag::new(0.0, 0.0, 0.0));
    }
    world
}

/// Flies a plan as if there were no other vehicles; a few thousand times faster than real time.
///
/// # Errors
/// [`CannotFly`] if the plan or the limits are refused.
pub fn fly(
    plan: Plan,
    config: &VehicleConfig,
    world: &WorldConfig,
) -> Result<SimulatedFlight, CannotFly> {
    // Nobody else is there.
    let config = VehicleConfig { peers: Vec::new(), ..config.clone() };
    let mut driver = Driver::new(Vehicle::flying(plan, &config)?, world);
    let start = config.estimator.start.unwrap_or_default();
    let charged = driver.world().truth().battery_percent;
    let (mut outcome, mut warnings, mut track) = (None, Vec::new(), Vec::new());
    let mut begun = None;
    let mut lifted: Option<Duration> = None;
    let mut landed = Duration::ZERO;
    while outcome.is_none() && driver.now() < LONGEST {
        let now = driver.now();
        let since = now.saturating_sub(lifted.unwrap_or(now));
        driver.step(|_, passed| match passed {
            Passed::Told(Telemetry::Ended(ended, _)) => outcome = Some(ended),
            Passed::Told(Telemetry::Event(FlightEvent::StepStarted { step })) => begun = Some(step),
            Passed::Told(Telemetry::Event(event)) if event.warns() => warnings.push((since, event)),
            _ => {}
        });
        let truth = driver.world().truth();
        if driver.vehicle.decision().is_some_and(is_in_the_air) {
            lifted.get_or_insert(now);
            landed = now;
            if since >= TRACK * u32::try_from(track.len()).unwrap_or(u32::MAX) {
                let [x_m, y_m] = start.in_world(truth.position_m.xy()).into();
                let yaw_deg = truth.yaw_deg + start.heading_deg;
                track.push((since, Pose { x_m, y_m, z_m: truth.position_m.z, yaw_deg }));
            }
        }
        driver.pass();
    }
    let duration = landed.saturating_sub(lifted.unwrap_or(landed));
    let battery_percent = charged - driver.world().truth().battery_percent;
    Ok(SimulatedFlight { outcome, step: begun, duration, battery_percent, track, warnings })
}

/// As the vehicle perceived it: a recorded flight begins and ends by the same sign.
pub(crate) fn is_in_the_air(decision: &Decision) -> bool {
    matches!(decision.phase, Phase::Flying | Phase::Landing) && !decision.percepts.on_ground
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flown(text: &str) -> SimulatedFlight {
        let plan = Plan::parse("plan", text).unwrap();
        fly(plan, &VehicleConfig::default(), &WorldConfig::default()).unwrap()
    }

    #[test]
    fn a_plan_is_flown_to_its_end() {
        let flight = flown("takeoff\ngoto 1 0 0 0\nland\n");
        assert_eq!(flight.outcome, Some(Outcome::Completed));
        let furthest = flight.track.iter().map(|(_, pose)| pose.x_m).fold(0.0, f64::max);
        assert!((0.9..1.2).contains(&furthest), "{furthest}");
        let seconds = flight.duration.as_secs_f64();
        assert!((5.0..30.0).contains(&seconds), "{seconds}");
        assert!((0.2..10.0).contains(&flight.battery_percent), "{}", flight.battery_percent);
        assert_eq!(flight.warnings, []);
        assert_eq!(flown("takeoff\ngoto 1 0 0 0\nland\n"), flight);
    }

    #[test]
    fn a_plan_for_which_no_battery_lasts_is_refused_as_it_would_be() {
        let flight =
            flown("takeoff\nsetStayTime 600\ngoto 0 0 0 0\ngoto 0 1 0 0\ngoto 0 0 0 0\nland\n");
        let refused = matches!(flight.outcome, Some(Outcome::PreflightRefused { .. }));
        assert!(refused, "{:?}", flight.outcome);
        assert_eq!((flight.duration, flight.track), (Duration::ZERO, vec![]));
    }
}
