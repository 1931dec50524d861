//! Makes text from outside safe to display: from a drone, a log, a plan, or a file name.
//!
//! Terminals obey control characters: text could clear the screen, change the title, or answer in the user's
//! place. Characters that change the writing direction, or are invisible, can make a line read differently
//! from what it is. Both are shown as escapes such as `\u{1b}`, so that nothing is hidden or obeyed.

use std::borrow::Cow;

/// Whether a character can be displayed as itself: not a control character, not one that changes the
/// direction or the lines of the text around it, and not an invisible one.
pub fn is_printable(character: char) -> bool {
    let invisible = matches!(
        character,
        '\u{ad}'
            | '\u{61c}'
            | '\u{180e}'
            | '\u{200b}'..='\u{200f}'
            | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{feff}'
            | '\u{fff9}'..='\u{fffb}'
            | '\u{e0000}'..='\u{e007f}'
    );
    !invisible && !character.is_control()
}

/// Escapes a text as a single line.
///
/// ```
/// use diagnostic::printable;
///
/// assert_eq!(printable("2.4.8"), "2.4.8");
/// assert_eq!(printable("2.4\x1b[2J\n"), "2.4\\u{1b}[2J\\u{a}");
/// ```
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_printable)
}

/// Like [`printable`], but keeps line feeds.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |character| character == '\n' || is_printable(character))
}

fn escaped(text: &str, is_safe: impl Fn(char) -> bool) -> Cow<'_, str> {
    if text.chars().all(&is_safe) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() * 2);
    for character in text.chars() {
        if is_safe(character) {
            safe.push(character);
        } else {
            safe.extend(character.escape_unicode());
        }
    }
    Cow::Owned(safe)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_that_is_safe_is_not_copied() {
        for text in
            ["", "goto 1 2 3 0", "plans/Fl\u{fc}ge.txt", "\u{65e5}\u{672c}", "e\u{301}", "90\u{b0}"]
        {
            assert!(matches!(printable(text), Cow::Borrowed(same) if same == text), "{text}");
        }
    }

    #[test]
    fn what_is_obeyed_or_hidden_is_shown_by_its_code() {
        for (text, shown) in [
            ("\x1b]0;title\x07", "\\u{1b}]0;title\\u{7}"),
            ("\u{9b}31m", "\\u{9b}31m"),
            ("a\rb\x08\x7f", "a\\u{d}b\\u{8}\\u{7f}"),
            ("1.0\u{202e}txt.", "1.0\\u{202e}txt."),
            ("\u{2066}\u{200b}\u{feff}\u{2028}", "\\u{2066}\\u{200b}\\u{feff}\\u{2028}"),
            ("\u{e0041}", "\\u{e0041}"),
        ] {
            assert_eq!(printable(text), shown);
            assert_eq!(printable_lines(text), shown);
        }
        assert_eq!(printable("a\n"), "a\\u{a}");
        assert_eq!(printable_lines("a\nb\t"), "a\nb\\u{9}");
    }
}
