//! What is between two tokens: blanks and comments.

/// A comment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Comment<'a> {
    /// Its text, from `//` or `/*` on.
    pub(super) text: &'a str,
    /// Number of newlines before it, from the token or comment before.
    pub(super) newlines: usize,
}

impl Comment<'_> {
    /// Whether the rest of its line belongs to it.
    pub(super) fn ends_line(&self) -> bool {
        self.text.starts_with("//")
    }
}

/// Everything between two tokens.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Gap<'a> {
    /// Its comments.
    pub(super) comments: Vec<Comment<'a>>,
    /// Number of newlines behind the last comment.
    pub(super) newlines: usize,
}

impl<'a> Gap<'a> {
    /// `text` consists of blanks and complete comments.
    pub(super) fn new(text: &'a str) -> Self {
        let mut gap = Self::default();
        let mut rest = text;
        while let Some(start) = rest.find(['/', '\n']) {
            if rest[start..].starts_with('\n') {
                gap.newlines += 1;
                rest = &rest[start + 1..];
                continue;
            }
            let comment = &rest[start..];
            let length = if comment.starts_with("//") {
                comment.find('\n')
            } else {
                comment.get(2..).and_then(|inner| inner.find("*/")).map(|end| end + 4)
            };
            let (comment, behind) = comment.split_at(length.unwrap_or(comment.len()));
            let newlines = std::mem::take(&mut gap.newlines);
            gap.comments.push(Comment { text: comment.trim_end(), newlines });
            rest = behind;
        }
        gap
    }

    /// Number of characters of the comments in one line, with the blanks before them.
    pub(super) fn width(&self) -> usize {
        self.comments.iter().map(|comment| comment.text.chars().count() + 1).sum()
    }

    /// Whether the author breaks the line here.
    pub(super) fn is_broken(&self) -> bool {
        self.newlines > 0
            || self.comments.iter().any(|comment| comment.newlines > 0 || comment.ends_line())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_found_with_the_newlines_around_them() {
        let gap = Gap::new(" // a / b \r\n\n  /* c\n // */\t/**/ // /* d\n");
        let comments: Vec<_> = gap.comments.iter().map(|c| (c.text, c.newlines)).collect();
        assert_eq!(comments, [("// a / b", 0), ("/* c\n // */", 2), ("/**/", 0), ("// /* d", 0)]);
        assert_eq!(gap.newlines, 1);
        assert!(gap.is_broken());
        assert!(!Gap::new(" /* a\nb */ ").is_broken());
        assert_eq!(Gap::new("  \t"), Gap::default());
    }
}
