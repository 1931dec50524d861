//! Arming on the ground, and take-offs that wait for it.

use std::time::Duration;

use autopilot::vehicle::{Operator, OperatorOrder, Station as Kind};

use super::MavlinkVehicle;
use super::following::Following;
use super::modes::Mode;
use super::stations::Station;
use crate::dialect::{MavResult, MavSeverity};

/// Auto-disarm timeout on the ground.
const ARMED_TIME: Duration = Duration::from_secs(10);
/// A take-off that was ordered before arming waits for so long.
const PENDING_TIME: Duration = Duration::from_secs(5);

/// What is done when arming follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Then {
    /// Take off, to this height in metres.
    TakeOff { height_m: Option<f64> },
    /// Fly the mission.
    Mission,
}

/// An order that waits for arming.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Pending {
    then: Then,
    station: Station,
    until: Duration,
}

/// The vehicle on the ground, as its clients see it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Arming {
    /// Until when it is armed, and by whom.
    armed: Option<(Duration, Operator)>,
    /// What will be done when it is armed.
    pending: Option<Pending>,
    /// What was ordered when it was armed, until it flies.
    begun: Option<Then>,
    /// Who has the controls, as long as that is known better than by the vehicle's last status.
    pub(super) controls: Option<Controls>,
}

/// An operator who has the controls, or nobody.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Controls(Option<Operator>);

impl Arming {
    /// Somebody else has taken the controls, who does not expect that a take-off follows.
    pub(super) fn of_another(by: Operator) -> Self {
        Self { controls: Some(Controls(Some(by))), ..Self::default() }
    }

    pub(super) fn is_armed(&self) -> bool {
        self.armed.is_some()
    }

    /// What waits for arming is given up.
    pub(super) fn give_up(&mut self) {
        self.pending = None;
        self.begun = None;
    }

    /// What was ordered when it was armed was refused.
    pub(super) fn not_begun(&mut self) {
        self.begun = None;
    }

    /// The mode of what waits for arming, or was ordered and does not fly yet.
    pub(super) fn begins(&self) -> Option<Mode> {
        let then = self.pending.map(|pending| pending.then).or(self.begun)?;
        Some(match then {
            Then::TakeOff { .. } => Mode::TakeOff,
            Then::Mission => Mode::Mission,
        })
    }
}

impl MavlinkVehicle {
    /// The operator who has the controls.
    pub(super) fn holder(&self) -> Option<Operator> {
        match self.arming.controls {
            Some(Controls(holder)) => holder,
            None => self.present().and_then(|status| status.controls),
        }
    }

    /// An operator has armed the vehicle: what waited for it is done.
    pub(super) fn armed_by(&mut self, now: Duration, by: Operator) {
        self.arming.armed = Some((now + ARMED_TIME, by));
        self.arming.controls = Some(Controls(Some(by)));
        let [system, component] = by.number.to_be_bytes();
        let info = MavSeverity::MAV_SEVERITY_INFO;
        self.say(info, format_args!("armed by station {system}.{component}"));
        // Whoever takes the controls does not expect that another's take-off follows.
        let pending = self.arming.pending.take();
        if let Some(pending) = pending.filter(|pending| pending.station.operator() == by) {
            self.do_then(now, pending.station, None, pending.then);
        }
    }

    /// Does it now if armed, or when arming follows soon.
    pub(super) fn when_armed(&mut self, now: Duration, station: Station, command: u16, then: Then) {
        if self.arming.is_armed() {
            self.do_then(now, station, Some(command), then);
            return;
        }
        let until = now + PENDING_TIME;
        self.arming.pending = Some(Pending { then, station, until });
        self.acknowledge(station, command, MavResult::MAV_RESULT_ACCEPTED);
    }

    fn do_then(&mut self, now: Duration, station: Station, command: Option<u16>, then: Then) {
        self.arming.begun = Some(then);
        match then {
            Then::TakeOff { height_m } => self.take_off(now, station, command, height_m),
            Then::Mission => self.fly_mission(now, station, command),
        }
    }

    pub(super) fn disarm(&mut self) {
        let armed = self.arming.armed.take();
        self.arming.give_up();
        self.following = Following::default();
        match armed {
            Some((_, by)) => self.release_of(by),
            None => self.release(),
        }
    }

    /// Whoever has the controls by `MAVLink` gives them back.
    pub(super) fn release(&mut self) {
        if let Some(holder) = self.holder()
            && holder.station == Kind::Mavlink
        {
            self.release_of(holder);
        }
    }

    fn release_of(&mut self, holder: Operator) {
        self.order_quietly(holder, OperatorOrder::Release);
        self.arming.controls = Some(Controls(self.holder().filter(|other| *other != holder)));
    }

    /// Neither arming nor a take-off that waits for it lasts.
    pub(super) fn watch_arming(&mut self, now: Duration) {
        if self.arming.pending.is_some_and(|pending| now >= pending.until) {
            self.arming.give_up();
            self.error(format_args!("not armed in time: the take-off is given up"));
        }
        if self.arming.armed.is_some_and(|(until, _)| now >= until) {
            self.warn(format_args!("disarmed: no take-off followed"));
            self.disarm();
        }
    }
}
