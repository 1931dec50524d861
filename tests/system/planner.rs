//! The plan editor and the map of the page: a real Chromium, the program, the mock drone.

use serde_json::json;

use crate::chromium::{Chromium, Tab};
use crate::station::Station;

/// The program at rest, with settings of its own.
fn station() -> Station {
    let arguments = ["--mock", "--ui", "0", "--plans", ".", "--config", "pilot.toml"];
    Station::start(&arguments, &[("pilot.toml", SETTINGS)])
}

/// A page whose plan editor is complete.
fn planner(chromium: &mut Chromium, station: &Station) -> Tab {
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "view === 'plan' && document.querySelectorAll('#plans option').length > 2");
    chromium.wait(&tab, "!document.querySelector('#simulate').disabled");
    tab
}

fn number(chromium: &mut Chromium, tab: &Tab, expression: &str) -> f64 {
    let value = chromium.evaluate(tab, expression);
    value.as_f64().unwrap_or_else(|| panic!("{expression}: {value}"))
}

/// The track begins where the take-off has ended, and the plan on the ground.
#[test]
fn plan_and_flight_are_at_the_same_place_of_the_heights() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = planner(&mut chromium, &station);
    chromium.type_into(&tab, "#plantext", "takeoff\ngoto 0 2 0 0\nland\n");
    chromium.wait(&tab, "plan.targets().length === 1");
    chromium.evaluate(&tab, "document.querySelector('#simulate').click()");
    chromium.wait(&tab, "plan.simulated()?.track?.length > 20");
    let apart_m = number(
        &mut chromium,
        &tab,
        "(() => {
           const [wanted, flown] = heights.unrolledWays();
           const there = plan.simulated().track.findIndex(([, , y]) => y > 1.9);
           return flown[there + 1][0] - wanted.at(-1)[0];
         })()",
    );
    assert!(apart_m.abs() < 0.4, "{apart_m}");
}

const CTRL: u32 = 2;
const SETTINGS: &str = "# Our hall.\n[fence]\nradius_m = 9.5 # to the wall\n";

/// One history for what is typed, clicked, dragged and opened; nothing of another plan is ever mixed in.
#[test]
fn everything_that_changes_a_plan_can_be_undone() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    std::fs::write(station.folder.path().join("other.txt"), "takeoff\nland\n").unwrap();
    let tab = planner(&mut chromium, &station);
    let text = |chromium: &mut Chromium| {
        chromium.evaluate(&tab, "plan.text()").as_str().unwrap().to_owned()
    };
    let mut states = vec![text(&mut chromium)];
    chromium.type_into(&tab, "#plantext", "takeoff\ngoto 0 1 0 0\nland\n");
    chromium.wait(&tab, "plan.targets().length === 1");
    states.push(text(&mut chromium));
    chromium.click(&tab, "#map", [60.0, -40.0]);
    chromium.wait(&tab, "plan.targets().length === 2");
    states.push(text(&mut chromium));
    chromium.drag(&tab, "#drafts g:nth-child(2)", [40.0, 0.0]);
    chromium.wait(&tab, &format!("plan.text() !== {}", json!(states[2])));
    states.push(text(&mut chromium));
    chromium.type_into(&tab, "#draftsteps li:nth-child(2) input:nth-of-type(3)", "0.3");
    chromium.wait(&tab, "plan.text().includes(' 0.3 ')");
    states.push(text(&mut chromium));
    chromium.choose(&tab, "#plans", "other.txt");
    chromium.click(&tab, "#askyes", [0.0; 2]);
    chromium.wait(&tab, "plan.text() === 'takeoff\\nland\\n'");
    states.push(text(&mut chromium));
    // Wherever the focus is, with keys and with buttons.
    chromium.evaluate(&tab, "document.querySelector('#plantext').focus()");
    for state in states.iter().rev().skip(1) {
        chromium.strike(&tab, "z", "KeyZ", CTRL);
        chromium.wait(&tab, &format!("plan.text() === {}", json!(state)));
    }
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#undo').disabled"), true);
    assert_eq!(chromium.evaluate(&tab, "plan.name()"), "example.txt");
    for state in &states[1..] {
        chromium.strike(&tab, "y", "KeyY", CTRL);
        chromium.wait(&tab, &format!("plan.text() === {}", json!(state)));
    }
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#redo').disabled"), true);
    assert_eq!(chromium.evaluate(&tab, "plan.name()"), "other.txt");
    chromium.click(&tab, "#undo", [0.0; 2]);
    chromium.wait(&tab, &format!("plan.text() === {}", json!(states[4])));
}

/// A plan at the limit is typed into without waiting, and a larger one is refused before it is read.
#[test]
fn large_plans_are_edited_and_larger_ones_refused() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = planner(&mut chromium, &station);
    // 32 kB less what is typed below. Each target has a place of its own.
    let line = |index: usize| {
        let (column, row) = (index % 40, index / 40 % 30);
        format!("goto -{:.2} -{:.2} -0.25 -180\n", column as f64 * 0.1, row as f64 * 0.1)
    };
    let lines = (32 * 1024 - 100) / line(0).len();
    let open = |lines| {
        let steps: String = (0..lines).map(line).collect();
        let text = json!(format!("takeoff\n{steps}land\n"));
        format!(
            "{{ const text = document.querySelector('#plantext'); text.value = {text}; text.oninput(); }}"
        )
    };
    chromium.evaluate(&tab, &open(lines));
    chromium.wait(&tab, "document.querySelector('#problems').childElementCount > 0");
    // Until the next picture, in milliseconds.
    let stroke = "new Promise((done) => { const begun = performance.now(); \
        const text = document.querySelector('#plantext'); text.setRangeText('# a\\n', 8, 8); text.oninput(); \
        requestAnimationFrame(() => setTimeout(() => done(performance.now() - begun))); })";
    let typing = |chromium: &mut Chromium| {
        let mut times: Vec<f64> =
            (0..9).map(|_| chromium.settle(&tab, stroke).as_f64().unwrap()).collect();
        times.sort_by(f64::total_cmp);
        times[4]
    };
    let many = typing(&mut chromium);
    let shown = "document.querySelector('#draftsteps').childElementCount";
    assert_eq!(chromium.evaluate(&tab, shown), lines + 2, "it is the large plan");
    // Only the row of a new line is made.
    let made = "{ const rows = document.querySelector('#draftsteps').children; for (const row of rows) row.kept = true; \
        const text = document.querySelector('#plantext'); text.setRangeText('goto 1 1 0 0\\n', 8, 8); text.oninput(); \
        [...rows].filter((row) => !row.kept).length }";
    assert_eq!(chromium.evaluate(&tab, made), 1);
    chromium.evaluate(&tab, &open(10));
    let few = typing(&mut chromium);
    println!("a key stroke in {lines} lines takes {many:.0} ms, in 10 lines {few:.0} ms");
    // However busy the machine is. Each line made anew would be a hundred times as long.
    assert!(many < 100.0 || many < 25.0 * few, "{many}, {few}");
    chromium.evaluate(&tab, &open(2 * lines));
    chromium
        .wait(&tab, "document.querySelector('#plananswer').textContent.includes('at most 32 kB')");
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#load').disabled"), true);
    // What is pasted is looked at first.
    let before = chromium.evaluate(&tab, "plan.text().length");
    chromium.evaluate(&tab, "document.querySelector('#plantext').select(); true");
    chromium.insert(&tab, "#plantext", &"goto 0 1 0 0\n".repeat(100_000));
    chromium.wait(
        &tab,
        "document.querySelector('#plananswer').textContent.startsWith('what was pasted has 1270 kB')",
    );
    assert_eq!(chromium.evaluate(&tab, "plan.text().length"), before);
    // A file is not even read.
    let before = chromium.evaluate(&tab, "plan.text().length");
    let upload = "{ const files = new DataTransfer(); \
        files.items.add(new File(['goto 0 1 0 0\\n'.repeat(100000)], 'big.txt')); \
        const field = document.querySelector('#upload'); field.files = files.files; \
        const begun = performance.now(); field.onchange(); performance.now() - begun; }";
    assert!(number(&mut chromium, &tab, upload) < 500.0);
    chromium.wait(
        &tab,
        "document.querySelector('#plananswer').textContent.startsWith('big.txt has 1270 kB')",
    );
    assert_eq!(chromium.evaluate(&tab, "plan.text().length"), before);
}

/// Whole numbers are seen, and a target has one number everywhere.
#[test]
fn numbers_are_not_cut_and_count_the_same_everywhere() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = planner(&mut chromium, &station);
    for width in [390, 1400] {
        chromium.look(&tab, [width, 860], "light");
        chromium.type_into(
            &tab,
            "#plantext",
            "takeoff\nsetStayTime 1\ngoto -1.5 -0.55 -0.25 -180\nland\n",
        );
        chromium.wait(&tab, "document.querySelectorAll('#draftsteps input').length === 5");
        let cut = "[...document.querySelectorAll('#draftsteps input')] \
            .filter((field) => field.scrollWidth > field.clientWidth).map((field) => field.value).join()";
        assert_eq!(chromium.evaluate(&tab, cut), "", "{width}");
    }
    chromium.wait(&tab, "!document.querySelector('#load').disabled");
    // Of `goto`: in the list, on the map, and as the step that is flown.
    let listed = "[...document.querySelectorAll('#draftsteps li')].find((item) => item.textContent.includes('goto')) \
        .querySelector('i').textContent";
    chromium.wait(&tab, &format!("{listed} !== ''"));
    let listed = chromium.evaluate(&tab, listed);
    let same = format!("document.querySelector('#drafts text')?.textContent === {listed}");
    chromium.wait(&tab, &same);
    chromium.click(&tab, "#load", [0.0; 2]);
    chromium
        .wait(&tab, "view === 'fly' && document.querySelectorAll('#targets text').length === 1");
    chromium.wait(&tab, &same.replace("#drafts", "#targets"));
    let step = "[...document.querySelectorAll('#steps li')].find((item) => item.textContent.includes('goto')).textContent";
    let step = chromium.evaluate(&tab, step);
    assert!(step.as_str().unwrap().starts_with(listed.as_str().unwrap()), "{step}, {listed}");
}

/// What is pointed at stays under the pointer, whatever is done with the map, and the fence is seen or pointed to.
#[test]
fn the_map_is_moved_and_keeps_what_is_pointed_at() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = planner(&mut chromium, &station);
    // The middle of the map is at `[x, y]`, and a pixel has `m`.
    let seen = |chromium: &mut Chromium| {
        let seen = "{ const { x, y, width, height } = document.querySelector('#map').getBoundingClientRect(); \
            const at = (clientX, clientY) => map.place({ clientX, clientY }); \
            const [middle, right] = [at(x + width / 2, y + height / 2), at(x + width / 2 + 100, y + height / 2)]; \
            [middle.x, middle.y, (right.x - middle.x) / 100] }";
        let seen = chromium.evaluate(&tab, seen);
        [0, 1, 2].map(|index| seen[index].as_f64().unwrap())
    };
    let near = |one: [f64; 2], other: [f64; 2]| (one[0] - other[0]).hypot(one[1] - other[1]) < 0.03;
    // A target that is placed stays where it was clicked.
    std::thread::sleep(std::time::Duration::from_secs(1));
    let before = seen(&mut chromium);
    chromium.click(&tab, "#map", [150.0, -120.0]);
    let clicked = [before[0] + 150.0 * before[2], before[1] + 120.0 * before[2]];
    chromium.wait(&tab, "plan.targets().length === 5");
    std::thread::sleep(std::time::Duration::from_secs(1));
    let after = seen(&mut chromium);
    assert!(near([after[0], after[1]], [before[0], before[1]]), "{before:?}, {after:?}");
    let placed =
        ["x", "y"].map(|axis| number(&mut chromium, &tab, &format!("plan.targets()[4].{axis}")));
    assert!(near(placed, clicked), "{placed:?}, {clicked:?}");
    // The wheel zooms about the pointer.
    chromium.wheel(&tab, "#map", [150.0, -120.0], -400.0);
    std::thread::sleep(std::time::Duration::from_millis(500));
    let zoomed = seen(&mut chromium);
    assert!(zoomed[2] < 0.7 * after[2], "{after:?}, {zoomed:?}");
    let pointed = [zoomed[0] + 150.0 * zoomed[2], zoomed[1] + 120.0 * zoomed[2]];
    assert!(near(pointed, clicked), "{pointed:?}, {clicked:?}");
    // A drag moves the map, and adds no target.
    chromium.drag(&tab, "#map", [80.0, 50.0]);
    std::thread::sleep(std::time::Duration::from_millis(500));
    let dragged = seen(&mut chromium);
    let moved = [dragged[0] - zoomed[0], dragged[1] - zoomed[1]];
    let wanted = [-80.0 * zoomed[2], 50.0 * zoomed[2]];
    assert!(near(moved, wanted), "{moved:?}, {wanted:?}");
    assert_eq!(chromium.evaluate(&tab, "plan.targets().length"), 5);
    // The fence is far away, and an arrow says where; from farther off it is seen.
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#fencearrow').hidden"), false);
    for _ in 0..8 {
        chromium.click(&tab, "#farther", [0.0; 2]);
    }
    chromium.wait(&tab, "document.querySelector('#fencearrow').hidden");
    // Everything again.
    chromium.click(&tab, "#all", [0.0; 2]);
    std::thread::sleep(std::time::Duration::from_secs(1));
    assert!(seen(&mut chromium)[2] < 0.1);
    // Solid, with something drawn in it.
    chromium.click(&tab, "#solid", [0.0; 2]);
    chromium.wait(
        &tab,
        "{ const view = document.querySelector('#solidview'); const pixels = view.getContext('2d') \
         .getImageData(0, 0, view.width, view.height).data; pixels.filter((part, index) => index % 4 === 3 && part).length > 2000 }",
    );
}

/// Two fingers move and zoom the map: the place between them stays there, and the scale changes as their distance.
#[test]
fn two_fingers_zoom_about_what_is_between_them() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = planner(&mut chromium, &station);
    std::thread::sleep(std::time::Duration::from_secs(1));
    let middle = chromium.middle(&tab, "#map");
    // What is at a place of the window, and metres a pixel there.
    let seen = |chromium: &mut Chromium, [x, y]: [f64; 2]| {
        let seen = format!(
            "{{ const at = (clientX) => map.place({{ clientX, clientY: {y} }}); \
             const [here, right] = [at({x}), at({x} + 100)]; [here.x, here.y, (right.x - here.x) / 100] }}"
        );
        let seen = chromium.evaluate(&tab, &seen);
        [0, 1, 2].map(|index| seen[index].as_f64().unwrap())
    };
    let before = seen(&mut chromium, [middle[0] - 60.0, middle[1] - 40.0]);
    // Both move, by different ways: apart from 100 to 250 pixels, and their middle by 90 and 70.
    let fingers = |part: f64| {
        let (x, y) = (middle[0] - 60.0 + 90.0 * part, middle[1] - 40.0 + 70.0 * part);
        let half = 50.0 + 75.0 * part;
        [[x - 0.6 * half, y - 0.8 * half], [x + 0.6 * half, y + 0.8 * half]]
    };
    // One of them begins on a target, which stays where it is.
    let [on_target, _] = fingers(0.0);
    let on_target = format!(
        "!!document.elementFromPoint({}, {}).closest('#drafts .free')",
        on_target[0], on_target[1]
    );
    assert_eq!(chromium.evaluate(&tab, &on_target), true);
    let text = chromium.evaluate(&tab, "plan.text()");
    chromium.touch(&tab, "touchStart", &fingers(0.0));
    for step in 1..=10 {
        chromium.touch(&tab, "touchMove", &fingers(f64::from(step) / 10.0));
    }
    chromium.touch(&tab, "touchEnd", &[]);
    std::thread::sleep(std::time::Duration::from_millis(500));
    let after = seen(&mut chromium, [middle[0] + 30.0, middle[1] + 30.0]);
    // A tremor of four pixels begins no gesture.
    let off = (after[0] - before[0]).hypot(after[1] - before[1]) / after[2];
    assert!(
        off < 5.0,
        "the place between the fingers is {off:.1} pixels away: {before:?}, {after:?}"
    );
    let zoom = before[2] / after[2];
    assert!((zoom - 2.5).abs() < 0.1, "{zoom}");
    assert_eq!(chromium.evaluate(&tab, "plan.text()"), text);
}

/// Sixty steps and ten minutes of flown way are drawn at thirty pictures a second, on the map and in three dimensions.
#[test]
#[ignore = "measures"]
fn pictures_of_a_long_flight() {
    let mut chromium = Chromium::start().expect("chromium");
    let station = station();
    let tab = planner(&mut chromium, &station);
    let steps = (0..60).map(|step| format!("goto {} {} 0.{} 0", step % 7, step % 5, step % 9));
    let steps = steps.collect::<Vec<_>>().join("\n");
    chromium.type_into(&tab, "#plantext", &format!("takeoff\n{steps}\nland\n"));
    chromium
        .wait(&tab, "plan.targets().length === 60 && !document.querySelector('#load').disabled");
    chromium.click(&tab, "#load", [0.0; 2]);
    chromium.wait(&tab, "view === 'fly' && flight.steps.length === 62");
    let way = "trail = [...Array(2000).keys()].map((at) => [3 * Math.sin(at / 40), 3 * Math.cos(at / 37), 1 + Math.sin(at / 11) / 2]); true";
    chromium.evaluate(&tab, way);
    let rate = "new Promise((done) => { let count = 0; const begun = performance.now(); const next = () => { \
        trail.push([Math.random(), 0, 1]); trail.shift(); count += 1; \
        if (performance.now() - begun < 5000) requestAnimationFrame(next); else done(count / 5); }; next(); })";
    let flat = chromium.settle(&tab, rate);
    chromium.click(&tab, "#solid", [0.0; 2]);
    let solid = chromium.settle(&tab, rate);
    println!("{flat} pictures a second on the map, {solid} in three dimensions");
    assert!(flat.as_f64() > Some(30.0) && solid.as_f64() > Some(30.0), "{flat}, {solid}");
}

/// Settings with what they are for; a change is checked, written beside what the file says already, and in effect later.
#[test]
fn settings_are_seen_and_changed() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = planner(&mut chromium, &station);
    chromium.click(&tab, "[data-show=settings]", [0.0; 2]);
    chromium.wait(&tab, "document.querySelectorAll('#settings label').length > 40");
    let field = |name: &str| {
        format!(
            "[...document.querySelectorAll('#settings label')].find((it) => it.querySelector('b').textContent === '{name}')"
        )
    };
    let radius = chromium.evaluate(&tab, &format!("{}.textContent", field("radius_m")));
    let radius = radius.as_str().unwrap();
    assert!(radius.contains("0.5 to 200.") && radius.contains("Default 10"), "{radius}");
    let set = |chromium: &mut Chromium, name: &str, value: &str| {
        let set = format!(
            "{{ const input = {}.querySelector('input, select'); input.value = '{value}'; input.oninput(); }}",
            field(name)
        );
        chromium.evaluate(&tab, &set);
        chromium.click(&tab, "#savesettings", [0.0; 2]);
    };
    let file = || station.file("pilot.toml");
    set(&mut chromium, "radius_m", "0.1");
    chromium.wait(
        &tab,
        "document.querySelector('#settingsnote').textContent.includes('it must lie in 0.5 to 200')",
    );
    assert_eq!(file(), SETTINGS);
    set(&mut chromium, "radius_m", "");
    chromium.wait(
        &tab,
        "document.querySelector('#settingsnote').textContent.includes('radius_m is no number')",
    );
    assert_eq!(file(), SETTINGS);
    set(&mut chromium, "radius_m", "4");
    chromium.wait(
        &tab,
        "document.querySelector('#settingsnote').textContent.startsWith('Saved. 1 of them')",
    );
    assert_eq!(file(), SETTINGS.replace("9.5", "4"));
    set(&mut chromium, "gps", "true");
    chromium.wait(
        &tab,
        "document.querySelector('#settingsnote').textContent.startsWith('Saved. 2 of them')",
    );
    assert_eq!(file(), format!("{}\n[drone]\ngps = true\n", SETTINGS.replace("9.5", "4")));
    // The fence of this run is what it was.
    assert!(
        number(&mut chromium, &tab, "Math.max(...flight.fence.outline_m.map(([x]) => x))") > 9.0
    );
    chromium.type_into(&tab, "#ofsettings", "ultrasound");
    chromium
        .wait(&tab, "[...document.querySelectorAll('#settings label')].some((it) => it.hidden)");
    // A gamepad: which axis moves what is kept.
    let pad = "navigator.getGamepads = () => [{ id: 'pad', axes: [0.1, 0, 0, -0.5, 0, 0], \
        buttons: [...Array(8)].map(() => ({ pressed: true })) }]; true";
    chromium.evaluate(&tab, pad);
    chromium
        .wait(&tab, "document.querySelector('#padaxes label:nth-child(4) meter').value === -0.5");
    chromium
        .wait(&tab, "document.querySelectorAll('#padaxes label:nth-child(1) option').length === 6");
    chromium.evaluate(&tab, "{ const choice = document.querySelector('#padaxes label:nth-child(4) select'); choice.value = 5; choice.oninput(); }");
    chromium.wait(&tab, "document.querySelector('#padaxes label:nth-child(4) meter').value === 0");
    chromium.reload(&tab);
    chromium
        .wait(&tab, "JSON.parse(localStorage.getItem('ardrone-pilot gamepad')).back.axis === 5");
}
