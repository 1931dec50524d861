//! Tags on the floor of a flight: those that are there, those that the pilot was told of, and what happens to them.

use std::time::Duration;

use autopilot::vehicle::{SurveyedTag, TagConfig};
use mock_drone::scenario::{Action, When};
use mock_drone::{CameraModel, FloorTag};
use nalgebra::Vector2;
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Tags are drawn from a sequence of their own: the rest of a flight is the same with and without them.
const SEQUENCE: u64 = 19;
/// One flight in so many has tags.
const ONE_IN: u64 = 3;
/// The end of a plan that needs no tag.
const LAND: &str = "land\n";
/// Error of a careful survey, on each axis, in m.
const SURVEY_ERROR_M: f64 = 0.05;

/// Tags of a flight.
#[derive(Debug, Clone)]
pub(super) struct Tags {
    /// On the floor at the start.
    pub(super) laid: Vec<FloorTag>,
    /// The pilot's knowledge.
    pub(super) config: TagConfig,
    /// The drone's camera.
    pub(super) camera: CameraModel,
    /// Tags that are moved or taken away.
    pub(super) accidents: Vec<(When, Action)>,
    /// The end of the plan.
    last_steps: &'static str,
    /// Whether a survey is wrong by metres.
    pub(super) is_survey_wrong: bool,
}

impl Tags {
    /// The tags of a seed's flight, if it has any.
    pub(super) fn of(seed: u64, has_hard_sensors: bool) -> Option<Self> {
        if !seed.is_multiple_of(ONE_IN) {
            return None;
        }
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(SEQUENCE);
        let random = &mut random;
        let camera = camera(random, has_hard_sensors);
        // Sometimes there is none, although they are in use.
        let number: usize = random.random_range(0..4);
        let laid: Vec<FloorTag> = (0..number).map(|_| tag(random, 2.5)).collect();
        let mut config = TagConfig::default();
        let is_surveyed = random.random_bool(0.4);
        let is_survey_wrong = is_surveyed && !laid.is_empty() && random.random_bool(0.25);
        if is_surveyed {
            let most_m = if is_survey_wrong { 2.0 } else { SURVEY_ERROR_M };
            for (slot, tag) in config.surveyed.iter_mut().zip(&laid) {
                *slot = Some(surveyed(random, tag, most_m));
            }
        }
        let mut accidents = Vec::new();
        if !laid.is_empty() && random.random_bool(0.3) {
            let at = Duration::from_secs_f64(random.random_range(0.0..60.0));
            let moved = random.random_range(0..laid.len());
            let to = random.random_bool(0.5).then(|| tag(random, 2.5));
            accidents.push((When::SinceTakeOff(at), Action::MoveTag(moved, to)));
        }
        let last_steps = match random.random_range(0..6) {
            0 if !laid.is_empty() => "findTag\nland\n",
            1 if !laid.is_empty() => "landOnTag\n",
            _ => LAND,
        };
        Some(Self { laid, config, camera, accidents, last_steps, is_survey_wrong })
    }

    /// Whether the plan needs one.
    pub(super) fn are_sought(&self) -> bool {
        self.last_steps != LAND
    }

    /// A plan with the steps for tags.
    pub(super) fn change(&self, plan: &str) -> String {
        plan.replace(LAND, self.last_steps)
    }

    /// Description, one line each.
    pub(super) fn circumstances(&self) -> Vec<String> {
        let tags = self.laid.iter().zip(&self.config.surveyed).map(|(tag, surveyed)| {
            let place = |place_m: Vector2<f64>| format!("{:.2} {:.2}", place_m.x, place_m.y);
            let survey = surveyed.map_or_else(
                || "not surveyed".to_owned(),
                |surveyed| format!("surveyed at {}", place(surveyed.place_m)),
            );
            format!("tag at {}, {survey}", place(tag.place_m))
        });
        let sights = format!("tags in use, {:.1} % false sights", 100.0 * self.camera.false_sights);
        std::iter::once(sights).chain(tags).collect()
    }
}

fn camera(random: &mut impl Rng, is_hard: bool) -> CameraModel {
    let camera = if is_hard { CameraModel::hard() } else { CameraModel::nominal() };
    let false_sights =
        if random.random_bool(0.2) { random.random_range(0.0..0.05) } else { camera.false_sights };
    CameraModel { false_sights, ..camera }
}

fn tag(random: &mut impl Rng, most_m: f64) -> FloorTag {
    let mut place_m = || random.random_range(-most_m..most_m);
    let (right_m, forward_m) = (place_m(), place_m());
    FloorTag::new(right_m, forward_m, random.random_range(-180.0..180.0))
}

fn surveyed(random: &mut impl Rng, tag: &FloorTag, most_m: f64) -> SurveyedTag {
    let mut error_m = || random.random_range(-most_m..most_m);
    let place_m = tag.place_m + Vector2::new(error_m(), error_m());
    SurveyedTag { place_m, heading_deg: random.random_bool(0.5).then_some(tag.heading_deg) }
}
