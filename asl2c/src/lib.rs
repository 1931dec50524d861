//! The AgentSpeak compiler's command line, and every analysis that runs external programs.
//!
//! The [`translator`] turns texts into texts. This crate reads and writes the files, and runs other programs: [`verify()`]
//! checks properties on a model with SPIN, [`prove()`] on the C with CBMC, [`validate()`] compares the C with a second
//! translation, [`cover()`] tests it, [`measure()`] and [`on_target()`] measure its cost, [`certify()`] does all of it. A
//! [`Session`] runs an agent by the interpreter, and [`command_line`] is the program, with translation itself.
//!
//! ```no_run
//! let agent = asl2c::Agent::read("pilot.conf".as_ref())?;
//! let model = translator::model(&agent.configuration, &agent.text)?;
//! for checked in asl2c::verify(&model, &[])? {
//!     println!("{}: {}", checked.property.name, checked.verdict.is_proved());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

/// The version of all JSON that the program writes for others: the field `version` of each object. It changes if a field
/// goes, or means something else.
pub const JSON_VERSION: u32 = 1;

mod agent;
mod certify;
mod checksum;
pub mod command_line;
mod coverage;
mod current;
mod eva;
mod headers;
mod lsp;
mod measure;
mod new;
mod output;
mod prove;
mod run;
mod spin;
mod target;
mod tool;
mod verify;
mod written;

pub use agent::{Agent, ReadError, read_system};
pub use certify::{
    Bounds, Certified, CertifyError, Deviation, Evidence, Limits, PlanEvidence, PropertyEvidence,
    Reach, Reached, Requirement, Status, TestEvidence, Tool, ValidationEvidence,
    Verdict as PropertyVerdict, certify,
};
pub use coverage::{
    Counts, Coverage, CoverageError, Independence, LineCount, OwnTest, Share, Test, cover,
};
pub use eva::{FRAMA_C, alarms, coarse_alarms};
pub use headers::HeaderError;
pub use measure::measure;
pub use prove::{
    Budget, CBMC, Cbmc, Checks, Difference, End, Open, Part, Plan, Proof, ProveError, Validated,
    Watch, prove, prove_beginning_with, validate, validate_watched, violates,
};
pub use run::{NetworkConditions, Replay, Runs, Session, SystemSession, repeat, replay};
pub use spin::{Counterexample, SPIN, SpinError, Verdict};
pub use target::{Bound, Observed, OnTarget, TargetError, TraceDifference, on_host, on_target};
pub use tool::ToolError;
pub use verify::{Checked, VerifyError, is_refuted, verify};
