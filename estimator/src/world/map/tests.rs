use super::*;
use crate::Start;
use crate::world::camera::Look;
use crate::world::history::Moment;

const NONE: [bool; SLOTS] = [false; SLOTS];

/// A drone that hovers at 2 m and sees what is given.
struct Bench {
    filter: Filter,
    map: Map,
    orientation: Orientation,
}

fn at(right_m: f64) -> Vector2<f64> {
    Vector2::new(right_m, 0.0)
}

impl Bench {
    fn new(surveyed: &[SurveyedTag]) -> Self {
        let mut slots = [None; MAX_TAGS];
        for (slot, tag) in slots.iter_mut().zip(surveyed) {
            *slot = Some(*tag);
        }
        let mut filter = Filter::new(!surveyed.is_empty(), &Start::default());
        let map = Map::new(&slots, &mut filter);
        Self { filter, map, orientation: Orientation::new(None) }
    }

    /// With surveyed tags at these places.
    fn with_known(right_m: &[f64]) -> Self {
        let known = |right_m: &f64| SurveyedTag { place_m: at(*right_m), heading_deg: None };
        Self::new(&right_m.iter().map(known).collect::<Vec<_>>())
    }

    fn sighted(&self, place_m: Vector2<f64>) -> Sighted {
        let (height_m, tilt_deg) = (2.0, Vector2::zeros());
        let look = Look { offset_m: Vector2::zeros(), height_m, orientation_deg: 0.0 };
        let moment = Moment { place_m, speed_m_s: 0.0, yaw_deg: 0.0, tilt_deg, height_m };
        self.filter.sighted(&look, &moment, 0.0)
    }

    /// The tag of a sighting at a time.
    fn see(&mut self, right_m: f64, now_s: f64) -> Option<usize> {
        let sighted = self.sighted(at(right_m));
        self.map.associate(&mut self.filter, &sighted, &NONE, now_s)
    }

    fn saw(&mut self, tag: usize, now_s: f64) -> Option<usize> {
        self.map.saw(&mut self.filter, &self.orientation, tag, now_s, 0.0, false)
    }

    /// The number of sightings after which a new tag here counts as a known one, which is returned.
    fn until_known(&mut self, right_m: f64, now_s: f64, is_cautious: bool) -> Option<(u32, usize)> {
        assert_eq!(self.see(right_m, now_s), None);
        let tag = (0..SLOTS).find(|tag| self.map.is_new(*tag)).unwrap();
        (1..=100).find_map(|sights| {
            let known =
                self.map.saw(&mut self.filter, &self.orientation, tag, now_s, 0.0, is_cautious);
            known.map(|known| (sights, known))
        })
    }
}

#[test]
fn a_tag_is_known_after_its_trial() {
    let mut bench = Bench::new(&[]);
    assert_eq!(bench.see(1.0, 0.0), None, "the first sighting begins a trial");
    assert!(bench.map.is_new(0) && !bench.map.is_known(0) && bench.map.known() == 0);
    assert_eq!(bench.see(1.05, 0.1), Some(0));
    for sights in 1..=10 {
        assert_eq!(bench.saw(0, 0.1), None);
        assert!(!bench.map.is_new(0));
        assert_eq!(bench.map.is_likely(0), sights >= 3, "{sights}");
    }
    assert_eq!(bench.saw(0, 0.1), Some(0));
    assert!(bench.map.is_known(0) && bench.map.known() == 1 && !bench.map.is_likely(0));
    assert_eq!(bench.saw(0, 0.2), Some(0));
    // After one has moved it takes longer.
    assert_eq!(Bench::new(&[]).until_known(1.0, 0.0, true), Some((61, 0)));
    assert_eq!(Bench::new(&[]).until_known(1.0, 0.0, false), Some((11, 0)));
}

#[test]
fn surveyed_tags_are_known_from_the_start() {
    let surveyed = [
        SurveyedTag { place_m: Vector2::new(1.0, 2.0), heading_deg: Some(30.0) },
        SurveyedTag { place_m: Vector2::new(-3.0, 1.0), heading_deg: None },
    ];
    let mut bench = Bench::new(&surveyed);
    let known = bench.map.known_tags(&bench.filter, 0.0);
    let known: Vec<&KnownTag> = known.iter().collect();
    assert_eq!(known.len(), 2);
    for (known, surveyed) in known.iter().zip(surveyed) {
        assert_eq!(known.place_m, surveyed.place_m);
        assert_eq!(known.heading_deg.is_some(), surveyed.heading_deg.is_some());
        assert!(known.surveyed && known.uncertainty_m > 0.0);
    }
    assert!((known[0].heading_deg.unwrap() - 30.0).abs() < 1e-9);
    assert!(bench.map.has_heading(0) && !bench.map.has_heading(1));
    assert_eq!((bench.map.known(), bench.map.is_known(2)), (2, false));
    // A direction that was found is forgotten with the sign, one that was measured is not.
    bench.until_known(5.0, 0.0, false);
    bench.map.learnt_heading(2);
    assert!(bench.map.has_heading(2));
    let known = bench.map.known_tags(&bench.filter, 0.0);
    assert!(!known.iter().last().unwrap().surveyed);
    bench.map.forget_found_headings();
    assert!(bench.map.has_heading(0) && !bench.map.has_heading(2));
}

#[test]
fn a_sighting_is_of_the_one_tag_in_view_that_is_near() {
    // 0.3 m.
    for (off_m, found) in [(0.29, Some(0)), (0.31, None), (-0.29, Some(0)), (-0.31, None)] {
        let mut bench = Bench::new(&[]);
        bench.see(1.0, 0.0);
        assert_eq!(bench.see(1.0 + off_m, 0.5), found, "{off_m}");
        assert_eq!(bench.map.is_new(1), found.is_none(), "another tag");
    }
    let mut bench = Bench::new(&[]);
    bench.see(0.0, 0.0);
    assert_eq!(bench.see(NEAR_M, 0.1), None, "exactly");
    // In view for a second.
    for (now_s, found) in [(IN_VIEW_S, Some(0)), (IN_VIEW_S + 0.01, None)] {
        let mut bench = Bench::new(&[]);
        bench.see(1.0, 0.0);
        assert_eq!(bench.see(1.0, now_s), found);
    }
    // Once in a packet.
    let mut bench = Bench::new(&[]);
    bench.see(1.0, 0.0);
    let mut seen = NONE;
    seen[0] = true;
    let sighted = bench.sighted(at(1.0));
    assert_eq!(bench.map.associate(&mut bench.filter, &sighted, &seen, 0.1), None);
    assert!(!bench.map.is_new(1), "it is no other tag either");
    // The next tag must be twice as far.
    for (off_m, found) in [(0.16, Some(0)), (0.168, None)] {
        let mut bench = Bench::new(&[]);
        bench.see(1.0, 0.0);
        bench.see(1.5, 0.0);
        assert_eq!(bench.see(1.0 + off_m, 0.1), found, "{off_m}");
        assert!(!bench.map.is_new(2));
    }
    let mut bench = Bench::new(&[]);
    bench.see(1.0, 0.0);
    bench.see(1.75, 0.0);
    assert_eq!(bench.see(1.25, 0.1), Some(0), "exactly twice");
    // Known tags come before those on trial.
    let mut bench = Bench::with_known(&[1.0]);
    bench.saw(0, 0.0);
    bench.see(1.35, 0.0);
    assert_eq!(bench.see(1.2, 0.1), Some(0));
    assert_eq!(bench.see(1.36, 0.1), Some(1));
}

#[test]
fn a_sighting_outside_the_gate_is_of_another_tag() {
    // The tag is known to 2 cm, and the drone as well, because it has just seen it often.
    let mut bench = Bench::with_known(&[1.0]);
    for _ in 0..2000 {
        let sighted = bench.sighted(at(1.0));
        bench.filter.correct(&sighted, 0);
    }
    bench.saw(0, 0.0);
    let sighted = bench.sighted(at(1.0));
    let lowest = (0..300).map(|i| 0.001 * f64::from(i)).find(|off_m| {
        let far = bench.sighted(at(1.0 + off_m));
        !bench.filter.admits(&far, 0)
    });
    if let Some(off_m) = lowest {
        assert_eq!(bench.see(1.0 + off_m, 0.1), None);
        assert!(bench.map.is_new(1));
    }
    assert!(bench.filter.admits(&sighted, 0));
}

#[test]
fn a_tag_on_trial_is_forgotten_after_two_seconds() {
    for (now_s, kept) in [(TRIAL_S, true), (TRIAL_S + 0.01, false)] {
        let mut bench = Bench::with_known(&[-4.0]);
        bench.saw(0, 0.0);
        bench.see(1.0, 0.0);
        assert_eq!(bench.filter.tag_place_m(1), at(1.0));
        bench.map.forget_old(&mut bench.filter, now_s);
        assert_eq!(bench.map.is_new(1), kept);
        assert!(bench.map.is_known(0), "known ones are not");
        assert_eq!(bench.filter.tag_uncertainty_m(1) > 0.0, kept);
    }
}

#[test]
fn a_known_tag_that_was_out_of_view_is_recognised_by_six_sightings() {
    let mut bench = Bench::with_known(&[1.0]);
    assert_eq!(bench.until_known(1.1, 5.0, false), Some((6, 0)));
    assert!(!bench.map.is_likely(1) && !bench.map.is_new(1), "the trial is over");
    assert_eq!(bench.see(1.0, 5.1), Some(0), "it is in view");
    assert!((bench.filter.tag_place_m(0) - at(1.0)).norm() < 0.05);
    let mut bench = Bench::with_known(&[1.0]);
    assert_eq!(bench.until_known(1.1, 5.0, true), Some((61, 0)), "cautiously");
    // One that is in view is not seen twice.
    for (seen_s, known) in [(4.0, (11, 1)), (3.99, (6, 0))] {
        let mut bench = Bench::with_known(&[1.0]);
        bench.saw(0, seen_s);
        // A sighting that is too far for it.
        assert_eq!(bench.until_known(1.35, 5.0, false), Some(known), "{seen_s}");
    }
    // Neither of two that are about as near, and not one that is too far.
    for (right_m, known) in [(1.12, (11, 2)), (2.9, (11, 2))] {
        let mut bench = Bench::with_known(&[1.0, 1.3]);
        assert_eq!(bench.until_known(right_m, 5.0, false), Some(known), "{right_m}");
    }
    let mut bench = Bench::with_known(&[1.0, 2.125]);
    assert_eq!(bench.until_known(1.375, 5.0, false), Some((6, 0)), "exactly twice as far");
}

#[test]
fn after_a_long_drift_the_nearest_tag_may_be_another() {
    // The drone has drifted by this much, and sees a tag 0.8 m from one of two that are 3.2 m apart.
    for (drift_m, known) in [(0.5, (6, 0)), (1.2, (11, 2))] {
        let mut bench = Bench::with_known(&[1.0, 4.2]);
        bench.filter.doubt_place(drift_m * drift_m);
        assert_eq!(bench.until_known(1.8, 5.0, false), Some(known), "{drift_m}");
    }
}

/// A drone with one tag that it has found by itself, as tag 0 at 0 m, and which has drifted since.
fn with_found(drift_m: f64) -> Bench {
    let mut bench = Bench::new(&[]);
    assert_eq!(bench.until_known(0.0, 0.0, false), Some((11, 0)));
    bench.filter.doubt_place(drift_m * drift_m);
    bench
}

#[test]
fn after_a_long_drift_the_only_known_tag_may_be_another_too() {
    // Odds of 10 for 0.1 unknown tags per square metre: two deviations at 0.2 m of drift, none beyond 0.4 m.
    for (drift_m, off_m, is_it) in [
        (0.2, 0.2, true),
        (0.2, 0.6, false),
        (0.35, 0.1, true),
        (0.35, 0.6, false),
        (0.5, 0.0, false),
    ] {
        let mut bench = with_found(drift_m);
        let known = if is_it { (6, 0) } else { (11, 1) };
        assert_eq!(bench.until_known(off_m, 5.0, false), Some(known), "{drift_m}, {off_m}");
        // What is not certain to be another one is not forgotten for it.
        assert!(bench.map.is_known(0), "{drift_m}, {off_m}");
    }
    // Where tags were surveyed, others are hardly expected.
    for (drift_m, known) in [(0.5, (6, 0)), (1.4, (11, 1))] {
        let mut bench = Bench::with_known(&[1.0]);
        bench.filter.doubt_place(drift_m * drift_m);
        assert_eq!(bench.until_known(1.8, 5.0, false), Some(known), "surveyed, {drift_m}");
    }
}

#[test]
fn directions_distinguish_tags_that_look_alike() {
    // The known one was seen in this direction.
    let recognised = |drift_m: f64, direction_deg: f64| {
        let mut bench = with_found(drift_m);
        for _ in 0..40 {
            bench.orientation.saw(0, 0.0, 270.0);
        }
        bench.orientation.saw_on_trial(1, 0.0, 270.0 + direction_deg);
        bench.until_known(0.3, 5.0, false).unwrap().1 == 0
    };
    assert!(
        recognised(0.5, 0.0) && recognised(0.5, 8.0),
        "after a drift that position alone cannot decide"
    );
    assert!(!recognised(0.5, 40.0) && !recognised(0.5, 180.0));
    assert!(recognised(0.2, 0.0) && !recognised(0.2, 90.0), "a contradiction counts as well");
    assert!(!recognised(2.0, 0.0), "a direction may agree by chance");
}

#[test]
fn a_known_tag_that_reappears_elsewhere_was_moved() {
    // Within a metre, and not while the old one is still seen.
    for (right_m, seen_s, kept) in [(2.98, 0.0, false), (3.0, 0.0, true), (2.98, 4.5, true)] {
        let mut bench = Bench::with_known(&[2.0, -6.0]);
        bench.saw(0, seen_s);
        assert_eq!(bench.until_known(right_m, 5.0, false), Some((11, 2)));
        assert_eq!(bench.map.is_known(0), kept, "{right_m}, {seen_s}");
        assert!(bench.map.is_known(1) && bench.map.is_known(2));
    }
}

#[test]
fn there_is_room_for_eight_known_tags() {
    let mut bench = Bench::with_known(&[0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0]);
    assert_eq!(bench.until_known(40.0, 5.0, false), Some((11, 7)));
    assert_eq!(bench.until_known(50.0, 5.0, false), None);
    assert_eq!(bench.map.known(), MAX_TAGS);
    for right_m in [60.0, 70.0] {
        assert_eq!(bench.see(right_m, 5.0), None);
    }
    assert!(bench.map.is_new(SLOTS - 1), "and three on trial");
    assert_eq!(bench.see(80.0, 5.0), None);
    assert_eq!(bench.see(80.0, 5.0), None, "the next is not even on trial");
}

#[test]
fn residuals_that_do_not_average_out_show_that_a_tag_moves() {
    let mut bench = Bench::with_known(&[1.0]);
    let mut watch = |off_m: f64, speed_m_s: f64, aside_m: f64| {
        bench.map.watch(0, Vector2::new(0.6, -0.8) * off_m, 2.0, aside_m, speed_m_s);
        bench.map.moves(0)
    };
    // 3 cm, 2.5 % of the height and 15 % of the offset, of which one residual counts an eighth.
    let most_m = 0.03 + 0.025 * 2.0 + 0.15 * 0.4;
    assert!(!watch(8.0 * most_m - 0.01, 0.0, 0.4));
    // The mean keeps seven eighths.
    assert!(!watch(most_m + 0.005, 0.0, 0.4));
    assert!(watch(most_m + 0.01, 0.0, 0.4));
    assert!((0..40).any(|_| !watch(0.0, 0.0, 0.4)), "it averages out");
    // A fast drone says nothing.
    assert!(!watch(9.0, SLOW_M_S + 0.01, 0.4));
    assert!(watch(9.0, SLOW_M_S, 0.4));
}

#[test]
fn a_moving_tag_is_forgotten_with_all_that_are_on_trial() {
    let mut bench = Bench::with_known(&[0.0, 5.0]);
    bench.see(10.0, 0.0);
    bench.see(12.0, 0.0);
    bench.map.forget_moving(&mut bench.filter, 0);
    assert!(!bench.map.is_known(0) && bench.map.is_known(1));
    assert!(!bench.map.is_new(2) && !bench.map.is_new(3));
    assert_eq!(bench.map.known(), 1);
    // The slot is free again, and the state covers the other tag still.
    assert_eq!(bench.see(20.0, 0.0), None);
    assert!(bench.map.is_new(0));
    let sighted = bench.sighted(at(5.2));
    bench.filter.correct(&sighted, 1);
    assert!(bench.filter.correction().place_m.x < -0.1, "it corrects the drone");
}

#[test]
fn a_mean_residual_at_the_limit_is_no_motion() {
    // At 2 m, right below: 0.08 m.
    for (off_m, moves) in [(8.0 * 0.08, false), (8.0 * 0.081, true)] {
        let mut bench = Bench::with_known(&[1.0]);
        bench.map.watch(0, at(off_m), 2.0, 0.0, 0.0);
        assert_eq!(bench.map.moves(0), moves);
    }
}

#[test]
fn a_forgotten_tag_takes_no_other_out_of_use() {
    let is_corrected = |bench: &mut Bench, tag: usize| {
        let before_m = bench.filter.tag_place_m(tag);
        let sighted = bench.sighted(before_m + at(0.2));
        bench.filter.correct(&sighted, tag);
        bench.filter.tag_place_m(tag) != before_m
    };
    // Every slot is taken, and the first on trial is forgotten.
    let mut bench = Bench::with_known(&[0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0]);
    for (right_m, now_s) in [(50.0, 0.0), (60.0, 1.5), (70.0, 1.5)] {
        bench.see(right_m, now_s);
    }
    bench.map.forget_old(&mut bench.filter, 2.1);
    assert!(!bench.map.is_new(8) && bench.map.is_new(9) && bench.map.is_new(10));
    assert!((0..SLOTS).filter(|tag| *tag != 8).all(|tag| is_corrected(&mut bench, tag)));
    // The last one is forgotten.
    let mut bench = Bench::with_known(&[0.0, 5.0]);
    bench.see(10.0, 0.0);
    bench.map.forget_old(&mut bench.filter, 2.1);
    assert!((0..2).all(|tag| is_corrected(&mut bench, tag)));
}

#[test]
fn the_number_of_a_tag_is_not_given_to_another() {
    let mut bench = Bench::with_known(&[0.0, 5.0]);
    let ids = |bench: &Bench| -> Vec<u32> {
        bench.map.known_tags(&bench.filter, 9.0).iter().map(|tag| tag.id).collect()
    };
    bench.map.forget_moving(&mut bench.filter, 0);
    // It takes the free slot, before the other one.
    assert_eq!(bench.until_known(20.0, 7.0, false), Some((11, 0)));
    assert_eq!(ids(&bench), [2, 3]);
    let known = bench.map.known_tags(&bench.filter, 9.5);
    let seen_ago: Vec<_> = known.iter().map(|tag| tag.seen_ago).collect();
    assert_eq!(seen_ago, [None, Some(Duration::from_millis(2500))]);
}
