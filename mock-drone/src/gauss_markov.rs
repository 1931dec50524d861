//! Errors that stay for a while: Gauss-Markov processes.

use nalgebra::Vector2;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

use crate::airframe::STEP_S;

/// A Gauss-Markov process on two axes, which are independent of each other.
#[derive(Debug, Clone)]
pub(crate) struct GaussMarkov {
    /// Standard deviation on each axis. Without one no random number is drawn.
    pub(crate) deviation: f64,
    time_s: f64,
    value: Vector2<f64>,
    random: ChaCha8Rng,
}

impl GaussMarkov {
    /// One that begins at zero.
    pub(crate) fn at_zero(deviation: f64, time_s: f64, random: ChaCha8Rng) -> Self {
        Self { deviation, time_s, value: Vector2::zeros(), random }
    }

    /// One that has been going on for long.
    pub(crate) fn settled(deviation: f64, time_s: f64, random: ChaCha8Rng) -> Self {
        let mut process = Self::at_zero(deviation, time_s, random);
        process.value = process.kick() * deviation;
        process
    }

    /// Its value after another physics step.
    pub(crate) fn step(&mut self) -> Vector2<f64> {
        if self.deviation > 0.0 {
            let fade = STEP_S / self.time_s;
            let kick = self.kick() * (self.deviation * (2.0 * fade).sqrt());
            self.value += kick - self.value * fade;
        }
        self.value
    }

    /// Its value.
    pub(crate) fn value(&self) -> Vector2<f64> {
        self.value
    }

    fn kick(&mut self) -> Vector2<f64> {
        Vector2::new(
            StandardNormal.sample(&mut self.random),
            StandardNormal.sample(&mut self.random),
        )
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng as _;

    use super::*;

    #[test]
    fn it_has_its_deviation_and_stays_for_its_time() {
        let mut process = GaussMarkov::at_zero(0.5, 2.0, ChaCha8Rng::seed_from_u64(7));
        let samples: Vec<f64> = (0..800_000).map(|_| process.step().x).collect();
        #[allow(clippy::cast_precision_loss)]
        let mean = |sum: f64| sum / samples.len() as f64;
        let variance = mean(samples.iter().map(|sample| sample * sample).sum());
        assert!((variance.sqrt() - 0.5).abs() < 0.1, "{variance}");
        // After its time 1/e of it is left.
        let later = samples.iter().skip(800).zip(&samples).map(|(later, now)| later * now).sum();
        assert!((mean(later) / variance - 0.37).abs() < 0.15);
        let process = |seed| GaussMarkov::settled(3.0, 60.0, ChaCha8Rng::seed_from_u64(seed));
        let squares: f64 = (0..4000).map(|seed| process(seed).value().norm_squared()).sum();
        assert!((squares / 4000.0 - 18.0).abs() < 1.0, "{squares}");
    }
}
