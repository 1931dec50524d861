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

    /// The headers that the configuration includes and that are in its folder or below: C that is compiled elsewhere
    /// needs them beside it.
    pub(crate) fn own_headers(&self) -> Vec<GeneratedFile> {
        let names = self.configuration.included_files();
        let names = names.filter(|name| {
            Path::new(name).is_relative() && !name.split('/').any(|part| part == "..")
        });
        // Most of the names are those of system headers.
        let headers = names.filter_map(|name| {
            let mut header = GeneratedFile::default();
            header.text = read(&self.folder().join(&name)).ok()?;
            header.name = name;
            Some(header)
        });
        headers.collect()
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
