//! Completion: names that fit before the cursor.

use std::collections::BTreeSet;
use std::path::PathBuf;

use gen_lsp_types::{CompletionItem, CompletionItemKind, CompletionParams};
use serde_json::{Value, json};
use translator::configuration::{Configuration, SECTIONS, SETTINGS, VERSION};
use translator::system::{self, CHANNELS, ParsedSystem};
use translator::types::{CType, TypeKind};

use super::answers::{Answer, parameters, result};
use super::files::{Content, File};
use super::places::related;
use super::server::Server;

pub(super) fn complete(server: &mut Server, params: Value) -> Answer {
    let params: CompletionParams = parameters(params)?;
    let at = params.text_document_position_params;
    let (path, ..) = server.cursor(&at)?;
    let texts = related(&mut server.files, &path);
    let members = server.files.members_of(&path);
    let beside = server.files.in_folder_of(&path);
    let (_, file, offset) = server.cursor(&at)?;
    let mut items = Items::default();
    match &file.content {
        Content::Agent(document) => {
            let mut texts = texts.iter().filter_map(|path| server.files.get(path));
            let configuration = texts.find_map(File::configuration).map(|text| &text.tree);
            let statement = &document.text()[document.statement_start(offset)..offset];
            in_agent(statement, configuration, &mut items);
        }
        Content::Configuration(text) => in_section(&file.text()[..offset], &text.tree, &mut items),
        Content::System(text) => {
            let known = members.iter().map(|(path, _)| {
                let file = server.files.get(path);
                file.and_then(File::configuration).map(|text| &text.tree)
            });
            let known: Vec<Option<&Configuration>> = known.collect();
            in_system(&file.text()[..offset], &text.tree, &known, &beside, &mut items);
        }
    }
    result(json!({ "isIncomplete": false, "items": items.list }))
}

#[derive(Default)]
struct Items {
    list: Vec<CompletionItem>,
    known: BTreeSet<String>,
}

impl Items {
    fn add(&mut self, label: &str, kind: CompletionItemKind, detail: &str) {
        if self.known.insert(label.to_owned()) {
            self.list.push(CompletionItem {
                label: label.to_owned(),
                kind: Some(kind),
                detail: Some(detail.to_owned()).filter(|detail| !detail.is_empty()),
                ..CompletionItem::default()
            });
        }
    }

    fn beliefs_and_goals(&mut self, configuration: &Configuration, kind: CompletionItemKind) {
        for predicate in &configuration.predicates {
            let name = &predicate.name.text;
            self.add(name, kind, &format!("{name}({})", types(&predicate.parameters)));
        }
    }

    fn basics(&mut self, configuration: &Configuration, fits: impl Fn(TypeKind) -> bool) {
        for basic in configuration.basics.iter().filter(|basic| fits(basic.result.kind)) {
            let name = &basic.name.text;
            let detail = format!("{} {name}({})", basic.result.name, types(&basic.parameters));
            self.add(name, CompletionItemKind::Function, &detail);
        }
    }

    fn peers(&mut self, configuration: &Configuration) {
        for peer in &configuration.peers {
            self.add(&peer.text, CompletionItemKind::EnumMember, "peer");
        }
    }

    /// What only stands before all sections.
    fn version(&mut self, before: &str) {
        if !before.contains('{') {
            self.add("version", CompletionItemKind::Keyword, &format!("version {VERSION};"));
        }
    }

    /// The variables of a statement.
    fn variables(&mut self, statement: &str) {
        for word in statement.split(|c: char| !is_word(c)) {
            if word.starts_with(|c: char| c.is_ascii_uppercase()) {
                self.add(word, CompletionItemKind::Variable, "");
            }
        }
    }
}

fn is_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

fn types(parameters: &[CType]) -> String {
    let names: Vec<&str> = parameters.iter().map(|ctype| ctype.name.as_str()).collect();
    if names.is_empty() { "void".to_owned() } else { names.join(", ") }
}

/// Part of a statement in which the cursor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    /// A trigger, or an initial belief.
    Head,
    /// Behind `:`
    Context,
    /// Where a formula begins.
    Formula,
    /// An argument or another value.
    Value,
}

/// Names that can follow `statement`, the begin of a statement of an agent.
fn in_agent(statement: &str, configuration: Option<&Configuration>, items: &mut Items) {
    let Some(statement) = without_comments(statement) else { return };
    let before = statement.trim_end_matches(is_word);
    let typed = &statement[before.len()..];
    let before = before.trim_end();
    if typed.starts_with(|c: char| c.is_ascii_digit()) || before.ends_with('@') {
        return;
    }
    if is_in_label(before) {
        items.add("req", CompletionItemKind::Keyword, "req(\"REQUIREMENT\")");
        return;
    }
    if let Some(formulae) = before.strip_suffix('.') {
        // Otherwise it is the full stop of the statement.
        let formulae = formulae.trim_end();
        let has_peers = configuration.is_some_and(|known| !known.peers.is_empty());
        if formulae.ends_with([';', '-']) {
            items.add("wait", CompletionItemKind::Keyword, ".wait(milliseconds)");
            if has_peers {
                items.add("send", CompletionItemKind::Keyword, ".send(peer, tell, belief)");
                items.add("broadcast", CompletionItemKind::Keyword, ".broadcast(tell, belief)");
            }
        }
        if has_peers && formulae.ends_with([';', '-', ':', '&', '|', 't', '(']) {
            items.add("my_name", CompletionItemKind::Keyword, ".my_name(Variable)");
        }
        return;
    }
    if let Some(annotation) = annotation(before) {
        let Some(configuration) = configuration.filter(|known| !known.peers.is_empty()) else {
            return;
        };
        if before.contains("<-") {
            return;
        }
        let is_age =
            annotation.strip_suffix('(').is_some_and(|word| word.trim_end().ends_with("age"));
        if annotation.is_empty() {
            items.add("source", CompletionItemKind::Keyword, "source(peer)");
            items.add("age", CompletionItemKind::Keyword, "age(Milliseconds)");
        } else if annotation.ends_with(',') {
            items.add("age", CompletionItemKind::Keyword, "age(Milliseconds)");
        } else if is_age {
            items.variables(before);
        } else {
            items.variables(before);
            items.peers(configuration);
            items.add("self", CompletionItemKind::EnumMember, "the agent itself");
        }
        return;
    }
    let part = part_of(before);
    let is_argument = is_argument(before);
    let value = |kind: TypeKind| kind != TypeKind::Void;
    let goals = before.ends_with('!');
    let is_changed = before.ends_with(['?', '+', '-']) && !before.ends_with("<-");
    if goals || (is_changed && !is_argument && matches!(part, Part::Head | Part::Formula)) {
        let kind = if goals { CompletionItemKind::Event } else { CompletionItemKind::Property };
        if let Some(configuration) = configuration {
            items.beliefs_and_goals(configuration, kind);
        }
        return;
    }
    let is_head = !before.contains(':') && !before.contains("<-");
    if !is_head || is_argument {
        items.variables(before);
    }
    let Some(configuration) = configuration else { return };
    match part {
        // A trigger has only variables and constants.
        _ if is_head && is_argument => {}
        Part::Head => items.beliefs_and_goals(configuration, CompletionItemKind::Property),
        Part::Formula => items.basics(configuration, |_| true),
        Part::Value => {
            items.basics(configuration, value);
            items.peers(configuration);
        }
        Part::Context if is_argument => {
            items.basics(configuration, value);
            items.peers(configuration);
        }
        Part::Context => {
            items.peers(configuration);
            items.beliefs_and_goals(configuration, CompletionItemKind::Property);
            items.basics(configuration, value);
            for word in ["not", "true", "false"] {
                items.add(word, CompletionItemKind::Keyword, "");
            }
        }
    }
}

/// A text with blanks in place of comments and strings; `None` if its end is in one.
fn without_comments(text: &str) -> Option<String> {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = if rest.starts_with("//") {
            rest.find('\n')?
        } else if rest.starts_with("/*") {
            rest.find("*/")? + 2
        } else if first == '"' {
            let mut escaped = false;
            let closes = |(_, c): &(usize, char)| {
                let closes = *c == '"' && !escaped;
                escaped = *c == '\\' && !escaped;
                closes
            };
            rest.char_indices().skip(1).find(closes).map(|(index, _)| index + 1)?
        } else {
            plain.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        };
        plain.push(' ');
        rest = &rest[end..];
    }
    Some(plain)
}

/// The part of a text behind the bracket of a belief's or goal's source, if it ends there.
fn annotation(text: &str) -> Option<&str> {
    let open = text.rfind('[').filter(|open| !text[*open..].contains(']'))?;
    Some(text[open + 1..].trim())
}

/// Whether the end of a text is in the brackets of a label.
fn is_in_label(text: &str) -> bool {
    let open = text.rfind('[').filter(|open| !text[*open..].contains(']'));
    open.is_some_and(|open| text[..open].trim_end_matches(is_word).ends_with('@'))
}

/// Whether the end of a text is among the arguments of a name, not in parentheses that group.
fn is_argument(text: &str) -> bool {
    let mut depth = 0_usize;
    for (index, character) in text.char_indices().rev() {
        match character {
            ')' => depth += 1,
            '(' if depth == 0 => return text[..index].ends_with(is_word),
            '(' => depth -= 1,
            _ => {}
        }
    }
    false
}

fn part_of(before: &str) -> Part {
    let (head, body) = before.split_once("<-").map_or((before, None), |(h, b)| (h, Some(b)));
    let text = body.unwrap_or(head);
    let depth = text.matches('(').count().saturating_sub(text.matches(')').count());
    match body {
        _ if depth > 0 && (body.is_some() || !head.contains(':')) => Part::Value,
        Some(body) => {
            let sign = ['!', '?', '+', '-'];
            let formula = body.rsplit(';').next().unwrap_or_default().trim();
            if formula.trim_end_matches(sign).is_empty() { Part::Formula } else { Part::Value }
        }
        None if head.contains(':') => Part::Context,
        None => Part::Head,
    }
}

/// The section in which a text ends, and the begin of an entry there.
fn entry_of(before: &str) -> Option<(&str, &str)> {
    let open = before.rfind('{').filter(|open| !before[*open..].contains('}'))?;
    let head = before[..open].trim_end();
    let section = &head[head.trim_end_matches(is_word).len()..];
    Some((section, before[open + 1..].rsplit(';').next().unwrap_or_default()))
}

/// Names that can follow `before` in a system, with the configurations of its agents, and those in its folder.
fn in_system(
    before: &str,
    system: &ParsedSystem,
    known: &[Option<&Configuration>],
    beside: &[PathBuf],
    items: &mut Items,
) {
    let Some((section, entry)) = entry_of(before) else {
        items.version(before);
        for section in system::SECTIONS {
            items.add(section, CompletionItemKind::Keyword, "section");
        }
        return;
    };
    let agents = system.agents();
    match section {
        "agents" if entry.contains(':') => {
            for name in beside.iter().filter_map(|path| path.file_name()) {
                items.add(&name.to_string_lossy(), CompletionItemKind::File, "configuration");
            }
        }
        "agents" => known.iter().flatten().for_each(|configuration| items.peers(configuration)),
        "channels" => match entry.split_once('=').map(|(setting, _)| setting.trim()) {
            None => {
                for setting in CHANNELS {
                    items.add(setting, CompletionItemKind::Property, "setting");
                }
            }
            Some("capacity") => {}
            Some(_) => items.add("any", CompletionItemKind::Value, ""),
        },
        "properties" if entry.contains('(') => {
            let typed = entry.trim_end_matches(is_word);
            let event = typed.trim_end_matches(['+', '-', '!']);
            let Some(named) = event.strip_suffix('.') else {
                for agent in agents {
                    items.add(&agent.peer.text, CompletionItemKind::Variable, &agent.configuration);
                }
                return;
            };
            let named = &named[named.trim_end_matches(is_word).len()..];
            let index = agents.iter().position(|agent| agent.peer.text == named);
            let Some(configuration) = index.and_then(|index| *known.get(index)?) else { return };
            if event.len() < typed.len() {
                for event in &configuration.triggerables {
                    items.add(&event.name.text, CompletionItemKind::Event, "");
                }
                return;
            }
            items.basics(configuration, |_| true);
            for class in &configuration.classes {
                items.add(&class.name.text, CompletionItemKind::Class, "class");
            }
            for action in configuration.sending() {
                items.add(&action.name.text, CompletionItemKind::Function, "message");
            }
        }
        "properties" if entry.contains(':') => {
            for formula in ["never_together", "within"] {
                items.add(formula, CompletionItemKind::Keyword, "");
            }
        }
        _ => {}
    }
}

/// Names that can follow `before` in a configuration.
fn in_section(before: &str, configuration: &Configuration, items: &mut Items) {
    let Some((section, entry)) = entry_of(before) else {
        items.version(before);
        for section in SECTIONS {
            items.add(section, CompletionItemKind::Keyword, "section");
        }
        return;
    };
    let actions = |items: &mut Items| items.basics(configuration, |_| true);
    let beliefs =
        |items: &mut Items| items.beliefs_and_goals(configuration, CompletionItemKind::Property);
    match section {
        "settings" => match entry.split_once('=').map(|(setting, _)| setting.trim()) {
            None => {
                for setting in SETTINGS {
                    items.add(setting, CompletionItemKind::Property, "setting");
                }
            }
            Some("instance") => {
                for form in ["static", "context"] {
                    items.add(form, CompletionItemKind::Value, "");
                }
            }
            Some("clock") => items.basics(configuration, |kind| kind != TypeKind::Void),
            Some(_) => {}
        },
        "classes" if entry.contains(':') => {
            actions(items);
            for class in &configuration.classes {
                items.add(&class.name.text, CompletionItemKind::Class, "class");
            }
            for word in ["all", "but"] {
                items.add(word, CompletionItemKind::Keyword, "");
            }
        }
        "messages" => {
            let words = entry.split_whitespace().count();
            if words <= 1 {
                for word in ["tell", "achieve"] {
                    items.add(word, CompletionItemKind::Keyword, "");
                }
                beliefs(items);
            } else {
                items.add("from", CompletionItemKind::Keyword, "");
                items.add("any", CompletionItemKind::Keyword, "");
                items.peers(configuration);
            }
        }
        "settables" | "perceived" | "triggerables" | "preemptive" => beliefs(items),
        // Behind the colon, where no requirements stand.
        "properties"
            if let Some(opened) =
                entry.split_once(':').and_then(|(_, formula)| annotation(formula)) =>
        {
            if opened.contains('(') {
                items.peers(configuration);
            } else {
                items.add("source", CompletionItemKind::Keyword, "source(peer)");
            }
        }
        "properties" if entry.contains('(') => {
            actions(items);
            beliefs(items);
            for class in &configuration.classes {
                items.add(&class.name.text, CompletionItemKind::Class, "class");
            }
            for word in ["unless", "until"] {
                items.add(word, CompletionItemKind::Keyword, "");
            }
        }
        "properties" if entry.contains(':') => {
            for formula in [
                "exactly_one",
                "at_most_one",
                "at_least_one",
                "never",
                "within",
                "only_after",
                "all_handled",
            ] {
                items.add(formula, CompletionItemKind::Keyword, "");
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(statement: &str) -> String {
        let (configuration, _) = translator::configuration::parse(
            "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
            basics { void act(int); int count(void); }; types { go(int); level(int); };",
        );
        let mut items = Items::default();
        in_agent(statement, Some(&configuration), &mut items);
        items.list.iter().map(|item| item.label.as_str()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn peers_are_offered_where_they_can_be_named() {
        let (configuration, _) = translator::configuration::parse(
            "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
            basics { void act(peer); }; peers { leader, scout }; messages { tell low from any; };
            types { go(void); };",
        );
        for (statement, expected) in [
            ("+low[", "source age"),
            ("+!go : low[source(leader), ", "age"),
            ("+!go(X) : low[source(leader), age(", "X"),
            ("+low[source(", "leader scout self"),
            ("+!go : low[source(l", "leader scout self"),
            ("+!go : low[source(P)] & P == ", "P leader scout go low not true false"),
            ("+!go : .", "my_name"),
            ("+!go : not .m", "my_name"),
            ("+!go <- act(", "leader scout"),
            ("+!go <- .", "wait send broadcast my_name"),
            ("+!go <- !go[", ""),
        ] {
            let mut items = Items::default();
            in_agent(statement, Some(&configuration), &mut items);
            let labels = items.list.iter().map(|item| item.label.as_str());
            assert_eq!(labels.collect::<Vec<_>>().join(" "), expected, "{statement}");
        }
        let offered = |before: &str| {
            let mut items = Items::default();
            in_section(before, &configuration, &mut items);
            let labels = items.list.iter().map(|item| item.label.as_str());
            labels.collect::<Vec<_>>().join(" ")
        };
        assert_eq!(offered("messages { te"), "tell achieve go low");
        assert_eq!(offered("messages { tell low from "), "from any leader scout");
        assert_eq!(offered("properties { p [R-1]: within(1, +low["), "source");
        assert_eq!(offered("properties { p: within(1, +low[source(s"), "leader scout");
    }

    #[test]
    fn what_fits_before_the_cursor_is_offered() {
        for (statement, expected) in [
            ("", "go level"),
            ("+!", "go level"),
            ("\n@l[req(\"a\")] +", "go level"),
            ("+!go(X) : ", "X go level count not true false"),
            ("+!go(X) : level(Y) & not l", "X Y go level count not true false"),
            ("+!go(X) : level(", "X count"),
            ("+!go(X) : not (lev", "X go level count not true false"),
            ("+!go(", ""),
            ("+!go(X) <- act(X); !!", "go level"),
            ("// Some Words.\n+!go(X) /* More */ <- say(\"Text\"); ", "X act count"),
            ("+!go(X) <- act(X); // No", ""),
            ("@l[", "req"),
            ("@l[req(\"a\"), r", "req"),
            ("+!go(X) <- ", "X act count"),
            ("+!go(X) <- a", "X act count"),
            ("+!go(X) <- act(", "X count"),
            ("+!go(X) <- act(X); !", "go level"),
            ("+!go(X) <- act(X); -l", "go level"),
            ("+!go(X) <- Y = X - c", "X Y count"),
            ("+!go(X) <- .w", "wait"),
            ("+!go(X) <- act(X); .", "wait"),
            ("+!go(X) <- act(X).", ""),
            ("+!go(X) <- act(3", ""),
            ("+!go(X) <- say(\"a", ""),
            ("// go", ""),
            ("@", ""),
        ] {
            assert_eq!(labels(statement), expected, "{statement}");
        }
    }

    #[test]
    fn sections_and_their_entries_are_offered() {
        let (configuration, _) = translator::configuration::parse(
            "basics { void act(int); }; classes { c: act; }; types { go(int); };",
        );
        let labels = |before: &str| {
            let mut items = Items::default();
            in_section(before, &configuration, &mut items);
            items.list.into_iter().map(|item| item.label).collect::<Vec<_>>().join(" ")
        };
        assert!(labels("").contains("triggerables") && labels("ver").contains("version"));
        assert!(!labels("settings { };").contains("version"), "it stands before all sections");
        assert!(labels("settings { input = a; o").contains("output"));
        assert_eq!(labels("settings { instance = "), "static context");
        assert_eq!(labels("classes { a: "), "act c all but");
        assert_eq!(labels("triggerables { +!"), "go");
        assert!(labels("properties { p: ").contains("within"));
        assert_eq!(labels("properties { p: never("), "act go c unless until");
        assert_eq!(labels("types { "), "");
    }
}
