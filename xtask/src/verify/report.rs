//! Reports the results on the terminal and in `docs/verification.md`.

use std::fmt::Write as _;

use translator::Promise;

use super::coverage::Coverage;
use super::tools::Versions;
use super::{Caught, Findings};

/// All results.
pub(super) struct Report {
    pub(super) versions: Versions,
    pub(super) autopilot: Findings,
    pub(super) paper: Findings,
    pub(super) mutants: Vec<Caught>,
    /// Output of `asl2c --report`.
    pub(super) cost: String,
    pub(super) coverage: Coverage,
}

/// A row of the table of properties.
struct Row<'a> {
    promise: &'a Promise,
    on_model: &'static str,
    on_c: &'static str,
}

impl Findings {
    fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.c.properties.iter().map(|(promise, holds)| {
            let on_model = match self.on_model(&promise.name) {
                None => "NOT CHECKED",
                Some(checked) if checked.verdict.is_proved() => "holds",
                Some(checked) if checked.verdict.is_refuted() => "FAILS",
                Some(_) => "not decided",
            };
            Row { promise, on_model, on_c: if *holds { "proved" } else { "NOT PROVED" } }
        })
    }

    fn run_time(&self) -> &'static str {
        if self.c.run_time.is_empty() { "proved" } else { "NOT PROVED" }
    }
}

/// Summary of the proofs of the shipped agent.
pub(super) fn proved(autopilot: &Findings) -> String {
    let mut text =
        String::from("The shipped agent, in every environment, for any number of steps\n");
    // Writing to a string cannot fail.
    for row in autopilot.rows() {
        let name = &row.promise.name;
        _ = writeln!(text, "  {name:<28}model: {:<10}C: {}", row.on_model, row.on_c);
    }
    _ = writeln!(text, "  {:<46}C: {}", "no error at run time", autopilot.run_time());
    for error in &autopilot.c.run_time {
        _ = writeln!(text, "    possible: {error}");
    }
    for checked in autopilot.model.iter().filter(|one| !one.verdict.is_proved()) {
        _ = writeln!(
            text,
            "  {} does not hold of the model, for this can happen:",
            checked.property.name
        );
        for happening in checked.verdict.counterexample() {
            _ = writeln!(text, "    {happening}");
        }
    }
    text
}

impl Report {
    /// Report for the terminal.
    pub(super) fn lines(&self) -> String {
        let mut text = proved(&self.autopilot);
        text += "Mutants, each of which must break what it is made for\n";
        for caught in &self.mutants {
            let how = if caught.is_caught() { "caught: " } else { "NOT CAUGHT; broken: " };
            let broken = caught.broken.join(", ");
            _ = writeln!(text, "  {:<54}{how}{broken}", caught.mutant.name);
        }
        let Coverage { outcomes, lines, .. } = &self.coverage;
        let chosen = self.coverage.chosen();
        _ = writeln!(
            text,
            "The tests choose {chosen} plans; of the C they run {lines} lines, {outcomes} outcomes of conditions"
        );
        text
    }

    /// Report for `docs/verification.md`.
    pub(super) fn markdown(&self) -> String {
        let mut text = String::from(INTRODUCTION);
        text += "| property | requirement | must hold | model | C |\n|---|---|---|---|---|\n";
        for Row { promise, on_model, on_c } in self.autopilot.rows() {
            let Promise { name, requirements, formula, .. } = promise;
            let requirements = requirements.join(", ");
            _ = writeln!(text, "| `{name}` | {requirements} | `{formula}` | {on_model} | {on_c} |");
        }
        _ = writeln!(
            text,
            "| no error at run time | | no access outside an object, no overflow, no division by zero, no \
             conversion that loses, no uninitialised read | | {} |",
            self.autopilot.run_time()
        );
        let (invariant, candidates) =
            (self.autopilot.c.invariant.len(), self.autopilot.c.candidates);
        let Versions { cbmc, frama_c, spin } = &self.versions;
        _ = writeln!(
            text,
            "\nThe invariant has {invariant} conditions, found among {candidates} candidates. CBMC {cbmc}; \
             Frama-C {frama_c}; {spin}.\n"
        );
        text += MUTANTS_INTRODUCTION;
        text += "| mutant | made to break | broken on the C, at least | on the model |\n|---|---|---|---|\n";
        for caught in &self.mutants {
            let not = if caught.is_caught() { "" } else { "**not caught**; " };
            let on_model = match caught.on_model {
                Some(true) => "a way to the failure",
                Some(false) => "**holds**",
                None => "",
            };
            let (mutant, broken) = (caught.mutant, caught.broken.join(", "));
            _ = writeln!(
                text,
                "| {} | {} | {not}{broken} | {on_model} |",
                mutant.name, mutant.breaks
            );
        }
        self.compare(&mut text);
        self.exercise(&mut text);
        _ = writeln!(text, "{COST}```text\n{}```", self.cost);
        text += LIMITS;
        text
    }

    /// Section on the paper's agent.
    fn compare(&self, text: &mut String) {
        *text += PAPER_INTRODUCTION;
        *text += "| property | must hold | model | C |\n|---|---|---|---|\n";
        for Row { promise, on_model, on_c } in self.paper.rows() {
            let Promise { name, formula, .. } = promise;
            _ = writeln!(text, "| `{name}` | `{formula}` | {on_model} | {on_c} |");
        }
        _ = writeln!(text, "| no error at run time | | | {} |", self.paper.run_time());
        let told = self.paper.on_model("flying_goes_on");
        if let Some(checked) = told.filter(|checked| checked.verdict.is_refuted()) {
            _ = writeln!(
                text,
                "\nHow `flying_goes_on` fails, as `asl2c verify` tells it:\n\n```text"
            );
            for happening in checked.verdict.counterexample() {
                _ = writeln!(text, "{happening}");
            }
            *text += "```\n";
        }
    }

    /// Section on test coverage.
    fn exercise(&self, text: &mut String) {
        let coverage = &self.coverage;
        let Coverage { outcomes, lines, plans } = coverage;
        let chosen = coverage.chosen();
        _ = writeln!(
            text,
            "{COVERAGE_INTRODUCTION}The tests choose {chosen} plans. Of the C they run {lines} lines and {outcomes} \
             outcomes of conditions.\n"
        );
        *text += "| requirement | plans chosen | outcomes of their conditions |\n|---|---|---|\n";
        for (requirement, (chosen, outcomes)) in coverage.by_requirement() {
            _ = writeln!(text, "| {requirement} | {chosen} | {outcomes} |");
        }
        *text += "\n| line | plan | requirement | chosen | outcomes |\n|---|---|---|---|---|\n";
        for plan in plans {
            let label = if plan.label.is_empty() { "" } else { " @" };
            let requirements = plan.requirements.join(", ");
            // Counts depend on the interleaving of test threads; only whether a plan was chosen is stable.
            let chosen = if plan.chosen > 0 { "yes" } else { "**never**" };
            _ = writeln!(
                text,
                "| {} | `{}`{label}{} | {requirements} | {chosen} | {} |",
                plan.line, plan.trigger, plan.label, plan.outcomes
            );
        }
    }
}

const INTRODUCTION: &str = "\
# Verification

`cargo xtask verify` proves what must hold of the shipped agent
([`autopilot.asl`](../autopilot/agent/autopilot.asl), [`autopilot.conf`](../autopilot/agent/autopilot.conf)),
shows that the proof can fail, measures what the tests exercise, and, if all was proved, writes this page. Without
CBMC, SPIN or Frama-C it proves nothing and fails.

Each property is proved twice, in an environment that may do anything at any time: raise every event with any
arguments, believe any values (numbers that are none among them), answer every question differently each time it
is asked. Neither proof has a bound on the length of the flight.

- **On a model of the agent** (`asl2c verify`): events, beliefs that are held or not, and plans in Promela. SPIN
  visits every state that can be reached. What fails is told in the agent's own words.
- **On the generated C**: CBMC shows that one transition (an event raised, a belief set, or a step) from *any* state
  that satisfies an invariant keeps the invariant and every property, and that the first state satisfies it. The
  invariant is found, not written: from candidates made of the agent's events and beliefs those are dropped that
  the first state or some transition breaks, until the rest proves itself. Frama-C's EVA follows the whole life of
  the same C from `init()` on.

Properties stand in the configuration; [the language guide](agentspeak.md#properties) tells what they mean. Those of
dangers begin where the danger does, at what the agent is told, and have no excuse: a step that begins in danger commands
the way down, whatever runs and whatever the pilot orders. Their numbers are the requirement's, not the agent's limits, so
that a limit which is changed breaks them. That the way down then goes on to the ground is `descending_goes_on` and
`landing_goes_on`, also when the danger has passed.

";

const MUTANTS_INTRODUCTION: &str = "\
## The proof can fail

Each of these mutants is the shipped agent, its configuration or its C with one mistake in it, and breaks
what it is made to break: the proof on the C does not go through, and on the model (where the mistake is not in the
C) SPIN finds a way to the failure.

";

const PAPER_INTRODUCTION: &str = "
## The paper's autopilot

[`paper.asl`](../translator/agents/paper.asl) is the autopilot of Bucheli, Kroening, Martins and Natraj (TAROS 2015,
figures 1 and 2), written anew from what its plans do, with promises like ours
([`paper.conf`](../translator/agents/paper.conf)). The paper leaves as future work to prove that \"in every deliberation
cycle one of the basic actions is executed\". That is not so: without a position, on orders for which no plan applies (a
take-off in the air, a target on the ground), and in the step in which a target is reached for the first time,
nothing is sent. A landing order waits until the target is reached and stayed at, for which there is no bound. That
`onGround` and `closeEnough` may answer differently when asked again, as senses do, loses goals whose plans
ask the same question twice. Our agent asks in order, with a last plan for everything else, lets landing pre-empt,
and mends failures.

";

const COVERAGE_INTRODUCTION: &str = "
## What the tests exercise

The agent's own tests and all flights in simulated time (500 with random faults among them), with the agent's C counted
by gcov. A condition has two outcomes, true and false; the generated C evaluates one condition after the other, so
where all outcomes were seen, so was every decision. What cannot come out otherwise counts too: that a limit
is believed, which it is from the start, or that `airworthy` is not. Plans carry the requirements that they are for
(`@label[req(\"SAF-2\")]`).

";

const COST: &str = "
## What a step costs

";

const LIMITS: &str = "
## What is assumed, and what is not proved

- The C is translated with the agent's state passed in, as the autopilot uses it; of `instance = static` the
  same plans and cycle are proved, not the other way of reaching the state.
- CBMC, Frama-C, SPIN, the C compiler and the Rust around the agent are trusted. What the environment does with an
  AT command is not part of the proof: that is the guard's, the session's and the drone's
  ([safety.md](safety.md)), and tested.
- The properties of dangers speak of what the agent is told. That charge, blindness, doubt and saturation are measured
  rightly is the estimator's and the flight program's, and tested. A doubt that is no number lands the drone too, which
  a comparison cannot say: it is tested.
- The agent has no clock. It is told for how long it has been taking off, approaching, holding a place and descending,
  and in the proofs that may be any time in any step. So `a_take_off_ends` says: in the step in which the agent is told
  that the take-off has lasted more than 10 s, it goes down. That what it is told grows as time does, and is not set back
  by arriving for a moment or by a moment's blindness, is the work of 40 lines (`Activity` in `autopilot/src/agent.rs`),
  and tested.
- A stay has no limit but the plan's own time and the battery: who drifts off begins it anew, as often as there is time
  left to approach.
- The pilot's hand (`+!hold`, `+!steer`) takes back a landing in which there is no danger (or no more), each time anew:
  that is what `unless` says. The flight program does not pass it on once a landing for a danger has begun.
- The model knows no values, so it proves less than the C where values matter; here it proves the same.
- Frama-C's WP with ACSL contracts is not used: what it would prove of single functions, CBMC proves of every
  path through all of them, and frames (what a function does not change) are part of the invariant.
";
