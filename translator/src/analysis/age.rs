//! The age of what peers tell: `b(X)[source(P), age(A)]`.

use diagnostic::Diagnostic;

use super::Analysis;
use super::scope::Scope;
use super::values::Resolved;
use crate::code::Code;
use crate::program::{BeliefId, Call, Condition, Operation, Value};
use crate::syntax::ast::{Arithmetic, Atom, Expression, Relation};

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
        let condition = match age {
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
        };
        self.timed.insert(belief);
        Ok(Some(condition))
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
