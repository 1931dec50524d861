//! The prompt for typed orders, with history and completion.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crossterm::event::KeyCode;

/// Maximum length of a line, longer than any command.
const LONGEST: usize = 500;
/// Capacity of the history.
const REMEMBERED: usize = 100;

/// The line being edited and the answer to the last one, shared with the display that draws them.
#[derive(Debug, Clone, Default)]
pub(super) struct PromptLine(Arc<Mutex<Shown>>);

#[derive(Debug, Default)]
struct Shown {
    line: Option<String>,
    answer: Option<String>,
}

impl PromptLine {
    fn lock(&self) -> MutexGuard<'_, Shown> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The text to display while the prompt is open.
    pub(super) fn shown(&self) -> Option<String> {
        self.lock().line.clone()
    }

    /// The answer to the last line, in several lines, until it is closed.
    pub(super) fn answer(&self) -> Option<String> {
        self.lock().answer.clone()
    }

    /// As [`answer`](Self::answer), which is closed by that.
    pub(super) fn take_answer(&self) -> Option<String> {
        self.lock().answer.take()
    }

    /// Shows an answer.
    pub(super) fn show_answer(&self, answer: String) {
        self.lock().answer = Some(answer);
    }

    fn show(&self, line: Option<String>) {
        self.lock().line = line;
    }
}

/// Effect of a key on the line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Edited {
    /// Editing continues.
    Typing,
    /// Editing was cancelled.
    Cancelled,
    /// The line was entered.
    Entered(String),
}

/// Line editor.
#[derive(Debug)]
pub(super) struct Prompt {
    line: PromptLine,
    /// The text, if the prompt is open, and the cursor position in characters.
    text: Option<Vec<char>>,
    cursor: usize,
    history: Vec<String>,
    /// Index of the history entry being displayed.
    recalled: usize,
}

impl Prompt {
    pub(super) fn new(line: PromptLine) -> Self {
        Self { line, text: None, cursor: 0, history: Vec::new(), recalled: 0 }
    }

    /// Whether keys go to the prompt.
    pub(super) fn is_open(&self) -> bool {
        self.text.is_some()
    }

    /// Opens the prompt.
    pub(super) fn open(&mut self) {
        self.set("");
        self.recalled = self.history.len();
    }

    /// Handles a key; `complete` returns completions of the text before the cursor.
    pub(super) fn key(&mut self, key: KeyCode, complete: impl Fn(&str) -> Vec<String>) -> Edited {
        let Some(text) = &mut self.text else { return Edited::Cancelled };
        match key {
            KeyCode::Enter => return self.enter(),
            KeyCode::Esc => return self.close(Edited::Cancelled),
            KeyCode::Backspace if text.is_empty() => return self.close(Edited::Cancelled),
            KeyCode::Backspace if self.cursor > 0 => {
                self.cursor -= 1;
                text.remove(self.cursor);
            }
            KeyCode::Delete if self.cursor < text.len() => {
                text.remove(self.cursor);
            }
            KeyCode::Left => self.cursor = self.cursor.saturating_sub(1),
            KeyCode::Right => self.cursor = (self.cursor + 1).min(text.len()),
            KeyCode::Home => self.cursor = 0,
            KeyCode::End => self.cursor = text.len(),
            KeyCode::Up => self.recall(self.recalled.checked_sub(1)),
            KeyCode::Down => self.recall(Some(self.recalled + 1)),
            KeyCode::Tab => self.complete(complete),
            KeyCode::Char(letter) if text.len() < LONGEST && !letter.is_control() => {
                text.insert(self.cursor, letter);
                self.cursor += 1;
            }
            _ => {}
        }
        self.show();
        Edited::Typing
    }

    fn enter(&mut self) -> Edited {
        let entered: String = self.text.iter().flatten().collect();
        let entered = entered.trim().to_owned();
        if entered.is_empty() {
            return self.close(Edited::Cancelled);
        }
        if self.history.last() != Some(&entered) {
            self.history.push(entered.clone());
            if self.history.len() > REMEMBERED {
                self.history.remove(0);
            }
        }
        self.close(Edited::Entered(entered))
    }

    fn recall(&mut self, entry: Option<usize>) {
        let Some(entry) = entry.filter(|entry| *entry <= self.history.len()) else { return };
        self.recalled = entry;
        let line = self.history.get(entry).cloned().unwrap_or_default();
        self.set(&line);
    }

    /// Inserts the common prefix of all completions.
    fn complete(&mut self, complete: impl Fn(&str) -> Vec<String>) {
        let Some(text) = &mut self.text else { return };
        let typed: String = text.iter().take(self.cursor).collect();
        let Some(common) = complete(&typed).into_iter().reduce(|a, b| common_start(&a, &b)) else {
            return;
        };
        let added: Vec<char> =
            common.strip_prefix(typed.as_str()).unwrap_or_default().chars().collect();
        let cursor = self.cursor;
        self.cursor += added.len();
        text.splice(cursor..cursor, added);
    }

    fn set(&mut self, line: &str) {
        let text: Vec<char> = line.chars().collect();
        self.cursor = text.len();
        self.text = Some(text);
        self.show();
    }

    fn close(&mut self, edited: Edited) -> Edited {
        self.text = None;
        self.show();
        edited
    }

    fn show(&self) {
        let shown = self.text.as_ref().map(|text| {
            let (before, behind) = text.split_at(self.cursor.min(text.len()));
            let (before, behind): (String, String) =
                (before.iter().collect(), behind.iter().collect());
            format!(":{before}\u{2038}{behind}")
        });
        self.line.show(shown);
    }
}

fn common_start(a: &str, b: &str) -> String {
    a.chars().zip(b.chars()).take_while(|(a, b)| a == b).map(|(a, _)| a).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn typed(prompt: &mut Prompt, keys: &str) {
        for key in keys.chars() {
            assert_eq!(prompt.key(KeyCode::Char(key), |_| Vec::new()), Edited::Typing);
        }
    }

    fn press(prompt: &mut Prompt, key: KeyCode) -> Edited {
        prompt.key(key, |typed| {
            let words = ["load square.txt", "load squarish.txt", "land"];
            words.iter().filter(|word| word.starts_with(typed)).map(ToString::to_string).collect()
        })
    }

    #[test]
    fn a_line_is_edited_and_entered() {
        let line = PromptLine::default();
        let mut prompt = Prompt::new(line.clone());
        assert!(!prompt.is_open() && line.shown().is_none());
        prompt.open();
        typed(&mut prompt, "gto 0");
        for _ in 0..4 {
            press(&mut prompt, KeyCode::Left);
        }
        typed(&mut prompt, "o");
        assert_eq!(line.shown().as_deref(), Some(":go\u{2038}to 0"));
        assert_eq!(press(&mut prompt, KeyCode::Enter), Edited::Entered("goto 0".to_owned()));
        assert!(!prompt.is_open() && line.shown().is_none());
    }

    #[test]
    fn what_was_typed_before_comes_back() {
        let mut prompt = Prompt::new(PromptLine::default());
        for line in ["takeoff", "hold"] {
            prompt.open();
            typed(&mut prompt, line);
            press(&mut prompt, KeyCode::Enter);
        }
        prompt.open();
        press(&mut prompt, KeyCode::Up);
        press(&mut prompt, KeyCode::Up);
        press(&mut prompt, KeyCode::Up);
        assert_eq!(press(&mut prompt, KeyCode::Enter), Edited::Entered("takeoff".to_owned()));
        prompt.open();
        press(&mut prompt, KeyCode::Up);
        press(&mut prompt, KeyCode::Down);
        assert_eq!(press(&mut prompt, KeyCode::Backspace), Edited::Cancelled, "it is empty again");
    }

    #[test]
    fn tab_completes_as_far_as_it_is_certain() {
        let mut prompt = Prompt::new(PromptLine::default());
        prompt.open();
        typed(&mut prompt, "lo");
        press(&mut prompt, KeyCode::Tab);
        typed(&mut prompt, "e");
        press(&mut prompt, KeyCode::Tab);
        assert_eq!(
            press(&mut prompt, KeyCode::Enter),
            Edited::Entered("load square.txt".to_owned())
        );
        prompt.open();
        typed(&mut prompt, "la");
        press(&mut prompt, KeyCode::Tab);
        assert_eq!(press(&mut prompt, KeyCode::Enter), Edited::Entered("land".to_owned()));
    }
}
