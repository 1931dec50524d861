//! Tells a gap of the link from a gap of one quantity. While packets arrive the link works, and the drone hears its
//! orders; while none arrive, it may not.

/// Longest interval between packets that counts as gapless.
pub(crate) const USUAL_STEP_S: f64 = 0.1;

/// After a longer interval it is not known what moved the drone meanwhile, and packets that come later than usual by more are
/// out of date.
pub(crate) const GAP_S: f64 = 0.3;

/// A drone that receives nothing keeps its last sticks for this long; then it hovers by itself.
pub(crate) const KEPT_S: f64 = 2.0;
/// Which order it received last is unknown: the largest number of them that are tried.
pub(crate) const TRIED: usize = 20;

/// Times in a gap at which the drone may have received its last order; the first is the beginning of the gap.
pub(crate) fn last_heard_s(from_s: f64, to_s: f64) -> impl Iterator<Item = f64> {
    let every_s = ((to_s - from_s) / TRIED as f64).max(USUAL_STEP_S);
    let tried = (0..TRIED).map(move |i| from_s + i as f64 * every_s);
    tried.take_while(move |at_s| *at_s < to_s)
}

/// The time without packets since a quantity was last measured.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Silence {
    packet_s: Option<f64>,
    silent_s: f64,
}

impl Silence {
    /// A packet was sent at a time, in seconds, whatever is in it.
    pub(crate) fn hear(&mut self, at_s: f64) {
        let interval_s = self.packet_s.replace(at_s).map_or(0.0, |last_s| at_s - last_s);
        if interval_s > USUAL_STEP_S {
            self.silent_s += interval_s;
        }
    }

    /// The quantity is measured. Returns the share, from 0 to 1, of the `step_s` since its last measurement in which
    /// no packets arrived.
    pub(crate) fn end(&mut self, step_s: f64) -> f64 {
        let silent_s = std::mem::take(&mut self.silent_s);
        if step_s > 0.0 { (silent_s / step_s).min(1.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_orders_that_were_perhaps_the_last_are_tried_at_intervals() {
        let tried = |from_s, to_s| last_heard_s(from_s, to_s).count();
        assert_eq!((tried(1.0, 1.05), tried(1.0, 1.25), tried(1.0, 2.95)), (1, 3, 20));
        assert_eq!((tried(1.0, 1.0), tried(0.0, 1000.0)), (0, 20));
        assert!(last_heard_s(7.0, 8.0).eq((0..10).map(|i| 7.0 + f64::from(i) * 0.1)));
    }

    #[test]
    fn only_time_without_packets_counts() {
        let mut silence = Silence::default();
        for at_s in [1.0, 1.06, 1.12] {
            silence.hear(at_s);
        }
        assert!(silence.end(0.12).abs() < 1e-9, "the quantity alone was missing");
        silence.hear(1.42);
        silence.hear(1.5);
        assert!((silence.end(0.4) - 0.75).abs() < 1e-9, "0.3 of 0.4 s");
        assert!(silence.end(0.4).abs() < 1e-9, "it begins again");
        silence.hear(2.5);
        assert!((silence.end(1.0) - 1.0).abs() < 1e-9);
        silence.hear(3.5);
        assert!(silence.end(0.0).abs() < 1e-9);
    }
}
