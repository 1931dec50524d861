//! The comparison of an agent's C with its plain translation, for a model checker.
//!
//! A *relation* reads the C's state as that of the plain translation. The two start related, and each call of
//! the interface, from any two related states and with the same answers of the environment, makes the same
//! calls with the same values in the same order, returns the same, and ends in related states. Therefore they
//! can never differ, after any number of calls.

mod beginning;
mod cases;
mod environment;
mod relation;
mod well_formed;

use std::fmt::Write as _;

pub(crate) use self::environment::NO_OWN_STATE;
use super::events::{event_name, no_event};
use super::host::{ANSWERS, Host, STEPS};
use super::names::{Names, argument, listed, typed_arguments};
use crate::backend::writer::Writer;
use crate::configuration::Basic;
use crate::plain;
use crate::program::Program;
use crate::scripted::Act;
use crate::types::{CType, TypeKind};

/// Maximum number of calls of one action in a step that are answered, to be defined as a number.
pub const ROOM: &str = "PLAIN_ROOM";
/// Assertion at the end of each function but `plain_cover`: it must fail, because otherwise nothing was compared.
pub const END: &str = "the end is not reached";
/// Chooses which call is watched.
const WATCH: &str = "{ plain_count_t any; plain_watched = any; }";
/// Assertion that [`ROOM`] is sufficient.
pub const ENOUGH_ROOM: &str = "room for the answers";

/// The C file that compares the agent's C, which it includes, with the plain translation in it. Executions of its
/// `main` have this beginning, if there is one; its other functions are of no use then.
pub(crate) fn comparison(program: &Program, beginning: &[Act]) -> String {
    Comparison::new(program, beginning).text()
}

/// What the step does in each function `plain_case_N`, for people.
pub(crate) fn cases(program: &Program) -> Vec<String> {
    Comparison::new(program, &[]).cases().into_iter().map(|case| case.name).collect()
}

/// A bound for all loops of both.
pub(crate) fn unwinding(program: &Program) -> usize {
    let messages = program.told.len();
    let rounds = plain::length(program) + plain::perceived(program).count() + messages + 2;
    let waiting = program.asked.iter().map(|asked| asked.room).max().unwrap_or_default();
    let peers = program.configuration.peers.len();
    rounds.max(program.deferred.len()).max(waiting).max(peers) + 1
}

/// All types of values, each once.
fn types(program: &Program) -> Vec<CType> {
    let peer = program.has_peers().then(CType::peer);
    let basics = program.configuration.basics.iter();
    let basics = basics.flat_map(|basic| basic.parameters.iter().chain([&basic.result]));
    let handlers = program.handlers.iter().flat_map(|handler| &handler.types);
    let events = program.external.iter().flat_map(|external| &external.types);
    let beliefs = program.beliefs.iter().flat_map(|belief| &belief.types);
    let messages = program.configuration.messages.iter();
    let said = messages.flat_map(|message| &message.parameters).chain(&peer);
    let used = basics.chain(handlers).chain(events).chain(beliefs).chain(said);
    let structs = program.configuration.structs.iter();
    let fields = structs.flat_map(|declared| declared.fields.iter().map(|(_, ctype)| ctype));
    let mut types = vec![CType::named("bool"), CType::named("uint32_t")];
    for ctype in fields.chain(used) {
        if ctype.kind != TypeKind::Void && !types.contains(ctype) {
            types.push(ctype.clone());
        }
    }
    types
}

struct Comparison<'a> {
    program: &'a Program,
    names: Names,
    types: Vec<CType>,
    beginning: &'a [Act],
}

impl<'a> Comparison<'a> {
    fn new(program: &'a Program, beginning: &'a [Act]) -> Self {
        Self { program, names: Names::new(program), types: types(program), beginning }
    }
}

impl Host for Comparison<'_> {
    fn called(&self, writer: &mut Writer, number: usize, basic: &Basic) {
        if self.names.is_context() {
            writer.line(
                "plain_assert(environment == plain_environment, \"the environment's pointer\");",
            );
        }
        writer.line(format!("bool watched = plain_logged({});", number + 1));
        for (_, argument, slot) in self.slots(basic) {
            writer.line(format!("if (watched) {{ {slot} = {argument}; }}"));
        }
        if basic.result.kind != TypeKind::Void {
            writer.line(format!("plain_count_t place = plain_asked_{number};"));
            writer.line(format!("plain_assert(place < {ROOM}, \"{ENOUGH_ROOM}\");"));
            writer.line(format!("__CPROVER_assume(place < {ROOM});"));
            writer.line(format!("plain_asked_{number}++;"));
            let (answer, any) = (self.answer(number, basic), self.any(&basic.result));
            if self.beginning.is_empty() {
                writer.line(format!("{answer} = {any};"));
            } else {
                let given = format!("plain_given_{number}");
                let left = format!("plain_given_left_{number}");
                writer.line(format!("{answer} = {given} != 0 ? *{given} : {any};"));
                writer.line(format!("if ({given} != 0 && {left} > 1) {{ {given}++; {left}--; }}"));
            }
            let name = &basic.name.text;
            writer.line(format!("__CPROVER_output(\"{ANSWERS} {name}\", {answer});"));
        }
        writer.line("(void)watched;");
        if self.names.is_context() {
            writer.line("plain_controlled();");
        }
    }

    fn answer(&self, number: usize, _: &Basic) -> String {
        format!("plain_answer_{number}[place]")
    }
}

impl Comparison<'_> {
    fn text(&self) -> String {
        let mut text = String::from(
            "/* Generated by asl2c: compares an agent's C with a plain translation. */\n",
        );
        text += "#define plain_assert(condition, said) __CPROVER_assert(condition, said)\n";
        text += &plain::float_functions();
        let settings = &self.program.configuration.settings;
        _ = writeln!(text, "#include \"{}\"\n", settings.output);
        if self.names.is_context() {
            let state = self.names.state_type();
            _ = writeln!(text, "static {state} plain_subject;");
            _ = writeln!(text, "static {state} *const self = &plain_subject;");
        }
        text.push_str("static int plain_token;\nstatic bool plain_searching;\n\n");
        text.push_str(&plain::state(self.program));
        self.values(&mut text);
        self.control(&mut text);
        self.calls(&mut text);
        self.updates(&mut text);
        text.push_str(&plain::functions(self.program));
        text.push_str(&self.relation());
        self.entries(&mut text);
        text
    }

    /// A field of the C's state. Without a pointer, whose validity would be proved at each use.
    fn field(&self, name: &str) -> String {
        if self.names.is_context() {
            format!("plain_subject.{name}")
        } else {
            self.names.field(name)
        }
    }

    fn index(&self, ctype: &CType) -> usize {
        self.types.iter().position(|other| other == ctype).unwrap_or_default()
    }

    /// An arbitrary value of a type, as an expression.
    fn any(&self, ctype: &CType) -> String {
        format!("plain_any_{}()", self.index(ctype))
    }

    /// Whether two values are the same, as an expression: bit for bit, also for a NaN, which the environment can see to be
    /// another one. CBMC gives the same NaN to the same operation on the same values.
    fn same(&self, ctype: &CType, left: &str, right: &str) -> String {
        format!("plain_same_{}({left}, {right})", self.index(ctype))
    }

    fn values(&self, text: &mut String) {
        let fields = |name: &str| self.program.configuration.fields(name).iter();
        text.push_str("static const char plain_texts[256];\n");
        for ctype in &self.types {
            let (name, index) = (&ctype.name, self.index(ctype));
            let any = match ctype.kind {
                TypeKind::Bool => "__CPROVER_assume(value == 0 || value == 1); ".to_owned(),
                TypeKind::Text => "unsigned char which; value = &plain_texts[which]; ".to_owned(),
                TypeKind::Struct => fields(name).fold(String::new(), |text, (field, ctype)| {
                    format!("{text}value.{} = {}; ", field.text, self.any(ctype))
                }),
                _ => String::new(),
            };
            _ = writeln!(
                text,
                "static {name} plain_any_{index}(void) {{ {name} value; {any}return value; }}"
            );
            let same = match ctype.kind {
                TypeKind::Float32 | TypeKind::Float64 => {
                    let bits =
                        if ctype.kind == TypeKind::Float32 { "uint32_t" } else { "uint64_t" };
                    format!(
                        "union {{ {name} value; {bits} bits; }} x, y; x.value = a; y.value = b; \
                         return x.bits == y.bits;"
                    )
                }
                TypeKind::Struct => {
                    let same = fields(name).map(|(field, ctype)| {
                        self.same(ctype, &format!("a.{}", field.text), &format!("b.{}", field.text))
                    });
                    format!("return {};", same.collect::<Vec<_>>().join(" && "))
                }
                // It may be a number, of which a NaN is not equal to itself. The C cannot tell one from another.
                TypeKind::Opaque => "return a == b || (a != a && b != b);".to_owned(),
                _ => "return a == b;".to_owned(),
            };
            _ = writeln!(text, "static bool plain_same_{index}({name} a, {name} b) {{ {same} }}");
        }
        text.push('\n');
    }

    /// The calls of both. One call of the step is watched, which may be any: what the C calls there, and with which
    /// values, is kept, and the plain translation must do the same. Where the two first call something else, they do
    /// so in the execution in which that call is watched, and before it they were given the same answers: the
    /// environment gives both the same answer to their n-th call of an action. Formulas are much smaller than with
    /// all calls in one list.
    fn calls(&self, text: &mut String) {
        _ = writeln!(
            text,
            "/* Numbers of calls. With few bits, formulas are smaller; that they suffice is asserted. */\n#if {ROOM} > 16\n\
             typedef uint32_t plain_count_t;\n#else\ntypedef uint8_t plain_count_t;\n#endif\n\
             #define PLAIN_NEVER ((plain_count_t)UINT32_MAX)"
        );
        text.push_str(
            "static plain_count_t plain_made;\nstatic plain_count_t plain_repeated;\nstatic plain_count_t plain_watched;\n\
             static int plain_seen;\n",
        );
        for ctype in &self.types {
            let (name, index) = (&ctype.name, self.index(ctype));
            let basics = self.program.configuration.basics.iter();
            let slots = basics.map(|basic| {
                basic.parameters.iter().filter(|parameter| *parameter == ctype).count()
            });
            for slot in 0..slots.max().unwrap_or_default() {
                _ = writeln!(text, "static {name} plain_log_{index}_{slot};");
            }
        }
        let mut restart = String::new();
        for (number, basic) in self.program.configuration.basics.iter().enumerate() {
            if basic.result.kind == TypeKind::Void {
                continue;
            }
            let result = &basic.result.name;
            _ = writeln!(text, "static {result} plain_answer_{number}[{ROOM}];");
            if !self.beginning.is_empty() {
                _ = writeln!(text, "static const {result} *plain_given_{number};");
                _ = writeln!(text, "static uint32_t plain_given_left_{number};");
            }
            for counted in ["asked", "answered"] {
                _ = writeln!(text, "static plain_count_t plain_{counted}_{number};");
                _ = writeln!(restart, "    plain_{counted}_{number} = 0;");
            }
        }
        _ = writeln!(
            text,
            "\n/* No call has been made yet. */\nstatic void plain_restart(void)\n{{\n    \
             plain_made = 0;\n    plain_repeated = 0;\n{restart}}}\n"
        );
        text.push_str(
            "static bool plain_logged(int call)\n{\n    bool watched = plain_made == plain_watched;\n    \
             if (watched) { plain_seen = call; }\n    \
             if (plain_made != PLAIN_NEVER) { plain_made++; }\n    return watched;\n}\n\n\
             static bool plain_expected(int call)\n{\n    bool watched = plain_repeated == plain_watched;\n    \
             bool made = !watched || (plain_repeated < plain_made && plain_seen == call);\n    \
             plain_assert(made, \"another call, or none\");\n    __CPROVER_assume(made);\n    \
             plain_repeated++;\n    return watched;\n}\n\n",
        );
        let mut writer = Writer::default();
        self.basics(&mut writer, self.program, &self.names);
        for (number, basic) in self.program.configuration.basics.iter().enumerate() {
            self.repeated(&mut writer, number, basic);
        }
        text.push_str(&writer.finish());
    }

    /// The arguments of an action, each with the place in which it is kept.
    fn slots<'b>(&self, basic: &'b Basic) -> Vec<(&'b CType, String, String)> {
        let slots = basic.parameters.iter().enumerate().map(|(index, ctype)| {
            let slot = basic.parameters[..index].iter().filter(|other| *other == ctype).count();
            (ctype, argument(index), format!("plain_log_{}_{slot}", self.index(ctype)))
        });
        slots.collect()
    }

    /// A call of an action by the plain translation.
    fn repeated(&self, writer: &mut Writer, number: usize, basic: &Basic) {
        let (name, result) = (&basic.name.text, &basic.result.name);
        let parameters = listed(typed_arguments(&basic.parameters));
        writer.open(format!("static {result} plain_call_{number}({parameters})"));
        writer.line(format!("bool watched = plain_expected({});", number + 1));
        for (ctype, argument, slot) in self.slots(basic) {
            let same = self.same(ctype, &argument, &slot);
            writer.line(format!("plain_assert(!watched || {same}, \"another value for {name}\");"));
        }
        writer.line("(void)watched;");
        if basic.result.kind != TypeKind::Void {
            writer.line(format!("plain_count_t place = plain_answered_{number};"));
            // No question is left out: the C has asked as often, or an earlier call differs.
            writer.line(format!("__CPROVER_assume(place < {ROOM});"));
            writer.line(format!("plain_answered_{number}++;"));
            writer.line(format!("return {};", self.answer(number, basic)));
        }
        writer.close("}");
        writer.line("");
    }

    fn entries(&self, text: &mut String) {
        self.havoc(text);
        self.base(text);
        _ = writeln!(
            text,
            "static void plain_both_step(void)\n{{\n    plain_restart();\n    {};\n    plain_step();",
            self.names.call("next_step", None)
        );
        text.push_str("    plain_compare();\n}\n\n");
        self.steps(text);
        self.calls_of_the_environment(text);
        _ = writeln!(
            text,
            "int plain_interface(void)\n{{\n    plain_start();\n    plain_call_by_environment();\n    plain_assert(false, \"{END}\");\n    return 0;\n}}\n"
        );
        let init = self.init(false);
        let mut begun = String::new();
        if !self.beginning.is_empty() {
            self.begin(text);
            begun.push_str("    plain_beginning();\n");
        }
        _ = writeln!(
            text,
            "int main(void)\n{{\n    plain_searching = true;\n{init}{begun}    {WATCH}\n    plain_compare();"
        );
        let choice = self.any(&CType::named("bool"));
        _ = writeln!(
            text,
            "    while ({choice}) {{\n        if ({choice}) {{\n            __CPROVER_output(\"{STEPS}\", 0U);\n            plain_both_step();\n        }} else {{\n            plain_call_by_environment();\n        }}\n    }}\n    return 0;\n}}"
        );
    }

    /// A step for each event that can be the next: with a known event, most of the code is known not to be
    /// executed. `plain_cover` asserts that no state is left out.
    fn steps(&self, text: &mut String) {
        let cases = self.cases();
        for (number, case) in cases.iter().enumerate() {
            _ = writeln!(text, "int plain_case_{number}(void)\n{{\n    plain_havoc();");
            for (place, value) in &case.fields {
                _ = writeln!(text, "    {place} = {value};");
            }
            text.push_str(
                "    __CPROVER_assume(plain_well_formed());\n    plain_relate(&plain);\n",
            );
            _ = writeln!(
                text,
                "    plain_both_step();\n    plain_assert(false, \"{END}\");\n    return 0;\n}}\n"
            );
        }
        text.push_str(
            "int plain_cover(void)\n{\n    plain_havoc();\n    __CPROVER_assume(plain_well_formed());\n",
        );
        let alternatives = cases.iter().map(|case| {
            let equal = case.fields.iter().map(|(place, value)| format!("({place} == {value})"));
            format!("({})", equal.collect::<Vec<_>>().join(" & "))
        });
        // Without `&&` and `||`, whose order would be executed.
        let alternatives = alternatives.collect::<Vec<_>>().join("\n        | ");
        _ = writeln!(text, "    plain_assert({alternatives}, \"some case\");\n    return 0;\n}}\n");
    }

    fn event(&self, slot: super::state::Slot, trigger: &str) -> String {
        event_name(&self.names, slot, trigger)
    }

    fn nothing(&self) -> String {
        no_event(&self.names)
    }
}
