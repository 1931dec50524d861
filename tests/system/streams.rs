//! No stream of orders, however fast, leads further than the worst single one of them. `cargo xtask streams` is the same
//! with more of them.

use std::thread;

use system_tests::streams::bad;

/// First seeds of the threads; each flies as many, on all airframes.
const FIRST: [u64; 4] = [1, 17, 33, 49];
const STREAMS: u64 = 16;

/// Each leads too far without one rule: a reference that begins anew when the drone is told to stay elsewhere, and the drag in
/// the braking of setpoints of rest.
const LED_TOO_FAR: [u64; 2] = [1142, 1070];

#[test]
fn no_stream_of_orders_leads_further_than_a_single_order() {
    let threads = FIRST.map(|first| thread::spawn(move || bad(first..first + STREAMS).unwrap()));
    let mut found: Vec<String> =
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect();
    found.extend(bad(LED_TOO_FAR).unwrap());
    assert!(found.is_empty(), "{} led too far:\n{}", found.len(), found.join("\n"));
}
