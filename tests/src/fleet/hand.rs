//! Whether the pilot of a vehicle can steer its drone at all: whom it meets while it cannot is counted apart.

use std::time::Duration;

use autopilot::vehicle::TICK;
use mock_drone::Truth;
use mock_drone::firmware::Phase;

use crate::campaign::Injected;

/// Who has not heard the other for this long: the drone flies on as it was ordered last, or as somebody else orders.
const HEARD: Duration = Duration::from_millis(300);
/// Time for a drone to come to rest after it is in hand again.
const AT_REST: Duration = Duration::from_secs(2);
/// A share of the wind that the airframe resists, as in the campaign.
const OVERPOWERS: f64 = 0.9;

/// The faults of a vehicle, and whether they have taken it out of its pilot's hand.
#[derive(Debug)]
pub(super) struct Hand {
    pub(super) injected: Injected,
    strongest_m_s: f64,
    wind_m_s: f64,
    lost_at: Option<Duration>,
    /// It has begun to land while it was out of hand, and cannot be moved until it is down.
    lands: bool,
}

impl Hand {
    pub(super) fn new(injected: Injected, strongest_m_s: f64, wind_m_s: f64) -> Self {
        Self { injected, strongest_m_s, wind_m_s, lost_at: None, lands: false }
    }

    pub(super) fn watch(&mut self, now: Duration, truth: &Truth, navdata_age: Option<Duration>) {
        self.injected.see(truth);
        let is_old = |age: Duration| age > HEARD;
        let is_up = truth.phase != Phase::Landed;
        let unseen = navdata_age.is_some_and(is_old);
        let unheard =
            is_up && truth.heard_at.is_some_and(|at| is_old(truth.time.saturating_sub(at)));
        // A wind acts one tick later.
        let wind_m_s =
            self.injected.wind_m_s(now.saturating_sub(2 * TICK)).unwrap_or(self.wind_m_s);
        let is_lost = unseen
            || unheard
            || truth.phase == Phase::Emergency
            || self.injected.second_pilot(now, Duration::from_secs(1))
            || wind_m_s > OVERPOWERS * self.strongest_m_s;
        if is_lost {
            self.lost_at = Some(now);
        }
        self.lands = truth.phase == Phase::Landing && (self.lands || is_lost);
    }

    /// Whether it is out of hand, or was a moment ago.
    pub(super) fn is_lost(&self, now: Duration) -> bool {
        self.lands || self.lost_at.is_some_and(|at| now <= at + AT_REST)
    }
}
