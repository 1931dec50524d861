//! Random agents that talk, and what happens to them.

use std::fmt::Write as _;

use translator::syntax::ast::Performative;

/// Most commands of a sequence.
const COMMANDS: usize = 60;
/// Contexts are refused that have more ways to choose who told their beliefs.
const MOST_WAYS: usize = 64;
pub(super) const PEERS: [&str; 4] = ["ann", "bob", "cid", "dee"];
/// What the clock may show: the time between some of them is none.
const TIMES: [i32; 8] = [0, 1, 2, 3, 4, 5, i32::MAX, i32::MIN];
/// The number of nobody.
pub(super) const STRANGER: usize = 200;

/// What the environment offers; all functions print their call.
const BASICS: &str = "void act(int); void who(peer); void both(int, peer); bool even(int); bool odd(peer); \
    int next(int); peer other(peer); int now(void);";

/// A list of choices; when it is exhausted, the simplest choice is taken.
pub(super) struct Choices<'a>(pub(super) &'a [u8]);

impl Choices<'_> {
    /// One of `count` alternatives.
    pub(super) fn pick(&mut self, count: usize) -> usize {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        usize::from(*first) % count
    }

    /// True in `percent` of all cases.
    pub(super) fn chance(&mut self, percent: usize) -> bool {
        self.pick(100) >= 100 - percent
    }

    pub(super) fn of<T: Clone>(&mut self, alternatives: &[T]) -> T {
        alternatives[self.pick(alternatives.len())].clone()
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Type {
    Int,
    Peer,
}

impl Type {
    fn name(self) -> &'static str {
        match self {
            Self::Int => "int",
            Self::Peer => "peer",
        }
    }
}

/// A belief or a goal.
#[derive(Debug, Clone)]
pub(super) struct Predicate {
    pub(super) name: &'static str,
    pub(super) is_goal: bool,
    pub(super) types: Vec<Type>,
    /// The peers that tell it or ask for it; none if it is no message.
    senders: Vec<usize>,
    /// The environment sets the belief.
    is_settable: bool,
    /// The environment raises `+!goal`, or `+belief` and `-belief`.
    is_raised: bool,
}

impl Predicate {
    /// It may come from the agent itself or its environment.
    fn is_own(&self) -> bool {
        self.is_goal || self.is_settable || self.is_raised
    }
}

/// A random agent with its configuration. Plans achieve and change only what is behind their own predicate.
pub(super) struct Talker {
    pub(super) peers: usize,
    pub(super) predicates: Vec<Predicate>,
    pub(super) configuration: String,
    pub(super) text: String,
}

/// What happens to an agent.
#[derive(Debug, Clone)]
pub(super) enum Command {
    Step,
    /// The sender, what it does, the belief or goal, and arguments.
    Receive(usize, Performative, &'static str, Vec<i64>),
    /// `achieve`, `add` or `del`, the belief or goal, and arguments.
    Raise(&'static str, &'static str, Vec<i64>),
    Set(&'static str, Vec<i64>),
    /// The clock shows this from now on.
    Time(i32),
    /// Begins again as this peer.
    Init(usize),
    Clear,
}

impl Talker {
    pub(super) fn new(choices: &mut Choices<'_>) -> Self {
        let peers = 2 + choices.pick(3);
        let mut predicates = Vec::new();
        let (told, asked) = (1 + choices.pick(3), 1 + choices.pick(2));
        // A belief and a goal may have the same name.
        let goals = if choices.chance(20) { ["told1", "asked2"] } else { ["asked1", "asked2"] };
        let messages = ["told1", "told2", "told3"].into_iter().take(told).map(|name| (name, false));
        let messages = messages.chain(goals.into_iter().take(asked).map(|name| (name, true)));
        for (name, is_goal) in messages {
            let count = [0, 1, 1, 2, 2][choices.pick(5)];
            let mut types: Vec<Type> =
                (0..count).map(|_| choices.of(&[Type::Int, Type::Int, Type::Peer])).collect();
            if let Some(same) = predicates.iter().find(|other: &&Predicate| other.name == name) {
                types.clone_from(&same.types);
            }
            let mut senders: Vec<usize> = (0..peers).collect();
            if choices.chance(50) {
                senders.retain(|_| choices.chance(60));
            }
            if senders.is_empty() {
                senders.push(choices.pick(peers));
            }
            let is_settable = !is_goal && choices.chance(40);
            let is_raised = choices.chance(40);
            let further = Predicate { name, is_goal, types, senders, is_settable, is_raised };
            predicates.push(further);
        }
        let own = Predicate {
            name: "own",
            is_goal: false,
            types: vec![Type::Int],
            senders: Vec::new(),
            is_settable: true,
            is_raised: choices.chance(50),
        };
        let go = Predicate { name: "go", is_goal: true, types: Vec::new(), ..own.clone() };
        predicates.extend([own, Predicate { is_settable: false, is_raised: true, ..go }]);
        for index in (1..predicates.len()).rev() {
            predicates.swap(index, choices.pick(index + 1));
        }
        let mut talker =
            Self { peers, predicates, configuration: String::new(), text: String::new() };
        talker.text = talker.text(choices);
        talker.configuration = talker.configuration(choices);
        talker
    }

    fn configuration(&self, choices: &mut Choices<'_>) -> String {
        let [mut messages, mut settable, mut perceived, mut raised, mut preemptive] =
            [const { String::new() }; 5];
        for predicate in &self.predicates {
            let Predicate { name, is_goal, types, senders, .. } = predicate;
            if !senders.is_empty() {
                let types: Vec<_> = types.iter().map(|ctype| ctype.name()).collect();
                let mut from: Vec<&str> = senders.iter().map(|sender| PEERS[*sender]).collect();
                // The order in which senders are declared has no meaning.
                from.rotate_left(choices.pick(senders.len()));
                let from =
                    if from.len() == self.peers { "any".to_owned() } else { from.join(", ") };
                let (verb, room) = match is_goal {
                    true => ("achieve", choices.of(&["", ", 2", ", 3", ", 1"])),
                    false => ("tell", ""),
                };
                _ = write!(messages, "{verb} {name}({}) from {from}{room}; ", types.join(", "));
            }
            if predicate.is_settable {
                _ = write!(settable, "{name}; ");
                if self.text.contains(&format!("\n+{name}")) && choices.chance(70) {
                    _ = write!(perceived, "{name}; ");
                }
            }
            if *is_goal {
                if predicate.is_raised {
                    _ = write!(raised, "+!{name}; ");
                }
                if (predicate.is_raised || !senders.is_empty()) && choices.chance(25) {
                    _ = write!(preemptive, "+!{name}; ");
                }
            } else if predicate.is_raised {
                _ = write!(raised, "+{name}; -{name}; ");
            }
        }
        let queue = choices.of(&["inbox", "max_events"]);
        let inbox = 1 + choices.pick(3);
        format!(
            "settings {{ input = agent.asl; output = agent.c; header = agent.h; basics = actions.h; \
             {queue} = {inbox}; clock = now; }};\nbasics {{ {BASICS} }};\ntypes {{ own(int); go(void); }};\n\
             peers {{ {} }};\nmessages {{ {messages}}};\nsettables {{ {settable}}};\n\
             perceived {{ {perceived}}};\ntriggerables {{ {raised}}};\npreemptive {{ {preemptive}}};\n",
            PEERS[..self.peers].join(", ")
        )
    }

    /// An agent for these predicates.
    pub(super) fn text(&self, choices: &mut Choices<'_>) -> String {
        let mut text = String::from("// An agent that talks.\n");
        for Predicate { name, is_goal, types, .. } in &self.predicates {
            // Peers are no constants.
            if !is_goal && !types.contains(&Type::Peer) && choices.chance(25) {
                let values: Vec<String> =
                    types.iter().map(|_| choices.pick(4).to_string()).collect();
                _ = writeln!(text, "{}.", call(name, &values));
            }
        }
        text.push_str(choices.of(&["", "!go.\n"]));
        for (level, predicate) in self.predicates.iter().enumerate() {
            let [add, delete] = if predicate.is_goal { ["+!", "-!"] } else { ["+", "-"] };
            let some = usize::from(predicate.is_goal) + choices.pick(3);
            let others = choices.pick(5).saturating_sub(2);
            for (operator, count) in [(add, some), (delete, others)] {
                for _ in 0..count {
                    let mut plan = Plan { talker: self, scope: Scope::default(), choices };
                    text.push_str(&plan.text(operator, level));
                }
            }
        }
        text
    }

    pub(super) fn sequence(&self, choices: &mut Choices<'_>) -> Vec<Command> {
        let mut commands = vec![Command::Init(choices.pick(self.peers))];
        while !choices.0.is_empty() && commands.len() < COMMANDS {
            commands.push(match choices.pick(20) {
                6..15 => {
                    let from = if choices.chance(4) { STRANGER } else { choices.pick(self.peers) };
                    self.said(from, choices)
                }
                5 | 15..19 => self.surroundings(choices),
                19 if choices.chance(30) => Command::Init(choices.pick(self.peers)),
                19 if choices.chance(40) => Command::Clear,
                _ => Command::Step,
            });
        }
        commands
    }

    fn arguments(&self, types: &[Type], choices: &mut Choices<'_>) -> Vec<i64> {
        let argument = |ctype: &Type| match ctype {
            Type::Int => choices.pick(4),
            Type::Peer if choices.chance(5) => STRANGER,
            Type::Peer => choices.pick(self.peers),
        };
        types.iter().map(argument).map(|number| i64::try_from(number).unwrap()).collect()
    }

    /// Something that somebody says, whether he may or not.
    pub(super) fn said(&self, from: usize, choices: &mut Choices<'_>) -> Command {
        let messages = self.predicates.iter().filter(|message| !message.senders.is_empty());
        let message = choices.of(&messages.collect::<Vec<_>>());
        let performative = match (message.is_goal, choices.chance(25)) {
            (false, false) => Performative::Tell,
            (false, true) => Performative::Untell,
            (true, false) => Performative::Achieve,
            (true, true) => Performative::Unachieve,
        };
        let types = if performative.has_arguments() { &*message.types } else { &[] };
        Command::Receive(from, performative, message.name, self.arguments(types, choices))
    }

    /// What the environment raises or sets, and its clock.
    pub(super) fn surroundings(&self, choices: &mut Choices<'_>) -> Command {
        let Predicate { name, is_goal, types, is_settable, is_raised, .. } =
            choices.of(&self.predicates);
        match choices.pick(5) {
            1 | 2 if is_settable => Command::Set(name, self.arguments(&types, choices)),
            3 | 4 if is_raised => match (is_goal, choices.chance(40)) {
                (true, _) => Command::Raise("achieve", name, self.arguments(&types, choices)),
                (false, false) => Command::Raise("add", name, self.arguments(&types, choices)),
                (false, true) => Command::Raise("del", name, Vec::new()),
            },
            _ => Command::Time(choices.of(&TIMES)),
        }
    }
}

fn call(name: &str, arguments: &[String]) -> String {
    if arguments.is_empty() { name.to_owned() } else { format!("{name}({})", arguments.join(", ")) }
}

/// Variables with a value.
#[derive(Clone, Default)]
struct Scope {
    variables: Vec<(String, Type)>,
    made: usize,
    /// How many ways there are to choose who told the beliefs, less one.
    further_ways: usize,
}

/// A plan while it is written.
struct Plan<'a, 'b, 'c> {
    talker: &'a Talker,
    scope: Scope,
    choices: &'b mut Choices<'c>,
}

impl Plan<'_, '_, '_> {
    fn text(&mut self, operator: &str, level: usize) -> String {
        let talker = self.talker;
        let predicate = &talker.predicates[level];
        let arguments = self.patterns(&predicate.types);
        let mut text = format!("{operator}{}", call(predicate.name, &arguments));
        if !predicate.senders.is_empty() {
            text.push_str(&self.source(predicate));
        }
        if self.choices.chance(70) {
            _ = write!(text, " : {}", self.context(2));
        }
        let mut body: Vec<String> = (0..=self.choices.pick(4)).map(|_| self.step(level)).collect();
        // Nobody else can cause this again.
        if level == 0 && self.choices.chance(30) {
            let again = if predicate.is_goal { "!" } else { "+" };
            body.push(format!("{again}{}", self.called(predicate)));
        }
        _ = writeln!(text, " <- {}.", body.join("; "));
        text
    }

    /// A new variable; it has a value behind the place where it is written.
    fn fresh(&mut self, ctype: Type) -> String {
        self.scope.made += 1;
        let name = format!("V{}", self.scope.made);
        self.scope.variables.push((name.clone(), ctype));
        name
    }

    fn variable(&mut self, ctype: Type) -> Option<String> {
        let known = self.scope.variables.iter().filter(|(_, other)| *other == ctype);
        let known: Vec<&String> = known.map(|(name, _)| name).collect();
        (!known.is_empty()).then(|| self.choices.of(&known).clone())
    }

    fn value(&mut self, ctype: Type) -> String {
        match (self.choices.pick(9), self.variable(ctype), ctype) {
            (0..5, Some(variable), _) => variable,
            (5, Some(variable), Type::Int) => format!("{variable} + 1"),
            (6, Some(variable), Type::Int) => format!("next({variable})"),
            (6, Some(variable), Type::Peer) => format!("other({variable})"),
            (_, _, Type::Int) => self.choices.pick(4).to_string(),
            (7 | 8, _, Type::Peer) => "self".to_owned(),
            (_, _, Type::Peer) => self.choices.of(&PEERS[..self.talker.peers]).to_owned(),
        }
    }

    fn called(&mut self, predicate: &Predicate) -> String {
        let values: Vec<String> = predicate.types.iter().map(|ctype| self.value(*ctype)).collect();
        call(predicate.name, &values)
    }

    fn patterns(&mut self, types: &[Type]) -> Vec<String> {
        let pattern = |ctype: &Type| match self.choices.pick(7) {
            0..4 => self.fresh(*ctype),
            4 => "_".to_owned(),
            _ => self.value(*ctype),
        };
        types.iter().map(pattern).collect()
    }

    /// `[source(P)]`, or nothing.
    fn source(&mut self, predicate: &Predicate) -> String {
        let source = match (self.choices.pick(9), self.variable(Type::Peer)) {
            (0 | 1, _) => return String::new(),
            (2, _) => "_".to_owned(),
            (3, Some(variable)) => variable,
            (0..6, _) => self.fresh(Type::Peer),
            (6, _) if predicate.is_own() => "self".to_owned(),
            _ => PEERS[self.choices.of(&predicate.senders)].to_owned(),
        };
        format!("[source({source})]")
    }

    /// Whether a belief of so many sources is not too much for this context.
    fn can_search(&mut self, sources: usize) -> bool {
        let ways = (self.scope.further_ways + 1) * sources;
        if ways <= MOST_WAYS {
            self.scope.further_ways = ways - 1;
        }
        ways <= MOST_WAYS
    }

    fn context(&mut self, depth: usize) -> String {
        let count = 1 + self.choices.pick(3);
        (0..count).map(|_| self.condition(depth)).collect::<Vec<_>>().join(" & ")
    }

    /// A part whose variables are not known outside.
    fn apart(&mut self, write: impl FnOnce(&mut Self) -> String) -> String {
        let outside = self.scope.variables.clone();
        let text = write(self);
        self.scope.variables = outside;
        text
    }

    /// A condition that binds this variable to a peer.
    fn binding(&mut self, common: &str) -> String {
        let told = &self.talker.predicates;
        let told = told.iter().find(|belief| !belief.is_goal && !belief.senders.is_empty());
        match told {
            Some(told) if self.choices.chance(60) && self.can_search(told.senders.len() + 1) => {
                format!("{}[source({common})]", call(told.name, &self.patterns(&told.types)))
            }
            _ => format!(".my_name({common})"),
        }
    }

    /// A belief, most often one that peers tell.
    fn belief(&mut self) -> String {
        let beliefs = self.talker.predicates.iter().filter(|predicate| !predicate.is_goal);
        let beliefs: Vec<&Predicate> = beliefs.collect();
        let belief = self.choices.of(&beliefs);
        if belief.senders.is_empty() || !self.can_search(belief.senders.len() + 1) {
            return format!("own({})", self.patterns(&[Type::Int])[0]);
        }
        let told = call(belief.name, &self.patterns(&belief.types));
        let source = self.source(belief);
        if source.contains("self") || !self.choices.chance(35) {
            return told + &source;
        }
        let age = match self.choices.pick(6) {
            0..3 => self.fresh(Type::Int),
            3 => "_".to_owned(),
            _ => self.value(Type::Int),
        };
        let source = source.trim_matches(['[', ']']);
        let comma = if source.is_empty() { "" } else { ", " };
        format!("{told}[{source}{comma}age({age})]")
    }

    fn condition(&mut self, depth: usize) -> String {
        let ctype = self.choices.of(&[Type::Peer, Type::Int]);
        let variable = self.variable(ctype);
        match (self.choices.pick(if depth == 0 { 11 } else { 15 }), variable) {
            (5..8, Some(variable)) => self.check(&variable, ctype),
            (9, _) if self.choices.chance(60) => format!(".my_name({})", self.fresh(Type::Peer)),
            (9, _) => format!(".my_name({})", self.choices.of(&PEERS[..self.talker.peers])),
            (8 | 10, Some(variable)) => {
                let function = if ctype == Type::Int { "next" } else { "other" };
                format!("{} = {function}({variable})", self.fresh(ctype))
            }
            (11, _) => format!("not {}", self.apart(Self::belief)),
            (12, _) => format!("not ({})", self.apart(|plan| plan.context(depth - 1))),
            (13 | 14, _) => {
                // A variable that both alternatives bind.
                let common = format!("Common{}", self.scope.made);
                self.scope.made += 1;
                let parts = [(); 2].map(|()| {
                    self.apart(|plan| match plan.choices.pick(3) {
                        0 => plan.binding(&common),
                        1 => format!("{} & {}", plan.binding(&common), plan.context(depth - 1)),
                        _ => format!("{} & {}", plan.context(depth - 1), plan.binding(&common)),
                    })
                });
                self.scope.variables.push((common, Type::Peer));
                format!("({})", parts.join(" | "))
            }
            _ => {
                let known = self.scope.variables.len();
                let belief = self.belief();
                match self.scope.variables[known..].last().cloned() {
                    // It decides who told the belief.
                    Some((variable, ctype)) if self.choices.chance(50) => {
                        format!("{belief} & {}", self.check(&variable, ctype))
                    }
                    _ => belief,
                }
            }
        }
    }

    /// A condition about the value of a variable.
    fn check(&mut self, variable: &str, ctype: Type) -> String {
        match (self.choices.pick(3), ctype) {
            (0, Type::Int) => format!("even({variable})"),
            (0, Type::Peer) => format!("odd({variable})"),
            (_, _) => {
                let right = match (self.value(ctype), ctype) {
                    (same, Type::Int) if same == variable => "2".to_owned(),
                    (same, Type::Peer) if same == variable => "self".to_owned(),
                    (other, _) => other,
                };
                format!("{variable} {} {right}", self.choices.of(&["==", "\\=="]))
            }
        }
    }

    fn step(&mut self, level: usize) -> String {
        let talker = self.talker;
        let behind = &talker.predicates[level + 1..];
        let [goals, beliefs] = [true, false].map(|is_goal| {
            behind.iter().filter(|predicate| predicate.is_goal == is_goal).collect::<Vec<_>>()
        });
        match self.choices.pick(16) {
            3..5 => {
                let receiver = self.value(Type::Peer);
                format!(".send({receiver}, {})", self.content())
            }
            5 => format!(".broadcast({})", self.content()),
            6 => format!(".my_name({})", self.fresh(Type::Peer)),
            7 | 8 if !beliefs.is_empty() => {
                let belief = self.choices.of(&beliefs);
                format!("+{}", self.called(belief))
            }
            9 if !beliefs.is_empty() => {
                let belief = self.choices.of(&beliefs);
                let wanted = belief.types.iter().map(|ctype| {
                    if self.choices.chance(60) { "_".to_owned() } else { self.value(*ctype) }
                });
                let wanted: Vec<String> = wanted.collect();
                format!("-{}", call(belief.name, &wanted))
            }
            10..13 if !goals.is_empty() => {
                let goal = self.choices.of(&goals);
                format!("!{}", self.called(goal))
            }
            13 => {
                let goals = talker.predicates.iter().filter(|predicate| predicate.is_goal);
                let goals: Vec<&Predicate> = goals.collect();
                let goal = self.choices.of(&goals);
                format!("!!{}", self.called(goal))
            }
            14 => {
                let value = self.value(Type::Int);
                format!("{} = next({value})", self.fresh(Type::Int))
            }
            1 => format!("who({})", self.value(Type::Peer)),
            2 => format!("both({}, {})", self.value(Type::Int), self.value(Type::Peer)),
            _ => format!("act({})", self.value(Type::Int)),
        }
    }

    /// What is said: `tell, told1(3)`.
    fn content(&mut self) -> String {
        let messages = self.talker.predicates.iter().filter(|message| !message.senders.is_empty());
        let messages: Vec<&Predicate> = messages.collect();
        let message = self.choices.of(&messages);
        let verb = if message.is_goal { "achieve" } else { "tell" };
        if self.choices.chance(25) {
            return format!("un{verb}, {}", message.name);
        }
        format!("{verb}, {}", self.called(message))
    }
}
