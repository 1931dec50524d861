//! Verifies the shipped agent: its properties on a model and on the C, run-time errors, cost, and test
//! coverage. Mutants show that the proofs can fail.

mod coverage;
mod model;
mod mutants;
mod proof;
mod report;
mod tools;

use std::fmt::Write as _;
use std::io;
use std::path::Path;
use std::time::Duration;

use asl2c::{
    Cbmc, CertifyError, Checked, Checks, Evidence, Limits, Plan, Proof, PropertyEvidence,
    PropertyVerdict, Status, alarms, certify, coarse_alarms, prove_beginning_with,
};
use translator::{DeclaredProperty, TranslateError};

use self::mutants::{AGENT, C, CONFIGURATION, MUTANTS, Mutant, RUN_TIME};
use self::proof::{broken, prove, to_prove, violates, write_program};
use self::report::Report;
use self::tools::{Missing, Tools};
use crate::files::{FileError, SHIPPED_AGENT, cannot, target_folder, write};
use crate::parallel;

/// Why the verification failed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum VerifyError {
    /// A file or a program.
    #[error(transparent)]
    File(#[from] FileError),
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
    /// There is no evidence.
    #[error(transparent)]
    Certify(#[from] CertifyError),
    /// The shipped agent cannot be read.
    #[error(transparent)]
    Read(#[from] asl2c::ReadError),
    /// Frama-C came to no result.
    #[error(transparent)]
    Alarms(#[from] asl2c::ToolError),
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
/// The evidence for the shipped agent, as `asl2c certify` makes it.
const EVIDENCE: &str = "evidence";
/// Limits of its proofs. A part of the comparison takes up to two minutes where nothing else runs.
const LIMITS: Limits = Limits { time: Duration::from_mins(30), transitions: 64 };
/// The autopilot's invariant as it was found last, a condition per line. Checking it takes a tenth of the time that
/// finding it takes.
const INVARIANT: &str = "xtask/src/verify/autopilot.invariant";

/// Results of an agent on its model and on its C.
#[derive(Debug)]
struct Findings {
    model: Vec<Checked>,
    on_c: Vec<OnC>,
    /// Errors at run time that are not excluded.
    run_time: Vec<String>,
}

/// A property that was to be proved on the C.
#[derive(Debug)]
struct OnC {
    name: String,
    requirements: Vec<String>,
    formula: String,
    is_proved: bool,
}

impl Findings {
    fn of_proof(model: Vec<Checked>, proof: Proof) -> Self {
        let on_c = proof.properties.into_iter().map(|(property, is_proved)| {
            let DeclaredProperty { name, requirements, formula, .. } = property;
            OnC { name, requirements, formula, is_proved }
        });
        Self { model, on_c: on_c.collect(), run_time: proof.run_time }
    }

    fn of_evidence(model: Vec<Checked>, evidence: &Evidence) -> Self {
        let on_c = evidence.properties.iter().map(|shown| {
            let PropertyEvidence { name, requirements, formula, verdict, .. } = shown.clone();
            OnC { name, requirements, formula, is_proved: verdict == PropertyVerdict::Proved }
        });
        let run_time = evidence.run_time_errors.iter().map(|error| error.name.clone()).collect();
        Self { model, on_c: on_c.collect(), run_time }
    }

    /// Result of a property on the model.
    fn on_model(&self, name: &str) -> Option<&Checked> {
        self.model.iter().find(|checked| checked.property.name == name)
    }

    /// Whether every property was proved, on the model and on the C.
    fn hold(&self) -> bool {
        let proved = |on_c: &OnC| {
            let model = self.on_model(&on_c.name);
            on_c.is_proved && model.is_some_and(|checked| checked.verdict.is_proved())
        };
        self.run_time.is_empty() && self.on_c.iter().all(proved)
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

/// Proves the properties of the shipped agent, and nothing else. Returns the report.
pub(crate) fn proofs() -> Result<(String, bool), VerifyError> {
    let verifier = Verifier { cbmc: Tools::find(true)?.cbmc };
    let folder = target_folder("verify").join("autopilot");
    let autopilot = verifier.verify(&AUTOPILOT, &folder, &read_invariant()?)?;
    Ok((report::proved(&autopilot), autopilot.hold()))
}

/// Makes all evidence for the shipped agent, and looks at its mutants and the paper's agent. Tests are run to measure the
/// coverage, unless they have `counted` it in a target folder. Returns the report, and writes it to a file if everything
/// was shown.
pub(crate) fn run(counted: Option<&Path>) -> Result<(String, bool), VerifyError> {
    let Tools { cbmc, versions } = Tools::find(false)?;
    let verifier = Verifier { cbmc };
    let known = read_invariant()?;
    let evidence = verifier.certify(&known)?;
    let autopilot = Findings::of_evidence(model::check(&AUTOPILOT)?, &evidence);
    if autopilot.hold() && evidence.invariant != known {
        write(Path::new(INVARIANT), &(evidence.invariant.join("\n") + "\n"))?;
    }
    let paper = verifier.verify(&PAPER, &target_folder("verify").join("paper"), &[])?;
    let mutants = verifier.mutants(&evidence.invariant)?;
    let coverage = counted.map_or_else(coverage::measure, coverage::counted)?;
    let shown = [
        evidence.validation.status,
        evidence.rules_status(),
        evidence.bounds_status(),
        evidence.tests_status(),
    ];
    let good = autopilot.hold()
        && shown.iter().all(|status| *status == Status::Shown)
        && mutants.iter().all(Caught::is_caught);
    let report = Report { versions, evidence, autopilot, paper, mutants, coverage };
    let mut lines = report.lines();
    if good {
        write(Path::new(REPORT), &report.markdown())?;
    } else {
        _ = writeln!(lines, "Not all was shown: {REPORT} is left as it was");
    }
    Ok((lines, good))
}

/// Runs the verification with the tools found.
struct Verifier {
    cbmc: Cbmc,
}

impl Verifier {
    /// All results of an agent. The proof begins with the known conditions.
    fn verify(
        &self,
        agent: &Agent<'_>,
        folder: &Path,
        known: &[String],
    ) -> Result<Findings, VerifyError> {
        let prove = || {
            let obligations = to_prove(agent, |_| None)?;
            let mut proof = prove_beginning_with(known, &obligations, &self.cbmc, folder)?;
            proof.run_time.extend(alarms(folder)?);
            Ok::<_, VerifyError>(proof)
        };
        let (model, proof) = parallel::both(|| model::check(agent), prove)?;
        Ok(Findings::of_proof(model, proof))
    }

    /// The evidence for the shipped agent, as `asl2c certify` makes it, in its folder.
    fn certify(&self, known: &[String]) -> Result<Evidence, VerifyError> {
        let agent = asl2c::Agent::read(Path::new(SHIPPED_AGENT))?;
        let certified = certify(&agent, &[], &self.cbmc, LIMITS, known, &mut |_| ())?;
        certified.write(&target_folder(EVIDENCE), &[])?;
        Ok(certified.evidence)
    }

    /// Results of the mutants, given the invariant of the agent.
    fn mutants(&self, invariant: &[String]) -> Result<Vec<Caught>, VerifyError> {
        // Mistakes in the C take longest: a core that begins with them last is alone with them at the end.
        let mut numbers: Vec<usize> = (0..MUTANTS.len()).collect();
        numbers.sort_by_key(|number| MUTANTS[*number].first.file != C);
        let mut caught = parallel::map(&numbers, |number| {
            let folder = target_folder("verify").join(format!("mutant{number}"));
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
fn read_invariant() -> Result<Vec<String>, FileError> {
    match std::fs::read_to_string(INVARIANT) {
        Ok(text) => Ok(text.lines().map(str::to_owned).collect()),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(cannot("read", Path::new(INVARIANT))(error)),
    }
}
