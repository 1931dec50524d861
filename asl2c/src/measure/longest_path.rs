//! Longest path through the compiled C: an upper bound of the instructions of a step.
//!
//! The generated C has no loops and no recursion, so the compiled code should have neither. This is checked
//! on the compiler's assembly: neither the flow graph of a function nor the call graph may have a cycle. The
//! longest path is then exact for the graph, and an upper bound for any run.

use std::collections::HashMap;

/// Instructions from the call of `entry` to its return over the longest path, or the reason why there is no
/// such number. Functions that the assembly does not define, the basic actions, cost nothing.
pub(super) fn longest(assembly: &str, entry: &str) -> Result<u64, String> {
    let functions = functions(assembly)?;
    let mut longest = Longest { functions: &functions, known: HashMap::new() };
    if !functions.contains_key(entry) {
        return Err(format!("the assembly has no `{entry}`"));
    }
    longest.function(entry)
}

/// Successors of an instruction.
#[derive(Debug, PartialEq, Eq)]
enum Flow<'a> {
    Next,
    /// This label or the next instruction.
    Branch(&'a str),
    Jump(&'a str),
    /// A call, then the next instruction.
    Call(&'a str),
    /// A call, then the return to the caller.
    TailCall(&'a str),
    Return,
}

/// A function: its instructions, and the positions of its labels.
#[derive(Debug, Default)]
struct Function<'a> {
    instructions: Vec<Flow<'a>>,
    labels: HashMap<&'a str, usize>,
}

/// The functions of an assembly in AT&T syntax for x86-64.
fn functions(assembly: &str) -> Result<HashMap<&str, Function<'_>>, String> {
    let mut functions: HashMap<&str, Function<'_>> = HashMap::new();
    let mut current: Option<&str> = None;
    for line in assembly.lines() {
        let text = line.trim();
        if let Some(label) = text.strip_suffix(':').filter(|_| !line.starts_with('\t')) {
            if label.starts_with('.') {
                if let Some(function) = current.and_then(|name| functions.get_mut(name)) {
                    function.labels.insert(label, function.instructions.len());
                }
            } else {
                current = Some(label);
                functions.entry(label).or_default();
            }
        } else if text.starts_with(".size") {
            current = None;
        } else if line.starts_with('\t')
            && !text.starts_with(['.', '#'])
            && let Some(function) = current.and_then(|name| functions.get_mut(name))
        {
            function.instructions.push(flow(text)?);
        }
    }
    Ok(functions)
}

fn flow(instruction: &str) -> Result<Flow<'_>, String> {
    let mut words =
        instruction.split_whitespace().filter(|word| !["notrack", "bnd"].contains(word));
    let mnemonic = words.next().unwrap_or_default();
    let target = words.next().unwrap_or_default().trim_end_matches("@PLT");
    if target.starts_with('*') && (mnemonic.starts_with('j') || mnemonic.starts_with("call")) {
        return Err(format!("`{instruction}` may jump anywhere"));
    }
    Ok(match mnemonic {
        "ret" | "retq" | "ud2" => Flow::Return,
        "call" | "callq" => Flow::Call(target),
        "jmp" if target.starts_with(".L") => Flow::Jump(target),
        "jmp" => Flow::TailCall(target),
        _ if mnemonic.starts_with('j') => Flow::Branch(target),
        _ => Flow::Next,
    })
}

struct Longest<'a> {
    functions: &'a HashMap<&'a str, Function<'a>>,
    /// `None` while a function is being evaluated.
    known: HashMap<&'a str, Option<u64>>,
}

impl<'a> Longest<'a> {
    fn function(&mut self, name: &'a str) -> Result<u64, String> {
        let Some(function) = self.functions.get(name) else { return Ok(0) };
        match self.known.get(name) {
            Some(Some(length)) => return Ok(*length),
            Some(None) => return Err(format!("`{name}` calls itself")),
            None => {}
        }
        self.known.insert(name, None);
        let mut lengths = vec![None; function.instructions.len()];
        let length = self.path(name, function, &mut lengths)?;
        self.known.insert(name, Some(length));
        Ok(length)
    }

    /// The longest path from the first instruction. The depth-first search has an explicit stack, because a
    /// path may be very long.
    fn path(
        &mut self,
        name: &str,
        function: &'a Function<'a>,
        lengths: &mut [Option<u64>],
    ) -> Result<u64, String> {
        let mut open = vec![0_usize];
        let mut on_the_way = vec![false; lengths.len()];
        while let Some(index) = open.last().copied() {
            let followers = followers(function, index)?;
            let waiting: Vec<usize> =
                followers.iter().copied().filter(|next| lengths[*next].is_none()).collect();
            if lengths[index].is_none() && !waiting.is_empty() {
                on_the_way[index] = true;
                if waiting.iter().any(|next| on_the_way[*next]) {
                    return Err(format!("`{name}` has a loop"));
                }
                open.extend(waiting);
                continue;
            }
            open.pop();
            on_the_way[index] = false;
            if lengths[index].is_some() {
                continue;
            }
            let called = match &function.instructions[index] {
                Flow::Call(callee) | Flow::TailCall(callee) => self.function(callee)?,
                Flow::Next | Flow::Branch(_) | Flow::Jump(_) | Flow::Return => 0,
            };
            let rest = followers.iter().filter_map(|next| lengths[*next]).max().unwrap_or(0);
            // It doubles with each level of goals.
            let length = called.checked_add(rest).and_then(|length| length.checked_add(1));
            lengths[index] = Some(length.ok_or("it has more instructions than fit into 64 bits")?);
        }
        Ok(lengths.first().copied().flatten().unwrap_or(0))
    }
}

/// Possible successors of an instruction within its function.
fn followers(function: &Function<'_>, index: usize) -> Result<Vec<usize>, String> {
    let label = |label: &str| {
        function.labels.get(label).copied().ok_or_else(|| format!("there is no label `{label}`"))
    };
    let next = index + 1;
    let all = match &function.instructions[index] {
        Flow::Next | Flow::Call(_) => vec![next],
        Flow::Branch(target) => vec![next, label(target)?],
        Flow::Jump(target) => vec![label(target)?],
        Flow::TailCall(_) | Flow::Return => Vec::new(),
    };
    Ok(all.into_iter().filter(|next| *next < function.instructions.len()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: &str = "\t.globl step\nstep:\n\tendbr64\n\tcmpl\t$1, %edi\n\tje\t.L2\n\tcall\thelp\n\
        \tcall\tact@PLT\n\tret\n.L2:\n\tnop\n\tjmp\thelp\n\t.size\tstep, .-step\n\
        help:\n\tnop\n\tnop\n\tret\n\t.size help, .-help\n";

    #[test]
    fn the_longest_path_counts_with_what_it_calls() {
        // endbr64, cmpl, je, call help (3), call act (elsewhere), ret
        assert_eq!(longest(STEP, "step"), Ok(9));
        assert_eq!(longest(STEP, "help"), Ok(3));
    }

    #[test]
    fn what_has_no_longest_path_is_refused() {
        let double =
            |below: u32| format!("f{}:\n\tcall\tf{below}\n\tcall\tf{below}\n\tret\n", below + 1);
        let doubled: Vec<String> = (0..79).map(double).collect();
        let doubled = format!("f0:\n\tnop\n\tret\n{}", doubled.concat());
        assert!(longest(&doubled, "f50").is_ok() && longest(&doubled, "f79").is_err());
        let looped = "f:\n.L1:\n\tnop\n\tjne\t.L1\n\tret\n";
        assert_eq!(longest(looped, "f"), Err("`f` has a loop".to_owned()));
        let recursive = "f:\n\tcall\tf\n\tret\n";
        assert_eq!(longest(recursive, "f"), Err("`f` calls itself".to_owned()));
        assert!(longest("f:\n\tjmp\t*%rax\n", "f").is_err());
        assert!(longest(STEP, "other").is_err());
        // A backward jump in the text is not necessarily a cycle.
        let back = "f:\n\tjmp\t.L2\n.L1:\n\tret\n.L2:\n\tnop\n\tjmp\t.L1\n";
        assert_eq!(longest(back, "f"), Ok(4));
    }
}
