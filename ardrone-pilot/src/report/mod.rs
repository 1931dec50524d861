//! A flight as a page to be read afterwards: one HTML file, with plots as SVG, that needs no network.

mod data;
mod page;
mod plots;

use data::Flight;

use crate::recording::Log;

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// No drone was heard.
    #[error("there is no tick in the log: no drone was heard")]
    Empty,
    /// The drawing library gave up.
    #[error("cannot draw the report: {0}")]
    Drawing(String),
}

/// The page about a flight.
///
/// # Errors
/// [`ReportError`] if there is nothing to tell, or it cannot be drawn.
pub fn html(log: &Log) -> Result<String, ReportError> {
    let flight = Flight::new(log).ok_or(ReportError::Empty)?;
    let plots = plots::all(&flight).map_err(|error| ReportError::Drawing(error.to_string()))?;
    Ok(page::html(log, &flight, &plots))
}
