//! The lines of a formatted text.

use super::comments::Gap;

/// What is between two tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Nothing,
    Blank,
    Newline,
}

/// The output.
#[derive(Debug, Default)]
pub(super) struct Lines {
    pub(super) text: String,
    /// Number of characters in the last line.
    pub(super) column: usize,
}

impl Lines {
    pub(super) fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.column += text.chars().count();
    }

    fn newline(&mut self, indent: usize) {
        self.text.push('\n');
        self.text.extend(std::iter::repeat_n(' ', indent));
        self.column = indent;
    }

    /// A comment, without blanks at the ends of its lines.
    fn comment(&mut self, text: &str) {
        for (index, line) in text.lines().enumerate() {
            if index > 0 {
                self.newline(0);
            }
            self.push(line.trim_end());
        }
    }

    /// What is between two tokens that can stand in one line; a token that `closes` has no blank before it.
    pub(super) fn gap(&mut self, gap: &Gap<'_>, separator: Separator, indent: usize, closes: bool) {
        let Some(last) = gap.comments.last() else {
            return match separator {
                Separator::Newline => self.newline(indent),
                Separator::Blank => self.push(" "),
                Separator::Nothing => {}
            };
        };
        let mut broken = false;
        for comment in &gap.comments {
            if comment.newlines > 0 {
                self.newline(indent);
                broken = true;
            } else if !self.text.ends_with(['(', '[']) {
                self.push(" ");
            }
            self.comment(comment.text);
        }
        if last.ends_line() || gap.newlines > 0 || separator == Separator::Newline && !broken {
            self.newline(indent);
        } else if separator != Separator::Nothing || !closes {
            self.push(" ");
        }
    }

    /// What is before a token that begins a line; `inner` is the column of comments in lines of their own.
    pub(super) fn between(&mut self, gap: &Gap<'_>, inner: usize, indent: usize) {
        for comment in &gap.comments {
            if comment.newlines > 0 {
                self.lines(comment.newlines, inner);
            } else if !self.text.is_empty() {
                self.push(" ");
            }
            self.comment(comment.text);
        }
        self.lines(gap.newlines, indent);
    }

    /// What is behind the last token.
    pub(super) fn end(&mut self, gap: &Gap<'_>) {
        self.between(&Gap { newlines: gap.newlines.min(1), ..gap.clone() }, 0, 0);
    }

    /// A new line, unless the text begins here; before it an empty one if there are some.
    fn lines(&mut self, newlines: usize, indent: usize) {
        if !self.text.is_empty() {
            if newlines > 1 {
                self.text.push('\n');
            }
            self.newline(indent);
        }
    }
}
