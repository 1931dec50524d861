//! The plan's targets, independent of the pilot's view.

use autopilot::plan::{Command, FlightLimits, Plan};
use autopilot::vehicle::Phase;
use mock_drone::Truth;
use nalgebra::{Vector2, Vector3};

use crate::place_in_navdata_frame;
use crate::sim::Moment;

/// Each plan begins with it.
pub(super) const TAKE_OFF_STEP: usize = 0;

/// The targets of a plan that contains only `goto`.
#[derive(Debug)]
pub(super) struct Targets {
    /// Each with its step, relative to the end of the take-off.
    wanted_m: Vec<(usize, Vector3<f64>)>,
    limits: FlightLimits,
    /// End of the take-off, in the frame that healthy sensors span.
    origin_m: Vector3<f64>,
    took_off: bool,
    /// Tags lead the pilot from the frame of the sensors to the true one.
    has_tags: bool,
}

impl Targets {
    pub(super) fn of(plan: &Plan, limits: &FlightLimits, has_tags: bool) -> Self {
        let wanted_m = plan.steps().iter().enumerate().filter_map(|(index, step)| {
            let Command::GoTo(pose) = step.command else { return None };
            Some((index, Vector3::new(pose.x_m, pose.y_m, pose.z_m)))
        });
        Self {
            wanted_m: wanted_m.collect(),
            limits: *limits,
            origin_m: Vector3::zeros(),
            took_off: false,
            has_tags,
        }
    }

    /// The last tick of the take-off defines the origin of the targets.
    pub(super) fn watch(&mut self, moment: &Moment) {
        self.took_off |= moment.status.step.is_some_and(|step| step > TAKE_OFF_STEP);
        // A take-over in the air completes its take-off within the tick.
        if moment.status.phase == Phase::Flying && !self.took_off {
            let place_m = place_in_navdata_frame(&moment.truth);
            // With tags, coordinates begin at the start.
            let across_m = if self.has_tags { Vector2::zeros() } else { place_m.xy() };
            self.origin_m = across_m.push(place_m.z);
        }
    }

    pub(super) fn count(&self) -> usize {
        self.wanted_m.len()
    }

    /// Distance of the drone from the target of a step.
    pub(super) fn error_m(&self, step: usize, truth: &Truth) -> Option<f64> {
        let (_, wanted_m) = self.wanted_m.iter().find(|(index, _)| *index == step)?;
        let to_m = self.origin_m + wanted_m;
        // The drone hovers elsewhere than assumed by the check: targets outside the fence are moved inside.
        let across_m: Vector2<f64> = self.limits.border.nearest_inside(to_m.xy(), 0.0);
        let height_m = to_m.z.clamp(self.limits.floor_m, self.limits.ceiling_m);
        let error_m = |place_m: Vector3<f64>| (place_m - across_m.push(height_m)).norm();
        let by_sensors_m = error_m(place_in_navdata_frame(truth));
        // A tag that the pilot has mapped itself lies in the frame of the sensors at that time, which is between
        // the two.
        let by_tags_m = if self.has_tags { error_m(truth.position_m) } else { f64::INFINITY };
        Some(by_sensors_m.min(by_tags_m))
    }
}
