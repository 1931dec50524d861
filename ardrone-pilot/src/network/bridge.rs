//! Carries the states of vehicles, and the lines of their agents, over Zenoh.
//!
//! What is decided is decided in `peers`. Ticks do not know of it: states are read from the places of the room and written to
//! them here, twenty times a second and when they arrive, on the threads of the runtime and of Zenoh.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use autopilot::vehicle::VehicleName;
use crossbeam_channel::{Receiver, Sender, bounded};
use mission_agent::Said;
use tokio::sync::oneshot;
use tokio::time::MissedTickBehavior;
use zenoh::pubsub::Publisher;
use zenoh::qos::{CongestionControl, Priority};
use zenoh::sample::Locality;

use super::lines::{Inbox, LONGEST_LINE_BYTES, LineError, Outbox, Talk};
use super::news::{News, Totals};
use super::peers::Peers;
use super::refused::Refused;
use super::roster::Roster;
use super::state::{STATE_BYTES, Session};
use crate::drive::NoRoom;
use crate::flight::{Placed, Places, RemoteAgents};
use crate::runtime::{Runtime, Task};

/// Interval of the states.
const INTERVAL: Duration = Duration::from_millis(50);
/// The last states of a program that ends are told so often.
const PARTING: u32 = 3;
/// Most news that wait to be shown.
const NEWS: usize = 64;
/// Zenoh's own word for whether it looks for others by multicast.
const MULTICAST: &str = "scouting/multicast/enabled";

/// Why there is no network.
#[derive(Debug, thiserror::Error)]
pub enum NetworkError {
    /// The configuration cannot be read.
    #[error("{}: no configuration of Zenoh: {reason}", .path.display())]
    Config {
        /// Its file.
        path: PathBuf,
        /// Zenoh's word for it.
        reason: String,
    },
    /// Zenoh refuses to begin.
    #[error("Zenoh cannot begin with this configuration: {0}")]
    Open(String),
    /// The system has no random numbers.
    #[error("cannot make a session's number: {0}")]
    Random(String),
}

/// How to reach the others.
#[derive(Debug, Clone)]
pub struct NetworkConfig(zenoh::Config);

impl NetworkConfig {
    /// Reads a file of Zenoh. Others are not looked for by multicast unless it says so.
    ///
    /// # Errors
    /// [`NetworkError::Config`] if it cannot be read, or is no configuration of Zenoh.
    pub fn read(path: &Path) -> Result<Self, NetworkError> {
        let refused = |error: zenoh::Error| NetworkError::Config {
            path: path.to_owned(),
            reason: error.to_string(),
        };
        let mut config = zenoh::Config::from_file(path).map_err(refused)?;
        if config.get_json(MULTICAST).map_err(refused)? == "null" {
            config.insert_json5(MULTICAST, "false").map_err(refused)?;
        }
        Ok(Self(config))
    }
}

/// Shared by what sends and what receives.
#[derive(Debug)]
struct Shared {
    /// Origin of its clock.
    start: Instant,
    places: Places,
    state: Mutex<Listening>,
    news: Sender<News>,
}

#[derive(Debug)]
struct Listening {
    peers: Peers,
    told: u64,
    heard: u64,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Listening> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A state arrives.
    fn hear(&self, key: &str, text: &[u8]) {
        let now = Instant::now();
        let mut state = self.lock();
        match state.peers.hear(now - self.start, key, text) {
            Ok(heard) => {
                state.heard += 1;
                // Nothing is older than the machine's own clock, but for what is two seconds old on one that has just begun.
                let Some(at) = now.checked_sub(heard.age) else { return };
                let placed = Placed { at, neighbour: heard.neighbour, is_parked: heard.is_parked };
                // Still locked: two that arrive at once are written in their order.
                self.places.write(heard.place, placed);
            }
            Err((vehicle, why)) => self.refuse(&mut state, vehicle, why),
        }
    }

    fn refuse(&self, state: &mut Listening, vehicle: Option<VehicleName>, why: Refused) {
        if state.peers.count(vehicle, why) {
            // It is counted in any case.
            _ = self.news.try_send(News::Refused(vehicle, why));
        }
    }

    /// The text that tells of a vehicle.
    fn tell(&self, place: usize) -> Option<String> {
        let Placed { at, neighbour, is_parked } = self.places.read(place)?;
        let mut state = self.lock();
        let now = self.start.elapsed();
        let at = at.saturating_duration_since(self.start);
        let neighbour = autopilot::separation::Neighbour { at, ..neighbour };
        let text = state.peers.tell(now, place, neighbour, is_parked)?;
        state.told += 1;
        Some(text)
    }
}

/// The connection to the programs that fly the other vehicles of a fleet. It ends when this is dropped, which waits until it has
/// told three times more how the vehicles were left.
#[derive(Debug)]
pub struct Bridge {
    shared: Arc<Shared>,
    task: Task<()>,
    news: Receiver<News>,
    talks: Vec<Option<Talk>>,
}

impl Bridge {
    /// Begins to tell of the vehicles that are flown here, and to hear the others; `places` are those of all, in the order of
    /// the fleet. It waits until Zenoh has begun, and so must not be called from a task of a runtime, which panics.
    ///
    /// # Errors
    /// [`NetworkError`] if Zenoh refuses to begin, or there are no random numbers.
    pub fn open(
        runtime: &Runtime,
        NetworkConfig(config): NetworkConfig,
        roster: Roster,
        places: Places,
    ) -> Result<Self, NetworkError> {
        let mut number = [0; 8];
        getrandom::fill(&mut number).map_err(|error| NetworkError::Random(error.to_string()))?;
        let own = Session(u64::from_ne_bytes(number));
        let (sender, news) = bounded(NEWS);
        let (mut inboxes, mut outboxes) = (Vec::new(), Vec::new());
        let mut talks: Vec<Option<Talk>> = roster.vehicles.iter().map(|_| None).collect();
        for place in roster.places(true) {
            let vehicle = roster.vehicles[place].name;
            let (inbox, outbox, talk) = Inbox::new(vehicle);
            inboxes.push((vehicle, inbox));
            outboxes.push(outbox);
            talks[place] = Some(talk);
        }
        let peers = Peers::new(roster, own);
        let state = Mutex::new(Listening { peers, told: 0, heard: 0 });
        let shared = Arc::new(Shared { start: Instant::now(), places, state, news: sender });
        let opening = open(config, Arc::clone(&shared), inboxes);
        let open = runtime
            .handle()
            .block_on(opening)
            .map_err(|error| NetworkError::Open(error.to_string()))?;
        let carried = Arc::clone(&shared);
        let task = runtime.run("the network", |ended| carry(ended, open, carried, outboxes));
        Ok(Self { shared, task, news, talks })
    }

    /// What there is to tell operators.
    pub fn news(&self) -> Receiver<News> {
        self.news.clone()
    }

    /// How the agent of a vehicle that is flown here talks to those of others; nothing if it was taken before.
    pub fn take_talk(&mut self, place: usize) -> Option<Talk> {
        self.talks.get_mut(place)?.take()
    }

    /// What has become of it so far.
    pub fn totals(&self) -> Totals {
        let state = self.shared.lock();
        let refused = state.peers.counts().to_vec();
        Totals { told: state.told, heard: state.heard, refused }
    }

    /// Tells how the vehicles were left, and leaves.
    pub fn end(mut self) -> Totals {
        self.task.end();
        self.totals()
    }
}

impl Drop for Bridge {
    fn drop(&mut self) {
        self.task.end();
    }
}

impl RemoteAgents for Talk {
    /// Names of vehicles are those of peers, and what an agent says is a line. Who has left the network tells nobody anything.
    fn say(&mut self, Said { to, line }: &Said) -> Result<(), NoRoom> {
        match to.parse().map(|to| Self::say(self, to, line)) {
            Ok(Err(LineError::Full)) => Err(NoRoom::Network),
            _ => Ok(()),
        }
    }

    /// A line that is longer than any message of an agent is none.
    fn next_line(&mut self) -> Option<mission_agent::Line> {
        loop {
            let text = Self::next_line(self)?.text;
            if let Ok(line) = mission_agent::Line::from(&text) {
                return Some(line);
            }
        }
    }
}

/// A session, and what was declared in it.
struct Open {
    session: zenoh::Session,
    /// For the state of each vehicle that is flown here.
    publishers: Vec<(usize, Publisher<'static>)>,
}

async fn open(
    config: zenoh::Config,
    shared: Arc<Shared>,
    inboxes: Vec<(VehicleName, Inbox)>,
) -> zenoh::Result<Open> {
    let session = zenoh::open(config).await?;
    let roster = shared.lock().peers.roster().clone();
    let hearing = Arc::clone(&shared);
    session
        .declare_subscriber(roster.state_key("*"))
        .allowed_origin(Locality::Remote)
        .callback(move |sample| {
            let key = sample.key_expr().as_str();
            // What is too long is not copied together.
            let payload = sample.payload();
            let text = if payload.len() > STATE_BYTES {
                vec![0; STATE_BYTES + 1].into()
            } else {
                payload.to_bytes()
            };
            hearing.hear(key, &text);
        })
        .background()
        .await?;
    for (vehicle, inbox) in inboxes {
        let (hearing, roster) = (Arc::clone(&shared), roster.clone());
        session
            .declare_subscriber(roster.line_key("*", vehicle.as_str()))
            .allowed_origin(Locality::Remote)
            .callback(move |sample| {
                let payload = sample.payload();
                let text = if payload.len() > LONGEST_LINE_BYTES {
                    vec![0; LONGEST_LINE_BYTES + 1].into()
                } else {
                    payload.to_bytes()
                };
                let taken = inbox.take(&roster, sample.key_expr().as_str(), &text);
                if let Err((vehicle, why)) = taken {
                    hearing.refuse(&mut hearing.lock(), vehicle, why);
                }
            })
            .background()
            .await?;
    }
    let mut publishers = Vec::new();
    for place in roster.places(true) {
        let publisher = session
            .declare_publisher(roster.state_key(roster.vehicles[place].name.as_str()))
            .congestion_control(CongestionControl::Drop)
            .priority(Priority::RealTime)
            .express(true)
            .allowed_destination(Locality::Remote)
            .await?;
        publishers.push((place, publisher));
    }
    Ok(Open { session, publishers })
}

/// Tells of the vehicles until it is to end.
async fn carry(
    mut ended: oneshot::Receiver<()>,
    open: Open,
    shared: Arc<Shared>,
    outboxes: Vec<Outbox>,
) {
    let Open { session, publishers } = open;
    let roster = shared.lock().peers.roster().clone();
    let mut interval = tokio::time::interval(INTERVAL);
    interval.set_missed_tick_behavior(MissedTickBehavior::Skip);
    loop {
        tokio::select! {
            _ = interval.tick() => {}
            _ = &mut ended => break,
        }
        tell(&shared, &publishers).await;
        for line in outboxes.iter().flat_map(Receiver::try_iter) {
            let key = roster.line_key(line.from.as_str(), line.to.as_str());
            let said = session
                .put(key, line.text.as_str())
                .congestion_control(CongestionControl::Drop)
                .express(true)
                .allowed_destination(Locality::Remote)
                .await;
            if let Err(error) = said {
                tracing::warn!("the network takes no line of {}'s agent: {error}", line.from);
            }
        }
        let changes = {
            let mut state = shared.lock();
            state.peers.changes(shared.start.elapsed())
        };
        for change in changes {
            // Whoever shows them falls behind only if nobody takes what is shown.
            _ = shared.news.try_send(News::Changed(change));
        }
    }
    for _ in 0..PARTING {
        tell(&shared, &publishers).await;
        tokio::time::sleep(INTERVAL).await;
    }
    if let Err(error) = session.close().await {
        tracing::warn!("leaving the network: {error}");
    }
}

async fn tell(shared: &Shared, publishers: &[(usize, Publisher<'static>)]) {
    for (place, publisher) in publishers {
        if let Some(text) = shared.tell(*place)
            && let Err(error) = publisher.put(text).await
        {
            // Others notice that it is silent.
            tracing::debug!("a state is not told: {error}");
        }
    }
}
