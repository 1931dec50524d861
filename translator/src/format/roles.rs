//! The role of each token, which decides what is between it and the token before.

use crate::syntax::lexer::{Token, TokenKind};

/// Role of a token in a text without errors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// First token of an initial belief, a goal or a plan.
    Statement,
    /// First token of a trigger behind a label.
    Trigger,
    /// `<-`
    Arrow,
    /// First token of a formula, except the first one.
    Formula,
    /// `&`, `|`
    Junction,
    /// A token with a blank before it.
    Apart,
    /// A token without a blank before it.
    Close,
}

/// A token's role and region.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub(super) role: Role,
    /// Whether it is part of a plan's body.
    pub(super) in_body: bool,
}

/// The role of each token.
pub(super) fn roles(tokens: &[Token]) -> Vec<Placed> {
    let mut walk = Walk::default();
    tokens.iter().enumerate().map(|(index, token)| walk.next(tokens, index, &token.kind)).collect()
}

/// What is expected at a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Expected {
    #[default]
    Statement,
    /// The label of a plan, up to its trigger.
    Label,
    /// A prefix of a trigger, a goal or a formula.
    Prefix,
    /// The first formula.
    Body,
    /// Another formula.
    Formula,
    Rest,
}

#[derive(Debug, Default)]
struct Walk {
    expected: Expected,
    in_body: bool,
    /// Number of open brackets of a label.
    brackets: usize,
}

impl Walk {
    fn next(&mut self, tokens: &[Token], index: usize, kind: &TokenKind) -> Placed {
        let before = index.checked_sub(1).and_then(|index| tokens.get(index)).map(|t| &t.kind);
        let was = self.expected;
        let is_internal =
            was == Expected::Rest && kind == &TokenKind::Dot && begins_condition(before);
        let role = match was {
            Expected::Statement => Role::Statement,
            Expected::Label if self.ends_label(tokens, index) => Role::Trigger,
            Expected::Label if before == Some(&TokenKind::Comma) => Role::Apart,
            Expected::Label | Expected::Prefix => Role::Close,
            Expected::Body => Role::Apart,
            Expected::Formula => Role::Formula,
            Expected::Rest if is_internal && before != Some(&TokenKind::LeftParenthesis) => {
                Role::Apart
            }
            Expected::Rest => inside(before, tokens, index, kind),
        };
        self.expected = match kind {
            TokenKind::At => Expected::Label,
            _ if was == Expected::Label && role != Role::Trigger => Expected::Label,
            _ if is_internal => Expected::Prefix,
            // Otherwise a full stop ends the statement, and a sign is part of an expression.
            _ if was != Expected::Rest && is_mark(kind) => Expected::Prefix,
            TokenKind::Dot => {
                self.in_body = false;
                Expected::Statement
            }
            TokenKind::Arrow => Expected::Body,
            TokenKind::Semicolon => Expected::Formula,
            _ => Expected::Rest,
        };
        // The arrow itself stands outside.
        let in_body = self.in_body;
        self.in_body |= kind == &TokenKind::Arrow;
        Placed { role, in_body }
    }

    /// Whether the label ends before this token.
    fn ends_label(&mut self, tokens: &[Token], index: usize) -> bool {
        match &tokens[index].kind {
            TokenKind::LeftBracket => self.brackets += 1,
            TokenKind::RightBracket => self.brackets = self.brackets.saturating_sub(1),
            TokenKind::Plus | TokenKind::Minus => return self.brackets == 0,
            _ => {}
        }
        false
    }
}

/// Whether a condition begins behind this token of a context: there a full stop does not end the statement.
fn begins_condition(before: Option<&TokenKind>) -> bool {
    matches!(
        before,
        Some(
            TokenKind::Colon
                | TokenKind::Ampersand
                | TokenKind::Bar
                | TokenKind::LeftParenthesis
                | TokenKind::Not
        )
    )
}

/// Role of a token inside a statement.
fn inside(before: Option<&TokenKind>, tokens: &[Token], index: usize, kind: &TokenKind) -> Role {
    match kind {
        TokenKind::Arrow => Role::Arrow,
        TokenKind::Ampersand | TokenKind::Bar => Role::Junction,
        TokenKind::Dot
        | TokenKind::Semicolon
        | TokenKind::Comma
        | TokenKind::RightParenthesis
        | TokenKind::LeftBracket
        | TokenKind::RightBracket => Role::Close,
        TokenKind::LeftParenthesis if before == Some(&TokenKind::Atom) => Role::Close,
        _ => match before {
            Some(TokenKind::LeftParenthesis | TokenKind::LeftBracket) => Role::Close,
            Some(TokenKind::Minus) if is_unary(tokens, index - 1) => {
                // A sign that does not touch its number is an operation, and must stay one.
                let touches = tokens[index - 1].span.end == tokens[index].span.start;
                if kind == &TokenKind::Number && !touches { Role::Apart } else { Role::Close }
            }
            _ => Role::Apart,
        },
    }
}

/// Whether the minus at `index` of an expression is a sign.
fn is_unary(tokens: &[Token], index: usize) -> bool {
    let before = index.checked_sub(1).and_then(|index| tokens.get(index)).map(|t| &t.kind);
    is_sign(before, &TokenKind::Minus)
}

/// Whether `kind` is a sign, and not between two operands.
fn is_sign(before: Option<&TokenKind>, kind: &TokenKind) -> bool {
    kind == &TokenKind::Minus
        && !matches!(
            before,
            Some(
                TokenKind::Variable
                    | TokenKind::Unnamed
                    | TokenKind::Number
                    | TokenKind::Text(_)
                    | TokenKind::True
                    | TokenKind::False
                    | TokenKind::Atom
                    | TokenKind::RightParenthesis
            )
        )
}

/// Marks before a trigger, a goal or a formula.
fn is_mark(kind: &TokenKind) -> bool {
    matches!(
        kind,
        TokenKind::Plus
            | TokenKind::Minus
            | TokenKind::Bang
            | TokenKind::BangBang
            | TokenKind::Question
            | TokenKind::Dot
    )
}
