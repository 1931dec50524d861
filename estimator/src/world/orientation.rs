//! Sign of a tag's orientation, and directions of the tags.
//!
//! Clients of the real drone contradict each other on the sign. With the right sign a tag's direction does
//! not depend on the drone's heading; with the wrong one it turns by twice the angle. Any turn therefore
//! decides.

use super::SLOTS;
use crate::sensor::ORIENTATION_DEG;
use kinematics::wrap_deg;

/// Direction in which the reported orientation grows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OrientationSign {
    /// When the drone turns clockwise.
    Clockwise,
    /// When the drone turns counter-clockwise.
    CounterClockwise,
}

impl OrientationSign {
    const BOTH: [Self; 2] = [Self::Clockwise, Self::CounterClockwise];

    /// The direction of a tag with this sign.
    fn direction_deg(self, heading_deg: f64, orientation_deg: f64) -> f64 {
        let turned_deg = orientation_deg - ALONG_DEG;
        match self {
            Self::Clockwise => heading_deg - turned_deg,
            Self::CounterClockwise => heading_deg + turned_deg,
        }
    }
}

/// Reported orientation when the drone is aligned with the tag.
const ALONG_DEG: f64 = 270.0;
/// Limit of the evidence of one sighting: it may be of something else.
const MOST_EVIDENCE: f64 = 1.0;
/// Logarithm of the odds that decides, and at which the odds are limited.
const DECIDED: f64 = 8.0;
const CERTAIN: f64 = 24.0;
/// Smaller turns may be noise.
const LEAST_TURN_DEG: f64 = 1.5;
/// Number of sightings in the mean direction of a tag.
const MEMORY: f64 = 40.0;
/// Number of sightings before a mean is used.
const LEAST: u32 = 8;
/// Fraction of means that say nothing about their tag: a bad picture, a firmware that reports something else.
const WORTHLESS: f64 = 0.05;

/// Result of an orientation.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Turned {
    /// The tag's mean direction, if the sign is known.
    pub(super) direction_deg: Option<f64>,
    /// The tag's direction from this sighting alone.
    pub(super) newest_deg: Option<f64>,
    /// The sign was wrong until now.
    pub(super) sign_changed: bool,
}

/// Mean direction of one tag with one sign.
#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    deg: f64,
    sights: u32,
}

impl Mean {
    /// Difference between a direction and the mean, to which it is then added.
    fn join(&mut self, deg: f64) -> f64 {
        let off_deg = if self.sights == 0 { 0.0 } else { wrap_deg(deg - self.deg) };
        self.sights = self.sights.saturating_add(1);
        let base_deg = if self.sights == 1 { deg } else { self.deg };
        self.deg = wrap_deg(base_deg + off_deg / f64::from(self.sights).min(MEMORY));
        off_deg
    }
}

#[derive(Debug, Clone)]
pub(super) struct Orientation {
    /// Logarithm of the odds that orientations grow clockwise.
    odds: f64,
    sign: Option<OrientationSign>,
    given: bool,
    /// Means by sign, in the order of [`OrientationSign::BOTH`].
    means: [[Mean; 2]; SLOTS],
    /// The same of the sightings while a tag was on trial.
    trials: [[Mean; 2]; SLOTS],
}

impl Orientation {
    pub(super) fn new(given: Option<OrientationSign>) -> Self {
        let means = [[Mean::default(); 2]; SLOTS];
        Self { odds: 0.0, sign: given, given: given.is_some(), means, trials: means }
    }

    pub(super) fn sign(&self) -> Option<OrientationSign> {
        self.sign
    }

    /// The slot now belongs to another tag.
    pub(super) fn forget(&mut self, tag: usize) {
        self.means[tag] = [Mean::default(); 2];
        self.trials[tag] = [Mean::default(); 2];
    }

    /// A tag on trial was seen at a heading.
    pub(super) fn saw_on_trial(&mut self, tag: usize, heading_deg: f64, orientation_deg: f64) {
        for (mean, sign) in self.trials[tag].iter_mut().zip(OrientationSign::BOTH) {
            mean.join(sign.direction_deg(heading_deg, orientation_deg));
        }
    }

    /// Logarithm of the odds, by their directions, that a tag on trial is a known one and not another that is
    /// turned at random. Zero if a direction is not known. `known_deg`: the known one's direction, if it was
    /// not derived from its sightings; `uncertainty_deg`: standard deviation of the heading.
    pub(super) fn log_odds_of_one(
        &self,
        trial: usize,
        known: usize,
        known_deg: Option<f64>,
        uncertainty_deg: f64,
    ) -> f64 {
        let variance_deg2 = ORIENTATION_DEG.powi(2) + uncertainty_deg.powi(2);
        let most = 360.0 / (std::f64::consts::TAU * variance_deg2).sqrt();
        let odds = |reading: usize| {
            let (mean, trial) = (&self.means[known][reading], &self.trials[trial][reading]);
            let seen_deg = (mean.sights > 0).then_some(mean.deg);
            let off_deg = wrap_deg(known_deg.or(seen_deg)? - trial.deg);
            let fits = most * (-off_deg.powi(2) / (2.0 * variance_deg2)).exp();
            (trial.sights > 0).then_some(WORTHLESS + (1.0 - WORTHLESS) * fits)
        };
        let odds = match self.sign {
            Some(OrientationSign::Clockwise) => odds(0),
            Some(OrientationSign::CounterClockwise) => odds(1),
            None => odds(0).zip(odds(1)).map(|(one, other)| f64::midpoint(one, other)),
        };
        odds.map_or(0.0, f64::ln)
    }

    /// A known tag was seen at a heading.
    pub(super) fn saw(&mut self, tag: usize, heading_deg: f64, orientation_deg: f64) -> Turned {
        let means = &mut self.means[tag];
        let mut off = [0.0; 2];
        let mut directions = [0.0; 2];
        for (reading, sign) in OrientationSign::BOTH.into_iter().enumerate() {
            directions[reading] = sign.direction_deg(heading_deg, orientation_deg);
            off[reading] = means[reading].join(directions[reading]);
        }
        // The mean of both is the angle by which the drone has turned.
        let turned_deg = f64::midpoint(off[0], off[1]).abs();
        if means[0].sights > LEAST && turned_deg > LEAST_TURN_DEG {
            let evidence =
                (off[1].powi(2) - off[0].powi(2)) / (2.0 * ORIENTATION_DEG * ORIENTATION_DEG);
            let evidence = evidence.clamp(-MOST_EVIDENCE, MOST_EVIDENCE);
            self.odds = (self.odds + evidence).clamp(-CERTAIN, CERTAIN);
        }
        let before = self.sign;
        if !self.given && self.odds.abs() >= DECIDED {
            let clockwise = self.odds > 0.0;
            self.sign = Some(OrientationSign::BOTH[usize::from(!clockwise)]);
        }
        let sign_changed = before.is_some() && before != self.sign;
        let reading = OrientationSign::BOTH.iter().position(|sign| Some(*sign) == self.sign);
        let Some(reading) = reading.filter(|_| self.means[tag][0].sights > LEAST) else {
            // The evidence that changes a sign comes from tags with a mean.
            return Turned::default();
        };
        Turned {
            direction_deg: Some(self.means[tag][reading].deg),
            newest_deg: Some(directions[reading]),
            sign_changed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of a few degrees with a long period.
    fn noise(i: u32) -> f64 {
        (f64::from(i) * 12.9898).sin() * 5.0
    }

    #[test]
    fn a_small_turn_tells_which_way_orientations_count() {
        for (sign, expected) in
            [(1.0, OrientationSign::Clockwise), (-1.0, OrientationSign::CounterClockwise)]
        {
            let mut orientation = Orientation::new(None);
            let mut turned = Turned::default();
            for i in 0..100_u32 {
                let heading_deg = 8.0 * (f64::from(i) * 0.07).sin();
                let reported_deg = 270.0 + sign * (heading_deg - 60.0) + noise(i);
                turned = orientation.saw(0, heading_deg, reported_deg);
            }
            assert_eq!(orientation.sign(), Some(expected));
            let direction_deg = turned.direction_deg.unwrap();
            assert!(wrap_deg(direction_deg - 60.0).abs() < 3.0, "{direction_deg}");
        }
    }

    #[test]
    fn a_drone_that_does_not_turn_learns_nothing() {
        let mut orientation = Orientation::new(None);
        for i in 0..2000 {
            orientation.saw(0, 0.05 * noise(i + 7), 100.0 + noise(i));
        }
        assert_eq!(orientation.sign(), None, "{orientation:?}");
    }

    /// Sightings of tag 0 by a drone that stands, and then one after a turn.
    fn turned(
        orientation: &mut Orientation,
        sights: u32,
        turn_deg: f64,
        reported_deg: f64,
    ) -> Turned {
        for _ in 0..sights {
            orientation.saw(0, 20.0, 300.0);
        }
        orientation.saw(0, 20.0 + turn_deg, 300.0 + reported_deg)
    }

    #[test]
    fn a_direction_is_the_heading_less_the_turn_in_the_picture() {
        let (clockwise, counter) = (OrientationSign::Clockwise, OrientationSign::CounterClockwise);
        // Aligned with the tag, either sign says the same.
        assert!((clockwise.direction_deg(40.0, 270.0) - 40.0).abs() < 1e-9);
        assert!((counter.direction_deg(40.0, 270.0) - 40.0).abs() < 1e-9);
        assert!((clockwise.direction_deg(40.0, 300.0) - 10.0).abs() < 1e-9);
        assert!((counter.direction_deg(40.0, 300.0) - 70.0).abs() < 1e-9);
    }

    #[test]
    fn the_mean_of_a_direction_remembers_forty_sightings() {
        let mut mean = Mean::default();
        assert!(mean.join(170.0).abs() < 1e-9);
        assert!((mean.deg - 170.0).abs() < 1e-9);
        // Across half a turn, the second counts as much as the first.
        assert!((mean.join(-170.0) - 20.0).abs() < 1e-9);
        assert!((wrap_deg(mean.deg - 180.0)).abs() < 1e-9, "{mean:?}");
        assert!((mean.join(-174.0) - 6.0).abs() < 1e-9);
        assert!((mean.deg + 178.0).abs() < 1e-9, "a third of it");
        let mut mean = Mean { deg: 10.0, sights: 500 };
        assert!((mean.join(14.0) - 4.0).abs() < 1e-9);
        assert!((mean.deg - 10.1).abs() < 1e-9 && mean.sights == 501);
    }

    #[test]
    fn a_turn_counts_by_how_much_better_one_sign_explains_it() {
        // The drone has turned by 4 degrees clockwise and the orientation has grown by 3 or shrunk by 3. The
        // clockwise sign leaves 1 degree, the other 7; or the reverse.
        for (reported_deg, off_deg) in [(3.0, [1.0_f64, 7.0]), (-3.0, [7.0, 1.0])] {
            let mut orientation = Orientation::new(None);
            turned(&mut orientation, 8, 4.0, reported_deg);
            let evidence = (off_deg[1].powi(2) - off_deg[0].powi(2)) / (2.0 * 8.0 * 8.0);
            assert!((orientation.odds - evidence).abs() < 1e-9, "{}", orientation.odds);
        }
        // One sighting decides no more than this, for it may be of something else.
        for (reported_deg, odds) in [(20.0, 1.0), (-20.0, -1.0)] {
            let mut orientation = Orientation::new(None);
            turned(&mut orientation, 8, 20.0, reported_deg);
            assert!((orientation.odds - odds).abs() < 1e-9);
        }
        // A small turn may be noise, and a mean of few sightings too.
        for (sights, turn_deg, counts) in
            [(8, 1.4, false), (8, 1.6, true), (8, -1.4, false), (8, -1.6, true), (7, 4.0, false)]
        {
            let mut orientation = Orientation::new(None);
            turned(&mut orientation, sights, turn_deg, turn_deg);
            assert_eq!(orientation.odds != 0.0, counts, "{sights}, {turn_deg}");
        }
        let mut orientation = Orientation::new(None);
        turned(&mut orientation, 8, LEAST_TURN_DEG, 4.0);
        assert!(orientation.odds.abs() < 1e-9, "not more than the least turn");
    }

    #[test]
    fn a_sign_is_decided_by_its_odds_and_changed_by_more_of_them() {
        let mut orientation = Orientation::new(None);
        let clockwise = |orientation: &mut Orientation, turn_deg: f64| {
            orientation.forget(0);
            turned(orientation, 8, turn_deg, turn_deg)
        };
        let counter = |orientation: &mut Orientation, turn_deg: f64| {
            orientation.forget(0);
            turned(orientation, 8, turn_deg, -turn_deg)
        };
        for i in 0..7 {
            let turned = clockwise(&mut orientation, 20.0);
            assert!(orientation.sign().is_none() && turned.direction_deg.is_none(), "{i}");
        }
        let turned = clockwise(&mut orientation, 20.0);
        assert_eq!(orientation.sign(), Some(OrientationSign::Clockwise), "at eight");
        assert!(!turned.sign_changed, "there was none");
        // Heading 20 and orientation 300 are a direction of -10.
        assert!((turned.direction_deg.unwrap() + 10.0).abs() < 1e-9);
        assert!((turned.newest_deg.unwrap() + 10.0).abs() < 1e-9);
        // The odds are limited, so that errors can be corrected.
        for _ in 0..50 {
            clockwise(&mut orientation, 20.0);
        }
        assert!((orientation.odds - CERTAIN).abs() < 1e-9);
        let changes: Vec<usize> =
            (0..50).filter(|_| counter(&mut orientation, 20.0).sign_changed).collect();
        assert_eq!(changes, [31], "from 24 to -8");
        assert_eq!(orientation.sign(), Some(OrientationSign::CounterClockwise));
        assert!((orientation.odds + CERTAIN).abs() < 1e-9);
        // A given sign is not changed.
        let mut given = Orientation::new(Some(OrientationSign::Clockwise));
        assert!((0..50).all(|_| !counter(&mut given, 20.0).sign_changed));
        assert_eq!(given.sign(), Some(OrientationSign::Clockwise));
    }

    #[test]
    fn a_direction_is_used_after_nine_sightings_of_its_tag() {
        let mut orientation = Orientation::new(Some(OrientationSign::CounterClockwise));
        for i in 0..9 {
            let turned = orientation.saw(0, 20.0, 300.0);
            assert_eq!(turned.direction_deg.is_some(), i == 8, "{i}");
            assert_eq!(turned.newest_deg.is_some(), i == 8, "{i}");
        }
        let turned = orientation.saw(0, 20.0, 310.0);
        assert!((turned.direction_deg.unwrap() - 51.0).abs() < 1e-9, "a tenth of it");
        assert!((turned.newest_deg.unwrap() - 60.0).abs() < 1e-9);
        assert!(orientation.saw(1, 20.0, 300.0).direction_deg.is_none(), "another tag");
        orientation.forget(0);
        assert!(orientation.saw(0, 20.0, 300.0).direction_deg.is_none(), "in its slot");
    }

    /// Logarithm of the odds that a tag on trial, seen by a drone with the second heading, is one that was seen
    /// with the first, turned by this angle in the picture.
    fn log_odds(sign: Option<OrientationSign>, heading_deg: f64, turned_deg: f64) -> f64 {
        let mut orientation = Orientation::new(sign);
        for _ in 0..20 {
            orientation.saw(0, 0.0, 300.0);
            orientation.saw_on_trial(1, heading_deg, 300.0 + turned_deg);
        }
        orientation.log_odds_of_one(1, 0, None, 0.0)
    }

    #[test]
    fn a_direction_counts_for_or_against_a_known_tag() {
        let clockwise = Some(OrientationSign::Clockwise);
        // 360 degrees over the area of a normal distribution of 8 degrees.
        let most = 360.0 / (std::f64::consts::TAU * 64.0).sqrt();
        for (heading_deg, turned_deg, off_deg) in
            [(0.0, 0.0, 0.0_f64), (0.0, 8.0, 8.0), (50.0, 50.0, 0.0), (50.0, 42.0, 8.0)]
        {
            let fits = 0.05 + 0.95 * most * (-off_deg.powi(2) / 128.0).exp();
            let odds = log_odds(clockwise, heading_deg, turned_deg);
            assert!((odds - fits.ln()).abs() < 1e-9, "{heading_deg}, {turned_deg}: {odds}");
        }
        // Another direction is another tag, unless the picture was bad.
        assert!((log_odds(clockwise, 0.0, 90.0) - 0.05_f64.ln()).abs() < 1e-6);
        assert!(
            (log_odds(Some(OrientationSign::CounterClockwise), 50.0, 50.0) - 0.05_f64.ln()).abs()
                < 1e-6
        );
        // While the sign is unknown, either may be right.
        assert!((log_odds(None, 0.0, 0.0) - log_odds(clockwise, 0.0, 0.0)).abs() < 1e-9);
        let either = f64::midpoint(0.05 + 0.95 * most, 0.05);
        assert!((log_odds(None, 50.0, 50.0) - either.ln()).abs() < 1e-6);
        assert!((log_odds(None, 50.0, -50.0) - either.ln()).abs() < 1e-6);
    }

    #[test]
    fn an_unknown_direction_counts_neither_way() {
        let mut orientation = Orientation::new(Some(OrientationSign::Clockwise));
        let odds = |orientation: &Orientation, known_deg| {
            orientation.log_odds_of_one(1, 0, known_deg, 0.0)
        };
        assert!(odds(&orientation, Some(-10.0)).abs() < 1e-12, "no sighting of the one on trial");
        orientation.saw_on_trial(1, 20.0, 300.0);
        assert!(odds(&orientation, None).abs() < 1e-12, "nor of the known one");
        assert!(odds(&orientation, Some(-10.0)) > 2.0 && odds(&orientation, Some(80.0)) < -2.0);
        // An uncertain heading says less.
        let vague = orientation.log_odds_of_one(1, 0, Some(80.0), 60.0);
        assert!((-1.0..0.5).contains(&vague), "{vague}");
        orientation.forget(1);
        assert!(odds(&orientation, Some(-10.0)).abs() < 1e-12, "the slot belongs to another tag");
    }
}
