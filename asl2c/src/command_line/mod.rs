//! The command line: executes the arguments, prints the result and returns the exit status.

mod arguments;
mod certify;
mod difference;
mod fmt;
mod messages;
#[allow(clippy::disallowed_methods, reason = "people are told how long a proof takes")]
mod progress;
mod prompt;
mod prove;
mod run;
mod stop;
mod target;
mod validate;
mod verify;

use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser as _};
use clap_complete::Shell;
use judged_c::Refused;
use translator::{Code, Diagnostic, Diagnostics, Severity, TranslateError, translate};

use self::arguments::{Arguments, Task, is_json};
use self::messages::{denied, error_lines, line, lines};
use crate::agent::{Agent, ReadError};
use crate::certify::CertifyError;
use crate::current::StaleError;
use crate::headers::HeaderError;
use crate::lsp;
use crate::measure::measure;
use crate::new::{NewError, make};
use crate::output::{self, OutputError};
use crate::prove::ProveError;
use crate::target::TargetError;
use crate::tool::ToolError;
use crate::verify::VerifyError;
use crate::written::WriteError;

/// Errors of the program.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    #[error(transparent)]
    Read(#[from] ReadError),
    #[error(transparent)]
    Header(#[from] HeaderError),
    #[error(transparent)]
    Stale(StaleError),
    #[error(transparent)]
    Translate(#[from] TranslateError),
    #[error(transparent)]
    Verify(#[from] VerifyError),
    #[error(transparent)]
    Prove(#[from] ProveError),
    #[error("nothing is proved: {0}")]
    Refused(#[from] Refused),
    #[error(transparent)]
    Tool(#[from] ToolError),
    #[error(transparent)]
    Certify(CertifyError),
    #[error(transparent)]
    Target(#[from] TargetError),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Write(#[from] WriteError),
    #[error(transparent)]
    New(#[from] NewError),
    /// Denied warnings, and the other enabled ones.
    #[error("{}\n\nerror: {}", .0, denied(.0))]
    Denied(Diagnostics),
    /// The prompt fails, or its input cannot be read.
    #[error("cannot read the input: {0}")]
    Typed(String),
    /// Arguments that do not fit the system.
    #[error("{0}")]
    Usage(String),
    #[error("cannot print {what}: {source}")]
    Print { what: &'static str, source: std::io::Error },
}

impl From<CertifyError> for CommandError {
    fn from(error: CertifyError) -> Self {
        match error {
            CertifyError::Translate(error) => error.into(),
            CertifyError::Prove(error) => error.into(),
            error => Self::Certify(error),
        }
    }
}

impl From<StaleError> for CommandError {
    fn from(error: StaleError) -> Self {
        match error {
            StaleError::Translate(error) => error.into(),
            StaleError::Read(error) => error.into(),
            error @ StaleError::Differs { .. } => Self::Stale(error),
        }
    }
}

/// Exit status if a check has no result.
const NOT_CHECKED: u8 = 3;

/// Runs the program. Returns its exit status.
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(usage) => return say(&usage),
    };
    let (done, json) = match (&arguments.command, &arguments.configuration) {
        (Some(Task::New { name }), _) => {
            (make(name, printed).map(|()| ExitCode::SUCCESS).map_err(CommandError::from), false)
        }
        (Some(Task::Explain { code }), _) => {
            let text = explained(code.as_deref());
            (print("the explanation", &text).map(|()| ExitCode::SUCCESS), false)
        }
        (Some(Task::Completions { shell }), _) => (print_completions(*shell), false),
        (Some(Task::Man { command }), _) => (manual(command.as_deref()), false),
        (Some(Task::Fmt(asked)), _) => (fmt::run(asked), is_json(&asked.message_format)),
        (Some(Task::Lsp { .. }), _) => (serve_editor(), false),
        (Some(Task::Run(asked)), _) => (run::run(asked), false),
        (Some(Task::Prove(asked)), _) => (prove::run(asked), is_json(&asked.message_format)),
        (Some(Task::Validate(asked)), _) => (validate::run(asked), is_json(&asked.message_format)),
        (Some(Task::Certify(asked)), _) => (certify::run(asked), is_json(&asked.message_format)),
        (Some(Task::Verify(asked)), _) => (verify::run(asked), is_json(&asked.message_format)),
        (None, Some(configuration)) => {
            (translate_files(&arguments, configuration), is_json(&arguments.message_format))
        }
        (None, None) => unreachable!("clap asks for the configuration"),
    };
    // Status 1 of these says that something is wrong with the agent's behaviour, which an error does not show.
    let judges = matches!(
        arguments.command,
        Some(Task::Prove(_) | Task::Validate(_) | Task::Certify(_) | Task::Verify(_))
    );
    done.unwrap_or_else(|error| {
        let status = complain(&error, json);
        if judges { NOT_CHECKED.into() } else { status }
    })
}

/// The explanation of a kind of error or warning, or all codes.
fn explained(code: Option<&str>) -> String {
    let Some(code) = code.and_then(Code::named) else {
        let line = |code: &Code| format!("{:<20} {}", code.name(), code.meaning());
        return Code::ALL.iter().map(line).collect::<Vec<_>>().join("\n") + "\n";
    };
    let severity = if code.severity() == Severity::Error { "error" } else { "warning" };
    format!("{severity} `{}`: {}\n\n{}\n", code.name(), code.meaning(), code.explanation())
}

fn print_completions(shell: Shell) -> Result<ExitCode, CommandError> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "asl2c", &mut script);
    print("the completions", &String::from_utf8_lossy(&script)).map(|()| ExitCode::SUCCESS)
}

/// Prints the manual page of the program, or of one of its commands.
fn manual(command: Option<&str>) -> Result<ExitCode, CommandError> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    // What names the commands' pages.
    program.build();
    let documented = match command {
        Some(name) => program.find_subcommand(name).cloned(),
        None => Some(program),
    };
    let documented = documented.ok_or_else(|| {
        CommandError::Usage(format!("there is no command `{}`", command.unwrap_or_default()))
    })?;
    let mut page = Vec::new();
    let rendered = clap_mangen::Man::new(documented).render(&mut page);
    rendered.map_err(|source| CommandError::Print { what: "the manual page", source })?;
    print("the manual page", &String::from_utf8_lossy(&page)).map(|()| ExitCode::SUCCESS)
}

/// Serves an editor until it leaves.
fn serve_editor() -> Result<ExitCode, CommandError> {
    let ended = lsp::serve(std::io::stdin(), &mut std::io::stdout().lock());
    let orderly = ended.map_err(|source| CommandError::Print { what: "an answer", source })?;
    Ok(if orderly { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn translate_files(arguments: &Arguments, path: &Path) -> Result<ExitCode, CommandError> {
    let json = is_json(&arguments.message_format);
    let agent = Agent::read(path)?;
    let mut translation =
        translate(&agent.configuration, &agent.text).map_err(|error| match error {
            TranslateError::Refused(found) => {
                TranslateError::Refused(printed_of(arguments, &found))
            }
            error => error,
        })?;
    let warnings = printed_of(arguments, &translation.warnings);
    if warnings.has_errors() {
        return Err(CommandError::Denied(warnings));
    }
    let folder = arguments.output.as_deref().unwrap_or(agent.folder());
    let files = output::known_again(translation.files.clone());
    output::write(&agent, &files, folder, arguments.force)?;
    if !warnings.is_empty() {
        complain_of(&if json { lines(&warnings) } else { warnings.to_string() });
    }
    if arguments.report {
        translation.files.extend(agent.own_headers(&translation.files)?);
        for unknown in measure(&mut translation, &agent.configuration, &agent.text) {
            complain_of(&if json {
                line("warning", "not-measured", &unknown, None)
            } else {
                unknown
            });
        }
        print("the report", &translation.report.to_string())?;
    }
    if arguments.target.is_some() {
        let (text, same) = target::measured(&agent)?;
        print("the report", &text)?;
        return Ok(if same { ExitCode::SUCCESS } else { ExitCode::FAILURE });
    }
    Ok(ExitCode::SUCCESS)
}

/// What is printed of errors and warnings: the errors first, denied warnings among them, then the other enabled warnings.
fn printed_of(arguments: &Arguments, found: &Diagnostics) -> Diagnostics {
    let is_error = |one: &Diagnostic| one.severity == Severity::Error;
    let mut enabled: Vec<Diagnostic> = found
        .iter()
        .filter(|one| is_error(one) || arguments.is_wanted(one.code))
        .cloned()
        .collect();
    for denied in enabled.iter_mut().filter(|one| arguments.is_denied(one.code)) {
        denied.severity = Severity::Error;
    }
    let (mut errors, warnings): (Vec<Diagnostic>, Vec<Diagnostic>) =
        enabled.into_iter().partition(is_error);
    if !arguments.quiet {
        errors.extend(warnings);
    }
    found.with(errors)
}

/// Prints an error. Returns the exit status.
fn complain(error: &CommandError, as_json: bool) -> ExitCode {
    let ours = matches!(
        error,
        CommandError::Read(ReadError::File { .. })
            | CommandError::Header(_)
            | CommandError::Stale(_)
            | CommandError::Print { .. }
            | CommandError::Typed(_)
            | CommandError::Usage(_)
            | CommandError::New(_)
            | CommandError::Output(OutputError::Write(_))
            | CommandError::Write(_)
            | CommandError::Verify(_)
            | CommandError::Prove(_)
            | CommandError::Certify(_)
            | CommandError::Target(_)
            | CommandError::Refused(_)
    );
    let prefix = if ours { "error: " } else { "" };
    complain_of(&if as_json { error_lines(error) } else { format!("{prefix}{error}") });
    let nothing_known = matches!(
        error,
        CommandError::Verify(_)
            | CommandError::Prove(_)
            | CommandError::Certify(
                CertifyError::Tool(_) | CertifyError::Tools(_) | CertifyError::Contradicted { .. }
            )
            | CommandError::Target(_)
            | CommandError::Refused(_)
            | CommandError::Translate(TranslateError::Unprovable { .. })
    );
    if nothing_known { NOT_CHECKED.into() } else { ExitCode::FAILURE }
}

/// Prints a message to standard error. There is no other channel if that fails.
fn complain_of(message: &str) {
    _ = writeln!(std::io::stderr(), "{message}");
}

/// Prints a result.
fn print(what: &'static str, text: &str) -> Result<(), CommandError> {
    printed(text).map_err(|source| CommandError::Print { what, source })
}

fn printed(text: &str) -> std::io::Result<()> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(text.as_bytes())?;
    stdout.flush()
}

/// Prints clap's output: help, version, or a usage error.
fn say(usage: &clap::Error) -> ExitCode {
    let said = usage.print().and_then(|()| std::io::stdout().flush());
    if let Err(source) = said
        && !usage.use_stderr()
    {
        return complain(&CommandError::Print { what: "the help", source }, false);
    }
    u8::try_from(usage.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}
