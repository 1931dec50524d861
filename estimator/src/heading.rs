//! Heading of the drone: in the past, now, and predicted.

use std::collections::VecDeque;

use crate::orders::{Order, Orders};
use crate::silence::{KEPT_S, Silence, USUAL_STEP_S, last_heard_s};
use kinematics::wrap_deg;
use kinematics::{Airframe, DroneLimits};

/// A heading that no turn explains, by more than this and this much per second since the last one, is a step of the
/// compass; by twice as much per second of a silence. The firmware has been seen to step by 160°.
const MAX_SURPRISE_DEG: f64 = 6.0;
const MAX_SURPRISE_DEG_S: f64 = 10.0;
/// The turn rate is measured over this time; from older headings the prediction of the sticks is better.
const RATE_S: f64 = 0.15;
const MAX_RATE_S: f64 = 0.5;
/// A compass that repeats its value while the drone should have turned by this has measured nothing new.
const STUCK_DEG: f64 = 0.5;
/// Covers the delay of the velocity at 200 packets per second.
const MEMORY: usize = 64;

/// Unwrapped headings, from that of the start, with their times of measurement.
#[derive(Debug, Clone)]
pub(crate) struct Heading {
    /// The heading at the start.
    start_deg: f64,
    baseline_deg: Option<f64>,
    measured: VecDeque<(f64, f64)>,
    /// Turn rate predicted from the sticks, at the newest measurement.
    turn_deg_s: f64,
    compass_deg: f64,
    silence: Silence,
}

impl Heading {
    pub(crate) fn new(start_deg: f64) -> Self {
        Self {
            start_deg,
            baseline_deg: None,
            measured: VecDeque::with_capacity(MEMORY),
            turn_deg_s: 0.0,
            compass_deg: f64::NAN,
            silence: Silence::default(),
        }
    }

    /// Adds a compass heading with its time of measurement. Returns whether the compass made a step; a step
    /// does not change the heading.
    pub(crate) fn update(
        &mut self,
        at_s: f64,
        compass_deg: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) -> bool {
        let baseline_deg = *self.baseline_deg.get_or_insert(compass_deg - self.start_deg);
        let last = self.measured.back().copied();
        if last.is_some_and(|(last_s, _)| at_s < last_s) {
            return false;
        }
        let turned_deg = wrap_deg(compass_deg - baseline_deg);
        let Some((last_s, last_deg)) = last else {
            self.measured.push_back((at_s, turned_deg));
            return false;
        };
        let model = Turning { orders, airframe, limits };
        let (rate_deg_s, angle_deg) = model.turned(self.turn_deg_s, last_s, at_s);
        #[allow(clippy::float_cmp, reason = "the very same number, not a near one")]
        let repeated = compass_deg == std::mem::replace(&mut self.compass_deg, compass_deg);
        if repeated && angle_deg.abs() > STUCK_DEG {
            return false;
        }
        let silent = self.silence.end(at_s - last_s);
        let moved_deg = wrap_deg(turned_deg - last_deg);
        let (moved_deg, step_deg) = self.separate(&model, at_s, silent, [angle_deg, moved_deg]);
        self.turn_deg_s = rate_deg_s;
        self.baseline_deg = Some(baseline_deg + step_deg.unwrap_or(0.0));
        if self.measured.len() == MEMORY {
            self.measured.pop_front();
        }
        self.measured.push_back((at_s, last_deg + moved_deg));
        step_deg.is_some()
    }

    /// Separates the turn since the newest measurement from a step of the compass, if there is one. The model turned by
    /// `angle_deg`, and the compass by `moved_deg`, or by whole turns more. `silent` is the share of the time in which no
    /// packets arrived.
    fn separate(
        &self,
        model: &Turning<'_>,
        at_s: f64,
        silent: f64,
        [angle_deg, moved_deg]: [f64; 2],
    ) -> (f64, Option<f64>) {
        let last_s = self.measured.back().map_or(at_s, |(last_s, _)| *last_s);
        let heard_deg = model.turned(self.measured_deg_s(), last_s, at_s).1;
        let [least_deg, most_deg] = self.explained(model, at_s, silent, [angle_deg, heard_deg]);
        // Unwrapped, so that it does not jump at half a turn, and by the turn that is expected.
        let moved_deg = moved_deg + 360.0 * ((heard_deg - moved_deg) / 360.0).round();
        let surprise_deg = beyond(moved_deg, least_deg, most_deg);
        let allowed_deg_s = MAX_SURPRISE_DEG_S * (1.0 + silent);
        let stepped = surprise_deg > MAX_SURPRISE_DEG + allowed_deg_s * (at_s - last_s);
        if stepped { (heard_deg, Some(moved_deg - heard_deg)) } else { (moved_deg, None) }
    }

    /// A packet was sent at a time, whatever is in it.
    pub(crate) fn hear(&mut self, at_s: f64) {
        self.silence.hear(at_s);
    }

    /// Measured turn rate at the newest measurement. It does not depend on whether the drone received its orders.
    fn measured_deg_s(&self) -> f64 {
        let Some((last_s, last_deg)) = self.measured.back() else { return 0.0 };
        let mut before = self.measured.iter().rev().skip(1);
        let found = before.find(|(at_s, _)| last_s - at_s >= RATE_S);
        match found.or(self.measured.front()) {
            Some((at_s, deg)) if (1e-3..MAX_RATE_S).contains(&(last_s - at_s)) => {
                (last_deg - deg) / (last_s - at_s)
            }
            _ => self.turn_deg_s,
        }
    }

    /// Least and largest turn since the newest measurement that needs no step of the compass. The drone turned as
    /// `ordered` (once with the predicted rate at the start, once with the measured), or went on for a moment. In the
    /// share of the time in which no packets arrived, it may have stopped, gone on, or kept any of its orders.
    fn explained(
        &self,
        model: &Turning<'_>,
        at_s: f64,
        silent: f64,
        ordered_deg: [f64; 2],
    ) -> [f64; 2] {
        let last_s = self.measured.back().map_or(at_s, |(last_s, _)| *last_s);
        let rate_deg_s = self.measured_deg_s();
        // A drone that does not receive its orders goes on turning. While packets arrive, a moment is enough.
        let brief_s = (at_s - last_s).min(USUAL_STEP_S);
        let after_deg = model.turned(rate_deg_s, last_s + brief_s, at_s).1;
        let heard = [ordered_deg[0], ordered_deg[1], rate_deg_s * brief_s + after_deg];
        let least_deg = heard.into_iter().fold(f64::INFINITY, f64::min);
        let most_deg = heard.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if silent <= 0.0 {
            return [least_deg, most_deg];
        }
        let went_on_deg = rate_deg_s * (at_s - last_s).min(KEPT_S);
        let kept = last_heard_s(last_s, at_s)
            .map(|until_s| model.kept(rate_deg_s, last_s, until_s, at_s))
            .chain([0.0, went_on_deg]);
        let (mut slowest_deg, mut fastest_deg) = (least_deg, most_deg);
        for deg in kept {
            slowest_deg = slowest_deg.min(deg);
            fastest_deg = fastest_deg.max(deg);
        }
        let unheard = |heard_deg: f64, deg: f64| heard_deg + (deg - heard_deg) * silent;
        [unheard(least_deg, slowest_deg), unheard(most_deg, fastest_deg)]
    }

    /// Interpolates between measurements; predicts from the sticks after the last one.
    pub(crate) fn at(
        &self,
        time_s: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) -> f64 {
        let after = self.measured.partition_point(|(at_s, _)| *at_s <= time_s);
        let before = after.checked_sub(1).and_then(|i| self.measured.get(i));
        match (before, self.measured.get(after)) {
            (Some((from_s, from)), Some((to_s, to))) => {
                from + (to - from) * (time_s - from_s) / (to_s - from_s).max(1e-9)
            }
            (Some((from_s, from)), None) => {
                let model = Turning { orders, airframe, limits };
                from + model.turned(self.turn_deg_s, *from_s, time_s).1
            }
            (None, Some((_, first))) => *first,
            (None, None) => self.start_deg,
        }
    }

    /// Turn rate at a time after the newest measurement, predicted from the sticks.
    pub(crate) fn turn_deg_s(
        &self,
        time_s: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) -> f64 {
        self.since_newest(self.turn_deg_s, time_s, &Turning { orders, airframe, limits })
    }

    /// Turn rate at a time: that of the last headings, predicted from the sticks since.
    pub(crate) fn rate_deg_s(
        &self,
        time_s: f64,
        orders: &Orders,
        airframe: &Airframe,
        limits: &DroneLimits,
    ) -> f64 {
        self.since_newest(self.measured_deg_s(), time_s, &Turning { orders, airframe, limits })
    }

    /// The turn rate of the newest measurement, predicted for a time; before it, itself.
    fn since_newest(&self, turn_deg_s: f64, time_s: f64, model: &Turning<'_>) -> f64 {
        let newest_s = self.measured.back().map(|(at_s, _)| *at_s);
        newest_s.map_or(0.0, |at_s| model.turned(turn_deg_s, at_s, time_s.max(at_s)).0)
    }

    /// The heading that was measured at a time, if the newest one was.
    pub(crate) fn measured_deg(&self, at_s: f64) -> Option<f64> {
        self.measured
            .back()
            .filter(|(newest_s, _)| (newest_s - at_s).abs() < 1e-9)
            .map(|(_, deg)| *deg)
    }

    /// The newest measured heading.
    pub(crate) fn newest_deg(&self) -> f64 {
        self.measured.back().map_or(self.start_deg, |(_, deg)| *deg)
    }

    /// The turn rate at the newest measurement, predicted from the sticks.
    pub(crate) fn newest_turn_deg_s(&self) -> f64 {
        self.turn_deg_s
    }

    /// The drone's compass has restarted. The drone has stood still, or turned unseen: it has the heading that it had last.
    pub(crate) fn handle_restart(&mut self) {
        self.start_deg = self.newest_deg();
        self.baseline_deg = None;
        self.measured.clear();
        self.turn_deg_s = 0.0;
        self.silence = Silence::default();
    }
}

/// How far a value lies outside an interval of angles, in degrees; it may be a whole turn away.
fn beyond(deg: f64, least_deg: f64, most_deg: f64) -> f64 {
    [-360.0, 0.0, 360.0]
        .map(|whole_deg| (least_deg - deg - whole_deg).max(deg + whole_deg - most_deg).max(0.0))
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

/// The model of a turn.
#[derive(Debug, Clone, Copy)]
struct Turning<'a> {
    orders: &'a Orders,
    airframe: &'a Airframe,
    limits: &'a DroneLimits,
}

impl Turning<'_> {
    /// Final rate and angle of a turn as ordered.
    fn turned(&self, rate_deg_s: f64, from_s: f64, to_s: f64) -> (f64, f64) {
        let (mut rate_deg_s, mut angle_deg) = (rate_deg_s, 0.0);
        self.orders.steps(from_s, to_s, |_, step_s, order| {
            let wanted_deg_s = self.wanted_deg_s(order);
            rate_deg_s +=
                (wanted_deg_s - rate_deg_s) * (1.0 - (-step_s / self.airframe.turn_lag_s).exp());
            angle_deg += rate_deg_s * step_s;
        });
        (rate_deg_s, angle_deg)
    }

    /// Angle of the turn of a drone that received its orders until `until_s`, kept the last one for a while, and then
    /// stopped.
    fn kept(&self, rate_deg_s: f64, from_s: f64, until_s: f64, to_s: f64) -> f64 {
        let (rate_deg_s, angle_deg) = self.turned(rate_deg_s, from_s, until_s);
        let wanted_deg_s = self.wanted_deg_s(self.orders.at(until_s));
        let kept_s = (to_s - until_s).min(KEPT_S);
        let lag_s = self.airframe.turn_lag_s;
        let gained_s = lag_s * (1.0 - (-kept_s / lag_s).exp());
        angle_deg + wanted_deg_s * kept_s + (rate_deg_s - wanted_deg_s) * gained_s
    }

    /// Turn rate that an order asks for.
    fn wanted_deg_s(&self, order: Order) -> f64 {
        match order {
            Order::Sticks(sticks) => sticks.yaw * self.limits.turn_deg_s * self.airframe.turn_gain,
            Order::ByItself => 0.0,
        }
    }
}

#[cfg(test)]
mod tests;
