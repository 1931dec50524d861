//! Messages as text, in the form of the Rust bindings.

use super::Value;
use crate::configuration::Configuration;
use crate::syntax::ast::Performative;
use crate::types::{CType, TypeKind};

/// A message as agents of this configuration write it: `tell at(1.5, 2.0, wingman)`.
pub fn message_text(
    configuration: &Configuration,
    performative: Performative,
    name: &str,
    values: &[Value],
) -> String {
    let head = format!("{} {name}", performative.name());
    let message = configuration.message(performative, name);
    let types = message.map_or(&[][..], |message| &message.parameters);
    let values: Vec<String> = types
        .iter()
        .zip(values)
        .map(|(ctype, value)| spelled(configuration, ctype, value))
        .collect();
    if values.is_empty() { head } else { format!("{head}({})", values.join(", ")) }
}

fn spelled(configuration: &Configuration, ctype: &CType, value: &Value) -> String {
    match value {
        Value::Integer(number) if ctype.is_peer() => {
            let peer = usize::try_from(*number).ok();
            let peer = peer.and_then(|number| configuration.peers.get(number));
            // A number that no peer has stays one.
            peer.map_or_else(|| number.to_string(), |peer| peer.text.clone())
        }
        Value::Float(number) if number.is_nan() => "nan".to_owned(),
        #[allow(clippy::cast_possible_truncation, reason = "it has been rounded to this precision")]
        Value::Float(number) if ctype.kind == TypeKind::Float32 => format!("{:?}", *number as f32),
        Value::Float(number) => format!("{number:?}"),
        Value::Struct(values) => {
            let fields = configuration.fields(&ctype.name).iter().zip(values);
            let fields = fields.map(|((_, ctype), value)| spelled(configuration, ctype, value));
            format!("{{{}}}", fields.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::parse;

    #[test]
    fn values_are_those_of_their_types() {
        let text = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
            structs { place_t { double x; float y; bool known; }; };\n\
            peers { leader, wingman };\n\
            messages { tell at(double, float, place_t, peer) from any; achieve go from any; };";
        let configuration = parse(text).0;
        let place = vec![Value::Float(1e300), Value::Float(f64::from(0.1_f32)), Value::Bool(true)];
        let mut values = vec![
            Value::Float(2.0),
            Value::Float(f64::from(0.1_f32)),
            Value::Struct(place),
            Value::Integer(1),
        ];
        let text = |performative, name, values: &[Value]| {
            message_text(&configuration, performative, name, values)
        };
        assert_eq!(
            text(Performative::Tell, "at", &values),
            "tell at(2.0, 0.1, {1e300, 0.1, true}, wingman)"
        );
        values[0] = Value::Float(f64::NAN);
        values[1] = Value::Float(f64::NEG_INFINITY);
        values[3] = Value::Integer(7);
        assert_eq!(
            text(Performative::Tell, "at", &values),
            "tell at(nan, -inf, {1e300, 0.1, true}, 7)"
        );
        assert_eq!(text(Performative::Untell, "at", &[]), "untell at");
        assert_eq!(text(Performative::Achieve, "go", &[]), "achieve go");
    }
}
