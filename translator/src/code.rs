//! The kinds of errors and warnings, each with a name that stays.

use diagnostic::{Diagnostic, Severity, Span};

macro_rules! codes {
    ($($severity:ident $code:ident $name:literal $meaning:literal;)*) => {
        /// A kind of error or warning. Its [name](Code::name) is what a [`Diagnostic`] has as its code: it is never
        /// given another meaning, while messages may be worded anew.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = $meaning] $code,)*
        }

        impl Code {
            /// All kinds: errors, then warnings with the most important first.
            pub const ALL: &[Self] = &[$(Self::$code),*];

            /// Its name: words with hyphens between.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$code => $name),* }
            }

            /// Whether nothing is translated in spite of it.
            pub const fn severity(self) -> Severity {
                match self { $(Self::$code => Severity::$severity),* }
            }

            /// Meaning in a few words, as in the language guide.
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$code => $meaning),* }
            }
        }
    };
}

codes! {
    Error Syntax "syntax" "text that is not of the language: something else is expected there";
    Error NotClosed "not-closed" "a comment, a string or an include without its end";
    Error MalformedNumber "malformed-number" "digits that are no number, or no number of steps";
    Error MalformedString "malformed-string" "an escape that is none, or a NUL in a string";
    Error Limit "limit" "more nesting, operators, arguments or ways to ask than are translated";
    Error NoPlans "no-plans" "an agent without a plan";
    Error UnknownAction "unknown-action" "an internal action that is none, such as `.print`";
    Error UnknownSection "unknown-section" "a section of the configuration that is none";
    Error UnknownSetting "unknown-setting" "a setting that is none";
    Error MissingSetting "missing-setting" "a setting that every configuration needs";
    Error SettingValue "setting-value" "a setting with a value that it cannot have";
    Error ExclusiveSettings "exclusive-settings" "two settings of which only one can be";
    Error UnknownFormula "unknown-formula" "a property of a form that is none";
    Error NotAType "not-a-type" "words that are no type of C, or none for this place";
    Error StructField "struct-field" "a struct without fields, or with one that is no number or `bool`";
    Error FileName "file-name" "an output that C cannot include, or outside the output's folder";
    Error Overwrites "overwrites" "an output that would take the place of something else";
    Error WrongSignature "wrong-signature" "`updateBeliefs` declared in another way";
    Error DeclaredTwice "declared-twice" "a name, section, setting or trigger that stands twice";
    Error ReservedName "reserved-name" "a name that C, Rust or generated code needs";
    Error RustBoundary "rust-boundary" "something that the Rust side has no counterpart for";
    Error NotDeclared "not-declared" "an action, belief, goal or clock that the configuration does not declare";
    Error WrongKind "wrong-kind" "a belief or goal where an action should stand, or the other way round";
    Error ArgumentCount "argument-count" "too few or too many arguments";
    Error WrongType "wrong-type" "a value of another type than is expected, or one that does not fit it";
    Error UnknownType "unknown-type" "a constant that could be of several types";
    Error NoValue "no-value" "an action that returns nothing where a value is needed";
    Error NotAValue "not-a-value" "a condition where a value is needed";
    Error NotACondition "not-a-condition" "a value where a condition is needed";
    Error NotConstant "not-constant" "an initial belief or goal with something else than constants";
    Error NotComparable "not-comparable" "values that C or a property cannot compare";
    Error ConstantComparison "constant-comparison" "a comparison that always holds, or never";
    Error UnboundVariable "unbound-variable" "a variable that has no value there";
    Error BoundTwice "bound-twice" "`=` for a variable that has a value";
    Error MissingPlan "missing-plan" "a goal or trigger without a plan, or a failure plan that can never run";
    Error Recursion "recursion" "a goal that leads back to itself before the end of its plan";
    Error NoClock "no-clock" "`.wait` or a deadline in an agent without a clock";
    Error NotAClock "not-a-clock" "a clock that takes arguments, or is too narrow";
    Error IdleDeadline "idle-deadline" "a deadline of a goal that is achieved at once";
    Error WaitInTestGoal "wait-in-test-goal" "`.wait` in the plan of a test goal";
    Error AskedArgument "asked-argument" "an argument that a test goal asks for, used as if it had a value";
    Error NeverAnswered "never-answered" "an argument that a test goal asks for and its plan gives no value";
    Error Unanswerable "unanswerable" "a test goal that its plans cannot answer";
    Error UnaskableType "unaskable-type" "a test goal that asks for a value of a type that cannot be kept";
    Error NotTriggerable "not-triggerable" "an event that the environment does not, or cannot, raise";
    Error NotSettable "not-settable" "a perceived belief that the environment does not set";
    Error NotPreemptive "not-preemptive" "a pre-empting event that is no goal";
    Error ComparedUnbelieved "compared-unbelieved" "a property that compares what is never believed";
    Warning UnseenFailure "unseen-failure" "failure plans that cannot see what their goal comes to in later steps";
    Warning NoPlan "no-plan" "goals that may find no plan while no `-!g` is there to mend it";
    Warning NeverTried "never-tried" "plans behind one that always applies";
    Warning NeverBelieved "never-believed" "beliefs that a context asks for and nothing makes true";
    Warning NeverTriggered "never-triggered" "plans of events that nothing raises";
    Warning NeverAsked "never-asked" "plans of test goals that nobody asks";
    Warning UnusedVariable "unused-variable" "variables that nobody uses";
    Warning UnusedDeclaration "unused-declaration" "declarations that nobody uses; actions of a library, if more than three, in one line";
}

/// A section for each kind, in their order.
const EXPLANATIONS: &str = include_str!("explanations.md");

impl Code {
    /// The kind of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|code| code.name() == name)
    }

    /// What is wrong, why that matters and what to do, mostly with an example, as Markdown. Blocks called `wrong` and
    /// `right` hold agents.
    pub fn explanation(self) -> &'static str {
        let sections = EXPLANATIONS.split("## ").filter_map(|section| section.split_once('\n'));
        let mut own = sections.filter(|(name, _)| *name == self.name());
        own.next().map_or("", |(_, text)| text.trim())
    }

    /// The kinds of warnings, the most important first: people may allow, ask for or deny each.
    pub fn warnings() -> impl Iterator<Item = Self> {
        Self::ALL.iter().copied().filter(|code| code.severity() == Severity::Warning)
    }

    /// A message of this kind.
    pub(crate) fn at(self, message: impl Into<String>, span: Span) -> Diagnostic {
        match self.severity() {
            Severity::Error => Diagnostic::error(message, span).code(self.name()),
            Severity::Warning => Diagnostic::warning(message, span).lint(self.name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn names_are_unique_and_plain() {
        let names: HashSet<&str> = Code::ALL.iter().map(|code| code.name()).collect();
        assert_eq!(names.len(), Code::ALL.len());
        let plain = |name: &str| name.chars().all(|c| c.is_ascii_lowercase() || c == '-');
        assert!(names.into_iter().all(plain));
    }

    /// The guide has a row for each kind, in the words that stand here, and for no other.
    #[test]
    fn every_kind_is_in_the_guide() {
        let guide = include_str!("../../docs/agentspeak.md");
        let (_, rest) = guide.split_once("| code | is said of |\n|---|---|\n").unwrap();
        let errors = rest.split_once("\n\n").unwrap().0.lines();
        let (_, rest) = guide.split_once("| code | warns of |\n|---|---|\n").unwrap();
        let warnings = rest.split_once("\n\n").unwrap().0.lines();
        let rows: Vec<&str> = errors.chain(warnings).collect();
        let row = |code: &Code| format!("| `{}` | {} |", code.name(), code.meaning());
        let expected: Vec<String> = Code::ALL.iter().map(row).collect();
        assert_eq!(rows, expected);
    }

    /// What the examples of explanations are translated with.
    const EXAMPLE: &str =
        "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; clock = now; };
        basics { void on(void); void show(int32_t); int32_t read(void); bool dark(void); int64_t now(void); };
        types { light(void); dim(int32_t); level(int32_t); asked(int32_t); pair(int32_t, int32_t); idle(void); }; settables { level; };
        triggerables { +!light; +!dim; };";

    /// The codes of all that is found in an agent.
    fn found(agent: &str) -> Vec<&'static str> {
        // Events without a plan are none of the example.
        let mut text = EXAMPLE.to_owned();
        for event in ["+!light", "+!dim"] {
            if !agent.contains(event) {
                text = text.replace(&format!("{event};"), "");
            }
        }
        let configuration = crate::parse_configuration("a.conf", &text).unwrap();
        match crate::translate(&configuration, agent) {
            Ok(translation) => translation.warnings.iter().map(|found| found.code).collect(),
            Err(error) => error.diagnostics().iter().map(|found| found.code).collect(),
        }
    }

    #[test]
    fn every_kind_is_explained_and_its_examples_are_of_it() {
        let titles = EXPLANATIONS.lines().filter_map(|line| line.strip_prefix("## "));
        assert!(titles.eq(Code::ALL.iter().map(|code| code.name())));
        let mut examples = 0;
        for code in Code::ALL {
            let text = code.explanation();
            assert!(text.len() > 60, "{}: {text}", code.name());
            assert_eq!(text.matches("```wrong\n").count(), text.matches("```right\n").count());
            for (block, is_right) in [("```wrong\n", false), ("```right\n", true)] {
                for example in text.split(block).skip(1) {
                    let agent = example.split("```").next().unwrap();
                    let found = found(agent);
                    assert_eq!(
                        found.contains(&code.name()),
                        !is_right,
                        "{code:?}: {agent}{found:?}"
                    );
                    let errors = found.iter().filter_map(|name| Code::named(name));
                    let errors = errors.filter(|code| code.severity() == Severity::Error);
                    assert!(!is_right || errors.count() == 0, "{agent}{found:?}");
                    examples += 1;
                }
            }
        }
        assert!(examples > 50, "{examples}");
    }

    /// There is no message without a kind.
    #[test]
    fn no_message_is_made_in_another_way() {
        let mut folders =
            vec![std::path::PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src"))];
        let mut bare = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else if !path.ends_with("code.rs") {
                    let text = std::fs::read_to_string(&path).unwrap();
                    let lines = text.lines().filter(|line| {
                        ["Diagnostic::error", "Diagnostic::warning"]
                            .iter()
                            .any(|made| line.contains(made))
                    });
                    bare.extend(lines.map(|line| line.trim().to_owned()));
                }
            }
        }
        // What follows from another error is not said at all.
        assert_eq!(bare, ["Diagnostic::error(String::new(), 0..0)"]);
    }
}
