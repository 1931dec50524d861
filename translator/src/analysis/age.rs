//! The age of what peers tell: `b(X)[source(P), age(A)]`.

use diagnostic::Diagnostic;

use super::Analysis;
use super::scope::Scope;
use super::values::Resolved;
use crate::code::Code;
use crate::program::{BeliefId, Call, Condition, Operation, Value};
use crate::syntax::ast::{Arithmetic, Atom, Expression, Performative, Relation};

impl Analysis<'_> {
    /// Checks that a peer tells a belief, and that there is a clock, if its age is asked for.
    pub(super) fn check_age(&self, atom: &Atom) -> Resolved<()> {
        let Some(age) = &atom.age else { return Ok(()) };
        if self.clock.is_none() {
            return Err(Code::NoAge.at("the agent has no clock", age.span()).help(
                "declare `uint64_t now(void);` in `basics` and write `clock = now;` in `settings`",
            ));
        }
        match atom.source.as_deref() {
            Some(Expression::Atom(source)) if source.name.text == "self" => Err(Code::NoAge
                .at("what is one's own has no age", age.span())
                .help("the time is kept only of what peers tell")),
            _ => Ok(()),
        }
    }

    /// The time is kept of what any of the peers tells that the text allows as a source, also where what is known of a
    /// variable leaves fewer: when the clock is called can be read off the text.
    pub(super) fn keep_times(&mut self, atom: &Atom) {
        if atom.age.as_deref().is_none_or(|age| matches!(age, Expression::Unnamed(_))) {
            return;
        }
        let named = match atom.source.as_deref() {
            Some(Expression::Atom(source)) => self.configuration.peer(&source.name.text),
            _ => None,
        };
        let name = &atom.name.text;
        let message = self.configuration.message(Performative::Tell, name);
        let senders = message.into_iter().flat_map(|message| &message.senders);
        let senders = senders.filter(|sender| named.is_none_or(|named| named == **sender));
        self.timed.extend(senders.map(|sender| (name.clone(), *sender)));
    }

    /// The condition that a belief that a peer tells has this age; what may be anything is no condition.
    pub(super) fn aged(
        &mut self,
        belief: BeliefId,
        age: &Expression,
        scope: &mut Scope,
    ) -> Resolved<Option<Condition>> {
        let Some(clock) = &self.clock else { return Ok(None) };
        let ctype = clock.ctype().clone();
        let elapsed = Value::Arithmetic(Box::new(Operation {
            operator: Arithmetic::Subtract,
            left: Value::Call(Call { basic: clock.function(), arguments: Vec::new() }),
            right: Value::ToldAt(belief),
            ctype: ctype.clone(),
        }));
        Ok(Some(match age {
            Expression::Unnamed(_) => return Ok(None),
            Expression::Variable(name) if scope.lookup(&name.text).is_none() => {
                Condition::Bind { variable: scope.bind(name, &ctype), value: elapsed }
            }
            wanted => Condition::Compare {
                relation: Relation::Equal,
                right: self.value(wanted, &ctype, scope)?,
                left: elapsed,
                ctype,
            },
        }))
    }
}

/// Refuses the age of an event.
pub(super) fn no_age_of_events(atom: &Atom) -> Option<Diagnostic> {
    let age = atom.age.as_ref()?;
    let belief = &atom.name.text;
    Some(Code::NoAge.at("an event has no age", age.span()).help(format!(
        "ask for it in the context: `+{belief}(..)[source(P)] : {belief}(..)[source(P), age(A)]`"
    )))
}
