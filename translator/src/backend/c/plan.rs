//! One C function for each plan, and one for each trigger that tries its plans in order.

use super::names::{
    Names, argument, argument_names, comment_safe, constant, typed, typed_arguments,
};
use super::state::{belief_value, handler_name, held};
use crate::backend::writer::Writer;
use crate::program::{
    BeliefId, Call, Condition, Handler, HandlerId, Pattern, Plan, Program, Raise, Step, Value,
    trigger_text,
};
use crate::types::CType;

/// Helper functions that the plans turned out to need.
#[derive(Debug, Default)]
pub(super) struct Helpers {
    /// Floating-point types that are compared.
    equal: Vec<CType>,
}

impl Helpers {
    pub(super) fn emit(&self, writer: &mut Writer) {
        for ctype in &self.equal {
            writer.line("/* Exact equality; a NaN equals nothing. */");
            writer.open(format!(
                "static bool equal_{0}({0} left, {0} right)",
                ctype.name.replace(' ', "_")
            ));
            writer.line("return (left <= right) && (left >= right);");
            writer.close("}");
            writer.line("");
        }
    }
}

/// Prototypes of the handlers, which may call each other in any order.
pub(super) fn prototypes(writer: &mut Writer, program: &Program, names: &Names) {
    for (index, handler) in program.reachable_handlers() {
        writer.line(format!("{};", handler_head(program, names, index, handler)));
    }
    writer.line("");
}

/// All plans and handlers, in the order of the source.
pub(super) fn handlers(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    input: &str,
) -> Helpers {
    let mut helpers = Helpers::default();
    for (index, handler) in program.reachable_handlers() {
        let trigger = handler_name(program, index);
        for (number, plan) in handler.plans.iter().enumerate() {
            let head = plan_name(number, &trigger);
            emit_plan(writer, program, names, &mut helpers, handler, plan, &head, input);
        }
        emit_handler(writer, program, names, index, handler);
    }
    helpers
}

fn plan_name(number: usize, trigger: &str) -> String {
    format!("plan{}_{trigger}", number + 1)
}

fn handler_head(program: &Program, names: &Names, id: HandlerId, handler: &Handler) -> String {
    let trigger = handler_name(program, id);
    format!("static outcome_t run_{trigger}({})", names.parameters(&handler.types))
}

fn emit_handler(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    id: HandlerId,
    handler: &Handler,
) {
    let trigger = handler_name(program, id);
    let arguments = names.arguments(argument_names(&handler.types));
    let text = trigger_text(handler.operator, handler.kind, &handler.name);
    writer.line(format!("/* Plans of {text}, in order. */"));
    writer.open(handler_head(program, names, id, handler));
    writer.line(format!("outcome_t outcome = {}({arguments});", plan_name(0, &trigger)));
    writer.line("");
    for number in 1..handler.plans.len() {
        writer.open("if (outcome == OUTCOME_NOT_APPLICABLE)");
        writer.line(format!("outcome = {}({arguments});", plan_name(number, &trigger)));
        writer.close("}");
    }
    if let Some(failure) = handler.failure {
        writer.open("if (outcome != OUTCOME_ACHIEVED)");
        writer.line(format!("outcome = run_{}({arguments});", handler_name(program, failure)));
        writer.close("}");
    }
    writer.line("return outcome;");
    writer.close("}");
    writer.line("");
}

#[allow(clippy::too_many_arguments, reason = "one call; a struct would only rename them")]
fn emit_plan(
    writer: &mut Writer,
    program: &Program,
    names: &Names,
    helpers: &mut Helpers,
    handler: &Handler,
    plan: &Plan,
    name: &str,
    input: &str,
) {
    writer.line(format!("/* {}:{}", comment_safe(input), plan.line));
    for line in comment_safe(&plan.source).lines() {
        writer.line(format!(" * {}", line.trim_end()).trim_end());
    }
    writer.line(" */");

    let mut emitter = PlanEmitter {
        program,
        names,
        helpers,
        plan,
        writer: Writer::default(),
        blocks: 0,
        temporaries: 0,
    };
    emitter.writer.indent();
    let parameters = emitter.trigger(&handler.types);
    emitter.context();
    emitter.body();
    emitter.close_blocks();
    let text = emitter.writer.finish();

    let mut all_parameters = names.state_parameter();
    all_parameters.extend(parameters);
    if all_parameters.is_empty() {
        all_parameters.push("void".to_owned());
    }
    writer.open(format!("static outcome_t {name}({})", all_parameters.join(", ")));
    writer.line("outcome_t outcome = OUTCOME_NOT_APPLICABLE;");
    writer.line("");
    if names.is_context() && !text.contains("self") {
        writer.line("(void)self;");
    }
    for line in text.lines() {
        writer.line(line.strip_prefix("    ").unwrap_or(line));
    }
    writer.line("return outcome;");
    writer.close("}");
    writer.line("");
}

/// Writes one plan. Each condition and each formula that can fail opens a block that stays open to
/// the end of the plan, so that every variable is a constant initialised where it is bound.
struct PlanEmitter<'a> {
    program: &'a Program,
    names: &'a Names,
    helpers: &'a mut Helpers,
    plan: &'a Plan,
    writer: Writer,
    blocks: usize,
    temporaries: usize,
}

impl PlanEmitter<'_> {
    fn open(&mut self, condition: &str) {
        self.writer.open(format!("if ({condition})"));
        self.blocks += 1;
    }

    fn close_blocks(&mut self) {
        for _ in 0..self.blocks {
            self.writer.close("}");
        }
    }

    /// Matches the trigger's arguments and returns the plan's parameters: a variable's parameter
    /// carries its name.
    fn trigger(&mut self, types: &[CType]) -> Vec<String> {
        let plan = self.plan;
        let mut parameters: Vec<String> = typed_arguments(types).collect();
        let mut conditions = Vec::new();
        for (index, pattern) in plan.patterns.iter().enumerate() {
            match pattern {
                Pattern::Bind(id) if plan.variables[id.0].used => {
                    let variable = variable_name(&plan.variables[id.0].name);
                    parameters[index] = typed(&types[index], &variable);
                }
                Pattern::Bind(_) | Pattern::Any => {
                    self.writer.line(format!("(void){};", argument(index)));
                }
                Pattern::Equal(value) => {
                    let value = self.value(value);
                    conditions.push(self.equal(&types[index], &argument(index), &value));
                }
            }
        }
        if !conditions.is_empty() {
            self.open(&conjunction(&conditions));
        }
        parameters
    }

    fn context(&mut self) {
        let plan = self.plan;
        for condition in &plan.context {
            match condition {
                Condition::Holds { belief, patterns } => self.holds(*belief, patterns),
                Condition::HoldsNot { belief, patterns } => {
                    let conditions = self.matches(*belief, patterns);
                    self.open(&format!("!({})", conjunction(&conditions)));
                }
                Condition::Test { call, negated } => {
                    let call = self.call(call);
                    self.open(&if *negated { format!("!{call}") } else { call });
                }
            }
        }
    }

    fn body(&mut self) {
        let plan = self.plan;
        if plan.body.iter().any(can_fail) {
            self.writer.line("outcome = OUTCOME_FAILED;");
        }
        for step in &plan.body {
            self.step(step);
        }
        self.writer.line("outcome = OUTCOME_ACHIEVED;");
    }

    fn step(&mut self, step: &Step) {
        match step {
            Step::Action(call) => self.discard(call),
            Step::Assign { variable, call } => {
                let variable = &self.plan.variables[variable.0];
                if variable.used {
                    let call = self.call(call);
                    let declaration = constant(&variable.ctype, &variable_name(&variable.name));
                    self.writer.line(format!("{declaration} = {call};"));
                } else {
                    self.discard(call);
                }
            }
            Step::Add { belief, values, raise } => self.add(*belief, values, *raise),
            Step::Delete { belief, patterns, raise } => self.delete(*belief, patterns, *raise),
            Step::Achieve { handler, values } => {
                let values = self.values(values);
                let arguments = self.names.arguments(values);
                let trigger = handler_name(self.program, *handler);
                self.open(&format!("run_{trigger}({arguments}) == OUTCOME_ACHIEVED"));
            }
            Step::Post { handler, values } => {
                let values = self.values(values);
                self.post(*handler, values);
            }
            Step::Defer { handler, values } => {
                let values = self.values(values);
                let arguments = self.names.arguments(values);
                let trigger = handler_name(self.program, *handler);
                self.writer.line(format!("defer_{trigger}({arguments});"));
            }
            Step::Ask { belief, patterns } => self.holds(*belief, patterns),
        }
    }

    /// Opens blocks in which the belief matches and its variables are bound.
    fn holds(&mut self, belief: BeliefId, patterns: &[Pattern]) {
        let program = self.program;
        let declared = program.belief(belief);
        let mut conditions = vec![self.names.field(&held(&declared.name))];
        for (index, pattern) in patterns.iter().enumerate() {
            let field = self.names.field(&belief_value(&declared.name, index));
            match pattern {
                Pattern::Any => {}
                Pattern::Bind(id) => {
                    let variable = &self.plan.variables[id.0];
                    if variable.used {
                        self.flush(&mut conditions);
                        let declaration = constant(&variable.ctype, &variable_name(&variable.name));
                        self.writer.line(format!("{declaration} = {field};"));
                    }
                }
                Pattern::Equal(value) => {
                    if matches!(value, Value::Call(_)) {
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

    /// The conditions under which the belief matches patterns that bind nothing.
    fn matches(&mut self, belief: BeliefId, patterns: &[Pattern]) -> Vec<String> {
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

    fn add(&mut self, belief: BeliefId, values: &[Value], raise: Raise) {
        let program = self.program;
        let declared = program.belief(belief);
        let held = self.names.field(&held(&declared.name));
        let values = self.values(values);
        let mut unchanged = vec![held.clone()];
        let mut comparable = true;
        for (index, value) in values.iter().enumerate() {
            let ctype = &declared.types[index];
            comparable &= ctype.has_equality();
            if raise != Raise::Nothing && ctype.has_equality() {
                let field = self.names.field(&belief_value(&declared.name, index));
                unchanged.push(self.equal(ctype, &field, value));
            }
        }
        let changed = if raise == Raise::Nothing {
            String::new()
        } else {
            let changed = self.temporary("changed");
            let condition = if comparable {
                format!("!({})", conjunction(&unchanged))
            } else {
                "true".to_owned()
            };
            self.writer.line(format!("const bool {changed} = {condition};"));
            changed
        };
        for (index, value) in values.iter().enumerate() {
            let field = self.names.field(&belief_value(&declared.name, index));
            self.writer.line(format!("{field} = {value};"));
        }
        self.writer.line(format!("{held} = true;"));
        self.raise(&changed, raise, values);
    }

    fn delete(&mut self, belief: BeliefId, patterns: &[Pattern], raise: Raise) {
        let program = self.program;
        let declared = program.belief(belief);
        let held = self.names.field(&held(&declared.name));
        let conditions = self.matches(belief, patterns);
        if raise == Raise::Nothing {
            if conditions.len() == 1 {
                self.writer.line(format!("{held} = false;"));
            } else {
                self.writer.open(format!("if ({})", conjunction(&conditions)));
                self.writer.line(format!("{held} = false;"));
                self.writer.close("}");
            }
            return;
        }
        let changed = self.temporary("changed");
        self.writer.line(format!("const bool {changed} = {};", conjunction(&conditions)));
        self.writer.open(format!("if ({changed})"));
        self.writer.line(format!("{held} = false;"));
        self.writer.close("}");
        let old = (0..declared.types.len())
            .map(|index| self.names.field(&belief_value(&declared.name, index)))
            .collect();
        self.raise(&changed, raise, old);
    }

    /// Runs or posts the plans of a percept if the belief has changed.
    fn raise(&mut self, changed: &str, raise: Raise, values: Vec<String>) {
        match raise {
            Raise::Nothing => {}
            Raise::Post(handler) => {
                self.writer.open(format!("if ({changed})"));
                self.post(handler, values);
                self.writer.close("}");
            }
            Raise::Call(handler) => {
                let outcome = self.temporary("outcome");
                let arguments = self.names.arguments(values);
                let trigger = handler_name(self.program, handler);
                self.writer.line(format!("outcome_t {outcome} = OUTCOME_ACHIEVED;"));
                self.writer.open(format!("if ({changed})"));
                self.writer.line(format!("{outcome} = run_{trigger}({arguments});"));
                self.writer.close("}");
                self.open(&format!("{outcome} != OUTCOME_FAILED"));
            }
        }
    }

    fn post(&mut self, handler: HandlerId, values: Vec<String>) {
        let arguments = self.names.arguments(values);
        let trigger = handler_name(self.program, handler);
        self.writer.line(format!("post_{trigger}({arguments});"));
    }

    /// Calls for the effect alone.
    fn discard(&mut self, call: &Call) {
        let void = self.program.basic(call.basic).result.name == "void";
        let call = self.call(call);
        self.writer.line(if void { format!("{call};") } else { format!("(void){call};") });
    }

    fn call(&mut self, call: &Call) -> String {
        let arguments = self.values(&call.arguments);
        let basic = self.program.basic(call.basic);
        format!("{}({})", self.names.action(basic), self.names.action_arguments(&arguments))
    }

    fn values(&mut self, values: &[Value]) -> Vec<String> {
        values.iter().map(|value| self.value(value)).collect()
    }

    /// A value as an expression without side effects: calls are made before, in order.
    fn value(&mut self, value: &Value) -> String {
        match value {
            Value::Variable(id) => variable_name(&self.plan.variables[id.0].name),
            Value::Field(belief, index) => {
                let name = &self.program.belief(*belief).name;
                self.names.field(&belief_value(name, *index))
            }
            Value::Constant(text, _) => text.clone(),
            Value::Call(call) => {
                let result = self.program.basic(call.basic).result.clone();
                let text = self.call(call);
                let name = self.temporary("value");
                self.writer.line(format!("{} = {text};", constant(&result, &name)));
                name
            }
        }
    }

    fn equal(&mut self, ctype: &CType, left: &str, right: &str) -> String {
        if !ctype.is_float() {
            return format!("({left} == {right})");
        }
        if !self.helpers.equal.contains(ctype) {
            self.helpers.equal.push(ctype.clone());
        }
        format!("equal_{}({left}, {right})", ctype.name.replace(' ', "_"))
    }

    fn temporary(&mut self, stem: &str) -> String {
        self.temporaries += 1;
        format!("{stem}{}", self.temporaries)
    }
}

fn can_fail(step: &Step) -> bool {
    match step {
        Step::Achieve { .. } | Step::Ask { .. } => true,
        Step::Add { raise, .. } | Step::Delete { raise, .. } => matches!(raise, Raise::Call(_)),
        Step::Action(_) | Step::Assign { .. } | Step::Post { .. } | Step::Defer { .. } => false,
    }
}

/// AgentSpeak variables get a prefix: `X` may be a macro of some included header.
fn variable_name(name: &str) -> String {
    format!("var_{name}")
}

fn conjunction(conditions: &[String]) -> String {
    match conditions {
        [only] => only.clone(),
        several => several.iter().map(|c| parenthesised(c)).collect::<Vec<_>>().join(" && "),
    }
}

fn parenthesised(condition: &str) -> String {
    if condition.starts_with('(') { condition.to_owned() } else { format!("({condition})") }
}
