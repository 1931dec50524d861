//! Compiler from AgentSpeak to C, for agents in safety-critical systems.
//!
//! An agent is written in the fragment of AgentSpeak of Bucheli, Kroening, Martins and Natraj, "From
//! AgentSpeak to C for Safety Considerations in Unmanned Aerial Vehicles" (TAROS 2015), with a configuration
//! that declares its environment. The output is C99 without heap, recursion or unbounded loops, and on
//! request Rust bindings.
//!
//! The crate is pure: texts in, texts out. Layers, each using only those before it:
//! `syntax` and `configuration` (texts to trees) → `analysis` (trees to a checked `Program`) →
//! `backend` (programs to C and Rust). The `interpreter` beside them executes the tree directly.
//!
//! ```
//! let configuration = "settings { input = lamp.asl; output = lamp.c; header = lamp.h; basics = actions.h; };
//!     basics { void switchOn(void); }; types { light(void); }; triggerables { +!light; };";
//! let parsed = translator::parse_configuration("lamp.conf", configuration)?;
//! let translation = translator::translate(&parsed, "+!light <- switchOn.")?;
//! assert!(translation.files[0].text.contains("switchOn();"));
//! # Ok::<(), translator::TranslateError>(())
//! ```
#![forbid(unsafe_code)]

mod analysis;
mod backend;
mod c_string;
mod code;
mod comparison;
pub mod configuration;
mod counterexample;
mod coverage;
mod exercise;
mod format;
mod gather;
pub mod interpreter;
mod model;
pub mod names;
mod obligations;
mod plain;
mod program;
mod report;
mod reserved;
mod scripted;
pub mod syntax;
pub mod system;
pub mod types;

use std::collections::HashSet;

pub use backend::c::{ROUNDED, include_path};
pub use backend::matrix::TraceRow;
use backend::rust::{OWN_TYPES, camel_case, snake_case, variant};
pub use code::{Code, not_read};
pub use comparison::{COMPARISON, Comparison, END, ENOUGH_ROOM, ROOM};
pub use configuration::DeclaredProperty;
use configuration::{Configuration, Instance};
pub use counterexample::{CounterexampleStep, Move, UnderWay};
pub use diagnostic::{Diagnostic, Diagnostics, Located, Severity};
use diagnostic::{Source, Span};
pub use exercise::{EXERCISE, EXERCISE_SEED, EXERCISE_STATE, EXERCISE_STEPS, Exercise};
pub use format::{format, format_system};
use gather::gather;
pub use model::Model;
pub use obligations::{ANSWERS, CALLS, HARNESS, Obligations, STEPS};
pub use plain::{ANY_FLOATS, float_function, float_operators};
pub use report::Report;
use reserved::is_rust_word;
pub use reserved::{is_c_word, is_library as is_c_library};
pub use scripted::{Act, TESTS, traced};
use syntax::Document;
use syntax::ast::{Agent, Name};
use types::TypeKind;

/// A configuration without errors.
#[derive(Debug, Clone)]
pub struct ParsedConfiguration {
    name: String,
    text: String,
    configuration: Configuration,
}

impl ParsedConfiguration {
    /// The AgentSpeak source's name, relative to the configuration.
    pub fn input(&self) -> &str {
        &self.configuration.settings.input
    }

    /// Possible paths of the files in the section `includes`, relative to the folder of the configuration or
    /// of the outputs.
    pub fn included_files(&self) -> impl Iterator<Item = String> {
        self.configuration.included_files().into_iter()
    }

    /// An error at the value of a setting whose file would overwrite another one, with its message and help.
    pub fn overwrites(&self, setting: &str, message: &str, help: &str) -> TranslateError {
        self.refused(setting, |place| Code::Overwrites.at(message, place).help(help))
    }

    /// An error at the name of the agent's text, which cannot be read for this reason.
    pub fn not_read(&self, reason: &str) -> TranslateError {
        self.refused("input", |place| not_read(self.input(), reason, place))
    }

    fn refused(&self, setting: &str, error: impl FnOnce(Span) -> Diagnostic) -> TranslateError {
        let place = self.configuration.settings.places.get(setting).cloned().unwrap_or_default();
        TranslateError::Refused(gather([(vec![error(place)], self.source())]))
    }

    /// The declarations of the configuration.
    pub fn declarations(&self) -> &Configuration {
        &self.configuration
    }

    fn source(&self) -> Source<'_> {
        Source { name: &self.name, text: &self.text }
    }

    fn declared_properties(&self) -> Vec<DeclaredProperty> {
        let properties = self.configuration.properties.iter();
        properties.map(|property| property.declared(&self.text)).collect()
    }
}

/// Result of a translation.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Translation {
    /// The C file, its header, the header of the basic actions, and on request the Rust bindings and the
    /// trace matrix.
    pub files: Vec<GeneratedFile>,
    /// Warnings by importance.
    pub warnings: Diagnostics,
    /// Cost of the agent: memory, call depth, calls of each action in a step.
    pub report: Report,
}

/// One generated file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct GeneratedFile {
    /// Its name as the configuration gives it, relative to the output folder, with an ending for a matrix; a fixed name if
    /// no setting names it.
    pub name: String,
    /// Its text.
    pub text: String,
    /// The setting that names it; empty if there is none.
    pub setting: &'static str,
}

/// Errors of a translation.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TranslateError {
    /// The configuration or the agent has errors, possibly followed by warnings.
    #[error("{0}")]
    Refused(Diagnostics),
    /// A proof would need arbitrary values of a type other than numbers and `bool`; or a random run, or tests, would have to
    /// create values of a type that only the environment can create.
    #[error(
        "cannot create arbitrary values of type `{name}`, which a proof or random run of this agent needs"
    )]
    Unprovable {
        /// The type.
        name: String,
    },
}

impl TranslateError {
    /// The errors and warnings; empty if the error has no place in a text.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Refused(found) => found,
            Self::Unprovable { .. } => &[],
        }
    }
}

/// Parses a configuration; `name` is its file's name for messages.
///
/// # Errors
/// [`TranslateError::Refused`] with all errors.
pub fn parse_configuration(name: &str, text: &str) -> Result<ParsedConfiguration, TranslateError> {
    let (configuration, diagnostics) = configuration::parse(text);
    if diagnostics.is_empty() {
        let (name, text) = (name.to_owned(), text.to_owned());
        return Ok(ParsedConfiguration { name, text, configuration });
    }
    Err(TranslateError::Refused(gather([(diagnostics, Source { name, text })])))
}

/// Translates the agent in `agent_text`, the content of the configuration's input file.
///
/// # Errors
/// [`TranslateError::Refused`] with all errors in both texts; if the agent's cannot be parsed, with those of its syntax and
/// of the Rust bindings. Nothing is produced then: the translator refuses what it cannot translate.
pub fn translate(
    configuration: &ParsedConfiguration,
    agent_text: &str,
) -> Result<Translation, TranslateError> {
    let wanted = configuration.configuration.settings.instance;
    let (program, warnings) = check(configuration, agent_text, wanted)?;
    let settings = &program.configuration.settings;
    let mut files = c_files(&program);
    if let Some(rust) = &settings.rust {
        let text = backend::rust::emit(&program, &settings.input);
        files.push(GeneratedFile { name: rust.text.clone(), text, setting: "rust" });
    }
    if let Some(name) = &settings.matrix {
        let matrix = backend::matrix::emit(&program, &settings.input, &files[0].text);
        for (ending, text) in [("csv", matrix.csv), ("json", matrix.json)] {
            files.push(GeneratedFile { name: format!("{name}.{ending}"), text, setting: "matrix" });
        }
    }
    Ok(Translation { files, warnings, report: Report::new(&program) })
}

/// The trace matrix of the agent's C, as it is translated: a row for each plan and requirement.
///
/// # Errors
/// As [`translate`].
pub fn trace_rows(
    configuration: &ParsedConfiguration,
    agent_text: &str,
) -> Result<Vec<TraceRow>, TranslateError> {
    let wanted = configuration.configuration.settings.instance;
    let (program, _) = check(configuration, agent_text, wanted)?;
    Ok(backend::matrix::rows(&program, &c_files(&program)[0].text))
}

/// Input of a model checker for proving an agent's properties on its C.
///
/// The agent is translated with its state passed in, whatever the configuration says, because a proof starts
/// in any state.
///
/// # Errors
/// As [`translate`], and [`TranslateError::Unprovable`] if the environment passes or returns strings, structs or values of
/// a type that the translator does not know.
pub fn obligations(
    configuration: &ParsedConfiguration,
    agent_text: &str,
) -> Result<Obligations, TranslateError> {
    let properties = configuration.declared_properties();
    // An agent that cannot be translated cannot be proved either.
    let wanted = configuration.configuration.settings.instance;
    let (mut program, _) = check(configuration, agent_text, wanted)?;
    if wanted != Instance::Context {
        program = check(configuration, agent_text, Instance::Context)?.0;
    }
    if let Some(name) = backend::c::unknown_type(&program) {
        return Err(TranslateError::Unprovable { name });
    }
    let harness = backend::c::harness(&program);
    let prefix = backend::c::symbol_prefix(&program);
    let mut files = c_files(&program);
    files.push(GeneratedFile { name: HARNESS.to_owned(), text: harness.source, setting: "" });
    Ok(Obligations {
        files,
        entry: format!("{prefix}next_step"),
        unwinding: backend::c::unwinding(&program),
        state_type: format!("{prefix}agent_t"),
        candidates: harness.candidates,
        fixed: harness.fixed,
        moments: harness.moments,
        properties,
    })
}

/// The comparison of the agent's C with a second, plain translation, for a model checker.
///
/// Values of types that only the environment knows are compared with `==`; if C cannot do that, the model checker
/// refuses the comparison.
///
/// # Errors
/// As [`translate`].
pub fn comparison(
    configuration: &ParsedConfiguration,
    agent_text: &str,
) -> Result<Comparison, TranslateError> {
    comparison_after(configuration, agent_text, &[])
}

/// As [`comparison()`], but executions of `main` have this beginning, if it has any acts; the other functions are of no use
/// then.
///
/// # Errors
/// As [`translate`].
pub fn comparison_after(
    configuration: &ParsedConfiguration,
    agent_text: &str,
    beginning: &[Act],
) -> Result<Comparison, TranslateError> {
    let wanted = configuration.configuration.settings.instance;
    let (program, _) = check(configuration, agent_text, wanted)?;
    let mut files = c_files(&program);
    let text = backend::c::comparison(&program, beginning);
    files.push(GeneratedFile { name: COMPARISON.to_owned(), text, setting: "" });
    Ok(Comparison {
        files,
        cases: backend::c::cases(&program),
        unwinding: backend::c::unwinding(&program),
        computes_floats: plain::calls_float_functions(&plain::functions(&program)),
    })
}

/// A program that makes random calls of the agent's C, as it is translated, and traces them.
///
/// # Errors
/// As [`translate`], and [`TranslateError::Unprovable`] if the environment passes or returns values of a type that only it
/// can create.
pub fn exercise(
    configuration: &ParsedConfiguration,
    agent_text: &str,
) -> Result<Exercise, TranslateError> {
    let wanted = configuration.configuration.settings.instance;
    let (program, _) = check(configuration, agent_text, wanted)?;
    if let Some(name) = backend::c::uncreatable_type(&program) {
        return Err(TranslateError::Unprovable { name });
    }
    let mut files = c_files(&program);
    let text = backend::c::exercise(&program, agent_text);
    files.push(GeneratedFile { name: EXERCISE.to_owned(), text, setting: "" });
    Ok(Exercise {
        files,
        interface: backend::c::interface_symbols(&program),
        environment: backend::c::environment_symbols(&program),
    })
}

/// A program that runs tests of the agent's C, as it is translated, and traces them.
///
/// The trace of a test is `# NUMBER`, each call in either direction with all values (floating-point numbers by their bits,
/// see [`traced`]), and at its end the answers of `can_add_event()` and of the counters.
///
/// # Errors
/// As [`exercise()`].
pub fn scripted(
    configuration: &ParsedConfiguration,
    agent_text: &str,
    tests: &[Vec<Act>],
) -> Result<Vec<GeneratedFile>, TranslateError> {
    let wanted = configuration.configuration.settings.instance;
    let (program, _) = check(configuration, agent_text, wanted)?;
    if let Some(name) = backend::c::uncreatable_type(&program) {
        return Err(TranslateError::Unprovable { name });
    }
    let mut files = c_files(&program);
    let text = backend::c::scripted(&program, tests);
    files.push(GeneratedFile { name: TESTS.to_owned(), text, setting: "" });
    Ok(files)
}

/// A model of the agent for SPIN, in which its properties can be checked for every environment.
///
/// # Errors
/// As [`translate`].
pub fn model(
    configuration: &ParsedConfiguration,
    agent_text: &str,
) -> Result<Model, TranslateError> {
    let properties = configuration.declared_properties();
    let wanted = configuration.configuration.settings.instance;
    let (program, _) = check(configuration, agent_text, wanted)?;
    Ok(Model::new(program, properties))
}

/// The C file, its header, and that of the basic actions.
fn c_files(program: &program::Program) -> Vec<GeneratedFile> {
    let settings = &program.configuration.settings;
    let c = backend::c::emit(program, &settings.input);
    vec![
        GeneratedFile { name: settings.output.clone(), text: c.source, setting: "output" },
        GeneratedFile { name: settings.header.clone(), text: c.header, setting: "header" },
        GeneratedFile { name: settings.basics.clone(), text: c.basics, setting: "basics" },
    ]
}

/// All findings in a configuration and its agent, those of [`translate`], by text and importance.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Findings {
    /// Those in the configuration.
    pub configuration: Vec<Diagnostic>,
    /// Those in the agent.
    pub agent: Vec<Diagnostic>,
}

/// Checks an agent without translating it.
pub fn findings(configuration: &ParsedConfiguration, agent: &Document) -> Findings {
    let instance = configuration.configuration.settings.instance;
    let errors = agent.errors();
    // Errors of the syntax come before all others.
    let agent_source = if errors.is_empty() { AGENT_SOURCE } else { 0 };
    let found = match check_tree(configuration, (agent.agent(), errors), agent.text(), instance) {
        Ok((_, found)) | Err(found) => found,
    };
    let (agent, configuration) =
        found.into_vec().into_iter().partition(|diagnostic| diagnostic.source == agent_source);
    Findings { configuration, agent }
}

/// Index of the agent among the sources of diagnostics, if it can be parsed.
const AGENT_SOURCE: usize = 1;

/// The checked program for a form of the C, and the warnings.
fn check(
    configuration: &ParsedConfiguration,
    agent_text: &str,
    instance: Instance,
) -> Result<(program::Program, Diagnostics), TranslateError> {
    let (agent, errors) = syntax::parse(agent_text);
    check_tree(configuration, (&agent, errors), agent_text, instance)
        .map_err(TranslateError::Refused)
}

/// The checked program of a syntax tree, and the warnings; or the errors.
fn check_tree(
    configuration: &ParsedConfiguration,
    (agent, diagnostics): (&Agent, Vec<Diagnostic>),
    agent_text: &str,
    instance: Instance,
) -> Result<(program::Program, Diagnostics), Diagnostics> {
    let ParsedConfiguration { name, text, configuration } = configuration;
    let input = configuration.settings.input.clone();
    let configuration_source = Source { name, text };
    let agent_source = Source { name: &input, text: agent_text };

    let boundary = check_rust_boundary(configuration);
    if diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
        // A text that cannot be parsed cannot be checked either.
        return Err(gather([(diagnostics, agent_source), (boundary, configuration_source)]));
    }
    let (program, mut findings) =
        analysis::analyse(configuration.clone(), instance, agent, agent_text);
    findings.configuration.extend(boundary);
    let found =
        gather([(findings.configuration, configuration_source), (findings.agent, agent_source)]);
    match program.filter(|_| !found.has_errors()) {
        Some(program) => Ok((program, found)),
        None => Err(found),
    }
}

/// The Rust bindings need the state passed in, and types that are known in Rust.
fn check_rust_boundary(configuration: &Configuration) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    let Some(rust) = &configuration.settings.rust else { return findings };
    if configuration.settings.instance != Instance::Context {
        findings.push(
            Code::RustBoundary
                .at("Rust bindings need the agent's state passed in", rust.span.clone())
                .help("add `instance = context;` to the settings"),
        );
    }
    check_rust_names(configuration, &mut findings);
    let mut check = |name: &str, kind: TypeKind, span: &Span| {
        if kind == TypeKind::Opaque {
            findings.push(
                Code::RustBoundary
                    .at(format!("type `{name}` has no Rust counterpart yet"), span.clone())
                    .help("pass its parts as numbers, or leave the setting `rust` out"),
            );
        }
    };
    for basic in &configuration.basics {
        for ctype in basic.parameters.iter().chain([&basic.result]) {
            check(&ctype.name, ctype.kind, &basic.span);
        }
        if basic.result.kind == TypeKind::Text {
            check(&basic.result.name, TypeKind::Opaque, &basic.span);
        }
    }
    for predicate in &configuration.predicates {
        for ctype in &predicate.parameters {
            check(&ctype.name, ctype.kind, &predicate.span);
        }
    }
    // A message declares its belief or goal, which is checked among those.
    findings
}

/// Names must not be Rust keywords, and must stay distinct in Rust.
fn check_rust_names(configuration: &Configuration, findings: &mut Vec<Diagnostic>) {
    let mut taken: HashSet<String> =
        HashSet::from(["Environment::update_beliefs", "Peer::ALL"].map(str::to_owned));
    let mut check =
        |owner: &str, name: String, source: &Name, known: bool| {
            let fresh = taken.insert(format!("{owner}::{name}"));
            if !fresh || known || is_rust_word(&name) {
                let message = format!("`{}` cannot be called `{name}` in Rust", source.text);
                findings.push(Code::ReservedName.at(message, source.span.clone()).help(
                    "it is a Rust keyword, or collides with another name in Rust; rename it",
                ));
            }
        };
    for basic in &configuration.basics {
        check("Environment", snake_case(&basic.name.text), &basic.name, false);
    }
    for name in &configuration.settables {
        check("Beliefs", format!("set_{}", snake_case(&name.text)), name, false);
    }
    for trigger in &configuration.triggerables {
        let name = program::trigger_name(trigger.operator, trigger.kind, &trigger.name.text);
        check("Agent", snake_case(&name), &trigger.name, false);
    }
    for (name, performative, message) in configuration.receiving() {
        check("Agent", snake_case(&name), &message.name, false);
        check("Message", variant(performative, &message.name.text), &message.name, false);
    }
    for action in configuration.sending() {
        check("Environment", snake_case(&action.name.text), &action.name, false);
    }
    for peer in &configuration.peers {
        check("Peer", camel_case(&peer.text), peer, false);
    }
    if let Some(first) = configuration.peers.first() {
        check("", "Peer".to_owned(), first, false);
    }
    if let Some(first) = configuration.messages.first() {
        for name in OWN_TYPES {
            check("", name.to_owned(), &first.name, false);
        }
    }
    for declared in &configuration.structs {
        const KNOWN: &str = "Agent Beliefs Environment State Loan Self Box Send Sync Copy Clone Debug PartialEq Default \
            Option Some None Result Ok Err Drop Fn FnMut FnOnce Sized Vec String";
        let name = camel_case(&declared.name.text);
        let known = KNOWN.split_ascii_whitespace().any(|word| word == name);
        check("", name, &declared.name, known);
        for (field, _) in &declared.fields {
            check(&declared.name.text, field.text.clone(), field, false);
        }
    }
}
