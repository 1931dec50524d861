//! Headers of an agent's own: only types, data and functions are declared there, and the same for every compiler.
//!
//! Such a header is compiled as it is, before the C that is judged. Its values are not looked at: the judged C knows only the
//! names of its types. But nothing in it may depend on who reads it, or change the meaning of what follows.

use std::collections::HashSet;
use std::hash::BuildHasher;

use crate::lexer::{Kind, Place, Token, header_tokens};
use crate::refused::{Refused, Rule};
use crate::types::basic;

/// Words of C that may stand in declarations.
const WORDS: [&str; 29] = [
    "_Bool",
    "bool",
    "char",
    "const",
    "double",
    "enum",
    "extern",
    "float",
    "int",
    "long",
    "short",
    "signed",
    "sizeof",
    "static",
    "struct",
    "typedef",
    "union",
    "unsigned",
    "void",
    "volatile",
    "true",
    "false",
    "NULL",
    "FILE",
    "size_t",
    "ptrdiff_t",
    "wchar_t",
    "sig_atomic_t",
    "max_align_t",
];
/// Signs of constants.
const SIGNS: [&str; 20] = [
    "(", ")", "+", "-", "*", "/", "%", "<", ">", "<=", ">=", "==", "!=", "&", "&&", "||", "!", "|",
    "~", "^",
];

type Judged<T> = Result<T, Refused>;

/// Judges a header of the agent's own. `used` are the words of the generated files.
///
/// # Errors
/// If something in it is more than a declaration: the first one, with its place.
pub fn judge_header<S: BuildHasher>(text: &str, used: &HashSet<String, S>) -> Judged<()> {
    let tokens = header_tokens(text, Place { line: 1, column: 1 })?;
    let tokens = without_guard(without_other_language(tokens)?)?;
    let mut item: Vec<Token<'_>> = Vec::new();
    let mut open: Vec<&str> = Vec::new();
    for token in tokens {
        match token.kind {
            Kind::Line if item.is_empty() => {
                directive(&token)?;
                continue;
            }
            Kind::Line => return Err(token.refused(Rule::Directive)),
            Kind::End if item.is_empty() => break,
            Kind::End => return Err(token.refused(Rule::Header)),
            Kind::Name => word(&token)?,
            Kind::Sign => match token.text {
                // The body of a function, or a statement as a value.
                "{" if item.last().is_some_and(|last| matches!(last.text, ")" | "(")) => {
                    return Err(token.refused(Rule::Header));
                }
                "{" => open.push("}"),
                "(" => open.push(")"),
                "[" => open.push("]"),
                "}" | ")" | "]" if open.pop() != Some(token.text) => {
                    return Err(token.refused(Rule::Header));
                }
                _ => {}
            },
            Kind::Integer | Kind::Float | Kind::Text => {}
        }
        if item.is_empty() && token.kind != Kind::Name {
            return Err(token.refused(Rule::Header));
        }
        item.push(token);
        if open.is_empty() && token.text == ";" {
            declared(&item, used)?;
            item.clear();
        }
    }
    Ok(())
}

/// The words of a preprocessor line.
fn words<'a>(line: &Token<'a>) -> Judged<Vec<Token<'a>>> {
    let place = Place { column: line.place.column + 1, ..line.place };
    let mut words = header_tokens(&line.text[1..], place)?;
    // The end.
    words.pop();
    Ok(words)
}

/// The name in a line with these two words.
fn named<'a>(line: &Token<'a>, directive: &str) -> Option<&'a str> {
    match words(line).ok()?.as_slice() {
        [first, name] if first.text == directive && name.kind == Kind::Name => Some(name.text),
        _ => None,
    }
}

fn is_line(token: &Token<'_>, directive: &str) -> bool {
    let first =
        words(token).ok().and_then(|words| words.first().map(|word| word.text == directive));
    token.kind == Kind::Line && first == Some(true)
}

/// Without what is only of C++, which no compiler of C reads: `extern "C" {` and `}`.
fn without_other_language(tokens: Vec<Token<'_>>) -> Judged<Vec<Token<'_>>> {
    let mut left = Vec::new();
    let mut begun = None;
    for token in tokens {
        let begins = token.kind == Kind::Line && named(&token, "ifdef") == Some("__cplusplus");
        match begun {
            None if begins => begun = Some(token),
            None => left.push(token),
            Some(_) if is_line(&token, "endif") => begun = None,
            Some(_) if token.kind == Kind::Line => return Err(token.refused(Rule::Directive)),
            Some(begun) if token.kind == Kind::End => return Err(begun.refused(Rule::Directive)),
            Some(_) => {}
        }
    }
    Ok(left)
}

/// Without a guard against double inclusion around all of it.
fn without_guard(mut tokens: Vec<Token<'_>>) -> Judged<Vec<Token<'_>>> {
    let [first, second, .., last, end] = tokens.as_slice() else { return Ok(tokens) };
    let Some(name) =
        Some(first).filter(|line| line.kind == Kind::Line).and_then(|line| named(line, "ifndef"))
    else {
        return Ok(tokens);
    };
    let end = *end;
    let is_defined = second.kind == Kind::Line && named(second, "define") == Some(name);
    // Any other name with an underscore is, or could be, known to one compiler and not to another one.
    let is_guard = !name.starts_with('_') || name.to_uppercase().contains("_H");
    if !is_defined || !is_guard || !is_line(last, "endif") {
        return Err(first.refused(Rule::Directive));
    }
    tokens.drain(..2);
    tokens.truncate(tokens.len() - 2);
    tokens.push(end);
    Ok(tokens)
}

fn directive(line: &Token<'_>) -> Judged<()> {
    let refused = || line.refused(Rule::Directive);
    let rest = line.text[1..].trim_start();
    if let Some(name) = rest.strip_prefix("include") {
        let name = name.trim_start();
        let ends = [('<', '>'), ('"', '"')].iter().any(|(begin, end)| {
            let inside = name.strip_prefix(*begin).and_then(|name| name.strip_suffix(*end));
            inside.is_some_and(|inside| !inside.contains(['<', '>', '"', '\\']))
        });
        return if ends { Ok(()) } else { Err(refused()) };
    }
    let words = words(line)?;
    match words.as_slice() {
        [pragma, once] if pragma.text == "pragma" && once.text == "once" => Ok(()),
        [define, name, value @ ..] if define.text == "define" && name.kind == Kind::Name => {
            let is_constant = |token: &&Token<'_>| match token.kind {
                Kind::Integer | Kind::Float | Kind::Text => true,
                Kind::Name => !translator::is_c_word(token.text),
                Kind::Sign => SIGNS.contains(&token.text),
                Kind::Line | Kind::End => false,
            };
            // With a bracket directly behind its name, it has parameters.
            let behind = name.place.column as usize + name.text.len();
            let is_call = value
                .first()
                .is_some_and(|first| first.text == "(" && first.place.column as usize == behind);
            if is_call || translator::is_c_word(name.text) {
                return Err(name.refused(Rule::Define));
            }
            match value.iter().find(|token| !is_constant(token)) {
                Some(other) => Err(other.refused(Rule::Define)),
                None => Ok(()),
            }
        }
        _ => Err(refused()),
    }
}

/// The word has no other effect than to declare something.
fn word(token: &Token<'_>) -> Judged<()> {
    let is_known = WORDS.contains(&token.text) || basic(token.text).is_some();
    let is_type = token.text.ends_with("_t") && !token.text.starts_with('_');
    if is_known || is_type || !translator::is_c_word(token.text) {
        Ok(())
    } else {
        Err(token.refused(Rule::Header))
    }
}

/// The names that a declaration gives are no others' names.
fn declared<S: BuildHasher>(item: &[Token<'_>], used: &HashSet<String, S>) -> Judged<()> {
    let is_type = item.first().is_some_and(|first| first.text == "typedef");
    let mut depth = 0_u32;
    for pair in item.windows(2) {
        let [name, next] = pair else { continue };
        match name.text {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth = depth.saturating_sub(1),
            _ => {}
        }
        let is_named = name.kind == Kind::Name
            && depth == 0
            && matches!(next.text, ";" | "," | "=" | "[" | "(");
        // A type that the agent's functions have is declared for them.
        let of_c = translator::is_c_word(name.text) && !WORDS.contains(&name.text);
        let taken = if is_type { of_c } else { used.contains(name.text) };
        if is_named && taken {
            return Err(name.refused(Rule::Used));
        }
    }
    Ok(())
}
