//! Several rejected measurements in a row: what was measured has made a step, or it moves on.

use nalgebra::SVector;

/// Number of measurements that show which of both it is.
const ENOUGH: u32 = 4;

/// Sums over rejected measurements, by which a step and a motion are fitted to them (least squares).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rejected<const N: usize> {
    count: u32,
    /// Since the last one that was not rejected.
    for_s: f64,
    /// Of how far each is from what is expected; of that times the time; and of the squares of both.
    sum: SVector<f64, N>,
    sum_s: SVector<f64, N>,
    sum_s2: f64,
    squares: f64,
}

/// What the rejected measurements show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shown<const N: usize> {
    Step,
    Motion(Motion<N>),
}

/// A motion since the last measurement that was not rejected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Motion<const N: usize> {
    pub(crate) rate_1_s: SVector<f64, N>,
    pub(crate) for_s: f64,
    /// Share of the sum of squares that it explains.
    pub(crate) explains: f64,
}

impl<const N: usize> Default for Rejected<N> {
    fn default() -> Self {
        let none = SVector::zeros();
        Self { count: 0, for_s: 0.0, sum: none, sum_s: none, sum_s2: 0.0, squares: 0.0 }
    }
}

impl<const N: usize> Rejected<N> {
    /// Adds one that was measured `step_s` after the one before.
    pub(crate) fn add(&mut self, away: SVector<f64, N>, step_s: f64) {
        self.count += 1;
        self.for_s += step_s;
        self.sum += away;
        self.sum_s += away * self.for_s;
        self.sum_s2 += self.for_s * self.for_s;
        self.squares += away.norm_squared();
    }

    pub(crate) fn count(&self) -> u32 {
        self.count
    }

    /// What fits better, once it can be told.
    pub(crate) fn shown(&self) -> Option<Shown<N>> {
        if self.count < ENOUGH {
            return None;
        }
        let by_motion = self.sum_s.norm_squared() / self.sum_s2;
        let by_step = self.sum.norm_squared() / f64::from(self.count);
        let motion = Motion {
            rate_1_s: self.sum_s / self.sum_s2,
            for_s: self.for_s,
            explains: by_motion / self.squares,
        };
        Some(if by_motion > by_step { Shown::Motion(motion) } else { Shown::Step })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::*;

    fn shown(away: impl Fn(f64) -> f64, count: u32) -> Option<Shown<2>> {
        let mut rejected = Rejected::default();
        for step in 1..=count {
            let away = away(0.05 * f64::from(step));
            rejected.add(Vector2::new(0.6 * away, -0.8 * away), 0.05);
        }
        rejected.shown()
    }

    #[test]
    fn four_tell_a_step_from_a_motion() {
        assert_eq!(shown(|_| 0.7, 3), None);
        assert_eq!(shown(|_| 0.7, 4), Some(Shown::Step));
        assert_eq!(shown(|s| 0.7 - 0.5 * s, 8), Some(Shown::Step), "it comes back slowly");
        let motion = |away: fn(f64) -> f64, count| match shown(away, count) {
            Some(Shown::Motion(motion)) => motion,
            other => panic!("{other:?}"),
        };
        let Motion { rate_1_s, for_s, explains } = motion(|s| 3.0 * s, 4);
        assert!((rate_1_s - Vector2::new(1.8, -2.4)).norm() < 1e-9, "{rate_1_s}");
        assert!((for_s - 0.2).abs() < 1e-9 && (explains - 1.0).abs() < 1e-9);
        // 0.1, 0.1, 0.2, 0.2 after 0.05, 0.1, 0.15, 0.2 s: products 0.085, squares of the time 0.075, of the values 0.1.
        let Motion { rate_1_s, explains, .. } = motion(|s| (s * 10.0).ceil() / 10.0, 4);
        assert!((rate_1_s.norm() - 0.085 / 0.075).abs() < 1e-9, "{rate_1_s}");
        assert!((explains - 0.085_f64.powi(2) / 0.075 / 0.1).abs() < 1e-9, "{explains}");
    }
}
