//! The options of a packet, one struct for each tag.
//!
//! Layouts, units and signs follow Parrot's `navdata_common.h` and were checked against captures of real
//! drones. Quantities are in SI units and degrees, with the unit in the name; fields without a unit are raw
//! numbers of the firmware.

mod control;
mod flight;
mod gps;
mod sensors;
mod system;
mod vision;

use bytes::BufMut;

pub use control::{Altitude, Pwm, RcReferences, References, Trims};
pub use flight::{Demo, EulerAngles, Time};
pub use gps::{Gps, GpsFix};
pub use sensors::{
    GyroOffsets, KalmanPressure, Magneto, PhysicalMeasures, PressureRaw, RawMeasures, WindSpeed,
};
pub use system::{AdcDataFrame, Games, HdVideoStream, VideoStream, Watchdog, Wifi, Zimmu3000};
pub use vision::{TrackersSend, Vision, VisionDetect, VisionFlow, VisionPerformance, VisionRaw};

/// One option of a packet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NavdataOption<'a> {
    /// Tag 0: attitude, altitude, velocity, battery.
    Demo(Demo),
    /// Tag 1: the drone's clock.
    Time(Time),
    /// Tag 2: raw sensor readings.
    RawMeasures(RawMeasures),
    /// Tag 3: accelerometers and gyroscopes, calibrated.
    PhysicalMeasures(PhysicalMeasures),
    /// Tag 4: gyroscope readings at rest.
    GyroOffsets(GyroOffsets),
    /// Tag 5: attitude by the accelerometers alone.
    EulerAngles(EulerAngles),
    /// Tag 6: setpoints of the controller.
    References(References),
    /// Tag 7: level corrections.
    Trims(Trims),
    /// Tag 8: a radio control's sticks.
    RcReferences(RcReferences),
    /// Tag 9: the motors.
    Pwm(Pwm),
    /// Tag 10: the altitude estimator.
    Altitude(Altitude),
    /// Tag 11: translation by vision, raw.
    VisionRaw(VisionRaw),
    /// Tag 12: optical flow.
    VisionFlow(VisionFlow),
    /// Tag 13: velocity by vision.
    Vision(Vision),
    /// Tag 14: duration of the vision algorithms.
    VisionPerformance(VisionPerformance),
    /// Tag 15: points tracked by vision.
    TrackersSend(TrackersSend),
    /// Tag 16: detected roundels and tags.
    VisionDetect(VisionDetect),
    /// Tag 17: watchdog of the controller.
    Watchdog(Watchdog),
    /// Tag 18: a frame of the analogue converter.
    AdcDataFrame(AdcDataFrame),
    /// Tag 19: the live video.
    VideoStream(VideoStream),
    /// Tag 20: Parrot's games.
    Games(Games),
    /// Tag 21: the barometer.
    PressureRaw(PressureRaw),
    /// Tag 22: the compass.
    Magneto(Magneto),
    /// Tag 23: the drone's estimate of the wind.
    WindSpeed(WindSpeed),
    /// Tag 24: altitude by pressure.
    KalmanPressure(KalmanPressure),
    /// Tag 25: the recorded video.
    HdVideoStream(HdVideoStream),
    /// Tag 26: the radio link.
    Wifi(Wifi),
    /// Tag 27 in its 12-byte form.
    Zimmu3000(Zimmu3000),
    /// Tag 27 in its 216-byte form: the flight recorder's GPS.
    Gps(Gps),
    /// Any other tag, or a known one with an unknown size.
    Unknown {
        /// The option's tag.
        tag: u16,
        /// Its payload, without tag and size.
        payload: &'a [u8],
    },
}

macro_rules! table {
    ($($variant:ident = $tag:literal,)*) => {
        impl<'a> NavdataOption<'a> {
            /// Decodes an option other than the checksum. An unknown size is not an error: the bytes are
            /// kept.
            pub fn decode(tag: u16, payload: &'a [u8]) -> Self {
                let unknown = Self::Unknown { tag, payload };
                match tag {
                    $($tag => $variant::read(payload).map_or(unknown, Self::$variant),)*
                    // Two options share this tag and differ only in size.
                    TAG_GPS if payload.len() == Gps::EXACT_BYTES => {
                        Gps::read(payload).map_or(unknown, Self::Gps)
                    }
                    TAG_GPS if payload.len() == Zimmu3000::EXACT_BYTES => {
                        Zimmu3000::read(payload).map_or(unknown, Self::Zimmu3000)
                    }
                    _ => unknown,
                }
            }

            /// The option's tag.
            pub fn tag(&self) -> u16 {
                match self {
                    $(Self::$variant(_) => $tag,)*
                    Self::Gps(_) | Self::Zimmu3000(_) => TAG_GPS,
                    Self::Unknown { tag, .. } => *tag,
                }
            }

            /// Encodes the option without tag and size.
            pub(super) fn write(&self, out: &mut impl BufMut) {
                match self {
                    $(Self::$variant(option) => option.write(out),)*
                    Self::Gps(option) => option.write(out),
                    Self::Zimmu3000(option) => option.write(out),
                    Self::Unknown { payload, .. } => out.put_slice(payload),
                }
            }
        }
    };
}

const TAG_GPS: u16 = 27;

table! {
    Demo = 0,
    Time = 1,
    RawMeasures = 2,
    PhysicalMeasures = 3,
    GyroOffsets = 4,
    EulerAngles = 5,
    References = 6,
    Trims = 7,
    RcReferences = 8,
    Pwm = 9,
    Altitude = 10,
    VisionRaw = 11,
    VisionFlow = 12,
    Vision = 13,
    VisionPerformance = 14,
    TrackersSend = 15,
    VisionDetect = 16,
    Watchdog = 17,
    AdcDataFrame = 18,
    VideoStream = 19,
    Games = 20,
    PressureRaw = 21,
    Magneto = 22,
    WindSpeed = 23,
    KalmanPressure = 24,
    HdVideoStream = 25,
    Wifi = 26,
}
