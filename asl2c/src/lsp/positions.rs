//! Lines and columns of the protocol: from 0, columns in UTF-16 code units.

use std::ops::Range;

use gen_lsp_types::{Position, Range as Place};

/// The begin of each line of a text.
#[derive(Debug, Clone, Default)]
pub(super) struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    /// The lines of a text; they end with `\n`, `\r\n` or `\r`.
    pub(super) fn of(text: &str) -> Self {
        let bytes = text.as_bytes();
        let ends = bytes.iter().enumerate().filter(|(index, byte)| match byte {
            b'\n' => true,
            b'\r' => bytes.get(index + 1) != Some(&b'\n'),
            _ => false,
        });
        Self { starts: std::iter::once(0).chain(ends.map(|(index, _)| index + 1)).collect() }
    }

    /// The position of a byte.
    pub(super) fn position(&self, text: &str, offset: usize) -> Position {
        let offset = text.floor_char_boundary(offset);
        let line = self.starts.partition_point(|start| *start <= offset).saturating_sub(1);
        let start = self.starts.get(line).copied().unwrap_or_default();
        let before = text.get(start..offset).unwrap_or_default();
        let column = if before.is_ascii() { before.len() } else { before.encode_utf16().count() };
        Position { line: number(line), character: number(column) }
    }

    /// The byte at a position. One outside the text is moved to the end of its line, or of the text.
    pub(super) fn offset(&self, text: &str, position: Position) -> usize {
        let line = usize::try_from(position.line).unwrap_or(usize::MAX);
        let Some(start) = self.starts.get(line).copied() else { return text.len() };
        let end = self.starts.get(line.saturating_add(1)).copied().unwrap_or(text.len());
        let content = text.get(start..end).unwrap_or_default().trim_end_matches(['\r', '\n']);
        let mut column = 0;
        for (index, character) in content.char_indices() {
            if column >= position.character {
                return start + index;
            }
            // A character is one or two units.
            column += if character.len_utf16() == 1 { 1 } else { 2 };
        }
        start + content.len()
    }

    /// The place of a range of bytes.
    pub(super) fn place(&self, text: &str, span: &Range<usize>) -> Place {
        Place {
            start: self.position(text, span.start),
            end: self.position(text, span.end.max(span.start)),
        }
    }

    /// The range of bytes at a place.
    pub(super) fn span(&self, text: &str, place: Place) -> Range<usize> {
        let start = self.offset(text, place.start);
        start..self.offset(text, place.end).max(start)
    }
}

/// The protocol's numbers have 32 bits.
fn number(of: usize) -> u32 {
    u32::try_from(of).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a\u{e9}\u{1f600}b\r\nc\rd\n\n\u{65e5}";

    fn at(line: u32, character: u32) -> Position {
        Position { line, character }
    }

    #[test]
    fn columns_count_utf16_units() {
        let lines = Lines::of(TEXT);
        for (offset, position) in [
            (0, at(0, 0)),
            (1, at(0, 1)),
            (3, at(0, 2)),
            (7, at(0, 4)),
            (8, at(0, 5)),
            (10, at(1, 0)),
            (12, at(2, 0)),
            (14, at(3, 0)),
            (15, at(4, 0)),
            (TEXT.len(), at(4, 1)),
        ] {
            assert_eq!(lines.position(TEXT, offset), position, "{offset}");
            assert_eq!(lines.offset(TEXT, position), offset, "{position:?}");
        }
    }

    #[test]
    fn what_is_outside_the_text_is_moved_into_it() {
        let lines = Lines::of(TEXT);
        // Behind a line, inside of a character of two units, and behind the text.
        assert_eq!(lines.offset(TEXT, at(0, 99)), 8);
        assert_eq!(lines.offset(TEXT, at(0, 3)), 7);
        assert_eq!(lines.offset(TEXT, at(1, u32::MAX)), 11);
        assert_eq!(lines.offset(TEXT, at(u32::MAX, 0)), TEXT.len());
        assert_eq!(lines.position(TEXT, 999), at(4, 1));
        assert_eq!(lines.position(TEXT, 2), at(0, 1));
        let backwards = Place { start: at(3, 0), end: at(0, 1) };
        assert_eq!(lines.span(TEXT, backwards), 14..14);
    }
}
