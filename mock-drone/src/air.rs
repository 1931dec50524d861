//! The air that several drones share: what each feels of the wash below another one, and hears of its ultrasound.
//!
//! Nobody is felt until [`World::meet`](crate::World::meet) tells of him; a drone that is alone flies bit for bit as without
//! this module.

use nalgebra::{Vector2, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::airframe::{AIR_KG_M3, GRAVITY_M_S2, MASS_KG, body_from_world, world_from_body};
use crate::gauss_markov::GaussMarkov;

/// Where a drone stands at its start, in a frame that all drones of one air have in common.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Standing {
    /// (right, forward) in the common frame, in metres.
    pub place_m: Vector2<f64>,
    /// Clockwise from the common frame's forward.
    pub heading_deg: f64,
}

impl Standing {
    /// A place in the drone's own frame (right, forward, up from its start), in the common frame.
    pub fn in_common(&self, own_m: Vector3<f64>) -> Vector3<f64> {
        let turned = world_from_body(own_m.x, own_m.y, self.heading_deg.to_radians());
        (self.place_m + turned).push(own_m.z)
    }

    /// The inverse of [`Standing::in_common`].
    pub fn seen_from_start(&self, common_m: Vector3<f64>) -> Vector3<f64> {
        let offset = common_m.xy() - self.place_m;
        body_from_world(offset.x, offset.y, self.heading_deg.to_radians()).push(common_m.z)
    }
}

/// A drone as others in the air notice it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Presence {
    /// Right, forward, up, in metres, in the common frame.
    pub position_m: Vector3<f64>,
    /// Whether its motors are on: otherwise there is no wash below it.
    pub rotors_turn: bool,
    /// The drone's number of its ultrasound's frequency, `pic:ultrasound_freq`: 7 (22.22 Hz) or 8 (25 Hz). It measures from
    /// when it is switched on, also on the ground.
    pub ultrasound: i64,
}

/// Air at a place that moves, because a drone hovers above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Wash {
    /// Downwards.
    pub(crate) down_m_s: f64,
    /// (right, forward), from the axis outwards, and gusts.
    pub(crate) across_m_s: Vector2<f64>,
}

const ROTOR_RADIUS_M: f64 = 0.1;
/// Of all four.
const DISC_AREA_M2: f64 = 4.0 * std::f64::consts::PI * ROTOR_RADIUS_M * ROTOR_RADIUS_M;
/// A turbulent round jet's half-width grows by 0.1 of the distance (Pope, *Turbulent Flows*, section 5.1); its Gaussian falls to
/// 1/e at 1.2 of that.
const SPREADING: f64 = 0.12;
/// Standard deviation of the turbulence on each axis, as a share of the speed: about what is measured on a jet's axis (Hussein,
/// Capp and George 1994).
const TURBULENCE: f64 = 0.25;
/// Time after which a gust is another one: an eddy as wide as the jet, carried past at its speed.
const EDDY_TIME_S: f64 = 0.15;
/// Beyond, across, nothing is felt: there the speed has fallen below 0.1 m/s where drones of one room fly.
const WASH_RADIUS_M: f64 = 1.0;

/// Speed of the air through the rotors of a drone that hovers: `sqrt(m g / (2 rho A))`, about 3.7 m/s.
fn induced_m_s() -> f64 {
    (MASS_KG * GRAVITY_M_S2 / (2.0 * AIR_KG_M3 * DISC_AREA_M2)).sqrt()
}

/// The mean flow at a place, relative to the drone that hovers above it (right, forward, up); none beside and above.
///
/// Momentum theory (Leishman, *Principles of Helicopter Aerodynamics*, section 2.2) gives the speed `v = sqrt(m g / (2 rho A))`
/// at the rotors; below them the wake contracts, and on the axis of a rotor of radius R the air gets faster as
/// `v (1 + z / sqrt(z² + R²))`, up to `2 v`. The wakes of the four rotors merge and spread as one turbulent jet, whose speed is a
/// Gaussian across, `exp(-(r / s)²)`, of width `s = s0 + 0.12 z`. It keeps its momentum, which is the weight of the drone:
/// `rho V² pi s² / 2 = m g`; with `V = 2 v` at the rotors, `s0 = sqrt(A / pi)` = 0.2 m, and below `V = 2 v s0 / s`. As the jet
/// widens, the air moves outwards by `0.12 r / s` of its speed. The form is that of Jain, Fortmuller, Byun, Mäkiharju and Mueller,
/// *Modeling of aerodynamic disturbances for proximity flight of multirotors* (2019).
///
/// 1 m below that is 4.6 m/s, 2 m below 3.3 m/s, and a twentieth of it 0.55 m and 0.76 m beside the axis. That a wake lags
/// behind, and trails a drone that flies fast, is not modelled, nor how it spreads on the floor.
fn wash_of(from_above_m: Vector3<f64>) -> Option<Wash> {
    let below_m = -from_above_m.z;
    let across_m = from_above_m.xy();
    if below_m <= 0.0 || across_m.norm() > WASH_RADIUS_M {
        return None;
    }
    let least_width_m = (DISC_AREA_M2 / std::f64::consts::PI).sqrt();
    let width_m = least_width_m + SPREADING * below_m;
    let contracted = 1.0 + below_m / below_m.hypot(ROTOR_RADIUS_M);
    let axis_m_s = induced_m_s() * contracted * least_width_m / width_m;
    let down_m_s = axis_m_s * (-(across_m.norm() / width_m).powi(2)).exp();
    Some(Wash { down_m_s, across_m_s: across_m * (SPREADING / width_m * down_m_s) })
}

/// The others in the air of one drone, and what it feels of them.
#[derive(Debug, Clone)]
pub(crate) struct Others {
    /// Where they are in the frame of this drone.
    present: Vec<Presence>,
    /// Gusts in units of their deviation: across, and (first axis) downwards.
    across: GaussMarkov,
    down: GaussMarkov,
}

impl Others {
    pub(crate) fn new(seed: u64) -> Self {
        let gusts = |word: u64| {
            GaussMarkov::at_zero(1.0, EDDY_TIME_S, ChaCha8Rng::seed_from_u64(seed ^ word))
        };
        Self { present: Vec::new(), across: gusts(0x7761_7368), down: gusts(0x646f_776e) }
    }

    pub(crate) fn are(&mut self, others: impl IntoIterator<Item = Presence>) {
        self.present.clear();
        self.present.extend(others);
    }

    /// The wash in the next physics step; no random number is drawn without one.
    pub(crate) fn wash(&mut self, position_m: Vector3<f64>) -> Option<Wash> {
        let above = self.present.iter().filter(|other| other.rotors_turn);
        let washes = above.filter_map(|other| wash_of(position_m - other.position_m));
        let mean = washes.reduce(|one, other| Wash {
            down_m_s: one.down_m_s + other.down_m_s,
            across_m_s: one.across_m_s + other.across_m_s,
        })?;
        let gust_m_s = mean.down_m_s * TURBULENCE;
        Some(Wash {
            down_m_s: (mean.down_m_s + self.down.step().x * gust_m_s).max(0.0),
            across_m_s: mean.across_m_s + self.across.step() * gust_m_s,
        })
    }

    pub(crate) fn is_alone(&self) -> bool {
        self.present.is_empty()
    }

    /// The share of the others' pulses that is loud enough to be taken for one's own, summed over all others.
    pub(crate) fn heard(&self, position_m: Vector3<f64>, ultrasound: i64) -> f64 {
        let same = self.present.iter().filter(|other| other.ultrasound == ultrasound);
        same.map(|other| {
            let apart_m = (position_m - other.position_m).norm();
            LOUD * (1.0 - apart_m / ULTRASOUND_M).max(0.0)
        })
        .sum()
    }
}

/// Drones nearer to each other hear each other's ultrasound (Parrot's developer guide).
const ULTRASOUND_M: f64 = 3.0;
/// Share of the pulses of a drone right beside that is loud enough: it sends them down, and what is heard of them is what the
/// floor scatters. Chosen, with the linear fall to nothing at 3 m: nobody has published a measurement.
const LOUD: f64 = 0.3;
/// Height from which an echo takes as long as the time between two pulses: 343 m/s, there and back, 25 times a second.
const PULSE_INTERVAL_M: f64 = 343.0 / 2.0 / 25.0;
/// The sensor measures nothing lower in the air.
const LEAST_ECHO_M: f64 = 0.2;
/// Share of the pulses of others that cover the own echo, so that there is no measurement.
const MISSING: f64 = 0.25;

/// What the pulses of others make of heights.
///
/// A pulse of another drone comes at any time of the interval between two pulses. The sensor takes the first one it hears, so
/// that it is taken for the own echo if it is loud enough and comes before that: the more often the nearer the other one is and
/// the higher the drone flies, 1 m beside another one at 1.5 m once in 23 measurements. It then is too low by anything, or
/// missing.
#[derive(Debug, Clone)]
pub(crate) struct ForeignPulses {
    /// See [`Others::heard`].
    pub(crate) heard: f64,
    random: ChaCha8Rng,
}

impl ForeignPulses {
    pub(crate) fn new(seed: u64) -> Self {
        Self { heard: 0.0, random: ChaCha8Rng::seed_from_u64(seed ^ 0x7075_6c73) }
    }

    /// The height that is measured in place of this one; none if there is no measurement.
    pub(crate) fn disturb(&mut self, height_m: f64) -> Option<f64> {
        if self.heard <= 0.0 {
            return Some(height_m);
        }
        let share = (self.heard * height_m / PULSE_INTERVAL_M).clamp(0.0, 1.0);
        if !self.random.random_bool(share) {
            return Some(height_m);
        }
        let is_missing = self.random.random_bool(MISSING);
        let low_m = self.random.random_range(LEAST_ECHO_M.min(height_m)..=height_m);
        (!is_missing).then_some(low_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wash(across_m: f64, up_m: f64) -> Option<Wash> {
        wash_of(Vector3::new(across_m, 0.0, up_m))
    }

    #[test]
    fn the_wash_carries_the_weight_at_each_height_below() {
        assert!((induced_m_s() - 3.66).abs() < 0.01, "{}", induced_m_s());
        let weight_n = MASS_KG * GRAVITY_M_S2;
        for below_m in [0.5, 1.0, 2.0] {
            // rho V² over rings of 1 mm.
            let rings = (0..1000).map(|ring| {
                let radius_m = (f64::from(ring) + 0.5) / 1000.0;
                let down_m_s = wash(radius_m, -below_m).unwrap().down_m_s;
                AIR_KG_M3 * down_m_s.powi(2) * std::f64::consts::TAU * radius_m / 1000.0
            });
            let carried_n: f64 = rings.sum();
            assert!((carried_n / weight_n - 1.0).abs() < 0.05, "{below_m}: {carried_n}");
        }
    }

    #[test]
    fn the_wash_slows_and_widens_below_and_is_nowhere_else() {
        let down = |across_m, up_m| wash(across_m, up_m).map_or(0.0, |wash| wash.down_m_s);
        assert!((down(0.0, -1e-6) - induced_m_s()).abs() < 0.01);
        assert!((down(0.0, -0.25) / induced_m_s()) > 1.6, "faster where it contracts");
        for (below_m, down_m_s) in [(1.0, 4.57), (2.0, 3.33), (4.0, 2.15)] {
            assert!((down(0.0, -below_m) - down_m_s).abs() < 0.02, "{}", down(0.0, -below_m));
        }
        assert!(
            down(0.5, -0.5) < 0.2 * down(0.0, -0.5) && down(0.5, -2.0) > 0.25 * down(0.0, -2.0)
        );
        for nowhere in [wash(0.0, 0.0), wash(0.0, 0.5), wash(1.01, -1.0), wash(2.0, 0.0)] {
            assert_eq!(nowhere, None);
        }
        let out_m_s = wash_of(Vector3::new(0.0, -0.3, -1.0)).unwrap().across_m_s;
        assert!(out_m_s.x.abs() < 1e-9 && (-0.4..-0.1).contains(&out_m_s.y), "{out_m_s}");
    }

    #[test]
    fn rotors_that_stand_move_no_air() {
        let mut others = Others::new(1);
        let other = |rotors_turn| Presence {
            position_m: Vector3::new(0.0, 0.0, 2.0),
            rotors_turn,
            ultrasound: 8,
        };
        others.are([other(false)]);
        assert_eq!(others.wash(Vector3::zeros()), None);
        others.are([other(true)]);
        let down: Vec<f64> =
            (0..8000).map(|_| others.wash(Vector3::zeros()).unwrap().down_m_s).collect();
        let mean_m_s = down.iter().sum::<f64>() / 8000.0;
        let square: f64 = down.iter().map(|down_m_s| (down_m_s - mean_m_s).powi(2)).sum();
        let deviation_m_s = (square / 8000.0).sqrt();
        assert!((mean_m_s - 3.33).abs() < 0.3, "{mean_m_s}");
        assert!((deviation_m_s - 0.25 * 3.33).abs() < 0.25, "{deviation_m_s}");
        others.are([]);
        assert_eq!(others.wash(Vector3::zeros()), None);
    }

    #[test]
    fn pulses_of_the_same_frequency_nearby_are_heard() {
        let mut others = Others::new(1);
        others.are([2.9, 3.1].map(|x_m| Presence {
            position_m: Vector3::new(x_m, 0.0, 1.0),
            rotors_turn: false,
            ultrasound: 8,
        }));
        let here = Vector3::new(0.0, 0.0, 1.0);
        let is = |share: f64, expected: f64| (share - expected).abs() < 1e-9;
        assert!(is(others.heard(here, 8), 0.3 * 0.1 / 3.0), "{}", others.heard(here, 8));
        assert!(is(others.heard(here, 7), 0.0));
        assert!(is(others.heard(Vector3::new(3.0, 0.0, 1.0), 8), 2.0 * 0.3 * 2.9 / 3.0));
    }

    #[test]
    fn heights_are_too_low_or_missing_the_more_often_the_higher_the_drone_flies() {
        let disturbed = |heard, height_m: f64| {
            let mut pulses = ForeignPulses { heard, ..ForeignPulses::new(3) };
            let read: Vec<_> = (0..10_000).map(|_| pulses.disturb(height_m)).collect();
            assert!(read.iter().flatten().all(|read_m| (0.2..=height_m).contains(read_m)));
            let missing = read.iter().filter(|read| read.is_none()).count();
            let low = read.iter().flatten().filter(|read_m| **read_m < height_m).count();
            (missing, low)
        };
        assert_eq!(disturbed(0.0, 1.5), (0, 0));
        let (missing, low) = disturbed(1.0, 1.5);
        assert!(missing.abs_diff(547) < 80 && low.abs_diff(1640) < 120, "{missing} {low}");
        let (missing, low) = disturbed(2.0, 3.0);
        assert!(missing.abs_diff(2187) < 150 && low.abs_diff(6560) < 200, "{missing} {low}");
    }

    #[test]
    fn places_turn_into_the_common_frame_and_back() {
        let standing = Standing { place_m: Vector2::new(3.0, -1.0), heading_deg: 90.0 };
        let ahead = standing.in_common(Vector3::new(0.0, 2.0, 1.0));
        assert!((ahead - Vector3::new(5.0, -1.0, 1.0)).norm() < 1e-12, "{ahead}");
        assert!((standing.seen_from_start(ahead) - Vector3::new(0.0, 2.0, 1.0)).norm() < 1e-12);
    }
}
