//! Builder of the client.

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

/// Capacity of the queue of configuration blocks.
const MAX_CONTROL_BLOCKS: usize = 16;
/// Timeout of name resolution; the system's own may be much longer.
const RESOLVE_LIMIT: Duration = Duration::from_secs(10);

/// Configures a [`Client`]. By default it connects to a drone at its standard address, in demo mode, with the
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
    /// A builder with the default values.
    pub fn builder() -> ClientBuilder {
        ClientBuilder::default()
    }
}

impl ClientBuilder {
    /// Address of the drone; by default 192.168.1.1 with the drone's standard ports.
    pub fn address(mut self, address: DroneAddress) -> Self {
        self.address = address;
        self
    }

    /// Host name or IP address of the drone; the ports are not changed.
    pub fn host(mut self, host: impl Into<String>) -> Self {
        self.address.host = host.into();
        self
    }

    /// Navdata requested from the drone; [`NavdataMode::Demo`] by default.
    pub fn navdata(mut self, mode: NavdataMode) -> Self {
        self.navdata = mode;
        self
    }

    /// Adds a setting. Settings are applied in the order of these calls, and applied again after the drone
    /// was lost or has restarted.
    pub fn setting(mut self, setting: Setting) -> Self {
        self.settings.push(setting);
        self
    }

    /// Selects a custom configuration; by default the drone's default configuration is changed.
    pub fn identity(mut self, identity: Identity) -> Self {
        self.identity = Some(identity);
        self
    }

    /// Whether the configuration must be read back over TCP and agree with the settings before the drone
    /// counts as ready; `false` by default.
    pub fn read_back(mut self, read_back: bool) -> Self {
        self.read_back = read_back;
        self
    }

    /// Timeout of [`Client::ready`]; 30 s by default. A drone may take 2 s for each setting, and 6 s for
    /// reading back.
    pub fn ready_limit(mut self, limit: Duration) -> Self {
        self.limits.ready = limit;
        self
    }

    /// Timeout of a take-off, until the drone hovers; 15 s by default. After it the landing is ordered.
    pub fn take_off_limit(mut self, limit: Duration) -> Self {
        self.limits.take_off = limit;
        self
    }

    /// Timeout of [`Client::land`]; 30 s by default.
    pub fn landing_limit(mut self, limit: Duration) -> Self {
        self.limits.landing = limit;
        self
    }

    /// Starts connecting to the drone. A missing drone is not an error, because it may appear later. A drone
    /// that is found in the air is landed, because this client has not ordered it to fly.
    ///
    /// The client runs in a task of the current tokio runtime.
    ///
    /// # Errors
    /// [`StartError`] if a setting is out of range, the host name cannot be resolved within 10 s, or no
    /// socket can be opened.
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
