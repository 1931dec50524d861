use proptest::prelude::*;

use super::*;

/// An L: 4 m in both directions, without its right rear quarter.
const L: [[f64; 2]; 6] =
    [[-2.0, -2.0], [1.0, -2.0], [1.0, 1.0], [4.0, 1.0], [4.0, 4.0], [-2.0, 4.0]];

fn border(corners_m: &[[f64; 2]]) -> Border {
    Border::polygon(corners_m).unwrap_or_else(|error| panic!("{error}"))
}

fn at(x_m: f64, y_m: f64) -> Vector2<f64> {
    Vector2::new(x_m, y_m)
}

/// A polygon around the start, of which each corner is in its own direction.
fn star() -> impl Strategy<Value = Border> {
    (prop::collection::vec(0.8_f64..6.0, 3..12), any::<bool>()).prop_map(|(reaches_m, turned)| {
        let parts = f64::from(u32::try_from(reaches_m.len()).unwrap());
        let corner = |(part, reach_m): (usize, &f64)| {
            let angle = f64::from(u32::try_from(part).unwrap()) * std::f64::consts::TAU / parts;
            [reach_m * angle.sin(), reach_m * angle.cos()]
        };
        let mut corners_m: Vec<_> = reaches_m.iter().enumerate().map(corner).collect();
        if turned {
            corners_m.reverse();
        }
        border(&corners_m)
    })
}

/// Half the angle that a side of it fills.
const HALF_A_SIDE: f64 = std::f64::consts::PI / 32.0;

fn circle_of_corners(radius_m: f64) -> Border {
    let corner = |part: u32| {
        let angle = f64::from(part) * 2.0 * HALF_A_SIDE;
        [radius_m * angle.sin(), radius_m * angle.cos()]
    };
    border(&(0..32).map(corner).collect::<Vec<_>>())
}

proptest! {
    #[test]
    fn the_nearest_place_inside_is_inside_and_the_nearest(
        border in star(),
        (x_m, y_m) in (-8.0_f64..8.0, -8.0_f64..8.0),
        by_m in 0.0_f64..0.25,
        others in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0), 64),
    ) {
        let place_m = at(x_m, y_m);
        let nearest_m = border.nearest_inside(place_m, by_m);
        // Where it is too narrow for the distance it is inside at least, and near.
        let most_m = border.outside_m(place_m).max(0.0) + 2.0 * by_m;
        let moved_m = (nearest_m - place_m).norm();
        prop_assert!(border.outside_m(nearest_m) <= FlightLimits::TOLERANCE_M);
        prop_assert!(moved_m <= most_m + FlightLimits::TOLERANCE_M);
        for (right, forward) in others {
            let way_m = at(right, forward) * most_m;
            if way_m.norm() <= most_m && border.outside_m(place_m + way_m) <= -by_m {
                prop_assert!(border.outside_m(nearest_m) <= -by_m + FlightLimits::TOLERANCE_M);
                prop_assert!(moved_m <= way_m.norm() + FlightLimits::TOLERANCE_M, "{way_m}");
            }
        }
    }

    #[test]
    fn a_place_inside_stays(border in star(), x_m in -6.0_f64..6.0, y_m in -6.0_f64..6.0, by_m in 0.0_f64..1.0) {
        let place_m = at(x_m, y_m);
        if border.outside_m(place_m) <= -by_m {
            prop_assert_eq!(border.nearest_inside(place_m, by_m), place_m);
        }
        // In a sharp corner it goes on to where there is more room, and stays there.
        let moved = |from_m, _| border.nearest_inside(from_m, by_m);
        let there_m = (0..9).fold(place_m, moved);
        prop_assert!((moved(there_m, 0) - there_m).norm() <= FlightLimits::TOLERANCE_M);
    }

    /// A ray through a corner passes one of its two sides, whatever is rounded.
    #[test]
    fn the_way_to_a_corner_ends_there(border in star()) {
        let Shape::Polygon(corners_m) = border.shape() else { panic!("a star has corners") };
        for corner_m in corners_m.iter().map(|[x_m, y_m]| at(*x_m, *y_m)) {
            let room_m = border.room_m(at(0.0, 0.0), corner_m.normalize(), 0.0);
            prop_assert!(room_m > 0.99 * corner_m.norm(), "{corner_m}: {room_m} m");
        }
    }

    /// The way ends at the border, and nowhere before it is further outside.
    #[test]
    fn the_way_to_the_border_ends_at_the_border(
        border in star(),
        x_m in -6.0_f64..6.0,
        y_m in -6.0_f64..6.0,
        angle in 0.0_f64..6.3,
        beyond_m in prop_oneof![Just(0.0), 0.0_f64..1.0],
    ) {
        let (place_m, heading) = (at(x_m, y_m), at(angle.cos(), angle.sin()));
        prop_assume!(border.outside_m(place_m) < beyond_m - 1e-6);
        let room_m = border.room_m(place_m, heading, beyond_m);
        let outside_m = |way_m: f64| border.outside_m(place_m + heading * way_m) - beyond_m;
        prop_assert!(outside_m(room_m).abs() < 1e-5, "{room_m}: {}", outside_m(room_m));
        for part in 0..100 {
            prop_assert!(outside_m(room_m * f64::from(part) / 100.0) <= 1e-5);
        }
        // One that goes in again within some micrometres has touched a corner.
        prop_assert!(outside_m(room_m + 1e-4) > -1e-5);
    }

    #[test]
    fn a_circle_of_32_corners_is_a_circle_but_for_its_sagitta(
        radius_m in 1.0_f64..8.0,
        x_m in -10.0_f64..10.0,
        y_m in -10.0_f64..10.0,
        angle in 0.0_f64..6.3,
        by_m in 0.0_f64..0.5,
    ) {
        let (round, cornered) = (Border::circle(radius_m), circle_of_corners(radius_m));
        let sagitta_m = radius_m * (1.0 - HALF_A_SIDE.cos()) + 1e-6;
        let place_m = at(x_m, y_m);
        let differ_m = round.outside_m(place_m) - cornered.outside_m(place_m);
        prop_assert!(differ_m.abs() <= sagitta_m, "{differ_m}");
        let nearest_m = round.nearest_inside(place_m, by_m) - cornered.nearest_inside(place_m, by_m);
        // On a side it is the foot of another perpendicular.
        prop_assert!(nearest_m.norm() <= (place_m.norm() + radius_m) * HALF_A_SIDE, "{nearest_m}");
        let heading = at(angle.cos(), angle.sin());
        if round.outside_m(place_m) < -0.5 {
            let room_m = round.room_m(place_m, heading, by_m) - cornered.room_m(place_m, heading, by_m);
            let across = heading.dot(&round.outward(place_m + heading * round.room_m(place_m, heading, by_m)));
            prop_assert!(room_m.abs() <= 1.5 * sagitta_m / across.max(0.1) + 1e-6, "{room_m}");
        }
    }

    /// What every wall allows keeps inside, also in corners and around those that point in.
    #[test]
    fn who_comes_no_nearer_to_a_wall_than_it_is_stays_inside(
        x_m in -2.0_f64..4.0,
        y_m in -2.0_f64..4.0,
        angle in 0.0_f64..6.3,
        way_m in 0.0_f64..6.0,
    ) {
        let (l, place_m, way) = (border(&L), at(x_m, y_m), at(angle.cos(), angle.sin()) * way_m);
        prop_assume!(l.outside_m(place_m) < -1e-6);
        let passes = l.walls(place_m).any(|wall| way.dot(&wall.outward) > wall.distance_m);
        prop_assert!(passes || l.leaves_at(place_m, place_m + way, 1e-6).is_none());
        // A way that leads out passes a wall.
        let left = l.passed(place_m, place_m + way, 0.0).any(|wall| wall.distance_m < 0.0);
        prop_assert_eq!(left, l.leaves_at(place_m, place_m + way, 0.0).is_some());
    }
}

#[test]
fn distances_in_an_l_are_those_to_its_nearest_side() {
    let l = border(&L);
    for (place_m, outside_m, outward) in [
        (at(0.0, 0.0), -1.0, at(1.0, 0.0)),
        (at(-1.5, 0.0), -0.5, at(-1.0, 0.0)),
        (at(2.0, 0.0), 1.0, at(0.0, -1.0)),
        (at(5.0, 5.0), 2.0_f64.sqrt(), at(0.5_f64.sqrt(), 0.5_f64.sqrt())),
        (at(0.7, 1.4), -0.5, at(0.6, -0.8)),
        (at(4.0, 2.0), 0.0, at(1.0, 0.0)),
    ] {
        assert!((l.outside_m(place_m) - outside_m).abs() < 1e-9, "{place_m}");
        // From (2, 0) two sides are as near.
        if place_m != at(2.0, 0.0) {
            assert!((l.outward(place_m) - outward).norm() < 1e-9, "{place_m}");
        }
    }
}

#[test]
fn inside_by_a_distance_is_beside_the_sides_and_around_corners_that_point_in() {
    let l = border(&L);
    let nearest = |x_m, y_m| l.nearest_inside(at(x_m, y_m), 0.5);
    assert!((nearest(9.0, 2.0) - at(3.5, 2.0)).norm() < 1e-9);
    assert!((nearest(9.0, 9.0) - at(3.5, 3.5)).norm() < 1e-9, "a corner");
    assert!((nearest(1.3, 0.6) - at(0.5, 0.6)).norm() < 1e-9, "the nearer leg");
    let around = (nearest(0.9, 1.1) - at(1.0, 1.0)).norm();
    assert!((around - 0.5).abs() < 1e-9, "it is half a metre from the corner that points in");
    // In a corridor of 0.6 m there are 0.3 m on both sides, not 0.5.
    let narrow = border(&[[-0.3, -5.0], [0.3, -5.0], [0.3, 5.0], [-0.3, 5.0]]);
    let found_m = narrow.nearest_inside(at(2.0, 1.0), 0.5);
    assert!((found_m - at(0.05, 1.0)).norm() < 1e-9, "{found_m}");
    // So there are in one of 0.9 m between two rooms: the next place with half a metre is in a room.
    let one = [[-2.0, -2.0], [2.0, -2.0], [2.0, -0.45], [6.0, -0.45], [6.0, -2.0], [9.0, -2.0]];
    let mirrored = one.map(|[x, y]| [x, -y]).into_iter().rev();
    let two_rooms = border(&one.into_iter().chain(mirrored).collect::<Vec<_>>());
    for (y_m, found_y_m) in [(0.1, 0.1), (0.4, 0.2), (-0.9, -0.2)] {
        let found_m = two_rooms.nearest_inside(at(4.0, y_m), 0.5);
        assert!((found_m - at(4.0, found_y_m)).norm() < 1e-9, "{found_m}");
    }
}

#[test]
fn a_straight_flight_between_two_places_inside_may_leave_an_l() {
    let fence = FlightLimits::new(border(&L), 0.3, 3.0);
    let pose = |x_m, y_m| Pose { x_m, y_m, z_m: 1.0, yaw_deg: 7.0 };
    let stop = |from, to, margin_m| fence.stop_before(&from, &to, margin_m, 0.5);
    assert_eq!(stop(pose(0.0, -1.0), pose(0.0, 3.0), 0.0), None);
    // It touches the corner that points in.
    assert_eq!(stop(pose(0.0, 0.0), pose(3.0, 3.0), 1e-6), None);
    assert_eq!(stop(pose(0.5, 0.4), pose(1.6, 1.7), 0.15), None, "as near as a drone flies");
    let before = stop(pose(0.0, -1.0), pose(3.0, 2.0), 0.0).unwrap();
    assert_eq!(before, pose(0.5, 0.0), "half a metre before (1, 0)");
    // From outside it comes in and stays.
    assert_eq!(stop(pose(1.1, 0.0), pose(0.0, 0.0), 0.0), None);
    let round = FlightLimits::default();
    assert_eq!(round.stop_before(&pose(9.0, 0.0), &pose(0.0, 9.0), 0.0, 0.5), None);
}

#[test]
fn a_drone_stops_before_it_leaves() {
    let l = border(&L);
    let stop = |x_m, y_m| l.stop_inside(at(-1.7, 0.0), at(x_m, y_m), 0.5);
    assert!((stop(-1.7, 2.0) - at(-1.5, 2.0)).norm() < 1e-9, "it flies along the side");
    assert!((stop(-2.3, 2.0) - at(-1.5, 1.0)).norm() < 1e-9, "and would pass it");
    // Across the notch: it stops before it, not in the other leg.
    let before_m = l.stop_inside(at(0.0, -1.0), at(3.0, 2.0), 0.5);
    assert!((before_m - at(0.5, 0.0)).norm() < 1e-9, "{before_m}");
    let round = Border::circle(4.0);
    assert_eq!(
        round.stop_inside(at(3.7, 0.0), at(3.7, 2.0), 0.5),
        round.nearest_inside(at(3.7, 2.0), 0.5)
    );
}

#[test]
fn a_ray_along_a_side_is_inside_as_far_as_the_side() {
    let l = border(&L);
    assert!((l.room_m(at(-2.0, 0.0), at(0.0, 1.0), 1e-6) - 4.0).abs() < 1e-5);
    assert!((l.room_m(at(0.0, 1.0), at(1.0, 0.0), 1e-6) - 4.0).abs() < 1e-5);
    // Across what is missing: the notch is 3 m wide there, and what is beyond it is not asked.
    let u = border(&[
        [-3.0, -1.0],
        [3.0, -1.0],
        [3.0, 3.0],
        [1.0, 3.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 3.0],
        [-3.0, 3.0],
    ]);
    assert!((u.room_m(at(-2.0, 2.0), at(1.0, 0.0), 0.0) - 1.0).abs() < 1e-9);
    assert!((u.room_m(at(-2.0, 2.0), at(1.0, 0.0), 0.4) - 1.4).abs() < 1e-9);
    assert!(
        (u.room_m(at(-2.0, 2.0), at(1.0, 0.0), 1.0) - 6.0).abs() < 1e-9,
        "it is never further outside"
    );
    // From outside: to where it would leave again; and not at all.
    assert!((u.room_m(at(-5.0, 2.0), at(1.0, 0.0), 0.0) - 4.0).abs() < 1e-9);
    assert!((u.room_m(at(-5.0, 2.0), at(-1.0, 0.0), 0.0) + 2.0).abs() < 1e-9);
    assert!((u.room_m(at(0.0, 0.0), Vector2::zeros(), 0.0) - 1.0).abs() < 1e-9, "it stands");
}

#[test]
fn corners_that_enclose_nothing_to_fly_in_are_refused() {
    let refused = |corners_m: &[[f64; 2]]| Border::polygon(corners_m).unwrap_err();
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    assert!(Border::polygon(&square).is_ok());
    assert_eq!(refused(&square[..2]), BorderError::TooFew(2));
    assert_eq!(refused(&[[0.0; 2]; MAX_CORNERS + 1]), BorderError::TooMany(MAX_CORNERS + 1));
    for wrong in [f64::NAN, f64::INFINITY, 200.1] {
        assert_eq!(refused(&[square[0], [wrong, 0.0], square[2]]), BorderError::Far(2));
    }
    let crossed = [square[0], square[2], square[1], square[3]];
    assert_eq!(refused(&crossed), BorderError::Meets(1, 3));
    let twice = [square[0], square[1], square[1], square[2], square[3]];
    assert!(matches!(refused(&twice), BorderError::Meets(..)));
    let spike = [square[0], square[1], [9.0, -1.0], square[1], square[2], square[3]];
    assert!(matches!(refused(&spike), BorderError::Meets(..)));
    let back = [square[0], square[1], [5.0, -1.0], [3.0, -1.0], square[2], square[3]];
    assert!(matches!(refused(&back), BorderError::Meets(..)));
    // One corner lies on another side.
    let pinched = [square[0], square[1], square[2], [0.0, -1.0], square[3]];
    assert!(matches!(refused(&pinched), BorderError::Meets(..)));
    assert_eq!(refused(&[[-1.0, 0.0], [1.0, 0.0], [0.0, 0.00009]]), BorderError::Meets(1, 2));
    let thin = [[-1.0, -0.1], [1.0, -0.1], [1.0, 0.1], [-1.0, 0.1]];
    assert!(matches!(refused(&thin), BorderError::Small { .. }), "{}", refused(&thin));
    let aside = square.map(|[x, y]| [x + 1.5, y]);
    assert_eq!(refused(&aside), BorderError::StartOutside);
    assert_eq!(refused(&square.map(|[x, y]| [x + 1.0, y])), BorderError::StartOutside, "on it");
}

#[test]
fn a_border_is_told_as_it_was_given() {
    let l = border(&L);
    assert_eq!(l.shape(), Shape::Polygon(&L));
    assert_eq!(l.to_string(), "a polygon of 6 corners");
    assert_eq!(Border::circle(4.0).to_string(), "4 m around the start");
    assert!((l.furthest_m() - 32.0_f64.sqrt()).abs() < 1e-9);
    let sides: Vec<_> = l.sides_m().collect();
    assert_eq!((sides.len(), sides[5]), (6, [L[5], L[0]]));
    assert_eq!(Border::circle(4.0).sides_m().count(), 360);
    assert_eq!(l.how_far(at(5.0, 2.0)), "1.00 m outside the fence");
}

#[test]
fn just_outside_one_side_the_others_are_still_there() {
    let square = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
    let border = Border::polygon(&square).unwrap();
    for x_m in [3.99, 4.01] {
        let ahead_m = border
            .walls(Vector2::new(x_m, 3.9))
            .filter_map(|wall| (wall.outward.y > 0.9).then_some(wall.distance_m));
        let least_m = ahead_m.fold(f64::INFINITY, f64::min);
        assert!((least_m - 0.1).abs() < 1e-9, "{x_m}: {least_m}");
    }
}
