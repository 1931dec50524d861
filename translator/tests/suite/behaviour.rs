//! What the generated C does: programs with the trace that they must leave.

use crate::harness::Case;

const BASICS: &str = "void a(void); void act(int); void pair(int, int); void say(const char *);";
const TYPES: &str = "g(void); h(void); k(void); gi(int); gd(double); go2(int, int); b(int); \
                     c(void); p(int, int); d(double); s(const char *); land(void);";

/// Runs `agent` through `script` and compares what it did.
fn check(sections: &'static str, agent: &'static str, script: &str, trace: &str) {
    let case = Case { basics: BASICS, types: TYPES, sections, agent };
    assert_eq!(case.run("", script), trace, "{agent}");
}

const STEP: &str = "next_step();";

#[test]
fn the_initial_goal_runs_in_the_first_step_not_before() {
    check("", "!g. +!g <- a.", "puts(\"init\"); next_step(); next_step();", "init a()");
}

#[test]
fn plans_are_tried_in_the_order_of_the_source() {
    let agent = "b(2). !g. +!g : b(1) <- act(1). +!g : b(2) <- act(2). +!g <- act(3).";
    check("", agent, STEP, "act(2)");
}

#[test]
fn constants_repeated_and_unnamed_variables_match() {
    let agent = "p(3, 3). !go2(4, 4).\n\
                 +!go2(X, X) : p(Y, Y) & p(_, 3) & not p(X, _) <- pair(X, Y).\n\
                 +!go2(_, _) <- act(0).";
    check("", agent, STEP, "pair(4,3)");
    let agent = "!go2(4, 5). +!go2(X, X) <- act(1). +!go2(4, _) <- act(2).";
    check("", agent, STEP, "act(2)");
}

#[test]
fn a_negation_with_a_repeated_local_variable() {
    let agent = "p(1, 2). !g. +!g : not p(X, X) <- act(1). +!g <- act(2).";
    check("", agent, STEP, "act(1)");
    let agent = "p(2, 2). !g. +!g : not p(X, X) <- act(1). +!g <- act(2).";
    check("", agent, STEP, "act(2)");
}

#[test]
fn doubles_are_compared_exactly() {
    let agent = "d(0.1). !gd(0.1). +!gd(X) : d(X) <- act(1). +!gd(_) <- act(2).";
    check("", agent, STEP, "act(1)");
    let agent = "d(0.1). !gd(0.10000001). +!gd(X) : d(X) <- act(1). +!gd(_) <- act(2).";
    check("", agent, STEP, "act(2)");
}

#[test]
fn beliefs_are_added_replaced_and_deleted_only_if_they_match() {
    let agent = "!g.\n+!g <- +b(1); +b(2); -b(1); !h.\n+!h : b(X) <- act(X); -b(2); !k.\n\
                 +!k : not b(_) <- a.";
    check("", agent, STEP, "act(2) a()");
}

#[test]
fn a_goal_in_the_middle_is_called_and_recursion_waits_for_the_next_step() {
    let agent = "b(2). !g. +!g <- !h; act(9); !k. +!h <- act(1). +!k : b(2) <- act(2); +b(3); !k.\n\
                 +!k <- act(3).";
    let script = "next_step(); puts(\"|\"); next_step(); puts(\"|\"); next_step();";
    // `k` leads to itself, so it is posted; `h` does not, so it is called.
    check("", agent, script, "act(1) act(9) | act(2) | act(3)");
}

#[test]
fn a_failed_goal_abandons_the_body_and_its_failure_plan_mends_it() {
    let agent = "!g. +!g <- act(1); !h; act(2). +!h : c <- a. -!h <- act(7).";
    check("", agent, STEP, "act(1) act(7) act(2)");
    let agent = "!g. +!g <- act(1); !h; act(2). +!h : c <- a. -!g <- act(8).";
    check("", agent, STEP, "act(1) act(8)");
    let agent = "!g. +!g <- act(1); !h; act(2). +!h : c <- a.";
    check("", agent, "next_step(); printf(\"%u\\n\", unhandled_events());", "act(1) 1");
}

#[test]
fn a_failed_body_never_makes_a_later_plan_run() {
    let agent = "!g. +!g <- act(1); ?c; act(2). +!g <- act(3).";
    check("", agent, STEP, "act(1)");
}

#[test]
fn a_retry_is_posted_not_recursive() {
    let agent = "b(0). !g. +!g : b(3) <- a. -!g : b(X) <- act(X); +b(3); !g.";
    check("", agent, "next_step(); next_step();", "act(0) a()");
}

#[test]
fn a_test_goal_binds_or_fails() {
    let agent = "p(1, 5). !g. +!g <- ?p(1, X); act(X); ?p(2, Y); act(Y).";
    check("", agent, STEP, "act(5)");
}

#[test]
fn deferred_goals_wait_in_order_and_one_slot_each() {
    let agent = "!g. +!g <- !!gi(1); !!h; !!gi(2); act(0). +!gi(X) <- act(X). +!h <- a.";
    let script = "next_step(); puts(\"|\"); next_step(); puts(\"|\"); next_step(); next_step();";
    check("", agent, script, "act(0) | act(2) | a()");
}

#[test]
fn posted_events_come_before_external_ones_and_those_before_deferred() {
    let sections = "triggerables { +!k; };";
    let agent = "b(1). !g. +!g : b(1) <- !!h; act(1); +b(2); !g. +!g <- act(2). +!h <- act(4).\n\
                 +!k <- act(3).";
    let script = "achieve_k(); next_step(); next_step(); next_step(); next_step();";
    check(sections, agent, script, "act(1) act(2) act(3) act(4)");
}

#[test]
fn a_full_inbox_refuses_and_says_so() {
    let sections = "triggerables { +!gi; };";
    let script = "bool r = can_add_event(); printf(\"%d \", r); r = achieve_gi(1); \
                  printf(\"%d \", r); r = achieve_gi(2); printf(\"%d \", r); r = can_add_event(); \
                  printf(\"%d \", r); next_step(); r = achieve_gi(3); printf(\"%d \", r); next_step();";
    check(sections, "+!gi(X) <- act(X).", script, "1 1 0 0 act(1) 1 act(3)");
}

#[test]
fn a_pre_empting_event_aborts_what_runs() {
    let sections = "triggerables { +!land; +!gi; }; preemptive { +!land; };";
    let agent = "+!gi(X) <- act(X); !gi(X). +!land <- a.";
    let script = "achieve_gi(1); next_step(); next_step(); achieve_land(); achieve_land(); \
                  achieve_gi(2); next_step(); next_step();";
    check(sections, agent, script, "act(1) act(1) a() act(2)");
}

#[test]
fn percepts_from_outside_change_the_belief_and_run_their_plan() {
    let sections = "triggerables { +b; -b; };";
    let agent = "+b(X) : b(X) <- act(X). -b(_) : not b(_) <- a.";
    let script = "add_b(5); next_step(); del_b(); next_step();";
    check(sections, agent, script, "act(5) a()");
}

#[test]
fn a_mere_update_costs_no_step() {
    let sections = "triggerables { +b; +!g; };";
    let agent = "!h. +!h : b(X) <- act(X). +!h <- a; !!h. +!g <- act(9).";
    let script = "next_step(); add_b(4); next_step();";
    check(sections, agent, script, "a() act(4)");
}

#[test]
fn percepts_from_a_body_run_before_the_body_goes_on_and_only_if_something_changed() {
    let agent = "!g. +!g <- +b(1); +b(1); +b(2); -b(9); -b(2); act(9). +b(X) <- act(X). -b(X) <- pair(X, 0).";
    check("", agent, STEP, "act(1) act(2) pair(2,0) act(9)");
}

#[test]
fn a_failed_percept_plan_fails_the_body_and_an_unfitting_one_does_not() {
    let agent = "!g. +!g <- +b(1); act(2). +b(1) <- ?c.";
    check("", agent, STEP, "");
    let agent = "!g. +!g <- +b(1); act(2). +b(7) <- ?c.";
    check("", agent, STEP, "act(2)");
}

#[test]
fn strings_and_numbers_keep_their_value() {
    let agent =
        "s(\"one\"). !g. +!g : s(X) <- say(X); say(\"a\\\"??=*/b\"); act(2147483647); act(-7).";
    check("", agent, STEP, "say(one) say(a\"??=*/b) act(2147483647) act(-7)");
}

#[test]
fn functions_are_called_in_order_once_and_only_as_far_as_needed() {
    let case = Case {
        basics: "void act(int); bool yes(int); bool no(int); int twice(int);",
        types: "g(void); b(int);",
        sections: "settables { b; };",
        agent: "!g. +!g : no(1) & yes(2) <- act(1).\n\
                +!g : not no(3) & b(X) & yes(X) <- Y = twice(twice(X)); act(Y); act(twice(1)).",
    };
    let functions = "bool yes(int x) { printf(\"yes(%d)\\n\", x); return true; }\n\
        bool no(int x) { printf(\"no(%d)\\n\", x); return false; }\n\
        int twice(int x) { printf(\"twice(%d)\\n\", x); return 2 * x; }\n\
        void updateBeliefs(void) { set_b(5); }\n";
    let trace = "no(1) no(3) yes(5) twice(5) twice(10) act(20) twice(1) act(2)";
    assert_eq!(case.run(functions, STEP), trace);
}

#[test]
fn init_starts_anew() {
    let agent = "!g. +!g : not b(_) <- act(1); +b(1); !!h. +!g <- act(2). +!h <- a.";
    check("", agent, "next_step(); init(); next_step(); next_step();", "act(1) act(1) a()");
}

#[test]
fn comparisons_and_arithmetic_decide_and_calculate() {
    let agent = "b(20). d(1.5). !g.\n\
        +!g : b(X) & X < 20 <- act(1).\n\
        +!g : b(X) & X / 3 * 3 + X mod 3 == X & d(Y) & Y * 2.0 >= 3.0 & Z = X - 25 & Z \\== 5\n\
            <- act(-Z); W = (X + 1) * 2; act(W); act(-X).";
    check("", agent, STEP, "act(5) act(42) act(-20)");
}

#[test]
fn what_has_no_result_fails() {
    let agent = "b(0). !g. +!g : b(X) & 1 / X > 0 <- act(1). +!g <- act(2); !h; act(9).\n\
        +!h : b(X) <- act(3); act(2147483647 + 1); act(4). -!h <- act(5).";
    check("", agent, STEP, "act(2) act(3) act(5) act(9)");
    let agent = "b(-2147483648). d(0.0). !g. +!g : b(X) & -X > 0 <- act(1).\n\
        +!g : b(X) & not (X - 1 < 0) & d(Y) & not (1.0 / Y > 0.0) <- act(2).";
    check("", agent, STEP, "act(2)");
}

#[test]
fn alternatives_and_negations_nest() {
    let agent = "b(1). p(2, 3). !g.\n\
        +!g : b(2) | p(3, _) <- act(1).\n\
        +!g : not (b(1) & (p(9, _) | p(_, 3))) <- act(2).\n\
        +!g : (c & b(X) | p(X, Y) & Y > X | b(X)) & not not b(1) <- act(X).";
    check("", agent, STEP, "act(2)");
}

#[test]
fn a_variable_that_every_alternative_binds_is_seen_afterwards() {
    let agent = "b(7). !g. +!g : p(X, _) | b(X) | p(_, X) <- act(X).";
    check("", agent, STEP, "act(7)");
    let agent = "p(4, 5). !g. +!g : b(X) & X > 3 | p(_, X) <- act(X).";
    check("", agent, STEP, "act(5)");
}

#[test]
fn booleans_are_values_and_conditions() {
    let case = Case {
        basics: "void act(int); bool flip(bool);",
        types: "g(void); on(bool);",
        sections: "",
        agent: "on(true). !g.\n+!g : on(X) & X & not flip(X) & Y = flip(false) & Y == true <- act(1); +on(false); !h.\n\
                +!h : on(false) & on(X) & not X <- act(2).",
    };
    let case = Case { types: "g(void); h(void); on(bool);", ..case };
    assert_eq!(case.run("bool flip(bool x) { return !x; }\n", STEP), "act(1) act(2)");
}

#[test]
fn a_test_goal_asks_the_beliefs_then_the_plans() {
    let agent = "p(1, 2). !g.\n\
        +!g <- ?p(1, X); act(X); ?p(5, Y); act(Y); ?b(Z); act(Z); ?go2(A, B); pair(A, B).\n\
        +?p(X, Y) : X > 3 <- Y = X * 10.\n\
        +?b(X) <- act(0); ?p(7, X).\n\
        +?go2(X, Y) : p(X, Y).";
    check("", agent, STEP, "act(2) act(50) act(0) act(70) pair(1,2)");
}

#[test]
fn a_test_goal_without_answer_fails_and_its_failure_plan_can_answer() {
    let agent = "!g. +!g <- ?b(X); act(X). +?b(X) : c & b(X). -!g <- act(8).";
    check("", agent, STEP, "act(8)");
    let agent =
        "p(6, 1). !g. +!g <- ?b(X); act(X). +?b(X) <- act(1); ?c; ?p(X, _). -?b(X) : p(X, _).";
    check("", agent, STEP, "act(1) act(6)");
}

#[test]
fn labels_and_requirements_are_carried_to_the_comment() {
    let case = Case {
        basics: "void a(void);",
        types: "g(void);",
        sections: "",
        agent: "!g.\n@first[req(\"HLR-1\")]\n+!g <- a.",
    };
    let text = case.translate("").unwrap().files[0].text.clone();
    assert!(text.contains(" * @first[req(\"HLR-1\")]\n * +!g <- a."), "{text}");
}

#[test]
fn a_perceived_belief_raises_its_event_when_it_changes() {
    let case = Case {
        basics: "void act(int); int reading(void);",
        types: "b(int); g(int);",
        sections: "settables { b; }; perceived { b; }; triggerables { +!g; };",
        agent: "+b(X) <- act(X). +!g(X) <- act(-X).",
    };
    let functions = "static int now = 1;\nint reading(void) { return now; }\n\
        void updateBeliefs(void) { set_b(now); }\n";
    // Once, not again while it stays; before the inbox; only the newest value.
    let script = "next_step(); next_step(); now = 2; (void)achieve_g(7); next_step(); set_b(5); \
                  now = 6; next_step(); next_step();";
    assert_eq!(case.run(functions, script), "act(1) act(2) act(6) act(-7)");
}

#[test]
fn clear_forgets_events_and_keeps_beliefs() {
    let agent = "!g. +!g : b(X) <- act(X). +!g <- +b(4); !!h. +!h <- a. +!k <- act(9).";
    let script = "next_step(); (void)achieve_k(); clear(); next_step(); next_step();";
    check("triggerables { +!k; };", agent, script, "act(4)");
}

#[test]
fn refused_events_are_counted() {
    let sections = "triggerables { +!gi; };";
    let script = "(void)achieve_gi(1); (void)achieve_gi(2); (void)achieve_gi(3); \
                  printf(\"%u\\n\", refused_events()); next_step();";
    check(sections, "+!gi(X) <- act(X).", script, "2 act(1)");
}

#[test]
fn structs_are_passed_kept_and_compared() {
    let case = Case {
        basics: "void act(int); place_t here(int); double far(place_t, place_t);",
        types: "g(void); at(place_t); to(place_t); ask(place_t);",
        sections: "structs { place_t { double x; double y; bool valid; }; }; settables { at; };\n\
                   perceived { at; }; triggerables { +!g; };",
        agent: "+at(P) : to(P) <- act(1).\n\
                +at(P) <- +to(P); ?ask(Q); !g.\n\
                +?ask(P) : at(P).\n\
                +!g : at(P) & to(Q) & P == Q & far(P, here(3)) > 1.0 <- act(2).\n\
                +!g : at(P) & not to(P) <- act(3).",
    };
    let functions = "static int place = 1;\n\
        place_t here(int n) { place_t p = { 0 }; p.x = n; p.valid = true; return p; }\n\
        double far(place_t a, place_t b) { return (b.x - a.x) + (b.y - a.y); }\n\
        void updateBeliefs(void) { set_at(here(place)); }\n";
    let script = "next_step(); next_step(); place = 9; next_step(); place = 1; next_step();";
    assert_eq!(case.run(functions, script), "act(2) act(2)");
    case.compile();
}

#[test]
fn the_trace_function_is_told_which_plan_was_chosen() {
    let configuration = "settings { input = a; output = a.c; header = a.h; basics = b.h; \
        trace = chosen; };\nbasics { void act(int); };\ntypes { g(void); h(void); b(int); };";
    let agent = "!g. +!g : b(1) <- act(1). +!g <- !h; act(2). +!h <- act(3).";
    let trace = crate::harness::run_program(configuration, agent, "next_step();");
    assert_eq!(trace, "chosen(1)\nchosen(2)\nact(3)\nact(2)");
}

#[test]
fn in_queue_mode_deferred_goals_wait_among_external_events() {
    let agent = "!g. +!g <- !!h; !!gi(7); act(0). +!gi(X) <- act(X). +!h <- a. +!k <- act(9).";
    let case = Case { basics: BASICS, types: TYPES, sections: "triggerables { +!k; };", agent };
    let script = "(void)achieve_k(); next_step(); (void)achieve_k(); for (int i = 0; i < 5; i++) \
                  { next_step(); }";
    // Queue: first in, first out; the initial goal is still the first event.
    assert_eq!(case.run_with("max_events = 2;", "", script), "act(0) act(9) a() act(7) act(9)");
    assert_eq!(case.run_with("inbox = 2;", "", script), "act(0) act(9) act(9) a() act(7)");
}
