//! Vision: velocity measurement and tag detection.

use crate::navdata::wire::{Centi, Milli, option};

option! {
    /// Translation by vision, raw.
    VisionRaw, 16 {
        /// Forward.
        translation_x: f32 as f32,
        /// Right.
        translation_y: f32 as f32,
        /// Down.
        translation_z: f32 as f32,
    }
}

option! {
    /// Optical flow, raw, of the last five pictures.
    VisionFlow, 44 {
        /// Forward.
        flow_x: [f32; 5] as [f32; 5],
        /// Right.
        flow_y: [f32; 5] as [f32; 5],
    }
}

option! {
    /// Velocity by vision.
    Vision, 92 {
        /// State of the algorithm.
        state: u32 as u32,
        /// For debugging.
        miscellaneous: i32 as i32,
        /// Roll trim.
        roll_trim: f32 as f32,
        /// Roll reference, proportional part.
        roll_reference: f32 as f32,
        /// Pitch trim.
        pitch_trim: f32 as f32,
        /// Pitch reference, proportional part.
        pitch_reference: f32 as f32,
        /// Whether there is a new picture.
        new_picture: i32 as i32,
        /// Pitch when the picture was taken.
        capture_pitch: f32 as f32,
        /// Roll when the picture was taken.
        capture_roll: f32 as f32,
        /// Heading when the picture was taken.
        capture_yaw_rad: f32 as f32,
        /// Altitude when the picture was taken.
        capture_altitude_m: f64 as Milli<i32>,
        /// When the picture was taken; firmware versions disagree on the format.
        capture_time: u32 as u32,
        /// Body frame: forward, right, down.
        velocity_m_s: [f64; 3] as [Milli<f32>; 3],
        /// Change since the last picture.
        roll_change: f32 as f32,
        /// Change since the last picture.
        pitch_change: f32 as f32,
        /// Change since the last picture.
        yaw_change: f32 as f32,
        /// Whether there is a reference picture.
        gold_defined: u32 as u32,
        /// Whether the reference picture was given up.
        gold_reset: u32 as u32,
        /// Offset to the reference picture, forward.
        gold_x: f32 as f32,
        /// Offset to the reference picture, right.
        gold_y: f32 as f32,
    }
}

option! {
    /// Duration of the vision algorithms.
    VisionPerformance, 108 {
        /// Size of the zone.
        zone: f32 as f32,
        /// Corners.
        corners: f32 as f32,
        /// Computation.
        computation: f32 as f32,
        /// Tracking.
        tracking: f32 as f32,
        /// Translation.
        translation: f32 as f32,
        /// Update.
        update: f32 as f32,
        /// Others.
        others: [f32; 20] as [f32; 20],
    }
}

option! {
    /// Points tracked by vision.
    TrackersSend, 364 {
        /// Not zero if the point is held.
        locked: [i32; 30] as [i32; 30],
        /// Position in the image, x and y.
        points: [[i32; 2]; 30] as [[i32; 2]; 30],
    }
}

option! {
    /// Detected roundels and tags, at most four.
    VisionDetect, 328 {
        /// Number of detections.
        count: u32 as u32,
        /// Camera in the high half, numbered as in `cameras`; kind of tag in the low half, 8 for the black and white oriented
        /// roundel.
        kinds: [u32; 4] as [u32; 4],
        /// Centre, 0 to 1000 from left to right.
        x: [u32; 4] as [u32; 4],
        /// Centre, 0 to 1000 from top to bottom.
        y: [u32; 4] as [u32; 4],
        /// Width of the box, in thousandths of the picture's width.
        widths: [u32; 4] as [u32; 4],
        /// Height of the box, in thousandths of the picture's height.
        heights: [u32; 4] as [u32; 4],
        /// From the camera.
        distances_m: [f64; 4] as [Centi<u32>; 4],
        /// Of oriented tags, in the picture. Clients of the real drone contradict each other on the sign.
        orientations_deg: [f32; 4] as [f32; 4],
        /// Row by row.
        rotations: [[f32; 9]; 4] as [[f32; 9]; 4],
        /// From the camera.
        translations: [[f32; 3]; 4] as [[f32; 3]; 4],
        /// 0 front, 1 bottom, 2 bottom in step with the front camera.
        cameras: [u32; 4] as [u32; 4],
    }
}
