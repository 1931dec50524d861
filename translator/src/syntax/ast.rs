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

/// An identifier and where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// The identifier.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// `name(term, ..)`; `name` and `name()` are the same.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Atom {
    /// The predicate, goal or basic action.
    pub name: Name,
    /// Its arguments.
    pub arguments: Vec<Term>,
    /// From the name to the closing parenthesis.
    pub span: Span,
}

/// An argument.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Term {
    /// `X`
    Variable(Name),
    /// `_` or `_name`: matches anything, each occurrence for itself.
    Unnamed(Span),
    /// `-1.5`
    Number(Number),
    /// `"text"`, escapes resolved.
    Text {
        /// The text itself.
        text: String,
        /// From quote to quote.
        span: Span,
    },
    /// `f(X)`: a value-returning basic function.
    Call(Atom),
}

impl Term {
    /// Where the term stands.
    pub fn span(&self) -> Span {
        match self {
            Self::Variable(name) => name.span.clone(),
            Self::Unnamed(span) | Self::Text { span, .. } => span.clone(),
            Self::Number(number) => number.span.clone(),
            Self::Call(atom) => atom.span.clone(),
        }
    }
}

/// A number exactly as written, so that it reaches C with its exact value.
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

/// What a trigger is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TriggerKind {
    /// A belief: `+b`
    Belief,
    /// An achievement goal: `+!g`
    Achieve,
    /// A test goal: `+?b`
    Test,
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
    /// From the operator to the closing parenthesis.
    pub span: Span,
}

/// `trigger : context <- body.`
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// The event it is for.
    pub trigger: Trigger,
    /// The conjunction that must hold; empty for `true`.
    pub context: Vec<Literal>,
    /// The formulae in order; empty for `true`.
    pub body: Vec<Formula>,
    /// The whole plan with its full stop.
    pub span: Span,
}

/// A belief or a boolean basic function in a context.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Literal {
    /// Whether `not` stands before it.
    pub negated: bool,
    /// The belief pattern or the function call.
    pub atom: Atom,
}

/// One step of a plan's body.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Formula {
    /// `a(t)`: a basic action.
    Action(Atom),
    /// `X = f(t)`
    Assign {
        /// The variable that receives the result.
        variable: Name,
        /// The function that is called.
        call: Atom,
    },
    /// `+b(t)`
    Add(Atom),
    /// `-b(t)`
    Delete(Atom),
    /// `!g(t)`
    Achieve(Atom),
    /// `!!g(t)`
    Defer(Atom),
    /// `?b(t)`
    Test(Atom),
}
