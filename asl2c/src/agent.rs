//! An agent on disk: a configuration, and the file that it names.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use translator::system::{ENDING, System, compose, parse_system};
use translator::{ParsedConfiguration, TranslateError, parse_configuration};

/// Errors on reading an agent.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// A file cannot be read, has more than 16 MiB, or is not UTF-8.
    #[error("cannot read {path}: {source}")]
    File {
        /// Its path.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The configuration or the system has errors, or names a file that cannot be read.
    #[error(transparent)]
    Configuration(#[from] TranslateError),
}

impl ReadError {
    /// The error at the place that names the file.
    fn at(self, place: impl FnOnce(&str) -> TranslateError) -> Self {
        match self {
            Self::File { source, .. } => Self::Configuration(place(&source.to_string())),
            error @ Self::Configuration(_) => error,
        }
    }
}

/// Whether a file describes a system of agents, by its name.
pub(crate) fn is_system(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == ENDING)
}

/// Reads a system, and the agents that it names.
///
/// # Errors
/// If a file cannot be read, or one of them has errors.
pub fn read_system(path: &Path) -> Result<System, ReadError> {
    let parsed = parse_system(&path.display().to_string(), &read(path)?)?;
    let agents = parsed.agents().iter().map(|agent| {
        let path = folder(path).join(&agent.configuration);
        let written = read(&path).map_err(|error| error.at(|why| parsed.not_read(agent, why)))?;
        let Agent { configuration, text, .. } = Agent::of(written, &path)?;
        Ok((configuration, text))
    });
    let agents = agents.collect::<Result<Vec<_>, ReadError>>()?;
    Ok(compose(&parsed, agents)?)
}

/// A configuration and the text of its agent.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Agent {
    /// The configuration.
    pub configuration: ParsedConfiguration,
    /// The configuration's text.
    pub(crate) written: String,
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
        Self::of(read(path)?, path)
    }

    fn of(written: String, path: &Path) -> Result<Self, ReadError> {
        let configuration = parse_configuration(&path.display().to_string(), &written)?;
        let text = read(&folder(path).join(configuration.input()))
            .map_err(|error| error.at(|why| configuration.not_read(why)))?;
        Ok(Self { configuration, written, text, path: path.to_owned() })
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

/// The folder of a file.
pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// Bytes of the longest text that is read: a device can be endless.
const MOST: u64 = 16 << 20;

/// The text of a file.
pub(crate) fn read(path: &Path) -> Result<String, ReadError> {
    let failed = |source| ReadError::File { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(failed)?;
    file.take(MOST + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MOST {
        return Err(failed(std::io::Error::other("it has more than 16 MB")));
    }
    text(bytes).map_err(failed)
}

/// Bytes as text. Others than those of UTF-8 would be translated, or written back, as something else.
pub(crate) fn text(bytes: Vec<u8>) -> std::io::Result<String> {
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(error.as_bytes().get(..valid).unwrap_or_default());
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        let what = format!("line {line}, column {column} is not UTF-8");
        std::io::Error::new(std::io::ErrorKind::InvalidData, what)
    })
}
