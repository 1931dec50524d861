//! Pictures of the documentation that are drawn by no other test. Each is drawn by a test whose name begins with `the_picture`, so that
//! one command draws all: `cargo test -p system-tests --test system -- --ignored the_picture`.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::animation;
use crate::chromium::Chromium;
use crate::processes::{program, signal, with_page};

#[test]
#[ignore = "writes docs/fleet.png"]
fn the_picture_of_the_fleet() {
    let mut chromium = Chromium::start().expect("chromium");
    let mut pilot = program("ardrone-pilot");
    pilot.current_dir("..").args(["fleet", "fleets/five.toml", "--mock", "--plain", "--no-log"]);
    let (mut child, url) = with_page(pilot.args(["--ui", "0"]).stdout(Stdio::null()));
    let tab = chromium.open(&format!("{}/?vehicle=cleo", url.trim_end_matches('/')));
    chromium.look(&tab, [1500, 950], "light");
    chromium.wait(&tab, "!!status && status.step === 3 && status.distance_m < 3.4");
    chromium.wait(&tab, "window.video.drawn > 20");
    chromium.screenshot(&tab, Path::new("../docs/fleet.png"));
    signal(&child, "-INT");
    child.wait().unwrap();
}

/// They are drawn by `xtask`, of what these pages are about.
#[test]
#[ignore = "writes docs/plots/figures.svg, docs/plots/flight.svg, docs/safety-case.svg and docs/figures.svg"]
fn the_pictures_of_the_control_law_of_the_safety_case_and_of_the_figures() {
    // A flight beside it keeps its time.
    let xtask = |arguments: &[&str]| {
        let xtask =
            ["-n", "19", env!("CARGO"), "run", "--quiet", "--release", "--package", "xtask"];
        let mut command = Command::new("nice");
        let status = command.current_dir("..").args(xtask).arg("--").args(arguments).status();
        assert!(status.unwrap().success(), "cargo xtask {arguments:?}");
    };
    for drawn in [
        "../docs/plots/figures.svg",
        "../docs/plots/flight.svg",
        "../docs/safety-case.svg",
        "../docs/figures.svg",
    ] {
        std::fs::remove_file(drawn).unwrap();
    }
    xtask(&["fly", "--plots", "docs/plots"]);
    xtask(&["case"]);
    xtask(&["figures", "--draw"]);
}

#[test]
#[ignore = "writes docs/square.svg"]
fn the_picture_of_the_square() {
    std::fs::write("../docs/square.svg", animation::square()).unwrap();
}

#[test]
fn the_square_of_the_first_page_is_as_it_is_flown() {
    let drawn = std::fs::read_to_string("../docs/square.svg").unwrap();
    assert!(
        drawn == animation::square(),
        "draw it again with the_picture_of_the_square, and look at it"
    );
    assert!(drawn.len() < 60_000, "{} bytes", drawn.len());
}
