//! Duration and allocations of decoding: `cargo bench -p ardrone-link`.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a benchmark reads the clock, prints, and ends where it cannot go on"
)]

use std::hint::black_box;
use std::time::Instant;

use ardrone_link::at::{Command, Datagram, Fraction, Motion, Ref};
use ardrone_link::navdata::{Navdata, Packet};

const DEMO: &[u8] = include_bytes!("../../tests/fixtures/uav_demo_inflight534mm.bin");
const FULL: &[u8] = include_bytes!("../../tests/fixtures/full_2012.bin");

fn main() {
    measure("demo packet, 500 bytes", || {
        _ = black_box(Navdata::decode(black_box(DEMO)));
    });
    measure("full packet, 1916 bytes, checked", || {
        _ = black_box(Packet::decode(black_box(FULL)));
    });
    measure("full packet, all 28 options read", || {
        for option in Packet::decode(black_box(FULL)).unwrap().options() {
            black_box(&option);
        }
    });
    let mut datagram = Datagram::new();
    let stick = Fraction::saturating(0.25);
    let motion = Motion::Progressive { roll: stick, pitch: stick, gaz: stick, yaw: stick };
    measure("REF and PCMD written", || {
        datagram.clear();
        datagram.push(1, &Command::Ref(Ref::TakeOff)).unwrap();
        datagram.push(2, &Command::Pcmd(black_box(motion))).unwrap();
        black_box(datagram.as_bytes());
    });
}

/// The median of many short runs.
fn measure(name: &str, mut once: impl FnMut()) {
    const RUNS: usize = 501;
    const REPETITIONS: u32 = 1000;
    let mut nanoseconds: Vec<f64> = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..REPETITIONS {
                once();
            }
            start.elapsed().as_secs_f64() * 1e9 / f64::from(REPETITIONS)
        })
        .collect();
    nanoseconds.sort_by(f64::total_cmp);
    let allocations = allocation_counter::measure(&mut once).count_total;
    println!("{name:<34}{:>8.1} ns  {allocations} allocations", nanoseconds[RUNS / 2]);
}
