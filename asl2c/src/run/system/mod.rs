//! Runs a system: its agents by the reference interpreter, and the channels between them.

mod monitor;
mod network;
mod repeat;
mod script;

use diagnostic::Diagnostic;
use translator::TranslateError;
use translator::interpreter::{Value, message_text};
use translator::syntax::ast::Performative;
use translator::system::{ROOM, System};

use self::monitor::Monitors;
pub use self::network::NetworkConditions;
use self::network::{ChannelFull, Message, Network};
pub use self::repeat::repeat;
use self::script::{Command, parse, words};
use super::history::History;
use super::script::{Statement, parse_line};
use super::session::{Session, State};
use super::transcript::Runs;

/// Maximum number of lines that a command may show.
const MOST_LINES: usize = 100_000;

/// A system that is run interactively or by a script.
#[derive(Debug)]
pub struct SystemSession<'a> {
    system: &'a System,
    agents: Vec<Session>,
    now: Now,
    before: History<(Vec<State>, Now)>,
    broken: Vec<String>,
    ended: bool,
}

/// Everything that a line can change, besides the agents.
#[derive(Debug, Clone)]
struct Now {
    network: Network,
    monitors: Monitors,
    /// Which agents have made their step of the round.
    moved: Vec<bool>,
    /// From 1.
    round: u64,
}

impl<'a> SystemSession<'a> {
    /// A system before its first round.
    ///
    /// # Errors
    /// As [`translator::translate`].
    pub fn new(system: &'a System, conditions: NetworkConditions) -> Result<Self, TranslateError> {
        let agents = system.members.iter().map(|member| {
            let mut agent = Session::new(&member.configuration, &member.text)?;
            agent.be_in_a_system(member.peer);
            Ok(agent)
        });
        let agents = agents.collect::<Result<Vec<_>, TranslateError>>()?;
        let now = Now {
            network: Network::new(system.channels, conditions),
            monitors: Monitors::new(system),
            moved: vec![false; agents.len()],
            round: 1,
        };
        let (before, broken, ended) = (History::new(), Vec::new(), false);
        Ok(Self { system, agents, now, before, broken, ended })
    }

    fn name(&self, member: usize) -> &'a str {
        &self.system.members[member].name
    }

    fn command(&mut self, command: Command<'_>, shown: &mut Vec<String>) -> Result<(), Diagnostic> {
        match command {
            Command::Agent { member, line, start } => {
                self.agent_line(member, line, shown).map_err(|mut error| {
                    error.span = start + error.span.start..start + error.span.end;
                    error
                })
            }
            Command::Step(count) => (0..count).try_for_each(|_| self.round(shown)).map_err(whole),
            Command::Deliver(from, to, number) => {
                let place = self.place(from, to, number).map_err(whole)?;
                self.arrive(place, shown);
                self.end_round_in_time(shown);
                Ok(())
            }
            Command::Lose(from, to, number) => {
                let place = self.place(from, to, number).map_err(whole)?;
                let lost = self.now.network.lose(place).map_err(|_| {
                    whole(
                        "it arrives: the channel has lost as many as it can, one after the other"
                            .to_owned(),
                    )
                })?;
                shown.push(format!("{}, lost", self.described(&lost)));
                self.end_round_in_time(shown);
                Ok(())
            }
            Command::Mind(member) => {
                for member in member.map_or_else(|| 0..self.agents.len(), |one| one..one + 1) {
                    shown.push(format!("{}:", self.name(member)));
                    let lines = self.agents[member].mind();
                    shown.extend(lines.into_iter().map(|line| format!("  {line}")));
                }
                Ok(())
            }
            Command::Channels => {
                let lines = self.now.network.under_way().map(|message| self.described(message));
                shown.extend(lines);
                if self.now.network.under_way().next().is_none() {
                    shown.push("no message is under way".to_owned());
                }
                Ok(())
            }
            Command::Undo(count) => self.undo(count).map_err(whole),
            Command::Help => {
                shown.extend(HELP.lines().map(str::to_owned));
                Ok(())
            }
            Command::Quit => {
                self.ended = true;
                Ok(())
            }
        }
    }

    /// A line of one agent.
    fn agent_line(
        &mut self,
        member: usize,
        line: &str,
        shown: &mut Vec<String>,
    ) -> Result<(), Diagnostic> {
        let configuration = std::sync::Arc::clone(&self.agents[member].configuration);
        let statements = parse_line(line, &configuration)?;
        let wrong = |what: &str| Diagnostic::error(what.to_owned(), 0..line.len());
        for statement in statements {
            match &statement {
                Statement::Step(1) => {
                    self.step(member, shown).map_err(|what| wrong(&what))?;
                    self.end_round_in_time(shown);
                }
                Statement::Raise(event, values) => {
                    match self.agents[member].raise(event, values.clone()) {
                        Ok(()) => self.now.monitors.raised(self.system, member, event),
                        Err(refused) => {
                            shown.push(format!("// {}: refused: {refused}", self.name(member)));
                        }
                    }
                }
                Statement::Set(..) | Statement::Answer(..) | Statement::Mind => {
                    self.agent_statement(member, statement, shown).map_err(|what| wrong(&what))?;
                }
                Statement::Step(_) | Statement::Run(_) => {
                    return Err(wrong("an agent makes one step in a round")
                        .help("`step 3` without an agent makes three rounds"));
                }
                Statement::Receive(..) => {
                    return Err(wrong("a message comes through a channel")
                        .help("`deliver` and `lose` decide about those that are under way"));
                }
                Statement::Be(_) | Statement::Init | Statement::Clear => {
                    return Err(wrong("the agents of a system are never initialised again"));
                }
                Statement::Undo(_) | Statement::Help | Statement::Quit => {
                    return Err(wrong("this command stands without an agent"));
                }
            }
        }
        Ok(())
    }

    /// Executes a statement of one agent, and shows its output with its name.
    fn agent_statement(
        &mut self,
        member: usize,
        statement: Statement,
        shown: &mut Vec<String>,
    ) -> Result<(), String> {
        if shown.len() > MOST_LINES {
            return Err(format!("stopped: there are more than {MOST_LINES} lines to show"));
        }
        let name = self.name(member);
        let (agent, mut lines) = (&mut self.agents[member], Vec::new());
        agent.broken.clear();
        agent.statement(statement, &mut lines).map_err(|what| format!("{name}: {what}"))?;
        self.broken.extend(agent.broken.iter().map(|broken| format!("{name}.{broken}")));
        shown.extend(lines.into_iter().map(|line| match line.strip_prefix("// ") {
            Some(comment) => format!("// {name}: {comment}"),
            None => format!("{name}: {line}"),
        }));
        Ok(())
    }

    /// The step of an agent in this round.
    fn step(&mut self, member: usize, shown: &mut Vec<String>) -> Result<(), String> {
        if self.now.moved[member] {
            let all = 0..self.agents.len();
            let others = all.filter(|other| !self.now.moved[*other]);
            let others: Vec<&str> = others.map(|other| self.name(other)).collect();
            let (name, round) = (self.name(member), self.now.round);
            let missing = if others.is_empty() {
                "messages that cannot be later have to arrive or be lost".to_owned()
            } else {
                format!("{} has not", others.join(", "))
            };
            return Err(format!("{name} has made its step in round {round}: {missing}"));
        }
        self.agent_statement(member, Statement::Step(1), shown)?;
        self.now.moved[member] = true;
        let world = &mut self.agents[member].now.world;
        for call in &world.sequence {
            self.now.monitors.called(self.system, member, call);
        }
        for (performative, about, values) in std::mem::take(&mut world.sent) {
            self.send(member, (performative, &about), values, shown);
        }
        Ok(())
    }

    /// An agent has called an action that sends a message.
    fn send(
        &mut self,
        from: usize,
        said: (Performative, &str),
        mut values: Vec<Value>,
        shown: &mut Vec<String>,
    ) {
        let peer = if values.is_empty() { None } else { Some(values.remove(0)) };
        let to = match peer {
            Some(Value::Integer(peer)) => usize::try_from(peer).ok(),
            _ => None,
        };
        // What is sent to oneself, or to nobody, goes nowhere.
        let to = to.and_then(|peer| self.system.peer(peer)).filter(|to| *to != from);
        let Some(to) = to else { return };
        let text = values.clone();
        if let Err(ChannelFull) = self.now.network.put((from, to), said, values, self.now.round) {
            let (from, to) = (self.name(from), self.name(to));
            let what = self.text(said, &text);
            shown.push(format!("{from} -> {to}: {what}, lost: the channel is full"));
            if self.system.channels.losses.is_some() {
                shown.push(format!("// round {} breaks `{ROOM}`", self.now.round));
                self.broken.push(ROOM.to_owned());
            }
        }
    }

    /// A message arrives.
    fn arrive(&mut self, place: usize, shown: &mut Vec<String>) {
        let message = self.now.network.take(place);
        let mut line = self.described(&message);
        let Message { from, to, performative, about, values, .. } = message;
        let from = self.system.members[from].peer;
        if !self.agents[to].receive(from, performative, &about, values) {
            line += ", refused";
        }
        shown.push(line);
    }

    fn described(&self, message: &Message) -> String {
        let Message { from, to, performative, about, values, .. } = message;
        let what = self.text((*performative, about), values);
        format!("{} -> {}: {what}", self.name(*from), self.name(*to))
    }

    /// What is said, as agents write it in lines of text. All agents have the same messages.
    fn text(&self, (performative, about): (Performative, &str), values: &[Value]) -> String {
        let first = self.system.members.first();
        first.map_or_else(String::new, |first| {
            message_text(first.configuration.declarations(), performative, about, values)
        })
    }

    /// The place of a message among all.
    fn place(&self, from: usize, to: usize, number: usize) -> Result<usize, String> {
        let found = self.now.network.between(from, to).nth(number - 1);
        found.map(|(place, _)| place).ok_or_else(|| {
            let count = self.now.network.between(from, to).count();
            let (from, to) = (self.name(from), self.name(to));
            format!("{count} messages of {from} to {to} are under way")
        })
    }

    /// The rest of this round: each agent makes its step, and what is due arrives.
    fn round(&mut self, shown: &mut Vec<String>) -> Result<(), String> {
        shown.push(format!("// round {}", self.now.round));
        for member in 0..self.agents.len() {
            if !self.now.moved[member] {
                self.step(member, shown)?;
            }
        }
        while let Some((place, is_lost)) = self.now.network.due(self.now.round) {
            let lost = is_lost.then(|| self.now.network.lose(place).ok()).flatten();
            match lost {
                Some(lost) => shown.push(format!("{}, lost", self.described(&lost))),
                None => self.arrive(place, shown),
            }
        }
        self.end_round(shown);
        Ok(())
    }

    /// Ends the round if all agents have made their steps, and no message would be late that cannot be.
    fn end_round_in_time(&mut self, shown: &mut Vec<String>) {
        let all = self.now.moved.iter().all(|moved| *moved);
        if all && !self.now.network.is_overdue(self.now.round) {
            self.end_round(shown);
        }
    }

    fn end_round(&mut self, shown: &mut Vec<String>) {
        for broken in self.now.monitors.end_round(self.system) {
            shown.push(format!("// round {} breaks `{broken}`", self.now.round));
            self.broken.push(broken);
        }
        self.now.round += 1;
        self.now.moved.fill(false);
    }

    fn undo(&mut self, count: u32) -> Result<(), String> {
        if let Some(before) = self.before.undo(count)? {
            self.restore(before);
        }
        Ok(())
    }

    fn states(&self) -> Vec<State> {
        self.agents.iter().map(|agent| agent.now.clone()).collect()
    }

    fn restore(&mut self, (agents, now): (Vec<State>, Now)) {
        for (agent, state) in self.agents.iter_mut().zip(agents) {
            agent.now = state;
        }
        self.now = now;
    }
}

/// An error of the whole line.
fn whole(message: String) -> Diagnostic {
    Diagnostic::error(message, 0..0)
}

impl Runs for SystemSession<'_> {
    fn execute(&mut self, line: &str) -> Result<Vec<String>, Diagnostic> {
        self.broken.clear();
        let command = parse(line, self.system)?;
        let (mut shown, before) = (Vec::new(), (self.states(), self.now.clone()));
        if let Err(mut error) = self.command(command, &mut shown) {
            // Of a line with an error nothing is executed.
            self.restore(before);
            if error.span.is_empty() {
                error.span = 0..line.len();
            }
            return Err(error);
        }
        if matches!(
            command,
            Command::Agent { .. } | Command::Step(_) | Command::Deliver(..) | Command::Lose(..)
        ) {
            self.before.push(before);
        }
        Ok(shown)
    }

    fn broken(&self) -> &[String] {
        &self.broken
    }

    fn is_ended(&self) -> bool {
        self.ended
    }

    fn words(&self) -> Vec<String> {
        words(self.system)
    }
}

const HELP: &str = "\
first: achieve_g(1); set_b(1.5);  events, beliefs and results of functions of the agent `first`
first: next_step();               its step in this round; the round ends when all have made theirs
step [N]                          the rest of the round, or N rounds: the agents in their order, then what is due arrives
deliver first second [N]          a message of `first` to `second` arrives: the oldest, or the N-th
lose first second [N]             it is lost
channels                          the messages that are under way
mind [first]                      beliefs and pending events of all agents, or of one
undo [N]                          undo the last line, or N lines
quit";
