//! Texts of agents, configurations and systems, open in the editor or on disk, and which belong together.

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use gen_lsp_types::{Position, Range as Place};
use translator::configuration::Configuration;
use translator::syntax::Document;
use translator::system::{Agent, ParsedSystem};
use translator::{
    Diagnostic, ParsedConfiguration, TranslateError, configuration, parse_configuration,
};

use super::positions::Lines;
use super::uri::{plain, uri_of};
use crate::agent::{ReadError, folder, is_system, read};

/// A text, and what is known of it.
#[derive(Debug)]
pub(super) struct File {
    pub(super) content: Content,
    lines: Lines,
    /// The text is that of the editor.
    pub(super) open: Option<Open>,
}

/// How the editor names a text.
#[derive(Debug, Clone)]
pub(super) struct Open {
    pub(super) uri: String,
    pub(super) version: i32,
}

#[derive(Debug)]
pub(super) enum Content {
    Agent(Box<Document>),
    Configuration(Box<ConfigurationText>),
    System(Box<SystemText>),
}

/// What a text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Agent,
    Configuration,
    System,
}

impl Kind {
    /// By the file's name, or the language that the editor says; what an editor sends otherwise is a configuration.
    pub(super) fn of(path: &Path, language: &str) -> Self {
        if is_system(path) || language == "agentspeak-system" {
            Self::System
        } else if has_ending(path, "asl") || language == "agentspeak" {
            Self::Agent
        } else {
            Self::Configuration
        }
    }
}

/// The text of a configuration.
#[derive(Debug)]
pub(super) struct ConfigurationText {
    text: String,
    /// What could be read, also if there are errors.
    pub(super) tree: Configuration,
    /// The configuration, or its errors.
    pub(super) parsed: Result<ParsedConfiguration, TranslateError>,
}

impl ConfigurationText {
    fn new(text: String) -> Self {
        let (tree, _) = configuration::parse(&text);
        Self { tree, parsed: parse_configuration("", &text), text }
    }
}

/// The text of a system.
#[derive(Debug)]
pub(super) struct SystemText {
    /// What could be read, also if there are errors.
    pub(super) tree: ParsedSystem,
    pub(super) errors: Vec<Diagnostic>,
}

impl SystemText {
    fn new(text: &str) -> Self {
        let (tree, errors) = ParsedSystem::read("", text);
        Self { tree, errors }
    }
}

impl File {
    fn new(kind: Kind, text: String, open: Option<Open>) -> Self {
        let lines = Lines::of(&text);
        let content = match kind {
            Kind::Agent => Content::Agent(Box::new(Document::new(text))),
            Kind::Configuration => Content::Configuration(Box::new(ConfigurationText::new(text))),
            Kind::System => Content::System(Box::new(SystemText::new(&text))),
        };
        Self { content, lines, open }
    }

    pub(super) fn text(&self) -> &str {
        match &self.content {
            Content::Agent(document) => document.text(),
            Content::Configuration(configuration) => &configuration.text,
            Content::System(system) => system.tree.text(),
        }
    }

    pub(super) fn agent(&self) -> Option<&Document> {
        match &self.content {
            Content::Agent(document) => Some(document),
            _ => None,
        }
    }

    pub(super) fn configuration(&self) -> Option<&ConfigurationText> {
        match &self.content {
            Content::Configuration(configuration) => Some(configuration),
            _ => None,
        }
    }

    pub(super) fn system(&self) -> Option<&SystemText> {
        match &self.content {
            Content::System(system) => Some(system),
            _ => None,
        }
    }

    pub(super) fn place(&self, span: &Range<usize>) -> Place {
        self.lines.place(self.text(), span)
    }

    pub(super) fn span(&self, place: Place) -> Range<usize> {
        self.lines.span(self.text(), place)
    }

    pub(super) fn offset(&self, position: Position) -> usize {
        self.lines.offset(self.text(), position)
    }

    fn edit(&mut self, place: Option<Place>, replacement: &str) {
        let span = place.map_or(0..self.text().len(), |place| self.span(place));
        match &mut self.content {
            Content::Agent(document) => document.edit(span, replacement),
            Content::Configuration(old) => {
                let mut text = std::mem::take(&mut old.text);
                text.replace_range(span, replacement);
                **old = ConfigurationText::new(text);
            }
            Content::System(old) => {
                let mut text = old.tree.text().to_owned();
                text.replace_range(span, replacement);
                **old = SystemText::new(&text);
            }
        }
        self.lines = Lines::of(self.text());
    }
}

/// The path of an agent's configuration, which is relative to the system.
pub(super) fn member_path(system: &Path, agent: &Agent) -> PathBuf {
    plain(&folder(system).join(&agent.configuration))
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending))
}

/// All texts that the server knows.
#[derive(Debug, Default)]
pub(super) struct Files {
    files: HashMap<PathBuf, File>,
    /// The configurations in a folder.
    folders: HashMap<PathBuf, Vec<PathBuf>>,
}

impl Files {
    pub(super) fn get(&self, path: &Path) -> Option<&File> {
        self.files.get(path)
    }

    /// Takes a text from the editor.
    pub(super) fn open(&mut self, path: &Path, kind: Kind, text: String, open: Open) {
        self.files.insert(path.to_owned(), File::new(kind, text, Some(open)));
    }

    pub(super) fn close(&mut self, path: &Path) {
        self.files.remove(path);
    }

    /// Edits an open text.
    pub(super) fn edit(&mut self, path: &Path, version: i32, place: Option<Place>, text: &str) {
        let Some(file) = self.files.get_mut(path) else { return };
        let Some(open) = &mut file.open else { return };
        open.version = version;
        file.edit(place, text);
    }

    /// Forgets what was read from disk, because it may have changed.
    pub(super) fn forget(&mut self) {
        self.files.retain(|_, file| file.open.is_some());
        self.folders.clear();
    }

    /// The paths of the open texts.
    pub(super) fn opened(&self) -> impl Iterator<Item = &Path> {
        let open = self.files.iter().filter(|(_, file)| file.open.is_some());
        open.map(|(path, _)| path.as_path())
    }

    /// How the editor names a file.
    pub(super) fn uri(&self, path: &Path) -> String {
        let open = self.files.get(path).and_then(|file| file.open.as_ref());
        open.map_or_else(|| uri_of(path), |open| open.uri.clone())
    }

    /// Reads a file unless it is known.
    fn load(&mut self, path: &Path) -> Result<(), ReadError> {
        if !self.files.contains_key(path) {
            let text = read(path)?;
            self.files.insert(path.to_owned(), File::new(Kind::of(path, ""), text, None));
        }
        Ok(())
    }

    /// The configurations that a system names, in the order of its agents, which are read if necessary.
    pub(super) fn members_of(&mut self, system: &Path) -> Vec<(PathBuf, Result<(), ReadError>)> {
        let text = self.files.get(system).and_then(File::system);
        let named = text.into_iter().flat_map(|text| text.tree.agents());
        let paths: Vec<PathBuf> = named.map(|agent| member_path(system, agent)).collect();
        let mut members = Vec::new();
        for path in paths {
            let read = self.load(&path);
            members.push((path, read));
        }
        members
    }

    /// The path of a configuration's agent, which is read if necessary; `None` if the configuration has errors.
    pub(super) fn agent_of(
        &mut self,
        configuration: &Path,
    ) -> Option<(PathBuf, Result<(), ReadError>)> {
        let agent = self.input(configuration)?;
        let read = self.load(&agent);
        Some((agent, read))
    }

    /// The agent that a known configuration names.
    fn input(&self, configuration: &Path) -> Option<PathBuf> {
        let text = self.files.get(configuration)?.configuration()?;
        let input = &text.tree.settings.input;
        let folder = configuration.parent()?;
        (!input.is_empty()).then(|| plain(&folder.join(input)))
    }

    /// The configurations that name an agent: open ones, and those in its folder. Sorted by path.
    pub(super) fn configurations_of(&mut self, agent: &Path) -> Vec<PathBuf> {
        for path in self.in_folder_of(agent) {
            // One that cannot be read names no agent.
            _ = self.load(&path);
        }
        let known = self.files.keys();
        let mut own: Vec<PathBuf> =
            known.filter(|path| self.input(path).is_some_and(|i| i == agent)).cloned().collect();
        own.sort();
        own
    }

    /// The files in a text's folder that end like configurations.
    pub(super) fn in_folder_of(&mut self, agent: &Path) -> Vec<PathBuf> {
        let Some(folder) = agent.parent().filter(|folder| folder.is_absolute()) else {
            return Vec::new();
        };
        let listed = self.folders.entry(folder.to_owned()).or_insert_with(|| {
            let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
            let paths = entries.map(|entry| entry.path());
            paths.filter(|path| has_ending(path, "conf")).collect()
        });
        listed.clone()
    }
}
