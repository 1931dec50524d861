//! Encodes AT commands.

use std::fmt::Write as _;

use bytes::BytesMut;

use super::command::{Command, Identity, Motion};

/// Maximum size of a datagram that the drone accepts.
pub const MAX_DATAGRAM_BYTES: usize = 1024;

/// Why a command was not added to a datagram.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The datagram would exceed the drone's limit; it is unchanged.
    #[error("datagram is full: {bytes} bytes are needed, {MAX_DATAGRAM_BYTES} are allowed")]
    Full {
        /// The size it would have.
        bytes: usize,
    },
    /// The command exists only for decoding.
    #[error("`AT*{name}` is not a command that a client sends")]
    NotSendable {
        /// The command's name.
        name: String,
    },
}

/// A datagram of AT commands. Its buffer is allocated once and reused.
#[derive(Debug, Clone)]
pub struct Datagram {
    buffer: BytesMut,
}

impl Default for Datagram {
    fn default() -> Self {
        Self::new()
    }
}

impl Datagram {
    /// An empty datagram.
    pub fn new() -> Self {
        // Twice the limit, because a command is written first and removed if it was too long.
        Self { buffer: BytesMut::with_capacity(2 * MAX_DATAGRAM_BYTES) }
    }

    /// Empties the datagram and keeps its buffer.
    pub fn clear(&mut self) {
        self.buffer.clear();
    }

    /// Adds a command with its sequence number.
    ///
    /// # Errors
    /// [`EncodeError`]; the datagram is unchanged then.
    pub fn push(&mut self, sequence: u32, command: &Command) -> Result<(), EncodeError> {
        let length = self.buffer.len();
        let result = self.write(sequence, command);
        if result.is_err() {
            self.buffer.truncate(length);
        }
        result
    }

    /// The bytes to send.
    pub fn as_bytes(&self) -> &[u8] {
        &self.buffer
    }

    fn write(&mut self, sequence: u32, command: &Command) -> Result<(), EncodeError> {
        let out = &mut self.buffer;
        let written = match command {
            Command::Ref(reference) => write!(out, "AT*REF={sequence},{}\r", reference.bits()),
            Command::Pcmd(motion) => {
                let [flag, roll, pitch, gaz, yaw] = motion_arguments(*motion);
                write!(out, "AT*PCMD={sequence},{flag},{roll},{pitch},{gaz},{yaw}\r")
            }
            Command::PcmdMagneto { motion, heading, accuracy } => {
                let [flag, roll, pitch, gaz, yaw] = motion_arguments(*motion);
                // Sets the absolute mode unless the drone shall hover.
                let flag = if flag == 0 { 0 } else { flag | ABSOLUTE };
                let heading = float_argument(heading.get());
                let accuracy = float_argument(accuracy.get());
                write!(
                    out,
                    "AT*PCMD_MAG={sequence},{flag},{roll},{pitch},{gaz},{yaw},{heading},{accuracy}\r"
                )
            }
            Command::CalibrateMagneto => write!(out, "AT*CALIB={sequence},0\r"),
            Command::Led { animation, frequency, seconds } => {
                let (number, frequency) = (animation.number(), float_argument(frequency.get()));
                write!(out, "AT*LED={sequence},{number},{frequency},{seconds}\r")
            }
            Command::Animation { animation, milliseconds } => {
                write!(out, "AT*ANIM={sequence},{},{milliseconds}\r", animation.number())
            }
            Command::Pmode(mode) => write!(out, "AT*PMODE={sequence},{mode}\r"),
            Command::Misc([a, b, c, d]) => write!(out, "AT*MISC={sequence},{a},{b},{c},{d}\r"),
            Command::ManualTrim { pitch, roll, yaw } => {
                let [pitch, roll, yaw] =
                    [pitch, roll, yaw].map(|value| float_argument(value.get()));
                write!(out, "AT*MTRIM={sequence},{pitch},{roll},{yaw}\r")
            }
            Command::FlatTrim => write!(out, "AT*FTRIM={sequence}\r"),
            Command::Config(config) => {
                write!(out, "AT*CONFIG={sequence},\"{}\",\"{}\"\r", config.key(), config.value())
            }
            Command::ConfigIds(Identity { session, user, application }) => write!(
                out,
                "AT*CONFIG_IDS={sequence},\"{session:08x}\",\"{user:08x}\",\"{application:08x}\"\r"
            ),
            Command::Control(mode) => write!(out, "AT*CTRL={sequence},{},0\r", mode.number()),
            Command::CommunicationWatchdog => write!(out, "AT*COMWDG={sequence}\r"),
            Command::Other { name } => {
                return Err(EncodeError::NotSendable { name: name.clone() });
            }
        };
        let bytes = out.len();
        if written.is_err() || bytes > MAX_DATAGRAM_BYTES {
            return Err(EncodeError::Full { bytes });
        }
        Ok(())
    }
}

/// Bit 2 of the flag: roll and pitch are relative to the operator (absolute control).
const ABSOLUTE: i32 = 4;

/// Flag, roll, pitch, gaz, yaw.
fn motion_arguments(motion: Motion) -> [i32; 5] {
    match motion {
        Motion::Hover => [0; 5],
        Motion::Progressive { roll, pitch, gaz, yaw } => {
            let [roll, pitch, gaz, yaw] =
                [roll, pitch, gaz, yaw].map(|value| float_argument(value.get()));
            [1, roll, pitch, gaz, yaw]
        }
    }
}

/// The IEEE-754 bits of a float, printed as a signed integer.
fn float_argument(value: f32) -> i32 {
    value.to_bits().cast_signed()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::at::{Config, ControlMode, FlightAnimation, Fraction, Hertz, LedAnimation, Ref};

    fn text(sequence: u32, command: &Command) -> String {
        let mut datagram = Datagram::new();
        datagram.push(sequence, command).unwrap();
        String::from_utf8(datagram.as_bytes().to_vec()).unwrap()
    }

    fn motion(values: [f64; 4]) -> Command {
        let [roll, pitch, gaz, yaw] = values.map(Fraction::saturating);
        Command::Pcmd(Motion::Progressive { roll, pitch, gaz, yaw })
    }

    /// The strings that pyardrone and node-ar-drone produce for the same commands.
    #[test]
    fn commands_are_encoded_as_other_clients_encode_them() {
        for (sequence, command, expected) in [
            (1, Command::Ref(Ref::Land), "AT*REF=1,290717696\r"),
            (2, Command::Ref(Ref::TakeOff), "AT*REF=2,290718208\r"),
            (3, Command::Ref(Ref::ToggleEmergency), "AT*REF=3,290717952\r"),
            (5, Command::Pcmd(Motion::Hover), "AT*PCMD=5,0,0,0,0,0\r"),
            (6, motion([0.0, -0.5, 0.0, 0.0]), "AT*PCMD=6,1,0,-1090519040,0,0\r"),
            (
                7,
                motion([-0.1, 0.0, 0.2, 0.75]),
                "AT*PCMD=7,1,-1110651699,0,1045220557,1061158912\r",
            ),
            (
                9,
                Command::Config(Config::new("general:navdata_demo", "TRUE").unwrap()),
                "AT*CONFIG=9,\"general:navdata_demo\",\"TRUE\"\r",
            ),
            (10, Command::Control(ControlMode::ClearAcknowledge), "AT*CTRL=10,5,0\r"),
            (11, Command::FlatTrim, "AT*FTRIM=11\r"),
            (13, Command::CalibrateMagneto, "AT*CALIB=13,0\r"),
            (14, Command::Pmode(2), "AT*PMODE=14,2\r"),
            (15, Command::Misc([2, 20, 2000, 3000]), "AT*MISC=15,2,20,2000,3000\r"),
            (
                16,
                Command::Led {
                    animation: LedAnimation::RedSnake,
                    frequency: Hertz::new(5.0).unwrap(),
                    seconds: 2,
                },
                "AT*LED=16,9,1084227584,2\r",
            ),
            (
                17,
                Command::Animation { animation: FlightAnimation::FlipLeft, milliseconds: 15 },
                "AT*ANIM=17,18,15\r",
            ),
            (
                18,
                Command::ConfigIds(Identity { session: 0xAB, user: 1, application: u32::MAX }),
                "AT*CONFIG_IDS=18,\"000000ab\",\"00000001\",\"ffffffff\"\r",
            ),
            (12, Command::CommunicationWatchdog, "AT*COMWDG=12\r"),
        ] {
            assert_eq!(text(sequence, &command), expected);
        }
    }

    #[test]
    fn motion_that_cannot_be_sent_becomes_motion_that_can() {
        let expected = "AT*PCMD=1,1,0,1065353216,-1082130432,0\r";
        assert_eq!(text(1, &motion([f64::NAN, f64::INFINITY, -7.0, -0.0])), expected);
        assert_eq!(Fraction::new(f32::NAN), None);
        assert_eq!(Fraction::new(1.001), None);
    }

    #[test]
    fn a_datagram_never_grows_beyond_what_the_drone_takes() {
        let config = Command::Config(Config::new("a:b", "x".repeat(256)).unwrap());
        let mut datagram = Datagram::new();
        let mut accepted = 0;
        while datagram.push(1, &config).is_ok() {
            accepted += 1;
        }
        assert_eq!(accepted, 3);
        assert!(datagram.as_bytes().len() <= MAX_DATAGRAM_BYTES);
        assert!(datagram.as_bytes().ends_with(b"\r"));
    }

    #[test]
    fn configuration_that_would_break_the_syntax_cannot_be_built() {
        for (key, value) in [("nokey", "1"), (":x", "1"), ("a:", "1"), ("a:b", "\""), ("a:b", "\r")]
        {
            assert!(Config::new(key, value).is_err(), "{key} {value:?}");
        }
        assert!(Config::new("a:b", "x".repeat(257)).is_err());
    }
}
