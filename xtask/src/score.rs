//! Scores of flights, in the frame that navdata span, so that drift does not count.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::FlightEvent;
use nalgebra::{Vector2, Vector3};
use system_tests::sim::{Moment, SimulatedFlight};

/// Scores of one flight.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Score {
    /// Whether the plan was flown to its end.
    pub(crate) completed: bool,
    /// Simulated time of the whole flight.
    pub(crate) duration: Duration,
    /// Targets that were reached and held for their stay time.
    pub(crate) waypoints: usize,
    /// Time from the start of the first target to the end of the last stay, without the stays.
    pub(crate) transit_s: f64,
    /// Overshoot of each leg along its direction.
    pub(crate) overshoots_m: Vec<f64>,
    /// Mean squared distance from the target in the late part of each stay.
    pub(crate) late_square_m2: Vec<f64>,
    /// Position drift at the end of integrated odometry: the drone's own velocity, without delay.
    pub(crate) odometry_drift_m: f64,
    /// Position drift at the end of the estimate.
    pub(crate) estimate_drift_m: f64,
}

/// A leg: its step and its measurements.
struct Leg {
    step: usize,
    target: Vector3<f64>,
    places: Vec<(Duration, Vector3<f64>)>,
}

/// Measures a flight with a given stay time at each target.
pub(crate) struct Scorer {
    stay: Duration,
    legs: Vec<Leg>,
    drift_m: (f64, f64),
}

impl Scorer {
    pub(crate) fn new(stay: Duration) -> Self {
        Self { stay, legs: Vec::new(), drift_m: (0.0, 0.0) }
    }

    pub(crate) fn watch(&mut self, moment: &Moment) {
        let (Some(step), Some(target)) = (moment.status.step, moment.status.target) else { return };
        let target = Vector3::new(target.x_m, target.y_m, target.z_m);
        let truth = moment.truth.position_m.xy();
        let pose = moment.status.pose.unwrap_or_default();
        self.drift_m = (
            (moment.truth.odometry_m - truth).norm(),
            (Vector2::new(pose.x_m, pose.y_m) - truth).norm(),
        );
        let place = moment.truth.odometry_m.push(moment.truth.position_m.z);
        let leg = match self.legs.last_mut() {
            Some(leg) if leg.step == step => leg,
            _ => {
                self.legs.push(Leg { step, target, places: Vec::new() });
                return;
            }
        };
        // The agent holds the last target for one tick before it takes the next.
        leg.target = target;
        leg.places.push((moment.now, place));
    }

    /// Duration of the evaluated part of a stay: the second half of a short one; all but the first five
    /// seconds of a long one.
    fn late(&self) -> Duration {
        (self.stay / 2).max(self.stay.saturating_sub(Duration::from_secs(5)))
    }

    /// The scores of the finished flight.
    pub(crate) fn score(&self, flight: &SimulatedFlight) -> Score {
        let when = |wanted: fn(&FlightEvent) -> Option<usize>, step: usize| {
            let mut events = flight.events.iter();
            events.find(|(_, event)| wanted(event) == Some(step)).map(|(at, _)| *at)
        };
        let started = |event: &FlightEvent| match event {
            FlightEvent::StepStarted { step } => Some(*step),
            _ => None,
        };
        let done = |event: &FlightEvent| match event {
            FlightEvent::StepDone { step } => Some(*step),
            _ => None,
        };
        let waypoints = flight.report.waypoints.len();
        let reached: Vec<&Leg> = self
            .legs
            .iter()
            .filter(|leg| flight.report.waypoints.iter().any(|waypoint| waypoint.step == leg.step))
            .collect();
        let first = reached.first().and_then(|leg| when(started, leg.step));
        let last = reached.last().and_then(|leg| when(done, leg.step));
        let whole =
            first.zip(last).map_or(Duration::ZERO, |(first, last)| last.saturating_sub(first));
        let stays = self.stay * u32::try_from(waypoints).unwrap_or(u32::MAX);
        let mut score = Score {
            completed: flight.outcome == Outcome::Completed,
            duration: flight.duration,
            waypoints,
            transit_s: whole.saturating_sub(stays).as_secs_f64(),
            odometry_drift_m: self.drift_m.0,
            estimate_drift_m: self.drift_m.1,
            ..Score::default()
        };
        for (index, leg) in reached.iter().enumerate() {
            let Some(end) = when(done, leg.step) else { continue };
            let from = match index.checked_sub(1).and_then(|before| reached.get(before)) {
                Some(before) => before.target,
                None => leg.places.first().map_or(leg.target, |(_, place)| *place),
            };
            let way = leg.target - from;
            if way.norm() > 0.05 {
                let direction = way.normalize();
                let beyond = leg.places.iter().map(|(_, p)| (p - leg.target).dot(&direction));
                score.overshoots_m.push(beyond.fold(0.0, f64::max));
            }
            let late: Vec<f64> = leg
                .places
                .iter()
                .filter(|(at, _)| *at <= end && *at + self.late() > end)
                .map(|(_, place)| (place - leg.target).norm_squared())
                .collect();
            score.late_square_m2.push(mean(&late));
        }
        score
    }
}

#[allow(clippy::cast_precision_loss, reason = "counts are small")]
pub(crate) fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}
