//! The commands of the plan language, each declared once: its name, numbers and description, and what it means.
//!
//! The parser, its messages, completion and the page's editor follow from these declarations; what a [`Command`] does in
//! flight is in the [interpreter](super::interpreter).

use estimator::SurveyedTag;
use kinematics::Pose;
use nalgebra::Vector2;

use super::Command;

/// The version of the language that is read: `version 1` may stand before all other commands.
pub const VERSION: u32 = 1;

/// Largest coordinate, beyond the range of the drone's Wi-Fi.
const MAX_DISTANCE_M: f64 = 100.0;
const MAX_ANGLE_DEG: f64 = 3600.0;
/// Most numbers behind a command.
pub(super) const MOST: usize = 4;

/// A command of the plan language.
#[derive(Debug)]
pub struct Declaration {
    /// First word of its lines.
    pub name: &'static str,
    /// What it does.
    pub help: &'static str,
    /// A line with it; empty for what plans of `tum_ardrone` have and nobody needs here.
    pub example: &'static str,
    /// The numbers behind the name.
    pub numbers: &'static [Number],
    /// How many of the last numbers may be missing.
    pub optional: usize,
    /// Words that may stand in place of the numbers.
    pub(super) words: &'static [(&'static str, Command)],
    /// Why somebody who knows `tum_ardrone` may be surprised.
    pub(super) note: Option<&'static str>,
    pub(super) meaning: fn([f64; MOST]) -> Meaning,
}

/// A number behind a command's name.
#[derive(Debug, Clone, Copy)]
pub struct Number {
    /// Its name in messages.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    pub(super) low: f64,
    pub(super) high: f64,
}

/// What a line means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meaning {
    /// A step of the plan.
    Step(Command),
    /// A tag, which is no step. Not a number where its heading is not given.
    Tag(SurveyedTag),
    /// The version of the language, as written.
    Version(f64),
    /// The commands before it are dropped.
    Clears,
    /// Nothing in flight.
    Nothing,
}

impl Declaration {
    /// What is wrong about a command is told with its arguments in place: `goto x y z yaw`.
    pub(super) fn usage(&self) -> String {
        let needed = self.numbers.len() - self.optional;
        let numbers = self.numbers.iter().enumerate().map(|(index, number)| match number.name {
            name if index < needed => format!(" {name}"),
            name => format!(" [{name}]"),
        });
        let numbers = numbers.collect::<String>();
        let name = self.name;
        match self.words {
            [] if numbers.is_empty() => format!("write `{name}` alone"),
            [] => format!("write `{name}{numbers}`"),
            words => {
                let words: Vec<String> =
                    words.iter().map(|(word, _)| format!("`{name} {word}`")).collect();
                format!("write `{name}{numbers}`, {}", words.join(" or "))
            }
        }
    }

    /// Whether it is a target, so that its first two numbers lead somewhere: `goto`, `moveBy` or `moveByRel`.
    pub fn is_target(&self) -> bool {
        matches!(
            (self.meaning)([0.0; MOST]),
            Meaning::Step(Command::GoTo(_) | Command::MoveBy(_) | Command::MoveByRelative(_))
        )
    }
}

const fn number(name: &'static str, unit: &'static str, low: f64, high: f64) -> Number {
    Number { name, unit, low, high }
}

const fn metres(name: &'static str, unit: &'static str) -> Number {
    number(name, unit, -MAX_DISTANCE_M, MAX_DISTANCE_M)
}

const POSE: &[Number] = &[
    metres("x", "m right"),
    metres("y", "m forward"),
    metres("z", "m up"),
    number("yaw", "° clockwise", -MAX_ANGLE_DEG, MAX_ANGLE_DEG),
];
/// What `tum_ardrone` needs for its visual map.
const MAPPING: &[Number] = &[
    number("move", "ms", f64::MIN, f64::MAX),
    number("wait", "ms", f64::MIN, f64::MAX),
    number("rise", "ms", f64::MIN, f64::MAX),
    number("speed", "", f64::MIN, f64::MAX),
];

fn pose([x_m, y_m, z_m, yaw_deg]: [f64; MOST]) -> Pose {
    Pose { x_m, y_m, z_m, yaw_deg }
}

/// A declaration without numbers.
const ALONE: Declaration = Declaration {
    name: "",
    help: "",
    example: "",
    numbers: &[],
    optional: 0,
    words: &[],
    note: None,
    meaning: |_| Meaning::Nothing,
};

/// All commands, in the order in which they are listed.
pub const LANGUAGE: &[Declaration] = &[
    Declaration {
        name: "takeoff",
        help: "take off",
        example: "takeoff",
        meaning: |_| Meaning::Step(Command::TakeOff { take_over: false }),
        ..ALONE
    },
    Declaration {
        name: "land",
        help: "land",
        example: "land",
        meaning: |_| Meaning::Step(Command::Land),
        ..ALONE
    },
    Declaration {
        name: "goto",
        help: "a target",
        example: "goto 0 1 0 0",
        numbers: POSE,
        meaning: |numbers| Meaning::Step(Command::GoTo(pose(numbers))),
        ..ALONE
    },
    Declaration {
        name: "moveBy",
        help: "a target relative to the last",
        example: "moveBy 0 1 0 0",
        numbers: POSE,
        meaning: |numbers| Meaning::Step(Command::MoveBy(pose(numbers))),
        ..ALONE
    },
    Declaration {
        name: "moveByRel",
        help: "a target relative to the drone",
        example: "moveByRel 0 1 0 0",
        numbers: POSE,
        meaning: |numbers| Meaning::Step(Command::MoveByRelative(pose(numbers))),
        ..ALONE
    },
    Declaration {
        name: "hold",
        help: "stay at the last target",
        example: "hold 5",
        numbers: &[number("time", "s", 0.0, 600.0)],
        meaning: |[time_s, ..]| Meaning::Step(Command::Hold { time_s }),
        ..ALONE
    },
    Declaration {
        name: "setReference",
        help: "the place from which `goto` counts",
        example: "setReference $POSE$",
        numbers: POSE,
        words: &[("$POSE$", Command::SetReferenceHere), ("$START$", Command::SetReferenceStart)],
        meaning: |numbers| Meaning::Step(Command::SetReference(pose(numbers))),
        ..ALONE
    },
    Declaration {
        name: "setInitialReachDist",
        help: "how near a target is reached",
        example: "setInitialReachDist 0.2",
        numbers: &[number("distance", "m", 0.01, 10.0)],
        meaning: |[distance_m, ..]| Meaning::Step(Command::SetReachDistance { distance_m }),
        ..ALONE
    },
    Declaration {
        name: "setStayWithinDist",
        help: "how far the drone may stray while it stays",
        example: "setStayWithinDist 0.5",
        numbers: &[number("distance", "m", 0.01, 10.0)],
        meaning: |[distance_m, ..]| Meaning::Step(Command::SetStayDistance { distance_m }),
        ..ALONE
    },
    Declaration {
        name: "setStayTime",
        help: "a time to stay at targets",
        example: "setStayTime 5",
        numbers: &[number("time", "s", 0.0, 600.0)],
        meaning: |[time_s, ..]| Meaning::Step(Command::SetStayTime { time_s }),
        ..ALONE
    },
    Declaration {
        name: "setSpeed",
        help: "a limit of the speed",
        example: "setSpeed 0.5",
        numbers: &[number("speed", "m/s", 0.05, 10.0)],
        meaning: |[speed_m_s, ..]| Meaning::Step(Command::SetSpeed { speed_m_s }),
        ..ALONE
    },
    Declaration {
        name: "setMaxControl",
        help: "a limit of the sticks",
        example: "setMaxControl 0.5",
        numbers: &[number("fraction", "of the sticks", 0.05, 1.0)],
        meaning: |[fraction, ..]| Meaning::Step(Command::SetMaxControl { fraction }),
        ..ALONE
    },
    Declaration {
        name: "tag",
        help: "a tag on the floor",
        example: "tag 0 1",
        numbers: &[
            metres("x", "m right"),
            metres("y", "m forward"),
            number("heading", "° clockwise", -360.0, 360.0),
        ],
        optional: 1,
        meaning: |[x_m, y_m, heading_deg, _]| {
            let heading_deg = (!heading_deg.is_nan()).then_some(heading_deg);
            Meaning::Tag(SurveyedTag { place_m: Vector2::new(x_m, y_m), heading_deg })
        },
        ..ALONE
    },
    Declaration {
        name: "findTag",
        help: "find a tag",
        example: "findTag",
        meaning: |_| Meaning::Step(Command::FindTag),
        ..ALONE
    },
    Declaration {
        name: "landOnTag",
        help: "land on a tag",
        example: "landOnTag",
        meaning: |_| Meaning::Step(Command::LandOnTag),
        ..ALONE
    },
    Declaration {
        name: "clearCommands",
        help: "drop the commands before it",
        note: Some("drops the commands before it"),
        meaning: |_| Meaning::Clears,
        ..ALONE
    },
    Declaration {
        name: "autoInit",
        help: "take off",
        numbers: MAPPING,
        optional: MAPPING.len(),
        note: Some("takes off; there is no visual map to initialise"),
        meaning: |_| Meaning::Step(Command::TakeOff { take_over: false }),
        ..ALONE
    },
    Declaration {
        name: "autoTakeover",
        help: "take over a drone in the air, or take off",
        numbers: MAPPING,
        optional: MAPPING.len(),
        note: Some("takes over, or takes off; there is no visual map to initialise"),
        meaning: |_| Meaning::Step(Command::TakeOff { take_over: true }),
        ..ALONE
    },
    Declaration {
        name: "lockScaleFP",
        help: "nothing",
        note: Some("does nothing; there is no visual map to scale"),
        ..ALONE
    },
    Declaration {
        name: "version",
        help: "the version of this language, before all other commands",
        numbers: &[number("number", "", 0.0, f64::MAX)],
        meaning: |[number, ..]| Meaning::Version(number),
        ..ALONE
    },
];
