//! The world frame, what moves it, and what does not.

use super::*;
use crate::Start;
use crate::world::{
    FASTEST_TURN_DEG_S, LOWEST_M, MAX_SIGHTS, OdometryStep, OrientationSign, STANDS_M, World,
};
use kinematics::{body_from_world, world_from_body};

fn assert_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-9, "{value} is not {expected}");
}

fn assert_same(vector: Vector2<f64>, expected: Vector2<f64>) {
    assert!((vector - expected).norm() < 1e-9, "{vector} is not {expected}");
}

/// A drone above surveyed tags, whose odometry started aside, is turned and has a bias.
pub(super) struct Drone {
    pub(super) tags: World,
    pub(super) now_s: f64,
    pub(super) odometry_m: Vector2<f64>,
    pub(super) place_m: Vector2<f64>,
    pub(super) velocity_m_s: Vector2<f64>,
    pub(super) height_m: f64,
    pub(super) turn_deg_s: f64,
    pub(super) airborne: bool,
    pub(super) unseen_m2: f64,
}

const TURNED_DEG: f64 = 6.0;
const YAW_DEG: f64 = 20.0;
pub(super) const STEP_S: f64 = 1.0 / 16.0;
pub(super) const TAG: SurveyedTag =
    SurveyedTag { place_m: Vector2::new(0.3, 0.1), heading_deg: Some(30.0) };

pub(super) fn surveyed() -> TagConfig {
    let mut config =
        TagConfig { orientation: Some(OrientationSign::Clockwise), ..TagConfig::default() };
    config.surveyed[0] = Some(TAG);
    config
}

impl Drone {
    pub(super) fn new(config: &TagConfig) -> Self {
        Self {
            tags: World::new(Some(config), &Start::default()),
            now_s: 0.0,
            odometry_m: Vector2::new(0.15, -0.1),
            place_m: Vector2::zeros(),
            velocity_m_s: Vector2::zeros(),
            height_m: HEIGHT_M,
            turn_deg_s: 0.0,
            airborne: true,
            unseen_m2: 0.0,
        }
    }

    pub(super) fn step(&self) -> OdometryStep {
        OdometryStep {
            made_s: self.now_s,
            at_s: self.now_s - 0.06,
            place_m: self.odometry_m,
            velocity_m_s: self.velocity_m_s,
            yaw_deg: YAW_DEG,
            tilt: (self.now_s - 0.02, Vector2::zeros()),
            height: (self.now_s - 0.04, self.height_m),
            echo_m: self.height_m,
            airborne: self.airborne,
            unseen_m2: self.unseen_m2,
        }
    }

    /// The tag below, as the camera of the true drone sees it; `wobble` makes another picture.
    pub(super) fn sight(&self, wobble: f64) -> Sight {
        let heading_deg = YAW_DEG + TURNED_DEG;
        let body_m = body_from_world(TAG.place_m - self.place_m, heading_deg);
        let sight = sight_at(body_m, 270.0 + heading_deg - 30.0, wobble);
        let scale = HEIGHT_M / self.height_m;
        Sight {
            x: 500.0 + (sight.x - 500.0) * scale,
            y: 450.0 + (sight.y - 450.0) * scale,
            width: sight.width * scale,
            distance_m: sight.distance_m / scale,
            ..sight
        }
    }

    pub(super) fn see(&mut self, sights: &[Sight]) {
        self.tags.see(sights, |_| YAW_DEG, self.turn_deg_s, self.airborne);
    }

    /// Flies one step, and sees its tag.
    pub(super) fn fly(&mut self) {
        self.now_s += STEP_S;
        self.odometry_m += self.velocity_m_s * STEP_S;
        self.place_m += world_from_body(self.velocity_m_s, TURNED_DEG) * STEP_S;
        self.tags.fly(&self.step());
        let wobble = (self.now_s * 16.0 * 7.0) % 5.0 - 2.0;
        let sight = self.sight(wobble);
        self.see(&[sight]);
    }

    /// Hovers above its tag until it knows where it is.
    pub(super) fn settled() -> Self {
        let mut drone = Self::new(&surveyed());
        (0..800).for_each(|_| drone.fly());
        drone
    }

    pub(super) fn correction(&self) -> (Vector2<f64>, f64) {
        let correction = self.tags.filter.correction();
        (correction.place_m, correction.heading_rad)
    }
}

#[test]
fn a_surveyed_tag_gives_position_and_heading_of_the_world() {
    let drone = Drone::settled();
    let place_m = drone.tags.place_m(drone.odometry_m);
    assert!((place_m - drone.place_m).norm() < 0.06, "{place_m}");
    let heading_deg = drone.tags.heading_deg(YAW_DEG);
    assert!((heading_deg - YAW_DEG - TURNED_DEG).abs() < 2.0, "{heading_deg}");
    assert!(drone.tags.status(drone.now_s).unwrap().heading_held);
}

#[test]
fn the_world_is_the_odometry_moved_and_turned_without_its_bias() {
    let mut drone = Drone::settled();
    // It drifts aside for a while, which is a bias.
    for _ in 0..160 {
        drone.odometry_m += Vector2::new(0.02, 0.01) * STEP_S;
        drone.fly();
    }
    let (place_m, heading_rad) = drone.correction();
    let bias_m_s = drone.tags.filter.bias_m_s();
    let turned_deg = heading_rad.to_degrees();
    assert!(place_m.norm() > 0.1 && turned_deg > 3.0 && bias_m_s.norm() > 0.003);
    let tags = &drone.tags;
    let some = Vector2::new(0.8, -0.6);
    assert_same(tags.place_m(some), some + place_m);
    assert_same(tags.turned(some), world_from_body(some, turned_deg));
    assert_near(tags.heading_deg(15.0), 15.0 + turned_deg);
    let biased_m_s = world_from_body(bias_m_s, 15.0 + turned_deg);
    assert_same(tags.velocity_m_s(some, 15.0), world_from_body(some, turned_deg) - biased_m_s);
    assert_same(tags.status(drone.now_s).unwrap().drift_m, -place_m);
    // What a jump has left over is taken from the place, the velocity and the heading.
    let (smooth_m, smooth_m_s, smooth_deg) = tags.smooth(some, some, 15.0);
    let left = &tags.take_back;
    assert!(left.place_m().norm() > 0.05, "{left:?}");
    assert_same(smooth_m, some - left.place_m());
    assert_near(smooth_deg, 15.0 - left.heading_deg());
    assert_same(smooth_m_s, some);
    assert_same(left.place_m(), place_m - Drone::new(&surveyed()).correction().0 - flown_m(&drone));
    let before_m = left.place_m();
    drone.tags.advance(0.05);
    let left = &drone.tags.take_back;
    assert!(left.place_m().norm() < before_m.norm());
    let (_, smooth_m_s, _) = drone.tags.smooth(some, some, 15.0);
    assert_same(smooth_m_s, some - left.rate_m_s());
    assert!(left.rate_m_s().norm() > 0.0);
}

/// The part of the correction that is no jump: what the filter adds while it flies.
fn flown_m(drone: &Drone) -> Vector2<f64> {
    drone.correction().0 - drone.tags.take_back.place_m()
}

#[test]
fn the_deviation_grows_with_the_way_since_the_tag_and_with_height() {
    let mut drone = Drone::new(&surveyed());
    let uncertainty_m = |drone: &Drone, odometry_m: Vector2<f64>, height_m: f64| {
        let squares = drone.tags.uncertainty_m(odometry_m, height_m).powi(2);
        (squares - drone.tags.filter.place_variance_m2()).sqrt()
    };
    let far = Vector2::new(3.0, 4.0);
    // Before a tag was seen its height has no part in it.
    assert_near(uncertainty_m(&drone, far, 2.0), 0.015_f64.hypot(0.06 * 5.0));
    let expected_m = |way_m: f64| 0.015_f64.hypot(0.06 * way_m).hypot(0.012 * 2.0);
    // From the place of the odometry at the last picture.
    (0..40).for_each(|_| drone.fly());
    let from_m = drone.odometry_m;
    assert_near(uncertainty_m(&drone, from_m + far, 2.0), expected_m(5.0));
    assert_near(uncertainty_m(&drone, from_m, 2.0), expected_m(0.0));
    assert_eq!(
        drone.tags.status(drone.now_s + 3.0).unwrap().seen_ago,
        Some(Duration::from_secs(3))
    );
    assert_eq!(drone.tags.status(drone.now_s + 3.0).unwrap().known.count(), 1);
}

/// After a gap the predicted height may be below the floor.
#[test]
fn motion_that_was_not_measured_is_doubted_at_any_height_once_the_drone_has_risen() {
    let mut drone = Drone::new(&surveyed());
    drone.height_m = STANDS_M + 0.01;
    drone.tags.fly(&drone.step());
    let before_m2 = drone.tags.filter.place_variance_m2();
    drone.height_m = -0.4;
    drone.unseen_m2 = 3.4;
    drone.tags.fly(&drone.step());
    assert_near(drone.tags.filter.place_variance_m2(), before_m2 + 3.4);
}

#[test]
fn motion_that_was_not_measured_is_doubted_once_and_only_in_flight() {
    for (height_m, doubted) in [(STANDS_M, 0.0), (STANDS_M + 0.01, 1.0)] {
        let mut drone = Drone::new(&surveyed());
        drone.height_m = height_m;
        drone.tags.fly(&drone.step());
        let before_m2 = drone.tags.filter.place_variance_m2();
        drone.unseen_m2 = 0.25;
        drone.tags.fly(&drone.step());
        assert_near(drone.tags.filter.place_variance_m2(), before_m2 + 0.25 * doubted);
        drone.tags.fly(&drone.step());
        assert_near(drone.tags.filter.place_variance_m2(), before_m2 + 0.25 * doubted);
        drone.unseen_m2 = 0.35;
        drone.tags.fly(&drone.step());
        assert_near(drone.tags.filter.place_variance_m2(), before_m2 + 0.35 * doubted);
    }
}

/// The packets of a take-off may be lost: the first height after them may not be believed yet.
#[test]
fn motion_during_a_take_off_that_was_not_measured_is_doubted_with_the_first_echo() {
    let mut drone = Drone::new(&surveyed());
    drone.height_m = 0.0;
    drone.tags.fly(&drone.step());
    let before_m2 = drone.tags.filter.place_variance_m2();
    drone.unseen_m2 = 3.4;
    drone.tags.fly(&OdometryStep { echo_m: 0.8, ..drone.step() });
    assert_near(drone.tags.filter.place_variance_m2(), before_m2 + 3.4);
}

#[test]
fn time_on_the_ground_makes_nothing_uncertain() {
    for airborne in [false, true] {
        let mut drone = Drone::new(&surveyed());
        drone.airborne = airborne;
        drone.tags.fly(&drone.step());
        let before_m2 = drone.tags.filter.place_variance_m2();
        drone.now_s = 100.0;
        drone.tags.fly(&drone.step());
        let after_m2 = drone.tags.filter.place_variance_m2();
        assert_eq!(after_m2 > before_m2, airborne);
    }
}

#[test]
fn a_step_of_the_compass_makes_a_far_tag_uncertain() {
    let mut drone = Drone::settled();
    let settled_deg = drone.correction().1.to_degrees();
    // The compass has stepped by 3 degrees, of which the tag knows.
    let mut stepped = drone.tags.clone();
    stepped.step_of_the_heading();
    let turn_by = |tags: &mut World, now_s: f64| {
        let sight =
            Sight { orientation_deg: drone.sight(0.3).orientation_deg + 3.0, ..drone.sight(0.3) };
        let step = OdometryStep { made_s: now_s, at_s: now_s - 0.06, ..drone.step() };
        tags.fly(&step);
        tags.see(&[sight], |_| YAW_DEG, 0.0, true);
        tags.filter.correction().heading_rad.to_degrees() - settled_deg
    };
    let now_s = drone.now_s + STEP_S;
    let sure = turn_by(&mut drone.tags.clone(), now_s).abs();
    let unsure = turn_by(&mut stepped, now_s).abs();
    assert!(unsure > 1.5 * sure, "{sure}, {unsure}");
    drone.tags.handle_restart(0.0);
    let before = drone.correction();
    let sight = drone.sight(0.7);
    drone.see(&[sight]);
    assert_eq!(drone.correction(), before, "nothing is known of the time of the picture");
}

/// Whether a new picture moves the world.
fn moves(change: impl Fn(&mut Drone)) -> bool {
    let mut drone = Drone::new(&surveyed());
    // Right above the tag, so that it is in the picture from any height.
    drone.place_m += TAG.place_m;
    drone.odometry_m += TAG.place_m;
    (0..8).for_each(|_| drone.fly());
    change(&mut drone);
    for _ in 0..8 {
        drone.now_s += STEP_S;
        drone.tags.fly(&drone.step());
    }
    let before = drone.correction();
    let sights = [drone.sight(0.4)];
    drone.see(&sights);
    let first = drone.correction();
    // The same picture in the next packet says nothing new.
    drone.see(&sights);
    assert_eq!(drone.correction(), first);
    first != before
}

#[test]
fn only_a_picture_from_a_drone_that_flies_high_and_slowly_turns_counts() {
    assert!(moves(|_| ()));
    assert!(!moves(|drone| drone.airborne = false));
    assert!(!moves(|drone| drone.height_m = LOWEST_M - 0.01));
    assert!(moves(|drone| drone.height_m = LOWEST_M));
    for sign in [-1.0, 1.0] {
        assert!(moves(|drone| drone.turn_deg_s = sign * FASTEST_TURN_DEG_S));
        assert!(!moves(|drone| drone.turn_deg_s = sign * (FASTEST_TURN_DEG_S + 0.1)));
    }
}

#[test]
fn a_packet_has_four_sightings_at_most() {
    let mut drone = Drone::new(&surveyed());
    (0..8).for_each(|_| drone.fly());
    drone.now_s += STEP_S;
    drone.tags.fly(&drone.step());
    let before = drone.correction();
    let nothing = Sight::default();
    let mut sights = vec![nothing; MAX_SIGHTS];
    sights.push(drone.sight(0.4));
    drone.see(&sights);
    assert_eq!(drone.correction(), before, "the fifth is ignored");
}

#[test]
fn a_turn_teaches_only_while_a_tag_is_in_view_and_the_sign_is_unknown() {
    let mut config = surveyed();
    config.orientation = None;
    let mut drone = Drone::new(&config);
    assert!(!drone.tags.would_learn_from_a_turn(0.0), "no tag was seen");
    (0..20).for_each(|_| drone.fly());
    assert!(drone.tags.would_learn_from_a_turn(drone.now_s + 0.49));
    assert!(!drone.tags.would_learn_from_a_turn(drone.now_s + 0.5));
    assert!(!Drone::settled().tags.would_learn_from_a_turn(0.0), "it is known");
    assert!(!drone.tags.status(0.0).unwrap().heading_held);
}

#[test]
fn a_picture_is_compared_with_tilt_and_height_of_its_own_time() {
    // The drone sways and climbs; attitude is 20 ms old, height 40 ms, and the picture 60 ms.
    let mut estimator = Estimator::new(EstimatorConfig {
        tags: Some(TagConfig::default()),
        ..EstimatorConfig::default()
    });
    for packet in 0..40_u32 {
        let arrival = Duration::from_micros(62_500) * packet;
        let at_s = arrival.as_secs_f64();
        estimator.update(&Sample {
            arrival,
            drone_time: Some(arrival),
            roll_deg: 20.0 * (at_s - 0.02),
            pitch_deg: -10.0 * (at_s - 0.02),
            altitude_m: 1.0 + 0.5 * (at_s - 0.04),
            velocity_forward_m_s: 0.001 * f64::from(packet % 3),
            airborne: true,
            ..Sample::default()
        });
    }
    let tags = &estimator.world;
    let at_s = 39.0 / 16.0 - 0.2;
    let moment = tags.history.at(at_s, 0.0).unwrap();
    assert!((moment.tilt_deg - Vector2::new(20.0, -10.0) * at_s).norm() < 1e-6, "{moment:?}");
    assert!((moment.height_m - (1.0 + 0.5 * at_s)).abs() < 0.01, "{moment:?}");
}

#[test]
fn estimate_prediction_and_reference_are_all_of_the_world() {
    let mut bench = Bench::new(Some(&surveyed()));
    bench.tag_m = TAG.place_m;
    bench.yaw_deg = 12.0;
    bench.flow_m_s = Vector2::new(0.02, 0.01);
    bench.fly(600, none);
    let estimator = &mut bench.estimator;
    let now = PERIOD * bench.packet;
    estimator.horizontal.disturbance_m_s2 = Vector2::new(0.3, 0.1);
    let tags = estimator.world.clone();
    let (correction, bias_m_s) = (tags.filter.correction(), tags.filter.bias_m_s());
    let turned_deg = correction.heading_rad.to_degrees();
    assert!(bias_m_s.norm() > 0.005 && turned_deg.abs() > 0.5, "{correction:?}");
    *estimator.world = World::new(None, &Start::default());
    let odometry = estimator.predicted(now);
    estimator.world = tags.clone();
    let world = estimator.predicted(now);
    assert_same(world.position_m.xy(), odometry.position_m.xy() + correction.place_m);
    assert_near(world.yaw_deg, odometry.yaw_deg + turned_deg);
    let turned = |vector| world_from_body(vector, turned_deg);
    let biased_m_s = world_from_body(bias_m_s, world.yaw_deg);
    assert_same(world.velocity_m_s.xy(), turned(odometry.velocity_m_s.xy()) - biased_m_s);
    assert_same(world.disturbance_m_s2, turned(odometry.disturbance_m_s2));
    assert_near(world.position_m.z, odometry.position_m.z);
    // The estimate too, with the velocity that was measured.
    let measured_m_s = estimator.horizontal.measured_m_s();
    let estimate = estimator.estimate();
    assert_same(estimate.position_m.xy(), estimator.horizontal.position_m + correction.place_m);
    assert_same(estimate.velocity_m_s.xy(), turned(measured_m_s) - biased_m_s);
    assert_near(estimate.yaw_deg, estimator.heading.newest_deg() + turned_deg);
    assert!((estimate.position_m.z - HEIGHT_M).abs() < 0.01, "{estimate:?}");
    // The reference follows the jumps slowly, in place, velocity and heading.
    estimator.advance_smooth(0.03);
    let tags = estimator.world.clone();
    let left = &tags.take_back;
    assert!(left.rate_m_s().norm() > 1e-4 && left.heading_deg().abs() > 0.1, "{left:?}");
    let smooth = estimator.smooth(&world);
    assert_same(smooth.position_m.xy(), world.position_m.xy() - left.place_m());
    assert_same(smooth.velocity_m_s.xy(), world.velocity_m_s.xy() - left.rate_m_s());
    assert_near(smooth.yaw_deg, world.yaw_deg - left.heading_deg());
    assert_near(smooth.velocity_m_s.z, world.velocity_m_s.z);
}
