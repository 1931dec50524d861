//! Periods, sizes and timeouts.

use std::time::Duration;

/// Timeout of [`super::Client::emergency_stop`] and [`super::Client::reset_emergency`]. The order itself is
/// given up after 5 s.
pub const EMERGENCY_LIMIT: Duration = Duration::from_secs(6);

/// Timeout of [`super::Client::configure`].
pub const CONFIGURE_LIMIT: Duration = Duration::from_secs(10);

/// Period of AT commands recommended by Parrot.
pub(super) const TICK: Duration = Duration::from_millis(30);
/// Receive buffer; no navdata packet is longer.
pub(super) const BUFFER_BYTES: usize = 4096;
/// Capacity of an event subscription.
pub(super) const MAX_EVENTS: usize = 256;

/// Timeouts of orders.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) ready: Duration,
    pub(super) take_off: Duration,
    pub(super) landing: Duration,
}
