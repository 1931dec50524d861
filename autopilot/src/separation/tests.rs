use super::*;
use crate::fence::Border;

const AT: Duration = Duration::from_secs(10);

const ONESELF: Oneself = Oneself {
    system: 1,
    rank: None,
    place_m: Vector2::new(0.0, 0.0),
    velocity_m_s: Vector2::new(0.0, 0.0),
    uncertainty_m: 0.0,
    separation_m: 1.5,
};

fn neighbour(x_m: f64, y_m: f64) -> Neighbour {
    Neighbour {
        system: 2,
        at: AT,
        place_m: Vector2::new(x_m, y_m),
        velocity_m_s: Vector2::zeros(),
        uncertainty_m: 0.0,
        separation_m: 1.5,
        presence: Presence::Flies,
        claim: None,
    }
}

fn seen(now: Duration, oneself: &Oneself, neighbour: &Neighbour) -> Other {
    other(now, oneself, &Known { told: *neighbour, doubt_m: 0.0 })
}

/// How far away the line between the two is.
fn room_m(now: Duration, oneself: &Oneself, neighbour: &Neighbour) -> f64 {
    seen(now, oneself, neighbour).wall(oneself.place_m).distance_m
}

#[test]
fn two_at_rest_share_what_is_left_between_them() {
    assert!((room_m(AT, &ONESELF, &neighbour(3.0, 4.0)) - 1.75).abs() < 1e-9);
    let wall = seen(AT, &ONESELF, &neighbour(3.0, 4.0)).wall(Vector2::new(0.6, 0.8));
    assert!((wall.distance_m - 0.75).abs() < 1e-9, "a metre nearer");
    assert!((wall.outward - Vector2::new(0.6, 0.8)).norm() < 1e-9);
    assert!(room_m(AT, &ONESELF, &neighbour(1.0, 0.0)) < 0.0, "too near");
    assert!(room_m(AT, &ONESELF, &neighbour(0.0, 0.0)) < 0.0, "in one place");
}

/// What each of two that know the same of each other has is together what there is.
#[test]
fn both_draw_the_same_line() {
    let (velocity_m_s, other_m_s) = (Vector2::new(0.8, 0.3), Vector2::new(-0.2, 0.6));
    let (oneself, there) = (
        Oneself { velocity_m_s, uncertainty_m: 0.3, ..ONESELF },
        Neighbour { velocity_m_s: other_m_s, uncertainty_m: 0.4, ..neighbour(6.0, 0.0) },
    );
    let seen_from_there = (
        Oneself { place_m: there.place_m, velocity_m_s: other_m_s, uncertainty_m: 0.4, ..ONESELF },
        Neighbour { velocity_m_s, uncertainty_m: 0.3, ..neighbour(0.0, 0.0) },
    );
    let [ours_m, theirs_m] = [(oneself, there), seen_from_there]
        .map(|(oneself, neighbour)| room_m(AT, &oneself, &neighbour));
    assert!((ours_m + theirs_m - (6.0 - 1.5 - 2.0 * 0.5)).abs() < 1e-9, "{ours_m} {theirs_m}");
    // Whoever is fast has what it needs to stop, and half of what both do not need.
    let [ours_stop_m, theirs_stop_m] = [0.8, 0.2].map(|m_s| Stopping::CAUTIOUS.way_m(m_s));
    assert!(((ours_m - ours_stop_m) - (theirs_m - theirs_stop_m)).abs() < 1e-9);
}

#[test]
fn nobody_has_room_beyond_the_separation() {
    let fast = Oneself { velocity_m_s: Vector2::new(2.0, 0.0), ..ONESELF };
    assert!((room_m(AT, &fast, &neighbour(2.5, 0.0)) - 1.0).abs() < 1e-9);
    assert!((room_m(AT, &fast, &neighbour(1.0, 0.0)) + 0.25).abs() < 1e-9, "each goes half of it");
}

#[test]
fn who_is_not_heard_goes_on_for_a_moment_and_may_then_be_anywhere() {
    let flying = Neighbour { velocity_m_s: Vector2::new(1.0, 0.0), ..neighbour(2.0, 0.0) };
    for (age_ms, ahead_m, reach_m) in
        [(0, 0.0, 0.0), (200, 0.2, 0.06), (300, 0.3, 0.135), (500, 0.3, 0.575), (4000, 0.3, 12.0)]
    {
        let (place_m, found_m) = flying.reach(AT + Duration::from_millis(age_ms));
        assert!((place_m.x - 2.0 - ahead_m).abs() < 1e-9, "{age_ms} {place_m}");
        assert!((found_m - reach_m).abs() < 1e-9, "{age_ms} {found_m}");
    }
    let early = AT.saturating_sub(Duration::from_secs(1));
    assert_eq!(flying.reach(early), (flying.place_m, 0.0), "its clock may be ahead");
}

fn heard(neighbours: &[Neighbour]) -> (Neighbours, Vec<Result<(), NotHeard>>) {
    let mut known = Neighbours::default();
    let results = neighbours.iter().map(|neighbour| known.hear(*neighbour)).collect();
    (known, results)
}

#[test]
fn only_those_in_the_air_are_avoided_and_the_newest_counts() {
    let landed = Neighbour { system: 3, presence: Presence::Stands, ..neighbour(0.0, 2.0) };
    let moved = Neighbour { at: AT + Duration::from_millis(100), ..neighbour(2.1, 0.0) };
    let (known, results) = heard(&[neighbour(2.0, 0.0), landed, moved, neighbour(1.9, 0.0)]);
    assert_eq!(results, [Ok(()); 4]);
    let others = known.others(moved.at, &ONESELF);
    assert_eq!(others.len(), 1);
    assert!((others[0].place_m.x - 2.1).abs() < 1e-9);
}

#[test]
fn who_is_where_it_cannot_have_got_to_is_as_uncertain_as_that() {
    let after = |ms, x_m| Neighbour { at: AT + Duration::from_millis(ms), ..neighbour(x_m, 0.0) };
    let result = |next| heard(&[neighbour(2.0, 0.0), next]).1[1];
    assert_eq!(result(after(100, 2.3)), Ok(()), "a tag may have corrected it");
    assert_eq!(result(after(100, 2.4)), Err(NotHeard::Jumps));
    assert_eq!(result(after(1000, 3.7)), Ok(()), "meanwhile it may have got there");
    assert_eq!(result(after(1000, 3.9)), Err(NotHeard::Jumps));
    let uncertain = Neighbour { uncertainty_m: 0.5, ..after(100, 4.3) };
    assert_eq!(result(uncertain), Ok(()), "it was not exactly known");
    // It is kept away from as from one whose place has that deviation, and by less as time goes on.
    let keeps_m = |told: &[Neighbour]| {
        let (known, _) = heard(told);
        let others = known.others(told[told.len() - 1].at, &ONESELF);
        (others[0].place_m.x, others[0].keep_m)
    };
    let is = |(x_m, keep_m): (f64, f64), [expected_x_m, expected_m]: [f64; 2]| {
        (x_m - expected_x_m).abs() < 1e-9 && (keep_m - expected_m).abs() < 1e-9
    };
    let jump = [neighbour(2.0, 0.0), after(100, 9.0)];
    assert!(is(keeps_m(&jump), [9.0, 1.5 + 2.0 * 7.0]));
    let later = after(10_100, 9.0);
    assert!(is(keeps_m(&[jump[0], jump[1], later]), [9.0, 1.5 + 2.0 * 6.0]));
    assert!(!heard(&jump).0.is_heard(2, jump[1].at), "nobody takes off");
    let again = after(10_200, 14.0);
    assert!(is(keeps_m(&[jump[0], jump[1], later, again]), [14.0, 1.5 + 2.0 * 5.99]));
    let over = [jump[0], jump[1], after(70_200, 9.0)];
    assert!(is(keeps_m(&over), [9.0, 1.5]));
    assert!(heard(&over).0.is_heard(2, over[2].at));
    let landed = Neighbour { presence: Presence::Stands, ..after(200, 9.0) };
    let (_, results) = heard(&[neighbour(2.0, 0.0), after(100, 9.0), landed, after(300, 9.0)]);
    assert_eq!(results[2..], [Ok(()); 2]);
    let over = [neighbour(2.0, 0.0), after(100, 9.0), landed, after(300, 9.0)];
    assert!(is(keeps_m(&over), [9.0, 1.5]), "on the ground it begins anew");
}

/// Whoever is only uncertain, or silent, is likelier where it tells than on the other side.
#[test]
fn who_contradicts_itself_by_more_than_it_is_far_may_be_in_any_direction() {
    let is_anywhere = |uncertainty_m, doubt_m, age_ms| {
        let known = Known { told: Neighbour { uncertainty_m, ..neighbour(3.0, 0.0) }, doubt_m };
        other(AT + Duration::from_millis(age_ms), &ONESELF, &known).is_anywhere(ONESELF.place_m)
    };
    assert!(!is_anywhere(0.0, 1.49, 0) && is_anywhere(0.0, 1.51, 0));
    assert!(!is_anywhere(9.0, 0.0, 0) && !is_anywhere(0.0, 0.0, 9000));
}

/// Whichever of the two keeps further away.
#[test]
fn the_larger_separation_counts_for_both() {
    let wide = Neighbour { separation_m: 3.0, ..neighbour(5.0, 0.0) };
    assert!((room_m(AT, &ONESELF, &wide) - 1.0).abs() < 1e-9);
    let oneself = Oneself { separation_m: 3.0, ..ONESELF };
    assert!((room_m(AT, &oneself, &neighbour(5.0, 0.0)) - 1.0).abs() < 1e-9);
}

#[test]
fn nonsense_is_not_heard_nor_more_than_fit() {
    let nan = Vector2::new(f64::NAN, 0.0);
    for nonsense in [
        Neighbour { place_m: nan, ..neighbour(1.0, 0.0) },
        Neighbour { velocity_m_s: nan, ..neighbour(1.0, 0.0) },
        Neighbour { uncertainty_m: f64::INFINITY, ..neighbour(1.0, 0.0) },
        Neighbour { separation_m: f64::NAN, ..neighbour(1.0, 0.0) },
        Neighbour { uncertainty_m: -0.1, ..neighbour(1.0, 0.0) },
    ] {
        assert_eq!(heard(&[nonsense]).1, [Err(NotHeard::Nonsense)], "{nonsense:?}");
    }
    let many: Vec<Neighbour> =
        (1..=32).map(|system| Neighbour { system, ..neighbour(1.0, 0.0) }).collect();
    let (known, results) = heard(&many);
    assert_eq!(results[MAX_NEIGHBOURS - 1..], [Ok(()), Err(NotHeard::TooMany)]);
    assert_eq!(known.others(AT, &ONESELF).len(), MAX_NEIGHBOURS);
}

/// Where somebody at the origin flies on its way forward.
fn past(target_m: f64, neighbours: &[(f64, f64)]) -> Vector2<f64> {
    let others = neighbours.iter().map(|(x_m, y_m)| seen(AT, &ONESELF, &neighbour(*x_m, *y_m)));
    way_past(
        Vector2::zeros(),
        Vector2::new(0.0, target_m),
        &others.collect(),
        &Border::circle(99.0),
    )
}

#[test]
fn who_is_in_the_way_is_passed_on_its_right() {
    let straight = Vector2::new(0.0, 6.0);
    assert_eq!(past(6.0, &[]), straight);
    assert_eq!(past(6.0, &[(1.6, 3.0), (-1.6, 3.0), (0.0, -2.0)]), straight, "none is in the way");
    assert_eq!(past(6.0, &[(0.0, 5.0)]), straight, "it is where somebody else is, and waits");
    assert_eq!(past(6.0, &[(0.0, 8.0)]), straight, "behind the target");
    // Along the tangent: 30° to the right, as the sine is half.
    let tangent = Vector2::new(3.0, 27.0_f64.sqrt());
    assert!((past(6.0, &[(0.0, 3.0)]) - tangent).norm() < 1e-9);
    assert!((past(6.0, &[(0.0, 3.0), (0.0, 4.2)]) - tangent).norm() < 1e-9, "the nearest decides");
    // Nearer than the tangent, it goes aside.
    assert!((past(6.0, &[(0.0, 1.2)]) - Vector2::new(6.0, 0.0)).norm() < 1e-9);
}

#[test]
fn who_is_silent_or_flies_near_is_known_before_a_take_off() {
    let after = |ms| AT + Duration::from_millis(ms);
    let jumped = Neighbour { at: after(100), ..neighbour(9.0, 0.0) };
    let (known, _) = heard(&[neighbour(2.0, 0.0)]);
    assert!(known.is_heard(2, after(2000)) && !known.is_heard(2, after(2001)));
    assert!(!known.is_heard(3, AT), "never heard");
    assert!(!heard(&[neighbour(2.0, 0.0), jumped]).0.is_heard(2, after(100)), "not believed");
    let near = |neighbour: Neighbour| -> Vec<(u8, f64)> {
        heard(&[neighbour]).0.too_near(AT, ONESELF).collect()
    };
    assert_eq!(near(neighbour(1.4, 0.0)), [(2, 1.4)]);
    assert_eq!(near(neighbour(1.6, 0.0)), []);
    let near_if = |presence, uncertainty_m, system, x_m| {
        near(Neighbour { system, uncertainty_m, presence, ..neighbour(x_m, 0.0) }).len() == 1
    };
    let (stands, starts) = (Presence::Stands, Presence::Starts);
    assert!(
        near_if(stands, 0.5, 2, 1.4) && !near_if(stands, 0.5, 2, 1.6),
        "where it is told to be"
    );
    assert!(near_if(starts, 0.0, 2, 1.4) && !near_if(starts, 0.0, 2, 1.6));
    assert!(near_if(starts, 0.5, 0, 2.4), "the lower number takes off first");
    assert!(!near_if(starts, 0.5, 2, 2.4));
}

/// Where somebody at the origin flies to on its way forward that passes another one, in a room so wide to the right and left.
fn past_in_a_room(right_m: f64, left_m: f64) -> Vector2<f64> {
    let corners_m = [[-left_m, -9.0], [right_m, -9.0], [right_m, 9.0], [-left_m, 9.0]];
    let border = Border::polygon(&corners_m).unwrap();
    let others = [seen(AT, &ONESELF, &neighbour(0.0, 3.0))].into_iter().collect();
    way_past(Vector2::zeros(), Vector2::new(0.0, 6.0), &others, &border)
}

#[test]
fn it_is_passed_on_its_left_where_only_there_is_room() {
    // The tangents touch 1.3 m to the right and left.
    for (right_m, left_m, is_right) in
        [(1.4, 9.0, true), (1.2, 9.0, false), (1.2, 1.2, true), (9.0, 1.2, true)]
    {
        let past_m = past_in_a_room(right_m, left_m);
        assert_eq!(past_m.x > 0.0, is_right, "{right_m} {left_m}: {past_m}");
        assert!((past_m.x.abs() - 3.0).abs() < 1e-9, "{past_m}");
    }
}

fn claim(x_m: f64, y_m: f64, system: u8, behind: u8) -> Claim {
    Claim { to_m: Vector2::new(x_m, y_m), rank: Rank { system, behind } }
}

/// Another one 4 m to the left that wants to get 8 m to the right, as seen by somebody with a claim or none.
fn passing(rank: Option<Rank>, claim: Claim) -> Others {
    let there = Neighbour { claim: Some(claim), ..neighbour(-4.0, 0.0) };
    [seen(AT, &Oneself { system: 3, rank, ..ONESELF }, &there)].into_iter().collect()
}

#[test]
fn the_lower_number_goes_first_and_those_that_make_way_for_it_follow() {
    let wide = Border::circle(99.0);
    let makes_way = |rank, claim| makes_way(Vector2::zeros(), &passing(rank, claim), &wide);
    let own = Some(Rank { system: 3, behind: 0 });
    assert!(makes_way(None, claim(4.0, 0.0, 200, 0)).is_some(), "who claims nothing makes way");
    let found = makes_way(own, claim(4.0, 0.0, 2, 0));
    assert_eq!(found.map(|claim| claim.rank), Some(Rank { system: 2, behind: 1 }));
    assert_eq!(makes_way(own, claim(4.0, 0.0, 4, 0)), None);
    let follows = Some(Rank { system: 2, behind: 1 });
    assert!(makes_way(follows, claim(4.0, 0.0, 2, 0)).is_some());
    // Of two that make way for the same one the lower number goes first: that of the other one is 2.
    assert!(makes_way(follows, claim(4.0, 0.0, 2, 1)).is_some());
    assert_eq!(makes_way(follows, claim(4.0, 0.0, 2, 2)), None);
    assert_eq!(makes_way(None, claim(4.0, 0.0, 2, 4)), None, "not for ever");
}

#[test]
fn way_is_made_beside_it_where_there_is_room() {
    let border = |ahead_m: f64, back_m: f64| {
        let corners_m = [[-9.0, -back_m], [9.0, -back_m], [9.0, ahead_m], [-9.0, ahead_m]];
        Border::polygon(&corners_m).unwrap()
    };
    let others = passing(None, claim(4.0, 0.0, 2, 0));
    let to_m = |here_m: Vector2<f64>, border: &Border| {
        makes_way(here_m, &others, border).map(|claim| claim.to_m)
    };
    let near = |found: Option<Vector2<f64>>, x_m: f64, y_m: f64| {
        found.is_some_and(|found| (found - Vector2::new(x_m, y_m)).norm() < 1e-6)
    };
    let here_m = Vector2::new(0.0, 0.5);
    assert!(near(to_m(here_m, &border(9.0, 9.0)), 0.0, 2.0), "half a metre more than must be");
    assert!(near(to_m(here_m, &border(1.6, 9.0)), 0.0, -2.0), "on the other side");
    assert_eq!(to_m(here_m, &border(1.6, 1.6)), None, "nowhere");
    assert_eq!(to_m(Vector2::new(0.0, 1.8), &border(9.0, 9.0)), None, "it is not in the way");
    assert!(near(to_m(Vector2::new(4.5, 0.0), &border(9.0, 9.0)), 6.0, 0.0), "behind the end");
    // Beside it those wait whose target is in it.
    let waits = |y_m, target_m: [f64; 2]| waits(Vector2::new(0.0, y_m), target_m.into(), &others);
    assert!(waits(2.4, [1.0, -1.0]) && !waits(2.6, [1.0, -1.0]) && !waits(2.4, [1.0, -2.0]));
}

#[test]
fn who_does_not_come_nearer_is_held_up_until_it_is_there() {
    let second = Duration::from_secs(1);
    let target_m = Vector2::new(5.0, 0.0);
    let mut progress = Progress::new(AT, target_m);
    let mut after = |s, x_m, makes_way| {
        progress.is_held_up(AT + second * s, Vector2::new(x_m, 0.0), target_m, makes_way)
    };
    assert_eq!([0, 5].map(|s| after(s, 0.0, false)), [false, false]);
    assert_eq!(
        [(5, 0.4), (10, 0.6), (11, 0.6)].map(|(s, x_m)| after(s, x_m, false)),
        [false, false, true]
    );
    assert!(after(12, 4.0, false), "it still wants to get there");
    assert!(!after(13, 4.8, false), "it is there");
    assert_eq!(
        [(14, true), (19, false), (20, false)].map(|(s, way)| after(s, 2.0, way)),
        [false, false, true]
    );
    let elsewhere_m = Vector2::new(2.0, 4.0);
    assert!(!progress.is_held_up(AT + second * 21, Vector2::new(2.0, 0.0), elsewhere_m, false));
}
