//! Results and output of `asl2c verify`.

use std::path::Path;
use std::process::{Command, Output};

use translator::{model, parse_configuration};

use crate::harness::skip;

/// An agent that can switch a lamp, with a property.
fn configuration(settings: &str, sections: &str, agent: &str, property: &str) -> String {
    let events = ["+!light", "+!dim", "+flag", "-flag"];
    let raised = events.iter().filter(|event| agent.lines().any(|line| line.starts_with(**event)));
    let raised: String = raised.map(|event| format!("{event}; ")).collect();
    format!(
        "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; {settings} }};\n\
         basics {{ void on(void); void off(void); void idle(void); bool dark(void); int64_t now(void); \
         bool flash(int); int read(void); }};\n\
         classes {{ shows: on, flash; }};\n\
         types {{ light(void); dim(int); level(int); limit(int); asked(int); flag(void); wait(void); inner(void); inner2(int); }};\n\
         triggerables {{ {raised}}};\n{sections}\n\
         properties {{ p [R-1]: {property}; }};\n"
    )
}

/// Runs `asl2c verify`; [skipped](skip) without SPIN.
fn verify(configuration: &str, agent: &str, options: &[&str]) -> Option<Output> {
    if Command::new("spin").arg("-V").output().is_err() {
        skip("spin");
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.conf"), configuration).unwrap();
    std::fs::write(folder.path().join("a.asl"), agent).unwrap();
    Some(run(folder.path(), options))
}

fn run(folder: &Path, options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asl2c"))
        .arg("verify")
        .args(options)
        .arg("a.conf")
        .current_dir(folder)
        .output()
        .unwrap()
}

const WAITING: &str = "!wait.\n+!wait <- idle; !!wait.\n";

/// Checks a property of an agent with an additional idle plan.
#[track_caller]
fn check(settings: &str, sections: &str, plans: &str, property: &str, holds: bool) {
    // Each plan on its own line; beliefs come first.
    let plans = plans.replace(". ", ".\n");
    let (beliefs, plans): (Vec<&str>, Vec<&str>) =
        plans.lines().partition(|line| !line.starts_with(['+', '-']));
    let agent = format!("{}\n{WAITING}{}\n", beliefs.join("\n"), plans.join("\n"));
    let Some(output) = verify(&configuration(settings, sections, &agent, property), &agent, &[])
    else {
        return;
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let expected = if holds { "p [R-1]: holds" } else { "p [R-1]: DOES NOT HOLD" };
    assert!(
        text.starts_with(expected),
        "{agent}\n{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(output.status.success(), holds);
}

const PREEMPTIVE: &str = "preemptive { +!light; };";

#[test]
fn a_failure_is_told_in_the_agents_own_terms() {
    let agent = "!wait.\n+!wait\n  <- idle;\n     !!wait.\n+!light : dark\n  <- on.\n+!light\n  <- idle;\n     ?asked(1).\n";
    let configuration = configuration("", PREEMPTIVE, agent, "within(1, +!light, on)");
    let Some(output) = verify(&configuration, agent, &[]) else { return };
    insta::assert_snapshot!(String::from_utf8_lossy(&output.stdout), @r"
    p [R-1]: DOES NOT HOLD
      within(1, +!light, on)
      counterexample (a.asl):
        the environment raises +!light
        step 1
          handles +!light
          line 7: plan +!light
            line 8: idle
            line 9: fails
    (a counterexample is one of the model, which has no values: `asl2c prove` tells whether the agent does it)
    ");
    let Some(output) = verify(&configuration, agent, &["--json"]) else { return };
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["version"], 1);
    let property = &json["properties"][0];
    assert_eq!((&property["name"], &property["verdict"]), (&"p".into(), &"fails".into()));
    assert_eq!(property["trace"][4]["line"], 8);
}

#[test]
fn events_come_in_the_order_of_the_cycle() {
    // Pre-empting events come first; the inbox comes before deferred goals.
    check("", PREEMPTIVE, "+!light <- on.", "within(1, +!light, on)", true);
    check("", "", "+!light <- on.", "within(1, +!light, on)", false);
    check("", "", "+!light <- on.", "within(2, +!light, on)", true);
    // An event that is already pending is served first.
    check("inbox = 2;", "", "+!light <- on. +!dim(_) <- off.", "within(2, +!light, on)", false);
    check("inbox = 2;", "", "+!light <- on. +!dim(_) <- off.", "within(3, +!light, on)", true);
    // A posted event delays the inbox.
    check("", "", "+!light <- on. +!dim(X) <- off; !dim(X).", "within(9, +!light, on)", false);
    // In queue mode so does an earlier deferred goal.
    check(
        "max_events = 2;",
        "",
        "+!light <- on. +!dim(_) <- off.",
        "within(2, +!light, on)",
        false,
    );
    check("max_events = 2;", "", "+!light <- on. +!dim(_) <- off.", "within(3, +!light, on)", true);
}

#[test]
fn failure_is_mended_or_is_not() {
    check("", "", "+!light <- ?asked(1); on.", "all_handled", false);
    check("", "", "+!light <- ?asked(1); on. -!light <- off.", "all_handled", true);
    check("", "", "+!light : dark <- on.", "all_handled", false);
    check("", "", "+!light : dark <- on. +!light : not dark <- off.", "all_handled", false);
    check("", "", "+!light : flag <- on. +!light : not flag <- off.", "all_handled", true);
    check(
        "",
        "",
        "+!light <- !inner; on. +!inner : dark <- off. -!light <- off.",
        "exactly_one(idle)",
        false,
    );
    // If no value matches, the plans are asked.
    check(
        "",
        "",
        "+!light <- ?asked(X); +level(X); on. +?asked(X) <- X = 1; off.",
        "all_handled",
        true,
    );
    // A division may have no result.
    check("", "", "+!dim(X) <- +level(10 / X); on. +!light <- idle.", "all_handled", false);
}

#[test]
fn beliefs_are_followed_and_their_values_are_free() {
    check("", "", "+flag <- on. -flag <- off.", "only_after(off, +flag)", true);
    check("", "", "+!light : flag <- on. +flag <- idle.", "only_after(on, +flag)", true);
    check(
        "",
        "",
        "+!light : flag <- on. +flag <- idle. +!dim(_) <- +flag.",
        "only_after(on, +flag)",
        false,
    );
    check("", "", "level(1). +!light : level(2) <- on.", "never(on)", false);
    check("", "", "+!light : level(_) <- on.", "never(on)", true);
    check(
        "",
        "settables { level; }; perceived { level; };",
        "+level(_) <- on.",
        "never(on)",
        false,
    );
    // A belief triggers its plans only if it changes.
    check("", "", "+!light <- +flag; -flag. +flag <- on. -flag <- off.", "at_most_one(on)", true);
    check("", "", "+!light <- +flag; +flag. +flag <- on.", "at_most_one(on)", true);
    check("", "", "+!dim(X) <- +level(X); +level(1). +level(_) <- on.", "at_most_one(on)", false);
}

#[test]
fn the_comparisons_of_properties_are_remembered() {
    let sections = "settables { level; };";
    let watching = "limit(5).\n+!light : level(X) & limit(Y) & X <= Y <- on.\n+!light <- off.\n";
    // The idle step may come first.
    let lowers = "within(1, level <= limit, on, idle)";
    check("", sections, watching, lowers, true);
    check("", sections, &watching.replace("X <= Y", "Y >= X"), lowers, true);
    check("", sections, &watching.replace("X <= Y", "not X > Y"), lowers, true);
    check("", sections, &watching.replace("X <= Y", "X < Y"), lowers, false);
    // Also with numbers, whichever belief a plan compares with.
    for below in ["within(1, level <= 5, on, idle)", "within(1, level < -2, on, idle)"] {
        check("", sections, watching, below, true);
        check("", sections, &watching.replace("limit(Y) & X <= Y", "X <= 5"), below, true);
        check("", sections, &watching.replace("limit(5)", "limit(-3)"), below, false);
    }
    let adds = format!("{watching}+!dim(X) <- +limit(X); idle.");
    check("", sections, &adds, "within(1, level <= 5, on, idle)", false);
    check("", sections, watching, "within(1, level <= 6, on, idle)", false);
    check("", "", "level(3).\n+!light <- on.", "within(1, level < 4, on)", false);
    check("", "", "level(3).\n+!light <- on.", "within(1, level > 4, on)", true);
    // Initial beliefs are compared from the start.
    check("", "", "level(3).\nlimit(5).\n+!light <- on.", "within(1, level <= limit, on)", false);
}

#[test]
fn of_what_holds_nothing_is_said_if_only_failures_are_wanted() {
    let agent = format!("{WAITING}+!light <- on.\n");
    let configuration =
        configuration("", PREEMPTIVE, &agent, "within(1, +!light, on); q: never(on)");
    let Some(output) = verify(&configuration, &agent, &["-q"]) else { return };
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.starts_with("q: DOES NOT HOLD") && !text.contains("p [R-1]"), "{text}");
    assert_eq!(output.status.code(), Some(1));
}

/// A property that compares with a constant limit gives the same result as one that compares with its number.
#[test]
fn what_is_known_does_not_depend_on_other_properties() {
    let agent = |compared: &str| {
        format!(
            "level(0).\nlimit(2000).\n!wait.\n\
             +!wait : level(X) & limit(L) & {compared} <- on; !!wait.\n+!wait <- idle; !!wait.\n"
        )
    };
    let number = "within(1, level > 2000, on)";
    for (compared, other, holds) in [
        ("X > L", "within(1, level > limit, on)", true),
        ("L < X", "within(1, limit < level, on)", true),
        ("X > 2000", "within(1, level > limit, on)", true),
        ("X > L", "within(1, level >= limit, on)", false),
    ] {
        let agent = agent(compared);
        for (property, expected) in [
            (format!("{number}; q: {other}"), ["holds", if holds { "holds" } else { "DOES" }]),
            (format!("{other}; q: {number}"), [if holds { "holds" } else { "DOES" }, "holds"]),
        ] {
            let configuration = configuration("", "settables { level; };", &agent, &property);
            let Some(output) = verify(&configuration, &agent, &[]) else { return };
            let text = String::from_utf8_lossy(&output.stdout);
            for (name, expected) in ["p [R-1]", "q"].iter().zip(expected) {
                assert!(text.contains(&format!("{name}: {expected}")), "{property}\n{agent}{text}");
            }
        }
    }
}

/// A function with a result is an action too, wherever it is called.
#[test]
fn calls_that_return_a_value_are_counted() {
    for (plans, holds) in [
        ("+!light <- flash(1).", false),
        ("+!light <- X = flash(1); on.", false),
        ("+!light : flash(1) <- on.", false),
        ("+!light : flag & not (dark & flash(1)) <- on. +flag.", false),
        ("+!light : dark | flash(1) <- on.", false),
        ("+!light : X = flash(1) <- on.", false),
        ("+!dim(X) : dark <- on. +!dim(X) : flash(X) <- off. +!light.", false),
        ("+!light <- off.", true),
    ] {
        check("", "", plans, "never(flash)", holds);
    }
    for (plans, holds) in [
        ("+!dim(X) <- +level(read).", false),
        ("+!dim(X) <- +level(X + read / 2).", false),
        ("+!dim(X) <- !inner2(read). +!inner2(_) <- on.", false),
        ("+!dim(X) <- !!dim(read).", false),
        ("+!dim(X) <- ?level(read).", false),
        ("level(1). +!dim(X) <- -level(read).", false),
        ("+!dim(read) <- on.", false),
        ("+!dim(X) : level(read) <- on. +!light <- +level(1).", false),
        ("+!dim(X) : X > read <- on.", false),
        ("+!dim(X) <- flash(read).", false),
        ("+!dim(X) <- on.", true),
    ] {
        check("", "", plans, "never(read)", holds);
    }
    // Also by class, and as cause, answer and end of a permission.
    check("", "", "+!light <- on; X = flash(1); idle.", "at_most_one(shows)", false);
    check("", "", "+!light <- X = flash(1); idle.", "at_most_one(shows)", true);
    check("", "", "+!light <- X = flash(1); !!light.", "within(1, flash, shows, idle)", true);
    check("", "", "+!light <- X = flash(1); off.", "within(1, off, on)", false);
    check("", "", "+!light <- flash(1).", "within(2, +!light, flash)", true);
    check(
        "",
        "",
        "+!light <- off; flash(1). +!dim(_) <- on.",
        "only_after(off, +!light, until flash)",
        true,
    );
    check(
        "",
        "",
        "+!light <- off; flash(1). +!dim(_) <- off.",
        "only_after(off, +!light, until flash)",
        false,
    );
    // A failure before the call prevents the call.
    check("", "", "+!dim(X) <- flash(1 / X). +!light.", "at_most_one(flash)", true);
}

/// The clock and the trace function are called by generated code, not by plans.
#[test]
fn calls_of_our_own_are_counted() {
    let limited =
        "+!light <- !dim(1)[deadline(10)]. +!dim(X) <- !dim(X)[deadline(5)]. -!dim(_) <- on.";
    check("clock = now;", "", limited, "at_most_one(now)", false);
    check("clock = now;", "", "+!light <- .wait(3); on.", "never(now)", false);
    check("trace = told;", "", "+!light <- on.", "never(told)", false);
    check("trace = told;", "", "+!light <- on.", "at_most_one(told)", true);
}

/// An event that does not fit into the queue is lost, and the model covers it.
#[test]
fn a_full_queue_loses_goals() {
    let queue = "max_events = 1;";
    check(
        queue,
        "",
        "+!light <- !!dim(1); !!dim(2); !!light. +!dim(_) <- on.",
        "all_handled",
        false,
    );
    check(queue, "", "+!light <- !!dim(1); !!dim(2). +!dim(_) <- on.", "all_handled", true);
    check("", "", "+!light <- !!dim(1); !!dim(2); !!light. +!dim(_) <- on.", "all_handled", true);
}

/// Queries that beliefs always answer need no plans.
#[test]
fn plans_of_what_is_always_believed_are_never_asked() {
    check(
        "",
        "",
        "level(1). +!light <- ?level(X); on. +?level(X) <- X = 2; off.",
        "never(off)",
        true,
    );
}

#[test]
fn time_can_be_over_and_need_not_be() {
    let clock = "clock = now;";
    let waits = "+!light <- on; .wait(100); off.";
    check(clock, "", waits, "only_after(off, +!light)", true);
    check(clock, "", waits, "within(5, on, off)", false);
    let limited = "+!light <- on; !dim(1)[deadline(10)]. +!dim(X) : dark <- off; !dim(X).\n\
                   +!dim(_) <- idle. -!dim(_) <- idle.\n-!light <- idle.";
    check(clock, "", limited, "all_handled", true);
    check(clock, "", &limited.replace("-!dim(_) <- idle.", ""), "all_handled", false);
}

#[test]
fn what_cannot_be_checked_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &[]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot read a.conf"));
    assert_eq!(output.status.code(), Some(3));
    let text = configuration("", "", WAITING, "within(1, level <= flag, on)");
    let error = model(&parse_configuration("a.conf", &text).unwrap(), WAITING).unwrap_err();
    let places: Vec<String> =
        error.to_string().lines().filter(|l| l.starts_with("error")).map(str::to_owned).collect();
    assert_eq!(
        places,
        [
            "error: `level` is never believed",
            "error: `flag` is not a belief with one number",
            "error: `flag` is never believed",
        ]
    );
    let text = configuration("", "", WAITING, "within(1, level <= 2.5, on)");
    let error =
        model(&parse_configuration("a.conf", &text).unwrap(), "!wait. +!wait : level(_) <- on.");
    assert!(
        error.unwrap_err().to_string().starts_with("error: a fraction where `int` is expected")
    );
    let text = configuration("", "", WAITING, "within(1, level <= limit, on)");
    let error =
        model(&parse_configuration("a.conf", &text).unwrap(), "!wait. +!wait : level(_) <- on.");
    assert!(error.unwrap_err().to_string().starts_with("error: `limit` is never believed"));
}

/// What is proved by a search that finds nothing, whatever it is asked.
#[cfg(unix)]
#[test]
fn a_search_that_finds_nothing_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let text = configuration("", "", "+!light <- on.\n", "at_most_one(on)");
    std::fs::write(folder.path().join("a.conf"), text).unwrap();
    std::fs::write(folder.path().join("a.asl"), "+!light <- on.\n").unwrap();
    let programs = tempfile::tempdir().unwrap();
    let pan = "#!/bin/sh\necho 'State-vector 1 byte, depth reached 1, errors: 0'\n";
    std::fs::write(programs.path().join("prepared"), pan).unwrap();
    let cc = format!(
        "#!/bin/sh\ncp {0}/prepared pan; cp {0}/prepared pan_breadth; chmod +x pan pan_breadth\n",
        programs.path().display()
    );
    for (name, text) in [("spin", "#!/bin/sh\n"), ("cc", cc.as_str())] {
        let path = programs.path().join(name);
        std::fs::write(&path, text).unwrap();
        std::fs::set_permissions(&path, PermissionsExt::from_mode(0o755)).unwrap();
    }
    let path = format!("{}:{}", programs.path().display(), std::env::var("PATH").unwrap());
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args(["verify", "a.conf"]).current_dir(folder.path()).env("PATH", path);
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(output.stdout.is_empty() && said.contains("does not refute"), "{said}");
}

/// The trace function is called for each chosen plan, whoever counts.
#[test]
fn calls_of_the_trace_function_count_everywhere() {
    let text = configuration("trace = tr;", "", "+!light <- on.\n", "never(tr)");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.conf"), text).unwrap();
    std::fs::write(folder.path().join("a.asl"), "+!light <- on.\n").unwrap();
    std::fs::write(folder.path().join("script"), "achieve_light();\nnext_step();\n").unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    command.args(["run", "a.conf", "--script", "script"]).current_dir(folder.path());
    let said = command.output().unwrap();
    assert!(String::from_utf8_lossy(&said.stdout).contains("breaks `p`"));
}
