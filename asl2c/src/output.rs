//! Writes all files of a translation, or none.

use std::path::{Path, PathBuf};

use translator::{GeneratedFile, TranslateError};

use crate::agent::Agent;
use crate::checksum::checksum;
use crate::written::{self, Comment, New, WriteError, is_own, marked, or_here};

/// Errors on writing the outputs.
#[derive(Debug, thiserror::Error)]
pub(crate) enum OutputError {
    /// An input or another output has the same path.
    #[error(transparent)]
    Refused(#[from] TranslateError),
    /// A file is somebody else's, or cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Begins a line of the C with the checksum of a file that cannot have a comment.
const ALSO: &str = "/* asl2c wrote also: sha256 ";

/// The files of a translation as they are written: each has a last line by which it is known again. The C also has those
/// of files without comments.
pub(crate) fn known_again(mut files: Vec<GeneratedFile>) -> Vec<GeneratedFile> {
    let others = files.iter().filter(|file| file.setting == "matrix");
    let also: Vec<String> =
        others.map(|file| format!("{ALSO}{} */\n", checksum(file.text.as_bytes()))).collect();
    for file in &mut files {
        if file.setting == "output" {
            file.text += &also.concat();
        }
        if let Some(comment) = comment(file) {
            file.text = marked(&file.text, comment);
        }
    }
    files
}

fn comment(file: &GeneratedFile) -> Option<Comment> {
    match file.setting {
        "output" | "header" | "basics" => Some(Comment::C),
        "rust" => Some(Comment::Slashes),
        _ => None,
    }
}

/// Writes files that are [known again](known_again) to `folder`, all or none. Inputs of the translation are never
/// overwritten; of others only those are that an earlier translation left, unless `force` says otherwise.
pub(crate) fn write(
    agent: &Agent,
    files: &[GeneratedFile],
    folder: &Path,
    force: bool,
) -> Result<(), OutputError> {
    let Agent { configuration, .. } = agent;
    let mut read = Vec::from(agent.sources().map(|path| (path, "translated")));
    for file in configuration.included_files() {
        read.extend([agent.folder(), folder].map(|place| (place.join(&file), "included")));
    }
    let mut targets: Vec<PathBuf> = Vec::new();
    for file in files {
        let target = folder.join(&file.name);
        if let Some((source, used)) = read.iter().find(|(source, _)| is_same(&target, source)) {
            let message = format!("this is {}, which is {used}", source.display());
            let help = "it would be overwritten: choose another name, or another folder with `-o`";
            return Err(configuration.overwrites(file.setting, &message, help).into());
        }
        if let Some(other) = targets.iter().find(|other| is_same(&target, other)) {
            let message = format!("this is {}, which is written too", other.display());
            let help = "a link leads from one to the other: choose another name";
            return Err(configuration.overwrites(file.setting, &message, help).into());
        }
        targets.push(target);
    }
    let c = files.iter().find(|file| file.setting == "output");
    let earlier = c.map(|c| folder.join(&c.name)).and_then(|c| written::regular(&c));
    let earlier = earlier.filter(|text| is_own(text)).unwrap_or_default();
    let earlier = String::from_utf8_lossy(&earlier).into_owned();
    let is_listed = |old: &[u8]| earlier.contains(&format!("{ALSO}{}", checksum(old)));
    let replaces = |old: &[u8]| force || is_own(old) || is_listed(old);
    let help = "replace it by `--force`";
    let files = files.iter().map(|GeneratedFile { name, text, .. }| New {
        name,
        text,
        replaces: &replaces,
        help,
    });
    Ok(written::write(folder, &files.collect::<Vec<_>>(), &[])?)
}

/// The path without links, existing or not: a missing file may be in a folder that is a link.
fn resolved(path: &Path) -> Option<PathBuf> {
    let in_folder = || Some(or_here(path.parent()?).canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(in_folder)
}

/// Whether two paths are the same file, existing or not.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
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
