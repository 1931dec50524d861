//! Setpoints of a ground station, and plans as it writes them, flown in simulated time.

use std::time::Duration;

use ardrone_pilot::drive::{Driver, Passed, Simulated};
use autopilot::plan::Plan;
use autopilot::vehicle::{
    FlightEvent, Heading, Horizontal, LandingReason, ManualControl, Operator, OperatorOrder, Phase,
    Setpoint, Station, Telemetry, Vertical,
};
use autopilot::{Vehicle, VehicleConfig};
use mock_drone::airframe::Profile;
use mock_drone::{DroneConfig, Truth, WorldConfig, firmware};
use nalgebra::Vector2;
use system_tests::sim::Simulation;
use system_tests::{place_in_navdata_frame, plan, true_error_m};

const SECOND: Duration = Duration::from_secs(1);
const PERIOD: Duration = Duration::from_millis(50);
const START: OperatorOrder = OperatorOrder::Start { when_ready: true };
const STATION: Operator = Operator { station: Station::Mavlink, number: 0xffbe, local: true };
const PROFILES: [fn() -> Profile; 4] = [Profile::rec, Profile::tum, Profile::tf, Profile::leo];

/// A vehicle that a ground station flies, which shows each second that it is there.
struct Bench {
    driver: Driver<Simulated>,
    events: Vec<FlightEvent>,
    /// Setpoint sent every [`PERIOD`].
    sent: Option<Setpoint>,
    next_at: Duration,
}

impl Bench {
    /// In the air at a height of 1 m, the take-off complete.
    fn in_the_air(profile: Profile, seed: u64) -> Self {
        let drone = DroneConfig { profile, seed, ..DroneConfig::default() };
        let world = WorldConfig { drone, ..WorldConfig::default() };
        let driver = Driver::new(Vehicle::new(&VehicleConfig::default()).unwrap(), &world);
        let mut bench = Self { driver, events: Vec::new(), sent: None, next_at: Duration::ZERO };
        bench.accepted(OperatorOrder::Load(plan("takeoff\ngoto 0 0 0 0\nland")));
        bench.accepted(START);
        bench.until(60 * SECOND, |bench| {
            bench.driver.vehicle.status(bench.driver.now()).step == Some(1)
        });
        bench
    }

    fn accepted(&mut self, order: OperatorOrder) {
        let name = order.name();
        assert_eq!(self.driver.order(STATION, order), Ok(()), "{name}");
    }

    fn truth(&self) -> Truth {
        self.driver.world().truth()
    }

    /// The frame that navdata span begins where the drone stood.
    fn place_m(&self) -> Vector2<f64> {
        place_in_navdata_frame(&self.truth()).xy()
    }

    fn velocity_m_s(&self) -> Vector2<f64> {
        self.truth().velocity_m_s.xy()
    }

    fn step(&mut self) {
        let now = self.driver.now();
        if now >= self.next_at {
            let order = self.sent.map_or(OperatorOrder::Present, OperatorOrder::Setpoint);
            _ = self.driver.order(STATION, order);
            self.next_at = now + PERIOD;
        }
        let events = &mut self.events;
        self.driver.step(|_, passed| {
            if let Passed::Told(Telemetry::Event(event)) = passed {
                events.push(event);
            }
        });
        self.driver.pass();
    }

    fn run(&mut self, time: Duration, mut see: impl FnMut(&Self)) {
        let end = self.driver.now() + time;
        while self.driver.now() < end {
            self.step();
            see(self);
        }
    }

    #[track_caller]
    fn until(&mut self, time: Duration, mut is_so: impl FnMut(&Self) -> bool) {
        let end = self.driver.now() + time;
        while !is_so(self) {
            assert!(self.driver.now() < end, "{:?}", self.events);
            self.step();
        }
    }

    fn follow(&mut self, setpoint: Setpoint) {
        if self.sent.is_none() {
            self.accepted(OperatorOrder::Follow(setpoint));
        }
        self.sent = Some(setpoint);
    }
}

fn at(x_m: f64, y_m: f64, height_m: f64) -> Setpoint {
    Setpoint {
        horizontal: Horizontal::Place { x_m, y_m },
        vertical: Vertical::Height(height_m),
        heading: Heading::Yaw(0.0),
    }
}

fn fast([x_m_s, y_m_s]: [f64; 2]) -> Setpoint {
    Setpoint {
        horizontal: Horizontal::Velocity { x_m_s, y_m_s },
        vertical: Vertical::Height(1.2),
        heading: Heading::Keep,
    }
}

/// A square of 2 m, 6 s for each corner, and back.
#[test]
fn a_square_is_flown_by_set_points() {
    for (number, profile) in PROFILES.iter().enumerate() {
        let mut bench = Bench::in_the_air(profile(), 7);
        let mut worst_m: f64 = 0.0;
        for (x_m, y_m) in [(0.0, 2.0), (2.0, 2.0), (2.0, 0.0), (0.0, 0.0)] {
            bench.follow(at(x_m, y_m, 1.2));
            bench.run(5 * SECOND, |_| {});
            bench.run(SECOND, |bench| {
                let error_m =
                    place_in_navdata_frame(&bench.truth()) - Vector2::new(x_m, y_m).push(1.2);
                worst_m = worst_m.max(error_m.norm());
            });
        }
        assert!(worst_m < 0.3, "profile {number}: {worst_m:.2} m");
        let status = bench.driver.vehicle.status(bench.driver.now());
        assert_eq!(status.manual, Some(ManualControl::Setpoints));
        assert_eq!(status.controls, Some(STATION));
    }
}

/// Setpoints on a circle, which move all the time.
#[test]
fn a_place_that_moves_is_followed() {
    const RADIUS_M: f64 = 1.5;
    const SPEED_M_S: f64 = 0.8;
    for (number, profile) in PROFILES.iter().enumerate() {
        let mut bench = Bench::in_the_air(profile(), 3);
        bench.follow(at(RADIUS_M, 0.0, 1.2));
        bench.run(5 * SECOND, |_| {});
        let start = bench.driver.now();
        let end = start + 20 * SECOND;
        let mut worst_m: f64 = 0.0;
        while bench.driver.now() < end {
            let time_s = bench.driver.now().saturating_sub(start).as_secs_f64();
            let (sin, cos) = (time_s * SPEED_M_S / RADIUS_M).sin_cos();
            let there_m = Vector2::new(cos, sin) * RADIUS_M;
            bench.follow(at(there_m.x, there_m.y, 1.2));
            bench.step();
            worst_m = worst_m.max((bench.place_m() - there_m).norm());
        }
        assert!(worst_m < 1.2, "profile {number}: {worst_m:.2} m");
    }
}

#[test]
fn velocities_are_flown_in_four_directions() {
    const DIRECTIONS: [[f64; 2]; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
    let mut bad = Vec::new();
    for (number, profile) in PROFILES.iter().enumerate() {
        // The slowest airframe flies no faster than 0.95 m/s to its side at the largest tilt.
        for speed_m_s in [0.5, 1.0] {
            let mut bench = Bench::in_the_air(profile(), 5);
            let (mut off_m_s, mut far_m, mut left_m_s): (f64, f64, f64) = (0.0, 0.0, 0.0);
            for direction in DIRECTIONS {
                let wanted_m_s = Vector2::from(direction) * speed_m_s;
                bench.follow(fast(wanted_m_s.into()));
                bench.run(3 * SECOND, |_| {});
                let before_m = bench.truth().position_m.xy();
                bench.run(SECOND, |_| {});
                let flown_m_s = bench.truth().position_m.xy() - before_m;
                off_m_s = off_m_s.max((flown_m_s - wanted_m_s).norm());
                let stopped_m = bench.place_m();
                bench.follow(fast([0.0, 0.0]));
                bench.run(4 * SECOND, |bench| {
                    far_m = far_m.max((bench.place_m() - stopped_m).norm());
                });
                left_m_s = left_m_s.max(bench.velocity_m_s().norm());
            }
            let flown = format!(
                "profile {number}, {speed_m_s} m/s: {off_m_s:.2} m/s off, stops in {far_m:.2} m, \
                 moves by {left_m_s:.2} m/s"
            );
            if off_m_s > 0.15 || far_m > 1.0 || left_m_s > 0.15 {
                bad.push(flown);
            }
        }
    }
    assert_eq!(bad, Vec::<String>::new());
}

/// A velocity as seen from the drone turns with it; so do climb and turn follow theirs.
#[test]
fn velocities_of_the_body_climb_and_turn() {
    for (number, profile) in PROFILES.iter().enumerate() {
        let mut bench = Bench::in_the_air(profile(), 2);
        bench.follow(Setpoint { heading: Heading::Yaw(90.0), ..at(0.0, 0.0, 1.0) });
        bench.run(6 * SECOND, |_| {});
        let (before, before_m) = (bench.truth(), bench.place_m());
        bench.follow(Setpoint {
            horizontal: Horizontal::BodyVelocity { right_m_s: 0.0, forward_m_s: 0.7 },
            vertical: Vertical::Climb(0.3),
            heading: Heading::Keep,
        });
        bench.run(4 * SECOND, |_| {});
        let (flown_m, climbed_m) =
            (bench.place_m() - before_m, bench.truth().position_m.z - before.position_m.z);
        assert!(flown_m.x > 2.0 && flown_m.y.abs() < 0.4, "profile {number}: {flown_m:?}");
        assert!((climbed_m - 1.2).abs() < 0.4, "profile {number}: {climbed_m:.2} m");
        let turned_from_deg = bench.truth().yaw_deg;
        bench.follow(Setpoint {
            horizontal: Horizontal::Velocity { x_m_s: 0.0, y_m_s: 0.0 },
            vertical: Vertical::Climb(0.0),
            heading: Heading::Turn(20.0),
        });
        bench.run(4 * SECOND, |_| {});
        let turned_deg = bench.truth().yaw_deg - turned_from_deg;
        assert!((turned_deg - 80.0).abs() < 25.0, "profile {number}: {turned_deg:.0}°");
    }
}

/// Flown at full speed towards the fence.
#[test]
fn set_points_lead_no_drone_to_the_fence() {
    let mut bad = Vec::new();
    for (number, profile) in PROFILES.iter().enumerate() {
        for setpoint in [fast([99.0, 99.0]), at(1e9, -1e12, 1.0)] {
            let mut bench = Bench::in_the_air(profile(), 4);
            bench.follow(setpoint);
            let mut furthest_m: f64 = 0.0;
            bench.run(15 * SECOND, |bench| furthest_m = furthest_m.max(bench.place_m().norm()));
            let vetoed = bench.events.iter().any(|event| matches!(event, FlightEvent::Veto(_)));
            if vetoed || !(9.0..9.8).contains(&furthest_m) {
                bad.push(format!("profile {number}: {furthest_m:.2} m, {:?}", bench.events));
            }
        }
    }
    assert_eq!(bad, Vec::<String>::new());
}

#[test]
fn set_points_that_stop_end_in_a_hold_and_a_landing() {
    for (number, profile) in PROFILES.iter().enumerate() {
        let mut bench = Bench::in_the_air(profile(), 6);
        bench.follow(fast([1.0, 0.0]));
        bench.run(4 * SECOND, |_| {});
        bench.sent = None;
        let (since, from_m) = (bench.driver.now(), bench.place_m());
        bench.until(SECOND, |bench| bench.events.contains(&FlightEvent::SetpointsSilent));
        bench.run(3 * SECOND, |_| {});
        // Half a second at 1 m/s, and then it brakes.
        let held_m = bench.place_m();
        assert!(
            (held_m - from_m).norm() < 1.5,
            "profile {number}: {:.2}",
            (held_m - from_m).norm()
        );
        bench.run(6 * SECOND, |_| {});
        let moved_m = (bench.place_m() - held_m).norm();
        assert!(moved_m < 0.5, "profile {number}: {moved_m:.2} m");
        let gone = FlightEvent::LandingOrdered(LandingReason::SetpointsGone);
        bench.until(3 * SECOND, |bench| bench.events.contains(&gone));
        let after_ms = bench.driver.now().saturating_sub(since).as_millis();
        assert!((10_400..10_700).contains(&after_ms), "profile {number}: {after_ms}");
        bench.until(20 * SECOND, |bench| {
            let phase = bench.driver.vehicle.status(bench.driver.now()).phase;
            bench.truth().phase == firmware::Phase::Landed && phase == Phase::Standby
        });
    }
}

/// Fastest true speed of a flight.
fn fastest_m_s(plan: Plan) -> f64 {
    let mut fastest_m_s: f64 = 0.0;
    let flown = Simulation::default().fly_watched(plan, |moment| {
        if moment.status.step.is_some_and(|step| step > 0) {
            fastest_m_s = fastest_m_s.max(moment.truth.velocity_m_s.xy().norm());
        }
    });
    assert_eq!(flown.unwrap().outcome, autopilot::outcome::Outcome::Completed);
    fastest_m_s
}

#[test]
fn a_plan_limits_the_speed_flown() {
    let free_m_s = fastest_m_s(plan("takeoff\ngoto 0 5 0 0\nland"));
    assert!(free_m_s > 1.5, "{free_m_s:.2} m/s");
    let slow_m_s = fastest_m_s(plan("takeoff\nsetSpeed 0.5\ngoto 0 5 0 0\nland"));
    assert!((0.4..0.65).contains(&slow_m_s), "{slow_m_s:.2} m/s");
}

/// Places of a ground station count from where the drone stood, in each flight anew.
#[test]
fn places_count_from_the_start_of_each_flight() {
    const PLAN: &str =
        "takeoff\ngoto 0 1 0 0\nsetReference $START$\ngoto 1 0.5 1.5 0\ngoto -1 -1 1.1 90\nland";
    let flown = Simulation::default().fly(plan(PLAN)).unwrap();
    assert_eq!(flown.outcome, autopilot::outcome::Outcome::Completed);
    let targets: Vec<_> = flown.report.waypoints.iter().map(|waypoint| waypoint.target).collect();
    let places: Vec<_> = targets.iter().map(|to| [to.x_m, to.y_m, to.z_m, to.yaw_deg]).collect();
    assert_eq!(places.get(1..), Some(&[[1.0, 0.5, 1.5, 0.0], [-1.0, -1.0, 1.1, 90.0]][..]));
    for (waypoint, truth) in flown.report.waypoints.iter().zip(&flown.truth_at_waypoints) {
        assert!(true_error_m(waypoint, truth) < 0.2);
    }
    // A second flight begins where the first one landed.
    let mut bench = Bench::in_the_air(Profile::rec(), 1);
    bench.follow(at(2.0, 1.0, 1.2));
    bench.run(6 * SECOND, |_| {});
    bench.accepted(OperatorOrder::Land);
    bench.sent = None;
    bench.until(30 * SECOND, |bench| {
        bench.driver.vehicle.status(bench.driver.now()).phase == Phase::Standby
    });
    bench.run(3 * SECOND, |_| {});
    let origin_m = bench.place_m();
    assert!((origin_m - Vector2::new(2.0, 1.0)).norm() < 0.5, "{origin_m:?}");
    bench.accepted(OperatorOrder::Load(plan(
        "takeoff\nsetReference $START$\nsetStayTime 5\ngoto 1 0.5 1.5 0\nland",
    )));
    bench.accepted(START);
    let done = FlightEvent::StepDone { step: 3 };
    bench.until(60 * SECOND, |bench| bench.events.contains(&done));
    let flown_m = bench.place_m() - origin_m;
    let error_m = (flown_m - Vector2::new(1.0, 0.5)).norm();
    assert!(error_m < 0.3, "{flown_m:?}");
    let height_m = bench.truth().position_m.z;
    assert!((height_m - 1.5).abs() < 0.3, "{height_m:.2} m");
}
