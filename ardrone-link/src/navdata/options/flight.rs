//! What a pilot looks at: attitude, altitude, velocity, battery, time.

use std::time::Duration;

use crate::navdata::state::ControlState;
use crate::navdata::wire::{ClockWord, ControlMajor, Milli, option};

option! {
    /// Attitude, altitude, velocity, battery. Body frame: forward, right, down.
    Demo, 148 {
        /// A detail of what the controller is doing.
        control_state_minor: u16 as u16,
        /// What the drone's controller is doing.
        control_state: ControlState as ControlMajor,
        /// Remaining charge.
        battery_percent: u32 as u32,
        /// Nose up positive.
        pitch_deg: f64 as Milli<f32>,
        /// Right side down positive.
        roll_deg: f64 as Milli<f32>,
        /// Clockwise from above positive, in [-180, 180]; zero is where the drone chose it to be.
        yaw_deg: f64 as Milli<f32>,
        /// Above the ground below.
        altitude_m: f64 as Milli<i32>,
        /// Forward, levelled body frame.
        velocity_forward_m_s: f64 as Milli<f32>,
        /// Right, levelled body frame.
        velocity_right_m_s: f64 as Milli<f32>,
        /// Down; zero in every known capture.
        velocity_down_m_s: f64 as Milli<f32>,
        /// Number of the picture that was streamed last.
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
    /// Whether the drone says that its camera sees nothing to measure its velocity by: minor state
    /// `no_vision` of flying (SDK 2, `control_states.h`).
    pub fn has_lost_vision(&self) -> bool {
        self.control_state == ControlState::Flying && self.control_state_minor == 6
    }

    /// Whether the drone says that it does not know its altitude: minor states `lost_alt` of flying
    /// and hovering, in all their kinds (SDK 2, `control_states.h`).
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
