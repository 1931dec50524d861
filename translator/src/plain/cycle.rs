//! The state of the plain translation, its deliberation cycle and its interface, as the guide describes them.

use std::fmt::Write as _;

use super::messages;
use super::plans::{believed, given, own, percept, same, values_of};
use crate::configuration::ExternalTrigger;
use crate::program::{Belief, External, HandlerId, Program, Value};
use crate::syntax::ast::{Operator, TriggerKind};

/// The declaration of the state `plain`. Lists begin at index 0.
pub(super) fn state(program: &Program) -> String {
    let mut text = String::from("struct plain_state {\n");
    for belief in &program.beliefs {
        _ = writeln!(text, "    bool held_{};", belief.name);
        for (index, ctype) in belief.types.iter().enumerate() {
            _ = writeln!(text, "    {} value_{}_{index};", ctype.name, belief.name);
        }
        if belief.perceived.is_some() {
            _ = writeln!(text, "    bool perceived_{};", belief.name);
        }
    }
    text.push_str("    int posted;\n    int limited;\n");
    for id in &program.posted {
        arguments(&mut text, program, *id, "posted", "");
    }
    if let Some((_, ctype)) = &program.clock {
        _ = writeln!(text, "    {} deadline;", ctype.name);
    }
    for id in &program.limited {
        arguments(&mut text, program, *id, "limited", "");
    }
    text.push_str("    int count;\n    int queue[PLAIN_LENGTH];\n");
    for (number, external) in program.external.iter().enumerate() {
        let length = if external.preemptive {
            _ = writeln!(text, "    bool pending_{number};");
            ""
        } else {
            "[PLAIN_LENGTH]"
        };
        for (index, ctype) in external.types.iter().enumerate() {
            _ = writeln!(text, "    {} event_{number}_{index}{length};", ctype.name);
        }
    }
    text.push_str("    int waiting;\n    int deferred[PLAIN_DEFERRED];\n");
    let length = if is_queue(program) { "[PLAIN_LENGTH]" } else { "" };
    for id in &program.deferred {
        arguments(&mut text, program, *id, "deferred", length);
    }
    text.push_str(&messages::state(program));
    text.push_str("    uint32_t unhandled;\n    uint32_t refused;\n    uint32_t aborted;\n");
    text.push_str("};\nstatic struct plain_state plain;\n\n");
    text
}

/// Declares the arguments of a goal.
fn arguments(text: &mut String, program: &Program, id: HandlerId, place: &str, length: &str) {
    for (index, ctype) in program.handler(id).types.iter().enumerate() {
        _ = writeln!(text, "    {} {place}_{}_{index}{length};", ctype.name, id.0);
    }
}

pub(crate) fn is_queue(program: &Program) -> bool {
    program.configuration.settings.queue
}

/// Capacity of the list of events, at least one.
pub(crate) fn length(program: &Program) -> usize {
    let inbox = program.configuration.settings.inbox as usize;
    inbox + if is_queue(program) { program.deferred_room } else { 0 }
}

/// The number of an event in the list.
pub(crate) fn event_number(external: usize) -> usize {
    external + 1
}

/// The number of a deferred goal in a list.
pub(crate) fn goal_number(program: &Program, id: HandlerId) -> usize {
    program.external.len() + 1 + id.0
}

/// Beliefs whose change raises an event, in the order of service.
pub(crate) fn perceived(program: &Program) -> impl Iterator<Item = (&Belief, HandlerId)> {
    program.configuration.perceived.iter().filter_map(|name| {
        let belief = program.beliefs.iter().find(|belief| belief.name == name.text)?;
        Some((belief, belief.perceived?))
    })
}

/// The pre-empting event that the environment raises, and its number, if it raises this one.
pub(crate) fn preempting<'a>(
    program: &'a Program,
    trigger: &ExternalTrigger,
) -> Option<(usize, &'a External)> {
    program.external.iter().enumerate().find(|(_, external)| {
        (external.operator, external.kind, external.name.as_str())
            == (trigger.operator, trigger.kind, trigger.name.text.as_str())
    })
}

/// What a pre-empting event takes back.
const ABORT: &str = "if (plain.posted != 0 && plain.aborted < UINT32_MAX) plain.aborted++; \
    plain.posted = 0; plain.limited = 0;";

/// The functions that plans call to post goals.
pub(super) fn posting(program: &Program) -> String {
    let mut text = String::new();
    for id in &program.posted {
        let (parameters, values) = taken(program, *id, "posted", "");
        _ = writeln!(
            text,
            "static void plain_post_{0}({parameters})\n{{\n{values}    plain.posted = {1};\n}}\n",
            id.0,
            id.0 + 1
        );
    }
    for id in &program.limited {
        let Some((_, clock)) = &program.clock else { continue };
        let (parameters, values) = taken(program, *id, "limited", "");
        let parameters = if parameters == "void" { String::new() } else { parameters + ", " };
        _ = writeln!(
            text,
            "static void plain_limit_{0}({parameters}{clock} due)\n{{\n    if (plain.limited == {number}) return;\n\
             {values}    plain.deadline = due;\n    plain.limited = {number};\n}}\n",
            id.0,
            clock = clock.name,
            number = id.0 + 1
        );
    }
    for id in &program.deferred {
        defer(&mut text, program, *id);
    }
    text
}

fn defer(text: &mut String, program: &Program, id: HandlerId) {
    let number = goal_number(program, id);
    let queue = is_queue(program);
    let (parameters, values) =
        taken(program, id, "deferred", if queue { "[plain.count]" } else { "" });
    _ = writeln!(text, "static void plain_defer_{}({parameters})\n{{", id.0);
    if queue {
        let (first, room) = (goal_number(program, HandlerId(0)), program.deferred_room);
        _ = writeln!(
            text,
            "    int goals = 0;\n    for (int i = 0; i < plain.count; i++) if (plain.queue[i] >= {first}) goals++;\n    \
             if (goals >= {room}) {{ if (plain.unhandled < UINT32_MAX) plain.unhandled++; return; }}\n\
             {values}    plain.queue[plain.count] = {number};\n    plain.count++;\n}}\n"
        );
    } else {
        _ = writeln!(
            text,
            "{values}    for (int i = 0; i < plain.waiting; i++) if (plain.deferred[i] == {number}) return;\n    \
             plain.deferred[plain.waiting] = {number};\n    plain.waiting++;\n}}\n"
        );
    }
}

/// Parameters for the arguments of a goal, and their assignments to a place.
fn taken(program: &Program, id: HandlerId, place: &str, at: &str) -> (String, String) {
    let types = &program.handler(id).types;
    let values = (0..types.len()).map(|i| format!("    plain.{place}_{}_{i}{at} = a{i};\n", id.0));
    (given(types), values.collect())
}

/// The places of a goal's arguments.
fn places(program: &Program, id: HandlerId, place: &str, at: &str) -> String {
    let count = program.handler(id).types.len();
    let places = (0..count).map(|index| format!("plain.{place}_{}_{index}{at}", id.0));
    places.collect::<Vec<_>>().join(", ")
}

/// `step()`: one deliberation cycle.
pub(super) fn step(program: &Program) -> String {
    let mut text = String::from(
        "static void plain_end(int outcome)\n{\n    if (outcome != PLAIN_ACHIEVED && plain.unhandled < UINT32_MAX) plain.unhandled++;\n    \
         if (plain.posted == 0) plain.limited = 0;\n}\n\n",
    );
    text.push_str(
        "/* Serves the next event; false if that only changed a belief. */\nstatic bool plain_serve(void)\n{\n",
    );
    for trigger in &program.configuration.preemptive {
        if let Some((number, external)) = preempting(program, trigger) {
            let values = event(external, number, "");
            let run = external.handler.map(|handler| {
                let values = own(program, handler, values.clone());
                format!("plain_end(plain_run_{}({values}));", handler.0)
            });
            _ = writeln!(
                text,
                "    if (plain.pending_{number}) {{\n        plain.pending_{number} = false;\n        \
                 {ABORT}\n        {}\n        return true;\n    }}",
                run.unwrap_or_default()
            );
        }
        text.push_str(&messages::preempt(program, &trigger.name.text, ABORT));
    }
    posted(&mut text, program);
    for (belief, handler) in perceived(program) {
        let name = &belief.name;
        _ = writeln!(
            text,
            "    if (plain.perceived_{name}) {{\n        plain.perceived_{name} = false;\n        \
             if (!plain.held_{name}) return false;\n        {}\n        return true;\n    }}",
            percept(handler, &own(program, handler, values_of(belief)))
        );
    }
    text.push_str(&messages::serve(program));
    listed(&mut text, program);
    if !is_queue(program) {
        text.push_str("    if (plain.waiting > 0) {\n        int goal = plain.deferred[0];\n        plain.waiting--;\n");
        text.push_str(
            "        for (int i = 0; i < plain.waiting; i++) plain.deferred[i] = plain.deferred[i + 1];\n",
        );
        for id in &program.deferred {
            let (number, values) =
                (goal_number(program, *id), places(program, *id, "deferred", ""));
            _ = writeln!(
                text,
                "        if (goal == {number}) plain_end(plain_run_{}({values}));",
                id.0
            );
        }
        text.push_str("        return true;\n    }\n");
    }
    text.push_str("    return true;\n}\n\n");
    let again = text.contains("return false");
    // Each round without an event to handle takes one away.
    let rounds = if again {
        length(program) + perceived(program).count() + messages::unnoticed(program) + 1
    } else {
        1
    };
    _ = writeln!(
        text,
        "static void plain_step(void)\n{{\n    plain_update();\n    \
         for (int round = 0; round < {rounds}; round++) if (plain_serve()) return;\n}}\n"
    );
    text
}

fn posted(text: &mut String, program: &Program) {
    text.push_str("    if (plain.posted != 0) {\n        int goal = plain.posted;\n        plain.posted = 0;\n");
    if let Some(clock) = program.deadline_clock() {
        _ = writeln!(
            text,
            "        if (plain.limited != 0 && plain_call_{}() >= plain.deadline) {{",
            clock.0
        );
        text.push_str("            int overdue = plain.limited;\n            plain.limited = 0;\n");
        for id in &program.limited {
            let run = program.handler(*id).failure.map_or("PLAIN_FAILED".to_owned(), |failure| {
                format!("plain_run_{}({})", failure.0, places(program, *id, "limited", ""))
            });
            _ = writeln!(text, "            if (overdue == {}) plain_end({run});", id.0 + 1);
        }
        text.push_str("            return true;\n        }\n");
    }
    for id in &program.posted {
        let values = places(program, *id, "posted", "");
        let run = if program.handler(*id).kind == TriggerKind::Belief {
            percept(*id, &values)
        } else {
            format!("plain_end(plain_run_{}({values}));", id.0)
        };
        _ = writeln!(text, "        if (goal == {}) {{ {run} }}", id.0 + 1);
    }
    text.push_str("        return true;\n    }\n");
}

fn event(external: &External, number: usize, at: &str) -> String {
    let places = (0..external.types.len()).map(|index| format!("plain.event_{number}_{index}{at}"));
    places.collect::<Vec<_>>().join(", ")
}

/// The first event of the list.
fn listed(text: &mut String, program: &Program) {
    text.push_str(
        "    if (plain.count > 0) {\n        int first = plain.queue[0];\n        plain.count--;\n",
    );
    let queued = program.external.iter().enumerate().filter(|(_, external)| !external.preemptive);
    let queued: Vec<(usize, &External)> = queued.collect();
    let mut shifted = String::from("plain.queue[i] = plain.queue[i + 1];");
    let mut shift = |name: String, ctype: &str| {
        _ = writeln!(text, "        {ctype} {} = plain.{name}[0];", name.replace("event", "e"));
        _ = write!(shifted, " plain.{name}[i] = plain.{name}[i + 1];");
    };
    for (number, external) in &queued {
        for (index, ctype) in external.types.iter().enumerate() {
            shift(format!("event_{number}_{index}"), &ctype.name);
        }
    }
    if is_queue(program) {
        for id in &program.deferred {
            for (index, ctype) in program.handler(*id).types.iter().enumerate() {
                shift(format!("deferred_{}_{index}", id.0), &ctype.name);
            }
        }
    }
    _ = writeln!(text, "        for (int i = 0; i < plain.count; i++) {{ {shifted} }}");
    for (number, external) in queued {
        let values = event(external, number, "").replace("plain.event", "e");
        let run = external_run(program, external, number, &values);
        _ = writeln!(text, "        if (first == {}) {{ {run} }}", event_number(number));
    }
    if is_queue(program) {
        for id in &program.deferred {
            let values = places(program, *id, "deferred", "").replace("plain.", "");
            let number = goal_number(program, *id);
            _ = writeln!(
                text,
                "        if (first == {number}) {{ plain_end(plain_run_{}({values})); }}",
                id.0
            );
        }
    }
    text.push_str("        return true;\n    }\n");
}

fn external_run(program: &Program, external: &External, number: usize, values: &str) -> String {
    let Some(belief) = external.belief.map(|id| program.belief(id)) else {
        return external.handler.map_or(String::from("return false;"), |handler| {
            let values = own(program, handler, values.to_owned());
            format!("plain_end(plain_run_{}({values}));", handler.0)
        });
    };
    let run = match external.handler {
        Some(handler) => percept(handler, &own(program, handler, values_of(belief))),
        None => "return false;".to_owned(),
    };
    let name = &belief.name;
    if external.operator == Operator::Delete {
        return format!("if (!plain.held_{name}) return false; plain.held_{name} = false; {run}");
    }
    let mut text = String::new();
    for index in 0..belief.types.len() {
        _ = write!(text, "{} = e_{number}_{index}; ", believed(name, index));
    }
    format!("{text}plain.held_{name} = true; {run}")
}

/// What the environment calls.
pub(super) fn interface(program: &Program) -> String {
    let inbox = program.configuration.settings.inbox;
    let goals = goal_number(program, HandlerId(0));
    let mut text = format!(
        "static bool plain_has_room(void)\n{{\n    int events = 0;\n    \
         for (int i = 0; i < plain.count; i++) if (plain.queue[i] < {goals}) events++;\n    return events < {inbox};\n}}\n\n"
    );
    for (number, external) in program.external.iter().enumerate() {
        let parameters = given(&external.types);
        _ = writeln!(text, "static bool plain_raise_{number}({parameters})\n{{");
        let at = if external.preemptive { "" } else { "[plain.count]" };
        if !external.preemptive {
            text.push_str(
                "    if (!plain_has_room()) { if (plain.refused < UINT32_MAX) plain.refused++; return false; }\n",
            );
        }
        for index in 0..external.types.len() {
            _ = writeln!(text, "    plain.event_{number}_{index}{at} = a{index};");
        }
        if external.preemptive {
            _ = writeln!(text, "    plain.pending_{number} = true;");
        } else {
            _ = writeln!(
                text,
                "    plain.queue[plain.count] = {};\n    plain.count++;",
                event_number(number)
            );
        }
        text.push_str("    return true;\n}\n\n");
    }
    for belief in program.beliefs.iter().filter(|belief| belief.settable) {
        set(&mut text, belief);
    }
    text.push_str(&messages::receive(program));
    clear(&mut text, program);
    text
}

fn set(text: &mut String, belief: &Belief) {
    let name = &belief.name;
    let parameters = given(&belief.types);
    _ = writeln!(text, "static void plain_set_{name}({parameters})\n{{");
    if belief.perceived.is_some() {
        _ = writeln!(text, "    if (!plain.held_{name}) plain.perceived_{name} = true;");
        for (index, ctype) in belief.types.iter().enumerate() {
            let same = same(ctype, &believed(name, index), &format!("a{index}"));
            _ = writeln!(text, "    if (!{same}) plain.perceived_{name} = true;");
        }
    }
    for index in 0..belief.types.len() {
        _ = writeln!(text, "    {} = a{index};", believed(name, index));
    }
    _ = writeln!(text, "    plain.held_{name} = true;\n}}\n");
}

fn clear(text: &mut String, program: &Program) {
    text.push_str("static void plain_clear(void)\n{\n");
    text.push_str("    plain.posted = 0;\n    plain.limited = 0;\n    plain.count = 0;\n    plain.waiting = 0;\n");
    for (number, external) in program.external.iter().enumerate() {
        if external.preemptive {
            _ = writeln!(text, "    plain.pending_{number} = false;");
        }
    }
    for (belief, _) in perceived(program) {
        _ = writeln!(text, "    plain.perceived_{} = false;", belief.name);
    }
    text.push_str(&messages::clear(program));
    if let Some((id, values)) = &program.initial_goal {
        _ = writeln!(text, "    plain_post_{}({});", id.0, constants(values));
    }
    let me = if program.has_peers() { "int me" } else { "void" };
    _ = writeln!(text, "}}\n\nstatic void plain_init({me})\n{{");
    if program.has_peers() {
        text.push_str("    plain.me = me;\n");
    }
    for belief in &program.beliefs {
        _ = writeln!(text, "    plain.held_{} = {};", belief.name, belief.initial.is_some());
        for (index, value) in belief.initial.iter().flatten().enumerate() {
            let value = constants(std::slice::from_ref(value));
            _ = writeln!(text, "    {} = {value};", believed(&belief.name, index));
        }
    }
    text.push_str("    plain.unhandled = 0;\n    plain.refused = 0;\n    plain.aborted = 0;\n");
    text.push_str("    plain_clear();\n}\n\n");
}

/// Initial beliefs and goals have only constants.
fn constants(values: &[Value]) -> String {
    let texts = values.iter().map(|value| match value {
        Value::Constant(text, _) => text.as_str(),
        Value::Me => "plain.me",
        Value::Variable(_)
        | Value::ToldAt(_)
        | Value::Call(_)
        | Value::Negate(_)
        | Value::Arithmetic(_) => {
            unreachable!("analysis lets only constants into initial beliefs and goals")
        }
    });
    texts.collect::<Vec<_>>().join(", ")
}
