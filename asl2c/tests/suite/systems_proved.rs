//! Proofs of random systems against runs: what `asl2c verify` proves for all channels and every order of steps must hold in
//! each run of the agents.
//!
//! The channels and monitors here follow the guide, and share nothing with those of the model and of `asl2c run`.
//! `ASL2C_SYSTEMS=500` checks more systems than usual, `ASL2C_SYSTEMS_SEED` other ones.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use asl2c::{NetworkConditions, SystemSession, Verdict, repeat};
use translator::interpreter::{Environment, Interpreter, Value};
use translator::syntax::ast::{Operator, Performative, TriggerKind};
use translator::system::{System, compose, parse_system};
use translator::types::{CType, TypeKind};
use translator::{Model, parse_configuration};

use crate::harness::{from_environment, skip};
use crate::proved::Random;

const PEERS: [&str; 3] = ["ann", "bob", "cid"];
/// Runs of each system, and the rounds of each.
const RUNS: usize = 60;
const ROUNDS: usize = 25;
/// Actions that properties name.
const ACTIONS: [&str; 7] = [
    "on",
    "off",
    "send_tell_seen",
    "send_untell_seen",
    "send_tell_at",
    "send_achieve_go",
    "send_achieve_come",
];

/// The bounds of the channels.
#[derive(Debug, Clone, Copy)]
struct Bounds {
    capacity: usize,
    losses: Option<usize>,
    delay: Option<usize>,
}

#[derive(Debug, Clone)]
enum Property {
    /// Agents and their actions.
    NeverTogether(Vec<(usize, &'static str)>),
    /// Rounds, the agent and its action or event, and the answers.
    Within(u32, usize, &'static str, Vec<(usize, &'static str)>),
}

impl Property {
    /// `sends` has the actions that occur in each agent's text.
    fn random(random: &mut Random, called: &[Vec<&'static str>]) -> Self {
        let agents = called.len();
        let deed = |random: &mut Random, agent: usize| (agent, random.of(&called[agent]));
        if random.chance(40) {
            let first = random.below(agents);
            let second = (first + 1 + random.below(agents - 1)) % agents;
            return Self::NeverTogether(vec![deed(random, first), deed(random, second)]);
        }
        let (agent, rounds) = (random.below(agents), 1 + u32::try_from(random.below(5)).unwrap());
        let cause = if random.chance(25) { "+!start" } else { random.of(&called[agent]) };
        let answers = 1 + random.below(3);
        let answers = (0..answers).map(|_| {
            let agent = random.below(agents);
            deed(random, agent)
        });
        Self::Within(rounds, agent, cause, answers.collect())
    }

    fn text(&self) -> String {
        let deeds = |deeds: &[(usize, &str)]| {
            let deeds = deeds.iter().map(|(agent, action)| format!("{}.{action}", PEERS[*agent]));
            deeds.collect::<Vec<_>>().join(", ")
        };
        match self {
            Self::NeverTogether(actions) => format!("never_together({})", deeds(actions)),
            Self::Within(rounds, agent, cause, answers) => {
                format!("within({rounds}, {}.{cause}, {})", PEERS[*agent], deeds(answers))
            }
        }
    }
}

/// State of a property in a run.
#[derive(Default, Clone)]
struct Monitor {
    /// For each of the actions that exclude each other, whether it was called in this round.
    together: Vec<(usize, &'static str)>,
    /// The round by whose end the answer must have come.
    until: Option<usize>,
    broken: bool,
}

impl Monitor {
    fn happens(&mut self, property: &Property, round: usize, agent: usize, what: &'static str) {
        match property {
            Property::NeverTogether(actions) => {
                let deed = (agent, what);
                if actions.contains(&deed) && !self.together.contains(&deed) {
                    self.together.push(deed);
                }
            }
            Property::Within(rounds, other, cause, answers) => {
                if answers.contains(&(agent, what)) {
                    self.until = None;
                }
                if (*other, *cause) == (agent, what) && self.until.is_none() {
                    self.until = Some(round + *rounds as usize);
                }
            }
        }
    }

    fn round_ends(&mut self, round: usize) {
        self.broken |= self.together.len() > 1 || self.until.is_some_and(|until| until <= round);
        self.together.clear();
        if self.until.is_some_and(|until| until <= round) {
            self.until = None;
        }
    }
}

/// A random agent. It never calls itself but by `!!`.
fn agent(random: &mut Random, peers: usize, kinds: &[&str]) -> String {
    let mut text = String::from("!live.\n");
    if random.chance(20) {
        text += "seen.\n";
    }
    for trigger in [
        "+!live",
        "+!live",
        "+!live",
        "+!start",
        "+!go",
        "+!go",
        "+!come(Y)",
        "+seen",
        "-seen",
        "+at(Y)",
        "-at(_)",
    ] {
        let is_optional = matches!(trigger, "+!live" | "+!go") || !trigger.starts_with("+!");
        let is_left_out = trigger.contains("at(") && !kinds.contains(&"at");
        if is_left_out || is_optional && random.chance(55) {
            continue;
        }
        plan(random, &mut text, trigger, (peers, kinds), true);
    }
    for trigger in ["+!live", "+!start", "+!go", "+!come(_)"] {
        plan(random, &mut text, trigger, (peers, kinds), false);
    }
    text
}

fn plan(
    random: &mut Random,
    text: &mut String,
    trigger: &str,
    (peers, kinds): (usize, &[&str]),
    has_context: bool,
) {
    let is_said = !matches!(trigger, "+!live" | "+!start");
    let (mut people, mut conditions) = (Vec::new(), Vec::new());
    text.push_str(trigger);
    if is_said && random.chance(70) {
        let peer = PEERS[random.below(peers)];
        let source = random.of(&["S", "S", peer, "self"]);
        if source == "S" {
            people.push("S");
        }
        // Nobody is asked for by oneself.
        let is_known = source != "self" || trigger.contains("seen");
        _ = write!(text, "[source({})]", if is_known { source } else { "_" });
    }
    if has_context {
        for _ in 0..=random.below(2) {
            let peer = PEERS[random.below(peers)];
            conditions.push(match random.below(12) {
                0 => "ready".to_owned(),
                1 => "not ready".to_owned(),
                2 => "mine".to_owned(),
                3 => "not mine".to_owned(),
                4 => format!("seen[source({})]", random.of(&["self", peer])),
                5 => format!("not seen[source({peer})]"),
                6 => format!(".my_name({peer})"),
                7 if !people.contains(&"P") => {
                    people.push("P");
                    format!(
                        "seen[source(P)]{}",
                        random.of(&["", " & P \\== self", " & not at(_)[source(P)]"])
                    )
                }
                8 if !people.contains(&"Q") => {
                    people.push("Q");
                    format!(
                        "at(Z)[source(Q)]{}",
                        random.of(&[" & Z < 2", "", " & Q \\== self & even(Z)"])
                    )
                }
                9 if people.contains(&"S") => format!("S \\== {}", random.of(&["self", peer])),
                10 => "level(L) & L < 3".to_owned(),
                _ => "not seen".to_owned(),
            });
            // A variable is bound once.
            if conditions.last().is_some_and(|last| last.starts_with("level")) {
                break;
            }
        }
        _ = write!(text, " : {}", conditions.join(" & "));
    }
    let mut body = Vec::new();
    for _ in 0..random.below(3) {
        // Whom a function names may be anybody: oneself, or no peer at all.
        let to = match (people.is_empty(), random.below(6)) {
            (false, 0..=3) => random.of(&people),
            (_, 5) => "other",
            _ => PEERS[random.below(peers)],
        };
        let verb = random.of(&["tell", "tell", "untell"]);
        let said = match random.of(kinds) {
            "seen" => format!("{verb}, seen"),
            "at" if verb == "untell" => "untell, at".to_owned(),
            "at" => format!("tell, at({})", random.below(4)),
            "come" => format!("achieve, come({})", random.below(4)),
            _ if random.chance(80) => "achieve, go".to_owned(),
            _ => "unachieve, go".to_owned(),
        };
        body.push(match random.below(9) {
            0 | 1 => "on".to_owned(),
            2 => "off".to_owned(),
            3 => random.of(&["+mine", "-mine", "+seen", "-seen"]).to_owned(),
            4..8 => format!(".send({to}, {said})"),
            _ => format!(".broadcast({said})"),
        });
    }
    if trigger == "+!live" {
        body.push("!!live".to_owned());
    }
    if body.is_empty() {
        body.push("on".to_owned());
    }
    _ = writeln!(text, " <- {}.", body.join("; "));
}

fn configuration(peers: usize, room: usize) -> String {
    format!(
        "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; }};\n\
         basics {{ void on(void); void off(void); bool ready(void); bool even(int); peer other(void); }};\n\
         peers {{ {} }};\nmessages {{ tell seen from any; tell at(int) from any; achieve go from any, {room}; \
         achieve come(int) from any; }};\n\
         types {{ live(void); start(void); mine(void); level(int); }}; settables {{ level; }};\n\
         triggerables {{ +!start; }};\n",
        PEERS[..peers].join(", ")
    )
}

struct World<'a> {
    random: &'a mut Random,
    calls: Vec<(String, Vec<Value>)>,
}

impl Environment for World<'_> {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        Vec::new()
    }

    fn call(&mut self, name: &str, arguments: &[Value], result: &CType) -> Option<Value> {
        self.calls.push((name.to_owned(), arguments.to_vec()));
        if result.is_peer() {
            return Some(Value::Integer(i128::try_from(self.random.below(PEERS.len())).unwrap()));
        }
        (result.kind == TypeKind::Bool).then(|| Value::Bool(self.random.chance(50)))
    }
}

/// A message that is under way.
struct Message {
    from: usize,
    to: usize,
    performative: Performative,
    about: &'static str,
    values: Vec<Value>,
    round: usize,
}

const SAID: [(Performative, &str); 8] = [
    (Performative::Tell, "seen"),
    (Performative::Untell, "seen"),
    (Performative::Tell, "at"),
    (Performative::Untell, "at"),
    (Performative::Achieve, "go"),
    (Performative::Unachieve, "go"),
    (Performative::Achieve, "come"),
    (Performative::Unachieve, "come"),
];

/// One run. Returns the violated properties, and whether a message was sent into a full channel.
fn run(
    random: &mut Random,
    agents: &[Interpreter],
    bounds: Bounds,
    properties: &[Property],
) -> (Vec<bool>, bool) {
    let mut agents = agents.to_vec();
    let mut monitors = vec![Monitor::default(); properties.len()];
    let mut under_way: Vec<Message> = Vec::new();
    let mut lost_in_a_row: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    let (mut moved, mut round, mut is_full) = (vec![false; agents.len()], 1, false);
    // Some runs are calm, others wild.
    let (losing, hurry) = (random.below(60), 20 + random.below(80));
    while round <= ROUNDS {
        let happens = |monitors: &mut Vec<Monitor>, agent: usize, what: &'static str| {
            for (monitor, property) in monitors.iter_mut().zip(properties) {
                monitor.happens(property, round, agent, what);
            }
        };
        let agent = random.below(agents.len());
        match random.below(6) {
            0 if moved.contains(&false) => {
                let (kind, none) = (TriggerKind::Achieve, Vec::new());
                let raised = agents[agent].raise(Operator::Add, kind, "start", none);
                if let Ok(()) = raised {
                    happens(&mut monitors, agent, "+!start");
                }
            }
            1 => {
                let level = Value::Integer(i128::try_from(random.below(5)).unwrap());
                agents[agent].set("level".to_owned(), vec![level]);
            }
            2 | 3 if !under_way.is_empty() && random.chance(hurry) => {
                let index = random.below(under_way.len());
                let pair = (under_way[index].from, under_way[index].to);
                let lost = lost_in_a_row.entry(pair).or_default();
                let may_be_lost = bounds.losses.is_none_or(|most| *lost < most);
                let message = under_way.remove(index);
                if may_be_lost && random.chance(losing) {
                    *lost += 1;
                } else {
                    *lost = 0;
                    let Message { from, to, performative, about, values, .. } = message;
                    let mut world = World { random, calls: Vec::new() };
                    agents[to].receive(from, performative, about, values, &mut world);
                }
            }
            _ if !moved[agent] => {
                let mut world = World { random, calls: Vec::new() };
                agents[agent].next_step(&mut world);
                moved[agent] = true;
                for (call, mut values) in world.calls {
                    let known = ACTIONS.iter().find(|action| **action == call);
                    if let Some(action) = known {
                        happens(&mut monitors, agent, action);
                    }
                    let said = SAID.iter().find(|(performative, about)| {
                        call == format!("send_{}_{about}", performative.name())
                    });
                    let Some((performative, about)) = said else { continue };
                    let Value::Integer(to) = values.remove(0) else { panic!("no receiver") };
                    let to = usize::try_from(to).unwrap();
                    if to == agent || to >= agents.len() {
                        continue;
                    }
                    let load =
                        under_way.iter().filter(|other| (other.from, other.to) == (agent, to));
                    if load.count() == bounds.capacity {
                        is_full = true;
                    } else {
                        let (from, performative) = (agent, *performative);
                        under_way.push(Message { from, to, performative, about, values, round });
                    }
                }
            }
            _ => {}
        }
        let is_late =
            |message: &Message| bounds.delay.is_some_and(|most| message.round + most <= round);
        if !moved.contains(&false) && !under_way.iter().any(is_late) && random.chance(70) {
            for monitor in &mut monitors {
                monitor.round_ends(round);
            }
            moved.fill(false);
            round += 1;
        }
    }
    (monitors.into_iter().map(|monitor| monitor.broken).collect(), is_full)
}

/// A random system with its properties and bounds, if its agents can be translated.
fn system(random: &mut Random) -> Option<(System, Vec<Property>, Bounds, String)> {
    let peers = 2 + random.below(6) / 5;
    let bounds = Bounds {
        capacity: 1 + random.below(3) / 2,
        losses: random.of(&[None, Some(0), Some(0), Some(1)]),
        delay: random.of(&[None, Some(0), Some(1), Some(1)]),
    };
    let room = 1 + random.below(2);
    let kinds: &[&str] =
        random.of(&[&["seen"], &["at"], &["go", "go", "seen"], &["come"], &["seen", "at"]]);
    let parsed = parse_configuration("a.conf", &configuration(peers, room)).unwrap();
    let texts: Vec<String> = (0..peers).map(|_| agent(random, peers, kinds)).collect();
    for text in &texts {
        translator::translate(&parsed, text).ok()?;
    }
    let called: Vec<Vec<&'static str>> = texts.iter().map(|text| calls(text)).collect();
    let properties: Vec<Property> = (0..4).map(|_| Property::random(random, &called)).collect();
    let or_any = |bound: Option<usize>| bound.map_or("any".to_owned(), |bound| bound.to_string());
    let (losses, delay) = (or_any(bounds.losses), or_any(bounds.delay));
    let mut text = String::from("agents { ");
    for peer in &PEERS[..peers] {
        _ = write!(text, "{peer}: {peer}.conf; ");
    }
    let capacity = bounds.capacity;
    _ = writeln!(
        text,
        "}};\nchannels {{ capacity = {capacity}; losses = {losses}; delay = {delay}; }};\nproperties {{"
    );
    for (number, property) in properties.iter().enumerate() {
        _ = writeln!(text, "  p{number}: {};", property.text());
    }
    text += "};\n";
    let described = format!("{text}{}{}", configuration(peers, room), texts.join("--\n"));
    let agents = texts.into_iter().map(|text| (parsed.clone(), text)).collect();
    match compose(&parse_system("a.system", &text).unwrap(), agents) {
        Ok(system) => Some((system, properties, bounds, described)),
        // A plan that never applies is left out.
        Err(error) if error.to_string().contains("never calls") => None,
        Err(error) => panic!("{error}\n{described}"),
    }
}

/// The actions that an agent's text has.
fn calls(text: &str) -> Vec<&'static str> {
    let has = |performative: Performative, about: &str| {
        text.contains(&format!("{}, {about}", performative.name()))
    };
    let sent = SAID.iter().filter(|(performative, about)| has(*performative, about));
    let sent: Vec<String> =
        sent.map(|(performative, about)| format!("send_{}_{about}", performative.name())).collect();
    let is_called = |action: &&&str| match **action {
        "on" | "off" => [" ", ";"].iter().any(|end| {
            text.contains(&format!(" {action}{end}")) || text.contains(&format!(" {action}."))
        }),
        action => sent.iter().any(|other| other == action),
    };
    let called: Vec<&'static str> = ACTIONS.iter().filter(is_called).copied().collect();
    if called.is_empty() { vec!["on"] } else { called }
}

#[test]
fn nothing_that_a_run_of_a_system_breaks_is_proved() {
    if std::process::Command::new("spin").arg("-V").output().is_err() {
        skip("spin");
        return;
    }
    let systems = from_environment("ASL2C_SYSTEMS", 3);
    let seed = u64::from(from_environment("ASL2C_SYSTEMS_SEED", 1));
    let mut random = Random(0x9E37_79B9_7F4A_7C15 ^ seed);
    let (mut checked, mut proved, mut broken_in_runs, mut refuted, mut repeated, mut undecided) =
        (0, 0, 0, 0, 0, 0);
    while checked < systems {
        let Some((system, properties, bounds, text)) = system(&mut random) else { continue };
        checked += 1;
        let agents: Vec<Interpreter> = (system.members.iter())
            .map(|member| {
                let mut agent = Interpreter::new(&member.configuration, &member.text).unwrap();
                agent.be(member.peer);
                agent
            })
            .collect();
        let (mut broken, mut is_full) = (vec![false; properties.len()], false);
        for _ in 0..RUNS {
            let (now, full) = run(&mut random, &agents, bounds, &properties);
            broken.iter_mut().zip(now).for_each(|(broken, now)| *broken |= now);
            is_full |= full;
        }
        if bounds.losses.is_some() {
            broken.push(is_full);
        }
        let model = Model::of_system("a.system", system);
        for (result, broken) in asl2c::verify(&model, &[]).unwrap().iter().zip(broken) {
            let name = &result.property.name;
            broken_in_runs += u32::from(broken);
            match &result.verdict {
                Verdict::Holds => {
                    proved += 1;
                    assert!(!broken, "`{name}` is proved, and a run breaks it\n{text}");
                }
                Verdict::Fails(way) => {
                    refuted += 1;
                    let system = model.system().unwrap();
                    let mut session =
                        SystemSession::new(system, NetworkConditions::PERFECT).unwrap();
                    repeated += u32::from(repeat(&mut session, &way.moves, name).is_some());
                }
                Verdict::Undecided(_) => undecided += 1,
            }
        }
    }
    println!(
        "{checked} systems: {proved} properties proved, {refuted} refuted ({repeated} ways repeated with values), \
         {broken_in_runs} broken by runs, {undecided} not decided"
    );
    assert!(proved > 0 && broken_in_runs > 0 && repeated > 0);
}
