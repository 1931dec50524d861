//! Mission agents of vehicles on two machines: they talk over a bad network.

use std::time::{Duration, Instant};

use nalgebra::Vector2;
use serde_json::Value;

use crate::flights::{Program, Room};
use crate::pilot::{Pilot, fleets};

/// By how much what a program has said may be read later than what another one has said after it. They wait for seconds.
const LATE: Duration = Duration::from_millis(250);
/// In the order of the file: the keeper, and those that it lets in.
const TRAVELLERS: [(usize, &str); 2] = [(1, "left"), (2, "right")];

/// Whether it is in the corridor, well behind where it waits and before where it comes out.
fn is_inside(place_m: Option<Vector2<f64>>) -> bool {
    place_m.is_some_and(|place_m| place_m.x.abs() < 1.0 && (-1.0..1.5).contains(&place_m.y))
}

/// Whoever comes first is let in, comes out, and says so before the other one is let in: also where the keeper flies with the
/// one, and the other one is behind a network that delays and loses packets.
#[test]
fn two_machines_pass_a_corridor_one_after_the_other() {
    let text = std::fs::read_to_string(fleets().join("corridor.toml")).unwrap();
    let programs: [Program<'_>; 2] = [(0, &["keeper", "left"]), (1, &["right"])];
    let Some(mut room) = Room::new(&text, programs) else { return };
    // In truth: how often each was inside, as the loop looked.
    let mut inside = [0; 2];
    room.watch(|room| {
        let places_m = room.places_m();
        let are_inside = TRAVELLERS.map(|(number, _)| is_inside(places_m[number]));
        assert_ne!(are_inside, [true; 2], "{places_m:?}");
        for (count, is_inside) in inside.iter_mut().zip(are_inside) {
            *count += usize::from(is_inside);
        }
        !room.pilots.iter_mut().any(Pilot::is_running)
    });
    assert!(inside.iter().all(|count| *count > 10), "each was there: {inside:?}");
    let said = room.pilots.each_ref().map(Pilot::said_at);
    // When somebody said something first; `None` if it did not in this program.
    let first = |program: usize, vehicle: &str, to: &str, text: &str| {
        let is_it = |(_, object): &&(Instant, Value)| {
            object["type"] == "message"
                && object["vehicle"] == vehicle
                && object["to"] == to
                && object["text"] == text
        };
        said[program].iter().find(is_it).map(|(at, _)| *at)
    };
    let of = |number: usize| {
        // Its own program, and the keeper's.
        let (_, name) = TRAVELLERS[number];
        let own = |text| first(number, name, "keeper", text);
        let waits = own("tell waiting").unwrap();
        let is_let_in = first(0, "keeper", name, "achieve enter").unwrap();
        let comes_out = own("untell waiting").unwrap();
        let is_through = own("tell through").unwrap();
        for [before, after] in [[waits, is_let_in], [is_let_in, comes_out], [comes_out, is_through]]
        {
            assert!(before <= after + LATE, "{name}");
        }
        assert!(is_through > is_let_in + Duration::from_secs(2), "{name} flew through");
        (is_let_in, is_through)
    };
    let mut both = [of(0), of(1)];
    both.sort_unstable();
    let [(_, first_is_through), (second_is_let_in, _)] = both;
    assert!(first_is_through <= second_is_let_in + LATE, "{both:?}");
    // Nobody says what is another one's to say.
    assert_eq!(
        (first(0, "right", "keeper", "tell waiting"), first(1, "keeper", "right", "achieve enter")),
        (None, None)
    );
    let (ended, nearest_m) = room.until_the_end();
    for (status, said) in &ended {
        assert_eq!(*status, Some(0), "{:?}", said.last());
    }
    assert!(nearest_m > 0.8, "{nearest_m}");
}
