//! Tokens to syntax tree, by recursive descent with one token of look-ahead.
//!
//! After an error the parser goes on behind the next full stop, so that one run reports all errors
//! of a file.

use diagnostic::{Diagnostic, Span};

use super::ast::{
    Agent, Atom, Formula, Literal, Name, Number, Operator, Plan, Term, Trigger, TriggerKind,
};
use super::lexer::{Token, TokenKind, tokenize};

/// Function calls may be nested this deep in a term; the bound keeps the parser's stack bounded.
const MAX_NESTING: usize = 64;

/// The syntax tree of `text` and everything that is wrong with it.
pub fn parse(text: &str) -> (Agent, Vec<Diagnostic>) {
    let (tokens, diagnostics) = tokenize(text);
    let mut parser = Parser { text, tokens, position: 0, diagnostics };
    let agent = parser.agent();
    (agent, parser.diagnostics)
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    position: usize,
    diagnostics: Vec<Diagnostic>,
}

type Parsed<T> = Result<T, Diagnostic>;

impl Parser<'_> {
    fn agent(&mut self) -> Agent {
        let mut agent = Agent::default();
        while self.peek() != &TokenKind::End {
            if let Err(diagnostic) = self.statement(&mut agent) {
                self.diagnostics.push(diagnostic);
                self.recover();
            }
        }
        if agent.plans.is_empty() && self.diagnostics.is_empty() {
            let end = self.text.len();
            self.diagnostics.push(
                Diagnostic::error("the agent has no plans", end..end)
                    .help("add at least one plan: `+!goal : context <- body.`"),
            );
        }
        agent
    }

    fn statement(&mut self, agent: &mut Agent) -> Parsed<()> {
        match self.peek() {
            TokenKind::Plus | TokenKind::Minus => agent.plans.push(self.plan()?),
            TokenKind::Bang => {
                let start = self.next().span.start;
                let goal = self.atom(0)?;
                self.expect(&TokenKind::Dot, "`.` after the initial goal")?;
                let span = start..goal.span.end;
                if agent.goal.is_some() {
                    return Err(Diagnostic::error("a second initial goal", span)
                        .help("an agent has at most one; let its plan call the other goals"));
                }
                self.refuse_after_plans(agent, span, "the initial goal");
                agent.goal = Some(goal);
            }
            TokenKind::Atom => {
                let belief = self.atom(0)?;
                self.expect(&TokenKind::Dot, "`.` after the initial belief")?;
                self.refuse_after_plans(agent, belief.span.clone(), "an initial belief");
                agent.beliefs.push(belief);
            }
            _ => {
                return Err(self.unexpected("an initial belief, an initial goal or a plan"));
            }
        }
        Ok(())
    }

    fn refuse_after_plans(&mut self, agent: &Agent, span: Span, what: &str) {
        if !agent.plans.is_empty() {
            self.diagnostics.push(
                Diagnostic::error(format!("{what} stands after a plan"), span)
                    .help("the order is: initial beliefs, initial goal, plans"),
            );
        }
    }

    fn plan(&mut self) -> Parsed<Plan> {
        let start = self.span().start;
        let trigger = self.trigger()?;
        let mut context = Vec::new();
        if self.take(&TokenKind::Colon) {
            context = self.context()?;
        }
        let mut body = Vec::new();
        if self.take(&TokenKind::Arrow) {
            body = self.body()?;
        }
        let end = self.expect(&TokenKind::Dot, "`.` at the end of the plan")?.end;
        Ok(Plan { trigger, context, body, span: start..end })
    }

    fn trigger(&mut self) -> Parsed<Trigger> {
        let operator_token = self.next();
        let operator = match operator_token.kind {
            TokenKind::Plus => Operator::Add,
            _ => Operator::Delete,
        };
        let kind = match self.peek() {
            TokenKind::Bang => TriggerKind::Achieve,
            TokenKind::Question => TriggerKind::Test,
            TokenKind::BangBang => {
                return Err(Diagnostic::error("`!!` cannot be a trigger", self.span())
                    .help("a goal posted with `!!g` triggers the plans of `+!g`"));
            }
            _ => TriggerKind::Belief,
        };
        if kind != TriggerKind::Belief {
            self.next();
        }
        let atom = self.atom(0)?;
        let span = operator_token.span.start..atom.span.end;
        Ok(Trigger { operator, kind, atom, span })
    }

    fn context(&mut self) -> Parsed<Vec<Literal>> {
        if self.take(&TokenKind::True) {
            return Ok(Vec::new());
        }
        let mut literals = vec![self.literal()?];
        while self.take(&TokenKind::Ampersand) {
            literals.push(self.literal()?);
        }
        Ok(literals)
    }

    fn literal(&mut self) -> Parsed<Literal> {
        let negated = self.take(&TokenKind::Not);
        let parenthesised = negated && self.take(&TokenKind::LeftParenthesis);
        let atom = self.atom_or("a belief or a function of type bool")?;
        if parenthesised {
            self.expect(&TokenKind::RightParenthesis, "`)`")?;
        }
        Ok(Literal { negated, atom })
    }

    fn body(&mut self) -> Parsed<Vec<Formula>> {
        if self.take(&TokenKind::True) {
            return Ok(Vec::new());
        }
        let mut formulae = vec![self.formula()?];
        while self.take(&TokenKind::Semicolon) {
            formulae.push(self.formula()?);
        }
        Ok(formulae)
    }

    fn formula(&mut self) -> Parsed<Formula> {
        let build = match self.peek() {
            TokenKind::Bang => Formula::Achieve,
            TokenKind::BangBang => Formula::Defer,
            TokenKind::Question => Formula::Test,
            TokenKind::Plus => Formula::Add,
            TokenKind::Minus => Formula::Delete,
            TokenKind::Atom => return Ok(Formula::Action(self.atom(0)?)),
            TokenKind::Variable => {
                let variable = self.name();
                self.expect(&TokenKind::Equals, "`=` and a function call")?;
                let call = self.atom_or("a function call")?;
                return Ok(Formula::Assign { variable, call });
            }
            _ => {
                return Err(
                    self.unexpected("an action, `X = f(..)`, `+b`, `-b`, `!g`, `!!g` or `?b`")
                );
            }
        };
        self.next();
        Ok(build(self.atom(0)?))
    }

    fn atom_or(&mut self, expected: &str) -> Parsed<Atom> {
        if self.peek() == &TokenKind::Atom { self.atom(0) } else { Err(self.unexpected(expected)) }
    }

    fn atom(&mut self, depth: usize) -> Parsed<Atom> {
        if self.peek() != &TokenKind::Atom {
            return Err(self.unexpected("a name that starts with a lower-case letter"));
        }
        let name = self.name();
        let mut end = name.span.end;
        let mut arguments = Vec::new();
        if self.take(&TokenKind::LeftParenthesis) {
            if self.peek() != &TokenKind::RightParenthesis {
                arguments.push(self.term(depth + 1)?);
                while self.take(&TokenKind::Comma) {
                    arguments.push(self.term(depth + 1)?);
                }
            }
            end = self.expect(&TokenKind::RightParenthesis, "`,` or `)`")?.end;
        }
        let span = name.span.start..end;
        Ok(Atom { name, arguments, span })
    }

    fn term(&mut self, depth: usize) -> Parsed<Term> {
        if depth > MAX_NESTING {
            return Err(Diagnostic::error("terms are nested too deeply", self.span())
                .help(format!("at most {MAX_NESTING} calls may stand inside each other")));
        }
        match self.peek().clone() {
            TokenKind::Variable => Ok(Term::Variable(self.name())),
            TokenKind::Unnamed => Ok(Term::Unnamed(self.next().span)),
            TokenKind::Text(text) => Ok(Term::Text { text, span: self.next().span }),
            TokenKind::Atom => Ok(Term::Call(self.atom(depth)?)),
            TokenKind::Number | TokenKind::Minus => self.number(),
            _ => Err(self.unexpected("a variable, a number, a string or a function call")),
        }
    }

    fn number(&mut self) -> Parsed<Term> {
        let start = self.span();
        let negative = self.take(&TokenKind::Minus);
        if self.peek() != &TokenKind::Number || (negative && self.span().start != start.end) {
            return Err(self.unexpected("a number directly behind the sign"));
        }
        let digits_span = self.next().span;
        let span = start.start..digits_span.end;
        Ok(Term::Number(Number { digits: self.text[digits_span].to_owned(), negative, span }))
    }

    /// The token under the cursor as a name; the caller has looked at its kind.
    fn name(&mut self) -> Name {
        let span = self.next().span;
        Name { text: self.text[span.clone()].to_owned(), span }
    }

    fn token(&self) -> &Token {
        // `tokenize` ends with `End`, and `next` never moves past it.
        &self.tokens[self.position.min(self.tokens.len() - 1)]
    }

    fn peek(&self) -> &TokenKind {
        &self.token().kind
    }

    fn span(&self) -> Span {
        self.token().span.clone()
    }

    fn next(&mut self) -> Token {
        let token = self.token().clone();
        if token.kind != TokenKind::End {
            self.position += 1;
        }
        token
    }

    fn take(&mut self, kind: &TokenKind) -> bool {
        let found = self.peek() == kind;
        if found {
            self.next();
        }
        found
    }

    fn expect(&mut self, kind: &TokenKind, expected: &str) -> Parsed<Span> {
        if self.peek() == kind { Ok(self.next().span) } else { Err(self.unexpected(expected)) }
    }

    fn unexpected(&self, expected: &str) -> Diagnostic {
        let found = match self.peek() {
            TokenKind::End => "the end of the file".to_owned(),
            _ => format!("`{}`", self.text[self.span()].escape_debug()),
        };
        Diagnostic::error(format!("expected {expected}, found {found}"), self.span())
    }

    /// Skips behind the next full stop.
    fn recover(&mut self) {
        while !matches!(self.next().kind, TokenKind::Dot | TokenKind::End) {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> Vec<String> {
        parse(text).1.into_iter().map(|diagnostic| diagnostic.message).collect()
    }

    #[test]
    fn a_whole_plan_is_parsed() {
        let (agent, diagnostics) = parse(
            "b(1, -2.5). !start.\n+!start : b(X, _) & not(c) & f(X) <- a(X, \"t\"); Y = g(X); +c(Y); -c(_); !h; !!h; ?b(X, Z).",
        );
        assert_eq!(diagnostics, []);
        assert_eq!(agent.beliefs.len(), 1);
        assert!(agent.goal.is_some());
        let plan = &agent.plans[0];
        assert_eq!(plan.context.len(), 3);
        assert!(plan.context[1].negated);
        assert_eq!(plan.body.len(), 7);
    }

    #[test]
    fn context_and_body_may_be_left_out_or_true() {
        let (agent, diagnostics) = parse("+!a. +!b : true <- true. -c <- act.");
        assert_eq!(diagnostics, []);
        assert_eq!(agent.plans.len(), 3);
    }

    #[test]
    fn all_errors_of_a_file_are_reported_in_one_run() {
        assert_eq!(
            messages("+!a <- ; b. +!c : <- d. +!e <- f(,1). +!!g <- h. +!ok <- i."),
            [
                "expected an action, `X = f(..)`, `+b`, `-b`, `!g`, `!!g` or `?b`, found `;`",
                "expected a belief or a function of type bool, found `<-`",
                "expected a variable, a number, a string or a function call, found `,`",
                "`!!` cannot be a trigger",
            ]
        );
    }

    #[test]
    fn malformed_input_of_any_kind_gives_an_error() {
        for text in ["", " ", "+", "+!", "+!a", "!a", "b", ".", "+!a <- X = 3.", "!a. !b. +!a."] {
            assert!(!messages(text).is_empty(), "{text:?}");
        }
        let deep = format!("+!a <- f({}1{}).", "g(".repeat(100_000), ")".repeat(100_000));
        assert_eq!(messages(&deep), ["terms are nested too deeply"]);
    }
}
