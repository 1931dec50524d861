//! Messages between agents: what is sent, what is told, and where beliefs and goals come from.
//!
//! A belief that peers tell is one belief for each of them. A context that asks for it tries them in their order, one's
//! own first, and takes the first for which the rest of the context holds.

use std::collections::HashSet;

use diagnostic::Span;

use super::Analysis;
use super::age::no_age_of_events;
use super::declarations::not_a_peer;
use super::scope::Scope;
use super::values::Resolved;
use crate::code::Code;
use crate::configuration::{Cause, Configuration, ExternalTrigger, Formula as Property, sending};
use crate::program::{
    Alternatives, Asked, BeliefId, Condition, Pattern, Step, Told, Value, peer_constant,
};
use crate::syntax::ast::{
    Agent, Atom, Expression, Formula, Name, Operator, Performative, Relation, TriggerKind,
};
use crate::types::CType;

/// Contexts are translated once for each way to choose the sources of their beliefs.
const MOST_WAYS: usize = 64;

/// The configuration with an action for each message that the agent sends.
pub(super) fn with_sending(mut configuration: Configuration, agent: &Agent) -> Configuration {
    let formulae = agent.plans.iter().flat_map(|plan| &plan.body);
    let sent = formulae.filter_map(|formula| match formula {
        Formula::Send { performative, content, .. } => {
            Some(sending(*performative, &content.name.text))
        }
        _ => None,
    });
    let sent: HashSet<String> = sent.chain(named(&configuration)).collect();
    let actions = configuration.sending().into_iter();
    configuration.basics.extend(actions.filter(|action| sent.contains(&action.name.text)));
    configuration
}

/// Actions that classes and properties name.
fn named(configuration: &Configuration) -> Vec<String> {
    let classes = configuration.classes.iter().flat_map(|class| &class.actions);
    let properties = configuration.properties.iter().flat_map(|property| match &property.formula {
        Property::AllHandled => Vec::new(),
        Property::Count { action, .. } => vec![action],
        Property::Within { cause: Cause::Action(cause), actions, .. } => {
            actions.iter().chain([cause]).collect()
        }
        Property::Within { actions, .. } => actions.iter().collect(),
        Property::OnlyAfter { action, until, .. } => until.iter().chain([action]).collect(),
    });
    classes.chain(properties).map(|name| name.text.clone()).collect()
}

/// Beliefs that the agent may have without a peer.
pub(super) fn own_beliefs(configuration: &Configuration, agent: &Agent) -> HashSet<String> {
    let initial = agent.beliefs.iter().map(|atom| &atom.name);
    let formulae = agent.plans.iter().flat_map(|plan| &plan.body);
    let added = formulae.filter_map(|formula| match formula {
        Formula::Add(atom) => Some(&atom.name),
        _ => None,
    });
    let raised = configuration
        .triggerables
        .iter()
        .filter_map(|trigger| (trigger.kind == TriggerKind::Belief).then_some(&trigger.name));
    let names = initial.chain(added).chain(raised).chain(&configuration.settables);
    names.map(|name| name.text.clone()).collect()
}

/// Where a belief or goal comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// The agent itself, or its environment.
    Own,
    /// A peer, by its number.
    Peer(usize),
}

impl Source {
    fn value(self, configuration: &Configuration) -> Value {
        match self {
            Self::Own => Value::Me,
            Self::Peer(number) => {
                let constant = peer_constant(&configuration.peers[number].text);
                Value::Constant(constant, CType::peer())
            }
        }
    }
}

/// A context's expressions, those in parentheses with the others.
pub(super) fn conjuncts(expression: &Expression) -> Vec<&Expression> {
    match expression {
        Expression::And(parts) => parts.iter().flat_map(conjuncts).collect(),
        other => vec![other],
    }
}

impl Analysis<'_> {
    /// What peers tell and ask for.
    pub(super) fn messages(&mut self) -> (Vec<Told>, Vec<Asked>) {
        let (mut told, mut asked) = (Vec::new(), Vec::new());
        for peer in &self.configuration.peers {
            if !self.declarations.is_free(&peer.text) {
                let message = format!("`{}` is a peer, and something else", peer.text);
                self.findings.configuration.push(
                    Code::DeclaredTwice
                        .at(message, peer.span.clone())
                        .help("a name is one peer, one basic action or one predicate"),
                );
            }
        }
        self.check_names();
        self.caused();
        for message in self.configuration.messages.clone() {
            let name = &message.name.text;
            let handler =
                |analysis: &Self, operator, kind| analysis.handler_id(operator, kind, name);
            // It is declared for all peers, and this one need not use it.
            self.declarations.external_predicate(&message.name, &mut self.findings.configuration);
            if message.performative == Performative::Achieve {
                let Some(handler) = handler(self, Operator::Add, TriggerKind::Achieve) else {
                    continue;
                };
                let mut preemptive = self.configuration.preemptive.iter();
                let preemptive = preemptive.any(|goal| goal.name.text == *name);
                asked.extend(message.senders.iter().map(|sender| Asked {
                    name: name.clone(),
                    sender: *sender,
                    handler,
                    room: message.room,
                    preemptive,
                }));
                continue;
            }
            let added = handler(self, Operator::Add, TriggerKind::Belief);
            let removed = handler(self, Operator::Delete, TriggerKind::Belief);
            for sender in &message.senders {
                let belief = self.told_belief(name, *sender, &message.parameters);
                let (timed, name) = (self.timed.contains(&(name.clone(), *sender)), name.clone());
                told.push(Told { name, sender: *sender, belief, added, removed, timed });
            }
        }
        (told, asked)
    }

    /// Checks the events of peers in properties.
    fn caused(&mut self) {
        let properties = self.configuration.properties.clone();
        for event in properties.iter().flat_map(|property| property.formula.events()) {
            let Some(source) = &event.source else { continue };
            let checked = self.cause(event, source);
            self.findings.configuration.extend(checked.err());
        }
    }

    /// Checks that a peer can cause an event.
    fn cause(&self, event: &ExternalTrigger, source: &Name) -> Resolved<()> {
        let name = &event.name.text;
        let performative = match event.kind {
            TriggerKind::Achieve => Performative::Achieve,
            TriggerKind::Belief | TriggerKind::Test => Performative::Tell,
        };
        let Some(message) = self.configuration.message(performative, name) else {
            return Err(no_source(name, event.name.span.clone()));
        };
        match self.configuration.peer(&source.text) {
            None => {
                return Err(Code::NotDeclared
                    .at(format!("`{}` is not a peer", source.text), source.span.clone())
                    .help("write a name of the section `peers`; an event without source is the environment's"));
            }
            Some(number) if !message.senders.contains(&number) => {
                return Err(never_sent(&source.text, performative, name, source.span.clone()));
            }
            Some(_) => {}
        }
        let is_goal = event.kind == TriggerKind::Achieve;
        let has_plans = |operator| self.handler_id(operator, event.kind, name).is_some();
        if has_plans(Operator::Add) || !is_goal && has_plans(Operator::Delete) {
            return Ok(());
        }
        let wanted =
            if is_goal { format!("`+!{name}`") } else { format!("`+{name}` or `-{name}`") };
        Err(Code::MissingPlan
            .at(format!("no plan for {wanted}"), event.span.clone())
            .help("without plans, what a peer says is no event"))
    }

    /// Names of C that only agents with peers have.
    fn check_names(&mut self) {
        const OWN: [&str; 7] = [
            "me",
            "peer",
            "peer_t",
            "take_asked",
            "take_asked_from",
            "take_told",
            "take_told_from",
        ];
        let Some(first) = self.configuration.peers.first() else { return };
        let place = first.span.clone();
        let receiving = self.configuration.receiving().into_iter();
        let receiving = receiving.map(|(name, _, message)| (name, message.span.clone()));
        let urgent = self.configuration.preemptive.iter().flat_map(|trigger| {
            let goal = &trigger.name.text;
            [format!("take_urgent_{goal}"), format!("hear_urgent_{goal}")]
        });
        let own = OWN.iter().map(|name| (*name).to_owned()).chain(urgent);
        let own: Vec<_> = own.map(|name| (name, place.clone())).collect();
        let peers = self.configuration.peers.iter();
        let constants = peers.map(|peer| (peer_constant(&peer.text), peer.span.clone()));
        let structs = &self.configuration.structs;
        for (name, span) in own.into_iter().chain(receiving).chain(constants) {
            let is_struct = structs.iter().any(|declared| {
                // The constants of peers are macros, which fields cannot be called either.
                let mut fields = declared.fields.iter();
                declared.name.text == name || fields.any(|(field, _)| field.text == name)
            });
            if is_struct || self.declarations.is_basic(&name) {
                self.findings.configuration.push(
                    Code::ReservedName
                        .at(format!("an agent with peers has its own `{name}`"), span)
                        .help("rename the other one with this name"),
                );
            }
        }
    }

    /// The belief that a peer tells.
    fn told_belief(&mut self, name: &str, sender: usize, types: &[CType]) -> BeliefId {
        let peer = &self.configuration.peers[sender];
        let (own, span) = (format!("{name}_from_{}", peer.text), peer.span.clone());
        if self.declarations.is_predicate(&own) || self.declarations.is_basic(&own) {
            self.findings.configuration.push(
                Code::ReservedName
                    .at(format!("`{own}` is what `{}` tells of `{name}`", peer.text), span)
                    .help("rename the other one with this name"),
            );
        }
        self.belief_id(&own, types)
    }

    /// The peer of a name, and its value.
    fn named_source(&self, atom: &Atom) -> Option<Source> {
        if !atom.arguments.is_empty() || !self.declarations.is_free(&atom.name.text) {
            return None;
        }
        if atom.name.text == "self" && !self.configuration.peers.is_empty() {
            return Some(Source::Own);
        }
        self.configuration.peer(&atom.name.text).map(Source::Peer)
    }

    /// The value of a peer's name.
    pub(super) fn peer_value(&self, atom: &Atom) -> Option<Value> {
        Some(self.named_source(atom)?.value(&self.configuration))
    }

    /// The pattern for the source of a trigger's event.
    pub(super) fn source_pattern(
        &mut self,
        atom: &Atom,
        kind: TriggerKind,
        scope: &mut Scope,
    ) -> Option<Pattern> {
        if let Some(error) = no_age_of_events(atom) {
            self.error(error);
        }
        let name = &atom.name.text;
        if !self.configuration.is_sourced(kind, name) {
            if let Some(source) = &atom.source {
                self.error(no_source(name, source.span()));
            }
            return None;
        }
        let Some(source) = &atom.source else { return Some(Pattern::Any) };
        let performative = match kind {
            TriggerKind::Achieve => Performative::Achieve,
            TriggerKind::Belief | TriggerKind::Test => Performative::Tell,
        };
        let checked = self.check_source(source, performative, name);
        self.report(checked)?;
        let pattern = self.pattern(source, &CType::peer(), scope);
        self.report(pattern)
    }

    /// Checks that a source is a variable, or somebody who may send the message.
    fn check_source(
        &self,
        source: &Expression,
        performative: Performative,
        name: &str,
    ) -> Resolved<()> {
        let atom = match source {
            Expression::Variable(_) | Expression::Unnamed(_) => return Ok(()),
            Expression::Atom(atom) => atom,
            _ => return Err(not_a_peer("this", source.span())),
        };
        let message = self.configuration.message(performative, name);
        let senders = message.map_or(&[][..], |message| &message.senders);
        match self.named_source(atom) {
            None => Err(not_a_peer(&format!("`{}`", atom.name.text), atom.span.clone())),
            Some(Source::Peer(number)) if !senders.contains(&number) => {
                Err(never_sent(&atom.name.text, performative, name, atom.span.clone()))
            }
            Some(_) => Ok(()),
        }
    }

    /// A belief that peers tell, with those whose turn comes here; `None` if it is another condition.
    pub(super) fn told<'a>(&self, condition: &'a Expression) -> Option<&'a Atom> {
        let Expression::Atom(atom) = condition else { return None };
        let name = &atom.name.text;
        let is_told = self.configuration.message(Performative::Tell, name).is_some();
        (is_told && self.declarations.is_predicate(name)).then_some(atom)
    }

    /// A belief that peers tell and the rest of its context, which decides who told it.
    pub(super) fn search(
        &mut self,
        atom: &Atom,
        rest: &[&Expression],
        scope: &mut Scope,
        conjunction: &mut Vec<Condition>,
    ) -> Resolved<()> {
        let name = &atom.name.text;
        let types = self.declarations.predicate(atom)?;
        if let Some(source) = &atom.source {
            self.check_source(source, Performative::Tell, name)?;
        }
        self.check_age(atom)?;
        self.keep_times(atom);
        let sources = self.sources(atom, scope);
        if let [only] = sources.as_slice() {
            self.told_by(*only, atom, &types, scope, conjunction)?;
            return self.conjunction(rest, scope, conjunction);
        }
        self.searched = self.searched.max(1) * sources.len();
        if self.searched > MOST_WAYS {
            let message =
                format!("more than {MOST_WAYS} ways to choose who told the beliefs of a context");
            return Err(Code::Limit.at(message, atom.span.clone()).help(
                "name some of the sources, or choose them in the contexts of several plans",
            ));
        }
        let (mut branches, mut bound) = (Vec::new(), Vec::new());
        let before = self.searched;
        for source in &sources {
            self.searched = before;
            let mark = scope.mark();
            let mut branch = Vec::new();
            self.told_by(*source, atom, &types, scope, &mut branch)?;
            self.conjunction(rest, scope, &mut branch)?;
            bound.push(scope.bound_since(mark));
            scope.leave(mark);
            branches.push(branch);
        }
        let exports = scope.exports(&bound);
        conjunction.push(Condition::Any(Alternatives { branches, exports }));
        Ok(())
    }

    /// Who may have told a belief, one's own first.
    fn sources(&self, atom: &Atom, scope: &Scope) -> Vec<Source> {
        let name = &atom.name.text;
        let message = self.configuration.message(Performative::Tell, name);
        let peers = message.into_iter().flat_map(|message| &message.senders);
        // What is one's own has no age.
        let is_own = self.own.contains(name) && atom.age.is_none();
        let own = is_own.then_some(Source::Own);
        let mut all = own.into_iter().chain(peers.map(|number| Source::Peer(*number)));
        let fits = |source: &Source| self.fits(*source, atom.source.as_deref(), scope);
        let found: Vec<Source> = all.clone().filter(fits).collect();
        if found.is_empty() {
            // What is never believed is asked for as any other belief that is not.
            let asked = if atom.age.is_some() { all.next() } else { None };
            return vec![asked.unwrap_or(Source::Own)];
        }
        found
    }

    /// Whether what comes from this source may be what is asked for.
    fn fits(&self, source: Source, wanted: Option<&Expression>, scope: &Scope) -> bool {
        match wanted {
            Some(Expression::Atom(name)) => match self.named_source(name) {
                // One's own is also that of one's own name.
                Some(Source::Peer(_)) if source == Source::Own => true,
                named => named == Some(source),
            },
            // Who told something is nobody else, and not the agent itself: nobody hears what he tells himself.
            Some(Expression::Variable(name)) => {
                let known = scope.known(&name.text);
                known.is_none_or(|known| *known == source.value(&self.configuration))
            }
            _ => true,
        }
    }

    /// The conditions that the belief matches and comes from this source.
    fn told_by(
        &mut self,
        source: Source,
        atom: &Atom,
        types: &[CType],
        scope: &mut Scope,
        conjunction: &mut Vec<Condition>,
    ) -> Resolved<()> {
        let belief = match source {
            Source::Own => self.belief_id(&atom.name.text, types),
            Source::Peer(number) => self.told_belief(&atom.name.text, number, types),
        };
        self.beliefs[belief.0].asked_at.get_or_insert(atom.span.clone());
        let found = source.value(&self.configuration);
        // Who is known already is compared before the arguments are evaluated, and who is not is known from them on.
        let is_known = atom.source.as_deref().is_some_and(|source| match source {
            Expression::Variable(name) => scope.lookup(&name.text).is_some(),
            _ => true,
        });
        if is_known {
            self.from(&found, atom, scope, conjunction)?;
        }
        let patterns = self.patterns(atom, types, scope)?;
        conjunction.push(Condition::Holds { belief, patterns });
        if !is_known {
            self.from(&found, atom, scope, conjunction)?;
        }
        if let Some(age) = &atom.age {
            conjunction.extend(self.aged(belief, age, scope)?);
        }
        Ok(())
    }

    /// The condition that a belief comes from whom it asks for.
    fn from(
        &mut self,
        found: &Value,
        atom: &Atom,
        scope: &mut Scope,
        conjunction: &mut Vec<Condition>,
    ) -> Resolved<()> {
        match atom.source.as_deref() {
            None | Some(Expression::Unnamed(_)) => {}
            Some(Expression::Variable(name)) if scope.lookup(&name.text).is_none() => {
                let variable = scope.bind(name, &CType::peer());
                scope.know(variable, found.clone());
                conjunction.push(Condition::Bind { variable, value: found.clone() });
            }
            Some(Expression::Variable(name)) if scope.known(&name.text) == Some(found) => {
                scope.decide_by(&name.text);
            }
            Some(wanted) => {
                let wanted = self.value(wanted, &CType::peer(), scope)?;
                if let Value::Variable(variable) = wanted {
                    scope.know(variable, found.clone());
                }
                if wanted != *found {
                    conjunction.push(equal(found.clone(), wanted));
                }
            }
        }
        Ok(())
    }

    /// `.my_name(M)` in a context.
    pub(super) fn my_name(
        &mut self,
        name: &Expression,
        span: &Span,
        scope: &mut Scope,
    ) -> Resolved<Condition> {
        self.check_peers(span)?;
        match name {
            Expression::Variable(variable) if scope.lookup(&variable.text).is_none() => {
                let variable = scope.bind(variable, &CType::peer());
                scope.know(variable, Value::Me);
                Ok(Condition::Bind { variable, value: Value::Me })
            }
            other => {
                let wanted = self.value(other, &CType::peer(), scope)?;
                check_peers_differ(&Value::Me, &wanted, span)?;
                Ok(equal(Value::Me, wanted))
            }
        }
    }

    /// Refuses what needs peers where there are none.
    pub(super) fn check_peers(&self, span: &Span) -> Resolved<()> {
        if self.configuration.peers.is_empty() {
            return Err(Code::NotDeclared
                .at("the agent has no peers", span.clone())
                .help("name them in the configuration: `peers { leader, wingman };`"));
        }
        Ok(())
    }

    /// `.send` and `.broadcast`.
    pub(super) fn send(
        &mut self,
        to: Option<&Expression>,
        performative: Performative,
        content: &Atom,
        scope: &mut Scope,
    ) -> Resolved<Step> {
        let name = &content.name.text;
        self.check_peers(&content.span)?;
        if self.configuration.message(performative, name).is_none() {
            let declared = performative.declared().name();
            return Err(Code::NotDeclared
                .at(format!("`{declared} {name}` is no message"), content.name.span.clone())
                .help(format!(
                    "declare it in the section `messages`: `{declared} {name}(..) from ..;`"
                )));
        }
        if performative.has_arguments() {
            self.declarations.predicate(content)?;
        }
        let mut action = content.clone();
        action.name.text = sending(performative, name);
        if !performative.has_arguments() && !content.arguments.is_empty() {
            let message =
                format!("`{}` takes back `{name}`, whatever its arguments", performative.name());
            return Err(Code::ArgumentCount
                .at(message, content.span.clone())
                .help(format!("write `{name}` without arguments")));
        }
        if let Some(to) = to {
            action.arguments.insert(0, to.clone());
            return Ok(Step::Action(self.call(&action, scope)?));
        }
        let types = if performative.has_arguments() {
            self.declarations.predicate(content)?
        } else {
            Vec::new()
        };
        let values = self.values(&content.arguments, &types, scope)?;
        let basic = self.declarations.basic_named(&action.name)?;
        let receivers = self.configuration.peers.len() - 1;
        Ok(Step::Broadcast { basic, values, receivers })
    }
}

fn equal(left: Value, right: Value) -> Condition {
    Condition::Compare { relation: Relation::Equal, left, right, ctype: CType::peer() }
}

/// Refuses a comparison of peers that is known.
pub(super) fn check_peers_differ(left: &Value, right: &Value, span: &Span) -> Resolved<()> {
    match (left, right) {
        (Value::Me, Value::Me) | (Value::Constant(..), Value::Constant(..)) => {
            Err(Code::ConstantComparison
                .at("the result is the same for every agent", span.clone())
                .help("compare with a variable or with the result of a function"))
        }
        (Value::Variable(left), Value::Variable(right)) if left == right => {
            Err(Code::ConstantComparison.at("a value is compared with itself", span.clone()))
        }
        _ => Ok(()),
    }
}

fn never_sent(
    peer: &str,
    performative: Performative,
    name: &str,
    span: Span,
) -> diagnostic::Diagnostic {
    let verb = if performative == Performative::Tell { "tells" } else { "asks for" };
    Code::NeverSent
        .at(format!("`{peer}` never {verb} `{name}`"), span)
        .help("the section `messages` names who may; what is one's own has the source `self`")
}

pub(super) fn no_source(name: &str, span: Span) -> diagnostic::Diagnostic {
    Code::NeverSent
        .at(format!("no peer sends `{name}`"), span)
        .help("what the section `messages` does not declare is always the agent's own")
}
