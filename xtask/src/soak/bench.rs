//! One flight of the soak test: a mock drone and a pilot as processes, with everything done to them.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::net::{Ipv4Addr, UdpSocket};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

use super::judge::{self, Times, Verdict};
use super::now;
use super::script::{End, Output, Script, Sign};

/// Why a flight could not be run.
#[derive(Debug, thiserror::Error)]
pub(crate) enum BenchError {
    #[error("the programs cannot be built")]
    Build,
    #[error("the mock drone does not print its ports: {0}")]
    Ports(String),
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error("the truth cannot be read: {0}")]
    Truth(#[from] csv::Error),
}

/// Paths of the programs.
#[derive(Debug)]
pub(crate) struct Programs {
    pilot: PathBuf,
    mock: PathBuf,
}

/// Timeout of a flight, longer than any plan with everything that can delay it.
const LONGEST_FLIGHT: Duration = Duration::from_secs(400);
/// Time for the pilot to end after the last interference.
const LONGEST_END: Duration = Duration::from_mins(1);
/// Time for which the drone is watched after the pilot's end.
const WATCHED: Duration = Duration::from_secs(22);
const LOOK: Duration = Duration::from_millis(10);
/// Interval of reading the drone's log.
const LOOK_AT_TRUTH: Duration = Duration::from_millis(500);
/// Datagrams of a flood sent in one go.
const BURST: u32 = 500;

impl Programs {
    /// Builds both programs in the same profile as this one.
    pub(crate) fn build(pilot: Option<PathBuf>) -> Result<Self, BenchError> {
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--workspace", "--bins"]);
        if !cfg!(debug_assertions) {
            build.arg("--release");
        }
        if !build.status()?.success() {
            return Err(BenchError::Build);
        }
        let own = std::env::current_exe()?;
        let folder = own.parent().ok_or(BenchError::Build)?;
        let pilot = pilot.unwrap_or_else(|| folder.join("ardrone-pilot"));
        Ok(Self { pilot, mock: folder.join("mock-drone") })
    }
}

/// A process that is killed when dropped.
struct Process(Child);

impl Process {
    fn signal(&self, signal: Signal) {
        let id = i32::try_from(self.0.id()).ok().and_then(Pid::from_raw);
        // A process that has ended cannot be signalled.
        _ = id.map(|id| kill_process(id, signal));
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        _ = self.0.kill();
        _ = self.0.wait();
    }
}

/// Runs a flight and judges it.
pub(crate) fn fly(programs: &Programs, script: &Script) -> Result<Verdict, BenchError> {
    let folder = tempfile::tempdir()?;
    let truth = folder.path().join("truth.csv");
    let (mock, ports, drone_start) = start_mock(programs, script, folder.path(), &truth)?;
    let pilot = start_pilot(programs, script, folder.path(), ports)?;
    let mut flight = Flight {
        script,
        pilot,
        ports,
        drone_start,
        pilot_start: now(),
        times: Times::default(),
        stopped: false,
        flooded: 0,
    };
    flight.watch()?;
    let ended = now();
    while ended.elapsed() < WATCHED && !(judge::is_down(&truth) && stays_down(ended)) {
        sleep(LOOK_AT_TRUTH);
    }
    // The mock drone flushes its log when it ends.
    mock.signal(Signal::TERM);
    sleep(LOOK_AT_TRUTH);
    drop(mock);
    Ok(judge::judge(script, &flight.times, &truth)?)
}

/// Whether the log, which may lag by half a second, covers the last judgement, 1.5 s after the pilot's end.
fn stays_down(ended: Instant) -> bool {
    ended.elapsed() > Duration::from_secs(3)
}

/// AT, navdata and control port of the drone.
type Ports = [u16; 3];

fn start_mock(
    programs: &Programs,
    script: &Script,
    folder: &Path,
    truth: &Path,
) -> Result<(Process, Ports, Instant), BenchError> {
    let scenario = folder.join("scenario.txt");
    std::fs::write(&scenario, &script.scenario)?;
    let mut mock = Command::new(&programs.mock);
    for port in ["--at-port", "--navdata-port", "--control-port", "--ftp-port", "--video-port"] {
        mock.args([port, "0"]);
    }
    mock.args(&script.drone).arg("--truth").arg(truth).arg("--scenario").arg(&scenario);
    mock.env("NO_COLOR", "1").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut mock = Process(mock.spawn()?);
    let mut line = String::new();
    if let Some(stderr) = mock.0.stderr.take() {
        let mut stderr = BufReader::new(stderr);
        stderr.read_line(&mut line)?;
        // Its further output is not read, which it tolerates.
    }
    // "... AT 1234/udp, navdata 1235/udp, configuration 1236/tcp"
    let ports: Vec<u16> =
        line.split_whitespace().filter_map(|word| word.split_once('/')?.0.parse().ok()).collect();
    let ports = ports.try_into().map_err(|_| BenchError::Ports(line))?;
    Ok((mock, ports, now()))
}

fn start_pilot(
    programs: &Programs,
    script: &Script,
    folder: &Path,
    ports: Ports,
) -> Result<Process, BenchError> {
    let plan = folder.join("plan.txt");
    File::create(&plan)?.write_all(script.plan.as_bytes())?;
    let mut pilot = Command::new(&programs.pilot);
    pilot.arg("--plan").arg(plan).args(["--drone", "127.0.0.1", "--json"]);
    for (name, port) in ["--at-port", "--navdata-port", "--control-port"].iter().zip(ports) {
        pilot.arg(name).arg(port.to_string());
    }
    if script.records {
        pilot.arg("--log").arg(folder.join("flight.mcap"));
    } else {
        pilot.arg("--no-log");
    }
    pilot.stdin(Stdio::null());
    match script.output {
        Output::Ignored => pilot.stdout(Stdio::null()).stderr(Stdio::null()),
        Output::Closed | Output::StuckUntil(_) => {
            pilot.stdout(Stdio::piped()).stderr(Stdio::piped())
        }
    };
    let mut pilot = Process(pilot.spawn()?);
    if script.output == Output::Closed {
        close_output(&mut pilot);
    }
    Ok(pilot)
}

fn close_output(pilot: &mut Process) {
    drop((pilot.0.stdout.take(), pilot.0.stderr.take()));
}

/// A running flight and what was done to it.
struct Flight<'a> {
    script: &'a Script,
    pilot: Process,
    ports: Ports,
    drone_start: Instant,
    pilot_start: Instant,
    times: Times,
    stopped: bool,
    flooded: u32,
}

impl Flight<'_> {
    /// Carries out the script on the pilot until it has ended.
    fn watch(&mut self) -> Result<(), BenchError> {
        let garbage = loopback_socket()?;
        loop {
            let at = self.pilot_start.elapsed();
            if self.pilot.0.try_wait()?.is_some() {
                self.times.ended = Some(self.drone_start.elapsed());
                return Ok(());
            }
            if at > LONGEST_FLIGHT || self.overdue() {
                return Ok(());
            }
            self.stop_and_resume(at);
            self.end(at);
            if let Output::StuckUntil(time) = self.script.output
                && at >= time
            {
                close_output(&mut self.pilot);
            }
            if let Some((from, datagrams)) = self.script.flood
                && at >= from
                && self.flooded < datagrams
            {
                self.flood(&garbage);
            }
            sleep(LOOK);
        }
    }

    /// Whether the pilot has not ended in time although nothing keeps it.
    fn overdue(&self) -> bool {
        let Some(signal) = self.times.signal else { return false };
        let resumed = self.times.resumed.unwrap_or_default();
        let read = match self.script.output {
            Output::StuckUntil(time) => time + self.pilot_start.duration_since(self.drone_start),
            Output::Ignored | Output::Closed => Duration::ZERO,
        };
        let last = signal.max(resumed).max(read).max(self.times.second.unwrap_or_default());
        !self.stopped && self.drone_start.elapsed() > last + LONGEST_END
    }

    fn stop_and_resume(&mut self, at: Duration) {
        let Some((from, time)) = self.script.stop else { return };
        if at >= from && !self.stopped && self.times.resumed.is_none() {
            self.pilot.signal(Signal::STOP);
            self.stopped = true;
        }
        if self.stopped && at >= from + time {
            self.pilot.signal(Signal::CONT);
            self.stopped = false;
            self.times.resumed = Some(self.drone_start.elapsed());
        }
    }

    fn end(&mut self, at: Duration) {
        let apart = |time| at >= self.script.end_at + time;
        let (first, second) = match self.script.end {
            End::Plan => (None, None),
            End::Once(sign) => (Some(number(sign)), None),
            End::Twice(sign, time) => (Some(number(sign)), Some((number(sign), time))),
            End::Kill => (Some(Signal::KILL), None),
        };
        if let Some(signal) = first.filter(|_| self.times.signal.is_none())
            && apart(Duration::ZERO)
        {
            self.pilot.signal(signal);
            self.times.signal = Some(self.drone_start.elapsed());
        } else if let Some((signal, time)) = second.filter(|_| self.times.second.is_none())
            && apart(time)
        {
            self.pilot.signal(signal);
            self.times.second = Some(self.drone_start.elapsed());
        }
    }

    /// Sends garbage to the drone's AT port and to the pilot's ports.
    fn flood(&mut self, garbage: &UdpSocket) {
        let mut to: Vec<u16> = self.pilot_ports();
        to.push(self.ports[0]);
        for _ in 0..BURST {
            for port in &to {
                // If the queue is full the datagram is lost.
                _ = garbage.send_to(&[0x55; 300], (Ipv4Addr::LOCALHOST, *port));
            }
        }
        self.flooded += BURST;
    }

    /// Local ports of the pilot's sockets connected to the drone.
    fn pilot_ports(&self) -> Vec<u16> {
        let table = std::fs::read_to_string("/proc/net/udp").unwrap_or_default();
        let port = |address: &str| u16::from_str_radix(address.rsplit(':').next()?, 16).ok();
        let connected = table.lines().skip(1).filter_map(|line| {
            let mut words = line.split_whitespace().skip(1);
            let (local, remote) = (port(words.next()?)?, port(words.next()?)?);
            self.ports[..2].contains(&remote).then_some(local)
        });
        connected.collect()
    }
}

fn number(sign: Sign) -> Signal {
    match sign {
        Sign::Interrupt => Signal::INT,
        Sign::Terminate => Signal::TERM,
        Sign::HangUp => Signal::HUP,
        Sign::Quit => Signal::QUIT,
    }
}

fn sleep(time: Duration) {
    #[allow(clippy::disallowed_methods, reason = "processes are watched in real time")]
    std::thread::sleep(time);
}

/// A socket on the loopback interface.
fn loopback_socket() -> io::Result<UdpSocket> {
    #[allow(clippy::disallowed_methods, reason = "garbage is sent over real sockets")]
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
    socket.set_nonblocking(true)?;
    Ok(socket)
}
