//! Delays, gaps, wind, and what is learnt of the airframe.

use kinematics::GRAVITY_M_S2;

use super::*;

fn unidentified() -> EstimatorConfig {
    EstimatorConfig { identify: false, ..EstimatorConfig::default() }
}

/// The stick at which drag holds a drone at this speed.
fn stick_for(m_s: f64) -> f64 {
    let tilt_rad = (m_s * Airframe::default().drag_1_s.y / GRAVITY_M_S2).atan();
    tilt_rad / DroneLimits::default().tilt_rad
}

#[test]
fn a_prediction_covers_the_age_of_each_measurement() {
    let mut flight = Flight::new(&unidentified());
    let steady = Sticks { pitch: -stick_for(1.0), gaz: 0.5, ..Sticks::default() };
    flight.order = sticks(steady);
    let velocity_m_s = 1.0;
    let climb_m_s = 0.5 * DroneLimits::default().climb_m_s;
    for packet in 0..160 {
        flight.shown.altitude_m = 1.0 + climb_m_s * 0.0625 * f64::from(packet);
        // It gathers speed as fast as the gate admits.
        flight.shown.velocity_forward_m_s = (0.02 * f64::from(packet)).min(velocity_m_s);
        flight.step();
    }
    let (estimate, predicted) = (*flight.estimator.estimate(), flight.predicted());
    let ahead_m = predicted.position_m - estimate.position_m;
    assert_near(ahead_m.y, 0.060 * velocity_m_s, 1e-3);
    assert_near(ahead_m.z, 0.040 * climb_m_s, 1e-3);
    // Beyond the newest sample it goes on for 0.6 s and no further.
    let after = |ms| {
        let at = flight.now() + Duration::from_millis(ms);
        flight.estimator.predicted(at).position_m - estimate.position_m
    };
    assert_near(after(400).y, 0.460, 0.005);
    assert_near(after(400).z, 0.440 * climb_m_s, 0.005);
    assert_near(after(5000).y, 0.6, 0.005);
    assert_near(after(5000).z, 0.6 * climb_m_s, 0.005);
    // The heights are those that were measured: 40 ms ago.
    assert_near(estimate.position_m.z, flight.shown.altitude_m, 1e-3);
}

#[test]
fn a_velocity_turns_by_the_heading_of_its_own_time() {
    let mut flight = Flight::new(&unidentified());
    flight.order = sticks(Sticks { yaw: 0.3, ..Sticks::default() });
    let rate_deg_s = 0.3 * DroneLimits::default().turn_deg_s;
    for packet in 0..160 {
        // The turn begins with the dead time and the lag of the airframe.
        let turned_deg =
            |age_s: f64| rate_deg_s * (0.0625 * f64::from(packet) - age_s - 0.22).max(0.0);
        flight.shown.yaw_deg = wrap_deg(100.0 + turned_deg(0.020));
        // In the world it flies forward.
        let m_s = (0.02 * f64::from(packet)).min(1.0);
        let body = kinematics::body_from_world(Vector2::new(0.0, m_s), turned_deg(0.060));
        (flight.shown.velocity_right_m_s, flight.shown.velocity_forward_m_s) = (body.x, body.y);
        flight.step();
        if packet == 159 {
            let estimate = flight.estimator.estimate();
            // 40 ms between the two are 1.2 degrees, or 0.02 m/s aside.
            assert_near(estimate.velocity_m_s.x, 0.0, 0.004);
            assert_near(estimate.yaw_deg, wrap_deg(turned_deg(0.020)), 0.01);
            assert_near(flight.predicted().yaw_deg, wrap_deg(turned_deg(0.0)), 0.05);
        }
    }
}

#[test]
fn on_the_ground_the_orders_move_nothing() {
    for airborne in [false, true] {
        let mut flight = Flight::new(&unidentified());
        flight.order = sticks(Sticks { pitch: -0.5, gaz: 0.5, ..Sticks::default() });
        flight.shown.airborne = airborne;
        flight.fly(4);
        let later = flight.estimator.predicted(flight.now() + Duration::from_millis(500));
        let moved_m = later.position_m - flight.estimator.estimate().position_m;
        assert_eq!(moved_m.y > 0.05, airborne, "{moved_m}");
        assert_eq!(moved_m.z > 0.05, airborne, "{moved_m}");
        let now = flight.now() + Duration::from_secs(2);
        let (aside_m, up_m) =
            (flight.estimator.uncertainty_m(now), flight.estimator.height_uncertainty_m(now));
        assert_eq!(aside_m > 0.1 && up_m > 0.1, airborne, "silence in the air is uncertain");
    }
}

#[test]
fn silence_and_disputed_heights_make_the_height_uncertain() {
    let mut flight = Flight::new(&unidentified());
    flight.fly(32);
    let uncertainty_m = |flight: &Flight, ms| {
        flight.estimator.height_uncertainty_m(flight.now() + Duration::from_millis(ms))
    };
    let before_m = uncertainty_m(&flight, 0);
    assert!((0.01..0.02).contains(&before_m), "{before_m}");
    assert!(uncertainty_m(&flight, 2000) > 1.0);
    flight.shown.altitude_m = 1.5;
    flight.step();
    assert_near(uncertainty_m(&flight, 0), 0.5, 0.01);
    // The floor has made a step, which is not known exactly.
    flight.fly(10);
    let stepped_m = uncertainty_m(&flight, 0);
    assert!((1.2 * before_m..0.1).contains(&stepped_m), "{stepped_m}");
}

/// A flight that hovers, then is silent, and then receives one packet.
fn after_a_gap(gap_packets: u32, shown: Sample) -> Flight {
    let mut flight = Flight::new(&unidentified());
    flight.order = sticks(Sticks::default());
    flight.fly(32);
    assert_near(flight.estimator.uncertainty.unmeasured_m2(), 0.0, 1e-12);
    flight.packet += gap_packets;
    flight.shown = shown;
    flight.step();
    flight
}

#[test]
fn a_gap_beyond_the_usual_tenth_of_a_second_was_flown_unseen() {
    let flying = Sample { altitude_m: 1.0, airborne: true, ..Sample::default() };
    for shown in [flying, Sample { airborne: false, ..flying }] {
        // Ten sixteenths of a second.
        let flight = after_a_gap(9, shown);
        let unseen_m = 0.15 * (0.625 - USUAL_STEP_S);
        assert_near(flight.estimator.uncertainty.unmeasured_m2().sqrt(), unseen_m, 1e-4);
        // A packet that is not lost adds nothing.
        let mut flight = after_a_gap(0, shown);
        assert_near(flight.estimator.uncertainty.unmeasured_m2(), 0.0, 1e-12);
        // Nor does a gap of a drone that was on the ground already.
        if !shown.airborne {
            flight.packet += 30;
            flight.step();
            assert_near(flight.estimator.uncertainty.unmeasured_m2(), 0.0, 1e-12);
        }
    }
}

#[test]
fn a_rejected_velocity_leaves_the_position_in_doubt_and_does_not_move_it() {
    let mut flight = Flight::new(&unidentified());
    flight.order = sticks(Sticks::default());
    flight.fly(32);
    flight.shown.velocity_forward_m_s = 1.0;
    flight.fly(4);
    let doubt_m = flight.estimator.uncertainty.unmeasured_m2().sqrt();
    assert_near(doubt_m, 4.0 * 0.0625 * 1.0, 0.005);
    assert_near(flight.estimator.estimate().position_m.y, 0.0, 0.005);
    flight.shown.velocity_forward_m_s = 0.0;
    flight.fly(4);
    assert_near(flight.estimator.uncertainty.unmeasured_m2().sqrt(), doubt_m, 1e-9);
    // From 0.5 m/s forward it brakes by itself within half a second, and the flow says backward.
    let mut flight = Flight::new(&unidentified());
    flight.shown.velocity_forward_m_s = 0.5;
    flight.fly(32);
    flight.shown.velocity_forward_m_s = -0.5;
    flight.fly(4);
    let off_m = |packet: u32| 0.0625 * (0.5 + 0.5 * (-0.125 * f64::from(packet)).exp());
    let doubt_m = flight.estimator.uncertainty.unmeasured_m2().sqrt();
    assert_near(doubt_m, (1..=4).map(off_m).sum(), 0.005);
}

#[test]
fn a_repeated_velocity_is_the_last_one_again() {
    let mut flight = Flight::new(&unidentified());
    flight.fly(32);
    let sample = |packet, velocity_forward_m_s| Sample {
        arrival: PERIOD * packet,
        velocity_forward_m_s,
        ..flight.shown
    };
    let shown = [sample(33, 0.1), sample(34, 0.1), sample(35, 0.1), sample(36, 0.2)];
    let mut all = flight.estimator.clone();
    for sample in &shown {
        all.update(sample);
    }
    let mut fresh = flight.estimator.clone();
    for sample in [&shown[0], &shown[3]] {
        fresh.update(sample);
    }
    let at = PERIOD * 36;
    assert_eq!(all.predicted(at).position_m.xy(), fresh.predicted(at).position_m.xy());
    assert_near(all.estimate().position_m.y - 0.0625 * 0.05, 0.1875 * 0.15, 0.001);
}

#[test]
fn a_drone_that_holds_its_position_shows_the_wind_by_its_tilt() {
    let disturbance = |order: Order| {
        let mut flight = Flight::new(&unidentified());
        flight.order = order;
        flight.shown.altitude_m = 1.0;
        // Left side down and nose up: it leans to the left and backward.
        (flight.shown.roll_deg, flight.shown.pitch_deg) = (-3.0, 2.0);
        flight.fly(160);
        flight.predicted().disturbance_m_s2
    };
    let wind = disturbance(Order::ByItself);
    assert_near(wind.x, GRAVITY_M_S2 * 3_f64.to_radians().tan(), 0.005);
    assert_near(wind.y, GRAVITY_M_S2 * 2_f64.to_radians().tan(), 0.005);
    assert_near(disturbance(sticks(Sticks::default())).norm(), 0.0, 0.01);
}

#[test]
fn a_storm_is_believed_with_the_fourth_velocity_that_no_gust_explains() {
    let mut flight = Flight::new(&unidentified());
    flight.order = sticks(Sticks::default());
    flight.fly(60);
    let began_m = flight.estimator.estimate().position_m.x;
    // 8 m/s² to the right: 0.53 m/s from one packet to the next.
    for packet in 1..=10 {
        flight.shown.velocity_right_m_s = 8.0 * PERIOD.as_secs_f64() * f64::from(packet);
        flight.fly(1);
        let believed = flight.estimator.estimate().velocity_m_s.x > 1.0;
        assert_eq!(believed, packet >= 4, "{packet}");
    }
    assert_eq!(flight.estimator.trust(), Trust::Sound);
    let flown_s = 10.0 * PERIOD.as_secs_f64();
    let flown_m = flight.estimator.estimate().position_m.x - began_m;
    assert_near(flown_m, 4.0 * flown_s * flown_s, 0.1);
    assert!(flight.predicted().disturbance_m_s2.x > 3.0);
}

#[test]
fn a_repeated_height_is_a_new_one_after_the_interval_of_the_ultrasound() {
    let heights = |heights: &[(f64, f64)]| {
        let config = EstimatorConfig { altitude_delay: Duration::ZERO, ..unidentified() };
        let mut estimator = Estimator::new(config);
        for (i, (at_s, altitude_m)) in heights.iter().enumerate() {
            estimator.update(&Sample {
                arrival: Duration::from_secs_f64(*at_s),
                drone_time: Some(Duration::from_secs_f64(*at_s)),
                altitude_m: *altitude_m,
                velocity_forward_m_s: 1e-3 * i as f64,
                airborne: true,
                ..Sample::default()
            });
        }
        estimator.altitude.state()
    };
    // It climbs half a metre per second, and seems to stop after 1.2 s.
    let climbing: Vec<(f64, f64)> =
        (0..=30).map(|i| (0.04 * f64::from(i), 1.0 + 0.02 * f64::from(i))).collect();
    let then = |more: &[(f64, f64)]| heights(&[&climbing[..], more].concat());
    let (climb, packets) = (then(&[]), then(&[(1.205, 1.6), (1.23, 1.6), (1.249, 1.6)]));
    assert_eq!((climb.height_m, climb.climb_m_s), (packets.height_m, packets.climb_m_s));
    let stopped = then(&[(1.255, 1.6)]);
    assert!(stopped.climb_m_s < climb.climb_m_s - 0.02, "{stopped:?}, {climb:?}");
    // At the interval itself it is a new one.
    let hovers = heights(&[(0.0, 1.0), (ALTITUDE_INTERVAL_S, 1.0)]);
    assert_near(hovers.height_m, 1.0, 1e-12);
    let climb = |again_s: f64| heights(&[(0.0, 1.0), (again_s, 1.0), (0.1, 1.03)]).climb_m_s;
    let [new, same] = [ALTITUDE_INTERVAL_S, 0.0499].map(climb);
    assert!((new - same).abs() > 1e-4, "it was measured twice: {new}, {same}");
}

/// A drone with another airframe than assumed, flown by its sticks for a minute. Nothing is
/// delayed.
fn flown(config: &EstimatorConfig, floor_steps: bool) -> Airframe {
    let now = Duration::ZERO;
    let [dead_time, velocity_delay, altitude_delay, attitude_delay] = [now; 4];
    let mut flight = Flight::new(&EstimatorConfig {
        dead_time,
        velocity_delay,
        altitude_delay,
        attitude_delay,
        ..*config
    });
    let airframe = Airframe {
        tilt_gain: 0.7,
        climb_gain: 1.4,
        drop_gain: 0.8,
        turn_gain: 0.8,
        thrust_gain: Vector2::new(0.8, 0.8),
        ..Airframe::default()
    };
    let limits = DroneLimits::default();
    let (mut horizontal, mut vertical) = (Horizontal::default(), Vertical::default());
    let mut tilt_rad = Vector2::<f64>::zeros();
    let (mut turn_deg_s, mut yaw_deg) = (0.0, 0.0);
    for packet in 0..16 * 60_u32 {
        let at_s = 0.0625 * f64::from(packet);
        let swing = |hertz: f64| (at_s * hertz * std::f64::consts::TAU).sin();
        let asked = Sticks {
            roll: 0.4 * swing(0.45),
            pitch: 0.4 * swing(0.3),
            gaz: 0.6 * swing(0.25),
            yaw: 0.12 * swing(0.2),
        };
        flight.order = sticks(asked);
        let body = kinematics::body_from_world(horizontal.velocity_m_s, yaw_deg);
        // A box of 0.8 m below, now and then.
        let floor_m = if floor_steps && packet % 40 > 30 { 0.8 } else { 0.0 };
        flight.shown = Sample {
            yaw_deg,
            roll_deg: tilt_rad.x.to_degrees(),
            pitch_deg: -tilt_rad.y.to_degrees(),
            velocity_right_m_s: body.x,
            velocity_forward_m_s: body.y,
            altitude_m: 2.5 + vertical.height_m - floor_m,
            ..flight.shown
        };
        flight.step();
        let step_s = 0.0625;
        horizontal.advance(step_s, flight.order, yaw_deg, &airframe, &limits);
        vertical.advance(step_s, flight.order, &airframe, &limits);
        let followed = |lag_s: f64| 1.0 - (-step_s / lag_s).exp();
        tilt_rad += (asked.tilt() * (limits.tilt_rad * airframe.tilt_gain) - tilt_rad)
            * followed(airframe.tilt_lag_s);
        turn_deg_s += (asked.yaw * limits.turn_deg_s * airframe.turn_gain - turn_deg_s)
            * followed(airframe.turn_lag_s);
        yaw_deg += turn_deg_s * step_s;
    }
    *flight.estimator.airframe()
}

#[test]
fn the_airframe_is_identified_in_flight() {
    let found = flown(&EstimatorConfig::default(), false);
    assert_near(found.tilt_gain, 0.7, 0.1);
    assert_near(found.climb_gain, 1.4, 0.2);
    assert_near(found.drop_gain, 0.8, 0.15);
    assert_near(found.turn_gain, 0.8, 0.1);
    assert!(found.thrust_gain.x < 0.95 && found.thrust_gain.y < 0.95, "{found:?}");
    let given = unidentified();
    assert_eq!(flown(&given, false), given.airframe, "not unless it is wanted");
    let over_boxes = flown(&EstimatorConfig::default(), true);
    assert_near(over_boxes.climb_gain, 1.4, 0.25);
    assert_near(over_boxes.drop_gain, 0.8, 0.2);
}

#[test]
fn after_a_restart_the_position_goes_on_and_the_clock_and_the_compass_begin_anew() {
    let mut flight = Flight::new(&unidentified());
    flight.shown.velocity_forward_m_s = 0.3;
    flight.shown.drone_time = None;
    flight.fly(64);
    let before = *flight.estimator.estimate();
    assert!(before.position_m.y > 0.5);
    let [sure_m, silent_m] = [0, 1000].map(|ms| {
        let at = before.at + Duration::from_millis(ms);
        flight.estimator.uncertainty_m(at)
    });
    flight.estimator.handle_restart(before.at + Duration::from_secs(1));
    // Nobody has seen what it flew in that second.
    let unsure_m = flight.estimator.uncertainty_m(before.at);
    assert!(silent_m > sure_m + 0.2, "{sure_m} {silent_m}");
    assert_near(unsure_m, silent_m, 1e-9);
    flight.packet += 160;
    flight.shown.yaw_deg = 150.0;
    flight.shown.velocity_forward_m_s = -1.0;
    flight.step();
    let after = flight.estimator.estimate();
    assert_near((after.position_m - before.position_m).norm(), 0.0, 0.01);
    assert_near(after.yaw_deg, 0.0, 1e-3);
    assert_near(after.velocity_m_s.y, -1.0, 1e-3);
    assert_eq!(flight.estimator.trust(), Trust::Sound);
}
