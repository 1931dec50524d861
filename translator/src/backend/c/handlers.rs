//! One C function for each plan, and one for each trigger that tries its plans in order.

use super::emitter::PlanEmitter;
use super::helpers::Helpers;
use super::names::{Names, argument, argument_names, comment_safe, typed};
use super::state::handler_name;
use crate::backend::writer::Writer;
use crate::program::{Handler, HandlerId, Plan, Program};

/// Prototypes of the handlers, which may call each other in any order.
pub(super) fn prototypes(writer: &mut Writer, program: &Program, names: &Names) {
    for (id, handler) in program.handlers() {
        writer.line(format!("{};", handler_head(program, names, id, handler)));
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
    let mut emission = Emission { writer, program, names, input, helpers: Helpers::default() };
    let mut plans = 0;
    for (id, handler) in program.handlers() {
        let trigger = handler_name(program, id);
        for (number, plan) in handler.plans.iter().enumerate() {
            emission.plan(handler, plan, plans, &plan_name(number, &trigger));
            plans += 1;
        }
        emission.handler(id, handler);
    }
    emission.helpers
}

/// The C function of a trigger's plan, counted from 0.
pub(crate) fn plan_name(number: usize, trigger: &str) -> String {
    format!("plan{}_{trigger}", number + 1)
}

fn handler_head(program: &Program, names: &Names, id: HandlerId, handler: &Handler) -> String {
    let trigger = handler_name(program, id);
    format!("static outcome_t run_{trigger}({})", parameters(names, handler).join(", "))
}

/// The parameters of a handler and its plans; queried arguments are passed as pointers.
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

/// Common data of all functions.
struct Emission<'a> {
    writer: &'a mut Writer,
    program: &'a Program,
    names: &'a Names,
    input: &'a str,
    helpers: Helpers,
}

impl Emission<'_> {
    fn handler(&mut self, id: HandlerId, handler: &Handler) {
        let Self { writer, program, names, .. } = self;
        let trigger = handler_name(program, id);
        let arguments = names.arguments(argument_names(&handler.types));
        let text = handler.text();
        writer.line(if handler.resumed {
            format!("/* {text}: the rest of a plan that waits. It continues when the time has passed. */")
        } else {
            format!("/* Plans of {text}, in order. */")
        });
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
            // The rest of a plan that waits starts with the arguments of its goal.
            let types = &program.handler(failure).types;
            let arguments = names.arguments(argument_names(types));
            writer.line(format!("outcome = run_{}({arguments});", handler_name(program, failure)));
            writer.close("}");
        }
        writer.line("return outcome;");
        writer.close("}");
        writer.line("");
    }

    /// One plan; `number` is passed to the trace function.
    fn plan(&mut self, handler: &Handler, plan: &Plan, number: usize, name: &str) {
        let Self { writer, program, names, input, helpers } = self;
        writer.line(format!("/* {}:{}", comment_safe(input), plan.lines.0));
        for line in comment_safe(&plan.source).lines() {
            writer.line(format!(" * {}", line.trim_end()).trim_end());
        }
        writer.line(" */");
        let mut parameters = parameters(names, handler);
        let body =
            PlanEmitter::new(program, names, helpers, plan).emit(handler, number, &mut parameters);
        writer.open(format!("static outcome_t {name}({})", parameters.join(", ")));
        writer.line("outcome_t outcome = OUTCOME_NOT_APPLICABLE;");
        writer.line("");
        if names.is_context() {
            // Not every plan needs the state.
            writer.line("(void)self;");
        }
        for line in body.lines() {
            writer.line(line.strip_prefix("    ").unwrap_or(line));
        }
        writer.line("return outcome;");
        writer.close("}");
        writer.line("");
    }
}
