//! Translates the agents in `agents/` to C and Rust, compiles the C, and lists them for `built_in.rs`.
//!
//! Each `NAME.conf` there is an agent, except `boundary.conf`, which says what all of them may sense and order.

use std::error::Error;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use translator::ParsedConfiguration;

const AGENTS: &str = "agents";
const BOUNDARY: &str = "boundary";

fn main() -> ExitCode {
    match build() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Returning the error would print its debug form, which escapes line breaks. If stderr fails, the exit status remains.
            _ = writeln!(std::io::stderr(), "{error}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={AGENTS}");
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let boundary = configuration(BOUNDARY)?;
    let mut names = Vec::new();
    for entry in std::fs::read_dir(AGENTS)? {
        let path = entry?.path();
        let name = path.file_stem().and_then(|name| name.to_str()).unwrap_or_default();
        if path.extension().is_some_and(|extension| extension == "conf") && name != BOUNDARY {
            names.push(name.to_owned());
        }
    }
    names.sort();
    let mut c = cc::Build::new();
    c.std("c99").flag(translator::ROUNDED).warnings(true).extra_warnings(true);
    let mut list = String::new();
    for name in &names {
        let folder = out.join(name);
        std::fs::create_dir_all(&folder)?;
        list += &agent(name, &boundary, &folder, &mut c)?;
    }
    let all: Vec<String> = names.iter().map(|name| format!("(\"{name}\", {name}::new)")).collect();
    writeln!(list, "const ALL: &[(&str, New)] = &[{}];", all.join(", "))?;
    std::fs::write(out.join("agents.rs"), list)?;
    c.try_compile("mission_agents")?;
    Ok(())
}

fn configuration(name: &str) -> Result<ParsedConfiguration, Box<dyn Error>> {
    let path = format!("{AGENTS}/{name}.conf");
    Ok(translator::parse_configuration(&path, &std::fs::read_to_string(&path)?)?)
}

/// Translates an agent; returns its line for `built_in.rs`.
fn agent(
    name: &str,
    boundary: &ParsedConfiguration,
    folder: &Path,
    c: &mut cc::Build,
) -> Result<String, Box<dyn Error>> {
    let configuration = configuration(name)?;
    fits(name, &configuration, boundary)?;
    let text = std::fs::read_to_string(format!("{AGENTS}/{}", configuration.input()))?;
    let translation = translator::translate(&configuration, &text)?;
    for line in translation.warnings.to_string().lines() {
        println!("cargo::warning={line}");
    }
    for file in &translation.files {
        let path = folder.join(&file.name);
        std::fs::write(&path, &file.text)?;
        if path.extension().is_some_and(|extension| extension == "c") {
            c.include(folder).file(path);
        }
    }
    let declared = configuration.declarations();
    let settables: Vec<&str> = declared.settables.iter().map(|name| name.text.as_str()).collect();
    let mut methods = Vec::new();
    for basic in &declared.basics {
        let parameters: Vec<String> = (basic.parameters.iter().enumerate())
            .map(|(number, parameter)| Ok(format!("a{number}: {}", rust(&parameter.name)?)))
            .collect::<Result<_, String>>()?;
        let result = rust(&basic.result.name)?;
        methods.push(format!(
            "{}({}) -> {result}",
            snake_case(&basic.name.text),
            parameters.join(", ")
        ));
    }
    let kind = if declared.messages.is_empty() { "silent" } else { "talks" };
    Ok(format!(
        "built_in! {{ {kind} {name} \"{name}\" [{}] [{}] }}\n",
        settables.join(", "),
        methods.join(", ")
    ))
}

/// Each agent has the settings that the glue needs, and no sense and no order that is not in the boundary.
fn fits(
    name: &str,
    configuration: &ParsedConfiguration,
    boundary: &ParsedConfiguration,
) -> Result<(), String> {
    let (declared, may) = (configuration.declarations(), boundary.declarations());
    let settings = &declared.settings;
    let rust = settings.rust.as_ref().map(|file| file.text.as_str());
    if rust != Some(&format!("{name}.rs")) || settings.output != format!("{name}.c") {
        return Err(format!(
            "{AGENTS}/{name}.conf: write `output = {name}.c;` and `rust = {name}.rs;` in `settings`"
        ));
    }
    for basic in &declared.basics {
        let is_it = may.basics.iter().any(|it| {
            it.name.text == basic.name.text
                && it.result == basic.result
                && it.parameters == basic.parameters
        });
        if !is_it {
            return Err(format!(
                "{AGENTS}/{name}.conf: `{}` is not declared so in {AGENTS}/{BOUNDARY}.conf, which has all that an agent senses and orders",
                basic.name.text
            ));
        }
    }
    for belief in &declared.settables {
        if !may.settables.iter().any(|it| it.text == belief.text) {
            return Err(format!(
                "{AGENTS}/{name}.conf: nobody sets the belief `{}`: {AGENTS}/{BOUNDARY}.conf has those that are",
                belief.text
            ));
        }
    }
    Ok(())
}

/// The Rust type of a type of the boundary.
fn rust(c: &str) -> Result<&'static str, String> {
    Ok(match c {
        "void" => "()",
        "bool" => "bool",
        "double" => "f64",
        "int32_t" => "i32",
        "int64_t" => "i64",
        other => {
            return Err(format!("{AGENTS}/{BOUNDARY}.conf: no Rust type is known for `{other}`"));
        }
    })
}

/// `flyTo` as `fly_to`, as the bindings have it.
fn snake_case(name: &str) -> String {
    let mut snake = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() {
            snake.push('_');
        }
        snake.push(letter.to_ascii_lowercase());
    }
    snake
}
