//! Names and texts designed to be mistaken for generated C or Rust: either they are refused with their line,
//! or the C behaves as the agent specifies.

use std::process::Command;

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use translator::{TranslateError, Translation, parse_configuration, translate};

use crate::harness::{Case, STRICT, from_environment};

fn translated(configuration: &str, agent: &str) -> Result<Translation, TranslateError> {
    translate(&parse_configuration("a.conf", configuration)?, agent)
}

/// Compiles all C of a translation separately, and includes both headers together.
fn compile(translation: &Translation) -> Result<(), String> {
    let folder = tempfile::tempdir().unwrap();
    for file in &translation.files {
        let path = folder.path().join(&file.name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, &file.text).unwrap();
    }
    let [source, header, basics, ..] = &translation.files[..] else { panic!("files are missing") };
    let main = format!("#include \"{}\"\n#include \"{}\"\n", basics.name, header.name);
    std::fs::write(folder.path().join("both.c"), main + "int unused;\n").unwrap();
    for compiler in ["gcc", "clang"] {
        // Compilers report unused functions only after a complete compilation.
        for unit in [source.name.as_str(), "both.c"] {
            let mut command = Command::new(compiler);
            command.current_dir(folder.path()).args(STRICT);
            command.args(["-O1", "-c", "-o", "unit.o", unit]);
            let Ok(output) = command.output() else { continue };
            if !output.status.success() {
                let message = String::from_utf8_lossy(&output.stderr);
                return Err(format!("{compiler}: {message}\n{}", source.text));
            }
        }
    }
    Ok(())
}

#[test]
fn a_variable_that_is_bound_again_is_no_other_variable() {
    let case = Case {
        basics: "void act2(int, int);",
        types: "g(int); b(int); c(int);",
        sections: "",
        agent: "b(7). c(9). !g(1).\n\
                +!g(_) : not b(8) & not (b(X) & X > 8) & c(X_2) & b(X) <- act2(X, X_2).",
    };
    assert_eq!(case.run("", "next_step();"), "act2(7,9)");
    let case = Case {
        agent: "b(7). c(9). !g(1).\n\
                +!g(_) : (b(X) | c(X)) & c(X_2) & (c(Var_X) | b(Var_X)) & not (c(Y) & Y < 3) & b(Y) & c(Y_2)\n\
                  <- act2(X, X_2); act2(Var_X, X); act2(Y, Y_2).",
        ..case
    };
    assert_eq!(case.run("", "next_step();"), "act2(7,9) act2(9,7) act2(7,9)");
    case.compile();
}

#[test]
fn plans_of_test_goals_have_names_of_their_own() {
    let case = Case {
        basics: "void act(int);",
        types: "g(void); b(int); b_o(void); o_b(void); q(int, int); q_io(void); io_q(void); x(int); failed_x(int); n_b(void);",
        sections: "",
        agent: "!g.\n+!g <- ?b(X); act(X); ?b_o; ?o_b; ?n_b; ?q(1, Y); act(Y); ?q_io; ?io_q; ?x(Z); act(Z); ?failed_x(V); act(V).\n\
                +?b(X) <- X = 1. +?b_o <- act(2). +?o_b <- act(3). +?n_b <- act(4).\n\
                +?q(A, B) <- B = A + 4. +?q_io <- act(6). +?io_q <- act(7).\n\
                +?x(X) : b(X). -?x(X) <- X = 8. +?failed_x(X) <- X = 9.\n",
    };
    assert_eq!(
        case.run("", "next_step();"),
        "act(1) act(2) act(3) act(4) act(5) act(6) act(7) act(8) act(9)"
    );
    case.compile();
}

#[test]
fn headers_have_guards_of_their_own() {
    let configuration = "settings { input = a; output = out/my.c; header = my-agent.h; basics = inc/my_agent.h; };\n\
        basics { void act(int); }; types { g(void); }; triggerables { +!g; };";
    let translation = translated(configuration, "+!g <- act(1).").unwrap();
    assert_eq!(compile(&translation), Ok(()));
    assert!(translation.files[2].text.contains("void act(int argument1);"));
    assert!(
        translation.files[0]
            .text
            .contains("#include \"../my-agent.h\"\n#include \"../inc/my_agent.h\"\n")
    );
}

#[test]
fn comments_stay_comments() {
    for agent in [
        "!g. // first\n+!g /* see *\\ int f(void){ return 1; } \\* */ <- say(\"x\").",
        "!g.\n+!g // see *\\ int f(void){ return 1; } \\*\n <- say(\"x\").",
        "!g. +!g <- say(\"*\\\\\").",
        "!g. +!g <- say(\"5*\\n\").",
        "!g. +!g // ???/\n <- say(\"???/\").",
        "!g. +!g // \\*/ \n <- say(\"\\\\*/\").",
        "!g. +!g // a \u{202e} b \u{2066}\n <- say(\"\u{202e}\").",
        "!g. +!g // \\\n <- say(\"/*//*\").",
    ] {
        let configuration = "settings { input = a; output = a.c; header = a.h; basics = b.h; rust = a.rs; instance = context; };\n\
            basics { void say(const char *); }; types { g(void); };";
        let translation = translated(configuration, agent).unwrap();
        assert_eq!(compile(&translation), Ok(()), "{agent}");
        assert!(!translation.files[0].text.contains("\nint f("), "{agent}");
        for file in &translation.files {
            assert!(!file.text.contains(['\u{202e}', '\u{2066}']), "{}", file.name);
        }
    }
    let configuration = "settings { input = *\u{202e}/evil; output = a.c; header = a.h; basics = b.h; };\n\
            basics { void say(const char *); }; types { g(void); };";
    assert_eq!(compile(&translated(configuration, "!g. +!g.").unwrap()), Ok(()));
}

/// `settings` and `sections` of a configuration that must be refused, and the start of the first error.
#[track_caller]
fn refused(settings: &str, sections: &str, expected: &str) {
    let configuration = format!("settings {{ {settings} }};\n{sections}\n");
    let error = translated(&configuration, "!g. +!g.").map(|_| "accepted").unwrap_err().to_string();
    let lines: Vec<&str> = error.lines().collect();
    let first = lines.iter().position(|line| line.starts_with("error: ")).unwrap();
    assert!(lines[first].starts_with(&format!("error: {expected}")), "{configuration}\n{error}");
    let line = if sections.is_empty() { "a.conf:1:" } else { "a.conf:2:" };
    assert!(lines[first + 1].contains(line), "{error}");
}

const FILES: &str = "input = a.asl; output = a.c; header = a.h; basics = b.h;";

#[test]
fn names_of_c_and_of_ours_are_refused() {
    for name in [
        "uint32_t",
        "INT32_MAX",
        "printf",
        "abs",
        "round",
        "log",
        "sinl",
        "malloc",
        "exit",
        "agent_t",
        "event_t",
        "outcome_t",
        "EVENT_NONE",
        "OUTCOME_FAILED",
        "ASL2C_A_H",
        "size_t",
        "plan1_x",
        "var_X",
        "self",
    ] {
        let expected = format!("`{name}` ");
        refused(
            FILES,
            &format!("basics {{ void {name}(void); }}; types {{ g(void); }};"),
            &expected,
        );
        let structs = format!("structs {{ {name} {{ int x; }}; }}; types {{ g(void); }};");
        refused(FILES, &structs, &format!("`{name}` cannot be the name of a struct"));
    }
    refused(
        FILES,
        "basics { void p(void); }; structs { p { int x; }; }; types { g(void); };",
        "`p` cannot be",
    );
    refused(FILES, "structs { p { int INT8_MAX; }; }; types { g(void); };", "`INT8_MAX` cannot be");
    refused(FILES, "types { g(void); b(event_t); };", "the type `event_t` may clash");
    refused(FILES, "basics { void t(void); }; types { g(void); b(t); };", "the type `t` may clash");
    for stem in ["run", "plan1", "post", "equal", "checked", "defer", "limit"] {
        let settings = format!(
            "input = a; header = a.h; basics = b.h; output = {stem}.c; instance = context;"
        );
        let configuration = format!("settings {{ {settings} }}; types {{ g(void); }};");
        let error = translated(&configuration, "!g. +!g.").unwrap_err().to_string();
        assert!(error.starts_with(&format!("error: names that begin with `{stem}_`")), "{error}");
    }
}

#[test]
fn types_that_are_none_are_refused() {
    for (ctype, expected) in [
        ("const int", "`const` has no effect on a value"),
        ("int x", "not a type"),
        ("short double", "not a type"),
        ("while", "not a type"),
        ("struct", "not a type"),
        ("int * const", "not a type"),
    ] {
        refused(FILES, &format!("basics {{ void f({ctype}); }}; types {{ g(void); }};"), expected);
        refused(FILES, &format!("types {{ g(void); b({ctype}); }};"), expected);
    }
    for ctype in [
        "long",
        "unsigned long int",
        "struct foo *",
        "const foo_t *",
        "void *",
        "size_t",
        "long double",
    ] {
        let configuration = format!(
            "settings {{ {FILES} }}; basics {{ void f({ctype}); }}; types {{ g(void); b({ctype}); }};"
        );
        assert!(translated(&configuration, "!g. +!g : b(X) <- f(X).").is_ok(), "{ctype}");
    }
    // Strings are not allowed for numbers.
    let configuration =
        format!("settings {{ {FILES} }}; basics {{ void f(long); }}; types {{ g(void); }};");
    assert!(translated(&configuration, "!g. +!g <- f(\"x\").").is_err());
}

#[test]
fn settings_are_read_once_and_as_they_stand() {
    let types = "types { g(void); };";
    refused(
        "input = a; output = a.c; header = a.h; basics = a.h;",
        "",
        "`basics` and `header` are the same file",
    );
    refused(
        "input = a; output = ./a.c; header = a.h; basics = b.h;",
        "",
        "`output` is not a plain file name",
    );
    refused(
        "input = a; output = ../a.c; header = a.h; basics = b.h;",
        "",
        "`output` is outside the output folder",
    );
    refused(
        "input = a; output = /tmp/a.c; header = a.h; basics = b.h;",
        "",
        "`output` is outside the output folder",
    );
    refused(&format!("{FILES} matrix = /tmp/m;"), "", "`matrix` is outside the output folder");
    refused(
        &format!("{FILES} rust = a.c; instance = context;"),
        "",
        "`rust` and `output` are the same file",
    );
    refused(
        &format!("{FILES} rust = m.csv; matrix = m; instance = context;"),
        "",
        "`matrix` and `rust` are the same file",
    );
    refused(
        "input = a; output = a*/b.c; header = a.h; basics = b.h;",
        "",
        "`output` is not a valid file name",
    );
    refused(&format!("{FILES} input = b;"), "", "a second setting `input`");
    refused(&format!("{FILES} inbox = 2; max_events = 3;"), "", "`inbox` and `max_events` exclude");
    refused("output = a.c; header = a.h; basics = b.h;", "", "the setting `input` is missing");
    refused(FILES, &format!("{types} settables {{ b; b; }};"), "`b` is listed twice");
    refused(
        FILES,
        &format!("{types} settables {{ b; }}; perceived {{ b; b; }};"),
        "`b` is listed twice",
    );
    refused(
        FILES,
        &format!("{types} triggerables {{ +!g; }}; preemptive {{ +!g; +!g; }};"),
        "this trigger is listed twice",
    );
    refused(
        FILES,
        &format!("{types} basics {{ void a(void); }}; classes {{ a: a; }};"),
        "`a` is an action, not a class",
    );
    for settings in
        ["inbox = 2 /*x*/;", "inbox = 2 // x\n;", "inbox = \"2\";", "inbox = 2/* ; */ ;"]
    {
        let configuration = format!("\u{feff}settings {{ {FILES} {settings} }}; {types}");
        assert!(translated(&configuration, "!g. +!g.").is_ok(), "{settings}");
    }
    let twice = translated(&format!("settings {{ {FILES} }}; {types}"), "!g.\n@l +!g.\n@l +!g.")
        .unwrap_err()
        .to_string();
    assert!(twice.contains("error: a second plan `@l`\n --> a.asl:3:2"), "{twice}");
}

#[test]
fn words_of_rust_are_refused() {
    let rust = format!("{FILES} rust = a.rs; instance = context;");
    for (sections, expected) in [
        (
            "basics { void match(void); }; types { g(void); };",
            "`match` cannot be called `match` in Rust",
        ),
        (
            "basics { void sendIt(void); void send_it(void); }; types { g(void); };",
            "`send_it` cannot be called `send_it`",
        ),
        (
            "basics { void update_beliefs(void); }; types { g(void); };",
            "`update_beliefs` may clash",
        ),
        ("structs { agent { int x; }; }; types { g(void); };", "`agent` cannot be"),
        ("structs { environment { int x; }; }; types { g(void); };", "`environment` cannot be"),
        ("structs { state { int x; }; }; types { g(void); };", "`state` cannot be called `State`"),
        ("structs { box { int x; }; }; types { g(void); };", "`box` cannot be called `Box`"),
        ("structs { p_t { int type; }; }; types { g(void); };", "`type` cannot be called `type`"),
        (
            "structs { p_t { int x; }; pT { int x; }; }; types { g(void); };",
            "`pT` cannot be called `PT`",
        ),
        (
            "types { g(void); aB(void); a_b(void); }; settables { aB; a_b; };",
            "`a_b` cannot be called `set_a_b`",
        ),
        (
            "types { g(void); }; peers { x, y }; messages { tell a1 from x; tell a_1 from x; };",
            "`a_1` cannot be called `TellA1`",
        ),
        (
            "structs { message { int x; }; }; types { g(void); }; peers { x, y }; messages { tell b from x; };",
            "`message` cannot be called `Message`",
        ),
        ("types { g(void); }; peers { x, aLL };", "`aLL` cannot be called `ALL`"),
    ] {
        refused(&rust, sections, expected);
    }
}

/// Text that looks like the state is not a use of the state.
#[test]
fn a_plan_that_speaks_of_self_need_not_use_it() {
    let configuration = format!(
        "settings {{ {FILES} instance = context; }};\nbasics {{ void say(const char *); bool ask(int); }};\n\
         types {{ g(int); }}; triggerables {{ +!g; }};"
    );
    let agent = "+!g(Myself) : Myself > 3 <- true.\n+!g(1) <- +h.\n+!g(_) <- say(\"self->x\").\n";
    let configuration = configuration.replace("g(int);", "g(int); h(void);");
    assert_eq!(compile(&translated(&configuration, agent).unwrap()), Ok(()));
}

/// Values that are not compared need no comparison function.
#[test]
fn what_is_not_compared_needs_no_helper() {
    for (basics, types, structs) in [
        (
            "void act(int); double read(void); handle_t get(void);",
            "g(void); b(double, handle_t);",
            "",
        ),
        (
            "void act(int); p_t read(void); handle_t get(void);",
            "g(void); b(p_t, handle_t);",
            "structs { p_t { double x; }; };",
        ),
        (
            "void act(int); double read(void); const char *get(void);",
            "g(void); b(double, const char *);",
            "",
        ),
    ] {
        for perceived in ["", "settables { b; }; perceived { b; };"] {
            let configuration = format!(
                "settings {{ {FILES} }}; includes {{ #include \"handle.h\" }}; {structs} basics {{ {basics} }};\n\
                 types {{ {types} }}; {perceived}"
            );
            let mut translation =
                translated(&configuration, "!g. +!g <- +b(read, get). +b(_, _) <- act(1).")
                    .unwrap();
            let mut handle = translation.files[1].clone();
            handle.name = "handle.h".to_owned();
            handle.text =
                "#ifndef HANDLE\n#define HANDLE\ntypedef struct { void *p; } handle_t;\n#endif\n"
                    .to_owned();
            translation.files.push(handle);
            assert_eq!(compile(&translation), Ok(()));
        }
    }
}

/// Mutations of the agents of the conformance suite: words removed, doubled, exchanged, inserted.
/// `ASL2C_FUZZ=1800` runs for that number of seconds.
#[test]
#[allow(clippy::disallowed_methods, reason = "it ends when the time is over")]
fn whatever_is_accepted_compiles() {
    let seconds = u64::from(from_environment("ASL2C_FUZZ", 3));
    let mut random = u64::from(from_environment("ASL2C_FUZZ_SEED", 1)) | 0x5851_F42D_4C95_7F2D;
    let mut below = |count: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        usize::try_from((random >> 11) % count as u64).unwrap()
    };
    let agents = crate::conformance::agents();
    let split = |text: &str| -> Vec<String> {
        let mut words: Vec<String> = Vec::new();
        for character in text.chars() {
            let word = character.is_ascii_alphanumeric() || character == '_' || character == '"';
            match words.last_mut() {
                Some(last)
                    if word && last.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_') =>
                {
                    last.push(character);
                }
                _ => words.push(character.to_string()),
            }
        }
        words
    };
    let pool: Vec<String> = agents.iter().flat_map(|agent| split(agent)).collect();
    let sections = [
        "",
        "settables { b; p; };",
        "settables { b; }; perceived { b; };",
        "structs { p_t { int x; float y; }; };",
    ];
    let begin = std::time::Instant::now();
    let (mut tried, mut accepted) = (0_u32, 0_u32);
    while begin.elapsed().as_secs() < seconds {
        tried += 1;
        let mut words = split(&agents[below(agents.len())]);
        for _ in 0..=below(4) {
            let place = below(words.len());
            match below(5) {
                0 => _ = words.remove(place),
                1 => words.insert(place, words[place].clone()),
                2 => words.insert(place, pool[below(pool.len())].clone()),
                3 => words[place] = pool[below(pool.len())].clone(),
                _ => {
                    let other = below(words.len());
                    words.swap(place, other);
                }
            }
            if words.is_empty() {
                break;
            }
        }
        let agent = words.concat();
        let settings = [
            "inbox = 2;",
            "max_events = 2;",
            "instance = context;",
            "instance = context; max_events = 1;",
        ];
        let raised: Vec<&str> = ["+!g", "+!gi", "+b", "-b", "+!h"]
            .into_iter()
            .filter(|event| {
                !event.contains('!')
                    || agent.contains(&format!("{event}("))
                    || agent.contains(&format!("{event} "))
            })
            .collect();
        let configuration = format!(
            "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; clock = now; {} }};\n\
             basics {{ {} }};\ntypes {{ {} }};\n{}\ntriggerables {{ {}; }};\n",
            settings[below(settings.len())],
            crate::conformance::BASICS,
            crate::conformance::TYPES,
            sections[below(sections.len())],
            raised.join("; ")
        );
        if let Ok(translation) = translated(&configuration, &agent) {
            accepted += 1;
            if let Err(error) = compile(&translation) {
                panic!("{configuration}\n{agent}\n{error}");
            }
        }
    }
    assert!(accepted > 0 && accepted < tried);
    println!("{accepted} of {tried} accepted in {seconds} s, and compiled");
}

/// Names that collide with something, or nearly.
const HOSTILE: &[&str] = &[
    "x",
    "X_2",
    "x_2",
    "b",
    "b_o",
    "o_b",
    "q_io",
    "failed_x",
    "event",
    "value1",
    "answer1",
    "holds1",
    "changed1",
    "outcome",
    "outcome1",
    "argument1",
    "self",
    "agent",
    "environment",
    "init",
    "clear",
    "slot",
    "round",
    "left",
    "right",
    "result",
    "valid",
    "posted",
    "posted_achieve_x",
    "inbox",
    "inbox_queue",
    "deferred",
    "limited",
    "deadline",
    "achieve_x",
    "add_x",
    "run_achieve_x",
    "plan1_achieve_x",
    "post_x",
    "equal_double",
    "checked_add_int",
    "set_x",
    "x_wait1",
    "x_pending",
    "belief_x",
    "held",
    "x_held",
    "x_1",
    "x_1_1",
    "unnamed1",
    "var_x",
    "var2_x",
    "index",
    "y1",
    "time",
    "printf",
    "bool",
    "int",
    "goto",
    "uint8_t",
    "INT8_MAX",
    "EVENT_NONE",
    "EVENT_POSTED_achieve_x",
    "agent_t",
    "event_t",
    "outcome_t",
    "unhandled",
    "refused",
    "aborted",
    "take_event",
    "forget_events",
    "next_step",
    "step",
    "reached1",
    "match",
    "type",
    "state",
    "a",
    "aA",
    "a_a",
    "main",
    "errno",
    "assert",
    "and",
    "xor",
    "class",
    "new",
    "unix",
    "linux",
    "I",
    "NAN",
    "signal",
    "_x",
    "x__y",
    "test",
    "untest_n_x",
    "fail_x",
    "handled",
    "accepted",
];

/// Any combination of names is refused, or both compilers accept the C.
#[test]
fn hostile_names_are_refused_or_compile() {
    let cases = from_environment("ASL2C_HOSTILE", 60);
    let name = || prop::sample::select(HOSTILE);
    let variables = prop::sample::select(&["X", "X_2", "Var_X", "Y", "Value1", "X_2_2", "XX"][..]);
    let strategy = (
        prop::collection::vec(prop::option::weighted(0.2, name()), 12),
        prop::collection::vec(variables, 6),
        prop::sample::select(
            &["a", "run", "my-x", "init", "x", "event", "int", "_", "plan1", "EVENT", "take"][..],
        ),
        any::<[bool; 3]>(),
    );
    let accepted = std::cell::Cell::new(0_u32);
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new(config)
        .run(&strategy, |(names, variables, stem, [context, queue, perceived])| {
            let usual = ["act", "now", "g", "h", "b", "c", "d", "q", "p_t", "field", "other", "label"];
            let names: Vec<&str> =
                names.iter().zip(usual).map(|(name, usual)| name.unwrap_or(usual)).collect();
            let [act, f, g, h, b, c, d, q, p, field, other, label] = names[..] else { unreachable!() };
            let [x, y, z, u, v, w] = variables[..] else { unreachable!() };
            let instance = if context { "context" } else { "static" };
            let events = if queue { "max_events = 2;" } else { "inbox = 2;" };
            let perceived = if perceived { b } else { "" };
            let configuration = format!(
                "settings {{ input = a.asl; output = {stem}.c; header = {stem}.h; basics = x{stem}.h; instance = {instance};\n\
                 {events} clock = {f}; }};\n\
                 structs {{ {p} {{ int {field}; double {other}; }}; }};\n\
                 basics {{ void {act}(int, {p}); int64_t {f}(void); {p} z9(void); }};\n\
                 types {{ {g}(int); {h}(int); {b}(int); {c}(double, {p}); {d}(int); {q}(int, int); }};\n\
                 settables {{ {b}; {c}; }}; perceived {{ {perceived}{} }}; triggerables {{ +!{g}; +{b}; -{d}; }};\n",
                if perceived.is_empty() { "" } else { ";" }
            );
            let agent = format!(
                "{b}(1). !{g}(2).\n\
                 @{label} +!{g}({x}) : not ({b}({y}) & {y} > 3) & {b}({y}) & ({d}({z}) | {b}({z}))\n\
                   <- ?{q}(1, {u}); {act}({u} + 1, z9); !!{h}(2); +{b}({y} + 1); .wait(5); +{c}(1.5, z9); !{h}({x}).\n\
                 +!{h}({v}) : {c}(_, {w}) <- {act}({v}, {w}); !{h}({v})[deadline(3)].\n-!{h}({v}) <- {act}({v}, z9).\n\
                 +{b}({x}) : {d}({x}) <- -{d}(_).\n+?{q}({x}, {y}) <- {y} = {x} * 2.\n-?{q}({x}, {y}) : {b}({y}) & {b}({x}).\n"
            );
            match translated(&configuration, &agent) {
                Err(_) => Ok(()),
                Ok(translation) => {
                    accepted.set(accepted.get() + 1);
                    compile(&translation)
                        .map_err(|error| TestCaseError::fail(format!("{configuration}\n{agent}\n{error}")))
                }
            }
        })
        .unwrap_or_else(|error| panic!("{error}"));
    let accepted = accepted.get();
    assert!(accepted > 0, "none of {cases} was accepted");
    println!("{accepted} of {cases} accepted, and compiled");
}
