//! The estimate compared with the truth.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::{Quantity, Trust};
use kinematics::Airframe;
use mock_drone::airframe::Profile;
use mock_drone::firmware::Phase;
use mock_drone::scenario::Scenario;
use mock_drone::sensors::SensorModel;
use mock_drone::{DroneConfig, WorldConfig};
use system_tests::sim::{Moment, Simulation};
use system_tests::{SQUARE, place_in_navdata_frame, plan};

const VERTICAL: &str = include_str!("../../plans/NikolausVertical.txt");

fn with(drone: DroneConfig, scenario: &str) -> Simulation {
    let scenario = Scenario::parse("scenario", scenario).unwrap();
    let world = WorldConfig { drone, scenario, ..WorldConfig::default() };
    Simulation { world, ..Simulation::default() }
}

fn learnt(profile: Profile, seed: u64) -> Airframe {
    let mut airframe = Airframe::default();
    let simulation = with(DroneConfig { profile, seed, ..DroneConfig::default() }, "");
    let flight =
        simulation.fly_watched(plan(VERTICAL), |moment| airframe = moment.status.airframe).unwrap();
    assert_eq!(flight.outcome, Outcome::Completed);
    airframe
}

fn assert_about(what: &str, value: f64, truth: f64, share: f64) {
    assert!((value / truth - 1.0).abs() <= share, "{what} is {value:.3}, in truth {truth:.3}");
}

#[test]
fn every_airframe_is_learnt_in_one_flight() {
    for seed in 1..=3 {
        let tum = learnt(Profile::tum(), seed);
        assert_about("tum's tilt", tum.tilt_gain, 2.0, 0.25);
        assert_about("tum's climb", tum.climb_gain, 0.6 / 0.7, 0.05);
        assert_about("tum's drop", tum.drop_gain, 1.2 / 0.7, 0.1);
        assert_about("tum's climb lag", tum.climb_lag_s, 1.25, 0.1);
        let tf = learnt(Profile::tf(), seed);
        assert_about("tf's thrust", tf.thrust_gain.x, 4.774 / 9.81, 0.15);
        assert_about("tf's climb", tf.climb_gain, 0.885, 0.1);
        let leo = learnt(Profile::leo(), seed);
        assert_about("leo's drag", leo.drag_1_s.x, 1.95, 0.2);
        assert_about("leo's climb lag", leo.climb_lag_s, 0.88, 0.2);
        let rec = learnt(Profile::rec(), seed);
        assert_about("rec's tilt", rec.tilt_gain, 1.0, 0.15);
        assert_about("rec's climb lag", rec.climb_lag_s, 0.5, 0.15);
    }
}

/// Root mean square of the drift at the end, of the estimate and of the odometry.
fn drifts_m(sensors: SensorModel, scenario: &str) -> (f64, f64) {
    let (mut estimate, mut odometry) = (0.0, 0.0);
    for seed in 1..=20 {
        let simulation = with(DroneConfig { sensors, seed, ..DroneConfig::default() }, scenario);
        let mut last = (0.0, 0.0);
        let watch = |moment: &Moment| {
            if moment.status.target.is_some() {
                let pose = moment.status.pose.unwrap_or_default();
                let truth = moment.truth.position_m;
                last = (
                    (truth.x - pose.x_m).powi(2) + (truth.y - pose.y_m).powi(2),
                    moment.truth.drift_m().norm_squared(),
                );
            }
        };
        simulation.fly_watched(plan(VERTICAL), watch).unwrap();
        estimate += last.0;
        odometry += last.1;
    }
    (f64::sqrt(estimate / 20.0), f64::sqrt(odometry / 20.0))
}

#[test]
fn the_estimate_drifts_no_more_than_the_drones_own_velocity() {
    for (sensors, scenario) in [
        (SensorModel::nominal(), ""),
        (SensorModel::hard(), ""),
        (SensorModel::nominal(), "0 loss 10\n0 delay 30 jitter 30"),
        (SensorModel::nominal(), "0 duplicate 20\n0 reorder 10"),
    ] {
        let (estimate_m, odometry_m) = drifts_m(sensors, scenario);
        assert!(estimate_m <= 1.1 * odometry_m, "{scenario}: {estimate_m:.3} {odometry_m:.3}");
    }
}

/// In flight the drone is close to the predicted state, in the frame that navdata span.
#[test]
fn the_prediction_is_where_the_drone_is() {
    for (scenario, most_m) in
        [("", 0.12), ("0 delay 30 jitter 20\n0 loss 10\n0 duplicate 10", 0.25)]
    {
        let mut worst_m: f64 = 0.0;
        for seed in 1..=5 {
            let simulation = with(DroneConfig { seed, ..DroneConfig::default() }, scenario);
            simulation
                .fly_watched(plan(SQUARE), |moment| {
                    if moment.status.target.is_some() {
                        let place = place_in_navdata_frame(&moment.truth);
                        let pose = moment.status.pose.unwrap_or_default();
                        let off = (place.x - pose.x_m).hypot(place.y - pose.y_m);
                        worst_m = worst_m.max(off.hypot(place.z - pose.z_m));
                    }
                })
                .unwrap();
        }
        assert!(worst_m < most_m, "{scenario}: {worst_m:.3}");
    }
}

#[test]
fn the_uncertainty_is_honest() {
    for sensors in [SensorModel::nominal(), SensorModel::hard()] {
        let (mut inside, mut all) = (0.0_f64, 0.0_f64);
        let mut largest_m: f64 = 0.0;
        for seed in 1..=20 {
            let simulation = with(DroneConfig { sensors, seed, ..DroneConfig::default() }, "");
            let watch = |moment: &Moment| {
                if moment.status.target.is_none() {
                    return;
                }
                let (pose, truth) =
                    (moment.status.pose.unwrap_or_default(), &moment.truth.position_m);
                let uncertainty_m = moment.status.uncertainty_m;
                for off_m in [truth.x - pose.x_m, truth.y - pose.y_m] {
                    all += 1.0;
                    inside += f64::from(u8::from(off_m.abs() <= 2.0 * uncertainty_m));
                }
                largest_m = largest_m.max(uncertainty_m);
            };
            simulation.fly_watched(plan(VERTICAL), watch).unwrap();
        }
        assert!(inside / all >= 0.95, "{:.3} of all errors within two deviations", inside / all);
        assert!(largest_m < 1.0, "{largest_m:.2} m after less than a minute says nothing");
    }
}

/// Times at which trust was lost, and why, in seconds after the take-off.
fn distrust(scenario: &str) -> Vec<(f64, Trust)> {
    let simulation = with(DroneConfig::default(), scenario);
    let mut distrusted = Vec::new();
    let mut took_off = None;
    simulation
        .fly_watched(plan(SQUARE), |moment| {
            if moment.truth.phase != Phase::Landed {
                let since: Duration = *took_off.get_or_insert(moment.now);
                let trust = moment.status.trust;
                if trust != Trust::Sound {
                    distrusted.push((moment.now.saturating_sub(since).as_secs_f64(), trust));
                }
            }
        })
        .unwrap();
    distrusted
}

#[test]
fn frozen_and_impossible_navdata_are_noticed_and_sound_ones_are_not() {
    // After this long a wrong velocity is not trusted again for four seconds.
    for (scenario, why, until_s) in [
        ("+6 freeze 1.5", Trust::Frozen(Quantity::Velocity), 7.0),
        ("+6 lie velocity 4 0 for 1.5", Trust::Implausible(Quantity::Velocity), 10.5),
        ("+6 lie velocity 20 0 for 1.5", Trust::Implausible(Quantity::Velocity), 10.5),
    ] {
        let distrusted = distrust(scenario);
        let (first_s, first) = distrusted.first().copied().unwrap_or_default();
        let (last_s, _) = distrusted.last().copied().unwrap_or_default();
        assert_eq!(first, why, "{scenario}");
        assert!((6.3..7.2).contains(&first_s), "{scenario}: {first_s}");
        assert!((until_s..until_s + 1.5).contains(&last_s), "{scenario}: {last_s}");
    }
    for scenario in ["", "+3 wind 1 1 gusts 0.5", "0 loss 20\n0 duplicate 20\n0 jitter 50"] {
        let scenario = scenario.replace("jitter", "delay 10 jitter");
        assert_eq!(distrust(&scenario), [], "{scenario}");
    }
}
