//! Command-line arguments.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use translator::Code;

/// Translate an AgentSpeak agent to C without heap, recursion or unbounded loops.
///
/// Writes the files that the configuration's `settings` name: the C file, its header, the header of the basic
/// actions and, with `rust = FILE`, the Rust bindings. If there is an error nothing is written. A file
/// is replaced only if it was generated and nobody has changed it since.
#[derive(Debug, Parser)]
#[command(
    name = "asl2c",
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Exit status: 0 translated, or every property holds; 1 refused, unreadable, not printed, a property \
                  that does not hold, or another trace on the target; 2 usage; 3 a property or the target could \
                  not be checked because a tool, memory or the properties are missing."
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Task>,
    /// The agent's configuration
    #[arg(value_name = "AGENT.CONF", required = true)]
    pub(super) configuration: Option<PathBuf>,
    /// Folder of the generated files [default: the configuration's folder]
    #[arg(short, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    /// Replace files that were changed since they were generated, or that somebody else wrote. Files that are
    /// translated or included are never replaced, and nothing is written through a link
    #[arg(short, long)]
    pub(super) force: bool,
    /// Print the agent's cost: memory, call depth, calls of each action in a step. If gcc and callgrind are
    /// installed, also the stack and the longest path of a step (gcc) and the costliest step under random
    /// events (callgrind)
    #[arg(long)]
    pub(super) report: bool,
    /// With the report, also compile the C for this microcontroller: size, stack and longest path of that code,
    /// and its trace under QEMU, which must be the same as on this machine
    #[arg(long, value_name = "TARGET", requires = "report", value_parser = ["cortex-m4"])]
    pub(super) target: Option<String>,
    /// Print errors only
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// Silence this warning: its code, or `all`; may be repeated
    #[arg(short = 'A', long = "allow", value_name = "CODE", value_parser = code("all"))]
    pub(super) allow: Vec<String>,
    /// Enable this warning in spite of `-A`
    #[arg(short = 'W', long = "warn", value_name = "CODE", value_parser = code("all"))]
    pub(super) warn: Vec<String>,
    /// Treat this warning as an error: its code, or `warnings` for all that are not silenced
    #[arg(short = 'D', long = "deny", value_name = "CODE", value_parser = code("warnings"))]
    pub(super) deny: Vec<String>,
    /// Format of errors and warnings: text, or one JSON object per line
    #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
    pub(super) message_format: String,
}

impl Arguments {
    /// Whether a warning is printed.
    pub(super) fn is_wanted(&self, code: &str) -> bool {
        let named = |list: &[String]| list.iter().any(|other| other == code || other == "all");
        named(&self.warn) || !named(&self.allow) || self.deny.iter().any(|other| other == code)
    }

    /// Whether a printed warning counts as an error.
    pub(super) fn is_denied(&self, code: &str) -> bool {
        self.deny.iter().any(|other| other == code || other == "warnings")
    }
}

/// Whether messages are printed as JSON.
pub(super) fn is_json(message_format: &str) -> bool {
    message_format == "json"
}

/// Codes of warnings, and a word for all of them.
fn code(all: &'static str) -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(Code::warnings().map(Code::name).chain([all]))
}

/// Codes of errors and warnings.
fn any_code() -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(Code::ALL.iter().map(|code| code.name()))
}

#[derive(Debug, Subcommand)]
pub(super) enum Task {
    /// Create a folder with an agent, its configuration, a main program, and a Makefile that builds and runs
    /// them
    New {
        /// Name of the agent and the folder: lower-case letters, digits and `_`
        #[arg(value_name = "NAME")]
        name: String,
    },
    /// Explain a kind of error or warning by its code, or list all codes
    Explain {
        /// The code, as in `warning[CODE]` and in lines of JSON
        #[arg(value_name = "CODE", value_parser = any_code())]
        code: Option<String>,
    },
    /// Format the texts of agents and systems in the canonical style
    ///
    /// A text that cannot be parsed is not changed, and its errors are shown; the exit status is 1 then.
    Fmt(Fmt),
    /// Serve an editor by the Language Server Protocol, over standard input and output
    ///
    /// Diagnostics of agents and their configurations while typing, types and what events lead to, definitions,
    /// references, renaming, completion, formatting, outlines and colours. The exit status is 0 if the editor shut the
    /// server down before it left, otherwise 1.
    Lsp {
        /// As editors pass it: there is no other transport
        #[arg(long)]
        stdio: bool,
    },
    /// Run the agent by the reference interpreter, without any C: a prompt for calls of its interface,
    /// results of its functions, steps, and its state
    ///
    /// A file NAME.system describes several agents that talk, which are run round by round.
    ///
    /// `help` lists the commands. Input from a file or pipe is executed line by line; the exit status is 1 if
    /// a line has an error, differs from a transcript, or violates a property.
    Run(Run),
    /// Prove the configuration's properties, and the absence of run-time errors, on the agent's C with CBMC
    ///
    /// In every environment and for any number of steps: an invariant is found, and proved with the
    /// properties. For a property that does not hold, a counterexample with all values is shown and saved as
    /// a script for `asl2c run --script`. The exit status is 0 if all is proved, 1 if there is a
    /// counterexample, and 3 if something could not be decided or a tool is missing.
    Prove(Prove),
    /// Prove with CBMC that the agent's C does what its text says
    ///
    /// The text is translated a second time, into plain C by other code, and both are compared: from any two
    /// related states, with the same answers of the environment, each call of the interface makes the same
    /// calls in the same order and ends in related states. The exit status is 0 if that is proved, 1 if the C
    /// differs (with the shortest way to it, saved as a script for `asl2c run --script`), and 3 if it could not
    /// be decided or a tool is missing.
    Validate(Validate),
    /// Gather the evidence for an agent: proofs, rules, bounds and tests of its C, in a folder with a page
    ///
    /// The C is compared with the agent's text (`validate`), the properties and the absence of run-time errors are
    /// proved (`prove`, the latter by Frama-C too), the rules of MISRA C:2012 are checked with cppcheck, stack and time
    /// are measured (`--report`), and tests that are made from the text are executed on the C, with the coverage that they reach.
    /// `index.html` has all of it for a reviewer, `evidence.json` for programs; with the same tools the files are the
    /// same each time. The exit status is 0 if everything is shown, 1 if something is refuted, and 3 if something
    /// could not be decided or a tool is missing.
    Certify(Certify),
    /// Check the configuration's properties with SPIN, on a model of the agent in any environment
    ///
    /// A file NAME.system describes several agents that talk, the channels between them, and properties of the whole.
    ///
    /// For a property that does not hold, the shortest counterexample is shown: the environment's actions,
    /// the event of each step, its plan and the actions, with lines of the agent. Values are not part of the
    /// model, so the counterexample may need an environment that cannot exist.
    Verify(Verify),
    /// Print what a shell needs to complete the command line
    Completions {
        /// The shell
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// Print the manual page of the program, or of one of its commands
    Man {
        /// The command
        #[arg(value_name = "COMMAND")]
        command: Option<String>,
    },
}

/// Arguments of `asl2c verify`.
#[derive(Debug, Args)]
pub(super) struct Verify {
    /// The agent's configuration, or a system of agents: a file NAME.system
    #[arg(value_name = "AGENT.CONF|NAME.SYSTEM")]
    pub(super) configuration: PathBuf,
    /// Of a system: folder of the counterexamples [default: the system's folder]
    #[arg(short, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    /// Check only this property; may be repeated
    #[arg(long, value_name = "PROPERTY")]
    pub(super) only: Vec<String>,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
    /// Print the Promela model without checking it
    #[arg(long, conflicts_with = "json")]
    pub(super) model: bool,
    /// Print only properties that do not hold; `--json` still prints all
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// Format of errors: text, or one JSON object per line
    #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
    pub(super) message_format: String,
}

/// Arguments of `asl2c fmt`.
#[derive(Debug, Args)]
pub(super) struct Fmt {
    /// The texts of agents and systems; `-` formats standard input to standard output
    #[arg(value_name = "AGENT.ASL|NAME.SYSTEM", required = true)]
    pub(super) files: Vec<PathBuf>,
    /// Change nothing: list the files that are not formatted, with exit status 1 if there are some
    #[arg(long)]
    pub(super) check: bool,
    /// Format of errors: text, or one JSON object per line
    #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
    pub(super) message_format: String,
}

/// Arguments of `asl2c run`.
#[derive(Debug, Args)]
pub(super) struct Run {
    /// The agent's configuration, or a system of agents: a file NAME.system
    #[arg(value_name = "AGENT.CONF|NAME.SYSTEM")]
    pub(super) configuration: PathBuf,
    /// Of a system: how many messages of a hundred are lost [default: 0]
    #[arg(long, value_name = "PERCENT", value_parser = clap::value_parser!(u32).range(0..=100))]
    pub(super) loss: Option<u32>,
    /// Of a system: how many rounds a message is late at most [default: 0]
    #[arg(long, value_name = "ROUNDS", value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub(super) delay: Option<u32>,
    /// Of a system: start of the random numbers for losses and delays [default: 1]
    #[arg(long, value_name = "NUMBER")]
    pub(super) seed: Option<u64>,
    /// Execute the lines of this file. If some begin with `>` it is a transcript: those lines are executed,
    /// and the lines between them are the expected output
    #[arg(long, value_name = "FILE")]
    pub(super) script: Option<PathBuf>,
}

/// Arguments of `asl2c prove`.
#[derive(Debug, Args)]
pub(super) struct Prove {
    /// The agent's configuration
    #[arg(value_name = "AGENT.CONF")]
    pub(super) configuration: PathBuf,
    /// Folder of the counterexamples [default: the configuration's folder]
    #[arg(short, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    /// Folder with tests of your own: transcripts of `asl2c run`, in files NAME.transcript
    #[arg(long, value_name = "DIR")]
    pub(super) tests: Option<PathBuf>,
    /// The CBMC to use [default: that on the path]
    #[arg(long, value_name = "PATH")]
    pub(super) cbmc: Option<PathBuf>,
    /// Begin with the conditions in this file, one a line, in place of searching all: `invariant.txt` of earlier evidence.
    /// Each is proved again, and if they do not prove everything, all are searched
    #[arg(long, value_name = "FILE")]
    pub(super) invariant: Option<PathBuf>,
    /// Maximum length of counterexamples, in events, beliefs and steps
    #[arg(long, value_name = "TRANSITIONS", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) length: u32,
    /// Time limit of the search for counterexamples, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 600)]
    pub(super) time: u64,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
    /// Print only what is not proved; `--json` still prints all
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// Format of errors: text, or one JSON object per line
    #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
    pub(super) message_format: String,
}

/// Arguments of `asl2c validate`.
#[derive(Debug, Args)]
pub(super) struct Validate {
    /// The agent's configuration
    #[arg(value_name = "AGENT.CONF")]
    pub(super) configuration: PathBuf,
    /// The C file to judge, with the state and interface of the generated header [default: the translation]
    #[arg(long, value_name = "FILE")]
    pub(super) c: Option<PathBuf>,
    /// Folder of the script that shows a difference [default: the configuration's folder]
    #[arg(short, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,
    /// The CBMC to use [default: that on the path]
    #[arg(long, value_name = "PATH")]
    pub(super) cbmc: Option<PathBuf>,
    /// Maximum length of the way to a difference, in events, beliefs and steps
    #[arg(long, value_name = "TRANSITIONS", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) length: u32,
    /// Time limit of each proof, and of the search for a difference, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 600)]
    pub(super) time: u64,
    /// Time limit of all together, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 7200)]
    pub(super) total: u64,
    /// Do not print the progress
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// Print one JSON object
    #[arg(long)]
    pub(super) json: bool,
    /// Format of errors: text, or one JSON object per line
    #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
    pub(super) message_format: String,
}

/// Arguments of `asl2c certify`.
#[derive(Debug, Args)]
pub(super) struct Certify {
    /// The agent's configuration
    #[arg(value_name = "AGENT.CONF")]
    pub(super) configuration: PathBuf,
    /// Folder of the evidence: a new or empty one, or one with earlier evidence, which is replaced if nobody has
    /// changed it
    #[arg(short, value_name = "DIR", required = true)]
    pub(super) output: PathBuf,
    /// Folder with tests of your own: transcripts of `asl2c run`, in files NAME.transcript
    #[arg(long, value_name = "DIR")]
    pub(super) tests: Option<PathBuf>,
    /// The CBMC to use [default: that on the path]
    #[arg(long, value_name = "PATH")]
    pub(super) cbmc: Option<PathBuf>,
    /// Begin with the conditions in this file, one a line, in place of searching all: `invariant.txt` of earlier evidence.
    /// Each is proved again, and if they do not prove everything, all are searched
    #[arg(long, value_name = "FILE")]
    pub(super) invariant: Option<PathBuf>,
    /// Maximum length of counterexamples, in events, beliefs and steps
    #[arg(long, value_name = "TRANSITIONS", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) length: u32,
    /// Time limit of each proof of the comparison, and of the search for counterexamples, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = 1800)]
    pub(super) time: u64,
    /// Do not print what is being done
    #[arg(short, long)]
    pub(super) quiet: bool,
    /// Format of errors: text, or one JSON object per line
    #[arg(long, value_name = "FORMAT", default_value = "human", value_parser = ["human", "json"])]
    pub(super) message_format: String,
}
