//! Verifies the shipped agent: its properties on a model and on the C, run-time errors, cost, and test
//! coverage. Mutants show that the proofs can fail.

mod coverage;
mod model;
mod mutants;
mod proof;
mod report;
mod tools;

use std::io;
use std::path::{Path, PathBuf};

use asl2c::{Cbmc, Checked, Checks, Plan, Proof, alarms, coarse_alarms};
use translator::TranslateError;

use self::mutants::{AGENT, C, CONFIGURATION, MUTANTS, Mutant, RUN_TIME};
use self::proof::{broken, prove, violates, write_program};
use self::report::Report;
use self::tools::{Missing, Tools};
use crate::parallel;

/// Why the verification failed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum VerifyError {
    /// A file or a program.
    #[error("{what}: {source}")]
    Io {
        /// The operation.
        what: String,
        /// The system's error.
        source: io::Error,
    },
    /// Required tools are missing.
    #[error("{0}")]
    Missing(Missing),
    /// CBMC is missing, which is not available as a package everywhere.
    #[error("nothing is proved: CBMC cannot be run")]
    NoCbmc,
    /// The agent was rejected by the translator.
    #[error("{0}")]
    Translate(#[from] TranslateError),
    /// The C was not proved.
    #[error(transparent)]
    Proof(#[from] asl2c::ProveError),
    /// Checking the model failed.
    #[error(transparent)]
    Model(#[from] asl2c::VerifyError),
    /// Frama-C came to no result.
    #[error(transparent)]
    Alarms(#[from] asl2c::ToolError),
    /// Some figures could not be measured: one reason per line.
    #[error("not everything is measured:\n{0}")]
    Unmeasured(String),
    /// Unexpected output of a tool.
    #[error("{tool} did not come to a result:\n{output}")]
    Tool {
        /// The tool.
        tool: &'static str,
        /// End of its output.
        output: String,
    },
}

/// An agent to be verified.
#[derive(Debug, Clone, Copy)]
struct Agent<'a> {
    /// File name of the configuration.
    name: &'a str,
    /// The configuration.
    configuration: &'a str,
    /// The agent.
    text: &'a str,
}

const AUTOPILOT: Agent<'_> = Agent {
    name: "autopilot.conf",
    configuration: include_str!("../../../autopilot/agent/autopilot.conf"),
    text: include_str!("../../../autopilot/agent/autopilot.asl"),
};
const PAPER: Agent<'_> = Agent {
    name: "paper.conf",
    configuration: include_str!("../../../translator/agents/paper.conf"),
    text: include_str!("../../../translator/agents/paper.asl"),
};
const REPORT: &str = "docs/verification.md";
/// The autopilot's invariant as it was found last, a condition per line. Checking it takes a tenth of the time that
/// finding it takes.
const INVARIANT: &str = "xtask/src/verify/autopilot.invariant";

/// Results of an agent on its model and on its C.
#[derive(Debug)]
struct Findings {
    model: Vec<Checked>,
    c: Proof,
}

impl Findings {
    /// Result of a property on the model.
    fn on_model(&self, name: &str) -> Option<&Checked> {
        self.model.iter().find(|checked| checked.property.name == name)
    }

    /// Whether every property was proved, on the model and on the C.
    fn hold(&self) -> bool {
        let mut names = self.c.properties.iter().map(|(property, _)| &property.name);
        self.c.holds()
            && names
                .all(|name| self.on_model(name).is_some_and(|checked| checked.verdict.is_proved()))
    }
}

/// Result of a mutant.
#[derive(Debug)]
struct Caught {
    mutant: &'static Mutant,
    /// Properties that the proof on the C reports as broken.
    broken: Vec<String>,
    /// On the model, whether the property broken by the mutant fails; `None` if the mistake is in the C.
    on_model: Option<bool>,
}

impl Caught {
    /// Whether every method found the property broken.
    fn is_caught(&self) -> bool {
        self.broken.iter().any(|name| name == self.mutant.expected) && self.on_model != Some(false)
    }
}

/// Verifies the shipped agent and, unless `only_proofs`, its mutants and the paper's agent. Tests are run to measure the
/// coverage, or have `counted` it in a folder. Returns the report, and writes it to a file if everything was proved.
pub(crate) fn run(
    only_proofs: bool,
    counted: Option<&Path>,
) -> Result<(String, bool), VerifyError> {
    let Tools { cbmc, versions } = Tools::find(only_proofs)?;
    let verifier = Verifier { cbmc };
    let generated = folder("verify");
    let known = read_invariant()?;
    let autopilot = verifier.verify(&AUTOPILOT, &generated.join("autopilot"), &known)?;
    if autopilot.hold() && autopilot.c.invariant != known {
        write(Path::new(""), INVARIANT, &(autopilot.c.invariant.join("\n") + "\n"))?;
    }
    if only_proofs {
        return Ok((report::proved(&autopilot), autopilot.hold()));
    }
    let paper = verifier.verify(&PAPER, &generated.join("paper"), &[])?;
    let mutants = verifier.mutants(&autopilot.c.invariant)?;
    let cost = model::cost(&AUTOPILOT)?;
    let coverage = counted.map_or_else(coverage::measure, coverage::counted)?;
    let good = autopilot.hold() && mutants.iter().all(Caught::is_caught);
    let report = Report { versions, autopilot, paper, mutants, cost, coverage };
    let mut lines = report.lines();
    if good {
        write(Path::new(""), REPORT, &report.markdown())?;
    } else {
        lines += "Not all was proved: ";
        lines += REPORT;
        lines += " is left as it was\n";
    }
    Ok((lines, good))
}

/// Runs the verification with the tools found.
struct Verifier {
    cbmc: Cbmc,
}

impl Verifier {
    /// All results of an agent. If the known conditions are not an invariant that proves everything, one is
    /// searched for.
    fn verify(
        &self,
        agent: &Agent<'_>,
        folder: &Path,
        known: &[String],
    ) -> Result<Findings, VerifyError> {
        let prove_with = |known: &[String]| {
            prove(agent, &self.cbmc, folder, &Plan { known, ..Plan::ALL }, |_| None)
        };
        let prove = || {
            let mut c = prove_with(known)?;
            if !c.holds() && !known.is_empty() {
                c = prove_with(&[])?;
            }
            c.run_time.extend(alarms(folder)?);
            Ok(c)
        };
        let (model, c) = parallel::both(|| model::check(agent), prove)?;
        Ok(Findings { model, c })
    }

    /// Results of the mutants, given the invariant of the agent.
    fn mutants(&self, invariant: &[String]) -> Result<Vec<Caught>, VerifyError> {
        // Mistakes in the C take longest: a core that begins with them last is alone with them at the end.
        let mut numbers: Vec<usize> = (0..MUTANTS.len()).collect();
        numbers.sort_by_key(|number| MUTANTS[*number].first.file != C);
        let mut caught = parallel::map(&numbers, |number| {
            let folder = folder("verify").join(format!("mutant{number}"));
            self.mutant(&MUTANTS[number], invariant, &folder).map(|caught| (number, caught))
        })?;
        caught.sort_by_key(|(number, _)| *number);
        Ok(caught.into_iter().map(|(_, caught)| caught).collect())
    }

    fn mutant(
        &self,
        mutant: &'static Mutant,
        invariant: &[String],
        folder: &Path,
    ) -> Result<Caught, VerifyError> {
        let changed =
            |file, text: &str| mutant.change(file, text).unwrap_or_else(|| text.to_owned());
        let configuration = changed(CONFIGURATION, AUTOPILOT.configuration);
        let text = changed(AGENT, AUTOPILOT.text);
        let agent = Agent { configuration: &configuration, text: &text, ..AUTOPILOT };
        let spoil = |file: &str| mutant.change(C, file);
        if mutant.expected == RUN_TIME {
            write_program(&agent, folder, spoil)?;
            let is_seen = !coarse_alarms(folder)?.is_empty();
            let broken = is_seen.then(|| RUN_TIME.to_owned()).into_iter().collect();
            return Ok(Caught { mutant, broken, on_model: None });
        }
        // The agent keeps the property in each transition from a state that satisfies its invariant. A mutant does not, or
        // it breaks a condition of the invariant first, most likely where it differs.
        let goals = mutant.goals(AUTOPILOT.text);
        let wanted = (mutant.expected, goals.as_slice());
        let at_once = violates(&agent, &self.cbmc, folder, invariant, wanted, spoil)?;
        // If the property also fails on the model, the agent's invariant suffices to find it on the C.
        // Otherwise all candidates are needed, because a failed proof with fewer conditions says nothing
        // about the mutant.
        let on_model = mutant.first.file != C;
        let broken = if at_once {
            vec![mutant.expected.to_owned()]
        } else {
            let known = if on_model { invariant } else { &[] };
            let plan = Plan { checks: Checks::Properties, known, enough: Some(mutant.expected) };
            let proof = prove(&agent, &self.cbmc, folder, &plan, spoil)?;
            broken(&proof).into_iter().map(str::to_owned).collect()
        };
        let on_model = on_model.then(|| model::is_refuted(&agent, mutant.expected)).transpose()?;
        Ok(Caught { mutant, broken, on_model })
    }
}

/// The invariant found last; empty if there is none.
fn read_invariant() -> Result<Vec<String>, VerifyError> {
    match std::fs::read_to_string(INVARIANT) {
        Ok(text) => Ok(text.lines().map(str::to_owned).collect()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(in_file("cannot read", Path::new(INVARIANT))(error)),
    }
}

/// Folder of the tools and generated files.
fn folder(name: &str) -> PathBuf {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    target.join(name)
}

fn write(folder: &Path, name: &str, text: &str) -> Result<(), VerifyError> {
    let path = folder.join(name);
    std::fs::write(&path, text).map_err(in_file("cannot write", &path))
}

fn in_file(what: &str, path: &Path) -> impl FnOnce(io::Error) -> VerifyError {
    let what = format!("{what} {}", path.display());
    move |source| VerifyError::Io { what, source }
}
