//! How long ago a peer told something.

use super::evaluate::Substitution;
use super::messages::Said;
use super::{Environment, Interpreter, Value};
use crate::syntax::ast::{Arithmetic, Atom, Expression};
use crate::types::CType;

impl Interpreter {
    /// The clock, and the type of its times.
    pub(super) fn clock(&self) -> Option<(String, CType)> {
        let clock = self.configuration.settings.clock.as_ref()?;
        let mut basics = self.configuration.basics.iter();
        let basic = basics.find(|basic| basic.name.text == clock.text)?;
        Some((clock.text.clone(), basic.result.clone()))
    }

    /// Whether any context asks for the age of what this peer tells.
    pub(super) fn asks_age(&self, (belief, sender): &Said) -> bool {
        let asks = |atom: &Atom| {
            let named = match atom.source.as_deref() {
                Some(Expression::Atom(source)) => self.configuration.peer(&source.name.text),
                _ => None,
            };
            let asks = atom.age.as_deref();
            atom.name.text == *belief
                && asks.is_some_and(|age| !matches!(age, Expression::Unnamed(_)))
                && named.is_none_or(|named| named == *sender)
        };
        let contexts = self.agent.plans.iter().filter_map(|plan| plan.context.as_ref());
        contexts.into_iter().any(|context| any_belief(context, &asks))
    }

    /// Matches the age of what was told at this time; what may be anything is not looked at.
    pub(super) fn match_age(
        &self,
        wanted: &Expression,
        told_at: Option<&Value>,
        theta: &mut Substitution,
        environment: &mut dyn Environment,
    ) -> Option<()> {
        if matches!(wanted, Expression::Unnamed(_)) {
            return Some(());
        }
        let (clock, ctype) = self.clock()?;
        let now = environment.call(&clock, &[], &ctype)?;
        let age = Value::calculate(Arithmetic::Subtract, &now, told_at?, &ctype)?;
        self.match_pattern(wanted, &age, &ctype, theta, environment)
    }
}

/// Whether this is so of any belief of a context.
fn any_belief(context: &Expression, is_so: &impl Fn(&Atom) -> bool) -> bool {
    match context {
        Expression::And(parts) | Expression::Or(parts) => {
            parts.iter().any(|part| any_belief(part, is_so))
        }
        Expression::Not { operand, .. } => any_belief(operand, is_so),
        Expression::Atom(atom) => is_so(atom),
        _ => false,
    }
}
