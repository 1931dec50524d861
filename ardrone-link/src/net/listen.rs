//! What the drone tells, as it comes.

use std::time::Duration;

use bytes::Bytes;
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::{broadcast, watch};
use tokio::time::{sleep, timeout};

use super::error::{ClientError, WaitError};
use super::limits::TICK;
use super::link::Status;
use crate::session::Event;

/// The client's events, see [`super::Client::events`].
///
/// A reader that is more than 256 events behind misses the oldest; [`Events::missed`] counts them.
#[derive(Debug)]
#[must_use = "events are read with `next`"]
pub struct Events {
    pub(super) receiver: broadcast::Receiver<Event>,
    pub(super) status: watch::Receiver<Status>,
    pub(super) missed: u64,
}

impl Events {
    /// The next event.
    ///
    /// # Errors
    /// [`WaitError::TimedOut`] if there is none within `limit`. [`WaitError::Ended`] once the client has
    /// ended and all its events are read; this takes 30 ms each time, so that a loop that ignores it does
    /// not occupy a processor.
    pub async fn next(&mut self, limit: Duration) -> Result<Event, WaitError> {
        let next = async {
            loop {
                match self.receiver.recv().await {
                    Ok(event) => return Ok(event),
                    Err(RecvError::Lagged(missed)) => self.missed += missed,
                    Err(RecvError::Closed) => return Err(ended(&self.status).await.into()),
                }
            }
        };
        timeout(limit, next).await.unwrap_or(Err(WaitError::TimedOut { limit }))
    }

    /// The next event that is `wanted`; those before it are dropped.
    ///
    /// # Errors
    /// As [`Events::next`]; `limit` is for the whole wait.
    pub async fn wait_for(
        &mut self,
        limit: Duration,
        mut wanted: impl FnMut(&Event) -> bool,
    ) -> Result<Event, WaitError> {
        let search = async {
            loop {
                let event = self.next(limit).await?;
                if wanted(&event) {
                    return Ok(event);
                }
            }
        };
        timeout(limit, search).await.unwrap_or(Err(WaitError::TimedOut { limit }))
    }

    /// Number of events that this reader was too slow for.
    pub fn missed(&self) -> u64 {
        self.missed
    }
}

/// The client's navdata packets, see [`super::Client::packets`].
#[derive(Debug)]
#[must_use = "packets are read with `next`"]
pub struct Packets {
    pub(super) packets: watch::Receiver<Option<Bytes>>,
    pub(super) status: watch::Receiver<Status>,
}

impl Packets {
    /// The newest packet, whole, once there is one that this reader has not had; a slow reader misses those
    /// between. [`crate::navdata::Packet`] decodes it.
    ///
    /// # Errors
    /// [`WaitError::TimedOut`] if there is none within `limit`. [`WaitError::Ended`] once the client has
    /// ended; this takes 30 ms each time, as with [`Events::next`].
    pub async fn next(&mut self, limit: Duration) -> Result<Bytes, WaitError> {
        let next = async {
            loop {
                if self.packets.changed().await.is_err() {
                    return Err(ended(&self.status).await.into());
                }
                // Nothing stands there while the drone is lost.
                if let Some(packet) = self.packets.borrow_and_update().clone() {
                    return Ok(packet);
                }
            }
        };
        timeout(limit, next).await.unwrap_or(Err(WaitError::TimedOut { limit }))
    }
}

/// Why the client has ended. It takes a tick: a loop that ignores the answer must not spin.
pub(super) async fn ended(status: &watch::Receiver<Status>) -> ClientError {
    sleep(TICK).await;
    // A task that could not leave a reason did not end by itself.
    status.borrow().ended.clone().unwrap_or(ClientError::Task)
}
