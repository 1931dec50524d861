//! Packets: header, options, checksum.

use std::time::Duration;

use bytes::{BufMut, BytesMut};
use nom::bytes::complete::take;
use nom::number::complete::{le_f32, le_i32, le_u16, le_u32};
use nom::{IResult, Parser};

use super::state::{ControlState, DroneState};

const MAGIC: u32 = 0x5566_7788;
/// The firmware's own buffer; nothing longer is navdata.
const MAX_PACKET_BYTES: usize = 4096;
const OPTION_HEADER_BYTES: usize = 4;
const DEMO_BYTES: u16 = 148;
const TIME_BYTES: u16 = 8;
const CHECKSUM_BYTES: u16 = 8;

/// Tag of the demo option: attitude, altitude, velocity, battery.
pub const OPTION_DEMO: u16 = 0;
/// Tag of the drone's clock.
pub const OPTION_TIME: u16 = 1;
/// Tag of the detected targets, part of the demo set.
pub const OPTION_VISION_DETECT: u16 = 16;
const OPTION_CHECKSUM: u16 = 0xFFFF;

/// One navdata packet. What was not sent is `None`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Navdata {
    /// The state bits.
    pub state: DroneState,
    /// Counts packets; starts again when the drone does.
    pub sequence: u32,
    /// The header's vision word.
    pub vision: u32,
    /// Attitude, altitude, velocity, battery.
    pub demo: Option<Demo>,
    /// The drone's clock, which wraps after 2048 s.
    pub time: Option<Duration>,
}

/// The demo option in SI units. Body frame: forward, right, down.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Demo {
    /// What the drone's controller is doing.
    pub control_state: ControlState,
    /// A detail of it.
    pub control_state_minor: u16,
    /// Remaining charge.
    pub battery_percent: u32,
    /// Nose up positive.
    pub pitch_deg: f64,
    /// Right side down positive.
    pub roll_deg: f64,
    /// Clockwise from above positive, in [-180, 180]; zero is where the drone chose it to be.
    pub yaw_deg: f64,
    /// Above the ground below.
    pub altitude_m: f64,
    /// Forward, levelled body frame.
    pub velocity_forward_m_s: f64,
    /// Right, levelled body frame.
    pub velocity_right_m_s: f64,
    /// Down; zero in every known capture.
    pub velocity_down_m_s: f64,
}

/// Why a packet was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NavdataError {
    /// The packet or one of its options ends early.
    #[error("navdata ends within its {part}")]
    Truncated {
        /// What was being read.
        part: &'static str,
    },
    /// It does not start with the navdata magic number.
    #[error("not navdata: starts with {found:#010x}")]
    Magic {
        /// The first word.
        found: u32,
    },
    /// An option says that it is shorter than its own header, or longer than the packet.
    #[error("navdata option {tag} with impossible size {size}")]
    OptionSize {
        /// The option's tag.
        tag: u16,
        /// The size it claims.
        size: u16,
    },
    /// The sum does not fit.
    #[error("navdata checksum is {found:#010x}, the bytes sum to {computed:#010x}")]
    Checksum {
        /// What the packet says.
        found: u32,
        /// What its bytes sum to.
        computed: u32,
    },
    /// More bytes than the firmware ever sends.
    #[error("navdata packet of {bytes} bytes")]
    TooLong {
        /// The datagram's length.
        bytes: usize,
    },
}

impl Navdata {
    /// Reads a packet. Unknown options are skipped, longer ones than known are read as far as
    /// known.
    ///
    /// # Errors
    /// [`NavdataError`]: nothing of a damaged packet is used.
    pub fn decode(packet: &[u8]) -> Result<Self, NavdataError> {
        if packet.len() > MAX_PACKET_BYTES {
            return Err(NavdataError::TooLong { bytes: packet.len() });
        }
        let (mut options, (magic, state, sequence, vision)) =
            parse((le_u32, le_u32, le_u32, le_u32), packet, "header")?;
        if magic != MAGIC {
            return Err(NavdataError::Magic { found: magic });
        }
        let state = DroneState::from_bits_retain(state);
        let mut navdata = Self { state, sequence, vision, ..Self::default() };
        loop {
            let before = packet.len() - options.len();
            let (_, (tag, size)) = parse((le_u16, le_u16), options, "option header")?;
            if usize::from(size) < OPTION_HEADER_BYTES || usize::from(size) > options.len() {
                return Err(NavdataError::OptionSize { tag, size });
            }
            let (option, rest) = options.split_at(usize::from(size));
            let payload = &option[OPTION_HEADER_BYTES..];
            match tag {
                OPTION_CHECKSUM => {
                    let (_, found) = parse(le_u32, payload, "checksum")?;
                    let computed = checksum(&packet[..before]);
                    if found != computed {
                        return Err(NavdataError::Checksum { found, computed });
                    }
                    return Ok(navdata);
                }
                OPTION_DEMO => navdata.demo = Some(parse(demo, payload, "demo option")?.1),
                OPTION_TIME => {
                    let (_, word) = parse(le_u32, payload, "time option")?;
                    navdata.time = Some(time_from_word(word));
                }
                _ => {}
            }
            options = rest;
        }
    }

    /// Appends the packet with its checksum to `out`. `with_vision_detect` adds the (empty) list
    /// of detected targets that the firmware's demo set contains.
    pub fn encode(&self, with_vision_detect: bool, out: &mut BytesMut) {
        let start = out.len();
        for word in [MAGIC, self.state.bits(), self.sequence, self.vision] {
            out.put_u32_le(word);
        }
        if let Some(demo) = &self.demo {
            encode_demo(demo, out);
        }
        if let Some(time) = self.time {
            option_header(OPTION_TIME, TIME_BYTES, out);
            out.put_u32_le(word_from_time(time));
        }
        if with_vision_detect {
            const VISION_DETECT_BYTES: u16 = 328;
            option_header(OPTION_VISION_DETECT, VISION_DETECT_BYTES, out);
            out.put_bytes(0, usize::from(VISION_DETECT_BYTES) - OPTION_HEADER_BYTES);
        }
        let sum = checksum(&out[start..]);
        option_header(OPTION_CHECKSUM, CHECKSUM_BYTES, out);
        out.put_u32_le(sum);
    }
}

/// The plain sum of all bytes before the checksum option.
fn checksum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0_u32, |sum, byte| sum.wrapping_add(u32::from(*byte)))
}

fn parse<'a, P: Parser<&'a [u8], Error = nom::error::Error<&'a [u8]>>>(
    mut parser: P,
    bytes: &'a [u8],
    part: &'static str,
) -> Result<(&'a [u8], P::Output), NavdataError> {
    parser.parse(bytes).map_err(|_| NavdataError::Truncated { part })
}

fn demo(bytes: &[u8]) -> IResult<&[u8], Demo> {
    let (rest, (control, battery_percent)) = (le_u32, le_u32).parse(bytes)?;
    let (rest, (theta_mdeg, phi_mdeg, psi_mdeg)) = (le_f32, le_f32, le_f32).parse(rest)?;
    let (rest, altitude_mm) = le_i32(rest)?;
    let (rest, (vx_mm_s, vy_mm_s, vz_mm_s)) = (le_f32, le_f32, le_f32).parse(rest)?;
    // The rest is deprecated camera data, which must be there all the same.
    let (rest, _) = take(DEMO_REST_BYTES)(rest)?;
    let demo = Demo {
        control_state: ControlState::from_number((control >> 16) as u16),
        control_state_minor: (control & 0xFFFF) as u16,
        battery_percent,
        pitch_deg: f64::from(theta_mdeg) / 1000.0,
        roll_deg: f64::from(phi_mdeg) / 1000.0,
        yaw_deg: f64::from(psi_mdeg) / 1000.0,
        altitude_m: f64::from(altitude_mm) / 1000.0,
        velocity_forward_m_s: f64::from(vx_mm_s) / 1000.0,
        velocity_right_m_s: f64::from(vy_mm_s) / 1000.0,
        velocity_down_m_s: f64::from(vz_mm_s) / 1000.0,
    };
    Ok((rest, demo))
}

/// Bytes of the demo option behind the velocity.
const DEMO_REST_BYTES: usize = DEMO_BYTES as usize - OPTION_HEADER_BYTES - 36;

fn encode_demo(demo: &Demo, out: &mut BytesMut) {
    option_header(OPTION_DEMO, DEMO_BYTES, out);
    let major = u32::from(demo.control_state.number());
    out.put_u32_le(major << 16 | u32::from(demo.control_state_minor));
    out.put_u32_le(demo.battery_percent);
    for angle_deg in [demo.pitch_deg, demo.roll_deg, demo.yaw_deg] {
        out.put_f32_le(thousandths(angle_deg));
    }
    // `as` saturates, and no altitude comes near the limits.
    #[allow(clippy::cast_possible_truncation)]
    out.put_i32_le((demo.altitude_m * 1000.0).round() as i32);
    for velocity_m_s in [demo.velocity_forward_m_s, demo.velocity_right_m_s, demo.velocity_down_m_s]
    {
        out.put_f32_le(thousandths(velocity_m_s));
    }
    out.put_bytes(0, DEMO_REST_BYTES);
}

#[allow(clippy::cast_possible_truncation, reason = "the wire carries single precision")]
fn thousandths(value: f64) -> f32 {
    (value * 1000.0) as f32
}

fn option_header(tag: u16, size: u16, out: &mut BytesMut) {
    out.put_u16_le(tag);
    out.put_u16_le(size);
}

/// The top 11 bits are seconds, the low 21 bits microseconds.
fn time_from_word(word: u32) -> Duration {
    Duration::from_secs(u64::from(word >> 21)) + Duration::from_micros(u64::from(word & 0x1F_FFFF))
}

/// The time of a packet as the drone's clock shows it: it wraps after 2048 s.
fn word_from_time(time: Duration) -> u32 {
    let seconds = u32::try_from(time.as_secs() % 2048).unwrap_or(0);
    seconds << 21 | time.subsec_micros()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn encoded(navdata: &Navdata, with_vision_detect: bool) -> BytesMut {
        let mut bytes = BytesMut::new();
        navdata.encode(with_vision_detect, &mut bytes);
        bytes
    }

    fn example() -> Navdata {
        Navdata {
            state: DroneState::FLYING | DroneState::NAVDATA_DEMO,
            sequence: 7,
            vision: 1,
            demo: Some(Demo {
                control_state: ControlState::Hovering,
                battery_percent: 81,
                pitch_deg: -6.5,
                yaw_deg: 179.999,
                altitude_m: 0.534,
                velocity_forward_m_s: 0.046,
                ..Demo::default()
            }),
            time: Some(Duration::from_micros(362_979_125)),
        }
    }

    #[test]
    fn the_demo_set_has_the_size_that_clients_know() {
        let navdata = Navdata { time: None, ..example() };
        assert_eq!(encoded(&navdata, true).len(), 500);
        let status = Navdata { demo: None, ..navdata };
        assert_eq!(encoded(&status, false).len(), 24);
    }

    #[test]
    fn every_truncation_and_every_flipped_bit_is_refused() {
        let bytes = encoded(&example(), false);
        for length in 0..bytes.len() {
            assert!(Navdata::decode(&bytes[..length]).is_err(), "{length}");
        }
        for bit in 0..bytes.len() * 8 {
            let mut damaged = bytes.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(Navdata::decode(&damaged).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn options_of_impossible_size_end_the_packet_not_the_program() {
        for size in [0_u16, 1, 3, 0xFFFF] {
            let mut bytes = BytesMut::new();
            for word in [MAGIC, 0, 1, 0] {
                bytes.put_u32_le(word);
            }
            option_header(3, size, &mut bytes);
            assert_eq!(Navdata::decode(&bytes), Err(NavdataError::OptionSize { tag: 3, size }));
        }
    }

    #[test]
    fn unknown_and_longer_options_are_skipped() {
        let mut bytes = BytesMut::new();
        for word in [MAGIC, 0, 9, 0] {
            bytes.put_u32_le(word);
        }
        option_header(28, 6, &mut bytes);
        bytes.put_bytes(0xAB, 2);
        option_header(OPTION_TIME, 12, &mut bytes);
        bytes.put_u32_le(3 << 21 | 5);
        bytes.put_u32_le(0);
        let sum = checksum(&bytes);
        option_header(OPTION_CHECKSUM, CHECKSUM_BYTES, &mut bytes);
        bytes.put_u32_le(sum);
        let navdata = Navdata::decode(&bytes).unwrap();
        assert_eq!(navdata.time, Some(Duration::new(3, 5000)));
        assert_eq!(navdata.demo, None);
    }

    fn demo_strategy() -> impl Strategy<Value = Demo> {
        let angle = || (-180_000.0_f32..180_000.0).prop_map(|mdeg| f64::from(mdeg) / 1000.0);
        let speed = || (-5000.0_f32..5000.0).prop_map(|mm_s| f64::from(mm_s) / 1000.0);
        (
            (any::<u16>(), any::<u16>(), 0_u32..=100),
            (angle(), angle(), angle()),
            (-10_000_i32..100_000, speed(), speed(), speed()),
        )
            .prop_map(|((major, minor, battery_percent), angles, motion)| Demo {
                control_state: ControlState::from_number(major),
                control_state_minor: minor,
                battery_percent,
                pitch_deg: angles.0,
                roll_deg: angles.1,
                yaw_deg: angles.2,
                altitude_m: f64::from(motion.0) / 1000.0,
                velocity_forward_m_s: motion.1,
                velocity_right_m_s: motion.2,
                velocity_down_m_s: motion.3,
            })
    }

    proptest! {
        #[test]
        fn decoding_undoes_encoding(
            (state, sequence, vision) in any::<(u32, u32, u32)>(),
            demo in proptest::option::of(demo_strategy()),
            time_us in proptest::option::of(0_u64..2_048_000_000),
            with_vision_detect in any::<bool>(),
        ) {
            let state = DroneState::from_bits_retain(state);
            let time = time_us.map(Duration::from_micros);
            let navdata = Navdata { state, sequence, vision, demo, time };
            prop_assert_eq!(Navdata::decode(&encoded(&navdata, with_vision_detect)), Ok(navdata));
        }

        #[test]
        fn any_bytes_are_decoded_or_refused(
            mut bytes in proptest::collection::vec(any::<u8>(), 0..300),
            with_magic in any::<bool>(),
        ) {
            if with_magic && bytes.len() >= 4 {
                bytes[..4].copy_from_slice(&MAGIC.to_le_bytes());
            }
            _ = Navdata::decode(&bytes);
        }
    }
}
