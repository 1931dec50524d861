//! All files that people get from this tool are written here, by one rule: nothing is overwritten or removed but what this
//! tool has written and nobody has changed since, and nothing is written through a link.
//!
//! What the tool has written is known by its last line, a comment with the checksum of all lines before, or by a file with
//! such a line that lists it. All files of a call are written, or none.

use std::io::{ErrorKind, Write as _};
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

/// Writes files into a folder, which is made if it is missing; all or none: each is first written completely under another name,
/// and if one cannot be moved to its place the others are restored. Then the `stale` ones are removed.
pub(crate) fn write(folder: &Path, files: &[New<'_>], stale: &[New<'_>]) -> Result<(), WriteError> {
    let mut removed = Vec::new();
    for file in stale {
        if let Some(text) = existing(folder, file)? {
            removed.push((folder.join(file.name), text, file.help));
        }
    }
    make_folders(or_here(folder), Path::new(""))?;
    let prepared: Result<_, _> = files.iter().map(|file| prepare(folder, file)).collect();
    replace(prepared?)?;
    for (path, text, help) in removed {
        match remove(&path, &text) {
            Ok(true) => {}
            Ok(false) => return Err(WriteError::Foreign { path, help }),
            Err(source) => return Err(WriteError::Io { path, source }),
        }
    }
    Ok(())
}

/// A file that was written beside the place where it will be.
struct Prepared<'a> {
    path: PathBuf,
    new: NamedTempFile,
    text: &'a str,
    /// What was judged there, if there is something.
    old: Option<Vec<u8>>,
    help: &'static str,
}

/// A file in its place, and where the one lies that was there before.
struct Placed<'a> {
    path: PathBuf,
    text: &'a str,
    before: Option<TempPath>,
}

/// The text of the file in this place that may be replaced or removed, if there is one.
fn existing(folder: &Path, file: &New<'_>) -> Result<Option<Vec<u8>>, WriteError> {
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
    // It may be another one when it is replaced: what comes back then is compared with this.
    let text = std::fs::read(&path).map_err(failed)?;
    if !(file.replaces)(&text) {
        return Err(WriteError::Foreign { path, help: file.help });
    }
    Ok(Some(text))
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

fn prepare<'a>(folder: &Path, file: &New<'a>) -> Result<Prepared<'a>, WriteError> {
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
    let mut new = builder.tempfile_in(folder_of(&path)).map_err(failed)?;
    new.write_all(file.text.as_bytes()).map_err(failed)?;
    new.as_file().sync_all().map_err(failed)?;
    if old.is_some() {
        let permissions = std::fs::metadata(&path).map_err(failed)?.permissions();
        std::fs::set_permissions(new.path(), permissions).map_err(failed)?;
    }
    Ok(Prepared { path, new, text: file.text, old, help: file.help })
}

fn replace(prepared: Vec<Prepared<'_>>) -> Result<(), WriteError> {
    let mut placed: Vec<Placed<'_>> = Vec::new();
    for Prepared { path, new, text, old, help } in prepared {
        // What has come meanwhile is not replaced, and a link not followed.
        let before = match &old {
            Some(_) => exchange(new.into_temp_path(), &path).map(Some),
            None => new.persist_noclobber(&path).map(|_| None).map_err(|error| error.error),
        };
        let failed = match before {
            Ok(before) => {
                let is_judged = before.as_deref().and_then(regular) == old;
                placed.push(Placed { path: path.clone(), text, before });
                (!is_judged).then_some(WriteError::Foreign { path, help })
            }
            Err(source) => Some(WriteError::Io { path, source }),
        };
        if let Some(error) = failed {
            placed.into_iter().rev().for_each(Placed::restore);
            return Err(error);
        }
    }
    Ok(())
}

impl Placed<'_> {
    /// Puts back what was there before, unless the file is somebody else's by now. If that fails nothing more can be done:
    /// the error that led to it is reported.
    fn restore(self) {
        let Self { path, text, before } = self;
        let Some(before) = before else {
            _ = remove(&path, text.as_bytes());
            return;
        };
        if let Ok(taken) = exchange(before, &path)
            && regular(&taken).as_deref() != Some(text.as_bytes())
        {
            _ = exchange(taken, &path);
        }
    }
}

/// Puts a file in the place of another one. Returns where that one lies now, until it is dropped.
fn exchange(new: TempPath, path: &Path) -> std::io::Result<TempPath> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        use rustix::io::Errno;
        match renameat_with(CWD, &*new, CWD, path, RenameFlags::EXCHANGE) {
            Ok(()) => return Ok(new),
            // Not every file system can.
            Err(Errno::INVAL | Errno::NOSYS | Errno::OPNOTSUPP) => {}
            Err(error) => return Err(error.into()),
        }
    }
    // A second name: what is put into the place between this and the next line is lost.
    let keep = |kept: &Path| {
        std::fs::hard_link(path, kept).or_else(|_| std::fs::copy(path, kept).map(|_| ()))
    };
    let kept = Builder::new().make_in(folder_of(path), keep)?.into_temp_path();
    new.persist(path).map_err(|error| error.error)?;
    Ok(kept)
}

/// Removes a file if it has this text, and tells whether it had.
fn remove(path: &Path, text: &[u8]) -> std::io::Result<bool> {
    let take = |taken: &Path| std::fs::rename(path, taken);
    let taken = Builder::new().make_in(folder_of(path), take)?.into_temp_path();
    let is_it = regular(&taken).as_deref() == Some(text);
    if !is_it {
        taken.persist_noclobber(path).map_err(|error| error.error)?;
    }
    Ok(is_it)
}

/// The folder in which a file is.
fn folder_of(path: &Path) -> &Path {
    or_here(path.parent().unwrap_or(path))
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

/// Whether a script can be written, as far as it is known before: there is no other file in its place, nor in that of its
/// folder, which is made for it.
pub(crate) fn check_script(folder: &Path, name: &str) -> Result<(), WriteError> {
    let folder = or_here(folder);
    let path = || folder.to_owned();
    match std::fs::metadata(folder) {
        Ok(data) if data.is_dir() => {}
        Ok(_) => {
            return Err(WriteError::Io { path: path(), source: ErrorKind::NotADirectory.into() });
        }
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(WriteError::Io { path: path(), source }),
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
        // Not only what is written into the file: another one can be moved there, by an editor for example.
        let prepared = ["a", "b"].map(|name| prepare(folder.path(), &new(name)).unwrap());
        std::fs::write(place("of an editor"), "mine").unwrap();
        std::fs::rename(place("of an editor"), place("b")).unwrap();
        assert!(matches!(replace(prepared.into()), Err(WriteError::Foreign { .. })));
        assert_eq!((text("a"), text("b")), ("old".to_owned(), "mine".to_owned()));
        std::fs::write(place("b"), "theirs").unwrap();
        assert!(!remove(&place("b"), b"mine").unwrap());
        assert_eq!(text("b"), "theirs");
        assert!(remove(&place("b"), b"theirs").unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
