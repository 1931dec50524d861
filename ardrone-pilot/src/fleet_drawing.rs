//! Drawing of a fleet: the ways of all vehicles from above.

use plotters::prelude::*;

use crate::drawing::{self, Drawing, Drawn, FONT, Map};
use crate::fleet::{Fleet, SimulatedFleet};
use crate::plan_drawing::PlanDrawingError;

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
    let places_m = starts_m.chain(tracks_m).map(|place_m| (place_m.x, place_m.y));
    let border = &fleet.members[0].config.limits.border;
    let Map { mut chart, .. } = Map::new(area, name, places_m, border)?;
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
