//! `ardrone-pilot`: flies an AR.Drone 2.0 along a plan.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ardrone_pilot::cli::main()
}
