//! Errors, one type for each kind of call.

use std::io;
use std::time::Duration;

use crate::settings::SettingError;

/// Why a client could not be started.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StartError {
    /// A setting is out of range, cannot be sent, or is not allowed in the list of settings.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The host name cannot be resolved.
    #[error("the name `{host}` has no address: check the spelling, or give the address itself")]
    Resolve {
        /// The host name.
        host: String,
        /// The system's error; a timeout if there was no answer within 10 s.
        source: io::Error,
    },
    /// A socket could not be opened.
    #[error("cannot open a UDP socket for {purpose}")]
    Socket {
        /// Purpose of the socket.
        purpose: &'static str,
        /// The system's error.
        source: io::Error,
    },
}

/// Why a client has ended. Its last datagrams ordered the landing, unless the runtime ended first, or the drone was never sent
/// anything.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ClientError {
    /// The client's task panicked, or its runtime has ended.
    #[error(
        "the client's task has died; it has ordered the landing, unless the runtime ended first"
    )]
    Task,
    /// The client was closed or dropped.
    #[error("the client is closed")]
    Closed,
}

/// Why a drone is not ready to fly.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReadyError {
    /// No navdata arrived, or none any more.
    #[error("no navdata from the drone within {limit:?}: is this computer in the drone's network?")]
    NotHeard {
        /// See [`super::ClientBuilder::ready_limit`].
        limit: Duration,
    },
    /// Navdata arrive, but the settings are not complete.
    #[error("the drone is not configured within {limit:?}")]
    NotConfigured {
        /// See [`super::ClientBuilder::ready_limit`].
        limit: Duration,
    },
    /// The drone never acknowledged these keys: it may fly with other limits than requested.
    #[error("the drone did not acknowledge {}", keys.join(", "))]
    NotAcknowledged {
        /// Each as `section:name`.
        keys: Vec<String>,
    },
    /// The configuration could not be read back.
    #[error("the drone's configuration could not be read back: is its TCP port 5559 reachable?")]
    NotReadBack,
    /// The drone reports other values for these keys.
    #[error("the drone has not applied the values of {}", keys.join(", "))]
    NotTaken {
        /// Each as `section:name`.
        keys: Vec<String>,
    },
    /// The client has ended.
    #[error(transparent)]
    Ended(#[from] ClientError),
}

/// Why a setting was not applied.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigureError {
    /// The value is out of range, or belongs to the navdata mode. Nothing was sent.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The drone is not connected or not configured. Nothing was sent.
    #[error("the drone is not ready: wait for `ready()`")]
    NotReady,
    /// The drone did not acknowledge it within 2 s of its first datagram, or [`super::CONFIGURE_LIMIT`] of the call.
    #[error("the drone did not acknowledge {key}")]
    NotAcknowledged {
        /// As `section:name`.
        key: String,
    },
    /// The client has ended.
    #[error(transparent)]
    Ended(#[from] ClientError),
}

/// Why an order to the drone was not carried out.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FlightError {
    /// Refused at once; nothing was sent.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The drone does not hover within the limit. The landing is ordered.
    #[error("the drone does not hover {limit:?} after the take-off order (battery: {})", percent(*.battery_percent))]
    TakeOffTimedOut {
        /// See [`super::ClientBuilder::take_off_limit`].
        limit: Duration,
        /// Remaining charge, if known. Drones refuse to take off below about 20 %.
        battery_percent: Option<u32>,
    },
    /// The drone is not on the ground within the limit. The landing stays ordered.
    #[error("the drone does not stand {limit:?} after the landing order, which stays in force")]
    LandingTimedOut {
        /// See [`super::ClientBuilder::landing_limit`].
        limit: Duration,
    },
    /// The drone's emergency bit did not change within the limit.
    #[error("the drone has not answered the emergency order within {limit:?}")]
    EmergencyTimedOut {
        /// Always [`super::EMERGENCY_LIMIT`].
        limit: Duration,
    },
    /// The drone has cut its motors.
    #[error("emergency: the drone has cut its motors")]
    Emergency,
    /// The drone is silent, or waits to be configured again. The landing is ordered, and the drone lands by
    /// itself after some seconds of silence.
    #[error("the link to the drone is lost; the landing is ordered")]
    LinkLost,
    /// The drone has restarted. Take-off must be ordered again.
    #[error("the drone has started again")]
    DroneRestarted,
    /// A landing was ordered, or the drone landed by itself, before the take-off was complete.
    #[error("the drone lands instead of taking off")]
    Landing,
    /// The client has ended.
    #[error(transparent)]
    Ended(#[from] ClientError),
}

fn percent(battery_percent: Option<u32>) -> String {
    battery_percent.map_or_else(|| "unknown".to_owned(), |percent| format!("{percent} %"))
}

/// Why an order was refused without being sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The drone is not connected or not configured.
    #[error("the drone is not ready: wait for `ready()`")]
    NotReady,
    /// The drone is in its emergency state.
    #[error(
        "the drone is in its emergency state: look at it, then clear it with `reset_emergency()`"
    )]
    Emergency,
    /// The drone reports that its battery is too low to fly.
    #[error("the drone's battery is too low to take off")]
    BatteryLow,
    /// The drone is in the air with the landing ordered: a landing is never taken back.
    #[error("the drone is landing: wait for `land()`")]
    Landing,
    /// The order requires a drone that hovers or flies.
    #[error("the drone is not in flight: wait for `take_off()`")]
    NotFlying,
    /// The order requires a connected drone on the ground.
    #[error("the drone does not stand on the ground: wait for `land()`")]
    NotStanding,
}

/// Why a wait for events or packets failed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WaitError {
    /// Nothing arrived within the caller's limit.
    #[error("nothing came within {limit:?}")]
    TimedOut {
        /// The caller's limit.
        limit: Duration,
    },
    /// The client has ended.
    #[error(transparent)]
    Ended(#[from] ClientError),
}
