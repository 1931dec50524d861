//! Values and conditions of one plan.
//!
//! A condition, or a value that may have no result, opens a block that stays open to the end of the plan or
//! of the alternative it belongs to.

use super::emitter::PlanEmitter;
use super::spelling::{conjunction, parenthesised, symbol};
use super::state::{belief_value, held, told_at};
use crate::program::{
    Alternatives, BeliefId, Call, Condition, Operation, Pattern, Value, VariableId,
};
use crate::syntax::ast::Relation;
use crate::types::CType;

impl PlanEmitter<'_> {
    pub(super) fn conditions(&mut self, conditions: &[Condition]) {
        for condition in conditions {
            self.condition(condition);
        }
    }

    fn condition(&mut self, condition: &Condition) {
        match condition {
            Condition::Holds { belief, patterns } => self.holds(*belief, patterns),
            Condition::Truth(value) => {
                let value = self.value(value);
                self.open(&value);
            }
            Condition::Compare { relation, left, right, ctype } => {
                let left = self.value(left);
                let right = self.value(right);
                let comparison = self.compare(*relation, ctype, &left, &right);
                self.open(&comparison);
            }
            Condition::Bind { variable, value } => self.assign(*variable, value),
            Condition::Not(inner) => self.not(inner),
            Condition::Any(alternatives) => self.any(alternatives),
        }
    }

    /// Assigns a variable; an unused one is not generated.
    pub(super) fn assign(&mut self, variable: VariableId, value: &Value) {
        let plan = self.plan;
        let variable = &plan.variables[variable.0];
        if variable.used {
            let text = self.value(value);
            self.constant(&variable.ctype, &variable.name, &text);
        } else if let Value::Call(call) = value {
            self.discard(call);
        } else {
            // The value is unused, but it may fail; calls in it have been made.
            let text = self.value(value);
            self.writer.line(format!("(void)({text});"));
        }
    }

    fn not(&mut self, inner: &[Condition]) {
        if let [condition] = inner
            && let Some(text) = self.simple(condition)
        {
            self.open(&format!("!{}", parenthesised(&text)));
            return;
        }
        let holds = self.temporary("holds");
        self.variable("bool", &holds, "false");
        self.writer.line("");
        self.nested(inner, &holds, &[]);
        self.open(&format!("!{holds}"));
    }

    fn any(&mut self, alternatives: &Alternatives) {
        let plan = self.plan;
        let holds = self.temporary("holds");
        self.variable("bool", &holds, "false");
        for (outer, _) in &alternatives.exports {
            let variable = &plan.variables[outer.0];
            if let Some(zero) = variable.ctype.zero().filter(|_| variable.used) {
                self.variable(&variable.ctype.name, &variable.name, zero);
            }
        }
        self.writer.line("");
        for (index, branch) in alternatives.branches.iter().enumerate() {
            let exports: Vec<(VariableId, VariableId)> = alternatives
                .exports
                .iter()
                .filter_map(|(outer, inner)| Some((*outer, *inner.get(index)?)))
                .collect();
            if index == 0 {
                self.nested(branch, &holds, &exports);
            } else {
                self.writer.open(format!("if (!{holds})"));
                self.nested(branch, &holds, &exports);
                self.writer.close("}");
            }
        }
        self.open(&holds);
    }

    /// Sets `holds` if the conjunction does, in blocks that are closed again.
    fn nested(
        &mut self,
        conditions: &[Condition],
        holds: &str,
        exports: &[(VariableId, VariableId)],
    ) {
        if self.level > 0 && self.blocks > 1 {
            self.flatten();
        }
        let outer_blocks = std::mem::take(&mut self.blocks);
        self.level += 1;
        // A separate block, so that its bindings do not clash with later ones.
        self.writer.open_bare();
        self.conditions(conditions);
        let plan = self.plan;
        for (outer, inner) in exports {
            let (outer, inner) = (&plan.variables[outer.0], &plan.variables[inner.0]);
            if outer.used {
                let (to, from) = (outer.name.clone(), inner.name.clone());
                self.writer.line(format!("{to} = {from};"));
            }
        }
        self.writer.line(format!("{holds} = true;"));
        self.close_blocks();
        self.writer.close("}");
        self.level -= 1;
        self.blocks = outer_blocks;
    }

    /// A condition without bindings that cannot fail, as one expression.
    fn simple(&mut self, condition: &Condition) -> Option<String> {
        match condition {
            Condition::Holds { belief, patterns } => {
                let plan = self.plan;
                let binds = |pattern: &Pattern| matches!(pattern, Pattern::Bind(id) if plan.variables[id.0].used);
                // A function in a pattern is called only if the belief is held.
                let plain = |pattern: &Pattern| match pattern {
                    Pattern::Equal(value) => is_plain(value),
                    Pattern::Any | Pattern::Bind(_) => true,
                };
                let simple = patterns.iter().all(|pattern| plain(pattern) && !binds(pattern));
                simple.then(|| conjunction(&self.matches(*belief, patterns)))
            }
            Condition::Truth(value) if !value.can_fail() => Some(self.value(value)),
            Condition::Compare { relation, left, right, ctype }
                if !left.can_fail() && !right.can_fail() =>
            {
                let left = self.value(left);
                let right = self.value(right);
                Some(self.compare(*relation, ctype, &left, &right))
            }
            _ => None,
        }
    }

    /// Opens blocks in which the belief matches and its variables are bound.
    pub(super) fn holds(&mut self, belief: BeliefId, patterns: &[Pattern]) {
        let program = self.program;
        let declared = program.belief(belief);
        let mut conditions = vec![self.names.field(&held(&declared.name))];
        for (index, pattern) in patterns.iter().enumerate() {
            let field = self.names.field(&belief_value(&declared.name, index));
            match pattern {
                Pattern::Any => {}
                Pattern::Bind(id) => {
                    let plan = self.plan;
                    let variable = &plan.variables[id.0];
                    if variable.used {
                        self.flush(&mut conditions);
                        self.constant(&variable.ctype, &variable.name, &field);
                    }
                }
                Pattern::Equal(value) => {
                    if !is_plain(value) {
                        self.flush(&mut conditions);
                    }
                    let value = self.value(value);
                    conditions.push(self.equal(&declared.types[index], &field, &value));
                }
            }
        }
        self.flush(&mut conditions);
    }

    fn flush(&mut self, conditions: &mut Vec<String>) {
        if !conditions.is_empty() {
            self.open(&conjunction(conditions));
            conditions.clear();
        }
    }

    /// The conditions under which the belief matches patterns without bindings.
    pub(super) fn matches(&mut self, belief: BeliefId, patterns: &[Pattern]) -> Vec<String> {
        let program = self.program;
        let declared = program.belief(belief);
        let mut conditions = vec![self.names.field(&held(&declared.name))];
        for (index, pattern) in patterns.iter().enumerate() {
            if let Pattern::Equal(value) = pattern {
                let value = self.value(value);
                let field = self.names.field(&belief_value(&declared.name, index));
                conditions.push(self.equal(&declared.types[index], &field, &value));
            }
        }
        conditions
    }

    /// A call whose result is discarded.
    pub(super) fn discard(&mut self, call: &Call) {
        let void = self.program.basic(call.basic).result.name == "void";
        let call = self.call(call);
        self.writer.line(if void { format!("{call};") } else { format!("(void){call};") });
    }

    fn call(&mut self, call: &Call) -> String {
        let arguments = self.values(&call.arguments);
        let basic = self.program.basic(call.basic);
        format!("{}({})", self.names.action(basic), self.names.action_arguments(&arguments))
    }

    pub(super) fn values(&mut self, values: &[Value]) -> Vec<String> {
        values.iter().map(|value| self.value(value)).collect()
    }

    /// A value as an expression without side effects: calls are made before it, in order, and an operation
    /// that may have no result opens a block in which it has one.
    pub(super) fn value(&mut self, value: &Value) -> String {
        match value {
            Value::Variable(id) => self.plan.variables[id.0].name.clone(),
            Value::Constant(text, _) => text.clone(),
            Value::Me => self.names.field("me"),
            Value::ToldAt(id) => self.names.field(&told_at(&self.program.belief(*id).name)),
            Value::Call(call) => {
                let result = self.program.basic(call.basic).result.clone();
                let text = self.call(call);
                let name = self.temporary("value");
                self.constant(&result, &name, &text);
                name
            }
            Value::Negate(operand) => {
                let operand = self.value(operand);
                // A constant may begin with a sign.
                format!("(-({operand}))")
            }
            Value::Arithmetic(operation) => self.operation(operation),
        }
    }

    fn operation(&mut self, operation: &Operation) -> String {
        let Operation { operator, left, right, ctype } = operation;
        let left = self.value(left);
        let right = self.value(right);
        self.helpers.operation(*operator, ctype);
        if !operation.can_fail() {
            return format!("({left} {} {right})", symbol(*operator));
        }
        let function = self.helpers.checked(*operator, ctype);
        let result = self.temporary("value");
        let zero = ctype.zero().unwrap_or("0");
        self.variable(&ctype.name, &result, zero);
        self.writer.line("");
        self.open(&format!("{function}({left}, {right}, &{result})"));
        result
    }

    fn compare(&mut self, relation: Relation, ctype: &CType, left: &str, right: &str) -> String {
        let symbol = match relation {
            Relation::Equal => return self.equal(ctype, left, right),
            Relation::NotEqual => {
                let equal = self.equal(ctype, left, right);
                return format!("(!{equal})");
            }
            Relation::Less => "<",
            Relation::LessOrEqual => "<=",
            Relation::Greater => ">",
            Relation::GreaterOrEqual => ">=",
        };
        format!("{left} {symbol} {right}")
    }

    pub(super) fn equal(&mut self, ctype: &CType, left: &str, right: &str) -> String {
        self.helpers.equality(ctype, left, right)
    }
}

/// Whether a value needs no preceding statement.
fn is_plain(value: &Value) -> bool {
    matches!(value, Value::Variable(_) | Value::Constant(..) | Value::Me | Value::ToldAt(_))
}
