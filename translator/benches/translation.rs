//! Speed of the translation, and number of instructions of a step of the autopilot.
//!
//! `cargo bench -p translator`. Instructions are counted by valgrind, which is optional.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a benchmark reads the clock, prints, and ends where it cannot go on"
)]

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use translator::{Translation, parse_configuration, translate};

const AUTOPILOT: [&str; 2] = [
    include_str!("../../autopilot/agent/autopilot.conf"),
    include_str!("../../autopilot/agent/autopilot.asl"),
];

/// Random orders, positions and times for the autopilot, with its own state like any environment.
const ENVIRONMENT: &str = r"
static uint32_t seed = 1U;
static uint32_t number(uint32_t below) { seed = seed * 1664525U + 1013904223U; return (seed >> 8) % below; }
void autopilot_updateBeliefs(autopilot_agent_t *agent, void *environment)
{
    (void)environment;
    autopilot_set_position(agent, number(5U), number(5U), 1.0, 0.0);
    autopilot_set_blindFor(agent, number(310U));
    autopilot_set_wind(agent, number(20U) / 100.0);
    autopilot_set_stayingFor(agent, number(600U));
}
void autopilot_tracePlan(void *e, uint32_t plan) { (void)e; (void)plan; }
void autopilot_sendStandby(void *e) { (void)e; }
void autopilot_sendTakeOff(void *e) { (void)e; }
void autopilot_sendTakeOffAgain(void *e) { (void)e; }
void autopilot_sendHover(void *e) { (void)e; }
void autopilot_sendSticks(void *e) { (void)e; }
void autopilot_sendPause(void *e) { (void)e; }
void autopilot_sendLand(void *e) { (void)e; }
void autopilot_sendGoto(void *e, double x, double y, double z, double yaw) { (void)e; (void)x; (void)y; (void)z; (void)yaw; }
void autopilot_sendGotoAgain(void *e, double x, double y, double z, double yaw) { (void)e; (void)x; (void)y; (void)z; (void)yaw; }
void autopilot_sendStay(void *e, double x, double y, double z, double yaw) { (void)e; (void)x; (void)y; (void)z; (void)yaw; }
void autopilot_sendDescent(void *e, double x, double y, double z, double yaw) { (void)e; (void)x; (void)y; (void)z; (void)yaw; }
bool autopilot_onGround(void *e) { (void)e; return number(20U) == 0U; }
bool autopilot_hovering(void *e) { (void)e; return number(5U) == 0U; }
bool autopilot_steering(void *e) { (void)e; return number(5U) != 0U; }
bool autopilot_closeEnough(void *e, double x, double y, double z, double yaw, double d) { (void)e; (void)x; (void)y; (void)z; (void)yaw; (void)d; return number(3U) == 0U; }
void autopilot_reportDone(void *e) { (void)e; }
void autopilot_reportRefused(void *e) { (void)e; }
void autopilot_reportFailed(void *e) { (void)e; }
void autopilot_tellBatteryLow(void *e) { (void)e; }
void autopilot_tellBatteryEmpty(void *e) { (void)e; }
void autopilot_tellBlind(void *e) { (void)e; }
void autopilot_tellLost(void *e) { (void)e; }
void autopilot_tellWind(void *e) { (void)e; }
void autopilot_tellNoProgress(void *e) { (void)e; }
int main(void)
{
    static autopilot_agent_t agent;
    autopilot_init(&agent, 0);
    autopilot_set_reachDistance(&agent, 0.2);
    autopilot_set_stayDistance(&agent, 0.5);
    autopilot_set_stayTime(&agent, 500);
    for (uint32_t step = 0U; step < STEPS; step++)
    {
        switch (number(40U))
        {
            case 0U: (void)autopilot_achieve_takeOff(&agent); break;
            case 1U: (void)autopilot_achieve_goTo(&agent, number(5U), number(5U), 1.0, 0.0); break;
            case 2U: (void)autopilot_achieve_land(&agent); break;
            default: break;
        }
        autopilot_next_step(&agent);
    }
    return 0;
}
";

/// Number of measured steps.
const STEPS: u64 = 100_000;

fn main() {
    let [configuration, agent] = AUTOPILOT;
    println!("autopilot            {:>9.3} ms", milliseconds(&timed(configuration, agent, 100)));
    for plans in [1_000, 10_000, 100_000] {
        let (configuration, agent) = agent_of(plans);
        let repetitions = (20_000 / plans).clamp(1, 10);
        let time = milliseconds(&timed(&configuration, &agent, repetitions));
        #[allow(clippy::cast_precision_loss, reason = "a plan count is small")]
        let each = time * 1000.0 / plans as f64;
        println!("{plans:>7} plans        {time:>9.3} ms   {each:.1} µs a plan");
    }
    for (what, [few, many]) in LARGE {
        for size in [few, many] {
            let (configuration, agent) = large(what, size);
            let time = milliseconds(&timed(&configuration, &agent, 1));
            #[allow(clippy::cast_precision_loss, reason = "a count is small")]
            let each = time * 1000.0 / size as f64;
            println!("{size:>7} {what:<12} {time:>9.3} ms   {each:.1} µs each");
        }
    }
    let parsed = parse_configuration("autopilot.conf", configuration).unwrap();
    let translation = translate(&parsed, agent).unwrap();
    for optimisation in ["-O0", "-Os", "-O2"] {
        match instructions(&translation, optimisation) {
            Some((step, all)) => println!(
                "next_step() {optimisation}      {step:>9} instructions on average, \
                 {all} with its environment"
            ),
            None => println!("next_step() {optimisation}      not counted: no cc or no valgrind"),
        }
    }
}

/// Large constructs: formulas that can fail, conditions, plans of one trigger.
const LARGE: [(&str, [usize; 2]); 3] = [
    ("formulae", [3_000, 30_000]),
    ("conditions", [3_000, 30_000]),
    ("of a trigger", [20_000, 330_000]),
];

/// An agent with such a construct.
fn large(what: &str, size: usize) -> (String, String) {
    let parts = |part: &dyn Fn(usize) -> String, between: &str| {
        (0..size).map(part).collect::<Vec<_>>().join(between)
    };
    let agent = match what {
        "formulae" => format!("+!g(X) <- {}.\n", parts(&|n| format!("act(X + {n})"), "; ")),
        "conditions" => format!("+!g(X) : {} <- act(X).\n", parts(&|n| format!("b({n})"), " & ")),
        _ => parts(&|n| format!("+!g({n}) <- act({n}).\n"), ""),
    };
    let configuration = "settings { input = a.asl; output = a.c; header = a.h; basics = b.h; };\n\
        basics { void act(int); };\ntypes { g(int); b(int); };\ntriggerables { +!g; };\nsettables { b; };\n";
    (configuration.to_owned(), agent)
}

/// The shortest time of several translations.
fn timed(configuration: &str, agent: &str, repetitions: usize) -> Duration {
    let once = || {
        let start = Instant::now();
        let parsed = parse_configuration("a.conf", configuration).unwrap();
        let translation = translate(&parsed, agent).unwrap();
        assert!(!translation.files.is_empty());
        start.elapsed()
    };
    (0..repetitions).map(|_| once()).min().unwrap()
}

fn milliseconds(time: &Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

/// An agent with this number of plans, three for each goal, that call and post each other.
fn agent_of(plans: usize) -> (String, String) {
    let goals = plans / 3;
    let mut types = String::from("b(int); ");
    let mut triggerables = String::new();
    let mut agent = String::from("b(1).\n");
    for goal in 0..goals {
        _ = write!(types, "g{goal}(int); ");
        _ = write!(triggerables, "+!g{goal}; ");
        let next = (goal + 1) % goals;
        _ = write!(
            agent,
            "+!g{goal}(X) : b(Y) & X < Y <- act(X); +b(X).\n\
             +!g{goal}(X) : b(X) <- act(X + {goal}); !!g{next}(X).\n\
             +!g{goal}(X) <- act(X); !g{next}(X).\n"
        );
    }
    let configuration = format!(
        "settings {{ input = a.asl; output = a.c; header = a.h; basics = b.h; }};\n\
         basics {{ void act(int); }};\ntypes {{ {types} }};\ntriggerables {{ {triggerables} }};\n"
    );
    (configuration, agent)
}

/// Instructions of `next_step()` per step, without and with its calls outside the agent.
fn instructions(translation: &Translation, optimisation: &str) -> Option<(u64, u64)> {
    let folder = tempfile::tempdir().unwrap();
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    std::fs::write(
        folder.path().join("main.c"),
        format!(
            "#include \"autopilot.h\"\n#include \"actions.h\"\n#define STEPS {STEPS}U\n{ENVIRONMENT}"
        ),
    )
    .unwrap();
    let mut compile = Command::new("cc");
    compile.args(["-std=c99", optimisation, "-o", "agent", "main.c", "autopilot.c"]);
    if !compile.current_dir(folder.path()).status().ok()?.success() {
        return None;
    }
    let all = all_instructions(folder.path())?;
    let environment = environment_instructions(folder.path())?;
    Some(((all - environment) / STEPS, all / STEPS))
}

/// Runs the agent under callgrind, which counts from each call of `next_step()` to its end.
fn all_instructions(folder: &Path) -> Option<u64> {
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--tool=callgrind", "--callgrind-out-file=counts"]);
    valgrind.args(["--toggle-collect=autopilot_next_step", "./agent"]);
    let output = valgrind.current_dir(folder).output().ok()?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    let line = text.lines().find(|line| line.contains("Collected :"))?;
    line.rsplit(' ').next()?.parse().ok()
}

/// Of these, the instructions in the environment's functions.
fn environment_instructions(folder: &Path) -> Option<u64> {
    let mut annotate = Command::new("callgrind_annotate");
    let output = annotate.args(["--threshold=100", "counts"]).current_dir(folder).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let environment = text.lines().filter(|line| {
        let function = line.split(':').next_back().unwrap_or_default();
        ENVIRONMENT.lines().filter(|line| !line.starts_with([' ', '{'])).any(|definition| {
            let name = definition.split('(').next().and_then(|head| head.split(' ').next_back());
            name.is_some_and(|name| name.len() > 3 && function.split(' ').next() == Some(name))
        })
    });
    let counts = environment.filter_map(|line| {
        let count = line.trim().split(' ').next()?.replace(',', "");
        count.parse::<u64>().ok()
    });
    Some(counts.sum())
}
