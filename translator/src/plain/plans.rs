//! Plans of the plain translation: each plan is one function that leaves at the first thing
//! that does not hold, and each value has its own variable.

use std::fmt::Write as _;

use super::floats::float_function;
use crate::program::{
    Alternatives, Belief, BeliefId, Call, Condition, Handler, HandlerId, Operation, Pattern, Plan,
    Program, Raise, Step, Value, VariableId,
};
use crate::syntax::ast::{Arithmetic, Relation};
use crate::types::{CType, TypeKind};

/// The functions of all plans and triggers.
pub(super) fn plans(program: &Program) -> String {
    let mut text = String::new();
    for (id, handler) in program.handlers() {
        _ = writeln!(text, "static int plain_run_{}({});", id.0, parameters(handler));
    }
    let mut number = 0;
    for (id, handler) in program.handlers() {
        for (index, plan) in handler.plans.iter().enumerate() {
            text.push_str(&Function::new(program, plan).text(id, handler, index, number));
            number += 1;
        }
        text.push_str(&trigger(program, id, handler));
    }
    text
}

/// Tries the plans in order, then those for the failure.
fn trigger(program: &Program, id: HandlerId, handler: &Handler) -> String {
    let given = |count: usize| (0..count).map(|i| format!("a{i}")).collect::<Vec<_>>().join(", ");
    let arguments = given(handler.types.len());
    let mut text = format!("/* {} */\n", handler.text());
    _ = writeln!(text, "static int plain_run_{}({})\n{{", id.0, parameters(handler));
    text.push_str("    int outcome = PLAIN_NO_PLAN;\n");
    for index in 0..handler.plans.len() {
        _ = writeln!(
            text,
            "    if (outcome == PLAIN_NO_PLAN) outcome = plain_plan_{}_{index}({arguments});",
            id.0
        );
    }
    if let Some(failure) = handler.failure {
        let arguments = given(program.handler(failure).types.len());
        _ = writeln!(
            text,
            "    if (outcome != PLAIN_ACHIEVED) outcome = plain_run_{}({arguments});",
            failure.0
        );
    }
    text.push_str("    return outcome;\n}\n\n");
    text
}

/// Arguments that a test goal asks for are pointers.
fn parameters(handler: &Handler) -> String {
    let parameters = handler.types.iter().enumerate().map(|(index, ctype)| {
        let star = if is_asked(handler, index) { "*" } else { "" };
        format!("{} {star}a{index}", ctype.name)
    });
    let parameters: Vec<String> = parameters.collect();
    if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") }
}

fn is_asked(handler: &Handler, index: usize) -> bool {
    handler.holes.get(index).copied().unwrap_or(false)
}

/// The equality of two values of a type.
fn equal(ctype: &CType, left: &str, right: &str) -> String {
    if ctype.kind == TypeKind::Struct {
        format!("plain_equal_{}({left}, {right})", ctype.name)
    } else {
        format!("({left} == {right})")
    }
}

/// Whether a value has not changed. One that cannot be compared counts as changed.
pub(super) fn same(ctype: &CType, left: &str, right: &str) -> String {
    if ctype.has_equality() { equal(ctype, left, right) } else { "false".to_owned() }
}

/// The place of a belief's argument.
pub(super) fn believed(belief: &str, index: usize) -> String {
    format!("plain.value_{belief}_{index}")
}

/// Parameters of these types.
pub(super) fn given(types: &[CType]) -> String {
    let parameters = types.iter().enumerate().map(|(i, ctype)| format!("{} a{i}", ctype.name));
    let parameters: Vec<String> = parameters.collect();
    if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") }
}

/// Runs the plans of a percept: it is no failure if none applies.
pub(super) fn percept(handler: HandlerId, values: &str) -> String {
    format!(
        "int outcome = plain_run_{}({values}); plain_end(outcome == PLAIN_NO_PLAN ? PLAIN_ACHIEVED : outcome);",
        handler.0
    )
}

/// The places of a belief's arguments.
pub(super) fn values_of(belief: &Belief) -> String {
    (0..belief.types.len()).map(|i| believed(&belief.name, i)).collect::<Vec<_>>().join(", ")
}

/// The source of an event that the agent causes itself, behind its other arguments.
pub(super) fn own(program: &Program, handler: HandlerId, values: String) -> String {
    match (program.handler(handler).sourced, values.is_empty()) {
        (false, _) => values,
        (true, true) => "plain.me".to_owned(),
        (true, false) => format!("{values}, plain.me"),
    }
}

/// The function of one plan.
struct Function<'a> {
    program: &'a Program,
    plan: &'a Plan,
    lines: String,
    declared: String,
    /// Numbers for labels and variables.
    number: usize,
}

impl<'a> Function<'a> {
    fn new(program: &'a Program, plan: &'a Plan) -> Self {
        Self { program, plan, lines: String::new(), declared: String::new(), number: 0 }
    }

    fn text(mut self, id: HandlerId, handler: &Handler, index: usize, number: usize) -> String {
        let plan = self.plan;
        for (variable, declared) in plan.variables.iter().enumerate() {
            _ = writeln!(self.declared, "    {} v{variable};", declared.ctype.name);
        }
        for (argument, pattern) in plan.patterns.iter().enumerate() {
            match pattern {
                Pattern::Bind(variable) if !is_asked(handler, argument) => {
                    self.line(format!("v{} = a{argument};", variable.0));
                }
                Pattern::Any | Pattern::Bind(_) => {}
                Pattern::Equal(value) => {
                    let value = self.value(value, "no");
                    let ctype = &handler.types[argument];
                    self.unless(&equal(ctype, &format!("a{argument}"), &value), "no");
                }
            }
        }
        self.conditions(&plan.context, "no");
        if let Some(trace) = self.program.trace() {
            self.line(format!("plain_call_{}({number}U);", trace.0));
        }
        for step in plan.steps() {
            self.step(step);
        }
        for (argument, variable) in &plan.outputs {
            self.line(format!("*a{argument} = v{};", variable.0));
        }
        let Self { declared, lines, .. } = self;
        let (id, parameters) = (id.0, parameters(handler));
        format!(
            "static int plain_plan_{id}_{index}({parameters})\n{{\n{declared}{lines}    return PLAIN_ACHIEVED;\n\
             no: __attribute__((unused));\n    return PLAIN_NO_PLAN;\n\
             failed: __attribute__((unused));\n    return PLAIN_FAILED;\n}}\n\n"
        )
    }

    fn line(&mut self, line: impl AsRef<str>) {
        _ = writeln!(self.lines, "    {}", line.as_ref());
    }

    fn unless(&mut self, condition: &str, label: &str) {
        self.line(format!("if (!{condition}) goto {label};"));
    }

    fn fresh(&mut self) -> usize {
        self.number += 1;
        self.number
    }

    fn variable(&mut self, ctype: &str) -> String {
        let name = format!("t{}", self.fresh());
        _ = writeln!(self.declared, "    {ctype} {name};");
        name
    }

    fn conditions(&mut self, conditions: &[Condition], label: &str) {
        for condition in conditions {
            self.condition(condition, label);
        }
    }

    /// Goes on if the condition holds, and to the label if it does not.
    fn condition(&mut self, condition: &Condition, label: &str) {
        match condition {
            Condition::Holds { belief, patterns } => self.holds(*belief, patterns, label),
            Condition::Truth(value) => {
                let value = self.value(value, label);
                self.unless(&value, label);
            }
            Condition::Compare { relation, left, right, ctype } => {
                let left = self.value(left, label);
                let right = self.value(right, label);
                let holds = match relation {
                    Relation::Equal => equal(ctype, &left, &right),
                    Relation::NotEqual => format!("(!{})", equal(ctype, &left, &right)),
                    Relation::Less => format!("({left} < {right})"),
                    Relation::LessOrEqual => format!("({left} <= {right})"),
                    Relation::Greater => format!("({left} > {right})"),
                    Relation::GreaterOrEqual => format!("({left} >= {right})"),
                };
                self.unless(&holds, label);
            }
            Condition::Bind { variable, value } => {
                let value = self.value(value, label);
                self.line(format!("v{} = {value};", variable.0));
            }
            Condition::Not(inner) => {
                let not = format!("l{}", self.fresh());
                self.conditions(inner, &not);
                self.line(format!("goto {label};"));
                self.line(format!("{not}:;"));
            }
            Condition::Any(alternatives) => self.any(alternatives, label),
        }
    }

    fn any(&mut self, alternatives: &Alternatives, label: &str) {
        let done = format!("l{}", self.fresh());
        for (index, branch) in alternatives.branches.iter().enumerate() {
            let next = format!("l{}", self.fresh());
            self.conditions(branch, &next);
            for (outer, inner) in &alternatives.exports {
                if let Some(inner) = inner.get(index) {
                    self.line(format!("v{} = v{};", outer.0, inner.0));
                }
            }
            self.line(format!("goto {done};"));
            self.line(format!("{next}:;"));
        }
        self.line(format!("goto {label};"));
        self.line(format!("{done}:;"));
    }

    /// In a context, arguments are evaluated as far as the belief matches.
    fn holds(&mut self, belief: BeliefId, patterns: &[Pattern], label: &str) {
        let belief = self.program.belief(belief);
        self.unless(&format!("plain.held_{}", belief.name), label);
        for (index, pattern) in patterns.iter().enumerate() {
            let place = believed(&belief.name, index);
            match pattern {
                Pattern::Any => {}
                Pattern::Bind(variable) => self.line(format!("v{} = {place};", variable.0)),
                Pattern::Equal(value) => {
                    let value = self.value(value, label);
                    self.unless(&equal(&belief.types[index], &place, &value), label);
                }
            }
        }
    }

    /// In a body, all arguments are evaluated first. Returns whether the belief matches, as a condition, and
    /// the given values.
    fn matches(&mut self, belief: BeliefId, patterns: &[Pattern]) -> (String, Vec<String>) {
        let belief = self.program.belief(belief);
        let mut matches = format!("plain.held_{}", belief.name);
        let mut given = Vec::new();
        for (index, pattern) in patterns.iter().enumerate() {
            if let Pattern::Equal(value) = pattern {
                let value = self.value(value, "failed");
                let place = believed(&belief.name, index);
                _ = write!(matches, " && {}", equal(&belief.types[index], &place, &value));
                given.push(value);
            }
        }
        (format!("({matches})"), given)
    }

    fn values(&mut self, values: &[Value], label: &str) -> Vec<String> {
        values.iter().map(|value| self.value(value, label)).collect()
    }

    /// Evaluates a value; goes to the label if it has none.
    fn value(&mut self, value: &Value, label: &str) -> String {
        match value {
            Value::Variable(VariableId(index)) => format!("v{index}"),
            Value::Constant(text, _) => text.clone(),
            Value::Me => "plain.me".to_owned(),
            Value::ToldAt(id) => format!("plain.told_at_{}", self.program.belief(*id).name),
            Value::Call(call) => {
                let result = self.program.basic(call.basic).result.name.clone();
                let call = self.call(call, label);
                let name = self.variable(&result);
                self.line(format!("{name} = {call};"));
                name
            }
            Value::Negate(operand) => {
                let operand = self.value(operand, label);
                format!("(-({operand}))")
            }
            Value::Arithmetic(operation) => self.arithmetic(operation, label),
        }
    }

    fn call(&mut self, call: &Call, label: &str) -> String {
        let arguments = self.values(&call.arguments, label).join(", ");
        format!("plain_call_{}({arguments})", call.basic.0)
    }

    fn arithmetic(&mut self, operation: &Operation, label: &str) -> String {
        let Operation { operator, left, right, ctype } = operation;
        let left = self.value(left, label);
        let right = self.value(right, label);
        let name = self.variable(&ctype.name);
        let symbol = match operator {
            Arithmetic::Add => "+",
            Arithmetic::Subtract => "-",
            Arithmetic::Multiply => "*",
            Arithmetic::Divide => "/",
            Arithmetic::Remainder => "%",
        };
        let is_division = matches!(operator, Arithmetic::Divide | Arithmetic::Remainder);
        let Some((low, high)) = ctype.integer_range() else {
            if is_division {
                // Neither zero nor NaN.
                self.unless(&format!("(({right} < 0) || ({right} > 0))"), label);
            }
            let value = match float_function(symbol, ctype.kind) {
                Some(function) => format!("{function}({left}, {right})"),
                None => format!("{left} {symbol} {right}"),
            };
            self.line(format!("{name} = {value};"));
            return name;
        };
        if is_division {
            self.unless(&format!("({right} != 0)"), label);
            if low < 0 {
                let (low, right) = (literal(low), &right);
                self.unless(&format!("!({left} == {low} && {right} == -1)"), label);
            }
            self.line(format!("{name} = ({})({left} {symbol} {right});", ctype.name));
            return name;
        }
        // Wide enough for every result.
        let wide = match (operator, low) {
            (Arithmetic::Multiply, 0) => "unsigned __int128",
            _ => "__int128",
        };
        let result = self.variable(wide);
        self.line(format!("{result} = ({wide}){left} {symbol} ({wide}){right};"));
        if low < 0 || *operator == Arithmetic::Subtract {
            self.unless(&format!("({result} >= {})", literal(low)), label);
        }
        self.unless(&format!("({result} <= {})", literal(high)), label);
        self.line(format!("{name} = ({}){result};", ctype.name));
        name
    }

    fn step(&mut self, step: &Step) {
        let program = self.program;
        match step {
            Step::Action(call) => {
                let call = self.call(call, "failed");
                self.line(format!("(void){call};"));
            }
            Step::Assign { variable, value } => {
                let value = self.value(value, "failed");
                self.line(format!("v{} = {value};", variable.0));
            }
            Step::Add { belief, values, raise } => self.add(*belief, values, *raise),
            Step::Delete { belief, patterns, raise } => self.delete(*belief, patterns, *raise),
            Step::Achieve { handler, values } => {
                let values = self.values(values, "failed").join(", ");
                self.unless(
                    &format!("(plain_run_{}({values}) == PLAIN_ACHIEVED)", handler.0),
                    "failed",
                );
            }
            Step::Post { handler, values, deadline } => {
                let values = self.values(values, "failed");
                if let Some(deadline) = deadline {
                    let due = self.value(deadline, "failed");
                    let arguments = values.iter().cloned().chain([due]);
                    let arguments = arguments.collect::<Vec<_>>().join(", ");
                    self.line(format!("plain_limit_{}({arguments});", handler.0));
                }
                self.line(format!("plain_post_{}({});", handler.0, values.join(", ")));
            }
            Step::Defer { handler, values } => {
                let values = self.values(values, "failed").join(", ");
                self.line(format!("plain_defer_{}({values});", handler.0));
            }
            Step::Broadcast { basic, values, .. } => {
                let values = self.values(values, "failed");
                for peer in 0..program.configuration.peers.len() {
                    let all: Vec<String> =
                        std::iter::once(peer.to_string()).chain(values.clone()).collect();
                    let all = all.join(", ");
                    self.line(format!("if (plain.me != {peer}) plain_call_{}({all});", basic.0));
                }
            }
            Step::Ask { belief, patterns, plans } => {
                if let Some(plans) = plans {
                    self.ask(*belief, patterns, *plans);
                    return;
                }
                let (matches, _) = self.matches(*belief, patterns);
                let declared = program.belief(*belief);
                self.unless(&matches, "failed");
                for (index, pattern) in patterns.iter().enumerate() {
                    if let Pattern::Bind(variable) = pattern {
                        let place = believed(&declared.name, index);
                        self.line(format!("v{} = {place};", variable.0));
                    }
                }
            }
        }
    }

    /// Asks the belief, then the plans.
    fn ask(&mut self, belief: BeliefId, patterns: &[Pattern], plans: HandlerId) {
        let (matches, given) = self.matches(belief, patterns);
        let belief = self.program.belief(belief);
        let mut arguments = Vec::new();
        let mut answers = Vec::new();
        let mut given = given.into_iter();
        for (index, pattern) in patterns.iter().enumerate() {
            if matches!(pattern, Pattern::Equal(_)) {
                arguments.push(given.next().unwrap_or_default());
            } else {
                let answer = self.variable(&belief.types[index].name);
                arguments.push(format!("&{answer}"));
                answers.push((index, answer));
            }
        }
        self.line(format!("if {matches} {{"));
        for (index, answer) in &answers {
            self.line(format!("    {answer} = {};", believed(&belief.name, *index)));
        }
        let arguments = arguments.join(", ");
        self.line(format!(
            "}} else if (plain_run_{}({arguments}) != PLAIN_ACHIEVED) goto failed;",
            plans.0
        ));
        for (index, answer) in answers {
            if let Pattern::Bind(variable) = &patterns[index] {
                self.line(format!("v{} = {answer};", variable.0));
            }
        }
    }

    fn add(&mut self, belief: BeliefId, values: &[Value], raise: Raise) {
        let values = self.values(values, "failed");
        let belief = self.program.belief(belief);
        let changed = self.variable("bool");
        self.line(format!("{changed} = !plain.held_{};", belief.name));
        for (index, (ctype, value)) in belief.types.iter().zip(&values).enumerate() {
            let place = believed(&belief.name, index);
            let same = same(ctype, &place, value);
            self.line(format!("if (!{same}) {changed} = true;"));
        }
        for (index, value) in values.iter().enumerate() {
            self.line(format!("{} = {value};", believed(&belief.name, index)));
        }
        self.line(format!("plain.held_{} = true;", belief.name));
        self.raise(&changed, raise, &values);
    }

    fn delete(&mut self, belief: BeliefId, patterns: &[Pattern], raise: Raise) {
        let (matches, _) = self.matches(belief, patterns);
        let belief = self.program.belief(belief);
        let changed = self.variable("bool");
        self.line(format!("{changed} = {matches};"));
        self.line(format!("if ({changed}) plain.held_{} = false;", belief.name));
        let old = (0..belief.types.len()).map(|index| believed(&belief.name, index));
        let old: Vec<String> = old.collect();
        self.raise(&changed, raise, &old);
    }

    /// What a change of a belief leads to.
    fn raise(&mut self, changed: &str, raise: Raise, values: &[String]) {
        let mut values = values.join(", ");
        if let Raise::Call(handler) | Raise::Post(handler) = raise {
            values = own(self.program, handler, values);
        }
        match raise {
            Raise::Nothing => {}
            Raise::Call(handler) => {
                let failed = format!("plain_run_{}({values}) == PLAIN_FAILED", handler.0);
                self.line(format!("if ({changed} && {failed}) goto failed;"));
            }
            Raise::Post(handler) => {
                self.line(format!("if ({changed}) plain_post_{}({values});", handler.0));
            }
        }
    }
}

/// A number as a constant of C.
fn literal(number: i128) -> String {
    if number == i128::from(i64::MIN) {
        // C has no negative constants.
        "(-9223372036854775807LL - 1)".to_owned()
    } else if number > i128::from(i64::MAX) {
        format!("{number}ULL")
    } else {
        format!("({number}LL)")
    }
}
