//! `asl2c validate`: what is translated is proved, and C that does something else is not.

use std::path::Path;
use std::process::{Command, Output};
use std::time::{Duration, Instant};

use asl2c::{Agent, Cbmc, ProveError, Session, on_host, replay, validate};
use judged_c::judge;
use translator::{Comparison, comparison, exercise, parse_configuration};

use crate::harness::{cbmc, from_environment, skip};

const GALLERY: &str = "../translator/agents";
const CONFORMANCE: &str = "../translator/tests/conformance";
const TIME: Duration = Duration::from_mins(10);

fn asl2c(arguments: &[&str], cbmc: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.arg("validate").args(arguments).arg("--cbmc").arg(cbmc).output().unwrap()
}

fn shown(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text)).concat()
}

#[test]
fn the_c_of_the_gallery_does_what_its_agents_say() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    for name in ["paper", "lift", "traffic_light", "infusion", "rover", "inspection", "relief"] {
        // As in the guide: from its folder.
        let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
        let cbmc = std::path::absolute(&cbmc).unwrap();
        command.args(["validate", "--json", &format!("{name}.conf"), "--cbmc"]).arg(cbmc);
        let output = command.current_dir(GALLERY).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{name}: {}", shown(&output));
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(json["version"], 1);
        assert_eq!((&json["verdict"], &json["timeouts"]), (&"proved".into(), &0.into()));
        // It has few events.
        let fewest = if name == "relief" { 6 } else { 10 };
        assert!(json["proofs"].as_u64().unwrap() >= fewest, "{json}");
        let progress = String::from_utf8_lossy(&output.stderr);
        assert!(progress.contains("] the start: proved (") && progress.contains("] step: +!"));
    }
}

/// The programs of the translator's conformance suite, each with its configuration.
fn programs() -> Vec<(String, Comparison)> {
    let suite = std::fs::read_to_string(format!("{CONFORMANCE}/../suite/conformance.rs")).unwrap();
    let constant = |name: &str| {
        let text = suite.split_once(&format!("const {name}: &str = \"")).unwrap().1;
        text.split_once("\";").unwrap().0.replace("\\\n", "")
    };
    let (basics, types) = (constant("BASICS"), constant("TYPES"));
    let mut programs = Vec::new();
    let of_peers = constant("OF_PEERS");
    for file in ["bodies", "contexts", "cycle", "goals", "messages", "program", "time"] {
        let text = std::fs::read_to_string(format!("{CONFORMANCE}/{file}.txt")).unwrap();
        for case in text.split("\n== ").skip(1) {
            let title = case.lines().next().unwrap();
            let given = |key: &str| case.lines().find_map(|line| line.strip_prefix(key));
            if given("refused:").is_some() {
                continue;
            }
            let agent = case.lines().filter_map(|line| line.strip_prefix("    "));
            let agent: String = agent.map(|line| format!("{line}\n")).collect();
            let settings = given("settings:").unwrap_or("clock = now;");
            let sections = given("with:").unwrap_or_default();
            let more = if sections.contains("peers") { &of_peers } else { "" };
            let configuration = format!(
                "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; {settings} }};\n\
                 basics {{ {basics} {more} }};\ntypes {{ {types} }};\n{sections}\n"
            );
            let configuration = parse_configuration("a.conf", &configuration).unwrap();
            let compared = comparison(&configuration, &agent).unwrap();
            programs.push((format!("{file}: {title}"), compared));
        }
    }
    programs
}

/// Every `ASL2C_VALIDATE_EVERY`th; all take minutes.
#[test]
fn programs_of_the_conformance_suite_are_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let programs = programs();
    assert!(programs.len() > 190, "{}", programs.len());
    let every = from_environment("ASL2C_VALIDATE_EVERY", 8) as usize;
    // Too hard for the solver.
    let hard = [
        // A product of two unknown numbers, divided and multiplied.
        "variables are taken along, and the context is not asked again",
        // Nine senders, each with all that it may have said.
        "the last of many senders is served, too",
    ];
    let mut times = Vec::new();
    for (title, comparison) in programs.iter().step_by(every) {
        // What is judged is printed from the tree.
        let mut printed = comparison.clone();
        judge(comparison, &comparison.files[0].text, []).unwrap().put_into(&mut printed);
        if hard.iter().any(|hard| title.ends_with(hard)) {
            continue;
        }
        let folder = tempfile::tempdir().unwrap();
        let begun = Instant::now();
        let result = validate(&printed, &cbmc, folder.path(), TIME).unwrap();
        times.push((begun.elapsed().as_secs_f64(), title));
        assert!(result.is_proved(), "{title}: {result:?}");
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0));
    let sum: f64 = times.iter().map(|(time, _)| time).sum();
    let (median, longest) = (times[times.len() / 2].0, times[times.len() - 1]);
    println!("{} programs in {sum:.0} s; median {median:.1} s, longest {longest:?}", times.len());
}

/// A mistake in the C: its description, and the C with it.
type Mistake = (String, String);

/// Single mistakes in a C file: a statement dropped, doubled or moved down, another number, comparison or truth
/// value.
fn mistakes(c: &str) -> Vec<Mistake> {
    const REPLACED: [(&str, &str); 12] = [
        (" < ", " <= "),
        (" <= ", " < "),
        (" > ", " >= "),
        (" >= ", " > "),
        (" == ", " != "),
        (" != ", " == "),
        (" && ", " || "),
        (" || ", " && "),
        ("true", "false"),
        ("false", "true"),
        ("if (", "if (!("),
        (" + ", " - "),
    ];
    let lines: Vec<&str> = c.lines().collect();
    let mut mistakes = Vec::new();
    let mut with = |what: &str, number: usize, new: Vec<String>, taken: usize| {
        let mut text: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        text.splice(number..number + taken, new);
        let line = lines[number].trim();
        mistakes.push((format!("{}: {what}: {line}", number + 1), text.join("\n") + "\n"));
    };
    let is_statement = |line: &str| {
        let line = line.trim();
        let begins =
            ["const ", "break", "return", "(void)", "bool ", "event_t ", "outcome_t ", "uint"];
        line.ends_with(';') && !begins.iter().any(|begin| line.starts_with(begin))
    };
    let is_action = |line: &str| {
        let line = line.trim();
        let own = ["post_", "defer_", "forget_"];
        is_statement(line)
            && !line.contains(" = ")
            && !own.iter().any(|name| line.starts_with(name))
    };
    // `init()` sets values that are never read.
    let ours = lines.iter().position(|line| line.starts_with("void init(")).unwrap();
    let ours = lines.iter().enumerate().take(ours);
    for (number, line) in ours.filter(|(_, line)| line.starts_with("    ")) {
        if is_statement(line) {
            with("dropped", number, vec![], 1);
            // An assignment may be doubled, or moved across a call.
            if is_action(line) || line.contains("_count = ") {
                with("doubled", number, vec![(*line).to_owned(), (*line).to_owned()], 1);
            }
            if is_action(line) && is_action(lines[number + 1]) {
                let moved = vec![lines[number + 1].to_owned(), (*line).to_owned()];
                with("moved down", number, moved, 2);
            }
        }
        for (from, to) in REPLACED {
            if let Some(place) = line.find(from) {
                let mut new = (*line).to_owned();
                new.replace_range(place..place + from.len(), to);
                if from == "if (" {
                    new.push(')');
                }
                with(&format!("{from:?} to {to:?}"), number, vec![new], 1);
            }
        }
        let digit = line.find(|c: char| c.is_ascii_digit());
        if let Some(place) = digit.filter(|place| line[..*place].ends_with([' ', '('])) {
            let mut new = (*line).to_owned();
            new.insert(place, '1');
            with("another number", number, vec![new], 1);
        }
    }
    mistakes
}

/// Steps in which a C file that is proved in spite of its mistake is tested too.
const TESTED: u32 = 20_000;

/// `ASL2C_MISTAKES` mistakes, spread over the gallery's C files. What is proved in spite of its mistake is the same
/// program: it is listed, and random tests must not find a difference.
#[test]
fn c_with_a_mistake_is_not_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let wanted = from_environment("ASL2C_MISTAKES", 12) as usize;
    let names = ["inspection", "infusion", "lift", "rover"];
    let (mut tried, mut refused, mut undecided, mut equal) = (0, 0, Vec::new(), Vec::new());
    for name in names {
        let agent = Agent::read(Path::new(&format!("{GALLERY}/{name}.conf"))).unwrap();
        let compared = comparison(&agent.configuration, &agent.text).unwrap();
        let tested = exercise(&agent.configuration, &agent.text).unwrap();
        let trace = on_host(&tested, TESTED).unwrap();
        let found = mistakes(&compared.files[0].text);
        let step = (found.len() * names.len() / wanted).max(1);
        for (what, c) in found.iter().step_by(step) {
            let mut compared = compared.clone();
            tried += 1;
            let Ok(judged) = judge(&compared, c, []) else {
                refused += 1;
                continue;
            };
            judged.put_into(&mut compared);
            let folder = tempfile::tempdir().unwrap();
            match validate(&compared, &cbmc, folder.path(), TIME) {
                Ok(result) if result.is_proved() => {
                    let mut tested = tested.clone();
                    tested.files[0].text.clone_from(c);
                    let same = on_host(&tested, TESTED).unwrap() == trace;
                    assert!(same, "{name}.c:{what}: proved, but does something else");
                    equal.push(format!("{name}.c:{what}"));
                }
                Ok(result) if result.open.is_empty() => undecided.push(format!("{name}.c:{what}")),
                // What does not compile is no C of the agent either.
                Ok(_) | Err(ProveError::NoResult { .. }) => {}
                Err(error) => panic!("{name}.c:{what}: {error}"),
            }
        }
    }
    let caught = tried - equal.len() - undecided.len();
    println!(
        "{tried} mistakes, {caught} caught ({refused} of them refused), {} undecided:\n{}\n{} without effect:\n{}",
        undecided.len(),
        undecided.join("\n"),
        equal.len(),
        equal.join("\n")
    );
    assert!(undecided.is_empty(), "{undecided:?}");
    assert!(tried >= wanted.min(12) && equal.len() * 4 <= tried, "{tried}: {equal:?}");
}

/// Faults of a back end: what it would write wrong, wherever it writes it.
const FAULTS: [(&str, &str, &str); 7] = [
    ("less is less or equal", "(var_Pole < ", "(var_Pole <= "),
    ("the list takes one event too many", "agent.inbox_count < 2U", "agent.inbox_count <= 2U"),
    ("a deferred goal is not known to wait", "wait_pending = true;", "wait_pending = false;"),
    ("an event's values are those of the first slot", "[agent.inbox_taken]", "[0]"),
    ("the next event is not found behind the list's end", "first + 1U) % 2U", "first) % 2U"),
    (
        "a pre-empted goal goes on",
        "        agent.posted = EVENT_NONE;\n    }\n    else",
        "    }\n    else",
    ),
    ("an added belief is not held", "agent.belief_last_held = true;", ""),
];

/// What would be faults elsewhere: here `Pole < Last` holds, so that `Pole + 1` never overflows.
const WITHOUT_EFFECT: [(&str, &str, &str); 2] = [
    ("an overflow of 16 bits is not seen", "(UINT16_MAX - ", "(UINT32_MAX - "),
    ("a plan that fails looks inapplicable", "= OUTCOME_FAILED;", "= OUTCOME_NOT_APPLICABLE;"),
];

#[test]
fn a_fault_of_the_back_end_is_caught() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let agent = Agent::read(Path::new(&format!("{GALLERY}/inspection.conf"))).unwrap();
    let compared = comparison(&agent.configuration, &agent.text).unwrap();
    let tested = exercise(&agent.configuration, &agent.text).unwrap();
    let traced = |c: &str| {
        let mut tested = tested.clone();
        c.clone_into(&mut tested.files[0].text);
        on_host(&tested, TESTED).unwrap()
    };
    let judged = |(fault, right, wrong): (&str, &str, &str)| {
        let mut faulty = compared.clone();
        let c = &mut faulty.files[0].text;
        assert!(c.contains(right), "{fault}");
        *c = c.replace(right, wrong);
        let same = traced(c) == traced(&compared.files[0].text);
        let folder = tempfile::tempdir().unwrap();
        let result = validate(&faulty, &cbmc, folder.path(), TIME).unwrap();
        (result, same)
    };
    for fault in FAULTS {
        let (result, _) = judged(fault);
        let differs = result.open.iter().any(|open| open.said.starts_with("another "));
        assert!(differs, "{}: {result:?}", fault.0);
    }
    for none in WITHOUT_EFFECT {
        let (result, same) = judged(none);
        assert!(result.is_proved() && same, "{}: {same}, {result:?}", none.0);
    }
}

/// The proof for a step is in parts, by the next event. A comparison that leaves one of them out is no proof.
#[test]
fn no_case_is_left_out() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let agent = Agent::read(Path::new(&format!("{GALLERY}/inspection.conf"))).unwrap();
    let compared = comparison(&agent.configuration, &agent.text).unwrap();
    let judged = |compared: &Comparison| {
        let folder = tempfile::tempdir().unwrap();
        validate(compared, &cbmc, folder.path(), TIME).unwrap()
    };
    assert!(compared.cases.iter().any(|case| case.ends_with("(slot 1, 2 waiting)")));
    // Two events wait, from the second slot on.
    let mut without = compared.clone();
    let text = &mut without.files.last_mut().unwrap().text;
    let (before, cover) = text.split_once("int plain_cover").unwrap();
    let kept =
        |line: &&str| !(line.contains("inbox_first == 1U) & ") && line.contains("count == 2U"));
    let kept: Vec<&str> = cover.lines().filter(kept).collect();
    assert!(kept.len() < cover.lines().count());
    *text = format!("{before}int plain_cover{}\n", kept.join("\n"));
    assert!(judged(&without).open.iter().any(|open| open.said == "some case"));
    // A mistake in that case only.
    let mut wrong = compared.clone();
    let c = &mut wrong.files[0].text;
    let update = "\n    updateBeliefs();\n";
    assert_eq!(c.matches(update).count(), 1);
    let mistake = "    if ((agent.inbox_first == 1U) && (agent.inbox_count == 2U)) { hover(); }\n";
    *c = c.replace(update, &format!("{update}{mistake}"));
    assert!(judged(&wrong).open.iter().any(|open| open.said == "another call, or none"));
}

#[test]
fn a_difference_is_shown_and_can_be_replayed() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let configuration = format!("{GALLERY}/inspection.conf");
    let agent = Agent::read(Path::new(&configuration)).unwrap();
    let c = &comparison(&agent.configuration, &agent.text).unwrap().files[0].text;
    let wrong = c.replace("var_Left < 30U", "var_Left <= 30U");
    assert_ne!(*c, wrong);
    // Behind an error at run time CBMC judges nothing, which is no error of CBMC's.
    let dividing = c.replace("var_Left < 30U", "30U / var_Left > 1U");
    assert_ne!(*c, dividing);
    let file = folder.path().join("wrong.c");
    let path = folder.path().display().to_string();
    std::fs::write(&file, dividing).unwrap();
    let output = asl2c(&[&configuration, "--c", &file.display().to_string(), "-o", &path], &cbmc);
    let text = shown(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("a possible error at run time: division by zero"), "{text}");
    std::fs::write(&file, wrong).unwrap();
    let output = asl2c(&[&configuration, "--c", &file.display().to_string(), "-o", &path], &cbmc);
    let text = shown(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("DIFFERS from inspection.asl") && text.contains("charge(30)"), "{text}");
    let script = std::fs::read_to_string(folder.path().join("inspection.differs.script")).unwrap();
    let mut session = Session::new(&agent.configuration, &agent.text).unwrap();
    let replayed = replay(&mut session, "way", &script);
    assert_eq!(replayed.errors, 0, "{}", replayed.shown);
}

/// It is 24 steps from the start, and only where two numbers of the environment are equal and a third one is 7.
#[test]
fn a_difference_far_from_the_start_is_found() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let configuration =
        "settings { input = bath.asl; output = bath.c; header = bath.h; basics = actions.h; };
        includes { #include <stdbool.h>
        #include <stdint.h> };
        basics { void pour(void); void ring(void); };
        types { fill(uint8_t); level(uint16_t); wanted(uint16_t); tap(uint8_t); };
        settables { level; wanted; tap; };";
    let text = "!fill(0).\n+!fill(N) : N < 24 <- pour; !fill(N + 1).\n\
        +!fill(_) : level(L) & wanted(W) & L >= W & tap(7) <- ring; !fill(0).\n+!fill(_) <- pour; !fill(0).\n";
    std::fs::write(path("bath.conf"), configuration).unwrap();
    std::fs::write(path("bath.asl"), text).unwrap();
    let agent = Agent::read(&path("bath.conf")).unwrap();
    let c = &comparison(&agent.configuration, &agent.text).unwrap().files[0].text;
    let wrong = c.replace("var_L >= var_W", "var_L > var_W");
    assert_ne!(*c, wrong);
    std::fs::write(path("wrong.c"), wrong).unwrap();
    let [configuration, file] =
        ["bath.conf", "wrong.c"].map(|name| path(name).display().to_string());
    let output = asl2c(&[&configuration, "--c", &file], &cbmc);
    let text = shown(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    let script = std::fs::read_to_string(path("bath.differs.script")).unwrap();
    let steps = script.lines().filter(|line| line.starts_with("next_step")).count();
    assert_eq!((steps, script.lines().count()), (25, 30), "{script}");
    assert!(text.contains("there may be a shorter way"), "{text}");
    // The judge says the same of the translation itself.
    std::fs::write(path("right.c"), c).unwrap();
    let right = path("right.c").display().to_string();
    assert_eq!(asl2c(&[&configuration, "--c", &right], &cbmc).status.code(), Some(0));
}

/// C that does the same for a while, or outside of steps, or never ends.
#[test]
fn what_the_relation_does_not_know_is_not_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let configuration = format!("{GALLERY}/lift.conf");
    let agent = Agent::read(Path::new(&configuration)).unwrap();
    let c = comparison(&agent.configuration, &agent.text).unwrap().files[0].text.clone();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("wrong.c");
    let judged = |old: &str, new: &str| {
        assert_eq!(c.matches(old).count(), 1, "{old}");
        std::fs::write(&file, c.replace(old, new)).unwrap();
        let (file, path) = (file.display().to_string(), folder.path().display().to_string());
        let output = asl2c(&[&configuration, "--c", &file, "-o", &path], &cbmc);
        (output.status.code(), shown(&output))
    };
    let update = "\n    updateBeliefs();\n";
    let late = "\n    static int steps = 0;\n    if (steps < 3) { steps++; } else { motorStop(); }\n    updateBeliefs();\n";
    let (status, text) = judged(update, late);
    assert!(status == Some(1) && text.contains("another call"), "{text}");
    let raised = "bool achieve_emergency(void)\n{\n";
    let (status, text) = judged(raised, &format!("{raised}    motorStop();\n"));
    assert!(status == Some(1) && text.contains("raises +!emergency"), "{text}");
    let endless = "\n    updateBeliefs();\n    while (agent.belief_stopped_held) { }\n";
    let (status, text) = judged(update, endless);
    assert!(status == Some(3) && text.contains("`while` cannot be judged"), "{text}");
    let (status, text) = judged(update, "\n    updateBeliefs();\n    exit(0);\n");
    assert!(status == Some(3) && text.contains("`exit` cannot be judged"), "{text}");
}

/// Judges an agent's C with each of these texts replaced by another: the C itself is right, and each mistake is found.
fn find_mistakes(configuration: &str, agent: &str, mistakes: &[(&str, &str)]) {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let configured = folder.path().join("talker.conf");
    std::fs::write(&configured, configuration).unwrap();
    std::fs::write(folder.path().join("talker.asl"), agent).unwrap();
    let agent = Agent::read(&configured).unwrap();
    let c = comparison(&agent.configuration, &agent.text).unwrap().files[0].text.clone();
    let file = folder.path().join("wrong.c");
    let judged = |old: &str, new: &str| {
        assert!(c.contains(old), "{old}");
        std::fs::write(&file, c.replacen(old, new, 1)).unwrap();
        let path = |path: &Path| path.display().to_string();
        let arguments = [&path(&configured), "--c", &path(&file), "-o", &path(folder.path())];
        let output = asl2c(&arguments, &cbmc);
        (output.status.code(), shown(&output))
    };
    let (status, text) = judged("return event;", "return event;");
    assert_eq!(status, Some(0), "{text}");
    for (old, new) in mistakes {
        let (status, text) = judged(old, new);
        assert_eq!(status, Some(1), "{old}: {text}");
    }
}

#[test]
fn mistakes_in_messages_are_found() {
    let configuration =
        "settings { input = talker.asl; output = talker.c; header = talker.h; basics = b.h; };
        basics { void say(uint8_t); };
        peers { a, b };
        messages { tell at(uint8_t) from any; achieve go(uint8_t) from any, 2; };\n";
    let agent = "-at(X) <- say(X).
        +!go(X)[source(b)] <- say(X); .broadcast(untell, at).
        +!go(_) <- true.\n";
    let taken_back = "agent.belief_at_from_b_held = false;\n                accepted";
    let lost = "agent.belief_at_from_b_held = false;\n                agent.belief_at_from_b_1 = 0U;\n                accepted";
    find_mistakes(
        configuration,
        agent,
        &[
            // The newest value does not win.
            ("belief_at_from_b_1 = argument2;", "belief_at_from_b_1 = agent.belief_at_from_b_1;"),
            // The last value is gone when that is noticed.
            (taken_back, lost),
            // A ring that overwrites, and a sender that starves the other one.
            ("asked_go_from_b_count < 2U", "asked_go_from_b_count < 3U"),
            ("agent.asked_turn = (value + 1U) % 2U;", "agent.asked_turn = value % 2U;"),
            // A message from oneself.
            ("if (argument1 != agent.me)", "if (argument1 != 3U)"),
        ],
    );
}

#[test]
fn mistakes_in_urgent_goals_are_found() {
    let configuration =
        "settings { input = talker.asl; output = talker.c; header = talker.h; basics = b.h; };
        basics { void say(uint8_t); };
        peers { a, b };
        messages { achieve land from any, 2; };
        preemptive { +!land; };
        types { go(uint8_t); };\n";
    let agent =
        "!go(0). +!go(X) <- say(X); !go(X). +!land[source(b)] <- say(1). +!land <- say(2).\n";
    let taken = "event = take_urgent_land();";
    find_mistakes(
        configuration,
        agent,
        &[
            // What is posted is not taken back, or not counted.
            ("        agent.posted = EVENT_NONE;\n    }\n    else", "    }\n    else"),
            (taken, "event = take_urgent_land();\n        agent.posted = EVENT_NONE;"),
            // A sender that starves the other one.
            ("agent.urgent_turn_land = (value + 1U) % 2U;", "agent.urgent_turn_land = value % 2U;"),
        ],
    );
}

#[test]
fn mistakes_in_ages_are_found() {
    let configuration =
        "settings { input = talker.asl; output = talker.c; header = talker.h; basics = b.h; clock = now; };
        basics { void old(int32_t); int32_t now(void); };
        peers { a, b };
        messages { tell at(uint8_t) from any; };\n";
    let agent = "+at(_) : at(_)[source(P), age(A)] & A > 3 & P \\== b <- old(A).\n";
    let told = "agent.belief_at_from_b_told_at = now();";
    find_mistakes(
        configuration,
        agent,
        &[
            // The time of another sender, none, and one that is not the clock's.
            ("agent.belief_at_from_a_told_at, &", "agent.belief_at_from_b_told_at, &"),
            (told, ""),
            (told, "(void)now();\n                agent.belief_at_from_b_told_at = 0;"),
        ],
    );
}

/// What could not be compared must not look like a proof.
#[test]
fn what_cannot_be_compared_is_no_pass() {
    let configuration = format!("{GALLERY}/lift.conf");
    let output = asl2c(&[&configuration], Path::new("no-such-cbmc"));
    assert_eq!(output.status.code(), Some(3));
    assert!(shown(&output).starts_with("error: nothing is proved"), "{}", shown(&output));
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("no.c");
    std::fs::write(&file, "int x = ;\n").unwrap();
    let output = asl2c(&[&configuration, "--c", &file.display().to_string()], &cbmc);
    assert_eq!(output.status.code(), Some(3), "{}", shown(&output));
    let output = asl2c(&[&configuration, "--time", "0"], &cbmc);
    assert_eq!(output.status.code(), Some(3));
    assert!(shown(&output).contains("NOT DECIDED"), "{}", shown(&output));
    let output = asl2c(&[&configuration, "--total", "0"], &cbmc);
    assert_eq!(output.status.code(), Some(3));
    assert!(shown(&output).contains("10 of 10 proofs were not finished in time"));
    let output = asl2c(&[&configuration, "--c", "no/such/file.c"], &cbmc);
    assert_eq!(output.status.code(), Some(3), "{}", shown(&output));
}
