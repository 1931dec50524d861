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
    CODES, Finding, ParsedConfiguration, REFUSED, TranslateError, Translation, parse_configuration,
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
}

/// Whether messages are lines of JSON.
fn is_json(message_format: &str) -> bool {
    message_format == "json"
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
        /// Print only what does not hold; `--json` tells of all
        #[arg(short, long)]
        quiet: bool,
        /// How errors are printed: for people, or each as a line of JSON
        #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
        message_format: String,
    },
}

#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error("cannot {action} {path}: {source}")]
    File { action: &'static str, path: PathBuf, source: std::io::Error },
    #[error("{0}")]
    Translate(#[from] TranslateError),
    #[error("{0}")]
    Verify(#[from] verify::VerifyError),
    #[error("{0}")]
    Output(#[from] output::OutputError),
    #[error("{0}")]
    New(#[from] new::NewError),
    /// Warnings that are refused, with the others that are wanted.
    #[error("{}\n\nerror: {}", rendered(.0), denied(.0))]
    Denied(Vec<Finding>),
    #[error("cannot print {what}: {source}")]
    Print { what: &'static str, source: std::io::Error },
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(usage) => return say(&usage),
    };
    match (&arguments.command, &arguments.configuration) {
        (Some(Task::New { name }), _) => {
            let made = new::make(name, printed);
            made.map_or_else(|error| complain(&error.into(), false), |()| ExitCode::SUCCESS)
        }
        (Some(Task::Verify { configuration, only, json, model, quiet, message_format }), _) => {
            let done = verify(configuration, only, *json, *model, *quiet);
            done.unwrap_or_else(|error| complain(&error, is_json(message_format)))
        }
        (None, Some(configuration)) => {
            let done = translate_files(&arguments, configuration);
            done.unwrap_or_else(|error| complain(&error, is_json(&arguments.message_format)))
        }
        (None, None) => unreachable!("clap asks for the configuration"),
    }
}

fn verify(
    configuration: &Path,
    only: &[String],
    json: bool,
    model: bool,
    quiet: bool,
) -> Result<ExitCode, CommandError> {
    let (parsed, agent) = read_agent(configuration)?;
    let checked = translator::model(parsed, &agent)?;
    if model {
        print("the model", &checked.promela())?;
        return Ok(ExitCode::SUCCESS);
    }
    let told = match (json, quiet) {
        (true, _) => verify::Told::Json,
        (false, true) => verify::Told::Failures,
        (false, false) => verify::Told::All,
    };
    let (text, status) = verify::run(&checked, only, told)?;
    print("what was found", &text)?;
    Ok(status)
}

/// Says what went wrong, and how to exit.
fn complain(error: &CommandError, as_json: bool) -> ExitCode {
    let ours = matches!(
        error,
        CommandError::File { .. }
            | CommandError::Print { .. }
            | CommandError::New(_)
            | CommandError::Output(output::OutputError::Write { .. })
            | CommandError::Verify(_)
    );
    let prefix = if ours { "error: " } else { "" };
    let said = if as_json { lines_of(error) } else { format!("{prefix}{error}") };
    // A message that cannot be printed has nowhere else to go.
    _ = writeln!(std::io::stderr(), "{said}");
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
        return complain(&CommandError::Print { what: "the help", source }, false);
    }
    u8::try_from(usage.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}

/// Adds what a compiler makes of the C, and what that costs; says what cannot be known.
fn measure(translation: &mut Translation, path: &Path, mut unknown: impl FnMut(String)) {
    let compiled = match stack::compiled(translation) {
        Ok(compiled) => compiled,
        Err(reason) => return unknown(format!("the stack is not measured: {reason}")),
    };
    let report = &mut translation.report;
    report.add_stack(stack::COMPILER, &compiled.frame_bytes);
    match path::longest(&compiled.assembly, report.entry()) {
        Ok(instructions) => report.add_path(stack::COMPILER, instructions),
        Err(reason) => unknown(format!("the longest path is not known: {reason}")),
    }
    let costliest = read_agent(path)
        .and_then(|(parsed, agent)| Ok(translator::obligations(parsed, &agent)?))
        .map_err(|error| error.to_string())
        .and_then(|obligations| worst::costliest(&obligations));
    match costliest {
        Ok(instructions) => report.add_costliest(instructions),
        Err(reason) => unknown(format!("no costliest step was found: {reason}")),
    }
}

fn translate_files(arguments: &Arguments, path: &Path) -> Result<ExitCode, CommandError> {
    let json = is_json(&arguments.message_format);
    let (mut translation, warnings) = run(arguments, path)?;
    if !warnings.is_empty() && !arguments.quiet {
        let text = if json { lines(&warnings) } else { rendered(&warnings) };
        // A message that cannot be printed has nowhere else to go.
        _ = writeln!(std::io::stderr(), "{text}");
    }
    if arguments.report {
        measure(&mut translation, path, |unknown| {
            let text = if json { line("warning", "not-measured", &unknown, None) } else { unknown };
            _ = writeln!(std::io::stderr(), "{text}");
        });
        print("the report", &translation.report.to_string())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// An error as lines of JSON.
fn lines_of(error: &CommandError) -> String {
    let general = |code: &str, file: Option<&Path>| line("error", code, &error.to_string(), file);
    match error {
        CommandError::Translate(refused)
        | CommandError::Output(output::OutputError::Refused(refused)) => match refused {
            TranslateError::Configuration { findings, .. }
            | TranslateError::Agent { findings, .. } => lines(findings),
            TranslateError::Unprovable { .. } | TranslateError::Matrix { .. } => {
                general(REFUSED, None)
            }
        },
        CommandError::Denied(findings) => {
            format!("{}\n{}", lines(findings), line("error", "denied", &denied(findings), None))
        }
        CommandError::File { path, .. } => general("not-read", Some(path)),
        CommandError::Output(output::OutputError::Write { path, .. }) => {
            general("not-written", Some(path))
        }
        CommandError::Print { .. } => general("not-printed", None),
        CommandError::New(_) => general("not-made", None),
        CommandError::Verify(_) => general("not-checked", None),
    }
}

/// Findings as lines of JSON.
fn lines(findings: &[Finding]) -> String {
    findings.iter().map(|finding| json!(finding).to_string()).collect::<Vec<_>>().join("\n")
}

/// What is said of no place in a text, as a line of JSON with the keys of a finding.
fn line(severity: &str, code: &str, message: &str, file: Option<&Path>) -> String {
    let nothing = serde_json::Value::Null;
    json!({
        "severity": severity,
        "code": code,
        "message": message,
        "file": file.map(|file| file.display().to_string()),
        "line": nothing,
        "column": nothing,
        "end_line": nothing,
        "end_column": nothing,
        "label": "",
        "help": nothing,
        "rendered": format!("{severity}: {message}"),
    })
    .to_string()
}

/// Findings as people read them.
fn rendered(findings: &[Finding]) -> String {
    findings.iter().map(|finding| finding.rendered.trim_end()).collect::<Vec<_>>().join("\n\n")
}

/// How many of the findings forbid translation.
fn denied(findings: &[Finding]) -> String {
    let denied = findings.iter().filter(|finding| finding.severity == "error").count();
    format!("{denied} of these are denied: nothing is translated")
}

/// The warnings that are wanted; an error if one is denied. Those come first then, or alone if only errors are wanted.
fn warnings(
    arguments: &Arguments,
    translation: &Translation,
) -> Result<Vec<Finding>, CommandError> {
    let wanted = translation.findings.iter().filter(|finding| arguments.is_wanted(finding.code));
    let (mut denied, others): (Vec<Finding>, Vec<Finding>) =
        wanted.cloned().partition(|finding| arguments.is_denied(finding.code));
    if denied.is_empty() {
        return Ok(others);
    }
    denied = denied.into_iter().map(Finding::denied).collect();
    if !arguments.quiet {
        denied.extend(others);
    }
    Err(CommandError::Denied(denied))
}

/// The configuration, and the text of its agent.
fn read_agent(path: &Path) -> Result<(ParsedConfiguration, String), CommandError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let configuration = parse_configuration(&path.display().to_string(), &read(path)?)?;
    let agent = read(&folder.join(configuration.input()))?;
    Ok((configuration, agent))
}

fn run(arguments: &Arguments, path: &Path) -> Result<(Translation, Vec<Finding>), CommandError> {
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
