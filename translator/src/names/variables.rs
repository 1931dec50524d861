//! The types of a plan's variables, as far as they follow from declarations.

use std::collections::HashMap;

use crate::configuration::Configuration;
use crate::syntax::ast::{Atom, Expression, Formula, Plan};
use crate::types::CType;

/// The type of each variable, from its first use as an argument or from the value that it is bound to; not of those that
/// only `.my_name`, a source or an age binds. Unlike the analysis this also works in plans with errors.
pub fn variable_types<'a>(
    configuration: &'a Configuration,
    plan: &'a Plan,
) -> HashMap<&'a str, &'a CType> {
    let mut types = Types { configuration, known: HashMap::new() };
    types.atom(&plan.trigger.atom);
    plan.context.iter().for_each(|context| types.expression(context));
    for formula in &plan.body {
        match formula {
            Formula::Action(atom)
            | Formula::Add(atom)
            | Formula::Delete(atom)
            | Formula::Defer(atom)
            | Formula::Test(atom)
            | Formula::Send { content: atom, .. } => types.atom(atom),
            Formula::MyName { .. } => {}
            Formula::Achieve { goal, .. } => types.atom(goal),
            Formula::Assign { variable, value } => types.bind(&variable.text, value),
            Formula::Wait { duration, .. } => types.expression(duration),
        }
    }
    types.known
}

struct Types<'a> {
    configuration: &'a Configuration,
    known: HashMap<&'a str, &'a CType>,
}

impl<'a> Types<'a> {
    fn atom(&mut self, atom: &'a Atom) {
        let Configuration { basics, predicates, .. } = self.configuration;
        let predicate = predicates.iter().find(|declared| declared.name.text == atom.name.text);
        let basic = || basics.iter().find(|declared| declared.name.text == atom.name.text);
        let parameters = match predicate {
            Some(predicate) => predicate.parameters.as_slice(),
            None => basic().map_or(&[][..], |basic| &basic.parameters),
        };
        for (argument, ctype) in atom.arguments.iter().zip(parameters) {
            match argument {
                Expression::Variable(name) => _ = self.known.entry(&name.text).or_insert(ctype),
                other => self.expression(other),
            }
        }
    }

    fn bind(&mut self, name: &'a str, value: &'a Expression) {
        self.expression(value);
        if let Some(ctype) = self.of(value) {
            self.known.entry(name).or_insert(ctype);
        }
    }

    fn of(&self, value: &'a Expression) -> Option<&'a CType> {
        if let Expression::Atom(atom) = value {
            let mut basics = self.configuration.basics.iter();
            return basics.find(|b| b.name.text == atom.name.text).map(|basic| &basic.result);
        }
        let mut found = None;
        value.for_each_variable(&mut |name| {
            found = found.or_else(|| self.known.get(name.text.as_str()).copied());
        });
        found
    }

    fn expression(&mut self, expression: &'a Expression) {
        match expression {
            Expression::Atom(atom) => self.atom(atom),
            Expression::Bind { variable, value, .. } => self.bind(&variable.text, value),
            Expression::Negate { operand, .. } | Expression::Not { operand, .. } => {
                self.expression(operand);
            }
            Expression::Arithmetic { left, right, .. }
            | Expression::Compare { left, right, .. } => {
                self.expression(left);
                self.expression(right);
            }
            Expression::And(parts) | Expression::Or(parts) => {
                for part in parts {
                    self.expression(part);
                }
            }
            _ => {}
        }
    }
}
