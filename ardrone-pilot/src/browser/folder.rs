//! Files of one folder, by their names: there is no way out of it.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::whole_file;

/// Maximum length of a file name.
const LONGEST_NAME: usize = 100;

/// A folder whose files of one kind the page lists, reads and writes.
#[derive(Debug, Clone)]
pub(super) struct Folder {
    path: PathBuf,
    /// With the dot.
    extension: &'static str,
}

/// A file of the folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) bytes: u64,
    pub(super) modified: SystemTime,
}

/// Why a file is not read or written.
#[derive(Debug, thiserror::Error)]
pub(super) enum FolderError {
    #[error(
        "`{0}` cannot be the name of a file here: letters, digits, spaces, `.`, `_` and `-`, at most {LONGEST_NAME}, and {1} at the end"
    )]
    Name(String, &'static str),
    #[error("there is no {0}")]
    Missing(String),
    #[error("{0} exists already")]
    Exists(String),
    #[error("{0} is larger than {1} bytes")]
    TooLarge(String, u64),
    #[error("{0}: {1}")]
    System(String, #[source] io::Error),
}

impl Folder {
    pub(super) fn new(path: PathBuf, extension: &'static str) -> Self {
        Self { path, extension }
    }

    /// The files, by name. A folder that does not exist has none.
    ///
    /// # Errors
    /// [`FolderError::System`] if it cannot be read.
    pub(super) fn list(&self) -> Result<Vec<Entry>, FolderError> {
        let system = |error| FolderError::System(self.path.display().to_string(), error);
        let files = match fs::read_dir(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            files => files.map_err(system)?,
        };
        let entry = |file: fs::DirEntry| {
            let name = file.file_name().into_string().ok()?;
            self.path_of(&name).ok()?;
            // Not that of the file to which a link leads.
            let metadata = file.metadata().ok().filter(fs::Metadata::is_file)?;
            let modified = metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            Some(Entry { name, bytes: metadata.len(), modified })
        };
        let mut entries: Vec<Entry> = files.flatten().filter_map(entry).collect();
        entries.sort_by(|one, other| one.name.cmp(&other.name));
        Ok(entries)
    }

    /// Opens a file; returns its length, too.
    ///
    /// # Errors
    /// [`FolderError`] if it is none of the folder.
    pub(super) fn open(&self, name: &str) -> Result<(File, u64), FolderError> {
        let path = self.path_of(name)?;
        let error = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => FolderError::Missing(name.to_owned()),
            _ => FolderError::System(name.to_owned(), error),
        };
        let metadata = fs::symlink_metadata(&path).map_err(error)?;
        if !metadata.is_file() {
            return Err(FolderError::Missing(name.to_owned()));
        }
        Ok((File::open(&path).map_err(error)?, metadata.len()))
    }

    /// The content of a file.
    ///
    /// # Errors
    /// [`FolderError`] if it is none of the folder, or larger than `most_bytes`.
    pub(super) fn read(&self, name: &str, most_bytes: u64) -> Result<Vec<u8>, FolderError> {
        let too_large = || FolderError::TooLarge(name.to_owned(), most_bytes);
        let (file, bytes) = self.open(name)?;
        if bytes > most_bytes {
            return Err(too_large());
        }
        let mut content = Vec::new();
        // It may grow meanwhile.
        let read = file.take(most_bytes + 1).read_to_end(&mut content);
        read.map_err(|error| FolderError::System(name.to_owned(), error))?;
        if content.len() as u64 > most_bytes {
            return Err(too_large());
        }
        Ok(content)
    }

    /// Writes a file, whole or not at all. `replaces` allows that there is one of that name.
    ///
    /// # Errors
    /// [`FolderError`] if it cannot be written, or exists already.
    pub(super) fn write(
        &self,
        name: &str,
        content: &[u8],
        replaces: bool,
    ) -> Result<(), FolderError> {
        let path = self.path_of(name)?;
        let system = |error| FolderError::System(name.to_owned(), error);
        fs::create_dir_all(&self.path).map_err(system)?;
        let written = if replaces {
            whole_file::replace(&path, content)
        } else {
            whole_file::create(&path, content)
        };
        written.map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => FolderError::Exists(name.to_owned()),
            _ => system(error),
        })
    }

    /// Deletes a file.
    ///
    /// # Errors
    /// [`FolderError`] if it is none of the folder, or cannot be deleted.
    pub(super) fn delete(&self, name: &str) -> Result<(), FolderError> {
        self.open(name)?;
        let system = |error| FolderError::System(name.to_owned(), error);
        fs::remove_file(self.path_of(name)?).map_err(system)
    }

    /// Whether a path leads to the file of this name.
    pub(super) fn is(&self, name: &str, path: &Path) -> bool {
        path.file_name().is_some_and(|file| file == name)
            && path.canonicalize().ok() == self.path.join(name).canonicalize().ok()
    }

    fn path_of(&self, name: &str) -> Result<PathBuf, FolderError> {
        let plain = |c: char| c.is_alphanumeric() || matches!(c, '.' | '_' | '-' | ' ');
        let fits = name.chars().all(plain)
            && !name.starts_with(['.', ' ', '-'])
            && name.chars().count() <= LONGEST_NAME
            && name.strip_suffix(self.extension).is_some_and(|stem| !stem.is_empty());
        if fits {
            Ok(self.path.join(name))
        } else {
            let shown: String = name.chars().take(LONGEST_NAME).collect();
            Err(FolderError::Name(diagnostic::printable(&shown).into_owned(), self.extension))
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn folder() -> (tempfile::TempDir, Folder) {
        let outside = tempfile::tempdir().unwrap();
        fs::write(outside.path().join("secret.txt"), "secret").unwrap();
        let folder = Folder::new(outside.path().join("plans"), ".txt");
        (outside, folder)
    }

    #[test]
    fn files_are_written_read_listed_and_deleted() {
        let (_outside, folder) = folder();
        assert_eq!(folder.list().unwrap(), []);
        folder.write("a b.txt", b"one", false).unwrap();
        assert!(matches!(folder.write("a b.txt", b"two", false), Err(FolderError::Exists(_))));
        assert_eq!(folder.read("a b.txt", 3).unwrap(), b"one");
        folder.write("a b.txt", b"three", true).unwrap();
        assert_eq!(folder.read("a b.txt", 5).unwrap(), b"three");
        assert!(matches!(folder.read("a b.txt", 4), Err(FolderError::TooLarge(_, 4))));
        let listed: Vec<_> =
            folder.list().unwrap().into_iter().map(|entry| (entry.name, entry.bytes)).collect();
        assert_eq!(listed, [("a b.txt".to_owned(), 5)]);
        folder.delete("a b.txt").unwrap();
        assert!(matches!(folder.delete("a b.txt"), Err(FolderError::Missing(_))));
        assert_eq!(folder.list().unwrap(), []);
    }

    #[test]
    fn no_name_and_no_link_leads_out() {
        let (outside, folder) = folder();
        folder.write("plan.txt", b"", false).unwrap();
        for name in [
            "../secret.txt",
            "..\\secret.txt",
            "/etc/hosts.txt",
            ".txt",
            ".hidden.txt",
            "secret",
            "plan.mcap",
            "a\0.txt",
            "a/b.txt",
            "c:a.txt",
            "-x.txt",
            "",
        ] {
            assert!(matches!(folder.read(name, 99), Err(FolderError::Name(..))), "{name}");
            assert!(matches!(folder.write(name, b"", true), Err(FolderError::Name(..))), "{name}");
            assert!(matches!(folder.delete(name), Err(FolderError::Name(..))), "{name}");
        }
        #[cfg(unix)]
        {
            let link = outside.path().join("plans/link.txt");
            std::os::unix::fs::symlink(outside.path().join("secret.txt"), link).unwrap();
            assert!(matches!(folder.read("link.txt", 99), Err(FolderError::Missing(_))));
            assert!(matches!(folder.delete("link.txt"), Err(FolderError::Missing(_))));
            assert_eq!(folder.list().unwrap().len(), 1);
            // What is written replaces the link, not the file behind it.
            folder.write("link.txt", b"ours", true).unwrap();
        }
        assert_eq!(fs::read(outside.path().join("secret.txt")).unwrap(), b"secret");
    }

    proptest! {
        #[test]
        fn accepted_names_stay_inside(name in "\\PC{0,40}(\\.txt)?") {
            let folder = Folder::new(PathBuf::from("plans"), ".txt");
            if let Ok(path) = folder.path_of(&name) {
                prop_assert_eq!(path.parent(), Some(Path::new("plans")));
                prop_assert_eq!(path.file_name().and_then(|name| name.to_str()), Some(&*name));
            }
        }
    }
}
