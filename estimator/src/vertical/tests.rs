use super::*;
use kinematics::Sticks;

const STEP_S: f64 = 0.066;

fn run(filter: &mut AltitudeFilter, altitudes_m: impl IntoIterator<Item = f64>) -> Vec<Echo> {
    let (airframe, limits) = (Airframe::default(), DroneLimits::default());
    let step_s = STEP_S;
    let mut echoes = Vec::new();
    for altitude_m in altitudes_m {
        let mut expected = filter.state();
        expected.advance(step_s, Order::ByItself, &airframe, &limits);
        echoes.push(filter.correct(altitude_m, expected, step_s, Order::ByItself));
    }
    echoes
}

#[test]
fn a_steady_climb_is_followed_without_lag() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, (0..100).map(|i| 0.5 * 0.066 * f64::from(i)));
    let state = filter.state();
    assert!((state.climb_m_s - 0.5).abs() < 0.01, "{state:?}");
    assert!((state.height_m - 0.5 * 0.066 * 99.0).abs() < 0.01, "{state:?}");
}

#[test]
fn what_the_sticks_do_is_known_at_once() {
    let (airframe, limits) = (Airframe::default(), DroneLimits::default());
    let order = Order::Sticks(Sticks { gaz: 1.0, ..Sticks::default() });
    let (mut truth, mut filter) = (Vertical::default(), AltitudeFilter::default());
    filter.correct(0.0, truth, 0.0, order);
    for _ in 0..60 {
        truth.advance(0.04, order, &airframe, &limits);
        let mut expected = filter.state();
        expected.advance(0.04, order, &airframe, &limits);
        filter.correct(truth.height_m, expected, 0.04, order);
        assert!((filter.state().climb_m_s - truth.climb_m_s).abs() < 1e-9);
    }
}

#[test]
fn wrong_echoes_are_ignored() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, [1.0; 50]);
    let echoes = run(&mut filter, [2.5, 1.0, 0.3, 0.7, 1.0]);
    assert_eq!(echoes, [Echo::Wrong, Echo::Good, Echo::Wrong, Echo::Wrong, Echo::Good]);
    assert!((filter.state().height_m - 1.0).abs() < 0.01);
}

/// Standard deviation of the height that was measured now.
fn now_m(filter: &AltitudeFilter) -> f64 {
    filter.uncertainty_m(0.0, Order::Sticks(Sticks::default()))
}

/// One echo from a filter that has received nothing for `gap_s`.
fn after_a_gap(filter: &mut AltitudeFilter, gap_s: f64, altitude_m: f64) -> Echo {
    let expected = filter.state();
    filter.correct(altitude_m, expected, gap_s, Order::ByItself)
}

#[test]
fn a_wrong_echo_behind_a_gap_is_ignored_too() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, [1.0; 50]);
    assert_eq!(after_a_gap(&mut filter, 0.4, 1.4), Echo::Wrong);
    assert!(now_m(&filter) > 0.39, "it is still undecided");
    // Nor does a single one decide it that is beside the expected height.
    assert_eq!(run(&mut filter, [1.0]), [Echo::Wrong]);
    assert!(now_m(&filter) > AltitudeFilter::AGREEMENT_M, "it is undecided still");
    assert_eq!(run(&mut filter, [1.0; 10]), [Echo::Good; 10]);
    assert!((filter.state().height_m - 1.0).abs() < 0.01);
    assert!(now_m(&filter) < ULTRASOUND_M);
}

/// The drone landed by itself in the gap, and the first echo is a wrong one, just at the height where it was expected.
#[test]
fn a_wrong_echo_at_the_expected_height_behind_a_gap_makes_no_floor_step_of_a_descent() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, [1.2; 50]);
    after_a_gap(&mut filter, 5.0, 1.15);
    for below_m in [0.73, 0.72, 0.70, 0.67, 0.65, 0.62] {
        let expected = filter.state();
        assert_ne!(filter.correct(below_m, expected, STEP_S, Order::ByItself), Echo::FloorStep);
    }
    let off_m = (filter.state().height_m - 0.62).abs();
    assert!(off_m < 3.0 * now_m(&filter), "{off_m} m, {} m told", now_m(&filter));
}

/// What the model makes of an order the airframe may not: how far it is off is known meanwhile.
#[test]
fn an_airframe_that_follows_an_order_later_than_the_model_flies_over_no_box() {
    let (airframe, limits) = (Airframe::default(), DroneLimits::default());
    let climbs = Order::Sticks(Sticks { gaz: 1.0, ..Sticks::default() });
    let mut filter = hovering(0.85);
    let mut truth = still(0.85);
    for step in 0..20_u32 {
        let mut expected = filter.state();
        expected.advance(STEP_S, climbs, &airframe, &limits);
        // It follows half a second later.
        truth.advance(STEP_S, if step < 8 { Order::ByItself } else { climbs }, &airframe, &limits);
        let echo = filter.correct(truth.height_m, expected, STEP_S, climbs);
        assert_ne!(echo, Echo::FloorStep, "at step {step}");
        let off_m = (filter.state().height_m - truth.height_m).abs();
        assert!(
            off_m < 3.0 * now_m(&filter),
            "at step {step}: {off_m} m, {} m told",
            now_m(&filter)
        );
    }
}

#[test]
fn what_was_climbed_in_a_gap_is_believed_with_the_second_echo() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, [1.0; 50]);
    // With half a metre per second.
    assert_eq!(after_a_gap(&mut filter, 0.4, 1.2), Echo::Wrong);
    assert_eq!(run(&mut filter, [1.2; 20]), [Echo::Good; 20]);
    let height_m = filter.state().height_m;
    assert!((height_m - 1.2).abs() < 0.01, "{height_m}");
    // Without a gap the same height is a step of the floor.
    assert!(run(&mut filter, [1.4; 5]).contains(&Echo::FloorStep));
}

#[test]
fn a_descent_that_began_in_a_gap_is_believed() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, (0..50).map(|i| 0.5 * 0.066 * f64::from(i)));
    let top_m = filter.state().height_m;
    // The model climbs on; the drone has reversed and sinks.
    let expected = Vertical { height_m: top_m + 0.2, climb_m_s: 0.5 };
    assert_eq!(filter.correct(top_m - 0.1, expected, 0.4, Order::ByItself), Echo::Wrong);
    let sinks = (1..20).map(|i| top_m - 0.1 - 0.4 * 0.066 * f64::from(i));
    let echoes = run(&mut filter, sinks);
    assert!(!echoes.contains(&Echo::FloorStep), "{echoes:?}");
    let state = filter.state();
    assert!((state.height_m - (top_m - 0.1 - 0.4 * 0.066 * 19.0)).abs() < 0.1, "{state:?}");
}

#[test]
fn a_wrong_echo_is_no_height_to_begin_with() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, [0.4, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0]);
    let height_m = filter.state().height_m;
    assert!((height_m - 2.0).abs() < 0.05, "{height_m}");
    assert!((filter.above_floor_m(height_m) - 2.0).abs() < 0.05);
}

#[test]
fn over_a_table_the_height_above_the_start_goes_on() {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, [1.5; 50]);
    let echoes = run(&mut filter, [0.8; 20]);
    assert!(echoes.contains(&Echo::FloorStep));
    let height_m = filter.state().height_m;
    assert!((height_m - 1.5).abs() < 0.02, "{height_m}");
    assert!((filter.above_floor_m(height_m) - 0.8).abs() < 0.02);
    run(&mut filter, [1.5; 20]);
    assert!((filter.above_floor_m(filter.state().height_m) - 1.5).abs() < 0.02);
}

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
}

#[test]
fn a_climb_follows_its_stick_with_the_gain_of_its_direction() {
    let airframe = Airframe { climb_gain: 1.5, drop_gain: 0.8, ..Airframe::default() };
    let limits = DroneLimits::default();
    let (step_s, followed) = (airframe.climb_lag_s, 1.0 - (-1_f64).exp());
    for (gaz, gain) in [(0.5, 1.5), (-0.5, 0.8)] {
        let mut state = Vertical { height_m: 1.0, climb_m_s: 0.1 };
        let order = Order::Sticks(Sticks { gaz, ..Sticks::default() });
        state.advance(step_s, order, &airframe, &limits);
        let climb_m_s = 0.1 + (gaz * limits.climb_m_s * gain - 0.1) * followed;
        assert_near(state.climb_m_s, climb_m_s);
        assert_near(state.height_m, 1.0 + f64::midpoint(0.1, climb_m_s) * step_s);
    }
    // By itself a drone goes on as it was.
    let mut state = Vertical { height_m: 1.0, climb_m_s: 0.4 };
    state.advance(0.5, Order::ByItself, &airframe, &limits);
    assert_near(state.climb_m_s, 0.4);
    assert_near(state.height_m, 1.2);
}

/// A filter that hovers at this height, all of whose heights agreed.
fn hovering(height_m: f64) -> AltitudeFilter {
    let mut filter = AltitudeFilter::default();
    run(&mut filter, [height_m; 50]);
    filter
}

fn still(height_m: f64) -> Vertical {
    Vertical { height_m, climb_m_s: 0.0 }
}

#[test]
fn the_longer_a_height_was_not_measured_the_more_the_next_one_counts() {
    let corrected_m = |order, step_s| {
        let mut filter = hovering(1.0);
        // Behind a gap a first one confirms nothing.
        filter.correct(1.09, still(1.0), step_s, order);
        if step_s > STEP_S {
            assert_eq!(filter.correct(1.09, still(1.0), STEP_S, order), Echo::Good);
        }
        filter.state().height_m - 1.0
    };
    let by_sticks = Order::Sticks(Sticks::default());
    let usual_m = corrected_m(by_sticks, STEP_S);
    assert!((0.025..0.035).contains(&usual_m), "{usual_m}");
    assert!(corrected_m(Order::ByItself, STEP_S) > usual_m);
    let late_m = corrected_m(by_sticks, 0.5);
    assert!((0.08..0.09).contains(&late_m), "{late_m}");
    // A height of the same instant has no weight.
    let mut filter = hovering(1.0);
    let before = filter.state();
    assert_eq!(filter.correct(1.1, before, 0.0, by_sticks), Echo::Good);
    assert_near(filter.state().height_m, before.height_m);
    assert_near(filter.state().climb_m_s, before.climb_m_s);
}

#[test]
fn the_covariance_is_that_of_a_climb_with_white_disturbances() {
    let mut filter = AltitudeFilter::default();
    filter.begin(1.0);
    let (noise_m2, begins_m2_s2) = (ULTRASOUND_M.powi(2), AltitudeFilter::BY_ITSELF_M_S.powi(2));
    // In a tenth of a second the climb changes by white noise, and nothing was missed.
    filter.correct(1.0, still(1.0), 0.1, Order::Sticks(Sticks::default()));
    let changed_m2_s3 = AltitudeFilter::STEERED_M_S.powi(2);
    let moved_m2 = noise_m2 + 0.01 * begins_m2_s2 + changed_m2_s3 * 0.001 / 3.0;
    let both_m2_s = 0.1 * begins_m2_s2 + changed_m2_s3 * 0.01 / 2.0;
    let climbs_m2_s2 = begins_m2_s2 + changed_m2_s3 * 0.1;
    let surprise_m2 = moved_m2 + noise_m2;
    let [[height, both, _], [same, climb, _], floor] = filter.covariance.data.0;
    assert_near(height, moved_m2 * noise_m2 / surprise_m2);
    assert_near(both, both_m2_s * noise_m2 / surprise_m2);
    assert_near(same, both);
    assert_near(climb, climbs_m2_s2 - both_m2_s * both_m2_s / surprise_m2);
    for of_the_start in floor {
        assert_near(of_the_start, 0.0);
    }
}

#[test]
fn a_height_may_be_off_by_the_noise_of_the_ultrasound() {
    for sign in [-1.0, 1.0] {
        for (off_m, echo) in [(0.099, Echo::Good), (0.101, Echo::Wrong)] {
            let mut filter = hovering(2.0);
            let found = filter.correct(2.0 + sign * off_m, still(2.0), 0.05, Order::ByItself);
            assert_eq!(found, echo, "{off_m} m");
        }
    }
}

#[test]
fn a_gap_explains_no_more_than_a_climb_through_it() {
    let order = Order::Sticks(Sticks::default());
    let after = |gap_s: f64, rise_m: f64| {
        let mut filter = hovering(1.0);
        assert_eq!(filter.correct(1.0 + rise_m, still(1.0), gap_s, order), Echo::Wrong);
        filter.correct(1.0 + rise_m, still(1.0), 0.05, order)
    };
    // Three standard deviations, most of them those of an unheard climb of 0.9 m/s with a lag of half a second. What counts is
    // the gap before the first of the heights.
    let changed_s = |gap_s: f64| gap_s - 0.5 * (1.0 - (-2.0 * gap_s).exp());
    for gap_s in [0.5, 1.0, 2.0] {
        let most_m = 3.0 * 0.9 * changed_s(gap_s - 0.1);
        assert_eq!(after(gap_s, 0.9 * most_m), Echo::Good, "{gap_s} s");
        assert_eq!(after(gap_s, 1.3 * most_m), Echo::Wrong, "{gap_s} s");
    }
    // Without a gap it takes four heights to make a floor, of a low box, too.
    for off_m in [0.59, -0.15] {
        let mut filter = hovering(1.0);
        let mut next = || filter.correct(1.0 + off_m, still(1.0), 0.05, order);
        let echoes = [next(), next(), next(), next()];
        assert_eq!(echoes, [Echo::Wrong, Echo::Wrong, Echo::Wrong, Echo::FloorStep]);
        let state = filter.state();
        assert!((filter.above_floor_m(state.height_m) - 1.0 - off_m).abs() < 0.005);
        assert!((state.height_m - 1.0).abs() < 0.02, "of 0.15 m a tenth may be a climb");
    }
}

#[test]
fn a_floor_is_agreed_on_by_heights_or_by_their_differences() {
    let floor = |heights_m: [(f64, f64); 4]| {
        let mut filter = hovering(2.0);
        heights_m.map(|(expected_m, height_m)| {
            filter.correct(height_m, still(expected_m), 0.05, Order::ByItself)
        })
    };
    // The model climbs and the drone hovers over a table.
    let hovers = [(2.0, 1.3), (2.15, 1.3), (2.3, 1.3), (2.45, 1.3)];
    assert_eq!(floor(hovers)[3], Echo::FloorStep);
    // Both climb.
    let climbs = [(2.0, 1.3), (2.2, 1.5), (2.4, 1.7), (2.6, 1.9)];
    assert_eq!(floor(climbs)[3], Echo::FloorStep);
    // The heights agree with nothing.
    let random = [(2.0, 1.3), (2.0, 1.5), (2.0, 1.3), (2.0, 1.5)];
    assert_eq!(floor(random), [Echo::Wrong; 4]);
    // The one that disagrees begins a new count of four.
    let late = [(2.0, 0.6), (2.0, 1.3), (2.0, 1.3), (2.0, 1.3)];
    assert_eq!(floor(late), [Echo::Wrong; 4]);
    // A tenth of a metre is near enough, more is not.
    let near = [(2.0, 1.0), (2.0, 1.09), (2.0, 1.0), (2.0, 1.09)];
    assert_eq!(floor(near)[3], Echo::FloorStep);
    let far = [(2.0, 1.0), (2.0, 1.11), (2.0, 1.0), (2.0, 1.11)];
    assert_eq!(floor(far), [Echo::Wrong; 4]);
}

#[test]
fn a_drone_that_stands_is_on_the_floor_of_the_start() {
    let mut filter = hovering(1.5);
    run(&mut filter, [0.8; 20]);
    filter.correct(3.0, still(1.5), 0.4, Order::ByItself);
    assert!(now_m(&filter) > 0.5);
    filter.stand();
    assert_near(filter.above_floor_m(0.0), 0.0);
    assert_near(filter.state().height_m, 0.0);
    assert_near(now_m(&filter), 0.0);
}

#[test]
fn a_low_box_is_not_noise_because_one_of_its_echoes_is_near() {
    let order = Order::Sticks(Sticks::default());
    let mut filter = hovering(1.0);
    let echoes = [0.88, 0.88, 0.91, 0.88].map(|m| filter.correct(m, still(1.0), 0.05, order));
    assert_eq!(echoes, [Echo::Wrong, Echo::Wrong, Echo::Wrong, Echo::FloorStep]);
}

#[test]
fn a_gap_after_a_jump_does_not_make_it_a_climb() {
    let order = Order::Sticks(Sticks::default());
    let mut filter = hovering(1.0);
    assert_eq!(filter.correct(1.16, still(1.0), 0.05, order), Echo::Wrong);
    assert_eq!(filter.correct(1.16, still(1.0), 0.6, order), Echo::Wrong);
}

/// What the drone does that has received other orders looks like a box at first.
#[test]
fn heights_that_move_on_as_fast_as_they_began_to_are_a_climb() {
    let step_s = 0.05;
    for climb_m_s in [0.3, 0.7, 1.2, -0.7] {
        let (mut filter, mut worst_m) = (hovering(2.0), 0.0_f64);
        for i in 1..30 {
            let height_m = 2.0 + climb_m_s * step_s * f64::from(i);
            let mut expected = filter.state();
            expected.height_m += expected.climb_m_s * step_s;
            let echo = filter.correct(height_m, expected, step_s, Order::ByItself);
            assert_ne!(echo, Echo::FloorStep, "{climb_m_s} m/s");
            let (off_m, told_m) = (filter.state().height_m - height_m, now_m(&filter));
            worst_m = worst_m.max(off_m.abs() - 4.0 * told_m);
        }
        assert!(worst_m < 0.1, "{climb_m_s} m/s: {worst_m} m more than four deviations");
        assert!((filter.state().height_m - 2.0 - climb_m_s * step_s * 29.0).abs() < 0.1);
        assert_near(filter.above_floor_m(0.0), 0.0);
    }
}

#[test]
fn a_height_stays_as_uncertain_as_it_was_when_the_floor_stepped() {
    let order = Order::Sticks(Sticks::default());
    let mut filter = hovering(2.0);
    let before_m = now_m(&filter);
    run(&mut filter, [1.4; 100]);
    let stepped_m = now_m(&filter);
    assert!(stepped_m > before_m && stepped_m < 0.1, "{before_m}, {stepped_m}");
    // That above the floor is as good as ever.
    assert!(filter.surprise_m2().sqrt() < 1.5 * ULTRASOUND_M);
    // After a second without packets it is a floor again, but what the drone has climbed meanwhile is not known well.
    let mut filter = hovering(2.0);
    let expected = filter.state();
    filter.correct(4.5, expected, 1.0, order);
    let echoes = run(&mut filter, [4.5; 50]);
    assert_eq!(echoes[2], Echo::FloorStep);
    assert!((0.05..0.4).contains(&now_m(&filter)), "{}", now_m(&filter));
}

#[test]
fn silence_and_a_restart_make_a_height_uncertain() {
    let order = Order::Sticks(Sticks::default());
    let mut filter = hovering(1.0);
    // Nearly the way of an unheard climb of 0.9 m/s with a lag of half a second.
    let unheard_m = 0.9 * (1.9 - 0.5 * (1.0 - (-3.8_f64).exp()));
    let silent_m = filter.uncertainty_m(2.0, order);
    assert!((unheard_m..1.1 * unheard_m).contains(&silent_m), "{silent_m}");
    let before_m = now_m(&filter);
    filter.handle_restart();
    assert_near(now_m(&filter), before_m.hypot(0.25));
    run(&mut filter, [1.0; 20]);
    assert!(now_m(&filter) > 0.2, "the floor may be another one");
    // A drone that seems to stand may be another one that has restarted, heard late.
    filter.stand();
    assert_near(now_m(&filter), 0.25);
    run(&mut filter, [1.0; 20]);
    assert!(now_m(&filter) > 0.2);
}

/// The packets of the take-off may be lost.
#[test]
fn the_first_height_after_standing_is_one_above_the_floor_it_stood_on() {
    let mut filter = hovering(1.5);
    run(&mut filter, [0.8; 20]);
    filter.stand();
    assert_eq!(run(&mut filter, [0.9; 10])[0], Echo::First);
    let height_m = filter.state().height_m;
    assert!((height_m - 0.9).abs() < 0.01, "{height_m}");
    assert_near(filter.above_floor_m(0.0), 0.0);
}
