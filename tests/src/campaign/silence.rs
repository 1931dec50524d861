//! Judges what is flown for a ground station that may have disappeared.

use std::time::Duration;

use autopilot::vehicle::{Operator, OperatorOrder, Phase as PilotPhase};
use mock_drone::Truth;
use mock_drone::firmware::Phase;
use nalgebra::Vector2;

use super::fault::Fault;
use super::injected::Injected;
use super::station::STATION;
use crate::sim::Moment;

/// After such a silence of the station that has the controls nothing is flown on.
const STATION_HOLDS: Duration = Duration::from_secs(10);
/// After such a silence the drone is landed.
const STATION_LANDS: Duration = Duration::from_secs(20);
/// Setpoints of this age are not flown on.
const SETPOINT_HOLDS: Duration = Duration::from_millis(500);
/// At this age of the last one the drone is landed.
const SETPOINT_LANDS: Duration = Duration::from_millis(10_500);
/// Time for an order to hold to arrive.
const ON_ITS_WAY: Duration = Duration::from_millis(300);
/// Time for a drone to brake and return; from then on it may hardly move.
const BRAKES_WITHIN: Duration = Duration::from_secs(6);
/// Time in which it may hardly move; gusts carry it further in the long run.
const HOLDS_FOR: Duration = Duration::from_secs(4);
/// Largest motion allowed after that, and besides braking.
const HELD_M: f64 = 1.0;
/// Deceleration that each airframe reaches against the wind, and the time until it begins.
const BRAKING_M_S2: f64 = 0.6;
const REACTION_S: f64 = 0.8;
/// Faults within this time before now may still disturb a hold.
const BEFORE: Duration = Duration::from_secs(3);

/// A drone that must hold, because nobody may be there any more.
#[derive(Debug, Clone, Copy)]
struct Hold {
    since: Duration,
    from_m: Vector2<f64>,
    /// How far it may go from there until it has stopped.
    most_m: f64,
    /// Where it was when it must have stopped, or [`HOLDS_FOR`] later, and so on.
    held: Option<(Duration, Vector2<f64>)>,
}

impl Hold {
    fn new(now: Duration, truth: &Truth) -> Self {
        let speed_m_s = truth.velocity_m_s.xy().norm();
        let braking_m = speed_m_s * REACTION_S + speed_m_s * speed_m_s / (2.0 * BRAKING_M_S2);
        let most_m = HELD_M + braking_m;
        Self { since: now, from_m: truth.odometry_m, most_m, held: None }
    }

    /// Whether the drone has gone too far.
    fn is_left(&mut self, now: Duration, truth: &Truth) -> bool {
        let here_m = truth.odometry_m;
        if now >= self.since + BRAKES_WITHIN {
            let (at, held_m) = *self.held.get_or_insert((now, here_m));
            if now >= at + HOLDS_FOR {
                self.held = None;
            }
            return (here_m - held_m).norm() > HELD_M;
        }
        (here_m - self.from_m).norm() > self.most_m
    }
}

/// The station that may have the controls, and what is flown for it.
#[derive(Debug)]
pub(super) struct Silence {
    orders: Vec<(Duration, Operator, OperatorOrder)>,
    next: usize,
    /// Who has the controls.
    holder: Option<Operator>,
    /// When the station was last heard.
    heard_at: Duration,
    /// The last setpoint, while they are followed or were the last that was.
    setpoint_at: Option<Duration>,
    /// Nobody may be there any more who ordered what is flown, until it is ordered anew.
    lost: bool,
    stale: bool,
    hold: Option<Hold>,
}

impl Silence {
    /// `by_terminal`: orders of the terminal's operator; `by_others`: those of stations.
    pub(super) fn new(
        by_terminal: &[(Duration, OperatorOrder)],
        by_others: &[(Duration, Operator, OperatorOrder)],
    ) -> Self {
        let terminal =
            by_terminal.iter().map(|(at, order)| (*at, Operator::TERMINAL, order.clone()));
        let mut orders: Vec<_> = terminal.chain(by_others.iter().cloned()).collect();
        orders.sort_by_key(|(at, ..)| *at);
        Self {
            orders,
            next: 0,
            holder: Some(Operator::TERMINAL),
            heard_at: Duration::ZERO,
            setpoint_at: None,
            lost: false,
            stale: false,
            hold: None,
        }
    }

    /// Whether the station that has the controls has been silent for so long that the drone must be landed.
    pub(super) fn is_station_gone(&self, now: Duration) -> bool {
        self.silence(now) > STATION_LANDS
    }

    /// Whether setpoints have not come for so long.
    pub(super) fn are_setpoints_gone(&self, now: Duration) -> bool {
        self.age(now) > SETPOINT_LANDS
    }

    fn silence(&self, now: Duration) -> Duration {
        let must_be_heard = self.holder == Some(STATION);
        if must_be_heard { now.saturating_sub(self.heard_at) } else { Duration::ZERO }
    }

    fn age(&self, now: Duration) -> Duration {
        self.setpoint_at.map_or(Duration::ZERO, |at| now.saturating_sub(at))
    }

    /// `steady`: the drone hears us, and no gust carries it far.
    pub(super) fn watch(
        &mut self,
        moment: &Moment,
        injected: &Injected,
        steady: bool,
    ) -> Option<Fault> {
        let Moment { now, truth, status, .. } = moment;
        // Orders are queued while the program is stopped.
        if moment.is_over || injected.is_stalled(*now) {
            return None;
        }
        while let Some((at, by, order)) = self.orders.get(self.next).cloned()
            && at <= *now
        {
            self.next += 1;
            self.ordered(moment, by, &order);
        }
        let flies = truth.phase == Phase::Flying && status.phase == PilotPhase::Flying;
        // The last step lands, perhaps on a tag, to which the drone may have to be flown.
        let lands = status.step.is_some_and(|step| step + 1 >= status.steps);
        self.lost |= flies && self.silence(*now) > STATION_HOLDS + ON_ITS_WAY;
        self.stale |= flies && self.age(*now) > SETPOINT_HOLDS + ON_ITS_WAY;
        if !(self.lost || self.stale) || !flies || lands {
            self.hold = None;
            return None;
        }
        let undisturbed = steady
            && injected.is_quiet(now.saturating_sub(BEFORE), *now)
            && !injected.has_weak_motor(*now)
            && !injected.has_lied_of_place(*now);
        if !undisturbed {
            self.hold = None;
            return None;
        }
        let hold = self.hold.get_or_insert_with(|| Hold::new(*now, truth));
        if !hold.is_left(*now, truth) {
            return None;
        }
        self.hold = None;
        Some(Fault::FlownForNobody { setpoints: self.stale })
    }

    fn ordered(&mut self, moment: &Moment, by: Operator, order: &OperatorOrder) {
        let takes = by == Operator::TERMINAL;
        match order {
            OperatorOrder::Present | OperatorOrder::Camera { .. } => {}
            OperatorOrder::Release => self.holder = self.holder.filter(|holder| *holder != by),
            _ if takes || self.holder.is_none() => self.holder = Some(by),
            _ => {}
        }
        if by == STATION {
            self.heard_at = moment.now;
        }
        if self.holder != Some(by) && !order.is_for_anyone() {
            return;
        }
        let Moment { truth, status, .. } = moment;
        let flies = truth.phase == Phase::Flying && status.phase == PilotPhase::Flying;
        match order {
            OperatorOrder::Follow(setpoint) if setpoint.is_finite() => {
                self.moves();
                self.setpoint_at = flies.then_some(moment.now);
            }
            OperatorOrder::Setpoint(setpoint) if setpoint.is_finite() => {
                self.setpoint_at = self.setpoint_at.map(|_| moment.now);
            }
            OperatorOrder::GoTo(place) if !place.is_place() => {}
            OperatorOrder::Follow(_)
            | OperatorOrder::Setpoint(_)
            | OperatorOrder::Present
            | OperatorOrder::Append(_)
            | OperatorOrder::Camera { .. }
            | OperatorOrder::Take
            | OperatorOrder::Release
            | OperatorOrder::Recover => {}
            // Refused by a mission that is not paused.
            OperatorOrder::Resume | OperatorOrder::Start { .. }
                if !self.is_paused(status.mission_waits) => {}
            _ => self.moves(),
        }
    }

    /// A mission can be resumed, as far as the judge knows.
    fn is_paused(&self, waits: bool) -> bool {
        self.lost || self.stale || self.setpoint_at.is_some() || waits
    }

    /// Something else was ordered.
    fn moves(&mut self) {
        self.setpoint_at = None;
        self.lost = false;
        self.stale = false;
        self.hold = None;
    }
}
