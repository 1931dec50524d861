//! Checks navdata for plausibility: each quantity on its own, on the clock of the packets' arrival.
//!
//! The arrival clock is the only one that a broken drone cannot stop. On the drone's own clock, a computer
//! that hangs would also stop the timeout that detects it.

use nalgebra::Vector2;

use crate::Sample;
use crate::trust::{Quantity, Trust};

/// Above the top speed of an AR.Drone.
const MAX_SPEED_M_S: f64 = 8.0;
/// The ultrasound ends at 6 m; the pressure sensor goes on to what the firmware allows.
const MAX_ALTITUDE_M: f64 = 120.0;
/// A drone on the floor of a pit reads no lower.
const MIN_ALTITUDE_M: f64 = -1.0;
/// The firmware cuts the motors long before.
const MAX_TILT_RAD: f64 = 1.2;
/// How long data must be wrong before trust is lost.
const WRONG_TIME_S: f64 = 0.4;
/// How long a quantity with noise of its own must repeat one value: the flow has 40 to 80 mm/s.
const FROZEN_TIME_S: f64 = 0.4;
/// The altitude has a resolution of one millimetre and the attitude of a thousandth of a degree, so in a
/// quiet hover they may repeat a value for a while...
const QUIET_FROZEN_TIME_S: f64 = 1.0;
/// ...but not while the sticks ask for this much climb or turn.
const ASKED_RISE_M: f64 = 0.05;
const ASKED_TURN_DEG: f64 = 5.0;
/// Minimum number of packets that repeat the value, because loss makes the time between packets long.
const FROZEN_PACKETS: u32 = 5;
/// Largest difference between measured and predicted change of the velocity: noise (m/s), plus gusts and an
/// airframe that is not identified yet (m/s²).
const JUMP_M_S: f64 = 0.2;
const JUMP_M_S2: f64 = 4.0;
/// After a jump the velocity must come back to this fraction of the allowed difference.
const RETURN_SHARE: f64 = 0.5;
/// Largest difference between measured and expected velocity, however it came about.
const MAX_SURPRISE_M_S: f64 = 1.5;
/// How long a disproved quantity is distrusted, whether by the commands or by a lasting jump. The reaction is
/// a hover, which asks for no motion that could confirm the quantity, and in which a false velocity is soon
/// as small as the true one. When the fault began is unknown.
const DISPROVED_TIME_S: f64 = 4.0;
/// Steps of the floor or heading that are tolerated, and the rate at which they are forgotten.
const FORGIVEN_STEPS: f64 = 2.5;
const FORGET_STEPS_1_S: f64 = 0.25;
/// Lateness, compared with the usual, beyond which navdata are out of date.
const MAX_LATENESS_S: f64 = 0.3;

/// The quantity of a sample whose value is impossible for an AR.Drone.
pub(crate) fn impossible(sample: &Sample) -> Option<Quantity> {
    let speed_m_s = sample.velocity_forward_m_s.hypot(sample.velocity_right_m_s);
    let tilt_rad = sample.roll_deg.abs().max(sample.pitch_deg.abs()).to_radians();
    let is_level_number = sample.roll_deg.is_finite() && sample.pitch_deg.is_finite();
    [
        (Quantity::Velocity, speed_m_s <= MAX_SPEED_M_S),
        (Quantity::Altitude, (MIN_ALTITUDE_M..=MAX_ALTITUDE_M).contains(&sample.altitude_m)),
        (Quantity::Heading, sample.yaw_deg.abs() <= 360.0),
        (Quantity::Attitude, is_level_number && tilt_rad <= MAX_TILT_RAD),
    ]
    .into_iter()
    .find_map(|(quantity, possible)| (!possible).then_some(quantity))
}

/// Separates velocities that jump, as no drone can, from changes by gusts. (right, forward) in the world
/// frame.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct VelocityGate {
    last_m_s: Option<Vector2<f64>>,
    jumped: bool,
}

impl VelocityGate {
    /// Whether the newest velocity is rejected because it jumped.
    pub(crate) fn has_jumped(&self) -> bool {
        self.jumped
    }

    /// Whether to accept a velocity that was measured `step_s` after the last one, while the model's velocity
    /// went from `before` to `foreseen`. After a jump only a velocity near the model's is accepted.
    pub(crate) fn admits(
        &mut self,
        measured_m_s: Vector2<f64>,
        before_m_s: Vector2<f64>,
        foreseen_m_s: Vector2<f64>,
        step_s: f64,
    ) -> bool {
        let Some(last_m_s) = self.last_m_s.replace(measured_m_s) else { return true };
        let allowed_m_s = JUMP_M_S + JUMP_M_S2 * step_s;
        let surprise_m_s = (measured_m_s - foreseen_m_s).norm();
        let unforeseen = (measured_m_s - last_m_s) - (foreseen_m_s - before_m_s);
        let jumps = surprise_m_s > allowed_m_s && unforeseen.norm() > allowed_m_s;
        // Hysteresis: a drone that hovers meanwhile comes near any small false value.
        let lasts = self.jumped && surprise_m_s > RETURN_SHARE * allowed_m_s;
        self.jumped = jumps || lasts;
        !self.jumped && surprise_m_s <= MAX_SURPRISE_M_S + JUMP_M_S2 * step_s
    }
}

/// Result of the estimator for one sample.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Verdict {
    /// A quantity with a rejected value.
    pub(crate) rejected: Option<Quantity>,
    /// A quantity that does not follow the commands.
    pub(crate) unresponsive: Option<Quantity>,
    /// The floor or the heading made a step, which was compensated.
    pub(crate) step: Option<Quantity>,
    /// The drone takes off autonomously near the ground, where its sensors may not work yet.
    pub(crate) near_ground: bool,
    /// Climb and turn that the sticks have asked for since the flight began.
    pub(crate) asked_rise_m: f64,
    pub(crate) asked_turn_deg: f64,
    /// Lateness of the sample, compared with the usual.
    pub(crate) lateness_s: f64,
}

/// Monitors the plausibility of navdata.
#[derive(Debug, Clone, Default)]
pub(crate) struct Plausibility {
    velocity: [Repetition; 2],
    altitude: Repetition,
    heading: Repetition,
    attitude: [Repetition; 2],
    wrong: Option<(Quantity, f64)>,
    /// A quantity that was found to be wrong; since when, and until when it is distrusted.
    disproved: Option<(Quantity, f64, f64)>,
    unresponsive: Option<(Quantity, f64)>,
    reported_since_s: Option<f64>,
    /// Number of remembered steps, and the quantity of the last one.
    steps: f64,
    stepped: Option<Quantity>,
    last_s: Option<f64>,
    trust: Trust,
    sound_at_s: Option<f64>,
}

impl Plausibility {
    /// Checks a sample that arrived at a time.
    pub(crate) fn watch(&mut self, arrival_s: f64, sample: &Sample, verdict: &Verdict) {
        let step_s = self.last_s.replace(arrival_s).map_or(0.0, |last_s| arrival_s - last_s);
        self.steps = (self.steps - FORGET_STEPS_1_S * step_s).max(0.0);
        self.steps += f64::from(u8::from(verdict.step.is_some()));
        self.stepped = verdict.step.or(self.stepped);
        let frozen = self.frozen(arrival_s, sample, verdict);
        let wrong = self.wrong(arrival_s, verdict);
        let reported = self.reported(arrival_s, sample);
        let unresponsive = self.unresponsive(arrival_s, verdict);
        // Dated from the first wrong packet, so that a reaction does not wait for another timeout.
        let since_s = [wrong, frozen, unresponsive].map(|found| found.map(|(_, since_s)| since_s));
        self.trust = if let Some((quantity, _)) = wrong {
            Trust::Implausible(quantity)
        } else if let Some((quantity, _)) = frozen {
            Trust::Frozen(quantity)
        } else if let Some(quantity) = reported {
            Trust::Reported(quantity)
        } else if let Some((quantity, _)) = unresponsive {
            Trust::Unresponsive(quantity)
        } else if let Some(quantity) = self.stepped.filter(|_| self.steps > FORGIVEN_STEPS) {
            Trust::Implausible(quantity)
        } else {
            Trust::Sound
        };
        if self.trust == Trust::Sound {
            if verdict.lateness_s <= MAX_LATENESS_S {
                self.sound_at_s = Some(arrival_s);
            }
        } else if let Some(sound_s) = &mut self.sound_at_s {
            *sound_s = since_s.into_iter().flatten().fold(*sound_s, f64::min);
        }
    }

    fn frozen(
        &mut self,
        arrival_s: f64,
        sample: &Sample,
        verdict: &Verdict,
    ) -> Option<(Quantity, f64)> {
        let [right, forward] = &mut self.velocity;
        let [roll, pitch] = &mut self.attitude;
        let watched = [
            (Quantity::Velocity, right, sample.velocity_right_m_s),
            (Quantity::Velocity, forward, sample.velocity_forward_m_s),
            (Quantity::Altitude, &mut self.altitude, sample.altitude_m),
            (Quantity::Heading, &mut self.heading, sample.yaw_deg),
            (Quantity::Attitude, roll, sample.roll_deg),
            (Quantity::Attitude, pitch, sample.pitch_deg),
        ];
        let mut frozen = None;
        for (quantity, repetition, value) in watched {
            let asked = match quantity {
                Quantity::Altitude => verdict.asked_rise_m,
                Quantity::Heading => verdict.asked_turn_deg,
                Quantity::Velocity | Quantity::Attitude => 0.0,
            };
            repetition.watch(arrival_s, value, asked, sample.airborne);
            let asked = (asked - repetition.asked).abs();
            let is_quiet = match quantity {
                Quantity::Velocity => false,
                Quantity::Altitude => asked < ASKED_RISE_M,
                Quantity::Heading => asked < ASKED_TURN_DEG,
                Quantity::Attitude => true,
            };
            let patience_s = if is_quiet { QUIET_FROZEN_TIME_S } else { FROZEN_TIME_S };
            let lasts = arrival_s - repetition.since_s >= patience_s;
            if repetition.count >= FROZEN_PACKETS && lasts && !verdict.near_ground {
                frozen = frozen.or(Some((quantity, repetition.since_s)));
            }
        }
        frozen
    }

    fn wrong(&mut self, arrival_s: f64, verdict: &Verdict) -> Option<(Quantity, f64)> {
        self.wrong = verdict.rejected.map(|quantity| match self.wrong {
            Some((_, since_s)) => (quantity, since_s),
            None => (quantity, arrival_s),
        });
        if let Some((_, since_s)) = self.wrong
            && arrival_s - since_s >= WRONG_TIME_S
        {
            self.disproved = self.wrong.map(|(quantity, _)| (quantity, since_s, arrival_s));
        }
        let (quantity, since_s, last_s) = self.disproved?;
        (arrival_s - last_s < DISPROVED_TIME_S).then_some((quantity, since_s))
    }

    fn unresponsive(&mut self, arrival_s: f64, verdict: &Verdict) -> Option<(Quantity, f64)> {
        if let Some(quantity) = verdict.unresponsive {
            // The detection took this long.
            self.unresponsive = Some((quantity, arrival_s - WRONG_TIME_S));
        }
        self.unresponsive.filter(|(_, since_s)| arrival_s - since_s < DISPROVED_TIME_S)
    }

    fn reported(&mut self, arrival_s: f64, sample: &Sample) -> Option<Quantity> {
        let reported = sample.reported_lost.filter(|_| sample.airborne);
        self.reported_since_s = reported.map(|_| self.reported_since_s.unwrap_or(arrival_s));
        reported.filter(|_| self.reported_since_s.is_some_and(|s| arrival_s - s >= WRONG_TIME_S))
    }

    pub(crate) fn trust(&self) -> Trust {
        self.trust
    }

    /// When the newest plausible navdata arrived, in seconds.
    pub(crate) fn sound_at_s(&self) -> Option<f64> {
        self.sound_at_s
    }
}

/// Counts exact repetitions of a value.
#[derive(Debug, Clone, Copy, Default)]
struct Repetition {
    value: Option<f64>,
    count: u32,
    since_s: f64,
    /// Total change asked for by the sticks when the value first appeared.
    asked: f64,
}

impl Repetition {
    /// A drone on the ground may report constant values.
    fn watch(&mut self, at_s: f64, value: f64, asked: f64, airborne: bool) {
        if self.value == Some(value) && airborne {
            self.count += 1;
        } else {
            *self = Self { value: Some(value), count: 0, since_s: at_s, asked };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINE: Verdict = Verdict {
        rejected: None,
        unresponsive: None,
        step: None,
        near_ground: false,
        asked_rise_m: 0.0,
        asked_turn_deg: 0.0,
        lateness_s: 0.0,
    };
    const PERIOD_S: f64 = 0.066;

    /// All quantities vary slightly.
    fn flying(step: u32) -> Sample {
        let wobble = 0.001 * f64::from(step % 7);
        Sample {
            yaw_deg: 10.0 + wobble,
            roll_deg: wobble,
            pitch_deg: -wobble,
            velocity_forward_m_s: wobble,
            velocity_right_m_s: 0.2 - wobble,
            altitude_m: 1.0 + wobble,
            airborne: true,
            ..Sample::default()
        }
    }

    /// The trust after each of some packets, and when navdata were last plausible.
    fn watch(
        packets: u32,
        sample: impl Fn(u32) -> Sample,
        verdict: impl Fn(u32) -> Verdict,
    ) -> Vec<(f64, Trust, f64)> {
        let mut plausibility = Plausibility::default();
        (0..packets)
            .map(|step| {
                let at_s = PERIOD_S * f64::from(step);
                plausibility.watch(at_s, &sample(step), &verdict(step));
                (at_s, plausibility.trust(), plausibility.sound_at_s().unwrap_or(-1.0))
            })
            .collect()
    }

    fn first_distrust(watched: &[(f64, Trust, f64)]) -> Option<(f64, Trust)> {
        watched
            .iter()
            .find(|(_, trust, _)| *trust != Trust::Sound)
            .map(|(s, trust, _)| (*s, *trust))
    }

    #[test]
    fn one_quantity_that_repeats_its_value_is_frozen() {
        type Freeze = fn(&mut Sample);
        let still: [(Quantity, Freeze, f64); 6] = [
            (Quantity::Velocity, |s| s.velocity_forward_m_s = 0.0, FROZEN_TIME_S),
            (Quantity::Velocity, |s| s.velocity_right_m_s = 1.2, FROZEN_TIME_S),
            (Quantity::Altitude, |s| s.altitude_m = 1.0, QUIET_FROZEN_TIME_S),
            (Quantity::Heading, |s| s.yaw_deg = 3.0, QUIET_FROZEN_TIME_S),
            (Quantity::Attitude, |s| s.roll_deg = 3.0, QUIET_FROZEN_TIME_S),
            (Quantity::Attitude, |s| s.pitch_deg = 3.0, QUIET_FROZEN_TIME_S),
        ];
        for (quantity, freeze, patience_s) in still {
            let sample = |step| {
                let mut sample = flying(step);
                if step >= 100 {
                    freeze(&mut sample);
                }
                sample
            };
            let watched = watch(150, sample, |_| FINE);
            let (at_s, trust) = first_distrust(&watched).unwrap();
            assert_eq!(trust, Trust::Frozen(quantity));
            let after_s = at_s - 100.0 * PERIOD_S;
            assert!((patience_s..patience_s + 2.0 * PERIOD_S).contains(&after_s), "{after_s}");
            let (_, _, sound_at_s) = watched[149];
            assert!((sound_at_s - 100.0 * PERIOD_S).abs() < 1e-9, "sound until it froze");
        }
        assert_eq!(first_distrust(&watch(150, flying, |_| FINE)), None);
    }

    #[test]
    fn an_altitude_that_repeats_during_a_climb_is_noticed_sooner() {
        let still = |step| Sample { altitude_m: 1.0, ..flying(step) };
        let climbing = |step| Verdict { asked_rise_m: 0.03 * f64::from(step), ..FINE };
        let (at_s, trust) = first_distrust(&watch(40, still, climbing)).unwrap();
        assert_eq!(trust, Trust::Frozen(Quantity::Altitude));
        assert!(at_s < 0.5, "{at_s}");
    }

    #[test]
    fn a_drone_on_the_ground_may_stand_still() {
        assert_eq!(first_distrust(&watch(100, |_| Sample::default(), |_| FINE)), None);
        let spinning_up = |_| Sample { airborne: true, ..Sample::default() };
        let near_ground = |_| Verdict { near_ground: true, ..FINE };
        assert_eq!(first_distrust(&watch(100, spinning_up, near_ground)), None);
    }

    #[test]
    fn what_no_drone_does_is_impossible() {
        assert_eq!(impossible(&flying(0)), None);
        for bad in [f64::NAN, f64::INFINITY, 1e6, -500.0] {
            let with = |change: fn(&mut Sample, f64)| {
                let mut sample = flying(0);
                change(&mut sample, bad);
                impossible(&sample)
            };
            assert_eq!(with(|s, bad| s.altitude_m = bad), Some(Quantity::Altitude));
            assert_eq!(with(|s, bad| s.velocity_right_m_s = bad), Some(Quantity::Velocity));
            assert_eq!(with(|s, bad| s.velocity_forward_m_s = bad), Some(Quantity::Velocity));
            assert_eq!(with(|s, bad| s.roll_deg = bad), Some(Quantity::Attitude));
            assert_eq!(with(|s, bad| s.pitch_deg = bad), Some(Quantity::Attitude));
            assert_eq!(with(|s, bad| s.yaw_deg = bad), Some(Quantity::Heading));
        }
    }

    #[test]
    fn a_velocity_that_jumps_is_not_believed_and_one_that_a_gust_changes_is() {
        let still = Vector2::zeros();
        let along = |m_s: f64| Vector2::new(m_s, 0.0);
        let mut gate = VelocityGate::default();
        assert!(gate.admits(along(0.3), still, still, 0.0), "the first one");
        let mut gate = VelocityGate { last_m_s: Some(still), jumped: false };
        for _ in 0..10 {
            assert!(!gate.admits(along(1.0), still, still, PERIOD_S), "as long as it lasts");
        }
        assert!(!gate.admits(along(0.4), still, still, PERIOD_S), "not half way back");
        assert!(gate.admits(along(0.1), still, still, PERIOD_S), "and no longer");
        // A gust of 2.5 m/s² that the model does not predict, and follows by two thirds.
        let (mut gate, mut model_m_s) = (VelocityGate::default(), 0.0);
        for step in 0..12 {
            let measured_m_s = 2.5 * PERIOD_S * f64::from(step);
            let model = along(model_m_s);
            assert!(gate.admits(along(measured_m_s), model, model, PERIOD_S), "{step}");
            model_m_s += 0.66 * (measured_m_s - model_m_s);
        }
        // After a gap large changes are possible.
        let mut gate = VelocityGate { last_m_s: Some(still), jumped: false };
        assert!(gate.admits(along(2.0), still, still, 1.0));
    }

    #[test]
    fn one_rejected_packet_is_no_reason_to_worry_and_many_are() {
        let bad = Verdict { rejected: Some(Quantity::Velocity), ..FINE };
        let once = |step| if step == 10 { bad } else { FINE };
        assert_eq!(first_distrust(&watch(100, flying, once)), None);
        let long = |step| if step >= 10 { bad } else { FINE };
        let (at_s, trust) = first_distrust(&watch(100, flying, long)).unwrap();
        assert_eq!(trust, Trust::Implausible(Quantity::Velocity));
        assert!((at_s - 10.0 * PERIOD_S) < 0.5, "{at_s}");
        let ends = |step| if (10..20).contains(&step) { bad } else { FINE };
        let watched = watch(100, flying, ends);
        assert_eq!(watched[50].1, trust, "the start of the fault is unknown");
        assert_eq!(watched[99].1, Trust::Sound);
    }

    #[test]
    fn what_the_drone_says_of_itself_counts() {
        let lost = |step| Sample {
            reported_lost: (step >= 10).then_some(Quantity::Velocity),
            ..flying(step)
        };
        let (at_s, trust) = first_distrust(&watch(30, lost, |_| FINE)).unwrap();
        assert_eq!(trust, Trust::Reported(Quantity::Velocity));
        assert!((at_s - 10.0 * PERIOD_S) < 0.5, "{at_s}");
        let unresponsive = Verdict { unresponsive: Some(Quantity::Heading), ..FINE };
        let once = |step| if step == 10 { unresponsive } else { FINE };
        let watched = watch(100, flying, once);
        assert_eq!(watched[40].1, Trust::Unresponsive(Quantity::Heading), "a hover shows nothing");
        assert_eq!(watched[99].1, Trust::Sound);
    }

    #[test]
    fn one_step_is_forgiven_and_many_are_not() {
        let stepping = |every: u32| {
            move |step: u32| Verdict {
                step: step.is_multiple_of(every).then_some(Quantity::Altitude),
                ..FINE
            }
        };
        assert_eq!(first_distrust(&watch(200, flying, stepping(150))), None);
        let (_, trust) = first_distrust(&watch(200, flying, stepping(10))).unwrap();
        assert_eq!(trust, Trust::Implausible(Quantity::Altitude));
    }

    #[test]
    fn old_news_does_not_make_navdata_fresh() {
        let late = |step| Verdict { lateness_s: if step >= 10 { 1.0 } else { 0.0 }, ..FINE };
        let watched = watch(20, flying, late);
        assert!((watched[19].2 - 9.0 * PERIOD_S).abs() < 1e-9, "{:?}", watched[19]);
    }
}
