//! Time-optimal height reference within the limits of the airframe.
//!
//! The rate of climb follows its stick with a lag, and its limits differ upwards and downwards. The reference
//! therefore uses the full command first, then the opposite one: with lag `τ` and counter-command `B`, a
//! drone at speed `v` comes to rest within `τ (v - B ln(1 + v / B))`. The reference stays on that braking
//! curve, so target and limits may change at any time.

/// Vertical limits of the airframe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClimbLimits {
    /// Maximum rate of climb.
    pub(crate) rise_m_s: f64,
    /// Maximum rate of descent, positive.
    pub(crate) drop_m_s: f64,
    /// Maximum speed of the reference.
    pub(crate) speed_m_s: f64,
    /// Time constant of the rate of climb.
    pub(crate) lag_s: f64,
    /// Fraction of the limits that is used for braking.
    pub(crate) braking: f64,
}

/// Height and vertical speed of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClimbReference {
    pub(crate) height_m: f64,
    pub(crate) climb_m_s: f64,
}

/// Lower limit of the lag; every airframe is slower.
const SHORTEST_LAG_S: f64 = 0.02;
/// Integration steps, fine enough for the shortest lag.
const SUBSTEPS: u32 = 6;
/// Distance below which the target counts as reached.
const THERE_M: f64 = 5e-4;

impl ClimbReference {
    pub(crate) fn at_rest(height_m: f64) -> Self {
        Self { height_m, climb_m_s: 0.0 }
    }

    /// Advances towards a target. Returns the rate of climb that follows the reference without error.
    pub(crate) fn advance(&mut self, target_m: f64, step_s: f64, limits: &ClimbLimits) -> f64 {
        let substep_s = step_s / f64::from(SUBSTEPS);
        let commands = (0..SUBSTEPS).map(|_| self.substep(target_m, substep_s, limits));
        commands.sum::<f64>() / f64::from(SUBSTEPS)
    }

    fn substep(&mut self, target_m: f64, step_s: f64, limits: &ClimbLimits) -> f64 {
        let lag_s = limits.lag_s.max(SHORTEST_LAG_S);
        let followed = 1.0 - (-step_s / lag_s).exp();
        let left_m = target_m - self.height_m;
        let (drop_m_s, rise_m_s) = (limits.drop_m_s.max(0.0), limits.rise_m_s.max(0.0));
        let counter_m_s = limits.braking * if left_m > 0.0 { drop_m_s } else { rise_m_s };
        if step_s <= 0.0 {
            return 0.0;
        }
        let slowest_m_s = 2.0 * counter_m_s * followed;
        if left_m.abs() < THERE_M && self.climb_m_s.abs() <= slowest_m_s {
            *self = Self::at_rest(target_m);
            return 0.0;
        }
        let speed_m_s = speed_before_stop(left_m.abs(), counter_m_s, lag_s).min(limits.speed_m_s);
        let wanted_m_s = speed_m_s.copysign(left_m);
        let command_m_s = self.climb_m_s + (wanted_m_s - self.climb_m_s) / followed;
        let command_m_s = command_m_s.clamp(-drop_m_s, rise_m_s);
        let before_m_s = self.climb_m_s;
        self.climb_m_s += (command_m_s - before_m_s) * followed;
        self.height_m += f64::midpoint(before_m_s, self.climb_m_s) * step_s;
        command_m_s
    }
}

/// Speed from which the counter-command stops within a distance: inverts the stopping distance by Newton's
/// method.
fn speed_before_stop(distance_m: f64, counter_m_s: f64, lag_s: f64) -> f64 {
    if counter_m_s <= 0.0 {
        return 0.0;
    }
    // Starts below the solution: the deceleration at rest is the weakest, so assuming it throughout
    // underestimates the speed.
    let mut speed_m_s = (2.0 * counter_m_s / lag_s * distance_m).sqrt();
    for _ in 0..3 {
        let ratio = speed_m_s / counter_m_s;
        let off_m = lag_s * counter_m_s * (ratio - ratio.ln_1p()) - distance_m;
        let slope_s = lag_s * ratio / (1.0 + ratio);
        if slope_s > 1e-9 {
            speed_m_s = (speed_m_s - off_m / slope_s).max(0.0);
        }
    }
    speed_m_s
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: ClimbLimits =
        ClimbLimits { rise_m_s: 0.6, drop_m_s: 1.1, speed_m_s: 0.68, lag_s: 1.2, braking: 0.9 };

    #[test]
    fn the_stopping_distance_is_that_of_the_model() {
        for lag_s in [0.17, 0.5, 1.25] {
            for distance_m in [0.01, 0.1, 0.5, 2.0] {
                let mut speed_m_s = speed_before_stop(distance_m, 0.6, lag_s);
                let mut way_m = 0.0;
                while speed_m_s > 0.0 {
                    way_m += speed_m_s * 1e-4;
                    speed_m_s += (-0.6 - speed_m_s) / lag_s * 1e-4;
                }
                assert!((way_m / distance_m - 1.0).abs() < 0.02, "{lag_s} {distance_m} {way_m}");
            }
        }
    }

    #[test]
    fn it_arrives_without_going_beyond_and_asks_for_no_more_than_there_is() {
        for lag_s in [0.17, 0.5, 1.25] {
            for target_m in [0.02, 1.0, -1.0, 3.0, -3.0] {
                let limits = ClimbLimits { lag_s, ..LIMITS };
                let mut reference = ClimbReference::at_rest(0.0);
                for _ in 0..500 {
                    let command = reference.advance(target_m, 0.03, &limits);
                    assert!((-1.1 - 1e-9..=0.6 + 1e-9).contains(&command), "{command}");
                    assert!(reference.climb_m_s.abs() <= 0.68 + 1e-9);
                    let beyond_m = (reference.height_m - target_m) * target_m.signum();
                    assert!(beyond_m < 2e-3, "{lag_s} {target_m} {beyond_m}");
                }
                assert_eq!(reference, ClimbReference::at_rest(target_m));
            }
        }
    }

    #[test]
    fn target_and_limits_may_change_on_the_way() {
        let mut reference = ClimbReference::at_rest(1.0);
        let mut last = reference;
        for step in 0..600 {
            let target_m = if step < 40 { 3.0 } else { 0.5 };
            let lag_s = if step < 60 { 0.5 } else { 1.2 };
            reference.advance(target_m, 0.03, &ClimbLimits { lag_s, ..LIMITS });
            assert!((reference.climb_m_s - last.climb_m_s).abs() < 0.12);
            last = reference;
        }
        assert_eq!(reference, ClimbReference::at_rest(0.5));
    }

    #[test]
    fn a_drone_that_can_do_nothing_is_asked_for_nothing() {
        let limits = ClimbLimits { rise_m_s: 0.0, drop_m_s: 0.0, speed_m_s: 0.0, ..LIMITS };
        let mut reference = ClimbReference::at_rest(0.0);
        for _ in 0..100 {
            assert!(reference.advance(1.0, 0.03, &limits).abs() < 1e-12);
        }
    }
}
