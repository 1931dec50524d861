//! Writes the evidence to a folder.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use super::gather::{Certified, CertifyError};
use super::page::page;
use crate::checksum::checksum;
use crate::written::{self, Comment, New, is_own, marked, regular};

/// The evidence as JSON.
const JSON: &str = "evidence.json";
const PAGE: &str = "index.html";
/// Checksums of all other files, in the format of `sha256sum`. It is known again by its last line, and the others by it.
const CHECKSUMS: &str = "SHA256SUMS";
/// What to do about a file that is in the way.
const HELP: &str = "name another folder by `-o DIR`";

/// Writes the files, the evidence as JSON and as a page, and the checksums of all; all or none. What an earlier
/// certification left in the folder is replaced or removed, if nobody has changed it since.
///
/// # Errors
/// If the folder holds something else, or a file cannot be written.
pub(crate) fn write(certified: &Certified, folder: &Path) -> Result<(), CertifyError> {
    let failed = |what: &str, path: &Path| {
        let what = format!("cannot {what} {}", path.display());
        move |source: io::Error| CertifyError::Io { what, source }
    };
    let earlier = earlier(folder)?;
    let mut files = certified.files.clone();
    let json = serde_json::to_string_pretty(&certified.evidence).map_err(io::Error::from);
    let json = json.map_err(failed("make", Path::new(JSON)))?;
    files.push((JSON.to_owned(), format!("{json}\n")));
    files.push((PAGE.to_owned(), page(certified)));
    files.sort();
    let mut checksums = String::new();
    for (name, text) in &files {
        // Writing to a string cannot fail.
        _ = writeln!(checksums, "{}  {name}", checksum(text.as_bytes()));
    }
    files.push((CHECKSUMS.to_owned(), marked(&checksums, Comment::Hash)));
    for (name, _) in &files {
        let parent = Path::new(name).parent().unwrap_or(Path::new(""));
        written::make_folders(folder, parent)?;
    }
    let replaces = |old: &[u8]| earlier.is_from_it(old);
    let new = |name, text| New { name, text, replaces: &replaces, help: HELP };
    let stale = earlier.names().filter(|name| !files.iter().any(|(new, _)| new == name));
    let stale: Vec<New<'_>> = stale.map(|name| new(name, "")).collect();
    let files: Vec<New<'_>> = files.iter().map(|(name, text)| new(name, text)).collect();
    Ok(written::write(folder, &files, &stale)?)
}

/// Checks that evidence can be written to a folder: it is not there yet, empty, or holds evidence that nobody has
/// changed.
///
/// # Errors
/// If it holds something else, or is no folder.
pub(crate) fn check_folder(folder: &Path) -> Result<(), CertifyError> {
    let earlier = earlier(folder)?;
    let replaces = |old: &[u8]| earlier.is_from_it(old);
    for name in earlier.names() {
        written::check(folder, &New { name, text: "", replaces: &replaces, help: HELP })?;
    }
    Ok(())
}

/// The checksums of an earlier evidence.
struct Earlier {
    checksums: String,
}

impl Earlier {
    /// The files that it lists below its folder.
    fn names(&self) -> impl Iterator<Item = &str> {
        let names = self.checksums.lines().filter_map(|line| line.split_once("  "));
        let names = names.map(|(_, name)| name);
        names.filter(|name| !name.split('/').any(|part| matches!(part, "" | "." | "..")))
    }

    /// Whether it has a file with this text.
    fn is_from_it(&self, text: &[u8]) -> bool {
        let sum = checksum(text);
        text == self.checksums.as_bytes()
            || self
                .checksums
                .lines()
                .any(|line| line.split_once("  ").is_some_and(|(listed, _)| listed == sum))
    }
}

/// The earlier evidence in a folder; nothing in one that is empty or not there.
fn earlier(folder: &Path) -> Result<Earlier, CertifyError> {
    let failed =
        |source| CertifyError::Io { what: format!("cannot use {}", folder.display()), source };
    let nothing = Earlier { checksums: String::new() };
    let mut entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(nothing),
        Err(error) => return Err(failed(error)),
    };
    if entries.next().is_none() {
        return Ok(nothing);
    }
    // One that other people wrote lists their files.
    let own = regular(&folder.join(CHECKSUMS)).filter(|text| is_own(text));
    match own.and_then(|text| String::from_utf8(text).ok()) {
        Some(checksums) => Ok(Earlier { checksums }),
        None => Err(CertifyError::Occupied { folder: folder.display().to_string() }),
    }
}
