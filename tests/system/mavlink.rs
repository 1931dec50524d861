//! The program as a MAVLink vehicle, over UDP: a small ground station, the program as a process, its own simulated drone.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{SocketAddr, UdpSocket};
use std::process::{Child, Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant, SystemTime};

use mavlink_vehicle::dialect::{
    COMMAND_ACK_DATA, COMMAND_LONG_DATA, HEARTBEAT_DATA, MavCmd, MavLandedState, MavMessage,
    MavModeFlag, MavResult,
};
use mavlink_vehicle::{Encoder, Key, LONGEST_FRAME, Signing, frames};
use rand::{Rng as _, RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use system_tests::lateness::Lateness;

use crate::processes::{plan_file, program, signal};

/// Longer than any flight here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(90);
/// A heartbeat comes each second.
const LONGEST_GAP: Duration = Duration::from_millis(1500);

/// A ground station.
struct Client {
    socket: UdpSocket,
    encoder: Encoder,
    signing: Option<Signing>,
    start: Instant,
    /// Where the vehicle speaks from.
    vehicle: Option<SocketAddr>,
    sent_heartbeat: Option<Instant>,
    /// When the vehicle's heartbeats came.
    heartbeats: Vec<Instant>,
    heard: u64,
}

impl Client {
    fn new() -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(50))).unwrap();
        Self {
            socket,
            encoder: Encoder::new(255, 190),
            signing: None,
            start: Instant::now(),
            vehicle: None,
            sent_heartbeat: None,
            heartbeats: Vec::new(),
            heard: 0,
        }
    }

    /// Another one, which nobody has told the vehicle of.
    fn beside(other: &Self) -> Self {
        Self { vehicle: other.vehicle, encoder: Encoder::new(254, 190), ..Self::new() }
    }

    fn sign(&mut self, phrase: &str) {
        let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap();
        let key = Key::from_pass_phrase(phrase).unwrap();
        self.signing = Some(Signing::new(key, 1, since.saturating_sub(self.start.elapsed()), 0));
    }

    /// `--mavlink` with this client alone.
    fn remote(&self) -> String {
        format!("udp:{}", self.socket.local_addr().unwrap())
    }

    fn send(&mut self, message: &MavMessage) {
        let mut buffer = [0; LONGEST_FRAME];
        let now = self.start.elapsed();
        let frame = self.encoder.encode(message, self.signing.as_mut(), now, &mut buffer);
        self.socket.send_to(frame, self.vehicle.expect("a vehicle was heard")).unwrap();
    }

    /// Waits for a datagram, and sends a heartbeat each second.
    fn poll(&mut self) -> Vec<MavMessage> {
        let due = self.sent_heartbeat.is_none_or(|at| at.elapsed() >= Duration::from_secs(1));
        if self.vehicle.is_some() && due {
            self.sent_heartbeat = Some(Instant::now());
            self.send(&MavMessage::HEARTBEAT(HEARTBEAT_DATA {
                mavtype: 6,
                autopilot: 8,
                mavlink_version: 3,
                ..HEARTBEAT_DATA::default()
            }));
        }
        let mut buffer = [0; 2048];
        let Ok((length, from)) = self.socket.recv_from(&mut buffer) else { return Vec::new() };
        self.vehicle = Some(from);
        let messages = frames(&buffer[..length]).map(|frame| frame.unwrap().message);
        let messages: Vec<MavMessage> = messages.collect();
        self.heard += messages.len() as u64;
        let is_heartbeat = |message: &&MavMessage| matches!(message, MavMessage::HEARTBEAT(_));
        let heartbeats = messages.iter().filter(is_heartbeat).count();
        self.heartbeats.extend(std::iter::repeat_n(Instant::now(), heartbeats));
        messages
    }

    #[track_caller]
    fn until<T>(&mut self, what: &str, wanted: impl Fn(&MavMessage) -> Option<T>) -> T {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(found) = self.poll().iter().find_map(&wanted) {
                return found;
            }
        }
        panic!("never: {what}");
    }

    /// What is heard for a while.
    fn listen(&mut self, time: Duration) -> u64 {
        let (start, before) = (Instant::now(), self.heard);
        while start.elapsed() < time {
            self.poll();
        }
        self.heard - before
    }

    #[track_caller]
    fn find(&mut self) {
        self.until("a heartbeat", |message| match message {
            MavMessage::HEARTBEAT(_) => Some(()),
            _ => None,
        });
    }

    fn send_command(&mut self, command: MavCmd, parameters: [f32; 2]) {
        self.send(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            command: command as u16,
            param1: parameters[0],
            param2: parameters[1],
            target_system: 1,
            target_component: 1,
            ..COMMAND_LONG_DATA::default()
        }));
    }

    #[track_caller]
    fn command(&mut self, command: MavCmd, parameters: [f32; 2]) -> MavResult {
        self.send_command(command, parameters);
        self.until("an acknowledgement", |message| acknowledgement(message, command))
    }

    /// Arms when the vehicle is ready for it.
    #[track_caller]
    fn arm(&mut self) {
        let start = Instant::now();
        while self.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, 0.0])
            != MavResult::MAV_RESULT_ACCEPTED
        {
            assert!(start.elapsed() < PATIENCE, "it is never ready");
            self.listen(Duration::from_millis(300));
        }
    }

    #[track_caller]
    fn until_state(&mut self, state: MavLandedState) {
        self.until("a landed state", |message| match message {
            MavMessage::EXTENDED_SYS_STATE(data) if data.landed_state == state => Some(()),
            _ => None,
        });
    }

    #[track_caller]
    fn fly(&mut self) {
        self.arm();
        let take_off = self.command(MavCmd::MAV_CMD_NAV_TAKEOFF, [f32::NAN; 2]);
        assert_eq!(take_off, MavResult::MAV_RESULT_ACCEPTED);
        self.until_state(MavLandedState::MAV_LANDED_STATE_IN_AIR);
        let land = self.command(MavCmd::MAV_CMD_NAV_LAND, [0.0; 2]);
        assert_eq!(land, MavResult::MAV_RESULT_ACCEPTED);
        self.until_state(MavLandedState::MAV_LANDED_STATE_ON_GROUND);
        self.until("disarmed", |message| match message {
            MavMessage::HEARTBEAT(data) => {
                (!data.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED)).then_some(())
            }
            _ => None,
        });
    }

    /// The longest time between two heartbeats.
    fn longest_gap(&self) -> Duration {
        let gaps = self.heartbeats.windows(2).map(|pair| pair[1] - pair[0]);
        gaps.max().unwrap_or(Duration::MAX)
    }
}

fn acknowledgement(message: &MavMessage, of: MavCmd) -> Option<MavResult> {
    match message {
        MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command, result, .. }) => {
            (*command == of as u16).then_some(*result)
        }
        _ => None,
    }
}

fn pilot(remotes: &str, arguments: &[&str]) -> Command {
    let mut pilot = program("ardrone-pilot");
    pilot.args(["--mock", "--plain", "--no-log", "--mavlink", remotes]).args(arguments);
    // Its end does not end the program.
    pilot.stdin(Stdio::null());
    pilot
}

/// A program, killed when dropped, and what it prints on standard error.
struct Process(Child);

impl Process {
    fn start(pilot: &mut Command) -> Self {
        Self(pilot.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap())
    }

    /// Ctrl-C ends it within seconds when the drone is down.
    #[track_caller]
    fn interrupt(mut self) {
        signal(&self.0, "-INT");
        let (start, lateness) = (Instant::now(), Lateness::measure());
        assert_eq!(self.0.wait().unwrap().code(), Some(130));
        let taken = start.elapsed();
        assert!(taken < Duration::from_secs(5) + 3 * lateness.worst(), "{taken:?}");
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // The process may have ended already.
        _ = self.0.kill();
        _ = self.0.wait();
    }
}

#[test]
fn a_ground_station_flies_the_drone() {
    let mut client = Client::new();
    let mut pilot = pilot(&client.remote(), &[]);
    let mut process = Process(pilot.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap());
    let mut lines = BufReader::new(process.0.stderr.take().unwrap()).lines();
    let line = lines.find_map(|line| line.unwrap().strip_prefix("MAVLink: ").map(str::to_owned));
    assert_eq!(line.unwrap(), format!("speaking to {}", client.remote()));
    std::thread::spawn(move || lines.for_each(drop));
    let lateness = Lateness::measure();
    client.find();
    client.fly();
    // Again, by another one of whom nobody has told the program. The first one's port stays its own: another test's client would
    // hear this vehicle there.
    let mut other = Client::beside(&client);
    let gap = client.longest_gap();
    other.find();
    other.fly();
    let (gap, allowed) = (gap.max(other.longest_gap()), LONGEST_GAP + lateness.worst());
    assert!(gap < allowed, "{gap:?}");
    process.interrupt();
}

#[test]
fn who_only_watches_gives_no_orders() {
    let mut client = Client::new();
    let process = Process::start(&mut pilot(&client.remote(), &["--mavlink-view-only"]));
    client.find();
    client.listen(Duration::from_secs(3));
    for command in [
        MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
        MavCmd::MAV_CMD_NAV_TAKEOFF,
        MavCmd::MAV_CMD_NAV_LAND,
        MavCmd::MAV_CMD_DO_FLIGHTTERMINATION,
    ] {
        assert_eq!(client.command(command, [1.0, 0.0]), MavResult::MAV_RESULT_DENIED);
    }
    let asked = client.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [148.0, 0.0]);
    assert_eq!(asked, MavResult::MAV_RESULT_ACCEPTED);
    process.interrupt();
}

#[test]
fn with_a_key_only_who_signs_is_heard() {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), "open sesame\n").unwrap();
    let mut client = Client::new();
    client.sign("open sesame");
    let key = ["--mavlink-key", file.path().to_str().unwrap()];
    let process = Process::start(&mut pilot(&client.remote(), &key));
    client.find();
    for phrase in [None, Some("open barley")] {
        let mut stranger = Client::beside(&client);
        if let Some(phrase) = phrase {
            stranger.sign(phrase);
        }
        assert_eq!(stranger.listen(Duration::from_millis(1500)), 0, "{phrase:?}");
    }
    let mut friend = Client::beside(&client);
    friend.sign("open sesame");
    friend.find();
    client.fly();
    process.interrupt();
}

/// Sends random datagrams, many of which begin as frames do, until it is told to end or has sent so many.
fn flood(vehicle: SocketAddr, most: u64, over: &AtomicBool) -> u64 {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(22);
    let mut sent = 0;
    while sent < most && !over.load(Ordering::Relaxed) {
        for _ in 0..100 {
            let mut bytes = [0_u8; 300];
            random.fill_bytes(&mut bytes);
            if random.random() {
                bytes[0] = 0xfd;
            }
            // Nobody may be there any more.
            _ = socket.send_to(&bytes[..random.random_range(0..300)], vehicle);
            sent += 1;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    sent
}

#[test]
fn a_flood_silences_nobody_and_ends_no_flight() {
    let mut client = Client::new();
    let plan = plan_file("takeoff\ngoto 0 1 0 0\nsetStayTime 15\ngoto 1 1 0 0\nland\n");
    let file = plan.path().to_str().unwrap();
    let mut process = Process::start(&mut pilot(&client.remote(), &["--plan", file]));
    client.find();
    client.until_state(MavLandedState::MAV_LANDED_STATE_IN_AIR);
    client.heartbeats.clear();
    let (vehicle, lateness) = (client.vehicle.unwrap(), Lateness::measure());
    let (sent, over) = (AtomicU64::new(0), AtomicBool::new(false));
    let (mut asked, mut answered) = (0, 0);
    let status = std::thread::scope(|scope| {
        scope.spawn(|| sent.store(flood(vehicle, 50_000, &over), Ordering::Relaxed));
        let mut next = Instant::now();
        loop {
            if let Some(status) = process.0.try_wait().unwrap() {
                over.store(true, Ordering::Relaxed);
                return status;
            }
            let request = MavCmd::MAV_CMD_REQUEST_MESSAGE;
            if sent.load(Ordering::Relaxed) == 0 && Instant::now() >= next {
                client.send_command(request, [148.0, 0.0]);
                asked += 1;
                next = Instant::now() + Duration::from_millis(50);
            }
            let answers = client.poll().into_iter();
            answered += answers.filter_map(|answer| acknowledgement(&answer, request)).count();
        }
    });
    // The plan ends the program, beside MAVLink too.
    assert_eq!(status.code(), Some(0));
    let sent = sent.into_inner();
    // It is heard through the flood; some of its questions may be lost.
    assert!(sent == 50_000 && asked > 20, "{sent} datagrams, {asked} questions");
    println!("{answered} of {asked} questions were answered in the flood");
    assert!(2 * answered > asked, "{answered} of {asked} questions were answered");
    let (gap, allowed) = (client.longest_gap(), LONGEST_GAP + lateness.worst());
    assert!(gap < allowed && client.heartbeats.len() > 5, "{gap:?}, {}", client.heartbeats.len());
}

/// A terminal that takes no output, as after Ctrl-S.
#[test]
fn output_that_nobody_takes_silences_nobody() {
    let (_unread, mut full) = std::io::pipe().unwrap();
    full.write_all(&vec![b'\n'; 65_536]).unwrap();
    let mut client = Client::new();
    let mut pilot = pilot(&client.remote(), &["--json"]);
    let process = Process(pilot.stdout(full).stderr(Stdio::null()).spawn().unwrap());
    client.find();
    client.listen(Duration::from_secs(5));
    client.fly();
    drop(process);
}

fn refused(arguments: &[&str]) -> (Option<i32>, String) {
    let output: Output = program("ardrone-pilot").args(arguments).output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn what_cannot_be_had_is_said_before_anything_starts() {
    let elsewhere = ["--mock", "--no-log", "--mavlink", "udp:192.0.2.1:14550"];
    let (status, message) = refused(&elsewhere);
    assert_eq!(status, Some(2), "{message}");
    for word in ["udp:192.0.2.1:14550", "--mavlink-key", "--mavlink-unsigned"] {
        assert!(message.contains(word), "{message}");
    }
    assert!(!message.contains("waiting for orders"), "{message}");
    let (status, message) = refused(&["--mavlink", "udp:no such host:14550"]);
    assert_eq!(status, Some(2), "{message}");
    assert!(message.contains("no such host") && message.contains("udp:HOST:PORT"), "{message}");
    let (status, message) = refused(&["--mavlink-view-only"]);
    assert_eq!(status, Some(2), "{message}");
    let (status, message) = refused(&["--mavlink", "--mavlink-origin", "90,0"]);
    assert_eq!(status, Some(2), "{message}");
    assert!(message.contains("latitude"), "{message}");
    let (status, message) = refused(&["--mavlink", "--mavlink-key", "/nowhere/key"]);
    assert_eq!(status, Some(20), "{message}");
    assert!(message.contains("/nowhere/key"), "{message}");
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), b"\xffsecret").unwrap();
    let (status, message) = refused(&["--mavlink", "--mavlink-key", file.path().to_str().unwrap()]);
    assert_eq!(status, Some(20), "{message}");
    assert!(!message.contains("secret"), "{message}");
}

/// Somebody else's port is where a ground station listens.
#[test]
fn others_who_speak_mavlink_disturb_nobody() {
    let mut client = Client::new();
    let first = Process::start(&mut pilot(&client.remote(), &[]));
    client.find();
    let one = client.vehicle;
    let second = Process::start(&mut pilot(&client.remote(), &[]));
    let start = Instant::now();
    while client.vehicle == one {
        assert!(start.elapsed() < PATIENCE);
        client.poll();
    }
    first.interrupt();
    second.interrupt();
}

/// How late ticks are with MAVLink at full rates and a flood on its port, beside the same flight without, in turn.
///
/// `cargo test --release -p system-tests --test system -- --ignored ticks_with_mavlink --nocapture`
#[test]
#[ignore = "measures"]
#[allow(clippy::print_stdout, reason = "a measurement")]
fn ticks_with_mavlink_and_without() {
    let plan = plan_file("takeoff\ngoto 0 1 0 0\nsetStayTime 45\ngoto 1 1 0 0\nland\n");
    for _ in 0..2 {
        for (what, rates, flooded) in [
            ("without MAVLink", false, false),
            ("with MAVLink at full rates", true, false),
            ("with MAVLink at full rates and a flood", true, true),
        ] {
            let mut client = Client::new();
            let mut flight = program("ardrone-pilot");
            flight.args(["--mock", "--plain", "--no-log", "--timing", "--plan"]).arg(plan.path());
            if rates {
                flight.args(["--mavlink", &client.remote()]);
            }
            let child = flight.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
            let mut process = Process(child.spawn().unwrap());
            let (over, start) = (AtomicBool::new(false), Instant::now());
            let sent = std::thread::scope(|scope| {
                let mut flooding = None;
                if rates {
                    client.find();
                    for id in 0..450_u16 {
                        client.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [f32::from(id), 1.0]);
                    }
                    let vehicle = client.vehicle.unwrap();
                    if flooded {
                        let over = &over;
                        flooding = Some(scope.spawn(move || flood(vehicle, u64::MAX, over)));
                    }
                }
                while process.0.try_wait().unwrap().is_none() {
                    client.poll();
                }
                over.store(true, Ordering::Relaxed);
                flooding.map_or(0, |flooding| flooding.join().unwrap())
            });
            let mut printed = String::new();
            process.0.stdout.take().unwrap().read_to_string(&mut printed).unwrap();
            assert_eq!(process.0.wait().unwrap().code(), Some(0), "{printed}");
            let seconds = start.elapsed().as_secs_f64();
            let [heard, sent] = [client.heard, sent].map(|count| count as f64 / seconds);
            println!("{what}: {heard:.0} messages per second, flood of {sent:.0} per second");
            let rows = ["timing", "µs", "period", "lateness", "all work"];
            let row = |line: &&str| rows.iter().any(|row| line.trim_start().starts_with(row));
            printed.lines().filter(row).for_each(|line| println!("{line}"));
        }
    }
}
