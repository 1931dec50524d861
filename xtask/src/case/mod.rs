//! The safety case, `docs/safety-case.md`: checks and draws it, and compares it with what has run.

mod drawing;
mod page;
mod sources;

use std::fmt::Write as _;
use std::path::PathBuf;

use self::page::{Kind, Mistake, Nodes};
use crate::files::{FileError, cannot, read, root, write};

/// What to do.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Write nothing, and fail if a test of the case did not run or was not ok in this output of `cargo test --workspace`
    #[arg(long, value_name = "LOG")]
    ran: Option<PathBuf>,
}

const PAGE: &str = "docs/safety-case.md";
const DRAWING: &str = "docs/safety-case.svg";

/// Checks the case, and draws it. Returns what to print, and whether nothing is wrong.
pub(crate) fn run(arguments: &Arguments) -> Result<(String, bool), FileError> {
    let log = arguments.ran.as_deref().map(read).transpose()?;
    let (nodes, mut mistakes) = checked(&read(&root().join(PAGE))?, log.as_deref())?;
    if mistakes.is_empty() && log.is_none() {
        let drawing = root().join(DRAWING);
        write(&drawing, &drawing::draw(&nodes))?;
    }
    mistakes.sort();
    let mut text = String::new();
    for (line, mistake) in &mistakes {
        _ = writeln!(text, "{PAGE}:{line}: {mistake}");
    }
    let assumed = nodes.values().filter(|node| node.kind == Kind::Assumption).count();
    let shown = nodes.values().filter(|node| node.kind.is_evidence()).count();
    _ = writeln!(
        text,
        "{shown} pieces of evidence, {assumed} assumptions, {} mistakes",
        mistakes.len()
    );
    Ok((text, mistakes.is_empty()))
}

/// Reads the page, and tells what is wrong with it, by the repository and by the output of the tests, too.
fn checked(page: &str, log: Option<&str>) -> Result<(Nodes, Vec<Mistake>), FileError> {
    let packages = sources::packages(&root()).map_err(cannot("read", &root()))?;
    let results = log.map(|log| sources::results(log, &packages));
    let verification = read(&root().join("docs/verification.md"))?;
    // Behind that come mutants, and properties of another agent with the same names.
    let proofs = verification.split("## The proof can fail").next().unwrap_or_default();
    let ci = read(&root().join(".ci/run"))?;
    let (nodes, mut mistakes) = page::parse(page);
    for node in nodes.values() {
        let wrong = match &node.kind {
            Kind::Test(name) => sources::missing(&packages, name).or_else(|| {
                let ended = results.as_ref()?.get(name).map_or("nothing", |ended| {
                    ended.iter().find(|result| *result != "ok").map_or("ok", String::as_str)
                });
                (ended != "ok").then(|| format!("of `{name}` the output says {ended}"))
            }),
            Kind::Proof(name) => {
                let rows = [format!("| {name} |"), format!("| `{name}` |")];
                let is_row = |line: &str| rows.iter().any(|row| line.starts_with(row));
                let is_good =
                    |line: &str| line.ends_with("| proved |") || line.contains("| shown |");
                let is_proved = proofs.lines().any(|line| is_row(line) && is_good(line));
                (!is_proved).then(|| format!("`{name}` is not proved"))
            }
            Kind::Run(command) => {
                let is_run = ci.contains(&command.replace("cargo xtask", "/xtask\""));
                (!is_run).then(|| format!("`.ci/run` does not run `{command}`"))
            }
            _ => None,
        };
        mistakes.extend(wrong.map(|wrong| (node.line, wrong)));
    }
    Ok((nodes, mistakes))
}

#[cfg(test)]
mod tests;
