//! The page as a ground station, end to end: a real Chromium, the program without a plan, the mock drone.

use std::io::Read as _;
use std::net::{IpAddr, UdpSocket};
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use serde_json::{Value, json};

use crate::chromium::{Chromium, Tab};
use crate::processes::{plan_file, program, signal, with_page};
use crate::station::{Station, response};

/// The program at rest, with plans of its own and the page at this address.
fn program_at(address: &str, arguments: &[&str]) -> Station {
    let arguments = [&["--ui", address, "--plans", "plans"], arguments].concat();
    Station::start(&arguments, &[])
}

impl Station {
    /// `127.0.0.1:1234`.
    fn host(&self) -> &str {
        self.url.trim_start_matches("http://").trim_end_matches('/')
    }

    /// The server's complete response to a request.
    fn request(&self, method: &str, path: &str, headers: &str, body: &str) -> String {
        let host = self.host();
        let length = body.len();
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nContent-Length: {length}\r\n{headers}"
        );
        response(host, format!("{head}\r\n{body}").as_bytes())
    }

    /// Lands, and waits for the end.
    fn end(mut self) {
        signal(&self.child, "-INT");
        self.child.wait().unwrap();
    }
}

fn happened(chromium: &mut Chromium, tab: &Tab, what: &str) {
    let events = "document.querySelector('#events').textContent";
    chromium.wait(tab, &format!("{events}.includes('{what}')"));
}

/// Waits until the plan editor is complete: what comes later moves what is below it.
fn planner(chromium: &mut Chromium, tab: &Tab) {
    chromium.wait(tab, "view === 'plan' && document.querySelectorAll('#plans option').length > 2");
    chromium.wait(tab, "!document.querySelector('#simulate').disabled");
}

fn number(chromium: &mut Chromium, tab: &Tab, expression: &str) -> f64 {
    let value = chromium.evaluate(tab, expression);
    value.as_f64().unwrap_or_else(|| panic!("{expression}: {value}"))
}

/// Someone without a drone: three clicks to a flight.
#[test]
fn the_example_is_three_clicks_from_the_air() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = program_at("0", &["--mock"]);
    let tab = chromium.open(&station.url);
    planner(&mut chromium, &tab);
    chromium.wait(&tab, "document.querySelector('#expected').textContent.includes('5.7 m')");
    chromium.click(&tab, "#simulate", [0.0; 2]);
    chromium.wait(&tab, "!!plan.simulated()?.completed");
    let simulated = number(&mut chromium, &tab, "plan.simulated().length_s");
    assert!((10.0..30.0).contains(&simulated), "{simulated}");
    chromium.wait(&tab, "document.querySelector('#simulated').getAttribute('points').length > 500");
    chromium.click(&tab, "#load", [0.0; 2]);
    chromium.wait(&tab, "view === 'fly' && document.querySelectorAll('#steps li').length === 6");
    chromium.wait(&tab, "!document.querySelector('#start').disabled");
    chromium.click(&tab, "#start", [0.0; 2]);
    chromium.wait(&tab, "status.phase === 'flying' && status.pose.z_m > 0.5");
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#who').textContent"), "you");
    station.end();
}

/// A plan is made with the mouse, simulated, flown with a detour by hand, and looked back at.
#[test]
fn a_plan_is_made_simulated_flown_and_compared() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = program_at("0", &["--mock"]);
    let tab = chromium.open(&station.url);
    planner(&mut chromium, &tab);
    // On an empty plan a click adds a take-off, too; before a landing on a tag it adds a target.
    chromium.type_into(&tab, "#plantext", "landOnTag\n");
    chromium.click(&tab, "#map", [0.0, -90.0]);
    chromium.wait(&tab, "/^takeoff\\ngoto .*\\nlandOnTag\\n$/.test(plan.text())");
    // What is not saved is not given up unasked.
    chromium.choose(&tab, "#plans", "-");
    chromium.click(&tab, "#ask button[value=no]", [0.0; 2]);
    chromium.wait(&tab, "!document.querySelector('#ask').open");
    chromium.wait(&tab, "plan.text().endsWith('landOnTag\\n')");
    chromium.choose(&tab, "#plans", "-");
    chromium.click(&tab, "#askyes", [0.0; 2]);
    chromium.wait(&tab, "plan.text() === 'takeoff\\nland\\n'");
    // A click on the mark of the target before would be no click on the map.
    chromium.wait(&tab, "!document.querySelector('#drafts g')");
    // Two clicks on the map are two targets before the landing, and one of them is dragged.
    for (count, off) in [(1, [0.0, -90.0]), (2, [90.0, -90.0])] {
        chromium.click(&tab, "#map", off);
        chromium.wait(&tab, &format!("plan.targets().length === {count}"));
    }
    let lines =
        chromium.evaluate(&tab, "plan.text().split('\\n').map((line) => line.split(' ')[0])");
    assert_eq!(lines, json!(["takeoff", "goto", "goto", "land", ""]));
    let before = number(&mut chromium, &tab, "plan.targets()[1].x");
    chromium.drag(&tab, "#drafts g:nth-child(2)", [40.0, 0.0]);
    chromium.wait(&tab, &format!("plan.targets()[1].x > {before} + 0.1"));
    // A click on a target adds none.
    chromium.click(&tab, "#drafts g:nth-child(1)", [0.0; 2]);
    // The list changes the text, and the text the list.
    chromium.type_into(&tab, "#draftsteps li:nth-child(2) input:nth-of-type(3)", "0.3");
    chromium.wait(&tab, "/^goto \\S+ \\S+ 0.3 0$/.test(plan.text().split('\\n')[1])");
    chromium.wait(&tab, "document.querySelector('#expected').textContent.includes('1.15 m above')");
    let good = chromium.evaluate(&tab, "plan.text()").as_str().unwrap().to_owned();
    assert_eq!(good.matches("goto").count(), 2, "{good}");
    // Slowly: a browser on a busy machine sees it under way.
    let good = good.replace("takeoff\n", "takeoff\nsetSpeed 0.3\n");
    chromium.type_into(&tab, "#plantext", &good.replace("takeoff", "takeof"));
    chromium.wait(&tab, "document.querySelector('#problems').textContent.includes('line 1')");
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#load').disabled"), true);
    chromium.type_into(&tab, "#plantext", &good);
    chromium.wait(&tab, "document.querySelectorAll('#problems .error').length === 0");
    chromium.type_into(&tab, "#planname", "two targets");
    chromium.click(&tab, "#saveplan", [0.0; 2]);
    chromium.wait(&tab, "document.querySelector('#plananswer').textContent.startsWith('Saved')");
    let saved = std::fs::read_to_string(station.folder.path().join("plans/two targets.txt"));
    assert_eq!(saved.unwrap(), good);
    chromium.click(&tab, "#simulate", [0.0; 2]);
    chromium.wait(&tab, "!!plan.simulated()?.completed");
    chromium.click(&tab, "#load", [0.0; 2]);
    chromium.wait(&tab, "view === 'fly' && !document.querySelector('#start').disabled");
    chromium.click(&tab, "#start", [0.0; 2]);
    // Anywhere on the way to both targets.
    chromium.wait(&tab, "status.step === 2 || status.step === 3");
    // By hand, away from the way, and on with the mission.
    chromium.click(&tab, "#byhand", [0.0; 2]);
    chromium.key(&tab, "keyDown", "KeyS");
    chromium.wait(&tab, "status.mission_waits && status.velocity_m_s[1] < -0.3");
    // The button of the cut answers to every press, and the sticks that are held do not disarm it. They are held during one
    // of them only: the detour by hand is as long as they are.
    for press in 0..3 {
        chromium.watch(&tab, "#cut");
        chromium.click(&tab, "#cut", [0.0; 2]);
        chromium.showed(&tab, &["Again: the drone FALLS", "Cut motors"]);
        assert_eq!(chromium.evaluate(&tab, "document.querySelector('#answer').textContent"), "");
        if press == 0 {
            chromium.key(&tab, "keyUp", "KeyS");
        }
    }
    chromium.wait(&tab, "Math.abs(status.velocity_m_s[1]) < 0.1");
    chromium.click(&tab, "#resume", [0.0; 2]);
    happened(&mut chromium, &tab, "mission resumed");
    happened(&mut chromium, &tab, "plan flown to its end");
    chromium.wait(&tab, "status.phase === 'standby'");
    // Looking back, while the program goes on: the flight and the simulation.
    chromium.click(&tab, "[data-show=flights]", [0.0; 2]);
    chromium.wait(&tab, "document.querySelectorAll('#recordings tbody tr').length === 2");
    let row = "document.querySelector('#recordings tbody tr:nth-child(2)').textContent";
    // It is written a moment later.
    chromium.wait(&tab, &format!("{row}.includes('plan flown to its end')"));
    let row = chromium.evaluate(&tab, row);
    let row = row.as_str().unwrap();
    assert!(row.contains("two targets.txt"), "{row}");
    for number in [1, 2] {
        chromium.click(&tab, &format!("#recordings tr:nth-child({number}) input"), [0.0; 2]);
    }
    chromium.wait(&tab, "document.querySelectorAll('#comparison polyline').length === 8");
    let apart = chromium.evaluate(&tab, "document.querySelector('#apart').textContent");
    let metres: Vec<f64> =
        (apart.as_str().unwrap().split_whitespace()).filter_map(|word| word.parse().ok()).collect();
    // The detour by hand is in one of them only.
    assert!(metres[0] > 0.02 && metres[1] > 0.3 && metres[1] < 6.0, "{apart}");
    chromium.click(&tab, "#recordings .actions button", [0.0; 2]);
    let report = "fetch(document.querySelector('#report').src).then((response) => response.text())\
        .then((text) => (window.reported = text)); true";
    chromium.wait(&tab, "document.querySelector('#report').src.endsWith('/report/0')");
    chromium.evaluate(&tab, report);
    chromium.wait(&tab, "(window.reported ?? '').includes('<h2>Decisions')");
    // The steps have the words of the plan that was loaded.
    chromium.wait(&tab, "window.reported.includes('1: takeoff')");
    chromium.wait(&tab, "window.reported.includes('<h1>two targets.txt</h1>')");
    // What is being recorded cannot be deleted.
    assert!(station.request("DELETE", "/flights/flights.mcap", "", "").contains(" 409 "));
    station.end();
}

/// One run of the program, two flights: each is found with its plan and its length.
#[test]
fn the_flights_of_a_run_are_told_apart() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = program_at("0", &["--mock"]);
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "!!status && !!readiness && readiness.ready");
    for (flown, name, plan) in
        [(1, "short.txt", "takeoff\\nland\\n"), (2, "long.txt", "takeoff\\ngoto 0 1 0 0\\nland\\n")]
    {
        let load = format!("order({{ order: 'load', name: '{name}', plan: '{plan}' }})");
        chromium.evaluate(&tab, &load);
        chromium.wait(&tab, &format!("flight.plan === '{name}'"));
        chromium.evaluate(&tab, "order({ order: 'start' })");
        // A browser on a busy machine may miss a short flight, and has what happened in it nevertheless.
        let ends = "document.querySelector('#events').textContent.split('plan flown to its end')";
        chromium.wait(&tab, &format!("{ends}.length === {flown} + 1"));
        chromium.wait(&tab, "status.phase === 'standby' && readiness.ready");
    }
    let summary = "fetch('flights/flights.mcap/summary').then((response) => response.json())";
    let ended =
        format!("{summary}.then((found) => found.flights.filter((one) => one.outcome).length)");
    while chromium.settle(&tab, &ended) != 2 {
        std::thread::sleep(Duration::from_millis(100));
    }
    let found = chromium.settle(&tab, summary);
    let [short, long] = [0, 1].map(|index| found["flights"][index].clone());
    assert_eq!((&short["plan"], &long["plan"]), (&json!("short.txt"), &json!("long.txt")));
    for flight in [&short, &long] {
        assert_eq!(flight["outcome"], "plan flown to its end");
        assert_eq!(flight["warning"], false);
    }
    let value = |flight: &Value, key: &str| flight[key].as_f64().unwrap();
    let [from, until] = [&short, &long].map(|flight| value(flight, "from_s"));
    assert!(from + value(&short, "length_s") < until, "{found}");
    assert!(value(&short, "length_s") + 2.0 < value(&long, "length_s"), "{found}");
    assert!(value(&short, "furthest_m") < 0.4 && value(&long, "furthest_m") > 0.8, "{found}");
    // Each has its report, with links to the other one; without a number it is the last one's.
    for (path, number, plan, link) in [
        ("report/0", 1, "short.txt", "href=\"1\""),
        ("report/1", 2, "long.txt", "href=\"0\""),
        ("report", 2, "long.txt", "href=\"report/0\""),
    ] {
        let page = station.request("GET", &format!("/flights/flights.mcap/{path}"), "", "");
        let heading = format!("<h1>{plan}</h1>");
        let which = format!("<b>flight {number} of 2</b>");
        let has_all = [&heading, &which, link].iter().all(|part| page.contains(*part));
        assert!(has_all, "{path}, {} bytes: {page:.2000}", page.len());
    }
    let missing = station.request("GET", "/flights/flights.mcap/report/2", "", "");
    assert!(missing.contains(" 404 ") && missing.contains("has no flight 3"), "{missing}");
    looked_back_at(&mut chromium, &tab);
    station.end();
}

/// The list of two flights of one run, a playback, and the plots.
fn looked_back_at(chromium: &mut Chromium, tab: &Tab) {
    chromium.click(tab, "[data-show=flights]", [0.0; 2]);
    let listed = "[...document.querySelectorAll('#recordings tbody tr')].filter((row) => !row.hidden) \
        .map((row) => row.children[2].textContent).join()";
    chromium.wait(tab, &format!("{listed} === 'long.txt,short.txt'"));
    chromium.type_into(tab, "#ofplan", "sho");
    chromium.wait(tab, &format!("{listed} === 'short.txt'"));
    chromium.type_into(tab, "#ofplan", " ");
    chromium.choose(tab, "#ofend", "ill");
    chromium.evaluate(tab, "document.querySelector('#ofend').oninput()");
    chromium.wait(tab, &format!("{listed} === ''"));
    chromium.choose(tab, "#ofend", "well");
    chromium.evaluate(tab, "document.querySelector('#ofend').oninput()");
    chromium.evaluate(
        tab,
        "document.querySelector('#ofdate').valueAsNumber = Date.now() + 2 * 86400000",
    );
    chromium.evaluate(tab, "document.querySelector('#ofdate').oninput()");
    chromium.wait(tab, &format!("{listed} === ''"));
    chromium.evaluate(tab, "document.querySelector('#ofdate').value = ''");
    chromium.evaluate(tab, "document.querySelector('#ofdate').oninput()");
    chromium.wait(tab, &format!("{listed} === 'long.txt,short.txt'"));
    // Played back eight times as fast, beside the live drone, until something flies.
    chromium.click(tab, "#recordings tbody tr:first-child .actions button:nth-child(2)", [0.0; 2]);
    chromium.wait(tab, "view === 'fly' && document.querySelector('#ghost').style.display === ''");
    chromium.choose(tab, "#pace", "8");
    chromium.wait(tab, "Number(document.querySelector('#playat').value) > 3");
    chromium.wait(tab, "document.querySelector('#ghostway').points.length > 20");
    chromium.wait(tab, "document.querySelector('#play').textContent === 'Play'");
    chromium.click(tab, "#solid", [0.0; 2]);
    chromium.picture(tab, "playback");
    chromium.click(tab, "#solid", [0.0; 2]);
    let played = chromium.evaluate(tab, "document.querySelector('#playtime').textContent");
    assert!(played.as_str().unwrap().starts_with("Played back"), "{played}");
    assert_eq!(chromium.evaluate(tab, "status.phase"), "standby");
    chromium.evaluate(tab, "order({ order: 'start' })");
    chromium.wait(tab, "document.querySelector('#playback').hidden && status.phase === 'flying'");
    // Plots with a time axis, whole percents, and nothing below nothing; they stand while they are looked at.
    chromium.click(tab, "[data-show=plots]", [0.0; 2]);
    let caption = |name| {
        format!(
            "[...document.querySelectorAll('figcaption')].find((it) => it.textContent.startsWith('{name}')).textContent"
        )
    };
    chromium.wait(tab, &format!("/^battery \\(%\\) \\d+ $/.test({})", caption("battery")));
    chromium.click(tab, "#pauseplots", [0.0; 2]);
    // Until it is drawn.
    std::thread::sleep(Duration::from_millis(500));
    let stands = chromium.evaluate(tab, &caption("position"));
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(chromium.evaluate(tab, &caption("position")), stands);
    chromium.click(tab, "#pauseplots", [0.0; 2]);
    chromium.wait(tab, &format!("{} !== {stands}", caption("position")));
    chromium.picture(tab, "plots");
}

/// The address by which other machines would reach this one.
fn own_address() -> Option<IpAddr> {
    let socket = UdpSocket::bind("0.0.0.0:0").ok()?;
    // Nothing is sent.
    socket.connect("192.0.2.1:9").ok()?;
    let address = socket.local_addr().ok()?.ip();
    (!address.is_loopback() && !address.is_unspecified()).then_some(address)
}

/// One page has the controls: a local one takes them visibly, a remote one is refused, and one that vanishes with a stick
/// held leaves a drone that holds.
#[test]
fn pages_hand_over_the_controls() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = program_at("0.0.0.0:0", &["--mock"]);
    let local = station.url.replace("ADDRESS-OF-THIS-MACHINE", "127.0.0.1");
    let first = chromium.open(&local);
    planner(&mut chromium, &first);
    let plan = "takeoff\ngoto 0 1 0 0\nsetStayTime 300\ngoto 0 0 0 0\nland\n";
    chromium.type_into(&first, "#plantext", plan);
    chromium.wait(&first, "document.querySelectorAll('#draftsteps li').length === 5");
    chromium.wait(&first, "!document.querySelector('#load').disabled");
    chromium.click(&first, "#load", [0.0; 2]);
    chromium.wait(&first, "view === 'fly' && !document.querySelector('#start').disabled");
    chromium.click(&first, "#start", [0.0; 2]);
    chromium.wait(&first, "status.phase === 'flying' && status.pose.z_m > 0.5");
    let who = "document.querySelector('#who').textContent";
    // A second one watches: what needs the controls is not offered.
    let second = chromium.open(&local);
    chromium.wait(&second, "isWatching() && !document.querySelector('#take').hidden");
    for button in ["fly", "typed", "byhand"] {
        let disabled = format!("document.querySelector('#{button}').disabled");
        chromium.wait(&second, &disabled);
    }
    chromium.click(&second, "#take", [0.0; 2]);
    chromium.wait(&second, &format!("{who} === 'you' && !status.mission_waits"));
    happened(&mut chromium, &second, "this page has taken the controls");
    chromium.show(&first);
    chromium.wait(&first, "isWatching()");
    happened(&mut chromium, &first, "has taken the controls");
    if let Some(address) = own_address() {
        let remote = chromium.open(&local.replace("127.0.0.1", &address.to_string()));
        chromium.wait(&remote, "isWatching() && me.includes('remote')");
        chromium.click(&remote, "#take", [0.0; 2]);
        let answer = "document.querySelector('#answer').textContent";
        chromium.wait(&remote, &format!("{answer}.includes('has the controls')"));
        chromium.wait(&remote, &format!("{who}.includes('local browser')"));
        // It may hold the drone nevertheless.
        chromium.click(&remote, "#hold", [0.0; 2]);
        chromium.wait(&remote, "status.mission_waits");
        chromium.close(&remote);
    } else {
        assert!(std::env::var_os("CI").is_none(), "this machine has no address but its own");
    }
    chromium.show(&second);
    chromium.click(&second, "#byhand", [0.0; 2]);
    chromium.key(&second, "keyDown", "KeyD");
    chromium.wait(&second, "status.velocity_m_s[0] > 0.3");
    chromium.close(&second);
    chromium.show(&first);
    chromium.wait(&first, "Math.abs(status.velocity_m_s[0]) < 0.1 && status.mission_waits");
    chromium.wait(&first, &format!("{who} === 'nobody'"));
    chromium.wait(&first, "status.phase === 'flying'");
    chromium.type_into(&first, "#typed", "resume");
    chromium.evaluate(&first, "document.querySelector('#typing').requestSubmit()");
    chromium.wait(&first, &format!("!status.mission_waits && {who} === 'you'"));
    station.end();
}

/// The files of the page: what is too large, badly named or foreign is refused, and nothing else is reached.
#[test]
fn files_are_bounded_and_nothing_else_is_reached() {
    let station = program_at("0", &["--mock"]);
    std::fs::write(station.folder.path().join("secret.txt"), "secret").unwrap();
    let plan = "takeoff\nland\n";
    let status = |answer: &str| answer.split(' ').nth(1).unwrap_or_default().to_owned();
    let put = |path: &str, headers: &str, body: &str| {
        status(&station.request("PUT", path, headers, body))
    };
    assert_eq!(put("/plans/a%20b.txt", "If-None-Match: *\r\n", plan), "204");
    assert_eq!(put("/plans/a%20b.txt", "If-None-Match: *\r\n", plan), "412");
    assert_eq!(put("/plans/a%20b.txt", "", plan), "204");
    let foreign = "Origin: http://evil.example\r\n";
    assert_eq!(put("/plans/evil.txt", foreign, plan), "403");
    for (method, path) in [
        ("DELETE", "/flights/flights.mcap"),
        ("POST", "/plan/check"),
        ("POST", "/plan/simulate"),
        ("GET", "/plans/a%20b.txt"),
    ] {
        assert_eq!(status(&station.request(method, path, foreign, plan)), "403", "{path}");
    }
    for name in ["..%2Fsecret.txt", "%2Fetc%2Fpasswd.txt", "..%5Csecret.txt", ".x.txt", "a%00.txt"]
    {
        for method in ["GET", "PUT"] {
            let answer = station.request(method, &format!("/plans/{name}"), "", plan);
            assert_eq!(status(&answer), "400", "{method} {name}: {answer}");
        }
        let answer = station.request("GET", &format!("/flights/{name}/report"), "", "");
        assert_eq!(status(&answer), "400", "{name}: {answer}");
    }
    for wrong in [
        r#"{"fence":4}"#,
        r#"{"fence":{"radius_m":"4"}}"#,
        r#"{"fence":[]}"#,
        r#"{"hall":{}}"#,
        "[]",
        "4",
        "",
    ] {
        assert_eq!(put("/settings", "", wrong), "422", "{wrong}");
    }
    let answer = station.request("PUT", "/settings", "", r#"{"fence":4}"#);
    assert!(answer.contains("integer `4`") && answer.contains("fence"), "{answer}");
    assert_eq!(status(&station.request("GET", "/plans/../secret.txt", "", "")), "404");
    assert_eq!(status(&station.request("GET", "/plans/none.txt", "", "")), "404");
    let large = "#".repeat(40 << 10);
    for (method, path) in
        [("PUT", "/plans/large.txt"), ("POST", "/plan/check"), ("POST", "/plan/simulate")]
    {
        assert_eq!(status(&station.request(method, path, "", &large)), "400", "{path}");
    }
    let plans = station.request("GET", "/plans", "", "");
    assert!(plans.ends_with("[\"a b.txt\"]"), "{plans}");
    std::fs::write(station.folder.path().join("broken.mcap"), "no log").unwrap();
    assert_eq!(status(&station.request("GET", "/flights/broken.mcap/summary", "", "")), "422");
    assert_eq!(status(&station.request("DELETE", "/flights/broken.mcap", "", "")), "204");
    // Half a second is not written yet.
    let report = (0..100).find_map(|_| {
        std::thread::sleep(Duration::from_millis(100));
        let report = station.request("GET", "/flights/flights.mcap/report", "", "");
        (status(&report) == "200").then_some(report)
    });
    let report = report.expect("a report of the flight that goes on");
    assert!(report.contains("sandbox allow-scripts") && !report.contains("script-src 'self'"));
    assert!(std::fs::exists(station.folder.path().join("secret.txt")).unwrap());
    // With a token everything but style and script needs it.
    let mut open = program_at("0.0.0.0:0", &["--mock"]);
    let port = open.url.split(':').nth(2).unwrap().split('/').next().unwrap();
    open.url = format!("http://127.0.0.1:{port}/");
    for path in ["/plans", "/flights", "/flights/flights.mcap", "/plans/a.txt"] {
        assert_eq!(status(&open.request("GET", path, "", "")), "403", "{path}");
    }
    assert_eq!(status(&open.request("GET", "/plan.js", "", "")), "200");
}

#[test]
fn a_drone_that_is_not_found_is_looked_for() {
    let Some(mut chromium) = Chromium::start() else { return };
    let station = program_at("0", &["--drone", "127.0.0.1"]);
    let tab = chromium.open(&station.url);
    // The page is complete.
    chromium.wait(&tab, "view === 'plan'");
    chromium.click(&tab, "[data-show=fly]", [0.0; 2]);
    chromium.wait(&tab, "!document.querySelector('#advice').hidden");
    let advice = chromium.evaluate(&tab, "document.querySelector('#advice').innerText");
    let advice = advice.as_str().unwrap();
    for word in ["127.0.0.1", "ardrone2_", "--drone", "another program", "--mock"] {
        assert!(advice.contains(word), "{word}: {advice}");
    }
    // A plan can be made and simulated meanwhile.
    chromium.click(&tab, "[data-show=plan]", [0.0; 2]);
    planner(&mut chromium, &tab);
    chromium.click(&tab, "#simulate", [0.0; 2]);
    chromium.wait(&tab, "!!plan.simulated()?.completed");
    station.end();
}

#[test]
#[ignore = "makes the pictures of the documentation"]
fn the_pictures_of_the_plan_and_of_the_flights() {
    let mut chromium = Chromium::start().expect("chromium");
    let station = program_at("0", &["--mock"]);
    let tab = chromium.open(&station.url);
    let plan = "# Up along a stair, and down again.\ntakeoff\nsetStayTime 1\ngoto 0 1.5 0 0\n\
        goto 1.5 1.5 0.5 90\ngoto 1.5 -0.5 1 180\nmoveBy -1.5 0 -0.5 0\ngoto 0 0 0 0\nland\n";
    planner(&mut chromium, &tab);
    chromium.type_into(&tab, "#planname", "stair.txt");
    chromium.type_into(&tab, "#plantext", plan);
    chromium.wait(&tab, "plan.targets().length === 5");
    chromium.click(&tab, "#simulate", [0.0; 2]);
    chromium.wait(&tab, "!!plan.simulated()?.completed");
    std::thread::sleep(Duration::from_secs(2));
    chromium.screenshot(&tab, Path::new("../docs/plan.png"));
    chromium.click(&tab, "#load", [0.0; 2]);
    chromium.wait(&tab, "view === 'fly' && !document.querySelector('#start').disabled");
    chromium.click(&tab, "#start", [0.0; 2]);
    chromium.click(&tab, "[data-show=plots]", [0.0; 2]);
    chromium.wait(&tab, "status.step === 6");
    chromium.picture(&tab, "plots");
    happened(&mut chromium, &tab, "plan flown to its end");
    chromium.click(&tab, "[data-show=flights]", [0.0; 2]);
    chromium.wait(
        &tab,
        // Below its simulation, which has such an end, too.
        "!!document.querySelector('#recordings tbody tr:nth-child(2)')?.textContent.includes('flown to its end')",
    );
    std::thread::sleep(Duration::from_secs(2));
    for number in [1, 2] {
        chromium.click(&tab, &format!("#recordings tr:nth-child({number}) input"), [0.0; 2]);
    }
    chromium.wait(&tab, "document.querySelectorAll('#comparison polyline').length === 8");
    chromium.screenshot(&tab, Path::new("../docs/flights.png"));
    chromium.click(&tab, "#recordings .actions button", [0.0; 2]);
    std::thread::sleep(Duration::from_secs(2));
    chromium.picture(&tab, "report");
    station.end();
}

/// What axe-core finds on a page that is serious: rule and place.
fn violations(chromium: &mut Chromium, tab: &Tab, axe: &str) -> Vec<String> {
    chromium.evaluate(tab, &format!("{axe}; true"));
    let found = chromium.settle(tab, "axe.run(document, { resultTypes: ['violations'] })");
    let violations = found["violations"].as_array().expect("axe-core has run").iter();
    let serious = violations
        .filter(|violation| matches!(violation["impact"].as_str(), Some("serious" | "critical")));
    serious
        .flat_map(|violation| {
            let nodes = violation["nodes"].as_array().unwrap().iter();
            nodes.map(|node| format!("{}: {}", violation["id"], node["target"]))
        })
        .collect()
}

#[test]
fn the_page_and_the_report_can_be_used_by_everybody() {
    let Some(mut chromium) = Chromium::start() else { return };
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("accessibility/node_modules/axe-core/axe.min.js");
    let Ok(axe) = std::fs::read_to_string(&file) else {
        let missing = "there is no axe-core here: npm ci --prefix tests/accessibility";
        assert!(std::env::var_os("CI").is_none(), "{missing}");
        println!("skipped: {missing}");
        return;
    };
    let station = program_at("0", &["--mock"]);
    let tab = chromium.open(&station.url);
    planner(&mut chromium, &tab);
    chromium.click(&tab, "#simulate", [0.0; 2]);
    chromium.wait(&tab, "!!plan.simulated()?.completed");
    chromium.click(&tab, "#load", [0.0; 2]);
    chromium.wait(&tab, "view === 'fly' && !document.querySelector('#start').disabled");
    chromium.click(&tab, "#start", [0.0; 2]);
    chromium.wait(&tab, "status.step >= 1");
    chromium.click(&tab, "#byhand", [0.0; 2]);
    // A plan with problems, a comparison, an alarm.
    let draft = "takeoff\ngoto 9 9 0 0\nfly\nland\n";
    chromium.click(&tab, "[data-show=plan]", [0.0; 2]);
    chromium.type_into(&tab, "#plantext", draft);
    chromium.wait(&tab, "document.querySelectorAll('#problems li').length > 0");
    for scheme in ["light", "dark"] {
        chromium.look(&tab, [1400, 860], scheme);
        for name in ["fly", "plan", "plots", "flights", "settings"] {
            chromium.click(&tab, &format!("[data-show={name}]"), [0.0; 2]);
            chromium.wait(&tab, &format!("view === '{name}'"));
            if name == "flights" {
                chromium.wait(&tab, "document.querySelectorAll('#recordings tbody tr').length > 0");
                chromium.click(&tab, "#recordings .actions button", [0.0; 2]);
            }
            let found = violations(&mut chromium, &tab, &axe);
            assert_eq!(found, Vec::<String>::new(), "{name}, {scheme}");
        }
    }
    let report = chromium.open(&format!("{}flights/flights.mcap/report", station.url));
    chromium.wait(&report, "document.querySelectorAll('h2').length > 3");
    assert_eq!(violations(&mut chromium, &report, &axe), Vec::<String>::new(), "the report");
    // The checker notices a button without a name and grey letters on grey ground.
    let breaks = "document.querySelector('nav button').replaceChildren(); \
        document.querySelector('h1').style.color = '#444'";
    chromium.evaluate(&tab, breaks);
    let found = violations(&mut chromium, &tab, &axe).join(" ");
    assert!(found.contains("button-name") && found.contains("color-contrast"), "{found}");
    station.end();
}

/// All views of a drone in the air, narrow and wide, in light and dark, where nothing is wider than the window.
#[test]
fn the_page_fits_telephones_and_large_screens() {
    let Some(mut chromium) = Chromium::start() else { return };
    let plan = plan_file(
        "takeoff\nsetStayTime 90\ngoto 0 1 0 0\nsetStayTime 1\ngoto -1.5 -0.55 -0.25 -180\nland\n",
    );
    let path = plan.path().to_str().unwrap().to_owned();
    let station = program_at("0", &["--mock", "--plan", &path]);
    let tab = chromium.open(&station.url);
    chromium.wait(&tab, "status?.phase === 'flying' && status.pose?.y_m > 0.8");
    for (width, height) in
        [(360, 740), (390, 844), (820, 1180), (1366, 768), (1400, 860), (1920, 1080)]
    {
        // The colours move nothing: in the dark the smallest and the largest suffice, but for pictures.
        let dark = [360, 1920].contains(&width) || std::env::var_os("PAGE_PICTURES").is_some();
        for scheme in ["light", "dark"].into_iter().take(if dark { 2 } else { 1 }) {
            chromium.look(&tab, [width, height], scheme);
            for name in ["fly", "plan", "plots", "flights", "settings"] {
                chromium.click(&tab, &format!("[data-show={name}]"), [0.0; 2]);
                chromium.wait(&tab, &format!("view === '{name}'"));
                let wide = number(&mut chromium, &tab, "document.documentElement.scrollWidth");
                assert!(wide <= f64::from(width), "{name} is {wide} wide at {width}");
                if name == "plan" && width >= 1366 {
                    // Each step has one line.
                    let rows = "document.querySelectorAll('#draftsteps li')";
                    let first = number(&mut chromium, &tab, &format!("{rows}[0].clientHeight"));
                    let target = number(&mut chromium, &tab, &format!("{rows}[4].clientHeight"));
                    assert!(target < 1.5 * first, "{target} and {first} at {width}");
                }
                chromium.picture(&tab, &format!("{name}-{width}-{scheme}"));
            }
        }
    }
    station.end();
}

/// How late ticks are with everything at once (a page that shows the video, plots drawn, the log with video, navdata 200
/// times per second) beside the same flight with nothing of it, in turn.
///
/// `cargo test --release -p system-tests --test system -- --ignored ticks_with_everything --nocapture`
#[test]
#[ignore = "measures"]
#[allow(clippy::print_stdout, reason = "a measurement")]
fn ticks_with_everything_and_with_nothing() {
    let plan = plan_file("takeoff\ngoto 0 1 0 0\nsetStayTime 45\ngoto 1 1 0 0\nland\n");
    let folder = tempfile::tempdir().unwrap();
    let full = folder.path().join("pilot.toml");
    std::fs::write(&full, "[drone]\nnavdata = \"full\"\n").unwrap();
    let mut chromium = Chromium::start().expect("chromium");
    for turn in 0..2 {
        for everything in [false, true] {
            let mut flight = program("ardrone-pilot");
            flight.args(["--mock", "--plain", "--timing", "--plan"]).arg(plan.path());
            if everything {
                let log = folder.path().join(format!("{turn}.mcap"));
                flight.args(["--ui", "0", "--record-video", "--log"]).arg(log);
                flight.arg("--config").arg(&full);
            } else {
                flight.arg("--no-log");
            }
            flight.stdout(Stdio::piped());
            let (mut flight, url) = if everything {
                let (flight, url) = with_page(&mut flight);
                (flight, Some(url))
            } else {
                (flight.stderr(Stdio::null()).spawn().unwrap(), None)
            };
            if let Some(url) = url {
                let tab = chromium.open(&url);
                chromium.wait(&tab, "window.video.drawn > 30");
                chromium.click(&tab, "[data-show=plots]", [0.0; 2]);
            }
            let mut printed = String::new();
            flight.stdout.take().unwrap().read_to_string(&mut printed).unwrap();
            assert_eq!(flight.wait().unwrap().code(), Some(0), "{printed}");
            println!("{}", if everything { "everything" } else { "nothing" });
            let rows = ["timing", "µs", "period", "lateness", "all work"];
            let row = |line: &&str| rows.iter().any(|row| line.trim_start().starts_with(row));
            printed.lines().filter(row).for_each(|line| println!("{line}"));
        }
    }
}
