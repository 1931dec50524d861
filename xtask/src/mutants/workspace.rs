//! A copy of the workspace for building mutants. It is kept together with its target folder, so that only the
//! crates affected by a mutant are built again.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use super::MutantsError;
use crate::edit::Mutant;
use crate::files::{FileError, cannot, read, write};

/// Target folder of the copy.
const TARGET: &str = "target";

/// The workspace and its copy.
#[derive(Debug)]
pub(super) struct Workspace {
    original: PathBuf,
    copy: PathBuf,
}

/// New contents of files, by path.
pub(super) type Changed = BTreeMap<&'static str, String>;

impl Workspace {
    /// Copies the workspace's files that git tracks or would track. Unchanged files are not touched, because
    /// cargo goes by modification times.
    pub(super) fn copy(original: &Path, folder: &Path) -> Result<Self, MutantsError> {
        let workspace = Self { original: original.to_owned(), copy: folder.join("workspace") };
        let files = workspace.files()?;
        for file in &files {
            workspace.update(file)?;
        }
        workspace.remove_others(&workspace.copy, &files)?;
        let copy = &workspace.copy;
        let copy = copy.canonicalize().map_err(cannot("find", copy))?;
        Ok(Self { copy, ..workspace })
    }

    /// The workspace itself, without a copy.
    #[cfg(test)]
    pub(super) fn here(original: &Path) -> Self {
        Self { original: original.to_owned(), copy: original.to_owned() }
    }

    /// Folder of the copy.
    pub(super) fn root(&self) -> &Path {
        &self.copy
    }

    /// Target folder of the copy.
    pub(super) fn target(&self) -> PathBuf {
        self.copy.join(TARGET)
    }

    /// Contents of the files of a mutant.
    ///
    /// # Errors
    /// [`MutantsError::Changed`] if a text to be replaced does not occur exactly once.
    pub(super) fn changed<E>(&self, mutant: &Mutant<E>) -> Result<Changed, MutantsError> {
        let mut changed = Changed::new();
        for edit in mutant.edits() {
            let text = if let Some(text) = changed.remove(edit.file) {
                text
            } else {
                read(&self.original.join(edit.file))?
            };
            let text = edit.apply(&text).map_err(|times| {
                let (name, file) = (mutant.name, edit.file);
                MutantsError::Changed { name, file, times }
            })?;
            changed.insert(edit.file, text);
        }
        Ok(changed)
    }

    /// Applies a mutant to the copy.
    pub(super) fn put(&self, changed: &Changed) -> Result<(), MutantsError> {
        for (file, text) in changed {
            let path = self.copy.join(file);
            write(&path, text)?;
        }
        Ok(())
    }

    /// Restores the copy to the original.
    pub(super) fn restore(&self, changed: &Changed) -> Result<(), FileError> {
        changed.keys().try_for_each(|file| self.update(Path::new(file)))
    }

    fn files(&self) -> Result<BTreeSet<PathBuf>, MutantsError> {
        let git = Command::new("git")
            .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
            .current_dir(&self.original)
            .output()
            .map_err(cannot("run", Path::new("git")))?;
        let names = String::from_utf8_lossy(&git.stdout).into_owned();
        let files = names.split('\0').filter(|name| !name.is_empty()).map(PathBuf::from);
        // A file that was deleted but not yet committed must not be copied.
        Ok(files.filter(|file| self.original.join(file).is_file()).collect())
    }

    fn update(&self, file: &Path) -> Result<(), FileError> {
        let (from, to) = (self.original.join(file), self.copy.join(file));
        let content = std::fs::read(&from).map_err(cannot("read", &from))?;
        if std::fs::read(&to).is_ok_and(|there| there == content) {
            return Ok(());
        }
        if let Some(folder) = to.parent() {
            std::fs::create_dir_all(folder).map_err(cannot("make", folder))?;
        }
        std::fs::write(&to, content).map_err(cannot("write", &to))
    }

    /// Removes files that the original does not have.
    fn remove_others(&self, folder: &Path, files: &BTreeSet<PathBuf>) -> Result<(), MutantsError> {
        let entries = std::fs::read_dir(folder).map_err(cannot("read", folder))?;
        for entry in entries {
            let path = entry.map_err(cannot("read", folder))?.path();
            let Ok(own) = path.strip_prefix(&self.copy) else { continue };
            if path.is_dir() {
                if own != Path::new(TARGET) {
                    self.remove_others(&path, files)?;
                }
            } else if !files.contains(own) {
                std::fs::remove_file(&path).map_err(cannot("remove", &path))?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::list::{Mutant, mutant};
    use super::*;
    use crate::edit::{edit, layered};

    const CLIPPY: &str = "clippy.toml";
    const TWICE: Mutant = layered(
        mutant("twice", CLIPPY, "allow-unwrap-in-tests", "a"),
        &[edit(CLIPPY, "allow-expect-in-tests", "b")],
    );
    const GONE: Mutant = mutant("gone", CLIPPY, "no such", "");
    const MANY: Mutant = mutant("many", CLIPPY, "allow-", "");

    #[test]
    fn a_mutant_of_other_code_is_no_mutant() {
        let workspace = Workspace::here(Path::new(".."));
        let changed = workspace.changed(&TWICE).unwrap();
        let text = &changed["clippy.toml"];
        assert!(changed.len() == 1 && text.contains("a = true") && text.contains("b = true"));
        for (mutant, expected) in [(GONE, 0), (MANY, 3)] {
            let error = workspace.changed(&mutant).unwrap_err();
            assert!(matches!(error, MutantsError::Changed { times, .. } if times == expected));
            assert!(error.to_string().contains("mend the mutant"), "{error}");
        }
    }
}
