//! When a context can hold and when it can fail, as far as the model knows.

use crate::configuration::{Cause, Comparison, Formula};
use crate::program::{BeliefId, Condition, Pattern, Plan, Program, Value, VariableId};
use crate::syntax::ast::Relation;

/// Two expressions over the state of the model. Both can be true: then it is a free choice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Choice {
    pub(super) holds: String,
    pub(super) fails: String,
}

impl Choice {
    fn free() -> Self {
        Self { holds: "true".to_owned(), fails: "true".to_owned() }
    }

    fn certain() -> Self {
        Self { holds: "true".to_owned(), fails: "false".to_owned() }
    }

    fn when(condition: String) -> Self {
        let fails = not(&condition);
        Self { holds: condition, fails }
    }

    fn not(self) -> Self {
        Self { holds: self.fails, fails: self.holds }
    }

    fn all(parts: Vec<Self>) -> Self {
        let (holds, fails): (Vec<_>, Vec<_>) =
            parts.into_iter().map(|part| (part.holds, part.fails)).unzip();
        Self { holds: and(&holds), fails: or(&fails) }
    }

    fn any(parts: Vec<Self>) -> Self {
        Self::all(parts.into_iter().map(Self::not).collect()).not()
    }
}

/// The conjunction, without what is always true.
pub(super) fn and(parts: &[String]) -> String {
    joined(parts, "&&", "true", "false")
}

fn or(parts: &[String]) -> String {
    joined(parts, "||", "false", "true")
}

fn joined(parts: &[String], operator: &str, neutral: &str, decisive: &str) -> String {
    if parts.iter().any(|part| part == decisive) {
        return decisive.to_owned();
    }
    let mut left: Vec<&str> = Vec::new();
    for part in parts.iter().filter(|part| *part != neutral) {
        if !left.contains(&part.as_str()) {
            left.push(part);
        }
    }
    match left.as_slice() {
        [] => neutral.to_owned(),
        [one] => (*one).to_owned(),
        several => format!("({})", several.join(&format!(" {operator} "))),
    }
}

fn not(condition: &str) -> String {
    match condition {
        "true" => "false".to_owned(),
        "false" => "true".to_owned(),
        other => format!("!{other}"),
    }
}

/// The comparisons that properties speak of: the model remembers how they come out.
pub(super) struct Comparisons(Vec<Comparison>);

impl Comparisons {
    pub(super) fn new(program: &Program) -> Self {
        let mut known: Vec<Comparison> = Vec::new();
        for property in &program.configuration.properties {
            if let Formula::Within { cause: Cause::Comparison(comparison), .. } = &property.formula
                && !known.iter().any(|other| same(other, comparison))
            {
                known.push(comparison.clone());
            }
        }
        Self(known)
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// The number of a property's comparison.
    pub(super) fn number(&self, comparison: &Comparison) -> Option<usize> {
        self.0.iter().position(|other| same(other, comparison))
    }

    /// Those in which a belief takes part.
    pub(super) fn of(&self, belief: &str) -> Vec<usize> {
        let about = |comparison: &Comparison| {
            comparison.left.text == belief || comparison.right.text == belief
        };
        (0..self.0.len()).filter(|index| about(&self.0[*index])).collect()
    }

    /// How `left relation right` comes out. Integers that are not `<=` are `>`; numbers that are none are
    /// neither.
    fn choice(&self, left: &str, relation: Relation, right: &str, total: bool) -> Choice {
        for (index, known) in self.0.iter().enumerate() {
            let compared = || Choice::when(format!("compared_{index}"));
            let (own, other) = (known.left.text.as_str(), known.right.text.as_str());
            let relation = match (left, right) {
                pair if pair == (own, other) => relation,
                pair if pair == (other, own) => mirrored(relation),
                _ => continue,
            };
            if relation == known.relation {
                return compared();
            }
            if total && relation == opposite(known.relation) {
                return compared().not();
            }
        }
        Choice::free()
    }
}

fn same(left: &Comparison, right: &Comparison) -> bool {
    (left.left.text.as_str(), left.relation, left.right.text.as_str())
        == (right.left.text.as_str(), right.relation, right.right.text.as_str())
}

fn mirrored(relation: Relation) -> Relation {
    match relation {
        Relation::Less => Relation::Greater,
        Relation::LessOrEqual => Relation::GreaterOrEqual,
        Relation::Greater => Relation::Less,
        Relation::GreaterOrEqual => Relation::LessOrEqual,
        Relation::Equal | Relation::NotEqual => relation,
    }
}

fn opposite(relation: Relation) -> Relation {
    match relation {
        Relation::Less => Relation::GreaterOrEqual,
        Relation::LessOrEqual => Relation::Greater,
        Relation::Greater => Relation::LessOrEqual,
        Relation::GreaterOrEqual => Relation::Less,
        Relation::Equal => Relation::NotEqual,
        Relation::NotEqual => Relation::Equal,
    }
}

/// Reads contexts of one plan.
pub(super) struct Reader<'a> {
    program: &'a Program,
    comparisons: &'a Comparisons,
    held: &'a dyn Fn(BeliefId) -> String,
    /// The belief whose only value each variable has.
    origins: Vec<Option<BeliefId>>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(
        program: &'a Program,
        comparisons: &'a Comparisons,
        held: &'a dyn Fn(BeliefId) -> String,
    ) -> Self {
        Self { program, comparisons, held, origins: Vec::new() }
    }

    /// Whether a plan applies.
    pub(super) fn applies(&mut self, plan: &Plan) -> Choice {
        self.origins = vec![None; plan.variables.len()];
        let mut parts = vec![matches(&plan.patterns)];
        parts.extend(plan.context.iter().map(|condition| self.condition(condition)));
        Choice::all(parts)
    }

    fn condition(&mut self, condition: &Condition) -> Choice {
        match condition {
            Condition::Holds { belief, patterns } => {
                if let [Pattern::Bind(variable)] = patterns.as_slice() {
                    self.originate(*variable, Some(*belief));
                }
                Choice::all(vec![Choice::when((self.held)(*belief)), matches(patterns)])
            }
            Condition::Truth(_) => Choice::free(),
            Condition::Compare { relation, left, right, ctype } => {
                match (self.origin(left), self.origin(right)) {
                    (Some(left), Some(right)) => {
                        let name = |id: BeliefId| self.program.belief(id).name.as_str();
                        let total = !ctype.is_float();
                        self.comparisons.choice(name(left), *relation, name(right), total)
                    }
                    _ => Choice::free(),
                }
            }
            Condition::Bind { variable, value } => {
                let origin = self.origin(value);
                self.originate(*variable, origin);
                if value.can_fail() { Choice::free() } else { Choice::certain() }
            }
            Condition::Not(inner) => self.conjunction(inner).not(),
            Condition::Any(alternatives) => {
                let branches = alternatives.branches.iter();
                Choice::any(branches.map(|branch| self.conjunction(branch)).collect())
            }
        }
    }

    fn conjunction(&mut self, conditions: &[Condition]) -> Choice {
        Choice::all(conditions.iter().map(|condition| self.condition(condition)).collect())
    }

    fn originate(&mut self, variable: VariableId, origin: Option<BeliefId>) {
        self.origins[variable.0] = origin;
    }

    fn origin(&self, value: &Value) -> Option<BeliefId> {
        match value {
            Value::Variable(id) => self.origins[id.0],
            _ => None,
        }
    }
}

/// Values are not known: a pattern that wants one may match or not.
pub(super) fn matches(patterns: &[Pattern]) -> Choice {
    let wanted = patterns.iter().any(|pattern| matches!(pattern, Pattern::Equal(_)));
    if wanted { Choice::free() } else { Choice::certain() }
}

#[cfg(test)]
mod tests {
    use super::{Choice, and, or};

    #[test]
    fn what_is_certain_is_left_out() {
        let [yes, no, held] = ["true", "false", "held_b"].map(str::to_owned);
        assert_eq!(and(&[yes.clone(), held.clone(), held.clone()]), "held_b");
        assert_eq!(and(&[held.clone(), no.clone()]), "false");
        assert_eq!(or(&[no, held.clone(), "x".to_owned()]), "(held_b || x)");
        assert_eq!(or(&[held.clone(), yes]), "true");
        let both = Choice::all(vec![Choice::when(held), Choice::free()]);
        assert_eq!((both.holds.as_str(), both.fails.as_str()), ("held_b", "true"));
    }
}
