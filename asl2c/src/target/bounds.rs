//! Upper bounds over the flow graph of an image: instructions and stack from a function's call to its return.
//!
//! The graph is followed from address to address, through calls, and into the compiler's library. Functions of
//! the environment cost nothing. It has to be free of indirect jumps, and of cycles: no recursion and, for a number of
//! instructions, no loops. Then the longest path is an upper bound for any run.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::code::{Code, Flow, Instruction};

/// The graph of an image.
pub(super) struct Bounds<'a> {
    code: &'a Code,
    /// Addresses of the environment's functions.
    environment: HashSet<u64>,
}

/// Depths of the stack that are known, and the calls that are being followed.
#[derive(Debug, Default)]
struct Calls {
    known: HashMap<u64, u64>,
    callers: Vec<u64>,
}

impl<'a> Bounds<'a> {
    pub(super) fn new(code: &'a Code, environment: HashSet<u64>) -> Self {
        Self { code, environment }
    }

    /// Instructions of the longest path from an address to the return, or the reason why there is no such
    /// number.
    pub(super) fn instructions(&self, entry: u64) -> Result<u64, String> {
        let mut known: HashMap<u64, u64> = HashMap::new();
        let mut open = vec![entry];
        let mut on_the_way: HashSet<u64> = HashSet::new();
        // A depth-first search with an explicit stack, because a path may be long.
        while let Some(address) = open.last().copied() {
            if known.contains_key(&address) {
                open.pop();
                continue;
            }
            let instruction = self.at(address)?;
            let (followers, called) = self.followers(address, instruction)?;
            let needed = followers.iter().chain(&called);
            let waiting: Vec<u64> =
                needed.copied().filter(|next| !known.contains_key(next)).collect();
            if waiting.is_empty() {
                let rest = followers.iter().filter_map(|next| known.get(next));
                let rest = rest.copied().max().unwrap_or(0);
                let inside = called.and_then(|callee| known.get(&callee)).copied().unwrap_or(0);
                // It doubles with each level of goals.
                let length = inside.checked_add(rest).and_then(|length| length.checked_add(1));
                let length = length.ok_or("it has more instructions than fit into 64 bits")?;
                known.insert(address, length);
                on_the_way.remove(&address);
                open.pop();
                continue;
            }
            on_the_way.insert(address);
            if let Some(again) = waiting.iter().find(|next| on_the_way.contains(next)) {
                return Err(format!("`{}` has a loop or calls itself", self.code.function(*again)));
            }
            open.extend(waiting);
        }
        Ok(known.get(&entry).copied().unwrap_or(0))
    }

    /// Bytes of stack from an address on, of the function and all that it calls.
    pub(super) fn stack(&self, entry: u64) -> Result<u64, String> {
        self.depth(entry, &mut Calls::default())
    }

    /// Bytes of stack of the function at an address, without those that it calls.
    pub(super) fn frame(&self, entry: u64) -> Result<u64, String> {
        self.deepest(entry, |_| Ok(0))
    }

    fn depth(&self, entry: u64, calls: &mut Calls) -> Result<u64, String> {
        if let Some(depth) = calls.known.get(&entry) {
            return Ok(*depth);
        }
        if calls.callers.contains(&entry) {
            return Err(format!("`{}` calls itself", self.code.function(entry)));
        }
        calls.callers.push(entry);
        let depth = self.deepest(entry, |callee| self.depth(callee, calls))?;
        calls.callers.pop();
        calls.known.insert(entry, depth);
        Ok(depth)
    }

    /// The deepest stack of a function, given that of each function that it calls.
    fn deepest(
        &self,
        entry: u64,
        mut inside: impl FnMut(u64) -> Result<u64, String>,
    ) -> Result<u64, String> {
        let reachable = self.reachable(entry)?;
        let mut ways: HashMap<u64, i64> = HashMap::new();
        // Repeated until nothing changes, backwards because most code goes on forwards. More passes than there are
        // instructions are needed only if a loop takes more stack in each round.
        for _ in 0..=reachable.len() {
            let mut changed = false;
            for address in reachable.iter().rev() {
                let instruction = self.at(*address)?;
                let (followers, called) = self.followers(*address, instruction)?;
                let rest = followers.iter().filter_map(|next| ways.get(next)).copied().max();
                let called = called.map_or(Ok(0), &mut inside)?;
                let need = rest.unwrap_or(0).max(i64::try_from(called).unwrap_or(i64::MAX));
                let need = need.saturating_add(instruction.pushes).max(0);
                changed |= ways.insert(*address, need) != Some(need);
            }
            if !changed {
                let depth = ways.get(&entry).copied().unwrap_or(0);
                return Ok(u64::try_from(depth).unwrap_or(0));
            }
        }
        Err(format!("the stack of `{}` grows in a loop", self.code.function(entry)))
    }

    /// All addresses of a function: without calls, with jumps to the code of others.
    fn reachable(&self, entry: u64) -> Result<BTreeSet<u64>, String> {
        let mut found = BTreeSet::from([entry]);
        let mut open = vec![entry];
        while let Some(address) = open.pop() {
            let instruction = self.at(address)?;
            let (followers, _) = self.followers(address, instruction)?;
            open.extend(followers.into_iter().filter(|next| found.insert(*next)));
        }
        Ok(found)
    }

    fn at(&self, address: u64) -> Result<&'a Instruction, String> {
        let function = || self.code.function(address);
        match self.code.instructions.get(&address) {
            Some(Ok(instruction)) => Ok(instruction),
            Some(Err(reason)) => Err(format!("{reason}, in `{}`", function())),
            None => Err(format!("there is no code at {address:#x}, in `{}`", function())),
        }
    }

    /// The instructions of the same call that may follow, and the function that is called before. A jump to a function
    /// of the environment ends the way.
    fn followers(
        &self,
        address: u64,
        instruction: &Instruction,
    ) -> Result<(Vec<u64>, Option<u64>), String> {
        let next = || {
            let end = || format!("`{}` has no end", self.code.function(address));
            self.code.after(address).ok_or_else(end)
        };
        let own = |target: u64| !self.environment.contains(&target);
        Ok(match instruction.flow {
            Flow::Next | Flow::MayReturn => (vec![next()?], None),
            Flow::Branch(target) => {
                let mut followers = vec![next()?];
                followers.extend(Some(target).filter(|target| own(*target)));
                (followers, None)
            }
            Flow::Jump(target) => {
                (Some(target).filter(|target| own(*target)).into_iter().collect(), None)
            }
            Flow::Call(target) => (vec![next()?], Some(target).filter(|target| own(*target))),
            Flow::Return => (Vec::new(), None),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: &str = "\
00000010 <step>:\n  10:\tpush\t{r4, lr}\n  12:\tcbz\tr0, 1a <step+0xa>\n  14:\tbl\t30 <help>\n  16:\tbl\t90 <act>\n\
  18:\tpop\t{r4, pc}\n  1a:\tldmia.w\tsp!, {r4, lr}\n  1e:\tb.n\t30 <help>\n\
00000030 <help>:\n  30:\tsub\tsp, #16\n  32:\tadd\tsp, #16\n  34:\tbx\tlr\n\
00000090 <act>:\n  90:\tpush\t{r0, r1, r2, r3}\n  92:\tb.n\t90 <act>\n";

    #[test]
    fn the_longest_path_and_the_deepest_stack_go_through_calls() {
        let code = Code::parse(STEP);
        let bounds = Bounds::new(&code, HashSet::from([0x90]));
        // push, cbz, bl, three of help, bl act, pop
        assert_eq!(bounds.instructions(0x10), Ok(8));
        assert_eq!(bounds.stack(0x10), Ok(24));
        assert_eq!(bounds.frame(0x10), Ok(16));
        assert_eq!(bounds.stack(0x30), Ok(16));
    }

    #[test]
    fn loops_and_recursion_have_no_bound() {
        let code = Code::parse(STEP);
        // The action is followed: each round of its loop pushes more.
        let bounds = Bounds::new(&code, HashSet::new());
        assert!(bounds.instructions(0x10).unwrap_err().contains("`act` has a loop"));
        assert!(bounds.stack(0x10).unwrap_err().contains("grows"));
        let code = Code::parse("00000010 <f>:\n  10:\tbl\t10 <f>\n  14:\tbx\tlr\n");
        let bounds = Bounds::new(&code, HashSet::new());
        assert!(bounds.instructions(0x10).unwrap_err().contains("`f`"));
        assert!(bounds.stack(0x10).unwrap_err().contains("`f` calls itself"));
    }

    #[test]
    fn the_stack_of_a_loop_that_releases_what_it_takes_is_known() {
        let code = Code::parse(
            "00000010 <f>:\n  10:\tpush\t{r4, lr}\n  12:\tsub\tsp, #8\n  14:\tadd\tsp, #8\n  \
             16:\tbne.n\t12 <f+0x2>\n  18:\tpop\t{r4, pc}\n",
        );
        let bounds = Bounds::new(&code, HashSet::new());
        assert_eq!(bounds.stack(0x10), Ok(16));
        assert!(bounds.instructions(0x10).is_err());
    }
}
