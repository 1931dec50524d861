//! Asks a drone on the ground what we assume of its firmware, and says what differs.
//!
//! [`examine`] is a script over a [`Contact`]: the simulated drone in simulated time, or a real one on sockets. It sends settings,
//! requests and the communication watchdog, **never a take-off and never sticks**, and no command to a drone that flies, or that
//! another program is seen to command. What it has set is set back at the end.

mod contact;
mod firmware;
mod navdata;
mod report;
mod video;

use std::time::Duration;

pub use contact::{Contact, Heard};
pub use report::{Assumption, Check, Outcome, Refusal, Report};

use crate::at::Config;
use crate::configuration::Configuration;
use contact::Examiner;
use report::Findings;

/// How long a drone may take to answer at all.
const FIRST_ANSWER: Duration = Duration::from_secs(3);

/// Examines the drone behind `contact`. `settings` are those that a pilot would make before a flight, in their order; `tell` hears of
/// each check as soon as it is made. It takes about 20 s.
///
/// # Errors
/// [`Refusal::Silent`] and [`Refusal::Commanded`]: nothing was set. [`Refusal::Flies`]: nothing was set in a drone that flew at
/// the beginning; to one that lifts off during the examination nothing is sent any more, so that it keeps what was set.
/// [`Refusal::Stopped`] if the examination was called off: what was set has been set back. [`Refusal::Gone`]: what was set may
/// not have been set back.
pub fn examine(
    contact: &mut impl Contact,
    settings: &[Config],
    tell: &mut dyn FnMut(&Check),
) -> Result<Report, Refusal> {
    let mut drone = Examiner::new(contact);
    drone.find(FIRST_ANSWER)?;
    let mut report = Findings::new(tell);
    let before = ask(&mut drone, settings, &mut report);
    if let Some(before) = &before
        && !drone.flies()
    {
        firmware::set_back(&mut drone, settings, before, &mut report);
    }
    drone.refusal()?;
    firmware::lost_link(&mut drone, &mut report);
    if drone.flies() { Err(Refusal::Flies) } else { Ok(report.report) }
}

/// A question to the drone.
type Question<'q, C> = &'q dyn Fn(&mut Examiner<'_, C>, &mut Findings<'_>);

/// Asks everything for which the drone must hear us, until it is called off. The configuration before anything was set.
fn ask<C: Contact>(
    drone: &mut Examiner<'_, C>,
    settings: &[Config],
    report: &mut Findings<'_>,
) -> Option<Configuration> {
    firmware::acknowledgement(drone, report);
    navdata::demo(drone, report);
    if drone.refusal().is_err() {
        return None;
    }
    let before = firmware::configuration(drone, report);
    let questions: [Question<'_, C>; 6] = [
        &|drone, report| firmware::settings(drone, settings, before.as_ref(), report),
        &|drone, report| navdata::requested(drone, settings, before.as_ref(), report),
        &|drone, report| navdata::full(drone, report),
        &|drone, report| firmware::sequence_numbers(drone, before.as_ref(), report),
        &|drone, report| firmware::watchdog(drone, report),
        &|drone, report| video::pictures(drone, report),
    ];
    for question in questions {
        if drone.refusal().is_err() {
            break;
        }
        question(drone, report);
    }
    before
}
