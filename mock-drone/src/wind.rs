//! The wind: steady, with gusts.

use nalgebra::Vector2;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use crate::gauss_markov::GaussMarkov;

/// Time constant of the gusts.
const GUST_TIME_CONSTANT_S: f64 = 2.0;

/// Wind that blows towards (right, forward).
#[derive(Debug, Clone)]
pub(crate) struct Wind {
    pub(crate) steady_m_s: Vector2<f64>,
    pub(crate) gusts_m_s: GaussMarkov,
}

impl Wind {
    pub(crate) fn new(steady_m_s: Vector2<f64>, gust_deviation_m_s: f64, seed: u64) -> Self {
        let random = ChaCha8Rng::seed_from_u64(seed ^ 0x7769_6e64);
        let gusts_m_s = GaussMarkov::at_zero(gust_deviation_m_s, GUST_TIME_CONSTANT_S, random);
        Self { steady_m_s, gusts_m_s }
    }

    /// The wind in the next physics step.
    pub(crate) fn step(&mut self) -> Vector2<f64> {
        self.steady_m_s + self.gusts_m_s.step()
    }
}
