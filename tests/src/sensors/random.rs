//! Random single sensor failures: any value, at any moment from before the take-off on, lasting, passing or in
//! pulses.
//!
//! [`failures`](super::failures) are few values at favourable moments. What lies between them, and a failure
//! that comes and goes, is found here.

use std::fmt;
use std::time::Duration;

use mock_drone::scenario::{Action, Scenario, When};
use mock_drone::{Quantity, SensorFault};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::{Excursion, Flown, GAINS, STEP, Situation};
use crate::airframes::{AIRFRAMES, Airframes};
use crate::sim::SimulationError;
use crate::trial::FOR_EVER;

/// Smallest error of a velocity that shows between two packets, or compared with rest at the take-off.
const SHOWS_M_S: f64 = 0.6;
/// A slower drift of the altitude is not distinguished from a climb.
const SHOWS_RAMP_M_S: f64 = 0.06;
/// Earliest moment of a failure: the drone stands and is observed.
const EARLIEST_S: f64 = 0.5;
/// Latest moment, after the start of the step that is observed.
const LATEST_S: f64 = 6.0;
/// More pulses than a flight is long.
const PULSES: usize = 60;

/// When a failure is active.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pattern {
    Lasting,
    Once { on_s: f64 },
    Pulses { on_s: f64, off_s: f64 },
}

impl Pattern {
    fn random(random: &mut ChaCha8Rng) -> Self {
        match random.random_range(0..3) {
            0 => Self::Lasting,
            1 => Self::Once { on_s: random.random_range(0.1..8.0) },
            _ => Self::Pulses {
                on_s: random.random_range(0.05..1.2),
                off_s: random.random_range(0.1..3.0),
            },
        }
    }

    fn scenario(self, at: Duration, quantity: Quantity, fault: SensorFault) -> Scenario {
        let (on, every, count) = match self {
            Self::Lasting => (FOR_EVER, FOR_EVER, 1),
            Self::Once { on_s } => (Duration::from_secs_f64(on_s), FOR_EVER, 1),
            Self::Pulses { on_s, off_s } => {
                (Duration::from_secs_f64(on_s), Duration::from_secs_f64(on_s + off_s), PULSES)
            }
        };
        let starts = std::iter::successors(Some(at), |start| Some(*start + every));
        starts.take(count).fold(Scenario::default(), |scenario, start| {
            scenario.and(When::SinceStart(start), Action::Sensor(quantity, fault, on))
        })
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lasting => f.write_str("from then on"),
            Self::Once { on_s } => write!(f, "for {on_s:.2} s"),
            Self::Pulses { on_s, off_s } => {
                write!(f, "in pulses of {on_s:.2} s, {off_s:.2} s apart")
            }
        }
    }
}

/// A flight with a random failure, and how far it led the drone astray.
#[derive(Debug, Clone, PartialEq)]
pub struct RandomFlight {
    /// The flight and its failure, for reports.
    pub description: String,
    /// Its number, of which all follows.
    pub number: u64,
    /// Name of the airframe.
    pub airframe: &'static str,
    /// What the drone does in the step that is observed.
    pub situation: Situation,
    /// The quantity that fails.
    pub quantity: Quantity,
    /// Whether navdata can reveal the failure.
    pub shows: bool,
    /// The drone's own hover and landing instead: the best that can be achieved.
    pub own: Excursion,
    /// With the failure.
    pub flown: Flown,
}

impl RandomFlight {
    /// Whether the failure led the drone too far.
    pub fn is_too_far(&self) -> bool {
        self.flown.excursion.is_too_far(&self.own)
    }
}

impl fmt::Display for RandomFlight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { description, own, flown: Flown { excursion: flown, outcome, .. }, .. } = self;
        write!(
            f,
            "{description}: {:.2} m away ({:.2} m by itself), {:.2} m outside, {:.1} s on the floor{}; {outcome}",
            flown.away_m,
            own.away_m,
            flown.outside_m,
            flown.scraping.as_secs_f64(),
            if flown.airborne { ", still airborne" } else { "" },
        )
    }
}

/// Flies the random failure of this number with a published airframe.
///
/// # Errors
/// As [`random_of`].
///
/// # Panics
/// If the healthy flight ends before the step that is observed.
pub fn random(number: u64) -> Result<RandomFlight, SimulationError> {
    let flight = random_of(Airframes::Published, number)?;
    Ok(flight.unwrap_or_else(|| panic!("number {number}: never came so far")))
}

/// Flies the random failure of this number; `None` if the healthy drone is landed before the step that is observed.
///
/// # Errors
/// [`SimulationError`] if the flight never ends.
pub fn random_of(
    airframes: Airframes,
    number: u64,
) -> Result<Option<RandomFlight>, SimulationError> {
    let mut random = ChaCha8Rng::seed_from_u64(number ^ 0x7261_6e64);
    let airframe = random.random_range(0..AIRFRAMES.len());
    let (profile, airframe) = (airframes.profile(airframe, number), airframes.name(airframe));
    let situation = Situation::ALL[random.random_range(0..Situation::ALL.len())];
    let (plan, between) = situation.plan();
    let healthy = super::simulation(profile, situation, number, &mut random);
    let Some(began) = healthy.fly(plan.clone())?.start_of_step(STEP) else { return Ok(None) };
    let at_s = random.random_range(EARLIEST_S..began.as_secs_f64() + LATEST_S);
    let at = Duration::from_secs_f64(at_s);
    let quantity = Quantity::ALL[random.random_range(0..Quantity::ALL.len())];
    let fault = random_fault(quantity, &mut random);
    let pattern = Pattern::random(&mut random);
    // Before it hovers, the drone has no motion of its own to be compared with.
    let own = super::own_hover_and_landing(&healthy, &plan, at.max(began), between)?;
    let mut faulty = healthy;
    faulty.world.scenario = pattern.scenario(at, quantity, fault);
    let flown = super::flown(&faulty, plan, at, between)?;
    Ok(Some(RandomFlight {
        description: format!(
            "{number} {airframe} {situation}: {quantity:?} {fault:?} at {at_s:.2} s (its step begins at {:.2} s) {pattern}",
            began.as_secs_f64(),
        ),
        number,
        airframe,
        situation,
        quantity,
        shows: shows(quantity, fault),
        own,
        flown,
    }))
}

/// Values from small to large, small ones more often.
fn random_fault(quantity: Quantity, random: &mut ChaCha8Rng) -> SensorFault {
    let sign = if random.random_bool(0.5) { 1.0 } else { -1.0 };
    let size: f64 = random.random_range(0.0..1.0);
    let (offset, ramp, value) = match quantity {
        Quantity::VelocityRight | Quantity::VelocityForward => {
            (0.4 + 2.6 * size * size, 0.05 + size, sign * 2.0 * size)
        }
        Quantity::Altitude => (0.1 + 2.5 * size * size, 0.05 + size * size, 3.0 * size),
        Quantity::Yaw => (5.0 + 175.0 * size * size, 1.0 + 60.0 * size * size, sign * 180.0 * size),
        Quantity::Roll | Quantity::Pitch => {
            (2.0 + 30.0 * size, 1.0 + 10.0 * size, sign * 20.0 * size)
        }
        Quantity::Clock => (0.1 + 50.0 * size.powi(3), 0.05 + 3.0 * size * size, 0.0),
    };
    let noise = match quantity {
        Quantity::Yaw | Quantity::Roll | Quantity::Pitch => 2.0 + 18.0 * size,
        _ => 0.1 + 0.9 * size,
    };
    let is_clock = quantity == Quantity::Clock;
    match random.random_range(0..9) {
        7 if !is_clock => SensorFault::Noise(noise),
        8 => SensorFault::Gain(GAINS[random.random_range(0..GAINS.len())]),
        0 if !is_clock => SensorFault::StuckAt(value),
        1 if !is_clock => SensorFault::DeadAt(value),
        2 | 3 => SensorFault::Offset(sign * offset),
        4 => SensorFault::Ramp(sign * ramp),
        5 => SensorFault::Late(Duration::from_secs_f64(0.1 + 2.4 * size)),
        6 if quantity.is_float() => SensorFault::NotANumber,
        _ => SensorFault::Stuck,
    }
}

/// Whether navdata can reveal a fault. Besides those of [`Failure::shows`](super::Failure::shows), a velocity that is
/// wrong by less than noise and gusts explain is taken for a wind.
fn shows(quantity: Quantity, fault: SensorFault) -> bool {
    match (quantity, fault) {
        (Quantity::VelocityRight | Quantity::VelocityForward, SensorFault::Offset(offset)) => {
            offset.abs() >= SHOWS_M_S
        }
        (Quantity::Altitude, SensorFault::Ramp(rate)) => rate.abs() >= SHOWS_RAMP_M_S,
        _ => super::shows(quantity, fault),
    }
}
