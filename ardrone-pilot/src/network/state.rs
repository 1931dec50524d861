//! A vehicle's state as it is told over a network: JSON that anybody's program can read.

use std::time::Duration;

use autopilot::separation::{Claim, Neighbour, Presence, Rank};
use autopilot::vehicle::VehicleName;
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};

use super::roster::Digest;

/// Version of the text. A program that reads another one refuses it.
pub const VERSION: u32 = 1;
/// Longest text, in bytes.
pub const STATE_BYTES: usize = 1024;
/// Most answers in one state, so that it is no longer than that.
pub const MOST_ECHOES: usize = 6;
/// Largest numbers that make sense: places and uncertainties, speeds, separations, and times that JSON carries exactly.
const FURTHEST_M: f64 = 1000.0;
const FASTEST_M_S: f64 = 30.0;
const WIDEST_M: f64 = 20.0;
const LATEST_US: u64 = 1 << 53;
/// Numbers of MAVLink's systems.
const SYSTEMS: std::ops::RangeInclusive<u8> = 1..=250;

/// One run of a program: its stamps are of one clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Session(pub u64);

/// An answer to the stamps of another program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Echo {
    /// Whose stamp it is.
    pub session: Session,
    /// Its newest stamp that was heard, by its own clock.
    pub sent: Duration,
    /// How long that was held, by the clock of who answers.
    pub held: Duration,
}

/// What a program tells of a vehicle that it flies.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// What the programs of a fleet must agree on.
    pub fleet: Digest,
    /// The program's run.
    pub session: Session,
    /// Whose state it is.
    pub vehicle: VehicleName,
    /// When it was told, by the clock of the session.
    pub sent: Duration,
    /// Where it was; `at` is by the clock of the session.
    pub neighbour: Neighbour,
    /// Its flight has ended, and it stays where it is.
    pub is_parked: bool,
    /// Answers to others; those beyond [`MOST_ECHOES`] are not told.
    pub heard: Vec<Echo>,
}

/// Why a text is no state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unreadable {
    /// It has more than [`STATE_BYTES`].
    TooLong,
    /// It is no JSON with the fields of a state.
    Malformed,
    /// It has another version.
    Version(u32),
    /// A number is not finite, so large that it makes no sense, or contradicts another one.
    Absurd,
}

#[derive(Deserialize)]
struct Versioned {
    version: u32,
}

/// The fields as they are written.
#[derive(Serialize, Deserialize)]
struct Written {
    version: u32,
    fleet: Digest,
    session: Session,
    vehicle: VehicleName,
    system: u8,
    sent_us: u64,
    measured_us: u64,
    place_m: [f64; 2],
    velocity_m_s: [f64; 2],
    uncertainty_m: f64,
    separation_m: f64,
    presence: WrittenPresence,
    claim: Option<WrittenClaim>,
    parked: bool,
    heard: Vec<WrittenEcho>,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum WrittenPresence {
    Stands,
    Starts,
    Flies,
}

#[derive(Serialize, Deserialize)]
struct WrittenClaim {
    to_m: [f64; 2],
    first_system: u8,
    behind: u8,
}

#[derive(Serialize, Deserialize)]
struct WrittenEcho {
    session: Session,
    sent_us: u64,
    held_us: u64,
}

impl TryFrom<String> for Session {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        let is_plain = text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let number = u64::from_str_radix(&text, 16).ok().filter(|_| is_plain);
        number.map(Self).ok_or("a session has 16 hexadecimal digits")
    }
}

impl From<Session> for String {
    fn from(Session(number): Session) -> Self {
        format!("{number:016x}")
    }
}

impl State {
    /// The text; `None` if a number makes no sense, which nobody would believe.
    pub fn encode(&self) -> Option<String> {
        let Neighbour { system, at, place_m, velocity_m_s, uncertainty_m, separation_m, .. } =
            self.neighbour;
        let presence = match self.neighbour.presence {
            Presence::Stands => WrittenPresence::Stands,
            Presence::Starts => WrittenPresence::Starts,
            Presence::Flies => WrittenPresence::Flies,
        };
        let claim = self.neighbour.claim.map(|Claim { to_m, rank }| WrittenClaim {
            to_m: rounded(to_m),
            first_system: rank.system,
            behind: rank.behind,
        });
        let echo = |echo: &Echo| WrittenEcho {
            session: echo.session,
            sent_us: micros(echo.sent),
            held_us: micros(echo.held),
        };
        let written = Written {
            version: VERSION,
            fleet: self.fleet,
            session: self.session,
            vehicle: self.vehicle,
            system,
            sent_us: micros(self.sent),
            measured_us: micros(at),
            place_m: rounded(place_m),
            velocity_m_s: rounded(velocity_m_s),
            // Never more certain than it is.
            uncertainty_m: (uncertainty_m * 1000.0).ceil() / 1000.0,
            separation_m: (separation_m * 1000.0).ceil() / 1000.0,
            presence,
            claim,
            parked: self.is_parked,
            heard: self.heard.iter().take(MOST_ECHOES).map(echo).collect(),
        };
        // These types have nothing that JSON cannot express.
        let text = serde_json::to_string(&written).ok().filter(|_| written.is_sound())?;
        (text.len() <= STATE_BYTES).then_some(text)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// [`Unreadable`], whatever it is.
    pub fn decode(text: &[u8]) -> Result<Self, Unreadable> {
        if text.len() > STATE_BYTES {
            return Err(Unreadable::TooLong);
        }
        let versioned: Versioned =
            serde_json::from_slice(text).map_err(|_| Unreadable::Malformed)?;
        if versioned.version != VERSION {
            return Err(Unreadable::Version(versioned.version));
        }
        let written: Written = serde_json::from_slice(text).map_err(|_| Unreadable::Malformed)?;
        if !written.is_sound() {
            return Err(Unreadable::Absurd);
        }
        let claim = written.claim.map(|WrittenClaim { to_m, first_system, behind }| Claim {
            to_m: to_m.into(),
            rank: Rank { system: first_system, behind },
        });
        let neighbour = Neighbour {
            system: written.system,
            at: Duration::from_micros(written.measured_us),
            place_m: written.place_m.into(),
            velocity_m_s: written.velocity_m_s.into(),
            uncertainty_m: written.uncertainty_m,
            separation_m: written.separation_m,
            presence: match written.presence {
                WrittenPresence::Stands => Presence::Stands,
                WrittenPresence::Starts => Presence::Starts,
                WrittenPresence::Flies => Presence::Flies,
            },
            claim,
        };
        let echo = |echo: &WrittenEcho| Echo {
            session: echo.session,
            sent: Duration::from_micros(echo.sent_us),
            held: Duration::from_micros(echo.held_us),
        };
        Ok(Self {
            fleet: written.fleet,
            session: written.session,
            vehicle: written.vehicle,
            sent: Duration::from_micros(written.sent_us),
            neighbour,
            is_parked: written.parked,
            heard: written.heard.iter().map(echo).collect(),
        })
    }
}

impl Written {
    /// Whether all numbers make sense, together and alone.
    fn is_sound(&self) -> bool {
        let is_within = |numbers: &[f64], most: f64| {
            numbers.iter().all(|number| number.is_finite() && number.abs() <= most)
        };
        let is_amount = |number: f64, most: f64| is_within(&[number], most) && number >= 0.0;
        let is_claimed = |claim: &WrittenClaim| {
            is_within(&claim.to_m, FURTHEST_M) && SYSTEMS.contains(&claim.first_system)
        };
        let is_time = |time_us: u64| time_us < LATEST_US;
        SYSTEMS.contains(&self.system)
            && is_within(&self.place_m, FURTHEST_M)
            && is_within(&self.velocity_m_s, FASTEST_M_S)
            && is_amount(self.uncertainty_m, FURTHEST_M)
            && is_amount(self.separation_m, WIDEST_M)
            && self.claim.as_ref().is_none_or(is_claimed)
            && is_time(self.sent_us)
            && self.measured_us <= self.sent_us
            && self.heard.len() <= MOST_ECHOES
            && self.heard.iter().all(|echo| is_time(echo.sent_us) && is_time(echo.held_us))
            // Who has left its drone on the ground does not fly it.
            && (!self.parked || matches!(self.presence, WrittenPresence::Stands))
    }
}

/// To a millimetre, so that the text is short.
fn rounded(vector: Vector2<f64>) -> [f64; 2] {
    vector.map(|number| (number * 1000.0).round() / 1000.0).into()
}

fn micros(time: Duration) -> u64 {
    u64::try_from(time.as_micros()).unwrap_or(u64::MAX)
}

#[cfg(test)]
pub(super) mod tests {
    use proptest::prelude::*;
    use serde_json::{Value, json};

    use super::*;

    pub(in crate::network) fn state() -> State {
        State {
            fleet: Digest([0xab; 8]),
            session: Session(0x1234),
            vehicle: "left".parse().unwrap(),
            sent: Duration::from_secs(5),
            neighbour: Neighbour {
                system: 1,
                at: Duration::from_millis(4980),
                place_m: Vector2::new(-2.5, 0.25),
                velocity_m_s: Vector2::new(0.5, -0.25),
                uncertainty_m: 0.125,
                separation_m: 1.5,
                presence: Presence::Flies,
                claim: Some(Claim {
                    to_m: Vector2::new(2.5, 0.0),
                    rank: Rank { system: 1, behind: 0 },
                }),
            },
            is_parked: false,
            heard: vec![Echo {
                session: Session(u64::MAX),
                sent: Duration::from_micros(77),
                held: Duration::from_micros(1200),
            }],
        }
    }

    #[test]
    fn a_state_is_plain_json_and_read_again() {
        let text = state().encode().unwrap();
        assert_eq!(State::decode(text.as_bytes()), Ok(state()));
        let object: Value = serde_json::from_str(&text).unwrap();
        let expected = json!({
            "version": 1,
            "fleet": "abababababababab",
            "session": "0000000000001234",
            "vehicle": "left",
            "system": 1,
            "sent_us": 5_000_000,
            "measured_us": 4_980_000,
            "place_m": [-2.5, 0.25],
            "velocity_m_s": [0.5, -0.25],
            "uncertainty_m": 0.125,
            "separation_m": 1.5,
            "presence": "flies",
            "claim": { "to_m": [2.5, 0.0], "first_system": 1, "behind": 0 },
            "parked": false,
            "heard": [{ "session": "ffffffffffffffff", "sent_us": 77, "held_us": 1200 }],
        });
        assert_eq!(object, expected);
    }

    #[test]
    fn what_is_no_state_is_refused_with_its_reason() {
        let good: Value = serde_json::from_str(&state().encode().unwrap()).unwrap();
        let decode = |key: &str, value: Value| {
            let mut object = good.clone();
            object[key] = value;
            State::decode(object.to_string().as_bytes()).map(|_| ())
        };
        assert_eq!(decode("version", json!(1)), Ok(()));
        assert_eq!(decode("version", json!(2)), Err(Unreadable::Version(2)));
        for (key, value) in [
            ("place_m", json!([1e9, 0])),
            ("velocity_m_s", json!([0, 31])),
            ("uncertainty_m", json!(-0.1)),
            ("uncertainty_m", json!(1e300)),
            ("separation_m", json!(21)),
            ("separation_m", json!(-1)),
            ("system", json!(0)),
            ("system", json!(251)),
            ("measured_us", json!(5_000_001)),
            ("sent_us", json!(1_u64 << 53)),
            ("claim", json!({ "to_m": [1001, 0], "first_system": 1, "behind": 0 })),
            ("claim", json!({ "to_m": [0, 0], "first_system": 0, "behind": 0 })),
            ("parked", json!(true)),
            (
                "heard",
                json!([{ "session": "0000000000000001", "sent_us": 1, "held_us": 1_u64 << 60 }]),
            ),
        ] {
            assert_eq!(decode(key, value.clone()), Err(Unreadable::Absurd), "{key} {value}");
        }
        for (key, value) in [
            ("place_m", json!([0])),
            ("place_m", json!(["0", 0])),
            ("uncertainty_m", Value::Null),
            ("presence", json!("hovers")),
            ("vehicle", json!("../left")),
            ("session", json!("+000000000000001")),
            ("session", json!("1")),
            ("fleet", json!("abab")),
            ("system", json!(256)),
            ("sent_us", json!(-1)),
        ] {
            assert_eq!(decode(key, value.clone()), Err(Unreadable::Malformed), "{key} {value}");
        }
        for text in
            ["", "[]", "{}", "null", "1e999", "{\"version\":1}", "\u{0}", "{\"version\":-1}"]
        {
            assert_eq!(State::decode(text.as_bytes()), Err(Unreadable::Malformed), "{text:?}");
        }
        let text = state().encode().unwrap().replace("-2.5", "1e999");
        assert_eq!(State::decode(text.as_bytes()), Err(Unreadable::Malformed));
    }

    #[test]
    fn length_is_looked_at_first() {
        let text = state().encode().unwrap();
        let padded = |length: usize| text.clone() + &" ".repeat(length - text.len());
        assert!(State::decode(padded(STATE_BYTES).as_bytes()).is_ok());
        assert_eq!(State::decode(padded(STATE_BYTES + 1).as_bytes()), Err(Unreadable::TooLong));
    }

    #[test]
    fn what_makes_no_sense_is_not_told() {
        for wrong in [f64::NAN, f64::INFINITY, 2000.0] {
            let mut state = state();
            state.neighbour.place_m.x = wrong;
            assert_eq!(state.encode(), None, "{wrong}");
        }
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..1100)) {
            _ = State::decode(&bytes);
        }

        /// Cut, doubled or changed text is refused or a state whose text is read again.
        #[test]
        fn damaged_text_is_refused_or_sound(at in 0_usize..500, byte in any::<u8>(), cut in 0_usize..500) {
            let mut text = state().encode().unwrap().into_bytes();
            let at = at % text.len();
            text[at] = byte;
            for text in [&text[..], &text[..cut.min(text.len())]] {
                if let Ok(read) = State::decode(text) {
                    prop_assert!(read.encode().is_some());
                }
            }
        }

        #[test]
        fn the_longest_state_fits(
            numbers in proptest::collection::vec(-999.9999_f64..999.9999, 5),
            speeds in proptest::collection::vec(-29.9999_f64..29.9999, 2),
        ) {
            let latest = Duration::from_micros(LATEST_US - 1);
            let echo = Echo { session: Session(u64::MAX), sent: latest, held: latest };
            let state = State {
                vehicle: "abcdefghijklmnop".parse().unwrap(),
                sent: latest,
                neighbour: Neighbour {
                    system: 250,
                    at: latest,
                    place_m: Vector2::new(numbers[0], numbers[1]),
                    velocity_m_s: Vector2::new(speeds[0], speeds[1]),
                    uncertainty_m: numbers[2].abs(),
                    separation_m: 19.9991,
                    presence: Presence::Stands,
                    claim: Some(Claim {
                        to_m: Vector2::new(numbers[3], numbers[4]),
                        rank: Rank { system: 250, behind: 255 },
                    }),
                },
                heard: vec![echo; MOST_ECHOES],
                ..state()
            };
            let text = state.encode().unwrap();
            prop_assert!(text.len() <= STATE_BYTES, "{}", text.len());
            let read = State::decode(text.as_bytes()).unwrap();
            prop_assert!(read.encode().is_some());
            prop_assert!(read.neighbour.uncertainty_m >= state.neighbour.uncertainty_m);
        }
    }
}
