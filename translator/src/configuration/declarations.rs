//! Sections with declarations: functions, structs, classes of actions, beliefs and goals.

use super::c_type::{c_type, check_type};
use super::parser::Parser;
use super::scanner::{Parsed, is_word, is_word_start};
use super::{ActionClass, Basic, Configuration, Predicate, Struct};
use crate::code::Code;
use crate::syntax::ast::Name;
use crate::types::{CType, TypeKind};

/// C99 guarantees 127 parameters; some are used by generated code.
const MOST_PARAMETERS: usize = 100;

impl Parser<'_> {
    pub(super) fn basic(&mut self) -> Parsed<()> {
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
    pub(super) fn structure(&mut self) -> Parsed<()> {
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
                    .help("structs of structs and pointers are not supported"));
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
    pub(super) fn class(&mut self) -> Parsed<()> {
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

    /// The trace function is declared as a basic action.
    pub(super) fn declare_trace(&mut self) {
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

    /// Resolves types that are declared in the section `structs`, wherever they are used.
    pub(super) fn resolve_structs(&mut self) {
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

    pub(super) fn predicate(&mut self) -> Parsed<()> {
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

    /// `unsigned int f`: the type and the name.
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
                    .at("`void` is not a parameter type", start..self.scanner.position)
                    .help("`(void)` alone means no parameters"));
            }
            parameters.push(parameter);
            if parameters.len() > MOST_PARAMETERS {
                return Err(Code::Limit
                    .at("too many arguments", start..self.scanner.position)
                    .help(format!("C guarantees 127; at most {MOST_PARAMETERS} are translated")));
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
}
