//! Proofs on an agent's C, for every environment and any number of steps, and counterexamples.
//!
//! CBMC checks one transition from any state that satisfies an invariant. The invariant is found by removing,
//! from many candidates, those that do not hold initially or that some transition breaks, until the rest is
//! inductive (Flanagan and Leino, "Houdini", FME 2001). If that does not prove a property, CBMC searches for
//! a counterexample from the initial state, which the reference interpreter has to confirm.

#[allow(clippy::disallowed_methods, reason = "other programs get a limited time")]
mod cbmc;
mod goals;
mod indices;
#[allow(clippy::disallowed_methods, reason = "the search gets a limited time")]
mod search;
mod shrink;
mod trace;
#[allow(clippy::disallowed_methods, reason = "the comparison gets a limited time")]
mod validate;
#[allow(clippy::disallowed_methods, reason = "proofs get a limited time")]
mod watch;

use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};

use translator::{DeclaredProperty, GeneratedFile, Obligations};

pub(crate) use self::cbmc::DeadBranches;
pub use self::cbmc::{CBMC, Cbmc};
use self::indices::with_checked_indices;
pub(crate) use self::search::{Found, Limits, Searched, search};
pub use self::validate::{Difference, Open, Validated, validate, validate_watched};
pub(crate) use self::validate::{SearchedWay, difference, write_comparison};
pub use self::watch::{Budget, End, Part, Watch};

/// Errors that prevent a proof.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProveError {
    /// There is no usable CBMC.
    #[error(
        "nothing is proved: {reason}; CBMC 6 or later is needed: `apt install cbmc` where that is new enough, or \
         https://github.com/diffblue/cbmc/releases; `--cbmc PATH` selects an installation"
    )]
    Missing {
        /// The reason.
        reason: String,
    },
    /// Error of a file or program.
    #[error("{what}: {source}")]
    Io {
        /// The operation.
        what: String,
        /// The system's error.
        source: io::Error,
    },
    /// Stopped by [`Cbmc::stopped_by`].
    #[error("nothing is proved: stopped")]
    Stopped,
    /// It misjudges goals whose truth is known, or contradicts itself.
    #[error(
        "nothing is proved: {path} cannot be trusted: {why}; reinstall CBMC, or select another one by `--cbmc PATH`"
    )]
    Untrusted {
        /// The program.
        path: PathBuf,
        /// What it does wrong.
        why: String,
    },
    /// The C of the proof is not complete.
    #[error(
        "nothing is proved: the C cannot be compiled: {said}; headers that the agent includes, and those that they \
         include, are looked for beside its configuration or below, and nowhere else, and need a guard against double \
         inclusion"
    )]
    NotCompiled {
        /// The first error.
        said: String,
    },
    /// The assertions of a function hold because no execution comes to its end.
    #[error(
        "nothing is proved: no execution comes to the end of `{function}()`, so that whatever is said of it is empty; \
         please report this as an error of asl2c"
    )]
    Vacuous {
        /// The function of the harness.
        function: String,
    },
    /// CBMC printed no result.
    #[error("CBMC gave no result:\n{output}")]
    NoResult {
        /// End of its output.
        output: String,
    },
}

/// Results for an agent's C.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Proof {
    /// Each property, and whether it holds in every environment and for any number of steps.
    pub properties: Vec<(DeclaredProperty, bool)>,
    /// Run-time errors that could not be excluded, in CBMC's words.
    pub run_time: Vec<String>,
    /// The candidates that are invariant.
    pub invariant: Vec<String>,
    /// Number of candidates.
    pub candidates: usize,
    /// Assertions that are not proved.
    pub(crate) open: Vec<cbmc::Failure>,
}

impl Proof {
    /// Whether everything was proved.
    pub fn holds(&self) -> bool {
        self.run_time.is_empty() && self.properties.iter().all(|(_, holds)| *holds)
    }
}

/// Assertions to check besides the candidates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Checks {
    /// The properties.
    Properties,
    /// The properties and all run-time errors.
    All,
}

/// Parameters of a proof.
#[derive(Debug, Clone, Copy)]
pub struct Plan<'a> {
    /// Assertions to check.
    pub checks: Checks,
    /// Only these candidates are tried, if there are any: the invariant of a nearly identical agent.
    pub known: &'a [String],
    /// Stop once this property is not proved: fewer candidates will not prove it either.
    pub enough: Option<&'a str>,
}

impl Plan<'_> {
    /// All checks, all candidates.
    pub const ALL: Plan<'static> = Plan { checks: Checks::All, known: &[], enough: None };
}

/// Proves the properties and run-time safety of an agent's C. Creates `folder` for the generated files.
///
/// # Errors
/// If a file cannot be written, the C cannot be compiled, or CBMC is stopped, gives no result, or one that cannot be trusted:
/// see [`ProveError`].
pub fn prove(
    obligations: &Obligations,
    cbmc: &Cbmc,
    folder: &Path,
    plan: &Plan<'_>,
) -> Result<Proof, ProveError> {
    write_files(obligations, folder)?;
    let candidates = obligations.candidates();
    let tried = tried(obligations, plan.known);
    let properties = obligations.properties.iter();
    let expected: Vec<String> =
        properties.map(|property| format!("property {}", property.name)).collect();
    let check = |function: &str, chosen: &[usize], checks| {
        let invariant = obligations.invariant(chosen);
        write(folder, &invariant.name, &invariant.text)?;
        // There is no step in the start.
        let expected = if function == "base" { &[] } else { expected.as_slice() };
        cbmc.check(folder, function, (chosen, obligations.unwinding), checks, expected)
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
    let properties = properties.map(|property| (property.clone(), holds(&property.name))).collect();
    let others = open.iter().filter(|failure| failure.property().is_none());
    let run_time = others.map(|failure| failure.said.clone()).collect();
    let invariant = chosen.into_iter().map(|index| candidates[index].clone()).collect();
    Ok(Proof { properties, run_time, invariant, candidates: candidates.len(), open })
}

/// Proves everything, first with the conditions of an invariant that was found earlier, if there are any: to check them
/// takes a tenth of the time in which it is found. If they do not prove everything, all candidates are tried.
///
/// # Errors
/// As [`prove`].
pub fn prove_beginning_with(
    known: &[String],
    obligations: &Obligations,
    cbmc: &Cbmc,
    folder: &Path,
) -> Result<Proof, ProveError> {
    let proof = prove(obligations, cbmc, folder, &Plan { known, ..Plan::ALL })?;
    if known.is_empty() || proof.holds() {
        return Ok(proof);
    }
    prove(obligations, cbmc, folder, &Plan::ALL)
}

/// Whether a property cannot be proved with these conditions, without those that the agent itself breaks: some transition
/// from a state that satisfies them violates it. Much faster than [`prove`], but what it does not find says nothing.
///
/// The states whose next step handles one of these goals come first: where one of them violates it, the others are not
/// looked at. Conditions are only sought to be broken there, because that takes longest.
///
/// # Errors
/// As [`prove`], and [`ProveError::NoResult`] if there is no such property.
pub fn violates(
    obligations: &Obligations,
    cbmc: &Cbmc,
    folder: &Path,
    known: &[String],
    (property, goals): (&str, &[&str]),
) -> Result<bool, ProveError> {
    const FUNCTION: &str = "induction";
    write_files(obligations, folder)?;
    let put = |invariant: GeneratedFile| write(folder, &invariant.name, &invariant.text);
    let at_goals = |chosen: &[usize]| {
        goals.iter().flat_map(|goal| obligations.invariants_at(chosen, goal)).collect::<Vec<_>>()
    };
    let mut chosen = tried(obligations, known);
    loop {
        let all = obligations.invariant(&chosen);
        for invariant in at_goals(&chosen).into_iter().chain([all]) {
            put(invariant)?;
            if cbmc.violates(folder, FUNCTION, property)? {
                return Ok(true);
            }
        }
        let mut kept = chosen.clone();
        for invariant in at_goals(&chosen) {
            put(invariant)?;
            let left = cbmc.kept(folder, FUNCTION, &chosen)?;
            kept.retain(|index| left.contains(index));
        }
        if kept.len() == chosen.len() {
            return Ok(false);
        }
        chosen = kept;
    }
}

/// The branches of the agent's C that no execution takes, after a [`prove`] of all in the same folder: from no state that
/// satisfies its invariant does a transition take them. Transitions are events, beliefs that are set, and steps.
///
/// # Errors
/// If CBMC gives no result.
pub(crate) fn dead_branches(
    obligations: &Obligations,
    cbmc: &Cbmc,
    folder: &Path,
) -> Result<DeadBranches, ProveError> {
    let file = obligations.files.first().map_or("", |file| &file.name);
    cbmc.dead(folder, "induction", file)
}

/// Indices of the known candidates, or of all if none are known.
fn tried(obligations: &Obligations, known: &[String]) -> Vec<usize> {
    let known: HashSet<&String> = known.iter().collect();
    let candidates = obligations.candidates();
    let is_tried = |index: &usize| known.is_empty() || known.contains(&candidates[*index]);
    (0..candidates.len()).filter(is_tried).collect()
}

fn write_files(obligations: &Obligations, folder: &Path) -> Result<(), ProveError> {
    std::fs::create_dir_all(folder).map_err(in_file("cannot make", folder))?;
    let Some((c, others)) = obligations.files.split_first() else { return Ok(()) };
    write(folder, &c.name, &with_checked_indices(&c.text))?;
    others.iter().try_for_each(|file| write(folder, &file.name, &file.text))
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
