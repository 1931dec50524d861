//! Identifies gains and a lag from commands and responses.
//!
//! For a given lag the response is linear in the gains. There is one hypothesis for each of several lags;
//! each fits its gains by recursive least squares, and its residuals give the probability of its lag
//! (Bayesian model averaging). The estimate is the mean over the hypotheses: it moves smoothly from the prior
//! to the data, and a wrong lag loses its weight quickly.

use nalgebra::{SMatrix, SVector};

/// A lag, and how well each set of gains explains the responses with it.
#[derive(Debug, Clone, Copy)]
struct Hypothesis<const GAINS: usize> {
    lag_s: f64,
    /// Logarithm of the prior probability.
    prior: f64,
    information: SMatrix<f64, GAINS, GAINS>,
    moment: SVector<f64, GAINS>,
    square: f64,
}

impl<const GAINS: usize> Hypothesis<GAINS> {
    fn gains(&self) -> SVector<f64, GAINS> {
        // The prior makes the information positive definite.
        self.information.cholesky().map_or_else(SVector::zeros, |matrix| matrix.solve(&self.moment))
    }

    /// Sum of the squared residuals, in units of the noise.
    fn unexplained(&self, gains: &SVector<f64, GAINS>) -> f64 {
        (self.square - self.moment.dot(gains)).max(0.0)
    }
}

/// The prior.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Assumption<const GAINS: usize> {
    pub(crate) gains: [f64; GAINS],
    /// Standard deviations of the gains.
    pub(crate) spreads: [f64; GAINS],
    pub(crate) lag_s: f64,
    /// Standard deviation of the logarithm of the lag.
    pub(crate) lag_spread: f64,
    /// Standard deviation of one response, as if all responses were independent.
    pub(crate) noise: f64,
}

impl<const GAINS: usize> Assumption<GAINS> {
    /// Logarithm of the probability of a lag.
    fn prior(&self, lag_s: f64) -> f64 {
        let off = (lag_s / self.lag_s).ln() / self.lag_spread;
        -off * off / 2.0
    }
}

/// Hypotheses for several lags.
#[derive(Debug, Clone)]
pub(crate) struct Bank<const LAGS: usize, const GAINS: usize> {
    hypotheses: [Hypothesis<GAINS>; LAGS],
    noise: f64,
}

/// Fraction of the information that is forgotten with each response of full excitation, because gains change
/// as the battery empties.
const FORGETTING: f64 = 0.002;

impl<const LAGS: usize, const GAINS: usize> Bank<LAGS, GAINS> {
    pub(crate) fn new(lags_s: [f64; LAGS], assumption: &Assumption<GAINS>) -> Self {
        let Assumption { gains, spreads, noise, .. } = *assumption;
        let gains = SVector::from(gains);
        let information =
            SMatrix::from_diagonal(&SVector::from(spreads).map(|spread: f64| spread.powi(-2)));
        let hypotheses = lags_s.map(|candidate_s| {
            let moment = information * gains;
            Hypothesis {
                lag_s: candidate_s,
                prior: assumption.prior(candidate_s),
                information,
                moment,
                square: gains.dot(&moment),
            }
        });
        Self { hypotheses, noise }
    }

    /// Sets the logarithms of the prior probabilities of the hypotheses, which the prior of the lag multiplies.
    pub(crate) fn expect(&mut self, assumption: &Assumption<GAINS>, logs: &[f64; LAGS]) {
        for (hypothesis, log) in self.hypotheses.iter_mut().zip(logs) {
            hypothesis.prior = assumption.prior(hypothesis.lag_s) + log;
        }
    }

    /// Learns from a response, and from the excitation that each lag's model derives from the sticks: the
    /// response should be the gains times the excitation.
    pub(crate) fn learn(&mut self, answer: f64, causes: &[SVector<f64, GAINS>; LAGS]) {
        let answer = answer / self.noise;
        let seen = causes.iter().map(SVector::norm_squared).sum::<f64>()
            / (self.noise.powi(2) * causes.len() as f64);
        let keep = 1.0 - FORGETTING * seen.min(1.0);
        for (hypothesis, cause) in self.hypotheses.iter_mut().zip(causes) {
            let cause = cause / self.noise;
            hypothesis.information = hypothesis.information * keep + cause * cause.transpose();
            hypothesis.moment = hypothesis.moment * keep + cause * answer;
            hypothesis.square = hypothesis.square * keep + answer * answer;
        }
    }

    /// A gain may have changed, with this standard deviation. All that was learnt of the others stays.
    pub(crate) fn doubt(&mut self, gain: usize, spread: f64) {
        for it in &mut self.hypotheses {
            let column = it.information.column(gain).clone_owned();
            let share = 1.0 / (spread.powi(-2) + column[gain]);
            let moment = it.moment[gain];
            it.information -= column * column.transpose() * share;
            it.moment -= column * (share * moment);
            it.square -= share * moment * moment;
        }
    }

    /// The lag in seconds and the gains.
    pub(crate) fn estimate(&self) -> (f64, SVector<f64, GAINS>) {
        let (lag_s, gains, _) = self.estimate_with(&[0.0; LAGS]);
        (lag_s, gains)
    }

    /// The lag in seconds, the gains, and the mean of what else differs between the hypotheses.
    pub(crate) fn estimate_with(&self, others: &[f64; LAGS]) -> (f64, SVector<f64, GAINS>, f64) {
        let judged = self.hypotheses.map(|hypothesis| {
            let gains = hypothesis.gains();
            (hypothesis, gains, hypothesis.prior - hypothesis.unexplained(&gains) / 2.0)
        });
        let best = judged.iter().map(|(.., log)| *log).fold(f64::NEG_INFINITY, f64::max);
        let (mut sum, mut lag_s, mut gains, mut mean) = (0.0, 0.0, SVector::zeros(), 0.0);
        for ((hypothesis, its_gains, log), other) in judged.into_iter().zip(others) {
            let weight = (log - best).exp();
            sum += weight;
            lag_s += hypothesis.lag_s * weight;
            gains += its_gains * weight;
            mean += other * weight;
        }
        (lag_s / sum, gains / sum, mean / sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAGS_S: [f64; 4] = [0.2, 0.4, 0.8, 1.6];
    const ASSUMPTION: Assumption<2> =
        Assumption { gains: [1.0; 2], spreads: [0.5; 2], lag_s: 0.5, lag_spread: 0.5, noise: 0.02 };

    /// Excitations for which the lag `true_lag` is right: its model gives `shape` times the others.
    fn causes(step: u32, true_lag: usize) -> [SVector<f64, 2>; 4] {
        std::array::from_fn(|i| {
            let phase = f64::from(step) * 0.1 - (i as f64 - true_lag as f64) * 0.4;
            SVector::<f64, 2>::new(phase.sin().max(0.0), phase.sin().min(0.0)) * 0.2
        })
    }

    #[test]
    fn what_is_assumed_holds_until_something_is_seen() {
        let mut bank = Bank::<4, 2>::new(LAGS_S, &ASSUMPTION);
        let (lag_s, gains) = bank.estimate();
        assert!((0.4..0.7).contains(&lag_s), "{lag_s}");
        assert!((gains.x - 1.0).abs() < 1e-9);
        // Noise without excitation teaches nothing.
        for i in 0..10_000 {
            bank.learn(if i % 2 == 0 { 0.03 } else { -0.03 }, &[SVector::zeros(); 4]);
        }
        let (after_s, gains) = bank.estimate();
        assert!((after_s - lag_s).abs() < 1e-9 && (gains.x - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_right_lag_and_gains_are_found_and_followed() {
        for true_lag in 0..4 {
            let mut bank = Bank::new(LAGS_S, &ASSUMPTION);
            let mut fly = |range: std::ops::Range<u32>, up: f64, down: f64| {
                for step in range {
                    let causes = causes(step, true_lag);
                    let noise = if step % 2 == 0 { 0.01 } else { -0.01 };
                    let answer = causes[true_lag].dot(&SVector::<f64, 2>::new(up, down)) + noise;
                    bank.learn(answer, &causes);
                }
                bank.estimate()
            };
            let (lag_s, gains) = fly(0..200, 0.8, 1.7);
            assert!((lag_s / LAGS_S[true_lag] - 1.0).abs() < 0.1, "{true_lag}: {lag_s}");
            assert!((gains.x - 0.8).abs() < 0.06 && (gains.y - 1.7).abs() < 0.1, "{gains}");
            // A falling gain is followed.
            let (_, gains) = fly(200..6000, 0.6, 1.7);
            assert!((gains.x - 0.6).abs() < 0.03, "{gains}");
        }
    }

    #[test]
    fn what_is_doubted_is_learnt_anew_and_the_rest_is_kept() {
        let mut bank = Bank::<1, 2>::new([1.0], &ASSUMPTION);
        let learn = |bank: &mut Bank<1, 2>, gains: [f64; 2], steps: u32| {
            for step in 0..steps {
                let cause = SVector::<f64, 2>::new(0.1 * (f64::from(step) * 0.3).sin(), 0.1);
                bank.learn(cause.dot(&SVector::from(gains)), &[cause]);
            }
            bank.estimate().1
        };
        learn(&mut bank, [0.8, 1.0], 400);
        let (before, mut sure) = (bank.estimate().1, bank.clone());
        bank.doubt(1, 10.0);
        let doubted = bank.estimate().1;
        assert!((doubted - before).norm() < 1e-9, "what is likeliest stays: {doubted}");
        let unexplained = |bank: &Bank<1, 2>| bank.hypotheses[0].unexplained(&before);
        assert!((unexplained(&bank) - unexplained(&sure)).abs() < 1e-6, "and how likely it is");
        let found = learn(&mut bank, [0.8, -1.0], 5);
        assert!((found - SVector::<f64, 2>::new(0.8, -1.0)).norm() < 0.05, "{found}");
        assert!(learn(&mut sure, [0.8, -1.0], 5).y > 0.5, "otherwise it is not believed");
    }

    /// One gain, and as many lags, of which each has its own excitation.
    fn small<const LAGS: usize>(lags_s: [f64; LAGS], spread: f64) -> Bank<LAGS, 1> {
        let (gains, spreads) = ([1.0], [spread]);
        let assumption = Assumption { gains, spreads, lag_s: 1.0, lag_spread: 0.5, noise: 0.02 };
        Bank::new(lags_s, &assumption)
    }

    #[test]
    fn information_is_forgotten_by_the_mean_excitation() {
        let learnt = |causes: [f64; 2]| {
            let mut bank = small([1.0, 1.0], 0.5);
            bank.learn(0.0, &causes.map(SVector::<f64, 1>::new));
            bank.hypotheses[0].information[(0, 0)]
        };
        // The prior is 1 / 0.5² = 4. Excitation counts in units of the noise, 0.02.
        for (causes, keep, gained) in [
            ([0.0, 0.0], 1.0, 0.0),
            ([0.01, 0.01], 1.0 - FORGETTING * 0.25, 0.25),
            ([0.01, 0.0], 1.0 - FORGETTING * 0.125, 0.25),
            ([0.0, 0.02], 1.0 - FORGETTING * 0.5, 0.0),
            // Full excitation.
            ([0.2, 0.2], 1.0 - FORGETTING, 100.0),
        ] {
            assert!((learnt(causes) - (4.0 * keep + gained)).abs() < 1e-9, "{causes:?}");
        }
    }

    #[test]
    fn lags_are_weighted_by_their_probability() {
        // A prior of two lags, one deviation of the logarithm apart on either side of the expected one.
        let e = 0.5_f64.exp();
        let mut bank = small([1.0 / e, 1.0, e], 1e-4);
        let weight = (-0.5_f64).exp();
        let expected_s = (weight / e + 1.0 + weight * e) / (1.0 + 2.0 * weight);
        assert!((bank.estimate().0 - expected_s).abs() < 1e-9);
        // The first lag explains the response; the residuals of the others are one and two deviations of the
        // noise.
        bank.learn(0.1, &[0.1, 0.08, 0.06].map(SVector::<f64, 1>::new));
        let weights = [weight, (-0.5_f64).exp(), weight * (-2.0_f64).exp()];
        let sum: f64 = weights.iter().sum();
        let expected_s = (weights[0] / e + weights[1] + weights[2] * e) / sum;
        let (lag_s, _) = bank.estimate();
        assert!((lag_s - expected_s).abs() < 1e-5, "{lag_s}, {expected_s}");
    }
}
