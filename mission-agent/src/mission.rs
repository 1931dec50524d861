//! A mission agent and its vehicle: what it senses of it, and its wishes as orders.

use std::time::Duration;

use arrayvec::ArrayVec;
use autopilot::Vehicle;
use autopilot::outcome::Outcome;
use autopilot::plan::Commands;
use autopilot::vehicle::{
    Heading, Horizontal, ManualControl, Operator, OperatorOrder, Phase, Place, Refused, Setpoint,
    Status, Vertical,
};
use kinematics::Pose;

use crate::boundary::{Outbox, Said, Sensed, Step, Wanted};
use crate::built_in::{self, NoAgent, Translated};

/// After an order was refused, it is not given again for so long.
const PATIENCE: Duration = Duration::from_secs(1);

/// Why a line is not understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Misunderstood {
    /// It is no message of this agent.
    #[error("it is no message")]
    NoMessage,
    /// Its sender was translated with other messages.
    #[error("it is of version {theirs:016x} of the messages, and not of {ours:016x}")]
    OtherVersion {
        /// The agent's own.
        ours: u64,
        /// The sender's.
        theirs: u64,
    },
    /// It is from the agent itself.
    #[error("it is from the agent itself")]
    Oneself,
    /// Its sender may not say that, or there is no room for more.
    #[error("it is refused")]
    Refused,
    /// The agent talks with nobody.
    #[error("the agent talks with nobody")]
    DoesNotTalk,
}

/// An agent that has the place of a flight plan.
#[derive(Debug)]
pub struct MissionAgent {
    agent: Box<dyn Translated>,
    places: Vec<Pose>,
    take_off: Commands,
    land: Commands,
    land_on_tag: Commands,
    uses_tags: bool,
    /// What goes on by its order.
    ordered: Option<Wanted>,
    /// No order is given before.
    waits_until: Duration,
    /// It wants nothing more.
    is_finished: bool,
    outbox: Outbox,
}

impl MissionAgent {
    /// A new agent of a vehicle, by the name under which it is built in. It may ask for the `places`, and whether the drone is
    /// asked to find tags: `uses_tags`.
    ///
    /// # Errors
    /// [`NoAgent`] if there is none, or the vehicle is none of its peers.
    ///
    /// # Panics
    /// If the plan language has no commands any more to take off and to land.
    pub fn new(
        name: &str,
        vehicle: &str,
        places: Vec<Pose>,
        uses_tags: bool,
    ) -> Result<Self, NoAgent> {
        let commands = |text: &str| {
            Commands::parse("agent", text).expect("these are commands of the plan language")
        };
        Ok(Self {
            agent: built_in::new(name, vehicle)?,
            places,
            take_off: commands("clearCommands\ntakeoff"),
            land: commands("clearCommands\nland"),
            land_on_tag: commands("clearCommands\nlandOnTag"),
            uses_tags,
            ordered: None,
            waits_until: Duration::ZERO,
            is_finished: false,
            outbox: Outbox::default(),
        })
    }

    /// The names of the vehicles with which it talks, its own among them.
    pub fn peers(&self) -> &'static [&'static str] {
        self.agent.peers()
    }

    /// Number of lines that it could not say: longer than [`MAX_LINE`](crate::MAX_LINE), or more than 64 before
    /// [`take_said`](Self::take_said).
    pub fn unsaid(&self) -> u64 {
        self.outbox.unsaid
    }

    /// Whether its mission is over: nothing flies any more, and either it is finished, or its flight ended otherwise than by its
    /// own orders. It does not fly again then, whatever it wants.
    pub fn is_over(&self, vehicle: &Vehicle) -> bool {
        vehicle.is_at_rest() && (self.is_finished || is_lost(vehicle))
    }

    /// Takes what it has said.
    pub fn take_said(&mut self) -> impl Iterator<Item = Said> {
        self.outbox.said.drain(..)
    }

    /// A peer says something. `now` is the time since the program started, as in [`step`](Self::step).
    ///
    /// # Errors
    /// [`Misunderstood`]. Nothing has changed then.
    pub fn hear(&mut self, now: Duration, line: &str) -> Result<(), Misunderstood> {
        let sensed = Sensed { now_ms: milliseconds(now), ..Sensed::default() };
        let me = self.agent.me();
        self.agent.hear(&mut Step::new(sensed, &self.places, me, &mut self.outbox), line)
    }

    /// One step; returns what it orders. The orders are given one after the other; once one is
    /// [`refused`](Self::refused), those after it are not given.
    pub fn step(&mut self, now: Duration, vehicle: &Vehicle) -> ArrayVec<OperatorOrder, 2> {
        let status = vehicle.status(now);
        let obeyed =
            status.controls.is_none_or(|holder| holder == Operator::AGENT) && !is_lost(vehicle);
        let flying = status.phase == Phase::Flying
            && status.airborne
            && (status.step.is_none() || status.manual.is_some());
        let sensed = Sensed {
            now_ms: milliseconds(now),
            pose: status.pose,
            battery_percent: status.battery_percent,
            on_ground: !status.airborne,
            flying,
            obeyed,
            tags_in_use: self.uses_tags,
        };
        let mut step = Step::new(sensed, &self.places, self.agent.me(), &mut self.outbox);
        self.agent.step(&mut step);
        let wanted = step.wanted;
        self.is_finished |= wanted == Wanted::Finish;
        if !obeyed || now < self.waits_until {
            // What somebody else has ordered meanwhile is not what this agent has.
            self.ordered = self.ordered.filter(|_| obeyed);
            return ArrayVec::new();
        }
        self.orders(wanted, &status, vehicle, flying)
    }

    /// An order was refused: it is given again, but not within 1 s.
    pub fn refused(&mut self, now: Duration, _: &Refused) {
        self.ordered = None;
        self.waits_until = now + PATIENCE;
    }

    fn orders(
        &mut self,
        wanted: Wanted,
        status: &Status,
        vehicle: &Vehicle,
        flying: bool,
    ) -> ArrayVec<OperatorOrder, 2> {
        let mut orders = ArrayVec::new();
        let is_new = self.ordered != Some(wanted);
        match wanted {
            Wanted::TakeOff if vehicle.is_at_rest() && !status.airborne => {
                orders.push(OperatorOrder::Append(self.take_off.clone()));
                orders.push(OperatorOrder::Start { when_ready: true });
            }
            Wanted::Hover if flying && is_new => {
                // After a take-off it holds by itself.
                if status.manual.is_some() {
                    orders.push(OperatorOrder::Hold);
                }
            }
            Wanted::FlyTo(place) if flying && is_new => {
                orders.push(OperatorOrder::GoTo(place_of(place)));
            }
            Wanted::Follow(place) if flying => {
                let follows = status.manual == Some(ManualControl::Setpoints)
                    && matches!(self.ordered, Some(Wanted::Follow(_)));
                let setpoint = setpoint(place);
                orders.push(if follows {
                    OperatorOrder::Setpoint(setpoint)
                } else {
                    OperatorOrder::Follow(setpoint)
                });
            }
            Wanted::Land { on_tag } if flying && is_new => {
                let land = if on_tag { &self.land_on_tag } else { &self.land };
                orders.push(OperatorOrder::Append(land.clone()));
                if status.mission_waits {
                    orders.push(OperatorOrder::Resume);
                }
            }
            // To keep, to finish, what goes on already, and what cannot be done now.
            _ => return orders,
        }
        self.ordered = Some(wanted);
        orders
    }
}

/// Whether the last flight has ended otherwise than by its mission.
fn is_lost(vehicle: &Vehicle) -> bool {
    vehicle.outcome().is_some_and(|outcome| *outcome != Outcome::Completed)
}

fn milliseconds(now: Duration) -> i64 {
    i64::try_from(now.as_millis()).unwrap_or(i64::MAX)
}

fn place_of(Pose { x_m, y_m, z_m, yaw_deg }: Pose) -> Place {
    Place { x_m: Some(x_m), y_m: Some(y_m), height_m: Some(z_m), yaw_deg: Some(yaw_deg) }
}

fn setpoint(Pose { x_m, y_m, z_m, yaw_deg }: Pose) -> Setpoint {
    Setpoint {
        horizontal: Horizontal::Place { x_m, y_m },
        vertical: Vertical::Height(z_m),
        heading: Heading::Yaw(yaw_deg),
    }
}

#[cfg(test)]
mod tests {
    use autopilot::vehicle::VehicleConfig;

    use super::*;

    fn names_of(orders: &[OperatorOrder]) -> Vec<&'static str> {
        orders.iter().map(OperatorOrder::name).collect()
    }

    #[test]
    fn an_agent_is_one_of_its_peers() {
        assert!(MissionAgent::new("keeper", "keeper", Vec::new(), false).is_ok());
        let error = MissionAgent::new("keeper", "ada", Vec::new(), false).unwrap_err().to_string();
        assert_eq!(error, "the agent `keeper` is one of keeper, left, right, and no `ada`");
        let error = MissionAgent::new("nobody", "ada", Vec::new(), false).unwrap_err().to_string();
        assert!(error.starts_with("no agent is called `nobody`: built in are "), "{error}");
    }

    #[test]
    fn a_take_off_is_two_orders_and_not_repeated_at_once_if_refused() {
        let mut agent = MissionAgent::new("traveller", "left", Vec::new(), false).unwrap();
        let mut vehicle = Vehicle::new(&VehicleConfig::default()).unwrap();
        let orders = agent.step(Duration::ZERO, &vehicle);
        assert_eq!(names_of(&orders), ["append", "start"]);
        agent.refused(Duration::ZERO, &Refused::NoMission);
        assert!(agent.step(Duration::from_millis(990), &vehicle).is_empty());
        let orders = agent.step(PATIENCE, &vehicle);
        assert_eq!(names_of(&orders), ["append", "start"]);
        for order in orders {
            let order = autopilot::vehicle::Input::Order(Operator::AGENT, order);
            assert_eq!(vehicle.handle(PATIENCE, order), Ok(()));
        }
        assert!(agent.step(PATIENCE, &vehicle).is_empty(), "it is about to fly");
    }

    #[test]
    fn who_has_the_controls_is_not_disturbed() {
        let mut agent = MissionAgent::new("traveller", "left", Vec::new(), false).unwrap();
        let mut vehicle = Vehicle::new(&VehicleConfig::default()).unwrap();
        let take = autopilot::vehicle::Input::Order(Operator::TERMINAL, OperatorOrder::Take);
        assert_eq!(vehicle.handle(Duration::ZERO, take), Ok(()));
        assert!(agent.step(Duration::ZERO, &vehicle).is_empty());
    }
}
