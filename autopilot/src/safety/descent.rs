//! How a drone is brought down that has left the fence, or that the wind carries off.
//!
//! The drone's own landing drifts, the more the higher it begins; while navdata are usable the drone is therefore flown back
//! and down first. If it cannot come back, it still tilts against the wind and sinks faster than by itself.

use std::time::Duration;

use kinematics::Pose;
use nalgebra::Vector2;

use super::{INSIDE_M, STALE, Situation, Veto};
use crate::agent::AgentCommand;
use crate::fence::{FlightLimits, across};

/// Height above the fence's floor to which a drone that has left the fence is flown down before it lands.
pub(super) const LOW_M: f64 = 0.15;
/// Longest flight back into the fence; then the drone is landed where it is.
pub(super) const RETREAT: Duration = Duration::from_secs(10);
/// The flight back is given up when the drone neither comes nearer by [`WAY_BACK_M`] nor brakes by [`BRAKES_M_S`] in this
/// time.
pub(super) const NO_WAY_BACK: Duration = Duration::from_millis(1500);
/// Smallest loss of outward speed that counts as progress: a gust has thrown the drone out, and it is braking.
pub(super) const BRAKES_M_S: f64 = 0.5;
/// Smallest approach that counts as progress on the way back.
pub(super) const WAY_BACK_M: f64 = 0.05;
/// A drone that cannot come back is flown down against the wind to this height, and lands by itself from there.
/// Above this height it sinks faster by its sticks than in its own landing.
pub(super) const HIGH_M: f64 = 0.8;
/// Slowest descent of any airframe. A drone that takes longer than this allows, or reports no descent, is left to
/// its own landing.
pub(super) const SINKS_M_S: f64 = 0.4;
/// Distance of the target that makes the drone tilt fully against the wind on its way down.
pub(super) const UPWIND_TARGET_M: f64 = 2.0;
/// Without usable navdata for this time the drone is landed instead of flown back or down.
pub(super) const BLIND_RETREAT: Duration = Duration::from_secs(1);

/// Why a drone is brought down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cause {
    Blind,
    OutsideFence,
    CarriedOff,
    Crowded,
}

impl Cause {
    pub(super) fn veto(self) -> Veto {
        match self {
            Self::Blind => Veto::Blind,
            Self::OutsideFence => Veto::OutsideFence,
            Self::CarriedOff => Veto::CarriedOff,
            Self::Crowded => Veto::Crowded,
        }
    }
}

/// A drone that is being brought down.
#[derive(Debug, Clone, Copy)]
pub(super) struct Descent {
    pub(super) cause: Cause,
    /// End of the time for flying back into the fence.
    retreats_until: Duration,
    /// End of the time for flying down outside the fence.
    sinks_until: Duration,
    way_back: WayBack,
    /// Target of the descent against the wind.
    upwind: Pose,
    /// Place inside the fence to which the drone is flown back: the nearest one, until the drone is there.
    back_at: Pose,
}

impl Descent {
    /// Begins to bring it down.
    pub(super) fn begin(cause: Cause, now: &Situation, fence: &FlightLimits) -> Self {
        Self {
            cause,
            retreats_until: now.now + RETREAT,
            sinks_until: now.now + time_to_sink(now.pose.z_m),
            way_back: WayBack::begin(now.now),
            upwind: place_upwind(now, fence),
            back_at: fence.nearest_inside(&now.pose, INSIDE_M),
        }
    }

    /// The command of one tick.
    pub(super) fn command(&mut self, now: &Situation, fence: &FlightLimits) -> AgentCommand {
        let outside_m = fence.outside_m(&now.pose);
        self.way_back.see(now, fence);
        // Once the drone is that far inside, its target must not move with it: nothing would stop it.
        if outside_m > -INSIDE_M {
            self.back_at = fence.nearest_inside(&now.pose, INSIDE_M);
        }
        let is_hopeless = outside_m > 0.0 && self.way_back.is_none(now);
        let sinks = now.pose.z_m > HIGH_M && now.now < self.sinks_until;
        let (target, may_fly) = match self.cause {
            Cause::OutsideFence => (self.retreat(&now.pose, fence), sinks || !is_hopeless),
            Cause::CarriedOff => (Some(self.upwind), sinks),
            Cause::Blind | Cause::Crowded => (None, false),
        };
        let retreats = may_fly && now.blind_for <= BLIND_RETREAT && now.now < self.retreats_until;
        match target {
            Some(target) if retreats && now.blind_for <= STALE => AgentCommand::GoTo(target),
            Some(_) if retreats => AgentCommand::Hover,
            _ => AgentCommand::Land,
        }
    }

    /// A low place inside the fence; `None` if the drone is near it.
    fn retreat(&self, pose: &Pose, fence: &FlightLimits) -> Option<Pose> {
        let low_m = fence.floor_m + LOW_M;
        let target = Pose { z_m: low_m, ..self.back_at };
        let is_inside = fence.outside_m(pose) <= 0.0;
        let is_there = is_inside && pose.z_m <= low_m + LOW_M;
        (!is_there).then_some(target)
    }
}

/// A low target away from the border that the drone is carried to, far enough for full tilt.
fn place_upwind(now: &Situation, fence: &FlightLimits) -> Pose {
    let [right_m_s, forward_m_s, _] = now.velocity_m_s;
    let heading = Vector2::new(right_m_s, forward_m_s).try_normalize(0.0).unwrap_or_default();
    let here_m = across(&now.pose);
    let [x_m, y_m] = (here_m + fence.border.back_from(here_m, heading) * UPWIND_TARGET_M).into();
    Pose { x_m, y_m, z_m: fence.floor_m + LOW_M, ..now.pose }
}

/// Progress of a drone outside the fence on its way back.
#[derive(Debug, Clone, Copy)]
struct WayBack {
    /// Smallest distance outside, and smallest speed outward, since the last progress.
    outside_m: f64,
    away_m_s: f64,
    /// When it last came nearer, or braked.
    progress_at: Duration,
}

impl WayBack {
    fn begin(now: Duration) -> Self {
        Self { outside_m: f64::NEG_INFINITY, away_m_s: 0.0, progress_at: now }
    }

    fn see(&mut self, now: &Situation, fence: &FlightLimits) {
        let outside_m = fence.outside_m(&now.pose);
        let [right_m_s, forward_m_s, _] = now.velocity_m_s;
        let away_m_s = outward(now, fence).dot(&Vector2::new(right_m_s, forward_m_s));
        if outside_m < self.outside_m - WAY_BACK_M {
            (self.outside_m, self.progress_at) = (outside_m, now.now);
        }
        if away_m_s < self.away_m_s - BRAKES_M_S {
            (self.away_m_s, self.progress_at) = (away_m_s, now.now);
        }
        self.outside_m = self.outside_m.max(outside_m);
        self.away_m_s = self.away_m_s.max(away_m_s);
    }

    fn is_none(&self, now: &Situation) -> bool {
        now.now >= self.progress_at + NO_WAY_BACK
    }
}

/// The unit vector that points out.
fn outward(now: &Situation, fence: &FlightLimits) -> Vector2<f64> {
    fence.border.outward(across(&now.pose))
}

/// Longest descent from this height to [`HIGH_M`].
pub(super) fn time_to_sink(height_m: f64) -> Duration {
    Duration::try_from_secs_f64((height_m - HIGH_M) / SINKS_M_S).unwrap_or_default().min(RETREAT)
}
