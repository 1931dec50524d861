//! Measures each part.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use super::programs::{Programs, output};
use super::record::Figures;
use super::{Arguments, Part, cadence, counted};
use crate::cases::CASES;
use crate::files::{SHIPPED_AGENT, read, root};
use crate::{fly, tags, target, verify};

/// Seeds of each flight.
const SEEDS: u64 = 3;

/// Measures a part.
pub(super) fn measure(
    part: Part,
    arguments: &Arguments,
    figures: &mut Figures,
) -> Result<(), Box<dyn std::error::Error>> {
    match part {
        Part::Flights => flights(figures),
        Part::Tags => over_tags(figures),
        Part::Instructions => counted::measure(&Programs::build()?, figures),
        Part::Cadence => cadence::measure(&Programs::build()?, figures),
        Part::Agent => agent(figures),
        Part::Proofs => proofs(arguments.proofs.as_deref(), figures),
        Part::Code => code(figures),
        Part::Build => build(figures),
        Part::Tests => tests(arguments.tests.as_deref(), figures),
    }
}

fn percent(part: usize, of: usize) -> f64 {
    part as f64 * 100.0 / of as f64
}

fn flights(figures: &mut Figures) -> Result<(), Box<dyn std::error::Error>> {
    for row in fly::rows(SEEDS)? {
        let case = &CASES[row.case];
        let hovers = case.bound_s.is_none();
        let what = if hovers { "hover" } else { "plans" };
        let of = format!("{what}, {}, {}", case.airframe, case.conditions);
        figures.add("plans completed", &of, percent(row.completed, row.flights));
        figures.add("distance in the late part of stays, rms", &of, row.late_rmse_m);
        if !hovers {
            figures.add("time between the stays", &of, row.transit_s);
            figures.add("overshoot, mean", &of, row.overshoot_mean_m);
        }
    }
    Ok(())
}

fn over_tags(figures: &mut Figures) -> Result<(), Box<dyn std::error::Error>> {
    for row in tags::judged(SEEDS)? {
        let of = format!("{}, {}", row.name, row.day());
        figures.add(
            "flights over tags that end as meant",
            &of,
            percent(row.flights - row.lost, row.flights),
        );
        if row.lands_on_tag {
            figures.add("distance of a landing from its tag, worst", &of, row.landing_m);
        } else {
            figures.add("distance from the target over tags, rms", &of, row.truth_rms_m);
            figures.add("error of the estimate over tags, rms", &of, row.estimate_rms_m);
        }
    }
    Ok(())
}

fn agent(figures: &mut Figures) -> Result<(), Box<dyn std::error::Error>> {
    let agent = asl2c::Agent::read(&root().join(SHIPPED_AGENT))?;
    let translation = translator::translate(&agent.configuration, &agent.text)?;
    let lines: usize = translation.files.iter().map(|file| file.text.lines().count()).sum();
    figures.add("lines of C", "autopilot", lines as f64);
    let found = target::measure_agent(&agent)?;
    figures.add("code on a Cortex-M4", "autopilot", found.text as f64);
    figures.add("state", "autopilot", found.state as f64);
    if let Some(step) = found.bounds.first() {
        figures.add("stack of a step", "autopilot", step.stack as f64);
        let longest = step.instructions.as_ref().map_err(String::as_str)?;
        figures.add("longest path of a step", "autopilot", *longest as f64);
    }
    Ok(())
}

/// Of the properties of the shipped agent, which come first.
fn proofs(log: Option<&Path>, figures: &mut Figures) -> Result<(), Box<dyn std::error::Error>> {
    let text = match log {
        Some(log) => read(log)?,
        None => verify::proofs()?.0,
    };
    let count = |words: &str| text.lines().filter(|line| line.contains(words)).count() as f64;
    // What is not proved does not make up for what is.
    if count(" C: ") > count(" C: proved") || count(" model: ") > count(" model: holds") {
        return Err("not everything is proved".into());
    }
    figures.add("proved on the C", "autopilot", count(" C: proved"));
    figures.add("hold of the model", "autopilot", count(" model: holds"));
    Ok(())
}

fn code(figures: &mut Figures) -> Result<(), Box<dyn std::error::Error>> {
    let mut tree = Command::new("cargo");
    tree.args(["tree", "--locked", "--package", "ardrone-pilot", "--edges", "normal,build"]);
    let tree = output(tree.args(["--prefix", "none", "--format", "{p}"]).current_dir(root()))?;
    let crates: BTreeSet<&str> = tree.lines().map(|line| line.trim_end_matches(" (*)")).collect();
    figures.add("crates of ardrone-pilot", "all", crates.len() as f64);

    let mut list = Command::new("git");
    let files = output(list.args(["ls-files", "-z", "*.rs", "*.md"]).current_dir(root()))?;
    let (mut rust, mut tests, mut pages) = (0, 0, 0);
    for file in files.split_terminator('\0') {
        let lines = read(&root().join(file))?.lines().count();
        let is_test = file.starts_with("tests/") || file.contains("/tests");
        *(if Path::new(file).extension().is_some_and(|extension| extension == "md") {
            &mut pages
        } else if is_test {
            &mut tests
        } else {
            &mut rust
        }) += lines;
    }
    for (name, lines) in
        [("lines of Rust", rust), ("lines of tests", tests), ("lines of pages", pages)]
    {
        figures.add(name, "all", lines as f64);
    }
    Ok(())
}

/// From nothing, in a folder that is removed. Crates must be downloaded already.
fn build(figures: &mut Figures) -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let reference_s = reference(folder.path())?;
    let mut build = Command::new("cargo");
    build.args([
        "build",
        "--release",
        "--locked",
        "--offline",
        "--quiet",
        "--package",
        "ardrone-pilot",
    ]);
    build.arg("--target-dir").arg(folder.path()).current_dir(root());
    let (clock, processors) = (now(), children_s());
    output(&mut build)?;
    figures.add("first build, by the clock", "all", clock.elapsed().as_secs_f64());
    let times = (children_s() - processors) / reference_s;
    figures.add("first build, times the work of a reference", "all", times);
    Ok(())
}

/// Processor time that compiling a fixed program takes here, with both cores busy, as in a build.
fn reference(folder: &Path) -> Result<f64, Box<dyn std::error::Error>> {
    const FUNCTIONS: u32 = 3000;
    let file = folder.join("reference.rs");
    let functions = (0..FUNCTIONS).map(|number| {
        format!(
            "pub fn f{number}(words: &[String]) -> Vec<(usize, String)> {{\n\
             words.iter().enumerate().filter(|(at, word)| word.len() > {number} + at)\n\
             .map(|(at, word)| (at, format!(\"{{word}} {number}\"))).collect()\n}}\n"
        )
    });
    std::fs::write(&file, functions.collect::<String>())?;
    let before_s = children_s();
    let compile = |number: usize| {
        let mut rustc = Command::new("rustc");
        rustc.args(["--crate-type=lib", "-Copt-level=1", "--edition=2024"]).arg(&file);
        rustc.arg("-o").arg(folder.join(format!("reference{number}.rlib"))).spawn()
    };
    let running = [compile(0)?, compile(1)?];
    for mut compiler in running {
        if !compiler.wait()?.success() {
            return Err("the reference does not compile".into());
        }
    }
    Ok((children_s() - before_s) / 2.0)
}

/// Processor time of all child processes that have ended.
fn children_s() -> f64 {
    // `times` of the shell that reads it would be its own.
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Behind the name, which may contain spaces: fields 14 to 17 from the third one on.
    let behind = stat.rsplit(')').next().unwrap_or_default();
    let ticks =
        behind.split_whitespace().skip(13).take(2).filter_map(|ticks| ticks.parse::<f64>().ok());
    ticks.sum::<f64>() / 100.0
}

fn tests(log: Option<&Path>, figures: &mut Figures) -> Result<(), Box<dyn std::error::Error>> {
    let text = if let Some(log) = log {
        read(log)?
    } else {
        let mut test = Command::new("cargo");
        output(test.args(["test", "--workspace", "--locked"]).current_dir(root()))?
    };
    // "test result: ok. 12 passed; 0 failed; ..."
    let results = text.lines().filter_map(|line| line.strip_prefix("test result: "));
    if results.clone().any(|result| !result.starts_with("ok.")) {
        return Err("not all tests passed".into());
    }
    let passed = results.filter_map(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    figures.add("tests passed", "all", passed.sum());
    Ok(())
}

/// Builds are timed.
fn now() -> Instant {
    #[allow(clippy::disallowed_methods, reason = "builds are timed")]
    Instant::now()
}
