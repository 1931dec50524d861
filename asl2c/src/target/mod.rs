//! An agent's C on a microcontroller: size, stack and longest path of the code for an Arm Cortex-M4, and its execution
//! under QEMU, compared with that on this machine.

mod bounds;
#[allow(clippy::disallowed_methods, reason = "other programs get a limited time")]
mod build;
mod code;
mod observed;

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, BufReader};

use translator::{EXERCISE_STATE, Exercise};

use self::bounds::Bounds;
use self::build::{Build, failed, io_error, versions};
pub(crate) use self::build::{HOST, SEED};
use self::code::Code;
pub use self::observed::Observed;

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// A tool is not installed.
    #[error(
        "{program} cannot be run; a Cortex-M4 needs gcc, arm-none-eabi-gcc and qemu-system-arm \
         (apt install gcc gcc-arm-none-eabi qemu-system-arm)"
    )]
    Missing {
        /// The program.
        program: String,
    },
    /// A tool failed, or its result contradicts another's.
    #[error("{program}: {said}")]
    Failed {
        /// The program.
        program: String,
        /// Its complaint.
        said: String,
    },
    /// A file, or a program that cannot be run.
    #[error("{what}: {source}")]
    Io {
        /// The operation.
        what: String,
        /// The system's error.
        source: io::Error,
    },
}

/// Upper bounds of a call of a function, without the environment's functions that it calls.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Bound {
    /// Linker symbol of the function.
    pub function: String,
    /// Bytes of stack.
    pub stack: u64,
    /// Instructions of the longest path, or the reason why there is no such number.
    pub instructions: Result<u64, String>,
}

/// Where two traces differ first.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct TraceDifference {
    /// The line, from one.
    pub line: usize,
    /// The line on this machine; empty if its trace has ended.
    pub host: String,
    /// The line on the target; empty if its trace has ended.
    pub target: String,
}

/// An agent on a Cortex-M4.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct OnTarget {
    /// Versions of compiler and emulator.
    pub versions: String,
    /// Bytes of code and constants.
    pub text: u64,
    /// Bytes of code of the compiler's library, such as arithmetic of doubles.
    pub library: u64,
    /// Bytes of the state, in the C or passed in.
    pub state: u64,
    /// Bounds of each function of the interface, `next_step()` first.
    pub bounds: Vec<Bound>,
    /// The most that a step took in an execution of at most 500 steps.
    pub observed: Observed,
    /// Steps that were executed on both machines.
    pub steps: u32,
    /// Lines of the trace on this machine.
    pub lines: usize,
    /// Where the traces differ; `None` if they are equal.
    pub difference: Option<TraceDifference>,
}

/// Steps of the execution in which each instruction is counted.
const COUNTED_STEPS: u32 = 500;

/// Compiles an agent for a Cortex-M4, derives the bounds from the code, and runs it for this number of steps there and,
/// as `reference`, on this machine. Both are usually the same, and have all files that are read but the compiler's.
///
/// # Errors
/// If a tool is missing or fails, the stack has no bound, or the compiler's frames are not those of the code.
pub fn on_target(
    exercise: &Exercise,
    reference: &Exercise,
    steps: u32,
) -> Result<OnTarget, TargetError> {
    let versions = versions()?;
    let host = on_host(reference, steps)?;
    let folder = temporary_folder()?;
    let build = Build { folder: folder.path() };
    build.write(exercise)?;
    let frames = build.compile(c_file(exercise))?;
    build.link(exercise, steps)?;
    let target = build.on_target(None)?;
    build.link(exercise, COUNTED_STEPS.min(steps))?;
    let image = Image::read(&build)?;
    image.check_frames(&frames)?;
    let (text, state) = sizes(&build, &image)?;
    Ok(OnTarget {
        versions,
        text,
        library: image.symbol("agent_last")? - image.symbol("library_first")?,
        state,
        bounds: image.bounds(exercise)?,
        observed: image.observe(&build, exercise)?,
        steps,
        lines: host.lines().count(),
        difference: difference(&host, &target),
    })
}

/// The trace of an agent on this machine.
///
/// # Errors
/// [`TargetError::Failed`] of `gcc` if the C does not compile, of another program if it does not end well;
/// [`TargetError::Missing`] if there is no `gcc`, [`TargetError::Io`] if files cannot be written.
pub fn on_host(exercise: &Exercise, steps: u32) -> Result<String, TargetError> {
    let folder = temporary_folder()?;
    let build = Build { folder: folder.path() };
    build.write(exercise)?;
    build.on_host(c_file(exercise), steps)
}

fn temporary_folder() -> Result<tempfile::TempDir, TargetError> {
    tempfile::tempdir()
        .map_err(|source| TargetError::Io { what: "no temporary folder".to_owned(), source })
}

fn c_file(exercise: &Exercise) -> &str {
    exercise.files.first().map_or("", |file| &file.name)
}

/// The code and the symbols of an image.
struct Image {
    code: Code,
    symbols: HashMap<String, u64>,
    /// Sizes of functions and variables.
    sizes: HashMap<String, u64>,
}

impl Image {
    fn read(build: &Build<'_>) -> Result<Self, TargetError> {
        let image = "platform/image.elf";
        let disassembly = build.inspect("objdump", &["-d", "--no-show-raw-insn", image])?;
        let mut symbols = HashMap::new();
        let mut sizes = HashMap::new();
        // `00000040 0000001c T next_step`, without the size where there is none
        for line in build.inspect("nm", &["-S", image])?.lines() {
            let columns: Vec<&str> = line.split_whitespace().collect();
            let hexadecimal = |text: &str| u64::from_str_radix(text, 16).ok();
            let (Some(address), Some(name)) = (hexadecimal(columns[0]), columns.last()) else {
                continue;
            };
            // The lowest bit marks Thumb code.
            symbols.insert((*name).to_owned(), address & !1);
            if let [_, size, _, _] = columns[..] {
                sizes.extend(hexadecimal(size).map(|size| ((*name).to_owned(), size)));
            }
        }
        Ok(Self { code: Code::parse(&disassembly), symbols, sizes })
    }

    fn symbol(&self, name: &str) -> Result<u64, TargetError> {
        let missing = || failed("arm-none-eabi-nm", format!("the image has no `{name}`"));
        self.symbols.get(name).copied().ok_or_else(missing)
    }

    /// Compares the frames that the compiler reports with those of the code: two ways to the same figure.
    fn check_frames(&self, frames: &HashMap<String, u64>) -> Result<(), TargetError> {
        // A jump to another function, as its last call, is not part of the frame.
        let bounds = Bounds::new(&self.code, self.code.names.keys().copied().collect());
        for (function, bytes) in frames {
            let Some(address) = self.symbols.get(function) else { continue };
            let own = bounds.frame(*address).map_err(|reason| failed("objdump", reason))?;
            // The compiler does not count the parts of a struct that come in registers and that the function stores
            // below the others, in front of everything else.
            let stored = self.code.reserves(*address).unwrap_or(0);
            if own != *bytes && own != bytes + stored {
                let said =
                    format!("`{function}` takes {own} bytes of stack, not {bytes} as reported");
                return Err(failed("arm-none-eabi-gcc", said));
            }
        }
        Ok(())
    }

    fn bounds(&self, exercise: &Exercise) -> Result<Vec<Bound>, TargetError> {
        let environment = exercise.environment.iter().filter_map(|name| self.symbols.get(name));
        let bounds = Bounds::new(&self.code, environment.copied().collect());
        let of = |function: &String| {
            let entry = self.symbol(function)?;
            let stack =
                bounds.stack(entry).map_err(|reason| failed("the stack is unknown", reason))?;
            Ok(Bound {
                function: function.clone(),
                stack,
                instructions: bounds.instructions(entry),
            })
        };
        exercise.interface.iter().map(of).collect()
    }

    /// Executes the image while each instruction of the agent is logged.
    fn observe(&self, build: &Build<'_>, exercise: &Exercise) -> Result<Observed, TargetError> {
        let range = (self.symbol("agent_first")?, self.symbol("agent_last")?);
        build.on_target(Some(("platform/log", range)))?;
        let interface = exercise.interface.iter().filter_map(|name| self.symbols.get(name));
        let entry = exercise.interface.first().map_or("", String::as_str);
        let path = build.folder.join("platform/log");
        let unread = |source| io_error("cannot read", &path, source);
        let log = BufReader::new(File::open(&path).map_err(unread)?);
        observed::costliest(log, self.symbol(entry)?, &interface.copied().collect()).map_err(unread)
    }
}

/// Bytes of code and constants, and of the state.
fn sizes(build: &Build<'_>, image: &Image) -> Result<(u64, u64), TargetError> {
    let said = build.inspect("size", &["agent.o"])?;
    let row = said.lines().nth(1).unwrap_or_default();
    let columns: Vec<u64> = row.split_whitespace().map_while(|text| text.parse().ok()).collect();
    let [text, data, bss, ..] = columns[..] else {
        return Err(failed("arm-none-eabi-size", said));
    };
    Ok((text, data + bss + image.sizes.get(EXERCISE_STATE).copied().unwrap_or(0)))
}

/// The first line that differs.
fn difference(host: &str, target: &str) -> Option<TraceDifference> {
    if host == target {
        return None;
    }
    let (mut hosts, mut targets) = (host.lines(), target.lines());
    for line in 1.. {
        let (host, target) = (hosts.next(), targets.next());
        if host != target || host.is_none() {
            let text = |line: Option<&str>| line.unwrap_or_default().to_owned();
            return Some(TraceDifference { line, host: text(host), target: text(target) });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::difference;

    #[test]
    fn the_first_difference_is_found_also_at_the_end() {
        assert_eq!(difference("a\nb\n", "a\nb\n"), None);
        let found = difference("a\nb\n", "a\nc\n").unwrap();
        assert_eq!((found.line, &*found.host, &*found.target), (2, "b", "c"));
        assert_eq!(difference("a\nb\n", "a\n").unwrap().line, 2);
        assert!(difference("a\n", "a").is_some());
    }
}
