//! Lists of tokens as the protocol has them, and what changes from one to the next.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use diagnostic::Span;
use gen_lsp_types::SemanticTokensEdit;

use super::files::File;

/// Numbers of each token in the protocol.
const NUMBERS: usize = 5;

/// The lists that the client has, by text.
#[derive(Debug, Default)]
pub(super) struct SentTokens {
    sent: HashMap<PathBuf, (u64, Vec<u32>)>,
    count: u64,
}

impl SentTokens {
    pub(super) fn forget(&mut self, path: &Path) {
        self.sent.remove(path);
    }

    /// Keeps a list that is sent. Returns its name.
    pub(super) fn remember(&mut self, path: PathBuf, data: Vec<u32>) -> String {
        self.count += 1;
        self.sent.insert(path, (self.count, data));
        self.count.to_string()
    }

    /// What has changed since a list was sent; `None` if it is not the last one.
    pub(super) fn changes(
        &self,
        path: &Path,
        name: &str,
        data: &[u32],
    ) -> Option<Vec<SemanticTokensEdit>> {
        let (id, old) = self.sent.get(path)?;
        (id.to_string() == name).then(|| difference(old, data))
    }
}

/// Each token relative to the one before it.
pub(super) fn encoded(file: &File, tokens: &[(Span, u32, u32)]) -> Vec<u32> {
    let mut data = Vec::with_capacity(tokens.len() * NUMBERS);
    let (mut line, mut column) = (0, 0);
    for (span, kind, modifiers) in tokens {
        let place = file.place(span);
        if place.start.line != line {
            column = 0;
        }
        let length = place.end.character.saturating_sub(place.start.character);
        let start = place.start.character;
        data.extend([place.start.line - line, start - column, length, *kind, *modifiers]);
        (line, column) = (place.start.line, start);
    }
    data
}

/// What is between the common begin and the common end of two lists of tokens.
fn difference(old: &[u32], new: &[u32]) -> Vec<SemanticTokensEdit> {
    if old == new {
        return Vec::new();
    }
    let same = |(one, other): &(&u32, &u32)| one == other;
    // Whole tokens.
    let start = old.iter().zip(new).take_while(same).count() / NUMBERS * NUMBERS;
    let (old, new) = (&old[start..], &new[start..]);
    let end = old.iter().rev().zip(new.iter().rev()).take_while(same).count() / NUMBERS * NUMBERS;
    let number = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    vec![SemanticTokensEdit {
        start: number(start),
        delete_count: number(old.len() - end),
        data: Some(new[..new.len() - end].to_vec()),
    }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_applied_to_the_old_list_gives_the_new_one() {
        let token = |n: u32| [0, n, 1, 2, 0];
        let list = |numbers: &[u32]| numbers.iter().flat_map(|n| token(*n)).collect::<Vec<u32>>();
        for (old, new) in [
            (&[1, 2, 3][..], &[1, 2, 3][..]),
            (&[1, 2, 3], &[1, 3]),
            (&[1, 1], &[1, 1, 1]),
            (&[], &[4]),
            (&[4], &[]),
            (&[1, 2, 3], &[1, 5, 3]),
        ] {
            let (old, new) = (list(old), list(new));
            let mut edited = old.clone();
            for edit in difference(&old, &new) {
                let start = usize::try_from(edit.start).unwrap();
                let end = start + usize::try_from(edit.delete_count).unwrap();
                edited.splice(start..end, edit.data.unwrap());
            }
            assert_eq!(edited, new);
        }
    }
}
