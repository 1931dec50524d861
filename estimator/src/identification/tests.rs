#![expect(clippy::float_cmp, reason = "the very same number, not a near one")]

use std::time::Duration;

use super::*;

const LIMITS: DroneLimits = DroneLimits { tilt_rad: 0.2, climb_m_s: 0.7, turn_deg_s: 100.0 };

fn gaz(gaz: f64) -> Order {
    Order::Sticks(Sticks { gaz, ..Sticks::default() })
}

/// Sticks in turns of 0.7 s: there and back, by different amounts.
fn in_turns(at_s: f64, most: f64) -> f64 {
    match at_s % 2.8 {
        ..0.7 => most,
        ..1.4 => -most,
        ..2.1 => most * 0.6,
        _ => -most * 0.6,
    }
}

/// Time between measurements: eight of them are exactly the window.
const PERIOD: Duration = Duration::from_micros(62_500);

/// A drone with this airframe.
#[derive(Default)]
struct Truth {
    climb_m_s: f64,
    height_m: f64,
    tilt_rad: Vector2<f64>,
    turn_deg_s: f64,
    yaw_deg: f64,
    velocity_m_s: Vector2<f64>,
}

impl Truth {
    /// Flies for a period.
    fn fly(&mut self, sticks: Sticks, airframe: &Airframe) {
        const STEPS: u32 = 60;
        let step_s = PERIOD.as_secs_f64() / f64::from(STEPS);
        for _ in 0..STEPS {
            let gain = if sticks.gaz > 0.0 { airframe.climb_gain } else { airframe.drop_gain };
            let wanted_m_s = sticks.gaz * LIMITS.climb_m_s * gain;
            self.climb_m_s += (wanted_m_s - self.climb_m_s) * step_s / airframe.climb_lag_s;
            self.height_m += self.climb_m_s * step_s;
            let most = LIMITS.tilt_rad;
            let wanted = sticks.tilt().map(|s| (s * most * airframe.tilt_gain).clamp(-most, most));
            self.tilt_rad += (wanted - self.tilt_rad) * (step_s / airframe.tilt_lag_s);
            let wanted_deg_s = sticks.yaw * LIMITS.turn_deg_s * airframe.turn_gain;
            self.turn_deg_s += (wanted_deg_s - self.turn_deg_s) * step_s / airframe.turn_lag_s;
            self.yaw_deg += self.turn_deg_s * step_s;
            let pull = self.tilt_rad.map(|angle_rad| GRAVITY_M_S2 * angle_rad.tan());
            let m_s2 = pull.component_mul(&airframe.thrust_gain)
                - self.velocity_m_s.component_mul(&airframe.drag_1_s);
            self.velocity_m_s += m_s2 * step_s;
        }
    }
}

/// Flies a drone for some seconds, and identifies it from what it measures.
fn identified(airframe: &Airframe, seconds: u32, sticks: impl Fn(f64) -> Sticks) -> Airframe {
    identified_while(|_| *airframe, seconds, sticks)
}

/// The same of a drone that changes.
fn identified_while(
    airframe: impl Fn(f64) -> Airframe,
    seconds: u32,
    sticks: impl Fn(f64) -> Sticks,
) -> Airframe {
    let mut identification = Identification::new(Airframe::default(), LIMITS);
    let (mut truth, mut orders) = (Truth::default(), Orders::new(Duration::ZERO));
    for step in 0..16 * seconds {
        let now = PERIOD * step;
        let at_s = now.as_secs_f64();
        orders.push(now, Order::Sticks(sticks(at_s)));
        identification.height(at_s, 3.0 + truth.height_m, &orders);
        identification.tilt(at_s, truth.tilt_rad, &orders);
        identification.heading(at_s, 40.0 + truth.yaw_deg, &orders);
        identification.velocity(at_s, truth.velocity_m_s, 0.0, &orders);
        truth.fly(sticks(at_s), &airframe(at_s));
    }
    *identification.airframe()
}

fn assert_share(found: f64, truth: f64, share: f64) {
    assert!((found / truth - 1.0).abs() < share, "{found} is not {truth}");
}

#[test]
fn climb_is_identified_upwards_and_downwards() {
    for (climb_gain, drop_gain, climb_lag_s) in [(1.5, 0.8, 0.38), (0.7, 1.6, 0.72)] {
        let truth = Airframe { climb_gain, drop_gain, climb_lag_s, ..Airframe::default() };
        let found =
            identified(&truth, 60, |at_s| Sticks { gaz: in_turns(at_s, 0.8), ..Sticks::default() });
        assert_share(found.climb_gain, climb_gain, 0.05);
        assert_share(found.drop_gain, drop_gain, 0.05);
        assert_share(found.climb_lag_s, climb_lag_s, 0.1);
        let untouched = Airframe {
            climb_gain: found.climb_gain,
            drop_gain: found.drop_gain,
            climb_lag_s: found.climb_lag_s,
            tilt_gain: found.tilt_gain,
            tilt_lag_s: found.tilt_lag_s,
            ..Airframe::default()
        };
        assert_eq!(found, untouched, "nothing else was excited");
    }
}

#[test]
fn tilt_and_turn_are_identified_on_their_axes() {
    for axis in 0..2 {
        for (gain, tilt_lag_s, turn_lag_s) in [(0.7, 0.19, 0.35), (1.3, 0.09, 0.1)] {
            let truth = Airframe {
                tilt_gain: gain,
                tilt_lag_s,
                turn_gain: gain,
                turn_lag_s,
                ..Airframe::default()
            };
            let found = identified(&truth, 60, |at_s| {
                let stick = in_turns(at_s, 0.6);
                let [roll, pitch] = if axis == 0 { [stick, 0.0] } else { [0.0, stick] };
                Sticks { roll, pitch, yaw: in_turns(at_s, 0.5), ..Sticks::default() }
            });
            assert_share(found.tilt_gain, gain, 0.03);
            assert_share(found.tilt_lag_s, tilt_lag_s, 0.15);
            assert_share(found.turn_gain, gain, 0.03);
            assert_share(found.turn_lag_s, turn_lag_s, 0.1);
        }
    }
}

#[test]
fn thrust_and_drag_are_identified_for_each_axis() {
    // By the tilt that this drone has, not an ordinary one.
    let truth = Airframe {
        tilt_gain: 0.8,
        thrust_gain: Vector2::new(0.7, 1.2),
        drag_1_s: Vector2::new(1.4, 0.8),
        ..Airframe::default()
    };
    let found = identified(&truth, 120, |at_s| Sticks {
        roll: in_turns(at_s, 0.9),
        pitch: in_turns(at_s * 0.6, 0.9),
        ..Sticks::default()
    });
    for axis in 0..2 {
        assert_share(found.thrust_gain[axis], truth.thrust_gain[axis], 0.05);
        assert_share(found.drag_1_s[axis], truth.drag_1_s[axis], 0.2);
    }
}

#[test]
fn a_small_excitation_teaches_nothing() {
    // Within half a second at most: 0.04 m of climb, 4 degrees of turn, 0.035 rad of tilt.
    let truth = Airframe { climb_gain: 2.0, turn_gain: 2.0, tilt_gain: 0.5, ..Airframe::default() };
    let turning = |gaz: f64, yaw: f64, roll: f64| {
        let turn = move |at_s: f64| if at_s % 6.0 < 3.0 { 1.0 } else { 0.0 };
        identified(&truth, 30, move |at_s| Sticks {
            gaz: gaz * turn(at_s),
            yaw: yaw * turn(at_s),
            roll: roll * turn(at_s),
            ..Sticks::default()
        })
    };
    let quiet = turning(0.11, 0.079, 0.17);
    let unmoved = turning(0.0, 0.0, 0.0);
    assert_eq!(quiet, unmoved);
    let moved = turning(0.12, 0.0, 0.0);
    assert!(moved.climb_gain > 1.01 && moved.climb_lag_s != unmoved.climb_lag_s, "{moved:?}");
    let moved = turning(0.0, 0.083, 0.0);
    assert!(moved.turn_gain > 1.01, "{moved:?}");
    let moved = turning(0.0, 0.0, 0.18);
    assert!(moved.tilt_gain < 0.99, "{moved:?}");
}

/// Velocities without tilt, or tilts of a drone that stands, for three seconds.
fn identified_by(body_m_s: f64, roll: f64, yaw_deg: impl Fn(f64) -> f64) -> Airframe {
    let mut identification = Identification::new(Airframe::default(), LIMITS);
    let mut orders = Orders::new(Duration::ZERO);
    orders.push(Duration::ZERO, Order::Sticks(Sticks { roll, ..Sticks::default() }));
    for step in 0..48 {
        let at_s = (PERIOD * step).as_secs_f64();
        let body_m_s = Vector2::new(body_m_s * (1.0 - at_s / 10.0), 0.0);
        identification.velocity(at_s, body_m_s, yaw_deg(at_s), &orders);
    }
    *identification.airframe()
}

#[test]
fn thrust_and_drag_need_a_quarter_of_a_metre_per_second() {
    let straight = |_| 0.0;
    // Of the way within half a second, or of the velocity that gravity gives at the tilt.
    assert_eq!(identified_by(0.49, 0.0, straight), Airframe::default());
    assert!(identified_by(0.55, 0.0, straight).drag_1_s.x != 0.5);
    let stick = |m_s2: f64| (m_s2 / GRAVITY_M_S2).atan() / LIMITS.tilt_rad;
    assert_eq!(identified_by(0.0, stick(0.49), straight), Airframe::default());
    assert!(identified_by(0.0, stick(0.51), straight).thrust_gain.x < 1.0);
    assert!(identified_by(0.0, -stick(0.51), straight).thrust_gain.x < 1.0);
}

#[test]
fn a_window_in_which_the_drone_turns_teaches_nothing_of_thrust() {
    // Beyond 10 degrees a new window begins, so at 20 degrees per second it is just full.
    let turning = |deg_s: f64| identified_by(2.0, 0.0, move |at_s| deg_s * at_s);
    assert_eq!(turning(25.0), Airframe::default());
    assert_eq!(turning(-25.0), Airframe::default());
    assert!(identified_by(2.0, 0.0, |_| 40.0) != Airframe::default(), "it may face anywhere");
    for deg_s in [16.0, -16.0, 20.0, -20.0] {
        assert!(turning(deg_s) != Airframe::default(), "{deg_s}");
    }
}

#[test]
fn the_wind_may_blow_from_another_side_after_a_turn() {
    // It looks the other way every 20 s, in a wind of 1 m/s² that holds it back in the world; it leans against it.
    let mut identification = Identification::new(Airframe::default(), LIMITS);
    let mut orders = Orders::new(Duration::ZERO);
    let mut truth = Truth::default();
    let mut worst = 0.0_f64;
    for step in 0..16 * 120 {
        let now = PERIOD * step;
        let at_s = now.as_secs_f64();
        let looks_back = at_s % 40.0 >= 20.0;
        let (side, yaw_deg) = if looks_back { (-1.0, 180.0) } else { (1.0, 0.0) };
        let roll = (0.5 * side + in_turns(at_s, 0.3)).clamp(-1.0, 1.0);
        let sticks = Sticks { roll, ..Sticks::default() };
        orders.push(now, Order::Sticks(sticks));
        identification.tilt(at_s, truth.tilt_rad, &orders);
        identification.velocity(at_s, truth.velocity_m_s, yaw_deg, &orders);
        truth.fly(sticks, &Airframe::default());
        truth.velocity_m_s.x -= side * PERIOD.as_secs_f64();
        worst = worst.max((identification.airframe().thrust_gain.x - 1.0).abs());
    }
    assert!(worst < 0.4, "{worst}");
}

#[test]
fn gains_stay_within_those_of_known_airframes() {
    let sticks = |at_s| Sticks {
        gaz: in_turns(at_s, 1.0),
        yaw: in_turns(at_s, 1.0),
        roll: in_turns(at_s, 0.3),
        pitch: in_turns(at_s, 0.3),
    };
    let strong = Airframe {
        climb_gain: 5.0,
        drop_gain: 5.0,
        turn_gain: 5.0,
        tilt_gain: 5.0,
        drag_1_s: Vector2::new(9.0, 9.0),
        ..Airframe::default()
    };
    let found = identified(&strong, 120, sticks);
    assert_eq!([found.climb_gain, found.drop_gain, found.turn_gain], [MAX_GAIN; 3]);
    let weak = Airframe {
        climb_gain: 0.1,
        drop_gain: 0.1,
        turn_gain: 0.1,
        tilt_gain: 0.1,
        ..Airframe::default()
    };
    let found = identified(&weak, 120, sticks);
    assert_eq!([found.climb_gain, found.drop_gain, found.turn_gain], [MIN_GAIN; 3]);
}

/// The gain that is identified of a drone with gain 0.8 whose stick goes to and fro.
fn swung(stick: f64) -> f64 {
    let truth = Airframe { tilt_gain: 0.8, ..Airframe::default() };
    let to_and_fro = |at_s| if at_s % 1.4 < 0.7 { stick } else { -stick };
    let [roll, pitch] = [
        identified(&truth, 20, |at_s| Sticks { roll: to_and_fro(at_s), ..Sticks::default() }),
        identified(&truth, 20, |at_s| Sticks { pitch: to_and_fro(at_s), ..Sticks::default() }),
    ]
    .map(|found| found.tilt_gain);
    assert_share(roll, pitch, 1e-9);
    roll
}

#[test]
fn a_tilt_at_the_limit_says_nothing_of_the_gain() {
    for stick in [0.5, 1.0, -1.0] {
        assert_share(swung(stick), 0.8, 0.05);
    }
    // First with half stick, then with this one.
    let found = |gain_later: f64, stick: f64| {
        let airframe = |at_s| Airframe {
            tilt_gain: if at_s < 10.0 { 1.5 } else { gain_later },
            ..Airframe::default()
        };
        let to_and_fro = |at_s| if at_s % 1.4 < 0.7 { 1.0 } else { -1.0 };
        let sticks = |at_s| Sticks {
            roll: to_and_fro(at_s) * if at_s < 10.0 { 0.5 } else { stick },
            ..Sticks::default()
        };
        identified_while(airframe, 60, sticks).tilt_gain
    };
    assert_share(found(1.5, 1.0), 1.5, 0.05);
    // A gain that falls is noticed all the same.
    assert!(found(1.0, 0.9) < 1.2);
}

#[test]
fn what_the_drone_does_by_itself_teaches_nothing() {
    let mut identification = Identification::new(Airframe::default(), LIMITS);
    let mut orders = Orders::new(Duration::ZERO);
    let before = identification.clone();
    for step in 0..160_u32 {
        let now = PERIOD * step;
        let at_s = now.as_secs_f64();
        // The window is never full.
        let by_itself = step % 12 < 4;
        let sticks = Sticks { gaz: 1.0, yaw: 1.0, roll: 1.0, ..Sticks::default() };
        orders.push(now, if by_itself { Order::ByItself } else { Order::Sticks(sticks) });
        identification.height(at_s, at_s, &orders);
        identification.tilt(at_s, Vector2::new(at_s, at_s), &orders);
        identification.heading(at_s, 30.0 * at_s, &orders);
        identification.velocity(at_s, Vector2::new(at_s, at_s), 0.0, &orders);
    }
    let (lag_s, gains) = before.tilt.bank.estimate();
    let (tilt_lag_s, tilt_gain) = (lag_s, gains.x);
    assert_eq!(
        *identification.airframe(),
        Airframe { tilt_lag_s, tilt_gain, ..Airframe::default() }
    );
}

#[test]
fn a_window_compares_the_newest_with_half_a_second_before() {
    let mut window = Window::<1, 1>::new();
    let mut change = |at_s: f64| {
        let causes = [SVector::<f64, 1>::new(2.0 * at_s)];
        let change = window.change(Answer { at_s, value: 10.0 + at_s, causes })?;
        assert_eq!(change.causes[0].x, 2.0 * change.value);
        assert_eq!(change.at_s, at_s);
        Some(change.value)
    };
    assert_eq!([0.0, 0.25].map(&mut change), [None, None]);
    // The newest one that is old enough, however long ago.
    assert_eq!([0.5, 0.625, 0.75].map(&mut change), [Some(0.5), Some(0.625), Some(0.5)]);
    assert_eq!(change(2.0), Some(1.25));
    // Two are kept, and the old one of them until there is no room.
    for i in 0..1000 {
        assert_eq!(change(2.0 + i as f64 / 1024.0).is_some(), 3 + i <= MEMORY, "{i}");
    }
}

#[test]
fn followers_lag_behind_the_sticks_and_integrate() {
    let lags_s = [0.2, 0.5];
    let mut followers = Followers::<2, 1>::new(lags_s);
    let mut orders = Orders::new(Duration::ZERO);
    orders.push(Duration::ZERO, gaz(0.5));
    orders.push(Duration::from_secs(2), Order::ByItself);
    let asked = |sticks: Sticks| SVector::<f64, 1>::new(2.0 * sticks.gaz);
    // The first call sets the time.
    followers.advance(0.5, &orders, asked);
    assert_eq!(followers.value[0].x, 0.0);
    followers.advance(0.9, &orders, asked);
    for (i, lag_s) in lags_s.into_iter().enumerate() {
        let reached = 1.0 - (-0.4_f64 / lag_s).exp();
        assert!((followers.value[i].x - reached).abs() < 1e-9);
        let way = 0.4 - lag_s * reached;
        assert!((followers.way[i].x - way).abs() < 1e-4, "{}, {way}", followers.way[i].x);
    }
    // They rest at once, and begin again from there; their ways go on.
    let way = followers.way;
    followers.rest(1.5);
    followers.advance(1.6, &orders, asked);
    for (i, lag_s) in lags_s.into_iter().enumerate() {
        let reached = 1.0 - (-0.1_f64 / lag_s).exp();
        assert!((followers.value[i].x - reached).abs() < 1e-9);
        let went = followers.way[i].x - way[i].x;
        assert!((went - (0.1 - lag_s * reached)).abs() < 1e-4, "{went}");
    }
    followers.advance(2.0, &orders, asked);
    let before = followers.value[0].x;
    followers.advance(2.2, &orders, asked);
    assert!((followers.value[0].x - before * (-1_f64).exp()).abs() < 1e-9, "by itself");
}
