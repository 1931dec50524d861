//! Operator orders in the flight log.

use autopilot::plan::{Commands, FlightLimits, Plan, PlanError};
use autopilot::vehicle::{
    Heading, Horizontal, Operator, OperatorOrder, Place, Setpoint, Station, Vertical,
};
use kinematics::Sticks;
use serde::{Deserialize, Serialize};

use crate::camera::NamedCamera;

/// An order and its operator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// The operator; missing in formats 1 and 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    by: Option<Giver>,
    #[serde(flatten)]
    order: Ordered,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Giver {
    station: String,
    number: u16,
    local: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "order", rename_all = "lowercase")]
enum Ordered {
    Load {
        name: String,
        plan: String,
    },
    Append {
        commands: String,
    },
    Clear,
    Start {
        when_ready: bool,
    },
    Hold,
    Resume,
    Steer {
        roll: f64,
        pitch: f64,
        gaz: f64,
        yaw: f64,
    },
    GoTo {
        x_m: Option<f64>,
        y_m: Option<f64>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        height_m: Option<f64>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        yaw_deg: Option<f64>,
    },
    Follow {
        setpoint: LoggedSetpoint,
    },
    Setpoint {
        setpoint: LoggedSetpoint,
    },
    Present,
    Land,
    Cut,
    Recover,
    Camera {
        camera: NamedCamera,
    },
    Take,
    Release,
}

/// A set-point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct LoggedSetpoint {
    horizontal: LoggedHorizontal,
    vertical: LoggedVertical,
    heading: LoggedHeading,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum LoggedHorizontal {
    PlaceM([f64; 2]),
    VelocityMS([f64; 2]),
    BodyVelocityMS([f64; 2]),
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum LoggedVertical {
    HeightM(f64),
    ClimbMS(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum LoggedHeading {
    Keep,
    YawDeg(f64),
    TurnDegS(f64),
}

impl From<LoggedSetpoint> for Setpoint {
    fn from(logged: LoggedSetpoint) -> Self {
        Self {
            horizontal: match logged.horizontal {
                LoggedHorizontal::PlaceM([x_m, y_m]) => Horizontal::Place { x_m, y_m },
                LoggedHorizontal::VelocityMS([x_m_s, y_m_s]) => {
                    Horizontal::Velocity { x_m_s, y_m_s }
                }
                LoggedHorizontal::BodyVelocityMS([right_m_s, forward_m_s]) => {
                    Horizontal::BodyVelocity { right_m_s, forward_m_s }
                }
            },
            vertical: match logged.vertical {
                LoggedVertical::HeightM(height_m) => Vertical::Height(height_m),
                LoggedVertical::ClimbMS(climb_m_s) => Vertical::Climb(climb_m_s),
            },
            heading: match logged.heading {
                LoggedHeading::Keep => Heading::Keep,
                LoggedHeading::YawDeg(yaw_deg) => Heading::Yaw(yaw_deg),
                LoggedHeading::TurnDegS(turn_deg_s) => Heading::Turn(turn_deg_s),
            },
        }
    }
}

impl From<Setpoint> for LoggedSetpoint {
    fn from(setpoint: Setpoint) -> Self {
        Self {
            horizontal: match setpoint.horizontal {
                Horizontal::Place { x_m, y_m } => LoggedHorizontal::PlaceM([x_m, y_m]),
                Horizontal::Velocity { x_m_s, y_m_s } => {
                    LoggedHorizontal::VelocityMS([x_m_s, y_m_s])
                }
                Horizontal::BodyVelocity { right_m_s, forward_m_s } => {
                    LoggedHorizontal::BodyVelocityMS([right_m_s, forward_m_s])
                }
            },
            vertical: match setpoint.vertical {
                Vertical::Height(height_m) => LoggedVertical::HeightM(height_m),
                Vertical::Climb(climb_m_s) => LoggedVertical::ClimbMS(climb_m_s),
            },
            heading: match setpoint.heading {
                Heading::Keep => LoggedHeading::Keep,
                Heading::Yaw(yaw_deg) => LoggedHeading::YawDeg(yaw_deg),
                Heading::Turn(turn_deg_s) => LoggedHeading::TurnDegS(turn_deg_s),
            },
        }
    }
}

/// Why a logged order cannot be replayed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OrderError {
    /// Its plan or commands are invalid in this version.
    #[error("a loaded plan is not valid in this version")]
    Plan(#[from] PlanError),
    /// The operator's station is unknown in this version.
    #[error("an order came from `{0}`, which is not known")]
    Station(String),
}

impl Order {
    /// Converts an order to its log message.
    pub fn new(by: Operator, order: &OperatorOrder) -> Self {
        let Operator { station, number, local } = by;
        let by = Some(Giver { station: station.name().to_owned(), number, local });
        Self { by, order: Ordered::from(order) }
    }

    /// Converts the message back to an order.
    ///
    /// # Errors
    /// [`OrderError`] if this version does not accept it.
    pub fn given(&self, limits: &FlightLimits) -> Result<(Operator, OperatorOrder), OrderError> {
        let by = match &self.by {
            None => Operator::TERMINAL,
            Some(Giver { station: name, number, local }) => {
                let station = Station::ALL.into_iter().find(|station| station.name() == name);
                let station = station.ok_or_else(|| OrderError::Station(name.clone()))?;
                Operator { station, number: *number, local: *local }
            }
        };
        let order = match &self.order {
            Ordered::Load { name, plan } => {
                OperatorOrder::Load(Plan::parse_within(name, plan, limits)?)
            }
            Ordered::Append { commands } => {
                OperatorOrder::Append(Commands::parse("command", commands)?)
            }
            Ordered::Clear => OperatorOrder::Clear,
            Ordered::Start { when_ready } => OperatorOrder::Start { when_ready: *when_ready },
            Ordered::Hold => OperatorOrder::Hold,
            Ordered::Resume => OperatorOrder::Resume,
            &Ordered::Steer { roll, pitch, gaz, yaw } => {
                OperatorOrder::Steer(Sticks { roll, pitch, gaz, yaw })
            }
            &Ordered::GoTo { x_m, y_m, height_m, yaw_deg } => OperatorOrder::GoTo(Place {
                place_m: x_m.zip(y_m).map(Into::into),
                height_m,
                yaw_deg,
            }),
            &Ordered::Follow { setpoint } => OperatorOrder::Follow(setpoint.into()),
            &Ordered::Setpoint { setpoint } => OperatorOrder::Setpoint(setpoint.into()),
            Ordered::Present => OperatorOrder::Present,
            Ordered::Land => OperatorOrder::Land,
            Ordered::Cut => OperatorOrder::Cut,
            Ordered::Recover => OperatorOrder::Recover,
            &Ordered::Camera { camera } => OperatorOrder::Camera(camera.into()),
            Ordered::Take => OperatorOrder::Take,
            Ordered::Release => OperatorOrder::Release,
        };
        Ok((by, order))
    }
}

impl From<&OperatorOrder> for Ordered {
    fn from(order: &OperatorOrder) -> Self {
        match order {
            OperatorOrder::Load(plan) => {
                Self::Load { name: plan.name().to_owned(), plan: plan.text().to_owned() }
            }
            OperatorOrder::Append(commands) => {
                Self::Append { commands: commands.text().to_owned() }
            }
            OperatorOrder::Clear => Self::Clear,
            OperatorOrder::Start { when_ready } => Self::Start { when_ready: *when_ready },
            OperatorOrder::Hold => Self::Hold,
            OperatorOrder::Resume => Self::Resume,
            &OperatorOrder::Steer(Sticks { roll, pitch, gaz, yaw }) => {
                Self::Steer { roll, pitch, gaz, yaw }
            }
            &OperatorOrder::GoTo(Place { place_m, height_m, yaw_deg }) => {
                let [x_m, y_m] = place_m.map_or([None; 2], |place_m| place_m.map(Some));
                Self::GoTo { x_m, y_m, height_m, yaw_deg }
            }
            &OperatorOrder::Follow(setpoint) => Self::Follow { setpoint: setpoint.into() },
            &OperatorOrder::Setpoint(setpoint) => Self::Setpoint { setpoint: setpoint.into() },
            OperatorOrder::Present => Self::Present,
            OperatorOrder::Land => Self::Land,
            OperatorOrder::Cut => Self::Cut,
            OperatorOrder::Recover => Self::Recover,
            &OperatorOrder::Camera(camera) => Self::Camera { camera: camera.into() },
            OperatorOrder::Take => Self::Take,
            OperatorOrder::Release => Self::Release,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_comes_back_from_a_log() {
        let limits = FlightLimits::default();
        let remote = Operator { station: Station::Browser, number: 2, local: false };
        for order in [
            OperatorOrder::Load(Plan::parse("square.txt", "takeoff\nland\n").unwrap()),
            OperatorOrder::Append(Commands::parse("command", "goto 0 1 0 0").unwrap()),
            OperatorOrder::Start { when_ready: true },
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
            OperatorOrder::Cut,
            OperatorOrder::Camera(ardrone_link::settings::Camera::Bottom),
        ] {
            let text = serde_json::to_string(&Order::new(remote, &order)).unwrap();
            let read: Order = serde_json::from_str(&text).unwrap();
            assert_eq!(read.given(&limits), Ok((remote, order)), "{text}");
        }
    }

    #[test]
    fn older_logs_do_not_say_who_gave_an_order() {
        let read: Order = serde_json::from_str(r#"{"order":"hold"}"#).unwrap();
        let given = read.given(&FlightLimits::default());
        assert_eq!(given, Ok((Operator::TERMINAL, OperatorOrder::Hold)));
        let odd = r#"{"order":"hold","by":{"station":"moon","number":0,"local":false}}"#;
        let odd: Order = serde_json::from_str(odd).unwrap();
        assert_eq!(
            odd.given(&FlightLimits::default()),
            Err(OrderError::Station("moon".to_owned()))
        );
    }
}
