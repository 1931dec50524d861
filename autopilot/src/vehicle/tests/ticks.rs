//! Ticks: readiness, percepts, wind, and what is output.

use kinematics::Sticks;

use super::bench::{Bench, SECOND};
use super::*;

const STAY: &str = "takeoff\ngoto 0 0 0 0\ngoto 0 1 0 0\nland";

#[test]
fn readiness_is_checked_every_ten_ticks_and_said_when_its_reasons_change() {
    let mut bench = Bench::standing_by(STAY);
    bench.readiness.clear();
    let mut percents = Vec::new();
    for percent in (1..=20).rev() {
        bench.battery_percent = percent;
        for _ in 0..3 {
            bench.step();
            percents.push(match bench.vehicle.readiness() {
                [NotReady::EmptyBattery { percent }] => Some(*percent),
                _ => None,
            });
        }
    }
    let changes: Vec<usize> =
        (1..percents.len()).filter(|&tick| percents[tick] != percents[tick - 1]).collect();
    assert!(changes.len() >= 5, "{changes:?}");
    assert!(changes.windows(2).all(|pair| pair[1] - pair[0] == 10), "{changes:?}");
    assert_eq!(bench.readiness.len(), 1, "another number is no other reason");
    bench.battery_percent = 80;
    bench.run(SECOND);
    assert_eq!(bench.readiness.len(), 2);
    assert_eq!(bench.readiness[1], []);
}

#[test]
fn in_flight_the_reason_not_to_take_off_is_the_flight() {
    let mut bench = Bench::in_the_air(STAY);
    bench.readiness.clear();
    bench.run(SECOND);
    assert_eq!(bench.vehicle.readiness(), [NotReady::InFlight]);
    assert!(bench.readiness.len() <= 1);
}

#[test]
fn a_drone_that_climbs_does_not_hover_yet() {
    let mut bench = Bench::standing_by(STAY);
    bench.accepted(OperatorOrder::Start { when_ready: false });
    bench.until(SECOND, |bench| bench.phase() == Phase::Flying);
    bench.rises();
    bench.control_state = ControlState::TakingOff;
    bench.run(SECOND);
    assert_eq!(bench.vehicle.report().steps_done, 0);
    bench.control_state = ControlState::Hovering;
    bench.run(2 * TICK);
    assert_eq!(bench.vehicle.report().steps_done, 1);
}

#[test]
fn the_agent_is_given_the_charge_and_nothing_if_the_drone_says_that_it_is_too_low() {
    let mut bench = Bench::in_the_air(STAY);
    let charge = |bench: &Bench| bench.vehicle.decision().unwrap().percepts.battery_percent;
    assert_eq!(charge(&bench), Some(80));
    bench.state |= DroneState::BATTERY_LOW;
    bench.step();
    assert_eq!(charge(&bench), Some(0));
    let reason = LandingReason::Battery { percent: 80 };
    assert!(bench.events.contains(&FlightEvent::LandingOrdered(reason)), "{:?}", bench.events);
}

#[test]
fn the_agent_is_given_the_time_since_the_last_navdata() {
    let mut bench = Bench::in_the_air(STAY);
    bench.is_heard = false;
    bench.run(SECOND);
    let blind_for_ms = bench.vehicle.decision().unwrap().percepts.blind_for_ms;
    assert!((990..1050).contains(&blind_for_ms), "{blind_for_ms}");
}

#[test]
fn the_navdata_rate_is_averaged_over_a_second() {
    let mut vehicle = Vehicle::new(&VehicleConfig::default()).unwrap();
    let mut hear = |at: Duration| {
        vehicle.count_packet(at);
        vehicle.navdata_hz
    };
    let tenth = Duration::from_millis(100);
    assert!(hear(SECOND).abs() < 1e-9, "one packet is no rate");
    let rates: Vec<f64> = (1..=100).map(|packet| hear(SECOND + tenth * packet)).collect();
    assert!((rates[9] - 6.5).abs() < 0.1, "{}", rates[9]);
    assert!((rates[99] - 10.0).abs() < 0.01, "{}", rates[99]);
    let after_a_gap = hear(SECOND + tenth * 120);
    assert!((after_a_gap - 0.5).abs() < 1e-9, "{after_a_gap}");
}

#[test]
fn the_wind_is_averaged_in_the_air_and_forgotten_on_the_ground() {
    let mut bench = Bench::in_the_air(STAY);
    let disturbance_m_s2 = nalgebra::Vector2::new(1.0, -0.5);
    let state = Prediction { newest_disturbance_m_s2: disturbance_m_s2, ..Prediction::default() };
    for _ in 0..3000 {
        bench.vehicle.feel_wind(&state, 0.01);
    }
    let wind_m_s2 = bench.vehicle.flight.wind.mean_m_s2();
    assert!((wind_m_s2 - disturbance_m_s2).norm() < 0.01, "{wind_m_s2}");
    bench.comes_down();
    bench.run(SECOND);
    bench.vehicle.feel_wind(&state, 0.01);
    assert_eq!(bench.vehicle.flight.wind.mean_m_s2(), nalgebra::Vector2::zeros());
}

/// Shares of what a drone whose thrust is weak in one direction reaches at full tilt.
#[test]
fn wind_is_a_share_of_the_weakest_acceleration_at_full_tilt() {
    let mut config = VehicleConfig::default();
    config.estimator.identify = false;
    config.estimator.limits.tilt_rad = 0.4;
    config.estimator.airframe.thrust_gain = nalgebra::Vector2::new(0.9, 0.5);
    config.estimator.airframe.drag_1_s = nalgebra::Vector2::new(0.7, 0.6);
    config.estimator.airframe.tilt_lag_s = 0.2;
    config.estimator.airframe.drop_gain = 1.5;
    config.estimator.limits.climb_m_s = 0.4;
    let mut vehicle = Vehicle::new(&config).unwrap();
    let full_m_s2 = 0.5 * 9.806_65 * 0.4_f64.tan();
    let state = Prediction {
        position_m: nalgebra::Vector3::new(1.0, 2.0, 3.0),
        velocity_m_s: nalgebra::Vector3::new(4.0, 5.0, 6.0),
        ..Prediction::default()
    };
    vehicle.feel_wind(&state, 0.03);
    let situation = vehicle.situation(SECOND, &state, &state);
    let braking_m_s2 = situation.wind.braking_m_s2(0.0, situation.drag_1_s, 0.0);
    assert!((braking_m_s2 - full_m_s2).abs() < 0.01, "{braking_m_s2}");
    assert!((situation.drag_1_s - 0.6).abs() < 1e-9);
    assert!((situation.tilts_after_s - 0.23).abs() < 1e-9);
    assert!((situation.sink_m_s - 0.6).abs() < 1e-9);
    assert_eq!((situation.airborne, situation.landing), (false, false));
    assert!(situation.velocity_m_s.iter().sum::<f64>() > 14.9);
    assert!((situation.pose.z_m - 3.0).abs() < 1e-9);
}

#[test]
fn a_drone_that_lands_by_itself_is_let_land_and_that_is_said_once() {
    let mut bench = Bench::in_the_air(STAY);
    bench.control_state = ControlState::Landing;
    for _ in 0..3 {
        bench.step();
        let reason = LandingReason::Safety(Veto::Landing);
        assert!(bench.events.contains(&FlightEvent::LandingOrdered(reason)), "{:?}", bench.events);
        let vetoes = bench.events.iter().filter(|event| matches!(event, FlightEvent::Veto(_)));
        assert_eq!(vetoes.count(), 1);
    }
}

#[test]
fn the_drone_is_down_when_it_neither_flies_nor_says_that_it_has_not_landed() {
    let on_ground = |state: DroneState, control_state: Option<ControlState>| {
        let mut bench = Bench::new();
        bench.state = state;
        bench.has_demo = control_state.is_some();
        bench.control_state = control_state.unwrap_or_default();
        bench.hear();
        bench.vehicle.on_ground()
    };
    let (none, flying) = (DroneState::empty(), DroneState::FLYING);
    assert!(on_ground(none, Some(ControlState::Landed)));
    assert!(on_ground(none, None), "without flight data the state decides");
    assert!(!on_ground(none, Some(ControlState::TakingOff)));
    assert!(!on_ground(flying, Some(ControlState::Landed)));
    assert!(on_ground(DroneState::EMERGENCY, Some(ControlState::Hovering)), "it cannot rise");
    assert!(!on_ground(DroneState::EMERGENCY | flying, Some(ControlState::Hovering)));
}

#[test]
fn a_mission_is_output_with_all_its_steps_when_it_changes() {
    let mut bench = Bench::standing_by(STAY);
    assert_eq!(bench.missions, [4]);
    bench.accepted(OperatorOrder::Clear);
    bench.step();
    assert_eq!(bench.missions, [4, 0]);
    assert_eq!(bench.vehicle.session.statistics().received, u64::from(bench.sequence));
}

#[test]
fn each_flight_begins_anew() {
    let mut bench = Bench::in_the_air("takeoff\nland");
    bench.run(TICK);
    bench.comes_down();
    bench.until(SECOND, |bench| bench.phase() == Phase::Standby);
    let first = bench.vehicle.report().clone();
    assert_eq!((first.steps, first.steps_done), (2, 2));
    bench.run(3 * SECOND);
    let began = bench.now;
    bench.accepted(OperatorOrder::Start { when_ready: false });
    assert_eq!(bench.vehicle.outcome(), None);
    let second = bench.vehicle.report();
    assert_eq!((second.steps, second.steps_done, second.took_off_at), (2, 0, None));
    bench.until(SECOND, |bench| bench.phase() == Phase::Flying);
    bench.rises();
    bench.run(3 * SECOND);
    bench.comes_down();
    bench.run(SECOND);
    assert_eq!(bench.outcomes, [Outcome::Completed, Outcome::Completed]);
    assert!(bench.vehicle.report().took_off_at.is_some_and(|at| at > began));
}

#[test]
fn a_program_that_exits_lands_the_drone_and_says_so_in_its_datagram() {
    let mut bench = Bench::in_the_air(STAY);
    assert_eq!(bench.vehicle.handle(bench.now + TICK, Input::Part), Ok(()));
    let expected = bench.vehicle.session.datagram().to_vec();
    assert!(expected.starts_with(b"AT*REF="), "{expected:?}");
    let Some(Output::Transmit(Transmit::Command { datagram, .. })) = bench.vehicle.poll() else {
        panic!("nothing was sent")
    };
    assert_eq!(datagram, expected);
    let first = ardrone_link::at::decode(datagram).next().unwrap().unwrap().1;
    assert_eq!(first, ardrone_link::at::Command::Ref(ardrone_link::at::Ref::Land));
}

/// The drone of this test does not move.
#[test]
fn a_drone_that_is_sent_forward_and_does_not_come_nearer_is_saturated_until_it_holds() {
    let mut bench = Bench::in_the_air(STAY);
    let saturated_ms = |bench: &Bench| bench.vehicle.decision().unwrap().percepts.saturated_for_ms;
    bench.accepted(OperatorOrder::GoTo(Place::at(0.0, 5.0)));
    bench.run(SECOND);
    let forward = match bench.commands[1] {
        ardrone_link::at::Command::Pcmd(ardrone_link::at::Motion::Progressive {
            pitch, ..
        }) => -pitch.get(),
        _ => 0.0,
    };
    assert!(forward > 0.5, "{:?}", bench.commands);
    let most_ms = saturated_ms(&bench);
    assert!(most_ms > 2 * 30, "more than one tick at a time: {most_ms}");
    bench.accepted(OperatorOrder::Hold);
    bench.run(SECOND / 2);
    assert!(saturated_ms(&bench) < most_ms);
}

#[test]
fn the_status_is_told_in_every_third_tick_and_says_whether_the_drone_is_in_the_air() {
    let mut bench = Bench::standing_by(STAY);
    assert!(!bench.vehicle.status(bench.now).airborne);
    let mut told = 0;
    for _ in 0..30 {
        bench.now += TICK;
        assert_eq!(bench.vehicle.handle(bench.now, Input::Tick), Ok(()));
        while let Some(output) = bench.vehicle.poll() {
            told += usize::from(matches!(output, Output::Telemetry(Telemetry::Status(_))));
        }
    }
    assert_eq!(told, 10);
    assert!(Bench::in_the_air(STAY).vehicle.status(SECOND).airborne);
}

/// The drone answers with its next packet, for which it waits for half an interval on average.
#[test]
fn the_delay_of_the_link_is_what_an_answer_takes_less_half_an_interval() {
    let mut bench = Bench::standing_by(STAY);
    let round_trip = bench.vehicle.session.round_trip().unwrap();
    let half = Duration::from_millis(25);
    assert!(round_trip > half, "{round_trip:?}");
    bench.vehicle.navdata_hz = 20.0;
    bench.accepted(OperatorOrder::Start { when_ready: false });
    let mut expected = estimator::Estimator::new(bench.vehicle.config.estimator);
    let untold = expected.order_delay();
    expected.expect_link_delay(round_trip.saturating_sub(half));
    assert_ne!(expected.order_delay(), untold);
    assert_eq!(bench.vehicle.flight.estimator.order_delay(), expected.order_delay());
}

/// Whether the last datagram begins with number 1, which every drone accepts.
fn insists(bench: &Bench) -> bool {
    let first = ardrone_link::at::decode(bench.vehicle.session.datagram()).next();
    first.is_some_and(|command| command.unwrap().0 == 1)
}

/// Steers for this time; when the vehicle first insisted on being obeyed.
fn insists_after(bench: &mut Bench, sticks: Sticks, time: Duration) -> Option<Duration> {
    let since = bench.now + TICK;
    let end = bench.now + time;
    while bench.now < end {
        bench.accepted(OperatorOrder::Steer(sticks));
        bench.step();
        if insists(bench) {
            return Some(bench.now.saturating_sub(since));
        }
    }
    None
}

#[test]
fn a_drone_that_leans_otherwise_than_it_is_told_for_too_long_is_made_to_listen() {
    let right = Sticks { roll: 1.0, ..Sticks::default() };
    let forward = Sticks { pitch: -1.0, ..Sticks::default() };
    for (sticks, leans, obeys) in [
        (right, [1.0, 0.0], true),
        (right, [0.35, 0.0], true),
        (right, [0.25, 0.0], false),
        (right, [1.0, 0.75], false),
        (forward, [0.0, -1.0], true),
        (forward, [0.0, -0.25], false),
    ] {
        let mut bench = Bench::in_the_air(STAY);
        let full_deg = bench.vehicle.config.estimator.limits.tilt_rad.to_degrees();
        bench.leans_deg = leans.map(|share| share * full_deg);
        let within = Duration::from_millis(500) + bench.vehicle.flight.estimator.order_delay();
        let after = insists_after(&mut bench, sticks, within + 3 * TICK);
        let in_time = after.is_some_and(|after| after >= within && after < within + TICK);
        assert_eq!((after.is_none(), in_time), (obeys, !obeys), "{leans:?}: {after:?} {within:?}");
    }
}

/// What is not heard for a moment may have been obeyed.
#[test]
fn a_drone_that_is_not_heard_is_not_taken_for_one_that_does_not_listen() {
    let right = Sticks { roll: 1.0, ..Sticks::default() };
    let mut bench = Bench::in_the_air(STAY);
    let within = Duration::from_millis(500) + bench.vehicle.flight.estimator.order_delay();
    let before = within.saturating_sub(7 * TICK);
    assert_eq!(insists_after(&mut bench, right, before), None);
    bench.is_heard = false;
    assert_eq!(insists_after(&mut bench, right, 9 * TICK), None);
}

#[test]
fn a_landing_of_a_drone_that_rose_by_an_old_order_is_a_flight_for_which_nobody_is_ready() {
    let mut bench = Bench::in_the_air("takeoff\nland");
    bench.run(TICK);
    bench.comes_down();
    bench.until(SECOND, |bench| bench.phase() == Phase::Standby);
    bench.run(SECOND / 2);
    assert_eq!(bench.vehicle.readiness(), []);
    bench.rises();
    bench.run(SECOND / 2);
    assert_eq!(
        (bench.phase(), bench.vehicle.readiness()),
        (Phase::Landing, &[NotReady::InFlight][..])
    );
}
