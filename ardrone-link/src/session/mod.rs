//! The client's side of the conversation: a state machine fed with time and bytes.
//!
//! A shell owns the sockets and the clock and drives a [`Session`] so:
//! - each navdata datagram goes to [`Session::handle_navdata`], each block of bytes from the
//!   control port to [`Session::handle_control`];
//! - every 30 ms [`Session::tick`] fills exactly one datagram for the AT port;
//! - when [`Session::wake_up_due`] says so, [`crate::WAKE_UP`] goes to the navdata port;
//! - [`Session::poll_event`] tells what happened.
//!
//! Rules of the drone that are kept here (Parrot's developer guide, and what other clients found out):
//! - REF and PCMD are levels and stand in every datagram.
//! - The drone takes number 1 always, and other numbers only if they are greater than the last. So
//!   that any datagram may be lost, every one begins with number 1 until the drone shows that it
//!   hears us; from then on numbers only rise, also after a loss and after a restart of the drone.
//! - A drone that has restarted or was lost must never take off because of an old order: the
//!   take-off bit is withheld until take-off is ordered anew.
//! - Navdata whose sequence number is not higher than the last is dropped, unless the drone has
//!   visibly started again.

mod emergency;
mod handshake;

use std::collections::VecDeque;
use std::time::Duration;

use self::emergency::{EmergencySwitch, EmergencyWish};
use self::handshake::Handshake;
use crate::at::{Command, Config, Datagram, EncodeError, Identity, Motion, Ref};
use crate::configuration::Configuration;
use crate::navdata::{ControlState, DroneState, Navdata, NavdataError};
use crate::settings::{NavdataMode, Setting, SettingError};

/// How a session behaves.
#[derive(Debug, Clone)]
pub struct SessionConfig {
    /// Keys set one after the other when the drone is found, each acknowledged. The first must
    /// be `general:navdata_demo`, which ends the bootstrap: [`SessionConfig::new`] sees to that.
    pub settings: Vec<Config>,
    /// Whose configuration is meant. Keys that are not common to all need it, except the limits
    /// and the cameras, which the default configuration takes too.
    pub identity: Option<Identity>,
    /// Whether the configuration is read back over the control port before the session is ready.
    pub read_back: bool,
    /// Silence after which the drone is asked for navdata again.
    pub wake_up_interval: Duration,
    /// Silence after which the link counts as lost. The drone itself uses 2 s.
    pub loss_timeout: Duration,
    /// A take-off that takes longer has failed: its order is withdrawn.
    pub take_off_timeout: Duration,
}

impl Default for SessionConfig {
    fn default() -> Self {
        Self {
            settings: Vec::new(),
            identity: None,
            read_back: false,
            wake_up_interval: Duration::from_millis(200),
            loss_timeout: Duration::from_secs(2),
            take_off_timeout: Duration::from_secs(8),
        }
    }
}

impl SessionConfig {
    /// A configuration whose settings begin with what [`NavdataMode`] needs, the rest as in the default.
    ///
    /// # Errors
    /// [`SettingError`] if a value is out of range or a setting belongs to the [`NavdataMode`].
    pub fn new(navdata: &NavdataMode, settings: &[Setting]) -> Result<Self, SettingError> {
        if let Some(setting) = settings.iter().find(|setting| setting.is_navdata_mode()) {
            return Err(SettingError::Navdata { key: setting.key() });
        }
        let mode = navdata.settings();
        let settings = mode.iter().chain(settings).map(Setting::config);
        Ok(Self { settings: settings.collect::<Result<_, _>>()?, ..Self::default() })
    }
}

/// Nothing is allocated in flight: so many events may wait to be told.
const EVENTS: usize = 32;
/// A drone that has been silent for so long is not heard.
const UNHEARD: Duration = Duration::from_millis(300);
/// Packets that come within so long after a silence may all have been held up on their way, since before a
/// restart.
const HELD_UP: Duration = Duration::from_millis(100);

/// A drone that is told to land begins to within this time, if it hears.
const DISOBEYED: Duration = Duration::from_millis(500);

/// What the pilot wants in this tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// The REF level.
    pub flight: FlightOrder,
    /// The PCMD arguments.
    pub motion: Motion,
}

impl Order {
    /// Land, or stay on the ground, with the sticks at rest.
    pub const LAND: Self = Self { flight: FlightOrder::Land, motion: Motion::Hover };
}

/// Take-off and landing, as the pilot wants it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlightOrder {
    /// Land, or stay on the ground.
    Land,
    /// Take off.
    TakeOff,
    /// Stay in the air. Never takes off: after a restart or a loss of the drone it is sent as
    /// [`FlightOrder::Land`].
    StayAirborne,
}

/// What happened in a session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// First navdata since the start or since a loss.
    Connected,
    /// The drone acknowledged a configuration key.
    Configured {
        /// `section:name`
        key: String,
    },
    /// The drone never acknowledged a configuration key.
    ConfigurationTimedOut {
        /// `section:name`
        key: String,
    },
    /// The configuration was read back over the control port.
    ConfigurationRead(Configuration),
    /// The configuration could not be read back.
    ConfigurationNotRead,
    /// All settings are made: the drone may fly.
    Ready,
    /// No navdata for the loss timeout.
    LinkLost,
    /// The drone has started again: its state is forgotten, take-off orders are withdrawn.
    DroneRestarted,
    /// The drone has left the ground.
    Airborne,
    /// The drone stands on the ground again.
    Landed,
    /// The drone has not left the ground within the take-off timeout.
    TakeOffTimedOut,
    /// The emergency bit rose: the motors are cut.
    Emergency,
    /// The emergency bit fell.
    EmergencyCleared,
}

/// What a navdata datagram turned out to be.
#[derive(Debug, Clone, PartialEq)]
pub enum Received {
    /// New navdata.
    Navdata(Navdata),
    /// A packet that is older than the last one, or the same again.
    Stale,
    /// A damaged packet.
    Damaged(NavdataError),
}

/// Counters of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Packets taken.
    pub received: u64,
    /// Packets dropped because they were old or repeated.
    pub stale: u64,
    /// Packets dropped because they were damaged.
    pub damaged: u64,
}

/// A client's session with one drone.
#[derive(Debug)]
pub struct Session {
    config: SessionConfig,
    link: Link,
    handshake: Handshake,
    /// Settings that were asked for since, and how far the first of them is.
    changes: VecDeque<Config>,
    change: Option<Handshake>,
    sequence: SequenceNumbers,
    state: DroneState,
    last_navdata: Option<Heard>,
    last_wake_up: Option<Duration>,
    flat_trim_due: bool,
    take_off: TakeOffLatch,
    /// Since when take-off is ordered of a drone that stands.
    taking_off_since: Option<Duration>,
    /// Since when landing is ordered of a drone that flies, and whether it does.
    landing_since: Option<Duration>,
    lands: bool,
    /// The last words have begun.
    parts: bool,
    emergency: EmergencySwitch,
    events: VecDeque<Event>,
    statistics: Statistics,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Link {
    /// Nothing heard yet, or not since a loss.
    Silent,
    Alive,
}

/// Counts commands.
#[derive(Debug, Clone, Copy)]
struct SequenceNumbers {
    next: u32,
    /// The greatest number that was said.
    greatest: u32,
    /// The drone has shown that it hears us.
    confirmed: bool,
}

impl SequenceNumbers {
    const FIRST: u32 = 1;

    fn new() -> Self {
        Self { next: Self::FIRST, greatest: 0, confirmed: false }
    }

    /// A datagram begins. The drone may still count where another pilot has left it, far above us,
    /// and the datagram that told it otherwise may be lost.
    fn begin_datagram(&mut self) {
        self.next = match self.greatest.checked_add(1) {
            Some(next) if self.confirmed => next,
            _ => Self::FIRST,
        };
    }

    /// Beyond whatever another client may have counted to. Number 1 would be heard as well, but behind it
    /// so would any old datagram that is still under way.
    fn leap(&mut self) {
        const FAR: u32 = 1 << 20;
        self.greatest = self.greatest.saturating_add(FAR);
    }

    fn take(&mut self) -> u32 {
        let number = self.next;
        self.greatest = self.greatest.max(number);
        self.next = number.saturating_add(1);
        number
    }
}

#[derive(Debug, Clone, Copy)]
struct Heard {
    at: Duration,
    sequence: u32,
    bootstrapping: bool,
    /// When a silence ended, while what has come since may have been held up.
    returned_at: Option<Duration>,
}

impl Heard {
    /// The same of a packet that comes now.
    fn returned_at(&self, now: Duration) -> Option<Duration> {
        if now.saturating_sub(self.at) >= UNHEARD {
            return Some(now);
        }
        self.returned_at.filter(|at| now.saturating_sub(*at) < HELD_UP)
    }
}

/// Guards the take-off bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TakeOffLatch {
    /// The bit follows the orders.
    Follow { airborne: bool },
    /// Something happened that ends every old order: the bit stays down until the pilot has
    /// ordered landing and then take-off again.
    Withheld { landing_ordered: bool },
}

impl Session {
    /// A session that has heard nothing yet.
    pub fn new(mut config: SessionConfig) -> Self {
        if let Some(identity) = config.identity {
            // The first key ends the bootstrap; those that follow belong to the identity.
            let place = config.settings.len().min(1);
            config.settings.splice(place..place, custom_settings(identity));
        }
        let handshake = Handshake::new(config.settings.len(), config.read_back);
        Self {
            config,
            link: Link::Silent,
            handshake,
            changes: VecDeque::new(),
            change: None,
            sequence: SequenceNumbers::new(),
            state: DroneState::empty(),
            last_navdata: None,
            last_wake_up: None,
            flat_trim_due: false,
            take_off: TakeOffLatch::Follow { airborne: false },
            taking_off_since: None,
            landing_since: None,
            lands: false,
            parts: false,
            emergency: EmergencySwitch::default(),
            events: VecDeque::with_capacity(EVENTS),
            statistics: Statistics::default(),
        }
    }

    /// Takes in a datagram from the drone's navdata port.
    pub fn handle_navdata(&mut self, now: Duration, datagram: &[u8]) -> Received {
        let navdata = match Navdata::decode(datagram) {
            Ok(navdata) => navdata,
            Err(error) => {
                self.statistics.damaged += 1;
                return Received::Damaged(error);
            }
        };
        if let Some(last) = self.last_navdata.filter(|_| self.link == Link::Alive)
            && navdata.sequence <= last.sequence
        {
            if !has_restarted(now, &navdata, last) {
                self.statistics.stale += 1;
                return Received::Stale;
            }
            self.events.push_back(Event::DroneRestarted);
            self.state = DroneState::empty();
            self.withhold_take_off();
            self.handshake = self.new_handshake();
        }
        let returned_at = self.last_navdata.and_then(|last| last.returned_at(now));
        let bootstrapping = navdata.state.contains(DroneState::NAVDATA_BOOTSTRAP);
        let sequence = navdata.sequence;
        self.last_navdata = Some(Heard { at: now, sequence, bootstrapping, returned_at });
        self.statistics.received += 1;
        if self.link == Link::Silent {
            self.link = Link::Alive;
            self.events.push_back(Event::Connected);
        }
        self.watch_state(&navdata);
        if bootstrapping && self.handshake.is_done() {
            // It has lost us, and waits to be configured again.
            self.withhold_take_off();
            self.handshake = self.new_handshake();
        }
        let state = navdata.state;
        if self.handshake.handle_state(state, &self.config.settings, &mut self.events) {
            self.sequence.confirmed = true;
        }
        self.follow_change(state);
        Received::Navdata(navdata)
    }

    /// Sets one more key, once the session is ready and behind those that were asked for before; it takes
    /// the place of an earlier value. [`Event::Configured`] or [`Event::ConfigurationTimedOut`] tells what
    /// became of it. It is among the settings from then on: made again after a loss or a restart.
    pub fn request_setting(&mut self, config: Config) {
        self.changes.push_back(config);
    }

    /// Looks at the acknowledge bit for the setting that is being changed.
    fn follow_change(&mut self, state: DroneState) {
        let Some(change) = &mut self.change else { return };
        self.sequence.confirmed |=
            change.handle_state(state, self.changes.make_contiguous(), &mut self.events);
        if change.is_done() {
            self.change = None;
            if let Some(config) = self.changes.pop_front() {
                self.keep(config);
            }
        }
    }

    /// Makes a setting one of those that are made when the drone is found.
    fn keep(&mut self, config: Config) {
        match self.config.settings.iter_mut().rfind(|other| other.key() == config.key()) {
            Some(other) => *other = config,
            None => self.config.settings.push(config),
        }
    }

    /// All settings are made anew, with those that wait among them.
    fn new_handshake(&mut self) -> Handshake {
        self.change = None;
        while let Some(config) = self.changes.pop_front() {
            self.keep(config);
        }
        Handshake::new(self.config.settings.len(), self.config.read_back)
    }

    /// What the conversation about settings adds to this tick.
    fn setting_command(&mut self, now: Duration) -> Option<Command> {
        if !self.handshake.is_done() {
            let settings = &self.config.settings;
            return self.handshake.command(now, self.state, settings, &mut self.events);
        }
        if self.changes.is_empty() {
            return None;
        }
        let change = self.change.get_or_insert_with(Handshake::change);
        change.command(now, self.state, self.changes.make_contiguous(), &mut self.events)
    }

    /// Takes in bytes from the drone's control port.
    pub fn handle_control(&mut self, bytes: &[u8]) {
        self.handshake.handle_control(bytes, &mut self.events);
    }

    /// Fills `datagram` with this tick's commands: REF, PCMD, and what the conversation needs. It stays empty
    /// until the drone has been heard: it may be flying already, and any REF would land it or fight its pilot.
    /// An REF that could lift the drone is left out while the drone is not heard.
    ///
    /// # Errors
    /// Never in practice: the commands of one tick are shorter than a datagram, whatever the
    /// settings; the error is passed on rather than hidden.
    pub fn tick(
        &mut self,
        now: Duration,
        order: Order,
        datagram: &mut Datagram,
    ) -> Result<(), EncodeError> {
        datagram.clear();
        if self.last_navdata.is_none() {
            return Ok(());
        }
        self.watch_silence(now);
        let take_off = self.take_off_bit(order.flight);
        self.watch_landing(now, take_off);
        self.begin(datagram);
        self.watch_take_off(now, take_off);
        let emergency = self.state.contains(DroneState::EMERGENCY);
        let reference = if self.emergency.level(now, emergency) {
            Some(Ref::ToggleEmergency)
        } else if take_off {
            self.is_heard(now).then_some(Ref::TakeOff)
        } else {
            Some(Ref::Land)
        };
        if let Some(reference) = reference {
            self.push(datagram, &Command::Ref(reference))?;
        }
        self.push(datagram, &Command::Pcmd(order.motion))?;
        if self.state.contains(DroneState::COMMUNICATION_WATCHDOG) {
            self.push(datagram, &Command::CommunicationWatchdog)?;
        }
        // A drone in the air does not stand level, whoever asked for it.
        let flies = self.state.contains(DroneState::FLYING);
        if std::mem::take(&mut self.flat_trim_due) && !flies {
            self.push(datagram, &Command::FlatTrim)?;
        }
        if self.link == Link::Alive
            && let Some(command) = self.setting_command(now)
        {
            // The identity holds for the command behind it.
            if let (Command::Config(_), Some(identity)) = (&command, self.config.identity) {
                self.push(datagram, &Command::ConfigIds(identity))?;
            }
            self.push(datagram, &command)?;
        }
        Ok(())
    }

    /// A tick in which nothing is said, to a drone that is not ours to speak to: its silence is noticed all
    /// the same.
    pub fn idle(&mut self, now: Duration) {
        self.watch_silence(now);
    }

    /// Fills `datagram` with the last words of a pilot that leaves: land, with the sticks at rest. A cut
    /// that was asked for goes on. It stays empty if nothing was ever said to this drone: it is not ours.
    ///
    /// # Errors
    /// Never in practice, see [`Session::tick`].
    pub fn part(&mut self, now: Duration, datagram: &mut Datagram) -> Result<(), EncodeError> {
        datagram.clear();
        if !self.has_spoken() {
            return Ok(());
        }
        if !std::mem::replace(&mut self.parts, true) {
            self.sequence.leap();
        }
        self.begin(datagram);
        self.withhold_take_off();
        let emergency = self.state.contains(DroneState::EMERGENCY);
        let cut = self.emergency.level(now, emergency);
        let reference = if cut { Ref::ToggleEmergency } else { Ref::Land };
        self.push(datagram, &Command::Ref(reference))?;
        self.push(datagram, &Command::Pcmd(Motion::Hover))
    }

    /// Whether anything was ever said to the drone.
    pub fn has_spoken(&self) -> bool {
        self.sequence.greatest > 0
    }

    /// Whether [`crate::WAKE_UP`] is to be sent to the navdata port now.
    pub fn wake_up_due(&mut self, now: Duration) -> bool {
        let heard = self.last_navdata.map(|heard| heard.at);
        let quiet = |since: Option<Duration>| {
            since.is_none_or(|at| now.saturating_sub(at) >= self.config.wake_up_interval)
        };
        let due = quiet(heard) && quiet(self.last_wake_up);
        if due {
            self.last_wake_up = Some(now);
        }
        due
    }

    /// Sends one level reference with the next tick. The drone must stand level on the ground.
    pub fn request_flat_trim(&mut self) {
        self.flat_trim_due = true;
    }

    /// Cuts the motors at once, wherever the drone is: **it falls**. Repeated until the drone says
    /// that it has done so.
    pub fn request_emergency_stop(&mut self) {
        self.withhold_take_off();
        self.emergency.request(EmergencyWish::Stop);
    }

    /// Clears an emergency, so that the drone can fly again. Only on the ground, and only when a
    /// person has looked at the drone.
    pub fn request_emergency_reset(&mut self) {
        self.emergency.request(EmergencyWish::Reset);
    }

    /// What happened, oldest first.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Whether the drone is heard and configured.
    pub fn is_ready(&self) -> bool {
        self.link == Link::Alive && self.handshake.is_done()
    }

    /// Whether the drone is being heard.
    pub fn is_alive(&self) -> bool {
        self.link == Link::Alive
    }

    /// The state bits of the newest packet.
    pub fn state(&self) -> DroneState {
        self.state
    }

    /// Time since the newest packet; nothing if there was none.
    pub fn silence(&self, now: Duration) -> Option<Duration> {
        self.last_navdata.map(|heard| now.saturating_sub(heard.at))
    }

    /// Counters since the start.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    fn push(&mut self, datagram: &mut Datagram, command: &Command) -> Result<(), EncodeError> {
        datagram.push(self.sequence.take(), command)
    }

    fn begin(&mut self, datagram: &mut Datagram) {
        datagram.clear();
        self.sequence.begin_datagram();
    }

    fn watch_state(&mut self, navdata: &Navdata) {
        let emergency = |state: DroneState| state.contains(DroneState::EMERGENCY);
        match (emergency(self.state), emergency(navdata.state)) {
            (false, true) => {
                self.events.push_back(Event::Emergency);
                self.withhold_take_off();
            }
            (true, false) => self.events.push_back(Event::EmergencyCleared),
            _ => {}
        }
        let flying = |state: DroneState| state.contains(DroneState::FLYING);
        match (flying(self.state), flying(navdata.state)) {
            (false, true) => {
                // It does what it was told.
                self.sequence.confirmed |= self.taking_off_since.is_some();
                self.events.push_back(Event::Airborne);
            }
            // With its motors cut it falls.
            (true, false) if !emergency(navdata.state) => self.events.push_back(Event::Landed),
            _ => {}
        }
        self.state = navdata.state;
        self.lands = navdata.demo.is_some_and(|demo| demo.control_state == ControlState::Landing);
        if let TakeOffLatch::Follow { airborne } = self.take_off {
            let landed =
                navdata.demo.is_some_and(|demo| demo.control_state == ControlState::Landed);
            if navdata.state.contains(DroneState::FLYING) {
                self.take_off = TakeOffLatch::Follow { airborne: true };
            } else if airborne && landed {
                // It flew and has landed: the order to fly is spent.
                self.withhold_take_off();
            }
        }
    }

    /// A drone that is not heard may have started again, and stand on the ground: nothing that could
    /// lift it is sent. One that flies goes on as if a datagram had been lost.
    fn is_heard(&self, now: Duration) -> bool {
        self.last_navdata.is_some_and(|heard| {
            heard.returned_at.is_none() && now.saturating_sub(heard.at) < UNHEARD
        })
    }

    fn watch_silence(&mut self, now: Duration) {
        let Some(heard) = self.last_navdata else { return };
        let lost = now.saturating_sub(heard.at) >= self.config.loss_timeout;
        if lost && self.link == Link::Alive {
            self.link = Link::Silent;
            self.events.push_back(Event::LinkLost);
            self.withhold_take_off();
            self.handshake = self.new_handshake();
        }
    }

    /// Gives up a take-off that does not come.
    fn watch_take_off(&mut self, now: Duration, ordered: bool) {
        if !ordered || self.state.contains(DroneState::FLYING) {
            self.taking_off_since = None;
            return;
        }
        let since = *self.taking_off_since.get_or_insert(now);
        if now.saturating_sub(since) >= self.config.take_off_timeout {
            self.taking_off_since = None;
            self.events.push_back(Event::TakeOffTimedOut);
            self.withhold_take_off();
        }
    }

    /// A drone that flies on although it is told to land may obey somebody who has counted further.
    fn watch_landing(&mut self, now: Duration, take_off: bool) {
        if take_off || !self.state.contains(DroneState::FLYING) || self.lands {
            self.landing_since = None;
            return;
        }
        let since = *self.landing_since.get_or_insert(now);
        if now.saturating_sub(since) >= DISOBEYED {
            self.landing_since = Some(now);
            self.sequence.leap();
        }
    }

    fn withhold_take_off(&mut self) {
        self.take_off = TakeOffLatch::Withheld { landing_ordered: false };
    }

    fn take_off_bit(&mut self, order: FlightOrder) -> bool {
        match &mut self.take_off {
            TakeOffLatch::Follow { airborne } => match order {
                FlightOrder::TakeOff => true,
                FlightOrder::StayAirborne => *airborne,
                FlightOrder::Land => false,
            },
            TakeOffLatch::Withheld { landing_ordered } => {
                let renewed = *landing_ordered && order == FlightOrder::TakeOff;
                *landing_ordered |= order == FlightOrder::Land;
                if renewed {
                    self.take_off = TakeOffLatch::Follow { airborne: false };
                }
                renewed
            }
        }
    }
}

/// The keys that select an identity's configurations, or make them.
fn custom_settings(identity: Identity) -> [Config; 3] {
    [
        ("custom:session_id", identity.session),
        ("custom:profile_id", identity.user),
        ("custom:application_id", identity.application),
    ]
    .map(|(key, id)| Config::plain(key, Identity::text(id)))
}

/// A sequence number that does not rise means a late or repeated packet, unless the drone says
/// that it is bootstrapping, as a drone does that nobody has configured yet, or counts from the very
/// start, and there was a silence, as there is while a drone starts: old packets that come again amid new
/// ones are old.
fn has_restarted(now: Duration, navdata: &Navdata, last: Heard) -> bool {
    const FIRST_PACKETS: u32 = 3;
    /// Packets overtake no more than so many others.
    const OVERTAKEN: u32 = 32;
    let behind = last.sequence.saturating_sub(navdata.sequence);
    if behind == 0 || last.returned_at(now).is_none() {
        return false;
    }
    let bootstrapping = navdata.state.contains(DroneState::NAVDATA_BOOTSTRAP);
    // One that was bootstrapping already may just have been overtaken.
    let is_new = !last.bootstrapping || behind > OVERTAKEN;
    let from_the_start = navdata.sequence <= FIRST_PACKETS && last.sequence > 10 * FIRST_PACKETS;
    bootstrapping && is_new || from_the_start
}

#[cfg(test)]
mod tests;
