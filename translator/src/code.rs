//! Kinds of errors and warnings, each with a stable name.

use diagnostic::{Diagnostic, Severity, Span};

macro_rules! codes {
    ($($severity:ident $code:ident $name:literal $meaning:literal;)*) => {
        /// A kind of error or warning. Its [name](Code::name) is the code of a [`Diagnostic`]. The meaning of
        /// a name never changes, while messages may be reworded.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $(#[doc = $meaning] $code,)*
        }

        impl Code {
            /// All kinds: errors, then warnings by importance.
            pub const ALL: &[Self] = &[$(Self::$code),*];

            /// Its name: words joined by hyphens.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$code => $name),* }
            }

            /// Whether it prevents translation.
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
    Error Syntax "syntax" "text that does not follow the grammar";
    Error NotClosed "not-closed" "a comment, a string or an include without its end";
    Error MalformedNumber "malformed-number" "digits that are not a number, or not a number of steps";
    Error MalformedString "malformed-string" "an unknown escape, or a NUL in a string";
    Error Limit "limit" "more nesting, operators, arguments or combinations of asked arguments than are supported";
    Error NoPlans "no-plans" "an agent without a plan";
    Error UnknownAction "unknown-action" "an unknown internal action, such as `.print`";
    Error UnknownSection "unknown-section" "an unknown section of the configuration";
    Error OtherVersion "other-version" "a version of the language that this compiler does not read";
    Error UnknownSetting "unknown-setting" "an unknown setting";
    Error MissingSetting "missing-setting" "a required setting is missing";
    Error SettingValue "setting-value" "an invalid value of a setting";
    Error ExclusiveSettings "exclusive-settings" "two settings that exclude each other";
    Error UnknownFormula "unknown-formula" "an unknown form of a property";
    Error NotAType "not-a-type" "words that are not a C type, or not one that is allowed there";
    Error StructField "struct-field" "a struct without fields, or with a field that is neither a number nor `bool`";
    Error FileName "file-name" "an output that C cannot include, or outside the output folder";
    Error NotRead "not-read" "a file that is named and cannot be read";
    Error Overwrites "overwrites" "an output that would overwrite another file";
    Error WrongSignature "wrong-signature" "`updateBeliefs` declared with another signature";
    Error DeclaredTwice "declared-twice" "a name, section, setting or trigger that is declared twice";
    Error NotInClass "not-in-class" "a class that leaves out what is not in the other class, or all of it";
    Error ReservedName "reserved-name" "a name that C, Rust or generated code uses";
    Error RustBoundary "rust-boundary" "something without a counterpart in the Rust bindings";
    Error NotDeclared "not-declared" "an action, belief, goal or clock that the configuration does not declare";
    Error WrongKind "wrong-kind" "a belief or goal in place of an action, or the other way round";
    Error ArgumentCount "argument-count" "too few or too many arguments";
    Error WrongType "wrong-type" "a value of the wrong type, or outside its range";
    Error UnknownType "unknown-type" "a constant that could be of several types";
    Error NoValue "no-value" "an action without a result where a value is needed";
    Error NotAValue "not-a-value" "a condition where a value is needed";
    Error NotACondition "not-a-condition" "a value where a condition is needed";
    Error NotConstant "not-constant" "an initial belief or goal with other arguments than constants";
    Error NotComparable "not-comparable" "values that C or a property cannot compare";
    Error ConstantComparison "constant-comparison" "a comparison with a constant result";
    Error UnboundVariable "unbound-variable" "a variable without a value";
    Error BoundTwice "bound-twice" "`=` for a variable that already has a value";
    Error MissingPlan "missing-plan" "a goal or trigger without a plan, or a failure plan that can never run";
    Error Recursion "recursion" "a recursive goal that is not the last formula of its plan";
    Error NoClock "no-clock" "`.wait` or a deadline in an agent without a clock";
    Error NoAge "no-age" "an age that nobody knows: without a clock, of one's own belief, or in a trigger";
    Error NotAClock "not-a-clock" "a clock that takes arguments, or is too narrow";
    Error IdleDeadline "idle-deadline" "a deadline of a goal that is achieved within one step";
    Error WaitInTestGoal "wait-in-test-goal" "`.wait` in the plan of a test goal";
    Error AskedArgument "asked-argument" "an argument that a test goal asks for, used as if it had a value";
    Error NeverAnswered "never-answered" "an argument that a test goal asks for and that its plan leaves without a value";
    Error Unanswerable "unanswerable" "a test goal that its plans cannot answer";
    Error UnaskableType "unaskable-type" "a test goal that asks for a value of a type that cannot be stored";
    Error NotTriggerable "not-triggerable" "an event that the environment does not, or cannot, raise";
    Error NotSettable "not-settable" "a perceived belief that the environment does not set";
    Error NotPreemptive "not-preemptive" "a pre-empting event that is not a goal";
    Error NeverSent "never-sent" "a source that never tells the belief or asks for the goal";
    Error OtherPeers "other-peers" "agents of a system that do not have the same peers and messages, or a peer without an agent";
    Error ComparedUnbelieved "compared-unbelieved" "a property that compares a belief that is never held";
    Warning UnseenFailure "unseen-failure" "failure plans that do not handle later failures of their goal";
    Warning NoPlan "no-plan" "goals that may find no plan and have no failure plan";
    Warning NeverTried "never-tried" "plans behind one that always applies";
    Warning NeverBelieved "never-believed" "beliefs in a context that nothing makes true";
    Warning NeverTriggered "never-triggered" "plans of events that nothing raises";
    Warning NeverAsked "never-asked" "plans of test goals that are never asked";
    Warning UnusedVariable "unused-variable" "variables that are never used";
    Warning UnusedDeclaration "unused-declaration" "declarations that are never used; unused actions of a library, if more than three, in one line";
}

/// One section per kind, in their order.
const EXPLANATIONS: &str = include_str!("explanations.md");

impl Code {
    /// Looks up a kind by its name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|code| code.name() == name)
    }

    /// Problem, consequences and remedy, usually with an example, as Markdown. Blocks named `wrong` and
    /// `right` contain agents.
    pub fn explanation(self) -> &'static str {
        let sections = EXPLANATIONS.split("## ").filter_map(|section| section.split_once('\n'));
        let mut own = sections.filter(|(name, _)| *name == self.name());
        own.next().map_or("", |(_, text)| text.trim())
    }

    /// The kinds of warnings by importance; users may allow, enable or deny each.
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

/// An error at the place that names a file by this path, which cannot be read for this reason.
pub fn not_read(path: &str, reason: &str, place: Span) -> Diagnostic {
    Code::NotRead
        .at(format!("cannot read `{path}`: {reason}"), place)
        .help("its path is relative to the folder of this file")
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

    /// The guide has exactly one row per kind, with the same words.
    #[test]
    fn every_kind_is_in_the_guide() {
        let guide = include_str!("../../docs/agentspeak.md");
        let (_, rest) = guide.split_once("| code | error |\n|---|---|\n").unwrap();
        let errors = rest.split_once("\n\n").unwrap().0.lines();
        let (_, rest) = guide.split_once("| code | warning |\n|---|---|\n").unwrap();
        let warnings = rest.split_once("\n\n").unwrap().0.lines();
        let rows: Vec<&str> = errors.chain(warnings).collect();
        let row = |code: &Code| format!("| `{}` | {} |", code.name(), code.meaning());
        let expected: Vec<String> = Code::ALL.iter().map(row).collect();
        assert_eq!(rows, expected);
    }

    /// Configuration of the examples in the explanations.
    const EXAMPLE: &str =
        "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; clock = now; };
        basics { void on(void); void show(int32_t); int32_t read(void); bool dark(void); int64_t now(void); };
        types { light(void); dim(int32_t); level(int32_t); asked(int32_t); pair(int32_t, int32_t); idle(void); }; settables { level; };
        triggerables { +!light; +!dim; };";

    /// The codes of all findings in an agent.
    fn found(agent: &str) -> Vec<&'static str> {
        // Missing plans of events are not part of the example.
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

    /// Every message has a kind.
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
        // Suppressed consequences of other errors have no message.
        assert_eq!(bare, ["Diagnostic::error(String::new(), 0..0)"]);
    }
}
