//! What nobody may overrule: checked once more, after the decision and before the wire.
//!
//! The agent decides; this file only takes away. It knows the fence, how old navdata may be, that a
//! drone in its emergency state is never asked to fly, and how fast sticks may move. Where it has to
//! land the drone, it stays with that.

mod carried;

use std::time::Duration;

use pid::{Demand, Pose};

use self::carried::CarriedOff;
use crate::agent::AgentCommand;
use crate::plan::FlightLimits;

/// Navdata older than this are no basis for moving.
const STALE: Duration = Duration::from_millis(300);
/// A drone that flies blindly for so long is landed, whatever the agent says.
const BLIND: Duration = Duration::from_secs(4);
/// The drone overshoots a little, and navdata are not exact: this far beyond the fence is too far.
const MARGIN_M: f64 = 0.35;
/// What the drone flies on before it brakes, per metre a second, and how it brakes then,
/// against the wind.
const REACTION_S: f64 = 0.5;
const BRAKING_M_S2: f64 = 0.6;
/// By hand the drone is stopped so far inside the fence, and sent no nearer to it: in the wind it would be
/// blown over it, and that lands. One that left it is flown back that far, and
/// down to so far above its floor, and is landed there.
pub(crate) const INSIDE_M: f64 = 0.5;
const LOW_M: f64 = 0.15;
/// It is landed wherever it is after so long.
const RETREAT: Duration = Duration::from_secs(10);
/// And when it has come no nearer by so much for so long: it cannot hold against the wind.
const NO_WAY_BACK: Duration = Duration::from_millis(1500);
const WAY_BACK_M: f64 = 0.05;
/// Or at once where the wind pushes it outward by this share of all that it can lean against.
const TOO_STRONG: f64 = 1.0;
/// Neither holds while a gust may last, nor of a drone that has just lost so much of its speed: a gust had
/// thrown it out, and it brakes.
const GUST: Duration = Duration::from_millis(1200);
const BRAKES: Duration = Duration::from_millis(600);
const BRAKES_M_S: f64 = 0.5;
/// Where it cannot come back it is flown down against the wind to this height, and lands by itself there: above
/// it sinks faster by its sticks, below no more. Each airframe sinks so fast; one that does not, or says that
/// it does not, is let land by itself too. It is sent so far against the wind.
const HIGH_M: f64 = 0.8;
const SINKS_M_S: f64 = 0.4;
const LEANS_FOR_M: f64 = 2.0;
/// And when navdata have been so old on its way.
const BLIND_RETREAT: Duration = Duration::from_secs(1);
/// Near the floor of its fence the drone sinks no faster than the slowest airframe stops: this fast at the
/// floor, and so much faster for each metre above.
const SINK_AT_FLOOR_M_S: f64 = 0.15;
const SINK_1_S: f64 = 0.5;
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
    /// The drone lands, by itself or as it was told: it is let land. An order to fly would lift it
    /// again once it is down.
    Landing,
    /// The target lies outside the fence: fly to the nearest place inside.
    TargetOutside,
    /// The drone comes too near the fence by the pilot's hand: stop inside.
    NearFence,
    /// The drone has left the fence: fly it back and down, and land.
    OutsideFence,
    /// The wind carries it over the fence faster than it can brake: fly it down against the wind, and land.
    CarriedOff,
}

impl Veto {
    /// Its name in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::StaleNavdata => "StaleNavdata",
            Self::Blind => "Blind",
            Self::Emergency => "Emergency",
            Self::Landing => "Landing",
            Self::TargetOutside => "TargetOutside",
            Self::NearFence => "NearFence",
            Self::OutsideFence => "OutsideFence",
            Self::CarriedOff => "CarriedOff",
        }
    }

    /// Whether the drone is landed for it.
    pub fn lands(self) -> bool {
        matches!(self, Self::Blind | Self::OutsideFence | Self::CarriedOff | Self::Landing)
    }
}

/// What the safety layer looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circumstances {
    /// Since the flight program started.
    pub now: Duration,
    /// Since the newest navdata that could be believed.
    pub blind_for: Duration,
    /// The drone's motors are cut.
    pub emergency: bool,
    /// The drone flies.
    pub airborne: bool,
    /// The drone is landing, whoever ordered it.
    pub landing: bool,
    /// Where the drone is.
    pub pose: Pose,
    /// How it moves: right, forward, up.
    pub velocity_m_s: [f64; 3],
    /// How the wind pushes it towards right and forward, as a share of what it can lean against.
    pub wind: [f64; 2],
    /// How fast it gains speed at full tilt in still air.
    pub full_tilt_m_s2: f64,
    /// How fast air that stands still slows it, by its speed.
    pub drag_1_s: f64,
}

/// The last word before the wire.
#[derive(Debug, Clone)]
pub struct Guard {
    fence: FlightLimits,
    /// The drone is brought down for this.
    danger: Option<Veto>,
    /// Until then it may be flown back first.
    retreats_until: Duration,
    /// Until then it may be flown down where it cannot come back.
    sinks_until: Duration,
    way_back: WayBack,
    carried_off: CarriedOff,
    /// Where it is flown down when it is carried off.
    upwind: Pose,
    /// It has been told to land: in the air that is not taken back.
    lands: bool,
    /// It was last told to stay on the ground: seen in the air it has risen on an order that was still on its
    /// way, and any order to fly would keep it there.
    stays_down: bool,
    sticks: Demand,
}

impl Guard {
    /// A guard of this fence.
    pub fn new(fence: FlightLimits) -> Self {
        Self {
            fence,
            danger: None,
            retreats_until: Duration::ZERO,
            sinks_until: Duration::ZERO,
            way_back: WayBack::default(),
            carried_off: CarriedOff::default(),
            upwind: Pose::default(),
            lands: false,
            stays_down: false,
            sticks: Demand::default(),
        }
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
        match command {
            AgentCommand::Standby => self.stays_down = true,
            AgentCommand::TakeOff => self.stays_down = false,
            _ => {}
        }
        if !now.airborne {
            self.danger = None;
            self.carried_off = CarriedOff::default();
            self.lands = false;
            return (command, None);
        }
        let (command, veto) = self.check_in_the_air(command, flies, now);
        self.lands = command == AgentCommand::Land;
        (command, veto)
    }

    fn check_in_the_air(
        &mut self,
        command: AgentCommand,
        flies: bool,
        now: &Circumstances,
    ) -> (AgentCommand, Option<Veto>) {
        if self.lands || now.landing || self.stays_down {
            return (AgentCommand::Land, flies.then(|| self.danger.unwrap_or(Veto::Landing)));
        }
        self.carried_off.see(now, self.fence.radius_m);
        if flies && self.danger.is_none() {
            self.danger = self.reason_to_land(now);
            self.retreats_until = now.now + RETREAT;
            self.sinks_until = now.now + time_to_sink(now.pose.z_m);
            self.upwind = self.place_upwind(&now.pose);
            let gust_since = self.carried_off.since().unwrap_or(now.now);
            self.way_back = WayBack::begin(now.now, gust_since);
        }
        self.way_back.see(now);
        if let Some(danger) = self.danger {
            return (self.bring_down(danger, now), Some(danger));
        }
        let moves = matches!(command, AgentCommand::GoTo(_) | AgentCommand::Sticks);
        match command {
            _ if moves && now.blind_for > STALE => (AgentCommand::Hover, Some(Veto::StaleNavdata)),
            AgentCommand::GoTo(target) if !self.is_inside(&target, 1e-6) => (
                AgentCommand::GoTo(self.fence.nearest_inside(&target, 0.0)),
                Some(Veto::TargetOutside),
            ),
            AgentCommand::Sticks if !self.stops_inside(now) => {
                let stop = self.fence.nearest_inside(&stopping_place(now), INSIDE_M);
                (AgentCommand::GoTo(stop), Some(Veto::NearFence))
            }
            _ => (command, None),
        }
    }

    /// The drone is to land where it is, not to be flown back first.
    pub fn land_here(&mut self) {
        self.lands |= self.danger.is_some();
    }

    /// The sticks within their limit, and no further from the last ones than they may jump. At a height
    /// above the start, where full gaz sinks by `climb_m_s`, the drone stays able to stop above the floor.
    pub fn limit(&mut self, demand: &Demand, most: f64, height_m: f64, climb_m_s: f64) -> Demand {
        let most = most.clamp(0.0, 1.0);
        let room_m = (height_m - self.fence.floor_m).max(0.0);
        let sink = (SINK_AT_FLOOR_M_S + SINK_1_S * room_m) / climb_m_s.max(f64::EPSILON);
        let within = |wanted: f64, last: f64| {
            let wanted = if wanted.is_finite() { wanted.clamp(-most, most) } else { 0.0 };
            wanted.clamp(last - LARGEST_JUMP, last + LARGEST_JUMP)
        };
        let last = self.sticks;
        self.sticks = Demand {
            roll: within(demand.roll, last.roll),
            pitch: within(demand.pitch, last.pitch),
            gaz: within(demand.gaz, last.gaz).max(-sink),
            yaw: within(demand.yaw, last.yaw),
        };
        self.sticks
    }

    /// The drone holds or lands by itself: its sticks are let go.
    pub fn let_go(&mut self) {
        self.sticks = Demand::default();
    }

    /// The drone's own landing drifts, and the longer the higher it begins: with eyes open the drone is flown
    /// back and down first. Where that is hopeless it still leans against the wind and sinks faster than by
    /// itself, as far as [`HIGH_M`].
    fn bring_down(&self, danger: Veto, now: &Circumstances) -> AgentCommand {
        let is_across = now.pose.x_m.hypot(now.pose.y_m) > self.fence.radius_m;
        let is_hopeless = is_across && self.way_back.is_none(now);
        let sinks = now.pose.z_m > HIGH_M && now.now < self.sinks_until;
        let (target, may_fly) = match danger {
            Veto::OutsideFence => (self.retreat(&now.pose), sinks || !is_hopeless),
            Veto::CarriedOff => (Some(self.upwind), sinks),
            _ => (None, false),
        };
        let retreats = may_fly && now.blind_for <= BLIND_RETREAT && now.now < self.retreats_until;
        match target {
            Some(target) if retreats && now.blind_for <= STALE => AgentCommand::GoTo(target),
            Some(_) if retreats => AgentCommand::Hover,
            _ => AgentCommand::Land,
        }
    }

    /// A low place so far towards the middle of the fence that the drone leans that way all it can.
    fn place_upwind(&self, pose: &Pose) -> Pose {
        let away_m = pose.x_m.hypot(pose.y_m).max(f64::EPSILON);
        let share = 1.0 - LEANS_FOR_M / away_m;
        let low_m = self.fence.floor_m + LOW_M;
        Pose { x_m: pose.x_m * share, y_m: pose.y_m * share, z_m: low_m, ..*pose }
    }

    fn reason_to_land(&self, now: &Circumstances) -> Option<Veto> {
        if now.blind_for > BLIND {
            Some(Veto::Blind)
        } else if !self.is_inside_above(&now.pose, MARGIN_M) {
            Some(Veto::OutsideFence)
        } else if self.carried_off.lasts(now.now) {
            Some(Veto::CarriedOff)
        } else {
            None
        }
    }

    /// A low place inside the fence, unless the drone is near it.
    fn retreat(&self, pose: &Pose) -> Option<Pose> {
        let low_m = self.fence.floor_m + LOW_M;
        let target = Pose { z_m: low_m, ..self.fence.nearest_inside(pose, INSIDE_M) };
        let is_inside = pose.x_m.hypot(pose.y_m) <= self.fence.radius_m;
        let is_there = is_inside && pose.z_m <= low_m + LOW_M;
        (!is_there).then_some(target)
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
        let (here, end) = (now.pose, stopping_place(now));
        let (away_m, end_away_m) = (here.x_m.hypot(here.y_m), end.x_m.hypot(end.y_m));
        (end_away_m <= self.fence.radius_m - INSIDE_M || end_away_m < away_m)
            && (end.z_m <= self.fence.ceiling_m || end.z_m < here.z_m)
            && (end.z_m >= self.fence.floor_m || end.z_m > here.z_m)
    }
}

/// Whether a drone outside its fence is on its way back.
#[derive(Debug, Clone, Copy, Default)]
struct WayBack {
    /// How far from the middle of the fence it is or was, and when it last came nearer.
    away_m: f64,
    nearer_at: Duration,
    /// How fast it goes or went away, and until when it is waited for it because it has lost much of that.
    away_m_s: f64,
    brakes_until: Duration,
}

impl WayBack {
    fn begin(now: Duration, gust_since: Duration) -> Self {
        Self { nearer_at: now, brakes_until: gust_since + GUST, ..Self::default() }
    }

    fn see(&mut self, now: &Circumstances) {
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

    fn is_none(&self, now: &Circumstances) -> bool {
        let no_nearer = now.now >= self.nearer_at + NO_WAY_BACK;
        let too_strong = outward(now, now.wind) > TOO_STRONG;
        (no_nearer || too_strong) && now.now >= self.brakes_until
    }
}

/// The part of (right, forward) that leads away from the middle of the fence.
fn outward(now: &Circumstances, [right, forward]: [f64; 2]) -> f64 {
    let Pose { x_m, y_m, .. } = now.pose;
    (right * x_m + forward * y_m) / x_m.hypot(y_m).max(f64::EPSILON)
}

/// How long a drone at this height needs at most to sink to where it lands by itself.
fn time_to_sink(height_m: f64) -> Duration {
    Duration::try_from_secs_f64((height_m - HIGH_M) / SINKS_M_S).unwrap_or_default().min(RETREAT)
}

/// Where the drone comes to rest if it begins to brake now.
fn stopping_place(now: &Circumstances) -> Pose {
    let way_m = |speed_m_s: f64| {
        speed_m_s * REACTION_S + speed_m_s * speed_m_s.abs() / (2.0 * BRAKING_M_S2)
    };
    let [right, forward, up] = now.velocity_m_s.map(way_m);
    let Pose { x_m, y_m, z_m, yaw_deg } = now.pose;
    Pose { x_m: x_m + right, y_m: y_m + forward, z_m: z_m + up, yaw_deg }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) const FINE: Circumstances = Circumstances {
        now: Duration::from_mins(1),
        blind_for: Duration::ZERO,
        emergency: false,
        airborne: true,
        landing: false,
        pose: Pose { x_m: 0.0, y_m: 0.0, z_m: 1.0, yaw_deg: 0.0 },
        velocity_m_s: [0.0; 3],
        wind: [0.0; 2],
        full_tilt_m_s2: 2.0,
        drag_1_s: 0.2,
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
    fn a_drone_that_lands_is_let_land() {
        let landing = Circumstances { landing: true, ..FINE };
        for command in [AgentCommand::TakeOff, AgentCommand::Hover, GO_TO, AgentCommand::Sticks] {
            let vetoed = (AgentCommand::Land, Some(Veto::Landing));
            assert_eq!(guard().check(command, &landing), vetoed);
        }
        let outside = Circumstances { pose: Pose { x_m: 11.0, ..FINE.pose }, ..FINE };
        let mut guard = guard();
        assert_ne!(guard.check(GO_TO, &outside).0, AgentCommand::Land);
        let command = guard.check(AgentCommand::Land, &Circumstances { landing: true, ..outside });
        assert_eq!(command, (AgentCommand::Land, None), "no retreat any more");
    }

    #[test]
    fn a_drone_that_rises_after_its_landing_is_landed_again() {
        let mut guard = guard();
        let on_ground = Circumstances { airborne: false, ..FINE };
        guard.check(AgentCommand::TakeOff, &on_ground);
        guard.check(AgentCommand::Standby, &on_ground);
        assert_eq!(guard.check(AgentCommand::Hover, &on_ground).0, AgentCommand::Hover);
        let lands = (AgentCommand::Land, Some(Veto::Landing));
        assert_eq!(guard.check(AgentCommand::Hover, &FINE), lands);
        let landed = (AgentCommand::TakeOff, None);
        assert_eq!(guard.check(AgentCommand::TakeOff, &on_ground), landed);
        assert_eq!(guard.check(AgentCommand::Hover, &FINE), (AgentCommand::Hover, None));
    }

    #[test]
    fn a_drone_that_is_landed_for_its_safety_is_landed_to_the_end() {
        for bad in [
            Circumstances { blind_for: Duration::from_secs(5), ..FINE },
            Circumstances { pose: Pose { x_m: 10.4, ..FINE.pose }, ..FINE },
            Circumstances { pose: Pose { z_m: 3.4, ..FINE.pose }, ..FINE },
        ] {
            let mut guard = guard();
            let veto = guard.check(AgentCommand::Hover, &bad).1;
            assert!(veto.is_some_and(Veto::lands));
            let low = Circumstances { pose: Pose { z_m: 0.5, ..FINE.pose }, ..FINE };
            assert_eq!(guard.check(GO_TO, &low).0, AgentCommand::Land, "it came back");
            let landed = Circumstances { airborne: false, ..FINE };
            assert_eq!(guard.check(AgentCommand::TakeOff, &landed).0, AgentCommand::TakeOff);
        }
    }

    #[test]
    fn a_drone_outside_the_fence_is_flown_back_and_down() {
        let outside = Circumstances { pose: Pose { y_m: -10.5, z_m: 2.0, ..FINE.pose }, ..FINE };
        let stale = Circumstances { blind_for: Duration::from_millis(400), ..outside };
        let blind = Circumstances { blind_for: Duration::from_millis(1001), ..outside };
        let much_later = Circumstances { now: outside.now + RETREAT, ..outside };
        let land = AgentCommand::Land;
        assert_eq!(guard().check(land, &outside), (land, None), "whoever lands, lands");
        for then in [&blind, &much_later] {
            let mut guard = guard();
            let (command, veto) = guard.check(GO_TO, &outside);
            assert_eq!(veto, Some(Veto::OutsideFence));
            let AgentCommand::GoTo(target) = command else { panic!("{command:?}") };
            assert!((target.y_m + 9.5).abs() < 1e-9 && target.z_m < 0.5, "{target:?}");
            // The landing that is then ordered waits for that, but not for ever, nor blindly.
            assert_eq!(guard.check(land, &outside).0, command);
            assert_eq!(guard.check(land, &stale).0, AgentCommand::Hover);
            assert_eq!(guard.check(land, then).0, land);
            assert_eq!(guard.check(land, &outside).0, land, "a landing is not taken back");
        }
        let mut guard = guard();
        guard.check(GO_TO, &outside);
        guard.land_here();
        assert_eq!(guard.check(land, &outside).0, land, "nor does it wait for the pilot");
    }

    #[test]
    fn near_the_floor_the_drone_sinks_slowly() {
        let down = Demand { gaz: -1.0, ..Demand::default() };
        let gaz = |height_m| guard().limit(&down, 1.0, height_m, 0.7).gaz;
        assert!((gaz(2.0) + 1.0).abs() < 1e-9);
        assert!((-0.4..-0.3).contains(&gaz(0.5)), "{}", gaz(0.5));
        assert!((-0.25..-0.2).contains(&gaz(0.1)), "{}", gaz(0.1));
        let up = Demand { gaz: 1.0, ..Demand::default() };
        assert!((guard().limit(&up, 1.0, 0.1, 0.7).gaz - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_drone_that_does_not_come_back_is_landed_where_it_is() {
        let lands_after = |speed_m_s: f64| {
            let mut guard = guard();
            (0_u32..400).map(|tick| Duration::from_millis(30) * tick).find(|time| {
                let x_m = 10.5 + speed_m_s * time.as_secs_f64();
                let now = Circumstances {
                    now: FINE.now + *time,
                    pose: Pose { x_m, ..FINE.pose },
                    ..FINE
                };
                guard.check(GO_TO, &now).0 == AgentCommand::Land
            })
        };
        let soon = NO_WAY_BACK + Duration::from_millis(60);
        for blown_m_s in [0.0, 2.0] {
            assert!(lands_after(blown_m_s).is_some_and(|time| time <= soon), "{blown_m_s}");
        }
        assert!(lands_after(-0.1).is_some_and(|time| time >= RETREAT), "slowly, but it comes back");
    }

    #[test]
    fn a_drone_is_not_flown_back_against_a_wind_that_is_stronger_than_it() {
        // It leaves the fence at 3 m/s, and loses of that what it does.
        let lands_after = |wind: [f64; 2], brakes_m_s2: f64| {
            let mut guard = guard();
            (0_u32..400).map(|tick| Duration::from_millis(30) * tick).find(|time| {
                let away_m_s = (3.0 - brakes_m_s2 * time.as_secs_f64()).max(0.1);
                let now = Circumstances {
                    now: FINE.now + *time,
                    pose: Pose { y_m: -10.5 - away_m_s, ..FINE.pose },
                    velocity_m_s: [0.0, -away_m_s, 0.0],
                    wind,
                    ..FINE
                };
                guard.check(GO_TO, &now).0 == AgentCommand::Land
            })
        };
        let within = |time: Option<Duration>, most: Duration| time.is_some_and(|time| time <= most);
        let tick = Duration::from_millis(30);
        assert!(within(lands_after([0.0, -1.1], 0.0), GUST + tick), "a storm");
        assert!(!within(lands_after([0.0, -1.1], 1.5), GUST + 5 * tick), "it was a gust");
        for bearable in [[0.0, -0.9], [0.0, 1.1], [1.1, 0.0]] {
            assert!(!within(lands_after(bearable, 0.0), GUST + 5 * tick), "{bearable:?}");
        }
    }

    #[test]
    fn a_drone_that_is_carried_off_is_flown_down_against_the_wind_and_lands() {
        // Three metres inside, backward by 1 m/s, in a storm.
        let lands_after = |height_m: f64, sinks_m_s: f64| {
            let mut guard = guard();
            let mut downward = 0;
            let lands = (0_u32..400).map(|tick| Duration::from_millis(30) * tick).find(|time| {
                let sunk_m = sinks_m_s * time.saturating_sub(GUST).as_secs_f64();
                let now = Circumstances {
                    now: FINE.now + *time,
                    pose: Pose { y_m: -7.0, z_m: height_m - sunk_m, ..FINE.pose },
                    velocity_m_s: [0.0, -1.0, 0.0],
                    wind: [0.0, -1.1],
                    ..FINE
                };
                let (command, veto) = guard.check(GO_TO, &now);
                if veto == Some(Veto::CarriedOff)
                    && let AgentCommand::GoTo(target) = command
                {
                    assert!(target.y_m > -5.1 && target.z_m < 0.5, "{target:?}");
                    downward += 1;
                }
                command == AgentCommand::Land
            });
            (lands.unwrap_or(Duration::MAX), downward)
        };
        let tick = Duration::from_millis(30);
        assert_eq!(lands_after(0.75, 0.5), (GUST, 0), "low already");
        let (time, downward) = lands_after(1.8, 0.5);
        assert!(time <= GUST + Duration::from_secs(2) + 2 * tick && downward > 60, "{time:?}");
        let (time, _) = lands_after(1.8, 0.0);
        assert!(
            time <= GUST + Duration::from_millis(2500) + 2 * tick,
            "it does not sink: {time:?}"
        );
        assert_eq!(time_to_sink(f64::NAN), Duration::ZERO);
        assert_eq!(time_to_sink(f64::INFINITY), Duration::ZERO);
    }

    #[test]
    fn targets_outside_the_fence_are_not_flown_to() {
        let here = FINE.pose;
        for target in [
            Pose { x_m: 8.0, y_m: -7.0, ..here },
            Pose { z_m: 3.1, ..here },
            Pose { z_m: 0.2, ..here },
        ] {
            let (command, veto) = guard().check(AgentCommand::GoTo(target), &FINE);
            assert_eq!(veto, Some(Veto::TargetOutside));
            let AgentCommand::GoTo(inside) = command else { panic!("{command:?}") };
            assert!(guard().is_inside(&inside, 1e-6), "{inside:?}");
        }
    }

    #[test]
    fn by_hand_the_drone_may_rest_at_the_floor_and_at_the_ceiling_of_its_fence() {
        let FlightLimits { floor_m, ceiling_m, .. } = FlightLimits::default();
        for (z_m, up_m_s, stays) in [
            (floor_m, 0.0, true),
            (ceiling_m, 0.0, true),
            (floor_m, -0.1, false),
            (floor_m - 0.1, 0.1, true),
            (ceiling_m, 0.1, false),
            (ceiling_m + 0.1, -0.1, true),
        ] {
            let pose = Pose { z_m, ..FINE.pose };
            let now = Circumstances { pose, velocity_m_s: [0.0, 0.0, up_m_s], ..FINE };
            let (_, veto) = guard().check(AgentCommand::Sticks, &now);
            assert_eq!(veto, (!stays).then_some(Veto::NearFence), "{z_m} {up_m_s}");
        }
    }

    #[test]
    fn the_pilots_hand_stops_before_the_fence_and_may_fly_back() {
        let near_the_fence = Pose { x_m: 9.0, ..FINE.pose };
        let moving =
            |x, up| Circumstances { pose: near_the_fence, velocity_m_s: [x, 0.0, up], ..FINE };
        let check = |now| guard().check(AgentCommand::Sticks, &now).1;
        assert_eq!(check(moving(1.0, 0.0)), Some(Veto::NearFence));
        assert_eq!(check(moving(-1.0, 0.0)), None);
        assert_eq!(check(moving(0.4, 0.0)), None);
        assert_eq!(check(moving(0.0, 3.0)), Some(Veto::NearFence));
    }

    #[test]
    fn sticks_are_limited_and_do_not_jump() {
        let mut guard = guard();
        let full = Demand { roll: 1.0, pitch: -3.0, gaz: f64::NAN, yaw: 0.2 };
        let limited = guard.limit(&full, 0.6, 2.0, 0.7);
        assert_eq!(limited, Demand { roll: 0.6, pitch: -0.6, gaz: 0.0, yaw: 0.2 });
        let limited = guard.limit(&Demand { roll: -1.0, ..full }, 1.0, 2.0, 0.7);
        assert!((limited.roll + 0.4).abs() < 1e-12, "{limited:?}");
        guard.let_go();
        assert!((guard.limit(&full, 1.0, 2.0, 0.7).roll - 1.0).abs() < 1e-12);
    }
}
