//! What the agent says besides its command: dangers, and how its orders ended.

use std::fmt;

/// Reason for which the agent lands, or warns of a landing, or what it has to say of tags.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Danger {
    /// The battery is nearly empty: a warning.
    BatteryLow,
    /// The battery is too low to fly on.
    BatteryEmpty,
    /// No usable navdata.
    Blind,
    /// The position uncertainty is too large.
    Lost,
    /// The wind is stronger than the drone.
    Wind,
    /// A take-off, or an approach, exceeded its time limit.
    NoProgress,
    /// The place is doubtful, and a tag is looked for: not a danger by itself.
    Searching,
    /// There is no tag to be found.
    NoTag,
    /// The tag to land on is not seen any more.
    TagLost,
    /// The setpoints that were followed have not come for too long.
    SetpointsGone,
    /// The ground station that has the controls is silent: a warning, in every step.
    StationSilent,
    /// It has been silent for too long.
    StationGone,
}

impl Danger {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::BatteryLow,
        Self::BatteryEmpty,
        Self::Blind,
        Self::Lost,
        Self::Wind,
        Self::NoProgress,
        Self::Searching,
        Self::NoTag,
        Self::TagLost,
        Self::SetpointsGone,
        Self::StationSilent,
        Self::StationGone,
    ];

    /// Its name in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::BatteryLow => "BatteryLow",
            Self::BatteryEmpty => "BatteryEmpty",
            Self::Blind => "Blind",
            Self::Lost => "Lost",
            Self::Wind => "Wind",
            Self::NoProgress => "NoProgress",
            Self::Searching => "Searching",
            Self::NoTag => "NoTag",
            Self::TagLost => "TagLost",
            Self::SetpointsGone => "SetpointsGone",
            Self::StationSilent => "StationSilent",
            Self::StationGone => "StationGone",
        }
    }
}

impl fmt::Display for Danger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BatteryLow => "the battery is nearly empty",
            Self::BatteryEmpty => "the battery is too low to fly on",
            Self::Blind => "there are no usable navdata",
            Self::Lost => "the position uncertainty is too large",
            Self::Wind => "the wind is stronger than the drone",
            Self::NoProgress => "what was ordered takes too long",
            Self::Searching => "the position is doubtful, and a tag is looked for",
            Self::NoTag => "no tag was found",
            Self::TagLost => "the tag to land on is not seen any more",
            Self::SetpointsGone => "setpoints have not come for too long",
            Self::StationSilent => "the ground station is silent",
            Self::StationGone => "the ground station has been silent for too long",
        })
    }
}

/// How the agent's last order ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Report {
    /// It was carried out.
    Done,
    /// It was not accepted.
    Refused,
    /// It was given up.
    Failed,
    /// It was set aside, and is to be given again when somebody resumes it.
    Paused,
}

/// As the end of a sentence about the order.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Done => "was carried out",
            Self::Refused => "was not accepted",
            Self::Failed => "was given up",
            Self::Paused => "was set aside until somebody resumes it",
        })
    }
}

impl Report {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Done, Self::Refused, Self::Failed, Self::Paused];

    /// Its name in logs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "Done",
            Self::Refused => "Refused",
            Self::Failed => "Failed",
            Self::Paused => "Paused",
        }
    }
}
