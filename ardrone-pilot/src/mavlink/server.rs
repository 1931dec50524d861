//! Speaks MAVLink.

use std::io;
use std::net::SocketAddr;
use std::time::{Duration, Instant};

use autopilot::vehicle::{Operator, OperatorOrder, Refused, Telemetry};
use crossbeam_channel::{Receiver, Sender, bounded};
use mavlink_vehicle::{Config, Input, MavlinkVehicle, Output, Signing, Ticket, To, frames};
use time::UtcDateTime;
use tokio::net::UdpSocket;
use tokio::sync::oneshot;
use tokio::time::MissedTickBehavior;

use super::peers::Peers;
use crate::flight::Controls;
use crate::runtime::{Runtime, Task};

/// Time between the vehicle's ticks.
const TICK: Duration = Duration::from_millis(20);
/// Longest datagram that is read as a whole.
const LONGEST_DATAGRAM: usize = 4096;
/// Most datagrams of peers that are handled in a tick; more wait in the system's buffer.
const HANDLED_PER_TICK: u32 = 64;
/// Most datagrams of others that are looked at.
const STRANGERS_PER_TICK: u32 = 16;
/// Most datagrams that are read at all: a flood from one port is read and dropped, so that it does not displace others.
const READ_PER_TICK: u32 = 512;
/// Answers that may wait: as many orders as wait for a tick, and as many as it is handling. Others are answered at once.
const ANSWERS: usize = 256;
/// Most outputs in a row.
const OUTPUTS: u32 = 1024;

type Answer = (Ticket, Result<(), Refused>);

/// Speaks until this is dropped.
#[derive(Debug)]
pub(super) struct Server(Task<Lost>);

impl Server {
    pub(super) fn start(
        runtime: &Runtime,
        socket: std::net::UdpSocket,
        remotes: &[SocketAddr],
        mut config: Config,
        controls: Controls,
        telemetry: Receiver<Telemetry>,
    ) -> io::Result<Self> {
        let socket = {
            let _inside = runtime.handle().enter();
            UdpSocket::from_std(socket)?
        };
        let unix_time = UtcDateTime::now() - UtcDateTime::UNIX_EPOCH;
        config.unix_time = unix_time.try_into().unwrap_or_default();
        let (answering, answers) = bounded(ANSWERS);
        let exchange = Exchange {
            judge: config.key.clone().map(|key| Signing::new(key, 0, config.unix_time, 0)),
            only_here: remotes.iter().all(|remote| remote.ip().is_loopback()),
            vehicle: MavlinkVehicle::new(config),
            socket,
            peers: Peers::new(remotes),
            controls,
            telemetry,
            answers,
            answering,
            start: Instant::now(),
            intake: Intake::default(),
            lost: Lost::default(),
        };
        Ok(Self(runtime.run("MAVLink", |ended| exchange.run(ended))))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // Told here, because what runs beside the flight must not wait for anybody to read this.
        let Some(Lost { dropped, unsent }) = self.0.end() else { return };
        if dropped > 0 {
            tracing::warn!("MAVLink: too many datagrams came; {dropped} were dropped");
        }
        if unsent > 0 {
            tracing::warn!("MAVLink: the system refused to send {unsent} datagrams");
        }
    }
}

/// Datagrams that were lost here.
#[derive(Debug, Clone, Copy, Default)]
struct Lost {
    /// Not handled, because there were too many.
    dropped: u64,
    /// Not sent.
    unsent: u64,
}

/// What was taken in since the last tick.
#[derive(Debug, Clone, Copy, Default)]
struct Intake {
    read: u32,
    handled: u32,
    strangers: u32,
}

impl Intake {
    fn has_room(&self) -> bool {
        self.read < READ_PER_TICK && self.handled < HANDLED_PER_TICK
    }
}

/// The vehicle between its socket and the flight.
struct Exchange {
    vehicle: MavlinkVehicle,
    socket: UdpSocket,
    peers: Peers,
    /// With a key, only who signs becomes a peer.
    judge: Option<Signing>,
    /// Whether nobody but this machine is to be heard.
    only_here: bool,
    controls: Controls,
    telemetry: Receiver<Telemetry>,
    answers: Receiver<Answer>,
    /// The other end, for those who answer.
    answering: Sender<Answer>,
    start: Instant,
    intake: Intake,
    lost: Lost,
}

impl Exchange {
    async fn run(mut self, mut ended: oneshot::Receiver<()>) -> Lost {
        let mut ticks = tokio::time::interval(TICK);
        ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut buffer = vec![0; LONGEST_DATAGRAM];
        loop {
            tokio::select! {
                // In this order: no flood holds up a tick.
                biased;
                _ = &mut ended => break,
                _ = ticks.tick() => self.tick(),
                received = self.socket.recv_from(&mut buffer), if self.intake.has_room() => {
                    self.intake.read += 1;
                    // An error is that of an earlier datagram, to somebody who does not listen.
                    if let Ok((length, from)) = received {
                        self.receive(from, buffer.get(..length).unwrap_or_default());
                    }
                }
            }
        }
        // The last news.
        self.tick();
        self.lost
    }

    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    fn tick(&mut self) {
        let now = self.now();
        self.intake = Intake::default();
        self.peers.tick();
        while let Some(gone) = self.peers.forget(now) {
            self.vehicle.handle(now, Input::PeerGone(gone));
        }
        for telemetry in self.telemetry.try_iter().take(super::BEHIND) {
            self.vehicle.handle(now, Input::Telemetry(&telemetry));
        }
        self.take_answers(now);
        self.vehicle.tick(now);
        self.put_out(now);
    }

    fn receive(&mut self, from: SocketAddr, bytes: &[u8]) {
        let local = from.ip().is_loopback();
        if self.only_here && !local {
            return;
        }
        let now = self.now();
        let Some(peer) = self.peer(now, from, bytes) else { return };
        self.intake.handled += 1;
        self.vehicle.handle(now, Input::Datagram { peer, local, bytes });
        self.put_out(now);
    }

    /// The number of the peer from which this datagram came, if it is to be handled.
    fn peer(&mut self, now: Duration, from: SocketAddr, bytes: &[u8]) -> Option<u8> {
        if let Some(peer) = self.peers.number(from) {
            if self.peers.hear(now, peer) {
                return Some(peer);
            }
            self.lost.dropped += 1;
            return None;
        }
        if self.intake.strangers >= STRANGERS_PER_TICK {
            self.lost.dropped += 1;
            return None;
        }
        self.intake.strangers += 1;
        let judge = &mut self.judge;
        let is_good = |signature| match (judge.as_mut(), signature) {
            (None, _) => true,
            (Some(judge), Some(signature)) => judge.verify(&signature, now).is_ok(),
            (Some(_), None) => false,
        };
        let speaks = frames(bytes).flatten().map(|frame| frame.signature).any(is_good);
        if !speaks {
            return None;
        }
        if let Some(gone) = self.peers.make_room(now) {
            self.vehicle.handle(now, Input::PeerGone(gone));
        }
        self.peers.learn(now, from)
    }

    /// Sends and orders what the vehicle wants.
    fn put_out(&mut self, now: Duration) {
        for _ in 0..OUTPUTS {
            match self.vehicle.poll(now) {
                Some(Output::Datagram { to: To::All, bytes }) => {
                    for address in self.peers.addresses() {
                        self.lost.unsent += send(&self.socket, bytes, address);
                    }
                }
                Some(Output::Datagram { to: To::Peer(peer), bytes }) => {
                    // One that has been forgotten meanwhile needs no answer.
                    if let Some(address) = self.peers.address(peer) {
                        self.lost.unsent += send(&self.socket, bytes, address);
                    }
                }
                Some(Output::Order { ticket, by, order }) => self.give(now, ticket, by, order),
                None => return,
            }
        }
    }

    fn give(&mut self, now: Duration, ticket: Ticket, by: Operator, order: OperatorOrder) {
        let answering = self.answering.clone();
        let given = self.controls.order_answered(by, order, move |answer| {
            // There is room.
            _ = answering.try_send((ticket, answer));
        });
        if let Err(refused) = given {
            self.vehicle.handle(now, Input::Answer { ticket, answer: Err(refused) });
        }
        // Some orders are answered at once.
        self.take_answers(now);
    }

    fn take_answers(&mut self, now: Duration) {
        for (ticket, answer) in self.answers.try_iter() {
            self.vehicle.handle(now, Input::Answer { ticket, answer });
        }
    }
}

/// Returns 1 if the system does not send it: it is lost as others are on the way.
fn send(socket: &UdpSocket, bytes: &[u8], address: SocketAddr) -> u64 {
    match socket.try_send_to(bytes, address) {
        // Of an earlier one: nobody listens there yet.
        Err(error) if error.kind() != io::ErrorKind::ConnectionRefused => 1,
        _ => 0,
    }
}
