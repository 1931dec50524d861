//! C from its tree: what is compared and executed is this, and never the text that was given.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::fmt::Write as _;

use translator::{float_function, float_operators};

use crate::check::Floats;
use crate::language::Language;
use crate::tree::{
    Block, Definition, Expression, Function, Item, Object, Parameter, Prefix, Statement, Type,
    Unit, What,
};
use crate::types::Ty;

/// A function of CBMC's that asserts that an index is inside an array of this length, in one line. CBMC 6 checks an index of an
/// array in a struct that a pointer leads to against the end of the whole struct.
pub const CHECKED_INDEX: &str = "static unsigned long long plain_index(unsigned long long plain_i, unsigned long long plain_n) \
    { __CPROVER_assert(plain_i < plain_n, \"a possible error at run time: an index is outside its array\"); return plain_i; }";

/// The text of a file, and statements that make its state arbitrary, but for that which is generated. To be `compared`, it has
/// checks of indices, which compilers leave out, and functions in place of these operators: it is no longer of the language.
pub(crate) fn print(
    unit: &Unit,
    language: &Language,
    compared: Option<&Floats>,
) -> (String, String) {
    let mut printer = Printer {
        language,
        compared,
        taken: names(unit),
        renamed: HashMap::new(),
        text: String::new(),
        arbitrary: String::new(),
    };
    for line in &unit.lines {
        _ = writeln!(printer.text, "{}", line.text);
    }
    if compared.is_some() {
        _ = writeln!(
            printer.text,
            "#ifdef __CPROVER__\n{CHECKED_INDEX}\n#else\n#define plain_index(plain_i, plain_n) (plain_i)\n{}#endif",
            float_operators()
        );
    }
    for item in &unit.items {
        printer.text.push('\n');
        printer.item(item);
    }
    (printer.text, printer.arbitrary)
}

struct Printer<'a> {
    language: &'a Language,
    compared: Option<&'a Floats>,
    /// All names of the file.
    taken: BTreeSet<String>,
    /// Static objects of the current function, which are printed outside of it.
    renamed: HashMap<String, String>,
    text: String,
    arbitrary: String,
}

/// Names that a new one must not be.
fn names(unit: &Unit) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for item in &unit.items {
        match item {
            Item::Definition(name, Definition::Enum(of)) => {
                names.extend(of.iter().chain([name]).map(|word| word.text.clone()));
            }
            Item::Definition(name, Definition::Struct(_)) => _ = names.insert(name.text.clone()),
            Item::Object(object) => _ = names.insert(object.name.text.clone()),
            Item::Function(function) => {
                names.insert(function.name.text.clone());
                let parameters = function.parameters.iter().filter_map(|p| p.name.as_ref());
                names.extend(parameters.map(|name| name.text.clone()));
                if let Some(body) = &function.body {
                    declared(body, &mut |object| {
                        names.insert(object.name.text.clone());
                    });
                }
            }
        }
    }
    names
}

/// Calls this for all objects that a block declares.
fn declared<'a>(block: &'a Block, each: &mut impl FnMut(&'a Object)) {
    for statement in block {
        match statement {
            Statement::Block(block) => declared(block, each),
            Statement::Object(object) => each(object),
            Statement::If(arms, otherwise) => {
                for (_, block) in arms {
                    declared(block, each);
                }
                if let Some(block) = otherwise {
                    declared(block, each);
                }
            }
            Statement::For(repeated) => {
                each(&repeated.counter);
                declared(&repeated.body, each);
            }
            Statement::Switch(_, groups) => {
                for group in groups {
                    declared(&group.body, each);
                }
            }
            Statement::Assign(..)
            | Statement::Count(..)
            | Statement::Value(_)
            | Statement::Return(..) => {}
        }
    }
}

impl Printer<'_> {
    fn item(&mut self, item: &Item) {
        match item {
            Item::Definition(name, Definition::Enum(names)) => {
                let names: Vec<&str> = names.iter().map(|name| name.text.as_str()).collect();
                let names = names.join(",\n    ");
                _ = writeln!(self.text, "typedef enum\n{{\n    {names}\n}} {};", name.text);
            }
            Item::Definition(name, Definition::Struct(fields)) => {
                self.text.push_str("typedef struct\n{\n");
                for (ctype, field, length) in fields {
                    let length = length
                        .as_ref()
                        .map_or(String::new(), |length| format!("[{}]", length.text));
                    _ = writeln!(self.text, "    {}{length};", typed(ctype, &field.text));
                }
                _ = writeln!(self.text, "}} {};", name.text);
            }
            Item::Object(object) => self.kept(object, &object.name.text),
            Item::Function(function) => self.function(function),
        }
    }

    /// A static object, which is also made arbitrary.
    fn kept(&mut self, object: &Object, name: &str) {
        let declaration = self.declaration(object, name);
        _ = writeln!(self.text, "static {declaration}");
        let ctype = &object.ctype;
        let constant =
            ctype.constant && ctype.stars.is_empty() || ctype.stars.last() == Some(&true);
        if constant || self.language.state.contains_key(&object.name.text) {
            return;
        }
        // The type has been checked.
        let Ok(named) = self.language.named(ctype) else { return };
        let length = object.length.as_ref().and_then(|length| length.text.parse().ok());
        let ty = length.map_or(named.ty.clone(), |length| Ty::Array(Box::new(named.ty), length));
        arbitrary(&mut self.arbitrary, self.language, name, &ty);
    }

    fn declaration(&self, object: &Object, name: &str) -> String {
        let length =
            object.length.as_ref().map_or(String::new(), |length| format!("[{}]", length.text));
        let initial = object.initial.as_ref();
        let initial =
            initial.map_or(String::new(), |value| format!(" = {}", self.expression(value)));
        format!("{}{length}{initial};", typed(&object.ctype, name))
    }

    fn function(&mut self, function: &Function) {
        let Function { is_static, result, name, parameters, body } = function;
        self.renamed.clear();
        if let Some(body) = body {
            let mut kept = Vec::new();
            declared(body, &mut |object| kept.extend(object.outlives.then_some(object)));
            for object in kept {
                let mut new = format!("{}_{}", name.text, object.name.text);
                while self.taken.contains(&new) {
                    new.push('_');
                }
                self.taken.insert(new.clone());
                self.kept(object, &new);
                self.renamed.insert(object.name.text.clone(), new);
            }
        }
        let parameter = |parameter: &Parameter| {
            let name = parameter.name.as_ref().map_or("", |name| &name.text);
            typed(&parameter.ctype, name)
        };
        let parameters: Vec<String> = parameters.iter().map(parameter).collect();
        let parameters =
            if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") };
        let storage = if *is_static { "static " } else { "" };
        let head = typed(result, &format!("{}({parameters})", name.text));
        _ = write!(self.text, "{storage}{head}");
        match body {
            Some(body) => {
                self.text.push('\n');
                self.block(body, 0);
            }
            None => self.text.push_str(";\n"),
        }
    }

    fn line(&mut self, depth: usize, line: &str) {
        _ = writeln!(self.text, "{:1$}{line}", "", depth * 4);
    }

    fn block(&mut self, block: &Block, depth: usize) {
        self.line(depth, "{");
        for statement in block {
            self.statement(statement, depth + 1);
        }
        self.line(depth, "}");
    }

    fn statement(&mut self, statement: &Statement, depth: usize) {
        match statement {
            Statement::Block(block) => self.block(block, depth),
            // It stands outside.
            Statement::Object(object) if object.outlives => {}
            Statement::Object(object) => {
                let declaration = self.declaration(object, &object.name.text);
                self.line(depth, &declaration);
            }
            Statement::Assign(place, sign, value) => {
                let (place, value) = (self.expression(place), self.expression(value));
                self.line(depth, &format!("{place} {sign} {value};"));
            }
            Statement::Count(place, sign) => {
                let place = self.expression(place);
                self.line(depth, &format!("{place}{sign};"));
            }
            Statement::Value(value) => {
                let value = self.expression(value);
                self.line(depth, &format!("{value};"));
            }
            Statement::If(arms, otherwise) => {
                for (index, (condition, block)) in arms.iter().enumerate() {
                    let word = if index == 0 { "if" } else { "else if" };
                    let condition = self.expression(condition);
                    self.line(depth, &format!("{word} ({condition})"));
                    self.block(block, depth);
                }
                if let Some(block) = otherwise {
                    self.line(depth, "else");
                    self.block(block, depth);
                }
            }
            Statement::For(repeated) => {
                let counter = self.declaration(&repeated.counter, &repeated.counter.name.text);
                let condition = self.expression(&repeated.condition);
                self.line(depth, &format!("for ({counter} {condition}; {}++)", repeated.step.text));
                self.block(&repeated.body, depth);
            }
            Statement::Switch(value, groups) => {
                let value = self.expression(value);
                self.line(depth, &format!("switch ({value})"));
                self.line(depth, "{");
                for group in groups {
                    for (_, label) in &group.labels {
                        let label = label.as_ref().map(|label| self.expression(label));
                        let label =
                            label.map_or("default:".to_owned(), |label| format!("case {label}:"));
                        self.line(depth + 1, &label);
                    }
                    for statement in &group.body {
                        self.statement(statement, depth + 2);
                    }
                    if group.breaks {
                        self.line(depth + 2, "break;");
                    }
                }
                self.line(depth, "}");
            }
            Statement::Return(_, value) => {
                let value = value
                    .as_ref()
                    .map_or(String::new(), |value| format!(" {}", self.expression(value)));
                self.line(depth, &format!("return{value};"));
            }
        }
    }

    fn expression(&self, expression: &Expression) -> String {
        let list = |of: &[Expression]| {
            of.iter().map(|value| self.expression(value)).collect::<Vec<_>>().join(", ")
        };
        match &expression.what {
            What::Name(name) => self.renamed.get(name).unwrap_or(name).clone(),
            What::Integer(text) | What::Float(text) | What::Text(text) => text.clone(),
            What::Prefix(prefix, operand) => {
                let sign = match prefix {
                    Prefix::Not => "!",
                    Prefix::Minus => "-",
                    Prefix::Address => "&",
                    Prefix::Content => "*",
                };
                let operand = self.expression(operand);
                // Two signs would be another one.
                let blank = if operand.starts_with(sign) { " " } else { "" };
                format!("{sign}{blank}{operand}")
            }
            What::Binary(sign, left, right) => {
                let (left, right) = (self.expression(left), self.expression(right));
                let kind = self.compared.and_then(|floats| floats.get(&expression.place));
                match kind.and_then(|kind| float_function(sign, *kind)) {
                    Some(function) => format!("{function}({left}, {right})"),
                    None => format!("{left} {sign} {right}"),
                }
            }
            What::Parentheses(inside) => format!("({})", self.expression(inside)),
            What::Cast(ctype, operand) => {
                format!("({}){}", typed(ctype, "").trim_end(), self.expression(operand))
            }
            What::Call(name, arguments) => format!("{}({})", name.text, list(arguments)),
            What::Field(of, name) => format!("{}.{name}", self.expression(of)),
            What::Arrow(of, name) => format!("{}->{name}", self.expression(of)),
            What::Index(of, index) => {
                let (of, number) = (self.expression(of), self.expression(index));
                // A number is known to be inside.
                if self.compared.is_some() && !matches!(index.what, What::Integer(_)) {
                    format!("{of}[plain_index({number}, sizeof ({of}) / sizeof ({of}[0]))]")
                } else {
                    format!("{of}[{number}]")
                }
            }
            What::Braces(values) => format!("{{ {} }}", list(values)),
        }
    }
}

/// `const char *const name`
fn typed(ctype: &Type, name: &str) -> String {
    let constant = if ctype.constant { "const " } else { "" };
    let stars: String =
        ctype.stars.iter().map(|constant| if *constant { "*const " } else { "*" }).collect();
    format!("{constant}{} {stars}{name}", ctype.words.join(" "))
}

/// Statements that give any value of its type to a place.
fn arbitrary(text: &mut String, language: &Language, place: &str, ty: &Ty) {
    let name = match ty {
        Ty::Array(of, length) => {
            return (0..*length)
                .for_each(|index| arbitrary(text, language, &format!("{place}[{index}]"), of));
        }
        Ty::Struct(name) => {
            for (field, ty) in language.structs.get(name).into_iter().flatten() {
                arbitrary(text, language, &format!("{place}.{field}"), ty);
            }
            return;
        }
        Ty::Bool => {
            _ = writeln!(
                text,
                "    {{ bool any; __CPROVER_assume(any == 0 || any == 1); {place} = any; }}"
            );
            return;
        }
        Ty::Text => {
            _ = writeln!(text, "    {{ unsigned char which; {place} = &plain_texts[which]; }}");
            return;
        }
        Ty::Integer { bits, signed } => format!("{}int{bits}_t", if *signed { "" } else { "u" }),
        Ty::Float32 => "float".to_owned(),
        Ty::Float64 => "double".to_owned(),
        Ty::Enum(name) | Ty::Opaque(name) => name.clone(),
        Ty::Pointer { to, .. } => format!("{} *", to.name),
        Ty::Void => return,
    };
    _ = writeln!(text, "    {{ {name} any; {place} = any; }}");
}

/// Names of the macros that a header's text defines, or would if other conditions held.
pub fn macros(header: &str) -> HashSet<String> {
    let text = header.replace("??/", "\\").replace('\r', "");
    // Lines are joined first, also with blanks behind the sign, as compilers do.
    let mut joined = String::with_capacity(text.len());
    for line in text.lines() {
        if let Some(begun) = line.trim_end().strip_suffix('\\') {
            joined.push_str(begun);
        } else {
            joined.push_str(line);
            joined.push('\n');
        }
    }
    let plain = without_comments(&joined);
    let mut names = HashSet::new();
    for text in [&joined, &plain] {
        let mut words = text
            .split(|c: char| !c.is_alphanumeric() && c != '_' && c != '$')
            .filter(|word| !word.is_empty());
        while let Some(word) = words.next() {
            if word == "define" {
                names.extend(words.clone().next().map(str::to_owned));
            }
        }
    }
    names
}

/// The words of C that it uses outside of comments.
pub fn words(text: &str) -> HashSet<String> {
    let plain = without_comments(text);
    let words = plain.split(|c: char| !c.is_alphanumeric() && c != '_' && c != '$');
    words.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// A text with blanks for comments.
fn without_comments(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    let mut quote = None;
    while let Some(character) = rest.chars().next() {
        let mut length = character.len_utf8();
        if quote.is_none() && (rest.starts_with("/*") || rest.starts_with("//")) {
            let end = if rest.starts_with("/*") { "*/" } else { "\n" };
            length = rest[2..].find(end).map_or(rest.len(), |at| at + 2 + end.len());
            plain.push(if end == "\n" { '\n' } else { ' ' });
        } else {
            match (quote, character) {
                (_, '\n') => quote = None,
                (Some(_), '\\') => length += rest[1..].chars().next().map_or(0, char::len_utf8),
                (Some(begun), _) if begun == character => quote = None,
                (None, '"' | '\'') => quote = Some(character),
                _ => {}
            }
            plain.push_str(&rest[..length]);
        }
        rest = &rest[length..];
    }
    plain
}
