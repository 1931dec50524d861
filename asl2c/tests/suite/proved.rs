//! Proofs against runs: what `asl2c verify` proves for every environment must hold in each run of the
//! reference interpreter, whatever its environment does.
//!
//! The monitors here follow the guide, and share nothing with those of the model and the harness.
//! `ASL2C_PROVED=2000` checks more agents than usual, `ASL2C_PROVED_SEED` other ones.

use std::collections::BTreeMap;
use std::process::Command;

use translator::interpreter::{Environment, Interpreter, Value};
use translator::parse_configuration;
use translator::syntax::ast::{Operator, Performative, TriggerKind};
use translator::types::{CType, TypeKind};

use crate::harness::{from_environment, skip};

/// Marsaglia's xorshift.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from((self.0 >> 11) % count as u64).unwrap()
    }

    pub(crate) fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    pub(crate) fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

const BASICS: &str = "void on(void); void off(void); void idle(void); bool flash(int); int read(void); bool dark(void); int64_t now(void);";
/// Calls that properties count.
const COUNTED: [&str; 8] = ["on", "off", "idle", "flash", "read", "dark", "now", "shows"];
/// Those of agents that talk, too.
const SENT: [&str; 3] = ["send_tell_seen", "send_tell_at", "send_achieve_dim"];

/// The basic actions of a name.
fn members(name: &str) -> &[&str] {
    match name {
        "on" => &["on"],
        "off" => &["off"],
        "idle" => &["idle"],
        "flash" => &["flash"],
        "read" => &["read"],
        "dark" => &["dark"],
        "now" => &["now"],
        "send_tell_seen" => &["send_tell_seen"],
        "send_tell_at" => &["send_tell_at"],
        "send_achieve_dim" => &["send_achieve_dim"],
        _ => &["on", "flash"],
    }
}

fn value(random: &mut Random) -> String {
    random.of(&["1", "3", "X", "read", "X + 1", "6 / X", "X + read"]).to_owned()
}

/// The peers of agents that talk, which begin as the first of them.
const PEERS: [&str; 2] = ["ann", "bob"];
const TALK: &str = "peers { ann, bob };\n\
    messages { tell seen from any; tell at(int) from bob; achieve dim(int) from bob, 2; };\n";

fn condition(random: &mut Random, talks: bool) -> String {
    let value = value(random);
    let peer = random.of(&PEERS);
    match random.below(if talks { 19 } else { 11 }) {
        11 => format!("seen[source({})]", random.of(&["self", peer, "_"])),
        12 => format!("not seen[source({})]", random.of(&["self", peer, "_"])),
        13 => format!(
            "seen[source(P{0})] & P{0} {1} self",
            random.below(1000),
            random.of(&["==", "\\=="])
        ),
        14 => format!("at(A{0})[source(Q{0})] & A{0} > {value}", random.below(1000)),
        15 => "not (at(_)[source(bob)] & dark)".to_owned(),
        16 => format!(".my_name({peer})"),
        17 => format!("at(_)[source(bob), age(T{0})] & T{0} < {value}", random.below(1000)),
        18 => format!("not (seen[source({peer}), age(T{0})] & T{0} > 2)", random.below(1000)),
        0 => "flag".to_owned(),
        1 => "not flag".to_owned(),
        2 => "dark".to_owned(),
        3 => format!("flash({value})"),
        4 => format!(
            "level(L) & L {} {}",
            random.of(&["<", "<=", ">", "=="]),
            random.of(&["2", "5", "X"])
        ),
        5 => format!("X > {value}"),
        6 => format!(
            "not ({} & {})",
            random.of(&["dark", "flag"]),
            random.of(&["flash(1)", "level(_)", "X > read"])
        ),
        7 => format!(
            "({} | {})",
            random.of(&["dark", "flag", "level(3)"]),
            random.of(&["flash(2)", "not flag", "read == 1"])
        ),
        8 => format!("store({})", random.of(&["_", "1", "read"])),
        9 => "not store(_)".to_owned(),
        _ => "level(_)".to_owned(),
    }
}

/// A formula; without goals to call it changes no belief either, so that there is no cycle.
fn formula(random: &mut Random, goals: &[&str], talks: bool) -> String {
    let value = value(random);
    if talks && random.chance(20) {
        let peer = random.of(&PEERS);
        return match random.below(if goals.is_empty() { 3 } else { 5 }) {
            0 => format!(".send({peer}, tell, at({value}))"),
            1 => ".broadcast(tell, seen)".to_owned(),
            2 => format!(".send({peer}, achieve, dim({value}))"),
            3 => "+seen".to_owned(),
            _ => "-seen".to_owned(),
        };
    }
    match random.below(if goals.is_empty() { 8 } else { 16 }) {
        0 | 1 => "on".to_owned(),
        2 => "off".to_owned(),
        3 => "idle".to_owned(),
        4 => format!("flash({value})"),
        5 => format!("F{} = flash({value})", random.below(1000)),
        6 => format!("?store({})", random.of(&["_", "1"])),
        7 => "?flag".to_owned(),
        8 => "+flag".to_owned(),
        9 => "-flag".to_owned(),
        10 => format!("+store({value})"),
        11 => format!("-store({})", random.of(&["_", "1", "read"])),
        12 => format!("?asked(A{})", random.below(1000)),
        13 => format!("!!{}", random.of(&["light", "dim(1)", "dim(X)", "wait"])),
        _ => format!("!{}", random.of(goals)),
    }
}

fn plan(
    random: &mut Random,
    (trigger, talks): (&str, bool),
    goals: &[&str],
    posts: &[&str],
) -> String {
    let conditions: Vec<String> = (0..random.below(3)).map(|_| condition(random, talks)).collect();
    let context = if conditions.is_empty() {
        String::new()
    } else {
        format!(" : {}", conditions.join(" & "))
    };
    let mut body: Vec<String> =
        (0..random.below(4)).map(|_| formula(random, goals, talks)).collect();
    if !posts.is_empty() && random.chance(40) {
        let deadline = if random.chance(20) { "[deadline(5)]" } else { "" };
        body.push(format!("!{}{deadline}", random.of(posts)));
    }
    if body.is_empty() {
        body.push("true".to_owned());
    }
    // A plan without an argument of its own gets another number.
    let text = format!("{trigger}{context} <- {}.\n", body.join("; "));
    if trigger.contains('X') { text } else { text.replace('X', "2") }
}

fn agent(random: &mut Random, talks: bool) -> String {
    let mut text = String::new();
    if random.chance(30) {
        text.push_str("flag.\n");
    }
    if random.chance(30) {
        text.push_str("store(1).\n");
    }
    text.push_str("!wait.\n");
    let inner = &["inner", "deep(1)", "deep(X)"];
    let deep = &["deep(2)"];
    for (trigger, goals, posts) in [
        ("+!wait", &inner[..], &["light", "wait"][..]),
        ("+!light", inner, &["light", "dim(3)"]),
        ("+!dim(X)", inner, &["dim(X)", "wait"]),
        ("+!inner", deep, &[]),
        ("+!deep(X)", &[], &[]),
        ("-!light", deep, &[]),
        ("-!dim(X)", inner, &[]),
        ("-!inner", &[], &[]),
        ("+store(X)", &[], &[]),
        ("-flag", &[], &[]),
        ("+seen", &[], &[]),
        ("-seen[source(_)]", &[], &["wait"]),
        ("+at(X)[source(bob)]", inner, &["dim(X)"]),
        ("-at(X)", &[], &[]),
    ] {
        let is_told = trigger.contains("seen") || trigger.contains("at(X)");
        if is_told && !talks {
            continue;
        }
        let optional = trigger.starts_with('-') || trigger == "+store(X)" || is_told;
        if optional && random.chance(60) {
            continue;
        }
        for _ in 0..=random.below(2) {
            let plan = plan(random, (trigger, talks), goals, posts);
            text.push_str(&plan);
        }
    }
    if random.chance(60) {
        text.push_str(random.of(&[
            "+?asked(X) <- X = read.\n",
            "+?asked(X) : level(X).\n",
            "+?asked(X) : dark <- X = 3; on.\n-?asked(X) : store(X).\n",
        ]));
    }
    text
}

/// A property, as written and as checked in runs.
enum DeclaredProperty {
    Count(&'static str, &'static str),
    Within(u32, Cause, &'static str),
    /// An action, and an event.
    OnlyAfter(&'static str, &'static str),
    AllHandled,
}

/// What peers say that is an event: its text, and the plans without which it is none.
const HEARD: [(&str, &str); 6] = [
    ("+!dim[source(bob)]", "\n+!dim"),
    ("+seen[source(ann)]", "\n+seen"),
    ("+seen[source(bob)]", "\n+seen"),
    ("-seen[source(bob)]", "\n-seen"),
    ("+at[source(bob)]", "\n+at"),
    ("-at[source(bob)]", "\n-at"),
];

#[derive(Clone, Copy)]
enum Cause {
    /// The text of an event.
    Event(&'static str),
    Called(&'static str),
    /// The level is at most this.
    Low(i128),
}

impl DeclaredProperty {
    fn random(random: &mut Random, agent: &str, talks: bool) -> Self {
        let action =
            if talks && random.chance(30) { random.of(&SENT) } else { random.of(&COUNTED) };
        let mut event = random.of(&["+!light", "+!dim"]);
        if talks && random.chance(60) {
            let heard = HEARD.iter().filter(|(_, plans)| agent.contains(plans));
            event = random.of(&heard.map(|(event, _)| *event).collect::<Vec<_>>());
        }
        match random.below(if talks { 12 } else { 10 }) {
            0..=3 => Self::Count(
                random.of(&["never", "at_most_one", "at_least_one", "exactly_one", "never"]),
                action,
            ),
            4 => Self::Within(
                1 + u32::try_from(random.below(3)).unwrap(),
                Cause::Called(random.of(&COUNTED)),
                action,
            ),
            5 => Self::Within(
                1 + u32::try_from(random.below(2)).unwrap(),
                Cause::Low(random.of(&[2, 5])),
                action,
            ),
            6 | 7 => Self::OnlyAfter(action, event),
            8 => Self::AllHandled,
            _ => Self::Within(
                1 + u32::try_from(random.below(4)).unwrap(),
                Cause::Event(event),
                action,
            ),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Count(bound, action) => format!("{bound}({action})"),
            Self::Within(steps, cause, action) => {
                let cause = match cause {
                    Cause::Event(text) | Cause::Called(text) => (*text).to_owned(),
                    Cause::Low(limit) => format!("level <= {limit}"),
                };
                format!("within({steps}, {cause}, {action})")
            }
            Self::OnlyAfter(action, event) => format!("only_after({action}, {event})"),
            Self::AllHandled => "all_handled".to_owned(),
        }
    }
}

/// State of a property in a run.
#[derive(Default, Clone)]
struct Monitor {
    due: u32,
    allowed: bool,
    broken: bool,
}

impl Monitor {
    fn happens(&mut self, property: &DeclaredProperty, event: &str) {
        match property {
            DeclaredProperty::Within(steps, Cause::Event(cause), _)
                if *cause == event && self.due == 0 =>
            {
                self.due = *steps;
            }
            DeclaredProperty::OnlyAfter(_, cause) if *cause == event => self.allowed = true,
            _ => {}
        }
    }

    /// A peer takes back what it said. If that was served before, the answer is due: not to know it breaks fewer properties.
    fn is_taken_back(&mut self, property: &DeclaredProperty, event: &str) {
        if let DeclaredProperty::Within(_, Cause::Event(cause), _) = property
            && *cause == event
        {
            self.due = 0;
        }
    }

    /// A step has ended; `level` is that of its beginning, `calls` are its calls.
    fn stepped(
        &mut self,
        property: &DeclaredProperty,
        level: Option<i128>,
        calls: &BTreeMap<String, u32>,
        lost: bool,
    ) {
        let count = |name: &str| -> u32 {
            members(name).iter().filter_map(|action| calls.get(*action)).sum()
        };
        match property {
            DeclaredProperty::Count(bound, action) => {
                let calls = count(action);
                self.broken |= match *bound {
                    "never" => calls > 0,
                    "at_most_one" => calls > 1,
                    "at_least_one" => calls < 1,
                    _ => calls != 1,
                };
            }
            DeclaredProperty::Within(steps, cause, action) => {
                if let Cause::Low(limit) = cause {
                    let low = level.is_some_and(|level| level <= *limit);
                    self.due = if !low {
                        0
                    } else if self.due == 0 {
                        *steps
                    } else {
                        self.due
                    };
                }
                if self.due > 0 {
                    let answered = count(action) > 0;
                    self.due = if answered { 0 } else { self.due - 1 };
                    self.broken |= !answered && self.due == 0;
                }
                if let Cause::Called(cause) = cause
                    && count(cause) > 0
                    && self.due == 0
                {
                    self.due = *steps;
                }
            }
            DeclaredProperty::OnlyAfter(action, _) => {
                self.broken |= count(action) > 0 && !self.allowed;
            }
            DeclaredProperty::AllHandled => self.broken |= lost,
        }
    }
}

struct World<'a> {
    random: &'a mut Random,
    level: Option<i128>,
    tells: bool,
    now: i128,
    calls: BTreeMap<String, u32>,
}

impl Environment for World<'_> {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        let level = self.level.filter(|_| std::mem::take(&mut self.tells));
        level.map(|level| ("level".to_owned(), vec![Value::Integer(level)])).into_iter().collect()
    }

    fn call(&mut self, name: &str, _: &[Value], result: &CType) -> Option<Value> {
        *self.calls.entry(name.to_owned()).or_default() += 1;
        match result.kind {
            TypeKind::Void => None,
            TypeKind::Bool => Some(Value::Bool(self.random.chance(50))),
            _ if name == "now" => {
                self.now += i128::try_from(self.random.below(4)).unwrap();
                Some(Value::Integer(self.now))
            }
            _ => Some(Value::Integer(i128::try_from(self.random.below(4)).unwrap())),
        }
    }
}

/// What each peer tells.
type Told = BTreeMap<(usize, &'static str), Vec<Value>>;

/// A peer says something. Returns the event that happens, and the one that is taken back.
fn hears(
    interpreter: &mut Interpreter,
    world: &mut World<'_>,
    told: &mut Told,
) -> (Option<String>, Option<String>) {
    let random = &mut *world.random;
    let (performative, about) = random.of(&[
        (Performative::Tell, "seen"),
        (Performative::Untell, "seen"),
        (Performative::Tell, "at"),
        (Performative::Untell, "at"),
        (Performative::Achieve, "dim"),
        (Performative::Unachieve, "dim"),
    ]);
    let value = Value::Integer(i128::try_from(random.below(4)).unwrap());
    let has_value = performative.has_arguments() && ["at", "dim"].contains(&about);
    let values = if has_value { vec![value] } else { Vec::new() };
    let from = random.below(PEERS.len());
    if !interpreter.receive(from, performative, about, values.clone(), world) {
        return (None, None);
    }
    let event = |trigger: &str| Some(format!("{trigger}{about}[source({})]", PEERS[from]));
    match performative {
        Performative::Tell => match told.insert((from, about), values.clone()) {
            Some(before) if before == values => (None, None),
            _ => (event("+"), event("-")),
        },
        Performative::Untell => match told.remove(&(from, about)) {
            Some(_) => (event("-"), event("+")),
            None => (None, None),
        },
        Performative::Achieve => (event("+!"), None),
        Performative::Unachieve => (None, event("+!")),
    }
}

/// Runs an agent. Returns the violated properties.
fn runs(
    random: &mut Random,
    configuration: &str,
    agent: &str,
    promises: &[DeclaredProperty],
) -> Option<Vec<bool>> {
    let parsed =
        parse_configuration("a.conf", configuration).unwrap_or_else(|error| panic!("{error}"));
    let mut interpreter = Interpreter::new(&parsed, agent).ok()?;
    let mut broken = vec![false; promises.len()];
    for _ in 0..120 {
        // The model knows no name of its own.
        interpreter.be(random.below(PEERS.len()));
        let talks = !parsed.declarations().peers.is_empty();
        let mut world = World { random, level: None, tells: false, now: 0, calls: BTreeMap::new() };
        let mut monitors = vec![Monitor::default(); promises.len()];
        let mut told = Told::new();
        for _ in 0..25 {
            match world.random.below(if talks { 9 } else { 6 }) {
                6.. => {
                    let (happens, taken_back) = hears(&mut interpreter, &mut world, &mut told);
                    for (monitor, property) in monitors.iter_mut().zip(promises) {
                        if let Some(event) = &taken_back {
                            monitor.is_taken_back(property, event);
                        }
                        if let Some(event) = &happens {
                            monitor.happens(property, event);
                        }
                    }
                }
                number @ (0 | 1) => {
                    let (goal, arguments) = if number == 0 {
                        ("light", Vec::new())
                    } else {
                        (
                            "dim",
                            vec![Value::Integer(i128::try_from(world.random.below(4)).unwrap())],
                        )
                    };
                    if interpreter
                        .raise(Operator::Add, TriggerKind::Achieve, goal, arguments)
                        .is_ok()
                    {
                        let pairs = monitors.iter_mut().zip(promises);
                        let event = format!("+!{goal}");
                        pairs.for_each(|(monitor, property)| monitor.happens(property, &event));
                    }
                }
                2 => {
                    world.level = Some(i128::try_from(world.random.below(8)).unwrap());
                    world.tells = true;
                }
                _ => {
                    world.calls.clear();
                    let before = interpreter.unhandled_events();
                    let level = world.level;
                    interpreter.next_step(&mut world);
                    let lost = interpreter.unhandled_events() != before;
                    for (monitor, property) in monitors.iter_mut().zip(promises) {
                        monitor.stepped(property, level, &world.calls, lost);
                    }
                }
            }
        }
        for (broken, monitor) in broken.iter_mut().zip(monitors) {
            *broken |= monitor.broken;
        }
        world.random.below(2);
    }
    Some(broken)
}

/// The verdict of `asl2c verify` on each property.
fn verdicts(configuration: &str, agent: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.conf"), configuration).unwrap();
    std::fs::write(folder.path().join("a.asl"), agent).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_asl2c"));
    let output =
        command.args(["verify", "--json", "a.conf"]).current_dir(folder.path()).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let json: serde_json::Value = serde_json::from_str(&text).unwrap_or_else(|_| {
        panic!("{configuration}\n{agent}\n{}", String::from_utf8_lossy(&output.stderr))
    });
    let properties = json["properties"].as_array().unwrap();
    properties.iter().map(|property| property["verdict"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn nothing_that_a_run_breaks_is_proved() {
    if Command::new("spin").arg("-V").output().is_err() {
        skip("spin");
        return;
    }
    let agents = from_environment("ASL2C_PROVED", 8);
    let mut random =
        Random(0x9E37_79B9_7F4A_7C15 ^ u64::from(from_environment("ASL2C_PROVED_SEED", 1)));
    let (mut checked, mut talking, mut proved, mut broken_in_runs, mut undecided) = (0, 0, 0, 0, 0);
    while checked < agents {
        let talks = random.chance(75);
        let text = agent(&mut random, talks);
        let promises: Vec<DeclaredProperty> =
            (0..5).map(|_| DeclaredProperty::random(&mut random, &text, talks)).collect();
        let properties: String = promises
            .iter()
            .enumerate()
            .map(|(n, property)| format!("p{n}: {}; ", property.text()))
            .collect();
        let events = random.of(&["inbox = 1;", "inbox = 2;", "max_events = 1;"]);
        let preemptive = random.of(&["", "+!light;", "+!dim;"]);
        let configuration = format!(
            "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; clock = now; {events} }};\n\
             basics {{ {BASICS} }};\nclasses {{ shows: on, flash; }};\n\
             types {{ wait(void); light(void); dim(int); inner(void); deep(int); flag(void); level(int); store(int); asked(int); }};\n\
             settables {{ level; }};\ntriggerables {{ +!light; +!dim; }};\npreemptive {{ {preemptive} }};\n\
             properties {{ {properties} }};\n{}",
            if talks { TALK } else { "" }
        );
        let Some(broken) = runs(&mut random, &configuration, &text, &promises) else { continue };
        checked += 1;
        talking += u32::from(talks);
        let verdicts = verdicts(&configuration, &text);
        assert_eq!(verdicts.len(), promises.len());
        for ((property, broken), verdict) in promises.iter().zip(broken).zip(verdicts) {
            assert!(
                !(broken && verdict == "holds"),
                "{} is proved, and a run breaks it\n{configuration}\n{text}",
                property.text()
            );
            proved += u32::from(verdict == "holds");
            undecided += u32::from(verdict == "undecided");
            broken_in_runs += u32::from(broken);
        }
    }
    println!(
        "{checked} agents, {talking} of them with peers, {} properties: {proved} proved, {broken_in_runs} broken by runs, {undecided} not decided",
        checked * 5
    );
    assert!(proved > 0 && broken_in_runs > 0);
}
