//! Runs the reference interpreter.

use std::fmt::Write as _;

use translator::interpreter::{Environment, Interpreter, Value};
use translator::parse_configuration;
use translator::syntax::ast::{Operator, TriggerKind};
use translator::types::{CType, TypeKind};

use super::generate::{BELIEFS, Command, FUNCTIONS, GOALS, RandomAgent, Type};

/// The trace of all sequences; `None` if the agent is refused.
pub(super) fn run(agent: &RandomAgent, sequences: &[Vec<Command>]) -> Option<String> {
    let configuration = parse_configuration("agent.conf", &agent.configuration)
        .unwrap_or_else(|error| panic!("{error}"));
    let mut interpreter = Interpreter::new(&configuration, &agent.text).ok()?;
    let mut world = World::default();
    for sequence in sequences {
        interpreter.init();
        world.calls = 0;
        world.pending = None;
        world.trace.push_str("sequence\n");
        for command in sequence {
            execute(&mut interpreter, &mut world, command);
        }
    }
    Some(world.trace)
}

fn execute(interpreter: &mut Interpreter, world: &mut World, command: &Command) {
    match command {
        Command::Step => {
            interpreter.next_step(world);
            let counts = (interpreter.unhandled_events(), interpreter.refused_events());
            let aborted = interpreter.aborted_events();
            _ = writeln!(world.trace, "step {} {} {aborted}", counts.0, counts.1);
        }
        Command::Raise(verb, name, arguments) => {
            let (operator, kind) = match *verb {
                "achieve" => (Operator::Add, TriggerKind::Achieve),
                "add" => (Operator::Add, TriggerKind::Belief),
                _ => (Operator::Delete, TriggerKind::Belief),
            };
            let types = BELIEFS.iter().chain(&GOALS).find(|(other, _)| other == name).unwrap().1;
            let values = arguments.iter().zip(types).map(|(text, t)| parse(text, *t)).collect();
            let accepted = interpreter.raise(operator, kind, name, values).is_ok();
            _ = writeln!(world.trace, "raise {}", u8::from(accepted));
        }
        Command::Set(first, second) => {
            world.pending = Some(vec![parse(first, Type::Int), parse(second, Type::Int)]);
        }
        Command::Init => interpreter.init(),
        Command::Clear => interpreter.clear(),
    }
}

fn parse(text: &str, ctype: Type) -> Value {
    match ctype {
        Type::Bool => Value::Bool(text == "true"),
        Type::Double => Value::Float(text.parse().unwrap()),
        _ => Value::Integer(text.parse().unwrap()),
    }
}

#[derive(Default)]
struct World {
    trace: String,
    calls: u32,
    pending: Option<Vec<Value>>,
}

impl Environment for World {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        self.pending.take().map(|values| ("b2".to_owned(), values)).into_iter().collect()
    }

    fn call(&mut self, name: &str, arguments: &[Value], result: &CType) -> Option<Value> {
        self.trace.push_str(name);
        let mut hash = Hash::new(name, self.calls);
        for argument in arguments {
            match argument {
                Value::Bool(value) => {
                    _ = write!(self.trace, " {}", u8::from(*value));
                    hash.mix(u32::from(*value));
                }
                Value::Integer(value) => {
                    _ = write!(self.trace, " {value}");
                    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                    hash.mix(*value as u32);
                }
                Value::Float(value) => {
                    let bits = if value.is_nan() { 0 } else { value.to_bits() };
                    _ = write!(self.trace, " {bits:016x}");
                    #[allow(clippy::cast_possible_truncation)]
                    hash.mix(bits as u32);
                    hash.mix((bits >> 32) as u32);
                }
                Value::Text(_) | Value::Struct(_) => unreachable!("none are generated"),
            }
        }
        self.trace.push('\n');
        if FUNCTIONS.iter().any(|(function, ..)| *function == name) {
            self.calls += 1;
        }
        hash.result(result)
    }
}

/// Results of functions: a hash of the function, its arguments and the number of calls so far.
struct Hash(u32);

impl Hash {
    fn new(name: &str, calls: u32) -> Self {
        let mut hash = Self(2_166_136_261);
        hash.mix(u32::from(name.as_bytes()[1]));
        hash.mix(calls);
        hash
    }

    fn mix(&mut self, value: u32) {
        self.0 = (self.0 ^ value).wrapping_mul(16_777_619);
    }

    fn result(&self, ctype: &CType) -> Option<Value> {
        let hash = self.0;
        let choice = hash >> 5;
        let extreme = hash.trailing_zeros() >= 5;
        Some(match ctype.kind {
            TypeKind::Void | TypeKind::Text | TypeKind::Struct | TypeKind::Opaque => return None,
            TypeKind::Bool => Value::Bool(choice & 4 != 0),
            TypeKind::Float32 | TypeKind::Float64 => {
                Value::Float([0.0, 1.5, -2.0, 0.1, 1e300, -0.0][choice as usize % 6])
            }
            TypeKind::Signed { bits: 8 } if extreme => Value::Integer(127),
            TypeKind::Signed { .. } if extreme => Value::Integer(2_147_483_647),
            TypeKind::Signed { .. } => Value::Integer(i128::from(choice % 7) - 3),
            TypeKind::Unsigned { .. } if extreme => Value::Integer(65_535),
            TypeKind::Unsigned { .. } => Value::Integer(i128::from(choice % 7)),
        })
    }
}
