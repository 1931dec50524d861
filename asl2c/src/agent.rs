//! An agent on disk: a configuration, and the file that it names.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use translator::{GeneratedFile, ParsedConfiguration, TranslateError, parse_configuration};

/// Names of headers that are tried; most are no files.
const MOST_HEADERS: usize = 10_000;

/// Errors on reading an agent.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// A file cannot be read.
    #[error("cannot read {path}: {source}")]
    File {
        /// Its path.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The configuration has errors.
    #[error(transparent)]
    Configuration(#[from] TranslateError),
}

/// A configuration and the text of its agent.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Agent {
    /// The configuration.
    pub configuration: ParsedConfiguration,
    /// The AgentSpeak text.
    pub text: String,
    /// Path of the configuration, as given.
    pub path: PathBuf,
}

impl Agent {
    /// Reads a configuration and the agent that it names, which is in the same folder or below.
    ///
    /// # Errors
    /// If a file cannot be read, or the configuration has errors.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let configuration = parse_configuration(&path.display().to_string(), &read(path)?)?;
        let text = read(&folder(path).join(configuration.input()))?;
        Ok(Self { configuration, text, path: path.to_owned() })
    }

    /// The configuration's folder.
    pub(crate) fn folder(&self) -> &Path {
        folder(&self.path)
    }

    /// The headers that the configuration includes, and those that they include in turn, as far as they are in its folder
    /// or below: C that is compiled elsewhere needs them beside it.
    pub(crate) fn own_headers(&self) -> Vec<GeneratedFile> {
        let mut names: Vec<String> =
            self.configuration.included_files().filter_map(|name| plain(&name)).collect();
        let mut headers: Vec<GeneratedFile> = Vec::new();
        while let Some(name) = names.pop() {
            if headers.iter().any(|header| header.name == name) {
                continue;
            }
            // Most of the names are those of system headers.
            let Ok(text) = read(&self.folder().join(&name)) else { continue };
            let beside = name.rsplit_once('/').map_or(".", |(folder, _)| folder);
            for included in included(&text) {
                // Beside the header, or beside the configuration, as compilers look for it.
                names.extend(
                    [format!("{beside}/{included}"), included].iter().filter_map(|n| plain(n)),
                );
            }
            let mut header = GeneratedFile::default();
            (header.name, header.text) = (name, text);
            headers.push(header);
        }
        headers.sort_by(|one, other| one.name.cmp(&other.name));
        headers
    }

    /// The texts of all headers in its folder that its C includes, also by others: their macros can change what C means.
    pub fn headers(&self) -> Vec<String> {
        // Such files in the folder would be taken for those of the compiler.
        let always = ["stdbool.h", "stdint.h"].map(str::to_owned);
        let mut names: Vec<PathBuf> = always
            .into_iter()
            .chain(self.configuration.included_files())
            .map(PathBuf::from)
            .collect();
        let mut known = BTreeSet::new();
        let mut texts = Vec::new();
        while let Some(name) = names.pop() {
            if known.len() >= MOST_HEADERS || !known.insert(name.clone()) {
                continue;
            }
            let Ok(text) = read(&self.folder().join(&name)) else { continue };
            for included in text.split(['"', '<', '>']).filter(|name| !name.contains('\n')) {
                names.extend([folder(&name).join(included), PathBuf::from(included)]);
            }
            texts.push(text);
        }
        texts
    }

    /// The files that it was read from.
    pub(crate) fn sources(&self) -> [PathBuf; 2] {
        [self.folder().join(self.configuration.input()), self.path.clone()]
    }
}

/// The path of a header below a folder, without `.` and `..`; `None` if it is not below.
fn plain(name: &str) -> Option<String> {
    if name.starts_with('/') {
        return None;
    }
    let mut parts: Vec<&str> = Vec::new();
    for part in name.split('/') {
        match part {
            "" | "." => {}
            ".." => _ = parts.pop()?,
            part => parts.push(part),
        }
    }
    (!parts.is_empty()).then(|| parts.join("/"))
}

/// The files that a header includes.
fn included(text: &str) -> impl Iterator<Item = String> {
    text.lines().filter_map(|line| {
        let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("include")?;
        let rest = rest.trim_start();
        let end = if rest.starts_with('<') { '>' } else { '"' };
        let name = rest.strip_prefix(['<', '"'])?.split(end).next()?;
        Some(name.to_owned())
    })
}

fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// The text of a file.
pub(crate) fn read(path: &Path) -> Result<String, ReadError> {
    let bytes =
        std::fs::read(path).map_err(|source| ReadError::File { path: path.to_owned(), source })?;
    // Invalid UTF-8 becomes a character that the lexer refuses, with line and column.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
