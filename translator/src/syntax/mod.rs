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

use diagnostic::Diagnostic;

pub use document::Document;

/// The syntax tree of `text` and all errors.
pub fn parse(text: &str) -> (ast::Agent, Vec<Diagnostic>) {
    Document::new(text.to_owned()).into_parts()
}
