//! `asl2c`: translates an AgentSpeak agent to C.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    asl2c::command_line::run()
}
