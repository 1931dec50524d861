//! A run of an agent: its state, and the states before, to which it can go back.

use std::collections::VecDeque;
use std::sync::Arc;

use diagnostic::Diagnostic;
use translator::configuration::{Configuration, ExternalTrigger};
use translator::interpreter::{Interpreter, Value, trigger, with_values};
use translator::types::TypeKind;
use translator::{Happening, ParsedConfiguration, TranslateError};

use super::monitor::Monitors;
use super::script::{Statement, parse_line, words};
use super::values::zero;
use super::world::{Answers, World};

/// What is told of a step in which nothing happens.
pub(crate) const IDLE: &str = "no event waits";
/// States that can be gone back to.
const KEPT: usize = 500;

/// An agent that is run by hand.
///
/// ```
/// let configuration = "settings { input = lamp.asl; output = lamp.c; header = lamp.h; basics = actions.h; };
///     basics { void switchOn(void); }; types { light(void); }; triggerables { +!light; };";
/// let configuration = translator::parse_configuration("lamp.conf", configuration)?;
/// let mut session = asl2c::Session::new(&configuration, "+!light <- switchOn.")?;
/// let shown = session.execute("achieve_light(); next_step();").unwrap();
/// assert_eq!(shown, ["switchOn()"]);
/// # Ok::<(), translator::TranslateError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Session {
    pub(super) configuration: Arc<Configuration>,
    pub(super) now: State,
    before: VecDeque<State>,
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
    /// An agent whose functions return 0, `false` and the like.
    ///
    /// # Errors
    /// As [`translator::translate`].
    pub fn new(configuration: &ParsedConfiguration, text: &str) -> Result<Self, TranslateError> {
        let agent = Interpreter::new(configuration, text)?;
        let configuration = configuration.declarations().clone();
        let mut world = World::default();
        for basic in &configuration.basics {
            if basic.result.kind != TypeKind::Void {
                let first = zero(&basic.result, &configuration);
                world.answers.insert(basic.name.text.clone(), Answers::new(vec![first]));
            }
        }
        let monitors = Monitors::new(&configuration);
        let now = State { agent, world, monitors, steps: 0 };
        let configuration = Arc::new(configuration);
        Ok(Self { configuration, now, before: VecDeque::new(), broken: Vec::new(), ended: false })
    }

    /// Does what a line says and returns what is to be shown. Actions stand there as calls; what begins with `//` is
    /// a note.
    ///
    /// # Errors
    /// What is wrong with the line, with a span in it. Nothing of the line is done then, or, if a step is too long,
    /// nothing from that step on.
    pub fn execute(&mut self, line: &str) -> Result<Vec<String>, Diagnostic> {
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
            self.before.push_back(self.now.clone());
            if self.before.len() > KEPT {
                self.before.pop_front();
            }
        }
        for statement in statements {
            self.statement(statement, &mut shown)
                .map_err(|message| Diagnostic::error(message, 0..line.len()))?;
        }
        Ok(shown)
    }

    /// Names of the properties that the last line has broken.
    pub fn broken(&self) -> &[String] {
        &self.broken
    }

    /// Whether `quit` was said.
    pub fn is_ended(&self) -> bool {
        self.ended
    }

    /// What a line may begin with.
    pub fn words(&self) -> Vec<String> {
        words(&self.configuration)
    }

    /// Steps since the beginning.
    pub(crate) fn steps(&self) -> u64 {
        self.now.steps
    }

    /// Does what a line says, and returns what that is in the agent's words.
    pub(crate) fn told(&mut self, line: &str) -> Vec<Happening> {
        let parsed = parse_line(line, &self.configuration);
        let Ok(shown) = self.execute(line) else { return Vec::new() };
        let at = |depth, text: String| Happening::new(depth, None, text);
        match parsed.unwrap_or_default().first() {
            Some(Statement::Raise(event, values)) => {
                let event = trigger(event.operator, event.kind, &event.name.text, values);
                let refused = shown.first().map_or("", |_| ", which is refused: the inbox is full");
                return vec![at(0, format!("the environment raises {event}{refused}"))];
            }
            Some(Statement::Set(belief, values)) => {
                let belief = with_values(belief, values);
                return vec![at(0, format!("the environment tells {belief}"))];
            }
            Some(Statement::Step(_)) => {}
            // What functions return is told where they are called.
            _ => return Vec::new(),
        }
        let story = &self.now.world.story;
        let idle = if story.is_empty() { format!(": {IDLE}") } else { String::new() };
        let step = at(0, format!("step {}{idle}", self.now.steps));
        // Plans that do not apply are told with all that was asked for them.
        std::iter::once(step).chain(story.iter().cloned()).collect()
    }

    fn statement(&mut self, statement: Statement, shown: &mut Vec<String>) -> Result<(), String> {
        match statement {
            Statement::Raise(event, values) => self.raise(&event, values, shown),
            Statement::Set(belief, values) => self.now.agent.set(belief, values),
            Statement::Answer(function, values) => {
                self.now.world.answers.insert(function, Answers::new(values));
            }
            Statement::Init => {
                self.now.agent.init();
                self.now.monitors = Monitors::new(&self.configuration);
                self.now.steps = 0;
            }
            Statement::Clear => self.now.agent.clear(),
            Statement::Step(count) => self.make_steps(count, shown)?,
            Statement::Run(most) => self.run(most, shown)?,
            Statement::Mind => shown.extend(self.mind()),
            Statement::Undo(count) => self.undo(count)?,
            Statement::Help => shown.extend(HELP.lines().map(str::to_owned)),
            Statement::Quit => self.ended = true,
        }
        Ok(())
    }

    fn raise(&mut self, event: &ExternalTrigger, values: Vec<Value>, shown: &mut Vec<String>) {
        let before = self.now.agent.clone();
        let name = &event.name.text;
        match self.now.agent.raise(event.operator, event.kind, name, values) {
            Ok(()) => self.now.monitors.raised(event, &self.configuration, &before),
            Err(refused) => shown.push(format!("// refused: {refused}")),
        }
    }

    fn undo(&mut self, count: u32) -> Result<(), String> {
        for _ in 0..count {
            self.now = self.before.pop_back().ok_or("there is nothing more to undo")?;
        }
        Ok(())
    }

    /// What is believed, what waits, and what the last step did.
    fn mind(&self) -> Vec<String> {
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
        section(&mut lines, "believes", "believes nothing", beliefs.collect());
        section(&mut lines, "waiting, the next first", "nothing waits", agent.waiting());
        let counts = [
            (agent.unhandled_events(), "not handled to their end"),
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
                &format!("step {steps}: no event waited"),
                story.collect(),
            );
        }
        lines
    }
}

const HELP: &str = "\
achieve_g(1); add_b(1); del_b();  raise an event that the configuration has among its triggerables
set_b(1.5);                       set a belief that it has among its settables
f_result = true;                  what a function returns from now on
f_result = 1, 2;                  what it returns the next times; the last value stays
next_step();  step [N]            one deliberation cycle, or so many
run [N]                           steps until nothing waits or nothing changes, at most 1000 or N
init();  clear();                 start anew; forget all events
mind                              beliefs, waiting events, and what the last step did and why
undo [N]                          take the last line back, or so many
quit";
