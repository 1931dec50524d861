//! How old what another program tells is at most, though the two clocks have nothing to do with each other.
//!
//! Arrival is not the time of a state: a network may hold it back for seconds. Each program tells its stamps, and answers those
//! that it hears: "your newest one was O, and I have had it for H". Whoever reads its own O again knows that the other one
//! wrote this after it: no earlier than O + H by its own clock. Together with the stamp S of that answer this is a bound of the
//! distance between the clocks, and with it every later state of the other one has a time before which it was not written.

use std::time::Duration;

/// How fast two clocks may part, in seconds a second: twice what one that is slewed by NTP (500 ppm) may be wrong besides
/// (500 ppm).
pub const DRIFT: f64 = 0.002;

/// What is known of the distance between two clocks: ours minus that of the other one, in microseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Bound {
    /// It is no less, by an answer.
    least: Option<Known>,
    /// It is no more, by an arrival.
    most: Option<Known>,
}

/// A bound, and when by our clock it was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Known {
    distance_us: i64,
    at: Duration,
}

impl Known {
    /// By how much the clocks may have parted since.
    fn parted_us(&self, now: Duration) -> i64 {
        drift_us(micros(now.saturating_sub(self.at)))
    }
}

/// By how much clocks may part in this time, rounded up.
fn drift_us(time_us: i64) -> i64 {
    // DRIFT is one five-hundredth.
    time_us / 500 + i64::from(time_us % 500 != 0)
}

/// Microseconds of a time since a program began, which no program survives.
pub(super) fn micros(time: Duration) -> i64 {
    i64::try_from(time.as_micros()).unwrap_or(i64::MAX / 4).min(i64::MAX / 4)
}

impl Bound {
    /// Something that the other one sent at `sent` by its clock arrives now.
    pub fn arrived(&mut self, now: Duration, sent: Duration) {
        let distance_us = micros(now) - micros(sent);
        if self.most_us(now).is_none_or(|most_us| distance_us < most_us) {
            self.most = Some(Known { distance_us, at: now });
        }
    }

    /// In what it sent at `sent` by its clock it has answered a stamp of ours, which it had for so long by its clock.
    pub fn answered(&mut self, now: Duration, sent: Duration, stamp: Duration, held: Duration) {
        let held_us = micros(held);
        let distance_us = micros(stamp) + held_us - drift_us(held_us) - micros(sent);
        if self.least_us(now).is_none_or(|least_us| distance_us > least_us) {
            self.least = Some(Known { distance_us, at: now });
        }
    }

    /// Whether a stamp of ours was answered, so that something is known of an age.
    pub fn has_answer(&self) -> bool {
        self.least.is_some()
    }

    fn least_us(&self, now: Duration) -> Option<i64> {
        self.least.map(|known| known.distance_us.saturating_sub(known.parted_us(now)))
    }

    fn most_us(&self, now: Duration) -> Option<i64> {
        self.most.map(|known| known.distance_us.saturating_add(known.parted_us(now)))
    }

    /// Whether the two bounds exclude each other: a clock has jumped, as on a machine that was suspended, or the other one lies.
    pub fn is_contradictory(&self, now: Duration) -> bool {
        matches!((self.least_us(now), self.most_us(now)), (Some(least), Some(most)) if least > most)
    }

    /// How old what happened at this time of the other clock is at most; `None` while nothing is known.
    pub fn age(&self, now: Duration, theirs: Duration) -> Option<Duration> {
        let ours_us = micros(theirs).saturating_add(self.least_us(now)?);
        let age_us = micros(now).saturating_sub(ours_us);
        Some(Duration::from_micros(u64::try_from(age_us).unwrap_or(0)))
    }

    /// By how much the age may be less than that.
    pub fn width(&self, now: Duration) -> Option<Duration> {
        let width_us = self.most_us(now)?.saturating_sub(self.least_us(now)?);
        Some(Duration::from_micros(u64::try_from(width_us).unwrap_or(0)))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn nothing_is_known_before_an_answer() {
        let mut bound = Bound::default();
        assert_eq!(bound.age(5 * MS, MS), None);
        bound.arrived(5 * MS, MS);
        assert_eq!((bound.age(5 * MS, MS), bound.width(5 * MS)), (None, None));
    }

    /// Their clock is 1000 ms behind; each way takes 20 ms, and the answer waited for 5 ms.
    #[test]
    fn an_answer_bounds_the_age_by_the_way_there_and_back() {
        let mut bound = Bound::default();
        // Ours 2000, there at 2020 (theirs 1020), sent at 1025, here at 2045.
        bound.arrived(2045 * MS, 1025 * MS);
        bound.answered(2045 * MS, 1025 * MS, 2000 * MS, 5 * MS);
        let age = bound.age(2045 * MS, 1025 * MS).unwrap();
        assert!((40 * MS..41 * MS).contains(&age), "{age:?}");
        assert!((40 * MS..41 * MS).contains(&bound.width(2045 * MS).unwrap()));
        // What was held back for 3 s shows it.
        let late = bound.age(5045 * MS, 1025 * MS).unwrap();
        assert!((3040 * MS..3050 * MS).contains(&late), "{late:?}");
        assert!(!bound.is_contradictory(5045 * MS));
    }

    #[test]
    fn a_clock_that_jumps_is_noticed() {
        let mut bound = Bound::default();
        bound.arrived(2045 * MS, 1025 * MS);
        bound.answered(2045 * MS, 1025 * MS, 2000 * MS, 5 * MS);
        // Our machine stood still for a second.
        bound.arrived(2145 * MS, 2125 * MS);
        assert!(bound.is_contradictory(2145 * MS));
    }

    proptest! {
        /// Whatever the delays and the drift: the true age is never above the bound, and never below what the width leaves.
        #[test]
        fn the_bound_holds(
            begin_ms in 0_u64..100_000,
            rate_ppm in -900_i64..900,
            ways in proptest::collection::vec((0_u64..900, 0_u64..900, 0_u64..400, 1_u64..3000), 1..60),
        ) {
            let theirs = |ours_us: i64| {
                let us = i64::try_from(begin_ms).unwrap() * 1000 + ours_us + ours_us * rate_ppm / 1_000_000;
                Duration::from_micros(u64::try_from(us).unwrap())
            };
            let (mut bound, mut now_us) = (Bound::default(), 0_i64);
            let ms = |ms: u64| i64::try_from(ms).unwrap() * 1000;
            for (there, back, waits, pause) in ways {
                now_us += ms(pause);
                let stamp_us = now_us;
                let there_us = stamp_us + ms(there);
                let sent_us = there_us + ms(waits);
                let arrival_us = sent_us + ms(back);
                let held = theirs(sent_us).checked_sub(theirs(there_us)).unwrap();
                let [stamp, arrival] = [stamp_us, arrival_us].map(|us| Duration::from_micros(us.try_into().unwrap()));
                bound.arrived(arrival, theirs(sent_us));
                bound.answered(arrival, theirs(sent_us), stamp, held);
                prop_assert!(!bound.is_contradictory(arrival));
                let age = bound.age(arrival, theirs(sent_us)).unwrap();
                let true_age = Duration::from_micros(u64::try_from(arrival_us - sent_us).unwrap());
                let rounding = Duration::from_micros(3);
                prop_assert!(age + rounding >= true_age, "{age:?} {true_age:?}");
                prop_assert!(age.saturating_sub(bound.width(arrival).unwrap()) <= true_age + rounding);
                now_us = arrival_us;
            }
        }
    }
}
