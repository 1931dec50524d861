//! The conformance suite: programs with their expected traces, and programs that must be refused, in
//! `tests/conformance/*.txt`.
//!
//! Each program is run twice, by the reference interpreter and as compiled C, and both must leave the trace
//! in the file. A case is a title, `== title`, then
//!
//! - `rule:` the rules of the language that it covers; all rules are in `RULES`;
//! - `with:` sections of the configuration, `settings:` settings instead of the clock, both
//!   optional;
//! - the agent, indented;
//! - `run:` commands, separated by `;`, and `trace:` their output; or `refused:` place and message of
//!   the agent's first error.
//!
//! Commands: `step`; `at 50` sets the clock and takes a step, `time 50` only sets it; `set b(3)`; `+!g(1)`, `+b(1)`, `-b` raise an
//! event and print whether it was accepted; `leader tells b(3)`, `untells b`, `asks g(1)`, `unasks g` is a message of a peer,
//! and prints whether it was accepted; `me scout` begins again as another peer than the first; `room` prints whether the next one would be; `init`; `clear`;
//! `counts` prints the counters. A step ends with `|`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use translator::interpreter::{Environment, Interpreter, Value};
use translator::syntax::ast::{Operator, Performative, TriggerKind};
use translator::types::{CType, TypeKind};
use translator::{ParsedConfiguration, parse_configuration, translate};

use crate::harness::{compile_and_run, trimmed_lines};

/// All rules of the language, each of which the suite must cover.
const RULES: [&str; 158] = [
    "program comments",
    "program left out",
    "program empty parentheses",
    "program not",
    "program numbers",
    "program strings",
    "program booleans",
    "program belief and goal",
    "program triggers",
    "plans order",
    "plans failed body",
    "match unnamed",
    "match binds",
    "match bound",
    "match repeated",
    "match constant",
    "match value",
    "match doubles",
    "context belief",
    "context not belief",
    "context not local",
    "context not bound",
    "context function",
    "context short",
    "context comparison",
    "context arithmetic",
    "context no result",
    "context or",
    "context nested",
    "context no backtracking",
    "body action",
    "body action fails",
    "body assign",
    "body add",
    "body add percept",
    "body add fails",
    "body add unequal",
    "body add recursive",
    "body delete",
    "body delete percept",
    "body delete nothing",
    "body delete fails",
    "body delete recursive",
    "body achieve now",
    "body achieve posted",
    "body achieve fails",
    "body defer",
    "body test",
    "body test fails",
    "test beliefs first",
    "test answers",
    "test given",
    "test modes",
    "test holes",
    "test not again",
    "test fails",
    "test failure plan",
    "failure mends",
    "failure outward",
    "failure not applicable",
    "failure of failure",
    "failure arguments",
    "failure no plan",
    "failure posted",
    "failure retry",
    "failure counted",
    "failure leaves events",
    "cycle initial goal",
    "cycle update first",
    "cycle initial beliefs",
    "cycle none",
    "state one instance",
    "state set silent",
    "cycle order",
    "cycle arrival",
    "cycle external add",
    "cycle external delete",
    "cycle mere update",
    "cycle unhandled",
    "state inbox",
    "state own inbox",
    "cycle init",
    "cycle clear",
    "cycle perceived",
    "cycle queue",
    "preempt aborts",
    "preempt always accepted",
    "preempt keeps the rest",
    "preempt priority",
    "preempt no failure",
    "time wait",
    "time variables",
    "time failure",
    "time percept",
    "time failure plan",
    "time events",
    "time clear",
    "time no result",
    "time deadline",
    "time deadline again",
    "time deadline next",
    "time deadline passes on",
    "time deadline wait",
    "time deadline pre-empted",
    "time deadline retry",
    "message tell",
    "message refused",
    "message newest",
    "message slots",
    "message untell",
    "message any source",
    "message order",
    "message search",
    "message search two",
    "message search or",
    "message search not",
    "message source bound",
    "message source named",
    "message self",
    "message my name",
    "message added",
    "message added once",
    "message removed",
    "message unnoticed",
    "message added source",
    "message added own",
    "message turns",
    "message service",
    "message ring",
    "message unachieve",
    "message goal source",
    "message goal waits",
    "message goal posted",
    "message preempt",
    "message preempt turns",
    "message send",
    "message broadcast",
    "message clear",
    "message age",
    "message age search",
    "message peer values",
    "message refused statically",
    "refused undeclared",
    "refused arity",
    "refused type",
    "refused unbound",
    "refused rebinding",
    "refused action in context",
    "refused no plan",
    "refused recursion",
    "refused trigger",
    "refused equality",
    "refused answers",
    "refused condition",
    "refused kind",
    "refused twice",
    "refused syntax",
    "refused time",
];

/// The environment of all agents of the suite. Actions and functions print their call.
pub(crate) const BASICS: &str = "void a(void); void act(int); void pair(int, int); void real(double); \
    void say(const char *); bool yes(int); bool no(int); bool flip(bool); int twice(int); \
    int count(void); int now(void); int watch(void);";
pub(crate) const TYPES: &str = "g(void); h(void); k(void); land(void); c(void); gi(int); h2(int); b(int); \
    gd(double); d(double); go2(int, int); p(int, int); s(const char *); on(bool);";

/// What there is besides for agents with peers.
const OF_PEERS: &str = "void who(peer); bool odd(peer); peer second(void);";
/// The same in C.
const PRELUDE_OF_PEERS: &str = r#"
void who(peer_t x) { printf("who(%d)\n", (int)x); }
bool odd(peer_t x) { printf("odd(%d)\n", (int)x); return (x % 2U) == 1U; }
peer_t second(void) { return 1U; }
"#;

/// The same in C.
const PRELUDE: &str = r#"
#include <stdio.h>
static int clock_ms = 0;
void updateBeliefs(void) { }
void a(void) { printf("a\n"); }
void act(int x) { printf("act(%d)\n", x); }
void pair(int x, int y) { printf("pair(%d,%d)\n", x, y); }
void real(double x) { printf("real(%.15f)\n", x); }
void say(const char *x) { printf("say(%s)\n", x); }
bool yes(int x) { printf("yes(%d)\n", x); return true; }
bool no(int x) { printf("no(%d)\n", x); return false; }
bool flip(bool x) { printf("flip(%d)\n", (int)x); return !x; }
int twice(int x) { printf("twice(%d)\n", x); return 2 * x; }
int count(void) { return 3; }
int now(void) { return clock_ms; }
int watch(void) { printf("watch\n"); return clock_ms; }
"#;

/// One case of a file.
struct Case {
    title: String,
    rule: String,
    sections: String,
    settings: String,
    agent: String,
    expected: Expected,
}

enum Expected {
    /// The commands and their output.
    Trace { run: String, trace: String },
    /// Place and message of the first error.
    Refused(String),
}

impl Case {
    fn configuration(&self) -> ParsedConfiguration {
        let text = format!(
            "settings {{ input = agent.asl; output = agent.c; header = agent.h; \
             basics = actions.h; {} }};\nbasics {{ {BASICS} {} }};\n\
             types {{ {TYPES} }};\n{}\n",
            self.settings,
            if self.sections.contains("peers") { OF_PEERS } else { "" },
            self.sections
        );
        parse_configuration("agent.conf", &text).unwrap_or_else(|e| panic!("{}: {e}", self.title))
    }

    /// `None` if the case passes.
    fn check(&self) -> Option<String> {
        let complaint = |found: &str, by: &str, expected: &str| {
            Some(format!("{}\n  expected: {expected}\n  {by}: {found}\n{}", self.title, self.agent))
        };
        match &self.expected {
            Expected::Refused(expected) => {
                let found = match translate(&self.configuration(), &self.agent) {
                    Ok(_) => "it is accepted".to_owned(),
                    Err(error) => first_error(&error.to_string()),
                };
                (found != *expected).then(|| complaint(&found, "found", expected))?
            }
            Expected::Trace { run, trace } => {
                let interpreted = self.interpreted(run);
                if interpreted != *trace {
                    return complaint(&interpreted, "interpreted", trace);
                }
                let compiled = self.compiled(run);
                (compiled != *trace).then(|| complaint(&compiled, "compiled", trace))?
            }
        }
    }

    fn interpreted(&self, run: &str) -> String {
        let configuration = self.configuration();
        let mut agent = Interpreter::new(&configuration, &self.agent)
            .unwrap_or_else(|error| panic!("{}\n{error}", self.title));
        let preempts = self.sections.contains("preemptive");
        let mut world = World::default();
        for command in run.split(';').map(str::trim) {
            let answer = |yes: bool| if yes { "yes\n" } else { "no\n" };
            match command.split_once(' ') {
                None if command == "step" => world.step(&mut agent),
                Some(("time", time)) => world.clock_ms = time.parse().unwrap(),
                Some(("at", time)) => {
                    world.clock_ms = time.parse().unwrap();
                    world.step(&mut agent);
                }
                Some(("set", belief)) => world.pending.push(atom(belief)),
                None if command == "init" => agent.init(),
                None if command == "clear" => agent.clear(),
                None if command == "room" => world.trace.push_str(answer(agent.can_add_event())),
                None if command == "counts" => {
                    let (unhandled, refused) = (agent.unhandled_events(), agent.refused_events());
                    _ = writeln!(world.trace, "unhandled {unhandled} refused {refused}");
                    if preempts {
                        _ = writeln!(world.trace, "aborted {}", agent.aborted_events());
                    }
                }
                Some(("me", name)) => agent.be(peer(&configuration, name)),
                Some((sender, said)) if let Some((performative, content)) = message(said) => {
                    let (name, arguments) = atom(content);
                    let sender = peer(&configuration, sender);
                    let accepted =
                        agent.receive(sender, performative, &name, arguments, &mut world);
                    world.trace.push_str(answer(accepted));
                }
                _ => {
                    let (operator, kind, event) = event(command);
                    let (name, arguments) = atom(event);
                    let accepted = agent.raise(operator, kind, &name, arguments).is_ok();
                    world.trace.push_str(answer(accepted));
                }
            }
        }
        trimmed_lines(&world.trace)
    }

    fn compiled(&self, run: &str) -> String {
        let configuration = self.configuration();
        let translation = translate(&configuration, &self.agent)
            .unwrap_or_else(|error| panic!("{}\n{error}", self.title));
        let mut script = sending(&configuration);
        if !configuration.declarations().peers.is_empty() {
            script.push_str(PRELUDE_OF_PEERS);
        }
        script.push_str("#define STEP next_step(); printf(\"|\\n\");\n");
        let mut init = "init();".to_owned();
        if !configuration.declarations().peers.is_empty() {
            "init(0U);".clone_into(&mut init);
        }
        _ = writeln!(script, "int main(void)\n{{\n{init}");
        for command in run.split(';').map(str::trim) {
            let call = |name: &str, rest: &str| {
                let rest = if rest.contains('(') { rest.to_owned() } else { format!("{rest}()") };
                format!("{name}_{rest}")
            };
            match command.split_once(' ') {
                None if command == "step" => script.push_str("STEP\n"),
                Some(("at", time)) => _ = writeln!(script, "clock_ms = {time}; STEP"),
                Some(("time", time)) => _ = writeln!(script, "clock_ms = {time};"),
                Some(("set", belief)) => _ = writeln!(script, "{};", call("set", belief)),
                None if command == "clear" => script.push_str("clear();\n"),
                None if command == "init" => _ = writeln!(script, "{init}"),
                Some(("me", name)) => {
                    init = format!("init(PEER_{});", name.to_uppercase());
                    _ = writeln!(script, "{init}");
                }
                Some((sender, said)) if let Some((performative, content)) = message(said) => {
                    let (name, arguments) = content.split_once('(').unwrap_or((content, ")"));
                    let comma = if arguments == ")" { "" } else { ", " };
                    let sender = if sender == "stranger" {
                        "200U".to_owned()
                    } else {
                        format!("PEER_{}", sender.to_uppercase())
                    };
                    _ = writeln!(
                        script,
                        "puts(receive_{}_{name}({sender}{comma}{arguments} ? \"yes\" : \"no\");",
                        performative.name()
                    );
                }
                None if command == "room" => {
                    script.push_str("puts(can_add_event() ? \"yes\" : \"no\");\n");
                }
                None if command == "counts" => {
                    script.push_str("printf(\"unhandled %u\\n\", unhandled_events());\n");
                    script.push_str("printf(\"refused %u\\n\", refused_events());\n");
                    if self.sections.contains("preemptive") {
                        script.push_str("printf(\"aborted %u\\n\", aborted_events());\n");
                    }
                }
                _ => {
                    let verb = match event(command) {
                        (_, TriggerKind::Achieve, _) => "achieve",
                        (Operator::Add, ..) => "add",
                        (Operator::Delete, ..) => "del",
                    };
                    let raised = call(verb, event(command).2);
                    _ = writeln!(script, "puts({raised} ? \"yes\" : \"no\");");
                }
            }
        }
        script.push_str("return 0;\n}\n");
        compile_and_run(&translation, &format!("{PRELUDE}{script}"))
    }
}

/// The number of a peer; a stranger has one that no peer has.
fn peer(configuration: &ParsedConfiguration, name: &str) -> usize {
    if name == "stranger" {
        return 200;
    }
    let mut peers = configuration.declarations().peers.iter();
    peers.position(|peer| peer.text == name).unwrap_or_else(|| panic!("no peer `{name}`"))
}

/// `tells b(3)`: what a message does, and what it is about.
fn message(said: &str) -> Option<(Performative, &str)> {
    let (verb, content) = said.split_once(' ')?;
    let performative = match verb {
        "tells" => Performative::Tell,
        "untells" => Performative::Untell,
        "asks" => Performative::Achieve,
        "unasks" => Performative::Unachieve,
        _ => return None,
    };
    Some((performative, content))
}

/// Definitions of the actions that send messages.
fn sending(configuration: &ParsedConfiguration) -> String {
    let mut text = String::new();
    for message in &configuration.declarations().messages {
        for performative in Performative::ALL {
            if performative.declared() != message.performative {
                continue;
            }
            let types = message.parameters.iter().filter(|_| performative.has_arguments());
            let (mut parameters, mut form, mut values) =
                ("peer_t to".to_owned(), "%d".to_owned(), "(int)to".to_owned());
            for (index, ctype) in types.enumerate() {
                _ = write!(parameters, ", {} x{index}", ctype.name);
                let (part, value) = match ctype.kind {
                    TypeKind::Float64 => (",%.15f", format!("x{index}")),
                    TypeKind::Text => (",%s", format!("x{index}")),
                    _ => (",%d", format!("(int)x{index}")),
                };
                form.push_str(part);
                _ = write!(values, ", {value}");
            }
            let name = format!("send_{}_{}", performative.name(), message.name.text);
            _ = writeln!(
                text,
                "void {name}({parameters}) {{ printf(\"{name}({form})\\n\", {values}); }}"
            );
        }
    }
    text
}

/// `LINE:COLUMN: message` of the first error.
fn first_error(rendered: &str) -> String {
    let lines: Vec<&str> = rendered.lines().collect();
    let index = lines.iter().position(|line| line.starts_with("error: ")).unwrap();
    let place = lines[index + 1].split("agent.asl:").nth(1).unwrap_or("not in the agent");
    format!("{place}: {}", lines[index].trim_start_matches("error: "))
}

/// `+!g(1)`: operator, kind and `g(1)`.
fn event(command: &str) -> (Operator, TriggerKind, &str) {
    if let Some(goal) = command.strip_prefix("+!") {
        (Operator::Add, TriggerKind::Achieve, goal)
    } else if let Some(belief) = command.strip_prefix('+') {
        (Operator::Add, TriggerKind::Belief, belief)
    } else if let Some(belief) = command.strip_prefix('-') {
        (Operator::Delete, TriggerKind::Belief, belief)
    } else {
        panic!("unknown command `{command}`")
    }
}

/// `b(3)`: name and arguments, which are integers.
fn atom(text: &str) -> (String, Vec<Value>) {
    let (name, arguments) = text.trim_end_matches(')').split_once('(').unwrap_or((text, ""));
    let arguments = arguments.split(',').filter(|argument| !argument.is_empty());
    (name.to_owned(), arguments.map(|a| Value::Integer(a.trim().parse().unwrap())).collect())
}

#[derive(Default)]
struct World {
    trace: String,
    clock_ms: i128,
    pending: Vec<(String, Vec<Value>)>,
}

impl World {
    fn step(&mut self, agent: &mut Interpreter) {
        agent.next_step(self);
        self.trace.push_str("|\n");
    }
}

impl Environment for World {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        std::mem::take(&mut self.pending)
    }

    fn call(&mut self, name: &str, arguments: &[Value], result: &CType) -> Option<Value> {
        if name == "now" {
            return Some(Value::Integer(self.clock_ms));
        }
        let texts: Vec<String> = arguments
            .iter()
            .map(|argument| match argument {
                Value::Bool(value) => u8::from(*value).to_string(),
                Value::Integer(value) => value.to_string(),
                Value::Float(value) => format!("{value:.15}"),
                Value::Text(value) => value.clone(),
                Value::Struct(_) => unreachable!("the suite has none"),
            })
            .collect();
        match (name, texts.as_slice()) {
            ("count" | "second", _) => {}
            (_, []) => _ = writeln!(self.trace, "{name}"),
            _ => _ = writeln!(self.trace, "{name}({})", texts.join(",")),
        }
        match (name, arguments) {
            _ if result.kind == TypeKind::Void => None,
            ("yes", _) => Some(Value::Bool(true)),
            ("no", _) => Some(Value::Bool(false)),
            ("flip", [Value::Bool(value)]) => Some(Value::Bool(!value)),
            ("odd", [Value::Integer(value)]) => Some(Value::Bool(value % 2 == 1)),
            ("second", _) => Some(Value::Integer(1)),
            ("twice", [Value::Integer(value)]) => Some(Value::Integer(2 * value)),
            ("count", _) => Some(Value::Integer(3)),
            ("watch", _) => Some(Value::Integer(self.clock_ms)),
            _ => unreachable!("the suite has no function `{name}`"),
        }
    }
}

/// All cases of all files.
fn cases() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/conformance");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
        .iter()
        .flat_map(|file| {
            let text = std::fs::read_to_string(file).unwrap();
            text.split("\n== ").skip(1).map(case).collect::<Vec<_>>()
        })
        .collect()
}

fn case(text: &str) -> Case {
    let mut lines = text.lines();
    let title = lines.next().unwrap().to_owned();
    let (mut agent, mut trace, mut refused) = (String::new(), None, None);
    let mut settings = "clock = now;".to_owned();
    let (mut rule, mut sections, mut run) = (String::new(), String::new(), String::new());
    for line in lines.filter(|line| !line.is_empty()) {
        match (line.strip_prefix("    "), line.split_once(": ")) {
            (Some(source), _) => {
                agent.push_str(source);
                agent.push('\n');
            }
            (None, Some(("rule", value))) => value.clone_into(&mut rule),
            (None, Some(("with", value))) => value.clone_into(&mut sections),
            (None, Some(("settings", value))) => value.clone_into(&mut settings),
            (None, Some(("run", value))) => value.clone_into(&mut run),
            (None, Some(("trace", value))) => trace = Some(value.trim().to_owned()),
            (None, Some(("refused", value))) => refused = Some(value.to_owned()),
            _ => panic!("{title}: what is `{line}`?"),
        }
    }
    let expected = match (trace, refused) {
        (Some(trace), None) => Expected::Trace { run, trace },
        (None, Some(refused)) => Expected::Refused(refused),
        _ => panic!("{title}: either a trace or a refusal"),
    };
    Case { title, rule, sections, settings, agent, expected }
}

/// The accepted agents.
pub(crate) fn agents() -> Vec<String> {
    let accepted = |case: &Case| matches!(case.expected, Expected::Trace { .. });
    cases().into_iter().filter(accepted).map(|case| case.agent).collect()
}

#[test]
fn every_program_means_what_the_suite_says() {
    let cases = cases();
    let next = AtomicUsize::new(0);
    let complaints = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let complaint = case.check();
                    complaints.lock().unwrap().extend(complaint);
                }
            });
        }
    });
    let complaints = complaints.into_inner().unwrap();
    assert!(complaints.is_empty(), "{} cases\n\n{}", complaints.len(), complaints.join("\n"));
    let refused = cases.iter().filter(|case| matches!(case.expected, Expected::Refused(_))).count();
    println!("{} programs with a trace, {refused} refused", cases.len() - refused);
}

#[test]
fn every_rule_has_a_case_and_every_case_a_rule() {
    let rules: BTreeSet<&str> = RULES.into();
    let cases = cases();
    let covered: BTreeSet<&str> = cases.iter().map(|case| case.rule.as_str()).collect();
    assert_eq!(rules.difference(&covered).collect::<Vec<_>>(), [&""; 0], "no case");
    assert_eq!(covered.difference(&rules).collect::<Vec<_>>(), [&""; 0], "no such rule");
}
