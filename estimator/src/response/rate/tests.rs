use super::*;

const TOLERANCE: Tolerance = Tolerance {
    share: 0.6,
    most: 1.5,
    slack: 0.03,
    missing: 0.3,
    missing_slowly: 0.5,
    jump: 0.1,
    jump_1_s: 1.0,
    full: 0.7,
};
const ORDINARY: Answer = Answer { lag_s: 0.5, down: 1.0 };
const SLUGGISH: Answer = Answer { lag_s: 1.25, down: 1.7 };

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
}

#[test]
fn a_rate_follows_its_stick_with_the_lag_of_the_hypothesis() {
    let mut rate = Rate::new(TOLERANCE, [ORDINARY, SLUGGISH]);
    let now = 0.7 * (1.0 - (-1_f64).exp());
    rate.follow(0.7, 0.5);
    assert_near(rate.hypotheses[0].now, now);
    assert_near(rate.hypotheses[0].way, now / 2.0 * 0.5);
    rate.follow(0.7, 0.5);
    let later = now + (0.7 - now) * (1.0 - (-1_f64).exp());
    assert_near(rate.asked(), now / 2.0 * 0.5 + f64::midpoint(now, later) * 0.5);
    // Downwards with its gain.
    let mut rate = Rate::new(TOLERANCE, [SLUGGISH]);
    rate.follow(-0.7, 1.25);
    assert_near(rate.hypotheses[0].now, -0.7 * 1.7 * (1.0 - (-1_f64).exp()));
}

/// A hypothesis by which the drone went this way.
fn gone(way: f64) -> Hypothesis {
    Hypothesis { way, ..Hypothesis::new(ORDINARY) }
}

/// The same after a measurement.
fn judged(mut hypothesis: Hypothesis, moved: f64, step_s: f64) -> Hypothesis {
    hypothesis.compare(moved, step_s, &TOLERANCE);
    hypothesis
}

#[test]
fn a_missing_response_is_what_the_weakest_airframe_would_have_shown() {
    // 60 % of 0.05 m, less the drift of a healthy sensor, 0.03 m/s, in either direction.
    assert_near(judged(gone(0.05), 0.0, 0.1).missing, 0.03 - 0.003);
    assert_near(judged(gone(-0.05), 0.0, 0.1).missing, 0.03 - 0.003);
    assert_near(judged(gone(0.05), 0.01, 0.1).missing, 0.02 - 0.003);
    assert_near(judged(gone(-0.05), -0.01, 0.1).missing, 0.02 - 0.003);
    assert_near(judged(gone(0.05), 0.04, 0.1).missing, 0.0);
    // It adds up, and what is old fades with ten seconds.
    let lacking = Hypothesis { missing: 0.2, ..gone(0.05) };
    assert_near(judged(lacking, 0.0, 1.0).missing, 0.2 * (-0.1_f64).exp() + 0.03 - 0.03);
}

#[test]
fn an_excessive_response_is_more_than_the_strongest_airframe_would_have_shown() {
    // More than 150 % of 0.04 m, and of a drift.
    assert_near(judged(gone(0.04), 0.1, 0.1).excess, 0.04 - 0.003);
    assert_near(judged(gone(-0.04), -0.1, 0.1).excess, 0.04 - 0.003);
    assert_near(judged(gone(0.04), 0.05, 0.1).excess, 0.0);
    assert_near(judged(gone(0.04), -0.1, 0.1).excess, 0.0);
    let exceeding = Hypothesis { excess: 0.2, ..gone(0.04) };
    assert_near(judged(exceeding, 0.1, 1.0).excess, 0.2 * (-0.1_f64).exp() + 0.04 - 0.03);
}

#[test]
fn a_slow_command_is_judged_after_two_seconds_by_all_of_it() {
    let slow_for = |now| judged(Hypothesis { now, slow_for_s: 1.0, ..gone(0.0) }, 0.0, 0.05);
    // 35 % of the full rate.
    for (now, slow_for_s) in
        [(0.244, 1.05), (-0.244, 1.05), (0.246, 0.0), (-0.246, 0.0), (SLOW_SHARE * 0.7, 0.0)]
    {
        assert_near(slow_for(now).slow_for_s, slow_for_s);
    }
    let missing = |slow_for_s, moved, way| {
        let before = Hypothesis { now: 0.1, missing_slowly: 0.2, slow_for_s, ..gone(way) };
        judged(before, moved, 0.5).missing_slowly
    };
    // What is old fades with ten seconds.
    let old = 0.2 * (-0.05_f64).exp();
    assert_near(missing(1.5, 0.01, 0.05), old);
    assert_near(missing(1.6, 0.01, 0.05), old + 0.04);
    assert_near(missing(1.6, -0.01, -0.05), old - 0.04);
}

/// An axis of which one measurement was 0.
fn axis(hypotheses: [Hypothesis; 2]) -> Rate<2> {
    Rate {
        hypotheses,
        last: Some(0.0),
        asks: true,
        is_new: false,
        ..Rate::new(TOLERANCE, [ORDINARY, SLUGGISH])
    }
}

#[test]
fn a_step_beyond_noise_and_motion_by_every_hypothesis_is_a_jump() {
    let missing = |ways: [f64; 2], moved| {
        let mut axis = axis(ways.map(gone));
        axis.compare(moved, 0.05, |metres| metres);
        assert!(axis.hypotheses.iter().all(|its| its.way.abs() < 1e-12), "the next one is new");
        axis.hypotheses[0].missing
    };
    // 0.1 m, plus 1 m/s for 0.05 s, around the 0.02 m that were asked for.
    assert_near(missing([0.02, 0.02], -0.12), 0.012 + 0.12 - 0.0015);
    assert_near(missing([0.02, 0.02], -0.14), 0.0);
    assert_near(missing([0.02, -0.01], -0.14), 0.012 + 0.14 - 0.0015);
}

#[test]
fn a_response_is_missing_once_it_is_too_small_by_every_hypothesis_for_a_while() {
    let is_missing = |missing: [f64; 2], missing_slowly: [f64; 2]| {
        let hypothesis = |i: usize| Hypothesis {
            missing: missing[i],
            missing_slowly: missing_slowly[i],
            ..gone(0.0)
        };
        let mut axis = axis([hypothesis(0), hypothesis(1)]);
        axis.compare(0.0, 1e-9, |metres| metres);
        axis.missing_for_s > 0.0
    };
    let (most, slowly) = (TOLERANCE.missing, TOLERANCE.missing_slowly);
    let (more, more_slowly) = (most + 1e-3, slowly + 1e-3);
    assert!(is_missing([more, more], [0.0; 2]));
    assert!(!is_missing([more, most], [0.0; 2]) && !is_missing([most, more], [0.0; 2]));
    assert!(is_missing([0.0; 2], [more_slowly; 2]) && is_missing([0.0; 2], [-more_slowly; 2]));
    assert!(!is_missing([0.0; 2], [slowly, more_slowly]));
    assert!(!is_missing([0.0; 2], [more_slowly, -more_slowly]));
    for (missing_for_s, found) in [(0.119, false), (MISSING_TIME_S, true)] {
        assert_eq!(Rate { missing_for_s, ..axis([gone(0.0); 2]) }.is_missing(), found);
    }
    let missing = Hypothesis { missing: 0.5, ..gone(0.0) };
    let mut lasting = Rate { missing_for_s: 0.1, ..axis([missing; 2]) };
    lasting.compare(0.0, 0.05, |metres| metres);
    assert_near(lasting.missing_for_s, 0.15);
}

#[test]
fn a_drone_whose_stick_is_at_rest_goes_back_to_where_it_was_released() {
    let mut axis = axis([gone(0.05); 2]);
    axis.compare(0.0, 0.05, |metres| metres);
    let missing = axis.hypotheses[0].missing;
    assert!(missing > 0.0);
    axis.follow(0.0, 0.05);
    axis.compare(-0.1, 0.05, |metres| metres);
    assert_near(axis.hypotheses[0].missing, missing);
    axis.follow(0.7, 0.05);
    axis.compare(-0.2, 0.05, |metres| metres);
    assert!(axis.hypotheses[0].missing > missing + 0.09);
}

/// After a gap, or after it moved by itself.
#[test]
fn a_drone_begins_with_the_rate_that_it_has() {
    let mut axis = Rate::new(TOLERANCE, [ORDINARY, SLUGGISH]);
    axis.rest(1.0);
    axis.follow(0.7, 0.05);
    axis.compare(0.97, 0.05, |metres| metres);
    for its in axis.hypotheses {
        assert_near(its.now, -0.6);
        assert_near(its.missing, 0.0);
    }
    axis.rest(1.0);
    axis.compare(0.9, 0.05, |metres| metres);
    assert_near(axis.hypotheses[0].now, -0.7);
    assert_near(axis.hypotheses[1].now, -0.7 * 1.7);
}
