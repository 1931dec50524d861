//! The commands, as types that cannot hold what must not be sent.

use super::animation::{FlightAnimation, Hertz, LedAnimation};
use super::config::Config;

/// A command to the drone. The sequence number is added when it is encoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// Take-off, landing, emergency: a level that is repeated in every datagram.
    Ref(Ref),
    /// How to move, or to hold still.
    Pcmd(Motion),
    /// As [`Command::Pcmd`], and where the pilot's own compass points: the drone then takes roll and
    /// pitch as the pilot sees them.
    PcmdMagneto {
        /// The motion.
        motion: Motion,
        /// The pilot's heading as a fraction of 180°, east positive.
        heading: Fraction,
        /// Its error, or less than zero if it is not known.
        accuracy: Fraction,
    },
    /// Level reference. Only on flat ground, landed.
    FlatTrim,
    /// Calibrates the compass. Only in flight: the drone turns on itself.
    CalibrateMagneto,
    /// Plays an LED animation; the drone's second generation prefers [`Config::led_animation`].
    Led {
        /// The animation.
        animation: LedAnimation,
        /// Its frequency in hertz, 0 to 60.
        frequency: Hertz,
        /// How long, in seconds.
        seconds: u32,
    },
    /// Starts a flight animation; the drone's second generation prefers
    /// [`Config::flight_animation`].
    Animation {
        /// The animation.
        animation: FlightAnimation,
        /// How long, in milliseconds.
        milliseconds: u32,
    },
    /// What Parrot's clients send once at the start; its meaning is not documented.
    Pmode(i32),
    /// Likewise.
    Misc([i32; 4]),
    /// Trims of the first generation.
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

    /// What a drone makes of an argument: it looks at bits 8 and 9 only, and the emergency bit
    /// is the stronger one.
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

// A fraction is never NaN.
impl Eq for Fraction {}

impl Fraction {
    /// No motion.
    pub const ZERO: Self = Self(0.0);

    /// The value if it is in \[-1, 1\].
    pub fn new(value: f32) -> Option<Self> {
        // Adding zero turns -0.0, which prints as -2147483648, into 0.0.
        (-1.0..=1.0).contains(&value).then_some(Self(value + 0.0))
    }

    /// The nearest value in \[-1, 1\]; NaN becomes zero, the value that moves nothing.
    pub fn saturating(value: f64) -> Self {
        if value.is_nan() {
            return Self::ZERO;
        }
        // The range check makes the narrowing harmless.
        #[allow(clippy::cast_possible_truncation)]
        let narrowed = value.clamp(-1.0, 1.0) as f32;
        Self(narrowed + 0.0)
    }

    /// The value.
    pub fn get(self) -> f32 {
        self.0
    }
}

/// Whose configuration is meant. Parrot's clients take the session at random, the others from the
/// CRC-32 of a name. Zeros are the default configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Identity {
    /// This session.
    pub session: u32,
    /// The person who flies.
    pub user: u32,
    /// The program that flies.
    pub application: u32,
}

impl Identity {
    /// An id as the drone wants it: eight lower-case hexadecimal digits.
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
    /// Flag 1: fractions of the configured limits.
    Progressive {
        /// Positive flies right; of `control:euler_angle_max`.
        roll: Fraction,
        /// Positive flies **backward**; of `control:euler_angle_max`.
        pitch: Fraction,
        /// Positive climbs; of `control:control_vz_max`.
        gaz: Fraction,
        /// Positive turns clockwise seen from above; of `control:control_yaw`.
        yaw: Fraction,
    },
}

/// The CTRL command's modes that a client may send.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ControlMode {
    /// Send the configuration on the control port.
    SendConfiguration,
    /// Clear the command-acknowledge bit.
    ClearAcknowledge,
    /// Send the list of custom configurations on the control port.
    SendCustomConfigurations,
    /// Any other mode; only ever decoded.
    Other(i32),
}

impl ControlMode {
    /// The argument on the wire.
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
