//! The commands that mean something here.

use crate::dialect::MavCmd;

/// A `MAV_CMD`, to be matched by number: unknown ones are answered, too.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MavCmdNumber(pub(super) u16);

macro_rules! commands {
    ($($name:ident = $command:expr),* $(,)?) => {
        impl MavCmdNumber {
            $(pub(super) const $name: Self = Self($command as u16);)*
            const ALL: &[Self] = &[$(Self::$name),*];
        }
    };
}

commands! {
    NAV_RETURN_TO_LAUNCH = MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH,
    NAV_LAND = MavCmd::MAV_CMD_NAV_LAND,
    NAV_TAKEOFF = MavCmd::MAV_CMD_NAV_TAKEOFF,
    NAV_LAND_LOCAL = 23,
    NAV_TAKEOFF_LOCAL = 24,
    DO_SET_MODE = MavCmd::MAV_CMD_DO_SET_MODE,
    DO_SET_HOME = MavCmd::MAV_CMD_DO_SET_HOME,
    DO_FLIGHTTERMINATION = MavCmd::MAV_CMD_DO_FLIGHTTERMINATION,
    // What MAVProxy sends for `land`.
    DO_LAND_START = 189,
    DO_REPOSITION = MavCmd::MAV_CMD_DO_REPOSITION,
    DO_PAUSE_CONTINUE = MavCmd::MAV_CMD_DO_PAUSE_CONTINUE,
    DO_SET_MISSION_CURRENT = MavCmd::MAV_CMD_DO_SET_MISSION_CURRENT,
    PREFLIGHT_REBOOT_SHUTDOWN = MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN,
    DO_SET_STANDARD_MODE = MavCmd::MAV_CMD_DO_SET_STANDARD_MODE,
    MISSION_START = MavCmd::MAV_CMD_MISSION_START,
    COMPONENT_ARM_DISARM = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
    RUN_PREARM_CHECKS = MavCmd::MAV_CMD_RUN_PREARM_CHECKS,
    GET_HOME_POSITION = MavCmd::MAV_CMD_GET_HOME_POSITION,
    GET_MESSAGE_INTERVAL = MavCmd::MAV_CMD_GET_MESSAGE_INTERVAL,
    SET_MESSAGE_INTERVAL = MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL,
    REQUEST_MESSAGE = MavCmd::MAV_CMD_REQUEST_MESSAGE,
    REQUEST_PROTOCOL_VERSION = MavCmd::MAV_CMD_REQUEST_PROTOCOL_VERSION,
    REQUEST_AUTOPILOT_CAPABILITIES = MavCmd::MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES,
}

/// Whether the command means something here.
pub(super) fn is_known(command: u16) -> bool {
    MavCmdNumber::ALL.contains(&MavCmdNumber(command))
}
