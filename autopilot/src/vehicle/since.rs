//! For how long something is so.

use std::time::Duration;

/// Since when something is so without a break.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Since(Option<Duration>);

impl Since {
    /// Takes in whether it is so now. Returns whether it has been for this time.
    pub(super) fn lasts(&mut self, now: Duration, is_so: bool, time: Duration) -> bool {
        self.0 = is_so.then(|| self.0.unwrap_or(now));
        self.has_lasted(now, time)
    }

    /// Whether it has been so for this time, by what was taken in last.
    pub(super) fn has_lasted(&self, now: Duration, time: Duration) -> bool {
        self.0.is_some_and(|since| now.saturating_sub(since) >= time)
    }
}

/// Since when, and from what height, a drone that is told to sink has not.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StaysUp(Option<(Duration, f64)>);

impl StaysUp {
    /// Sinking by this much counts: the slowest airframe (0.4 m/s) does so in half a second at half stick, noise does not.
    const SINKS_M: f64 = 0.1;

    /// Takes in whether it is told to sink, and its height. Returns whether it has stayed up for this time.
    pub(super) fn lasts(
        &mut self,
        now: Duration,
        told: bool,
        height_m: f64,
        time: Duration,
    ) -> bool {
        let from = self.0.filter(|(_, from_m)| height_m > from_m - Self::SINKS_M);
        self.0 = told.then(|| from.unwrap_or((now, height_m)));
        self.0.is_some_and(|(since, _)| now.saturating_sub(since) >= time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drone_stays_up_that_sinks_by_less_than_noise() {
        let second = Duration::from_secs(1);
        for (sinks_m_s, told, stays) in
            [(0.0, true, true), (0.08, true, true), (0.4, true, false), (0.0, false, false)]
        {
            let mut up = StaysUp::default();
            let ticks = (0..100_u32).map(|tick| second * tick / 30);
            let lasts =
                ticks.map(|now| up.lasts(now, told, -sinks_m_s * now.as_secs_f64(), second));
            assert_eq!(lasts.collect::<Vec<_>>().contains(&true), stays, "{sinks_m_s} {told}");
        }
    }

    #[test]
    fn a_break_begins_anew() {
        let second = Duration::from_secs;
        let mut since = Since::default();
        let mut lasts = |at, is_so| since.lasts(second(at), is_so, second(2));
        assert_eq!([lasts(1, true), lasts(2, true), lasts(3, true)], [false, false, true]);
        assert_eq!([lasts(4, false), lasts(5, true), lasts(7, true)], [false, false, true]);
    }
}
