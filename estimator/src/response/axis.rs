//! Whether the velocity follows the tilt.

use std::collections::VecDeque;

use kinematics::{Airframe, GRAVITY_M_S2, body_from_world};
use nalgebra::Vector2;

/// The most sluggish airframe: the published ones accelerate with 0.5 to 1.03 of gravity's component at a tilt. An even
/// weaker one is landed: a dead flow leads further astray than a dead altimeter or compass.
const LEAST_THRUST: f64 = 0.4;
/// Hypotheses of the drag: the published ones. With much of it a drone soon forgets how fast it was before it braked, with
/// little it comes to rest by braking.
const DRAGS_1_S: [f64; 2] = Airframe::DRAGS_1_S;
/// If the velocity of the weakest airframe would have varied this much (standard deviation) in this many
/// seconds, either quickly or slowly, with any drag...
const AXIS_DEVIATION_M_S: f64 = 0.08;
const AXIS_WINDOWS_S: [f64; 2] = [3.0, 8.0];
/// ...a working flow shows more than this fraction of it, also while the drone compensates gusts; the noise
/// of a dead one is less.
const AXIS_SHARE: f64 = 0.3;
/// A drone that starts to tilt by this fraction of full tilt, and keeps it for a while, accelerates or
/// brakes. If it seems to stand this still (standard deviation, and mean), its flow is dead. A drone that has
/// been tilted for longer may hold its position in the wind.
pub(super) const LEANS_SHARE: f64 = 0.8;
pub(super) const LEANS_S: f64 = 2.0;
const LEVEL_SHARE: f64 = 0.0;
const LEVEL_S: f64 = 5.0;
const STILL_DEVIATION_M_S: f64 = 0.02;
const STILL_M_S: f64 = 0.04;
const SMOOTHING_S: f64 = 0.2;
const AXIS_INTERVAL_S: f64 = 0.05;
const AXIS_MEMORY: usize = 176;

/// Whether the measured velocity follows the measured tilt, along one body axis.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    /// Velocity that the most sluggish airframe of each drag would have from the tilt, in m/s.
    least_m_s: [f64; DRAGS_1_S.len()],
    /// These velocities and the measured one, smoothed alike: the flow does not follow the fastest swings.
    expected_m_s: [f64; DRAGS_1_S.len()],
    measured_m_s: f64,
    /// The newest tilt.
    tilt_rad: f64,
    recent: VecDeque<Moment>,
    /// The tilt moves the drone, but the velocity does not show it. Evaluated only for each moment that is
    /// kept, because full navdata come four times as often.
    is_dead: bool,
}

/// State of an axis at one moment of the last seconds, along the axis as it points now.
#[derive(Debug, Clone, Copy)]
struct Moment {
    at_s: f64,
    tilt_rad: f64,
    expected_m_s: [f64; DRAGS_1_S.len()],
    measured_m_s: f64,
}

impl Axis {
    pub(super) fn new() -> Self {
        let (zeros, recent) = ([0.0; DRAGS_1_S.len()], VecDeque::with_capacity(AXIS_MEMORY));
        Self {
            least_m_s: zeros,
            expected_m_s: zeros,
            measured_m_s: 0.0,
            tilt_rad: 0.0,
            recent,
            is_dead: false,
        }
    }

    /// Turns what is remembered along with the body, clockwise: a steady wind, and the tilt that holds the drone in
    /// it, would otherwise seem to change while the drone turns.
    pub(super) fn turn(right: &mut Self, forward: &mut Self, deg: f64) {
        if deg.abs() < 1e-9 {
            return;
        }
        let turn = |right: &mut f64, forward: &mut f64| {
            let turned = body_from_world(Vector2::new(*right, *forward), deg);
            (*right, *forward) = (turned.x, turned.y);
        };
        let turn_each = |right: &mut [f64], forward: &mut [f64]| {
            right.iter_mut().zip(forward).for_each(|(right, forward)| turn(right, forward));
        };
        turn_each(&mut right.least_m_s, &mut forward.least_m_s);
        turn_each(&mut right.expected_m_s, &mut forward.expected_m_s);
        turn(&mut right.measured_m_s, &mut forward.measured_m_s);
        turn(&mut right.tilt_rad, &mut forward.tilt_rad);
        for (right, forward) in right.recent.iter_mut().zip(&mut forward.recent) {
            turn(&mut right.tilt_rad, &mut forward.tilt_rad);
            turn_each(&mut right.expected_m_s, &mut forward.expected_m_s);
            turn(&mut right.measured_m_s, &mut forward.measured_m_s);
        }
    }

    pub(super) fn is_dead(&self) -> bool {
        self.is_dead
    }

    pub(super) fn watch(
        &mut self,
        at_s: f64,
        step_s: f64,
        velocity_m_s: f64,
        tilt_rad: f64,
        full_tilt_rad: f64,
    ) {
        // When it tilted in a gap is not known.
        let mean_rad = f64::midpoint(std::mem::replace(&mut self.tilt_rad, tilt_rad), tilt_rad);
        let pull_m_s2 = LEAST_THRUST * GRAVITY_M_S2 * mean_rad.tan();
        let share = 1.0 - (-step_s / SMOOTHING_S).exp();
        let hypotheses = self.least_m_s.iter_mut().zip(&mut self.expected_m_s);
        for ((least_m_s, expected_m_s), drag_1_s) in hypotheses.zip(DRAGS_1_S) {
            *least_m_s += (pull_m_s2 - drag_1_s * *least_m_s) * step_s;
            *expected_m_s += (*least_m_s - *expected_m_s) * share;
        }
        self.measured_m_s += (velocity_m_s - self.measured_m_s) * share;
        if self.recent.back().is_none_or(|last| at_s - last.at_s >= AXIS_INTERVAL_S) {
            if self.recent.len() == AXIS_MEMORY {
                self.recent.pop_front();
            }
            let Self { expected_m_s, measured_m_s, .. } = *self;
            self.recent.push_back(Moment { at_s, tilt_rad, expected_m_s, measured_m_s });
            self.is_dead =
                self.misses_swings(at_s) || self.stands_while_leaning(at_s, full_tilt_rad);
        }
    }

    /// The moments of the last `window_s` seconds.
    fn within(&self, at_s: f64, window_s: f64) -> impl ExactSizeIterator<Item = &Moment> + Clone {
        let first = self.recent.partition_point(|then| at_s - then.at_s > window_s);
        self.recent.range(first..)
    }

    /// The tilt varies, and the velocity does not. A steady wind varies neither.
    fn misses_swings(&self, at_s: f64) -> bool {
        AXIS_WINDOWS_S.iter().any(|window_s| {
            let recent = self.within(at_s, *window_s);
            let measured_m_s = deviation(recent.clone().map(|moment| moment.measured_m_s));
            (0..DRAGS_1_S.len()).all(|i| {
                let expected_m_s = deviation(recent.clone().map(|moment| moment.expected_m_s[i]));
                expected_m_s >= AXIS_DEVIATION_M_S && measured_m_s < AXIS_SHARE * expected_m_s
            })
        })
    }

    /// The drone has started to tilt, and does not move.
    fn stands_while_leaning(&self, at_s: f64, full_tilt_rad: f64) -> bool {
        let recent = self.within(at_s, LEANS_S);
        let Some(first) = recent.clone().next() else { return false };
        let lasts = at_s - first.at_s >= LEANS_S - 2.0 * AXIS_INTERVAL_S;
        let lean = |moment: &Moment| moment.tilt_rad * first.tilt_rad.signum() / full_tilt_rad;
        let leans = recent.clone().all(|moment| lean(moment) >= LEANS_SHARE);
        let was_level = self.within(at_s, LEVEL_S).any(|moment| lean(moment) <= LEVEL_SHARE);
        let measured = recent.map(|moment| moment.measured_m_s);
        let stands =
            mean(measured.clone()).abs() < STILL_M_S && deviation(measured) < STILL_DEVIATION_M_S;
        lasts && leans && was_level && stands
    }

    pub(super) fn rest(&mut self) {
        self.least_m_s = [0.0; DRAGS_1_S.len()];
        self.expected_m_s = [0.0; DRAGS_1_S.len()];
        self.measured_m_s = 0.0;
        self.tilt_rad = 0.0;
        self.recent.clear();
        self.is_dead = false;
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

/// Standard deviation.
fn deviation(values: impl ExactSizeIterator<Item = f64> + Clone) -> f64 {
    let count = values.len().max(1) as f64;
    let mean = mean(values.clone());
    (values.map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

#[cfg(test)]
mod tests;
