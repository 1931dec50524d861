//! The evidence as data: it becomes JSON and a page.

use serde::Serialize;

use super::misra::Deviation;
use super::reach::Reach;
use crate::coverage::Share;

/// Result of one kind of evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It was shown.
    Shown,
    /// It could not be decided.
    Undecided,
    /// It was refuted.
    Refuted,
}

/// Result of a property.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// It holds in every environment, for any number of steps.
    Proved,
    /// It does not hold.
    Fails {
        /// The counterexample in the agent's terms.
        story: Vec<String>,
        /// Its script for `asl2c run`, a file of the evidence.
        script: String,
    },
    /// Neither a proof nor a counterexample was found.
    Undecided,
}

impl Verdict {
    /// Whether it holds, fails, or neither is known.
    pub fn status(&self) -> Status {
        match self {
            Self::Proved => Status::Shown,
            Self::Fails { .. } => Status::Refuted,
            Self::Undecided => Status::Undecided,
        }
    }
}

/// A property, or the absence of one kind of run-time error.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct PropertyEvidence {
    /// Its name, or the description of the error by the tool that does not exclude it.
    pub name: String,
    /// The requirements that it implements.
    pub requirements: Vec<String>,
    /// Its formula; empty for run-time errors.
    pub formula: String,
    /// The result.
    pub verdict: Verdict,
}

/// Whether the C does what the agent's text says.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ValidationEvidence {
    /// The result.
    pub status: Status,
    /// Number of proofs.
    pub proofs: usize,
    /// Largest number of answers of one action in a step that was compared, rounded up to a power of two.
    pub calls: u32,
    /// Proofs that reached their time limit.
    pub timeouts: usize,
    /// What differs or is open, by CBMC's description.
    pub open: Vec<String>,
}

/// A plan and what is known of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct PlanEvidence {
    /// First and last line in the agent's text, counted from 1.
    pub lines: (usize, usize),
    /// Its triggering event.
    pub trigger: String,
    /// Its label; empty if it has none.
    pub label: String,
    /// The requirements that it implements.
    pub requirements: Vec<String>,
    /// Its function in the C.
    pub function: String,
    /// First and last line of the function in the C, counted from 1.
    pub c_lines: (usize, usize),
    /// Executed lines of the function.
    pub statements: Share,
    /// Seen outcomes of its conditions.
    pub outcomes: Share,
    /// The tests in which it is chosen, from one.
    pub tests: Vec<usize>,
}

/// A requirement and what implements and shows it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Requirement {
    /// Its tag.
    pub tag: String,
    /// Indices of its plans in [`Evidence::plans`].
    pub plans: Vec<usize>,
    /// Indices of its properties in [`Evidence::properties`].
    pub properties: Vec<usize>,
    /// The tests in which one of its plans is chosen, from one.
    pub tests: Vec<usize>,
}

/// A test of the C.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct TestEvidence {
    /// Its transcript, a file of the evidence.
    pub file: String,
    /// First lines of the plans that are chosen in it.
    pub plans: Vec<usize>,
    /// The first difference between the C and the reference interpreter, if there is one.
    pub difference: Option<String>,
}

/// Memory and time of the C.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Bounds {
    /// The report, as `asl2c --report` prints it.
    pub report: String,
    /// Figures that are missing, with the reason.
    pub missing: Vec<String>,
}

/// A program that was used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Tool {
    /// Its name.
    pub name: String,
    /// Its version.
    pub version: String,
    /// What has to be believed of it.
    pub trust: String,
}

/// Everything that is known of an agent.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Evidence {
    /// The agent's text, a file of the evidence.
    pub agent: String,
    /// Its configuration.
    pub configuration: String,
    /// The C.
    pub c: String,
    /// The requirements that plans or properties name.
    pub requirements: Vec<Requirement>,
    /// The properties.
    pub properties: Vec<PropertyEvidence>,
    /// Run-time errors that are not excluded; empty if there are none.
    pub run_time_errors: Vec<PropertyEvidence>,
    /// Conditions of the invariant that proves the properties.
    pub invariant: Vec<String>,
    /// Number of conditions among which it was searched.
    pub candidates: usize,
    /// Whether the C does what the agent's text says.
    pub validation: ValidationEvidence,
    /// Deviations from MISRA C:2012.
    pub deviations: Vec<Deviation>,
    /// Memory and time.
    pub bounds: Bounds,
    /// The plans.
    pub plans: Vec<PlanEvidence>,
    /// What the tests reach of the C, and what nothing can reach.
    pub reach: Reach,
    /// Conditions in mixtures of `&&` and `||`, of which the counts do not tell whether they decide independently.
    pub not_measured: usize,
    /// The tests.
    pub tests: Vec<TestEvidence>,
    /// The programs that were used.
    pub tools: Vec<Tool>,
    /// What else has to be believed.
    pub assumptions: Vec<String>,
}

impl Evidence {
    /// The plans that no test chooses.
    pub fn untested_plans(&self) -> Vec<&PlanEvidence> {
        self.plans.iter().filter(|plan| plan.tests.is_empty()).collect()
    }

    /// Result of the proofs of the properties. An agent of which nothing is required is not shown to be right.
    pub fn properties_status(&self) -> Status {
        if self.properties.is_empty() {
            return Status::Undecided;
        }
        worst(self.properties.iter().map(|property| property.verdict.status()))
    }

    /// Result of the proof that there is no run-time error.
    pub fn run_time_status(&self) -> Status {
        worst(self.run_time_errors.iter().map(|error| error.verdict.status()))
    }

    /// Whether there is no deviation from the checked rules.
    pub fn rules_status(&self) -> Status {
        if self.deviations.is_empty() { Status::Shown } else { Status::Refuted }
    }

    /// Whether all tests pass, and reach nothing that is proved to be unreachable. Coverage is not judged.
    pub fn tests_status(&self) -> Status {
        let failed = self.tests.iter().any(|test| test.difference.is_some())
            || !self.reach.contradictions.is_empty();
        if failed { Status::Refuted } else { Status::Shown }
    }

    /// Whether all bounds are known.
    pub fn bounds_status(&self) -> Status {
        if self.bounds.missing.is_empty() { Status::Shown } else { Status::Undecided }
    }

    /// The worst of all.
    pub fn status(&self) -> Status {
        worst([
            self.validation.status,
            self.properties_status(),
            self.run_time_status(),
            self.rules_status(),
            self.tests_status(),
            self.bounds_status(),
        ])
    }
}

fn worst(all: impl IntoIterator<Item = Status>) -> Status {
    all.into_iter().max().unwrap_or(Status::Shown)
}
