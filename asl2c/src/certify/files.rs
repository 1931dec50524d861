//! Writes the evidence to a folder.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::evidence::Evidence;
use super::gather::{AGENT, C, COUNTEREXAMPLES, Certified, CertifyError, OWN_TESTS, TESTS};
use super::page::page;
use crate::JSON_VERSION;
use crate::checksum::checksum;
use crate::output::is_same;
use crate::written::{self, Comment, New, is_own, marked, regular};

/// The evidence as JSON.
const JSON: &str = "evidence.json";
const PAGE: &str = "index.html";
/// The conditions of the invariant, one a line, with which another proof can begin.
const INVARIANT: &str = "invariant.txt";
/// The program of the tests.
const PROGRAM: &str = "tests.c";
/// Checksums of all other files, in the format of `sha256sum`. It is known again by its last line, and the others by it.
const CHECKSUMS: &str = "SHA256SUMS";
/// What to do about a file that is in the way.
const HELP: &str = "name another folder by `-o DIR`";

/// The evidence as it is written.
#[derive(Serialize)]
struct Versioned<'a> {
    version: u32,
    #[serde(flatten)]
    evidence: &'a Evidence,
}

impl Certified {
    /// Writes the files, the evidence as JSON and as a page, and the checksums of all; all or none. What an earlier
    /// certification left in the folder is replaced or removed, if nobody has changed it since and it is none of the `inputs`.
    ///
    /// # Errors
    /// If the folder holds something else, or a file cannot be written.
    pub fn write(&self, folder: &Path, inputs: &[PathBuf]) -> Result<(), CertifyError> {
        let failed = |what: &str, path: &Path| {
            let what = format!("cannot {what} {}", path.display());
            move |source: io::Error| CertifyError::Io { what, source }
        };
        let earlier = earlier(folder, inputs)?;
        let mut files = self.files.clone();
        let json = serde_json::to_string_pretty(&Versioned {
            version: JSON_VERSION,
            evidence: &self.evidence,
        })
        .map_err(io::Error::from);
        let json = json.map_err(failed("make", Path::new(JSON)))?;
        files.push((JSON.to_owned(), format!("{json}\n")));
        files.push((PAGE.to_owned(), page(self)));
        let conditions = self.evidence.invariant.iter().map(|condition| format!("{condition}\n"));
        files.push((INVARIANT.to_owned(), conditions.collect()));
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
}

/// Checks that evidence can be written to a folder: it is not there yet, empty, or holds evidence that nobody has
/// changed and that are none of the `inputs`.
///
/// # Errors
/// If it holds something else, or is no folder.
pub(crate) fn check_folder(folder: &Path, inputs: &[PathBuf]) -> Result<(), CertifyError> {
    let earlier = earlier(folder, inputs)?;
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
    /// The files that it lists.
    fn names(&self) -> impl Iterator<Item = &str> {
        let names = self.checksums.lines().filter_map(|line| line.split_once("  "));
        names.map(|(_, name)| name)
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

/// Whether evidence can have a file of this name. A list can be made by anybody: whatever it says, no other file is touched.
fn is_of_evidence(name: &str) -> bool {
    let is_number = |text: &str| text.len() >= 3 && text.bytes().all(|byte| byte.is_ascii_digit());
    let Some((folder, file)) = name.split_once('/') else {
        return [JSON, PAGE, INVARIANT].contains(&name);
    };
    let is_test = |file: &str| {
        let number = file.strip_prefix("test_").and_then(|file| file.strip_suffix(".transcript"));
        file == PROGRAM || number.is_some_and(is_number)
    };
    let is_plain = |ending: &str| !file.contains('/') && file.ends_with(ending);
    let is_below = !file.split('/').any(|part| matches!(part, "" | "." | ".."));
    match folder {
        AGENT | C => is_below,
        COUNTEREXAMPLES => is_plain(".script"),
        TESTS => match name.strip_prefix(OWN_TESTS).and_then(|own| own.strip_prefix('/')) {
            Some(own) => !own.contains('/') && own.ends_with(".transcript"),
            None => is_test(file),
        },
        _ => false,
    }
}

/// The earlier evidence in a folder; nothing in one that is empty or not there.
fn earlier(folder: &Path, inputs: &[PathBuf]) -> Result<Earlier, CertifyError> {
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
    let occupied = || CertifyError::Occupied { folder: folder.display().to_string() };
    // One that other people wrote lists their files.
    let own = regular(&folder.join(CHECKSUMS)).filter(|text| is_own(text));
    let checksums = own.and_then(|text| String::from_utf8(text).ok()).ok_or_else(occupied)?;
    let earlier = Earlier { checksums };
    for name in earlier.names() {
        let path = folder.join(name);
        // Generated code is known again by itself.
        let is_code = name.starts_with(C) && [".c", ".rs"].iter().any(|end| name.ends_with(end));
        let is_foreign = || is_code && regular(&path).is_some_and(|text| !is_own(&text));
        if !is_of_evidence(name) || is_foreign() {
            return Err(CertifyError::Unlikely { path });
        }
        if inputs.iter().any(|input| is_same(input, &path)) {
            return Err(CertifyError::Input { path });
        }
    }
    Ok(earlier)
}

#[cfg(test)]
mod tests {
    use super::is_of_evidence;

    #[test]
    fn only_names_of_evidence_are_replaced() {
        for name in [
            "evidence.json",
            "index.html",
            "invariant.txt",
            "agent/sub/a.asl",
            "c/a.h",
            "tests/tests.c",
            "tests/test_001.transcript",
            "tests/test_1000.transcript",
            "tests/own/mine.transcript",
            "counterexamples/p.script",
        ] {
            assert!(is_of_evidence(name), "{name}");
        }
        for name in [
            "",
            "main.c",
            "a.asl",
            "SHA256SUMS",
            "../a.asl",
            "/etc/passwd",
            "agent/../main.c",
            "agent//main.c",
            "agent/",
            "c/./a.c",
            "tests/main.c",
            "tests/test_1.transcript",
            "tests/test_+01.transcript",
            "tests/own/main.c",
            "tests/own/../../a.transcript",
            "tests/own/",
            "counterexamples/main.c",
            "counterexamples/../p.script",
            "src/main.c",
        ] {
            assert!(!is_of_evidence(name), "{name}");
        }
    }
}
