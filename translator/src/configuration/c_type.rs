//! Syntax of types in the configuration.

use super::scanner::Parsed;
use crate::code::Code;
use crate::reserved::is_c_word;
use crate::syntax::ast::Name;
use crate::types::{C_NUMBERS, CType, TypeKind};

/// Refuses what is no type, and types that the translator does not know or that C does not allow for a parameter, a result or
/// a field. `words` are the words of the type and its stars.
pub(super) fn check_type(words: &[Name]) -> Parsed<()> {
    let (Some(first), Some(last)) = (words.first(), words.last()) else { return Ok(()) };
    let span = first.span.start..last.span.end;
    let error =
        |message: &str, help: &str| Err(Code::NotAType.at(message, span.clone()).help(help));
    let stars = words.iter().position(|word| word.text == "*").unwrap_or(words.len());
    let (base, pointer) = words.split_at(stars);
    if pointer.iter().any(|word| word.text != "*") {
        return error(
            "not a type",
            "the translator knows `name`, `struct name`, `const name *` and numbers",
        );
    }
    let is_const = |word: &&Name| word.text == "const";
    let constant = base.iter().filter(is_const).count();
    if constant > 0 && pointer.is_empty() {
        return error(
            "`const` has no effect on a value",
            "values are passed by copy: remove `const`",
        );
    }
    let base: Vec<&str> =
        base.iter().filter(|word| !is_const(word)).map(|word| word.text.as_str()).collect();
    let known = match base.as_slice() {
        ["struct" | "union" | "enum", name] => !is_c_word(name),
        ["void"] => true,
        [name] if C_NUMBERS.contains(name) || *name == "_Bool" => true,
        [name] => {
            !is_c_word(name)
                || CType::named(name).kind != TypeKind::Opaque
                || name.ends_with("_t")
                || *name == "FILE"
        }
        several => is_number(several),
    };
    if !known || constant > 1 {
        return error("not a type", "a parameter is written without its name: `int`, not `int x`");
    }
    Ok(())
}

/// Whether these words are a numeric type in C.
fn is_number(words: &[&str]) -> bool {
    const KNOWN: [&str; 18] = [
        "short int",
        "signed short",
        "signed short int",
        "unsigned short",
        "unsigned short int",
        "signed int",
        "unsigned int",
        "signed char",
        "unsigned char",
        "long int",
        "signed long",
        "signed long int",
        "unsigned long",
        "unsigned long int",
        "long long",
        "long long int",
        "unsigned long long",
        "long double",
    ];
    let text = words.join(" ");
    let rarer = ["signed long long", "signed long long int", "unsigned long long int"];
    KNOWN.contains(&text.as_str()) || rarer.contains(&text.as_str())
}

/// The type with these words, which [`check_type`] has accepted.
pub(super) fn c_type(words: &[Name]) -> CType {
    let words: Vec<&str> = words.iter().map(|word| word.text.as_str()).collect();
    CType::named(&words.join(" "))
}
