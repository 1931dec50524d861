//! The conditions that change the phase of a flight, and end it.

use std::time::Duration;

use ardrone_link::navdata::DroneState;

use super::readiness::NotReady;
use super::{
    AgentOrder, Authority, BLIND_LANDING_TIME, CONFIGURE_TIMEOUT, CONNECT_TIMEOUT, Configured,
    Danger, FAULT_TIME, FlightEvent, FlightPhase, LANDING_TIMEOUT, LandingReason, SETTLE_TIME,
    TAG_LANDING_TIMEOUT, Trust, Vehicle, Veto, session,
};
use crate::outcome::Outcome;

/// Longest time for an order to reach the drone and for its effect to show in navdata.
pub(super) const ON_ITS_WAY: Duration = Duration::from_millis(600);
/// The link to a drone that was heard so recently is not lost.
const HEARD: Duration = Duration::from_millis(500);
/// A drone that rises within this time after landing follows an old order of ours. Later than that, another
/// pilot flies it.
pub(super) const OURS: Duration = Duration::from_secs(2);

impl Vehicle {
    /// Advances the phase and detects the conditions that end a flight.
    pub(super) fn watch(&mut self, now: Duration) {
        let departs = self.departure.is_some();
        if self.has_lasting_emergency(now) {
            self.end(now, Outcome::Emergency);
        }
        match self.phase {
            _ if self.is_flown_by_another() => {
                if departs {
                    self.refuse(now, vec![NotReady::NotLanded.to_string()]);
                } else {
                    self.observe_again(now);
                }
            }
            FlightPhase::Connecting
                if self.departure.is_some_and(|at| now.saturating_sub(at) >= CONNECT_TIMEOUT) =>
            {
                self.end(now, Outcome::NoDrone);
            }
            FlightPhase::Observing { since, received } if departs => {
                let watched = now.saturating_sub(since);
                if watched >= SETTLE_TIME {
                    let packets = self.session.statistics().received.saturating_sub(received);
                    self.take_over_or_refuse(now, watched, packets);
                }
            }
            // Another client has landed the drone, and may have changed its settings.
            FlightPhase::Observing { .. } if self.on_ground() && self.navdata.is_some() => {
                self.request(now, session::Request::AllSettings);
                self.begin_to_configure(now, Authority::OnGround);
            }
            FlightPhase::Configuring { since }
                if departs && now.saturating_sub(since) >= CONFIGURE_TIMEOUT =>
            {
                let reason = "the drone does not take its configuration".to_owned();
                self.refuse(now, vec![reason]);
            }
            FlightPhase::Settling { since, received } => {
                let watched = now.saturating_sub(since);
                if watched < SETTLE_TIME {
                } else if departs {
                    let packets = self.session.statistics().received.saturating_sub(received);
                    self.take_off_or_refuse(now, watched, packets);
                } else {
                    self.phase = FlightPhase::Standby { since: now };
                }
            }
            FlightPhase::Standby { since } if !self.on_ground() => self.has_risen(now, since),
            FlightPhase::Flying => self.watch_flight(now),
            FlightPhase::Landing { since } => self.watch_landing(now, since),
            FlightPhase::Connecting
            | FlightPhase::Observing { .. }
            | FlightPhase::Configuring { .. }
            | FlightPhase::Standby { .. } => {}
        }
    }

    /// Handles a drone that took off while standing by.
    fn has_risen(&mut self, now: Duration, since: Duration) {
        if self.flight.has_begun && now.saturating_sub(since) < OURS {
            self.phase = FlightPhase::Landing { since: now };
            // Pre-empting goals are always accepted.
            let accepted = self.flight.agent.achieve_land();
            debug_assert!(accepted);
        } else {
            self.observe_again(now);
        }
    }

    /// Another pilot flies the drone: stop sending until it stands on the ground.
    fn observe_again(&mut self, now: Duration) {
        self.events.push_back(FlightEvent::FlownByAnother);
        self.authority = Authority::None;
        let received = self.session.statistics().received;
        self.phase = FlightPhase::Observing { since: now, received };
    }

    /// Checks the conditions that end a flight. The agent repeats a landing until the drone is down.
    fn watch_flight(&mut self, now: Duration) {
        if let Some(fault) = self.lasting_fault(now) {
            self.land(now, LandingReason::DroneFault(fault));
        }
        if self.has_come_down(now) {
            self.land(now, LandingReason::Safety(Veto::Landing));
        }
        // Lands at once: a hovering drone could not show that its measurement responds again.
        let trust = self.flight.estimator.trust();
        if matches!(trust, Trust::Unresponsive(_)) {
            self.land(now, LandingReason::Distrust(trust));
        }
        if let Some(active) = self.flight.due
            && let Some(limit) = match active.due.order {
                AgentOrder::Land => Some(LANDING_TIMEOUT),
                AgentOrder::LandOnTag => Some(TAG_LANDING_TIMEOUT),
                AgentOrder::TakeOff | AgentOrder::GoTo(_) | AgentOrder::FindTag => None,
            }
            && now.saturating_sub(active.since) >= limit
        {
            self.land(now, LandingReason::StepTimedOut { step: active.due.step });
        }
    }

    /// The fault that the drone reports, once it has lasted for [`FAULT_TIME`], because a single packet may
    /// be damaged.
    fn lasting_fault(&mut self, now: Duration) -> Option<&'static str> {
        let fault = if self.on_ground() { None } else { self.reported_fault() };
        let lasts = self.flight.fault.lasts(now, fault.is_some(), FAULT_TIME);
        fault.filter(|_| lasts)
    }

    /// Whether the drone has cut its motors in a flight, for [`FAULT_TIME`].
    fn has_lasting_emergency(&mut self, now: Duration) -> bool {
        let flies = matches!(self.phase, FlightPhase::Flying | FlightPhase::Landing { .. });
        let emergency = flies && self.drone_state().contains(DroneState::EMERGENCY);
        self.flight.emergency.lasts(now, emergency, FAULT_TIME)
    }

    /// Whether the drone has landed by itself: the agent hears of it only if it had an order to carry out.
    fn has_come_down(&mut self, now: Duration) -> bool {
        self.flight.has_lifted |= !self.on_ground();
        let down = self.flight.has_lifted && self.on_ground() && !self.lands();
        self.flight.down.lasts(now, down, FAULT_TIME)
    }

    /// Whether another pilot has taken off with the drone while it was being prepared.
    fn is_flown_by_another(&self) -> bool {
        let prepares =
            matches!(self.phase, FlightPhase::Configuring { .. } | FlightPhase::Settling { .. });
        prepares && self.authority == Authority::OnGround && !self.on_ground()
    }

    /// Refuses the flight. A drone that was taken over in the air is landed; otherwise nothing is sent to a
    /// drone in the air.
    pub(super) fn refuse(&mut self, now: Duration, reasons: Vec<String>) {
        if self.authority == Authority::TakenOver && !self.on_ground() {
            self.flight.refusals = reasons;
            self.land(now, LandingReason::TakeOverRefused);
            return;
        }
        if !self.on_ground() {
            self.authority = Authority::None;
            let received = self.session.statistics().received;
            self.phase = FlightPhase::Observing { since: now, received };
        }
        self.end(now, Outcome::PreflightRefused { reasons });
    }

    /// Handles a danger reported by the agent. Except for warnings and what concerns tags, the agent is already
    /// landing.
    pub(super) fn endangered(&mut self, now: Duration, danger: Danger) {
        let percent = self.demo().map_or(0, |demo| demo.battery_percent);
        let reason = match danger {
            Danger::BatteryLow => {
                self.events.push_back(FlightEvent::BatteryLow { percent });
                return;
            }
            Danger::Searching => {
                self.events.push_back(FlightEvent::SearchingTag);
                return;
            }
            Danger::NoTag => {
                self.events.push_back(FlightEvent::NoTagFound);
                return;
            }
            Danger::TagLost => {
                self.events.push_back(FlightEvent::TagLost);
                return;
            }
            Danger::StationSilent => {
                // The agent says it in every step.
                let told = self.decision.is_some_and(|last| last.danger == Some(danger));
                if !told {
                    self.events.push_back(FlightEvent::StationSilent);
                }
                return;
            }
            Danger::SetpointsGone => LandingReason::SetpointsGone,
            Danger::StationGone => LandingReason::StationGone,
            Danger::BatteryEmpty => LandingReason::Battery { percent },
            Danger::Blind => match self.flight.estimator.trust() {
                Trust::Sound if self.session.silence(now).is_some_and(|age| age <= HEARD) => {
                    LandingReason::NavdataLate
                }
                Trust::Sound => LandingReason::LinkLost,
                trust => LandingReason::Distrust(trust),
            },
            Danger::Lost => LandingReason::PlaceUncertain,
            Danger::Wind => LandingReason::Wind,
            Danger::NoProgress if self.flight.manual.sends() => LandingReason::ManualTargetTimedOut,
            Danger::NoProgress => LandingReason::StepTimedOut {
                step: self.flight.due.map_or(0, |active| active.due.step),
            },
        };
        self.give_up(now, reason);
    }

    fn watch_landing(&mut self, now: Duration, since: Duration) {
        let elapsed = now.saturating_sub(since);
        let blind = !self.session.is_alive();
        // A take-off ordered just before the landing may not have taken effect yet.
        let landed = !blind && self.on_ground() && elapsed >= ON_ITS_WAY;
        // A restarted drone sends its state before it sends flight data.
        let known = self.demo().is_some();
        if landed && known {
            self.flight.report.landed_at = Some(now);
        } else if !(blind && elapsed >= BLIND_LANDING_TIME || elapsed >= LANDING_TIMEOUT) {
            return;
        }
        let outcome = match self.flight.landing {
            Some(LandingReason::Operator) if landed => Outcome::Interrupted,
            Some(LandingReason::Operator) => Outcome::LeftLanding,
            Some(LandingReason::LinkLost) => Outcome::LinkLost,
            Some(LandingReason::TakeOverRefused) => {
                Outcome::PreflightRefused { reasons: std::mem::take(&mut self.flight.refusals) }
            }
            Some(reason) => {
                let mut reason = reason.to_string();
                if !landed {
                    reason.push_str("; the drone did not confirm that it has landed");
                }
                Outcome::Failsafe { reason }
            }
            None => Outcome::Completed,
        };
        self.end(now, if blind { Outcome::LinkLost } else { outcome });
    }

    /// Gives up the mission and lands. The first reason is kept. On the ground the flight ends at once.
    pub(super) fn land(&mut self, now: Duration, reason: LandingReason) {
        let flies = matches!(self.phase, FlightPhase::Flying);
        if self.flight.landing.is_some()
            || !flies && self.departure.is_none() && !self.is_ours_in_the_air()
        {
            return;
        }
        if self.authority == Authority::None && self.navdata.is_some() {
            self.refuse(now, vec![NotReady::NotLanded.to_string()]);
            return;
        }
        if !flies && self.on_ground() {
            self.end(now, Outcome::Interrupted);
            return;
        }
        // Pre-empting: always accepted, obeyed in the next step.
        let accepted = self.flight.agent.achieve_land();
        debug_assert!(accepted);
        self.give_up(now, reason);
    }

    /// Marks the mission as given up; the agent lands. The first reason is kept.
    fn give_up(&mut self, now: Duration, reason: LandingReason) {
        if self.flight.landing.is_some() {
            return;
        }
        self.events.push_back(FlightEvent::LandingOrdered(reason));
        self.flight.landing = Some(reason);
        self.flight.due = None;
        self.phase = FlightPhase::Landing { since: now };
    }

    /// Whether a drone in the air was taken over but is not being flown yet.
    fn is_ours_in_the_air(&self) -> bool {
        self.authority == Authority::TakenOver && !self.on_ground()
    }

    /// Sets the flight's outcome; the first one is kept. A drone on the ground returns to standby; one in the
    /// air, or lost, continues to be landed.
    pub(super) fn end(&mut self, now: Duration, outcome: Outcome) {
        if self.flight.outcome.is_none() {
            let outcome = match (outcome, self.flight.cross_checks.contradicts()) {
                (Outcome::Completed, Some(by)) => Outcome::Contradicted { by },
                (outcome, _) => outcome,
            };
            self.flight.outcome = Some(outcome);
            self.pending.outcome = true;
        }
        self.departure = None;
        let is_down = self.session.is_alive() && self.on_ground() && self.demo().is_some();
        self.phase = match &self.phase {
            FlightPhase::Settling { .. } | FlightPhase::Flying | FlightPhase::Landing { .. }
                if is_down && self.session.is_ready() =>
            {
                FlightPhase::Standby { since: now }
            }
            FlightPhase::Flying | FlightPhase::Landing { .. } if is_down => {
                FlightPhase::Configuring { since: now }
            }
            FlightPhase::Flying => {
                // Pre-empting goals are always accepted.
                let accepted = self.flight.agent.achieve_land();
                debug_assert!(accepted);
                FlightPhase::Landing { since: now }
            }
            other => other.clone(),
        };
        if is_down {
            self.authority = match self.authority {
                Authority::TakenOver => Authority::OnGround,
                other => other,
            };
        }
    }

    /// Starts sending to the drone.
    pub(super) fn begin_to_configure(&mut self, now: Duration, authority: Authority) {
        self.authority = authority;
        self.flight.asked_at = now;
        self.configured = Configured::default();
        self.phase = FlightPhase::Configuring { since: now };
    }
}
