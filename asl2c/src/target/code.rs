//! The instructions of an image, from its disassembly by objdump.

use std::collections::BTreeMap;

/// Possible continuations of an instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Flow {
    Next,
    /// This address or the next instruction.
    Branch(u64),
    Jump(u64),
    /// A call, then the next instruction.
    Call(u64),
    /// A return to the caller, or the next instruction.
    MayReturn,
    Return,
}

/// An instruction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Instruction {
    pub(super) flow: Flow,
    /// Bytes by which it extends the stack; negative if it releases them.
    pub(super) pushes: i64,
}

/// The code of an image by address.
#[derive(Debug, Default)]
pub(super) struct Code {
    /// What cannot be followed is an error with its text, which matters only where it is reachable.
    pub(super) instructions: BTreeMap<u64, Result<Instruction, String>>,
    /// Names by address.
    pub(super) names: BTreeMap<u64, String>,
    /// Functions that begin by making room on the stack and then save registers below it, with the bytes of the room.
    reserved: BTreeMap<u64, u64>,
}

impl Code {
    /// Parses the output of `objdump -d --no-show-raw-insn` for Thumb code.
    pub(super) fn parse(disassembly: &str) -> Self {
        let mut code = Self::default();
        // The function whose first instruction is next, or the room that it has made.
        let (mut begins, mut made) = (None, None);
        for line in disassembly.lines() {
            if let Some((address, name)) = label(line) {
                code.names.insert(address, name.to_owned());
                (begins, made) = (Some(address), None);
            } else if let Some((address, text)) = line.split_once(":\t")
                && let Ok(address) = u64::from_str_radix(address.trim(), 16)
                // Constants between instructions.
                && !text.starts_with('.')
            {
                if let Some((function, bytes)) = made.take()
                    && text.starts_with("push\t")
                {
                    code.reserved.insert(function, bytes);
                }
                made = begins.take().zip(room(text));
                code.instructions.insert(address, instruction(text));
            }
        }
        code
    }

    /// Bytes that a function takes from the stack before it saves registers: for parameters that came in registers.
    pub(super) fn reserves(&self, function: u64) -> Option<u64> {
        self.reserved.get(&function).copied()
    }

    /// The address after an instruction's.
    pub(super) fn after(&self, address: u64) -> Option<u64> {
        self.instructions.range(address + 1..).next().map(|(address, _)| *address)
    }

    /// The function that contains an address.
    pub(super) fn function(&self, address: u64) -> &str {
        self.names.range(..=address).next_back().map_or("?", |(_, name)| name)
    }
}

/// The bytes of `sub sp, #16`.
fn room(text: &str) -> Option<u64> {
    text.strip_prefix("sub\tsp, #")?.split_whitespace().next()?.parse().ok()
}

/// `00000040 <next_step>:`
fn label(line: &str) -> Option<(u64, &str)> {
    let (address, name) = line.strip_suffix(">:")?.split_once(" <")?;
    Some((u64::from_str_radix(address, 16).ok()?, name))
}

fn instruction(text: &str) -> Result<Instruction, String> {
    // A comment follows `;` or `@`.
    let text = text.split([';', '@']).next().unwrap_or_default().trim();
    let (mnemonic, operands) = text.split_once('\t').unwrap_or((text, ""));
    let refused = || format!("`{}` cannot be followed", text.replace('\t', " "));
    let mnemonic = mnemonic.trim_end_matches(".n").trim_end_matches(".w");
    let (flow, pushes) =
        flow(mnemonic, operands).zip(pushes(mnemonic, operands)).ok_or_else(refused)?;
    Ok(Instruction { flow, pushes })
}

const CONDITIONS: [&str; 16] = [
    "eq", "ne", "cs", "hs", "cc", "lo", "mi", "pl", "vs", "vc", "hi", "ls", "ge", "lt", "gt", "le",
];

/// Whether the mnemonic is this one with a condition.
fn is_conditional(mnemonic: &str, of: &str) -> bool {
    mnemonic.strip_prefix(of).is_some_and(|condition| CONDITIONS.contains(&condition))
}

fn flow(mnemonic: &str, operands: &str) -> Option<Flow> {
    let target = |text: &str| u64::from_str_radix(text.split_whitespace().next()?, 16).ok();
    match mnemonic {
        "b" => return target(operands).map(Flow::Jump),
        "bl" => return target(operands).map(Flow::Call),
        "cbz" | "cbnz" => return target(operands.split_once(", ")?.1).map(Flow::Branch),
        "bx" => return (operands == "lr").then_some(Flow::Return),
        // Stops the processor.
        "udf" => return Some(Flow::Return),
        "blx" | "tbb" | "tbh" | "svc" | "bkpt" => return None,
        _ => {}
    }
    if is_conditional(mnemonic, "b") {
        return target(operands).map(Flow::Branch);
    }
    if is_conditional(mnemonic, "bl") {
        return target(operands).map(Flow::Call);
    }
    if is_conditional(mnemonic, "bx") {
        return (operands == "lr").then_some(Flow::MayReturn);
    }
    if is_conditional(mnemonic, "blx") {
        return None;
    }
    let first = operands.split([',', ' ']).next().unwrap_or_default();
    let listed = operands.split_once('{').is_some_and(|(_, list)| list.contains("pc"));
    if listed {
        // Loads the program counter from the stack.
        return match mnemonic {
            "pop" => Some(Flow::Return),
            "ldmia" | "ldmfd" | "ldm" if first == "sp!" => Some(Flow::Return),
            _ if is_conditional(mnemonic, "pop") => Some(Flow::MayReturn),
            _ if first == "sp!" && is_conditional(mnemonic, "ldmia") => Some(Flow::MayReturn),
            _ => None,
        };
    }
    if first == "pc" {
        let from_stack = mnemonic == "ldr" && operands.starts_with("pc, [sp], #");
        return from_stack.then_some(Flow::Return);
    }
    Some(Flow::Next)
}

/// Bytes that an instruction adds to the stack; `None` if that is unknown.
fn pushes(mnemonic: &str, operands: &str) -> Option<i64> {
    let listed = || registers(operands.split_once('{')?.1.trim_end_matches('}'));
    let number = |text: &str| text.strip_prefix('#')?.parse::<i64>().ok();
    match mnemonic {
        "push" | "vpush" => return listed(),
        "pop" | "vpop" => return Some(-listed()?),
        _ => {}
    }
    if let Some(rest) = operands.strip_prefix("sp!, ") {
        return match mnemonic {
            "stmdb" | "stmfd" | "vstmdb" => registers(rest.trim_matches(['{', '}'])),
            "ldmia" | "ldmfd" | "ldm" | "vldmia" => {
                Some(-registers(rest.trim_matches(['{', '}']))?)
            }
            // A return that may not happen releases nothing on the way that goes on.
            _ if is_conditional(mnemonic, "ldmia") && rest.contains("pc") => Some(0),
            _ => None,
        };
    }
    if is_conditional(mnemonic, "pop") && operands.contains("pc") {
        return Some(0);
    }
    if is_conditional(mnemonic, "pop") || is_conditional(mnemonic, "push") {
        return None;
    }
    if let Some((_, offset)) = operands.split_once("[sp, ")
        && let Some(offset) = offset.strip_suffix("]!")
    {
        return Some(-number(offset)?);
    }
    if let Some((_, offset)) = operands.split_once("[sp], ") {
        return Some(-number(offset)?);
    }
    let Some(rest) = operands.strip_prefix("sp, ") else {
        return (!operands.contains("sp!") && operands != "sp").then_some(0);
    };
    let count = number(rest.strip_prefix("sp, ").unwrap_or(rest));
    match mnemonic {
        // Stores or loads without moving the pointer.
        "stmia" | "stm" | "ldmia" | "ldm" if rest.starts_with('{') && !rest.contains("pc") => {
            Some(0)
        }
        "sub" | "subw" => count,
        "add" | "addw" => Some(-count?),
        "cmp" => Some(0),
        _ => None,
    }
}

/// Bytes of a list of registers: `r4, r5, lr` or `d8-d11`.
fn registers(list: &str) -> Option<i64> {
    let mut bytes = 0;
    for register in list.split(',').map(str::trim) {
        let width = if register.starts_with('d') { 8 } else { 4 };
        bytes += match register.split_once('-') {
            Some((first, last)) => {
                let number = |name: &str| name.get(1..)?.parse::<i64>().ok();
                width * (number(last)? - number(first)? + 1)
            }
            None => width,
        };
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_go_on_where_they_do_on_the_processor() {
        for (text, flow, pushes) in [
            ("push\t{r4, r5, r6, lr}", Flow::Next, 16),
            ("stmdb\tsp!, {r4, r5, r6, r7, r8, lr}", Flow::Next, 24),
            ("vpush\t{d8-d11}", Flow::Next, 32),
            ("vpush\t{s16}", Flow::Next, 4),
            ("stmia.w\tsp, {r0, r1}", Flow::Next, 0),
            ("sub\tsp, #16", Flow::Next, 16),
            ("add.w\tsp, sp, #512\t; 0x200", Flow::Next, -512),
            ("str.w\tlr, [sp, #-4]!", Flow::Next, 4),
            ("strd\tr4, r5, [sp, #-16]!", Flow::Next, 16),
            ("ldr.w\tpc, [sp], #4", Flow::Return, -4),
            ("pop\t{r4, pc}", Flow::Return, -8),
            ("ldmia.w\tsp!, {r4, r5, pc}", Flow::Return, -12),
            ("popne\t{r4, pc}", Flow::MayReturn, 0),
            ("bxeq\tlr", Flow::MayReturn, 0),
            ("bx\tlr", Flow::Return, 0),
            ("bl\t2304 <__adddf3>", Flow::Call(0x2304), 0),
            ("b.n\t46 <f+0x6>", Flow::Jump(0x46), 0),
            ("bls.n\t46 <f+0x6>", Flow::Branch(0x46), 0),
            ("cbz\tr0, 46 <f+0x6>", Flow::Branch(0x46), 0),
            ("bic.w\tr0, r1, r2", Flow::Next, 0),
            ("ldr\tr0, [pc, #8]\t; (50 <f+0x10>)", Flow::Next, 0),
            ("ldr\tr0, [sp, #8]", Flow::Next, 0),
            ("it\tne", Flow::Next, 0),
        ] {
            assert_eq!(instruction(text), Ok(Instruction { flow, pushes }), "{text}");
        }
    }

    #[test]
    fn what_may_go_anywhere_is_not_followed() {
        for text in [
            "blx\tr3",
            "bx\tr3",
            "tbb\t[pc, r0]",
            "mov\tpc, r0",
            "ldr.w\tpc, [r3, #4]",
            "ldmia\tr0!, {r1, pc}",
            "mov\tsp, r7",
            "sub.w\tsp, sp, r3",
            "pushne\t{r4}",
        ] {
            assert!(instruction(text).is_err(), "{text}");
        }
    }

    #[test]
    fn constants_are_no_instructions() {
        let code = Code::parse(
            "\n00000040 <f>:\n  40:\tpush\t{r4, lr}\n  42:\tpop\t{r4, pc}\n  44:\t.word\t0x20000000\n\
             00000048 <g>:\n  48:\tbx\tlr\n",
        );
        assert_eq!(code.instructions.keys().copied().collect::<Vec<_>>(), [0x40, 0x42, 0x48]);
        assert_eq!(code.after(0x42), Some(0x48));
        assert_eq!(code.function(0x44), "f");
    }
}
