//! The filter against Kalman's equations, with derivatives taken numerically.
#![expect(clippy::float_cmp, reason = "the very same number, not a near one")]

use nalgebra::{DMatrix, DVector};

use super::*;

mod landmarks;

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
}

fn assert_same(found: &DMatrix<f64>, expected: &DMatrix<f64>) {
    let off = (found - expected).amax();
    assert!(off < 1e-8 * expected.amax().max(1.0), "{off}\n{found:.6}\n{expected:.6}");
}

/// A filter with two tags, in which everything is correlated with everything.
fn filled() -> Filter {
    let mut filter = Filter::new(false, &Start::default());
    filter.use_tags(2);
    let used = filter.used;
    let some = |i: usize| (i as f64 * 12.9898).sin() * 0.3;
    for i in 0..used {
        filter.x[i] = some(i + 1);
        for j in 0..used {
            filter.p[i][j] = (0..used).map(|k| some(i * 17 + k) * some(j * 17 + k)).sum::<f64>()
                + if i == j { 0.05 } else { 0.0 };
        }
    }
    filter
}

fn covariance(filter: &Filter) -> DMatrix<f64> {
    DMatrix::from_fn(filter.used, filter.used, |i, j| filter.p[i][j])
}

fn state(filter: &Filter) -> DVector<f64> {
    DVector::from_column_slice(&filter.x[..filter.used])
}

/// The derivative of a function of the state.
fn derivative(filter: &Filter, function: impl Fn(&Filter) -> DVector<f64>) -> DMatrix<f64> {
    const STEP: f64 = 1e-4;
    let columns: Vec<DVector<f64>> = (0..filter.used)
        .map(|column| {
            let at = |off: f64| {
                let mut filter = filter.clone();
                filter.x[column] += off;
                function(&filter)
            };
            // Of fourth order.
            let [near, far] = [1.0, 2.0].map(|k| (at(k * STEP) - at(-k * STEP)) / (2.0 * k * STEP));
            (near * 4.0 - far) / 3.0
        })
        .collect();
    DMatrix::from_columns(&columns)
}

const WAY_M: Vector2<f64> = Vector2::new(0.4, -0.3);

#[test]
fn the_odometry_turns_by_the_correction_and_loses_its_bias() {
    let before = filled();
    let mut after = before.clone();
    after.fly(WAY_M, 30.0, 0.5);
    let heading_deg = before.x[HEADING].to_degrees();
    let bias_m = world_from_body(before.bias_m_s(), 30.0 + heading_deg) * 0.5;
    let moved_m = world_from_body(WAY_M, heading_deg) - WAY_M - bias_m;
    let corrected_m = after.correction().place_m - before.correction().place_m;
    assert_near((corrected_m - moved_m).norm(), 0.0);
    let faded = 1.0 - 0.5 / BIAS_TIME_S;
    assert_near((after.bias_m_s() - before.bias_m_s() * faded).norm(), 0.0);
    let turned_rad = after.correction().heading_rad - before.correction().heading_rad;
    assert_near(turned_rad, before.x[RATE] * 0.5);
    assert_eq!(after.x[RATE], before.x[RATE]);
    assert_eq!(after.x[CAMERA..], before.x[CAMERA..], "camera and tags stay");
    // A bias is forgotten after its time and does not turn round.
    let mut later = before.clone();
    later.fly(WAY_M, 30.0, 3.0 * BIAS_TIME_S);
    assert_near(later.bias_m_s().norm(), 0.0);
}

#[test]
fn the_covariance_follows_the_derivative_of_the_motion_and_the_random_walks() {
    // The bias itself is so small that its turn by the heading's error is neglected.
    let mut before = filled();
    (before.x[BIAS], before.x[BIAS + 1]) = (0.0, 0.0);
    let fly = |filter: &Filter| {
        let mut filter = filter.clone();
        filter.fly(WAY_M, 30.0, 0.5);
        filter
    };
    let transition = derivative(&before, |filter| state(&fly(filter)));
    let mut expected = &transition * covariance(&before) * transition.transpose();
    let walk_rad = [HEADING_WALK_DEG, RATE_WALK_DEG_S].map(f64::to_radians);
    for (states, variance) in [
        (PLACE..PLACE + 2, PLACE_WALK_M2_S),
        (BIAS..BIAS + 2, BIAS_WALK_M_S.powi(2)),
        (HEADING..HEADING + 1, walk_rad[0].powi(2)),
        (RATE..RATE + 1, walk_rad[1].powi(2)),
    ] {
        states.for_each(|state| expected[(state, state)] += variance * 0.5);
    }
    let off = covariance(&fly(&before)) - expected;
    // The random walks are far smaller than the rest, so they are compared with themselves.
    assert!(off.amax() < 1e-12, "{off:e}");
}

const LOOK: Look =
    Look { offset_m: Vector2::new(0.5, -0.2), height_m: 1.6, orientation_deg: 270.0 };
const MOMENT: Moment = Moment {
    place_m: Vector2::new(2.0, 3.0),
    speed_m_s: 0.7,
    yaw_deg: 40.0,
    tilt_deg: Vector2::new(0.0, 0.0),
    height_m: 1.6,
};

#[test]
fn a_sighting_lies_where_drone_and_camera_point() {
    let filter = filled();
    let sighted = filter.sighted(&LOOK, &MOMENT, 2.0);
    let yaw_deg = 40.0 + filter.x[HEADING].to_degrees();
    let camera_m = Vector2::new(filter.x[CAMERA], filter.x[CAMERA + 1]) * 1.6;
    let from_drone_m = world_from_body(LOOK.offset_m + camera_m, yaw_deg);
    let place_m = MOMENT.place_m + filter.correction().place_m + from_drone_m;
    assert_near((sighted.place_m - place_m).norm(), 0.0);
    let aside_m = 0.5_f64.hypot(0.2);
    let parts_m = [0.01, 0.03 * 1.6, 0.06 * aside_m, 0.06 * 0.7];
    assert_near(sighted.variance_m2, parts_m.iter().map(|part_m| part_m.powi(2)).sum());
    assert_near(sighted.scale_m2, (0.06_f64 * 2.0).powi(2));
}

/// The filter after a measurement that should have been zero, by Kalman's equations.
fn corrected(
    before: &Filter,
    measure: impl Fn(&Filter) -> DVector<f64>,
    variance: f64,
) -> (DVector<f64>, DMatrix<f64>) {
    let (measured, rows) = (measure(before), derivative(before, &measure));
    let p = covariance(before);
    let count = measured.len();
    let spread = &rows * &p * rows.transpose() + DMatrix::identity(count, count) * variance;
    let gain = &p * rows.transpose() * spread.try_inverse().unwrap();
    (state(before) - &gain * measured, &p - gain * rows * &p)
}

fn assert_corrected(after: &Filter, expected: &(DVector<f64>, DMatrix<f64>)) {
    let off = (state(after) - &expected.0).amax();
    assert!(off < 1e-7, "{off}");
    assert_same(&covariance(after), &expected.1);
}

fn pair(vector: Vector2<f64>) -> DVector<f64> {
    DVector::from_column_slice(vector.as_slice())
}

#[test]
fn a_sighting_corrects_the_state_by_kalmans_equations() {
    let before = filled();
    for tag in 0..2 {
        let sighted = before.sighted(&LOOK, &MOMENT, 2.0);
        let mut after = before.clone();
        after.correct(&sighted, tag);
        let residual = |filter: &Filter| {
            pair(filter.sighted(&LOOK, &MOMENT, 2.0).place_m - filter.tag_place_m(tag))
        };
        let variance_m2 = sighted.variance_m2 + sighted.scale_m2;
        assert_corrected(&after, &corrected(&before, residual, variance_m2));
    }
}

#[test]
fn two_tags_that_are_one_correct_each_other() {
    let before = filled();
    for (one, other) in [(1, 0), (0, 1)] {
        let mut after = before.clone();
        after.make_one(one, other, 3.0);
        let residual = |filter: &Filter| pair(filter.tag_place_m(one) - filter.tag_place_m(other));
        let variance_m2 = 0.02_f64.powi(2) + (0.06_f64 * 3.0).powi(2);
        assert_corrected(&after, &corrected(&before, residual, variance_m2));
    }
    // They agree within the deviation of the scale on the way.
    let close = |way_m: f64| {
        let mut after = before.clone();
        after.make_one(1, 0, way_m);
        (after.tag_place_m(0) - after.tag_place_m(1)).norm()
    };
    assert!(close(0.0) < 0.01 && close(10.0) > close(0.0));
}

#[test]
fn an_orientation_corrects_the_heading_by_kalmans_equations() {
    let before = filled();
    let tag = 1;
    let direction_rad = before.x[TAGS + 3 * tag + 2] + 0.2;
    let mut after = before.clone();
    after.correct_heading(tag, direction_rad);
    // The direction of the tag by this heading: it grows with the heading, and should be the tag's.
    let residual = |filter: &Filter| {
        let turned = filter.x[HEADING] - before.x[HEADING];
        DVector::from_element(1, direction_rad + turned - filter.x[TAGS + 3 * tag + 2])
    };
    let variance = ORIENTATION_DEG.to_radians().powi(2);
    assert_corrected(&after, &corrected(&before, residual, variance));
    // Across half a turn it is the same angle.
    let mut wrapped = before.clone();
    wrapped.correct_heading(tag, direction_rad + std::f64::consts::TAU);
    assert!((state(&wrapped) - state(&after)).amax() < 1e-9);
}

/// A filter that knows everything but one tag.
fn certain(tag_variance_m2: f64) -> Filter {
    let mut filter = Filter::new(false, &Start::default());
    filter.use_tags(2);
    filter.p = [[0.0; STATES]; STATES];
    for axis in 0..2 {
        filter.p[TAGS + axis][TAGS + axis] = tag_variance_m2;
    }
    filter
}

#[test]
fn beyond_five_deviations_it_is_something_else() {
    let variance_m2 = 0.01_f64;
    for (deviations, fits) in [(4.99, true), (5.01, false)] {
        // A sighting: the deviations of tag, sighting and scale count together.
        let mut filter = certain(variance_m2);
        let sighted = filter.sighted(&LOOK, &MOMENT, 2.0);
        let uncertainty_m = (variance_m2 + sighted.variance_m2 + sighted.scale_m2).sqrt();
        filter.x[TAGS] = sighted.place_m.x - uncertainty_m * deviations;
        filter.x[TAGS + 1] = sighted.place_m.y;
        assert_eq!(filter.admits(&sighted, 0), fits);
        filter.x[TAGS] = sighted.place_m.x + uncertainty_m * deviations * 0.6;
        filter.x[TAGS + 1] = sighted.place_m.y + uncertainty_m * deviations * 0.8;
        assert_eq!(filter.admits(&sighted, 0), fits);
        // Two tags: 2 cm, and the scale of the way between.
        let mut filter = certain(variance_m2);
        let uncertainty_m = (variance_m2 + 0.02_f64.powi(2) + 0.18_f64.powi(2)).sqrt();
        filter.x[TAGS] = 1.0;
        filter.x[TAGS + 3] = 1.0 + uncertainty_m * deviations;
        assert_eq!(filter.may_be_one(0, 1, 3.0), fits);
        assert_eq!(filter.may_be_one(1, 0, 3.0), fits);
        // A direction.
        let mut filter = certain(0.0);
        let variance = 0.01 + ORIENTATION_DEG.to_radians().powi(2);
        filter.p[HEADING][HEADING] = 0.01;
        filter.correct_heading(0, variance.sqrt() * deviations);
        assert_eq!(filter.x[HEADING] != 0.0, fits);
    }
    // The gate itself is beyond: 5 m with a deviation of 1 m.
    assert!(squared_deviations(Vector2::new(3.0, 4.0), Matrix2::identity()) >= GATE * GATE);
}

#[test]
fn at_the_start_only_what_was_not_set_is_unknown() {
    for surveyed in [false, true] {
        let filter = Filter::new(surveyed, &Start::default());
        let placed = |deviation: f64| if surveyed { deviation.powi(2) } else { 0.0 };
        let expected = [
            placed(START_M),
            placed(START_M),
            BIAS_M_S.powi(2),
            BIAS_M_S.powi(2),
            placed(START_DEG.to_radians()),
            RATE_DEG_S.to_radians().powi(2),
            CAMERA_RAD.powi(2),
            CAMERA_RAD.powi(2),
        ];
        let p = covariance(&filter);
        assert_same(&p, &DMatrix::from_diagonal(&DVector::from_column_slice(&expected)));
        assert_near(filter.place_variance_m2(), placed(START_M));
    }
}

#[test]
fn doubt_adds_to_the_variance_and_a_forgotten_bias_is_as_at_the_start() {
    let before = filled();
    let mut after = before.clone();
    after.doubt_place(0.3);
    after.doubt_heading(0.2);
    let mut expected = covariance(&before);
    (expected[(PLACE, PLACE)], expected[(PLACE + 1, PLACE + 1)]) =
        (before.p[PLACE][PLACE] + 0.3, before.p[PLACE + 1][PLACE + 1] + 0.3);
    expected[(HEADING, HEADING)] += 0.04;
    assert_same(&covariance(&after), &expected);
    assert_near(after.place_variance_m2(), expected[(0, 0)].max(expected[(1, 1)]));

    after.forget_bias();
    let mut expected_x = state(&before);
    for bias in BIAS..BIAS + 2 {
        expected_x[bias] = 0.0;
        expected.row_mut(bias).fill(0.0);
        expected.column_mut(bias).fill(0.0);
        expected[(bias, bias)] = BIAS_M_S.powi(2);
    }
    assert_same(&covariance(&after), &expected);
    assert_eq!(state(&after), expected_x);
    assert_near(after.bias_m_s().norm(), 0.0);
}

#[test]
fn a_tag_has_a_place_a_direction_and_a_deviation() {
    let mut filter = filled();
    let state = TAGS + 3;
    (filter.x[state], filter.x[state + 1], filter.x[state + 2]) = (1.5, -2.5, 4.0);
    (filter.p[state][state], filter.p[state + 1][state + 1]) = (0.04, 0.09);
    assert_eq!(filter.tag_place_m(1), Vector2::new(1.5, -2.5));
    assert_near(filter.tag_heading_deg(1), 4.0_f64.to_degrees() - 360.0);
    assert_near(filter.tag_uncertainty_m(1), 0.3);
}

#[test]
fn the_worse_axis_counts() {
    let mut filter = filled();
    for variances_m2 in [[0.04, 0.09], [0.09, 0.04]] {
        for (axis, variance_m2) in variances_m2.into_iter().enumerate() {
            filter.p[PLACE + axis][PLACE + axis] = variance_m2;
            filter.p[TAGS + 3 + axis][TAGS + 3 + axis] = variance_m2;
        }
        assert_near(filter.place_variance_m2(), 0.09);
        assert_near(filter.tag_uncertainty_m(1), 0.3);
    }
}
