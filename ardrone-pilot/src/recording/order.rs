//! Operator orders in the flight log.

use autopilot::plan::{FlightLimits, PlanError, TagUse};
use autopilot::vehicle::{Operator, OperatorOrder, OrderText};
use serde::{Deserialize, Serialize};

/// An order and its operator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Order {
    by: Operator,
    #[serde(flatten)]
    order: OrderText,
}

impl Order {
    /// Converts an order to its log message.
    pub fn new(by: Operator, order: OperatorOrder) -> Self {
        Self { by, order: order.into() }
    }

    /// The order and who gave it, for people.
    pub fn text(&self) -> String {
        format!("{}: {}", self.by, self.order.name())
    }

    /// Whether it is one of many in a row, as those of sticks that are held.
    pub fn repeats(&self) -> bool {
        matches!(self.order, OrderText::Steer(_) | OrderText::Setpoint(_) | OrderText::Present)
    }

    /// Converts the message back to an order.
    ///
    /// # Errors
    /// [`PlanError`] if its plan or commands are not valid in this version.
    pub fn given(self, limits: &FlightLimits) -> Result<(Operator, OperatorOrder), PlanError> {
        Ok((self.by, self.order.parse(limits, TagUse::Unknown)?))
    }
}

#[cfg(test)]
mod tests {
    use ardrone_link::settings::Camera;
    use autopilot::plan::{Commands, Plan};
    use autopilot::vehicle::{Heading, Horizontal, Place, Setpoint, Station, Vertical};
    use kinematics::Sticks;

    use super::*;

    /// One of each.
    fn all() -> Vec<OperatorOrder> {
        vec![
            OperatorOrder::Load(Plan::parse("square.txt", "takeoff\nland\n").unwrap()),
            OperatorOrder::Append(Commands::parse("command", "goto 0 1 0 0").unwrap()),
            OperatorOrder::Clear,
            OperatorOrder::Start { when_ready: true },
            OperatorOrder::Hold,
            OperatorOrder::Resume,
            OperatorOrder::Steer(Sticks { roll: 0.5, ..Sticks::default() }),
            OperatorOrder::GoTo(Place::at(1.0, -2.5)),
            OperatorOrder::GoTo(Place {
                height_m: Some(1.5),
                yaw_deg: Some(-90.0),
                ..Place::default()
            }),
            OperatorOrder::Follow(Setpoint {
                horizontal: Horizontal::Place { x_m: 1.0, y_m: -2.5 },
                vertical: Vertical::Height(1.0),
                heading: Heading::Keep,
            }),
            OperatorOrder::Setpoint(Setpoint {
                horizontal: Horizontal::BodyVelocity { right_m_s: 1.0, forward_m_s: -0.5 },
                vertical: Vertical::Climb(-0.25),
                heading: Heading::Turn(5.0),
            }),
            OperatorOrder::Setpoint(Setpoint {
                horizontal: Horizontal::Velocity { x_m_s: 1.0, y_m_s: -0.5 },
                vertical: Vertical::Climb(0.25),
                heading: Heading::Yaw(5.0),
            }),
            OperatorOrder::Present,
            OperatorOrder::Land,
            OperatorOrder::Cut,
            OperatorOrder::Recover,
            OperatorOrder::Camera { camera: Camera::Bottom },
            OperatorOrder::Take,
            OperatorOrder::Release,
        ]
    }

    #[test]
    fn an_order_comes_back_from_a_log() {
        let remote = Operator { station: Station::Browser, number: 2, local: false };
        for order in all() {
            let text = serde_json::to_value(Order::new(remote, order.clone())).unwrap();
            assert_eq!(text["order"], order.name());
            let read: Order = serde_json::from_value(text.clone()).unwrap();
            assert_eq!(read.given(&FlightLimits::default()), Ok((remote, order)), "{text}");
        }
    }

    #[test]
    fn orders_have_a_schema() {
        let schema = include_str!("schemas/order.json");
        let schema: serde_json::Value = serde_json::from_str(schema).unwrap();
        for order in all() {
            let text = serde_json::to_value(Order::new(Operator::TERMINAL, order)).unwrap();
            for key in text.as_object().unwrap().keys() {
                assert!(schema["properties"].get(key).is_some(), "{key}");
            }
        }
    }
}
