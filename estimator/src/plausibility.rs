//! Checks navdata for plausibility: each quantity on its own, on the clock of the packets' arrival.
//!
//! The arrival clock is the only one that a broken drone cannot stop. On the drone's own clock, a computer
//! that hangs would also stop the timeout that detects it.

use nalgebra::Vector2;

use crate::Sample;
use crate::silence::{KEPT_S, Silence};
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
/// These hardly last longer than this. After a longer gap a new wind adds to the difference, and an error of the model
/// by this share of the predicted change.
const BRIEF_S: f64 = 0.1;
const NEW_WIND_M_S2: f64 = 0.15;
const MODEL_SHARE: f64 = 0.15;
/// The thrust is known within this share; in a silence a wrong one acts for long.
const THRUST_SHARE: f64 = 0.2;
/// What a drone does that hovers by itself because it received nothing for long is predicted less well.
const ALONE_M_S2: f64 = 0.5;
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
/// Stops of a value that are tolerated, and the rate at which they are forgotten. A quantity that hangs again and
/// again is no better than one that hangs for good, although each time it moves again before the drone must land.
const FORGIVEN_STOPS: f64 = 1.5;
const FORGET_STOPS_1_S: f64 = 0.1;
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

/// Longest time in which a drone that lifts off can have gained speed unseen.
const LIFT_OFF_S: f64 = 0.1;

/// Separates velocities that jump, as no drone can, from changes by gusts. (right, forward) in the world
/// frame.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct VelocityGate {
    last_m_s: Option<Vector2<f64>>,
    jumped: bool,
    /// The last velocity is that of a drone that stands.
    rests: bool,
    silence: Silence,
}

/// The model's velocity before and after a step, (right, forward) in the world frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Foreseen<'a> {
    pub(crate) before_m_s: Vector2<f64>,
    pub(crate) after_m_s: Vector2<f64>,
    /// Velocities after the step of a drone that did not receive all of its orders, sorted by the time of the last one
    /// that it received, the latest first; none if packets arrived all the time.
    pub(crate) unheard_m_s: &'a [Option<Vector2<f64>>],
    /// Acceleration by the measured tilt, if no packets arrived before; in the share of the step in which none did.
    pub(crate) pull_m_s2: f64,
}

impl Foreseen<'_> {
    /// Distance of a velocity from the nearest that is explained by the orders, received or not: those between two
    /// are explained too. The predicted changes may be wrong by a share.
    fn off_m_s(&self, m_s: Vector2<f64>, share: f64) -> f64 {
        let scaled =
            |m_s: Vector2<f64>, scale: f64| self.before_m_s + (m_s - self.before_m_s) * scale;
        let mut off_m_s = f64::INFINITY;
        let mut last_m_s = self.after_m_s;
        for after_m_s in [&self.after_m_s].into_iter().chain(self.unheard_m_s.iter().flatten()) {
            let [less, more] = [1.0 - share, 1.0 + share].map(|scale| scaled(*after_m_s, scale));
            off_m_s = off_m_s.min(distance_m_s(m_s, less, more));
            for scale in [1.0 - share, 1.0, 1.0 + share] {
                let (from, to) = (scaled(last_m_s, scale), scaled(*after_m_s, scale));
                off_m_s = off_m_s.min(distance_m_s(m_s, from, to));
            }
            last_m_s = *after_m_s;
        }
        off_m_s
    }
}

/// Distance of a velocity from those between two others.
fn distance_m_s(m_s: Vector2<f64>, from_m_s: Vector2<f64>, to_m_s: Vector2<f64>) -> f64 {
    let way = to_m_s - from_m_s;
    let share = (m_s - from_m_s).dot(&way) / way.norm_squared().max(1e-12);
    (m_s - from_m_s - way * share.clamp(0.0, 1.0)).norm()
}

impl VelocityGate {
    /// Whether the newest velocity is rejected because it jumped.
    pub(crate) fn has_jumped(&self) -> bool {
        self.jumped
    }

    /// A packet was sent at a time, in seconds, whatever is in it.
    pub(crate) fn hear(&mut self, at_s: f64) {
        self.silence.hear(at_s);
    }

    /// Share of the `step_s` since the last velocity in which no packets arrived, and the drone may not have received
    /// its orders. The velocity is measured now.
    pub(crate) fn unheard_share(&mut self, step_s: f64) -> f64 {
        let share = self.silence.end(step_s);
        if self.rests { 0.0 } else { share }
    }

    /// The drone stands: what it reports is compared with rest once it flies. Otherwise the first velocity of a flight
    /// would be accepted whatever it is, and a constant error with it.
    pub(crate) fn rest(&mut self) {
        let silence = self.silence;
        *self = Self { last_m_s: Some(Vector2::zeros()), rests: true, silence, ..Self::default() };
    }

    /// Whether to accept a velocity that was measured `step_s` after the last one. After a jump only a velocity near
    /// the model's is accepted.
    pub(crate) fn admits(
        &mut self,
        measured_m_s: Vector2<f64>,
        foreseen: &Foreseen<'_>,
        step_s: f64,
    ) -> bool {
        let Some(last_m_s) = self.last_m_s.replace(measured_m_s) else { return true };
        // The flow may measure nothing new for a second while the drone lifts off, which is no time to speed up.
        let longest_s = if std::mem::take(&mut self.rests) { LIFT_OFF_S } else { f64::INFINITY };
        let step_s = step_s.min(longest_s);
        let gap_s = (step_s - BRIEF_S).max(0.0);
        let wind_m_s = NEW_WIND_M_S2 * gap_s + ALONE_M_S2 * (gap_s - KEPT_S).max(0.0);
        let thrust_m_s = THRUST_SHARE * foreseen.pull_m_s2 * gap_s;
        let gained_m_s = JUMP_M_S2 * step_s.min(BRIEF_S) + wind_m_s + thrust_m_s;
        let allowed_m_s = JUMP_M_S + gained_m_s;
        let share = MODEL_SHARE * gap_s / (gap_s + BRIEF_S);
        let surprise_m_s = foreseen.off_m_s(measured_m_s, share);
        let changed_m_s = foreseen.before_m_s + measured_m_s - last_m_s;
        let unforeseen_m_s = foreseen.off_m_s(changed_m_s, share);
        let jumps = surprise_m_s > allowed_m_s && unforeseen_m_s > allowed_m_s;
        // Hysteresis: a drone that hovers meanwhile comes near any small false value.
        let lasts = self.jumped && surprise_m_s > RETURN_SHARE * allowed_m_s;
        self.jumped = jumps || lasts;
        !self.jumped && surprise_m_s <= MAX_SURPRISE_M_S + gained_m_s
    }
}

/// Result of the estimator for one sample.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Verdict {
    /// A quantity with a rejected value.
    pub(crate) rejected: Option<Quantity>,
    /// A quantity that is noisier than its sensor.
    pub(crate) noisy: Option<Quantity>,
    /// A quantity that does not follow the commands.
    pub(crate) unresponsive: Option<Quantity>,
    /// The floor or the heading made a step, which was compensated.
    pub(crate) step: Option<Quantity>,
    /// The drone takes off autonomously near the ground, where its sensors may not work yet.
    pub(crate) near_ground: bool,
    /// It takes off or lands by itself that near to the ground: however long its motors take to lift it, the flow has
    /// nothing to see.
    pub(crate) flow_rests: bool,
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
    /// Number of remembered stops of a value, and whether one lasts.
    stops: f64,
    is_stopped: bool,
    /// A quantity that is too noisy, and when it was last.
    noisy: Option<(Quantity, f64)>,
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
        let noisy = self.noisy(arrival_s, verdict);
        self.count_stop(arrival_s, step_s, frozen.map(|(quantity, _)| quantity));
        // Dated from the first wrong packet, so that a reaction does not wait for another timeout.
        let since_s = [wrong, frozen, unresponsive].map(|found| found.map(|(_, since_s)| since_s));
        self.trust = if let Some((quantity, _)) = wrong {
            Trust::Implausible(quantity)
        } else if let Some((quantity, _)) = frozen {
            Trust::Frozen(quantity)
        } else if let Some(quantity) = noisy {
            Trust::Noisy(quantity)
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
            let rests = quantity == Quantity::Velocity && verdict.flow_rests;
            if repetition.count >= FROZEN_PACKETS && lasts && !verdict.near_ground && !rests {
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

    /// Counts how often a value has stopped, and disproves a quantity that stops again and again.
    fn count_stop(&mut self, arrival_s: f64, step_s: f64, stopped: Option<Quantity>) {
        self.stops = (self.stops - FORGET_STOPS_1_S * step_s).max(0.0);
        let was_stopped = std::mem::replace(&mut self.is_stopped, stopped.is_some());
        let Some(quantity) = stopped else { return };
        if !was_stopped {
            self.stops = (self.stops + 1.0).min(FORGIVEN_STOPS + 1.0);
        }
        if self.stops > FORGIVEN_STOPS {
            self.disproved = Some((quantity, arrival_s, arrival_s));
        }
    }

    fn unresponsive(&mut self, arrival_s: f64, verdict: &Verdict) -> Option<(Quantity, f64)> {
        if let Some(quantity) = verdict.unresponsive {
            // The detection took this long.
            self.unresponsive = Some((quantity, arrival_s - WRONG_TIME_S));
        }
        self.unresponsive.filter(|(_, since_s)| arrival_s - since_s < DISPROVED_TIME_S)
    }

    fn noisy(&mut self, arrival_s: f64, verdict: &Verdict) -> Option<Quantity> {
        self.noisy = verdict.noisy.map(|quantity| (quantity, arrival_s)).or(self.noisy);
        let (quantity, last_s) = self.noisy?;
        (arrival_s - last_s < DISPROVED_TIME_S).then_some(quantity)
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
mod tests;
