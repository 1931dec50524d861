//! Finds the way from the start to a state in which C differs from its agent.

use std::path::Path;
use std::time::Duration;

use translator::{Act, Comparison, comparison_after};

use super::CommandError;
use crate::agent::Agent;
use crate::coverage::{CoverageError, Differing, differing, places, shorter};
use crate::prove::{
    Budget, Cbmc, Difference, SearchedWay, Validated, Watch, difference, write_comparison,
};

/// How long something shorter than a known way is looked for.
const SHORTER: Duration = Duration::from_mins(1);
/// How long a difference is looked for after each known beginning, ..
const AFTER: Duration = Duration::from_secs(30);
/// .. how many events, beliefs and steps after it, ..
const BEYOND: u32 = 4;
/// .. and for how long after all of them.
const AFTER_ALL: Duration = Duration::from_mins(3);

/// A way to a difference.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Way {
    pub(super) difference: Difference,
    /// Whether there is no shorter one.
    pub(super) is_shortest: bool,
}

/// How ways are looked for.
pub(super) struct Search<'a> {
    pub(super) agent: &'a Agent,
    /// The comparison that was not proved, ..
    pub(super) comparison: &'a Comparison,
    /// .. with its result.
    pub(super) validated: &'a Validated,
    pub(super) cbmc: &'a Cbmc,
    /// The folder of the comparison's files.
    pub(super) folder: &'a Path,
    /// Maximum number of events, beliefs and steps.
    pub(super) length: u32,
    pub(super) budget: Budget,
    pub(super) watch: &'a dyn Watch,
}

impl Search<'_> {
    /// A way to a difference, if one is found, and the number of events, beliefs and steps within which there is none.
    ///
    /// CBMC alone needs very long for a difference far from the start. Tests that are made from the agent's text are
    /// executed first, and then CBMC begins where such tests come to the steps that differ.
    pub(super) fn way(&self) -> Result<(Option<Way>, u32), CommandError> {
        let known = match self.by_tests()? {
            Some(known) => Some(known),
            None => self.after_beginnings()?,
        };
        let fewer = known.as_ref().map(|known| known.transitions.saturating_sub(1));
        let length = fewer.map_or(self.length, |fewer| fewer.min(self.length));
        let budget = if known.is_some() { self.budget.at_most(SHORTER) } else { self.budget };
        let what = "the shortest way to a difference";
        let searched = self.search(self.comparison, self.folder, (length, what), budget)?;
        let is_shortest = searched.difference.is_some() || fewer == Some(searched.none);
        let known = known.map(|Differing { said, lines, .. }| Difference { said, lines });
        let way = searched.difference.or(known);
        Ok((way.map(|difference| Way { difference, is_shortest }), searched.none))
    }

    fn c(&self) -> &str {
        &self.comparison.files[0].text
    }

    fn by_tests(&self) -> Result<Option<Differing>, CommandError> {
        testable(differing(self.agent, self.c())).map(Option::flatten)
    }

    fn after_beginnings(&self) -> Result<Option<Differing>, CommandError> {
        let mut beginnings = testable(places(self.agent))?.unwrap_or_default();
        let differs = |next: &str| {
            let event = next.split([' ', ',']).next().unwrap_or_default();
            self.validated.open.iter().any(|open| open.part.contains(&format!("{event} ")))
        };
        beginnings.sort_by_key(|(next, acts)| (!differs(next), acts.len()));
        // The empty one is that of the search for the shortest way.
        beginnings.retain(|(_, acts)| !acts.is_empty());
        let budget = self.budget.at_most(AFTER_ALL);
        for (next, acts) in &beginnings {
            if self.watch.stops() || budget.is_over() {
                break;
            }
            let what = format!("a difference where {next} is next, after {} acts", acts.len());
            if let Some(found) = self.after(acts, &what, budget)? {
                let lines = &found.lines;
                let known = shorter(self.agent, lines, self.c());
                let known = testable(known)?.flatten();
                let transitions = u32::try_from(lines.len()).unwrap_or(u32::MAX);
                let Difference { said, lines } = found;
                return Ok(Some(known.unwrap_or(Differing { lines, transitions, said })));
            }
        }
        Ok(None)
    }

    /// A difference soon after a beginning.
    fn after(
        &self,
        beginning: &[Act],
        what: &str,
        budget: Budget,
    ) -> Result<Option<Difference>, CommandError> {
        let Agent { configuration, text, .. } = self.agent;
        let mut comparison = comparison_after(configuration, text, beginning)?;
        self.c().clone_into(&mut comparison.files[0].text);
        comparison.files.extend(self.agent.own_headers(&comparison.files)?);
        let folder = self.folder.join("beginning");
        write_comparison(&comparison, &folder)?;
        let budget = budget.at_most(AFTER);
        Ok(self.search(&comparison, &folder, (BEYOND, what), budget)?.difference)
    }

    fn search(
        &self,
        comparison: &Comparison,
        folder: &Path,
        (length, what): (u32, &str),
        budget: Budget,
    ) -> Result<SearchedWay, CommandError> {
        let declared = self.agent.configuration.declarations();
        let limits = (budget, self.watch);
        let lengths = (self.validated.calls, length);
        Ok(difference(comparison, declared, self.cbmc, folder, (lengths, what), limits)?)
    }
}

/// Nothing for an agent whose values only the environment can create: there are no tests of it.
fn testable<T>(tested: Result<T, CoverageError>) -> Result<Option<T>, CommandError> {
    match tested {
        Ok(tested) => Ok(Some(tested)),
        // No test is somebody's own.
        Err(CoverageError::Translate(_) | CoverageError::Test(_)) => Ok(None),
        Err(CoverageError::Header(error)) => Err(error.into()),
        Err(CoverageError::Tool(error)) => Err(error.into()),
    }
}
