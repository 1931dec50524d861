//! The grammar of the language.

use std::collections::HashSet;

use crate::lexer::{Kind, Place, Token, tokens};
use crate::refused::{Refused, Rule};
use crate::tree::{
    Block, Definition, Expression, For, Function, Group, Item, Object, Parameter, Prefix,
    Statement, Type, Unit, What, Word,
};
use crate::types::float;

/// Blocks inside each other. C99 guarantees 127, and what is generated stays within that.
const MOST_BLOCKS: u32 = 127;
/// Parentheses inside each other, ..
const MOST_PARENTHESES: u32 = 100;
/// .. and expressions: each operator of a chain is inside the next one.
const MOST_EXPRESSIONS: u16 = 500;

/// `else if` behind each other: for a compiler, each is inside the one before.
const MOST_ARMS: usize = 500;

/// Words of types that are no names.
const BASE: [&str; 11] = [
    "void", "bool", "_Bool", "char", "short", "int", "long", "signed", "unsigned", "float",
    "double",
];
/// Words that no object or function can have as its name, whatever the rules of names say.
const WORDS: [&str; 17] = [
    "static", "const", "typedef", "struct", "union", "enum", "if", "else", "for", "switch", "case",
    "default", "break", "return", "true", "false", "while",
];

/// Binary operators by binding, the loosest first.
const OPERATORS: [&[&str]; 6] =
    [&["||"], &["&&"], &["==", "!="], &["<", "<=", ">", ">="], &["+", "-"], &["*", "/", "%"]];

type Parsed<T> = Result<T, Refused>;

/// Parses a file in which these names are types.
pub(crate) fn parse(text: &str, types: &HashSet<String>) -> Parsed<Unit> {
    Parser::new(text, types, false)?.unit()
}

/// Parses a generated header, which declares what it names.
pub(crate) fn parse_header(text: &str) -> Parsed<Unit> {
    // Its preprocessor lines need not be known: it is no input. Other names of types are known from their lines.
    let is_left_out =
        |line: &str| line.starts_with('#') || (line.starts_with("typedef ") && line.ends_with(';'));
    let lines = text.lines().map(|line| if is_left_out(line) { "" } else { line });
    let text = lines.collect::<Vec<_>>().join("\n");
    Parser::new(&text, &HashSet::new(), true)?.unit()
}

struct Parser<'a> {
    tokens: Vec<Token<'a>>,
    next: usize,
    types: &'a HashSet<String>,
    header: bool,
    blocks: u32,
    parentheses: u32,
}

fn word(token: &Token<'_>) -> Word {
    Word { text: token.text.to_owned(), place: token.place }
}

impl<'a> Parser<'a> {
    fn new(text: &'a str, types: &'a HashSet<String>, header: bool) -> Parsed<Self> {
        Ok(Self { tokens: tokens(text)?, next: 0, types, header, blocks: 0, parentheses: 0 })
    }

    /// A word further on; the last one has no successor.
    fn peek(&self, further: usize) -> Token<'a> {
        self.tokens[(self.next + further).min(self.tokens.len() - 1)]
    }

    fn take(&mut self) -> Token<'a> {
        let token = self.peek(0);
        self.next += 1;
        token
    }

    fn is(&self, text: &str) -> bool {
        self.is_at(0, text)
    }

    fn is_at(&self, further: usize, text: &str) -> bool {
        let token = self.peek(further);
        token.text == text && matches!(token.kind, Kind::Name | Kind::Sign)
    }

    fn accept(&mut self, text: &str) -> bool {
        let accepted = self.is(text);
        self.next += usize::from(accepted);
        accepted
    }

    fn expect(&mut self, text: &str, expected: &'static str) -> Parsed<()> {
        if self.accept(text) { Ok(()) } else { Err(self.peek(0).refused(Rule::Expected(expected))) }
    }

    fn name(&mut self) -> Parsed<Word> {
        let token = self.take();
        let is_word = BASE.contains(&token.text) || WORDS.contains(&token.text);
        if token.kind != Kind::Name || is_word {
            return Err(token.refused(Rule::Expected("a name was expected")));
        }
        Ok(word(&token))
    }

    fn unit(mut self) -> Parsed<Unit> {
        let mut unit = Unit::default();
        loop {
            let token = self.peek(0);
            match token.kind {
                Kind::Line => unit.lines.push(word(&self.take())),
                Kind::End => break,
                _ => unit.items.push(self.item()?),
            }
        }
        unit.end = self.peek(0).place;
        Ok(unit)
    }

    fn item(&mut self) -> Parsed<Item> {
        if self.accept("typedef") {
            return self.definition();
        }
        let is_static = self.accept("static");
        let ctype = self.ctype()?;
        let name = self.name()?;
        if !self.is("(") {
            if !is_static {
                return Err(self.tokens[self.next - 1].refused(Rule::Static));
            }
            return Ok(Item::Object(self.object(true, ctype, name)?));
        }
        let parameters = self.parameters()?;
        let body = if self.accept(";") { None } else { Some(self.block()?) };
        Ok(Item::Function(Function { is_static, result: ctype, name, parameters, body }))
    }

    fn definition(&mut self) -> Parsed<Item> {
        const EXPECTED: &str = "`typedef enum {` or `typedef struct {` was expected";
        let is_enum = self.accept("enum");
        if !is_enum {
            self.expect("struct", EXPECTED)?;
        }
        self.expect("{", EXPECTED)?;
        let definition = if is_enum {
            let mut names = vec![self.name()?];
            while self.accept(",") {
                names.push(self.name()?);
            }
            Definition::Enum(names)
        } else {
            let mut fields = Vec::new();
            while !self.is("}") {
                let ctype = self.ctype()?;
                let name = self.name()?;
                let length = self.length()?;
                self.expect(";", "`;` was expected")?;
                fields.push((ctype, name, length));
            }
            Definition::Struct(fields)
        };
        self.expect("}", "`}` was expected")?;
        let name = self.name()?;
        self.expect(";", "`;` was expected")?;
        Ok(Item::Definition(name, definition))
    }

    /// `[3]`
    fn length(&mut self) -> Parsed<Option<Word>> {
        if !self.accept("[") {
            return Ok(None);
        }
        let token = self.take();
        if token.kind != Kind::Integer {
            return Err(token.refused(Rule::Array));
        }
        self.expect("]", "`]` was expected")?;
        Ok(Some(word(&token)))
    }

    fn parameters(&mut self) -> Parsed<Vec<Parameter>> {
        self.expect("(", "`(` was expected")?;
        let mut parameters = Vec::new();
        if self.is("void") && self.is_at(1, ")") {
            self.next += 2;
            return Ok(parameters);
        }
        loop {
            let ctype = self.ctype()?;
            let is_named = self.peek(0).kind == Kind::Name;
            let name = if is_named { Some(self.name()?) } else { None };
            parameters.push(Parameter { ctype, name });
            if !self.accept(",") {
                break;
            }
        }
        self.expect(")", "`,` or `)` was expected")?;
        Ok(parameters)
    }

    /// Whether a type begins here.
    fn is_type(&self, further: usize) -> bool {
        const TAGS: [&str; 3] = ["struct", "union", "enum"];
        let token = self.peek(further);
        let is_word =
            token.text == "const" || BASE.contains(&token.text) || TAGS.contains(&token.text);
        token.kind == Kind::Name && (is_word || self.types.contains(token.text))
    }

    fn ctype(&mut self) -> Parsed<Type> {
        let place = self.peek(0).place;
        let mut ctype = Type { words: Vec::new(), constant: false, stars: Vec::new(), place };
        loop {
            let token = self.peek(0);
            let has_name = ctype.words.iter().any(|word| !BASE.contains(&word.as_str()));
            match token.text {
                "const" if !ctype.constant => ctype.constant = true,
                "struct" | "union" | "enum" if ctype.words.is_empty() => {
                    self.next += 1;
                    if self.is("{") {
                        let constant = "write a constant as `static const int32_t limit = 3;`";
                        return Err(token.refused(Rule::Expected(constant)));
                    }
                    let name = self.name()?;
                    ctype.words.push(format!("{} {}", token.text, name.text));
                    continue;
                }
                text if BASE.contains(&text) && !has_name => ctype.words.push(text.to_owned()),
                text if token.kind == Kind::Name
                    && ctype.words.is_empty()
                    && (self.header || self.types.contains(text)) =>
                {
                    ctype.words.push(text.to_owned());
                }
                _ => break,
            }
            self.next += 1;
        }
        if ctype.words.is_empty() {
            let token = self.peek(0);
            let expected = match token.text {
                "inline" => "a compiler finds by itself what to inline; leave the word out",
                _ => "a declaration was expected",
            };
            return Err(token.refused(Rule::Expected(expected)));
        }
        while self.accept("*") {
            ctype.stars.push(self.accept("const"));
        }
        Ok(ctype)
    }

    /// A declaration behind its name.
    fn object(&mut self, outlives: bool, ctype: Type, name: Word) -> Parsed<Object> {
        let length = self.length()?;
        let initial = if self.accept("=") { Some(self.initial()?) } else { None };
        self.expect(";", "`;` was expected: each declaration has one name")?;
        Ok(Object { outlives, ctype, name, length, initial })
    }

    fn initial(&mut self) -> Parsed<Expression> {
        let place = self.peek(0).place;
        if !self.is("{") {
            return self.expression(0);
        }
        self.deeper()?;
        self.next += 1;
        let mut values = vec![self.initial()?];
        while self.accept(",") {
            values.push(self.initial()?);
        }
        self.expect("}", "`,` or `}` was expected")?;
        self.parentheses -= 1;
        let depth = values.iter().map(|value| value.depth).max().unwrap_or_default() + 1;
        Ok(Expression { what: What::Braces(values), place, depth })
    }

    fn deeper(&mut self) -> Parsed<()> {
        self.parentheses += 1;
        if self.parentheses > MOST_PARENTHESES {
            return Err(self.peek(0).refused(Rule::Depth));
        }
        Ok(())
    }

    fn block(&mut self) -> Parsed<Block> {
        self.blocks += 1;
        if self.blocks > MOST_BLOCKS {
            return Err(self.peek(0).refused(Rule::Depth));
        }
        self.expect("{", "`{` was expected")?;
        let mut block = Vec::new();
        while !self.is("}") {
            block.push(self.statement()?);
        }
        self.next += 1;
        self.blocks -= 1;
        Ok(block)
    }

    /// What `if` and the like do: a block, or a statement that is none of its own.
    fn body(&mut self) -> Parsed<Block> {
        if self.is("{") {
            return self.block();
        }
        self.blocks += 1;
        if self.blocks > MOST_BLOCKS {
            return Err(self.peek(0).refused(Rule::Depth));
        }
        if self.is_declaration() {
            return Err(self.peek(0).refused(Rule::Expected("`{` was expected")));
        }
        let statement = self.statement()?;
        self.blocks -= 1;
        Ok(vec![statement])
    }

    fn is_declaration(&self) -> bool {
        self.is("static") || self.is_type(0)
    }

    fn statement(&mut self) -> Parsed<Statement> {
        let token = self.peek(0);
        if self.is("{") {
            return Ok(Statement::Block(self.block()?));
        }
        if self.is_declaration() {
            let outlives = self.accept("static");
            let ctype = self.ctype()?;
            let name = self.name()?;
            return Ok(Statement::Object(self.object(outlives, ctype, name)?));
        }
        if self.accept("if") {
            return self.choice();
        }
        if self.accept("for") {
            return self.repetition();
        }
        if self.accept("switch") {
            return self.selection();
        }
        if self.accept("return") {
            let value = if self.is(";") { None } else { Some(self.expression(0)?) };
            self.expect(";", "`;` was expected")?;
            return Ok(Statement::Return(token.place, value));
        }
        if self.is("break") {
            return Err(token.refused(Rule::Case));
        }
        if self.is("while") || self.is("do") {
            return Err(token.refused(Rule::Loop));
        }
        if self.is(";") {
            let empty = "a statement was expected; an empty one is `{ }`, or nothing";
            return Err(token.refused(Rule::Expected(empty)));
        }
        if self.is("goto") || self.is("continue") {
            let jump = "nothing jumps but `return`, and `break` of a case; use `if` and blocks";
            return Err(token.refused(Rule::Expected(jump)));
        }
        let statement = self.action()?;
        self.expect(";", "`;` was expected")?;
        Ok(statement)
    }

    /// A statement without its `;`.
    fn action(&mut self) -> Parsed<Statement> {
        let left = self.expression(0)?;
        for sign in ["=", "+=", "-="] {
            if self.accept(sign) {
                return Ok(Statement::Assign(left, sign, self.expression(0)?));
            }
        }
        for sign in ["++", "--"] {
            if self.accept(sign) {
                return Ok(Statement::Count(left, sign));
            }
        }
        Ok(Statement::Value(left))
    }

    fn condition(&mut self) -> Parsed<Expression> {
        self.expect("(", "`(` was expected")?;
        let condition = self.expression(0)?;
        self.expect(")", "an operator or `)` was expected")?;
        Ok(condition)
    }

    fn choice(&mut self) -> Parsed<Statement> {
        let mut arms = vec![(self.condition()?, self.body()?)];
        let mut otherwise = None;
        while self.accept("else") {
            if !self.accept("if") {
                otherwise = Some(self.body()?);
                break;
            }
            if arms.len() == MOST_ARMS {
                return Err(self.peek(0).refused(Rule::Depth));
            }
            arms.push((self.condition()?, self.body()?));
        }
        Ok(Statement::If(arms, otherwise))
    }

    fn repetition(&mut self) -> Parsed<Statement> {
        let begin = self.peek(0);
        self.expect("(", "`(` was expected")?;
        if !self.is_type(0) {
            return Err(begin.refused(Rule::Loop));
        }
        let ctype = self.ctype()?;
        let name = self.name()?;
        let counter = self.object(false, ctype, name)?;
        let condition = self.expression(0)?;
        self.expect(";", "`;` was expected")?;
        let step = self.name()?;
        if !self.accept("++") || !self.accept(")") {
            return Err(self.peek(0).refused(Rule::Loop));
        }
        let body = self.body()?;
        Ok(Statement::For(Box::new(For { counter, condition, step, body })))
    }

    fn selection(&mut self) -> Parsed<Statement> {
        let value = self.condition()?;
        self.blocks += 1;
        if self.blocks > MOST_BLOCKS {
            return Err(self.peek(0).refused(Rule::Depth));
        }
        self.expect("{", "`{` was expected")?;
        let mut groups = Vec::new();
        while !self.accept("}") {
            groups.push(self.group()?);
        }
        self.blocks -= 1;
        Ok(Statement::Switch(value, groups))
    }

    fn group(&mut self) -> Parsed<Group> {
        let mut labels = Vec::new();
        loop {
            let place = self.peek(0).place;
            if self.accept("case") {
                labels.push((place, Some(self.expression(0)?)));
            } else if self.accept("default") {
                labels.push((place, None));
            } else {
                break;
            }
            self.expect(":", "`:` was expected")?;
        }
        if labels.is_empty() {
            return Err(self.peek(0).refused(Rule::Case));
        }
        let mut body = Vec::new();
        loop {
            if self.accept("break") {
                self.expect(";", "`;` was expected")?;
                return Ok(Group { labels, body, breaks: true });
            }
            let ends = self.is("case") || self.is("default") || self.is("}");
            if ends && matches!(body.last(), Some(Statement::Return(..))) {
                return Ok(Group { labels, body, breaks: false });
            }
            if ends || self.is_declaration() {
                return Err(self.peek(0).refused(Rule::Case));
            }
            body.push(self.statement()?);
        }
    }

    /// An expression whose operators bind at least as strongly as those of this row.
    fn expression(&mut self, row: usize) -> Parsed<Expression> {
        let mut left = self.prefixed()?;
        loop {
            let found = OPERATORS.iter().enumerate().skip(row).find_map(|(row, operators)| {
                let sign = operators.iter().find(|sign| self.is(sign))?;
                Some((row, *sign))
            });
            let Some((found, sign)) = found else { return Ok(left) };
            let place = self.take().place;
            let right = self.expression(found + 1)?;
            let depth = left.depth.max(right.depth) + 1;
            let what = What::Binary(sign, Box::new(left), Box::new(right));
            left = self.node(what, place, depth)?;
        }
    }

    fn node(&self, what: What, place: Place, depth: u16) -> Parsed<Expression> {
        if depth > MOST_EXPRESSIONS {
            return Err(self.peek(0).refused(Rule::Depth));
        }
        Ok(Expression { what, place, depth })
    }

    fn prefixed(&mut self) -> Parsed<Expression> {
        const PREFIXES: [(&str, Prefix); 4] = [
            ("!", Prefix::Not),
            ("-", Prefix::Minus),
            ("&", Prefix::Address),
            ("*", Prefix::Content),
        ];
        let place = self.peek(0).place;
        if let Some((_, prefix)) = PREFIXES.into_iter().find(|(sign, _)| self.is(sign)) {
            self.deeper()?;
            self.next += 1;
            let operand = self.prefixed()?;
            self.parentheses -= 1;
            let depth = operand.depth + 1;
            return self.node(What::Prefix(prefix, Box::new(operand)), place, depth);
        }
        if self.is("(") && self.is_type(1) {
            self.deeper()?;
            self.next += 1;
            let ctype = self.ctype()?;
            self.expect(")", "`)` was expected")?;
            let operand = self.prefixed()?;
            self.parentheses -= 1;
            let depth = operand.depth + 1;
            return self.node(What::Cast(ctype, Box::new(operand)), place, depth);
        }
        self.postfixed()
    }

    fn postfixed(&mut self) -> Parsed<Expression> {
        let mut left = self.primary()?;
        loop {
            let place = self.peek(0).place;
            let depth = left.depth + 1;
            let what = if self.accept(".") {
                What::Field(Box::new(left), self.name()?.text)
            } else if self.accept("->") {
                What::Arrow(Box::new(left), self.name()?.text)
            } else if self.accept("[") {
                self.deeper()?;
                let index = self.expression(0)?;
                self.parentheses -= 1;
                self.expect("]", "an operator or `]` was expected")?;
                let depth = depth.max(index.depth + 1);
                left = self.node(What::Index(Box::new(left), Box::new(index)), place, depth)?;
                continue;
            } else {
                return Ok(left);
            };
            left = self.node(what, place, depth)?;
        }
    }

    fn primary(&mut self) -> Parsed<Expression> {
        let token = self.peek(0);
        let place = token.place;
        let text = || token.text.to_owned();
        let what = match token.kind {
            Kind::Integer => What::Integer(text()),
            Kind::Float => match float(token.text) {
                Some(number) => What::Float(number),
                None => return Err(token.refused(Rule::Number)),
            },
            Kind::Text => What::Text(text()),
            Kind::Sign if token.text == "(" => {
                self.deeper()?;
                self.next += 1;
                let inner = self.expression(0)?;
                self.parentheses -= 1;
                self.expect(")", "an operator or `)` was expected")?;
                let depth = inner.depth + 1;
                return self.node(What::Parentheses(Box::new(inner)), place, depth);
            }
            Kind::Name if matches!(token.text, "true" | "false") => What::Name(text()),
            Kind::Name if self.is_at(1, "(") => return self.call(),
            Kind::Name => What::Name(self.name().inspect(|_| self.next -= 1)?.text),
            Kind::Sign if matches!(token.text, "++" | "--") => {
                let counted = "counting is a statement of its own: `count++;`";
                return Err(token.refused(Rule::Expected(counted)));
            }
            Kind::Sign | Kind::Line | Kind::End => {
                return Err(token.refused(Rule::Expected("a value was expected")));
            }
        };
        self.next += 1;
        self.node(what, place, 1)
    }

    fn call(&mut self) -> Parsed<Expression> {
        let name = self.name()?;
        let place = name.place;
        self.deeper()?;
        self.next += 1;
        let mut arguments = Vec::new();
        if !self.is(")") {
            arguments.push(self.expression(0)?);
            while self.accept(",") {
                arguments.push(self.expression(0)?);
            }
        }
        self.parentheses -= 1;
        self.expect(")", "`,` or `)` was expected")?;
        let depth = arguments.iter().map(|argument| argument.depth).max().unwrap_or_default() + 1;
        self.node(What::Call(name, arguments), place, depth)
    }
}
