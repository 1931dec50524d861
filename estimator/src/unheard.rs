//! The velocity of a drone that did not receive all of its orders in a gap.

use kinematics::Airframe;
use nalgebra::Vector2;

use crate::Estimator;
use crate::horizontal::Horizontal;
use crate::orders::Order;
use crate::silence::{KEPT_S, TRIED, last_heard_s};

/// A drone that has kept its sticks for longer than this has a tilt that differs by no more than this, and by this
/// share, from the one that they ask for.
const TILT_SETTLES_S: f64 = 0.4;
const TILT_RAD: f64 = 0.03;
const TILT_SHARE: f64 = 0.25;
/// Fine enough for a tilt that hardly changes.
const STEP_S: f64 = 0.02;

impl Estimator {
    /// Velocities after a gap (right, forward in the world) of a drone that did not receive all of its orders, the latest
    /// loss first. Where packets arrived in a share of the gap, they are nearer to `heard_m_s`, as ordered. A drone that
    /// kept its sticks has the tilt that they ask for, and is excluded if it has another one (right, forward).
    pub(crate) fn unheard_m_s(
        &self,
        [from_s, to_s]: [f64; 2],
        tilt_rad: Vector2<f64>,
        heard_m_s: Vector2<f64>,
        share: f64,
    ) -> [Option<Vector2<f64>>; TRIED] {
        let mut unheard_m_s = [None; TRIED];
        if share <= 0.0 {
            return unheard_m_s;
        }
        let (mut heard, mut heard_s) = (self.horizontal, from_s);
        for (until_s, unheard_m_s) in last_heard_s(from_s, to_s).zip(unheard_m_s.iter_mut().rev()) {
            heard = self.horizontal_at(heard, heard_s, until_s);
            heard_s = until_s;
            let kept = self.horizontal_kept(heard, until_s, to_s);
            if self.may_be_kept(&kept, until_s, to_s, tilt_rad) {
                *unheard_m_s = Some(heard_m_s + (kept.velocity_m_s - heard_m_s) * share);
            }
        }
        unheard_m_s
    }

    /// The state of a drone that keeps its order for a while, and then hovers by itself.
    fn horizontal_kept(&self, mut state: Horizontal, from_s: f64, to_s: f64) -> Horizontal {
        let kept = self.orders.at(from_s);
        let mut now_s = from_s;
        while now_s < to_s - 1e-9 {
            let step_s = STEP_S.min(to_s - now_s);
            let order = if now_s - from_s < KEPT_S { kept } else { Order::ByItself };
            let yaw_deg = self.heading_at(now_s);
            state.advance(step_s, order, yaw_deg, self.airframe(), &self.config.limits);
            now_s += step_s;
        }
        state
    }

    /// Whether a drone with this tilt may have kept its sticks. The tilt of a drone that hovers by itself is unknown.
    fn may_be_kept(
        &self,
        kept: &Horizontal,
        from_s: f64,
        to_s: f64,
        tilt_rad: Vector2<f64>,
    ) -> bool {
        let by_itself = self.orders.at(from_s) == Order::ByItself || to_s - from_s >= KEPT_S;
        let kept_rad = kept.tilt_rad();
        let most_rad = TILT_RAD + TILT_SHARE * kept_rad.norm();
        // One that has not tilted yet may tilt more than was assumed: the nearest of these tilts counts.
        let most = (Airframe::STRONGEST_TILT / self.airframe().tilt_gain).max(1.0);
        let scale = kept_rad.dot(&tilt_rad) / kept_rad.norm_squared().max(f64::EPSILON);
        let nearest_rad = kept_rad * scale.clamp(1.0, most);
        by_itself || to_s - from_s < TILT_SETTLES_S || (nearest_rad - tilt_rad).norm() <= most_rad
    }
}
