//! The pre-flight check: every reason not to fly, at once.

use std::fmt;
use std::time::Duration;

use super::{ControlState, DroneState, FlightPhase, Pilot};
use crate::agent::LANDING_BATTERY_PERCENT;
use crate::outcome::Outcome;
use crate::plan;

/// Below this the drone may refuse to take off.
const LEAST_BATTERY_PERCENT: u32 = 20;
/// Navdata older than this are no basis for taking off.
const OLDEST_NAVDATA: Duration = Duration::from_millis(500);
/// The drone sends 15 packets a second, or 200. A third of them may be lost.
const LEAST_NAVDATA_HZ: f64 = 5.0;
/// A drone that leans more than this does not stand on level ground, or its sensors are wrong.
const LARGEST_LEAN_DEG: f64 = 8.0;

/// A reason not to take off.
#[derive(Debug, Clone, PartialEq)]
enum Refusal {
    Emergency,
    Drone(&'static str),
    Silent,
    OldNavdata { age: Duration },
    FewNavdata { hz: f64 },
    Leaning { deg: f64 },
    EmptyBattery { percent: u32 },
    ShortBattery { percent: u32, flight: Duration, needed: f64 },
    NotLanded,
    Settings(String),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Emergency => f.write_str(
                "the drone is in its emergency state: check it, then clear it with its reset or \
                 battery",
            ),
            Self::Drone(problem) => f.write_str(problem),
            Self::Silent => f.write_str("the drone sends no flight data"),
            Self::OldNavdata { age } => write!(
                f,
                "the newest flight data are {} ms old: go nearer, or to another channel",
                age.as_millis()
            ),
            Self::FewNavdata { hz } => write!(
                f,
                "only {hz:.0} packets of flight data a second: at least {LEAST_NAVDATA_HZ:.0} are \
                 needed; go nearer, or to another channel"
            ),
            Self::Leaning { deg } => {
                write!(f, "the drone leans by {deg:.0}°: put it on level ground")
            }
            Self::EmptyBattery { percent } => {
                write!(f, "battery at {percent} %: more than {LEAST_BATTERY_PERCENT} % are needed")
            }
            Self::ShortBattery { percent, flight, needed } => write!(
                f,
                "battery at {percent} %: the plan takes about {} s, for which {needed:.0} % are \
                 needed",
                flight.as_secs()
            ),
            Self::NotLanded => f.write_str(
                "the drone is not landed: land it first, or begin the plan with `autoTakeover`",
            ),
            Self::Settings(keys) => write!(f, "the drone has not taken its settings: {keys}"),
        }
    }
}

impl Pilot {
    /// Begins the flight, or says why not. The drone has been watched for `watched`, in which so many
    /// packets came.
    pub(super) fn take_off_or_refuse(&mut self, now: Duration, watched: Duration, packets: u64) {
        let mut refusals = self.problems_of_the_drone();
        refusals.extend(self.problems_of_the_link(now, watched, packets));
        refusals.extend(self.problems_of_the_battery());
        if !self.on_ground() && !self.mission.takes_over() {
            refusals.push(Refusal::NotLanded);
        }
        if !self.report.unconfirmed_settings.is_empty() {
            refusals.push(Refusal::Settings(self.report.unconfirmed_settings.join(", ")));
        }
        if refusals.is_empty() {
            self.phase = FlightPhase::Flying;
        } else {
            let reasons = refusals.iter().map(ToString::to_string).collect();
            self.end(Outcome::PreflightRefused { reasons });
        }
    }

    fn problems_of_the_drone(&self) -> Vec<Refusal> {
        let state = self.drone_state();
        let mut refusals = Vec::new();
        if state.contains(DroneState::EMERGENCY) {
            refusals.push(Refusal::Emergency);
        }
        for (bit, problem) in [
            (DroneState::MOTORS_PROBLEM, "a motor is blocked or broken"),
            (DroneState::SOFTWARE_FAULT, "the drone reports a software fault"),
            (DroneState::ANGLES_OUT_OF_RANGE, "the drone does not stand level"),
            (DroneState::CUTOUT_DETECTED, "the drone reports a motor cut-out"),
        ] {
            if state.contains(bit) {
                refusals.push(Refusal::Drone(problem));
            }
        }
        let landed = |control_state| control_state == ControlState::Landed;
        if let Some(demo) = self.demo().filter(|demo| landed(demo.control_state)) {
            let deg = demo.roll_deg.abs().max(demo.pitch_deg.abs());
            if deg > LARGEST_LEAN_DEG {
                refusals.push(Refusal::Leaning { deg });
            }
        }
        refusals
    }

    fn problems_of_the_link(
        &self,
        now: Duration,
        watched: Duration,
        packets: u64,
    ) -> Option<Refusal> {
        let Some(age) = self.session.silence(now).filter(|_| self.demo().is_some()) else {
            return Some(Refusal::Silent);
        };
        let hz = packets as f64 / watched.as_secs_f64();
        if age > OLDEST_NAVDATA {
            Some(Refusal::OldNavdata { age })
        } else if hz < LEAST_NAVDATA_HZ {
            Some(Refusal::FewNavdata { hz })
        } else {
            None
        }
    }

    fn problems_of_the_battery(&self) -> Option<Refusal> {
        let percent = self.demo()?.battery_percent;
        let needed = f64::from(LANDING_BATTERY_PERCENT) + plan::battery_percent(self.expected_time);
        if percent <= LEAST_BATTERY_PERCENT {
            Some(Refusal::EmptyBattery { percent })
        } else if f64::from(percent) < needed {
            Some(Refusal::ShortBattery { percent, flight: self.expected_time, needed })
        } else {
            None
        }
    }
}
