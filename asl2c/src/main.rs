//! `asl2c`: translates an AgentSpeak agent to C.
#![forbid(unsafe_code)]

use std::process::ExitCode;

use mimalloc::MiMalloc;

/// Programs and trees are many small allocations: with the system's allocator the language server needs twice as long
/// for each keystroke.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    asl2c::command_line::run()
}
