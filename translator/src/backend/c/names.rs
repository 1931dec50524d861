//! Names in the generated C.

use diagnostic::is_printable;

use crate::configuration::Basic;
use crate::configuration::Instance;
use crate::program::Program;
use crate::types::CType;

/// Names that depend on the kind of instance.
pub(super) struct Names {
    instance: Instance,
    prefix: String,
    /// The agent is told which of its peers it is.
    has_peers: bool,
}

impl Names {
    pub(super) fn new(program: &Program) -> Self {
        Self {
            instance: program.instance,
            prefix: symbol_prefix(program),
            has_peers: program.has_peers(),
        }
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

    /// A parameter list, starting with the agent's state if it is passed in.
    pub(super) fn parameters(&self, types: &[CType]) -> String {
        listed(self.state_parameter().into_iter().chain(typed_arguments(types)))
    }

    /// The head of a basic action's function, which begins with the environment's pointer if the state is passed in.
    pub(super) fn action_head(&self, basic: &Basic) -> String {
        let environment = self.is_context().then(|| "void *environment".to_owned());
        let parameters = environment.into_iter().chain(typed_arguments(&basic.parameters));
        typed(&basic.result, &format!("{}({})", self.action(basic), listed(parameters)))
    }

    /// The head of the environment's `updateBeliefs()`.
    pub(super) fn update_head(&self) -> String {
        let state = || format!("{} *agent, void *environment", self.state_type());
        let parameters = listed(self.is_context().then(state));
        format!("void {}({parameters})", self.interface("updateBeliefs"))
    }

    /// A call of the interface.
    pub(super) fn call(&self, name: &str, arguments: impl IntoIterator<Item = String>) -> String {
        format!("{}({})", self.interface(name), self.arguments(arguments))
    }

    /// A call of `init()` with this pointer of the environment, if it has one, and as this peer, if it has peers.
    pub(super) fn init_call(&self, environment: &str, me: &str) -> String {
        let environment = self.is_context().then(|| environment.to_owned());
        self.call("init", environment.into_iter().chain(self.has_peers.then(|| me.to_owned())))
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

    /// `pilot_agent_t *self`, if the state is passed in.
    pub(super) fn state_parameter(&self) -> Vec<String> {
        if self.is_context() { vec![format!("{} *self", self.state_type())] } else { Vec::new() }
    }
}

/// Prefix of every external symbol: with `instance = context` several agents can be linked into one program.
pub(crate) fn symbol_prefix(program: &Program) -> String {
    program.configuration.settings.symbol_prefix(program.instance)
}

/// Linker symbol of a basic action.
pub(crate) fn action_symbol(program: &Program, name: &str) -> String {
    format!("{}{name}", symbol_prefix(program))
}

/// `double argument1`, `int argument2`, ..
pub(super) fn typed_arguments(types: &[CType]) -> impl Iterator<Item = String> {
    types.iter().enumerate().map(|(index, ctype)| typed(ctype, &argument(index)))
}

/// A list of parameters, or `void`.
pub(super) fn listed(parameters: impl IntoIterator<Item = String>) -> String {
    let parameters = parameters.into_iter().collect::<Vec<_>>().join(", ");
    if parameters.is_empty() { "void".to_owned() } else { parameters }
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

/// A local constant: `const double x`, `const char *const x`.
pub(super) fn constant(ctype: &CType, name: &str) -> String {
    if ctype.name.ends_with('*') {
        format!("{}const {name}", ctype.name)
    } else {
        format!("const {} {name}", ctype.name)
    }
}

/// Makes text safe for a comment of C or Rust: nothing in it can end the comment, begin another one, join
/// lines, or be displayed as something else.
pub(crate) fn comment_safe(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    let mut last = ' ';
    for character in text.chars() {
        let character = match character {
            // At the end of a line it would join the next.
            '\\' => '/',
            '\n' => '\n',
            other if is_printable(other) => other,
            _ => ' ',
        };
        // Checked on the output, so that a replacement cannot create a pair either.
        if matches!((last, character), ('*' | '/', '/') | ('/', '*') | ('?', '?')) {
            safe.push(' ');
        }
        safe.push(character);
        last = character;
    }
    safe
}

/// The path from the folder of one output to another, for `#include`.
pub fn include_path(from: &str, to: &str) -> String {
    let folder: Vec<&str> = from.split('/').collect();
    let folder = &folder[..folder.len() - 1];
    let target: Vec<&str> = to.split('/').collect();
    let common = folder.iter().zip(&target[..target.len() - 1]).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..", folder.len() - common);
    up.chain(target[common..].iter().copied()).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_comment_ends_begins_or_joins_lines() {
        for (text, expected) in [
            ("see *\\ int f(void){} \\*", "see * / int f(void){} / *"),
            ("*/ /* //", "* / / * / /"),
            ("???/", "? ? ?/"),
            ("\\*/", "/ * /"),
            ("/*/", "/ * /"),
            ("a\\\nb", "a/\nb"),
            ("x\u{202e}y\r\u{0}", "x y  "),
            ("X \\== Y", "X /== Y"),
        ] {
            assert_eq!(comment_safe(text), expected, "{text:?}");
        }
    }

    #[test]
    fn includes_find_their_way() {
        for (from, to, expected) in [
            ("a.c", "a.h", "a.h"),
            ("gen/a.c", "gen/a.h", "a.h"),
            ("gen/a.c", "a.h", "../a.h"),
            ("a.c", "inc/a.h", "inc/a.h"),
            ("src/x/a.c", "src/inc/a.h", "../inc/a.h"),
        ] {
            assert_eq!(include_path(from, to), expected);
        }
    }
}
