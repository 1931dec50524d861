//! Sections with declarations: functions, structs, classes of actions, beliefs and goals.

use super::c_type::{c_type, check_type};
use super::parser::Parser;
use super::scanner::{Parsed, is_word, is_word_start};
use super::{ActionClass, AllBut, Basic, Configuration, Predicate, Struct};
use crate::code::Code;
use crate::syntax::ast::Name;
use crate::types::{CType, TypeKind};

/// C99 guarantees 127 parameters; some are used by generated code.
const MOST_PARAMETERS: usize = 100;

impl Parser<'_> {
    /// `type name(types);`: a basic action or function. `updateBeliefs`, which is always declared, is only checked.
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

    /// `name { type field; .. };`: a struct type.
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

    /// `name: action, action;` or `name: all class but action, class;`: a class of actions.
    pub(super) fn class(&mut self) -> Parsed<()> {
        let name = self.scanner.word("a class of actions")?;
        self.scanner.expect(":")?;
        let first = self.scanner.word("a basic action")?;
        self.scanner.skip_blanks()?;
        // An action may have this name, too.
        let all = first.text == "all" && self.scanner.rest().starts_with(is_word_start);
        let all_but = all.then(|| self.all_but()).transpose()?;
        let actions = match &all_but {
            Some(all_but) => self.left(all_but)?,
            None => self.names(first, "a basic action")?,
        };
        self.scanner.expect(";")?;
        self.configuration.classes.push(ActionClass { name, actions, all_but });
        Ok(())
    }

    /// What follows `all`.
    fn all_but(&mut self) -> Parsed<AllBut> {
        const LEFT_OUT: &str = "a basic action or a class of actions";
        let class = self.scanner.word("a class of actions")?;
        let but = self.scanner.word("`but`")?;
        if but.text != "but" {
            let message = format!("expected `but`, found `{}`", but.text);
            return Err(Code::Syntax.at(message, but.span));
        }
        let first = self.scanner.word(LEFT_OUT)?;
        Ok(AllBut { class, but: self.names(first, LEFT_OUT)? })
    }

    /// `first` and the names that follow it, each behind a comma.
    pub(super) fn names(&mut self, first: Name, expected: &str) -> Parsed<Vec<Name>> {
        let mut names = vec![first];
        self.scanner.skip_blanks()?;
        while self.scanner.take(",") {
            names.push(self.scanner.word(expected)?);
            self.scanner.skip_blanks()?;
        }
        Ok(names)
    }

    /// The actions of a class that are not left out.
    fn left(&self, AllBut { class, but }: &AllBut) -> Parsed<Vec<Name>> {
        let declared = |name: &Name| {
            let mut classes = self.configuration.classes.iter();
            classes.find(|class| class.name.text == name.text)
        };
        let Some(whole) = declared(class) else {
            return Err(Code::NotDeclared
                .at(format!("no class `{}` is declared before", class.text), class.span.clone())
                .help("declare the class above, and leave actions of it out here"));
        };
        let mut left = whole.actions.clone();
        for name in but {
            let own = std::slice::from_ref(name);
            for action in declared(name).map_or(own, |class| &class.actions) {
                let Some(place) = left.iter().position(|other| other.text == action.text) else {
                    let message =
                        format!("`{}` is not left in the class `{}`", action.text, class.text);
                    return Err(Code::NotInClass
                        .at(message, name.span.clone())
                        .help("leave out what is in the class, and that once"));
                };
                left.remove(place);
            }
        }
        if left.is_empty() {
            return Err(Code::NotInClass
                .at(format!("nothing is left of the class `{}`", class.text), class.span.clone())
                .help("a class has at least one action"));
        }
        Ok(left)
    }

    /// Declares the trace function, if the settings name one, as a basic action.
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
        let Self { configuration, messages, .. } = self;
        let Configuration { structs, basics, predicates, .. } = configuration;
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
        for message in messages {
            message.parameters.iter_mut().for_each(resolve);
        }
    }

    /// `name(types);`: a belief or a goal.
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

    /// The types between parentheses; none for `()` and `(void)`.
    pub(super) fn parameters(&mut self) -> Parsed<Vec<CType>> {
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
