//! The browser display end to end: a real Chromium, the program, the mock drone.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use system_tests::lateness::Lateness;
use tungstenite::client::IntoClientRequest as _;
use tungstenite::{Message, WebSocket};

use crate::chromium::{Chromium, Tab};
use crate::processes::{plan_file, program, signal, with_page};
use crate::station::{Station, response};

/// A flight with a page.
struct Flown {
    child: Child,
    /// `127.0.0.1:1234`.
    host: String,
    _plan: Option<tempfile::NamedTempFile>,
}

impl Flown {
    fn start(plan: &str) -> Self {
        let (mut flown, address) = Self::at("0", plan);
        address.strip_suffix('/').unwrap().clone_into(&mut flown.host);
        flown
    }

    /// With a page at this address; also returns the printed URL.
    fn at(address: &str, plan: &str) -> (Self, String) {
        let plan = plan_file(plan);
        let (child, printed) = Self::fly(address, plan.path());
        (Self { child, host: String::new(), _plan: Some(plan) }, printed)
    }

    fn fly(address: &str, plan: &Path) -> (Child, String) {
        let mut pilot = program("ardrone-pilot");
        pilot.current_dir("..").arg("--plan").arg(plan);
        pilot.args(["--mock", "--plain", "--no-log", "--ui", address]);
        let (child, url) = with_page(pilot.stdout(Stdio::piped()));
        (child, url.strip_prefix("http://").unwrap().to_owned())
    }

    /// Waits for the end: the exit status and the output.
    fn end(mut self) -> (Option<i32>, String) {
        let mut printed = String::new();
        self.child.stdout.take().unwrap().read_to_string(&mut printed).unwrap();
        (self.child.wait().unwrap().code(), printed)
    }

    fn url(&self) -> String {
        format!("http://{}/", self.host)
    }

    /// The server's complete response to a request.
    fn request(&self, head: &str) -> String {
        response(&self.host, head.as_bytes())
    }

    /// Opens a WebSocket like the page's.
    fn live(&self) -> Live {
        Live::from(&self.host, "/live", None).unwrap()
    }
}

impl Drop for Flown {
    fn drop(&mut self) {
        // The process may have ended already.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// A WebSocket client in place of the page.
pub(crate) struct Live(WebSocket<TcpStream>);

impl Live {
    pub(crate) fn from(
        host: &str,
        path: &str,
        origin: Option<&str>,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        let mut request = format!("ws://{host}{path}").into_client_request()?;
        if let Some(origin) = origin {
            request.headers_mut().insert("Origin", origin.parse()?);
        }
        let stream = TcpStream::connect(host)?;
        stream.set_read_timeout(Some(Duration::from_secs(20)))?;
        Ok(Self(tungstenite::client(request, stream)?.0))
    }

    /// The next message of this type.
    pub(crate) fn next(&mut self, kind: &str) -> Value {
        loop {
            let message = match self.0.read() {
                // An interrupted system call, which is unrelated to the page.
                Err(tungstenite::Error::Io(error)) if error.kind() == ErrorKind::Interrupted => {
                    continue;
                }
                message => message.unwrap(),
            };
            let Message::Text(text) = message else { continue };
            let message: Value = serde_json::from_str(&text).unwrap();
            if message["type"] == kind {
                return message;
            }
        }
    }

    pub(crate) fn order(&mut self, request: &Value) {
        self.0.send(Message::text(request.to_string())).unwrap();
    }
}

const HOVER: &str = "takeoff\ngoto 0 1 0 0\nsetStayTime 300\ngoto 0 0 0 0\nland\n";

#[test]
fn the_page_shows_the_flight_and_orders_it() {
    let Some(mut chromium) = Chromium::start() else {
        return;
    };
    // A slow way: however slow the page is, it is still on it when it is held, and no stay has been set that the manual target
    // would have too.
    let flown = Flown::start("takeoff\nsetSpeed 0.1\ngoto 0 1 0 0\nland\n");
    let tab = chromium.open(&flown.url());
    chromium.wait(&tab, "document.querySelector('#steps .now')?.innerText.startsWith('3')");
    chromium
        .wait(&tab, "document.querySelector('#because pre')?.textContent.includes('+!approach')");
    chromium.wait(&tab, "!document.querySelector('#hold').disabled");
    chromium.click(&tab, "#hold", [0.0; 2]);
    chromium.wait(&tab, "document.querySelector('#events').innerText.includes('holding')");
    // A click on the map with a confirmation: the drone flies there.
    chromium.click(&tab, "#map", [60.0, 40.0]);
    chromium.wait(&tab, "!document.querySelector('#go').hidden");
    chromium.click(&tab, "#fly", [0.0; 2]);
    chromium.wait(
        &tab,
        "document.querySelector('#events').innerText.includes('flying to a manual target')",
    );
    let now = "document.querySelector('#now').textContent";
    chromium.wait(&tab, &format!("{now} === 'flying to the place that was chosen'"));
    chromium.wait(
        &tab,
        "document.querySelector('#events').innerText.includes('manual target reached')",
    );
    let target = chromium.evaluate(&tab, "status.target");
    assert!(target["x_m"].as_f64() > Some(0.1) && target["y_m"].as_f64() < Some(0.5), "{target}");
    chromium.click(&tab, "#resume", [0.0; 2]);
    chromium.wait(&tab, "document.querySelector('#events').innerText.includes('mission resumed')");
    // Reloading and opening the page twice loses nothing.
    chromium.reload(&tab);
    let second = chromium.open(&flown.url());
    for tab in [&tab, &second] {
        chromium.wait(tab, "document.querySelector('#events').innerText.includes('drone found')");
        chromium.wait(tab, "document.querySelector('#events').innerText.includes('holding')");
        chromium.wait(tab, "!status.mission_waits");
        // A page in the background is not drawn.
        chromium.wait(tab, "trail.length > 40");
    }
    chromium.click(&second, "#land", [0.0; 2]);
    for tab in [&tab, &second] {
        chromium
            .wait(tab, "document.querySelector('#alarm').innerText.startsWith('Over: landed on')");
    }
    let (status, printed) = flown.end();
    assert_eq!(status, Some(130), "{printed}");
}

/// Keys steer as long as they are held, and a page that vanishes with a key held steers no longer.
#[test]
fn the_page_flies_by_hand() {
    let Some(mut chromium) = Chromium::start() else {
        return;
    };
    let flown = Flown::start(HOVER);
    let tab = chromium.open(&flown.url());
    chromium.wait(&tab, "status?.step === 3");
    chromium.wait(&tab, "document.querySelector('#who').textContent === 'the local terminal'");
    // Without taking the sticks keys do nothing.
    chromium.key(&tab, "keyDown", "KeyW");
    chromium.key(&tab, "keyUp", "KeyW");
    chromium.click(&tab, "#byhand", [0.0; 2]);
    assert_eq!(chromium.evaluate(&tab, "status.mission_waits"), false);
    chromium.key(&tab, "keyDown", "KeyD");
    chromium.wait(&tab, "status.pose.x_m > 0.5");
    assert_eq!(chromium.evaluate(&tab, "status.mission_waits"), true);
    chromium.key(&tab, "keyUp", "KeyD");
    chromium.wait(&tab, "status.target && Math.abs(status.target.x_m - status.pose.x_m) < 0.1");
    let place = |chromium: &mut Chromium, tab: &Tab| {
        chromium.evaluate(tab, "status.pose.x_m").as_f64().unwrap()
    };
    let held = place(&mut chromium, &tab);
    std::thread::sleep(Duration::from_secs(1));
    assert!((place(&mut chromium, &tab) - held).abs() < 0.3);
    // The sticks on the screen: up with the left one, to the left with the right one.
    let high = chromium.evaluate(&tab, "status.pose.z_m").as_f64().unwrap();
    chromium.press(&tab, "#left", [0.0, -60.0]);
    chromium.wait(&tab, &format!("status.pose.z_m > {high} + 0.2"));
    chromium.release(&tab, "#left", [0.0, -60.0]);
    let watcher = chromium.open(&flown.url());
    chromium.wait(&watcher, "!!status");
    chromium.show(&tab);
    chromium.press(&tab, "#right", [-60.0, 0.0]);
    chromium.wait(&tab, &format!("status.pose.x_m < {held} - 0.3"));
    chromium.close(&tab);
    chromium.wait(&watcher, "status.target && Math.abs(status.target.x_m - status.pose.x_m) < 0.1");
    chromium.click(&watcher, "#land", [0.0; 2]);
    assert_eq!(flown.end().0, Some(130));
}

#[test]
#[ignore = "makes the picture of the documentation"]
fn the_picture_of_the_page() {
    let mut chromium = Chromium::start().expect("chromium");
    let (child, printed) = Flown::fly("0", Path::new("plans/xyz.txt"));
    let flown = Flown { child, host: printed.replace('/', ""), _plan: None };
    let tab = chromium.open(&flown.url());
    chromium.wait(&tab, "!!status && status.step === 5 && status.distance_m < 0.6");
    chromium.wait(&tab, "window.video.drawn > 20");
    chromium.click(&tab, "#map", [90.0, -60.0]);
    chromium.wait(&tab, "!document.querySelector('#go').hidden");
    chromium.screenshot(&tab, Path::new("../docs/browser.png"));
}

#[test]
fn one_click_cuts_nothing_and_two_do() {
    let Some(mut chromium) = Chromium::start() else {
        return;
    };
    let flown = Flown::start(HOVER);
    let tab = chromium.open(&flown.url());
    chromium.wait(
        &tab,
        "!!status && status.phase === 'flying' && status.pose && status.pose.z_m > 0.5",
    );
    chromium.watch(&tab, "#cut");
    chromium.click(&tab, "#cut", [0.0; 2]);
    chromium.showed(&tab, &["Again: the drone FALLS", "Cut motors"]);
    assert_eq!(chromium.evaluate(&tab, "status.phase"), json!("flying"));
    let emergency = "document.querySelector('#alarm').innerText.includes('emergency')";
    chromium.confirm(&tab, "#cut", emergency);
    assert_eq!(flown.end().0, Some(50));
}

/// If the pilot's process is stopped, the page reports that its data are old. A flight might not outlast that.
#[test]
fn a_page_that_hears_nothing_says_so() {
    let Some(mut chromium) = Chromium::start() else {
        return;
    };
    let station = Station::start(&["--mock", "--ui", "0"], &[]);
    let tab = chromium.open(&station.url);
    let hears = "!!readiness && readiness.ready && document.querySelector('#alarm').hidden";
    chromium.wait(&tab, hears);
    signal(&station.child, "-STOP");
    chromium.wait(
        &tab,
        "document.querySelector('#alarm').innerText.startsWith('No data from ardrone-pilot')",
    );
    signal(&station.child, "-CONT");
    chromium.wait(&tab, hears);
}

#[test]
fn foreign_pages_and_names_are_refused() {
    let flown = Flown::start(HOVER);
    let host = &flown.host;
    let page =
        flown.request(&format!("GET / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"));
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("<title>ardrone-pilot"), "{page}");
    assert!(page.contains("frame-ancestors 'none'"), "{page}");
    for outside in ["http://", "https://", "//cdn"] {
        let page = page.split("\r\n\r\n").nth(1).unwrap();
        assert!(!page.contains(outside), "{page}");
    }
    for (head, status) in [
        ("GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n".to_owned(), "403"),
        (
            format!(
                "GET / HTTP/1.1\r\nHost: {host}\r\nOrigin: http://evil.example\r\nConnection: close\r\n\r\n"
            ),
            "403",
        ),
        (
            format!("GET /../Cargo.toml HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"),
            "404",
        ),
        (format!("POST / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"), "405"),
        (format!("GET /live HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"), "4"),
        ("\0\u{1}\u{2} nonsense\r\nConnection: close\r\n\r\n".to_owned(), "400"),
    ] {
        let answer = flown.request(&head);
        assert!(answer.starts_with(&format!("HTTP/1.1 {status}")), "{head}\n{answer}");
    }
    assert!(Live::from(host, "/live", Some("http://evil.example")).is_err());
    assert!(Live::from(host, "/live", Some("null")).is_err());
    let mut ours = Live::from(host, "/live", Some(&format!("http://{host}"))).unwrap();
    assert_eq!(ours.next("flight")["steps"][0]["text"], "takeoff");
    ours.next("status");
    ours.order(&json!({ "order": "land" }));
    assert_eq!(flown.end().0, Some(130));
}

#[test]
fn other_machines_need_the_token() {
    let (mut flown, printed) = Flown::at("0.0.0.0:0", HOVER);
    let (port, token) = printed
        .strip_prefix("ADDRESS-OF-THIS-MACHINE:")
        .and_then(|rest| rest.split_once("/?token="))
        .unwrap();
    flown.host = format!("127.0.0.1:{port}");
    for (query, status) in [("", "403"), ("?token=0", "403"), (&format!("?token={token}"), "200")] {
        let answer = flown.request(&format!(
            "GET /{query} HTTP/1.1\r\nHost: pilot.local:{port}\r\nConnection: close\r\n\r\n"
        ));
        assert!(answer.starts_with(&format!("HTTP/1.1 {status}")), "{query}: {answer}");
    }
    assert!(Live::from(&flown.host, "/live", None).is_err());
    let mut live = Live::from(&flown.host, &format!("/live?token={token}"), None).unwrap();
    live.next("status");
    live.order(&json!({ "order": "land" }));
    assert_eq!(flown.end().0, Some(130));
}

/// Misbehaving clients of every kind at once: other clients and the flight are not affected.
#[test]
fn no_client_disturbs_the_flight() {
    let flown = Flown::start("takeoff\ngoto 0 1 0 0\nsetStayTime 6\ngoto 1 1 0 0\nland\n");
    let mut good = flown.live();
    // Slow clients: they read nothing, or send nothing.
    let deaf: Vec<Live> = (0..5).map(|_| flown.live()).collect();
    let silent: Vec<TcpStream> =
        (0..40).map(|_| TcpStream::connect(&flown.host).unwrap()).collect();
    // A client that sends garbage is disconnected.
    let mut garbage = flown.live();
    for text in ["", "{", "{\"order\":\"fall\"}", "[1,2,3]", "land"].iter().cycle().take(30) {
        // The connection may be closed by now.
        _ = garbage.0.send(Message::text(*text));
        std::thread::sleep(Duration::from_millis(25));
    }
    while let Ok(message) = garbage.0.read() {
        drop(message);
    }
    let mut binary = flown.live();
    // A message that is too large.
    _ = binary.0.send(Message::binary(vec![0; 1 << 20]));
    while let Ok(message) = binary.0.read() {
        drop(message);
    }
    // Clients that connect and disconnect a thousand times.
    for count in 0..1000 {
        let mut stream = TcpStream::connect(&flown.host).unwrap();
        if count % 2 == 0 {
            _ = stream.write_all(b"GET / HTTP/1.1\r\nHo");
        }
    }
    drop(silent);
    let mut late = flown.live();
    assert_eq!(late.next("flight")["steps"][4]["text"], "land");
    // Too many clients at a time.
    let mut all = Vec::new();
    while let Ok(live) = Live::from(&flown.host, "/live", None) {
        all.push(live);
        assert!(all.len() < 100);
    }
    drop((all, deaf));
    let end = good.next("end");
    assert_eq!((&end["exit_status"], &end["steps_done"]), (&json!(0), &json!(5)));
    assert_eq!(late.next("end"), end);
    let (status, printed) = flown.end();
    assert_eq!(status, Some(0));
    println!("{printed}");
}

/// Who is disconnected for what it sends knows why: each message is answered before, however fast they came.
#[test]
fn garbage_is_answered_before_the_end() {
    let flown = Flown::start(HOVER);
    let mut garbage = flown.live();
    garbage.next("status");
    for count in 0..11 {
        garbage.order(&json!({ "order": format!("fall {count}") }));
    }
    let mut answers = Vec::new();
    let closed = loop {
        match garbage.0.read() {
            Ok(Message::Text(text)) => {
                let message: Value = serde_json::from_str(&text).unwrap();
                if message["type"] == "refused" {
                    answers.push(message["reason"].as_str().unwrap().to_owned());
                }
            }
            Ok(Message::Close(_)) => break true,
            Ok(_) => {}
            Err(tungstenite::Error::Io(error)) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => panic!("{error} after {answers:?}"),
        }
    };
    assert!(closed && answers.len() == 11, "{answers:?}");
    assert!((0..11).all(|at| answers[at].contains(&format!("fall {at}"))), "{answers:?}");
}

/// A local operator has the controls by giving an order, whoever had them, and everybody is told; what anyone may do leaves
/// them where they are.
#[test]
fn a_plan_that_is_loaded_in_the_air_takes_the_controls() {
    let flown = Flown::start(HOVER);
    let (mut one, mut other) = (flown.live(), flown.live());
    let names = [one.next("you"), other.next("you")].map(|you| you["name"].clone());
    while one.next("status")["phase"] != "flying" {}
    let holds = |live: &mut Live, name: &Value| while live.next("status")["controls"] != *name {};
    one.order(&json!({ "order": "take" }));
    holds(&mut one, &names[0]);
    other.order(&json!({ "order": "hold" }));
    let held = loop {
        let status = other.next("status");
        if status["mission_waits"] == true {
            break status;
        }
    };
    assert_eq!(held["controls"], names[0]);
    let plan = "takeoff\ngoto 1 0 0 0\nland\n";
    other.order(&json!({ "order": "load", "name": "other", "plan": plan }));
    while other.next("accepted")["order"] != "load" {}
    let told = |event: &Value| event["text"].as_str().unwrap().contains("has taken the controls");
    while !told(&one.next("event")) {}
    holds(&mut one, &names[1]);
    // It was held: the new plan waits, too.
    assert_eq!(one.next("status")["mission_waits"], true);
}

/// Reading their plans is work: what all vehicles share has only two threads.
#[test]
fn pages_that_load_without_end_hold_up_no_signal() {
    let mut flown = Flown::start(HOVER);
    let bad = json!({ "order": "load", "plan": "x\n".repeat(9000) }).to_string();
    let pages = [(); 4].map(|()| {
        let (mut page, bad) = (flown.live(), bad.clone());
        std::thread::spawn(move || while page.0.send(Message::text(bad.as_str())).is_ok() {})
    });
    let mut watching = flown.live();
    while watching.next("status")["phase"] != "flying" {}
    signal(&flown.child, "-INT");
    let (told, lateness) = (Instant::now(), Lateness::measure());
    while watching.next("status")["phase"] == "flying" {}
    let taken = told.elapsed();
    assert!(taken < Duration::from_secs(3) + 3 * lateness.worst(), "{taken:?}");
    drop(watching);
    let mut printed = flown.child.stdout.take().unwrap();
    std::thread::spawn(move || std::io::copy(&mut printed, &mut std::io::sink()));
    while flown.child.try_wait().unwrap().is_none() {
        assert!(told.elapsed() < Duration::from_secs(20), "it has not ended");
        std::thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(flown.child.wait().unwrap().code(), Some(130));
    for page in pages {
        page.join().unwrap();
    }
}

#[test]
fn a_port_in_use_is_reported_before_anything_flies() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let plan = plan_file("takeoff\nland\n");
    let address = taken.local_addr().unwrap().to_string();
    let output = program("ardrone-pilot")
        .arg("--plan")
        .arg(plan.path())
        .args(["--mock", "--no-log", "--ui", &address])
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{printed}");
    assert!(
        printed.contains(&address) && printed.contains("give another address as --ui"),
        "{printed}"
    );
}
