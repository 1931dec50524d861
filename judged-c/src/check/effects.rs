//! Which functions can change what others read, and that none calls itself.

use std::collections::{HashMap, HashSet, VecDeque};

use crate::language::{Language, Owner};
use crate::lexer::refused;
use crate::refused::{Refused, Rule};
use crate::tree::{Block, Expression, Function, Item, Object, Statement, Unit, What};

/// Functions on a way of calls. What is generated has as many as goals are inside each other.
const MOST_CALLS: usize = 200;

/// What a function does by itself.
#[derive(Default)]
struct Doing<'a> {
    locals: HashSet<&'a str>,
    called: HashSet<&'a str>,
    /// It changes something that outlives it.
    changes: bool,
}

/// The functions of a file that can change something, or call the environment, which can do anything.
pub(crate) fn effects(unit: &Unit, language: &Language) -> Result<HashSet<String>, Refused> {
    let mut functions: HashMap<&str, (&Function, Doing<'_>)> = HashMap::new();
    for item in &unit.items {
        let Item::Function(function) = item else { continue };
        let Some(body) = &function.body else { continue };
        let mut doing = Doing::default();
        let parameters = function.parameters.iter().filter_map(|parameter| parameter.name.as_ref());
        doing.locals.extend(parameters.map(|name| name.text.as_str()));
        doing.block(body);
        functions.insert(&function.name.text, (function, doing));
    }
    let mut effectful: HashSet<String> = HashSet::new();
    for (name, (owner, _)) in &language.functions {
        if *owner == Owner::Environment {
            effectful.insert(name.clone());
        }
    }
    let mut callers: HashMap<&str, Vec<&str>> = HashMap::new();
    let mut waiting: HashMap<&str, usize> = HashMap::new();
    for (name, (_, doing)) in &functions {
        let own = doing.called.iter().filter(|called| functions.contains_key(**called));
        waiting.insert(name, own.clone().count());
        own.for_each(|called| callers.entry(called).or_default().push(name));
    }
    // A function is known when all that it calls are: who calls itself never is. Each has the length of its longest way.
    let begin = waiting.iter().filter(|(_, count)| **count == 0);
    let mut ready: VecDeque<(&str, usize)> = begin.map(|(name, _)| (*name, 1)).collect();
    while let Some((name, length)) = ready.pop_front() {
        let (function, doing) = &functions[name];
        if length > MOST_CALLS {
            return Err(refused(name, function.name.place, Rule::Calls));
        }
        if doing.changes || doing.called.iter().any(|called| effectful.contains(*called)) {
            effectful.insert(name.to_owned());
        }
        for caller in callers.get(name).into_iter().flatten() {
            let Some(count) = waiting.get_mut(caller) else { continue };
            *count -= 1;
            if *count == 0 {
                // The last one of those it calls is one with the longest way: they come by length.
                ready.push_back((caller, length + 1));
            }
        }
    }
    let recursive = functions.iter().filter(|(name, _)| waiting[*name] > 0);
    match recursive.map(|(_, (function, _))| &function.name).min_by_key(|name| name.place.line) {
        Some(name) => Err(refused(&name.text, name.place, Rule::Recursion)),
        None => Ok(effectful),
    }
}

impl<'a> Doing<'a> {
    fn block(&mut self, block: &'a Block) {
        for statement in block {
            self.statement(statement);
        }
    }

    fn object(&mut self, object: &'a Object) {
        if !object.outlives {
            self.locals.insert(&object.name.text);
        }
        if let Some(initial) = &object.initial {
            self.expression(initial);
        }
    }

    fn change(&mut self, place: &'a Expression) {
        let is_local = matches!(root(place), Some(name) if self.locals.contains(name));
        self.changes |= !is_local;
        self.expression(place);
    }

    fn statement(&mut self, statement: &'a Statement) {
        match statement {
            Statement::Block(block) => self.block(block),
            Statement::Object(object) => self.object(object),
            Statement::Assign(place, _, value) => {
                self.change(place);
                self.expression(value);
            }
            Statement::Count(place, _) => self.change(place),
            Statement::Value(value) | Statement::Return(_, Some(value)) => self.expression(value),
            Statement::Return(_, None) => {}
            Statement::If(arms, otherwise) => {
                for (condition, block) in arms {
                    self.expression(condition);
                    self.block(block);
                }
                if let Some(block) = otherwise {
                    self.block(block);
                }
            }
            Statement::For(repeated) => {
                self.expression(&repeated.condition);
                self.block(&repeated.body);
            }
            Statement::Switch(value, groups) => {
                self.expression(value);
                for group in groups {
                    self.block(&group.body);
                }
            }
        }
    }

    fn expression(&mut self, expression: &'a Expression) {
        if let What::Call(name, _) = &expression.what {
            self.called.insert(&name.text);
        }
        operands(expression).for_each(|operand| self.expression(operand));
    }
}

/// The expressions directly inside another one.
pub(crate) fn operands(expression: &Expression) -> impl Iterator<Item = &Expression> {
    let (first, second, rest): (Option<&Expression>, Option<&Expression>, &[Expression]) =
        match &expression.what {
            What::Name(_) | What::Integer(_) | What::Float(_) | What::Text(_) => (None, None, &[]),
            What::Prefix(_, inner)
            | What::Parentheses(inner)
            | What::Cast(_, inner)
            | What::Field(inner, _)
            | What::Arrow(inner, _) => (Some(inner), None, &[]),
            What::Binary(_, left, right) | What::Index(left, right) => {
                (Some(left), Some(right), &[])
            }
            What::Call(_, inner) | What::Braces(inner) => (None, None, inner),
        };
    first.into_iter().chain(second).chain(rest)
}

/// The variable of which a place is a part; `None` for what is behind a pointer.
pub(crate) fn root(place: &Expression) -> Option<&str> {
    match &place.what {
        What::Name(name) => Some(name),
        What::Parentheses(inner) | What::Field(inner, _) | What::Index(inner, _) => root(inner),
        _ => None,
    }
}
