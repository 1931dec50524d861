//! Fleets in one simulated time: a table of how near their vehicles came to each other and of what went wrong with them, and each
//! fleet of which something is bad.

mod table;

use std::fmt::Write as _;
use std::ops::RangeInclusive;
use std::time::Duration;

use autopilot::vehicle::CannotFly;
use system_tests::fleet::{Fleet, FleetFlight, corridor, crossing, liar, take_off};
use system_tests::tick_times;

use self::table::Table;
use crate::parallel;

/// Longest flight.
const LIMIT: Duration = Duration::from_mins(4);
/// Vehicles of a crossing start this far from the point through which all fly.
const RADIUS_M: f64 = 3.0;
const CROSSING: RangeInclusive<usize> = 2..=6;
/// Of the meetings there is one of each kind for so many random fleets.
const RANDOM_FOR_ONE: u64 = 5;
/// Random fleets that are flown before anything is looked at.
const AT_ONCE: u64 = 50;
/// Other vehicles beside which the time of a tick is measured.
const OTHERS: [u8; 3] = [1, 4, 19];

/// Which fleets are flown.
#[derive(Debug, Clone, clap::Args)]
pub(crate) struct Request {
    /// How many random fleets, and a fifth as many corridors, take-offs and crossings of each of two to six
    #[arg(long, value_name = "N", default_value_t = 1_000, value_parser = clap::value_parser!(u64).range(1..))]
    fleets: u64,
    /// The first seed; each further fleet takes the next one
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    first: u64,
    /// Only until one is bad, which is all that is printed: how `mutants --fleets` judges
    #[arg(long)]
    until_bad: bool,
}

/// A kind of fleets, each of which follows from its seed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Random,
    Corridor,
    TakeOff,
    Liar,
    Crossing(usize),
}

impl Kind {
    fn all() -> impl Iterator<Item = Self> {
        [Self::Random, Self::Corridor, Self::TakeOff, Self::Liar]
            .into_iter()
            .chain(CROSSING.map(Self::Crossing))
    }

    /// Whether it is of interest how long it takes: only that of those whose ways are in each other's way.
    fn is_timed(self) -> bool {
        matches!(self, Self::Crossing(_))
    }

    fn fleet(self, seed: u64) -> Fleet {
        match self {
            Self::Random => Fleet::random(seed),
            Self::Corridor => corridor(seed),
            Self::TakeOff => take_off(seed),
            Self::Liar => liar(seed),
            Self::Crossing(count) => crossing(count, RADIUS_M, seed),
        }
    }

    /// What is bad, if anything is.
    fn bad(self, flight: &FleetFlight) -> Option<String> {
        if !flight.is_down {
            return Some("not all on the ground at the end".to_owned());
        }
        if !flight.keeps_apart() {
            return flight.least.judged.map(|near| near.to_string());
        }
        let must_arrive = !matches!(self, Self::Random | Self::Liar);
        let stayed = || flight.members.iter().position(|member| !member.is_complete());
        let number = stayed().filter(|_| must_arrive)?;
        let outcome = flight.members[number].outcome.as_ref();
        let outcome = outcome.map_or_else(|| "no end".to_owned(), ToString::to_string);
        Some(format!("vehicle {} has not flown its plan: {outcome}", number + 1))
    }
}

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Random => f.write_str("random"),
            Self::Corridor => f.write_str("corridor"),
            Self::TakeOff => f.write_str("take-off"),
            Self::Liar => f.write_str("liar"),
            Self::Crossing(count) => write!(f, "crossing-of-{count}"),
        }
    }
}

/// Flies random fleets, and a fifth as many meetings of each kind; returns the report, and whether all kept apart and came
/// down, and all that met on purpose arrived. Of a single fleet it tells what happened.
pub(crate) fn run(request: &Request) -> Result<(String, bool), CannotFly> {
    let Request { fleets, first, until_bad } = request;
    let end = first.saturating_add(*fleets);
    let mut table = Table::default();
    let mut begin = *first;
    while begin < end {
        let next = begin.saturating_add(AT_ONCE).min(end);
        let bad = fly(begin..next, *first, &mut table)?;
        if let Some(line) = bad.first().filter(|_| *until_bad) {
            return Ok((format!("{line}\n"), false));
        }
        begin = next;
    }
    if *until_bad {
        return Ok((String::new(), true));
    }
    let mut text = table.to_string();
    if *fleets == 1 {
        text += &story(*first)?;
    } else {
        text += &tick_times::report(&OTHERS)?;
    }
    Ok((text, table.is_good()))
}

/// Flies those of some seeds; returns what is bad, a line for each.
fn fly(
    seeds: std::ops::Range<u64>,
    first: u64,
    table: &mut Table,
) -> Result<Vec<String>, CannotFly> {
    let is_flown = |kind: Kind, seed: u64| {
        kind == Kind::Random || (seed - first).is_multiple_of(RANDOM_FOR_ONE)
    };
    let jobs: Vec<(Kind, u64)> = Kind::all()
        .flat_map(|kind| seeds.clone().map(move |seed| (kind, seed)))
        .filter(|(kind, seed)| is_flown(*kind, *seed))
        .collect();
    let flown = parallel::map(&jobs, |(kind, seed)| {
        let fleet = kind.fleet(seed);
        Ok::<_, CannotFly>((fleet.fly(LIMIT)?, kind.is_timed().then(|| alone(&fleet)).transpose()?))
    })?;
    let mut lines = Vec::new();
    for ((kind, seed), (flight, alone)) in jobs.into_iter().zip(&flown) {
        let bad = kind.bad(flight).map(|what| {
            let had: Vec<&str> = flight.kinds.iter().copied().collect();
            format!("{kind}:{seed}: {what}; {}", had.join(", "))
        });
        table.add(kind, seed, flight, bad.as_deref());
        if let Some(alone) = alone {
            table.add_alone(kind, flight, *alone);
        }
        lines.extend(bad);
    }
    Ok(lines)
}

/// When the last one would be down if each had the room for itself: no way of keeping apart is faster.
fn alone(fleet: &Fleet) -> Result<Duration, CannotFly> {
    let mut last = Duration::ZERO;
    for member in &fleet.members {
        let alone = Fleet { members: vec![member.clone()], ..Fleet::default() };
        last = last.max(alone.fly(LIMIT)?.duration());
    }
    Ok(last)
}

/// What happened to the random fleet of a seed.
fn story(seed: u64) -> Result<String, CannotFly> {
    let fleet = Fleet::random(seed);
    let mut text = format!("\n{}\n", fleet.circumstances().join("\n"));
    let flight = fleet.fly(LIMIT)?;
    for (member, number) in flight.members.iter().zip(1..) {
        // Writing to a string cannot fail.
        _ = writeln!(
            text,
            "vehicle {number}: {:?} after {:.1} s",
            member.outcome,
            member.ended.as_secs_f64()
        );
        for (at, event) in &member.events {
            _ = writeln!(text, "  {:.2} s: {event:?}", at.as_secs_f64());
        }
    }
    let least = flight.least;
    for (what, near) in
        [("", least.judged), ("a runaway: ", least.runaway), ("astray: ", least.astray)]
    {
        text.extend(near.map(|near| format!("{what}{near}\n")));
    }
    Ok(text)
}
