//! Conditions under which a context can hold and can fail, as far as the model has that information.

use super::logic::{Choice, or};
use super::scale::{Number, Scale, is_checked};
use crate::analysis::constants::c_number;
use crate::configuration::{Cause, Comparison, Formula, Operand, Property};
use crate::program::{
    Alternatives, BeliefId, Condition, Pattern, Plan, Program, Value, VariableId,
};
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
    pub(super) fn new(program: &Program, properties: &[Property]) -> Self {
        let (mut pairs, mut scales) = (Vec::new(), Vec::<Scale>::new());
        for (number, property) in (1..).zip(properties) {
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
    peers: &'a Peers,
    /// Where each variable has its value from.
    known: Vec<Option<Known>>,
}

/// What is known of a value.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Known {
    /// It is the only one of a belief.
    Belief(BeliefId),
    /// It is a peer, whose number is this expression.
    Peer(String),
}

/// A way in which a plan applies: when, and the numbers of the peers that variables have then.
pub(super) struct Way {
    pub(super) choice: Choice,
    pub(super) peers: Vec<(VariableId, String)>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(
        program: &'a Program,
        comparisons: &'a Comparisons,
        held: &'a dyn Fn(BeliefId) -> String,
        peers: &'a Peers,
    ) -> Self {
        Self { program, comparisons, held, peers, known: Vec::new() }
    }

    /// Whether a plan applies. `source` is the variable with the peer that its event comes from.
    pub(super) fn applies(&mut self, plan: &Plan, source: Option<&str>) -> Choice {
        let trigger = self.trigger(plan, source);
        Choice::all(vec![trigger, self.conjunction(&plan.context)])
    }

    /// The ways in which a plan applies, those that are tried first before the others.
    pub(super) fn ways(&mut self, plan: &Plan, source: Option<&str>) -> Vec<Way> {
        let trigger = self.trigger(plan, source);
        let mut ways = Vec::new();
        let context = plan.context.iter().map(Next::Condition).collect();
        self.find_ways(context, &[trigger], &mut ways);
        ways
    }

    fn find_ways(&mut self, mut rest: Vec<Next<'_>>, before: &[Choice], ways: &mut Vec<Way>) {
        let mut parts = before.to_vec();
        while !rest.is_empty() {
            let condition = match rest.remove(0) {
                Next::Condition(Condition::Any(alternatives)) => {
                    let Alternatives { branches, exports } = alternatives;
                    for (index, branch) in branches.iter().enumerate() {
                        let known = self.known.clone();
                        let branch = branch.iter().map(Next::Condition);
                        let exports =
                            exports.iter().map(|(outer, inner)| Next::Named(*outer, inner[index]));
                        let all = branch.chain(exports).chain(rest.iter().copied()).collect();
                        self.find_ways(all, &parts, ways);
                        self.known = known;
                    }
                    return;
                }
                Next::Named(outer, inner) => {
                    let known = self.known[inner.0].clone();
                    self.known[outer.0] = known;
                    continue;
                }
                Next::Condition(condition) => condition,
            };
            parts.push(self.condition(condition));
        }
        let peers = self.known.iter().enumerate().filter_map(|(index, known)| match known {
            Some(Known::Peer(peer)) => Some((VariableId(index), peer.clone())),
            _ => None,
        });
        let peers = peers.collect();
        ways.push(Way { choice: Choice::all(parts), peers });
    }

    /// Whether the event matches.
    fn trigger(&mut self, plan: &Plan, source: Option<&str>) -> Choice {
        self.known = vec![None; plan.variables.len()];
        let (Some(source), Some((last, others))) = (source, plan.patterns.split_last()) else {
            return matches(&plan.patterns);
        };
        let from = match last {
            Pattern::Any => Choice::certain(),
            Pattern::Bind(variable) => {
                self.known[variable.0] = Some(Known::Peer(source.to_owned()));
                Choice::certain()
            }
            Pattern::Equal(value) => match self.peer(value) {
                Some(peer) => self.peers.same(source, &peer),
                None => Choice::free(),
            },
        };
        Choice::all(vec![matches(others), from])
    }

    fn condition(&mut self, condition: &Condition) -> Choice {
        match condition {
            Condition::Holds { belief, patterns } => {
                if let [Pattern::Bind(variable)] = patterns.as_slice() {
                    self.known[variable.0] = Some(Known::Belief(*belief));
                }
                Choice::all(vec![Choice::when((self.held)(*belief)), matches(patterns)])
            }
            Condition::Truth(_) => Choice::free(),
            Condition::Compare { relation, left, right, ctype } => {
                if let (Some(left), Some(right)) = (self.peer(left), self.peer(right)) {
                    let same = self.peers.same(&left, &right);
                    return match relation {
                        Relation::Equal => same,
                        Relation::NotEqual => same.not(),
                        _ => Choice::free(),
                    };
                }
                let total = !ctype.is_float();
                self.comparisons.choice(self.side(left), *relation, self.side(right), total)
            }
            Condition::Bind { variable, value } => {
                let belief = self.origin(value).map(Known::Belief);
                self.known[variable.0] = belief.or_else(|| self.peer(value).map(Known::Peer));
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
            Value::Variable(id) => match self.known[id.0] {
                Some(Known::Belief(belief)) => Some(belief),
                _ => None,
            },
            _ => None,
        }
    }

    /// The number of a peer, as an expression.
    fn peer(&self, value: &Value) -> Option<String> {
        match value {
            Value::Me => Some(self.peers.me()),
            Value::Constant(name, ctype) if ctype.is_peer() => {
                let peers = 0..self.program.configuration.peers.len();
                let peer = peers.into_iter().find(|peer| self.program.peer(*peer) == *name)?;
                Some(peer.to_string())
            }
            Value::Variable(id) => match &self.known[id.0] {
                Some(Known::Peer(peer)) => Some(peer.clone()),
                _ => None,
            },
            _ => None,
        }
    }
}

/// What a context has still to decide.
#[derive(Clone, Copy)]
enum Next<'c> {
    Condition(&'c Condition),
    /// A variable behind alternatives is that of the branch that was taken.
    Named(VariableId, VariableId),
}

/// The numbers of peers in the model.
#[derive(Debug, Clone, Copy)]
pub(super) struct Peers {
    /// How many there are.
    pub(super) count: usize,
    /// The peer that the agent is, if the model is of that one.
    pub(super) me: Option<usize>,
}

/// A peer about whom nothing is known.
pub(super) const UNKNOWN_PEER: &str = "255";

impl Peers {
    /// The agent's own number: one that is no other's, if it may be any of them.
    pub(super) fn me(self) -> String {
        self.me.unwrap_or(self.count).to_string()
    }

    /// Whether two are the same.
    fn same(self, left: &str, right: &str) -> Choice {
        if left == right && left != UNKNOWN_PEER {
            return Choice::certain();
        }
        let number = |peer: &str| peer.parse::<usize>().ok();
        let (one, other) = match (number(left), number(right)) {
            // The agent may be the one that is named.
            (Some(left), Some(right)) if left < self.count && right < self.count => {
                return Choice::certain().not();
            }
            (None, Some(_)) => (left, right),
            (Some(_), None) => (right, left),
            _ => return Choice::free(),
        };
        if other == UNKNOWN_PEER {
            return Choice::free();
        }
        let mut may_be = vec![format!("{one} == {UNKNOWN_PEER}")];
        let fails = format!("({} || {one} != {other})", may_be[0]);
        if self.me.is_none() {
            // What comes from the agent itself may come from the one that is named.
            may_be.push(format!("{one} == {}", self.count));
        }
        may_be.push(format!("{one} == {other}"));
        Choice { holds: format!("({})", may_be.join(" || ")), fails }
    }
}

/// Values are unknown: a pattern with a value may match or not.
pub(super) fn matches(patterns: &[Pattern]) -> Choice {
    let wanted = patterns.iter().any(|pattern| matches!(pattern, Pattern::Equal(_)));
    if wanted { Choice::free() } else { Choice::certain() }
}
