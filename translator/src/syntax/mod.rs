//! Lexer and parser: from AgentSpeak text to a syntax tree.
//!
//! [`parse`] never fails: it returns the tree of the parts that it understood, and a diagnostic for each
//! error. A tree with errors must not be translated.

pub mod ast;
mod expression;
pub(crate) mod lexer;
mod parser;

pub use parser::parse;
