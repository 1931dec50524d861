//! The command line: builds a drone from the arguments and serves it until it is stopped.

mod arguments;

use std::fs::File;
use std::io::{IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use clap::{CommandFactory as _, Parser as _};
use nalgebra::Vector2;
use tokio::signal::unix::{SignalKind, signal};

use self::arguments::{
    Airframe, Arguments, Command, DroneArguments, Option27, PortArguments, Sensors,
};
use crate::airframe::Profile;
use crate::scenario::{Scenario, ScenarioError};
use crate::sensors::SensorModel;
use crate::server::{Ports, Server, ServerError};
use crate::{CameraModel, DroneConfig, LinkFaults, Tag27, TruthLog, WorldConfig};

/// Errors of the program.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("cannot {action} {}: {source}", path.display())]
    File { action: &'static str, path: PathBuf, source: std::io::Error },
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    #[error(transparent)]
    Server(#[from] ServerError),
    #[error("there is no command `{0}`")]
    NoCommand(String),
    #[error("cannot print: {0}")]
    Print(#[source] std::io::Error),
}

/// Runs the program until it is stopped. Returns its exit status.
pub fn run() -> ExitCode {
    // A closed pipe ends the log, not the drone.
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none())
        .with_target(false)
        .log_internal_errors(false)
        .init();
    let arguments = Arguments::parse();
    let done = match &arguments.command {
        Some(command) => print(command),
        None => serve(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // The diagnostics of a scenario need no prefix.
            let scenario = matches!(error, CommandError::Scenario(_));
            let prefix = if scenario { "" } else { "error: " };
            // There is no other channel for a message that cannot be printed.
            _ = writeln!(std::io::stderr(), "{prefix}{error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints what a subcommand asks for.
fn print(command: &Command) -> Result<(), CommandError> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    let text = match command {
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut program, "mock-drone", &mut script);
            script
        }
        Command::Man { command } => manual(program, command.as_deref())?,
    };
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(&text).and_then(|()| stdout.flush()).map_err(CommandError::Print)
}

/// The manual page of the program, or of one of its commands.
fn manual(mut program: clap::Command, command: Option<&str>) -> Result<Vec<u8>, CommandError> {
    // What names the commands' pages.
    program.build();
    let documented = match command {
        Some(name) => program.find_subcommand(name).cloned(),
        None => Some(program),
    };
    let documented = documented
        .ok_or_else(|| CommandError::NoCommand(command.unwrap_or_default().to_owned()))?;
    let mut page = Vec::new();
    clap_mangen::Man::new(documented).render(&mut page).map_err(CommandError::Print)?;
    Ok(page)
}

fn serve(arguments: &Arguments) -> Result<(), CommandError> {
    let config = world(arguments)?;
    let log = arguments.truth.as_ref().map(|path| truth_log(path)).transpose()?;
    let PortArguments { bind, at_port, navdata_port, control_port, .. } = arguments.ports;
    let ports = Ports {
        host: bind,
        at: at_port,
        navdata: navdata_port,
        control: control_port,
        ftp: Some(arguments.ports.ftp_port),
        video: Some(arguments.ports.video_port),
        presence: arguments.ports.presence_port,
    };
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(ServerError::Start)?;
    runtime.block_on(async {
        let mut server = Server::bind(&config, ports).await?;
        if let Some(log) = log {
            server.log_truth(log);
        }
        if arguments.video_clock {
            server.show_video_clock();
        }
        let bound = server.ports().map_err(ServerError::Start)?;
        tracing::info!(
            "mock drone on {}: AT {}/udp, navdata {}/udp, configuration {}/tcp",
            bound.host,
            bound.at,
            bound.navdata,
            bound.control
        );
        tokio::select! {
            ended = server.run() => ended.map_err(ServerError::Start)?,
            // The truth log is written out when the server is dropped.
            () = stopped() => tracing::info!("stopped"),
        }
        Ok(())
    })
}

/// Waits for SIGINT or SIGTERM.
async fn stopped() {
    let terminated = async {
        match signal(SignalKind::terminate()) {
            Ok(mut signal) => _ = signal.recv().await,
            // Without the handler, the signal ends the program.
            Err(_) => std::future::pending().await,
        }
    };
    tokio::select! {
        _ = tokio::signal::ctrl_c() => {}
        () = terminated => {}
    }
}

fn world(arguments: &Arguments) -> Result<WorldConfig, CommandError> {
    let DroneArguments { seed, battery, airframe, sensors, option_27, ref wind, gusts, .. } =
        arguments.drone;
    let drone = DroneConfig {
        seed,
        battery_percent: f64::from(battery),
        battery_sag_percent: arguments.drone.battery_sag,
        flies_at_m: arguments.drone.flies_at,
        profile: match airframe {
            Airframe::Rec => Profile::rec(),
            Airframe::Tum => Profile::tum(),
            Airframe::Tf => Profile::tf(),
            Airframe::Leo => Profile::leo(),
        },
        sensors: match sensors {
            Sensors::Perfect => SensorModel::perfect(),
            Sensors::Nominal => SensorModel::nominal(),
            Sensors::Hard => SensorModel::hard(),
        },
        camera: match sensors {
            Sensors::Perfect => CameraModel::perfect(),
            Sensors::Nominal => CameraModel::nominal(),
            Sensors::Hard => CameraModel::hard(),
        },
        tag_27: match option_27 {
            Option27::Absent => Tag27::Absent,
            Option27::Zimmu => Tag27::Zimmu,
            Option27::Gps => Tag27::Gps,
        },
        wind_m_s: match wind.as_deref() {
            Some([right, forward]) => Vector2::new(*right, *forward),
            _ => Vector2::zeros(),
        },
        gusts_m_s: gusts,
        lies: arguments.faults.lie.iter().copied().collect(),
        ..DroneConfig::default()
    };
    let faults = &arguments.faults;
    let link = LinkFaults {
        loss: faults.loss / 100.0,
        duplication: faults.duplicate / 100.0,
        reordering: faults.reorder / 100.0,
        corruption: faults.corrupt / 100.0,
        delay: Duration::from_millis(faults.delay.into()),
        jitter: Duration::from_millis(faults.jitter.into()),
    };
    let scenario = match &faults.scenario {
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(|source| CommandError::File {
                action: "read",
                path: path.clone(),
                source,
            })?;
            Scenario::parse(&path.display().to_string(), &text)?
        }
        None => Scenario::default(),
    };
    let tags = arguments.drone.tag.clone();
    Ok(WorldConfig { drone, link, scenario, tags, ..WorldConfig::default() })
}

fn truth_log(path: &Path) -> Result<TruthLog<File>, CommandError> {
    File::create(path).and_then(TruthLog::new).map_err(|source| CommandError::File {
        action: "write",
        path: path.to_owned(),
        source,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn manual_pages_say_what_the_help_says() {
        let page = |command| manual(Arguments::command(), command).map(String::from_utf8);
        let of_program = page(None).unwrap().unwrap();
        assert!(of_program.contains(".TH mock-drone 1") && of_program.contains("Scenario files"));
        assert!(page(Some("man")).unwrap().unwrap().contains(".TH mock-drone-man 1"));
        assert!(matches!(page(Some("fly")), Err(CommandError::NoCommand(_))));
    }

    #[test]
    fn a_drone_is_not_asked_for_with_a_subcommand() {
        assert!(Arguments::try_parse_from(["mock-drone", "completions", "zsh"]).is_ok());
        assert!(Arguments::try_parse_from(["mock-drone", "--seed", "2", "man"]).is_err());
    }
}
