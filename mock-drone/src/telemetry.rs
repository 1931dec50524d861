//! Content of navdata: every option of a packet, from the sensor readings.

use std::time::Duration;

use ardrone_link::at::Motion;
use ardrone_link::navdata::{
    AdcDataFrame, Altitude, Demo, EulerAngles, Games, Gps, GyroOffsets, HdVideoStream,
    KalmanPressure, Magneto, NavdataError, NavdataOption, PacketWriter, PhysicalMeasures,
    PressureRaw, Pwm, RawMeasures, RcReferences, References, Time, TrackersSend, Trims,
    VideoStream, Vision, VisionDetect, VisionFlow, VisionPerformance, VisionRaw, Watchdog, Wifi,
    WindSpeed, Zimmu3000,
};
use nalgebra::Vector2;

use crate::airframe::{Airframe, GRAVITY_M_S2};
use crate::firmware::{Firmware, Phase};
use crate::lies::Lies;
use crate::sensors::Reading;

/// Content of option 27, in which firmware versions differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tag27 {
    /// Nothing, which every client understands.
    #[default]
    Absent,
    /// 12 bytes, as in older firmware; some clients then lose every packet.
    Zimmu,
    /// 216 bytes of GPS, as in firmware 2.4 with a flight recorder; other clients then lose every packet.
    Gps,
}

/// Sources of navdata.
pub(crate) struct Telemetry<'a> {
    pub(crate) firmware: &'a Firmware,
    pub(crate) airframe: &'a Airframe,
    pub(crate) reading: Reading,
    /// Detections in the pictures.
    pub(crate) tags: VisionDetect,
    /// Detail of the control state; 0 if there is none.
    pub(crate) minor_state: u16,
    pub(crate) wind_m_s: Vector2<f64>,
    /// The drone's own clock.
    pub(crate) clock: Duration,
    pub(crate) tag_27: Tag27,
    pub(crate) gps_error_m: Vector2<f64>,
}

/// Battery voltage when empty, and the difference to a full charge.
const EMPTY_V: f64 = 9.9;
const CHARGE_V: f64 = 2.6;
/// Height of the ultrasound sensor when the drone stands.
const SENSOR_HEIGHT_M: f64 = 0.24;
const SEA_LEVEL_PA: f64 = 101_325.0;
const PASCALS_PER_METRE: f64 = 12.0;

impl Telemetry<'_> {
    /// Writes the requested options, in the order of their tags.
    pub(crate) fn write(
        &self,
        wanted: impl Fn(u16) -> bool,
        packet: &mut PacketWriter<'_>,
    ) -> Result<(), NavdataError> {
        (0..=27)
            .filter(|tag| wanted(*tag))
            .filter_map(|tag| self.option(tag))
            .try_for_each(|option| packet.option(&option))
    }

    fn option(&self, tag: u16) -> Option<NavdataOption<'static>> {
        Some(match tag {
            0 => NavdataOption::Demo(self.demo()),
            1 => NavdataOption::Time(Time { since_start: self.clock }),
            2 if self.firmware.lies().contains(Lies::SHORT_OPTION) => {
                NavdataOption::Unknown { tag, payload: &[0; 44] }
            }
            2 => NavdataOption::RawMeasures(self.raw_measures()),
            3 => NavdataOption::PhysicalMeasures(self.physical_measures()),
            5 => NavdataOption::EulerAngles(EulerAngles {
                pitch_deg: self.reading.pitch_deg,
                roll_deg: self.reading.roll_deg,
            }),
            6 => NavdataOption::References(self.references()),
            7 => NavdataOption::Trims(Trims::default()),
            9 => NavdataOption::Pwm(self.pwm()),
            10 => NavdataOption::Altitude(self.altitude()),
            13 => NavdataOption::Vision(self.vision()),
            16 => NavdataOption::VisionDetect(self.tags),
            17 => NavdataOption::Watchdog(Watchdog { watchdog: 4822 }),
            21 => NavdataOption::PressureRaw(self.pressure()),
            22 => NavdataOption::Magneto(self.magneto()),
            23 => NavdataOption::WindSpeed(self.wind()),
            24 => NavdataOption::KalmanPressure(KalmanPressure {
                offset_pa: single(SEA_LEVEL_PA),
                ..KalmanPressure::default()
            }),
            27 => match self.tag_27 {
                Tag27::Absent => return None,
                Tag27::Zimmu => NavdataOption::Zimmu3000(Zimmu3000::default()),
                Tag27::Gps => NavdataOption::Gps(self.gps()),
            },
            // Options without a counterpart in the simulation are zero.
            4 => NavdataOption::GyroOffsets(GyroOffsets::default()),
            8 => NavdataOption::RcReferences(RcReferences::default()),
            11 => NavdataOption::VisionRaw(VisionRaw::default()),
            12 => NavdataOption::VisionFlow(VisionFlow::default()),
            14 => NavdataOption::VisionPerformance(VisionPerformance::default()),
            15 => NavdataOption::TrackersSend(TrackersSend::default()),
            18 => NavdataOption::AdcDataFrame(AdcDataFrame::default()),
            19 => NavdataOption::VideoStream(VideoStream::default()),
            20 => NavdataOption::Games(Games::default()),
            25 => NavdataOption::HdVideoStream(HdVideoStream::default()),
            26 => NavdataOption::Wifi(Wifi::default()),
            _ => return None,
        })
    }

    /// A receiver somewhere in Paris, with north where the drone looked at its start.
    fn gps(&self) -> Gps {
        const METRES_PER_DEGREE: f64 = 111_320.0;
        const START_DEG: [f64; 2] = [48.879_12, 2.367_77];
        const START_M: f64 = 61.0;
        let place_m = self.airframe.position_m();
        let across_m = place_m.xy() + self.gps_error_m;
        let [latitude_deg, longitude_deg] = START_DEG;
        let east_deg = across_m.x / (METRES_PER_DEGREE * latitude_deg.to_radians().cos());
        Gps {
            latitude_deg: latitude_deg + across_m.y / METRES_PER_DEGREE,
            longitude_deg: longitude_deg + east_deg,
            elevation_m: START_M + place_m.z,
            start_latitude_deg: latitude_deg,
            start_longitude_deg: longitude_deg,
            horizontal_dilution: 1.0,
            horizontal_error_m: single(3.35),
            data_available: 7,
            plugged: 1,
            satellite_count: 8,
            ..Gps::default()
        }
    }

    fn demo(&self) -> Demo {
        // A percentage fits.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let battery_percent = self.firmware.battery_percent().round() as u32;
        let in_millivolts = self.firmware.lies().contains(Lies::CHARGE_IN_MILLIVOLTS);
        let battery_percent =
            if in_millivolts { 9_900 + 26 * battery_percent } else { battery_percent };
        Demo {
            control_state_minor: self.minor_state,
            control_state: self.firmware.control_state(),
            battery_percent,
            pitch_deg: self.reading.pitch_deg,
            roll_deg: self.reading.roll_deg,
            yaw_deg: self.reading.yaw_deg,
            altitude_m: self.reading.altitude_m,
            velocity_forward_m_s: self.reading.velocity_m_s.y,
            velocity_right_m_s: self.reading.velocity_m_s.x,
            detection_camera_type: 3,
            ..Demo::default()
        }
    }

    fn raw_measures(&self) -> RawMeasures {
        RawMeasures {
            accelerometers: [2040, 2036, 2528],
            battery_v: EMPTY_V + CHARGE_V * self.firmware.battery_percent() / 100.0,
            altitude_m: self.reading.altitude_m + SENSOR_HEIGHT_M,
            echo_count: 1,
            ..RawMeasures::default()
        }
    }

    fn physical_measures(&self) -> PhysicalMeasures {
        let (pitch, roll) =
            (self.reading.pitch_deg.to_radians(), self.reading.roll_deg.to_radians());
        // Tilt is told wrongly then, but not felt.
        let felt_pitch = if self.firmware.lies().contains(Lies::TILTED) {
            10_f64.to_radians() - pitch
        } else {
            pitch
        };
        let down = if self.firmware.lies().contains(Lies::GRAVITY_UP) { 1.0 } else { -1.0 };
        let rates_deg_s = self.airframe.angular_rate_rad_s().map(f64::to_degrees);
        PhysicalMeasures {
            accelerometer_temperature_celsius: 45.0,
            gyroscope_temperature: 55_738,
            acceleration_m_s2: [
                GRAVITY_M_S2 * felt_pitch.sin(),
                -GRAVITY_M_S2 * felt_pitch.cos() * roll.sin(),
                down * GRAVITY_M_S2 * felt_pitch.cos() * roll.cos(),
            ],
            angular_rate_deg_s: [rates_deg_s.x, rates_deg_s.y, rates_deg_s.z].map(single),
            ..PhysicalMeasures::default()
        }
    }

    fn references(&self) -> References {
        let (roll, pitch) = match self.firmware.motion() {
            Motion::Hover => (0.0, 0.0),
            Motion::Progressive { roll, pitch, .. } => (roll.get(), pitch.get()),
        };
        References { input_roll: roll, input_pitch: pitch, ..References::default() }
    }

    fn pwm(&self) -> Pwm {
        let turning = !matches!(self.firmware.phase(), Phase::Landed | Phase::Emergency);
        let (motor, current_a) = if turning { (160, 2.1) } else { (0, 0.0) };
        Pwm {
            motors: [motor; 4],
            saturated_motors: [255; 4],
            current_a: [current_a; 4],
            ..Pwm::default()
        }
    }

    fn altitude(&self) -> Altitude {
        Altitude {
            vision_m: self.reading.altitude_m,
            climb_m_s: self.airframe.velocity_m_s().z,
            raw_m: self.reading.altitude_m + SENSOR_HEIGHT_M,
            ..Altitude::default()
        }
    }

    fn vision(&self) -> Vision {
        Vision {
            state: 2,
            capture_pitch: single(self.reading.pitch_deg.to_radians()),
            capture_roll: single(self.reading.roll_deg.to_radians()),
            capture_yaw_rad: single(self.reading.yaw_deg.to_radians()),
            capture_altitude_m: self.reading.altitude_m,
            velocity_m_s: [self.reading.velocity_m_s.y, self.reading.velocity_m_s.x, 0.0],
            ..Vision::default()
        }
    }

    fn pressure(&self) -> PressureRaw {
        let pressure_pa = SEA_LEVEL_PA - PASCALS_PER_METRE * self.airframe.position_m().z;
        // Pressures of the lower atmosphere fit.
        #[allow(clippy::cast_possible_truncation)]
        let pressure_pa = pressure_pa.round() as i32;
        PressureRaw {
            uncompensated_pressure: 39_148,
            uncompensated_temperature: 32_556,
            temperature_celsius: 43.5,
            pressure_pa,
        }
    }

    fn magneto(&self) -> Magneto {
        let heading_deg = single(self.reading.yaw_deg);
        Magneto {
            heading_deg,
            gyroscope_heading_deg: heading_deg,
            fused_heading_deg: heading_deg,
            calibrated: 1,
            calibration_state: 2,
            radius_ut: 38.7,
            ..Magneto::default()
        }
    }

    fn wind(&self) -> WindSpeed {
        // Direction from which it blows; zero without wind.
        let still = self.wind_m_s == Vector2::zeros();
        let from_deg = (-self.wind_m_s.x).atan2(-self.wind_m_s.y).to_degrees();
        let from_deg = if still { 0.0 } else { from_deg };
        WindSpeed {
            speed_m_s: single(self.wind_m_s.norm()),
            direction_deg: single(from_deg),
            ..WindSpeed::default()
        }
    }
}

#[allow(clippy::cast_possible_truncation, reason = "the wire carries single precision")]
fn single(value: f64) -> f32 {
    value as f32
}
