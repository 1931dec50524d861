//! The wind: steady, with gusts.

use nalgebra::Vector2;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

use crate::airframe::STEP_S;

/// Time constant of the gusts.
const GUST_TIME_CONSTANT_S: f64 = 2.0;

/// Wind that blows towards (right, forward).
#[derive(Debug, Clone)]
pub(crate) struct Wind {
    pub(crate) steady_m_s: Vector2<f64>,
    pub(crate) gust_deviation_m_s: f64,
    gust_m_s: Vector2<f64>,
    random: ChaCha8Rng,
}

impl Wind {
    pub(crate) fn new(steady_m_s: Vector2<f64>, gust_deviation_m_s: f64, seed: u64) -> Self {
        Self {
            steady_m_s,
            gust_deviation_m_s,
            gust_m_s: Vector2::zeros(),
            random: ChaCha8Rng::seed_from_u64(seed ^ 0x7769_6e64),
        }
    }

    /// The wind in the next physics step: a Gauss-Markov process around the steady wind.
    pub(crate) fn step(&mut self) -> Vector2<f64> {
        if self.gust_deviation_m_s > 0.0 {
            let fade = STEP_S / GUST_TIME_CONSTANT_S;
            let deviation = self.gust_deviation_m_s * (2.0 * fade).sqrt();
            let kick = Vector2::new(
                StandardNormal.sample(&mut self.random),
                StandardNormal.sample(&mut self.random),
            ) * deviation;
            self.gust_m_s += kick - self.gust_m_s * fade;
        }
        self.steady_m_s + self.gust_m_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_have_the_deviation_that_was_asked_for() {
        let mut wind = Wind::new(Vector2::new(1.0, 0.0), 0.5, 7);
        let samples: Vec<Vector2<f64>> = (0..400_000).map(|_| wind.step()).collect();
        #[allow(clippy::cast_precision_loss)]
        let count = samples.len() as f64;
        let mean = samples.iter().sum::<Vector2<f64>>() / count;
        let variance =
            samples.iter().map(|sample| (sample.x - mean.x).powi(2)).sum::<f64>() / count;
        assert!((mean.x - 1.0).abs() < 0.1 && mean.y.abs() < 0.1, "{mean}");
        assert!((variance.sqrt() - 0.5).abs() < 0.1, "{variance}");
    }
}
