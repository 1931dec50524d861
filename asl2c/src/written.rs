//! All files that people get from this tool are written here, by one rule: nothing is overwritten or removed but what this
//! tool has written and nobody has changed since, and nothing is written through a link.
//!
//! What the tool has written is known by its last line, a comment with the checksum of all lines before, or by a file with
//! such a line that lists it. All files of a call are written, or none.

use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempPath};

use crate::checksum::checksum;

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum WriteError {
    /// The file is somebody else's.
    #[error(
        "{path} is not as asl2c left it: somebody else wrote or changed it; nothing is changed; move it away, or {help}"
    )]
    Foreign { path: PathBuf, help: &'static str },
    /// A link, to something or nothing, or a folder on the way that is one.
    #[error(
        "{path} is a link, through which nothing is written; nothing is changed; remove the link, or name what it leads to"
    )]
    Link { path: PathBuf },
    /// A file, or the folder for it.
    #[error("cannot write {path}: {source}; nothing is changed")]
    Io { path: PathBuf, source: std::io::Error },
}

impl WriteError {
    /// The file or link.
    pub(crate) fn path(&self) -> &Path {
        match self {
            Self::Foreign { path, .. } | Self::Link { path } | Self::Io { path, .. } => path,
        }
    }
}

/// How the last line is a comment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Comment {
    /// Of C.
    C,
    /// Of Rust, and of scripts for `asl2c run`.
    Slashes,
    /// Of `sha256sum`.
    Hash,
}

/// The text with a last line by which it is known again.
pub(crate) fn marked(text: &str, comment: Comment) -> String {
    format!("{text}{}\n", mark(text, comment))
}

/// The last line of a text.
fn mark(text: &str, comment: Comment) -> String {
    let sum = checksum(text.as_bytes());
    match comment {
        Comment::C => format!("/* asl2c wrote this: sha256 {sum} */"),
        Comment::Slashes => format!("// asl2c wrote this: sha256 {sum}"),
        Comment::Hash => format!("# asl2c wrote this: sha256 {sum}"),
    }
}

/// Whether this tool wrote a text, and nobody has changed it since.
pub(crate) fn is_own(text: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(text) else { return false };
    let Some(lines) = text.strip_suffix('\n') else { return false };
    let (before, last) = lines.split_at(lines.rfind('\n').map_or(0, |end| end + 1));
    [Comment::C, Comment::Slashes, Comment::Hash]
        .iter()
        .any(|comment| mark(before, *comment) == last)
}

/// A file to write.
pub(crate) struct New<'a> {
    /// Its place below the folder, with `/` between its parts.
    pub(crate) name: &'a str,
    pub(crate) text: &'a str,
    /// Whether a file with this text is one that may be replaced.
    pub(crate) replaces: &'a dyn Fn(&[u8]) -> bool,
    /// What else to do about another one.
    pub(crate) help: &'static str,
}

/// Writes files into a folder that exists; all or none: each is first written completely under another name, and if one
/// cannot be moved to its place the others are restored. Then the `stale` ones are removed.
pub(crate) fn write(folder: &Path, files: &[New<'_>], stale: &[New<'_>]) -> Result<(), WriteError> {
    let mut removed = Vec::new();
    for file in stale {
        let path = folder.join(file.name);
        if let Some(old) = existing(folder, file)? {
            removed.push((path, old));
        }
    }
    let mut prepared = Vec::new();
    for file in files {
        prepared.push(prepare(folder, file)?);
    }
    replace(prepared)?;
    for (path, old) in removed {
        let failed = |source| WriteError::Io { path: path.clone(), source };
        old.check(&path)?;
        std::fs::remove_file(&path).map_err(failed)?;
    }
    Ok(())
}

/// A file that was there before, under a second name: it is still to be had when another one is in its place.
struct Old {
    kept: TempPath,
    text: Vec<u8>,
    help: &'static str,
}

impl Old {
    /// Whether the file is what was judged: it may have been changed meanwhile.
    fn check(&self, path: &Path) -> Result<(), WriteError> {
        let now = std::fs::read(&self.kept)
            .map_err(|source| WriteError::Io { path: path.to_owned(), source })?;
        let foreign = || WriteError::Foreign { path: path.to_owned(), help: self.help };
        if now == self.text { Ok(()) } else { Err(foreign()) }
    }
}

/// A file that was written beside the one it will replace.
struct Prepared {
    path: PathBuf,
    new: NamedTempFile,
    old: Option<Old>,
}

/// The file in this place that may be replaced or removed, if there is one.
fn existing(folder: &Path, file: &New<'_>) -> Result<Option<Old>, WriteError> {
    let path = folder.join(file.name);
    let failed = |source| WriteError::Io { path: path.clone(), source };
    // A link is noticed before what it leads to is looked at, and so is what would not end, such as a pipe.
    let mut place = folder.to_owned();
    let mut found = None;
    for part in Path::new(file.name).components() {
        place.push(part);
        found = match std::fs::symlink_metadata(&place) {
            Ok(data) if data.is_symlink() => return Err(WriteError::Link { path: place }),
            Ok(data) => Some(data),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(failed(error)),
        };
        if found.is_none() && part != Component::CurDir {
            break;
        }
    }
    let Some(found) = found else { return Ok(None) };
    if !found.is_file() {
        return Err(failed(std::io::Error::other("there is something that is not a regular file")));
    }
    if found.permissions().readonly() {
        return Err(failed(ErrorKind::PermissionDenied.into()));
    }
    let parent = or_here(path.parent().unwrap_or(folder));
    let keep = |kept: &Path| {
        std::fs::hard_link(&path, kept).or_else(|_| std::fs::copy(&path, kept).map(|_| ()))
    };
    let kept = Builder::new().make_in(parent, keep).map_err(failed)?.into_temp_path();
    // It may have become one since.
    if std::fs::symlink_metadata(&kept).map_err(failed)?.is_symlink() {
        return Err(WriteError::Link { path });
    }
    let mut text = Vec::new();
    let read = std::fs::File::open(&kept).and_then(|mut file| file.read_to_end(&mut text));
    read.map_err(failed)?;
    if !(file.replaces)(&text) {
        return Err(WriteError::Foreign { path, help: file.help });
    }
    Ok(Some(Old { kept, text, help: file.help }))
}

/// Whether a file may be replaced, or is not there.
pub(crate) fn check(folder: &Path, file: &New<'_>) -> Result<(), WriteError> {
    existing(folder, file).map(|_| ())
}

/// Makes a folder, and those below it, none of which is a link.
pub(crate) fn make_folders(folder: &Path, below: &Path) -> Result<(), WriteError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| WriteError::Io { path, source }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    let mut place = folder.to_owned();
    for part in below.components() {
        place.push(part);
        match std::fs::create_dir(&place) {
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            made => made.map_err(failed(&place))?,
        }
        if std::fs::symlink_metadata(&place).map_err(failed(&place))?.is_symlink() {
            return Err(WriteError::Link { path: place });
        }
    }
    Ok(())
}

fn prepare(folder: &Path, file: &New<'_>) -> Result<Prepared, WriteError> {
    let path = folder.join(file.name);
    let old = existing(folder, file)?;
    let failed = |source| WriteError::Io { path: path.clone(), source };
    let mut builder = Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As for any new file, so that the user's umask applies.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut new = builder.tempfile_in(or_here(path.parent().unwrap_or(folder))).map_err(failed)?;
    new.write_all(file.text.as_bytes()).map_err(failed)?;
    new.as_file().sync_all().map_err(failed)?;
    if let Some(old) = &old {
        let permissions = std::fs::metadata(&old.kept).map_err(failed)?.permissions();
        std::fs::set_permissions(new.path(), permissions).map_err(failed)?;
    }
    Ok(Prepared { path, new, old })
}

fn replace(prepared: Vec<Prepared>) -> Result<(), WriteError> {
    let mut replaced: Vec<(PathBuf, Option<Old>)> = Vec::new();
    let restore = |replaced: Vec<(PathBuf, Option<Old>)>| {
        for (path, old) in replaced.into_iter().rev() {
            // If restoring fails nothing more can be done; the original error is reported.
            _ = match old {
                Some(old) => old.kept.persist(&path).map_err(|error| error.error),
                None => std::fs::remove_file(&path),
            };
        }
    };
    for Prepared { path, new, old } in prepared {
        // A rename replaces a link, and leaves what it leads to as it is. What has come meanwhile is not replaced.
        let moved = match &old {
            Some(_) => new.persist(&path),
            None => new.persist_noclobber(&path),
        };
        if let Err(error) = moved {
            restore(replaced);
            return Err(WriteError::Io { path, source: error.error });
        }
        let checked = old.as_ref().map_or(Ok(()), |old| old.check(&path));
        replaced.push((path, old));
        if let Err(error) = checked {
            restore(replaced);
            return Err(error);
        }
    }
    Ok(())
}

/// The bytes of a regular file, if there is one in this place that is no link.
pub(crate) fn regular(path: &Path) -> Option<Vec<u8>> {
    let is_file = std::fs::symlink_metadata(path).is_ok_and(|data| data.is_file());
    is_file.then(|| std::fs::read(path).ok()).flatten()
}

/// Writes a script for `asl2c run` in place of none, or of one that this tool has written.
pub(crate) fn write_script(folder: &Path, name: &str, text: &str) -> Result<PathBuf, WriteError> {
    let text = marked(text, Comment::Slashes);
    write(folder, &[script(name, &text)], &[])?;
    Ok(folder.join(name))
}

/// Whether a script can be written, as far as it is known before: the folder is there, and no other file in its place.
pub(crate) fn check_script(folder: &Path, name: &str) -> Result<(), WriteError> {
    let folder = or_here(folder);
    let path = || folder.to_owned();
    let data =
        std::fs::metadata(folder).map_err(|source| WriteError::Io { path: path(), source })?;
    if !data.is_dir() {
        return Err(WriteError::Io { path: path(), source: ErrorKind::NotADirectory.into() });
    }
    check(folder, &script(name, ""))
}

fn script<'a>(name: &'a str, text: &'a str) -> New<'a> {
    New { name, text, replaces: &is_own, help: "name another folder by `-o DIR`" }
}

/// Replaces the text that was read from a file by another one.
pub(crate) fn rewrite(path: &Path, read: &str, text: &str) -> Result<(), WriteError> {
    let replaces = |old: &[u8]| old == read.as_bytes();
    let help = "format it again";
    let name = path.file_name().map(|name| name.to_string_lossy());
    let folder = path.parent().unwrap_or(path);
    let name = name.unwrap_or_default();
    write(folder, &[New { name: &name, text, replaces: &replaces, help }], &[])
}

/// The folder; the current one for a path without a folder.
pub(crate) fn or_here(folder: &Path) -> &Path {
    if folder == Path::new("") { Path::new(".") } else { folder }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_known_until_it_is_changed() {
        for comment in [Comment::C, Comment::Slashes, Comment::Hash] {
            for text in ["", "int a;\n", "one\n\ntwo\n"] {
                let known = marked(text, comment);
                assert!(is_own(known.as_bytes()), "{known}");
                assert!(known.starts_with(text));
                for changed in [
                    format!(" {known}"),
                    format!("{known}\n"),
                    format!("{known}more\n"),
                    known.trim_end().to_owned(),
                    text.to_owned(),
                    format!("{text}// asl2c wrote this: sha256 \n"),
                ] {
                    assert!(!is_own(changed.as_bytes()), "{changed}");
                }
            }
        }
        assert!(!is_own(b"\xff\n"));
    }

    /// What is changed between the judgement and the replacement is not lost.
    #[test]
    fn what_is_changed_meanwhile_is_restored() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        std::fs::write(place("a"), "old").unwrap();
        std::fs::write(place("b"), "old").unwrap();
        let any = |_: &[u8]| true;
        let new = |name| New { name, text: "new", replaces: &any, help: "" };
        let prepared = ["a", "b"].map(|name| prepare(folder.path(), &new(name)).unwrap());
        let mut open = std::fs::OpenOptions::new().append(true).open(place("b")).unwrap();
        open.write_all(b" and more").unwrap();
        assert!(matches!(replace(prepared.into()), Err(WriteError::Foreign { .. })));
        let text = |name: &str| std::fs::read_to_string(place(name)).unwrap();
        assert_eq!((text("a"), text("b")), ("old".to_owned(), "old and more".to_owned()));
        let prepared = ["a", "c"].map(|name| prepare(folder.path(), &new(name)).unwrap());
        std::fs::write(place("c"), "mine").unwrap();
        assert!(matches!(replace(prepared.into()), Err(WriteError::Io { .. })));
        assert_eq!((text("a"), text("c")), ("old".to_owned(), "mine".to_owned()));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
    }
}
