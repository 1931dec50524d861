//! Input of a model checker for comparing an agent's C with a second, plain translation.

use std::collections::HashSet;

use crate::GeneratedFile;

pub use crate::backend::c::{ENOUGH_ROOM, ONLY_END, ONLY_ROOM, ROOM};

/// The file of a comparison that includes all others.
pub const COMPARISON: &str = "comparison.c";

/// An agent's C, and a plain translation of the same agent beside it.
///
/// The functions `plain_base`, `plain_case_N` and `plain_interface` of [`COMPARISON`] assert that both start in
/// related states, and that a step, or another call of the environment, from any related states makes the same
/// calls and leads to related states; `plain_cover` asserts that each state is one from which some `plain_case_N`
/// starts. `main` is an execution from the start.
///
/// Other variables with static lifetime must be arbitrary in all of them but `main`, because the relation does
/// not know them. With [`ONLY_END`] defined, each but `plain_cover` must fail.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
#[must_use = "the comparison has to be proved"]
pub struct Comparison {
    /// The C of the agent first, then its headers, then [`COMPARISON`].
    pub files: Vec<GeneratedFile>,
    /// The functions `plain_case_0`, `plain_case_1`, ..: one for each event that can be the next, which is named here.
    pub cases: Vec<String>,
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
    /// If the file has preprocessor lines that the translation does not have, calls functions that are defined
    /// elsewhere, or has something else by which executions could differ without being compared.
    pub fn replace_c(&mut self, text: String) -> Result<(), Incomparable> {
        if let Some(found) = trigraph(&text) {
            return Err(found);
        }
        let own = tokens(&self.files[0].text);
        let given = tokens(&text);
        let known: HashSet<&str> = own.iter().map(|token| token.text.as_str()).collect();
        let defined = defined(&given);
        let statements = statements(&own);
        for (index, token) in given.iter().enumerate() {
            let objection = objection(&given, index, &known, &defined);
            if let Some(reason) = objection {
                return Err(Incomparable { line: token.line, found: token.text.clone(), reason });
            }
        }
        for statement in given.split(|token| matches!(token.text.as_str(), ";" | "{" | "}")) {
            let mut called = calls(statement);
            if let (Some(first), Some(_)) = (called.next(), called.next())
                && !statements.contains(&joined(statement))
            {
                let reason =
                    "C does not define in which order several calls of a statement are made";
                return Err(Incomparable { line: first.line, found: first.text.clone(), reason });
            }
        }
        self.files[0].text = text;
        Ok(())
    }
}

/// A name, number, literal, sign, or whole preprocessor line.
struct Token {
    line: usize,
    text: String,
}

impl Token {
    fn is_name(&self) -> bool {
        self.text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
    }
}

/// Words that are followed by a parenthesis without being called.
const CONTROL: [&str; 6] = ["for", "if", "return", "sizeof", "switch", "while"];

/// Words whose meaning is left to the compiler and the processor: sizes, ranges, signs, the place of bytes.
const VARYING: [&str; 8] =
    ["alignof", "enum", "long", "short", "signed", "sizeof", "union", "unsigned"];
const COMPILER: &str = "its meaning is left to the compiler and the processor";

/// Two question marks and a third character stand for another character, also in comments, but only in standard C.
fn trigraph(text: &str) -> Option<Incomparable> {
    const THIRD: [char; 9] = ['=', '/', '\'', '(', ')', '!', '<', '>', '-'];
    for (number, line) in text.lines().enumerate() {
        for (start, mark) in line.match_indices("??") {
            let third = line[start + mark.len()..].chars().next();
            if let Some(third) = third.filter(|third| THIRD.contains(third)) {
                let reason =
                    "in standard C it is another character, which could hide what is compiled";
                return Some(Incomparable {
                    line: number + 1,
                    found: format!("??{third}"),
                    reason,
                });
            }
        }
    }
    None
}

/// Whether a number of bits begins here, in the declaration of a field.
fn is_bit_field(tokens: &[Token], index: usize) -> bool {
    let text_at = |index: usize| tokens.get(index).map_or("", |token| token.text.as_str());
    let is_number = text_at(index + 1).starts_with(|c: char| c.is_ascii_digit());
    let ends = matches!(text_at(index + 2), ";" | ",");
    let mut before = tokens[..index].iter().rev().map(|token| token.text.as_str());
    let is_choice = before
        .by_ref()
        .take_while(|word| !matches!(*word, ";" | "{" | "}"))
        .any(|word| matches!(word, "?" | "case"));
    text_at(index) == ":" && is_number && ends && !is_choice
}

/// Whether a text is more than an argument or a value: compared, or the begin of a sum.
fn is_operand(tokens: &[Token], index: usize) -> bool {
    let word = |token: Option<&Token>| token.map_or(String::new(), |token| token.text.clone());
    let behind = word(tokens[index + 1..].iter().find(|token| token.text != ")"));
    let before = word(tokens[..index].iter().rev().find(|token| token.text != "("));
    let is_place = |text: &str| text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let begins =
        matches!(before.as_str(), "," | "=" | "{" | ";" | "" | "?" | ":") || is_place(&before);
    let is_compared = before == "="
        && tokens[..index]
            .iter()
            .rev()
            .filter(|token| token.text != "(")
            .nth(1)
            .is_some_and(|token| matches!(token.text.as_str(), "=" | "!" | "<" | ">"));
    let ends = matches!(behind.as_str(), "," | ";" | "}" | ":" | "");
    !begins || is_compared || !ends
}

/// Why a token must not be in a C file.
fn objection(
    tokens: &[Token],
    index: usize,
    known: &HashSet<&str>,
    defined: &HashSet<&str>,
) -> Option<&'static str> {
    const LEAVES: [&str; 5] = ["asm", "main", "register", "volatile", "extern"];
    let text_at = |index: usize| tokens.get(index).map_or("", |token| token.text.as_str());
    let word = text_at(index);
    let before = index.checked_sub(1).map_or("", text_at);
    let second = word.chars().nth(1).unwrap_or_default();
    if word == "*" && text_at(index + 1) == ")" {
        return Some("a cast of a pointer could change what must not change");
    }
    if word == "char" && before != "const" {
        return Some("a text must be constant");
    }
    if word == "{" && before == ")" && is_literal(tokens, index - 1) {
        return Some("an object without a name is not known to the comparison");
    }
    if is_bit_field(tokens, index) || (word == ">" && before == ">") {
        return Some(COMPILER);
    }
    if word.starts_with('"') && is_operand(tokens, index) {
        return Some("whether equal texts are the same object is left to the compiler");
    }
    if known.contains(word) {
        return None;
    }
    if word.starts_with('#') || word == "%:" {
        Some("the preprocessor could change what is compared")
    } else if matches!(word, "\\" | "??") {
        Some("it could hide what is compiled")
    } else if word.starts_with('_') && (second == '_' || second.is_ascii_uppercase()) {
        Some("such names belong to the compiler")
    } else if word.starts_with("plain_") || word == "plain" {
        Some("such names belong to the comparison")
    } else if LEAVES.contains(&word) {
        Some("it could do what is not compared")
    } else if VARYING.contains(&word)
        || word.starts_with('\'')
        || matches!(text_at(index + 1).chars().next(), Some('"' | '\''))
            && tokens[index].is_name()
            && word != "return"
    {
        Some(COMPILER)
    } else if tokens[index].is_name()
        && text_at(index + 1) == "("
        && !CONTROL.contains(&word)
        && !defined.contains(word)
    {
        Some("it is defined elsewhere")
    } else {
        None
    }
}

/// Whether the parenthesis that closes here is that of a type in front of a literal, and not that of a function or of
/// a control statement.
fn is_literal(tokens: &[Token], closes: usize) -> bool {
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().take(closes + 1).rev() {
        match token.text.as_str() {
            ")" => depth += 1,
            "(" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            let before = index.checked_sub(1).and_then(|before| tokens.get(before));
            return !before.is_some_and(|before| before.is_name() && before.text != "return");
        }
    }
    true
}

/// Names of the functions that are defined: a body follows their parameters.
fn defined(tokens: &[Token]) -> HashSet<&str> {
    let mut defined = HashSet::new();
    for (index, token) in tokens.iter().enumerate() {
        let mut depth = 0_usize;
        let follows = tokens[index + 1..].iter().position(|token| {
            match token.text.as_str() {
                "(" => depth += 1,
                ")" => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth == 0
        });
        let body = follows.and_then(|end| tokens.get(index + end + 2));
        let has_parameters = tokens.get(index + 1).is_some_and(|token| token.text == "(");
        if token.is_name() && has_parameters && body.is_some_and(|body| body.text == "{") {
            defined.insert(token.text.as_str());
        }
    }
    defined
}

/// The names in a statement that are called.
fn calls(statement: &[Token]) -> impl Iterator<Item = &Token> {
    statement.windows(2).filter_map(|pair| {
        let called = pair[0].is_name() && !CONTROL.contains(&pair[0].text.as_str());
        (called && pair[1].text == "(").then_some(&pair[0])
    })
}

fn statements(tokens: &[Token]) -> HashSet<String> {
    tokens.split(|token| matches!(token.text.as_str(), ";" | "{" | "}")).map(joined).collect()
}

fn joined(statement: &[Token]) -> String {
    statement.iter().map(|token| token.text.as_str()).collect::<Vec<_>>().join(" ")
}

/// The tokens of a C text, as far as they matter: comments are left out, and literals are one token.
fn tokens(text: &str) -> Vec<Token> {
    let mut tokens = Vec::new();
    let mut comment = false;
    for (number, line) in text.lines().enumerate() {
        let mut rest = line;
        let mut push = |text: &str| tokens.push(Token { line: number + 1, text: text.to_owned() });
        while let Some(first) = rest.chars().next() {
            if comment {
                let end = rest.find("*/");
                comment = end.is_none();
                rest = &rest[end.map_or(rest.len(), |end| end + 2)..];
            } else if rest.starts_with("/*") {
                comment = true;
                rest = &rest[2..];
            } else if rest.starts_with("//") {
                break;
            } else if first == '#' {
                // With all that stands before it: a comment may hide it from people.
                push(&format!("#{}", line.trim()));
                break;
            } else {
                let sign = ["%:", "??"].into_iter().find(|sign| rest.starts_with(sign));
                let length = match first {
                    '"' | '\'' => literal(rest, first),
                    _ if first.is_ascii_alphanumeric() || first == '_' => {
                        let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
                        end.unwrap_or(rest.len())
                    }
                    _ => sign.map_or(first.len_utf8(), str::len),
                };
                if !first.is_whitespace() {
                    push(&rest[..length]);
                }
                rest = &rest[length..];
            }
        }
    }
    tokens
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
            ("#define on() ((void)0)", "##define on() ((void)0)"),
            ("  #  include <stdlib.h>", "##  include <stdlib.h>"),
            ("/* x */ # /* y */ ifdef X", "#/* x */ # /* y */ ifdef X"),
            ("/**/#include \"lamp.h\"", "#/**/#include \"lamp.h\""),
            ("int sleep(int); void f(void) { sleep(1); }", "sleep"),
            ("void f(void) { say(g(), h()); }", "g"),
            ("int g(void) { return 1; } void f(int x) { f(g() + g()); }", "f"),
            ("static int *p = &(int){0};", "{"),
            ("static const int k = 0; void f(void) { *(int *)&k = 1; }", "*"),
            ("char *p = \"abc\";", "char"),
            ("%:define on off", "%:"),
            ("static int x; /* */ exit(0);", "exit"),
            ("__CPROVER_assume(false);", "__CPROVER_assume"),
            ("_Exit(1);", "_Exit"),
            ("plain_made = 0U;", "plain_made"),
            ("plain.posted = 0;", "plain"),
            ("x = 1 \\", "\\"),
            ("/* a comment\nthat ends */ abort();", "abort"),
            ("say(\"\\\"\"); asm(\"hlt\");", "asm"),
            ("// why ??/", "??/"),
            ("int x = '\\xff' < 0;", "'\\xff'"),
            ("int x = L'\\xffff' == 65535;", "L"),
            ("const char *p = L\"x\";", "L"),
            ("int x = sizeof(int);", "sizeof"),
            ("unsigned long x;", "unsigned"),
            ("union u { int a; };", "union"),
            ("int x = -1 >> 1;", ">"),
            ("struct s { int a : 3; };", ":"),
            ("int x = \"x\" == \"x\";", "\"x\""),
            ("int x = (\"x\") != p;", "\"x\""),
            ("int x = p == \"x\";", "\"x\""),
        ] {
            let text = format!("{c}{line}\n");
            let error = lamp().replace_c(text).unwrap_err();
            assert_eq!(error.found, found, "{line}");
            let lines = c.lines().count() + line.lines().count();
            assert_eq!(error.line, lines, "{line}");
        }
        for harmless in [
            "// exit(0) #",
            "/* __x */",
            "say(\"abort # *)\");",
            "static int own = 3 > 2 ? 1 : 3;",
            "// why ?? so",
            "static const char *text = (\"abort\");",
            "static int f(int x) { return x; } void g(void) { f(1); }",
        ] {
            assert_eq!(lamp().replace_c(format!("{c}{harmless}\n")), Ok(()), "{harmless}");
        }
    }
}
