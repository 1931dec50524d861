//! A drone that has cut its motors.

use super::*;
use crate::dialect::MavLandedState;

#[test]
fn a_drone_in_its_emergency_state_is_not_armed() {
    let mut bench = Bench::new(Config::default());
    bench.status.emergency = true;
    bench.pass(Duration::from_millis(20));
    // Its reasons not to take off come later.
    bench.refuses(400, first(1.0));
    bench.status.emergency = false;
    bench.pass(Duration::from_millis(20));
    bench.accepts(400, first(1.0));
}

/// With its motors cut it neither flies a mission nor lands: it falls, and then lies on the ground.
#[test]
fn a_drone_that_falls_is_not_said_to_land() {
    let mut bench = Bench::new(Config::default());
    bench.fly();
    (bench.status.phase, bench.status.emergency) = (Phase::Standby, true);
    for airborne in [true, false] {
        bench.status.airborne = airborne;
        bench.sent.clear();
        bench.pass(2 * SECOND);
        let states = bench.sent.iter().filter_map(|(_, message)| match message {
            MavMessage::EXTENDED_SYS_STATE(data) => Some(data.landed_state),
            _ => None,
        });
        let falls = if airborne {
            MavLandedState::MAV_LANDED_STATE_IN_AIR
        } else {
            MavLandedState::MAV_LANDED_STATE_ON_GROUND
        };
        let states: Vec<MavLandedState> = states.collect();
        assert!(!states.is_empty() && states.iter().all(|state| *state == falls), "{states:?}");
        assert!(!bench.is_armed());
        assert_eq!(bench.mode(), Mode::Hold);
    }
    assert!(!bench.said("landed"));
}
