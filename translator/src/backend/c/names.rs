//! How things are called in the generated C.

use crate::configuration::Basic;
use crate::configuration::Instance;
use crate::program::Program;
use crate::types::CType;

/// Spelling of everything that depends on the kind of instance.
pub(super) struct Names {
    instance: Instance,
    prefix: String,
}

impl Names {
    pub(super) fn new(program: &Program) -> Self {
        Self { instance: program.configuration.settings.instance, prefix: symbol_prefix(program) }
    }

    pub(super) fn is_context(&self) -> bool {
        self.instance == Instance::Context
    }

    /// The type of the agent's state.
    pub(super) fn state_type(&self) -> String {
        format!("{}agent_t", self.prefix)
    }

    /// A function of the interface, `next_step` or `pilot_next_step`.
    pub(super) fn interface(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    /// A basic action as the environment provides it.
    pub(super) fn action(&self, basic: &Basic) -> String {
        format!("{}{}", self.prefix, basic.name.text)
    }

    /// A field of the agent's state.
    pub(super) fn field(&self, name: &str) -> String {
        match self.instance {
            Instance::Static => format!("agent.{name}"),
            Instance::Context => format!("self->{name}"),
        }
    }

    /// A parameter list that starts with the agent's state where it is passed in.
    pub(super) fn parameters(&self, types: &[CType]) -> String {
        let mut parameters = self.state_parameter();
        parameters.extend(typed_arguments(types));
        if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") }
    }

    /// The arguments of a call inside the agent.
    pub(super) fn arguments(&self, arguments: impl IntoIterator<Item = String>) -> String {
        let state = self.is_context().then(|| "self".to_owned());
        state.into_iter().chain(arguments).collect::<Vec<_>>().join(", ")
    }

    /// The arguments of a call of the environment.
    pub(super) fn action_arguments(&self, arguments: &[String]) -> String {
        let environment = self.is_context().then(|| "self->environment".to_owned());
        environment.into_iter().chain(arguments.iter().cloned()).collect::<Vec<_>>().join(", ")
    }

    /// `pilot_agent_t *self`, where the state is passed in.
    pub(super) fn state_parameter(&self) -> Vec<String> {
        if self.is_context() { vec![format!("{} *self", self.state_type())] } else { Vec::new() }
    }
}

/// What stands before every external symbol: with `instance = context` several agents can be
/// linked into one program.
pub(crate) fn symbol_prefix(program: &Program) -> String {
    let settings = &program.configuration.settings;
    match settings.instance {
        Instance::Static => String::new(),
        Instance::Context => {
            let file = settings.output.rsplit('/').next().unwrap_or_default();
            let stem = file.split('.').next().unwrap_or_default();
            let stem: String =
                stem.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
            format!("{}_", stem.trim_start_matches(|c: char| c.is_ascii_digit() || c == '_'))
        }
    }
}

/// The linker's name of a basic action.
pub(crate) fn action_symbol(program: &Program, name: &str) -> String {
    format!("{}{name}", symbol_prefix(program))
}

/// `double argument1`, `int argument2`, ..
pub(super) fn typed_arguments(types: &[CType]) -> impl Iterator<Item = String> {
    types.iter().enumerate().map(|(index, ctype)| typed(ctype, &argument(index)))
}

/// `argument1`, `argument2`, ..
pub(super) fn argument_names(types: &[CType]) -> impl Iterator<Item = String> {
    (0..types.len()).map(argument)
}

/// The name of the argument with this index.
pub(super) fn argument(index: usize) -> String {
    format!("argument{}", index + 1)
}

/// `double x`, `const char *x`
pub(super) fn typed(ctype: &CType, name: &str) -> String {
    if ctype.name.ends_with('*') {
        format!("{}{name}", ctype.name)
    } else {
        format!("{} {name}", ctype.name)
    }
}

/// A local that never changes: `const double x`, `const char *const x`.
pub(super) fn constant(ctype: &CType, name: &str) -> String {
    if ctype.name.ends_with('*') {
        format!("{}const {name}", ctype.name)
    } else {
        format!("const {} {name}", ctype.name)
    }
}

/// Text that can stand inside a C comment.
pub(super) fn comment_safe(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?").replace('\\', "/")
}
