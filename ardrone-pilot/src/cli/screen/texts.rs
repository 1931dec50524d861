//! Texts of several lines on the screen: what happened, and answers to what was typed.

use diagnostic::printable_lines;
use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::widgets::{Block, Clear, List, ListItem, Padding, Paragraph};

use super::WARNING;

/// How far the continuation of a line is indented.
const INDENT: usize = 2;

/// The newest of these texts, each on as many lines as it needs, and marked if it warns. The newest comes first, and is drawn
/// last.
pub(super) fn draw_newest<T: AsRef<str>>(
    frame: &mut Frame<'_>,
    area: Rect,
    title: &str,
    newest_first: impl Iterator<Item = (T, bool)>,
) {
    let block = Block::bordered().title(title);
    let inside = block.inner(area);
    let (columns, rows) = (usize::from(inside.width), usize::from(inside.height));
    let mut shown: Vec<ListItem<'_>> = Vec::new();
    for (text, warns) in newest_first {
        let style = if warns { Style::new().fg(WARNING) } else { Style::new() };
        let lines = wrapped(text.as_ref(), columns);
        // Half of a text would be taken for the whole; the newest is shown as far as it goes.
        if !shown.is_empty() && shown.len() + lines.len() > rows {
            break;
        }
        let lines = lines.into_iter().take(rows).rev();
        shown.extend(lines.map(|line| ListItem::new(line).style(style)));
    }
    shown.reverse();
    frame.render_widget(List::new(shown).block(block), area);
}

/// The answer to what was typed, at the lower end of an area and in front of what is there.
pub(super) fn draw_answer(frame: &mut Frame<'_>, area: Rect, answer: Option<&str>) {
    let Some(answer) = answer else { return };
    let columns = usize::from(area.width.saturating_sub(4));
    let lines = wrapped(&printable_lines(answer), columns);
    let height = u16::try_from(lines.len() + 2).unwrap_or(u16::MAX).min(area.height);
    let pane = Rect { y: area.bottom().saturating_sub(height), height, ..area };
    let block = Block::bordered().padding(Padding::horizontal(1));
    let block = block.title("answer (any key closes it)");
    frame.render_widget(Clear, pane);
    frame.render_widget(Paragraph::new(lines.join("\n")).block(block), pane);
}

/// Texts in lines of at most so many columns.
pub(super) fn wrapped_all(texts: &[String], columns: usize) -> Vec<String> {
    texts.iter().flat_map(|text| wrapped(text, columns)).collect()
}

/// The beginning of a text in one line of at most so many columns: whole words, with a mark if there are more.
pub(super) fn clipped(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    let lines = wrapped(text, columns.saturating_sub(2));
    lines.first().map_or_else(String::new, |line| format!("{line} …"))
}

/// A text in lines of at most so many columns, broken between words where that is possible.
fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let mut lines = Vec::new();
    for whole in text.lines() {
        let mut rest: Vec<char> = whole.chars().collect();
        let mut begin = rest.iter().take_while(|letter| **letter == ' ').count();
        let hanging = (begin + INDENT).min(columns / 2);
        while rest.len() > columns && columns > 2 * INDENT {
            let space = rest[..=columns].iter().rposition(|letter| *letter == ' ');
            let end = space.filter(|end| *end > begin).unwrap_or(columns);
            let behind = rest.split_off(end);
            lines.push(rest.iter().collect());
            rest = vec![' '; hanging];
            rest.extend(behind.into_iter().skip_while(|letter| *letter == ' '));
            begin = hanging;
        }
        lines.push(rest.into_iter().collect());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_broken_between_words_and_lose_nothing() {
        assert_eq!(wrapped("a bb ccc dddd", 8), ["a bb ccc", "  dddd"]);
        assert_eq!(wrapped("  a bb ccc\n", 8), ["  a bb", "    ccc"]);
        assert_eq!(wrapped("a bb ccc dddd eeeee", 8), ["a bb ccc", "  dddd", "  eeeee"]);
        assert_eq!(wrapped("aaaaaaaaaa", 8), ["aaaaaaaa", "  aa"]);
        assert_eq!(wrapped("a b", 0), ["a b"]);
        assert_eq!(wrapped("\n\nb", 8), ["", "", "b"]);
        assert_eq!(clipped("a bb ccc", 8), "a bb ccc");
        assert_eq!(clipped("a bb ccc dddd", 8), "a bb …");
    }
}
