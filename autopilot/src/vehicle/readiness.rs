//! The pre-flight check: every reason not to fly, at once.

use std::fmt;
use std::time::Duration;

use super::{Authority, ControlState, DroneState, FlightEvent, FlightPhase, Pilot, Trust};
use crate::agent::LANDING_BATTERY_PERCENT;
use crate::plan;

/// Below this the drone may refuse to take off.
const LEAST_BATTERY_PERCENT: u32 = 20;
/// Navdata older than this are no basis for taking off.
const OLDEST_NAVDATA: Duration = Duration::from_millis(500);
/// The drone sends 15 packets a second, or 200. A third of them may be lost.
const LEAST_NAVDATA_HZ: f64 = 5.0;
/// A drone that leans more than this does not stand on level ground, or its sensors are wrong.
const LARGEST_LEAN_DEG: f64 = 8.0;

/// A drone that stands on the floor reads about zero.
const HIGHEST_ON_GROUND_M: f64 = 0.6;
/// What the drone says of itself that forbids to fly it.
const FAULTS: [(DroneState, &str); 6] = [
    (DroneState::MOTORS_PROBLEM, "a motor is blocked or broken"),
    (DroneState::SOFTWARE_FAULT, "the drone reports a software fault"),
    (DroneState::ANGLES_OUT_OF_RANGE, "the drone reports that it leans too far"),
    (DroneState::CUTOUT_DETECTED, "the drone reports a motor cut-out"),
    (DroneState::ULTRASOUND_DEAF, "the drone reports that its ultrasound hears nothing"),
    (DroneState::TOO_MUCH_WIND, "the drone reports too much wind"),
];

/// A reason not to take off.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Refusal {
    Emergency,
    Drone(&'static str),
    Silent,
    OldNavdata { age: Duration },
    FewNavdata { hz: f64 },
    Distrust(Trust),
    NotOnFloor { altitude_m: f64 },
    Leaning { deg: f64 },
    EmptyBattery { percent: u32 },
    ShortBattery { percent: u32, flight: Duration, needed: f64 },
    NotLanded,
    Settings(String),
    SettingsNotRead,
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
            Self::Distrust(trust) => write!(f, "{trust}: restart the drone"),
            Self::NotOnFloor { altitude_m } => write!(
                f,
                "the drone reads an altitude of {altitude_m:.1} m although it has landed: restart it"
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
            Self::SettingsNotRead => f.write_str(
                "the drone's settings could not be read back over its control port: restart the \
                 drone, or set `read_back = false` to fly on its acknowledgements alone",
            ),
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
        refusals.extend(self.problems_of_the_sensors(now));
        if !self.on_ground() && !self.mission.takes_over() {
            refusals.push(Refusal::NotLanded);
        }
        if !self.report.unconfirmed_settings.is_empty() {
            refusals.push(Refusal::Settings(self.report.unconfirmed_settings.join(", ")));
        }
        if self.report.settings_not_read {
            refusals.push(Refusal::SettingsNotRead);
        }
        if refusals.is_empty() {
            self.phase = FlightPhase::Flying;
        } else {
            self.refuse(now, refusals.iter().map(ToString::to_string).collect());
        }
    }

    /// Decides about a drone that was found in the air, by what it says unasked: one that has lost its
    /// pilot says nothing but its state until it is configured.
    pub(super) fn take_over_or_refuse(&mut self, now: Duration, watched: Duration, packets: u64) {
        let mut refusals = self.problems_of_the_drone();
        if self.demo().is_some() {
            refusals.extend(self.problems_of_the_battery());
            refusals.extend(self.problems_of_the_sensors(now));
        }
        let link = self.problems_of_the_link(now, watched, packets);
        refusals.extend(link.filter(|refusal| *refusal != Refusal::Silent));
        if !self.mission.takes_over() {
            refusals.push(Refusal::NotLanded);
        }
        if refusals.is_empty() {
            self.events.push_back(FlightEvent::TakingOver);
            self.begin_to_configure(now, Authority::TakenOver);
        } else {
            self.refuse(now, refusals.iter().map(ToString::to_string).collect());
        }
    }

    /// The fault that the drone reports of itself, if there is one.
    pub(super) fn reported_fault(&self) -> Option<&'static str> {
        let state = self.drone_state();
        FAULTS.iter().find(|(bit, _)| state.contains(*bit)).map(|(_, fault)| *fault)
    }

    /// Navdata that cannot be believed lift no drone.
    fn problems_of_the_sensors(&self, now: Duration) -> Option<Refusal> {
        let demo = self.demo()?;
        let trust = self.estimator.trust();
        let heard = self.session.silence(now).is_some_and(|age| age <= OLDEST_NAVDATA);
        let old = heard && self.blind_for(now) > OLDEST_NAVDATA;
        if trust != Trust::Sound {
            Some(Refusal::Distrust(trust))
        } else if old {
            Some(Refusal::OldNavdata { age: self.blind_for(now) })
        } else if self.on_ground() && demo.altitude_m.abs() > HIGHEST_ON_GROUND_M {
            Some(Refusal::NotOnFloor { altitude_m: demo.altitude_m })
        } else {
            None
        }
    }

    fn problems_of_the_drone(&self) -> Vec<Refusal> {
        let state = self.drone_state();
        let mut refusals = Vec::new();
        if state.contains(DroneState::EMERGENCY) {
            refusals.push(Refusal::Emergency);
        }
        let faults = FAULTS.iter().filter(|(bit, _)| state.contains(*bit));
        refusals.extend(faults.map(|(_, problem)| Refusal::Drone(problem)));
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
