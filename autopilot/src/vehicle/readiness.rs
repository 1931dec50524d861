//! Pre-flight checks: all reasons why the vehicle cannot take off.

use std::fmt;
use std::time::Duration;

use super::life::{Flying, Life, Preparation};
use super::{ControlState, DroneState, FlightEvent, Trust, Vehicle};
use crate::agent::LANDING_BATTERY_PERCENT;
use crate::plan;

/// Minimum charge for take-off; below it the drone may refuse to take off.
const LEAST_BATTERY_PERCENT: u32 = 20;
/// Oldest navdata accepted for take-off.
const OLDEST_NAVDATA: Duration = Duration::from_millis(500);
/// Minimum navdata rate in packets per second: a third of the slower of the drone's two rates (15 and 200).
pub(super) const LEAST_NAVDATA_HZ: f64 = 5.0;
/// Maximum roll or pitch on the ground. Beyond it the ground is not level, or the sensors are wrong.
const LARGEST_TILT_DEG: f64 = 8.0;

/// Highest altitude accepted on the ground. A drone on the floor reads about zero.
const HIGHEST_ON_GROUND_M: f64 = 0.6;
/// State bits that forbid flying, with their messages.
const FAULTS: [(DroneState, &str); 6] = [
    (DroneState::MOTORS_PROBLEM, "a motor is blocked or broken"),
    (DroneState::SOFTWARE_FAULT, "the drone reports a software fault"),
    (DroneState::ANGLES_OUT_OF_RANGE, "the drone reports that it is tilted too far"),
    (DroneState::CUTOUT_DETECTED, "the drone reports a motor cut-out"),
    (DroneState::ULTRASOUND_DEAF, "the drone reports that its ultrasound hears nothing"),
    (DroneState::TOO_MUCH_WIND, "the drone reports too much wind"),
];

/// A reason not to take off.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum NotReady {
    /// No drone answers.
    NoDrone,
    /// The settings or the level reference are being set.
    Configuring,
    /// A flight is in progress or about to begin.
    InFlight,
    /// The drone has cut its motors.
    Emergency,
    /// The drone reports a fault.
    Drone(&'static str),
    /// The drone sends its state, but no flight data.
    Silent,
    /// The newest navdata, or the newest plausible ones, are older than 500 ms.
    OldNavdata {
        /// Age of the newest navdata.
        age: Duration,
    },
    /// Fewer than 5 packets of navdata a second arrive.
    FewNavdata {
        /// Packets a second.
        hz: f64,
    },
    /// The navdata are not plausible.
    Distrust(Trust),
    /// The altitude is more than 0.6 m from zero although the drone has landed.
    NotOnFloor {
        /// Metres above the floor.
        altitude_m: f64,
    },
    /// The drone does not stand level: it is tilted by more than 8°.
    Tilted {
        /// The larger of roll and pitch.
        deg: f64,
    },
    /// The battery is too low for any flight: 20 % or less.
    EmptyBattery {
        /// Remaining charge.
        percent: u32,
    },
    /// The battery is too low for this mission.
    ShortBattery {
        /// Remaining charge.
        percent: u32,
        /// Expected duration of the mission.
        flight: Duration,
        /// Charge required at take-off, in percent.
        needed: f64,
    },
    /// The drone is in the air: another pilot flies it.
    NotLanded,
    /// The drone has not applied the settings of these keys, separated by commas.
    Settings(String),
    /// The drone's configuration could not be read back.
    SettingsNotRead,
    /// Another vehicle in the room has not told where it is, or not for too long.
    PeerSilent {
        /// The number of its MAVLink system.
        system: u8,
    },
    /// Another vehicle flies or stands too near to where this one stands, or is about to take off there.
    PeerNear {
        /// The number of its MAVLink system.
        system: u8,
        /// How far away it is, across.
        away_m: f64,
    },
}

impl fmt::Display for NotReady {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDrone => f.write_str("no drone answers yet"),
            Self::Configuring => f.write_str("the drone is being configured"),
            Self::InFlight => f.write_str("a flight is under way"),
            Self::Emergency => f.write_str(
                "the drone is in its emergency state: check it, then clear it with `recover`, its \
                 reset button or its battery",
            ),
            Self::Drone(problem) => f.write_str(problem),
            Self::Silent => f.write_str("the drone sends no flight data"),
            Self::OldNavdata { age } => write!(
                f,
                "the newest flight data are {} ms old: move closer, or use another Wi-Fi channel",
                age.as_millis()
            ),
            Self::FewNavdata { hz } => write!(
                f,
                "only {hz:.0} packets of flight data a second: at least {LEAST_NAVDATA_HZ:.0} are \
                 needed; move closer, or use another Wi-Fi channel"
            ),
            Self::Distrust(trust) => write!(f, "{trust}: restart the drone"),
            Self::NotOnFloor { altitude_m } => write!(
                f,
                "the drone reads an altitude of {altitude_m:.1} m although it has landed: restart it"
            ),
            Self::Tilted { deg } => {
                write!(f, "the drone is tilted by {deg:.0}°: put it on level ground")
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
                "the drone is in the air: land it first, or begin the plan with `autoTakeover`",
            ),
            Self::Settings(keys) => write!(f, "the drone has not applied its settings: {keys}"),
            Self::SettingsNotRead => f.write_str(
                "the drone's settings could not be read back over its control port: restart the \
                 drone, or set `read_back = false` to fly on its acknowledgements alone",
            ),
            Self::PeerSilent { system } => {
                write!(
                    f,
                    "vehicle {system} in the same room is not heard: switch its drone on and start its pilot, or leave it out"
                )
            }
            Self::PeerNear { system, away_m } => {
                write!(f, "vehicle {system} is {away_m:.1} m away: move one of the two first")
            }
        }
    }
}

impl Vehicle {
    /// Begins the flight of a drone that has been monitored and sent so many packets per second, or refuses it with all
    /// reasons.
    pub(super) fn take_off_or_refuse(&mut self, now: Duration, hz: f64) {
        let mut reasons = self.problems_of_the_drone();
        reasons.extend(self.problems_of_the_link(now, hz));
        reasons.extend(self.problems_of_the_battery());
        reasons.extend(self.problems_of_the_sensors(now));
        if !self.on_ground() && !self.mission.takes_over() {
            reasons.push(NotReady::NotLanded);
        }
        reasons.extend(self.problems_of_the_settings());
        reasons.extend(self.problems_of_the_room(now));
        if reasons.is_empty() {
            self.life.enter(Life::Flying(Flying::default()));
        } else {
            self.refuse(now, reasons.iter().map(ToString::to_string).collect());
        }
    }

    /// Reasons why the vehicle cannot take off now with a short mission, evaluated while it does not fly.
    /// They are in the order in which an operator would resolve them.
    pub(super) fn not_ready(&self, now: Duration) -> Vec<NotReady> {
        match &self.life {
            Life::Preparing { stage, departure } => vec![match stage {
                Preparation::Observing(_) if self.navdata.is_some() => NotReady::NotLanded,
                Preparation::Connecting | Preparation::Observing(_) => NotReady::NoDrone,
                Preparation::Trimming(_) if departure.is_some() => NotReady::InFlight,
                Preparation::Configuring { .. } | Preparation::Trimming(_) => NotReady::Configuring,
            }],
            Life::Flying(_) | Life::Landing { .. } => vec![NotReady::InFlight],
            Life::Standby { .. } => {
                let mut reasons = self.problems_of_the_drone();
                reasons.extend(self.problems_of_the_link(now, self.navdata_hz));
                reasons.extend(self.battery_empty());
                reasons.extend(self.problems_of_the_sensors(now));
                reasons.extend(self.problems_of_the_settings());
                reasons.extend(self.problems_of_the_room(now));
                reasons
            }
        }
    }

    /// Other vehicles that are not heard, or too near. Asking for the first of them allocates nothing.
    pub(super) fn problems_of_the_room(&self, now: Duration) -> impl Iterator<Item = NotReady> {
        let peers = self.config.peers.iter();
        let silent = peers.filter(move |peer| !self.neighbours.is_heard(**peer, now));
        let silent = silent.map(|peer| NotReady::PeerSilent { system: *peer });
        let oneself = self.oneself(now, &self.state(now));
        let near = self.neighbours.too_near(now, oneself);
        silent.chain(near.map(|(system, away_m)| NotReady::PeerNear { system, away_m }))
    }

    fn problems_of_the_settings(&self) -> Vec<NotReady> {
        let mut reasons = Vec::new();
        if !self.configured.unconfirmed.is_empty() {
            reasons.push(NotReady::Settings(self.configured.unconfirmed.join(", ")));
        }
        if self.configured.not_read {
            reasons.push(NotReady::SettingsNotRead);
        }
        reasons
    }

    /// Decides whether to take over a drone found in the air, from what it sends before it is configured: a
    /// drone that has lost its pilot sends nothing but its state until then.
    pub(super) fn take_over_or_refuse(&mut self, now: Duration, hz: f64) {
        let mut reasons = self.problems_of_the_drone();
        if self.demo().is_some() {
            reasons.extend(self.problems_of_the_battery());
            reasons.extend(self.problems_of_the_sensors(now));
        }
        let link = self.problems_of_the_link(now, hz);
        reasons.extend(link.filter(|reason| *reason != NotReady::Silent));
        if !self.mission.takes_over() {
            reasons.push(NotReady::NotLanded);
        }
        if reasons.is_empty() {
            self.events.push_back(FlightEvent::TakingOver);
            self.begin_to_configure(now);
            if let Life::Preparing { departure: Some(departure), .. } = &mut self.life {
                departure.takes_over = true;
            }
        } else {
            self.refuse(now, reasons.iter().map(ToString::to_string).collect());
        }
    }

    /// The fault that the drone reports, if any.
    pub(super) fn reported_fault(&self) -> Option<&'static str> {
        let state = self.drone_state();
        FAULTS.iter().find(|(bit, _)| state.contains(*bit)).map(|(_, fault)| *fault)
    }

    /// A drone with implausible navdata must not take off.
    fn problems_of_the_sensors(&self, now: Duration) -> Option<NotReady> {
        self.demo()?;
        let trust = self.flight.estimator.trust();
        let heard = self.session.silence(now).is_some_and(|age| age <= OLDEST_NAVDATA);
        let old = heard && self.blind_for(now) > OLDEST_NAVDATA;
        match self.flight.estimator.standing_altitude_m() {
            _ if trust != Trust::Sound => Some(NotReady::Distrust(trust)),
            _ if old => Some(NotReady::OldNavdata { age: self.blind_for(now) }),
            _ if !self.on_ground() => None,
            // A start may be called off and given again before the next packet; before the take-off it is asked again.
            None => self.life.departure().map(|_| NotReady::Silent),
            Some(altitude_m) => (altitude_m.abs() > HIGHEST_ON_GROUND_M)
                .then_some(NotReady::NotOnFloor { altitude_m }),
        }
    }

    fn problems_of_the_drone(&self) -> Vec<NotReady> {
        let state = self.drone_state();
        let mut reasons = Vec::new();
        if state.contains(DroneState::EMERGENCY) {
            reasons.push(NotReady::Emergency);
        }
        let faults = FAULTS.iter().filter(|(bit, _)| state.contains(*bit));
        reasons.extend(faults.map(|(_, problem)| NotReady::Drone(problem)));
        let landed = |control_state| control_state == ControlState::Landed;
        if let Some(demo) = self.demo().filter(|demo| landed(demo.control_state)) {
            let deg = demo.roll_deg.abs().max(demo.pitch_deg.abs());
            if deg > LARGEST_TILT_DEG {
                reasons.push(NotReady::Tilted { deg });
            }
        }
        reasons
    }

    fn problems_of_the_link(&self, now: Duration, hz: f64) -> Option<NotReady> {
        let Some(age) = self.session.silence(now).filter(|_| self.demo().is_some()) else {
            return Some(NotReady::Silent);
        };
        if age > OLDEST_NAVDATA {
            Some(NotReady::OldNavdata { age })
        } else if hz < LEAST_NAVDATA_HZ {
            Some(NotReady::FewNavdata { hz })
        } else {
            None
        }
    }

    fn problems_of_the_battery(&self) -> Option<NotReady> {
        self.battery_empty().or_else(|| self.battery_too_low_for_mission())
    }

    fn battery_empty(&self) -> Option<NotReady> {
        let percent = self.demo()?.battery_percent;
        (percent <= LEAST_BATTERY_PERCENT).then_some(NotReady::EmptyBattery { percent })
    }

    pub(super) fn battery_too_low_for_mission(&self) -> Option<NotReady> {
        let percent = self.demo()?.battery_percent;
        let flight = self.mission.expected_time();
        let needed = f64::from(LANDING_BATTERY_PERCENT) + plan::battery_percent(flight);
        let short = f64::from(percent) < needed;
        short.then_some(NotReady::ShortBattery { percent, flight, needed })
    }
}
