//! The pilot's hand: hold, fly by stick, go on, land, cut.

use std::time::Duration;

use pid::Demand;

use super::{FlightEvent, FlightPhase, LandingReason, Pilot};

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
}

impl Hand {
    /// What the sticks say now.
    pub(super) fn sticks(&self, now: Duration) -> Option<Demand> {
        self.sticks.filter(|(_, since)| now.saturating_sub(*since) < STICK_TIME).map(|(d, _)| d)
    }
}

impl Pilot {
    /// The person at the controls wants something.
    pub fn order(&mut self, now: Duration, order: PilotOrder) {
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
                self.hand.sticks = None;
                // Pre-empting: always accepted.
                let accepted = self.agent.achieve_hold();
                debug_assert!(accepted);
            }
            PilotOrder::Steer(demand) => {
                if self.hand.sticks(now).is_none() {
                    self.take_in_hand(FlightEvent::Steered);
                    let accepted = self.agent.achieve_steer();
                    debug_assert!(accepted);
                }
                self.hand.sticks = Some((demand, now));
            }
            PilotOrder::Resume => {
                if self.hand.holds_plan {
                    self.hand = Hand::default();
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

    fn take_in_hand(&mut self, event: FlightEvent) {
        if !self.hand.holds_plan || event == FlightEvent::Steered {
            self.events.push_back(event);
        }
        self.hand.holds_plan = true;
    }
}
