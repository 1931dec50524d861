//! `ardrone-pilot check FLEET.toml`: what becomes of a fleet in simulated time, each vehicle alone and all together.

use std::ffi::OsStr;
use std::fmt;
use std::path::Path;
use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::Start;
use serde_json::{Value, json};

use super::arguments::CheckPlan;
use super::check::write_drawing;
use super::fleet::own_drones;
use super::{CommandError, terminal};
use crate::fleet::{self, Fleet, Meeting, Member, SimulatedFleet, SimulatedMember};
use crate::{fleet_drawing, json};

/// Whether a file is that of a fleet, by its name.
pub(super) fn is_fleet(path: &Path) -> bool {
    path.extension() == Some(OsStr::new("toml"))
}

/// Checks a fleet, prints the findings, and draws its ways if asked to. The exit status is 20 if a vehicle cannot begin.
pub(super) fn run(arguments: &CheckPlan) -> Result<u8, CommandError> {
    let name = arguments.plan.display().to_string();
    if arguments.config.is_some() || arguments.tags || !arguments.tag.is_empty() {
        return Err(CommandError::OfPlans);
    }
    let fleet = Fleet::read(&arguments.plan, arguments.z_origin.into())?;
    let simulated = fleet::fly(&fleet)?;
    let report = Report { name: &name, fleet: &fleet, simulated: &simulated };
    if arguments.json {
        terminal::print(json::text_in_lines(&report.json()) + "\n");
    } else {
        terminal::print(&report);
    }
    if let Some(path) = &arguments.svg {
        write_drawing(path, &fleet_drawing::svg(&name, &fleet, &simulated)?)?;
    }
    Ok(if report.grounded().next().is_some() { 20 } else { 0 })
}

/// A checked fleet.
struct Report<'a> {
    name: &'a str,
    fleet: &'a Fleet,
    simulated: &'a SimulatedFleet,
}

impl Report<'_> {
    fn member(&self, number: usize) -> &Member {
        &self.fleet.members[number]
    }

    /// Those who would come nearer to each other than they may, or of whom that is not known.
    fn conflicts(&self) -> impl Iterator<Item = &Meeting> {
        let separation_m = |meeting: &Meeting| self.member(meeting.who[0]).config.separation_m;
        let would_meet =
            move |it: &&Meeting| it.alone.is_none_or(|(alone_m, _)| alone_m < separation_m(it));
        self.simulated.meetings.iter().filter(would_meet)
    }

    /// Those that do not fly their plans to the end with the others.
    fn short(&self) -> impl Iterator<Item = &SimulatedMember> {
        self.simulated.members.iter().filter(|member| !is_flown(member.outcome.as_ref()))
    }

    /// Those that cannot begin, whatever the others do.
    fn grounded(&self) -> impl Iterator<Item = &SimulatedMember> {
        let is_refused =
            |it: &&SimulatedMember| matches!(it.outcome, Some(Outcome::PreflightRefused { .. }));
        self.simulated.members.iter().filter(is_refused)
    }

    fn mission_of(&self, member: &SimulatedMember) -> &'static str {
        if self.member(member.number).plan.is_some() { "plan" } else { "mission" }
    }

    fn json(&self) -> Value {
        let members: Vec<Value> = self.simulated.members.iter().map(|it| self.one(it)).collect();
        let name = |number: usize| self.member(number).config.name;
        let conflicts = self.conflicts().map(|it| {
            json!({
                "vehicles": it.who.map(name),
                "at_s": it.alone.map(|(_, at)| at.as_secs_f64()),
                "planned_m": it.alone.map(|(alone_m, _)| alone_m),
                "kept_apart_m": finite(it.together_m),
            })
        });
        let warnings: Vec<Value> = (self.fleet.warnings.located())
            .map(|it| {
                let (line, column) = it.start();
                let (message, help) = (&it.diagnostic.message, &it.diagnostic.help);
                json!({ "severity": "warning", "line": line, "column": column, "message": message, "help": help })
            })
            .collect();
        json!({
            "fleet": self.name,
            "vehicles": members,
            "conflicts": conflicts.collect::<Vec<_>>(),
            "problems": warnings,
        })
    }

    fn one(&self, simulated: &SimulatedMember) -> Value {
        let config = &self.member(simulated.number).config;
        let Start { place_m, heading_deg, .. } = config.estimator.start.unwrap_or_default();
        json!({
            "vehicle": config.name,
            "system": config.system,
            "start": [place_m.x, place_m.y, heading_deg],
            "alone_s": simulated.alone.as_ref().map(|alone| alone.duration.as_secs_f64()),
            "battery_percent": simulated.alone.as_ref().map(|alone| alone.battery_percent),
            "together_s": simulated.duration.as_secs_f64(),
            "messages": simulated.said.iter().map(|(at, said)| json!({
                "t_s": at.as_secs_f64(),
                "to": said.to,
                "text": said.text(),
            })).collect::<Vec<_>>(),
            "outcome": outcome(simulated.outcome.as_ref()),
            "completed": is_flown(simulated.outcome.as_ref()),
        })
    }
}

fn or_dash(text: Option<String>) -> String {
    text.unwrap_or_else(|| "-".to_owned())
}

fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}

fn is_flown(outcome: Option<&Outcome>) -> bool {
    outcome.is_some_and(|outcome| outcome.exit_status() == 0)
}

fn outcome(outcome: Option<&Outcome>) -> String {
    outcome.map_or("it did not end within 20 minutes".to_owned(), ToString::to_string)
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

impl fmt::Display for Report<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "vehicle           {:>7} {:>7} {:>7}  {:>8} {:>8}  {:>8}",
            "right", "forward", "heading", "alone", "battery", "together"
        )?;
        for member in &self.simulated.members {
            let (config, alone) = (&self.member(member.number).config, member.alone.as_ref());
            let Start { place_m, heading_deg, .. } = config.estimator.start.unwrap_or_default();
            writeln!(
                f,
                "{:<16}  {:>7.2} {:>7.2} {heading_deg:>6.0}°  {:>8} {:>8}  {:>8}",
                config.name.as_str(),
                place_m.x,
                place_m.y,
                or_dash(alone.map(|alone| seconds(alone.duration))),
                or_dash(alone.map(|alone| format!("{:.1} %", alone.battery_percent))),
                seconds(member.duration),
            )?;
        }
        writeln!(f, "\nstarts in metres; time in the air, each alone and all together\n")?;
        if !self.fleet.warnings.is_empty() {
            writeln!(f, "{}\n", self.fleet.warnings)?;
        }
        for meeting in self.conflicts() {
            let [a, b] = meeting.who.map(|number| self.member(number).config.name);
            let together = match finite(meeting.together_m) {
                Some(together_m) => format!("never nearer than {together_m:.2} m"),
                None => "never in the air at the same time".to_owned(),
            };
            match meeting.alone {
                Some((alone_m, at)) => writeln!(
                    f,
                    "{a} and {b}: {alone_m:.2} m from each other at {} as planned; kept apart, {together}",
                    seconds(at)
                )?,
                None => writeln!(f, "{a} and {b}: {together}")?,
            }
        }
        for member in self.short() {
            let name = self.member(member.number).config.name;
            let alone = member.alone.as_ref();
            let with_others = alone.is_some_and(|alone| is_flown(alone.outcome.as_ref()));
            let how = if with_others { " with the others" } else { "" };
            let outcome = outcome(member.outcome.as_ref());
            writeln!(
                f,
                "{name}: does not fly its {} to the end{how}: {outcome}",
                self.mission_of(member)
            )?;
        }
        if let Err(shared) = own_drones(&self.fleet.members.iter()) {
            writeln!(f, "only with simulated drones, or on different machines: {shared}")?;
        }
        let verdict = match self.short().count() {
            _ if self.grounded().next().is_some() => match self.grounded().count() {
                1 => "cannot be flown: one vehicle cannot begin".to_owned(),
                grounded => format!("cannot be flown: {grounded} vehicles cannot begin"),
            },
            0 => "can be flown".to_owned(),
            1 => "can be flown, but one vehicle not to the end of its plan".to_owned(),
            short => format!("can be flown, but {short} vehicles not to the ends of their plans"),
        };
        writeln!(f, "{} {verdict}", self.name)
    }
}
