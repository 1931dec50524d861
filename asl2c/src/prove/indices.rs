//! Indices that are checked against the array itself.
//!
//! CBMC 6 checks an index of an array in a struct that a pointer leads to against the end of the whole struct: `p->q[1]` of an
//! `int q[1]` before another member is right for it. In C of the judged language the printer writes the check. The C of the
//! proofs is the translator's, whose lines are told: there the check is written into the text.

use std::fmt::Write as _;

use judged_c::CHECKED_INDEX;

/// The C, with the same lines, in which each index of an array behind a pointer is checked.
pub(super) fn with_checked_indices(c: &str) -> String {
    let mut text = format!("{CHECKED_INDEX} ");
    // The arrays of the open brackets.
    let mut open: Vec<Option<String>> = Vec::new();
    let mut rest = c;
    while let Some(next) = rest.chars().next() {
        let (part, behind) = rest.split_at(passed_over(rest).unwrap_or(next.len_utf8()));
        rest = behind;
        if part == "]"
            && let Some(Some(array)) = open.pop()
        {
            // Writing to a string cannot fail.
            _ = write!(text, ", sizeof ({array}) / sizeof ({array}[0]))");
        }
        text.push_str(part);
        if part == "[" {
            let array = array_behind_pointer(&text[..text.len() - 1]);
            text.push_str(if array.is_some() { "plain_index(" } else { "" });
            open.push(array);
        }
    }
    text
}

/// The array behind a pointer that a text ends with, `self->inbox_queue`.
fn array_behind_pointer(text: &str) -> Option<String> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "_->.".contains(c);
    let array = &text[text.trim_end_matches(is_part).len()..];
    array.contains("->").then(|| array.to_owned())
}

/// The length of a comment or quoted text at the begin.
fn passed_over(text: &str) -> Option<usize> {
    if let Some(comment) = text.strip_prefix("/*") {
        return Some(comment.find("*/").map_or(text.len(), |end| end + 4));
    }
    if text.starts_with("//") {
        return Some(text.find('\n').unwrap_or(text.len()));
    }
    let quote = text.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let mut is_escaped = false;
    let end = text[1..].find(|c| {
        let ends = c == quote && !is_escaped;
        is_escaped = c == '\\' && !is_escaped;
        ends
    });
    Some(end.map_or(text.len(), |end| end + 2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_behind_pointers_are_checked() {
        let of = |array: &str| format!("sizeof ({array}) / sizeof ({array}[0])");
        for (c, expected) in [
            ("x = self->q[i];\n", format!("x = self->q[plain_index(i, {})];\n", of("self->q"))),
            (
                "f(p->a[p->b[1]], 2)",
                format!(
                    "f(p->a[plain_index(p->b[plain_index(1, {})], {})], 2)",
                    of("p->b"),
                    of("p->a")
                ),
            ),
            ("int q[2]; q[i] = agent.q[i];", "int q[2]; q[i] = agent.q[i];".to_owned()),
            ("/* self->q[i] */ // p->q[\n", "/* self->q[i] */ // p->q[\n".to_owned()),
            (r#"f("\"p->q[", ']');"#, r#"f("\"p->q[", ']');"#.to_owned()),
        ] {
            assert_eq!(with_checked_indices(c), format!("{CHECKED_INDEX} {expected}"));
        }
        assert_eq!(with_checked_indices("a\nb\n").lines().count(), 2);
    }
}
