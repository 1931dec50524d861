//! The page of the safety case: nodes in nested lists, each with what stands below it.

use std::collections::{BTreeMap, BTreeSet};

/// What a node is, by the letter of its id.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Kind {
    /// What is claimed.
    Goal,
    /// How a claim is divided.
    Strategy,
    /// What was tested.
    Test(String),
    /// What was proved of the agent and its C.
    Proof(String),
    /// A command of `.ci/run`.
    Run(String),
    /// What is taken to be so.
    Assumption,
    /// What the words mean, or where the claim holds.
    Context,
}

/// An item of a list.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) kind: Kind,
    /// Without the id and the evidence's name.
    pub(crate) text: String,
    /// Line of the page, from 1.
    pub(crate) line: usize,
    /// What stands below it, and what it refers to, in their order.
    pub(crate) below: Vec<String>,
}

/// All nodes by their ids, and what is wrong with the page.
#[derive(Debug, Default)]
pub(crate) struct Page {
    pub(crate) nodes: BTreeMap<String, Node>,
    /// Line and message.
    pub(crate) mistakes: Vec<(usize, String)>,
}

/// The node that is not below another one.
pub(crate) const TOP: &str = "G1";

impl Page {
    pub(crate) fn parse(text: &str) -> Self {
        let mut page = Self::default();
        // Ids of the items around the current one, with their indents.
        let mut around: Vec<(usize, String)> = Vec::new();
        for (line, indent, item) in items(text) {
            around.retain(|(outer, _)| *outer < indent);
            let parent = around.last().map(|(_, id)| id.clone());
            let below = if let Some(ids) = item.strip_prefix("see ") {
                ids.split(',').map(|id| id.trim().to_owned()).collect()
            } else {
                match node(&item) {
                    Ok((id, kind, text)) => {
                        let node = Node { kind, text, line, below: Vec::new() };
                        if page.nodes.insert(id.clone(), node).is_some() {
                            page.mistakes.push((line, format!("{id} is there twice")));
                        }
                        around.push((indent, id.clone()));
                        vec![id]
                    }
                    Err(mistake) => {
                        page.mistakes.push((line, mistake));
                        continue;
                    }
                }
            };
            if let Some(parent) = parent.and_then(|id| page.nodes.get_mut(&id)) {
                parent.below.extend(below);
            }
        }
        page.judge();
        page
    }

    /// Looks for what is not supported, not used, or not there.
    fn judge(&mut self) {
        let mut mistakes = Vec::new();
        for (id, node) in &self.nodes {
            let missing = node.below.iter().filter(|below| !self.nodes.contains_key(*below));
            mistakes.extend(missing.map(|below| (node.line, format!("there is no {below}"))));
            let is_support = |below: &&Node| below.kind != Kind::Context;
            let mut supports = node.below.iter().filter_map(|id| self.nodes.get(id));
            let is_supported = supports.any(|below| is_support(&below));
            let wrong = match node.kind {
                Kind::Goal | Kind::Strategy => !is_supported,
                _ => !node.below.is_empty(),
            };
            if wrong && node.below.is_empty() {
                mistakes.push((node.line, format!("nothing supports {id}")));
            } else if wrong {
                mistakes.push((node.line, format!("{id} has what does not belong below it")));
            }
            let lacks_experiment = node.kind == Kind::Assumption
                && !(node.text.contains("*Experiment:*") && node.text.contains(".md"));
            if lacks_experiment {
                mistakes.push((node.line, format!("{id} lacks its experiment, or the link to it")));
            }
            if node.text.is_empty() {
                mistakes.push((node.line, format!("{id} says nothing")));
            }
        }
        let mut used = BTreeSet::new();
        if let Err(round) = self.reach(TOP, &mut Vec::new(), &mut used) {
            mistakes.push((0, round));
        }
        let unused = self.nodes.iter().filter(|(id, _)| !used.contains(*id));
        mistakes.extend(unused.map(|(id, node)| (node.line, format!("{id} supports nothing"))));
        self.mistakes.extend(mistakes);
    }

    /// Collects what `id` rests on.
    fn reach(
        &self,
        id: &str,
        path: &mut Vec<String>,
        used: &mut BTreeSet<String>,
    ) -> Result<(), String> {
        if path.iter().any(|above| above == id) {
            return Err(format!("{id} supports itself"));
        }
        used.insert(id.to_owned());
        path.push(id.to_owned());
        for below in self.nodes.get(id).map_or(&[][..], |node| &node.below) {
            self.reach(below, path, used)?;
        }
        path.pop();
        Ok(())
    }
}

/// Items of lists: line, indent, and text with what is broken onto further lines.
fn items(text: &str) -> Vec<(usize, usize, String)> {
    let mut items: Vec<(usize, usize, String)> = Vec::new();
    let mut is_open = false;
    for (line, text) in (1..).zip(text.lines()) {
        let bare = text.trim_start();
        let indent = text.len() - bare.len();
        if let Some(item) = bare.strip_prefix("- ") {
            items.push((line, indent, item.to_owned()));
            is_open = true;
        } else if let Some((_, _, item)) = items.last_mut()
            && is_open
            && indent > 0
            && !bare.is_empty()
        {
            item.push(' ');
            item.push_str(bare);
        } else {
            is_open = false;
        }
    }
    items
}

/// Id, kind and text of an item.
fn node(item: &str) -> Result<(String, Kind, String), String> {
    let (id, text) = item
        .strip_prefix("**")
        .and_then(|rest| rest.split_once("**"))
        .ok_or_else(|| format!("neither a node nor a reference: {item}"))?;
    let digits = |rest: &str| rest.chars().all(|c| c.is_ascii_digit() || c == '.');
    if id.len() < 2 || !digits(id.get(1..).unwrap_or("?")) {
        return Err(format!("no id: {id}"));
    }
    let text = text.trim();
    let (kind, text) = match id.chars().next() {
        Some('G') => (Kind::Goal, text),
        Some('S') => (Kind::Strategy, text),
        Some('A') => (Kind::Assumption, text),
        Some('C') => (Kind::Context, text),
        Some('E') => evidence(text).ok_or_else(|| format!("{id} is no evidence"))?,
        _ => return Err(format!("no kind of node begins like {id}")),
    };
    Ok((id.to_owned(), kind, text.to_owned()))
}

/// ``test `NAME`: what it shows``.
fn evidence(text: &str) -> Option<(Kind, &str)> {
    let (kind, rest) = text.split_once(" `")?;
    let (name, text) = rest.split_once("`: ")?;
    let name = name.to_owned();
    let kind = match kind {
        "test" => Kind::Test(name),
        "proof" => Kind::Proof(name),
        "run" => Kind::Run(name),
        _ => return None,
    };
    Some((kind, text.trim()))
}
