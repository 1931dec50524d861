//! The air between the vehicles of a fleet: how their messages travel, and what one of them tells that is not so.

use std::collections::VecDeque;
use std::time::Duration;

use autopilot::separation::Neighbour;
use kinematics::world_from_body;
use nalgebra::Vector2;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// By how much the direction of a place that jumps turns with each jump, in degrees.
const TURNS_DEG: f64 = 137.0;

/// How messages between vehicles travel, and whether more than messages does.
#[derive(Debug, Clone, Default)]
pub struct Air {
    /// Share of them that is lost.
    pub loss: f64,
    /// Delay of each, and at most so much more: a later message may come first.
    pub delay: Duration,
    /// See [`Air::delay`].
    pub jitter: Duration,
    /// From when to when none arrives.
    pub silent: Option<[Duration; 2]>,
    /// Who does not hear whom.
    pub partitions: Vec<Partition>,
    /// What one of them tells that is not so.
    pub lie: Option<Lie>,
    /// Seed of losses and jitter.
    pub seed: u64,
    /// Whether the drones share the air: each feels the wash of those above, and hears the ultrasound of those nearby.
    pub is_shared: bool,
}

/// One vehicle is not heard by another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Partition {
    /// The number of the one that is not heard.
    pub of: usize,
    /// By whom.
    pub by: usize,
    /// From when to when.
    pub at: [Duration; 2],
}

/// A vehicle tells others what is not so, from a time on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lie {
    /// Its number.
    pub who: usize,
    /// From when on.
    pub since: Duration,
    /// What.
    pub what: Falsehood,
}

/// What a vehicle tells that is not so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Falsehood {
    /// Its place is off by this, right and forward.
    Place(Vector2<f64>),
    /// Its place is off by so much, in another direction each second.
    Jumps(f64),
    /// Its place moves off with this velocity: as slowly as a vehicle flies, so that nobody can notice.
    Creeps(Vector2<f64>),
    /// Its velocity is off by this.
    Velocity(Vector2<f64>),
    /// It stays where it was at the beginning, and tells so as if it was just measured: nobody can notice.
    Stale,
    /// The message of the beginning comes again and again, with its old time.
    Repeats,
}

impl Falsehood {
    /// Whether nobody can tell it from the truth: who believes it makes no mistake.
    pub fn is_credible(self) -> bool {
        matches!(self, Self::Creeps(_) | Self::Stale)
    }
}

impl Lie {
    /// What becomes of a message; `begun` is the one with which the lie began.
    fn of(&self, now: Duration, truth: Neighbour, begun: &Neighbour) -> Neighbour {
        let Neighbour { place_m, velocity_m_s, .. } = truth;
        let lasted = now.saturating_sub(self.since);
        match self.what {
            Falsehood::Place(off_m) => Neighbour { place_m: place_m + off_m, ..truth },
            Falsehood::Jumps(off_m) => {
                let turned_deg = TURNS_DEG * lasted.as_secs_f64().floor();
                let off_m = world_from_body(Vector2::new(0.0, off_m), turned_deg);
                Neighbour { place_m: place_m + off_m, ..truth }
            }
            Falsehood::Creeps(off_m_s) => {
                Neighbour { place_m: place_m + off_m_s * lasted.as_secs_f64(), ..truth }
            }
            Falsehood::Velocity(off_m_s) => {
                Neighbour { velocity_m_s: velocity_m_s + off_m_s, ..truth }
            }
            Falsehood::Stale => Neighbour { at: truth.at, presence: truth.presence, ..*begun },
            Falsehood::Repeats => *begun,
        }
    }
}

impl Air {
    /// What a vehicle tells in place of the truth.
    pub(super) fn told(
        &self,
        now: Duration,
        from: usize,
        truth: Neighbour,
        begun: &mut Option<Neighbour>,
    ) -> Neighbour {
        match &self.lie {
            Some(lie) if lie.who == from && now >= lie.since => {
                lie.of(now, truth, begun.get_or_insert(truth))
            }
            _ => truth,
        }
    }

    /// Whether what a vehicle tells is false, and nobody can tell.
    pub(super) fn is_credible_lie(&self, now: Duration, from: usize) -> bool {
        let tells = |lie: &Lie| lie.who == from && now >= lie.since && lie.what.is_credible();
        self.lie.as_ref().is_some_and(tells)
    }

    /// When a message arrives, if it does.
    pub(super) fn arrives(
        &self,
        now: Duration,
        [from, to]: [usize; 2],
        random: &mut ChaCha8Rng,
    ) -> Option<Duration> {
        let lasts = |[begins, ends]: [Duration; 2]| (begins..ends).contains(&now);
        let is_cut =
            self.partitions.iter().any(|cut| (cut.of, cut.by) == (from, to) && lasts(cut.at));
        let is_lost = random.random::<f64>() < self.loss;
        let late = self.jitter.mul_f64(random.random());
        let is_heard = !is_lost && !is_cut && !self.silent.is_some_and(lasts);
        is_heard.then_some(now + self.delay + late)
    }
}

/// Messages on their way to one vehicle.
#[derive(Debug, Default)]
pub(super) struct Mail(VecDeque<(Duration, Neighbour)>);

impl Mail {
    pub(super) fn put(&mut self, arrives: Duration, message: Neighbour) {
        let place = self.0.partition_point(|(at, _)| *at <= arrives);
        self.0.insert(place, (arrives, message));
    }

    pub(super) fn take(&mut self, now: Duration) -> Option<Neighbour> {
        self.0.pop_front_if(|(at, _)| *at <= now).map(|(_, message)| message)
    }
}
