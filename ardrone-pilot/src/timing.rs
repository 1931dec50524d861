//! Timing of the ticks: regularity, cost, and the worst tick.

use std::fmt;
use std::time::Duration;

use autopilot::vehicle::Stage;

use crate::realtime::Realtime;

/// Delay after the deadline from which a tick counts as late.
const LATE: Duration = Duration::from_millis(3);
const US: Duration = Duration::from_micros(1);

/// Collects the times of ticks in memory that is allocated once.
#[derive(Debug, Clone)]
pub struct TickRecorder {
    periods: Histogram,
    lateness: Histogram,
    costs: [Histogram; Stage::ALL.len()],
    work: Histogram,
    late: u64,
    skipped: u64,
    last: Option<Duration>,
    tick: Tick,
    worst: Option<Tick>,
    /// Largest lateness since the last call of [`TickRecorder::health`].
    latest: Duration,
}

/// Current timing of the ticks, for displays.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TickHealth {
    /// Largest delay after a deadline since the last call.
    pub lateness: Duration,
    /// Deadlines missed entirely since the start.
    pub skipped: u64,
}

/// Times of one tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tick {
    /// When it began, since the start of the flight.
    pub at: Duration,
    /// Delay after its deadline.
    pub lateness: Duration,
    /// The deadline passed while navdata were being handled, so the delay is not the system's.
    pub held_up: bool,
    /// Duration of each stage.
    pub costs: [Duration; Stage::ALL.len()],
}

impl Tick {
    /// Total duration of its stages.
    pub fn work(&self) -> Duration {
        self.costs.iter().sum()
    }

    /// Time from the deadline until the command was sent.
    fn behind(&self) -> Duration {
        self.lateness + self.work()
    }
}

impl fmt::Display for Tick {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (lateness, work) = (microseconds(self.lateness), microseconds(self.work()));
        write!(
            f,
            "at {:.2} s, {lateness:.0} µs late, {work:.0} µs of work: ",
            self.at.as_secs_f64()
        )?;
        let longest = Stage::ALL.into_iter().zip(self.costs).max_by_key(|(_, cost)| *cost);
        match longest {
            _ if self.held_up => f.write_str("held up by navdata"),
            Some((stage, cost)) if cost > self.lateness => f.write_str(stage.name()),
            _ => f.write_str("the system woke it late"),
        }
    }
}

impl Default for TickRecorder {
    fn default() -> Self {
        let cost = || Histogram::new(US, 2_000);
        Self {
            periods: Histogram::new(10 * US, 10_000),
            lateness: Histogram::new(5 * US, 10_000),
            costs: Stage::ALL.map(|_| cost()),
            work: cost(),
            late: 0,
            skipped: 0,
            last: None,
            tick: Tick::default(),
            worst: None,
            latest: Duration::ZERO,
        }
    }
}

impl TickRecorder {
    /// Begins a tick at `now` that was due at `deadline`; `skipped` deadlines before it were missed. It was
    /// `held_up` if the deadline passed during other work.
    pub fn begin(&mut self, now: Duration, deadline: Duration, skipped: u64, held_up: bool) {
        let lateness = now.saturating_sub(deadline);
        self.tick = Tick { at: now, lateness, held_up, ..self.tick };
        self.late += u64::from(lateness > LATE);
        self.skipped += skipped;
        self.lateness.add(lateness);
        self.latest = self.latest.max(lateness);
        if let Some(last) = self.last.replace(now) {
            self.periods.add(now.saturating_sub(last));
        }
    }

    /// Adds to the duration of a stage of this tick.
    pub fn spend(&mut self, stage: Stage, time: Duration) {
        if let Some(cost) = self.tick.costs.get_mut(stage as usize) {
            *cost += time;
        }
    }

    /// Ends the tick.
    pub fn end(&mut self) {
        let tick = std::mem::take(&mut self.tick);
        for (histogram, cost) in self.costs.iter_mut().zip(tick.costs) {
            histogram.add(cost);
        }
        self.work.add(tick.work());
        if self.worst.is_none_or(|worst| tick.behind() > worst.behind()) {
            self.worst = Some(tick);
        }
    }

    /// Timing since the last call.
    pub fn health(&mut self) -> TickHealth {
        TickHealth { lateness: std::mem::take(&mut self.latest), skipped: self.skipped }
    }

    /// Statistics of all ticks.
    pub fn summary(&self, realtime: Realtime) -> TickSummary {
        TickSummary {
            realtime,
            periods: self.periods.quantiles(),
            lateness: self.lateness.quantiles(),
            lateness_counts: LATENESS_EDGES.map(|edge| self.lateness.count_below(edge)),
            costs: self.costs.each_ref().map(Histogram::quantiles),
            work: self.work.quantiles(),
            late: self.late,
            skipped: self.skipped,
            worst: self.worst,
        }
    }
}

/// Histogram with bins of equal width. Larger values share the last bin; the maximum is exact.
#[derive(Debug, Clone)]
struct Histogram {
    width: Duration,
    bins: Vec<u32>,
    count: u64,
    sum: Duration,
    max: Duration,
}

impl Histogram {
    fn new(width: Duration, bins: usize) -> Self {
        Self { width, bins: vec![0; bins], count: 0, sum: Duration::ZERO, max: Duration::ZERO }
    }

    fn add(&mut self, value: Duration) {
        self.count += 1;
        self.sum += value;
        self.max = self.max.max(value);
        let bin = usize::try_from(value.as_nanos() / self.width.as_nanos()).unwrap_or(usize::MAX);
        let last = self.bins.len().saturating_sub(1);
        if let Some(count) = self.bins.get_mut(bin.min(last)) {
            *count = count.saturating_add(1);
        }
    }

    fn quantiles(&self) -> Quantiles {
        let count = u32::try_from(self.count).unwrap_or(u32::MAX);
        Quantiles {
            count: self.count,
            mean: self.sum.checked_div(count).unwrap_or_default(),
            p50: self.quantile(0.5),
            p99: self.quantile(0.99),
            max: self.max,
        }
    }

    /// Upper edge of the bin that contains the quantile, or the maximum if that is smaller.
    fn quantile(&self, fraction: f64) -> Duration {
        let wanted = fraction * self.count as f64;
        let mut seen = 0_u64;
        for (upper_edge, count) in (1_u32..).zip(&self.bins) {
            seen += u64::from(*count);
            if seen as f64 >= wanted {
                return (self.width * upper_edge).min(self.max);
            }
        }
        self.max
    }

    fn count_below(&self, edge: Duration) -> u64 {
        let edges = (1_u32..).map(|bin| self.width * bin);
        edges
            .zip(&self.bins)
            .take_while(|(upper, _)| *upper <= edge)
            .map(|(_, n)| u64::from(*n))
            .sum()
    }
}

/// Summary of a histogram. Median and percentile are the upper edges of bins: of 10 µs for periods, 5 µs for lateness, and 1 µs
/// for durations. Beyond the last bin (100 ms, 50 ms, 2 ms) they are at its edge, too.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Quantiles {
    /// Number of values.
    pub count: u64,
    /// Mean.
    pub mean: Duration,
    /// Median.
    pub p50: Duration,
    /// 99th percentile.
    pub p99: Duration,
    /// Maximum.
    pub max: Duration,
}

/// Edges of the printed histogram of lateness.
const LATENESS_EDGES: [Duration; 7] = [
    Duration::from_micros(50),
    Duration::from_micros(100),
    Duration::from_micros(200),
    Duration::from_micros(500),
    Duration::from_millis(1),
    Duration::from_millis(3),
    Duration::from_millis(10),
];

/// Statistics of a flight's ticks.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TickSummary {
    /// Scheduling granted by the system.
    pub realtime: Realtime,
    /// Time between the beginnings of two ticks.
    pub periods: Quantiles,
    /// Delay after the deadline.
    pub lateness: Quantiles,
    /// Ticks that were late by less than 50, 100, 200, 500 µs, 1, 3, 10 ms; each count includes those before it.
    pub lateness_counts: [u64; LATENESS_EDGES.len()],
    /// Duration of each of [`Stage::ALL`].
    pub costs: [Quantiles; Stage::ALL.len()],
    /// Total duration of a tick's stages.
    pub work: Quantiles,
    /// Ticks more than 3 ms behind their deadline.
    pub late: u64,
    /// Deadlines missed entirely.
    pub skipped: u64,
    /// The tick whose command was sent latest after its deadline.
    pub worst: Option<Tick>,
}

impl fmt::Display for TickSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Quantiles { count, mean, p99, max, .. } = self.periods;
        let [mean, p99, max] = [mean, p99, max].map(milliseconds);
        let Self { late, skipped, .. } = self;
        write!(
            f,
            "{count} periods, mean {mean:.2} ms, p99 {p99:.2} ms, max {max:.2} ms, {late} late, {skipped} skipped"
        )
    }
}

/// The statistics as text in several lines.
pub struct TimingReport<'a>(pub &'a TickSummary);

impl fmt::Display for TimingReport<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let summary = self.0;
        writeln!(f, "timing: {}", summary.realtime)?;
        writeln!(f, "  µs                p50       p99       max")?;
        let row = |f: &mut fmt::Formatter<'_>, name: &str, row: &Quantiles| {
            let [p50, p99, max] = [row.p50, row.p99, row.max].map(microseconds);
            writeln!(f, "  {name:<11}{p50:>10.0}{p99:>10.0}{max:>10.0}")
        };
        row(f, "period", &summary.periods)?;
        row(f, "lateness", &summary.lateness)?;
        for (stage, cost) in Stage::ALL.iter().zip(&summary.costs) {
            row(f, stage.name(), cost)?;
        }
        row(f, "all work", &summary.work)?;
        writeln!(f, "  ticks by lateness")?;
        let mut below = 0;
        for (edge, count) in LATENESS_EDGES.iter().zip(summary.lateness_counts) {
            bar(f, &format!("< {:.2} ms", milliseconds(*edge)), count - below, summary)?;
            below = count;
        }
        bar(f, "longer", summary.lateness.count - below, summary)?;
        if let Some(worst) = &summary.worst {
            writeln!(f, "  worst tick: {worst}")?;
        }
        Ok(())
    }
}

fn bar(f: &mut fmt::Formatter<'_>, name: &str, count: u64, summary: &TickSummary) -> fmt::Result {
    const LONGEST: u64 = 40;
    if count == 0 {
        return Ok(());
    }
    let all = summary.lateness.count.max(1);
    let length = usize::try_from((LONGEST * count).div_ceil(all)).unwrap_or_default();
    writeln!(f, "  {name:>11}{count:>10}  {}", "▇".repeat(length))
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn microseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn tick(recorder: &mut TickRecorder, at: Duration, lateness: Duration, control: Duration) {
        recorder.begin(at + lateness, at, 0, false);
        recorder.spend(Stage::Control, control);
        recorder.end();
    }

    #[test]
    fn periods_and_costs_are_summed_up() {
        let mut recorder = TickRecorder::default();
        for number in 0..200 {
            tick(&mut recorder, 30 * MS * number, Duration::ZERO, 7 * US);
        }
        recorder.begin(200 * 30 * MS + 45 * MS, 200 * 30 * MS, 1, false);
        recorder.end();
        let summary = recorder.summary(Realtime::default());
        assert_eq!((summary.periods.count, summary.late, summary.skipped), (200, 1, 1));
        assert_eq!(summary.periods.max, 75 * MS);
        assert!(summary.periods.p99 > 30 * MS && summary.periods.p99 <= 30 * MS + 10 * US);
        assert_eq!(summary.costs[Stage::Control as usize].p50, 7 * US);
        assert_eq!(summary.work.max, 7 * US);
    }

    #[test]
    fn the_worst_tick_is_reported_with_its_cause() {
        let worst = |lateness, control, held_up| {
            let mut recorder = TickRecorder::default();
            tick(&mut recorder, Duration::ZERO, 50 * US, 9 * US);
            recorder.begin(30 * MS + lateness, 30 * MS, 0, held_up);
            recorder.spend(Stage::Control, control);
            recorder.end();
            tick(&mut recorder, 60 * MS, 50 * US, 9 * US);
            recorder.summary(Realtime::default()).worst.unwrap().to_string()
        };
        assert_eq!(
            worst(4 * MS, US, false),
            "at 0.03 s, 4000 µs late, 1 µs of work: the system woke it late"
        );
        assert!(worst(US, 4 * MS, false).ends_with("4000 µs of work: control"));
        assert!(worst(4 * MS, US, true).ends_with("held up by navdata"));
    }

    #[test]
    fn the_report_shows_where_the_time_went() {
        let mut recorder = TickRecorder::default();
        for number in 0..99 {
            tick(&mut recorder, 30 * MS * number, 80 * US, 9 * US);
        }
        tick(&mut recorder, 99 * 30 * MS, 15 * MS, 9 * US);
        let summary = recorder.summary(Realtime { priority: true, memory: false, timers: true });
        insta::assert_snapshot!(TimingReport(&summary));
    }

    #[test]
    fn no_ticks_are_no_statistics() {
        let summary = TickRecorder::default().summary(Realtime::default());
        assert_eq!(summary, TickSummary::default());
        assert!(!TimingReport(&summary).to_string().contains("worst"));
    }
}
