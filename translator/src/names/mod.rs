//! The names in an agent and its configuration: where they are declared and used, and what they mean. For editors.

mod description;
mod reach;
mod variables;

use diagnostic::Span;

pub use description::describe;
pub use variables::variable_types;

use crate::configuration::{AllBut, Cause, Configuration, Formula as Promised};
use crate::syntax::Document;
use crate::syntax::ast::{
    Agent, Atom, Expression, Formula, Name, Operator, Plan, Trigger, TriggerKind,
};

/// What kind of thing a name stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// A belief, a goal, an action, a function or a peer: one declaration for each name.
    Declared,
    /// A class of actions.
    Class,
    /// A property.
    Property,
    /// A plan's label.
    Label,
    /// A variable of a plan.
    Variable,
}

/// How a name is used at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Usage {
    /// It is declared here: in the configuration, or as a label.
    Declaration,
    /// In another section of the configuration.
    Listed,
    /// `b(1).`
    InitialBelief,
    /// Trigger of a plan.
    Trigger(Operator, TriggerKind),
    /// `!g`, `!!g`
    Goal,
    /// `?b`
    Question,
    /// `+b`, `-b`
    Change(Operator),
    /// `a(1)` in a body.
    Action,
    /// A belief or function in a context, a function in a value, what a message is about, a peer, or a variable.
    Value,
}

/// A name at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Occurrence<'a> {
    /// The name with its place.
    pub name: &'a Name,
    /// Its meaning.
    pub meaning: Meaning,
    /// Its use.
    pub usage: Usage,
}

/// The name under a cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found<'a> {
    /// The name.
    pub text: &'a str,
    /// Its place.
    pub span: Span,
    /// Its meaning.
    pub meaning: Meaning,
    /// Its use, if the text around it can be parsed.
    pub usage: Option<Usage>,
    /// The plan around it; variables have a meaning only there.
    pub plan: Option<&'a Plan>,
}

impl<'a> Found<'a> {
    fn of(occurrence: Occurrence<'a>, plan: Option<&'a Plan>) -> Self {
        let Occurrence { name, meaning, usage } = occurrence;
        Self { text: &name.text, span: name.span.clone(), meaning, usage: Some(usage), plan }
    }
}

/// All names of an agent, in the order of beliefs, goal and plans.
pub fn in_agent<'a>(agent: &'a Agent, visit: &mut impl FnMut(Occurrence<'a>)) {
    for belief in &agent.beliefs {
        in_atom(belief, Usage::InitialBelief, visit);
    }
    if let Some(goal) = &agent.goal {
        in_atom(goal, Usage::Goal, visit);
    }
    for plan in &agent.plans {
        in_plan(plan, visit);
    }
}

/// All names of a plan, in the order of the text.
pub fn in_plan<'a>(plan: &'a Plan, visit: &mut impl FnMut(Occurrence<'a>)) {
    if let Some(name) = &plan.label {
        visit(Occurrence { name, meaning: Meaning::Label, usage: Usage::Declaration });
    }
    let Trigger { operator, kind, atom, .. } = &plan.trigger;
    in_atom(atom, Usage::Trigger(*operator, *kind), visit);
    if let Some(context) = &plan.context {
        in_expression(context, visit);
    }
    for formula in &plan.body {
        match formula {
            Formula::Action(atom) => in_atom(atom, Usage::Action, visit),
            Formula::Add(atom) => in_atom(atom, Usage::Change(Operator::Add), visit),
            Formula::Delete(atom) => in_atom(atom, Usage::Change(Operator::Delete), visit),
            Formula::Defer(atom) => in_atom(atom, Usage::Goal, visit),
            Formula::Test(atom) => in_atom(atom, Usage::Question, visit),
            Formula::Achieve { goal, deadline } => {
                in_atom(goal, Usage::Goal, visit);
                if let Some(deadline) = deadline {
                    in_expression(deadline, visit);
                }
            }
            Formula::Assign { variable, value } => {
                in_variable(variable, visit);
                in_expression(value, visit);
            }
            Formula::Wait { duration, .. } => in_expression(duration, visit),
            Formula::MyName { variable, .. } => in_variable(variable, visit),
            Formula::Send { to, content, .. } => {
                if let Some(to) = to {
                    in_expression(to, visit);
                }
                in_atom(content, Usage::Value, visit);
            }
        }
    }
}

fn in_atom<'a>(atom: &'a Atom, usage: Usage, visit: &mut impl FnMut(Occurrence<'a>)) {
    visit(Occurrence { name: &atom.name, meaning: Meaning::Declared, usage });
    atom.arguments.iter().for_each(|argument| in_expression(argument, visit));
    let annotations = atom.source.iter().chain(&atom.age);
    annotations.for_each(|annotation| in_expression(annotation, visit));
}

fn in_variable<'a>(name: &'a Name, visit: &mut impl FnMut(Occurrence<'a>)) {
    visit(Occurrence { name, meaning: Meaning::Variable, usage: Usage::Value });
}

/// The parser bounds the depth of expressions.
fn in_expression<'a>(expression: &'a Expression, visit: &mut impl FnMut(Occurrence<'a>)) {
    match expression {
        Expression::Variable(name) => in_variable(name, visit),
        Expression::Atom(atom) => in_atom(atom, Usage::Value, visit),
        Expression::Negate { operand, .. }
        | Expression::Not { operand, .. }
        | Expression::MyName { name: operand, .. } => {
            in_expression(operand, visit);
        }
        Expression::Arithmetic { left, right, .. } | Expression::Compare { left, right, .. } => {
            in_expression(left, visit);
            in_expression(right, visit);
        }
        Expression::Bind { variable, value, .. } => {
            in_variable(variable, visit);
            in_expression(value, visit);
        }
        Expression::And(parts) | Expression::Or(parts) => {
            for part in parts {
                in_expression(part, visit);
            }
        }
        Expression::Unnamed(_)
        | Expression::Number(_)
        | Expression::Boolean { .. }
        | Expression::Text { .. } => {}
    }
}

/// All names of a configuration, by section.
pub fn in_configuration<'a>(
    configuration: &'a Configuration,
    visit: &mut impl FnMut(Occurrence<'a>),
) {
    let counted = |name: &Name| {
        let is_class = configuration.classes.iter().any(|class| class.name.text == name.text);
        if is_class { Meaning::Class } else { Meaning::Declared }
    };
    let mut at = |name, meaning, usage| visit(Occurrence { name, meaning, usage });
    if let Some(name) = &configuration.settings.clock {
        at(name, Meaning::Declared, Usage::Listed);
    }
    for basic in &configuration.basics {
        at(&basic.name, Meaning::Declared, Usage::Declaration);
    }
    for declared in &configuration.classes {
        at(&declared.name, Meaning::Class, Usage::Declaration);
        let written = match &declared.all_but {
            Some(AllBut { class, but }) => std::iter::once(class).chain(but).collect::<Vec<_>>(),
            None => declared.actions.iter().collect(),
        };
        for name in written {
            at(name, counted(name), Usage::Listed);
        }
    }
    for peer in &configuration.peers {
        at(peer, Meaning::Declared, Usage::Declaration);
    }
    for predicate in &configuration.predicates {
        at(&predicate.name, Meaning::Declared, Usage::Declaration);
    }
    for message in &configuration.messages {
        let mut predicates = configuration.predicates.iter();
        // It may be where the belief or goal is declared.
        if predicates.all(|predicate| predicate.name.span != message.name.span) {
            at(&message.name, Meaning::Declared, Usage::Listed);
        }
        for name in &message.named {
            at(name, Meaning::Declared, Usage::Listed);
        }
    }
    for name in configuration.settables.iter().chain(&configuration.perceived) {
        at(name, Meaning::Declared, Usage::Listed);
    }
    for trigger in configuration.triggerables.iter().chain(&configuration.preemptive) {
        at(&trigger.name, Meaning::Declared, Usage::Listed);
    }
    for property in &configuration.properties {
        at(&property.name, Meaning::Property, Usage::Declaration);
        for name in promised(&property.formula) {
            at(name, counted(name), Usage::Listed);
        }
        let events = property.formula.events().into_iter();
        for peer in events.filter_map(|event| event.source.as_ref()) {
            at(peer, Meaning::Declared, Usage::Listed);
        }
    }
}

/// The names in a property's formula.
fn promised(formula: &Promised) -> Vec<&Name> {
    match formula {
        Promised::AllHandled => Vec::new(),
        Promised::Count { action, .. } => vec![action],
        Promised::Within { cause, actions, unless, .. } => {
            let cause: Vec<&Name> = match cause {
                Cause::Event(event) => vec![&event.name],
                Cause::Action(action) => vec![action],
                Cause::Comparison(comparison) => comparison.beliefs().collect(),
            };
            cause.into_iter().chain(actions).chain(unless.iter().map(|event| &event.name)).collect()
        }
        Promised::OnlyAfter { action, event, until } => {
            [action, &event.name].into_iter().chain(until).collect()
        }
    }
}

/// The name under a cursor in an agent, or directly before it.
pub fn at_agent(document: &Document, offset: usize) -> Option<Found<'_>> {
    let agent = document.agent();
    if document.is_unknown(offset) {
        return word_at(document.text(), offset);
    }
    let mut found = None;
    let look = |occurrence: Occurrence<'_>| touches(&occurrence.name.span, offset);
    let index = agent.plans.partition_point(|plan| plan.span.end < offset);
    if let Some(plan) = agent.plans.get(index) {
        in_plan(plan, &mut |occurrence| {
            if look(occurrence) {
                found = Some(Found::of(occurrence, Some(plan)));
            }
        });
    }
    let goal = agent.goal.iter().map(|goal| (goal, Usage::Goal));
    let beliefs = agent.beliefs.iter().map(|belief| (belief, Usage::InitialBelief));
    for (atom, usage) in beliefs.chain(goal).filter(|(atom, _)| touches(&atom.span, offset)) {
        in_atom(atom, usage, &mut |occurrence| {
            if look(occurrence) {
                found = Some(Found::of(occurrence, None));
            }
        });
    }
    found
}

/// The name under a cursor in a configuration, or directly before it.
pub fn at_configuration(configuration: &Configuration, offset: usize) -> Option<Found<'_>> {
    let mut found = None;
    in_configuration(configuration, &mut |occurrence| {
        if touches(&occurrence.name.span, offset) {
            found = Some(Found::of(occurrence, None));
        }
    });
    found
}

fn touches(span: &Span, offset: usize) -> bool {
    (span.start..=span.end).contains(&offset)
}

/// The word under a cursor in a text that cannot be parsed.
fn word_at(text: &str, offset: usize) -> Option<Found<'_>> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let (before, behind) = text.split_at_checked(offset)?;
    let start = before.rfind(|c| !is_word(c)).map_or(0, |at| at + 1);
    // What stands before a word may be a longer character.
    let start = text.ceil_char_boundary(start);
    let end = offset + behind.find(|c| !is_word(c)).unwrap_or(behind.len());
    let word = text.get(start..end)?;
    let declared = word.starts_with(|c: char| c.is_ascii_lowercase());
    declared.then_some(Found {
        text: word,
        span: start..end,
        meaning: Meaning::Declared,
        usage: None,
        plan: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROVER: [&str; 2] =
        [include_str!("../../agents/rover.conf"), include_str!("../../agents/rover.asl")];

    #[test]
    fn every_name_of_a_text_is_at_its_place() {
        let (configuration, _) = crate::configuration::parse(ROVER[0]);
        let document = Document::new(ROVER[1].to_owned());
        let mut seen = 0;
        let mut check = |text: &str, occurrence: Occurrence<'_>| {
            assert_eq!(&text[occurrence.name.span.clone()], occurrence.name.text);
            seen += 1;
        };
        in_agent(document.agent(), &mut |occurrence| check(ROVER[1], occurrence));
        in_configuration(&configuration, &mut |occurrence| check(ROVER[0], occurrence));
        assert_eq!(seen, 185);
    }

    #[test]
    fn the_name_under_the_cursor_is_found_in_any_text() {
        let text =
            "level(1).\n!go.\n@start +!go : level(X) & X > 1 <- on(X); -level(_).\n+!é <- halt";
        let document = Document::new(text.to_owned());
        let found = |word: &str, nth: usize| {
            let (offset, _) = text.match_indices(word).nth(nth).unwrap();
            let found = at_agent(&document, offset + word.len())?;
            assert_eq!(found.text, word);
            Some((found.meaning, found.usage))
        };
        let declared = |usage| Some((Meaning::Declared, Some(usage)));
        assert_eq!(found("level", 0), declared(Usage::InitialBelief));
        assert_eq!(found("go", 0), declared(Usage::Goal));
        assert_eq!(found("go", 1), declared(Usage::Trigger(Operator::Add, TriggerKind::Achieve)));
        assert_eq!(found("start", 0), Some((Meaning::Label, Some(Usage::Declaration))));
        assert_eq!(found("level", 1), declared(Usage::Value));
        assert_eq!(found("X", 1), Some((Meaning::Variable, Some(Usage::Value))));
        assert_eq!(found("on", 0), declared(Usage::Action));
        assert_eq!(found("level", 2), declared(Usage::Change(Operator::Delete)));
        assert_eq!(found("halt", 0), Some((Meaning::Declared, None)));
        assert_eq!(at_agent(&document, 9), None);
        assert_eq!(at_agent(&document, 9999), None);
    }
}
