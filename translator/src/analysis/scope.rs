//! The variables of the plan that is being resolved.

use std::collections::{HashMap, HashSet};

use diagnostic::{Diagnostic, Span};

use crate::code::Code;
use crate::program::{Value, Variable, VariableId};
use crate::syntax::ast::{Expression, Name};
use crate::types::CType;

/// Variables, and their visibility.
#[derive(Default)]
pub(super) struct Scope {
    pub(super) variables: Vec<Variable>,
    /// Names whose value could not be resolved, which was reported.
    broken: HashSet<String>,
    /// Number of bindings of each name.
    times: HashMap<String, usize>,
    /// Place of the binding of each variable.
    bound_at: Vec<Span>,
    /// The visible variables, innermost last.
    visible: Vec<(String, VariableId)>,
    /// Types of the queried variables that the plan of a test goal has to bind.
    pub(super) asked: Vec<(String, CType)>,
    /// Names that were bound inside a negation or an alternative and are no longer visible.
    hidden: Vec<String>,
    /// Variables that every branch of an alternative binds: the one visible afterwards, and those of the
    /// branches.
    exports: Vec<(VariableId, Vec<VariableId>)>,
    /// The values that variables have in this branch.
    known: Vec<(VariableId, Value)>,
    /// Variables that decide what is translated, so that the translation need not read them.
    decisive: HashSet<VariableId>,
}

/// An error that is not reported, because it is the consequence of another one.
pub(super) fn said_already() -> Diagnostic {
    Diagnostic::error(String::new(), 0..0)
}

/// Numbers of visible variables and of known values at the start of a negation or an alternative.
#[derive(Clone, Copy)]
pub(super) struct Mark {
    visible: usize,
    known: usize,
}

impl Scope {
    pub(super) fn lookup(&self, name: &str) -> Option<VariableId> {
        self.visible.iter().find(|(visible, _)| visible == name).map(|(_, id)| *id)
    }

    pub(super) fn bind(&mut self, name: &Name, ctype: &CType) -> VariableId {
        let times = self.times.entry(name.text.clone()).or_default();
        *times += 1;
        // In C every variable of a plan has its own name: the generated prefix ends at the first underscore.
        let number = if *times == 1 { String::new() } else { times.to_string() };
        let unique = format!("var{number}_{}", name.text);
        let id = VariableId(self.variables.len());
        self.variables.push(Variable {
            source: name.text.clone(),
            name: unique,
            ctype: ctype.clone(),
            used: false,
        });
        self.bound_at.push(name.span.clone());
        self.visible.push((name.text.clone(), id));
        id
    }

    /// A variable that no formula can name: those of the agent begin with an upper-case letter.
    pub(super) fn bind_unnamed(&mut self, ctype: &CType) -> VariableId {
        let id = VariableId(self.variables.len());
        self.variables.push(Variable {
            source: String::new(),
            name: format!("var_unnamed{}", id.0 + 1),
            ctype: ctype.clone(),
            used: false,
        });
        self.bound_at.push(0..0);
        id
    }

    /// All variables with a value at this place.
    pub(super) fn visible(&self) -> impl Iterator<Item = (Name, VariableId)> {
        self.visible
            .iter()
            .map(|(text, id)| (Name { text: text.clone(), span: self.bound_at[id.0].clone() }, *id))
    }

    /// The variable `name`, which must have a value.
    pub(super) fn bound(&mut self, name: &Name) -> Result<VariableId, Diagnostic> {
        if let Some(id) = self.lookup(&name.text) {
            return Ok(id);
        }
        if self.broken.contains(&name.text) {
            return Err(said_already());
        }
        // A use was intended, so it is not reported as unused.
        for variable in self.variables.iter_mut().filter(|other| other.source == name.text) {
            variable.used = true;
        }
        let message = format!("`{}` has no value here", name.text);
        let error = Code::UnboundVariable.at(message, name.span.clone());
        Err(if self.hidden.contains(&name.text) {
            error.help("it is bound only inside `not`, or not in every branch of `|`")
        } else {
            error.help("bind it in the trigger, in the context, by `?b(X)` or by `X = value`")
        })
    }

    /// The variable would have a value if that could be resolved.
    pub(super) fn break_variable(&mut self, name: &Name) {
        self.broken.insert(name.text.clone());
    }

    /// The variables of an expression with an error would have values: where they are used is no second one.
    pub(super) fn break_unbound(&mut self, expression: &Expression) {
        let mut unbound = Vec::new();
        expression.for_each_variable(&mut |name| {
            if self.lookup(&name.text).is_none() {
                unbound.push(name.text.clone());
            }
        });
        self.broken.extend(unbound);
    }

    /// Whether an expression is unresolved only because of a broken variable.
    pub(super) fn is_broken(&self, expression: &Expression) -> bool {
        let mut broken = false;
        expression.for_each_variable(&mut |name| {
            broken |= self.broken.contains(&name.text) && self.lookup(&name.text).is_none();
        });
        broken
    }

    pub(super) fn mark(&self) -> Mark {
        Mark { visible: self.visible.len(), known: self.known.len() }
    }

    /// The bindings since the mark.
    pub(super) fn bound_since(&self, mark: Mark) -> Vec<(String, VariableId)> {
        self.visible[mark.visible..].to_vec()
    }

    /// Hides the bindings since the mark.
    pub(super) fn leave(&mut self, mark: Mark) {
        let hidden = self.visible.drain(mark.visible..).map(|(name, _)| name);
        self.hidden.extend(hidden);
        self.known.truncate(mark.known);
    }

    /// From here to the end of the branch the variable has this value.
    pub(super) fn know(&mut self, variable: VariableId, value: Value) {
        self.known.push((variable, value));
    }

    /// The value that is known of a variable.
    pub(super) fn known(&self, name: &str) -> Option<&Value> {
        let id = self.lookup(name)?;
        self.known.iter().find(|(known, _)| *known == id).map(|(_, value)| value)
    }

    /// The variable's known value has decided what is translated.
    pub(super) fn decide_by(&mut self, name: &str) {
        let id = self.lookup(name);
        self.decisive.extend(id);
    }

    /// A variable that stands for those of the branches of an alternative.
    pub(super) fn export(&mut self, inner: Vec<VariableId>) -> VariableId {
        let first = inner[0];
        let ctype = self.variables[first.0].ctype.clone();
        let name = Name {
            text: self.variables[first.0].source.clone(),
            span: self.bound_at[first.0].clone(),
        };
        let outer = self.bind(&name, &ctype);
        self.exports.push((outer, inner));
        outer
    }

    /// Variables that every branch binds to values of one type are visible afterwards.
    pub(super) fn exports(
        &mut self,
        bound: &[Vec<(String, VariableId)>],
    ) -> Vec<(VariableId, Vec<VariableId>)> {
        let Some((first, others)) = bound.split_first() else { return Vec::new() };
        let mut exports = Vec::new();
        for (name, id) in first {
            let ctype = self.variables[id.0].ctype.clone();
            let same = |(other, other_id): &&(String, VariableId)| {
                other == name && self.variables[other_id.0].ctype == ctype
            };
            let inner: Option<Vec<VariableId>> =
                others.iter().map(|branch| branch.iter().find(same).map(|(_, id)| *id)).collect();
            // A variable that is assigned in branches needs an initial value.
            if let Some(inner) = inner.filter(|_| ctype.zero().is_some()) {
                let inner: Vec<VariableId> = std::iter::once(*id).chain(inner).collect();
                exports.push((self.export(inner.clone()), inner));
            }
        }
        exports
    }

    /// Propagates uses from exported variables to those of the branches. To be called at the end of the plan.
    pub(super) fn settle(&mut self) {
        // A variable is always created after those that it stands for.
        for (outer, inner) in self.exports.iter().rev() {
            if self.variables[outer.0].used {
                for id in inner {
                    self.variables[id.0].used = true;
                }
            }
        }
    }

    /// Unused variables.
    pub(super) fn unused(&self) -> impl Iterator<Item = (&str, &Span)> {
        let exported = |index| self.exports.iter().any(|(outer, _)| outer.0 == index);
        self.variables
            .iter()
            .zip(&self.bound_at)
            .enumerate()
            .filter(move |(index, (variable, _))| {
                let used = variable.used || self.decisive.contains(&VariableId(*index));
                !used && !variable.source.is_empty() && !exported(*index)
            })
            .map(|(_, pair)| pair)
            .map(|(variable, span)| (variable.source.as_str(), span))
    }
}
