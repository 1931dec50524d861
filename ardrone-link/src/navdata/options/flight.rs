//! Basic flight data: attitude, altitude, velocity, battery, time.

use std::time::Duration;

use crate::navdata::state::ControlState;
use crate::navdata::wire::{ClockWord, ControlMajor, Milli, option};

option! {
    /// Attitude, altitude, velocity, battery. Body frame: forward, right, down.
    Demo, 148 {
        /// Minor control state, a detail of `control_state`.
        control_state_minor: u16 as u16,
        /// Major control state.
        control_state: ControlState as ControlMajor,
        /// Remaining charge, 0 to 100.
        battery_percent: u32 as u32,
        /// Nose up positive.
        pitch_deg: f64 as Milli<f32>,
        /// Right side down positive.
        roll_deg: f64 as Milli<f32>,
        /// Clockwise from above positive, in [-180, 180]; the zero direction is chosen by the drone.
        yaw_deg: f64 as Milli<f32>,
        /// Height above the ground below.
        altitude_m: f64 as Milli<i32>,
        /// Forward, levelled body frame.
        velocity_forward_m_s: f64 as Milli<f32>,
        /// Right, levelled body frame.
        velocity_right_m_s: f64 as Milli<f32>,
        /// Down; zero in every known capture.
        velocity_down_m_s: f64 as Milli<f32>,
        /// Number of the last streamed video frame.
        frame_number: u32 as u32,
        /// Deprecated by Parrot.
        detection_camera_rotation: [f32; 9] as [f32; 9],
        /// Deprecated by Parrot.
        detection_camera_translation: [f32; 3] as [f32; 3],
        /// Deprecated by Parrot.
        detection_tag_index: u32 as u32,
        /// Deprecated by Parrot; 3 in captures.
        detection_camera_type: u32 as u32,
        /// Body to world, row by row; not for control.
        camera_rotation: [f32; 9] as [f32; 9],
        /// World frame, down positive; not for control.
        camera_translation_m: [f64; 3] as [Milli<f32>; 3],
    }
}

impl Demo {
    /// Whether the drone reports that its camera cannot measure velocity: minor state `no_vision` of flying
    /// (SDK 2, `control_states.h`).
    pub fn has_lost_vision(&self) -> bool {
        self.control_state == ControlState::Flying && self.control_state_minor == 6
    }

    /// Whether the drone reports that its altitude is unknown: the `lost_alt` minor states of flying and
    /// hovering (SDK 2, `control_states.h`).
    pub fn has_lost_altitude(&self) -> bool {
        match self.control_state {
            ControlState::Flying => matches!(self.control_state_minor, 1 | 2),
            ControlState::Hovering => matches!(self.control_state_minor, 2 | 3 | 6 | 7 | 9 | 10),
            _ => false,
        }
    }
}

option! {
    /// The drone's clock.
    Time, 8 {
        /// Since the drone was switched on; wraps after 2048 s.
        since_start: Duration as ClockWord,
    }
}

option! {
    /// Attitude by the accelerometers alone.
    EulerAngles, 12 {
        /// Nose up positive.
        pitch_deg: f64 as Milli<f32>,
        /// Right side down positive.
        roll_deg: f64 as Milli<f32>,
    }
}
