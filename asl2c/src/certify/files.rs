//! Writes the evidence to a folder.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use super::checksum::checksum;
use super::gather::{Certified, CertifyError};
use super::page::page;

/// The evidence as JSON.
const JSON: &str = "evidence.json";
const PAGE: &str = "index.html";
/// Checksums of all other files, in the format of `sha256sum`. A folder with this file is one of ours.
const CHECKSUMS: &str = "SHA256SUMS";

/// Writes the files, the evidence as JSON and as a page, and the checksums of all. What an earlier certification left in
/// the folder is removed.
///
/// # Errors
/// If the folder holds something else, or a file cannot be written.
pub(crate) fn write(certified: &Certified, folder: &Path) -> Result<(), CertifyError> {
    let failed = |what: &str, path: &Path| {
        let what = format!("cannot {what} {}", path.display());
        move |source: io::Error| CertifyError::Io { what, source }
    };
    clear(folder)?;
    let mut files = certified.files.clone();
    let json = serde_json::to_string_pretty(&certified.evidence).map_err(io::Error::from);
    let json = json.map_err(failed("make", Path::new(JSON)))?;
    files.push((JSON.to_owned(), format!("{json}\n")));
    files.push((PAGE.to_owned(), page(certified)));
    files.sort();
    let mut checksums = String::new();
    for (name, text) in &files {
        // Writing to a string cannot fail.
        _ = writeln!(checksums, "{}  {name}", checksum(text));
    }
    files.push((CHECKSUMS.to_owned(), checksums));
    for (name, text) in &files {
        let path = folder.join(name);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent).map_err(failed("make", parent))?;
        }
        std::fs::write(&path, text).map_err(failed("write", &path))?;
    }
    Ok(())
}

/// Checks that evidence can be written to a folder: it is not there yet, empty, or holds evidence. Its checksums are
/// returned, if it has any.
///
/// # Errors
/// If it holds something else, or is no folder.
pub(crate) fn check_folder(folder: &Path) -> Result<Option<String>, CertifyError> {
    let failed =
        |source| CertifyError::Io { what: format!("cannot use {}", folder.display()), source };
    let mut entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(failed(error)),
    };
    if entries.next().is_none() {
        return Ok(None);
    }
    match std::fs::read_to_string(folder.join(CHECKSUMS)) {
        Ok(checksums) => Ok(Some(checksums)),
        Err(_) => Err(CertifyError::Occupied { folder: folder.display().to_string() }),
    }
}

/// Removes an earlier evidence: the files that its checksums name.
fn clear(folder: &Path) -> Result<(), CertifyError> {
    let failed =
        |source| CertifyError::Io { what: format!("cannot use {}", folder.display()), source };
    let Some(checksums) = check_folder(folder)? else { return Ok(()) };
    let names = checksums.lines().filter_map(|line| line.split_once("  ")).map(|(_, name)| name);
    // Files that somebody has added stay, and are not in the new checksums.
    for name in names.filter(|name| !name.split('/').any(|part| part == ".." || part.is_empty())) {
        match std::fs::remove_file(folder.join(name)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(failed(error)),
            _ => {}
        }
    }
    Ok(())
}
