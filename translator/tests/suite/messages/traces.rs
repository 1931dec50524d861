//! What an agent does, interpreted and compiled.

use std::fmt::Write as _;
use std::fs::File;
use std::process::Command as Process;

use translator::interpreter::{Environment, Interpreter, Value};
use translator::syntax::ast::{Operator, TriggerKind};
use translator::types::CType;
use translator::{ParsedConfiguration, translate};

use super::talker::{Command, Talker, Type};
use crate::harness::STRICT;

/// What the environment offers, in C: all functions print their call.
const PRELUDE: &str = r#"
#include <stdio.h>
void updateBeliefs(void) { }
void act(int x) { printf("act %d\n", x); }
void who(peer_t x) { printf("who %d\n", (int)x); }
void both(int x, peer_t y) { printf("both %d %d\n", x, (int)y); }
bool even(int x) { printf("even %d\n", x); return (x % 2) == 0; }
bool odd(peer_t x) { printf("odd %d\n", (int)x); return (x % 2U) == 1U; }
int next(int x) { printf("next %d\n", x); return (x == 3) ? 0 : ((x < 3) ? (x + 1) : 3); }
peer_t other(peer_t x) { printf("other %d\n", (int)x); return (x == 0U) ? 1U : 0U; }
static int clock_ms = 0;
int now(void) { printf("now\n"); return clock_ms; }
static void answer(bool yes) { printf("%s\n", yes ? "yes" : "no"); }
"#;

/// The trace of the interpreter.
pub(super) fn interpreted(mut agent: Interpreter, sequences: &[Vec<Command>]) -> String {
    let mut trace = Trace::default();
    for command in sequences.iter().flatten() {
        trace.executes(&mut agent, command);
    }
    trace.text
}

/// What an agent has done.
#[derive(Default)]
pub(super) struct Trace {
    pub(super) text: String,
    /// The messages that it has sent: each action's name and its arguments, the first of which is the receiver.
    pub(super) sent: Vec<(String, Vec<i64>)>,
    time: i32,
}

impl Trace {
    pub(super) fn executes(&mut self, agent: &mut Interpreter, command: &Command) {
        let values = |arguments: &[i64]| -> Vec<Value> {
            arguments.iter().map(|argument| Value::Integer((*argument).into())).collect()
        };
        let answer = |accepted: bool| if accepted { "yes\n" } else { "no\n" };
        match command {
            Command::Step => {
                agent.next_step(self);
                let counts = (agent.unhandled_events(), agent.refused_events());
                let aborted = agent.aborted_events();
                _ = writeln!(self.text, "step {} {} {aborted}", counts.0, counts.1);
            }
            Command::Receive(from, performative, name, arguments) => {
                let accepted = agent.receive(*from, *performative, name, values(arguments), self);
                self.text.push_str(answer(accepted));
            }
            Command::Raise(verb, name, arguments) => {
                let (operator, kind) = match *verb {
                    "achieve" => (Operator::Add, TriggerKind::Achieve),
                    "add" => (Operator::Add, TriggerKind::Belief),
                    _ => (Operator::Delete, TriggerKind::Belief),
                };
                let accepted = agent.raise(operator, kind, name, values(arguments)).is_ok();
                self.text.push_str(answer(accepted));
            }
            Command::Time(time) => self.time = *time,
            Command::Set(name, arguments) => agent.set((*name).to_owned(), values(arguments)),
            Command::Init(me) => {
                agent.be(*me);
                self.text.push_str("init\n");
            }
            Command::Clear => agent.clear(),
        }
    }
}

impl Environment for Trace {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        Vec::new()
    }

    fn call(&mut self, name: &str, arguments: &[Value], _: &CType) -> Option<Value> {
        let integers = arguments.iter().map(|argument| match argument {
            Value::Integer(value) => *value,
            _ => unreachable!("there are only numbers and peers"),
        });
        let integers: Vec<i128> = integers.collect();
        self.text.push_str(name);
        for value in &integers {
            _ = write!(self.text, " {value}");
        }
        self.text.push('\n');
        if name.starts_with("send_") {
            let arguments = integers.iter().map(|value| i64::try_from(*value).unwrap());
            self.sent.push((name.to_owned(), arguments.collect()));
        }
        match (name, integers.as_slice()) {
            ("even" | "odd", [value]) => Some(Value::Bool((value % 2 != 0) == (name == "odd"))),
            ("now", _) => Some(Value::Integer(self.time.into())),
            ("next", [value]) => {
                Some(Value::Integer(if *value == 3 { 0 } else { 3.min(value + 1) }))
            }
            ("other", [value]) => Some(Value::Integer(i128::from(*value == 0))),
            _ => None,
        }
    }
}

/// The trace of the C of an agent with this text, or why it cannot be compiled.
pub(super) fn compiled(
    talker: &Talker,
    text: &str,
    parsed: &ParsedConfiguration,
    sequences: &[Vec<Command>],
) -> Result<String, String> {
    let translation = translate(parsed, text).map_err(|error| error.to_string())?;
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for file in &translation.files {
        std::fs::write(path(&file.name), &file.text).unwrap();
    }
    let preempts = translation.files.iter().any(|file| file.text.contains("aborted_events"));
    let (main, commands) =
        script(talker, sequences, if preempts { "aborted_events()" } else { "0U" });
    // One compilation unit, because compilation dominates the time.
    let main = format!("#include \"agent.c\"\n{PRELUDE}{}{main}", sending(parsed));
    std::fs::write(path("main.c"), main).unwrap();
    std::fs::write(path("commands"), commands).unwrap();
    let compiler = std::env::var("ASL2C_CC").unwrap_or_else(|_| "cc".to_owned());
    let mut compile = Process::new(&compiler);
    if compiler == "cc" {
        compile.args(STRICT).arg("-pipe");
    }
    let compile = compile.current_dir(folder.path()).args(["-o", "agent", "main.c"]);
    let result = compile.output().unwrap();
    if !result.status.success() {
        let message = String::from_utf8_lossy(&result.stderr);
        return Err(format!("{message}\n{}", translation.files[0].text));
    }
    let commands = File::open(path("commands")).unwrap();
    let result = Process::new(path("agent")).stdin(commands).output().unwrap();
    let trace = String::from_utf8_lossy(&result.stdout).into_owned();
    if result.status.success() { Ok(trace) } else { Err(format!("{trace}{:?}", result.status)) }
}

/// The actions that send messages.
fn sending(parsed: &ParsedConfiguration) -> String {
    let mut text = String::new();
    for action in parsed.declarations().sending() {
        let (mut parameters, mut form, mut values) = (Vec::new(), String::new(), String::new());
        for (index, ctype) in action.parameters.iter().enumerate() {
            parameters.push(format!("{} x{index}", ctype.name));
            form.push_str(" %d");
            _ = write!(values, ", (int)x{index}");
        }
        let (name, parameters) = (&action.name.text, parameters.join(", "));
        _ = writeln!(text, "void {name}({parameters}) {{ printf(\"{name}{form}\\n\"{values}); }}");
    }
    text
}

/// A program that executes commands, and what it reads: for each command its number in the program, and numbers.
fn script(talker: &Talker, sequences: &[Vec<Command>], aborted: &str) -> (String, String) {
    let (mut known, mut read) = (Vec::new(), String::new());
    for command in sequences.iter().flatten() {
        let types = |name: &str, arguments: &[i64]| {
            let same = talker.predicates.iter().find(|predicate| predicate.name == name);
            same.unwrap().types[..arguments.len()].to_vec()
        };
        // What is called, and the types and values of its arguments.
        let (call, types, values): (String, Vec<Type>, Vec<i64>) = match command {
            Command::Step => ("step".to_owned(), Vec::new(), Vec::new()),
            Command::Receive(from, performative, name, arguments) => (
                format!("receive_{}_{name}", performative.name()),
                [vec![Type::Peer], types(name, arguments)].concat(),
                [vec![number(*from)], arguments.clone()].concat(),
            ),
            Command::Raise(verb, name, arguments) => {
                (format!("{verb}_{name}"), types(name, arguments), arguments.clone())
            }
            Command::Set(name, arguments) => {
                (format!("set_{name}"), types(name, arguments), arguments.clone())
            }
            Command::Time(time) => ("show".to_owned(), vec![Type::Int], vec![(*time).into()]),
            Command::Init(me) => ("begin".to_owned(), vec![Type::Peer], vec![number(*me)]),
            Command::Clear => ("clear".to_owned(), Vec::new(), Vec::new()),
        };
        let form = (call, types, matches!(command, Command::Receive(..) | Command::Raise(..)));
        let place = known.iter().position(|other| *other == form).unwrap_or_else(|| {
            known.push(form);
            known.len() - 1
        });
        _ = write!(read, "{place}");
        for value in values {
            _ = write!(read, " {value}");
        }
        read.push('\n');
    }
    let mut text = format!(
        "static void step(void) {{ next_step(); printf(\"step %u %u %u\\n\", (unsigned)unhandled_events(), \
         (unsigned)refused_events(), (unsigned){aborted}); }}\n\
         static void show(int time) {{ clock_ms = time; }}\n\
         static void begin(peer_t me) {{ init(me); puts(\"init\"); }}\n\
         static int number(void) {{ int value = 0; return (scanf(\"%d\", &value) == 1) ? value : -1; }}\n\
         int main(void)\n{{\nint a[4] = {{0}};\n(void)a;\n(void)answer;\n(void)show;\nfor (;;) {{ switch (number()) {{\n"
    );
    for (number, (call, types, is_answered)) in known.iter().enumerate() {
        _ = write!(text, "case {number}: ");
        for (index, ctype) in types.iter().enumerate() {
            let limit = if *ctype == Type::Peer { " & 0xFF" } else { "" };
            _ = write!(text, "a[{index}] = number(){limit}; ");
        }
        let arguments = types.iter().enumerate().map(|(index, ctype)| match ctype {
            Type::Int => format!("a[{index}]"),
            Type::Peer => format!("(peer_t)a[{index}]"),
        });
        let call = format!("{call}({})", arguments.collect::<Vec<_>>().join(", "));
        _ = match is_answered {
            true => writeln!(text, "answer({call}); break;"),
            false => writeln!(text, "{call}; break;"),
        };
    }
    text.push_str("default: return 0; } }\n}\n");
    (text, read)
}

fn number(peer: usize) -> i64 {
    i64::try_from(peer).unwrap()
}
