//! Compiles an agent for this machine and for the target, and runs both.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read as _, Seek as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use translator::{EXERCISE, EXERCISE_SEED, EXERCISE_STATE, EXERCISE_STEPS, Exercise, ROUNDED};

use super::TargetError;

const GCC: &str = "arm-none-eabi-gcc";
const QEMU: &str = "qemu-system-arm";
const CORE: [&str; 4] = ["-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"];
const STARTUP: &str = include_str!("cortex_m4/startup.c");
const LAYOUT: &str = include_str!("cortex_m4/image.ld");
/// The program for this machine.
pub(crate) const HOST: &str = include_str!("cortex_m4/host.c");
/// Seed of the random calls.
pub(crate) const SEED: &str = "88172645463325252ULL";
/// Time limit of QEMU: an execution takes a second.
const PATIENCE: Duration = Duration::from_mins(5);

/// The folder of an exercise.
pub(super) struct Build<'a> {
    pub(super) folder: &'a Path,
}

impl Build<'_> {
    /// Writes the files of an exercise and of the platform.
    pub(super) fn write(&self, exercise: &Exercise) -> Result<(), TargetError> {
        let own = exercise.files.iter().map(|file| (file.name.as_str(), file.text.as_str()));
        let platform = [("startup.c", STARTUP), ("image.ld", LAYOUT), ("host.c", HOST)];
        // In a folder of its own, because the agent's files may have any name.
        let platform = platform.map(|(name, text)| (format!("platform/{name}"), text));
        let platform = platform.iter().map(|(name, text)| (name.as_str(), *text));
        for (name, text) in own.chain(platform) {
            let path = self.folder.join(name);
            let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
            made.and_then(|()| std::fs::write(&path, text))
                .map_err(|source| io_error("cannot write", &path, source))?;
        }
        Ok(())
    }

    /// The trace of the exercise on this machine.
    pub(super) fn on_host(&self, c: &str, steps: u32) -> Result<String, TargetError> {
        let (steps, seed) = definitions(steps);
        self.run(
            "gcc",
            &["-std=c99", ROUNDED, "-O2", "-w", "-I.", "-c", c, "-o", "platform/host.o"],
        )?;
        let sources = [EXERCISE, "platform/host.c", "platform/host.o"];
        let options =
            ["-std=c99", ROUNDED, "-O2", "-w", "-I.", &steps, &seed, "-o", "platform/host"];
        self.run("gcc", &[&options[..], &sources].concat())?;
        self.run("platform/host", &[])
    }

    /// Compiles the agent for the target. Returns the frame of each function as the compiler reports it.
    pub(super) fn compile(&self, c: &str) -> Result<HashMap<String, u64>, TargetError> {
        let strict = ["-Wall", "-Wextra", "-Werror", "-fno-jump-tables", "-fstack-usage", "-I."];
        self.run(GCC, &[&CORE[..], &FREE, &strict, &["-c", c, "-o", "agent.o"]].concat())?;
        let usage = self.read("agent.su")?;
        frames(&usage).map_err(|reason| failed(GCC, reason))
    }

    /// Links the image of an exercise with this number of steps.
    pub(super) fn link(&self, exercise: &Exercise, steps: u32) -> Result<(), TargetError> {
        let (steps, seed) = definitions(steps);
        let quiet = ["-w", "-I.", &steps, &seed, "-c", EXERCISE, "-o", "platform/exercise.o"];
        self.run(GCC, &[&CORE[..], &FREE, &quiet].concat())?;
        let startup = ["-w", "-fno-tree-loop-distribute-patterns", "-c", "platform/startup.c"];
        self.run(GCC, &[&CORE[..], &FREE, &startup, &["-o", "platform/startup.o"]].concat())?;
        // The environment has its own copy of the compiler's library: all of it that is left is the agent's.
        let parts = ["platform/exercise.o", "platform/startup.o", "-lgcc"];
        let relocatable = ["-nostdlib", "-r", "-o", "platform/environment.o"];
        self.run(GCC, &[&CORE[..], &relocatable, &parts].concat())?;
        let kept = exercise.environment.iter().map(String::as_str);
        let kept = kept.chain(["reset", "memcpy", "memset", EXERCISE_STATE]);
        let kept: Vec<String> = kept.map(|name| format!("--keep-global-symbol={name}")).collect();
        let kept: Vec<&str> = kept.iter().map(String::as_str).collect();
        self.run("arm-none-eabi-objcopy", &[&kept[..], &["platform/environment.o"]].concat())?;
        let parts = ["agent.o", "platform/environment.o", "-lgcc", "-o", "platform/image.elf"];
        let layout = ["-nostdlib", "-Wl,--no-warn-rwx-segments", "-T", "platform/image.ld"];
        self.run(GCC, &[&CORE[..], &layout, &parts].concat())?;
        Ok(())
    }

    /// The trace of the linked exercise on the target; with `log`, QEMU writes each instruction in this
    /// range of addresses to that file of the folder.
    pub(super) fn on_target(&self, log: Option<(&str, (u64, u64))>) -> Result<String, TargetError> {
        let mut command = Command::new(QEMU);
        command.args([
            "-machine",
            "mps2-an386",
            "-nographic",
            "-monitor",
            "none",
            "-serial",
            "none",
        ]);
        command.args(["-semihosting-config", "enable=on,target=native"]);
        command.args(["-kernel", "platform/image.elf"]).current_dir(self.folder);
        if let Some((file, (first, end))) = log {
            let range = format!("{first:#x}..{:#x}", end.saturating_sub(1));
            command.args(["-singlestep", "-d", "exec,cpu,nochain", "-dfilter", &range, "-D", file]);
        }
        let (mut said, mut complaint) = (temporary()?, temporary()?);
        let output = |file: &File| file.try_clone().map_err(|source| in_run(QEMU, source));
        let child = command.stdin(Stdio::null()).stdout(output(&said)?).stderr(output(&complaint)?);
        let mut child = child.spawn().map_err(|source| in_run(QEMU, source))?;
        let mut waited = Duration::ZERO;
        let status = loop {
            if let Some(status) = child.try_wait().map_err(|source| in_run(QEMU, source))? {
                break status;
            }
            if waited >= PATIENCE {
                // It may have ended already.
                _ = child.kill();
                child.wait().map_err(|source| in_run(QEMU, source))?;
                return Err(failed(QEMU, "the exercise does not end".to_owned()));
            }
            let pause = Duration::from_millis(5);
            std::thread::sleep(pause);
            waited += pause;
        };
        if !status.success() {
            let complaint = content(&mut complaint)?;
            return Err(failed(QEMU, format!("the exercise ends with {status}\n{complaint}")));
        }
        content(&mut said)
    }

    /// Output of a tool of the target that takes the image or an object.
    pub(super) fn inspect(&self, tool: &str, arguments: &[&str]) -> Result<String, TargetError> {
        self.run(&format!("arm-none-eabi-{tool}"), arguments)
    }

    pub(super) fn read(&self, name: &str) -> Result<String, TargetError> {
        let path = self.folder.join(name);
        std::fs::read_to_string(&path).map_err(|source| io_error("cannot read", &path, source))
    }

    fn run(&self, program: &str, arguments: &[&str]) -> Result<String, TargetError> {
        let path = self.folder.join(program);
        let mut command =
            if program.contains('/') { Command::new(path) } else { Command::new(program) };
        command.args(arguments).current_dir(self.folder);
        let output = command.output().map_err(|source| in_run(program, source))?;
        if output.status.success() {
            return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
        }
        let said = String::from_utf8_lossy(&output.stderr);
        Err(failed(program, said.lines().take(20).collect::<Vec<_>>().join("\n")))
    }
}

/// Compiler options of all code of the target.
const FREE: [&str; 4] = ["-std=gnu99", ROUNDED, "-O2", "-ffreestanding"];

/// The versions of the target's compiler and of QEMU.
///
/// # Errors
/// If one of the tools is missing.
pub(super) fn versions() -> Result<String, TargetError> {
    let version = |program: &str| {
        let output = Command::new(program).arg("--version").output();
        let output = output.map_err(|source| in_run(program, source))?;
        let said = String::from_utf8_lossy(&output.stdout);
        Ok(said.lines().next().unwrap_or_default().to_owned())
    };
    version("gcc")?;
    let (gcc, qemu) = (version(GCC)?, version(QEMU)?);
    let gcc = gcc.split_whitespace().rev().nth(1).unwrap_or_default().to_owned();
    let qemu = qemu.trim_start_matches("QEMU emulator version ");
    let qemu = qemu.split_whitespace().next().unwrap_or_default();
    Ok(format!("{GCC} {gcc} -O2, QEMU {qemu}"))
}

fn definitions(steps: u32) -> (String, String) {
    (format!("-D{EXERCISE_STEPS}={steps}U"), format!("-D{EXERCISE_SEED}={SEED}"))
}

/// The frames in a file of `-fstack-usage`: place and function, bytes and kind, separated by tabs. An error if one has
/// no fixed size.
fn frames(usage: &str) -> Result<HashMap<String, u64>, String> {
    let mut frames = HashMap::new();
    for line in usage.lines() {
        let columns: Vec<&str> = line.split('\t').collect();
        let [place, bytes, "static"] = columns[..] else {
            return Err(format!("a frame without a fixed size: {line}"));
        };
        let name = place.rsplit(':').next().unwrap_or(place);
        let bytes = bytes.parse().map_err(|_| format!("a frame without a size: {line}"))?;
        frames.insert(name.to_owned(), bytes);
    }
    Ok(frames)
}

fn temporary() -> Result<File, TargetError> {
    tempfile::tempfile()
        .map_err(|source| TargetError::Io { what: "no temporary file".to_owned(), source })
}

fn content(file: &mut File) -> Result<String, TargetError> {
    let mut bytes = Vec::new();
    let read = file.rewind().and_then(|()| file.read_to_end(&mut bytes));
    read.map_err(|source| in_run(QEMU, source))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn in_run(program: &str, source: io::Error) -> TargetError {
    if source.kind() == io::ErrorKind::NotFound {
        return TargetError::Missing { program: program.to_owned() };
    }
    TargetError::Io { what: format!("cannot run {program}"), source }
}

pub(super) fn failed(program: &str, said: String) -> TargetError {
    TargetError::Failed { program: program.to_owned(), said }
}

pub(super) fn io_error(what: &str, path: &Path, source: io::Error) -> TargetError {
    TargetError::Io { what: format!("{what} {}", path.display()), source }
}

#[cfg(test)]
mod tests {
    use super::frames;

    #[test]
    fn frames_have_a_fixed_size() {
        let known = frames("a.c:1:6:next_step\t48\tstatic\na.c:9:2:run_g.part.0\t16\tstatic\n");
        assert_eq!(known.unwrap()["run_g.part.0"], 16);
        assert!(frames("a.c:1:6:f\t48\tdynamic,bounded\n").is_err());
    }
}
