//! Words and signs of C.
//!
//! What is not a listed character, or could be read in two ways by compilers, is refused here, also in comments.

use diagnostic::is_printable;

use crate::refused::{Refused, Rule};

/// Place of a word in the text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(crate) struct Place {
    pub(crate) line: u32,
    pub(crate) column: u32,
}

/// Kinds of words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Name,
    Integer,
    Float,
    Text,
    Sign,
    /// A whole preprocessor line.
    Line,
    /// Behind the last word.
    End,
}

/// A word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Token<'a> {
    pub(crate) kind: Kind,
    pub(crate) text: &'a str,
    pub(crate) place: Place,
}

impl Token<'_> {
    /// The refusal of this word.
    pub(crate) fn refused(&self, rule: Rule) -> Refused {
        refused(self.text, self.place, rule)
    }
}

/// Characters of a word in a message.
const MOST_FOUND: usize = 60;

/// A refusal. The text may be anything, and is made safe to show.
pub(crate) fn refused(found: &str, place: Place, rule: Rule) -> Refused {
    let short: String = found.chars().take(MOST_FOUND).collect();
    let found = diagnostic::printable(&short).to_string();
    Refused { line: place.line, column: place.column, found, rule }
}

/// Signs of two characters, and then of one.
const SIGNS: [&str; 32] = [
    "->", "++", "--", "+=", "-=", "==", "!=", "<=", ">=", "&&", "||", "(", ")", "{", "}", "[", "]",
    ";", ",", ":", "=", "<", ">", "+", "-", "*", "/", "%", "!", "&", ".", "#",
];
/// Signs that are known only in headers.
const HEADER_SIGNS: [char; 4] = ['|', '~', '^', '?'];
/// Other spellings of signs.
const DIGRAPHS: [&str; 5] = ["<%", "%>", "<:", ":>", "%:"];

/// Why a character cannot begin a word.
fn unknown(character: char) -> Rule {
    match character {
        '\r' => Rule::LineEnd,
        '?' => Rule::Sign("choose with `if` and `else`"),
        '|' | '^' | '~' => Rule::Sign("there are no operations on bits, only `&&`, `||` and `!`"),
        '\'' => Rule::Sign("write the number of the character"),
        _ => Rule::Character,
    }
}

struct Lexer<'a> {
    rest: &'a str,
    place: Place,
    tokens: Vec<Token<'a>>,
    /// A header of the agent's own, or a line of one: its values are not computed with.
    is_header: bool,
}

/// The words of a text, and the place behind them.
pub(crate) fn tokens(text: &str) -> Result<Vec<Token<'_>>, Refused> {
    all(text, Place { line: 1, column: 1 }, false)
}

/// The words of a header of the agent's own, with preprocessor lines anywhere, or of a part of one at this place.
pub(crate) fn header_tokens(text: &str, place: Place) -> Result<Vec<Token<'_>>, Refused> {
    all(text, place, true)
}

fn all(text: &str, place: Place, is_header: bool) -> Result<Vec<Token<'_>>, Refused> {
    let mut lexer = Lexer { rest: text, place, tokens: Vec::new(), is_header };
    while !lexer.rest.is_empty() {
        lexer.next()?;
    }
    lexer.tokens.push(Token { kind: Kind::End, text: "the end", place: lexer.place });
    Ok(lexer.tokens)
}

impl<'a> Lexer<'a> {
    fn refuse(&self, length: usize, rule: Rule) -> Result<(), Refused> {
        let found = self.rest.get(..length).unwrap_or(self.rest);
        Err(refused(found, self.place, rule))
    }

    fn first_length(&self) -> usize {
        self.rest.chars().next().map_or(1, char::len_utf8)
    }

    /// Takes this many bytes.
    fn take(&mut self, length: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(length);
        for character in taken.chars() {
            if character == '\n' {
                self.place.line += 1;
                self.place.column = 1;
            } else {
                self.place.column += 1;
            }
        }
        self.rest = rest;
        taken
    }

    fn push(&mut self, kind: Kind, length: usize) {
        let place = self.place;
        let text = self.take(length);
        self.tokens.push(Token { kind, text, place });
    }

    fn next(&mut self) -> Result<(), Refused> {
        let first = self.rest.chars().next().unwrap_or(' ');
        if self.rest.starts_with("/*") || self.rest.starts_with("//") {
            return self.comment();
        }
        if self.rest.starts_with("??") {
            return self.refuse(2, Rule::Trigraph);
        }
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        match first {
            ' ' | '\t' | '\n' => _ = self.take(1),
            '#' => self.line()?,
            '"' => self.text()?,
            _ if first.is_ascii_digit() => self.number()?,
            _ if word(first) => {
                let length = self.rest.find(|c| !word(c)).unwrap_or(self.rest.len());
                self.push(Kind::Name, length);
            }
            _ => {
                if DIGRAPHS.iter().any(|digraph| self.rest.starts_with(digraph)) {
                    return self.refuse(2, Rule::Digraph);
                }
                let more = self.is_header && HEADER_SIGNS.contains(&first);
                match SIGNS.iter().find(|sign| self.rest.starts_with(**sign)) {
                    Some(sign) => self.push(Kind::Sign, sign.len()),
                    None if more => self.push(Kind::Sign, 1),
                    None => self.refuse(self.first_length(), unknown(first))?,
                }
            }
        }
        Ok(())
    }

    /// Leaves out a comment. Its characters may be any that are shown as what they are.
    fn comment(&mut self) -> Result<(), Refused> {
        let block = self.rest.starts_with("/*");
        let start = self.place;
        // In `//*` another comment begins with the second character, for compilers that know only that kind.
        self.take(if block { 2 } else { 1 });
        loop {
            let Some(character) = self.rest.chars().next() else {
                return if block { Err(refused("/*", start, Rule::Open)) } else { Ok(()) };
            };
            if block && self.rest.starts_with("*/") {
                self.take(2);
                return Ok(());
            }
            if !block && character == '\n' {
                return Ok(());
            }
            if self.rest.starts_with("??") {
                return self.refuse(2, Rule::Trigraph);
            }
            if character == '\\' || self.rest.starts_with("/*") {
                return self.refuse(self.first_length(), Rule::Comment);
            }
            // What replaces bytes that are no text could be anything.
            let shown = is_printable(character) && character != char::REPLACEMENT_CHARACTER;
            if !shown && !matches!(character, '\t' | '\n') {
                let rule = if character == '\r' { Rule::LineEnd } else { Rule::Character };
                return self.refuse(self.first_length(), rule);
            }
            self.take(character.len_utf8());
        }
    }

    /// A preprocessor line, of which only whole ones are known.
    fn line(&mut self) -> Result<(), Refused> {
        let length = self.rest.find('\n').unwrap_or(self.rest.len());
        let line = self.rest[..length].trim_end_matches([' ', '\t']);
        let is_alone = self.tokens.iter().all(|token| {
            token.kind == Kind::Line || self.is_header && token.place.line < self.place.line
        });
        if !is_alone {
            return self.refuse(line.len(), Rule::Preprocessor);
        }
        self.push(Kind::Line, line.len());
        Ok(())
    }

    fn text(&mut self) -> Result<(), Refused> {
        let bytes = self.rest.as_bytes();
        let mut end = 1;
        loop {
            let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
            let octal =
                |at: usize| bytes.get(end + at).is_some_and(|byte| (b'0'..=b'7').contains(byte));
            match bytes.get(end) {
                None | Some(b'\n') => return self.refuse(end, Rule::Open),
                Some(b'"') => break,
                Some(b'\\') => match bytes.get(end + 1) {
                    Some(b'"' | b'\\' | b'n' | b't' | b'?') => end += 2,
                    // At most \377, and no digit behind it: CBMC would take that for one of them.
                    Some(b'0'..=b'3') if octal(2) && octal(3) && !is_digit(end + 4) => end += 4,
                    _ => return self.refuse(end + 1, Rule::Escape),
                },
                Some(b'?') if bytes.get(end + 1) == Some(&b'?') => {
                    return self.refuse(end + 2, Rule::Trigraph);
                }
                Some(b' '..=b'~') => end += 1,
                Some(_) => return self.refuse(end, Rule::Character),
            }
        }
        self.push(Kind::Text, end + 1);
        Ok(())
    }

    /// `3`, `3U`, `3LL`, `3ULL`, `3.0`, `3e5`, `3.0e-5F`.
    fn number(&mut self) -> Result<(), Refused> {
        if self.is_header {
            let end = self.rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '.');
            self.push(Kind::Integer, end.unwrap_or(self.rest.len()));
            return Ok(());
        }
        let bytes = self.rest.as_bytes();
        let digits = |from: usize| {
            from + bytes.iter().skip(from).take_while(|byte| byte.is_ascii_digit()).count()
        };
        let whole = digits(0);
        let mut end = whole;
        if bytes.get(end) == Some(&b'.') {
            let fraction = digits(end + 1);
            if fraction == end + 1 {
                return self.refuse(fraction, Rule::Number);
            }
            end = fraction;
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let exponent = digits(end + 1 + sign);
            if exponent == end + 1 + sign {
                return self.refuse(exponent, Rule::Number);
            }
            end = exponent;
        }
        let is_float = end > whole;
        let suffixes: &[&str] = if is_float { &["F"] } else { &["ULL", "LL", "U"] };
        let rest = &self.rest[end..];
        let suffix = suffixes.iter().find(|suffix| rest.starts_with(**suffix));
        let length = end + suffix.map_or(0, |suffix| suffix.len());
        let behind = self.rest[length..].chars().next().unwrap_or(' ');
        let octal = !is_float && whole > 1 && bytes[0] == b'0';
        if octal || behind.is_alphanumeric() || matches!(behind, '_' | '.') {
            return self.refuse(length + behind.len_utf8(), Rule::Number);
        }
        let kind = if is_float { Kind::Float } else { Kind::Integer };
        self.push(kind, length);
        Ok(())
    }
}
