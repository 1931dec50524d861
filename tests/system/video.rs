//! The video end to end: a camera that is simulated or was real, the program, its log, and a real Chromium.

use std::io::{Read as _, Write as _};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use ardrone_link::video::Reader;
use ardrone_pilot::recording::{Log, pictures};
use mock_drone::WorldConfig;
use mock_drone::server::{MockDrone, Ports};
use serde_json::Value;

use crate::chromium::{Chromium, Tab};
use crate::processes::{plan_file, program, signal, with_page};

const HOVER: &str = "takeoff\ngoto 0 1 0 0\nsetStayTime 300\ngoto 0 0 0 0\nland\n";
const SHORT: &str = "takeoff\nland\n";
const CAPTURES: [&[u8]; 2] =
    [include_bytes!("../fixtures/video/pave.bin"), include_bytes!("../fixtures/video/pave68.bin")];

/// The program with a page.
struct Pilot {
    child: Child,
    url: String,
}

impl Pilot {
    fn start(arguments: &[&str]) -> Self {
        let mut pilot = program("ardrone-pilot");
        pilot.current_dir("..").args(["--plain", "--ui", "0"]).args(arguments);
        let (child, url) = with_page(pilot.stdout(Stdio::null()));
        Self { child, url }
    }

    /// Lands, and waits for the end.
    fn end(mut self) {
        signal(&self.child, "-INT");
        self.child.wait().unwrap();
    }
}

/// Waits until the page has drawn some pictures without an error.
fn drawn(chromium: &mut Chromium, tab: &Tab, least: u32) {
    chromium.wait(tab, &format!("window.video.drawn >= {least}"));
    assert_eq!(chromium.evaluate(tab, "window.video.errors"), 0);
}

/// Mean brightness of a part of the canvas.
fn brightness(chromium: &mut Chromium, tab: &Tab, [x, y, width, height]: [u32; 4]) -> f64 {
    let mean = format!(
        "{{ const data = document.querySelector('#picture').getContext('2d')\
         .getImageData({x}, {y}, {width}, {height}).data; let sum = 0; \
         for (let i = 1; i < data.length; i += 4) sum += data[i]; sum / (data.length / 4) }}"
    );
    chromium.evaluate(tab, &mean).as_f64().unwrap()
}

#[test]
fn the_page_shows_both_cameras() {
    let Some(mut chromium) = Chromium::start() else { return };
    let plan = plan_file(HOVER);
    let plan = plan.path().display().to_string();
    let pilot = Pilot::start(&["--plan", &plan, "--mock", "--no-log"]);
    let tab = chromium.open(&pilot.url);
    drawn(&mut chromium, &tab, 20);
    let size = chromium.evaluate(&tab, "[picture.width, picture.height]");
    assert_eq!(size, serde_json::json!([640, 360]));
    chromium.wait(&tab, "status.pose && status.pose.z_m > 0.5");
    // The sky above the floor.
    let [sky, floor] = [[0, 0, 640, 60], [0, 300, 640, 60]];
    assert!(brightness(&mut chromium, &tab, sky) > brightness(&mut chromium, &tab, floor) + 30.0);
    chromium.click(&tab, "#bottom", [0.0; 2]);
    let mut differs = f64::INFINITY;
    for _ in 0..100 {
        differs = brightness(&mut chromium, &tab, sky) - brightness(&mut chromium, &tab, floor);
        if differs.abs() < 25.0 {
            break;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    assert!(differs.abs() < 25.0, "{differs}");
    let text = chromium.evaluate(&tab, "document.querySelector('#seen').textContent");
    assert!(text.as_str().unwrap().starts_with("height +0."), "{text}");
    assert_eq!(chromium.evaluate(&tab, "document.querySelector('#shoot').disabled"), false);
    pilot.end();
}

/// A drone whose video comes from somewhere else; returns the program's arguments.
fn arguments(mock: &MockDrone, video_port: u16) -> Vec<String> {
    let Ports { host, at, navdata, control, .. } = mock.ports();
    let pairs = [
        ("--drone", host.to_string()),
        ("--at-port", at.to_string()),
        ("--navdata-port", navdata.to_string()),
        ("--control-port", control.to_string()),
        ("--video-port", video_port.to_string()),
    ];
    pairs.into_iter().flat_map(|(name, value)| [name.to_owned(), value]).collect()
}

/// A server of the video port, on a thread that ends with the test.
fn serve(talk: impl Fn(&mut TcpStream) -> std::io::Result<()> + Send + 'static) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            // A client may go at any time.
            _ = talk(&mut stream.unwrap());
        }
    });
    port
}

#[test]
fn captures_of_real_drones_are_drawn() {
    let Some(mut chromium) = Chromium::start() else { return };
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let port = serve(|stream| {
        for capture in CAPTURES {
            let mut reader = Reader::default();
            reader.push(capture);
            let mut sent = 0;
            while let Some(picture) = reader.next() {
                let size = usize::from(picture.header.header_bytes) + picture.payload.len();
                stream.write_all(&capture[sent..sent + size])?;
                sent += size;
                std::thread::sleep(Duration::from_millis(120));
            }
        }
        // Nothing more, until the client gives up.
        stream.read_exact(&mut [0]).map(drop)
    });
    let arguments = arguments(&mock, port);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let pilot = Pilot::start(&[&arguments[..], &["--no-log"]].concat());
    let tab = chromium.open(&pilot.url);
    // Of the 20 and 5 pictures the first three depend on ones before the capture.
    drawn(&mut chromium, &tab, 22);
    // The silence behind them ends the connection, and the next one is shown.
    chromium.wait(&tab, "window.video.drawn > 22");
    pilot.end();
}

/// Whatever comes on the video port, the flight is flown as if nothing came.
#[test]
fn no_video_disturbs_the_flight() {
    /// 10 Mbit/s, in parts of 5 ms.
    const PART: usize = 6250;
    static NOISE: AtomicU64 = AtomicU64::new(1);
    static CONNECTIONS: [AtomicU64; 6] = [const { AtomicU64::new(0) }; 6];
    let connected = |server: usize| _ = CONNECTIONS[server].fetch_add(1, Ordering::Relaxed);
    let garbage = |stream: &mut TcpStream, begin: &[u8]| -> std::io::Result<()> {
        loop {
            let seed = NOISE.fetch_add(1, Ordering::Relaxed);
            let mut part = begin.to_vec();
            part.extend((0..PART as u64).map(|n| (seed * 31 + n * n * 7919).to_le_bytes()[0]));
            stream.write_all(&part)?;
            std::thread::sleep(Duration::from_millis(5));
        }
    };
    let lie = |size: u32| {
        let mut header = CAPTURES[1][..68].to_vec();
        header[8..12].copy_from_slice(&size.to_le_bytes());
        header
    };
    let servers = [
        serve(move |_| {
            connected(0);
            Ok(())
        }),
        serve(move |stream| {
            connected(1);
            stream.read_exact(&mut [0]).map(drop)
        }),
        serve(move |stream| {
            connected(2);
            garbage(stream, b"")
        }),
        serve(move |stream| {
            connected(3);
            garbage(stream, b"PaVE")
        }),
        serve(move |stream| {
            connected(4);
            garbage(stream, &lie(1_000_000))
        }),
        serve(move |stream| {
            connected(5);
            garbage(stream, &lie(3))
        }),
    ];
    let folder = tempfile::tempdir().unwrap();
    let flights = servers.into_iter().enumerate().map(|(number, port)| {
        let log = folder.path().join(format!("{number}.mcap"));
        std::thread::spawn(move || fly_and_read(&log, port))
    });
    for flight in flights.collect::<Vec<_>>() {
        flight.join().unwrap();
    }
    // Otherwise nothing was tried.
    let tried = CONNECTIONS.iter().map(|count| count.load(Ordering::Relaxed));
    assert!(tried.clone().all(|count| count > 0), "{:?}", tried.collect::<Vec<_>>());
}

fn fly_and_read(log: &Path, video_port: u16) {
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let plan = plan_file(SHORT);
    let output = program("ardrone-pilot")
        .args(["--plain", "--record-video", "--plan"])
        .arg(plan.path())
        .arg("--log")
        .arg(log)
        .args(arguments(&mock, video_port))
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{printed}");
    let bytes = std::fs::read(log).unwrap();
    let log = Log::read(&bytes).unwrap();
    assert!(log.complete);
    assert!(log.outcome().is_some_and(|(warns, _)| !warns));
}

/// The report shows the picture of the moment under the cursor, from a file as from the page, without a network.
#[test]
fn the_report_shows_the_pictures() {
    let Some(mut chromium) = Chromium::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("flight.mcap");
    let plan = plan_file(SHORT);
    let fly = program("ardrone-pilot")
        .args(["--plain", "--mock", "--record-video", "--plan"])
        .arg(plan.path())
        .arg("--log")
        .arg(&log)
        .output();
    assert_eq!(fly.unwrap().status.code(), Some(0));
    let report = program("ardrone-pilot").arg("report").arg(&log).output();
    assert_eq!(report.unwrap().status.code(), Some(0));
    let tab = chromium.open(&format!("file://{}", log.with_extension("html").display()));
    chromium.wait(&tab, "typeof camera === 'object' && camera !== null");
    let mut seen = Vec::new();
    for share in [0.3, 0.7, 0.2] {
        chromium.evaluate(&tab, &format!("show({share} * Number(end))"));
        let of =
            format!("Math.abs(parseFloat(nopicture.textContent.split(' ')[2]) - {share} * end)");
        chromium.wait(&tab, &format!("{of} < 0.2"));
        seen.push(brightness(&mut chromium, &tab, [0, 0, 640, 360]));
    }
    assert!(seen.iter().all(|brightness| *brightness > 20.0), "{seen:?}");
    // The keyboard moves the cursor as well.
    chromium.evaluate(&tab, "document.querySelector('.plot').focus(); marked = 1; true");
    chromium.key(&tab, "keyDown", "ArrowRight");
    chromium.wait(&tab, "marked > 1.05 && document.activeElement.className === 'plot'");
}

#[test]
fn a_recorded_flight_has_its_video() {
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("flight.mcap");
    let plan = plan_file(SHORT);
    let status = program("ardrone-pilot")
        .args(["--plain", "--mock", "--record-video", "--plan"])
        .arg(plan.path())
        .arg("--log")
        .arg(&log)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .unwrap();
    assert_eq!(status.code(), Some(0));
    let recorded = pictures(&std::fs::read(&log).unwrap()).unwrap();
    assert!(recorded.len() > 60, "{}", recorded.len());
    assert!(recorded[0].is_entry && recorded.iter().filter(|one| one.is_entry).count() > 3);
    assert!(recorded.windows(2).all(|pair| pair[0].at <= pair[1].at));
    let export = |name: &str| {
        let output = folder.path().join(name);
        let written =
            program("ardrone-pilot").arg("video").arg(&log).arg("-o").arg(&output).output();
        (written.unwrap().status.code(), std::fs::read(output).unwrap_or_default())
    };
    let (status, stream) = export("film.h264");
    assert_eq!(status, Some(0));
    let expected: Vec<u8> = recorded.iter().flat_map(|one| one.data.clone()).collect();
    assert_eq!(stream, expected);
    let (status, film) = export("film.mp4");
    assert_eq!((status, &film[4..8]), (Some(0), &b"ftyp"[..]));
    assert!(film.len() > expected.len());
    assert_eq!(export("film.mp4"), (Some(0), film), "it is replaced");
    assert_eq!(export("film.avi"), (Some(2), Vec::new()));
    for name in ["full.h264", "full.mp4"] {
        no_room(&log, &folder.path().join(name));
    }
    // The flight is replayed as if there were no video.
    let replayed = program("ardrone-pilot").arg("replay").arg(&log).output().unwrap();
    assert_eq!(replayed.status.code(), Some(0));
}

/// A film that cannot be written to its end is an error, and nothing is left of it.
fn no_room(log: &Path, film: &Path) {
    // As on a full disk: no file may be larger than four kilobytes or so, and what is refused is an error, not a signal.
    let limited = r#"trap "" XFSZ; ulimit -f 8; exec "$0" "$@""#;
    let mut pilot = Command::new("sh");
    pilot.args(["-c", limited]).arg(program("ardrone-pilot").get_program());
    let output = pilot.arg("video").arg(log).arg("-o").arg(film).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), &*output.stdout), (Some(1), &b""[..]), "{said}");
    assert!(said.contains("File too large"), "{said}");
    assert!(said.contains(&film.display().to_string()), "{said}");
    let left = std::fs::read_dir(film.parent().unwrap()).unwrap();
    let left: Vec<_> = left.map(|file| file.unwrap().file_name()).collect();
    assert_eq!(left.len(), 3, "something is left of {}: {left:?}", film.display());
}

/// `cargo test --release -p system-tests --test system -- --ignored how_late --nocapture`
#[test]
#[ignore = "measures"]
#[allow(clippy::print_stdout, reason = "a measurement")]
fn how_late_the_picture_is() {
    let mut chromium = Chromium::start().expect("chromium");
    let mut drone = program("mock-drone")
        .args(["--video-clock", "--at-port", "0", "--navdata-port", "0", "--control-port", "0"])
        .args(["--ftp-port", "0", "--video-port", "15555"])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mock = MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK).unwrap();
    let arguments = arguments(&mock, 15555);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let pilot = Pilot::start(&[&arguments[..], &["--no-log"]].concat());
    let tab = chromium.open(&pilot.url);
    drawn(&mut chromium, &tab, 30);
    chromium.evaluate(
        &tab,
        "window.late = []; { const context = picture.getContext('2d'); let last = 0; \
         setInterval(() => { if (window.video.drawn === last) return; last = window.video.drawn; \
         const row = context.getImageData(64, 352, 512, 1).data; let stamp = 0; \
         for (let bit = 0; bit < 32; bit += 1) stamp = stamp * 2 + (row[4 * (16 * bit + 8)] > 128); \
         window.late.push((Date.now() % 2 ** 32) - stamp); }, 1) }",
    );
    chromium.wait(&tab, "window.late.length > 300");
    let late: Value = chromium.evaluate(&tab, "window.late.slice().sort((a, b) => a - b)");
    let late: Vec<f64> = late.as_array().unwrap().iter().map(|ms| ms.as_f64().unwrap()).collect();
    let at = |share: usize| late[late.len() * share / 100];
    println!(
        "from the camera to the canvas: median {} ms, 95 % {} ms, worst {} ms",
        at(50),
        at(95),
        late[late.len() - 1]
    );
    pilot.end();
    drone.kill().unwrap();
    drone.wait().unwrap();
}
