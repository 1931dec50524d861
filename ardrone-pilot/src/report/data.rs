//! Data of a report, extracted from a log.

use std::collections::BTreeMap;

use autopilot::agent::plan_text;
use diagnostic::{printable, printable_lines};
use serde::Serialize;

use crate::recording::{Log, Tags, Tick};

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
    /// Seconds since the start, and the tick.
    pub(super) ticks: Vec<(f64, &'a Tick)>,
    /// Sections of the flight for the background of plots.
    pub(super) bands: Vec<Band>,
    /// Decisions of the agent; consecutive equal ones are merged.
    pub(super) decisions: Vec<Decision>,
    /// Source text of the chosen plans, by line.
    pub(super) plans: BTreeMap<u32, String>,
    /// Seconds, whether it is a warning, and text.
    pub(super) events: Vec<(f64, bool, &'a str)>,
    /// Seconds, and the tags that were known then.
    pub(super) tags: Vec<(f64, &'a Tags)>,
    /// Time of the last tick.
    pub(super) end_s: f64,
}

/// A section of the flight, drawn as background of plots.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Band {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// The plan step, or the phase.
    pub(super) label: String,
    pub(super) kind: BandKind,
}

/// Colour of a band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BandKind {
    /// On the ground, before or after the flight.
    Ground,
    /// A step of the plan; even and odd ones have different colours.
    Step(usize),
    /// In the air without a step: paused, manual control, or landing early.
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
    pub(super) fn new(log: &'a Log) -> Option<Self> {
        let ticks: Vec<(f64, &Tick)> =
            log.ticks().map(|(at, tick)| (at.as_secs_f64(), tick)).collect();
        let end_s = ticks.last()?.0;
        let mut missions = log.missions().peekable();
        let mut steps = steps(&log.plan);
        let mut flight = Self {
            bands: Vec::new(),
            decisions: Vec::new(),
            plans: BTreeMap::new(),
            events: Vec::new(),
            tags: Vec::new(),
            end_s,
            ticks,
        };
        for index in 0..flight.ticks.len() {
            let (at_s, tick) = flight.ticks[index];
            let until_s = flight.ticks.get(index + 1).map_or(at_s, |(next_s, _)| *next_s);
            while let Some((_, mission)) = missions.next_if(|(at, _)| at.as_secs_f64() <= at_s) {
                steps = mission.steps.iter().map(|step| label(step)).collect();
            }
            flight.extend_band(at_s, until_s, tick, &steps);
            flight.extend_decision(at_s, until_s, tick, &steps);
            flight.extend_plans(tick, &log.agent);
        }
        let events = log.events().map(|(at, warns, text)| (at.as_secs_f64(), warns, text));
        flight.events = events.collect();
        let tags = || log.tags().map(|(at, tags)| (at.as_secs_f64(), tags));
        let every = tags().count().div_ceil(MOST_TAG_MOMENTS).max(1);
        // The last one is always among them.
        let skipped = tags().count().saturating_sub(1) % every;
        flight.tags = tags().skip(skipped).step_by(every).collect();
        Some(flight)
    }

    fn extend_band(&mut self, at_s: f64, until_s: f64, tick: &Tick, steps: &[String]) {
        let (label, kind) = match tick.step {
            Some(step) => (step_text(steps, step), BandKind::Step(step)),
            None if tick.agent.on_ground => (label(&tick.phase), BandKind::Ground),
            None => (label(&tick.phase), BandKind::Other),
        };
        match self.bands.last_mut() {
            Some(band) if band.kind == kind && band.label == label => band.to_s = until_s,
            _ => self.bands.push(Band { from_s: at_s, to_s: until_s, label, kind }),
        }
    }

    fn extend_decision(&mut self, at_s: f64, until_s: f64, tick: &Tick, steps: &[String]) {
        let Tick { agent, veto, .. } = tick;
        let danger = agent.danger.iter().map(|danger| format!("danger: {}", label(danger)));
        let veto = veto.iter().map(|veto| format!("safety monitor: {}", label(veto)));
        let plans = agent.plans.iter().map(|plan| (label(&plan.trigger), plan.line));
        let step = tick.step.map_or_else(|| label(&tick.phase), |step| step_text(steps, step));
        let decision = Decision {
            from_s: at_s,
            to_s: until_s,
            step,
            command: label(&agent.command),
            plans: plans.collect(),
            said: agent.report.as_ref().map(|report| format!("last order: {}", label(report))),
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

    /// Duration in the air, in seconds.
    pub(super) fn flown_s(&self) -> f64 {
        let airborne = |(_, tick): &&(f64, &Tick)| !tick.agent.on_ground;
        let first = self.ticks.iter().find(airborne).map(|(at_s, _)| *at_s);
        let last = self.ticks.iter().rfind(airborne).map(|(at_s, _)| *at_s);
        first.zip(last).map_or(0.0, |(first, last)| last - first)
    }

    /// Charge at the beginning and at the end, in percent.
    pub(super) fn battery_percent(&self) -> Option<(u32, u32)> {
        let charge = |(_, tick): &(f64, &Tick)| tick.agent.battery_percent;
        Some((self.ticks.iter().find_map(charge)?, self.ticks.iter().rev().find_map(charge)?))
    }

    /// Lateness of all ticks, sorted, in ms.
    pub(super) fn lateness_ms(&self) -> Vec<f64> {
        let mut late: Vec<f64> = self.ticks.iter().map(|(_, tick)| tick.timing.late_ms).collect();
        late.sort_by(f64::total_cmp);
        late
    }
}

impl Decision {
    fn is_like(&self, other: &Self) -> bool {
        (&self.step, &self.command, &self.plans, &self.said, &self.warnings)
            == (&other.step, &other.command, &other.plans, &other.said, &other.warnings)
    }
}

/// The commands of a plan, numbered like the mission's steps.
fn steps(plan: &str) -> Vec<String> {
    let (plan, _) = autopilot::plan::Plan::review(plan, &autopilot::plan::FlightLimits::NONE);
    plan.map_or_else(Vec::new, |plan| plan.steps().iter().map(|step| label(&step.text)).collect())
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
