//! `cargo xtask`: measurements of the whole system.
#![forbid(unsafe_code)]

mod cases;
mod fly;
mod plot;
mod score;
mod table;

use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Measurements of the whole system, in simulated time.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Fly plans on every airframe, by both laws, with many seeds, and tell how well it went
    Fly {
        /// Seeds of each plan on each airframe, from 1
        #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=10_000))]
        seeds: u64,
        /// Write one line a flight to this file
        #[arg(long, value_name = "FILE")]
        csv: Option<PathBuf>,
        /// Write plots (SVG) to this folder
        #[arg(long, value_name = "FOLDER")]
        plots: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    let Command::Fly { seeds, csv, plots } = Arguments::parse().command;
    #[allow(clippy::disallowed_methods, reason = "how long it takes is what a person sees")]
    let start = std::time::Instant::now();
    // What cannot be printed has nowhere else to go.
    match fly::run(seeds, csv.as_deref(), plots.as_deref()) {
        Ok(table) => {
            let seconds = start.elapsed().as_secs_f64();
            _ = writeln!(std::io::stdout(), "{table}flown in {seconds:.1} s");
            ExitCode::SUCCESS
        }
        Err(error) => {
            _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}
