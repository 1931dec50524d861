//! How far the estimate may be from the truth: a place that is integrated from a velocity drifts, and
//! whoever flies by it should know by how much.
//!
//! The deviations are those of the flight model's worse sensors, so that the figure errs on the safe
//! side indoors: the flow's bias, its scale, the heading's drift, and what was flown unseen.

/// Standard deviation of the flow's bias.
const BIAS_M_S: f64 = 0.013;
/// Of the flow's scale, as a share of the distance from the start.
const SCALE: f64 = 0.06;
/// Of the heading's drift.
const HEADING_DRIFT_DEG_S: f64 = 0.03;
/// Of the velocity while nothing is heard.
const UNSEEN_M_S: f64 = 0.3;
/// Of the place while navdata are late.
const FLOOR_M: f64 = 0.02;
/// Of a height.
const HEIGHT_M: f64 = 0.015;
/// Of the height after each step of the floor.
const FLOOR_STEP_M: f64 = 0.05;

/// What adds to the uncertainty.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Uncertainty {
    flown_s: f64,
    unseen_m2: f64,
    floor_steps: u32,
}

impl Uncertainty {
    /// So long was flown; `gap_s` of it is more than packets usually are apart.
    pub(crate) fn fly(&mut self, step_s: f64, gap_s: f64) {
        self.flown_s += step_s;
        self.unseen_m2 += (UNSEEN_M_S * gap_s).powi(2);
    }

    pub(crate) fn step_of_the_floor(&mut self) {
        self.floor_steps += 1;
    }

    /// Standard deviation of the place across the ground, on each axis, `distance_m` from the start;
    /// the newest sample is `silence_s` old.
    pub(crate) fn horizontal_m(&self, distance_m: f64, silence_s: f64) -> f64 {
        let turned = (HEADING_DRIFT_DEG_S * self.flown_s).to_radians();
        [
            FLOOR_M,
            BIAS_M_S * self.flown_s,
            SCALE * distance_m,
            turned * distance_m,
            self.unseen_m2.sqrt(),
            UNSEEN_M_S * silence_s,
        ]
        .iter()
        .map(|part| part * part)
        .sum::<f64>()
        .sqrt()
    }

    /// Standard deviation of the height.
    pub(crate) fn vertical_m(&self, silence_s: f64) -> f64 {
        let steps_m = FLOOR_STEP_M * f64::from(self.floor_steps).sqrt();
        HEIGHT_M.hypot(steps_m).hypot(UNSEEN_M_S * silence_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_only_grows() {
        let mut uncertainty = Uncertainty::default();
        let mut last = uncertainty.horizontal_m(0.0, 0.0);
        for step in 0..100 {
            uncertainty.fly(0.066, if step % 10 == 0 { 0.2 } else { 0.0 });
            let now = uncertainty.horizontal_m(0.0, 0.0);
            assert!(now > last);
            last = now;
        }
        assert!(uncertainty.horizontal_m(3.0, 0.0) > last);
        assert!(uncertainty.horizontal_m(0.0, 1.0) > last);
        let before = uncertainty.vertical_m(0.0);
        uncertainty.step_of_the_floor();
        assert!(uncertainty.vertical_m(0.0) > before);
    }
}
