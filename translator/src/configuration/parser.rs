//! Reads a configuration.

use diagnostic::{Diagnostic, Span, is_printable};

use super::scanner::{Parsed, Scanner, is_word, is_word_start};
use super::{
    ActionClass, Basic, Configuration, ExternalTrigger, Instance, Predicate, Settings, Struct,
};
use crate::code::Code;
use crate::reserved::is_c_word;
use crate::syntax::ast::{Name, Operator, TriggerKind};
use crate::types::{C_NUMBERS, CType, TypeKind};

const SECTIONS: [&str; 11] = [
    "settings",
    "includes",
    "structs",
    "basics",
    "classes",
    "types",
    "settables",
    "perceived",
    "triggerables",
    "preemptive",
    "properties",
];
const SETTINGS: [&str; 11] = [
    "trace",
    "clock",
    "input",
    "output",
    "header",
    "basics",
    "rust",
    "matrix",
    "instance",
    "inbox",
    "max_events",
];
/// More waiting events than this is a mistake: each costs memory and makes commands stale.
const MAX_INBOX: u32 = 64;
/// C99 promises 127 parameters, of which some are ours.
const MOST_PARAMETERS: usize = 100;

/// The configuration in `text` and everything that is wrong with it.
pub fn parse(text: &str) -> (Configuration, Vec<Diagnostic>) {
    const BYTE_ORDER_MARK: char = '\u{feff}';
    let position = if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len_utf8() } else { 0 };
    let mut parser = Parser {
        scanner: Scanner { text, position },
        configuration: Configuration::default(),
        seen: Vec::new(),
        settings: text.len()..text.len(),
        diagnostics: Vec::new(),
    };
    parser.run();
    (parser.configuration, parser.diagnostics)
}

pub(super) struct Parser<'a> {
    pub(super) scanner: Scanner<'a>,
    pub(super) configuration: Configuration,
    seen: Vec<&'a str>,
    /// Where the section `settings` begins, or would have to.
    settings: Span,
    diagnostics: Vec<Diagnostic>,
}

impl<'a> Parser<'a> {
    fn run(&mut self) {
        loop {
            match self.section() {
                Ok(true) => {}
                Ok(false) => break,
                Err(diagnostic) => {
                    self.diagnostics.push(diagnostic);
                    // Go on behind the section, or stop where no section ends.
                    match self.scanner.rest().find('}') {
                        Some(offset) => self.scanner.position += offset + 1,
                        None => break,
                    }
                }
            }
        }
        self.declare_trace();
        self.resolve_structs();
        if self.diagnostics.is_empty() {
            self.check_settings();
            self.check_outputs();
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
            return Err(Code::UnknownSection
                .at(format!("unknown section `{section}`"), name.span)
                .help(advice(section, &SECTIONS)));
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

    fn setting(&mut self) -> Parsed<()> {
        let key = self.scanner.word("a setting")?;
        self.scanner.expect("=")?;
        let value = self.setting_value()?;
        self.scanner.expect(";")?;
        let settings = &mut self.configuration.settings;
        if settings.places.contains_key(&key.text) {
            let message = format!("a second setting `{}`", key.text);
            return Err(Code::DeclaredTwice
                .at(message, key.span)
                .help("only one of them could count"));
        }
        let same = |other: &str| settings.places.contains_key(other);
        if matches!(key.text.as_str(), "inbox" | "max_events")
            && (same("inbox") || same("max_events"))
        {
            return Err(Code::ExclusiveSettings
                .at("`inbox` and `max_events` exclude each other", key.span)
                .help("both tell how many external events can wait"));
        }
        settings.places.insert(key.text.clone(), value.span.clone());
        match key.text.as_str() {
            "input" => settings.input = value.text,
            "output" => settings.output = value.text,
            "header" => settings.header = value.text,
            "basics" => settings.basics = value.text,
            "rust" => settings.rust = Some(value),
            "matrix" => settings.matrix = Some(value.text),
            "trace" => settings.trace = Some(value),
            "clock" => settings.clock = Some(value),
            "instance" => {
                settings.instance = match value.text.as_str() {
                    "static" => Instance::Static,
                    "context" => Instance::Context,
                    _ => {
                        return Err(Code::SettingValue
                            .at("unknown kind of instance", value.span)
                            .help("write `static` or `context`"));
                    }
                };
            }
            "inbox" | "max_events" => match value.text.parse() {
                Ok(inbox @ 1..=MAX_INBOX) => {
                    settings.inbox = inbox;
                    settings.queue |= key.text == "max_events";
                }
                _ => {
                    return Err(Code::SettingValue
                        .at(format!("`{}` out of range", key.text), value.span)
                        .help(format!("a whole number from 1 to {MAX_INBOX}")));
                }
            },
            other => {
                return Err(Code::UnknownSetting
                    .at(format!("unknown setting `{other}`"), key.span)
                    .help(advice(other, &SETTINGS)));
            }
        }
        Ok(())
    }

    /// A word, a number or a file's name, which may stand in quotes. Comments may follow.
    fn setting_value(&mut self) -> Parsed<Name> {
        self.scanner.skip_blanks()?;
        let rest = self.scanner.rest();
        let start = self.scanner.position;
        let (text, length) = if let Some(quoted) = rest.strip_prefix('"') {
            match quoted.find(['"', '\n']).filter(|end| quoted[*end..].starts_with('"')) {
                Some(end) => (&quoted[..end], end + 2),
                None => {
                    return Err(Code::SettingValue
                        .at("value with a quote or backslash", start..start + 1)
                        .help("close the quote on the same line"));
                }
            }
        } else {
            let end = rest.find([';', '\n', '}']).unwrap_or(rest.len());
            let comment = ["/*", "//"].iter().filter_map(|open| rest[..end].find(open)).min();
            let text = rest[..comment.unwrap_or(end)].trim_end();
            (text, text.len())
        };
        let span = start..start + length;
        self.scanner.position = span.end;
        if text.is_empty() {
            return Err(Code::SettingValue.at("setting without a value", start..start + 1));
        }
        if text.contains(['"', '\\']) || text.chars().any(char::is_control) {
            return Err(Code::SettingValue
                .at("value with a quote or backslash", span)
                .help("generated C includes files by these names"));
        }
        Ok(Name { text: text.to_owned(), span })
    }

    fn basic(&mut self) -> Parsed<()> {
        let start = self.scanner.position;
        let (result, name) = self.typed_name()?;
        let parameters = self.parameters()?;
        let span = start..self.scanner.position;
        self.scanner.expect(";")?;
        if name.text != "updateBeliefs" {
            self.configuration.basics.push(Basic { name, result, parameters, span });
        } else if result.name != "void" || !parameters.is_empty() {
            return Err(Code::WrongSignature
                .at("`updateBeliefs` has another signature", span)
                .help("it is always declared, as `void updateBeliefs(void)`"));
        }
        Ok(())
    }

    /// `name { type field; .. };`
    fn structure(&mut self) -> Parsed<()> {
        let name = self.scanner.word("a struct type")?;
        self.scanner.expect("{")?;
        let mut fields: Vec<(Name, CType)> = Vec::new();
        self.scanner.skip_blanks()?;
        while !self.scanner.take("}") {
            let (ctype, field) = self.typed_name()?;
            self.scanner.expect(";")?;
            if !ctype.is_numeric() && ctype.kind != TypeKind::Bool {
                return Err(Code::StructField
                    .at("a field must be a number or bool", field.span)
                    .help("structs of structs and pointers are not translated"));
            }
            if fields.iter().any(|(other, _)| other.text == field.text) {
                return Err(Code::DeclaredTwice.at("a second field of this name", field.span));
            }
            fields.push((field, ctype));
            self.scanner.skip_blanks()?;
        }
        self.scanner.expect(";")?;
        if fields.is_empty() {
            return Err(Code::StructField.at("a struct without fields", name.span));
        }
        self.configuration.structs.push(Struct { name, fields });
        Ok(())
    }

    /// `name: action, action;`
    fn class(&mut self) -> Parsed<()> {
        let name = self.scanner.word("a class of actions")?;
        self.scanner.expect(":")?;
        let mut actions = vec![self.scanner.word("a basic action")?];
        while self.scanner.take(",") {
            actions.push(self.scanner.word("a basic action")?);
        }
        self.scanner.expect(";")?;
        self.configuration.classes.push(ActionClass { name, actions });
        Ok(())
    }

    /// The function that is told of plans is a basic action like any other.
    fn declare_trace(&mut self) {
        let Some(name) = self.configuration.settings.trace.clone() else { return };
        if !name.text.starts_with(is_word_start) || !name.text.chars().all(is_word) {
            self.diagnostics.push(
                Code::SettingValue
                    .at("not the name of a function", name.span)
                    .help("write `trace = tracePlan;` and provide `void tracePlan(uint32_t)`"),
            );
            return;
        }
        self.configuration.basics.push(Basic {
            span: name.span.clone(),
            name,
            result: CType::named("void"),
            parameters: vec![CType::named("uint32_t")],
        });
    }

    /// Types that the section `structs` declares are known wherever they are named.
    fn resolve_structs(&mut self) {
        let Configuration { structs, basics, predicates, .. } = &mut self.configuration;
        let resolve = |ctype: &mut CType| {
            if structs.iter().any(|declared| declared.name.text == ctype.name) {
                ctype.kind = TypeKind::Struct;
            }
        };
        for basic in basics {
            resolve(&mut basic.result);
            basic.parameters.iter_mut().for_each(resolve);
        }
        for predicate in predicates {
            predicate.parameters.iter_mut().for_each(resolve);
        }
    }

    fn predicate(&mut self) -> Parsed<()> {
        let start = self.scanner.position;
        let name = self.scanner.word("a belief or a goal")?;
        self.scanner.skip_blanks()?;
        if self.scanner.rest().starts_with(';') {
            return Err(self
                .scanner
                .unexpected("`(`")
                .help(format!("without arguments it is `{}(void)`", name.text)));
        }
        let parameters = self.parameters()?;
        let span = start..self.scanner.position;
        self.scanner.expect(";")?;
        self.configuration.predicates.push(Predicate { name, parameters, span });
        Ok(())
    }

    /// `unsigned int f` → the type and the name.
    fn typed_name(&mut self) -> Parsed<(CType, Name)> {
        let mut words = self.type_words()?;
        let name = match words.pop() {
            Some(name) if !words.is_empty() && name.text != "*" => name,
            _ => return Err(self.scanner.unexpected("a result type and a function name")),
        };
        check_type(&words)?;
        Ok((c_type(&words), name))
    }

    fn parameters(&mut self) -> Parsed<Vec<CType>> {
        self.scanner.expect("(")?;
        let mut parameters = Vec::new();
        self.scanner.skip_blanks()?;
        if self.scanner.take(")") {
            return Ok(parameters);
        }
        loop {
            let start = self.scanner.position;
            let words = self.type_words()?;
            if words.is_empty() {
                return Err(self.scanner.unexpected("a type"));
            }
            check_type(&words)?;
            let parameter = c_type(&words);
            if parameter.name == "void" {
                self.scanner.skip_blanks()?;
                if parameters.is_empty() && self.scanner.take(")") {
                    return Ok(parameters);
                }
                return Err(Code::NotAType
                    .at("`void` is no parameter", start..self.scanner.position)
                    .help("`(void)` alone says that there is none"));
            }
            parameters.push(parameter);
            if parameters.len() > MOST_PARAMETERS {
                return Err(Code::Limit
                    .at("too many arguments", start..self.scanner.position)
                    .help(format!(
                        "C promises room for 127; at most {MOST_PARAMETERS} are translated"
                    )));
            }
            self.scanner.skip_blanks()?;
            if self.scanner.take(")") {
                return Ok(parameters);
            }
            self.scanner.expect(",")?;
        }
    }

    fn type_words(&mut self) -> Parsed<Vec<Name>> {
        let mut words = Vec::new();
        loop {
            self.scanner.skip_blanks()?;
            if self.scanner.rest().starts_with('*') {
                let span = self.scanner.position..self.scanner.position + 1;
                self.scanner.position += 1;
                words.push(Name { text: "*".to_owned(), span });
            } else if self.scanner.rest().starts_with(is_word_start) {
                words.push(self.scanner.word("a type")?);
            } else {
                return Ok(words);
            }
        }
    }

    fn declared_trigger(&mut self) -> Parsed<ExternalTrigger> {
        let trigger = self.trigger()?;
        self.scanner.expect(";")?;
        Ok(trigger)
    }

    pub(super) fn trigger(&mut self) -> Parsed<ExternalTrigger> {
        let start = self.scanner.position;
        let operator = if self.scanner.take("+") {
            Operator::Add
        } else if self.scanner.take("-") {
            Operator::Delete
        } else {
            return Err(self.scanner.unexpected("`+!goal`, `+belief` or `-belief`"));
        };
        let kind = if self.scanner.take("!") {
            TriggerKind::Achieve
        } else if self.scanner.rest().starts_with('?') {
            return Err(self.scanner.unexpected("`+!goal`, `+belief` or `-belief`"));
        } else {
            TriggerKind::Belief
        };
        let name = self.scanner.word("a name")?;
        let span = start..self.scanner.position;
        if operator == Operator::Delete && kind == TriggerKind::Achieve {
            return Err(Code::NotTriggerable
                .at("`-!goal` cannot be raised from outside", span)
                .help("failure plans run when their goal fails"));
        }
        Ok(ExternalTrigger { operator, kind, name, span })
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
                return Err(Code::FileName.at(
                    "this is no name of a file that C includes",
                    start..self.scanner.position,
                ));
            }
            self.configuration.includes.push(format!("#include {file}"));
        }
    }

    fn check_settings(&mut self) {
        let settings = &self.configuration.settings;
        for (key, value) in [
            ("input", &settings.input),
            ("output", &settings.output),
            ("header", &settings.header),
            ("basics", &settings.basics),
        ] {
            if value.is_empty() {
                self.diagnostics.push(
                    Code::MissingSetting
                        .at(format!("the setting `{key}` is missing"), self.settings.clone())
                        .help(format!("add `{key} = FILE;` to the section `settings`")),
                );
            }
        }
    }

    /// What is written has names that C can include, stays in its folder, and is no other output.
    fn check_outputs(&mut self) {
        let outputs = self.configuration.settings.outputs();
        let included = self.configuration.included_files();
        let place =
            |settings: &Settings, key: &str| settings.places.get(key).cloned().unwrap_or_default();
        let mut findings = Vec::new();
        for (index, (key, name)) in outputs.iter().enumerate() {
            let span = place(&self.configuration.settings, key);
            let odd = |c: char| "'\"\\*?<>|".contains(c) || !is_printable(c);
            if name.contains(odd) {
                findings.push(
                    Code::FileName
                        .at(format!("`{key}` is no name for a file that C includes"), span)
                        .help("letters, digits, `_`, `-`, `.` and `/` do"),
                );
            } else if name.starts_with('/') || name.split('/').any(|part| part == "..") {
                findings.push(
                    Code::FileName.at(format!("`{key}` leads out of the output's folder"), span)
                        .help("name a file in the configuration's folder or below; `-o DIR` puts all elsewhere"),
                );
            } else if name.split('/').any(|part| matches!(part, "" | ".")) {
                findings.push(
                    Code::FileName
                        .at(format!("`{key}` is no plain name of a file"), span)
                        .help("write it without `./` and `//`"),
                );
            } else if ["harness.c", "invariant.h"].contains(&name.as_str()) {
                findings.push(
                    Code::FileName
                        .at(format!("`{name}` is a file of the proofs"), span)
                        .help("choose another name"),
                );
            } else if let Some((other, _)) =
                outputs[..index].iter().find(|(_, other)| other == name)
            {
                findings.push(
                    Code::Overwrites
                        .at(format!("`{key}` and `{other}` are one file"), span)
                        .help("the second would overwrite the first"),
                );
            } else if included.contains(name) {
                findings.push(
                    Code::Overwrites
                        .at(format!("`{key}` is {name}, which is included"), span)
                        .help("yours would be overwritten: choose another name"),
                );
            }
        }
        // A name that ends in two files is refused once.
        findings.dedup_by(|one, other| one.message == other.message);
        self.diagnostics.extend(findings);
    }
}

fn listed_once(list: &[Name], name: &Name) -> Parsed<()> {
    if list.iter().any(|other| other.text == name.text) {
        let message = format!("`{}` is listed twice", name.text);
        return Err(Code::DeclaredTwice.at(message, name.span.clone()));
    }
    Ok(())
}

/// Refuses what is no type of a parameter, a result or a field in C, with the reason.
fn check_type(words: &[Name]) -> Parsed<()> {
    let (Some(first), Some(last)) = (words.first(), words.last()) else { return Ok(()) };
    let span = first.span.start..last.span.end;
    let error =
        |message: &str, help: &str| Err(Code::NotAType.at(message, span.clone()).help(help));
    let stars = words.iter().position(|word| word.text == "*").unwrap_or(words.len());
    let (base, pointer) = words.split_at(stars);
    if pointer.iter().any(|word| word.text != "*") {
        return error(
            "this is no type",
            "the translator knows `name`, `struct name`, `const name *` and numbers",
        );
    }
    let is_const = |word: &&Name| word.text == "const";
    let constant = base.iter().filter(is_const).count();
    if constant > 0 && pointer.is_empty() {
        return error("a value needs no `const`", "what is passed is a copy: leave `const` out");
    }
    let base: Vec<&str> =
        base.iter().filter(|word| !is_const(word)).map(|word| word.text.as_str()).collect();
    let known = match base.as_slice() {
        ["struct" | "union" | "enum", name] => !is_c_word(name),
        ["void"] => true,
        [name] if C_NUMBERS.contains(name) || *name == "_Bool" => true,
        [name] => {
            !is_c_word(name)
                || CType::named(name).kind != TypeKind::Opaque
                || name.ends_with("_t")
                || *name == "FILE"
        }
        several => is_number(several),
    };
    if !known || constant > 1 {
        return error(
            "this is no type",
            "a parameter is written without its name: `int`, not `int x`",
        );
    }
    Ok(())
}

/// Whether these words are a type of numbers in C.
fn is_number(words: &[&str]) -> bool {
    const KNOWN: [&str; 18] = [
        "short int",
        "signed short",
        "signed short int",
        "unsigned short",
        "unsigned short int",
        "signed int",
        "unsigned int",
        "signed char",
        "unsigned char",
        "long int",
        "signed long",
        "signed long int",
        "unsigned long",
        "unsigned long int",
        "long long",
        "long long int",
        "unsigned long long",
        "long double",
    ];
    let text = words.join(" ");
    let rarer = ["signed long long", "signed long long int", "unsigned long long int"];
    KNOWN.contains(&text.as_str()) || rarer.contains(&text.as_str())
}

fn c_type(words: &[Name]) -> CType {
    let words: Vec<&str> = words.iter().map(|word| word.text.as_str()).collect();
    CType::named(&words.join(" "))
}

fn advice(word: &str, known: &[&str]) -> String {
    match diagnostic::closest(word, known.iter().copied()) {
        Some(candidate) => format!("did you mean `{candidate}`?"),
        None => format!("known are: {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::{CallBound, Cause, Formula, Operand};

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
    fn properties_are_read() {
        let text = format!(
            "{MINIMAL} properties {{ one: exactly_one(send); none_lost: all_handled;\n\
             prompt [SAF-1, SAF-2]: within(3, +!land, a, b, unless +!hold, unless -wind);\n\
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
            "`void` is no parameter",
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
