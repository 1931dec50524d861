//! Time at which a sample was measured, on the pilot's clock.

use std::time::Duration;

/// The drone's clock starts again from zero after this time.
const DRONE_CLOCK_WRAP_S: f64 = 2048.0;
/// A longer step of the drone's clock alone means that the clock was set, not that time has passed.
const MAX_PLAUSIBLE_STEP_S: f64 = 10.0;
/// Upper limit of the rate error of the drone's clock; a quartz is a hundred times better.
const CLOCK_DRIFT: f64 = 1e-3;
/// Gain by which an arrival corrects the smoothed time.
const SMOOTHING: f64 = 0.15;
/// Gain by which an interval corrects the smoothed interval.
const INTERVAL_SMOOTHING: f64 = 0.1;

/// Determines when samples were measured.
///
/// With the drone's clock, the smallest difference between arrival and drone time belongs to a packet that
/// was not delayed. All later packets are dated by it, so that network jitter has no effect. Without the
/// drone's clock arrivals are smoothed; packets are never counted, so a lost packet does not shift the time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SampleClock {
    drone: Option<DroneClock>,
    arrivals: Option<Arrivals>,
    last_made_s: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
struct DroneClock {
    /// The drone's time of the last sample, unwrapped.
    time_s: f64,
    /// Offset from the drone's time to the pilot's.
    offset_s: f64,
}

#[derive(Debug, Clone, Copy)]
struct Arrivals {
    smoothed_s: f64,
    interval_s: f64,
}

impl SampleClock {
    /// When the sample was measured, in seconds on the pilot's clock, except for the constant part of its
    /// latency. Never earlier than the previous sample.
    pub(crate) fn made_s(&mut self, drone_time: Option<Duration>, arrival: Duration) -> f64 {
        let arrival_s = arrival.as_secs_f64();
        let by_arrival_s = self.smooth(arrival_s);
        let made_s = drone_time
            .and_then(|time| self.by_drone_clock(time.as_secs_f64(), arrival_s))
            .unwrap_or(by_arrival_s);
        let made_s = self.last_made_s.map_or(made_s, |last| made_s.max(last)).min(arrival_s);
        self.last_made_s = Some(made_s);
        made_s
    }

    /// `None` if the drone's clock stands still: a new packet with an old time.
    fn by_drone_clock(&mut self, time_s: f64, arrival_s: f64) -> Option<f64> {
        let fresh = DroneClock { time_s, offset_s: arrival_s - time_s };
        let Some(last) = self.drone else {
            self.drone = Some(fresh);
            return Some(arrival_s);
        };
        let step_s = (time_s - last.time_s).rem_euclid(DRONE_CLOCK_WRAP_S);
        if step_s <= 0.0 {
            return None;
        }
        if step_s > MAX_PLAUSIBLE_STEP_S {
            self.drone = Some(fresh);
            return Some(arrival_s);
        }
        let time_s = last.time_s + step_s;
        let offset_s = (last.offset_s + CLOCK_DRIFT * step_s).min(arrival_s - time_s);
        // No packet is under way for this long: the drone was restarted.
        if arrival_s - time_s - offset_s > MAX_PLAUSIBLE_STEP_S {
            self.drone = Some(fresh);
            return Some(arrival_s);
        }
        self.drone = Some(DroneClock { time_s, offset_s });
        Some(time_s + offset_s)
    }

    fn smooth(&mut self, arrival_s: f64) -> f64 {
        let Some(Arrivals { smoothed_s, interval_s }) = &mut self.arrivals else {
            self.arrivals = Some(Arrivals { smoothed_s: arrival_s, interval_s: 0.0 });
            return arrival_s;
        };
        let gap_s = arrival_s - *smoothed_s;
        // First interval, or a gap: there is nothing to smooth.
        if *interval_s <= 0.0 || gap_s > 1.5 * *interval_s {
            if *interval_s <= 0.0 {
                *interval_s = gap_s;
            }
            *smoothed_s = arrival_s;
            return arrival_s;
        }
        *interval_s += INTERVAL_SMOOTHING * (gap_s - *interval_s);
        let expected_s = *smoothed_s + *interval_s;
        *smoothed_s = expected_s + SMOOTHING * (arrival_s - expected_s);
        *smoothed_s = smoothed_s.min(arrival_s);
        *smoothed_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: fn(u64) -> Duration = Duration::from_millis;

    fn assert_near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    #[test]
    fn a_clock_that_jumps_is_not_believed() {
        let mut clock = SampleClock::default();
        assert_near(clock.made_s(Some(MS(500_000)), MS(0)), 0.0, 1e-9);
        assert_near(clock.made_s(Some(MS(500_066)), MS(70)), 0.066, 1e-3);
        // The drone has restarted: its clock is near zero again.
        assert_near(clock.made_s(Some(MS(100)), MS(140)), 0.14, 1e-9);
        assert_near(clock.made_s(Some(MS(166)), MS(240)), 0.206, 1e-3);
    }

    #[test]
    fn packets_that_were_held_up_were_made_in_time() {
        let mut clock = SampleClock::default();
        // The clock wraps on the way, and every third packet arrives 50 ms late.
        for i in 0..100_u64 {
            let late = if i % 3 == 1 { 50 } else { 0 };
            let made_s =
                clock.made_s(Some(MS((2_047_000 + 66 * i) % 2_048_000)), MS(66 * i + late));
            assert_near(made_s, 0.066 * i as f64, 0.001);
        }
    }

    #[test]
    fn without_the_drones_clock_jitter_is_smoothed_and_loss_is_no_lost_time() {
        let mut clock = SampleClock::default();
        let mut worst: f64 = 0.0;
        for i in (0..300_u64).filter(|i| i % 10 != 3) {
            let jitter = (i * 7919) % 20;
            let made_s = clock.made_s(None, MS(66 * i + jitter));
            if i > 50 {
                worst = worst.max((made_s - 0.066 * i as f64 - 0.01).abs());
            }
        }
        assert!(worst < 0.02, "{worst}");
    }

    #[test]
    fn a_clock_that_stands_still_is_replaced_by_the_arrivals() {
        let mut clock = SampleClock::default();
        for i in 0..200_u64 {
            let time = MS(66 * i.min(50));
            let made_s = clock.made_s(Some(time), MS(66 * i));
            assert_near(made_s, 0.066 * i as f64, 0.01);
        }
    }

    #[test]
    fn time_never_runs_backward() {
        let mut clock = SampleClock::default();
        let mut last = 0.0;
        for i in 0..200_u64 {
            let time = (i % 3 != 0).then(|| MS((i * 37) % 4000));
            let made_s = clock.made_s(time, MS(i * 10));
            assert!(made_s >= last && made_s <= 0.01 * i as f64 + 1e-9);
            last = made_s;
        }
    }
}
