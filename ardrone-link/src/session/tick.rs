//! One tick: the commands of its datagram, and the timeouts that are checked with it.

use std::time::Duration;

use super::{Event, Link, Order, Session};
use crate::at::{Command, Motion, Ref};
use crate::navdata::DroneState;

/// Time within which a drone that receives a landing order begins to land.
const DISOBEYED: Duration = Duration::from_millis(500);

impl Session {
    /// Fills the datagram: REF, PCMD, and commands for settings.
    pub(super) fn tick(&mut self, now: Duration, order: Order) {
        if self.last_navdata.is_some() {
            self.watch_silence(now);
            self.fly(now, order);
        }
        self.check_wake_up(now);
    }

    /// A tick without a command.
    pub(super) fn listen(&mut self, now: Duration) {
        self.watch_silence(now);
        self.check_wake_up(now);
    }

    fn fly(&mut self, now: Duration, order: Order) {
        let take_off = self.take_off.bit(order.flight);
        self.watch_landing(now, take_off);
        self.sequence.begin_datagram();
        self.watch_take_off(now, take_off);
        let emergency = self.state.contains(DroneState::EMERGENCY);
        let reference = if self.emergency.level(now, emergency) {
            Some(Ref::ToggleEmergency)
        } else if take_off {
            self.last_navdata.is_some_and(|heard| heard.is_fresh(now)).then_some(Ref::TakeOff)
        } else {
            Some(Ref::Land)
        };
        if let Some(reference) = reference {
            self.push(&Command::Ref(reference));
        }
        self.push(&Command::Pcmd(order.motion));
        if self.state.contains(DroneState::COMMUNICATION_WATCHDOG) {
            self.push(&Command::CommunicationWatchdog);
        }
        // In the air the drone is not level, so flat trim would set a wrong reference.
        let flies = self.state.contains(DroneState::FLYING);
        if std::mem::take(&mut self.flat_trim_due) && !flies {
            self.push(&Command::FlatTrim);
        }
        if self.link == Link::Alive
            && let Some(command) = self.settings.command(now, self.state, &mut self.events)
        {
            // The identity applies to the next command.
            if let (Command::Config(_), Some(identity)) = (&command, self.settings.identity()) {
                self.push(&Command::ConfigIds(identity));
            }
            self.push(&command);
        }
    }

    /// Fills the datagram with a final landing order.
    pub(super) fn part(&mut self, now: Duration) {
        if !self.sequence.has_begun() {
            return;
        }
        if !std::mem::replace(&mut self.parts, true) {
            self.sequence.leap();
            self.sequence.contest();
        }
        self.sequence.begin_datagram();
        self.take_off.withhold();
        let emergency = self.state.contains(DroneState::EMERGENCY);
        let cut = self.emergency.level(now, emergency);
        let reference = if cut { Ref::ToggleEmergency } else { Ref::Land };
        self.push(&Command::Ref(reference));
        self.push(&Command::Pcmd(Motion::Hover));
    }

    /// Adds a command to the datagram. The commands of one tick always fit, see the test: the longest is a
    /// setting, whose key and value have at most 256 bytes each.
    fn push(&mut self, command: &Command) {
        let pushed = self.datagram.push(self.sequence.take(), command);
        debug_assert_eq!(pushed, Ok(()), "the commands of one tick are shorter than a datagram");
    }

    fn check_wake_up(&mut self, now: Duration) {
        let heard = self.last_navdata.map(|heard| heard.at);
        let quiet = |since: Option<Duration>| {
            since.is_none_or(|at| now.saturating_sub(at) >= self.timeouts.wake_up)
        };
        if quiet(heard) && quiet(self.last_wake_up) {
            self.last_wake_up = Some(now);
            self.pending.wake_up = true;
        }
    }

    fn watch_silence(&mut self, now: Duration) {
        let Some(heard) = self.last_navdata else { return };
        let lost = now.saturating_sub(heard.at) >= self.timeouts.loss;
        if lost && self.link == Link::Alive {
            self.link = Link::Silent;
            self.events.push_back(Event::LinkLost);
            self.take_off.withhold();
            self.settings.apply_again();
        }
    }

    /// Withdraws a take-off that does not happen in time.
    fn watch_take_off(&mut self, now: Duration, ordered: bool) {
        if !ordered || self.state.contains(DroneState::FLYING) {
            self.taking_off_since = None;
            return;
        }
        let since = *self.taking_off_since.get_or_insert(now);
        if now.saturating_sub(since) >= self.timeouts.take_off {
            self.taking_off_since = None;
            self.events.push_back(Event::TakeOffTimedOut);
            self.take_off.withhold();
        }
    }

    /// Detects a drone that flies on although landing is ordered: it may accept only numbers above those of
    /// another client. First our numbers leap; if that is not enough they are contested until the drone is down.
    fn watch_landing(&mut self, now: Duration, take_off: bool) {
        if take_off || !self.state.contains(DroneState::FLYING) {
            self.landing_since = None;
            self.sequence.settle();
            return;
        }
        if self.lands {
            self.landing_since = None;
            return;
        }
        let since = *self.landing_since.get_or_insert(now);
        if now.saturating_sub(since) >= DISOBEYED {
            self.landing_since = Some(now);
            self.sequence.escalate();
        }
    }
}
