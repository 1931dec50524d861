//! The C of the language, as a tree.

use crate::lexer::Place;

/// A name or another word, and where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Word {
    pub(crate) text: String,
    pub(crate) place: Place,
}

/// A type as it is written: `const char *const`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Type {
    /// Without `const`.
    pub(crate) words: Vec<String>,
    /// Whether the words have `const`.
    pub(crate) constant: bool,
    /// For each `*`, whether `const` stands behind it.
    pub(crate) stars: Vec<bool>,
    pub(crate) place: Place,
}

/// Operators with one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Prefix {
    Not,
    Minus,
    Address,
    Content,
}

/// An expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Expression {
    pub(crate) what: What,
    pub(crate) place: Place,
    /// How many expressions are inside each other.
    pub(crate) depth: u16,
}

/// Kinds of expressions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum What {
    Name(String),
    Integer(String),
    /// In its shortest form.
    Float(String),
    Text(String),
    Prefix(Prefix, Box<Expression>),
    Binary(&'static str, Box<Expression>, Box<Expression>),
    Parentheses(Box<Expression>),
    Cast(Type, Box<Expression>),
    Call(Word, Vec<Expression>),
    Field(Box<Expression>, String),
    Arrow(Box<Expression>, String),
    Index(Box<Expression>, Box<Expression>),
    /// `{ 0 }`, only as an initial value.
    Braces(Vec<Expression>),
}

/// A declaration of an object.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Object {
    pub(crate) outlives: bool,
    pub(crate) ctype: Type,
    pub(crate) name: Word,
    pub(crate) length: Option<Word>,
    pub(crate) initial: Option<Expression>,
}

/// Statements in braces.
pub(crate) type Block = Vec<Statement>;

/// A statement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Statement {
    Block(Block),
    Object(Object),
    /// `place = value;`, also with `+=` and `-=`.
    Assign(Expression, &'static str, Expression),
    /// `place++;`, `place--;`
    Count(Expression, &'static str),
    /// A call, or a value that is thrown away.
    Value(Expression),
    If(Vec<(Expression, Block)>, Option<Block>),
    For(Box<For>),
    Switch(Expression, Vec<Group>),
    Return(Place, Option<Expression>),
}

/// `for (uint32_t i = 0U; i < 3U; i++)`
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct For {
    pub(crate) counter: Object,
    pub(crate) condition: Expression,
    pub(crate) step: Word,
    pub(crate) body: Block,
}

/// Labels of a `switch`, and what is done for them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Group {
    /// `None` for `default`.
    pub(crate) labels: Vec<(Place, Option<Expression>)>,
    pub(crate) body: Block,
    /// Whether it ends with `break` and not with `return`.
    pub(crate) breaks: bool,
}

/// A parameter; its name may be missing in a header.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Parameter {
    pub(crate) ctype: Type,
    pub(crate) name: Option<Word>,
}

/// A function, or its declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Function {
    pub(crate) is_static: bool,
    pub(crate) result: Type,
    pub(crate) name: Word,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) body: Option<Block>,
}

/// A `typedef`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Definition {
    Enum(Vec<Word>),
    /// Fields with their lengths.
    Struct(Vec<(Type, Word, Option<Word>)>),
}

/// What stands outside of functions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Item {
    Definition(Word, Definition),
    Object(Object),
    Function(Function),
}

/// A file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Unit {
    /// Preprocessor lines.
    pub(crate) lines: Vec<Word>,
    pub(crate) items: Vec<Item>,
    pub(crate) end: Place,
}
