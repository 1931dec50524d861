//! The safety case, `docs/safety-case.md`: checks it, draws it, and compares it with what has run.

mod drawing;
mod page;
mod ran;
mod sources;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use self::page::{Kind, Page};
use self::sources::Sources;

/// What to do.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Only look, and write no drawing; fails if the drawing is not what the page says
    #[arg(long)]
    check: bool,
    /// Output of `cargo test --workspace`: each test of the case must have run, and been ok
    #[arg(long, value_name = "LOG")]
    ran: Option<PathBuf>,
    /// Output of `cargo xtask verify`: each proof of the case must have been made
    #[arg(long, value_name = "LOG")]
    proved: Option<PathBuf>,
}

/// Why nothing was checked.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {source}")]
pub(crate) struct CaseError {
    path: PathBuf,
    source: std::io::Error,
}

const PAGE: &str = "docs/safety-case.md";
const DRAWING: &str = "docs/safety-case.svg";

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: PathBuf) -> Result<String, CaseError> {
    std::fs::read_to_string(&path).map_err(|source| CaseError { path, source })
}

/// Checks the case, and writes its drawing if there is nothing wrong with it. Returns what to print, and whether it is good.
pub(crate) fn run(arguments: &Arguments) -> Result<(String, bool), CaseError> {
    let page = Page::parse(&read(workspace().join(PAGE))?);
    let mut mistakes = mistakes(&page)?;
    let tests_log = arguments.ran.clone().map(read).transpose()?;
    let proofs_log = arguments.proved.clone().map(read).transpose()?;
    mistakes.extend(not_seen(&page, tests_log.as_deref(), proofs_log.as_deref())?);
    let drawing = drawing::draw(&page);
    let path = workspace().join(DRAWING);
    if arguments.check || tests_log.is_some() || proofs_log.is_some() {
        if read(path)? != drawing {
            mistakes.push((0, format!("{DRAWING} shows something else: run `cargo xtask case`")));
        }
    } else if mistakes.is_empty() {
        std::fs::write(&path, &drawing).map_err(|source| CaseError { path, source })?;
    }
    mistakes.sort();
    let mut text = String::new();
    for (line, mistake) in &mistakes {
        _ = writeln!(text, "{PAGE}:{line}: {mistake}");
    }
    let count = |is_counted: fn(&Kind) -> bool| {
        page.nodes.values().filter(|node| is_counted(&node.kind)).count()
    };
    _ = writeln!(
        text,
        "{} goals, {} tests, {} proofs, {} runs, {} assumptions; {} mistakes",
        count(|kind| *kind == Kind::Goal),
        count(|kind| matches!(kind, Kind::Test(_))),
        count(|kind| matches!(kind, Kind::Proof(_))),
        count(|kind| matches!(kind, Kind::Run(_))),
        count(|kind| *kind == Kind::Assumption),
        mistakes.len(),
    );
    Ok((text, mistakes.is_empty()))
}

/// What is wrong with the page by itself and by the repository.
fn mistakes(page: &Page) -> Result<Vec<(usize, String)>, CaseError> {
    let root = workspace();
    let sources = sources_of(&root)?;
    let proved = ran::proved_on_the_page(&read(root.join("docs/verification.md"))?);
    let ci = read(root.join(".ci/run"))?;
    let mut mistakes = page.mistakes.clone();
    for node in page.nodes.values() {
        let wrong = match &node.kind {
            Kind::Test(name) => sources.missing(name),
            Kind::Proof(name) => {
                (!proved.contains(name)).then(|| format!("`{name}` is not proved"))
            }
            Kind::Run(command) => (!ci.contains(&command.replace("cargo xtask", "/xtask\"")))
                .then(|| format!("`.ci/run` does not run `{command}`")),
            _ => None,
        };
        mistakes.extend(wrong.map(|wrong| (node.line, wrong)));
    }
    Ok(mistakes)
}

/// Which evidence is not in the outputs that are given.
fn not_seen(
    page: &Page,
    tests: Option<&str>,
    proofs: Option<&str>,
) -> Result<Vec<(usize, String)>, CaseError> {
    let sources = sources_of(&workspace())?;
    let ran = tests.map(|log| ran::tests(log, &sources));
    let proved = proofs.map(ran::proved);
    let unseen = page.nodes.values().filter_map(|node| {
        let wrong = match &node.kind {
            Kind::Test(name) => ran::not_ran(ran.as_ref()?, name)?,
            Kind::Proof(name) if !proved.as_ref()?.contains(name) => {
                format!("`{name}` was not proved")
            }
            _ => return None,
        };
        Some((node.line, wrong))
    });
    Ok(unseen.collect())
}

fn sources_of(root: &Path) -> Result<Sources, CaseError> {
    Sources::of(root).map_err(|source| CaseError { path: root.to_owned(), source })
}

#[cfg(test)]
mod tests;
