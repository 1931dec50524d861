//! Tags that come and go.

use super::*;

#[test]
fn a_new_tag_is_as_uncertain_as_the_drone_that_saw_it_and_its_sighting() {
    let before = filled();
    let sighted = before.sighted(&LOOK, &MOMENT, 2.0);
    for tag in [1, 2] {
        let mut after = before.clone();
        after.begin_tag(tag, &sighted);
        assert_eq!(after.used, TAGS + 3 * (tag + 1).max(2));
        let state = TAGS + 3 * tag;
        // The new state is a function of the old one, in which this tag has no part.
        let mut old = before.clone();
        old.forget_tag(tag);
        old.used = after.used;
        let map = derivative(&old, |filter| {
            let mut x = self::state(filter);
            let place_m = filter.sighted(&LOOK, &MOMENT, 2.0).place_m;
            x.rows_mut(state, 2).copy_from_slice(place_m.as_slice());
            x
        });
        let mut expected = &map * covariance(&old) * map.transpose();
        for axis in 0..2 {
            expected[(state + axis, state + axis)] += sighted.variance_m2;
        }
        assert_same(&covariance(&after), &expected);
        assert_near((after.tag_place_m(tag) - sighted.place_m).norm(), 0.0);
    }
}

#[test]
fn a_surveyed_tag_is_known_to_a_tape_measure_and_its_direction_if_it_was_measured() {
    let place_m = Vector2::new(3.0, -1.0);
    // In a slot that another tag has left behind, in a new one, and in the last.
    for (tag, used) in [(1, TAGS + 6), (2, TAGS + 9), (SLOTS - 1, STATES)] {
        for heading_rad in [None, Some(0.5)] {
            let mut filter = filled();
            filter.survey_tag(tag, place_m, heading_rad);
            assert_eq!(filter.used, used);
            assert_eq!(filter.tag_place_m(tag), place_m);
            assert_near(filter.tag_uncertainty_m(tag), 0.02);
            if let Some(heading_rad) = heading_rad {
                assert_near(filter.tag_heading_deg(tag), heading_rad.to_degrees());
            }
            let state = TAGS + 3 * tag;
            let mut expected = covariance(&Filter { used, ..filled() });
            for tag in state..state + 3 {
                expected.row_mut(tag).fill(0.0);
                expected.column_mut(tag).fill(0.0);
            }
            (expected[(state, state)], expected[(state + 1, state + 1)]) = (0.0004, 0.0004);
            let direction = heading_rad.map_or(0.0, |_| 2_f64.to_radians().powi(2));
            expected[(state + 2, state + 2)] = direction;
            assert_same(&covariance(&filter), &expected);
            // The first tag again does not shorten the state.
            filter.survey_tag(0, place_m, None);
            assert_eq!(filter.used, used);
        }
    }
}

#[test]
fn a_direction_that_was_found_is_as_uncertain_as_the_heading_and_its_mean() {
    let before = filled();
    for tag in 0..2 {
        let mut after = before.clone();
        after.begin_heading(tag, 0.7);
        let state = TAGS + 3 * tag + 2;
        let mut expected = covariance(&before);
        for other in 0..before.used {
            let covariance = if other == state { 0.0 } else { before.p[HEADING][other] };
            (expected[(state, other)], expected[(other, state)]) = (covariance, covariance);
        }
        expected[(state, state)] = before.p[HEADING][HEADING] + 3_f64.to_radians().powi(2);
        assert_same(&covariance(&after), &expected);
        assert_near(after.tag_heading_deg(tag), 0.7_f64.to_degrees());
    }
}

#[test]
fn a_forgotten_tag_leaves_nothing_behind() {
    let mut filter = filled();
    filter.forget_tag(0);
    for state in TAGS..TAGS + 3 {
        assert!(filter.p[state].iter().all(|value| *value == 0.0));
        assert!(filter.p.iter().all(|row| row[state] == 0.0));
    }
    let kept = filled();
    assert_eq!(filter.p[TAGS + 3][TAGS + 3..TAGS + 6], kept.p[TAGS + 3][TAGS + 3..TAGS + 6]);
}
