//! Conditions under which a context can hold and can fail, as far as the model has that information.

use super::logic::{Choice, or};
use super::scale::{Number, Scale, is_checked};
use crate::analysis::constants::c_number;
use crate::configuration::{Cause, Comparison, Formula, Operand};
use crate::program::{BeliefId, Condition, Pattern, Plan, Program, Value, VariableId};
use crate::syntax::ast::Relation;

/// The comparisons of properties, whose results the model remembers.
pub(super) struct Comparisons {
    /// Comparisons of two beliefs.
    pairs: Vec<Pair>,
    /// Comparisons of beliefs with numbers.
    scales: Vec<Scale>,
}

/// A comparison of two beliefs. The model remembers its result only while it checks a property with it.
#[derive(Debug, Clone)]
struct Pair {
    left: String,
    relation: Relation,
    right: String,
    /// The properties with it.
    properties: Vec<usize>,
}

impl Pair {
    fn of(property: usize, comparison: &Comparison) -> Option<Self> {
        let Comparison { left, relation, right: Operand::Belief(right) } = comparison else {
            return None;
        };
        let (left, right) = (left.text.clone(), right.text.clone());
        Some(Self { left, relation: *relation, right, properties: vec![property] })
    }

    fn is(&self, comparison: &Comparison) -> bool {
        let Comparison { left, relation, right: Operand::Belief(right) } = comparison else {
            return false;
        };
        self.left == left.text && self.relation == *relation && self.right == right.text
    }
}

/// A comparison of a belief with a number.
struct Marked<'a> {
    belief: &'a str,
    relation: Relation,
    mark: Number,
}

impl<'a> Marked<'a> {
    /// A comparison with a number, or with a belief that never changes.
    fn of(program: &Program, comparison: &'a Comparison) -> Option<Self> {
        let Comparison { left, relation, right } = comparison;
        let find = |name: &str| program.beliefs.iter().position(|belief| belief.name == name);
        let always = |name: &str| program.fixed(BeliefId(find(name)?)).and_then(Number::of);
        let right = match right {
            Operand::Number(number) => {
                let ctype = program.beliefs.get(find(&left.text)?)?.types.first()?;
                let text = c_number(number, ctype).ok()?;
                let mark = Number::of(&Value::Constant(text, ctype.clone()))?;
                return Some(Self { belief: &left.text, relation: *relation, mark });
            }
            Operand::Belief(right) => &right.text,
        };
        if let Some(mark) = always(right) {
            return Some(Self { belief: &left.text, relation: *relation, mark });
        }
        let mark = always(&left.text)?;
        Some(Self { belief: right, relation: mirrored(*relation), mark })
    }
}

/// One side of a comparison in a context, as far as it is known.
#[derive(Debug, Clone, Copy)]
struct Side<'a> {
    /// The belief whose only value it is.
    belief: Option<&'a str>,
    /// Its value, if it is constant.
    number: Option<Number>,
}

impl Comparisons {
    pub(super) fn new(program: &Program) -> Self {
        let (mut pairs, mut scales) = (Vec::new(), Vec::<Scale>::new());
        for (number, property) in (1..).zip(&program.configuration.properties) {
            let Formula::Within { cause: Cause::Comparison(comparison), .. } = &property.formula
            else {
                continue;
            };
            let Some(Marked { belief, mark, .. }) = Marked::of(program, comparison) else {
                match pairs.iter_mut().find(|pair: &&mut Pair| pair.is(comparison)) {
                    Some(pair) => pair.properties.push(number),
                    None => pairs.extend(Pair::of(number, comparison)),
                }
                continue;
            };
            match scales.iter_mut().find(|scale| scale.belief() == belief) {
                Some(scale) => scale.add(number, mark),
                None => scales.push(Scale::new(belief, number, mark)),
            }
        }
        Self { pairs, scales }
    }

    /// Number of compared pairs of beliefs.
    pub(super) fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether a property's comparison holds, given that its beliefs are held.
    pub(super) fn holds(&self, program: &Program, comparison: &Comparison) -> Option<String> {
        if let Some(Marked { belief, relation, mark }) = Marked::of(program, comparison) {
            return Some(self.scale(belief)?.holds(relation, mark));
        }
        let index = self.pairs.iter().position(|pair| pair.is(comparison))?;
        Some(format!("compared_{index}"))
    }

    /// Whether the result of a pair is remembered, as an expression.
    pub(super) fn followed(&self, index: usize) -> String {
        is_checked(self.pairs.get(index).map_or(&[], |pair| &pair.properties))
    }

    /// The pairs that contain a belief.
    pub(super) fn of(&self, belief: &str) -> Vec<usize> {
        let about = |pair: &Pair| pair.left == belief || pair.right == belief;
        (0..self.pairs.len()).filter(|index| about(&self.pairs[*index])).collect()
    }

    /// The pairs in which both beliefs satisfy a predicate.
    pub(super) fn between(&self, is_so: impl Fn(&str) -> bool) -> Vec<usize> {
        let both = |pair: &Pair| is_so(&pair.left) && is_so(&pair.right);
        (0..self.pairs.len()).filter(|index| both(&self.pairs[*index])).collect()
    }

    pub(super) fn scales(&self) -> &[Scale] {
        &self.scales
    }

    /// The numbers with which a belief is compared.
    pub(super) fn scale(&self, belief: &str) -> Option<&Scale> {
        self.scales.iter().find(|scale| scale.belief() == belief)
    }

    /// Possible results of `left relation right`.
    fn choice(&self, left: Side<'_>, relation: Relation, right: Side<'_>, total: bool) -> Choice {
        let scaled = |side: Side<'_>, relation, other: Side<'_>| {
            let (holds, fails) = self.scale(side.belief?)?.outcomes(relation, other.number?);
            Some(Choice { holds, fails })
        };
        self.paired(left, relation, right, total)
            .or_else(|| scaled(left, relation, right))
            .or_else(|| scaled(right, mirrored(relation), left))
            .unwrap_or_else(Choice::free)
    }

    /// Comparison of two beliefs. For integers, not `<=` means `>`; with NaN both are false.
    fn paired(
        &self,
        left: Side<'_>,
        relation: Relation,
        right: Side<'_>,
        total: bool,
    ) -> Option<Choice> {
        let compared = (left.belief?, right.belief?);
        self.pairs.iter().enumerate().find_map(|(index, known)| {
            let relation = match (known.left.as_str(), known.right.as_str()) {
                pair if pair == compared => relation,
                (own, other) if (other, own) == compared => mirrored(relation),
                _ => return None,
            };
            let free = format!("!{}", self.followed(index));
            let outcome = || Choice {
                holds: or(&[free.clone(), format!("compared_{index}")]),
                fails: or(&[free.clone(), format!("!compared_{index}")]),
            };
            if relation == known.relation {
                return Some(outcome());
            }
            (total && relation == opposite(known.relation)).then(|| outcome().not())
        })
    }
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

/// Evaluates contexts of one plan.
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
                let total = !ctype.is_float();
                self.comparisons.choice(self.side(left), *relation, self.side(right), total)
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

    fn side(&self, value: &Value) -> Side<'_> {
        let origin = self.origin(value);
        let fixed = origin.and_then(|id| self.program.fixed(id));
        Side {
            belief: origin.map(|id| self.program.belief(id).name.as_str()),
            number: Number::of(fixed.unwrap_or(value)),
        }
    }

    fn origin(&self, value: &Value) -> Option<BeliefId> {
        match value {
            Value::Variable(id) => self.origins[id.0],
            _ => None,
        }
    }
}

/// Values are unknown: a pattern with a value may match or not.
pub(super) fn matches(patterns: &[Pattern]) -> Choice {
    let wanted = patterns.iter().any(|pattern| matches!(pattern, Pattern::Equal(_)));
    if wanted { Choice::free() } else { Choice::certain() }
}
