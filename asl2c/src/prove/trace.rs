//! Converts CBMC's traces to scripts of the environment's actions.

use serde::Deserialize;
use translator::configuration::Configuration;
use translator::interpreter::Value;
use translator::types::{CType, TypeKind};
use translator::{ANSWERS, CALLS, STEPS};

/// A failing assertion: its name and description, and the environment's actions.
#[derive(Debug, Clone)]
pub(super) struct Trace {
    pub(super) name: String,
    pub(super) said: String,
    outputs: Vec<Output>,
}

/// A result of CBMC, as JSON.
#[derive(Debug, Deserialize)]
struct Message {
    result: Option<Vec<Checked>>,
}

#[derive(Debug, Deserialize)]
struct Checked {
    property: String,
    #[serde(default)]
    description: String,
    #[serde(default)]
    trace: Vec<Step>,
}

/// A step of a trace; only outputs matter.
#[derive(Debug, Clone, Deserialize)]
struct Step {
    #[serde(rename = "stepType")]
    kind: String,
    #[serde(rename = "outputID")]
    output_id: Option<String>,
    #[serde(default)]
    values: Vec<Bits>,
}

#[derive(Debug, Clone)]
struct Output {
    what: String,
    values: Vec<Bits>,
}

#[derive(Debug, Clone, Deserialize)]
struct Bits {
    #[serde(default)]
    binary: String,
}

/// The traces in CBMC's output; `None` if it has no result.
pub(super) fn traces(text: &str) -> Option<Vec<Trace>> {
    let messages: Vec<Message> = serde_json::from_str(text).ok()?;
    let checked = messages.into_iter().find_map(|message| message.result)?;
    let failing = checked.into_iter().filter(|checked| !checked.trace.is_empty());
    let traces = failing.map(|Checked { property, description, trace }| {
        let outputs = trace.into_iter().filter(|step| step.kind == "output");
        let outputs =
            outputs.filter_map(|step| Some(Output { what: step.output_id?, values: step.values }));
        Trace { name: property, said: description, outputs: outputs.collect() }
    });
    Some(traces.collect())
}

/// The environment's actions that lead to a failure.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Way {
    pub(super) acts: Vec<Act>,
}

/// One line of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Act {
    pub(super) kind: Kind,
    /// `achieve_land`, `onGround`
    pub(super) name: String,
    pub(super) values: Vec<Value>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// The environment calls the agent.
    Call,
    /// A function's result in the following step.
    Answers,
    Step,
}

impl Way {
    /// Converts a trace; results are placed before the step in which they are returned.
    pub(super) fn new(trace: &Trace, configuration: &Configuration) -> Option<Self> {
        let mut acts: Vec<Act> = Vec::new();
        let mut step: Option<usize> = None;
        for Output { what, values } in &trace.outputs {
            let (kind, name) = what.split_once(' ').unwrap_or((what.as_str(), ""));
            let values = |types: &[CType]| -> Option<Vec<Value>> {
                types.iter().zip(values).map(|(ctype, bits)| decode(&bits.binary, ctype)).collect()
            };
            let name = name.to_owned();
            match kind {
                CALLS => {
                    let mut received = configuration.receiving().into_iter();
                    let values = match received.find(|(function, ..)| *function == name) {
                        Some((_, performative, message)) => values(&message.said(performative))?,
                        None if name == "init" => values(&[CType::peer()])?,
                        None => values(parameters(configuration, &name))?,
                    };
                    // The clock may be asked when a message arrives.
                    step = Some(acts.len());
                    acts.push(Act { kind: Kind::Call, name, values });
                }
                STEPS => {
                    step = Some(acts.len());
                    acts.push(Act { kind: Kind::Step, name, values: Vec::new() });
                }
                ANSWERS => {
                    let mut basics = configuration.basics.iter();
                    let basic = basics.find(|basic| basic.name.text == name)?;
                    let values = values(std::slice::from_ref(&basic.result))?;
                    let at = step?;
                    // The results of this step stand between the line before it and the step.
                    let before = acts[..at].iter().rposition(|act| act.kind != Kind::Answers);
                    let begin = before.map_or(0, |before| before + 1);
                    if let Some(act) = acts[begin..at].iter_mut().find(|act| act.name == name) {
                        act.values.extend(values);
                    } else {
                        acts.insert(at, Act { kind: Kind::Answers, name, values });
                        step = Some(at + 1);
                    }
                }
                _ => {}
            }
        }
        Some(Self { acts })
    }

    /// Number of events, beliefs that are set, and steps.
    pub(super) fn transitions(&self) -> u32 {
        let transitions = self.acts.iter().filter(|act| act.kind != Kind::Answers).count();
        // A search is never as long as that.
        u32::try_from(transitions).unwrap_or(u32::MAX)
    }

    /// The lines of the script.
    pub(crate) fn lines(&self) -> impl Iterator<Item = String> {
        self.acts.iter().map(Act::line)
    }
}

impl Act {
    fn line(&self) -> String {
        let values: Vec<String> = self.values.iter().map(Value::to_string).collect();
        let values = values.join(", ");
        match self.kind {
            Kind::Call => format!("{}({values});", self.name),
            Kind::Answers => format!("{}_result = {values};", self.name),
            Kind::Step => "next_step();".to_owned(),
        }
    }
}

/// Types of the arguments of `achieve_g`, `add_b` and `set_b`; none for `del_b`, which removes the belief
/// whatever its values.
fn parameters<'a>(configuration: &'a Configuration, call: &str) -> &'a [CType] {
    let prefixes = ["achieve_", "add_", "set_"];
    let name = prefixes.iter().find_map(|prefix| call.strip_prefix(prefix));
    let declared = name.and_then(|name| {
        configuration.predicates.iter().find(|declared| declared.name.text == name)
    });
    declared.map_or(&[], |declared| &declared.parameters)
}

/// The value of a bit string, highest bit first.
fn decode(binary: &str, ctype: &CType) -> Option<Value> {
    let bits = u64::from_str_radix(binary, 2).ok()?;
    Some(match ctype.kind {
        TypeKind::Bool => Value::Bool(bits != 0),
        TypeKind::Float64 => Value::Float(f64::from_bits(bits)),
        TypeKind::Float32 => Value::Float(f32::from_bits(u32::try_from(bits).ok()?).into()),
        TypeKind::Unsigned { .. } => Value::Integer(bits.into()),
        TypeKind::Signed { bits: width } => {
            let value = i128::from(bits);
            let is_negative = value >> (width - 1) & 1 == 1;
            Value::Integer(if is_negative { value - (1 << width) } else { value })
        }
        TypeKind::Text | TypeKind::Struct | TypeKind::Opaque | TypeKind::Void => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_values() {
        let value = |bits: &str, ctype: &str| decode(bits, &CType::named(ctype)).unwrap();
        assert_eq!(value("11111111", "int8_t"), Value::Integer(-1));
        assert_eq!(value("11111111", "uint8_t"), Value::Integer(255));
        assert_eq!(value("01111111", "int8_t"), Value::Integer(127));
        assert_eq!(value(&"1".repeat(64), "int64_t"), Value::Integer(-1));
        assert_eq!(value("00000001", "bool"), Value::Bool(true));
        assert_eq!(value(&format!("{:064b}", 1.5_f64.to_bits()), "double"), Value::Float(1.5));
        assert_eq!(
            value(&format!("{:032b}", 0.1_f32.to_bits()), "float"),
            Value::Float(0.1_f32.into())
        );
        assert_eq!(decode("", &CType::named("int")), None);
    }
}
