//! How long a state is under way: a measurement, not a test of a limit. The numbers of docs/fleet.md are from here:
//! `cargo test -p ardrone-pilot --features zenoh --test network -- --ignored --nocapture how_long`

use std::io::{BufRead as _, BufReader};
use std::process::{Command, Stdio};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use zenoh::Wait as _;
use zenoh::qos::CongestionControl;

use crate::lab::{ADDRESSES, Lab};
use crate::pilot::zenoh;

/// States that are sent, and their interval; 0 is as fast as it goes.
const COUNT: u32 = 600;
const INTERVAL: Duration = Duration::from_millis(50);
const FAST: u32 = 100_000;
const KEY: &str = "ardrone/measured/one/state";
/// A state has about so many bytes.
const BYTES: usize = 500;

/// Of the machine, so that two processes share it.
fn clock_us() -> u64 {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    u64::try_from(now.as_micros()).unwrap()
}

/// What another process is to do: `sends CONFIG COUNT`, `hears CONFIG`.
const TASK: &str = "ARDRONE_MEASURES";

/// Not for itself: the measurement starts this program again, on each of the machines.
#[test]
#[ignore = "a part of how_long_a_state_is_under_way"]
fn one_end() {
    let Some(task) = std::env::var(TASK).ok() else { return };
    let (task, config) = task.split_once(' ').unwrap();
    let session = zenoh::open(zenoh::Config::from_json5(config).unwrap()).wait().unwrap();
    if task == "hears" {
        let heard = session.declare_subscriber(KEY).wait().unwrap();
        let mut ways_us = Vec::new();
        while let Ok(Some(sample)) = heard.recv_timeout(Duration::from_secs(8)) {
            let now_us = clock_us();
            let text = sample.payload().try_to_string().unwrap().into_owned();
            let sent_us: u64 = text.trim_end().parse().unwrap();
            ways_us.push((now_us - sent_us, now_us));
        }
        let time_s = match (ways_us.first(), ways_us.last()) {
            (Some((_, first)), Some((_, last))) => (last - first) as f64 / 1e6,
            _ => 0.0,
        };
        let count = ways_us.len();
        let mut ways_us: Vec<u64> = ways_us.into_iter().map(|(way_us, _)| way_us).collect();
        ways_us.sort_unstable();
        let at = |thousandths: usize| {
            let index = (count * thousandths / 1000).min(count.saturating_sub(1));
            ways_us.get(index).map_or(f64::NAN, |us| *us as f64 / 1000.0)
        };
        let (median, p99, most) = (at(500), at(990), at(1000));
        println!(
            "ways: {count} heard in {time_s:.1} s, median {median:.2} ms, p99 {p99:.2} ms, at most {most:.1} ms"
        );
    } else {
        let count: u32 = task.parse().unwrap();
        std::thread::sleep(Duration::from_secs(3));
        let publisher = session.declare_publisher(KEY).congestion_control(CongestionControl::Drop);
        let publisher = publisher.express(true).wait().unwrap();
        for _ in 0..count {
            publisher.put(format!("{:<BYTES$}", clock_us())).wait().unwrap();
            if count == COUNT {
                std::thread::sleep(INTERVAL);
            }
        }
        std::thread::sleep(Duration::from_secs(6));
    }
}

fn measure(what: &str, lab: Option<&Lab>, count: u32) {
    let addresses = if lab.is_some() { ADDRESSES } else { ["127.0.0.1"; 2] };
    let at = format!("tcp/{}:7448", addresses[0]);
    let configs = [zenoh(&at, None), zenoh(&format!("tcp/{}:0", addresses[1]), Some(&at))];
    let this = std::env::current_exe().unwrap();
    let start = |end: usize, task: &str| {
        let mut command = lab.map_or_else(|| Command::new(&this), |lab| lab.command(end, &this));
        command.args(["--ignored", "--nocapture", "--exact", "latency::one_end"]);
        let config = &configs[end];
        command.env(TASK, format!("{task} {config}")).stdout(Stdio::piped()).spawn().unwrap()
    };
    let mut hears = start(0, "hears");
    let mut sends = start(1, &count.to_string());
    let lines = BufReader::new(hears.stdout.take().unwrap()).lines().map_while(Result::ok);
    let result = lines.filter_map(|line| Some(line.split_once("ways: ")?.1.to_owned())).last();
    sends.wait().unwrap();
    hears.wait().unwrap();
    println!("{what}, {count} sent: {}", result.unwrap());
}

#[test]
#[ignore = "it measures for some minutes"]
fn how_long_a_state_is_under_way() {
    measure("loopback", None, COUNT);
    measure("loopback, as fast as it goes", None, FAST);
    let Some(mut lab) = Lab::new() else { return };
    lab.wire(50, 0.1);
    measure("50 ms and 10 % lost each way", Some(&lab), COUNT);
}
