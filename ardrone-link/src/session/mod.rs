//! The client's side of the protocol: a state machine with time and bytes as inputs.
//!
//! A shell owns the sockets and the clock and drives a [`Session`] as follows:
//! - each navdata datagram goes to [`Session::handle_navdata`], each block of bytes from the control port to
//!   [`Session::handle_control`];
//! - every 30 ms [`Session::tick`] fills exactly one datagram for the AT port;
//! - when [`Session::wake_up_due`] is true, [`crate::WAKE_UP`] goes to the navdata port;
//! - [`Session::poll_event`] returns events.
//!
//! Rules of the drone that are enforced here (from Parrot's developer guide and the experience of other
//! clients):
//! - REF and PCMD are levels and must be in every datagram.
//! - The drone always accepts sequence number 1, and other numbers only if they are greater than the last. So
//!   that any datagram may be lost, every one starts with number 1 until the drone shows that it receives
//!   them; from then on numbers only rise, also after a loss and after a restart of the drone.
//! - A drone that has restarted or was lost must never take off because of an old order: the take-off bit is
//!   withheld until take-off is ordered again.
//! - Navdata whose sequence number is not higher than the last is dropped, unless the drone has evidently
//!   restarted.

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

/// Configuration of a session.
#[derive(Debug, Clone)]
pub struct SessionConfig {
    /// Keys set one after the other when the drone is found, each acknowledged. The first must be
    /// `general:navdata_demo`, which ends the bootstrap mode; [`SessionConfig::new`] ensures this.
    pub settings: Vec<Config>,
    /// Custom configuration to be used. Keys outside the common category need one, except the limits and the
    /// cameras, which the default configuration contains too.
    pub identity: Option<Identity>,
    /// Whether the configuration is read back over the control port before the session is ready.
    pub read_back: bool,
    /// Silence after which navdata are requested again.
    pub wake_up_interval: Duration,
    /// Silence after which the link counts as lost. The drone's own limit is 2 s.
    pub loss_timeout: Duration,
    /// Timeout of a take-off, after which its order is withdrawn.
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
    /// A configuration whose settings begin with those of [`NavdataMode`]; other fields have their defaults.
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

/// Event queue capacity; preallocated, because a tick must not allocate.
const EVENTS: usize = 32;
/// Silence after which the drone may have restarted unnoticed, so it must not be sent anything that lifts it.
const UNHEARD: Duration = Duration::from_millis(300);
/// Packets that arrive within this time after a silence may have been delayed since before a restart.
const HELD_UP: Duration = Duration::from_millis(100);

/// Time within which a drone that receives a landing order begins to land.
const DISOBEYED: Duration = Duration::from_millis(500);

/// The client's order for one tick.
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

/// Take-off and landing level of an order.
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

/// An event of a session.
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
    /// All settings are applied: the drone may fly.
    Ready,
    /// No navdata for the loss timeout.
    LinkLost,
    /// The drone has restarted: its state is reset, take-off orders are withdrawn.
    DroneRestarted,
    /// The drone has left the ground.
    Airborne,
    /// The drone is on the ground again.
    Landed,
    /// The drone has not left the ground within the take-off timeout.
    TakeOffTimedOut,
    /// The emergency bit rose: the motors are cut.
    Emergency,
    /// The emergency bit fell.
    EmergencyCleared,
}

/// Result of handling a navdata datagram.
#[derive(Debug, Clone, PartialEq)]
pub enum Received {
    /// New navdata.
    Navdata(Navdata),
    /// A packet that is older than the last one, or a repetition of it.
    Stale,
    /// A damaged packet.
    Damaged(NavdataError),
}

/// Counters of a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Statistics {
    /// Packets accepted.
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
    /// Requested changes of settings, and the handshake of the first of them.
    changes: VecDeque<Config>,
    change: Option<Handshake>,
    sequence: SequenceNumbers,
    state: DroneState,
    last_navdata: Option<Heard>,
    last_wake_up: Option<Duration>,
    flat_trim_due: bool,
    take_off: TakeOffLatch,
    /// Start of a take-off order to a drone on the ground.
    taking_off_since: Option<Duration>,
    /// Start of a landing order to a drone in the air, and whether it has begun to land.
    landing_since: Option<Duration>,
    lands: bool,
    /// The final landing orders have begun, see [`Session::part`].
    parts: bool,
    emergency: EmergencySwitch,
    events: VecDeque<Event>,
    statistics: Statistics,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Link {
    /// No navdata yet, or none since a loss.
    Silent,
    Alive,
}

/// Assigns sequence numbers to commands.
#[derive(Debug, Clone, Copy)]
struct SequenceNumbers {
    next: u32,
    /// The greatest number used.
    greatest: u32,
    /// The drone has shown that it receives our commands.
    confirmed: bool,
}

impl SequenceNumbers {
    const FIRST: u32 = 1;

    fn new() -> Self {
        Self { next: Self::FIRST, greatest: 0, confirmed: false }
    }

    /// Starts a datagram. Until the drone has confirmed our numbering it may still expect numbers above those
    /// of another client, and the datagram that resets them may be lost.
    fn begin_datagram(&mut self) {
        self.next = match self.greatest.checked_add(1) {
            Some(next) if self.confirmed => next,
            _ => Self::FIRST,
        };
    }

    /// Skips beyond any number that another client may have reached. Number 1 would be accepted as well, but
    /// so would any delayed old datagram after it.
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
    /// End of the last silence, while packets may still have been delayed since before it.
    returned_at: Option<Duration>,
}

impl Heard {
    /// The same for a packet that arrives now.
    fn returned_at(&self, now: Duration) -> Option<Duration> {
        if now.saturating_sub(self.at) >= UNHEARD {
            return Some(now);
        }
        self.returned_at.filter(|at| now.saturating_sub(*at) < HELD_UP)
    }
}

/// State of the take-off bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TakeOffLatch {
    /// The bit follows the orders.
    Follow { airborne: bool },
    /// An event has invalidated all older orders: the bit stays down until landing and then take-off are
    /// ordered again.
    Withheld { landing_ordered: bool },
}

impl Session {
    /// A session that has not received anything yet.
    pub fn new(mut config: SessionConfig) -> Self {
        if let Some(identity) = config.identity {
            // The first key ends the bootstrap mode; the keys of the identity follow it.
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

    /// Handles a datagram from the drone's navdata port.
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
            // The drone has lost its client and waits to be configured again.
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

    /// Changes one more key once the session is ready and earlier requests are complete; it replaces an
    /// earlier value. The result is [`Event::Configured`] or [`Event::ConfigurationTimedOut`]. From then on
    /// it is one of the settings, which are applied again after a loss or a restart.
    pub fn request_setting(&mut self, config: Config) {
        self.changes.push_back(config);
    }

    /// Applies all settings again, because another client may have changed them. The session is not ready until
    /// this is complete.
    pub fn configure_again(&mut self) {
        self.handshake = self.new_handshake();
    }

    /// Checks the acknowledge bit for the setting that is being changed.
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

    /// Adds a setting to those that are applied when the drone is found.
    fn keep(&mut self, config: Config) {
        match self.config.settings.iter_mut().rfind(|other| other.key() == config.key()) {
            Some(other) => *other = config,
            None => self.config.settings.push(config),
        }
    }

    /// A handshake for all settings, including requested changes.
    fn new_handshake(&mut self) -> Handshake {
        self.change = None;
        while let Some(config) = self.changes.pop_front() {
            self.keep(config);
        }
        Handshake::new(self.config.settings.len(), self.config.read_back)
    }

    /// Command for settings in this tick, if any.
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

    /// Handles bytes from the drone's control port.
    pub fn handle_control(&mut self, bytes: &[u8]) {
        self.handshake.handle_control(bytes, &mut self.events);
    }

    /// Fills `datagram` with this tick's commands: REF, PCMD, and commands for settings. It stays empty until
    /// navdata arrive, because the drone may already be flying: any REF would land it or compete with its
    /// pilot. A REF that could lift the drone is left out while the drone is silent.
    ///
    /// # Errors
    /// Never in practice: the commands of one tick are shorter than a datagram, whatever the settings. The
    /// error is returned rather than hidden.
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
        // In the air the drone is not level, so flat trim would set a wrong reference.
        let flies = self.state.contains(DroneState::FLYING);
        if std::mem::take(&mut self.flat_trim_due) && !flies {
            self.push(datagram, &Command::FlatTrim)?;
        }
        if self.link == Link::Alive
            && let Some(command) = self.setting_command(now)
        {
            // The identity applies to the next command.
            if let (Command::Config(_), Some(identity)) = (&command, self.config.identity) {
                self.push(datagram, &Command::ConfigIds(identity))?;
            }
            self.push(datagram, &command)?;
        }
        Ok(())
    }

    /// A tick without a datagram, for a drone that another pilot flies: its silence is still detected.
    pub fn idle(&mut self, now: Duration) {
        self.watch_silence(now);
    }

    /// Fills `datagram` with a final landing order and centred sticks, for a program that is about to exit. A
    /// requested cut of the motors continues. The datagram stays empty if nothing was ever sent to this
    /// drone, because another client may fly it.
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

    /// Whether anything was ever sent to the drone.
    pub fn has_spoken(&self) -> bool {
        self.sequence.greatest > 0
    }

    /// Whether [`crate::WAKE_UP`] must be sent to the navdata port now.
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

    /// Sets the level reference in the next tick. The drone must stand on level ground.
    pub fn request_flat_trim(&mut self) {
        self.flat_trim_due = true;
    }

    /// Cuts the motors at once, wherever the drone is: **it falls**. Repeated until the drone reports that
    /// they are cut.
    pub fn request_emergency_stop(&mut self) {
        self.withhold_take_off();
        self.emergency.request(EmergencyWish::Stop);
    }

    /// Clears an emergency so that the drone can fly again. Use it only on the ground, after a person has
    /// inspected the drone.
    pub fn request_emergency_reset(&mut self) {
        self.emergency.request(EmergencyWish::Reset);
    }

    /// The next event, oldest first.
    pub fn poll_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Whether the drone is connected and configured.
    pub fn is_ready(&self) -> bool {
        self.link == Link::Alive && self.handshake.is_done()
    }

    /// Whether the drone is connected.
    pub fn is_alive(&self) -> bool {
        self.link == Link::Alive
    }

    /// The state bits of the newest packet.
    pub fn state(&self) -> DroneState {
        self.state
    }

    /// Time since the newest packet; `None` if there was none.
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
                // The drone obeys the take-off order, so it receives our commands.
                self.sequence.confirmed |= self.taking_off_since.is_some();
                self.events.push_back(Event::Airborne);
            }
            // With its motors cut it falls instead of landing.
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
                // It has flown and landed: the order to fly is used up.
                self.withhold_take_off();
            }
        }
    }

    /// A silent drone may have restarted and stand on the ground: commands that could lift it are left out.
    /// One that still flies sees this as a lost datagram.
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

    /// Withdraws a take-off that does not happen in time.
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

    /// Detects a drone that flies on although landing is ordered: it may accept only numbers above those of
    /// another client.
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

/// The keys that select or create the configurations of an identity.
fn custom_settings(identity: Identity) -> [Config; 3] {
    [
        ("custom:session_id", identity.session),
        ("custom:profile_id", identity.user),
        ("custom:application_id", identity.application),
    ]
    .map(|(key, id)| Config::plain(key, Identity::text(id)))
}

/// Whether a packet with a lower sequence number shows a restart rather than a late or repeated packet. After
/// a restart the drone is in bootstrap mode, or counts from the very start, and there was a silence while it
/// started; old packets that are repeated among new ones come without a silence.
fn has_restarted(now: Duration, navdata: &Navdata, last: Heard) -> bool {
    const FIRST_PACKETS: u32 = 3;
    /// Maximum number of packets by which a packet can be overtaken.
    const OVERTAKEN: u32 = 32;
    let behind = last.sequence.saturating_sub(navdata.sequence);
    if behind == 0 || last.returned_at(now).is_none() {
        return false;
    }
    let bootstrapping = navdata.state.contains(DroneState::NAVDATA_BOOTSTRAP);
    // A drone that was already in bootstrap mode may just have had a packet overtaken.
    let is_new = !last.bootstrapping || behind > OVERTAKEN;
    let from_the_start = navdata.sequence <= FIRST_PACKETS && last.sequence > 10 * FIRST_PACKETS;
    bootstrapping && is_new || from_the_start
}

#[cfg(test)]
mod tests;
