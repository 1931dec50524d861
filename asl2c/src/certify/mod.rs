//! The evidence for an agent: what was proved, checked, measured and tested, with everything needed to do it again.

mod evidence;
mod files;
mod flow;
mod gather;
mod misra;
mod needed;
mod page;
mod reach;
mod trust;

pub use self::evidence::{
    Bounds, Evidence, PlanEvidence, PropertyEvidence, Requirement, Status, TestEvidence, Tool,
    ValidationEvidence, Verdict,
};
pub(crate) use self::files::check_folder;
pub use self::gather::{Certified, CertifyError, Limits, certify};
pub use self::misra::Deviation;
pub(crate) use self::needed::find_tools;
pub use self::reach::{Reach, Reached};
