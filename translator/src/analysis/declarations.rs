//! What the configuration declares, by name.

use std::cell::Cell;
use std::collections::HashMap;

use diagnostic::{Diagnostic, Span, closest};

use super::constants::c_number;
use crate::configuration::{
    Basic, Cause, Comparison, Configuration, ExternalTrigger, Formula, Operand,
};
use crate::program::BasicId;
use crate::syntax::ast::{Atom, Name};
use crate::types::{CType, TypeKind};

/// C99 keywords and the `<stdbool.h>` names: no basic action can be called so.
const C_WORDS: [&str; 42] = [
    "auto",
    "break",
    "case",
    "char",
    "const",
    "continue",
    "default",
    "do",
    "double",
    "else",
    "enum",
    "extern",
    "float",
    "for",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "register",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "switch",
    "typedef",
    "union",
    "unsigned",
    "void",
    "volatile",
    "while",
    "_Bool",
    "_Complex",
    "_Imaginary",
    "bool",
    "true",
    "false",
    "main",
    "errno",
];

/// Names that the generated interface uses itself.
const INTERFACE: [&str; 12] = [
    "init",
    "next_step",
    "can_add_event",
    "take_event",
    "handle_event",
    "unhandled_events",
    "refused_events",
    "aborted_events",
    "clear",
    "forget_events",
    "updateBeliefs",
    "agent",
];

/// Prefixes of generated functions and variables.
const PREFIXES: [&str; 12] = [
    "achieve_", "add_", "del_", "set_", "run_", "plan", "equal_", "checked_", "post_", "defer_",
    "limit_", "var_",
];

/// Generated local variables; most of them are numbered.
const LOCALS: [&str; 13] = [
    "accepted",
    "answer",
    "answered",
    "argument",
    "changed",
    "current_time",
    "event",
    "handled",
    "holds",
    "outcome",
    "round",
    "slot",
    "value",
];

/// Whether generated C may use the name for something of its own.
fn is_generated(name: &str) -> bool {
    INTERFACE.contains(&name)
        || PREFIXES.iter().any(|prefix| name.starts_with(prefix))
        || LOCALS.contains(&name.trim_end_matches(|c: char| c.is_ascii_digit()))
}

#[derive(Debug, Clone)]
enum Declared {
    Basic(BasicId),
    Predicate(Vec<CType>),
}

#[derive(Debug)]
pub(super) struct Declarations {
    names: HashMap<String, Declaration>,
    basics: Vec<Basic>,
}

#[derive(Debug)]
struct Declaration {
    declared: Declared,
    span: Span,
    /// Whether anybody has asked for it.
    used: Cell<bool>,
}

impl Declarations {
    pub(super) fn new(configuration: &Configuration, findings: &mut Vec<Diagnostic>) -> Self {
        let mut declarations = Self { names: HashMap::new(), basics: configuration.basics.clone() };
        for (index, basic) in configuration.basics.iter().enumerate() {
            let name = &basic.name.text;
            if C_WORDS.contains(&name.as_str()) || name.starts_with('_') {
                findings.push(
                    Diagnostic::error(
                        format!("`{name}` cannot be the name of a C function"),
                        basic.name.span.clone(),
                    )
                    .help("C reserves this word; rename the basic action"),
                );
            } else if is_generated(name) {
                findings.push(
                    Diagnostic::error(
                        format!("`{name}` may clash with a generated function"),
                        basic.name.span.clone(),
                    )
                    .help(format!(
                        "generated names are {}, {} and those that start with {}",
                        INTERFACE.join(", "),
                        LOCALS.join(", "),
                        PREFIXES.join(", ")
                    )),
                );
            }
            declarations.declare(&basic.name, Declared::Basic(BasicId(index)), findings);
        }
        for (index, declared) in configuration.structs.iter().enumerate() {
            let name = &declared.name.text;
            let known = CType::named(name).kind != TypeKind::Opaque;
            let twice = configuration.structs[..index].iter().any(|s| s.name.text == *name);
            if known || twice || C_WORDS.contains(&name.as_str()) || name.starts_with('_') {
                findings.push(
                    Diagnostic::error(
                        format!("`{name}` cannot be the name of a struct"),
                        declared.name.span.clone(),
                    )
                    .help("another type has this name, or C reserves it"),
                );
            }
            for (field, _) in &declared.fields {
                if C_WORDS.contains(&field.text.as_str()) || field.text.starts_with('_') {
                    let message = format!("`{}` cannot be the name of a field", field.text);
                    findings.push(Diagnostic::error(message, field.span.clone()));
                }
            }
        }
        for (index, class) in configuration.classes.iter().enumerate() {
            if configuration.classes[..index].iter().any(|c| c.name.text == class.name.text) {
                let message = format!("a second class `{}`", class.name.text);
                findings.push(Diagnostic::error(message, class.name.span.clone()));
            }
            for action in class.actions.iter().filter(|action| !declarations.is_basic(&action.text))
            {
                findings.push(declarations.undeclared(action, "basics"));
            }
        }
        for predicate in &configuration.predicates {
            let declared = Declared::Predicate(predicate.parameters.clone());
            declarations.declare(&predicate.name, declared, findings);
        }
        declarations.check_properties(configuration, findings);
        declarations
    }

    /// Properties speak of actions, classes and events that there are.
    fn check_properties(&self, configuration: &Configuration, findings: &mut Vec<Diagnostic>) {
        let (mut actions, mut events) = (Vec::new(), Vec::new());
        for property in &configuration.properties {
            match &property.formula {
                Formula::AllHandled => {}
                Formula::Count { action, .. } => actions.push(action),
                Formula::Within { cause, actions: answers, unless, .. } => {
                    match cause {
                        Cause::Event(event) => events.push(event),
                        Cause::Action(action) => actions.push(action),
                        Cause::Comparison(comparison) => {
                            self.check_comparison(comparison, findings);
                        }
                    }
                    actions.extend(answers);
                    events.extend(unless);
                }
                Formula::OnlyAfter { action, event, until } => {
                    actions.push(action);
                    actions.extend(until);
                    events.push(event);
                }
            }
        }
        let is_class =
            |name: &str| configuration.classes.iter().any(|class| class.name.text == name);
        for action in actions {
            if !self.is_basic(&action.text) && !is_class(&action.text) {
                findings.push(self.undeclared(action, "basics"));
            }
        }
        for event in events {
            let same = |other: &&ExternalTrigger| {
                (other.operator, other.kind, &other.name.text)
                    == (event.operator, event.kind, &event.name.text)
            };
            if !configuration.triggerables.iter().any(|other| same(&other)) {
                findings.push(
                    Diagnostic::error("the environment does not raise this", event.span.clone())
                        .help("properties speak of events of the section `triggerables`"),
                );
            }
        }
    }

    /// What is compared are beliefs with one number of the same type, or numbers that fit it.
    fn check_comparison(&self, comparison: &Comparison, findings: &mut Vec<Diagnostic>) {
        let mut number = |name: &Name| {
            let Some(Declared::Predicate(types)) = self.find(&name.text) else {
                findings.push(self.undeclared(name, "types"));
                return None;
            };
            let number = types.first().filter(|ctype| types.len() == 1 && ctype.is_numeric());
            if number.is_none() {
                let message = format!("`{}` is no belief with one number", name.text);
                findings.push(
                    Diagnostic::error(message, name.span.clone())
                        .help("properties compare beliefs such as `battery(int64_t)`"),
                );
            }
            number.cloned()
        };
        let left = number(&comparison.left);
        match &comparison.right {
            Operand::Belief(belief) => {
                if let (Some(left), Some(right)) = (left, number(belief))
                    && left != right
                {
                    let message = format!("a `{}` is compared with a `{}`", left.name, right.name);
                    findings.push(Diagnostic::error(message, belief.span.clone()));
                }
            }
            Operand::Number(value) => {
                findings.extend(left.and_then(|left| c_number(value, &left).err()));
            }
        }
    }

    fn declare(&mut self, name: &Name, declared: Declared, findings: &mut Vec<Diagnostic>) {
        let declaration = Declaration { declared, span: name.span.clone(), used: Cell::new(false) };
        if self.names.insert(name.text.clone(), declaration).is_some() {
            findings.push(
                Diagnostic::error(format!("`{}` is declared twice", name.text), name.span.clone())
                    .help("a name is one basic action or one predicate"),
            );
        }
    }

    /// The types of a belief or goal as used in the agent.
    pub(super) fn predicate(&self, atom: &Atom) -> Result<Vec<CType>, Diagnostic> {
        match self.find(&atom.name.text) {
            Some(Declared::Predicate(types)) => {
                check_arity(atom, types.len())?;
                Ok(types.clone())
            }
            Some(Declared::Basic(_)) => Err(Diagnostic::error(
                format!("`{}` is a basic action, not a belief or goal", atom.name.text),
                atom.name.span.clone(),
            )
            .help("the section `types` declares beliefs and goals, `basics` actions")),
            None => Err(self.undeclared(&atom.name, "types")),
        }
    }

    /// The types of a belief or goal named in `settables` or `triggerables`.
    pub(super) fn external_predicate(
        &self,
        name: &Name,
        findings: &mut Vec<Diagnostic>,
    ) -> Option<Vec<CType>> {
        if let Some(Declared::Predicate(types)) = self.find(&name.text) {
            return Some(types.clone());
        }
        findings.push(self.undeclared(name, "types"));
        None
    }

    /// The basic action or function that `atom` calls.
    pub(super) fn basic(&self, atom: &Atom) -> Result<(BasicId, &Basic), Diagnostic> {
        match self.find(&atom.name.text) {
            Some(Declared::Basic(id)) => {
                let basic = &self.basics[id.0];
                check_arity(atom, basic.parameters.len())?;
                Ok((*id, basic))
            }
            Some(Declared::Predicate(_)) => Err(Diagnostic::error(
                format!("`{}` is a belief or goal, not a basic action", atom.name.text),
                atom.name.span.clone(),
            )
            .help("in a body write `!g` for a goal, `?b`, `+b` or `-b` for a belief")),
            None => Err(self.undeclared(&atom.name, "basics")),
        }
    }

    fn known(&self, name: &str) -> Option<&Declared> {
        self.names.get(name).map(|declaration| &declaration.declared)
    }

    /// What is declared by this name, from now on in use.
    fn find(&self, name: &str) -> Option<&Declared> {
        let declaration = self.names.get(name)?;
        declaration.used.set(true);
        Some(&declaration.declared)
    }

    /// Warns of what neither the agent nor the configuration uses; the settings name `functions`.
    pub(super) fn warn_unused(&self, functions: &[&str], findings: &mut Vec<Diagnostic>) {
        let mut unused: Vec<(&String, &Declaration)> = self
            .names
            .iter()
            .filter(|(name, declaration)| {
                !declaration.used.get() && !functions.contains(&name.as_str())
            })
            .collect();
        unused.sort_by_key(|(_, declaration)| declaration.span.start);
        findings.extend(unused.into_iter().map(|(name, declaration)| {
            let message = format!("`{name}` is declared and never used");
            Diagnostic::warning(message, declaration.span.clone())
                .help("take it out, or use it in the agent")
        }));
    }

    pub(super) fn is_basic(&self, name: &str) -> bool {
        matches!(self.known(name), Some(Declared::Basic(_)))
    }

    pub(super) fn is_predicate(&self, name: &str) -> bool {
        matches!(self.known(name), Some(Declared::Predicate(_)))
    }

    fn undeclared(&self, name: &Name, section: &str) -> Diagnostic {
        let help = match closest(&name.text, self.names.keys().map(String::as_str)) {
            Some(candidate) => format!("did you mean `{candidate}`?"),
            None => format!("declare it in the section `{section}` of the configuration"),
        };
        Diagnostic::error(format!("`{}` is not declared", name.text), name.span.clone()).help(help)
    }
}

/// Refuses results that cannot be used as a value.
pub(super) fn check_value_result(basic: &Basic, atom: &Atom) -> Result<(), Diagnostic> {
    if basic.result.kind == TypeKind::Void {
        return Err(Diagnostic::error(
            format!("`{}` returns no value", atom.name.text),
            atom.span.clone(),
        )
        .label("declared `void`"));
    }
    Ok(())
}

fn check_arity(atom: &Atom, expected: usize) -> Result<(), Diagnostic> {
    let found = atom.arguments.len();
    if found == expected {
        return Ok(());
    }
    Err(Diagnostic::error(
        format!("`{}` takes {expected} arguments, not {found}", atom.name.text),
        atom.span.clone(),
    ))
}
