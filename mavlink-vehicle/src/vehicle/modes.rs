//! Flight modes in PX4's numbering, which clients take for that of every vehicle but `ArduPilot`'s.

use autopilot::vehicle::{ManualControl, Phase, Status};

use crate::dialect::MavStandardMode;

/// A flight mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Mode {
    /// Hold the place; on the ground, wait.
    Hold,
    /// Take off.
    TakeOff,
    /// Fly the mission.
    Mission,
    /// Land.
    Land,
    /// Fly to the start and land.
    Return,
    /// Follow setpoints.
    Offboard,
    /// Fly by hand: `MANUAL_CONTROL`.
    Position,
}

impl Mode {
    /// In the order of `AVAILABLE_MODES`.
    pub(crate) const ALL: [Self; 7] = [
        Self::Hold,
        Self::TakeOff,
        Self::Mission,
        Self::Land,
        Self::Return,
        Self::Offboard,
        Self::Position,
    ];

    /// Main mode and sub-mode, in PX4's `custom_mode`.
    fn parts(self) -> (u8, u8) {
        match self {
            Self::Position => (3, 0),
            Self::TakeOff => (4, 2),
            Self::Hold => (4, 3),
            Self::Mission => (4, 4),
            Self::Return => (4, 5),
            Self::Land => (4, 6),
            Self::Offboard => (6, 0),
        }
    }

    /// PX4's `custom_mode`.
    pub(crate) fn custom(self) -> u32 {
        let (main, sub) = self.parts();
        of_parts(main, sub)
    }

    /// The mode of a `custom_mode`.
    pub(crate) fn from_custom(custom: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|mode| mode.custom() == custom)
    }

    /// Its place among the standard modes.
    pub(crate) fn standard(self) -> MavStandardMode {
        match self {
            Self::Hold | Self::Offboard => MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD,
            Self::Position => MavStandardMode::MAV_STANDARD_MODE_POSITION_HOLD,
            Self::Return => MavStandardMode::MAV_STANDARD_MODE_SAFE_RECOVERY,
            Self::Mission => MavStandardMode::MAV_STANDARD_MODE_MISSION,
            Self::Land => MavStandardMode::MAV_STANDARD_MODE_LAND,
            Self::TakeOff => MavStandardMode::MAV_STANDARD_MODE_TAKEOFF,
        }
    }

    /// The mode of a standard mode's number.
    pub(crate) fn from_standard(number: u8) -> Option<Self> {
        let standard = |mode: &Self| mode.standard() as u8;
        Self::ALL.into_iter().find(|mode| number != 0 && standard(mode) == number)
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Hold => "Hold",
            Self::TakeOff => "Takeoff",
            Self::Mission => "Mission",
            Self::Land => "Land",
            Self::Return => "Return",
            Self::Offboard => "Offboard",
            Self::Position => "Position",
        }
    }

    /// Whether the vehicle flies by itself in it.
    pub(crate) fn is_automatic(self) -> bool {
        !matches!(self, Self::Position | Self::Offboard)
    }
}

/// PX4's `custom_mode` of a main mode and a sub-mode.
pub(crate) fn of_parts(main: u8, sub: u8) -> u32 {
    u32::from(main) << 16 | u32::from(sub) << 24
}

/// The names of all modes of this vehicle.
pub(crate) fn names() -> [&'static str; Mode::ALL.len()] {
    Mode::ALL.map(Mode::name)
}

/// The name in QGroundControl of a mode of PX4's that this vehicle does not have.
pub(crate) fn name_of_px4(custom: u32) -> Option<&'static str> {
    let [_, _, main, sub] = custom.to_le_bytes();
    Some(match (main, sub) {
        (1, _) => "Manual",
        (2, _) => "Altitude",
        (3, 1) => "Orbit",
        (4, 1) => "Ready",
        (4, 8) => "Follow Me",
        (4, 9) => "Precision Land",
        (5, _) => "Acro",
        (7, _) => "Stabilized",
        (8, _) => "Rattitude",
        (9, _) => "Simple",
        _ => return None,
    })
}

/// What the mission that the vehicle flies was made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// A mission or plan.
    Mission,
    /// A take-off.
    TakeOff,
    /// A return to the start.
    Return,
}

/// What the vehicle's status does not say.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Doing {
    /// Of the mission that it has.
    pub(crate) purpose: Purpose,
    /// Its setpoints are those of sticks.
    pub(crate) by_hand: bool,
    /// Its mission is not at its end, even if it is between two steps.
    pub(crate) goes_on: bool,
    /// The mode of what waits on the ground until it is armed, or has just been ordered there.
    pub(crate) begins: Option<Mode>,
}

/// The mode of a vehicle.
pub(crate) fn mode(status: &Status, doing: Doing) -> Mode {
    match status.phase {
        Phase::Landing => return Mode::Land,
        Phase::Flying => {}
        // QGroundControl arms only once it sees the mode that it has set.
        _ => return doing.begins.unwrap_or(Mode::Hold),
    }
    match status.manual {
        Some(ManualControl::Sticks) => return Mode::Position,
        Some(ManualControl::Setpoints) if doing.by_hand => return Mode::Position,
        Some(ManualControl::Setpoints) => return Mode::Offboard,
        Some(ManualControl::Hold | ManualControl::Target) => return Mode::Hold,
        None => {}
    }
    match status.command {
        // The landing belongs to the return, as the take-off to the mission: QGroundControl would else offer to go on with it.
        Some("Land") if doing.purpose == Purpose::Return => Mode::Return,
        Some("Land") => Mode::Land,
        Some("TakeOff") if doing.purpose == Purpose::Mission && doing.goes_on => Mode::Mission,
        Some("TakeOff") => Mode::TakeOff,
        _ if status.step.is_none() && !doing.goes_on => Mode::Hold,
        _ => match doing.purpose {
            Purpose::Mission => Mode::Mission,
            Purpose::TakeOff => Mode::TakeOff,
            Purpose::Return => Mode::Return,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// PX4's documentation of its flight modes.
    #[test]
    fn modes_have_px4s_numbers() {
        let numbers = Mode::ALL.map(|mode| (mode.name(), mode.custom()));
        let expected = [
            ("Hold", 0x0304_0000),
            ("Takeoff", 0x0204_0000),
            ("Mission", 0x0404_0000),
            ("Land", 0x0604_0000),
            ("Return", 0x0504_0000),
            ("Offboard", 0x0006_0000),
            ("Position", 0x0003_0000),
        ];
        assert_eq!(numbers, expected);
        for mode in Mode::ALL {
            assert_eq!(Mode::from_custom(mode.custom()), Some(mode));
        }
        assert_eq!(Mode::from_standard(7), Some(Mode::Land));
        assert_eq!(Mode::from_standard(0), None);
    }

    /// Those of `ArduCopter`, and PX4's that this vehicle does not have.
    #[test]
    fn other_numbers_are_no_mode() {
        for (main, sub) in [(4, 0), (4, 1), (5, 0), (9, 0), (0, 0), (1, 0), (6, 1)] {
            assert_eq!(Mode::from_custom(of_parts(main, sub)), None, "{main} {sub}");
        }
    }
}
