//! The orders of a stream.

use std::time::Duration;

use ardrone_link::settings::Camera;
use autopilot::plan::Commands;
use autopilot::vehicle::{
    Heading, Horizontal, Operator, OperatorOrder, Place, Setpoint, Station, Vertical,
};
use kinematics::Sticks;
use nalgebra::Vector2;
use rand::{Rng, RngExt as _};

use super::{Given, plan};

/// The fastest that a joystick of a ground station asks for.
const JOYSTICK_M_S: f64 = 1.5;
const JOYSTICK_CLIMB_M_S: f64 = 0.5;
/// Interval at which the vehicle hears that a ground station is there.
const PRESENT_EVERY: Duration = Duration::from_millis(250);

/// The orders that move the drone: most lead in one direction.
#[derive(Debug)]
pub(super) struct Moving {
    sticks: Sticks,
    /// Share of other orders.
    others: f64,
    /// A ground station's sticks are followed as setpoints.
    by: Operator,
}

impl Moving {
    pub(super) fn of(random: &mut impl Rng, by: Operator) -> Self {
        let way = direction(random);
        let climbs = random.random_bool(0.3);
        let sticks = Sticks {
            roll: way.x,
            pitch: way.y,
            gaz: if climbs { random.random_range(-1.0..1.0) } else { 0.0 },
            yaw: if random.random_bool(0.2) { random.random_range(-1.0..1.0) } else { 0.0 },
        };
        Self { sticks, others: [0.0, 0.3, 0.5, 0.8][random.random_range(0..4)], by }
    }

    fn is_ground_station(&self) -> bool {
        self.by.station == Station::Mavlink
    }

    /// What a ground station orders before its sticks count: it gets the controls, and its sticks are followed.
    pub(super) fn begin(&self, at: Duration) -> Vec<Given> {
        if !self.is_ground_station() {
            return Vec::new();
        }
        let released = (at, Operator::TERMINAL, OperatorOrder::Release);
        vec![released, (at, self.by, OperatorOrder::Follow(self.joystick()))]
    }

    fn joystick(&self) -> Setpoint {
        let Sticks { roll, pitch, gaz, yaw } = self.sticks;
        Setpoint {
            horizontal: Horizontal::BodyVelocity {
                right_m_s: roll * JOYSTICK_M_S,
                forward_m_s: -pitch * JOYSTICK_M_S,
            },
            vertical: Vertical::Climb(gaz * JOYSTICK_CLIMB_M_S),
            heading: Heading::Turn(60.0 * yaw),
        }
    }

    pub(super) fn order(&self, random: &mut impl Rng) -> OperatorOrder {
        if !random.random_bool(self.others) {
            return match self.by.station {
                Station::Mavlink if random.random_bool(0.1) => {
                    OperatorOrder::Follow(self.joystick())
                }
                Station::Mavlink => OperatorOrder::Setpoint(self.joystick()),
                _ => OperatorOrder::Steer(self.sticks),
            };
        }
        match random.random_range(0..9) {
            0 => OperatorOrder::Steer(Sticks {
                roll: random.random_range(-1.0..1.0),
                pitch: random.random_range(-1.0..1.0),
                ..self.sticks
            }),
            1 => OperatorOrder::GoTo(place(random, 9.0)),
            2 => OperatorOrder::Follow(setpoint(random)),
            3 => OperatorOrder::Setpoint(setpoint(random)),
            4 => mission(random),
            5 => nonsense(random),
            _ => stopping(random),
        }
    }
}

/// An order after which the drone stops, or flies back.
pub(super) fn stopping(random: &mut impl Rng) -> OperatorOrder {
    match random.random_range(0..9) {
        0..=3 => OperatorOrder::Hold,
        4 | 5 => OperatorOrder::Clear,
        6 => OperatorOrder::GoTo(place(random, 1.5)),
        7 => OperatorOrder::Follow(Setpoint {
            horizontal: Horizontal::Velocity { x_m_s: 0.0, y_m_s: 0.0 },
            vertical: Vertical::Climb(0.0),
            heading: Heading::Keep,
        }),
        _ => OperatorOrder::Load(plan("takeoff\ngoto 0 0 0.3 0\nsetStayTime 90\ngoto 0 0 0.3 0\n")),
    }
}

/// An order after which the drone does what it did.
pub(super) fn nonsense(random: &mut impl Rng) -> OperatorOrder {
    match random.random_range(0..9) {
        0 => OperatorOrder::Camera { camera: Camera::Bottom },
        1 => OperatorOrder::Take,
        2 => OperatorOrder::Release,
        3 => OperatorOrder::Present,
        4 => OperatorOrder::Recover,
        5 => OperatorOrder::GoTo(Place::at(f64::NAN, 0.0)),
        6 => Commands::parse("stream", "setSpeed 2")
            .map_or(OperatorOrder::Present, OperatorOrder::Append),
        7 => OperatorOrder::Setpoint(Setpoint {
            vertical: Vertical::Climb(f64::NAN),
            ..setpoint(random)
        }),
        _ => OperatorOrder::Start { when_ready: random.random_bool(0.5) },
    }
}

/// A plan with settings, which may be given in the air.
fn mission(random: &mut impl Rng) -> OperatorOrder {
    let (x, y) = (random.random_range(-2.7..2.7), random.random_range(-2.7..2.7));
    let most = random.random_range(0.2..1.0);
    OperatorOrder::Load(plan(&format!(
        "takeoff\nsetReference $START$\nsetMaxControl {most:.1}\ngoto {x:.1} {y:.1} 1 0\nsetStayTime 90\ngoto {x:.1} {y:.1} 1 0\n"
    )))
}

fn setpoint(random: &mut impl Rng) -> Setpoint {
    let [x, y] = [random.random_range(-2.0..2.0), random.random_range(-2.0..2.0)];
    Setpoint {
        horizontal: match random.random_range(0..3) {
            0 => Horizontal::Place { x_m: 4.0 * x, y_m: 4.0 * y },
            1 => Horizontal::Velocity { x_m_s: x, y_m_s: y },
            _ => Horizontal::BodyVelocity { right_m_s: x, forward_m_s: y },
        },
        vertical: if random.random_bool(0.6) {
            Vertical::Height(random.random_range(0.5..3.5))
        } else {
            Vertical::Climb(random.random_range(-1.0..1.0))
        },
        heading: Heading::Keep,
    }
}

fn place(random: &mut impl Rng, most_m: f64) -> Place {
    let away_m = random.random_range(0.0..most_m);
    let at_m = direction(random) * away_m;
    let height_m = random.random_bool(0.3).then(|| random.random_range(0.5..3.5));
    Place { height_m, ..Place::at(at_m.x, at_m.y) }
}

/// A ground station that is there.
pub(super) fn present(by: Operator, from: Duration, to: Duration) -> Vec<Given> {
    if by.station != Station::Mavlink {
        return Vec::new();
    }
    let times = (0_u32..).map(|count| from + PRESENT_EVERY * count).take_while(|at| *at < to);
    times.map(|at| (at, by, OperatorOrder::Present)).collect()
}

/// Orders of these operators, so many each second.
pub(super) fn give<R: Rng>(
    random: &mut R,
    operators: &[Operator],
    from: Duration,
    to: Duration,
    each_second: f64,
    into: &mut Vec<Given>,
    mut order: impl FnMut(&mut R) -> OperatorOrder,
) {
    let period = Duration::from_secs_f64(1.0 / each_second);
    let mut at = from;
    while at < to {
        let by = operators[random.random_range(0..operators.len())];
        into.push((at, by, order(random)));
        at += period;
    }
}

/// From 1 to 400 each second, as many slow ones as fast ones.
pub(super) fn rate(random: &mut impl Rng) -> f64 {
    400_f64.powf(random.random_range(0.0..1.0))
}

pub(super) fn direction(random: &mut impl Rng) -> Vector2<f64> {
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    Vector2::new(sin, cos)
}

pub(super) fn seconds(random: &mut impl Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(random.random_range(from..to))
}
