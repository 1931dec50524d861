//! Random agents and event sequences.

/// A list of choices; when it is exhausted, the simplest choice is taken.
pub(super) struct Choices<'a> {
    bytes: &'a [u8],
}

impl<'a> Choices<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// One of `count` alternatives.
    fn pick(&mut self, count: usize) -> usize {
        let Some((first, rest)) = self.bytes.split_first() else { return 0 };
        self.bytes = rest;
        usize::from(*first) % count
    }

    /// True in `percent` of all cases.
    fn chance(&mut self, percent: usize) -> bool {
        self.pick(100) >= 100 - percent
    }

    fn of<'b>(&mut self, alternatives: &[&'b str]) -> &'b str {
        alternatives[self.pick(alternatives.len())]
    }
}

/// A random agent with its configuration.
pub(super) struct RandomAgent {
    pub(super) text: String,
    pub(super) configuration: String,
    /// Number of predicates with a hostile name.
    pub(super) hostile: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    Int,
    Small,
    Unsigned,
    Double,
    Bool,
}

use Type::{Bool, Double, Int, Small, Unsigned};

impl Type {
    pub(super) fn c_name(self) -> &'static str {
        match self {
            Int => "int",
            Small => "int8_t",
            Unsigned => "uint16_t",
            Double => "double",
            Bool => "bool",
        }
    }
}

/// Beliefs, by name.
pub(super) const BELIEFS: [(&str, &[Type]); 7] = [
    ("b0", &[]),
    ("b1", &[Int]),
    ("b2", &[Int, Int]),
    ("bd", &[Double]),
    ("bb", &[Bool]),
    ("bs", &[Small]),
    ("bu", &[Unsigned, Int]),
];
/// Goals; a goal's plans call only later ones, except that the first may be recursive.
const RECURSIVE_GOALS: usize = 2;
pub(super) const GOALS: [(&str, &[Type]); 6] = [
    ("g0", &[]),
    ("g1", &[Int]),
    ("g2", &[Int, Int]),
    ("gd", &[Double]),
    ("gb", &[Bool]),
    ("g3", &[Small]),
];
pub(super) const ACTIONS: [(&str, &[Type]); 6] = [
    ("a0", &[]),
    ("a1", &[Int]),
    ("a2", &[Int, Int]),
    ("ad", &[Double]),
    ("ab", &[Bool]),
    ("as", &[Small, Unsigned]),
];
pub(super) const FUNCTIONS: [(&str, &[Type], Type); 8] = [
    ("f0", &[], Int),
    ("f1", &[Int], Int),
    ("f2", &[Int, Double], Double),
    ("fs", &[Small], Small),
    ("fu", &[], Unsigned),
    ("q0", &[], Bool),
    ("q1", &[Int], Bool),
    ("q2", &[Bool, Small], Bool),
];

/// An event of a sequence.
#[derive(Debug, Clone)]
pub(super) enum Command {
    Step,
    /// `achieve_`, `add_` or `del_` and the arguments.
    Raise(&'static str, &'static str, Vec<String>),
    /// Sets `b2` before the next step.
    Set(String, String),
    Init,
    Clear,
}

/// Events of the environment.
pub(super) const EXTERNAL: [(&str, &str, &[Type]); 8] = [
    ("achieve", "g0", &[]),
    ("achieve", "g1", &[Int]),
    ("achieve", "gb", &[Bool]),
    ("achieve", "gd", &[Double]),
    ("add", "b1", &[Int]),
    ("del", "b1", &[]),
    ("add", "bd", &[Double]),
    ("del", "b2", &[]),
];

pub(super) fn sequence(choices: &mut Choices<'_>) -> Vec<Command> {
    let length = 4 + choices.pick(12);
    (0..length)
        .map(|_| match choices.pick(10) {
            0..6 => Command::Step,
            6..8 => {
                let (verb, name, types) = EXTERNAL[choices.pick(EXTERNAL.len())];
                let arguments = types.iter().map(|ctype| constant(choices, *ctype)).collect();
                Command::Raise(verb, name, arguments)
            }
            8 => Command::Set(constant(choices, Int), constant(choices, Int)),
            _ if choices.chance(30) => Command::Init,
            _ if choices.chance(30) => Command::Clear,
            _ => Command::Step,
        })
        .collect()
}

fn constant(choices: &mut Choices<'_>, ctype: Type) -> String {
    let alternatives: &[&str] = match ctype {
        Int => &["0", "1", "2", "-1", "3", "7", "2147483647", "-2147483648"],
        Small => &["0", "1", "-1", "2", "127", "-128"],
        Unsigned => &["0", "1", "2", "3", "65535"],
        Double => &["0.0", "1.0", "-2", "1.5", "0.1", "1e300"],
        Bool => &["true", "false"],
    };
    choices.of(alternatives).to_owned()
}

pub(super) fn agent(choices: &mut Choices<'_>) -> RandomAgent {
    // Chosen first, because the choices may be exhausted later.
    let is_hostile = choices.chance(50);
    let names = PRIVATE.map(|name| (name, HOSTILE[choices.pick(HOSTILE.len())]));
    let mut text = String::new();
    for (name, types) in BELIEFS {
        if choices.chance(40) {
            let arguments: Vec<String> =
                types.iter().map(|ctype| constant(choices, *ctype)).collect();
            text.push_str(&format!("{}.\n", call(name, &arguments)));
        }
    }
    text.push_str("!g0.\n");
    for (level, (name, types)) in GOALS.iter().enumerate() {
        for _ in 0..=choices.pick(2) {
            text.push_str(&plan(choices, &format!("+!{name}"), types, Place::Goal(level)));
        }
        if choices.chance(30) {
            text.push_str(&plan(choices, &format!("-!{name}"), types, Place::Goal(level)));
        }
    }
    for (level, (name, types)) in BELIEFS.iter().enumerate() {
        for operator in ["+", "-"] {
            if choices.chance(20) {
                let trigger = format!("{operator}{name}");
                text.push_str(&plan(choices, &trigger, types, Place::Percept(level)));
            }
        }
        if !types.is_empty() && choices.chance(25) {
            text.push_str(&test_plan(choices, "+", level));
            if choices.chance(40) {
                text.push_str(&test_plan(choices, "-", level));
            }
        }
    }
    if text.contains("[deadline(") {
        // Only goals that can take several steps may have a deadline.
        text.push_str("+!g0 <- .wait(1); a0.\n+!g1(N) <- .wait(N); a1(N).\n");
    }
    let configuration = configuration(choices, &text);
    let mut agent = RandomAgent { text, configuration, hostile: 0 };
    for (from, to) in names.into_iter().filter(|_| is_hostile) {
        agent.rename(from, to);
    }
    agent
}

/// Beliefs and goals that the environment does not name.
const PRIVATE: [&str; 6] = ["b0", "bb", "bs", "bu", "g2", "g3"];
/// Names that look like generated ones, or that generated code needs.
const HOSTILE: [&str; 28] = [
    "b_o",
    "b1_o",
    "b1_io",
    "b2_oi",
    "bd_o",
    "bu_oo",
    "g1_2",
    "g0_2",
    "failed_g1",
    "failed_b1",
    "untest",
    "test_b1",
    "tested_b2",
    "del_b",
    "add_b",
    "achieve_g",
    "set_b",
    "queue",
    "event",
    "args",
    "b1_t",
    "believes",
    "x",
    "v1",
    "var_v1",
    "arg0",
    "out",
    "in",
];

impl RandomAgent {
    /// Renames a predicate, unless the name is taken.
    fn rename(&mut self, from: &str, to: &str) {
        if words(&self.configuration).any(|word| word == to) {
            return;
        }
        for text in [&mut self.text, &mut self.configuration] {
            let renamed = words(text).map(|word| if word == from { to } else { word }).collect();
            *text = renamed;
        }
        self.hostile += 1;
    }
}

/// Names, and the text between them.
fn words(text: &str) -> impl Iterator<Item = &str> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.split_inclusive(move |c| !is_name(c)).flat_map(move |part| {
        let end = part.trim_end_matches(|c| !is_name(c)).len();
        let (name, between) = part.split_at(end);
        [name, between]
    })
}

fn configuration(choices: &mut Choices<'_>, agent: &str) -> String {
    let signature = |name: &str, types: &[Type]| {
        let types: Vec<_> = types.iter().map(|ctype| ctype.c_name()).collect();
        format!("{name}({})", if types.is_empty() { "void".to_owned() } else { types.join(", ") })
    };
    let mut basics = String::new();
    for (name, types) in ACTIONS {
        basics.push_str(&format!("void {}; ", signature(name, types)));
    }
    for (name, types, result) in FUNCTIONS {
        basics.push_str(&format!("{} {}; ", result.c_name(), signature(name, types)));
    }
    let predicates: String = BELIEFS
        .iter()
        .chain(&GOALS)
        .map(|(name, types)| format!("{}; ", signature(name, types)))
        .collect();
    let external: String = EXTERNAL
        .iter()
        .map(|(verb, name, _)| match *verb {
            "achieve" => format!("+!{name}; "),
            "add" => format!("+{name}; "),
            _ => format!("-{name}; "),
        })
        .collect();
    let inbox = 1 + choices.pick(3);
    let queue = choices.of(&["inbox", "max_events"]);
    let perceived = if agent.contains("\n+b2") && choices.chance(70) { "b2;" } else { "" };
    let preemptive = if choices.chance(50) { "+!gb; +!g1;" } else { "" };
    format!(
        "settings {{ input = agent.asl; output = agent.c; header = agent.h; basics = actions.h; \
         clock = f0; {queue} = {inbox}; }};\nbasics {{ {basics} }};\ntypes {{ {predicates} }};\n\
         settables {{ b2; }};\nperceived {{ {perceived} }};\ntriggerables {{ {external} }};\npreemptive {{ {preemptive} }};\n"
    )
}

#[derive(Clone, Copy)]
enum Place {
    Goal(usize),
    Percept(usize),
    Test(usize),
}

/// Variables with a value.
#[derive(Clone, Default)]
struct Scope {
    variables: Vec<(String, Type)>,
    made: usize,
}

impl Scope {
    fn fresh(&mut self) -> String {
        self.made += 1;
        // Some look like another variable that is bound a second time.
        match self.made % 4 {
            0 => format!("V{}_2", self.made - 1),
            3 => format!("Var_V{}", self.made - 2),
            _ => format!("V{}", self.made),
        }
    }

    fn of_type(&self, ctype: Type) -> Vec<&str> {
        self.variables.iter().filter(|(_, t)| *t == ctype).map(|(name, _)| name.as_str()).collect()
    }
}

fn call(name: &str, arguments: &[String]) -> String {
    if arguments.is_empty() { name.to_owned() } else { format!("{name}({})", arguments.join(", ")) }
}

fn plan(choices: &mut Choices<'_>, trigger: &str, types: &[Type], place: Place) -> String {
    let mut scope = Scope::default();
    let arguments = patterns(choices, types, &mut scope);
    let mut text = call(trigger, &arguments);
    if choices.chance(60) {
        text.push_str(&format!(" : {}", context(choices, &mut scope, 2)));
    }
    text.push_str(&format!(" <- {}.\n", body(choices, &mut scope, place)));
    text
}

/// A plan that answers a query with another belief's values.
fn test_plan(choices: &mut Choices<'_>, operator: &str, level: usize) -> String {
    let (name, types) = BELIEFS[level];
    let mut scope = Scope::default();
    let mut arguments = Vec::new();
    let mut conditions = Vec::new();
    for ctype in types {
        let variable = scope.fresh();
        let source = match ctype {
            Int => ["b1(X)", "b2(X, _)", "b2(_, X)"][choices.pick(3)],
            Small => "bs(X)",
            Unsigned => "bu(X, _)",
            Double => "bd(X)",
            Bool => "bb(X)",
        };
        conditions.push(source.replace('X', &variable));
        scope.variables.push((variable.clone(), *ctype));
        arguments.push(variable);
    }
    if choices.chance(40) {
        conditions.push(context(choices, &mut scope, 1));
    }
    let body = body(choices, &mut scope, Place::Test(level));
    format!("{operator}?{} : {} <- {body}.\n", call(name, &arguments), conditions.join(" & "))
}

/// Patterns of a trigger, a belief in a context or a test goal.
fn patterns(choices: &mut Choices<'_>, types: &[Type], scope: &mut Scope) -> Vec<String> {
    types
        .iter()
        .map(|ctype| match choices.pick(8) {
            0..4 => {
                let variable = scope.fresh();
                scope.variables.push((variable.clone(), *ctype));
                variable
            }
            4 => "_".to_owned(),
            5 => constant(choices, *ctype),
            _ => value(choices, scope, *ctype, 1),
        })
        .collect()
}

fn value(choices: &mut Choices<'_>, scope: &Scope, ctype: Type, depth: usize) -> String {
    let variables = scope.of_type(ctype);
    match choices.pick(if depth == 0 { 5 } else { 8 }) {
        0..3 if !variables.is_empty() => variables[choices.pick(variables.len())].to_owned(),
        0..5 => constant(choices, ctype),
        5 | 6 if ctype != Bool => {
            let left = value(choices, scope, ctype, depth - 1);
            let right = value(choices, scope, ctype, depth - 1);
            let operators: &[&str] =
                if ctype == Double { &["+", "-", "*", "/"] } else { &["+", "-", "*", "/", "mod"] };
            match choices.pick(6) {
                0 => format!("(-{left})").replace("--", "- -"),
                _ => format!("({left} {} {right})", choices.of(operators)),
            }
        }
        _ => {
            let functions: Vec<_> =
                FUNCTIONS.iter().filter(|(_, _, result)| *result == ctype).collect();
            let Some((name, types, _)) = functions.get(choices.pick(functions.len().max(1))) else {
                return constant(choices, ctype);
            };
            let arguments: Vec<String> = types
                .iter()
                .map(|ctype| value(choices, scope, *ctype, depth.saturating_sub(1)))
                .collect();
            call(name, &arguments)
        }
    }
}

fn context(choices: &mut Choices<'_>, scope: &mut Scope, depth: usize) -> String {
    let parts = 1 + choices.pick(3);
    let parts: Vec<String> = (0..parts).map(|_| literal(choices, scope, depth)).collect();
    parts.join(" & ")
}

fn literal(choices: &mut Choices<'_>, scope: &mut Scope, depth: usize) -> String {
    match choices.pick(if depth == 0 { 6 } else { 9 }) {
        0..3 => {
            let (name, types) = BELIEFS[choices.pick(BELIEFS.len())];
            call(name, &patterns(choices, types, scope))
        }
        3 => value(choices, scope, Bool, 1),
        4 if !scope.variables.is_empty() => {
            let (variable, ctype) = scope.variables[choices.pick(scope.variables.len())].clone();
            let operators: &[&str] =
                if ctype == Bool { &["==", "\\=="] } else { &["<", "<=", ">", ">=", "==", "\\=="] };
            let mut right = value(choices, scope, ctype, 1);
            if right == variable {
                right = constant(choices, ctype);
            }
            format!("{variable} {} {right}", choices.of(operators))
        }
        5 if !scope.variables.is_empty() => {
            let (variable, ctype) = scope.variables[choices.pick(scope.variables.len())].clone();
            let fresh = scope.fresh();
            let right = if ctype == Bool {
                variable
            } else {
                format!("{variable} + {}", value(choices, scope, ctype, 0))
            };
            scope.variables.push((fresh.clone(), ctype));
            format!("{fresh} = {right}")
        }
        6 => {
            let mut inner = scope.clone();
            let text = context(choices, &mut inner, depth - 1);
            // Variables that are bound inside may be bound again.
            if choices.chance(50) {
                scope.made = inner.made;
            }
            format!("not ({text})")
        }
        7 => {
            // A variable that both branches bind.
            let variable = scope.fresh();
            let sources = ["b1(X)", "b2(X, _)", "b2(_, X)", "bu(_, X)"];
            let left = choices.of(&sources).replace('X', &variable);
            let right = choices.of(&sources).replace('X', &variable);
            scope.variables.push((variable, Int));
            format!("({left} | {right})")
        }
        8 => {
            let branches: Vec<String> = (0..2)
                .map(|_| {
                    let mut inner = scope.clone();
                    let text = context(choices, &mut inner, depth - 1);
                    scope.made = inner.made;
                    text
                })
                .collect();
            format!("({})", branches.join(" | "))
        }
        _ => choices.of(&["true", "q0", "not b0", "b0"]).to_owned(),
    }
}

fn body(choices: &mut Choices<'_>, scope: &mut Scope, place: Place) -> String {
    // Occasionally longer than the maximum nesting of blocks.
    let length = if choices.chance(4) { 20 + choices.pick(20) } else { choices.pick(5) };
    let mut formulae: Vec<String> = (0..length).map(|_| formula(choices, scope, place)).collect();
    // The first goals may wait, and post each other as the last formula.
    if let Place::Goal(level @ 0..RECURSIVE_GOALS) = place {
        if choices.chance(30) {
            formulae.push(format!(".wait({})", value(choices, scope, Int, 1)));
            formulae.extend((0..choices.pick(4)).map(|_| formula(choices, scope, place)));
        }
        if choices.chance(50 + level) {
            let (name, types) = GOALS[choices.pick(RECURSIVE_GOALS)];
            let arguments: Vec<String> =
                types.iter().map(|ctype| value(choices, scope, *ctype, 1)).collect();
            let deadline = if choices.chance(30) {
                format!("[deadline({})]", value(choices, scope, Int, 1))
            } else {
                String::new()
            };
            formulae.push(format!("!{}{deadline}", call(name, &arguments)));
        }
    }
    if formulae.is_empty() { "true".to_owned() } else { formulae.join("; ") }
}

fn formula(choices: &mut Choices<'_>, scope: &mut Scope, place: Place) -> String {
    let values = |choices: &mut Choices<'_>, scope: &Scope, types: &[Type]| -> Vec<String> {
        types.iter().map(|ctype| value(choices, scope, *ctype, 2)).collect()
    };
    match (choices.pick(10), place) {
        (0, _) if choices.chance(25) => {
            // The result is discarded.
            let (name, types, _) = FUNCTIONS[choices.pick(FUNCTIONS.len())];
            call(name, &values(choices, scope, types))
        }
        (0..3, _) => {
            let (name, types) = ACTIONS[choices.pick(ACTIONS.len())];
            call(name, &values(choices, scope, types))
        }
        (3, _) => {
            let (name, types, result) = FUNCTIONS[choices.pick(FUNCTIONS.len())];
            let right = call(name, &values(choices, scope, types));
            let variable = scope.fresh();
            scope.variables.push((variable.clone(), result));
            format!("{variable} = {right}")
        }
        (4 | 5, Place::Goal(_) | Place::Percept(_)) => {
            // Percepts change later beliefs only.
            let first = if let Place::Percept(level) = place { level + 1 } else { 0 };
            let Some((name, types)) =
                BELIEFS.get(first + choices.pick(BELIEFS.len() - first.min(6)))
            else {
                return "a0".to_owned();
            };
            if choices.chance(65) {
                format!("+{}", call(name, &values(choices, scope, types)))
            } else {
                let arguments: Vec<String> = types
                    .iter()
                    .map(|ctype| match choices.pick(2) {
                        0 => "_".to_owned(),
                        _ => value(choices, scope, *ctype, 1),
                    })
                    .collect();
                format!("-{}", call(name, &arguments))
            }
        }
        (6, _) => {
            // Test plans query later beliefs only.
            let first = if let Place::Test(level) = place { level + 1 } else { 0 };
            let Some((name, types)) =
                BELIEFS.get(first + choices.pick(BELIEFS.len() - first.min(6)))
            else {
                return "a0".to_owned();
            };
            format!("?{}", call(name, &patterns(choices, types, scope)))
        }
        (7 | 8, Place::Goal(level)) => {
            let first = (level + 1).max(RECURSIVE_GOALS);
            let Some((name, types)) = GOALS.get(first + choices.pick(3)) else {
                return "a0".to_owned();
            };
            format!("!{}", call(name, &values(choices, scope, types)))
        }
        (9, Place::Goal(_)) => {
            let (name, types) = GOALS[choices.pick(GOALS.len())];
            format!("!!{}", call(name, &values(choices, scope, types)))
        }
        _ => "a0".to_owned(),
    }
}
