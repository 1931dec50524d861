//! A program that exercises an agent's C on any machine.

use crate::GeneratedFile;

pub use crate::backend::c::{EXERCISE_SEED, EXERCISE_STATE, EXERCISE_STEPS};

/// The file with `void asl2c_exercise(void)`.
pub const EXERCISE: &str = "exercise.c";

/// An agent's C as it is translated, and a program that makes random calls of its interface.
///
/// The calls depend only on the seed ([`EXERCISE_SEED`]) and the number of steps ([`EXERCISE_STEPS`]), so two
/// machines on which the C does the same leave the same trace: each call in either direction with all values.
/// The platform defines `void asl2c_trace_text(const char *)` and calls `asl2c_exercise()`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Exercise {
    /// The C file first, then its headers and [`EXERCISE`].
    pub files: Vec<GeneratedFile>,
    /// Linker symbols of the functions of the agent's interface, `next_step()` first.
    pub interface: Vec<String>,
    /// Linker symbols of the functions that the environment defines.
    pub environment: Vec<String>,
}

#[cfg(test)]
mod tests {
    use crate::{EXERCISE, exercise, parse_configuration};

    const LAMP: &str =
        "settings { input = a.asl; output = lamp.c; header = lamp.h; basics = b.h; };
        structs { place_t { double x; int8_t y; }; };
        basics { bool on(place_t); }; types { light(place_t); lit(int); };
        triggerables { +!light; }; settables { lit; };";

    #[test]
    fn every_call_in_either_direction_is_traced() {
        let configuration = parse_configuration("a.conf", LAMP).unwrap();
        let exercise = exercise(&configuration, "+!light(P) <- on(P).").unwrap();
        assert_eq!(exercise.interface[0], "next_step");
        assert!(exercise.interface.contains(&"set_lit".to_owned()));
        assert_eq!(exercise.environment, ["on", "updateBeliefs"]);
        let program = exercise.files.iter().find(|file| file.name == EXERCISE).unwrap();
        for part in [
            "asl2c_trace_text(\"on(\");",
            "asl2c_trace_signed(argument1.y);",
            "asl2c_trace_bool(achieve_light(argument1));",
            "const place_t argument1 = anything_place_t();",
            "asl2c_trace_text(\"> next_step()\\n\");",
        ] {
            assert!(program.text.contains(part), "{part}:\n{}", program.text);
        }
    }

    #[test]
    fn what_only_the_environment_knows_is_not_made_up() {
        let text = LAMP.replace("lit(int)", "lit(handle_t)");
        let configuration = parse_configuration("a.conf", &text).unwrap();
        let error = exercise(&configuration, "+!light(P) <- on(P).").unwrap_err();
        assert!(error.to_string().contains("`handle_t`"), "{error}");
    }
}
