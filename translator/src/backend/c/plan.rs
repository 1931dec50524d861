//! Body of the C function of one plan.

use super::emitter::PlanEmitter;
use super::names::{argument, typed};
use super::spelling::{conjunction, parenthesised};
use super::state::{belief_value, handler_name, held, limited_types};
use crate::program::{
    BasicId, BeliefId, Handler, HandlerId, Pattern, Raise, Step, Value, VariableId,
};
use crate::types::CType;

impl PlanEmitter<'_> {
    /// The text of the function's body between its first and last line. A parameter that binds a variable
    /// gets its name. `number` is passed to the trace function.
    pub(super) fn emit(
        mut self,
        handler: &Handler,
        number: usize,
        parameters: &mut [String],
    ) -> String {
        let plan = self.plan;
        self.trigger(handler, parameters);
        self.conditions(&plan.context);
        self.trace(number);
        self.body();
        self.finish()
    }

    /// Matches the trigger's arguments; a parameter is named like its variable.
    fn trigger(&mut self, handler: &Handler, parameters: &mut [String]) {
        let plan = self.plan;
        let first = parameters.len() - handler.types.len().min(parameters.len());
        let mut equals = Vec::new();
        for (index, pattern) in plan.patterns.iter().enumerate() {
            let ctype = &handler.types[index];
            match pattern {
                Pattern::Bind(id) if plan.variables[id.0].used => {
                    let variable = plan.variables[id.0].name.clone();
                    parameters[first + index] = typed(ctype, &variable);
                }
                // Queried arguments are stored at the end.
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

    /// Calls the trace function, if there is one, with the chosen plan.
    fn trace(&mut self, number: usize) {
        if let Some(name) = &self.program.configuration.settings.trace {
            let function = self.names.interface(&name.text);
            let arguments = self.names.action_arguments(&[format!("{number}U")]);
            self.writer.line(format!("{function}({arguments});"));
        }
    }

    fn body(&mut self) {
        let plan = self.plan;
        if plan.steps().any(Step::can_fail) {
            self.writer.line("outcome = OUTCOME_FAILED;");
        }
        for step in plan.steps() {
            self.step(step);
        }
        for (index, id) in &plan.outputs {
            let variable = plan.variables[id.0].name.clone();
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
            Step::Post { handler, values, deadline } => {
                let values = self.values(values);
                let due = deadline.as_ref().map(|deadline| self.value(deadline));
                if let Some(due) = due {
                    self.limit(*handler, &values, due);
                }
                self.post(*handler, values);
            }
            Step::Defer { handler, values } => {
                let values = self.values(values);
                let arguments = self.names.arguments(values);
                let trigger = handler_name(self.program, *handler);
                self.writer.line(format!("defer_{trigger}({arguments});"));
            }
            Step::Broadcast { basic, values, .. } => self.broadcast(*basic, values),
            Step::Ask { belief, patterns, plans: None } => self.ask_beliefs(*belief, patterns),
            Step::Ask { belief, patterns, plans: Some(plans) } => {
                self.ask(*belief, patterns, *plans);
            }
        }
    }

    /// The action for each peer but oneself.
    fn broadcast(&mut self, basic: BasicId, values: &[Value]) {
        let program = self.program;
        let values = self.values(values);
        let function = self.names.action(program.basic(basic));
        let me = self.names.field("me");
        for number in 0..program.configuration.peers.len() {
            let peer = program.peer(number);
            let arguments: Vec<String> =
                std::iter::once(peer.clone()).chain(values.clone()).collect();
            let arguments = self.names.action_arguments(&arguments);
            self.writer.open(format!("if ({me} != {peer})"));
            self.writer.line(format!("{function}({arguments});"));
            self.writer.close("}");
        }
    }

    /// Queries only the beliefs. In a body all arguments are evaluated first.
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
            self.constant(&variable.ctype, &variable.name, text);
        }
    }

    /// Queries the beliefs, then the plans; continues with the answers.
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
                self.variable(&ctype.name, &answer, zero);
                arguments.push(format!("&{answer}"));
                answers.push((index, answer, field));
            }
        }
        self.variable("bool", &answered, "false");
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
        let comparable = declared.types.iter().all(CType::has_equality);
        for (index, value) in values.iter().enumerate() {
            let ctype = &declared.types[index];
            if raise != Raise::Nothing && comparable {
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
            self.constant(&CType::named("bool"), &changed, &condition);
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
        self.constant(&CType::named("bool"), &changed, &conjunction(&conditions));
        self.writer.open(format!("if ({changed})"));
        self.writer.line(format!("{held} = false;"));
        self.writer.close("}");
        let old = (0..declared.types.len())
            .map(|index| self.names.field(&belief_value(&declared.name, index)))
            .collect();
        self.raise(&changed, raise, old);
    }

    /// Runs or posts the plans of a percept if the belief has changed.
    fn raise(&mut self, changed: &str, raise: Raise, mut values: Vec<String>) {
        if let Raise::Post(handler) | Raise::Call(handler) = raise
            && self.program.handler(handler).sourced
        {
            values.push(self.names.field("me"));
        }
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
                self.variable("outcome_t", &outcome, "OUTCOME_ACHIEVED");
                self.writer.open(format!("if ({changed})"));
                self.writer.line(format!("{outcome} = run_{trigger}({arguments});"));
                self.writer.close("}");
                self.open(&format!("{outcome} != OUTCOME_FAILED"));
            }
        }
    }

    /// Sets the deadline of a goal; its arguments are stored for failure plans.
    fn limit(&mut self, handler: HandlerId, values: &[String], due: String) {
        let kept = limited_types(self.program, handler).len();
        let arguments = values[..kept].iter().cloned().chain([due]);
        let arguments = self.names.arguments(arguments);
        let trigger = handler_name(self.program, handler);
        self.writer.line(format!("limit_{trigger}({arguments});"));
    }

    fn post(&mut self, handler: HandlerId, values: Vec<String>) {
        let arguments = self.names.arguments(values);
        let trigger = handler_name(self.program, handler);
        self.writer.line(format!("post_{trigger}({arguments});"));
    }
}
