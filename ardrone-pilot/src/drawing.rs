//! Common parts of all drawings.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

/// Font of all labels.
pub(crate) const FONT: &str = "sans-serif";

/// A part of a drawing.
pub(crate) type Drawing<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Result of a drawing function.
pub(crate) type Drawn = Result<(), Box<dyn Error>>;

/// Creates an SVG with a white background.
pub(crate) fn svg(
    size: (u32, u32),
    draw: impl FnOnce(&Drawing<'_>) -> Drawn,
) -> Result<String, Box<dyn Error>> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE)?;
        draw(&area)?;
        area.present()?;
    }
    Ok(svg)
}
