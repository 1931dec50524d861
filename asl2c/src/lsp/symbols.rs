//! The outline of a text.

use gen_lsp_types::{DocumentSymbolParams, SymbolKind};
use serde_json::{Value, json};
use translator::configuration::Configuration;
use translator::syntax::Document;
use translator::syntax::ast::{Operator, Trigger, TriggerKind};
use translator::system::ParsedSystem;

use diagnostic::Span;

use super::answers::{Answer, parameters, result};
use super::files::{Content, File};
use super::server::Server;

/// Beliefs, goal and plans of an agent; all declarations of a configuration; agents and properties of a system.
pub(super) fn symbols(server: &mut Server, params: Value) -> Answer {
    let params: DocumentSymbolParams = parameters(params)?;
    let (_, file) = server.file(&params.text_document.uri.0)?;
    let mut symbols: Vec<Value> = Vec::new();
    let mut add = |name: &str, detail: &str, kind: SymbolKind, whole: &Span, own: &Span| {
        symbols.push(symbol(file, name, detail, kind, whole, own));
    };
    match &file.content {
        Content::Agent(document) => of_agent(document, &mut add),
        Content::Configuration(configuration) => of_configuration(&configuration.tree, &mut add),
        Content::System(system) => of_system(&system.tree, &mut add),
    }
    result(symbols)
}

fn of_agent(document: &Document, add: &mut impl FnMut(&str, &str, SymbolKind, &Span, &Span)) {
    let agent = document.agent();
    for belief in &agent.beliefs {
        add(
            &belief.name.text,
            "initial belief",
            SymbolKind::Property,
            &belief.span,
            &belief.name.span,
        );
    }
    if let Some(goal) = &agent.goal {
        let name = format!("!{}", goal.name.text);
        add(&name, "initial goal", SymbolKind::Event, &goal.span, &goal.name.span);
    }
    for plan in &agent.plans {
        let label = plan.label.as_ref().map(|label| format!("@{}", label.text));
        let name = trigger_text(&plan.trigger);
        let detail = label.unwrap_or_default();
        add(&name, &detail, SymbolKind::Method, &plan.span, &plan.trigger.span);
    }
}

fn of_configuration(
    configuration: &Configuration,
    add: &mut impl FnMut(&str, &str, SymbolKind, &Span, &Span),
) {
    for declared in &configuration.structs {
        let own = &declared.name.span;
        add(&declared.name.text, "struct", SymbolKind::Struct, own, own);
    }
    for basic in &configuration.basics {
        let own = &basic.name.span;
        // The trace function is declared by its setting.
        let detail = basic.result.name.as_str();
        add(&basic.name.text, detail, SymbolKind::Function, &around(&basic.span, own), own);
    }
    for class in &configuration.classes {
        add(&class.name.text, "class", SymbolKind::Class, &class.name.span, &class.name.span);
    }
    for predicate in &configuration.predicates {
        let own = &predicate.name.span;
        let whole = around(&predicate.span, own);
        add(&predicate.name.text, "belief or goal", SymbolKind::Property, &whole, own);
    }
    for property in &configuration.properties {
        let own = &property.name.span;
        let whole = around(&property.span, own);
        add(&property.name.text, "property", SymbolKind::Constant, &whole, own);
    }
}

fn of_system(system: &ParsedSystem, add: &mut impl FnMut(&str, &str, SymbolKind, &Span, &Span)) {
    for agent in system.agents() {
        let own = &agent.peer.span;
        let whole = around(&agent.place, own);
        add(&agent.peer.text, &agent.configuration, SymbolKind::Object, &whole, own);
    }
    for property in system.properties() {
        let own = &property.name.span;
        let whole = around(&property.span, own);
        add(&property.name.text, "property", SymbolKind::Constant, &whole, own);
    }
}

/// The protocol asks that the name is inside of the whole.
fn around(whole: &Span, name: &Span) -> Span {
    whole.start.min(name.start)..whole.end.max(name.end)
}

fn symbol(
    file: &File,
    name: &str,
    detail: &str,
    kind: SymbolKind,
    whole: &Span,
    own: &Span,
) -> Value {
    json!({
        "name": name,
        "detail": detail,
        "kind": kind,
        "range": file.place(whole),
        "selectionRange": file.place(own),
    })
}

/// `+!go`
fn trigger_text(trigger: &Trigger) -> String {
    let operator = if trigger.operator == Operator::Add { '+' } else { '-' };
    let kind = match trigger.kind {
        TriggerKind::Belief => "",
        TriggerKind::Achieve => "!",
        TriggerKind::Test => "?",
    };
    format!("{operator}{kind}{}", trigger.atom.name.text)
}
