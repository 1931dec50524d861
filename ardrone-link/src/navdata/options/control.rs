//! Setpoints and outputs of the drone's controller.

use crate::navdata::wire::{Milli, option};

option! {
    /// Setpoints of the controller.
    References, 88 {
        /// Nose up positive.
        pitch_deg: f64 as Milli<i32>,
        /// Right side down positive.
        roll_deg: f64 as Milli<i32>,
        /// Integral part.
        pitch_integral_deg: f64 as Milli<i32>,
        /// Integral part.
        roll_integral_deg: f64 as Milli<i32>,
        /// Rate.
        pitch_rate_deg_s: f64 as Milli<i32>,
        /// Rate.
        roll_rate_deg_s: f64 as Milli<i32>,
        /// Rate.
        yaw_rate_deg_s: f64 as Milli<i32>,
        /// Heading.
        yaw_deg: f64 as Milli<i32>,
        /// Raw velocity reference, forward.
        velocity_forward: f32 as f32,
        /// Raw velocity reference, right.
        velocity_right: f32 as f32,
        /// The model's pitch.
        model_pitch: f32 as f32,
        /// The model's roll.
        model_roll: f32 as f32,
        /// Velocity gain, forward.
        gain_forward: f32 as f32,
        /// Velocity gain, right.
        gain_right: f32 as f32,
        /// Mode of the velocity gain.
        gain_mode: u32 as u32,
        /// Time of the client's last input.
        input_time: f32 as f32,
        /// PCMD pitch as received.
        input_pitch: f32 as f32,
        /// PCMD roll as received.
        input_roll: f32 as f32,
        /// Heading of the operator's compass as received.
        input_psi: f32 as f32,
        /// Its accuracy as received.
        input_psi_accuracy: f32 as f32,
        /// Sequence number of the input.
        input_sequence: i32 as i32,
    }
}

option! {
    /// Level corrections.
    Trims, 16 {
        /// Raw.
        yaw_rate: f32 as f32,
        /// From flat trim.
        pitch_deg: f64 as Milli<f32>,
        /// From flat trim.
        roll_deg: f64 as Milli<f32>,
    }
}

option! {
    /// A radio control's sticks.
    RcReferences, 24 {
        /// Raw.
        pitch: i32 as i32,
        /// Raw.
        roll: i32 as i32,
        /// Raw.
        yaw: i32 as i32,
        /// Raw.
        gaz: i32 as i32,
        /// Raw.
        ag: i32 as i32,
    }
}

option! {
    /// Motors and their control inputs. Arrays are in the order front left, front right, rear right, rear left.
    Pwm, 76 {
        /// 0 to 255.
        motors: [u8; 4] as [u8; 4],
        /// 0 to 255, after saturation.
        saturated_motors: [u8; 4] as [u8; 4],
        /// Gaz by feed-forward.
        gaz_feed_forward: f32 as f32,
        /// Gaz by the altitude.
        gaz_altitude: f32 as f32,
        /// Integral part of the altitude.
        altitude_integral: f32 as f32,
        /// Raw climb reference.
        climb_reference: f32 as f32,
        /// Raw.
        pitch: i32 as i32,
        /// Raw.
        roll: i32 as i32,
        /// Raw.
        yaw: i32 as i32,
        /// Integral part of the yaw.
        yaw_integral: f32 as f32,
        /// Planned, raw.
        planned_pitch: i32 as i32,
        /// Planned, raw.
        planned_roll: i32 as i32,
        /// Planned, raw.
        planned_yaw: i32 as i32,
        /// Planned, raw.
        planned_gaz: f32 as f32,
        /// Of each motor.
        current_a: [f64; 4] as [Milli<u16>; 4],
        /// Proportional part of the altitude.
        altitude_proportional: f32 as f32,
        /// Derivative part of the altitude.
        altitude_derivative: f32 as f32,
    }
    newer {
        /// Status of each motor.
        motor_status: [u32; 4] as [u32; 4]
    }
}

option! {
    /// Altitude estimator.
    Altitude, 56 {
        /// Measured by vision.
        vision_m: f64 as Milli<i32>,
        /// Climb.
        climb_m_s: f64 as Milli<f32>,
        /// Setpoint.
        reference_m: f64 as Milli<i32>,
        /// Ultrasound without filtering; about 0.24 on the ground.
        raw_m: f64 as Milli<i32>,
        /// Observed vertical acceleration.
        observed_acceleration: f32 as f32,
        /// Observed altitude.
        observed_altitude: f32 as f32,
        /// States of the observer.
        observer: [f32; 3] as [f32; 3],
        /// State of the observer.
        observer_state: u32 as u32,
        /// Estimated velocity, forward and right.
        estimated_velocity: [f32; 2] as [f32; 2],
        /// State of the estimator.
        estimator_state: u32 as u32,
    }
}
