//! What led to a flight's end, from all that was recorded: what was first seen of each thing that went wrong.

use std::collections::{BTreeMap, VecDeque};

use ardrone_link::navdata::DroneState;
use kinematics::wrap_deg;
use serde::Serialize;

use super::data::Flight;
use super::rows::Row;
use super::series::tilt_ordered;
use super::spans::{Level, Span, set};
use super::{wind, words};
use crate::recording::DecodedNavdata;

/// Navdata that are older are a gap, in seconds: several packets.
const GAP_S: f64 = 0.3;
/// Share of missing packets that is worth telling.
const MISSING: f64 = 0.1;
/// Share of full tilt's acceleration from which wind is worth telling.
const WINDY: f64 = 0.4;
/// Charge in percent that no flight takes within a second.
const CHARGE_LOST: u32 = 4;
const CHARGE_LOST_WITHIN_S: f64 = 1.0;
/// Tilt away from what was ordered, in degrees, and for how long: more than the airframe's lag.
const TILTED_DEG: f64 = 7.0;
const TILTED_FOR_S: f64 = 0.25;
/// The drone follows an order after about this time, in seconds.
const ORDER_LAG_S: f64 = 0.15;
/// Stick at which it is told to climb, for how long, and how far it then sank all the same.
const CLIMBS: f64 = 0.15;
const CLIMBS_FOR_S: f64 = 0.4;
const SUNK_M: f64 = 0.08;
/// Jumps of height and heading that are worth telling, and the time within which no drone does so.
const STEP_M: f64 = 0.3;
const STEP_DEG: f64 = 15.0;
const STEP_WITHIN_S: f64 = 0.15;
/// What navdata said before is told of so many seconds.
const BEFORE_S: f64 = 0.5;
/// Lateness of a tick that is worth telling: a whole period.
const LATE_MS: f64 = 30.0;
/// Deviation of the place that is worth telling, in metres: half of what lands the drone.
const DOUBTFUL_M: f64 = 1.0;
/// A state that lasts shorter is no news: the watchdog barks at each lost datagram.
const STATE_FOR_S: f64 = 0.2;

/// Something that explains a flight's course.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Finding {
    /// When it was first seen, in seconds since the recording's start.
    pub(super) at_s: f64,
    /// Printable, in one line.
    pub(super) text: String,
}

/// All findings, in the order of time.
pub(super) fn findings(flight: &Flight<'_>) -> Vec<Finding> {
    let mut found = Findings::default();
    found.beliefs(flight);
    found.jumps(flight);
    let air: Vec<&Row<'_>> = flight.rows.iter().filter(|row| !row.tick.agent.on_ground).collect();
    found.link(&air);
    found.states(&air);
    found.charge(&flight.rows);
    found.peak(&air, |row| row.tick.agent.wind, WINDY, |most, until_s| {
        let then = air.iter().find(|row| row.at_s >= until_s).and_then(|row| row.tick.wind_m_s2);
        let side = then.map_or_else(String::new, |towards| format!(" {}", wind::from(towards)));
        format!("wind, or a push like it{side}: up to {:.0} % of what full tilt holds against, at {until_s:.2} s", most * 100.0)
    });
    found.tilt(flight, &air);
    found.thrust(&air);
    let late = |row: &Row<'_>| row.tick.timing.late_ms;
    found.peak(&air, late, LATE_MS, |most, until_s| {
        format!("a tick was late: up to {most:.0} ms, at {until_s:.2} s")
    });
    let doubt = |row: &Row<'_>| row.tick.estimate.map_or(0.0, |at| at.uncertainty_m);
    found.peak(&air, doubt, DOUBTFUL_M, |most, until_s| {
        format!("the uncertainty of the place was above {DOUBTFUL_M} m: up to {most:.2} m, at {until_s:.2} s")
    });
    found.decided(flight);
    let mut all = found.all;
    all.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    all
}

#[derive(Debug, Default)]
struct Findings {
    all: Vec<Finding>,
}

impl Findings {
    fn add(&mut self, at_s: f64, text: String) {
        self.all.push(Finding { at_s, text });
    }

    /// The first time at which a value is above a limit, with its largest value and when it had that.
    fn peak(
        &mut self,
        rows: &[&Row<'_>],
        value: impl Fn(&Row<'_>) -> f64,
        limit: f64,
        text: impl Fn(f64, f64) -> String,
    ) {
        let above = rows.iter().map(|row| (row.at_s, value(row))).filter(|(_, it)| *it > limit);
        let most = above.clone().max_by(|a, b| a.1.total_cmp(&b.1));
        if let (Some((at_s, _)), Some((until_s, most))) = (above.clone().next(), most) {
            self.add(at_s, text(most, until_s));
        }
    }

    /// What was disproved of navdata, with what they said at that time.
    fn beliefs(&mut self, flight: &Flight<'_>) {
        for strip in &flight.beliefs {
            let of = |level| strip.spans.iter().filter(move |span| span.level == level);
            let wrong = || of(Level::Wrong);
            let Some(first) = wrong().next() else {
                self.suspicion(flight, strip.name, of(Level::Suspect));
                continue;
            };
            // Suspected before it was disproved: the fault began there.
            let since_s = strip.spans.iter().rev().find(|span| {
                span.level == Level::Suspect && (first.from_s - span.to_s).abs() < 1e-6
            });
            let since_s = since_s.map_or(first.from_s, |span| span.from_s);
            let how = match first.text.as_str() {
                "frozen" => "did not change any more",
                "implausible" => "had values that a drone cannot have, or jumped",
                "noisy" => "had more noise than its sensor",
                "unresponsive" => "did not follow the sticks",
                "lost" => "was lost by the drone, as it said itself",
                _ => "was not believed",
            };
            let values = values(flight, strip.name, since_s, first.from_s);
            let length_s: f64 = wrong().map(|span| span.to_s - span.from_s).sum();
            let text = format!(
                "the {} in navdata {how}: suspected from {since_s:.2} s, not believed from {:.2} s for {length_s:.1} s in all{values}",
                strip.name, first.from_s
            );
            self.add(since_s, text);
        }
    }

    /// What was suspected, and believed again: a step that was compensated, or a moment of noise.
    fn suspicion<'a>(
        &mut self,
        flight: &Flight<'_>,
        quantity: &str,
        mut suspected: impl Iterator<Item = &'a Span>,
    ) {
        let Some(first) = suspected.next() else { return };
        let others = suspected.count();
        let times = if others == 0 { String::new() } else { format!(", and {others} times more") };
        let values = values(flight, quantity, first.from_s, first.to_s);
        let text = format!(
            "the {quantity} in navdata was suspected at {:.2} s{times}, and believed again: a step or a moment of noise{values}",
            first.from_s
        );
        self.add(first.from_s, text);
    }

    /// A height or a heading that jumps, and is believed all the same: a box on the floor, a compass beside iron.
    fn jumps(&mut self, flight: &Flight<'_>) {
        let height: Off = |row| Some(row.heard?.altitude_m? - row.tick.estimate?.z_m);
        let heading: Off =
            |row| Some(wrap_deg(row.heard?.attitude_deg?[2] - row.tick.estimate?.yaw_deg));
        for (name, unit, least, off, or) in [
            ("altitude", "m", STEP_M, height, "a step of the floor"),
            ("heading", "°", STEP_DEG, heading, "iron beside the compass"),
        ] {
            let mut before: VecDeque<(f64, f64)> = VecDeque::new();
            for row in flight.rows.iter().filter(|row| row.tick.phase == "flying") {
                let Some(now) = off(row) else { continue };
                while before.front().is_some_and(|(at_s, _)| row.at_s - at_s > STEP_WITHIN_S) {
                    before.pop_front();
                }
                let jump = before.front().map_or(0.0, |(_, then)| now - then);
                let jump = if unit == "°" { wrap_deg(jump) } else { jump };
                if jump.abs() >= least {
                    let text = format!(
                        "the {name} in navdata jumped by {jump:+.2} {unit} against the estimate: {or} or a wrong {name}"
                    );
                    self.add(row.at_s, text);
                    break;
                }
                before.push_back((row.at_s, now));
            }
        }
    }

    /// Packets that did not arrive.
    fn link(&mut self, air: &[&Row<'_>]) {
        let mut gaps: Vec<(f64, f64)> = Vec::new();
        for row in air {
            let age_s = row.age_s.unwrap_or(0.0);
            let since_s = row.at_s - age_s;
            match gaps.last_mut() {
                _ if age_s < GAP_S => {}
                Some((begun_s, length_s)) if (*begun_s - since_s).abs() < 1e-3 => *length_s = age_s,
                _ => gaps.push((since_s, age_s)),
            }
        }
        if let Some((since_s, _)) = gaps.first() {
            let longest_s = gaps.iter().map(|gap| gap.1).fold(0.0, f64::max);
            let times =
                if gaps.len() == 1 { String::new() } else { format!(", {} times", gaps.len()) };
            let text = format!("no navdata arrived for up to {longest_s:.2} s{times}");
            self.add(*since_s, text);
        }
        self.peak(air, |row| row.missing, MISSING, |most, until_s| {
            let percent = most * 100.0;
            format!("packets of navdata were lost: up to {percent:.0} % of those of a second, at {until_s:.2} s")
        });
        for row in air.iter().filter(|row| row.restarted).take(1) {
            self.add(
                row.at_s,
                "the drone counts its packets from 1 again: it has restarted".into(),
            );
        }
    }

    /// What the drone said of itself.
    fn states(&mut self, air: &[&Row<'_>]) {
        let mut since: BTreeMap<u32, (f64, f64, &str)> = BTreeMap::new();
        let mut told: BTreeMap<u32, (f64, f64, &str)> = BTreeMap::new();
        let mut last_s = air.first().map_or(0.0, |row| row.at_s);
        for row in air {
            let step_s = row.at_s - last_s;
            last_s = row.at_s;
            let now: Vec<(DroneState, &str)> = set(row).collect();
            since.retain(|bit, _| now.iter().any(|(state, _)| state.bits() == *bit));
            for (state, text) in now {
                let entry = since.entry(state.bits()).or_insert((row.at_s, 0.0, text));
                entry.1 += step_s;
                let longest_s = entry.1;
                if longest_s >= STATE_FOR_S || state == DroneState::EMERGENCY {
                    let first = told.entry(state.bits()).or_insert((entry.0, longest_s, text));
                    first.1 = first.1.max(longest_s);
                }
            }
        }
        for (at_s, length_s, text) in told.into_values() {
            self.add(at_s, format!("the drone reports: {text}, for up to {length_s:.1} s"));
        }
    }

    /// A charge that falls faster than it can be used.
    fn charge(&mut self, rows: &[Row<'_>]) {
        let charges =
            rows.iter().filter_map(|row| Some((row.at_s, row.tick.agent.battery_percent?)));
        let mut before: Option<(f64, u32)> = None;
        for (at_s, percent) in charges {
            let (since_s, most) = before.unwrap_or((at_s, percent));
            if percent + CHARGE_LOST <= most {
                self.add(at_s, format!("the charge fell from {most} to {percent} % at once"));
                return;
            }
            if at_s - since_s > CHARGE_LOST_WITHIN_S || percent > most || before.is_none() {
                before = Some((at_s, percent));
            }
        }
    }

    /// A drone that leans otherwise than it was told.
    fn tilt(&mut self, flight: &Flight<'_>, air: &[&Row<'_>]) {
        let ordered: Vec<(f64, (f64, f64))> = flight
            .rows
            .iter()
            .filter_map(|row| Some((row.at_s, tilt_ordered(row, &flight.scales)?)))
            .collect();
        let (mut since, mut most): (Option<f64>, Option<(f64, f64)>) = (None, None);
        for row in air.iter().filter(|row| row.tick.phase == "flying" && !row.tick.command.hover) {
            let off_deg = row.heard.and_then(|heard| heard.attitude_deg).and_then(|attitude| {
                let index = ordered.partition_point(|(at_s, _)| *at_s < row.at_s - ORDER_LAG_S);
                let (_, (right, forward)) = ordered.get(index)?;
                // Of what was ordered around then, whatever is nearest.
                let near = &ordered[index.saturating_sub(6)..(index + 6).min(ordered.len())];
                let nearest = near.iter().map(|(_, (right, forward))| {
                    (attitude[0] - right).hypot(-attitude[1] - forward)
                });
                let here = (attitude[0] - right).hypot(-attitude[1] - forward);
                Some(nearest.fold(here, f64::min))
            });
            // What is no number is told of the attitude.
            let off_deg = off_deg.filter(|off_deg| off_deg.is_finite()).unwrap_or(0.0);
            if off_deg < TILTED_DEG {
                since = None;
                continue;
            }
            let since_s = *since.get_or_insert(row.at_s);
            if row.at_s - since_s >= TILTED_FOR_S {
                let (first_s, most_deg) = most.unwrap_or((since_s, off_deg));
                most = Some((first_s, most_deg.max(off_deg)));
            }
        }
        if let Some((at_s, most_deg)) = most {
            let text = format!(
                "navdata show it leaning up to {most_deg:.0}° away from what was ordered: it does not obey, or the attitude is wrong"
            );
            self.add(at_s, text);
        }
    }

    /// A drone that sinks although it is told to climb.
    fn thrust(&mut self, air: &[&Row<'_>]) {
        // A drone that brakes its descent sinks more slowly from tick to tick.
        let mut since: Option<(f64, f64, f64)> = None;
        let mut worst: Option<(f64, f64, f64)> = None;
        for row in air {
            let climbs = row.tick.command.gaz >= CLIMBS && row.tick.phase == "flying";
            let height_m = row.heard.and_then(|heard| heard.altitude_m);
            let (true, Some(height_m)) = (climbs, height_m) else {
                since = None;
                continue;
            };
            let climb_m_s = row.tick.estimate.map_or(0.0, |at| at.vz_m_s);
            let (since_s, from_m, from_m_s) = *since.get_or_insert((row.at_s, height_m, climb_m_s));
            let (for_s, sunk_m) = (row.at_s - since_s, from_m - height_m);
            let is_worse = worst.is_none_or(|(_, _, most_m)| sunk_m > most_m);
            let sinks = sunk_m >= SUNK_M && climb_m_s < from_m_s;
            if for_s >= CLIMBS_FOR_S && sinks && is_worse {
                worst = Some((since_s, for_s, sunk_m));
            }
        }
        if let Some((since_s, for_s, sunk_m)) = worst {
            let text = format!(
                "by its altitude it sank {sunk_m:.2} m in {for_s:.1} s while it was told to climb: it has too little thrust, or the altitude is wrong"
            );
            self.add(since_s, text);
        }
    }

    /// The first danger and veto of each kind, and the warnings.
    fn decided(&mut self, flight: &Flight<'_>) {
        let mut told: Vec<&str> = Vec::new();
        for event in flight.events.iter().filter(|event| event.kind.warns()) {
            let text = event.text.as_str();
            if !told.contains(&text) && text != words::NO_VETO && told.len() < 12 {
                told.push(text);
                self.add(event.at_s, event.text.clone());
            }
        }
    }
}

/// What navdata said of a quantity before something was wrong with it, and while it was.
fn values(flight: &Flight<'_>, quantity: &str, from_s: f64, until_s: f64) -> String {
    let range = |(from_s, until_s): (f64, f64), value: Value| {
        let rows = flight.rows.iter().filter(|row| (from_s..until_s).contains(&row.at_s));
        let (mut least, mut most, mut is_number) = (f64::INFINITY, f64::NEG_INFINITY, true);
        for value in rows.filter_map(|row| value(row.heard?)) {
            is_number &= !value.is_nan();
            (least, most) = (least.min(value), most.max(value));
        }
        match (least <= most, is_number) {
            (true, true) => format!("{least:.2} to {most:.2}"),
            (true, false) => format!("{least:.2} to {most:.2}, or no number"),
            (false, false) => "no number".to_owned(),
            (false, true) => "nothing".to_owned(),
        }
    };
    let parts: &[(&str, Value)] = match quantity {
        "velocity" => &[
            ("m/s to the right", |heard| Some(heard.velocity_m_s?[1])),
            ("m/s forward", |heard| Some(heard.velocity_m_s?[0])),
        ],
        "altitude" => &[("m", |heard| heard.altitude_m)],
        "heading" => &[("°", |heard| Some(heard.attitude_deg?[2]))],
        "attitude" => &[
            ("° to the right", |heard| Some(heard.attitude_deg?[0])),
            ("° forward", |heard| Some(-heard.attitude_deg?[1])),
        ],
        _ => return String::new(),
    };
    let said = |times| {
        let parts = parts.iter().map(|(unit, value)| format!("{} {unit}", range(times, *value)));
        parts.collect::<Vec<_>>().join(" and ")
    };
    let before = said((from_s - BEFORE_S, from_s - 0.03));
    format!("; navdata said {before} before, and {} then", said((from_s, until_s + 0.1)))
}

/// What navdata say, less the estimate.
type Off = fn(&Row<'_>) -> Option<f64>;

/// A number in navdata.
type Value = fn(&DecodedNavdata) -> Option<f64>;
