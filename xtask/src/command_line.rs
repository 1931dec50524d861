//! The command line of `cargo xtask`.

use std::error::Error;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand, ValueEnum};
use system_tests::airframes::Airframes;

use crate::{
    campaign, case, compare, cross_checks, figures, fleets, fly, healthy, mavlink, mutants, rules,
    sensors, soak, streams, tags, target, verify,
};

/// Measurements of the whole system, in simulated time.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

/// Which airframes fly, by the words of the command line.
#[derive(Debug, Clone, Copy, Default, ValueEnum)]
enum AirframesArgument {
    /// The four published ones
    #[default]
    Published,
    /// Others: each parameter drawn by the seed within 40 % of that of a published one
    Any,
}

impl From<AirframesArgument> for Airframes {
    fn from(airframes: AirframesArgument) -> Self {
        match airframes {
            AirframesArgument::Published => Self::Published,
            AirframesArgument::Any => Self::Any,
        }
    }
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Fly plans on every airframe, with many seeds, and report how well it went
    Fly {
        /// Seeds of each plan on each airframe, from 1
        #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=10_000))]
        seeds: u64,
        /// Write one line per flight to this file
        #[arg(long, value_name = "FILE")]
        csv: Option<PathBuf>,
        /// Write plots (SVG) to this folder
        #[arg(long, value_name = "FOLDER")]
        plots: Option<PathBuf>,
    },
    /// Fly with random faults, and report how each flight ended; fails if anything happened that must not
    Campaign {
        /// How many flights
        #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = clap::value_parser!(u64).range(1..))]
        flights: u64,
        /// The first seed; each further flight takes the next one
        #[arg(long, value_name = "SEED", default_value_t = 1)]
        first: u64,
        /// Which airframes fly
        #[arg(long, value_name = "WHICH", value_enum, default_value_t)]
        airframe: AirframesArgument,
    },
    /// Fly healthy drones on links that lose and delay datagrams, above boxes and in gusts, and tell which were landed
    /// without need; fails if more than one in a thousand was
    Healthy {
        /// How many flights
        #[arg(long, value_name = "N", default_value_t = 2_000, value_parser = clap::value_parser!(u64).range(1..))]
        flights: u64,
        /// The first seed; each further flight takes the next one
        #[arg(long, value_name = "SEED", default_value_t = 1)]
        first: u64,
        /// Which airframes fly
        #[arg(long, value_name = "WHICH", value_enum, default_value_t)]
        airframe: AirframesArgument,
    },
    /// Fly with one wrong sensor at a time, and report how far that led the drone astray; fails if it was too
    /// far
    Sensors {
        /// Seeds of each failure in each situation on each airframe, from 1
        #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(0..=1_000))]
        seeds: u64,
        /// How many random failures besides
        #[arg(long, value_name = "N", default_value_t = 1000)]
        random: u64,
        /// Number of the first random failure
        #[arg(long, value_name = "NUMBER", default_value_t = 1)]
        first: u64,
        /// Of the listed failures only those with this in their name
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
        /// Which airframes fly
        #[arg(long, value_name = "WHICH", value_enum, default_value_t)]
        airframe: AirframesArgument,
        /// Write one line for each flight to this file
        #[arg(long, value_name = "FILE")]
        csv: Option<PathBuf>,
    },
    /// Compare the same flights of two builds, as `sensors --csv` writes them; fails if a judged row has more that led too
    /// far
    Compare {
        /// File of the build before
        before: PathBuf,
        /// File of the build after
        after: PathBuf,
    },
    /// Give random streams of orders, 1 to 400 each second, and report how far they led the drone; fails if one led
    /// outside the fence, or further than a single order does
    Streams {
        /// How many streams; every fourth is for the same airframe
        #[arg(long, value_name = "N", default_value_t = 4_000, value_parser = clap::value_parser!(u64).range(1..))]
        streams: u64,
        /// The first seed; each further stream takes the next one
        #[arg(long, value_name = "SEED", default_value_t = 1)]
        first: u64,
    },
    /// Fly several vehicles in one room, with faults of all kinds, and report how near they came to each other; fails if two came
    /// too near, one stayed up, or one that meets others on purpose did not arrive
    Fleets(fleets::Request),
    /// Fly where tags or a GPS know the place too, with a right velocity and a wrong one, and report how often they
    /// contradicted it; fails if they contradicted a right one
    CrossChecks {
        /// How many flights of each case
        #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u64).range(1..))]
        flights: u64,
        /// The first seed; each further flight takes the next one
        #[arg(long, value_name = "SEED", default_value_t = 1)]
        first: u64,
    },
    /// Hover and fly over tags on the floor, and tell how well the pilot knows where it is; fails if that is not
    /// as good as it must be
    Tags {
        /// Seeds of each case, nominal and hard, from 1
        #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1_000))]
        seeds: u64,
        /// Only cases with this in their name
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
        /// One line for each flight too
        #[arg(long)]
        each: bool,
    },
    /// Fly code with mistakes in it through the campaign; fails if it finds nothing wrong with one of them
    Mutants {
        /// At most this many flights with each
        #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..))]
        flights: u64,
        /// Instead, mutants of what keeps vehicles apart, and at most this many random fleets with each
        #[arg(long, value_name = "N", conflicts_with = "flights", value_parser = clap::value_parser!(u64).range(1..))]
        fleets: Option<u64>,
        /// Only mutants with this in their name
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
        /// Instead, all mutants that cargo-mutants generates, against the tests in simulated time: takes
        /// hours
        #[arg(long, conflicts_with_all = ["flights", "fleets", "only"])]
        all: bool,
        /// A part of those, such as 0/20
        #[arg(long, value_name = "K/N", requires = "all")]
        shard: Option<String>,
    },
    /// Fly where a single rule keeps the drone safe, and list what did not end as it must
    Rules,
    /// Fly the pilot without one piece of evidence against its sensors after the other, with failing sensors, with healthy
    /// ones and for the rules; fails if one is not missed
    Ablation {
        /// Seeds of each failure in each situation on each airframe
        #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(0..=1_000))]
        seeds: u64,
        /// How many random failures besides
        #[arg(long, value_name = "N", default_value_t = 1000)]
        random: u64,
        /// How many healthy flights
        #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u64).range(1..))]
        healthy: u64,
        /// Only pieces with this in their name
        #[arg(long, value_name = "TEXT")]
        only: Option<String>,
    },
    /// Fly over UDP, as processes, with random faults, signals, floods and closed output; fails if a
    /// drone was left in the air
    Soak(soak::Arguments),
    /// Prove the properties of the shipped agent on a model and on its C, and measure what tests exercise
    Verify {
        /// Only the proofs, which is all that the shipped agent needs: no mutants, no coverage, no other
        /// agent, no report
        #[arg(long)]
        only_proofs: bool,
        /// Build and run no tests: read what those have counted that are built in this target folder, with
        /// `AGENT_COVERAGE` set, once `target/coverage.lock` is free
        #[arg(long, value_name = "DIR", conflicts_with = "only_proofs")]
        counted: Option<PathBuf>,
    },
    /// Compile the gallery's agents and the shipped one for a Cortex-M4, measure that code, and compare its trace under
    /// QEMU with this machine's; fails if one differs or exceeds its bounds
    Target,
    /// Generate the code of the MAVLink dialect from its XML; it is checked in
    Mavlink(mavlink::Arguments),
    /// Measure what is promised, and compare it with what was recorded last (`docs/figures.json`); fails if anything was lost
    Figures(figures::Arguments),
    /// Check the safety case (`docs/safety-case.md`), and write its drawing
    Case(case::Arguments),
}

/// Runs the command and returns the exit status.
pub(crate) fn main() -> ExitCode {
    #[allow(clippy::disallowed_methods, reason = "how long it takes is what a person sees")]
    let start = std::time::Instant::now();
    // If printing fails there is nowhere else to report it.
    match run(Arguments::parse().command, start) {
        Ok((table, good)) => {
            let seconds = start.elapsed().as_secs_f64();
            _ = writeln!(std::io::stdout(), "{table}done in {seconds:.1} s");
            if good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(error) => {
            _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// What a command prints, and whether all was as it must be.
fn run(command: Command, start: std::time::Instant) -> Result<(String, bool), Box<dyn Error>> {
    Ok(match command {
        Command::Fly { seeds, csv, plots } => {
            let (table, flown) = fly::run(seeds, csv.as_deref(), plots.as_deref())?;
            let flown_s = flown.as_secs_f64();
            let times = flown_s / start.elapsed().as_secs_f64();
            (format!("{table}{flown_s:.0} s flown, {times:.0} times as fast as real\n"), true)
        }
        Command::Campaign { flights, first, airframe } => {
            campaign::run(airframe.into(), flights, first)?
        }
        Command::Healthy { flights, first, airframe } => {
            healthy::run(airframe.into(), flights, first)?
        }
        Command::Sensors { seeds, random, first, only, airframe, csv } => {
            let randoms = first..first.saturating_add(random);
            let request = sensors::Request { airframes: airframe.into(), seeds, only, randoms };
            let report = sensors::run(&request)?;
            if let Some(path) = csv {
                compare::write(&path, &report.lines)?;
            }
            let good = report.is_good();
            (report.text, good)
        }
        Command::Compare { before, after } => compare::run(&before, &after)?,
        Command::Streams { streams, first } => streams::run(streams, first)?,
        Command::Fleets(request) => fleets::run(&request)?,
        Command::CrossChecks { flights, first } => cross_checks::run(flights, first)?,
        Command::Tags { seeds, only, each } => tags::run(seeds, only.as_deref(), each)?,
        Command::Mutants { all: true, shard, .. } => mutants::all(shard.as_deref())?,
        Command::Mutants { fleets: Some(fleets), only, .. } => {
            mutants::by_hand(mutants::Judge::Fleets(fleets), only.as_deref())?
        }
        Command::Mutants { flights, only, .. } => {
            mutants::by_hand(mutants::Judge::Flights(flights), only.as_deref())?
        }
        Command::Rules => rules::run()?,
        Command::Ablation { seeds, random, healthy, only } => {
            let flights = mutants::ablation::Flights { seeds, random, healthy };
            mutants::ablation::run(flights, only.as_deref())?
        }
        Command::Soak(arguments) => soak::run(&arguments)?,
        Command::Verify { only_proofs: true, .. } => verify::proofs()?,
        Command::Verify { counted, .. } => verify::run(counted.as_deref())?,
        Command::Target => target::run()?,
        Command::Mavlink(arguments) => mavlink::run(&arguments)?,
        Command::Figures(arguments) => figures::run(&arguments)?,
        Command::Case(arguments) => case::run(&arguments)?,
    })
}
