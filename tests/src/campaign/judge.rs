//! Judges a flight by the true state, the orders and the injected faults. The pilot's own view excuses
//! nothing.

use std::time::Duration;

use ardrone_link::at::Motion;
use ardrone_link::navdata::DroneState;
use autopilot::outcome::Outcome;
use autopilot::vehicle::{FlightEvent, Phase as PilotPhase, TICK};
use mock_drone::firmware::Phase;
use mock_drone::{Drone, Truth};

use super::fault::{Danger, Fault};
use super::fence::Fence;
use super::flight::Flight;
use super::injected::{Injected, is_airborne};
use super::orders::Orders;
use super::silence::Silence;
use super::targets::{TAKE_OFF_STEP, Targets};
use crate::sim::{Moment, SimulatedFlight};

/// Longest time for an order to arrive.
const ON_ITS_WAY: Duration = Duration::from_millis(500);
/// Longest flight: plans have at most seven targets.
const LONGEST: Duration = Duration::from_mins(10);
/// A drone that has accepted a command within this time receives us.
const HEARS: Duration = Duration::from_millis(300);
/// Navdata up to this age are fresh.
const FRESH: Duration = Duration::from_millis(300);
/// Height of a room's ceiling above the fence's.
const CEILING_ABOVE_FENCE_M: f64 = 1.0;
/// Touch-down speed that damages nothing.
const SOFT_M_S: f64 = 0.9;
/// A drone with a wrong altitude may hit the floor, but must notice within this time that it sinks no
/// further.
const SCRAPES_FOR: Duration = Duration::from_secs(3);
/// Smallest stick that moves the drone.
const MOVING: f32 = 0.02;
/// Time in which missing navdata must be noticed and an order must arrive.
const BLIND: Duration = Duration::from_millis(1500);
/// A condition that is true for a shorter time may be due to delays.
const MOMENT: Duration = Duration::from_millis(200);
/// Time in which a drone must be down, including a descent of its own.
const LANDS_WITHIN: Duration = Duration::from_secs(40);
/// Number of standard deviations that an honest estimate hardly ever exceeds; and an error too small to
/// matter.
const DEVIATIONS: f64 = 4.0;
const TRIFLE_M: f64 = 0.1;
const WRONG_FOR: Duration = Duration::from_secs(1);
/// Largest true error at a target that counts as reached: as requested by plans, and with wrong sensors; plus
/// the estimate's claimed error.
const REACHED_M: f64 = 0.5;
const REACHED_LYING_M: f64 = 1.5;
/// The agent's own limit of position uncertainty is 3 m; far beyond it nobody may fly on.
const LOST_M: f64 = 3.6;
/// Wind and gusts that a drone holds against within a metre for a long time, as a share of what it resists.
const CALM: f64 = 0.5;
/// Time for another pilot's drone to land by itself after that pilot's last command.
const STRANGER_LANDS: Duration = Duration::from_secs(15);

/// A danger and how long it lasts.
#[derive(Debug)]
struct DangerWatch {
    danger: Danger,
    /// It counts after this time.
    counts_after: Duration,
    /// Longest time in the air from then on.
    patience: Duration,
    lasted: Duration,
    /// Time in the air since then, while the drone receives us.
    open: Option<Duration>,
}

impl DangerWatch {
    fn new(danger: Danger) -> Self {
        let (counts_after, patience) = match danger {
            Danger::Battery => (1, 30),
            Danger::Blind => (4, 25),
            Danger::Worthless | Danger::Lost => (3, 25),
            Danger::Broken => (2, 25),
            Danger::NoFloor => (5, 30),
            Danger::Wind => (5, 40),
            Danger::Station | Danger::Setpoints => (1, 25),
        };
        Self {
            danger,
            counts_after: Duration::from_secs(counts_after),
            patience: Duration::from_secs(patience),
            lasted: Duration::ZERO,
            open: None,
        }
    }

    fn watch(&mut self, lasts: bool, airborne: bool, reached: bool) -> Option<Fault> {
        if !airborne {
            self.lasted = Duration::ZERO;
            self.open = None;
            return None;
        }
        self.lasted = if lasts { self.lasted + TICK } else { Duration::ZERO };
        if self.lasted >= self.counts_after {
            self.open.get_or_insert(Duration::ZERO);
        }
        if reached {
            self.open = self.open.map(|open| open + TICK);
        }
        let after = self.open.filter(|open| *open > self.patience)?;
        Some(Fault::DangerIgnored { danger: self.danger, after })
    }
}

/// Duration of a condition.
#[derive(Debug, Default)]
struct Lasting(Duration);

impl Lasting {
    /// Updates it; returns how long the condition has been true.
    fn watch(&mut self, so: bool) -> Duration {
        self.0 = if so { self.0 + TICK } else { Duration::ZERO };
        self.0
    }
}

/// Judge of one flight.
#[derive(Debug)]
pub(super) struct Judge {
    injected: Injected,
    /// The wind at the start with its gusts, and the strongest that the airframe resists.
    wind_m_s: f64,
    gusts_m_s: f64,
    strongest_m_s: f64,
    pub(super) fence: Fence,
    orders: Orders,
    silence: Silence,
    targets: Targets,
    dangers: [DangerWatch; 9],
    /// Faults found, with their times.
    found: Vec<(Duration, Fault)>,
    last: Option<Truth>,
    /// When the plan's take-off was last ordered.
    ordered_at: Option<Duration>,
    scrapes: Lasting,
    moves_blindly: Lasting,
    place_wrong: Lasting,
    height_wrong: Lasting,
    /// Duration of the landing.
    lands_for: Duration,
    flew: bool,
    phase_at_end: Option<Phase>,
    /// Largest error of healthy sensors.
    pub(super) wrong_m: f64,
}

impl Judge {
    pub(super) fn new(flight: &Flight) -> Self {
        let drone = &flight.simulation.world.drone;
        let limits = &flight.simulation.pilot.limits;
        Self {
            injected: flight.injected.clone(),
            wind_m_s: drone.wind_m_s.norm(),
            gusts_m_s: drone.gusts_m_s,
            strongest_m_s: flight.strongest_m_s,
            fence: Fence::new(limits),
            orders: Orders::new(
                &flight.simulation.orders,
                &flight.simulation.others,
                limits,
                flight.plan.steps().len().saturating_sub(1),
            ),
            silence: Silence::new(&flight.simulation.orders, &flight.simulation.others),
            targets: Targets::of(&flight.plan, limits, flight.tags.is_some()),
            dangers: [
                Danger::Battery,
                Danger::Blind,
                Danger::Worthless,
                Danger::Broken,
                Danger::NoFloor,
                Danger::Wind,
                Danger::Lost,
                Danger::Station,
                Danger::Setpoints,
            ]
            .map(DangerWatch::new),
            found: Vec::new(),
            last: None,
            ordered_at: None,
            scrapes: Lasting::default(),
            moves_blindly: Lasting::default(),
            place_wrong: Lasting::default(),
            height_wrong: Lasting::default(),
            lands_for: Duration::ZERO,
            flew: false,
            phase_at_end: None,
            wrong_m: 0.0,
        }
    }

    /// Records a fault; only the first of each kind.
    fn find(&mut self, now: Duration, fault: Fault) {
        if !self.found.iter().any(|(_, known)| known.kind() == fault.kind()) {
            self.found.push((now, fault));
        }
    }

    /// Judges a tick.
    pub(super) fn watch(&mut self, moment: &Moment, drone: &Drone) {
        let Moment { now, truth, .. } = moment;
        self.injected.see(truth);
        self.flew |= truth.phase == Phase::Flying;
        self.wrong_m = self.wrong_m.max(truth.drift_m().norm());
        if moment.is_over {
            self.phase_at_end.get_or_insert(truth.phase);
        }
        self.targets.watch(moment);
        let overpowered = self.is_overpowered(*now);
        self.fence.watch(moment, drone, &self.injected, overpowered);
        let heard = truth.heard_at.is_some_and(|at| now.saturating_sub(at) < HEARS);
        let stranger = self.injected.second_pilot(*now, Duration::from_secs(1));
        let reached = heard && !stranger && !moment.is_over;
        for fault in self.orders.watch(moment, &self.injected, reached) {
            self.find(*now, fault);
        }
        let steady = reached && self.is_calm(*now);
        if let Some(fault) = self.silence.watch(moment, &self.injected, steady) {
            self.find(*now, fault);
        }
        self.watch_dangers(moment, reached, overpowered);
        self.watch_contacts(moment);
        self.watch_sticks(moment, reached);
        self.watch_landing(moment, reached);
        self.watch_honesty(moment);
        self.watch_take_off(moment);
        if truth.trims_in_flight > 0 {
            self.find(*now, Fault::TrimmedInFlight);
        }
        self.last = Some(*truth);
    }

    fn is_overpowered(&self, now: Duration) -> bool {
        // The wind acts on the drone one tick later.
        let wind_m_s =
            self.injected.wind_m_s(now.saturating_sub(2 * TICK)).unwrap_or(self.wind_m_s);
        wind_m_s > 0.9 * self.strongest_m_s
    }

    /// Whether no gust carries the drone far.
    fn is_calm(&self, now: Duration) -> bool {
        let (wind_m_s, gusts_m_s) =
            self.injected.wind(now).unwrap_or((self.wind_m_s, self.gusts_m_s));
        wind_m_s + 3.0 * gusts_m_s < CALM * self.strongest_m_s
    }

    fn watch_dangers(&mut self, moment: &Moment, reached: bool, overpowered: bool) {
        let Moment { now, truth, status, .. } = moment;
        let (now, airborne) = (*now, is_airborne(truth));
        let broken = DroneState::MOTORS_PROBLEM
            | DroneState::SOFTWARE_FAULT
            | DroneState::ANGLES_OUT_OF_RANGE
            | DroneState::CUTOUT_DETECTED
            | DroneState::BATTERY_LOW;
        for index in 0..self.dangers.len() {
            let lasts = match self.dangers[index].danger {
                Danger::Battery => truth.battery_percent <= 10.0,
                Danger::Blind => status.navdata_age.is_some_and(|age| age > FRESH),
                Danger::Worthless => self.injected.worthless_for(now) > Duration::ZERO,
                Danger::Broken => self.injected.claims(now, broken),
                Danger::NoFloor if truth.phase != Phase::Flying => false,
                Danger::NoFloor => {
                    self.injected.claims(now, DroneState::ULTRASOUND_DEAF)
                        || self.injected.claims_no_floor(now)
                }
                // A drone that stays inside resists more wind than calculated.
                Danger::Wind => overpowered && self.fence.is_outside(truth),
                Danger::Lost => status.uncertainty_m > LOST_M,
                Danger::Station => self.silence.is_station_gone(now),
                Danger::Setpoints => self.silence.are_setpoints_gone(now),
            };
            if let Some(fault) = self.dangers[index].watch(lasts, airborne, reached) {
                self.find(now, fault);
            }
        }
    }

    fn watch_contacts(&mut self, moment: &Moment) {
        let Moment { now, truth, .. } = moment;
        let Some(last) = self.last else { return };
        let lied = self.injected.has_lied_of_height(*now);
        // A drone with a weak motor sinks.
        let excused = lied || self.fence.may_meet_floor || self.injected.has_weak_motor(*now);
        if truth.floor_contacts > last.floor_contacts && !excused {
            let speed_m_s = truth.touch_down_m_s.unwrap_or_default();
            self.find(*now, Fault::FloorContact { speed_m_s });
        }
        let scrapes = truth.phase == Phase::Flying && truth.position_m.z <= 0.0;
        if self.scrapes.watch(scrapes) > SCRAPES_FOR {
            self.find(*now, Fault::Scraping);
        }
        let room_m = self.fence.ceiling_m() + CEILING_ABOVE_FENCE_M;
        if truth.position_m.z > room_m {
            self.find(*now, Fault::CeilingContact { height_m: truth.position_m.z });
        }
        let met_floor = last.position_m.z > 0.0 && truth.position_m.z <= 0.0;
        // With cut motors the drone falls.
        let falls = !is_airborne(&last)
            || truth.phase == Phase::Emergency
            || truth.switched_on != last.switched_on;
        let speed_m_s = truth.touch_down_m_s.filter(|_| met_floor && !falls).unwrap_or_default();
        if speed_m_s > SOFT_M_S && !self.fence.may_meet_floor {
            self.find(*now, Fault::HardTouchDown { speed_m_s });
        }
    }

    fn watch_sticks(&mut self, moment: &Moment, reached: bool) {
        let Moment { now, truth, status, .. } = moment;
        let moves = match truth.motion {
            Motion::Hover => false,
            Motion::Progressive { roll, pitch, gaz, yaw } => {
                [roll, pitch, gaz, yaw].iter().any(|stick| stick.get().abs() > MOVING)
            }
        };
        let unseen = status.navdata_age.unwrap_or_default();
        let blind_for = unseen.max(self.injected.worthless_for(*now));
        let blindly = truth.phase == Phase::Flying && reached && moves && blind_for > BLIND;
        if self.moves_blindly.watch(blindly) > MOMENT {
            self.find(*now, Fault::BlindSticks { blind_for });
        }
    }

    fn watch_landing(&mut self, moment: &Moment, reached: bool) {
        let Moment { now, truth, status, .. } = moment;
        let fresh = status.navdata_age.is_some_and(|age| age < FRESH);
        if status.phase == PilotPhase::Landing && is_airborne(truth) && reached && fresh {
            self.lands_for += TICK;
        }
        if self.lands_for > LANDS_WITHIN {
            self.find(*now, Fault::EndlessLanding { after: self.lands_for });
        }
    }

    fn watch_honesty(&mut self, moment: &Moment) {
        let Moment { now, truth, status, .. } = moment;
        // Before the first navdata there is no estimate.
        if status.battery_percent.is_none() {
            return;
        }
        let fresh = status.navdata_age.is_some_and(|age| age < FRESH);
        let to_be_judged = fresh
            // Some flight data have arrived.
            && status.attitude_deg.is_some()
            && is_airborne(truth)
            && !moment.is_over
            && !self.injected.has_lied(*now)
            && !self.injected.has_restarted(*now);
        let pose = status.pose.unwrap_or_default();
        let place_error_m = (truth.position_m.x - pose.x_m).hypot(truth.position_m.y - pose.y_m);
        let height_error_m = (truth.position_m.z - pose.z_m).abs();
        let is_wrong = |error_m: f64, claimed_m: f64| {
            to_be_judged && error_m > DEVIATIONS * claimed_m + TRIFLE_M
        };
        let (place_claimed_m, height_claimed_m) =
            (status.uncertainty_m, status.height_uncertainty_m);
        let place_is_wrong =
            is_wrong(place_error_m, place_claimed_m) && !self.injected.has_lied_of_place(*now);
        if self.place_wrong.watch(place_is_wrong) > WRONG_FOR {
            let (error_m, claimed_m) = (place_error_m, place_claimed_m);
            self.find(*now, Fault::Overconfident { vertical: false, error_m, claimed_m });
        }
        if self.height_wrong.watch(is_wrong(height_error_m, height_claimed_m)) > WRONG_FOR {
            let (error_m, claimed_m) = (height_error_m, height_claimed_m);
            self.find(*now, Fault::Overconfident { vertical: true, error_m, claimed_m });
        }
    }

    fn watch_take_off(&mut self, moment: &Moment) {
        let Moment { now, truth, status, .. } = moment;
        let takes_off = |truth: &Truth| matches!(truth.phase, Phase::TakingOff { .. });
        let rises = takes_off(truth) && !self.last.is_some_and(|last| takes_off(&last));
        if status.phase == PilotPhase::Flying && status.step == Some(TAKE_OFF_STEP) {
            self.ordered_at = Some(*now);
        }
        let patience = ON_ITS_WAY + self.injected.longest_hold(*now);
        let ordered = self.ordered_at.is_some_and(|at| now.saturating_sub(at) <= patience);
        if rises && !ordered && !self.injected.second_pilot(*now, ON_ITS_WAY) {
            self.find(*now, Fault::UncommandedTakeOff);
        }
    }

    /// All faults found, in the order of time.
    pub(super) fn end(mut self, flight: &Flight, flown: &SimulatedFlight) -> Judged {
        let end = flown.final_truth.time;
        if let Some((at, outside_m, allowed_m)) = self.fence.worst {
            self.find(at, Fault::OutsideFence { outside_m, allowed_m });
        }
        // Another pilot may have lifted it again, and its own landing takes a while.
        let lifted = self.injected.second_pilot(end, STRANGER_LANDS);
        if is_airborne(&flown.final_truth) && !lifted {
            self.find(end, Fault::StillFlying { phase: flown.final_truth.phase });
        }
        if flown.duration > LONGEST {
            self.find(end, Fault::Hanging);
        }
        self.judge_outcome(flight, flown);
        self.found.sort_by_key(|(at, _)| *at);
        Judged { found: self.found, outside_m: self.fence.outside_m, wrong_m: self.wrong_m }
    }

    fn judge_outcome(&mut self, flight: &Flight, flown: &SimulatedFlight) {
        let end = flown.duration;
        let begins = |event: &FlightEvent| matches!(event, FlightEvent::StepStarted { .. });
        let has_begun = flown.events.iter().any(|(_, event)| begins(event));
        let says_down = match &flown.outcome {
            // Nobody exits early here, so an unconfirmed landing did not work.
            Outcome::Completed
            | Outcome::Contradicted { .. }
            | Outcome::Interrupted
            | Outcome::LeftLanding
            | Outcome::Emergency => true,
            // Unless it had begun nothing is said of where the drone is.
            Outcome::CalledOff => has_begun,
            Outcome::Failsafe { reason } => !reason.contains("did not confirm"),
            Outcome::NoDrone | Outcome::LinkLost | Outcome::PreflightRefused { .. } => false,
        };
        let phase = self.phase_at_end.unwrap_or(flown.final_truth.phase);
        // Another pilot may have lifted it again.
        let stranger = self.injected.second_pilot(end, ON_ITS_WAY);
        if says_down && !stranger && !matches!(phase, Phase::Landed | Phase::Emergency) {
            self.find(end, Fault::EndedInTheAir { phase });
        }
        if flown.outcome != Outcome::Completed {
            let contradicted = matches!(flown.outcome, Outcome::Contradicted { .. });
            if contradicted && !self.injected.may_be_contradicted(end) {
                self.find(end, Fault::ContradictedForNothing);
            }
            if flight.is_fair() {
                self.find(end, Fault::GivenUpForNothing);
            }
            return;
        }
        // A station's mission has other targets.
        if flight.is_plan_replaced() {
            return;
        }
        let waypoints = &flown.report.waypoints;
        let all_done = flown.report.steps_done >= flown.report.steps
            && waypoints.len() == self.targets.count();
        if !self.flew || !all_done {
            self.find(end, Fault::NotFlown);
        }
        for (waypoint, truth) in waypoints.iter().zip(&flown.truth_at_waypoints) {
            let Some(error_m) = self.targets.error_m(waypoint.step, truth) else { continue };
            let lied = self.injected.has_lied_of_place(waypoint.at);
            let reached_m = if lied { REACHED_LYING_M } else { REACHED_M };
            let claimed_m = DEVIATIONS * waypoint.uncertainty_m + TRIFLE_M;
            if error_m > reached_m + claimed_m {
                self.find(waypoint.at, Fault::TargetMissed { step: waypoint.step, error_m });
            }
        }
    }
}

/// Result of the judge.
pub(super) struct Judged {
    /// Faults found, with their times.
    pub(super) found: Vec<(Duration, Fault)>,
    /// Largest distance outside the fence.
    pub(super) outside_m: f64,
    /// Largest error of healthy sensors.
    pub(super) wrong_m: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::airframes::Airframes;

    /// Seconds after which the judge reports a danger of this duration, in a flight that goes on.
    fn patience_s(danger: Danger, lasts_s: u32, reached: bool) -> Option<f64> {
        let mut watch = DangerWatch::new(danger);
        (0_u32..4000).find_map(|tick| {
            let now = TICK * tick;
            let lasts = now < Duration::from_secs(1) * lasts_s;
            watch.watch(lasts, true, reached).map(|_| now.as_secs_f64())
        })
    }

    #[test]
    fn a_danger_counts_when_it_lasts_and_the_drone_can_be_landed() {
        assert_eq!(patience_s(Danger::Worthless, 2, true), None, "it was short");
        let after_s = patience_s(Danger::Worthless, 4, true).unwrap();
        assert!((27.0..29.0).contains(&after_s), "it is not forgotten: {after_s}");
        assert_eq!(patience_s(Danger::Worthless, 60, false), None, "nobody could have");
        let mut watch = DangerWatch::new(Danger::Battery);
        assert!((0..4000).all(|tick| watch.watch(true, tick < 900, true).is_none()), "it landed");
    }

    #[test]
    fn lasting_conditions_are_distinguished_from_passing_ones() {
        let mut lasting = Lasting::default();
        let longest = (0..100).map(|tick| lasting.watch(tick % 10 != 0)).max();
        assert_eq!(longest, Some(TICK * 9));
    }

    /// The judge's model of wind, wrong sensors and lost links agrees with the simulated world.
    #[test]
    fn each_flight_is_the_same_for_judge_and_pilot() {
        for seed in 0..50 {
            let flight = Flight::of(Airframes::Published, seed);
            assert_eq!(flight.simulation.world.scenario, flight.injected.scenario());
            assert_eq!(flight.simulation.stalls, flight.injected.stalls);
        }
    }
}
