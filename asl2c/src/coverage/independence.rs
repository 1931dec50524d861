//! Modified condition/decision coverage (MC/DC): each condition is shown to change the outcome of its decision, while
//! the others stay the same or are not evaluated.

use super::gcov::{Counts, Share};

/// MC/DC of a file of C, derived from the outcomes of its conditions.
///
/// A decision of one condition has it if both outcomes were seen. So has a chain of `&&`, or of `||`, if both outcomes
/// of each condition were seen, because the next condition is evaluated only if those before do not decide
/// (Chilenski, "An Investigation of Three Forms of the Modified Condition Decision Coverage (MCDC) Criterion", 2001).
/// Of other decisions, the outcomes do not tell: they count as not shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Independence {
    /// Conditions.
    pub conditions: Share,
    /// Of those that are not shown: conditions in a mixture of `&&` and `||`.
    pub mixed: usize,
}

impl Independence {
    /// Of a file's counts and text.
    pub(super) fn new(counts: &Counts, text: &str) -> Self {
        let mut found = Self::default();
        let lines: Vec<&str> = text.lines().collect();
        for counted in &counts.lines {
            let line = lines.get(counted.line.saturating_sub(1)).copied().unwrap_or_default();
            let outcomes = counted.outcomes();
            // A selection has a value, not conditions.
            if outcomes.all == 0 || line.trim_start().starts_with("switch") {
                continue;
            }
            let conditions = outcomes.all / 2;
            let is_mixed = line.contains("&&") && line.contains("||");
            let shown = outcomes.is_whole() && !is_mixed;
            (0..conditions).for_each(|_| found.conditions.count(shown));
            found.mixed += if is_mixed { conditions } else { 0 };
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_whole_chains_show_their_conditions() {
        let line = |number: usize, counts: &[u64]| {
            let branches: Vec<String> =
                counts.iter().map(|count| format!(r#"{{ "count": {count} }}"#)).collect();
            format!(
                r#"{{ "line_number": {number}, "count": 1, "branches": [{}] }}"#,
                branches.join(", ")
            )
        };
        let text = "if (a)\nif (b)\nif (a && b)\nok = (a && b) || c;\nswitch (a)\n";
        let lines = [
            line(1, &[1, 1]),
            line(2, &[1, 0]),
            line(3, &[1, 1, 1, 1]),
            line(4, &[1, 1, 1, 1, 1, 1]),
            line(5, &[1, 1, 0]),
        ];
        let json =
            format!(r#"{{ "files": [{{ "file": "a.c", "lines": [{}] }}] }}"#, lines.join(", "));
        let counts = Counts::parse(&json, "a.c").unwrap();
        let found = Independence::new(&counts, text);
        assert_eq!(found.conditions.to_string(), "3 of 7");
        assert_eq!(found.mixed, 3);
    }
}
