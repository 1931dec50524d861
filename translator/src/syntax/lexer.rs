//! Lexer: from text to tokens.

use diagnostic::{Diagnostic, Span};

use crate::code::Code;
use crate::syntax::ast::FOREIGN_RELATIONS;

const BYTE_ORDER_MARK: char = '\u{feff}';

/// Kind of a token.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// `goto`: starts with a lower-case letter.
    Atom,
    /// `X`: starts with an upper-case letter.
    Variable,
    /// `_` or `_x`
    Unnamed,
    /// `12`, `0.5`, `1e-3`
    Number,
    /// `"text"` with escapes resolved.
    Text(String),
    True,
    False,
    Not,
    Mod,
    Dot,
    Colon,
    Semicolon,
    Comma,
    LeftParenthesis,
    RightParenthesis,
    Arrow,
    Plus,
    Minus,
    Bang,
    BangBang,
    Question,
    Ampersand,
    Bar,
    Equals,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    EqualsEquals,
    NotEquals,
    Star,
    Slash,
    At,
    LeftBracket,
    RightBracket,
    /// An error that has been reported.
    Invalid,
    End,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Token {
    pub(crate) kind: TokenKind,
    pub(crate) span: Span,
}

/// All tokens of `text`, ending with [`TokenKind::End`], and the errors.
pub(crate) fn tokenize(text: &str) -> (Vec<Token>, Vec<Diagnostic>) {
    let mut lexer = Lexer::at(text, 0);
    let mut tokens = vec![lexer.token()];
    while tokens.last().is_some_and(|token| token.kind != TokenKind::End) {
        tokens.push(lexer.token());
    }
    (tokens, lexer.diagnostics)
}

/// Reads one token after the other.
pub(super) struct Lexer<'a> {
    text: &'a str,
    position: usize,
    /// The errors, in the order of the text.
    pub(super) diagnostics: Vec<Diagnostic>,
}

impl<'a> Lexer<'a> {
    /// A lexer that begins in the middle of a text: between two tokens, outside of comments.
    pub(super) fn at(text: &'a str, position: usize) -> Self {
        Self { text, position, diagnostics: Vec::new() }
    }

    /// The next token; [`TokenKind::End`] at the end, however often it is asked for.
    pub(super) fn token(&mut self) -> Token {
        loop {
            let start = self.position;
            let Some(character) = self.peek() else { return self.made(TokenKind::End, start) };
            match character {
                c if c.is_whitespace() => self.advance(),
                '/' if self.rest().starts_with("//") => self.take_while(|c| c != '\n'),
                '/' if self.rest().starts_with("/*") => {
                    if !self.block_comment(start) {
                        return self.made(TokenKind::Invalid, start);
                    }
                }
                '"' => return self.string(start),
                c if c.is_ascii_digit() => return self.number(start),
                c if c.is_ascii_alphabetic() || c == '_' => return self.word(start),
                BYTE_ORDER_MARK if start == 0 => self.advance(),
                _ => return self.symbol(start),
            }
        }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.position..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn advance(&mut self) {
        self.position += self.peek().map_or(0, char::len_utf8);
    }

    fn take_while(&mut self, accept: impl Fn(char) -> bool) {
        while self.peek().is_some_and(&accept) {
            self.advance();
        }
    }

    fn made(&self, kind: TokenKind, start: usize) -> Token {
        Token { kind, span: start..self.position }
    }

    fn error(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    /// Skips a comment. Returns `false` if it is never closed.
    fn block_comment(&mut self, start: usize) -> bool {
        let length = self.rest()[2..].find("*/");
        if let Some(length) = length {
            self.position += 2 + length + 2;
        } else {
            self.position = self.text.len();
            self.error(
                Code::NotClosed
                    .at("comment is never closed", start..start + 2)
                    .label("opened here")
                    .help("close it with `*/`"),
            );
        }
        length.is_some()
    }

    fn word(&mut self, start: usize) -> Token {
        self.take_while(|c| c.is_ascii_alphanumeric() || c == '_');
        let kind = match &self.text[start..self.position] {
            "true" => TokenKind::True,
            "false" => TokenKind::False,
            "not" => TokenKind::Not,
            "mod" => TokenKind::Mod,
            word if word.starts_with('_') => TokenKind::Unnamed,
            word if word.starts_with(|c: char| c.is_ascii_uppercase()) => TokenKind::Variable,
            _ => TokenKind::Atom,
        };
        self.made(kind, start)
    }

    fn number(&mut self, start: usize) -> Token {
        self.take_while(|c| c.is_ascii_digit());
        let mut after_dot = self.rest().strip_prefix('.').into_iter().flat_map(str::chars);
        if after_dot.next().is_some_and(|c| c.is_ascii_digit()) {
            self.advance();
            self.take_while(|c| c.is_ascii_digit());
        }
        self.exponent();
        if self.peek().is_some_and(|c| c.is_ascii_alphanumeric() || c == '_') {
            self.take_while(|c| c.is_ascii_alphanumeric() || c == '_');
            self.error(
                Code::MalformedNumber
                    .at("malformed number", start..self.position)
                    .help("numbers are decimal: `12`, `0.5`, `1e-3`"),
            );
            return self.made(TokenKind::Invalid, start);
        }
        self.made(TokenKind::Number, start)
    }

    fn exponent(&mut self) {
        let rest = self.rest();
        let Some(after_e) = rest.strip_prefix(['e', 'E']) else { return };
        let digits = after_e.strip_prefix(['+', '-']).unwrap_or(after_e);
        if digits.starts_with(|c: char| c.is_ascii_digit()) {
            self.position += rest.len() - digits.len();
            self.take_while(|c| c.is_ascii_digit());
        }
    }

    fn string(&mut self, start: usize) -> Token {
        self.advance();
        let mut text = String::new();
        loop {
            let escape_start = self.position;
            let Some(character) = self.peek().filter(|c| *c != '\n') else {
                self.error(
                    Code::NotClosed
                        .at("string is never closed", start..self.position)
                        .help("close it with `\"` on the same line"),
                );
                break;
            };
            self.advance();
            match character {
                '"' => break,
                '\\' => match self.peek() {
                    Some(escaped @ ('"' | '\\')) => {
                        self.advance();
                        text.push(escaped);
                    }
                    Some('n') => {
                        self.advance();
                        text.push('\n');
                    }
                    Some('t') => {
                        self.advance();
                        text.push('\t');
                    }
                    _ => self.error(
                        Code::MalformedString
                            .at("unknown escape in string", escape_start..self.position)
                            .help("the escapes are `\\\"`, `\\\\`, `\\n` and `\\t`"),
                    ),
                },
                '\0' => self.error(
                    Code::MalformedString
                        .at("string contains a NUL", escape_start..self.position)
                        .help("a C string would end here"),
                ),
                other => text.push(other),
            }
        }
        self.made(TokenKind::Text(text), start)
    }

    fn symbol(&mut self, start: usize) -> Token {
        const SYMBOLS: [(&str, TokenKind); 26] = [
            ("<-", TokenKind::Arrow),
            ("<=", TokenKind::LessOrEqual),
            (">=", TokenKind::GreaterOrEqual),
            ("==", TokenKind::EqualsEquals),
            ("\\==", TokenKind::NotEquals),
            ("!!", TokenKind::BangBang),
            ("!", TokenKind::Bang),
            ("?", TokenKind::Question),
            ("+", TokenKind::Plus),
            ("-", TokenKind::Minus),
            ("*", TokenKind::Star),
            ("/", TokenKind::Slash),
            ("&", TokenKind::Ampersand),
            ("|", TokenKind::Bar),
            ("=", TokenKind::Equals),
            ("<", TokenKind::Less),
            (">", TokenKind::Greater),
            (".", TokenKind::Dot),
            (":", TokenKind::Colon),
            (";", TokenKind::Semicolon),
            (",", TokenKind::Comma),
            ("(", TokenKind::LeftParenthesis),
            (")", TokenKind::RightParenthesis),
            ("@", TokenKind::At),
            ("[", TokenKind::LeftBracket),
            ("]", TokenKind::RightBracket),
        ];
        if let Some((found, meant)) =
            FOREIGN_RELATIONS.iter().find(|(found, _)| self.rest().starts_with(found))
        {
            self.position += found.len();
            self.error(foreign_relation(found, meant, start));
            let kind = SYMBOLS.into_iter().find(|(symbol, _)| *symbol == *meant);
            return self.made(kind.map_or(TokenKind::Invalid, |(_, kind)| kind), start);
        }
        match SYMBOLS.iter().find(|(symbol, _)| self.rest().starts_with(symbol)) {
            Some((symbol, kind)) => {
                self.position += symbol.len();
                self.made(kind.clone(), start)
            }
            None => self.unknown_symbol(start),
        }
    }

    fn unknown_symbol(&mut self, start: usize) -> Token {
        let character = self.peek().unwrap_or(' ');
        self.advance();
        let help = match character {
            '~' => "strong negation is not supported; `not b` tests that `b` is not believed",
            '{' | '}' => "braces do not occur in AgentSpeak",
            '\\' => "`\\==` is the only operator with a backslash",
            _ => "this character has no meaning in AgentSpeak",
        };
        self.error(
            Code::Syntax
                .at(
                    format!("unexpected character `{}`", character.escape_default()),
                    start..self.position,
                )
                .help(help),
        );
        self.made(TokenKind::Invalid, start)
    }
}

/// A relation that is spelt as in another language.
pub(crate) fn foreign_relation(found: &str, meant: &str, start: usize) -> Diagnostic {
    Code::Syntax
        .at(format!("`{found}` is no relation"), start..start + found.len())
        .help(format!("write `{meant}`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<TokenKind> {
        let (tokens, diagnostics) = tokenize(text);
        assert_eq!(diagnostics, []);
        tokens.into_iter().map(|token| token.kind).collect()
    }

    #[test]
    fn a_full_stop_after_a_number_is_not_its_fraction() {
        use TokenKind::{Dot, End, Number};
        assert_eq!(kinds("1. 1.5."), [Number, Dot, Number, Dot, End]);
        assert_eq!(kinds("1e5.2e-3"), [Number, Dot, Number, End]);
    }

    #[test]
    fn words_are_told_apart_by_their_first_letter() {
        use TokenKind::{Atom, End, Not, True, Unnamed, Variable};
        assert_eq!(
            kinds("go Go _ _go true not nothing"),
            [Atom, Variable, Unnamed, Unnamed, True, Not, Atom, End]
        );
    }

    #[test]
    fn string_escapes_are_resolved() {
        let text = TokenKind::Text("a\"\\\n\tb".to_owned());
        assert_eq!(kinds(r#""a\"\\\n\tb""#), [text, TokenKind::End]);
    }

    #[test]
    fn what_cannot_be_read_is_an_error_at_its_place() {
        for (text, span) in [
            ("a ~b", 2..3),
            ("a /* b", 2..4),
            ("\"a", 0..2),
            ("\"a\nb\"", 0..2),
            ("12x", 0..3),
            ("a \u{fffd}", 2..5),
            ("a\u{feff}", 1..4),
            ("\"\\q\"", 1..2),
        ] {
            let (_, diagnostics) = tokenize(text);
            assert_eq!(diagnostics.first().map(|d| d.span.clone()), Some(span), "{text:?}");
        }
    }
}
