//! `asl2c`: translates an AgentSpeak agent to C.
#![forbid(unsafe_code)]

mod path;
mod stack;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use translator::{TranslateError, Translation, parse_configuration, translate};

/// Translate an AgentSpeak agent to C without heap, recursion or unbounded loops.
///
/// Writes the files that the configuration's `settings` name: the C file, its header, the header
/// of the basic actions and, with `rust = FILE`, the Rust side of the boundary. Nothing is written
/// if anything is wrong.
#[derive(Debug, Parser)]
#[command(
    name = "asl2c",
    version,
    after_help = "Exit status: 0 translated, 1 refused or unreadable, 2 usage."
)]
struct Arguments {
    /// The agent's configuration
    #[arg(value_name = "AGENT.CONF")]
    configuration: PathBuf,
    /// Where the generated files go [default: the configuration's folder]
    #[arg(short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print what the agent costs: memory, call depth, calls of each action in a step. The stack and the
    /// longest path of a step are gcc's, if it is there
    #[arg(long)]
    report: bool,
}

#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("cannot {action} {path}: {source}")]
    File { action: &'static str, path: PathBuf, source: std::io::Error },
    #[error("{0}")]
    Translate(#[from] TranslateError),
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let mut stderr = std::io::stderr().lock();
    // A message that cannot be printed has nowhere else to go.
    match run(&arguments) {
        Ok(mut translation) => {
            if !translation.warnings.is_empty() {
                _ = writeln!(stderr, "{}", translation.warnings);
            }
            if arguments.report {
                match stack::compiled(&translation) {
                    Ok(compiled) => {
                        let report = &mut translation.report;
                        report.add_stack(stack::COMPILER, &compiled.frame_bytes);
                        match path::longest(&compiled.assembly, report.entry()) {
                            Ok(instructions) => report.add_path(stack::COMPILER, instructions),
                            Err(reason) => {
                                _ = writeln!(stderr, "the longest path is not known: {reason}");
                            }
                        }
                    }
                    Err(reason) => _ = writeln!(stderr, "the stack is not measured: {reason}"),
                }
                _ = write!(std::io::stdout(), "{}", translation.report);
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            let prefix = if matches!(error, CommandError::File { .. }) { "error: " } else { "" };
            _ = writeln!(stderr, "{prefix}{error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<Translation, CommandError> {
    let path = &arguments.configuration;
    let folder = path.parent().unwrap_or(Path::new(""));
    let configuration = parse_configuration(&path.display().to_string(), &read(path)?)?;
    let agent = read(&folder.join(configuration.input()))?;
    let translation = translate(configuration, &agent)?;
    let output = arguments.output.as_deref().unwrap_or(folder);
    for file in &translation.files {
        let path = output.join(&file.name);
        std::fs::write(&path, &file.text).map_err(|source| CommandError::File {
            action: "write",
            path,
            source,
        })?;
    }
    Ok(translation)
}

fn read(path: &Path) -> Result<String, CommandError> {
    let bytes = std::fs::read(path).map_err(|source| CommandError::File {
        action: "read",
        path: path.to_owned(),
        source,
    })?;
    // Bytes that are no UTF-8 become characters that the lexer refuses, with line and column.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
