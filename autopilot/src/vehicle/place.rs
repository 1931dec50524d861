//! Whether anything contradicts the claimed place.
//!
//! Navdata cannot show that a velocity is wrong that agrees with itself. What is claimed is told with its condition, and
//! compared with what else knows of the place: tags on the floor, and the flight recorder's GPS, by which nothing is flown.

use std::time::Duration;

use ardrone_link::navdata::GpsFix;
use estimator::TagStatus;
use nalgebra::Vector2;

use super::cross_check::IN_VIEW;
use super::since::Since;
use super::{CrossCheck, FlightEvent, Vehicle};

/// A drone that was heard this recently is heard.
const HEARD: Duration = Duration::from_millis(150);
/// So long a tag must be due and unseen. Of 45 pictures in this time a bad camera misses not all.
const UNSEEN_S: f64 = 3.0;
/// So many of its own expected errors the GPS must be further away or nearer than the place, besides so many of the
/// place's deviations, for so long: the receiver measures once per second, its errors stay for many, and they are half as
/// large again as it expects.
const GPS_ERRORS: f64 = 4.0;
const DEVIATIONS: f64 = 4.0;
const GPS_LASTS: Duration = Duration::from_secs(5);
const METRES_PER_DEGREE: f64 = 111_320.0;

/// What was seen of the place in a flight besides what it was integrated from.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct CrossChecks {
    contradicts: Option<CrossCheck>,
    unseen_s: f64,
    /// The GPS where the drone stood before the flight.
    start: Option<GpsFix>,
    gps_off: Since,
}

impl CrossChecks {
    /// The first source that contradicted the place.
    pub(super) fn contradicts(&self) -> Option<CrossCheck> {
        self.contradicts
    }

    /// The tags in one tick; whether they contradict the place.
    fn see_tags(&mut self, tags: &TagStatus, step_s: f64) -> bool {
        match tags.seen_ago {
            Some(ago) if ago > IN_VIEW && tags.is_due => self.unseen_s += step_s,
            Some(ago) if ago > IN_VIEW => {}
            // Whether it would be seen at all is not known yet.
            Some(_) | None => self.unseen_s = 0.0,
        }
        tags.given_up > 0 || self.unseen_s > UNSEEN_S
    }

    /// The GPS of a drone that claims to be at this place, relative to its start; whether it contradicts that. The direction
    /// in which the drone looked at the start is not known: only distances are compared.
    fn see_gps(
        &mut self,
        now: Duration,
        fix: &GpsFix,
        place_m: Vector2<f64>,
        uncertainty_m: f64,
    ) -> bool {
        let Some(start) = &self.start else { return false };
        let off_m = (distance_m(start, fix) - place_m.norm()).abs();
        let error_m = start.horizontal_error_m.hypot(fix.horizontal_error_m);
        let is_off = off_m > GPS_ERRORS * error_m + DEVIATIONS * uncertainty_m;
        self.gps_off.lasts(now, is_off, GPS_LASTS)
    }
}

fn distance_m(from: &GpsFix, to: &GpsFix) -> f64 {
    let north_m = (to.latitude_deg - from.latitude_deg) * METRES_PER_DEGREE;
    // The short way round the earth.
    let east_deg = kinematics::wrap_deg(to.longitude_deg - from.longitude_deg);
    north_m.hypot(east_deg * METRES_PER_DEGREE * from.latitude_deg.to_radians().cos())
}

impl Vehicle {
    /// Compares the claimed place with what else knows of it, in one tick.
    pub(super) fn cross_check(&mut self, now: Duration, tags: Option<&TagStatus>, step_s: f64) {
        let fix = self.gps(now);
        if self.on_ground() && self.flight.report().took_off_at.is_none() {
            self.flight.cross_checks.start = fix.or(self.flight.cross_checks.start);
            return;
        }
        let heard = self.session.silence(now).is_some_and(|age| age <= HEARD);
        let flight = &mut self.flight;
        let start_m = self.config.estimator.start.unwrap_or_default().place_m;
        let place_m = flight.estimator.estimate().position_m.xy() - start_m;
        let uncertainty_m = flight.estimator.uncertainty_m(now);
        let cross_checks = &mut flight.cross_checks;
        // In a silence nothing can be seen.
        let seen_s = if heard { step_s } else { 0.0 };
        let by_tags = tags.is_some_and(|tags| cross_checks.see_tags(tags, seen_s));
        let by_gps = fix.is_some_and(|fix| cross_checks.see_gps(now, &fix, place_m, uncertainty_m));
        let found = by_tags.then_some(CrossCheck::Tags).or(by_gps.then_some(CrossCheck::Gps));
        if cross_checks.contradicts.is_none()
            && let Some(by) = found
        {
            cross_checks.contradicts = Some(by);
            self.events.push_back(FlightEvent::PlaceContradicted { by });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK_S: f64 = 0.03;

    #[test]
    fn a_tag_that_is_due_and_not_seen_contradicts_and_one_that_never_was_seen_does_not() {
        let contradicts = |tags: TagStatus| {
            let mut cross_checks = CrossChecks::default();
            (0..110).any(|_| cross_checks.see_tags(&tags, TICK_S))
        };
        let seen_ago = |s| Some(Duration::from_secs(s));
        let unseen = TagStatus { seen_ago: seen_ago(4), is_due: true, ..TagStatus::default() };
        assert!(contradicts(unseen));
        assert!(!contradicts(TagStatus { is_due: false, ..unseen }));
        assert!(!contradicts(TagStatus { seen_ago: seen_ago(0), ..unseen }));
        assert!(!contradicts(TagStatus { seen_ago: None, ..unseen }));
        assert!(!contradicts(TagStatus { seen_ago: Some(IN_VIEW), ..unseen }));
        assert!(contradicts(TagStatus { given_up: 1, ..TagStatus::default() }));
        let mut cross_checks = CrossChecks::default();
        let moments =
            (0..90).map(|_| unseen).chain([TagStatus { seen_ago: seen_ago(0), ..unseen }]);
        let mut moments = moments.chain((0..90).map(|_| unseen));
        assert!(!moments.any(|tags| cross_checks.see_tags(&tags, TICK_S)));
    }

    /// Somewhere north of the start.
    fn north(m: f64) -> GpsFix {
        GpsFix {
            latitude_deg: 48.0 + m / METRES_PER_DEGREE,
            longitude_deg: 2.0,
            elevation_m: 60.0,
            horizontal_error_m: 3.0,
            satellites: 8,
        }
    }

    #[test]
    fn a_gps_contradicts_that_is_further_off_than_both_may_be_for_long_enough() {
        let contradicts_after = |gps_m: f64, place_m: f64| {
            let mut cross_checks =
                CrossChecks { start: Some(north(0.0)), ..CrossChecks::default() };
            let place_m = Vector2::new(place_m, 0.0);
            (0..20).find(|second| {
                cross_checks.see_gps(Duration::from_secs(*second), &north(gps_m), place_m, 0.5)
            })
        };
        // Four times 3 m √2, and four times half a metre: 19.0 m.
        assert_eq!(contradicts_after(18.8, 0.0), None);
        assert_eq!(contradicts_after(19.2, 0.0), Some(5));
        assert_eq!(contradicts_after(28.0, 10.0), None, "in any direction");
        assert_eq!(contradicts_after(0.0, 19.2), Some(5), "it stands");
        // One that is exact agrees with a place that is.
        let exact = GpsFix { horizontal_error_m: 0.0, ..north(0.0) };
        let mut agrees = CrossChecks { start: Some(exact), ..CrossChecks::default() };
        let mut seconds = (0..20).map(Duration::from_secs);
        assert!(!seconds.any(|now| agrees.see_gps(now, &exact, Vector2::zeros(), 0.0)));
        let mut fresh = CrossChecks::default();
        assert!(!fresh.see_gps(Duration::from_secs(9), &north(99.0), Vector2::zeros(), 0.0));
    }

    #[test]
    fn distances_are_those_on_the_ground() {
        let at = |latitude_deg, longitude_deg| GpsFix { latitude_deg, longitude_deg, ..north(0.0) };
        assert!((distance_m(&at(60.0, 2.0), &at(60.0, 2.001)) - 55.66).abs() < 0.01);
        assert!((distance_m(&at(0.0, 179.999), &at(0.0, -179.999)) - 222.64).abs() < 0.01);
    }

    /// Where the drone is not above it a tag is not due, which says nothing of it.
    #[test]
    fn a_tag_is_missed_for_three_seconds_in_all_since_it_was_in_view() {
        let due = TagStatus {
            seen_ago: Some(Duration::from_secs(4)),
            is_due: true,
            ..TagStatus::default()
        };
        let elsewhere = TagStatus { is_due: false, ..due };
        let in_view = TagStatus { seen_ago: Some(IN_VIEW), ..elsewhere };
        for (between, contradicts) in [(due, true), (elsewhere, false), (in_view, false)] {
            let mut cross_checks = CrossChecks::default();
            let mut see = |tags: &TagStatus| cross_checks.see_tags(tags, 1.0);
            assert_eq!([see(&due), see(&due), see(&due)], [false; 3]);
            assert_eq!(see(&between), contradicts);
            assert_eq!(see(&due), between != in_view);
        }
    }
}
