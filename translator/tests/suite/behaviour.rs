//! Behaviour of generated C beyond the conformance suite: structs, the trace function, comments.

use translator::{parse_configuration, translate};

use crate::harness::Case;

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

/// Queried arguments may be of any type that can be passed on.
#[test]
fn test_goals_are_for_every_type() {
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
        includes { #include \"types.h\" };\n\
        basics { void say(name_t); void go(place_t); place_t here(void); handle_t *get(void); void use(handle_t *); };\n\
        types { g(void); who(name_t); at(place_t); by(handle_t *); known(name_t); };";
    let agent = "known(\"me\"). !g.\n+!g <- ?who(N); say(N); ?at(P); go(P); ?by(H); use(H).\n\
        +?who(N) : known(N). +?at(P) <- P = here. +?by(H) <- H = get.\n\
        -?who(N) : known(N) | who(N).\n";
    let mut translation =
        translate(&parse_configuration("a.conf", configuration).unwrap(), agent).unwrap();
    let mut types = translation.files[1].clone();
    types.name = "types.h".to_owned();
    types.text = "#ifndef T\n#define T\ntypedef const char *name_t;\ntypedef struct { struct { int x; } inner; } place_t;\n\
        typedef struct handle handle_t;\n#endif\n".to_owned();
    translation.files.push(types);
    let environment = "#include <stdio.h>\nvoid updateBeliefs(void) {}\nvoid say(name_t n) { puts(n); }\n\
        void go(place_t p) { printf(\"%d\\n\", p.inner.x); }\n\
        place_t here(void) { place_t p; p.inner.x = 7; return p; }\nhandle_t *get(void) { return 0; }\n\
        void use(handle_t *h) { puts(h ? \"some\" : \"none\"); }\n\
        int main(void) { init(); next_step(); return (int)unhandled_events(); }\n";
    assert_eq!(crate::harness::compile_and_run(&translation, environment), "me 7 none");
}

/// Plans of events that nothing raises do not appear in the C or in the model, wherever they are in the
/// source.
#[test]
fn what_nothing_triggers_is_as_if_it_were_not_there() {
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; inbox = 2; clock = now; };\n\
        basics { void on(void); void off(void); uint64_t now(void); };\n\
        types { light(void); dim(int); idle(int); lost(int); lit(int); };\nsettables { lit; };\n\
        perceived { lit; };\ntriggerables { +!light; };\nproperties { p: at_most_one(on); };\n";
    let dead = [
        "+!idle(X) <- off; !!light; !lost(X).\n",
        "+!lost(X) : X > 1 <- off; .wait(9); +lit(X).\n-!lost(X) <- +lit(X).\n",
    ];
    let live = [
        "+!light <- on; !!dim(1); !!light.\n",
        "+!dim(X) : X < 3 <- off; !dim(X + 1).\n-!dim(_) <- on.\n",
        "+lit(X) <- on; !dim(X)[deadline(5)].\n",
    ];
    // Line numbers appear in comments and in the model, so the dead plans replace empty lines.
    let agent = |dead: [&str; 2]| {
        format!("!light.\n{}{}{}{}{}", live[0], dead[0], live[1], dead[1], live[2])
    };
    let (with, without) = (agent(dead), agent(["\n", "\n\n"]));
    let parsed = || parse_configuration("a.conf", configuration).unwrap();
    let files = |agent: &str| translate(&parsed(), agent).unwrap().files;
    assert_eq!(files(&with), files(&without));
    let promela = |agent: &str| translator::model(&parsed(), agent).unwrap().promela();
    assert_eq!(promela(&with), promela(&without));
}
