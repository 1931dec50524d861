//! `asl2c validate --c` is attacked: C that compilers take, that does something else, and that must not be proved.
//!
//! Each trick is a kind, put at a place of an agent's C. It counts if gcc or clang compile it, and the program then leaves
//! another trace than the translation does.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use asl2c::{Agent, Cbmc, validate};
use judged_c::judge;
use translator::{
    Comparison, EXERCISE, EXERCISE_SEED, EXERCISE_STEPS, Exercise, comparison, exercise,
};

use crate::harness::{cbmc, from_environment, skip};

const GALLERY: &str = "../translator/agents";
const TIME: Duration = Duration::from_mins(2);
const STEPS: u32 = 300;

/// A kind of tricks: what stands outside of functions, and what stands in one.
///
/// `@A` is a call of an action, `@F` its name, and `@k` a small number.
type Kind = (&'static str, &'static str, &'static str);

/// What is no C of the language.
#[rustfmt::skip]
const FOREIGN: &[Kind] = &[
    ("struct with a constant member", "static struct { const int32_t id; uint32_t n; } own = { 1, 0U };", "own.n++; if (own.n > @kU) { @A }"),
    ("named struct with a constant member", "struct kept { const bool x; uint32_t n; };\nstatic struct kept own = { true, 0U };", "own.n = own.n + 1U; if (own.n > @kU) { @A }"),
    ("array of structs with a constant member", "static struct { const int32_t id; uint32_t n; } own[2] = { { 1, 0U }, { 2, 0U } };", "own[1].n++; if (own[1].n > @kU) { @A }"),
    ("joined lines in a comment", "", "/* *\\\n/ @A /* */"),
    ("joined lines behind a comment", "", "uint32_t on = @kU; on = 0U; // \\\non = @kU;\nif (on == 0U) { @A }"),
    ("joined lines in a word", "", "@\\\nA"),
    ("digraphs", "", "<% @A %>"),
    ("digraph for the preprocessor", "%:define MORE @A", "MORE"),
    ("trigraphs", "", "??< @A ??>"),
    ("trigraph that joins lines", "", "uint32_t on = 0U; // why??/\non = @kU;\nif (on == 0U) { @A }"),
    ("type of a function", "typedef void (F)(int);\nF exit;", "(exit)(@k);"),
    ("type of a function, abort", "typedef void (F)(void);\nF abort;", "(abort)();"),
    ("declared library function", "extern void exit(int);", "exit(@k);"),
    ("function of the library in parentheses", "void abort(void);", "(abort)();"),
    ("function of the system", "int raise(int);", "raise(6 + @k);"),
    ("puts of one's own", "int puts(const char *text);\nint puts(const char *text) { (void)text; @A return @k; }", "puts(\"x\");"),
    ("action called through parentheses", "", "(@F)();"),
    ("action called through a pointer", "", "void (*f)(void) = @F; f();"),
    ("action called through a static pointer", "static void (*const f)(void) = @F;", "f();"),
    ("long jump", "#include <setjmp.h>\nstatic jmp_buf where;", "if (setjmp(where) == 0) { longjmp(where, @k); } else { @A }"),
    ("signal", "#include <signal.h>\n#include <stdlib.h>", "signal(6, exit); raise(6);"),
    ("at the end", "#include <stdlib.h>", "static bool first = true; if (first) { first = false; atexit(@F); }"),
    ("macro", "#define MORE() @A", "MORE()"),
    ("macro for an action's keyword", "#define return @A return", ""),
    ("macro of a condition", "#define if(x) if (!(x))", ""),
    ("conditional text", "", "#ifndef __CPROVER\n@A\n#endif"),
    ("conditional text by compiler", "", "#if defined __GNUC__\n@A\n#endif"),
    ("other line", "", "#line 7\nif (__LINE__ == 7) { @A }"),
    ("pragma", "", "_Pragma(\"GCC poison sleep\") @A"),
    ("constructor", "__attribute__((constructor)) static void begin(void) { @A }", ""),
    ("destructor", "__attribute__((destructor)) static void finish(void) { @A }", ""),
    ("assembly", "", "__asm__ volatile (\"ud2\");"),
    ("assembly on top", "__asm__(\".globl mine\\nmine: ret\");\nvoid mine(void);", "mine(); @A"),
    ("addresses less", "static uint32_t a = 1U;\nstatic uint32_t b = 1U;", "if (&a < &b) { @A }"),
    ("addresses greater", "static uint32_t a = 1U;\nstatic uint32_t b = 1U;", "if (&a > &b) { @A }"),
    ("address as a number", "static uint32_t a = @kU;", "if (((uintptr_t)&a & 1U) == 0U) { @A }"),
    ("address of a local", "", "uint32_t a = @kU; uintptr_t at = (uintptr_t)&a; if (at > 4096U) { @A }"),
    ("constant written", "static const uint32_t own = @kU;", "*(uint32_t *)&own = 9U; if (own == 9U) { @A }"),
    ("constant local written", "", "const volatile uint32_t own = @kU; *(uint32_t *)&own = 9U; if (own == 9U) { @A }"),
    ("type of a pointer", "typedef uint32_t *P;", "uint32_t a = @kU; *(P)&a = 9U; if (a == 9U) { @A }"),
    ("order of a sum", "static uint32_t scratch = 0U;\nstatic uint32_t bump(void) { scratch = scratch + 1U; return 0U; }", "scratch = 0U; if ((scratch + bump()) == (uint32_t)0U) { @A } else { @A @A }"),
    ("assignment in a sum", "", "int32_t i = @k; if ((i + (i = 5)) > 0) { @A }"),
    ("assignment as a condition", "", "bool on = false; if (on = true) { @A }"),
    ("increment in an argument", "", "uint32_t i = 0U; if (i++ < @kU) { @A }"),
    ("signs and widths", "", "if (-1L < 4294967295U) { @A }"),
    ("signs", "", "if (-@k > 1U) { @A }"),
    ("unequal signs of variables", "", "int32_t a = -@k; uint32_t b = 1U; if (a > b) { @A }"),
    ("width of a pointer", "", "if (UINTPTR_MAX > 4294967295U) { @A }"),
    ("size", "", "if (sizeof(long) > @kU) { @A }"),
    ("fast type", "", "uint_fast16_t a = 65535U; a = a + @kU; if (a > 65535U) { @A }"),
    ("enum of one's own", "enum small { SMALL = -1 };", "if (sizeof(enum small) == 4U) { @A }"),
    ("enum with a value", "typedef enum { FIRST = @k, SECOND } own_t;", "own_t x = SECOND; if (x == (own_t)(@k + 1)) { @A }"),
    ("field of bits", "struct bits { int b : 1; };", "struct bits x; x.b = 1; if (x.b < 0) { @A }"),
    ("union", "union both { float f; uint32_t n; };", "union both x; x.f = 1.0F; if (x.n > @kU) { @A }"),
    ("array of variable length", "", "uint32_t n = @kU; uint32_t a[n]; a[0] = n; if (a[0] == n) { @A }"),
    ("alloca", "", "uint32_t *a = __builtin_alloca(@k * 4); a[0] = 1U; if (a[0] == 1U) { @A }"),
    ("object without a name", "", "if ((uint32_t){ @kU } > 0U) { @A }"),
    ("generic choice", "", "if (_Generic(1, int: true, default: false)) { @A }"),
    ("comma", "", "@F(), (void)@k;"),
    ("choice of values", "", "(void)(true ? @F() : (void)0);"),
    ("inline", "static inline void more(void) { @A }", "more();"),
    ("tentative definition", "static uint32_t own;\nstatic uint32_t own;", "own++; if (own > @kU) { @A }"),
    ("visible object", "uint32_t own = 0U;", "own++; if (own > @kU) { @A }"),
    ("external object", "extern int environ_;\nint environ_ = @k;", "if (environ_ == @k) { @A }"),
    ("old function", "static void more(a) int a; { if (a > 0) { @A } }", "more(@k);"),
    ("implicit int", "static own = @k;", "if (own == @k) { @A }"),
    ("function without parameters", "static void more();\nstatic void more(void) { @A }", "more();"),
    ("shift to the right", "", "int32_t a = -@k; if ((a >> 1) < 0) { @A }"),
    ("shift by the width", "", "volatile uint32_t by = 32U; uint32_t a = 1U; if ((a << (by - @kU)) != 0U) { @A }"),
    ("and of bits", "", "if ((6U & @kU) < 7U) { @A }"),
    ("long double", "", "long double a = 0.1L; if (a != (long double)0.1) { @A }"),
    ("equal floats", "", "float a = 0.1F; double b = 0.1; if (a != b) { @A }"),
    ("float as an integer", "", "double a = 3.7; uint32_t b = a; if (b == 3U) { @A }"),
    ("texts compared", "", "const char *a = \"x\"; const char *b = \"x\"; if (a == b) { @A }"),
    ("texts unequal", "", "const char *a = \"x\"; char b[2] = \"x\"; if (a != b) { @A }"),
    ("character of a text", "", "const char *a = \"x\"; if (a[0] == 'x') { @A }"),
    ("sign of a character", "", "if ('\\xff' < 0) { @A }"),
    ("recursion", "static void more(uint32_t n) { if (n > 0U) { more(n - 1U); } else { @A } }", "more(@kU);"),
    ("mutual recursion", "static void other(uint32_t n);\nstatic void more(uint32_t n) { if (n > 0U) { other(n - 1U); } }\nstatic void other(uint32_t n) { @A more(n); }", "more(@kU);"),
    ("deep recursion", "static uint32_t more(uint32_t n) { return (n == 0U) ? 0U : (1U + more(n - 1U)); }", "if (more(@k000U) > 0U) { @A }"),
    ("endless loop", "", "while (true) { }"),
    ("endless for", "", "for (;;) { @A break; }"),
    ("do", "", "do { @A } while (false);"),
    ("while that ends", "", "uint32_t n = 0U; while (n < @kU) { n++; @A }"),
    ("goto", "", "goto more; more: @A"),
    ("volatile", "static volatile uint32_t own = 0U;", "own++; if (own > @kU) { @A }"),
    ("register", "", "register uint32_t own = @kU; if (own > 0U) { @A }"),
    ("restrict", "static void more(uint32_t *restrict a, uint32_t *restrict b) { *a = 1U; *b = 2U; if (*a != 1U) { @A } }", "uint32_t x = 0U; more(&x, &x); if (x == 2U) { @A }"),
    ("of a thread", "static _Thread_local uint32_t own = 0U;", "own++; if (own > @kU) { @A }"),
    ("errno", "#include <errno.h>", "errno = @k; if (errno == @k) { @A }"),
    ("date", "", "if (__DATE__[0] != '0') { @A }"),
    ("name of the function", "", "if (__func__[0] != '0') { @A }"),
    ("standard", "", "if (__STDC__ == 1) { @A }"),
    ("assumption", "static void __CPROVER_assume(int x) { (void)x; }", "__CPROVER_assume(0); @A"),
    ("assumption of a library", "static void __VERIFIER_assume(int x) { (void)x; }", "__VERIFIER_assume(0); @A"),
    ("dollar", "static uint32_t a$b = 0U;", "a$b++; if (a$b > @kU) { @A }"),
    ("universal name", "static uint32_t \\u00e4 = 0U;", "\\u00e4++; if (\\u00e4 > @kU) { @A }"),
    ("name beyond ASCII", "static uint32_t ä = 0U;", "ä++; if (ä > @kU) { @A }"),
    ("function in a function", "", "void more(void) { @A } more();"),
    ("statement as a value", "", "(void)({ @A @k; });"),
    ("label as a value", "", "void *at = &&more; goto *at; more: @A"),
    ("octal", "", "uint32_t a = 010; if (a == 8U) { @A }"),
    ("hexadecimal", "", "if (0x1@kU > 16U) { @A }"),
    ("cases that fall through", "", "switch (@k) { case @k: case 9: @A default: break; }"),
    ("range of cases", "", "switch (@k) { case 0 ... 5: @A break; default: break; }"),
    ("declaration in a case", "", "switch (@k) { uint32_t a; default: a = 1U; if (a == 1U) { @A } break; }"),
    ("hidden name", "static uint32_t own = 0U;", "bool own = true; if (own) { @A }"),
    ("prototype in a function", "", "void @F(void); @F();"),
    ("weak", "__attribute__((weak)) void more(void) { @A }", "more();"),
    ("alias", "static void more(void) { @A }\nstatic void same(void) __attribute__((alias(\"more\")));", "same();"),
    ("cleanup", "static void more(uint32_t *x) { (void)x; @A }", "uint32_t own __attribute__((cleanup(more))) = @kU; (void)own;"),
    ("builtin", "", "if (__builtin_constant_p(@k)) { @A }"),
    ("trap", "", "__builtin_trap();"),
    ("unreachable", "", "if (@k > 0) { __builtin_unreachable(); }"),
    ("typeof", "", "__typeof__(1U) own = @kU; if (own > 0U) { @A }"),
    ("vector", "typedef uint32_t four __attribute__((vector_size(16)));", "four own = { @kU }; if (own[0] == @kU) { @A }"),
    ("uninitialised local", "", "uint32_t own; own = own - own; if (own == 0U) { @A }"),
    ("uninitialised array", "", "uint32_t own[3]; own[@k % 3] = 5U; if (own[@k % 3] == 5U) { @A }"),
    ("alias of the state", "", "uint8_t *bytes = (uint8_t *)&agent; bytes[0] = (uint8_t)(bytes[0] ^ 1U);"),
    ("state in a bigger one", "typedef struct { uint32_t n; agent_t of; } more_t;\nstatic more_t own = { 0 };", "own.n++; if (own.n > @kU) { @A }"),
    ("pointer that is kept", "static uint32_t *own = 0;", "static uint32_t n = 0U; own = &n; *own = *own + 1U; if (n > @kU) { @A }"),
    ("system", "int system(const char *);", "(void)system(\"true\"); @A"),
    ("two in one", "static uint32_t a = 0U, b = 0U;", "a++, b++; if (b > @kU) { @A }"),
    ("last member of no length", "struct open { uint32_t n; uint32_t more[]; };", "static struct open own = { 0U }; own.n++; if (own.n > @kU) { @A }"),
    ("complex", "", "double _Complex a = 1.0; if (a == 1.0) { @A }"),
    ("assertion", "_Static_assert(1, \"\");", "@A"),
    ("empty statement", "", "; @A"),
    ("atomic", "static _Atomic uint32_t own = 0U;", "own++; if (own > @kU) { @A }"),
    ("designated", "static agent_t own = { .unhandled = 0U };", "own.unhandled++; if (own.unhandled > @kU) { @A }"),
];

/// What is C of the language, and must not be proved by CBMC.
#[rustfmt::skip]
const WITHIN: &[Kind] = &[
    ("counter", "static uint32_t own = 0U;", "own++; if (own > @kU) { @A }"),
    ("counter far away", "static uint32_t own = 0U;", "if (own < 20@kU) { own = own + 1U; } else { @A }"),
    ("counter of a function", "", "static uint32_t own = 0U; own += 1U; if (own > @kU) { @A }"),
    ("truth that is kept", "static bool own = false;", "if (own) { @A } own = !own;"),
    ("array that is kept", "static uint32_t own[3] = { 0U, 0U, 0U };", "own[2] = own[2] + 1U; if (own[2] > @kU) { @A }"),
    ("second state", "static agent_t own = { 0 };", "own.unhandled = own.unhandled + 1U; if (own.unhandled > @kU) { @A }"),
    ("text that is kept", "static const char *own = \"a\";\nstatic uint32_t n = 0U;", "own = \"b\"; n++; if (n > @kU) { @A }"),
    ("helper with a counter", "static bool is_late(void) { static uint32_t own = 0U; own++; return own > @kU; }", "if (is_late()) { @A }"),
    ("helper by address", "static void bump(uint32_t *x) { *x = *x + @kU; }", "bump(&agent.unhandled);"),
    ("helper with the state", "static void spoil(agent_t *of) { of->refused = of->refused + @kU; }", "spoil(&agent);"),
    ("table", "static const uint32_t own[3] = { 1U, @kU, 0U };", "if (own[2] == agent.refused) { @A }"),
    ("constant", "static const uint32_t own = @kU;", "if (agent.refused < own) { @A }"),
    ("number", "", "if (agent.unhandled < @kU) { @A }"),
    ("once more", "", "@A"),
    ("loop", "", "for (uint32_t i = 0U; i < @kU; i++) { @A }"),
    ("loop with a condition", "", "bool on = true; for (uint32_t i = 0U; (i < @kU) && on; i++) { @A on = false; }"),
    ("choice", "", "switch (agent.refused) { case 0U: @A break; default: break; }"),
    ("overflow", "", "int32_t own = INT32_MAX; own = own + (int32_t)agent.refused + @k; if (own < 0) { @A }"),
    ("sum of floats", "", "if ((0.1 + 0.2) > 0.3) { @A }"),
    ("float in between", "", "const double own = 1.0 / 3.0; if ((own * 3.0) <= 1.0) { @A }"),
    ("remainder of a negative number", "", "const int32_t own = -7; if ((own % 3) < 0) { @A }"),
    ("narrow", "", "const uint8_t own = (uint8_t)300; if (own == 44U) { @A }"),
    ("wrapped", "", "const uint32_t own = agent.refused - 1U; if (own > agent.refused) { @A }"),
    ("event lost", "", "agent.posted = EVENT_NONE;"),
    ("counter changed", "", "agent.refused = @kU;"),
    ("cast", "", "if ((int8_t)200 < 0) { @A }"),
];

/// Where the second part is put: behind these words.
const PLACES: [&str; 4] = [
    "\n    updateBeliefs();\n",
    "static void forget_events(void)\n{\n",
    "bool can_add_event(void)\n{\n",
    "bool handled = true;\n",
];

const AGENTS: [&str; 6] = ["infusion", "lift", "traffic_light", "paper", "rover", "inspection"];

/// An agent of the gallery.
struct Attacked {
    name: &'static str,
    compared: Comparison,
    exercise: Exercise,
    action: String,
    traces: Vec<String>,
}

impl Attacked {
    fn new(name: &'static str) -> Self {
        let agent = Agent::read(Path::new(&format!("{GALLERY}/{name}.conf"))).unwrap();
        let compared = comparison(&agent.configuration, &agent.text).unwrap();
        let exercise = exercise(&agent.configuration, &agent.text).unwrap();
        let basics = &compared.files[2].text;
        let action = basics
            .lines()
            .filter_map(|line| line.strip_prefix("void "))
            .find_map(|line| line.strip_suffix("(void);").filter(|name| *name != "updateBeliefs"));
        let action = action.unwrap().to_owned();
        let mut attacked = Self { name, compared, exercise, action, traces: Vec::new() };
        attacked.traces = traces(&attacked.exercise, attacked.c(), None);
        assert!(attacked.traces.iter().all(|trace| trace.lines().count() > 100), "{name}");
        attacked
    }

    fn c(&self) -> &str {
        &self.compared.files[0].text
    }

    /// The C with a trick of this kind; `None` if it has no such place.
    fn with(&self, (_, top, statement): Kind, place: &str, number: usize) -> Option<String> {
        let filled = |text: &str| {
            let text = text.replace("@A", &format!("{}();", self.action));
            text.replace("@F", &self.action)
                .replace("@k", &number.to_string())
                .replace("@\\", &format!("{}\\", &self.action[..1]))
                .replace("\nA", &format!("\n{}();", &self.action[1..]))
        };
        let (before, after) = self.c().split_once(place)?;
        let first = before.find("\nstatic outcome_t ").or_else(|| before.find("\n/* Result"))?;
        let (head, rest) = before.split_at(first);
        Some(format!("{head}\n{}\n{rest}{place}{}\n{after}", filled(top), filled(statement)))
    }

    fn is_other(&self, c: &str) -> bool {
        let found = traces(&self.exercise, c, Some(&self.traces));
        found
            .iter()
            .zip(&self.traces)
            .any(|(found, expected)| !found.is_empty() && found != expected)
    }
}

/// What each compiler makes of it; nothing if it does not compile. Ends with the first that is another than expected.
fn traces(exercise: &Exercise, c: &str, expected: Option<&[String]>) -> Vec<String> {
    const MAIN: &str = "#include <stdio.h>\nvoid asl2c_exercise(void);\nvoid asl2c_trace_text(const char *text);\n\
        void asl2c_trace_text(const char *text) { fputs(text, stdout); }\n\
        int main(void) { setvbuf(stdout, 0, _IONBF, 0); puts(\"begin\"); asl2c_exercise(); puts(\"end\"); return 0; }\n";
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    for file in &exercise.files[1..] {
        write(&file.name, &file.text);
    }
    write(&exercise.files[0].name, c);
    write("main.c", &MAIN.replace("_IONBF, 0", "_IOFBF, 1 << 16"));
    let mut traces = Vec::new();
    for (compiler, standard, level) in
        [("gcc", "-std=gnu99", "-O0"), ("gcc", "-std=c99", "-O2"), ("clang", "-std=gnu11", "-O1")]
    {
        let mut run = String::new();
        _ = write!(
            run,
            "{compiler} {standard} {level} -w -I. -D{EXERCISE_STEPS}={STEPS} -D{EXERCISE_SEED}=7 {} {EXERCISE} main.c -o program \
             2>&1 >/dev/null || exit 0; (ulimit -t 5; ulimit -f 20000; ulimit -c 0; timeout 5 ./program); echo \"status $?\"",
            exercise.files[0].name
        );
        let output =
            Command::new("sh").arg("-c").arg(&run).current_dir(folder.path()).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let trace = if text.contains("status ") { text } else { String::new() };
        let differs = expected.is_some_and(|of| !trace.is_empty() && of[traces.len()] != trace);
        traces.push(trace);
        if differs {
            break;
        }
    }
    traces
}

/// `ASL2C_TRICKS` of them.
#[test]
fn no_trick_is_proved() {
    let Some(cbmc) = cbmc() else {
        skip("cbmc");
        return;
    };
    let cbmc = Cbmc::find(Some(&cbmc)).unwrap();
    let wanted = from_environment("ASL2C_TRICKS", 30) as usize;
    let kinds: Vec<Kind> = FOREIGN.iter().chain(WITHIN).copied().collect();
    let mut agents: Vec<Option<Attacked>> = AGENTS.iter().map(|_| None).collect();
    // All kinds first, then the next place and agent for each; few of them are spread over the kinds.
    let step = (kinds.len() / wanted).max(1);
    let (mut refused, mut open, mut without_effect, mut proved) = (0, 0, Vec::new(), Vec::new());
    for round in 0..AGENTS.len() * PLACES.len() {
        for (index, kind) in kinds.iter().enumerate().step_by(step) {
            if refused + open + proved.len() >= wanted {
                break;
            }
            let number = (index + round) % AGENTS.len();
            let agent = agents[number].get_or_insert_with(|| Attacked::new(AGENTS[number]));
            let place = PLACES[(round / AGENTS.len() + round) % PLACES.len()];
            let name = format!("{}: {}, behind {:?}", agent.name, kind.0, place.trim());
            let c = agent.with(*kind, place, 1 + (index + round) % 3).unwrap();
            if !agent.is_other(&c) {
                without_effect.push(name);
                continue;
            }
            let mut compared = agent.compared.clone();
            let Ok(judged) = judge(&agent.compared, &c, []) else {
                refused += 1;
                continue;
            };
            judged.put_into(&mut compared);
            let folder = tempfile::tempdir().unwrap();
            let result = validate(&compared, &cbmc, folder.path(), TIME);
            match result {
                Ok(result) if !result.is_proved() => open += 1,
                other => proved.push(format!("{name}: {other:?}")),
            }
        }
    }
    println!(
        "{} tricks: {refused} refused, {open} not proved, {} proved; {} without effect are not counted:\n{}",
        refused + open + proved.len(),
        proved.len(),
        without_effect.len(),
        without_effect.join("\n")
    );
    assert!(proved.is_empty(), "{proved:#?}");
    assert!(refused + open >= wanted, "{refused}, {open}");
}
