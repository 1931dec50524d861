//! Expressions over the state of the model, simplified where an operand is constant.

/// Two expressions over the state of the model. Both can be true: then the choice is nondeterministic.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Choice {
    pub(super) holds: String,
    pub(super) fails: String,
}

impl Choice {
    pub(super) fn free() -> Self {
        Self { holds: "true".to_owned(), fails: "true".to_owned() }
    }

    pub(super) fn certain() -> Self {
        Self { holds: "true".to_owned(), fails: "false".to_owned() }
    }

    pub(super) fn when(condition: String) -> Self {
        let fails = not(&condition);
        Self { holds: condition, fails }
    }

    pub(super) fn not(self) -> Self {
        Self { holds: self.fails, fails: self.holds }
    }

    pub(super) fn all(parts: Vec<Self>) -> Self {
        let (holds, fails): (Vec<_>, Vec<_>) =
            parts.into_iter().map(|part| (part.holds, part.fails)).unzip();
        Self { holds: and(&holds), fails: or(&fails) }
    }

    pub(super) fn any(parts: Vec<Self>) -> Self {
        Self::all(parts.into_iter().map(Self::not).collect()).not()
    }
}

/// The conjunction, without operands that are always true.
pub(super) fn and(parts: &[String]) -> String {
    joined(parts, "&&", "true", "false")
}

/// The disjunction, without operands that are always false.
pub(super) fn or(parts: &[String]) -> String {
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

/// The negation of an atomic or parenthesised expression.
pub(super) fn not(condition: &str) -> String {
    match condition {
        "true" => "false".to_owned(),
        "false" => "true".to_owned(),
        other => format!("!{other}"),
    }
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
