//! A known beginning of an execution, which both make before the model checker chooses what happens.

use std::fmt::Write as _;

use super::Comparison;
use crate::backend::c::host::{CALLS, STEPS};
use crate::backend::c::literal::literal;
use crate::backend::c::messages::{Received, received};
use crate::backend::c::state::external_name;
use crate::configuration::ExternalTrigger;
use crate::interpreter::Value;
use crate::scripted::Act;
use crate::types::{CType, TypeKind};

impl Comparison<'_> {
    /// The function `plain_beginning()`; its calls and answers are recorded in the trace.
    pub(super) fn begin(&self, text: &mut String) {
        text.push_str("static void plain_beginning(void)\n{\n    plain_watched = PLAIN_NEVER;\n");
        for (number, basic) in self.program.configuration.basics.iter().enumerate() {
            if basic.result.kind != TypeKind::Void {
                let zero = literal(self.program, None, &basic.result);
                self.give(text, number, &[zero]);
            }
        }
        for act in self.beginning {
            match act {
                Act::Raise(event, values) => self.raise(text, event, values),
                Act::Set(belief, values) => self.set(text, belief, values),
                Act::Receive(performative, about, values) => {
                    let mut functions = received(self.program).into_iter();
                    let function = functions
                        .find(|one| one.performative == *performative && one.about == *about);
                    if let Some(function) = function {
                        self.receive(text, &function, values);
                    }
                }
                // The known beginning is that of the first peer.
                Act::Be(_) => {}
                Act::Answer(function, values) => {
                    let mut basics = self.program.configuration.basics.iter().enumerate();
                    let found = basics.find(|(_, basic)| basic.name.text == *function);
                    let Some((number, basic)) = found else { continue };
                    let values = values.iter();
                    let values =
                        values.map(|value| literal(self.program, Some(value), &basic.result));
                    self.give(text, number, &values.collect::<Vec<_>>());
                }
                Act::Clear => {
                    _ = writeln!(text, "    __CPROVER_output(\"{CALLS} clear\", 0U);");
                    let clear = self.names.call("clear", None);
                    _ = writeln!(text, "    {clear};\n    plain_clear();\n    plain_compare();");
                }
                Act::Step => {
                    _ = writeln!(text, "    __CPROVER_output(\"{STEPS}\", 0U);");
                    text.push_str("    plain_both_step();\n");
                }
            }
        }
        for (number, basic) in self.program.configuration.basics.iter().enumerate() {
            if basic.result.kind != TypeKind::Void {
                _ = writeln!(text, "    plain_given_{number} = 0;");
            }
        }
        text.push_str("}\n\n");
    }

    /// From now on a function returns these values in turn; the last one repeats.
    fn give(&self, text: &mut String, number: usize, values: &[String]) {
        let result = &self.program.configuration.basics[number].result.name;
        let (count, values) = (values.len(), values.join(", "));
        _ = writeln!(
            text,
            "    {{\n        static const {result} given[{count}] = {{ {values} }};"
        );
        _ = writeln!(text, "        plain_given_{number} = given;");
        _ = writeln!(text, "        plain_given_left_{number} = {count};\n    }}");
    }

    fn raise(&self, text: &mut String, event: &ExternalTrigger, values: &[Value]) {
        let Some((number, external)) = self.program.raised(event) else { return };
        let name = external_name(external);
        self.accept(text, (&name, &format!("plain_raise_{number}")), values, &external.types);
    }

    fn receive(&self, text: &mut String, function: &Received, values: &[Value]) {
        let name = &function.name;
        self.accept(text, (name, &format!("plain_{name}")), values, &function.types);
    }

    /// A call that is accepted or refused, by the C and by the plain translation alike.
    fn accept(
        &self,
        text: &mut String,
        (name, plain): (&str, &str),
        values: &[Value],
        types: &[CType],
    ) {
        let given = self.given(text, name, values, types);
        let accepted = self.names.call(name, given.clone());
        let given = given.join(", ");
        _ = writeln!(text, "        bool accepted = {accepted};");
        _ = writeln!(text, "        bool expected = {plain}({given});");
        _ = writeln!(
            text,
            "        plain_assert(accepted == expected, \"another result of {name}\");"
        );
        text.push_str("        plain_compare();\n    }\n");
    }

    fn set(&self, text: &mut String, belief: &str, values: &[Value]) {
        let mut beliefs = self.program.beliefs.iter();
        let Some(declared) = beliefs.find(|declared| declared.name == belief) else { return };
        let name = format!("set_{belief}");
        let given = self.given(text, &name, values, &declared.types);
        let set = self.names.call(&name, given.clone());
        let given = given.join(", ");
        _ = writeln!(text, "        {set};\n        plain_set_{belief}({given});");
        text.push_str("        plain_compare();\n    }\n");
    }

    /// Opens a block and declares the arguments of a call in it. Returns their names.
    fn given(
        &self,
        text: &mut String,
        call: &str,
        values: &[Value],
        types: &[CType],
    ) -> Vec<String> {
        text.push_str("    {\n");
        let mut names = Vec::new();
        for (value, ctype) in values.iter().zip(types) {
            let name = format!("argument{}", names.len() + 1);
            let value = literal(self.program, Some(value), ctype);
            _ = writeln!(text, "        {} {name} = {value};", ctype.name);
            names.push(name);
        }
        let recorded = if names.is_empty() { "0U".to_owned() } else { names.join(", ") };
        _ = writeln!(text, "        __CPROVER_output(\"{CALLS} {call}\", {recorded});");
        names
    }
}
