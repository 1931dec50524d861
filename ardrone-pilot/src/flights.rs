//! The flights in a recording: a recording is of all that a program flew from its start to its end.

use std::time::Duration;

use serde_json::{Value, json};

use crate::recording::{Entry, Log, Tick};

/// Maximum number of points of a track.
const POINTS: usize = 3000;

/// A flight in a recording.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RecordedFlight {
    /// The mission's plan; empty if it had none.
    pub(crate) plan: String,
    /// First and last tick in the air; both are the end for a flight that never left the ground.
    pub(crate) air: (Duration, Duration),
    /// When its outcome was known.
    pub(crate) ended: Option<Duration>,
    /// Whether it is a warning, and text; `None` for a flight that goes on or was cut off.
    pub(crate) outcome: Option<(bool, String)>,
    /// Charge at the beginning and at the end.
    pub(crate) battery_percent: Option<(u32, u32)>,
    /// Largest distance from where it began.
    pub(crate) furthest_m: f64,
    /// Where that was: right and forward.
    began_m: Option<[f64; 2]>,
}

/// The flights of a recording, in their order. [`Log::read_decisions`] is enough for them.
pub(crate) fn flights(log: &Log) -> Vec<RecordedFlight> {
    let mut flights = Vec::new();
    let mut plan = log.plan_name.clone();
    let mut flight: Option<RecordedFlight> = None;
    // Of what was flown before the last outcome nothing can come any more.
    let mut is_past = true;
    for (at, entry) in &log.entries {
        match entry {
            Entry::Mission(mission) => plan.clone_from(&mission.name),
            Entry::Tick(tick) => {
                // A drone whose outcome is known before it is down lands for the same flight, and so does one that an old
                // order lifts again.
                is_past |= !matches!(tick.phase.as_str(), "landing" | "standby");
                if !is_in_the_air(tick) {
                    continue;
                }
                let last = flights.last_mut().filter(|_| !is_past && flight.is_none());
                let new = || RecordedFlight::new(&plan, *at);
                last.unwrap_or_else(|| flight.get_or_insert_with(new)).extend(*at, tick);
            }
            Entry::Outcome { warns, text } => {
                let mut flight = flight.take().unwrap_or_else(|| RecordedFlight::new(&plan, *at));
                flight.outcome = Some((*warns, text.clone()));
                flight.ended = Some(*at);
                flights.push(flight);
                is_past = false;
            }
            _ => {}
        }
    }
    flights.extend(flight);
    flights
}

/// Whether a flight of ours goes on in a tick: the one place that says so of recordings. It has ended when the drone is on the
/// ground, or when its motors are off: then the vehicle no longer flies or lands.
pub(crate) fn is_in_the_air(tick: &Tick) -> bool {
    matches!(tick.phase.as_str(), "flying" | "landing") && !tick.agent.on_ground
}

impl RecordedFlight {
    fn new(plan: &str, at: Duration) -> Self {
        let air = (at, at);
        let plan = plan.to_owned();
        Self {
            plan,
            air,
            ended: None,
            outcome: None,
            battery_percent: None,
            furthest_m: 0.0,
            began_m: None,
        }
    }

    fn extend(&mut self, at: Duration, tick: &Tick) {
        self.air.1 = at;
        if let Some(charge) = tick.agent.battery_percent {
            let (first, _) = self.battery_percent.unwrap_or((charge, charge));
            self.battery_percent = Some((first, charge));
        }
        if let Some(at) = tick.estimate {
            let [x_m, y_m] = *self.began_m.get_or_insert([at.x_m, at.y_m]);
            self.furthest_m = self.furthest_m.max((at.x_m - x_m).hypot(at.y_m - y_m));
        }
    }

    /// As a JSON object.
    pub(crate) fn json(&self) -> Value {
        let (from, until) = self.air;
        json!({
            "plan": self.plan,
            "from_s": from.as_secs_f64(),
            "length_s": until.saturating_sub(from).as_secs_f64(),
            "warning": self.outcome.as_ref().is_none_or(|(warns, _)| *warns),
            "outcome": self.outcome.as_ref().map(|(_, text)| text),
            "battery_percent": self.battery_percent.map(|(first, last)| [first, last]),
            "furthest_m": self.furthest_m,
        })
    }

    /// Its track as rows of seconds since it left the ground, metres right, forward and up, degrees clockwise.
    pub(crate) fn track(&self, log: &Log) -> Vec<[f64; 5]> {
        let (from, until) = self.air;
        let inside = || log.ticks().filter(|(at, _)| (from..=until).contains(at));
        let every = inside().count().div_ceil(POINTS).max(1);
        let point = |(at, tick): (Duration, &Tick)| {
            let pose = tick.estimate?;
            let since_s = at.saturating_sub(from).as_secs_f64();
            Some([since_s, pose.x_m, pose.y_m, pose.z_m, pose.yaw_deg])
        };
        inside().step_by(every).filter_map(point).collect()
    }
}
