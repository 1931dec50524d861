//! The environment of an agent in a run: the results of its functions, and its actions.

use std::collections::{BTreeMap, VecDeque};

use translator::CounterexampleStep;
use translator::interpreter::{Environment, Value};
use translator::syntax::ast::Performative;
use translator::types::{CType, TypeKind};

/// Results of one function: these values in turn; the last one repeats.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Answers {
    next: VecDeque<Value>,
}

impl Answers {
    pub(super) fn new(values: Vec<Value>) -> Self {
        Self { next: values.into() }
    }

    fn next(&mut self) -> Option<Value> {
        if self.next.len() > 1 { self.next.pop_front() } else { self.next.front().cloned() }
    }
}

/// The environment of a run.
#[derive(Debug, Clone, Default)]
pub(super) struct World {
    /// Results of functions, by name.
    pub(super) answers: BTreeMap<String, Answers>,
    /// The actions of the step, as shown in transcripts.
    pub(super) shown: Vec<String>,
    /// The trace function, which generated C calls with each plan that is chosen.
    pub(super) trace: Option<String>,
    /// Number of calls of each basic action or function in the step.
    pub(super) calls: BTreeMap<String, u32>,
    /// The same in their order.
    pub(super) sequence: Vec<String>,
    /// The actions that send messages of a system: what they send.
    pub(super) sending: BTreeMap<String, (Performative, String)>,
    /// What was sent in the step, with the receiver first.
    pub(super) sent: Vec<(Performative, String, Vec<Value>)>,
    /// Events of the step, with their causes.
    pub(super) story: Vec<CounterexampleStep>,
}

impl World {
    /// Clears the data of the last step.
    pub(super) fn begin_step(&mut self) {
        self.shown.clear();
        self.calls.clear();
        self.sequence.clear();
        self.sent.clear();
        self.story.clear();
    }

    fn count(&mut self, name: &str) {
        *self.calls.entry(name.to_owned()).or_default() += 1;
        self.sequence.push(name.to_owned());
    }

    /// Whether all functions have reached their last result.
    pub(super) fn is_constant(&self) -> bool {
        self.answers.values().all(|answers| answers.next.len() <= 1)
    }
}

impl Environment for World {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        Vec::new()
    }

    fn call(&mut self, name: &str, arguments: &[Value], result: &CType) -> Option<Value> {
        self.count(name);
        if let Some((performative, about)) = self.sending.get(name) {
            self.sent.push((*performative, about.clone(), arguments.to_vec()));
        }
        if result.kind == TypeKind::Void {
            // In the form of the guide's transcripts: texts without quotation marks.
            let arguments: Vec<String> = (arguments.iter())
                .map(|value| match value {
                    Value::Text(text) => on_one_line(text),
                    value => value.to_string(),
                })
                .collect();
            self.shown.push(format!("{name}({})", arguments.join(",")));
            return None;
        }
        self.answers.get_mut(name).and_then(Answers::next)
    }

    fn chosen(&mut self) {
        if let Some(trace) = self.trace.clone() {
            self.count(&trace);
        }
    }

    fn story(&mut self) -> Option<&mut Vec<CounterexampleStep>> {
        Some(&mut self.story)
    }
}

/// A text as it is shown: with the escapes of agents, so that no line of it is taken for another one of a transcript.
fn on_one_line(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\\' => shown.push_str("\\\\"),
            character if character.is_control() => shown.extend(character.escape_default()),
            character => shown.push(character),
        }
    }
    shown
}
