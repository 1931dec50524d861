//! What makes navdata implausible, and when they were last plausible.

use super::*;

/// When navdata are first distrusted within some packets, in seconds of flight.
fn distrusted(flight: &mut Flight, packets: u32) -> Option<(f64, Trust)> {
    (0..packets).find_map(|i| {
        flight.step();
        let trust = flight.estimator.trust();
        (trust != Trust::Sound).then(|| (0.0625 * f64::from(i), trust))
    })
}

fn hovering() -> Flight {
    let mut flight = Flight::new(&EstimatorConfig::default());
    flight.order = sticks(Sticks::default());
    assert_eq!(distrusted(&mut flight, 64), None);
    assert_eq!(flight.estimator.sound_at(), Some(flight.now()));
    flight
}

#[test]
fn each_quantity_that_goes_wrong_is_named() {
    let mut flight = hovering();
    let sound_at = flight.now();
    flight.shown.altitude_m = 500.0;
    let (at_s, trust) = distrusted(&mut flight, 32).unwrap();
    assert_eq!(trust, Trust::Implausible(Quantity::Altitude));
    assert!((0.4..0.5).contains(&at_s), "{at_s}");
    assert_eq!(flight.estimator.sound_at(), Some(sound_at), "the last packet before");
    assert_near(flight.estimator.estimate().position_m.z, 1.0, 1e-3);

    let mut flight = hovering();
    flight.shown.velocity_right_m_s = 1.2;
    let (at_s, trust) = distrusted(&mut flight, 32).unwrap();
    assert_eq!(trust, Trust::Implausible(Quantity::Velocity));
    assert!((0.4..0.5).contains(&at_s), "{at_s}");

    // Four steps are forgiven, of the compass and of the floor: both ends of two boxes.
    let compass: fn(&mut Sample, f64) = |shown, up| shown.yaw_deg = 90.0 * up;
    let floor: fn(&mut Sample, f64) = |shown, up| shown.altitude_m = 1.0 + up;
    for (change, quantity) in [(compass, Quantity::Heading), (floor, Quantity::Altitude)] {
        let mut flight = hovering();
        for up in [1.0, 0.0, 1.0, 0.0] {
            change(&mut flight.shown, up);
            assert_eq!(distrusted(&mut flight, 8), None);
        }
        change(&mut flight.shown, 1.0);
        let (_, trust) = distrusted(&mut flight, 8).unwrap();
        assert_eq!(trust, Trust::Implausible(quantity));
    }
}

#[test]
fn a_velocity_that_repeats_after_a_jump_is_still_rejected() {
    let mut flight = hovering();
    let mut show = |after: u32, velocity_forward_m_s: f64| {
        let arrival = flight.now() + PERIOD * after;
        let wobble = 1e-4 * f64::from(after % 3);
        let (yaw_deg, altitude_m) = (wobble, 1.0 + wobble);
        let shown = Sample { arrival, yaw_deg, velocity_forward_m_s, altitude_m, ..flight.shown };
        flight.estimator.update(&shown);
        flight.estimator.trust()
    };
    // It jumps, and then hangs: wrong from the first packet on, not from the last.
    let trusts: Vec<Trust> = (1..=8).map(|after| show(after, 1.1)).collect();
    assert_eq!(trusts[7], Trust::Implausible(Quantity::Velocity), "{trusts:?}");
    // One that does not jump is just the last one again.
    let mut flight = hovering();
    flight.estimator.update(&Sample { arrival: flight.now() + PERIOD, ..flight.shown });
    assert_eq!(flight.estimator.trust(), Trust::Sound);
}

#[test]
fn a_packet_is_no_news_that_is_late_or_impossible() {
    for (altitude_m, news_ms) in [(1.0, 320), (500.0, 60)] {
        let mut flight = hovering();
        let start = flight.now();
        let mut show = |drone_ms: u64, arrival_ms: u64, altitude_m: f64| {
            flight.estimator.update(&Sample {
                drone_time: Some(Duration::from_millis(7000 + drone_ms)),
                arrival: start + Duration::from_millis(arrival_ms),
                altitude_m,
                velocity_forward_m_s: 1e-6 * drone_ms as f64,
                ..flight.shown
            });
            flight.estimator.sound_at().unwrap().saturating_sub(start)
        };
        assert_eq!(show(60, 60, 1.0), Duration::from_millis(60));
        assert_eq!(show(120, 320, altitude_m), Duration::from_millis(news_ms), "by 200 ms");
        assert_eq!(show(180, 580, altitude_m), Duration::from_millis(news_ms), "by 400 ms");
    }
}

/// A drone that has taken off, whose sensors do not work yet.
fn taking_off(order: Order, altitude_m: f64) -> Flight {
    let mut flight = Flight::new(&EstimatorConfig::default());
    flight.order = order;
    flight.shown.autonomous = order == Order::ByItself;
    flight.shown.altitude_m = altitude_m;
    flight
}

/// The same packet, without any rattle, every sixteenth of a second: when it is distrusted.
fn frozen_at_s(flight: &mut Flight) -> Option<f64> {
    (0..100_u32).find_map(|i| {
        flight.estimator.order_sent(flight.now(), flight.order);
        flight.estimator.update(&Sample { arrival: flight.now(), ..flight.shown });
        flight.packet += 1;
        (flight.estimator.trust() != Trust::Sound).then(|| 0.0625 * f64::from(i))
    })
}

#[test]
fn a_drone_that_takes_off_by_itself_may_see_nothing_yet() {
    // The usual patience of the flow, and of the others.
    let (flow_s, others_s) = (0.4375, 1.0);
    let sees_again_s = |flight: &mut Flight, wobbles: fn(&mut Sample, f64)| {
        (0..100_u32).find_map(|i| {
            let (arrival, wobble) = (flight.now(), 0.001 * f64::from(flight.packet % 7));
            let mut shown = Sample { arrival, ..flight.shown };
            wobbles(&mut shown, wobble);
            flight.estimator.order_sent(arrival, flight.order);
            flight.estimator.update(&shown);
            flight.packet += 1;
            (flight.estimator.trust() != Trust::Sound).then(|| 0.0625 * f64::from(i))
        })
    };
    let turns: fn(&mut Sample, f64) = |shown, wobble| {
        (shown.roll_deg, shown.pitch_deg, shown.yaw_deg) = (wobble, -wobble, wobble);
    };
    let turns_and_rises: fn(&mut Sample, f64) = |shown, wobble| {
        (shown.roll_deg, shown.pitch_deg, shown.yaw_deg) = (wobble, -wobble, wobble);
        shown.altitude_m += wobble;
    };
    let rises = || taking_off(Order::ByItself, 0.3);
    // The ultrasound for three seconds, and the flow for as long as the motors need.
    assert_eq!(sees_again_s(&mut rises(), turns), Some(TAKE_OFF_S));
    assert_eq!(sees_again_s(&mut rises(), turns_and_rises), None);
    // Attitude and compass need no floor.
    assert_eq!(frozen_at_s(&mut rises()), Some(others_s));
    assert_eq!(frozen_at_s(&mut taking_off(Order::ByItself, 0.5)), Some(flow_s));
    let at_limit = &mut taking_off(Order::ByItself, CLEAR_OF_GROUND_M);
    assert_eq!(frozen_at_s(at_limit), Some(flow_s));
    let by_sticks = sticks(Sticks::default());
    assert_eq!(frozen_at_s(&mut taking_off(by_sticks, 0.3)), Some(flow_s));
    // Each take-off has its time.
    let mut again = rises();
    sees_again_s(&mut again, turns);
    again.shown.airborne = false;
    again.fly(80);
    assert_eq!(again.estimator.trust(), Trust::Sound);
    again.shown.airborne = true;
    assert_eq!(sees_again_s(&mut again, turns), Some(TAKE_OFF_S));
}

#[test]
fn a_drone_that_follows_its_sticks_does_not_scrape_along_the_floor() {
    let low = |altitude_m: f64, order: Order, airborne: bool| {
        let mut flight = Flight::new(&EstimatorConfig::default());
        flight.shown.altitude_m = 0.5;
        flight.fly(32);
        flight.shown.airborne = airborne;
        // It sinks to this height by itself.
        for step in 1..=16 {
            let share = f64::from(step) / 16.0;
            flight.shown.altitude_m = 0.5 + (altitude_m - 0.5) * share;
            flight.step();
        }
        flight.order = order;
        distrusted(&mut flight, 32)
    };
    let level = sticks(Sticks::default());
    let (at_s, trust) = low(0.05, level, true).unwrap();
    assert_eq!(trust, Trust::Unresponsive(Quantity::Altitude));
    // 0.4 s, once the order is in effect.
    assert!((0.45..0.6).contains(&at_s), "{at_s}");
    assert_eq!(low(ON_FLOOR_M, level, true), None);
    assert_eq!(low(0.05, Order::ByItself, true), None);
    assert_eq!(low(0.05, level, false), None);
    // For exactly this time, and below exactly this height.
    for (altitude_m, trust) in
        [(0.05, Trust::Unresponsive(Quantity::Altitude)), (ON_FLOOR_M, Trust::Sound)]
    {
        let (dead_time, attitude_delay) = (Duration::ZERO, Duration::ZERO);
        let config = EstimatorConfig { dead_time, attitude_delay, ..EstimatorConfig::default() };
        let mut estimator = Estimator::new(config);
        estimator.order_sent(Duration::ZERO, level);
        for tenth in 0..=4_u32 {
            let wobble = 1e-3 * f64::from(tenth);
            assert_eq!(estimator.trust(), Trust::Sound);
            estimator.update(&Sample {
                arrival: Duration::from_millis(100) * tenth,
                altitude_m,
                velocity_forward_m_s: wobble,
                velocity_right_m_s: wobble,
                airborne: true,
                ..Sample::default()
            });
        }
        assert_eq!(estimator.trust(), trust);
    }
}

#[test]
fn a_height_that_does_not_follow_the_sticks_is_noticed() {
    let mut flight = hovering();
    flight.order = sticks(Sticks { gaz: 1.0, ..Sticks::default() });
    let (_, trust) = distrusted(&mut flight, 40).unwrap();
    assert_eq!(trust, Trust::Unresponsive(Quantity::Altitude));
    // A frozen one is known to be frozen before.
    let mut flight = hovering();
    flight.order = sticks(Sticks { gaz: 1.0, ..Sticks::default() });
    let frozen = |flight: &mut Flight| {
        (0..40_u32).find_map(|i| {
            flight.packet += 1;
            flight.estimator.order_sent(flight.now(), flight.order);
            let wobble = 1e-4 * f64::from(i % 3);
            flight.estimator.update(&Sample {
                arrival: flight.now(),
                yaw_deg: wobble,
                roll_deg: wobble,
                pitch_deg: wobble,
                velocity_forward_m_s: wobble,
                velocity_right_m_s: wobble,
                ..flight.shown
            });
            let trust = flight.estimator.trust();
            (trust == Trust::Frozen(Quantity::Altitude)).then(|| 0.0625 * f64::from(i))
        })
    };
    let at_s = frozen(&mut flight).unwrap();
    assert!((0.9..1.1).contains(&at_s), "{at_s}");
}

#[test]
fn one_wrong_echo_does_not_lift_a_drone_that_stands() {
    let mut estimator = Estimator::default();
    let mut stand = |packet: u32, altitude_m: f64| {
        let arrival = Duration::from_millis(66) * packet;
        estimator.update(&Sample { arrival, altitude_m, ..Sample::default() });
        estimator.standing_altitude_m()
    };
    let read_m = [0.02, 2.4, 0.03, 1.1, 1.2];
    let seen_m: Vec<_> = (0..).zip(read_m).map(|(packet, m)| stand(packet, m)).collect();
    assert_eq!(seen_m, [0.02, 0.02, 0.03, 0.03, 1.1].map(Some));
    assert_eq!(Estimator::default().standing_altitude_m(), None);
}

#[test]
fn motors_may_take_as_long_as_they_like_to_lift_the_drone() {
    let mut flight = taking_off(Order::ByItself, 0.0);
    flight.shown.autonomous = true;
    // Every sensor rattles but the flow, which has nothing to see; now and then an echo is wrong.
    let mut step = |autonomous: bool, i: u32| {
        let rattle = 0.01 * f64::from(i % 3);
        flight.packet += 1;
        flight.estimator.update(&Sample {
            arrival: flight.now(),
            yaw_deg: rattle,
            roll_deg: rattle,
            pitch_deg: -rattle,
            altitude_m: if i % 30 == 17 { 0.6 } else { rattle },
            autonomous,
            ..flight.shown
        });
        flight.estimator.trust()
    };
    for i in 0..100 {
        assert_eq!(step(true, i), Trust::Sound, "{i}");
    }
    assert!((100..110).any(|i| step(false, i) == Trust::Frozen(Quantity::Velocity)));
}
