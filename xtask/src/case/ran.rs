//! What has run, by the output of `cargo test` and of `cargo xtask verify`.

use std::collections::{BTreeMap, BTreeSet};

use super::sources::Sources;

/// How often each test was said to be something: `ok`, `ignored`, `FAILED`.
pub(crate) type Ran = BTreeMap<String, Vec<String>>;

/// Tests in the output of `cargo test`, named as on the page: a name is unique in its binary only.
pub(crate) fn tests(log: &str, sources: &Sources) -> Ran {
    let mut ran = Ran::new();
    let mut package: Option<String> = None;
    let mut binary: Option<String> = None;
    for line in log.lines().map(str::trim_end) {
        if let Some(running) = line.trim_start().strip_prefix("Running ") {
            // `unittests src/lib.rs (target/debug/deps/NAME-HASH)`, or the file of an integration test.
            let (file, program) = running.split_once(" (").unwrap_or((running, ""));
            let name = program.rsplit('/').next().and_then(|name| name.rsplit_once('-'));
            let name = name.map_or("", |(name, _)| name);
            if let Some(root) = file.strip_prefix("unittests ") {
                let of = name.replace('_', "-");
                // The program of a package with a library has the library's name.
                let has_library = sources.package_with("src/lib.rs", Some(&of)) == Some(&of);
                binary = (root == "src/lib.rs" || !has_library).then(|| of.clone());
                package = Some(of);
            } else {
                let of = sources.package_with(file, package.as_deref());
                binary = of.map(|of| format!("{of}/{name}"));
            }
        } else if line.trim_start().starts_with("Doc-tests ") {
            binary = None;
        } else if let Some((name, result)) = line.strip_prefix("test ").and_then(ended)
            && let Some(binary) = &binary
        {
            ran.entry(format!("{binary} {name}")).or_default().push(result.to_owned());
        }
    }
    ran
}

/// Name and result in `NAME ... RESULT`.
fn ended(rest: &str) -> Option<(&str, &str)> {
    let (name, result) = rest.split_once(" ... ")?;
    let result = result.split([',', ' ', ':']).next()?;
    Some((name.split(' ').next()?, result))
}

/// Why a test counts as not run.
pub(crate) fn not_ran(ran: &Ran, test: &str) -> Option<String> {
    match ran.get(test) {
        None => Some(format!("`{test}` did not run")),
        Some(results) => {
            let bad = results.iter().find(|result| *result != "ok")?;
            Some(format!("`{test}` ended with {bad}"))
        }
    }
}

/// What the output of `cargo xtask verify` says of the shipped agent that is proved or shown.
pub(crate) fn proved(log: &str) -> BTreeSet<String> {
    // Behind that come the paper's properties, with the same names.
    let lines = log.lines().skip_while(|line| !line.starts_with("The shipped agent"));
    let lines = lines.skip(1).take_while(|line| line.starts_with("  "));
    let rows = lines.filter_map(|line| line.trim_start().split_once("  "));
    let is_proved = |verdict: &str| match verdict.split_once("C: ") {
        Some((model, c)) => c == "proved" && (model.is_empty() || model == "model: holds"),
        None => verdict.starts_with("shown"),
    };
    let squeezed = |verdict: &str| {
        verdict.split("  ").map(str::trim).filter(|part| !part.is_empty()).collect::<String>()
    };
    rows.filter(|(_, verdict)| is_proved(&squeezed(verdict)))
        .map(|(name, _)| name.to_owned())
        .collect()
}

/// What `docs/verification.md` says of the shipped agent that is proved or shown.
pub(crate) fn proved_on_the_page(page: &str) -> BTreeSet<String> {
    // Behind that come mutants, and the paper's agent.
    let page = page.split("## The proof can fail").next().unwrap_or_default();
    let rows = page.lines().map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
    rows.filter_map(|row| match row.as_slice() {
        ["", name, .., "holds", "proved", ""] | ["", name, _, _, "", "proved", ""] => Some(*name),
        ["", name, "shown", ..] => Some(*name),
        _ => None,
    })
    .map(|name| name.trim_matches('`').to_owned())
    .collect()
}
