//! The flight recorder's GPS, firmware 2.4.

use crate::navdata::wire::option;

option! {
    /// The flight recorder's GPS.
    Gps, 216 {
        /// North positive.
        latitude_deg: f64 as f64,
        /// East positive.
        longitude_deg: f64 as f64,
        /// Above the sea.
        elevation_m: f64 as f64,
        /// Dilution of precision, horizontal.
        horizontal_dilution: f64 as f64,
        /// Not zero if there are data.
        data_available: i32 as i32,
        /// Not zero if the start was found.
        zero_validated: i32 as i32,
        /// Not zero if a waypoint was found.
        waypoint_validated: i32 as i32,
        /// Of the start.
        start_latitude_deg: f64 as f64,
        /// Of the start.
        start_longitude_deg: f64 as f64,
        /// With the other sensors.
        fused_latitude_deg: f64 as f64,
        /// With the other sensors.
        fused_longitude_deg: f64 as f64,
        /// State of the receiver.
        state: u32 as u32,
        /// Trajectory.
        x_trajectory: f32 as f32,
        /// Reference.
        x_reference: f32 as f32,
        /// Trajectory.
        y_trajectory: f32 as f32,
        /// Reference.
        y_reference: f32 as f32,
        /// Proportional part of the pitch.
        pitch_proportional: f32 as f32,
        /// Proportional part of the roll.
        roll_proportional: f32 as f32,
        /// Integral part of the pitch.
        pitch_integral: f32 as f32,
        /// Integral part of the roll.
        roll_integral: f32 as f32,
        /// Derivative part of the pitch.
        pitch_derivative: f32 as f32,
        /// Derivative part of the roll.
        roll_derivative: f32 as f32,
        /// Dilution of precision, vertical.
        vertical_dilution: f64 as f64,
        /// Dilution of precision, of the position.
        position_dilution: f64 as f64,
        /// Over the ground.
        speed_m_s: f32 as f32,
        /// Of the last message.
        last_frame_timestamp: u32 as u32,
        /// Course over the ground.
        course_deg: f32 as f32,
        /// Course by magnetic north.
        magnetic_course_deg: f32 as f32,
        /// Expected error, horizontal.
        horizontal_error_m: f32 as f32,
        /// Expected error, vertical.
        vertical_error_m: f32 as f32,
        /// Carrier to noise.
        carrier_to_noise: f32 as f32,
        /// Satellites.
        satellite_count: u32 as u32,
        /// Number and carrier to noise of each channel.
        channels: [[u8; 2]; 12] as [[u8; 2]; 12],
        /// Not zero if the receiver is plugged in.
        plugged: i32 as i32,
        /// Whether the orbits are known.
        ephemeris_status: u32 as u32,
        /// Velocity of the trajectory.
        x_velocity: f32 as f32,
        /// Velocity of the trajectory.
        y_velocity: f32 as f32,
        /// Of the receiver.
        firmware_status: u32 as u32,
    }
}

/// Where the flight recorder's receiver is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GpsFix {
    /// North positive.
    pub latitude_deg: f64,
    /// East positive.
    pub longitude_deg: f64,
    /// Above the sea.
    pub elevation_m: f64,
    /// Error expected by the receiver, horizontal; metres in the open, more near walls.
    pub horizontal_error_m: f64,
    /// Satellites in use.
    pub satellites: u32,
}

impl Gps {
    pub(in crate::navdata) const EXACT_BYTES: usize = Self::PAYLOAD_BYTES;

    /// The position, if the receiver is plugged in and knows it. Before its first fix the firmware reports zeros, or
    /// its invalid position of 500 degrees.
    pub fn fix(&self) -> Option<GpsFix> {
        let fix = GpsFix {
            latitude_deg: self.latitude_deg,
            longitude_deg: self.longitude_deg,
            elevation_m: self.elevation_m,
            horizontal_error_m: self.horizontal_error_m.into(),
            satellites: self.satellite_count,
        };
        let is_place = fix.latitude_deg.abs() <= 90.0
            && fix.longitude_deg.abs() <= 180.0
            && (fix.latitude_deg, fix.longitude_deg) != (0.0, 0.0);
        let is_sound = fix.elevation_m.is_finite() && fix.horizontal_error_m >= 0.0;
        let is_there = self.plugged != 0 && self.data_available != 0 && fix.satellites > 0;
        (is_there && is_place && is_sound).then_some(fix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_that_is_none_is_not_reported() {
        let gps = Gps {
            plugged: 1,
            data_available: 7,
            satellite_count: 8,
            latitude_deg: 48.88,
            longitude_deg: 2.37,
            elevation_m: 61.0,
            horizontal_error_m: 3.35,
            ..Gps::default()
        };
        let fix = gps.fix().unwrap();
        assert_eq!((fix.latitude_deg, fix.longitude_deg, fix.satellites), (48.88, 2.37, 8));
        for none in [
            Gps::default(),
            Gps { plugged: 0, ..gps },
            Gps { data_available: 0, ..gps },
            Gps { satellite_count: 0, ..gps },
            Gps { latitude_deg: 500.0, longitude_deg: 500.0, ..gps },
            Gps { longitude_deg: -180.1, ..gps },
            Gps { latitude_deg: 0.0, longitude_deg: 0.0, ..gps },
            Gps { latitude_deg: f64::NAN, ..gps },
            Gps { elevation_m: f64::INFINITY, ..gps },
            Gps { horizontal_error_m: f32::NAN, ..gps },
        ] {
            assert_eq!(none.fix(), None, "{none:?}");
        }
    }
}
