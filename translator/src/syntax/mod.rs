//! AgentSpeak text to syntax tree.
//!
//! [`parse`] never fails: it returns the tree of what it understood and a diagnostic for each
//! thing that it did not. A tree with errors must not be translated.

pub mod ast;
mod expression;
mod lexer;
mod parser;

pub use parser::parse;
