//! A flight as an animated drawing: the plan with the step that is flown, the height, and the drone from above.
//!
//! CSS animates it, which browsers and code hosts play where a page shows it. What does not animate shows the flight at one moment, and
//! so does a browser that is asked for less motion.

use std::fmt::Write as _;

use kinematics::Pose;
use nalgebra::Vector3;
use system_tests::sim::{Moment, Simulation};
use system_tests::{SQUARE, plan};

/// Ticks from one drawn moment to the next.
const TICKS: usize = 8;
/// How long the end is shown before the flight begins again.
const REST_S: f64 = 2.0;
/// Pixels of the drawing per metre, from above and in the height.
const SCALE: [f64; 2] = [162.0, 68.0];
/// Where the start is on the map, and where the plot of the height begins, in pixels.
const START: [f64; 2] = [507.0, 240.0];
const PLOT: [f64; 2] = [54.0, 292.0];
const PLOT_WIDTH: f64 = 332.0;
/// The first line of the plan, and from one to the next, in pixels.
const LINES: [f64; 2] = [46.0, 20.0];
/// How far a shadow is from the drone, right and down, in pixels for a metre of height.
const SHADOW: f64 = 26.0;

const FRAME: &str = include_str!("animation.svg");

/// What is drawn of a moment.
struct Seen {
    at_s: f64,
    place_m: Vector3<f64>,
    step: Option<usize>,
    target: Option<Pose>,
    distance_m: f64,
}

/// A flight of `plans/square.txt`, from a moment before the take-off to one after the landing.
fn flown() -> Vec<Seen> {
    let mut seen = Vec::new();
    let watch = |moment: &Moment| {
        let status = &moment.status;
        seen.push(Seen {
            at_s: moment.now.as_secs_f64(),
            place_m: moment.truth.position_m,
            step: status.step,
            target: status.target,
            distance_m: status.distance_m.unwrap_or(f64::INFINITY),
        });
    };
    Simulation::default().fly_watched(plan(SQUARE), watch).unwrap();
    let took_off = seen.iter().position(|moment| moment.step.is_some()).unwrap();
    let mut seen: Vec<Seen> = seen.into_iter().skip(took_off).step_by(TICKS).collect();
    let start_s = seen[0].at_s;
    for moment in &mut seen {
        moment.at_s -= start_s;
    }
    seen
}

fn on_map(place_m: Vector3<f64>) -> [f64; 2] {
    [START[0] + SCALE[0] * place_m.x, START[1] - SCALE[0] * place_m.y]
}

/// Points of a line.
fn line(points: impl Iterator<Item = [f64; 2]>) -> String {
    let points: Vec<String> = points.map(|[x, y]| format!("{x:.1} {y:.1}")).collect();
    format!("M{}", points.join("L"))
}

/// The keyframes of a property at all moments, without those between two that are the same.
fn keyframes(name: &str, all_s: f64, moments: &[Seen], values: &[String]) -> String {
    let mut frames = format!("@keyframes {name}{{");
    for (at, (moment, value)) in moments.iter().zip(values).enumerate() {
        let is_same = |other: Option<&String>| other.is_some_and(|other| other == value);
        if !is_same(at.checked_sub(1).map(|at| &values[at])) || !is_same(values.get(at + 1)) {
            _ = write!(frames, "{:.2}%{{{value}}}", 100.0 * moment.at_s / all_s);
        }
    }
    _ = write!(frames, "to{{{}}}}}", values.last().unwrap());
    frames
}

/// The drawing.
pub(crate) fn square() -> String {
    let moments = flown();
    let end_s = moments.last().unwrap().at_s;
    let all_s = end_s + REST_S;
    let still = moments.iter().position(|moment| moment.step == Some(3) && moment.distance_m < 0.4);
    let still = still.unwrap();
    let places: Vec<[f64; 2]> = moments.iter().map(|moment| on_map(moment.place_m)).collect();

    let ways =
        places.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]));
    let mut flown = vec![0.0];
    flown.extend(ways.scan(0.0, |sum, way| {
        *sum += way;
        Some(*sum)
    }));
    let all = *flown.last().unwrap();
    let left: Vec<f64> = flown.iter().map(|way| 1000.0 * (1.0 - way / all)).collect();

    let translated = |[x, y]: [f64; 2]| format!("transform:translate({x:.1}px,{y:.1}px)");
    let fly: Vec<_> = places.iter().map(|place| translated(*place)).collect();
    let shadow = |moment: &Seen| [SHADOW * moment.place_m.z; 2];
    let shade: Vec<_> = moments.iter().map(|moment| translated(shadow(moment))).collect();
    let trail: Vec<_> = left.iter().map(|left| format!("stroke-dashoffset:{left:.1}")).collect();
    let at_line = |moment: &Seen| [0.0, LINES[1] * moment.step.unwrap_or(5) as f64];
    let step: Vec<_> = moments.iter().map(|moment| translated(at_line(moment))).collect();
    let along = |at_s: f64| [PLOT_WIDTH * at_s / end_s, 0.0];
    let [start, end] = [0.0, end_s].map(|at_s| translated(along(at_s)));
    let end_percent = 100.0 * end_s / all_s;
    let cursor =
        format!("@keyframes cursor{{from{{{start}}}{end_percent:.2}%{{{end}}}to{{{end}}}}}");
    let style = [("fly", fly), ("shade", shade), ("trail", trail), ("step", step)]
        .map(|(name, values)| keyframes(name, all_s, &moments, &values))
        .join("\n");

    let mut words = String::new();
    let commands = SQUARE.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    for (number, command) in commands.enumerate() {
        let y = LINES[0] + LINES[1] * number as f64;
        _ = write!(words, "<text x=\"30\" y=\"{y}\">{}  {command}</text>", number + 1);
    }
    let mut targets: Vec<(usize, [f64; 2])> = Vec::new();
    for moment in &moments {
        let (Some(step @ 1..=4), Some(target)) = (moment.step, moment.target) else { continue };
        if targets.iter().all(|(known, _)| *known != step) {
            targets.push((step, on_map(Vector3::new(target.x_m, target.y_m, target.z_m))));
        }
    }
    let start = on_map(Vector3::zeros());
    let planned = line(std::iter::once(start).chain(targets.iter().map(|(_, place)| *place)));
    let mut marks = String::new();
    for (step, [x, y]) in targets {
        _ = write!(marks, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\"/>");
        let (x, y) = (x + if x > 580.0 { 48.0 } else { -48.0 }, y + 5.0);
        _ = write!(marks, "<text x=\"{x:.1}\" y=\"{y:.1}\">{}</text>", step + 1);
    }
    let heights = moments
        .iter()
        .map(|moment| [PLOT[0] + along(moment.at_s)[0], PLOT[1] - SCALE[1] * moment.place_m.z]);
    let mut seconds = String::new();
    for at_s in (0..).step_by(5).map(f64::from).take_while(|at_s| *at_s <= end_s) {
        let x = PLOT[0] + along(at_s)[0];
        _ = write!(seconds, "<text x=\"{x:.1}\" y=\"{}\">{at_s} s</text>", PLOT[1] + 16.0);
    }
    let at = |[x, y]: [f64; 2]| format!("{x:.1} {y:.1}");
    let filled = [
        ("{style}", format!("{style}\n{cursor}")),
        ("{all}", format!("{all_s:.2}s")),
        ("{ago}", format!("-{:.2}s", moments[still].at_s)),
        ("{words}", words),
        ("{line}", at(at_line(&moments[still]))),
        ("{planned}", planned),
        ("{marks}", marks),
        ("{way}", line(places.iter().copied())),
        ("{left}", format!("{:.1}", left[still])),
        ("{drone}", at(places[still])),
        ("{shadow}", at(shadow(&moments[still]))),
        ("{heights}", line(heights)),
        ("{cursor}", at(along(moments[still].at_s))),
        ("{seconds}", seconds),
    ];
    filled.iter().fold(FRAME.to_owned(), |drawing, (name, value)| drawing.replace(name, value))
}
