//! Missions: their items, what they mean in our plan language, and how they travel.

mod fence;
#[allow(deprecated, reason = "clients of all ages are answered")]
mod item;
mod program;
mod transfer;
mod translate;

pub(crate) use fence::FENCE;
pub(crate) use item::{Item, command};
pub(crate) use program::TAKE_OFF;
pub(crate) use program::{Step, Translated};
pub(crate) use transfer::{Event, Handled, Message, Partner, Received, Transfer};
pub(crate) use translate::{MAX_ITEMS, Problem, Rules, translate};
pub(crate) use translate::{SHORT_STAY_S, short, short_pose};

/// Results of `MISSION_ACK`.
pub(crate) mod result {
    pub(crate) use crate::dialect::MavMissionResult::{
        MAV_MISSION_ACCEPTED as ACCEPTED, MAV_MISSION_DENIED as DENIED,
        MAV_MISSION_INVALID_PARAM1 as INVALID_PARAM1, MAV_MISSION_INVALID_PARAM2 as INVALID_PARAM2,
        MAV_MISSION_INVALID_PARAM3 as INVALID_PARAM3, MAV_MISSION_INVALID_PARAM4 as INVALID_PARAM4,
        MAV_MISSION_INVALID_PARAM5_X as INVALID_PARAM5_X,
        MAV_MISSION_INVALID_PARAM6_Y as INVALID_PARAM6_Y,
        MAV_MISSION_INVALID_PARAM7 as INVALID_PARAM7,
        MAV_MISSION_INVALID_SEQUENCE as INVALID_SEQUENCE, MAV_MISSION_NO_SPACE as NO_SPACE,
        MAV_MISSION_OPERATION_CANCELLED as OPERATION_CANCELLED,
        MAV_MISSION_UNSUPPORTED as UNSUPPORTED, MAV_MISSION_UNSUPPORTED_FRAME as UNSUPPORTED_FRAME,
    };
}

#[cfg(test)]
mod tests {
    use autopilot::plan::{Commands, MissionId};

    use super::{Item, Step};

    /// Steps as logs hold them; empty without any.
    pub(super) fn written(steps: &[Step]) -> String {
        let commands = steps.iter().map(|step| step.command);
        let commands = Commands::new("test", MissionId(0), false, commands);
        if steps.is_empty() { String::new() } else { commands.unwrap().text().to_owned() }
    }

    /// An item without parameters.
    pub(super) fn item(seq: u16, frame: u8, command: u16) -> Item {
        Item {
            seq,
            frame,
            command,
            current: 0,
            autocontinue: 1,
            param1: 0.0,
            param2: 0.0,
            param3: 0.0,
            param4: f32::NAN,
            x: 0,
            y: 0,
            z: 0.0,
            mission_type: 0,
        }
    }
}
