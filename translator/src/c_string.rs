//! Texts as constants of C.

use std::fmt::Write as _;

/// A string constant of C: printable ASCII is copied, everything else becomes octal escapes, so that no trigraph, comment
/// or source encoding can change it. So does a digit behind such an escape: a C compiler takes three digits, but CBMC 6.6
/// takes all that follow, and would prove of another text.
pub(crate) fn c_string(text: &str) -> String {
    let mut out = String::from("\"");
    let mut escaped = false;
    for byte in text.bytes() {
        let was_escaped = std::mem::take(&mut escaped);
        match byte {
            b'"' => out.push_str("\\\""),
            b'\\' => out.push_str("\\\\"),
            b'\n' => out.push_str("\\n"),
            b'\t' => out.push_str("\\t"),
            b'?' => out.push_str("\\?"),
            b' '..=b'~' if !(was_escaped && byte.is_ascii_digit()) => out.push(char::from(byte)),
            _ => {
                // Writing to a string cannot fail.
                _ = write!(out, "\\{byte:03o}");
                escaped = true;
            }
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_digit_stands_behind_an_escape() {
        assert_eq!(c_string("a\"?\\\n\t\u{e9}19b2"), r#""a\"\?\\\n\t\303\251\061\071b2""#);
    }
}
