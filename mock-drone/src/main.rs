//! `mock-drone`: a simulated AR.Drone 2.0 on the drone's own ports.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    mock_drone::command_line::run()
}
