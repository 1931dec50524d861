//! Exit on a second signal, even if output is blocked: nobody may be reading a full pipe, and writing to it
//! would keep the process alive for ever.

use std::io;
use std::time::Duration;

use autopilot::outcome::Outcome;

use crate::flight::{Controls, EndSignals};

/// Time for pending output after the flight has ended.
const GRACE: Duration = Duration::from_secs(1);
/// Interval at which the end of the flight is checked; the flight orders its landing first.
const LOOK: Duration = Duration::from_millis(20);

/// Makes a second end signal, and any end signal after the flight, exit the process once the flight has ended
/// and pending output has had [`GRACE`].
///
/// # Errors
/// If the thread cannot be started.
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
