//! The section `properties`: requirements that must hold in every environment.

use diagnostic::Span;

use super::ExternalTrigger;
use super::parser::Parser;
use super::scanner::{Parsed, Scanner};
use crate::code::Code;
use crate::syntax::ast::{FOREIGN_RELATIONS, Name, Number, Relation};
use crate::syntax::lexer::foreign_relation;

/// A requirement that must hold in every environment and for any number of steps. `F` is the language of its formula, that of
/// one agent or of a system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Property<F = Formula> {
    /// Its name.
    pub name: Name,
    /// Tags of the requirements that it implements.
    pub requirements: Vec<String>,
    /// Its formula.
    pub formula: F,
    /// Where its formula is written.
    pub formula_span: Span,
    /// The whole declaration.
    pub span: Span,
}

/// A property as it is written in the configuration, as text.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct DeclaredProperty {
    /// Its name.
    pub name: String,
    /// Tags of the requirements that it implements.
    pub requirements: Vec<String>,
    /// Its formula, with single blanks between its words.
    pub formula: String,
}

/// Formula of a property of one agent. Wherever it names an action, it may name a class of actions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Formula {
    /// `exactly_one(a)`: a bound on the number of calls in each step.
    Count {
        /// The bound.
        bound: CallBound,
        /// The action whose calls are counted.
        action: Name,
    },
    /// `within(n, cause, a, b, unless +!g)`: after the cause one of the actions is called in one of the next `n` steps, unless
    /// one of the events is pending already or comes first. Of a comparison: in one of each `n` consecutive steps that begin
    /// while it holds.
    Within {
        /// Maximum number of steps, 1 to 1000.
        steps: u32,
        /// The cause.
        cause: Cause,
        /// The actions of which one is required.
        actions: Vec<Name>,
        /// Events that excuse the agent.
        unless: Vec<ExternalTrigger>,
    },
    /// `only_after(a, +!g, until b, c)`: the action is called only after the event was accepted, and not any more once one of
    /// the others was called while no such event was pending.
    OnlyAfter {
        /// The action.
        action: Name,
        /// The event that permits it.
        event: ExternalTrigger,
        /// Actions that end the permission.
        until: Vec<Name>,
    },
    /// `all_handled`: each event is handled completely by some plan, or by a failure plan.
    AllHandled,
}

impl Formula {
    /// The events that it names.
    pub(crate) fn events(&self) -> Vec<&ExternalTrigger> {
        match self {
            Self::Count { .. } | Self::AllHandled => Vec::new(),
            Self::Within { cause: Cause::Event(cause), unless, .. } => {
                std::iter::once(cause).chain(unless).collect()
            }
            Self::Within { unless, .. } => unless.iter().collect(),
            Self::OnlyAfter { event, .. } => vec![event],
        }
    }
}

/// Bound on the number of calls in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CallBound {
    /// `exactly_one`: one call.
    ExactlyOne,
    /// `at_most_one`: no call, or one.
    AtMostOne,
    /// `at_least_one`: one call or more.
    AtLeastOne,
    /// `never`: no call.
    Never,
}

/// What requires an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Cause {
    /// The environment has raised an event, or a peer has caused it, and it was accepted.
    Event(ExternalTrigger),
    /// The agent has called an action.
    Action(Name),
    /// A comparison holds at the start of a step.
    Comparison(Comparison),
}

/// Both sides are believed, and the values satisfy the relation: `battery <= landingBattery`, `blindFor >
/// 2000`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Comparison {
    /// A belief with one value.
    pub left: Name,
    /// The relation.
    pub relation: Relation,
    /// The right side.
    pub right: Operand,
}

/// Right side of a comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Operand {
    /// A belief with one value of the same type.
    Belief(Name),
    /// A number, of the type of the left side.
    Number(Number),
}

impl Comparison {
    /// The beliefs that are compared, one or two.
    pub fn beliefs(&self) -> impl Iterator<Item = &Name> {
        let right = match &self.right {
            Operand::Belief(name) => Some(name),
            Operand::Number(_) => None,
        };
        std::iter::once(&self.left).chain(right)
    }
}

const FORMULAS: &str = "`exactly_one`, `at_most_one`, `at_least_one`, `never`, `within`, `only_after` \
                        or `all_handled`";
/// Longer responses are pointless.
const MOST_STEPS: u32 = 1000;

impl Parser<'_> {
    /// `name [TAG, TAG]: formula;`, which is added to the properties.
    pub(super) fn property(&mut self) -> Parsed<()> {
        let head = self.scanner.property_head()?;
        let formula = self.formula()?;
        let property = self.scanner.property_end(head, formula)?;
        property.add_to(&mut self.configuration.properties)
    }

    fn formula(&mut self) -> Parsed<Formula> {
        let name = self.scanner.word(FORMULAS)?;
        let bound = match name.text.as_str() {
            "exactly_one" => CallBound::ExactlyOne,
            "at_most_one" => CallBound::AtMostOne,
            "at_least_one" => CallBound::AtLeastOne,
            "never" => CallBound::Never,
            "within" => return self.within(),
            "only_after" => return self.only_after(),
            "all_handled" => return Ok(Formula::AllHandled),
            other => {
                let message = format!("unknown formula `{other}`");
                return Err(Code::UnknownFormula
                    .at(message, name.span)
                    .help(format!("write {FORMULAS}")));
            }
        };
        self.scanner.expect("(")?;
        let action = self.scanner.word("an action or a class of actions")?;
        self.scanner.expect(")")?;
        Ok(Formula::Count { bound, action })
    }

    fn within(&mut self) -> Parsed<Formula> {
        self.scanner.expect("(")?;
        let steps = self.scanner.steps()?;
        self.scanner.expect(",")?;
        self.scanner.skip_blanks()?;
        let cause = if self.scanner.rest().starts_with(['+', '-']) {
            Cause::Event(self.event()?)
        } else {
            let name = self.scanner.word("an event, an action or a belief")?;
            match self.relation()? {
                Some(relation) => {
                    let right = self.operand()?;
                    Cause::Comparison(Comparison { left: name, relation, right })
                }
                None => Cause::Action(name),
            }
        };
        let (mut actions, mut unless) = (Vec::new(), Vec::new());
        self.scanner.expect(",")?;
        loop {
            let word = self.scanner.word("an action, a class of actions, or `unless`")?;
            self.scanner.skip_blanks()?;
            if word.text == "unless" {
                unless.push(self.event()?);
            } else {
                actions.push(word);
            }
            self.scanner.skip_blanks()?;
            if !self.scanner.take(",") {
                break;
            }
        }
        self.scanner.expect(")")?;
        if actions.is_empty() {
            return Err(self.scanner.unexpected("an action that must follow"));
        }
        Ok(Formula::Within { steps, cause, actions, unless })
    }

    /// `+!g`, which the environment raises, or `+!g[source(p)]`, which a peer causes.
    fn event(&mut self) -> Parsed<ExternalTrigger> {
        let mut event = self.scanner.trigger()?;
        if self.scanner.rest().trim_start().starts_with('[') {
            self.scanner.expect("[")?;
            let word = self.scanner.word("`source`")?;
            if word.text != "source" {
                let message = format!("expected `source`, found `{}`", word.text);
                return Err(Code::Syntax.at(message, word.span));
            }
            self.scanner.expect("(")?;
            event.source = Some(self.scanner.word("a peer")?);
            self.scanner.expect(")")?;
            self.scanner.expect("]")?;
            event.span.end = self.scanner.position;
        }
        Ok(event)
    }

    fn relation(&mut self) -> Parsed<Option<Relation>> {
        self.scanner.skip_blanks()?;
        let rest = self.scanner.rest();
        if let Some((found, meant)) =
            FOREIGN_RELATIONS.iter().find(|(found, _)| rest.starts_with(found))
        {
            return Err(foreign_relation(found, meant, self.scanner.position));
        }
        let known = [
            ("<=", Relation::LessOrEqual),
            (">=", Relation::GreaterOrEqual),
            ("==", Relation::Equal),
            ("\\==", Relation::NotEqual),
            ("<", Relation::Less),
            (">", Relation::Greater),
        ];
        let found = known.into_iter().find(|(symbol, _)| self.scanner.take(symbol));
        Ok(found.map(|(_, relation)| relation))
    }

    /// A belief, or a number such as `2000` or `-0.5`.
    fn operand(&mut self) -> Parsed<Operand> {
        self.scanner.skip_blanks()?;
        let start = self.scanner.position;
        let negative = self.scanner.take("-");
        let rest = self.scanner.rest();
        if !negative && !rest.starts_with(|c: char| c.is_ascii_digit()) {
            return Ok(Operand::Belief(self.scanner.word("a belief or a number")?));
        }
        let length = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let digits = rest[..length].to_owned();
        self.scanner.position += length;
        let span = start..self.scanner.position;
        let parts: Vec<&str> = digits.split('.').collect();
        if parts.len() > 2 || parts.iter().any(|part| part.is_empty()) {
            return Err(Code::MalformedNumber
                .at("malformed number", span)
                .help("numbers are decimal: `12`, `-0.5`"));
        }
        Ok(Operand::Number(Number { digits, negative, span }))
    }

    fn only_after(&mut self) -> Parsed<Formula> {
        self.scanner.expect("(")?;
        let action = self.scanner.word("an action or a class of actions")?;
        self.scanner.expect(",")?;
        self.scanner.skip_blanks()?;
        let event = self.event()?;
        self.scanner.skip_blanks()?;
        let mut until = Vec::new();
        while self.scanner.take(",") {
            let mut word = self.scanner.word("`until`, an action or a class of actions")?;
            if word.text == "until" && until.is_empty() {
                word = self.scanner.word("an action or a class of actions")?;
            }
            until.push(word);
            self.scanner.skip_blanks()?;
        }
        self.scanner.expect(")")?;
        Ok(Formula::OnlyAfter { action, event, until })
    }
}

/// The part of a property before its formula: `name [TAG, TAG]:`.
pub(crate) struct Head {
    start: usize,
    end: usize,
    /// The property's name.
    pub(crate) name: Name,
    requirements: Vec<String>,
}

impl<F> Property<F> {
    /// Adds it to the properties that are declared before; an error if one of them has its name.
    pub(crate) fn add_to(self, known: &mut Vec<Self>) -> Parsed<()> {
        if known.iter().any(|property| property.name.text == self.name.text) {
            let message = format!("a second property `{}`", self.name.text);
            return Err(Code::DeclaredTwice.at(message, self.name.span));
        }
        known.push(self);
        Ok(())
    }

    /// The property as it is written in `text`, the one that it was read from, without comments: in one line they would hide
    /// what follows.
    pub(crate) fn declared(&self, text: &str) -> DeclaredProperty {
        let text = text.get(..self.formula_span.end).unwrap_or_default();
        let mut scanner = Scanner { text, position: self.formula_span.start };
        let mut formula = String::new();
        loop {
            let from = scanner.position;
            // They were closed when the formula was read.
            _ = scanner.skip_blanks();
            if scanner.position > from {
                formula.push(' ');
            }
            let Some(next) = scanner.rest().chars().next() else { break };
            scanner.position += next.len_utf8();
            formula.push(next);
        }
        DeclaredProperty {
            name: self.name.text.clone(),
            requirements: self.requirements.clone(),
            formula: formula.split_whitespace().collect::<Vec<_>>().join(" "),
        }
    }
}

impl Scanner<'_> {
    /// Reads `name [TAG, TAG]:`.
    pub(crate) fn property_head(&mut self) -> Parsed<Head> {
        self.skip_blanks()?;
        let start = self.position;
        let name = self.word("a property's name")?;
        let requirements = self.requirements()?;
        self.expect(":")?;
        Ok(Head { start, end: self.position, name, requirements })
    }

    /// Reads the `;` behind a property's formula, and returns the whole property.
    pub(crate) fn property_end<F>(&mut self, head: Head, formula: F) -> Parsed<Property<F>> {
        let Head { start, end, name, requirements } = head;
        let (span, formula_span) = (start..self.position, end..self.position);
        self.expect(";")?;
        Ok(Property { name, requirements, formula, formula_span, span })
    }

    /// `[REQ-1, REQ-2]`, or empty.
    fn requirements(&mut self) -> Parsed<Vec<String>> {
        let mut tags = Vec::new();
        self.skip_blanks()?;
        if !self.take("[") {
            return Ok(tags);
        }
        loop {
            self.skip_blanks()?;
            let rest = self.rest();
            let ends = |c: char| !(c.is_ascii_alphanumeric() || "-_.".contains(c));
            let length = rest.find(ends).unwrap_or(rest.len());
            if length > 0 {
                tags.push(rest[..length].to_owned());
                self.position += length;
                self.skip_blanks()?;
                if self.take("]") {
                    return Ok(tags);
                }
                if self.take(",") {
                    continue;
                }
            }
            return Err(self.unexpected("requirement tags, such as `[SAF-1, SAF-2]`"));
        }
    }

    /// Reads a number of steps, 1 to 1000.
    pub(crate) fn steps(&mut self) -> Parsed<u32> {
        self.skip_blanks()?;
        let rest = self.rest();
        let length = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        let start = self.position;
        match rest[..length].parse() {
            Ok(steps @ 1..=MOST_STEPS) => {
                self.position += length;
                Ok(steps)
            }
            _ => Err(Code::MalformedNumber
                .at("not a number of steps", start..start + length.max(1))
                .help(format!("a whole number from 1 to {MOST_STEPS}"))),
        }
    }
}
