//! Tags on the floor: what navdata tell of them, and the small turn by which it is learnt how to read them.

use std::time::Duration;

use ardrone_link::navdata::{Packet, VisionDetect};
use estimator::{EstimatorConfig, MAX_SIGHTS, MAX_TAGS, NoRoom, Prediction, Sight};
use kinematics::Pose;
use nalgebra::Vector2;

use super::{Refused, TagStatus, Vehicle, VehicleConfig};
use crate::agent::TagPercepts;
use crate::plan::Plan;

/// The black and white roundel, with or without its direction: `ardrone_api.h`.
const ROUNDELS: [u32; 2] = [3, 8];
/// The bottom camera, at full speed and in step with the hover.
const BOTTOM: [u32; 2] = [1, 2];

/// The tags below the drone that a packet tells of.
pub(super) fn sights(packet: &Packet<'_>) -> Sights {
    packet.vision_detect().map_or(Sights::default(), |detected| Sights::new(&detected))
}

/// At most as many as a packet has room for.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sights {
    all: [Sight; MAX_SIGHTS],
    count: usize,
}

impl Sights {
    fn new(detected: &VisionDetect) -> Self {
        let mut sights = Self::default();
        let count = usize::try_from(detected.count).unwrap_or(MAX_SIGHTS).min(MAX_SIGHTS);
        for slot in 0..count {
            let (source, kind) = (detected.kinds[slot] >> 16, detected.kinds[slot] & 0xFFFF);
            if !ROUNDELS.contains(&kind) || !BOTTOM.contains(&source) {
                continue;
            }
            sights.all[sights.count] = Sight {
                x: f64::from(detected.x[slot]),
                y: f64::from(detected.y[slot]),
                width: f64::from(detected.widths[slot]),
                height: f64::from(detected.heights[slot]),
                distance_m: detected.distances_m[slot],
                orientation_deg: f64::from(detected.orientations_deg[slot]),
            };
            sights.count += 1;
        }
        sights
    }
}

impl std::ops::Deref for Sights {
    type Target = [Sight];

    fn deref(&self) -> &[Sight] {
        &self.all[..self.count]
    }
}

/// A tag that was seen this recently is in view.
const IN_VIEW: Duration = Duration::from_millis(500);
/// Displacement during the drone's own landing from 0.3 m, for the acceleration that the wind gives to a level drone:
/// half the square of its duration of 1.2 s, less half of that, which the drone's own hold takes back.
const LANDING_DRIFT_S2: f64 = 0.4;
/// Largest displacement that is compensated, in metres: the wind's estimate contains the airframe's errors.
const LARGEST_DRIFT_M: f64 = 0.3;

/// How far the drone turns to and fro to learn which way orientations count, and how long once takes.
const SWING_DEG: f64 = 8.0;
const SWING_S: f64 = 6.0;

/// The turn to and fro above the first tag.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SignSearch {
    /// So much of it is over.
    time_s: f64,
}

impl Vehicle {
    /// The percepts about tags.
    pub(super) fn tag_percepts(
        &self,
        now: Duration,
        state: &Prediction,
        status: &TagStatus,
    ) -> TagPercepts {
        let age = status.seen_ago.unwrap_or(now.saturating_sub(self.flight.asked_at));
        let here_m = state.position_m.xy();
        let places_m = status.known.iter().map(|tag| tag.place_m);
        let nearest = places_m.min_by(|a, b| (a - here_m).norm().total_cmp(&(b - here_m).norm()));
        TagPercepts {
            age_ms: i64::try_from(age.as_millis()).unwrap_or(i64::MAX),
            seen: nearest.is_some() && status.seen_ago.is_some_and(|ago| ago < IN_VIEW),
            nearest_m: nearest.map(Into::into),
            landing_drift_m: landing_drift_m(self.flight.wind.mean_m_s2()).into(),
        }
    }

    /// Checks that there is room for the tags that a plan declares, where tags are in use, and adds them to a
    /// flight that has begun, and does not land yet. A flight that begins later begins with them.
    pub(super) fn take_tags_of(&mut self, plan: &Plan) -> Result<(), Refused> {
        let Some(tags) = &self.config.estimator.tags else { return Ok(()) };
        let declared = plan.tags().len();
        let given = tags.surveyed.iter().flatten().count();
        if given + declared > MAX_TAGS {
            return Err(Refused::TooManyTags { declared, known: given });
        }
        let flies = self.life.is_in_flight() && !self.lands();
        if !flies && self.life.departure().is_none() {
            return Ok(());
        }
        let estimator = &mut self.flight.estimator;
        let known = estimator.tag_status(Duration::ZERO).map_or(0, |status| status.known.count());
        estimator.survey(plan.tags()).map_err(|NoRoom| Refused::TooManyTags { declared, known })
    }

    /// The configuration with the tags that the mission's plan declares, where tags are in use.
    pub(super) fn with_mission_tags(&self) -> VehicleConfig {
        let mut config = self.config.clone();
        if let Some(tags) = &mut config.estimator.tags {
            let free = tags.surveyed.iter_mut().filter(|slot| slot.is_none());
            for (slot, tag) in free.zip(self.mission.tags()) {
                *slot = Some(*tag);
            }
        }
        config
    }

    /// Where a take-off that has ended at `pose` is taken to have led: there, but above the origin of the world if tags give
    /// one and the drone started there.
    pub(super) fn hover_place(&self, pose: Pose) -> Pose {
        let EstimatorConfig { tags, start, .. } = &self.config.estimator;
        let is_above_origin = tags.is_some() && start.is_none();
        if is_above_origin { Pose { z_m: pose.z_m, ..Pose::default() } } else { pose }
    }

    /// The target, turned a little to and fro while that teaches how to read the tag below.
    pub(super) fn turned_to_learn(&mut self, now: Duration, target: &Pose, step_s: f64) -> Pose {
        let search = &mut self.flight.sign_search;
        if !self.flight.estimator.would_learn_from_a_turn(now) {
            search.time_s = 0.0;
            return *target;
        }
        search.time_s += step_s;
        let swing_deg = SWING_DEG * (std::f64::consts::TAU * search.time_s / SWING_S).sin();
        Pose { yaw_deg: target.yaw_deg + swing_deg, ..*target }
    }
}

/// Displacement during the drone's own landing, in metres, under this disturbance.
fn landing_drift_m(disturbance_m_s2: Vector2<f64>) -> Vector2<f64> {
    (disturbance_m_s2 * LANDING_DRIFT_S2).cap_magnitude(LARGEST_DRIFT_M)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_tags_below_the_drone_count_and_never_more_than_fit() {
        let mut detected = VisionDetect { count: 4_000_000, ..VisionDetect::default() };
        detected.kinds = [1 << 16 | 8, 8, 2 << 16 | 3, 1 << 16 | 6];
        detected.x = [1, 2, 3, 4];
        let sights = Sights::new(&detected);
        let x: Vec<f64> = sights.iter().map(|sight| sight.x).collect();
        assert_eq!(x, [1.0, 3.0]);
    }

    #[test]
    fn the_wind_displaces_a_landing_in_its_direction_and_only_so_far_is_compensated() {
        let drift_m = |x, y| landing_drift_m(Vector2::new(x, y));
        assert!((drift_m(0.5, -0.25) - Vector2::new(0.2, -0.1)).norm() < 1e-12);
        assert!((drift_m(0.0, -3.0) - Vector2::new(0.0, -LARGEST_DRIFT_M)).norm() < 1e-12);
    }

    #[test]
    fn a_take_off_leads_above_the_origin_that_tags_give_or_to_where_the_drone_is() {
        let there = Pose { x_m: 1.0, y_m: 2.0, z_m: 0.8, yaw_deg: 30.0 };
        let origin = |tags, start| {
            let mut config = VehicleConfig::default();
            config.estimator.tags = tags;
            config.starts_at(start);
            Vehicle::new(&config).unwrap().hover_place(there)
        };
        assert_eq!(origin(None, None), there);
        let above = Pose { z_m: 0.8, ..Pose::default() };
        assert_eq!(origin(Some(super::super::TagConfig::default()), None), above);
        let tags = Some(super::super::TagConfig::default());
        assert_eq!(origin(tags, Some(estimator::Start::default())), there, "the mission knows it");
    }
}
