//! Judge of the soak test, using the mock drone's log.

use std::path::Path;
use std::time::Duration;

use super::script::{End, Script};

/// Time within which an ordered landing begins: by then some of ten datagrams have arrived.
const HEEDED: Duration = Duration::from_millis(1500);
/// Time within which the drone must be down after the pilot's end. If it was killed, the drone lands by
/// itself after 4 s.
const DOWN: Duration = Duration::from_secs(20);
/// Time within which the drone must be down after a first signal, which causes a descent and a landing.
const DOWN_AFTER_SIGNAL: Duration = Duration::from_secs(35);
/// Time for which a take-off may still be in progress when the signal comes.
const UNDER_WAY: Duration = Duration::from_millis(600);

/// Times of what was done, since the drone's start.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Times {
    /// The first end signal, or the kill.
    pub(crate) signal: Option<Duration>,
    /// The second end signal.
    pub(crate) second: Option<Duration>,
    /// SIGCONT.
    pub(crate) resumed: Option<Duration>,
    /// End of the pilot.
    pub(crate) ended: Option<Duration>,
}

/// Result of a flight.
#[derive(Debug, Clone, Default)]
pub(crate) struct Verdict {
    pub(crate) faults: Vec<String>,
    /// The drone was in the air at some time.
    pub(crate) flew: bool,
    /// Time in the air after the pilot was ordered to end, or ended.
    pub(crate) until_down: Option<Duration>,
}

/// A line of the drone's log.
#[derive(Debug, Clone, PartialEq)]
struct Moment {
    at: Duration,
    phase: String,
}

impl Moment {
    fn is_down(&self) -> bool {
        matches!(self.phase.as_str(), "landed" | "emergency")
    }

    fn obeys(&self) -> bool {
        self.is_down() || self.phase == "landing"
    }
}

/// Whether the drone is down according to its log so far; false while the log is empty.
pub(crate) fn is_down(log: &Path) -> bool {
    read(log).is_ok_and(|moments| moments.last().is_some_and(Moment::is_down))
}

/// Reads the log without an incomplete last line.
fn read(log: &Path) -> Result<Vec<Moment>, csv::Error> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(log)?;
    let moments = reader.records().map_while(Result::ok).filter_map(|record| {
        let at = record.get(0)?.parse().ok().map(Duration::from_secs_f64)?;
        let phase = record.get(1)?.to_owned();
        // The phase is complete if another field follows it.
        record.get(2).map(|_| Moment { at, phase })
    });
    Ok(moments.collect())
}

/// Judges a flight by the drone's `log`.
///
/// # Errors
/// If there is no log.
pub(crate) fn judge(script: &Script, times: &Times, log: &Path) -> Result<Verdict, csv::Error> {
    Ok(verdict(script, times, &read(log)?))
}

fn verdict(script: &Script, times: &Times, truth: &[Moment]) -> Verdict {
    let mut faults = Vec::new();
    let mut fault = |wrong: bool, text: &str| {
        if wrong {
            faults.push(text.to_owned());
        }
    };
    // A pilot that is stopped, or whose datagrams are lost, cannot order anything.
    let heard = |at: Duration| {
        let at = times.resumed.map_or(at, |resumed| at.max(resumed));
        (!script.is_out(at, at + HEEDED)).then_some(at)
    };
    let after = |at: Duration| truth.iter().filter(move |moment| moment.at >= at);
    let at_moment = |at: Duration| after(at).next().or(truth.last());
    let disobeys = |at: Duration| at_moment(at + HEEDED).is_some_and(|moment| !moment.obeys());
    let in_the_air = |at: Duration| at_moment(at).is_none_or(|moment| !moment.is_down());

    let killed = script.end == End::Kill && times.signal.is_some();
    if let Some(second) = times.second.and_then(heard) {
        fault(disobeys(second), "still flying 1.5 s after the second signal");
    }
    if let Some(signal) = times.signal {
        let from = times.resumed.map_or(signal, |resumed| signal.max(resumed));
        fault(in_the_air(from + DOWN_AFTER_SIGNAL), "in the air 35 s after the signal");
        let takes_off = |from| {
            let mut pairs = truth.windows(2).filter(|pair| pair[1].at > from);
            pairs.any(|pair| pair[0].is_down() && pair[1].phase == "taking off")
        };
        fault(takes_off(from + UNDER_WAY), "took off after the signal");
    }
    match times.ended {
        None => fault(true, "the pilot has not ended"),
        Some(ended) => {
            let parted = heard(ended).is_some() && !killed;
            fault(parted && disobeys(ended), "still flying 1.5 s after the pilot had ended");
            fault(in_the_air(ended + DOWN), "in the air 20 s after the pilot had ended");
        }
    }
    let ordered = [times.signal, times.ended].into_iter().flatten().min();
    let until_down = ordered.filter(|ordered| in_the_air(*ordered)).map(|ordered| {
        let down = after(ordered).find(|moment| moment.is_down()).or(truth.last());
        down.map_or(Duration::ZERO, |moment| moment.at.saturating_sub(ordered))
    });
    let flew = truth.iter().any(|moment| moment.phase == "flying");
    Verdict { faults, flew, until_down }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soak::script::Sign;

    /// A log with these phases and durations.
    fn truth(phases: &[(&str, f64)]) -> Vec<Moment> {
        let mut at = 0.0;
        let mut moments = Vec::new();
        for (phase, seconds) in phases {
            let end = at + seconds;
            while at < end {
                moments
                    .push(Moment { at: Duration::from_secs_f64(at), phase: (*phase).to_owned() });
                at += 0.1;
            }
        }
        moments
    }

    fn script(end: End) -> Script {
        Script { end, outages: Vec::new(), ..Script::new(1) }
    }

    fn times(signal: u64, second: Option<u64>, ended: u64) -> Times {
        let seconds = Duration::from_secs;
        Times {
            signal: Some(seconds(signal)),
            second: second.map(seconds),
            resumed: None,
            ended: Some(seconds(ended)),
        }
    }

    const FLIGHT: [(&str, f64); 3] = [("landed", 2.0), ("taking off", 3.0), ("flying", 5.0)];

    fn judged(end: End, times: &Times, rest: &[(&str, f64)]) -> Vec<String> {
        verdict(&script(end), times, &truth(&[&FLIGHT, rest].concat())).faults
    }

    #[test]
    fn a_landing_that_is_ordered_at_once_is_good_and_one_by_the_drone_itself_is_not() {
        let end = End::Twice(Sign::Interrupt, Duration::ZERO);
        let times = times(9, Some(10), 11);
        assert_eq!(judged(end, &times, &[("landing", 4.0), ("landed", 40.0)]), [""; 0]);
        // Without effective landing orders the drone waits for 4 s, then lands by itself.
        let faults = judged(end, &times, &[("flying", 5.0), ("landing", 4.0), ("landed", 40.0)]);
        assert_eq!(faults.len(), 2, "{faults:?}");
    }

    #[test]
    fn a_signal_that_is_not_heard_is_a_fault() {
        let rest = [("flying", 60.0), ("landing", 4.0), ("landed", 10.0)];
        let faults = judged(End::Once(Sign::Interrupt), &times(9, None, 75), &rest);
        assert_eq!(faults, ["in the air 35 s after the signal"]);
    }

    #[test]
    fn a_killed_pilot_has_the_drones_own_landing() {
        let rest = [("flying", 4.0), ("landing", 4.0), ("landed", 40.0)];
        assert_eq!(judged(End::Kill, &times(10, None, 10), &rest), [""; 0]);
        let never = [("flying", 60.0)];
        assert!(!judged(End::Kill, &times(10, None, 10), &never).is_empty());
    }

    #[test]
    fn a_drone_that_takes_off_again_is_a_fault() {
        let rest = [("landing", 3.0), ("landed", 2.0), ("taking off", 2.0), ("landed", 50.0)];
        let faults = judged(End::Once(Sign::Terminate), &times(10, None, 14), &rest);
        assert!(faults.contains(&"took off after the signal".to_owned()), "{faults:?}");
    }

    #[test]
    fn what_nobody_could_hear_is_not_held_against_the_pilot() {
        let end = End::Twice(Sign::Interrupt, Duration::ZERO);
        let outage = (Duration::from_secs(9), Duration::from_secs(14));
        let script = Script { outages: vec![outage], ..script(end) };
        let rest = [("flying", 3.0), ("landing", 4.0), ("landed", 40.0)];
        let truth = truth(&[&FLIGHT[..], &rest].concat());
        assert_eq!(verdict(&script, &times(9, Some(10), 11), &truth).faults, [""; 0]);
    }
}
