//! The page of the safety case: nodes in nested lists, each with what stands below it.

use std::collections::{BTreeMap, BTreeSet};

/// What a node is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Kind {
    Goal,
    Strategy,
    Context,
    Assumption,
    /// A test, by its binary and its path.
    Test(String),
    /// A row of `docs/verification.md`.
    Proof(String),
    /// A command of `.ci/run`.
    Run(String),
}

impl Kind {
    pub(crate) fn is_evidence(&self) -> bool {
        matches!(self, Self::Test(_) | Self::Proof(_) | Self::Run(_))
    }
}

/// An item of a list.
#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) kind: Kind,
    /// Without its id, and the name of the evidence.
    pub(crate) text: String,
    /// Line of the page, from 1.
    pub(crate) line: usize,
    /// What stands below it, and what it refers to.
    pub(crate) below: Vec<String>,
}

/// What is wrong, and in which line of the page.
pub(crate) type Mistake = (usize, String);

/// The nodes by their ids.
pub(crate) type Nodes = BTreeMap<String, Node>;

/// The goal of which all others are parts.
pub(crate) const TOP: &str = "G1";

/// Reads the page, and tells what is wrong with it by itself.
pub(crate) fn parse(text: &str) -> (Nodes, Vec<Mistake>) {
    let (mut nodes, mut mistakes) = (Nodes::new(), Vec::new());
    // The items around the current one, with their indents.
    let mut around: Vec<(usize, String)> = Vec::new();
    for (line, indent, item) in items(text) {
        around.retain(|(outer, _)| *outer < indent);
        let below: Vec<String> = if let Some(ids) = item.strip_prefix("see ") {
            ids.split(", ").map(str::to_owned).collect()
        } else if let Some((id, kind, text)) = node(&item) {
            let node = Node { kind, text: text.to_owned(), line, below: Vec::new() };
            if nodes.insert(id.to_owned(), node).is_some() {
                mistakes.push((line, format!("{id} is there twice")));
            }
            vec![id.to_owned()]
        } else {
            mistakes.push((line, format!("neither a node nor a reference: {item}")));
            continue;
        };
        if let Some(above) = around.last().and_then(|(_, id)| nodes.get_mut(id)) {
            above.below.extend(below.iter().cloned());
        }
        around.extend(below.into_iter().map(|id| (indent, id)).take(1));
    }
    let used: BTreeSet<&String> = nodes.values().flat_map(|node| &node.below).collect();
    for (id, node) in &nodes {
        let below = |below: &String| nodes.get(below).map(|found| (found.line, &found.kind));
        let is_support = |id: &String| below(id).is_some_and(|(_, kind)| *kind != Kind::Context);
        // What is referred to stands further down, so that nothing supports itself.
        let is_astray = |id: &&String| {
            below(id).is_none_or(|(line, kind)| line <= node.line && *kind != Kind::Assumption)
        };
        let astray = node.below.iter().filter(is_astray);
        mistakes
            .extend(astray.map(|below| (node.line, format!("there is no {below} behind {id}"))));
        let is_divided = matches!(node.kind, Kind::Goal | Kind::Strategy);
        let is_complete = node.kind != Kind::Assumption
            || node.text.contains("*Experiment:* ") && node.text.contains(".md");
        for (wrong, says) in [
            (!used.contains(id) && id != TOP, "supports nothing"),
            (is_divided && !node.below.iter().any(is_support), "is not supported"),
            (!is_divided && !node.below.is_empty(), "cannot have anything below it"),
            (!is_complete, "lacks its experiment, or a link to it"),
        ] {
            mistakes.extend(wrong.then(|| (node.line, format!("{id} {says}"))));
        }
    }
    (nodes, mistakes)
}

/// Items of lists: line, indent, and text with the lines that go on.
fn items(text: &str) -> Vec<(usize, usize, String)> {
    let mut items: Vec<(usize, usize, String)> = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        let bare = text.trim_start();
        let indent = text.len() - bare.len();
        if let Some(item) = bare.strip_prefix("- ") {
            items.push((line, indent, item.to_owned()));
        } else if let Some((_, _, item)) = items.last_mut().filter(|_| indent > 0) {
            *item = format!("{item} {bare}");
        }
    }
    items
}

/// Id, kind and text of ``**ID** text`` or ``**ID** test `NAME`: text``.
fn node(item: &str) -> Option<(&str, Kind, &str)> {
    let (id, text) = item.strip_prefix("**")?.split_once("** ")?;
    let kind = match id.split_at_checked(1)? {
        (_, number) if !number.starts_with(|c: char| c.is_ascii_digit()) => return None,
        ("G", _) => Kind::Goal,
        ("S", _) => Kind::Strategy,
        ("C", _) => Kind::Context,
        ("A", _) => Kind::Assumption,
        ("E", _) => {
            let (kind, rest) = text.split_once(" `")?;
            let (name, text) = rest.split_once("`: ")?;
            let kind = match kind {
                "test" => Kind::Test,
                "proof" => Kind::Proof,
                "run" => Kind::Run,
                _ => return None,
            };
            return Some((id, kind(name.to_owned()), text));
        }
        _ => return None,
    };
    Some((id, kind, text))
}
