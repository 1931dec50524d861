//! `mock-drone`: a simulated AR.Drone 2.0 on the drone's own ports.
#![forbid(unsafe_code)]

use std::io::{IsTerminal as _, Write as _};
use std::net::{IpAddr, Ipv4Addr};
use std::process::ExitCode;

use ardrone_link::{AT_PORT, CONTROL_PORT, NAVDATA_PORT};
use clap::{Parser, ValueEnum};
use mock_drone::DroneConfig;
use mock_drone::sensors::SensorModel;
use mock_drone::server::{Ports, Server, ServerError};

/// A simulated AR.Drone 2.0: any client of the real drone can fly it.
///
/// It boots, waits to be configured, takes off, flies, lands and runs out of battery like the real
/// one, and loses patience with a silent pilot like the real one. It runs until it is killed.
#[derive(Debug, Parser)]
#[command(version, after_help = "Exit status: 1 a port is taken or a socket failed, 2 usage.")]
struct Arguments {
    /// Address to listen on
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    bind: IpAddr,
    /// UDP port for AT commands
    #[arg(long, value_name = "PORT", default_value_t = AT_PORT)]
    at_port: u16,
    /// UDP port for navdata
    #[arg(long, value_name = "PORT", default_value_t = NAVDATA_PORT)]
    navdata_port: u16,
    /// TCP port for the configuration
    #[arg(long, value_name = "PORT", default_value_t = CONTROL_PORT)]
    control_port: u16,
    /// Everything random follows from this number
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Charge at the start, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 90, value_parser = clap::value_parser!(u8).range(0..=100))]
    battery: u8,
    /// How good the drone's sensors are
    #[arg(long, value_enum, default_value_t = Sensors::Nominal)]
    sensors: Sensors,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Sensors {
    /// A good room: some noise, delay and drift
    Nominal,
    /// No noise, no delay, no drift
    Perfect,
}

fn main() -> ExitCode {
    // Whoever closed the pipe does not want the log; the drone lives on.
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none())
        .with_target(false)
        .log_internal_errors(false)
        .init();
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // A message that cannot be printed has nowhere else to go.
            _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), ServerError> {
    let config = DroneConfig {
        seed: arguments.seed,
        battery_percent: f64::from(arguments.battery),
        sensors: match arguments.sensors {
            Sensors::Nominal => SensorModel::nominal(),
            Sensors::Perfect => SensorModel::perfect(),
        },
        ..DroneConfig::default()
    };
    let ports = Ports {
        host: arguments.bind,
        at: arguments.at_port,
        navdata: arguments.navdata_port,
        control: arguments.control_port,
    };
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    runtime.block_on(async {
        let server = Server::bind(&config, ports).await?;
        let bound = server.ports()?;
        tracing::info!(
            "mock drone on {}: AT {}/udp, navdata {}/udp, configuration {}/tcp",
            bound.host,
            bound.at,
            bound.navdata,
            bound.control
        );
        server.run().await?;
        Ok(())
    })
}
