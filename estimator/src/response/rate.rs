//! Whether a measurement follows a stick that asks for a rate: climb and turn.
//!
//! How an airframe answers is not known exactly: it may do so with any lag of the published models, and descend faster than
//! it climbs. A measurement is accused only if it shows too little under each of these hypotheses.

/// Time constant with which a missing response is forgotten.
const FORGET_S: f64 = 10.0;
/// Below this fraction of full stick the gains of the airframe make no difference, and neither do its lags
/// once the command has been this slow for this long.
const SLOW_SHARE: f64 = 0.35;
const SLOW_TIME_S: f64 = 2.0;
/// How long a response must be missing: one wrong echo may look like it.
pub(super) const MISSING_TIME_S: f64 = 0.12;

/// Tolerances of an axis that follows its stick as a rate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tolerance {
    /// Smallest fraction of the commanded rate that an airframe achieves.
    pub(super) share: f64,
    /// More than this multiple of it none achieves.
    pub(super) most: f64,
    /// Drift of a healthy sensor, and rates too small to judge, per second.
    pub(super) slack: f64,
    /// Tolerated missing, or excessive, response in total: to all commands, and to slow commands.
    pub(super) missing: f64,
    pub(super) missing_slowly: f64,
    /// A measurement further than this from the expected one, plus this much per second, has jumped; jumps
    /// are judged elsewhere.
    pub(super) jump: f64,
    pub(super) jump_1_s: f64,
    /// Full rate is the stick's times this.
    pub(super) full: f64,
}

/// How an airframe may answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Answer {
    pub(super) lag_s: f64,
    /// Gain of a negative rate.
    pub(super) down: f64,
}

/// A response and what an airframe would have shown, by one hypothesis.
#[derive(Debug, Clone, Copy)]
struct Hypothesis {
    answer: Answer,
    /// Rate that follows the stick, and its integral since the last measurement.
    now: f64,
    way: f64,
    missing: f64,
    excess: f64,
    missing_slowly: f64,
    slow_for_s: f64,
}

/// The axis, judged by several hypotheses, of which the first is the ordinary airframe.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rate<const N: usize> {
    tolerance: Tolerance,
    hypotheses: [Hypothesis; N],
    /// What the stick asked of the ordinary airframe since the flight began.
    asked: f64,
    last: Option<f64>,
    /// Whether the stick asked for anything since the last measurement.
    asks: bool,
    /// How fast the drone moves is not known yet.
    is_new: bool,
    missing_for_s: f64,
}

impl Hypothesis {
    fn new(answer: Answer) -> Self {
        Self {
            answer,
            now: 0.0,
            way: 0.0,
            missing: 0.0,
            excess: 0.0,
            missing_slowly: 0.0,
            slow_for_s: 0.0,
        }
    }

    fn follow(&mut self, wanted: f64, step_s: f64) -> f64 {
        let wanted = if wanted < 0.0 { wanted * self.answer.down } else { wanted };
        let before = self.now;
        self.now += (wanted - self.now) * (1.0 - (-step_s / self.answer.lag_s).exp());
        let way = f64::midpoint(before, self.now) * step_s;
        self.way += way;
        way
    }

    fn compare(&mut self, moved: f64, step_s: f64, tolerance: &Tolerance) {
        let forgotten = (-step_s / FORGET_S).exp();
        let slack = tolerance.slack * step_s;
        let lacking = self.way.signum() * (tolerance.share * self.way - moved);
        self.missing = (self.missing * forgotten + lacking - slack).max(0.0);
        let exceeding = self.way.signum() * (moved - tolerance.most * self.way);
        self.excess = (self.excess * forgotten + exceeding - slack).max(0.0);
        self.missing_slowly *= forgotten;
        let is_slow = self.now.abs() < SLOW_SHARE * tolerance.full;
        self.slow_for_s = if is_slow { self.slow_for_s + step_s } else { 0.0 };
        if self.slow_for_s > SLOW_TIME_S {
            self.missing_slowly += self.way - moved;
        }
    }
}

impl<const N: usize> Rate<N> {
    pub(super) fn new(tolerance: Tolerance, answers: [Answer; N]) -> Self {
        Self {
            tolerance,
            hypotheses: answers.map(Hypothesis::new),
            asked: 0.0,
            last: None,
            asks: false,
            is_new: true,
            missing_for_s: 0.0,
        }
    }

    /// The stick asks for a rate, for a time.
    pub(super) fn follow(&mut self, wanted: f64, step_s: f64) {
        self.asks |= wanted != 0.0;
        let mut ways = self.hypotheses.iter_mut().map(|its| its.follow(wanted, step_s));
        self.asked += ways.next().unwrap_or(0.0);
        ways.for_each(drop);
    }

    /// Compares a measurement with what was asked for in the `step_s` since the last one. With its stick at rest the drone
    /// goes back by itself to where it was when the stick was released: that is not judged.
    pub(super) fn compare(&mut self, value: f64, step_s: f64, difference: fn(f64) -> f64) {
        let Some(last) = self.last.replace(value) else { return };
        let moved = difference(value - last);
        if std::mem::take(&mut self.is_new) {
            self.begin(moved / step_s.max(f64::EPSILON));
            return;
        }
        let Tolerance { jump, jump_1_s, missing, missing_slowly, .. } = self.tolerance;
        let off = self.hypotheses.iter().map(|its| (moved - its.way).abs());
        let jumped = off.fold(f64::INFINITY, f64::min) > jump + jump_1_s * step_s;
        let is_judged = std::mem::take(&mut self.asks) && !jumped;
        for its in &mut self.hypotheses {
            if is_judged {
                its.compare(moved, step_s, &self.tolerance);
            }
            its.way = 0.0;
        }
        if !is_judged {
            return;
        }
        let all = |is: fn(&Hypothesis, f64) -> bool, most: f64| {
            self.hypotheses.iter().all(|its| is(its, most))
        };
        let is_missing = all(|its, most| its.missing > most, missing)
            || all(|its, most| its.excess > most, missing)
            || all(|its, most| its.missing_slowly > most, missing_slowly)
            || all(|its, most| its.missing_slowly < -most, missing_slowly);
        self.missing_for_s = if is_missing { self.missing_for_s + step_s } else { 0.0 };
    }

    /// The drone follows its stick from now on, and moves at this rate.
    fn begin(&mut self, rate: f64) {
        self.asks = false;
        for its in &mut self.hypotheses {
            let most = self.tolerance.full * its.answer.down;
            *its = Hypothesis { now: rate.clamp(-most, most), ..Hypothesis::new(its.answer) };
        }
    }

    /// Change that the stick has asked for since the flight began.
    pub(super) fn asked(&self) -> f64 {
        self.asked
    }

    pub(super) fn is_missing(&self) -> bool {
        self.missing_for_s >= MISSING_TIME_S
    }

    /// The drone moves by itself, and measures a value.
    pub(super) fn rest(&mut self, value: f64) {
        self.hypotheses = self.hypotheses.map(|its| Hypothesis::new(its.answer));
        self.asks = false;
        self.is_new = true;
        self.missing_for_s = 0.0;
        self.last = Some(value);
    }
}

#[cfg(test)]
mod tests;
