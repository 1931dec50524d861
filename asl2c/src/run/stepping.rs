//! Steps of a run.

use super::monitor::Step;
use super::session::Session;

/// Maximum number of plans and formulas that one step may try, far above the longest step of a real agent.
const LONGEST: u32 = 100_000;
/// Maximum number of lines that a command may show.
const MOST_LINES: usize = 100_000;
/// Number of earlier states that `run` compares with, to detect a cycle.
const LOOKED_BACK: usize = 64;

impl Session {
    pub(super) fn make_steps(&mut self, count: u32, shown: &mut Vec<String>) -> Result<(), String> {
        for _ in 0..count {
            self.step(shown)?;
        }
        Ok(())
    }

    /// Executes steps until no event is pending or a state repeats.
    pub(super) fn run(&mut self, most: u32, shown: &mut Vec<String>) -> Result<(), String> {
        let mut seen = vec![(self.now.steps, self.now.agent.clone())];
        for _ in 0..most {
            if self.now.agent.waiting().is_empty() {
                shown.push("// no event is pending".to_owned());
                return Ok(());
            }
            self.step(shown)?;
            let agent = &self.now.agent;
            let again = seen.iter().rev().take(LOOKED_BACK).find(|(_, then)| agent.is_like(then));
            if let Some((then, _)) = again.filter(|_| self.now.world.is_constant()) {
                let now = self.now.steps;
                shown.push(format!("// step {now} ends in the same state as step {then}"));
                return Ok(());
            }
            seen.push((self.now.steps, agent.clone()));
            if seen.len() > LOOKED_BACK {
                seen.remove(0);
            }
        }
        shown.push(format!("// stopped after {most} steps"));
        Ok(())
    }

    fn step(&mut self, shown: &mut Vec<String>) -> Result<(), String> {
        if shown.len() > MOST_LINES {
            return Err(format!("stopped: there are more than {MOST_LINES} lines to show"));
        }
        let before = self.now.clone();
        let now = &mut self.now;
        now.world.begin_step();
        now.monitors.begin_step(&self.configuration, &now.agent);
        let lost = now.agent.unhandled_events();
        if now.agent.next_step_within(LONGEST, &mut now.world).is_err() {
            self.now = before;
            return Err(format!(
                "this step tries more than {LONGEST} plans and formulas, or nests calls too deep: it is not executed"
            ));
        }
        now.steps += 1;
        let step = Step { calls: &now.world.calls, lost: now.agent.unhandled_events() != lost };
        shown.append(&mut now.world.shown);
        if step.lost {
            shown.push(format!("// step {}: an event was not handled completely", now.steps));
        }
        for property in now.monitors.end_step(&step, &self.configuration, &now.agent) {
            shown.push(format!("// step {} breaks `{}`", now.steps, property.name.text));
            self.broken.push(property.name.text.clone());
        }
        Ok(())
    }
}
