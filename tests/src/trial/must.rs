//! Rules for the true course of a flight.

use std::time::Duration;

use autopilot::vehicle::TICK;
use mock_drone::firmware::Phase;
use nalgebra::Vector2;

use crate::sim::Moment;

/// An estimate off by more than this many of its own standard deviations and this distance for this time is
/// overconfident, as in the campaign.
const DEVIATIONS: f64 = 4.0;
const TRIFLE_M: f64 = 0.1;
const WRONG_FOR: Duration = Duration::from_secs(1);

/// A rule, with what it remembers of the flight.
#[derive(Debug, Clone)]
pub(crate) enum Must {
    /// Flying at this time, because a flight that is refused shows nothing.
    BeUp { at: Duration },
    /// Landed from this time on.
    BeDown { by: Duration },
    /// Never further than this from the start, horizontally, beyond the error of healthy sensors if they are all
    /// that the pilot has.
    StayNear { m: f64, by_sensors: bool },
    /// Never higher than this, from this time on.
    StayBelow { m: f64, since: Duration },
    /// Not lower than this for longer than `most` while it is flown, from this time on.
    StayAbove { m: f64, since: Duration, most: Duration, lower_for: Duration },
    /// What is added to the error of the estimated place from this time on is within its claimed uncertainty.
    BeHonest { since: Duration, error_m: Option<Vector2<f64>>, wrong_for: Duration },
}

impl Must {
    pub(crate) fn stay_above(m: f64, since: Duration, most: Duration) -> Self {
        Self::StayAbove { m, since, most, lower_for: Duration::ZERO }
    }

    pub(crate) fn be_honest(since: Duration) -> Self {
        Self::BeHonest { since, error_m: None, wrong_for: Duration::ZERO }
    }

    /// Description of the violation in this tick, if any.
    pub(crate) fn violated(&mut self, moment: &Moment) -> Option<String> {
        let Moment { now, truth, status, .. } = moment;
        let at_s = now.as_secs_f64();
        let is_up = matches!(truth.phase, Phase::TakingOff { .. } | Phase::Flying | Phase::Landing);
        match self {
            Self::BeUp { at } => (*now >= *at && *now < *at + TICK && truth.phase != Phase::Flying)
                .then(|| format!("not flying after {at_s:.1} s, {:?}", truth.phase)),
            Self::BeDown { by } => (now >= by && truth.phase != Phase::Landed)
                .then(|| format!("not down after {at_s:.1} s, {:?}", truth.phase)),
            Self::StayNear { m, by_sensors } => {
                let place_m = if *by_sensors { truth.odometry_m } else { truth.position_m.xy() };
                let away_m = place_m.norm();
                (is_up && away_m > *m)
                    .then(|| format!("{away_m:.2} m away after {at_s:.1} s, {m:.2} m allowed"))
            }
            Self::StayBelow { m, since } => {
                let height_m = truth.position_m.z;
                (now >= since && height_m > *m)
                    .then(|| format!("{height_m:.2} m high after {at_s:.1} s, {m:.2} m allowed"))
            }
            Self::StayAbove { m, since, most, lower_for } => {
                let is_low = truth.phase == Phase::Flying && truth.position_m.z < *m;
                *lower_for =
                    if now >= since && is_low { *lower_for + TICK } else { Duration::ZERO };
                (*lower_for > *most).then(|| format!("lower than {m:.2} m for {lower_for:.1?}"))
            }
            Self::BeHonest { since, error_m, wrong_for } => {
                let pose = status.pose?;
                let now_m = truth.position_m.xy() - Vector2::new(pose.x_m, pose.y_m);
                if now < since || !is_up || moment.is_over {
                    return None;
                }
                let added_m = (now_m - *error_m.get_or_insert(now_m)).norm();
                let claimed_m = status.uncertainty_m;
                let is_wrong = added_m > DEVIATIONS * claimed_m + TRIFLE_M;
                *wrong_for = if is_wrong { *wrong_for + TICK } else { Duration::ZERO };
                (*wrong_for > WRONG_FOR)
                    .then(|| format!("overconfident: {added_m:.2} m off, {claimed_m:.2} m claimed"))
            }
        }
    }
}
