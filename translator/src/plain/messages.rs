//! Messages between agents in the plain translation: lists for goals that peers ask for, and a mark for each belief that
//! one of them has changed.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::plans::{believed, given, percept, same, values_of};
use crate::configuration::Message;
use crate::program::{Asked, HandlerId, Program, Told};
use crate::syntax::ast::Performative;
use crate::types::CType;

fn noticed(program: &Program) -> impl Iterator<Item = (usize, &Told)> {
    let told = program.told.iter().enumerate();
    told.filter(|(_, told)| told.added.is_some() || told.removed.is_some())
}

/// The arguments that a peer gives a goal.
fn types<'a>(program: &'a Program, asked: &Asked) -> &'a [CType] {
    let types = &program.handler(asked.handler).types;
    &types[..types.len() - 1]
}

/// Whose turn it is among those who ask, and among those who tell.
pub(crate) const TURNS: [&str; 2] = ["asked_turn", "told_turn"];

/// These, and whose turn it is for each goal that pre-empts.
fn turns(program: &Program) -> Vec<String> {
    let urgent: BTreeSet<&str> = (program.asked.iter())
        .filter(|asked| is_urgent(program, asked))
        .map(|asked| asked.name.as_str())
        .collect();
    TURNS.into_iter().map(str::to_owned).chain(urgent.into_iter().map(urgent_turn)).collect()
}

pub(super) fn state(program: &Program) -> String {
    let mut text = String::new();
    if !program.has_peers() {
        return text;
    }
    text.push_str("    int me;\n");
    for turn in turns(program) {
        _ = writeln!(text, "    int {turn};");
    }
    for (index, asked) in program.asked.iter().enumerate() {
        _ = writeln!(text, "    int asked_{index};");
        for (argument, ctype) in types(program, asked).iter().enumerate() {
            _ = writeln!(text, "    {} asked_{index}_{argument}[{}];", ctype.name, asked.room);
        }
    }
    for (index, _) in noticed(program) {
        _ = writeln!(text, "    bool told_{index};");
    }
    for told in program.told.iter().filter(|told| told.timed) {
        if let Some((_, time)) = &program.clock {
            _ = writeln!(text, "    {} told_at_{};", time.name, program.belief(told.belief).name);
        }
    }
    text
}

fn with_sender(values: &str, sender: usize) -> String {
    if values.is_empty() { sender.to_string() } else { format!("{values}, {sender}") }
}

/// Begins to ask each peer, in turn.
fn each(text: &mut String, program: &Program, turn: &str) {
    let peers = program.configuration.peers.len();
    _ = writeln!(
        text,
        "    for (int k = 0; k < {peers}; k++) {{\n        int sender = (plain.{turn} + k) % {peers};"
    );
}

fn is_urgent(program: &Program, asked: &Asked) -> bool {
    program.configuration.preemptive.iter().any(|trigger| trigger.name.text == asked.name)
}

fn urgent_turn(goal: &str) -> String {
    format!("urgent_turn_{goal}")
}

/// Serves this goal, which pre-empts, if a peer asks for it.
pub(super) fn preempt(program: &Program, goal: &str, abort: &str) -> String {
    ask(program, &urgent_turn(goal), abort, |asked| asked.name == goal)
}

/// Serves what peers ask for, if it is such a goal.
fn ask(program: &Program, turn: &str, first: &str, is_such: impl Fn(&Asked) -> bool) -> String {
    let mut text = String::new();
    let peers = program.configuration.peers.len();
    for (index, asked) in program.asked.iter().enumerate().filter(|(_, asked)| is_such(asked)) {
        if text.is_empty() {
            each(&mut text, program, turn);
        }
        let types = types(program, asked);
        _ = writeln!(
            text,
            "        if (sender == {} && plain.asked_{index} > 0) {{\n            {first}\n            \
             plain.{turn} = (sender + 1) % {peers};\n            plain.asked_{index}--;",
            asked.sender
        );
        for (argument, ctype) in types.iter().enumerate() {
            _ = writeln!(
                text,
                "            {} e{argument} = plain.asked_{index}_{argument}[0];\n            \
                 for (int i = 0; i < plain.asked_{index}; i++) plain.asked_{index}_{argument}[i] = plain.asked_{index}_{argument}[i + 1];",
                ctype.name
            );
        }
        let values = (0..types.len()).map(|argument| format!("e{argument}"));
        let values = with_sender(&values.collect::<Vec<_>>().join(", "), asked.sender);
        _ = writeln!(
            text,
            "            plain_end(plain_run_{}({values}));\n            return true;\n        }}",
            asked.handler.0
        );
    }
    if !text.is_empty() {
        text.push_str("    }\n");
    }
    text
}

/// Serves what peers ask for without pre-empting, then what they told.
pub(super) fn serve(program: &Program) -> String {
    let mut text = ask(program, TURNS[0], "", |asked| !is_urgent(program, asked));
    let peers = program.configuration.peers.len();
    if noticed(program).next().is_some() {
        each(&mut text, program, TURNS[1]);
    }
    for (index, told) in noticed(program) {
        let belief = program.belief(told.belief);
        let run = |handler: Option<HandlerId>| match handler {
            Some(handler) => {
                let values = with_sender(&values_of(belief), told.sender);
                format!("{{ {} return true; }}", percept(handler, &values))
            }
            None => "return false;".to_owned(),
        };
        _ = writeln!(
            text,
            "        if (sender == {} && plain.told_{index}) {{\n            plain.told_turn = (sender + 1) % {peers};\n            \
             plain.told_{index} = false;\n            if (plain.held_{}) {}\n            else {}\n        }}",
            told.sender,
            belief.name,
            run(told.added),
            run(told.removed)
        );
    }
    if noticed(program).next().is_some() {
        text.push_str("    }\n");
    }
    text
}

/// How many changes can be taken away without handling one.
pub(super) fn unnoticed(program: &Program) -> usize {
    noticed(program).count()
}

/// What peers may call: `plain_receive_tell_B(..)` and the like.
pub(super) fn receive(program: &Program) -> String {
    let mut text = String::new();
    for message in &program.configuration.messages {
        match message.performative.declared() {
            Performative::Achieve => achieve(&mut text, program, message),
            _ => tell(&mut text, program, message),
        }
    }
    text
}

fn head(text: &mut String, verb: &str, name: &str, types: &[CType]) {
    let parameters = given(types);
    let parameters = if types.is_empty() { String::new() } else { format!(", {parameters}") };
    _ = writeln!(
        text,
        "static bool plain_receive_{verb}_{name}(int from{parameters})\n{{\n    if (from == plain.me) return false;"
    );
}

fn tell(text: &mut String, program: &Program, message: &Message) {
    let name = &message.name.text;
    let own = |told: &Told| told.name == *name;
    head(text, "tell", name, &message.parameters);
    for (index, told) in program.told.iter().enumerate().filter(|(_, told)| own(told)) {
        let belief = program.belief(told.belief);
        let is_noticed = told.added.is_some() || told.removed.is_some();
        _ = writeln!(text, "    if (from == {}) {{", told.sender);
        if is_noticed {
            _ = writeln!(
                text,
                "        if (!plain.held_{}) plain.told_{index} = true;",
                belief.name
            );
        }
        for (argument, ctype) in belief.types.iter().enumerate() {
            let place = believed(&belief.name, argument);
            if is_noticed {
                let same = same(ctype, &place, &format!("a{argument}"));
                _ = writeln!(text, "        if (!{same}) plain.told_{index} = true;");
            }
            _ = writeln!(text, "        {place} = a{argument};");
        }
        if let Some((clock, _)) = program.clock.as_ref().filter(|_| told.timed) {
            let name = &belief.name;
            _ = writeln!(text, "        plain.told_at_{name} = plain_call_{}();", clock.0);
        }
        _ = writeln!(
            text,
            "        plain.held_{} = true;\n        return true;\n    }}",
            belief.name
        );
    }
    text.push_str("    return false;\n}\n\n");
    head(text, "untell", name, &[]);
    for (index, told) in program.told.iter().enumerate().filter(|(_, told)| own(told)) {
        let belief = &program.belief(told.belief).name;
        _ = writeln!(text, "    if (from == {}) {{", told.sender);
        if told.added.is_some() || told.removed.is_some() {
            _ = writeln!(text, "        if (plain.held_{belief}) plain.told_{index} = true;");
        }
        _ = writeln!(text, "        plain.held_{belief} = false;\n        return true;\n    }}");
    }
    text.push_str("    return false;\n}\n\n");
}

fn achieve(text: &mut String, program: &Program, message: &Message) {
    let name = &message.name.text;
    let own = |asked: &Asked| asked.name == *name;
    head(text, "achieve", name, &message.parameters);
    for (index, asked) in program.asked.iter().enumerate().filter(|(_, asked)| own(asked)) {
        _ = writeln!(
            text,
            "    if (from == {}) {{\n        if (plain.asked_{index} == {}) {{ if (plain.refused < UINT32_MAX) plain.refused++; return false; }}",
            asked.sender, asked.room
        );
        for argument in 0..message.parameters.len() {
            _ = writeln!(
                text,
                "        plain.asked_{index}_{argument}[plain.asked_{index}] = a{argument};"
            );
        }
        _ = writeln!(text, "        plain.asked_{index}++;\n        return true;\n    }}");
    }
    text.push_str("    return false;\n}\n\n");
    head(text, "unachieve", name, &[]);
    for (index, asked) in program.asked.iter().enumerate().filter(|(_, asked)| own(asked)) {
        _ = writeln!(
            text,
            "    if (from == {}) {{ plain.asked_{index} = 0; return true; }}",
            asked.sender
        );
    }
    text.push_str("    return false;\n}\n\n");
}

/// Forgets all that waits.
pub(super) fn clear(program: &Program) -> String {
    let mut text = String::new();
    if !program.has_peers() {
        return text;
    }
    for turn in turns(program) {
        _ = writeln!(text, "    plain.{turn} = 0;");
    }
    for index in 0..program.asked.len() {
        _ = writeln!(text, "    plain.asked_{index} = 0;");
    }
    for (index, _) in noticed(program) {
        _ = writeln!(text, "    plain.told_{index} = false;");
    }
    text
}
