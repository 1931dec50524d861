//! Lexer and parser: from AgentSpeak text to a syntax tree.
//!
//! [`parse`] never fails: it returns the tree of the parts that it understood, and a diagnostic for each
//! error. A tree with errors must not be translated.

pub mod ast;
mod document;
mod expression;
pub(crate) mod lexer;
mod parser;
mod shift;

pub use document::Document;
pub use parser::parse;
