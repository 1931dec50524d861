//! Plots of the report.

use std::error::Error;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use serde::Serialize;

use super::data::{Band, BandKind, Flight};
use crate::drawing::{self, Drawing, Drawn, FONT};
use crate::recording::Tick;

/// Width of all plots over time; their time axes are aligned, because the page draws one cursor over all of
/// them.
pub(super) const WIDTH: u32 = 960;
pub(super) const LEFT: u32 = 56;
pub(super) const RIGHT: u32 = 12;
/// Maximum points of a line; more are not visible.
const POINTS: usize = 1500;

const PLACE: &str = "Place (m), dashed: the target";

const BLUE: RGBColor = RGBColor(25, 95, 170);
const ORANGE: RGBColor = RGBColor(178, 76, 14);
const GREEN: RGBColor = RGBColor(40, 130, 70);
const PURPLE: RGBColor = RGBColor(120, 70, 150);
const GREY: RGBColor = RGBColor(110, 110, 110);

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A drawn plot.
pub(super) struct Plot {
    pub(super) title: &'static str,
    /// Whether its horizontal axis is the time of the flight.
    pub(super) over_time: bool,
    /// Name and colour of each line; dashed lines have no entry.
    pub(super) legend: Vec<(&'static str, String)>,
    pub(super) svg: String,
    /// Position of the axes, for what the page draws into a map itself.
    pub(super) map: Option<MapScale>,
}

/// The drawing area of a map in pixels, and the part of the floor that it shows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct MapScale {
    /// Left and right edge.
    x_px: [i32; 2],
    /// Bottom and top edge.
    y_px: [i32; 2],
    /// Right of the start.
    x_m: [f64; 2],
    /// Forward of the start.
    y_m: [f64; 2],
}

/// A line over time.
struct Line {
    name: &'static str,
    colour: RGBColor,
    dashed: bool,
    value: fn(&Tick) -> Option<f64>,
}

const fn line(name: &'static str, colour: RGBColor, value: fn(&Tick) -> Option<f64>) -> Line {
    Line { name, colour, dashed: false, value }
}

const fn dashed(name: &'static str, colour: RGBColor, value: fn(&Tick) -> Option<f64>) -> Line {
    Line { name, colour, dashed: true, value }
}

/// All plots in the order of the page.
pub(super) fn all(flight: &Flight<'_>) -> Result<Vec<Plot>, Box<dyn Error>> {
    let place = [
        line("right", BLUE, |tick| Some(tick.estimate?.x_m)),
        dashed("", BLUE, |tick| Some(tick.target?.x_m)),
        line("forward", ORANGE, |tick| Some(tick.estimate?.y_m)),
        dashed("", ORANGE, |tick| Some(tick.target?.y_m)),
    ];
    let height = [
        line("height", GREEN, |tick| Some(tick.estimate?.z_m)),
        dashed("", GREEN, |tick| Some(tick.target?.z_m)),
    ];
    let error = [
        line("across", BLUE, |tick| {
            let target = tick.target?;
            let at = tick.estimate?;
            Some((target.x_m - at.x_m).hypot(target.y_m - at.y_m))
        }),
        line("up and down", GREEN, |tick| Some((tick.target?.z_m - tick.estimate?.z_m).abs())),
        dashed("place known to (dashed)", GREY, |tick| Some(tick.estimate?.horizontal_deviation_m)),
    ];
    let sticks = [
        line("right", BLUE, |tick| Some(tick.command.roll)),
        line("forward", ORANGE, |tick| Some(-tick.command.pitch)),
        line("up", GREEN, |tick| Some(tick.command.gaz)),
        line("clockwise", PURPLE, |tick| Some(tick.command.yaw)),
    ];
    let battery = [line("charge", GREY, |tick| tick.agent.battery_percent.map(f64::from))];
    let late = [
        line("late", ORANGE, |tick| Some(tick.timing.late_ms)),
        line("work", BLUE, |tick| Some(tick.timing.work_ms)),
    ];
    let mut map = None;
    let track = drawing::svg((560, 520), |area| {
        map = Some(ground_track(area, flight)?);
        Ok(())
    })?;
    Ok(vec![
        Plot { title: "Ground track", over_time: false, legend: Vec::new(), svg: track, map },
        over_time(PLACE, 250, flight, &place)?,
        over_time("Height above the floor (m), dashed: the target", 180, flight, &height)?,
        over_time("Distance from the target (m)", 180, flight, &error)?,
        over_time("Sticks, as shares of the limits", 180, flight, &sticks)?,
        over_time("Battery (%)", 120, flight, &battery)?,
        over_time("Ticks: late, and their work (ms)", 150, flight, &late)?,
        Plot {
            title: "How late ticks were",
            over_time: false,
            legend: Vec::new(),
            svg: drawing::svg((560, 220), |area| histogram(area, &flight.lateness_ms()))?,
            map: None,
        },
    ])
}

fn over_time(
    title: &'static str,
    height: u32,
    flight: &Flight<'_>,
    lines: &[Line],
) -> Result<Plot, Box<dyn Error>> {
    // Only one plot labels the steps.
    let labelled = title == PLACE;
    let svg = drawing::svg((WIDTH, height), |area| {
        let values = flight
            .ticks
            .iter()
            .flat_map(|(_, tick)| lines.iter().filter_map(|line| (line.value)(tick)));
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = if low < high { (low, high) } else { (low - 1.0, low + 1.0) };
        let margin = (high - low) * if labelled { 0.14 } else { 0.08 };
        let mut chart = ChartBuilder::on(area)
            .margin_top(6)
            .margin_right(RIGHT)
            .x_label_area_size(26)
            .y_label_area_size(LEFT)
            .build_cartesian_2d(0.0..flight.end_s.max(0.1), low - margin..high + margin)?;
        bands(&mut chart, &flight.bands, low - margin, high + margin)?;
        if labelled {
            band_labels(&mut chart, flight, high + margin)?;
        }
        chart
            .configure_mesh()
            .x_label_formatter(&|seconds| format!("{seconds:.0} s"))
            .y_labels(6)
            .label_style((FONT, 12))
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.08))
            .draw()?;
        for line in lines {
            draw_line(&mut chart, flight, line)?;
        }
        Ok(())
    })?;
    let legend = lines.iter().filter(|line| lines.len() > 1 && !line.name.is_empty());
    let legend = legend.map(|line| {
        let RGBColor(red, green, blue) = line.colour;
        (line.name, format!("rgb({red},{green},{blue})"))
    });
    Ok(Plot { title, over_time: true, legend: legend.collect(), svg, map: None })
}

/// Sections of the flight as background.
fn bands(chart: &mut Chart<'_, '_>, bands: &[Band], low: f64, high: f64) -> Drawn {
    for band in bands {
        let colour = match band.kind {
            BandKind::Ground => GREY.mix(0.16),
            BandKind::Step(step) if step % 2 == 0 => BLUE.mix(0.07),
            BandKind::Step(_) => TRANSPARENT,
            BandKind::Other => ORANGE.mix(0.16),
        };
        let corners = [(band.from_s, low), (band.to_s, high)];
        chart.draw_series([Rectangle::new(corners, colour.filled())])?;
    }
    Ok(())
}

/// Labels of the steps, where there is room for them.
fn band_labels(chart: &mut Chart<'_, '_>, flight: &Flight<'_>, top: f64) -> Drawn {
    const CHARACTER_PX: f64 = 6.0;
    let px_per_s = f64::from(WIDTH - LEFT - RIGHT) / flight.end_s.max(0.1);
    for band in &flight.bands {
        let room_px = (band.to_s - band.from_s) * px_per_s;
        let width_px = band.label.chars().count() as f64 * CHARACTER_PX;
        if width_px < room_px {
            chart.draw_series([EmptyElement::at((band.from_s, top))
                + Text::new(band.label.clone(), (4, 3), (FONT, 11))])?;
        }
    }
    Ok(())
}

/// Draws a line with gaps where there is no value.
fn draw_line(chart: &mut Chart<'_, '_>, flight: &Flight<'_>, line: &Line) -> Drawn {
    let every = flight.ticks.len().div_ceil(POINTS).max(1);
    let mut parts: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for (at_s, tick) in flight.ticks.iter().step_by(every) {
        match (line.value)(tick) {
            Some(value) => parts.last_mut().into_iter().for_each(|part| part.push((*at_s, value))),
            None if parts.last().is_some_and(|part| !part.is_empty()) => parts.push(Vec::new()),
            None => {}
        }
    }
    let colour = line.colour;
    for part in parts.into_iter().filter(|part| !part.is_empty()) {
        if line.dashed {
            chart.draw_series(DashedLineSeries::new(part, 4, 4, colour.mix(0.7).into()))?;
        } else {
            chart.draw_series(LineSeries::new(part, colour.stroke_width(2)))?;
        }
    }
    Ok(())
}

/// Top view, with the same scale on both axes.
fn ground_track(area: &Drawing<'_>, flight: &Flight<'_>) -> Result<MapScale, Box<dyn Error>> {
    let places =
        || flight.ticks.iter().filter_map(|(_, tick)| tick.estimate).map(|at| (at.x_m, at.y_m));
    let mut targets: Vec<(f64, f64)> = Vec::new();
    for target in flight.ticks.iter().filter_map(|(_, tick)| tick.target) {
        let near = |other: &(f64, f64)| (other.0 - target.x_m).hypot(other.1 - target.y_m) < 0.02;
        if !targets.last().is_some_and(near) {
            targets.push((target.x_m, target.y_m));
        }
    }
    let tags = flight.tags.iter().flat_map(|(_, tags)| &tags.tags).map(|tag| (tag.x_m, tag.y_m));
    let all = || places().chain(targets.iter().copied()).chain(tags.clone());
    let extent = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)))
    };
    let x = extent(&mut all().map(|place| place.0));
    let y = extent(&mut all().map(|place| place.1));
    let half_m = ((x.1 - x.0).max(y.1 - y.0) * 0.6).max(0.5);
    let (x, y) = (f64::midpoint(x.0, x.1), f64::midpoint(y.0, y.1));
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(x - half_m..x + half_m, y - half_m..y + half_m)?;
    chart
        .configure_mesh()
        .x_desc("right (m)")
        .y_desc("forward (m)")
        .label_style((FONT, 12))
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.1))
        .draw()?;
    let every = flight.ticks.len().div_ceil(POINTS).max(1);
    chart.draw_series(LineSeries::new(places().step_by(every), BLUE.stroke_width(2)))?;
    chart.draw_series([TriangleMarker::new((0.0, 0.0), 8, GREY.filled())])?;
    chart.draw_series(
        targets.iter().map(|target| Circle::new(*target, 5, ORANGE.stroke_width(2))),
    )?;
    let (across, down) = chart.plotting_area().get_pixel_range();
    Ok(MapScale {
        x_px: [across.start, across.end],
        y_px: [down.end, down.start],
        x_m: [x - half_m, x + half_m],
        y_m: [y - half_m, y + half_m],
    })
}

fn histogram(area: &Drawing<'_>, late_ms: &[f64]) -> Drawn {
    /// Lateness from which all ticks share the last bar.
    const MOST_MS: f64 = 5.0;
    const BARS: usize = 50;
    let mut counts = [0_usize; BARS];
    for late in late_ms {
        // Lateness is not negative; values beyond the last bar are counted in it.
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let bar = (late / MOST_MS * BARS as f64) as usize;
        counts[bar.min(BARS - 1)] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(1).max(1) as f64;
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(48)
        .build_cartesian_2d(0.0..MOST_MS, 0.0..most.log10() + 0.3)?;
    chart
        .configure_mesh()
        .x_desc("ms after the deadline; the last bar is all that is later")
        .y_desc("ticks")
        .y_label_formatter(&|exponent| format!("{:.0}", 10_f64.powf(*exponent)))
        .y_labels(4)
        .disable_x_mesh()
        .label_style((FONT, 12))
        .light_line_style(TRANSPARENT)
        .draw()?;
    let width_ms = MOST_MS / BARS as f64;
    let bars = counts.iter().enumerate().filter(|(_, count)| **count > 0);
    chart.draw_series(bars.map(|(bar, count)| {
        let from_ms = bar as f64 * width_ms;
        let height = (*count as f64).log10() + 0.15;
        Rectangle::new([(from_ms, 0.0), (from_ms + width_ms * 0.9, height)], BLUE.filled())
    }))?;
    Ok(())
}
