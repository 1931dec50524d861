//! Whoever asked for the end twice does not wait for those who do not read what is said: a pipe that is
//! full would keep the process for ever.

use std::io;
use std::time::Duration;

use autopilot::outcome::Outcome;

use crate::flight::{Controls, EndSignals};

/// What is left to be said and written may take so long.
const GRACE: Duration = Duration::from_secs(1);
/// How often is looked whether the flight, which orders its landing, is over.
const LOOK: Duration = Duration::from_millis(20);

/// From now on a second signal that asks for the end, and any one after the flight, ends the process, as
/// soon as the flight is over and has had its grace.
///
/// # Errors
/// If no thread can be had.
#[expect(clippy::exit, reason = "what is blocked cannot be asked to end")]
pub(super) fn on_second_signal(controls: Controls) -> io::Result<()> {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let watch = async move {
        let mut signals = EndSignals::new();
        signals.next().await;
        if !controls.is_over() {
            signals.next().await;
        }
        while !controls.is_over() {
            tokio::time::sleep(LOOK).await;
        }
        tokio::time::sleep(GRACE).await;
        std::process::exit(Outcome::LeftLanding.exit_status().into());
    };
    std::thread::Builder::new()
        .name("leave".to_owned())
        .spawn(move || runtime.block_on(watch))
        .map(drop)
}
