//! Model of an agent, or of a system of agents, for the model checker SPIN.

use crate::backend::promela::{PROPERTY, emit, emit_system};
use crate::configuration::DeclaredProperty;
use crate::counterexample::{CounterexampleStep, Move, moves, of_agent, of_system};
use crate::program::Program;
use crate::system::System;

/// A model of an agent, or of a system of agents, in Promela.
///
/// Beliefs are held or not. Their values, the results of functions and the outcome of comparisons are
/// nondeterministic, except for the comparisons in properties. A property that holds in the model therefore
/// holds in every environment, while a counterexample may need an environment that cannot exist. The agents of a system hear
/// each other, and nobody else.
#[derive(Debug)]
#[non_exhaustive]
#[must_use = "the model has to be checked"]
pub struct Model {
    /// The properties, in the order of their numbers.
    pub properties: Vec<DeclaredProperty>,
    subject: Subject,
}

#[derive(Debug)]
enum Subject {
    Agent(Box<Program>),
    System { name: String, system: Box<System> },
}

impl Model {
    pub(crate) fn new(program: Program, properties: Vec<DeclaredProperty>) -> Self {
        Self { properties, subject: Subject::Agent(Box::new(program)) }
    }

    /// The model of a system; `name` is its file's name.
    pub fn of_system(name: &str, system: System) -> Self {
        let (properties, name) = (system.declared.clone(), name.to_owned());
        Self { properties, subject: Subject::System { name, system: Box::new(system) } }
    }

    /// The system, unless it is the model of one agent.
    pub fn system(&self) -> Option<&System> {
        match &self.subject {
            Subject::Agent(_) => None,
            Subject::System { system, .. } => Some(system),
        }
    }

    /// The environment variable that selects the property to check, counted from 1.
    pub fn selector(&self) -> &'static str {
        PROPERTY
    }

    /// The name of the AgentSpeak source, or of the system.
    pub fn input(&self) -> &str {
        match &self.subject {
            Subject::Agent(program) => &program.configuration.settings.input,
            Subject::System { name, .. } => name,
        }
    }

    /// The number by which a property is selected that is false in each agent: some step ends.
    pub fn falsehood(&self) -> usize {
        self.properties.len() + 1
    }

    /// The model in Promela.
    pub fn promela(&self) -> String {
        match &self.subject {
            Subject::Agent(program) => emit(program),
            Subject::System { system, .. } => emit_system(system),
        }
    }

    /// Translates the replay of a counterexample to the agents' terms.
    pub fn explain(&self, replay: &str) -> Vec<CounterexampleStep> {
        match &self.subject {
            Subject::Agent(program) => of_agent(program, replay),
            Subject::System { system, .. } => of_system(system, replay),
        }
    }

    /// What happens in the counterexample of a system, for those who repeat it; of one agent nothing.
    pub fn moves(&self, replay: &str) -> Vec<Move> {
        self.system().map_or_else(Vec::new, |system| moves(system, replay))
    }
}
