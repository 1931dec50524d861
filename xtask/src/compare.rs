//! Flights with failing sensors as lines of a file, and a comparison of two such files: the same flights of two builds.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

/// Why files could not be written, read or compared.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CompareError {
    /// The file, or a line of it.
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: csv::Error },
    /// Two lines of one file are of the same flight.
    #[error("{} has two lines of {key:?}", path.display())]
    Twice { path: PathBuf, key: Box<Key> },
    /// Nothing can be compared.
    #[error("the files have no flight in common")]
    Foreign,
}

/// What makes two lines the same flight.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct Key {
    /// The failure.
    pub(crate) row: String,
    pub(crate) airframe: String,
    pub(crate) situation: String,
    pub(crate) seed: u64,
}

/// A flight with a failing sensor.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Line {
    /// The failure.
    pub(crate) row: String,
    pub(crate) airframe: String,
    pub(crate) situation: String,
    pub(crate) seed: u64,
    /// Whether navdata can show the failure.
    pub(crate) judged: bool,
    pub(crate) away_m: f64,
    pub(crate) outside_m: f64,
    pub(crate) scraping_s: f64,
    pub(crate) airborne: bool,
    pub(crate) too_far: bool,
    /// Time from the failure to the first hover or landing; empty if nobody noticed it.
    pub(crate) reaction_s: Option<f64>,
    /// The pilot's account.
    pub(crate) outcome: String,
}

impl Line {
    fn key(&self) -> Key {
        let Self { row, airframe, situation, .. } = self;
        let [row, airframe, situation] = [row, airframe, situation].map(String::clone);
        Key { row, airframe, situation, seed: self.seed }
    }
}

/// Writes one line for each flight.
pub(crate) fn write(path: &Path, lines: &[Line]) -> Result<(), CompareError> {
    let written = || -> Result<(), csv::Error> {
        let mut writer = csv::Writer::from_path(path)?;
        lines.iter().try_for_each(|line| writer.serialize(line))?;
        Ok(writer.flush()?)
    };
    written().map_err(|source| CompareError::File { path: path.to_owned(), source })
}

/// The lines of a file.
pub(crate) fn read(path: &Path) -> Result<Vec<Line>, CompareError> {
    let read = || csv::Reader::from_path(path)?.into_deserialize().collect::<Result<_, _>>();
    read().map_err(|source| CompareError::File { path: path.to_owned(), source })
}

fn by_key(path: &Path) -> Result<BTreeMap<Key, Line>, CompareError> {
    let mut lines = BTreeMap::new();
    for line in read(path)? {
        let key = line.key();
        if lines.insert(key.clone(), line).is_some() {
            return Err(CompareError::Twice { path: path.to_owned(), key: Box::new(key) });
        }
    }
    Ok(lines)
}

/// What changed in the flights of one row.
#[derive(Debug, Default)]
pub(crate) struct Change {
    judged: bool,
    pairs: usize,
    too_far: [usize; 2],
    newly: usize,
    no_longer: usize,
    noticed: [usize; 2],
    /// Of the flights in which both noticed it.
    reactions_s: [Vec<f64>; 2],
}

impl Change {
    /// What changed in all flights that are judged.
    pub(crate) fn of_judged(before: &[Line], after: &[Line]) -> Self {
        let mut change = Self::default();
        pairs(before, after).for_each(|pair| change.see(pair));
        change
    }

    /// Whether more were led too far.
    pub(crate) fn led_further(&self) -> bool {
        self.too_far[1] > self.too_far[0]
    }

    /// How many of the flights after it led too far, newly and no longer, how many were noticed, and how soon.
    pub(crate) fn after(&self) -> String {
        let Self { too_far, newly, no_longer, noticed, .. } = self;
        let median_s = median(&self.reactions_s[1]).unwrap_or(f64::NAN);
        format!("{:>9}{newly:>8}{no_longer:>8}{:>10}{median_s:>11.2}", too_far[1], noticed[1])
    }

    fn see(&mut self, lines: [&Line; 2]) {
        let [before, after] = lines;
        self.judged |= before.judged || after.judged;
        self.pairs += 1;
        self.newly += usize::from(!before.too_far && after.too_far);
        self.no_longer += usize::from(before.too_far && !after.too_far);
        for (i, line) in lines.into_iter().enumerate() {
            self.too_far[i] += usize::from(line.too_far);
            self.noticed[i] += usize::from(line.reaction_s.is_some());
        }
        if let (Some(before_s), Some(after_s)) = (before.reaction_s, after.reaction_s) {
            self.reactions_s[0].push(before_s);
            self.reactions_s[1].push(after_s);
        }
    }

    fn is_worse(&self) -> bool {
        self.judged && self.led_further()
    }

    fn medians_s(&self) -> [Option<f64>; 2] {
        [0, 1].map(|i| median(&self.reactions_s[i]))
    }

    fn text(&self, row: &str) -> String {
        let Self { pairs, too_far, newly, no_longer, noticed, .. } = self;
        let seconds = |s: Option<f64>| s.map_or_else(|| "-".to_owned(), |s| format!("{s:.2}"));
        let [before_s, after_s] = self.medians_s().map(seconds);
        format!(
            "{row:<32}{pairs:>8}{:>8}{:>8}{newly:>8}{no_longer:>8}{:>10}{:>10}{before_s:>10}{after_s:>10}{}\n",
            too_far[0],
            too_far[1],
            noticed[0],
            noticed[1],
            if self.is_worse() { "  WORSE" } else { "" },
        )
    }

    fn is_different(&self) -> bool {
        let [before_s, after_s] = self.medians_s();
        self.newly + self.no_longer > 0 || self.noticed[0] != self.noticed[1] || before_s != after_s
    }
}

/// The same judged flights of two builds.
fn pairs<'a>(before: &'a [Line], after: &'a [Line]) -> impl Iterator<Item = [&'a Line; 2]> {
    let after: BTreeMap<Key, &Line> = after.iter().map(|line| (line.key(), line)).collect();
    let judged = before.iter().filter(|line| line.judged);
    judged.filter_map(move |line| Some([line, *after.get(&line.key())?]))
}

/// The judged row with the most flights that newly led too far, and how many these are.
pub(crate) fn most_newly_too_far(before: &[Line], after: &[Line]) -> String {
    let mut rows: BTreeMap<&str, usize> = BTreeMap::new();
    for [before, after] in pairs(before, after) {
        *rows.entry(&after.row).or_default() += usize::from(!before.too_far && after.too_far);
    }
    let most = rows.into_iter().max_by_key(|(_, newly)| *newly).filter(|(_, newly)| *newly > 0);
    most.map_or_else(String::new, |(row, newly)| format!("{row} ({newly})"))
}

/// The middle one; of two in the middle the smaller.
fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied()
}

/// Compares the same flights of two builds, row by row; the second value is whether no judged row has more that led too
/// far.
pub(crate) fn run(before: &Path, after: &Path) -> Result<(String, bool), CompareError> {
    /// Largest number of flights that are named.
    const NAMED: usize = 40;
    let (before, after) = (by_key(before)?, by_key(after)?);
    let mut rows: BTreeMap<&str, Change> = BTreeMap::new();
    let (mut all, mut worse) = (Change::default(), Vec::new());
    for (key, line) in &before {
        let Some(other) = after.get(key) else { continue };
        let pair = [line, other];
        rows.entry(&key.row).or_default().see(pair);
        all.see(pair);
        if other.judged && other.too_far && !line.too_far {
            worse.push(key);
        }
    }
    if all.pairs == 0 {
        return Err(CompareError::Foreign);
    }
    let mut text = format!(
        "{:<32}{:>8}{:>16}{:>8}{:>8}{:>20}{:>20}\n{:<32}{:>8}{:>8}{:>8}{:>8}{:>8}{:>10}{:>10}{:>10}{:>10}\n",
        "",
        "",
        "too far",
        "newly",
        "no",
        "noticed",
        "median reaction, s", //
        "row",
        "flights",
        "before",
        "after",
        "",
        "longer",
        "before",
        "after",
        "before",
        "after",
    );
    let is_good = !rows.values().any(Change::is_worse);
    for (row, change) in rows.iter().filter(|(_, change)| change.is_different()) {
        text += &change.text(row);
    }
    // Rows that are not judged are in it: whether it is worse is for the rows to say.
    text += &Change { judged: false, ..all }.text("all");
    for Key { row, airframe, situation, seed } in worse.iter().take(NAMED) {
        _ = writeln!(text, "newly too far: {row}: {airframe} {situation}, seed {seed}");
    }
    let alone = |these: &BTreeMap<Key, Line>, those: &BTreeMap<Key, Line>| {
        these.keys().filter(|key| !those.contains_key(key)).count()
    };
    _ = writeln!(
        text,
        "{} flights are only in the first file, {} only in the second",
        alone(&before, &after),
        alone(&after, &before)
    );
    Ok((text, is_good))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(row: &str, seed: u64, too_far: bool, reaction_s: Option<f64>) -> Line {
        Line {
            row: row.to_owned(),
            airframe: "rec".to_owned(),
            situation: "holding".to_owned(),
            seed,
            judged: true,
            away_m: 0.1,
            outside_m: 0.0,
            scraping_s: 0.0,
            airborne: false,
            too_far,
            reaction_s,
            outcome: "plan flown, \"to its end\"".to_owned(),
        }
    }

    #[test]
    fn the_same_flights_are_compared_and_no_others() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str, lines: &[Line]| {
            let path = folder.path().join(name);
            write(&path, lines).unwrap();
            assert_eq!(read(&path).unwrap(), lines);
            path
        };
        let before = file(
            "before",
            &[
                line("a", 1, true, Some(0.5)),
                line("a", 2, false, Some(1.5)),
                line("b", 1, false, None),
                line("b", 9, true, None),
            ],
        );
        let after = file(
            "after",
            &[
                line("b", 1, false, None),
                line("a", 2, true, Some(1.0)),
                line("a", 1, false, Some(2.0)),
                line("c", 1, true, None),
            ],
        );
        let (text, is_good) = run(&before, &after).unwrap();
        assert!(is_good, "one more and one less: {text}");
        let words = |row: &str| {
            let line = text.lines().find(|line| line.starts_with(row)).unwrap();
            line.split_whitespace().skip(1).map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(words("a "), ["2", "1", "1", "1", "1", "2", "2", "0.50", "1.00"]);
        assert_eq!(words("all"), ["3", "1", "1", "1", "1", "2", "2", "0.50", "1.00"]);
        assert!(!text.lines().any(|line| line.starts_with("b ")), "nothing changed: {text}");
        assert!(
            text.contains("newly too far: a: rec holding, seed 2\n1 flights are only"),
            "{text}"
        );

        let lines = [&before, &after].map(|path| read(path).unwrap());
        let [before_lines, after_lines] = &lines;
        assert_eq!(most_newly_too_far(before_lines, after_lines), "a (1)");
        let change = Change::of_judged(before_lines, after_lines);
        let words: Vec<_> = change.after().split_whitespace().map(str::to_owned).collect();
        assert_eq!(words, ["1", "1", "1", "2", "1.00"]);
        assert!(!change.led_further());

        let worse = file("worse", &[line("a", 2, true, None)]);
        assert!(!run(&before, &worse).unwrap().1);
        assert!(run(&worse, &before).unwrap().1);
        let twice = file("twice", &[line("a", 2, true, None), line("a", 2, false, None)]);
        assert!(matches!(run(&before, &twice), Err(CompareError::Twice { .. })));
        let foreign = file("foreign", &[line("d", 2, true, None)]);
        assert!(matches!(run(&before, &foreign), Err(CompareError::Foreign)));
    }
}
