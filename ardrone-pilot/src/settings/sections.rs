//! The settings, section by section.

use std::ops::RangeInclusive;

use autopilot::vehicle::{VehicleConfig, VehicleName};
use serde::{Deserialize, Serialize};

use super::section::{BitRate, Degrees, Milliseconds, Navdata, Pair, UltrasoundFrequency, section};

/// Range of gains that the estimator accepts.
const GAIN: RangeInclusive<f64> = 0.4..=2.5;

section! {
    struct Vehicle("vehicle") of VehicleConfig {
        /// Its name, in orders, messages and logs: up to 16 letters a to z, digits and hyphens, with a letter first.
        name: VehicleName = [name],
        /// Number of its MAVLink system.
        system: u8 = [system] in 1.0..=250.0,
    }
}

section! {
    struct Drone("drone") of VehicleConfig {
        /// Limits sent to the drone before each flight; full sticks command these values. Degrees; m/s; degrees/s.
        tilt_max_deg: Degrees = [estimator.limits.tilt_rad] in 1.0..=25.0,
        climb_max_m_s: f64 = [estimator.limits.climb_m_s] in 0.2..=2.0,
        turn_max_deg_s: f64 = [estimator.limits.turn_deg_s] in 40.0..=350.0,
        /// "demo": 15 packets a second; "full": 200, with all options.
        navdata: Navdata = [navdata],
        /// Whether the drone's settings are read back over its control port before it flies. If they cannot be read it
        /// is not flown. Without reading back, its acknowledgements are trusted.
        read_back: bool = [read_back],
        /// Whether the position by a flight recorder is asked for. It is shown and recorded; nothing is flown by it.
        gps: bool = [gps],
        /// Frequency of the ultrasound: 7 (22.22 Hz) or 8 (25 Hz); 0 leaves it as it is, in factory state 8. Drones within 3 m of
        /// each other need different ones.
        ultrasound: UltrasoundFrequency = [ultrasound],
    }
}

section! {
    struct Video("video") of VehicleConfig {
        /// Bit rate that the drone is asked for, 250 to 4000: less suffers less from a bad link. kbit/s; 0 leaves it as it is,
        /// which is 1000 after a start.
        bitrate_kbit_s: BitRate = [video_kbit_s] in 250.0..=4000.0,
    }
}

section! {
    struct Station("station") of VehicleConfig {
        /// A ground station that speaks MAVLink, has the controls and is silent in flight: after this time its mission is paused
        /// and the drone holds, and after that time it lands. Milliseconds; never longer than the defaults.
        hold_after_ms: Milliseconds = [station.hold_after] in 1000.0..=10_000.0,
        land_after_ms: Milliseconds = [station.land_after] in 2000.0..=20_000.0,
    }
}

section! {
    #[allow(clippy::struct_field_names, reason = "the unit belongs to the name")]
    struct Delays("delays") of VehicleConfig {
        /// From a command to the motors, including half a tick. Milliseconds.
        command_ms: Milliseconds = [estimator.dead_time] in 0.0..=500.0,
        /// Age of measurements when they are sent: optical flow with its filter, ultrasound, attitude.
        velocity_ms: Milliseconds = [estimator.velocity_delay] in 0.0..=300.0,
        altitude_ms: Milliseconds = [estimator.altitude_delay] in 0.0..=300.0,
        attitude_ms: Milliseconds = [estimator.attitude_delay] in 0.0..=300.0,
    }
}

section! {
    struct Airframe("airframe") of VehicleConfig {
        /// Whether the airframe is identified in flight. The values below are the initial ones, or the final ones if not.
        identify: bool = [estimator.identify],
        /// Achieved over commanded tilt, climb and descent, and their lags in seconds.
        tilt_gain: f64 = [estimator.airframe.tilt_gain] in GAIN,
        tilt_lag_s: f64 = [estimator.airframe.tilt_lag_s] in 0.01..=1.0,
        climb_gain: f64 = [estimator.airframe.climb_gain] in GAIN,
        drop_gain: f64 = [estimator.airframe.drop_gain] in GAIN,
        climb_lag_s: f64 = [estimator.airframe.climb_lag_s] in 0.05..=3.0,
        /// Achieved acceleration over that of gravity at the same tilt, and linear drag (1/s); right and forward.
        thrust_gain: Pair = [estimator.airframe.thrust_gain] in GAIN,
        drag_1_s: Pair = [estimator.airframe.drag_1_s] in 0.0..=3.0,
        /// Achieved over commanded yaw rate, and its lag in seconds.
        turn_gain: f64 = [estimator.airframe.turn_gain] in GAIN,
        turn_lag_s: f64 = [estimator.airframe.turn_lag_s] in 0.01..=1.0,
    }
}

section! {
    struct Estimator("estimator") of VehicleConfig {
        /// Observer gains: how fast the velocity follows an innovation, and the disturbance is estimated from it.
        velocity_gain_1_s: f64 = [estimator.velocity_gain_1_s] in 0.1..=100.0,
        disturbance_gain_1_s2: f64 = [estimator.disturbance_gain_1_s2] in 0.0..=50.0,
        /// Largest disturbance (wind, wrong level reference) that is estimated.
        disturbance_max_m_s2: f64 = [estimator.disturbance_max_m_s2] in 0.0..=6.0,
    }
}

section! {
    struct Controller("controller") of VehicleConfig {
        /// Horizontal limits of the reference; the acceleration as a fraction of that at full tilt.
        speed_max_m_s: f64 = [cascade.speed_max_m_s] in 0.1..=10.0,
        acceleration_share: f64 = [cascade.acceleration_share] in 0.05..=1.0,
        jerk_max_m_s3: f64 = [cascade.jerk_max_m_s3] in 0.5..=100.0,
        /// Vertical limits of the reference; braking as a fraction of full gaz.
        climb_speed_max_m_s: f64 = [cascade.climb_speed_max_m_s] in 0.05..=2.0,
        braking_share: f64 = [cascade.braking_share] in 0.1..=1.0,
        /// Horizontal gains: acceleration per metre, per m/s, per metre-second of error.
        proportional_1_s2: f64 = [cascade.horizontal.proportional] in 0.1..=20.0,
        derivative_1_s: f64 = [cascade.horizontal.derivative] in 0.0..=20.0,
        integral_1_s3: f64 = [cascade.horizontal.integral] in 0.0..=5.0,
        /// Height loop: natural frequency, damping ratio; rate of climb per metre-second of error.
        vertical_frequency_rad_s: f64 = [cascade.vertical_frequency_rad_s] in 0.1..=10.0,
        vertical_damping: f64 = [cascade.vertical_damping] in 0.1..=3.0,
        vertical_integral_1_s2: f64 = [cascade.vertical_integral_1_s2] in 0.0..=5.0,
        /// Yaw: fraction of the stick used on the way to a target, and stick fraction per degree.
        turn_share: f64 = [cascade.turn_share] in 0.05..=1.0,
        yaw_1_deg: f64 = [cascade.yaw.proportional] in 0.001..=0.2,
    }
}
