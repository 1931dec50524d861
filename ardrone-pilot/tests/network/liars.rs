//! A client of Zenoh that publishes what is not so.

use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use ardrone_pilot::network::{Peers, Session};
use autopilot::separation::Neighbour;
use nalgebra::Vector2;
use serde_json::{Value, json};
use zenoh::Wait as _;

use crate::bridges::{roster, stands};
use crate::flights::own_address;
use crate::pilot::{Pilot, fleets, has_told, program, refused, zenoh};

const LEFT: &str = "ardrone/two/left/state";
const RIGHT: &str = "ardrone/two/right/state";

/// The program that flies the left vehicle, and a session that reaches it.
fn left() -> (Pilot, zenoh::Session, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let net = folder.path().join("net.json5");
    let at = format!("tcp/{}", own_address());
    std::fs::write(&net, zenoh(&at, None)).unwrap();
    let mut command = Command::new(program());
    command.arg("fleet").arg(fleets().join("two.toml")).args(["--mock", "--json", "--no-log"]);
    let pilot = Pilot::start(command.args(["--vehicle", "left", "--net"]).arg(&net));
    let config =
        zenoh::Config::from_json5(&zenoh(&format!("tcp/{}", own_address()), Some(&at))).unwrap();
    (pilot, zenoh::open(config).wait().unwrap(), folder)
}

/// Lies twenty times a second while it may: what it sends needs no answer of the one that it lies to.
fn lie(session: &zenoh::Session, until: &AtomicBool) {
    // By the digest of the real fleet: it has read the same file.
    let mut foreign = Peers::new(roster("right"), Session(0xbad));
    let mut own = Peers::new(roster("left"), Session(0xbad0));
    let start = Instant::now();
    let mut turn = 0_usize;
    while !until.load(Ordering::Relaxed) {
        let now = start.elapsed();
        // Just in front of the left one.
        let place_m = Vector2::new(-1.0, 0.0);
        let near = |system| Neighbour { at: now, place_m, ..stands(system) };
        // Well-formed, and of a program that has never heard the left one.
        let text = foreign.tell(now, 1, near(2), false).unwrap();
        let changed = |key: &str, value: Value| {
            let mut object: Value = serde_json::from_str(&text).unwrap();
            object[key] = value;
            object.to_string()
        };
        let strange = changed("session", json!(format!("{turn:016x}")));
        for (key, text) in [
            (RIGHT, text.clone()),
            (RIGHT, strange),
            (RIGHT, changed("version", json!(0))),
            (RIGHT, changed("fleet", json!("0123456789abcdef"))),
            (RIGHT, changed("place_m", json!([1e30, 0]))),
            (
                RIGHT,
                changed(
                    "heard",
                    json!([{ "session": "0000000000000bad", "sent_us": 1, "held_us": 1 }]),
                ),
            ),
            (RIGHT, text.clone() + &" ".repeat(2000)),
            (RIGHT, "x".repeat(1_000_000)),
            (RIGHT, "\u{0}\u{1b}[2J".to_owned()),
            (LEFT, own.tell(now, 0, near(1), false).unwrap()),
            (LEFT, text.clone()),
            ("ardrone/two/middle/state", text.clone()),
            ("ardrone/two/right/agent/left", "\u{7}".to_owned()),
        ] {
            session.put(key, text).wait().unwrap();
        }
        turn += 1;
        std::thread::sleep(Duration::from_millis(50));
    }
}

const CAUGHT: [&str; 7] =
    ["version", "other_fleet", "absurd", "too_long", "malformed", "flown_here", "unknown"];

/// If any of it were believed, the left one would take off: it only waits for the right one.
#[test]
fn nothing_that_a_liar_tells_is_believed() {
    let (pilot, session, _folder) = left();
    let until = Arc::new(AtomicBool::new(false));
    let lies = Arc::clone(&until);
    let liar = std::thread::spawn(move || lie(&session, &lies));
    let (status, said) = pilot.end();
    until.store(true, Ordering::Relaxed);
    liar.join().unwrap();
    assert_eq!(status, Some(30), "{:?}", said.last());
    let end = said.iter().find(|object| object["type"] == "end").unwrap();
    assert!(end["outcome"].as_str().unwrap().contains("vehicle 2"), "{end}");
    assert_eq!(said.last().unwrap()["network"]["heard"], 0, "{:?}", said.last());
    for why in CAUGHT {
        assert!(refused(&said, why) > 20, "{why}: {:?}", said.last());
        let told = said.iter().filter(|object| {
            object["type"] == "network" && object["refused"] == why && object["warning"] == true
        });
        // Once of each vehicle, and of none.
        assert!((1..=3).contains(&told.count()), "{why}");
    }
    assert!(refused(&said, "unanswered") > 20 && !has_told(&said, "refused", &json!("unanswered")));
}

/// The same with an honest program, written here by the documentation, which is believed in all that noise.
#[test]
fn a_liar_does_not_drown_who_tells_the_truth() {
    let (pilot, session, _folder) = left();
    let until = Arc::new(AtomicBool::new(false));
    let (lies, liar_session) = (Arc::clone(&until), session.clone());
    let liar = std::thread::spawn(move || lie(&liar_session, &lies));
    let heard = session.declare_subscriber(LEFT).wait().unwrap();
    let (told, truth_session) = (Arc::clone(&until), session.clone());
    let truth = std::thread::spawn(move || {
        let start = Instant::now();
        let us = || u64::try_from(start.elapsed().as_micros()).unwrap();
        // Of the left one's program: session, its newest stamp, and when that came.
        let mut newest: Option<(String, u64, u64)> = None;
        while !told.load(Ordering::Relaxed) {
            while let Ok(Some(sample)) = heard.try_recv() {
                let text = sample.payload().to_bytes();
                let Ok(state) = serde_json::from_slice::<Value>(&text) else { continue };
                // The liar's are of a session that is known here.
                if state["session"] != "000000000000bad0" && state["vehicle"] == "left" {
                    let session = state["session"].as_str().unwrap().to_owned();
                    newest = Some((session, state["sent_us"].as_u64().unwrap(), us()));
                }
            }
            let now_us = us();
            let heard = newest.iter().map(|(session, sent_us, at_us)| {
                json!({ "session": session, "sent_us": sent_us, "held_us": now_us - at_us })
            });
            let state = json!({
                "version": 1,
                "fleet": "aa010c2e795a3b31",
                "session": "00000000000600d0",
                "vehicle": "right",
                "system": 2,
                "sent_us": now_us,
                "measured_us": now_us,
                "place_m": [2.5, 3.0],
                "velocity_m_s": [0, 0],
                "uncertainty_m": 0.05,
                "separation_m": 1.5,
                "presence": "stands",
                "claim": null,
                "parked": false,
                "heard": heard.collect::<Vec<_>>(),
            });
            truth_session.put(RIGHT, state.to_string()).express(true).wait().unwrap();
            std::thread::sleep(Duration::from_millis(50));
        }
    });
    let (status, said) = pilot.end();
    until.store(true, Ordering::Relaxed);
    liar.join().unwrap();
    truth.join().unwrap();
    assert_eq!(status, Some(0), "{:?}", said.last());
    assert!(has_told(&said, "heard", &json!(true)));
    assert!(said.last().unwrap()["network"]["heard"].as_u64().unwrap() > 100);
    for why in CAUGHT {
        assert!(refused(&said, why) > 20, "{why}: {:?}", said.last());
    }
}
