//! Describes a name in Markdown, for a cursor that rests on it.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::reach::{Key, key, reach};
use super::{Found, Meaning, Usage, in_agent, variable_types};
use crate::configuration::{Basic, Configuration, Predicate};
use crate::program::{peer_constant, trigger_name};
use crate::syntax::ast::{Agent, Operator, Performative, TriggerKind};
use crate::types::{CType, TypeKind};

/// More names than this are counted.
const MOST_NAMES: usize = 12;

/// A description of a name as Markdown; `None` if there is nothing to say of it.
pub fn describe(
    found: &Found<'_>,
    configuration: Option<&Configuration>,
    agent: Option<&Agent>,
) -> Option<String> {
    match found.meaning {
        Meaning::Variable => {
            let ctype = *variable_types(configuration?, found.plan?).get(found.text)?;
            Some(format!("{}variable", code("c", &format!("{} {}", ctype.name, found.text))))
        }
        Meaning::Label => {
            let plan = found.plan?;
            let mut text = format!("label of a plan of `{}`", trigger_text(key(plan)));
            if !plan.requirements.is_empty() {
                _ = write!(text, ", which implements {}", plan.requirements.join(", "));
            }
            Some(text)
        }
        Meaning::Class => {
            let mut classes = configuration?.classes.iter();
            let class = classes.find(|class| class.name.text == found.text)?;
            let actions = class.actions.iter().map(|action| action.text.as_str());
            Some(format!("class of the actions {}", listed(&actions.collect())))
        }
        Meaning::Property => None,
        Meaning::Declared => {
            let declared = configuration.and_then(|configuration| {
                let mut basics = configuration.basics.iter();
                let mut predicates = configuration.predicates.iter();
                let basic = basics.find(|basic| basic.name.text == found.text);
                let predicate = predicates.find(|other| other.name.text == found.text);
                if configuration.peer(found.text).is_some() {
                    return Some(format!("{}peer", code("c", &peer_constant(found.text))));
                }
                let described = basic.map(|basic| action(basic, configuration, agent));
                described.or_else(|| predicate.map(|found| belief(found, configuration, agent)))
            });
            let (mut text, is_basic) = match declared {
                Some(text) => (text, basic_named(configuration, found.text)),
                None => (String::new(), false),
            };
            if !is_basic && let Some(agent) = agent {
                text.push_str(&plans(found, agent));
            }
            let text = text.trim_end();
            (!text.is_empty()).then(|| text.to_owned())
        }
    }
}

fn basic_named(configuration: Option<&Configuration>, name: &str) -> bool {
    configuration.is_some_and(|c| c.basics.iter().any(|basic| basic.name.text == name))
}

/// The declaration of a basic action or function.
fn action(basic: &Basic, configuration: &Configuration, agent: Option<&Agent>) -> String {
    let name = &basic.name.text;
    let declaration = format!("{} {name}({});", basic.result.name, types(&basic.parameters));
    let what = if basic.result.kind == TypeKind::Void { "action" } else { "function" };
    let mut text = format!("{}{what} of the environment", code("c", &declaration));
    let classes = configuration.classes.iter();
    let classes = classes.filter(|class| class.actions.iter().any(|action| action.text == *name));
    let classes: BTreeSet<&str> = classes.map(|class| class.name.text.as_str()).collect();
    if !classes.is_empty() {
        _ = write!(text, ", in the class {}", listed(&classes));
    }
    if let Some(agent) = agent {
        let mut uses = 0_usize;
        in_agent(agent, &mut |occurrence| {
            uses += usize::from(
                occurrence.meaning == Meaning::Declared && occurrence.name.text == *name,
            );
        });
        _ = write!(text, "; {}", counted(uses, "call"));
    }
    text
}

/// The declaration of a belief or goal, and what the environment does with it.
fn belief(predicate: &Predicate, configuration: &Configuration, agent: Option<&Agent>) -> String {
    let name = &predicate.name.text;
    let mut text = code("c", &format!("{name}({})", types(&predicate.parameters)));
    let named = |list: &[crate::syntax::ast::Name]| list.iter().any(|other| other.text == *name);
    let mut facts: Vec<String> = Vec::new();
    if named(&configuration.settables) {
        let mut fact = format!("belief that the environment sets with `set_{name}`");
        if named(&configuration.perceived) {
            _ = write!(fact, ", and a change raises `+{name}`");
        }
        facts.push(fact);
    }
    let initial = agent.is_some_and(|a| a.beliefs.iter().any(|atom| atom.name.text == *name));
    if initial {
        facts.push("initial belief".to_owned());
    }
    for message in configuration.messages.iter().filter(|message| message.name.text == *name) {
        let peers = message.senders.iter().filter_map(|peer| configuration.peers.get(*peer));
        let peers = listed(&peers.map(|peer| peer.text.as_str()).collect());
        let what = if message.performative == Performative::Tell { "tell" } else { "ask for" };
        let preempts = message.performative == Performative::Achieve
            && configuration.preemptive.iter().any(|other| other.name.text == *name);
        let how = if preempts { ", which pre-empts what is posted" } else { "" };
        facts.push(format!("the peers that may {what} it are {peers}{how}"));
    }
    for event in configuration.triggerables.iter().filter(|event| event.name.text == *name) {
        let first = configuration.preemptive.iter().any(|other| {
            (other.operator, other.kind, &other.name.text) == (event.operator, event.kind, name)
        });
        let call = trigger_name(event.operator, event.kind, name);
        let trigger = trigger_text((event.operator, event.kind, name));
        let how = if first { ", which pre-empts what is posted" } else { "" };
        facts.push(format!("the environment raises `{trigger}` with `{call}`{how}"));
    }
    for fact in facts {
        _ = write!(text, "{fact}\n\n");
    }
    text
}

/// The plans of a belief or goal, and what they lead to.
fn plans(found: &Found<'_>, agent: &Agent) -> String {
    let mut triggers: BTreeSet<(Operator, TriggerKind)> = BTreeSet::new();
    match found.usage {
        Some(Usage::Trigger(operator, kind)) => _ = triggers.insert((operator, kind)),
        Some(Usage::Goal) => _ = triggers.insert((Operator::Add, TriggerKind::Achieve)),
        Some(Usage::Question) => _ = triggers.insert((Operator::Add, TriggerKind::Test)),
        Some(Usage::Change(operator)) => _ = triggers.insert((operator, TriggerKind::Belief)),
        _ => triggers.extend(
            agent
                .plans
                .iter()
                .filter(|plan| plan.trigger.atom.name.text == found.text)
                .map(|plan| (plan.trigger.operator, plan.trigger.kind)),
        ),
    }
    let mut text = String::new();
    for (operator, kind) in triggers {
        let trigger: Key<'_> = (operator, kind, found.text);
        let count = agent.plans.iter().filter(|plan| key(plan) == trigger).count();
        if count == 0 {
            continue;
        }
        let reached = reach(agent, &[trigger]);
        _ = write!(text, "`{}`: {}", trigger_text(trigger), counted(count, "plan"));
        for (what, names) in [
            ("achieves", &reached.goals),
            ("changes", &reached.changes),
            ("calls", &reached.actions),
        ] {
            if !names.is_empty() {
                _ = write!(text, "\n- {what} {}", listed(names));
            }
        }
        text.push_str("\n\n");
    }
    text
}

/// `+!go`
fn trigger_text((operator, kind, name): Key<'_>) -> String {
    crate::program::trigger_text(operator, kind, name)
}

fn code(language: &str, text: &str) -> String {
    format!("```{language}\n{text}\n```\n\n")
}

fn types(parameters: &[CType]) -> String {
    let names: Vec<&str> = parameters.iter().map(|ctype| ctype.name.as_str()).collect();
    if names.is_empty() { "void".to_owned() } else { names.join(", ") }
}

/// "1 plan", "3 plans"
fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

fn listed(names: &BTreeSet<&str>) -> String {
    let first: Vec<String> = names.iter().take(MOST_NAMES).map(|n| format!("`{n}`")).collect();
    let more = names.len().saturating_sub(MOST_NAMES);
    let first = first.join(", ");
    if more == 0 { first } else { format!("{first} and {more} more") }
}

#[cfg(test)]
mod tests {
    use crate::names::{at_agent, at_configuration};
    use crate::syntax::Document;

    use super::*;

    const ROVER: [&str; 2] =
        [include_str!("../../agents/rover.conf"), include_str!("../../agents/rover.asl")];

    fn described(place: &str, file: usize) -> String {
        let (configuration, _) = crate::configuration::parse(ROVER[0]);
        let document = Document::new(ROVER[1].to_owned());
        let offset = ROVER[file].find(place).unwrap() + place.len() - 1;
        let found = match file {
            0 => at_configuration(&configuration, offset),
            _ => at_agent(&document, offset),
        };
        let text = describe(&found.unwrap(), Some(&configuration), Some(document.agent()));
        text.unwrap_or_default()
    }

    #[test]
    fn each_kind_of_name_is_described() {
        let places = [
            ("@blocked", 1),
            ("+!visit(X, Y) <- halt; !drive", 1),
            ("+!visit", 1),
            ("+!drive(X, Y, Attempts) : obstacle", 1),
            ("obstacle(Metres", 1),
            ("!avoid(X, Y, Left", 1),
            ("<- driveTo", 1),
            (": isThere", 1),
            ("reserve", 1),
            ("not_driving", 0),
            ("preemptive { +!halt_now", 0),
        ];
        let text: Vec<String> =
            places.map(|(place, file)| format!("## {place}\n{}", described(place, file))).into();
        insta::assert_snapshot!(text.join("\n\n"));
    }
}
