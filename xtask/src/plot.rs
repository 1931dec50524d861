//! Plots of the figures, as SVG.

use std::path::Path;

use nalgebra::Vector3;
use plotters::coord::Shift;
use plotters::prelude::*;

use crate::cases::CASES;
use crate::job::{FlyError, Job, fly};
use crate::table::Row;

const COLOUR: RGBColor = RGBColor(25, 95, 170);
const FONT: &str = "sans-serif";

/// The flight to draw: the airframe that differs most from the assumed one, with the plan that moves it most.
const DRAWN: Job = Job { case: 1, plan: 2, seed: 1 };
/// Seconds of it to draw.
const DRAWN_S: f64 = 45.0;
/// Ticks per point.
const DRAWN_TICKS: usize = 4;

pub(crate) fn write_all(folder: &Path, rows: &[Row]) -> Result<(), FlyError> {
    std::fs::create_dir_all(folder)
        .map_err(|source| FlyError::Write { path: folder.to_owned(), source })?;
    write(&folder.join("figures.svg"), (900, 420), |area| figures(area, rows))?;
    let moments = moments(DRAWN)?;
    write(&folder.join("flight.svg"), (900, 620), |area| flight(area, &moments))
}

type Drawing<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

fn write(
    path: &Path,
    size: (u32, u32),
    draw: impl FnOnce(&Drawing<'_>) -> Drawn,
) -> Result<(), FlyError> {
    let area = SVGBackend::new(path, size).into_drawing_area();
    area.fill(&WHITE)
        .map_err(Into::into)
        .and_then(|()| draw(&area))
        .and_then(|()| area.present().map_err(Into::into))
        .map_err(|error: Box<dyn std::error::Error>| FlyError::Write {
            path: path.to_owned(),
            source: std::io::Error::other(error.to_string()),
        })
}

/// Seconds since the first target, position, target.
type Moment = (f64, Vector3<f64>, Vector3<f64>);

fn moments(job: Job) -> Result<Vec<Moment>, FlyError> {
    let mut moments = Vec::new();
    let mut first_s = None;
    fly(job, |moment| {
        let (Some(_), Some(target)) = (moment.status.step, moment.status.target) else { return };
        let now_s = moment.now.as_secs_f64();
        let since_s = now_s - *first_s.get_or_insert(now_s);
        let place = moment.truth.odometry_m.push(moment.truth.position_m.z);
        moments.push((since_s, place, Vector3::new(target.x_m, target.y_m, target.z_m)));
    })?;
    Ok(moments)
}

/// Transit time and overshoot of each case.
fn figures(area: &Drawing<'_>, rows: &[Row]) -> Drawn {
    let rows: Vec<&Row> = rows.iter().filter(|row| CASES[row.case].bound_s.is_some()).collect();
    let (left, right) = area.split_horizontally(450);
    let over_bound = |row: &Row| row.transit_s / CASES[row.case].bound_s.unwrap_or(1.0);
    bars(&left, &rows, "Time between the stays / best possible", 2.0, over_bound)?;
    bars(&right, &rows, "Worst overshoot (m)", 0.4, |row| row.overshoot_worst_m)
}

fn bars(
    area: &Drawing<'_>,
    rows: &[&Row],
    title: &str,
    most: f64,
    value: impl Fn(&Row) -> f64,
) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .caption(title, (FONT, 18))
        .margin(12)
        .x_label_area_size(58)
        .y_label_area_size(44)
        .build_cartesian_2d(0.0..rows.len() as f64, 0.0..most)?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_label_style((FONT, 13))
        .light_line_style(WHITE)
        .draw()?;
    for (index, row) in rows.iter().enumerate() {
        let from = index as f64 + 0.2;
        let height = value(row).min(most);
        chart
            .draw_series([Rectangle::new([(from, 0.0), (from + 0.6, height)], COLOUR.filled())])?;
        chart.draw_series([Text::new(
            format!("{:.2}", value(row)),
            (from, height + most * 0.035),
            (FONT, 11),
        )])?;
        let case = &CASES[row.case];
        for (line, word) in [case.airframe, case.conditions].into_iter().enumerate() {
            chart.draw_series([EmptyElement::at((from, 0.0))
                + Text::new(word, (0, 8 + 15 * i32::try_from(line)?), (FONT, 11))])?;
        }
    }
    Ok(())
}

/// Target and position over time: right, forward and up.
fn flight(area: &Drawing<'_>, moments: &[Moment]) -> Drawn {
    let case = &CASES[DRAWN.case];
    let plan = case.plans[DRAWN.plan].name;
    let area = area.titled(
        &format!("{plan} on the airframe `{}`: place over time", case.airframe),
        (FONT, 18),
    )?;
    let axes = [("right (m), dashed: the target", 0), ("up (m), dashed: the target", 2)];
    for ((title, axis), panel) in axes.into_iter().zip(area.split_evenly((2, 1))) {
        let values = moments.iter().flat_map(|(_, place, target)| [place[axis], target[axis]]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let mut chart = ChartBuilder::on(&panel)
            .margin(10)
            .x_label_area_size(34)
            .y_label_area_size(52)
            .build_cartesian_2d(0.0..DRAWN_S, low - 0.1..high + 0.3)?;
        chart
            .configure_mesh()
            .x_desc("seconds since the first target")
            .y_desc(title)
            .label_style((FONT, 13))
            .light_line_style(WHITE)
            .bold_line_style(BLACK.mix(0.1))
            .draw()?;
        let shown = moments.iter().step_by(DRAWN_TICKS);
        let shown = shown.filter(|(since_s, ..)| *since_s <= DRAWN_S);
        let targets = shown.clone().map(|(since_s, _, target)| (*since_s, target[axis]));
        chart.draw_series(DashedLineSeries::new(targets, 4, 4, COLOUR.mix(0.6).into()))?;
        let places = shown.map(|(since_s, place, _)| (*since_s, place[axis]));
        chart.draw_series(LineSeries::new(places, COLOUR.stroke_width(2)))?;
    }
    Ok(())
}
