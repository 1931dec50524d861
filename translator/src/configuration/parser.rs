//! Parser of the configuration.

use diagnostic::{Diagnostic, Span, is_printable};

use super::outputs::check_outputs;
use super::scanner::{Parsed, Scanner, unknown_section};
use super::{Configuration, ExternalTrigger, Message};
use crate::code::Code;
use crate::syntax::ast::Name;

/// The names of the sections of a configuration.
pub const SECTIONS: [&str; 13] = [
    "settings",
    "includes",
    "structs",
    "basics",
    "classes",
    "peers",
    "messages",
    "types",
    "settables",
    "perceived",
    "triggerables",
    "preemptive",
    "properties",
];

/// Parses the text of a configuration. Returns what could be read, and all errors with their places; without errors the
/// configuration is complete. Missing settings and the names of outputs are judged if there is no other error, and of another
/// version of the language nothing is read.
pub fn parse(text: &str) -> (Configuration, Vec<Diagnostic>) {
    const BYTE_ORDER_MARK: char = '\u{feff}';
    let position = if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len_utf8() } else { 0 };
    let mut parser = Parser {
        scanner: Scanner { text, position },
        configuration: Configuration::default(),
        seen: Vec::new(),
        messages: Vec::new(),
        settings: text.len()..text.len(),
        diagnostics: Vec::new(),
    };
    parser.run();
    (parser.configuration, parser.diagnostics)
}

/// The state of the parser, which collects errors and goes on behind them.
pub(super) struct Parser<'a> {
    /// The text.
    pub(super) scanner: Scanner<'a>,
    /// What is declared so far.
    pub(super) configuration: Configuration,
    seen: Vec<&'a str>,
    /// Messages so far. The section `peers`, which names their senders, may stand behind them.
    pub(super) messages: Vec<Message>,
    /// Place of the section `settings`, or where it is missing.
    pub(super) settings: Span,
    /// The errors so far.
    pub(super) diagnostics: Vec<Diagnostic>,
}

impl<'a> Parser<'a> {
    fn run(&mut self) {
        if let Err(diagnostic) = self.scanner.version() {
            self.diagnostics.push(diagnostic);
            return;
        }
        loop {
            match self.section() {
                Ok(true) => {}
                Ok(false) => break,
                Err(diagnostic) => {
                    self.diagnostics.push(diagnostic);
                    // Continues behind the section, or stops if no section ends.
                    match self.scanner.rest().find('}') {
                        Some(offset) => self.scanner.position += offset + 1,
                        None => break,
                    }
                }
            }
        }
        self.declare_trace();
        self.resolve_structs();
        self.resolve_messages();
        if self.diagnostics.is_empty() {
            self.check_settings();
            self.diagnostics.extend(check_outputs(&self.configuration));
        }
    }

    fn section(&mut self) -> Parsed<bool> {
        self.scanner.skip_blanks()?;
        while self.scanner.take(";") {
            self.scanner.skip_blanks()?;
        }
        if self.scanner.rest().is_empty() {
            return Ok(false);
        }
        let name = self.scanner.word("a section name")?;
        let section: &'a str = &self.scanner.text[name.span.clone()];
        if !SECTIONS.contains(&section) {
            let unknown = unknown_section(name, &SECTIONS);
            return Err(if ["agents", "channels"].contains(&section) {
                unknown.help("this is a system of agents: `asl2c run` and `asl2c verify` know it, as `NAME.system`")
            } else {
                unknown
            });
        }
        if self.seen.contains(&section) {
            return Err(Code::DeclaredTwice
                .at(format!("a second section `{section}`"), name.span)
                .help("put its entries into the first one"));
        }
        self.seen.push(section);
        if section == "settings" {
            self.settings = name.span;
        }
        self.scanner.expect("{")?;
        if section == "includes" {
            return self.includes().map(|()| true);
        }
        self.scanner.skip_blanks()?;
        if section == "peers" && !self.scanner.rest().starts_with('}') {
            return self.peers().map(|()| true);
        }
        while !self.scanner.take("}") {
            if self.scanner.rest().is_empty() {
                return Err(self.scanner.unexpected("`}`"));
            }
            if let Err(diagnostic) = self.entry(section) {
                self.diagnostics.push(diagnostic);
                self.scanner.skip_entry();
            }
            self.scanner.skip_blanks()?;
        }
        Ok(true)
    }

    fn entry(&mut self, section: &str) -> Parsed<()> {
        match section {
            "settings" => self.setting(),
            "structs" => self.structure(),
            "basics" => self.basic(),
            "classes" => self.class(),
            "messages" => self.message(),
            "types" => self.predicate(),
            "settables" => {
                let name = self.scanner.word("a belief")?;
                self.scanner.expect(";")?;
                listed_once(&self.configuration.settables, &name)?;
                self.configuration.settables.push(name);
                Ok(())
            }
            "perceived" => {
                let name = self.scanner.word("a belief")?;
                self.scanner.expect(";")?;
                listed_once(&self.configuration.perceived, &name)?;
                self.configuration.perceived.push(name);
                Ok(())
            }
            "triggerables" => {
                let trigger = self.declared_trigger()?;
                self.configuration.triggerables.push(trigger);
                Ok(())
            }
            "preemptive" => {
                let trigger = self.declared_trigger()?;
                let same = |other: &ExternalTrigger| {
                    (other.operator, other.kind, &other.name.text)
                        == (trigger.operator, trigger.kind, &trigger.name.text)
                };
                if self.configuration.preemptive.iter().any(same) {
                    return Err(
                        Code::DeclaredTwice.at("this trigger is listed twice", trigger.span)
                    );
                }
                self.configuration.preemptive.push(trigger);
                Ok(())
            }
            _ => self.property(),
        }
    }

    fn declared_trigger(&mut self) -> Parsed<ExternalTrigger> {
        let trigger = self.scanner.trigger()?;
        self.scanner.expect(";")?;
        Ok(trigger)
    }

    /// `#include <file>` or `#include "file"`, one after the other.
    fn includes(&mut self) -> Parsed<()> {
        loop {
            self.scanner.skip_blanks()?;
            if self.scanner.take("}") {
                return Ok(());
            }
            let start = self.scanner.position;
            if !self.scanner.take("#include") {
                return Err(self.scanner.unexpected("`#include` or `}`"));
            }
            self.scanner.skip_blanks()?;
            let close = match self.scanner.rest().as_bytes().first() {
                Some(b'<') => '>',
                Some(b'"') => '"',
                _ => return Err(self.scanner.unexpected("`<file>` or `\"file\"`")),
            };
            let Some(length) = self.scanner.rest()[1..].find([close, '\n']) else {
                return Err(self.scanner.unexpected("a file name that ends on its line"));
            };
            let file = &self.scanner.rest()[..length + 2];
            self.scanner.position += file.len();
            if file.ends_with('\n') {
                return Err(
                    Code::NotClosed.at("include is never closed", start..self.scanner.position - 1)
                );
            }
            let odd = |c: char| c == '\\' || !is_printable(c);
            if file.contains(odd) || ["??", "/*", "//"].iter().any(|mark| file.contains(mark)) {
                return Err(Code::FileName
                    .at("not a valid file name for `#include`", start..self.scanner.position));
            }
            self.configuration.includes.push(format!("#include {file}"));
        }
    }
}

fn listed_once(list: &[Name], name: &Name) -> Parsed<()> {
    if list.iter().any(|other| other.text == name.text) {
        let message = format!("`{}` is listed twice", name.text);
        return Err(Code::DeclaredTwice.at(message, name.span.clone()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::{CallBound, Cause, Formula, Operand};
    use crate::types::TypeKind;

    const MINIMAL: &str =
        "settings { input = a.asl; output = my-a.c; header = a.h; basics = b.h; };";

    fn messages(text: &str) -> Vec<String> {
        parse(text).1.into_iter().map(|diagnostic| diagnostic.message).collect()
    }

    #[test]
    fn sections_may_be_empty_in_any_order_and_without_semicolon() {
        let text = format!("types {{ }} triggerables {{}}; {MINIMAL} includes {{ }};");
        let (configuration, diagnostics) = parse(&text);
        assert_eq!(diagnostics, []);
        assert_eq!(configuration.settings.output, "my-a.c");
    }

    #[test]
    fn a_configuration_may_name_its_version() {
        for text in ["version 1;", "\u{feff}// of today\nversion /* here */ 1 ;", "version 01;"] {
            assert_eq!(messages(&format!("{text} {MINIMAL}")), [""; 0], "{text}");
        }
        for (text, place) in [("version 2;", 8..9), ("version\n  99999999999;", 10..21)] {
            let (_, found) = parse(&format!("{text} colours {{ }}; {MINIMAL}"));
            assert_eq!(found.len(), 1, "nothing else of it is judged: {found:?}");
            assert_eq!((found[0].span.clone(), found[0].code), (place, "other-version"));
            assert_eq!(found[0].help.as_deref(), Some("this program reads version 1"));
        }
        for (text, expected) in [
            ("version;", "expected the number of a version, found `;`"),
            ("version = 1;", "expected the number of a version, found `=`"),
            ("version 1", "expected `;`, found `settings`"),
        ] {
            assert_eq!(messages(&format!("{text} {MINIMAL}")), [expected], "{text}");
        }
        assert_eq!(messages(&format!("{MINIMAL} version 1;")), ["unknown section `version`"]);
    }

    #[test]
    fn a_wrong_name_of_a_peer_is_the_only_error() {
        let text = format!(
            "{MINIMAL} peers {{ self, q, Q, r }}; \
             messages {{ tell seen from q, self; achieve go from r; }};"
        );
        let expected = ["`self` cannot be the name of a peer", "a second peer `Q`"];
        assert_eq!(messages(&text), expected);
    }

    #[test]
    fn declarations_carry_their_types() {
        let text = format!(
            "{MINIMAL} includes {{\n  #include <stdbool.h>\n  #include \"types.h\" // ours\n}};\n\
             basics {{ unsigned int f(const char *, double); void g(); void updateBeliefs(void); }};\n\
             types {{ p(int, posit_t); q(void); }}; settables {{ p; }};\n\
             triggerables {{ +!q; -p; }}; preemptive {{ +!q; }};"
        );
        let (configuration, diagnostics) = parse(&text);
        assert_eq!(diagnostics, []);
        assert_eq!(configuration.basics.len(), 2);
        assert_eq!(configuration.basics[0].result.kind, TypeKind::Unsigned { bits: 32 });
        assert_eq!(configuration.basics[0].parameters[0].kind, TypeKind::Text);
        assert_eq!(configuration.predicates[0].parameters[1].kind, TypeKind::Opaque);
        assert_eq!(configuration.includes.len(), 2);
        assert_eq!(configuration.triggerables.len(), 2);
    }

    #[test]
    fn a_formula_is_told_as_it_is_written() {
        let text = format!(
            "{MINIMAL} properties {{ p /* a: b */ [A-1] : // of all\n exactly_one( /* ; */ f ) // end\n; }};"
        );
        let (configuration, diagnostics) = parse(&text);
        assert_eq!(diagnostics, []);
        assert_eq!(configuration.properties[0].declared(&text).formula, "exactly_one( f )");
    }

    #[test]
    fn a_class_has_all_but_some_of_another() {
        let classes = |text: &str| {
            let (configuration, diagnostics) = parse(&format!("{MINIMAL} classes {{ {text} }};"));
            let names = |class: &crate::configuration::ActionClass| {
                let actions = class.actions.iter().map(|action| action.text.as_str());
                format!("{}: {}", class.name.text, actions.collect::<Vec<_>>().join(" "))
            };
            let classes: Vec<String> = configuration.classes.iter().map(names).collect();
            let messages = diagnostics.into_iter().map(|diagnostic| diagnostic.message);
            (classes.join("; "), messages.collect::<Vec<_>>().join("; "))
        };
        let good = |text: &str| {
            let (classes, messages) = classes(text);
            assert_eq!(messages, "", "{text}");
            classes
        };
        assert_eq!(
            good("a: p, q, r, s; b: q, s; c: all a but b; d: all a but b, p; e: all c but p;"),
            "a: p q r s; b: q s; c: p r; d: r; e: r"
        );
        // No words of the language elsewhere.
        assert_eq!(
            good("a: all; but: all, but; c: all but but all;"),
            "a: all; but: all but; c: but"
        );
        for (text, expected) in [
            ("c: all a but p; a: p, q;", "no class `a` is declared before"),
            ("c: all c but p;", "no class `c` is declared before"),
            ("a: p, q; c: all a but r;", "`r` is not left in the class `a`"),
            ("a: p, q; c: all a but q, q;", "`q` is not left in the class `a`"),
            ("a: p, q; b: q, r; c: all a but b;", "`r` is not left in the class `a`"),
            ("a: p; c: all a but p;", "nothing is left of the class `a`"),
            ("a: p, q; c: all a;", "expected `but`, found `;`"),
            ("a: p, q; c: all a without q;", "expected `but`, found `without`"),
            ("a: p, q; c: all a but;", "expected a basic action or a class of actions, found `;`"),
        ] {
            assert_eq!(classes(text).1, expected, "{text}");
        }
    }

    #[test]
    fn properties_are_read() {
        let text = format!(
            "{MINIMAL} properties {{ one: exactly_one(send); none_lost: all_handled;\n\
             prompt [SAF-1 /* the first */, // and\n SAF-2]: within(3, +!land, a, b, unless +!hold, unless -wind);\n\
             asked: only_after(lift, +!takeOff, until sink, stay); }};"
        );
        let (configuration, diagnostics) = parse(&text);
        assert_eq!(diagnostics, []);
        let [one, lost, prompt, asked] = &configuration.properties[..] else { panic!() };
        assert!(matches!(&one.formula, Formula::Count { bound: CallBound::ExactlyOne, .. }));
        assert_eq!(lost.formula, Formula::AllHandled);
        assert_eq!(prompt.requirements, ["SAF-1", "SAF-2"]);
        let Formula::Within { steps: 3, cause: Cause::Event(_), actions, unless } = &prompt.formula
        else {
            panic!("{prompt:?}")
        };
        assert_eq!((actions.len(), unless.len()), (2, 2));
        assert!(matches!(&asked.formula, Formula::OnlyAfter { until, .. } if until.len() == 2));
    }

    #[test]
    fn requirements_are_tags_between_commas() {
        for tags in ["[]", "[,]", "[A,]", "[,A]", "[A B]", "[A/B]", "[A", "[A;B]", "[[A]]"] {
            let text = format!("{MINIMAL} properties {{ p {tags}: all_handled; }};");
            let message = &parse(&text).1[0].message;
            assert!(message.contains("expected requirement tags"), "{tags}: {message}");
        }
    }

    #[test]
    fn beliefs_are_compared_with_beliefs_and_numbers() {
        let text = format!(
            "{MINIMAL} properties {{ a: within(1, x <= y, z); b: within(1, x > -2.5, z); }};"
        );
        let (configuration, diagnostics) = parse(&text);
        assert_eq!(diagnostics, []);
        let compared = |index: usize| match &configuration.properties[index].formula {
            Formula::Within { cause: Cause::Comparison(comparison), .. } => comparison.clone(),
            other => panic!("{other:?}"),
        };
        assert_eq!(compared(0).beliefs().count(), 2);
        assert_eq!(compared(1).beliefs().count(), 1);
        let Operand::Number(number) = compared(1).right else { panic!() };
        assert_eq!((number.digits.as_str(), number.negative), ("2.5", true));
        assert_eq!(text[number.span], *"-2.5");
    }

    #[test]
    fn every_error_is_reported_with_its_place() {
        let text = format!(
            "{MINIMAL} basics {{ void (int); int f(void, int); }}; typs {{ }}; settables {{ 3; }}; \
             triggerables {{ q; +?t; -!g; }};"
        );
        let expected = [
            "expected a result type and a function name, found `(`",
            "`void` is not a parameter type",
            "unknown section `typs`",
            "expected a belief, found `3`",
            "expected `+!goal`, `+belief` or `-belief`, found `q`",
            "expected `+!goal`, `+belief` or `-belief`, found `?`",
            "`-!goal` cannot be raised from outside",
        ];
        assert_eq!(messages(&text), expected);
    }

    #[test]
    fn incomplete_and_odd_configurations_are_refused() {
        for text in [
            "",
            "settings",
            "settings {",
            "settings { input",
            "settings { input = ; };",
            "settings { colour = red; };",
            "settings { max_events = 0; };",
            "settings { inbox = 0; };",
            "settings { instance = both; };",
            "includes { int x; };",
            "includes { #include <a\n> };",
            "settables { 3",
            "includes { #include <a>",
            "properties { p: always(a); };",
            "properties { p: within(0, +!g, a); };",
            "properties { p: within(1, +!g, unless +!h); };",
            "properties { p: never(a); p: never(a); };",
            "properties { p [A B]: never(a); };",
            "properties { p: within(1, x < 1.2.3, a); };",
            "properties { p: within(1, x < 5., a); };",
            "properties { p: within(1, x < -y, a); };",
            "properties { p: only_after(a); };",
            "/* open",
            "\0\u{fffd}}}{{",
        ] {
            assert!(!messages(text).is_empty(), "{text:?}");
        }
    }
}
