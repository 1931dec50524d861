//! How a drone is brought down that has left the fence, or that the wind carries off.
//!
//! The drone's own landing drifts, the more the higher it begins; while navdata are usable the drone is therefore flown back
//! and down first. If it cannot come back, it still tilts against the wind and sinks faster than by itself.

use std::time::Duration;

use kinematics::Pose;

use super::{BRAKES, BRAKES_M_S, GUST, INSIDE_M, STALE, Situation, Veto};
use crate::agent::AgentCommand;
use crate::fence::FlightLimits;

/// Height above the fence's floor to which a drone that has left the fence is flown down before it lands.
pub(super) const LOW_M: f64 = 0.15;
/// Longest flight back into the fence; then the drone is landed where it is.
pub(super) const RETREAT: Duration = Duration::from_secs(10);
/// The flight back is given up when the drone comes no nearer by [`WAY_BACK_M`] in this time, because then it
/// cannot hold against the wind.
pub(super) const NO_WAY_BACK: Duration = Duration::from_millis(1500);
/// Smallest approach that counts as progress on the way back.
pub(super) const WAY_BACK_M: f64 = 0.05;
/// The flight back is given up at once where the outward wind exceeds this fraction of full tilt.
pub(super) const TOO_STRONG: f64 = 1.0;
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
}

impl Cause {
    pub(super) fn veto(self) -> Veto {
        match self {
            Self::Blind => Veto::Blind,
            Self::OutsideFence => Veto::OutsideFence,
            Self::CarriedOff => Veto::CarriedOff,
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
    /// Begins to bring it down; a gust that it was thrown out by began at `gust_since`.
    pub(super) fn begin(
        cause: Cause,
        now: &Situation,
        fence: &FlightLimits,
        gust_since: Duration,
    ) -> Self {
        Self {
            cause,
            retreats_until: now.now + RETREAT,
            sinks_until: now.now + time_to_sink(now.pose.z_m),
            way_back: WayBack::begin(now.now, gust_since),
            upwind: place_upwind(&now.pose, fence),
            back_at: fence.nearest_inside(&now.pose, INSIDE_M),
        }
    }

    /// The command of one tick.
    pub(super) fn command(&mut self, now: &Situation, fence: &FlightLimits) -> AgentCommand {
        self.way_back.see(now);
        let away_m = now.pose.x_m.hypot(now.pose.y_m);
        // Once the drone is that far inside, its target must not move with it: nothing would stop it.
        if away_m > fence.radius_m - INSIDE_M {
            self.back_at = fence.nearest_inside(&now.pose, INSIDE_M);
        }
        let is_hopeless = away_m > fence.radius_m && self.way_back.is_none(now);
        let sinks = now.pose.z_m > HIGH_M && now.now < self.sinks_until;
        let (target, may_fly) = match self.cause {
            Cause::OutsideFence => (self.retreat(&now.pose, fence), sinks || !is_hopeless),
            Cause::CarriedOff => (Some(self.upwind), sinks),
            Cause::Blind => (None, false),
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
        let is_inside = pose.x_m.hypot(pose.y_m) <= fence.radius_m;
        let is_there = is_inside && pose.z_m <= low_m + LOW_M;
        (!is_there).then_some(target)
    }
}

/// A low target in the direction of the fence's centre, far enough for full tilt.
pub(super) fn place_upwind(pose: &Pose, fence: &FlightLimits) -> Pose {
    let away_m = pose.x_m.hypot(pose.y_m).max(f64::EPSILON);
    let share = 1.0 - UPWIND_TARGET_M / away_m;
    let low_m = fence.floor_m + LOW_M;
    Pose { x_m: pose.x_m * share, y_m: pose.y_m * share, z_m: low_m, ..*pose }
}

/// Progress of a drone outside the fence on its way back.
#[derive(Debug, Clone, Copy, Default)]
struct WayBack {
    /// Smallest distance from the fence's centre so far, and when it was reached.
    away_m: f64,
    nearer_at: Duration,
    /// Largest outward speed since it last fell by [`BRAKES_M_S`], and until when a braking drone is given
    /// time.
    away_m_s: f64,
    brakes_until: Duration,
}

impl WayBack {
    fn begin(now: Duration, gust_since: Duration) -> Self {
        Self { nearer_at: now, brakes_until: gust_since + GUST, ..Self::default() }
    }

    fn see(&mut self, now: &Situation) {
        let away_m = now.pose.x_m.hypot(now.pose.y_m);
        let [right_m_s, forward_m_s, _] = now.velocity_m_s;
        let away_m_s = outward(now, [right_m_s, forward_m_s]);
        if away_m < self.away_m - WAY_BACK_M {
            (self.away_m, self.nearer_at) = (away_m, now.now);
        }
        if away_m_s < self.away_m_s - BRAKES_M_S {
            self.away_m_s = away_m_s;
            self.brakes_until = self.brakes_until.max(now.now + BRAKES);
        }
        self.away_m = self.away_m.max(away_m);
        self.away_m_s = self.away_m_s.max(away_m_s);
    }

    fn is_none(&self, now: &Situation) -> bool {
        let no_nearer = now.now >= self.nearer_at + NO_WAY_BACK;
        let too_strong = outward(now, now.wind) > TOO_STRONG;
        (no_nearer || too_strong) && now.now >= self.brakes_until
    }
}

/// The component of (right, forward) that points away from the fence's centre.
pub(super) fn outward(now: &Situation, [right, forward]: [f64; 2]) -> f64 {
    let Pose { x_m, y_m, .. } = now.pose;
    (right * x_m + forward * y_m) / x_m.hypot(y_m).max(f64::EPSILON)
}

/// Longest descent from this height to [`HIGH_M`].
pub(super) fn time_to_sink(height_m: f64) -> Duration {
    Duration::try_from_secs_f64((height_m - HIGH_M) / SINKS_M_S).unwrap_or_default().min(RETREAT)
}
