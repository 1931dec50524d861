//! Fleets whose messages are cut, late, old or false, and fleets of up to twenty that fly the same way twice.

use std::time::Duration;

use nalgebra::Vector2;
use system_tests::fleet::{
    Air, Falsehood, Fleet, FleetFlight, Lie, NEAREST_M, Partition, corridor, crossing, liar,
    take_off,
};

const LIMIT: Duration = Duration::from_mins(4);

fn flown(fleet: &Fleet) -> FleetFlight {
    fleet.fly(LIMIT).unwrap()
}

fn seconds(from: u64, to: u64) -> [Duration; 2] {
    [from, to].map(Duration::from_secs)
}

/// The hash is that of all datagrams with their times.
#[test]
fn two_five_and_twenty_vehicles_send_the_same_datagrams_twice() {
    for (count, radius_m) in [(2, 3.0), (5, 3.0), (20, 9.0)] {
        let sent = |seed| {
            let mut fleet = crossing(count, radius_m, seed);
            let jitter = Duration::from_millis(100);
            fleet.air = Air { loss: 0.1, jitter, seed, is_shared: true, ..Air::default() };
            fleet.fly(Duration::from_secs(20)).unwrap().datagrams
        };
        let first = sent(1);
        assert_eq!(sent(1), first, "{count}");
        assert_ne!(sent(2), first, "{count}");
    }
}

/// While they cross: of the two the one that hears makes room, or both land.
#[test]
fn two_of_which_one_does_not_hear_the_other_or_neither_does_keep_apart() {
    let at = seconds(7, 30);
    let cuts = [[0, 1], [1, 0]].map(|[of, by]| Partition { of, by, at });
    for partitions in [&cuts[..1], &cuts[1..], &cuts[..]] {
        for seed in 0..4 {
            let mut fleet = crossing(2, 3.0, seed);
            fleet.air.partitions = partitions.to_vec();
            let flight = flown(&fleet);
            assert!(flight.keeps_apart(), "{partitions:?} {seed}: {flight:?}");
            assert!(!flight.is_complete(), "who does not hear goes nowhere: {partitions:?} {seed}");
        }
    }
}

fn told(what: Falsehood, seed: u64) -> FleetFlight {
    let mut fleet = crossing(2, 3.0, seed);
    fleet.air.lie = Some(Lie { who: 0, since: Duration::from_secs(7), what });
    flown(&fleet)
}

#[test]
fn what_cannot_be_so_brings_nobody_too_near() {
    let left_m = Vector2::new(-5.0, 0.0);
    for what in [
        Falsehood::Place(left_m),
        Falsehood::Jumps(4.0),
        Falsehood::Velocity(left_m),
        Falsehood::Repeats,
    ] {
        for seed in 0..4 {
            let flight = told(what, seed);
            let least = flight.least;
            assert!(flight.keeps_apart() && least.astray.is_none(), "{what:?} {seed}: {least:?}");
        }
    }
}

/// Who says that it still stands where it was, or drifts away slowly, is believed: whom it meets so is told apart, and nobody who
/// is too near by what is told is excused.
#[test]
fn a_place_that_may_be_so_is_believed() {
    let away_m_s = Vector2::new(0.8, 0.0);
    let mut astray = 0;
    for what in [Falsehood::Creeps(away_m_s), Falsehood::Stale] {
        for seed in 0..4 {
            let flight = told(what, seed);
            assert!(flight.keeps_apart(), "{what:?} {seed}: {:?}", flight.least);
            astray += usize::from(flight.least.astray.is_some());
        }
    }
    assert!(astray < 8, "{astray}");
}

#[test]
fn all_arrive_that_meet_in_a_corridor_or_as_they_take_off() {
    for seed in 0..4 {
        for fleet in [corridor(seed), take_off(seed)] {
            let flight = flown(&fleet);
            assert!(flight.keeps_apart() && flight.is_complete(), "{seed}: {flight:?}");
        }
    }
}

/// It hovers in the way of another one, keeps away from nobody, and tells that it is elsewhere.
#[test]
fn nobody_believes_that_its_way_is_free_when_who_was_there_cannot_have_got_away() {
    for seed in 0..4 {
        let flight = flown(&liar(seed));
        assert!(flight.keeps_apart() && !flight.members[0].is_complete(), "{seed}: {flight:?}");
    }
}

/// Somebody else's program flies one of them through the places of the others, and tells where it is.
#[test]
fn one_that_keeps_away_from_nobody_is_avoided_where_its_place_is_told() {
    for seed in 0..4 {
        let mut fleet = crossing(3, 3.0, seed);
        fleet.members[0].is_foreign = true;
        fleet.members[0].plan.insert_str(0, "setMaxControl 0.5\n");
        let flight = flown(&fleet);
        assert!(flight.keeps_apart(), "{seed}: {flight:?}");
        assert!(flight.members[0].is_complete(), "{seed}: it goes its way");
        fleet.members.iter_mut().for_each(|member| member.is_foreign = true);
        assert!(flown(&fleet).nearest_m() < NEAREST_M, "{seed}: nobody hears anybody");
    }
}
