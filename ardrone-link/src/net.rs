//! A client on real sockets: a [`Session`] driven by tokio.
//!
//! ```no_run
//! use ardrone_link::DroneAddress;
//! use ardrone_link::net::Client;
//! use ardrone_link::session::{Event, FlightOrder, Order, SessionConfig};
//! use ardrone_link::settings::Setting;
//!
//! # async fn fly() -> Result<(), Box<dyn std::error::Error>> {
//! let settings = vec![Setting::NavdataDemo(true).config()?];
//! let config = SessionConfig { settings, ..SessionConfig::default() };
//! let mut drone = Client::start(&DroneAddress::default(), config).await?;
//! while drone.next_event().await != Some(Event::Ready) {}
//! drone.order(Order { flight: FlightOrder::TakeOff, ..Order::default() });
//! while drone.next_event().await != Some(Event::Airborne) {}
//! drone.order(Order::default());
//! while drone.next_event().await != Some(Event::Landed) {}
//! # Ok(())
//! # }
//! ```

use std::io;
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

use bytes::Bytes;
use tokio::io::AsyncReadExt as _;
use tokio::net::{TcpStream, UdpSocket, lookup_host};
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;
use tokio::time::{Instant, Interval, MissedTickBehavior, interval, sleep, timeout};

use crate::at::{Datagram, EncodeError};
use crate::health::SocketHealth;
use crate::navdata::Navdata;
use crate::session::{Event, Order, Received, Session, SessionConfig};
use crate::{DroneAddress, WAKE_UP};

/// The period of AT commands that Parrot recommends.
const TICK: Duration = Duration::from_millis(30);
/// Landing orders that are sent when the client ends: a datagram may be lost.
const PARTING_ORDERS: u32 = 10;
/// If the system refuses them, it goes on for so many ticks.
const PARTING_TICKS: u32 = 3 * PARTING_ORDERS;
/// Longer than any navdata packet.
const BUFFER_BYTES: usize = 4096;
/// Events that wait for a reader; more are dropped.
const MAX_EVENTS: usize = 256;
/// Blocks of the configuration that wait to be taken in.
const MAX_CONTROL_BLOCKS: usize = 16;
/// Time between two attempts to reach the control port.
const CONTROL_RETRY: Duration = Duration::from_millis(500);

/// Why a client has ended.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// See [`Session::tick`].
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// The client's task panicked.
    #[error("the client's task has died; its last datagrams ordered the landing")]
    Task,
}

/// What else is asked of the session.
#[derive(Debug, Clone, Copy)]
enum Request {
    FlatTrim,
    EmergencyStop,
    EmergencyReset,
    #[cfg(test)]
    Panic,
}

/// A drone that is talked to every 30 ms by a task of its own. Only datagrams from the drone's
/// address are taken. No error of a socket ends it: it warns, goes on, and binds a socket anew that
/// fails for long. When the client is dropped, or its task panics, the landing is ordered, several
/// times, for as long as the runtime lives: [`Client::close`] waits for that.
#[derive(Debug)]
pub struct Client {
    orders: watch::Sender<Order>,
    requests: mpsc::UnboundedSender<Request>,
    events: mpsc::Receiver<Event>,
    packets: watch::Receiver<Option<Bytes>>,
    task: JoinHandle<Result<(), ClientError>>,
}

impl Client {
    /// Begins to look for the drone. Until something else is ordered the order is to land.
    ///
    /// # Errors
    /// What the system says if the name is unknown or no socket can be had. A drone that is not
    /// there is no error: it may come.
    pub async fn start(address: &DroneAddress, config: SessionConfig) -> io::Result<Self> {
        let host = |port| (address.host.as_str(), port);
        let at = Wire::new("AT commands", first_address(host(address.at_port)).await?).await?;
        let navdata = first_address(host(address.navdata_port)).await?;
        let navdata = Wire::new("navdata", navdata).await?;
        let (control_sender, control) = mpsc::channel(MAX_CONTROL_BLOCKS);
        if config.read_back {
            let address = first_address(host(address.control_port)).await?;
            tokio::spawn(read_control(address, control_sender));
        }
        let (orders, order_receiver) = watch::channel(Order::default());
        let (requests, request_receiver) = mpsc::unbounded_channel();
        let (event_sender, events) = mpsc::channel(MAX_EVENTS);
        let (packet_sender, packets) = watch::channel(None);
        let link = Link {
            session: Session::new(config),
            at,
            navdata,
            control,
            orders: order_receiver,
            requests: request_receiver,
            events: event_sender,
            packets: packet_sender,
            rests: false,
        };
        let task = tokio::spawn(link.run());
        Ok(Self { orders, requests, events, packets, task })
    }

    /// What is sent with every datagram from now on.
    pub fn order(&self, order: Order) {
        self.orders.send_replace(order);
    }

    /// Sends one level reference. The drone must stand level on the ground.
    pub fn request_flat_trim(&self) {
        self.request(Request::FlatTrim);
    }

    /// See [`Session::request_emergency_stop`]: **the drone falls**.
    pub fn request_emergency_stop(&self) {
        self.request(Request::EmergencyStop);
    }

    /// See [`Session::request_emergency_reset`].
    pub fn request_emergency_reset(&self) {
        self.request(Request::EmergencyReset);
    }

    fn request(&self, request: Request) {
        if self.requests.send(request).is_err() {
            tracing::warn!("the client has ended: {request:?} is not sent");
        }
    }

    /// What happened next; nothing if the client has ended, of which [`Client::close`] knows why.
    pub async fn next_event(&mut self) -> Option<Event> {
        self.events.recv().await
    }

    /// The newest packet, whole, once it is another than that of the last call; nothing if the
    /// client has ended. [`crate::navdata::Packet`] reads it.
    pub async fn next_packet(&mut self) -> Option<Bytes> {
        self.packets.changed().await.ok()?;
        self.packets.borrow_and_update().clone()
    }

    /// What every pilot needs of the newest packet.
    pub fn navdata(&self) -> Option<Navdata> {
        let packet = self.packets.borrow();
        packet.as_ref().and_then(|packet| Navdata::decode(packet).ok())
    }

    /// Orders the landing several times and ends.
    ///
    /// # Errors
    /// Why the client had ended before.
    pub async fn close(self) -> Result<(), ClientError> {
        let Self { orders, requests, events, packets, task } = self;
        drop((orders, requests, events, packets));
        task.await.map_err(|_| ClientError::Task)?
    }
}

/// The client's task.
struct Link {
    session: Session,
    at: Wire,
    navdata: Wire,
    control: mpsc::Receiver<Bytes>,
    orders: watch::Receiver<Order>,
    requests: mpsc::UnboundedReceiver<Request>,
    events: mpsc::Sender<Event>,
    packets: watch::Sender<Option<Bytes>>,
    /// Navdata cannot be received until the next tick.
    rests: bool,
}

/// What the task is woken by.
enum Input {
    Tick,
    Request(Request),
    Control(Bytes),
    Navdata(io::Result<usize>),
}

impl Link {
    async fn run(mut self) -> Result<(), ClientError> {
        let start = Instant::now();
        let mut datagram = Datagram::new();
        let mut clock = interval(TICK);
        clock.set_missed_tick_behavior(MissedTickBehavior::Skip);
        let end = self.fly(start, &mut clock, &mut datagram).await;
        // Whatever it was.
        self.part(start, &mut clock, &mut datagram).await;
        end
    }

    /// Goes on until nobody gives orders any more.
    async fn fly(
        &mut self,
        start: Instant,
        clock: &mut Interval,
        datagram: &mut Datagram,
    ) -> Result<(), ClientError> {
        let mut buffer = [0_u8; BUFFER_BYTES];
        while self.orders.has_changed().is_ok() {
            // The tick comes first, however much navdata there are.
            let input = tokio::select! {
                biased;
                _ = clock.tick() => Input::Tick,
                Some(request) = self.requests.recv() => Input::Request(request),
                Some(block) = self.control.recv() => Input::Control(block),
                received = self.navdata.socket.recv(&mut buffer), if !self.rests => {
                    Input::Navdata(received)
                }
            };
            let now = start.elapsed();
            let ticks = matches!(input, Input::Tick);
            // A session that panics has still a landing to order.
            let handled =
                catch_unwind(AssertUnwindSafe(|| self.handle(now, input, &buffer, datagram)));
            handled.map_err(|_| ClientError::Task)??;
            if ticks {
                self.send(now, datagram).await;
            }
            if self.navdata.mend(now).await {
                self.navdata.send(now, &WAKE_UP).await;
            }
        }
        Ok(())
    }

    fn handle(
        &mut self,
        now: Duration,
        input: Input,
        buffer: &[u8],
        datagram: &mut Datagram,
    ) -> Result<(), ClientError> {
        match input {
            Input::Tick => {
                self.rests = false;
                let order = *self.orders.borrow();
                datagram.clear();
                // A first word said unseen would land a drone that is flying already.
                if self.session.silence(now).is_some() {
                    self.session.tick(now, order, datagram)?;
                }
            }
            Input::Request(Request::FlatTrim) => self.session.request_flat_trim(),
            Input::Request(Request::EmergencyStop) => self.session.request_emergency_stop(),
            Input::Request(Request::EmergencyReset) => self.session.request_emergency_reset(),
            #[cfg(test)]
            Input::Request(Request::Panic) => panic!("something is wrong"),
            Input::Control(block) => self.session.handle_control(&block),
            Input::Navdata(received) => match self.navdata.judge(now, received) {
                Some(length) => self.take_in(now, &buffer[..length]),
                None => self.rests = true,
            },
        }
        while let Some(event) = self.session.poll_event() {
            if self.events.try_send(event).is_err() {
                tracing::debug!("an event has no reader");
            }
        }
        Ok(())
    }

    fn take_in(&mut self, now: Duration, packet: &[u8]) {
        match self.session.handle_navdata(now, packet) {
            Received::Navdata(_) => {
                self.packets.send_replace(Some(Bytes::copy_from_slice(packet)));
            }
            Received::Stale => {}
            Received::Damaged(error) => tracing::debug!("{error}"),
        }
    }

    async fn send(&mut self, now: Duration, datagram: &Datagram) {
        if !datagram.as_bytes().is_empty() {
            self.at.send(now, datagram.as_bytes()).await;
        }
        self.at.mend(now).await;
        if self.session.wake_up_due(now) {
            self.navdata.send(now, &WAKE_UP).await;
        }
    }

    /// Nobody gives orders any more.
    async fn part(&mut self, start: Instant, clock: &mut Interval, datagram: &mut Datagram) {
        let mut parted = 0;
        for _ in 0..PARTING_TICKS {
            clock.tick().await;
            let now = start.elapsed();
            let said = self.session.part(now, datagram).is_ok();
            // A drone that was never spoken to is not ours to land.
            if !said || datagram.as_bytes().is_empty() || parted == PARTING_ORDERS {
                return;
            }
            parted += u32::from(self.at.send(now, datagram.as_bytes()).await);
            self.at.mend(now).await;
        }
    }
}

/// A socket that hears only the drone, and whose errors end nothing.
struct Wire {
    name: &'static str,
    drone: SocketAddr,
    socket: UdpSocket,
    health: SocketHealth,
}

impl Wire {
    async fn new(name: &'static str, drone: SocketAddr) -> io::Result<Self> {
        let socket = connected(drone).await?;
        Ok(Self { name, drone, socket, health: SocketHealth::default() })
    }

    /// Sends a datagram; returns whether the system took it.
    async fn send(&mut self, now: Duration, datagram: &[u8]) -> bool {
        let sent = timeout(TICK, self.socket.send(datagram)).await;
        let sent = sent.unwrap_or_else(|_| Err(io::ErrorKind::WouldBlock.into()));
        self.judge(now, sent).is_some()
    }

    /// What came of a call, if it succeeded.
    fn judge(&mut self, now: Duration, result: io::Result<usize>) -> Option<usize> {
        match result {
            Ok(length) => {
                self.health.succeeded();
                Some(length)
            }
            Err(error) => {
                if self.health.failed(now, &error) {
                    tracing::warn!("the system refuses {}: {error}; trying on", self.name);
                }
                None
            }
        }
    }

    /// Binds the socket anew if it needs that; returns whether it did.
    async fn mend(&mut self, now: Duration) -> bool {
        if !self.health.rebind_due(now) {
            return false;
        }
        connected(self.drone).await.map(|socket| self.socket = socket).is_ok()
    }
}

/// Reads the control port for as long as somebody listens, connecting again and again: the drone
/// may come and go.
async fn read_control(address: SocketAddr, out: mpsc::Sender<Bytes>) {
    let mut buffer = [0_u8; BUFFER_BYTES];
    while !out.is_closed() {
        match TcpStream::connect(address).await {
            Ok(mut stream) => {
                while let Ok(length @ 1..) = stream.read(&mut buffer).await {
                    if out.send(Bytes::copy_from_slice(&buffer[..length])).await.is_err() {
                        return;
                    }
                }
            }
            Err(error) => tracing::debug!("no control port yet: {error}"),
        }
        sleep(CONTROL_RETRY).await;
    }
}

async fn first_address(host: (&str, u16)) -> io::Result<SocketAddr> {
    lookup_host(host).await?.next().ok_or_else(|| {
        io::Error::new(io::ErrorKind::NotFound, format!("`{}` has no address", host.0))
    })
}

/// A socket that hears only the drone: the system drops datagrams from anybody else.
async fn connected(drone: SocketAddr) -> io::Result<UdpSocket> {
    let any: SocketAddr = match drone {
        SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
        SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
    };
    let socket = UdpSocket::bind(any).await?;
    socket.connect(drone).await?;
    Ok(socket)
}

#[cfg(test)]
mod tests {
    use bytes::BytesMut;

    use super::*;
    use crate::at::{Command, Motion, Ref, decode};
    use crate::navdata::{DroneState, PacketWriter};

    #[tokio::test]
    async fn a_panic_orders_the_landing() {
        let bind = async || UdpSocket::bind((Ipv4Addr::LOCALHOST, 0)).await.unwrap();
        let (at, navdata) = (bind().await, bind().await);
        let port = |socket: &UdpSocket| socket.local_addr().unwrap().port();
        let address = DroneAddress {
            host: Ipv4Addr::LOCALHOST.to_string(),
            at_port: port(&at),
            navdata_port: port(&navdata),
            ..DroneAddress::default()
        };
        let client = Client::start(&address, SessionConfig::default()).await.unwrap();
        let mut buffer = [0; BUFFER_BYTES];
        let (_, from) = navdata.recv_from(&mut buffer).await.unwrap();
        let mut packet = BytesMut::new();
        PacketWriter::new(&mut packet, DroneState::FLYING, 1, 0).finish();
        navdata.send_to(&packet, from).await.unwrap();
        // It is spoken to.
        at.recv(&mut buffer).await.unwrap();
        client.requests.send(Request::Panic).unwrap();
        let mut landings = 0;
        while let Ok(Ok(length)) = timeout(10 * TICK, at.recv(&mut buffer)).await {
            let said: Vec<Command> =
                decode(&buffer[..length]).map(|command| command.unwrap().1).collect();
            landings += u32::from(said == [Command::Ref(Ref::Land), Command::Pcmd(Motion::Hover)]);
        }
        assert!(landings >= PARTING_ORDERS, "{landings}");
        assert!(matches!(client.close().await, Err(ClientError::Task)));
    }
}
