//! Drawing of a plan: top view and height over time.

use autopilot::plan::{FlightLimits, Plan};
use autopilot::vehicle::SurveyedTag;
use kinematics::Pose;
use plotters::prelude::*;

use crate::drawing::{self, Drawing, Drawn, FENCE, FONT, Map};

const SIZE: (u32, u32) = (960, 500);
const WAY: RGBColor = RGBColor(25, 95, 170);
const TAG: RGBColor = RGBColor(20, 20, 20);
const GROUND: RGBColor = RGBColor(110, 110, 110);

/// Why a plan could not be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the plan: {0}")]
pub struct PlanDrawingError(pub(crate) String);

/// A place on the way, with its expected times.
#[derive(Debug, Clone, Copy)]
struct Place {
    pose: Pose,
    arrival_s: f64,
    /// End of the stay.
    departure_s: f64,
    /// Number of the step, if it has a target.
    target: Option<usize>,
}

/// Draws a plan as SVG.
///
/// # Errors
/// [`PlanDrawingError`] if the drawing library fails.
pub fn svg(name: &str, plan: &Plan, limits: &FlightLimits) -> Result<String, PlanDrawingError> {
    let places = places(plan, limits);
    drawing::svg(SIZE, |area| {
        let (left, right) = area.split_horizontally(SIZE.1);
        from_above(&left, name, &places, plan.tags(), limits)?;
        over_time(&right, &places, limits)
    })
    .map_err(|error| PlanDrawingError(error.to_string()))
}

fn places(plan: &Plan, limits: &FlightLimits) -> Vec<Place> {
    let mut places = vec![Place {
        pose: limits.start.unwrap_or_default(),
        arrival_s: 0.0,
        departure_s: 0.0,
        target: None,
    }];
    let mut now_s = 0.0;
    for (step, expected) in plan.expectations(limits).into_iter().enumerate() {
        let time_s = expected.time.as_secs_f64();
        now_s += time_s;
        if expected.leg_m == 0.0 && expected.target.is_none() {
            continue;
        }
        places.push(Place {
            pose: expected.place,
            arrival_s: now_s - expected.stay.as_secs_f64(),
            departure_s: now_s,
            target: expected.target.map(|_| step + 1),
        });
    }
    places
}

/// Top view, with the same scale on both axes.
fn from_above(
    area: &Drawing<'_>,
    name: &str,
    places: &[Place],
    tags: &[SurveyedTag],
    limits: &FlightLimits,
) -> Drawn {
    let ways = places.iter().map(|place| (place.pose.x_m, place.pose.y_m));
    let map = Map::new(area, name, ways.chain([(0.0, 0.0)]), &limits.border)?;
    let tags: Vec<_> = tags
        .iter()
        .map(|tag| (tag.place_m.x, tag.place_m.y))
        .filter(|tag| map.shows(*tag))
        .collect();
    let Map { mut chart, half_m, .. } = map;
    let way = places.iter().map(|place| (place.pose.x_m, place.pose.y_m));
    chart.draw_series(LineSeries::new(way, WAY.stroke_width(2)))?;
    let start = limits.start.unwrap_or_default();
    chart.draw_series([TriangleMarker::new((start.x_m, start.y_m), 9, GROUND.filled())])?;
    chart.draw_series(tags.into_iter().flat_map(|tag| {
        [Circle::new(tag, 8, TAG.stroke_width(2)), Circle::new(tag, 3, TAG.filled())]
    }))?;
    let targets = places.iter().filter_map(|place| Some((place.target?, place.pose)));
    let mut labels: Vec<(Pose, Vec<String>)> = Vec::new();
    for (number, pose) in targets {
        // Targets at one place share a label.
        let near =
            |other: &Pose| (other.x_m - pose.x_m).hypot(other.y_m - pose.y_m) < half_m / 40.0;
        match labels.iter_mut().find(|(other, _)| near(other)) {
            Some((_, numbers)) => numbers.push(number.to_string()),
            None => labels.push((pose, vec![number.to_string()])),
        }
        let nose_m = half_m / 12.0;
        let yaw_rad = pose.yaw_deg.to_radians();
        let nose = (pose.x_m + nose_m * yaw_rad.sin(), pose.y_m + nose_m * yaw_rad.cos());
        chart
            .draw_series([PathElement::new([(pose.x_m, pose.y_m), nose], BLACK.stroke_width(2))])?;
        chart.draw_series([Circle::new((pose.x_m, pose.y_m), 4, WAY.filled())])?;
    }
    chart.draw_series(labels.into_iter().map(|(pose, numbers)| {
        EmptyElement::at((pose.x_m, pose.y_m)) + Text::new(numbers.join(", "), (7, 6), (FONT, 14))
    }))?;
    Ok(())
}

/// Height over time, between floor and ceiling.
fn over_time(area: &Drawing<'_>, places: &[Place], limits: &FlightLimits) -> Drawn {
    let end_s = places.last().map_or(1.0, |place| place.departure_s).max(1.0);
    let top_m = limits.ceiling_m + 0.3;
    let mut chart = ChartBuilder::on(area)
        .caption("height over expected time", (FONT, 18))
        .margin(12)
        .x_label_area_size(36)
        .y_label_area_size(44)
        .build_cartesian_2d(0.0..end_s * 1.02, 0.0..top_m)?;
    chart
        .configure_mesh()
        .x_desc("s")
        .y_desc("above the floor (m)")
        .label_style((FONT, 13))
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.1))
        .draw()?;
    for limit_m in [limits.floor_m, limits.ceiling_m] {
        let line = [(0.0, limit_m), (end_s * 1.02, limit_m)];
        chart.draw_series(DashedLineSeries::new(line, 6, 4, FENCE.into()))?;
    }
    let heights = places
        .iter()
        .flat_map(|place| [(place.arrival_s, place.pose.z_m), (place.departure_s, place.pose.z_m)]);
    chart.draw_series(LineSeries::new(heights, WAY.stroke_width(2)))?;
    let targets = places.iter().filter_map(|place| Some((place.target?, place)));
    chart.draw_series(targets.map(|(number, place)| {
        EmptyElement::at((place.arrival_s, place.pose.z_m))
            + Circle::new((0, 0), 3, WAY.filled())
            + Text::new(number.to_string(), (-3, -16), (FONT, 13))
    }))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As on the page, in the terminal and in messages.
    #[test]
    fn targets_have_the_numbers_of_their_steps() {
        let plan = Plan::parse("p", "takeoff\nsetStayTime 1\ngoto 0 1 0 0\nland\n").unwrap();
        let numbers: Vec<usize> =
            places(&plan, &FlightLimits::default()).iter().filter_map(|it| it.target).collect();
        let goto = plan.steps().iter().position(|step| step.text.starts_with("goto")).unwrap();
        assert_eq!(numbers, [goto + 1]);
        assert!(goto > 0);
    }
}
