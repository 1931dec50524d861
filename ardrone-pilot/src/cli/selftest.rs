//! `ardrone-pilot selftest`: what is assumed of a drone's firmware, asked of one on the ground.

use ardrone_link::selftest::{Check, Outcome, examine};
use autopilot::plan::ZOrigin;
use autopilot::vehicle::VehicleConfig;
use mock_drone::server::{MockDrone, Ports};
use serde_json::json;

use super::arguments::ExamineDrone;
use super::fly::{drone_address, mock_address};
use super::{CommandError, read_settings, terminal};
use crate::flight::{FlightError, resolve};
use crate::selftest::{SelfTestError, Sockets};
use crate::simulation;

/// The drone differs from what is assumed of it.
const DIFFERS: u8 = 70;

/// Examines the drone; returns the exit status.
pub(super) fn run(arguments: &ExamineDrone) -> Result<u8, CommandError> {
    let settings = read_settings(arguments.config.as_deref())?;
    // The video's bit rate needs a configuration of one's own on the drone, which is not made for an examination.
    let config = VehicleConfig { video_kbit_s: None, ..settings.pilot_config(ZOrigin::Hover) };
    let wanted = config.drone_settings().map_err(FlightError::Config)?;
    let mock = if arguments.drone.mock {
        let ports = Ports { video: Some(0), ftp: Some(0), ..Ports::LOOPBACK };
        Some(MockDrone::start(&simulation::world(&config, None), ports)?)
    } else {
        None
    };
    let ports = mock.as_ref().map(MockDrone::ports);
    let address = mock.as_ref().map_or_else(|| drone_address(&arguments.drone), mock_address);
    let video_port = ports.and_then(|ports| ports.video).unwrap_or(arguments.drone.video_port);
    let ftp_port = ports.and_then(|ports| ports.ftp).unwrap_or(arguments.ftp_port);
    terminal::print_message(format_args!(
        "examining the drone at {}: its motors stay off; about 25 s",
        address.host
    ));
    let mut drone = Sockets::open(resolve(&address.host)?, &address, video_port, ftp_port)?;
    let report = examine(&mut drone, &wanted, &mut |check| {
        if arguments.json {
            terminal::print_object(&object(check));
        } else {
            terminal::print(line(check));
        }
    });
    let report = report.map_err(SelfTestError::Refused).inspect_err(|error| {
        if arguments.json {
            terminal::print_object(&json!({ "type": "end", "error": error.to_string() }));
        }
    })?;
    let status = if report.is_as_assumed() { 0 } else { DIFFERS };
    let count = |wanted: &str| {
        report.checks.iter().filter(|check| word(&check.outcome).1 == wanted).count()
    };
    let [hold, differ, unasked] = ["holds", "differs", "not-asked"].map(count);
    if arguments.json {
        terminal::print_object(&json!({
            "type": "end", "hold": hold, "differ": differ, "not_asked": unasked, "exit_status": status,
        }));
    } else {
        terminal::print(format!("{hold} hold, {differ} differ, {unasked} not asked\n"));
    }
    Ok(status)
}

/// For people and for programs.
fn word(outcome: &Outcome) -> (&'static str, &'static str) {
    match outcome {
        Outcome::Holds(_) => ("holds", "holds"),
        Outcome::Differs(_) => ("DIFFERS", "differs"),
        Outcome::NotAsked(_) => ("not asked", "not-asked"),
    }
}

fn seen(check: &Check) -> &str {
    match &check.outcome {
        Outcome::Holds(seen) | Outcome::Differs(seen) | Outcome::NotAsked(seen) => seen,
    }
}

fn line(check: &Check) -> String {
    format!("{:10}{}\n          {}\n", word(&check.outcome).0, check.assumption, seen(check))
}

fn object(check: &Check) -> serde_json::Value {
    json!({
        "type": "check",
        "assumption": check.assumption.name(),
        "text": check.assumption.to_string(),
        "outcome": word(&check.outcome).1,
        "seen": seen(check),
    })
}
