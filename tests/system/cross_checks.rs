//! Tags and GPS never contradict a place that is right. `cargo xtask cross-checks` is the same with more flights, and with
//! places that are wrong.

use std::thread;

use system_tests::cross_checks::{Knows, Wrong, fly};

/// Flights of each thread.
const FLIGHTS: u64 = 15;

#[test]
fn no_right_place_is_contradicted() {
    let threads = [(Knows::Tags, 1), (Knows::Tags, 101), (Knows::Gps, 1), (Knows::Gps, 101)].map(
        |(knows, first)| {
            thread::spawn(move || {
                let seeds = first..first + FLIGHTS;
                seeds.map(|seed| fly(Wrong::Nothing, knows, seed).unwrap()).collect::<Vec<_>>()
            })
        },
    );
    let mut off_m: f64 = 0.0;
    for told in threads.into_iter().flat_map(|thread| thread.join().unwrap()) {
        assert!(!told.contradicted, "{told:?}");
        off_m = off_m.max(told.off_m);
    }
    assert!(off_m > 0.0, "they flew");
}
