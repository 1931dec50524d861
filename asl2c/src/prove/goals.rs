//! Goals whose truth is known before, which accompany each proof in the same program and the same run.
//!
//! A tool that only prints success, that does not read the program, or whose solver is broken is not noticed by what it
//! says of an agent: that may well be right. It is noticed by these goals. Each says that `A·x² + B·x` is not `D` modulo
//! 256 for an arbitrary byte `x`; whether there is such an `x` was found out here, by trying all, and is not to be seen
//! without calculating. Which of them are false, and all numbers and names, are different each time.

use std::fmt::Write as _;
use std::hash::{BuildHasher as _, RandomState};

use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Number of goals before the proof.
const COUNT: usize = 5;

/// Goals of known truth around a function that is proved.
#[derive(Debug)]
pub(super) struct Goals {
    /// Begins all names.
    nonce: String,
    /// Before the function.
    before: Vec<Goal>,
    /// The number of the goal after the function, which is false. Numbers do not tell places.
    end: usize,
    place: Place,
}

/// Where goals stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    /// There are none.
    Nowhere,
    /// Only before the function: what comes after it would keep CBMC from leaving out what one assertion does not need.
    Before,
    /// Also after it, so that a proof of which no execution comes to the end is noticed.
    Around,
}

#[derive(Debug, Clone, Copy)]
struct Goal {
    number: usize,
    square: u8,
    linear: u8,
    avoided: u8,
    holds: bool,
}

impl Goal {
    /// As C, of the byte with this name.
    fn condition(self, byte: &str) -> String {
        let Self { square, linear, avoided, .. } = self;
        let byte = format!("(unsigned int){byte}");
        format!("(((({square}U * {byte}) * {byte}) + ({linear}U * {byte})) & 255U) != {avoided}U")
    }

    fn value(square: u8, linear: u8, byte: u8) -> u8 {
        let squared = square.wrapping_mul(byte).wrapping_mul(byte);
        squared.wrapping_add(linear.wrapping_mul(byte))
    }
}

impl Goals {
    /// Goals that nobody can know before.
    pub(super) fn new(place: Place) -> Self {
        Self::of(place, &mut ChaCha8Rng::seed_from_u64(RandomState::new().hash_one(COUNT)))
    }

    fn of(place: Place, random: &mut ChaCha8Rng) -> Self {
        let nonce = format!("goal_{:016x}", random.random::<u64>());
        let mut numbers: Vec<usize> = (0..=COUNT).collect();
        for last in (1..numbers.len()).rev() {
            numbers.swap(last, random.random_range(0..=last));
        }
        // At least one is true, and one false.
        let mask = random.random_range(1..(1_u32 << COUNT) - 1);
        // All false ones fail for the same bytes: the solver finds them with one assignment, not with one for each.
        let linear: u8 = random.random();
        let fails_for: u8 = random.random();
        let reached = |value: u8| (0..=u8::MAX).any(|byte| Goal::value(1, linear, byte) == value);
        let unreached: Vec<u8> = (0..=u8::MAX).filter(|value| !reached(*value)).collect();
        let goals = (0..COUNT).map(|index| {
            let holds = mask & (1 << index) != 0;
            let value = if holds {
                // Squares are never all values modulo 256.
                unreached[random.random_range(0..unreached.len())]
            } else {
                Goal::value(1, linear, fails_for)
            };
            // Odd numbers have inverses modulo 256, so that this changes no truth.
            let factor = random.random::<u8>() | 1;
            let (linear, avoided) = (linear.wrapping_mul(factor), value.wrapping_mul(factor));
            Goal { number: numbers[index], square: factor, linear, avoided, holds }
        });
        let before = if place == Place::Nowhere { Vec::new() } else { goals.collect() };
        Self { nonce, before, end: numbers[COUNT], place }
    }

    /// The name of the file that [`Self::program`] is the text of.
    pub(super) fn file(&self) -> String {
        format!("{}.c", self.nonce)
    }

    /// The function to prove in place of the given one.
    pub(super) fn function(&self) -> &str {
        &self.nonce
    }

    /// C that includes a file, and has a function with the goals before and after a call of one in it.
    pub(super) fn program(&self, file: &str, function: &str) -> String {
        let nonce = &self.nonce;
        let byte = format!("{nonce}_byte");
        let mut text = format!("#include \"{file}\"\nvoid {nonce}(void)\n{{\n");
        // Writing to a string cannot fail.
        if !self.before.is_empty() {
            _ = writeln!(text, "    unsigned char {byte};");
        }
        for goal in &self.before {
            let (condition, number) = (goal.condition(&byte), goal.number);
            _ = writeln!(text, "    __CPROVER_assert({condition}, \"{nonce} {number}\");");
        }
        _ = writeln!(text, "    (void){function}();");
        if self.place == Place::Around {
            _ = writeln!(text, "    __CPROVER_assert(0, \"{nonce} {}\");", self.end);
        }
        text + "}\n"
    }

    /// The number of a goal with this description, if it is one.
    pub(super) fn number(&self, said: &str) -> Option<usize> {
        said.strip_prefix(&self.nonce)?.trim().parse().ok()
    }

    /// Whether the goals before the function were judged as they are; `holds` is what the tool says of the goal with a
    /// number. The reason otherwise.
    pub(super) fn judge(&self, holds: impl Fn(usize) -> Option<bool>) -> Result<(), &'static str> {
        for goal in &self.before {
            match holds(goal.number) {
                None => return Err("it does not say whether a goal of known truth holds"),
                Some(true) if !goal.holds => return Err("it proves a goal that is false"),
                Some(false) if goal.holds => return Err("it refutes a goal that is true"),
                Some(_) => {}
            }
        }
        Ok(())
    }

    /// Whether the goal after the function is refuted, if there is one: it holds if no execution comes to it.
    pub(super) fn reaches_end(&self, holds: impl Fn(usize) -> Option<bool>) -> bool {
        self.place == Place::Around && holds(self.end) == Some(false)
    }

    /// Whether the goal after the function is proved: no execution comes to it.
    pub(super) fn excludes_end(&self, holds: impl Fn(usize) -> Option<bool>) -> bool {
        self.place == Place::Around && holds(self.end) == Some(true)
    }

    /// C whose branches are taken or not: for each goal one that is taken if it does not hold, in a line of its own.
    /// The lines follow that of the function's brace.
    pub(super) fn branches(&self, file: &str, function: &str) -> String {
        let nonce = &self.nonce;
        let byte = format!("{nonce}_byte");
        let mut text = format!("#include \"{file}\"\nint {nonce}_taken;\nvoid {nonce}(void) {{\n");
        _ = writeln!(text, "    unsigned char {byte};");
        for goal in &self.before {
            let (condition, number) = (goal.condition(&byte), goal.number);
            _ = writeln!(text, "    if (!({condition})) {{ {nonce}_taken = {number}; }}");
        }
        _ = writeln!(text, "    (void){function}();\n}}");
        text
    }

    /// Whether the branches of [`Self::branches`] were judged as they are; `dead` are the lines whose condition is
    /// never true, and never false. The reason otherwise.
    pub(super) fn judge_branches(
        &self,
        never: impl Fn(usize, bool) -> bool,
    ) -> Result<(), &'static str> {
        const FIRST: usize = 5;
        for (line, goal) in (FIRST..).zip(&self.before) {
            if never(line, true) != goal.holds {
                return Err("it misjudges whether a branch can be taken");
            }
            if never(line, false) {
                return Err("it says that a branch is never left out that can be");
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_are_what_they_are_said_to_be() {
        for seed in 0..500 {
            let goals = Goals::of(Place::Around, &mut ChaCha8Rng::seed_from_u64(seed));
            let truth = |goal: &Goal| {
                (0..=u8::MAX)
                    .all(|byte| Goal::value(goal.square, goal.linear, byte) != goal.avoided)
            };
            for goal in &goals.before {
                assert_eq!(truth(goal), goal.holds, "{goal:?}");
            }
            let some = |holds: bool| goals.before.iter().any(|goal| goal.holds == holds);
            assert!(some(true) && some(false));
            // Whoever says the same of all, or nothing, is noticed.
            for said in [None, Some(true), Some(false)] {
                assert!(goals.judge(|_| said).is_err());
            }
            let right = |number: usize| {
                goals.before.iter().find(|goal| goal.number == number).map(|goal| goal.holds)
            };
            assert_eq!(goals.judge(right), Ok(()));
            let but_one = |number: usize| {
                right(number).map(|holds| holds != (number == goals.before[0].number))
            };
            assert!(goals.judge(but_one).is_err());
        }
    }

    #[test]
    fn an_end_is_reached_if_its_goal_is_refuted() {
        let ends = |place, said: Option<bool>| {
            let goals = Goals::new(place);
            let of_end = |number: usize| if number == goals.end { said } else { Some(false) };
            (goals.reaches_end(of_end), goals.excludes_end(of_end))
        };
        assert_eq!(ends(Place::Around, Some(false)), (true, false));
        assert_eq!(ends(Place::Around, Some(true)), (false, true));
        assert_eq!(ends(Place::Around, None), (false, false));
        for said in [None, Some(true), Some(false)] {
            assert_eq!(ends(Place::Before, said), (false, false));
        }
    }

    #[test]
    fn goals_differ_each_time() {
        assert_ne!(Goals::new(Place::Before).nonce, Goals::new(Place::Before).nonce);
    }
}
