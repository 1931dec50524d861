//! Rules of the estimator.

use std::time::Duration;

use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::TagConfig;
use mock_drone::airframe::Profile;
use mock_drone::scenario::{Action, Direction, Scenario, When};
use mock_drone::{CameraModel, FloorTag, Quantity, SensorFault};
use nalgebra::Vector2;

use crate::airframes::{AIRFRAMES, Model};
use crate::plan;
use crate::sensors::MOST_OUTSIDE_M;
use crate::sim::SimulationError;
use crate::trial::{FENCE, FOR_EVER, HOLD, HOLDS_AT, Must, Trial};

/// A turn before a long flight, which shows whether the world has turned with the drone.
const TURN: &str = "takeoff\ngoto 0 3 0.5 0\ngoto 0 3 0.5 175\ngoto 0 -3 0.5 175\nland\n";

/// An altitude that drifts too slowly to be noticed leads the drone down, and is right again near the floor: that
/// looks like another floor. From then on the drone must not stay there.
pub(super) fn led_to_the_floor() -> Vec<Trial> {
    const DRIFT_M_S: f64 = 0.045;
    const LOW_M: f64 = 0.1;
    const MOST: Duration = Duration::from_secs(2);
    const LOW: &str = "takeoff\ngoto 0 0 0 0\nsetStayTime 60\ngoto 0 0 0 0\nland\n";
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for drifts in [17, 18].map(Duration::from_secs) {
            let drift = Action::Sensor(Quantity::Altitude, SensorFault::Ramp(DRIFT_M_S), drifts);
            let scenario = Scenario::default().and(When::SinceStart(HOLDS_AT), drift);
            let what = format!("{name} led to the floor for {drifts:?}");
            let trial = Trial::new(what, LOW, profile, scenario);
            trials.push(trial.and(Must::BeUp { at: HOLDS_AT + drifts }).and(Must::stay_above(
                LOW_M,
                HOLDS_AT + drifts,
                MOST,
            )));
        }
    }
    trials
}

/// A velocity that is no number for most of the time, but comes back again and again.
pub(super) fn wrong_in_pulses() -> Vec<Trial> {
    const PULSES: u32 = 30;
    const LANDS_WITHIN: Duration = Duration::from_secs(15);
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for (wrong_ms, right_ms) in [(500, 300), (600, 400), (1000, 300), (1000, 500)] {
            let wrong = Duration::from_millis(wrong_ms);
            let every = wrong + Duration::from_millis(right_ms);
            let pulse = Action::Sensor(Quantity::VelocityForward, SensorFault::NotANumber, wrong);
            let scenario = (0..PULSES).fold(Scenario::default(), |scenario, pulses| {
                scenario.and(When::SinceStart(HOLDS_AT + every * pulses), pulse)
            });
            let what = format!("{name} without velocity for {wrong_ms} ms in {every:?}");
            let trial = Trial::new(what, HOLD, profile, scenario)
                .and(Must::StayNear { m: MOST_OUTSIDE_M, by_sensors: true })
                .and(Must::BeDown { by: HOLDS_AT + LANDS_WITHIN });
            trials.push(trial);
        }
    }
    trials
}

/// A velocity that becomes wrong in steps too small to be noticed, and right again at once: it is the right velocity
/// that is rejected then, and the place must become uncertain by what is flown meanwhile.
pub(super) fn right_again() -> Vec<Trial> {
    const STEP_M_S: f64 = 0.4;
    const EVERY: Duration = Duration::from_secs(1);
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for steps in [3, 4] {
            let right_at = HOLDS_AT + EVERY * steps;
            let scenario = (0..steps).fold(Scenario::default(), |scenario, step| {
                let more = SensorFault::Offset(STEP_M_S);
                let lasts = EVERY * (steps - step);
                let action = Action::Sensor(Quantity::VelocityForward, more, lasts);
                scenario.and(When::SinceStart(HOLDS_AT + EVERY * step), action)
            });
            let what = format!("{name} with a velocity right again after {steps} steps");
            let trial = Trial::new(what, HOLD, profile, scenario);
            trials.push(trial.and(Must::be_honest(right_at)));
        }
    }
    trials
}

/// Each picture of a bad camera has a false detection besides the tag below the drone.
pub(super) fn false_sights() -> Vec<Trial> {
    /// As far as a tag keeps a drone on a bad day.
    const KEPT_M: f64 = 0.4;
    let mut trials = Vec::new();
    for seed in 1..=6 {
        for height_m in [-0.15, 0.0] {
            let text = format!(
                "takeoff\ngoto 0 0 {height_m} 0\nsetStayTime 40\ngoto 0 0 {height_m} 0\nland\n"
            );
            let what = format!("false sights, seed {seed}, {height_m} m");
            let mut trial = Trial::new(what, &text, Profile::rec, Scenario::default())
                .and(Must::StayNear { m: KEPT_M, by_sensors: false });
            let world = &mut trial.simulation.world;
            world.drone.seed = seed;
            world.drone.camera = CameraModel { false_sights: 1.0, ..CameraModel::hard() };
            world.tags = vec![FloorTag::new(0.0, 0.0, 120.0)];
            trial.simulation.pilot.estimator.tags = Some(TagConfig::default());
            trials.push(trial);
        }
    }
    trials
}

/// A velocity that is wrong from the end of a gap on: what a gap allows for must not let it in.
pub(super) fn wrong_after_a_gap() -> Vec<Trial> {
    const WRONG_M_S: f64 = 1.1;
    const LANDS_WITHIN: Duration = Duration::from_secs(15);
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for gap in [70, 300, 600, 1200].map(Duration::from_millis) {
            let nan = Action::Sensor(Quantity::VelocityRight, SensorFault::NotANumber, gap);
            for (what, unseen) in
                [("an outage", Action::Outage(Direction::Down, gap)), ("a fault", nan)]
            {
                let wrong = SensorFault::Offset(WRONG_M_S);
                let wrong = Action::Sensor(Quantity::VelocityRight, wrong, FOR_EVER);
                let scenario = Scenario::default()
                    .and(When::SinceStart(HOLDS_AT), unseen)
                    .and(When::SinceStart(HOLDS_AT + gap), wrong);
                let what = format!("{name} with a wrong velocity after {what} of {gap:?}");
                let trial = Trial::new(what, HOLD, profile, scenario)
                    .and(Must::StayNear { m: MOST_OUTSIDE_M, by_sensors: true })
                    .and(Must::BeDown { by: HOLDS_AT + LANDS_WITHIN });
                trials.push(trial);
            }
        }
    }
    trials
}

/// The same while the drone moves or turns. While only the velocity is missing, the drone hears its orders, and what
/// they explain is known: in an outage it is not, so that an error must be larger there.
pub(super) fn wrong_after_a_gap_in_motion() -> Vec<Trial> {
    const MOVE: &str =
        "takeoff\ngoto 0 -2 0.5 0\ngoto 0 2 0.5 0\nsetStayTime 20\ngoto 0 2 0.5 0\nland\n";
    const TURN_AND_HOLD: &str =
        "takeoff\ngoto 0 0 0.5 0\ngoto 0 0 0.5 175\nsetStayTime 20\ngoto 0 0 0.5 175\nland\n";
    let gap = Duration::from_millis(380);
    let flights = [(MOVE, 10_300, 1.2), (MOVE, 11_000, 1.5), (TURN_AND_HOLD, 9_500, 1.2)];
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for (plan, at_ms, wrong_m_s) in flights {
            for quantity in [Quantity::VelocityForward, Quantity::VelocityRight] {
                let at = Duration::from_millis(at_ms);
                let nan = Action::Sensor(quantity, SensorFault::NotANumber, gap);
                let wrong = Action::Sensor(quantity, SensorFault::Offset(wrong_m_s), FOR_EVER);
                let scenario = Scenario::default()
                    .and(When::SinceStart(at), nan)
                    .and(When::SinceStart(at + gap), wrong);
                let what = format!("{name}, {quantity:?} missing at {at:?}, then wrong");
                let m = FENCE.border.furthest_m() + MOST_OUTSIDE_M;
                let trial = Trial::new(what, plan, profile, scenario);
                trials.push(trial.and(Must::StayNear { m, by_sensors: true }));
            }
        }
    }
    trials
}

/// Turns in a steady wind, against which the drone leans: the tilt goes round the body, and the velocity stays zero. That
/// is no reason to distrust it.
pub(super) fn turns_in_the_wind() -> Vec<Trial> {
    const TURNS: &str = "takeoff\ngoto 0 0 0.5 0\nsetStayTime 2\ngoto 0 0 0.5 175\ngoto 0 0 0.5 0\n\
                         goto 0 0 0.5 175\nsetStayTime 60\ngoto 0 0 0.5 175\nland\n";
    /// A flight that is given up in a turn is down by then.
    const TURNED_AT: Duration = Duration::from_secs(32);
    let winds_m_s = [1.0, 1.0, 0.6, 0.4];
    let mut trials = Vec::new();
    for (Model { name, profile }, wind_m_s) in AIRFRAMES.into_iter().zip(winds_m_s) {
        for seed in 1..=3 {
            let what = format!("{name} turning in a wind of {wind_m_s} m/s, seed {seed}");
            let mut trial = Trial::new(what, TURNS, profile, Scenario::default())
                .and(Must::BeUp { at: TURNED_AT });
            trial.simulation.world.drone.seed = seed;
            trial.simulation.world.drone.wind_m_s = Vector2::new(wind_m_s, 0.0);
            trials.push(trial);
        }
    }
    trials
}

/// A compass that makes a step in a turn, at once or after it has shown nothing for a while: the world must not turn with
/// it, which shows when the drone flies on.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
///
/// # Panics
/// If the undisturbed drone does not turn: nothing would be tried then.
pub(super) fn steps_in_a_turn() -> Result<Vec<Trial>, SimulationError> {
    /// At once, and after a heading that is no number.
    const STEPS: [(u64, f64); 5] = [(0, 18.0), (0, -18.0), (300, 30.0), (300, 60.0), (300, -60.0)];
    const INTO: [Duration; 2] = [Duration::from_millis(600), Duration::from_secs(1)];
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        let begun = turn_begins(name, profile)?;
        for (into, (missing_ms, deg)) in INTO.into_iter().flat_map(|into| STEPS.map(|s| (into, s)))
        {
            let (at, missing) = (begun + into, Duration::from_millis(missing_ms));
            let nan = Action::Sensor(Quantity::Yaw, SensorFault::NotANumber, missing);
            let step = Action::Sensor(Quantity::Yaw, SensorFault::Offset(deg), FOR_EVER);
            let scenario = Scenario::default();
            let scenario =
                if missing_ms > 0 { scenario.and(When::SinceStart(at), nan) } else { scenario };
            let scenario = scenario.and(When::SinceStart(at + missing), step);
            let what = format!("{name}, a step of {deg} after {missing:?} {into:?} into a turn");
            let mut trial = Trial::new(what, TURN, profile, scenario).and(Must::be_honest(begun));
            trial.simulation.pilot.limits = FlightLimits { border: Border::circle(8.0), ..FENCE };
            trials.push(trial);
        }
    }
    Ok(trials)
}

/// A compass that hangs in a turn, or a drone that does not hear in a turn that it should end: neither must turn the
/// world, which shows when the drone flies on.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
///
/// # Panics
/// If the undisturbed drone does not turn: nothing would be tried then.
pub(super) fn disturbed_turns() -> Result<Vec<Trial>, SimulationError> {
    const STUCK_AT_MS: [u64; 3] = [600, 1000, 1400];
    const STUCK_MS: [u64; 2] = [250, 380];
    const UNHEARD_AT_MS: [u64; 6] = [900, 1050, 1200, 1350, 1500, 1650];
    const UNHEARD_MS: [u64; 4] = [1200, 1400, 1600, 1800];
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        let begun = turn_begins(name, profile)?;
        // While it turns fastest, and while it is to be braked, which the drone does not receive.
        let stuck = disturbances(&STUCK_AT_MS, &STUCK_MS, |time| {
            Action::Sensor(Quantity::Yaw, SensorFault::Stuck, time)
        });
        let unheard =
            disturbances(&UNHEARD_AT_MS, &UNHEARD_MS, |time| Action::Outage(Direction::Up, time));
        for (into, action) in stuck.chain(unheard) {
            let scenario = Scenario::default().and(When::SinceStart(begun + into), action);
            let what = format!("{name} {action:?} {into:?} into a turn");
            let mut trial = Trial::new(what, TURN, profile, scenario).and(Must::be_honest(begun));
            trial.simulation.pilot.limits = FlightLimits { border: Border::circle(8.0), ..FENCE };
            trials.push(trial);
        }
    }
    Ok(trials)
}

/// When an undisturbed drone begins the turn of [`TURN`].
fn turn_begins(name: &str, profile: fn() -> Profile) -> Result<Duration, SimulationError> {
    const STEP: usize = 2;
    let undisturbed = Trial::new(String::new(), TURN, profile, Scenario::default());
    let begun = undisturbed.simulation.fly(plan(TURN))?.start_of_step(STEP);
    Ok(begun.unwrap_or_else(|| panic!("{name} never turns")))
}

/// An action at each of some times, for each of some durations.
fn disturbances(
    at_ms: &[u64],
    for_ms: &[u64],
    action: impl Fn(Duration) -> Action,
) -> impl Iterator<Item = (Duration, Action)> {
    at_ms.iter().flat_map(move |at_ms| {
        let actions = for_ms.iter().map(|ms| action(Duration::from_millis(*ms)));
        actions.map(|action| (Duration::from_millis(*at_ms), action)).collect::<Vec<_>>()
    })
}

/// A velocity that is wrong from before the take-off on: nothing that the drone reports changes when it lifts off.
pub(super) fn wrong_from_the_start() -> Vec<Trial> {
    const WRONG_M_S: f64 = 1.0;
    const BEGINS: Duration = Duration::from_millis(500);
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for quantity in [Quantity::VelocityForward, Quantity::VelocityRight] {
            for wrong_m_s in [WRONG_M_S, -WRONG_M_S] {
                let wrong = Action::Sensor(quantity, SensorFault::Offset(wrong_m_s), FOR_EVER);
                let scenario = Scenario::default().and(When::SinceStart(BEGINS), wrong);
                let what = format!("{name}, {quantity:?} wrong by {wrong_m_s} m/s from the start");
                let trial = Trial::new(what, HOLD, profile, scenario)
                    .and(Must::StayNear { m: MOST_OUTSIDE_M, by_sensors: true });
                trials.push(trial);
            }
        }
    }
    trials
}
