//! The pilot's hand: hold, fly by stick, fly to a place, go on, land, cut.

use std::time::Duration;

use pid::{Demand, Pose};

use super::{FlightEvent, FlightPhase, LandingReason, Pilot};
use crate::agent::Report;
use crate::safety::INSIDE_M;

/// What the person at the controls wants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PilotOrder {
    /// Stay where the drone is; the plan waits.
    Hold,
    /// Go on with the plan.
    Resume,
    /// Fly so, for a moment: it is said again as long as a key is pressed. Stick fractions with the
    /// drone's signs.
    Steer(Demand),
    /// Fly to this place and stay there, as high and looking the same way as before; the plan waits.
    /// A place at or outside the fence becomes the nearest one inside. In the estimator's frame.
    GoTo {
        /// To the right of the start, as the drone stood there.
        x_m: f64,
        /// Before the start.
        y_m: f64,
    },
    /// Land. The plan is given up.
    Land,
    /// Cut the motors now. The drone falls.
    Cut,
}

/// A stick that is not moved again for so long is let go: keys that are held repeat faster.
const STICK_TIME: Duration = Duration::from_millis(600);

/// What the hand does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Hand {
    /// The plan waits.
    pub(super) holds_plan: bool,
    sticks: Option<(Demand, Duration)>,
    /// Where the drone is sent, and whether the agent has been told.
    target: Option<(Pose, bool)>,
    /// What the next step of the agent serves before anything else. What it is told beside that would
    /// outlast an order that comes after.
    pub(super) pre_empts: bool,
}

impl Hand {
    /// What the sticks say now.
    pub(super) fn sticks(&self, now: Duration) -> Option<Demand> {
        self.sticks.filter(|(_, since)| now.saturating_sub(*since) < STICK_TIME).map(|(d, _)| d)
    }

    /// Whether the drone is sent somewhere.
    pub(super) fn sends(&self) -> bool {
        self.target.is_some()
    }
}

impl Pilot {
    /// The person at the controls wants something.
    pub(super) fn order(&mut self, now: Duration, order: PilotOrder) {
        match order {
            PilotOrder::Land => {
                self.guard.land_here();
                self.land(now, LandingReason::Pilot);
            }
            PilotOrder::Cut => {
                self.events.push_back(FlightEvent::CutOrdered);
                self.session.request_emergency_stop();
            }
            // Whoever lands is not held up; on the ground there is nothing to hold.
            _ if self.phase != FlightPhase::Flying || self.on_ground() => {}
            PilotOrder::Hold => {
                self.take_in_hand(FlightEvent::Held);
                self.hold();
            }
            PilotOrder::Steer(demand) => {
                if self.hand.sticks(now).is_none() {
                    self.take_in_hand(FlightEvent::Steered);
                    self.hand.target = None;
                    self.hand.pre_empts = true;
                    // Pre-empting: always accepted.
                    let accepted = self.agent.achieve_steer();
                    debug_assert!(accepted);
                }
                self.hand.sticks = Some((demand, now));
            }
            PilotOrder::GoTo { x_m, y_m } if x_m.is_finite() && y_m.is_finite() => {
                let wanted = Pose { x_m, y_m, ..self.target.unwrap_or_else(|| self.pose(now)) };
                self.take_in_hand(FlightEvent::SentByHand);
                self.hold();
                self.hand.target = Some((self.mission.inside(&wanted, INSIDE_M), false));
            }
            // No place.
            PilotOrder::GoTo { .. } => {}
            PilotOrder::Resume => {
                if self.hand.holds_plan {
                    // What the agent does for the hand ends unreported: its end is not the plan's.
                    self.hold();
                    self.hand = Hand { pre_empts: self.hand.pre_empts, ..Hand::default() };
                    self.events.push_back(FlightEvent::Resumed);
                    // What the agent was told was pre-empted.
                    if let Some(active) = &mut self.due {
                        active.offered = false;
                        active.since = now;
                    }
                }
            }
        }
    }

    fn hold(&mut self) {
        self.hand.sticks = None;
        self.hand.target = None;
        self.hand.pre_empts = true;
        // Pre-empting: always accepted.
        let accepted = self.agent.achieve_hold();
        debug_assert!(accepted);
    }

    /// Tells the agent where the drone is sent, once it holds.
    pub(super) fn offer_hand_target(&mut self) {
        if let Some((pose, offered @ false)) = &mut self.hand.target {
            *offered = self.agent.achieve_go_to(pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg);
        }
    }

    /// The agent has reported how what it was told by hand ended.
    pub(super) fn hand_target_ended(&mut self, report: Report) {
        let told = self.hand.target.take_if(|(_, offered)| *offered);
        // It only fails on the ground, which is noticed by others.
        if told.is_some() && report == Report::Done {
            self.events.push_back(FlightEvent::HandTargetReached);
        }
    }

    fn take_in_hand(&mut self, event: FlightEvent) {
        if !self.hand.holds_plan || event != FlightEvent::Held {
            self.events.push_back(event);
        }
        self.hand.holds_plan = true;
    }
}
