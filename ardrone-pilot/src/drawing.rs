//! Common parts of all drawings.

use std::error::Error;

use autopilot::plan::Border;
use diagnostic::printable;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Font of all labels.
pub(crate) const FONT: &str = "sans-serif";

/// A part of a drawing.
pub(crate) type Drawing<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Result of a drawing function.
pub(crate) type Drawn = Result<(), Box<dyn Error>>;

/// Colour of the fence.
pub(crate) const FENCE: RGBColor = RGBColor(190, 60, 40);
/// Pieces of the fence are no longer, in metres.
const PIECE_M: f64 = 0.2;

/// A chart of places from above, right and forward in metres, with the same scale on both axes and with the fence.
pub(crate) struct Map<'a> {
    pub(crate) chart: ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>,
    /// Half of its width and of its height, in metres.
    pub(crate) half_m: f64,
    pub(crate) middle: (f64, f64),
}

impl<'a> Map<'a> {
    /// One that shows these places.
    pub(crate) fn new(
        area: &Drawing<'a>,
        name: &str,
        places: impl Iterator<Item = (f64, f64)> + Clone,
        border: &Border,
    ) -> Result<Self, Box<dyn Error>> {
        let extent = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let x = extent(&mut places.clone().map(|place| place.0));
        let y = extent(&mut places.map(|place| place.1));
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
        let mut map = Self { chart, half_m, middle: (x, y) };
        let sides = border.sides_m().flat_map(pieces);
        let fence = sides.filter(|ends| ends.iter().all(|end| map.shows(*end)));
        let fence: Vec<_> =
            fence.map(|part| PathElement::new(part, FENCE.stroke_width(2))).collect();
        map.chart.draw_series(fence)?;
        Ok(map)
    }

    /// Whether a place is on it: the library would draw those outside along the edge.
    pub(crate) fn shows(&self, (x, y): (f64, f64)) -> bool {
        (x - self.middle.0).abs() < self.half_m && (y - self.middle.1).abs() < self.half_m
    }
}

/// A side of the fence in short pieces, of which those in view are drawn.
fn pieces([from, to]: [[f64; 2]; 2]) -> impl Iterator<Item = [(f64, f64); 2]> {
    let length_m = (to[0] - from[0]).hypot(to[1] - from[1]);
    let count = (length_m / PIECE_M).ceil().clamp(1.0, 10_000.0);
    let at = move |share: f64| {
        let between = |axis: usize| from[axis] + share * (to[axis] - from[axis]);
        (between(0), between(1))
    };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 10 000")]
    let parts = 0..count as u32;
    parts.map(move |part| {
        let [begins, ends] = [f64::from(part), f64::from(part + 1)].map(|part| at(part / count));
        [begins, ends]
    })
}

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
