//! Instructions, counted by valgrind: unlike times they are the same on each machine and beside other programs.

use std::hint::black_box;
use std::process::Command;

use super::programs::{Programs, output};
use super::record::Figures;
use crate::files::{SHIPPED_AGENT, root};
use crate::job::{Job, fly};

/// What is counted: a function with all that it calls, for each call. The agent's C, which counts its own work where
/// `AGENT_COVERAGE` is set, is a hundredth of the first one.
#[rustfmt::skip]
const COUNTED: [(&str, &str); 8] = [
    ("all of a tick or a packet", "autopilot::vehicle::protocol::<impl autopilot::vehicle::Vehicle>::handle_timed"),
    ("decode a packet", "ardrone_link::navdata::summary::Navdata::decode"),
    ("estimate from a packet", "estimator::Estimator::update"),
    ("predict for a tick", "estimator::Estimator::predicted"),
    ("check the safety of a tick", "autopilot::safety::SafetyMonitor::check"),
    ("control the position", "pid::cascade::PositionController::step"),
    ("write a command", "ardrone_link::at::encode::Datagram::push"),
    ("translate the shipped agent", "translator::translate"),
];

/// A flight that is always the same, and one translation of the shipped agent.
pub(super) fn work() -> Result<(), Box<dyn std::error::Error>> {
    fly(Job { case: 0, plan: 0, seed: 1 }, |_| ())?;
    let agent = asl2c::Agent::read(&root().join(SHIPPED_AGENT))?;
    black_box(translator::translate(&agent.configuration, &agent.text)?);
    Ok(())
}

/// Counts the instructions of the work.
pub(super) fn measure(
    programs: &Programs,
    figures: &mut Figures,
) -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let counts = folder.path().join("counts");
    let mut valgrind = Command::new("valgrind");
    valgrind.args(["--quiet", "--tool=callgrind"]);
    valgrind.arg(format!("--callgrind-out-file={}", counts.display())).arg(programs.named("xtask"));
    output(valgrind.args(["figures", "--work"]))?;
    let text = String::from_utf8_lossy(&std::fs::read(&counts)?).into_owned();
    for (what, function) in COUNTED {
        // What is inlined away is not called, which is a loss: name another function.
        if let Some(each) = each_call(&text, function) {
            figures.add("instructions", what, each);
        }
    }
    Ok(())
}

/// Instructions of a call of a function, with all that it calls, on average. In the file each call from one place to it is
/// `cfn=(number) name`, the name only the first time; `calls=count position`; and `position instructions`.
fn each_call(counts: &str, function: &str) -> Option<f64> {
    let number = counts.lines().find_map(|line| {
        let (number, name) = line.split_once("fn=(")?.1.split_once(") ")?;
        (name == function).then_some(number)
    })?;
    let called = format!("cfn=({number})");
    let (mut calls, mut instructions) = (0.0, 0.0);
    let mut lines = counts.lines();
    while let Some(line) = lines.next() {
        if line == called || line.starts_with(&format!("{called} ")) {
            let mut word =
                |number: usize| lines.next()?.split([' ', '=']).nth(number)?.parse::<f64>().ok();
            calls += word(1)?;
            instructions += word(1)?;
        }
    }
    (calls > 0.0).then(|| instructions / calls)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_of_a_function_are_added_up() {
        let counts = "fn=(1) main\n5 10\ncfn=(2) a::b\ncalls=2 7\n6 300\ncfn=(3) a::b::c\ncalls=1 9\n6 1\n\n\
                      fn=(3)\n1 1\ncfn=(2)\ncalls=1 7\n+3 600\n";
        assert_eq!(each_call(counts, "a::b"), Some(300.0));
        assert_eq!(each_call(counts, "a::b::c"), Some(1.0));
        assert_eq!(each_call(counts, "main"), None);
        assert_eq!(each_call(counts, "a"), None);
    }
}
