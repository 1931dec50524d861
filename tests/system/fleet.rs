//! Vehicles in one room keep apart, whatever they are told to do and whatever becomes of their messages.

use std::time::Duration;

use autopilot::outcome::Outcome;
use autopilot::plan::Border;
use autopilot::vehicle::{FlightEvent, OperatorOrder, Place, Setpoint, Start, Veto};
use autopilot::vehicle::{Heading, Horizontal, Vertical};
use kinematics::Sticks;
use mock_drone::scenario::Scenario;
use nalgebra::Vector2;
use system_tests::fleet::{
    Falsehood, Fleet, FleetFlight, Lie, Member, NEAREST_M, Partition, crossing,
};
use system_tests::plan;

const LIMIT: Duration = Duration::from_mins(4);
/// A separation that separates nobody.
const OFF_M: f64 = -1e3;

fn flown(fleet: &Fleet) -> FleetFlight {
    fleet.fly(LIMIT).unwrap()
}

fn without_separation(mut fleet: Fleet) -> Fleet {
    fleet.members.iter_mut().for_each(|member| member.pilot.separation_m = OFF_M);
    fleet
}

#[test]
fn all_that_cross_one_point_arrive() {
    for count in 2..=6 {
        for seed in 0..8 {
            let flight = flown(&crossing(count, 3.0, seed));
            assert!(flight.keeps_apart() && flight.is_complete(), "{count} {seed}: {flight:?}");
            let duration_s = flight.duration().as_secs_f64();
            assert!(duration_s < 45.0, "{count} {seed}: {duration_s}");
        }
    }
    let met = (0..4)
        .filter(|seed| flown(&without_separation(crossing(2, 3.0, *seed))).nearest_m() < NEAREST_M);
    assert_eq!(met.count(), 4, "who is not kept apart meets");
}

#[test]
fn random_fleets_keep_apart_and_all_come_down() {
    let bad = (0..45).filter(|seed| !flown(&Fleet::random(*seed)).keeps_apart());
    assert_eq!(bad.collect::<Vec<u64>>(), Vec::<u64>::new());
    let met = (0..20)
        .filter(|seed| flown(&without_separation(Fleet::random(*seed))).nearest_m() < NEAREST_M);
    assert!(met.count() > 8, "who is not kept apart meets");
}

#[test]
fn the_same_fleet_flies_the_same_way_twice() {
    let fleet = Fleet::random(3);
    assert_eq!(flown(&fleet), flown(&fleet));
}

/// Two that hover 3 m apart; the first does as it is ordered after a while.
fn side_by_side(orders: Vec<(Duration, OperatorOrder)>) -> Fleet {
    let member = |x_m: f64, seed: u64| {
        let mut member: Member = crossing(1, 0.0, seed).members.remove(0);
        let place_m = Vector2::new(x_m, 0.0);
        member.start = Start { place_m, ..Start::default() };
        member.plan = format!("takeoff\nsetStayTime 25\ngoto {x_m} 0 0.5 0\nland\n");
        member
    };
    let mut first = member(0.0, 1);
    first.orders = orders;
    Fleet { members: vec![first, member(3.0, 2)], ..Fleet::default() }
}

/// Vehicles that fly from one place to another, and stay there for so long, in a fence that is so wide from the middle.
fn from_to(fence_m: [f64; 2], flights: &[([f64; 2], [f64; 2], u64)], seed: u64) -> Fleet {
    let [x_m, y_m] = fence_m;
    let border = Border::polygon(&[[-x_m, -y_m], [x_m, -y_m], [x_m, y_m], [-x_m, y_m]]).unwrap();
    let members = flights.iter().zip(0..).map(|((from_m, to_m, stay_s), number)| {
        let mut member = crossing(1, 0.0, 10 * seed + number).members.remove(0);
        member.start.place_m = (*from_m).into();
        let [x_m, y_m] = to_m;
        member.plan = format!("takeoff\nsetStayTime {stay_s}\ngoto {x_m} {y_m} 0.5 0\nland\n");
        member.pilot.limits.border = border;
        member
    });
    Fleet { members: members.collect(), ..Fleet::default() }
}

/// Who hovers beside a wall is passed on the other side; two that meet in a corridor pass each other though one is nearer to
/// the wall on its right; one that hovers in the middle of a corridor makes way, and comes back.
#[test]
fn all_arrive_where_there_is_room_to_pass() {
    let walls = [[5.0, 3.0], [5.0, 4.5], [5.0, 1.8], [5.0, 2.2]];
    let flights = [
        [([-4.0, -2.5], [4.0, -2.5], 1), ([0.0, -2.5], [0.0, -2.5], 60)],
        [([-1.1, 0.7], [2.2, 0.7], 1), ([0.4, -2.6], [-4.0, 3.7], 1)],
        [([-4.0, 0.0], [4.0, 0.0], 1), ([4.0, 0.0], [-4.0, 0.0], 1)],
        [([-4.0, 0.0], [4.0, 0.0], 1), ([0.5, 0.0], [0.5, 0.0], 40)],
    ];
    for (fence_m, flights) in walls.into_iter().zip(&flights) {
        for seed in 0..3 {
            let flight = flown(&from_to(fence_m, flights, seed));
            assert!(flight.keeps_apart() && flight.is_complete(), "{fence_m:?} {seed}: {flight:?}");
        }
    }
}

/// Two that stand a metre apart: the one flies nowhere, and the other not beside it.
#[test]
fn nobody_takes_off_beside_one_that_stands_there() {
    let still = |x_m| ([x_m, 0.0], [x_m, 0.0], 2);
    let flight = flown(&from_to([5.0, 5.0], &[still(0.0), still(1.0)], 1));
    for (member, other) in flight.members.iter().zip([2, 1]) {
        let reason = format!("vehicle {other} is 1.0 m away: move one of the two first");
        let refused = Outcome::PreflightRefused { reasons: vec![reason] };
        assert_eq!(member.outcome, Some(refused));
    }
    assert!(flown(&from_to([5.0, 5.0], &[still(0.0), still(1.7)], 1)).is_complete());
}

/// It lands beside one that stands there, as a plan may tell it to, and does not lift off there again.
#[test]
fn a_plan_takes_off_beside_nobody_who_stands_there_either() {
    let mut fleet =
        from_to([6.0, 6.0], &[([-2.5, 0.0], [0.0; 2], 0), ([2.5, 0.0], [1.0, 0.0], 0)], 1);
    fleet.members[0].plan =
        "takeoff\nsetStayTime 12\ngoto -2.5 0 0.5 0\nsetStayTime 0\ngoto 0.6 0 0.5 0\nland\n\
         takeoff\ngoto -2.5 0 0.5 0\nland\n"
            .to_owned();
    let mut landed_at = None;
    let mut highest_m = 0.0_f64;
    let flight = fleet
        .fly_watched(LIMIT, |now, places_m| {
            let [first_m, second_m] = places_m else { return };
            let is_beside = (first_m - second_m).xy().norm() < 1.0;
            if is_beside && first_m.z < 0.01 && second_m.z < 0.01 {
                landed_at.get_or_insert(now);
            }
            if landed_at.is_some() {
                highest_m = highest_m.max(first_m.z);
            }
        })
        .unwrap();
    assert!(landed_at.is_some() && highest_m < 0.05, "{landed_at:?} {highest_m} {flight:?}");
    assert!(vetoed(&flight, 0, Veto::KeepsApart), "{flight:?}");
    let reason = "another vehicle was in the way for too long".to_owned();
    assert_eq!(flight.members[0].outcome, Some(Outcome::Failsafe { reason }), "{flight:?}");
    assert!(flight.members[1].is_complete(), "{flight:?}");
}

/// The first shuttles past the second one, which takes off for another flight at any moment of that. Each hears the other a second
/// late.
#[test]
fn who_takes_off_has_told_those_that_come_past() {
    let legs = "goto 5 0.2 0.5 0\ngoto -5 0.2 0.5 0\n".repeat(6);
    let to_and_fro = format!("setSpeed 2.2\nsetStayTime 0.5\ntakeoff\n{legs}land\n");
    let mut took_off = 0;
    for tenths in 200..300 {
        let fence_m = [9.0, 9.0];
        let mut fleet = from_to(fence_m, &[([-5.0, 3.5], [0.0; 2], 0), ([0.0; 2], [0.0; 2], 0)], 1);
        fleet.members[0].plan.clone_from(&to_and_fro);
        fleet.members[1].plan = "takeoff\nland\n".to_owned();
        let again = plan("takeoff\nsetStayTime 8\ngoto 0 0 0.5 0\nland\n");
        let start = OperatorOrder::Start { when_ready: true };
        let at = Duration::from_millis(100 * tenths);
        fleet.members[1].orders = vec![(at, OperatorOrder::Load(again)), (at, start)];
        fleet.air.delay = Duration::from_secs(1);
        let flight = flown(&fleet);
        assert!(flight.nearest_m() > 1.5 && flight.is_down, "{tenths}: {flight:?}");
        // The others were refused: the first one was just coming past.
        took_off += usize::from(flight.members[1].ended > at);
    }
    assert!(took_off > 10, "{took_off}");
}

/// The one keeps 0.8 m from others, the other 3 m: neither goes nearer than that, though only one of them wants so much.
#[test]
fn two_with_different_separations_keep_the_larger_one() {
    let nearer = OperatorOrder::GoTo(Place::at(1.8, 0.0));
    let mut fleet = side_by_side(vec![(Duration::from_secs(10), nearer)]);
    fleet.members[1].start.place_m.x = 3.6;
    fleet.members[1].plan = "takeoff\nsetStayTime 20\ngoto 3.6 0 0.5 0\nland\n".to_owned();
    fleet.members[0].pilot.separation_m = 0.8;
    fleet.members[1].pilot.separation_m = 3.0;
    let flight = flown(&fleet);
    let is_crowded = [0, 1].map(|number| vetoed(&flight, number, Veto::Crowded));
    assert!(is_crowded == [false; 2] && flight.nearest_m() > 3.0, "{flight:?}");
}

/// The first one tells a place that is off by this.
fn from_the_tenth_second(off_m: Vector2<f64>) -> Lie {
    Lie { who: 0, since: Duration::from_secs(10), what: Falsehood::Place(off_m) }
}

/// A tag that is seen again may move what a vehicle believes of its place by so much.
#[test]
fn a_step_of_a_metre_in_what_one_tells_lands_nobody() {
    let still = |x_m| ([x_m, 0.0], [x_m, 0.0], 20);
    let mut fleet = from_to([9.0, 5.0], &[still(-3.5), still(0.0), still(3.5)], 1);
    fleet.air.lie = Some(from_the_tenth_second(Vector2::new(1.0, 0.0)));
    let flight = flown(&fleet);
    assert!(flight.keeps_apart() && flight.is_complete(), "{flight:?}");
}

/// Orders from the tenth second on, every tenth of a second for so long, and then to go on.
fn repeated(order: &OperatorOrder, time_s: u64) -> Vec<(Duration, OperatorOrder)> {
    let at = |tenths: u64| Duration::from_millis(10_000 + 100 * tenths);
    let orders = (0..10 * time_s).map(|tenths| (at(tenths), order.clone()));
    orders.chain([(at(10 * time_s + 10), OperatorOrder::Resume)]).collect()
}

fn vetoed(flight: &FleetFlight, number: usize, veto: Veto) -> bool {
    let events = &flight.members[number].events;
    events.iter().any(|(_, event)| *event == FlightEvent::Veto(veto))
}

#[test]
fn sticks_that_are_held_towards_another_vehicle_do_not_reach_it() {
    for roll in [0.3, 1.0] {
        let sticks = OperatorOrder::Steer(Sticks { roll, ..Sticks::default() });
        let fleet = side_by_side(repeated(&sticks, 10));
        let flight = flown(&fleet);
        assert!(flight.keeps_apart(), "{roll}: {flight:?}");
        assert!(vetoed(&flight, 0, Veto::KeepsApart), "{roll}: {flight:?}");
        assert!(flown(&without_separation(fleet)).nearest_m() < NEAREST_M, "{roll}");
    }
}

#[test]
fn set_points_that_lead_through_another_vehicle_lead_past_it() {
    for horizontal in
        [Horizontal::Place { x_m: 6.0, y_m: 0.0 }, Horizontal::Velocity { x_m_s: 1.0, y_m_s: 0.0 }]
    {
        let setpoint =
            Setpoint { horizontal, vertical: Vertical::Climb(0.0), heading: Heading::Keep };
        let mut orders = repeated(&OperatorOrder::Setpoint(setpoint), 10);
        orders[0].1 = OperatorOrder::Follow(setpoint);
        let fleet = side_by_side(orders);
        let flight = flown(&fleet);
        assert!(flight.keeps_apart(), "{horizontal:?}: {flight:?}");
        assert!(flown(&without_separation(fleet)).nearest_m() < NEAREST_M, "{horizontal:?}");
    }
}

/// Whoever is not heard may be anywhere: those that are near to where it was land, and others do not.
#[test]
fn a_silence_lands_those_that_cannot_be_kept_apart() {
    let silence = |from_s, time_s| {
        let mut fleet = side_by_side(Vec::new());
        fleet.air.silent = Some([from_s, from_s + time_s].map(Duration::from_secs));
        flown(&fleet)
    };
    let flight = silence(12, 8);
    assert!(flight.keeps_apart(), "{flight:?}");
    for member in &flight.members {
        let reason = "another vehicle was too near, or silent".to_owned();
        assert_eq!(member.outcome, Some(Outcome::Failsafe { reason }));
    }
    assert!(silence(12, 1).is_complete(), "a short one is no danger");
}

/// One falls silent, as if its program was killed. It may have come 3 m nearer in each second, wherever it is in truth: the
/// others fly on until it can have come to them, however far that is.
#[test]
fn a_silence_lands_others_when_who_is_silent_can_have_come_to_them() {
    let hovers = |x_m, y_m, stay_s| ([x_m, y_m], [x_m, y_m], stay_s);
    let flights =
        [hovers(-9.0, 0.0, 60), hovers(0.0, 0.0, 60), hovers(9.0, 0.0, 60), hovers(9.0, 4.0, 4)];
    let mut fleet = from_to([100.0, 100.0], &flights, 1);
    let silent_s = 9_u32;
    let cut =
        |by| Partition { of: 0, by, at: [Duration::from_secs(silent_s.into()), Duration::MAX] };
    fleet.air.partitions = (1..4).map(cut).collect();
    let flight = flown(&fleet);
    let [silent, near, far, ends] = &flight.members[..] else { panic!("{flight:?}") };
    assert!(flight.keeps_apart() && silent.is_complete(), "{flight:?}");
    for (member, away_m) in [(near, 9.0), (far, 18.0)] {
        let reason = "another vehicle was too near, or silent".to_owned();
        assert_eq!(member.outcome, Some(Outcome::Failsafe { reason }));
        let lands =
            |(_, event): &&(Duration, FlightEvent)| *event == FlightEvent::Veto(Veto::Crowded);
        let after_s =
            member.events.iter().find(lands).unwrap().0.as_secs_f64() - f64::from(silent_s);
        let reached_s = away_m / 3.0;
        assert!((reached_s..reached_s + 2.0).contains(&after_s), "{away_m}: {after_s}");
    }
    assert!(ends.is_complete(), "its plan ends before: {ends:?}");
}

/// Whoever tells that it is where it cannot have got to is avoided where it may be.
#[test]
fn a_vehicle_that_lies_of_its_place_is_not_believed() {
    let sticks = OperatorOrder::Steer(Sticks { roll: 0.4, ..Sticks::default() });
    let mut fleet = side_by_side(repeated(&sticks, 10));
    fleet.air.lie = Some(from_the_tenth_second(Vector2::new(-6.0, 0.0)));
    let flight = flown(&fleet);
    assert!(flight.is_down && vetoed(&flight, 1, Veto::Crowded), "{flight:?}");
}

/// By what it tells the first one is behind the second one. A way back from there leads to where it truly is.
#[test]
fn nobody_goes_back_from_one_that_may_be_anywhere() {
    let still = |x_m| ([x_m, 0.0], [x_m, 0.0], 20);
    let mut fleet = from_to([9.0, 9.0], &[still(-1.0), still(1.0)], 1);
    fleet.air.lie = Some(from_the_tenth_second(Vector2::new(7.0, 0.0)));
    let flight = flown(&fleet);
    assert!(flight.is_down && vetoed(&flight, 1, Veto::Crowded), "{flight:?}");
    assert!(flight.nearest_m() > 1.8, "{flight:?}");
    for seed in [2911, 10_227] {
        let flight = flown(&Fleet::random(seed));
        assert!(flight.keeps_apart(), "{seed}: {flight:?}");
    }
}

/// Without knowing where the others are nobody takes off.
#[test]
fn nobody_takes_off_who_does_not_hear_the_others() {
    let mut fleet = side_by_side(Vec::new());
    fleet.air.silent = Some([Duration::ZERO, Duration::from_secs(40)]);
    let flight = flown(&fleet);
    for (member, other) in flight.members.iter().zip([2, 1]) {
        let reason = format!(
            "vehicle {other} in the same room is not heard: switch its drone on and start its pilot, or leave it out"
        );
        let refused = Outcome::PreflightRefused { reasons: vec![reason] };
        assert_eq!(member.outcome, Some(refused));
    }
}

/// The second flight starts where the first one has landed, 4 m from the surveyed start, and turned.
#[test]
fn targets_are_places_in_the_common_frame_also_in_the_next_flight() {
    let mut fleet = crossing(1, 2.0, 5);
    fleet.members[0].start.heading_deg = 90.0;
    fleet.members[0].plan = "takeoff\ngoto 0 2 0.5 45\nland\n".to_owned();
    let there_m = flown(&fleet).places_m[0].xy();
    assert!((there_m - Vector2::new(0.0, 2.0)).norm() < 0.5, "{there_m}");
    let back = plan("takeoff\ngoto -1.5 0 0.5 0\nland\n");
    let start = OperatorOrder::Start { when_ready: true };
    fleet.members[0].orders = [(30, OperatorOrder::Load(back)), (31, start)]
        .map(|(s, order)| (Duration::from_secs(s), order))
        .to_vec();
    let there_m = flown(&fleet).places_m[0].xy();
    assert!((there_m - Vector2::new(-1.5, 0.0)).norm() < 0.7, "{there_m}");
}

/// A battery is changed between two flights: the drone, which lies turned, begins with a new compass.
#[test]
fn a_drone_that_restarts_on_the_ground_stands_as_it_landed() {
    let mut member = side_by_side(Vec::new()).members.remove(0);
    member.start = Start { place_m: Vector2::new(-3.0, 0.0), ..Start::default() };
    member.plan = "takeoff\ngoto -3 0 0 180\nland\n".to_owned();
    member.world.scenario = Scenario::parse("restart", "+25 restart\n").unwrap();
    let again = plan("takeoff\ngoto -3 2 0 180\nland\n");
    let at = Duration::from_secs;
    member.orders = vec![
        (at(45), OperatorOrder::Load(again)),
        (at(46), OperatorOrder::Start { when_ready: true }),
        // Until then it flies.
        (at(90), OperatorOrder::Clear),
    ];
    let flight = flown(&Fleet { members: vec![member], ..Fleet::default() });
    let place_m = flight.places_m[0].xy();
    assert!((place_m - Vector2::new(-3.0, 2.0)).norm() < 0.5, "{place_m}");
}
