//! Why the vehicle is not ready, told before anybody tries to arm it.
//!
//! `QGroundControl` shows a text that begins with `PreArm` as the reason beside "Not Ready" for 35 s, and nothing else:
//! `SYS_STATUS` says only that there is one.

use std::time::Duration;

use super::MavlinkVehicle;

/// Reasons that last no longer than this, as while the drone is configured, are not told.
const LASTING: Duration = Duration::from_secs(2);
/// The same reason is told again so often.
const AGAIN_AFTER: Duration = Duration::from_secs(30);

/// Since when the vehicle is not ready for the present reason, and when that was told.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Prearm {
    since: Option<Duration>,
    told: Option<Duration>,
}

impl Prearm {
    /// Whether a reason that is there now is to be told.
    fn is_due(&mut self, now: Duration) -> bool {
        let since = *self.since.get_or_insert(now);
        let due = now.saturating_sub(since) >= LASTING
            && self.told.is_none_or(|told| now.saturating_sub(told) >= AGAIN_AFTER);
        if due {
            self.told = Some(now);
        }
        due
    }
}

impl MavlinkVehicle {
    pub(super) fn tell_prearm(&mut self, now: Duration) {
        let Some(why) = self.not_ready.filter(|why| !why.is_empty() && !self.is_flying()) else {
            self.prearm = Prearm::default();
            return;
        };
        if self.prearm.is_due(now) {
            self.warn(format_args!("PreArm: {why}"));
        }
    }
}
