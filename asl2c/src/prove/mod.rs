//! Proofs on an agent's C, in every environment and for any number of steps, and ways to what does not hold.
//!
//! CBMC checks one transition from any state that satisfies an invariant. The invariant is found by
//! dropping, from many candidates, those that do not hold in the beginning or that some transition
//! breaks, until the rest proves itself (Flanagan and Leino, "Houdini", FME 2001). Where that proves nothing, CBMC
//! looks for a way to a failure from the beginning on, which the reference interpreter must confirm.

#[allow(clippy::disallowed_methods, reason = "other programs get a limited time")]
mod cbmc;
#[allow(clippy::disallowed_methods, reason = "the search gets a limited time")]
mod search;
mod shrink;
mod trace;

use std::io;
use std::path::{Path, PathBuf};

use translator::{Obligations, Promise};

pub use self::cbmc::{CBMC, Cbmc};
pub(crate) use self::search::{Found, Limits, Searched, search};
pub(crate) use self::trace::Way;

/// Why nothing was proved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProveError {
    /// There is no CBMC, or none that can be used.
    #[error(
        "nothing is proved: {reason}; CBMC 6 or later is needed: `apt install cbmc` where that is new enough, or \
         https://github.com/diffblue/cbmc/releases; one that is elsewhere is named by `--cbmc PATH`"
    )]
    Missing {
        /// What is missing.
        reason: String,
    },
    /// A file or a program.
    #[error("{what}: {source}")]
    Io {
        /// What was tried.
        what: String,
        /// What the system says.
        source: io::Error,
    },
    /// CBMC said something else than a result.
    #[error("CBMC did not come to a result:\n{output}")]
    NoResult {
        /// The end of what it said.
        output: String,
    },
}

/// What was proved of an agent's C, and what was not.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Proof {
    /// Each property, and whether it holds in every environment, however long the agent runs.
    pub properties: Vec<(Promise, bool)>,
    /// Errors at run time that could not be excluded, as CBMC says it.
    pub run_time: Vec<String>,
    /// The candidates that are invariant.
    pub invariant: Vec<String>,
    /// How many candidates there were.
    pub candidates: usize,
    /// Names of the assertions that are not proved.
    pub(crate) open: Vec<cbmc::Failure>,
}

impl Proof {
    /// Whether everything was proved.
    pub fn holds(&self) -> bool {
        self.run_time.is_empty() && self.properties.iter().all(|(_, holds)| *holds)
    }
}

/// What is looked at besides the candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Checks {
    /// The properties.
    Properties,
    /// And whatever could be an error at run time.
    All,
}

/// How a proof is made.
#[derive(Debug, Clone, Copy)]
pub struct Plan<'a> {
    /// What is proved.
    pub checks: Checks,
    /// Only these candidates are tried, unless there are none: those of an agent that nearly is this one.
    pub known: &'a [String],
    /// It is enough to know that this property is not proved: with fewer candidates it is not proved either.
    pub enough: Option<&'a str>,
}

impl Plan<'_> {
    /// Everything, with all candidates.
    pub const ALL: Plan<'static> = Plan { checks: Checks::All, known: &[], enough: None };
}

/// Proves what can be proved of an agent's C; `folder` is made and gets the generated files.
///
/// # Errors
/// If a file cannot be written, or CBMC comes to no result.
pub fn prove(
    obligations: &Obligations,
    cbmc: &Cbmc,
    folder: &Path,
    plan: &Plan<'_>,
) -> Result<Proof, ProveError> {
    std::fs::create_dir_all(folder).map_err(in_file("cannot make", folder))?;
    for file in &obligations.files {
        write(folder, &file.name, &file.text)?;
    }
    let candidates = obligations.candidates();
    let tried = |index: &usize| plan.known.is_empty() || plan.known.contains(&candidates[*index]);
    let tried: Vec<usize> = (0..candidates.len()).filter(tried).collect();
    let check = |function: &str, chosen: &[usize], checks| {
        let invariant = obligations.invariant(chosen);
        write(folder, &invariant.name, &invariant.text)?;
        cbmc.check(folder, function, chosen, checks)
    };
    let mut chosen = check("base", &tried, Checks::Properties)?.1;
    let mut open = loop {
        let (open, left) = check("induction", &chosen, Checks::Properties)?;
        let found = |name: &str| open.iter().any(|failure| failure.property() == Some(name));
        if left.len() == chosen.len() || plan.enough.is_some_and(found) {
            break open;
        }
        chosen = left;
    };
    if plan.checks == Checks::All {
        open = check("induction", &chosen, Checks::All)?.0;
    }
    let holds = |name: &str| !open.iter().any(|failure| failure.property() == Some(name));
    let properties = obligations.properties.iter();
    let properties = properties.map(|promise| (promise.clone(), holds(&promise.name))).collect();
    let others = open.iter().filter(|failure| failure.property().is_none());
    let run_time = others.map(|failure| failure.said.clone()).collect();
    let invariant = chosen.into_iter().map(|index| candidates[index].clone()).collect();
    Ok(Proof { properties, run_time, invariant, candidates: candidates.len(), open })
}

fn write(folder: &Path, name: &str, text: &str) -> Result<(), ProveError> {
    let path: PathBuf = folder.join(name);
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent).map_err(in_file("cannot make", parent))?;
    }
    std::fs::write(&path, text).map_err(in_file("cannot write", &path))
}

fn in_file(what: &str, path: &Path) -> impl FnOnce(io::Error) -> ProveError {
    let what = format!("{what} {}", path.display());
    move |source| ProveError::Io { what, source }
}
