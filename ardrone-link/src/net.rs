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
use std::time::Duration;

use bytes::Bytes;
use tokio::io::AsyncReadExt as _;
use tokio::net::{TcpStream, UdpSocket, lookup_host};
use tokio::sync::{mpsc, watch};
use tokio::task::JoinHandle;
use tokio::time::{Instant, MissedTickBehavior, interval, sleep};

use crate::at::{Datagram, EncodeError};
use crate::navdata::Navdata;
use crate::session::{Event, Order, Received, Session, SessionConfig};
use crate::{DroneAddress, WAKE_UP, is_passing};

/// The period of AT commands that Parrot recommends.
const TICK: Duration = Duration::from_millis(30);
/// Landing orders that are sent when the client is dropped: a datagram may be lost.
const PARTING_ORDERS: u32 = 10;
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
    /// A socket failed for good.
    #[error("the link to the drone failed: {0}")]
    Socket(#[from] io::Error),
    /// See [`Session::tick`].
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// The client's task panicked.
    #[error("the client's task has died")]
    Task,
}

/// What else is asked of the session.
#[derive(Debug, Clone, Copy)]
enum Request {
    FlatTrim,
    EmergencyStop,
    EmergencyReset,
}

/// A drone that is talked to every 30 ms by a task of its own. Only datagrams from the drone's
/// address are taken. When the client is dropped its task orders the landing, several times, for as
/// long as the runtime lives: [`Client::close`] waits for that.
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
        let at = connected(host(address.at_port)).await?;
        let navdata = connected(host(address.navdata_port)).await?;
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
    at: UdpSocket,
    navdata: UdpSocket,
    control: mpsc::Receiver<Bytes>,
    orders: watch::Receiver<Order>,
    requests: mpsc::UnboundedReceiver<Request>,
    events: mpsc::Sender<Event>,
    packets: watch::Sender<Option<Bytes>>,
}

impl Link {
    async fn run(mut self) -> Result<(), ClientError> {
        let start = Instant::now();
        let mut datagram = Datagram::new();
        let mut navdata_buffer = [0_u8; BUFFER_BYTES];
        let mut clock = interval(TICK);
        clock.set_missed_tick_behavior(MissedTickBehavior::Skip);
        loop {
            tokio::select! {
                received = self.navdata.recv(&mut navdata_buffer) => {
                    if let Some(length) = tolerate(received)? {
                        self.take_in(start.elapsed(), &navdata_buffer[..length]);
                    }
                }
                Some(block) = self.control.recv() => self.session.handle_control(&block),
                Some(request) = self.requests.recv() => match request {
                    Request::FlatTrim => self.session.request_flat_trim(),
                    Request::EmergencyStop => self.session.request_emergency_stop(),
                    Request::EmergencyReset => self.session.request_emergency_reset(),
                },
                _ = clock.tick() => {
                    let now = start.elapsed();
                    let order = *self.orders.borrow();
                    self.send(now, order, &mut datagram).await?;
                    if self.orders.has_changed().is_err() {
                        return self.part(start, &mut datagram).await;
                    }
                }
            }
            while let Some(event) = self.session.poll_event() {
                if self.events.try_send(event).is_err() {
                    tracing::debug!("an event has no reader");
                }
            }
        }
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

    async fn send(
        &mut self,
        now: Duration,
        order: Order,
        datagram: &mut Datagram,
    ) -> Result<(), ClientError> {
        self.session.tick(now, order, datagram)?;
        // A first word said unseen would land a drone that is flying already.
        if self.session.silence(now).is_some() {
            tolerate(self.at.send(datagram.as_bytes()).await)?;
        }
        if self.session.wake_up_due(now) {
            tolerate(self.navdata.send(&WAKE_UP).await)?;
        }
        Ok(())
    }

    /// Nobody gives orders any more.
    async fn part(mut self, start: Instant, datagram: &mut Datagram) -> Result<(), ClientError> {
        for _ in 0..PARTING_ORDERS {
            self.send(start.elapsed(), Order::default(), datagram).await?;
            sleep(TICK).await;
        }
        Ok(())
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
async fn connected(host: (&str, u16)) -> io::Result<UdpSocket> {
    let address = first_address(host).await?;
    let any: SocketAddr = match address {
        SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
        SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
    };
    let socket = UdpSocket::bind(any).await?;
    socket.connect(address).await?;
    Ok(socket)
}

/// A drone that is not there yet, or gone for a moment, is no reason to end.
fn tolerate(result: io::Result<usize>) -> io::Result<Option<usize>> {
    match result {
        Err(error) if is_passing(&error) => Ok(None),
        result => result.map(Some),
    }
}
