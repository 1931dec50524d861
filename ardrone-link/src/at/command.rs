//! AT commands, as types that cannot represent invalid values.

use super::animation::{FlightAnimation, Hertz, LedAnimation};
use super::config::Config;

/// A command to the drone. The sequence number is added when it is encoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// Take-off, landing, emergency: a level that is repeated in every datagram.
    Ref(Ref),
    /// Stick positions, or hold position.
    Pcmd(Motion),
    /// As [`Command::Pcmd`], with the heading of the operator's compass: roll and pitch are then relative to
    /// the operator.
    PcmdMagneto {
        /// The motion.
        motion: Motion,
        /// The operator's heading as a fraction of 180°, east positive.
        heading: Fraction,
        /// Accuracy of the heading; negative if unknown.
        accuracy: Fraction,
    },
    /// Sets the level reference. Only on flat ground, landed.
    FlatTrim,
    /// Calibrates the compass. Only in flight: the drone turns on itself.
    CalibrateMagneto,
    /// Plays an LED animation; the drone's second generation prefers [`Config::led_animation`].
    Led {
        /// The animation.
        animation: LedAnimation,
        /// Its frequency in hertz, 0 to 60.
        frequency: Hertz,
        /// Duration in seconds.
        seconds: u32,
    },
    /// Starts a flight animation; the drone's second generation prefers
    /// [`Config::flight_animation`].
    Animation {
        /// The animation.
        animation: FlightAnimation,
        /// Duration in milliseconds.
        milliseconds: u32,
    },
    /// Sent once at the start by Parrot's clients; its meaning is not documented.
    Pmode(i32),
    /// Likewise.
    Misc([i32; 4]),
    /// Trims of the first generation of the drone.
    ManualTrim {
        /// Pitch.
        pitch: Fraction,
        /// Roll.
        roll: Fraction,
        /// Yaw.
        yaw: Fraction,
    },
    /// Sets one configuration key; the drone acknowledges with a state bit.
    Config(Config),
    /// Selects the custom configuration of the CONFIG that follows in the same datagram.
    ConfigIds(Identity),
    /// Requests about configuration and acknowledge.
    Control(ControlMode),
    /// Resets the drone's communication watchdog.
    CommunicationWatchdog,
    /// A command that this crate does not model; only ever decoded.
    Other {
        /// Its name, between `AT*` and `=`.
        name: String,
    },
}

/// The REF command's levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ref {
    /// Land, or stay on the ground.
    Land,
    /// Take off, or stay in the air.
    TakeOff,
    /// The rising edge cuts the motors at once, or clears an emergency on the ground.
    ToggleEmergency,
}

impl Ref {
    /// Bits 18, 20, 22, 24 and 28 are always set.
    const BASE: u32 = 0x1154_0000;
    const TAKE_OFF: u32 = 1 << 9;
    const EMERGENCY: u32 = 1 << 8;

    /// The argument on the wire.
    pub fn bits(self) -> u32 {
        match self {
            Self::Land => Self::BASE,
            Self::TakeOff => Self::BASE | Self::TAKE_OFF,
            Self::ToggleEmergency => Self::BASE | Self::EMERGENCY,
        }
    }

    /// Decodes an argument as the drone does: it uses only bits 8 and 9, and the emergency bit takes
    /// precedence.
    pub fn from_bits(bits: u32) -> Self {
        if bits & Self::EMERGENCY != 0 {
            Self::ToggleEmergency
        } else if bits & Self::TAKE_OFF != 0 {
            Self::TakeOff
        } else {
            Self::Land
        }
    }
}

/// A number in \[-1, 1\]: a fraction of one of the drone's configured limits.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Fraction(f32);

// A fraction is never NaN, so equality is reflexive.
impl Eq for Fraction {}

impl Fraction {
    /// No motion.
    pub const ZERO: Self = Self(0.0);

    /// The value if it is in \[-1, 1\].
    pub fn new(value: f32) -> Option<Self> {
        // Adding zero turns -0.0, which would be sent as -2147483648, into 0.0.
        (-1.0..=1.0).contains(&value).then_some(Self(value + 0.0))
    }

    /// The nearest value in \[-1, 1\]; NaN becomes zero, which is no motion.
    pub fn saturating(value: f64) -> Self {
        if value.is_nan() {
            return Self::ZERO;
        }
        // Narrowing is safe after the range check.
        #[allow(clippy::cast_possible_truncation)]
        let narrowed = value.clamp(-1.0, 1.0) as f32;
        Self(narrowed + 0.0)
    }

    /// The value.
    pub fn get(self) -> f32 {
        self.0
    }
}

/// Identifies a custom configuration. Parrot's clients choose the session at random, other clients take the
/// CRC-32 of a name. Zeros are the default configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Identity {
    /// The session.
    pub session: u32,
    /// The user.
    pub user: u32,
    /// The application.
    pub application: u32,
}

impl Identity {
    /// An id as the drone expects it: eight lower-case hexadecimal digits.
    pub fn text(id: u32) -> String {
        format!("{id:08x}")
    }
}

/// The PCMD command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Motion {
    /// Flag 0: the drone holds its position with the bottom camera.
    #[default]
    Hover,
    /// Flag 1: stick positions as fractions of the configured limits.
    Progressive {
        /// Positive rolls right; fraction of `control:euler_angle_max`.
        roll: Fraction,
        /// Positive pitches nose up and flies **backward**; fraction of `control:euler_angle_max`.
        pitch: Fraction,
        /// Positive climbs; fraction of `control:control_vz_max`.
        gaz: Fraction,
        /// Positive turns clockwise seen from above; fraction of `control:control_yaw`.
        yaw: Fraction,
    },
}

/// The CTRL command's modes that a client may send.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ControlMode {
    /// 4: send the configuration on the control port.
    SendConfiguration,
    /// 5: clear the command-acknowledge bit.
    ClearAcknowledge,
    /// 6: send the list of custom configurations on the control port.
    SendCustomConfigurations,
    /// Any other mode, by its number, which is also sent.
    Other(i32),
}

impl ControlMode {
    /// The argument in the AT command.
    pub fn number(self) -> i32 {
        match self {
            Self::SendConfiguration => 4,
            Self::ClearAcknowledge => 5,
            Self::SendCustomConfigurations => 6,
            Self::Other(number) => number,
        }
    }

    /// The mode with this number.
    pub fn from_number(number: i32) -> Self {
        match number {
            4 => Self::SendConfiguration,
            5 => Self::ClearAcknowledge,
            6 => Self::SendCustomConfigurations,
            other => Self::Other(other),
        }
    }
}
