//! Report of a flight: one HTML file with SVG plots that needs no network.

mod data;
mod page;
mod pictures;
mod plots;

use data::Flight;

use crate::recording::{Log, RecordedPicture};

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The log contains no navdata.
    #[error("the log contains no ticks: no drone answered")]
    Empty,
    /// The drawing library failed.
    #[error("cannot draw the report: {0}")]
    Drawing(String),
}

/// Creates the page about a flight, with the pictures of its camera if it recorded them.
///
/// # Errors
/// [`ReportError`] if the log is empty or a plot cannot be drawn.
pub fn html(log: &Log, pictures: &[RecordedPicture]) -> Result<String, ReportError> {
    let flight = Flight::new(log).ok_or(ReportError::Empty)?;
    let plots = plots::all(&flight).map_err(|error| ReportError::Drawing(error.to_string()))?;
    let pictures = pictures::embedded(pictures, log.start);
    Ok(page::html(log, &flight, &plots, &pictures))
}
