//! A system's text to lines.

use super::WIDTH;
use super::comments::Gap;
use super::lines::{Lines, Separator};
use crate::configuration::scanner::{Scanner, is_word};

/// Columns of entries, and of the continued lines of an entry.
const ENTRY: usize = 2;
const CONTINUED: usize = 4;

/// Role of a token in a text without errors, which decides what is between it and the token before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// The name of a section.
    Section,
    /// First token of an entry.
    Entry,
    /// The end of a section.
    End,
    /// First token of an argument, except the first one.
    Argument,
    /// A token with a blank before it.
    Apart,
    /// A token without a blank before it.
    Close,
}

/// A token, with what is before it.
#[derive(Debug)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    pub(super) gap: Gap<'a>,
    role: Role,
    /// Its column if it begins a line.
    indent: usize,
}

impl Token<'_> {
    /// Whether the author breaks the line before this token of a section, and may.
    fn is_broken(&self) -> bool {
        let is_inside = self.indent > 0;
        let may_be = matches!(self.role, Role::Entry | Role::End | Role::Argument);
        self.gap.is_broken() && (may_be || is_inside && !self.gap.comments.is_empty())
    }

    /// Number of its characters, with the comments and the blank before it.
    fn width(&self) -> usize {
        let blank = usize::from(self.role != Role::Close);
        blank + self.gap.width() + self.text.chars().count()
    }
}

/// The tokens of a text without errors, and what is behind the last one.
pub(super) fn tokens(text: &str) -> (Vec<Token<'_>>, Gap<'_>) {
    let mut scanner = Scanner { text, position: 0 };
    scanner.take("\u{feff}");
    let mut tokens: Vec<Token<'_>> = Vec::new();
    let (mut is_in_section, mut is_in_tags, mut is_in_agents) = (false, false, false);
    let mut before = "";
    let mut last = 0;
    // All comments are closed.
    while scanner.skip_blanks().is_ok()
        && let Some(first) = scanner.rest().chars().next()
    {
        let start = scanner.position;
        let rest = scanner.rest();
        let is_path = is_in_agents && before == ":";
        let length = if is_path {
            // As it is read: whatever else is in the line belongs to the path.
            rest[..rest.find([';', '}', '\n']).unwrap_or(rest.len())].trim_end().len()
        } else {
            let is_tag = |c| is_in_tags && "-.".contains(c);
            rest.find(|c| !(is_word(c) || is_tag(c))).unwrap_or(rest.len())
        };
        scanner.position += length.max(first.len_utf8());
        let text = &text[start..scanner.position];
        let role = match (before, text) {
            _ if is_path => Role::Apart,
            (_, ";" | "," | ":" | ")" | "]" | "." | "(") => Role::Close,
            (_, "{") => Role::Apart,
            (_, "}") => Role::End,
            ("version", _) if !is_in_section => Role::Apart,
            _ if !is_in_section => Role::Section,
            ("{" | ";", _) => Role::Entry,
            (",", _) if !is_in_tags => Role::Argument,
            ("(" | "[" | "." | "+" | "-" | "!", _) => Role::Close,
            _ => Role::Apart,
        };
        let indent = match role {
            Role::Entry => ENTRY,
            Role::End => 0,
            _ if is_in_section => CONTINUED,
            _ => 0,
        };
        match text {
            _ if is_path => {}
            "{" => (is_in_section, is_in_agents) = (true, before == "agents"),
            "}" => (is_in_section, is_in_agents) = (false, false),
            "[" => is_in_tags = true,
            "]" => is_in_tags = false,
            _ => {}
        }
        let mut gap = Gap::new(&scanner.text[last..start]);
        // No empty lines at the begin and the end of a section.
        if before == "{" {
            let newlines = gap.comments.first_mut().map(|comment| &mut comment.newlines);
            let newlines = newlines.unwrap_or(&mut gap.newlines);
            *newlines = 1.min(*newlines);
        }
        if role == Role::End {
            gap.newlines = gap.newlines.min(1);
        }
        tokens.push(Token { text, gap, role, indent });
        before = if is_path { "" } else { text };
        last = scanner.position;
    }
    (tokens, Gap::new(&text[last..]))
}

/// The formatted text.
pub(super) fn formatted(text: &str) -> String {
    let (tokens, behind) = tokens(text);
    let mut lines = Lines::default();
    let mut is_broken = false;
    for (index, token) in tokens.iter().enumerate() {
        let rest = &tokens[index + 1..];
        let until = |ends: &[Role]| {
            let length = rest.iter().take_while(|token| !ends.contains(&token.role)).count();
            &rest[..length]
        };
        let separator = match token.role {
            Role::Section => {
                let section = until(&[Role::Section]);
                let width: usize = section.iter().map(Token::width).sum();
                is_broken = section.iter().any(Token::is_broken)
                    || token.text.chars().count() + width > WIDTH;
                None
            }
            Role::Entry | Role::End if is_broken => None,
            Role::Argument => {
                let argument = until(&[Role::Argument, Role::Entry, Role::End]);
                let width = token.width() + argument.iter().map(Token::width).sum::<usize>();
                let is_too_long = lines.column + width > WIDTH;
                let newline = token.is_broken() || is_too_long;
                Some(if newline { Separator::Newline } else { Separator::Blank })
            }
            Role::Close => Some(Separator::Nothing),
            _ => Some(Separator::Blank),
        };
        match separator {
            _ if index == 0 => lines.between(&token.gap, 0, 0),
            None => {
                let inner = if token.role == Role::Section { 0 } else { ENTRY };
                lines.between(&token.gap, inner, token.indent);
            }
            Some(separator) => {
                let closes = !token.text.starts_with(is_word);
                lines.gap(&token.gap, separator, token.indent, closes);
            }
        }
        lines.push(token.text);
    }
    lines.end(&behind);
    lines.text
}
