//! Time between samples.

use std::time::Duration;

/// The drone's clock starts again from zero after this time.
const DRONE_CLOCK_WRAP: Duration = Duration::from_secs(2048);
/// A step longer than this on the drone's clock alone is a clock that was set, not time that
/// passed.
const MAX_PLAUSIBLE_STEP: Duration = Duration::from_secs(10);

/// Measures the time from one sample to the next: on the drone's clock where both samples carry
/// it, otherwise by their arrival.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SampleClock {
    last: Option<(Option<Duration>, Duration)>,
}

impl SampleClock {
    /// Time since the sample before, zero for the first one.
    pub(crate) fn step(&mut self, drone_time: Option<Duration>, arrival: Duration) -> Duration {
        let Some((last_drone_time, last_arrival)) = self.last.replace((drone_time, arrival)) else {
            return Duration::ZERO;
        };
        let by_arrival = arrival.saturating_sub(last_arrival);
        let (Some(now), Some(last)) = (drone_time, last_drone_time) else { return by_arrival };
        let unwrapped = if now >= last { now } else { now + DRONE_CLOCK_WRAP };
        match unwrapped.checked_sub(last) {
            Some(step) if step <= MAX_PLAUSIBLE_STEP => step,
            _ => by_arrival,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_jumps_is_not_believed() {
        let mut clock = SampleClock::default();
        let ms = Duration::from_millis;
        assert_eq!(clock.step(Some(ms(500_000)), ms(0)), Duration::ZERO);
        assert_eq!(clock.step(Some(ms(500_066)), ms(70)), ms(66));
        // The drone restarted: its clock is near zero again.
        assert_eq!(clock.step(Some(ms(100)), ms(140)), ms(70));
        assert_eq!(clock.step(None, ms(200)), ms(60));
    }
}
