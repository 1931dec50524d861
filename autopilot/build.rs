//! Translates the agent to C and Rust, and compiles the C.

use std::error::Error;
use std::path::PathBuf;

const CONFIGURATION: &str = "agent/autopilot.conf";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=agent");
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let configuration =
        translator::parse_configuration(CONFIGURATION, &std::fs::read_to_string(CONFIGURATION)?)?;
    let agent = std::fs::read_to_string(format!("agent/{}", configuration.input()))?;
    let translation = translator::translate(configuration, &agent)?;
    for line in translation.warnings.lines() {
        println!("cargo::warning={line}");
    }
    let mut c = cc::Build::new();
    c.include(&out).std("c99").warnings(true).extra_warnings(true);
    for file in &translation.files {
        let path = out.join(&file.name);
        std::fs::write(&path, &file.text)?;
        if path.extension().is_some_and(|extension| extension == "c") {
            c.file(path);
        }
    }
    c.try_compile("autopilot_agent")?;
    Ok(())
}
