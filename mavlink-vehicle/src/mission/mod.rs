//! Missions: their items, what they mean in our plan language, and how they travel.

mod item;
mod program;
mod transfer;
mod translate;

pub use item::{Item, command};
pub(crate) use program::TAKE_OFF;
pub use program::{Step, Translated};
pub use transfer::{Event, Handled, Message, Outgoing, Outgoings, Partner, Received, Transfer};
pub use translate::{MAX_ITEMS, Problem, Rules, translate};
pub(crate) use translate::{SHORT_STAY_S, short, short_pose};

/// Results of `MISSION_ACK` (`MAV_MISSION_RESULT`).
pub mod result {
    /// Done.
    pub const ACCEPTED: u8 = 0;
    /// The frame is not supported.
    pub const UNSUPPORTED_FRAME: u8 = 2;
    /// The command or the kind of mission is not supported.
    pub const UNSUPPORTED: u8 = 3;
    /// Too many items.
    pub const NO_SPACE: u8 = 4;
    /// `param1`.
    pub const INVALID_PARAM1: u8 = 6;
    /// `param2`.
    pub const INVALID_PARAM2: u8 = 7;
    /// `param3`.
    pub const INVALID_PARAM3: u8 = 8;
    /// `param4`.
    pub const INVALID_PARAM4: u8 = 9;
    /// `x`.
    pub const INVALID_PARAM5_X: u8 = 10;
    /// `y`.
    pub const INVALID_PARAM6_Y: u8 = 11;
    /// `z`.
    pub const INVALID_PARAM7: u8 = 12;
    /// Another item was wanted.
    pub const INVALID_SEQUENCE: u8 = 13;
    /// Not now, or not from this sender.
    pub const DENIED: u8 = 14;
    /// The transfer was given up.
    pub const OPERATION_CANCELLED: u8 = 15;
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
