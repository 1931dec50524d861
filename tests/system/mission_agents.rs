//! Agents that fly missions and talk: the examples in simulated time, who has the controls, and what is proved of them.

use std::collections::VecDeque;
use std::path::Path;
use std::time::Duration;

use ardrone_pilot::drive::{self, Driver, NoRoom, POLL, Passed, Simulated};
use ardrone_pilot::fleet::{self, Fleet, Member, SimulatedFleet, SimulatedMember};
use ardrone_pilot::flight::{Connections, Content, Flight, RemoteAgents, Trouble};
use ardrone_pilot::recording::{Header, Log, Recorder};
use ardrone_pilot::report;
use ardrone_pilot::settings::Settings;
use autopilot::Vehicle;
use autopilot::outcome::Outcome;
use autopilot::plan::ZOrigin;
use autopilot::vehicle::{Input, Operator, OperatorOrder, Refused, Station, VehicleConfig};
use kinematics::Pose;
use mission_agent::{Line, MissionAgent, Said};
use mock_drone::WorldConfig;
use mock_drone::server::{MockDrone, Ports};
use nalgebra::Vector2;

use super::processes::program;

fn read(name: &str) -> Fleet {
    Fleet::read(&Path::new("../fleets").join(name), ZOrigin::default()).unwrap()
}

fn named<'a>(fleet: &Fleet, flown: &'a SimulatedFleet, name: &str) -> &'a SimulatedMember {
    let number = fleet.members.iter().position(|one| one.config.name.as_str() == name).unwrap();
    flown.members.iter().find(|one| one.number == number).unwrap()
}

/// Texts of what was said, each once, with the time of the first.
fn said(member: &SimulatedMember) -> Vec<(Duration, &str)> {
    let mut all: Vec<(Duration, &str)> = Vec::new();
    for (at, said) in &member.said {
        if !all.iter().any(|(_, text)| *text == said.text()) {
            all.push((*at, said.text()));
        }
    }
    all
}

#[test]
fn two_pass_a_corridor_one_after_the_other() {
    let fleet = read("corridor.toml");
    let flown = fleet::fly(&fleet).unwrap();
    assert_eq!(fleet::fly(&fleet).unwrap(), flown, "the same again");
    for member in &flown.members {
        assert_eq!(member.outcome, Some(Outcome::Completed));
    }
    let [left, right] = ["left", "right"].map(|name| said(named(&fleet, &flown, name)));
    let when = |said: &[(Duration, &str)], text: &str| {
        said.iter().find(|(_, it)| *it == text).map(|(at, _)| *at).unwrap()
    };
    // The first that is let in has come out before the other one is.
    let lets_in = &named(&fleet, &flown, "keeper").said;
    let let_in = |to: &str| lets_in.iter().find(|(_, said)| said.to == to).unwrap().0;
    let (first, second) = (let_in("right"), let_in("left"));
    assert!(first < second, "{lets_in:?}");
    assert!(when(&right, "tell through") <= second, "{right:?}");
    assert!(when(&left, "tell through") > second, "{left:?}");
    let near = flown.meetings.iter().map(|meeting| meeting.together_m).fold(f64::MAX, f64::min);
    assert!(near > 2.0, "{near}");
}

#[test]
fn a_wingman_relieves_its_leader() {
    let fleet = read("relief.toml");
    let flown = fleet::fly(&fleet).unwrap();
    let [leader, wingman] = ["leader", "wingman"].map(|name| named(&fleet, &flown, name));
    assert_eq!(leader.outcome, Some(Outcome::Completed));
    assert_eq!(wingman.outcome, Some(Outcome::Completed));
    assert!(said(leader).iter().any(|(_, text)| *text == "tell low"));
    assert!(said(wingman).iter().any(|(_, text)| *text == "tell leads"));
    assert!(wingman.duration > leader.duration, "it flies on");
    // Beside the leader it flew where the round does not lead.
    let furthest_m =
        |member: &SimulatedMember| member.track_m.iter().map(|place| place.x).fold(0.0, f64::max);
    let (led, followed) = (furthest_m(leader), furthest_m(wingman));
    assert!(led < 1.5 && followed > 2.4, "{led} {followed}");
    // Each lands on its own tag.
    for (member, home) in [(leader, Vector2::new(-2.0, -3.0)), (wingman, Vector2::new(2.0, -3.0))] {
        let last = member.track_m.last().unwrap();
        assert!((last - home).norm() < 0.1, "{last}");
    }
}

/// A fleet whose vehicles are driven by a test.
struct Flown {
    drivers: Vec<Driver<Simulated>>,
    now: Duration,
}

impl Flown {
    fn new(fleet: &Fleet) -> Self {
        let driver = |member: &Member| {
            let vehicle = Vehicle::new(&member.config).unwrap();
            let mut driver = Driver::new(vehicle, &member.world());
            driver.agent = member.new_agent().unwrap();
            driver
        };
        Self { drivers: fleet.members.iter().map(driver).collect(), now: Duration::ZERO }
    }

    /// Flies on; `lose` says which of the lines get lost.
    fn fly(&mut self, time: Duration, mut lose: impl FnMut(&Said) -> bool) {
        let end = self.now + time;
        while self.now < end {
            drive::share_air(&mut self.drivers);
            let mut told = Vec::new();
            for driver in &mut self.drivers {
                if driver.step(|_, _| {}) {
                    told.extend(driver.vehicle.as_neighbour(self.now));
                }
                driver.surroundings.said.retain(|said| !lose(said));
                driver.pass();
            }
            drive::deliver(&mut self.drivers);
            for driver in &mut self.drivers {
                for neighbour in &told {
                    // Its own is refused.
                    _ = driver.handle(Input::Neighbour(*neighbour), |_, _| {});
                }
            }
            self.now += POLL;
        }
    }

    fn is_over(&self, place: usize) -> bool {
        let driver = &self.drivers[place];
        driver.agent.as_ref().unwrap().is_over(&driver.vehicle)
    }

    fn height_m(&self, place: usize) -> f64 {
        self.drivers[place].world().truth().position_m.z
    }
}

const SECOND: Duration = Duration::from_secs(1);
const PAGE: Operator = Operator { station: Station::Browser, number: 1, local: false };

#[test]
fn messages_that_are_lost_cost_time_and_nothing_else() {
    let fleet = read("corridor.toml");
    for seed in 0..5_u64 {
        let mut flown = Flown::new(&fleet);
        let mut state = seed;
        // Two of three lines are lost.
        flown.fly(90 * SECOND, |_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            !(state >> 33).is_multiple_of(3)
        });
        for place in 0..3 {
            assert!(flown.is_over(place), "seed {seed}: {:?}", flown.drivers[place].agent);
        }
    }
}

#[test]
fn who_hears_nothing_does_not_go_in() {
    let fleet = read("corridor.toml");
    let mut flown = Flown::new(&fleet);
    flown.fly(25 * SECOND, |_| true);
    for place in [1, 2] {
        let truth = flown.drivers[place].world().truth();
        assert!(flown.height_m(place) > 0.5, "{truth:?}");
        let forward_m = truth.position_m.y - 4.0;
        assert!(forward_m < -1.5, "it waits in front of the corridor: {forward_m}");
    }
}

#[test]
fn every_person_takes_the_controls_from_an_agent_and_gives_them_back() {
    let fleet = read("corridor.toml");
    let mut flown = Flown::new(&fleet);
    flown.fly(6 * SECOND, |_| false);
    let left = |flown: &mut Flown, order| flown.drivers[1].order(PAGE, order);
    left(&mut flown, OperatorOrder::Hold).unwrap();
    let controls = |flown: &Flown| flown.drivers[1].vehicle.status(flown.now).controls;
    assert_eq!(controls(&flown), Some(PAGE));
    let before = flown.drivers[1].world().truth().position_m;
    flown.fly(5 * SECOND, |_| false);
    let held = flown.drivers[1].world().truth().position_m;
    assert!((held - before).xy().norm() < 1.0, "it is held");
    let agent = flown.drivers[1].order(Operator::AGENT, OperatorOrder::Resume);
    assert_eq!(agent, Err(Refused::ControlsHeld(PAGE)), "an agent overrules nobody");
    left(&mut flown, OperatorOrder::Release).unwrap();
    flown.fly(40 * SECOND, |_| false);
    assert!((0..3).all(|place| flown.is_over(place)), "the mission goes on");
    assert_eq!(flown.drivers[1].vehicle.outcome(), Some(&Outcome::Completed));
}

#[test]
fn an_agent_whose_flight_was_ended_by_somebody_else_does_not_take_off_again() {
    let fleet = read("corridor.toml");
    let mut flown = Flown::new(&fleet);
    flown.fly(6 * SECOND, |_| false);
    flown.drivers[1].order(PAGE, OperatorOrder::Land).unwrap();
    flown.fly(6 * SECOND, |_| false);
    assert!(flown.is_over(1));
    flown.drivers[1].order(PAGE, OperatorOrder::Release).unwrap();
    flown.fly(6 * SECOND, |_| false);
    assert!(flown.height_m(1) < 0.05, "{}", flown.height_m(1));
    assert_eq!(flown.drivers[1].vehicle.outcome(), Some(&Outcome::Interrupted));
}

#[test]
fn lines_that_are_no_messages_are_refused_and_told() {
    let fleet = read("corridor.toml");
    let mut flown = Flown::new(&fleet);
    flown.fly(SECOND, |_| false);
    let mut refused = 0;
    let lines = [
        "",
        "x",
        "0000000000000000 left tell waiting",
        "\u{0}",
        "bdeb1a92c5c08985 nobody tell low",
    ];
    for line in lines {
        flown.drivers[0].surroundings.heard.push_back(Line::from(line).unwrap());
    }
    for _ in 0..20 {
        let driver = &mut flown.drivers[0];
        driver.step(|_, passed| refused += usize::from(matches!(passed, Passed::Misunderstood(_))));
        driver.pass();
    }
    assert_eq!(refused, lines.len());
}

/// Another machine: it answers what it hears, with a line of its own making that is said again and again, and a line that is no
/// message; it has no room for the first two lines.
#[derive(Debug, Default)]
struct Elsewhere {
    heard: u32,
    answers: VecDeque<Line>,
}

impl RemoteAgents for Elsewhere {
    fn say(&mut self, Said { line, .. }: &Said) -> Result<(), NoRoom> {
        self.heard += 1;
        if self.heard <= 2 {
            return Err(NoRoom::Network);
        }
        let (version, _) = line.split_once(' ').unwrap();
        for text in [&format!("{version} keeper achieve enter"), "<script>alert(1)</script>"] {
            self.answers.push_back(Line::from(text).unwrap());
        }
        Ok(())
    }

    fn next_line(&mut self) -> Option<Line> {
        self.answers.pop_front()
    }
}

/// What is lost is told, and all that was said and heard is in the log, and in its report.
#[test]
fn messages_of_a_flight_are_in_its_log_and_report_and_lost_ones_are_told() {
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("flight.mcap");
    let config = VehicleConfig { name: "left".parse().unwrap(), ..VehicleConfig::default() };
    let header =
        Header { vehicle: config.name, settings: Settings::sample().unwrap(), ..Header::default() };
    let (recorder, recording) = Recorder::start(&path, &header).unwrap();
    // It waits where it takes off, goes a metre forward, and lands there.
    let place = |y_m| Pose { x_m: 0.0, y_m, z_m: 0.8, yaw_deg: 0.0 };
    let places = vec![place(0.0), place(1.0), place(1.0)];
    let connections = Connections {
        recorder: Some(recorder),
        agent: Some(MissionAgent::new("traveller", "left", places, false).unwrap()),
        remote_agents: Some(Box::new(Elsewhere::default())),
        seat: None,
    };
    let runtime = super::udp::runtime();
    let flight =
        Flight::start(&runtime, None, &config, &super::udp::address(&mock), connections).unwrap();
    let mut lost = Vec::new();
    for message in flight.messages() {
        if let Content::Trouble(_, trouble @ Trouble::Unsaid(..)) = message.content {
            lost.push(trouble);
        }
    }
    assert_eq!(flight.finish().unwrap().outcome, Outcome::Completed);
    recording.finish().unwrap();
    // At once, and what was lost within the second after that together.
    assert_eq!(lost, [Trouble::Unsaid(NoRoom::Network, 1); 2]);
    let log = Log::read(&std::fs::read(&path).unwrap()).unwrap();
    let text = "the agent says a line that is lost: too many wait for the network already";
    assert_eq!(log.events().filter(|(.., told)| *told == text).count(), 2);
    let page = report::html(&log, &[]).unwrap();
    let (_, table) = page.split_once("<table id=\"events\">").unwrap();
    let at = |text: &str| {
        let cell = format!("<td class=\"faint\">message</td><td>{text}");
        table.find(&cell).unwrap_or_else(|| panic!("no {text}: {table}"))
    };
    let order = [
        at("to keeper: tell waiting, 3 times until "),
        at("from keeper: achieve enter"),
        at("to left: &lt;script&gt;alert(1)&lt;/script&gt;"),
        at("to keeper: untell waiting, "),
        at("to keeper: tell through, "),
    ];
    assert!(order.is_sorted(), "{order:?}");
}

/// The examples' agents are as safe as is said of them: one corridor, whatever is lost or late.
#[test]
fn what_is_said_of_the_agents_is_checked() {
    for (name, holds) in
        [("corridor.system", 1), ("keeper.conf", 3), ("traveller.conf", 3), ("wingman.conf", 3)]
    {
        let checked = program("asl2c")
            .args(["verify", &format!("../mission-agent/agents/{name}")])
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&checked.stdout);
        assert!(checked.status.success(), "{text}{}", String::from_utf8_lossy(&checked.stderr));
        assert_eq!(text.matches("holds in every environment").count(), holds, "{text}");
    }
}
