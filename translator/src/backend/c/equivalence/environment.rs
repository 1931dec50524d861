//! What the environment may do: before the first call, between calls, and while it has control in a step.
//!
//! In `updateBeliefs()` it may call the setters in any order and any number of times; with the state passed in, it may
//! also call anything for other instances whenever it has control. No such sequence is executed: each call of a setter
//! alone is a transition of its own, which changes nothing but its belief and from any related state does what the plain
//! one does. Hence setters of several beliefs commute, and what any number of calls leaves is what one call for each
//! belief leaves, or two for one whose changes are perceived: there and back again. Where they are not perceived, a value
//! is simply arbitrary afterwards. Objects which the relation does not know are arbitrary, too.

use std::fmt::Write as _;

use super::{Comparison, END, WATCH};
use crate::backend::c::host::{Call, changes, choose, counts, record};
use crate::backend::c::names::{listed, typed_arguments};
use crate::backend::c::said::{ring_field, ring_parts};
use crate::backend::c::state::{
    FieldType, Slot, belief_value, handler_name, held, layout, pending, rings,
};
use crate::backend::writer::Writer;
use crate::program::Belief;
use crate::types::CType;

/// State of C that is not translated, none here.
pub(crate) const NO_OWN_STATE: &str = "static void plain_own(void)\n{\n}\n";

impl Comparison<'_> {
    /// What is arbitrary whenever the environment has had control, and its pointer.
    pub(super) fn control(&self, text: &mut String) {
        text.push_str(NO_OWN_STATE);
        text.push_str(
            "static bool plain_related(void);\n\
             /* It has had control. A search only knows what a script can say. */\n\
             static void plain_controlled(void) { if (!plain_searching) { plain_own(); } }\n",
        );
        if self.names.is_context() {
            text.push_str("static void *plain_environment = &plain_token;\n");
        }
        text.push('\n');
    }

    /// Calls of setters at the start of a step, the same for both.
    pub(super) fn updates(&self, text: &mut String) {
        for belief in self.program.settable() {
            let name = &belief.name;
            for call in 0..calls(belief) {
                _ = writeln!(text, "static bool plain_updates_{name}_{call};");
                for (index, ctype) in belief.types.iter().enumerate() {
                    let ctype = &ctype.name;
                    _ = writeln!(text, "static {ctype} plain_update_{name}_{call}_{index};");
                }
            }
            let parameters = listed(typed_arguments(&belief.types));
            _ = writeln!(text, "static void plain_set_{name}({parameters});");
        }
        let update = self.names.update_head();
        _ = writeln!(text, "{update}\n{{\n    (void)plain_logged(0);");
        if self.names.is_context() {
            text.push_str("    plain_assert(agent == self && environment == plain_environment, \"the environment's pointer\");\n");
        }
        // The setters are only known to be right in such states.
        text.push_str(
            "    plain_assert(plain_searching || plain_related(), \"another state before updateBeliefs\");\n",
        );
        let mut plainly = String::new();
        let any_bool = self.any(&CType::named("bool"));
        for belief in self.program.settable() {
            let name = &belief.name;
            if belief.perceived.is_none() {
                self.update(text, &mut plainly, belief);
                continue;
            }
            for call in 0..calls(belief) {
                let chosen = format!("plain_updates_{name}_{call}");
                _ = writeln!(text, "    {chosen} = !plain_searching && {any_bool};");
                _ = writeln!(text, "    if ({chosen}) {{");
                let mut values = Vec::new();
                for (index, ctype) in belief.types.iter().enumerate() {
                    let value = format!("plain_update_{name}_{call}_{index}");
                    _ = writeln!(text, "        {value} = {};", self.any(ctype));
                    values.push(value);
                }
                _ = writeln!(plainly, "    if ({chosen}) plain_set_{name}({});", values.join(", "));
                let set = self.names.call(&format!("set_{name}"), values);
                _ = writeln!(text, "        {set};\n    }}");
            }
        }
        _ = writeln!(
            text,
            "    plain_controlled();\n}}\nstatic void plain_update(void)\n{{\n    (void)plain_expected(0);\n{plainly}}}\n"
        );
    }

    /// What calls of a setter may leave, and more: the belief may be held, and its value is arbitrary. With the same new
    /// values in both, instead of what two setters leave of their old ones, all that is computed from them begins the same.
    fn update(&self, text: &mut String, plainly: &mut String, belief: &Belief) {
        let name = &belief.name;
        let chosen = format!("plain_updates_{name}_0");
        let any_bool = self.any(&CType::named("bool"));
        _ = writeln!(text, "    if (!plain_searching) {{\n        {chosen} = {any_bool};");
        let field = self.field(&held(name));
        _ = writeln!(text, "        {field} = {field} || {chosen};");
        _ = writeln!(
            plainly,
            "    if (!plain_searching) {{\n        plain.held_{name} = plain.held_{name} || {chosen};"
        );
        for (index, ctype) in belief.types.iter().enumerate() {
            let value = format!("plain_update_{name}_0_{index}");
            _ = writeln!(text, "        {value} = {};", self.any(ctype));
            _ = writeln!(text, "        {} = {value};", self.field(&belief_value(name, index)));
            _ = writeln!(plainly, "        plain.value_{name}_{index} = {value};");
        }
        text.push_str("    }\n");
        plainly.push_str("    }\n");
    }

    /// One call outside of a step.
    pub(super) fn calls_of_the_environment(&self, text: &mut String) {
        let same_result = |left: &str, right: &str, name: &str| {
            format!("plain_assert({left} == {right}, \"another result of {name}\");")
        };
        let make = |writer: &mut Writer, call: &Call<'_>, arguments: Vec<String>| {
            let (name, values) = (call.name(), arguments.join(", "));
            if !matches!(call, Call::Room | Call::Count(_)) {
                record(writer, &name, &arguments);
            }
            let made = self.names.call(&name, arguments);
            match call {
                Call::Raise(number, _) => {
                    writer.line(format!("bool accepted = {made};"));
                    writer.line(format!("bool expected = plain_raise_{number}({values});"));
                    writer.line(same_result("accepted", "expected", &name));
                }
                Call::Set(belief) => self.set_alone(writer, belief, &made, &values),
                Call::Receive(function) => {
                    if function.asks_time {
                        writer.line("plain_restart();");
                    }
                    writer.line(format!("bool accepted = {made};"));
                    writer.line(format!("bool expected = plain_{name}({values});"));
                    writer.line(same_result("accepted", "expected", &name));
                }
                Call::Clear => {
                    writer.line(format!("{made};"));
                    writer.line("plain_clear();");
                }
                Call::Room => writer.line(same_result(&made, "plain_has_room()", &name)),
                Call::Count(counter) => {
                    writer.line(same_result(&made, &format!("plain.{counter}"), &name));
                }
            }
            // Before the ways meet, so that the state need not be chosen by the way.
            writer.line("plain_compare();");
        };
        let mut writer = Writer::default();
        let calls = changes(self.program).chain([Call::Clear, Call::Room]);
        let choice = self.any(&CType::named("uint32_t"));
        writer.open("static void plain_call_by_environment(void)");
        choose(
            &mut writer,
            &choice,
            calls.chain(counts(self.program)),
            |ctype| self.any(ctype),
            make,
            &[],
        );
        writer.close("}");
        writer.line("");
        text.push_str(&writer.finish());
    }

    /// A call of a setter: nothing but its belief changes.
    fn set_alone(&self, writer: &mut Writer, belief: &Belief, made: &str, values: &str) {
        let state = if self.names.is_context() { "*self" } else { "agent" };
        let (name, unchanged) = (&belief.name, self.unchanged(belief));
        writer.line(format!("{} before = {state};", self.names.state_type()));
        writer.line(format!("{made};"));
        writer.line(format!("plain_set_{name}({values});"));
        writer.line(format!(
            "plain_assert(plain_searching || ({unchanged}), \"set_{name} changes more than its belief\");"
        ));
    }

    /// Whether the state is as in `before` but for a belief, as an expression.
    fn unchanged(&self, belief: &Belief) -> String {
        let mut changed = vec![held(&belief.name)];
        changed.extend((0..belief.types.len()).map(|index| belief_value(&belief.name, index)));
        let flag = belief.perceived.map(|handler| handler_name(self.program, handler));
        changed.extend(flag.map(|handler| pending(Slot::Perceived, &handler)));
        let mut same = vec!["true".to_owned()];
        for field in layout(self.program).fields {
            if changed.contains(&field.name) {
                continue;
            }
            let (now, before) = (self.field(&field.name), format!("before.{}", field.name));
            let mut add = |now: String, before: String| {
                same.push(match &field.content {
                    FieldType::Value(ctype) => self.same(ctype, &now, &before),
                    _ => format!("({now} == {before})"),
                });
            };
            match field.length {
                Some(length) => (0..length)
                    .for_each(|slot| add(format!("{now}[{slot}]"), format!("{before}[{slot}]"))),
                None => add(now, before),
            }
        }
        // Without `&&`, whose order would be executed.
        same.join("\n            & ")
    }

    /// The start: `init()` of memory that holds anything.
    pub(super) fn base(&self, text: &mut String) {
        let (init, state) = (self.init(true), self.names.state_type());
        let place = if self.names.is_context() { "*self" } else { "agent" };
        _ = writeln!(
            text,
            "int plain_base(void)\n{{\n    plain_any_environment();\n    {{ {state} any; {place} = any; }}\n{init}    \
             plain_compare();\n    plain_assert(false, \"{END}\");\n    return 0;\n}}\n"
        );
    }

    /// Both start, as any peer or as the first.
    pub(super) fn init(&self, is_any: bool) -> String {
        let peers = self.program.configuration.peers.len();
        if peers == 0 {
            let call = self.names.init_call("plain_environment", "");
            return format!("    {call};\n    plain_init();\n");
        }
        let peer = CType::peer();
        // A search makes what a script can say.
        let me = if is_any { self.any(&peer) } else { "0U".to_owned() };
        let call = self.names.init_call("plain_environment", "plain_me");
        format!(
            "    {} plain_me = {me};\n    __CPROVER_assume(plain_me < {peers});\n    {call};\n    \
             plain_init(plain_me);\n",
            peer.name
        )
    }

    /// Any state of the C, and of all that it does not know.
    pub(super) fn havoc(&self, text: &mut String) {
        let number = self.any(&CType::named("uint32_t"));
        text.push_str("\nstatic void plain_any_environment(void)\n{\n    plain_own();\n");
        if self.names.is_context() {
            text.push_str("    { void *any; plain_environment = any; }\n");
        }
        _ = writeln!(text, "    plain_searching = false;\n    plain_restart();\n    {WATCH}\n}}\n");
        text.push_str("static void plain_havoc(void)\n{\n    plain_any_environment();\n");
        let event = self.names.interface("event_t");
        for field in layout(self.program).fields {
            let value = match &field.content {
                FieldType::Environment => "plain_environment".to_owned(),
                FieldType::Flag => self.any(&CType::named("bool")),
                FieldType::Count => number.clone(),
                FieldType::Event => format!("({event}){number}"),
                FieldType::Value(ctype) => self.any(ctype),
            };
            let place = self.field(&field.name);
            match field.length {
                Some(length) => {
                    for slot in 0..length {
                        _ = writeln!(text, "    {place}[{slot}] = {value};");
                    }
                }
                None => _ = writeln!(text, "    {place} = {value};"),
            }
        }
        // An index, even in states that are not well-formed.
        for asked in &self.program.asked {
            if ring_parts(self.program, asked).contains(&"first") {
                let first = self.field(&ring_field(self.program, asked, "first"));
                _ = writeln!(text, "    __CPROVER_assume({first} < {}U);", asked.room);
            }
        }
        for ring in rings(self.program) {
            let first = self.field(&ring.field("first"));
            _ = writeln!(text, "    __CPROVER_assume({first} < {}U);", ring.length);
        }
        text.push_str(
            "}\n\n/* Any two related states. */\nstatic void plain_start(void)\n{\n    plain_havoc();\n    \
             __CPROVER_assume(plain_well_formed());\n    plain_relate(&plain);\n}\n\n",
        );
    }
}

/// How often a setter is called in `updateBeliefs()`, which stands for any number of calls.
fn calls(belief: &Belief) -> usize {
    if belief.perceived.is_some() && !belief.types.is_empty() { 2 } else { 1 }
}
