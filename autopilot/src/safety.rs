//! What nobody may overrule: checked once more, after the decision and before the wire.
//!
//! The agent decides; this file only takes away. It knows the fence, how old navdata may be, that a
//! drone in its emergency state is never asked to fly, and how fast sticks may move. Where it has to
//! land the drone, it stays with that.

use std::time::Duration;

use pid::{Demand, Pose};

use crate::agent::AgentCommand;
use crate::plan::FlightLimits;

/// Navdata older than this are no basis for moving.
const STALE: Duration = Duration::from_millis(300);
/// A drone that flies blindly for so long is landed, whatever the agent says.
const BLIND: Duration = Duration::from_secs(4);
/// The drone overshoots a little, and navdata are not exact: this far beyond the fence is too far.
const MARGIN_M: f64 = 0.35;
/// What the drone flies on until it has stopped, per metre a second.
const STOPPING_S: f64 = 0.7;
/// No stick jumps further within one tick.
const LARGEST_JUMP: f64 = 1.0;

/// Why a command was replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Veto {
    /// The newest navdata are too old: hover instead of flying on.
    StaleNavdata,
    /// They have been for too long: land.
    Blind,
    /// The drone is in its emergency state: it is never asked to fly.
    Emergency,
    /// The target lies outside the fence: hover.
    TargetOutside,
    /// The drone itself is about to leave the fence by the pilot's hand: hover.
    NearFence,
    /// The drone has left the fence: land.
    OutsideFence,
}

impl Veto {
    /// Whether the drone is landed for it.
    pub fn lands(self) -> bool {
        matches!(self, Self::Blind | Self::OutsideFence)
    }
}

/// What the safety layer looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circumstances {
    /// Since the newest navdata that could be believed.
    pub blind_for: Duration,
    /// The drone's motors are cut.
    pub emergency: bool,
    /// The drone flies.
    pub airborne: bool,
    /// Where the drone is.
    pub pose: Pose,
    /// How it moves: right, forward, up.
    pub velocity_m_s: [f64; 3],
}

/// The last word before the wire.
#[derive(Debug, Clone)]
pub struct Guard {
    fence: FlightLimits,
    /// The drone is being landed for this.
    landing: Option<Veto>,
    sticks: Demand,
}

impl Guard {
    /// A guard of this fence.
    pub fn new(fence: FlightLimits) -> Self {
        Self { fence, landing: None, sticks: Demand::default() }
    }

    /// The command itself, or a safer one and the reason.
    pub fn check(
        &mut self,
        command: AgentCommand,
        now: &Circumstances,
    ) -> (AgentCommand, Option<Veto>) {
        let flies = !matches!(command, AgentCommand::Standby | AgentCommand::Land);
        if now.emergency && flies {
            return (AgentCommand::Standby, Some(Veto::Emergency));
        }
        if !now.airborne {
            self.landing = None;
        }
        if !flies || !now.airborne {
            return (command, None);
        }
        self.landing = self.landing.or_else(|| self.reason_to_land(now));
        if let Some(veto) = self.landing {
            return (AgentCommand::Land, Some(veto));
        }
        let moves = matches!(command, AgentCommand::GoTo(_) | AgentCommand::Sticks);
        let veto = match command {
            _ if moves && now.blind_for > STALE => Veto::StaleNavdata,
            AgentCommand::GoTo(target) if !self.is_inside(&target, 1e-6) => Veto::TargetOutside,
            AgentCommand::Sticks if !self.stops_inside(now) => Veto::NearFence,
            _ => return (command, None),
        };
        (AgentCommand::Hover, Some(veto))
    }

    /// The sticks within their limit, and no further from the last ones than they may jump.
    pub fn limit(&mut self, demand: &Demand, most: f64) -> Demand {
        let most = most.clamp(0.0, 1.0);
        let within = |wanted: f64, last: f64| {
            let wanted = if wanted.is_finite() { wanted.clamp(-most, most) } else { 0.0 };
            wanted.clamp(last - LARGEST_JUMP, last + LARGEST_JUMP)
        };
        let last = self.sticks;
        self.sticks = Demand {
            roll: within(demand.roll, last.roll),
            pitch: within(demand.pitch, last.pitch),
            gaz: within(demand.gaz, last.gaz),
            yaw: within(demand.yaw, last.yaw),
        };
        self.sticks
    }

    /// The drone holds or lands by itself: its sticks are let go.
    pub fn let_go(&mut self) {
        self.sticks = Demand::default();
    }

    fn reason_to_land(&self, now: &Circumstances) -> Option<Veto> {
        if now.blind_for > BLIND {
            Some(Veto::Blind)
        } else if !self.is_inside_above(&now.pose, MARGIN_M) {
            Some(Veto::OutsideFence)
        } else {
            None
        }
    }

    fn is_inside(&self, pose: &Pose, margin_m: f64) -> bool {
        pose.z_m >= self.fence.floor_m - margin_m && self.is_inside_above(pose, margin_m)
    }

    /// A drone that sinks too low is not mended by landing it.
    fn is_inside_above(&self, pose: &Pose, margin_m: f64) -> bool {
        pose.x_m.hypot(pose.y_m) <= self.fence.radius_m + margin_m
            && pose.z_m <= self.fence.ceiling_m + margin_m
    }

    fn stops_inside(&self, now: &Circumstances) -> bool {
        let [right, forward, up] = now.velocity_m_s.map(|speed_m_s| speed_m_s * STOPPING_S);
        let Pose { x_m, y_m, z_m, .. } = now.pose;
        let (away_m, end_away_m) = (x_m.hypot(y_m), (x_m + right).hypot(y_m + forward));
        let end_m = z_m + up;
        (end_away_m <= self.fence.radius_m || end_away_m < away_m)
            && (end_m <= self.fence.ceiling_m || up < 0.0)
            && (end_m >= self.fence.floor_m || up > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: Circumstances = Circumstances {
        blind_for: Duration::ZERO,
        emergency: false,
        airborne: true,
        pose: Pose { x_m: 0.0, y_m: 0.0, z_m: 1.0, yaw_deg: 0.0 },
        velocity_m_s: [0.0; 3],
    };
    const TARGET: Pose = Pose { x_m: 1.0, ..FINE.pose };
    const GO_TO: AgentCommand = AgentCommand::GoTo(TARGET);

    fn guard() -> Guard {
        Guard::new(FlightLimits::default())
    }

    #[test]
    fn only_what_moves_the_drone_needs_fresh_navdata() {
        let stale = Circumstances { blind_for: Duration::from_millis(301), ..FINE };
        assert_eq!(guard().check(GO_TO, &FINE), (GO_TO, None));
        let held = (AgentCommand::Hover, Some(Veto::StaleNavdata));
        assert_eq!(guard().check(GO_TO, &stale), held);
        assert_eq!(guard().check(AgentCommand::Sticks, &stale), held);
        assert_eq!(guard().check(AgentCommand::Land, &stale), (AgentCommand::Land, None));
    }

    #[test]
    fn nothing_flies_in_an_emergency() {
        let emergency = Circumstances { emergency: true, ..FINE };
        for command in [AgentCommand::TakeOff, AgentCommand::Hover, GO_TO, AgentCommand::Sticks] {
            let vetoed = (AgentCommand::Standby, Some(Veto::Emergency));
            assert_eq!(guard().check(command, &emergency), vetoed);
        }
        assert_eq!(guard().check(AgentCommand::Land, &emergency), (AgentCommand::Land, None));
    }

    #[test]
    fn a_drone_that_is_landed_for_its_safety_is_landed_to_the_end() {
        for bad in [
            Circumstances { blind_for: Duration::from_secs(5), ..FINE },
            Circumstances { pose: Pose { x_m: 10.4, ..FINE.pose }, ..FINE },
            Circumstances { pose: Pose { z_m: 3.4, ..FINE.pose }, ..FINE },
        ] {
            let mut guard = guard();
            let (command, veto) = guard.check(AgentCommand::Hover, &bad);
            assert_eq!(command, AgentCommand::Land);
            assert!(veto.is_some_and(Veto::lands));
            assert_eq!(guard.check(GO_TO, &FINE).0, AgentCommand::Land, "it came back");
            let landed = Circumstances { airborne: false, ..FINE };
            assert_eq!(guard.check(AgentCommand::TakeOff, &landed).0, AgentCommand::TakeOff);
        }
    }

    #[test]
    fn targets_outside_the_fence_are_not_flown_to() {
        let here = FINE.pose;
        for target in [
            Pose { x_m: 8.0, y_m: -7.0, ..here },
            Pose { z_m: 3.1, ..here },
            Pose { z_m: 0.2, ..here },
        ] {
            let outside = (AgentCommand::Hover, Some(Veto::TargetOutside));
            assert_eq!(guard().check(AgentCommand::GoTo(target), &FINE), outside);
        }
    }

    #[test]
    fn the_pilots_hand_stops_before_the_fence_and_may_fly_back() {
        let at_the_fence = Pose { x_m: 9.5, ..FINE.pose };
        let moving =
            |x, up| Circumstances { pose: at_the_fence, velocity_m_s: [x, 0.0, up], ..FINE };
        let check = |now| guard().check(AgentCommand::Sticks, &now).1;
        assert_eq!(check(moving(1.0, 0.0)), Some(Veto::NearFence));
        assert_eq!(check(moving(-1.0, 0.0)), None);
        assert_eq!(check(moving(0.5, 0.0)), None);
        assert_eq!(check(moving(0.0, 3.0)), Some(Veto::NearFence));
    }

    #[test]
    fn sticks_are_limited_and_do_not_jump() {
        let mut guard = guard();
        let full = Demand { roll: 1.0, pitch: -3.0, gaz: f64::NAN, yaw: 0.2 };
        let limited = guard.limit(&full, 0.6);
        assert_eq!(limited, Demand { roll: 0.6, pitch: -0.6, gaz: 0.0, yaw: 0.2 });
        let limited = guard.limit(&Demand { roll: -1.0, ..full }, 1.0);
        assert!((limited.roll + 0.4).abs() < 1e-12, "{limited:?}");
        guard.let_go();
        assert!((guard.limit(&full, 1.0).roll - 1.0).abs() < 1e-12);
    }
}
