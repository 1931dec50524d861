//! Other vehicles in the same room, and the room that they leave.
//!
//! Each vehicle keeps to its side of a line between itself and each other one, of which both know the same: Voronoi cells
//! with a buffer (Zhou, Wang, Bandyopadhyay and Schwager, "Fast, On-line Collision Avoidance for Dynamic Vehicles Using
//! Buffered Voronoi Cells", 2017). The line divides what is left of the distance between the places where both would come
//! to rest: whoever is fast has more of it. Lines are upright, so that nobody flies above or below another, whose downwash
//! carries it off, and no wrong height brings two together.

mod passing;

use std::time::Duration;

use arrayvec::ArrayVec;
use nalgebra::Vector2;

use crate::fence::Wall;
use crate::safety::Stopping;

pub use self::passing::{Claim, Rank};
pub(crate) use self::passing::{Progress, makes_way, waits, way_past};

/// Most other vehicles that are kept apart from.
pub const MAX_NEIGHBOURS: usize = 31;
/// Standard deviations of the distance between two by which they keep further apart.
const DEVIATIONS: f64 = 2.0;
/// What another vehicle may accelerate with while it is not heard, and the speed that it may reach.
const ACCELERATES_M_S2: f64 = 3.0;
const FASTEST_M_S: f64 = 3.0;
/// Who has not been heard for this long is no longer taken to go on as it did.
const GOES_ON: Duration = Duration::from_millis(300);
/// A vehicle that has not been heard for this long is silent: nobody takes off where it is.
const SILENT: Duration = Duration::from_secs(2);
/// A place moves by this, and this many standard deviations, without a motion: a tag corrects it.
const JUMP_M: f64 = 0.3;
const JUMP_DEVIATIONS: f64 = 4.0;
/// Who was where it cannot have got to is believed again by so much in each second.
const REGAINED_M_S: f64 = 0.1;

/// Whether a vehicle is in the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Presence {
    /// It stands on the ground.
    Stands,
    /// It is about to take off, when the others have had time to hear it: they keep away from it.
    Starts,
    /// It is in the air.
    Flies,
}

/// What a vehicle tells the others of itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbour {
    /// The number of its MAVLink system, which is its own among all in the room.
    pub system: u8,
    /// When it was there, by the clock of whoever hears it.
    pub at: Duration,
    /// Its place in the common frame: (x, y).
    pub place_m: Vector2<f64>,
    /// Its velocity in the common frame: (x, y).
    pub velocity_m_s: Vector2<f64>,
    /// Standard deviation of the place on the worse axis.
    pub uncertainty_m: f64,
    /// Least distance that it keeps from others, across.
    pub separation_m: f64,
    /// Whether it is in the air.
    pub presence: Presence,
    /// The way that it claims, if it has been held up, or makes way itself.
    pub claim: Option<Claim>,
}

impl Neighbour {
    /// Whether all its numbers are usable.
    fn is_sound(&self) -> bool {
        let numbers = self.place_m.iter().chain(&self.velocity_m_s);
        let numbers = numbers.chain(self.claim.iter().flat_map(|claim| &claim.to_m));
        numbers.chain([&self.uncertainty_m, &self.separation_m]).all(|number| number.is_finite())
            && self.uncertainty_m >= 0.0
    }

    /// Where it is at a time if it went on for a while, and how far from there it can have got.
    fn reach(&self, now: Duration) -> (Vector2<f64>, f64) {
        let age = now.saturating_sub(self.at);
        let age_s = age.as_secs_f64();
        let place_m = self.place_m + self.velocity_m_s * age.min(GOES_ON).as_secs_f64();
        let braked_m = self.velocity_m_s.norm() * age.saturating_sub(GOES_ON).as_secs_f64();
        let accelerated_m = ACCELERATES_M_S2 * age_s * age_s / 2.0;
        (place_m, (accelerated_m + braked_m).min(FASTEST_M_S * age_s))
    }
}

/// Why what a vehicle tells of itself is not believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NotHeard {
    /// A number is not finite, or the deviation is negative.
    #[error("another vehicle tells nonsense of its position")]
    Nonsense,
    /// It cannot have got there. It is taken to be there, but as uncertain as the way that it cannot have flown.
    #[error("another vehicle is where it cannot have got to")]
    Jumps,
    /// It has this vehicle's number.
    #[error("another vehicle has the same number")]
    Oneself,
    /// There are more than [`MAX_NEIGHBOURS`].
    #[error("more than {MAX_NEIGHBOURS} other vehicles cannot be kept apart from")]
    TooMany,
}

/// The other vehicles, as they were heard last.
#[derive(Debug, Clone, Default)]
pub(crate) struct Neighbours(ArrayVec<Known, MAX_NEIGHBOURS>);

#[derive(Debug, Clone, Copy)]
struct Known {
    /// What it told last.
    told: Neighbour,
    /// By how much it was where it cannot have got to, in metres: its place is as uncertain as that. It becomes less while it
    /// goes on as it can, and ends on the ground.
    doubt_m: f64,
}

/// A vehicle that keeps away from others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Oneself {
    pub(crate) system: u8,
    /// That of its own claim.
    pub(crate) rank: Option<Rank>,
    pub(crate) place_m: Vector2<f64>,
    pub(crate) velocity_m_s: Vector2<f64>,
    pub(crate) uncertainty_m: f64,
    /// Least distance from others.
    pub(crate) separation_m: f64,
}

/// Another vehicle as seen from here.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Other {
    pub(crate) place_m: Vector2<f64>,
    separation_m: f64,
    /// How near to its place this vehicle may come.
    pub(crate) keep_m: f64,
    /// How far from its place it may be because it was where it cannot have got to.
    doubtful_m: f64,
    /// The way that it claims, if this vehicle has to make it.
    claim: Option<Claim>,
    /// Unit vector towards it.
    outward: Vector2<f64>,
    /// The line between the two: how far along that vector it is from the origin.
    line_m: f64,
}

impl Other {
    /// The line as a wall, as seen from a place.
    pub(crate) fn wall(&self, place_m: Vector2<f64>) -> Wall {
        let distance_m = self.line_m - place_m.dot(&self.outward);
        Wall { distance_m, outward: self.outward }
    }

    /// Whether it may be in any direction, as seen from a place: it contradicts itself by more than the way between the two, so
    /// that the place that it tells is no likelier than others. Of one that is only uncertain, or silent, it is.
    pub(crate) fn is_anywhere(&self, from_m: Vector2<f64>) -> bool {
        (self.place_m - from_m).norm() < self.doubtful_m
    }

    /// Whether a straight way passes it too near. Who wants to where the other is has to wait.
    fn blocks(&self, from_m: Vector2<f64>, to_m: Vector2<f64>) -> bool {
        let way_m = to_m - from_m;
        let along = (self.place_m - from_m).dot(&way_m) / way_m.norm_squared().max(f64::EPSILON);
        let nearest_m = from_m + way_m * along.clamp(0.0, 1.0);
        along > 0.0
            && (nearest_m - self.place_m).norm() < self.keep_m
            && (to_m - self.place_m).norm() > self.keep_m
    }
}

/// All others in the air.
pub(crate) type Others = ArrayVec<Other, MAX_NEIGHBOURS>;

impl Neighbours {
    /// Another vehicle tells of itself.
    pub(crate) fn hear(&mut self, neighbour: Neighbour) -> Result<(), NotHeard> {
        if !neighbour.is_sound() {
            return Err(NotHeard::Nonsense);
        }
        let known = self.0.iter_mut().find(|known| known.told.system == neighbour.system);
        let Some(known) = known else {
            let known = Known { told: neighbour, doubt_m: 0.0 };
            return self.0.try_push(known).map_err(|_| NotHeard::TooMany);
        };
        let Known { told, doubt_m } = *known;
        // An older message may come later.
        if neighbour.at < told.at {
            return Ok(());
        }
        let (place_m, reach_m) = told.reach(neighbour.at);
        let uncertainty_m = told.uncertainty_m.hypot(neighbour.uncertainty_m);
        let furthest_m = reach_m + JUMP_M + JUMP_DEVIATIONS * uncertainty_m;
        let jump_m = (neighbour.place_m - place_m).norm();
        let stands = neighbour.presence == Presence::Stands;
        let has_jumped = jump_m > furthest_m && !stands;
        let regained_m = REGAINED_M_S * neighbour.at.saturating_sub(told.at).as_secs_f64();
        let doubt_m = if stands { 0.0 } else { (doubt_m - regained_m).max(0.0) };
        *known = Known {
            told: neighbour,
            doubt_m: if has_jumped { doubt_m.max(jump_m) } else { doubt_m },
        };
        if has_jumped { Err(NotHeard::Jumps) } else { Ok(()) }
    }

    /// Whether none has ever been heard.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether this one has told of itself, not too long ago.
    pub(crate) fn is_heard(&self, system: u8, now: Duration) -> bool {
        let known = self.0.iter().find(|known| known.told.system == system);
        known.is_some_and(|known| {
            now.saturating_sub(known.told.at) <= SILENT && known.doubt_m == 0.0
        })
    }

    /// Those near to whom a vehicle must not take off, with their distances across: who flies or is about to, if the two are
    /// not separated, and who stands nearer than they may be. Of two that are about to, the one with the lower number does.
    pub(crate) fn too_near(
        &self,
        now: Duration,
        oneself: Oneself,
    ) -> impl Iterator<Item = (u8, f64)> {
        self.0.iter().filter_map(move |known| {
            let Neighbour { system, presence, .. } = known.told;
            let other = other(now, &oneself, known);
            let away_m = (other.place_m - oneself.place_m).norm();
            let is_beyond = other.wall(oneself.place_m).distance_m < 0.0;
            let is_near = match presence {
                Presence::Stands => away_m < other.separation_m,
                Presence::Starts => {
                    away_m < other.separation_m || is_beyond && system < oneself.system
                }
                Presence::Flies => is_beyond,
            };
            is_near.then_some((system, away_m))
        })
    }

    /// Those in the air or about to be, as seen by a vehicle.
    pub(crate) fn others(&self, now: Duration, oneself: &Oneself) -> Others {
        let flying = self.0.iter().filter(|known| known.told.presence != Presence::Stands);
        flying.map(|known| other(now, oneself, known)).collect()
    }
}

/// How much nearer to each other two may be than they are known to be, in metres, by the standard deviations of their places:
/// two of those of their distance.
pub fn unsure_m([one_m, other_m]: [f64; 2]) -> f64 {
    DEVIATIONS * one_m.hypot(other_m)
}

fn other(now: Duration, oneself: &Oneself, known: &Known) -> Other {
    let Known { told: neighbour, doubt_m } = known;
    let (place_m, reach_m) = neighbour.reach(now);
    let way_m = place_m - oneself.place_m;
    // Two in one place have to part in some direction.
    let outward = way_m.try_normalize(f64::EPSILON).unwrap_or_else(Vector2::x);
    let to_rest_m = |speed_m_s: f64| Stopping::CAUTIOUS.way_m(speed_m_s.max(0.0));
    let ours_m = to_rest_m(oneself.velocity_m_s.dot(&outward));
    let theirs_m = to_rest_m(-neighbour.velocity_m_s.dot(&outward));
    // Of both separations the larger one, so that both draw the same line.
    let separation_m = oneself.separation_m.max(neighbour.separation_m);
    let their_uncertainty_m = neighbour.uncertainty_m.hypot(*doubt_m);
    let keep_m = separation_m + unsure_m([oneself.uncertainty_m, their_uncertainty_m]) + reach_m;
    let doubtful_m = DEVIATIONS * doubt_m;
    let between_m = way_m.norm() - keep_m;
    // Who is too fast to stop before the other has no more room for that, and two that are too near each go half of the way
    // back.
    let most_m = between_m.max(between_m / 2.0);
    let room_m = ((between_m + ours_m - theirs_m) / 2.0).min(most_m);
    let line_m = oneself.place_m.dot(&outward) + room_m;
    let makes_way = |claim: &Claim| claim.is_before(neighbour.system, oneself.rank, oneself.system);
    let claim = neighbour.claim.filter(makes_way);
    Other { place_m, separation_m, keep_m, doubtful_m, claim, outward, line_m }
}

#[cfg(test)]
mod tests;
