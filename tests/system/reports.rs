//! Reports: what they show of a flight, and whether the cause of a fault can be named from them.

use std::path::Path;
use std::time::Duration;

use ardrone_pilot::recording::{Entry, Log};
use ardrone_pilot::report::{self, Reports};
use autopilot::vehicle::{NavdataRate, OperatorOrder, VehicleConfig};
use mock_drone::WorldConfig;
use mock_drone::scenario::Scenario;
use serde_json::Value;
use system_tests::SQUARE;
use system_tests::sim::Simulation;

use crate::chromium::{Chromium, Tab};
use crate::recording::recorded;

/// A round with turns and heights, long enough for a fault to show.
const ROUND: &str = "takeoff\nsetStayTime 2\ngoto 0 2 0 0\ngoto 2 2 0 90\ngoto 2 0 0.3 0\n\
    goto 0 0 0 0\ngoto 0 2 0 0\nland\n";

fn log(plan: &str, scenario: &str) -> Log {
    let scenario = Scenario::parse("faults", scenario).unwrap();
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    let pilot = VehicleConfig { navdata: NavdataRate::Full, ..VehicleConfig::default() };
    let (_, file) = recorded(plan, &Simulation { world, pilot, ..Simulation::default() });
    Log::read(&file).unwrap()
}

/// What the page's script draws.
fn drawn(page: &str) -> Value {
    let (_, data) = page.split_once("id=\"decided\">").unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

/// What the page says of the cause.
fn led_to(page: &str) -> &str {
    page.split_once("<ol id=\"findings\">").unwrap().1.split_once("</ol>").unwrap().0
}

/// Smallest and largest value of a line.
fn range(drawn: &Value, plot: &str, line: &str) -> (f64, f64) {
    let named = |list: &Value, key: &str, name: &str| {
        let found = list
            .as_array()
            .unwrap()
            .iter()
            .find(|one| one[key].as_str().is_some_and(|title| title.starts_with(name)));
        found.unwrap_or_else(|| panic!("no {name}")).clone()
    };
    let plot = named(&drawn["series"]["plots"], "title", plot);
    let line = named(&plot["lines"], "name", line);
    let values: Vec<f64> =
        line["values"].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    assert!(values.len() > 100, "{line}");
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(*value), high.max(*value))
    })
}

#[test]
fn a_report_has_the_numbers_behind_its_verdict() {
    let page = report::html(&log(SQUARE, "+4 wind 2 0\n"), &[]).unwrap();
    let drawn = drawn(&page);
    let (_, forward_m_s) = range(&drawn, "Velocity", "forward");
    let (_, measured_m_s) = range(&drawn, "Velocity", "forward in navdata");
    assert!(forward_m_s > 0.5 && (forward_m_s - measured_m_s).abs() < 0.4, "{forward_m_s}");
    let (_, tilt_deg) = range(&drawn, "Tilt", "forward");
    let (_, ordered_deg) = range(&drawn, "Tilt", "ordered forward");
    assert!((3.0..25.0).contains(&tilt_deg) && (tilt_deg - ordered_deg).abs() < 5.0, "{tilt_deg}");
    assert!(range(&drawn, "Wind", "wind").1 > 20.0);
    let (_, age_ms) = range(&drawn, "Navdata", "newest");
    assert!((1.0..200.0).contains(&age_ms), "{age_ms}");
    let (low_v, high_v) = range(&drawn, "Battery (V)", "voltage");
    assert!(9.0 < low_v && low_v < high_v && high_v < 13.0, "{low_v} {high_v}");
    assert!(range(&drawn, "Battery (%)", "charge").1 > 80.0);
    // It blows to the right, and the fence of the settings is there.
    assert!(range(&drawn, "Wind", "to the right").1 > 20.0);
    let towards_right = drawn["series"]["wind"][0].as_array().unwrap();
    let most_m_s2 = towards_right.iter().filter_map(Value::as_f64).fold(0.0, f64::max);
    assert!((0.3..5.0).contains(&most_m_s2), "{most_m_s2}");
    assert_eq!(drawn["fence"]["text"], "10 m around the start");
    let corners = drawn["fence"]["corners"].as_array().unwrap();
    let away_m = |corner: &Value| corner[0].as_f64().unwrap().hypot(corner[1].as_f64().unwrap());
    assert!(corners.len() > 8 && corners.iter().all(|corner| (away_m(corner) - 10.0).abs() < 0.1));
    let beliefs = drawn["beliefs"].as_array().unwrap();
    let names: Vec<&str> = beliefs.iter().map(|strip| strip["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["velocity", "altitude", "heading", "attitude"]);
}

/// Whatever changed is an event: a hover that the agent orders and nobody is told of, too.
#[test]
fn all_events_are_on_the_time_axis() {
    let orders = vec![
        (Duration::from_secs(7), OperatorOrder::Hold),
        (Duration::from_secs(9), OperatorOrder::Resume),
    ];
    let scenario = Scenario::parse("faults", "12 stuck velocity-forward for 30\n").unwrap();
    let world = WorldConfig { scenario, ..WorldConfig::default() };
    let (_, file) = recorded(SQUARE, &Simulation { world, orders, ..Simulation::default() });
    let page = report::html(&Log::read(&file).unwrap(), &[]).unwrap();
    let events = drawn(&page)["events"].as_array().unwrap().clone();
    let has = |kind: &str, text: &str, near_s: f64| {
        let found = events.iter().any(|event| {
            event["kind"] == kind
                && event["text"].as_str().unwrap().contains(text)
                && (event["at_s"].as_f64().unwrap() - near_s).abs() < 0.2
        });
        assert!(found, "{kind} {text} at {near_s} s: {events:?}");
    };
    has("order", "hold", 7.0);
    has("event", "holding", 7.0);
    has("order", "resume", 9.0);
    // What is not believed, and the hover that it leads to, of which nobody is told.
    let at_s = |text: &str| {
        let event = events.iter().find(|event| event["text"].as_str().unwrap().starts_with(text));
        event.unwrap_or_else(|| panic!("{text}: {events:?}"))["at_s"].as_f64().unwrap()
    };
    let (frozen_s, hover_s) = (at_s("velocity: frozen"), at_s("hover (line "));
    assert!(12.0 < frozen_s && frozen_s <= hover_s && hover_s < at_s("landing: the velocity"));
    let landing = events.iter().find(|event| event["text"] == "control state: landing");
    assert!(landing.is_some_and(|event| event["kind"] == "drone"));
}

/// Two flights of a run are two pages, each with its own events and numbers.
#[test]
fn each_flight_of_a_run_has_its_page() {
    let mut log = log(SQUARE, "");
    let length = log.ticks().last().unwrap().0 + Duration::from_mins(1);
    let again: Vec<(Duration, Entry)> =
        log.entries.iter().map(|(at, entry)| (*at + length, entry.clone())).collect();
    let single = Reports::new(&log, &[]);
    assert_eq!(single.count(), 1);
    let alone = drawn(&single.html(0, |_| String::new()).unwrap());
    log.entries.extend(again);
    let reports = Reports::new(&log, &[]);
    assert_eq!(reports.count(), 2);
    let pages = [0, 1].map(|index| reports.html(index, |other| format!("{other}.html")).unwrap());
    assert!(pages[0].contains("<b>flight 1 of 2</b><a href=\"1.html\">flight 2</a>"));
    let [first, second] = [0, 1].map(|index| drawn(&pages[index]));
    let value = |page: &Value, key: &str| page[key].as_f64().unwrap();
    assert!((value(&first, "end") - value(&alone, "end")).abs() < 0.1);
    assert!(value(&second, "begin") >= length.as_secs_f64());
    let count = |page: &Value| page["events"].as_array().unwrap().len();
    assert_eq!((count(&first), count(&second)), (count(&alone), count(&alone)));
    let in_the_air = |page: &str| {
        let (before, _) = page.split_once("</b>in the air").unwrap();
        before.rsplit_once("<b>").unwrap().1.to_owned()
    };
    assert_eq!(in_the_air(&pages[0]), in_the_air(&pages[1]));
    assert!(reports.html(2, |_| String::new()).is_err());
}

/// A flight that ends in the air is one, and it has not landed.
#[test]
fn a_flight_that_ends_before_the_drone_is_down_is_one_flight() {
    let emergency = log(SQUARE, "+8 propeller\n");
    assert!(emergency.outcome().is_some_and(|(_, text)| text.contains("emergency")));
    // A drone that is not heard has its outcome before it is down, and one with an emergency had in recordings of before.
    let mut lost = log(SQUARE, "");
    let (down, (_, outcome)) = {
        let is_outcome = |(_, entry): &(Duration, Entry)| matches!(entry, Entry::Outcome { .. });
        let index = lost.entries.iter().position(is_outcome).unwrap();
        (lost.entries[index].0, lost.entries.remove(index))
    };
    let middle = down.checked_sub(Duration::from_secs(4)).unwrap();
    let index = lost.entries.partition_point(|(at, _)| *at < middle);
    lost.entries.insert(index, (middle, outcome));
    for (_, entry) in &mut lost.entries[index..] {
        if let Entry::Tick(tick) = entry
            && tick.phase == "flying"
        {
            (tick.phase, tick.step) = ("landing".to_owned(), None);
        }
    }
    for log in [&emergency, &lost] {
        let reports = Reports::new(log, &[]);
        assert_eq!(reports.count(), 1);
        let page = reports.html(0, |_| String::new()).unwrap();
        let last = log.ticks().last().unwrap().0;
        assert_eq!(
            drawn(&page)["end"].as_f64(),
            Some(last.as_secs_f64()),
            "the way down is its own"
        );
    }
    let page = drawn(&report::html(&emergency, &[]).unwrap());
    let texts = |list: &str, text: &str| -> Vec<String> {
        let list = page[list].as_array().unwrap();
        list.iter().map(|one| one[text].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(texts("bands", "label").last().unwrap(), "emergency");
    assert!(!texts("bands", "label").contains(&"landing".to_owned()), "nothing was landed");
    assert!(!texts("events", "text").contains(&"landed".to_owned()), "it fell");
}

/// Ten faults, and what the report says of each: its cause, not its consequence.
#[test]
fn the_cause_of_a_fault_is_named() {
    let faults = [
        ("+6 stuck velocity-forward for 30", &["the velocity in navdata did not change"][..]),
        ("+6 lie altitude 0.8 for 30", &["the altitude in navdata jumped by +0.8"]),
        ("+6 ramp yaw 30 for 30", &["the heading in navdata"]),
        ("+7 outage down 2.5", &["no navdata arrived for up to 2."]),
        ("+6 wind 5 3 gusts 2", &["wind, or a push like it from ", "left: up to "]),
        ("+8 motor 70 over 1", &["it sank", "too little thrust"]),
        ("+8 sag 60", &["the charge fell from"]),
        ("+9 restart", &["has restarted"]),
        ("+7 outage up 2.5", &["the drone reports: it hears no commands, for up to 2."]),
        ("+6 nan roll for 30", &["the attitude in navdata", "no number ° to the right"]),
        ("+6 state motors-problem for 3", &["the drone reports: a motor is broken"]),
        ("+6 loss down 40", &["packets of navdata were lost: up to"]),
    ];
    let mut unnamed = Vec::new();
    for (fault, named) in faults {
        let page = report::html(&log(ROUND, &format!("{fault}\n")), &[]).unwrap();
        if !named.iter().all(|part| led_to(&page).contains(part)) {
            unnamed.push(format!("{fault}: {}", led_to(&page)));
        }
    }
    // Of a healthy flight there is nothing to tell.
    let healthy = report::html(&log(ROUND, ""), &[]).unwrap();
    if !led_to(&healthy).trim().is_empty() {
        unnamed.push(format!("healthy: {}", led_to(&healthy)));
    }
    assert!(unnamed.is_empty(), "{}", unnamed.join("\n"));
}

/// The page is opened as a file.
fn open(chromium: &mut Chromium, folder: &Path, page: &str) -> Tab {
    let file = folder.join("report.html");
    std::fs::write(&file, page).unwrap();
    let tab = chromium.open(&format!("file://{}", file.display()));
    chromium.wait(&tab, "document.querySelectorAll('#all .plot path.line').length > 20");
    tab
}

#[test]
fn a_report_is_zoomed_moved_and_read_at_the_cursor() {
    let Some(mut chromium) = Chromium::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let page = report::html(&log(ROUND, "+6 stuck velocity-forward for 30\n"), &[]).unwrap();
    let tab = open(&mut chromium, folder.path(), &page);
    chromium.look(&tab, [1400, 900], "light");
    // It opens where something went wrong, and a finding leads there.
    chromium.wait(
        &tab,
        "Math.abs(marked - document.querySelector('#findings button').dataset.at) < 0.01",
    );
    let height = "[...document.querySelectorAll('#all h3')].find((title) => title.textContent.startsWith('Height'))\
        .nextElementSibling.querySelector('b').textContent";
    chromium.evaluate(&tab, "show(begin)");
    chromium.evaluate(&tab, "window.before = document.querySelector('#map .drone')?.getAttribute('transform') ?? ''; true");
    // The mouse moves the cursor: values and the place on the map follow.
    chromium.evaluate(&tab, "show(begin + 0.6 * (end - begin))");
    chromium.wait(&tab, &format!("Number({height}) > 0.3 && {height} === series.plots[1].lines[0].values[indexAt(times, marked)].toFixed(2)"));
    chromium.wait(
        &tab,
        "document.querySelector('#map .drone').getAttribute('transform') !== window.before",
    );
    chromium.wait(&tab, "document.querySelector('#map .flown').getAttribute('d').length > 100");
    chromium.wait(&tab, "document.querySelector('#map .flown').getAttribute('d').length < document.querySelector('#map .way').getAttribute('d').length");
    // The map has the fence, which is too large for this one, and the wind.
    chromium.wait(&tab, "document.querySelector('#map .fence').getAttribute('d').length > 100");
    chromium.wait(&tab, "document.querySelector('#map .fencetext').textContent === 'dashed: the fence, 10 m around the start, beyond this map'");
    chromium.evaluate(&tab, "fence.corners.forEach((corner) => { corner[0] *= 0.3; corner[1] *= 0.3; }); drawMap(); true");
    chromium.wait(&tab, "document.querySelector('#map .fencetext').textContent === 'dashed: the fence, 10 m around the start'");
    chromium.wait(&tab, "Math.abs(document.querySelector('#map .fence').getBBox().width - 6 / scale.metres) < 1 && 6 / scale.metres < map.clientWidth");
    chromium
        .evaluate(&tab, "series.wind[0].fill(-1.25); series.wind[1].fill(0.1); show(marked); true");
    chromium.wait(
        &tab,
        "document.querySelector('#map .wind text').textContent === 'wind from the right, 1.3 m/s²'",
    );
    // All plots are zoomed and moved together, by the buttons, the wheel, the keyboard and a drag.
    let axes = "new Set([...document.querySelectorAll('#all .plot svg')].map((plot) => \
        [...plot.querySelectorAll('text')].filter((text) => / s$/.test(text.textContent)).map((text) => text.textContent).join())).size === 1";
    chromium.wait(&tab, axes);
    chromium.click(&tab, "#in", [0.0; 2]);
    chromium.wait(&tab, "Math.abs((shown[1] - shown[0]) / (end - begin) - 0.5) < 0.01 && shown[0] < marked && marked < shown[1]");
    chromium.wait(&tab, axes);
    chromium.evaluate(&tab, "window.was = [...shown]; document.querySelector('#all .plot').dispatchEvent(new WheelEvent('wheel', \
        { deltaY: -100, ctrlKey: true, clientX: 400, cancelable: true })); true");
    chromium.wait(&tab, "shown[1] - shown[0] < 0.9 * (was[1] - was[0])");
    chromium.evaluate(&tab, "document.querySelector('#all .plot').scrollIntoView({ block: 'center' }); window.was = [...shown]; true");
    chromium.drag(&tab, "#all .plot", [120.0, 0.0]);
    chromium.wait(
        &tab,
        "shown[0] < was[0] - 0.1 && Math.abs(shown[1] - shown[0] - (was[1] - was[0])) < 1e-6",
    );
    chromium.evaluate(&tab, "document.querySelector('#all .plot').focus(); true");
    chromium.key(&tab, "keyDown", "End");
    chromium.wait(&tab, "marked === end && shown[1] === end");
    chromium.click(&tab, "#whole", [0.0; 2]);
    chromium.wait(&tab, "shown[0] === begin && shown[1] === end");
    chromium.evaluate(&tab, "document.querySelector('#events tr:nth-child(8)').click(); true");
    chromium.wait(
        &tab,
        "Math.abs(marked - document.querySelector('#events tr:nth-child(8)').dataset.at) < 0.01",
    );
    chromium.wait(&tab, "document.querySelector('#moment li') !== null");
}

/// Nothing is wider than a telephone, and the whole page is no larger than a page should be.
#[test]
fn a_report_fits_telephones_and_large_screens() {
    let Some(mut chromium) = Chromium::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let page = report::html(&log(ROUND, "+6 stuck velocity-forward for 30\n"), &[]).unwrap();
    let tab = open(&mut chromium, folder.path(), &page);
    let pictures = std::env::var_os("PAGE_PICTURES");
    for (width, height) in [(390, 844), (820, 1180), (1400, 1000), (1920, 1080)] {
        for scheme in ["light", "dark"] {
            chromium.look(&tab, [width, height], scheme);
            chromium.wait(&tab, "document.querySelectorAll('#all .plot path.line').length > 20");
            let wide = chromium.evaluate(&tab, "document.documentElement.scrollWidth");
            assert!(wide.as_f64().unwrap() <= f64::from(width), "{wide} wide at {width}");
            let least = "Math.min(...[...document.querySelectorAll('#all .plot')].map((plot) => plot.clientWidth))";
            let plot = chromium.evaluate(&tab, least).as_f64().unwrap();
            assert!(plot > 0.6 * f64::from(width.min(1300)), "a plot is {plot} wide at {width}");
            if let Some(folder) = &pictures {
                std::thread::sleep(Duration::from_millis(300));
                let file = Path::new(folder).join(format!("report-{width}-{scheme}.png"));
                chromium.screenshot(&tab, &file);
            }
        }
    }
}

/// `cargo test -p system-tests --test system -- --ignored the_picture_of_the_report`
#[test]
#[ignore = "writes docs/report.png"]
fn the_picture_of_the_report() {
    let mut chromium = Chromium::start().expect("chromium");
    let folder = tempfile::tempdir().unwrap();
    let page = report::html(&log(ROUND, "+6 stuck velocity-forward for 30\n"), &[]).unwrap();
    let tab = open(&mut chromium, folder.path(), &page);
    chromium.look(&tab, [1400, 1150], "light");
    std::thread::sleep(Duration::from_secs(1));
    chromium.screenshot(&tab, Path::new("../docs/report.png"));
}
