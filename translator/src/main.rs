//! `asl2c`: translates an AgentSpeak agent to C.
#![forbid(unsafe_code)]

mod new;
mod output;
mod path;
mod spin;
mod stack;
mod verify;
mod worst;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use serde_json::json;
use translator::{
    CODES, Finding, ParsedConfiguration, TranslateError, Translation, parse_configuration,
    translate,
};

/// Translate an AgentSpeak agent to C without heap, recursion or unbounded loops.
///
/// Writes the files that the configuration's `settings` name: the C file, its header, the header
/// of the basic actions and, with `rust = FILE`, the Rust side of the boundary. Nothing is written
/// if anything is wrong.
#[derive(Debug, Parser)]
#[command(
    name = "asl2c",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Exit status: 0 translated, or every property holds; 1 refused, unreadable, not printed, or a \
                  property that does not hold; 2 usage; 3 nothing is known of some property, for want of a tool, \
                  of memory, or of properties."
)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Task>,
    /// The agent's configuration
    #[arg(value_name = "AGENT.CONF", required = true)]
    configuration: Option<PathBuf>,
    /// Where the generated files go [default: the configuration's folder]
    #[arg(short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print what the agent costs: memory, call depth, calls of each action in a step. The stack and the
    /// longest path of a step are gcc's, the costliest step that random events lead to is callgrind's, if they
    /// are there
    #[arg(long)]
    report: bool,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
    /// Do not warn of this: a warning's code, or `all`; may be given more than once
    #[arg(short = 'A', long = "allow", value_name = "CODE", value_parser = code("all"))]
    allow: Vec<String>,
    /// Warn of this, whatever `-A` says
    #[arg(short = 'W', long = "warn", value_name = "CODE", value_parser = code("all"))]
    warn: Vec<String>,
    /// Refuse agents with this: a warning's code, or `warnings` for all that are not allowed
    #[arg(short = 'D', long = "deny", value_name = "CODE", value_parser = code("warnings"))]
    deny: Vec<String>,
    /// How errors and warnings are printed: for people, or each as a line of JSON
    #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
    message_format: String,
}

impl Arguments {
    /// Whether a warning is printed.
    fn is_wanted(&self, code: &str) -> bool {
        let named = |list: &[String]| list.iter().any(|other| other == code || other == "all");
        named(&self.warn) || !named(&self.allow) || self.deny.iter().any(|other| other == code)
    }

    /// Whether a warning that is printed forbids translation.
    fn is_denied(&self, code: &str) -> bool {
        self.deny.iter().any(|other| other == code || other == "warnings")
    }

    fn is_json(&self) -> bool {
        self.message_format == "json"
    }
}

/// Codes of warnings, and a word for all of them.
fn code(all: &'static str) -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(CODES.into_iter().chain([all]))
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Make a folder with an agent, its configuration, a main program, and a Makefile that builds and runs all
    New {
        /// The agent's name, and the folder's: a word of lower-case letters, digits and `_`
        #[arg(value_name = "NAME")]
        name: String,
    },
    /// Check the configuration's properties with SPIN, on a model of the agent in any environment
    ///
    /// A property that does not hold is told as a way to its failure in the agent's own terms: what the
    /// environment did, the event of each step, its plan and the actions, with lines of the agent. Values are
    /// not part of the model, so a failure may need an environment that there is not.
    Verify {
        /// The agent's configuration
        #[arg(value_name = "AGENT.CONF")]
        configuration: PathBuf,
        /// Check this property only; may be given more than once
        #[arg(long, value_name = "PROPERTY")]
        only: Vec<String>,
        /// Print one JSON object
        #[arg(long)]
        json: bool,
        /// Print the model in Promela, and check nothing
        #[arg(long, conflicts_with = "json")]
        model: bool,
    },
}

#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("cannot {action} {path}: {source}")]
    File { action: &'static str, path: PathBuf, source: std::io::Error },
    #[error("{0}")]
    Translate(#[from] TranslateError),
    #[error("error: {0}")]
    Verify(#[from] verify::VerifyError),
    #[error("{0}")]
    Output(#[from] output::OutputError),
    #[error("{0}")]
    New(#[from] new::NewError),
    #[error("{0}")]
    Denied(String),
    #[error("cannot print {what}: {source}")]
    Print { what: &'static str, source: std::io::Error },
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(usage) => return say(&usage),
    };
    let done = match (&arguments.command, &arguments.configuration) {
        (Some(task), _) => carry_out(task),
        (None, Some(configuration)) => Ok(translate_files(&arguments, configuration)),
        (None, None) => unreachable!("clap asks for the configuration"),
    };
    done.unwrap_or_else(|error| complain(&error))
}

fn carry_out(task: &Task) -> Result<ExitCode, CommandError> {
    let (configuration, only, json, model) = match task {
        Task::New { name } => {
            new::make(name, printed)?;
            return Ok(ExitCode::SUCCESS);
        }
        Task::Verify { configuration, only, json, model } => (configuration, only, json, model),
    };
    let (parsed, agent) = read_agent(configuration)?;
    let checked = translator::model(parsed, &agent)?;
    if *model {
        print("the model", &checked.promela())?;
        return Ok(ExitCode::SUCCESS);
    }
    let (text, status) = verify::run(&checked, only, *json)?;
    print("what was found", &text)?;
    Ok(status)
}

fn complain(error: &CommandError) -> ExitCode {
    let ours = matches!(
        error,
        CommandError::File { .. }
            | CommandError::Print { .. }
            | CommandError::New(_)
            | CommandError::Output(output::OutputError::Write { .. })
    );
    let prefix = if ours { "error: " } else { "" };
    // A message that cannot be printed has nowhere else to go.
    _ = writeln!(std::io::stderr(), "{prefix}{error}");
    if matches!(error, CommandError::Verify(_)) { NOT_CHECKED.into() } else { ExitCode::FAILURE }
}

/// The exit status if nothing is known of what should be checked.
pub(crate) const NOT_CHECKED: u8 = 3;

/// Prints what was asked for.
fn print(what: &'static str, text: &str) -> Result<(), CommandError> {
    printed(text).map_err(|source| CommandError::Print { what, source })
}

fn printed(text: &str) -> std::io::Result<()> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    stdout.flush()
}

/// Prints what clap says: help and version, or what is wrong with the usage.
fn say(usage: &clap::Error) -> ExitCode {
    let said = usage.print().and_then(|()| std::io::stdout().flush());
    if let Err(source) = said
        && !usage.use_stderr()
    {
        return complain(&CommandError::Print { what: "the help", source });
    }
    u8::try_from(usage.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}

/// Adds what a compiler makes of the C, and what that costs; says what cannot be known.
fn measure(translation: &mut Translation, path: &Path, stderr: &mut impl std::io::Write) {
    let compiled = match stack::compiled(translation) {
        Ok(compiled) => compiled,
        Err(reason) => {
            _ = writeln!(stderr, "the stack is not measured: {reason}");
            return;
        }
    };
    let report = &mut translation.report;
    report.add_stack(stack::COMPILER, &compiled.frame_bytes);
    match path::longest(&compiled.assembly, report.entry()) {
        Ok(instructions) => report.add_path(stack::COMPILER, instructions),
        Err(reason) => _ = writeln!(stderr, "the longest path is not known: {reason}"),
    }
    let costliest = read_agent(path)
        .and_then(|(parsed, agent)| Ok(translator::obligations(parsed, &agent)?))
        .map_err(|error| error.to_string())
        .and_then(|obligations| worst::costliest(&obligations));
    match costliest {
        Ok(instructions) => report.add_costliest(instructions),
        Err(reason) => _ = writeln!(stderr, "no costliest step was found: {reason}"),
    }
}

fn translate_files(arguments: &Arguments, path: &Path) -> ExitCode {
    let mut stderr = std::io::stderr().lock();
    // A message that cannot be printed has nowhere else to go.
    match run(arguments, path) {
        Ok((mut translation, warnings)) => {
            if !warnings.is_empty() && !arguments.quiet {
                _ = writeln!(stderr, "{warnings}");
            }
            if arguments.report {
                measure(&mut translation, path, &mut stderr);
                drop(stderr);
                if let Err(error) = print("the report", &translation.report.to_string()) {
                    return complain(&error);
                }
            }
            ExitCode::SUCCESS
        }
        Err(error) if arguments.is_json() => {
            _ = writeln!(stderr, "{}", as_json(&error));
            ExitCode::FAILURE
        }
        Err(error) => {
            drop(stderr);
            complain(&error)
        }
    }
}

/// An error as lines of JSON.
fn as_json(error: &CommandError) -> String {
    let refused = match error {
        CommandError::Translate(error)
        | CommandError::Output(output::OutputError::Refused(error)) => error,
        CommandError::Denied(lines) => return lines.clone(),
        other => return json!({ "severity": "error", "message": other.to_string() }).to_string(),
    };
    match refused {
        TranslateError::Configuration { findings, .. } | TranslateError::Agent { findings, .. } => {
            lines(findings)
        }
        other => json!({ "severity": "error", "message": other.to_string() }).to_string(),
    }
}

/// Findings as lines of JSON.
fn lines<'a>(findings: impl IntoIterator<Item = &'a Finding>) -> String {
    let lines = findings.into_iter().map(|finding| json!(finding).to_string());
    lines.collect::<Vec<_>>().join("\n")
}

/// The warnings that are wanted, as they are printed; an error if one is denied.
fn warnings(arguments: &Arguments, translation: &Translation) -> Result<String, CommandError> {
    let wanted: Vec<&Finding> =
        translation.findings.iter().filter(|finding| arguments.is_wanted(finding.code)).collect();
    let denied = wanted.iter().filter(|finding| arguments.is_denied(finding.code)).count();
    let text = if arguments.is_json() {
        lines(wanted.iter().copied())
    } else {
        wanted.iter().map(|finding| finding.rendered.trim_end()).collect::<Vec<_>>().join("\n\n")
    };
    if denied == 0 {
        return Ok(text);
    }
    let message = format!("{denied} of these are denied: nothing is translated");
    Err(CommandError::Denied(if arguments.is_json() {
        format!("{text}\n{}", json!({ "severity": "error", "message": message }))
    } else {
        format!("{text}\n\nerror: {message}")
    }))
}

/// The configuration, and the text of its agent.
fn read_agent(path: &Path) -> Result<(ParsedConfiguration, String), CommandError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let configuration = parse_configuration(&path.display().to_string(), &read(path)?)?;
    let agent = read(&folder.join(configuration.input()))?;
    Ok((configuration, agent))
}

fn run(arguments: &Arguments, path: &Path) -> Result<(Translation, String), CommandError> {
    let (configuration, agent) = read_agent(path)?;
    let agent_path = path.parent().unwrap_or(Path::new("")).join(configuration.input());
    let translation = translate(configuration.clone(), &agent)?;
    let warnings = warnings(arguments, &translation)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let output = arguments.output.as_deref().unwrap_or(folder);
    let mut read = vec![(agent_path, "translated"), (path.to_owned(), "translated")];
    for file in configuration.included_files() {
        read.extend([folder, output].map(|place| (place.join(&file), "included")));
    }
    output::write(&configuration, &translation.files, output, &read)?;
    Ok((translation, warnings))
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
