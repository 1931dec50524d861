//! The drone on real sockets: UDP for AT commands and navdata, TCP for the configuration.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use ardrone_link::{AT_PORT, CONTROL_PORT, NAVDATA_PORT};
use tokio::io::AsyncWriteExt as _;
use tokio::net::{TcpListener, TcpStream, UdpSocket};
use tokio::sync::oneshot;
use tokio::time::Instant;
use tracing::{debug, info};

use crate::{Drone, DroneConfig, Truth};

/// Where the drone listens. Port 0 takes any free port.
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
}

impl Ports {
    /// Free ports on the loopback interface.
    pub const LOOPBACK: Self =
        Self { host: IpAddr::V4(Ipv4Addr::LOCALHOST), at: 0, navdata: 0, control: 0 };

    /// The drone's own ports.
    pub fn standard(host: IpAddr) -> Self {
        Self { host, at: AT_PORT, navdata: NAVDATA_PORT, control: CONTROL_PORT }
    }
}

/// Why the drone could not be put on the network.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// A port could not be bound.
    #[error("cannot listen on {address} for {purpose}: {source}")]
    Bind {
        /// The address.
        address: SocketAddr,
        /// What the port is for.
        purpose: &'static str,
        /// What the system says.
        source: io::Error,
    },
    /// The runtime or its thread could not be started.
    #[error("cannot start the mock drone: {0}")]
    Start(#[from] io::Error),
}

/// A drone on its sockets, not yet alive.
#[derive(Debug)]
pub struct Server {
    at: UdpSocket,
    navdata: UdpSocket,
    control: TcpListener,
    drone: Drone,
    truth: Arc<Mutex<Truth>>,
}

/// How long the drone lives between two looks at the clock.
const PERIOD: Duration = Duration::from_millis(5);
/// Longer than any datagram that means something.
const BUFFER_BYTES: usize = 2048;

impl Server {
    /// Binds the ports.
    ///
    /// # Errors
    /// [`ServerError::Bind`] naming the port that is taken.
    pub async fn bind(config: &DroneConfig, ports: Ports) -> Result<Self, ServerError> {
        let address = |port| SocketAddr::new(ports.host, port);
        let udp = async |port, purpose| {
            let address = address(port);
            UdpSocket::bind(address).await.map_err(|source| ServerError::Bind {
                address,
                purpose,
                source,
            })
        };
        let at = udp(ports.at, "AT commands (UDP)").await?;
        let navdata = udp(ports.navdata, "navdata (UDP)").await?;
        let address = address(ports.control);
        let control = TcpListener::bind(address).await.map_err(|source| ServerError::Bind {
            address,
            purpose: "configuration (TCP)",
            source,
        })?;
        let drone = Drone::new(config);
        let truth = Arc::new(Mutex::new(drone.truth()));
        Ok(Self { at, navdata, control, drone, truth })
    }

    /// The ports that were bound.
    ///
    /// # Errors
    /// What the system says if a socket has no address.
    pub fn ports(&self) -> io::Result<Ports> {
        let at = self.at.local_addr()?;
        Ok(Ports {
            host: at.ip(),
            at: at.port(),
            navdata: self.navdata.local_addr()?.port(),
            control: self.control.local_addr()?.port(),
        })
    }

    /// Lives for ever.
    ///
    /// # Errors
    /// What the system says when a socket fails for good.
    pub async fn run(mut self) -> io::Result<()> {
        let start = Instant::now();
        let mut at_buffer = [0_u8; BUFFER_BYTES];
        let mut navdata_buffer = [0_u8; BUFFER_BYTES];
        let mut listener: Option<SocketAddr> = None;
        let mut reader: Option<TcpStream> = None;
        let mut clock = tokio::time::interval(PERIOD);
        loop {
            tokio::select! {
                received = self.at.recv_from(&mut at_buffer) => {
                    if let Some((length, _)) = tolerate(received)? {
                        let datagram = at_buffer.get(..length).unwrap_or_default();
                        for error in self.drone.handle_at(start.elapsed(), datagram) {
                            debug!("{error}");
                        }
                    }
                }
                received = self.navdata.recv_from(&mut navdata_buffer) => {
                    if let Some((_, from)) = tolerate(received)? {
                        if listener != Some(from) {
                            info!("navdata goes to {from}");
                        }
                        listener = Some(from);
                        self.drone.handle_wake_up(start.elapsed());
                    }
                }
                accepted = self.control.accept() => {
                    if let Ok((stream, from)) = accepted {
                        info!("{from} is connected to the control port");
                        reader = Some(stream);
                    }
                }
                _ = clock.tick() => self.drone.advance(start.elapsed()),
            }
            while let Some(packet) = self.drone.poll_navdata() {
                if let Some(to) = listener {
                    tolerate(self.navdata.send_to(&packet, to).await)?;
                }
            }
            if let Some(dump) = self.drone.poll_control()
                && let Some(stream) = &mut reader
                && let Err(error) = stream.write_all(dump.as_bytes()).await
            {
                debug!("the reader of the configuration has gone: {error}");
                reader = None;
            }
            *self.truth.lock().unwrap_or_else(PoisonError::into_inner) = self.drone.truth();
        }
    }
}

/// A datagram to somebody who has gone comes back as an error of the next call: no reason to die.
fn tolerate<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::ConnectionRefused
                    | io::ErrorKind::ConnectionReset
                    | io::ErrorKind::HostUnreachable
                    | io::ErrorKind::NetworkUnreachable
            ) =>
        {
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// A drone that lives on a thread of its own, until it is dropped.
#[derive(Debug)]
pub struct MockDrone {
    ports: Ports,
    truth: Arc<Mutex<Truth>>,
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl MockDrone {
    /// Starts a drone.
    ///
    /// # Errors
    /// [`ServerError`] if a port is taken or no thread can be had.
    pub fn start(config: &DroneConfig, ports: Ports) -> Result<Self, ServerError> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let server = runtime.block_on(Server::bind(config, ports))?;
        let ports = server.ports()?;
        let truth = Arc::clone(&server.truth);
        let (stop, stopped) = oneshot::channel();
        let thread =
            std::thread::Builder::new().name("mock-drone".to_owned()).spawn(move || {
                runtime.block_on(async {
                    tokio::select! {
                        result = server.run() => {
                            if let Err(error) = result {
                                tracing::error!("the mock drone's sockets failed: {error}");
                            }
                        }
                        // Stopped, or its owner has gone.
                        _ = stopped => {}
                    }
                });
            })?;
        Ok(Self { ports, truth, stop: Some(stop), thread: Some(thread) })
    }

    /// Where it listens.
    pub fn ports(&self) -> Ports {
        self.ports
    }

    /// What really happens, now.
    pub fn truth(&self) -> Truth {
        *self.truth.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for MockDrone {
    fn drop(&mut self) {
        if let Some(stop) = self.stop.take() {
            // The thread may have ended by itself.
            _ = stop.send(());
        }
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the mock drone's thread panicked");
        }
    }
}
