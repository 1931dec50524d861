//! Setpoints and sticks of operators: what came last, and whose are followed.

use std::time::Duration;

use autopilot::vehicle::{Operator, Setpoint};

use super::setpoints::Joystick;
use crate::dialect::MANUAL_CONTROL_DATA;

/// A setpoint that is older is none.
const SETPOINT_TIME: Duration = Duration::from_millis(500);
/// Sticks that have been silent for so long must be seen in the middle again.
const STICKS_TIME: Duration = Duration::from_secs(1);
/// The same setpoint again is not passed on sooner than this; the vehicle decides no faster.
const SETPOINT_EVERY: Duration = Duration::from_millis(20);
/// Setpoints that are refused are told no more often than this.
const TELL_EVERY: Duration = Duration::from_secs(2);

/// By what an operator moves the drone all the time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// `SET_POSITION_TARGET_*`.
    Setpoints,
    /// `MANUAL_CONTROL`.
    Sticks,
}

/// The last that an operator sent.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Latest {
    at: Duration,
    by: Operator,
    setpoint: Setpoint,
}

/// What operators send all the time, and whom the drone follows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Following {
    setpoint: Option<Latest>,
    sticks: Option<Latest>,
    joystick: Joystick,
    /// What is followed and whose, or was until it stopped.
    followed: Option<(Source, Operator)>,
    refusal_told: Option<Duration>,
}

impl Following {
    /// A setpoint has come. Returns whether it is to be followed.
    pub(super) fn take_setpoint(
        &mut self,
        now: Duration,
        by: Operator,
        setpoint: Setpoint,
    ) -> bool {
        let latest = Latest { at: now, by, setpoint };
        let followed = self.followed;
        take(&mut self.setpoint, latest, Source::Setpoints, followed)
    }

    /// Sticks have come. Returns what they ask for if it is to be followed.
    pub(super) fn take_sticks(
        &mut self,
        now: Duration,
        by: Operator,
        data: &MANUAL_CONTROL_DATA,
    ) -> Option<Setpoint> {
        if self.sticks.is_none_or(|last| now.saturating_sub(last.at) >= STICKS_TIME) {
            self.joystick = Joystick::default();
        }
        let setpoint = self.joystick.setpoint(data);
        let latest = Latest { at: now, by, setpoint };
        let followed = self.followed;
        take(&mut self.sticks, latest, Source::Sticks, followed).then_some(setpoint)
    }

    /// What an operator sent last, if that was just now.
    pub(super) fn fresh(&self, now: Duration, source: Source, by: Operator) -> Option<Setpoint> {
        let last = match source {
            Source::Setpoints => self.setpoint,
            Source::Sticks => self.sticks,
        };
        last.filter(|last| last.by == by && now.saturating_sub(last.at) <= SETPOINT_TIME)
            .map(|last| last.setpoint)
    }

    /// What is followed and whose.
    pub(super) fn followed(&self) -> Option<(Source, Operator)> {
        self.followed
    }

    /// From now on this is followed, or nothing.
    pub(super) fn follow(&mut self, followed: Option<(Source, Operator)>) {
        self.followed = followed;
    }

    /// Whether a setpoint's refusal is to be told: now and then.
    pub(super) fn tells_refusal(&mut self, now: Duration) -> bool {
        let tells = self.refusal_told.is_none_or(|at| now.saturating_sub(at) >= TELL_EVERY);
        if tells {
            self.refusal_told = Some(now);
        }
        tells
    }
}

/// Takes what has come in place of the last, unless that is somebody else's and followed. Returns whether it is to be
/// followed.
fn take(
    last: &mut Option<Latest>,
    latest: Latest,
    source: Source,
    followed: Option<(Source, Operator)>,
) -> bool {
    let follows = followed.filter(|(by_what, _)| *by_what == source).map(|(_, by)| by);
    if follows.is_some_and(|by| by != latest.by) {
        return false;
    }
    let repeated = last.is_some_and(|last| {
        last.by == latest.by
            && last.setpoint == latest.setpoint
            && latest.at.saturating_sub(last.at) < SETPOINT_EVERY
    });
    if repeated {
        return false;
    }
    *last = Some(latest);
    follows.is_some()
}

#[cfg(test)]
mod tests {
    use autopilot::vehicle::{Heading, Horizontal, Station, Vertical};

    use super::*;

    const ONE: Operator = Operator { station: Station::Mavlink, number: 0xff_be, local: true };
    const OTHER: Operator = Operator { number: 0xfe_be, ..ONE };

    fn to(x_m: f64) -> Setpoint {
        Setpoint {
            horizontal: Horizontal::Place { x_m, y_m: 0.0 },
            vertical: Vertical::Climb(0.0),
            heading: Heading::Keep,
        }
    }

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn only_the_fresh_ones_of_an_operator_can_be_followed() {
        let mut following = Following::default();
        assert!(!following.take_setpoint(ms(0), ONE, to(1.0)), "nobody is followed yet");
        assert_eq!(following.fresh(ms(500), Source::Setpoints, ONE), Some(to(1.0)));
        assert_eq!(following.fresh(ms(501), Source::Setpoints, ONE), None);
        assert_eq!(following.fresh(ms(500), Source::Setpoints, OTHER), None);
        assert_eq!(following.fresh(ms(500), Source::Sticks, ONE), None);
    }

    #[test]
    fn those_of_another_take_no_place() {
        let mut following = Following::default();
        following.follow(Some((Source::Setpoints, ONE)));
        assert!(following.take_setpoint(ms(0), ONE, to(1.0)));
        assert!(!following.take_setpoint(ms(30), OTHER, to(2.0)));
        assert_eq!(following.fresh(ms(30), Source::Setpoints, ONE), Some(to(1.0)));
        assert!(following.take_setpoint(ms(60), ONE, to(3.0)));
        // Sticks are another source.
        let centred = MANUAL_CONTROL_DATA { z: 500, ..MANUAL_CONTROL_DATA::default() };
        assert_eq!(following.take_sticks(ms(60), OTHER, &centred), None);
        assert!(following.fresh(ms(60), Source::Sticks, OTHER).is_some());
    }

    #[test]
    fn the_same_again_is_not_passed_on_at_once() {
        let mut following = Following::default();
        following.follow(Some((Source::Setpoints, ONE)));
        assert!(following.take_setpoint(ms(0), ONE, to(1.0)));
        assert!(!following.take_setpoint(ms(19), ONE, to(1.0)));
        assert!(following.take_setpoint(ms(19), ONE, to(2.0)));
        assert!(following.take_setpoint(ms(39), ONE, to(2.0)));
        following.follow(Some((Source::Sticks, ONE)));
        let centred = MANUAL_CONTROL_DATA { z: 500, ..MANUAL_CONTROL_DATA::default() };
        assert!(following.take_sticks(ms(0), ONE, &centred).is_some());
        assert!(following.take_sticks(ms(19), ONE, &centred).is_none());
        assert!(following.take_sticks(ms(20), ONE, &centred).is_some());
    }

    #[test]
    fn sticks_that_were_silent_are_centred_again() {
        let mut following = Following::default();
        following.follow(Some((Source::Sticks, ONE)));
        let mut climb = |at, z| {
            let data = MANUAL_CONTROL_DATA { z, ..MANUAL_CONTROL_DATA::default() };
            following.take_sticks(ms(at), ONE, &data).map(|setpoint| setpoint.vertical)
        };
        assert_eq!(climb(0, 500), Some(Vertical::Climb(0.0)));
        assert_eq!(climb(100, 1000), Some(Vertical::Climb(0.5)));
        assert_eq!(climb(1099, 1000), Some(Vertical::Climb(0.5)));
        assert_eq!(climb(2099, 1000), Some(Vertical::Climb(0.0)));
    }

    #[test]
    fn refusals_are_told_now_and_then() {
        let mut following = Following::default();
        let told = [0, 1999, 2000, 2001].map(|at| following.tells_refusal(ms(at)));
        assert_eq!(told, [true, false, true, false]);
    }
}
