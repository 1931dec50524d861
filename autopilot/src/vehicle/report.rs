//! Summary of a flight.

use std::time::Duration;

use kinematics::Pose;

use super::RestsOn;
use crate::agent::distance;

/// A target that was reached and held for its stay time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// Index of its step in the plan.
    pub step: usize,
    /// Target pose.
    pub target: Pose,
    /// Estimated pose at the end of the stay.
    pub pose: Pose,
    /// Standard deviation of that estimate on the worse horizontal axis.
    pub uncertainty_m: f64,
    /// What that deviation rests on.
    pub rests_on: RestsOn,
    /// Time of the end of the stay.
    pub at: Duration,
}

impl Waypoint {
    /// Distance between estimate and target.
    pub fn error_m(&self) -> f64 {
        distance(&self.pose, &self.target)
    }
}

/// Summary of a flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlightReport {
    /// Number of mission steps when the flight ended.
    pub steps: usize,
    /// Number of steps up to the last one that was carried out.
    pub steps_done: usize,
    /// Targets reached, in order.
    pub waypoints: Vec<Waypoint>,
    /// When the take-off was ordered; `None` until it has ended.
    pub took_off_at: Option<Duration>,
    /// When the drone was on the ground again, or had cut its motors in the air; `None` while it flies, and if that was never
    /// heard.
    pub ended_at: Option<Duration>,
}

impl FlightReport {
    /// From the take-off order to the end; `None` before that.
    pub fn flight_time(&self) -> Option<Duration> {
        self.flight_time_at(self.ended_at?)
    }

    /// From the take-off order until now, or to the end; `None` before the drone has left the ground.
    pub fn flight_time_at(&self, now: Duration) -> Option<Duration> {
        self.ended_at.unwrap_or(now).checked_sub(self.took_off_at?)
    }

    /// Distance from the last target at the end of its stay.
    pub fn final_error_m(&self) -> Option<f64> {
        self.waypoints.last().map(Waypoint::error_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_report_gives_the_time_in_the_air_and_the_last_distance_from_a_target() {
        let empty = FlightReport::default();
        assert_eq!((empty.flight_time(), empty.final_error_m()), (None, None));
        let target = Pose { x_m: 1.0, y_m: 1.0, z_m: 1.0, yaw_deg: 90.0 };
        let reached = |pose| Waypoint {
            step: 0,
            target,
            pose,
            uncertainty_m: 0.1,
            rests_on: RestsOn::Velocity,
            at: Duration::from_secs(9),
        };
        let near = Pose { x_m: 1.3, y_m: 0.6, ..target };
        let report = FlightReport {
            waypoints: vec![reached(target), reached(near)],
            took_off_at: Some(Duration::from_secs(5)),
            ended_at: Some(Duration::from_secs(65)),
            ..empty
        };
        assert_eq!(report.flight_time(), Some(Duration::from_mins(1)));
        let error_m = report.final_error_m().unwrap();
        assert!((error_m - 0.5).abs() < 1e-9, "{error_m}");
    }
}
