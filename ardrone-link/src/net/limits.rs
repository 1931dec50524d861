//! Periods, sizes, and how long is waited.

use std::time::Duration;

/// How long [`super::Client::emergency_stop`] and [`super::Client::reset_emergency`] wait for the drone's
/// answer. The order itself is given up after 5 s.
pub const EMERGENCY_LIMIT: Duration = Duration::from_secs(6);

/// How long [`super::Client::configure`] waits for the drone to acknowledge a setting.
pub const CONFIGURE_LIMIT: Duration = Duration::from_secs(10);

/// The period of AT commands that Parrot recommends.
pub(super) const TICK: Duration = Duration::from_millis(30);
/// Longer than any navdata packet.
pub(super) const BUFFER_BYTES: usize = 4096;
/// Events that wait for a slow reader.
pub(super) const MAX_EVENTS: usize = 256;

/// How long an order may take until its caller is told that it has failed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) ready: Duration,
    pub(super) take_off: Duration,
    pub(super) landing: Duration,
}
