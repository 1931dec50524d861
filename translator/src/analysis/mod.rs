//! Checks a syntax tree against its configuration and resolves it to a [`Program`].
//!
//! The order: declarations, then the triggers and their recursion, then each plan. All errors of a file are
//! reported in one run.

mod age;
mod conditions;
pub(crate) mod constants;
mod declarations;
mod graph;
mod leave_out;
mod messages;
mod plans;
mod reach;
mod scope;
mod tail;
mod time;
mod values;

use std::collections::{HashMap, HashSet, VecDeque};

use diagnostic::{Diagnostic, Severity};

use self::constants::constant;
use self::declarations::Declarations;
use self::graph::TriggerGraph;
use self::leave_out::leave_out;
use self::messages::{own_beliefs, with_sending};
use self::reach::{
    Reached, believable, reach, warn_never_believed, warn_unreachable, warn_without_plan,
};
use self::tail::warn_unseen;
use self::time::{Clock, find_clock};
use crate::code::Code;
use crate::configuration::{Cause, Configuration, ExternalTrigger, Formula, Instance};
use crate::program::{
    Belief, BeliefId, External, Handler, HandlerId, Program, Value, deferred_room,
};
use crate::syntax::ast::{self, Agent, Atom, Operator, TriggerKind};
use crate::types::CType;

/// Findings, by file.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// Findings in the configuration.
    pub(crate) configuration: Vec<Diagnostic>,
    /// Findings in the agent.
    pub(crate) agent: Vec<Diagnostic>,
}

impl Findings {
    /// Whether an error prevents translation.
    pub(crate) fn has_errors(&self) -> bool {
        self.configuration.iter().chain(&self.agent).any(|d| d.severity == Severity::Error)
    }
}

/// A trigger: operator, kind and name.
pub(crate) type TriggerKey = (Operator, TriggerKind, String);

/// Checks `agent`, whose source is `text`, for a form of the C. The program is `Some` iff no finding is an
/// error.
pub(crate) fn analyse(
    configuration: Configuration,
    instance: Instance,
    agent: &Agent,
    text: &str,
) -> (Option<Program>, Findings) {
    let mut findings = Findings::default();
    let configuration = with_sending(configuration, agent);
    let declarations = Declarations::new(&configuration, instance, &mut findings.configuration);
    let clock = find_clock(&configuration, &mut findings.configuration);
    let mut analysis = Analysis {
        text,
        configuration: configuration.clone(),
        own: HashSet::new(),
        searched: 0,
        timed: HashSet::new(),
        clock,
        line_starts: std::iter::once(0)
            .chain(text.match_indices('\n').map(|(newline, _)| newline + 1))
            .collect(),
        declarations,
        findings,
        beliefs: Vec::new(),
        belief_ids: HashMap::new(),
        handler_ids: HashMap::new(),
        handlers: Vec::new(),
        test_handlers: HashMap::new(),
        test_triggers: HashSet::new(),
        crowded: HashSet::new(),
        open_tests: VecDeque::new(),
        covered: HashSet::new(),
        waits: HashMap::new(),
    };
    analysis.own = own_beliefs(&analysis.configuration, agent);
    analysis.labels(agent);
    analysis.collect_triggers(agent);
    let graph = TriggerGraph::new(agent);
    analysis.initial_beliefs(agent);
    for plan in agent.plans.iter().filter(|plan| plan.trigger.kind != TriggerKind::Test) {
        analysis.plan(plan, &graph);
    }
    analysis.test_plans(agent, &graph);
    let initial_goal = agent.goal.as_ref().and_then(|goal| analysis.initial_goal(goal));
    analysis.settables(&configuration);
    let external = analysis.external(&configuration);
    let (told, asked) = analysis.messages();
    analysis.compared_beliefs(&configuration);
    let settings = &configuration.settings;
    let named = settings.trace.iter().chain(&settings.clock);
    let named: Vec<&str> = named.map(|name| name.text.as_str()).collect();
    if !analysis.findings.has_errors() {
        analysis.declarations.warn_unused(&named, &mut analysis.findings.configuration);
    }
    let Analysis { mut findings, beliefs, handlers, clock, .. } = analysis;
    let clock = clock.map(Clock::into_parts);
    // A plan of a test goal is resolved once for each combination of given and queried arguments.
    let mut seen = HashSet::new();
    findings.agent.retain(|found| seen.insert((found.span.clone(), found.message.clone())));
    if findings.has_errors() {
        return (None, findings);
    }
    let roots: Vec<HandlerId> = external
        .iter()
        .filter_map(|event| event.handler)
        .chain(beliefs.iter().filter_map(|belief| belief.perceived))
        .chain(told.iter().flat_map(|told| told.added.into_iter().chain(told.removed)))
        .chain(asked.iter().map(|asked| asked.handler))
        .chain(initial_goal.as_ref().map(|(handler, _)| *handler))
        .collect();
    let Reached { handlers: reached, mut posted, deferred, limited } = reach(&handlers, &roots);
    let posted_by_plans = posted.iter().copied().collect();
    posted.extend(initial_goal.as_ref().map(|(handler, _)| *handler));
    let events: Vec<HandlerId> = roots.iter().chain(&posted).chain(&deferred).copied().collect();
    warn_unreachable(&handlers, &reached, &mut findings.agent);
    let believable = believable(&beliefs, &handlers, &external, &told);
    warn_never_believed(&beliefs, &believable, &mut findings.agent);
    warn_without_plan(&handlers, &events, &mut findings.agent);
    warn_unseen(&handlers, &reached, &mut findings.agent);
    let formulae = agent.plans.iter().flat_map(|plan| &plan.body);
    let defers = formulae.filter(|formula| matches!(formula, ast::Formula::Defer(_))).count();
    let mut program = Program {
        deferred_room: deferred_room(&configuration.settings, defers),
        configuration,
        instance,
        beliefs,
        believable,
        handlers,
        left_out: 0,
        posted: posted.into_iter().collect(),
        posted_by_plans,
        deferred: deferred.into_iter().collect(),
        limited: limited.into_iter().collect(),
        clock,
        external,
        initial_goal,
        told,
        asked,
    };
    leave_out(&mut program, &reached);
    (Some(program), findings)
}

struct Analysis<'a> {
    text: &'a str,
    /// As it is declared, and with the actions that send messages.
    configuration: Configuration,
    /// Beliefs that the agent may have by itself, not from a peer.
    own: HashSet<String>,
    /// Ways to choose the sources of the context that is being resolved.
    searched: usize,
    /// Beliefs whose age is asked for, and the numbers of the peers that tell them.
    timed: HashSet<(String, usize)>,
    clock: Option<Clock>,
    /// Offset of each line.
    line_starts: Vec<usize>,
    declarations: Declarations,
    findings: Findings,
    beliefs: Vec<Belief>,
    belief_ids: HashMap<String, BeliefId>,
    handler_ids: HashMap<TriggerKey, HandlerId>,
    handlers: Vec<Handler>,
    /// Handlers of test goals: one for each trigger and combination of queried arguments.
    test_handlers: HashMap<TriggerKey, HashMap<Vec<bool>, HandlerId>>,
    /// Test goals that have plans.
    test_triggers: HashSet<TriggerKey>,
    /// Test goals with too many combinations, for which this was reported.
    crowded: HashSet<String>,
    /// Handlers of test goals whose plans are not resolved yet.
    open_tests: VecDeque<(HandlerId, TriggerKey, Vec<bool>)>,
    /// Handlers with a plan that applies to every event.
    covered: HashSet<HandlerId>,
    /// Number of named waits of each goal or belief.
    waits: HashMap<String, usize>,
}

impl Analysis<'_> {
    fn error(&mut self, diagnostic: Diagnostic) {
        // Consequences of another error are not reported.
        if !diagnostic.message.is_empty() {
            self.findings.agent.push(diagnostic);
        }
    }

    /// Line of a byte of the source, from 1.
    fn line(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|start| *start <= offset)
    }

    fn handler_id(&self, operator: Operator, kind: TriggerKind, name: &str) -> Option<HandlerId> {
        self.handler_ids.get(&(operator, kind, name.to_owned())).copied()
    }

    /// Checks that labels are unique.
    fn labels(&mut self, agent: &Agent) {
        let mut known: HashSet<&str> = HashSet::new();
        for label in agent.plans.iter().filter_map(|plan| plan.label.as_ref()) {
            if !known.insert(&label.text) {
                self.error(
                    Code::DeclaredTwice
                        .at(format!("a second plan `@{}`", label.text), label.span.clone())
                        .help("a label is the name of one plan; requirements may be shared"),
                );
            }
        }
    }

    /// Creates one handler for each trigger with plans, except those of test goals.
    fn collect_triggers(&mut self, agent: &Agent) {
        for plan in &agent.plans {
            let trigger = &plan.trigger;
            if trigger.kind == TriggerKind::Test {
                // Their handlers are created on demand.
                self.test_triggers.insert((
                    trigger.operator,
                    trigger.kind,
                    trigger.atom.name.text.clone(),
                ));
                continue;
            }
            let name = trigger.atom.name.text.clone();
            let Some(mut types) = self.predicate_types(&trigger.atom) else { continue };
            let sourced = self.configuration.is_sourced(trigger.kind, &name);
            types.extend(sourced.then(CType::peer));
            let key = (trigger.operator, trigger.kind, name.clone());
            if self.handler_ids.contains_key(&key) {
                continue;
            }
            self.handler_ids.insert(key, HandlerId(self.handlers.len()));
            self.handlers.push(Handler {
                operator: trigger.operator,
                kind: trigger.kind,
                name,
                types,
                plans: Vec::new(),
                failure: None,
                span: trigger.span.clone(),
                holes: Vec::new(),
                resumed: false,
                sourced,
            });
        }
        for index in 0..self.handlers.len() {
            let handler = &self.handlers[index];
            if (handler.operator, handler.kind) == (Operator::Add, TriggerKind::Achieve) {
                let failure =
                    self.handler_id(Operator::Delete, TriggerKind::Achieve, &handler.name.clone());
                self.handlers[index].failure = failure;
            }
        }
        for plan in &agent.plans {
            let trigger = &plan.trigger;
            let name = &trigger.atom.name.text;
            if (trigger.operator, trigger.kind) == (Operator::Delete, TriggerKind::Achieve)
                && self.handler_id(Operator::Add, TriggerKind::Achieve, name).is_none()
            {
                self.error(
                    Code::MissingPlan
                        .at(
                            format!("`-!{name}` can never run: no plan for `+!{name}`"),
                            trigger.span.clone(),
                        )
                        .help("a failure plan runs when a plan of its goal fails"),
                );
            }
        }
    }

    fn initial_beliefs(&mut self, agent: &Agent) {
        for atom in &agent.beliefs {
            let Some(types) = self.predicate_types(atom) else { continue };
            let values: Option<Vec<Value>> = atom
                .arguments
                .iter()
                .zip(&types)
                .map(|(term, ctype)| match self.initial(term, ctype) {
                    Some(Ok(value)) => Some(value),
                    Some(Err(diagnostic)) => {
                        self.error(diagnostic);
                        None
                    }
                    None => {
                        self.error(
                            Code::NotConstant
                                .at("not a constant", term.span())
                                .help("initial beliefs are numbers, strings and names of peers"),
                        );
                        None
                    }
                })
                .collect();
            let id = self.belief_id(&atom.name.text, &types);
            if self.beliefs[id.0].initial.is_some() {
                self.error(
                    Code::DeclaredTwice
                        .at(
                            format!("a second initial belief `{}`", atom.name.text),
                            atom.span.clone(),
                        )
                        .help("an agent believes at most one instance of a predicate"),
                );
            }
            self.beliefs[id.0].initial = values;
        }
    }

    /// A constant of an initial belief or goal, which may be a peer.
    fn initial(&self, term: &ast::Expression, ctype: &CType) -> Option<Result<Value, Diagnostic>> {
        match term {
            ast::Expression::Atom(atom) if ctype.is_peer() => {
                let peer = self.peer_value(atom);
                peer.filter(|peer| matches!(peer, Value::Constant(..))).map(Ok)
            }
            term => constant(term, ctype),
        }
    }

    fn initial_goal(&mut self, goal: &Atom) -> Option<(HandlerId, Vec<Value>)> {
        let types = self.predicate_types(goal)?;
        let handler = self.goal_handler(goal)?;
        let mut values = Vec::new();
        let sourced = self.handlers[handler.0].sourced;
        for (term, ctype) in goal.arguments.iter().zip(&types) {
            match self.initial(term, ctype) {
                Some(Ok(value)) => values.push(value),
                Some(Err(diagnostic)) => self.error(diagnostic),
                None => {
                    self.error(Code::NotConstant.at("not a constant", term.span()).help(
                        "the initial goal's arguments are numbers, strings and names of peers",
                    ));
                }
            }
        }
        values.extend(sourced.then_some(Value::Me));
        Some((handler, values))
    }

    /// The handler of `+!goal`; reports an error if there is none.
    fn goal_handler(&mut self, goal: &Atom) -> Option<HandlerId> {
        let name = &goal.name.text;
        let handler = self.handler_id(Operator::Add, TriggerKind::Achieve, name);
        if handler.is_none() {
            self.error(
                Code::MissingPlan
                    .at(format!("no plan for `+!{name}`"), goal.span.clone())
                    .label("this goal could never be achieved")
                    .help(format!("add a plan `+!{name} : context <- body.`")),
            );
        }
        handler
    }

    fn settables(&mut self, configuration: &Configuration) {
        for name in &configuration.settables {
            let Some(types) =
                self.declarations.external_predicate(name, &mut self.findings.configuration)
            else {
                continue;
            };
            let id = self.belief_id(&name.text, &types);
            self.beliefs[id.0].settable = true;
        }
        for name in &configuration.perceived {
            let settable = configuration.settables.iter().any(|other| other.text == name.text);
            let handler = self.handler_id(Operator::Add, TriggerKind::Belief, &name.text);
            match handler {
                Some(handler) if settable => {
                    if let Some(id) = self.belief_ids.get(&name.text) {
                        self.beliefs[id.0].perceived = Some(handler);
                    }
                }
                _ => self.findings.configuration.push(if settable {
                    Code::MissingPlan
                        .at(format!("no plan for `+{}`", name.text), name.span.clone())
                        .help("a change would raise an event without a plan")
                } else {
                    Code::NotSettable
                        .at(
                            format!("`{}` is perceived but not settable", name.text),
                            name.span.clone(),
                        )
                        .help("list it in `settables` too")
                }),
            }
        }
    }

    fn external(&mut self, configuration: &Configuration) -> Vec<External> {
        let mut external: Vec<External> = Vec::new();
        let mut known: HashSet<TriggerKey> = HashSet::new();
        for trigger in &configuration.triggerables {
            if let Some(event) = self.external_event(trigger, configuration) {
                if known.insert((event.operator, event.kind, event.name.clone())) {
                    external.push(event);
                } else {
                    self.findings.configuration.push(
                        Code::DeclaredTwice
                            .at("this trigger is listed twice", trigger.span.clone()),
                    );
                }
            }
        }
        for trigger in &configuration.preemptive {
            let listed = configuration.triggerables.iter().any(|other| {
                (other.operator, other.kind, &other.name.text)
                    == (trigger.operator, trigger.kind, &trigger.name.text)
            });
            // A goal or belief of peers.
            let sent = configuration.is_sourced(trigger.kind, &trigger.name.text);
            if !listed && !sent {
                self.findings.configuration.push(
                    Code::NotTriggerable
                        .at("a pre-emptive event must be triggerable", trigger.span.clone())
                        .help(
                            "list it in `triggerables` too, or in `messages` if peers ask for it",
                        ),
                );
            } else if trigger.kind != TriggerKind::Achieve {
                self.findings.configuration.push(
                    Code::NotPreemptive
                        .at("only goals can pre-empt", trigger.span.clone())
                        .help("raise a goal, `+!goal`, instead"),
                );
            } else if !listed
                && self.handler_id(trigger.operator, trigger.kind, &trigger.name.text).is_none()
            {
                self.findings.configuration.push(
                    Code::MissingPlan
                        .at(format!("no plan for `+!{}`", trigger.name.text), trigger.span.clone())
                        .help("what is urgent would be refused"),
                );
            }
        }
        // Pre-emptive events first, in their order of priority.
        let priority = |event: &External| {
            configuration
                .preemptive
                .iter()
                .position(|trigger| trigger.name.text == event.name && event.preemptive)
                .unwrap_or(usize::MAX)
        };
        external.sort_by_key(priority);
        external
    }

    fn external_event(
        &mut self,
        trigger: &ExternalTrigger,
        configuration: &Configuration,
    ) -> Option<External> {
        let types = self
            .declarations
            .external_predicate(&trigger.name, &mut self.findings.configuration)?;
        let name = trigger.name.text.clone();
        let handler = self.handler_id(trigger.operator, trigger.kind, &name);
        let belief = match trigger.kind {
            TriggerKind::Belief => Some(self.belief_id(&name, &types)),
            _ => None,
        };
        if belief.is_none() && handler.is_none() {
            self.findings.configuration.push(
                Code::MissingPlan
                    .at(format!("no plan for `+!{name}`"), trigger.span.clone())
                    .help("the environment could request what the agent cannot do"),
            );
        }
        let preemptive = configuration.preemptive.iter().any(|other| {
            other.name.text == name
                && other.kind == trigger.kind
                && other.operator == trigger.operator
        });
        // An event that deletes a belief has no arguments.
        let types = if trigger.operator == Operator::Delete { Vec::new() } else { types };
        Some(External {
            operator: trigger.operator,
            kind: trigger.kind,
            name,
            types,
            belief,
            handler,
            preemptive,
        })
    }

    /// Beliefs in the comparisons of properties.
    fn compared_beliefs(&mut self, configuration: &Configuration) {
        for property in &configuration.properties {
            let Formula::Within { cause: Cause::Comparison(comparison), .. } = &property.formula
            else {
                continue;
            };
            for name in comparison.beliefs() {
                if self.declarations.is_predicate(&name.text)
                    && !self.belief_ids.contains_key(&name.text)
                {
                    let message = format!("`{}` is never believed", name.text);
                    self.findings.configuration.push(
                        Code::ComparedUnbelieved
                            .at(message, name.span.clone())
                            .help("a comparison of what is not believed never holds"),
                    );
                }
            }
        }
    }

    /// The id of a belief; a predicate becomes a belief on its first use as one.
    fn belief_id(&mut self, name: &str, types: &[CType]) -> BeliefId {
        if let Some(id) = self.belief_ids.get(name) {
            return *id;
        }
        let id = BeliefId(self.beliefs.len());
        self.belief_ids.insert(name.to_owned(), id);
        self.beliefs.push(Belief {
            name: name.to_owned(),
            types: types.to_vec(),
            initial: None,
            settable: false,
            perceived: None,
            asked_at: None,
        });
        id
    }

    /// The declared argument types of a belief or goal, if it is declared with this arity.
    fn predicate_types(&mut self, atom: &Atom) -> Option<Vec<CType>> {
        match self.declarations.predicate(atom) {
            Ok(types) => Some(types),
            Err(diagnostic) => {
                self.error(diagnostic);
                None
            }
        }
    }
}
