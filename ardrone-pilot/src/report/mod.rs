//! Report of a flight: one HTML file that draws itself and needs no network.

mod data;
mod events;
mod findings;
mod others;
mod page;
mod pictures;
mod rows;
mod series;
mod spans;
mod wind;
mod words;

use std::time::Duration;

use data::Flight;
use findings::findings;

use crate::flights::{RecordedFlight, flights};
use crate::recording::{Log, RecordedPicture};

/// What is shown of the time on the ground before a flight, and behind its outcome.
const BEFORE: Duration = Duration::from_secs(10);
const BEHIND: Duration = Duration::from_secs(3);

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The log, or its part about the flight, has no ticks.
    #[error("the log contains no ticks: no drone answered")]
    Empty,
    /// The recording has fewer flights.
    #[error("the recording has no flight {0}")]
    NoFlight(usize),
}

/// The flights of a recording, each of which has a page.
#[derive(Debug)]
pub struct Reports<'a> {
    log: &'a Log,
    pictures: &'a [RecordedPicture],
    flights: Vec<RecordedFlight>,
}

impl<'a> Reports<'a> {
    /// Finds the flights of a recording; `pictures` are those of its camera, if they were recorded.
    pub fn new(log: &'a Log, pictures: &'a [RecordedPicture]) -> Self {
        Self { log, pictures, flights: flights(log) }
    }

    /// How many pages there are: one for each flight, and one for a recording without any.
    pub fn count(&self) -> usize {
        self.flights.len().max(1)
    }

    /// The page about a flight, counted from 0; `link` is the address of another one's.
    ///
    /// # Errors
    /// [`ReportError`] if there is no such flight, or nothing was recorded of it.
    pub fn html(
        &self,
        index: usize,
        link: impl Fn(usize) -> String,
    ) -> Result<String, ReportError> {
        if index >= self.count() {
            return Err(ReportError::NoFlight(index + 1));
        }
        let span = self.span(index);
        let flight = Flight::new(self.log, span).ok_or(ReportError::Empty)?;
        let outcome = match self.flights.get(index) {
            Some(flight) => flight.outcome.clone(),
            None => self.log.outcome().map(|(warns, text)| (warns, text.to_owned())),
        };
        let plan = self.flights.get(index).map_or(self.log.plan_name.as_str(), |it| &it.plan);
        let links = (0..self.count()).map(link).collect();
        let findings = findings(&flight);
        let pictures = pictures::embedded(self.pictures, self.log.start, span);
        let about = page::About { plan, outcome, index, links, findings };
        Ok(page::html(self.log, &flight, &about, &pictures))
    }

    /// The part of the recording that is about a flight: not the rest before and behind it, in which nothing happens, and
    /// nothing of its neighbours.
    fn span(&self, index: usize) -> (Duration, Duration) {
        let Some(flight) = self.flights.get(index) else { return (Duration::ZERO, Duration::MAX) };
        let end = |flight: &RecordedFlight| flight.ended.unwrap_or(flight.air.1).max(flight.air.1);
        let before = index.checked_sub(1).and_then(|before| self.flights.get(before));
        let from = before.map_or(Duration::ZERO, end).max(flight.air.0.saturating_sub(BEFORE));
        let next = self.flights.get(index + 1).map_or(Duration::MAX, |next| next.air.0);
        (from, end(flight).saturating_add(BEHIND).min(next))
    }
}

/// The page of a recording's last flight.
///
/// # Errors
/// [`ReportError`] if the log is empty.
pub fn html(log: &Log, pictures: &[RecordedPicture]) -> Result<String, ReportError> {
    let reports = Reports::new(log, pictures);
    reports.html(reports.count() - 1, |_| String::new())
}
