//! The parts of the bindings that are the same for all messages.

/// Peers by number and by name. The error's type is written out, because a peer may be called `err` or `error`.
pub(super) const PEER: &str = r"impl TryFrom<u8> for Peer {
    type Error = u8;

    /// The peer of a number, as it is given to `send_..`; the number itself if no peer has it.
    fn try_from(number: u8) -> Result<Self, u8> {
        Self::ALL.get(usize::from(number)).copied().ok_or(number)
    }
}

impl core::fmt::Display for Peer {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name())
    }
}

impl core::str::FromStr for Peer {
    type Err = MessageError;

    fn from_str(name: &str) -> Result<Self, MessageError> {
        let mut all = Self::ALL.into_iter();
        all.find(|peer| peer.name() == name).ok_or(MessageError::UnknownPeer { column: 1 })
    }
}";

/// Lines about strings begin with `$`.
pub(super) const ERRORS: &str = r#"/// Why a text is no message. Columns are counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MessageError {
    /// It does not begin with a version: 16 hexadecimal digits and a blank.
    NoVersion,
    /// Its sender was translated with other peers or messages.
    OtherVersion {
        /// [`MESSAGES_VERSION`]
        ours: u64,
        /// The sender's.
        theirs: u64,
    },
    /// It is longer than any message.
    TooLong {
        /// Its length; at most [`LONGEST_LINE`] are read.
        bytes: usize,
    },
    /// No peer has this name.
    UnknownPeer {
        /// Where the name begins.
        column: usize,
    },
    /// There is no such message.
    UnknownMessage {
        /// Where it begins.
        column: usize,
    },
    /// An argument is missing, or is no value of its type.
    WrongArgument {
        /// Where it begins, or the sign before or behind it should be.
        column: usize,
    },
$    /// It has a string, which can be written and not read: C may keep it for ever.
$    Unreadable {
$        /// Where the message begins.
$        column: usize,
$    },
    /// There is something behind the message.
    Trailing {
        /// Where that begins.
        column: usize,
    },
}

impl core::fmt::Display for MessageError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NoVersion => f.write_str("it does not begin with a version"),
            Self::OtherVersion { ours, theirs } => {
                write!(f, "it is of version {theirs:016x} of the messages, and not of {ours:016x}")
            }
            Self::TooLong { bytes } => {
                write!(f, "it has {bytes} bytes, and the longest message {LONGEST_LINE}")
            }
            Self::UnknownPeer { column } => write!(f, "no peer has the name at column {column}"),
            Self::UnknownMessage { column } => write!(f, "no message begins at column {column}"),
            Self::WrongArgument { column } => write!(f, "wrong argument at column {column}"),
$            Self::Unreadable { column } => {
$                write!(f, "strings are not read, as of the message at column {column}")
$            }
            Self::Trailing { column } => {
                write!(f, "something stands behind the message at column {column}")
            }
        }
    }
}

impl core::error::Error for MessageError {}"#;

/// For [`of_bits`].
pub(super) const DIGITS: &str = r#"/// A number by the shortest digits with exactly this value, or `inf`, `-inf` or `nan`; another
/// not-a-number than the usual one has its bits behind it.
struct DigitsBITS(fBITS);

impl core::fmt::Display for DigitsBITS {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self.0.to_bits() {
            NAN => f.write_str("nan"),
            bits if self.0.is_nan() => write!(f, "nan:{bits:0DIGITSx}"),
            _ => write!(f, "{:?}", self.0),
        }
    }
}"#;

/// Whole lines, and messages alone.
pub(super) const ENVELOPE: &str = r#"/// A message with its sender, as one line: `VERSION SENDER MESSAGE`, without an end of line.
///
/// The line says who has sent it, and proves nothing: who may write to the channel can be any peer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Envelope {
    /// The sender.
    pub from: Peer,
    /// What it says.
    pub message: Message,
}

impl core::fmt::Display for Envelope {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { from, message } = self;
        write!(f, "{MESSAGES_VERSION:016x} {from} {message}")
    }
}

impl core::str::FromStr for Envelope {
    type Err = MessageError;

    /// Reads a whole line.
    fn from_str(line: &str) -> Result<Self, MessageError> {
        let mut rest = Rest { text: line, column: 1 };
        // First, because other messages may be longer.
        let theirs = rest.version().ok_or(MessageError::NoVersion)?;
        if theirs != MESSAGES_VERSION {
            return Err(MessageError::OtherVersion { ours: MESSAGES_VERSION, theirs });
        }
        check_length(line)?;
        let column = rest.column;
        let name = rest.word(&[' ']);
        let from = name.parse::<Peer>().map_err(|_| MessageError::UnknownPeer { column })?;
        rest.take(" ");
        let message = rest.message()?;
        Ok(Self { from, message })
    }
}

impl core::str::FromStr for Message {
    type Err = MessageError;

    /// Reads a whole text.
    fn from_str(text: &str) -> Result<Self, MessageError> {
        let mut rest = Rest { text, column: 1 };
        check_length(text)?;
        rest.message()
    }
}"#;

/// The state of reading, and its bound.
pub(super) const REST: &str = r"/// Refuses a text that no message has, before any work is done with it.
fn check_length(text: &str) -> Result<(), MessageError> {
    let bytes = text.len();
    if bytes > LONGEST_LINE { Err(MessageError::TooLong { bytes }) } else { Ok(()) }
}

/// What is not read yet of a line, and the column where it begins.
struct Rest<'a> {
    text: &'a str,
    column: usize,
}";

/// The methods of `Rest` that all messages need.
pub(super) const READING: &str = r#"/// Reads this, if it comes next.
fn take(&mut self, expected: &str) -> bool {
    let Some(rest) = self.text.strip_prefix(expected) else { return false };
    self.text = rest;
    self.column += expected.len();
    true
}

/// Reads up to one of these signs, or all.
fn word(&mut self, ends: &[char]) -> &'a str {
    let end = self.text.find(ends).unwrap_or(self.text.len());
    let (word, rest) = self.text.split_at(end);
    self.text = rest;
    self.column += word.len();
    word
}

/// Reads a version and the blank behind it.
fn version(&mut self) -> Option<u64> {
    let version = hexadecimal(self.word(&[' ']), 16)?;
    self.take(" ").then_some(version)
}"#;

/// Those that arguments need.
pub(super) const ARGUMENT: &str = r"/// Reads the signs before an argument, and the argument.
fn argument<T>(
    &mut self,
    before: &str,
    read: impl FnOnce(&str) -> Option<T>,
) -> Result<T, MessageError> {
    self.close(before)?;
    let column = self.column;
    read(self.word(&[',', ')', '}'])).ok_or(MessageError::WrongArgument { column })
}

/// Reads the signs that must be here.
fn close(&mut self, expected: &str) -> Result<(), MessageError> {
    if self.take(expected) {
        return Ok(());
    }
    Err(MessageError::WrongArgument { column: self.column })
}";

/// Versions, and bits.
pub(super) const HEXADECIMAL: &str = r"/// A number of so many small hexadecimal digits.
fn hexadecimal(text: &str, digits: usize) -> Option<u64> {
    let is_digit = |sign: u8| matches!(sign, b'0'..=b'9' | b'a'..=b'f');
    if text.len() != digits || !text.bytes().all(is_digit) {
        return None;
    }
    u64::from_str_radix(text, 16).ok()
}";

/// Their text is the only one, so that nothing is read as something else.
pub(super) const INTEGER: &str = r#"/// An integer in its only text: without `+`, zeros in front, or a sign of zero.
fn read_integer<T: core::str::FromStr>(text: &str) -> Option<T> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    if digits.starts_with(['+', '0']) && text != "0" {
        return None;
    }
    text.parse().ok()
}"#;

/// Other programs, and other versions of Rust, write the same number in other ways.
pub(super) const DECIMAL: &str = r#"/// Whether a text is a number in decimal: `2`, `-0.0`, `1.5e-7`, `1E+300`.
fn is_decimal(text: &str) -> bool {
    let text = text.strip_prefix('-').unwrap_or(text);
    let (number, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = number.split_once('.').unwrap_or((number, "0"));
    let exponent = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|sign| sign.is_ascii_digit());
    [whole, fraction, exponent].into_iter().all(is_digits)
}"#;

/// For [`of_bits`].
pub(super) const FLOAT: &str = r#"/// The nearest number; none for one beyond the largest.
fn read_fBITS(text: &str) -> Option<fBITS> {
    let number = match text {
        "nan" => fBITS::from_bits(NAN),
        "inf" => fBITS::INFINITY,
        "-inf" => fBITS::NEG_INFINITY,
        _ => match text.strip_prefix("nan:") {
            Some(digits) => {
                let bits = FROM_DIGITS;
                let number = fBITS::from_bits(bits);
                // Each number has one text of this form, and finite ones have none.
                return (number.is_nan() && bits != NAN).then_some(number);
            }
            None if is_decimal(text) => {
                return text.parse().ok().filter(|number: &fBITS| number.is_finite());
            }
            None => return None,
        },
    };
    Some(number)
}"#;

/// A template for `f32` or `f64`.
pub(super) fn of_bits(bits: u32, template: &str) -> String {
    // The quiet not-a-number of most machines.
    let (nan, digits, from_digits) = match bits {
        32 => ("0x7fc0_0000", "8", "u32::try_from(hexadecimal(digits, 8)?).ok()?"),
        _ => ("0x7ff8_0000_0000_0000", "16", "hexadecimal(digits, 16)?"),
    };
    let template = template.replace("FROM_DIGITS", from_digits).replace("DIGITS", digits);
    template.replace("BITS", &bits.to_string()).replace("NAN", nan)
}
