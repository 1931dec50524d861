//! How far outside the fence the drone may be, and how far it is.

use std::time::Duration;

use ardrone_link::navdata::DroneState;
use autopilot::plan::FlightLimits;
use mock_drone::firmware::Phase;
use mock_drone::{Drone, Truth};

use super::injected::{Injected, is_airborne};
use crate::alone;
use crate::sim::Moment;

/// Distance allowed with a working link and correct sensors.
const MARGIN_M: f64 = 0.5;
/// Distance allowed with sensors that are or were wrong.
const LYING_MARGIN_M: f64 = 3.0;
/// Time for which the last sticks still act after navdata stop: the age of navdata must be noticed, and the
/// order to hover must arrive.
const REACTION: Duration = Duration::from_millis(500);
/// Interval at which the prediction of an uncontrolled drone is repeated: the wind may have changed.
const AGAIN: Duration = Duration::from_secs(1);
/// Time within which too strong a wind must be noticed and the landing order must arrive.
const RESISTS_FOR: Duration = Duration::from_secs(5);
/// Predicted height below which an uncontrolled drone may hit the floor. The last order may arrive a little
/// later than the prediction assumes.
const NEAR_FLOOR_M: f64 = 0.1;
/// Time for a drone to come to rest after it is under control again.
const IN_HAND: Duration = Duration::from_secs(2);

/// Why the drone is not under control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct OutOfHand {
    /// The drone does not receive us, acts by itself, or obeys another pilot.
    unheard: bool,
    /// We do not receive the drone.
    unseen: bool,
}

/// The fence as judged.
#[derive(Debug)]
pub(super) struct Fence {
    limits: FlightLimits,
    out_of_hand: OutOfHand,
    looked_at: Option<Duration>,
    out_of_hand_at: Option<Duration>,
    allowed_m: f64,
    /// Whether the drone was inside, as far as can be expected, when its own landing began.
    within: bool,
    /// It may come down on the floor by itself.
    pub(super) may_meet_floor: bool,
    /// The wind is too strong for the airframe, or the drone is still outside because of it.
    blown: bool,
    /// Largest distance outside, corrected by the error of healthy sensors.
    pub(super) outside_m: f64,
    /// First time outside by more than allowed; the largest distance, and the distance allowed then.
    pub(super) worst: Option<(Duration, f64, f64)>,
}

impl Fence {
    pub(super) fn new(limits: &FlightLimits) -> Self {
        Self {
            limits: *limits,
            out_of_hand: OutOfHand::default(),
            looked_at: None,
            out_of_hand_at: None,
            allowed_m: 0.0,
            within: true,
            may_meet_floor: false,
            blown: false,
            outside_m: 0.0,
            worst: None,
        }
    }

    pub(super) fn ceiling_m(&self) -> f64 {
        self.limits.ceiling_m
    }

    /// Distance outside, corrected by the error of healthy sensors, which cannot be known in flight.
    fn outside_m(&self, truth: &Truth) -> f64 {
        let across_m = self.limits.border.outside_m(truth.position_m.xy());
        let above_m = truth.position_m.z - self.limits.ceiling_m;
        across_m.max(above_m) - truth.drift_m().norm()
    }

    /// Whether it is truly outside.
    pub(super) fn is_outside(&self, truth: &Truth) -> bool {
        self.outside_m(truth) > 0.0
    }

    /// `overpowered`: the wind is too strong for the airframe.
    pub(super) fn watch(
        &mut self,
        moment: &Moment,
        drone: &Drone,
        injected: &Injected,
        overpowered: bool,
    ) {
        let Moment { now, truth, .. } = moment;
        self.look(*now, truth, drone, injected);
        let outside_m = self.outside_m(truth);
        let blown = matches!(truth.phase, Phase::Flying | Phase::Landing)
            && (overpowered || self.blown && outside_m > 0.0);
        if blown && !self.blown {
            // It is carried off, but must not go further than a drone that is landed in time.
            let alone = self.left_alone(drone, |see| {
                alone::flies_on_and_lands(drone, RESISTS_FOR, see);
            });
            self.allowed_m = self.allowed_m.max(alone.outside_m);
        }
        self.blown = blown;
        let in_hand = self.out_of_hand_at.is_none_or(|at| now.saturating_sub(at) > IN_HAND);
        if in_hand {
            self.may_meet_floor = false;
            if outside_m <= 0.0 && !blown {
                self.allowed_m = 0.0;
            }
        }
        self.outside_m = self.outside_m.max(outside_m);
        let margin_m = if injected.has_lied(*now) {
            // A drifting velocity cannot be distinguished from rising wind.
            LYING_MARGIN_M + injected.velocity_drift_m(*now)
        } else {
            MARGIN_M
        };
        let allowed_m = self.allowed_m + margin_m;
        if outside_m <= allowed_m || !is_airborne(truth) {
            return;
        }
        let (at, most_m, _) = self.worst.unwrap_or((*now, 0.0, 0.0));
        if outside_m > most_m {
            self.worst = Some((at, outside_m, allowed_m));
        }
    }

    /// When control is lost, predicts how far the drone goes.
    fn look(&mut self, now: Duration, truth: &Truth, drone: &Drone, injected: &Injected) {
        let silence = truth.heard_at.map(|at| now.saturating_sub(at));
        let lands_by_itself = truth.phase == Phase::Landing
            && (truth.battery_percent <= 8.5 || silence > Some(Duration::from_secs(2)));
        let unheard = injected.is_cut_up(now)
            || lands_by_itself
            || truth.phase == Phase::Emergency
            || truth.phase == Phase::Landed && truth.position_m.z > 0.0
            || injected.second_pilot(now, Duration::ZERO)
            // Without plausible navdata the drone's own hover and landing are the right response.
            || injected.claims_no_floor(now)
            || injected.claims(now, DroneState::ULTRASOUND_DEAF)
            || injected.worthless_for(now) > Duration::ZERO;
        // The drone's own landing drifts with the wind.
        let unheard = unheard || truth.phase == Phase::Landing && self.within;
        self.within = self.outside_m(truth) <= MARGIN_M && truth.phase != Phase::Landing
            || self.within && truth.phase == Phase::Landing;
        let before = self.out_of_hand;
        self.out_of_hand = OutOfHand { unheard, unseen: injected.is_cut_down(now) };
        if self.out_of_hand == OutOfHand::default() {
            return;
        }
        self.out_of_hand_at = Some(now);
        let begins = self.out_of_hand != before;
        let again = self.looked_at.is_none_or(|at| now.saturating_sub(at) >= AGAIN);
        // A drone that we do not receive is still commanded, so later excursions are the pilot's own.
        if begins || unheard && again {
            self.looked_at = Some(now);
            let alone = self.left_alone(drone, |see| {
                alone::flies_on_and_lands(drone, REACTION, &mut *see);
                if unheard {
                    alone::unheard(drone, see);
                }
            });
            self.allowed_m = self.allowed_m.max(alone.outside_m);
            self.may_meet_floor |= alone.meets_floor;
        }
    }

    /// How far an uncontrolled drone goes, considering several courses.
    fn left_alone(&self, drone: &Drone, leave: impl FnOnce(&mut dyn FnMut(&Truth))) -> Alone {
        let contacts = drone.truth().floor_contacts;
        let mut alone = Alone::default();
        leave(&mut |other: &Truth| {
            alone.outside_m = alone.outside_m.max(self.outside_m(other));
            let is_near = other.phase == Phase::Flying && other.position_m.z < NEAR_FLOOR_M;
            alone.meets_floor |= other.floor_contacts > contacts || is_near;
        });
        alone
    }
}

/// Predicted course of an uncontrolled drone.
#[derive(Debug, Clone, Copy, Default)]
struct Alone {
    outside_m: f64,
    meets_floor: bool,
}
