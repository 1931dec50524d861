//! A ground station of a flight: it flies by missions, setpoints and sticks, orders nonsense, and disappears without a
//! word.

use std::fmt::Write as _;
use std::time::Duration;

use autopilot::Plan;
use autopilot::plan::FlightLimits;
use autopilot::vehicle::{
    Heading, Horizontal, Operator, OperatorOrder, Place, Setpoint, Station as Kind, Vertical,
};
use kinematics::Sticks;
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// The station is drawn from a sequence of its own: the rest of a flight is the same with and without it.
const SEQUENCE: u64 = 23;
/// The station that flies.
pub(super) const STATION: Operator =
    Operator { station: Kind::Mavlink, number: 0xffbe, local: true };
/// One that only shows that it is there, and would like to fly.
const BYSTANDER: Operator = Operator { number: 0xfebe, ..STATION };
/// Interval at which a station shows that it is there.
const PULSE: Duration = Duration::from_secs(1);
/// Orders of a flood.
const FLOOD: u32 = 200;

/// A flight's station.
#[derive(Debug, Clone)]
pub(super) struct Station {
    /// When the terminal's operator gives the controls away.
    pub(super) released_at: Duration,
    /// Orders of all stations, in the order of time.
    pub(super) orders: Vec<(Duration, Operator, OperatorOrder)>,
}

impl Station {
    /// The station of a seed's flight, if it has one.
    pub(super) fn of(seed: u64, limits: &FlightLimits) -> Option<Self> {
        // A quarter of all flights.
        if !matches!(seed % 8, 3 | 6) {
            return None;
        }
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(SEQUENCE);
        let random = &mut random;
        let released_at = seconds(random, 0.1, 8.0);
        let mut orders = vec![(released_at, OperatorOrder::Take)];
        if random.random_bool(0.5) {
            orders.push((released_at, OperatorOrder::Load(mission(random, limits))));
        }
        let gone_at = released_at + seconds(random, 3.0, 30.0);
        acts(random, limits, released_at, gone_at, &mut orders);
        let mut end = gone_at;
        if random.random_bool(0.5) {
            let back_at = gone_at + seconds(random, 1.0, 22.0);
            end = back_at + seconds(random, 2.0, 30.0);
            pulse(back_at, end, &mut orders);
            // It may say nothing at all.
            if random.random_bool(0.5) {
                let acts_at = back_at + seconds(random, 0.0, 10.0);
                acts(random, limits, acts_at, end, &mut orders);
            }
        }
        if random.random_bool(0.2) {
            orders.push((end, OperatorOrder::Land));
        }
        let mut orders: Vec<_> =
            orders.into_iter().map(|(at, order)| (at, STATION, order)).collect();
        if random.random_bool(0.5) {
            let mut pulses = Vec::new();
            pulse(Duration::ZERO, end + Duration::from_secs(40), &mut pulses);
            pulses.push((seconds(random, 0.0, 60.0), OperatorOrder::Take));
            pulses.push((seconds(random, 0.0, 60.0), OperatorOrder::Resume));
            // It must not get the controls before the other one.
            pulses.retain(|(at, _)| *at > released_at);
            orders.extend(pulses.into_iter().map(|(at, order)| (at, BYSTANDER, order)));
        }
        orders.sort_by_key(|(at, ..)| *at);
        Some(Self { released_at, orders })
    }

    /// Description of its orders, one line each.
    pub(super) fn circumstances(&self) -> impl Iterator<Item = String> {
        let mut last = "";
        let floods = |at: Duration| {
            self.orders.iter().filter(|(other, ..)| *other == at).count() > FLOOD as usize / 2
        };
        let flooded_at = self.orders.iter().map(|(at, ..)| *at).filter(move |at| floods(*at));
        let flooded_at = flooded_at.collect::<std::collections::BTreeSet<_>>().into_iter();
        let flooded = flooded_at.map(|at| format!("{:.2} s: a flood of orders", at.as_secs_f64()));
        let said = self
            .orders
            .iter()
            .filter(move |(at, _, order)| *order != OperatorOrder::Present && !floods(*at));
        let said = said.filter(move |(_, _, order)| {
            let repeats = matches!(order, OperatorOrder::Setpoint(_) | OperatorOrder::Steer(_));
            std::mem::replace(&mut last, order.name()) != order.name() || !repeats
        });
        let heard = self.orders.iter().filter(|(_, by, _)| *by == STATION).map(|(at, ..)| *at);
        let silences =
            heard.clone().zip(heard.skip(1)).filter(|(from, to)| *to > *from + 2 * PULSE);
        let silences = silences.map(|(from, to)| {
            format!(
                "{:.2} s: the station is silent until {:.2} s",
                from.as_secs_f64(),
                to.as_secs_f64()
            )
        });
        let last_at = self.orders.iter().rfind(|(_, by, _)| *by == STATION).map(|(at, ..)| *at);
        let gone = last_at.map(|at| format!("{:.2} s: the station is gone", at.as_secs_f64()));
        let said = said.map(|(at, by, order)| {
            format!("{:.2} s: {by} orders {order:?}", at.as_secs_f64()).chars().take(240).collect()
        });
        said.chain(flooded).chain(silences).chain(gone)
    }
}

/// It shows that it is there.
fn pulse(from: Duration, to: Duration, orders: &mut Vec<(Duration, OperatorOrder)>) {
    let mut at = from;
    while at < to {
        orders.push((at, OperatorOrder::Present));
        at += PULSE;
    }
}

/// It shows that it is there, and gives orders.
fn acts(
    random: &mut impl Rng,
    limits: &FlightLimits,
    from: Duration,
    to: Duration,
    orders: &mut Vec<(Duration, OperatorOrder)>,
) {
    pulse(from, to, orders);
    let mut at = from;
    let mut given = Vec::new();
    while at < to {
        at += seconds(random, 0.2, 8.0);
        match random.random_range(0..16) {
            0..=3 => at = stream(random, at, &mut given),
            4 => {
                let sticks = sticks(random);
                for _ in 0..10 {
                    given.push((at, OperatorOrder::Steer(sticks)));
                    at += Duration::from_millis(100);
                }
            }
            5 => given.push((at, OperatorOrder::GoTo(place(random)))),
            6 => given.push((at, OperatorOrder::Hold)),
            7 | 8 => given.push((at, OperatorOrder::Resume)),
            9 => given.push((at, OperatorOrder::Start { when_ready: true })),
            10 => given.push((at, OperatorOrder::Load(mission(random, limits)))),
            11 => given.push((at, OperatorOrder::Setpoint(setpoint(random)))),
            12 => given.extend((0..FLOOD).map(|_| (at, flooded(random)))),
            13 | 14 => {
                given.push((at, OperatorOrder::Follow(nonsense(random))));
                given.push((at, OperatorOrder::Setpoint(nonsense(random))));
                let nowhere = Place { height_m: Some(f64::NAN), ..place(random) };
                given.push((at, OperatorOrder::GoTo(nowhere)));
            }
            _ if random.random_bool(0.3) => given.push((at, OperatorOrder::Land)),
            _ => {}
        }
    }
    orders.extend(given.into_iter().filter(|(at, _)| *at < to));
}

/// Setpoints for a while; returns their end.
fn stream(
    random: &mut impl Rng,
    from: Duration,
    orders: &mut Vec<(Duration, OperatorOrder)>,
) -> Duration {
    let end = from + seconds(random, 0.5, 12.0);
    let period = seconds(random, 0.03, 0.3);
    let mut wanted = setpoint(random);
    orders.push((from, OperatorOrder::Follow(wanted)));
    let mut at = from;
    while at < end {
        at += period;
        if random.random_bool(0.02) {
            wanted = setpoint(random);
        }
        let sent = if random.random_bool(0.02) { nonsense(random) } else { wanted };
        orders.push((at, OperatorOrder::Setpoint(sent)));
    }
    at
}

fn setpoint(random: &mut impl Rng) -> Setpoint {
    // Some want everything.
    let most = if random.random_bool(0.05) { 1e9 } else { 1.0 };
    let mut number = |most_usual: f64| most * random.random_range(-most_usual..most_usual);
    let (place_m, velocity_m_s) = ([number(6.0), number(6.0)], [number(2.0), number(2.0)]);
    let (height_m, climb_m_s) = (number(3.5).abs(), number(1.0));
    let (yaw_deg, turn_deg_s) = (number(180.0), number(90.0));
    let [x_m, y_m] = place_m;
    let [right_m_s, forward_m_s] = velocity_m_s;
    Setpoint {
        horizontal: match random.random_range(0..3) {
            0 => Horizontal::Place { x_m, y_m },
            1 => Horizontal::Velocity { x_m_s: right_m_s, y_m_s: forward_m_s },
            _ => Horizontal::BodyVelocity { right_m_s, forward_m_s },
        },
        vertical: if random.random_bool(0.6) {
            Vertical::Height(height_m)
        } else {
            Vertical::Climb(climb_m_s)
        },
        heading: match random.random_range(0..3) {
            0 => Heading::Keep,
            1 => Heading::Yaw(yaw_deg),
            _ => Heading::Turn(turn_deg_s),
        },
    }
}

/// A setpoint of which one number is none, or infinite.
fn nonsense(random: &mut impl Rng) -> Setpoint {
    let number = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][random.random_range(0..3)];
    let sound = setpoint(random);
    match random.random_range(0..3) {
        0 => {
            let horizontal = Horizontal::Velocity { x_m_s: number, y_m_s: 0.0 };
            Setpoint { horizontal, ..sound }
        }
        1 => Setpoint { vertical: Vertical::Height(number), ..sound },
        _ => Setpoint { heading: Heading::Turn(number), ..sound },
    }
}

fn flooded(random: &mut impl Rng) -> OperatorOrder {
    match random.random_range(0..6) {
        0 => OperatorOrder::Follow(setpoint(random)),
        1 => OperatorOrder::Follow(nonsense(random)),
        2 => OperatorOrder::Resume,
        3 => OperatorOrder::Steer(sticks(random)),
        4 => OperatorOrder::Present,
        _ => OperatorOrder::Setpoint(setpoint(random)),
    }
}

fn sticks(random: &mut impl Rng) -> Sticks {
    let mut stick = || random.random_range(-1.0..1.0);
    Sticks { roll: stick(), pitch: stick(), gaz: stick(), yaw: stick() }
}

fn place(random: &mut impl Rng) -> Place {
    let mut number = |most: f64| random.random_range(-most..most);
    let (x_m, y_m, height_m, yaw_deg) = (number(6.0), number(6.0), number(3.0), number(180.0));
    let given = random.random_bool(0.8);
    Place {
        x_m: given.then_some(x_m),
        y_m: given.then_some(y_m),
        height_m: random.random_bool(0.5).then_some(height_m),
        yaw_deg: random.random_bool(0.5).then_some(yaw_deg),
    }
}

/// A mission in metres above the floor of the start.
fn mission(random: &mut impl Rng, limits: &FlightLimits) -> Plan {
    let mut text = "takeoff\nsetReference $START$\n".to_owned();
    if random.random_bool(0.5) {
        text += "setSpeed 0.6\n";
    }
    if random.random_bool(0.5) {
        text += "setStayTime 4\n";
    }
    // It takes longer than the station is there.
    for _ in 0..random.random_range(4..9) {
        let (x, y) = (random.random_range(-2.5..2.5), random.random_range(-2.5..2.5));
        let z = random.random_range(0.5..limits.ceiling_m - 0.2);
        _ = writeln!(text, "goto {x:.2} {y:.2} {z:.2} 0");
    }
    text += "land\n";
    Plan::parse_within("mission", &text, limits).unwrap_or_else(|error| panic!("{error}"))
}

fn seconds(random: &mut impl Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(random.random_range(from..to))
}
