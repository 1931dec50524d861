//! Tells velocities that no drone can reach from changes by gusts, storms and orders.

use nalgebra::Vector2;

use crate::rejected::{Motion, Rejected, Shown};
use crate::sensor::{FLOW_M_S, GATE, MODEL};
use crate::silence::{Silence, USUAL_STEP_S};

/// Standard deviation of what gusts and an airframe that is not identified yet add to the velocity, and the time within
/// which they do.
const GUST_M_S: f64 = 0.13;
const GUST_S: f64 = 0.1;
/// After a jump the velocity must come back to this fraction of the allowed difference.
const RETURN_SHARE: f64 = 0.5;
/// Largest difference between measured and expected velocity beyond that, however it came about.
const MAX_SURPRISE_M_S: f64 = 1.3;

/// Share of what velocities are wrong by that a storm explains: a noisy one moves on by chance, but not evenly.
const NEARLY_ALL: f64 = 0.9;

/// Separates velocities that jump, as no drone can, from changes by gusts. (right, forward) in the world
/// frame.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct VelocityGate {
    last_m_s: Option<Vector2<f64>>,
    jumped: bool,
    /// The last velocity is that of a drone that stands.
    rests: bool,
    silence: Silence,
    rejected: Rejected<2>,
}

/// Judgement of a velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Judged {
    Believed,
    Rejected,
    /// It is believed although those before were rejected: the drone has been pushed for this time, as by a storm.
    Pushed {
        by_m_s2: Vector2<f64>,
        for_s: f64,
    },
}

/// The model's velocity before and after a step, (right, forward) in the world frame.
#[allow(clippy::struct_field_names, reason = "the unit belongs to the name")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foreseen<'a> {
    pub(crate) before_m_s: Vector2<f64>,
    pub(crate) after_m_s: Vector2<f64>,
    /// Velocities after the step of a drone that did not receive all of its orders, sorted by the time of the last one
    /// that it received, the latest first; none if packets arrived all the time.
    pub(crate) unheard_m_s: &'a [Option<Vector2<f64>>],
}

impl Foreseen<'_> {
    /// Distance of a velocity from the nearest that is explained by the orders, received or not: those between two
    /// are explained too. The predicted changes may be wrong by a share.
    fn off_m_s(&self, m_s: Vector2<f64>, share: f64) -> f64 {
        let scaled =
            |m_s: Vector2<f64>, scale: f64| self.before_m_s + (m_s - self.before_m_s) * scale;
        let mut off_m_s = f64::INFINITY;
        let mut last_m_s = self.after_m_s;
        for after_m_s in [&self.after_m_s].into_iter().chain(self.unheard_m_s.iter().flatten()) {
            let [less, more] = [1.0 - share, 1.0 + share].map(|scale| scaled(*after_m_s, scale));
            off_m_s = off_m_s.min(distance_m_s(m_s, less, more));
            for scale in [1.0 - share, 1.0, 1.0 + share] {
                let (from, to) = (scaled(last_m_s, scale), scaled(*after_m_s, scale));
                off_m_s = off_m_s.min(distance_m_s(m_s, from, to));
            }
            last_m_s = *after_m_s;
        }
        off_m_s
    }
}

/// Distance of a velocity from those between two others.
fn distance_m_s(m_s: Vector2<f64>, from_m_s: Vector2<f64>, to_m_s: Vector2<f64>) -> f64 {
    let way = to_m_s - from_m_s;
    let share = (m_s - from_m_s).dot(&way) / way.norm_squared().max(1e-12);
    (m_s - from_m_s - way * share.clamp(0.0, 1.0)).norm()
}

impl VelocityGate {
    /// Whether the newest velocity is rejected because it jumped.
    pub(crate) fn has_jumped(&self) -> bool {
        self.jumped
    }

    /// A packet was sent at a time, in seconds, whatever is in it.
    pub(crate) fn hear(&mut self, at_s: f64) {
        self.silence.hear(at_s);
    }

    /// Share of the `step_s` since the last velocity in which no packets arrived, and the drone may not have received
    /// its orders. The velocity is measured now.
    pub(crate) fn unheard_share(&mut self, step_s: f64) -> f64 {
        let share = self.silence.end(step_s);
        if self.rests { 0.0 } else { share }
    }

    /// The drone stands: what it reports is compared with rest once it flies. Otherwise the first velocity of a flight
    /// would be accepted whatever it is, and a constant error with it.
    pub(crate) fn rest(&mut self) {
        let silence = self.silence;
        *self = Self { last_m_s: Some(Vector2::zeros()), rests: true, silence, ..Self::default() };
    }

    /// Judges a velocity that was measured `step_s` after the last one. After a jump only a velocity near the model's is
    /// believed, or one that moves on.
    pub(crate) fn judge(
        &mut self,
        measured_m_s: Vector2<f64>,
        foreseen: &Foreseen<'_>,
        step_s: f64,
    ) -> Judged {
        if self.admits(measured_m_s, foreseen, step_s) {
            self.rejected = Rejected::default();
            return Judged::Believed;
        }
        self.rejected.add(measured_m_s - foreseen.after_m_s, step_s);
        match self.rejected.shown() {
            Some(Shown::Motion(Motion { rate_1_s, for_s, explains })) if explains >= NEARLY_ALL => {
                self.rejected = Rejected::default();
                self.jumped = false;
                Judged::Pushed { by_m_s2: rate_1_s, for_s }
            }
            _ => Judged::Rejected,
        }
    }

    fn admits(&mut self, measured_m_s: Vector2<f64>, foreseen: &Foreseen<'_>, step_s: f64) -> bool {
        let Some(last_m_s) = self.last_m_s.replace(measured_m_s) else { return true };
        // The flow may measure nothing new for a second while the drone lifts off, which is no time to speed up.
        let rests = std::mem::take(&mut self.rests);
        let longest_s = if rests { USUAL_STEP_S } else { f64::INFINITY };
        let step_s = step_s.min(longest_s);
        let gust_m_s = GUST_M_S * (1.0 - (-step_s / GUST_S).exp());
        let allowed_m_s = GATE * (std::f64::consts::SQRT_2 * FLOW_M_S).hypot(gust_m_s);
        let gap_s = (step_s - USUAL_STEP_S).max(0.0);
        // A change in a shorter time is within what gusts do.
        let share = MODEL * gap_s / (gap_s + USUAL_STEP_S);
        let surprise_m_s = foreseen.off_m_s(measured_m_s, share);
        let changed_m_s = foreseen.before_m_s + measured_m_s - last_m_s;
        let unforeseen_m_s = foreseen.off_m_s(changed_m_s, share);
        let jumps = surprise_m_s > allowed_m_s && unforeseen_m_s > allowed_m_s;
        // Hysteresis: a drone that hovers meanwhile comes near any small false value.
        let lasts = self.jumped && surprise_m_s > RETURN_SHARE * allowed_m_s;
        self.jumped = jumps || lasts;
        !self.jumped && surprise_m_s <= MAX_SURPRISE_M_S + allowed_m_s
    }
}

#[cfg(test)]
mod tests;
