//! Runs the compiled C.

use std::fmt::Write as _;
use std::process::Command as Process;

use translator::{parse_configuration, translate};

use super::generate::{ACTIONS, Command, FUNCTIONS, RandomAgent, Type};
use crate::harness::STRICT;

const PRELUDE: &str = r#"
#include <stdio.h>
#include <string.h>
static uint32_t hash_value;
static uint32_t calls;
static bool pending;
static int pending1;
static int pending2;
static void start(const char *name)
{
    printf("%s", name);
    hash_value = 2166136261U;
    hash_value = (hash_value ^ (uint32_t)(unsigned char)name[1]) * 16777619U;
    hash_value = (hash_value ^ calls) * 16777619U;
}
static void mix(uint32_t value) { hash_value = (hash_value ^ value) * 16777619U; }
static void integer(int32_t value) { printf(" %d", value); mix((uint32_t)value); }
static void number(double value)
{
    uint64_t bits = 0U;
    if (!((value < 0.0) || (value >= 0.0))) { bits = 0U; } else { memcpy(&bits, &value, sizeof bits); }
    printf(" %016llx", (unsigned long long)bits);
    mix((uint32_t)(bits & 0xFFFFFFFFU));
    mix((uint32_t)(bits >> 32));
}
static bool extreme(void) { return (hash_value & 0x1FU) == 0U; }
void updateBeliefs(void) { if (pending) { pending = false; set_b2(pending1, pending2); } }
"#;

/// The trace of all sequences.
pub(super) fn run(agent: &RandomAgent, sequences: &[Vec<Command>]) -> Result<String, String> {
    let parsed = parse_configuration("agent.conf", &agent.configuration)
        .map_err(|error| error.to_string())?;
    let translation = translate(&parsed, &agent.text).map_err(|error| error.to_string())?;
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    for file in &translation.files {
        std::fs::write(folder.path().join(&file.name), &file.text)
            .map_err(|error| error.to_string())?;
    }
    let preempts = translation.files.iter().any(|file| file.text.contains("aborted_events"));
    let main = main_function(sequences, if preempts { "aborted_events()" } else { "0U" });
    // One compilation unit, because compilation dominates the time.
    let main = format!("#include \"agent.c\"\n{PRELUDE}{}{main}", basics());
    std::fs::write(folder.path().join("main.c"), main).map_err(|error| error.to_string())?;
    // `tcc` is faster, but has fewer warnings.
    let compiler = std::env::var("ASL2C_CC").unwrap_or_else(|_| "cc".to_owned());
    let mut compile = Process::new(&compiler);
    if compiler == "cc" {
        compile.args(STRICT).args(["-O1", "-pipe"]);
    }
    let compiled = compile
        .current_dir(folder.path())
        .args(["-o", "agent", "main.c"])
        .output()
        .map_err(|error| error.to_string())?;
    if !compiled.status.success() {
        let message = String::from_utf8_lossy(&compiled.stderr);
        return Err(format!("{}\n{message}\n{}", agent.text, translation.files[0].text));
    }
    let output =
        Process::new(folder.path().join("agent")).output().map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("{}\n{:?}", agent.text, output.status));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn basics() -> String {
    let mut text = String::new();
    let actions = ACTIONS.iter().map(|(name, types)| (*name, *types, None));
    let functions = FUNCTIONS.iter().map(|(name, types, result)| (*name, *types, Some(*result)));
    for (name, types, result) in actions.chain(functions) {
        let parameters: Vec<String> =
            types.iter().enumerate().map(|(i, t)| format!("{} x{i}", t.c_name())).collect();
        let parameters =
            if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") };
        let returned = result.map_or("void", Type::c_name);
        _ = write!(text, "{returned} {name}({parameters}) {{ start(\"{name}\");");
        for (index, ctype) in types.iter().enumerate() {
            match ctype {
                Type::Double => _ = write!(text, " number(x{index});"),
                _ => _ = write!(text, " integer((int32_t)x{index});"),
            }
        }
        text.push_str(" printf(\"\\n\");");
        if let Some(result) = result {
            _ = write!(text, " calls++; return {};", result_expression(result));
        }
        text.push_str(" }\n");
    }
    text
}

fn result_expression(result: Type) -> &'static str {
    match result {
        Type::Bool => "((hash_value >> 5) & 4U) != 0U",
        Type::Double => {
            "((const double[]){0.0, 1.5, -2.0, 0.1, 1e300, -0.0})[(hash_value >> 5) % 6U]"
        }
        Type::Small => "(int8_t)(extreme() ? 127 : (int)((hash_value >> 5) % 7U) - 3)",
        Type::Int => "extreme() ? 2147483647 : (int)((hash_value >> 5) % 7U) - 3",
        Type::Unsigned => "(uint16_t)(extreme() ? 65535U : (hash_value >> 5) % 7U)",
    }
}

fn main_function(sequences: &[Vec<Command>], aborted: &str) -> String {
    let mut text = String::from("int main(void)\n{\n");
    let c_constant = |constant: &String| match constant.as_str() {
        "-2147483648" => "(-2147483647 - 1)".to_owned(),
        other => other.to_owned(),
    };
    for sequence in sequences {
        text.push_str("init(); calls = 0U; pending = false; printf(\"sequence\\n\");\n");
        for command in sequence {
            match command {
                Command::Step => {
                    _ = writeln!(
                        text,
                        "next_step(); printf(\"step %u %u %u\\n\", unhandled_events(), refused_events(), {aborted});",
                    );
                }
                Command::Raise(verb, name, arguments) => {
                    let arguments: Vec<String> = arguments.iter().map(c_constant).collect();
                    let arguments = arguments.join(", ");
                    _ = writeln!(text, "printf(\"raise %d\\n\", (int){verb}_{name}({arguments}));");
                }
                Command::Set(first, second) => {
                    let (first, second) = (c_constant(first), c_constant(second));
                    _ = writeln!(text, "pending = true; pending1 = {first}; pending2 = {second};");
                }
                Command::Init => text.push_str("init();\n"),
                Command::Clear => text.push_str("clear();\n"),
            }
        }
    }
    text.push_str("return 0;\n}\n");
    text
}
