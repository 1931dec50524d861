//! What an operator can order, also as text: in logs, and from programs.

use std::convert::Infallible;

use ardrone_link::settings::Camera;
use kinematics::Sticks;
use serde::{Deserialize, Serialize};

use super::Setpoint;
use crate::plan::{Commands, FlightLimits, Plan, PlanError, TagUse};

/// An order from an operator.
///
/// Anyone may give [`Hold`](Self::Hold), [`Land`](Self::Land) and [`Cut`](Self::Cut); every other order but
/// [`Camera`](Self::Camera), [`Present`](Self::Present) and [`Release`](Self::Release) needs the controls, see
/// [`Operator`](super::Operator).
///
/// In logs and in what programs send a plan and commands are texts: [`OrderText`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "order", rename_all = "lowercase")]
pub enum OperatorOrder<P = Plan, C = Commands> {
    /// Replace the mission. On the ground the new mission waits for [`Start`](Self::Start). In the air the
    /// drone holds and flies the new mission at once, unless the mission was paused. Coordinates are still
    /// relative to the take-off of the current flight.
    Load(P),
    /// Append commands to the mission, before a landing that its plan does not contain but implies. After the
    /// end of a mission they begin a new one.
    Append(C),
    /// Clear the mission. In the air the drone holds.
    Clear,
    /// Start the mission, or resume it where it was paused.
    Start {
        /// Wait, for a limited time, for a drone that is not ready yet.
        #[serde(default)]
        when_ready: bool,
    },
    /// Hold position; the mission is paused.
    Hold,
    /// Resume the mission.
    Resume,
    /// Manual control: stick fractions with the drone's signs. They expire after 600 ms unless repeated, those of a
    /// browser's page after 250 ms.
    Steer(Sticks),
    /// Fly to this place and stay there; the mission is paused. A place near or outside the fence is moved inside.
    GoTo(Place),
    /// Follow setpoints, of which this is the first; the mission is paused. If the next ones stop coming for 0.5 s the
    /// drone holds, and ten seconds later it lands.
    Follow(Setpoint),
    /// The next setpoint, while they are followed.
    Setpoint(Setpoint),
    /// Nothing but that the operator's station is there. A station that speaks `MAVLink` and has the controls must be
    /// heard: by this or any other order.
    Present,
    /// Land and give up the mission.
    Land,
    /// Cut the motors now. **The drone falls.**
    Cut,
    /// Clear the drone's emergency state so that it can fly again. The operator must have inspected the
    /// drone.
    Recover,
    /// Show this camera in the video. It takes no controls; a remote operator must not switch the picture of somebody
    /// else who has them.
    Camera {
        /// The camera.
        camera: Camera,
    },
    /// Have the controls, and change nothing else.
    Take,
    /// Release the controls.
    Release,
}

/// A place to fly to, in the world, whose origin is the start unless that is surveyed; what is not given stays as it is.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Place {
    /// Metres to the right of the origin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_m: Option<f64>,
    /// Metres forward of the origin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_m: Option<f64>,
    /// Metres above the floor of the start.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub height_m: Option<f64>,
    /// Degrees clockwise from the world's forward axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_deg: Option<f64>,
}

impl Place {
    /// This place, at the present height and heading.
    pub const fn at(x_m: f64, y_m: f64) -> Self {
        Self { x_m: Some(x_m), y_m: Some(y_m), height_m: None, yaw_deg: None }
    }

    /// Whether it is one: some of its numbers are given, and those are finite.
    pub fn is_place(&self) -> bool {
        let Self { x_m, y_m, height_m, yaw_deg } = *self;
        let mut numbers = [x_m, y_m, height_m, yaw_deg].into_iter().flatten().peekable();
        numbers.peek().is_some() && numbers.all(f64::is_finite)
    }
}

/// An order as it is written to logs, and by programs.
pub type OrderText = OperatorOrder<PlanText, CommandsText>;

/// The text of a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanText {
    /// Its name in messages.
    #[serde(default = "plan")]
    pub name: String,
    /// Its lines.
    pub plan: String,
}

fn plan() -> String {
    "plan".to_owned()
}

/// The text of commands.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CommandsText {
    /// Their lines.
    pub commands: String,
}

impl OrderText {
    /// Parses the texts in it.
    ///
    /// # Errors
    /// [`PlanError`] if a plan cannot be flown within `limits` and with these `tags`, or a command cannot be read.
    pub fn parse(
        self,
        limits: &FlightLimits,
        tags: TagUse<'_>,
    ) -> Result<OperatorOrder, PlanError> {
        self.map(
            |PlanText { name, plan }| Plan::parse_with_tags(&name, &plan, limits, tags),
            |CommandsText { commands }| Commands::parse("command", &commands),
        )
    }
}

impl From<OperatorOrder> for OrderText {
    fn from(order: OperatorOrder) -> Self {
        let text =
            |plan: Plan| PlanText { name: plan.name().to_owned(), plan: plan.text().to_owned() };
        let commands = |commands: Commands| CommandsText { commands: commands.text().to_owned() };
        let Ok(text) = order.map::<_, _, Infallible>(|it| Ok(text(it)), |it| Ok(commands(it)));
        text
    }
}

impl OperatorOrder {
    /// How many steps it brings, each of which is tried before it is accepted.
    pub fn steps(&self) -> usize {
        match self {
            Self::Load(plan) => plan.steps().len(),
            Self::Append(commands) => commands.count(),
            _ => 0,
        }
    }
}

impl<P, C> OperatorOrder<P, C> {
    /// The same order with other forms of plans and commands.
    fn map<Q, D, E>(
        self,
        plan: impl FnOnce(P) -> Result<Q, E>,
        commands: impl FnOnce(C) -> Result<D, E>,
    ) -> Result<OperatorOrder<Q, D>, E> {
        Ok(match self {
            Self::Load(it) => OperatorOrder::Load(plan(it)?),
            Self::Append(it) => OperatorOrder::Append(commands(it)?),
            Self::Clear => OperatorOrder::Clear,
            Self::Start { when_ready } => OperatorOrder::Start { when_ready },
            Self::Hold => OperatorOrder::Hold,
            Self::Resume => OperatorOrder::Resume,
            Self::Steer(sticks) => OperatorOrder::Steer(sticks),
            Self::GoTo(place) => OperatorOrder::GoTo(place),
            Self::Follow(setpoint) => OperatorOrder::Follow(setpoint),
            Self::Setpoint(setpoint) => OperatorOrder::Setpoint(setpoint),
            Self::Present => OperatorOrder::Present,
            Self::Land => OperatorOrder::Land,
            Self::Cut => OperatorOrder::Cut,
            Self::Recover => OperatorOrder::Recover,
            Self::Camera { camera } => OperatorOrder::Camera { camera },
            Self::Take => OperatorOrder::Take,
            Self::Release => OperatorOrder::Release,
        })
    }

    /// Whether every operator may give this order at any time.
    pub fn is_for_anyone(&self) -> bool {
        matches!(self, Self::Hold | Self::Land | Self::Cut)
    }

    /// Whether the drone flies otherwise after it.
    pub(super) fn changes_the_flight(&self) -> bool {
        match self {
            Self::Take | Self::Release | Self::Present | Self::Camera { .. } | Self::Recover => {
                false
            }
            Self::Load(_)
            | Self::Append(_)
            | Self::Clear
            | Self::Start { .. }
            | Self::Hold
            | Self::Resume
            | Self::Steer(_)
            | Self::GoTo(_)
            | Self::Follow(_)
            | Self::Setpoint(_)
            | Self::Land
            | Self::Cut => true,
        }
    }

    /// Its name in logs and in JSON.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Load(_) => "load",
            Self::Append(_) => "append",
            Self::Clear => "clear",
            Self::Start { .. } => "start",
            Self::Hold => "hold",
            Self::Resume => "resume",
            Self::Steer(_) => "steer",
            Self::GoTo(_) => "goto",
            Self::Follow(_) => "follow",
            Self::Setpoint(_) => "setpoint",
            Self::Present => "present",
            Self::Land => "land",
            Self::Cut => "cut",
            Self::Recover => "recover",
            Self::Camera { .. } => "camera",
            Self::Take => "take",
            Self::Release => "release",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_given_by_some_finite_numbers() {
        assert!(Place::at(0.0, 1.0).is_place());
        assert!(Place { yaw_deg: Some(90.0), ..Place::default() }.is_place());
        assert!(!Place::default().is_place());
        assert!(!Place { height_m: Some(f64::NAN), ..Place::at(0.0, 1.0) }.is_place());
    }

    #[test]
    fn a_plan_without_a_name_is_called_plan() {
        assert_eq!(plan(), "plan");
    }

    #[test]
    fn texts_of_orders_are_parsed_within_the_fence() {
        let load = |plan: &str| {
            let plan = PlanText { name: "p".to_owned(), plan: plan.to_owned() };
            OrderText::Load(plan).parse(&FlightLimits::default(), TagUse::Unknown)
        };
        let order = load("takeoff\ngoto 0 1 0 0\nland\n").unwrap();
        assert!(matches!(&order, OperatorOrder::Load(plan) if plan.steps().len() == 3));
        assert_eq!(
            OrderText::from(order.clone()).parse(&FlightLimits::default(), TagUse::Unknown),
            Ok(order)
        );
        assert!(load("takeoff\ngoto 99 0 0 0").is_err());
        let commands = CommandsText { commands: "gotoo".to_owned() };
        assert!(
            OrderText::Append(commands).parse(&FlightLimits::default(), TagUse::Unknown).is_err()
        );
    }
}
