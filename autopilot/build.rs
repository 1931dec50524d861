//! Translates the agent to C and Rust, and compiles the C.
//!
//! If `AGENT_COVERAGE` is set, the C counts what it executes (gcov), beside itself in `OUT_DIR`; `cargo xtask verify` reads
//! this.

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
    let is_counted = std::env::var_os(COVERAGE).is_some();
    let mut c = cc::Build::new();
    c.include(&out).std("c99").flag(translator::ROUNDED).warnings(true).extra_warnings(true);
    for file in &translation.files {
        let path = out.join(&file.name);
        std::fs::write(&path, &file.text)?;
        if path.extension().is_some_and(|extension| extension == "c") {
            c.file(path);
        }
    }
    if is_counted {
        // Optimized code has other branches than the source; atomic counters allow tests on several threads.
        c.opt_level(0).flag("--coverage").flag("-fprofile-update=atomic");
    }
    c.try_compile("autopilot_agent")?;
    if is_counted {
        println!("cargo::rustc-link-lib=gcov");
    }
    Ok(())
}
