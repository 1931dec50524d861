//! Other vehicles: what this one tells them, and what it hears of them.

use std::time::Duration;

use estimator::{Prediction, Start};

use super::{FAULT_TIME, Phase, Refused, SETTLE_TIME, Vehicle};
use crate::agent::AgentCommand;
use crate::safety::{Situation, Veto};
use crate::separation::{Neighbour, NotHeard, Oneself, Presence};

/// So long before it takes off a vehicle tells the others that it will.
const TELLS_TIME: Duration = Duration::from_secs(1);

impl Vehicle {
    /// Another vehicle tells of itself.
    pub(super) fn hear(&mut self, neighbour: Neighbour) -> Result<(), Refused> {
        if neighbour.system == self.config.system {
            return Err(NotHeard::Oneself.into());
        }
        Ok(self.neighbours.hear(neighbour)?)
    }

    /// What the others need to know of this vehicle, as it was measured last: where a drone that is not heard has got to since
    /// nobody knows, this vehicle no better than the others. `None` until it is heard.
    pub fn as_neighbour(&self, now: Duration) -> Option<Neighbour> {
        self.session.silence(now)?;
        let estimate = self.flight.estimator.estimate();
        Some(Neighbour {
            system: self.config.system,
            at: estimate.at,
            place_m: estimate.position_m.xy(),
            velocity_m_s: estimate.velocity_m_s.xy(),
            uncertainty_m: self.flight.estimator.uncertainty_m(estimate.at),
            separation_m: self.config.separation_m,
            presence: self.presence(now),
            claim: self.flight.safety.claim(),
        })
    }

    /// Whether it is in the air: not with its motors cut, as it falls then and lies there. While it is prepared for a flight it is
    /// about to be, so that the others have heard it when it lifts.
    fn presence(&self, now: Duration) -> Presence {
        let is_prepared = self.life.phase() == Phase::Trimming && self.life.departure().is_some();
        if self.flight.emergency.has_lasted(now, FAULT_TIME) {
            Presence::Stands
        } else if !self.on_ground() {
            Presence::Flies
        } else if is_prepared || self.life.phase() == Phase::Flying {
            Presence::Starts
        } else {
            Presence::Stands
        }
    }

    /// How long a drone is watched on the ground before it is flown: where there are others, until they have heard of it.
    pub(super) fn settle_time(&self) -> Duration {
        let is_alone = self.config.peers.is_empty() && self.neighbours.is_empty();
        if is_alone { SETTLE_TIME } else { TELLS_TIME }
    }

    /// In a common frame the next flight starts where the last one ended, and as exactly as that is known.
    pub(super) fn start_here(&mut self, now: Duration) {
        let state = self.state(now);
        let estimator = &self.flight.estimator;
        if let Some(start) = &mut self.config.estimator.start {
            *start = Start {
                place_m: state.position_m.xy(),
                heading_deg: state.yaw_deg,
                uncertainty_m: estimator.uncertainty_m(now),
                heading_uncertainty_deg: estimator.heading_uncertainty_deg(),
            };
        }
    }

    /// This vehicle among the others.
    pub(super) fn oneself(&self, now: Duration, state: &Prediction) -> Oneself {
        Oneself {
            system: self.config.system,
            rank: self.flight.safety.claim().map(|claim| claim.rank),
            place_m: state.position_m.xy(),
            velocity_m_s: state.velocity_m_s.xy(),
            uncertainty_m: self.flight.estimator.uncertainty_m(now),
            separation_m: self.config.separation_m,
        }
    }

    /// A command that the safety monitor has left, kept apart from other vehicles.
    pub(super) fn kept_apart(
        &mut self,
        now: Duration,
        command: AgentCommand,
        state: &Prediction,
        situation: &Situation,
    ) -> (AgentCommand, Option<Veto>) {
        let oneself = self.oneself(now, state);
        // Also where a plan takes off again: who is near may have come since the first time.
        let must_stay = command == AgentCommand::TakeOff
            && self.on_ground()
            && self.neighbours.too_near(now, oneself).next().is_some();
        let command = if must_stay { AgentCommand::Standby } else { command };
        let others = self.neighbours.others(now, &oneself);
        let limits = self.course_limits();
        let (command, veto) =
            self.flight.safety.keep_apart(command, situation, &others, &limits, self.config.system);
        (command, veto.or(must_stay.then_some(Veto::KeepsApart)))
    }
}
