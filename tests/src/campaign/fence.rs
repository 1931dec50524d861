//! How far outside the fence the drone may be, and how far it is.

use std::time::Duration;

use ardrone_link::navdata::DroneState;
use autopilot::plan::FlightLimits;
use mock_drone::firmware::Phase;
use mock_drone::{Drone, Truth};

use super::injected::{Injected, is_airborne};
use crate::alone;
use crate::sim::Moment;

/// So far outside a drone may be that is heard, hears, and tells the truth.
const MARGIN_M: f64 = 0.5;
/// So far one whose sensors lie or lied.
const LYING_MARGIN_M: f64 = 3.0;
/// Our last sticks are carried out for so long after navdata stop: that they are old has to be noticed,
/// and the order to hover has to arrive.
const REACTION: Duration = Duration::from_millis(500);
/// What is beyond our control is looked at anew in this interval: the wind may have changed.
const AGAIN: Duration = Duration::from_secs(1);
/// A wind that is too strong is to be noticed within this time, and the order to land to arrive.
const RESISTS_FOR: Duration = Duration::from_secs(5);
/// Where a drone is left to itself it may meet the floor if it comes this near: what was said to it last may
/// arrive a little later than is reckoned with here.
const NEAR_FLOOR_M: f64 = 0.1;
/// A drone that is in hand again gets so long to come to rest.
const IN_HAND: Duration = Duration::from_secs(2);

/// Why the drone is not in our hands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct OutOfHand {
    /// It does not hear us, does what it does by itself, or obeys somebody else.
    unheard: bool,
    /// We do not hear it.
    unseen: bool,
}

/// The fence, as the judge sees it.
#[derive(Debug)]
pub(super) struct Fence {
    limits: FlightLimits,
    out_of_hand: OutOfHand,
    looked_at: Option<Duration>,
    out_of_hand_at: Option<Duration>,
    allowed_m: f64,
    /// It was inside, as far as can be asked, when it began to land by itself.
    within: bool,
    /// It may come down on the floor by itself.
    pub(super) may_meet_floor: bool,
    /// In a wind that its airframe does not resist, or still outside because of one.
    blown: bool,
    /// Furthest outside, less what healthy sensors were wrong by.
    pub(super) outside_m: f64,
    /// When it was first outside by more than is allowed; by how much at most, and what was allowed.
    pub(super) worst: Option<(Duration, f64, f64)>,
}

impl Fence {
    pub(super) fn new(limits: FlightLimits) -> Self {
        Self {
            limits,
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

    /// How far outside it is, less what healthy sensors were wrong by: what nobody can know.
    fn outside_m(&self, truth: &Truth) -> f64 {
        let across_m = truth.position_m.xy().norm() - self.limits.radius_m;
        let above_m = truth.position_m.z - self.limits.ceiling_m;
        across_m.max(above_m) - truth.drift_m().norm()
    }

    /// Whether it is outside in truth.
    pub(super) fn is_outside(&self, truth: &Truth) -> bool {
        self.outside_m(truth) > 0.0
    }

    /// `overpowered`: the wind is stronger than the airframe.
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
            // It is carried off: but no further than one that lands in time.
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
            // A velocity that drifts cannot be told from a wind that rises.
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

    /// Where the drone goes out of our hands, looks how far it goes then.
    fn look(&mut self, now: Duration, truth: &Truth, drone: &Drone, injected: &Injected) {
        let silence = truth.heard_at.map(|at| now.saturating_sub(at));
        let lands_by_itself = truth.phase == Phase::Landing
            && (truth.battery_percent <= 8.5 || silence > Some(Duration::from_secs(2)));
        let unheard = injected.is_cut_up(now)
            || lands_by_itself
            || truth.phase == Phase::Emergency
            || truth.phase == Phase::Landed && truth.position_m.z > 0.0
            || injected.second_pilot(now, Duration::ZERO)
            // Where nothing can be believed the drone's own hover and landing are the right answer.
            || injected.claims_no_floor(now)
            || injected.claims(now, DroneState::ULTRASOUND_DEAF)
            || injected.worthless_for(now) > Duration::ZERO;
        // Its own landing drifts with the wind.
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
        // What we do not hear we still command: later excursions are our own.
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

    /// How far a drone goes that is left to itself, in one way or several.
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

/// What becomes of a drone that is left to itself.
#[derive(Debug, Clone, Copy, Default)]
struct Alone {
    outside_m: f64,
    meets_floor: bool,
}
