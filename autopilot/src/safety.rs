//! What the agent may not overrule: checked once more, after the decision and before the wire.

use std::time::Duration;

use crate::agent::AgentCommand;

/// Navdata older than this is no basis for moving.
const STALE: Duration = Duration::from_millis(300);

/// Why a command was replaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Veto {
    /// The newest navdata is too old: hover instead of flying on.
    StaleNavdata,
    /// The drone is in its emergency state: it is never asked to fly.
    Emergency,
}

/// What the safety layer looks at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Circumstances {
    /// Age of the newest navdata.
    pub silence: Duration,
    /// The drone's motors are cut.
    pub emergency: bool,
}

/// The command itself, or a safer one and the reason.
pub fn check(command: AgentCommand, now: Circumstances) -> (AgentCommand, Option<Veto>) {
    let flies = !matches!(command, AgentCommand::Standby | AgentCommand::Land);
    if now.emergency && flies {
        return (AgentCommand::Standby, Some(Veto::Emergency));
    }
    if now.silence > STALE && matches!(command, AgentCommand::GoTo(_)) {
        return (AgentCommand::Hover, Some(Veto::StaleNavdata));
    }
    (command, None)
}

#[cfg(test)]
mod tests {
    use pid::Pose;

    use super::*;

    const FRESH: Circumstances = Circumstances { silence: Duration::ZERO, emergency: false };

    #[test]
    fn only_what_moves_the_drone_needs_fresh_navdata() {
        let stale = Circumstances { silence: Duration::from_millis(301), ..FRESH };
        let go_to = AgentCommand::GoTo(Pose::default());
        assert_eq!(check(go_to, FRESH), (go_to, None));
        assert_eq!(check(go_to, stale), (AgentCommand::Hover, Some(Veto::StaleNavdata)));
        assert_eq!(check(AgentCommand::Land, stale), (AgentCommand::Land, None));
    }

    #[test]
    fn nothing_flies_in_an_emergency() {
        let emergency = Circumstances { emergency: true, ..FRESH };
        for command in
            [AgentCommand::TakeOff, AgentCommand::Hover, AgentCommand::GoTo(Pose::default())]
        {
            let vetoed = (AgentCommand::Standby, Some(Veto::Emergency));
            assert_eq!(check(command, emergency), vetoed);
        }
        assert_eq!(check(AgentCommand::Land, emergency), (AgentCommand::Land, None));
    }
}
