//! Recursive-descent parser of one statement after the other, with one token of look-ahead.
//!
//! After an error the parser continues behind the next full stop, so that one run reports all errors of a
//! file.

use diagnostic::{Diagnostic, Span};

use super::ast::{
    Atom, Expression, Formula, Name, Operator, Performative, Plan, Trigger, TriggerKind,
};
use super::lexer::{Lexer, Token, TokenKind};
use crate::code::Code;

/// What one statement of an agent is.
pub(super) enum Statement {
    Belief(Atom),
    /// The initial goal, and its place with the `!`.
    Goal(Atom, Span),
    Plan(Box<Plan>),
    /// Text with an error.
    Unknown,
}

/// A statement with its errors.
pub(super) struct Parsing {
    pub(super) statement: Statement,
    /// Its end in the text, behind the full stop.
    pub(super) end: usize,
    /// Errors in its characters.
    pub(super) lexical: Vec<Diagnostic>,
    /// Its other error.
    pub(super) error: Option<Diagnostic>,
}

pub(super) struct Parser<'a> {
    pub(super) text: &'a str,
    lexer: Lexer<'a>,
    current: Token,
    following: Token,
    /// End of the last token that was taken.
    end: usize,
}

pub(super) type Parsed<T> = Result<T, Diagnostic>;

/// A plan's label and its requirement tags.
type Annotations = (Option<Name>, Vec<String>);

impl<'a> Parser<'a> {
    /// A parser that begins behind a statement, or at the begin of the text.
    pub(super) fn at(text: &'a str, position: usize) -> Self {
        let mut lexer = Lexer::at(text, position);
        let (current, following) = (lexer.token(), lexer.token());
        Self { text, lexer, current, following, end: position }
    }

    /// The next statement; `None` at the end of the text.
    pub(super) fn next_statement(&mut self) -> Option<Parsing> {
        if self.peek() == &TokenKind::End {
            return None;
        }
        let (statement, error) = match self.statement() {
            Ok(statement) => (statement, None),
            Err(diagnostic) => {
                // The lexer has reported it.
                let said = self.peek() == &TokenKind::Invalid;
                self.recover();
                (Statement::Unknown, Some(diagnostic).filter(|_| !said))
            }
        };
        // A statement without a full stop depends on everything behind it.
        let open = matches!(statement, Statement::Unknown) && self.peek() == &TokenKind::End;
        let end = if open { self.text.len() } else { self.end };
        let found = &mut self.lexer.diagnostics;
        let own = found.partition_point(|diagnostic| diagnostic.span.start < end);
        let lexical = found.drain(..own).collect();
        Some(Parsing { statement, end, lexical, error })
    }

    fn statement(&mut self) -> Parsed<Statement> {
        match self.peek() {
            TokenKind::Plus | TokenKind::Minus | TokenKind::At => {
                Ok(Statement::Plan(Box::new(self.plan()?)))
            }
            TokenKind::Bang => {
                let start = self.next().span.start;
                let goal = self.atom(0)?;
                if let Err(error) = self.expect(&TokenKind::Dot, "`.` after the initial goal") {
                    let plan = matches!(self.peek(), TokenKind::Arrow | TokenKind::Colon);
                    let help = format!(
                        "a plan begins with its trigger: did you mean `+!{}`?",
                        goal.name.text
                    );
                    return Err(if plan { error.help(help) } else { error });
                }
                let span = start..goal.span.end;
                Ok(Statement::Goal(goal, span))
            }
            TokenKind::Atom => {
                let belief = self.atom(0)?;
                if let Err(error) = self.expect(&TokenKind::Dot, "`.` after the initial belief") {
                    let plan = matches!(self.peek(), TokenKind::Arrow | TokenKind::Colon);
                    let name = &belief.name.text;
                    let help = format!(
                        "a plan begins with its trigger: did you mean `+!{name}` or `+{name}`?"
                    );
                    return Err(if plan { error.help(help) } else { error });
                }
                Ok(Statement::Belief(belief))
            }
            _ => Err(self.unexpected("an initial belief, an initial goal or a plan")),
        }
    }

    fn plan(&mut self) -> Parsed<Plan> {
        let start = self.span().start;
        let (label, requirements) = self.annotations()?;
        let trigger = self.trigger()?;
        let mut context = None;
        if self.take(&TokenKind::Colon) {
            context = Some(self.expression("a belief or a function of type bool")?);
        }
        let mut body = Vec::new();
        if self.take(&TokenKind::Arrow) {
            body = self.body()?;
        }
        let end = match self.expect(&TokenKind::Dot, "`.` at the end of the plan") {
            Ok(dot) => dot.end,
            Err(error) => {
                return Err(match self.peek() {
                    TokenKind::Comma | TokenKind::Ampersand if !body.is_empty() => {
                        error.help("formulae of a body are separated by `;`")
                    }
                    TokenKind::Comma => error.help("conditions of a context are joined by `&`"),
                    TokenKind::Plus | TokenKind::Minus | TokenKind::At => {
                        error.help("the plan before this one needs a full stop at its end")
                    }
                    _ => error,
                });
            }
        };
        Ok(Plan { label, requirements, trigger, context, body, span: start..end })
    }

    /// `@label[req("HLR-1"), req("HLR-2")]`
    fn annotations(&mut self) -> Parsed<Annotations> {
        let mut requirements = Vec::new();
        if !self.take(&TokenKind::At) {
            return Ok((None, requirements));
        }
        if self.peek() != &TokenKind::Atom {
            return Err(self.unexpected("a plan's label"));
        }
        let label = self.name();
        if self.take(&TokenKind::LeftBracket) {
            loop {
                requirements.push(self.requirement()?);
                if !self.take(&TokenKind::Comma) {
                    break;
                }
            }
            self.expect(&TokenKind::RightBracket, "`,` or `]`")?;
        }
        Ok((Some(label), requirements))
    }

    fn requirement(&mut self) -> Parsed<String> {
        if !self.take_word("req") {
            return Err(self.unexpected("`req(\"tag\")`"));
        }
        self.expect(&TokenKind::LeftParenthesis, "`(`")?;
        let TokenKind::Text(tag) = self.peek().clone() else {
            return Err(self.unexpected("a requirement's tag in quotes"));
        };
        self.next();
        self.expect(&TokenKind::RightParenthesis, "`)`")?;
        Ok(tag)
    }

    fn trigger(&mut self) -> Parsed<Trigger> {
        if !matches!(self.peek(), TokenKind::Plus | TokenKind::Minus) {
            return Err(self.unexpected("`+` or `-` of a trigger"));
        }
        let operator_token = self.next();
        let operator = match operator_token.kind {
            TokenKind::Plus => Operator::Add,
            _ => Operator::Delete,
        };
        let kind = match self.peek() {
            TokenKind::Bang => TriggerKind::Achieve,
            TokenKind::Question => TriggerKind::Test,
            TokenKind::BangBang => {
                return Err(Code::Syntax
                    .at("`!!` cannot be a trigger", self.span())
                    .help("a goal posted with `!!g` triggers the plans of `+!g`"));
            }
            _ => TriggerKind::Belief,
        };
        if kind != TriggerKind::Belief {
            self.next();
        }
        let atom = self.sourced(0)?;
        let span = operator_token.span.start..atom.span.end;
        Ok(Trigger { operator, kind, atom, span })
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
            TokenKind::Bang => return self.achieve(),
            TokenKind::Dot if self.following() == &TokenKind::Atom => return self.internal(),
            TokenKind::BangBang => Formula::Defer,
            TokenKind::Question => Formula::Test,
            TokenKind::Plus => Formula::Add,
            TokenKind::Minus => Formula::Delete,
            TokenKind::Atom => return Ok(Formula::Action(self.atom(0)?)),
            TokenKind::Variable => {
                let variable = self.name();
                self.expect(&TokenKind::Equals, "`=` and a value")?;
                let value = self.expression("a value")?;
                return Ok(Formula::Assign { variable, value });
            }
            _ => {
                return Err(
                    self.unexpected("an action, `X = value`, `+b`, `-b`, `!g`, `!!g` or `?b`")
                );
            }
        };
        self.next();
        Ok(build(self.atom(0)?))
    }

    /// `!goal`, `!goal[deadline(ms)]`
    fn achieve(&mut self) -> Parsed<Formula> {
        self.next();
        let goal = self.atom(0)?;
        let mut deadline = None;
        if self.take(&TokenKind::LeftBracket) {
            if !self.take_word("deadline") {
                return Err(self.unexpected("`deadline(milliseconds)`"));
            }
            self.expect(&TokenKind::LeftParenthesis, "`(`")?;
            deadline = Some(self.expression("a time in milliseconds")?);
            self.expect(&TokenKind::RightParenthesis, "`)`")?;
            self.expect(&TokenKind::RightBracket, "`]`")?;
        }
        Ok(Formula::Achieve { goal, deadline })
    }

    /// An internal action. Where a formula is expected, a full stop before a name has no other meaning.
    fn internal(&mut self) -> Parsed<Formula> {
        let start = self.next().span.start;
        let name = self.span();
        match &self.text[name.clone()] {
            "wait" => {
                self.next();
                self.expect(&TokenKind::LeftParenthesis, "`(` and a time in milliseconds")?;
                let duration = self.expression("a time in milliseconds")?;
                let end = self.expect(&TokenKind::RightParenthesis, "`)`")?.end;
                Ok(Formula::Wait { duration, span: start..end })
            }
            "my_name" => {
                self.next();
                self.expect(&TokenKind::LeftParenthesis, "`(` and a variable")?;
                if self.peek() != &TokenKind::Variable {
                    return Err(self.unexpected("a variable"));
                }
                let variable = self.name();
                let end = self.expect(&TokenKind::RightParenthesis, "`)`")?.end;
                Ok(Formula::MyName { variable, span: start..end })
            }
            "send" => self.message(start, true),
            "broadcast" => self.message(start, false),
            found => Err(Code::UnknownAction
                .at(format!("unknown internal action `.{found}`"), start..name.end)
                .help(
                    "known are `.wait(milliseconds)`, `.send(peer, tell, belief)`, `.broadcast(tell, belief)` and \
                     `.my_name(Variable)`; others are basic actions",
                )),
        }
    }

    /// `.send(peer, tell, b(t))`, or `.broadcast(tell, b(t))`, at its name.
    fn message(&mut self, start: usize, has_receiver: bool) -> Parsed<Formula> {
        self.next();
        self.expect(&TokenKind::LeftParenthesis, "`(`")?;
        let mut to = None;
        if has_receiver {
            to = Some(self.expression("a peer")?);
            self.expect(&TokenKind::Comma, "`,` and what the message does")?;
        }
        let word = self.span();
        let known = |performative: &Performative| performative.name() == &self.text[word.clone()];
        let Some(performative) = Performative::ALL.into_iter().find(known) else {
            return Err(self.unexpected("`tell`, `untell`, `achieve` or `unachieve`"));
        };
        self.next();
        self.expect(&TokenKind::Comma, "`,` and what the message is about")?;
        let content = self.atom(0)?;
        let end = self.expect(&TokenKind::RightParenthesis, "`)`")?.end;
        Ok(Formula::Send { to, performative, content, span: start..end })
    }

    /// `.my_name(M)` in a context.
    pub(super) fn my_name(&mut self, depth: usize) -> Parsed<Expression> {
        let start = self.next().span.start;
        if !self.take_word("my_name") {
            return Err(self.unexpected("`my_name`, which alone may stand in a context"));
        }
        self.expect(&TokenKind::LeftParenthesis, "`(` and a variable or peer")?;
        let name = Box::new(self.argument(depth)?);
        let end = self.expect(&TokenKind::RightParenthesis, "`)`")?.end;
        Ok(Expression::MyName { name, span: start..end })
    }

    /// A name with arguments, where it comes from, and how old it is: `b(t)[source(P), age(A)]`.
    pub(super) fn sourced(&mut self, depth: usize) -> Parsed<Atom> {
        let mut atom = self.atom(depth)?;
        if self.take(&TokenKind::LeftBracket) {
            if self.take_word("source") {
                self.expect(&TokenKind::LeftParenthesis, "`(` and a peer")?;
                atom.source = Some(Box::new(self.argument(depth)?));
                self.expect(&TokenKind::RightParenthesis, "`)`")?;
            }
            if atom.source.is_none() || self.take(&TokenKind::Comma) {
                if !self.take_word("age") {
                    let known = ["`source(peer)` or `age(milliseconds)`", "`age(milliseconds)`"];
                    return Err(self.unexpected(known[usize::from(atom.source.is_some())]));
                }
                self.expect(&TokenKind::LeftParenthesis, "`(` and a time in milliseconds")?;
                atom.age = Some(Box::new(self.argument(depth)?));
                self.expect(&TokenKind::RightParenthesis, "`)`")?;
            }
            atom.span.end = self.expect(&TokenKind::RightBracket, "`]`")?.end;
        }
        Ok(atom)
    }

    /// Whether the current token is a full stop before a name.
    pub(super) fn is_at_internal(&self) -> bool {
        self.peek() == &TokenKind::Dot && self.following() == &TokenKind::Atom
    }

    /// Takes the name under the cursor if it is `word`.
    fn take_word(&mut self, word: &str) -> bool {
        let found = self.peek() == &TokenKind::Atom && &self.text[self.span()] == word;
        if found {
            self.next();
        }
        found
    }

    /// A name with arguments; `depth` is the nesting depth.
    pub(super) fn atom(&mut self, depth: usize) -> Parsed<Atom> {
        if self.peek() != &TokenKind::Atom {
            return Err(self.unexpected("a name that starts with a lower-case letter"));
        }
        let name = self.name();
        let mut end = name.span.end;
        let mut arguments = Vec::new();
        if self.take(&TokenKind::LeftParenthesis) {
            if self.peek() != &TokenKind::RightParenthesis {
                arguments.push(self.argument(depth)?);
                while self.take(&TokenKind::Comma) {
                    arguments.push(self.argument(depth)?);
                }
            }
            end = self.expect(&TokenKind::RightParenthesis, "`,` or `)`")?.end;
        }
        let span = name.span.start..end;
        Ok(Atom { name, arguments, source: None, age: None, span })
    }

    /// The current token as a name; the caller has checked its kind.
    pub(super) fn name(&mut self) -> Name {
        let span = self.next().span;
        Name { text: self.text[span.clone()].to_owned(), span }
    }

    pub(super) fn peek(&self) -> &TokenKind {
        &self.current.kind
    }

    /// The token behind the current one.
    fn following(&self) -> &TokenKind {
        &self.following.kind
    }

    pub(super) fn span(&self) -> Span {
        self.current.span.clone()
    }

    /// Takes the current token.
    pub(super) fn next(&mut self) -> Token {
        let following = std::mem::replace(&mut self.following, self.lexer.token());
        let token = std::mem::replace(&mut self.current, following);
        self.end = token.span.end;
        token
    }

    pub(super) fn take(&mut self, kind: &TokenKind) -> bool {
        let found = self.peek() == kind;
        if found {
            self.next();
        }
        found
    }

    pub(super) fn expect(&mut self, kind: &TokenKind, expected: &str) -> Parsed<Span> {
        if self.peek() == kind { Ok(self.next().span) } else { Err(self.unexpected(expected)) }
    }

    pub(super) fn unexpected(&self, expected: &str) -> Diagnostic {
        let found = match self.peek() {
            TokenKind::End => "the end of the file".to_owned(),
            _ => format!("`{}`", self.text[self.span()].escape_debug()),
        };
        Code::Syntax.at(format!("expected {expected}, found {found}"), self.span())
    }

    /// Skips to behind the next full stop.
    fn recover(&mut self) {
        while !matches!(self.next().kind, TokenKind::Dot | TokenKind::End) {}
    }
}

#[cfg(test)]
mod tests {
    use crate::syntax::ast::Expression;
    use crate::syntax::parse;

    fn messages(text: &str) -> Vec<String> {
        parse(text).1.into_iter().map(|diagnostic| diagnostic.message).collect()
    }

    #[test]
    fn a_whole_plan_is_parsed() {
        let (agent, diagnostics) = parse(
            "b(1, -2.5). !start.\n@go[req(\"HLR-1\"), req(\"HLR-2\")] +!start : b(X, _) & not(c) & (f(X) | X + 1 < 3)\n\
             <- a(X, \"t\"); Y = g(X) * 2; +c(Y); -c(_); !h; !!h; ?b(X, Z); .wait(2 * X); !h[deadline(500)].",
        );
        assert_eq!(diagnostics, []);
        assert_eq!(agent.beliefs.len(), 1);
        assert!(agent.goal.is_some());
        let plan = &agent.plans[0];
        assert!(matches!(&plan.context, Some(Expression::And(parts)) if parts.len() == 3));
        assert_eq!(plan.body.len(), 9);
        assert_eq!(plan.requirements, ["HLR-1", "HLR-2"]);
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
            messages("+!a <- ; b. +!c : <- d. +!e <- f(,1). +!!g <- h. +!x : ~b <- c. +!ok <- i."),
            [
                "unexpected character `~`",
                "expected an action, `X = value`, `+b`, `-b`, `!g`, `!!g` or `?b`, found `;`",
                "expected a belief or a function of type bool, found `<-`",
                "expected a value, found `,`",
                "`!!` cannot be a trigger",
            ]
        );
    }

    #[test]
    fn malformed_input_of_any_kind_gives_an_error() {
        for text in [
            "",
            " ",
            "+",
            "+!",
            "+!a",
            "!a",
            "b",
            ".",
            "+!a <- X = .",
            "!a. !b. +!a.",
            "@",
            "@l",
            "@l[",
            "@l[req] +!a.",
            "@l[req(3)] +!a.",
            "+!a : (b <- c.",
            "+!a : b | <- c.",
            "+!a : 1 < 2 < 3 <- c.",
            "+!a : not <- c.",
            "+!a <- .",
            "+!a <- .wait.",
            "+!a <- .wait().",
            "+!a <- .print(1).",
            "+!a <- b; .",
            "+!a <- !b[.",
            "+!a <- !b[deadline].",
            "+!a <- !b[deadline(1].",
            "+!a <- !!b[deadline(1)].",
        ] {
            assert!(!messages(text).is_empty(), "{text:?}");
        }
    }

    #[test]
    fn nesting_is_bounded() {
        for (open, close) in [("g(", ")"), ("(", ")"), ("-", ""), ("1+(", ")")] {
            let text = format!("+!a <- f({}1{}).", open.repeat(100_000), close.repeat(100_000));
            assert_eq!(messages(&text), ["nested too deeply"], "{open}");
        }
        let text = format!("+!a : {}b{} <- c.", "not (".repeat(100_000), ")".repeat(100_000));
        assert_eq!(messages(&text), ["nested too deeply"]);
        let text = format!("+!a <- f(1{}).", "+1".repeat(100_000));
        assert_eq!(messages(&text), ["the expression is too long"]);
        // Conjunctions have no such limit.
        let text = format!("+!a : b{} <- c.", " & b".repeat(100_000));
        assert_eq!(messages(&text), [""; 0]);
    }
}
