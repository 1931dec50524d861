//! Authority of operators: several may give orders, one of them has the controls.

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};

/// Someone who gives orders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Operator {
    /// Where the orders come from.
    pub station: Station,
    /// Distinguishes operators at stations of the same kind; by `MAVLink` the system in the upper byte, and its
    /// component.
    pub number: u16,
    /// Whether the operator is at the machine that runs the program. A local operator takes the controls from
    /// whoever has them; remote ones, `MAVLink` stations and the agent get them only if they are free or the agent has them.
    pub local: bool,
}

/// Where orders come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Station {
    /// The terminal in which the program was started, and its command line.
    Terminal,
    /// A program that writes orders to this program's standard input.
    Program,
    /// A page in a browser.
    Browser,
    /// A ground station that speaks `MAVLink`.
    Mavlink,
    /// The agent that has the place of a flight plan. It yields to every person and program.
    Agent,
}

impl Station {
    /// All stations.
    pub const ALL: [Self; 5] =
        [Self::Terminal, Self::Program, Self::Browser, Self::Mavlink, Self::Agent];

    /// Its name in logs and messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terminal => "terminal",
            Self::Program => "program",
            Self::Browser => "browser",
            Self::Mavlink => "mavlink",
            Self::Agent => "agent",
        }
    }
}

impl Station {
    /// Whether an operator who has the controls at such a station must be heard all the time: a program elsewhere that
    /// falls silent may have ended without a word.
    fn must_be_heard(self) -> bool {
        self == Self::Mavlink
    }
}

impl Operator {
    /// The operator who started the program.
    pub const TERMINAL: Self = Self { station: Station::Terminal, number: 0, local: true };
    /// The program connected to standard input.
    pub const PROGRAM: Self = Self { station: Station::Program, number: 0, local: true };

    /// The agent that has the place of a flight plan.
    pub const AGENT: Self = Self { station: Station::Agent, number: 0, local: true };

    /// Whether this operator may take the controls from others. `MAVLink` has no login: its stations get them
    /// only if they are free.
    fn takes_controls(self) -> bool {
        self.local && !matches!(self.station, Station::Mavlink | Station::Agent)
    }

    /// Whether everybody else may take the controls from this operator.
    pub(super) fn yields(self) -> bool {
        self.station == Station::Agent
    }
}

impl fmt::Display for Operator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.station == Station::Agent {
            return f.write_str("the agent");
        }
        f.write_str(if self.local { "the local " } else { "the remote " })?;
        f.write_str(self.station.name())?;
        match self.number {
            0 => Ok(()),
            // System and component, as `MAVLink` programs write them.
            number if self.station == Station::Mavlink => {
                let [system, component] = number.to_be_bytes();
                write!(f, " {system}.{component}")
            }
            number => write!(f, " {number}"),
        }
    }
}

/// Which operator has the controls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Controls {
    holder: Option<Operator>,
    /// When the holder was last heard.
    heard: Duration,
    /// Who gave the last order by which the drone flies, and when that one was last heard: while nobody has the controls, it
    /// flies on for that one.
    flies_for: Option<(Operator, Duration)>,
}

impl Controls {
    pub(super) fn holder(self) -> Option<Operator> {
        self.holder
    }

    /// An operator was heard.
    pub(super) fn heard(&mut self, now: Duration, by: Operator) {
        if self.holder == Some(by) {
            self.heard = now;
        }
        if let Some((operator, heard)) = &mut self.flies_for
            && *operator == by
        {
            *heard = now;
        }
    }

    /// An operator has ordered what the drone does from now on.
    pub(super) fn has_ordered(&mut self, now: Duration, by: Operator) {
        self.flies_for = Some((by, now));
    }

    /// Silence of the operator in control, or else of the one for whom the drone flies; zero for one who need not be heard.
    /// Who takes the controls and only gives them back has ordered nothing.
    pub(super) fn silence(self, now: Duration) -> Duration {
        let watched = self.holder.map(|holder| (holder, self.heard)).or(self.flies_for);
        match watched {
            Some((operator, heard)) if operator.station.must_be_heard() => {
                now.saturating_sub(heard)
            }
            _ => Duration::ZERO,
        }
    }

    /// Admits an order that anyone may give. It gives the controls to the first operator who orders anything,
    /// and moves them from a remote operator, or one who cannot take them, to a local one, whom that one must not
    /// overrule afterwards.
    pub(super) fn admit_any(&mut self, by: Operator) {
        let moves = |holder: Operator| {
            by.takes_controls() && !holder.takes_controls() || holder.yields() && !by.yields()
        };
        if self.holder.is_none_or(moves) {
            self.holder = Some(by);
        }
    }

    /// Admits an order that needs the controls. A local operator takes them from a remote one; a remote
    /// operator gets them only if they are free or an agent has them.
    ///
    /// # Errors
    /// The operator who has the controls.
    pub(super) fn admit(&mut self, by: Operator) -> Result<(), Operator> {
        match self.holder {
            Some(holder) if holder != by && !by.takes_controls() && !holder.yields() => Err(holder),
            _ => {
                self.holder = Some(by);
                Ok(())
            }
        }
    }

    /// Releases the controls if this operator has them.
    pub(super) fn release(&mut self, by: Operator) {
        self.holder.take_if(|holder| *holder == by);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: Operator = Operator { station: Station::Browser, number: 1, local: false };
    const STATION: Operator = Operator { station: Station::Mavlink, number: 1, local: false };

    #[test]
    fn a_local_operator_takes_the_controls_and_a_remote_one_does_not() {
        let mut controls = Controls::default();
        assert_eq!(controls.admit(PAGE), Ok(()));
        assert_eq!(controls.admit(STATION), Err(PAGE));
        assert_eq!(controls.admit(Operator::TERMINAL), Ok(()));
        assert_eq!(controls.admit(PAGE), Err(Operator::TERMINAL));
        assert_eq!(controls.admit(Operator::PROGRAM), Ok(()), "both are local");
        controls.release(PAGE);
        assert_eq!(controls.holder(), Some(Operator::PROGRAM));
        controls.release(Operator::PROGRAM);
        assert_eq!(controls.admit(STATION), Ok(()));
    }

    #[test]
    fn what_anyone_may_order_takes_the_controls_for_local_operators_only() {
        let mut controls = Controls::default();
        controls.admit_any(PAGE);
        assert_eq!(controls.holder(), Some(PAGE));
        controls.admit_any(STATION);
        assert_eq!(controls.holder(), Some(PAGE));
        controls.admit_any(Operator::TERMINAL);
        assert_eq!(controls.holder(), Some(Operator::TERMINAL));
        controls.admit_any(PAGE);
        controls.admit_any(Operator::PROGRAM);
        assert_eq!(controls.holder(), Some(Operator::TERMINAL));
    }

    #[test]
    fn a_drone_flies_on_for_whoever_ordered_it_last() {
        let second = Duration::from_secs;
        let mut controls = Controls::default();
        assert_eq!(controls.admit(STATION), Ok(()));
        controls.has_ordered(second(1), STATION);
        controls.heard(second(1), STATION);
        assert_eq!(controls.silence(second(5)), second(4));
        // Somebody is there who need not be heard, and leaves it alone again.
        assert_eq!(controls.admit(Operator::TERMINAL), Ok(()));
        controls.heard(second(6), Operator::TERMINAL);
        assert_eq!(controls.silence(second(7)), Duration::ZERO);
        controls.release(Operator::TERMINAL);
        assert_eq!(controls.silence(second(8)), second(7));
        controls.heard(second(8), STATION);
        assert_eq!(controls.silence(second(9)), second(1));
        // It was there all the time that somebody else had them.
        assert_eq!(controls.admit(Operator::TERMINAL), Ok(()));
        controls.heard(second(60), STATION);
        controls.release(Operator::TERMINAL);
        assert_eq!(controls.silence(second(61)), second(1));
        controls.has_ordered(second(61), Operator::TERMINAL);
        assert_eq!(controls.silence(second(9)), Duration::ZERO);
    }

    #[test]
    fn an_agent_yields_to_everybody_and_takes_from_nobody() {
        for by in [Operator::TERMINAL, Operator::PROGRAM, PAGE, STATION] {
            let mut controls = Controls::default();
            assert_eq!(controls.admit(Operator::AGENT), Ok(()));
            assert_eq!(controls.admit(by), Ok(()), "{by}");
            assert_eq!(controls.admit(Operator::AGENT), Err(by));
            controls.admit_any(Operator::AGENT);
            assert_eq!(controls.holder(), Some(by));
            controls.release(by);
            assert_eq!(controls.admit(Operator::AGENT), Ok(()));
            // A hold or a landing takes them, too: the agent must not overrule it.
            controls.admit_any(by);
            assert_eq!(controls.holder(), Some(by));
        }
    }

    #[test]
    fn operators_have_names() {
        assert_eq!(Operator::TERMINAL.to_string(), "the local terminal");
        assert_eq!(PAGE.to_string(), "the remote browser 1");
        assert_eq!(Operator::AGENT.to_string(), "the agent");
        let system_and_component = Operator { number: 0xffbe, ..STATION };
        assert_eq!(system_and_component.to_string(), "the remote mavlink 255.190");
        for station in Station::ALL {
            assert_eq!(station.name(), format!("{station:?}").to_lowercase());
        }
    }
}
