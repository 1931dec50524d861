//! The declarations of the configuration, by name.

use std::cell::Cell;
use std::collections::{HashMap, HashSet};

use diagnostic::{Diagnostic, Span, closest};

use super::constants::c_number;
use crate::code::Code;
use crate::configuration::{
    Basic, Cause, Comparison, Configuration, ExternalTrigger, Formula, Instance, Operand,
};
use crate::program::BasicId;
use crate::reserved::{
    INTERFACE, VERBS, described, is_c, is_c_word, is_generated, is_generated_prefix, is_library,
    is_of_proofs,
};
use crate::syntax::ast::{Atom, Name};
use crate::types::{CType, TypeKind};

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
    /// Whether it is used.
    used: Cell<bool>,
}

impl Declarations {
    pub(super) fn new(
        configuration: &Configuration,
        instance: Instance,
        findings: &mut Vec<Diagnostic>,
    ) -> Self {
        let mut declarations = Self { names: HashMap::new(), basics: configuration.basics.clone() };
        for (index, basic) in configuration.basics.iter().enumerate() {
            findings
                .extend(check_basic_name(basic, &configuration.settings.symbol_prefix(instance)));
            declarations.declare(&basic.name, Declared::Basic(BasicId(index)), findings);
        }
        check_types(configuration, instance, findings);
        for (index, class) in configuration.classes.iter().enumerate() {
            if configuration.classes[..index].iter().any(|c| c.name.text == class.name.text) {
                let message = format!("a second class `{}`", class.name.text);
                findings.push(Code::DeclaredTwice.at(message, class.name.span.clone()));
            }
            if declarations.is_basic(&class.name.text) {
                let message = format!("`{}` is an action, not a class", class.name.text);
                findings.push(
                    Code::DeclaredTwice
                        .at(message, class.name.span.clone())
                        .help("properties could not distinguish them: rename the class"),
                );
            }
            // What another class has is judged there.
            if class.all_but.is_some() {
                continue;
            }
            for (index, action) in class.actions.iter().enumerate() {
                if class.actions[..index].iter().any(|other| other.text == action.text) {
                    let message =
                        format!("`{}` is in the class `{}` twice", action.text, class.name.text);
                    findings.push(
                        Code::DeclaredTwice
                            .at(message, action.span.clone())
                            .help("a call counts once for a class: remove one of them"),
                    );
                }
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

    /// Checks that properties refer to declared actions, classes and events.
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
        // Those of peers need plans and are checked with their messages.
        for event in events.into_iter().filter(|event| event.source.is_none()) {
            let same = |other: &&ExternalTrigger| {
                (other.operator, other.kind, &other.name.text)
                    == (event.operator, event.kind, &event.name.text)
            };
            if !configuration.triggerables.iter().any(|other| same(&other)) {
                findings.push(
                    Code::NotTriggerable
                        .at("the environment does not raise this", event.span.clone())
                        .help("properties refer to events of the section `triggerables`, or of one peer: `+!goal[source(peer)]`"),
                );
            }
        }
    }

    /// Checks that both sides are beliefs with one number of the same type, or numbers of that type.
    fn check_comparison(&self, comparison: &Comparison, findings: &mut Vec<Diagnostic>) {
        let mut number = |name: &Name| {
            let Some(Declared::Predicate(types)) = self.find(&name.text) else {
                findings.push(self.undeclared(name, "types"));
                return None;
            };
            let number = types.first().filter(|ctype| types.len() == 1 && ctype.is_numeric());
            if number.is_none() {
                let message = format!("`{}` is not a belief with one number", name.text);
                findings.push(
                    Code::NotComparable
                        .at(message, name.span.clone())
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
                    findings.push(Code::WrongType.at(message, belief.span.clone()));
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
                Code::DeclaredTwice
                    .at(format!("`{}` is declared twice", name.text), name.span.clone())
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
            Some(Declared::Basic(_)) => Err(Code::WrongKind
                .at(
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
            Some(Declared::Predicate(_)) => Err(Code::WrongKind
                .at(
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

    /// The declaration of this name, which is marked as used.
    fn find(&self, name: &str) -> Option<&Declared> {
        let declaration = self.names.get(name)?;
        declaration.used.set(true);
        Some(&declaration.declared)
    }

    /// Warns of declarations that neither the agent nor the configuration uses; the settings name
    /// `functions`.
    pub(super) fn warn_unused(&self, functions: &[&str], findings: &mut Vec<Diagnostic>) {
        let mut unused: Vec<(&String, &Declaration)> = self
            .names
            .iter()
            .filter(|(name, declaration)| {
                !declaration.used.get() && !functions.contains(&name.as_str())
            })
            .collect();
        unused.sort_by_key(|(_, declaration)| declaration.span.start);
        let (basics, others): (Vec<_>, Vec<_>) =
            unused.into_iter().partition(|(_, d)| matches!(d.declared, Declared::Basic(_)));
        let warning =
            |message: String, span: &Span| Code::UnusedDeclaration.at(message, span.clone());
        let single = |(name, declaration): &(&String, &Declaration)| {
            warning(format!("`{name}` is declared and never used"), &declaration.span)
                .help("remove it, or use it in the agent")
        };
        if let [(_, first), _, _, _, ..] = basics.as_slice() {
            // Unused basics are allowed, because a library of actions serves several agents.
            let names: Vec<&str> = basics.iter().map(|(name, _)| name.as_str()).collect();
            let message = format!("{} actions and functions are never used", names.len());
            findings
                .push(warning(message, &first.span).help(format!("these: {}", names.join(", "))));
        } else {
            findings.extend(basics.iter().map(single));
        }
        findings.extend(others.iter().map(single));
    }

    /// Whether nothing has this name.
    pub(super) fn is_free(&self, name: &str) -> bool {
        self.known(name).is_none()
    }

    /// The action of this name, whatever its arguments.
    pub(super) fn basic_named(&self, name: &Name) -> Result<BasicId, Diagnostic> {
        match self.find(&name.text) {
            Some(Declared::Basic(id)) => Ok(*id),
            _ => Err(self.undeclared(name, "basics")),
        }
    }

    pub(super) fn is_basic(&self, name: &str) -> bool {
        matches!(self.known(name), Some(Declared::Basic(_)))
    }

    pub(super) fn is_predicate(&self, name: &str) -> bool {
        matches!(self.known(name), Some(Declared::Predicate(_)))
    }

    /// A name that is not what it has to be, a name of this section.
    fn undeclared(&self, name: &Name, section: &str) -> Diagnostic {
        let wrong_kind = |is: &str, wanted: &str| {
            Code::WrongKind
                .at(format!("`{}` is {is}, not {wanted}", name.text), name.span.clone())
                .help(format!("the section `{section}` declares them"))
        };
        match self.known(&name.text) {
            Some(Declared::Basic(_)) => {
                return wrong_kind("a basic action or function", "a belief or goal");
            }
            Some(Declared::Predicate(_)) => {
                return wrong_kind("a belief or goal", "an action or a class of actions");
            }
            None => {}
        }
        let help = match closest(&name.text, self.names.keys().map(String::as_str)) {
            Some(candidate) => format!("did you mean `{candidate}`?"),
            None => format!("declare it in the section `{section}` of the configuration"),
        };
        Code::NotDeclared
            .at(format!("`{}` is not declared", name.text), name.span.clone())
            .help(help)
    }
}

/// What is named in the place of a peer is none.
pub(super) fn not_a_peer(what: &str, span: Span) -> Diagnostic {
    Code::NotDeclared
        .at(format!("{what} is not a peer"), span)
        .help("write a variable, `self`, or a name of the section `peers`")
}

/// A basic action is a C function, so its name must be unique.
fn check_basic_name(basic: &Basic, prefix: &str) -> Option<Diagnostic> {
    let name = &basic.name.text;
    let symbol = format!("{prefix}{name}");
    if is_c_word(name) || is_c(&symbol) {
        let message = format!("`{name}` cannot be the name of a C function");
        return Some(
            Code::ReservedName
                .at(message, basic.name.span.clone())
                .help("C reserves this word; rename the basic action"),
        );
    }
    (is_generated(name) || is_generated(&symbol)).then(|| {
        let message = format!("`{name}` may clash with a generated function");
        Code::ReservedName.at(message, basic.name.span.clone()).help(described())
    })
}

/// Types must not have names of functions or of generated C.
fn check_types(configuration: &Configuration, instance: Instance, findings: &mut Vec<Diagnostic>) {
    let settings = &configuration.settings;
    let prefix = settings.symbol_prefix(instance);
    if is_generated_prefix(&prefix) && !prefix.is_empty() {
        let place = settings.places.get("output").cloned().unwrap_or_default();
        let message = format!("names that begin with `{prefix}` may clash with generated ones");
        findings.push(
            Code::ReservedName
                .at(message, place)
                .help("with `instance = context` the file's name begins all names; choose another"),
        );
    }
    let mut symbols: HashSet<String> =
        configuration.basics.iter().map(|basic| format!("{prefix}{}", basic.name.text)).collect();
    symbols.extend(INTERFACE.iter().map(|name| format!("{prefix}{name}")));
    for predicate in &configuration.predicates {
        symbols.extend(VERBS.iter().map(|verb| format!("{prefix}{verb}_{}", predicate.name.text)));
    }
    let own = |name: &str| {
        let unprefixed = name.strip_prefix(prefix.as_str()).unwrap_or(name);
        let upper = prefix.to_uppercase();
        let constant = name.strip_prefix(upper.as_str()).unwrap_or(name);
        is_generated(name)
            || is_of_proofs(name)
            || ["agent_t", "event_t"].contains(&unprefixed)
            || constant.starts_with("EVENT_")
            || symbols.contains(name)
    };
    for (index, declared) in configuration.structs.iter().enumerate() {
        let name = &declared.name.text;
        let known = CType::named(name).kind != TypeKind::Opaque;
        let twice = configuration.structs[..index].iter().any(|s| s.name.text == *name);
        if known || twice || is_c(name) || own(name) {
            findings.push(
                Code::ReservedName
                    .at(
                        format!("`{name}` cannot be the name of a struct"),
                        declared.name.span.clone(),
                    )
                    .help(
                        "another type or a function has this name, or C or generated C reserves it",
                    ),
            );
        }
        for (field, _) in &declared.fields {
            if is_c_word(&field.text) || field.text.starts_with("ASL2C_") {
                let message = format!("`{}` cannot be the name of a field", field.text);
                findings.push(Code::ReservedName.at(message, field.span.clone()));
            }
        }
    }
    let in_basics = configuration.basics.iter().flat_map(|basic| {
        basic.parameters.iter().chain([&basic.result]).map(move |ctype| (ctype, &basic.span))
    });
    let in_types = configuration
        .predicates
        .iter()
        .flat_map(|declared| declared.parameters.iter().map(move |ctype| (ctype, &declared.span)));
    let mut reported: HashSet<&str> = HashSet::new();
    for (ctype, span) in
        in_basics.chain(in_types).filter(|(ctype, _)| ctype.kind == TypeKind::Opaque)
    {
        let clash = ctype.name.split(' ').any(|word| own(word) || is_library(word));
        if clash && reported.insert(&ctype.name) {
            let message = format!("the type `{}` may clash with a generated name", ctype.name);
            findings.push(Code::ReservedName.at(message, span.clone()).help(described()));
        }
    }
}

/// Refuses results that cannot be used as a value.
pub(super) fn check_value_result(basic: &Basic, atom: &Atom) -> Result<(), Diagnostic> {
    if basic.result.kind == TypeKind::Void {
        return Err(Code::NoValue
            .at(format!("`{}` returns no value", atom.name.text), atom.span.clone())
            .label("declared `void`"));
    }
    Ok(())
}

fn check_arity(atom: &Atom, expected: usize) -> Result<(), Diagnostic> {
    let found = atom.arguments.len();
    if found == expected {
        return Ok(());
    }
    Err(Code::ArgumentCount.at(
        format!("`{}` takes {expected} arguments, not {found}", atom.name.text),
        atom.span.clone(),
    ))
}
