//! The bottom camera, and the tags that the firmware detects in its pictures.
//!
//! A projection: points of each pattern's outline are mapped through the drone's tilt, its height and a
//! pin-hole camera, and the firmware reports their bounding box. Parameters that a pilot cannot know (focal
//! length, centre, mounting, delay, sign of orientations) are drawn from the seed.

use std::time::Duration;

use ardrone_link::navdata::VisionDetect;
use nalgebra::{Rotation3, Vector2, Vector3};
use rand::seq::SliceRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

use crate::airframe::Airframe;
use crate::sensors::DelayLine;

/// A tag on the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloorTag {
    /// Right and forward of the start.
    pub place_m: Vector2<f64>,
    /// Direction of its pattern: clockwise from the drone's initial heading.
    pub heading_deg: f64,
    /// Diameter of the pattern.
    pub size_m: f64,
}

impl FloorTag {
    /// Diameter of a pattern that fills a sheet of A4.
    pub const SIZE_M: f64 = 0.19;

    /// A tag of [`FloorTag::SIZE_M`].
    pub fn new(right_m: f64, forward_m: f64, heading_deg: f64) -> Self {
        let place_m = Vector2::new(right_m, forward_m);
        Self { place_m, heading_deg, size_m: Self::SIZE_M }
    }
}

/// Direction in which the reported orientation of a tag grows. Clients of the real drone contradict each
/// other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OrientationSign {
    /// Drawn from the seed.
    Drawn,
    /// When the drone turns clockwise.
    Clockwise,
    /// When the drone turns counter-clockwise, as the pattern turns in the picture.
    CounterClockwise,
}

/// Errors of the bottom camera and of the detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraModel {
    /// Maximum relative error of the focal length, 0.03 for 3 %.
    pub focal_error: f64,
    /// Maximum error of the picture's centre, in thousandths of the picture.
    pub centre_error_units: f64,
    /// Maximum error of its mounting about each axis.
    pub mount_error_deg: f64,
    /// Whether these errors have their maximum size, in a direction drawn from the seed, or any size up to
    /// it.
    pub at_extremes: bool,
    /// Delay from the picture to its report: between these, drawn from the seed. The wait for the next packet
    /// adds up to one interval.
    pub delay: [Duration; 2],
    /// White noise of a reported centre, in thousandths of the picture.
    pub noise_units: f64,
    /// White noise of a reported orientation.
    pub orientation_noise_deg: f64,
    /// Fraction of the pictures in which a complete tag is detected, from 0 to 1; it falls to none from 3 m to 4.5 m.
    pub seen: f64,
    /// Fraction of the pictures with a false detection, from 0 to 1.
    pub false_sights: f64,
    /// Sign of the orientations.
    pub orientation: OrientationSign,
}

impl CameraModel {
    /// Without noise, delay or error; every tag is detected.
    pub fn perfect() -> Self {
        Self {
            focal_error: 0.0,
            centre_error_units: 0.0,
            mount_error_deg: 0.0,
            at_extremes: false,
            delay: [Duration::ZERO; 2],
            noise_units: 0.0,
            orientation_noise_deg: 0.0,
            seen: 1.0,
            false_sights: 0.0,
            orientation: OrientationSign::CounterClockwise,
        }
    }

    /// Good light, a flat sheet of paper.
    pub fn nominal() -> Self {
        Self {
            focal_error: 0.03,
            centre_error_units: 20.0,
            mount_error_deg: 0.5,
            at_extremes: false,
            delay: [Duration::from_millis(30), Duration::from_millis(60)],
            noise_units: 3.0,
            orientation_noise_deg: 2.0,
            seen: 0.9,
            false_sights: 0.001,
            orientation: OrientationSign::Drawn,
        }
    }

    /// Bad light, a camera far from the published ones.
    pub fn hard() -> Self {
        Self {
            focal_error: 0.10,
            centre_error_units: 50.0,
            mount_error_deg: 1.0,
            delay: [Duration::from_millis(70), Duration::from_millis(130)],
            noise_units: 8.0,
            orientation_noise_deg: 4.0,
            seen: 0.6,
            false_sights: 0.01,
            ..Self::nominal()
        }
    }
}

/// Detector settings, in the firmware's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Detector {
    /// 1: at full rate; 2: in step with the hover.
    pub(crate) source: u32,
    /// 8: the black and white oriented roundel.
    pub(crate) kind: u32,
}

/// The camera of one drone.
#[derive(Debug, Clone)]
pub(crate) struct Camera {
    model: CameraModel,
    random: ChaCha8Rng,
    focal_units: Vector2<f64>,
    centre_units: Vector2<f64>,
    /// Rotation from the body to the camera.
    mount: Rotation3<f64>,
    /// 1 if orientations grow with a clockwise turn of the pattern in the picture.
    sign: f64,
    reported: DelayLine<VisionDetect>,
}

/// Published calibrations of the bottom camera, in thousandths of the whole picture.
pub(crate) const FOCAL_UNITS: Vector2<f64> = Vector2::new(1072.0, 1452.0);
const CENTRE_UNITS: Vector2<f64> = Vector2::new(500.0, 450.0);
/// Pixels per unit: the picture is 320 by 240.
const UNIT_PX: Vector2<f64> = Vector2::new(0.32, 0.24);
/// Minimum size of a detectable pattern.
const LEAST_UNITS: f64 = 20.0;
/// Above the first height the detection rate falls; above the second it is zero.
const HIGH_M: [f64; 2] = [3.0, 4.5];
/// Pattern size that the firmware assumes for its distance.
const NOMINAL_SIZE_M: f64 = 0.222;
const FIRMWARE_FOCAL_PX: f64 = 343.0;
/// Relative standard deviation of the distance and of the box.
const SIZE_NOISE: f64 = 0.03;
/// Maximum number of detections in a packet.
const MOST: usize = 4;
/// Points of an outline.
const OUTLINE: u32 = 16;

/// One detection in one picture.
#[derive(Debug, Clone, Copy)]
struct Sight {
    centre_units: Vector2<f64>,
    size_units: Vector2<f64>,
    orientation_deg: f64,
}

impl Camera {
    pub(crate) fn new(model: CameraModel, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed ^ 0x6361_6d65);
        let mut draw = || {
            let unit: f64 = random.random_range(-1.0..=1.0);
            if model.at_extremes { unit.signum() } else { unit }
        };
        let focal_units = FOCAL_UNITS * (1.0 + draw() * model.focal_error);
        let centre_units = CENTRE_UNITS + Vector2::new(draw(), draw()) * model.centre_error_units;
        let mount_rad = Vector3::new(draw(), draw(), draw()) * model.mount_error_deg.to_radians();
        let mount = Rotation3::from_scaled_axis(mount_rad);
        let [shortest, longest] = model.delay;
        let delay =
            shortest + longest.saturating_sub(shortest).mul_f64(random.random_range(0.0..=1.0));
        let grows_clockwise = match model.orientation {
            OrientationSign::Drawn => random.random_bool(0.5),
            OrientationSign::Clockwise => true,
            OrientationSign::CounterClockwise => false,
        };
        let sign = if grows_clockwise { -1.0 } else { 1.0 };
        let reported = DelayLine::new(delay);
        Self { model, random, focal_units, centre_units, mount, sign, reported }
    }

    /// Takes a picture of the floor; `detector` evaluates it.
    pub(crate) fn take(
        &mut self,
        now: Duration,
        airframe: &Airframe,
        tags: &[FloorTag],
        detector: Option<Detector>,
    ) {
        let found = detector.map(|detector| self.find(airframe, tags, detector));
        self.reported.push(now, found.unwrap_or_default());
    }

    /// Detections in navdata now: those of the newest picture that has been processed.
    pub(crate) fn read(&mut self, now: Duration) -> VisionDetect {
        self.reported.read(now)
    }

    fn find(&mut self, airframe: &Airframe, tags: &[FloorTag], detector: Detector) -> VisionDetect {
        let high =
            ((airframe.position_m().z - HIGH_M[0]) / (HIGH_M[1] - HIGH_M[0])).clamp(0.0, 1.0);
        let seen = self.model.seen * (1.0 - high);
        let mut sights = Vec::new();
        for tag in tags {
            let sight = self.sight(airframe, tag);
            sights.extend(sight.filter(|_| self.random.random_bool(seen)));
        }
        if self.model.false_sights > 0.0 && self.random.random_bool(self.model.false_sights) {
            sights.push(self.phantom());
        }
        sights.shuffle(&mut self.random);
        sights.truncate(MOST);
        self.report(&sights, detector)
    }

    /// Position of a tag in the picture, if it is complete.
    fn sight(&self, airframe: &Airframe, tag: &FloorTag) -> Option<Sight> {
        let (mut least, mut most) =
            (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        for step in 0..OUTLINE {
            let angle_rad = std::f64::consts::TAU * f64::from(step) / f64::from(OUTLINE);
            let (sin, cos) = angle_rad.sin_cos();
            let point =
                self.project(airframe, tag.place_m + Vector2::new(sin, cos) * (tag.size_m / 2.0))?;
            least = least.inf(&point);
            most = most.sup(&point);
        }
        let size_units = most - least;
        let whole = least.min() >= 0.0 && most.max() <= 1000.0 && size_units.min() >= LEAST_UNITS;
        let (sin, cos) = tag.heading_deg.to_radians().sin_cos();
        let ahead = tag.place_m + Vector2::new(sin, cos) * (tag.size_m / 2.0);
        let arrow = self.project(airframe, ahead)? - self.project(airframe, tag.place_m)?;
        let arrow_px = arrow.component_mul(&UNIT_PX);
        // Clockwise from the right side of the picture, so up is 270.
        let turned_deg = arrow_px.y.atan2(arrow_px.x).to_degrees() + 90.0;
        let orientation_deg = 270.0 + self.sign * turned_deg;
        let centre_units = (least + most) / 2.0;
        whole.then_some(Sight { centre_units, size_units, orientation_deg })
    }

    /// Projects a point of the floor into the picture (right, down), if it lies in front of the camera.
    fn project(&self, airframe: &Airframe, point_m: Vector2<f64>) -> Option<Vector2<f64>> {
        let up = Vector3::z_axis();
        let attitude = Rotation3::from_axis_angle(&up, -airframe.yaw_rad())
            * Rotation3::from_axis_angle(&Vector3::x_axis(), airframe.pitch_rad())
            * Rotation3::from_axis_angle(&Vector3::y_axis(), airframe.roll_rad());
        let way = point_m.push(0.0) - airframe.position_m();
        // Right, forward and up of the camera.
        let seen = (attitude * self.mount).inverse() * way;
        let depth = -seen.z;
        (depth > 0.05).then(|| {
            let picture = Vector2::new(seen.x, -seen.y) / depth;
            self.centre_units + self.focal_units.component_mul(&picture)
        })
    }

    /// A false detection.
    fn phantom(&mut self) -> Sight {
        let random = &mut self.random;
        let width = random.random_range(30.0..300.0);
        let size_units = Vector2::new(width, width * UNIT_PX.x / UNIT_PX.y);
        let free = Vector2::repeat(1000.0) - size_units;
        let share = Vector2::new(random.random_range(0.0..1.0), random.random_range(0.0..1.0));
        let centre_units = size_units / 2.0 + free.component_mul(&share);
        Sight { centre_units, size_units, orientation_deg: random.random_range(0.0..360.0) }
    }

    fn report(&mut self, sights: &[Sight], detector: Detector) -> VisionDetect {
        let mut reported =
            VisionDetect { count: whole(sights.len() as f64), ..VisionDetect::default() };
        for (slot, sight) in sights.iter().enumerate() {
            let noise = Vector2::new(self.gaussian(), self.gaussian()) * self.model.noise_units;
            let centre = sight.centre_units + noise;
            let grown = 1.0 + SIZE_NOISE * self.gaussian();
            let size = sight.size_units * grown;
            let size_px = size.component_mul(&UNIT_PX).mean();
            let noise_deg = self.gaussian() * self.model.orientation_noise_deg;
            reported.kinds[slot] = detector.source << 16 | detector.kind;
            reported.cameras[slot] = detector.source;
            reported.x[slot] = whole(centre.x);
            reported.y[slot] = whole(centre.y);
            reported.widths[slot] = whole(size.x);
            reported.heights[slot] = whole(size.y);
            reported.distances_m[slot] = NOMINAL_SIZE_M * FIRMWARE_FOCAL_PX / size_px.max(1.0);
            #[allow(clippy::cast_possible_truncation, reason = "the wire carries single precision")]
            let orientation = (sight.orientation_deg + noise_deg).rem_euclid(360.0) as f32;
            reported.orientations_deg[slot] = orientation;
        }
        reported
    }

    fn gaussian(&mut self) -> f64 {
        StandardNormal.sample(&mut self.random)
    }
}

/// Rounded and clipped to the picture.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped before")]
fn whole(units: f64) -> u32 {
    units.round().clamp(0.0, 1000.0) as u32
}

#[cfg(test)]
mod tests;
