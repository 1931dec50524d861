//! The drone on real sockets: UDP for AT commands and navdata, TCP for the configuration, and its other ports
//! as far as clients need them to connect.

mod air;
mod ftp;
#[cfg(feature = "video")]
mod video;

use std::collections::VecDeque;
use std::fs::File;
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use ardrone_link::{AT_PORT, CONTROL_PORT, FTP_PORT, NAVDATA_PORT, VIDEO_PORT, is_passing};
use tokio::io::AsyncWriteExt as _;
use tokio::net::{TcpListener, TcpStream, UdpSocket};
use tokio::sync::oneshot;
use tokio::time::Instant;
use tracing::{debug, info};

pub use self::air::Air;
use self::air::InAir;
use crate::truth_log::TruthLog;
use crate::{Message, Truth, World, WorldConfig};

/// Addresses and ports of the drone. Port 0 takes any free port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ports {
    /// The address to bind.
    pub host: IpAddr,
    /// UDP, AT commands.
    pub at: u16,
    /// UDP, navdata.
    pub navdata: u16,
    /// TCP, configuration.
    pub control: u16,
    /// TCP, FTP with the firmware's version; `None` disables it.
    pub ftp: Option<u16>,
    /// TCP, video; without the feature `video` connections stay open without data.
    pub video: Option<u16>,
    /// TCP, a port that some clients probe to detect the drone. The real drone has 21.
    pub presence: Option<u16>,
}

impl Ports {
    /// Free ports on the loopback interface.
    pub const LOOPBACK: Self = Self {
        host: IpAddr::V4(Ipv4Addr::LOCALHOST),
        at: 0,
        navdata: 0,
        control: 0,
        ftp: None,
        video: None,
        presence: None,
    };

    /// The real drone's ports.
    pub fn standard(host: IpAddr) -> Self {
        Self {
            host,
            at: AT_PORT,
            navdata: NAVDATA_PORT,
            control: CONTROL_PORT,
            ftp: Some(FTP_PORT),
            video: Some(VIDEO_PORT),
            presence: None,
        }
    }
}

/// Errors on starting the server.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ServerError {
    /// A port could not be bound.
    #[error("cannot listen on {address} for {purpose}: {source}")]
    Bind {
        /// The address.
        address: SocketAddr,
        /// Purpose of the port.
        purpose: &'static str,
        /// The system's error.
        source: io::Error,
    },
    /// The runtime or its thread could not be started.
    #[error("cannot start the mock drone: {0}")]
    Start(#[from] io::Error),
}

/// A drone with bound sockets, before it runs.
#[derive(Debug)]
#[must_use = "the drone runs while `run` is awaited"]
pub struct Server {
    at: UdpSocket,
    navdata: UdpSocket,
    control: TcpListener,
    ftp: Option<TcpListener>,
    video: Option<TcpListener>,
    presence: Option<TcpListener>,
    world: World,
    in_air: Option<InAir>,
    truth: Arc<Mutex<Truth>>,
    log: Option<TruthLog<File>>,
    next_flush: Duration,
    #[cfg(feature = "video")]
    video_clock: bool,
}

/// Simulation step: interval between readings of the clock.
const PERIOD: Duration = Duration::from_millis(5);
/// Interval between flushes of the truth log, so that a kill loses little.
const FLUSH_PERIOD: Duration = Duration::from_millis(500);
/// Longer than any valid datagram.
const BUFFER_BYTES: usize = 2048;

impl Server {
    /// Binds the ports.
    ///
    /// # Errors
    /// [`ServerError::Bind`] with the port that cannot be bound.
    pub async fn bind(config: &WorldConfig, ports: Ports) -> Result<Self, ServerError> {
        let address = |port| SocketAddr::new(ports.host, port);
        let udp = async |port, purpose| {
            let address = address(port);
            UdpSocket::bind(address).await.map_err(|source| ServerError::Bind {
                address,
                purpose,
                source,
            })
        };
        let tcp = async |port, purpose| {
            let address = address(port);
            TcpListener::bind(address).await.map_err(|source| ServerError::Bind {
                address,
                purpose,
                source,
            })
        };
        let optional = async |port: Option<u16>, purpose| match port {
            Some(port) => tcp(port, purpose).await.map(Some),
            None => Ok(None),
        };
        let world = World::new(config);
        let truth = Arc::new(Mutex::new(world.truth()));
        Ok(Self {
            at: udp(ports.at, "AT commands (UDP)").await?,
            navdata: udp(ports.navdata, "navdata (UDP)").await?,
            control: tcp(ports.control, "configuration (TCP)").await?,
            ftp: optional(ports.ftp, "the version (FTP)").await?,
            video: optional(ports.video, "video (TCP)").await?,
            presence: optional(ports.presence, "presence (TCP)").await?,
            world,
            in_air: None,
            truth,
            log: None,
            next_flush: Duration::ZERO,
            #[cfg(feature = "video")]
            video_clock: false,
        })
    }

    /// Puts the drone into an air that others share, at [`WorldConfig::start`].
    pub fn enter(&mut self, air: &Air) {
        self.in_air = Some(air.enter(self.world.presence()));
    }

    /// Records the true state.
    pub fn log_truth(&mut self, log: TruthLog<File>) {
        self.log = Some(log);
    }

    /// The bound ports.
    ///
    /// # Errors
    /// The system's error if a socket has no address.
    pub fn ports(&self) -> io::Result<Ports> {
        let port = |listener: Option<&TcpListener>| {
            listener.map(|listener| listener.local_addr().map(|address| address.port())).transpose()
        };
        let at = self.at.local_addr()?;
        Ok(Ports {
            host: at.ip(),
            at: at.port(),
            navdata: self.navdata.local_addr()?.port(),
            control: self.control.local_addr()?.port(),
            ftp: port(self.ftp.as_ref())?,
            video: port(self.video.as_ref())?,
            presence: port(self.presence.as_ref())?,
        })
    }

    /// Runs until a socket or the truth log fails; it never ends otherwise.
    ///
    /// # Errors
    /// The system's error when a socket fails for good, the truth log cannot be written, or the video cannot be started.
    pub async fn run(mut self) -> io::Result<()> {
        let start = Instant::now();
        let mut at_buffer = [0_u8; BUFFER_BYTES];
        let mut navdata_buffer = [0_u8; BUFFER_BYTES];
        let mut listener: Option<SocketAddr> = None;
        let mut reader: Option<TcpStream> = None;
        let mut visitors = Visitors::default();
        let mut clock = tokio::time::interval(PERIOD);
        #[cfg(feature = "video")]
        let video = match &self.video {
            Some(_) => Some(video::VideoServer::start(start, self.sight(), self.video_clock)?),
            None => None,
        };
        loop {
            tokio::select! {
                received = self.at.recv_from(&mut at_buffer) => {
                    if let Some((length, _)) = tolerate(received)? {
                        let datagram = at_buffer.get(..length).unwrap_or_default();
                        self.world.send_at(start.elapsed(), datagram);
                    }
                }
                received = self.navdata.recv_from(&mut navdata_buffer) => {
                    if let Some((length, from)) = tolerate(received)? {
                        if listener != Some(from) {
                            info!("sending navdata to {from}");
                        }
                        listener = Some(from);
                        let datagram = navdata_buffer.get(..length).unwrap_or_default();
                        self.world.send_wake_up(start.elapsed(), datagram);
                    }
                }
                accepted = self.control.accept() => {
                    if let Ok((stream, from)) = accepted {
                        info!("{from} connected to the control port");
                        reader = Some(stream);
                    }
                }
                Some(stream) = accept(self.ftp.as_ref()) => {
                    tokio::spawn(async move {
                        if let Err(error) = ftp::serve(stream).await {
                            debug!("FTP client disconnected: {error}");
                        }
                    });
                }
                Some(stream) = accept(self.video.as_ref()) => {
                    #[cfg(feature = "video")]
                    if let Some(video) = &video {
                        video.connect(stream, self.sight());
                    }
                    #[cfg(not(feature = "video"))]
                    visitors.keep(stream);
                }
                Some(stream) = accept(self.presence.as_ref()) => visitors.keep(stream),
                _ = clock.tick() => {}
            }
            let now = start.elapsed();
            if let Some(in_air) = &mut self.in_air {
                let others = in_air.exchange(self.world.presence());
                self.world.meet(others.iter().copied());
            }
            self.world.advance(now);
            #[cfg(feature = "video")]
            if let Some(video) = video.as_ref().filter(|video| video.is_watched()) {
                video.see(self.sight());
            }
            while let Some(message) = self.world.receive(now) {
                match message {
                    Message::Navdata(packet) => {
                        if let Some(to) = listener {
                            tolerate(self.navdata.send_to(&packet, to).await)?;
                        }
                    }
                    Message::Control(dump) => {
                        if let Some(stream) = &mut reader
                            && let Err(error) = stream.write_all(dump.as_bytes()).await
                        {
                            debug!("configuration client disconnected: {error}");
                            reader = None;
                        }
                    }
                }
            }
            if let Some(log) = &mut self.log {
                log.record(&self.world)?;
                if now >= self.next_flush {
                    self.next_flush = now + FLUSH_PERIOD;
                    log.flush()?;
                }
            }
            *self.truth.lock().unwrap_or_else(PoisonError::into_inner) = self.world.truth();
        }
    }
}

#[cfg(feature = "video")]
impl Server {
    /// Draws the time since 1970 into each picture, along its lower edge: see [`crate::video::VideoEncoder::new`].
    pub fn show_video_clock(&mut self) {
        self.video_clock = true;
    }

    fn sight(&self) -> video::Sight {
        let drone = self.world.drone();
        let scene = crate::video::Scene { tags: drone.tags().to_vec() };
        let (loss, is_out) = self.world.link_state();
        video::Sight {
            view: drone.view(),
            scene,
            loss,
            is_out,
            fault: self.world.video_fault(),
            kbit_s: drone.video_kbit_s(),
            lies: drone.lies(),
        }
    }
}

/// The next connection; pending for ever without a listener.
async fn accept(listener: Option<&TcpListener>) -> Option<TcpStream> {
    match listener {
        Some(listener) => listener.accept().await.ok().map(|(stream, _)| stream),
        None => std::future::pending().await,
    }
}

/// Connections that stay open without data; the oldest are closed.
#[derive(Default)]
struct Visitors(VecDeque<TcpStream>);

impl Visitors {
    const MAX: usize = 16;

    fn keep(&mut self, stream: TcpStream) {
        if self.0.len() == Self::MAX {
            self.0.pop_front();
        }
        self.0.push_back(stream);
    }
}

/// UDP reports a peer that has gone as an error of the next call; the server continues.
fn tolerate<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error) if is_passing(&error) => Ok(None),
        result => result.map(Some),
    }
}

/// A drone that runs on its own thread until it is dropped.
#[derive(Debug)]
#[must_use = "the drone stops when this is dropped"]
pub struct MockDrone {
    ports: Ports,
    truth: Arc<Mutex<Truth>>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl MockDrone {
    /// Starts a drone that is alone in its air.
    ///
    /// # Errors
    /// [`ServerError`] if a port is taken or the thread cannot be started.
    pub fn start(config: &WorldConfig, ports: Ports) -> Result<Self, ServerError> {
        Self::start_in(&Air::default(), config, ports)
    }

    /// Starts a drone in an air that others share: at [`WorldConfig::start`], in the frame of the air.
    ///
    /// # Errors
    /// As [`MockDrone::start`].
    pub fn start_in(air: &Air, config: &WorldConfig, ports: Ports) -> Result<Self, ServerError> {
        let (air, config) = (air.clone(), config.clone());
        let (stop, stopped) = oneshot::channel();
        let (started, starting) = std::sync::mpsc::sync_channel(1);
        // The runtime is created on the drone's own thread, so that the caller may have one too.
        let thread =
            std::thread::Builder::new().name("mock-drone".to_owned()).spawn(move || {
                live(&air, &config, ports, &started, stopped);
            })?;
        let ended = || io::Error::other("the mock drone's thread ended at once");
        let (ports, truth) = starting.recv().map_err(|_| ended())??;
        Ok(Self { ports, truth, stop: Some(stop), thread: Some(thread) })
    }

    /// Its ports.
    pub fn ports(&self) -> Ports {
        self.ports
    }

    /// The true state now, in the drone's own frame, which begins at its start.
    pub fn truth(&self) -> Truth {
        *self.truth.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Result of starting a drone.
type Started = Result<(Ports, Arc<Mutex<Truth>>), ServerError>;

/// Body of the drone's thread: reports the start, then runs until it is stopped.
fn live(
    air: &Air,
    config: &WorldConfig,
    ports: Ports,
    started: &SyncSender<Started>,
    stopped: oneshot::Receiver<()>,
) {
    // If the receiver has gone, nobody can stop the drone, and it ends.
    let tell = |result| _ = started.send(result);
    let runtime = match tokio::runtime::Builder::new_current_thread().enable_all().build() {
        Ok(runtime) => runtime,
        Err(error) => return tell(Err(error.into())),
    };
    runtime.block_on(async {
        let mut server = match Server::bind(config, ports).await {
            Ok(server) => server,
            Err(error) => return tell(Err(error)),
        };
        server.enter(air);
        let truth = Arc::clone(&server.truth);
        tell(server.ports().map(|ports| (ports, truth)).map_err(ServerError::from));
        tokio::select! {
            result = server.run() => {
                if let Err(error) = result {
                    tracing::error!("the mock drone's sockets failed: {error}");
                }
            }
            // Stopped, or its owner was dropped.
            _ = stopped => {}
        }
    });
}

impl Drop for MockDrone {
    fn drop(&mut self) {
        if let Some(stop) = self.stop.take() {
            // The thread may have ended already.
            _ = stop.send(());
        }
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the mock drone's thread panicked");
        }
    }
}
