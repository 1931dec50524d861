//! Generates a flight from a seed.

use std::fmt::Write as _;
use std::time::Duration;

use ardrone_link::navdata::DroneState;
use autopilot::Plan;
use autopilot::plan::FlightLimits;
use autopilot::vehicle::{OperatorOrder, Place, VehicleConfig};
use kinematics::Sticks;
use mock_drone::airframe::Profile;
use mock_drone::scenario::{Action, Direction, When};
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, Quantity, SensorFault, WorldConfig};
use nalgebra::Vector2;
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::injected::Injected;
use super::station::Station;
use super::tags::Tags;
use crate::airframes::{AIRFRAMES, Airframes, strongest_wind_m_s};
use crate::sim::Simulation;
use crate::trial::FENCE;

/// Time after the flight in which an uncontrolled drone must land by itself.
const AFTERMATH: Duration = Duration::from_secs(45);

/// A flight of the campaign.
#[derive(Debug)]
pub(super) struct Flight {
    pub(super) simulation: Simulation,
    pub(super) plan: Plan,
    pub(super) injected: Injected,
    /// The strongest wind that the airframe can resist.
    pub(super) strongest_m_s: f64,
    airframe: &'static str,
    plan_text: String,
    /// Tags, if they are in use.
    pub(super) tags: Option<Tags>,
    /// The ground station that flies it, if there is one.
    station: Option<Station>,
}

impl Flight {
    /// The flight of a seed.
    pub(super) fn of(airframes: Airframes, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let random = &mut random;
        let limits = FlightLimits { ceiling_m: random.random_range(1.6..3.0), ..FENCE };
        let airframe = random.random_range(0..AIRFRAMES.len());
        let (profile, airframe) = (airframes.profile(airframe, seed), airframes.name(airframe));
        let strongest_m_s = strongest_wind_m_s(&profile);
        let mut drone = drone(random, seed, profile, strongest_m_s, &limits);
        let link = if random.random_bool(0.3) { LinkFaults::default() } else { link(random) };
        let mut injected = injected(random, strongest_m_s, drone.flies_at_m.is_some());
        let mut orders = orders(random);
        let mut plan_text = plan(random, &limits, drone.flies_at_m.is_some());
        let tags = Tags::of(seed, drone.sensors == SensorModel::hard());
        let mut pilot = VehicleConfig { limits, ..VehicleConfig::default() };
        if let Some(tags) = &tags {
            drone.camera = tags.camera;
            injected.accidents.extend(&tags.accidents);
            injected.is_survey_wrong = tags.is_survey_wrong;
            pilot.estimator.tags = Some(tags.config);
            plan_text = tags.change(&plan_text);
        }
        let station = Station::of(seed, &limits);
        if let Some(station) = &station {
            orders.push((station.released_at, OperatorOrder::Release));
            orders.sort_by_key(|(at, _)| *at);
        }
        let plan = Plan::parse_within("campaign", &plan_text, &limits)
            .unwrap_or_else(|error| panic!("{error}"));
        let simulation = Simulation {
            world: WorldConfig {
                drone,
                link,
                scenario: injected.scenario(),
                tags: tags.as_ref().map(|tags| tags.laid.clone()).unwrap_or_default(),
                ..WorldConfig::default()
            },
            pilot,
            orders,
            others: station.as_ref().map(|station| station.orders.clone()).unwrap_or_default(),
            stalls: injected.stalls.clone(),
            aftermath: AFTERMATH,
        };
        Self { simulation, plan, injected, strongest_m_s, airframe, plan_text, tags, station }
    }

    /// Whether a station has loaded another plan.
    pub(super) fn is_plan_replaced(&self) -> bool {
        let is_plan = |order: &OperatorOrder| matches!(order, OperatorOrder::Load(_));
        self.simulation.others.iter().any(|(_, _, order)| is_plan(order))
    }

    /// Whether nothing prevents the plan from being completed.
    pub(super) fn is_fair(&self) -> bool {
        let WorldConfig { drone, link, .. } = &self.simulation.world;
        let wind_m_s = drone.wind_m_s.norm() + 3.0 * drone.gusts_m_s;
        self.injected == Injected::default()
            && *link == LinkFaults::default()
            && self.simulation.orders.is_empty()
            // A tag may lie where no search leads.
            && !self.tags.as_ref().is_some_and(Tags::are_sought)
            && drone.battery_percent > 60.0
            && drone.flies_at_m.is_none()
            && wind_m_s < 0.5 * self.strongest_m_s
    }

    /// Description of the flight and its faults, one line each.
    pub(super) fn circumstances(&self) -> Vec<String> {
        let WorldConfig { drone, link, .. } = &self.simulation.world;
        let mut lines = vec![
            format!(
                "airframe {}, sensors {}, battery {:.0} % sagging by {:.0} %, ceiling {:.2} m",
                self.airframe,
                if drone.sensors == SensorModel::hard() { "hard" } else { "nominal" },
                drone.battery_percent,
                drone.battery_sag_percent,
                self.simulation.pilot.limits.ceiling_m,
            ),
            format!(
                "wind {:.2} {:.2} gusts {:.2} m/s, of {:.2} m/s that the airframe resists",
                drone.wind_m_s.x, drone.wind_m_s.y, drone.gusts_m_s, self.strongest_m_s,
            ),
            format!(
                "loss {:.0} %, delay {} + {} ms, doubled {:.0} %, swapped {:.0} %, spoiled {:.0} %",
                100.0 * link.loss,
                link.delay.as_millis(),
                link.jitter.as_millis(),
                100.0 * link.duplication,
                100.0 * link.reordering,
                100.0 * link.corruption,
            ),
            format!("plan: {}", self.plan_text.trim().replace('\n', "; ")),
        ];
        if let Some(tags) = &self.tags {
            lines.extend(tags.circumstances());
        }
        if let Some(height_m) = drone.flies_at_m {
            lines.push(format!("flies at {height_m:.2} m from the start"));
        }
        for (when, action) in &self.injected.accidents {
            lines.push(match when {
                When::SinceStart(at) => format!("{:.2} s: {action:?}", at.as_secs_f64()),
                When::SinceTakeOff(at) => format!("+{:.2} s: {action:?}", at.as_secs_f64()),
            });
        }
        for (at, time) in &self.injected.stalls {
            lines.push(format!("{:.2} s: stalls for {time:?}", at.as_secs_f64()));
        }
        let mut last = None;
        for (at, order) in &self.simulation.orders {
            // A held key is recorded once.
            if last.replace(order) == Some(order) {
                continue;
            }
            lines.push(format!("{:.2} s: ordered to {order:?}", at.as_secs_f64()));
        }
        lines.extend(self.station.iter().flat_map(Station::circumstances));
        lines
    }
}

fn drone(
    random: &mut impl Rng,
    seed: u64,
    profile: Profile,
    strongest_m_s: f64,
    limits: &FlightLimits,
) -> DroneConfig {
    DroneConfig {
        seed,
        profile,
        sensors: if random.random_bool(0.5) { SensorModel::nominal() } else { SensorModel::hard() },
        battery_percent: random.random_range(15.0..100.0),
        battery_sag_percent: if random.random_bool(0.2) {
            random.random_range(0.0..30.0)
        } else {
            0.0
        },
        flies_at_m: random.random_bool(0.04).then(|| random.random_range(0.5..limits.ceiling_m)),
        wind_m_s: wind(random, 0.5 * strongest_m_s),
        gusts_m_s: random.random_range(0.0..0.15) * strongest_m_s,
        trim_error_deg: random.random_range(0.0..1.0),
        ..DroneConfig::default()
    }
}

/// The faults of a flight; `flies`: the drone is in the air from the start.
pub(crate) fn injected(random: &mut impl Rng, strongest_m_s: f64, flies: bool) -> Injected {
    let mut injected = Injected::default();
    for _ in 0..random.random_range(0..4) {
        let at = seconds(random, 0.0, 40.0);
        let when =
            if random.random_bool(0.8) { When::SinceTakeOff(at) } else { When::SinceStart(at) };
        let action = accident(random, strongest_m_s);
        injected.accidents.push((when, action));
    }
    if flies && random.random_bool(0.5) {
        let action = Action::SecondPilot(seconds(random, 1.0, 10.0), first_number(random));
        injected.accidents.push((When::SinceStart(Duration::ZERO), action));
    }
    if random.random_bool(0.05) {
        injected.stalls.push((seconds(random, 1.0, 40.0), seconds(random, 0.05, 3.0)));
    }
    injected
}

fn orders(random: &mut impl Rng) -> Vec<(Duration, OperatorOrder)> {
    let mut orders = Vec::new();
    if random.random_bool(0.4) {
        let mut at = Duration::ZERO;
        for _ in 0..random.random_range(1..6) {
            at += seconds(random, 0.5, 15.0);
            let order = pilot_order(random);
            // A held key repeats.
            let repeats = if matches!(order, OperatorOrder::Steer(_)) { 10 } else { 1 };
            for _ in 0..repeats {
                orders.push((at, order.clone()));
                at += Duration::from_millis(100);
            }
        }
    }
    orders
}

fn plan(random: &mut impl Rng, limits: &FlightLimits, flies: bool) -> String {
    let mut text = if flies && random.random_bool(0.5) {
        "autoTakeover 500 800 0.5 0.5\n"
    } else {
        "takeoff\n"
    }
    .to_owned();
    for _ in 0..random.random_range(1..7) {
        let x = random.random_range(-2.5..2.5);
        let y = random.random_range(-2.5..2.5);
        let z = random.random_range(-0.5..limits.ceiling_m - 0.9);
        let yaw = if random.random_bool(0.3) { random.random_range(-180.0..180.0) } else { 0.0 };
        _ = writeln!(text, "goto {x:.2} {y:.2} {z:.2} {yaw:.0}");
    }
    text + "land\n"
}

/// A link that loses, delays, doubles, swaps and spoils datagrams.
pub(crate) fn link(random: &mut impl Rng) -> LinkFaults {
    LinkFaults {
        loss: random.random_range(0.0..0.4),
        delay: seconds(random, 0.0, 0.08),
        jitter: seconds(random, 0.0, 0.06),
        duplication: random.random_range(0.0..0.2),
        reordering: random.random_range(0.0..0.1),
        corruption: random.random_range(0.0..0.05),
    }
}

fn accident(random: &mut impl Rng, strongest_m_s: f64) -> Action {
    match random.random_range(0..25) {
        0 | 1 => Action::Outage(direction(random), seconds(random, 0.2, 10.0)),
        2 => Action::Outage(direction(random), seconds(random, 0.1, 1.5)),
        3 => Action::Restart,
        4 => Action::Freeze(seconds(random, 0.2, 8.0)),
        5..=11 => sensor(random),
        12 | 13 => {
            let steady_m_s = wind(random, 0.6 * strongest_m_s);
            let left_m_s = strongest_m_s - steady_m_s.norm();
            // Most gusts stay below the strongest wind.
            Action::Wind(steady_m_s, random.random_range(0.0..0.3) * left_m_s)
        }
        14 => {
            let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
            let speed_m_s = random.random_range(1.1..1.8) * strongest_m_s;
            Action::Wind(Vector2::new(sin, cos) * speed_m_s, 0.0)
        }
        15 => Action::Battery(random.random_range(3.0..30.0)),
        16 => Action::BatterySag(random.random_range(0.0..40.0)),
        17 => Action::Loss(direction(random), random.random_range(0.0..0.6)),
        18 => Action::Hold(direction(random), seconds(random, 0.1, 3.0)),
        19 => Action::Burst(random.random_range(1..100)),
        20 => Action::State(claim(random), seconds(random, 0.2, 10.0)),
        21 => {
            // Neither velocity nor altitude is measured, whatever the drone does.
            let minor = if random.random_bool(0.5) { 2 } else { 6 };
            Action::Minor(minor, seconds(random, 0.2, 10.0))
        }
        22 => Action::Motor(random.random_range(0.8..1.0), seconds(random, 0.0, 5.0)),
        23 => Action::SecondPilot(seconds(random, 0.5, 8.0), first_number(random)),
        _ if random.random_bool(0.3) => Action::Propeller,
        _ => Action::Battery(random.random_range(3.0..30.0)),
    }
}

/// One quantity with one fault. Faults that cannot be detected for long do not last long.
fn sensor(random: &mut impl Rng) -> Action {
    let quantity = Quantity::ALL[random.random_range(0..Quantity::ALL.len())];
    // Magnitude of a bad case, in the unit of the quantity.
    let most = match quantity {
        Quantity::VelocityRight | Quantity::VelocityForward => 3.0,
        Quantity::Altitude => 1.0,
        Quantity::Yaw => 60.0,
        Quantity::Roll | Quantity::Pitch => 15.0,
        Quantity::Clock => 20.0,
    };
    let value = random.random_range(-most..most);
    let long = seconds(random, 0.2, 30.0);
    let short = seconds(random, 0.2, 8.0);
    let (fault, time) = match random.random_range(0..9) {
        0 => (SensorFault::Stuck, long),
        1 => (SensorFault::StuckAt(0.5 * value), long),
        2 => (SensorFault::DeadAt(0.0), long),
        3 => (SensorFault::Offset(value), short),
        4 => (SensorFault::Ramp(0.2 * value), short),
        5 if quantity.is_float() => (SensorFault::NotANumber, long),
        6 => (SensorFault::Noise(noise(random, quantity)), long),
        7 => (SensorFault::Gain(gain(random, quantity)), long),
        _ => (SensorFault::Late(seconds(random, 0.05, 1.0)), short),
    };
    Action::Sensor(quantity, fault, time)
}

/// Standard deviation of noise, from what is hardly noticed to what is worthless.
fn noise(random: &mut impl Rng, quantity: Quantity) -> f64 {
    match quantity {
        Quantity::VelocityRight | Quantity::VelocityForward | Quantity::Altitude => {
            random.random_range(0.1..1.0)
        }
        Quantity::Yaw | Quantity::Roll | Quantity::Pitch => random.random_range(2.0..20.0),
        Quantity::Clock => random.random_range(0.01..0.1),
    }
}

/// A wrong gain. A velocity that shows too little is that of a weaker airframe, and is not judged.
fn gain(random: &mut impl Rng, quantity: Quantity) -> f64 {
    match quantity {
        Quantity::VelocityRight | Quantity::VelocityForward => random.random_range(1.2..3.0),
        _ if random.random_bool(0.3) => -1.0,
        _ => random.random_range(0.2..3.0),
    }
}

fn direction(random: &mut impl Rng) -> Direction {
    match random.random_range(0..4) {
        0 => Direction::Up,
        1 => Direction::Down,
        _ => Direction::Both,
    }
}

/// A state bit reported by the drone.
fn claim(random: &mut impl Rng) -> DroneState {
    const CLAIMS: [DroneState; 10] = [
        DroneState::ULTRASOUND_DEAF,
        DroneState::ULTRASOUND_DEAF,
        DroneState::MOTORS_PROBLEM,
        DroneState::SOFTWARE_FAULT,
        DroneState::ANGLES_OUT_OF_RANGE,
        DroneState::CUTOUT_DETECTED,
        DroneState::BATTERY_LOW,
        DroneState::COMMUNICATION_WATCHDOG,
        DroneState::COMMUNICATION_LOST,
        DroneState::COMMAND_ACKNOWLEDGE,
    ];
    CLAIMS[random.random_range(0..CLAIMS.len())]
}

/// First sequence number of a client that has just started, or has flown for minutes.
fn first_number(random: &mut impl Rng) -> u32 {
    if random.random_bool(0.5) { 1 } else { 5000 }
}

fn pilot_order(random: &mut impl Rng) -> OperatorOrder {
    match random.random_range(0..12) {
        0 | 1 => OperatorOrder::Hold,
        2..=4 => OperatorOrder::Resume,
        5..=7 => {
            let mut stick = || random.random_range(-1.0..1.0);
            OperatorOrder::Steer(Sticks {
                roll: stick(),
                pitch: stick(),
                gaz: stick(),
                yaw: stick(),
            })
        }
        8 => OperatorOrder::Land,
        9 | 10 => {
            let mut place_m = || random.random_range(-15.0..15.0);
            OperatorOrder::GoTo(Place::at(place_m(), place_m()))
        }
        _ if random.random_bool(0.1) => OperatorOrder::Cut,
        _ => OperatorOrder::Resume,
    }
}

/// A random direction with a limited speed.
fn wind(random: &mut impl Rng, most_m_s: f64) -> Vector2<f64> {
    let speed_m_s = random.random_range(0.0..most_m_s);
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    Vector2::new(sin, cos) * speed_m_s
}

fn seconds(random: &mut impl Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(random.random_range(from..to))
}
