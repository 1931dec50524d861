//! Recent motion and tilt of the drone.

use std::collections::VecDeque;

use nalgebra::Vector2;

use super::OdometryStep;

/// More than a second of navdata at 200 packets per second.
const MEMORY: usize = 220;

/// The odometry at one moment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    pub(super) place_m: Vector2<f64>,
    pub(super) speed_m_s: f64,
    pub(super) yaw_deg: f64,
    /// Right side down, nose up.
    pub(super) tilt_deg: Vector2<f64>,
    pub(super) height_m: f64,
}

/// Positions and velocities by time.
type Places = VecDeque<(f64, (Vector2<f64>, Vector2<f64>))>;

/// Recent odometry, tilt and height, each by its own time.
#[derive(Debug, Clone)]
pub(super) struct History {
    places: Places,
    tilts: VecDeque<(f64, Vector2<f64>)>,
    heights: VecDeque<(f64, f64)>,
    newest_s: Option<f64>,
}

impl History {
    pub(super) fn new() -> Self {
        Self {
            places: VecDeque::with_capacity(MEMORY),
            tilts: VecDeque::with_capacity(MEMORY),
            heights: VecDeque::with_capacity(MEMORY),
            newest_s: None,
        }
    }

    /// Returns the displacement since the last step, and its duration, if the odometry has advanced.
    pub(super) fn push(&mut self, step: &OdometryStep) -> Option<(Vector2<f64>, f64)> {
        self.newest_s = Some(step.made_s);
        push(&mut self.tilts, step.tilt.0, step.tilt.1);
        push(&mut self.heights, step.height.0, step.height.1);
        let last = self.places.back().copied();
        let place = (step.place_m, step.velocity_m_s);
        if !push(&mut self.places, step.at_s, place) {
            return None;
        }
        last.map(|(last_s, (last_m, _))| (step.place_m - last_m, step.at_s - last_s))
    }

    /// Time of the newest sample.
    pub(super) fn newest_s(&self) -> Option<f64> {
        self.newest_s
    }

    /// The odometry at a time; `None` before the first sample.
    pub(super) fn at(&self, at_s: f64, yaw_deg: f64) -> Option<Moment> {
        let (place_m, velocity_m_s) = place_at(&self.places, at_s)?;
        Some(Moment {
            place_m,
            speed_m_s: velocity_m_s.norm(),
            yaw_deg,
            tilt_deg: between(&self.tilts, at_s, |from, to, share| from + (to - from) * share)?,
            height_m: between(&self.heights, at_s, |from, to, share| from + (to - from) * share)?,
        })
    }
}

/// Returns whether the value is newer than the last.
fn push<T>(line: &mut VecDeque<(f64, T)>, at_s: f64, value: T) -> bool {
    if line.back().is_some_and(|(last_s, _)| at_s <= *last_s) {
        return false;
    }
    if line.len() == MEMORY {
        line.pop_front();
    }
    line.push_back((at_s, value));
    true
}

/// Interpolates linearly; constant beyond the ends.
fn between<T: Copy>(
    line: &VecDeque<(f64, T)>,
    at_s: f64,
    mix: impl Fn(T, T, f64) -> T,
) -> Option<T> {
    let after = line.partition_point(|(time_s, _)| *time_s <= at_s);
    let before = after.checked_sub(1).and_then(|i| line.get(i));
    match (before, line.get(after)) {
        (Some((from_s, from)), Some((to_s, to))) => {
            Some(mix(*from, *to, (at_s - from_s) / (to_s - from_s).max(1e-9)))
        }
        (Some((_, only)), None) | (None, Some((_, only))) => Some(*only),
        (None, None) => None,
    }
}

/// Extrapolates with the velocity for a moment beyond the newest position.
fn place_at(places: &Places, at_s: f64) -> Option<(Vector2<f64>, Vector2<f64>)> {
    const LONGEST_S: f64 = 0.1;
    let (place_m, velocity_m_s) = between(places, at_s, |from, to, share| {
        (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share)
    })?;
    let ahead_s = places.back().map_or(0.0, |(newest_s, _)| at_s - newest_s);
    Some((place_m + velocity_m_s * ahead_s.clamp(0.0, LONGEST_S), velocity_m_s))
}
