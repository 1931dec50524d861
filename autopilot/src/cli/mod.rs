//! The command line of `ardrone-pilot`.

mod arguments;
mod check;
mod keys;
mod progress;
mod summary;

use std::io::{IsTerminal as _, Write as _};
use std::path::Path;
use std::process::ExitCode;

use ardrone_link::DroneAddress;
use clap::Parser as _;
use mock_drone::WorldConfig;
use mock_drone::server::{MockDrone, Ports, ServerError};

use self::arguments::{Arguments, Command, Fly};
use self::keys::Keys;
use self::progress::Progress;
use self::summary::{Summary, TrueWaypoint};
use crate::flight::{Flight, FlightError, Message};
use crate::picture::PictureError;
use crate::plan::{FlightLimits, Plan, PlanError};
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
    #[error("{0}")]
    Picture(#[from] PictureError),
    #[error("{0}")]
    Mock(#[from] ServerError),
    #[error("{0}")]
    Flight(#[from] FlightError),
}

impl CommandError {
    fn exit_status(&self) -> u8 {
        match self {
            Self::Read { .. } | Self::Plan(_) | Self::Settings(_) => 20,
            Self::Flight(FlightError::Address { .. }) => 10,
            Self::Mock(_)
            | Self::Flight(_)
            | Self::PrintSettings(_)
            | Self::Picture(_)
            | Self::Write { .. } => 1,
        }
    }
}

/// Runs the program and returns its exit status.
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_max_level(tracing::Level::WARN)
        .with_ansi(std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none())
        .with_target(false)
        .without_time()
        .log_internal_errors(false)
        .init();
    let done = match (&arguments.command, &arguments.fly) {
        (Some(Command::Check(arguments)), _) => check::run(arguments),
        (Some(Command::Config { config }), _) => print_settings(config.as_deref()),
        (None, Some(flight)) => fly(flight),
        // The parser demands a plan where there is no command.
        (None, None) => Ok(2),
    };
    let status = done.unwrap_or_else(|error| {
        let prefix = if matches!(error, CommandError::Plan(_)) { "" } else { "error: " };
        // A message that cannot be printed has nowhere else to go.
        _ = writeln!(std::io::stderr(), "{prefix}{error}");
        error.exit_status()
    });
    ExitCode::from(status)
}

fn print_settings(path: Option<&Path>) -> Result<u8, CommandError> {
    let text = match path {
        Some(_) => read_settings(path)?.to_toml()?,
        None => settings::DEFAULTS.to_owned(),
    };
    // Whoever closed the pipe does not want the settings.
    _ = write!(std::io::stdout(), "{text}");
    Ok(0)
}

fn fly(arguments: &Fly) -> Result<u8, CommandError> {
    let mut settings = read_settings(arguments.config.as_deref())?;
    if let Some(law) = arguments.law() {
        settings.set_law(law);
    }
    let config = settings.pilot_config(arguments.z_origin());
    let plan = read_plan(arguments, &config.limits)?;
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
    let flight = Flight::start(plan, &config, &drone)?;
    let keys = Keys::start(flight.controls());
    if keys.is_some() {
        progress.say(keys::HELP);
    }
    let mut truths = Vec::new();
    for message in flight.messages() {
        if let (Message::Waypoint(waypoint), Some(mock)) = (&message, &mock) {
            truths.push(TrueWaypoint::new(waypoint, &mock.truth()));
        }
        progress.show(&message);
    }
    drop(keys);
    let finished = flight.finish()?;
    progress.end();
    // Whoever closed the pipe does not want the summary.
    _ = write!(std::io::stdout(), "{}", Summary { finished: &finished, truths: &truths });
    if arguments.timing {
        _ = write!(std::io::stdout(), "{}", TimingReport(&finished.ticks));
    }
    Ok(finished.outcome.exit_status())
}

fn read_settings(path: Option<&Path>) -> Result<Settings, CommandError> {
    let Some(path) = path else { return Ok(Settings::default()) };
    let text = read("the settings", path)?;
    Ok(Settings::parse(&path.display().to_string(), &text)?)
}

fn read_plan(arguments: &Fly, limits: &FlightLimits) -> Result<Plan, CommandError> {
    let text = read("the plan", &arguments.plan)?;
    Ok(Plan::parse_within(&arguments.plan.display().to_string(), &text, limits)?)
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
