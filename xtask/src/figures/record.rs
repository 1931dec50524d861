//! Records of figures, and what is a loss between two of them.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{FiguresError, KINDS, Kind, Loss, Part};
use crate::files::cannot;

/// Figures by what they measure and of what, such as `state: autopilot`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct Figures(pub(super) BTreeMap<String, f64>);

impl Figures {
    /// Adds a figure. `name` is one of [`KINDS`]. What is no number, or has no bound, was not measured: JSON has no word for it.
    pub(super) fn add(&mut self, name: &str, of: &str, value: f64) {
        debug_assert!(kind_of(name).is_some(), "{name}");
        if !value.is_finite() {
            return;
        }
        // As many digits as mean something.
        let value = format!("{value:.4e}").parse().unwrap_or(value);
        self.0.insert(format!("{name}: {of}"), value);
    }
}

fn kind_of(name: &str) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.name == name)
}

/// The kind of a figure, and what it is of.
pub(super) fn split(key: &str) -> Option<(&'static Kind, &str)> {
    let (name, of) = key.split_once(": ")?;
    Some((kind_of(name)?, of))
}

/// Figures that were measured together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Record {
    /// Of the program.
    pub(super) version: String,
    /// What it was recorded for, where that is not the version alone.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(super) note: String,
    pub(super) figures: Figures,
}

impl Record {
    pub(super) fn new(figures: Figures) -> Self {
        Self { version: env!("CARGO_PKG_VERSION").to_owned(), note: String::new(), figures }
    }

    pub(super) fn json(&self) -> String {
        pretty(self)
    }

    /// What it is of, in the drawing.
    pub(super) fn name(&self) -> String {
        let Self { version, note, .. } = self;
        if note.is_empty() { version.clone() } else { format!("{version} ({note})") }
    }

    /// Takes over the figures of other parts than these, and those that are now worse by no more than noise: small losses, each
    /// recorded for the next one to be compared with, would add up unseen.
    pub(super) fn keep_of(&mut self, last: &Self, parts: &[Part]) {
        for (key, before) in &last.figures.0 {
            let Some((kind, _)) = split(key) else { continue };
            let now = self.figures.0.get(key);
            let is_noise = |now: &f64| {
                kind.worse(*before, *now)
                    .is_some_and(|worse| (0.0..=kind.noise_of(*before)).contains(&worse))
            };
            if !parts.contains(&kind.part) || now.is_some_and(is_noise) {
                self.figures.0.insert(key.clone(), *before);
            }
        }
    }

    /// What differs from the last record, of these parts, and whether anything was lost.
    pub(super) fn against(&self, last: &Self, parts: &[Part]) -> (String, bool) {
        let (mut text, mut lost) = (String::new(), 0);
        let (now, before) = (&self.figures.0, &last.figures.0);
        let keys: std::collections::BTreeSet<&String> = now.keys().chain(before.keys()).collect();
        let mut compared = 0;
        for key in keys {
            let Some((kind, _)) = split(key) else {
                lost += 1;
                _ = writeln!(text, "LOST      {key}: is recorded, and no longer measured");
                continue;
            };
            if !parts.contains(&kind.part) {
                continue;
            }
            compared += 1;
            let change = match (before.get(key), now.get(key)) {
                (Some(_), None) => Some(("LOST", "is recorded, and was not measured".to_owned())),
                (None, Some(now)) => {
                    Some(("LOST", format!("is {now} {}, and not recorded", kind.unit)))
                }
                (Some(before), Some(now)) => kind.change(*before, *now).map(|word| {
                    (word, format!("{before} {unit} -> {now} {unit}", unit = kind.unit))
                }),
                (None, None) => None,
            };
            if let Some((word, says)) = change {
                lost += usize::from(word == "LOST");
                _ = writeln!(text, "{word:<10}{key}: {says}");
            }
        }
        _ = writeln!(
            text,
            "{compared} figures compared with those of {}, {lost} lost",
            last.version
        );
        if lost > 0 {
            text += "If that is meant, say why in the commit that records them anew: cargo xtask figures --record\n";
        }
        (text, lost > 0)
    }
}

impl Kind {
    /// By how much a figure is worse than before; `None` if that is not judged.
    fn worse(&self, before: f64, now: f64) -> Option<f64> {
        match self.loss {
            Loss::More => Some(now - before),
            Loss::Less => Some(before - now),
            Loss::NotJudged => None,
        }
    }

    /// A word for a difference beyond noise.
    fn change(&self, before: f64, now: f64) -> Option<&'static str> {
        let worse = self.worse(before, now)?;
        // What is no number is a loss.
        if worse.is_nan() || worse > self.noise_of(before) {
            Some("LOST")
        } else if -worse > self.noise_of(before) {
            Some("better")
        } else {
            None
        }
    }

    /// The largest difference from this value that is none.
    pub(super) fn noise_of(&self, value: f64) -> f64 {
        // Beyond the last digit that is recorded.
        self.noise + self.share * value.abs() + 1e-9
    }
}

/// All records, the latest last.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct History(pub(super) Vec<Record>);

impl History {
    /// Reads the records; there are none if there is no file.
    pub(super) fn read(path: &Path) -> Result<Self, FiguresError> {
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self::default());
            }
            Err(error) => return Err(cannot("read", path)(error).into()),
        };
        serde_json::from_str(&text)
            .map_err(|source| FiguresError::Json { path: path.to_owned(), source })
    }

    pub(super) fn last(&self) -> Option<&Record> {
        self.0.last()
    }

    /// Adds a record, in place of the last one if that is of the same version.
    pub(super) fn push(&mut self, record: Record) {
        if self.last().is_some_and(|last| last.name() == record.name()) {
            self.0.pop();
        }
        self.0.push(record);
    }

    pub(super) fn json(&self) -> String {
        pretty(self)
    }
}

fn pretty(value: &impl Serialize) -> String {
    let text = serde_json::to_string_pretty(value);
    text.expect("texts and numbers can be written as JSON") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files;

    fn record(figures: &[(&str, &str, f64)]) -> Record {
        let mut record = Record::new(Figures::default());
        for (name, of, value) in figures {
            record.figures.add(name, of, *value);
        }
        record
    }

    const TIME: &str = "time between the stays";
    const PARTS: &[Part] = &[Part::Flights, Part::Tests];

    fn against(before: &[(&str, &str, f64)], now: &[(&str, &str, f64)]) -> (String, bool) {
        record(now).against(&record(before), PARTS)
    }

    #[test]
    fn a_loss_beyond_noise_is_found_and_one_within_it_is_none() {
        let before = [(TIME, "rec", 50.0), ("tests passed", "all", 100.0)];
        assert!(!against(&before, &before).1);
        assert!(!against(&before, &[(TIME, "rec", 50.9), ("tests passed", "all", 100.0)]).1);
        let (text, lost) = against(&before, &[(TIME, "rec", 51.1), ("tests passed", "all", 100.0)]);
        assert!(
            lost && text.contains("LOST      time between the stays: rec: 50 s -> 51.1 s"),
            "{text}"
        );
        let (text, lost) = against(&before, &[(TIME, "rec", 50.0), ("tests passed", "all", 99.0)]);
        assert!(lost && text.contains("tests passed"), "{text}");
        assert!(against(&before, &[(TIME, "rec", f64::NAN), ("tests passed", "all", 100.0)]).1);
    }

    #[test]
    fn a_gain_is_told_and_is_no_loss() {
        let (text, lost) = against(&[(TIME, "rec", 50.0)], &[(TIME, "rec", 40.0)]);
        assert!(!lost && text.contains("better"), "{text}");
    }

    #[test]
    fn what_is_not_measured_or_not_recorded_is_a_loss() {
        assert!(against(&[(TIME, "rec", 50.0)], &[]).1);
        assert!(against(&[], &[(TIME, "rec", 50.0)]).1);
        for value in [f64::NAN, f64::INFINITY] {
            assert!(against(&[(TIME, "rec", value)], &[(TIME, "rec", 50.0)]).1);
            let measured = record(&[(TIME, "rec", value)]).json();
            assert_eq!(serde_json::from_str::<Record>(&measured).unwrap(), record(&[]));
        }
        let mut before = record(&[]);
        before.figures.0.insert("something: of old".to_owned(), 1.0);
        assert!(record(&[]).against(&before, PARTS).1);
        // Unless its part was left out.
        assert!(!against(&[("state", "autopilot", 50.0)], &[]).1);
    }

    #[test]
    fn small_losses_add_up() {
        let first = record(&[(TIME, "rec", 50.0)]);
        let mut second = record(&[(TIME, "rec", 50.9)]);
        second.keep_of(&first, PARTS);
        assert!(record(&[(TIME, "rec", 51.8)]).against(&second, PARTS).1);
        // A gain is kept, however small: what was lost on a bad day is compared with no longer.
        for better in [45.0, 49.5] {
            let mut gain = record(&[(TIME, "rec", better)]);
            gain.keep_of(&first, PARTS);
            assert_eq!(gain, record(&[(TIME, "rec", better)]));
        }
    }

    #[test]
    fn what_is_not_judged_is_no_loss() {
        let parts = [Part::Code];
        let now = record(&[("lines of Rust", "all", 9.0)]);
        assert!(!now.against(&record(&[("lines of Rust", "all", 1.0)]), &parts).1);
    }

    #[test]
    fn kinds_have_different_names_without_a_colon() {
        let names: std::collections::BTreeSet<&str> = KINDS.iter().map(|kind| kind.name).collect();
        assert_eq!(names.len(), KINDS.len());
        assert!(names.iter().all(|name| !name.contains(": ")));
    }

    #[test]
    fn figures_keep_five_digits() {
        let mut figures = Figures::default();
        figures.add(TIME, "a", 58.723_456);
        figures.add(TIME, "b", 1_165_198_764.0);
        figures.add(TIME, "c", 0.0);
        let values: Vec<f64> = figures.0.into_values().collect();
        assert_eq!(values, [58.723, 1_165_200_000.0, 0.0]);
    }

    /// What is checked in is what is compared with, and what the page says.
    #[test]
    fn the_page_is_made_of_the_records() {
        let read = |path: &str| files::read(&files::root().join(path)).unwrap();
        let history = History::read(&files::root().join(super::super::HISTORY)).unwrap();
        assert_eq!(history.json(), read(super::super::HISTORY));
        assert_eq!(super::super::page::page(&history), read(super::super::PAGE));
        assert_eq!(super::super::page::drawing(&history), read(super::super::DRAWING));
        let last = history.last().unwrap();
        for kind in KINDS {
            let has = last
                .figures
                .0
                .keys()
                .any(|key| split(key).is_some_and(|(k, _)| k.name == kind.name));
            assert!(has, "{} is not recorded", kind.name);
        }
    }
}
