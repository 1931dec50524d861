//! The public client.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use bytes::Bytes;
use tokio::sync::{broadcast, mpsc, oneshot, watch};
use tokio::task::JoinHandle;
use tokio::time::Instant;

use super::error::{ClientError, ConfigureError, FlightError, ReadyError, Refusal};
use super::link::{Request, Status, Steered};
use super::listen::{Events, Packets, ended};
use super::steering::Steering;
use crate::at::Motion;
use crate::navdata::Navdata;
use crate::session::Event;
use crate::settings::{Setting, SettingError};

/// A connection to a drone, driven every 30 ms by a task of its own.
///
/// All methods take `&self`: tasks may share a client, by reference or in an `Arc`. Every wait has a timeout
/// and a typed error, and once the client has ended every call returns that error within 30 ms.
///
/// Only datagrams from the drone's address are accepted. Socket errors never end the client: it logs a
/// warning, continues, and reopens a socket that keeps failing.
///
/// **Dropping the client lands the drone**: the landing is ordered ten times, provided that the runtime still
/// runs, even if the task panics. [`Client::close`] waits for these orders.
#[derive(Debug)]
#[must_use = "dropping the client lands the drone"]
pub struct Client {
    requests: mpsc::UnboundedSender<Request>,
    steering: watch::Sender<Option<Steered>>,
    status: watch::Receiver<Status>,
    /// A weak sender, so that the end of the task ends the subscriptions.
    events: broadcast::WeakSender<Event>,
    /// Events since the start, for the first subscription.
    first_events: Mutex<Option<broadcast::Receiver<Event>>>,
    packets: watch::Receiver<Option<Bytes>>,
    task: JoinHandle<Result<(), ClientError>>,
}

impl Client {
    pub(super) fn new(
        requests: mpsc::UnboundedSender<Request>,
        steering: watch::Sender<Option<Steered>>,
        status: watch::Receiver<Status>,
        (events, first_events): (broadcast::WeakSender<Event>, broadcast::Receiver<Event>),
        packets: watch::Receiver<Option<Bytes>>,
        task: JoinHandle<Result<(), ClientError>>,
    ) -> Self {
        let first_events = Mutex::new(Some(first_events));
        Self { requests, steering, status, events, first_events, packets, task }
    }

    /// Waits until the drone is connected and all settings are applied, acknowledged and, with
    /// [`super::ClientBuilder::read_back`], found in the configuration that it reports.
    ///
    /// # Errors
    /// [`ReadyError`]; after [`super::ClientBuilder::ready_limit`] at the latest.
    pub async fn ready(&self) -> Result<(), ReadyError> {
        let answer = self.ask(Request::Ready);
        self.wait(answer).await
    }

    /// Adds or changes a setting, also in flight; completes when the drone has acknowledged it. The setting
    /// is applied again if the drone is lost or restarts.
    ///
    /// # Errors
    /// [`ConfigureError`]; after [`super::CONFIGURE_LIMIT`] at the latest.
    pub async fn configure(&self, setting: &Setting) -> Result<(), ConfigureError> {
        if setting.is_navdata_mode() {
            return Err(SettingError::Navdata { key: setting.key() }.into());
        }
        let config = setting.config()?;
        let answer = self.ask(|reply| Request::Configure(config, reply));
        self.wait(answer).await
    }

    /// Takes off; completes when the drone hovers. A drone that already hovers is not affected, and tasks
    /// that call this at the same time wait for the same take-off.
    ///
    /// If this future is dropped and no other task waits for the take-off, the landing is ordered: a program
    /// that has stopped waiting does not know that its drone flies.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::ClientBuilder::take_off_limit`] at the latest. Unless the order was
    /// refused at once, the landing is ordered then.
    pub async fn take_off(&self) -> Result<(), FlightError> {
        let answer = self.ask(Request::TakeOff);
        self.wait(answer).await
    }

    /// Lands; the future completes when the drone is on the ground. The landing is ordered at once, even if
    /// the future is dropped, and never taken back: a take-off in progress fails, and another one is refused
    /// until the drone is on the ground.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::ClientBuilder::landing_limit`] at the latest. The landing stays
    /// ordered whatever the error.
    pub fn land(&self) -> impl Future<Output = Result<(), FlightError>> {
        let answer = self.ask(Request::Land);
        self.wait(answer)
    }

    /// Flies with these stick positions for `duration`, then hovers; a later call replaces this one. Returns
    /// at once. The duration stops the drone if the program hangs: choose it as short as the distance flown
    /// by mistake must be, and repeat the call.
    ///
    /// # Errors
    /// [`Refusal::NotFlying`] unless a take-off has completed and nothing has ended the flight since;
    /// [`FlightError::Ended`].
    pub fn steer(&self, steering: Steering, duration: Duration) -> Result<(), FlightError> {
        self.set_motion(steering.motion(), duration)
    }

    /// Stops steering: the drone holds its position.
    ///
    /// # Errors
    /// As [`Client::steer`].
    pub fn hover(&self) -> Result<(), FlightError> {
        self.set_motion(Motion::Hover, Duration::ZERO)
    }

    /// Sets the drone's current attitude as level. It must stand on level ground.
    ///
    /// # Errors
    /// [`Refusal::NotStanding`] unless the drone is connected and on the ground; [`FlightError::Ended`].
    pub fn flat_trim(&self) -> Result<(), FlightError> {
        self.check(|status| status.standing, Refusal::NotStanding)?;
        self.requests.send(Request::FlatTrim).map_err(|_| self.reason().into())
    }

    /// Cuts the motors, wherever the drone is: **it falls**. The future completes when the drone reports it.
    /// The order is given at once, even if the future is dropped.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::EMERGENCY_LIMIT`] at the latest.
    pub fn emergency_stop(&self) -> impl Future<Output = Result<(), FlightError>> {
        let answer = self.ask(Request::EmergencyStop);
        self.wait(answer)
    }

    /// Clears an emergency, so that the drone can fly again; completes when the drone reports it. Use it only
    /// on the ground, after a person has inspected the drone.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::EMERGENCY_LIMIT`] at the latest.
    pub async fn reset_emergency(&self) -> Result<(), FlightError> {
        let answer = self.ask(Request::EmergencyReset);
        self.wait(answer).await
    }

    /// Subscribes to events. The first subscription starts with the events since the start, each later one
    /// with those that follow.
    pub fn events(&self) -> Events {
        let first = self.first_events.lock().unwrap_or_else(PoisonError::into_inner).take();
        let receiver = first.unwrap_or_else(|| {
            let subscribed = self.events.upgrade().map(|events| events.subscribe());
            // The task has ended: a subscription that reports it.
            subscribed.unwrap_or_else(|| broadcast::channel(1).1)
        });
        Events { receiver, status: self.status.clone(), missed: 0 }
    }

    /// Subscribes to whole navdata packets.
    pub fn packets(&self) -> Packets {
        Packets { packets: self.packets.clone(), status: self.status.clone() }
    }

    /// The newest navdata: attitude, altitude, velocity, battery. `None` before the first packet, while the
    /// drone is lost, and once the client has ended.
    pub fn navdata(&self) -> Option<Navdata> {
        let packet = self.packets.borrow();
        packet.as_ref().and_then(|packet| Navdata::decode(packet).ok())
    }

    /// Orders the landing ten times and ends, without waiting for the drone to land; [`Client::land`] does.
    /// It takes 0.3 s, and at most 2 s if the system refuses to send.
    ///
    /// # Errors
    /// [`ClientError`] if the client had ended before.
    pub async fn close(self) -> Result<(), ClientError> {
        let Self { requests, task, .. } = self;
        drop(requests);
        task.await.map_err(|_| ClientError::Task)?
    }

    #[cfg(test)]
    pub(super) fn panic(&self) {
        self.requests.send(Request::Panic).unwrap();
    }

    fn set_motion(&self, motion: Motion, duration: Duration) -> Result<(), FlightError> {
        self.check(|status| status.airborne, Refusal::NotFlying)?;
        self.steering.send_replace(Some(Steered { at: Instant::now(), duration, motion }));
        Ok(())
    }

    fn check(&self, allows: fn(&Status) -> bool, refusal: Refusal) -> Result<(), FlightError> {
        if self.requests.is_closed() {
            return Err(self.reason().into());
        }
        if allows(&self.status.borrow()) { Ok(()) } else { Err(refusal.into()) }
    }

    fn reason(&self) -> ClientError {
        self.status.borrow().ended.clone().unwrap_or(ClientError::Task)
    }

    /// Sends a request and waits for the reply. A task that has ended drops the request and with it the
    /// reply's sender.
    fn ask<E>(
        &self,
        request: impl FnOnce(oneshot::Sender<Result<(), E>>) -> Request,
    ) -> oneshot::Receiver<Result<(), E>> {
        let (reply, answer) = oneshot::channel();
        _ = self.requests.send(request(reply));
        answer
    }

    async fn wait<E: From<ClientError>>(
        &self,
        answer: oneshot::Receiver<Result<(), E>>,
    ) -> Result<(), E> {
        match answer.await {
            Ok(result) => result,
            Err(_) => Err(ended(&self.status).await.into()),
        }
    }
}
