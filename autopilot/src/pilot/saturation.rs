//! Whether the drone can hold against the wind: what counts is that its sticks are at their limit and that it
//! comes no nearer all the same.

use std::time::Duration;

use pid::{Demand, Pose};

/// Sticks beyond this share of their limit are at it: controllers keep a little back.
const AT_THE_LIMIT: f64 = 0.8;
/// Whoever comes nearer by this makes way.
const WAY_M: f64 = 0.05;

/// Since when the drone has made no way with its sticks at their limit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Saturation {
    since: Option<Since>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Since {
    at: Duration,
    target: Pose,
    distance_m: f64,
}

impl Saturation {
    /// The sticks of a tick on the way from a pose to a target. `limit` is that of each stick.
    pub(super) fn flown(
        &mut self,
        at: Duration,
        pose: &Pose,
        target: &Pose,
        sticks: &Demand,
        limit: f64,
    ) {
        if sticks.roll.hypot(sticks.pitch) < AT_THE_LIMIT * limit {
            self.since = None;
            return;
        }
        let distance_m = (target.x_m - pose.x_m).hypot(target.y_m - pose.y_m);
        let makes_way =
            |since: Since| since.target != *target || distance_m <= since.distance_m - WAY_M;
        if self.since.is_none_or(makes_way) {
            self.since = Some(Since { at, target: *target, distance_m });
        }
    }

    /// Nothing is flown to.
    pub(super) fn let_go(&mut self) {
        self.since = None;
    }

    /// For how long, in milliseconds.
    pub(super) fn lasted_ms(&self, now: Duration) -> i64 {
        let lasted = self.since.map_or(Duration::ZERO, |since| now.saturating_sub(since.at));
        i64::try_from(lasted.as_millis()).unwrap_or(i64::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: Pose = Pose { x_m: 0.0, y_m: 0.0, z_m: 1.0, yaw_deg: 0.0 };
    const FULL: Demand = Demand { roll: 0.6, pitch: -0.8, gaz: 0.0, yaw: 0.0 };
    const SECOND: Duration = Duration::from_secs(1);

    /// For how long it is saturated after ten seconds at this speed towards a target 20 m away.
    fn after_ten_seconds(speed_m_s: f64, sticks: Demand, limit: f64) -> i64 {
        let mut saturation = Saturation::default();
        let target = Pose { x_m: 20.0, ..START };
        for tenths in 0..=100_u32 {
            let pose = Pose { x_m: speed_m_s * f64::from(tenths) / 10.0, ..START };
            saturation.flown(SECOND / 10 * tenths, &pose, &target, &sticks, limit);
        }
        saturation.lasted_ms(10 * SECOND)
    }

    #[test]
    fn who_is_carried_off_at_full_tilt_is_saturated_and_who_makes_way_is_not() {
        assert_eq!(after_ten_seconds(-1.0, FULL, 1.0), 10_000);
        assert_eq!(after_ten_seconds(0.0, FULL, 1.0), 10_000);
        assert_eq!(after_ten_seconds(1.0, FULL, 1.0), 0);
        assert_eq!(after_ten_seconds(-1.0, Demand { pitch: 0.0, ..FULL }, 1.0), 0);
        assert_eq!(after_ten_seconds(-1.0, Demand { pitch: 0.0, ..FULL }, 0.6), 10_000);
    }

    #[test]
    fn another_target_is_another_matter() {
        let mut saturation = Saturation::default();
        let near = Pose { x_m: 1.0, ..START };
        saturation.flown(SECOND, &START, &near, &FULL, 1.0);
        let far = Pose { x_m: 9.0, ..START };
        saturation.flown(3 * SECOND, &START, &far, &FULL, 1.0);
        assert_eq!(saturation.lasted_ms(4 * SECOND), 1000);
        saturation.let_go();
        assert_eq!(saturation.lasted_ms(4 * SECOND), 0);
    }
}
