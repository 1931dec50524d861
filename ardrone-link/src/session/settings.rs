//! The drone's settings: those applied when it is found, and changes requested while it is in use.

use std::collections::VecDeque;
use std::time::Duration;

use super::Event;
use super::handshake::Handshake;
use crate::at::{Command, Config, Identity};
use crate::navdata::DroneState;

/// Settings and how far the drone has confirmed them.
#[derive(Debug)]
pub(super) struct Settings {
    /// Applied whenever the drone is found.
    all: Vec<Config>,
    identity: Option<Identity>,
    read_back: bool,
    handshake: Handshake,
    /// Requested changes, and the handshake of the first of them.
    changes: VecDeque<Config>,
    change: Option<Handshake>,
}

impl Settings {
    /// Settings that are all still to be applied. The keys of the `identity` are set behind the first of them. With
    /// `read_back` the drone's configuration is read afterwards.
    pub(super) fn new(mut all: Vec<Config>, identity: Option<Identity>, read_back: bool) -> Self {
        if let Some(identity) = identity {
            // The first key ends the bootstrap mode; the keys of the identity follow it.
            let place = all.len().min(1);
            all.splice(place..place, custom_settings(identity));
        }
        let handshake = Handshake::new(all.len(), read_back);
        Self { all, identity, read_back, handshake, changes: VecDeque::new(), change: None }
    }

    /// The identity whose configurations are used; `None` for the default ones.
    pub(super) fn identity(&self) -> Option<Identity> {
        self.identity
    }

    /// Whether each of the settings is acknowledged or given up, and the configuration read back if that was asked for, or
    /// given up too. Requested changes are not awaited.
    pub(super) fn are_applied(&self) -> bool {
        self.handshake.is_done()
    }

    /// Shortest time from a setting to its acknowledgement when all settings were last applied; `None` before the first
    /// acknowledgement.
    pub(super) fn round_trip(&self) -> Option<Duration> {
        self.handshake.round_trip()
    }

    /// Requests a change. Once it is acknowledged or given up, it is one of the settings that are applied again.
    pub(super) fn request(&mut self, config: Config) {
        self.changes.push_back(config);
    }

    /// Begins to apply all settings anew, including requested changes.
    pub(super) fn apply_again(&mut self) {
        self.change = None;
        while let Some(config) = self.changes.pop_front() {
            self.keep(config);
        }
        self.handshake = Handshake::new(self.all.len(), self.read_back);
    }

    /// Checks the acknowledge bit of a new packet; returns whether the drone has acknowledged one of our keys.
    pub(super) fn handle_state(
        &mut self,
        now: Duration,
        state: DroneState,
        events: &mut VecDeque<Event>,
    ) -> bool {
        let acknowledged = self.handshake.handle_state(now, state, &self.all, events);
        let Some(change) = &mut self.change else { return acknowledged };
        let changed = change.handle_state(now, state, self.changes.make_contiguous(), events);
        if change.is_done() {
            self.change = None;
            if let Some(config) = self.changes.pop_front() {
                self.keep(config);
            }
        }
        acknowledged || changed
    }

    /// Collects bytes from the control port, which has the configuration to be read back.
    pub(super) fn handle_control(&mut self, bytes: &[u8], events: &mut VecDeque<Event>) {
        self.handshake.handle_control(bytes, events);
    }

    /// Command for settings in this tick, if any.
    pub(super) fn command(
        &mut self,
        now: Duration,
        state: DroneState,
        events: &mut VecDeque<Event>,
    ) -> Option<Command> {
        if !self.handshake.is_done() {
            return self.handshake.command(now, state, &self.all, events);
        }
        if self.changes.is_empty() {
            return None;
        }
        let change = self.change.get_or_insert_with(Handshake::change);
        change.command(now, state, self.changes.make_contiguous(), events)
    }

    fn keep(&mut self, config: Config) {
        match self.all.iter_mut().rfind(|other| other.key() == config.key()) {
            Some(other) => *other = config,
            None => self.all.push(config),
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
