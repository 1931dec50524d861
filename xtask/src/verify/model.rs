//! Checks the properties on a model of the agent, with `asl2c verify`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde::Deserialize;
use translator::Happening;

use super::{Agent, VerifyError, in_file, write};

/// The model checker that `asl2c` uses.
pub(super) const SPIN: &str = "spin";

/// The translator as a program.
pub(super) struct Asl2c {
    program: PathBuf,
}

/// What was found of one property.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Checked {
    /// The property.
    pub(super) name: String,
    verdict: String,
    /// The shortest way to a failure.
    pub(super) trace: Vec<Happening>,
}

#[derive(Debug, Deserialize)]
struct Answer {
    properties: Vec<Checked>,
}

impl Checked {
    /// Whether the property holds in every environment.
    pub(super) fn holds(&self) -> bool {
        self.verdict == "holds"
    }

    /// Whether there is an environment in which it fails.
    pub(super) fn fails(&self) -> bool {
        self.verdict == "fails"
    }
}

impl Asl2c {
    /// Builds it as this program is built.
    pub(super) fn build() -> Result<Self, VerifyError> {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = Command::new(&cargo);
        build.args(["build", "--locked", "--quiet", "-p", "translator"]);
        let profile = if cfg!(debug_assertions) { "debug" } else { "release" };
        if profile == "release" {
            build.arg("--release");
        }
        let built = build.status().map_err(in_file("cannot run", Path::new(&cargo)))?;
        let program = super::folder(profile).join("asl2c");
        if !built.success() {
            let output = "the translator does not build".to_owned();
            return Err(VerifyError::Tool { tool: "cargo", output });
        }
        Ok(Self { program: program.canonicalize().map_err(in_file("cannot find", &program))? })
    }

    /// Checks all properties of an agent, or only one.
    pub(super) fn verify(
        &self,
        agent: &Agent<'_>,
        folder: &Path,
        only: Option<&str>,
    ) -> Result<Vec<Checked>, VerifyError> {
        let only = only.iter().flat_map(|name| ["--only", name]);
        let arguments: Vec<&str> = ["verify", "--json"].into_iter().chain(only).collect();
        let output = self.run(agent, folder, &arguments)?;
        let answer: Result<Answer, _> = serde_json::from_slice(&output.stdout);
        answer.map(|answer| answer.properties).map_err(|_| VerifyError::Tool {
            tool: "asl2c",
            output: String::from_utf8_lossy(&output.stderr).into_owned(),
        })
    }

    /// What the agent costs.
    pub(super) fn report(&self, agent: &Agent<'_>, folder: &Path) -> Result<String, VerifyError> {
        let output = self.run(agent, folder, &["--report"])?;
        // What could not be measured is said there, and the rest is printed all the same.
        if !output.status.success() || !output.stderr.is_empty() {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(VerifyError::Tool { tool: "asl2c", output: said });
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn run(
        &self,
        agent: &Agent<'_>,
        folder: &Path,
        arguments: &[&str],
    ) -> Result<Output, VerifyError> {
        std::fs::create_dir_all(folder).map_err(in_file("cannot make", folder))?;
        write(folder, agent.name, agent.configuration)?;
        write(folder, agent.input, agent.text)?;
        let mut program = Command::new(&self.program);
        program.args(arguments).arg(agent.name).current_dir(folder);
        program.output().map_err(in_file("cannot run", &self.program))
    }
}
