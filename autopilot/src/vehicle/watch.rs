//! The conditions that change the phase of a flight, and end it.

use std::time::Duration;

use ardrone_link::navdata::DroneState;

use super::life::{Departure, Flying, Life, Preparation, Watched, Why};
use super::readiness::NotReady;
use super::{
    AgentOrder, BLIND_LANDING_TIME, CONFIGURE_TIMEOUT, CONNECT_TIMEOUT, Configured, Danger,
    FAULT_TIME, FlightEvent, LANDING_TIMEOUT, LandingReason, ROOM_TIMEOUT, SETTLE_TIME,
    TAG_LANDING_TIMEOUT, Trust, Vehicle, Veto, session,
};
use crate::outcome::Outcome;

/// Longest time for an order to reach the drone and for its effect to show in navdata.
pub(super) const ON_ITS_WAY: Duration = Duration::from_millis(600);
/// The link to a drone that was heard so recently is not lost.
const HEARD: Duration = Duration::from_millis(500);
const NOT_CONFIRMED: &str = "the drone did not confirm that it has landed";
/// A drone that rises within this time after landing follows an old order of ours. Later than that, another
/// pilot flies it.
pub(super) const OURS: Duration = Duration::from_secs(2);

impl Vehicle {
    /// Advances the state and detects the conditions that end a flight.
    pub(super) fn watch(&mut self, now: Duration) {
        let emergency = self.drone_state().contains(DroneState::EMERGENCY);
        let emergency = self.flight.emergency.lasts(now, emergency, FAULT_TIME);
        self.watch_flight_time(now);
        if emergency && self.life.is_in_flight() {
            // What it was doing must not go on once the emergency is cleared.
            if self.life.flying().is_some() {
                self.agent_lands();
            }
            self.end(now, Outcome::Emergency);
        }
        match &self.life {
            Life::Preparing { stage, departure } => {
                self.watch_preparation(now, *stage, *departure);
            }
            Life::Standby { since, has_flown } if !self.is_down(now) => {
                self.has_risen(*has_flown && now.saturating_sub(*since) < OURS, now);
            }
            Life::Standby { .. } => {}
            Life::Flying(_) => self.watch_flight(now),
            Life::Landing { since, .. } => self.watch_landing(now, *since),
        }
    }

    fn watch_preparation(
        &mut self,
        now: Duration,
        stage: Preparation,
        departure: Option<Departure>,
    ) {
        let lasts = |since, time| now.saturating_sub(since) >= time;
        let takes_over = self.life.takes_over();
        match stage {
            Preparation::Connecting => {
                if departure.is_some_and(|departure| lasts(departure.ordered, CONNECT_TIMEOUT)) {
                    self.end(now, Outcome::NoDrone);
                }
            }
            Preparation::Observing(watched) if departure.is_some() => {
                if lasts(watched.since, SETTLE_TIME) {
                    self.take_over_or_refuse(now, self.packets_hz(now, watched));
                }
            }
            // Another client has landed the drone, and may have changed its settings.
            Preparation::Observing(_) => {
                if self.on_ground() && self.navdata.is_some() {
                    self.request(now, session::Request::AllSettings);
                    self.begin_to_configure(now);
                }
            }
            // Another pilot has taken off with the drone while it was being prepared.
            _ if !takes_over && !self.is_down(now) => {
                if departure.is_some() {
                    self.refuse(now, vec![NotReady::NotLanded.to_string()]);
                } else {
                    self.observe_again(now);
                }
            }
            Preparation::Configuring { since } => {
                if departure.is_some() && lasts(since, CONFIGURE_TIMEOUT) {
                    let reason = "the drone does not take its configuration".to_owned();
                    self.refuse(now, vec![reason]);
                }
            }
            Preparation::Trimming(watched) if lasts(watched.since, SETTLE_TIME) => {
                match departure {
                    Some(Departure { ordered, .. }) => {
                        let is_seen = lasts(watched.since.max(ordered), self.settle_time());
                        // Drones do not answer at the same moment, and others fly away.
                        let waits = || {
                            let mut problems = self.problems_of_the_room(now);
                            problems.next().is_some() && !lasts(ordered, ROOM_TIMEOUT)
                        };
                        if is_seen && !waits() {
                            self.take_off_or_refuse(now, self.packets_hz(now, watched));
                        }
                    }
                    None => self.life.enter(Life::Standby { since: now, has_flown: false }),
                }
            }
            Preparation::Trimming(_) => {}
        }
    }

    /// Navdata packets per second since the drone is monitored.
    fn packets_hz(&self, now: Duration, watched: Watched) -> f64 {
        let packets = self.session.statistics().received.saturating_sub(watched.received);
        packets as f64 / now.saturating_sub(watched.since).as_secs_f64()
    }

    /// Handles a drone that took off while standing by: it follows an old order of ours, or another pilot flies it.
    fn has_risen(&mut self, is_ours: bool, now: Duration) {
        if is_ours {
            self.agent_lands();
            self.life.enter(Life::Landing { since: now, why: Why::StillUp });
        } else {
            self.observe_again(now);
        }
    }

    /// Pre-empting goals are always accepted, and obeyed in the next step.
    fn agent_lands(&mut self) {
        let accepted = self.flight.agent.achieve_land();
        debug_assert!(accepted);
    }

    /// Another pilot flies the drone: stop sending until it stands on the ground.
    fn observe_again(&mut self, now: Duration) {
        self.events.push_back(FlightEvent::FlownByAnother);
        self.life.prepare(Preparation::Observing(self.watched_from(now)));
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
        if let Some(active) = self.life.due()
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

    /// Whether the drone has said for [`FAULT_TIME`] that it has cut its motors, and does not fly.
    fn has_cut(&self, now: Duration) -> bool {
        self.flight.emergency.has_lasted(now, FAULT_TIME) && self.says_on_ground()
    }

    /// Whether the drone does not fly, by what was heard last: it is on the ground, or its motors are off.
    fn is_down(&self, now: Duration) -> bool {
        self.on_ground() || self.has_cut(now)
    }

    /// Whether there is nothing left of the flight: whatever ends with it asks here.
    fn is_over(&self, now: Duration) -> bool {
        // A take-off ordered just before a landing may not have taken effect in what was heard last.
        let heard_later = match &self.life {
            Life::Landing { since, .. } => {
                self.packet_at.is_some_and(|at| at >= *since + ON_ITS_WAY)
            }
            _ => true,
        };
        // A restarted drone sends its state before it sends flight data.
        let is_known = self.session.is_alive() && self.demo().is_some();
        is_known && (self.has_cut(now) || self.on_ground() && heard_later)
    }

    /// The flight's time begins with the take-off that lifts the drone, even if that is never ended, stops once the flight is
    /// over, and goes on if the mission takes off again.
    fn watch_flight_time(&mut self, now: Duration) {
        if let Life::Flying(Flying { due: Some(active), .. }) = &self.life
            && active.due.order == AgentOrder::TakeOff
            && !self.on_ground()
        {
            let ordered_at = active.since;
            self.flight.report_mut().took_off_at.get_or_insert(ordered_at);
        }
        if !self.life.is_in_flight() || self.flight.report().took_off_at.is_none() {
            return;
        }
        let ended_at = match self.flight.report().ended_at {
            None if self.is_over(now) => Some(now),
            Some(_) if !self.is_down(now) => None,
            _ => return,
        };
        self.flight.report_mut().ended_at = ended_at;
    }

    /// Whether the drone has landed by itself: the agent hears of it only if it had an order to carry out.
    fn has_come_down(&mut self, now: Duration) -> bool {
        let (on_ground, lands) = (self.on_ground(), self.lands());
        let Life::Flying(flying) = &mut self.life else { return false };
        flying.has_flown |= !on_ground;
        let down = flying.has_risen && on_ground && !lands;
        // Where it was landed it stands until it rises again, which a plan may order.
        flying.has_risen = !on_ground || down;
        self.flight.down.lasts(now, down, FAULT_TIME)
    }

    /// Refuses the flight. A drone that was taken over in the air is landed; otherwise nothing is sent to a
    /// drone in the air.
    pub(super) fn refuse(&mut self, now: Duration, reasons: Vec<String>) {
        if self.life.takes_over() && !self.on_ground() {
            self.agent_lands();
            self.give_up(now, Why::TakeOverRefused(reasons));
            return;
        }
        if !self.on_ground() {
            self.life.prepare(Preparation::Observing(self.watched_from(now)));
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
            Danger::NoProgress if self.life.manual().sends() => LandingReason::ManualTargetTimedOut,
            Danger::NoProgress if self.flight.veto == Some(Veto::KeepsApart) => {
                LandingReason::Safety(Veto::KeepsApart)
            }
            Danger::NoProgress => LandingReason::StepTimedOut {
                step: self.life.due().map_or(0, |active| active.due.step),
            },
        };
        self.give_up(now, Why::GivenUp(reason));
    }

    fn watch_landing(&mut self, now: Duration, since: Duration) {
        let elapsed = now.saturating_sub(since);
        let blind = !self.session.is_alive();
        let landed = self.is_over(now);
        let awaited = !(blind && elapsed >= BLIND_LANDING_TIME || elapsed >= LANDING_TIMEOUT);
        if !landed && (self.flight.outcome.is_some() || awaited) {
            return;
        }
        let outcome = match &self.life {
            _ if blind => Outcome::LinkLost,
            Life::Landing { why: Why::GivenUp(reason), .. } => match reason {
                LandingReason::Operator if landed => Outcome::Interrupted,
                LandingReason::Operator => Outcome::LeftLanding,
                LandingReason::LinkLost => Outcome::LinkLost,
                reason if landed => Outcome::Failsafe { reason: reason.to_string() },
                reason => Outcome::Failsafe { reason: format!("{reason}; {NOT_CONFIRMED}") },
            },
            Life::Landing { why: Why::Replaced { .. }, .. } if !landed => {
                Outcome::Failsafe { reason: NOT_CONFIRMED.to_owned() }
            }
            Life::Landing { why: Why::Replaced { step }, .. } => {
                if self.flight.outcome.is_none() {
                    self.flight.report_mut().steps_done = step + 1;
                }
                Outcome::Completed
            }
            Life::Landing { why: Why::TakeOverRefused(reasons), .. } => {
                Outcome::PreflightRefused { reasons: reasons.clone() }
            }
            _ => Outcome::Completed,
        };
        self.end(now, outcome);
    }

    /// Gives up the mission and lands. The first reason is kept. On the ground the flight ends at once.
    pub(super) fn land(&mut self, now: Duration, reason: LandingReason) {
        match &self.life {
            Life::Standby { .. } | Life::Landing { .. } => return,
            Life::Preparing { stage, departure } => match stage {
                _ if departure.is_none() => return,
                Preparation::Observing(_) => {
                    self.refuse(now, vec![NotReady::NotLanded.to_string()]);
                    return;
                }
                stage if *stage == Preparation::Connecting || self.on_ground() => {
                    self.end(now, Outcome::CalledOff);
                    return;
                }
                _ => {}
            },
            Life::Flying(_) => {}
        }
        self.agent_lands();
        self.give_up(now, Why::GivenUp(reason));
    }

    /// Marks the mission as given up; the agent lands. The first reason is kept.
    pub(super) fn give_up(&mut self, now: Duration, why: Why) {
        if matches!(self.life, Life::Landing { .. }) {
            return;
        }
        if let Some(reason) = why.reason() {
            self.events.push_back(FlightEvent::LandingOrdered(reason));
        }
        self.life.enter(Life::Landing { since: now, why });
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
        let is_over = self.is_over(now);
        let is_ready = is_over && self.session.is_ready();
        let standby = |has_flown| Life::Standby { since: now, has_flown };
        let next = match self.life {
            Life::Preparing { stage: Preparation::Trimming(_), .. } if is_ready => standby(false),
            Life::Preparing { stage, .. } => Life::Preparing { stage, departure: None },
            Life::Flying(_) | Life::Landing { .. } if is_ready => standby(true),
            Life::Flying(_) | Life::Landing { .. } if is_over => {
                let stage = Preparation::Configuring { since: now };
                Life::Preparing { stage, departure: None }
            }
            Life::Flying(_) => {
                self.agent_lands();
                Life::Landing { since: now, why: Why::StillUp }
            }
            Life::Landing { .. } | Life::Standby { .. } => return,
        };
        self.life.enter(next);
    }

    /// Starts sending to the drone.
    pub(super) fn begin_to_configure(&mut self, now: Duration) {
        self.flight.asked_at = now;
        self.configured = Configured::default();
        self.life.prepare(Preparation::Configuring { since: now });
    }
}
