//! Asks a drone on the ground what we assume of its firmware, and says what differs.
//!
//! [`examine`] is a script over a [`Contact`]: the simulated drone in simulated time, or a real one on sockets. It sends settings,
//! requests and the communication watchdog, **never a take-off and never sticks**, and nothing at all to a drone that flies or that
//! another program commands. What it has set is set back at the end.

mod contact;
mod firmware;
mod navdata;
mod report;
mod video;

use std::time::Duration;

pub use contact::{Contact, Heard};
pub use report::{Assumption, Check, Outcome, Refusal, Report};

use crate::at::Config;
use contact::Examiner;
use report::Findings;

/// How long a drone may take to answer at all.
const FIRST_ANSWER: Duration = Duration::from_secs(3);
/// How long a drone is only listened to, before anything is sent to it.
const LISTENING: Duration = Duration::from_millis(500);

/// Examines the drone behind `contact`. `settings` are those that a pilot would make before a flight, in their order; `tell` hears of
/// each check as soon as it is made. It takes about 25 s.
///
/// # Errors
/// [`Refusal`] if the drone is silent, flies, or obeys somebody else: then nothing was set.
pub fn examine(
    contact: &mut impl Contact,
    settings: &[Config],
    tell: &mut dyn FnMut(&Check),
) -> Result<Report, Refusal> {
    let mut drone = Examiner::new(contact);
    drone.find(FIRST_ANSWER, LISTENING)?;
    let mut report = Findings::new(tell);
    firmware::acknowledgement(&mut drone, &mut report);
    navdata::demo(&mut drone, &mut report);
    let before = firmware::configuration(&mut drone, &mut report);
    firmware::settings(&mut drone, settings, before.as_ref(), &mut report);
    navdata::requested(&mut drone, settings, &mut report);
    navdata::full(&mut drone, &mut report);
    firmware::sequence_numbers(&mut drone, &mut report);
    firmware::watchdog(&mut drone, &mut report);
    video::pictures(&mut drone, &mut report);
    if let Some(before) = &before {
        firmware::set_back(&mut drone, before);
    }
    firmware::lost_link(&mut drone, &mut report);
    Ok(report.report)
}
