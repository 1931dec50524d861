//! Tokens and comments to lines.

use std::ops::Range;

use super::WIDTH;
use super::comments::Gap;
use super::lines::{Lines, Separator};
use super::roles::{Placed, Role};
use crate::syntax::lexer::{Token, TokenKind};

/// Columns of `<-`, of formulas, and of continued lines of a head and of a formula.
const ARROW: usize = 2;
const FORMULA: usize = 5;
const HEAD: usize = 4;
const CONTINUED: usize = 7;

/// A text without errors, and what is known of its tokens.
pub(super) struct Layout<'a> {
    pub(super) text: &'a str,
    pub(super) tokens: &'a [Token],
    pub(super) roles: &'a [Placed],
    /// The gap before each token, and that behind the last one.
    pub(super) gaps: &'a [Gap<'a>],
}

/// Which parts of a plan are broken.
#[derive(Debug, Clone, Copy, Default)]
struct Breaks {
    arrow: bool,
    body: bool,
}

impl Layout<'_> {
    /// The formatted text.
    pub(super) fn text(&self) -> String {
        let mut lines = Lines::default();
        let starts = self.roles.iter().enumerate();
        let starts = starts.filter(|(_, placed)| placed.role == Role::Statement);
        let mut starts = starts.map(|(index, _)| index).peekable();
        while let Some(start) = starts.next() {
            let end = starts.peek().copied().unwrap_or(self.tokens.len());
            lines.between(&self.gaps[start], 0, 0);
            self.statement(start..end, &mut lines);
        }
        if let Some(gap) = self.gaps.last() {
            lines.end(gap);
        }
        lines.text
    }

    fn statement(&self, range: Range<usize>, lines: &mut Lines) {
        let breaks = self.breaks(range.clone());
        for index in range.clone() {
            if index > range.start {
                let separator = self.separator(index, breaks, lines.column);
                lines.gap(&self.gaps[index], separator, self.indent(index), self.closes(index));
            }
            lines.push(self.of(index));
        }
    }

    /// The parts that the author breaks, or that are too long for a line.
    fn breaks(&self, range: Range<usize>) -> Breaks {
        let role = |index: usize| self.roles[index].role;
        let Some(arrow) = range.clone().find(|index| role(*index) == Role::Arrow) else {
            return Breaks::default();
        };
        let trigger = range.clone().find(|index| role(*index) == Role::Trigger);
        let start = trigger.unwrap_or(range.start);
        let mut body = arrow + 2..range.end;
        let body_broken = body.any(|index| self.is_broken(index));
        let head_broken = (start + 1..arrow + 2).any(|index| self.is_broken(index));
        let too_long = self.width(start..range.end) > WIDTH;
        let arrow_broken = head_broken || body_broken || too_long;
        let body_too_long = FORMULA + self.width(arrow + 1..range.end) > WIDTH;
        Breaks { arrow: arrow_broken, body: body_broken || arrow_broken && body_too_long }
    }

    /// Whether the author breaks the line before this token, and may.
    fn is_broken(&self, index: usize) -> bool {
        let gap = &self.gaps[index];
        if !gap.comments.is_empty() {
            return gap.is_broken();
        }
        let role = self.roles[index].role;
        match role {
            // A line that ends in an operator is broken before it.
            Role::Junction => {
                let behind = self.gaps.get(index + 1);
                gap.newlines > 0
                    || behind.is_some_and(|gap| gap.comments.is_empty() && gap.newlines > 0)
            }
            Role::Arrow | Role::Formula => gap.newlines > 0,
            _ => gap.newlines > 0 && self.tokens[index - 1].kind == TokenKind::Arrow,
        }
    }

    /// What is between a token of a statement and the one before.
    fn separator(&self, index: usize, breaks: Breaks, column: usize) -> Separator {
        let broken = match self.roles[index].role {
            Role::Close => return Separator::Nothing,
            Role::Trigger => true,
            Role::Arrow => breaks.arrow,
            Role::Formula => breaks.body,
            Role::Junction => {
                let ends = |role| matches!(role, Role::Junction | Role::Arrow | Role::Formula);
                let rest = self.roles[index + 1..].iter();
                let length =
                    rest.take_while(|p| !ends(p.role) && p.role != Role::Statement).count();
                self.is_broken(index) || column + self.width(index..index + 1 + length) > WIDTH
            }
            Role::Statement | Role::Apart => false,
        };
        if broken { Separator::Newline } else { Separator::Blank }
    }

    /// Column of a token that begins a line of a statement.
    fn indent(&self, index: usize) -> usize {
        match self.roles[index] {
            Placed { role: Role::Trigger, .. } => 0,
            Placed { role: Role::Arrow, .. } => ARROW,
            Placed { role: Role::Formula, .. } => FORMULA,
            _ if self.tokens[index - 1].kind == TokenKind::Arrow => FORMULA,
            Placed { in_body: true, .. } => CONTINUED,
            Placed { in_body: false, .. } => HEAD,
        }
    }

    /// Whether a token is written behind a comment without a blank.
    fn closes(&self, index: usize) -> bool {
        matches!(
            self.tokens[index].kind,
            TokenKind::Comma
                | TokenKind::Semicolon
                | TokenKind::Dot
                | TokenKind::RightParenthesis
                | TokenKind::RightBracket
                | TokenKind::LeftParenthesis
                | TokenKind::LeftBracket
        )
    }

    /// Number of characters of tokens in one line, with the comments and blanks before them.
    fn width(&self, range: Range<usize>) -> usize {
        let start = range.start;
        range
            .map(|index| {
                let blank = index > start && self.roles[index].role != Role::Close;
                let before = if index > start { self.gaps[index].width() } else { 0 };
                usize::from(blank) + before + self.of(index).chars().count()
            })
            .sum()
    }

    fn of(&self, index: usize) -> &str {
        self.text.get(self.tokens[index].span.clone()).unwrap_or_default()
    }
}
