//! Position of a belief's value among the numbers with which properties compare it.
//!
//! The numbers divide the line into regions: below the first, the first itself, between the first and the
//! second, and so on. The model remembers the region, and only while it checks one of those properties. A
//! comparison with one of these numbers is then determined; one with another number is nondeterministic where
//! the region has values on both sides of it.

use std::cmp::Ordering;
use std::ops::RangeInclusive;

use super::logic::or;
use crate::analysis::constants::{float, integer};
use crate::program::Value;
use crate::syntax::ast::Relation;

/// An exact number. All numbers of a scale are of one kind.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(super) enum Number {
    Integer(i128),
    Float(f64),
}

impl Number {
    /// The value of a constant.
    pub(super) fn of(value: &Value) -> Option<Self> {
        integer(value).map(Self::Integer).or_else(|| float(value).map(Self::Float))
    }
}

/// A belief, and the numbers that properties compare it with.
pub(super) struct Scale {
    belief: String,
    /// In ascending order.
    marks: Vec<Number>,
    /// The properties with these numbers.
    properties: Vec<usize>,
}

impl Scale {
    pub(super) fn new(belief: &str, property: usize, mark: Number) -> Self {
        Self { belief: belief.to_owned(), marks: vec![mark], properties: vec![property] }
    }

    /// Adds a comparison by another property.
    pub(super) fn add(&mut self, property: usize, mark: Number) {
        self.properties.push(property);
        if let Some(place) = self.marks.iter().position(|other| *other >= mark) {
            if self.marks[place] != mark {
                self.marks.insert(place, mark);
            }
        } else {
            self.marks.push(mark);
        }
    }

    pub(super) fn belief(&self) -> &str {
        &self.belief
    }

    /// The variable of the model that holds the region.
    pub(super) fn variable(&self) -> String {
        format!("region_{}", self.belief)
    }

    /// Whether the region is remembered, as an expression.
    pub(super) fn followed(&self) -> String {
        is_checked(&self.properties)
    }

    /// Numbers of the regions. The last one is for NaN.
    pub(super) fn regions(&self) -> RangeInclusive<usize> {
        let numbers = 2 * self.marks.len();
        let last = if matches!(self.marks[0], Number::Float(_)) { numbers + 1 } else { numbers };
        0..=last
    }

    /// The region of a constant.
    pub(super) fn region(&self, value: &Value) -> usize {
        let Some(number) = Number::of(value) else { return 0 };
        let below = self.marks.iter().take_while(|mark| **mark < number).count();
        if self.marks.get(below) == Some(&number) { 2 * below + 1 } else { 2 * below }
    }

    /// Expressions: when `value relation number` can hold, and when it can fail.
    pub(super) fn outcomes(&self, relation: Relation, number: Number) -> (String, String) {
        let when = |wanted: bool| {
            let can =
                |region: &usize| self.orders(*region, number).any(|o| holds(relation, o) == wanted);
            let free = format!("!{}", self.followed());
            or(&std::iter::once(free).chain(self.any_of(can)).collect::<Vec<_>>())
        };
        (when(true), when(false))
    }

    /// When `value relation mark` holds for one of the marks, as an expression.
    pub(super) fn holds(&self, relation: Relation, mark: Number) -> String {
        let holds = |region: &usize| self.orders(*region, mark).all(|o| holds(relation, o));
        or(&self.any_of(holds).collect::<Vec<_>>())
    }

    fn any_of(&self, wanted: impl Fn(&usize) -> bool) -> impl Iterator<Item = String> {
        let variable = self.variable();
        self.regions().filter(wanted).map(move |region| format!("{variable} == {region}"))
    }

    /// Possible orders of values of a region and a number; `None` for NaN.
    fn orders(&self, region: usize, number: Number) -> impl Iterator<Item = Option<Ordering>> {
        let mark = |index: usize| self.marks.get(index).and_then(|m| m.partial_cmp(&number));
        let orders = if region > 2 * self.marks.len() {
            vec![None]
        } else if region % 2 == 1 {
            vec![mark(region / 2)]
        } else {
            // The open interval between two marks.
            let above = region / 2;
            let below = above.checked_sub(1).and_then(mark);
            let less = !matches!(below, Some(Ordering::Greater | Ordering::Equal));
            let greater = !matches!(mark(above), Some(Ordering::Less | Ordering::Equal));
            let possible = [
                (less, Ordering::Less),
                (less && greater, Ordering::Equal),
                (greater, Ordering::Greater),
            ];
            possible.into_iter().filter(|(can, _)| *can).map(|(_, order)| Some(order)).collect()
        };
        orders.into_iter()
    }
}

/// Whether values in this order satisfy a relation; NaN satisfies only `\==`.
fn holds(relation: Relation, order: Option<Ordering>) -> bool {
    match relation {
        Relation::Less => order == Some(Ordering::Less),
        Relation::LessOrEqual => matches!(order, Some(Ordering::Less | Ordering::Equal)),
        Relation::Greater => order == Some(Ordering::Greater),
        Relation::GreaterOrEqual => matches!(order, Some(Ordering::Greater | Ordering::Equal)),
        Relation::Equal => order == Some(Ordering::Equal),
        Relation::NotEqual => order != Some(Ordering::Equal),
    }
}

/// Whether one of these properties is checked, as an expression.
pub(super) fn is_checked(properties: &[usize]) -> String {
    let checked: Vec<String> =
        properties.iter().map(|number| format!("checked == {number}")).collect();
    format!("({})", checked.join(" || "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(marks: &[Number]) -> Scale {
        let mut scale = Scale::new("b", 1, marks[0]);
        marks[1..].iter().for_each(|mark| scale.add(2, *mark));
        scale
    }

    /// The regions in which a comparison can hold, and those in which it can fail.
    fn outcomes(scale: &Scale, relation: Relation, number: Number) -> [String; 2] {
        let (holds, fails) = scale.outcomes(relation, number);
        let regions = |text: &str| {
            let digits = text.split("region_b == ").skip(1).filter_map(|part| part.chars().next());
            digits.collect::<String>()
        };
        [regions(&holds), regions(&fails)]
    }

    #[test]
    fn a_comparison_with_a_mark_comes_out_as_it_must() {
        let integers = scale(&[Number::Integer(20), Number::Integer(12), Number::Integer(20)]);
        assert_eq!(integers.regions(), 0..=4);
        let at = |relation, number| outcomes(&integers, relation, Number::Integer(number));
        assert_eq!(at(Relation::LessOrEqual, 12), ["01", "234"]);
        assert_eq!(at(Relation::Greater, 20), ["4", "0123"]);
        assert_eq!(at(Relation::Equal, 20), ["3", "0124"]);
        // Values between 12 and 20 may be below 15 or not.
        assert_eq!(at(Relation::Less, 15), ["012", "234"]);
        assert_eq!(at(Relation::GreaterOrEqual, 5), ["01234", "0"]);
        assert_eq!(
            integers.holds(Relation::GreaterOrEqual, Number::Integer(20)),
            "(region_b == 3 || region_b == 4)"
        );
    }

    #[test]
    fn what_is_no_number_is_only_unequal() {
        let floats = scale(&[Number::Float(3.0)]);
        assert_eq!(floats.regions(), 0..=3);
        let at = |relation, number| outcomes(&floats, relation, Number::Float(number));
        assert_eq!(at(Relation::Greater, 3.0), ["2", "013"]);
        assert_eq!(at(Relation::LessOrEqual, 3.0), ["01", "23"]);
        assert_eq!(at(Relation::NotEqual, 3.0), ["023", "1"]);
        let value =
            |text: &str| Value::Constant(text.to_owned(), crate::types::CType::named("double"));
        assert_eq!(["2.5", "3.0", "3.5"].map(|text| floats.region(&value(text))), [0, 1, 2]);
    }
}
