//! The syntax tree: Table 1 of the paper, with the span of everything.

use diagnostic::Span;

/// A whole agent program.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Agent {
    /// Initial beliefs, `b(1).`
    pub beliefs: Vec<Atom>,
    /// The initial goal, `!g.`
    pub goal: Option<Atom>,
    /// Plans in the order of the source.
    pub plans: Vec<Plan>,
}

/// An identifier with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// The identifier.
    pub text: String,
    /// Its place.
    pub span: Span,
}

/// `name(expression, ..)`; `name` and `name()` are the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Atom {
    /// The predicate, goal or basic action.
    pub name: Name,
    /// Its arguments.
    pub arguments: Vec<Expression>,
    /// Who told the belief or asked for the goal: `[source(P)]`.
    pub source: Option<Box<Expression>>,
    /// How long ago a peer told the belief: `[age(A)]`.
    pub age: Option<Box<Expression>>,
    /// From the name to the closing parenthesis, or bracket.
    pub span: Span,
}

impl Atom {
    /// Visits every variable in it.
    pub(crate) fn for_each_variable<'a>(&'a self, visit: &mut impl FnMut(&'a Name)) {
        self.arguments.iter().for_each(|argument| argument.for_each_variable(visit));
        let annotations = self.source.iter().chain(&self.age);
        annotations.for_each(|annotation| annotation.for_each_variable(visit));
    }
}

/// An argument, or a part of a context.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Expression {
    /// `X`
    Variable(Name),
    /// `_` or `_name`: matches anything, each occurrence for itself.
    Unnamed(Span),
    /// `-1.5`
    Number(Number),
    /// `true`, `false`
    Boolean {
        /// Its value.
        value: bool,
        /// Its place.
        span: Span,
    },
    /// `"text"`, escapes resolved.
    Text {
        /// The text itself.
        text: String,
        /// From quote to quote.
        span: Span,
    },
    /// `f(X)`: a basic function, in a context a belief; without arguments also a peer.
    Atom(Atom),
    /// `-X`
    Negate {
        /// What is negated.
        operand: Box<Self>,
        /// Sign and operand.
        span: Span,
    },
    /// `X + 1`
    Arithmetic {
        /// The operation.
        operator: Arithmetic,
        /// Left operand.
        left: Box<Self>,
        /// Right operand.
        right: Box<Self>,
        /// Both operands.
        span: Span,
    },
    /// `X < 3`
    Compare {
        /// The relation.
        operator: Relation,
        /// Left operand.
        left: Box<Self>,
        /// Right operand.
        right: Box<Self>,
        /// Both operands.
        span: Span,
    },
    /// `X = f(Y)` in a context: binds a new variable.
    Bind {
        /// The variable that receives the value.
        variable: Name,
        /// The value.
        value: Box<Self>,
        /// The whole binding.
        span: Span,
    },
    /// `.my_name(M)` in a context: which of the peers the agent is.
    MyName {
        /// A new variable, or the peer that it must be.
        name: Box<Self>,
        /// From the full stop to the closing parenthesis.
        span: Span,
    },
    /// `not b`
    Not {
        /// The negated condition.
        operand: Box<Self>,
        /// `not` and operand.
        span: Span,
    },
    /// `a & b & c`
    And(Vec<Self>),
    /// `a | b | c`
    Or(Vec<Self>),
}

impl Expression {
    /// Place of the expression.
    pub fn span(&self) -> Span {
        match self {
            Self::Variable(name) => name.span.clone(),
            Self::Number(number) => number.span.clone(),
            Self::Atom(atom) => atom.span.clone(),
            Self::Unnamed(span)
            | Self::Boolean { span, .. }
            | Self::Text { span, .. }
            | Self::Negate { span, .. }
            | Self::Arithmetic { span, .. }
            | Self::Compare { span, .. }
            | Self::Bind { span, .. }
            | Self::MyName { span, .. }
            | Self::Not { span, .. } => span.clone(),
            Self::And(parts) | Self::Or(parts) => {
                let start = parts.first().map_or(0, |part| part.span().start);
                let end = parts.last().map_or(start, |part| part.span().end);
                start..end
            }
        }
    }
}

impl Expression {
    /// Visits every variable in the expression; its depth is bounded by the parser.
    pub(crate) fn for_each_variable<'a>(&'a self, visit: &mut impl FnMut(&'a Name)) {
        match self {
            Self::Variable(name) => visit(name),
            Self::Atom(atom) => atom.for_each_variable(visit),
            Self::Negate { operand, .. }
            | Self::Not { operand, .. }
            | Self::MyName { name: operand, .. } => {
                operand.for_each_variable(visit);
            }
            Self::Arithmetic { left, right, .. } | Self::Compare { left, right, .. } => {
                left.for_each_variable(visit);
                right.for_each_variable(visit);
            }
            Self::Bind { variable, value, .. } => {
                visit(variable);
                value.for_each_variable(visit);
            }
            Self::And(parts) | Self::Or(parts) => {
                for part in parts {
                    part.for_each_variable(visit);
                }
            }
            Self::Unnamed(_) | Self::Number(_) | Self::Boolean { .. } | Self::Text { .. } => {}
        }
    }
}

impl Expression {
    /// Visits every variable that `=` binds in a condition.
    pub(crate) fn for_each_assigned<'a>(&'a self, visit: &mut impl FnMut(&'a Name)) {
        match self {
            Self::Bind { variable, .. } => visit(variable),
            Self::Not { operand, .. } => operand.for_each_assigned(visit),
            Self::And(parts) | Self::Or(parts) => {
                for part in parts {
                    part.for_each_assigned(visit);
                }
            }
            _ => {}
        }
    }
}

/// An arithmetic operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arithmetic {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`, truncating for integers.
    Divide,
    /// `mod`, the remainder of the truncating division; integers only.
    Remainder,
}

/// A relation between two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// `==`
    Equal,
    /// `\==`
    NotEqual,
}

/// Relations of other languages, with those that are meant.
pub(crate) const FOREIGN_RELATIONS: [(&str, &str); 5] =
    [("!=", "\\=="), ("<>", "\\=="), ("=<", "<="), ("=>", ">="), ("=/=", "\\==")];

/// A number as written, so that its exact value reaches C.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Number {
    /// Digits, optional fraction and exponent, without sign.
    pub digits: String,
    /// Whether a minus sign stands directly before it.
    pub negative: bool,
    /// Sign and digits.
    pub span: Span,
}

/// `+` or `-` of a trigger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Delete,
}

/// Kind of a trigger.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TriggerKind {
    /// A belief: `+b`
    Belief,
    /// An achievement goal: `+!g`
    Achieve,
    /// A test goal: `+?b`
    Test,
}

/// What a message does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Performative {
    /// The receiver believes it.
    Tell,
    /// The receiver believes it no more.
    Untell,
    /// The receiver has to achieve it.
    Achieve,
    /// The receiver need not achieve it any more.
    Unachieve,
}

impl Performative {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Tell, Self::Untell, Self::Achieve, Self::Unachieve];

    /// Its name in agents and in C.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tell => "tell",
            Self::Untell => "untell",
            Self::Achieve => "achieve",
            Self::Unachieve => "unachieve",
        }
    }

    /// What it takes back, or itself: what a configuration declares.
    #[must_use]
    pub fn declared(self) -> Self {
        match self {
            Self::Tell | Self::Untell => Self::Tell,
            Self::Achieve | Self::Unachieve => Self::Achieve,
        }
    }

    /// Whether the message has arguments; one that takes something back has none.
    pub fn has_arguments(self) -> bool {
        self == self.declared()
    }
}

/// The head of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trigger {
    /// `+` or `-`
    pub operator: Operator,
    /// Belief, achievement or test goal.
    pub kind: TriggerKind,
    /// Name and argument patterns.
    pub atom: Atom,
    /// From the operator to the closing parenthesis, or bracket.
    pub span: Span,
}

/// `@label[req("tag")] trigger : context <- body.`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// The plan's name, if it has one.
    pub label: Option<Name>,
    /// Tags of the requirements that it implements.
    pub requirements: Vec<String>,
    /// The triggering event.
    pub trigger: Trigger,
    /// The context; `None` for `true`.
    pub context: Option<Expression>,
    /// The formulas in order; empty for `true`.
    pub body: Vec<Formula>,
    /// The whole plan with its full stop.
    pub span: Span,
}

/// One step of a plan's body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Formula {
    /// `a(t)`: a basic action.
    Action(Atom),
    /// `X = f(t)`
    Assign {
        /// The variable that receives the value.
        variable: Name,
        /// The value.
        value: Expression,
    },
    /// `+b(t)`
    Add(Atom),
    /// `-b(t)`
    Delete(Atom),
    /// `!g(t)`, `!g(t)[deadline(ms)]`
    Achieve {
        /// The goal.
        goal: Atom,
        /// Time limit in milliseconds.
        deadline: Option<Expression>,
    },
    /// `!!g(t)`
    Defer(Atom),
    /// `?b(t)`
    Test(Atom),
    /// `.wait(ms)`
    Wait {
        /// Duration in milliseconds.
        duration: Expression,
        /// From the full stop to the closing parenthesis.
        span: Span,
    },
    /// `.my_name(M)`
    MyName {
        /// The variable that receives the agent's own peer.
        variable: Name,
        /// From the full stop to the closing parenthesis.
        span: Span,
    },
    /// `.send(peer, tell, b(t))`, `.broadcast(tell, b(t))`
    Send {
        /// The receiver; `None` for all other peers.
        to: Option<Expression>,
        /// What the message does.
        performative: Performative,
        /// What it is about.
        content: Atom,
        /// From the full stop to the closing parenthesis.
        span: Span,
    },
}

impl Formula {
    /// Place of the formula, without a leading `+`, `-`, `!` or `?`.
    pub(crate) fn span(&self) -> Span {
        match self {
            Self::Action(atom)
            | Self::Add(atom)
            | Self::Delete(atom)
            | Self::Defer(atom)
            | Self::Test(atom) => atom.span.clone(),
            Self::Assign { variable, value } => variable.span.start..value.span().end,
            Self::Achieve { goal, .. } => goal.span.clone(),
            Self::Wait { span, .. } | Self::MyName { span, .. } | Self::Send { span, .. } => {
                span.clone()
            }
        }
    }

    /// Visits every variable in the formula.
    pub(crate) fn for_each_variable<'a>(&'a self, visit: &mut impl FnMut(&'a Name)) {
        match self {
            Self::Action(atom)
            | Self::Add(atom)
            | Self::Delete(atom)
            | Self::Defer(atom)
            | Self::Test(atom) => atom.for_each_variable(visit),
            Self::Assign { variable, value } => {
                visit(variable);
                value.for_each_variable(visit);
            }
            Self::MyName { variable, .. } => visit(variable),
            Self::Send { to, content, .. } => {
                if let Some(to) = to {
                    to.for_each_variable(visit);
                }
                content.for_each_variable(visit);
            }
            Self::Achieve { goal, deadline } => {
                goal.arguments.iter().chain(deadline).for_each(|a| a.for_each_variable(visit));
            }
            Self::Wait { duration, .. } => duration.for_each_variable(visit),
        }
    }
}
