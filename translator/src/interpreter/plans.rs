//! Executes plans and their formulas.

use std::sync::Arc;

use super::evaluate::Substitution;
use super::{
    Deadline, Decision, Environment, Event, Interpreter, Key, Origin, Outcome, Value, Waiting,
    key_of,
};
use crate::configuration::sending;
use crate::syntax::ast::{
    Arithmetic, Atom, Expression, Formula, Operator, Performative, Plan, Relation, TriggerKind,
};
use crate::types::CType;

impl Interpreter {
    /// Runs a trigger's plans, and if they fail those of its failure trigger. Arguments that are `None` are
    /// queried.
    pub(super) fn run_with_failure(
        &mut self,
        key: &Key,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        if !self.limit.descend() {
            return Outcome::Failed;
        }
        let outcome = self.run(key, arguments, environment);
        let outcome = self.mend(key, outcome, arguments, environment);
        self.limit.ascend();
        outcome
    }

    /// Runs the failure plans of a goal that was not achieved.
    pub(super) fn mend(
        &mut self,
        key: &Key,
        outcome: Outcome,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        let (operator, kind, name) = key;
        let failure = (Operator::Delete, *kind, name.clone());
        let mendable = *operator == Operator::Add && *kind != TriggerKind::Belief;
        if matches!(outcome, Outcome::Achieved(_)) || !mendable || !self.has_plans(&failure) {
            return outcome;
        }
        self.run(&failure, arguments, environment)
    }

    /// Continues a plan that waits, if its time has come.
    pub(super) fn resume(
        &mut self,
        key: &Key,
        waiting: Waiting,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        let is_due = Self::is_due(&self.configuration, &waiting.due, environment);
        environment.chosen();
        if let Some(wait) = waiting.next.checked_sub(1).and_then(|wait| waiting.plan.body.get(wait))
        {
            environment.decided(Decision::Condition { place: wait.span(), holds: is_due });
        }
        if !is_due {
            self.posted = Some(Event {
                key: key.clone(),
                arguments: arguments.iter().flatten().cloned().collect(),
                origin: Origin::Wait(Box::new(waiting)),
            });
            return Outcome::Achieved(Vec::new());
        }
        let Waiting { plan, next, theta, .. } = waiting;
        self.log_plan(&plan, environment);
        let outcome = self.body(&plan, next, theta, arguments, environment);
        self.mend(key, outcome, arguments, environment)
    }

    fn run(
        &mut self,
        key: &Key,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        let agent = Arc::clone(&self.agent);
        let types = self.event_types(key);
        for plan in agent.plans.iter().filter(|plan| key_of(&plan.trigger) == *key) {
            if !self.limit.spend() {
                return Outcome::Failed;
            }
            let index = self.log_plan(plan, environment);
            let applicable = self.applicable(plan, arguments, &types, environment);
            let (place, applies) = (plan.trigger.span.clone(), applicable.is_some());
            environment.decided(Decision::Plan { place, applies });
            let Some(theta) = applicable else {
                Self::log_skipped(index, environment);
                continue;
            };
            environment.chosen();
            return self.body(plan, 0, theta, arguments, environment);
        }
        self.log_no_plan(key, environment);
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
        let Atom { arguments: patterns, source, .. } = &plan.trigger.atom;
        let any = Expression::Unnamed(plan.trigger.span.clone());
        let source = source.as_deref().unwrap_or(&any);
        let patterns = patterns.iter().chain([source]);
        for ((pattern, value), ctype) in patterns.zip(arguments).zip(types) {
            if let Some(value) = value {
                self.match_pattern(pattern, value, ctype, &mut theta, environment)?;
            } else if let Expression::Variable(name) = pattern {
                theta.ask(&name.text, ctype);
            }
        }
        match &plan.context {
            Some(context) => self.context(context, &theta, environment),
            None => Some(theta),
        }
    }

    /// Runs the formulas from index `first` on.
    fn body(
        &mut self,
        plan: &Plan,
        first: usize,
        mut theta: Substitution,
        arguments: &[Option<Value>],
        environment: &mut dyn Environment,
    ) -> Outcome {
        for (index, formula) in plan.body.iter().enumerate().skip(first) {
            if let Formula::Wait { duration, .. } = formula {
                let due = self.due(duration, &theta, environment);
                let (place, succeeded) = (formula.span(), due.is_some());
                environment.decided(Decision::Formula { place, succeeded });
                let Some(due) = due else {
                    self.log_failure(formula, environment);
                    return Outcome::Failed;
                };
                let waiting = Waiting { due, plan: plan.clone(), next: index + 1, theta };
                self.posted = Some(Event {
                    key: key_of(&plan.trigger),
                    arguments: arguments.iter().flatten().cloned().collect(),
                    origin: Origin::Wait(Box::new(waiting)),
                });
                return Outcome::Achieved(Vec::new());
            }
            let fuel = self.limit.spend();
            let succeeded = fuel && self.formula(formula, &mut theta, environment).is_some();
            environment.decided(Decision::Formula { place: formula.span(), succeeded });
            if !succeeded {
                self.log_failure(formula, environment);
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

    /// Runs one formula; `None` if it fails.
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
            Formula::MyName { variable, .. } => {
                theta.bind(&variable.text, &CType::peer(), self.me());
            }
            Formula::Send { to, performative, content, .. } => {
                self.send(to.as_ref(), *performative, content, theta, environment)?;
            }
            Formula::Assign { variable, value } => {
                let asked = || theta.asked(&variable.text);
                let ctype = self.type_of(value, theta).or_else(asked)?;
                let value = self.evaluate(value, &ctype, theta, environment)?;
                theta.bind(&variable.text, &ctype, value);
            }
            Formula::Add(atom) => {
                let values = self.arguments(atom, theta, environment)?;
                self.log_formula("+", atom, &values, environment);
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
                    self.log_formula("-", atom, &old, environment);
                    self.percept(Operator::Delete, name, old, environment)?;
                }
            }
            Formula::Achieve { goal, deadline } => {
                let arguments = self.arguments(goal, theta, environment)?;
                self.log_formula("!", goal, &arguments, environment);
                let key = (Operator::Add, TriggerKind::Achieve, goal.name.text.clone());
                let arguments = self.own(key.1, &key.2, arguments);
                if self.recursive.contains(&key) {
                    if let Some(deadline) = deadline {
                        let due = self.due(deadline, theta, environment)?;
                        if self.deadline.as_ref().is_none_or(|running| running.goal != key) {
                            let arguments = arguments.clone();
                            self.deadline = Some(Deadline { goal: key.clone(), arguments, due });
                        }
                    }
                    self.posted = Some(Event { key, arguments, origin: Origin::Agent });
                } else {
                    let given: Vec<_> = arguments.into_iter().map(Some).collect();
                    let outcome = self.run_with_failure(&key, &given, environment);
                    matches!(outcome, Outcome::Achieved(_)).then_some(())?;
                }
            }
            Formula::Defer(atom) => {
                let arguments = self.arguments(atom, theta, environment)?;
                self.log_formula("!!", atom, &arguments, environment);
                let key = (Operator::Add, TriggerKind::Achieve, atom.name.text.clone());
                let arguments = self.own(key.1, &key.2, arguments);
                self.defer(key, arguments);
            }
            Formula::Test(atom) => self.test(atom, theta, environment)?,
            // The wait is over.
            Formula::Wait { .. } => {}
        }
        Some(())
    }

    /// Sends a message to one peer, or to all others in their order.
    fn send(
        &self,
        to: Option<&Expression>,
        performative: Performative,
        content: &Atom,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<()> {
        let to = match to {
            Some(to) => vec![self.evaluate(to, &CType::peer(), theta, environment)?],
            None => self.other_peers(),
        };
        let arguments = self.arguments(content, theta, environment)?;
        let action = sending(performative, &content.name.text);
        for peer in to {
            let values: Vec<Value> = std::iter::once(peer).chain(arguments.clone()).collect();
            environment.call(&action, &values, &CType::named("void"));
            self.log_sent(&action, content, &values, environment);
        }
        Some(())
    }

    /// The time at which `duration` will have passed.
    fn due(
        &self,
        duration: &Expression,
        theta: &Substitution,
        environment: &mut dyn Environment,
    ) -> Option<Value> {
        let clock = self.configuration.settings.clock.as_ref()?;
        let basics = &self.configuration.basics;
        let clock = basics.iter().find(|basic| basic.name.text == clock.text)?;
        let now = environment.call(&clock.name.text, &[], &clock.result)?;
        let duration = self.evaluate(duration, &clock.result, theta, environment)?;
        Value::calculate(Arithmetic::Add, &now, &duration, &clock.result)
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
        let arguments = self.own(key.1, name, arguments);
        if self.recursive.contains(&key) {
            self.posted = Some(Event { key, arguments, origin: Origin::Agent });
            return Some(());
        }
        let given: Vec<_> = arguments.into_iter().map(Some).collect();
        if !self.limit.descend() {
            return None;
        }
        let outcome = self.run(&key, &given, environment);
        self.limit.ascend();
        (outcome != Outcome::Failed).then_some(())
    }

    /// The given arguments, evaluated in order; the others are queried.
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
