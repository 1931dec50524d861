//! The structure of generated C: which line is guarded by which condition. Generated C has braces on lines of their own
//! and no jumps but those at the end of a case.

use std::collections::BTreeMap;

/// A condition and the value that it must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Guard {
    /// The condition in this line is true.
    True(usize),
    /// The condition in this line is false.
    False(usize),
    /// The part with this index of the selection in this line.
    Case(usize, usize),
}

/// A part of a selection: the lines of its labels, and whether it has the default.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Case {
    pub(super) labels: Vec<usize>,
    pub(super) has_default: bool,
}

/// A function: its lines with statements or conditions, in order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Function {
    pub(super) name: String,
    pub(super) lines: Vec<usize>,
    /// The lines of its labels.
    pub(super) labels: Vec<usize>,
}

/// The structure of a file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Flow {
    pub(super) functions: Vec<Function>,
    /// The innermost guard of a line, if it has one.
    guards: BTreeMap<usize, Guard>,
    /// The parts of the selection in a line.
    pub(super) cases: BTreeMap<usize, Vec<Case>>,
}

/// An open brace.
struct Open {
    /// What its lines are guarded by.
    guard: Option<Guard>,
    /// The last `if` or `else if` directly inside.
    condition: Option<usize>,
    /// The selection whose parts are directly inside.
    selection: Option<usize>,
    /// Whether a label has just been read.
    is_labelled: bool,
}

impl Flow {
    pub(super) fn new(text: &str) -> Self {
        let mut flow = Self::default();
        let mut open: Vec<Open> = Vec::new();
        let mut header = (0, "");
        for (number, line) in (1..).zip(text.lines().map(str::trim)) {
            match line {
                "" => continue,
                "{" => {
                    let opened = flow.opened(&mut open, header);
                    open.push(opened);
                    continue;
                }
                _ if line.starts_with('}') => {
                    open.pop();
                    continue;
                }
                _ if line.starts_with("/*") || line.starts_with('*') || line == "(void)self;" => {
                    continue;
                }
                _ => header = (number, line),
            }
            let Some(block) = open.last_mut() else { continue };
            if let (true, Some(selection)) = (is_label(line), block.selection) {
                flow.label(block, selection, header);
                continue;
            }
            block.is_labelled = false;
            if let Some(guard) = block.guard {
                flow.guards.insert(number, guard);
            }
            if line.starts_with("if (") || line.starts_with("else if (") {
                block.condition = Some(number);
            }
            if let Some(function) = flow.functions.last_mut() {
                function.lines.push(number);
            }
        }
        flow
    }

    fn opened(&mut self, open: &mut [Open], (number, line): (usize, &str)) -> Open {
        let Some(around) = open.last() else {
            let name = line.split('(').next().unwrap_or_default();
            let name = name.rsplit([' ', '*']).next().unwrap_or_default().to_owned();
            self.functions.push(Function { name, lines: Vec::new(), labels: Vec::new() });
            return Open { guard: None, condition: None, selection: None, is_labelled: false };
        };
        let is = |start: &str| line.starts_with(start);
        let guard = if is("if (") || is("else if (") || is("for (") || is("while (") {
            Some(Guard::True(number))
        } else if line == "else" {
            around.condition.map(Guard::False)
        } else {
            around.guard
        };
        let selection = is("switch (").then_some(number);
        if let Some(selection) = selection {
            self.cases.insert(selection, Vec::new());
        }
        Open { guard, condition: None, selection, is_labelled: false }
    }

    /// A label begins another part, unless it follows a label.
    fn label(&mut self, block: &mut Open, selection: usize, (number, line): (usize, &str)) {
        let cases = self.cases.entry(selection).or_default();
        if !block.is_labelled {
            block.guard = Some(Guard::Case(selection, cases.len()));
            cases.push(Case::default());
        }
        block.is_labelled = true;
        if let Some(guard) = block.guard {
            self.guards.insert(number, guard);
        }
        let Some(case) = cases.last_mut() else { return };
        if line == "default:" {
            case.has_default = true;
        } else {
            case.labels.push(number);
            if let Some(function) = self.functions.last_mut() {
                function.labels.push(number);
            }
        }
    }

    /// The guards of a line, the innermost first.
    pub(super) fn guards(&self, line: usize) -> impl Iterator<Item = Guard> {
        let first = self.guards.get(&line).copied();
        std::iter::successors(first, |guard| {
            let (Guard::True(line) | Guard::False(line) | Guard::Case(line, _)) = guard;
            self.guards.get(line).copied()
        })
    }

    /// The function with a line.
    pub(super) fn function(&self, line: usize) -> Option<&Function> {
        self.functions.iter().find(|function| {
            let ends = function.lines.first().zip(function.lines.last());
            ends.is_some_and(|(first, last)| (*first..=*last).contains(&line))
        })
    }
}

fn is_label(line: &str) -> bool {
    line.starts_with("case ") || line == "default:"
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "static int f(int a)\n{\n    int b = 0;\n    (void)self;\n    if (a > 0)\n    {\n        b = 1;\n    }\n\
        \x20   else if (a > -3)\n    {\n        b = 2;\n    }\n    else\n    {\n        b = 3;\n    }\n    switch (b)\n    {\n        case 1:\n\
        \x20           g();\n            break;\n        case 2:\n        default:\n            /* Nothing. */\n            break;\n    }\n    return b;\n}\n";

    #[test]
    fn lines_have_their_guards() {
        let flow = Flow::new(TEXT);
        let guards = |line: usize| flow.guards(line).collect::<Vec<_>>();
        assert_eq!(guards(3), []);
        assert_eq!(guards(7), [Guard::True(5)]);
        assert_eq!(guards(11), [Guard::True(9)]);
        assert_eq!(guards(15), [Guard::False(9)]);
        assert_eq!(guards(20), [Guard::Case(17, 0)]);
        assert_eq!(guards(22), [Guard::Case(17, 1)]);
        assert_eq!(guards(25), [Guard::Case(17, 1)]);
        assert_eq!(guards(27), []);
        let case = |labels: &[usize], has_default| Case { labels: labels.to_vec(), has_default };
        assert_eq!(flow.cases[&17], [case(&[19], false), case(&[22], true)]);
        let [function] = &flow.functions[..] else { panic!("{flow:?}") };
        assert_eq!(function.name, "f");
        assert_eq!(function.lines, [3, 5, 7, 9, 11, 13, 15, 17, 20, 21, 25, 27]);
        assert_eq!(function.labels, [19, 22]);
        assert_eq!(flow.function(21).unwrap().name, "f");
    }
}
