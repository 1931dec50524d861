//! Rules of the safety monitor and of the flight as a whole.

use std::time::Duration;

use autopilot::plan::{Border, FlightLimits};
use autopilot::vehicle::{OperatorOrder, TICK};
use mock_drone::airframe::Profile;
use mock_drone::scenario::{Action, Direction, Scenario, When};
use mock_drone::{Quantity, SensorFault};

use crate::airframes::{AIRFRAMES, Model};
use crate::plan;
use crate::sim::SimulationError;
use crate::trial::{FENCE, FOR_EVER, HOLD, HOLDS_AT, Must, Trial};

/// Drones that another pilot has left above the ceiling: they are taken over, and told to hold where they are. No
/// order leads above the ceiling, and the drone's own limit of altitude stops a climb, but does not bring it down.
pub(super) fn above_the_ceiling() -> Vec<Trial> {
    const CEILING_M: f64 = 1.6;
    const MARGIN_M: f64 = 0.5;
    const DOWN_TO_IT: Duration = Duration::from_secs(6);
    const TAKE_OVER: &str = "autoTakeover 500 800 0.5 0.5\nsetStayTime 20\ngoto 0 0 0 0\nland\n";
    let limits = FlightLimits { ceiling_m: CEILING_M, ..FENCE };
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for height_m in [3.0, 4.0] {
            for held_at in [1500, 2000].map(Duration::from_millis) {
                let what = format!("{name} taken over at {height_m} m, held after {held_at:?}");
                let mut trial = Trial::new(what, TAKE_OVER, profile, Scenario::default())
                    .and(Must::StayBelow { m: CEILING_M + MARGIN_M, since: DOWN_TO_IT })
                    .and(Must::StayNear {
                        m: FENCE.border.furthest_m() + MARGIN_M,
                        by_sensors: true,
                    });
                trial.simulation.world.drone.flies_at_m = Some(height_m);
                trial.simulation.pilot.limits = limits;
                trial.simulation.orders = vec![(held_at, OperatorOrder::Hold)];
                trials.push(trial);
            }
        }
    }
    trials
}

/// Navdata that no longer arrive, or are worthless, for ever: the agent lands after two seconds, and if it does not,
/// the monitor after four.
pub(super) fn blind() -> Vec<Trial> {
    const LANDS_WITHIN: Duration = Duration::from_secs(15);
    let no_velocity = |quantity| Action::Sensor(quantity, SensorFault::NotANumber, FOR_EVER);
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for (what, action) in [
            ("unseen", Action::Outage(Direction::Down, FOR_EVER)),
            ("frozen", Action::Freeze(FOR_EVER)),
            ("without velocity", no_velocity(Quantity::VelocityForward)),
        ] {
            let scenario = Scenario::default().and(When::SinceStart(HOLDS_AT), action);
            let trial = Trial::new(format!("{name} {what}"), HOLD, profile, scenario);
            trials.push(trial.and(Must::BeDown { by: HOLDS_AT + LANDS_WITHIN }));
        }
    }
    trials
}

/// A landing ordered so soon after the take-off that the drone has not yet left the ground: the landing is complete
/// before the take-off arrives, and the drone rises after it.
///
/// # Errors
/// [`SimulationError`] if a flight never ends.
///
/// # Panics
/// If the undisturbed drone does not take off: nothing would be tried then.
pub(super) fn down_before_the_take_off() -> Result<Vec<Trial>, SimulationError> {
    const TICKS: u32 = 10;
    const LANDS_WITHIN: Duration = Duration::from_secs(8);
    let text = "takeoff\ngoto 0 0 0.5 0\nland\n";
    let mut trials = Vec::new();
    for delay in [20, 50, 80, 120].map(Duration::from_millis) {
        let late = Action::Delay(delay, Duration::ZERO);
        let scenario = Scenario::default().and(When::SinceStart(Duration::ZERO), late);
        let undisturbed = Trial::new(String::new(), text, Profile::rec, scenario.clone());
        let begun = undisturbed.simulation.fly(plan(text))?.start_of_step(0);
        let begun = begun.unwrap_or_else(|| panic!("no take-off, {delay:?} late"));
        for tick in 0..TICKS {
            let ordered = begun + TICK * tick;
            let what = format!("landing {tick} ticks after the take-off, {delay:?} late");
            let mut trial = Trial::new(what, text, Profile::rec, scenario.clone())
                .and(Must::BeDown { by: ordered + LANDS_WITHIN });
            trial.simulation.orders = vec![(ordered, OperatorOrder::Land)];
            trials.push(trial);
        }
    }
    Ok(trials)
}

/// A velocity that is late by a second: the drone circles around its target, without its sticks at their limit. It
/// must not do so until the time of the approach is over.
pub(super) fn kept_away() -> Vec<Trial> {
    const LATE: Duration = Duration::from_secs(1);
    const FAILS_AT: Duration = Duration::from_secs(14);
    const GIVES_UP_BY: Duration = Duration::from_secs(55);
    let mut trials = Vec::new();
    for Model { name, profile } in AIRFRAMES {
        for away_m in [0.6, 1.0, 1.5] {
            let text = format!(
                "takeoff\ngoto 0 0 0.5 0\nsetStayTime 10\ngoto 0 0 0.5 0\ngoto 0 {away_m} 0.5 0\nland\n"
            );
            let late = |quantity| Action::Sensor(quantity, SensorFault::Late(LATE), FOR_EVER);
            let scenario = Scenario::default()
                .and(When::SinceStart(FAILS_AT), late(Quantity::VelocityForward))
                .and(When::SinceStart(FAILS_AT), late(Quantity::VelocityRight));
            let what = format!("{name} to {away_m} m by a late velocity");
            let trial = Trial::new(what, &text, profile, scenario);
            trials.push(trial.and(Must::BeDown { by: GIVES_UP_BY }));
        }
    }
    trials
}

/// A target so far away, flown to so slowly, that the drone is on its way for more than a minute, and comes nearer all
/// the time.
pub(super) fn slow() -> Vec<Trial> {
    const AWAY_M: f64 = 25.0;
    const ON_ITS_WAY: Duration = Duration::from_secs(50);
    const GIVES_UP_BY: Duration = Duration::from_secs(85);
    let plan = format!("takeoff\nsetMaxControl 0.05\ngoto 0 {AWAY_M} 0 0\nland\n");
    let limits = FlightLimits { border: Border::circle(AWAY_M + 10.0), ..FENCE };
    let trials = AIRFRAMES.map(|Model { name, profile }| {
        let what = format!("{name} slowly to {AWAY_M} m");
        let mut trial = Trial::new(what, &plan, profile, Scenario::default())
            .and(Must::BeUp { at: ON_ITS_WAY })
            .and(Must::BeDown { by: GIVES_UP_BY });
        trial.simulation.pilot.limits = limits;
        trial
    });
    trials.into()
}
