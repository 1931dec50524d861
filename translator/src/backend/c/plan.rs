//! One C function for each plan, and one for each trigger that tries its plans in order.

use super::expression::{conjunction, parenthesised, variable_name};
use super::helpers::Helpers;
use super::names::{Names, argument, argument_names, comment_safe, constant, typed};
use super::state::{belief_value, handler_name, held};
use crate::backend::writer::Writer;
use crate::program::{
    BeliefId, Handler, HandlerId, Pattern, Plan, Program, Raise, Step, Value, VariableId,
    trigger_text,
};

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
    let mut plans = 0;
    for (index, handler) in program.reachable_handlers() {
        let trigger = handler_name(program, index);
        for (number, plan) in handler.plans.iter().enumerate() {
            let head = plan_name(number, &trigger);
            let number = plans;
            plans += 1;
            emit_plan(writer, program, names, &mut helpers, handler, plan, number, &head, input);
        }
        emit_handler(writer, program, names, index, handler);
    }
    helpers
}

pub(crate) fn plan_name(number: usize, trigger: &str) -> String {
    format!("plan{}_{trigger}", number + 1)
}

fn handler_head(program: &Program, names: &Names, id: HandlerId, handler: &Handler) -> String {
    let trigger = handler_name(program, id);
    format!("static outcome_t run_{trigger}({})", parameters(names, handler).join(", "))
}

/// The parameters of a handler and its plans: what is asked for is passed as a pointer.
fn parameters(names: &Names, handler: &Handler) -> Vec<String> {
    let mut parameters = names.state_parameter();
    for (index, ctype) in handler.types.iter().enumerate() {
        let hole = handler.holes.get(index).copied().unwrap_or(false);
        let name = if hole { format!("*{}", argument(index)) } else { argument(index) };
        parameters.push(typed(ctype, &name));
    }
    if parameters.is_empty() {
        parameters.push("void".to_owned());
    }
    parameters
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
    number: usize,
    name: &str,
    input: &str,
) {
    writer.line(format!("/* {}:{}", comment_safe(input), plan.lines.0));
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
    let mut parameters = parameters(names, handler);
    emitter.trigger(handler, &mut parameters);
    emitter.conditions(&plan.context);
    emitter.trace(number);
    emitter.body();
    emitter.close_blocks();
    let text = emitter.writer.finish();

    writer.open(format!("static outcome_t {name}({})", parameters.join(", ")));
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
pub(super) struct PlanEmitter<'a> {
    pub(super) program: &'a Program,
    pub(super) names: &'a Names,
    pub(super) helpers: &'a mut Helpers,
    pub(super) plan: &'a Plan,
    pub(super) writer: Writer,
    pub(super) blocks: usize,
    temporaries: usize,
}

impl PlanEmitter<'_> {
    pub(super) fn open(&mut self, condition: &str) {
        self.writer.open(format!("if {}", parenthesised(condition)));
        self.blocks += 1;
    }

    pub(super) fn close_blocks(&mut self) {
        for _ in 0..std::mem::take(&mut self.blocks) {
            self.writer.close("}");
        }
    }

    pub(super) fn temporary(&mut self, stem: &str) -> String {
        self.temporaries += 1;
        format!("{stem}{}", self.temporaries)
    }

    /// Matches the trigger's arguments; a variable's parameter carries its name.
    fn trigger(&mut self, handler: &Handler, parameters: &mut [String]) {
        let plan = self.plan;
        let first = parameters.len() - handler.types.len().min(parameters.len());
        let mut equals = Vec::new();
        for (index, pattern) in plan.patterns.iter().enumerate() {
            let ctype = &handler.types[index];
            match pattern {
                Pattern::Bind(id) if plan.variables[id.0].used => {
                    let variable = variable_name(&plan.variables[id.0].name);
                    parameters[first + index] = typed(ctype, &variable);
                }
                // The answer to what is asked for is stored at the end.
                Pattern::Any if plan.outputs.iter().any(|(output, _)| *output == index) => {}
                Pattern::Bind(_) | Pattern::Any => {
                    self.writer.line(format!("(void){};", argument(index)));
                }
                Pattern::Equal(value) => equals.push((index, value)),
            }
        }
        for (index, value) in equals {
            let value = self.value(value);
            let equal = self.equal(&handler.types[index], &argument(index), &value);
            self.open(&equal);
        }
    }

    /// Tells which plan was chosen, if somebody wants to know.
    fn trace(&mut self, number: usize) {
        if let Some(name) = &self.program.configuration.settings.trace {
            let function = self.names.interface(&name.text);
            let arguments = self.names.action_arguments(&[format!("{number}U")]);
            self.writer.line(format!("{function}({arguments});"));
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
        for (index, id) in &plan.outputs {
            let variable = variable_name(&plan.variables[id.0].name);
            self.writer.line(format!("*{} = {variable};", argument(*index)));
        }
        self.writer.line("outcome = OUTCOME_ACHIEVED;");
    }

    fn step(&mut self, step: &Step) {
        match step {
            Step::Action(call) => self.discard(call),
            Step::Assign { variable, value } => self.assign(*variable, value),
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
            Step::Ask { belief, patterns, plans: None } => self.ask_beliefs(*belief, patterns),
            Step::Ask { belief, patterns, plans: Some(plans) } => {
                self.ask(*belief, patterns, *plans);
            }
        }
    }

    /// Asks the beliefs alone. In a body all arguments are evaluated first.
    fn ask_beliefs(&mut self, belief: BeliefId, patterns: &[Pattern]) {
        let conditions = self.matches(belief, patterns);
        self.open(&conjunction(&conditions));
        let program = self.program;
        for (index, pattern) in patterns.iter().enumerate() {
            if let Pattern::Bind(id) = pattern {
                let field = self.names.field(&belief_value(&program.belief(belief).name, index));
                self.bind(*id, &field);
            }
        }
    }

    fn bind(&mut self, id: VariableId, text: &str) {
        let variable = &self.plan.variables[id.0];
        if variable.used {
            let declaration = constant(&variable.ctype, &variable_name(&variable.name));
            self.writer.line(format!("{declaration} = {text};"));
        }
    }

    /// Asks the beliefs, then the plans; goes on with the answers.
    fn ask(&mut self, belief: BeliefId, patterns: &[Pattern], plans: HandlerId) {
        let program = self.program;
        let declared = program.belief(belief);
        let answered = self.temporary("answered");
        let mut arguments = Vec::new();
        let mut matching = vec![self.names.field(&held(&declared.name))];
        let mut answers = Vec::new();
        for (index, pattern) in patterns.iter().enumerate() {
            let ctype = &declared.types[index];
            let field = self.names.field(&belief_value(&declared.name, index));
            if let Pattern::Equal(value) = pattern {
                let value = self.value(value);
                matching.push(self.equal(ctype, &field, &value));
                arguments.push(value);
            } else {
                let answer = self.temporary("answer");
                let zero = ctype.zero().unwrap_or("0");
                self.writer.line(format!("{} = {zero};", typed(ctype, &answer)));
                arguments.push(format!("&{answer}"));
                answers.push((index, answer, field));
            }
        }
        self.writer.line(format!("bool {answered} = false;"));
        self.writer.line("");
        self.writer.open(format!("if {}", parenthesised(&conjunction(&matching))));
        for (_, answer, field) in &answers {
            self.writer.line(format!("{answer} = {field};"));
        }
        self.writer.line(format!("{answered} = true;"));
        self.writer.close("}");
        self.writer.open("else");
        let arguments = self.names.arguments(arguments);
        let trigger = handler_name(program, plans);
        self.writer.line(format!("{answered} = (run_{trigger}({arguments}) == OUTCOME_ACHIEVED);"));
        self.writer.close("}");
        self.open(&answered);
        for (index, answer, _) in answers {
            if let Pattern::Bind(id) = &patterns[index] {
                self.bind(*id, &answer);
            }
        }
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
                self.writer.open(format!("if {}", parenthesised(&conjunction(&conditions))));
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
}

/// Whether the body can end before the formulae behind this one.
fn can_fail(step: &Step) -> bool {
    let values_fail = |values: &[Value]| values.iter().any(Value::can_fail);
    match step {
        Step::Achieve { .. } | Step::Ask { .. } => true,
        Step::Action(call) => values_fail(&call.arguments),
        Step::Assign { value, .. } => value.can_fail(),
        Step::Add { raise, values, .. } => matches!(raise, Raise::Call(_)) || values_fail(values),
        Step::Delete { raise, patterns, .. } => {
            matches!(raise, Raise::Call(_)) || patterns.iter().any(Pattern::can_fail)
        }
        Step::Post { values, .. } | Step::Defer { values, .. } => values_fail(values),
    }
}
