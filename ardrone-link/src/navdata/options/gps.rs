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

impl Gps {
    pub(super) const EXACT_BYTES: usize = Self::PAYLOAD_BYTES;
}
