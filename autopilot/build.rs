//! Translates the agent to C and Rust, and compiles the C.
//!
//! If `AGENT_COVERAGE` names a folder, the C is instrumented and its coverage (gcov) is collected there;
//! `cargo xtask verify` uses this.

use std::error::Error;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

const COVERAGE: &str = "AGENT_COVERAGE";
const CONFIGURATION: &str = "agent/autopilot.conf";

fn main() -> ExitCode {
    match build() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Returning the error would print its debug form, which escapes line breaks. If stderr fails, the
            // exit status remains.
            _ = writeln!(std::io::stderr(), "{error}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=agent");
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let configuration =
        translator::parse_configuration(CONFIGURATION, &std::fs::read_to_string(CONFIGURATION)?)?;
    let agent = std::fs::read_to_string(format!("agent/{}", configuration.input()))?;
    let translation = translator::translate(&configuration, &agent)?;
    for line in translation.warnings.to_string().lines() {
        println!("cargo::warning={line}");
    }
    println!("cargo::rerun-if-env-changed={COVERAGE}");
    let counted = std::env::var_os(COVERAGE).map(PathBuf::from);
    let sources = counted.as_ref().unwrap_or(&out);
    std::fs::create_dir_all(sources)?;
    let mut c = cc::Build::new();
    c.include(sources).std("c99").flag(translator::ROUNDED).warnings(true).extra_warnings(true);
    for file in &translation.files {
        // Cargo expects the bindings in `OUT_DIR`.
        std::fs::write(out.join(&file.name), &file.text)?;
        let path = sources.join(&file.name);
        std::fs::write(&path, &file.text)?;
        if path.extension().is_some_and(|extension| extension == "c") {
            c.file(path);
        }
    }
    if counted.is_some() {
        // Optimized code has other branches than the source; atomic counters allow tests on several threads.
        c.opt_level(0).flag("--coverage").flag("-fprofile-update=atomic").out_dir(sources);
        println!("cargo::rerun-if-changed={}", sources.join(&translation.files[0].name).display());
    }
    c.try_compile("autopilot_agent")?;
    if counted.is_some() {
        println!("cargo::rustc-link-lib=gcov");
    }
    Ok(())
}
