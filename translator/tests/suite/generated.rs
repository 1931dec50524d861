//! Form of the generated text, and its acceptance by compilers.

use std::process::Command;

use proptest::prelude::*;
use translator::{parse_configuration, translate};

use crate::harness::{Case, skip};

const LAMP: Case = Case {
    basics: "void switchOn(double); bool isDark(void);",
    types: "light(double); level(double); wait(void);",
    sections: "settables { level; }; triggerables { +!light; }; preemptive { +!light; };",
    agent: "// A lamp.\n!wait.\n+!wait <- !!wait.\n+!light(Level) : isDark & not level(Level)\n  <- switchOn(Level); +level(Level).\n-!light(_) <- true.\n",
};

#[test]
fn a_whole_agent_as_c_and_rust() {
    let static_form = LAMP.translate("").unwrap();
    insta::assert_snapshot!("lamp_static_source", static_form.files[0].text);
    insta::assert_snapshot!("lamp_static_header", static_form.files[1].text);
    let context = LAMP.translate("instance = context; rust = lamp.rs;").unwrap();
    insta::assert_snapshot!("lamp_context_header", context.files[1].text);
    insta::assert_snapshot!("lamp_context_actions", context.files[2].text);
    insta::assert_snapshot!("lamp_bindings", context.files[3].text);
    LAMP.compile();
}

/// What a program in Rust prints that uses the bindings of an agent.
fn bound(case: &Case, main: &str) -> String {
    bound_with("", case, main)
}

fn bound_with(settings: &str, case: &Case, main: &str) -> String {
    let folder = built_with(settings, case, main);
    let output = Command::new(folder.path().join("main")).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{:?}: {errors}", output.status);
    String::from_utf8(output.stdout).unwrap()
}

/// A folder with the compiled program `main` in Rust that uses the bindings of an agent.
pub(crate) fn built_with(settings: &str, case: &Case, main: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let settings = format!("{settings} instance = context; rust = bindings.rs;");
    let translation = case.translate(&settings).unwrap();
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    std::fs::write(folder.path().join("main.rs"), main).unwrap();
    let run = |program: &mut Command| {
        let output = program.current_dir(folder.path()).output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{:?}: {errors}", output.status);
    };
    run(Command::new("cc").args(["-c", "agent.c"]));
    run(Command::new("rustc").args(["--edition", "2024", "-C", "link-arg=agent.o", "main.rs"]));
    folder
}

/// A panic cannot unwind through C, so it is delayed until C has finished its step.
#[test]
fn a_panic_of_the_environment_is_carried_over_the_c() {
    let printed = bound(&PANICKING, PANICKING_MAIN);
    assert_eq!(printed, "asked\ncaught: it fell over\nasked 1 times\nnever again\n");
}

const PANICKING: Case = Case {
    basics: "void say(const char *); double measure(void); void act(double);",
    types: "go(void);",
    sections: "",
    agent: "!go.\n+!go : X = measure & X < 1 <- act(X); act(measure); say(\"done\"); !!go.\n-!go <- act(2); !!go.\n",
};

const PANICKING_MAIN: &str = r#"
mod bindings { include!("bindings.rs"); }
use bindings::{Agent, Beliefs, Environment};
struct World { asked: u32 }
impl Environment for World {
    fn update_beliefs(&mut self, _: &mut Beliefs<'_>) {}
    fn say(&mut self, _: &'static core::ffi::CStr) { self.asked += 1; }
    fn act(&mut self, _: f64) { self.asked += 1; }
    fn measure(&mut self) -> f64 {
        self.asked += 1;
        println!("asked");
        panic!("it fell over")
    }
}
fn main() {
    let mut agent = Agent::new();
    let mut world = World { asked: 0 };
    let mut step = || std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| agent.next_step(&mut world)));
    let panic = step().unwrap_err();
    println!("caught: {}", panic.downcast_ref::<&str>().unwrap());
    let again = step();
    println!("asked {} times", world.asked);
    println!("{}", if again.is_err() { "never again" } else { "it goes on" });
}
"#;

const PEERS: Case = Case {
    basics: "void show(int); void who(peer);",
    types: "go(void);",
    sections: "peers { leader, wingman }; messages { tell at(int) from any; achieve visit(int) from leader, 2; };
        triggerables { +!go; };",
    agent: "+!go : at(X)[source(P)] & P \\== self <- show(X); who(P); .broadcast(tell, at(X + 1)).
        +!visit(X)[source(P)] <- show(X); who(P). +at(_) <- .my_name(M); who(M).",
};

const PEERS_MAIN: &str = r#"
mod bindings { include!("bindings.rs"); }
use bindings::{Agent, Beliefs, Environment, Message, Peer};
struct World;
impl Environment for World {
    fn update_beliefs(&mut self, _: &mut Beliefs<'_>) {}
    fn show(&mut self, x: i32) { println!("show {x}"); }
    fn who(&mut self, peer: u8) { println!("who {peer}"); }
    fn send(&mut self, to: Peer, message: Message) { println!("send {to}: {message}"); }
}
fn main() {
    let mut agent = Agent::new(Peer::Wingman);
    let leader = Peer::Leader as u8;
    println!("{}", agent.receive_tell_at(Peer::Wingman as u8, 1));
    println!("{}", agent.receive_tell_at(leader, 4));
    println!("{}", agent.receive_achieve_visit(leader, 5));
    println!("{}", agent.receive_achieve_visit(7, 5));
    println!("{}", agent.achieve_go());
    for _ in 0..3 {
        agent.next_step(&mut World);
    }
    println!("{} {}", agent.receive_untell_at(leader), agent.receive_unachieve_visit(leader));
}
"#;

#[test]
fn agents_that_talk_are_compiled_and_bound() {
    PEERS.compile();
    let printed = bound(&PEERS, PEERS_MAIN);
    let expected = "false true true false true show 5 who 0 who 1 show 4 who 0 send leader: tell at(5) true true";
    assert_eq!(printed.split_whitespace().collect::<Vec<_>>().join(" "), expected);
}

#[test]
fn the_autopilot_passes_strict_compilation() {
    let configuration = include_str!("../../../autopilot/agent/autopilot.conf");
    let agent = include_str!("../../../autopilot/agent/autopilot.asl");
    let folder = tempfile::tempdir().unwrap();
    let parsed = parse_configuration("autopilot.conf", configuration).unwrap();
    let translation = translate(&parsed, agent).unwrap();
    assert!(translation.warnings.is_empty(), "{}", translation.warnings);
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    let result = Command::new("cc")
        .current_dir(folder.path())
        .args(crate::harness::STRICT)
        .args(["-c", "autopilot.c"])
        .output()
        .unwrap();
    assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
}

#[test]
fn the_report_says_what_the_autopilot_costs() {
    let configuration = include_str!("../../../autopilot/agent/autopilot.conf");
    let agent = include_str!("../../../autopilot/agent/autopilot.asl");
    let parsed = parse_configuration("autopilot.conf", configuration).unwrap();
    insta::assert_snapshot!("autopilot_report", translate(&parsed, agent).unwrap().report);
}

#[test]
fn the_report_bounds_calls_over_all_paths() {
    let case = Case {
        basics: "void a(void); void b(void); void act(int);",
        types: "g(void); h(void); k(void); x(int);",
        sections: "settables { x; };",
        agent: "!g. +!g <- a; !h; a; b. +!h : x(X) <- b; act(X + 1); b; +x(3). +x(_) <- b; b. -!h <- act(0).",
    };
    insta::assert_snapshot!("bounded_report", case.translate("").unwrap().report);
}

/// A function with a result is an action too, wherever it is called.
#[test]
fn the_report_counts_calls_that_return_a_value() {
    let case = Case {
        basics: "void a(int); bool try(void); int read(void); bool quiet(int);",
        types: "g(void); b(int);",
        sections: "classes { tries: try, quiet; }; triggerables { +!g; };",
        agent: "+!g : quiet(1) <- X = try; a(read). +!g : b(_) <- try; +b(read + 1). +!g <- a(2).",
    };
    let report = case.translate("").unwrap().report.to_string();
    let (_, calls) = report.split_once("calls in a step that handles an event").unwrap();
    insta::assert_snapshot!(calls.trim_start_matches('\n'), @r"
      a                         0 to 1
      try                       0 to 1
      read                      0 to 1

    calls of any action of a class
      tries                     0 to 2
    ");
}

#[test]
fn the_trace_matrix_leads_from_requirement_to_c_lines() {
    let case = Case {
        basics: "void a(void); void b(void);",
        types: "g(void); h(void);",
        sections: "",
        agent: "!g.\n@first[req(\"HLR-1\"), req(\"HLR,2\")]\n+!g : true\n  <- a; !h.\n+!h <- b.\n",
    };
    let translation = case.translate("matrix = trace;").unwrap();
    let [source, .., csv, json] = &translation.files[..] else { panic!("files are missing") };
    assert_eq!((csv.name.as_str(), json.name.as_str()), ("trace.csv", "trace.json"));
    insta::assert_snapshot!("trace_csv", csv.text);
    insta::assert_snapshot!("trace_json", json.text);
    // The lines are the function's: its head and its closing brace.
    let last = csv.text.lines().last().unwrap();
    let fields: Vec<&str> = last.split(',').collect();
    let lines: Vec<&str> = source.text.lines().collect();
    let line = |field: &str| lines[field.parse::<usize>().unwrap() - 1];
    assert_eq!(line(fields[9]), "static outcome_t plan1_achieve_h(void)");
    assert_eq!(line(fields[10]), "}");
}

/// Nesting depth of the braces of a C text.
fn depth(text: &str) -> usize {
    let mut depth = 0_usize;
    let mut deepest = 0;
    for character in text.chars() {
        match character {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}

/// The trace of an agent with the goal `g(X)` and the belief `b(3)`, whose C must not be nested deeper than
/// C99 guarantees, and the length of the C.
fn trace_of(agent: &str) -> (String, usize) {
    let configuration = "settings { input = a; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void act(int); bool yes(int); };\ntypes { g(int); b(int); c(int); };";
    let translation =
        translate(&parse_configuration("a.conf", configuration).unwrap(), agent).unwrap();
    let source = &translation.files[0].text;
    assert!(depth(source) <= 127, "{}", depth(source));
    let environment = "#include <stdio.h>\nvoid updateBeliefs(void) {}\n\
        void act(int x) { printf(\"%d\\n\", x); }\nbool yes(int x) { return x > 0; }\n\
        int main(void) { init(); next_step(); printf(\"%u\\n\", unhandled_events()); return 0; }\n";
    (crate::harness::compile_and_run(&translation, environment), source.len())
}

#[test]
fn nesting_is_bounded_however_long_a_plan() {
    // All bindings are used at the end.
    let body = |count: usize, last: &str| {
        let binds: Vec<String> = (0..count).map(|n| format!("V{n} = X + {n}")).collect();
        let uses: Vec<String> = (0..count).step_by(50).map(|n| format!("act(V{n})")).collect();
        format!("b(3). !g(1).\n+!g(X) <- {}; {}; act({last}).\n", binds.join("; "), uses.join("; "))
    };
    let (trace, short) = trace_of(&body(300, "X"));
    assert_eq!(trace, "1 51 101 151 201 251 1 0");
    let (trace, long) = trace_of(&body(3000, "V2999 / (V2999 - V2999)"));
    assert!(trace.starts_with("1 51 101 ") && trace.ends_with(" 2951 1"), "{trace}");
    assert!(long < 12 * short, "{short} {long}");
    // Also contexts; a failing condition in the middle makes the whole context fail.
    let context = |count: usize, odd: usize| {
        let parts: Vec<String> = (0..count)
            .map(
                |n| if n == odd { "b(2)".to_owned() } else { format!("b(V{n}) & yes(V{n} + {n})") },
            )
            .collect();
        format!(
            "b(3). !g(1).\n+!g(_) : {} <- act(V0 + V250).\n+!g(X) <- act(X).\n",
            parts.join(" & ")
        )
    };
    assert_eq!(trace_of(&context(300, 999)).0, "6 0");
    assert_eq!(trace_of(&context(300, 150)).0, "1 0");
    // Alternatives and negations at maximum depth, with several conditions on each level.
    let level = "b(A) & yes(A) & yes(A + 1) & (b(2) & yes(1) | ";
    let deep = format!("{}b(3) & yes(4){}", level.repeat(30), ")".repeat(30));
    assert_eq!(
        trace_of(&format!("b(3). !g(1).\n+!g(_) : {deep} <- act(7).\n+!g(X) <- act(X).\n")).0,
        "7 0"
    );
    let level = "not (b(A) & yes(A) & yes(A + 1) & yes(A + 2) & ";
    let deep = format!("{}b(3){}", level.repeat(14), ")".repeat(14));
    assert_eq!(
        trace_of(&format!("b(3). !g(1).\n+!g(_) : {deep} <- act(7).\n+!g(X) <- act(X).\n")).0,
        "7 0"
    );
}

#[test]
fn size_grows_with_the_agent() {
    let plans = |count: usize| -> String {
        let plans = (0..count).map(|n| format!("+!g(X) : c(X) & X > {n} <- act({n}).\n"));
        format!("b(1). !g(1).\n{}+!g(X) : b({count}) <- act(X).\n", plans.collect::<String>())
    };
    let configuration = "settings { input = a; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void act(int); };\ntypes { g(int); b(int); c(int); }; settables { c; };\n\
        properties { p: never(act); };";
    let sizes = |count: usize| {
        let parsed = || parse_configuration("a.conf", configuration).unwrap();
        let agent = plans(count);
        let model = translator::model(&parsed(), &agent).unwrap().promela().len();
        [translate(&parsed(), &agent).unwrap().files[0].text.len(), model]
    };
    let (few, many) = (sizes(200), sizes(4000));
    assert!(few.iter().zip(many).all(|(few, many)| many < 25 * few), "{few:?} {many:?}");
}

/// The clock of [`EVERYTHING`].
const CLOCK: &str = "clock = level;";

/// Every construct of the language in one agent.
const EVERYTHING: Case = Case {
    basics: "void go(place_t); void act(int32_t); void say(const char *); bool dark(void); int32_t level(void); double gauge(double);",
    types: "at(place_t); to(place_t); g(void); h(int32_t); k(void); b(int32_t); p(int32_t, int32_t); d(double); c(bool); u(uint16_t); q(int32_t, double); w(int32_t); v(int32_t);",
    sections: "structs { place_t { double x; float y; bool ok; }; }; settables { b; at; }; perceived { at; }; triggerables { +!g; +!h; +b; -b; +!k; +!w; }; preemptive { +!k; };",
    agent: "b(3). d(0.5). c(true). u(7).\n!g.\n\
        +!g : b(X) & X < 10 & not (c(Y) & Y | p(X, _)) <- act(X * 2); !h(X); say(\"x\"); +p(X, X + 1); !g.\n\
        +!g : (b(X) | p(_, X)) & d(Z) & Z / 2.0 > 0.1 & u(W) & W mod 2 == 1 & dark\n\
          <- act(level); ?q(X, V); +d(gauge(V)); !!k.\n\
        +!g <- -b(_); !!g.\n\
        +!h(3) <- act(3).\n+!h(X) : X >= 5 <- ?p(X, Y); act(-Y).\n-!h(_) <- +c(false).\n\
        +p(X, Y) : X == Y <- act(0).\n+p(_, _) <- act(1).\n-b(X) <- act(X).\n\
        +?q(X, V) : d(V) & b(X).\n+!k <- act(9).\n+at(P) : not to(P) <- +to(P); go(P); ?to(Q); go(Q).\n+?to(P) : at(P).\n\
        +!w(X) : at(P) <- .wait(100); go(P); !v(X)[deadline(50 + X)].\n\
        +!v(_) <- .wait(5); !v(3).\n-!v(X) <- act(X).\n",
};

/// cppcheck's checks and its MISRA addon only report that the interface is not called.
#[test]
fn generated_c_passes_the_misra_addon() {
    let gallery = ["paper", "lift", "traffic_light", "infusion", "rover", "inspection"];
    let gallery = gallery.map(|name| format!("agents/{name}"));
    let shipped = std::iter::once("../autopilot/agent/autopilot".to_owned());
    let agents = gallery.into_iter().chain(shipped).map(|path| {
        let read = |ending: &str| std::fs::read_to_string(format!("{path}.{ending}")).unwrap();
        let configuration = parse_configuration(&path, &read("conf")).unwrap();
        translate(&configuration, &read("asl")).unwrap()
    });
    let others = [(LAMP, ""), (EVERYTHING, CLOCK)].into_iter().flat_map(|(case, clock)| {
        ["", "instance = context;", "inbox = 3;", "max_events = 2;"]
            .map(|settings| case.translate(&format!("{clock} {settings}")).unwrap())
    });
    for translation in agents.chain(others) {
        let folder = tempfile::tempdir().unwrap();
        for file in &translation.files {
            std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
        }
        let result = Command::new("cppcheck")
            .current_dir(folder.path())
            .args(["--addon=misra", "--enable=all", "--std=c99", "--quiet"])
            .args(["--suppress=missingIncludeSystem", "--suppress=unusedFunction"])
            .arg(&translation.files[0].name)
            .output();
        let Ok(result) = result else {
            skip("cppcheck");
            return;
        };
        let findings = String::from_utf8_lossy(&result.stderr);
        assert_eq!(findings, "", "{}", translation.files[0].text);
    }
}

/// The addon detects violations.
#[test]
fn the_misra_addon_is_awake() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("bad.c"),
        "int f(int x);\nint f(int x)\n{\n  if (x)\n    return 1;\n  return 0;\n}\n",
    )
    .unwrap();
    let result = Command::new("cppcheck")
        .current_dir(folder.path())
        .args(["--addon=misra", "--enable=all", "bad.c"])
        .output();
    match result {
        Ok(result) => {
            assert!(String::from_utf8_lossy(&result.stderr).contains("misra-c2012-15.5"));
        }
        Err(_) => skip("cppcheck"),
    }
}

#[test]
fn both_compilers_accept_everything() {
    LAMP.compile();
    EVERYTHING.compile_with(CLOCK);
}

proptest! {
    #[test]
    fn any_text_is_translated_or_refused(agent in "\\PC{0,200}", configuration in "\\PC{0,200}") {
        let _ = parse_configuration("agent.conf", &configuration);
        let fixed = parse_configuration("lamp.conf", &LAMP.configuration("")).unwrap();
        let _ = translate(&fixed, &agent);
    }

    #[test]
    fn any_words_of_the_language_are_translated_or_refused(
        words in proptest::collection::vec(
            prop_oneof![
                Just("+!light(X)"), Just("+!"), Just("-"), Just("wait"), Just("level(X)"),
                Just("light(1)"), Just(":"), Just("<-"), Just("."), Just(";"), Just("&"),
                Just("not"), Just("true"), Just("isDark"), Just("switchOn(X)"), Just("X ="),
                Just("!!"), Just("?"), Just("("), Just(")"), Just("_"), Just("\"t\""), Just("-0.5"),
            ],
            0..30,
        )
    ) {
        let fixed = parse_configuration("lamp.conf", &LAMP.configuration("")).unwrap();
        let _ = translate(&fixed, &words.join(" "));
    }
}

const AGED: Case = Case {
    basics: "int64_t now(void); void seen(int64_t);",
    types: "go(void);",
    sections: "peers { leader, wingman }; messages { tell at(int) from any; tell low from any; };
        triggerables { +!go; };",
    agent: "+!go : at(_)[source(leader), age(A)] & low[source(_)] <- seen(A).",
};

const AGED_MAIN: &str = r#"
mod bindings { include!("bindings.rs"); }
use bindings::{Agent, Beliefs, Environment, Message, Peer};
struct World(i64);
impl Environment for World {
    fn update_beliefs(&mut self, _: &mut Beliefs<'_>) {}
    fn now(&mut self) -> i64 { if self.0 == 99 { panic!("no time") } self.0 += 7; self.0 }
    fn seen(&mut self, age: i64) { println!("seen {age}"); }
    fn send(&mut self, _: Peer, _: Message) {}
}
fn main() {
    let mut agent = Agent::new(Peer::Wingman);
    let mut world = World(0);
    println!("{}", agent.receive_tell_at(&mut world, Peer::Wingman as u8, 1));
    println!("{}", agent.receive(&mut world, Peer::Leader, Message::TellAt(4)));
    println!("{} {}", agent.receive_tell_low(Peer::Leader as u8), agent.achieve_go());
    agent.next_step(&mut world);
    println!("{}", world.0);
    world.0 = 99;
    let mut tell = || agent.receive_tell_at(&mut world, Peer::Leader as u8, 4);
    let tell = std::panic::AssertUnwindSafe(&mut tell);
    println!("{}", std::panic::catch_unwind(tell).is_err());
}
"#;

/// The environment is lent to C where it asks for the time, also when a message arrives.
#[test]
fn the_age_of_what_is_told_is_compiled_and_bound() {
    let printed = bound_with("clock = now;", &AGED, AGED_MAIN);
    let words = printed.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(words, "false true true true seen 7 14 true");
    // Only where it is asked for.
    let translation = AGED.translate("clock = now;").unwrap();
    let kept = translation.files[0].text.matches("_told_at = now()").count();
    assert_eq!(kept, 1, "{}", translation.files[0].text);
}
