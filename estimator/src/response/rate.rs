//! Whether a measurement follows a stick that asks for a rate: climb and turn.
//!
//! How an airframe answers is not known exactly: it may do so with any lag of the published models, and with any gain
//! between the least and the largest. What it moves by lies between those two for one of the lags; what lies outside for
//! all of them is summed up and slowly forgotten (a cumulative sum for each side; Page, 1954).

/// Time constant with which evidence is forgotten.
const FORGET_S: f64 = 10.0;
/// How long there must be enough of it: one wrong echo may look like it.
pub(super) const LASTS_S: f64 = 0.12;

/// How far from what a stick asks for a measurement may be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tolerance {
    /// Least and largest gain of an airframe, and by what the largest is multiplied downwards.
    pub(super) gains: [f64; 2],
    pub(super) down: f64,
    /// Drift of a healthy sensor, per second.
    pub(super) slack: f64,
    /// Evidence that is enough.
    pub(super) enough: f64,
}

/// An airframe of one lag.
#[derive(Debug, Clone, Copy)]
struct Hypothesis {
    lag_s: f64,
    /// Least and most rate, and their integrals since the last measurement.
    rates: [f64; 2],
    ways: [f64; 2],
    /// How far the measurement was below the least, and above the most.
    below: f64,
    above: f64,
}

/// The axis, judged by several hypotheses.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rate<const N: usize> {
    tolerance: Tolerance,
    hypotheses: [Hypothesis; N],
    last: Option<f64>,
    /// Whether the stick asked for anything since the last measurement.
    asks: bool,
    /// How fast the drone moves is not known yet.
    is_new: bool,
    missing_for_s: f64,
}

impl Hypothesis {
    fn moving(lag_s: f64, rate: f64) -> Self {
        Self { lag_s, rates: [rate; 2], ways: [0.0; 2], below: 0.0, above: 0.0 }
    }

    fn follow(&mut self, wanted: [f64; 2], step_s: f64) {
        let followed = 1.0 - (-step_s / self.lag_s).exp();
        for ((rate, way), wanted) in self.rates.iter_mut().zip(&mut self.ways).zip(wanted) {
            let before = *rate;
            *rate += (wanted - *rate) * followed;
            *way += f64::midpoint(before, *rate) * step_s;
        }
    }

    fn compare(&mut self, moved: f64, step_s: f64, tolerance: &Tolerance) {
        let forgotten = (-step_s / FORGET_S).exp();
        let slack = tolerance.slack * step_s;
        let [least, most] = self.ways;
        self.below = (self.below * forgotten + least - moved - slack).max(0.0);
        self.above = (self.above * forgotten + moved - most - slack).max(0.0);
    }
}

impl<const N: usize> Rate<N> {
    pub(super) fn new(tolerance: Tolerance, lags_s: [f64; N]) -> Self {
        Self {
            tolerance,
            hypotheses: lags_s.map(|lag_s| Hypothesis::moving(lag_s, 0.0)),
            last: None,
            asks: false,
            is_new: true,
            missing_for_s: 0.0,
        }
    }

    /// The stick asks for a rate, for a time.
    pub(super) fn follow(&mut self, wanted: f64, step_s: f64) {
        self.asks |= wanted != 0.0;
        let Tolerance { gains: [least, most], down, .. } = self.tolerance;
        let wanted = if wanted < 0.0 {
            [most * down * wanted, least * wanted]
        } else {
            [least * wanted, most * wanted]
        };
        for its in &mut self.hypotheses {
            its.follow(wanted, step_s);
        }
    }

    /// Compares a measurement with what was asked for in the `step_s` since the last one. With its stick at rest the drone
    /// goes back by itself to where it was when the stick was released: that is not judged.
    pub(super) fn compare(&mut self, value: f64, step_s: f64, difference: fn(f64) -> f64) {
        let Some(last) = self.last.replace(value) else { return };
        let moved = difference(value - last);
        let is_judged = std::mem::take(&mut self.asks);
        if std::mem::take(&mut self.is_new) {
            // The drone follows its stick from now on, and moves at this rate.
            let rate = moved / step_s.max(f64::EPSILON);
            self.hypotheses = self.hypotheses.map(|its| Hypothesis::moving(its.lag_s, rate));
            return;
        }
        for its in &mut self.hypotheses {
            if is_judged {
                its.compare(moved, step_s, &self.tolerance);
            }
            its.ways = [0.0; 2];
        }
        if is_judged {
            let enough = self.tolerance.enough;
            let is_missing = self.hypotheses.iter().all(|its| its.below > enough)
                || self.hypotheses.iter().all(|its| its.above > enough);
            self.missing_for_s = if is_missing { self.missing_for_s + step_s } else { 0.0 };
        }
    }

    pub(super) fn is_missing(&self) -> bool {
        self.missing_for_s >= LASTS_S
    }

    /// The drone moves by itself, and measures a value.
    pub(super) fn rest(&mut self, value: Option<f64>) {
        self.hypotheses = self.hypotheses.map(|its| Hypothesis::moving(its.lag_s, 0.0));
        self.asks = false;
        self.is_new = true;
        self.missing_for_s = 0.0;
        self.last = value;
    }
}

#[cfg(test)]
mod tests;
