//! What is refused, and with which words.

use crate::harness::Case;

fn refused(agent: &'static str) -> String {
    refused_with("", agent)
}

fn refused_with(sections: &'static str, agent: &'static str) -> String {
    let case = Case {
        basics: "void act(int); bool flag(int); int count(void); void take(handle_t);",
        types: "g(void); gi(int); b(int); d(double); h(handle_t); c(void);",
        sections,
        agent,
    };
    let error = case.translate("").map(|translation| translation.warnings).unwrap_err();
    error.to_string()
}

/// The message and place of the first error, without the source lines.
fn first(agent: &'static str) -> String {
    let rendered = refused(agent);
    let mut lines = rendered.lines();
    let message = lines.next().unwrap_or_default();
    let place = lines.next().unwrap_or_default().trim_start_matches([' ', '-', '>']);
    format!("{place}: {message}")
}

#[test]
fn an_error_shows_its_line_a_caret_and_what_to_do() {
    insta::assert_snapshot!(refused("!g.\n+!g : b(X) & not b(Y)\n  <- act(Y); fly(1)."), @r"
    warning: variable `X` is never used
     --> agent.asl:2:9
      |
    2 | +!g : b(X) & not b(Y)
      |         ^
      |
      = help: write `_` if any value will do

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
    ");
}

#[test]
fn every_static_restriction_is_checked() {
    for (agent, expected) in [
        ("!g. +!g <- acts(1).", "agent.asl:1:12: error: `acts` is not declared"),
        ("!g. +!g <- act(1, 2).", "agent.asl:1:12: error: `act` takes 1 arguments, not 2"),
        ("!g. +!g <- act(1.5).", "agent.asl:1:16: error: a fraction where `int` is expected"),
        ("!g. +!g <- act(3000000000).", "agent.asl:1:16: error: number out of the range of `int`"),
        (
            "!g. +!g <- act(\"x\").",
            "agent.asl:1:16: error: a string where a value of type `int` is expected",
        ),
        ("!g. +!g <- act(X).", "agent.asl:1:16: error: `X` has no value here"),
        ("!g. +!g <- act(_).", "agent.asl:1:16: error: an unnamed variable has no value"),
        (
            "!g. +!g : d(X) <- act(X).",
            "agent.asl:1:23: error: `X` has type `double`, expected `int`",
        ),
        (
            "!g. +!g <- X = count; X = count; act(X).",
            "agent.asl:1:23: error: `X` already has a value",
        ),
        ("!g. +!g <- X = act(1).", "agent.asl:1:16: error: `act` returns no value"),
        ("!g. +!g : act(1) <- act(1).", "agent.asl:1:11: error: `act` does not return `bool`"),
        ("!g. +!g : count <- act(1).", "agent.asl:1:11: error: `count` does not return `bool`"),
        ("!g. +!g <- !c.", "agent.asl:1:13: error: no plan for `+!c`"),
        ("!c. +!g <- act(1).", "agent.asl:1:2: error: no plan for `+!c`"),
        ("!g. +!g <- !!c.", "agent.asl:1:14: error: no plan for `+!c`"),
        (
            "!g. +!g <- !g; act(1).",
            "agent.asl:1:13: error: `g` leads back to itself and is not the last formula",
        ),
        (
            "!g. +!g <- +c; act(1). +c <- +b(1). +b(X) <- -c; act(X). -c <- +c.",
            "agent.asl:1:13: error: `c` leads back to itself and is not the last formula",
        ),
        ("!g. +!!g <- act(1).", "agent.asl:1:6: error: `!!` cannot be a trigger"),
        (
            "!g. +!g : h(X) & h(X) <- take(X).",
            "agent.asl:1:20: error: values of type `handle_t` cannot be compared",
        ),
        (
            "!g. +!g <- ?b(X); act(X). +?b(X) <- act(1).",
            "agent.asl:1:31: error: `X` is asked for and never gets a value",
        ),
        (
            "!g. +!g <- ?b(X); act(X). +?b(3) <- act(1).",
            "agent.asl:1:31: error: this argument is asked for",
        ),
        (
            "!g. +!g <- ?b(X); act(X). +?b(X) <- ?b(X).",
            "agent.asl:1:13: error: `?b` leads back to itself",
        ),
        ("!g. +!g : b(X) | c <- act(X).", "agent.asl:1:27: error: `X` has no value here"),
        (
            "!g. +!g : b(X) & X <- act(X).",
            "agent.asl:1:18: error: `X` has type `int`, expected `bool`",
        ),
        ("!g. +!g : 1 < 2 <- act(1).", "agent.asl:1:11: error: both sides are constants"),
        (
            "!g. +!g : d(X) & X mod 2.0 < 1.0 <- act(1).",
            "agent.asl:1:18: error: `mod` is for integers",
        ),
        (
            "!g. +!g : b(X) & d(Y) & X < Y <- act(1).",
            "agent.asl:1:29: error: `Y` has type `double`, expected `int`",
        ),
        ("!g. +!g <- X = 3; act(X).", "agent.asl:1:16: error: the type of this value is unknown"),
        ("!g. +!g : b(X) & X = X + 1 <- act(X).", "agent.asl:1:18: error: `X` already has a value"),
        ("!g. +!g : X < 3 <- act(1).", "agent.asl:1:11: error: `X` has no value here"),
        (
            "!g. +!g : h(X) & X == X <- act(1).",
            "agent.asl:1:18: error: values of type `handle_t` cannot be compared",
        ),
        ("!g. +!g <- act(b(1) | c).", "agent.asl:1:16: error: a condition where a value is needed"),
        (
            "!g. +!g : b(X) & X == X <- act(X).",
            "agent.asl:1:18: error: a value is compared with itself",
        ),
        ("!g. +!g : 3 <- act(1).", "agent.asl:1:11: error: not a condition"),
        (
            "!g. +!g <- act(1). -!c <- act(1).",
            "agent.asl:1:20: error: `-!c` can never run: no plan for `+!c`",
        ),
        ("!g. +!g <- b(1).", "agent.asl:1:12: error: `b` is a belief or goal, not a basic action"),
        (
            "!g. +!g. +!act <- act(1).",
            "agent.asl:1:12: error: `act` is a basic action, not a belief or goal",
        ),
        ("b(1). b(2). !g. +!g <- act(1).", "agent.asl:1:7: error: a second initial belief `b`"),
        ("b(X). !g. +!g <- act(1).", "agent.asl:1:3: error: not a constant"),
        ("!g. +!g <- -b(X).", "agent.asl:1:15: error: `X` has no value here"),
        ("!g. +!g : b(X) & {} <- act(X).", "agent.asl:1:18: error: unexpected character `{`"),
        ("!g. +!g : ~b(1) <- act(1).", "agent.asl:1:11: error: unexpected character `~`"),
        (
            "@l !g. +!g <- act(1).",
            "agent.asl:1:4: error: expected `+` or `-` of a trigger, found `!`",
        ),
    ] {
        assert_eq!(first(agent), expected, "{agent}");
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
      = help: the environment could order what the agent can't do

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
      = help: list it in `triggerables` too

    error: pre-emptive percepts are not translated yet
     --> agent.conf:4:70
      |
    4 | settables { bb; }; triggerables { +!c; +b; +b; }; preemptive { +!gi; +b; };
      |                                                                      ^^
      |
      = help: only goals, `+!goal`, can pre-empt
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
    assert!(translation.warnings.contains("nothing ever triggers `+!c`"));
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
        let error = parsed.and_then(|parsed| translator::translate(parsed, "!g. +!g."));
        let error = error.unwrap_err().to_string();
        assert!(error.contains(expected), "{structs}: {error}");
    }
}

#[test]
fn what_cannot_happen_is_warned_of() {
    let case = Case {
        basics: "void act(int);",
        types: "g(int); b(int); c(void); d(void);",
        sections: "settables { c; };",
        agent: "!g(1).\n+!g(1) : b(X) & not c <- act(X).\n+!g(X) <- act(X).\n+!g(2) : c <- act(2).\n",
    };
    insta::assert_snapshot!(case.translate("").unwrap().warnings, @r"
    warning: `b` is never believed
     --> agent.asl:2:10
      |
    2 | +!g(1) : b(X) & not c <- act(X).
      |          ^^^^
      |
      = help: no initial belief, no plan, no event and no `set_` function makes it true

    warning: this plan is never tried
     --> agent.asl:4:1
      |
    4 | +!g(2) : c <- act(2).
      | ^^^^^^
      |
      = help: an earlier plan of the same trigger fits every event
    ");
}
