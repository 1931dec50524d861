//! Where the drone is, from what it says of its own motion.
//!
//! The AR.Drone reports velocity in its own frame, heading, and height above the ground. The
//! [`Estimator`] rotates each velocity by the heading of the same instant and integrates over the
//! drone's own clock, so that late, lost or bunched packets don't change the distance. It is pure:
//! samples in, [`Estimate`] out.
//!
//! Frame: x right, y forward, z up, metres; the origin is where the estimator started, the floor
//! below the drone is z = 0; yaw in degrees, clockwise from above, zero where the drone pointed at
//! the start. Velocity integrated is position that drifts.
//!
//! ```
//! use std::time::Duration;
//! use estimator::{Estimator, Sample};
//!
//! let mut estimator = Estimator::new();
//! for tick in 0..=10 {
//!     estimator.update(&Sample {
//!         arrival: Duration::from_millis(100 * tick),
//!         yaw_deg: 37.0,
//!         velocity_forward_m_s: 0.5,
//!         airborne: true,
//!         ..Sample::default()
//!     });
//! }
//! let position = estimator.estimate().position_m;
//! assert!((position.y - 0.5).abs() < 1e-9 && position.x.abs() < 1e-9);
//! ```
#![forbid(unsafe_code)]

mod altitude;
mod angle;
mod clock;

use std::time::Duration;

use nalgebra::{Rotation2, Vector2, Vector3};

pub use angle::wrap_deg;

use crate::altitude::AltitudeFilter;
use crate::clock::SampleClock;

/// What one navdata packet says of the drone's motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// When it arrived, on the pilot's clock.
    pub arrival: Duration,
    /// When it was made, on the drone's clock, which wraps after 2048 s; if the drone sent it.
    pub drone_time: Option<Duration>,
    /// Heading, clockwise positive, with an arbitrary zero; jumps at ±180.
    pub yaw_deg: f64,
    /// Forward velocity, levelled body frame.
    pub velocity_forward_m_s: f64,
    /// Rightward velocity, levelled body frame.
    pub velocity_right_m_s: f64,
    /// Height above the ground.
    pub altitude_m: f64,
    /// Whether the drone flies; on the ground its velocity means nothing.
    pub airborne: bool,
}

/// Where the drone is and how it moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    /// When the sample behind it arrived.
    pub at: Duration,
    /// Right, forward, up.
    pub position_m: Vector3<f64>,
    /// Right, forward, up.
    pub velocity_m_s: Vector3<f64>,
    /// In [-180, 180), zero where the drone pointed at the start.
    pub yaw_deg: f64,
}

/// Integrates samples to a position.
#[derive(Debug, Clone, Default)]
pub struct Estimator {
    clock: SampleClock,
    altitude: AltitudeFilter,
    yaw_baseline_deg: Option<f64>,
    estimate: Estimate,
}

impl Estimator {
    /// A gap longer than this is not bridged by the mean of the velocities around it.
    const MAX_STEP: Duration = Duration::from_millis(300);

    /// An estimator that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes in the next sample; samples come in the order of the drone's packets.
    pub fn update(&mut self, sample: &Sample) {
        let baseline_deg = *self.yaw_baseline_deg.get_or_insert(sample.yaw_deg);
        let yaw_deg = wrap_deg(sample.yaw_deg - baseline_deg);
        let step = self.clock.step(sample.drone_time, sample.arrival);
        let step_s = step.min(Self::MAX_STEP).as_secs_f64();

        let velocity = if sample.airborne {
            world_from_body(sample.velocity_forward_m_s, sample.velocity_right_m_s, yaw_deg)
        } else {
            Vector2::zeros()
        };
        let mean = (self.estimate.velocity_m_s.xy() + velocity) / 2.0;
        let position = self.estimate.position_m.xy() + mean * step_s;
        let vertical = self.altitude.update(sample.altitude_m, step_s);

        self.estimate = Estimate {
            at: sample.arrival,
            position_m: position.push(vertical.height_m),
            velocity_m_s: velocity.push(vertical.climb_m_s),
            yaw_deg,
        };
    }

    /// The newest estimate.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// Forgets the clock, not the place: the drone's next packet may count time anew.
    pub fn handle_restart(&mut self) {
        self.clock = SampleClock::default();
        self.yaw_baseline_deg = None;
    }
}

/// Body velocity to world velocity at a heading: forward is +y at heading 0, and a clockwise
/// heading turns forward towards +x.
fn world_from_body(forward: f64, right: f64, yaw_deg: f64) -> Vector2<f64> {
    Rotation2::new(-yaw_deg.to_radians()) * Vector2::new(right, forward)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fly(samples: impl IntoIterator<Item = Sample>) -> Estimate {
        let mut estimator = Estimator::new();
        for sample in samples {
            estimator.update(&sample);
        }
        *estimator.estimate()
    }

    fn sample(arrival_ms: u64, yaw_deg: f64, forward: f64, right: f64) -> Sample {
        Sample {
            arrival: Duration::from_millis(arrival_ms),
            yaw_deg,
            velocity_forward_m_s: forward,
            velocity_right_m_s: right,
            altitude_m: 1.0,
            airborne: true,
            ..Sample::default()
        }
    }

    #[test]
    fn clockwise_heading_turns_forward_to_the_right() {
        for (turn_deg, x, y) in [(0.0, 0.0, 1.0), (90.0, 1.0, 0.0), (180.0, 0.0, -1.0)] {
            // The first sample sets the baseline, at a heading close to the jump.
            let start = sample(0, 171.0, 0.0, 0.0);
            let turned = wrap_deg(171.0 + turn_deg);
            let flight = (0..=100).map(|i| sample(1000 + 10 * i, turned, 1.0, 0.0));
            let estimate = fly([start, sample(999, turned, 0.0, 0.0)].into_iter().chain(flight));
            let position = estimate.position_m;
            assert!((position.x - x).abs() < 1e-3, "{turn_deg}: {position}");
            assert!((position.y - y).abs() < 1e-3, "{turn_deg}: {position}");
        }
    }

    #[test]
    fn lost_packets_do_not_change_the_distance() {
        let all = (0..=60).map(|i| sample(i * 66, 0.0, 1.0, 0.5));
        let some = all.clone().enumerate().filter(|(i, _)| i % 4 != 1).map(|(_, sample)| sample);
        let (all, some) = (fly(all), fly(some));
        assert!((all.position_m - some.position_m).norm() < 1e-9);
    }

    #[test]
    fn the_drones_clock_counts_not_the_arrival() {
        // Packets held up and delivered in a bunch, while the drone's clock wraps.
        let samples = (0..30_u64).map(|i| {
            let drone_ms = (2_047_000 + i * 66) % 2_048_000;
            Sample {
                drone_time: Some(Duration::from_millis(drone_ms)),
                ..sample(i / 10 * 660, 0.0, 1.0, 0.0)
            }
        });
        let estimate = fly(samples);
        assert!((estimate.position_m.y - 29.0 * 0.066).abs() < 1e-9, "{}", estimate.position_m);
    }

    #[test]
    fn on_the_ground_nothing_moves() {
        let grounded = (0..10).map(|i| Sample { airborne: false, ..sample(i * 66, 0.0, 3.0, 3.0) });
        assert_eq!(fly(grounded).position_m.xy(), Vector2::zeros());
    }

    #[test]
    fn a_long_gap_is_not_filled_with_motion() {
        let estimate = fly([sample(0, 0.0, 1.0, 0.0), sample(10_000, 0.0, 1.0, 0.0)]);
        assert!(estimate.position_m.y <= 0.3 + 1e-9);
    }
}
