//! Checks whether some plan of a trigger applies in every state.
//!
//! Contexts become formulas over questions such as "is `b` believed" and "is its first value less than 20",
//! and all answers are tried. Questions are treated as independent, so the result is conservative: a trigger
//! found to be covered is covered. The result of a function, or of an operation that may fail, is a new
//! question each time: a function such as a clock may differ for the next plan.

use std::collections::HashMap;

use crate::program::{Condition, Handler, Pattern, Plan, Program, Value, VariableId};
use crate::syntax::ast::Relation;
use crate::types::CType;

/// With more questions than this the answers are not enumerated, and the trigger counts as not covered.
const MAX_QUESTIONS: usize = 12;

/// Whether one of the plans applies to every event.
pub(crate) fn always_finds_a_plan(handler: &Handler) -> bool {
    if handler.plans.iter().any(Plan::always_applies) {
        return true;
    }
    let mut questions = Questions::default();
    let plans: Vec<Formula> =
        handler.plans.iter().map(|plan| applies(plan, &mut questions)).collect();
    questions.count <= MAX_QUESTIONS
        && (0_u32..1 << questions.count).all(|answers| plans.iter().any(|plan| plan.holds(answers)))
}

/// Plans that can never be chosen: an earlier one always applies, or they require a belief that is never
/// held.
pub(crate) fn never_applicable(program: &Program) -> impl Iterator<Item = &Plan> {
    let mut covered = false;
    program.plans().filter_map(move |(_, number, plan)| {
        covered &= number > 0;
        let impossible = |condition: &Condition| {
            matches!(condition, Condition::Holds { belief, .. } if !program.is_believable(*belief))
        };
        let never = covered || plan.context.iter().any(impossible);
        covered |= plan.always_applies();
        never.then_some(plan)
    })
}

enum Formula {
    /// The answer to a question.
    Question(usize),
    Not(Box<Self>),
    All(Vec<Self>),
    Any(Vec<Self>),
}

impl Formula {
    fn holds(&self, answers: u32) -> bool {
        match self {
            Self::Question(number) => answers & (1 << number) != 0,
            Self::Not(inner) => !inner.holds(answers),
            Self::All(parts) => parts.iter().all(|part| part.holds(answers)),
            Self::Any(parts) => parts.iter().any(|part| part.holds(answers)),
        }
    }
}

/// Questions by their text.
#[derive(Default)]
struct Questions {
    known: HashMap<String, usize>,
    count: usize,
}

impl Questions {
    fn named(&mut self, text: String) -> Formula {
        let next = self.count;
        let number = *self.known.entry(text).or_insert(next);
        self.count = self.count.max(number + 1);
        Formula::Question(number)
    }

    /// A question that no other plan shares.
    fn fresh(&mut self) -> Formula {
        self.count += 1;
        Formula::Question(self.count - 1)
    }
}

/// Origin of each value of a plan's variables.
struct Origins {
    origins: Vec<Option<String>>,
}

impl Origins {
    fn bind(&mut self, id: VariableId, origin: Option<String>) {
        self.origins[id.0] = origin;
    }

    /// The value as text with the same meaning in every plan of the trigger.
    fn text(&self, value: &Value) -> Option<String> {
        match value {
            Value::Variable(id) => self.origins[id.0].clone(),
            Value::Constant(text, _) => Some(text.clone()),
            Value::Me => Some("me".to_owned()),
            Value::Negate(operand) => Some(format!("-({})", self.text(operand)?)),
            Value::ToldAt(_) | Value::Arithmetic(_) | Value::Call(_) => None,
        }
    }
}

/// Condition under which the plan applies.
fn applies(plan: &Plan, questions: &mut Questions) -> Formula {
    let mut origins = Origins { origins: vec![None; plan.variables.len()] };
    let mut parts = Vec::new();
    matches("argument", &plan.patterns, &mut origins, questions, &mut parts);
    parts.extend(conjunction(&plan.context, &mut origins, questions));
    Formula::All(parts)
}

/// The questions whether values match patterns; records the origins of variables.
fn matches(
    of: &str,
    patterns: &[Pattern],
    origins: &mut Origins,
    questions: &mut Questions,
    parts: &mut Vec<Formula>,
) {
    for (index, pattern) in patterns.iter().enumerate() {
        let value = format!("{of}.{index}");
        match pattern {
            Pattern::Any => {}
            Pattern::Bind(id) => origins.bind(*id, Some(value)),
            Pattern::Equal(wanted) => parts.push(match origins.text(wanted) {
                Some(wanted) => questions.named(format!("{value} == {wanted}")),
                None => questions.fresh(),
            }),
        }
    }
}

fn conjunction(
    conditions: &[Condition],
    origins: &mut Origins,
    questions: &mut Questions,
) -> Vec<Formula> {
    conditions.iter().map(|condition| formula(condition, origins, questions)).collect()
}

fn formula(condition: &Condition, origins: &mut Origins, questions: &mut Questions) -> Formula {
    match condition {
        Condition::Holds { belief, patterns } => {
            let name = format!("belief {}", belief.0);
            let mut parts = vec![questions.named(name.clone())];
            matches(&name, patterns, origins, questions, &mut parts);
            Formula::All(parts)
        }
        Condition::Truth(value) => match origins.text(value) {
            Some(text) => questions.named(text),
            None => questions.fresh(),
        },
        Condition::Compare { relation, left, right, ctype } => {
            match (origins.text(left), origins.text(right)) {
                (Some(left), Some(right)) => comparison(*relation, &left, &right, ctype, questions),
                _ => questions.fresh(),
            }
        }
        Condition::Bind { variable, value } => {
            let text = origins.text(value);
            origins.bind(*variable, text);
            if value.can_fail() { questions.fresh() } else { Formula::All(Vec::new()) }
        }
        Condition::Not(inner) => {
            Formula::Not(Box::new(Formula::All(conjunction(inner, origins, questions))))
        }
        Condition::Any(alternatives) => {
            let branches = alternatives.branches.iter();
            let branches = branches.map(|b| Formula::All(conjunction(b, origins, questions)));
            Formula::Any(branches.collect())
        }
    }
}

/// For numbers without NaN, `<` and `==` are the only questions.
fn comparison(
    relation: Relation,
    left: &str,
    right: &str,
    ctype: &CType,
    questions: &mut Questions,
) -> Formula {
    let not = |formula| Formula::Not(Box::new(formula));
    let total = !ctype.is_float();
    match relation {
        Relation::Less => questions.named(format!("{left} < {right}")),
        Relation::Greater => questions.named(format!("{right} < {left}")),
        Relation::GreaterOrEqual if total => not(questions.named(format!("{left} < {right}"))),
        Relation::LessOrEqual if total => not(questions.named(format!("{right} < {left}"))),
        Relation::GreaterOrEqual => questions.named(format!("{right} <= {left}")),
        Relation::LessOrEqual => questions.named(format!("{left} <= {right}")),
        Relation::Equal => questions.named(format!("{left} == {right}")),
        Relation::NotEqual => not(questions.named(format!("{left} == {right}"))),
    }
}
