//! Data of a report, extracted from a log.

use std::collections::BTreeMap;
use std::time::Duration;

use ardrone_link::navdata::DroneState;
use autopilot::agent::plan_text;
use autopilot::plan::Border;
use autopilot::vehicle::VehicleConfig;
use diagnostic::{printable, printable_lines};
use kinematics::Pose;
use serde::Serialize;

use super::events::{Event, events};
use super::others::{Other, others};
use super::rows::{Row, rows};
use super::series::Scales;
use super::spans::{Strip, beliefs, states};
use super::words::{self, spoken};
use crate::flights::is_in_the_air;
use crate::recording::{Entry, Log, Tags, Tick};
use crate::settings::Settings;

/// Maximum length of a plan's text and maximum number of plans. They bound the size of the page for a forged
/// log; real agents have less.
const LONGEST_PLAN: usize = 2000;
const MOST_PLANS: usize = 500;
/// Maximum number of moments with tags in the page.
const MOST_TAG_MOMENTS: usize = 2000;
/// Maximum length of a label.
const LONGEST_LABEL: usize = 100;

/// A flight as needed by the report. All text in it is [printable], whatever the log contains.
#[derive(Debug)]
pub(super) struct Flight<'a> {
    /// The ticks, with what had been heard by then.
    pub(super) rows: Vec<Row<'a>>,
    /// What their numbers refer to.
    pub(super) scales: Scales,
    /// The fence, if the recorded settings can be read.
    pub(super) fence: Option<Border>,
    /// Where the drone stood at its first start.
    pub(super) start_m: [f64; 2],
    /// What was believed of each quantity.
    pub(super) beliefs: Vec<Strip>,
    /// What the drone said of itself.
    pub(super) states: Vec<Strip>,
    /// Sections of the flight for the background of plots.
    pub(super) bands: Vec<Band>,
    /// Decisions of the agent; consecutive equal ones are merged.
    pub(super) decisions: Vec<Decision>,
    /// Source text of the chosen plans, by line.
    pub(super) plans: BTreeMap<u32, String>,
    /// Everything that happened.
    pub(super) events: Vec<Event>,
    /// Seconds, and the tags that were known then.
    pub(super) tags: Vec<(f64, &'a Tags)>,
    /// Other vehicles.
    pub(super) others: Vec<Other>,
    /// Steps of the mission at the end: those up to the last one that was carried out, and all.
    pub(super) steps: [usize; 2],
    /// Times of the first and of the last tick, in seconds since the recording's start.
    pub(super) begin_s: f64,
    pub(super) end_s: f64,
}

/// A section of the flight, drawn as background of plots.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Band {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// The plan step, or the phase.
    pub(super) label: String,
    pub(super) kind: BandKind,
}

/// Colour of a band.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum BandKind {
    /// On the ground, before or after the flight.
    Ground,
    /// A step of the plan; even and odd ones have different colours.
    Step(usize),
    /// In the air without a step: paused, manual control, landing early, or falling.
    Other,
}

/// A decision of the agent and what led to it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Decision {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// The step as written in the plan.
    pub(super) step: String,
    /// The agent's command.
    pub(super) command: String,
    /// Trigger and line of each chosen plan.
    pub(super) plans: Vec<(String, u32)>,
    /// How its last order ended.
    pub(super) said: Option<String>,
    /// Dangers that it reported, and vetoes of the safety monitor.
    pub(super) warnings: Vec<String>,
}

impl<'a> Flight<'a> {
    /// A part of a recording; `None` if nothing was decided in it.
    pub(super) fn new(log: &'a Log, span: (Duration, Duration)) -> Option<Self> {
        let rows = rows(log, span);
        let (begin_s, end_s) = (rows.first()?.at_s, rows.last()?.at_s);
        let mut missions = log.missions().peekable();
        let mut steps = steps(&log.plan);
        let (beliefs, states) = (beliefs(&rows), states(&rows));
        // The settings of a log of another version may not be valid in this one.
        let config = Settings::parse("pilot.toml", &log.settings).ok();
        let config = config.map(|settings| settings.pilot_config(log.z_origin));
        let events = events(log, span, &rows, &beliefs, &states);
        let at = |pose: Pose| [pose.x_m, pose.y_m];
        let mut flight = Self {
            bands: Vec::new(),
            decisions: Vec::new(),
            plans: BTreeMap::new(),
            scales: scales(config.as_ref(), &rows),
            start_m: config.as_ref().and_then(|config| config.limits.start).map_or([0.0; 2], at),
            fence: config.map(|config| config.limits.border),
            beliefs,
            states,
            events,
            tags: tags(log, span),
            others: others(log, span),
            steps: steps_done(log, span, steps.len()),
            begin_s,
            end_s,
            rows,
        };
        for index in 0..flight.rows.len() {
            let row = flight.rows[index];
            let Row { at_s, tick, .. } = row;
            let until_s = flight.rows.get(index + 1).map_or(at_s, |next| next.at_s);
            while let Some((_, mission)) = missions.next_if(|(at, _)| at.as_secs_f64() <= at_s) {
                steps = mission.steps.iter().map(|step| label(step)).collect();
            }
            flight.extend_band(&row, until_s, &steps);
            flight.extend_decision(&row, until_s, &steps);
            flight.extend_plans(tick, &log.agent);
        }
        Some(flight)
    }

    fn extend_band(&mut self, row: &Row<'_>, until_s: f64, steps: &[String]) {
        let Row { at_s, tick, .. } = *row;
        let (label, kind) = match tick.step {
            Some(step) => (step_text(steps, step), BandKind::Step(step)),
            None if tick.agent.on_ground => (phase(row), BandKind::Ground),
            None => (phase(row), BandKind::Other),
        };
        match self.bands.last_mut() {
            Some(band) if band.kind == kind && band.label == label => band.to_s = until_s,
            _ => self.bands.push(Band { from_s: at_s, to_s: until_s, label, kind }),
        }
    }

    fn extend_decision(&mut self, row: &Row<'_>, until_s: f64, steps: &[String]) {
        let Row { at_s, tick, .. } = *row;
        let Tick { agent, veto, .. } = tick;
        let danger = agent.danger.iter().map(|danger| label(&words::danger(danger)));
        let veto = veto.iter().map(|veto| label(&words::veto(veto)));
        let plans = agent.plans.iter().map(|plan| (label(&plan.trigger), plan.line));
        let step = tick.step.map_or_else(|| phase(row), |step| step_text(steps, step));
        let decision = Decision {
            from_s: at_s,
            to_s: until_s,
            step,
            command: label(&spoken(&agent.command)),
            plans: plans.collect(),
            said: agent.report.as_ref().map(|report| label(&words::last_order(report))),
            warnings: danger.chain(veto).collect(),
        };
        match self.decisions.last_mut() {
            Some(last) if last.is_like(&decision) => last.to_s = until_s,
            _ => self.decisions.push(decision),
        }
    }

    /// Adds the source text of the plans chosen in a tick.
    fn extend_plans(&mut self, tick: &Tick, agent: &str) {
        for plan in &tick.agent.plans {
            if self.plans.len() < MOST_PLANS && !self.plans.contains_key(&plan.line) {
                let text: String = plan_text(agent, plan.line).chars().take(LONGEST_PLAN).collect();
                self.plans.insert(plan.line, printable_lines(&text).into_owned());
            }
        }
    }

    /// The ticks.
    pub(super) fn ticks(&self) -> impl DoubleEndedIterator<Item = (f64, &'a Tick)> + '_ {
        self.rows.iter().map(|row| (row.at_s, row.tick))
    }

    /// Duration in the air, in seconds.
    pub(super) fn flown_s(&self) -> f64 {
        let mut airborne = self.ticks().filter(|(_, tick)| is_in_the_air(tick));
        let first = airborne.next().map(|(at_s, _)| at_s);
        let last = airborne.next_back().map(|(at_s, _)| at_s);
        first.zip(last).map_or(0.0, |(first, last)| last - first)
    }

    /// Charge at the beginning and at the end, in percent.
    pub(super) fn battery_percent(&self) -> Option<(u32, u32)> {
        let charge = |(_, tick): (f64, &Tick)| tick.agent.battery_percent;
        Some((self.ticks().find_map(charge)?, self.ticks().rev().find_map(charge)?))
    }

    /// Voltage at the beginning and at the end, if it was sent.
    pub(super) fn battery_v(&self) -> Option<(f64, f64)> {
        let mut known = self.rows.iter().filter_map(|row| row.battery_v);
        let first = known.next()?;
        Some((first, known.next_back().unwrap_or(first)))
    }

    /// Lateness of all ticks, sorted, in ms.
    pub(super) fn lateness_ms(&self) -> Vec<f64> {
        let mut late: Vec<f64> = self.ticks().map(|(_, tick)| tick.timing.late_ms).collect();
        late.sort_by(f64::total_cmp);
        late
    }
}

/// The known tags at some moments.
fn tags(log: &Log, (from, until): (Duration, Duration)) -> Vec<(f64, &Tags)> {
    let tags = || {
        let inside = log.tags().filter(move |(at, _)| (from..=until).contains(at));
        inside.map(|(at, tags)| (at.as_secs_f64(), tags))
    };
    let every = tags().count().div_ceil(MOST_TAG_MOMENTS).max(1);
    // The last one is always among them.
    let skipped = tags().count().saturating_sub(1) % every;
    tags().skip(skipped).step_by(every).collect()
}

/// What numbers refer to. Without settings no tilt is known.
fn scales(config: Option<&VehicleConfig>, rows: &[Row<'_>]) -> Scales {
    let tilt_rad = config.map(|config| config.estimator.limits.tilt_rad);
    let north_deg =
        rows.iter().find_map(|row| Some(row.heard?.attitude_deg?[2] - row.tick.estimate?.yaw_deg));
    Scales { tilt_deg: tilt_rad.map(f64::to_degrees), north_deg }
}

impl Decision {
    fn is_like(&self, other: &Self) -> bool {
        (&self.step, &self.command, &self.plans, &self.said, &self.warnings)
            == (&other.step, &other.command, &other.plans, &other.said, &other.warnings)
    }
}

/// As the vehicle counts them for the flight in a part ([`FlightReport`](autopilot::vehicle::FlightReport)): steps up to the
/// last one that was carried out in it, and all, of the plan with which the recording begins or of the last mission.
fn steps_done(log: &Log, (from, until): (Duration, Duration), of_plan: usize) -> [usize; 2] {
    let mut done = [0, of_plan];
    for (at, entry) in log.entries.iter().take_while(|(at, _)| *at <= until) {
        match entry {
            // What was done of it then was so in the flight before.
            Entry::Mission(mission) if *at <= from => done[1] = mission.steps.len(),
            Entry::Progress(progress) if *at > from => {
                done = [progress.steps_done, progress.steps];
            }
            // What follows is for the next flight.
            Entry::Outcome { .. } if *at > from => break,
            _ => {}
        }
    }
    done
}

/// The commands of a plan, numbered like the mission's steps.
fn steps(plan: &str) -> Vec<String> {
    let (plan, _) = autopilot::plan::Plan::review(plan, &autopilot::plan::FlightLimits::NONE);
    plan.map_or_else(Vec::new, |plan| plan.steps().iter().map(|step| label(&step.text)).collect())
}

/// What the vehicle was doing. A drone with its motors cut neither stands by nor lands.
fn phase(row: &Row<'_>) -> String {
    let state = row.state.unwrap_or_default();
    if state.contains(DroneState::EMERGENCY) {
        return "emergency".to_owned();
    }
    label(&row.tick.phase)
}

/// Shortens a text to one line.
fn label(text: &str) -> String {
    let short: String = text.chars().take(LONGEST_LABEL).collect();
    printable(&short).into_owned()
}

fn step_text(steps: &[String], step: usize) -> String {
    let text = steps.get(step).map_or("", String::as_str);
    format!("{}: {text}", step + 1)
}
