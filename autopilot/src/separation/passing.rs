//! How vehicles get past each other: on which side, and who makes way for whom.
//!
//! Usually nobody has to know what another one wants: each passes whoever is in its way, on the right where the fence leaves
//! room there. Who has not come nearer to its target for a while all the same claims the way there, and those that claim none,
//! or have a higher number, make it: whatever they do themselves, also if they only hover. One of all is the first, so that
//! not all of them wait.

use std::time::Duration;

use kinematics::world_from_body;
use nalgebra::Vector2;

use super::{Other, Others};
use crate::fence::Border;

/// Who comes nearer to its target by less than this in so long is held up, unless it is as near to it. A target that is
/// further from the last one is another.
const NEARER_M: f64 = 0.3;
const HELD_UP: Duration = Duration::from_secs(6);
/// Who makes way goes further than it must: the claimed way may turn, and places become less certain.
const ASIDE_M: f64 = 0.5;
/// Directions in which to make way, from the nearest one, in degrees clockwise.
const TURNS_DEG: [f64; 8] = [0.0, 45.0, -45.0, 90.0, -90.0, 135.0, -135.0, 180.0];
/// Most that make way for each other, one behind the other: without an end, two could do so in turn for ever.
const MOST_BEHIND: u8 = 4;

/// Who goes first: the least one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    /// The number of the vehicle that has been held up.
    pub system: u8,
    /// Zero for that one, and one more for each that makes way for the one before it.
    pub behind: u8,
}

/// A way that a vehicle wants to have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claim {
    /// From its place to this one, in the common frame: (x, y).
    pub to_m: Vector2<f64>,
    /// Before whom it goes.
    pub rank: Rank,
}

impl Claim {
    /// Whether a vehicle with that claim of its own makes way for this one of another.
    pub(super) fn is_before(&self, system: u8, own: Option<Rank>, own_system: u8) -> bool {
        let is_first = own.is_none_or(|own| (self.rank, system) < (own, own_system));
        is_first && self.rank.behind < MOST_BEHIND
    }
}

/// How one vehicle gets on with its way to a target.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Progress {
    target_m: Vector2<f64>,
    /// The least distance to the target, and when that was.
    nearest_m: f64,
    at: Duration,
    is_held_up: bool,
}

impl Progress {
    pub(crate) fn new(now: Duration, target_m: Vector2<f64>) -> Self {
        Self { target_m, nearest_m: f64::INFINITY, at: now, is_held_up: false }
    }

    /// Takes in where the vehicle is on its way. Returns whether it has been held up: until it is there. Who makes way for
    /// another is not held up by it.
    pub(crate) fn is_held_up(
        &mut self,
        now: Duration,
        here_m: Vector2<f64>,
        target_m: Vector2<f64>,
        makes_way: bool,
    ) -> bool {
        if (target_m - self.target_m).norm() > NEARER_M {
            *self = Self::new(now, target_m);
        }
        let away_m = (target_m - here_m).norm();
        let is_there = away_m < NEARER_M;
        if makes_way || is_there || away_m < self.nearest_m - NEARER_M {
            (self.nearest_m, self.at) = (away_m, now);
        }
        let is_late = now.saturating_sub(self.at) >= HELD_UP;
        self.is_held_up = (self.is_held_up || is_late) && !is_there;
        self.is_held_up
    }
}

impl Other {
    /// The nearest place of the way that it claims.
    fn way_m(&self, to_m: Vector2<f64>) -> Option<Vector2<f64>> {
        let way_m = self.claim?.to_m - self.place_m;
        let along = (to_m - self.place_m).dot(&way_m) / way_m.norm_squared().max(f64::EPSILON);
        Some(self.place_m + way_m * along.clamp(0.0, 1.0))
    }

    /// How far a place is from where one is too near to that way.
    fn clearance_m(&self, place_m: Vector2<f64>) -> f64 {
        let away_m = |way_m: Vector2<f64>| (place_m - way_m).norm() - self.keep_m;
        self.way_m(place_m).map_or(f64::INFINITY, away_m)
    }

    /// Where to make that way, if there is room.
    fn beside_way_m(&self, here_m: Vector2<f64>, border: &Border) -> Option<Vector2<f64>> {
        let way_m = self.way_m(here_m)?;
        let across = || Vector2::new(self.outward.y, -self.outward.x);
        let nearest = (here_m - way_m).try_normalize(f64::EPSILON).unwrap_or_else(across);
        let place_m = |turned_deg| {
            let side = world_from_body(nearest, turned_deg);
            border.nearest_inside(way_m + side * (self.keep_m + ASIDE_M), 0.0)
        };
        let has_room = |place_m: &Vector2<f64>| self.clearance_m(*place_m) > ASIDE_M / 2.0;
        TURNS_DEG.into_iter().map(place_m).find(has_room)
    }
}

/// The way that leads out of those which others claim, if a vehicle is in one of them and has room beside it.
pub(crate) fn makes_way(here_m: Vector2<f64>, others: &Others, border: &Border) -> Option<Claim> {
    let met = others.iter().filter(|other| other.clearance_m(here_m) < ASIDE_M / 2.0);
    let first = met.min_by_key(|other| other.claim.map(|claim| claim.rank))?;
    let Rank { system, behind } = first.claim?.rank;
    let to_m = first.beside_way_m(here_m, border)?;
    Some(Claim { to_m, rank: Rank { system, behind: behind + 1 } })
}

/// Whether a vehicle is beside a way that another claims, and its target is in it.
pub(crate) fn waits(here_m: Vector2<f64>, target_m: Vector2<f64>, others: &Others) -> bool {
    let is_near = |other: &Other| other.clearance_m(here_m) < 2.0 * ASIDE_M;
    others.iter().any(|other| is_near(other) && other.clearance_m(target_m) < 0.0)
}

/// Where to fly to on the way to a target: there, or past who is in the way, on the right of it, or on the left if the fence
/// leaves room only there. As everybody keeps to the right, two that meet do not block each other where there is room.
pub(crate) fn way_past(
    from_m: Vector2<f64>,
    target_m: Vector2<f64>,
    others: &Others,
    border: &Border,
) -> Vector2<f64> {
    let distance_m = |other: &&Other| (other.place_m - from_m).norm();
    let in_the_way = others.iter().filter(|other| other.blocks(from_m, target_m));
    let nearest = in_the_way.min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
    let Some(other) = nearest else { return target_m };
    let away_m = distance_m(&other).max(f64::EPSILON);
    let sine = (other.keep_m / away_m).min(1.0);
    let cosine = (1.0 - sine * sine).sqrt();
    let ahead = other.outward;
    let right = Vector2::new(ahead.y, -ahead.x);
    // Along the tangents, of which the right one is clockwise as seen from above.
    let tangents = [right, -right].map(|side| ahead * cosine + side * sine);
    let beside_m = (away_m * cosine).max(NEARER_M);
    let is_inside =
        |tangent: &&Vector2<f64>| border.outside_m(from_m + **tangent * beside_m) <= 0.0;
    let tangent = tangents.iter().find(is_inside).unwrap_or(&tangents[0]);
    from_m + tangent * (target_m - from_m).norm()
}
