//! Drones in one simulated air: the wash below each, and the ultrasound of others.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::vehicle::{FlightEvent, Start, Ultrasound};
use nalgebra::Vector2;
use system_tests::fleet::{Air, Fleet, FleetFlight, Member, crossing};

const LIMIT: Duration = Duration::from_mins(3);
/// A separation that separates nobody.
const OFF_M: f64 = -1e3;

fn shared() -> Air {
    Air { is_shared: true, ..Air::default() }
}

fn member(x_m: f64, plan: String, seed: u64, ultrasound: Ultrasound) -> Member {
    let mut member: Member = crossing(1, 0.0, seed).members.remove(0);
    let place_m = Vector2::new(x_m, 0.0);
    member.start = Start { place_m, ..Start::default() };
    member.plan = plan;
    member.pilot.separation_m = OFF_M;
    member.pilot.ultrasound = Some(ultrasound);
    member
}

/// The second one flies under the first, waits there, and flies away.
fn one_under_the_other(below_m: f64, seed: u64) -> Fleet {
    let over = format!("takeoff\nsetStayTime 30\ngoto 0 0 {} 0\nland\n", 0.3 + below_m);
    let under = "takeoff\nsetStayTime 3\ngoto 3 0 0.3 0\nsetStayTime 6\ngoto 0 0 0.3 0\nsetStayTime 1\ngoto 3 0 0.3 0\nland\n";
    let members = vec![
        member(0.0, over, 2 * seed, Ultrasound::Slow),
        member(3.0, under.to_owned(), 2 * seed + 1, Ultrasound::Fast),
    ];
    Fleet { members, air: shared() }
}

/// The flight, and the lowest height of the second one, in truth, within 0.5 m of below the first and before its landing began.
fn flown_under(fleet: &Fleet) -> (FleetFlight, f64) {
    let mut heights = Vec::new();
    let flight = fleet.fly_watched(LIMIT, |now, places_m| {
        let [over, under] = places_m else { return };
        if (over - under).xy().norm() < 0.5 && over.z > under.z + 0.5 {
            heights.push((now, under.z));
        }
    });
    let flight = flight.unwrap();
    let events = &flight.members[1].events;
    let is_landing = |event: &FlightEvent| matches!(event, FlightEvent::LandingOrdered(_));
    let landing = events.iter().find(|(_, event)| is_landing(event)).map_or(LIMIT, |(at, _)| *at);
    let before = heights.iter().filter(|(at, _)| *at < landing).map(|(_, height_m)| *height_m);
    let lowest_m = before.fold(f64::INFINITY, f64::min);
    (flight, lowest_m)
}

#[test]
fn who_flies_under_another_vehicle_loses_height() {
    for below_m in [1.0, 1.5] {
        for seed in 0..4 {
            let mut fleet = one_under_the_other(below_m, seed);
            let (flight, lowest_m) = flown_under(&fleet);
            fleet.air.is_shared = false;
            let (calm, calm_m) = flown_under(&fleet);
            assert!(calm.is_complete() && flight.is_down, "{below_m} {seed}: {flight:?}");
            assert_eq!(flight.members[0].outcome, Some(Outcome::Completed));
            let lost_m = calm_m - lowest_m;
            assert!(lost_m > 0.1, "{below_m} {seed}: {lost_m}");
        }
    }
}

/// Two that hover so far beside each other.
fn side_by_side(apart_m: f64, ultrasound: [Ultrasound; 2], seed: u64) -> FleetFlight {
    let plan = |x_m: f64| format!("takeoff\nsetStayTime 20\ngoto {x_m} 0 0.5 0\nland\n");
    let members = [0.0, apart_m].into_iter().zip(ultrasound).zip(0..);
    let members = members.map(|((x_m, of), number)| member(x_m, plan(x_m), 2 * seed + number, of));
    Fleet { members: members.collect(), air: shared() }.fly(LIMIT).unwrap()
}

#[test]
fn ultrasound_of_the_same_frequency_nearby_disturbs_heights_and_all_come_down() {
    for seed in 0..4 {
        let same = side_by_side(2.0, [Ultrasound::Fast; 2], seed);
        assert!(same.is_down);
        for member in &same.members {
            assert!(member.reported_height_error_m > 0.5, "{seed}: {member:?}");
            assert!(member.height_error_m < 0.2, "{seed}: {member:?}");
        }
        for (apart_m, ultrasound) in
            [(2.0, [Ultrasound::Slow, Ultrasound::Fast]), (3.5, [Ultrasound::Fast; 2])]
        {
            let flight = side_by_side(apart_m, ultrasound, seed);
            assert!(flight.is_complete(), "{seed}: {flight:?}");
            for member in &flight.members {
                assert!(member.reported_height_error_m < 0.2, "{seed}: {member:?}");
            }
        }
    }
}
