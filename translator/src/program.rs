//! The checked program: input of the back ends.
//!
//! Only [`crate::analysis::analyse`] creates a [`Program`]. Therefore names are declared, arities and types
//! fit, each variable is bound before it is used, and no call is recursive. All references are indices.

use std::collections::BTreeSet;

use diagnostic::Span;

use crate::configuration::{Basic, Configuration, ExternalTrigger, Instance, Settings};
use crate::syntax::ast::{Arithmetic, Operator, Relation, TriggerKind};
use crate::types::CType;

/// A checked agent program.
#[derive(Debug)]
pub(crate) struct Program {
    pub(crate) configuration: Configuration,
    /// Form of the C: a proof may need another one than the configuration asks for.
    pub(crate) instance: Instance,
    pub(crate) beliefs: Vec<Belief>,
    /// Beliefs that can become true.
    pub(crate) believable: BTreeSet<BeliefId>,
    /// Reachable handlers, in the order of the source. Unreachable ones are removed, so that a back end
    /// cannot translate dead code.
    pub(crate) handlers: Vec<Handler>,
    /// Number of plans that were removed as unreachable.
    pub(crate) left_out: usize,
    /// Handlers whose events can be the event of the next step: those that a plan posts, and the initial
    /// goal's. At most one is pending.
    pub(crate) posted: Vec<HandlerId>,
    /// Handlers whose events a plan posts as its last action.
    pub(crate) posted_by_plans: Vec<HandlerId>,
    /// Handlers whose goals a plan can post with `!!`: each has one slot.
    pub(crate) deferred: Vec<HandlerId>,
    /// Capacity for goals posted with `!!` among external events, in queue mode: that of the inbox plus one
    /// for each `!!` of the agent.
    pub(crate) deferred_room: usize,
    /// Handlers whose goals a plan gives a deadline.
    pub(crate) limited: Vec<HandlerId>,
    /// The clock function, and the type of its times.
    pub(crate) clock: Option<(BasicId, CType)>,
    /// Events of the environment.
    pub(crate) external: Vec<External>,
    pub(crate) initial_goal: Option<(HandlerId, Vec<Value>)>,
    /// What peers tell.
    pub(crate) told: Vec<Told>,
    /// What peers ask to be achieved.
    pub(crate) asked: Vec<Asked>,
}

/// A belief that one peer tells: it has a slot of its own, in which the newest counts.
#[derive(Debug)]
pub(crate) struct Told {
    /// The name of the message.
    pub(crate) name: String,
    /// The number of the peer.
    pub(crate) sender: usize,
    pub(crate) belief: BeliefId,
    /// Plans of `+b`.
    pub(crate) added: Option<HandlerId>,
    /// Plans of `-b`.
    pub(crate) removed: Option<HandlerId>,
    /// Whether a context asks for its age, so that the time is kept when it is told.
    pub(crate) timed: bool,
}

/// What a peer says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Said {
    /// An index into [`Program::asked`].
    Asked(usize),
    /// An index into [`Program::told`].
    Told(usize),
}

/// A goal that one peer asks for: those that wait are served in their order.
#[derive(Debug)]
pub(crate) struct Asked {
    /// The name of the message.
    pub(crate) name: String,
    /// The number of the peer.
    pub(crate) sender: usize,
    pub(crate) handler: HandlerId,
    /// How many may wait.
    pub(crate) room: usize,
    /// Whether it aborts the pending event.
    pub(crate) preemptive: bool,
}

/// Index into [`Program::handlers`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct HandlerId(pub(crate) usize);

/// Index into [`Program::beliefs`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct BeliefId(pub(crate) usize);

/// Index into [`Plan::variables`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct VariableId(pub(crate) usize);

/// Index into the configuration's basics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct BasicId(pub(crate) usize);

/// A predicate of the belief base, with at most one instance.
#[derive(Debug)]
pub(crate) struct Belief {
    pub(crate) name: String,
    pub(crate) types: Vec<CType>,
    /// Initial values.
    pub(crate) initial: Option<Vec<Value>>,
    pub(crate) settable: bool,
    /// Handler of a change by `set_b`, if it raises an event.
    pub(crate) perceived: Option<HandlerId>,
    /// First context that queries it.
    pub(crate) asked_at: Option<Span>,
}

/// All plans of one trigger.
#[derive(Debug)]
pub(crate) struct Handler {
    pub(crate) operator: Operator,
    pub(crate) kind: TriggerKind,
    pub(crate) name: String,
    pub(crate) types: Vec<CType>,
    pub(crate) plans: Vec<Plan>,
    /// The handler of `-!g` for a handler of `+!g`.
    pub(crate) failure: Option<HandlerId>,
    /// Place of the first trigger in the source.
    pub(crate) span: Span,
    /// For plans of test goals: which arguments are queried rather than given.
    pub(crate) holes: Vec<bool>,
    /// Whether this is the rest of a plan that waits. If the goal has failure plans, its arguments come
    /// first.
    pub(crate) resumed: bool,
    /// Whether the last argument is the peer that caused the event.
    pub(crate) sourced: bool,
}

/// An event of the environment.
#[derive(Debug)]
pub(crate) struct External {
    pub(crate) operator: Operator,
    pub(crate) kind: TriggerKind,
    pub(crate) name: String,
    pub(crate) types: Vec<CType>,
    /// The belief that the event changes.
    pub(crate) belief: Option<BeliefId>,
    /// Its handler; `None` for a mere update of a belief.
    pub(crate) handler: Option<HandlerId>,
    /// Whether it aborts the pending event.
    pub(crate) preemptive: bool,
}

/// One plan.
#[derive(Debug)]
pub(crate) struct Plan {
    /// First and last line in the source.
    pub(crate) lines: (usize, usize),
    /// Its text in the source.
    pub(crate) source: String,
    pub(crate) variables: Vec<Variable>,
    /// One pattern for each argument of the trigger.
    pub(crate) patterns: Vec<Pattern>,
    pub(crate) context: Vec<Condition>,
    pub(crate) body: Vec<Placed>,
    /// For plans of test goals: which variable returns which argument.
    pub(crate) outputs: Vec<(usize, VariableId)>,
    pub(crate) label: Option<String>,
    pub(crate) requirements: Vec<String>,
}

/// A variable of a plan that the generated code needs.
#[derive(Debug)]
pub(crate) struct Variable {
    /// Its name in the agent.
    pub(crate) source: String,
    /// Its name in C, unique within the plan.
    pub(crate) name: String,
    pub(crate) ctype: CType,
    /// Whether its value is used; an unused variable is not generated.
    pub(crate) used: bool,
}

/// Pattern of an argument.
#[derive(Debug)]
pub(crate) enum Pattern {
    /// Any value.
    Any,
    /// Any value, bound to a variable.
    Bind(VariableId),
    /// This value.
    Equal(Value),
}

/// One conjunct of a context.
#[derive(Debug)]
pub(crate) enum Condition {
    /// The belief is held and matches.
    Holds { belief: BeliefId, patterns: Vec<Pattern> },
    /// A value of type bool is true.
    Truth(Value),
    /// A comparison of two values.
    Compare { relation: Relation, left: Value, right: Value, ctype: CType },
    /// Always true; binds the variable.
    Bind { variable: VariableId, value: Value },
    /// The conjunction does not hold.
    Not(Vec<Self>),
    /// One of the conjunctions holds; the first that does is used.
    Any(Alternatives),
}

/// Conjunctions of which one must hold.
#[derive(Debug)]
pub(crate) struct Alternatives {
    pub(crate) branches: Vec<Vec<Condition>>,
    /// Variables that every branch binds: the one visible afterwards, and each branch's own.
    pub(crate) exports: Vec<(VariableId, Vec<VariableId>)>,
}

/// A formula of a body, and its line in the source.
#[derive(Debug)]
pub(crate) struct Placed {
    pub(crate) line: usize,
    pub(crate) span: Span,
    pub(crate) step: Step,
}

/// One formula of a body.
#[derive(Debug)]
pub(crate) enum Step {
    Action(Call),
    Assign {
        variable: VariableId,
        value: Value,
    },
    Add {
        belief: BeliefId,
        values: Vec<Value>,
        raise: Raise,
    },
    Delete {
        belief: BeliefId,
        patterns: Vec<Pattern>,
        raise: Raise,
    },
    /// `!g` now, as a function call.
    Achieve {
        handler: HandlerId,
        values: Vec<Value>,
    },
    /// `!g` as the event of the next step.
    Post {
        handler: HandlerId,
        values: Vec<Value>,
        /// The time by which the goal must be achieved.
        deadline: Option<Value>,
    },
    /// `!!g`
    Defer {
        handler: HandlerId,
        values: Vec<Value>,
    },
    /// `.broadcast`: the action for each peer but oneself, which is its first argument.
    Broadcast {
        basic: BasicId,
        /// The arguments behind the peer.
        values: Vec<Value>,
        /// The number of other peers.
        receivers: usize,
    },
    /// `?b`: asks the beliefs, then the plans.
    Ask {
        belief: BeliefId,
        patterns: Vec<Pattern>,
        plans: Option<HandlerId>,
    },
}

/// Consequence of a change of a belief.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Raise {
    Nothing,
    /// The percept's plans now, as a function call.
    Call(HandlerId),
    /// The percept's plans as the event of the next step.
    Post(HandlerId),
}

/// A value of known type.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Variable(VariableId),
    /// A C constant.
    Constant(String, CType),
    /// The peer that the agent is.
    Me,
    /// The time when a peer told a belief.
    ToldAt(BeliefId),
    Call(Call),
    /// Sign change of a floating-point value; for integers it is a subtraction.
    Negate(Box<Self>),
    Arithmetic(Box<Operation>),
}

/// An arithmetic operation on two values of one type.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Operation {
    pub(crate) operator: Arithmetic,
    pub(crate) left: Value,
    pub(crate) right: Value,
    pub(crate) ctype: CType,
}

impl Operation {
    /// Whether the operation has no result for some operands: integer overflow, or division by zero. Without
    /// a result it fails.
    pub(crate) fn can_fail(&self) -> bool {
        !self.ctype.is_float() || self.operator == Arithmetic::Divide
    }
}

impl Handler {
    /// The trigger in AgentSpeak; `+!g_wait1` for the rest of a plan that waits.
    pub(crate) fn text(&self) -> String {
        trigger_text(self.operator, self.kind, &self.name)
    }
}

impl Plan {
    /// The steps of the body, in order.
    pub(crate) fn steps(&self) -> impl Iterator<Item = &Step> {
        self.body.iter().map(|placed| &placed.step)
    }

    /// The calls that evaluating the context can make, in order.
    pub(crate) fn context_calls(&self) -> Vec<ContextCall> {
        let (mut effects, mut calls) = (Vec::new(), Vec::new());
        pattern_effects(&self.patterns, &mut effects);
        push_calls(&effects, true, &mut calls);
        self.context.iter().for_each(|condition| condition.calls(true, &mut calls));
        calls
    }

    /// Whether the plan applies to every event of its trigger.
    pub(crate) fn always_applies(&self) -> bool {
        self.context.is_empty()
            && !self.patterns.iter().any(|pattern| matches!(pattern, Pattern::Equal(_)))
    }
}

impl Value {
    /// Whether evaluating it can fail.
    pub(crate) fn can_fail(&self) -> bool {
        match self {
            Self::Variable(_) | Self::Constant(..) | Self::Me | Self::ToldAt(_) => false,
            Self::Call(call) => call.arguments.iter().any(Self::can_fail),
            Self::Negate(operand) => operand.can_fail(),
            Self::Arithmetic(operation) => {
                operation.can_fail() || operation.left.can_fail() || operation.right.can_fail()
            }
        }
    }
}

/// Effect of evaluating values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effect {
    /// A basic action or function is called.
    Call(BasicId),
    /// There may be no result; then the following effects do not happen.
    MayFail,
}

impl Value {
    /// Effects of the evaluation, in order.
    fn effects(&self, effects: &mut Vec<Effect>) {
        match self {
            Self::Variable(_) | Self::Constant(..) | Self::Me | Self::ToldAt(_) => {}
            Self::Call(call) => call.effects(effects),
            Self::Negate(operand) => operand.effects(effects),
            Self::Arithmetic(operation) => {
                operation.left.effects(effects);
                operation.right.effects(effects);
                if operation.can_fail() {
                    effects.push(Effect::MayFail);
                }
            }
        }
    }
}

impl Call {
    fn effects(&self, effects: &mut Vec<Effect>) {
        self.arguments.iter().for_each(|argument| argument.effects(effects));
        effects.push(Effect::Call(self.basic));
    }
}

fn pattern_effects(patterns: &[Pattern], effects: &mut Vec<Effect>) {
    for pattern in patterns {
        if let Pattern::Equal(value) = pattern {
            value.effects(effects);
        }
    }
}

/// A call that evaluating a context may make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ContextCall {
    pub(crate) basic: BasicId,
    /// Whether it is always made when the plan applies.
    pub(crate) certain: bool,
}

impl Condition {
    fn calls(&self, certain: bool, calls: &mut Vec<ContextCall>) {
        let mut effects = Vec::new();
        match self {
            Self::Holds { patterns, .. } => pattern_effects(patterns, &mut effects),
            Self::Truth(value) | Self::Bind { value, .. } => value.effects(&mut effects),
            Self::Compare { left, right, .. } => {
                left.effects(&mut effects);
                right.effects(&mut effects);
            }
            Self::Not(inner) => inner.iter().for_each(|condition| condition.calls(false, calls)),
            Self::Any(alternatives) => {
                let conditions = alternatives.branches.iter().flatten();
                conditions.for_each(|condition| condition.calls(false, calls));
            }
        }
        push_calls(&effects, certain, calls);
    }
}

fn push_calls(effects: &[Effect], certain: bool, calls: &mut Vec<ContextCall>) {
    calls.extend(effects.iter().filter_map(|effect| match effect {
        Effect::Call(basic) => Some(ContextCall { basic: *basic, certain }),
        Effect::MayFail => None,
    }));
}

impl Step {
    /// Effects of evaluating its values, in order, before its own effect; an action is a value too.
    pub(crate) fn effects(&self) -> Vec<Effect> {
        let mut effects = Vec::new();
        match self {
            Self::Action(call) => call.effects(&mut effects),
            Self::Assign { value, .. } => value.effects(&mut effects),
            Self::Broadcast { basic, values, receivers } => {
                for value in values {
                    value.effects(&mut effects);
                }
                effects.extend(std::iter::repeat_n(Effect::Call(*basic), *receivers));
            }
            Self::Add { values, .. }
            | Self::Achieve { values, .. }
            | Self::Defer { values, .. } => {
                for value in values {
                    value.effects(&mut effects);
                }
            }
            Self::Post { values, deadline, .. } => {
                values.iter().chain(deadline).for_each(|value| value.effects(&mut effects));
            }
            Self::Ask { patterns, .. } | Self::Delete { patterns, .. } => {
                pattern_effects(patterns, &mut effects);
            }
        }
        effects
    }

    /// Whether the body can end here, before the following formulas.
    pub(crate) fn can_fail(&self) -> bool {
        let calls = match self {
            Self::Achieve { .. } | Self::Ask { .. } => true,
            Self::Add { raise, .. } | Self::Delete { raise, .. } => {
                matches!(raise, Raise::Call(_))
            }
            _ => false,
        };
        calls || self.values_can_fail()
    }

    /// Whether a value in it may have no result; then it has no effect.
    pub(crate) fn values_can_fail(&self) -> bool {
        let values_fail = |values: &[Value]| values.iter().any(Value::can_fail);
        match self {
            Self::Achieve { values, .. }
            | Self::Add { values, .. }
            | Self::Broadcast { values, .. }
            | Self::Defer { values, .. } => values_fail(values),
            Self::Action(call) => values_fail(&call.arguments),
            Self::Assign { value, .. } => value.can_fail(),
            Self::Ask { patterns, .. } | Self::Delete { patterns, .. } => {
                patterns.iter().any(Pattern::can_fail)
            }
            Self::Post { values, deadline, .. } => {
                values_fail(values) || deadline.as_ref().is_some_and(Value::can_fail)
            }
        }
    }
}

impl Pattern {
    /// Whether evaluating it can fail.
    pub(crate) fn can_fail(&self) -> bool {
        matches!(self, Self::Equal(value) if value.can_fail())
    }
}

/// A call of a basic action or function.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Call {
    pub(crate) basic: BasicId,
    pub(crate) arguments: Vec<Value>,
}

/// Maximum number of `!!` that add capacity to the queue.
const MOST_DEFERRED: usize = 64;

/// The capacity of [`Program::deferred_room`], for an agent with this number of `!!`.
pub(crate) fn deferred_room(settings: &Settings, formulae: usize) -> usize {
    settings.inbox as usize + formulae.min(MOST_DEFERRED)
}

impl Program {
    /// Beliefs that the environment can set.
    pub(crate) fn settable(&self) -> impl Iterator<Item = &Belief> {
        self.beliefs.iter().filter(|belief| belief.settable)
    }

    /// The number of an event that the environment can raise, and the event.
    pub(crate) fn raised(&self, event: &ExternalTrigger) -> Option<(usize, &External)> {
        self.external.iter().enumerate().find(|(_, external)| {
            event.source.is_none()
                && (external.operator, external.kind, &external.name)
                    == (event.operator, event.kind, &event.name.text)
        })
    }

    /// What a peer says to cause this event of a property.
    pub(crate) fn said(&self, event: &ExternalTrigger) -> Option<Said> {
        let sender = self.configuration.peer(&event.source.as_ref()?.text)?;
        let (name, is_goal) = (&event.name.text, event.kind == TriggerKind::Achieve);
        let asked = self.asked.iter();
        let mut asked = asked.map(|asked| is_goal && (asked.sender, &asked.name) == (sender, name));
        let told = self.told.iter();
        let mut told = told.map(|told| !is_goal && (told.sender, &told.name) == (sender, name));
        let asked = asked.position(|is_it| is_it).map(Said::Asked);
        asked.or_else(|| told.position(|is_it| is_it).map(Said::Told))
    }

    /// Goals that pre-empt if a peer asks for them, by priority.
    pub(crate) fn urgent(&self) -> impl Iterator<Item = &str> {
        let names = self.configuration.preemptive.iter().map(|trigger| trigger.name.text.as_str());
        names.filter(|name| self.asked.iter().any(|asked| asked.preemptive && asked.name == *name))
    }

    /// Whether anything aborts the pending event.
    pub(crate) fn has_preemptive(&self) -> bool {
        self.external.iter().any(|external| external.preemptive) || self.urgent().next().is_some()
    }

    /// The clock, and the type of its times, if the time is kept when a peer tells this belief.
    pub(crate) fn timing(&self, told: &Told) -> Option<&(BasicId, CType)> {
        self.clock.as_ref().filter(|_| told.timed)
    }

    /// The constant of a peer in C.
    pub(crate) fn peer(&self, number: usize) -> String {
        peer_constant(&self.configuration.peers[number].text)
    }

    /// Whether the agent is one of several that talk.
    pub(crate) fn has_peers(&self) -> bool {
        !self.configuration.peers.is_empty()
    }

    pub(crate) fn belief(&self, id: BeliefId) -> &Belief {
        &self.beliefs[id.0]
    }

    /// The value of a belief that has it from the start and never changes.
    pub(crate) fn fixed(&self, id: BeliefId) -> Option<&Value> {
        let belief = self.belief(id);
        let [value] = belief.initial.as_deref()? else { return None };
        let adds = |step: &Step| matches!(step, Step::Add { belief: other, .. } if *other == id);
        let changes = belief.settable
            || self.external.iter().any(|external| external.belief == Some(id))
            || self.plans().any(|(_, _, plan)| plan.steps().any(adds));
        (!changes).then_some(value)
    }

    /// Whether a belief can become true.
    pub(crate) fn is_believable(&self, id: BeliefId) -> bool {
        self.believable.contains(&id)
    }

    /// Whether a plan or the environment can delete a belief.
    pub(crate) fn is_deleted(&self, belief: &Belief) -> bool {
        let deletes = |step: &Step| matches!(step, Step::Delete { belief: other, .. } if std::ptr::eq(self.belief(*other), belief));
        let takes_back = |external: &External| {
            (external.operator, external.kind) == (Operator::Delete, TriggerKind::Belief)
                && external.name == belief.name
        };
        self.external.iter().any(takes_back)
            || self.told.iter().any(|told| std::ptr::eq(self.belief(told.belief), belief))
            || self.plans().any(|(_, _, plan)| plan.steps().any(deletes))
    }

    pub(crate) fn handler(&self, id: HandlerId) -> &Handler {
        &self.handlers[id.0]
    }

    /// The handlers with their ids.
    pub(crate) fn handlers(&self) -> impl Iterator<Item = (HandlerId, &Handler)> {
        self.handlers.iter().enumerate().map(|(index, handler)| (HandlerId(index), handler))
    }

    /// The plans with their handlers, numbered from 0 in each.
    pub(crate) fn plans(&self) -> impl Iterator<Item = (HandlerId, usize, &Plan)> {
        self.handlers().flat_map(|(id, handler)| {
            handler.plans.iter().enumerate().map(move |(number, plan)| (id, number, plan))
        })
    }

    pub(crate) fn basic(&self, id: BasicId) -> &Basic {
        &self.configuration.basics[id.0]
    }

    /// The trace function, which is called with each chosen plan.
    pub(crate) fn trace(&self) -> Option<BasicId> {
        let name = self.configuration.settings.trace.as_ref()?;
        let mut basics = self.configuration.basics.iter();
        basics.position(|basic| basic.name.text == name.text).map(BasicId)
    }

    /// The clock, if every step has to check a deadline.
    pub(crate) fn deadline_clock(&self) -> Option<BasicId> {
        self.clock.as_ref().filter(|_| !self.limited.is_empty()).map(|(basic, _)| *basic)
    }

    /// Functions called in bodies, not only in contexts.
    pub(crate) fn called_in_bodies(&self) -> BTreeSet<BasicId> {
        let steps = self.plans().flat_map(|(_, _, plan)| plan.steps());
        let effects = steps.flat_map(Step::effects);
        effects
            .filter_map(|effect| match effect {
                Effect::Call(basic) => Some(basic),
                Effect::MayFail => None,
            })
            .collect()
    }
}

/// `PEER_LEADER`
pub(crate) fn peer_constant(name: &str) -> String {
    format!("PEER_{}", name.to_ascii_uppercase())
}

/// `achieve_goto`, `add_battery`: a trigger in generated names.
pub(crate) fn trigger_name(operator: Operator, kind: TriggerKind, name: &str) -> String {
    let verb = match (operator, kind) {
        (Operator::Add, TriggerKind::Achieve) => "achieve",
        (Operator::Delete, TriggerKind::Achieve) => "fail",
        (Operator::Add, TriggerKind::Belief) => "add",
        (Operator::Delete, TriggerKind::Belief) => "del",
        (Operator::Add, TriggerKind::Test) => "test",
        (Operator::Delete, TriggerKind::Test) => "untest",
    };
    format!("{verb}_{name}")
}

/// `+!goto`, `-battery`: a trigger in AgentSpeak.
pub(crate) fn trigger_text(operator: Operator, kind: TriggerKind, name: &str) -> String {
    let operator = match operator {
        Operator::Add => "+",
        Operator::Delete => "-",
    };
    let kind = match kind {
        TriggerKind::Belief => "",
        TriggerKind::Achieve => "!",
        TriggerKind::Test => "?",
    };
    format!("{operator}{kind}{name}")
}
