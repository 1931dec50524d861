//! The environment of an agent that is run by hand: what its functions return, and what it has done.

use std::collections::{BTreeMap, VecDeque};

use translator::Happening;
use translator::interpreter::{Environment, Value};
use translator::types::{CType, TypeKind};

/// What one function returns: these values, one each time, and from then on the last of them.
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
    /// What functions return, by name.
    pub(super) answers: BTreeMap<String, Answers>,
    /// The actions of the step, as transcripts show them.
    pub(super) shown: Vec<String>,
    /// How often each basic action or function was called in the step.
    pub(super) calls: BTreeMap<String, u32>,
    /// What happened in the step and why.
    pub(super) story: Vec<Happening>,
}

impl World {
    /// What is known of the last step is forgotten.
    pub(super) fn begin_step(&mut self) {
        self.shown.clear();
        self.calls.clear();
        self.story.clear();
    }

    /// Whether functions go on to return what they return now.
    pub(super) fn is_constant(&self) -> bool {
        self.answers.values().all(|answers| answers.next.len() <= 1)
    }
}

impl Environment for World {
    fn update_beliefs(&mut self) -> Vec<(String, Vec<Value>)> {
        Vec::new()
    }

    fn call(&mut self, name: &str, arguments: &[Value], result: &CType) -> Option<Value> {
        *self.calls.entry(name.to_owned()).or_default() += 1;
        if result.kind == TypeKind::Void {
            // As the guide's transcripts show them.
            let arguments: Vec<String> = (arguments.iter())
                .map(|value| match value {
                    Value::Text(text) => text.clone(),
                    value => value.to_string(),
                })
                .collect();
            self.shown.push(format!("{name}({})", arguments.join(",")));
            return None;
        }
        self.answers.get_mut(name).and_then(Answers::next)
    }

    fn story(&mut self) -> Option<&mut Vec<Happening>> {
        Some(&mut self.story)
    }
}
