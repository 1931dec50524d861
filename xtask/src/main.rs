//! `cargo xtask`: measurements of the whole system.
#![forbid(unsafe_code)]

mod campaign;
mod case;
mod cases;
mod command_line;
mod compare;
mod cross_checks;
mod edit;
mod figures;
mod files;
mod fleets;
mod fly;
mod healthy;
mod job;
mod mavlink;
mod mutants;
mod parallel;
mod plot;
mod rules;
mod score;
mod sensors;
mod soak;
mod streams;
mod table;
mod tags;
mod target;
mod verify;

fn main() -> std::process::ExitCode {
    command_line::main()
}
