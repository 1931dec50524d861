//! PID controller of one axis.

/// Gains of one axis, in units of output per unit of error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PidGains {
    /// Output per error.
    pub proportional: f64,
    /// Output per error and second.
    pub integral: f64,
    /// Output per rate of error.
    pub derivative: f64,
}

/// Inputs of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PidInputs {
    /// Setpoint.
    pub setpoint: f64,
    /// Rate of the setpoint. Zero for a step, so that a step causes no derivative kick.
    pub setpoint_rate: f64,
    /// Measured value.
    pub measured: f64,
    /// Measured rate; errors are not differentiated.
    pub measured_rate: f64,
    /// Output that would suffice without errors.
    pub feed_forward: f64,
}

/// PID controller of one axis, in the parallel form.
///
/// The derivative acts on the measurement. Anti-windup is by back-calculation: the integral gives up the part
/// of the output that the actuator could not apply, with the integral's own time constant (K. J. Åström and
/// T. Hägglund, *Advanced PID Control*, 2006, §3.5). The controller can take over from another one without a
/// jump. Limiting is left to the caller, because several axes may share an actuator.
///
/// ```
/// use pid::{Pid, PidGains, PidInputs};
///
/// let mut pid = Pid::new(PidGains { proportional: 2.0, integral: 1.0, ..PidGains::default() });
/// let inputs = PidInputs { setpoint: 1.0, ..PidInputs::default() };
/// let wanted = pid.output(&inputs);
/// let applied = wanted.clamp(-1.0, 1.0);
/// pid.learn(&inputs, wanted, applied, 0.03);
/// assert_eq!(applied, 1.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pid {
    gains: PidGains,
    integral: f64,
}

impl Pid {
    /// A controller with its integral at zero.
    pub fn new(gains: PidGains) -> Self {
        Self { gains, integral: 0.0 }
    }

    /// The output before limiting.
    pub fn output(&self, inputs: &PidInputs) -> f64 {
        self.without_integral(inputs) + self.integral
    }

    /// Updates the integral for the next step of `step_s` seconds, from the error and from the `applied` part
    /// of the `wanted` output. Without a proportional gain there is no anti-windup.
    pub fn learn(&mut self, inputs: &PidInputs, wanted: f64, applied: f64, step_s: f64) {
        let PidGains { integral, proportional, .. } = self.gains;
        let error = inputs.setpoint - inputs.measured;
        let not_carried_out =
            if proportional > 0.0 { (applied - wanted) / proportional } else { 0.0 };
        self.integral += integral * (error + not_carried_out) * step_s;
    }

    /// Sets the integral so that the next output is `output` (bumpless transfer).
    pub fn take_over(&mut self, inputs: &PidInputs, output: f64) {
        self.integral = output - self.without_integral(inputs);
    }

    /// Changes the gains and keeps the integral.
    pub fn set_gains(&mut self, gains: PidGains) {
        self.gains = gains;
    }

    /// The integral part of the output.
    pub fn integral(&self) -> f64 {
        self.integral
    }

    fn without_integral(&self, inputs: &PidInputs) -> f64 {
        inputs.feed_forward
            + self.gains.proportional * (inputs.setpoint - inputs.measured)
            + self.gains.derivative * (inputs.setpoint_rate - inputs.measured_rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAINS: PidGains = PidGains { proportional: 2.0, integral: 1.0, derivative: 0.5 };

    /// A mass driven by the output and a disturbance; returns its position in each step.
    fn push(pid: &mut Pid, setpoint: f64, disturbance: f64, limit: f64, steps: u32) -> Vec<f64> {
        let (mut place, mut speed) = (0.0, 0.0);
        (0..steps)
            .map(|_| {
                let inputs = PidInputs {
                    setpoint,
                    measured: place,
                    measured_rate: speed,
                    ..PidInputs::default()
                };
                let wanted = pid.output(&inputs);
                let applied = wanted.clamp(-limit, limit);
                pid.learn(&inputs, wanted, applied, 0.01);
                speed += (applied + disturbance - 2.0 * speed) * 0.01;
                place += speed * 0.01;
                place
            })
            .collect()
    }

    #[test]
    fn a_step_of_the_setpoint_kicks_nothing_and_the_rate_damps() {
        let pid = Pid::new(GAINS);
        let step = PidInputs { setpoint: 1.0, ..PidInputs::default() };
        assert!((pid.output(&step) - 2.0).abs() < 1e-12);
        let moving = PidInputs { measured_rate: 1.0, ..step };
        assert!((pid.output(&moving) - 1.5).abs() < 1e-12);
    }

    #[test]
    fn what_pushes_all_the_time_is_learnt() {
        let places = push(&mut Pid::new(GAINS), 1.0, -0.7, 10.0, 4000);
        assert!((places[3999] - 1.0).abs() < 1e-3, "{}", places[3999]);
    }

    #[test]
    fn an_output_that_cannot_be_carried_out_does_not_wind_up() {
        let overshoot = |limit| {
            let places = push(&mut Pid::new(GAINS), 5.0, 0.0, limit, 6000);
            places.into_iter().fold(0.0, f64::max) - 5.0
        };
        assert!(overshoot(1.5) < overshoot(1e9), "{} {}", overshoot(1.5), overshoot(1e9));
    }

    #[test]
    fn it_takes_over_without_a_jump() {
        let mut pid = Pid::new(GAINS);
        let inputs = PidInputs { setpoint: 3.0, measured: 1.0, ..PidInputs::default() };
        pid.take_over(&inputs, -0.4);
        assert!((pid.output(&inputs) + 0.4).abs() < 1e-12);
        assert!((pid.integral() + 4.4).abs() < 1e-12);
    }
}
