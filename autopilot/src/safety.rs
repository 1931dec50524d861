//! The safety monitor: a last check between the agent's decision and the wire.
//!
//! The agent decides; the monitor only restricts. It enforces the fence, the maximum age of navdata, the
//! limits of stick motion, the distance from other vehicles, and that a drone in its emergency state is never
//! ordered to fly. A landing that it has ordered is not taken back in the air.

mod apart;
mod brake;
mod carried;
mod descent;
mod stopping;

use std::fmt;
use std::time::Duration;

use kinematics::{Pose, Sticks, world_from_body};
use nalgebra::Vector2;
use pid::{Course, MotionLimits};

use self::apart::Apart;
use self::brake::Brake;
use self::carried::is_carried_off;
use self::descent::{Cause, Descent};
pub(crate) use self::stopping::{Stopping, stopping_inside_m_s};
use crate::agent::AgentCommand;
use crate::fence::{FlightLimits, across};
use crate::separation::{Claim, Others};
pub use crate::wind::Wind;

/// Navdata older than this are too old to move by: the drone hovers.
const STALE: Duration = Duration::from_millis(300);
/// After this time without usable navdata the drone is landed, whatever the agent orders.
const BLIND: Duration = Duration::from_secs(4);
/// Distance beyond the fence that is tolerated, because the drone overshoots and its position is not exact.
const MARGIN_M: f64 = 0.35;
/// Distance beyond the fence up to which the drone may come to rest, and its way to a target lead. A target on the fence is
/// flown to with less.
const BEYOND_M: f64 = 0.15;
/// Delay before the drone starts to brake.
const REACTION_S: f64 = 0.5;
/// Under manual control the drone is stopped this far inside the fence, and manual targets are moved as far
/// inside: nearer to it, wind could carry the drone over the fence, which lands it. A drone that has left the
/// fence is flown back this far.
pub(crate) const INSIDE_M: f64 = 0.5;
/// A stick that leads nearer to the border than [`INSIDE_M`], or to the ceiling or the floor, by less than this leads along it.
const AHEAD_M: f64 = 0.05;
/// Largest rate of descent at the fence's floor. Towards the floor the descent is limited to what the slowest
/// airframe can stop.
const SINK_AT_FLOOR_M_S: f64 = 0.15;
/// Increase of that limit for each metre above the floor, in m/s.
const SINK_1_S: f64 = 0.5;
/// Least climb below the floor, for each metre, in 1/s: nobody flies on down there.
const RISE_1_S: f64 = 1.0;
/// Largest change of a stick within one tick.
const LARGEST_JUMP: f64 = 1.0;

/// Why a command was replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Veto {
    /// The newest plausible navdata are older than 300 ms: hover instead of flying on.
    StaleNavdata,
    /// Navdata have been unusable for more than 4 s: land.
    Blind,
    /// The drone is in its emergency state and must not be ordered to fly.
    Emergency,
    /// The drone is landing, by itself or by order, and must not be ordered to fly: such an order would lift
    /// it again once it is down.
    Landing,
    /// The target lies outside the fence: fly to the nearest place inside.
    TargetOutside,
    /// The straight way to the target leads over the fence: stop before it.
    WayOutside,
    /// Manual control leads the drone too near to the fence: stop inside.
    NearFence,
    /// The drone has left the fence: fly it back and down, and land.
    OutsideFence,
    /// The wind carries the drone over the fence faster than it can brake: fly it down against the wind, and
    /// land.
    CarriedOff,
    /// Another vehicle is in the way: fly past it, or wait.
    KeepsApart,
    /// Another vehicle is too near, and cannot be kept away from: land.
    Crowded,
}

impl Veto {
    /// All of them.
    pub const ALL: [Self; 11] = [
        Self::StaleNavdata,
        Self::Blind,
        Self::Emergency,
        Self::Landing,
        Self::TargetOutside,
        Self::WayOutside,
        Self::NearFence,
        Self::OutsideFence,
        Self::CarriedOff,
        Self::KeepsApart,
        Self::Crowded,
    ];

    /// Its name in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::StaleNavdata => "StaleNavdata",
            Self::Blind => "Blind",
            Self::Emergency => "Emergency",
            Self::Landing => "Landing",
            Self::TargetOutside => "TargetOutside",
            Self::WayOutside => "WayOutside",
            Self::NearFence => "NearFence",
            Self::OutsideFence => "OutsideFence",
            Self::CarriedOff => "CarriedOff",
            Self::KeepsApart => "KeepsApart",
            Self::Crowded => "Crowded",
        }
    }

    /// Whether this veto ends in a landing.
    pub fn lands(self) -> bool {
        matches!(
            self,
            Self::Blind | Self::OutsideFence | Self::CarriedOff | Self::Landing | Self::Crowded
        )
    }
}

impl fmt::Display for Veto {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::StaleNavdata => "no fresh navdata: hovering",
            Self::Blind => "no navdata for too long: landing",
            Self::Emergency => "emergency state: not flying",
            Self::Landing => "the drone lands: letting it",
            Self::TargetOutside => "target outside the fence: flying to its edge",
            Self::WayOutside => {
                "the straight way to the target leaves the fence: stopping before it"
            }
            Self::NearFence => "at the fence: stopping",
            Self::OutsideFence => "outside the fence: flying back and landing",
            Self::CarriedOff => "the wind is stronger than the drone can brake: landing",
            Self::KeepsApart => "another vehicle is in the way: keeping apart",
            Self::Crowded => "too near to another vehicle: landing",
        })
    }
}

/// Where the drone is, and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Pose in the world.
    pub pose: Pose,
    /// Velocity in the world: x, y, z.
    pub velocity_m_s: [f64; 3],
}

/// Inputs of the safety monitor in one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Situation {
    /// Time since the program started.
    pub now: Duration,
    /// Time since the newest plausible navdata.
    pub blind_for: Duration,
    /// The drone has cut its motors.
    pub emergency: bool,
    /// The drone is in the air.
    pub airborne: bool,
    /// The drone is landing, by itself or by order.
    pub landing: bool,
    /// What manual control asks for; at rest without it.
    pub sticks: Sticks,
    /// Predicted pose.
    pub pose: Pose,
    /// Predicted velocity in the world: x, y, z.
    pub velocity_m_s: [f64; 3],
    /// Predicted motion when an order of this tick takes effect: until then the drone does what it has been sent before.
    pub soon: Motion,
    /// The wind.
    pub wind: Wind,
    /// Linear drag: deceleration in still air divided by speed, in 1/s.
    pub drag_1_s: f64,
    /// Time for which an order holds until the next, in seconds.
    pub tick_s: f64,
    /// Time from an order to tilt until the drone has tilted, in seconds.
    pub tilts_after_s: f64,
    /// Time constant with which the rate of climb follows its order, in seconds.
    pub climb_lag_s: f64,
    /// Rate of climb that full stick asks for.
    pub climb_m_s: f64,
    /// Rate of descent at full stick, positive.
    pub sink_m_s: f64,
}

impl Situation {
    /// The motion from which the drone must stop when an order of this tick takes effect. One that is slower to answer than
    /// was identified still moves as now: of both velocities that which leads further.
    fn stops_from(&self) -> Motion {
        let further = |axis: usize| {
            let [now, soon] = [self.velocity_m_s[axis], self.soon.velocity_m_s[axis]];
            if now.abs() > soon.abs() { now } else { soon }
        };
        Motion { pose: self.soon.pose, velocity_m_s: [0, 1, 2].map(further) }
    }
}

/// What the agent is free to do.
#[derive(Debug, Clone, Copy)]
enum State {
    /// To fly inside the fence.
    Free,
    /// The drone is brought down, because it is not safe to fly on.
    BringingDown(Descent),
    /// Nothing: the drone was ordered to land, which is not taken back in the air.
    Landing {
        /// Why it was brought down.
        cause: Option<Cause>,
    },
    /// To take off: the drone was landed, or ordered to stay on the ground. If it is in the air all the same, it follows
    /// an older order, and any order to fly would keep it there.
    StaysDown,
}

impl State {
    fn cause(&self) -> Option<Cause> {
        match self {
            Self::BringingDown(descent) => Some(descent.cause),
            Self::Landing { cause } => *cause,
            Self::Free | Self::StaysDown => None,
        }
    }
}

/// Replaces unsafe commands of the agent; the last stage before the session.
#[derive(Debug, Clone)]
pub struct SafetyMonitor {
    fence: FlightLimits,
    state: State,
    /// What the fence leaves of this tick's sticks.
    brake: Brake,
    sticks: Sticks,
    /// Where manual control was stopped, until the drone would stop inside and is not led outside again. It must not be found
    /// anew in each tick: a place that goes ahead of the drone would lead it on, along the border, up and down.
    stop: Option<Pose>,
    apart: Apart,
}

impl SafetyMonitor {
    /// A monitor for this fence.
    pub fn new(fence: FlightLimits) -> Self {
        Self {
            fence,
            state: State::Free,
            brake: Brake::default(),
            sticks: Sticks::default(),
            stop: None,
            apart: Apart::default(),
        }
    }

    /// Returns the command itself, or a safer one with the reason.
    pub fn check(
        &mut self,
        command: AgentCommand,
        now: &Situation,
    ) -> (AgentCommand, Option<Veto>) {
        let flies = !matches!(command, AgentCommand::Standby | AgentCommand::Land);
        self.brake = Brake::of(now, self.sticks.gaz, &self.fence);
        self.stop = self.stop.filter(|_| command == AgentCommand::Sticks && now.airborne);
        if now.emergency && flies {
            return (AgentCommand::Standby, Some(Veto::Emergency));
        }
        if !now.airborne {
            self.state = match (command, self.state) {
                (AgentCommand::TakeOff, _) => State::Free,
                (AgentCommand::Standby, _)
                | (_, State::BringingDown(_) | State::Landing { .. } | State::StaysDown) => {
                    State::StaysDown
                }
                (_, State::Free) => State::Free,
            };
            return (command, None);
        }
        let (command, veto) = self.check_in_the_air(command, flies, now);
        if command == AgentCommand::Land {
            self.state = State::Landing { cause: self.state.cause() };
        }
        (command, veto)
    }

    fn check_in_the_air(
        &mut self,
        command: AgentCommand,
        flies: bool,
        now: &Situation,
    ) -> (AgentCommand, Option<Veto>) {
        let lands = matches!(self.state, State::Landing { .. } | State::StaysDown);
        if lands || now.landing || command == AgentCommand::Standby {
            let veto = self.state.cause().map_or(Veto::Landing, Cause::veto);
            return (AgentCommand::Land, flies.then_some(veto));
        }
        if flies
            && matches!(self.state, State::Free)
            && let Some(cause) = self.reason_to_land(now)
        {
            self.state = State::BringingDown(Descent::begin(cause, now, &self.fence));
        }
        if let State::BringingDown(descent) = &mut self.state {
            return (descent.command(now, &self.fence), Some(descent.cause.veto()));
        }
        let moves = matches!(command, AgentCommand::GoTo(_) | AgentCommand::Sticks);
        match command {
            _ if moves && now.blind_for > STALE => (AgentCommand::Hover, Some(Veto::StaleNavdata)),
            AgentCommand::GoTo(target) => self.kept_inside(&target, now),
            AgentCommand::Sticks => {
                self.stop = if self.stops_inside(now) {
                    self.stop.filter(|stop| self.leads_on(stop, now))
                } else {
                    // Whatever the sticks ask for, first it stops.
                    Some(self.stop.unwrap_or_else(|| self.place_to_stop(now)))
                };
                self.stop.map_or((command, None), |stop| {
                    (AgentCommand::GoTo(stop), Some(Veto::NearFence))
                })
            }
            _ => (command, None),
        }
    }

    /// What [`SafetyMonitor::check`] has left of a command, kept apart from other vehicles: the drone lands if that is not
    /// possible. The reference of its motion stays within `limits`; `system` is its number.
    pub(crate) fn keep_apart(
        &mut self,
        command: AgentCommand,
        now: &Situation,
        others: &Others,
        limits: &MotionLimits,
        system: u8,
    ) -> (AgentCommand, Option<Veto>) {
        let moves = matches!(command, AgentCommand::GoTo(_) | AgentCommand::Sticks);
        if others.is_empty() || !now.airborne || !moves {
            self.apart.rest();
            return (command, None);
        }
        self.brake.keep_apart(now, others);
        if self.apart.is_crowded(now, others) {
            self.state = State::Landing { cause: Some(Cause::Crowded) };
            return (AgentCommand::Land, Some(Veto::Crowded));
        }
        let (command, keeps_apart) =
            self.apart.keep(command, now, others, &self.fence.border, limits, system);
        (command, keeps_apart.then_some(Veto::KeepsApart))
    }

    /// The way on which the drone is kept apart from others, if it is.
    pub(crate) fn course(&self) -> Option<&Course> {
        self.apart.course()
    }

    /// The way that the drone claims from others.
    pub(crate) fn claim(&self) -> Option<Claim> {
        self.apart.claim()
    }

    /// Ends a flight back into the fence: the drone lands where it is.
    pub fn land_here(&mut self) {
        if let State::BringingDown(Descent { cause, .. }) = self.state {
            self.state = State::Landing { cause: Some(cause) };
        }
    }

    /// Limits the sticks to `most`, from 0 to 1, and their change since the last tick; those that are not finite are at rest.
    /// Where the drone could not stop inside the fence any more they brake, with all that there is. The descent is limited
    /// further so that the drone can stop above the fence's floor; full gaz descends at `full_sink_m_s`.
    pub fn limit(
        &mut self,
        demand: &Sticks,
        most: f64,
        height_m: f64,
        full_sink_m_s: f64,
    ) -> Sticks {
        let asked = most.clamp(0.0, 1.0);
        let demand = &clamped(demand, asked);
        let left = self.brake.leave(demand);
        let most = if left == *demand { asked } else { 1.0 };
        let room_m = height_m - self.fence.floor_m;
        let sink_m_s =
            if room_m < 0.0 { room_m * RISE_1_S } else { SINK_AT_FLOOR_M_S + SINK_1_S * room_m };
        let sink = sink_m_s / full_sink_m_s.max(f64::EPSILON);
        let within = |wanted: f64, last: f64| {
            wanted.clamp(-most, most).clamp(last - LARGEST_JUMP, last + LARGEST_JUMP)
        };
        let last = self.sticks;
        self.sticks = Sticks {
            roll: within(left.roll, last.roll),
            pitch: within(left.pitch, last.pitch),
            gaz: within(left.gaz, last.gaz).max((-sink).min(most)),
            yaw: within(left.yaw, last.yaw),
        };
        self.sticks
    }

    /// The sticks are released: the drone holds or lands by itself.
    pub fn let_go(&mut self) {
        self.sticks = Sticks::default();
    }

    fn reason_to_land(&self, now: &Situation) -> Option<Cause> {
        if now.blind_for > BLIND {
            Some(Cause::Blind)
        } else if !self.fence.is_inside_above(&now.pose, MARGIN_M) {
            // Not below its floor: landing does not correct a height that is too low.
            Some(Cause::OutsideFence)
        } else if is_carried_off(now, &self.fence.border) {
            Some(Cause::CarriedOff)
        } else {
            None
        }
    }

    /// A target inside, or one before the straight way to it leaves the fence.
    fn kept_inside(&self, target: &Pose, now: &Situation) -> (AgentCommand, Option<Veto>) {
        let fence = &self.fence;
        let (inside, veto) = if fence.is_inside(target, FlightLimits::TOLERANCE_M) {
            (*target, None)
        } else {
            (fence.nearest_inside(target, 0.0), Some(Veto::TargetOutside))
        };
        match fence.stop_before(&now.pose, &inside, BEYOND_M, INSIDE_M) {
            Some(stop) => (AgentCommand::GoTo(stop), Some(Veto::WayOutside)),
            None => (AgentCommand::GoTo(inside), veto),
        }
    }

    /// Where a drone stops inside that begins to brake now.
    fn place_to_stop(&self, now: &Situation) -> Pose {
        let end = stopping_place(&now.stops_from());
        let across_m =
            self.fence.border.stop_inside(across(&now.soon.pose), across(&end), INSIDE_M);
        self.fence.nearest_inside(&Pose { x_m: across_m.x, y_m: across_m.y, ..end }, 0.0)
    }

    /// Whether manual control leads towards the border, the ceiling or the floor from where it was stopped.
    fn leads_on(&self, stop: &Pose, now: &Situation) -> bool {
        let Sticks { roll, pitch, gaz, .. } = now.sticks;
        let ahead_m = world_from_body(Vector2::new(roll, -pitch), now.pose.yaw_deg)
            .try_normalize(0.0)
            .map_or(across(stop), |direction| across(stop) + direction * INSIDE_M);
        self.fence.border.outside_m(ahead_m) > AHEAD_M - INSIDE_M
            || gaz > 0.0 && stop.z_m > self.fence.ceiling_m - AHEAD_M
            || gaz < 0.0 && stop.z_m < self.fence.floor_m + AHEAD_M
    }

    fn stops_inside(&self, now: &Situation) -> bool {
        let (here, end) = (now.soon.pose, stopping_place(&now.stops_from()));
        self.fence.border.is_stop_inside(across(&here), across(&end), INSIDE_M)
            && (end.z_m <= self.fence.ceiling_m || end.z_m < here.z_m)
            && (end.z_m >= self.fence.floor_m || end.z_m > here.z_m)
    }
}

/// Each stick within `most`; one that is no number is at rest.
fn clamped(sticks: &Sticks, most: f64) -> Sticks {
    let within = |wanted: f64| if wanted.is_finite() { wanted.clamp(-most, most) } else { 0.0 };
    Sticks {
        roll: within(sticks.roll),
        pitch: within(sticks.pitch),
        gaz: within(sticks.gaz),
        yaw: within(sticks.yaw),
    }
}

/// Where the drone comes to rest if it begins to brake now.
fn stopping_place(soon: &Motion) -> Pose {
    let [right, forward, up] =
        soon.velocity_m_s.map(|speed_m_s| Stopping::CAUTIOUS.way_m(speed_m_s));
    let Pose { x_m, y_m, z_m, yaw_deg } = soon.pose;
    Pose { x_m: x_m + right, y_m: y_m + forward, z_m: z_m + up, yaw_deg }
}

#[cfg(test)]
mod tests;
