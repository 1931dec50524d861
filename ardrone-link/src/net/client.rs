//! The client as its users see it.

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

/// A drone that is talked to every 30 ms by a task of its own.
///
/// All methods take `&self`: tasks may share a client, by reference or in an `Arc`. Every wait has a limit
/// and a typed error, and once the client has ended every call answers so within 30 ms.
///
/// Only datagrams from the drone's address are taken. No error of a socket ends the client: it warns, goes
/// on, and binds a socket anew that fails for long.
///
/// **Dropping the client lands the drone**: the landing is ordered ten times, for as long as the runtime
/// lives, and also if the task panics. [`Client::close`] waits for that.
#[derive(Debug)]
#[must_use = "dropping the client lands the drone"]
pub struct Client {
    requests: mpsc::UnboundedSender<Request>,
    steering: watch::Sender<Option<Steered>>,
    status: watch::Receiver<Status>,
    /// Without a sender of its own: the end of the task must end the subscriptions.
    events: broadcast::WeakSender<Event>,
    /// What has happened since the start, for the first subscription.
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

    /// Waits until the drone is heard and all settings are made, acknowledged and, with
    /// [`super::ClientBuilder::read_back`], found in the configuration that it reports.
    ///
    /// # Errors
    /// [`ReadyError`]; after [`super::ClientBuilder::ready_limit`] at the latest.
    pub async fn ready(&self) -> Result<(), ReadyError> {
        let answer = self.ask(Request::Ready);
        self.wait(answer).await
    }

    /// Makes one more setting, or changes one, in flight too; ends when the drone has acknowledged it. It is
    /// made again if the drone is lost or starts again.
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

    /// Takes off; ends when the drone hovers. A drone that hovers already is left as it is, and tasks that
    /// call this at the same time wait for the same take-off.
    ///
    /// If this future is dropped while nobody else waits for the take-off, the landing is ordered: a program
    /// that has given up waiting does not know that its drone flies.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::ClientBuilder::take_off_limit`] at the latest. Unless the order was refused
    /// at once, the landing is ordered then.
    pub async fn take_off(&self) -> Result<(), FlightError> {
        let answer = self.ask(Request::TakeOff);
        self.wait(answer).await
    }

    /// Lands; the future ends when the drone stands. The landing is ordered at once, even if the future is
    /// dropped, and never taken back: a take-off that is under way fails, and another is refused until the
    /// drone stands.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::ClientBuilder::landing_limit`] at the latest. The landing stays ordered
    /// whatever the error.
    pub fn land(&self) -> impl Future<Output = Result<(), FlightError>> {
        let answer = self.ask(Request::Land);
        self.wait(answer)
    }

    /// Flies so for `duration`, then hovers; a later call takes the place of this one. It returns at once.
    /// The duration is what lets the drone stop if the program hangs: give what a lost order may cost, and
    /// repeat the call.
    ///
    /// # Errors
    /// [`Refusal::NotFlying`] unless a take-off is complete and nothing has ended the flight since;
    /// [`FlightError::Ended`].
    pub fn steer(&self, steering: Steering, duration: Duration) -> Result<(), FlightError> {
        self.set_motion(steering.motion(), duration)
    }

    /// Ends steering: the drone holds its position.
    ///
    /// # Errors
    /// As [`Client::steer`].
    pub fn hover(&self) -> Result<(), FlightError> {
        self.set_motion(Motion::Hover, Duration::ZERO)
    }

    /// Takes the drone's present attitude for level. It must stand on level ground.
    ///
    /// # Errors
    /// [`Refusal::NotStanding`] unless the drone is heard and stands; [`FlightError::Ended`].
    pub fn flat_trim(&self) -> Result<(), FlightError> {
        self.check(|status| status.standing, Refusal::NotStanding)?;
        self.requests.send(Request::FlatTrim).map_err(|_| self.reason().into())
    }

    /// Cuts the motors, wherever the drone is: **it falls**. The future ends when the drone says that it has
    /// done so. The order is given at once, even if the future is dropped.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::EMERGENCY_LIMIT`] at the latest.
    pub fn emergency_stop(&self) -> impl Future<Output = Result<(), FlightError>> {
        let answer = self.ask(Request::EmergencyStop);
        self.wait(answer)
    }

    /// Clears an emergency, so that the drone can fly again; ends when the drone says that it has done so.
    /// Only on the ground, and only when a person has looked at the drone.
    ///
    /// # Errors
    /// [`FlightError`]; after [`super::EMERGENCY_LIMIT`] at the latest.
    pub async fn reset_emergency(&self) -> Result<(), FlightError> {
        let answer = self.ask(Request::EmergencyReset);
        self.wait(answer).await
    }

    /// Subscribes to events. The first subscription begins with what has happened since the start, each
    /// later one with what happens from now on.
    pub fn events(&self) -> Events {
        let first = self.first_events.lock().unwrap_or_else(PoisonError::into_inner).take();
        let receiver = first.unwrap_or_else(|| {
            let subscribed = self.events.upgrade().map(|events| events.subscribe());
            // The task has ended: a subscription that says so.
            subscribed.unwrap_or_else(|| broadcast::channel(1).1)
        });
        Events { receiver, status: self.status.clone(), missed: 0 }
    }

    /// Subscribes to navdata packets, whole, as they come.
    pub fn packets(&self) -> Packets {
        Packets { packets: self.packets.clone(), status: self.status.clone() }
    }

    /// The newest navdata: attitude, altitude, velocity, battery. `None` before the first packet, while the
    /// drone is lost, and once the client has ended.
    pub fn navdata(&self) -> Option<Navdata> {
        let packet = self.packets.borrow();
        packet.as_ref().and_then(|packet| Navdata::decode(packet).ok())
    }

    /// Orders the landing ten times and ends, without waiting for the drone to stand: [`Client::land`] does.
    /// It takes 0.3 s, and at most 2 s if the system refuses to send.
    ///
    /// # Errors
    /// Why the client had ended before.
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

    /// A task that has ended drops the request, and with it the reply that is waited for.
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
