//! Sensors, raw and calibrated, and estimates based on them.

use crate::navdata::wire::{Milli, MilliGravity, Tenth, option};

option! {
    /// Raw sensor readings.
    RawMeasures, 52 {
        /// Accelerometer counts, forward, right, down.
        accelerometers: [u16; 3] as [u16; 3],
        /// Gyroscope counts, roll, pitch, yaw.
        gyroscopes: [i16; 3] as [i16; 3],
        /// Counts of the slow gyroscope outputs.
        gyroscopes_110: [i16; 2] as [i16; 2],
        /// Battery.
        battery_v: f64 as Milli<u32>,
        /// Ultrasound: start of the echo.
        echo_start: u16 as u16,
        /// Ultrasound: end of the echo.
        echo_end: u16 as u16,
        /// Ultrasound: which echo was taken.
        echo_association: u16 as u16,
        /// Ultrasound: distance of the echo.
        echo_distance: u16 as u16,
        /// Ultrasound: time of the curve.
        curve_time: u16 as u16,
        /// Ultrasound: value of the curve.
        curve_value: u16 as u16,
        /// Ultrasound: reference of the curve.
        curve_reference: u16 as u16,
        /// Ultrasound: whether the echo is the first.
        echo_initialised: u16 as u16,
        /// Ultrasound: number of echoes.
        echo_count: u16 as u16,
        /// Ultrasound: sum of the echoes.
        echo_sum: u32 as u32,
        /// Ultrasound: altitude before any filter.
        altitude_m: f64 as Milli<i32>,
        /// Ultrasound: slope of the echo.
        gradient: i16 as i16,
    }
}

option! {
    /// Accelerometers and gyroscopes, calibrated.
    PhysicalMeasures, 46 {
        /// Of the accelerometers.
        accelerometer_temperature_celsius: f32 as f32,
        /// Raw temperature of the gyroscopes.
        gyroscope_temperature: u16 as u16,
        /// Forward, right, down; at rest the reaction to gravity, -9.8 on the last.
        acceleration_m_s2: [f64; 3] as [MilliGravity<f32>; 3],
        /// Roll, pitch, yaw.
        angular_rate_deg_s: [f32; 3] as [f32; 3],
        /// Raw supply voltage.
        supply: u32 as u32,
        /// Raw reference voltage of the yaw gyroscope.
        yaw_reference: u32 as u32,
        /// Raw reference voltage of the other gyroscopes.
        tilt_reference: u32 as u32,
    }
}

option! {
    /// Gyroscope readings at rest.
    GyroOffsets, 16 {
        /// Raw, roll, pitch, yaw.
        offsets: [f32; 3] as [f32; 3],
    }
}

option! {
    /// The barometer.
    PressureRaw, 18 {
        /// Uncompensated pressure.
        uncompensated_pressure: i32 as i32,
        /// Uncompensated temperature.
        uncompensated_temperature: i16 as i16,
        /// Compensated.
        temperature_celsius: f64 as Tenth<i32>,
        /// Compensated.
        pressure_pa: i32 as i32,
    }
}

option! {
    /// The compass.
    Magneto, 75 {
        /// Counts, forward, right, down.
        counts: [i16; 3] as [i16; 3],
        /// As measured.
        raw_ut: [f64; 3] as [Tenth<f32>; 3],
        /// Corrected by the calibration.
        rectified_ut: [f64; 3] as [Tenth<f32>; 3],
        /// The calibration's correction.
        offset_ut: [f64; 3] as [Tenth<f32>; 3],
        /// By the compass alone, not wrapped.
        heading_deg: f32 as f32,
        /// By the gyroscope alone, not wrapped.
        gyroscope_heading_deg: f32 as f32,
        /// By both, not wrapped.
        fused_heading_deg: f32 as f32,
        /// Not zero if the compass is calibrated.
        calibrated: u8 as u8,
        /// State of the calibration.
        calibration_state: u32 as u32,
        /// Radius of the calibration's sphere.
        radius_ut: f64 as Tenth<f32>,
        /// Mean of the calibration's error.
        error_mean: f32 as f32,
        /// Variance of the calibration's error.
        error_variance: f32 as f32,
    }
    newer {
        /// Mean and variance of the error found in the background.
        background_error: [f32; 2] as [f32; 2]
    }
}

option! {
    /// The drone's estimate of the wind, outdoors only.
    WindSpeed, 56 {
        /// Of the wind.
        speed_m_s: f32 as f32,
        /// Direction it comes from; degrees in recordings, although Parrot's comment says radians.
        direction_deg: f32 as f32,
        /// Tilt against the wind, pitch.
        compensation_pitch: f32 as f32,
        /// Tilt against the wind, roll.
        compensation_roll: f32 as f32,
        /// States of the estimator.
        states: [f32; 6] as [f32; 6],
        /// For debugging.
        debug: [f32; 3] as [f32; 3],
    }
    newer {
        /// Two more states.
        more_states: [f32; 2] as [f32; 2]
    }
}

option! {
    /// Altitude by pressure.
    KalmanPressure, 72 {
        /// Pressure at the start.
        offset_pa: f32 as f32,
        /// Estimated altitude.
        altitude: f32 as f32,
        /// Estimated climb.
        climb: f32 as f32,
        /// Estimated bias of the motors.
        motor_bias: f32 as f32,
        /// Estimated bias of the barometer.
        pressure_bias: f32 as f32,
        /// Offset of the ultrasound.
        ultrasound_offset: f32 as f32,
        /// Predicted ultrasound.
        ultrasound_prediction: f32 as f32,
        /// Covariance of the altitude.
        altitude_covariance: f32 as f32,
        /// Covariance of the motors' bias.
        motor_covariance: f32 as f32,
        /// Covariance of the climb.
        climb_covariance: f32 as f32,
        /// Not zero near the ground.
        ground_effect: i32 as i32,
        /// Sum of the innovations.
        innovation_sum: f32 as f32,
        /// Not zero if the ultrasound was rejected.
        ultrasound_rejected: i32 as i32,
        /// Test signal.
        test_signal: f32 as f32,
        /// Gaz by the altitude.
        altitude_gaz: f32 as f32,
        /// Not zero with a test signal.
        test_signal_on: i32 as i32,
        /// Not zero where a test signal begins.
        test_signal_start: i32 as i32,
    }
}
