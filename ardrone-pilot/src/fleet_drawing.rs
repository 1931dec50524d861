//! Drawing of a fleet: the ways of all vehicles from above.

use autopilot::plan::FlightLimits;
use diagnostic::printable;
use nalgebra::Vector2;
use plotters::prelude::*;

use crate::drawing::{self, Drawing, Drawn, FONT};
use crate::fleet::{Fleet, SimulatedFleet};
use crate::plan_drawing::{FENCE, PlanDrawingError, pieces};

const SIZE: (u32, u32) = (640, 640);

/// Draws where all vehicles fly together in simulated time, as SVG.
///
/// # Errors
/// [`PlanDrawingError`] if the drawing library fails.
pub(crate) fn svg(
    name: &str,
    fleet: &Fleet,
    simulated: &SimulatedFleet,
) -> Result<String, PlanDrawingError> {
    drawing::svg(SIZE, |area| from_above(area, name, fleet, simulated))
        .map_err(|error| PlanDrawingError(error.to_string()))
}

fn from_above(area: &Drawing<'_>, name: &str, fleet: &Fleet, simulated: &SimulatedFleet) -> Drawn {
    let start_m =
        |number: usize| fleet.members[number].config.estimator.start.unwrap_or_default().place_m;
    let starts_m = (0..fleet.members.len()).map(start_m);
    let tracks_m = simulated.members.iter().flat_map(|member| member.track_m.iter().copied());
    let places_m: Vec<Vector2<f64>> = starts_m.chain(tracks_m).collect();
    let extent = |axis: usize| {
        let values = places_m.iter().map(|place_m| place_m[axis]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    };
    let (x, y) = (extent(0), extent(1));
    let half_m = ((x.1 - x.0).max(y.1 - y.0) * 0.55 + 0.5).max(1.0);
    let (x, y) = (f64::midpoint(x.0, x.1), f64::midpoint(y.0, y.1));
    let mut chart = ChartBuilder::on(area)
        .caption(printable(name), (FONT, 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(44)
        .build_cartesian_2d(x - half_m..x + half_m, y - half_m..y + half_m)?;
    chart
        .configure_mesh()
        .x_desc("right (m)")
        .y_desc("forward (m)")
        .label_style((FONT, 13))
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.1))
        .draw()?;
    let inside = |(at_x, at_y): (f64, f64)| (at_x - x).abs() < half_m && (at_y - y).abs() < half_m;
    let FlightLimits { border, .. } = fleet.members[0].config.limits;
    let sides = border.sides_m().flat_map(pieces);
    let fence = sides.filter(|[from, to]| inside(*from) && inside(*to));
    chart.draw_series(fence.map(|part| PathElement::new(part, FENCE.stroke_width(2))))?;
    for member in &simulated.members {
        let colour = Palette99::pick(member.number).to_rgba();
        let track = member.track_m.iter().map(|place_m| (place_m.x, place_m.y));
        let name = fleet.members[member.number].config.name.as_str();
        chart
            .draw_series(LineSeries::new(track, colour.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
        let start = start_m(member.number);
        chart.draw_series([TriangleMarker::new((start.x, start.y), 8, colour.filled())])?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .label_font((FONT, 14))
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.2))
        .draw()?;
    Ok(())
}
