//! Input of a model checker for comparing an agent's C with a second, plain translation.

use std::collections::HashSet;

use crate::GeneratedFile;

pub use crate::backend::c::{END, ENOUGH_ROOM, ROOM};

/// The file of a comparison that includes all others.
pub const COMPARISON: &str = "comparison.c";

/// An agent's C, and a plain translation of the same agent beside it.
///
/// The functions `base`, `step_N` and `interface` of [`COMPARISON`] assert that both start in related states,
/// and that a step, or another call of the environment, from any related states makes the same calls and
/// leads to related states; `cover` asserts that each state is one from which some `step_N` starts. `main` is
/// an execution from the start.
///
/// Other variables with static lifetime must be arbitrary in all of them but `main`, because the relation does
/// not know them. The assertion [`END`] must fail in all but `cover`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "the comparison has to be proved"]
pub struct Comparison {
    /// The C of the agent first, then its headers, then [`COMPARISON`].
    pub files: Vec<GeneratedFile>,
    /// Number of the functions `step_0`, `step_1`, ..: one for each event that can be the next.
    pub steps: usize,
    /// A bound for all loops of the functions, but for that of `main`.
    pub unwinding: usize,
}

/// C that a model checker could misjudge.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: `{found}` cannot be judged: {reason}")]
#[non_exhaustive]
pub struct Incomparable {
    /// The line, counted from 1.
    pub line: usize,
    /// The word or line.
    pub found: String,
    /// Why it cannot be judged.
    pub reason: &'static str,
}

impl Comparison {
    /// Judges another C file in place of the translation.
    ///
    /// # Errors
    /// If the file has preprocessor lines that the translation does not have, or names with which C ends or leaves a
    /// program, or speaks to its compiler or to the comparison: executions that end early would not be compared.
    pub fn replace_c(&mut self, text: String) -> Result<(), Incomparable> {
        let known: HashSet<String> = words(&self.files[0].text).map(|(_, word)| word).collect();
        for (line, found) in words(&text).filter(|(_, word)| !known.contains(word)) {
            if let Some(reason) = objection(&found) {
                return Err(Incomparable { line, found, reason });
            }
        }
        self.files[0].text = text;
        Ok(())
    }
}

/// Why a word must not be in a C file.
fn objection(word: &str) -> Option<&'static str> {
    const LEAVES: [&str; 9] =
        ["abort", "asm", "assert", "exit", "longjmp", "main", "quick_exit", "setjmp", "signal"];
    let second = word.chars().nth(1).unwrap_or_default();
    if word.starts_with('#') || word == "%:" {
        Some("the preprocessor could change what is compared")
    } else if matches!(word, "\\" | "??") {
        Some("it could hide what is compiled")
    } else if word.starts_with('_') && (second == '_' || second.is_ascii_uppercase()) {
        Some("such names belong to the compiler")
    } else if word.starts_with("plain_") || word == "plain" {
        Some("such names belong to the comparison")
    } else if LEAVES.contains(&word) {
        Some("it could leave the program")
    } else {
        None
    }
}

/// The names, preprocessor lines and suspicious signs of a C text, with their lines; comments and literals are left
/// out.
fn words(text: &str) -> impl Iterator<Item = (usize, String)> {
    let mut words = Vec::new();
    let mut comment = false;
    for (number, line) in text.lines().enumerate() {
        let mut rest = line;
        if !comment && line.trim_start().starts_with('#') {
            words.push((number + 1, line.trim().to_owned()));
            continue;
        }
        while let Some(first) = rest.chars().next() {
            if comment {
                let end = rest.find("*/").map_or(rest.len(), |end| end + 2);
                comment = !rest[..end].ends_with("*/");
                rest = &rest[end..];
            } else if rest.starts_with("/*") {
                comment = true;
                rest = &rest[2..];
            } else if rest.starts_with("//") {
                break;
            } else if first == '"' || first == '\'' {
                rest = &rest[literal(rest, first)..];
            } else if first.is_ascii_alphabetic() || first == '_' {
                let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
                let end = end.unwrap_or(rest.len());
                words.push((number + 1, rest[..end].to_owned()));
                rest = &rest[end..];
            } else {
                let sign = ["%:", "??", "\\"].into_iter().find(|sign| rest.starts_with(sign));
                words.extend(sign.map(|sign| (number + 1, sign.to_owned())));
                rest = &rest[first.len_utf8()..];
            }
        }
    }
    words.into_iter()
}

/// Length of a literal that begins with this quote, at most to the end of the line.
fn literal(text: &str, quote: char) -> usize {
    let mut escaped = false;
    for (index, character) in text.char_indices().skip(1) {
        if !escaped && character == quote {
            return index + 1;
        }
        escaped = !escaped && character == '\\';
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{comparison, parse_configuration};

    const LAMP: &str =
        "settings { input = a.asl; output = lamp.c; header = lamp.h; basics = b.h; };
        basics { void on(void); void say(const char *); }; types { light(void); }; triggerables { +!light; };";

    fn lamp() -> Comparison {
        let configuration = parse_configuration("a.conf", LAMP).unwrap();
        comparison(&configuration, "+!light <- on; say(\"exit # \\\\ \").").unwrap()
    }

    #[test]
    fn the_translation_itself_can_be_judged() {
        let mut lamp = lamp();
        let c = lamp.files[0].text.clone();
        assert_eq!(lamp.replace_c(c), Ok(()));
    }

    #[test]
    fn what_could_hide_something_is_refused_with_its_line() {
        let c = lamp().files[0].text.clone();
        for (line, found) in [
            ("#define on() ((void)0)", "#define on() ((void)0)"),
            ("  #  include <stdlib.h>", "#  include <stdlib.h>"),
            ("%:define on off", "%:"),
            ("static int x; /* */ exit(0);", "exit"),
            ("__CPROVER_assume(false);", "__CPROVER_assume"),
            ("_Exit(1);", "_Exit"),
            ("plain_made = 0U;", "plain_made"),
            ("plain.posted = 0;", "plain"),
            ("x = 1 \\", "\\"),
            ("/* a comment\nthat ends */ abort();", "abort"),
            ("say(\"\\\"\"); asm(\"hlt\");", "asm"),
        ] {
            let text = format!("{c}{line}\n");
            let error = lamp().replace_c(text).unwrap_err();
            assert_eq!(error.found, found, "{line}");
            let lines = c.lines().count() + line.lines().count();
            assert_eq!(error.line, lines, "{line}");
        }
        for harmless in
            ["// exit(0) #", "/* __x */", "say(\"abort\");", "static int own; own = '\\'';"]
        {
            assert_eq!(lamp().replace_c(format!("{c}{harmless}\n")), Ok(()), "{harmless}");
        }
    }
}
