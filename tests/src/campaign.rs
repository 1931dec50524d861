//! The fault campaign: flights on which anything may go wrong, and what must hold all the same.
//!
//! Everything about a flight follows from its seed: the airframe, its sensors, the air, the link, what
//! breaks and when, and what the pilot orders meanwhile. [`fly`] flies it and [judges](Verdict) it
//! against the truth.

use std::fmt::{self, Write as _};
use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::pilot::{FlightEvent, LandingReason, PilotConfig, PilotOrder, Trust};
use autopilot::plan::FlightLimits;
use autopilot::sim::{Moment, Simulation, SimulationError};
use autopilot::{Demand, Plan};
use mock_drone::airframe::{Profile, ThrustLaw};
use mock_drone::firmware::Phase;
use mock_drone::scenario::{Action, Direction, Scenario, When};
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, Quantity, SensorFault, WorldConfig};
use nalgebra::Vector2;
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// The fence of the campaign.
const RADIUS_M: f64 = 4.0;
/// A drone may be so far outside it.
const MARGIN_M: f64 = 0.5;
/// No flight takes longer: its plan has at most seven targets.
const LONGEST: Duration = Duration::from_mins(10);
/// An order may take so long to arrive.
const ON_ITS_WAY: Duration = Duration::from_millis(500);
/// Each plan begins with it.
const TAKE_OFF_STEP: usize = 0;
/// A drone that was not seen needs so long to slow down once it is.
const SLOWING_DOWN: Duration = Duration::from_secs(1);
/// So long is watched whether a drone that hears nothing lands by itself.
const AFTERMATH: Duration = Duration::from_secs(45);

/// How a flight was, seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Everything follows from it.
    pub seed: u64,
    /// How the pilot says that it ended.
    pub outcome: Outcome,
    /// Why the plan was given up, if it was.
    pub landing: Option<LandingReason>,
    /// The safety layer had its say.
    pub vetoed: bool,
    /// How far the drone was outside the fence, beyond what navdata themselves were wrong by.
    pub outside_m: f64,
    /// How far it strayed outside while it was not heard, or its navdata were known to be wrong.
    pub unseen_m: f64,
    /// How wrong the place was at most that navdata gave.
    pub wrong_m: f64,
    /// What must never happen and did.
    pub faults: Vec<Fault>,
    /// What happened, and when.
    pub events: Vec<(Duration, FlightEvent)>,
}

/// What must never happen.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// The drone was neither on the ground nor in its emergency at the end.
    StillFlying(Phase),
    /// It was too far outside the fence.
    OutsideFence,
    /// It took off without being told to by the plan.
    UncommandedTakeOff,
    /// The flight took longer than any flight does.
    Hanging,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StillFlying(phase) => write!(f, "still flying: {phase:?}"),
            Self::OutsideFence => f.write_str("outside the fence"),
            Self::UncommandedTakeOff => f.write_str("uncommanded take-off"),
            Self::Hanging => f.write_str("hanging"),
        }
    }
}

/// Flies the flight of a seed.
///
/// # Errors
/// [`SimulationError`] if the flight never ends: that is the campaign's own failure.
pub fn fly(seed: u64) -> Result<Verdict, SimulationError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (simulation, plan) = flight(seed, &mut random);
    let mut watcher = Watcher::new(simulation.pilot.limits);
    let flown = simulation.fly_watched(plan, |moment| watcher.watch(moment))?;
    let mut faults = Vec::new();
    if !matches!(flown.final_truth.phase, Phase::Landed | Phase::Emergency) {
        faults.push(Fault::StillFlying(flown.final_truth.phase));
    }
    if watcher.outside_m > MARGIN_M {
        faults.push(Fault::OutsideFence);
    }
    if watcher.uncommanded {
        faults.push(Fault::UncommandedTakeOff);
    }
    if flown.duration > LONGEST {
        faults.push(Fault::Hanging);
    }
    let landing = flown.events.iter().find_map(|(_, event)| match event {
        FlightEvent::LandingOrdered(reason) => Some(*reason),
        _ => None,
    });
    let vetoed = flown.events.iter().any(|(_, event)| matches!(event, FlightEvent::Veto(_)));
    Ok(Verdict {
        seed,
        outcome: flown.outcome,
        landing,
        vetoed,
        outside_m: watcher.outside_m,
        unseen_m: watcher.unseen_m,
        wrong_m: watcher.wrong_m,
        faults,
        events: flown.events,
    })
}

/// Watches the truth.
struct Watcher {
    fence: FlightLimits,
    outside_m: f64,
    unseen_m: f64,
    /// How wrong the estimate is, while the drone is seen.
    wrong_m: f64,
    /// When the drone was last not seen.
    unseen_at: Option<Duration>,
    /// The drone is outside the fence, and flew there unseen.
    strayed_unseen: bool,
    /// The drone is landing, and began to unseen.
    lands_unseen: bool,
    last_phase: Phase,
    /// When the plan's take-off was last ordered.
    ordered_at: Option<Duration>,
    uncommanded: bool,
}

impl Watcher {
    fn new(fence: FlightLimits) -> Self {
        Self {
            fence,
            outside_m: 0.0,
            unseen_m: 0.0,
            wrong_m: 0.0,
            unseen_at: None,
            strayed_unseen: false,
            lands_unseen: false,
            last_phase: Phase::Landed,
            ordered_at: None,
            uncommanded: false,
        }
    }

    fn watch(&mut self, moment: &Moment) {
        let Moment { now, truth, status } = moment;
        let pose = &status.pose;
        let truth_m = truth.position_m;
        let seen = status.trust == Trust::Sound
            && status.navdata_age.is_some_and(|age| age < Duration::from_millis(300));
        if seen {
            let off = (truth_m.x - pose.x_m).hypot(truth_m.y - pose.y_m);
            // What navdata were wrong by stays: nobody can know better.
            self.wrong_m = self.wrong_m.max(off.hypot(truth_m.z - pose.z_m));
        } else {
            self.unseen_at = Some(*now);
        }
        let across_m = truth_m.x.hypot(truth_m.y) - self.fence.radius_m;
        let above_m = truth_m.z - self.fence.ceiling_m;
        let outside_m = across_m.max(above_m) - self.wrong_m;
        // What is blown over the fence unseen is there before anybody can act; a landing that began
        // unseen is not taken back.
        let was_unseen = self.unseen_at.is_some_and(|at| now.saturating_sub(at) < SLOWING_DOWN);
        let goes_on = self.last_phase == Phase::Landing;
        self.lands_unseen =
            truth.phase == Phase::Landing && if goes_on { self.lands_unseen } else { was_unseen };
        self.strayed_unseen =
            outside_m > 0.0 && (self.strayed_unseen || self.lands_unseen || was_unseen);
        if self.strayed_unseen {
            self.unseen_m = self.unseen_m.max(outside_m);
        } else {
            self.outside_m = self.outside_m.max(outside_m);
        }
        let rises = matches!(truth.phase, Phase::TakingOff { .. })
            && !matches!(self.last_phase, Phase::TakingOff { .. });
        if status.phase == "flying" && status.step == Some(TAKE_OFF_STEP) {
            self.ordered_at = Some(*now);
        }
        let ordered = self.ordered_at.is_some_and(|at| now.saturating_sub(at) <= ON_ITS_WAY);
        self.uncommanded |= rises && !ordered;
        self.last_phase = truth.phase;
    }
}

/// The world, the pilot and the plan of a seed.
fn flight(seed: u64, random: &mut ChaCha8Rng) -> (Simulation, Plan) {
    let profiles = [Profile::rec(), Profile::tum(), Profile::tf(), Profile::leo()];
    let limits = FlightLimits {
        radius_m: RADIUS_M,
        ceiling_m: random.random_range(1.6..3.0),
        ..FlightLimits::default()
    };
    let profile = profiles[random.random_range(0..profiles.len())];
    let strongest_m_s = strongest_wind_m_s(&profile);
    let drone = DroneConfig {
        seed,
        profile,
        sensors: if random.random_bool(0.5) { SensorModel::nominal() } else { SensorModel::hard() },
        battery_percent: random.random_range(15.0..100.0),
        wind_m_s: wind(random, 0.5 * strongest_m_s),
        gusts_m_s: random.random_range(0.0..0.15) * strongest_m_s,
        trim_error_deg: random.random_range(0.0..1.0),
        ..DroneConfig::default()
    };
    let link = if random.random_bool(0.3) { LinkFaults::default() } else { link(random) };
    let mut scenario = Scenario::default();
    for _ in 0..random.random_range(0..4) {
        let at = seconds(random, 0.0, 40.0);
        let when =
            if random.random_bool(0.8) { When::SinceTakeOff(at) } else { When::SinceStart(at) };
        scenario = scenario.and(when, accident(random, strongest_m_s));
    }
    let mut orders = Vec::new();
    if random.random_bool(0.4) {
        let mut at = Duration::ZERO;
        for _ in 0..random.random_range(1..6) {
            at += seconds(random, 0.5, 15.0);
            let order = pilot_order(random);
            // A key that is held down repeats.
            let repeats = if matches!(order, PilotOrder::Steer(_)) { 10 } else { 1 };
            for _ in 0..repeats {
                orders.push((at, order));
                at += Duration::from_millis(100);
            }
        }
    }
    let plan = plan(random, &limits);
    let simulation = Simulation {
        world: WorldConfig { drone, link, scenario },
        pilot: PilotConfig { limits, ..PilotConfig::default() },
        orders,
        stalls: Vec::new(),
        aftermath: AFTERMATH,
    };
    (simulation, plan)
}

/// The wind that the airframe just resists at 12 degrees of tilt: what is blown away by more is lost to
/// any pilot.
fn strongest_wind_m_s(profile: &Profile) -> f64 {
    let tilt_rad = 12_f64.to_radians();
    let acceleration = match profile.thrust {
        ThrustLaw::CarriesWeight => Vector2::repeat(9.81 * tilt_rad.tan()),
        ThrustLaw::Sine { acceleration_m_s2 } => {
            Vector2::repeat(acceleration_m_s2 * tilt_rad.sin())
        }
        ThrustLaw::Linear { acceleration_m_s2 } => acceleration_m_s2 * tilt_rad,
    };
    // Quadratic drag makes it a little less.
    0.8 * acceleration.component_div(&profile.linear_drag_1_s).min()
}

fn plan(random: &mut impl Rng, limits: &FlightLimits) -> Plan {
    let mut text = "takeoff\n".to_owned();
    for _ in 0..random.random_range(1..7) {
        let x = random.random_range(-2.5..2.5);
        let y = random.random_range(-2.5..2.5);
        let z = random.random_range(-0.5..limits.ceiling_m - 0.9);
        let yaw = if random.random_bool(0.3) { random.random_range(-180.0..180.0) } else { 0.0 };
        _ = writeln!(text, "goto {x:.2} {y:.2} {z:.2} {yaw:.0}");
    }
    text += "land\n";
    Plan::parse_within("campaign", &text, limits).unwrap_or_else(|error| panic!("{error}"))
}

fn link(random: &mut impl Rng) -> LinkFaults {
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
    match random.random_range(0..9) {
        0 => Action::Outage(Direction::Both, seconds(random, 0.2, 10.0)),
        1 => Action::Restart,
        2 => Action::Freeze(seconds(random, 0.2, 8.0)),
        3 | 4 => {
            let (quantity, offset) = match random.random_range(0..3) {
                0 => (Quantity::Altitude, random.random_range(-1.0..1.0)),
                1 => (Quantity::VelocityRight, random.random_range(-3.0..3.0)),
                _ => (Quantity::Yaw, random.random_range(-60.0..60.0)),
            };
            Action::Sensor(quantity, SensorFault::Offset(offset), seconds(random, 0.2, 8.0))
        }
        5 => {
            let steady_m_s = wind(random, 0.6 * strongest_m_s);
            let left_m_s = strongest_m_s - steady_m_s.norm();
            // Most gusts stay below the strongest wind.
            Action::Wind(steady_m_s, random.random_range(0.0..0.3) * left_m_s)
        }
        6 => Action::Battery(random.random_range(3.0..30.0)),
        7 => Action::Loss(Direction::Both, random.random_range(0.0..0.6)),
        _ if random.random_bool(0.2) => Action::Propeller,
        _ => Action::Outage(Direction::Both, seconds(random, 0.1, 1.5)),
    }
}

fn pilot_order(random: &mut impl Rng) -> PilotOrder {
    match random.random_range(0..12) {
        0 | 1 => PilotOrder::Hold,
        2..=4 => PilotOrder::Resume,
        5..=7 => {
            let mut stick = || random.random_range(-1.0..1.0);
            PilotOrder::Steer(Demand { roll: stick(), pitch: stick(), gaz: stick(), yaw: stick() })
        }
        8 => PilotOrder::Land,
        9 | 10 => {
            let mut place_m = || random.random_range(-15.0..15.0);
            PilotOrder::GoTo { x_m: place_m(), y_m: place_m() }
        }
        _ if random.random_bool(0.1) => PilotOrder::Cut,
        _ => PilotOrder::Resume,
    }
}

/// Any direction, up to a speed.
fn wind(random: &mut impl Rng, most_m_s: f64) -> Vector2<f64> {
    let speed_m_s = random.random_range(0.0..most_m_s);
    let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
    Vector2::new(sin, cos) * speed_m_s
}

fn seconds(random: &mut impl Rng, from: f64, to: f64) -> Duration {
    Duration::from_secs_f64(random.random_range(from..to))
}
