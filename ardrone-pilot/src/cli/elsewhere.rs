//! The vehicles of a fleet that are flown by programs elsewhere: `--net` and `--vehicle`.
//!
//! Without the feature `zenoh` there is no `Connection`: nothing can make one.

use std::path::Path;
use std::time::{Duration, Instant};

use autopilot::vehicle::VehicleName;
use crossbeam_channel::{Receiver, never};

use crate::fleet::Fleet;
use crate::flight::{Places, RemoteAgents};
use crate::network::{News, Roster, Seen, Told, Totals, UnknownVehicle};
use crate::runtime::Runtime;

#[cfg(feature = "zenoh")]
use crate::network::bridge::{Bridge, NetworkConfig, NetworkError};
#[cfg(not(feature = "zenoh"))]
use std::convert::Infallible as Bridge;
#[cfg(not(feature = "zenoh"))]
use std::convert::Infallible as NetworkConfig;

/// Interval at which displays are told of those vehicles.
const LOOK: Duration = Duration::from_millis(200);

/// Why nobody elsewhere can be heard.
#[derive(Debug, thiserror::Error)]
pub(super) enum ElsewhereError {
    /// `--vehicle` names none of the fleet.
    #[error(transparent)]
    Vehicle(#[from] UnknownVehicle),
    /// It is not built for that.
    #[cfg(not(feature = "zenoh"))]
    #[error(
        "this program was built without Zenoh, which --net needs: build it with `cargo build --release -p ardrone-pilot --features zenoh`"
    )]
    NotBuilt,
    /// The network cannot be had.
    #[cfg(feature = "zenoh")]
    #[error(transparent)]
    Network(#[from] NetworkError),
}

impl ElsewhereError {
    pub(super) fn exit_status(&self) -> u8 {
        match self {
            Self::Vehicle(_) => 20,
            #[cfg(not(feature = "zenoh"))]
            Self::NotBuilt => 2,
            #[cfg(feature = "zenoh")]
            Self::Network(NetworkError::Config { .. }) => 20,
            #[cfg(feature = "zenoh")]
            Self::Network(_) => 1,
        }
    }
}

/// Who is in a fleet, and who of them is flown here.
pub(super) fn roster(fleet: &Fleet, here: &[VehicleName]) -> Result<Roster, ElsewhereError> {
    let vehicles = fleet.members.iter().map(|member| {
        let start = member.config.estimator.start.unwrap_or_default();
        (member.config.name, member.config.system, start)
    });
    Ok(Roster::new(fleet.name, vehicles, here)?)
}

/// The vehicles that are flown elsewhere, as displays show them. There may be none, and no network.
pub(super) struct Elsewhere {
    roster: Roster,
    places: Places,
    connection: Option<Connection>,
    begun: Instant,
    next_look: Instant,
}

impl Elsewhere {
    /// Begins to tell of the vehicles that are flown here, and to hear the others.
    pub(super) fn begin(
        net: Option<Configured>,
        runtime: &Runtime,
        roster: &Roster,
        places: Places,
    ) -> Result<Self, ElsewhereError> {
        let open = |net: Configured| net.open(runtime, roster.clone(), places.clone());
        let connection = net.map(open).transpose()?;
        let now = Instant::now();
        Ok(Self { roster: roster.clone(), places, connection, begun: now, next_look: now })
    }

    /// How the agent of the vehicle with this place reaches those of vehicles elsewhere.
    pub(super) fn remote_agents(&mut self, place: usize) -> Option<Box<dyn RemoteAgents>> {
        self.connection.as_mut()?.remote_agents(place)
    }

    /// What there is to tell; nothing without a network.
    pub(super) fn news(&self) -> Receiver<News> {
        self.connection.as_ref().map_or_else(never, Connection::news)
    }

    /// Since the beginning.
    pub(super) fn time(&self) -> Duration {
        self.begun.elapsed()
    }

    /// What is seen of them, five times a second; nothing in between.
    pub(super) fn look(&mut self) -> Vec<Seen> {
        let now = Instant::now();
        if now < self.next_look {
            return Vec::new();
        }
        self.next_look = now + LOOK;
        let seen = self.roster.places(false).map(|place| {
            let told = self.places.read(place).map(|placed| Told {
                presence: placed.neighbour.presence,
                place_m: placed.neighbour.place_m,
                uncertainty_m: placed.neighbour.uncertainty_m,
                age: if placed.is_parked { Duration::ZERO } else { placed.at.elapsed() },
            });
            Seen { vehicle: self.roster.vehicles[place].name, told }
        });
        seen.collect()
    }

    /// Tells how the vehicles were left, and ends.
    pub(super) fn end(self) -> Option<Totals> {
        self.connection.map(Connection::end)
    }
}

/// A configuration of the network that was read.
pub(super) struct Configured(NetworkConfig);

impl Configured {
    /// Reads it.
    pub(super) fn read(path: &Path) -> Result<Self, ElsewhereError> {
        #[cfg(feature = "zenoh")]
        {
            Ok(Self(NetworkConfig::read(path)?))
        }
        #[cfg(not(feature = "zenoh"))]
        {
            _ = path;
            Err(ElsewhereError::NotBuilt)
        }
    }

    fn open(
        self,
        runtime: &Runtime,
        roster: Roster,
        places: Places,
    ) -> Result<Connection, ElsewhereError> {
        #[cfg(feature = "zenoh")]
        {
            Ok(Connection(Bridge::open(runtime, self.0, roster, places)?))
        }
        #[cfg(not(feature = "zenoh"))]
        {
            _ = (runtime, roster, places);
            match self.0 {}
        }
    }
}

/// The connection to the others.
struct Connection(Bridge);

impl Connection {
    fn remote_agents(&mut self, place: usize) -> Option<Box<dyn RemoteAgents>> {
        #[cfg(feature = "zenoh")]
        {
            let talk = self.0.take_talk(place)?;
            Some(Box::new(talk))
        }
        #[cfg(not(feature = "zenoh"))]
        {
            _ = place;
            match self.0 {}
        }
    }

    /// What there is to tell.
    fn news(&self) -> Receiver<News> {
        #[cfg(feature = "zenoh")]
        {
            self.0.news()
        }
        #[cfg(not(feature = "zenoh"))]
        {
            match self.0 {}
        }
    }

    /// Tells how the vehicles were left, and ends.
    fn end(self) -> Totals {
        #[cfg(feature = "zenoh")]
        {
            self.0.end()
        }
        #[cfg(not(feature = "zenoh"))]
        {
            match self.0 {}
        }
    }
}
