//! The command line of `ardrone-pilot`.

mod arguments;
mod progress;
mod summary;

use std::io::{IsTerminal as _, Write as _};
use std::process::ExitCode;

use ardrone_link::DroneAddress;
use clap::Parser as _;
use mock_drone::WorldConfig;
use mock_drone::server::{MockDrone, Ports, ServerError};

use self::arguments::Arguments;
use self::progress::Progress;
use self::summary::{Summary, TrueWaypoint};
use crate::flight::{Flight, FlightError, Message};
use crate::pilot::PilotConfig;
use crate::plan::{FlightLimits, Plan, PlanError};

/// Why nothing was flown.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("cannot read the plan {path}: {source}")]
    ReadPlan { path: String, source: std::io::Error },
    #[error("{0}")]
    Plan(#[from] PlanError),
    #[error("{0}")]
    Mock(#[from] ServerError),
    #[error("{0}")]
    Flight(#[from] FlightError),
}

impl CommandError {
    fn exit_status(&self) -> u8 {
        match self {
            Self::ReadPlan { .. } | Self::Plan(_) => 20,
            Self::Flight(FlightError::Address { .. }) => 10,
            Self::Mock(_) | Self::Flight(_) => 1,
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
    let status = run(&arguments).unwrap_or_else(|error| {
        let prefix = if matches!(error, CommandError::Plan(_)) { "" } else { "error: " };
        // A message that cannot be printed has nowhere else to go.
        _ = writeln!(std::io::stderr(), "{prefix}{error}");
        error.exit_status()
    });
    ExitCode::from(status)
}

fn run(arguments: &Arguments) -> Result<u8, CommandError> {
    let limits = FlightLimits { z_origin: arguments.z_origin(), ..FlightLimits::default() };
    let plan = read_plan(arguments, &limits)?;
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
    let config = PilotConfig { limits, law: arguments.law(), ..PilotConfig::default() };
    let flight = Flight::start(plan, &config, &drone)?;
    let mut truths = Vec::new();
    for message in flight.messages() {
        if let (Message::Waypoint(waypoint), Some(mock)) = (&message, &mock) {
            truths.push(TrueWaypoint::new(waypoint, &mock.truth()));
        }
        progress.show(&message);
    }
    let finished = flight.finish()?;
    progress.end();
    // Whoever closed the pipe does not want the summary.
    _ = write!(std::io::stdout(), "{}", Summary { finished: &finished, truths: &truths });
    Ok(finished.outcome.exit_status())
}

fn read_plan(arguments: &Arguments, limits: &FlightLimits) -> Result<Plan, CommandError> {
    let path = arguments.plan.display().to_string();
    let bytes = std::fs::read(&arguments.plan)
        .map_err(|source| CommandError::ReadPlan { path: path.clone(), source })?;
    // Bytes that are no UTF-8 become characters that no command contains.
    let text = String::from_utf8_lossy(&bytes);
    Ok(Plan::parse_within(&path, &text, limits)?)
}

fn drone_address(arguments: &Arguments, mock: Option<&MockDrone>) -> DroneAddress {
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
