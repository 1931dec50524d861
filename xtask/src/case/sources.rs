//! Tests in the sources of the workspace.

use std::path::{Path, PathBuf};

/// Where a test is looked for.
#[derive(Debug)]
pub(crate) struct Sources {
    /// Packages by name, with their folders.
    packages: Vec<(String, PathBuf)>,
}

impl Sources {
    /// The packages below a folder.
    pub(crate) fn of(workspace: &Path) -> std::io::Result<Self> {
        let mut packages = Vec::new();
        for entry in std::fs::read_dir(workspace)? {
            let folder = entry?.path();
            let Ok(manifest) = std::fs::read_to_string(folder.join("Cargo.toml")) else { continue };
            let name = manifest.lines().find_map(|line| line.strip_prefix("name = \""));
            if let Some(name) = name {
                packages.push((name.trim_end_matches('"').to_owned(), folder));
            }
        }
        packages.sort();
        Ok(Self { packages })
    }

    /// The package that has this file; if several have, the one that is preferred.
    pub(crate) fn package_with(&self, file: &str, preferred: Option<&str>) -> Option<&str> {
        let mut having = self.packages.iter().filter(|(_, folder)| folder.join(file).is_file());
        let first = having.clone().next();
        let wanted = having.find(|(name, _)| Some(name.as_str()) == preferred);
        wanted.or(first).map(|(name, _)| name.as_str())
    }

    /// Why there is no test of this name (`PACKAGE path` or `PACKAGE/TARGET path`) that runs.
    pub(crate) fn missing(&self, test: &str) -> Option<String> {
        let found = test.split_once(' ').and_then(|(binary, path)| {
            let (package, target) = binary.split_once('/').unwrap_or((binary, ""));
            let (_, folder) = self.packages.iter().find(|(name, _)| name == package)?;
            let roots = if target.is_empty() {
                ["src/lib.rs", "src/main.rs"].map(str::to_owned).to_vec()
            } else {
                ["tests/TARGET.rs", "tests/TARGET/main.rs", "TARGET/main.rs"]
                    .map(|root| root.replace("TARGET", target))
                    .to_vec()
            };
            let root = roots.iter().map(|root| folder.join(root)).find(|root| root.is_file())?;
            let text = std::fs::read_to_string(&root).ok()?;
            let path: Vec<&str> = path.split("::").collect();
            attributes(&text, 0, root.parent()?, &path)
        });
        let Some(found) = found else { return Some(format!("there is no `{test}`")) };
        let has = |begin: &str| found.iter().any(|line| line.starts_with(begin));
        if !has("#[test]") && !has("#[tokio::test") {
            return Some(format!("`{test}` is no test"));
        }
        let is_ignored = has("#[ignore") || has("#[cfg_attr");
        is_ignored.then(|| format!("`{test}` is ignored"))
    }
}

/// Attributes of the function at the end of a path, in a module whose items are indented so, and whose files are in a folder.
fn attributes(text: &str, indent: usize, folder: &Path, path: &[&str]) -> Option<Vec<String>> {
    let lines: Vec<&str> = text.lines().collect();
    let indent_of = |line: &str| line.len() - line.trim_start().len();
    let (name, rest) = path.split_first()?;
    if rest.is_empty() {
        let is_it = |line: &str| {
            let line = line.trim_start();
            let line = line.strip_prefix("async ").unwrap_or(line);
            line.strip_prefix("fn ").is_some_and(|rest| rest.starts_with(&format!("{name}(")))
        };
        // Proptest's functions are in a macro.
        let is_in_proptest = |at: usize| {
            let mut before = lines.iter().take(at).rev().filter(|line| !line.is_empty());
            before
                .find(|line| indent_of(line) == indent)
                .is_some_and(|line| line.trim_start().starts_with("proptest!"))
        };
        let at = (0..lines.len()).find(|&at| {
            lines.get(at).is_some_and(|line| {
                is_it(line)
                    && (indent_of(line) == indent
                        || indent_of(line) == indent + 4 && is_in_proptest(at))
            })
        })?;
        // An attribute that is broken onto several lines ends with its bracket; nothing else stands above without a blank.
        let above = lines.iter().take(at).rev().map(|line| line.trim());
        let above = above.take_while(|line| !line.is_empty() && !line.ends_with(['{', '}', ';']));
        let no_comments = above.filter(|line| !line.starts_with("//"));
        return Some(no_comments.map(str::to_owned).collect());
    }
    let declared = lines.iter().position(|line| {
        indent_of(line) == indent
            && line.trim_start().trim_start_matches("pub(crate) ").strip_prefix("mod ").is_some_and(
                |rest| rest == format!("{name};").as_str() || rest == format!("{name} {{").as_str(),
            )
    })?;
    let folder_within = folder.join(name);
    if lines.get(declared)?.ends_with('{') {
        let inside = lines.iter().skip(declared + 1);
        let inside: Vec<&str> = inside
            .take_while(|line| !(indent_of(line) == indent && line.trim() == "}"))
            .copied()
            .collect();
        return attributes(&inside.join("\n"), indent + 4, &folder_within, rest);
    }
    let files = [folder.join(format!("{name}.rs")), folder_within.join("mod.rs")];
    let text = files.iter().find_map(|file| std::fs::read_to_string(file).ok())?;
    attributes(&text, 0, &folder_within, rest)
}
