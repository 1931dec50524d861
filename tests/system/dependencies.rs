//! Licences, sources and duplicate versions of all dependencies.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// Licences whose only condition is to distribute their text.
const ALLOWED: [&str; 9] = [
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Crates that are compiled in two versions, for the log format (mcap), the page's connection (axum, tungstenite) and
/// the mock drone's video (`rusty_h264`), whose dependencies are older. Review a new one before adding it.
const TWICE: [&str; 11] = [
    "cpufeatures",
    "darling",
    "darling_core",
    "darling_macro",
    "getrandom",
    "rand",
    "rand_chacha",
    "rand_core",
    "safe_arch",
    "syn",
    "wide",
];

const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";

/// A compiled dependency of the programs or their tests.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Package {
    name: String,
    version: String,
    /// Its source, unless it is the registry.
    from: Option<String>,
    licence: String,
}

/// All compiled crates. `cargo metadata` would also list those of disabled features.
fn packages() -> BTreeSet<Package> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--workspace", "--edges", "normal,build,dev", "--prefix", "none"])
        .args(["--format", "{p}|{l}", "--locked", "--offline"])
        .current_dir("..")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    // Repeated crates are marked with an asterisk.
    let first = text.lines().filter(|line| !line.ends_with("(*)"));
    let lines = first.filter_map(|line| line.split_once('|'));
    lines
        .filter_map(|(package, licence)| {
            // `name v1.2.3`, then the source, and a mark for procedural macros.
            let mut words = package.split(' ').filter(|word| *word != "(proc-macro)");
            let name = words.next()?.to_owned();
            let version = words.next()?.strip_prefix('v')?.to_owned();
            let from = words.next().map(str::to_owned);
            Some(Package { name, version, from, licence: licence.to_owned() })
        })
        .collect()
}

/// Whether a licence expression (SPDX, or the old form `MIT/Apache-2.0`) can be met by allowed licences.
fn is_allowed(expression: &str) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let mut words = spaced.split_whitespace().peekable();
    let allowed = alternatives(&mut words);
    allowed && words.next().is_none()
}

type Words<'a> = std::iter::Peekable<std::str::SplitWhitespace<'a>>;

fn alternatives(words: &mut Words<'_>) -> bool {
    let mut allowed = together(words);
    while words.next_if_eq(&"OR").is_some() {
        allowed |= together(words);
    }
    allowed
}

fn together(words: &mut Words<'_>) -> bool {
    let mut allowed = single(words);
    while words.next_if_eq(&"AND").is_some() {
        allowed &= single(words);
    }
    allowed
}

fn single(words: &mut Words<'_>) -> bool {
    if words.next_if_eq(&"(").is_some() {
        let allowed = alternatives(words);
        return words.next_if_eq(&")").is_some() && allowed;
    }
    let allowed = words.next().is_some_and(|word| ALLOWED.contains(&word));
    // An exception only grants additional rights.
    if words.next_if_eq(&"WITH").is_some() {
        words.next();
    }
    allowed
}

#[test]
fn licence_expressions_are_understood() {
    for allowed in [
        "MIT",
        "MIT/Apache-2.0",
        "GPL-3.0-only OR MIT",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
        "Apache-2.0 WITH LLVM-exception",
    ] {
        assert!(is_allowed(allowed), "{allowed}");
    }
    for refused in ["", "GPL-3.0-only", "MIT AND GPL-3.0-only", "(MIT", "MIT Apache-2.0"] {
        assert!(!is_allowed(refused), "{refused}");
    }
}

#[test]
fn every_licence_may_be_used() {
    let packages = packages();
    assert!(packages.len() > 100, "{}", packages.len());
    for package in packages {
        assert!(is_allowed(&package.licence), "{package:?}");
    }
}

/// Third-party crates come from the registry, with checksums in the lock file.
#[test]
fn everything_comes_from_the_registry() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    for package in packages() {
        let folder = package.from.as_ref().map(|from| from.trim_matches(['(', ')']));
        let ours = |folder: &str| Path::new(folder).parent() == Some(here);
        assert!(folder.is_none_or(ours), "{package:?}");
    }
    let lock = std::fs::read_to_string("../Cargo.lock").unwrap();
    let sources = lock.lines().filter_map(|line| line.strip_prefix("source = "));
    let others: Vec<&str> = sources.filter(|source| source.trim_matches('"') != REGISTRY).collect();
    assert_eq!(others, [""; 0]);
}

#[test]
fn no_crate_is_compiled_in_two_versions() {
    let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for Package { name, version, .. } in packages() {
        versions.entry(name).or_default().insert(version);
    }
    versions.retain(|_, versions| versions.len() > 1);
    let names: Vec<&str> = versions.keys().map(String::as_str).collect();
    assert_eq!(names, TWICE, "{versions:?}");
}
