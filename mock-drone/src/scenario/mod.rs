//! Faults over time, in a text format.
//!
//! ```text
//! # seconds since the start, or with a plus since the first take-off
//! 0     delay 20 jitter 15       # milliseconds
//! +2    loss 30                  # percent
//! +5    outage 1.2               # seconds
//! +8    lie altitude 0.5 for 3   # metres, seconds
//! +9    stuck yaw for 2
//! +10   video cut for 2
//! +12   wind 1.5 -0.5 gusts 0.4  # metres a second towards right and forward
//! +20   restart
//! ```

mod parser;

use std::time::Duration;

use ardrone_link::navdata::DroneState;
use diagnostic::{Source, render_all};
use nalgebra::Vector2;

use crate::camera::FloorTag;
use crate::faults::{Quantity, SensorFault};

/// A list of actions with their times.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Scenario {
    entries: Vec<Entry>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    when: When,
    action: Action,
}

/// Time of an action.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// Time since the start.
    SinceStart(Duration),
    /// Time since the first take-off.
    SinceTakeOff(Duration),
}

/// Direction of a link fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Pilot to drone.
    Up,
    /// Drone to pilot.
    Down,
    /// Both directions.
    Both,
}

impl Direction {
    pub(crate) fn is_up(self) -> bool {
        self != Self::Down
    }

    pub(crate) fn is_down(self) -> bool {
        self != Self::Up
    }
}

/// What is wrong with the video stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VideoFault {
    /// Connections are closed, new ones as soon as they are accepted.
    Cut,
    /// Connections stay open and new ones are accepted, but nothing is sent.
    Silent,
    /// Random bytes in place of each picture, with a header's signature among them.
    Garbage,
    /// The headers of the pictures announce wrong sizes, of themselves or of the payload.
    Lie,
}

/// A fault or another change. Fractions are probabilities from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Fraction of datagrams that are lost.
    Loss(Direction, f64),
    /// Base latency and maximum jitter, in both directions, as the next three.
    Delay(Duration, Duration),
    /// Fraction of datagrams that arrive twice.
    Duplication(f64),
    /// Fraction of datagrams that are reordered.
    Reordering(f64),
    /// Fraction of datagrams that are corrupted.
    Corruption(f64),
    /// All datagrams are lost for a time.
    Outage(Direction, Duration),
    /// Datagrams are held back for a time, and then arrive at once.
    Hold(Direction, Duration),
    /// The last navdata packets, this many and at most 256, arrive once more, at once.
    Burst(usize),
    /// The drone is power-cycled.
    Restart,
    /// A propeller is blocked.
    Propeller,
    /// All sensor readings stay constant for a time; the drone's clock goes on.
    Freeze(Duration),
    /// One quantity in navdata is wrong for a time.
    Sensor(Quantity, SensorFault, Duration),
    /// The drone sets bits of its state word for a time.
    State(DroneState, Duration),
    /// The drone reports this detail of its control state for a time.
    Minor(u16, Duration),
    /// A motor weakens to this fraction of its thrust, over a time.
    Motor(f64, Duration),
    /// The wind towards (right, forward), and the standard deviation of its gusts on each axis, both in m/s.
    Wind(Vector2<f64>, f64),
    /// A tag is placed on the floor.
    LayTag(FloorTag),
    /// A tag is moved or removed; the first one placed is 0.
    MoveTag(usize, Option<FloorTag>),
    /// Sets the charge in percent.
    Battery(f64),
    /// Reduction of the measured charge at full load, in percent.
    BatterySag(f64),
    /// Another client orders take-off and hover for a time; its sequence numbers start here.
    SecondPilot(Duration, u32),
    /// The video is wrong for a time. Of several faults the last one counts, until it ends.
    Video(VideoFault, Duration),
}

/// The errors of a scenario.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{rendered}")]
#[non_exhaustive]
pub struct ScenarioError {
    /// All errors, with line and column.
    pub rendered: String,
}

impl Scenario {
    /// Adds an action.
    #[must_use]
    pub fn and(mut self, when: When, action: Action) -> Self {
        self.entries.push(Entry { when, action });
        self
    }

    /// Parses a scenario; `name` is its file's name for messages.
    ///
    /// # Errors
    /// [`ScenarioError`] with all errors.
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        let (entries, diagnostics) = parser::parse(text);
        if diagnostics.is_empty() {
            return Ok(Self { entries });
        }
        let rendered = render_all(&diagnostics, &Source { name, text });
        Err(ScenarioError { rendered })
    }

    /// Removes and returns the actions that are due, in the order of the text.
    pub(crate) fn due(&mut self, now: Duration, take_off: Option<Duration>) -> Vec<Action> {
        let is_due = |entry: &mut Entry| entry.time(take_off).is_some_and(|time| time <= now);
        self.entries.extract_if(.., is_due).map(|entry| entry.action).collect()
    }

    /// When the next action is due, as far as it is known.
    pub(crate) fn next_due(&self, take_off: Option<Duration>) -> Option<Duration> {
        self.entries.iter().filter_map(|entry| entry.time(take_off)).min()
    }
}

impl Entry {
    fn time(&self, take_off: Option<Duration>) -> Option<Duration> {
        match self.when {
            When::SinceStart(time) => Some(time),
            When::SinceTakeOff(time) => take_off.map(|take_off| take_off + time),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scenario_is_read_and_its_actions_come_when_they_are_due() {
        let text = "# faults\n0 delay 20 jitter 15\n+2 loss 30\n\n+5.5 outage 1.2 # gone\n\
                    1 wind 1.5 -0.5 gusts 0.4\n+8 lie altitude 0.5 for 3\n+9 restart\n";
        let mut scenario = Scenario::parse("s.txt", text).unwrap();
        let seconds = Duration::from_secs_f64;
        assert_eq!(scenario.next_due(None), Some(Duration::ZERO));
        let delay = Action::Delay(seconds(0.02), seconds(0.015));
        let wind = Action::Wind(Vector2::new(1.5, -0.5), 0.4);
        assert_eq!(scenario.due(seconds(1.0), None), [delay, wind]);
        assert_eq!(scenario.due(seconds(100.0), None), []);
        assert_eq!(scenario.next_due(Some(seconds(100.0))), Some(seconds(102.0)));
        assert_eq!(
            scenario.due(seconds(102.0), Some(seconds(100.0))),
            [Action::Loss(Direction::Both, 0.3)]
        );
        assert_eq!(scenario.due(seconds(200.0), Some(seconds(100.0))).len(), 3);
        assert_eq!(scenario, Scenario::default());
    }

    /// The actions of a text, as if all were due.
    fn actions(text: &str) -> Vec<Action> {
        let mut scenario = Scenario::parse("s.txt", text).unwrap_or_else(|error| panic!("{error}"));
        scenario.due(Duration::from_hours(1), None)
    }

    #[test]
    fn each_quantity_can_be_wrong_in_each_way() {
        use SensorFault as Fault;

        let second = Duration::from_secs(1);
        for (text, quantity, fault) in [
            ("stuck velocity-right", Quantity::VelocityRight, Fault::Stuck),
            ("stuck velocity-forward at -0.5", Quantity::VelocityForward, Fault::StuckAt(-0.5)),
            ("dead altitude", Quantity::Altitude, Fault::DeadAt(0.0)),
            ("dead altitude at 1.5", Quantity::Altitude, Fault::DeadAt(1.5)),
            ("lie heading 20", Quantity::Yaw, Fault::Offset(20.0)),
            ("lie yaw -20", Quantity::Yaw, Fault::Offset(-20.0)),
            ("ramp roll 0.5", Quantity::Roll, Fault::Ramp(0.5)),
            ("noise altitude 0.4", Quantity::Altitude, Fault::Noise(0.4)),
            ("gain velocity-right -1", Quantity::VelocityRight, Fault::Gain(-1.0)),
            ("nan pitch", Quantity::Pitch, Fault::NotANumber),
            ("late clock 0.5", Quantity::Clock, Fault::Late(second / 2)),
        ] {
            let text = format!("1 {text} for 1");
            assert_eq!(actions(&text), [Action::Sensor(quantity, fault, second)], "{text}");
        }
        assert_eq!(
            actions("1 lie velocity 0.5 -1 for 1"),
            [
                Action::Sensor(Quantity::VelocityRight, Fault::Offset(0.5), second),
                Action::Sensor(Quantity::VelocityForward, Fault::Offset(-1.0), second),
            ]
        );
    }

    #[test]
    fn the_other_faults_are_read() {
        let second = Duration::from_secs(1);
        for (text, action) in [
            ("loss up 30", Action::Loss(Direction::Up, 0.3)),
            ("outage down 1", Action::Outage(Direction::Down, second)),
            ("outage 1", Action::Outage(Direction::Both, second)),
            ("hold 1", Action::Hold(Direction::Both, second)),
            ("hold up 1", Action::Hold(Direction::Up, second)),
            ("burst 50", Action::Burst(50)),
            ("state ultrasound-deaf for 1", Action::State(DroneState::ULTRASOUND_DEAF, second)),
            ("minor 6 for 1", Action::Minor(6, second)),
            ("motor 70 over 1", Action::Motor(0.7, second)),
            ("motor 70", Action::Motor(0.7, Duration::ZERO)),
            ("sag 15", Action::BatterySag(15.0)),
            ("tag 1 -0.5", Action::LayTag(FloorTag::new(1.0, -0.5, 0.0))),
            ("tag 1 -0.5 90", Action::LayTag(FloorTag::new(1.0, -0.5, 90.0))),
            ("tag-gone 2", Action::MoveTag(1, None)),
            ("tag-moved 1 0 2 -90", Action::MoveTag(0, Some(FloorTag::new(0.0, 2.0, -90.0)))),
            ("second-pilot 1", Action::SecondPilot(second, 1)),
            ("second-pilot 1 from 5000", Action::SecondPilot(second, 5000)),
            ("video cut for 1", Action::Video(VideoFault::Cut, second)),
            ("video silent for 1", Action::Video(VideoFault::Silent, second)),
            ("video garbage for 1", Action::Video(VideoFault::Garbage, second)),
            ("video lie for 1", Action::Video(VideoFault::Lie, second)),
        ] {
            assert_eq!(actions(&format!("0 {text}")), [action], "{text}");
        }
    }

    #[test]
    fn every_mistake_is_shown_with_its_place() {
        let text = "soon loss 3\n1 los 3\n2 loss 300\n3 loss\n4 restart now\n5 lie wind 3 for 1\n\
                    6 lie yaw 3 1\n-7 restart\nNaN restart\n8 nan altitude for 1\n9 state happy for 1\n\
                    10 burst 1.5\n11 lie velocity 1 for 2\n12 stuck velocity for 2\n13 video gone for 2\n14 video cut 2";
        let error = Scenario::parse("s.txt", text).unwrap_err().rendered;
        let places: Vec<&str> = error.lines().filter(|line| line.starts_with("error")).collect();
        assert_eq!(
            places,
            [
                "error: `soon` is not a time",
                "error: unknown action `los`",
                "error: expected a percentage, found `300`",
                "error: expected a percentage, found the end of the line",
                "error: unexpected `now`",
                "error: unknown quantity `wind`",
                "error: expected `for`, found `1`",
                "error: `-7` is not a time",
                "error: `NaN` is not a time",
                "error: altitude is always a number",
                "error: unknown state `happy`",
                "error: expected a number of packets, found `1.5`",
                "error: expected metres a second, found `for`",
                "error: unknown quantity `velocity`",
                "error: unknown fault of the video `gone`",
                "error: expected `for`, found `2`",
            ]
        );
        assert!(error.contains("s.txt:3:8"), "{error}");
        assert!(error.contains("ultrasound-deaf"), "{error}");
    }
}
