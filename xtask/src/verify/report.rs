//! Reports the results on the terminal and in `docs/verification.md`.

use std::fmt::Write as _;

use asl2c::{Evidence, Status};

use super::coverage::Coverage;
use super::tools::Versions;
use super::{Caught, Findings, OnC};

/// All results.
pub(super) struct Report {
    pub(super) versions: Versions,
    pub(super) evidence: Evidence,
    pub(super) autopilot: Findings,
    pub(super) paper: Findings,
    pub(super) mutants: Vec<Caught>,
    pub(super) coverage: Coverage,
}

impl Findings {
    /// Each property with the words for its results on the model and on the C.
    fn rows(&self) -> impl Iterator<Item = (&OnC, &'static str, &'static str)> {
        self.on_c.iter().map(|on_c| {
            let on_model = match self.on_model(&on_c.name) {
                None => "NOT CHECKED",
                Some(checked) if checked.verdict.is_proved() => "holds",
                Some(checked) if checked.verdict.is_refuted() => "FAILS",
                Some(_) => "not decided",
            };
            (on_c, on_model, if on_c.is_proved { "proved" } else { "NOT PROVED" })
        })
    }

    fn run_time(&self) -> &'static str {
        if self.run_time.is_empty() { "proved" } else { "NOT PROVED" }
    }
}

/// Summary of the proofs of the shipped agent.
pub(super) fn proved(autopilot: &Findings) -> String {
    let mut text =
        String::from("The shipped agent, in every environment, for any number of steps\n");
    // Writing to a string cannot fail.
    for (OnC { name, .. }, on_model, on_c) in autopilot.rows() {
        _ = writeln!(text, "  {name:<28}model: {on_model:<10}C: {on_c}");
    }
    _ = writeln!(text, "  {:<46}C: {}", "no error at run time", autopilot.run_time());
    for error in &autopilot.run_time {
        _ = writeln!(text, "    possible: {error}");
    }
    for checked in autopilot.model.iter().filter(|one| !one.verdict.is_proved()) {
        _ = writeln!(
            text,
            "  {} does not hold of the model, counterexample:",
            checked.property.name
        );
        for happening in checked.verdict.counterexample() {
            _ = writeln!(text, "    {happening}");
        }
    }
    text
}

fn word(status: Status) -> &'static str {
    match status {
        Status::Shown => "shown",
        Status::Undecided => "NOT DECIDED",
        Status::Refuted => "REFUTED",
    }
}

impl Report {
    /// Report for the terminal.
    pub(super) fn lines(&self) -> String {
        let mut text = proved(&self.autopilot);
        for (what, status, detail) in self.further_evidence() {
            _ = writeln!(text, "  {what:<46}{:<12}{detail}", word(status));
        }
        for open in &self.evidence.validation.open {
            _ = writeln!(text, "    {open}");
        }
        text += "Mutants, each of which must break what it is made for\n";
        for caught in &self.mutants {
            let how = if caught.is_caught() { "caught: " } else { "NOT CAUGHT; broken: " };
            let broken = caught.broken.join(", ");
            _ = writeln!(text, "  {:<55}{how}{broken}", caught.mutant.name);
        }
        let Coverage { outcomes, lines, .. } = &self.coverage;
        let chosen = self.coverage.chosen();
        _ = writeln!(
            text,
            "The tests choose {chosen} plans; of the C they run {lines} lines, {outcomes} outcomes of conditions"
        );
        text
    }

    /// What is shown besides the properties.
    fn further_evidence(&self) -> [(&'static str, Status, String); 4] {
        let evidence = &self.evidence;
        let proofs = evidence.validation.proofs;
        let outcomes = evidence.reach.outcomes;
        [
            (
                "the C does what the text says",
                evidence.validation.status,
                format!("{proofs} proofs"),
            ),
            (
                "rules of MISRA C:2012",
                evidence.rules_status(),
                format!("{} deviations", evidence.deviations.len()),
            ),
            ("bounds of memory and time", evidence.bounds_status(), String::new()),
            (
                "tests made from the text, executed on the C",
                evidence.tests_status(),
                format!(
                    "{} tests; of {} outcomes of conditions {} tested, {} proved to be unreachable, {} open",
                    evidence.tests.len(),
                    outcomes.all,
                    outcomes.tested,
                    outcomes.unreachable,
                    outcomes.open()
                ),
            ),
        ]
    }

    /// Report for `docs/verification.md`.
    pub(super) fn markdown(&self) -> String {
        let mut text = String::from(INTRODUCTION);
        text += "| property | requirement | must hold | model | C |\n|---|---|---|---|---|\n";
        for (OnC { name, requirements, formula, .. }, on_model, on_c) in self.autopilot.rows() {
            let requirements = requirements.join(", ");
            _ = writeln!(text, "| `{name}` | {requirements} | `{formula}` | {on_model} | {on_c} |");
        }
        _ = writeln!(
            text,
            "| no error at run time | | no access outside an object, no overflow, no division by zero, no \
             conversion that loses, no uninitialised read | | {} |",
            self.autopilot.run_time()
        );
        let (invariant, candidates) = (self.evidence.invariant.len(), self.evidence.candidates);
        let Versions { cbmc, frama_c, spin } = &self.versions;
        _ = writeln!(
            text,
            "\nThe invariant has {invariant} conditions, found among {candidates} candidates. CBMC {cbmc}; \
             Frama-C {frama_c}; {spin}.\n"
        );
        text += EVIDENCE_INTRODUCTION;
        text += "| evidence | result | |\n|---|---|---|\n";
        for (what, status, detail) in self.further_evidence() {
            _ = writeln!(text, "| {what} | {} | {detail} |", word(status));
        }
        text.push('\n');
        text += MUTANTS_INTRODUCTION;
        text += "| mutant | made to break | broken on the C, at least | on the model |\n|---|---|---|---|\n";
        for caught in &self.mutants {
            let not = if caught.is_caught() { "" } else { "**not caught**; " };
            let on_model = match caught.on_model {
                Some(true) => "counterexample",
                Some(false) => "**holds**",
                None => "",
            };
            let (mutant, broken) = (caught.mutant, caught.broken.join(", "));
            _ = writeln!(
                text,
                "| {} | {} | {not}{broken} | {on_model} |",
                mutant.name, mutant.expected
            );
        }
        self.compare(&mut text);
        self.exercise(&mut text);
        _ = writeln!(text, "{COST}```text\n{}```", self.evidence.bounds.report);
        text += LIMITS;
        text
    }

    /// Section on the paper's agent.
    fn compare(&self, text: &mut String) {
        *text += PAPER_INTRODUCTION;
        *text += "| property | must hold | model | C |\n|---|---|---|---|\n";
        for (OnC { name, formula, .. }, on_model, on_c) in self.paper.rows() {
            _ = writeln!(text, "| `{name}` | `{formula}` | {on_model} | {on_c} |");
        }
        _ = writeln!(text, "| no error at run time | | | {} |", self.paper.run_time());
        let counterexample = self.paper.on_model("flying_goes_on");
        if let Some(checked) = counterexample.filter(|checked| checked.verdict.is_refuted()) {
            _ = writeln!(
                text,
                "\nThe counterexample of `asl2c verify` to `flying_goes_on`:\n\n```text"
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

`cargo xtask verify` proves the required properties of the shipped agent
([`autopilot.asl`](../autopilot/agent/autopilot.asl), [`autopilot.conf`](../autopilot/agent/autopilot.conf)),
makes all evidence for it, checks that the proofs can fail, measures the coverage of the tests, and, if all was shown, writes
this page. Without CBMC, SPIN or Frama-C it proves nothing and fails.

Each property is proved twice, in a nondeterministic environment: it may raise every event with any
arguments at any time, set beliefs to any values (including NaN), and return a different answer to each
query. Neither proof has a bound on the length of the flight.

- **On a model of the agent** (`asl2c verify`): events, beliefs that are held or not, and plans in Promela. SPIN
  visits every reachable state. A counterexample is shown in the agent's terms.
- **On the generated C**: CBMC shows that one transition (an event raised, a belief set, or a step) from *any* state
  that satisfies an invariant preserves the invariant and every property, and that the initial state satisfies it. The
  invariant is found automatically: from candidates about the agent's events and beliefs, those are removed that
  the initial state or some transition violates, until the rest is inductive. The result is kept
  ([`autopilot.invariant`](../xtask/src/verify/autopilot.invariant)): each run shows that it still is an invariant, and
  searches for another only if it does not prove everything. Frama-C's EVA analyses the same C from `init()` on.

The properties are part of the configuration; [the language guide](agentspeak.md#properties) defines their meaning. Those
for dangers refer to the agent's percepts and have no exceptions: a step that begins in danger commands the descent, whatever
is running and whatever the operator orders. Their numbers are those of the requirement, not the agent's limits, so
a changed limit violates them. `descending_goes_on` and `landing_goes_on` state that the descent continues to the ground,
also after the danger has passed.

";

const EVIDENCE_INTRODUCTION: &str = "\
## The evidence

`asl2c certify autopilot/agent/autopilot.conf -o DIR` makes all evidence for the shipped agent, as for any other. It is what
proves the properties on the C above; besides, it shows this:

";

const MUTANTS_INTRODUCTION: &str = "\
## The proof can fail

Each of these mutants is the shipped agent, its configuration or its C with one mistake, and violates
the intended property: the proof on the C fails, and on the model (unless the mistake is in the
C) SPIN finds a counterexample. On the C, most of them violate the property in one transition from a state that satisfies
the shipped agent's invariant; of the others, conditions are removed until the rest is inductive and the property fails.
An error at run time is found by Frama-C: for CBMC, an array in the state ends where the state does.

";

const PAPER_INTRODUCTION: &str = "
## The paper's autopilot

[`paper.asl`](../translator/agents/paper.asl) is the autopilot of Bucheli, Kroening, Martins and Natraj (TAROS 2015,
figures 1 and 2), rewritten from the description of its plans, with properties like those above
([`paper.conf`](../translator/agents/paper.conf)). The paper leaves as future work to prove that \"in every deliberation
cycle one of the basic actions is executed\". This does not hold: without a position, for orders without an applicable plan (a
take-off in the air, a target on the ground), and in the step in which a target is reached for the first time,
no command is sent. A landing order waits until the target is reached and the stay is over, without a bound. Because
`onGround` and `closeEnough` are sensors that may return different results in one step, goals are lost whose plans
query them twice. The shipped agent queries in order, with a last plan for all other cases, lets landing pre-empt,
and has failure plans.

";

const COVERAGE_INTRODUCTION: &str = "
## Coverage of the tests

Measured by gcov on the agent's C, in the agent's own tests and all flights in simulated time (500 of them with random
faults). A condition has two outcomes, true and false; the generated C evaluates one condition after the other, so
if all outcomes were seen, every decision was covered. Impossible outcomes count as missing: for example a limit
is always believed, and `airworthy` never. Plans name the requirements that they implement
(`@label[req(\"SAF-2\")]`).

";

const COST: &str = "
## Cost of a step

";

const LIMITS: &str = "
## Assumptions and limits

- The C is translated with the agent's state passed in, as the autopilot uses it. For `instance = static` the
  proofs cover the same plans and cycle, but not the other access to the state.
- That the C does what the text says is proved too, as by `asl2c validate` ([validation.md](validation.md)).
- CBMC, Frama-C, SPIN, the C compiler and the Rust code around the agent are trusted. The effect of an
  AT command is not part of the proof: it depends on the safety monitor, the session and the drone
  ([safety.md](safety.md)), and is tested.
- The properties for dangers refer to the agent's percepts. Tests cover the correct measurement of charge, blindness,
  position uncertainty (`doubt`) and saturation by the estimator and the flight program. An uncertainty that is NaN lands the
  drone too, which a comparison cannot express; that is tested.
- The agent has no clock. Its percepts include the time that it has been taking off, approaching, holding a position and
  descending, and in the proofs each may have any value in any step. `a_take_off_ends` therefore means: in a step in which
  the percept exceeds 10 s, the agent descends. That these times grow with the clock, and are not reset
  by a momentary arrival or blindness, is implemented by `Activity` (`autopilot/src/agent/activity.rs`),
  and tested.
  A clock of its own with a deadline of the take-off's goal was tried in place of the percept, and does not keep the properties:
  a deadline passes to the goals that follow, so that it ends a landing that has begun (`landing_goes_on`); with an integer
  clock its time can also overflow, after the take-off was ordered (`one_command`). SPIN shows both. And `a_take_off_ends`
  could not be stated: properties compare beliefs and know no clock.
- A stay is limited only by the plan's own time and the battery: a drone that drifts off starts it again, as long as there
  is time left to approach.
- The model has no values, so in general it proves less than the C; here it proves the same.
- Frama-C's WP with ACSL contracts is not used: CBMC proves the properties for every path through all functions,
  and frame conditions (what a function does not change) are part of the invariant.
";
