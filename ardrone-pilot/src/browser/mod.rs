//! The ground station in a browser: a page in which plans are made and simulated, flights are watched and ordered, and
//! recorded ones looked back at.
//!
//! Whoever serves the page has no access to the flight except its [`Controls`]: no
//! client can affect the tick. What reads files or thinks is done on threads with the lowest priority. A page that falls behind
//! gets a new snapshot; one that does not read is disconnected.
//!
//! On the loopback interface every user of this machine may give orders. At any other address the page
//! requires a token, which is new for each flight. Pages of other sites are refused everywhere.

mod access;
mod files;
mod folder;
mod pictures;
mod planning;
mod requests;
mod server;
mod settings_file;
mod snapshot;

use std::net::{SocketAddr, TcpListener};
use std::path::PathBuf;
use std::time::Duration;

use autopilot::plan::Plan;
use autopilot::vehicle::VehicleName;

use self::access::Access;
use self::files::Files;
pub use self::planning::Planning;
use self::server::{Server, Vehicle};
pub use self::settings_file::SettingsFile;
use self::snapshot::Snapshot;
use crate::flight::{Controls, Message};
use crate::network::{News, Seen};
use crate::runtime::Runtime;
use crate::video::VideoFeed;

/// Why the page cannot be served.
#[derive(Debug, thiserror::Error)]
pub enum BrowserError {
    /// The address cannot be bound.
    #[error("cannot serve the page at {address}; give another address as --ui")]
    Bind {
        /// The requested address.
        address: SocketAddr,
        /// The system's error.
        source: std::io::Error,
    },
    /// The system has no random numbers.
    #[error("cannot make a token for the page: {0}")]
    Token(String),
}

/// A vehicle that the page shows.
#[derive(Debug)]
pub struct Shown {
    /// What it is to fly.
    pub plan: Option<Plan>,
    /// Its drone, for people.
    pub drone: String,
    /// By what its plans are checked and simulated.
    pub planning: Planning,
    /// Where its orders go.
    pub controls: Controls,
    /// What its camera sees.
    pub video: Option<VideoFeed>,
}

/// What the page offers besides the flights.
#[derive(Debug, Clone)]
pub struct PageConfig {
    /// Folder of the plans.
    pub plans: PathBuf,
    /// Folder of the recordings.
    pub flights: PathBuf,
    /// The recordings of this run, which cannot be deleted.
    pub recordings: Vec<PathBuf>,
    /// The settings, which apply from the next start on.
    pub settings: SettingsFile,
    /// All vehicles of a fleet, also those that are flown elsewhere; without any there are only those that are shown.
    pub fleet: Vec<VehicleName>,
}

/// A bound address, reserved before the flight begins.
#[derive(Debug)]
pub struct Listener {
    listener: TcpListener,
    access: Access,
}

impl Listener {
    /// Binds the address.
    ///
    /// # Errors
    /// [`BrowserError`] if it cannot be bound, or there is no token for it.
    pub fn bind(address: SocketAddr) -> Result<Self, BrowserError> {
        let error = |source| BrowserError::Bind { address, source };
        let listener = TcpListener::bind(address).map_err(error)?;
        listener.set_nonblocking(true).map_err(error)?;
        let access = Access::new(listener.local_addr().map_err(error)?)?;
        Ok(Self { listener, access })
    }

    /// The address to open in a browser.
    pub fn url(&self) -> String {
        self.access.url()
    }

    /// Starts serving the page about these vehicles, of which a browser shows one, the first unless it asks for another.
    pub fn open(self, runtime: &Runtime, page: PageConfig, vehicles: Vec<Shown>) -> Browser {
        let PageConfig { plans, flights, recordings, settings, fleet } = page;
        let here: Vec<_> = vehicles.iter().map(|shown| shown.planning.config.name).collect();
        let fleet = if fleet.is_empty() { here.clone() } else { fleet };
        let plannings = vehicles.iter().map(|shown| shown.planning.clone()).collect();
        let files = Files::new(plannings, plans, flights, recordings, settings);
        let seen = vehicles.into_iter().map(|Shown { plan, drone, planning, controls, video }| {
            let snapshot = Snapshot::new(plan.as_ref(), &planning.config, &drone, &fleet, &here);
            Vehicle::new(snapshot, planning, controls, video)
        });
        let vehicles = seen.collect();
        let server = Server::start(runtime, self.listener, self.access, files, vehicles);
        Browser { server }
    }
}

/// The server of the page. Dropping it delivers all messages first.
#[derive(Debug)]
pub struct Browser {
    server: Server,
}

impl Browser {
    /// Publishes a message of a flight; never blocks.
    pub fn show(&self, message: &Message) {
        self.server.publish(message.vehicle, |snapshot| snapshot.take_in(message));
    }

    /// Publishes what happens on the network, on the pages of all vehicles.
    pub fn tell_all(&self, at: Duration, told: &News) {
        self.server.publish_to_all(|snapshot| snapshot.tell(at, told.warns(), &told.to_string()));
    }

    /// Publishes what is seen of a vehicle that is flown elsewhere.
    pub fn show_elsewhere(&self, seen: &Seen) {
        let object = seen.json();
        self.server.publish_to_all(|snapshot| {
            snapshot.take_in_other(seen.vehicle, &object);
            object.clone()
        });
    }

    /// Publishes the end of a vehicle's flight.
    pub fn end(&self, vehicle: VehicleName, end: &serde_json::Value) {
        self.server.publish(vehicle, |snapshot| {
            snapshot.end(end.clone());
            end.clone()
        });
    }
}
