//! Summary printed at the end of a flight.

use std::fmt;

use autopilot::vehicle::{Start, Waypoint};
use mock_drone::Truth;
use nalgebra::Vector2;

use crate::flight::{FinishedFlight, LinkSummary};
use crate::recording::Recorded;

/// A waypoint compared with the simulation's truth.
pub(super) struct TrueWaypoint {
    /// True distance from the target, in the frame that navdata span.
    error_m: f64,
    /// Drift of that frame relative to the world.
    drift_m: f64,
}

impl TrueWaypoint {
    /// The simulated drone's world begins where it stands at the start.
    pub(super) fn new(waypoint: &Waypoint, truth: &Truth, start: &Start) -> Self {
        let target = &waypoint.target;
        let place = start.in_world(truth.odometry_m) - Vector2::new(target.x_m, target.y_m);
        let height_m = truth.position_m.z - target.z_m;
        Self { error_m: place.norm().hypot(height_m), drift_m: truth.drift_m().norm() }
    }
}

/// The end of a flight in a few lines.
pub(super) struct Summary<'a> {
    pub(super) finished: &'a FinishedFlight,
    pub(super) truths: &'a [TrueWaypoint],
    pub(super) recorded: Option<&'a Recorded>,
    /// Whether the program exited at the end of a plan, rather than on request.
    pub(super) flew_a_plan: bool,
}

impl fmt::Display for Summary<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = &self.finished.report;
        if !self.flew_a_plan {
            let down =
                if self.finished.is_down { "the drone is down" } else { "its landing was ordered" };
            writeln!(f, "left: {down}")?;
            return self.machine(f);
        }
        writeln!(f, "{}", self.finished.outcome)?;
        writeln!(f, "  steps done      {} of {}", report.steps_done, report.steps)?;
        match report.flight_time() {
            Some(time) => writeln!(f, "  flight time     {:.1} s", time.as_secs_f64())?,
            None => writeln!(f, "  flight time     -")?,
        }
        if let Some(error_m) = report.final_error_m() {
            writeln!(f, "  final error     {error_m:.2} m (estimate to last target)")?;
        }
        if let Some(waypoint) = report.waypoints.last() {
            let (uncertainty_m, rests_on) = (waypoint.uncertainty_m, waypoint.rests_on);
            writeln!(f, "  uncertainty     {uncertainty_m:.2} m (standard deviation), {rests_on}")?;
        }
        let largest = |value: fn(&TrueWaypoint) -> f64| {
            self.truths.iter().map(value).fold(None, |largest: Option<f64>, value| {
                Some(largest.map_or(value, |largest| largest.max(value)))
            })
        };
        if let (Some(error_m), Some(drift_m)) =
            (largest(|truth| truth.error_m), largest(|truth| truth.drift_m))
        {
            writeln!(
                f,
                "  simulated truth at most {error_m:.2} m from a target, navdata drifted {drift_m:.2} m"
            )?;
        }
        self.machine(f)
    }
}

impl Summary<'_> {
    /// Statistics of ticks, flight log and network.
    fn machine(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "  timing          {}", self.finished.ticks)?;
        if let Some(recorded) = self.recorded {
            let (path, kilobytes) = (recorded.path.display(), recorded.bytes.div_ceil(1000));
            writeln!(f, "  flight log      {path}, {kilobytes} kB")?;
        }
        if self.finished.lost_records > 0 {
            let lost = self.finished.lost_records;
            writeln!(f, "  not recorded    {lost} entries, for which the disk was too slow")?;
        }
        let LinkSummary { errors, bound_anew, flooded_ticks, unrecorded } = self.finished.link;
        if errors > 0 {
            writeln!(
                f,
                "  network         {errors} errors, sockets bound anew {bound_anew} times"
            )?;
        }
        if flooded_ticks > 0 || unrecorded > 0 {
            writeln!(
                f,
                "  flooded         in {flooded_ticks} ticks; {unrecorded} datagrams not recorded"
            )?;
        }
        Ok(())
    }
}
