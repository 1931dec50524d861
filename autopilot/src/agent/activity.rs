//! What the drone is doing, and for how long.

use kinematics::Pose;

/// Activities of the drone whose duration the agent limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pursuit {
    TakingOff,
    Approaching,
    Searching,
    OverTag,
    Staying,
    Descending,
}

/// The drone's current activity and its duration. The agent has no clock of its own and gets these durations
/// as percepts. A hover in between does not end the activity.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Activity {
    /// The activity, and the time of its first command in milliseconds.
    pub(super) pursuit: Option<(Pursuit, i64)>,
    /// Duration of the approach before the target was last reached. Without it, a drone that keeps reaching
    /// its target and drifting away would never exceed the time limit.
    pub(super) approached_ms: i64,
    /// Duration of the stay before it was interrupted by a search for a tag.
    stayed_ms: i64,
    /// Where it stays, or comes down, or where the course of its setpoints has got to.
    place: Option<Pose>,
    /// Time of the last command of a search, in milliseconds.
    searched_ms: Option<i64>,
    /// A take-off that was broken off on the ground: when it began and when that was, in milliseconds.
    broken_off_ms: Option<(i64, i64)>,
}

/// A take-off that is ordered again so soon goes on, in milliseconds: another mission begins with one, and a drone that waits for
/// its place does not wait longer for that.
const AT_ONCE_MS: i64 = 200;

impl Activity {
    /// Duration of this activity in milliseconds; 0 if another one is current.
    pub(super) fn lasted_ms(self, pursuit: Pursuit, now_ms: i64) -> i64 {
        let Some((current, since_ms)) = self.pursuit else { return 0 };
        let lasted_ms = now_ms.saturating_sub(since_ms);
        match pursuit {
            _ if current != pursuit => 0,
            Pursuit::Approaching => lasted_ms.saturating_add(self.approached_ms),
            Pursuit::Staying => lasted_ms.saturating_add(self.stayed_ms),
            Pursuit::TakingOff | Pursuit::Searching | Pursuit::OverTag | Pursuit::Descending => {
                lasted_ms
            }
        }
    }

    /// Whether the agent is coming down to land.
    pub(crate) fn is_descending(&self) -> bool {
        self.pursuit.is_some_and(|(pursuit, _)| pursuit == Pursuit::Descending)
    }

    /// The place at which the drone, which is at `pose`, is to stay if it is told to stay where it is. A drone that
    /// stays somewhere, or is on its way back there after braking, is there: otherwise each order to hold would
    /// begin the hold anew at the place to which the drone has moved meanwhile, and many of them would let it go on.
    pub(super) fn place_to_stay(&self, pose: &Pose) -> Pose {
        match (self.pursuit, self.place) {
            (Some((Pursuit::Staying, _)), Some(place)) => place,
            // A course leads across only: the height and the heading of a setpoint may be far away.
            (None, Some(place)) => Pose { x_m: place.x_m, y_m: place.y_m, ..*pose },
            // How high it is decides when it is down.
            (Some((Pursuit::Descending, _)), Some(place)) => Pose { z_m: pose.z_m, ..place },
            _ => *pose,
        }
    }

    /// Takes in the place of the activity that was just begun or continued.
    pub(super) fn stays_at(&mut self, place: Pose) {
        self.place = Some(place);
    }

    /// Whether the drone stays at a place.
    pub(crate) fn stays(&self) -> bool {
        self.pursuit.is_some_and(|(pursuit, _)| pursuit == Pursuit::Staying)
    }

    /// Time since the last search for a tag in milliseconds.
    pub(super) fn searched_ago_ms(&self, now_ms: i64) -> i64 {
        self.searched_ms.map_or(i64::MAX, |at_ms| now_ms.saturating_sub(at_ms))
    }

    /// Ends the activity.
    pub(super) fn end(&mut self) {
        *self = Self { searched_ms: self.searched_ms, ..Self::default() };
    }

    /// Ends the activity on the ground.
    pub(super) fn stand_by(&mut self, now_ms: i64) {
        let broken_off_ms = match self.pursuit {
            Some((Pursuit::TakingOff, since_ms)) => Some((since_ms, now_ms)),
            _ => self.broken_off_ms,
        };
        self.end();
        self.broken_off_ms = broken_off_ms;
    }

    pub(super) fn go_on(&mut self, pursuit: Pursuit, now_ms: i64) {
        if pursuit == Pursuit::Searching {
            self.searched_ms = Some(now_ms);
        }
        let current = self.pursuit.map(|(current, _)| current);
        if current == Some(pursuit) {
            return;
        }
        if current == Some(Pursuit::Approaching) {
            self.approached_ms = self.lasted_ms(Pursuit::Approaching, now_ms);
        }
        if current == Some(Pursuit::Staying) {
            let goes_on = pursuit == Pursuit::Searching;
            self.stayed_ms = if goes_on { self.lasted_ms(Pursuit::Staying, now_ms) } else { 0 };
        }
        let broken_off_ms = self.broken_off_ms.take().filter(|(_, at_ms)| {
            pursuit == Pursuit::TakingOff && now_ms.saturating_sub(*at_ms) <= AT_ONCE_MS
        });
        self.pursuit = Some((pursuit, broken_off_ms.map_or(now_ms, |(since_ms, _)| since_ms)));
        self.place = None;
    }
}
