//! The numbers of the plots, thinned to what a screen can show. The page draws them.

use kinematics::wrap_deg;
use serde::Serialize;
use serde_json::{Value, json};

use super::rows::Row;
use super::wind;
use crate::recording::Place;

/// Most moments of a plot. Of a longer flight each moment stands for several ticks, of which the plot shows the smallest
/// and the largest value: what lasted for one tick is seen as well.
const MOMENTS: usize = 4000;
/// Larger numbers are no measurement.
const LARGEST: f64 = 1e9;
/// Targets that are nearer to each other are drawn as one.
const SAME_TARGET_M: f64 = 0.02;
/// Most targets on the map.
const MOST_TARGETS: usize = 1000;

/// What values refer to.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Scales {
    /// The drone's tilt at full stick, if the recorded settings can be read.
    pub(super) tilt_deg: Option<f64>,
    /// The zero of the drone's own heading, against the start.
    pub(super) north_deg: Option<f64>,
}

type Read = fn(&Row<'_>, &Scales) -> Option<f64>;

/// A line of a plot.
struct Line {
    name: &'static str,
    colour: &'static str,
    dashed: bool,
    value: Read,
}

/// Colours by name: the page has a light and a dark one of each.
const BLUE: &str = "blue";
const ORANGE: &str = "orange";
const GREEN: &str = "green";
const PURPLE: &str = "purple";
const GREY: &str = "grey";

const fn line(name: &'static str, colour: &'static str, value: Read) -> Line {
    Line { name, colour, dashed: false, value }
}

const fn dashed(name: &'static str, colour: &'static str, value: Read) -> Line {
    Line { name, colour, dashed: true, value }
}

/// A plot: its title, the height of its drawing in pixels, and its lines.
struct Plot {
    title: &'static str,
    height_px: u32,
    lines: &'static [Line],
}

const fn plot(title: &'static str, height_px: u32, lines: &'static [Line]) -> Plot {
    Plot { title, height_px, lines }
}

/// A vector of the world by the drone's axes: to its right and forward.
fn by_axes(yaw_deg: f64, x: f64, y: f64) -> (f64, f64) {
    let (sin, cos) = yaw_deg.to_radians().sin_cos();
    (x * cos - y * sin, x * sin + y * cos)
}

fn velocity(row: &Row<'_>) -> Option<(f64, f64)> {
    let at = row.tick.estimate?;
    Some(by_axes(at.yaw_deg, at.vx_m_s, at.vy_m_s))
}

/// The same as navdata have it.
fn measured(row: &Row<'_>) -> Option<[f64; 3]> {
    row.heard?.velocity_m_s
}

fn attitude(row: &Row<'_>) -> Option<[f64; 3]> {
    row.heard?.attitude_deg
}

static PLOTS: [Plot; 12] = [
    plot(
        "Place (m), dashed: the target",
        190,
        &[
            line("right", BLUE, |row, _| Some(row.tick.estimate?.x_m)),
            dashed("target right", BLUE, |row, _| Some(row.tick.target?.x_m)),
            line("forward", ORANGE, |row, _| Some(row.tick.estimate?.y_m)),
            dashed("target forward", ORANGE, |row, _| Some(row.tick.target?.y_m)),
        ],
    ),
    plot(
        "Height above the floor (m)",
        150,
        &[
            line("estimated", GREEN, |row, _| Some(row.tick.estimate?.z_m)),
            dashed("target", GREEN, |row, _| Some(row.tick.target?.z_m)),
            line("in navdata", GREY, |row, _| row.heard?.altitude_m),
        ],
    ),
    plot(
        "Distance from the target (m), dashed: the uncertainty of the place",
        150,
        &[
            line("across", BLUE, |row, _| {
                let (target, at) = (row.tick.target?, row.tick.estimate?);
                Some((target.x_m - at.x_m).hypot(target.y_m - at.y_m))
            }),
            line("up and down", GREEN, |row, _| {
                Some((row.tick.target?.z_m - row.tick.estimate?.z_m).abs())
            }),
            dashed("uncertainty", GREY, |row, _| Some(row.tick.estimate?.uncertainty_m)),
        ],
    ),
    plot(
        "Velocity by the drone's axes (m/s), dashed: as navdata have it",
        190,
        &[
            line("right", BLUE, |row, _| Some(velocity(row)?.0)),
            dashed("right in navdata", BLUE, |row, _| Some(measured(row)?[1])),
            line("forward", ORANGE, |row, _| Some(velocity(row)?.1)),
            dashed("forward in navdata", ORANGE, |row, _| Some(measured(row)?[0])),
            line("up", GREEN, |row, _| Some(row.tick.estimate?.vz_m_s)),
        ],
    ),
    plot(
        "Tilt in navdata (°), dashed: as ordered",
        170,
        &[
            line("to the right", BLUE, |row, _| Some(attitude(row)?[0])),
            dashed("ordered to the right", BLUE, |row, scales| Some(tilt_ordered(row, scales)?.0)),
            line("forward", ORANGE, |row, _| Some(-attitude(row)?[1])),
            dashed("ordered forward", ORANGE, |row, scales| Some(tilt_ordered(row, scales)?.1)),
        ],
    ),
    plot(
        "Heading (° clockwise)",
        150,
        &[
            line("estimated", PURPLE, |row, _| Some(row.tick.estimate?.yaw_deg)),
            dashed("target", PURPLE, |row, _| Some(row.tick.target?.yaw_deg)),
            line("in navdata", GREY, |row, scales| {
                Some(wrap_deg(attitude(row)?[2] - scales.north_deg?))
            }),
        ],
    ),
    plot(
        "Sticks, as shares of the limits",
        150,
        &[
            line("right", BLUE, |row, _| Some(row.tick.command.roll)),
            line("forward", ORANGE, |row, _| Some(-row.tick.command.pitch)),
            line("up", GREEN, |row, _| Some(row.tick.command.gaz)),
            line("clockwise", PURPLE, |row, _| Some(row.tick.command.yaw)),
        ],
    ),
    plot(
        "Wind (% of what full tilt holds against), dashed: what it pushes to the right and forward",
        120,
        &[
            line("wind", GREY, |row, _| Some(row.tick.agent.wind * 100.0)),
            dashed("to the right", BLUE, |row, _| Some(wind_percent(row)?[0])),
            dashed("forward", ORANGE, |row, _| Some(wind_percent(row)?[1])),
        ],
    ),
    plot(
        "Navdata: their age (ms) and what is missing (% of a second)",
        150,
        &[
            line("newest", BLUE, |row, _| Some(row.age_s? * 1e3)),
            // Whole milliseconds.
            dashed("newest believed", ORANGE, |row, _| Some(row.tick.agent.blind_for_ms as f64)),
            line("missing", GREY, |row, _| Some(row.missing * 100.0)),
        ],
    ),
    plot(
        "Battery (%)",
        110,
        &[line("charge", GREEN, |row, _| row.tick.agent.battery_percent.map(f64::from))],
    ),
    plot("Battery (V)", 110, &[line("voltage", GREEN, |row, _| row.battery_v)]),
    plot(
        "Ticks: late, and their work (ms)",
        120,
        &[
            line("late", ORANGE, |row, _| Some(row.tick.timing.late_ms)),
            line("work", BLUE, |row, _| Some(row.tick.timing.work_ms)),
        ],
    ),
];

/// Tilt to the right and forward at these sticks.
pub(super) fn tilt_ordered(row: &Row<'_>, scales: &Scales) -> Option<(f64, f64)> {
    let tilt_deg = scales.tilt_deg?;
    let command = &row.tick.command;
    Some((command.roll * tilt_deg, -command.pitch * tilt_deg))
}

/// The wind towards right and forward, in percent of what full tilt holds against.
fn wind_percent(row: &Row<'_>) -> Option<[f64; 2]> {
    let towards = row.tick.wind_m_s2?;
    let m_s2 = towards[0].hypot(towards[1]);
    let percent = if m_s2 > 0.0 { row.tick.agent.wind * 100.0 / m_s2 } else { 0.0 };
    Some(towards.map(|part| part * percent))
}

/// Plots, track and targets as the page reads them.
#[derive(Debug, Serialize)]
pub(super) struct Series {
    times: Vec<f64>,
    plots: Vec<Value>,
    /// Right, forward and heading at each time.
    track: [Vec<Option<f64>>; 3],
    /// What lasts of the wind at each time, towards right and forward, in m/s²; not a number where it was not recorded.
    wind: [Vec<Option<f64>>; 2],
    /// Names of the sides from which it comes, clockwise by eighths.
    wind_from: [&'static str; 8],
    targets: Vec<[f64; 2]>,
}

impl Series {
    pub(super) fn new(rows: &[Row<'_>], scales: &Scales) -> Self {
        // Two moments for each run of ticks: its smallest and its largest value.
        let every = if rows.len() <= MOMENTS { 1 } else { rows.len().div_ceil(MOMENTS / 2) };
        let plots = PLOTS.iter().map(|plot| {
            let lines = plot.lines.iter().map(|line| {
                let values = thinned(rows, every, |row| (line.value)(row, scales));
                json!({ "name": line.name, "colour": line.colour, "dashed": line.dashed, "values": values })
            });
            json!({ "title": plot.title, "height": plot.height_px, "lines": lines.collect::<Vec<_>>() })
        });
        let place = |value: fn(Place) -> f64| {
            let value =
                |row: &&Row<'_>| row.tick.estimate.map(|at| value(at.into())).and_then(short);
            moments(rows, every).map(|row| value(&row)).collect()
        };
        Self {
            times: moments(rows, every).filter_map(|row| short(row.at_s)).collect(),
            plots: plots.collect(),
            track: [place(|at| at.x_m), place(|at| at.y_m), place(|at| at.yaw_deg)],
            wind: [0, 1].map(|part| {
                let value = |row: &Row<'_>| row.tick.wind_m_s2.and_then(|wind| short(wind[part]));
                moments(rows, every).map(value).collect()
            }),
            wind_from: wind::FROM,
            targets: targets(rows),
        }
    }
}

/// The places of the target.
fn targets(rows: &[Row<'_>]) -> Vec<[f64; 2]> {
    let mut targets: Vec<[f64; 2]> = Vec::new();
    for target in rows.iter().filter_map(|row| row.tick.target) {
        let near = |other: &[f64; 2]| (other[0] - target.x_m).hypot(other[1] - target.y_m);
        let is_new = targets.last().is_none_or(|last| near(last) > SAME_TARGET_M);
        if is_new && targets.len() < MOST_TARGETS {
            targets.extend(short(target.x_m).zip(short(target.y_m)).map(|(x, y)| [x, y]));
        }
    }
    targets
}

/// The rows whose times are shown: of each run the first and the middle one.
fn moments<'a>(rows: &'a [Row<'a>], every: usize) -> impl Iterator<Item = &'a Row<'a>> {
    let of_run = move |run: &'a [Row<'a>]| {
        let middle = if every > 1 { run.get(run.len() / 2) } else { None };
        run.first().into_iter().chain(middle)
    };
    rows.chunks(every).flat_map(of_run)
}

/// The value at each of these moments: the smallest and the largest of a run, in the order in which they came.
fn thinned<'a>(
    rows: &'a [Row<'a>],
    every: usize,
    value: impl Fn(&Row<'a>) -> Option<f64>,
) -> Vec<Option<f64>> {
    if every == 1 {
        return rows.iter().map(|row| value(row).and_then(short)).collect();
    }
    let of_run = |run: &'a [Row<'a>]| {
        let values = || {
            let values = run.iter().enumerate();
            values.filter_map(|(index, row)| Some((index, short(value(row)?)?)))
        };
        let least = values().min_by(|a, b| a.1.total_cmp(&b.1));
        let most = values().max_by(|a, b| a.1.total_cmp(&b.1));
        let (first, second) =
            if least.map(|it| it.0) <= most.map(|it| it.0) { (least, most) } else { (most, least) };
        [first, second].map(|value| value.map(|(_, value)| value))
    };
    rows.chunks(every).flat_map(of_run).collect()
}

/// A number of a few digits; `None` if it cannot be one that was measured.
pub(super) fn short(value: f64) -> Option<f64> {
    (value.abs() < LARGEST).then(|| (value * 1e3).round() / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lasts_for_a_moment_is_kept_and_what_is_no_number_is_left_out() {
        assert_eq!((short(1.23456), short(f64::NAN), short(1e300)), (Some(1.235), None, None));
        let (right, forward) = by_axes(90.0, 1.0, 0.0);
        // Nose to the right of the world: what goes there goes forward.
        assert!(right.abs() < 1e-9 && (forward - 1.0).abs() < 1e-9);
    }
}
