//! The costliest step of an execution, from QEMU's log of each instruction of the agent with its registers.

use std::collections::HashSet;
use std::io::{self, BufRead};

/// The most that one call of a function has taken; of both figures not necessarily the same call.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Observed {
    /// Instructions of the agent and of the compiler's library.
    pub instructions: u64,
    /// Bytes of stack.
    pub stack: u64,
}

/// The costliest call of the function at `entry`. Another call begins at each address of `interface`.
pub(super) fn costliest(
    log: impl BufRead,
    entry: u64,
    interface: &HashSet<u64>,
) -> io::Result<Observed> {
    let mut most = Observed::default();
    // Instructions so far and the stack pointer at the start, of a call of the function.
    let mut running: Option<(u64, u64)> = None;
    for line in log.lines() {
        let line = line?;
        let Some((pointer, address)) = registers(&line) else { continue };
        if interface.contains(&address) {
            running = (address == entry).then_some((0, pointer));
        }
        if let Some((count, start)) = &mut running {
            *count += 1;
            most.instructions = most.instructions.max(*count);
            most.stack = most.stack.max(start.saturating_sub(pointer));
        }
    }
    Ok(most)
}

/// The stack pointer and the program counter before an instruction, in the line that has both.
fn registers(line: &str) -> Option<(u64, u64)> {
    let value = |name: &str| {
        let (_, rest) = line.split_once(name)?;
        u64::from_str_radix(rest.get(..8)?, 16).ok()
    };
    Some((value("R13=")?, value("R15=")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_call_lasts_until_the_next_one() {
        let at = |pointer: u32, address: u32| {
            format!(
                "Trace 0: 0x7f00 [0/0/0/0] f\nR12=00000000 R13={pointer:08x} R14=00000000 R15={address:08x}\n"
            )
        };
        let log = [
            at(0x100, 0x10),
            at(0xf0, 0x12),
            at(0xe8, 0x30),
            at(0x100, 0x20),
            at(0x20, 0x22),
            at(0x100, 0x10),
        ];
        let observed = costliest(log.concat().as_bytes(), 0x10, &HashSet::from([0x10, 0x20]));
        assert_eq!(observed.unwrap(), Observed { instructions: 3, stack: 0x18 });
    }
}
