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

    #[test]
    fn the_drones_clock_may_run_slow_by_a_thousandth_and_no_more() {
        let mut clock = SampleClock::default();
        assert_near(clock.made_s(Some(MS(0)), MS(0)), 0.0, 1e-12);
        // From now on each packet is 50 ms late. As far as a clock can drift this may be its rate.
        for i in 1..=100_u64 {
            let made_s = clock.made_s(Some(MS(66 * i)), MS(66 * i + 50));
            assert_near(made_s, 0.066 * i as f64 * (1.0 + CLOCK_DRIFT), 1e-9);
        }
        // The first that was not late sets the time again.
        let (at, next) = (66 * 101, 66 * 102);
        assert_near(clock.made_s(Some(MS(at)), MS(at)), 0.001 * at as f64, 1e-9);
        let made_s = clock.made_s(Some(MS(next)), MS(next + 50));
        assert_near(made_s, 0.001 * next as f64 + CLOCK_DRIFT * 0.066, 1e-9);
    }

    #[test]
    fn ten_seconds_of_the_drones_clock_are_time_and_more_are_a_set_clock() {
        for (step_ms, made_ms) in [(9_900, 9_900.0 * 1.001), (10_100, 10_500.0)] {
            let mut clock = SampleClock::default();
            clock.made_s(Some(MS(1_000)), MS(0));
            let made_s = clock.made_s(Some(MS(1_000 + step_ms)), MS(10_500));
            assert_near(made_s, made_ms / 1000.0, 1e-9);
        }
        // A step of this limit exactly is time.
        let mut clock = SampleClock::default();
        clock.made_s(Some(MS(0)), MS(0));
        assert_near(clock.made_s(Some(MS(10_000)), MS(10_500)), 10.01, 1e-9);
    }

    #[test]
    fn a_packet_is_under_way_for_ten_seconds_at_most() {
        // Five seconds of the drone's clock later, by which the offset may have drifted by 5 ms.
        for (arrival_ms, made_s) in [(14_900, 5.005), (15_100, 15.1)] {
            let mut clock = SampleClock::default();
            clock.made_s(Some(MS(1_000)), MS(0));
            assert_near(clock.made_s(Some(MS(6_000)), MS(arrival_ms)), made_s, 1e-9);
            // The next packet is dated by the clock that was found.
            let made_s = clock.made_s(Some(MS(6_066)), MS(arrival_ms + 90));
            assert_near(made_s, if arrival_ms < 15_000 { 5.071_066 } else { 15.166_066 }, 1e-9);
        }
    }

    /// Arrivals after intervals of 100 ms, in milliseconds, without the drone's clock.
    fn smoothed_s(arrivals_ms: &[u64]) -> f64 {
        let mut clock = SampleClock::default();
        clock.made_s(None, MS(0));
        clock.made_s(None, MS(100));
        arrivals_ms.iter().map(|ms| clock.made_s(None, MS(*ms))).last().unwrap()
    }

    #[test]
    fn an_arrival_moves_the_time_by_the_gains_of_the_smoothing() {
        // The interval becomes 104 ms, so 204 ms are expected; of the 36 ms beyond 15 % are believed.
        assert_near(smoothed_s(&[240]), 0.2094, 1e-9);
        // Nothing was measured after it arrived, even if the packet came early.
        assert_near(smoothed_s(&[240, 250]), 0.25, 1e-9);
        // Half an interval more than usual is jitter; beyond it packets are missing.
        assert_near(smoothed_s(&[248]), 0.2 + 0.0048 + 0.15 * 0.0432, 1e-9);
        assert_near(smoothed_s(&[252]), 0.252, 1e-9);
        // Half an interval more exactly: 131.25 ms are the interval, and 256.25 ms were expected.
        let mut clock = SampleClock::default();
        clock.made_s(None, MS(0));
        clock.made_s(None, MS(125));
        let made_s = clock.made_s(None, Duration::from_micros(312_500));
        assert_near(made_s, 0.256_25 + 0.15 * 0.056_25, 1e-9);
        // A gap does not change the interval, so the next packet is expected as before.
        assert_near(smoothed_s(&[400, 520]), 0.502 + 0.15 * 0.018, 1e-9);
    }
}
