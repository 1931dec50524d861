//! A request to end, by a signal.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::TERM_SIGNALS;

use crate::prove::ProveError;

/// A flag that an interrupt (Ctrl-C) or a request to end sets from now on. Neither ends the program any more, which has
/// to end the provers and to remove its files.
pub(super) fn flag() -> Result<Arc<AtomicBool>, ProveError> {
    let stopped = Arc::new(AtomicBool::new(false));
    for signal in TERM_SIGNALS {
        signal_hook::flag::register(*signal, Arc::clone(&stopped)).map_err(|source| {
            ProveError::Io { what: "cannot wait for a request to end".to_owned(), source }
        })?;
    }
    Ok(stopped)
}
