//! The command line of `ardrone-pilot`.

mod arguments;
mod check;
mod check_fleet;
mod elsewhere;
mod fleet;
mod fly;
mod keys;
mod mavlink;
mod program;
mod progress;
mod prompt;
mod recipients;
mod screen;
mod selftest;
mod summary;
mod terminal;

use std::fmt::Write as _;
use std::fs::File;
use std::io::{IsTerminal as _, Read as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use ardrone_link::selftest::Refusal;
use autopilot::plan::PlanError;
use clap::CommandFactory as _;
use clap_complete::Shell;
use mock_drone::server::ServerError;

use self::arguments::{Arguments, Command};
use self::elsewhere::ElsewhereError;
use self::fleet::MembersError;
use self::mavlink::MavlinkArgumentError;
use self::screen::Warnings;
use crate::browser::BrowserError;
use crate::fleet::FleetError;
use crate::flight::FlightError;
use crate::mavlink::MavlinkError;
use crate::plan_drawing::PlanDrawingError;
use crate::recording::{self, LARGEST_FILE_BYTES, Log, LogError, RecordingError};
use crate::replay::{Replay, ReplayError};
use crate::report::{ReportError, Reports};
use crate::selftest::SelfTestError;
use crate::settings::{Settings, SettingsError};
use crate::text_file;
use crate::video::{self, ExportError};

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("cannot read {what} {path}")]
    Read { what: &'static str, path: String, source: std::io::Error },
    #[error("cannot write {what} {path}")]
    Write { what: &'static str, path: String, source: std::io::Error },
    #[error(transparent)]
    Settings(#[from] SettingsError),
    #[error("cannot print the settings")]
    PrintSettings(#[from] toml::ser::Error),
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error(transparent)]
    Fleet(#[from] FleetError),
    #[error(transparent)]
    Members(#[from] MembersError),
    #[error(transparent)]
    Elsewhere(#[from] ElsewhereError),
    #[error("there is no command `{0}`")]
    NoCommand(String),
    #[error("--config, --tags and --tag are for plans: a fleet says them in its file")]
    OfPlans,
    #[error("{path}")]
    Log { path: String, source: LogError },
    #[error(transparent)]
    Replay(#[from] ReplayError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Video(#[from] ExportError),
    #[error("cannot start the threads beside the flight")]
    Threads(#[source] std::io::Error),
    #[error(transparent)]
    Picture(#[from] PlanDrawingError),
    #[error(transparent)]
    Mock(#[from] ServerError),
    #[error("no flight log can be written; give another file as --log, or --no-log")]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Browser(#[from] BrowserError),
    #[error(transparent)]
    MavlinkArguments(#[from] MavlinkArgumentError),
    #[error(transparent)]
    Mavlink(#[from] MavlinkError),
    #[error(transparent)]
    Flight(#[from] FlightError),
    #[error(transparent)]
    SelfTest(#[from] SelfTestError),
}

impl CommandError {
    fn exit_status(&self) -> u8 {
        match self {
            Self::Read { .. }
            | Self::Plan(_)
            | Self::Fleet(_)
            | Self::Members(_)
            | Self::Settings(_)
            | Self::Log { .. }
            | Self::Video(ExportError::Log(_) | ExportError::NoVideo)
            | Self::Replay(_)
            | Self::Report(_) => 20,
            Self::Video(ExportError::Format { .. }) | Self::OfPlans | Self::NoCommand(_) => 2,
            Self::Elsewhere(error) => error.exit_status(),
            Self::MavlinkArguments(error) => error.exit_status(),
            Self::Flight(FlightError::Address { .. })
            | Self::SelfTest(SelfTestError::Refused(Refusal::Silent | Refusal::Gone)) => 10,
            Self::SelfTest(SelfTestError::Refused(Refusal::Stopped)) => 130,
            Self::SelfTest(SelfTestError::Refused(_)) => 30,
            Self::Mock(_)
            | Self::Flight(_)
            | Self::SelfTest(_)
            | Self::PrintSettings(_)
            | Self::Picture(_)
            | Self::Video(_)
            | Self::Threads(_)
            | Self::Recording(_)
            | Self::Browser(_)
            | Self::Mavlink(_)
            | Self::Write { .. } => 1,
        }
    }
}

/// Runs the program and returns its exit status.
pub fn main() -> ExitCode {
    let arguments = Arguments::of_process();
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
        (Some(Command::Check(arguments)), _) if check_fleet::is_fleet(&arguments.plan) => {
            check_fleet::run(arguments)
        }
        (Some(Command::Check(arguments)), _) => check::run(arguments),
        (Some(Command::Fleet(arguments)), _) => fleet::run(arguments, &warnings),
        (Some(Command::Selftest(arguments)), _) => selftest::run(arguments),
        (Some(Command::Report { log, output }), _) => make_report(log, output.as_deref()),
        (Some(Command::Replay { log }), _) => replay(log),
        (Some(Command::Video { log, output }), _) => write_video(log, output.as_deref()),
        (Some(Command::Completions { shell }), _) => Ok(print_completions(*shell)),
        (Some(Command::Man { command }), _) => print_manual(command.as_deref()),
        (Some(Command::Config { config }), _) => print_settings(config.as_deref()),
        (None, flight) => fly::run(flight, &warnings),
    };
    let status = done.unwrap_or_else(|error| {
        let is_rendered = matches!(
            error,
            CommandError::Plan(_)
                | CommandError::Fleet(FleetError::Invalid(_) | FleetError::Plan(_))
        );
        let prefix = if is_rendered { "" } else { "error: " };
        terminal::print_message(format_args!("{prefix}{}", terminal::Causes(&error)));
        error.exit_status()
    });
    ExitCode::from(status)
}

fn print_settings(path: Option<&Path>) -> Result<u8, CommandError> {
    let text = match path {
        Some(_) => read_settings(path)?.to_toml()?,
        None => Settings::sample()?,
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

fn print_manual(command: Option<&str>) -> Result<u8, CommandError> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    // What names the commands' pages.
    program.build();
    let documented = match command {
        Some(name) => program.find_subcommand(name).cloned(),
        None => Some(program),
    };
    let documented = documented
        .ok_or_else(|| CommandError::NoCommand(command.unwrap_or_default().to_owned()))?;
    let mut page = Vec::new();
    // Writing to memory cannot fail.
    _ = clap_mangen::Man::new(documented).render(&mut page);
    terminal::print_own(&page);
    Ok(0)
}

/// Writes the report of a log: a page for each flight.
fn make_report(path: &Path, output: Option<&Path>) -> Result<u8, CommandError> {
    let file = read_file(path)?;
    let log = parse_log(path, &file)?;
    let pictures = recording::pictures(&file)
        .map_err(|source| CommandError::Log { path: path.display().to_string(), source })?;
    let output = output.map_or_else(|| path.with_extension("html"), Path::to_owned);
    let reports = Reports::new(&log, &pictures);
    let name = |index| report_name(&output, index, reports.count());
    for index in 0..reports.count() {
        // The pages are in the same folder.
        let link = |other| {
            let name = name(other).file_name().map(|name| name.to_string_lossy().into_owned());
            name.map(|name| address_of(&name)).unwrap_or_default()
        };
        let page = reports.html(index, link)?;
        let output = name(index);
        std::fs::write(&output, page).map_err(|source| CommandError::Write {
            what: "the report",
            path: output.display().to_string(),
            source,
        })?;
        terminal::print(format_args!("{}\n", output.display()));
    }
    Ok(0)
}

/// The file of a flight's page: of several, each has its number behind the name.
fn report_name(output: &Path, index: usize, count: usize) -> PathBuf {
    if count < 2 {
        return output.to_owned();
    }
    let mut name = output.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{}", index + 1));
    if let Some(extension) = output.extension() {
        name.push(".");
        name.push(extension);
    }
    output.with_file_name(name)
}

/// A file's name as the address of a page beside it.
fn address_of(name: &str) -> String {
    let mut address = String::from("./");
    for byte in name.bytes() {
        if byte.is_ascii_alphanumeric() || matches!(byte, b'.' | b'-' | b'_') {
            address.push(byte.into());
        } else {
            // Writing to a string cannot fail.
            _ = write!(address, "%{byte:02X}");
        }
    }
    address
}

/// Replays a log; returns 1 if today's code decides differently.
fn replay(path: &Path) -> Result<u8, CommandError> {
    let replay = Replay::new(&read_log(path)?)?;
    terminal::print(&replay);
    Ok(u8::from(!replay.is_same()))
}

/// Writes the video of a log.
fn write_video(path: &Path, output: Option<&Path>) -> Result<u8, CommandError> {
    let output = output.map_or_else(|| path.with_extension("mp4"), Path::to_owned);
    let written = video::export(&read_file(path)?, &output)?;
    terminal::print(format_args!(
        "{}: {} pictures, {:.1} s\n",
        output.display(),
        written.pictures,
        written.seconds
    ));
    Ok(0)
}

/// The content of a flight log.
fn read_file(path: &Path) -> Result<Vec<u8>, CommandError> {
    let name = || path.display().to_string();
    let mut file = Vec::new();
    // One byte more than allowed, so that a longer file is noticed.
    let most = LARGEST_FILE_BYTES as u64 + 1;
    File::open(path)
        .and_then(|opened| opened.take(most).read_to_end(&mut file))
        .map_err(|source| CommandError::Read { what: "the flight log", path: name(), source })?;
    Ok(file)
}

fn read_log(path: &Path) -> Result<Log, CommandError> {
    parse_log(path, &read_file(path)?)
}

/// The content of a flight log; one that was truncated is reported.
fn parse_log(path: &Path, file: &[u8]) -> Result<Log, CommandError> {
    let name = || path.display().to_string();
    let log = Log::read(file).map_err(|source| CommandError::Log { path: name(), source })?;
    if !log.complete {
        terminal::print_message(format_args!(
            "note: {} was cut off; what is there is read",
            name()
        ));
    }
    Ok(log)
}

fn read_settings(path: Option<&Path>) -> Result<Settings, CommandError> {
    let Some(path) = path else { return Ok(Settings::default()) };
    let text = read("the settings", path)?;
    Ok(Settings::parse(&path.display().to_string(), &text)?)
}

fn read(what: &'static str, path: &Path) -> Result<String, CommandError> {
    text_file::read(path).map_err(|source| CommandError::Read {
        what,
        path: path.display().to_string(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_page_of_several_has_a_number_and_an_address() {
        let output = Path::new("logs/a flight.html");
        assert_eq!(report_name(output, 0, 1), output);
        assert_eq!(report_name(output, 1, 3), Path::new("logs/a flight-2.html"));
        assert_eq!(report_name(Path::new("page"), 0, 2), Path::new("page-1"));
        assert_eq!(address_of("a flight-2.html"), "./a%20flight-2.html");
    }
}
