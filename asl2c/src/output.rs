//! Writes all files of a translation, or none.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile, TempPath};
use translator::{GeneratedFile, TranslateError};

use crate::agent::Agent;

/// Errors on writing the outputs.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OutputError {
    /// An input or another output has the same path.
    #[error(transparent)]
    Refused(#[from] TranslateError),
    #[error("cannot write {path}: {source}; nothing is changed")]
    Write { path: PathBuf, source: std::io::Error },
}

/// A file that was written beside the one it will replace.
struct Prepared {
    target: PathBuf,
    new: NamedTempFile,
    /// The old file under another name, if there is one.
    old: Option<TempPath>,
}

/// Writes `files` to `folder`, all or none: each is first written completely under another name, and if one
/// cannot be moved to its place the others are restored. Inputs of the translation are never overwritten.
pub(crate) fn write(
    agent: &Agent,
    files: &[GeneratedFile],
    folder: &Path,
) -> Result<(), OutputError> {
    let Agent { configuration, .. } = agent;
    let mut read = Vec::from(agent.sources().map(|path| (path, "translated")));
    for file in configuration.included_files() {
        read.extend([agent.folder(), folder].map(|place| (place.join(&file), "included")));
    }
    let mut prepared: Vec<Prepared> = Vec::new();
    let inside = or_here(folder).canonicalize().ok();
    for file in files {
        let path = folder.join(&file.name);
        // A path without a file name cannot be written; writing reports that.
        let target = resolved(&path);
        let both = inside.as_ref().zip(target.as_ref());
        let leads_out = both.is_some_and(|(inside, target)| !target.starts_with(inside));
        let target = target.unwrap_or_else(|| path.clone());
        if leads_out {
            let message =
                format!("a link leads to {}, out of the output's folder", target.display());
            let help = "name a file in that folder or below; `-o DIR` selects another folder";
            return Err(configuration.overwrites(file.setting, &message, help).into());
        }
        if let Some((source, used)) = read.iter().find(|(source, _)| is_same(&target, source)) {
            let message = format!("this is {}, which is {used}", source.display());
            let help = "it would be overwritten: choose another name, or another folder with `-o`";
            return Err(configuration.overwrites(file.setting, &message, help).into());
        }
        if let Some(other) = prepared.iter().find(|other| is_same(&target, &other.target)) {
            let message = format!("this is {}, which is written too", other.target.display());
            let help = "a link leads from one to the other: choose another name";
            return Err(configuration.overwrites(file.setting, &message, help).into());
        }
        let new = prepare(&target, &file.text);
        prepared.push(new.map_err(|source| OutputError::Write { path, source })?);
    }
    replace(prepared)
}

/// Replaces the text of an existing file, completely or not at all. A link stays, and leads to the new text.
pub(crate) fn rewrite(path: &Path, text: &str) -> Result<(), OutputError> {
    let failed = |source| OutputError::Write { path: path.to_owned(), source };
    let target = path.canonicalize().map_err(failed)?;
    replace(vec![prepare(&target, text).map_err(failed)?])
}

/// The path without links, existing or not: a missing file may be in a folder that is a link.
fn resolved(path: &Path) -> Option<PathBuf> {
    let in_folder = || Some(or_here(path.parent()?).canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(in_folder)
}

/// The folder; the current one for a path without a folder.
fn or_here(folder: &Path) -> &Path {
    if folder == Path::new("") { Path::new(".") } else { folder }
}

/// Whether two paths are the same file, existing or not.
fn is_same(one: &Path, other: &Path) -> bool {
    if resolved(one).is_some_and(|one| Some(one) == resolved(other)) {
        return true;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        let inode = |path: &Path| std::fs::metadata(path).ok().map(|data| (data.dev(), data.ino()));
        inode(one).is_some_and(|one| Some(one) == inode(other))
    }
    #[cfg(not(unix))]
    false
}

fn prepare(target: &Path, text: &str) -> std::io::Result<Prepared> {
    let parent = or_here(target.parent().unwrap_or(target));
    let existing = std::fs::metadata(target).ok();
    if let Some(existing) = &existing {
        if !existing.is_file() {
            return Err(std::io::Error::other("not a regular file"));
        }
        if existing.permissions().readonly() {
            return Err(std::io::ErrorKind::PermissionDenied.into());
        }
    }
    let mut builder = Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As for any new file, so that the user's umask applies.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut new = builder.tempfile_in(parent)?;
    new.write_all(text.as_bytes())?;
    new.as_file().sync_all()?;
    let mut old = None;
    if let Some(existing) = existing {
        std::fs::set_permissions(new.path(), existing.permissions())?;
        let kept = Builder::new().make_in(parent, |path| {
            std::fs::hard_link(target, path).or_else(|_| std::fs::copy(target, path).map(|_| ()))
        })?;
        old = Some(kept.into_temp_path());
    }
    Ok(Prepared { target: target.to_owned(), new, old })
}

fn replace(prepared: Vec<Prepared>) -> Result<(), OutputError> {
    let mut replaced: Vec<(PathBuf, Option<TempPath>)> = Vec::new();
    for Prepared { target, new, old } in prepared {
        if let Err(error) = new.persist(&target) {
            for (path, old) in replaced.into_iter().rev() {
                // If restoring fails nothing more can be done; the original error is reported.
                _ = match old {
                    Some(old) => old.persist(&path).map_err(|error| error.error),
                    None => std::fs::remove_file(&path),
                };
            }
            return Err(OutputError::Write { path: target, source: error.error });
        }
        replaced.push((target, old));
    }
    Ok(())
}
