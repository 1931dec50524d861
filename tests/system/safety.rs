//! No fault leads to a crash: a campaign of random faults, and regression tests of single flights.

use std::thread;
use std::time::Duration;

use autopilot::Plan;
use autopilot::outcome::Outcome;
use autopilot::plan::{Border, FlightLimits};
use autopilot::safety::Veto;
use autopilot::vehicle::{
    FlightEvent, LandingReason, OperatorOrder, Place, Quantity, Trust, VehicleConfig,
};
use kinematics::Sticks;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::{Action, Scenario, When};
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, Quantity as Sensor, SensorFault, WorldConfig};
use system_tests::sim::{Moment, SimulatedFlight, Simulation};
use system_tests::{SQUARE, campaign, landings, plan, rules};

const SECOND: Duration = Duration::from_secs(1);
const NEAR: FlightLimits = FlightLimits::new(Border::circle(4.0), 0.3, 3.0);

#[test]
fn five_hundred_flights_with_random_faults_end_well() {
    let halves = [1_u64..251, 251..501].map(|seeds| {
        thread::spawn(move || seeds.map(|seed| campaign::fly(seed).unwrap()).collect::<Vec<_>>())
    });
    let mut flown = 0;
    for verdict in halves.into_iter().flat_map(|half| half.join().unwrap()) {
        assert!(verdict.faults.is_empty(), "seed {}: {:?}", verdict.seed, verdict.faults);
        flown += usize::from(verdict.is_success());
    }
    // A campaign without completed flights would prove nothing.
    assert!(flown > 100, "only {flown} plans were flown to their end");
}

/// Seeds beyond those five hundred that showed a fault which was then mended.
#[test]
fn flights_that_once_went_wrong_end_well() {
    const LANDING_RIGHT_AFTER_TAKE_OFF: u64 = 2_004_116;
    const RESTARTED_DRONES: [u64; 2] = [6426, 8461];
    const CUT_DURING_A_TAKE_OVER: u64 = 900_820;
    const STORMS: [u64; 4] = [2359, 8173, 8688, 2_002_821];
    const GROUND_STATIONS: [u64; 3] = [3219, 4062, 5291];
    let single = [LANDING_RIGHT_AFTER_TAKE_OFF, CUT_DURING_A_TAKE_OVER];
    for seed in RESTARTED_DRONES.into_iter().chain(STORMS).chain(GROUND_STATIONS).chain(single) {
        assert_eq!(campaign::fly(seed).unwrap().faults, [], "seed {seed}");
    }
}

#[test]
fn the_same_seed_is_the_same_flight() {
    assert_eq!(campaign::fly(5).unwrap(), campaign::fly(5).unwrap());
}

/// Neither a gap that swallows the order or the drone's answer, nor another order, cancels a landing.
#[test]
fn no_gap_and_no_other_order_makes_a_landing_forgotten() {
    assert_eq!(landings::forgotten().unwrap(), Vec::<String>::new());
}

/// In each of these flights a single rule keeps the drone safe, whose absence random flights do not show.
#[test]
fn each_rule_holds_where_no_other_does() {
    assert_eq!(rules::broken().unwrap(), Vec::<String>::new());
}

/// A flight with a scenario; `watch` is called for every moment.
fn watched(
    text: &str,
    seed: u64,
    plan: Plan,
    simulation: Simulation,
    watch: impl FnMut(&Moment),
) -> SimulatedFlight {
    let scenario = Scenario::parse("scenario", text).unwrap();
    let mut world = WorldConfig { scenario, ..simulation.world };
    world.drone.seed = seed;
    Simulation { world, ..simulation }.fly_watched(plan, watch).unwrap()
}

/// Number of take-offs on the square.
fn take_offs(text: &str, seed: u64) -> u32 {
    let mut count = 0;
    let mut rose = false;
    let simulation = Simulation { aftermath: 20 * SECOND, ..Simulation::default() };
    let flight = watched(text, seed, plan(SQUARE), simulation, |moment| {
        let rises = matches!(moment.truth.phase, Phase::TakingOff { .. });
        count += u32::from(rises && !rose);
        rose = rises;
    });
    assert_eq!(flight.final_truth.phase, Phase::Landed, "{text}, seed {seed}");
    count
}

/// The drone lands by itself after 2 s of silence. If it is heard again shortly before touch-down, the order
/// to stay in the air must not reach it on the ground.
#[test]
fn a_drone_that_landed_by_itself_is_not_lifted_again() {
    for quarters in 8_u32..40 {
        let text = format!("+5 outage {}", f64::from(quarters) / 4.0);
        assert_eq!(take_offs(&text, u64::from(quarters % 3)), 1, "{text}");
    }
}

/// It has lost its state, while orders to stay in the air still arrive.
#[test]
fn a_drone_that_restarts_unheard_is_not_lifted() {
    for tenths in 0_u32..20 {
        let outage = f64::from(tenths) / 10.0 + 0.05;
        let text = format!("+5 restart\n+5 outage {outage}\n0 delay 40 jitter 40");
        assert_eq!(take_offs(&text, 1), 1, "{text}");
    }
}

/// The drone's own landing drifts with the wind, so the agent flies the first part of the descent.
#[test]
fn a_landing_in_the_wind_does_not_drift_far() {
    for seed in 1..=10 {
        let flown = plan("takeoff\ngoto 2 0 1 0\nland\n");
        let mut from_m = 0.0;
        let lands = |moment: &Moment| {
            // The place before the last step, which is the landing.
            if moment.status.step == Some(1) {
                from_m = moment.truth.odometry_m.x;
            }
        };
        let flight = watched("0 wind 1 0", seed, flown, Simulation::default(), lands);
        assert_eq!(flight.outcome, Outcome::Completed);
        let drifted_m = flight.final_truth.odometry_m.x - from_m;
        assert!(drifted_m < 0.5, "seed {seed}: {drifted_m:.2} m");
    }
}

/// Largest distance from the start.
fn furthest_m(moment: &Moment, furthest_m: &mut f64) {
    *furthest_m = furthest_m.max(moment.truth.odometry_m.norm());
}

#[test]
fn manual_control_does_not_leave_the_fence() {
    let full = Sticks { roll: 1.0, ..Sticks::default() };
    let sticks = (0..200_u32)
        .map(|tenth| (8 * SECOND + SECOND / 10 * tenth, OperatorOrder::Steer(full)))
        .chain([(30 * SECOND, OperatorOrder::Land)]);
    let orders: Vec<_> = sticks.collect();
    for (seed, wind) in [(1, ""), (2, "0 wind 1 0"), (3, "0 wind 0.5 -1 gusts 0.3")] {
        let pilot = VehicleConfig { limits: NEAR, ..VehicleConfig::default() };
        let simulation = Simulation { pilot, orders: orders.clone(), ..Simulation::default() };
        let mut away_m = 0.0;
        let flown = plan("takeoff\ngoto 0 0 0 0\nsetStayTime 60\ngoto 0 0 0 0\nland\n");
        let flight = watched(wind, seed, flown, simulation, |m| furthest_m(m, &mut away_m));
        assert_eq!(flight.outcome, Outcome::Interrupted, "{wind}: {away_m:.2} m");
        let stopped = flight.events.iter().any(|(_, event)| {
            matches!(event, FlightEvent::Veto(Veto::NearFence | Veto::OutsideFence))
        });
        assert!(stopped && away_m < 4.5, "{wind}: {away_m:.2} m");
    }
}

/// A stick that is held outward stops the drone at the fence, and neither leads it on along the border nor up and down.
#[test]
fn a_stick_that_is_held_at_the_fence_leads_the_drone_nowhere() {
    let square = [[-4.0, -4.0], [4.0, -4.0], [4.0, 4.0], [-4.0, 4.0]];
    let square = Border::polygon(&square).unwrap();
    for border in [NEAR.border, square] {
        for (profile, roll, pitch) in [
            (Profile::rec(), 0.7, -0.7),
            (Profile::rec(), 0.0, -1.0),
            (Profile::rec(), -1.0, 0.3),
            (Profile::tum(), 0.7, -0.7),
            (Profile::tf(), 1.0, -0.2),
            (Profile::leo(), 0.7, -0.7),
        ] {
            let held = Sticks { roll, pitch, ..Sticks::default() };
            let sticks = (0..400_u32)
                .map(|tenth| (8 * SECOND + SECOND / 10 * tenth, OperatorOrder::Steer(held)))
                .chain([(48 * SECOND, OperatorOrder::Land)]);
            let limits = FlightLimits { border, ..NEAR };
            let pilot = VehicleConfig { limits, ..VehicleConfig::default() };
            let drone = DroneConfig { profile, ..DroneConfig::default() };
            let world = WorldConfig { drone, ..WorldConfig::default() };
            let orders = sticks.collect();
            let simulation = Simulation { pilot, orders, world, ..Simulation::default() };
            let flown = plan("takeoff\ngoto 0 0 0 0\nsetStayTime 60\ngoto 0 0 0 0\nland\n");
            let mut places_m = Vec::new();
            let watch = |moment: &Moment| {
                if (28 * SECOND..48 * SECOND).contains(&moment.now) {
                    places_m.push(moment.truth.position_m);
                }
            };
            simulation.fly_watched(flown, watch).unwrap();
            let first_m = places_m[0];
            let led_m =
                places_m.iter().map(|place_m| (place_m - first_m).norm()).fold(0.0, f64::max);
            let reached_m = first_m.xy().norm();
            assert!(led_m < 0.3, "{profile:?} {roll} {pitch}: led on by {led_m:.2} m");
            assert!(reached_m > 2.5, "{profile:?} {roll} {pitch}: {reached_m:.2} m");
        }
    }
}

/// Who lets go of the sticks at the border or the ceiling, or asks for little, is not made faster by what stops the drone there, but
/// for 0.3 m/s.
#[test]
fn the_fence_makes_nobody_faster() {
    const FREE: FlightLimits = FlightLimits::new(Border::circle(1e3), 0.3, 100.0);
    const NARROW: FlightLimits = FlightLimits::new(Border::circle(1.0), 0.3, 1.5);
    let square = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let square = FlightLimits { border: Border::polygon(&square).unwrap(), ..NARROW };
    let sticks = |[roll, pitch, gaz, yaw]: [f64; 4]| Sticks { roll, pitch, gaz, yaw };
    // Largest true speed, from 3 s after the sticks were changed.
    let fastest_m_s = |limits, profile, first: [f64; 4], then: [f64; 4]| {
        let steered = (80..400_u32).map(|tenth| {
            let sticks = sticks(if tenth < 200 { first } else { then });
            (SECOND / 10 * tenth, OperatorOrder::Steer(sticks))
        });
        let orders = steered.chain([(40 * SECOND, OperatorOrder::Land)]).collect();
        let pilot = VehicleConfig { limits, ..VehicleConfig::default() };
        let drone = DroneConfig { profile, ..DroneConfig::default() };
        let world = WorldConfig { drone, ..WorldConfig::default() };
        let simulation = Simulation { pilot, orders, world, ..Simulation::default() };
        let flown = plan("takeoff\ngoto 0 0 0.2 0\nsetStayTime 60\ngoto 0 0 0.2 0\nland\n");
        let mut fastest_m_s = 0.0_f64;
        let watch = |moment: &Moment| {
            if (23 * SECOND..40 * SECOND).contains(&moment.now) {
                fastest_m_s = fastest_m_s.max(moment.truth.velocity_m_s.xy().norm());
            }
        };
        simulation.fly_watched(flown, watch).unwrap();
        fastest_m_s
    };
    let mut wrong = Vec::new();
    for (first, then) in [
        ([0.0, 0.0, 0.4, 0.0], [0.0; 4]),
        ([0.0, 0.0, 0.4, 0.0], [0.0, 0.0, 0.0, 0.4]),
        ([0.0, 0.0, 0.4, 0.0], [0.0, -0.05, 0.0, 0.0]),
        ([0.2, 0.0, 0.0, 0.0], [0.0; 4]),
        ([0.2, 0.0, 0.0, 0.0], [0.0, -0.05, 0.0, 0.0]),
        ([0.5, 0.3, 0.0, 0.0], [0.0, 0.0, 0.0, -0.4]),
        ([0.5, 0.3, 0.0, 0.0], [0.02, 0.05, 0.0, 0.2]),
        ([0.5, 0.3, 0.4, 0.0], [-0.03, 0.0, 0.01, 0.0]),
    ] {
        for profile in [Profile::rec(), Profile::tum(), Profile::tf(), Profile::leo()] {
            let free_m_s = fastest_m_s(FREE, profile, [0.0; 4], then);
            for limits in [NEAR, NARROW, square] {
                let fenced_m_s = fastest_m_s(limits, profile, first, then);
                if fenced_m_s > free_m_s.max(0.3) + 0.3 {
                    let border = limits.border;
                    wrong.push(format!(
                        "{border:?} {first:?} {then:?}: {fenced_m_s:.2} m/s, {free_m_s:.2} without a fence"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// After a gust that no drone could resist, the drone comes back, low, and lands inside.
#[test]
fn a_drone_that_was_blown_over_the_fence_comes_back_to_land() {
    for seed in 1..=5 {
        let pilot = VehicleConfig { limits: NEAR, ..VehicleConfig::default() };
        let simulation = Simulation { pilot, ..Simulation::default() };
        let flown = plan("takeoff\nsetStayTime 20\ngoto 3.9 0 0 0\nland\n");
        let gust = "+12 wind 7 0\n+13 wind 0 0";
        let flight = watched(gust, seed, flown, simulation, |_| {});
        let outside = FlightEvent::LandingOrdered(LandingReason::Safety(Veto::OutsideFence));
        assert!(flight.events.iter().any(|(_, event)| *event == outside), "{:?}", flight.events);
        let away_m = flight.final_truth.odometry_m.norm();
        assert!(flight.final_truth.phase == Phase::Landed && away_m < 4.2, "{away_m:.2} m");
    }
}

/// The drone is landed while it is being carried off, not after it has left the fence.
#[test]
fn a_storm_that_carries_the_drone_off_lands_it_before_it_leaves_its_fence() {
    for seed in 1..=5 {
        let drone = DroneConfig { profile: Profile::tf(), ..DroneConfig::default() };
        let world = WorldConfig { drone, ..WorldConfig::default() };
        let pilot = VehicleConfig { limits: NEAR, ..VehicleConfig::default() };
        let simulation = Simulation { world, pilot, ..Simulation::default() };
        let mut away_m = 0.0;
        let flown = plan("takeoff\ngoto 0 2.5 1.5 0\nland\n");
        let see = |moment: &Moment| furthest_m(moment, &mut away_m);
        let flight = watched("0 wind 0 2", seed, flown, simulation, see);
        let ordered = FlightEvent::LandingOrdered(LandingReason::Safety(Veto::CarriedOff));
        assert!(flight.events.iter().any(|(_, event)| *event == ordered), "{:?}", flight.events);
        assert!(flight.final_truth.phase == Phase::Landed && away_m < 6.0, "{away_m:.2} m");
    }
}

#[test]
fn navdata_that_stay_frozen_or_lie_too_much_land_the_drone() {
    for (text, trust) in [
        ("+5 freeze 20", Trust::Frozen(Quantity::Velocity)),
        ("+5 lie velocity 4 0 for 20", Trust::Implausible(Quantity::Velocity)),
    ] {
        let flight = watched(text, 1, plan(SQUARE), Simulation::default(), |_| {});
        let ordered = FlightEvent::LandingOrdered(LandingReason::Distrust(trust));
        assert!(flight.events.iter().any(|(_, event)| *event == ordered), "{:?}", flight.events);
    }
}

/// Its packets arrive, so the link is not lost, but they are dated ever later.
#[test]
fn a_slow_clock_lands_the_drone_and_is_told_as_what_it_is() {
    let slow = Action::Sensor(Sensor::Clock, SensorFault::Ramp(-0.5), 60 * SECOND);
    let scenario = Scenario::default().and(When::SinceTakeOff(5 * SECOND), slow);
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    let flight = Simulation { world, ..Simulation::default() }.fly(plan(SQUARE)).unwrap();
    let reason = LandingReason::NavdataLate.to_string();
    assert_eq!(flight.outcome, Outcome::Failsafe { reason });
}

/// Whatever was wrong: the motors do not start.
#[test]
fn a_drone_that_lies_from_the_first_packet_does_not_take_off() {
    for (sensor, fault) in [
        (Sensor::VelocityRight, SensorFault::Offset(20.0)),
        (Sensor::Altitude, SensorFault::Offset(-5.0)),
        (Sensor::Altitude, SensorFault::Offset(2.0)),
        (Sensor::Yaw, SensorFault::NotANumber),
    ] {
        let lies = Action::Sensor(sensor, fault, 60 * SECOND);
        let scenario = Scenario::default().and(When::SinceStart(Duration::ZERO), lies);
        let world = WorldConfig { scenario, ..WorldConfig::default() };
        let simulation = Simulation { world, ..Simulation::default() };
        let mut rose = false;
        let watch = |moment: &Moment| rose |= moment.truth.phase != Phase::Landed;
        let flight = simulation.fly_watched(plan(SQUARE), watch).unwrap();
        assert!(!rose, "{sensor:?} {fault:?}: {:?}", flight.outcome);
    }
}

/// An error that is there from the start does not jump in flight.
#[test]
fn a_velocity_that_is_wrong_before_the_take_off_does_not_carry_the_drone_away() {
    let long = "takeoff\ngoto 0 0 0.5 0\nsetStayTime 30\ngoto 0 0 0.5 0\nland\n";
    for profile in [Profile::rec(), Profile::tum(), Profile::tf(), Profile::leo()] {
        for since in ["0", "+0", "+0.5"] {
            for wrong_m_s in [1.0, 1.7, 3.0] {
                let drone = DroneConfig { profile, ..DroneConfig::default() };
                let text = format!("{since} lie velocity-right {wrong_m_s} for 600");
                let scenario = Scenario::parse("wrong", &text).unwrap();
                let world = WorldConfig { scenario, drone, ..WorldConfig::default() };
                let simulation = Simulation { world, ..Simulation::default() };
                let mut away_m = 0.0;
                let flight =
                    simulation.fly_watched(plan(long), |m| furthest_m(m, &mut away_m)).unwrap();
                assert!(away_m < 1.5, "{text}: {away_m:.2} m, {:?}", flight.outcome);
                assert_ne!(flight.outcome, Outcome::Completed, "{text}");
            }
        }
    }
}

/// A flight of an airframe in wind, and its largest distance from the start.
fn in_the_wind(profile: Profile, seed: u64, text: &str, wind: &str) -> (SimulatedFlight, f64) {
    let scenario = Scenario::parse("wind", wind).unwrap();
    let sensors = SensorModel::hard();
    let drone = DroneConfig { profile, sensors, seed, ..DroneConfig::default() };
    let world = WorldConfig { scenario, drone, ..WorldConfig::default() };
    let limits = FlightLimits { border: Border::circle(60.0), ..NEAR };
    let pilot = VehicleConfig { limits, ..VehicleConfig::default() };
    let mut away_m = 0.0;
    let simulation = Simulation { world, pilot, ..Simulation::default() };
    let flight = simulation.fly_watched(plan(text), |m| furthest_m(m, &mut away_m)).unwrap();
    (flight, away_m)
}

/// Whatever tilt it needs, as long as the position is held.
#[test]
fn a_wind_that_can_be_held_against_lands_nobody() {
    for seed in 1..=5 {
        let flight = in_the_wind(Profile::leo(), seed, SQUARE, "0 wind 0.5 0 gusts 0.25").0;
        assert_eq!(flight.outcome, Outcome::Completed, "seed {seed}");
    }
}

/// A wind that carries the drone off at full tilt does so until the landing, which is ordered after two
/// seconds.
#[test]
fn a_wind_that_cannot_be_held_against_lands_in_time() {
    let long = "takeoff\ngoto 0 0 0 0\nsetStayTime 60\ngoto 0 0 0 0\nland\n";
    // Either the agent notices it by the saturated sticks, or the safety monitor by the braking distance.
    let reasons = [LandingReason::Wind, LandingReason::Safety(Veto::CarriedOff)];
    let ends = reasons.map(|reason| Outcome::Failsafe { reason: reason.to_string() });
    for (profile, wind) in [(Profile::rec(), "+10 wind 6 0"), (Profile::leo(), "+10 wind 4 0")] {
        for seed in 1..=5 {
            let (flight, away_m) = in_the_wind(profile, seed, long, wind);
            assert!(ends.contains(&flight.outcome), "{wind}: {:?}", flight.outcome);
            assert!(away_m < 25.0, "{wind}, seed {seed}: {away_m:.1} m");
        }
    }
}

/// A manual target is flown to and held while the plan waits; the plan then goes on.
#[test]
fn the_drone_is_sent_by_hand_and_the_plan_goes_on() {
    let go_to = |x_m, y_m| OperatorOrder::GoTo(Place::at(x_m, y_m));
    let orders = vec![
        (8 * SECOND, go_to(f64::NAN, 0.0)),
        (8 * SECOND, go_to(0.5, 2.0)),
        // Changed in flight, and twice at once: the last order counts.
        (10 * SECOND, go_to(1.0, -1.0)),
        (10 * SECOND, go_to(-1.5, 0.5)),
        (22 * SECOND, OperatorOrder::Resume),
    ];
    for seed in 1..=3 {
        let mut there_m = f64::INFINITY;
        let watch = |moment: &Moment| {
            if moment.now < 22 * SECOND {
                let at = moment.truth.odometry_m;
                there_m = (at.x + 1.5).hypot(at.y - 0.5);
            }
        };
        let simulation = Simulation { orders: orders.clone(), ..Simulation::default() };
        let flight = watched("", seed, plan(SQUARE), simulation, watch);
        assert_eq!(flight.outcome, Outcome::Completed);
        assert!(there_m < 0.25, "seed {seed}: {there_m:.2} m off");
        let count = |event| flight.events.iter().filter(|(_, other)| *other == event).count();
        assert_eq!(count(FlightEvent::ManualTargetSet), 3);
        assert_eq!(count(FlightEvent::ManualTargetReached), 1);
    }
}

/// A hold in the tick of a manual target, or just after it, cancels the target.
#[test]
fn a_hold_takes_back_where_the_drone_was_sent() {
    for after_ms in [0, 10, 30, 40, 60, 100] {
        let held = 9 * SECOND + Duration::from_millis(after_ms);
        let sent = OperatorOrder::GoTo(Place::at(3.0, 0.0));
        let orders = vec![
            (8 * SECOND, OperatorOrder::Hold),
            (9 * SECOND, sent),
            (held, OperatorOrder::Hold),
            (20 * SECOND, OperatorOrder::Land),
        ];
        let mut furthest = 0.0;
        let simulation = Simulation { orders, ..Simulation::default() };
        let flown = plan("takeoff\ngoto 0 0 0 0\nsetStayTime 60\ngoto 0 0 0 0\nland\n");
        let flight = watched("", 1, flown, simulation, |m| furthest_m(m, &mut furthest));
        assert_eq!(flight.outcome, Outcome::Interrupted);
        assert!(furthest < 0.4, "{after_ms} ms: {furthest:.2} m");
    }
}

/// A target outside the fence is moved to its edge; one that is not reached in time is given up.
#[test]
fn a_place_given_by_hand_may_be_outside_or_never_reached() {
    let sent = (8 * SECOND, OperatorOrder::GoTo(Place::at(80.0, 0.0)));
    let fly = |radius_m, settings, orders| {
        let flown = plan(&format!("takeoff\n{settings}goto 0 0 0 0\ngoto 0 1 0 0\nland\n"));
        let limits = FlightLimits { border: Border::circle(radius_m), ..NEAR };
        let pilot = VehicleConfig { limits, ..VehicleConfig::default() };
        let simulation = Simulation { orders, pilot, ..Simulation::default() };
        let mut away_m = 0.0;
        let flight = watched("", 1, flown, simulation, |m| furthest_m(m, &mut away_m));
        let events: Vec<_> = flight.events.into_iter().map(|(_, event)| event).collect();
        (events, away_m)
    };
    let (events, away_m) = fly(4.0, "", vec![sent.clone(), (25 * SECOND, OperatorOrder::Land)]);
    assert!(events.contains(&FlightEvent::ManualTargetReached), "{events:?}");
    assert!((3.5..4.3).contains(&away_m), "{away_m:.2} m");
    let (events, _) = fly(100.0, "setMaxControl 0.05\n", vec![sent]);
    let given_up = FlightEvent::LandingOrdered(LandingReason::ManualTargetTimedOut);
    assert!(events.contains(&given_up), "{events:?}");
}
