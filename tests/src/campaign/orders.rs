//! Checks that operator orders have an effect.

use std::time::Duration;

use autopilot::plan::FlightLimits;
use autopilot::vehicle::{Operator, OperatorOrder, Phase as PilotPhase, Place, TICK};
use mock_drone::firmware::Phase;
use nalgebra::Vector2;

use super::fault::Fault;
use super::injected::{Injected, is_airborne};
use crate::sim::Moment;

/// Time for a drone to land after the order, including its own descent.
const LANDS_WITHIN: Duration = Duration::from_secs(30);
/// Time for a cut order to take effect; it is repeated until it is confirmed.
const CUTS_WITHIN: Duration = Duration::from_millis(1500);
/// Time for a drone to brake and return after a hold order; from then on it is monitored.
const BRAKES_WITHIN: Duration = Duration::from_secs(8);
const HOLDS_FOR: Duration = Duration::from_secs(3);
/// Events within this time before an order may still disturb it.
const BEFORE: Duration = Duration::from_secs(3);
/// Largest motion allowed after that.
const HELD_M: f64 = 1.0;
/// Time for a drone to be close to a manual target.
const GOES_WITHIN: Duration = Duration::from_secs(20);
const NEARLY: f64 = 0.3;
const NEAR_M: f64 = 0.6;
/// Distance from the fence kept under manual control.
const INSIDE_M: f64 = 0.5;

/// The operator's orders and their effects.
#[derive(Debug)]
pub(super) struct Orders {
    all: Vec<(Duration, OperatorOrder)>,
    next: usize,
    limits: FlightLimits,
    last_step: usize,
    lands_for: Option<Duration>,
    cuts_for: Option<Duration>,
    watched: Option<Watched>,
}

/// An order whose effect shows in the drone's position.
#[derive(Debug, Clone, Copy)]
enum Watched {
    Hold { at: Duration, place_m: Option<Vector2<f64>> },
    GoTo { at: Duration, to_m: Vector2<f64>, far_m: f64 },
}

impl Orders {
    pub(super) fn new(
        all: &[(Duration, OperatorOrder)],
        others: &[(Duration, Operator, OperatorOrder)],
        limits: &FlightLimits,
        last_step: usize,
    ) -> Self {
        // Anyone may hold and land. What else others order may have an effect or not, but disturbs.
        let others = others.iter().filter_map(|(at, _, order)| match order {
            OperatorOrder::Present | OperatorOrder::Setpoint(_) => None,
            order if order.is_for_anyone() => Some((*at, order.clone())),
            _ => Some((*at, OperatorOrder::Take)),
        });
        let mut all: Vec<_> = all.iter().cloned().chain(others).collect();
        all.sort_by_key(|(at, _)| *at);
        Self {
            all,
            next: 0,
            limits: *limits,
            last_step,
            lands_for: None,
            cuts_for: None,
            watched: None,
        }
    }

    /// `reached`: the drone hears us now.
    pub(super) fn watch(
        &mut self,
        moment: &Moment,
        injected: &Injected,
        reached: bool,
    ) -> Vec<Fault> {
        let mut faults = Vec::new();
        if injected.is_stalled(moment.now) {
            // Orders are queued while the program is stopped.
            self.watched = None;
            return faults;
        }
        while let Some((at, order)) = self.all.get(self.next).cloned()
            && at <= moment.now
        {
            self.next += 1;
            self.ordered(moment, &order, injected);
        }
        let airborne = is_airborne(&moment.truth);
        for (open, most, order) in
            [(&mut self.lands_for, LANDS_WITHIN, "land"), (&mut self.cuts_for, CUTS_WITHIN, "cut")]
        {
            // A landing is complete on the ground; a take-off ordered later is not part of it.
            *open = open.map(|open| if airborne && reached { open + TICK } else { open });
            if open.is_some_and(|open| open > most) {
                faults.push(Fault::OrderIgnored { order });
                *open = None;
            }
        }
        faults.extend(self.watch_place(moment));
        faults
    }

    fn ordered(&mut self, moment: &Moment, order: &OperatorOrder, injected: &Injected) {
        let Moment { now, truth, status, .. } = moment;
        self.watched = None;
        match order {
            OperatorOrder::Land => _ = self.lands_for.get_or_insert(Duration::ZERO),
            OperatorOrder::Cut if is_airborne(truth) => {
                self.cuts_for.get_or_insert(Duration::ZERO);
            }
            _ => {}
        }
        let lasts = match order {
            OperatorOrder::Hold => BRAKES_WITHIN + HOLDS_FOR,
            _ => GOES_WITHIN,
        };
        let on_the_way = status.step.is_some_and(|step| step > 0 && step < self.last_step);
        let undisturbed = self.all.get(self.next).is_none_or(|(at, _)| *at > *now + lasts)
            && injected.is_quiet(now.saturating_sub(BEFORE), *now + lasts)
            && !injected.has_weak_motor(*now)
            && !injected.has_lied(*now);
        if !on_the_way || !undisturbed || truth.phase != Phase::Flying {
            return;
        }
        self.watched = match *order {
            OperatorOrder::Hold => Some(Watched::Hold { at: *now, place_m: None }),
            OperatorOrder::GoTo(Place { x_m: Some(x_m), y_m: Some(y_m), .. }) => {
                let wanted_m = Vector2::new(x_m, y_m);
                let to_m = self.limits.border.nearest_inside(wanted_m, INSIDE_M);
                let far_m = (to_m - truth.odometry_m).norm();
                Some(Watched::GoTo { at: *now, to_m, far_m })
            }
            _ => None,
        };
    }

    fn watch_place(&mut self, moment: &Moment) -> Option<Fault> {
        let Moment { now, truth, status, .. } = moment;
        if truth.phase != Phase::Flying || status.phase != PilotPhase::Flying {
            self.watched = None;
        }
        let here_m = truth.odometry_m;
        match &mut self.watched {
            Some(Watched::Hold { at, place_m }) if *now >= *at + BRAKES_WITHIN => {
                let held_m = *place_m.get_or_insert(here_m);
                if (here_m - held_m).norm() > HELD_M {
                    self.watched = None;
                    return Some(Fault::OrderIgnored { order: "hold" });
                }
                if *now >= *at + BRAKES_WITHIN + HOLDS_FOR {
                    self.watched = None;
                }
            }
            Some(Watched::GoTo { at, to_m, far_m }) if *now >= *at + GOES_WITHIN => {
                let left_m = (*to_m - here_m).norm();
                let ignored = left_m > *far_m * NEARLY + NEAR_M;
                self.watched = None;
                return ignored.then_some(Fault::OrderIgnored { order: "go to" });
            }
            _ => {}
        }
        None
    }
}
