//! A program that makes given calls of an agent's C.

use crate::configuration::ExternalTrigger;
use crate::interpreter::Value;
use crate::syntax::ast::Performative;

pub use crate::backend::c::traced;

/// The file of the program.
pub const TESTS: &str = "tests.c";

/// What the environment does.
#[derive(Debug, Clone, PartialEq)]
pub enum Act {
    /// It raises an event.
    Raise(ExternalTrigger, Vec<Value>),
    /// It sets a belief.
    Set(String, Vec<Value>),
    /// A peer, the first value, says something.
    Receive(Performative, String, Vec<Value>),
    /// It begins again, as this peer.
    Be(usize),
    /// From now on a function returns these values in turn; the last one repeats.
    Answer(String, Vec<Value>),
    /// It drops all events.
    Clear,
    /// It calls `next_step()`.
    Step,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::Configuration;
    use crate::types::CType;
    use crate::{parse_configuration, scripted};

    const LAMP: &str =
        "settings { input = a.asl; output = lamp.c; header = lamp.h; basics = b.h; };
        structs { place_t { double x; int8_t y; }; };
        basics { bool on(place_t); int64_t age(void); }; types { light(place_t); lit(int64_t); };
        triggerables { +!light; }; settables { lit; };";

    #[test]
    fn a_test_is_the_same_calls_in_c() {
        let parsed = parse_configuration("a.conf", LAMP).unwrap();
        let light = parsed.declarations().triggerables[0].clone();
        let place = Value::Struct(vec![Value::Float(f64::NAN), Value::Integer(-1)]);
        let lowest = Value::Integer(i64::MIN.into());
        let acts = vec![
            Act::Answer("age".to_owned(), vec![Value::Integer(1), lowest.clone()]),
            Act::Set("lit".to_owned(), vec![lowest]),
            Act::Raise(light, vec![place]),
            Act::Step,
        ];
        let files = scripted(&parsed, "+!light(P) : lit(age) <- on(P).", &[acts]).unwrap();
        let program = &files.iter().find(|file| file.name == TESTS).unwrap().text;
        for part in [
            "static const int64_t asl2c_age_1[2] = { 1LL, (-9223372036854775807LL - 1LL) };",
            "set_lit((-9223372036854775807LL - 1LL));",
            "asl2c_trace_text(\"> achieve_light({nan}{-1}) = \");",
            "achieve_light((const place_t){ (0.0 / 0.0), -1LL })",
        ] {
            assert!(program.contains(part), "{part}:\n{program}");
        }
    }

    #[test]
    fn traced_values_have_their_bits() {
        let traced = |value, ctype| traced(&value, &CType::named(ctype), &Configuration::default());
        assert_eq!(traced(Value::Float(1.5), "double"), "0x3ff8000000000000");
        assert_eq!(traced(Value::Float(1.5), "float"), "0x3fc00000");
        assert_eq!(traced(Value::Float(-f64::NAN), "float"), "nan");
        assert_eq!(traced(Value::Integer(-3), "int8_t"), "-3");
        assert_eq!(traced(Value::Text("a".to_owned()), "const char *"), "a");
    }
}
