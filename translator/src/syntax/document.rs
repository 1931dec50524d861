//! An agent's text with its syntax tree, which follows the edits of the text.
//!
//! An edit parses only the statements that it touches and those beside them; the others are moved. The result is
//! always that of parsing the whole text.

use std::ops::Range;

use diagnostic::{Diagnostic, Span};

use super::ast::{Agent, Atom};
use super::parser::{Parser, Parsing, Statement};
use super::shift::Shift as _;
use crate::code::Code;

/// The text of an agent and its syntax tree.
///
/// ```
/// let mut document = translator::syntax::Document::new("+!go <- on.".to_owned());
/// document.edit(8..10, "off; on");
/// assert_eq!(document.text(), "+!go <- off; on.");
/// assert_eq!(document.agent().plans[0].body.len(), 2);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Document {
    text: String,
    agent: Agent,
    /// All initial goals, with their places; an agent has the first one.
    goals: Vec<(Atom, Span)>,
    /// The statements, in the order of the text.
    clauses: Vec<Clause>,
}

/// One statement: its tree is the next one of its kind.
#[derive(Debug, Clone)]
struct Clause {
    kind: Kind,
    end: usize,
    lexical: Vec<Diagnostic>,
    error: Option<Diagnostic>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Belief,
    Goal,
    Plan,
    /// Text with an error.
    Unknown,
}

/// Statements with their trees.
#[derive(Default)]
struct Statements {
    clauses: Vec<Clause>,
    beliefs: Vec<Atom>,
    goals: Vec<(Atom, Span)>,
    plans: Vec<super::ast::Plan>,
}

impl Statements {
    fn push(&mut self, Parsing { statement, end, lexical, error }: Parsing) {
        let kind = match statement {
            Statement::Belief(belief) => {
                self.beliefs.push(belief);
                Kind::Belief
            }
            Statement::Goal(goal, span) => {
                self.goals.push((goal, span));
                Kind::Goal
            }
            Statement::Plan(plan) => {
                self.plans.push(*plan);
                Kind::Plan
            }
            Statement::Unknown => Kind::Unknown,
        };
        self.clauses.push(Clause { kind, end, lexical, error });
    }
}

impl Document {
    /// Parses a text.
    pub fn new(text: String) -> Self {
        let mut read = Statements::default();
        let mut parser = Parser::at(&text, 0);
        while let Some(parsing) = parser.next_statement() {
            read.push(parsing);
        }
        let Statements { clauses, beliefs, goals, plans } = read;
        let goal = goals.first().map(|(goal, _)| goal.clone());
        Self { text, agent: Agent { beliefs, goal, plans }, goals, clauses }
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The tree of the statements without errors.
    pub fn agent(&self) -> &Agent {
        &self.agent
    }

    /// The tree, and all errors.
    pub(super) fn into_parts(self) -> (Agent, Vec<Diagnostic>) {
        let errors = self.errors();
        (self.agent, errors)
    }

    /// Replaces a range of bytes of the text. A range that is not one of the text is moved to the nearest that is.
    pub fn edit(&mut self, range: Range<usize>, replacement: &str) {
        let start = self.text.floor_char_boundary(range.start);
        let range = start..self.text.ceil_char_boundary(range.end.max(start));
        self.text.replace_range(range.clone(), replacement);
        // Both are lengths of texts in memory.
        let moved = replacement.len().cast_signed() - range.len().cast_signed();
        let edited = range.start + replacement.len();

        // A statement's last token, and an error in it, may depend on the first token behind it.
        let touched = self.clauses.partition_point(|clause| clause.end < range.start);
        let first = touched.saturating_sub(1);
        let begin = first.checked_sub(1).map_or(0, |before| self.clauses[before].end);
        let mut kept = self.clauses.len();
        let mut read = Statements::default();
        let mut parser = Parser::at(&self.text, begin);
        while let Some(parsing) = parser.next_statement() {
            let end = parsing.end;
            read.push(parsing);
            if end >= edited {
                // What follows is known if a statement ended here before, too.
                let before = end.saturating_add_signed(-moved);
                if let Ok(same) = self.clauses.binary_search_by_key(&before, |clause| clause.end) {
                    kept = same + 1;
                    break;
                }
            }
        }
        self.replace(first..kept, read, moved);
    }

    /// Replaces some statements, and moves those behind them.
    fn replace(&mut self, old: Range<usize>, new: Statements, moved: isize) {
        let of_kind = |kind: Kind| {
            let count = |clauses: &[Clause]| clauses.iter().filter(|c| c.kind == kind).count();
            let start = count(&self.clauses[..old.start]);
            start..start + count(&self.clauses[old.clone()])
        };
        let (beliefs, goals, plans) =
            (of_kind(Kind::Belief), of_kind(Kind::Goal), of_kind(Kind::Plan));
        if moved != 0 {
            self.agent.beliefs[beliefs.end..].shift(moved);
            self.goals[goals.end..].shift(moved);
            self.agent.plans[plans.end..].shift(moved);
            for clause in &mut self.clauses[old.end..] {
                clause.end.shift(moved);
                clause.lexical.shift(moved);
                clause.error.shift(moved);
            }
        }
        self.agent.beliefs.splice(beliefs, new.beliefs);
        self.goals.splice(goals, new.goals);
        self.agent.plans.splice(plans, new.plans);
        self.clauses.splice(old, new.clauses);
        self.agent.goal = self.goals.first().map(|(goal, _)| goal.clone());
    }

    /// Whether the statement at this byte has an error, so that it is not part of the tree.
    pub fn is_unknown(&self, offset: usize) -> bool {
        let index = self.clauses.partition_point(|clause| clause.end < offset);
        self.clauses.get(index).is_some_and(|clause| clause.kind == Kind::Unknown)
    }

    /// The begin of the statement that contains this byte, or precedes it directly: behind the full stop before it.
    pub fn statement_start(&self, offset: usize) -> usize {
        let index = self.clauses.partition_point(|clause| clause.end < offset);
        index.checked_sub(1).map_or(0, |before| self.clauses[before].end)
    }

    /// All errors.
    pub fn errors(&self) -> Vec<Diagnostic> {
        let lexical = self.clauses.iter().flat_map(|clause| &clause.lexical);
        let mut errors: Vec<Diagnostic> = lexical.cloned().collect();
        let (mut beliefs, mut goals) = (self.agent.beliefs.iter(), self.goals.iter());
        let (mut first_goal, mut first_plan) = (true, true);
        let late = |what: &str, span: Span| {
            Code::Syntax
                .at(format!("{what} after a plan"), span)
                .help("the order is: initial beliefs, initial goal, plans")
        };
        for clause in &self.clauses {
            match clause.kind {
                Kind::Belief => {
                    let belief = beliefs.next().filter(|_| !first_plan);
                    errors.extend(belief.map(|atom| late("an initial belief", atom.span.clone())));
                }
                Kind::Goal => {
                    let span = goals.next().map(|(_, span)| span.clone());
                    if !std::mem::take(&mut first_goal) {
                        errors.extend(span.map(|span| {
                            Code::DeclaredTwice
                                .at("a second initial goal", span)
                                .help("an agent has at most one; let its plan call the other goals")
                        }));
                    } else if !first_plan {
                        errors.extend(span.map(|span| late("the initial goal", span)));
                    }
                }
                Kind::Plan => first_plan = false,
                Kind::Unknown => errors.extend(clause.error.clone()),
            }
        }
        if first_plan && errors.is_empty() {
            let end = self.text.len();
            errors.push(
                Code::NoPlans
                    .at("the agent has no plans", end..end)
                    .help("add at least one plan: `+!goal : context <- body.`"),
            );
        }
        errors
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const AGENT: &str = include_str!("../../agents/rover.asl");

    /// Pieces that begin, end or break tokens and statements.
    const PIECES: [&str; 22] = [
        "",
        ".",
        "1",
        "5",
        " ",
        "\n",
        "\"",
        "/*",
        "*/",
        "//",
        "!g.",
        "b(1.",
        "+!g <- a; ",
        ". wait(1)",
        "+",
        "X",
        "é",
        "\u{feff}",
        "!h(1). ",
        "b(1).",
        "@l ",
        "~",
    ];

    fn check_same(edited: &Document) {
        let fresh = Document::new(edited.text().to_owned());
        assert_eq!(edited.agent(), fresh.agent(), "{}", edited.text());
        assert_eq!(edited.errors(), fresh.errors(), "{}", edited.text());
        assert_eq!(edited.clauses.len(), fresh.clauses.len());
    }

    #[test]
    fn an_edit_parses_only_what_it_touches() {
        let mut document = Document::new(AGENT.to_owned());
        let plans = document.agent().plans.len();
        let last = document.agent().plans[plans - 1].body.as_ptr();
        let offset = AGENT.find("halt;").unwrap();
        document.edit(offset..offset + 4, "haltAtOnce");
        check_same(&document);
        // The tree of the last plan was moved, not made anew.
        assert_eq!(document.agent().plans[plans - 1].body.as_ptr(), last);
    }

    #[test]
    fn the_first_token_behind_a_statement_can_belong_to_it() {
        for (text, range, replacement) in [
            ("+!g : X == 1. +!h.", 13..14, "5"),
            ("+!g : X == 1.", 13..13, "5 <- a."),
            ("+!a <- b; . +!h.", 12..12, "w"),
            ("+!a. /* +!b. +!c.", 5..7, ""),
            ("+!a. +!b. +!c.", 5..5, "/*"),
            ("b. +!c. !a. !d.", 8..12, ""),
            ("+!a", 0..3, ""),
            ("", 0..0, "+!a."),
            ("a\u{e9}.", 2..2, "b"),
        ] {
            let mut document = Document::new(text.to_owned());
            document.edit(range, replacement);
            check_same(&document);
        }
    }

    proptest! {
        #[test]
        fn after_edits_the_tree_is_that_of_the_text(
            edits in prop::collection::vec((0_usize..2600, 0_usize..30, 0..PIECES.len()), 1..12)
        ) {
            let mut document = Document::new(AGENT.to_owned());
            for (start, length, piece) in edits {
                let start = start.min(document.text().len());
                document.edit(start..start + length, PIECES[piece]);
                check_same(&document);
            }
        }
    }
}
