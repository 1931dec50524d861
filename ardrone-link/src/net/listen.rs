//! Subscriptions to events and packets.

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
    /// ended and all its events were read; this takes 30 ms each time, so that a loop that ignores the error
    /// does not occupy a processor.
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

    /// The next event for which `wanted` is true; earlier ones are dropped.
    ///
    /// # Errors
    /// As [`Events::next`]; `limit` applies to the whole wait.
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

    /// Number of events lost because this reader was too slow.
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
    /// The newest packet that this reader has not had yet; a slow reader misses those in between. Decode it
    /// with [`crate::navdata::Packet`].
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
                // The value is `None` while the drone is lost.
                if let Some(packet) = self.packets.borrow_and_update().clone() {
                    return Ok(packet);
                }
            }
        };
        timeout(limit, next).await.unwrap_or(Err(WaitError::TimedOut { limit }))
    }
}

/// Why the client has ended. Takes one tick, so that a loop that ignores the error does not spin.
pub(super) async fn ended(status: &watch::Receiver<Status>) -> ClientError {
    sleep(TICK).await;
    // A task that left no reason has panicked or was aborted.
    status.borrow().ended.clone().unwrap_or(ClientError::Task)
}
