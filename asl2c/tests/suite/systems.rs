//! Systems of agents: those of the gallery, faults in them, and what is refused.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use asl2c::{NetworkConditions, Runs as _, SystemSession, read_system, replay};
use insta::assert_snapshot;

use crate::harness::{cbmc, skip};

const GALLERY: &str = "../translator/agents";
const SYSTEMS: [&str; 4] = ["contract", "corridor", "corridor_calm", "relief"];

fn asl2c(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asl2c")).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

#[test]
fn every_system_is_in_the_gallery_and_its_readme() {
    let readme = fs::read_to_string(format!("{GALLERY}/README.md")).unwrap();
    let files =
        fs::read_dir(format!("{GALLERY}/systems")).unwrap().map(|file| file.unwrap().path());
    let mut found: Vec<String> = files
        .filter(|path| path.extension().is_some_and(|ending| ending == "system"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    found.sort();
    assert_eq!(found, SYSTEMS);
    assert!(found.iter().all(|name| readme.contains(&format!("`{name}.system`"))));
}

#[test]
fn every_property_of_the_gallerys_systems_holds() {
    for name in SYSTEMS {
        let output = asl2c(&["verify", &format!("{GALLERY}/systems/{name}.system")]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", said(&output));
    }
}

/// What is proved of one agent holds in each system.
#[test]
fn every_agent_of_the_gallerys_systems_is_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    for name in ["bidder", "keeper", "manager", "traveller"] {
        let path = format!("{GALLERY}/systems/{name}.conf");
        let output = asl2c(&["prove", &path, "--cbmc", cbmc.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", said(&output));
    }
}

#[test]
fn every_transcript_is_what_the_system_does() {
    for name in ["contract", "corridor", "relief"] {
        let path = format!("{GALLERY}/systems/{name}");
        let system = read_system(Path::new(&format!("{path}.system"))).unwrap();
        let mut session = SystemSession::new(&system, NetworkConditions::PERFECT).unwrap();
        let text = fs::read_to_string(format!("{path}.transcript")).unwrap();
        let replayed = replay(&mut session, name, &text);
        assert!(replayed.is_fine(), "{name} {:?}\n{}", replayed.broken, replayed.shown);
    }
}

/// A system, a file of its agents, a text in it and what stands there instead, and the properties that this breaks.
type Fault = (&'static str, &'static str, &'static str, &'static str, &'static [&'static str]);

/// Each with a way that agents with values can go.
const FAULTS: [Fault; 12] = [
    ("corridor", "systems/keeper.asl", " <- +taken; .send", " <- .send", &["one_at_a_time"]),
    (
        "corridor",
        "systems/traveller.asl",
        ".send(keeper, untell, waiting).",
        ".send(keeper, untell, waiting); .send(keeper, achieve, release).",
        &["one_at_a_time"],
    ),
    (
        "corridor",
        "systems/keeper.conf",
        "release from left, right, 1",
        "release from left, right, 2",
        &[],
    ),
    (
        "corridor_calm",
        "systems/traveller.asl",
        "-inside; .send(keeper, achieve, release)",
        "-inside",
        &["is_used"],
    ),
    (
        "corridor_calm",
        "systems/traveller.asl",
        "hold; .send(keeper, achieve, release).",
        "hold.",
        &["is_used"],
    ),
    (
        "contract",
        "systems/manager.asl",
        ".send(far, achieve, work)",
        ".send(far, achieve, work); .send(near, achieve, work)",
        &["one_works", "is_begun"],
    ),
    (
        "contract",
        "systems/manager.asl",
        "not open & not busy",
        "not open",
        &["one_works", "is_begun"],
    ),
    ("contract", "systems/bidder.asl", "<- rest; +working.", "<- rest.", &["is_begun"]),
    (
        "contract",
        "systems/bidder.asl",
        "<- rest; .send(manager, tell, bid(1000)).",
        "<- rest.",
        &["is_given"],
    ),
    (
        "relief",
        "relief.asl",
        "<- flyToPlace",
        "<- hover",
        &["first_is_relieved", "second_is_relieved"],
    ),
    (
        "relief",
        "relief.asl",
        "not watching[source(self)] <- goHome",
        "not watching[source(self)] <- flyToPlace",
        &["one_flies"],
    ),
    (
        "relief",
        "systems/relief.system",
        "delay = 1",
        "delay = 6",
        &["first_is_relieved", "second_is_relieved"],
    ),
];

/// A copy of the gallery with a fault.
fn with_fault(file: &str, from: &str, to: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("systems")).unwrap();
    for part in ["", "systems"] {
        for entry in fs::read_dir(Path::new(GALLERY).join(part)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                fs::copy(&path, folder.path().join(part).join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{file}: {from}");
    fs::write(path, text.replacen(from, to, 1)).unwrap();
    folder
}

#[test]
fn faults_are_found_and_can_be_repeated() {
    for (name, file, from, to, properties) in FAULTS {
        let folder = with_fault(file, from, to);
        let system = folder.path().join("systems").join(format!("{name}.system"));
        let system = system.to_str().unwrap();
        let mut verify = vec!["verify", system, "--json"];
        verify.extend(properties.iter().flat_map(|property| ["--only", property]));
        let output = asl2c(&verify);
        if properties.is_empty() {
            // The messages differ.
            assert!(said(&output).contains("has other messages than"), "{}", said(&output));
            continue;
        }
        assert_eq!(output.status.code(), Some(1), "{file} {to}: {}", said(&output));
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        for wanted in properties {
            let mut all = json["properties"].as_array().unwrap().iter();
            let property = all.find(|property| property["name"] == *wanted).unwrap();
            assert_eq!(property["verdict"], "fails", "{file} {to} {wanted}");
            let script = property["script"].as_str();
            let script = script.unwrap_or_else(|| panic!("{file} {to} {wanted} is not repeated"));
            let again = asl2c(&["run", system, "--script", script]);
            assert_eq!(again.status.code(), Some(1), "{}", said(&again));
            assert!(said(&again).contains(&format!("breaks `{wanted}`")), "{}", said(&again));
        }
    }
}

/// Two agents that tell each other a number.
const PAIR: &str = "settings { input = INPUT; output = a.c; header = a.h; basics = b.h; };
    basics { void act(int32_t); bool ready(void); };
    peers { one, two }; messages { tell seen(int32_t) from any; achieve go from one, 1; };
    types { live(void); start(void); wait(void); }; triggerables { +!start; };
    properties { few: at_most_one(act); };";
const TALKS: &str = "!live. +!live : ready & seen(X)[source(P)] & P \\== self <- act(X); .send(P, tell, seen(X + 1)); !!live.
    +!live <- !!live. +!go <- act(0). +!start <- .send(two, achieve, go); .broadcast(tell, seen(1)).";

fn pair(system: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("a.conf", &PAIR.replace("INPUT", "a.asl"));
    write(
        "b.conf",
        &PAIR.replace("INPUT", "a.asl").replace("peers { one, two }", "peers { two, one }"),
    );
    write("a.asl", TALKS);
    write("a.system", system);
    folder
}

/// Agents with texts of their own: `one` calls `on` in nearly every step, and `off` of `two` must not be reached.
const ALONE: &str = "settings { input = INPUT; output = a.c; header = a.h; basics = b.h; };
    basics { void on(void); void off(void); peer other(void); };
    peers { one, two }; messages { tell first from one; tell second from one; tell begin from two; achieve go from one, ROOM; };
    types { live(void); start(void); done(void); s(void); f1(void); f2(void); f3(void); f4(void);
        f5(void); };
    triggerables { +!start; };";

/// What `one` does besides, what `two` does, the room of its ring, the channels, a property, and whether it holds.
type Alone = (&'static str, &'static str, u8, &'static str, &'static str, bool);

const ORDERS: &str = "+begin <- .send(two, achieve, go); .send(two, achieve, go). +!start <- true.";
/// Busy until both orders have arrived.
const BUSY: &str =
    "+!start <- .send(one, tell, begin); !s. +!s : not f1 <- +f1; !s. +!s : not f2 <- +f2; !s.
    +!s : not f3 <- +f3; !s. +!s : not f4 <- +f4; !s. +!s : not f5 <- +f5; !s. +!s <- true.
    +!go : not done <- +done. +!go <- off.";
const TAKES_BACK: &str = "+begin <- .send(two, achieve, go); .send(two, achieve, go).
    -begin <- on; .send(two, unachieve, go). +!start <- true.";
/// Busy until both orders have arrived and are taken back.
const BUSY_LONGER: &str = "+!start : not f1 <- .send(one, tell, begin); !s. +!start <- true.
    +!s : not f1 <- +f1; !s. +!s : not f2 <- +f2; .send(one, untell, begin); !s. +!s : not f3 <- +f3; !s.
    +!s : not f4 <- +f4; !s. +!s : not f5 <- +f5; !s. +!s <- true. +!go <- off.";
const TELLS: &str = "+!start <- .send(two, tell, first); .send(two, tell, second).";
const COMPARES: &str =
    "!live. +!live : second[source(one)] & not first[source(one)] <- off; !!live. +!live <- !!live.
    +!start <- true.";
/// The second in a later round than the first.
const TELLS_LATER: &str =
    "+!start <- .send(two, tell, first); !!s. +!s <- on; .send(two, tell, second).";
const ASKS: &str = "+!start <- .send(two, achieve, go).";
const ASKS_SOMEBODY: &str = "+!start : P = other <- .send(P, achieve, go).";
const ASKS_WITHOUT_NAME: &str = "+!start <- .send(other, achieve, go).";
const ANSWERS: &str = "+!go <- off. +!start <- true.";
const TELLS_AND_ASKS: &str =
    "+!start <- .send(two, tell, first); .send(two, tell, second); .send(two, achieve, go).";
/// Looks when everything has arrived or is lost.
const LOOKS: &str =
    "+!go <- !!s. +!s : not first & not second <- off. +!s <- true. +!start <- true.";
const NEVER: &str = "never_together(one.on, two.off)";

const ALL_ALONE: [Alone; 14] = [
    // A ring has its room, and no more.
    (ORDERS, BUSY, 1, "capacity = 2; losses = 0; delay = 1;", NEVER, true),
    (ORDERS, BUSY, 2, "capacity = 2; losses = 0; delay = 1;", NEVER, false),
    // Who is asked may be anybody.
    (ASKS_SOMEBODY, ANSWERS, 1, "capacity = 2; losses = 0; delay = 0;", NEVER, false),
    // All that waits is taken back.
    (TAKES_BACK, BUSY_LONGER, 2, "capacity = 2; losses = 0; delay = 0;", NEVER, true),
    // A later message may overtake, but both have arrived at the end of a round if nothing is late.
    (TELLS, COMPARES, 1, "capacity = 2; losses = 0; delay = 1;", NEVER, false),
    (TELLS, COMPARES, 1, "capacity = 2; losses = 0; delay = 0;", NEVER, true),
    (TELLS_LATER, COMPARES, 1, "capacity = 3; losses = 0; delay = 2;", NEVER, false),
    // Two are lost, with one between them that arrives.
    (TELLS_AND_ASKS, LOOKS, 1, "capacity = 3; losses = 1; delay = 0;", NEVER, false),
    // An answer counts, if it is not too late and nothing is lost.
    (
        ASKS,
        ANSWERS,
        1,
        "capacity = 2; losses = 0; delay = 1;",
        "within(3, one.send_achieve_go, two.off)",
        true,
    ),
    // .. and if it is not oneself who is asked.
    (
        ASKS_SOMEBODY,
        ANSWERS,
        1,
        "capacity = 2; losses = 0; delay = 1;",
        "within(3, one.send_achieve_go, two.off)",
        false,
    ),
    (
        ASKS_WITHOUT_NAME,
        ANSWERS,
        1,
        "capacity = 2; losses = 0; delay = 1;",
        "within(3, one.send_achieve_go, two.off)",
        false,
    ),
    (
        ASKS,
        ANSWERS,
        1,
        "capacity = 2; losses = 0; delay = 2;",
        "within(2, one.send_achieve_go, two.off)",
        false,
    ),
    (
        ASKS,
        ANSWERS,
        1,
        "capacity = 2; losses = 1; delay = 1;",
        "within(3, one.send_achieve_go, two.off)",
        false,
    ),
    (
        ASKS,
        ANSWERS,
        1,
        "capacity = 2; losses = any; delay = 1;",
        "within(3, one.send_achieve_go, two.off)",
        false,
    ),
];

#[test]
fn rooms_orders_and_answers_decide() {
    if Command::new("spin").arg("-V").output().is_err() {
        return skip("spin");
    }
    for (one, two, room, channels, property, holds) in ALL_ALONE {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        let configuration = ALONE.replace("ROOM", &room.to_string());
        write("one.conf", &configuration.replace("INPUT", "one.asl"));
        write("two.conf", &configuration.replace("INPUT", "two.asl"));
        write("one.asl", &format!("!live. +!live <- on; !!live. {one}"));
        write("two.asl", two);
        let system = format!(
            "agents {{ one: one.conf; two: two.conf; }}; channels {{ {channels} }}; properties {{ p: {property}; }};"
        );
        write("a.system", &system);
        let path = folder.path().join("a.system");
        let output = asl2c(&["verify", path.to_str().unwrap()]);
        let expected = i32::from(!holds);
        assert_eq!(output.status.code(), Some(expected), "{two} {system}\n{}", said(&output));
    }
}

const AGENTS: &str = "agents { one: a.conf; two: a.conf; }; ";

#[test]
fn what_does_not_fit_is_refused_with_its_place() {
    let mut all = String::new();
    for text in [
        "agents { one: a.conf; };",
        "agents { one: a.conf; three: a.conf; };",
        "agents { one: a.conf; two: b.conf; };",
        "agents { one: a.conf; two: none.conf; };",
        "agents { one: a.conf; two: a.conf; } properties { p: never_together(one.act, two.acts); };",
        "agents { one: a.conf; two: a.conf; } properties { p: never_together(one.act, one.act); };",
        "agents { one: a.conf; two: a.conf; } properties { p: never_together(one.act, three.act); };",
        "agents { one: a.conf; two: a.conf; } properties { p: within(3, one.+!go, two.act); };",
        "agents { one: a.conf; two: a.conf; } properties { p: within(3, one.+!start, two.send_untell_seen); };",
    ] {
        let folder = pair(text);
        let output = Command::new(env!("CARGO_BIN_EXE_asl2c"))
            .args(["verify", "a.system"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(3), "{text}");
        all += &said(&output);
    }
    assert_snapshot!(all);
}

/// What a receiver refuses takes its place in the channel; a trace function is an action.
#[test]
fn refused_messages_and_traces_count() {
    let folder = pair(
        "agents { one: a.conf; two: a.conf; }; channels { capacity = 1; losses = 0; delay = 0; };
        properties { answered: within(2, two.send_tell_seen, one.act); traced: within(1, one.act, two.trace); };",
    );
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let traced =
        PAIR.replace("INPUT", "a.asl").replace("basics = b.h;", "basics = b.h; trace = trace;");
    write("a.conf", &traced);
    // Only the first may ask for it.
    write(
        "a.asl",
        "!live. +!live : .my_name(two) <- .send(one, achieve, go); .send(one, tell, seen(1)). +!live <- !!wait.
        +!wait : seen(_)[source(two)] <- act(1). +!wait <- !!wait. +!go. +!start.",
    );
    let path = folder.path().join("a.system");
    let path = path.to_str().unwrap();
    let output = asl2c(&["verify", path]);
    let text = said(&output);
    for broken in ["answered", "channels_suffice"] {
        assert!(text.contains(&format!("{broken}: DOES NOT HOLD")), "{text}");
    }
    let script = folder.path().join("four.script");
    fs::write(&script, "step 4\n").unwrap();
    let text = said(&asl2c(&["run", path, "--script", script.to_str().unwrap()]));
    assert!(
        text.contains("breaks `channels_suffice`") && text.contains("breaks `answered`"),
        "{text}"
    );
    // It chooses a plan in each step that the other one acts in.
    write(
        "a.asl",
        "!live. +!live : .my_name(one) <- act(1); !!live. +!live <- .broadcast(tell, seen(2)); !!live. +!go. +!start.",
    );
    let text = said(&asl2c(&["verify", path, "--only", "traced"]));
    assert!(text.contains("traced: holds"), "{text}");
    let text = said(&asl2c(&["run", path, "--script", script.to_str().unwrap()]));
    assert!(!text.contains("breaks `traced`"), "{text}");
}

/// The time of an answer begins when the event is raised, also after the agent's step, and behind another event.
#[test]
fn an_event_that_waits_behind_another_one_is_late() {
    let folder = pair(
        "agents { one: a.conf; two: a.conf; };
        properties { next: within(1, one.+!start, one.act); after: within(2, one.+!start, one.act); };",
    );
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let two = PAIR.replace("INPUT", "a.asl").replace("basics = b.h;", "basics = b.h; inbox = 2;");
    write("a.conf", &two.replace("+!start; }", "+!start; +!wait; }"));
    write("a.asl", "+!start <- act(1). +!wait. +!go.");
    let path = folder.path().join("a.system");
    let path = path.to_str().unwrap();
    let text = said(&asl2c(&["verify", path]));
    assert!(text.contains("next: DOES NOT HOLD") && text.contains("after: holds"), "{text}");
    let script = folder.path().join("late.script");
    fs::write(&script, "one: step\none: achieve_wait(); achieve_start()\ntwo: step\nstep 2\n")
        .unwrap();
    let text = said(&asl2c(&["run", path, "--script", script.to_str().unwrap()]));
    assert!(text.contains("breaks `next`") && !text.contains("breaks `after`"), "{text}");
}

fn shown(channels: &str, conditions: NetworkConditions, lines: &[&str]) -> String {
    let folder = pair(&format!("{AGENTS}{channels}"));
    let system = read_system(&folder.path().join("a.system")).unwrap();
    let mut session = SystemSession::new(&system, conditions).unwrap();
    let told = lines.iter().map(|line| match session.execute(line) {
        Ok(shown) => format!(
            "> {line}\n{}",
            shown.iter().map(|line| format!("{line}\n")).collect::<String>()
        ),
        Err(error) => {
            let help = error.help.map_or(String::new(), |help| format!(" ({help})"));
            format!("> {line}\nerror {:?}: {}{help}\n", error.span, error.message)
        }
    });
    told.collect()
}

#[test]
fn messages_arrive_are_lost_and_overtake_each_other() {
    let lines = [
        "one: achieve_start(); achieve_start();",
        "step",
        "one: next_step()",
        "channels",
        "two: step",
        "deliver one two 3",
        "deliver one two 2",
        "one: step",
        "one: step",
        "two: step",
        "two: step",
        "lose one two",
        "deliver one two",
        "mind two",
        "undo",
        "deliver two one",
        "step 2",
        "two: step 2",
        "two: receive_tell_seen(one, 3)",
        "two: clear(); ",
        "two: step; step",
        "two: undo",
        "two: sept",
        "one: ready_result = true // and on",
        "step 2",
        "one: achieve_start()",
        "step 2",
        "lose one",
        "deliver one three",
        "four: step",
        "sept",
        "step 0",
        "step 1 2",
        "undo 100",
        "undo",
        "help",
        "quit",
    ];
    let channels = "channels { capacity = 2; losses = 0; delay = 1; };";
    assert_snapshot!(shown(channels, NetworkConditions::PERFECT, &lines));
}

#[test]
fn losses_and_delays_are_the_same_for_the_same_seed_and_within_the_bounds() {
    let steps =
        ["one: ready_result = true", "two: ready_result = true", "one: achieve_start()", "step 60"];
    let channels = "channels { capacity = 3; losses = 1; delay = 2; };";
    let conditions = |seed| NetworkConditions { loss_percent: 40, delay_rounds: 2, seed };
    let first = shown(channels, conditions(7), &steps);
    assert_eq!(first, shown(channels, conditions(7), &steps));
    assert_ne!(first, shown(channels, conditions(8), &steps));
    let lost = first.lines().filter(|line| line.ends_with(", lost")).count();
    assert!(lost > 5, "{first}");
    // Of two messages to the same agent at least one arrives.
    for to in ["one", "two"] {
        let mut before = false;
        for line in first.lines().filter(|line| line.contains(&format!("-> {to}: "))) {
            let is_lost = line.ends_with(", lost");
            assert!(!(before && is_lost), "{first}");
            before = is_lost;
        }
    }
    let folder = pair(&format!("{AGENTS}channels {{ losses = 0; delay = 1; }};"));
    let path = folder.path().join("a.system");
    for (options, message) in [
        (["--loss", "3"], "the channels of this system lose nothing"),
        (["--delay", "2"], "at most 1 rounds late"),
    ] {
        let output = asl2c(&[&["run", path.to_str().unwrap()], options.as_slice()].concat());
        assert_eq!(output.status.code(), Some(1));
        assert!(said(&output).contains(message), "{}", said(&output));
    }
    // One agent has no channels.
    let agent = folder.path().join("a.conf");
    for option in ["--loss", "--delay", "--seed"] {
        let output = asl2c(&["run", agent.to_str().unwrap(), option, "1"]);
        assert_eq!(output.status.code(), Some(1), "{option}");
        let said = said(&output);
        assert!(said.starts_with("error: only the channels of a system"), "{option}: {said}");
    }
}

#[test]
fn a_file_that_cannot_be_read_is_told_where_it_is_named() {
    let folder = pair("agents { one: nowhere.conf; two: b.conf; };");
    let path = folder.path().join("a.system");
    let output = asl2c(&["run", path.to_str().unwrap()]);
    assert!(said(&output).contains("a.system:1:15\n"), "{}", said(&output));
    fs::remove_file(folder.path().join("a.asl")).unwrap();
    let output = asl2c(&["run", folder.path().join("a.conf").to_str().unwrap()]);
    assert!(said(&output).contains("a.conf:1:20\n"), "{}", said(&output));
    assert!(said(&output).contains("error: cannot read `a.asl`: "), "{}", said(&output));
}

/// The same messages in other words have the same version, which the report shows.
#[test]
fn agents_need_the_same_version_of_the_messages() {
    const SAID: &str = "tell seen(double, peer) from any; achieve go(int) from one, 2;";
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let configuration = |name: &str, messages: &str| {
        format!(
            "settings {{ input = a.asl; output = {name}.c; header = {name}.h; basics = {name}_actions.h; }};
            basics {{ void act(int); }}; peers {{ one, two }}; messages {{ {messages} }}; types {{ live(void); }};"
        )
    };
    write("a.conf", &configuration("a", SAID));
    write(
        "a.asl",
        "!live. +!live <- .broadcast(tell, seen(2.0, self)); !!live. +!go(_) <- act(1). +seen(_, _).",
    );
    write("a.system", "agents { one: a.conf; two: b.conf; };");
    write("two.script", "step 1\n");
    let run = |arguments: &[&str]| {
        let mut asl2c = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        // Without compilers the report is fast.
        asl2c.args(arguments).current_dir(folder.path()).env("PATH", "/nothing").output().unwrap()
    };
    let version = |configuration: &str| {
        let output = run(&["-q", "--report", configuration]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let mut lines = text.lines();
        let version = lines.find_map(|line| line.strip_prefix("version of the messages"));
        version.unwrap_or_else(|| panic!("{}{text}", said(&output))).trim().to_owned()
    };
    write(
        "b.conf",
        &configuration(
            "b",
            "achieve go(int32_t) from one, 2; tell seen(double, peer_t) from two, one;",
        ),
    );
    let output = run(&["run", "a.system", "--script", "two.script"]);
    assert!(output.status.success(), "{}", said(&output));
    let text = said(&output);
    assert!(text.contains("one -> two: tell seen(2.0, one)\n"), "{text}");
    let one = version("a.conf");
    assert_eq!(one.len(), 16);
    assert_eq!(version("b.conf"), one);
    for (from, to) in [("double", "float"), ("from any", "from one"), ("one, 2", "one, 3")] {
        write("b.conf", &configuration("b", &SAID.replace(from, to)));
        let output = run(&["run", "a.system", "--script", "two.script"]);
        assert!(said(&output).contains("`two` has other messages than `one`"), "{}", said(&output));
        assert_ne!(version("b.conf"), one);
    }
}
