//! Estimates the drone's position from its navdata and from the orders sent to it.
//!
//! The AR.Drone reports velocity in its own frame, attitude, heading, and height above the ground, each with
//! a known delay. The [`Estimator`] processes these [`Sample`]s and every [`Order`] that was sent. It
//!
//! - integrates the velocity to a position, each sample rotated by the heading of the same instant, over
//!   the time at which it was measured, so that late, lost or bunched packets do not change the result;
//! - runs a model of the drone under the orders, which covers the time between and after the
//!   measurements ([`Estimator::predicted`]), and estimates the disturbance from the difference;
//! - identifies how this airframe responds to its sticks ([`Estimator::airframe`]);
//! - reports its uncertainty ([`Estimator::uncertainty_m`]) and whether navdata are
//!   plausible ([`Estimator::trust`]).
//!
//! It is pure: samples and orders in, [`Estimate`]s out.
//!
//! Frame, called the world: x right, y forward, z up, in metres; yaw in degrees, clockwise from above. The origin is where
//! the drone stood at the start, and yaw is zero at its heading there, unless [`EstimatorConfig::start`] puts it elsewhere;
//! z is zero on the floor there. An integrated velocity is a position that drifts.
//!
//! ```
//! use std::time::Duration;
//! use estimator::{Estimator, Sample};
//!
//! let mut estimator = Estimator::default();
//! for tick in 0..=10 {
//!     estimator.update(&Sample {
//!         arrival: Duration::from_millis(100 * tick),
//!         yaw_deg: 37.0,
//!         velocity_forward_m_s: if tick % 2 == 0 { 0.45 } else { 0.55 },
//!         airborne: true,
//!         ..Sample::default()
//!     });
//! }
//! let position = estimator.estimate().position_m;
//! assert!((position.y - 0.5).abs() < 1e-9 && position.x.abs() < 1e-9);
//! ```
#![forbid(unsafe_code)]

mod bank;
mod belief;
mod clock;
mod heading;
mod horizontal;
mod identification;
mod noise;
mod orders;
mod rejected;
mod repetition;
mod response;
mod sensor;
mod silence;
mod trust;
mod uncertainty;
mod unheard;
mod velocity_gate;
mod vertical;
mod world;

use std::time::Duration;

use kinematics::{Airframe, DroneLimits, world_from_body, wrap_deg};
use nalgebra::{Vector2, Vector3};

pub use orders::Order;
pub use trust::{Quantity, Trust, Worth};
pub use world::{
    KnownTag, KnownTags, MAX_SIGHTS, MAX_TAGS, NoRoom, OrientationSign, Sight, SurveyedTag,
    TagConfig, TagStatus,
};

use crate::belief::{Beliefs, Cause, ENOUGH_S, Evidence};
use crate::clock::SampleClock;
use crate::heading::Heading;
use crate::horizontal::{Horizontal, ObserverGains};
use crate::identification::Identification;
use crate::noise::NoiseOfAll;
use crate::orders::Orders;
use crate::repetition::Repetitions;
use crate::response::{Measured, Response};
use crate::silence::{GAP_S, USUAL_STEP_S};
use crate::uncertainty::Uncertainty;
use crate::velocity_gate::{Foreseen, Judged, VelocityGate};
use crate::vertical::{AltitudeFilter, Echo, Vertical};
use crate::world::{OdometryStep, World};

/// The motion reported by one navdata packet.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sample {
    /// Time of arrival, on the pilot's clock.
    pub arrival: Duration,
    /// Time of measurement on the drone's clock, which wraps after 2048 s, if the drone sent it.
    pub drone_time: Option<Duration>,
    /// Heading, clockwise positive, with an arbitrary zero; jumps at ±180.
    pub yaw_deg: f64,
    /// Right side down.
    pub roll_deg: f64,
    /// Nose up.
    pub pitch_deg: f64,
    /// Forward velocity, levelled body frame.
    pub velocity_forward_m_s: f64,
    /// Rightward velocity, levelled body frame.
    pub velocity_right_m_s: f64,
    /// Height above the ground below.
    pub altitude_m: f64,
    /// Whether the drone is airborne; its velocity on the ground is meaningless.
    pub airborne: bool,
    /// Whether it takes off or lands by itself, whatever its sticks ask for.
    pub autonomous: bool,
    /// The quantity that the drone itself reports as lost, if any.
    pub reported_lost: Option<Quantity>,
}

/// Limits, delays and gains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EstimatorConfig {
    /// The drone's limits at full stick.
    pub limits: DroneLimits,
    /// The airframe that is assumed before identification.
    pub airframe: Airframe,
    /// Time from an order to the motors.
    pub dead_time: Duration,
    /// Age of a velocity when its packet is sent: the optical flow and its filter.
    pub velocity_delay: Duration,
    /// Age of an altitude: the ultrasound's own interval.
    pub altitude_delay: Duration,
    /// Age of attitude and heading.
    pub attitude_delay: Duration,
    /// Observer gain of the velocity.
    pub velocity_gain_1_s: f64,
    /// Observer gain of the disturbance.
    pub disturbance_gain_1_s2: f64,
    /// Limit of the disturbance.
    pub disturbance_max_m_s2: f64,
    /// Whether the airframe is identified in flight.
    pub identify: bool,
    /// Use of tags on the floor, if any.
    pub tags: Option<TagConfig>,
    /// Where the drone stands in the world at the start; at the origin with yaw zero if `None`.
    pub start: Option<Start>,
}

/// Where a drone stands at the start, in a world that it shares with others.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Start {
    /// Its place: (x, y) in the world.
    pub place_m: Vector2<f64>,
    /// Its yaw in the world.
    pub heading_deg: f64,
    /// Standard deviation of the place on the worse axis.
    pub uncertainty_m: f64,
    /// Standard deviation of the heading.
    pub heading_uncertainty_deg: f64,
}

impl Start {
    /// A place right and forward of a drone that stands there, in the world.
    pub fn in_world(&self, place_m: Vector2<f64>) -> Vector2<f64> {
        self.place_m + world_from_body(place_m, self.heading_deg)
    }

    /// A place in the world, right and forward of a drone that stands there.
    pub fn seen_from_here(&self, place_m: Vector2<f64>) -> Vector2<f64> {
        world_from_body(place_m - self.place_m, -self.heading_deg)
    }
}

impl Default for EstimatorConfig {
    fn default() -> Self {
        Self {
            limits: DroneLimits::default(),
            airframe: Airframe::default(),
            dead_time: Duration::from_millis(70),
            velocity_delay: Duration::from_millis(60),
            altitude_delay: Duration::from_millis(40),
            attitude_delay: Duration::from_millis(20),
            velocity_gain_1_s: 10.0,
            disturbance_gain_1_s2: 5.0,
            disturbance_max_m_s2: 4.0,
            identify: true,
            tags: None,
            start: None,
        }
    }
}

/// Measured position and motion in the world, by the newest sample: each quantity is as old as its delay in
/// [`EstimatorConfig`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Estimate {
    /// When that sample arrived.
    pub at: Duration,
    /// x, y, z.
    pub position_m: Vector3<f64>,
    /// Along x, y, z.
    pub velocity_m_s: Vector3<f64>,
    /// Clockwise, in [-180, 180).
    pub yaw_deg: f64,
    /// Height above the floor below the drone, which may differ from the floor at the start.
    pub above_floor_m: f64,
}

/// Predicted position and motion in the world at a time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Prediction {
    /// x, y, z.
    pub position_m: Vector3<f64>,
    /// Along x, y, z.
    pub velocity_m_s: Vector3<f64>,
    /// Clockwise, in [-180, 180).
    pub yaw_deg: f64,
    /// Clockwise.
    pub turn_deg_s: f64,
    /// Acceleration that does not come from the sticks: wind, a wrong level reference. Along x and y.
    pub disturbance_m_s2: Vector2<f64>,
    /// The same as the newest measurement shows it: sooner, and with its noise.
    pub newest_disturbance_m_s2: Vector2<f64>,
}

/// Estimates the drone's position from samples and orders.
#[derive(Debug, Clone)]
pub struct Estimator {
    config: EstimatorConfig,
    clock: SampleClock,
    orders: Orders,
    heading: Heading,
    horizontal: Horizontal,
    /// Time of `horizontal`.
    velocity_at_s: Option<f64>,
    /// The velocity in navdata at that time: forward and to the right.
    last_velocity_m_s: Option<Vector2<f64>>,
    velocity_gate: VelocityGate,
    altitude: AltitudeFilter,
    /// Time and value of the last altitude.
    altitude_at: Option<(f64, f64)>,
    /// The last two altitudes of a drone that stands.
    standing_m: [f64; 2],
    identification: Identification,
    beliefs: Beliefs,
    repetitions: Repetitions,
    response: Response,
    noise: NoiseOfAll,
    uncertainty: Uncertainty,
    /// Since when the altitude is that of a drone on the floor although it follows its sticks.
    low_since_s: Option<f64>,
    airborne_since_s: Option<f64>,
    airborne: bool,
    estimate: Estimate,
    world: Box<World>,
}

impl Default for Estimator {
    fn default() -> Self {
        Self::new(EstimatorConfig::default())
    }
}

/// Longest gap that is bridged by the mean of the velocities around it. A drone that receives nothing hovers
/// and then lands by itself.
const MAX_STEP_S: f64 = 3.0;
/// A repeated altitude after this time is a new measurement with the same value: the ultrasound measures 22
/// or 25 times per second.
const ALTITUDE_INTERVAL_S: f64 = 0.05;
/// Below this height a drone that takes off or lands does not hold its position yet.
const CLEAR_OF_GROUND_M: f64 = 0.4;
/// Time after which a take-off is clear of the ground.
const TAKE_OFF_S: f64 = 3.0;
/// A drone that follows its sticks does not fly this low: it is on the floor, or its altitude is wrong.
const ON_FLOOR_M: f64 = 0.1;
/// Time in which an order shows in the attitude, also through a link that delays it.
const RECENT_S: f64 = 0.5;
/// Furthest prediction beyond the newest sample, besides the delay of the link.
const MAX_PREDICTION_S: f64 = 0.6;

impl Estimator {
    /// An estimator without samples.
    pub fn new(config: EstimatorConfig) -> Self {
        let start = config.start.unwrap_or_default();
        Self {
            clock: SampleClock::default(),
            orders: Orders::new(config.dead_time),
            heading: Heading::new(start.heading_deg),
            horizontal: Horizontal::default(),
            velocity_at_s: None,
            last_velocity_m_s: None,
            velocity_gate: VelocityGate::default(),
            altitude: AltitudeFilter::default(),
            altitude_at: None,
            // Nothing has been measured yet.
            standing_m: [f64::INFINITY; 2],
            identification: Identification::new(config.airframe, config.limits),
            beliefs: Beliefs::new(),
            repetitions: Repetitions::default(),
            response: Response::new(),
            noise: NoiseOfAll::default(),
            uncertainty: Uncertainty::default(),
            low_since_s: None,
            airborne_since_s: None,
            airborne: false,
            // Until something is measured it is where it stands.
            estimate: Estimate {
                position_m: start.place_m.push(0.0),
                yaw_deg: wrap_deg(start.heading_deg),
                ..Estimate::default()
            },
            world: Box::new(World::new(config.tags.as_ref(), &start)),
            config,
        }
    }

    /// An order was sent to the drone at `sent_at` on the pilot's clock, as [`Sample::arrival`]. Orders come in that order; the
    /// last hundred are kept.
    pub fn order_sent(&mut self, sent_at: Duration, order: Order) {
        self.orders.push(sent_at, order);
    }

    /// The time on the link, to the drone and back, as measured before the flight. In flight it is identified by
    /// the drone's response.
    pub fn expect_link_delay(&mut self, delay: Duration) {
        self.identification.expect_link_delay(delay.as_secs_f64());
        self.orders.set_link_delay(self.identification.link_delay_s());
    }

    /// Time from an order to its effect in the samples.
    pub fn order_delay(&self) -> Duration {
        Duration::from_secs_f64(self.orders.delay_s().max(0.0))
    }

    /// Processes the next sample. Samples come in the order of the drone's packets. Nothing of a sample with a value that is
    /// impossible for an AR.Drone is used, but it counts against [`Estimator::trust`].
    pub fn update(&mut self, sample: &Sample) {
        let made_s = self.clock.made_s(sample.drone_time, sample.arrival);
        let arrival_s = sample.arrival.as_secs_f64();
        let lateness_s = arrival_s - made_s;
        self.heading.hear(made_s);
        self.velocity_gate.hear(made_s);
        let is_news = lateness_s <= GAP_S;
        let against = |cause: Cause| {
            move |quantity: Quantity| Evidence { quantity, cause, since_s: arrival_s }
        };
        if let Some(quantity) = sensor::impossible(sample) {
            // Such a packet is not used, and is no news.
            self.beliefs.weigh(arrival_s, &[Some(against(Cause::Value)(quantity))], false);
            return;
        }
        let was_airborne = std::mem::replace(&mut self.airborne, sample.airborne);
        let attitude_s = made_s - self.config.attitude_delay.as_secs_f64();
        if sample.autonomous {
            self.orders.set_autonomous(made_s);
        }
        let turned = self.update_attitude(attitude_s, sample);
        let believed = self.update_horizontal(made_s, sample, was_airborne);
        let floor_stepped = self.update_vertical(made_s, sample);
        let vertical = self.altitude.state();
        self.estimate = Estimate {
            at: sample.arrival,
            position_m: self.horizontal.position_m.push(vertical.height_m),
            velocity_m_s: self.horizontal.measured_m_s().push(vertical.climb_m_s),
            yaw_deg: wrap_deg(self.heading_at(attitude_s)),
            above_floor_m: self.altitude.above_floor_m(vertical.height_m),
        };

        // Not by one echo, which may be wrong.
        let is_low = self.estimate.above_floor_m < CLEAR_OF_GROUND_M;
        // Near the ground a drone that takes off or lands may see nothing: its flow however long the motors need, its ultrasound
        // until it has lifted off. A frozen one says for ever that it does so.
        let rests = sample.autonomous && is_low;
        let airborne_since_s = *self.airborne_since_s.get_or_insert(arrival_s);
        if !sample.airborne {
            self.airborne_since_s = None;
        }
        let takes_off = arrival_s - airborne_since_s < TAKE_OFF_S;
        let may_rest = |quantity| match quantity {
            Quantity::Velocity => rests,
            Quantity::Altitude => rests && takes_off,
            Quantity::Heading | Quantity::Attitude => false,
        };
        let repeated = self.repetitions.watch(arrival_s, sample, may_rest);
        // What has summed up began before.
        let summed_up = |it: Evidence| Evidence { since_s: it.since_s - ENOUGH_S, ..it };
        let stepped = [(turned, Quantity::Heading), (floor_stepped, Quantity::Altitude)];
        let [turned, floor_stepped] =
            stepped.map(|(stepped, quantity)| stepped.then_some(quantity));
        let evidence = [
            (!believed).then_some(Quantity::Velocity).map(against(Cause::Value)),
            repeated.map(|(quantity, since_s)| Evidence {
                since_s,
                ..against(Cause::Repetition)(quantity)
            }),
            self.watch_noise(made_s, sample).map(against(Cause::Noise)).map(summed_up),
            sample.reported_lost.filter(|_| sample.airborne).map(against(Cause::Report)),
            self.watch_response(attitude_s, sample).map(against(Cause::Response)).map(summed_up),
            turned.map(against(Cause::Step)),
            floor_stepped.map(against(Cause::Step)),
        ];
        self.beliefs.weigh(arrival_s, &evidence, is_news);

        self.move_world(made_s, sample);
    }

    /// Moves the world frame along with the odometry.
    fn move_world(&mut self, made_s: f64, sample: &Sample) {
        let at_s = self.velocity_at_s.unwrap_or(made_s);
        let yaw_deg = self.heading_at(at_s);
        let attitude_s = made_s - self.config.attitude_delay.as_secs_f64();
        let height_s = made_s - self.config.altitude_delay.as_secs_f64();
        self.world.fly(&OdometryStep {
            made_s,
            at_s,
            place_m: self.horizontal.position_m,
            velocity_m_s: self.horizontal.measured_m_s(),
            yaw_deg,
            tilt: (attitude_s, Vector2::new(sample.roll_deg, sample.pitch_deg)),
            height: (height_s, self.estimate.above_floor_m),
            echo_m: sample.altitude_m,
            airborne: sample.airborne,
            unseen_m2: self.uncertainty.unmeasured_m2(),
        });
        self.move_into_world();
    }

    /// Transforms the newest estimate from the odometry to the world frame.
    fn move_into_world(&mut self) {
        let at_s = self.velocity_at_s.unwrap_or_default();
        let heading_deg = self.heading_at(at_s);
        let velocity_m_s = self.horizontal.measured_m_s();
        let estimate = &mut self.estimate;
        let yaw_deg = self.heading.newest_deg();
        estimate.position_m =
            self.world.place_m(self.horizontal.position_m).push(estimate.position_m.z);
        estimate.velocity_m_s =
            self.world.velocity_m_s(velocity_m_s, heading_deg).push(estimate.velocity_m_s.z);
        estimate.yaw_deg = wrap_deg(self.world.heading_deg(yaw_deg));
    }

    /// Processes the tags in the packet of the newest sample, the first [`MAX_SIGHTS`] of them. They are ignored without
    /// [`EstimatorConfig::tags`], on the ground, and if they are those of the packet before.
    pub fn see(&mut self, sights: &[Sight]) {
        let turn_deg_s = self.heading.newest_turn_deg_s();
        let Self { config, orders, heading, identification, world, .. } = self;
        let airframe = identification.airframe();
        let heading_at = |at_s| heading.at(at_s, orders, airframe, &config.limits);
        world.see(sights, heading_at, turn_deg_s, self.airborne);
        self.move_into_world();
    }

    /// Returns whether the compass made a step.
    fn update_attitude(&mut self, attitude_s: f64, sample: &Sample) -> bool {
        let Self { config, orders, heading, identification, world, .. } = self;
        let airframe = *identification.airframe();
        let stepped = heading.update(attitude_s, sample.yaw_deg, orders, &airframe, &config.limits);
        if stepped {
            world.step_of_the_heading();
        }
        if config.identify {
            let tilt_deg = Vector2::new(sample.roll_deg, -sample.pitch_deg);
            identification.tilt(attitude_s, tilt_deg.map(f64::to_radians), orders);
            orders.set_link_delay(identification.link_delay_s());
            // While the compass hangs, the heading is what the airframe is already thought to do.
            if let Some(yaw_deg) = heading.measured_deg(attitude_s) {
                identification.heading(attitude_s, yaw_deg, orders);
            }
        }
        stepped
    }

    /// Returns a quantity that is noisier than its sensor.
    fn watch_noise(&mut self, made_s: f64, sample: &Sample) -> Option<Quantity> {
        if !sample.airborne {
            self.noise = NoiseOfAll::default();
            return None;
        }
        let limits = &self.config.limits;
        let recent_s = made_s - RECENT_S;
        let steered = self.orders.variation(recent_s, made_s);
        self.noise.watch(made_s, sample, limits, steered)
    }

    fn watch_response(&mut self, at_s: f64, sample: &Sample) -> Option<Quantity> {
        let measured = Measured {
            at_s,
            altitude_m: self.altitude.state().height_m,
            // Without the steps of the compass.
            yaw_deg: self.heading.newest_deg(),
            velocity_m_s: Vector2::new(sample.velocity_right_m_s, sample.velocity_forward_m_s),
            tilt_rad: Vector2::new(sample.roll_deg, -sample.pitch_deg).map(f64::to_radians),
        };
        if !sample.airborne {
            self.response.stand();
            self.low_since_s = None;
            return None;
        }
        let by_sticks = self.orders.at(at_s) != Order::ByItself;
        let is_low = by_sticks && sample.altitude_m < ON_FLOOR_M;
        self.low_since_s = is_low.then(|| self.low_since_s.unwrap_or(at_s));
        let scrapes = self.low_since_s.is_some_and(|since_s| at_s - since_s >= ENOUGH_S);
        let unresponsive = self.response.watch(&measured, &self.orders, &self.config.limits);
        unresponsive.or(scrapes.then_some(Quantity::Altitude))
    }

    /// Returns whether the velocity was accepted.
    fn update_horizontal(&mut self, made_s: f64, sample: &Sample, was_airborne: bool) -> bool {
        let at_s = made_s - self.config.velocity_delay.as_secs_f64();
        let body = Vector2::new(sample.velocity_right_m_s, sample.velocity_forward_m_s);
        // A repeated value is the last measurement again: navdata come more often than the flow measures. A
        // flow that hangs therefore leaves a gap.
        if self.last_velocity_m_s.replace(body) == Some(body) && sample.airborne {
            return !self.velocity_gate.has_jumped();
        }
        let from_s = self.velocity_at_s.replace(at_s).unwrap_or(at_s);
        let step_s = (at_s - from_s).max(0.0);
        let order = self.orders.at(at_s);
        if !sample.airborne {
            self.velocity_gate.rest();
            if was_airborne {
                let before_m_s = self.horizontal.measured_m_s();
                let unseen_s = (step_s - USUAL_STEP_S).max(0.0);
                self.uncertainty.fly_unseen(unseen_s, before_m_s, Vector2::zeros());
            }
            self.horizontal.correct(
                Vector2::zeros(),
                self.horizontal.position_m,
                step_s,
                Order::ByItself,
                &self.observer_gains(),
            );
            return true;
        }
        let yaw_deg = self.heading_at(at_s);
        let measured_m_s = world_from_body(body, yaw_deg);
        let foreseen = self.horizontal_at(self.horizontal, from_s, at_s);
        let (before, after) = (self.horizontal.velocity_m_s, foreseen.velocity_m_s);
        let unheard_share = self.velocity_gate.unheard_share(step_s);
        let tilt_rad = Vector2::new(sample.roll_deg, -sample.pitch_deg).map(f64::to_radians);
        let unheard = self.unheard_m_s([from_s, at_s], tilt_rad, after, unheard_share);
        let expected = Foreseen { before_m_s: before, after_m_s: after, unheard_m_s: &unheard };
        let judged = self.velocity_gate.judge(measured_m_s, &expected, step_s);
        let believed = judged != Judged::Rejected;
        let velocity_m_s = if believed { measured_m_s } else { foreseen.velocity_m_s };
        let before_m_s = self.horizontal.measured_m_s();
        let mean_m_s = (before_m_s + velocity_m_s) / 2.0;
        let mut position_m = self.horizontal.position_m + mean_m_s * step_s.min(MAX_STEP_S);
        let unseen_s = (step_s - USUAL_STEP_S).max(0.0);
        self.uncertainty.fly_unseen(unseen_s, before_m_s, velocity_m_s);
        if !believed {
            self.uncertainty.fly_disputed(step_s, (measured_m_s - after).norm());
        }
        self.horizontal = foreseen;
        let gains = self.observer_gains();
        if let Judged::Pushed { by_m_s2, for_s } = judged {
            self.horizontal.push(by_m_s2, for_s, &gains);
            position_m += by_m_s2 * (for_s * (for_s - step_s) / 2.0);
        }
        self.horizontal.correct(velocity_m_s, position_m, step_s, order, &gains);
        if order == Order::ByItself {
            let airframe = self.identification.airframe();
            self.horizontal.learn_from_hold(tilt_rad, yaw_deg, step_s, airframe, &gains);
        }
        if believed && self.config.identify {
            self.identification.velocity(at_s, body, yaw_deg, &self.orders);
        }
        believed
    }

    /// Returns whether the floor made a step.
    fn update_vertical(&mut self, made_s: f64, sample: &Sample) -> bool {
        let at_s = made_s - self.config.altitude_delay.as_secs_f64();
        if !sample.airborne {
            self.altitude.stand();
            self.standing_m = [self.standing_m[1], sample.altitude_m];
            self.altitude_at = Some((at_s, sample.altitude_m));
            return false;
        }
        let (last_s, last_m) = self.altitude_at.unwrap_or((at_s, f64::NAN));
        #[allow(clippy::float_cmp, reason = "the very same number, not a near one")]
        let same = sample.altitude_m == last_m && at_s - last_s < ALTITUDE_INTERVAL_S;
        if same {
            return false;
        }
        let expected = self.vertical_at(last_s, at_s);
        let order = self.orders.at(at_s);
        let echo = self.altitude.correct(sample.altitude_m, expected, at_s - last_s, order);
        self.altitude_at = Some((at_s, sample.altitude_m));
        match echo {
            Echo::Good | Echo::First if self.config.identify => {
                let height_m = sample.altitude_m;
                self.identification.height(at_s, height_m, &self.orders);
            }
            Echo::FloorStep => {
                self.identification.forget_heights(at_s, &self.orders);
            }
            Echo::Good | Echo::First | Echo::Wrong => {}
        }
        echo == Echo::FloorStep
    }

    fn observer_gains(&self) -> ObserverGains {
        ObserverGains {
            velocity_1_s: self.config.velocity_gain_1_s,
            disturbance_1_s2: self.config.disturbance_gain_1_s2,
            disturbance_max_m_s2: self.config.disturbance_max_m_s2,
        }
    }

    fn heading_at(&self, time_s: f64) -> f64 {
        self.heading.at(time_s, &self.orders, self.airframe(), &self.config.limits)
    }

    fn horizontal_at(&self, mut state: Horizontal, from_s: f64, to_s: f64) -> Horizontal {
        let (airframe, limits) = (self.airframe(), &self.config.limits);
        self.orders.steps(from_s, to_s, |at_s, step_s, order| {
            state.advance(step_s, order, self.heading_at(at_s), airframe, limits);
        });
        state
    }

    fn vertical_at(&self, from_s: f64, to_s: f64) -> Vertical {
        let mut state = self.altitude.state();
        self.orders.steps(from_s, to_s, |_, step_s, order| {
            state.advance(step_s, order, self.airframe(), &self.config.limits);
        });
        state
    }

    /// The newest measurement.
    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// Turn rate at a time, clockwise, in degrees per second: measured by the compass, and predicted from the sticks since. In
    /// contrast to the rate of [`Estimator::predicted`] it tells also of turns that nobody has ordered.
    pub fn turn_rate_deg_s(&self, at: Duration) -> f64 {
        let (airframe, limits) = (self.airframe(), &self.config.limits);
        self.heading.rate_deg_s(at.as_secs_f64(), &self.orders, airframe, limits)
    }

    /// Position and motion at a time: the newest measurement, propagated by the model. The time may lie as
    /// far ahead as [`Estimator::order_delay`], because the orders until then are known. Place and velocity are not propagated
    /// on the ground, and not for longer than 0.6 s and the link's delay.
    pub fn predicted(&self, at: Duration) -> Prediction {
        let at_s = at.as_secs_f64();
        let furthest_s = MAX_PREDICTION_S + self.identification.link_delay_s();
        let until = |from_s: f64| at_s.clamp(from_s, from_s + furthest_s);
        let horizontal = match self.velocity_at_s {
            Some(from_s) if self.airborne => {
                self.horizontal_at(self.horizontal, from_s, until(from_s))
            }
            _ => self.horizontal,
        };
        let vertical = match self.altitude_at {
            Some((from_s, _)) if self.airborne => self.vertical_at(from_s, until(from_s)),
            _ => self.altitude.state(),
        };
        let odometry = Prediction {
            position_m: horizontal.position_m.push(vertical.height_m),
            velocity_m_s: horizontal.velocity_m_s.push(vertical.climb_m_s),
            yaw_deg: wrap_deg(self.heading_at(at_s)),
            turn_deg_s: self.heading.turn_deg_s(
                at_s,
                &self.orders,
                self.airframe(),
                &self.config.limits,
            ),
            disturbance_m_s2: horizontal.disturbance_m_s2,
            newest_disturbance_m_s2: horizontal.newest_disturbance_m_s2(),
        };
        self.in_world(odometry)
    }

    fn in_world(&self, odometry: Prediction) -> Prediction {
        let world = &self.world;
        let Prediction { position_m, velocity_m_s, yaw_deg, .. } = odometry;
        Prediction {
            position_m: world.place_m(position_m.xy()).push(position_m.z),
            velocity_m_s: world.velocity_m_s(velocity_m_s.xy(), yaw_deg).push(velocity_m_s.z),
            yaw_deg: wrap_deg(world.heading_deg(yaw_deg)),
            disturbance_m_s2: world.turned(odometry.disturbance_m_s2),
            newest_disturbance_m_s2: world.turned(odometry.newest_disturbance_m_s2),
            ..odometry
        }
    }

    /// A prediction for the controller: where a tag has moved the estimate by a step, the step is turned into
    /// a motion. Without tags it is the prediction itself.
    pub fn smooth(&self, prediction: &Prediction) -> Prediction {
        let (place_m, velocity_m_s, yaw_deg) = self.world.smooth(
            prediction.position_m.xy(),
            prediction.velocity_m_s.xy(),
            prediction.yaw_deg,
        );
        Prediction {
            position_m: place_m.push(prediction.position_m.z),
            velocity_m_s: velocity_m_s.push(prediction.velocity_m_s.z),
            yaw_deg: wrap_deg(yaw_deg),
            ..*prediction
        }
    }

    /// Advances the motions of [`Estimator::smooth`] by one step of `step_s` seconds.
    pub fn advance_smooth(&mut self, step_s: f64) {
        self.world.advance(step_s);
    }

    /// Adds surveyed tags to those that are known, in flight. A known tag within 0.75 m is taken to be the same:
    /// a found one gets the surveyed position, a surveyed one keeps its own. They are ignored without
    /// [`EstimatorConfig::tags`].
    ///
    /// # Errors
    /// [`NoRoom`] if more than [`MAX_TAGS`] tags would be known. Nothing has changed then.
    pub fn survey(&mut self, surveyed: &[SurveyedTag]) -> Result<(), NoRoom> {
        if self.config.tags.is_some() {
            self.world.survey(surveyed, self.horizontal.position_m)?;
            self.move_into_world();
        }
        Ok(())
    }

    /// The known tags and their status; `None` if tags are not used.
    pub fn tag_status(&self, now: Duration) -> Option<TagStatus> {
        let status = self.world.status(now.as_secs_f64())?;
        let at_s = self.velocity_at_s.unwrap_or_default();
        let uncertainty_m = self.uncertainty_m(now);
        let is_due = self.airborne && self.world.is_due(at_s, self.heading_at(at_s), uncertainty_m);
        Some(TagStatus { is_due, ..status })
    }

    /// Whether a known tag was in view within the last 0.5 s and a turn of some degrees would reveal the sign of its
    /// orientation, without which tags do not correct the heading.
    pub fn would_learn_from_a_turn(&self, now: Duration) -> bool {
        self.world.would_learn_from_a_turn(now.as_secs_f64())
    }

    /// Standard deviation of the position on the worse horizontal axis, in metres. It grows with time, with the distance from
    /// the start or from where a known tag was seen last, and with silence.
    pub fn uncertainty_m(&self, now: Duration) -> f64 {
        let speed_m_s = self.horizontal.measured_m_s().norm();
        let known_m =
            self.world.uncertainty_m(self.horizontal.position_m, self.estimate.above_floor_m);
        known_m.hypot(uncertainty::silence_m(self.silence_s(now), speed_m_s))
    }

    /// Standard deviation of the heading in the world, in degrees, as far as its start and tags decide it.
    pub fn heading_uncertainty_deg(&self) -> f64 {
        self.world.heading_uncertainty_deg()
    }

    /// Standard deviation of the height, in metres.
    pub fn height_uncertainty_m(&self, now: Duration) -> f64 {
        let order = self.orders.at(now.as_secs_f64());
        self.altitude.uncertainty_m(self.silence_s(now), order)
    }

    /// Silence on the ground adds no uncertainty.
    fn silence_s(&self, now: Duration) -> f64 {
        if self.airborne { now.saturating_sub(self.estimate.at).as_secs_f64() } else { 0.0 }
    }

    /// The identified response of this airframe.
    pub fn airframe(&self) -> &Airframe {
        self.identification.airframe()
    }

    /// Altitude in metres of a drone that stands: of the last two the one that is nearer to the floor, because a single one may
    /// be a wrong echo. `None` if it has not been heard standing yet.
    pub fn standing_altitude_m(&self) -> Option<f64> {
        let [before_m, last_m] = self.standing_m;
        let nearer_m = if before_m.abs() < last_m.abs() { before_m } else { last_m };
        nearer_m.is_finite().then_some(nearer_m)
    }

    /// Whether navdata are plausible.
    pub fn trust(&self) -> Trust {
        self.beliefs.trust()
    }

    /// What each quantity in navdata is worth, in the order of [`Quantity::ALL`].
    pub fn worth(&self) -> [Worth; Quantity::ALL.len()] {
        self.beliefs.worth()
    }

    /// When the newest plausible navdata arrived; `None` if there were none yet. A fault is dated from its
    /// first packet: when it is detected this moves back to the packet before.
    pub fn sound_at(&self) -> Option<Duration> {
        self.beliefs.sound_at_s().map(|at_s| Duration::from_secs_f64(at_s.max(0.0)))
    }

    /// The drone has restarted: forgets the clock and the compass, keeps the position.
    pub fn handle_restart(&mut self, now: Duration) {
        // What it has flown unseen since the last sample nobody will ever measure.
        let unseen_m =
            uncertainty::silence_m(self.silence_s(now), self.horizontal.measured_m_s().norm());
        self.world.handle_restart(unseen_m * unseen_m);
        self.clock = SampleClock::default();
        self.heading.handle_restart();
        self.velocity_at_s = None;
        self.last_velocity_m_s = None;
        self.velocity_gate = VelocityGate::default();
        self.altitude_at = None;
        self.altitude.handle_restart();
        self.beliefs = Beliefs::new();
        self.repetitions = Repetitions::default();
        self.response = Response::new();
        self.noise = NoiseOfAll::default();
    }
}

#[cfg(test)]
mod tests;
