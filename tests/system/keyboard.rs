//! The page by keyboard alone: a real Chromium, the program, the mock drone, and key events.

use serde_json::json;

use crate::chromium::{Chromium, LANDS, Tab};
use crate::station::Station;

const CTRL: u32 = 2;
const SHIFT: u32 = 8;

/// The program at rest, with plans and settings of its own.
fn station() -> Station {
    let arguments = ["--mock", "--ui", "0", "--plans", ".", "--config", "pilot.toml"];
    let first = ("first.txt", "takeoff\nland\n");
    let second = ("second.txt", "takeoff\ngoto 0 1 0 0\nland\n");
    Station::start(&arguments, &[first, second, ("pilot.toml", "[fence]\nradius_m = 9.5\n")])
}

/// Somebody at a keyboard.
struct Keyboard<'a> {
    chromium: &'a mut Chromium,
    tab: Tab,
}

impl Keyboard<'_> {
    fn key(&mut self, key: &str) {
        self.strike(key, 0);
    }

    fn strike(&mut self, key: &str, modifiers: u32) {
        self.chromium.wait_for_focus(&self.tab);
        self.chromium.type_key(&self.tab, key, modifiers);
    }

    /// Writes a text key by key.
    fn write(&mut self, text: &str) {
        for letter in text.chars() {
            self.key(if letter == '\n' { "Enter".to_owned() } else { letter.to_string() }.as_str());
        }
    }

    fn wait(&mut self, condition: &str) {
        self.chromium.wait(&self.tab, condition);
    }

    fn text(&mut self, expression: &str) -> String {
        let value = self.chromium.evaluate(&self.tab, expression);
        value.as_str().unwrap_or_else(|| panic!("{expression}: {value}")).to_owned()
    }

    /// Presses Tab (or Shift and Tab) until what has the focus, `it`, fulfils a condition. Wherever the focus stops, it is seen;
    /// in a report that is for the report to show.
    fn go(&mut self, modifiers: u32, condition: &str) {
        let stop = format!(
            "{{ const it = document.activeElement; const style = getComputedStyle(it); const box = it.getBoundingClientRect(); \
             ({{ name: it.id || it.ariaLabel || it.outerHTML.slice(0, 80), found: Boolean({condition}), \
             seen: it === document.body || it.id === 'report' || (style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2 \
             && box.width > 0 && box.right > 0 && box.left < innerWidth && box.bottom > 0 && box.top < innerHeight) }}) }}"
        );
        let mut stops = Vec::new();
        for _ in 0..150 {
            self.strike("Tab", modifiers);
            self.chromium.wait_for_focus(&self.tab);
            let now = self.chromium.evaluate(&self.tab, &stop);
            assert_eq!(now["seen"], true, "the focus is not seen: {now}");
            if now["found"] == true {
                return;
            }
            stops.push(now["name"].clone());
        }
        panic!("{condition} is never reached: {}", json!(stops));
    }

    fn to(&mut self, id: &str) {
        self.go(0, &format!("it.id === '{id}'"));
    }

    /// Presses the button with this name.
    fn press(&mut self, id: &str) {
        self.to(id);
        self.key("Enter");
    }

    /// Shows a view.
    fn view(&mut self, name: &str) {
        self.go(0, &format!("it.dataset.show === '{name}'"));
        self.key("Enter");
        self.wait(&format!("view === '{name}'"));
    }
}

/// From a plan to the playback of its flight, and what is set up around it, without a mouse.
#[test]
fn everything_can_be_done_by_keys() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = chromium.open(&station.url);
    let mut person = Keyboard { chromium: &mut chromium, tab };
    person.wait("view === 'plan' && document.querySelectorAll('#plans option').length > 4");
    person.wait("!document.querySelector('#simulate').disabled");
    a_plan_is_made(&mut person);
    assert_eq!(station.file("by keys.txt"), person.text("plan.text()"));
    it_is_flown(&mut person);
    it_is_looked_back_at(&mut person);
    // A setting, the sound, and the keys.
    person.view("settings");
    person.wait("document.querySelectorAll('#settings label').length > 40");
    person.go(0, "it.closest('#settings label')?.querySelector('b').textContent === 'radius_m'");
    person.write("4");
    person.go(SHIFT, "it.id === 'savesettings'");
    person.key("Enter");
    person.wait("document.querySelector('#settingsnote').textContent.startsWith('Saved.')");
    assert_eq!(station.file("pilot.toml"), "[fence]\nradius_m = 4\n");
    person.go(SHIFT, "it.id === 'mute'");
    // On the ground the space bar presses a button, too.
    person.key(" ");
    person.wait("document.querySelector('#mute').textContent === 'Sound off'");
    person.press("help");
    person.wait("document.querySelector('#keys').open");
    person.key("Escape");
    person.wait("!document.querySelector('#keys').open");
}

fn a_plan_is_made(person: &mut Keyboard<'_>) {
    // Arrows go through the names, and Enter opens one.
    person.to("plans");
    person.key("ArrowDown");
    person.key("ArrowDown");
    person.wait("document.querySelector('#plans').value === 'second.txt'");
    person.wait("document.querySelector('#plananswer').textContent === 'Enter opens second.txt.'");
    assert_eq!(person.text("plan.name()"), "example.txt");
    person.key("Enter");
    person
        .wait("plan.name() === 'second.txt' && plan.text() === 'takeoff\\ngoto 0 1 0 0\\nland\\n'");
    person.to("planname");
    person.write("by keys");
    // Written, undone, and done again.
    person.to("plantext");
    person.strike("a", CTRL);
    person.write("takeoff\ngoto 1 0 0 0\nland\n");
    person
        .wait("plan.targets().length === 1 && plan.text() === 'takeoff\\ngoto 1 0 0 0\\nland\\n'");
    // What was written in one go is one step of the history; on a busy machine there are pauses.
    for (letter, target) in [("z", "goto 0 1 0 0"), ("y", "goto 1 0 0 0")] {
        let wanted = format!("plan.text().includes('{target}')");
        while person.chromium.evaluate(&person.tab, &wanted) != true {
            let before = person.text("plan.text()");
            person.strike(letter, CTRL);
            assert_ne!(person.text("plan.text()"), before, "Ctrl-{letter} does nothing more");
        }
    }
    person.wait("plan.text() === 'takeoff\\ngoto 1 0 0 0\\nland\\n'");
    // What a mouse drags has numbers, and what it clicks a button.
    person.go(0, "it.matches('#draftsteps li:nth-child(2) input:nth-of-type(2)')");
    person.write("0.5");
    person.wait("plan.text().includes('goto 1 0.5 0 0')");
    person.press("addstep");
    person.wait("plan.targets().length === 2 && plan.targets()[1].y === 1.5");
    person.go(
        SHIFT,
        "it.matches('#draftsteps li:nth-child(3) button') && it.ariaLabel === 'move up'",
    );
    person.key("Enter");
    person.wait("plan.targets()[0].y === 1.5 && plan.targets()[1].y === 0.5");
    // The map.
    let seen = "document.querySelector('#map').getAttribute('viewBox')";
    person.go(SHIFT, "it.id === 'map'");
    for key in ["ArrowRight", "ArrowUp", "+", "-", "ArrowDown", "ArrowLeft"] {
        let before = person.text(seen);
        person.key(key);
        person.wait(&format!("{seen} !== '{before}'"));
    }
    person.press("all");
    person.wait("document.querySelector('#all').ariaPressed === 'true'");
    person.press("solid");
    person.wait("!document.querySelector('#solidview').hidden");
    let picture = "document.querySelector('#solidview').toDataURL()";
    let before = person.text(picture);
    person.go(SHIFT, "it.id === 'solidview'");
    person.key("ArrowLeft");
    person.wait(&format!("{picture} !== '{before}'"));
    person.press("solid");
    person.press("saveplan");
    person.wait("document.querySelector('#plananswer').textContent.startsWith('Saved')");
    person.press("simulate");
    person.wait("!!plan.simulated()?.completed");
    person.press("load");
    person.wait("view === 'fly' && !document.querySelector('#start').disabled");
}

fn it_is_flown(person: &mut Keyboard<'_>) {
    person.press("start");
    person.wait("status.phase === 'flying' && status.step >= 1");
    person.key(" ");
    person.wait("status.mission_waits");
    person.key("r");
    person.wait("!status.mission_waits");
    // What is left of the mission would be flown before the way to a button is gone with Tab.
    person.key(" ");
    person.wait("status.mission_waits");
    person.press("byhand");
    person.chromium.key(&person.tab, "keyDown", "KeyS");
    person.wait("status.mission_waits && status.velocity_m_s[1] < -0.3");
    person.chromium.key(&person.tab, "keyUp", "KeyS");
    person.wait("Math.abs(status.velocity_m_s[1]) < 0.1");
    // An order is typed, and keys that it is made of order nothing.
    person.to("typed");
    person.write("hold\n");
    person.wait("document.querySelector('#typed').value === '' && status.phase === 'flying'");
    person.key("Tab");
    person.key("l");
    person.wait(LANDS);
    person.wait("status.phase === 'standby'");
}

fn it_is_looked_back_at(person: &mut Keyboard<'_>) {
    person.view("flights");
    // The simulation of the plan is listed, too, and has no report; a busy machine lists the flight a good while later.
    let listed = "[...document.querySelectorAll('#recordings tbody tr')]\
        .some((row) => row.textContent.includes('by keys.txt') && row.textContent.includes('Report'))";
    person.wait(listed);
    person.go(0, "it.textContent === 'Report'");
    // A list that is read again leaves the focus where it is.
    let focused = "flights.list().then(() => document.activeElement.textContent)";
    assert_eq!(person.chromium.settle(&person.tab, focused), "Report");
    person.key("Enter");
    person.wait("!document.querySelector('#report').hidden");
    person.go(0, "it.id === 'report'");
    person.go(SHIFT, "it.textContent === 'Play'");
    person.key("Enter");
    person.wait("view === 'fly' && !document.querySelector('#playback').hidden");
    person.to("pace");
    for _ in 0..3 {
        person.key("ArrowDown");
    }
    person.wait("document.querySelector('#pace').value === '8'");
    person.wait("document.querySelector('#play').textContent === 'Play'");
    person.press("endplay");
    person.wait("document.querySelector('#playback').hidden");
    person.view("plots");
    person.go(0, "it.matches('.plots')");
    person.key("ArrowLeft");
    person.wait("document.querySelector('#plotsat').textContent.startsWith('at ')");
}

/// In the air the keys that hold and land work wherever the focus is, but in a text.
#[test]
fn a_drone_is_held_and_landed_from_everywhere() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = chromium.open(&station.url);
    let mut person = Keyboard { chromium: &mut chromium, tab };
    person.wait("!!status && !!readiness && readiness.ready");
    let plan = "takeoff\ngoto 0 1 0 0\nsetStayTime 300\ngoto 0 0 0 0\nland\n";
    let load = format!("order({})", json!({ "order": "load", "name": "hover", "plan": plan }));
    person.chromium.evaluate(&person.tab, &load);
    person.wait("flight.plan === 'hover'");
    // Whoever looks at the list sees there that a flight has begun.
    person.chromium.evaluate(&person.tab, "show('flights')");
    person.wait(
        "performance.getEntriesByType('resource').some(({ name }) => name.includes('/summary'))",
    );
    person.chromium.evaluate(&person.tab, "order({ order: 'start' })");
    let goes_on = "document.querySelector('#recordings tbody').textContent.includes('goes on')";
    person.wait(goes_on);
    person.wait("status.phase === 'flying' && status.step >= 1");
    let resume = |person: &mut Keyboard<'_>| {
        person.chromium.evaluate(&person.tab, "order({ order: 'resume' })");
        person.wait("!status.mission_waits");
    };
    for (view, places) in [
        ("plan", vec!["#newstep", "#plans", "#draftsteps input", "#upload", "#map"]),
        ("flights", vec!["#ofdate", "#ofend", "#recordings input[type=checkbox]", "#report"]),
        ("settings", vec!["#settings select", "#settings input[type=number]", "#padaxes input"]),
        ("plots", vec![".plots"]),
        ("fly", vec!["summary", "#playat"]),
    ] {
        person.chromium.evaluate(&person.tab, &format!("show('{view}')"));
        for place in places {
            let there = format!("!!document.querySelector('{place}')");
            person.wait(&there);
            let focus = format!("document.querySelector('{place}').focus(); true");
            if place == "#report" {
                a_report_is_open(&mut person);
            } else if place == "#playat" {
                // It is not seen while something flies.
                person
                    .chromium
                    .evaluate(&person.tab, "document.querySelector('#playback').hidden = false");
            }
            person.chromium.evaluate(&person.tab, &focus);
            person.wait(&format!("document.activeElement.matches('{place}')"));
            let content = format!(
                "String([document.querySelector('{place}').value, document.querySelector('{place}').checked])"
            );
            let before = person.text(&content);
            person.key(" ");
            person.wait("status.mission_waits");
            assert_eq!(person.text(&content), before, "{place}");
            let open = format!("document.querySelector('{place}').matches('select:open')");
            assert_eq!(person.chromium.evaluate(&person.tab, &open), false, "{place}");
            resume(&mut person);
        }
    }
    // A text takes them.
    person
        .chromium
        .evaluate(&person.tab, "show('plan'); document.querySelector('#planname').select()");
    person.write("l l");
    person.wait("document.querySelector('#planname').value === 'l l'");
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert_eq!(
        person.chromium.evaluate(&person.tab, "status.mission_waits || status.phase !== 'flying'"),
        false
    );
    // From inside the report.
    person.chromium.evaluate(&person.tab, "show('flights')");
    a_report_is_open(&mut person);
    person.wait(goes_on);
    person.chromium.evaluate(&person.tab, "document.querySelector('#report').focus(); true");
    person.key("l");
    person.wait(LANDS);
    // Whoever looks at the list sees there that the flight has ended.
    let ended = "status.phase === 'standby' && document.querySelectorAll('#recordings tbody tr').length === 1";
    person.wait(&format!("{ended} && !{goes_on}"));
}

/// A report is shown, and its script has begun to listen.
fn a_report_is_open(person: &mut Keyboard<'_>) {
    person.wait("document.querySelectorAll('#recordings .actions button').length > 0");
    let open = "window.loaded = false; document.querySelector('#report').onload = () => (window.loaded = true); \
        document.querySelector('#recordings .actions button').click(); document.querySelector('#report').hidden";
    // Until then nobody can be in it.
    assert_eq!(person.chromium.evaluate(&person.tab, open), true);
    person.wait("window.loaded && !document.querySelector('#report').hidden");
}

/// Whatever has the focus in a report is seen to have it.
#[test]
fn the_focus_is_seen_in_a_report() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = station();
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "!!status && !!readiness && readiness.ready");
    // Half a second is not written yet.
    let made = "fetch('flights/flights.mcap/report').then(({ ok }) => ok)";
    while chromium.settle(&tab, made) != true {
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    let tab = chromium.open(&format!("{}flights/flights.mcap/report", station.url));
    chromium.wait(&tab, "document.querySelectorAll('.plot').length > 3");
    let mut person = Keyboard { chromium: &mut chromium, tab };
    let stops = "document.querySelectorAll('a[href], button, summary, [tabindex=\"0\"]').length";
    let stops = person.chromium.evaluate(&person.tab, stops).as_u64().unwrap();
    assert!(stops > 6, "{stops}");
    for _ in 0..stops {
        person.go(0, "true");
    }
}
