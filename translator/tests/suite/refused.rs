//! Refused agents and configurations, and the messages.

use translator::Severity;

use crate::harness::Case;

fn refused(agent: &'static str) -> String {
    refused_with("", agent)
}

fn refused_with(sections: &'static str, agent: &'static str) -> String {
    refused_in("", sections, agent)
}

fn refused_in(settings: &str, sections: &'static str, agent: &'static str) -> String {
    let case = Case {
        basics: "void act(int); bool flag(int); int count(void); void take(handle_t);",
        types: "g(void); gi(int); b(int); d(double); h(handle_t); c(void);",
        sections,
        agent,
    };
    let error = case.translate(settings).map(|translation| translation.warnings).unwrap_err();
    error.to_string()
}

#[test]
fn an_error_shows_its_line_a_caret_and_what_to_do() {
    insta::assert_snapshot!(refused("!g.\n+!g : b(X) & not b(Y)\n  <- act(Y); fly(1)."), @r"
    error: `Y` has no value here
     --> agent.asl:3:10
      |
    3 |   <- act(Y); fly(1).
      |          ^
      |
      = help: it is bound only inside `not`, or not in every branch of `|`

    error: `fly` is not declared
     --> agent.asl:3:14
      |
    3 |   <- act(Y); fly(1).
      |              ^^^
      |
      = help: declare it in the section `basics` of the configuration

    warning[unused-variable]: variable `X` is never used
     --> agent.asl:2:9
      |
    2 | +!g : b(X) & not b(Y)
      |         ^
      |
      = help: write `_` if any value will do
    ");
}

/// The first line of each error of an agent.
fn errors(agent: &'static str) -> Vec<String> {
    let case = Case {
        basics: "void act(int); bool flag(int); int count(void); void take(handle_t);",
        types: "g(void); gi(int); b(int); d(double); h(handle_t); c(void); p(int, int); h2(handle_t, int);",
        sections: "settables { h; };",
        agent,
    };
    let text = case.translate("").map_or_else(|error| error.to_string(), |_| String::new());
    text.lines().filter_map(|line| line.strip_prefix("error: ")).map(str::to_owned).collect()
}

#[test]
fn plans_of_test_goals_that_nobody_asks_are_checked() {
    assert_eq!(errors("!g. +!g. +?b(X) <- fly(X)."), ["`fly` is not declared"]);
    assert_eq!(errors("!g. +!g. +?b(X, Y) <- act(X)."), ["`b` takes 1 arguments, not 2"]);
    assert_eq!(errors("!g. +!g. +?b(X) <- act(X, 1)."), ["`act` takes 1 arguments, not 2"]);
    assert_eq!(errors("!g. +!g. +?b(X) <- ?b(X)."), ["`?b` is recursive"]);
    assert_eq!(
        errors("!g. +!g. +?b(X) <- ?d(Y); X = 1. +?d(Y) <- ?b(_); Y = 1.0."),
        ["`?d` is recursive", "`?b` is recursive"]
    );
    assert_eq!(
        errors("!g. +!g. +?b(X) <- ?p(X, _). +?p(X, Y) <- fly(X); Y = 1."),
        ["`fly` is not declared"]
    );
    assert_eq!(errors("!g. +!g. -?b(X) <- X = 1."), ["`-?b` can never run: no plan for `+?b`"]);
    assert_eq!(
        errors("!g. +!g <- ?b(X); act(X). -?b(X) <- X = 1."),
        ["`-?b` can never run: no plan for `+?b`"]
    );
    assert_eq!(errors("!g. +!g. +?b(X) : c <- X = Y."), ["`Y` has no value here"]);
    // However they are queried.
    for agent in [
        "!g. +!g. +?b(X) <- X = 1.",
        "!g. +!g. +?b(X) <- act(X).",
        "!g. +!g. +?b(3) <- act(3).",
        "!g. +!g. +?p(X, Y) <- Y = X * 2.",
        "!g. +!g. +?p(X, X) <- act(X).",
        "!g. +!g. +?h(X) : h(X).",
        "!g. +!g. +?h2(X, Y) : h(X) & Y = count.",
        "!g. +!g. +?h(X) <- take(X).",
        "!g. +!g. +?b(X) : not (X = count & flag(X)) & p(X, _).",
    ] {
        assert_eq!(errors(agent), [""; 0], "{agent}");
    }
}

#[test]
fn one_mistake_is_said_once() {
    let only = |agent| assert_eq!(errors(agent), ["`fly` is not declared"], "{agent}");
    only("!g. +!g <- X = fly(1); act(X); Y = X + 1; act(Y + X); !gi(Y); +b(X); -b(X); act(-X).");
    only("!g. +!g : X = fly(1) & X > 3 & Y = X & not (Y == X) <- act(Y).");
    only("!g. +!g <- ?b(X); act(X). +?b(X) <- X = fly(1).");
    // Other errors are reported as well.
    assert_eq!(
        errors("!g. +!g <- X = fly(1); act(X); act(Z)."),
        ["`fly` is not declared", "`Z` has no value here"]
    );
}

/// The messages for an agent with test goals.
fn said(agent: &str) -> String {
    let configuration = "settings { input = agent.asl; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void act(int); int count(void); };\n\
        types { g(void); b(int); p(int, int); h0(int, int, int, int); h1(int, int, int, int); };\n\
        settables { b; };";
    let parsed = translator::parse_configuration("agent.conf", configuration).unwrap();
    translator::translate(&parsed, agent).map_or_else(|error| error.to_string(), |_| String::new())
}

/// If a correct plan is queried in a way that it does not support, the error is at the query.
#[test]
fn a_question_that_no_plan_answers_is_one_mistake() {
    const PLANS: &str = "+?p(X, Y) : X > 3 & X \\== 8 <- act(X); Y = X + 5.\n\
        -?p(X, Y) : X \\== 8 <- ?b(X); Y = count; +p(X, Y).\n+?b(X) : X > 3.\n";
    insta::assert_snapshot!(said(&format!("!g. +!g <- ?p(X, 8); act(X).\n{PLANS}")), @r"
    error: the plans of `?p` cannot answer this
     --> agent.asl:1:13
      |
    1 | !g. +!g <- ?p(X, 8); act(X).
      |             ^^^^^^^ line 2: `X` has no value here
      |
      = help: ask `?p(value, New)`, a value where the plan needs one and a new variable where it gives one, or change the plan
    ");
    insta::assert_snapshot!(said("!g. +!g <- ?p(4, 9).\n+?p(X, Y) : X > 3 <- Y = 8.\n"), @r"
    error: the plans of `?p` cannot answer this
     --> agent.asl:1:13
      |
    1 | !g. +!g <- ?p(4, 9).
      |             ^^^^^^^ line 2: `Y` already has a value
      |
      = help: ask `?p(value, New)`, a value where the plan needs one and a new variable where it gives one, or change the plan
    ");
    // An error of the plan is reported once for all queries; one of another query separately.
    assert_eq!(
        errors("!g. +!g <- ?p(X, 8); ?p(3, Y); ?p(3, 4). +?p(X, Y) : X > 3 <- Y = fly(X)."),
        ["`fly` is not declared"]
    );
    let twice = errors("!g. +!g <- ?p(4, 9); ?p(X, 9). +?p(X, Y) <- act(X); Y = 8.");
    assert_eq!(twice, ["the plans of `?p` cannot answer this"; 2]);
    assert_eq!(errors("!g. +!g : p(X, Y) <- Y = 8."), ["`Y` already has a value"]);
    assert_eq!(said(&format!("!g. +!g <- ?p(4, X); act(X).\n{PLANS}")), "");
}

/// Plans that query each other in many ways would multiply.
#[test]
fn a_question_has_a_few_ways_to_be_asked() {
    let asked = |ways: u32| {
        let question = |way: u32| {
            let given = (0..4).map(|bit| if way >> bit & 1 == 1 { "1" } else { "_" });
            format!("?h0({})", given.collect::<Vec<_>>().join(", "))
        };
        let questions: Vec<String> = (0..ways).map(question).collect();
        said(&format!(
            "!g. +!g <- {}.\n+?h0(A, B, C, D) <- ?h1(A, B, C, D).\n+?h1(A, B, C, D) : b(A) & b(B) & b(C) & b(D).",
            questions.join(";\n")
        ))
    };
    assert_eq!(asked(8), "");
    insta::assert_snapshot!(asked(11), @r"
    error: `?h0` is asked with more than 8 combinations of arguments
     --> agent.asl:9:2
      |
    9 | ?h0(_, _, _, 1);
      |  ^^^^^^^^^^^^^^ a new combination of given and asked arguments
      |
      = help: its plans are translated once per combination: use one of the others, and compare the answers
    ");
}

#[test]
fn a_clock_is_a_function_that_tells_a_time() {
    for (clock, expected) in [
        ("clock = time;", "agent.conf:1:95: error: the clock `time` is not declared"),
        ("clock = flag;", "agent.conf:1:95: error: `flag` cannot be a clock"),
        ("clock = act;", "agent.conf:1:95: error: `act` cannot be a clock"),
    ] {
        let rendered = refused_in(clock, "", "!g. +!g <- act(1).");
        let mut lines = rendered.lines();
        let message = lines.next().unwrap_or_default();
        let place = lines.next().unwrap_or_default().trim_start_matches([' ', '-', '>']);
        assert_eq!(format!("{place}: {message}"), expected);
    }
}

#[test]
fn the_configuration_is_checked_too() {
    insta::assert_snapshot!(
        refused_with("settables { bb; }; triggerables { +!c; +b; +b; }; preemptive { +!gi; +b; };", "!g. +!g <- act(1)."),
        @r"
    error: `bb` is not declared
     --> agent.conf:4:13
      |
    4 | settables { bb; }; triggerables { +!c; +b; +b; }; preemptive { +!gi; +b; };
      |             ^^
      |
      = help: did you mean `b`?

    error: no plan for `+!c`
     --> agent.conf:4:35
      |
    4 | settables { bb; }; triggerables { +!c; +b; +b; }; preemptive { +!gi; +b; };
      |                                   ^^^
      |
      = help: the environment could request what the agent cannot do

    error: this trigger is listed twice
     --> agent.conf:4:44
      |
    4 | settables { bb; }; triggerables { +!c; +b; +b; }; preemptive { +!gi; +b; };
      |                                            ^^

    error: a pre-emptive event must be triggerable
     --> agent.conf:4:64
      |
    4 | settables { bb; }; triggerables { +!c; +b; +b; }; preemptive { +!gi; +b; };
      |                                                                ^^^^
      |
      = help: list it in `triggerables` too, or in `messages` if peers ask for it

    error: only goals can pre-empt
     --> agent.conf:4:70
      |
    4 | settables { bb; }; triggerables { +!c; +b; +b; }; preemptive { +!gi; +b; };
      |                                                                      ^^
      |
      = help: raise a goal, `+!goal`, instead
    "
    );
}

#[test]
fn names_that_c_could_not_take_are_refused() {
    for basics in [
        "void goto(void);",
        "void init(void);",
        "void _x(void);",
        "void achieve_g(void);",
        "void a(void); void a(int);",
        "void outcome(void);",
        "int value1(void);",
        "int checked_add_int(int);",
    ] {
        let case = Case { basics, types: "g(void);", sections: "", agent: "!g. +!g." };
        assert!(case.translate("").is_err(), "{basics}");
    }
}

#[test]
fn rust_bindings_need_types_that_rust_knows_and_a_passed_state() {
    let case =
        Case { basics: "void take(handle_t);", types: "g(void);", sections: "", agent: "!g. +!g." };
    let error = case.translate("rust = b.rs;").unwrap_err().to_string();
    assert!(error.contains("need the agent's state passed in"), "{error}");
    assert!(error.contains("`handle_t` has no Rust counterpart"), "{error}");
}

#[test]
fn what_nothing_triggers_is_left_out_with_a_warning() {
    let case = Case {
        basics: "void act(int);",
        types: "g(void); c(void);",
        sections: "",
        agent: "!g. +!g <- act(1). +!c <- act(2).",
    };
    let translation = case.translate("").unwrap();
    assert!(translation.warnings.to_string().contains("`+!c` is never triggered"));
    assert!(!translation.files[0].text.contains("act(2)"));
    case.compile();
}

#[test]
fn structs_are_checked() {
    for (structs, expected) in [
        ("p_t { };", "a struct without fields"),
        ("p_t { double x; int x; };", "a second field of this name"),
        ("p_t { other_t x; };", "a field must be a number or bool"),
        ("double { int x; };", "`double` cannot be the name of a struct"),
        ("p_t { int x; }; p_t { int y; };", "`p_t` cannot be the name of a struct"),
        ("p_t { int while; };", "`while` cannot be the name of a field"),
        ("p_t { int x };", "expected `;`, found `}`"),
    ] {
        let configuration = format!(
            "settings {{ input = a; output = b; header = c; basics = d; }}; structs {{ {structs} }}; \
             types {{ g(void); }};"
        );
        let parsed = translator::parse_configuration("c", &configuration);
        let error = parsed.and_then(|parsed| translator::translate(&parsed, "!g. +!g."));
        let error = error.unwrap_err().to_string();
        assert!(error.contains(expected), "{structs}: {error}");
    }
}

#[test]
fn what_cannot_happen_is_warned_of() {
    let case = Case {
        basics: "void act(int);",
        types: "g(int); b(int); c(void);",
        sections: "settables { c; };",
        agent: "!g(1).\n+!g(1) : b(X) & not c <- act(X).\n+!g(X) <- act(X).\n+!g(2) : c <- act(2).\n",
    };
    insta::assert_snapshot!(case.translate("").unwrap().warnings.to_string(), @r"
    warning[never-tried]: this plan is never tried
     --> agent.asl:4:1
      |
    4 | +!g(2) : c <- act(2).
      | ^^^^^^
      |
      = help: an earlier plan of the same trigger fits every event

    warning[never-believed]: `b` is never believed
     --> agent.asl:2:10
      |
    2 | +!g(1) : b(X) & not c <- act(X).
      |          ^^^^
      |
      = help: no initial belief, no plan, no event and no `set_` function makes it true
    ");
}

/// The first line of each warning about the agent.
fn warnings(agent: &'static str) -> Vec<String> {
    let case = Case {
        basics: "void act(int); bool flag(void);",
        types: "g(void); h(int); k(void); b(int); c(void); d(double);",
        sections: "settables { b; c; d; };",
        agent,
    };
    let warnings = case.translate("").unwrap().warnings.to_string();
    let about_agent = warnings
        .lines()
        .filter_map(|line| Some(line.strip_prefix("warning[")?.split_once("]: ")?.1));
    about_agent.filter(|line| !line.contains("declared and never")).map(str::to_owned).collect()
}

#[test]
fn a_goal_that_may_find_no_plan_is_warned_of_unless_every_case_is_covered() {
    let may = |trigger: &str| vec![format!("`{trigger}` may find no plan")];
    assert_eq!(warnings("!g. +!g : c <- act(1)."), may("+!g"));
    assert_eq!(warnings("!g. +!g : c <- act(1). +!g : not c <- act(2)."), [""; 0]);
    assert_eq!(warnings("!g. +!g : c <- act(1). +!g : b(_) <- act(2)."), may("+!g"));
    // A failure plan handles it, its own or that of a caller.
    assert_eq!(warnings("!g. +!g : c <- act(1). -!g <- act(2)."), [""; 0]);
    assert_eq!(warnings("!g. +!g <- !k. +!k : c <- act(1). -!g <- act(2)."), [""; 0]);
    assert_eq!(warnings("!g. +!g <- !k. +!k : c <- act(1)."), may("+!k"));
    // Comparisons of integers cover all cases; for doubles there is NaN.
    let compared = "!g. +!g : b(X) & X < 3 <- act(1). +!g : b(X) & X >= 3 <- act(2). +!g : not b(_) <- act(3).";
    assert_eq!(warnings(compared), [""; 0]);
    let compared = "!g. +!g : d(X) & X < 3.0 <- act(1). +!g : d(X) & X >= 3.0 <- act(2). +!g : not d(_) <- act(3).";
    assert_eq!(warnings(compared), may("+!g"));
    assert_eq!(
        warnings("!g. +!g <- !h(1). +!h(1) <- act(1). +!h(X) : X \\== 1 <- act(X)."),
        [""; 0]
    );
    assert_eq!(warnings("!g. +!g : c | b(_) <- act(1). +!g : not (b(_) | c) <- act(2)."), [""; 0]);
    // A function may return something else the next time.
    assert_eq!(warnings("!g. +!g : flag <- act(1). +!g : not flag <- act(2)."), may("+!g"));
}

#[test]
fn a_failure_that_does_not_go_outward_is_warned_of() {
    let unseen = |guard: &str, goal: &str| {
        vec![format!("`{guard}` does not handle a later failure of `{goal}`")]
    };
    let may = |goal: &str| format!("`{goal}` may find no plan");
    // `k` continues in later steps, and fails there.
    let tail = warnings("!g. +!g <- !k. -!g <- act(1). +!k : c <- !k.");
    assert_eq!(tail, [unseen("-!g", "+!k"), vec![may("+!k")]].concat());
    assert_eq!(
        warnings("!g. +!g <- !k. -!g <- act(1). +!k <- ?b(X); act(X); !k."),
        unseen("-!g", "+!k")
    );
    assert_eq!(
        warnings("!g. +!g <- !k. -!g <- act(1). +!k <- ?b(X); act(X); !k. -!k <- act(2)."),
        [""; 0]
    );
    // Partial handling is not enough; nor are failures several steps later covered.
    assert_eq!(
        warnings("!g. +!g <- !k. -!g <- act(1). +!k <- ?b(X); act(X); !k. -!k : c <- act(2)."),
        unseen("-!g", "+!k")
    );
    assert_eq!(
        warnings("!g. +!g <- !k. -!g <- act(1). +!k <- !h(1). +!h(X) <- ?b(X); !k."),
        unseen("-!g", "+!h")
    );
    assert_eq!(
        warnings(
            "!g. +!g <- !k. -!g <- act(1). +!k <- ?c; !k. -!k <- !h(1). +!h(X) <- ?b(X); !h(X)."
        ),
        unseen("-!g", "+!h")
    );
    // A goal that posts itself handles its own failures, and a goal that cannot fail needs no failure plan.
    assert_eq!(warnings("!g. +!g <- ?c; !g. -!g <- act(1)."), [""; 0]);
    assert_eq!(warnings("!g. +!g <- !k. -!g <- act(1). +!k <- act(2); !g."), [""; 0]);
    // A percept is posted too.
    assert_eq!(
        warnings("!g. +!g <- +b(1). -!g <- act(1). +b(X) : X > 0 <- ?c; !g."),
        unseen("-!g", "+b")
    );
}

#[test]
fn a_deadline_that_nobody_sees_is_warned_of() {
    let case = Case {
        basics: "void act(int); int64_t now(void);",
        types: "g(void); k(void);",
        sections: "",
        agent: "!g. +!g <- !k[deadline(5)]. -!g <- act(1). +!k <- act(2); !k.",
    };
    let warnings = case.translate("clock = now;").unwrap().warnings.to_string();
    assert!(
        warnings
            .starts_with("warning[unseen-failure]: `-!g` does not handle a later failure of `+!k`"),
        "{warnings}"
    );
    let mended = Case {
        agent: "!g. +!g <- !k[deadline(5)]. -!g <- act(1). +!k <- act(2); !k. -!k <- act(3).",
        ..case
    };
    assert_eq!(mended.translate("clock = now;").unwrap().warnings.to_string(), "");
}

#[test]
fn what_is_declared_and_never_used_is_warned_of() {
    let case = Case {
        basics: "void act(int); bool flag(void); int now(void);",
        types: "g(void); b(int);",
        sections: "classes { all: act, flag; };",
        agent: "!g. +!g <- act(1).",
    };
    insta::assert_snapshot!(case.translate("clock = now;").unwrap().warnings.to_string(), @r"
    warning[unused-declaration]: `flag` is declared and never used
     --> agent.conf:2:30
      |
    2 | basics { void act(int); bool flag(void); int now(void); };
      |                              ^^^^
      |
      = help: remove it, or use it in the agent

    warning[unused-declaration]: `b` is declared and never used
     --> agent.conf:3:18
      |
    3 | types { g(void); b(int); };
      |                  ^
      |
      = help: remove it, or use it in the agent
    ");
}

#[test]
fn classes_are_checked() {
    for (classes, expected) in [
        ("all: act, fly;", "`fly` is not declared"),
        ("all: act; all: act;", "a second class `all`"),
        ("all: act, act;", "`act` is in the class `all` twice"),
        ("all act;", "expected `:`, found `act`"),
        ("all: b;", "`b` is not declared"),
    ] {
        let configuration = format!(
            "settings {{ input = a; output = b; header = c; basics = d; }}; \
             basics {{ void act(int); }}; classes {{ {classes} }}; types {{ g(void); }};"
        );
        let parsed = translator::parse_configuration("c", &configuration);
        let error = parsed.and_then(|parsed| translator::translate(&parsed, "!g. +!g."));
        let error = error.unwrap_err().to_string();
        assert!(error.contains(expected), "{classes}: {error}");
    }
}

#[test]
fn slips_of_the_pen_are_understood() {
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void on(void); };\ntypes { light(void); level(int); };\ntriggerables { +!light; };\n";
    for (agent, help) in [
        ("!light <- on.", "did you mean `+!light`?"),
        ("!light : level(_) <- on.", "did you mean `+!light`?"),
        ("light <- on.", "did you mean `+!light` or `+light`?"),
        ("+!light <- on, on.", "separated by `;`"),
        ("+!light <- on & on.", "separated by `;`"),
        ("+!light : level(_), level(_) <- on.", "joined by `&`"),
        ("+!light <- on\n+!light <- on.", "needs a full stop"),
    ] {
        let error = translator::translate(
            &translator::parse_configuration("a.conf", configuration).unwrap(),
            agent,
        )
        .unwrap_err();
        assert!(error.to_string().contains(help), "{agent}\n{error}");
    }
    let error =
        translator::parse_configuration("a.conf", &configuration.replace("light(void);", "light;"))
            .unwrap_err();
    assert!(error.to_string().contains("without arguments it is `light(void)`"), "{error}");
}

/// For editors and build scripts: each finding is data about one of the two files.
#[test]
fn what_is_found_is_data() {
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void on(void); };\ntypes { light(void); level(int); };\ntriggerables { +!light; };\n";
    let parsed = || translator::parse_configuration("a.conf", configuration).unwrap();
    let error = translator::translate(&parsed(), "+!light <- off; on.").unwrap_err();
    let [found] = error.diagnostics() else { panic!("{error}") };
    assert_eq!((found.code, found.severity), ("not-declared", Severity::Error));
    assert_eq!((found.span.clone(), found.message.as_str()), (11..14, "`off` is not declared"));
    let warnings = translator::translate(&parsed(), "+!light <- on.").unwrap().warnings;
    let [found] = &warnings[..] else { panic!("{warnings}") };
    assert_eq!((found.code, found.severity), ("unused-declaration", Severity::Warning));
    let place = warnings.located().next().unwrap();
    assert_eq!((place.source.name, place.start(), place.end()), ("a.conf", (3, 22), (3, 27)));
    let error = translator::parse_configuration("a.conf", "colours { };").unwrap_err();
    let codes: Vec<&str> = error.diagnostics().iter().map(|found| found.code).collect();
    assert_eq!(codes, ["unknown-section"]);
}

/// The messages of rendered errors, with their places.
fn places(rendered: &str) -> String {
    let lines = rendered.lines().filter(|line| line.starts_with("error") || line.contains("-->"));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn only_goals_with_plans_pre_empt_for_peers() {
    insta::assert_snapshot!(
        places(&refused_with("peers { ann, bob }; messages { tell b(int) from any; achieve gi(int) from any; }; preemptive { +b; +!gi; };", "!g. +!g <- act(1).")),
        @r"
    error: only goals can pre-empt
     --> agent.conf:4:96
    error: no plan for `+!gi`
     --> agent.conf:4:100
    "
    );
}

#[test]
fn events_of_peers_are_checked() {
    let rendered = refused_with(
        "peers { ann, bob }; messages { tell b(int) from ann; achieve gi(int) from any; tell d(double) from ann; }; triggerables { +!g; };
properties { p: within(1, +!gi, act); q: within(1, +!gi[source(cid)], act); r: only_after(act, +!g[source(ann)]);
s: within(1, +b[source(bob)], act, unless -d[source(ann)]); t: within(1, +!gi[source(self)], act, unless +!gi[source(bob)]); };",
        "+!g <- act(1). +b(_) <- act(1).",
    );
    insta::assert_snapshot!(places(&rendered), @r"
    error: the environment does not raise this
     --> agent.conf:5:27
    error: `cid` is not a peer
     --> agent.conf:5:64
    error: no peer sends `g`
     --> agent.conf:5:98
    error: `bob` never tells `b`
     --> agent.conf:6:24
    error: no plan for `+d` or `-d`
     --> agent.conf:6:43
    error: `self` is not a peer
     --> agent.conf:6:86
    error: no plan for `+!gi`
     --> agent.conf:6:106
    ");
    for (text, expected) in [
        ("within(1, +!gi[sorce(ann)], act)", "expected `source`, found `sorce`"),
        ("within(1, +!gi[source(3)], act)", "expected a peer, found `3`"),
        ("within(1, +!gi[source(ann), act)", "expected `]`, found `,`"),
    ] {
        let text = format!(
            "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; }}; properties {{ p: {text}; }};"
        );
        let (_, found) = translator::configuration::parse(&text);
        assert!(found.iter().any(|found| found.message == expected), "{text}: {found:?}");
    }
}

/// What would have a value without an error in the context is no second error.
#[test]
fn an_error_in_a_context_is_the_only_one() {
    for (context, expected) in [
        ("b(X)[source(zed)] & b(Y)", "`zed` is not a peer"),
        ("b(Y) & b(X)[source(3)]", "this is not a peer"),
        ("b(X)[age(Y)]", "the agent has no clock"),
        ("c & gone(X, Y)", "`gone` is not declared"),
    ] {
        let agent = format!("!g. +!g : {context} <- act(X); act(Y). -!g <- act(1).");
        let rendered =
            refused_with("peers { ann, bob }; messages { tell b(int) from any; };", agent.leak());
        let errors = rendered.lines().filter_map(|line| line.strip_prefix("error: "));
        assert_eq!(errors.collect::<Vec<_>>(), [expected], "{context}");
    }
}
