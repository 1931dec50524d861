//! Flights in simulated time.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::{FlightEvent, LandingReason, OperatorOrder};
use kinematics::wrap_deg;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::{Action, Direction, Scenario, When};
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, LinkFaults, WorldConfig};
use nalgebra::Vector2;
use system_tests::sim::{SimulatedFlight, Simulation};
use system_tests::{SQUARE, plan, true_error_m};

pub(crate) fn fly(simulation: &Simulation, text: &str) -> SimulatedFlight {
    simulation.fly(plan(text)).unwrap()
}

fn largest_true_error_m(flight: &SimulatedFlight) -> f64 {
    let pairs = flight.report.waypoints.iter().zip(&flight.truth_at_waypoints);
    pairs.map(|(waypoint, truth)| true_error_m(waypoint, truth)).fold(0.0, f64::max)
}

const SECOND: Duration = Duration::from_secs(1);

fn with_drone(drone: DroneConfig) -> Simulation {
    let world = WorldConfig { drone, ..WorldConfig::default() };
    Simulation { world, ..Simulation::default() }
}

/// A world with one fault.
fn happens(at: Duration, action: Action) -> Simulation {
    let scenario = Scenario::default().and(When::SinceStart(at), action);
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    Simulation { world, ..Simulation::default() }
}

#[test]
fn the_square_is_flown_and_the_drone_is_at_each_waypoint() {
    for seed in 1..=20 {
        let drone = DroneConfig { seed, ..DroneConfig::default() };
        let flight = fly(&with_drone(drone), SQUARE);
        assert_eq!(flight.outcome, Outcome::Completed, "seed {seed}");
        assert_eq!(flight.report.waypoints.len(), 4);
        assert_eq!(flight.final_truth.phase, Phase::Landed);
        let error_m = largest_true_error_m(&flight);
        assert!(error_m < 0.2, "seed {seed}: {error_m:.2} m");
        assert!(flight.report.flight_time().is_some_and(|time| time < 30 * SECOND));
    }
}

#[test]
fn every_plan_in_the_folder_is_flown_to_its_end() {
    let mut flown = 0;
    for entry in std::fs::read_dir("../plans").unwrap() {
        let path = entry.unwrap().path();
        let flight = fly(&Simulation::default(), &std::fs::read_to_string(&path).unwrap());
        assert_eq!(flight.outcome, Outcome::Completed, "{}", path.display());
        let error_m = largest_true_error_m(&flight);
        assert!(error_m < 0.2, "{}: {error_m:.2} m", path.display());
        flown += 1;
    }
    assert!(flown >= 4);
}

#[test]
fn the_same_flight_twice_is_the_same_bit_for_bit() {
    let simulation = Simulation::default();
    assert_eq!(fly(&simulation, SQUARE), fly(&simulation, SQUARE));
    let drone = DroneConfig { seed: 2, ..DroneConfig::default() };
    let other = with_drone(drone);
    assert_ne!(fly(&simulation, SQUARE).final_truth, fly(&other, SQUARE).final_truth);
}

#[test]
fn perfect_sensors_make_the_estimate_the_truth() {
    // A sensor without noise would look frozen.
    let sensors = SensorModel {
        flow_noise_m_s: 1e-4,
        altitude_noise_m: 0.002,
        attitude_noise_deg: 0.01,
        yaw_noise_deg: 0.01,
        ..SensorModel::perfect()
    };
    let drone = DroneConfig { sensors, ..DroneConfig::default() };
    let flight = fly(&with_drone(drone), SQUARE);
    assert_eq!(flight.outcome, Outcome::Completed);
    for (waypoint, truth) in flight.report.waypoints.iter().zip(&flight.truth_at_waypoints) {
        let pose = &waypoint.pose;
        let off = (pose.x_m - truth.position_m.x).hypot(pose.y_m - truth.position_m.y);
        assert!(off < 0.05, "{off:.3} m");
    }
}

#[test]
fn a_turn_goes_the_short_way_and_the_frame_does_not_turn_with_the_drone() {
    let text = "takeoff\ngoto 0 0 0 90\ngoto 1 0 0 181\ngoto 0 0 0 0\nland";
    let flight = fly(&Simulation::default(), text);
    assert_eq!(flight.outcome, Outcome::Completed);
    assert!(largest_true_error_m(&flight) < 0.2);
    // Whole turns do not matter, only the final heading.
    let off_deg = wrap_deg(flight.final_truth.yaw_deg);
    assert!(off_deg.abs() < 8.0, "{off_deg}");
}

/// Largest distance from the line x = 0 in the frame of the drone's own odometry.
fn off_the_line_m(simulation: &Simulation, text: &str) -> f64 {
    let mut worst_m: f64 = 0.0;
    let flight = simulation
        .fly_watched(plan(text), |moment| {
            if let Some(target) = moment.status.target {
                worst_m = worst_m.max((moment.truth.odometry_m.x - target.x_m).abs());
            }
        })
        .unwrap();
    assert_eq!(flight.outcome, Outcome::Completed);
    worst_m
}

#[test]
fn a_full_turn_on_the_way_does_not_bend_it() {
    let text =
        "takeoff\nsetReference $POSE$\ngoto 0 1.5 0 120\ngoto 0 3 0 240\ngoto 0 0 0 360\nland";
    for profile in [Profile::rec(), Profile::tum(), Profile::tf(), Profile::leo()] {
        for seed in 1..=5 {
            let drone = DroneConfig { profile, seed, ..DroneConfig::default() };
            let off_m = off_the_line_m(&with_drone(drone), text);
            assert!(off_m < 0.15, "{profile:?} seed {seed}: {off_m:.2} m");
        }
    }
}

#[test]
fn a_heading_across_the_jump_is_reached() {
    let sensors = SensorModel { initial_heading_deg: 171.0, ..SensorModel::nominal() };
    let text = "takeoff\ngoto 0 0 0 20\ngoto 0 0 0 181\ngoto 0 0 0 0\nland";
    for seed in 1..=5 {
        let drone = DroneConfig { sensors, seed, ..DroneConfig::default() };
        let flight = fly(&with_drone(drone), text);
        assert_eq!(flight.outcome, Outcome::Completed, "seed {seed}");
        assert!(flight.duration < 30 * SECOND, "{:?}", flight.duration);
    }
}

/// The time limit of the way back does not depend on the length of the stay.
#[test]
fn a_disturbance_late_in_a_long_stay_does_not_end_the_plan() {
    for seed in 1..=3 {
        let text = "+70 wind 3.5 0\n+71 wind 0 0";
        let scenario = Scenario::parse("push", text).unwrap();
        let drone = DroneConfig { seed, ..DroneConfig::default() };
        let world = WorldConfig { scenario, drone, ..WorldConfig::default() };
        let simulation = Simulation { world, ..Simulation::default() };
        let mut pushed_m: f64 = 0.0;
        let flight = simulation
            .fly_watched(plan("takeoff\nsetStayTime 90\ngoto 0 0 1 0\nland"), |moment| {
                if moment.now > 60 * SECOND {
                    pushed_m = pushed_m.max(moment.truth.odometry_m.norm());
                }
            })
            .unwrap();
        assert!(pushed_m > 0.6, "{pushed_m:.2} m is no drift");
        assert_eq!(flight.outcome, Outcome::Completed, "seed {seed}");
    }
}

#[test]
fn the_operators_order_lands_in_the_middle_of_a_step() {
    let orders = vec![(8 * SECOND, OperatorOrder::Land)];
    let simulation = Simulation { orders, ..Simulation::default() };
    let flight = fly(&simulation, SQUARE);
    assert_eq!(flight.outcome, Outcome::Interrupted);
    assert_eq!(flight.final_truth.phase, Phase::Landed);
    assert!(flight.duration < 13 * SECOND);
}

/// Delays of more than two ticks each way: the drone is seen on the ground while the take-off order is on its
/// way.
#[test]
fn a_landing_ordered_right_after_the_take_off_keeps_the_drone_down() {
    let link = LinkFaults {
        delay: Duration::from_millis(42),
        jitter: Duration::from_millis(15),
        ..LinkFaults::default()
    };
    let mut overtaken = 0;
    for ms in (2000..5000).step_by(30) {
        let ordered_at = Duration::from_millis(ms);
        let simulation = Simulation {
            world: WorldConfig { link, ..WorldConfig::default() },
            orders: vec![(ordered_at, OperatorOrder::Land)],
            aftermath: 3 * SECOND,
            ..Simulation::default()
        };
        let mut rises = false;
        let flight = simulation
            .fly_watched(plan(SQUARE), |moment| {
                // By then the drone is down again whenever the landing was ordered.
                let late = moment.now > ordered_at + 8 * SECOND;
                rises |= late && moment.truth.phase == Phase::Flying;
                overtaken += u32::from(
                    moment.now < ordered_at + SECOND
                        && matches!(moment.truth.phase, Phase::TakingOff { .. }),
                );
            })
            .unwrap();
        assert!(!rises, "ordered at {ms} ms: {:?}", flight.events);
        assert_eq!(flight.outcome, outcome_of_landing(&flight), "ordered at {ms} ms");
        assert_eq!(flight.final_truth.phase, Phase::Landed, "ordered at {ms} ms");
    }
    assert!(overtaken > 0, "none came in the take-off");
}

/// A flight that has begun is landed, and another one is called off.
fn outcome_of_landing(flight: &SimulatedFlight) -> Outcome {
    if flight.start_of_step(0).is_some() { Outcome::Interrupted } else { Outcome::CalledOff }
}

#[test]
fn the_operators_order_is_obeyed_at_every_moment() {
    // How long the plan's own landing takes: ordered within it, or after it, nothing is left to be obeyed.
    let landing = 4 * SECOND;
    let whole = fly(&Simulation::default(), SQUARE);
    for tenths in 0..250 {
        let orders = vec![(SECOND / 10 * tenths, OperatorOrder::Land)];
        let simulation = Simulation { orders, ..Simulation::default() };
        let flight = fly(&simulation, SQUARE);
        let is_over = SECOND / 10 * tenths + landing >= whole.duration;
        let over = is_over && flight.outcome == Outcome::Completed;
        assert!(over || flight.outcome == outcome_of_landing(&flight), "{tenths}: {flight:?}");
        assert_eq!(flight.final_truth.phase, Phase::Landed, "ordered at {tenths}/10 s");
    }
}

#[test]
fn a_short_outage_is_survived_and_a_long_one_lands() {
    let outage = |from: u32, to: u32| {
        happens(SECOND * from / 10, Action::Outage(Direction::Both, SECOND * (to - from) / 10))
    };
    let mut hovered = 0;
    let flight = outage(80, 90)
        .fly_watched(plan(SQUARE), |moment| {
            let outage = 8 * SECOND..9 * SECOND;
            hovered += u32::from(outage.contains(&moment.now) && moment.status.target.is_none());
        })
        .unwrap();
    assert_eq!(flight.outcome, Outcome::Completed);
    assert!((15..30).contains(&hovered), "the pilot hovered for {hovered} ticks");
    // After three seconds the link counts as lost, and the drone is landed as soon as it is heard again.
    let flight = fly(&outage(80, 110), SQUARE);
    assert_eq!(flight.outcome, Outcome::LinkLost);
    assert_eq!(flight.final_truth.phase, Phase::Landed);
    // Without end: the drone lands by itself.
    let flight = fly(&outage(80, 10_000), SQUARE);
    assert_eq!(flight.outcome, Outcome::LinkLost);
    assert!(flight.duration < 16 * SECOND, "{:?}", flight.duration);
}

#[test]
fn a_drone_that_never_answers_is_reported_soon() {
    let flight =
        fly(&happens(Duration::ZERO, Action::Outage(Direction::Both, 100 * SECOND)), SQUARE);
    assert_eq!(flight.outcome, Outcome::NoDrone);
    assert!(flight.duration <= 6 * SECOND);
}

#[test]
fn a_drone_that_restarts_in_flight_stays_on_the_ground() {
    let flight = fly(&happens(9 * SECOND, Action::Restart), SQUARE);
    let reason = "the drone has restarted".to_owned();
    assert_eq!(flight.outcome, Outcome::Failsafe { reason });
    assert_eq!(flight.final_truth.phase, Phase::Landed);
    assert!(flight.final_truth.position_m.z.abs() < 1e-9);
    let ordered = FlightEvent::LandingOrdered(LandingReason::DroneRestarted);
    assert!(flight.events.iter().any(|(_, event)| *event == ordered));
}

#[test]
fn a_drone_that_cuts_its_motors_ends_the_flight_and_is_not_flown_again() {
    let blocked = |seconds| happens(SECOND * seconds, Action::Propeller);
    let flight = fly(&blocked(9), SQUARE);
    assert_eq!(flight.outcome, Outcome::Emergency);
    assert_eq!(flight.outcome.exit_status(), 50);
    assert!(flight.events.iter().any(|(_, event)| *event == FlightEvent::Emergency));
    // Before take-off the flight is refused with all reasons.
    let flight = fly(&blocked(0), SQUARE);
    assert!(matches!(&flight.outcome, Outcome::PreflightRefused { reasons } if reasons.len() == 2));
}

#[test]
fn an_empty_battery_is_refused_before_take_off_and_lands_in_flight() {
    let battery =
        |battery_percent| with_drone(DroneConfig { battery_percent, ..DroneConfig::default() });
    let flight = fly(&battery(15.0), SQUARE);
    assert!(matches!(&flight.outcome, Outcome::PreflightRefused { reasons }
        if reasons.len() == 1 && reasons[0].contains("battery at 15 %")));
    assert!(flight.final_truth.position_m.z.abs() < 1e-9);
    let long = "takeoff\nsetStayTime 55\ngoto 0 1 0 0\ngoto 0 0 0 0\nland";
    let flight = fly(&battery(30.0), long);
    assert!(matches!(&flight.outcome, Outcome::PreflightRefused { reasons }
        if reasons.len() == 1 && reasons[0].contains("the plan takes about 1")));
    // An old battery, which empties suddenly.
    let flight = fly(&happens(9 * SECOND, Action::Battery(11.0)), SQUARE);
    assert!(matches!(&flight.outcome, Outcome::Failsafe { reason } if reason.contains("battery")));
    assert_eq!(flight.final_truth.phase, Phase::Landed);
}

#[test]
fn a_step_that_makes_no_progress_is_given_up() {
    // Smaller than the drone's motion in gusts: the target is reached, but never held for a whole stay.
    let text = "takeoff\nsetInitialReachDist 0.01\nsetStayWithinDist 0.01\nsetStayTime 30\n\
                goto 0 1 0 0\nland";
    let scenario = Scenario::parse("gusts", "0 wind 0.5 0.5 gusts 0.4").unwrap();
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    let flight = fly(&Simulation { world, ..Simulation::default() }, text);
    let reason = "step 5 exceeded its time limit".to_owned();
    assert_eq!(flight.outcome, Outcome::Failsafe { reason });
    assert_eq!(flight.final_truth.phase, Phase::Landed);
}

#[test]
fn a_slow_link_is_flown_all_the_same() {
    let delay = Action::Delay(Duration::from_millis(40), Duration::ZERO);
    let flight = fly(&happens(Duration::ZERO, delay), SQUARE);
    assert_eq!(flight.outcome, Outcome::Completed);
    assert!(largest_true_error_m(&flight) < 0.3);
}

#[test]
fn settings_of_the_plan_are_obeyed() {
    let slow = fly(&Simulation::default(), "takeoff\nsetMaxControl 0.1\ngoto 0 2 0 0\nland");
    let fast = fly(&Simulation::default(), "takeoff\ngoto 0 2 0 0\nland");
    assert!(slow.duration > fast.duration + 2 * SECOND);
    let long = fly(&Simulation::default(), "takeoff\nsetStayTime 6\ngoto 0 2 0 0\nland");
    assert!(long.duration > fast.duration + 3 * SECOND);
}

#[test]
fn a_second_flight_in_one_plan_takes_off_again() {
    let text = "takeoff\ngoto 0 1 0 0\nland\ntakeoff\ngoto 0 0 0 0\nland";
    let flight = fly(&Simulation::default(), text);
    assert_eq!(flight.outcome, Outcome::Completed);
    assert_eq!(flight.report.waypoints.len(), 2);
    // The reference is still the end of the first take-off, so the drone flew back.
    assert!(flight.final_truth.position_m.y < 0.3, "{}", flight.final_truth.position_m);
}

#[test]
fn every_airframe_is_flown_without_going_far_beyond_a_target() {
    for (profile, beyond_m) in
        [(Profile::rec(), 0.1), (Profile::tum(), 0.2), (Profile::tf(), 0.1), (Profile::leo(), 0.1)]
    {
        for seed in 1..=3 {
            let simulation = with_drone(DroneConfig { profile, seed, ..DroneConfig::default() });
            let mut furthest_m: f64 = 0.0;
            let plan = plan("takeoff\ngoto 0 2 0 0\ngoto 0 2 1 0\ngoto 0 2 0 0\nland");
            let flight = simulation
                .fly_watched(plan, |moment| {
                    let beyond_m = moment.truth.odometry_m.y - 2.0;
                    furthest_m = furthest_m.max(beyond_m);
                })
                .unwrap();
            assert_eq!(flight.outcome, Outcome::Completed, "{profile:?}");
            assert!(furthest_m < beyond_m, "{profile:?}: {furthest_m:.2} m");
        }
    }
}

/// Worse sensors with wrong echoes, wind with gusts, a wrong level reference, lost packets: the position is
/// held whatever tilt that needs.
#[test]
fn every_airframe_flies_every_plan_on_a_hard_day() {
    let plans = ["square1x1", "xyz", "NikolausVertical"];
    for profile in [Profile::rec(), Profile::tum(), Profile::tf(), Profile::leo()] {
        for name in plans {
            let text = std::fs::read_to_string(format!("../plans/{name}.txt")).unwrap();
            for seed in 1..=3 {
                let drone = DroneConfig {
                    seed,
                    profile,
                    sensors: SensorModel::hard(),
                    wind_m_s: Vector2::new(0.5, -0.4),
                    gusts_m_s: 0.2,
                    trim_error_deg: 0.6,
                    ..DroneConfig::default()
                };
                let link = LinkFaults { loss: 0.03, ..LinkFaults::default() };
                let world = WorldConfig { drone, link, ..WorldConfig::default() };
                let flight = fly(&Simulation { world, ..Simulation::default() }, &text);
                assert_eq!(flight.outcome, Outcome::Completed, "{name}, seed {seed}: {profile:?}");
            }
        }
    }
}
