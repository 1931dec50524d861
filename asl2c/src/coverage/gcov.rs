//! Counts of executed lines and branches, as gcov prints them.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

/// A covered fraction.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Share {
    /// Number covered.
    pub ran: usize,
    /// Number in total.
    pub all: usize,
}

impl Share {
    /// Counts one more.
    pub fn count(&mut self, ran: bool) {
        self.ran += usize::from(ran);
        self.all += 1;
    }

    /// Adds another fraction's numbers.
    pub fn add(&mut self, other: Self) {
        self.ran += other.ran;
        self.all += other.all;
    }

    /// Whether nothing is missing.
    pub fn is_whole(&self) -> bool {
        self.ran == self.all
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {}", self.ran, self.all)
    }
}

/// Counts of a file of C.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Counts {
    /// Lines with statements, in order.
    pub lines: Vec<LineCount>,
}

/// Counts of a line.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct LineCount {
    /// Its number, from one.
    #[serde(rename = "line_number")]
    pub line: usize,
    /// How often it was executed.
    pub count: u64,
    branches: Vec<Branch>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct Branch {
    count: u64,
}

/// Output of gcov.
#[derive(Debug, Deserialize)]
struct Output {
    files: Vec<FileCounts>,
}

#[derive(Debug, Deserialize)]
struct FileCounts {
    file: String,
    lines: Vec<LineCount>,
}

impl Counts {
    /// Options of gcov, before the names of the files with the counts.
    pub const OPTIONS: [&'static str; 4] =
        ["--json-format", "--stdout", "--branch-probabilities", "--branch-counts"];

    /// The counts of the file with this name in gcov's output.
    ///
    /// # Errors
    /// If the output has another form.
    pub fn parse(output: &str, file: &str) -> Result<Self, serde_json::Error> {
        let output: Output = serde_json::from_str(output)?;
        let files = output.files.into_iter().filter(|counted| counted.file.ends_with(file));
        Ok(Self { lines: files.flat_map(|file| file.lines).collect() })
    }

    /// Whether the others can be added: the same lines, with the same branches.
    pub fn is_of_the_same(&self, others: &Self) -> bool {
        let shape = |counts: &Self| -> Vec<(usize, usize)> {
            counts.lines.iter().map(|line| (line.line, line.branches.len())).collect()
        };
        shape(self) == shape(others)
    }

    /// Adds what another build of the same C has counted.
    pub fn add(&mut self, others: &Self) {
        for (line, other) in self.lines.iter_mut().zip(&others.lines) {
            line.count += other.count;
            for (branch, other) in line.branches.iter_mut().zip(&other.branches) {
                branch.count += other.count;
            }
        }
    }

    /// Executed lines of a part of the file.
    pub fn statements(&self, part: &RangeInclusive<usize>) -> Share {
        let mut share = Share::default();
        self.within(part).for_each(|line| share.count(line.count > 0));
        share
    }

    /// Seen outcomes of the conditions in a part of the file: each can be true and false.
    pub fn outcomes(&self, part: &RangeInclusive<usize>) -> Share {
        let mut share = Share::default();
        self.within(part).for_each(|line| share.add(line.outcomes()));
        share
    }

    fn within(&self, part: &RangeInclusive<usize>) -> impl Iterator<Item = &LineCount> {
        self.lines.iter().filter(|line| part.contains(&line.line))
    }
}

impl LineCount {
    /// Seen outcomes of the line's conditions.
    pub fn outcomes(&self) -> Share {
        let mut share = Share::default();
        self.branches.iter().for_each(|branch| share.count(branch.count > 0));
        share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_has_the_counts_of_its_lines() {
        let counts = r#"{ "files": [{ "file": "x/pilot.c", "lines": [
            { "line_number": 2, "count": 9, "branches": [{ "count": 9 }, { "count": 0 }] },
            { "line_number": 3, "count": 4, "branches": [] },
            { "line_number": 5, "count": 0, "branches": [{ "count": 0 }, { "count": 0 }] } ] },
            { "file": "x/other.c", "lines": [{ "line_number": 2, "count": 9, "branches": [] }] }] }"#;
        let counts = Counts::parse(counts, "pilot.c").unwrap();
        assert_eq!(counts.statements(&(1..=9)).to_string(), "2 of 3");
        assert_eq!(counts.outcomes(&(1..=9)).to_string(), "1 of 4");
        assert_eq!(counts.outcomes(&(3..=5)).to_string(), "0 of 2");
        assert_eq!(counts.statements(&(2..=3)).to_string(), "2 of 2");
    }

    #[test]
    fn counts_of_the_same_c_are_added() {
        let counts = |line: usize, count: u64, other: u64| {
            let output = format!(
                r#"{{ "files": [{{ "file": "a.c", "lines": [{{ "line_number": {line}, "count": {count},
                "branches": [{{ "count": {count} }}, {{ "count": {other} }}] }}] }}] }}"#
            );
            Counts::parse(&output, "a.c").unwrap()
        };
        let mut sum = counts(2, 3, 0);
        assert!(sum.is_of_the_same(&counts(2, 4, 1)) && !sum.is_of_the_same(&counts(3, 4, 1)));
        sum.add(&counts(2, 4, 1));
        assert_eq!(sum, counts(2, 7, 1));
    }
}
