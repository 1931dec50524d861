//! Replays a recorded flight: the same inputs at the same times, decided by today's code.
//!
//! The recorded inputs do not depend on the new decisions. Up to the first difference the comparison is
//! therefore exact; after it, it shows what today's code would do in the recorded situations.

use std::fmt;
use std::time::Duration;

use ardrone_link::settings::SettingError;
use autopilot::outcome::Outcome;
use autopilot::plan::{Plan, PlanError};
use autopilot::vehicle::{CannotFly, Input, Output, Transmit, Vehicle};
use diagnostic::printable;

use crate::recording::{Entry, Log, Tick, Timing};
use crate::settings::{Settings, SettingsError};

/// Why a log cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// Its settings are invalid in this version.
    #[error("the log's settings are not valid in this version")]
    Settings(#[from] SettingsError),
    /// Its plan, or one that was loaded, is invalid in this version.
    #[error("a plan of the log is not valid in this version")]
    Plan(#[from] PlanError),
    /// Its limits cannot be encoded as drone settings.
    #[error(transparent)]
    Config(#[from] SettingError),
    /// Its plan does not fit its settings in this version.
    #[error(transparent)]
    CannotFly(#[from] CannotFly),
    /// The log contains no ticks.
    #[error("the log contains no ticks: no drone answered")]
    Empty,
}

/// Comparison of a recorded flight with its replay.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// Ticks that were compared.
    pub ticks: usize,
    /// Ticks with identical datagrams.
    pub same_datagrams: usize,
    /// Ticks in which the agent chose other plans.
    pub other_plans: usize,
    /// Largest difference of a stick, as a fraction of its limit.
    pub largest_stick_difference: f64,
    /// Ticks at which the decisions begin to differ, at most [`Replay::MOST`].
    pub differences: Vec<Difference>,
    /// Outcome of the replayed flight, if it ends.
    pub outcome: Option<Outcome>,
}

/// A tick in which the decision begins to differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Its time.
    pub at: Duration,
    /// The recorded decision.
    pub then: String,
    /// Today's decision.
    pub now: String,
}

/// Sticks that differ by less than this count as equal.
const SAME_STICK: f64 = 0.01;

impl Replay {
    /// Maximum number of differences kept.
    pub const MOST: usize = 20;

    /// Whether all datagrams are identical.
    pub fn is_same(&self) -> bool {
        self.same_datagrams == self.ticks
    }

    /// Replays a log.
    ///
    /// # Errors
    /// [`ReplayError`] if its plan or settings are invalid in this version, or it is empty.
    pub fn new(log: &Log) -> Result<Self, ReplayError> {
        let config = Settings::parse("pilot.toml", &log.settings)?.pilot_config(log.z_origin);
        // A log without a plan belongs to a vehicle that got its missions by orders.
        let mut vehicle = if log.plan.is_empty() {
            Vehicle::new(&config)?
        } else {
            let plan = Plan::parse_within(&log.plan_name, &log.plan, &config.limits)?;
            Vehicle::flying(plan, &config)?
        };
        let mut replay = Self {
            ticks: 0,
            same_datagrams: 0,
            other_plans: 0,
            largest_stick_difference: 0.0,
            differences: Vec::new(),
            outcome: None,
        };
        let mut parted = false;
        for (at, entry) in &log.entries {
            match entry {
                // What was refused is refused again.
                Entry::Navdata(packet) => _ = vehicle.handle(*at, Input::Navdata(packet)),
                Entry::Control(bytes) => _ = vehicle.handle(*at, Input::Control(bytes)),
                Entry::Order(order) => {
                    let (by, order) = order.as_ref().clone().given(&config.limits)?;
                    _ = vehicle.handle(*at, Input::Order(by, order));
                }
                Entry::Neighbour(neighbour) => {
                    _ = vehicle.handle(*at, Input::Neighbour(neighbour.heard()));
                }
                Entry::Decoded(_)
                | Entry::Tags(_)
                | Entry::Message(_)
                | Entry::Mission(_)
                | Entry::Progress(_)
                | Entry::Event { .. }
                | Entry::Outcome { .. } => {}
                Entry::Tick(recorded) => {
                    _ = vehicle.handle(*at, Input::Tick);
                    while let Some(output) = vehicle.poll() {
                        if let Output::Transmit(Transmit::Command {
                            datagram,
                            decision: Some(decision),
                        }) = output
                        {
                            let today = Tick::new(decision, Timing::default(), datagram);
                            parted = replay.compare(*at, recorded, &today, parted);
                        }
                    }
                }
            }
        }
        replay.outcome = vehicle.outcome().cloned();
        if replay.ticks == 0 { Err(ReplayError::Empty) } else { Ok(replay) }
    }

    /// Compares a tick; returns whether it differs.
    fn compare(&mut self, at: Duration, then: &Tick, now: &Tick, parted: bool) -> bool {
        self.ticks += 1;
        self.same_datagrams += usize::from(then.datagram == now.datagram);
        let names = |tick: &Tick| -> Vec<String> {
            tick.agent.plans.iter().map(|plan| printable(&plan.trigger).into_owned()).collect()
        };
        let other_plans = names(then) != names(now) || then.agent.command != now.agent.command;
        self.other_plans += usize::from(other_plans);
        let sticks = |tick: &Tick| {
            let command = &tick.command;
            [command.roll, command.pitch, command.gaz, command.yaw]
        };
        let pairs = sticks(then).into_iter().zip(sticks(now));
        let apart = pairs.map(|(then, now)| (then - now).abs()).fold(0.0, f64::max);
        self.largest_stick_difference = self.largest_stick_difference.max(apart);
        let differs =
            other_plans || then.command.flight != now.command.flight || apart > SAME_STICK;
        if differs && !parted && self.differences.len() < Self::MOST {
            let text = |tick: &Tick| {
                let [roll, pitch, gaz, yaw] = sticks(tick);
                format!(
                    "{} by {}; {}, sticks {roll:+.2} {pitch:+.2} {gaz:+.2} {yaw:+.2}",
                    printable(&tick.agent.command),
                    names(tick).join(" "),
                    printable(&tick.command.flight)
                )
            };
            self.differences.push(Difference { at, then: text(then), now: text(now) });
        }
        differs
    }
}

impl fmt::Display for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { ticks, same_datagrams, other_plans, largest_stick_difference, .. } = self;
        if self.is_same() {
            return writeln!(f, "the same in all {ticks} ticks, byte for byte");
        }
        writeln!(f, "{same_datagrams} of {ticks} datagrams are the same")?;
        writeln!(f, "  other plans in {other_plans} ticks")?;
        writeln!(f, "  sticks differ by at most {largest_stick_difference:.3}")?;
        for Difference { at, then, now } in &self.differences {
            writeln!(f, "{:8.2} s then: {then}", at.as_secs_f64())?;
            writeln!(f, "{:8}   now:  {now}", "")?;
        }
        if self.differences.len() == Self::MOST {
            writeln!(f, "... and perhaps more")?;
        }
        Ok(())
    }
}
