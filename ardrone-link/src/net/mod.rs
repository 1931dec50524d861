//! A client on real sockets: a [`crate::session::Session`] driven by tokio.
//!
//! ```no_run
//! use std::time::Duration;
//!
//! use ardrone_link::{Client, Setting, Steering};
//!
//! # async fn fly() -> Result<(), Box<dyn std::error::Error>> {
//! let drone = Client::builder().setting(Setting::AltitudeMaxM(2.0)).start().await?;
//! drone.ready().await?;
//! drone.take_off().await?;
//! drone.steer(Steering::forward(0.1), Duration::from_secs(1))?;
//! tokio::time::sleep(Duration::from_secs(2)).await;
//! drone.land().await?;
//! # Ok(())
//! # }
//! ```
//!
//! [`ClientBuilder`] configures a client, [`Client`] flies, [`Events`] and [`Packets`] are its subscriptions;
//! [`VideoStream`] is the live video, which needs no client.
//! Internally, `link` is the task with the sockets (`wire`); its decisions are made in `orders` and
//! `readiness`, which use neither sockets nor clocks.

mod builder;
mod client;
mod error;
mod limits;
mod link;
mod listen;
mod orders;
mod readiness;
mod steering;
mod video;
mod wire;

pub use builder::ClientBuilder;
pub use client::Client;
pub use error::{
    ClientError, ConfigureError, FlightError, ReadyError, Refusal, StartError, WaitError,
};
pub use limits::{CONFIGURE_LIMIT, EMERGENCY_LIMIT};
pub use listen::{Events, Packets};
pub use steering::Steering;
pub use video::{VideoNews, VideoStream};

#[cfg(test)]
mod tests;
