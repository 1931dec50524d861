//! Tests in the sources of the workspace, and those that have run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Folders of the packages.
pub(crate) type Packages = BTreeMap<String, PathBuf>;

/// The packages of a workspace.
pub(crate) fn packages(workspace: &Path) -> std::io::Result<Packages> {
    let mut packages = Packages::new();
    for entry in std::fs::read_dir(workspace)? {
        let folder = entry?.path();
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        let name =
            manifest.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
        packages.extend(name.map(|name| (name.to_owned(), folder.clone())));
    }
    Ok(packages)
}

/// Why there is no test `PACKAGE path` or `PACKAGE/TARGET path` that runs.
pub(crate) fn missing(packages: &Packages, test: &str) -> Option<String> {
    let attributes = test.split_once(' ').and_then(|(binary, path)| {
        let (package, target) = binary.split_once('/').unwrap_or((binary, "src"));
        let files = [("", "/lib.rs"), ("", "/main.rs"), ("tests/", ".rs"), ("tests/", "/main.rs")];
        let folder = packages.get(package)?;
        let root = files.map(|(before, after)| folder.join(format!("{before}{target}{after}")));
        let root = root.iter().find(|root| root.is_file())?;
        let text = std::fs::read_to_string(root).ok()?;
        attributes(&text, 0, root.parent()?, &path.split("::").collect::<Vec<_>>())
    });
    let has = |begin: &str| attributes.iter().flatten().any(|line| line.starts_with(begin));
    let what = match &attributes {
        None => "is not in the sources",
        Some(_) if !has("#[test]") && !has("#[tokio::test") => "is no test",
        Some(_) if has("#[ignore") || has("#[cfg_attr") => "is ignored",
        Some(_) => return None,
    };
    Some(format!("`{test}` {what}"))
}

/// Attributes of the function at the end of a path, in a module with this text, indent of its items, and folder of its files.
fn attributes(text: &str, indent: usize, folder: &Path, path: &[&str]) -> Option<Vec<String>> {
    let lines: Vec<&str> = text.lines().collect();
    let (name, rest) = path.split_first()?;
    let at_indent = |line: &&str, indent: usize| {
        line.trim_start().len() + indent == line.len() && !line.is_empty()
    };
    if rest.is_empty() {
        let (at, _) = (0..).zip(&lines).find(|(at, line)| {
            let begin = line.trim_start().trim_start_matches("async ");
            let is_it = begin.strip_prefix("fn ").and_then(|rest| rest.strip_prefix(*name));
            // Proptest's functions are in a macro.
            let mut before = lines.iter().take(*at).rev().filter(|line| at_indent(line, indent));
            let is_in_proptest = |line: &&str| line.trim_start().starts_with("proptest!");
            is_it.is_some_and(|rest| rest.starts_with('('))
                && (at_indent(line, indent)
                    || at_indent(line, indent + 4) && before.next().is_some_and(is_in_proptest))
        })?;
        // Nothing else than comments stands between attributes and function.
        let above = lines.iter().take(at).rev().map(|line| line.trim());
        let above = above.take_while(|line| !line.is_empty() && !line.ends_with(['{', '}', ';']));
        return Some(above.map(str::to_owned).collect());
    }
    let at = lines.iter().position(|line| {
        let declared = line.trim_start().split_once("mod ");
        let declared =
            declared.filter(|(before, _)| before.is_empty() || before.starts_with("pub"));
        let rest = declared.and_then(|(_, declared)| declared.strip_prefix(*name));
        at_indent(line, indent) && rest.is_some_and(|rest| rest == ";" || rest == " {")
    })?;
    let within = folder.join(name);
    if lines.get(at)?.ends_with('{') {
        let inside = lines
            .iter()
            .skip(at + 1)
            .take_while(|line| !at_indent(line, indent) || line.trim() != "}");
        let inside: Vec<&str> = inside.copied().collect();
        return attributes(&inside.join("\n"), indent + 4, &within, rest);
    }
    let files = [within.with_extension("rs"), within.join("mod.rs")];
    let text = files.iter().find_map(|file| std::fs::read_to_string(file).ok())?;
    attributes(&text, 0, &within, rest)
}

/// What became of each test in the output of `cargo test`: a path is unique in its binary only.
pub(crate) fn results(log: &str, packages: &Packages) -> BTreeMap<String, Vec<String>> {
    let mut results = BTreeMap::<String, Vec<String>>::new();
    let (mut package, mut binary) = (String::new(), None);
    for line in log.lines() {
        if let Some(running) = line.trim_start().strip_prefix("Running ") {
            // `unittests src/lib.rs (target/debug/deps/NAME-HASH)`, or the file of an integration test.
            let (file, program) = running.split_once(" (").unwrap_or((running, ""));
            let name = program.rsplit('/').next().and_then(|name| name.rsplit_once('-'));
            let name = name.map_or("", |(name, _)| name);
            let has = |package: &str, file: &str| {
                packages.get(package).is_some_and(|folder| folder.join(file).is_file())
            };
            binary = if let Some(root) = file.strip_prefix("unittests ") {
                package = name.replace('_', "-");
                // The program of a package with a library has the library's name.
                (root == "src/lib.rs" || !has(&package, "src/lib.rs")).then(|| package.clone())
            } else if has(&package, file) {
                Some(format!("{package}/{name}"))
            } else {
                packages.keys().find(|package| has(package, file)).map(|of| format!("{of}/{name}"))
            };
        } else if line.trim_start().starts_with("Doc-tests ") {
            binary = None;
        } else if let Some((path, result)) =
            line.strip_prefix("test ").and_then(|l| l.split_once(" ... "))
            && let Some(binary) = &binary
        {
            results.entry(format!("{binary} {path}")).or_default().push(result.trim().to_owned());
        }
    }
    results
}
