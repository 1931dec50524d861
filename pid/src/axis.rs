//! One axis.

/// Gains and limits of one axis. Outputs are stick fractions, so the gains carry stick per unit
/// of error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gains {
    /// Per unit of error.
    pub proportional: f64,
    /// Per unit of error and second.
    pub integral: f64,
    /// Per unit of measured rate.
    pub derivative: f64,
    /// The integral's share of the output stays within plus and minus this.
    pub integral_limit: f64,
    /// The integral rests while the error is larger than this: on a long way the error is the
    /// way, not a disturbance.
    pub integral_zone: f64,
}

/// A PID controller with the derivative on the measured rate.
#[derive(Debug, Clone)]
pub struct Pid {
    gains: Gains,
    integral: f64,
}

impl Pid {
    /// A controller at rest.
    pub fn new(gains: Gains) -> Self {
        Self { gains, integral: 0.0 }
    }

    /// One step of `step_s` seconds: the output within plus and minus `limit`. Inputs that are no
    /// numbers give zero and leave the integral alone.
    pub fn step(&mut self, error: f64, rate: f64, step_s: f64, limit: f64) -> f64 {
        let gains = &self.gains;
        let proportional = gains.proportional * error - gains.derivative * rate;
        if !proportional.is_finite() {
            return 0.0;
        }
        let unlimited = proportional + self.integral;
        let saturated_towards_error = unlimited.abs() > limit && unlimited * error > 0.0;
        let near = -gains.integral_zone <= error && error <= gains.integral_zone;
        if near && !saturated_towards_error {
            let integral = self.integral + gains.integral * error * step_s;
            self.integral = integral.clamp(-gains.integral_limit, gains.integral_limit);
        }
        (proportional + self.integral).clamp(-limit, limit)
    }

    /// Forgets what was learnt of disturbances.
    pub fn reset(&mut self) {
        self.integral = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAINS: Gains = Gains {
        proportional: 1.0,
        integral: 0.5,
        derivative: 0.5,
        integral_limit: 0.3,
        integral_zone: 10.0,
    };

    #[test]
    fn the_output_stays_within_its_limit_and_a_new_target_causes_no_kick() {
        let mut pid = Pid::new(GAINS);
        assert!(pid.step(100.0, 0.0, 0.03, 0.5) <= 0.5);
        let mut pid = Pid::new(Gains { integral: 0.0, ..GAINS });
        let before = pid.step(0.0, 0.2, 0.03, 1.0);
        let after = pid.step(0.1, 0.2, 0.03, 1.0);
        assert!((after - before - 0.1).abs() < 1e-12);
    }

    #[test]
    fn the_integral_removes_a_standing_error_but_does_not_wind_up() {
        // A plant that drifts at a constant rate.
        let mut pid = Pid::new(Gains { derivative: 0.0, ..GAINS });
        let mut position = 0.0;
        for _ in 0..3000 {
            let output = pid.step(-position, 0.0, 0.03, 1.0);
            position += (output + 0.2) * 0.03;
        }
        assert!(position.abs() < 1e-3, "{position}");
        // Saturated for a long time, then the error turns: the output follows at once.
        let mut pid = Pid::new(GAINS);
        for _ in 0..10_000 {
            pid.step(5.0, 0.0, 0.03, 1.0);
        }
        assert!(pid.step(-0.5, 0.0, 0.03, 1.0) < 0.0);
    }

    #[test]
    fn what_is_no_number_moves_nothing_and_spoils_nothing() {
        let mut pid = Pid::new(GAINS);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(pid.step(bad, 0.0, 0.03, 1.0).abs() <= 0.0);
            assert!(pid.step(0.0, bad, 0.03, 1.0).abs() <= 0.0);
        }
        assert!(pid.step(0.0, 0.0, 0.03, 1.0).abs() <= 0.0);
    }
}
