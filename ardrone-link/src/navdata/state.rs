//! The state word and the control state.

use bitflags::bitflags;

bitflags! {
    /// The 32 state bits at the head of every navdata packet: `def_ardrone_state_mask_t` of Parrot's SDK 2.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct DroneState: u32 {
        /// The drone is in the air.
        const FLYING = 1 << 0;
        /// The video stream is enabled.
        const VIDEO = 1 << 1;
        /// The vision system is enabled.
        const VISION = 1 << 2;
        /// Altitude control is active.
        const ALTITUDE_CONTROL = 1 << 4;
        /// A configuration command was received and not yet cleared.
        const COMMAND_ACKNOWLEDGE = 1 << 6;
        /// The camera is ready.
        const CAMERA_READY = 1 << 7;
        /// Only the demo set of options is sent.
        const NAVDATA_DEMO = 1 << 10;
        /// No options are sent until the drone is configured.
        const NAVDATA_BOOTSTRAP = 1 << 11;
        /// A motor is broken or blocked.
        const MOTORS_PROBLEM = 1 << 12;
        /// The drone has not received commands for two seconds.
        const COMMUNICATION_LOST = 1 << 13;
        /// The firmware has detected an internal fault.
        const SOFTWARE_FAULT = 1 << 14;
        /// The battery is too low to fly: the drone will soon land by itself.
        const BATTERY_LOW = 1 << 15;
        /// A client's emergency bit stopped the motors.
        const USER_EMERGENCY = 1 << 16;
        /// The attitude left the range in which the drone can fly.
        const ANGLES_OUT_OF_RANGE = 1 << 19;
        /// The wind is too strong.
        const TOO_MUCH_WIND = 1 << 20;
        /// The ultrasound sensor receives no echo.
        const ULTRASOUND_DEAF = 1 << 21;
        /// A motor was cut out.
        const CUTOUT_DETECTED = 1 << 22;
        /// The version of the motor controller is compatible.
        const PIC_VERSION_OK = 1 << 23;
        /// The thread that reads AT commands runs.
        const AT_THREAD = 1 << 24;
        /// The navdata thread runs.
        const NAVDATA_THREAD = 1 << 25;
        /// The video thread runs.
        const VIDEO_THREAD = 1 << 26;
        /// The acquisition thread runs.
        const ACQUISITION_THREAD = 1 << 27;
        /// The drone has not received commands for 50 ms.
        const COMMUNICATION_WATCHDOG = 1 << 30;
        /// Emergency: the motors are cut.
        const EMERGENCY = 1 << 31;

        // The drone sets bits without a name here, which must survive a round trip.
        const _ = !0;
    }
}

/// The major control state: the high half of the demo option's first word (SDK 2, `control_states.h`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ControlState {
    /// Before anything else.
    #[default]
    Default,
    /// Starting up.
    Init,
    /// On the ground, motors off.
    Landed,
    /// In the air, following PCMD.
    Flying,
    /// In the air, holding position.
    Hovering,
    /// Self-test.
    Test,
    /// Climbing to the hover height.
    TakingOff,
    /// Going to a fixed point; some clients count it as flying.
    GoingToFixPoint,
    /// Descending to the ground.
    Landing,
    /// A flip.
    Looping,
    /// A number that Parrot's documents do not name.
    Unknown(u16),
}

impl ControlState {
    /// Name for logs, stable across versions. Numbers without a name are `Unknown`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Default => "Default",
            Self::Init => "Init",
            Self::Landed => "Landed",
            Self::Flying => "Flying",
            Self::Hovering => "Hovering",
            Self::Test => "Test",
            Self::TakingOff => "TakingOff",
            Self::GoingToFixPoint => "GoingToFixPoint",
            Self::Landing => "Landing",
            Self::Looping => "Looping",
            Self::Unknown(_) => "Unknown",
        }
    }

    /// The major number in the packet.
    pub fn number(self) -> u16 {
        match self {
            Self::Default => 0,
            Self::Init => 1,
            Self::Landed => 2,
            Self::Flying => 3,
            Self::Hovering => 4,
            Self::Test => 5,
            Self::TakingOff => 6,
            Self::GoingToFixPoint => 7,
            Self::Landing => 8,
            Self::Looping => 9,
            Self::Unknown(number) => number,
        }
    }

    /// The state with this major number.
    pub fn from_number(number: u16) -> Self {
        match number {
            0 => Self::Default,
            1 => Self::Init,
            2 => Self::Landed,
            3 => Self::Flying,
            4 => Self::Hovering,
            5 => Self::Test,
            6 => Self::TakingOff,
            7 => Self::GoingToFixPoint,
            8 => Self::Landing,
            9 => Self::Looping,
            other => Self::Unknown(other),
        }
    }
}
