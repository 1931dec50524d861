//! All places of a name, in an agent and its configurations.

use std::path::{Path, PathBuf};

use diagnostic::Span;
use translator::names::{Found, Meaning, Occurrence, Usage, in_agent, in_configuration, in_plan};

use super::files::{File, Files};

/// A place of a name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Spot {
    pub(super) path: PathBuf,
    pub(super) span: Span,
    pub(super) usage: Usage,
}

/// A text, and those that use the same names: an agent's configurations and their agents, sorted.
pub(super) fn related(files: &mut Files, path: &Path) -> Vec<PathBuf> {
    let is_agent = files.get(path).is_some_and(|file| file.agent().is_some());
    let agent = if is_agent {
        Some(path.to_owned())
    } else {
        files.agent_of(path).filter(|(_, read)| read.is_ok()).map(|(agent, _)| agent)
    };
    let mut paths = vec![path.to_owned()];
    if let Some(agent) = agent {
        paths.extend(files.configurations_of(&agent));
        paths.push(agent);
    }
    paths.sort();
    paths.dedup();
    paths
}

/// All places of a name in some texts; those of a variable are in its plan.
pub(super) fn places(
    files: &Files,
    home: &Path,
    found: &Found<'_>,
    texts: &[PathBuf],
) -> Vec<Spot> {
    let mut spots = Vec::new();
    if found.meaning == Meaning::Variable {
        if let Some(plan) = found.plan {
            in_plan(plan, &mut |occurrence| collect(home, found, occurrence, &mut spots));
        }
        return spots;
    }
    for path in texts {
        let Some(file) = files.get(path) else { continue };
        in_file(file, &mut |occurrence| collect(path, found, occurrence, &mut spots));
    }
    spots
}

/// All names of a text.
pub(super) fn in_file<'a>(file: &'a File, visit: &mut impl FnMut(Occurrence<'a>)) {
    match (file.agent(), file.configuration()) {
        (Some(document), _) => in_agent(document.agent(), visit),
        (_, Some(configuration)) => in_configuration(&configuration.tree, visit),
        _ => {}
    }
}

fn collect(path: &Path, found: &Found<'_>, occurrence: Occurrence<'_>, spots: &mut Vec<Spot>) {
    let Occurrence { name, meaning, usage } = occurrence;
    if meaning == found.meaning && name.text == found.text {
        spots.push(Spot { path: path.to_owned(), span: name.span.clone(), usage });
    }
}
