//! How regular the ticks were.

use std::fmt;
use std::time::Duration;

/// Widths of the histogram's bins and how many there are: up to 100 ms; longer periods share the
/// last one and are remembered exactly by the maximum.
const BIN: Duration = Duration::from_micros(10);
const BINS: usize = 10_000;
/// A tick that comes later than this after its deadline is late.
const LATE: Duration = Duration::from_millis(3);

/// Collects the times of ticks. Its memory is allocated once.
#[derive(Debug, Clone)]
pub struct TickRecorder {
    bins: Vec<u32>,
    count: u64,
    sum: Duration,
    max: Duration,
    late: u64,
    skipped: u64,
    last: Option<Duration>,
}

impl Default for TickRecorder {
    fn default() -> Self {
        Self {
            bins: vec![0; BINS],
            count: 0,
            sum: Duration::ZERO,
            max: Duration::ZERO,
            late: 0,
            skipped: 0,
            last: None,
        }
    }
}

impl TickRecorder {
    /// A tick at `now` that was due at `deadline`; `skipped` deadlines before it were missed.
    pub fn record(&mut self, now: Duration, deadline: Duration, skipped: u64) {
        if now.saturating_sub(deadline) > LATE {
            self.late += 1;
        }
        self.skipped += skipped;
        let Some(last) = self.last.replace(now) else { return };
        let period = now.saturating_sub(last);
        self.count += 1;
        self.sum += period;
        self.max = self.max.max(period);
        let bin = usize::try_from(period.as_micros() / BIN.as_micros()).unwrap_or(BINS);
        if let Some(count) = self.bins.get_mut(bin.min(BINS - 1)) {
            *count = count.saturating_add(1);
        }
    }

    /// What was collected.
    pub fn summary(&self) -> TickSummary {
        let count = u32::try_from(self.count).unwrap_or(u32::MAX);
        TickSummary {
            periods: self.count,
            mean: self.sum.checked_div(count).unwrap_or_default(),
            p99: self.quantile(0.99),
            max: self.max,
            late: self.late,
            skipped: self.skipped,
        }
    }

    /// The upper edge of the bin in which the quantile lies, or the maximum if that is smaller.
    fn quantile(&self, fraction: f64) -> Duration {
        let wanted = fraction * self.count as f64;
        let mut seen = 0_u64;
        for (upper_edge, count) in (1_u32..).zip(&self.bins) {
            seen += u64::from(*count);
            if seen as f64 >= wanted {
                return (BIN * upper_edge).min(self.max);
            }
        }
        self.max
    }
}

/// How regular the ticks of a flight were.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TickSummary {
    /// Periods measured: one less than ticks.
    pub periods: u64,
    /// Mean period.
    pub mean: Duration,
    /// 99 % of the periods were no longer.
    pub p99: Duration,
    /// The longest period.
    pub max: Duration,
    /// Ticks more than 3 ms behind their deadline.
    pub late: u64,
    /// Deadlines that passed without a tick.
    pub skipped: u64,
}

impl fmt::Display for TickSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ms = |duration: Duration| duration.as_secs_f64() * 1000.0;
        let (mean, p99, max) = (ms(self.mean), ms(self.p99), ms(self.max));
        let Self { periods, late, skipped, .. } = self;
        write!(
            f,
            "{periods} periods, mean {mean:.2} ms, p99 {p99:.2} ms, max {max:.2} ms, {late} late, {skipped} skipped"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_are_summed_up() {
        let ms = Duration::from_millis;
        let mut recorder = TickRecorder::default();
        for tick in 0..200 {
            recorder.record(ms(30 * tick), ms(30 * tick), 0);
        }
        recorder.record(ms(200 * 30 + 45), ms(200 * 30), 1);
        let summary = recorder.summary();
        assert_eq!((summary.periods, summary.late, summary.skipped), (200, 1, 1));
        assert_eq!(summary.max, ms(75));
        assert!(summary.p99 > ms(30) && summary.p99 <= Duration::from_micros(30_010));
    }

    #[test]
    fn no_ticks_are_no_statistics() {
        assert_eq!(TickRecorder::default().summary(), TickSummary::default());
    }
}
