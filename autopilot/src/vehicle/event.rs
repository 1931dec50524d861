//! What happens in a flight.

use std::fmt;

use diagnostic::printable;

use super::{CrossCheck, LandingReason, Operator};
use crate::safety::Veto;

/// Something that happened in a flight.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FlightEvent {
    /// The drone answered.
    Connected,
    /// The drone's configuration was read back.
    ConfigurationRead {
        /// Firmware version, if the drone sent it.
        version: Option<String>,
    },
    /// The drone's configuration could not be read back.
    ConfigurationNotRead,
    /// The drone does not send its clock: time is taken from the arrival of packets.
    NoDroneClock,
    /// The drone does not confirm that it looks for tags: the position may drift.
    NoTagDetection,
    /// The drone does not confirm the bit rate of the video.
    NoVideoRate,
    /// The settings are complete, apart from those that the drone did not confirm, and the level reference is being set if it
    /// stands on the ground.
    Configured,
    /// The drone is already in the air, and the plan takes it over.
    TakingOver,
    /// A step of the plan has begun.
    StepStarted {
        /// Index of the step.
        step: usize,
    },
    /// A step of the plan was carried out.
    StepDone {
        /// Index of the step.
        step: usize,
    },
    /// A target was moved into the fence.
    TargetCorrected {
        /// Index of the step.
        step: usize,
    },
    /// The plan was given up and the drone is being landed.
    LandingOrdered(LandingReason),
    /// The drone stopped answering.
    LinkLost,
    /// The drone cut its motors.
    Emergency,
    /// The battery is nearly empty: a warning.
    BatteryLow {
        /// Remaining charge.
        percent: u32,
    },
    /// The place has become doubtful: a tag is looked for.
    SearchingTag,
    /// No tag was found.
    NoTagFound,
    /// The tag to land on is not seen any more: the drone lands where it is.
    TagLost,
    /// Something else that knows of the place contradicts it.
    PlaceContradicted {
        /// What.
        by: CrossCheck,
    },
    /// The drone's emergency state was cleared.
    EmergencyCleared,
    /// The drone is on the ground again.
    Landed,
    /// Another pilot flies the drone: nothing is sent to it until it is on the ground.
    FlownByAnother,
    /// A mission was loaded.
    MissionLoaded {
        /// Number of its steps.
        steps: usize,
    },
    /// Commands were appended to the mission.
    MissionExtended {
        /// Number of its steps now.
        steps: usize,
    },
    /// The mission was cleared.
    MissionCleared,
    /// Another operator has the controls now.
    ControlsTaken {
        /// The new holder.
        by: Operator,
    },
    /// An operator has paused the mission; the drone holds.
    Held,
    /// An operator flies by stick.
    Steered,
    /// An operator has sent the drone to a manual target.
    ManualTargetSet,
    /// The manual target was reached.
    ManualTargetReached,
    /// An operator's setpoints are followed.
    FollowingSetpoints,
    /// The setpoints have stopped coming: the drone holds.
    SetpointsSilent,
    /// The ground station that has the controls is silent: a warning.
    StationSilent,
    /// It has been silent for so long that the mission is paused.
    PausedForStation,
    /// The mission was resumed.
    Resumed,
    /// An operator has ordered the motors to be cut.
    CutOrdered,
    /// The safety layer has replaced a command.
    Veto(Veto),
}

impl FlightEvent {
    /// Whether the event deserves the operator's attention.
    pub fn warns(&self) -> bool {
        match self {
            Self::Connected
            | Self::ConfigurationRead { .. }
            | Self::NoDroneClock
            | Self::Configured
            | Self::TakingOver
            | Self::StepStarted { .. }
            | Self::StepDone { .. }
            | Self::EmergencyCleared
            | Self::Landed
            | Self::MissionLoaded { .. }
            | Self::MissionExtended { .. }
            | Self::MissionCleared
            | Self::Held
            | Self::Steered
            | Self::ManualTargetSet
            | Self::ManualTargetReached
            | Self::FollowingSetpoints
            | Self::Resumed => false,
            Self::ConfigurationNotRead
            | Self::NoTagDetection
            | Self::NoVideoRate
            | Self::TargetCorrected { .. }
            | Self::LandingOrdered(_)
            | Self::LinkLost
            | Self::Emergency
            | Self::BatteryLow { .. }
            | Self::SearchingTag
            | Self::NoTagFound
            | Self::TagLost
            | Self::PlaceContradicted { .. }
            | Self::FlownByAnother
            | Self::ControlsTaken { .. }
            | Self::SetpointsSilent
            | Self::StationSilent
            | Self::PausedForStation
            | Self::CutOrdered
            | Self::Veto(_) => true,
        }
    }
}

impl fmt::Display for FlightEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connected => f.write_str("drone found"),
            Self::ConfigurationRead { version: Some(version) } => {
                // The version string comes over the network, so it may contain anything.
                write!(f, "configuration read back, firmware {}", printable(version))
            }
            Self::ConfigurationRead { version: None } => f.write_str("configuration read back"),
            Self::ConfigurationNotRead => f.write_str(
                "configuration could not be read back: the drone's limits are not known",
            ),
            Self::NoDroneClock => {
                f.write_str("the drone does not send its clock: taking the arrival of packets")
            }
            Self::NoTagDetection => f.write_str(
                "the drone does not confirm that it looks for tags: the position may drift as without them",
            ),
            Self::NoVideoRate => {
                f.write_str("the drone does not confirm the bit rate of the video: it may have another one")
            }
            Self::Configured => f.write_str("drone configured, level reference set"),
            Self::TakingOver => f.write_str("the drone flies: taking it over"),
            Self::StepStarted { step } => write!(f, "step {}", step + 1),
            Self::StepDone { step } => write!(f, "step {} done", step + 1),
            Self::TargetCorrected { step } => {
                write!(f, "step {}: target moved into the fence", step + 1)
            }
            Self::LandingOrdered(reason) => write!(f, "landing: {reason}"),
            Self::LinkLost => f.write_str("link lost: ordering the landing blindly"),
            Self::Emergency => f.write_str("EMERGENCY: the drone has cut its motors"),
            Self::BatteryLow { percent } => write!(f, "battery at {percent} %: land soon"),
            Self::SearchingTag => f.write_str("the position is doubtful: looking for a tag"),
            Self::NoTagFound => f.write_str("no tag found"),
            Self::TagLost => {
                f.write_str("the tag to land on is not seen any more: landing here")
            }
            Self::PlaceContradicted { by } => {
                write!(f, "{by} contradicts the position: the drone may be elsewhere")
            }
            Self::EmergencyCleared => f.write_str("emergency cleared"),
            Self::Landed => f.write_str("landed"),
            Self::FlownByAnother => f.write_str(
                "another pilot flies the drone: nothing is sent to it until it has landed",
            ),
            Self::MissionLoaded { steps } => write!(f, "mission loaded: {}", counted(*steps)),
            Self::MissionExtended { steps } => write!(f, "mission extended: {}", counted(*steps)),
            Self::MissionCleared => f.write_str("mission cleared"),
            Self::ControlsTaken { by } => write!(f, "{by} has taken the controls"),
            Self::Held => f.write_str("holding"),
            Self::Steered => f.write_str("manual control"),
            Self::ManualTargetSet => f.write_str("flying to a manual target"),
            Self::ManualTargetReached => f.write_str("manual target reached"),
            Self::FollowingSetpoints => f.write_str("following setpoints"),
            Self::SetpointsSilent => f.write_str("setpoints have stopped: holding"),
            Self::StationSilent => f.write_str("the ground station is silent"),
            Self::PausedForStation => {
                f.write_str("the ground station is silent: holding, mission paused")
            }
            Self::Resumed => f.write_str("mission resumed"),
            Self::CutOrdered => f.write_str("EMERGENCY CUT ordered"),
            Self::Veto(veto) => veto.fmt(f),
        }
    }
}

fn counted(steps: usize) -> String {
    match steps {
        1 => "1 step".to_owned(),
        steps => format!("{steps} steps"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_wrong_warns_and_what_is_planned_does_not() {
        let wrong = [
            FlightEvent::LinkLost,
            FlightEvent::Emergency,
            FlightEvent::LandingOrdered(LandingReason::Wind),
            FlightEvent::Veto(Veto::NearFence),
            FlightEvent::TargetCorrected { step: 0 },
        ];
        assert!(wrong.iter().all(FlightEvent::warns));
        let planned =
            [FlightEvent::Connected, FlightEvent::StepDone { step: 0 }, FlightEvent::Landed];
        assert!(!planned.iter().any(FlightEvent::warns));
    }

    #[test]
    fn one_step_is_not_several() {
        let loaded = |steps| FlightEvent::MissionLoaded { steps }.to_string();
        assert_eq!(loaded(1), "mission loaded: 1 step");
        assert_eq!(loaded(2), "mission loaded: 2 steps");
        assert_eq!(loaded(0), "mission loaded: 0 steps");
    }
}
