//! No stream of orders, however fast, leads further than the worst single one of them. `cargo xtask streams` is the same
//! with more of them.

use std::thread;

use system_tests::streams::bad;

/// First seeds of the threads; each flies as many, on all airframes.
const FIRST: [u64; 4] = [1, 17, 33, 49];
const STREAMS: u64 = 16;

/// A mission that is resumed at the fence, after sticks that led the reference far ahead of the drone.
const REFERENCE_AHEAD: u64 = 624;

#[test]
fn no_stream_of_orders_leads_further_than_a_single_order() {
    let threads = FIRST.map(|first| thread::spawn(move || bad(first..first + STREAMS).unwrap()));
    let mut found: Vec<String> =
        threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect();
    found.extend(bad([REFERENCE_AHEAD]).unwrap());
    assert!(found.is_empty(), "{} led too far:\n{}", found.len(), found.join("\n"));
}
