//! Instructions of the costliest step under random events and beliefs, counted by callgrind.

use std::path::Path;

use translator::{EXERCISE, EXERCISE_SEED, EXERCISE_STEPS, Exercise, ROUNDED};

use crate::target::{HOST, SEED};
use crate::tool::{ToolError, run, write};

/// Compiler options, the same as for the upper bound.
const OPTIMIZED: &str = "-O2";
/// Number of steps to try.
const STEPS: u32 = 4000;

/// Instructions of the agent's own C in the costliest step, or the reason why they are unknown. Actions and
/// functions of the environment do not count.
pub(super) fn costliest(exercise: &Exercise) -> Result<u64, String> {
    let folder = tempfile::tempdir().map_err(|error| format!("no temporary folder: {error}"))?;
    let folder = folder.path();
    let agent = exercise.files.first().map(|file| file.name.as_str()).ok_or("there is no C")?;
    let entry = exercise.interface.first().ok_or("there is no interface")?;
    profile(exercise, (agent, entry), folder).map_err(|error| error.to_string())?;
    let entries = std::fs::read_dir(folder).map_err(|error| error.to_string())?;
    let profiles = entries.filter_map(Result::ok).map(|entry| entry.path());
    let profiles = profiles
        .filter(|path| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with("step.")));
    let costs = profiles.map(|path| {
        let profile = std::fs::read_to_string(&path)
            .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        Ok(own_cost(&profile, agent))
    });
    let costs: Vec<u64> = costs.collect::<Result<_, String>>()?;
    costs.into_iter().max().filter(|cost| *cost > 0).ok_or_else(|| "no step was counted".to_owned())
}

/// Runs the C under callgrind, which leaves a profile of each step in the folder.
fn profile(
    exercise: &Exercise,
    (agent, entry): (&str, &str),
    folder: &Path,
) -> Result<(), ToolError> {
    exercise.files.iter().try_for_each(|file| write(folder, &file.name, &file.text))?;
    write(folder, "host.c", HOST)?;
    let (steps, seed) =
        (format!("-D{EXERCISE_STEPS}={STEPS}U"), format!("-D{EXERCISE_SEED}={SEED}"));
    let own = [
        "-std=c99",
        ROUNDED,
        OPTIMIZED,
        "-fno-jump-tables",
        "-g",
        "-w",
        "-c",
        agent,
        "-o",
        "agent.o",
    ];
    run(folder, "gcc", &own)?;
    let rest = [
        "-std=c99", ROUNDED, "-g", "-w", &steps, &seed, EXERCISE, "host.c", "agent.o", "-o",
        "steps",
    ];
    run(folder, "gcc", &rest)?;
    let toggle = format!("--toggle-collect={entry}");
    let dump = format!("--dump-after={entry}");
    let options = ["--tool=callgrind", "--callgrind-out-file=step", &toggle, &dump, "./steps"];
    run(folder, "valgrind", &options).map(|_| ())
}

/// The cost of the lines of one source file in a profile of callgrind (its manual, "Callgrind Format
/// Specification"). Costs behind `calls=` are those of the callee, which has lines of its own.
fn own_cost(profile: &str, source: &str) -> u64 {
    let mut files: Vec<(&str, &str)> = Vec::new();
    let mut inside = false;
    let mut called = false;
    let mut cost = 0;
    for line in profile.lines() {
        let value = |keys: &[&str]| keys.iter().find_map(|key| line.strip_prefix(key));
        let own = value(&["fl=", "fi=", "fe="]);
        if let Some(place) = own.or_else(|| value(&["cfl=", "cfi="])) {
            // "(3) name" defines the number's name for the rest of the file.
            let (number, name) = place.split_once(' ').unwrap_or((place, ""));
            if !name.is_empty() {
                files.push((number, name));
            }
            if own.is_some() {
                let name = files.iter().find(|(known, _)| *known == number).map(|(_, name)| *name);
                inside = name.is_some_and(|name| Path::new(name).ends_with(source));
            }
        } else if line.starts_with("calls=") {
            called = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit() || "+-*".contains(c)) {
            if inside && !std::mem::take(&mut called) {
                let count = line.split_whitespace().nth(1).and_then(|count| count.parse().ok());
                cost += count.unwrap_or(0_u64);
            }
            called = false;
        }
    }
    cost
}

#[cfg(test)]
mod tests {
    use super::own_cost;

    #[test]
    fn what_is_called_counts_where_it_stands() {
        let profile = "version: 1\nevents: Ir\nfl=(2) /tmp/x/harness.c\nfn=(9) step\ncfi=(1) /tmp/x/agent.c\n\
                       cfn=(1)\ncalls=1 9\n8 54\nfl=(1)\nfn=(1) next_step\n10 5\n+1 2\ncfi=(2)\ncfn=(2) onGround\ncalls=1 7\n* 40\n12 1\n\
                       fl=(2)\nfn=(2)\n7 40\nfl=(1)\nfn=(3) run\n3 4\n";
        assert_eq!(own_cost(profile, "agent.c"), 12);
        assert_eq!(own_cost(profile, "other.c"), 0);
    }
}
