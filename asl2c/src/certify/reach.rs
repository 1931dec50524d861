//! What the tests reach of the C, what no execution can reach, and what is left.

use std::collections::{BTreeSet, HashMap};

use serde::Serialize;

use super::flow::{Flow, Function, Guard};
use crate::coverage::{Counts, LineCount};
use crate::prove::DeadBranches;

/// Parts of the C that tests reach, that are proved to be unreachable, and others.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Reached {
    /// Reached by a test.
    pub tested: usize,
    /// Reached by no execution: proved.
    pub unreachable: usize,
    /// All parts.
    pub all: usize,
}

impl Reached {
    fn count(&mut self, tested: usize, unreachable: usize, all: usize) {
        self.tested += tested;
        self.unreachable += unreachable;
        self.all += all;
    }

    /// Parts that are neither.
    pub fn open(&self) -> usize {
        self.all - self.tested - self.unreachable
    }
}

/// Coverage of the C with the proofs.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Reach {
    /// Lines with statements.
    pub statements: Reached,
    /// Outcomes of conditions.
    pub outcomes: Reached,
    /// Conditions that tests show to decide independently (MC/DC), or of which an outcome is unreachable.
    pub conditions: Reached,
    /// Lines with something that is neither tested nor proved to be unreachable.
    pub open_lines: Vec<usize>,
    /// Lines with something unreachable, and nothing open.
    pub unreachable_lines: Vec<usize>,
    /// Lines in which a test has reached what is proved to be unreachable: one of the two is wrong.
    pub contradictions: Vec<usize>,
}

/// Functions of the interface that the proofs do not call, without the agent's prefix: nothing is said of them.
const NOT_CALLED: [&str; 6] = [
    "init",
    "can_add_event",
    "unhandled_events",
    "refused_events",
    "aborted_events",
    "forget_events",
];

/// Brings the counts of the C together with the dead branches of `proved`, the same C in the form of the proofs.
pub(super) fn reach(c: &str, counts: &Counts, proved: &str, dead: &DeadBranches) -> Reach {
    let flow = Flow::new(c);
    let dead = translated(&flow, &Flow::new(proved), dead);
    let lines: Vec<&str> = c.lines().collect();
    let mut reach = Reach::default();
    for counted in &counts.lines {
        let text = lines.get(counted.line.saturating_sub(1)).map_or("", |line| line.trim());
        one_line(&mut reach, counted, text, &flow, &dead);
    }
    reach
}

fn one_line(reach: &mut Reach, counted: &LineCount, text: &str, flow: &Flow, dead: &DeadBranches) {
    let line = counted.line;
    let is_dead = is_dead(line, flow, dead);
    let mut is_open = false;
    let mut has_unreachable = false;
    let mut count = |share: &mut Reached, tested: usize, unreachable: usize, all: usize| {
        // What both claim is told as a contradiction below.
        let unreachable = unreachable.min(all - tested);
        share.count(tested, unreachable, all);
        is_open |= tested + unreachable < all;
        has_unreachable |= unreachable > 0;
    };
    let ran = usize::from(counted.count > 0);
    count(&mut reach.statements, ran, usize::from(is_dead), 1);
    let outcomes = counted.outcomes();
    let impossible = if is_dead {
        outcomes.all
    } else {
        impossible_outcomes(line, text, outcomes.all, flow, dead)
    };
    count(&mut reach.outcomes, outcomes.ran, impossible, outcomes.all);
    if !text.starts_with("switch (") && outcomes.all > 0 {
        let conditions = outcomes.all / 2;
        let is_mixed = text.contains("&&") && text.contains("||");
        let shown = outcomes.is_whole() && !is_mixed;
        let excused = !shown && !is_mixed && outcomes.ran + impossible >= outcomes.all;
        let (shown, excused) = (usize::from(shown), usize::from(excused));
        count(&mut reach.conditions, shown * conditions, excused * conditions, conditions);
    }
    if outcomes.ran + impossible > outcomes.all || (is_dead && ran > 0) {
        reach.contradictions.push(line);
    }
    if is_open {
        reach.open_lines.push(line);
    } else if has_unreachable {
        reach.unreachable_lines.push(line);
    }
}

/// Whether no execution comes to a line.
fn is_dead(line: usize, flow: &Flow, dead: &DeadBranches) -> bool {
    let function = flow.function(line);
    let is_never_entered = function.is_some_and(|function| dead.functions.contains(&function.name));
    is_never_entered
        || flow.guards(line).any(|guard| match guard {
            Guard::True(line) => dead.never_true.contains(&line),
            Guard::False(line) => dead.never_false.contains(&line),
            Guard::Case(line, index) => is_dead_case(line, index, flow, dead),
        })
}

/// Whether a part of a selection is never chosen: none of its labels, and not the default.
fn is_dead_case(line: usize, index: usize, flow: &Flow, dead: &DeadBranches) -> bool {
    let Some(cases) = flow.cases.get(&line) else { return false };
    // A label jumps to what it guards: its condition is that the value is another one.
    let last = cases.iter().flat_map(|case| &case.labels).max();
    let is_default_dead = last.is_some_and(|last| dead.never_true.contains(last));
    cases.get(index).is_some_and(|case| {
        case.labels.iter().all(|label| dead.never_false.contains(label))
            && (!case.has_default || is_default_dead)
    })
}

/// A lower bound of the outcomes of a line's conditions that no execution has.
fn impossible_outcomes(
    line: usize,
    text: &str,
    outcomes: usize,
    flow: &Flow,
    dead: &DeadBranches,
) -> usize {
    if let Some(cases) = flow.cases.get(&line) {
        let all = 0..cases.len();
        return all.filter(|index| is_dead_case(line, *index, flow, dead)).count().min(outcomes);
    }
    if outcomes == 0 {
        // A label.
        return 0;
    }
    let conditions = outcomes / 2;
    let (never_true, never_false) =
        (dead.never_true.contains(&line), dead.never_false.contains(&line));
    let (and, or) = (text.contains("&&"), text.contains("||"));
    // A chain of `&&` is never true: its last condition is not, for one. It is never false: none of its conditions is.
    let of_true = match (and, or) {
        (true, true) => 0,
        (false, true) => conditions,
        (true | false, false) => 1,
    };
    let of_false = match (and, or) {
        (true, true) => 0,
        (true, false) => conditions,
        (false, true | false) => 1,
    };
    usize::from(never_true) * of_true + usize::from(never_false) * of_false
}

/// The dead branches in the lines of the C. The C of the proofs has its state passed in, and may differ in that from the C:
/// functions with the same name have the same lines in the same order.
fn translated(flow: &Flow, proved: &Flow, dead: &DeadBranches) -> DeadBranches {
    let mut lines = HashMap::new();
    let mut names = HashMap::new();
    for function in flow.functions.iter().filter(|function| is_called(&function.name)) {
        // Names of the interface have the agent's prefix there.
        let prefixed = format!("_{}", function.name);
        let is_same = |other: &&Function| other.name == function.name;
        let is_prefixed = |other: &&Function| other.name.ends_with(&prefixed);
        let others = &proved.functions;
        let other = others.iter().find(is_same).or_else(|| others.iter().find(is_prefixed));
        let Some(other) = other else { continue };
        let counts = |function: &Function| (function.lines.len(), function.labels.len());
        if counts(other) == counts(function) {
            names.insert(other.name.as_str(), function.name.as_str());
            lines.extend(other.lines.iter().copied().zip(function.lines.iter().copied()));
            lines.extend(other.labels.iter().copied().zip(function.labels.iter().copied()));
        }
    }
    let own =
        |all: &BTreeSet<usize>| all.iter().filter_map(|line| lines.get(line).copied()).collect();
    let functions = dead.functions.iter();
    let functions = functions.filter_map(|name| names.get(name.as_str()).copied());
    DeadBranches {
        functions: functions.map(str::to_owned).collect(),
        never_true: own(&dead.never_true),
        never_false: own(&dead.never_false),
    }
}

/// Whether the proofs call a function, so that they know whether it is entered.
fn is_called(name: &str) -> bool {
    !NOT_CALLED.iter().any(|other| name == *other || name.ends_with(&format!("_{other}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coverage::Counts;

    const C: &str = "static void f(void)\n{\n    if (agent.a)\n    {\n        g();\n    }\n}\n";
    const PROVED: &str = "static void f(p_t *self)\n{\n    (void)self;\n    if (self->a)\n    {\n        g(self);\n    }\n}\n";

    fn reached(counts: [[u64; 3]; 2], dead: &DeadBranches) -> Reach {
        let [[ran, on, off], [body, ..]] = counts;
        let counts = format!(
            r#"{{ "files": [{{ "file": "a.c", "lines": [
                {{ "line_number": 3, "count": {ran}, "branches": [{{ "count": {on} }}, {{ "count": {off} }}] }},
                {{ "line_number": 5, "count": {body}, "branches": [] }}] }}] }}"#
        );
        let counts = Counts::parse(&counts, "a.c").unwrap();
        reach(C, &counts, PROVED, dead)
    }

    #[test]
    fn what_is_not_tested_is_unreachable_or_open() {
        let nothing = DeadBranches::default();
        let never_true = DeadBranches { never_true: [4].into(), ..DeadBranches::default() };
        let known = reached([[1, 0, 1], [0, 0, 0]], &never_true);
        assert_eq!(known.outcomes, Reached { tested: 1, unreachable: 1, all: 2 });
        assert_eq!(known.statements, Reached { tested: 1, unreachable: 1, all: 2 });
        assert_eq!(known.conditions, Reached { tested: 0, unreachable: 1, all: 1 });
        assert_eq!((known.open_lines.len(), known.unreachable_lines), (0, vec![3, 5]));
        let unknown = reached([[1, 0, 1], [0, 0, 0]], &nothing);
        assert_eq!((unknown.outcomes.open(), unknown.open_lines), (1, vec![3, 5]));
        let whole = reached([[2, 1, 1], [1, 0, 0]], &nothing);
        assert_eq!((whole.conditions.tested, whole.open_lines.len()), (1, 0));
    }

    #[test]
    fn what_is_tested_and_unreachable_is_a_contradiction() {
        let never_true = DeadBranches { never_true: [4].into(), ..DeadBranches::default() };
        let both = reached([[2, 1, 1], [1, 0, 0]], &never_true);
        assert_eq!(both.contradictions, [3, 5]);
        let never_entered =
            DeadBranches { functions: ["f".to_owned()].into(), ..DeadBranches::default() };
        assert_eq!(reached([[1, 0, 1], [0, 0, 0]], &never_entered).contradictions, [3]);
        let fine = reached([[0, 0, 0], [0, 0, 0]], &never_entered);
        assert_eq!((fine.statements.unreachable, fine.contradictions.len()), (2, 0));
    }
}
