//! Decodes AT commands, as leniently as the firmware is known to do.

use nom::branch::alt;
use nom::bytes::complete::{tag, take_till, take_while1};
use nom::character::complete::{char, i64 as integer};
use nom::combinator::{all_consuming, map};
use nom::multi::many0;
use nom::sequence::{delimited, preceded};
use nom::{IResult, Parser};

use super::animation::Hertz;
use super::animation::{FlightAnimation, LedAnimation};
use super::command::{Command, ControlMode, Fraction, Identity, Motion, Ref};
use super::config::Config;

/// Why a command of a datagram cannot be decoded.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeError {
    /// Not of the form `AT*NAME=sequence,arguments`, or its sequence number is negative or has more than 32 bits.
    #[error("malformed AT command `{command}`")]
    Malformed {
        /// Its first 80 bytes, with U+FFFD for each that is no printable ASCII.
        command: String,
    },
    /// Too few arguments, or some of the wrong type or out of range.
    #[error("AT*{name} with impossible arguments")]
    Arguments {
        /// The command's name.
        name: String,
    },
}

/// Decodes the commands of a datagram with their sequence numbers, in order. Carriage return, line feed and NUL end a
/// command, and need not end the last; empty lines are skipped; surplus arguments are ignored.
pub fn decode(datagram: &[u8]) -> impl Iterator<Item = Result<(u32, Command), DecodeError>> {
    datagram
        .split(|byte| matches!(byte, b'\r' | b'\n' | 0))
        .filter(|line| !line.is_empty())
        .map(decode_command)
}

#[derive(Debug, PartialEq)]
enum Argument<'a> {
    Number(i64),
    Text(&'a [u8]),
}

impl Argument<'_> {
    /// An integer. Clients print 32 bits signed or unsigned.
    fn bits(&self) -> Option<u32> {
        match self {
            Self::Number(number) => u32::try_from(*number)
                .ok()
                .or_else(|| i32::try_from(*number).ok().map(i32::cast_unsigned)),
            Self::Text(_) => None,
        }
    }

    fn fraction(&self) -> Option<Fraction> {
        Fraction::new(f32::from_bits(self.bits()?))
    }

    fn identity(&self) -> Option<u32> {
        u32::from_str_radix(&self.text()?, 16).ok()
    }

    fn text(&self) -> Option<String> {
        match self {
            Self::Text(text) => String::from_utf8(text.to_vec()).ok(),
            Self::Number(_) => None,
        }
    }
}

/// A command's name, sequence number and arguments.
type Parts<'a> = (&'a [u8], i64, Vec<Argument<'a>>);

fn syntax(line: &[u8]) -> IResult<&[u8], Parts<'_>> {
    let name = take_while1(|byte: u8| byte.is_ascii_uppercase() || byte == b'_');
    let text = delimited(char('"'), take_till(|byte| byte == b'"'), char('"'));
    let argument = alt((map(integer, Argument::Number), map(text, Argument::Text)));
    all_consuming((
        preceded(tag(&b"AT*"[..]), name),
        preceded(char('='), integer),
        many0(preceded(char(','), argument)),
    ))
    .parse(line)
}

fn decode_command(line: &[u8]) -> Result<(u32, Command), DecodeError> {
    let malformed = || DecodeError::Malformed {
        command: line.iter().take(80).copied().map(printable).collect(),
    };
    let (_, (name, sequence, arguments)) = syntax(line).map_err(|_| malformed())?;
    let sequence = u32::try_from(sequence).map_err(|_| malformed())?;
    let name: String = name.iter().copied().map(char::from).collect();
    let command = typed(&name, &arguments).ok_or(DecodeError::Arguments { name })?;
    Ok((sequence, command))
}

fn typed(name: &str, arguments: &[Argument<'_>]) -> Option<Command> {
    let command = match (name, arguments) {
        ("REF", [bits, ..]) => Command::Ref(Ref::from_bits(bits.bits()?)),
        ("PCMD", [flag, roll, pitch, gaz, yaw, ..]) => {
            Command::Pcmd(motion_of(flag, roll, pitch, gaz, yaw)?)
        }
        ("PCMD_MAG", [flag, roll, pitch, gaz, yaw, heading, accuracy, ..]) => {
            Command::PcmdMagneto {
                motion: motion_of(flag, roll, pitch, gaz, yaw)?,
                heading: heading.fraction()?,
                accuracy: accuracy.fraction()?,
            }
        }
        ("FTRIM", _) => Command::FlatTrim,
        ("CALIB", [device, ..]) if device.bits()? == 0 => Command::CalibrateMagneto,
        ("LED", [animation, frequency, seconds, ..]) => Command::Led {
            animation: LedAnimation::from_number(animation.bits()?)?,
            frequency: Hertz::new(f32::from_bits(frequency.bits()?))?,
            seconds: seconds.bits()?,
        },
        ("ANIM", [animation, milliseconds, ..]) => Command::Animation {
            animation: FlightAnimation::from_number(animation.bits()?)?,
            milliseconds: milliseconds.bits()?,
        },
        ("PMODE", [mode, ..]) => Command::Pmode(mode.bits()?.cast_signed()),
        ("MISC", [a, b, c, d, ..]) => Command::Misc([
            a.bits()?.cast_signed(),
            b.bits()?.cast_signed(),
            c.bits()?.cast_signed(),
            d.bits()?.cast_signed(),
        ]),
        ("MTRIM", [pitch, roll, yaw, ..]) => Command::ManualTrim {
            pitch: pitch.fraction()?,
            roll: roll.fraction()?,
            yaw: yaw.fraction()?,
        },
        ("CONFIG", [key, value, ..]) => {
            Command::Config(Config::new(key.text()?, value.text()?).ok()?)
        }
        ("CONFIG_IDS", [session, user, application, ..]) => Command::ConfigIds(Identity {
            session: session.identity()?,
            user: user.identity()?,
            application: application.identity()?,
        }),
        ("CTRL", [mode, ..]) => {
            Command::Control(ControlMode::from_number(mode.bits()?.cast_signed()))
        }
        ("COMWDG", _) => Command::CommunicationWatchdog,
        (
            "REF" | "PCMD" | "PCMD_MAG" | "CONFIG" | "CONFIG_IDS" | "CTRL" | "CALIB" | "LED"
            | "ANIM" | "PMODE" | "MISC" | "MTRIM",
            _,
        ) => return None,
        _ => Command::Other { name: name.to_owned() },
    };
    Some(command)
}

fn motion_of(
    flag: &Argument<'_>,
    roll: &Argument<'_>,
    pitch: &Argument<'_>,
    gaz: &Argument<'_>,
    yaw: &Argument<'_>,
) -> Option<Motion> {
    if flag.bits()? & 1 == 0 {
        return Some(Motion::Hover);
    }
    Some(Motion::Progressive {
        roll: roll.fraction()?,
        pitch: pitch.fraction()?,
        gaz: gaz.fraction()?,
        yaw: yaw.fraction()?,
    })
}

fn printable(byte: u8) -> char {
    if (b' '..=b'~').contains(&byte) { char::from(byte) } else { '\u{fffd}' }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::at::Datagram;

    fn commands(datagram: &[u8]) -> Vec<Result<(u32, Command), DecodeError>> {
        decode(datagram).collect()
    }

    #[test]
    fn what_real_clients_send_is_understood() {
        // A lone CR, PMODE and MISC come first; REF without the constant bits; LF endings.
        let datagram = b"\rAT*PMODE=1,2\rAT*MISC=2,2,20,2000,3000\nAT*REF=3,512\r\n";
        assert_eq!(
            commands(datagram),
            [
                Ok((1, Command::Pmode(2))),
                Ok((2, Command::Misc([2, 20, 2000, 3000]))),
                Ok((3, Command::Ref(Ref::TakeOff))),
            ]
        );
        // A float printed as an unsigned integer, as one client does.
        let fraction = Fraction::new(-0.2).unwrap();
        let motion = Motion::Progressive {
            roll: fraction,
            pitch: Fraction::ZERO,
            gaz: Fraction::ZERO,
            yaw: Fraction::ZERO,
        };
        let decoded = commands(b"AT*PCMD=4,3,3192704205,0,0,0\r");
        assert_eq!(decoded, [Ok((4, Command::Pcmd(motion)))]);
    }

    #[test]
    fn one_bad_command_does_not_spoil_the_others() {
        let decoded = commands(b"AT*PCMD=1,1,2139095040,0,0,0\rAT*REF=x\rAT*FTRIM=3\r");
        assert!(matches!(decoded[0], Err(DecodeError::Arguments { .. })));
        assert!(matches!(decoded[1], Err(DecodeError::Malformed { .. })));
        assert_eq!(decoded[2], Ok((3, Command::FlatTrim)));
    }

    fn fraction() -> impl Strategy<Value = Fraction> {
        (-1.0_f64..=1.0).prop_map(Fraction::saturating)
    }

    fn command() -> impl Strategy<Value = Command> {
        let motion = || {
            (fraction(), fraction(), fraction(), fraction())
                .prop_map(|(roll, pitch, gaz, yaw)| Motion::Progressive { roll, pitch, gaz, yaw })
        };
        prop_oneof![
            prop_oneof![Just(Ref::Land), Just(Ref::TakeOff), Just(Ref::ToggleEmergency)]
                .prop_map(Command::Ref),
            Just(Command::Pcmd(Motion::Hover)),
            motion().prop_map(Command::Pcmd),
            (motion(), fraction(), fraction()).prop_map(|(motion, heading, accuracy)| {
                Command::PcmdMagneto { motion, heading, accuracy }
            }),
            Just(Command::FlatTrim),
            Just(Command::CalibrateMagneto),
            (0_u32..21, 0.0_f32..60.0, any::<u32>()).prop_map(|(number, frequency, seconds)| {
                Command::Led {
                    animation: LedAnimation::from_number(number).unwrap(),
                    frequency: Hertz::new(frequency).unwrap(),
                    seconds,
                }
            }),
            (0_u32..20, any::<u32>()).prop_map(|(number, milliseconds)| Command::Animation {
                animation: FlightAnimation::from_number(number).unwrap(),
                milliseconds,
            }),
            any::<i32>().prop_map(Command::Pmode),
            any::<[i32; 4]>().prop_map(Command::Misc),
            (fraction(), fraction(), fraction())
                .prop_map(|(pitch, roll, yaw)| Command::ManualTrim { pitch, roll, yaw }),
            ("[a-z]{1,8}:[a-z_]{1,12}", "[ !#-~]{0,40}")
                .prop_map(|(key, value)| Command::Config(Config::new(key, value).unwrap())),
            any::<(u32, u32, u32)>().prop_map(|(session, user, application)| {
                Command::ConfigIds(Identity { session, user, application })
            }),
            any::<i32>().prop_map(|mode| Command::Control(ControlMode::from_number(mode))),
            Just(Command::CommunicationWatchdog),
        ]
    }

    proptest! {
        #[test]
        fn decoding_undoes_encoding(
            sent in proptest::collection::vec((any::<u32>(), command()), 0..5)
        ) {
            let mut datagram = Datagram::new();
            for (sequence, command) in &sent {
                datagram.push(*sequence, command).unwrap();
            }
            let received: Vec<_> = decode(datagram.as_bytes()).map(Result::unwrap).collect();
            prop_assert_eq!(received, sent);
        }

        #[test]
        fn any_bytes_are_decoded_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
            for command in decode(&bytes) {
                drop(command);
            }
        }
    }
}
