use super::*;

const TOLERANCE: Tolerance = Tolerance { gains: [0.6, 1.5], down: 1.7, slack: 0.03, enough: 0.3 };
const LAGS_S: [f64; 2] = [0.5, 1.25];

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
}

#[test]
fn a_rate_is_between_the_least_and_the_largest_gain_with_the_lag_of_the_hypothesis() {
    let followed = 1.0 - (-1_f64).exp();
    for (wanted, [least, most]) in [(0.7, [0.42, 1.05]), (-0.7, [-1.5 * 1.7 * 0.7, -0.42])] {
        let mut rate = Rate::new(TOLERANCE, LAGS_S);
        rate.follow(wanted, 0.5);
        let [ordinary, sluggish] = rate.hypotheses;
        assert_near(ordinary.rates[0], least * followed);
        assert_near(ordinary.rates[1], most * followed);
        assert_near(sluggish.rates[1], most * (1.0 - (-0.4_f64).exp()));
        // The way is that of the mean rate.
        assert_near(ordinary.ways[1], most * followed / 2.0 * 0.5);
        rate.follow(wanted, 0.5);
        let later = most * (1.0 - (-2_f64).exp());
        let way = most * followed / 2.0 * 0.5 + f64::midpoint(most * followed, later) * 0.5;
        assert_near(rate.hypotheses[0].ways[1], way);
    }
}

/// A hypothesis by which the drone went between these ways.
fn gone(ways: [f64; 2]) -> Hypothesis {
    Hypothesis { ways, ..Hypothesis::moving(0.5, 0.0) }
}

/// How much is below and above after a measurement.
fn judged(mut hypothesis: Hypothesis, moved: f64, step_s: f64) -> [f64; 2] {
    hypothesis.compare(moved, step_s, &TOLERANCE);
    [hypothesis.below, hypothesis.above]
}

#[test]
fn what_lies_outside_of_the_ways_adds_up_and_fades_with_ten_seconds() {
    // Less the drift of a healthy sensor, 0.03 m/s.
    for (moved, below, above) in [
        (0.0, 0.03 - 0.003, 0.0),
        (0.03, 0.0, 0.0),
        (0.05, 0.0, 0.0),
        (0.08, 0.0, 0.0),
        (0.1, 0.0, 0.02 - 0.003),
    ] {
        let found = judged(gone([0.03, 0.08]), moved, 0.1);
        assert_near(found[0], below);
        assert_near(found[1], above);
    }
    let before = Hypothesis { below: 0.2, above: 0.1, ..gone([0.05, 0.05]) };
    let [below, above] = judged(before, 0.0, 1.0);
    assert_near(below, 0.2 * (-0.1_f64).exp() + 0.05 - 0.03);
    assert_near(above, 0.1 * (-0.1_f64).exp() - 0.05 - 0.03);
}

/// An axis of which one measurement was 0.
fn axis(hypotheses: [Hypothesis; 2]) -> Rate<2> {
    Rate { hypotheses, last: Some(0.0), asks: true, is_new: false, ..Rate::new(TOLERANCE, LAGS_S) }
}

#[test]
fn a_response_is_missing_once_it_is_outside_by_every_hypothesis_for_a_while() {
    let is_missing = |below: [f64; 2], above: [f64; 2]| {
        let hypothesis =
            |i: usize| Hypothesis { below: below[i], above: above[i], ..gone([0.0; 2]) };
        let mut axis = axis([hypothesis(0), hypothesis(1)]);
        axis.compare(0.0, 1e-9, |metres| metres);
        axis.missing_for_s > 0.0
    };
    let (most, more, none) = (TOLERANCE.enough, TOLERANCE.enough + 1e-3, [0.0; 2]);
    assert!(is_missing([more; 2], none) && is_missing(none, [more; 2]));
    assert!(!is_missing([more, most], none) && !is_missing([most, more], none));
    assert!(!is_missing(none, [more, most]) && !is_missing([more, 0.0], [0.0, more]));
    for (missing_for_s, found) in [(0.119, false), (LASTS_S, true)] {
        assert_eq!(Rate { missing_for_s, ..axis([gone([0.0; 2]); 2]) }.is_missing(), found);
    }
    let missing = Hypothesis { below: 0.5, ..gone([0.0; 2]) };
    let mut lasting = Rate { missing_for_s: 0.1, ..axis([missing; 2]) };
    lasting.compare(0.0, 0.05, |metres| metres);
    assert_near(lasting.missing_for_s, 0.15);
    for its in lasting.hypotheses {
        its.ways.into_iter().for_each(|way| assert_near(way, 0.0));
    }
}

#[test]
fn a_drone_whose_stick_is_at_rest_goes_back_to_where_it_was_released() {
    let mut axis = axis([gone([0.05; 2]); 2]);
    axis.compare(0.0, 0.05, |metres| metres);
    let below = axis.hypotheses[0].below;
    assert!(below > 0.0);
    axis.follow(0.0, 0.05);
    axis.compare(-0.1, 0.05, |metres| metres);
    assert_near(axis.hypotheses[0].below, below);
    axis.follow(0.7, 0.05);
    axis.compare(-0.2, 0.05, |metres| metres);
    assert!(axis.hypotheses[0].below > below + 0.09);
}

/// After a gap, or after it moved by itself.
#[test]
fn a_drone_begins_with_the_rate_that_it_has() {
    let mut axis = Rate::new(TOLERANCE, LAGS_S);
    axis.rest(Some(1.0));
    axis.follow(0.7, 0.05);
    axis.compare(0.97, 0.05, |metres| metres);
    for its in axis.hypotheses {
        assert_near(its.rates[0], -0.6);
        assert_near(its.rates[1], -0.6);
        assert_near(its.below.max(its.above), 0.0);
    }
}
