//! Height and climb rate from a noisy height.

/// Height and vertical speed.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Vertical {
    pub(crate) height_m: f64,
    pub(crate) climb_m_s: f64,
}

/// An alpha-beta filter that does not follow single bad echoes of the ultrasound sensor.
#[derive(Debug, Clone, Default)]
pub(crate) struct AltitudeFilter {
    state: Option<Vertical>,
    rejected: u32,
}

impl AltitudeFilter {
    /// Time constant of the correction.
    const TIME_CONSTANT_S: f64 = 0.15;
    /// A height further than this from the expected one is a bad echo...
    const MAX_JUMP_M: f64 = 0.3;
    /// ...unless it persists for this many samples: then the floor has changed.
    const MAX_REJECTED: u32 = 5;

    pub(crate) fn update(&mut self, altitude_m: f64, step_s: f64) -> Vertical {
        let Some(state) = self.state else {
            return *self.state.insert(Vertical { height_m: altitude_m, climb_m_s: 0.0 });
        };
        let predicted_m = state.height_m + state.climb_m_s * step_s;
        let surprise_m = altitude_m - predicted_m;
        if surprise_m.abs() > Self::MAX_JUMP_M && self.rejected < Self::MAX_REJECTED {
            self.rejected += 1;
            // The climb rate fades: what is not seen is not extrapolated for long.
            let climb_m_s = state.climb_m_s * 0.8;
            return *self.state.insert(Vertical { height_m: predicted_m, climb_m_s });
        }
        if self.rejected >= Self::MAX_REJECTED {
            self.rejected = 0;
            return *self.state.insert(Vertical { height_m: altitude_m, climb_m_s: 0.0 });
        }
        self.rejected = 0;
        if step_s <= 0.0 {
            return state;
        }
        // Critically damped: beta follows from alpha (Benedict and Bordner, 1962).
        let alpha = step_s / (step_s + Self::TIME_CONSTANT_S);
        let beta = alpha * alpha / (2.0 - alpha);
        *self.state.insert(Vertical {
            height_m: predicted_m + alpha * surprise_m,
            climb_m_s: state.climb_m_s + beta * surprise_m / step_s,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_climb_is_followed_without_lag() {
        let mut filter = AltitudeFilter::default();
        let mut vertical = Vertical::default();
        for i in 0..100 {
            vertical = filter.update(0.5 * 0.066 * f64::from(i), 0.066);
        }
        assert!((vertical.climb_m_s - 0.5).abs() < 0.01, "{vertical:?}");
        assert!((vertical.height_m - 0.5 * 0.066 * 99.0).abs() < 0.01, "{vertical:?}");
    }

    #[test]
    fn a_bad_echo_is_ignored_and_a_new_floor_is_accepted() {
        let mut filter = AltitudeFilter::default();
        for _ in 0..50 {
            filter.update(1.0, 0.066);
        }
        assert!((filter.update(2.5, 0.066).height_m - 1.0).abs() < 0.01);
        assert!((filter.update(1.0, 0.066).height_m - 1.0).abs() < 0.01);
        let mut vertical = Vertical::default();
        for _ in 0..8 {
            vertical = filter.update(0.4, 0.066);
        }
        assert!((vertical.height_m - 0.4).abs() < 0.05, "{vertical:?}");
    }
}
