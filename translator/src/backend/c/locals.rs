//! Locals of a plan's function.
//!
//! Each local is declared where it gets its value, so that it cannot be read before. If the blocks around it
//! are closed before its last use it is declared at the head of the function.

use std::collections::HashMap;

/// Placeholder for a local until the place of its declaration is known.
const MARK: char = '\u{1}';

/// A local.
pub(super) struct Local {
    pub(super) name: String,
    /// Its declaration as a constant, without its value.
    pub(super) constant: String,
    /// Its declaration as a variable, without its value.
    pub(super) plain: String,
    /// Its initial value if it is declared at the head.
    pub(super) start: String,
    /// Its only value, unless it is changed later.
    pub(super) value: Option<String>,
}

/// The locals of one function.
#[derive(Default)]
pub(super) struct Locals {
    locals: Vec<Local>,
    /// Declarations at the head of the function.
    head: Vec<String>,
}

impl Locals {
    /// The placeholder line of a local.
    pub(super) fn add(&mut self, local: Local) -> String {
        self.locals.push(local);
        format!("{MARK}{}", self.locals.len() - 1)
    }

    /// Adds a declaration to the head of the function, because blocks are closed.
    pub(super) fn before(&mut self, declaration: String) {
        self.head.push(declaration);
    }

    /// The text with all declarations, and those at the head.
    pub(super) fn resolve(&self, text: &str) -> String {
        let outside =
            if self.head.is_empty() { vec![false; self.locals.len()] } else { self.outlived(text) };
        let mut out = String::with_capacity(text.len() * 2);
        for declaration in &self.head {
            out.extend(["    ", declaration, "\n"]);
        }
        for (local, _) in self.locals.iter().zip(&outside).filter(|(_, outside)| **outside) {
            out.extend(["    ", &local.plain, " = ", &local.start, ";\n"]);
        }
        if !self.head.is_empty() {
            out.push('\n');
        }
        for line in text.lines() {
            let Some(index) = marked(line) else {
                out.push_str(line);
                out.push('\n');
                continue;
            };
            let local = &self.locals[index];
            let Local { name, constant, plain, start, value } = local;
            let statement = match (value, outside[index]) {
                (Some(value), true) => format!("{name} = {value};"),
                (Some(value), false) => format!("{constant} = {value};"),
                // It is already initialised at the head.
                (None, true) => continue,
                (None, false) => format!("{plain} = {start};"),
            };
            let indentation = line.find(MARK).unwrap_or_default();
            out.push_str(&line[..indentation]);
            out.push_str(&statement);
            out.push('\n');
        }
        out
    }

    /// Locals that are used after the block in which they get their value.
    fn outlived(&self, text: &str) -> Vec<bool> {
        let names: HashMap<&str, usize> = self
            .locals
            .iter()
            .enumerate()
            .map(|(index, local)| (local.name.as_str(), index))
            .collect();
        let mut last_use = vec![0; self.locals.len()];
        let mut ends = vec![usize::MAX; self.locals.len()];
        let mut open: Vec<Vec<usize>> = vec![Vec::new()];
        for (number, line) in text.lines().enumerate() {
            match line.trim_start() {
                "{" => open.push(Vec::new()),
                "}" => {
                    for index in open.pop().into_iter().flatten() {
                        ends[index] = number;
                    }
                }
                _ => {}
            }
            let mut used = line;
            if let Some(index) = marked(line) {
                open.last_mut().into_iter().for_each(|block| block.push(index));
                used = self.locals[index].value.as_deref().unwrap_or_default();
            }
            for word in used.split(|c: char| !c.is_ascii_alphanumeric() && c != '_') {
                if let Some(index) = names.get(word) {
                    last_use[*index] = number;
                }
            }
        }
        last_use.into_iter().zip(ends).map(|(last, end)| last > end).collect()
    }
}

fn marked(line: &str) -> Option<usize> {
    line.trim_start().strip_prefix(MARK)?.parse().ok()
}
