//! What was known at each tick of a flight: the tick, and what the drone had sent by then.

use std::collections::VecDeque;
use std::time::Duration;

use ardrone_link::navdata::{DroneState, Packet};

use crate::recording::{DecodedNavdata, Entry, Log, Tick};

/// Navdata that are older are not shown: they say nothing of the moment.
const FRESH_S: f64 = 0.3;
/// Time over which missing packets are counted.
const MISSING_OVER_S: f64 = 1.0;
/// More packets than these are not missing: the drone has restarted, or the number is wrong.
const MOST_MISSING: u32 = 1000;

/// A tick with what had been received by then.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row<'a> {
    /// Seconds since the recording's start.
    pub(super) at_s: f64,
    pub(super) tick: &'a Tick,
    /// Content of the newest packet, if it is fresh.
    pub(super) heard: Option<&'a DecodedNavdata>,
    /// Age of the newest packet, in seconds.
    pub(super) age_s: Option<f64>,
    /// The drone's state in it, if it is fresh.
    pub(super) state: Option<DroneState>,
    /// Share of the packets of the last second that did not arrive.
    pub(super) missing: f64,
    /// Whether the drone began to count its packets anew since the tick before.
    pub(super) restarted: bool,
    /// Voltage of the battery.
    pub(super) battery_v: Option<f64>,
}

/// The rows of a part of a recording.
pub(super) fn rows(log: &Log, (from, until): (Duration, Duration)) -> Vec<Row<'_>> {
    let mut rows = Vec::new();
    let mut decoded: Option<(f64, &DecodedNavdata)> = None;
    let mut heard = Heard::default();
    for (at, entry) in &log.entries {
        let at_s = at.as_secs_f64();
        match entry {
            Entry::Navdata(packet) => heard.take_in(at_s, packet),
            Entry::Decoded(navdata) => decoded = Some((at_s, navdata)),
            Entry::Tick(tick) => {
                let restarted = std::mem::take(&mut heard.restarted);
                if (from..=until).contains(at) {
                    let fresh = decoded.filter(|(heard_s, _)| at_s - heard_s < FRESH_S);
                    rows.push(Row {
                        at_s,
                        tick,
                        heard: fresh.map(|(_, navdata)| navdata),
                        age_s: heard.at_s.map(|heard_s| (at_s - heard_s).max(0.0)),
                        state: heard.state.filter(|_| heard.is_fresh(at_s)),
                        missing: heard.missing(at_s),
                        restarted,
                        battery_v: heard.battery_v,
                    });
                }
            }
            _ => {}
        }
    }
    rows
}

/// What was received so far.
#[derive(Debug, Default)]
struct Heard {
    at_s: Option<f64>,
    state: Option<DroneState>,
    sequence: Option<u32>,
    restarted: bool,
    battery_v: Option<f64>,
    /// Arrivals of the last second, each with the number of packets that are missing before it.
    arrivals: VecDeque<(f64, u32)>,
}

impl Heard {
    fn take_in(&mut self, at_s: f64, packet: &[u8]) {
        // The session has refused what cannot be decoded, too.
        let Ok(packet) = Packet::decode(packet) else { return };
        (self.at_s, self.state) = (Some(at_s), Some(packet.state));
        if let Some(millivolts) = packet.battery_mv() {
            self.battery_v = Some(f64::from(millivolts) / 1e3);
        }
        let last = self.sequence.replace(packet.sequence);
        let ahead = last.map_or(1, |last| packet.sequence.wrapping_sub(last));
        if (1..MOST_MISSING).contains(&ahead) {
            self.arrivals.push_back((at_s, ahead - 1));
        } else if packet.sequence < 3 {
            self.restarted = true;
        } else {
            // It was overtaken by another one: no longer missing.
            self.sequence = last;
            self.arrivals.push_back((at_s, 0));
        }
    }

    /// Whether what was heard last still tells of the moment.
    fn is_fresh(&self, at_s: f64) -> bool {
        self.at_s.is_some_and(|heard_s| at_s - heard_s < FRESH_S)
    }

    fn missing(&mut self, at_s: f64) -> f64 {
        while self.arrivals.front().is_some_and(|(then_s, _)| at_s - then_s > MISSING_OVER_S) {
            self.arrivals.pop_front();
        }
        let missing: u32 = self.arrivals.iter().map(|(_, missing)| *missing).sum();
        let all = f64::from(missing) + self.arrivals.len() as f64;
        if all > 0.0 { f64::from(missing) / all } else { 0.0 }
    }
}
