//! No file needs one that needs it: a circle means that something is defined in the wrong file.
//!
//! Imports are read from the text: `crate::`, `super::`, names of modules, and what a module passes on from another one. A
//! child of a module is a part of it, and may need it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::architecture::sources;

const PACKAGES: [&str; 14] = [
    "diagnostic",
    "translator",
    "judged-c",
    "asl2c",
    "kinematics",
    "estimator",
    "autopilot",
    "mock-drone",
    "ardrone-link",
    "mavlink-vehicle",
    "pid",
    "ardrone-pilot",
    "xtask",
    "tests",
];

/// A path from the root of a package: of a module, or of something in it.
type Name = Vec<String>;

/// What a file imports.
struct Import {
    /// The name by which it is known here.
    name: String,
    path: Name,
}

/// The modules of a package.
#[derive(Default)]
struct Package {
    imports: BTreeMap<Name, Vec<Import>>,
    /// Other paths in the text.
    mentioned: BTreeMap<Name, Vec<Name>>,
}

fn words(path: &str) -> Name {
    path.split("::").map(|word| word.trim().to_owned()).filter(|word| !word.is_empty()).collect()
}

/// The paths of a `use`, with their names: `a::{b, c as d}` is `a::b` and `a::c`.
fn imports(before: &[String], tree: &str, found: &mut Vec<Import>) {
    let tree = tree.trim();
    if let Some((first, rest)) = tree.split_once('{').filter(|_| tree.ends_with('}')) {
        let before = [before, &words(first)].concat();
        let (mut depth, mut begin) = (0, 0);
        let rest = &rest[..rest.len() - 1];
        for (at, sign) in rest.char_indices() {
            match sign {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    imports(&before, &rest[begin..at], found);
                    begin = at + 1;
                }
                _ => {}
            }
        }
        imports(&before, &rest[begin..], found);
    } else if !tree.is_empty() {
        let (path, name) = tree.split_once(" as ").unwrap_or((tree, ""));
        let mut path = [before, &words(path)].concat();
        // `self` in braces, and all of a module, are the module.
        path.pop_if(|last| matches!(last.as_str(), "self" | "*"));
        let last = path.last().cloned().unwrap_or_default();
        let name = if name.is_empty() { last } else { name.trim().to_owned() };
        found.push(Import { name, path });
    }
}

impl Package {
    fn read(folder: &Path) -> Self {
        let mut package = Self::default();
        let mut texts = BTreeMap::new();
        for path in sources(folder) {
            let within = path.strip_prefix(folder).unwrap().with_extension("");
            let mut name: Name =
                within.iter().map(|part| part.to_str().unwrap().to_owned()).collect();
            if name.contains(&"tests".to_owned()) {
                continue;
            }
            name.pop_if(|last| matches!(last.as_str(), "mod" | "lib" | "main"));
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
            let lines = code.lines().map(|line| line.split("//").next().unwrap());
            texts.insert(name, lines.collect::<Vec<_>>().join("\n"));
        }
        for (name, text) in &texts {
            let mut found = Vec::new();
            let mut mentioned = Vec::new();
            for statement in text.split(';') {
                let statement = statement.rsplit("\n\n").next().unwrap_or(statement).trim();
                let statement = statement.strip_prefix("pub ").unwrap_or(statement);
                let statement = match statement.strip_prefix("pub(") {
                    Some(rest) => rest.split_once(") ").map_or("", |(_, rest)| rest),
                    None => statement,
                };
                if let Some(tree) = statement.strip_prefix("use ") {
                    imports(&[], tree, &mut found);
                }
            }
            let is_word = |sign: char| sign.is_alphanumeric() || matches!(sign, '_' | ':');
            let paths = text.split(|sign| !is_word(sign)).filter(|word| word.contains("::"));
            mentioned.extend(paths.map(words).filter(|path| !path.is_empty()));
            package.imports.insert(name.clone(), found);
            package.mentioned.insert(name.clone(), mentioned);
        }
        package
    }

    /// A path from the root; `None` for one of another package.
    fn absolute(&self, module: &Name, path: &[String]) -> Option<Name> {
        let mut place = module.clone();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => return Some(path[1..].to_vec()),
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|word| word == "super") {
                    place.pop()?;
                    rest = &rest[1..];
                }
            }
            child => {
                place.push(child.to_owned());
                self.imports.get(&place)?;
                rest = &path[1..];
            }
        }
        Some([&place[..], rest].concat())
    }

    /// The module in which a path is defined, wherever it is passed on.
    fn defined(&self, path: &Name, depth: u32) -> Option<Name> {
        if self.imports.contains_key(path) {
            return Some(path.clone());
        }
        let length = (0..path.len()).rev().find(|end| self.imports.contains_key(&path[..*end]))?;
        let (module, rest) = (path[..length].to_vec(), &path[length..]);
        let passed_on = self.imports[&module].iter().find(|import| import.name == rest[0]);
        match passed_on.filter(|_| depth < 8) {
            Some(import) => {
                let to = self.absolute(&module, &import.path)?;
                self.defined(&[&to[..], &rest[1..]].concat(), depth + 1)
            }
            None => Some(module),
        }
    }

    /// The modules that one needs, but for those that it is a part of.
    fn needed(&self, module: &Name) -> BTreeSet<Name> {
        let imported = self.imports[module].iter().map(|import| &import.path);
        let mut paths: Vec<Name> = imported.cloned().collect();
        for path in &self.mentioned[module] {
            // The first word may be a module that is imported.
            let import = self.imports[module].iter().find(|import| import.name == path[0]);
            paths.push(
                import
                    .map_or_else(|| path.clone(), |import| [&import.path[..], &path[1..]].concat()),
            );
        }
        let needed = paths.iter().filter_map(|path| self.absolute(module, path));
        // What a module passes on of its children it does not need.
        let needed = needed.filter_map(|path| self.defined(&path, 0));
        needed.filter(|other| !module.starts_with(other)).collect()
    }

    /// The modules that need themselves by way of others.
    fn circles(&self) -> Vec<String> {
        let needed: BTreeMap<&Name, BTreeSet<Name>> =
            self.imports.keys().map(|module| (module, self.needed(module))).collect();
        let mut circles = Vec::new();
        for module in self.imports.keys() {
            let mut open: Vec<&Name> = needed[module].iter().collect();
            let mut seen = BTreeSet::new();
            while let Some(next) = open.pop() {
                if next == module {
                    circles.push(module.join("::"));
                    break;
                }
                if seen.insert(next) {
                    open.extend(&needed[next]);
                }
            }
        }
        circles
    }
}

#[test]
fn no_files_need_each_other() {
    let mut circles = Vec::new();
    let mut imported = 0;
    for name in PACKAGES {
        let package = Package::read(&Path::new("..").join(name).join("src"));
        imported +=
            package.imports.keys().map(|module| package.needed(module).len()).sum::<usize>();
        circles.extend(package.circles().into_iter().map(|module| format!("{name}: {module}")));
    }
    assert_eq!(circles, [""; 0]);
    assert!(imported > 1000, "{imported}");
}

#[test]
fn each_way_to_import_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let circles = |one: &str, two: &str| {
        std::fs::create_dir_all(folder.path().join("part")).unwrap();
        for (name, text) in [
            ("lib.rs", "mod one;\nmod two;\nmod part;\n\npub(crate) use two::Two;\n"),
            ("part/mod.rs", "mod three;\n\npub(crate) use self::three::Three;\n"),
            ("part/three.rs", "use crate::one::One;\n\npub(crate) struct Three(One);\n"),
            ("one.rs", one),
            ("two.rs", two),
        ] {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        Package::read(folder.path()).circles()
    };
    let back = "use std::fmt;\n\npub(crate) struct Two;\nfn two() -> super::one::One { todo!() }\n";
    for one in [
        "use crate::two::Two;\n",
        "use crate::{two::Two as Other};\n",
        "use super::Two;\n",
        "use crate::two;\nfn a(_: two::Two) {}\n",
        "fn a(_: crate::Two) {}\n",
    ] {
        assert_eq!(circles(one, back), ["one", "two"], "{one}");
        assert_eq!(circles(one, "pub(crate) struct Two;\n"), [""; 0], "{one}");
    }
    assert_eq!(circles("use crate::part::Three;\n", ""), ["one", "part::three"]);
    assert_eq!(circles("// crate::two::Two\n", back), [""; 0]);
}
