//! A run of an agent: its state, and earlier states for `undo`.

use std::sync::Arc;

use diagnostic::Diagnostic;
use translator::configuration::{Configuration, ExternalTrigger};
use translator::interpreter::{Interpreter, Refused, Value, message_text, trigger, with_values};
use translator::syntax::ast::Performative;
use translator::types::TypeKind;
use translator::{CounterexampleStep, ParsedConfiguration, TranslateError};

use super::history::History;
use super::monitor::Monitors;
use super::script::{Statement, parse_line, words};
use super::transcript::Runs;
use super::values::zero;
use super::world::{Answers, World};

/// Shown for a step without an event.
pub(crate) const IDLE: &str = "no event is pending";

/// An agent that is run interactively or by a script.
///
/// ```
/// let configuration = "settings { input = lamp.asl; output = lamp.c; header = lamp.h; basics = actions.h; };
///     basics { void switchOn(void); }; types { light(void); }; triggerables { +!light; };";
/// let configuration = translator::parse_configuration("lamp.conf", configuration)?;
/// let mut session = asl2c::Session::new(&configuration, "+!light <- switchOn.")?;
/// use asl2c::Runs as _;
/// let shown = session.execute("achieve_light(); next_step();").unwrap();
/// assert_eq!(shown, ["switchOn()"]);
/// # Ok::<(), translator::TranslateError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Session {
    pub(super) configuration: Arc<Configuration>,
    pub(super) now: State,
    before: History<State>,
    pub(super) broken: Vec<String>,
    ended: bool,
}

/// Everything that a line can change.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) agent: Interpreter,
    pub(super) world: World,
    pub(super) monitors: Monitors,
    pub(super) steps: u64,
}

impl Session {
    /// An agent whose functions return 0, `false` or the like.
    ///
    /// # Errors
    /// As [`translator::translate`].
    pub fn new(configuration: &ParsedConfiguration, text: &str) -> Result<Self, TranslateError> {
        let agent = Interpreter::new(configuration, text)?;
        let configuration = configuration.declarations().clone();
        let trace = configuration.settings.trace.as_ref().map(|name| name.text.clone());
        let mut world = World { trace, ..World::default() };
        for basic in &configuration.basics {
            if basic.result.kind != TypeKind::Void {
                let first = zero(&basic.result, &configuration);
                world.answers.insert(basic.name.text.clone(), Answers::new(vec![first]));
            }
        }
        let monitors = Monitors::new(&configuration);
        let now = State { agent, world, monitors, steps: 0 };
        let configuration = Arc::new(configuration);
        Ok(Self { configuration, now, before: History::new(), broken: Vec::new(), ended: false })
    }

    /// Begins as a peer whose messages are collected.
    pub(super) fn be_in_a_system(&mut self, peer: usize) {
        self.now.agent.be(peer);
        for (name, performative, message) in self.configuration.receiving() {
            let action = name.replacen("receive_", "send_", 1);
            self.now.world.sending.insert(action, (performative, message.name.text.clone()));
        }
    }

    /// Number of steps since the start.
    pub(crate) fn steps(&self) -> u64 {
        self.now.steps
    }

    /// Executes a line, and returns it as steps of a counterexample.
    pub(crate) fn happenings(&mut self, line: &str) -> Vec<CounterexampleStep> {
        let parsed = parse_line(line, &self.configuration);
        let Ok(shown) = self.execute(line) else { return Vec::new() };
        let at = |depth, text: String| CounterexampleStep::new(depth, None, text);
        match parsed.unwrap_or_default().first() {
            Some(Statement::Raise(event, values)) => {
                let event = trigger(event.operator, event.kind, &event.name.text, values);
                let refused = shown.first().map_or("", |_| ", which is refused: the inbox is full");
                return vec![at(0, format!("the environment raises {event}{refused}"))];
            }
            Some(Statement::Set(belief, values)) => {
                let belief = with_values(belief, values);
                return vec![at(0, format!("the environment sets {belief}"))];
            }
            Some(Statement::Receive(performative, about, values)) => {
                let (sender, said) = values
                    .split_first()
                    .map_or((None, &[][..]), |(peer, said)| (self.peer(peer), said));
                let sender = sender.unwrap_or_else(|| "a stranger".to_owned());
                let refused = shown.first().map_or("", |_| ", which is refused");
                let what = message_text(&self.configuration, *performative, about, said);
                return vec![at(0, format!("{sender} sends {what}{refused}"))];
            }
            Some(Statement::Be(peer)) => {
                let name = self.configuration.peers.get(*peer).map_or("?", |peer| &peer.text);
                return vec![at(0, format!("the agent is {name}"))];
            }
            Some(Statement::Clear) => {
                return vec![at(0, "the environment drops all events: clear()".to_owned())];
            }
            Some(Statement::Step(_)) => {}
            // Results of functions are shown where the functions are called.
            _ => return Vec::new(),
        }
        let story = &self.now.world.story;
        let idle = if story.is_empty() { format!(": {IDLE}") } else { String::new() };
        let step = at(0, format!("step {}{idle}", self.now.steps));
        // Plans that do not apply are shown with all queries of their contexts.
        std::iter::once(step).chain(story.iter().cloned()).collect()
    }

    /// The name of a peer.
    fn peer(&self, peer: &Value) -> Option<String> {
        let Value::Integer(number) = peer else { return None };
        let peer = self.configuration.peers.get(usize::try_from(*number).ok()?)?;
        Some(peer.text.clone())
    }

    pub(super) fn statement(
        &mut self,
        statement: Statement,
        shown: &mut Vec<String>,
    ) -> Result<(), String> {
        match statement {
            Statement::Raise(event, values) => {
                if let Err(refused) = self.raise(&event, values) {
                    shown.push(format!("// refused: {refused}"));
                }
            }
            Statement::Set(belief, values) => self.now.agent.set(belief, values),
            Statement::Receive(performative, about, values) => {
                let sender = match values.first() {
                    Some(Value::Integer(sender)) => usize::try_from(*sender).unwrap_or(usize::MAX),
                    _ => usize::MAX,
                };
                if !self.receive(sender, performative, &about, values[1..].to_vec()) {
                    shown.push(
                        "// refused: not from this peer, or too many of them wait".to_owned(),
                    );
                }
            }
            Statement::Be(peer) => {
                self.now.agent.be(peer);
                self.now.monitors = Monitors::new(&self.configuration);
                self.now.steps = 0;
            }
            Statement::Answer(function, values) => {
                self.now.world.answers.insert(function, Answers::new(values));
            }
            Statement::Init => {
                self.now.agent.init();
                self.now.monitors = Monitors::new(&self.configuration);
                self.now.steps = 0;
            }
            Statement::Clear => {
                self.now.agent.clear();
                self.now.monitors.clear();
            }
            Statement::Step(count) => self.make_steps(count, shown)?,
            Statement::Run(most) => self.run(most, shown)?,
            Statement::Mind => shown.extend(self.mind()),
            Statement::Undo(count) => self.undo(count)?,
            Statement::Help => shown.extend(HELP.lines().map(str::to_owned)),
            Statement::Quit => self.ended = true,
        }
        Ok(())
    }

    /// The environment raises an event.
    pub(super) fn raise(
        &mut self,
        event: &ExternalTrigger,
        values: Vec<Value>,
    ) -> Result<(), Refused> {
        let State { agent, monitors, .. } = &mut self.now;
        agent.raise(event.operator, event.kind, &event.name.text, values)?;
        monitors.raised(event, &self.configuration, agent);
        Ok(())
    }

    /// A message arrives. False if it is refused.
    pub(super) fn receive(
        &mut self,
        sender: usize,
        performative: Performative,
        about: &str,
        values: Vec<Value>,
    ) -> bool {
        let State { agent, world, monitors, .. } = &mut self.now;
        let before = agent.clone();
        let is_news = agent.is_news(sender, performative, about, &values);
        let accepted = agent.receive(sender, performative, about, values, world);
        if accepted {
            let said = (sender, performative, about, is_news);
            monitors.heard(said, &self.configuration, &before, agent);
        }
        accepted
    }

    fn undo(&mut self, count: u32) -> Result<(), String> {
        if let Some(before) = self.before.undo(count)? {
            self.now = before;
        }
        Ok(())
    }

    /// The beliefs, the pending events, and the last step.
    pub(super) fn mind(&self) -> Vec<String> {
        let State { agent, world, steps, .. } = &self.now;
        let mut lines = Vec::new();
        let section = |lines: &mut Vec<String>, title: &str, empty: &str, entries: Vec<String>| {
            lines.push(if entries.is_empty() { empty.to_owned() } else { title.to_owned() });
            lines.extend(entries.into_iter().map(|entry| format!("  {entry}")));
        };
        let beliefs = agent.beliefs().map(|(name, values)| {
            let values: Vec<String> = values.iter().map(Value::to_string).collect();
            if values.is_empty() {
                name.to_owned()
            } else {
                format!("{name}({})", values.join(", "))
            }
        });
        let told = agent
            .told_beliefs()
            .map(|(name, peer, values)| format!("{}[source({peer})]", with_values(name, values)));
        section(&mut lines, "believes", "no beliefs", beliefs.chain(told).collect());
        section(&mut lines, "pending, the next one first", "no events", agent.waiting());
        let counts = [
            (agent.unhandled_events(), "not handled completely"),
            (agent.refused_events(), "refused"),
            (agent.aborted_events(), "aborted"),
        ];
        let counts = counts.iter().filter(|(count, _)| *count > 0);
        let counts: Vec<String> = counts.map(|(count, what)| format!("{count} {what}")).collect();
        if !counts.is_empty() {
            lines.push(format!("events: {}", counts.join(", ")));
        }
        if *steps > 0 {
            let story = world.story.iter().map(|happening| {
                let mut happening = happening.clone();
                happening.depth = happening.depth.saturating_sub(1);
                happening.to_string()
            });
            section(
                &mut lines,
                &format!("step {steps}"),
                &format!("step {steps}: no event was pending"),
                story.collect(),
            );
        }
        lines
    }
}

impl Runs for Session {
    fn execute(&mut self, line: &str) -> Result<Vec<String>, Diagnostic> {
        self.broken.clear();
        let statements = parse_line(line, &self.configuration)?;
        let mut shown = Vec::new();
        let changes = |statement: &Statement| {
            !matches!(
                statement,
                Statement::Mind | Statement::Help | Statement::Quit | Statement::Undo(_)
            )
        };
        if statements.iter().any(changes) {
            self.before.push(self.now.clone());
        }
        for statement in statements {
            self.statement(statement, &mut shown)
                .map_err(|message| Diagnostic::error(message, 0..line.len()))?;
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
        words(&self.configuration)
    }
}

const HELP: &str = "\
achieve_g(1); add_b(1); del_b();  raise an event of the configuration's triggerables
set_b(1.5);                       set a belief of its settables
receive_tell_b(leader, 1);        a message of a peer; init(leader); begins again as one of them
f_result = true;                  result of a function from now on
f_result = 1, 2;                  its next results; the last one repeats
next_step();  step [N]            one deliberation cycle, or N
run [N]                           steps until no event is pending or a state repeats, at most 1000 or N
init();  clear();                 start again; drop all events
mind                              beliefs, pending events, and the last step with its causes
undo [N]                          undo the last line, or N lines
quit";
