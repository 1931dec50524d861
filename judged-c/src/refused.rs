//! Why C is not judged.

/// A place in C that is not of the language, and why.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}, column {column}: `{found}` cannot be judged: {rule}")]
#[non_exhaustive]
pub struct Refused {
    /// The line, counted from 1.
    pub line: u32,
    /// The column in characters, counted from 1.
    pub column: u32,
    /// The word or sign.
    pub found: String,
    /// The rule that it breaks.
    pub rule: Rule,
}

/// A rule of the language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, thiserror::Error)]
#[non_exhaustive]
pub enum Rule {
    /// Characters outside of comments.
    #[error("only printable ASCII characters, tabs and line ends may stand here")]
    Character,
    /// A sign that is not of the language.
    #[error("this sign is not of the C that is generated; {0}")]
    Sign(&'static str),
    /// `\r`
    #[error("lines end with CR and LF; convert the file, with `dos2unix` for example")]
    LineEnd,
    /// `??`
    #[error("two question marks can begin another character, also in comments; write one")]
    Trigraph,
    /// `<%`
    #[error(
        "it is another spelling of a bracket or `#`; write a blank between the two characters, or the bracket"
    )]
    Digraph,
    /// `/* /*`, `\` in a comment.
    #[error("it could hide what is compiled: no `\\` and no begin of another comment in a comment")]
    Comment,
    /// `/*` without an end.
    #[error("it never ends")]
    Open,
    /// Preprocessor lines.
    #[error(
        "the preprocessor could change what is compared: only the generated lines, at the begin; write a constant as \
             `static const int32_t limit = 3;`"
    )]
    Preprocessor,
    /// The generated preprocessor lines are not all there.
    #[error("the generated `#include` lines must stand at the begin, in their order")]
    Includes,
    /// `\x41`
    #[error(
        "in a text only \\\" \\\\ \\n \\t \\? and three octal digits are known, behind which no digit stands (5 is \\065)"
    )]
    Escape,
    /// `0x1F`, `1l`, `010`.
    #[error(
        "numbers are decimal (16 for 0x10), in range, and without a suffix, with U, LL or ULL, or with F behind a fraction"
    )]
    Number,
    /// A word or sign where another one should be.
    #[error("it is not of the C that is generated; {0}")]
    Expected(&'static str),
    /// Too many parentheses or blocks inside each other.
    #[error("it is nested too deeply; name a part of it")]
    Depth,
    /// `long`, `union x`.
    #[error(
        "it is no type of the agent's headers, nor bool, float, double, or an integer of a fixed width"
    )]
    Type,
    /// A `typedef` that is not generated, or was changed.
    #[error("types must be the generated ones, unchanged")]
    Typedef,
    /// A generated type is not there.
    #[error("the generated types must all be there")]
    Types,
    /// The agent's state is not declared.
    #[error("the agent's state must be declared as it was generated")]
    State,
    /// An array outside of a `static` declaration, or whose length is not a number from 1 to 1024.
    #[error("only static objects can be arrays, with a number as length")]
    Array,
    /// A pointer that is a local or static variable, or a result.
    #[error("pointers can only be parameters of static functions")]
    Pointer,
    /// No initial value.
    #[error("its initial value must be given")]
    Initial,
    /// A static object's initial value that is no constant.
    #[error("the initial value of a static object must be a constant")]
    Constant,
    /// A name that was not declared.
    #[error("it is not declared here or in the generated headers")]
    Undeclared,
    /// A name that means something else here.
    #[error("it is declared more than once, or hides another declaration; rename it")]
    Declared,
    /// A name of C, its library or a compiler.
    #[error("such names belong to C, its library or the compiler; rename it")]
    Reserved,
    /// A name of the comparison.
    #[error("such names belong to the comparison; rename it")]
    Comparison,
    /// A macro has the name.
    #[error("an included header defines a macro of this name, or could; rename it")]
    Macro,
    /// A function that is neither `static` nor of the interface, or one of the interface that is `static` or without a body.
    #[error("functions must be static, unless the generated header declares them")]
    Static,
    /// An interface function with another signature.
    #[error(
        "its result and parameters must be those of the generated header or of its first declaration"
    )]
    Signature,
    /// A function is declared, but not defined.
    #[error("it is declared, but not defined here")]
    Undefined,
    /// A function of the interface is missing.
    #[error("the interface needs this function, which is not defined here")]
    Missing,
    /// A function that calls itself.
    #[error("it calls itself, directly or through others")]
    Recursion,
    /// A chain of more than 200 calls inside each other.
    #[error("it is the begin of a chain of more than 200 calls inside each other")]
    Calls,
    /// A function without a result at some end.
    #[error("some way through it ends without `return`, or goes on behind it")]
    Return,
    /// The number of arguments.
    #[error("it needs another number of arguments")]
    Arguments,
    /// A value of another type.
    #[error("the types do not fit without a conversion that could change the value")]
    Mismatch,
    /// A cast other than between integers, or to `void`.
    #[error("only integers can be cast, to integers, and anything to void")]
    Cast,
    /// Something without this operation.
    #[error("this operation is not defined for its type")]
    Operation,
    /// A comparison of what has no defined equality.
    #[error(
        "whether such values are equal is left to the compiler, or not exact; only integers, truth values and \
             events are compared with == and !="
    )]
    Equality,
    /// `&x` elsewhere than as the argument of a static function.
    #[error(
        "an address can only be passed to a static function that stores a result or reads a value there"
    )]
    Address,
    /// Something constant is written.
    #[error("it is constant, a parameter, or counts a loop: it cannot be changed")]
    Written,
    /// An assignment to something that is no variable.
    #[error("it is no place that can be changed")]
    Place,
    /// An effect whose order C does not define.
    #[error(
        "the call can change what is read beside it, and C does not define which is first; keep its result in a \
             constant before"
    )]
    Order,
    /// A value that is not used.
    #[error("its value is not used; write `(void)` before it")]
    Unused,
    /// A loop without a known bound.
    #[error(
        "loops are `for (uint32_t i = 0U; i < 3U; i++)`, also with `&&` and another condition, not `while`"
    )]
    Loop,
    /// A `case` that falls through, or is not constant.
    #[error(
        "each case ends with break or return, is a constant of the value's type, stands once, and declares nothing \
             outside of a block"
    )]
    Case,
    /// Code that is never reached.
    #[error("it is never reached")]
    Unreachable,
    /// Preprocessor lines of a header.
    #[error(
        "in a header of the agent's own, only a guard against double inclusion around all of it, `#include`, `#define` of \
             a constant, and what stands in `#ifdef __cplusplus` are known: a condition could make it another header for a \
             model checker than for the compiler"
    )]
    Directive,
    /// `#define`
    #[error(
        "a header of the agent's own defines only constants: numbers, texts, names and operators, in a line"
    )]
    Define,
    /// What is no declaration of data.
    #[error(
        "a header of the agent's own declares types, data and functions, in plain C and each with its `;`"
    )]
    Header,
    /// A declaration in a header of what the generated C means by a name.
    #[error("the generated files use this name; rename it")]
    Used,
    /// The agent's own C is not of the language.
    #[error(
        "the translation of this agent itself is not of the language that is judged, for its types"
    )]
    Translation,
}
