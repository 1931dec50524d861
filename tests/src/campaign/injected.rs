//! Injected faults and their times: known to the judge, not to the pilot.

use std::time::Duration;

use ardrone_link::navdata::DroneState;
use autopilot::vehicle::TICK;
use mock_drone::scenario::{Action, Direction, Scenario, When};
use mock_drone::{Quantity, SensorFault, Truth};

/// The faults of a flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Injected {
    pub(crate) accidents: Vec<(When, Action)>,
    /// Times and durations in which the pilot's program does not run.
    pub(crate) stalls: Vec<(Duration, Duration)>,
    /// The pilot was told wrong positions of tags.
    pub(super) is_survey_wrong: bool,
    /// Time of the first take-off.
    take_off: Option<Duration>,
}

impl Injected {
    /// The faults as a scenario.
    pub(crate) fn scenario(&self) -> Scenario {
        self.accidents
            .iter()
            .fold(Scenario::default(), |scenario, (when, action)| scenario.and(*when, *action))
    }

    /// Detects the take-off.
    pub(crate) fn see(&mut self, truth: &Truth) {
        if is_airborne(truth) {
            // It is seen at the end of the tick in which it happens.
            self.take_off.get_or_insert(truth.time.saturating_sub(TICK));
        }
    }

    /// Faults that have begun, with their times.
    pub(crate) fn begun(&self, now: Duration) -> impl Iterator<Item = (Duration, &Action)> {
        self.times().filter(move |(at, _)| *at <= now)
    }

    /// Faults that last now, with their start.
    fn lasting(&self, now: Duration) -> impl Iterator<Item = (Duration, &Action)> {
        self.begun(now)
            .filter(move |(at, action)| time_of(action).is_none_or(|time| now < *at + time + TICK))
    }

    /// All faults whose times are known; some depend on the take-off.
    fn times(&self) -> impl Iterator<Item = (Duration, &Action)> {
        self.accidents.iter().filter_map(|(when, action)| {
            let at = match when {
                When::SinceStart(at) => Some(*at),
                When::SinceTakeOff(at) => self.take_off.map(|take_off| take_off + *at),
            };
            Some((at?, action))
        })
    }

    /// Whether no fault begins or ends in this interval.
    pub(super) fn is_quiet(&self, from: Duration, to: Duration) -> bool {
        let passes = |at: Duration, time: Duration| at + time < from || at > to;
        // Faults without an end are steady; only changes disturb.
        self.times().all(|(at, action)| passes(at, time_of(action).unwrap_or(Duration::ZERO)))
            && self.stalls.iter().all(|(at, time)| passes(*at, *time))
    }

    /// Whether the program is stopped.
    pub(crate) fn is_stalled(&self, now: Duration) -> bool {
        self.stalls.iter().any(|(at, time)| (*at..*at + *time).contains(&now))
    }

    /// Whether datagrams to the drone are lost or delayed.
    pub(super) fn is_cut_up(&self, now: Duration) -> bool {
        self.is_cut(now, Direction::Up)
    }

    /// Whether datagrams from the drone are lost or delayed.
    pub(super) fn is_cut_down(&self, now: Duration) -> bool {
        self.is_cut(now, Direction::Down)
    }

    fn is_cut(&self, now: Duration, way: Direction) -> bool {
        self.is_stalled(now)
            || self.lasting(now).any(|(_, action)| match action {
                Action::Outage(direction, _) | Action::Hold(direction, _) => {
                    *direction == way || *direction == Direction::Both
                }
                _ => false,
            })
    }

    /// Whether another pilot sends commands, or has within `since`.
    pub(crate) fn second_pilot(&self, now: Duration, since: Duration) -> bool {
        self.begun(now).any(|(at, action)| match action {
            Action::SecondPilot(time, _) => now < at + *time + since,
            _ => false,
        })
    }

    /// Longest time for which an order may have been delayed.
    pub(super) fn longest_hold(&self, now: Duration) -> Duration {
        let holds = self.begun(now).filter_map(|(_, action)| match action {
            Action::Hold(_, time) => Some(*time),
            _ => None,
        });
        holds.max().unwrap_or_default()
    }

    /// Whether navdata have been wrong so far.
    pub(crate) fn has_lied(&self, now: Duration) -> bool {
        self.begun(now).any(|(_, action)| matches!(action, Action::Sensor(..) | Action::Freeze(_)))
    }

    /// Whether navdata or tags have been wrong so far about the position.
    pub(super) fn has_lied_of_place(&self, now: Duration) -> bool {
        let is_moved = |action: &Action| matches!(action, Action::MoveTag(_, Some(_)));
        self.has_lied(now)
            || self.is_survey_wrong
            || self.begun(now).any(|(_, action)| is_moved(action))
    }

    /// Whether tags could rightly contradict the position.
    pub(super) fn may_be_contradicted(&self, now: Duration) -> bool {
        let is_gone = |action: &Action| matches!(action, Action::MoveTag(..));
        self.has_lied_of_place(now) || self.begun(now).any(|(_, action)| is_gone(action))
    }

    /// How far a drifting velocity has led a pilot that trusts it, including the distance until that speed is
    /// lost again.
    pub(super) fn velocity_drift_m(&self, now: Duration) -> f64 {
        const SLOWING_DOWN_S: f64 = 2.0;
        const BLOWN_M_S: f64 = 1.5;
        const BLOWN_S: f64 = 8.0;
        let drift = |at: Duration, action: &Action| match action {
            Action::Sensor(
                Quantity::VelocityRight | Quantity::VelocityForward,
                SensorFault::Ramp(a_second),
                time,
            ) => {
                let drifts_s = now.saturating_sub(at).min(*time).as_secs_f64();
                a_second.abs() * drifts_s * (drifts_s / 2.0 + SLOWING_DOWN_S)
            }
            // A velocity that is frozen but noisy can be detected only when the drone tilts; until then the
            // drone is blown along.
            Action::Sensor(
                Quantity::VelocityRight | Quantity::VelocityForward,
                SensorFault::DeadAt(_),
                time,
            ) => BLOWN_M_S * now.saturating_sub(at).min(*time).as_secs_f64().min(BLOWN_S),
            _ => 0.0,
        };
        self.begun(now).map(|(at, action)| drift(at, action)).sum()
    }

    /// Whether the altitude is or was wrong.
    pub(super) fn has_lied_of_height(&self, now: Duration) -> bool {
        self.begun(now).any(|(_, action)| {
            matches!(action, Action::Sensor(Quantity::Altitude, ..) | Action::Freeze(_))
        })
    }

    /// Time for which no measurement of the position has been usable.
    pub(super) fn worthless_for(&self, now: Duration) -> Duration {
        let worthless = self.lasting(now).filter(|(_, action)| match action {
            Action::Freeze(_) => true,
            Action::Sensor(quantity, SensorFault::NotANumber, _) => matches!(
                quantity,
                Quantity::VelocityRight | Quantity::VelocityForward | Quantity::Yaw
            ),
            _ => false,
        });
        worthless.map(|(at, _)| now.saturating_sub(at)).max().unwrap_or_default()
    }

    /// Whether the drone reports these state bits.
    pub(super) fn claims(&self, now: Duration, bits: DroneState) -> bool {
        self.lasting(now).any(|(_, action)| match action {
            Action::State(claimed, _) => claimed.intersects(bits),
            _ => false,
        })
    }

    /// Whether the drone reports by its minor control state that it does not measure velocity or altitude.
    pub(super) fn claims_no_floor(&self, now: Duration) -> bool {
        self.lasting(now).any(|(_, action)| matches!(action, Action::Minor(..)))
    }

    /// Whether a motor has weakened.
    pub(super) fn has_weak_motor(&self, now: Duration) -> bool {
        self.begun(now).any(|(_, action)| matches!(action, Action::Motor(..)))
    }

    /// Whether it has been restarted.
    pub(super) fn has_restarted(&self, now: Duration) -> bool {
        self.begun(now).any(|(_, action)| matches!(action, Action::Restart))
    }

    /// The current wind.
    pub(crate) fn wind_m_s(&self, now: Duration) -> Option<f64> {
        self.wind(now).map(|(speed_m_s, _)| speed_m_s)
    }

    /// The current wind, and the deviation of its gusts.
    pub(super) fn wind(&self, now: Duration) -> Option<(f64, f64)> {
        let winds = self.begun(now).filter_map(|(at, action)| match action {
            Action::Wind(steady_m_s, gusts_m_s) => Some((at, (steady_m_s.norm(), *gusts_m_s))),
            _ => None,
        });
        winds.max_by_key(|(at, _)| *at).map(|(_, wind)| wind)
    }
}

/// Whether the drone is off the ground, or about to be.
pub(super) fn is_airborne(truth: &Truth) -> bool {
    use mock_drone::firmware::Phase;
    matches!(truth.phase, Phase::TakingOff { .. } | Phase::Flying | Phase::Landing)
}

/// Its duration, if it ends.
fn time_of(action: &Action) -> Option<Duration> {
    match action {
        Action::Outage(_, time)
        | Action::Hold(_, time)
        | Action::Freeze(time)
        | Action::Sensor(_, _, time)
        | Action::State(_, time)
        | Action::Minor(_, time)
        | Action::SecondPilot(time, _) => Some(*time),
        // These have no duration.
        Action::Burst(_) | Action::Restart | Action::Propeller => Some(Duration::ZERO),
        _ => None,
    }
}
