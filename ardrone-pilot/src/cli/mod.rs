//! The command line of `ardrone-pilot`.

mod arguments;
mod check;
mod keys;
mod leave;
mod progress;
mod screen;
mod summary;
mod terminal;

use std::fs::File;
use std::io::{IsTerminal as _, Read as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use ardrone_link::DroneAddress;
use autopilot::plan::{Plan, PlanError};
use clap::{CommandFactory as _, Parser as _};
use clap_complete::Shell;
use mock_drone::WorldConfig;
use mock_drone::server::{MockDrone, Ports, ServerError};
use serde_json::Value;
use time::UtcDateTime;

use self::arguments::{Arguments, Command, Fly};
use self::keys::Keys;
use self::progress::Progress;
use self::screen::{Screen, Warnings};
use self::summary::{Summary, TrueWaypoint};
use crate::browser::{BrowserError, Door};
use crate::flight::{Flight, FlightError, Message};
use crate::json;
use crate::picture::PictureError;
use crate::recording::{
    Header, LARGEST_FILE_BYTES, Log, LogError, Recorder, Recording, RecordingError,
};
use crate::replay::{Replay, ReplayError};
use crate::report::{self, ReportError};
use crate::settings::{self, Settings, SettingsError};
use crate::timing::TimingReport;

/// Why nothing was flown.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("cannot read {what} {path}: {source}")]
    Read { what: &'static str, path: String, source: std::io::Error },
    #[error("cannot write {what} {path}: {source}")]
    Write { what: &'static str, path: String, source: std::io::Error },
    #[error("{0}")]
    Settings(#[from] SettingsError),
    #[error("cannot print the settings: {0}")]
    PrintSettings(#[from] toml::ser::Error),
    #[error("{0}")]
    Plan(#[from] PlanError),
    #[error("{path}: {source}")]
    Log { path: String, source: LogError },
    #[error("{0}")]
    Replay(#[from] ReplayError),
    #[error("{0}")]
    Report(#[from] ReportError),
    #[error("{0}")]
    Picture(#[from] PictureError),
    #[error("{0}")]
    Mock(#[from] ServerError),
    #[error("{0}; give another file as --log, or --no-log")]
    Recording(#[from] RecordingError),
    #[error("{0}")]
    Browser(#[from] BrowserError),
    #[error("{0}")]
    Flight(#[from] FlightError),
}

impl CommandError {
    fn exit_status(&self) -> u8 {
        match self {
            Self::Read { .. }
            | Self::Plan(_)
            | Self::Settings(_)
            | Self::Log { .. }
            | Self::Replay(_) => 20,
            Self::Flight(FlightError::Address { .. }) => 10,
            Self::Mock(_)
            | Self::Flight(_)
            | Self::PrintSettings(_)
            | Self::Picture(_)
            | Self::Report(_)
            | Self::Recording(_)
            | Self::Browser(_)
            | Self::Write { .. } => 1,
        }
    }
}

/// Runs the program and returns its exit status.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let warnings = Warnings::default();
    tracing_subscriber::fmt()
        .with_writer(warnings.clone())
        .with_max_level(tracing::Level::WARN)
        .with_ansi(std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none())
        .with_target(false)
        .without_time()
        .log_internal_errors(false)
        .init();
    let done = match (&arguments.command, &arguments.fly) {
        (Some(Command::Check(arguments)), _) => check::run(arguments),
        (Some(Command::Report { log, output }), _) => make_report(log, output.as_deref()),
        (Some(Command::Replay { log }), _) => replay(log),
        (Some(Command::Completions { shell }), _) => Ok(print_completions(*shell)),
        (Some(Command::Man), _) => Ok(print_manual()),
        (Some(Command::Config { config }), _) => print_settings(config.as_deref()),
        (None, Some(flight)) => fly(flight, &warnings),
        // The parser demands a plan where there is no command.
        (None, None) => Ok(2),
    };
    let status = done.unwrap_or_else(|error| {
        let prefix = if matches!(error, CommandError::Plan(_)) { "" } else { "error: " };
        terminal::tell(format_args!("{prefix}{error}"));
        error.exit_status()
    });
    ExitCode::from(status)
}

fn print_settings(path: Option<&Path>) -> Result<u8, CommandError> {
    let text = match path {
        Some(_) => read_settings(path)?.to_toml()?,
        None => settings::DEFAULTS.to_owned(),
    };
    terminal::print(text);
    Ok(0)
}

fn print_completions(shell: Shell) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "ardrone-pilot", &mut script);
    terminal::print_own(&script);
    0
}

fn print_manual() -> u8 {
    let mut page = Vec::new();
    // Writing to memory cannot fail.
    _ = clap_mangen::Man::new(Arguments::command()).render(&mut page);
    terminal::print_own(&page);
    0
}

/// Writes the page about a log.
fn make_report(path: &Path, output: Option<&Path>) -> Result<u8, CommandError> {
    let page = report::html(&read_log(path)?)?;
    let output = output.map_or_else(|| path.with_extension("html"), Path::to_owned);
    std::fs::write(&output, page).map_err(|source| CommandError::Write {
        what: "the report",
        path: output.display().to_string(),
        source,
    })?;
    terminal::print(format_args!("{}\n", output.display()));
    Ok(0)
}

/// Flies a log again; 1 if today's code decides otherwise.
fn replay(path: &Path) -> Result<u8, CommandError> {
    let replay = Replay::new(&read_log(path)?)?;
    terminal::print(&replay);
    Ok(u8::from(!replay.is_same()))
}

fn read_log(path: &Path) -> Result<Log, CommandError> {
    let name = || path.display().to_string();
    let mut file = Vec::new();
    // A byte more than is taken, which is then told.
    let most = LARGEST_FILE_BYTES as u64 + 1;
    File::open(path)
        .and_then(|opened| opened.take(most).read_to_end(&mut file))
        .map_err(|source| CommandError::Read { what: "the flight log", path: name(), source })?;
    let log = Log::read(&file).map_err(|source| CommandError::Log { path: name(), source })?;
    if !log.complete {
        terminal::tell(format_args!("note: {} was cut off; what is there is read", name()));
    }
    Ok(log)
}

fn fly(arguments: &Fly, warnings: &Warnings) -> Result<u8, CommandError> {
    let mut settings = read_settings(arguments.config.as_deref())?;
    if let Some(law) = arguments.law() {
        settings.set_law(law);
    }
    let config = settings.pilot_config(arguments.z_origin());
    // What is recorded is what is flown.
    let text = read("the plan", &arguments.plan)?;
    let name = arguments.plan.display().to_string();
    let plan = Plan::parse_within(&name, &text, &config.limits)?;
    let plain = arguments.plain || !std::io::stderr().is_terminal();
    let mut progress = Progress::new(&plan, plain);
    let mock = if arguments.mock {
        Some(MockDrone::start(&WorldConfig::default(), Ports::LOOPBACK)?)
    } else {
        None
    };
    let drone = drone_address(arguments, mock.as_ref());
    progress.say(&format!(
        "flying {} with {}",
        arguments.plan.display(),
        if mock.is_some() {
            "the mock drone".to_owned()
        } else {
            format!("the drone at {}", drone.host)
        }
    ));
    let door = arguments.ui.map(Door::bind).transpose()?;
    if let Some(door) = &door {
        progress.say(&format!("watch it at {}", door.url()));
    }
    let (recorder, recording) = match record(arguments, &settings, &plan, text, mock.is_some())? {
        Some((recorder, recording)) => (Some(recorder), Some(recording)),
        None => (None, None),
    };
    let screen = || Screen::start(&plan, &config.limits, warnings);
    let wanted = !plain && !arguments.json && std::io::stdin().is_terminal();
    let flight = Flight::start(plan.clone(), &config, &drone, recorder)?;
    // The drone may be flying already.
    if let Err(error) = leave::on_second_signal(flight.controls()) {
        progress.warn(&format!("a second Ctrl-C waits for whoever reads: {error}"));
    }
    let open = |door: Door| door.open(&name, &plan, &config.limits, flight.controls());
    let browser = door.map(open).transpose().unwrap_or_else(|error| {
        // The drone may be flying already.
        progress.warn(&error.to_string());
        None
    });
    let mut watch = match wanted.then(screen).flatten() {
        Some(screen) => Watch::Screen(Box::new(screen)),
        None => Watch::Lines(progress),
    };
    let keys = Keys::start(flight.controls());
    if keys.is_some() {
        watch.say(keys::HELP);
    }
    let mut truths = Vec::new();
    for message in flight.messages() {
        if arguments.json {
            print_object(&json::message(&message, plan.steps()));
        }
        if let (Message::Waypoint(waypoint), Some(mock)) = (&message, &mock) {
            truths.push(TrueWaypoint::new(waypoint, &mock.truth()));
        }
        if let Some(browser) = &browser {
            browser.show(&message);
        }
        watch.show(&message);
        if let Some(problem) = recording.as_ref().and_then(Recording::problem) {
            watch.warn(&problem.to_string());
        }
    }
    drop(keys);
    watch.end();
    let finished = flight.finish()?;
    let recorded = recording.and_then(Recording::finish);
    let summary = Summary { finished: &finished, truths: &truths, recorded: recorded.as_ref() };
    let end = json::end(&finished, recorded.as_ref());
    if let Some(browser) = browser {
        browser.end(&end);
    }
    if arguments.json {
        print_object(&end);
        return Ok(finished.outcome.exit_status());
    }
    terminal::print(&summary);
    if arguments.timing {
        terminal::print(TimingReport(&finished.ticks));
    }
    Ok(finished.outcome.exit_status())
}

/// One line for programs.
fn print_object(object: &Value) {
    terminal::print(format_args!("{}\n", json::text(object)));
}

/// Where people watch the flight.
enum Watch {
    Lines(Progress),
    Screen(Box<Screen>),
}

impl Watch {
    fn say(&mut self, line: &str) {
        match self {
            Self::Lines(progress) => progress.say(line),
            Self::Screen(screen) => screen.say(line),
        }
    }

    fn warn(&mut self, line: &str) {
        match self {
            Self::Lines(progress) => progress.warn(line),
            Self::Screen(screen) => screen.warn(line),
        }
    }

    fn show(&mut self, message: &Message) {
        match self {
            Self::Lines(progress) => progress.show(message),
            Self::Screen(screen) => screen.show(message),
        }
    }

    /// The flight is over: the terminal is as it was.
    fn end(self) {
        match self {
            Self::Lines(mut progress) => progress.end(),
            Self::Screen(screen) => {
                for warning in screen.end() {
                    terminal::tell(warning);
                }
            }
        }
    }
}

/// Starts to record the flight, unless nobody wants that.
fn record(
    arguments: &Fly,
    settings: &Settings,
    plan: &Plan,
    text: String,
    mock: bool,
) -> Result<Option<(Recorder, Recording)>, CommandError> {
    if arguments.no_log {
        return Ok(None);
    }
    let now = UtcDateTime::now();
    let path = match &arguments.log {
        Some(path) => path.clone(),
        None => default_log(now)?,
    };
    let start = now - UtcDateTime::UNIX_EPOCH;
    let header = Header {
        start: start.try_into().unwrap_or_default(),
        plan_name: arguments.plan.display().to_string(),
        plan: text,
        settings: settings.to_toml()?,
        z_origin: arguments.z_origin(),
        drone: if mock { "mock drone".to_owned() } else { arguments.drone.clone() },
    };
    let (mut recorder, recording) = Recorder::start(&path, &header)?;
    for note in plan.notes() {
        recorder.note(Duration::ZERO, note.clone());
    }
    Ok(Some((recorder, recording)))
}

/// `flights/2026-11-21T13-45-07Z.mcap`: names in the order of time, on any file system.
fn default_log(now: UtcDateTime) -> Result<PathBuf, CommandError> {
    let folder = PathBuf::from("flights");
    std::fs::create_dir_all(&folder).map_err(|source| CommandError::Write {
        what: "the folder",
        path: folder.display().to_string(),
        source,
    })?;
    let (date, time) = (now.date(), now.time());
    Ok(folder.join(format!(
        "{:04}-{:02}-{:02}T{:02}-{:02}-{:02}Z.mcap",
        date.year(),
        u8::from(date.month()),
        date.day(),
        time.hour(),
        time.minute(),
        time.second()
    )))
}

fn read_settings(path: Option<&Path>) -> Result<Settings, CommandError> {
    let Some(path) = path else { return Ok(Settings::default()) };
    let text = read("the settings", path)?;
    Ok(Settings::parse(&path.display().to_string(), &text)?)
}

fn read(what: &'static str, path: &Path) -> Result<String, CommandError> {
    let bytes = std::fs::read(path).map_err(|source| CommandError::Read {
        what,
        path: path.display().to_string(),
        source,
    })?;
    // Bytes that are no UTF-8 become characters that nothing of ours contains.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn drone_address(arguments: &Fly, mock: Option<&MockDrone>) -> DroneAddress {
    match mock.map(MockDrone::ports) {
        Some(ports) => DroneAddress {
            host: ports.host.to_string(),
            at_port: ports.at,
            navdata_port: ports.navdata,
            control_port: ports.control,
        },
        None => DroneAddress {
            host: arguments.drone.clone(),
            at_port: arguments.at_port,
            navdata_port: arguments.navdata_port,
            control_port: arguments.control_port,
        },
    }
}
