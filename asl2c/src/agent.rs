//! An agent on disk: a configuration, and the file that it names.

use std::path::{Path, PathBuf};

use translator::{ParsedConfiguration, TranslateError, parse_configuration};

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
