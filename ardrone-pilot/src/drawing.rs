//! What all drawings have in common.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

/// Of all labels.
pub(crate) const FONT: &str = "sans-serif";

/// A part of a drawing.
pub(crate) type Drawing<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// What the drawing library says.
pub(crate) type Drawn = Result<(), Box<dyn Error>>;

/// A drawing on white, as SVG.
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
