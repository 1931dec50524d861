//! How far a flight is, and the mission in it.

use autopilot::vehicle::Phase;

use super::super::modes::Mode;
use super::View;
use crate::dialect::{MISSION_CURRENT_DATA, MavLandedState, MissionState};

impl View<'_> {
    pub(super) fn landed(&self) -> MavLandedState {
        match (self.status.phase, self.vehicle.mode()) {
            (Phase::Connecting, _) => MavLandedState::MAV_LANDED_STATE_UNDEFINED,
            _ if !self.status.airborne && self.status.command != Some("TakeOff") => {
                MavLandedState::MAV_LANDED_STATE_ON_GROUND
            }
            _ if self.status.command == Some("TakeOff") => MavLandedState::MAV_LANDED_STATE_TAKEOFF,
            (_, Mode::Land) => MavLandedState::MAV_LANDED_STATE_LANDING,
            _ => MavLandedState::MAV_LANDED_STATE_IN_AIR,
        }
    }

    pub(super) fn mission(&self) -> MISSION_CURRENT_DATA {
        let vehicle = self.vehicle;
        let total = vehicle.transfer.items().len();
        let flown = vehicle.flown.is_stored(vehicle.transfer.id());
        // Between two steps, and while it is paused there, it is the one before.
        let step = vehicle.flown.item().filter(|_| flown);
        let complete = flown && vehicle.flown.is_complete();
        let last = u16::try_from(total.saturating_sub(1)).unwrap_or_default();
        let state = if total == 0 {
            MissionState::MISSION_STATE_NO_MISSION
        } else if complete {
            MissionState::MISSION_STATE_COMPLETE
        } else if !flown || !vehicle.is_flying() {
            MissionState::MISSION_STATE_NOT_STARTED
        } else if self.status.mission_waits {
            MissionState::MISSION_STATE_PAUSED
        } else {
            MissionState::MISSION_STATE_ACTIVE
        };
        let seq = match (step, complete) {
            (Some(item), _) => item,
            (None, true) => last,
            (None, false) => vehicle.flown.first_item(),
        };
        MISSION_CURRENT_DATA {
            seq,
            total: if total == 0 { u16::MAX } else { u16::try_from(total).unwrap_or(u16::MAX) },
            mission_state: state,
            // Not known.
            mission_mode: 0,
            mission_id: vehicle.transfer.id(),
            ..MISSION_CURRENT_DATA::default()
        }
    }
}
