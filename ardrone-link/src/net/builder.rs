//! How a client is set up.

use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use tokio::sync::{broadcast, mpsc, watch};
use tokio::time::timeout;

use super::client::Client;
use super::error::StartError;
use super::limits::{Limits, MAX_EVENTS};
use super::link::{Link, Status};
use super::orders::Orders;
use super::readiness::Readiness;
use super::wire::{Wire, read_control};
use crate::DroneAddress;
use crate::at::Identity;
use crate::session::{Session, SessionConfig};
use crate::settings::{NavdataMode, Setting};

/// Blocks of the configuration that wait to be taken in.
const MAX_CONTROL_BLOCKS: usize = 16;
/// The system's resolver may take much longer.
const RESOLVE_LIMIT: Duration = Duration::from_secs(10);

/// Sets up a [`Client`]. Without any call it is for a drone at its own address, in demo mode, with the
/// drone's own limits.
///
/// ```
/// use ardrone_link::{Client, DroneAddress, NavdataMode, Setting};
///
/// let builder = Client::builder()
///     .address(DroneAddress { host: "10.0.0.7".to_owned(), ..DroneAddress::default() })
///     .navdata(NavdataMode::Full)
///     .setting(Setting::AltitudeMaxM(2.0))
///     .read_back(true);
/// ```
#[derive(Debug, Clone)]
#[must_use = "nothing happens before `start`"]
pub struct ClientBuilder {
    address: DroneAddress,
    navdata: NavdataMode,
    settings: Vec<Setting>,
    identity: Option<Identity>,
    read_back: bool,
    limits: Limits,
}

impl Default for ClientBuilder {
    fn default() -> Self {
        Self {
            address: DroneAddress::default(),
            navdata: NavdataMode::default(),
            settings: Vec::new(),
            identity: None,
            read_back: false,
            limits: Limits {
                ready: Duration::from_secs(30),
                take_off: Duration::from_secs(15),
                landing: Duration::from_secs(30),
            },
        }
    }
}

impl Client {
    /// A client for a drone at its own address, to be set up and started.
    pub fn builder() -> ClientBuilder {
        ClientBuilder::default()
    }
}

impl ClientBuilder {
    /// Where the drone is; 192.168.1.1 with the drone's own ports by default.
    pub fn address(mut self, address: DroneAddress) -> Self {
        self.address = address;
        self
    }

    /// The drone's name or address, with the ports as they are.
    pub fn host(mut self, host: impl Into<String>) -> Self {
        self.address.host = host.into();
        self
    }

    /// What navdata the drone sends; [`NavdataMode::Demo`] by default.
    pub fn navdata(mut self, mode: NavdataMode) -> Self {
        self.navdata = mode;
        self
    }

    /// Adds a setting. They are made in the order of these calls, also after the drone was lost or has
    /// started again.
    pub fn setting(mut self, setting: Setting) -> Self {
        self.settings.push(setting);
        self
    }

    /// Whose configuration is set; the drone's default configuration unless given.
    pub fn identity(mut self, identity: Identity) -> Self {
        self.identity = Some(identity);
        self
    }

    /// Whether the configuration is read back over TCP and compared with the settings before the drone
    /// counts as ready; `false` by default.
    pub fn read_back(mut self, read_back: bool) -> Self {
        self.read_back = read_back;
        self
    }

    /// How long [`Client::ready`] waits; 30 s by default. A drone may take 2 s for each setting, and 6 s for
    /// reading back.
    pub fn ready_limit(mut self, limit: Duration) -> Self {
        self.limits.ready = limit;
        self
    }

    /// How long a take-off may take until the drone hovers; 15 s by default. Then the landing is ordered.
    pub fn take_off_limit(mut self, limit: Duration) -> Self {
        self.limits.take_off = limit;
        self
    }

    /// How long [`Client::land`] waits for the drone to stand; 30 s by default.
    pub fn landing_limit(mut self, limit: Duration) -> Self {
        self.limits.landing = limit;
        self
    }

    /// Begins to look for the drone. A drone that is not there is no error: it may come. A drone that is
    /// found in the air is landed, since nobody has ordered it to fly.
    ///
    /// The client lives in a task of the tokio runtime in which this is called.
    ///
    /// # Errors
    /// [`StartError`] if a setting is out of range, the name has no address (asked for 10 s at most) or no
    /// socket can be had.
    pub async fn start(self) -> Result<Client, StartError> {
        let mut config = SessionConfig::new(&self.navdata, &self.settings)?;
        config.identity = self.identity;
        config.read_back = self.read_back;
        config.take_off_timeout = self.limits.take_off;

        let address = &self.address;
        let at = wire("AT commands", address, address.at_port).await?;
        let navdata = wire("navdata", address, address.navdata_port).await?;
        let (control_sender, control) = mpsc::channel(MAX_CONTROL_BLOCKS);
        if self.read_back {
            let control_address = resolve(address, address.control_port).await?;
            tokio::spawn(read_control(control_address, control_sender));
        }
        let (requests, request_receiver) = mpsc::unbounded_channel();
        let (steering, steering_receiver) = watch::channel(None);
        let (status_sender, status) = watch::channel(Status::default());
        let (event_sender, events) = broadcast::channel(MAX_EVENTS);
        let (packet_sender, packets) = watch::channel(None);
        let link = Link {
            readiness: Readiness::new(config.settings.clone(), self.limits.ready),
            session: Session::new(config),
            orders: Orders::new(self.limits),
            at,
            navdata,
            control,
            requests: request_receiver,
            steering: steering_receiver,
            status: status_sender,
            events: event_sender.clone(),
            packets: packet_sender,
            control_state: None,
            battery_percent: None,
            rests: false,
        };
        let task = tokio::spawn(link.run());
        let events = (event_sender.downgrade(), events);
        Ok(Client::new(requests, steering, status, events, packets, task))
    }
}

async fn wire(
    purpose: &'static str,
    address: &DroneAddress,
    port: u16,
) -> Result<Wire, StartError> {
    let drone = resolve(address, port).await?;
    Wire::new(purpose, drone).await.map_err(|source| StartError::Socket { purpose, source })
}

async fn resolve(address: &DroneAddress, port: u16) -> Result<SocketAddr, StartError> {
    let found =
        timeout(RESOLVE_LIMIT, tokio::net::lookup_host((address.host.as_str(), port))).await;
    let first = found
        .unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()))
        .and_then(|mut found| found.next().ok_or_else(|| io::ErrorKind::NotFound.into()));
    first.map_err(|source| StartError::Resolve { host: address.host.clone(), source })
}
