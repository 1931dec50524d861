//! What each quantity in navdata is worth, by the evidence against it.
//!
//! Whatever shows that a quantity is wrong is [`Evidence`], and counts as a time for which it was wrong. That time is
//! summed up and slowly forgotten (a cumulative sum; Page, 1954): one bad packet is no reason to worry, many in a row are,
//! and so are pulses of them. All of it is dated by the arrival of the packets, the only clock that a broken drone cannot
//! stop.

use crate::silence::USUAL_STEP_S;
use crate::trust::{Quantity, Trust, Worth};

/// A quantity that was wrong for longer than this is disproved.
pub(crate) const ENOUGH_S: f64 = 0.4;
/// Share of the time that is forgotten, per second.
const FORGOTTEN_1_S: f64 = 0.1;
/// A disproved quantity stays so until as much would be forgotten, after the last evidence. The reaction is a hover, which
/// asks for no motion that could confirm the quantity, and in which a false velocity is soon as small as the true one.
const HOLDS_S: f64 = ENOUGH_S / FORGOTTEN_1_S;
/// A step of the floor or the heading counts as this, because it is compensated: both ends of a box in a row do no harm.
const STEP_S: f64 = ENOUGH_S / 3.0;

/// What shows that a quantity is wrong. Of several the first one is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Cause {
    /// The value is impossible for an AR.Drone, or further from the expected one than any motion.
    Value,
    /// The value repeats itself for too long.
    Repetition,
    /// It is noisier than its sensor.
    Noise,
    /// The drone itself reports that it has lost the quantity.
    Report,
    /// It does not follow the commands.
    Response,
    /// It made a step, which was compensated.
    Step,
}

impl Cause {
    /// The time for which it counts; `begins` if the packet before did not show it.
    fn weight_s(self, packet_s: f64, begins: bool) -> f64 {
        match self {
            // What happened in a gap is unknown.
            Self::Value | Self::Report => packet_s.min(USUAL_STEP_S),
            Self::Step => STEP_S,
            // Its end is seen as exactly as its beginning, so that a single one is forgiven.
            Self::Repetition => ENOUGH_S * f64::from(u8::from(begins)),
            // What shows these has summed up enough.
            Self::Noise | Self::Response => 2.0 * ENOUGH_S,
        }
    }

    fn trust(self, quantity: Quantity) -> Trust {
        match self {
            Self::Value | Self::Step => Trust::Implausible(quantity),
            Self::Repetition => Trust::Frozen(quantity),
            Self::Noise => Trust::Noisy(quantity),
            Self::Report => Trust::Reported(quantity),
            Self::Response => Trust::Unresponsive(quantity),
        }
    }
}

/// Evidence of one packet against a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Evidence {
    pub(crate) quantity: Quantity,
    pub(crate) cause: Cause,
    /// Since when it shows.
    pub(crate) since_s: f64,
}

/// What a quantity is worth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Belief {
    /// Nothing speaks against it.
    Sound,
    /// Something does, but not for long enough.
    Suspect,
    /// It is wrong.
    Disproved { cause: Cause, since_s: f64, until_s: f64 },
}

/// The evidence against one quantity.
#[derive(Debug, Clone, Copy)]
struct Tally {
    wrong_s: f64,
    /// What the newest packet shows, and since when.
    shows: Option<(Cause, f64)>,
    disproved: Option<(Cause, f64, f64)>,
}

impl Tally {
    const EMPTY: Self = Self { wrong_s: 0.0, shows: None, disproved: None };

    /// The one place where evidence changes a belief.
    fn weigh(&mut self, at_s: f64, packet_s: f64, evidence: impl Iterator<Item = Evidence>) {
        let before = self.shows.take();
        self.wrong_s = (self.wrong_s - FORGOTTEN_1_S * packet_s).max(0.0);
        for Evidence { cause, since_s, .. } in evidence {
            let before_s = before.filter(|(its, _)| *its == cause).map(|(_, since_s)| since_s);
            let since_s = before_s.unwrap_or(since_s);
            self.wrong_s += cause.weight_s(packet_s, before_s.is_none());
            let is_first = self.shows.is_none_or(|(shown, _)| cause < shown);
            self.shows = if is_first { Some((cause, since_s)) } else { self.shows };
        }
        let Some((cause, since_s)) = self.shows else { return };
        self.wrong_s = self.wrong_s.min(2.0 * ENOUGH_S);
        if self.wrong_s > ENOUGH_S {
            self.disproved = Some((cause, since_s, at_s + HOLDS_S));
        } else if cause == Cause::Repetition {
            self.disproved = Some((cause, since_s, at_s));
        }
    }

    fn belief(&self, at_s: f64) -> Belief {
        match self.disproved {
            Some((cause, since_s, until_s)) if at_s <= until_s => {
                Belief::Disproved { cause, since_s, until_s }
            }
            _ if self.shows.is_some() => Belief::Suspect,
            _ => Belief::Sound,
        }
    }
}

/// The beliefs in all quantities.
#[derive(Debug, Clone)]
pub(crate) struct Beliefs {
    tallies: [Tally; Quantity::ALL.len()],
    at_s: Option<f64>,
    sound_at_s: Option<f64>,
}

impl Beliefs {
    pub(crate) fn new() -> Self {
        Self { tallies: [Tally::EMPTY; Quantity::ALL.len()], at_s: None, sound_at_s: None }
    }

    /// Weighs the evidence of a packet that arrived at a time, which is news or is out of date.
    pub(crate) fn weigh(&mut self, at_s: f64, evidence: &[Option<Evidence>], is_news: bool) {
        let packet_s = self.at_s.replace(at_s).map_or(0.0, |last_s| at_s - last_s);
        for (quantity, tally) in Quantity::ALL.into_iter().zip(&mut self.tallies) {
            let against = evidence.iter().flatten().filter(|it| it.quantity == quantity);
            tally.weigh(at_s, packet_s, against.copied());
        }
        // Dated from the first wrong packet, so that a reaction does not wait for another timeout.
        let wrong_since_s = self.disproved().map(|(_, _, since_s)| since_s).reduce(f64::min);
        match (wrong_since_s, &mut self.sound_at_s) {
            (None, sound_at_s) if is_news => *sound_at_s = Some(at_s),
            (Some(since_s), Some(sound_at_s)) => *sound_at_s = sound_at_s.min(since_s),
            _ => {}
        }
    }

    fn disproved(&self) -> impl Iterator<Item = (Cause, Quantity, f64)> {
        let at_s = self.at_s.unwrap_or_default();
        Quantity::ALL.into_iter().zip(&self.tallies).filter_map(
            move |(quantity, tally)| match tally.belief(at_s) {
                Belief::Disproved { cause, since_s, .. } => Some((cause, quantity, since_s)),
                Belief::Sound | Belief::Suspect => None,
            },
        )
    }

    /// What each quantity is worth, in the order of [`Quantity::ALL`].
    pub(crate) fn worth(&self) -> [Worth; Quantity::ALL.len()] {
        let at_s = self.at_s.unwrap_or_default();
        let mut worth = [Worth::Sound; Quantity::ALL.len()];
        for ((worth, tally), quantity) in worth.iter_mut().zip(&self.tallies).zip(Quantity::ALL) {
            *worth = match tally.belief(at_s) {
                Belief::Sound => Worth::Sound,
                Belief::Suspect => Worth::Suspect,
                Belief::Disproved { cause, .. } => Worth::Disproved(cause.trust(quantity)),
            };
        }
        worth
    }

    /// Whether all quantities are believed; otherwise what is wrong.
    pub(crate) fn trust(&self) -> Trust {
        let worst = self.disproved().min_by_key(|(cause, ..)| *cause);
        worst.map_or(Trust::Sound, |(cause, quantity, _)| cause.trust(quantity))
    }

    /// When the newest navdata arrived that are believed, in seconds.
    pub(crate) fn sound_at_s(&self) -> Option<f64> {
        self.sound_at_s
    }
}

#[cfg(test)]
mod tests;
