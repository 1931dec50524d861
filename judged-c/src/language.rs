//! What the judged C can name: the types, functions and lines of the agent's own C and its headers.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use crate::lexer::refused;
use crate::parser::{parse, parse_header};
use crate::refused::{Refused, Rule};
use crate::tree::{Definition, Function, Item, Type, Unit};
use crate::types::{Named, Ty, Typed, basic, integer, spelling};

/// A function's types.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Signature {
    pub(crate) result: Named,
    pub(crate) parameters: Vec<Named>,
}

/// Who defines a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Owner {
    /// The environment: it may do anything.
    Environment,
    /// The judged C, for the environment.
    Interface,
}

/// What is declared outside of the judged C.
#[derive(Debug, Clone, Default)]
pub(crate) struct Language {
    /// Preprocessor lines.
    pub(crate) lines: Vec<String>,
    /// Generated types of the C file, by name.
    pub(crate) definitions: BTreeMap<String, Definition>,
    pub(crate) structs: HashMap<String, Vec<(String, Ty)>>,
    /// The type of each enumerator.
    pub(crate) enumerators: HashMap<String, String>,
    /// Constants of the generated headers: `#define PEER_LEADER 0U`.
    pub(crate) constants: HashMap<String, Typed>,
    /// Other names of numeric types in the generated headers: `typedef uint8_t peer_t;`.
    aliases: HashMap<String, Ty>,
    enums: HashSet<String>,
    /// Names of types that are declared nowhere else: those of the environment's headers.
    opaque: HashSet<String>,
    pub(crate) functions: HashMap<String, (Owner, Signature)>,
    /// The objects of the C file: the agent's state.
    pub(crate) state: BTreeMap<String, Ty>,
    /// Texts, which may be of a type that the environment declares.
    texts: HashSet<String>,
}

impl Language {
    /// The language of an agent with this C and these headers, all generated.
    pub(crate) fn new(c: &str, headers: &[&str]) -> Result<Self, Refused> {
        let mut language = Self::default();
        for header in headers {
            language.learn_lines(header);
            for item in parse_header(header)?.items {
                match item {
                    Item::Definition(name, definition) => {
                        language.define(&name.text, &definition)?;
                    }
                    Item::Function(function) => {
                        let signature = language.declared(&function)?;
                        let name = function.name.text;
                        language.functions.insert(name, (Owner::Environment, signature));
                    }
                    Item::Object(object) => {
                        return Err(refused(
                            &object.name.text,
                            object.name.place,
                            Rule::Translation,
                        ));
                    }
                }
            }
        }
        let unit = parse(c, &language.with_definitions(c)?)?;
        language.lines = unit.lines.iter().map(|line| line.text.clone()).collect();
        for item in &unit.items {
            match item {
                Item::Definition(name, definition) => {
                    language.define(&name.text, definition)?;
                    language.definitions.insert(name.text.clone(), plain(definition));
                }
                Item::Object(object) => {
                    let ty = language.named(&object.ctype)?.ty;
                    language.state.insert(object.name.text.clone(), ty);
                }
                Item::Function(function) if !function.is_static => {
                    if let Some((owner, _)) = language.functions.get_mut(&function.name.text) {
                        *owner = Owner::Interface;
                    }
                }
                Item::Function(_) => {}
            }
        }
        Ok(language)
    }

    /// Keeps constants and other names of types, each of which has a line of its own.
    fn learn_lines(&mut self, header: &str) {
        for line in header.lines() {
            let words: Vec<&str> = line.trim_end_matches(';').split(' ').collect();
            match words.as_slice() {
                ["#define", name, value] => {
                    self.constants.extend(integer(value).map(|value| ((*name).to_owned(), value)));
                }
                ["typedef", words, name] => {
                    self.aliases.extend(basic(words).map(|ty| ((*name).to_owned(), ty)));
                }
                _ => {}
            }
        }
    }

    /// Names of all types, also those that the generated C defines, which are found by their form: `} event_t;`.
    fn with_definitions(&self, c: &str) -> Result<HashSet<String>, Refused> {
        let tokens = crate::lexer::tokens(c)?;
        let named = tokens.windows(3).filter(|three| three[0].text == "}" && three[2].text == ";");
        Ok(self.types().into_iter().chain(named.map(|three| three[1].text.to_owned())).collect())
    }

    /// Names that begin a type.
    pub(crate) fn types(&self) -> HashSet<String> {
        let own = self.structs.keys().chain(&self.enums).chain(&self.opaque);
        let own = own.chain(self.aliases.keys());
        let integers = [8, 16, 32, 64]
            .into_iter()
            .flat_map(|bits| [format!("int{bits}_t"), format!("uint{bits}_t")]);
        own.cloned().chain(integers).collect()
    }

    fn define(&mut self, name: &str, definition: &Definition) -> Result<(), Refused> {
        match definition {
            Definition::Enum(names) => {
                self.enums.insert(name.to_owned());
                let names = names.iter().map(|word| (word.text.clone(), name.to_owned()));
                self.enumerators.extend(names);
            }
            Definition::Struct(fields) => {
                let mut types = Vec::new();
                for (ctype, field, length) in fields {
                    self.learn(ctype);
                    let ty = self.named(ctype)?.ty;
                    let ty = match length {
                        Some(length) => {
                            let length = length.text.parse().unwrap_or_default();
                            Ty::Array(Box::new(ty), length)
                        }
                        None => ty,
                    };
                    types.push((field.text.clone(), ty));
                }
                self.structs.insert(name.to_owned(), types);
            }
        }
        Ok(())
    }

    /// Keeps a type of the environment.
    fn learn(&mut self, ctype: &Type) {
        let words = ctype.words.join(" ");
        let known = basic(&words).is_some()
            || self.aliases.contains_key(&words)
            || self.structs.contains_key(&words)
            || self.enums.contains(&words);
        if !known {
            self.opaque.insert(words);
        }
    }

    fn declared(&mut self, function: &Function) -> Result<Signature, Refused> {
        self.learn(&function.result);
        function.parameters.iter().for_each(|parameter| self.learn(&parameter.ctype));
        for ctype in
            std::iter::once(&function.result).chain(function.parameters.iter().map(|p| &p.ctype))
        {
            if translator::types::CType::named(&spelling(ctype)).may_be_text() {
                self.texts.insert(spelling(ctype));
            }
        }
        self.signature(function)
    }

    /// A function's types.
    pub(crate) fn signature(&self, function: &Function) -> Result<Signature, Refused> {
        let parameters = function.parameters.iter().map(|parameter| self.named(&parameter.ctype));
        Ok(Signature {
            result: self.named(&function.result)?,
            parameters: parameters.collect::<Result<_, _>>()?,
        })
    }

    /// The meaning of a type that is written.
    pub(crate) fn named(&self, ctype: &Type) -> Result<Named, Refused> {
        let words = ctype.words.join(" ");
        let name = spelling(ctype);
        let wrong = || refused(&name, ctype.place, Rule::Type);
        let plain = basic(&words)
            .or_else(|| self.aliases.get(&words).cloned())
            .or_else(|| self.structs.contains_key(&words).then(|| Ty::Struct(words.clone())))
            .or_else(|| self.enums.contains(&words).then(|| Ty::Enum(words.clone())))
            .or_else(|| self.opaque.contains(&words).then(|| Ty::Opaque(words.clone())));
        let ty = match (ctype.stars.len(), plain) {
            (1, _) if words == "char" && ctype.constant => Ty::Text,
            (0, Some(ty)) => ty,
            (1, Some(Ty::Void | Ty::Opaque(_))) => Ty::Opaque(name.clone()),
            (1, Some(to)) => {
                let to = Named { name: words, ty: to };
                Ty::Pointer { constant: ctype.constant, to: Box::new(to) }
            }
            (_, Some(_)) => Ty::Opaque(name.clone()),
            _ => return Err(wrong()),
        };
        Ok(Named { name, ty })
    }

    /// Whether a text in quotes can be a value of this type.
    pub(crate) fn is_text(&self, ty: &Ty) -> bool {
        match ty {
            Ty::Text => true,
            Ty::Opaque(name) => self.texts.contains(name),
            _ => false,
        }
    }

    /// The functions that the judged C must define.
    pub(crate) fn interface(&self) -> BTreeSet<&str> {
        let functions = self.functions.iter().filter(|(_, (owner, _))| *owner == Owner::Interface);
        functions.map(|(name, _)| name.as_str()).collect()
    }

    /// The types of the C file in a file are the generated ones.
    pub(crate) fn check_definitions(&self, unit: &Unit) -> Result<(), Refused> {
        let mut missing: BTreeSet<&String> = self.definitions.keys().collect();
        for item in &unit.items {
            let Item::Definition(name, definition) = item else { continue };
            let same = self.definitions.get(&name.text) == Some(&plain(definition));
            if !same || !missing.remove(&name.text) {
                return Err(refused(&name.text, name.place, Rule::Typedef));
            }
        }
        match missing.first() {
            Some(name) => Err(refused(name, unit.end, Rule::Types)),
            None => Ok(()),
        }
    }
}

/// A definition without its places.
fn plain(definition: &Definition) -> Definition {
    let mut plain = definition.clone();
    match &mut plain {
        Definition::Enum(names) => names.iter_mut().for_each(|name| name.place = <_>::default()),
        Definition::Struct(fields) => {
            for (ctype, name, length) in fields {
                ctype.place = <_>::default();
                name.place = <_>::default();
                if let Some(length) = length {
                    length.place = <_>::default();
                }
            }
        }
    }
    plain
}
