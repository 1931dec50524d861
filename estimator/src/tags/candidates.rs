//! What may become a known tag: something that was seen at one place again and again.

use nalgebra::Vector2;

use super::filter::Sighted;

/// So many sights make a tag of it. One would not do: its noise would stay in the tag's place for good.
const ENOUGH: u32 = 30;
/// What is not seen again within this time is forgotten.
const FORGOTTEN_S: f64 = 3.0;
/// Sights this near to each other are of the same thing.
const SAME_M: f64 = 0.3;
/// False sights fill some of these and are forgotten.
const MOST: usize = 6;

/// Something that may be a tag.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub(super) place_m: Vector2<f64>,
    sights: u32,
    last_s: f64,
}

#[derive(Debug, Clone, Default)]
pub(super) struct Candidates {
    slots: [Option<Candidate>; MOST],
}

impl Candidates {
    /// A sight that is of no known tag; the candidate that it makes a tag, if it does.
    pub(super) fn saw(&mut self, now_s: f64, sighted: &Sighted) -> Option<Candidate> {
        for slot in &mut self.slots {
            _ = slot.take_if(|candidate| now_s - candidate.last_s > FORGOTTEN_S);
        }
        let far = |candidate: &Candidate| (candidate.place_m - sighted.place_m).norm();
        let near = self
            .slots
            .iter_mut()
            .filter(|slot| slot.as_ref().is_some_and(|candidate| far(candidate) < SAME_M))
            .min_by_key(|slot| slot.map_or(u32::MAX, |candidate| u32::MAX - candidate.sights));
        if let Some(slot) = near {
            let candidate = slot.as_mut()?;
            candidate.sights += 1;
            candidate.last_s = now_s;
            let share = 1.0 / f64::from(candidate.sights);
            candidate.place_m += (sighted.place_m - candidate.place_m) * share;
            let enough = candidate.sights >= ENOUGH;
            return if enough { slot.take() } else { None };
        }
        let new = Candidate { place_m: sighted.place_m, sights: 1, last_s: now_s };
        let weakest = self.slots.iter_mut().min_by_key(|slot| slot.map_or(0, |known| known.sights));
        if let Some(slot) = weakest {
            *slot = Some(new);
        }
        None
    }
}
