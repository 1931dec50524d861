//! The prompt of `asl2c run` at a terminal: editing, history and completion.

use rustyline::completion::Completer;
use rustyline::config::CompletionType;
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::MemHistory;
use rustyline::validate::Validator;
use rustyline::{Config, Context, Editor, Helper};

/// Reads lines from a terminal.
pub(super) struct Prompt {
    editor: Editor<Words, MemHistory>,
}

impl Prompt {
    /// A prompt with completion of these words.
    pub(super) fn new(words: Vec<String>) -> Result<Self, ReadlineError> {
        let config = Config::builder().completion_type(CompletionType::List).build();
        let mut editor = Editor::with_history(config, MemHistory::new())?;
        editor.set_helper(Some(Words(words)));
        Ok(Self { editor })
    }

    /// The next line; `None` at the end of the input. An interrupted line is empty.
    pub(super) fn line(&mut self) -> Result<Option<String>, ReadlineError> {
        match self.editor.readline("> ") {
            Ok(line) => {
                self.editor.add_history_entry(&line)?;
                Ok(Some(line))
            }
            Err(ReadlineError::Interrupted) => Ok(Some(String::new())),
            Err(ReadlineError::Eof) => Ok(None),
            Err(error) => Err(error),
        }
    }
}

/// Possible beginnings of a line.
struct Words(Vec<String>);

impl Words {
    /// Start of the last word, and its completions.
    fn completions(&self, line: &str) -> (usize, Vec<String>) {
        let start = line.rfind([' ', ';']).map_or(0, |index| index + 1);
        let begun = line.get(start..).unwrap_or_default();
        (start, self.0.iter().filter(|word| word.starts_with(begun)).cloned().collect())
    }
}

impl Completer for Words {
    type Candidate = String;

    fn complete(
        &self,
        line: &str,
        position: usize,
        _: &Context<'_>,
    ) -> rustyline::Result<(usize, Vec<String>)> {
        Ok(self.completions(line.get(..position).unwrap_or(line)))
    }
}

impl Hinter for Words {
    type Hint = String;
}

impl Highlighter for Words {}
impl Validator for Words {}
impl Helper for Words {}

#[cfg(test)]
mod tests {
    use super::Words;

    #[test]
    fn the_last_word_is_completed() {
        let words = ["achieve_land(", "achieve_go(", "step"].map(str::to_owned);
        let words = Words(words.to_vec());
        assert_eq!(words.completions("ach").1, ["achieve_land(", "achieve_go("]);
        assert_eq!(words.completions("step; achieve_l"), (6, vec!["achieve_land(".to_owned()]));
        assert_eq!(words.completions("zzz").1, [""; 0]);
    }
}
