//! Input of a model checker for proving an agent's properties.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::GeneratedFile;
use crate::backend::c::Moment;
use crate::configuration::DeclaredProperty;

pub use crate::backend::c::{ANSWERS, CALLS, STEPS};

/// The file of a proof that includes all others.
pub const HARNESS: &str = "harness.c";

/// Assertions on an agent's C, and the environment in which they must hold.
///
/// A proof needs an invariant: it starts with all candidates and removes those that do not hold initially, or
/// that some transition breaks, until the rest is inductive.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "the assertions have to be proved"]
pub struct Obligations {
    /// The C of the agent and [`HARNESS`], with the functions `base`, `induction` and `main`.
    pub files: Vec<GeneratedFile>,
    /// Linker symbol of `next_step()` with the state passed in.
    pub entry: String,
    /// A bound for all loops of the C.
    pub unwinding: usize,
    pub(crate) state_type: String,
    pub(crate) candidates: Vec<String>,
    pub(crate) fixed: BTreeMap<usize, String>,
    pub(crate) moments: Vec<Moment>,
    /// The properties: each has an assertion `property NAME`.
    pub properties: Vec<DeclaredProperty>,
}

impl Obligations {
    /// The candidates for the invariant, as C.
    pub fn candidates(&self) -> &[String] {
        &self.candidates
    }

    /// The file `invariant.h` of an invariant of these candidates; each has an assertion
    /// `candidate INDEX`.
    pub fn invariant(&self, chosen: &[usize]) -> GeneratedFile {
        self.restricted(chosen, &[])
    }

    /// Files like [`Self::invariant`] that restrict the states to those whose next step handles a goal of this name:
    /// one for each way in which it can be pending.
    pub fn invariants_at(&self, chosen: &[usize], goal: &str) -> Vec<GeneratedFile> {
        let moments = self.moments.iter().filter(|moment| moment.goal == goal);
        moments.map(|moment| self.restricted(chosen, &moment.sets)).collect()
    }

    fn restricted(&self, chosen: &[usize], sets: &[String]) -> GeneratedFile {
        let conditions =
            || chosen.iter().filter_map(|index| Some((index, self.candidates.get(*index)?)));
        let mut text = String::new();
        // Writing to a string cannot fail.
        _ = writeln!(text, "static void assume_invariant({} *self)\n{{", self.state_type);
        text += "    (void)self;\n";
        // An assumption follows each assignment, so that both say the same of an arbitrary state. But a constant that is
        // assigned is known before paths are followed; without, most that are followed cannot be taken.
        let fixed = chosen.iter().filter_map(|index| self.fixed.get(index));
        for set in fixed.chain(sets) {
            _ = writeln!(text, "    {set}");
        }
        for (_, condition) in conditions() {
            _ = writeln!(text, "    __CPROVER_assume({condition});");
        }
        text += "}\n\n";
        _ = writeln!(text, "static void check_invariant(const {} *self)\n{{", self.state_type);
        text += "    (void)self;\n";
        for (index, condition) in conditions() {
            _ = writeln!(text, "    __CPROVER_assert({condition}, \"candidate {index}\");");
        }
        text += "}\n";
        GeneratedFile { name: "invariant.h".to_owned(), text, setting: "" }
    }
}

#[cfg(test)]
mod tests {
    use crate::{obligations, parse_configuration};

    const LAMP: &str =
        "settings { input = a.asl; output = lamp.c; header = lamp.h; basics = b.h; };
        basics { void on(void); }; types { light(void); lit(int); }; triggerables { +!light; };
        settables { lit; }; properties { one [R-1]: at_most_one(on);
            answered:  within(1, +!light,
                on); };";

    #[test]
    fn a_proof_has_an_environment_an_invariant_and_its_properties() {
        let configuration = parse_configuration("a.conf", LAMP).unwrap();
        let obligations = obligations(&configuration, "+!light <- on.").unwrap();
        let formulas = obligations.properties.iter().map(|property| property.formula.as_str());
        assert!(formulas.eq(["at_most_one(on)", "within(1, +!light, on)"]));
        assert_eq!(obligations.properties[0].requirements, ["R-1"]);
        let harness = &obligations.files.last().unwrap().text;
        for part in
            ["\"property one\"", "= any_int();", "\"calls set_lit\"", "lamp_achieve_light(self)"]
        {
            assert!(harness.contains(part), "{part}:\n{harness}");
        }
        assert!(obligations.candidates().len() > 5);
        let invariant = obligations.invariant(&[0, 999]);
        assert!(invariant.text.contains("\"candidate 0\"") && !invariant.text.contains("999"));
    }

    #[test]
    fn what_is_constant_is_assigned_and_assumed() {
        let configuration = parse_configuration("a.conf", LAMP).unwrap();
        let obligations = obligations(&configuration, "lit(7). +!light <- on.").unwrap();
        let chosen: Vec<usize> = (0..obligations.candidates().len()).collect();
        let text = obligations.invariant(&chosen).text;
        for part in [
            "    self->belief_lit_1 = 7;\n",
            "__CPROVER_assume((self->belief_lit_1 == 7));",
            "__CPROVER_assert((self->belief_lit_1 == 7), ",
            "    self->belief_lit_held = true;\n",
        ] {
            assert!(text.contains(part), "{part}:\n{text}");
        }
        assert!(text.rfind(" = true;") < text.find("__CPROVER_assume("), "{text}");
        // What is not chosen is not said.
        let text = obligations.invariant(&[]).text;
        assert!(!text.contains("lit"), "{text}");
    }

    /// Other values are equal to a constant than it: 0.0 and -0.0.
    #[test]
    fn what_has_equals_is_not_assigned() {
        let text = LAMP.replace("lit(int)", "lit(double)");
        let configuration = parse_configuration("a.conf", &text).unwrap();
        let obligations = obligations(&configuration, "lit(0.0). +!light <- on.").unwrap();
        let chosen: Vec<usize> = (0..obligations.candidates().len()).collect();
        let text = obligations.invariant(&chosen).text;
        assert!(text.contains("assume((self->belief_lit_1 == 0.0))"), "{text}");
        assert!(!text.contains("self->belief_lit_1 = "), "{text}");
    }

    #[test]
    fn a_step_may_handle_a_goal_in_each_way_in_which_it_can_be_pending() {
        let text = LAMP
            .replace("+!light; };", "+!light; +!stop; }; preemptive { +!stop; };")
            .replace("light(void);", "light(void); stop(void);");
        let configuration = parse_configuration("a.conf", &text).unwrap();
        let agent = "+!light <- on; !light. +!stop <- on.";
        let obligations = obligations(&configuration, agent).unwrap();
        let first = |goal: &str| -> Vec<String> {
            let files = obligations.invariants_at(&[], goal);
            files.into_iter().map(|file| file.text).collect()
        };
        let [posted, raised] = &first("light")[..] else { panic!("{:?}", first("light")) };
        for part in ["preemptive_achieve_stop_pending = false", "posted = LAMP_EVENT_POSTED_"] {
            assert!(posted.contains(part), "{part}:\n{posted}");
        }
        for part in ["posted = LAMP_EVENT_NONE", "inbox_count = 1U", "inbox_queue[0] = LAMP_EVENT_"]
        {
            assert!(raised.contains(part), "{part}:\n{raised}");
        }
        let [urgent] = &first("stop")[..] else { panic!("{:?}", first("stop")) };
        assert!(urgent.contains("preemptive_achieve_stop_pending = true"), "{urgent}");
        assert_eq!(first("dim"), [""; 0]);
    }

    #[test]
    fn calls_that_return_a_value_are_counted() {
        let text = LAMP.replace("void on(void);", "bool on(void);");
        let configuration = parse_configuration("a.conf", &text).unwrap();
        let obligations = obligations(&configuration, "+!light <- X = on; +lit(1).").unwrap();
        let harness = &obligations.files.last().unwrap().text;
        for part in [
            "calls_on = (calls_on < 2U)",
            "calls_on = 0U;",
            "= any_bool();",
            "\"answers on\", result",
        ] {
            assert!(harness.contains(part), "{part}:\n{harness}");
        }
    }

    #[test]
    fn what_only_the_environment_knows_is_not_made_up() {
        let text = LAMP.replace("lit(int)", "lit(handle_t)");
        let configuration = parse_configuration("a.conf", &text).unwrap();
        let error = obligations(&configuration, "+!light <- on.").unwrap_err();
        assert!(error.to_string().contains("`handle_t`"), "{error}");
    }

    /// A proof needs the state passed in, and proves exactly the agent that would be translated.
    #[test]
    fn what_is_not_translated_is_not_proved() {
        let text = LAMP.replace("basics = b.h;", "basics = b.h; rust = b.rs;");
        let configuration = parse_configuration("a.conf", &text).unwrap();
        let error = obligations(&configuration, "+!light <- on.").unwrap_err();
        assert_eq!(error.diagnostics()[0].code, "rust-boundary");
        let configuration = parse_configuration("a.conf", LAMP).unwrap();
        let proof = obligations(&configuration, "+!light <- on.").unwrap();
        assert!(proof.files[0].text.contains("lamp_next_step"));
        let translation = crate::translate(&configuration, "+!light <- on.").unwrap();
        assert!(!translation.files[0].text.contains("lamp_next_step"));
    }
}
