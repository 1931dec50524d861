//! Proves, checks, measures and tests an agent, and gathers the results.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Duration;

use judged_c::judge;
use translator::{
    GeneratedFile, Obligations, TraceRow, TranslateError, comparison, obligations, trace_rows,
    translate,
};

use super::evidence::{
    Bounds, Evidence, PlanEvidence, PropertyEvidence, Requirement, Status, TestEvidence,
    ValidationEvidence, Verdict,
};
use super::misra::deviations;
use super::reach::reach;
use super::trust::{assumptions, tools};
use crate::agent::Agent;
use crate::coverage::{Coverage, CoverageError, OwnTest, Test, cover};
use crate::eva::alarms;
use crate::headers::HeaderError;
use crate::measure::measure;
use crate::output::known_again;
use crate::prove::{
    Cbmc, DeadBranches, Found, Limits as SearchLimits, Proof, ProveError, Searched, Validated,
    dead_branches, prove_beginning_with, search, validate,
};
use crate::run::Session;
use crate::tool::ToolError;
use crate::written::WriteError;

/// Why there is no evidence.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CertifyError {
    /// The agent has errors, or cannot be proved.
    #[error(transparent)]
    Translate(#[from] TranslateError),
    /// CBMC is missing or gave no result.
    #[error(transparent)]
    Prove(#[from] ProveError),
    /// A header of the agent's own.
    #[error("nothing is certified: {0}")]
    Header(#[from] HeaderError),
    /// Tools are missing: each with what to install.
    #[error("nothing is certified:\n{}", .0.join("\n"))]
    Tools(Vec<String>),
    /// Another tool is missing or failed.
    #[error("nothing is certified: {0}")]
    Tool(#[from] ToolError),
    /// A file of the agent or the evidence.
    #[error("{what}: {source}")]
    Io {
        /// The operation.
        what: String,
        /// The system's error.
        source: std::io::Error,
    },
    /// A file of the evidence is somebody else's, or cannot be written.
    #[error("{0}")]
    Write(String),
    /// The folder holds something else.
    #[error(
        "{folder} is not empty and holds no evidence, so it is not changed; `-o DIR` names another folder"
    )]
    Occupied {
        /// The folder.
        folder: String,
    },
    /// Its list of evidence has what evidence has not.
    #[error(
        "{path} is listed as evidence in that folder, but is not what asl2c writes there, so nothing is changed; `-o DIR` \
         names another folder"
    )]
    Unlikely {
        /// The file.
        path: PathBuf,
    },
    /// Its list of evidence has a file that is read.
    #[error(
        "{path}, of which evidence is made, is listed in that folder as earlier evidence, which would be replaced; \
         nothing is changed; `-o DIR` names another folder"
    )]
    Input {
        /// The file.
        path: PathBuf,
    },
    /// A test of one's own cannot be executed, or the agent does something else.
    #[error("nothing is certified: {0}")]
    Test(String),
    /// A property that CBMC has shown is broken by the agent in a test.
    #[error(
        "nothing is certified: CBMC shows `{property}`, which the agent breaks in the test that begins with\n{test}\n\
         A tool that shows what is false cannot be trusted"
    )]
    Contradicted {
        /// The property.
        property: String,
        /// The first lines of the test.
        test: String,
    },
}

impl From<WriteError> for CertifyError {
    fn from(error: WriteError) -> Self {
        Self::Write(error.to_string())
    }
}

impl From<CoverageError> for CertifyError {
    fn from(error: CoverageError) -> Self {
        match error {
            CoverageError::Translate(error) => error.into(),
            CoverageError::Header(error) => error.into(),
            CoverageError::Tool(error) => error.into(),
            CoverageError::Test(said) => Self::Test(said),
        }
    }
}

/// Limits of the proofs.
#[derive(Debug, Clone, Copy)]
pub struct Limits {
    /// Time of each proof of the comparison, and of the search for counterexamples.
    pub time: Duration,
    /// Maximum length of counterexamples: events, beliefs and steps.
    pub transitions: u32,
}

/// The evidence, and the files that it refers to.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Certified {
    /// The results.
    pub evidence: Evidence,
    /// Names and texts: the agent, its C, tests and counterexamples.
    pub files: Vec<(String, String)>,
}

/// Folder of the agent's own files in the evidence.
pub(super) const AGENT: &str = "agent";
/// Folder of the generated files.
pub(super) const C: &str = "c";
pub(super) const TESTS: &str = "tests";
pub(super) const OWN_TESTS: &str = "tests/own";
pub(super) const COUNTEREXAMPLES: &str = "counterexamples";

/// Gathers the evidence for an agent, with tests of one's own; `tell` hears what is being done. The proof of the properties
/// begins with the conditions of an invariant that are known from earlier evidence, if there are any.
///
/// # Errors
/// If a tool is missing or fails, the agent cannot be translated or proved, one of its headers or tests cannot be used, or a
/// test breaks what is proved: see [`CertifyError`].
pub fn certify(
    agent: &Agent,
    own_tests: &[OwnTest],
    cbmc: &Cbmc,
    limits: Limits,
    known: &[String],
    tell: &mut dyn FnMut(&str),
) -> Result<Certified, CertifyError> {
    let Agent { configuration, text, .. } = agent;
    // A missing tool is told before an hour of proofs.
    let tools = tools(cbmc)?;
    let mut translation = translate(configuration, text)?;
    // So is an agent that cannot be proved.
    let mut obligations = obligations(configuration, text)?;
    let own = agent.own_headers(&translation.files)?;
    translation.files.extend(own);
    obligations.files.extend(agent.own_headers(&obligations.files)?);
    let mut tell = |doing: &str| cbmc.check_stop().map(|()| tell(doing));
    tell("checks the rules of MISRA C:2012")?;
    let deviations = deviations(&translation.files)?;
    tell("measures stack and time")?;
    let missing = measure(&mut translation, configuration, text);
    let bounds = Bounds { report: translation.report.to_string(), missing };
    tell("makes tests and executes them on the C")?;
    let coverage = cover(agent, own_tests)?;
    tell("proves the properties")?;
    let Proved { properties, run_time_errors, invariant, candidates, mut files, c: proved_c, dead } =
        proved(agent, obligations, cbmc, limits, known)?;
    check_not_contradicted(&properties, &coverage.tests)?;
    tell("compares the C with the agent's text")?;
    let validation = validation(agent, cbmc, limits)?;
    // Proofs that were ended are no result.
    cbmc.check_stop()?;

    let c = &translation.files[0];
    let rows = trace_rows(configuration, text)?;
    let plans = plans(&rows, &coverage);
    let name = |folder: &str, file: &str| format!("{folder}/{file}");
    let tests: Vec<TestEvidence> = (1..)
        .zip(&coverage.tests)
        .map(|(number, test)| TestEvidence {
            file: match &test.own {
                Some(own) => name(OWN_TESTS, own),
                None => name(TESTS, &format!("test_{number:03}.transcript")),
            },
            plans: test.plans.clone(),
            difference: test.difference.clone(),
        })
        .collect();
    let configuration_file = agent.path.file_name().unwrap_or_default().to_string_lossy();
    let evidence = Evidence {
        agent: name(AGENT, configuration.input()),
        configuration: name(AGENT, &configuration_file),
        c: name(C, &c.name),
        requirements: requirements(&plans, &properties),
        properties,
        run_time_errors,
        invariant,
        candidates,
        validation,
        deviations,
        bounds,
        reach: reach(&c.text, &coverage.counts, &proved_c, &dead),
        not_measured: coverage.independence.mixed,
        plans,
        tests,
        tools,
        assumptions: assumptions(),
    };
    files.extend(own_files(agent, &evidence));
    // Whoever translates the agent again gets the same files.
    let generated = known_again(translation.files).into_iter();
    files.extend(generated.map(|GeneratedFile { name: file, text, .. }| (name(C, &file), text)));
    let transcripts = evidence.tests.iter().zip(coverage.tests);
    files.extend(transcripts.map(|(test, made)| (test.file.clone(), made.transcript)));
    files.push((name(TESTS, &coverage.program.name), coverage.program.text));
    Ok(Certified { evidence, files })
}

/// A test that was executed knows better than a proof.
fn check_not_contradicted(
    properties: &[PropertyEvidence],
    tests: &[Test],
) -> Result<(), CertifyError> {
    /// Lines of a test that are shown.
    const SHOWN: usize = 12;
    let shown = properties.iter().filter(|property| property.verdict == Verdict::Proved);
    for property in shown {
        if let Some(test) = tests.iter().find(|test| test.broken.contains(&property.name)) {
            let lines: Vec<&str> = test.transcript.lines().take(SHOWN).collect();
            return Err(CertifyError::Contradicted {
                property: property.name.clone(),
                test: lines.join("\n"),
            });
        }
    }
    Ok(())
}

/// The texts that the agent was read from.
fn own_files(agent: &Agent, evidence: &Evidence) -> [(String, String); 2] {
    [
        (evidence.agent.clone(), agent.text.clone()),
        (evidence.configuration.clone(), agent.written.clone()),
    ]
}

struct Proved {
    properties: Vec<PropertyEvidence>,
    run_time_errors: Vec<PropertyEvidence>,
    invariant: Vec<String>,
    candidates: usize,
    /// The counterexamples.
    files: Vec<(String, String)>,
    /// The C that was proved, and its branches that nothing takes.
    c: String,
    dead: DeadBranches,
}

fn proved(
    agent: &Agent,
    obligations: Obligations,
    cbmc: &Cbmc,
    limits: Limits,
    known: &[String],
) -> Result<Proved, CertifyError> {
    let Agent { configuration, text, .. } = agent;
    let folder = temporary_folder()?;
    let proof = prove_beginning_with(known, &obligations, cbmc, folder.path())?;
    let dead = dead_branches(&obligations, cbmc, folder.path())?;
    let alarms = alarms(folder.path())?;
    let mut found = Vec::new();
    if !proof.holds() {
        let session = Session::new(configuration, text)?;
        let Limits { time, transitions } = limits;
        let limits = SearchLimits { transitions, time };
        found = search(&proof, configuration, &session, cbmc, folder.path(), limits)?;
    }
    let mut files = Vec::new();
    let properties = proof.properties.iter().map(|(property, holds)| {
        let searched = found.iter().find(|searched| {
            !holds && searched.property.as_deref() == Some(property.name.as_str())
        });
        PropertyEvidence {
            name: property.name.clone(),
            requirements: property.requirements.clone(),
            formula: property.formula.clone(),
            verdict: if *holds {
                Verdict::Proved
            } else {
                verdict(searched, &property.name, &mut files)
            },
        }
    });
    let properties = properties.collect();
    let errors = found.iter().filter(|searched| searched.property.is_none());
    let run_time_errors = (1..).zip(errors).map(|(number, searched)| PropertyEvidence {
        name: searched.said.clone(),
        requirements: Vec::new(),
        formula: String::new(),
        verdict: verdict(Some(searched), &format!("run_time_{number}"), &mut files),
    });
    let alarms = alarms.into_iter().map(|alarm| PropertyEvidence {
        name: format!("Frama-C does not exclude: {alarm}"),
        requirements: Vec::new(),
        formula: String::new(),
        verdict: Verdict::Undecided,
    });
    let run_time_errors = run_time_errors.chain(alarms).collect();
    let c = obligations.files.into_iter().next().unwrap_or_default().text;
    let Proof { invariant, candidates, .. } = proof;
    Ok(Proved { properties, run_time_errors, invariant, candidates, files, c, dead })
}

/// The verdict of something unproved; its counterexample becomes a file.
fn verdict(searched: Option<&Searched>, name: &str, files: &mut Vec<(String, String)>) -> Verdict {
    let Some(searched) = searched else { return Verdict::Undecided };
    let (Found::Way(_, story), Some(text)) = (&searched.found, searched.script()) else {
        return Verdict::Undecided;
    };
    let script = format!("{COUNTEREXAMPLES}/{name}.script");
    files.push((script.clone(), text));
    Verdict::Fails { story: story.iter().map(ToString::to_string).collect(), script }
}

fn validation(
    agent: &Agent,
    cbmc: &Cbmc,
    limits: Limits,
) -> Result<ValidationEvidence, CertifyError> {
    let mut comparison = comparison(&agent.configuration, &agent.text)?;
    let own = agent.own_headers(&comparison.files)?;
    let headers = own.iter().map(|header| header.text.as_str());
    match judge(&comparison, &comparison.files[0].text, headers) {
        Ok(judged) => judged.put_into(&mut comparison),
        Err(refused) => {
            let open = vec![refused.to_string()];
            let status = Status::Undecided;
            return Ok(ValidationEvidence { status, proofs: 0, calls: 0, timeouts: 0, open });
        }
    }
    comparison.files.extend(own);
    let folder = temporary_folder()?;
    let validated = validate(&comparison, cbmc, folder.path(), limits.time)?;
    let status = if validated.is_proved() {
        Status::Shown
    } else if validated.differs() {
        Status::Refuted
    } else {
        Status::Undecided
    };
    let Validated { proofs, calls, timeouts, open } = validated;
    let open = open.iter().map(ToString::to_string).collect();
    Ok(ValidationEvidence { status, proofs, calls, timeouts, open })
}

/// The plans, each once, with its coverage.
fn plans(rows: &[TraceRow], coverage: &Coverage) -> Vec<PlanEvidence> {
    let mut plans: Vec<PlanEvidence> = Vec::new();
    let mut last = None;
    for row in rows {
        let requirement = Some(row.requirement.clone()).filter(|tag| !tag.is_empty());
        if last == Some(row.plan) {
            if let Some(plan) = plans.last_mut() {
                plan.requirements.extend(requirement);
            }
            continue;
        }
        last = Some(row.plan);
        let part = row.c_lines.0..=row.c_lines.1;
        let inside = |line: &usize| (row.source_lines.0..=row.source_lines.1).contains(line);
        let tests = (1..).zip(&coverage.tests);
        let tests = tests.filter(|(_, test)| test.plans.iter().any(inside));
        plans.push(PlanEvidence {
            lines: row.source_lines,
            trigger: row.trigger.clone(),
            label: row.label.clone(),
            requirements: requirement.into_iter().collect(),
            function: row.function.clone(),
            c_lines: row.c_lines,
            statements: coverage.counts.statements(&part),
            outcomes: coverage.counts.outcomes(&part),
            tests: tests.map(|(number, _)| number).collect(),
        });
    }
    plans.sort_by_key(|plan| plan.lines);
    plans
}

fn requirements(plans: &[PlanEvidence], properties: &[PropertyEvidence]) -> Vec<Requirement> {
    let of_plans = plans.iter().flat_map(|plan| &plan.requirements);
    let of_properties = properties.iter().flat_map(|property| &property.requirements);
    let tags: BTreeSet<&String> = of_plans.chain(of_properties).collect();
    let indices = |has: &dyn Fn(usize) -> bool, count: usize| {
        (0..count).filter(|index| has(*index)).collect::<Vec<usize>>()
    };
    let requirement = |tag: &String| {
        let of_plans = indices(&|index| plans[index].requirements.contains(tag), plans.len());
        let tests: BTreeSet<usize> =
            of_plans.iter().flat_map(|index| plans[*index].tests.iter().copied()).collect();
        Requirement {
            tag: tag.clone(),
            properties: indices(
                &|index| properties[index].requirements.contains(tag),
                properties.len(),
            ),
            plans: of_plans,
            tests: tests.into_iter().collect(),
        }
    };
    tags.into_iter().map(requirement).collect()
}

fn temporary_folder() -> Result<tempfile::TempDir, CertifyError> {
    tempfile::tempdir()
        .map_err(|source| CertifyError::Io { what: "no temporary folder".to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_property_that_a_test_breaks_is_not_shown() {
        let folder = tempfile::tempdir().unwrap();
        let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };
            includes { #include <stdbool.h>
            #include <stdint.h> };
            basics { void go(void); };
            types { tick(void); };
            properties { never_goes: never(go); };\n";
        std::fs::write(folder.path().join("a.conf"), configuration).unwrap();
        std::fs::write(folder.path().join("a.asl"), "!tick.\n+!tick <- go; !!tick.\n").unwrap();
        let agent = Agent::read(&folder.path().join("a.conf")).unwrap();
        let coverage = cover(&agent, &[]).unwrap();
        let judged = |verdict| {
            let property = PropertyEvidence {
                name: "never_goes".to_owned(),
                requirements: Vec::new(),
                formula: String::new(),
                verdict,
            };
            check_not_contradicted(&[property], &coverage.tests)
        };
        let refused = judged(Verdict::Proved).unwrap_err().to_string();
        assert!(refused.contains("`never_goes`") && refused.contains("next_step"), "{refused}");
        assert!(judged(Verdict::Undecided).is_ok());
    }
}
