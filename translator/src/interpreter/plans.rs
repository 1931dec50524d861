//! Plans and their formulae.

use super::evaluate::Substitution;
use super::{Environment, Event, Interpreter, Key, Outcome, Value, key_of};
use crate::syntax::ast::{Atom, Expression, Formula, Operator, Plan, Relation, TriggerKind};
use crate::types::CType;

impl Interpreter {
    /// Runs a trigger's plans, and if they fail those of its failure trigger. Arguments that are
    /// `None` are asked for.
    pub(super) fn run_with_failure(
        &mut self,
        key: &Key,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        let outcome = self.run(key, arguments, environment);
        let (operator, kind, name) = key;
        let failure = (Operator::Delete, *kind, name.clone());
        let mendable = *operator == Operator::Add && *kind != TriggerKind::Belief;
        if matches!(outcome, Outcome::Achieved(_)) || !mendable || !self.has_plans(&failure) {
            return outcome;
        }
        self.run(&failure, arguments, environment)
    }

    fn run(
        &mut self,
        key: &Key,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        let plans: Vec<Plan> =
            self.agent.plans.iter().filter(|plan| key_of(&plan.trigger) == *key).cloned().collect();
        let types = self.types(&key.2);
        for plan in plans {
            let Some(theta) = self.applicable(&plan, arguments, &types, environment) else {
                continue;
            };
            return self.body(&plan, theta, arguments, environment);
        }
        Outcome::NoPlan
    }

    fn applicable(
        &self,
        plan: &Plan,
        arguments: &[Option<Value>],
        types: &[CType],
        environment: &mut dyn Environment,
    ) -> Option<Substitution> {
        let mut theta = Substitution::default();
        let patterns = &plan.trigger.atom.arguments;
        for ((pattern, value), ctype) in patterns.iter().zip(arguments).zip(types) {
            if let Some(value) = value {
                self.match_pattern(pattern, value, ctype, &mut theta, environment)?;
            }
        }
        match &plan.context {
            Some(context) => self.context(context, &theta, environment),
            None => Some(theta),
        }
    }

    fn body(
        &mut self,
        plan: &Plan,
        mut theta: Substitution,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        for formula in &plan.body {
            if self.formula(formula, &mut theta, environment).is_none() {
                return Outcome::Failed;
            }
        }
        let patterns = plan.trigger.atom.arguments.iter().zip(arguments);
        let answers = patterns.filter(|(_, value)| value.is_none()).filter_map(|(pattern, _)| {
            let Expression::Variable(name) = pattern else { return None };
            theta.get(&name.text).cloned()
        });
        Outcome::Achieved(answers.collect())
    }

    /// One formula; nothing if it fails.
    fn formula(
        &mut self,
        formula: &Formula,
        theta: &mut Substitution,
        environment: &mut dyn Environment,
    ) -> Option<()> {
        match formula {
            Formula::Action(atom) => {
                self.call(atom, theta, environment)?;
            }
            Formula::Assign { variable, value } => {
                let ctype = self.type_of(value, theta)?;
                let value = self.evaluate(value, &ctype, theta, environment)?;
                theta.bind(&variable.text, &ctype, value);
            }
            Formula::Add(atom) => {
                let values = self.arguments(atom, theta, environment)?;
                let name = &atom.name.text;
                let old = self.beliefs.insert(name.clone(), values.clone());
                let same = old.is_some_and(|old| Value::all_equal(&old, &values));
                if !same {
                    self.percept(Operator::Add, name, values, environment)?;
                }
            }
            Formula::Delete(atom) => {
                let name = &atom.name.text;
                let given = self.given(atom, theta, environment)?;
                let matching = self.beliefs.get(name);
                if matching.is_some_and(|values| matches_given(values, &given))
                    && let Some(old) = self.beliefs.remove(name)
                {
                    self.percept(Operator::Delete, name, old, environment)?;
                }
            }
            Formula::Achieve(atom) => {
                let arguments = self.arguments(atom, theta, environment)?;
                let key = (Operator::Add, TriggerKind::Achieve, atom.name.text.clone());
                if self.recursive.contains(&key) {
                    self.posted = Some(Event { key, arguments, external: false });
                } else {
                    let given: Vec<_> = arguments.into_iter().map(Some).collect();
                    let outcome = self.run_with_failure(&key, &given, environment);
                    matches!(outcome, Outcome::Achieved(_)).then_some(())?;
                }
            }
            Formula::Defer(atom) => {
                let arguments = self.arguments(atom, theta, environment)?;
                let key = (Operator::Add, TriggerKind::Achieve, atom.name.text.clone());
                self.defer(key, arguments);
            }
            Formula::Test(atom) => self.test(atom, theta, environment)?,
        }
        Some(())
    }

    fn arguments(
        &self,
        atom: &Atom,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Vec<Value>> {
        self.evaluate_all(&atom.arguments, &self.types(&atom.name.text), theta, environment)
    }

    /// A belief has changed: its plans run now, or in the next step if they are recursive.
    fn percept(
        &mut self,
        operator: Operator,
        name: &str,
        arguments: Vec<Value>,
        environment: &mut dyn Environment,
    ) -> Option<()> {
        let key = (operator, TriggerKind::Belief, name.to_owned());
        if self.recursive.contains(&key) {
            self.posted = Some(Event { key, arguments, external: false });
            return Some(());
        }
        let given: Vec<_> = arguments.into_iter().map(Some).collect();
        let outcome = self.run(&key, &given, environment);
        (outcome != Outcome::Failed).then_some(())
    }

    /// The arguments that have a value, evaluated in order; the others are asked for.
    fn given(
        &self,
        atom: &Atom,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Vec<Option<Value>>> {
        let mut given = Vec::new();
        for (pattern, ctype) in atom.arguments.iter().zip(self.types(&atom.name.text)) {
            let hole = match pattern {
                Expression::Unnamed(_) => true,
                Expression::Variable(name) => theta.get(&name.text).is_none(),
                _ => false,
            };
            given.push(if hole {
                None
            } else {
                Some(self.evaluate(pattern, &ctype, theta, environment)?)
            });
        }
        Some(given)
    }

    /// `?b`: the beliefs, then the plans.
    fn test(
        &mut self,
        atom: &Atom,
        theta: &mut Substitution,
        environment: &mut dyn Environment,
    ) -> Option<()> {
        let types = self.types(&atom.name.text);
        let given = self.given(atom, theta, environment)?;
        let answers = match self.beliefs.get(&atom.name.text) {
            Some(values) if matches_given(values, &given) => {
                let open = values.iter().zip(&given).filter(|(_, given)| given.is_none());
                open.map(|(value, _)| value.clone()).collect()
            }
            _ => {
                let key = (Operator::Add, TriggerKind::Test, atom.name.text.clone());
                match self.run_with_failure(&key, &given, environment) {
                    Outcome::Achieved(answers) => answers,
                    Outcome::NoPlan | Outcome::Failed => return None,
                }
            }
        };
        let holes = atom.arguments.iter().zip(&types).zip(&given).filter(|(_, v)| v.is_none());
        for (((pattern, ctype), _), answer) in holes.zip(answers) {
            if let Expression::Variable(name) = pattern {
                theta.bind(&name.text, ctype, answer);
            }
        }
        Some(())
    }
}

fn matches_given(values: &[Value], given: &[Option<Value>]) -> bool {
    values.iter().zip(given).all(|(value, given)| {
        given.as_ref().is_none_or(|given| Value::compare(Relation::Equal, value, given))
    })
}
