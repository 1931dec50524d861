//! Flight plans in `tum_ardrone`'s script language.
//!
//! One command per line; `#` and `//` start comments. Lengths are in metres, angles in degrees, times in
//! seconds. x is right, y forward, z up along the axes of the world, whatever the drone's heading is; yaw is clockwise.
//! Coordinates are relative to the reference, until `setReference` moves it: across the place where the first take-off
//! ended, or the origin of the world if tags are in use or [`FlightLimits::start`] is given; upwards the [`ZOrigin`].
//!
//! ```
//! let plan = autopilot::Plan::parse("square.txt", "takeoff\ngoto 0 1 0 0\nland\n")?;
//! assert_eq!(plan.steps().len(), 3);
//! # Ok::<(), autopilot::plan::PlanError>(())
//! ```

mod check;
mod commands;
mod dry_run;
mod expectation;
mod interpreter;
mod language;
mod parser;
mod tags;
mod warnings;
mod writer;

use diagnostic::{Diagnostic, Severity};
use estimator::SurveyedTag;
use kinematics::Pose;

pub use crate::fence::{Border, BorderError, FlightLimits, MAX_CORNERS, Shape, ZOrigin};
pub use commands::Commands;
pub use diagnostic::Figures;
pub(crate) use dry_run::DryRun;
pub(crate) use expectation::expected_time;
pub use expectation::{Expectation, battery_percent, expectations};
pub(crate) use interpreter::Interpreter;
pub use interpreter::{AgentOrder, Target};
pub use language::{Declaration, LANGUAGE, Number, VERSION};
pub use tags::{LOOK_AROUND_M, TagUse, given_tag_warnings};

/// A flight plan without errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    name: String,
    text: String,
    steps: Vec<Step>,
    tags: Vec<SurveyedTag>,
    notes: Vec<String>,
}

/// One command of a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// What to do.
    pub command: Command,
    /// Line in the plan, from 1; 0 for an implied step.
    pub line: usize,
    /// The command as written.
    pub text: String,
}

/// A command with its arguments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Command {
    /// `takeoff`, `autoInit`, `autoTakeover`: take off.
    TakeOff {
        /// Whether the drone may already be in the air.
        take_over: bool,
    },
    /// `land`
    Land,
    /// `findTag`: look for a tag on the floor.
    FindTag,
    /// `landOnTag`: land on the nearest tag.
    LandOnTag,
    /// `goto x y z yaw`: to a pose relative to the reference.
    GoTo(Pose),
    /// `moveBy x y z yaw`: from the current target.
    MoveBy(Pose),
    /// `moveByRel x y z yaw`: from the drone's pose, along the axes of the world.
    MoveByRelative(Pose),
    /// `hold seconds`: stay at the last target.
    Hold {
        /// Seconds.
        time_s: f64,
    },
    /// `setReference x y z yaw`: relative to where the reference is before any `setReference`.
    SetReference(Pose),
    /// `setReference $POSE$`: at the drone's pose.
    SetReferenceHere,
    /// `setReference $START$`: where the flight began, on the floor.
    SetReferenceStart,
    /// `setInitialReachDist`: a target is reached within this distance.
    SetReachDistance {
        /// Metres.
        distance_m: f64,
    },
    /// `setStayWithinDist`: largest distance from the target during the stay.
    SetStayDistance {
        /// Metres.
        distance_m: f64,
    },
    /// `setStayTime`: stay time at a target.
    SetStayTime {
        /// Seconds.
        time_s: f64,
    },
    /// `setSpeed`: limit of the horizontal speed.
    SetSpeed {
        /// Metres per second.
        speed_m_s: f64,
    },
    /// `setMaxControl`: limit of the sticks.
    SetMaxControl {
        /// Fraction in (0, 1].
        fraction: f64,
    },
}

/// The number of a mission, given by whoever made it of commands: by that they know it again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MissionId(pub u32);

impl Command {
    /// Whether it only changes how later commands are flown.
    pub fn is_setting(self) -> bool {
        self.concerns_targets() == Some(false) || matches!(self, Self::SetMaxControl { .. })
    }

    /// What it is to targets: `Some(true)` if the drone flies to some place by it, as the settings say, and `Some(false)` if
    /// it is such a setting.
    pub(crate) fn concerns_targets(self) -> Option<bool> {
        match self {
            Self::GoTo(_)
            | Self::MoveBy(_)
            | Self::MoveByRelative(_)
            | Self::Hold { .. }
            | Self::FindTag
            | Self::LandOnTag => Some(true),
            Self::SetReference(_)
            | Self::SetReferenceHere
            | Self::SetReferenceStart
            | Self::SetReachDistance { .. }
            | Self::SetStayDistance { .. }
            | Self::SetStayTime { .. }
            | Self::SetSpeed { .. } => Some(false),
            // The limit of the sticks also applies to holding the position.
            Self::TakeOff { .. } | Self::Land | Self::SetMaxControl { .. } => None,
        }
    }
}

/// Why a plan cannot be flown: all problems with file, line, column and advice.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{rendered}")]
pub struct PlanError {
    rendered: String,
}

impl PlanError {
    fn new(name: &str, text: &str, diagnostics: &[Diagnostic]) -> Self {
        Self { rendered: diagnostic::render_all(diagnostics, &diagnostic::Source { name, text }) }
    }
}

impl Plan {
    /// Parses a plan and checks it against the default fence; `name` is the file name for messages.
    ///
    /// # Errors
    /// [`PlanError`] with all problems.
    pub fn parse(name: &str, text: &str) -> Result<Self, PlanError> {
        Self::parse_within(name, text, &FlightLimits::default())
    }

    /// Parses a plan and refuses targets outside `limits`.
    ///
    /// # Errors
    /// [`PlanError`] with all problems.
    pub fn parse_within(name: &str, text: &str, limits: &FlightLimits) -> Result<Self, PlanError> {
        Self::parse_with_tags(name, text, limits, TagUse::Unknown)
    }

    /// As [`Plan::parse_within`], for a flight that uses tags, or does not: refuses tags for which there is no
    /// room besides the given ones.
    ///
    /// # Errors
    /// [`PlanError`] with all problems.
    pub fn parse_with_tags(
        name: &str,
        text: &str,
        limits: &FlightLimits,
        tags: TagUse<'_>,
    ) -> Result<Self, PlanError> {
        let (plan, mut diagnostics) = Self::review_with_tags(text, limits, tags);
        let Some(mut plan) = plan.map(|plan| Self { name: name.to_owned(), ..plan }) else {
            diagnostics.retain(|diagnostic| diagnostic.severity == Severity::Error);
            return Err(PlanError::new(name, text, &diagnostics));
        };
        let warnings = match diagnostics.len() {
            0 => return Ok(plan),
            1 => "is a warning".to_owned(),
            several => format!("are {several} warnings"),
        };
        plan.notes.push(format!("there {warnings}: run `ardrone-pilot check {name}`"));
        Ok(plan)
    }

    /// Parses a plan, refuses targets outside `limits`, and warns of what is legal but unwise. The plan is
    /// `Some` iff no finding is an error.
    pub fn review(text: &str, limits: &FlightLimits) -> (Option<Self>, Vec<Diagnostic>) {
        Self::review_with_tags(text, limits, TagUse::Unknown)
    }

    /// As [`Plan::review`], for a flight that uses tags, or does not.
    pub fn review_with_tags(
        text: &str,
        limits: &FlightLimits,
        tags: TagUse<'_>,
    ) -> (Option<Self>, Vec<Diagnostic>) {
        let (lines, mut diagnostics) = parser::parse(text);
        let mut notes: Vec<String> = lines.iter().filter_map(parser::note).collect();
        let mut lines = parser::clear_commands(lines);
        if let Some(first) = diagnostics.first() {
            // Behind a line that cannot be parsed, the places of the others are unknown.
            lines.retain(|line| line.span.start < first.span.start);
            diagnostics.extend(check::check_places(&lines, limits));
        } else {
            diagnostics = check::check(&lines, text, limits);
        }
        diagnostics.extend(warnings::warnings(&lines, limits));
        diagnostics.extend(tags::findings(&lines, limits, tags));
        if diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
            return (None, diagnostics);
        }
        let tags = lines.iter().filter_map(|line| line.tag).collect();
        let mut steps: Vec<Step> = lines.into_iter().filter_map(parser::Line::into_step).collect();
        if steps
            .last()
            .is_some_and(|step| !matches!(step.command, Command::Land | Command::LandOnTag))
        {
            notes.push("the plan does not end with `land`: the drone will land".to_owned());
            steps.push(Step { command: Command::Land, line: 0, text: "land".to_owned() });
        }
        let (name, text) = (String::new(), text.to_owned());
        (Some(Self { name, text, steps, tags, notes }), diagnostics)
    }

    /// The name given to [`Plan::parse`]; empty from [`Plan::review`].
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The parsed text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The commands in order.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The tags that it declares, in the world.
    pub fn tags(&self) -> &[SurveyedTag] {
        &self.tags
    }

    /// Whether it needs tags: it declares some, looks for one or lands on one.
    pub fn uses_tags(&self) -> bool {
        let needs = |step: &Step| matches!(step.command, Command::FindTag | Command::LandOnTag);
        !self.tags.is_empty() || self.steps.iter().any(needs)
    }

    /// Notes for the operator before the flight.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Whether the plan may start with a drone that is already in the air.
    pub fn takes_over(&self) -> bool {
        takes_over(&self.steps)
    }

    pub(crate) fn into_steps(self) -> Vec<Step> {
        self.steps
    }
}

impl Step {
    /// Whether it is a landing that the plan implies but does not contain.
    pub(crate) fn is_implied(&self) -> bool {
        self.line == 0 && self.command == Command::Land
    }
}

/// Whether the first take-off may take over a drone in the air.
pub(crate) fn takes_over(steps: &[Step]) -> bool {
    let first = steps.iter().find_map(|step| {
        let Command::TakeOff { take_over } = step.command else { return None };
        Some(take_over)
    });
    first.unwrap_or(false)
}

#[cfg(test)]
mod tests;
