//! Files that are written whole or not at all: a draft beside each takes its place once it is complete.

use std::fs::{self, Permissions};
use std::io::{self, Write as _};
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

/// Who may read and write a new file, less whom the process's umask excludes.
const NEW: u32 = 0o666;
/// Who may read and write a draft before it has the permissions of the file whose place it takes.
const OWNER: u32 = 0o600;

/// An empty draft of a file, in its folder and with its permissions; deleted when dropped. `persist` puts it into its place.
///
/// # Errors
/// Those of the file system, without the name of the draft.
pub(crate) fn draft(path: &Path) -> io::Result<NamedTempFile> {
    // A link is replaced: who may read what it leads to says nothing of the new file.
    let replaced = fs::symlink_metadata(path).ok().filter(fs::Metadata::is_file);
    let draft = begun(path, if replaced.is_some() { OWNER } else { NEW })?;
    if let Some(replaced) = replaced {
        let mode = replaced.permissions().mode() & 0o777;
        let file = draft.as_file();
        // Some file systems have the same permissions for all files, and let nobody set them.
        if file.metadata()?.permissions().mode() & 0o777 != mode {
            file.set_permissions(Permissions::from_mode(mode))?;
        }
    }
    Ok(draft)
}

fn begun(path: &Path, mode: u32) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    Builder::new()
        .prefix(".")
        .suffix(".new")
        .permissions(Permissions::from_mode(mode))
        .tempfile_in(folder.unwrap_or(Path::new(".")))
        // With its text it names the draft, of which nobody has heard.
        .map_err(|error| error.kind().into())
}

/// Writes a file, which takes the place of one that may be there.
///
/// # Errors
/// Those of the file system; what was there is as it was.
pub(crate) fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    complete(path, content)?.persist(path)?;
    Ok(())
}

/// Writes a file where there is none.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`], or those of the file system.
pub(crate) fn create(path: &Path, content: &[u8]) -> io::Result<()> {
    complete(path, content)?.persist_noclobber(path)?;
    Ok(())
}

fn complete(path: &Path, content: &[u8]) -> io::Result<NamedTempFile> {
    let draft = draft(path)?;
    draft.as_file().write_all(content)?;
    Ok(draft)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().permissions().mode() & 0o777
    }

    #[test]
    fn a_file_keeps_its_permissions_and_a_new_one_has_those_of_new_files() {
        let folder = tempfile::tempdir().unwrap();
        let [old, new, usual] = ["old", "new", "usual"].map(|name| folder.path().join(name));
        fs::write(&usual, "").unwrap();
        fs::write(&old, "one").unwrap();
        for secrecy in [0o600, 0o644, 0o664] {
            fs::set_permissions(&old, Permissions::from_mode(secrecy)).unwrap();
            assert_eq!(mode(begun(&old, OWNER).unwrap().path()), 0o600, "at first");
            assert_eq!(mode(draft(&old).unwrap().path()), secrecy);
            replace(&old, b"two").unwrap();
            assert_eq!(mode(&old), secrecy);
        }
        assert_eq!(fs::read(&old).unwrap(), b"two");
        create(&new, b"new").unwrap();
        assert_eq!(mode(&new), mode(&usual));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3, "no draft is left");
    }

    #[test]
    fn what_is_there_is_not_created_and_a_link_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| folder.path().join(name));
        create(&file, b"one").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        fs::set_permissions(&file, Permissions::from_mode(0o600)).unwrap();
        for there in [&file, &link] {
            let error = create(there, b"two").unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        }
        replace(&link, b"three").unwrap();
        assert!(!link.is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"one");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "no draft is left");
    }

    #[test]
    fn what_cannot_be_replaced_leaves_no_draft() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pilot.toml");
        fs::create_dir(&path).unwrap();
        assert!(replace(&path, b"text").is_err());
        assert!(create(&path, b"text").is_err());
        let nowhere = folder.path().join("none/pilot.toml");
        let error = replace(&nowhere, b"text").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotFound);
        assert!(!error.to_string().contains(".new"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
