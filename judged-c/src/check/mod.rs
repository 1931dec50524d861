//! The rules of the language: names, types, the order of effects, and ways through functions.

mod effects;
mod expression;
mod statement;

use std::collections::{BTreeMap, HashMap, HashSet};

use translator::types::TypeKind;

use self::effects::effects;
pub(crate) use self::effects::operands;
use crate::language::{Language, Owner, Signature};
use crate::lexer::{Place, refused};
use crate::refused::{Refused, Rule};
use crate::tree::{Expression, Function, Item, Object, Unit, What, Word};
use crate::types::{Ty, Typed, is_kept, listed_macro};

pub(crate) type Checked<T> = Result<T, Refused>;

/// Words of the language that are no names: a macro of one of them would change it.
const WORDS: [&str; 26] = [
    "static", "const", "typedef", "struct", "enum", "if", "else", "for", "switch", "case",
    "default", "break", "return", "void", "bool", "_Bool", "true", "false", "char", "short", "int",
    "long", "signed", "unsigned", "float", "double",
];

/// Elements of an array: each is made arbitrary by a statement of its own.
const MOST_ELEMENTS: u64 = 1024;

/// Refuses a word unless a condition holds.
pub(crate) fn require(holds: bool, found: &str, place: Place, rule: Rule) -> Checked<()> {
    if holds { Ok(()) } else { Err(refused(found, place, rule)) }
}

/// An object that has been declared.
#[derive(Debug, Clone)]
struct Variable {
    ty: Ty,
    /// It is `const`, a parameter, or a loop's counter: its value stays the same.
    constant: bool,
    /// It outlives calls.
    outlives: bool,
}

/// A function of the file.
#[derive(Debug, Clone)]
struct Own {
    signature: Signature,
    place: Place,
    is_defined: bool,
}

struct Checker<'a> {
    language: &'a Language,
    /// Macros that included headers define, or could.
    macros: &'a HashSet<String>,
    effects: HashSet<String>,
    functions: HashMap<String, Own>,
    /// Variables by their scope, the file's first.
    scopes: Vec<HashMap<String, Variable>>,
    /// The result of the current function.
    result: Ty,
    /// Names that are declared in the current function, and whether it is a static object.
    declared: HashMap<String, bool>,
    /// Names of the file and their first places.
    names: BTreeMap<String, Place>,
    floats: Floats,
}

/// Places of operators on floating-point numbers, with the type of both operands.
pub(crate) type Floats = HashMap<Place, TypeKind>;

/// What is known of a file of the language.
pub(crate) struct Known {
    /// Names in it, which the preprocessor must not know, and their first places.
    pub(crate) names: BTreeMap<String, Place>,
    pub(crate) floats: Floats,
}

/// Checks a file.
pub(crate) fn check(unit: &Unit, language: &Language, macros: &HashSet<String>) -> Checked<Known> {
    for (index, line) in unit.lines.iter().enumerate() {
        let same = language.lines.get(index) == Some(&line.text);
        require(same, &line.text, line.place, Rule::Preprocessor)?;
    }
    let all = unit.lines.len() == language.lines.len();
    require(all, "the begin", Place { line: 1, column: 1 }, Rule::Includes)?;
    for word in WORDS {
        require(!macros.contains(word), word, Place { line: 1, column: 1 }, Rule::Macro)?;
    }
    language.check_definitions(unit)?;
    let effects = effects(unit, language)?;
    let mut checker = Checker {
        language,
        macros,
        effects,
        functions: HashMap::new(),
        scopes: vec![HashMap::new()],
        result: Ty::Void,
        declared: HashMap::new(),
        names: BTreeMap::new(),
        floats: Floats::new(),
    };
    for item in &unit.items {
        checker.item(item)?;
    }
    checker.end(unit.end)?;
    let words = WORDS.into_iter().filter(|word| !matches!(*word, "bool" | "true" | "false"));
    checker.names.extend(words.map(|word| (word.to_owned(), Place::default())));
    Ok(Known { names: checker.names, floats: checker.floats })
}

/// Names of the comparison's own: its functions, variables and macros, and the state that it passes.
fn is_of_comparison(name: &str) -> bool {
    ["plain", "PLAIN", "asl2c", "ASL2C"].iter().any(|first| {
        name == *first || name.strip_prefix(first).is_some_and(|rest| rest.starts_with('_'))
    })
}

impl Checker<'_> {
    fn item(&mut self, item: &Item) -> Checked<()> {
        match item {
            // They are the generated ones.
            Item::Definition(..) => Ok(()),
            Item::Object(object) => self.object(object),
            Item::Function(function) => self.function(function),
        }
    }

    /// What must be there in the end.
    fn end(&mut self, end: Place) -> Checked<()> {
        let mut missing: Vec<(&String, &Own)> =
            self.functions.iter().filter(|(_, own)| !own.is_defined).collect();
        missing.sort_by_key(|(name, _)| *name);
        if let Some((name, own)) = missing.first() {
            return Err(refused(name, own.place, Rule::Undefined));
        }
        for name in self.language.interface() {
            require(self.functions.contains_key(name), name, end, Rule::Missing)?;
        }
        for name in self.language.state.keys() {
            require(self.scopes[0].contains_key(name), name, end, Rule::State)?;
        }
        Ok(())
    }

    /// Keeps a name that stands in the file.
    fn name(&mut self, name: &str, place: Place) -> Checked<()> {
        require(!self.macros.contains(name), name, place, Rule::Macro)?;
        if !self.names.contains_key(name) {
            self.names.insert(name.to_owned(), place);
        }
        Ok(())
    }

    /// Whether a new name may be given.
    fn fresh(&mut self, word: &Word, is_function: bool) -> Checked<()> {
        let Word { text, place } = word;
        let reserved = translator::is_c_word(text) || is_function && translator::is_c_library(text);
        require(!reserved, text, *place, Rule::Reserved)?;
        require(!is_of_comparison(text), text, *place, Rule::Comparison)?;
        let language = self.language;
        let known = language.functions.contains_key(text)
            || language.enumerators.contains_key(text)
            || language.constants.contains_key(text)
            || language.types().contains(text)
            || self.functions.contains_key(text)
            || self.scopes.iter().any(|scope| scope.contains_key(text));
        require(!known, text, *place, Rule::Declared)?;
        self.name(text, *place)
    }

    fn declare(&mut self, word: &Word, variable: Variable) -> Checked<()> {
        let is_state = self.scopes.len() == 1 && self.language.state.contains_key(&word.text);
        if is_state {
            require(
                !self.scopes[0].contains_key(&word.text),
                &word.text,
                word.place,
                Rule::Declared,
            )?;
            self.name(&word.text, word.place)?;
        } else {
            self.fresh(word, false)?;
        }
        // A static object of a function is printed outside of it, under a name of its own.
        let kept = self.declared.get(&word.text).copied();
        let twice = kept.is_some_and(|kept| kept || variable.outlives);
        require(!twice, &word.text, word.place, Rule::Declared)?;
        self.declared.insert(word.text.clone(), variable.outlives);
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(word.text.clone(), variable);
        }
        Ok(())
    }

    fn variable(&self, name: &str) -> Option<&Variable> {
        self.scopes.iter().rev().find_map(|scope| scope.get(name))
    }

    /// A declaration of an object, with its initial value.
    fn object(&mut self, object: &Object) -> Checked<()> {
        let Object { outlives, ctype, name, length, initial } = object;
        let named = self.language.named(ctype)?;
        self.type_names(ctype)?;
        let place = name.place;
        let constant =
            if ctype.stars.is_empty() { ctype.constant } else { ctype.stars.last() == Some(&true) };
        require(named.ty != Ty::Void, &name.text, place, Rule::Type)?;
        let pointer = matches!(named.ty, Ty::Pointer { .. });
        require(!pointer, &name.text, place, Rule::Pointer)?;
        let mut ty = named.ty;
        if let Some(state) = self.language.state.get(&name.text).filter(|_| self.scopes.len() == 1)
        {
            let same =
                *outlives && !constant && length.is_none() && initial.is_none() && *state == ty;
            require(same, &name.text, place, Rule::State)?;
            return self.declare(name, Variable { ty, constant: false, outlives: true });
        }
        if let Some(length) = length {
            let number = length
                .text
                .parse::<u64>()
                .ok()
                .filter(|number| (1..=MOST_ELEMENTS).contains(number));
            require(*outlives && number.is_some(), &length.text, length.place, Rule::Array)?;
            ty = Ty::Array(Box::new(ty), number.unwrap_or(1));
        }
        let Some(initial) = initial else {
            return Err(refused(&name.text, place, Rule::Initial));
        };
        if *outlives {
            self.constant(initial)?;
        }
        // Before the name is known: it is not its own initial value.
        self.initial(initial, &ty)?;
        self.declare(name, Variable { ty, constant, outlives: *outlives })
    }

    /// An initial value fits.
    fn initial(&mut self, initial: &Expression, ty: &Ty) -> Checked<()> {
        let What::Braces(values) = &initial.what else {
            let value = self.expression(initial)?;
            return self.kept(initial, &value, ty);
        };
        let mismatch = || refused("{", initial.place, Rule::Mismatch);
        if let Ty::Array(of, length) = ty {
            require(values.len() as u64 == *length, "{", initial.place, Rule::Mismatch)?;
            return values.iter().try_for_each(|value| self.initial(value, of));
        }
        let is_zero = matches!(values.as_slice(), [Expression { what: What::Integer(zero), .. }] if zero == "0");
        match ty {
            // `{ 0 }` initializes any type.
            Ty::Struct(_) | Ty::Opaque(_) if is_zero => Ok(()),
            Ty::Struct(name) => {
                let fields = self.language.structs.get(name).ok_or_else(mismatch)?.clone();
                require(values.len() == fields.len(), "{", initial.place, Rule::Mismatch)?;
                values.iter().zip(fields).try_for_each(|(value, (_, ty))| self.initial(value, &ty))
            }
            _ => Err(mismatch()),
        }
    }

    /// It is a constant expression.
    fn constant(&self, initial: &Expression) -> Checked<()> {
        let constant = match &initial.what {
            What::Name(name) => {
                let language = self.language;
                listed_macro(name).is_some()
                    || language.enumerators.contains_key(name)
                    || language.constants.contains_key(name)
            }
            What::Integer(_)
            | What::Float(_)
            | What::Text(_)
            | What::Prefix(crate::tree::Prefix::Minus | crate::tree::Prefix::Not, _)
            | What::Binary(..)
            | What::Parentheses(_)
            | What::Braces(_) => true,
            _ => false,
        };
        require(constant, "=", initial.place, Rule::Constant)?;
        operands(initial).try_for_each(|operand| self.constant(operand))
    }

    /// A value can be kept in a place of this type.
    fn kept(&self, from: &Expression, value: &Typed, ty: &Ty) -> Checked<()> {
        let is_text = matches!(inner(from).what, What::Text(_)) && self.language.is_text(ty);
        require(is_text || is_kept(value, ty), &shown(from), from.place, Rule::Mismatch)
    }

    /// The names in a type are no macros.
    fn type_names(&mut self, ctype: &crate::tree::Type) -> Checked<()> {
        for word in ctype.words.iter().flat_map(|words| words.split(' ')) {
            require(!self.macros.contains(word), word, ctype.place, Rule::Macro)?;
        }
        Ok(())
    }

    fn function(&mut self, function: &Function) -> Checked<()> {
        let Function { is_static, result, name, parameters, body } = function;
        let Word { text, place } = name;
        let signature = self.language.signature(function)?;
        self.type_names(result)?;
        let returns_pointer = matches!(signature.result.ty, Ty::Pointer { .. });
        require(!returns_pointer, text, *place, Rule::Pointer)?;
        let outside = self.language.functions.get(text);
        match outside {
            Some((Owner::Interface, declared)) => {
                require(!is_static && body.is_some(), text, *place, Rule::Static)?;
                require(*declared == signature, text, *place, Rule::Signature)?;
                require(!self.functions.contains_key(text), text, *place, Rule::Declared)?;
                self.name(text, *place)?;
            }
            Some((Owner::Environment, _)) => return Err(refused(text, *place, Rule::Declared)),
            None => {
                require(*is_static, text, *place, Rule::Static)?;
                match self.functions.get(text) {
                    Some(own) => {
                        require(own.signature == signature, text, *place, Rule::Signature)?;
                        require(!own.is_defined || body.is_none(), text, *place, Rule::Declared)?;
                    }
                    None => self.fresh(name, true)?,
                }
            }
        }
        let is_defined =
            self.functions.get(text).is_some_and(|own| own.is_defined) || body.is_some();
        self.functions
            .insert(text.clone(), Own { signature: signature.clone(), place: *place, is_defined });
        self.declared.clear();
        self.scopes.push(HashMap::new());
        for (parameter, named) in parameters.iter().zip(&signature.parameters) {
            self.type_names(&parameter.ctype)?;
            require(named.ty != Ty::Void, text, *place, Rule::Type)?;
            match &parameter.name {
                Some(word) => {
                    let variable =
                        Variable { ty: named.ty.clone(), constant: true, outlives: false };
                    self.declare(word, variable)?;
                }
                None => {
                    require(body.is_none(), text, *place, Rule::Expected("a name was expected"))?;
                }
            }
        }
        if let Some(body) = body {
            self.result = signature.result.ty;
            let returns = self.statements(body)?;
            require(returns || self.result == Ty::Void, text, *place, Rule::Return)?;
        }
        self.scopes.pop();
        Ok(())
    }
}

/// An expression without the parentheses around it.
fn inner(expression: &Expression) -> &Expression {
    match &expression.what {
        What::Parentheses(inside) => inner(inside),
        _ => expression,
    }
}

/// A word for an expression in a message.
fn shown(expression: &Expression) -> String {
    match &expression.what {
        What::Name(text) | What::Integer(text) | What::Float(text) | What::Text(text) => {
            text.clone()
        }
        What::Call(name, _) => name.text.clone(),
        What::Binary(sign, ..) => (*sign).to_owned(),
        What::Field(_, name) | What::Arrow(_, name) => name.clone(),
        What::Prefix(..) | What::Parentheses(_) | What::Cast(..) => "(".to_owned(),
        What::Index(..) => "[".to_owned(),
        What::Braces(_) => "{".to_owned(),
    }
}
