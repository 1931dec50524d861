//! Dependencies between crates, and purity of the core crates.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use autopilot::vehicle::Phase;

/// The packages of the workspace and the packages that each may depend on.
const MAY_USE: [(&str, &[&str]); 15] = [
    ("diagnostic", &[]),
    ("translator", &["diagnostic"]),
    ("judged-c", &["diagnostic", "translator"]),
    ("asl2c", &["diagnostic", "judged-c", "translator"]),
    ("ardrone-link", &[]),
    ("kinematics", &[]),
    ("estimator", &["kinematics"]),
    ("pid", &["kinematics"]),
    ("mock-drone", &["ardrone-link", "diagnostic"]),
    ("autopilot", &["ardrone-link", "diagnostic", "estimator", "kinematics", "pid", "translator"]),
    ("mission-agent", &["autopilot", "kinematics", "translator"]),
    ("mavlink-vehicle", &["ardrone-link", "autopilot", "estimator", "kinematics"]),
    (
        "ardrone-pilot",
        &[
            "ardrone-link",
            "autopilot",
            "diagnostic",
            "estimator",
            "kinematics",
            "mavlink-vehicle",
            "mission-agent",
            "mock-drone",
        ],
    ),
    (
        "system-tests",
        &[
            "ardrone-link",
            "ardrone-pilot",
            "autopilot",
            "kinematics",
            "mavlink-vehicle",
            "mission-agent",
            "mock-drone",
        ],
    ),
    ("xtask", &["asl2c", "autopilot", "kinematics", "mock-drone", "system-tests", "translator"]),
];

/// All external dependencies of the autopilot. None of them opens a socket or a file, reads a clock or starts
/// a thread; review a new one before adding it.
const PURE: [&str; 30] = [
    "annotate-snippets",
    "anstyle",
    "approx",
    "arrayvec",
    "bitflags",
    "bytemuck",
    "bytes",
    "matrixmultiply",
    "memchr",
    "nalgebra",
    "nom",
    "num-complex",
    "num-integer",
    "num-rational",
    "num-traits",
    "proc-macro2",
    "quote",
    "rawpointer",
    "safe_arch",
    "serde",
    "serde_core",
    "serde_derive",
    "simba",
    "syn",
    "thiserror",
    "thiserror-impl",
    "typenum",
    "unicode-ident",
    "unicode-width",
    "wide",
];

/// What the MAVLink vehicle depends on besides. `mavlink-core` could open files, but not without its feature `std`.
const PURE_OF_MAVLINK: [&str; 12] = [
    "block-buffer",
    "cfg-if",
    "cpufeatures",
    "crc-any",
    "crypto-common",
    "digest",
    "embedded-io",
    "embedded-io-async",
    "generic-array",
    "mavlink-core",
    "num-derive",
    "sha2",
];

/// Names that a pure crate must not use. `cargo tree` does not show uses of the standard library.
const IMPURE: [&str; 10] = [
    "std::net",
    "std::fs",
    "std::thread",
    "std::env",
    "std::process",
    "Instant::now",
    "SystemTime",
    "tokio::",
    "io::std",
    // Would hide the imported names.
    "use std::{",
];

fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .args(["--locked", "--offline"])
        .current_dir("..")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn dependencies_point_one_way() {
    let metadata = cargo(&["metadata", "--no-deps", "--format-version", "1"]);
    let metadata: serde_json::Value = serde_json::from_str(&metadata).unwrap();
    let packages = metadata["packages"].as_array().unwrap();
    assert_eq!(packages.len(), MAY_USE.len(), "a package that nobody looks at");
    let names: Vec<&str> = packages.iter().map(|p| p["name"].as_str().unwrap()).collect();
    for package in packages {
        let name = package["name"].as_str().unwrap();
        let (_, allowed) = MAY_USE.iter().find(|(package, _)| *package == name).unwrap();
        for used in package["dependencies"].as_array().unwrap() {
            let used = used["name"].as_str().unwrap();
            assert!(!names.contains(&used) || allowed.contains(&used), "{name} uses {used}");
        }
    }
}

/// The names of all crates that a package needs at run time.
fn needed_by(package: &str) -> BTreeSet<String> {
    let tree = cargo(&["tree", "--package", package, "--edges", "normal", "--prefix", "none"]);
    let names = tree.lines().filter_map(|line| line.split(' ').next());
    names.filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

fn is_ours(name: &str) -> bool {
    MAY_USE.iter().any(|(package, _)| *package == name)
}

#[test]
fn the_pilot_depends_on_nothing_that_can_do_input_or_output() {
    let used = needed_by("autopilot");
    assert!(used.contains("nalgebra"), "{used:?}");
    for name in &used {
        assert!(is_ours(name) || PURE.contains(&&**name), "the pilot depends on {name}");
    }
}

#[test]
fn the_mavlink_vehicle_depends_on_nothing_that_can_do_input_or_output() {
    let used = needed_by("mavlink-vehicle");
    assert!(used.contains("mavlink-core"), "{used:?}");
    for name in &used {
        let pure = PURE.contains(&&**name) || PURE_OF_MAVLINK.contains(&&**name);
        assert!(is_ours(name) || pure, "the MAVLink vehicle depends on {name}");
    }
    let features =
        cargo(&["tree", "--package", "mavlink-vehicle", "--format", "{p} {f}", "--prefix", "none"]);
    let core = features.lines().find(|line| line.starts_with("mavlink-core "));
    assert!(core.is_some_and(|line| line.ends_with(" embedded")), "{features}");
}

/// Zenoh is what a program has that was built with the feature, and no other.
#[test]
fn without_its_feature_the_program_has_no_zenoh() {
    let is_zenoh = |name: &str| name == "zenoh" || name.starts_with("zenoh-");
    for package in ["ardrone-pilot", "system-tests", "xtask"] {
        let tree =
            cargo(&["tree", "--package", package, "--edges", "normal,build", "--prefix", "none"]);
        let mut names = tree.lines().filter_map(|line| line.split(' ').next());
        assert!(!names.any(is_zenoh), "{package}: {tree}");
    }
    let tree = ["tree", "--package", "ardrone-pilot", "--features", "zenoh", "--prefix", "none"];
    assert!(cargo(&tree).lines().any(|line| line.starts_with("zenoh v")));
}

/// Every build script that uses the translator compiles its dependencies.
#[test]
fn the_translator_needs_no_command_line_and_no_files() {
    let tree = cargo(&["tree", "--package", "translator", "--edges", "normal", "--prefix", "none"]);
    for name in ["clap", "tempfile", "rustix", "tokio", "asl2c"] {
        assert!(!tree.lines().any(|line| line.split(' ').next() == Some(name)), "{name}: {tree}");
    }
}

/// Simulated flights need only the mock's `World`: without features it must not depend on sockets or a
/// runtime.
#[test]
fn the_mock_drone_is_pure_without_its_features() {
    let tree = cargo(&[
        "tree",
        "--package",
        "mock-drone",
        "--no-default-features",
        "--edges",
        "normal",
        "--prefix",
        "none",
    ]);
    for name in ["clap", "tokio", "tracing-subscriber"] {
        assert!(!tree.lines().any(|line| line.split(' ').next() == Some(name)), "{name}: {tree}");
    }
}

/// What is believed of a network is decided without one.
#[test]
fn only_the_bridge_of_the_network_does_input_or_output() {
    let mut looked_at = 0;
    for path in sources(Path::new("../ardrone-pilot/src/network")) {
        if path.ends_with("bridge.rs") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        assert_eq!(impure_word(code), None, "{}", path.display());
        assert!(!code.contains("zenoh::") && !code.contains("flight::"), "{}", path.display());
        looked_at += 1;
    }
    assert!(looked_at >= 8, "{looked_at}");
}

/// Source files of a folder, except tests.
pub(crate) fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs")
            && !path.ends_with("tests.rs")
        {
            files.push(path);
        }
    }
    files
}

/// The first forbidden name in some code.
fn impure_word(code: &str) -> Option<&'static str> {
    let mut lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.find_map(|line| IMPURE.into_iter().find(|word| line.contains(word)))
}

#[test]
fn what_does_input_or_output_is_seen() {
    for code in [
        "use std::net::UdpSocket;",
        "use std::{fmt, fs};",
        "let now = std::time::Instant::now();",
        "use std::io::stdin;",
    ] {
        assert!(impure_word(code).is_some(), "{code}");
    }
    assert_eq!(impure_word("// std::fs is for shells\nuse std::time::Duration;"), None);
}

#[test]
fn pure_crates_name_nothing_that_does_input_or_output() {
    let mut looked_at = 0;
    for package in [
        "diagnostic",
        "translator",
        "kinematics",
        "estimator",
        "pid",
        "autopilot",
        "ardrone-link",
        "mavlink-vehicle",
        "mission-agent",
        "mock-drone",
    ] {
        for path in sources(&Path::new("..").join(package).join("src")) {
            // Behind features that the core does not enable.
            let feature = ["net", "server", "command_line", "main.rs"];
            if path.components().any(|part| feature.iter().any(|name| part.as_os_str() == *name)) {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
            assert_eq!(impure_word(code), None, "{}", path.display());
            looked_at += 1;
        }
    }
    assert!(looked_at > 40, "{looked_at}");
}

/// The pilot's output goes through one file, which makes foreign text printable.
#[test]
fn standard_streams_are_written_to_in_one_file() {
    let mut folders = vec![PathBuf::from("../ardrone-pilot/src")];
    let mut writers = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                let writes = ["stdout().lock()", "stderr().lock()", "write!(std", "writeln!(std"];
                if writes.iter().any(|write| text.contains(write)) {
                    writers.push(path);
                }
            }
        }
    }
    assert_eq!(writers, [Path::new("../ardrone-pilot/src/cli/terminal.rs")]);
}

/// What a program does belongs into its library, where tests reach it.
#[test]
fn programs_only_start_their_library() {
    let mut programs = 0;
    for (package, _) in MAY_USE {
        let Ok(text) = std::fs::read_to_string(format!("../{package}/src/main.rs")) else {
            continue;
        };
        assert!(text.lines().count() <= 40, "{package}");
        programs += 1;
    }
    assert_eq!(programs, 4);
}

/// `unsafe` is used in the bindings of agents only, which one file of each of two crates includes.
#[test]
fn unsafe_code_is_at_the_boundary_to_c() {
    let forbidding = [
        "diagnostic/src/lib.rs",
        "translator/src/lib.rs",
        "asl2c/src/lib.rs",
        "asl2c/src/main.rs",
        "ardrone-link/src/lib.rs",
        "kinematics/src/lib.rs",
        "estimator/src/lib.rs",
        "mavlink-vehicle/src/lib.rs",
        "pid/src/lib.rs",
        "mock-drone/src/lib.rs",
        "mock-drone/src/main.rs",
        "ardrone-pilot/src/lib.rs",
        "ardrone-pilot/src/main.rs",
        "tests/src/lib.rs",
    ];
    for file in forbidding {
        let text = std::fs::read_to_string(format!("../{file}")).unwrap();
        assert!(text.contains("#![forbid(unsafe_code)]"), "{file}");
    }
    for (folder, bindings) in [("autopilot", "agent.rs"), ("mission-agent", "built_in.rs")] {
        let library = std::fs::read_to_string(format!("../{folder}/src/lib.rs")).unwrap();
        assert!(library.contains("#![deny(unsafe_code)]"), "{folder}");
        for path in sources(&Path::new("..").join(folder).join("src")) {
            let allows = std::fs::read_to_string(&path).unwrap().contains("    unsafe_code,\n");
            assert_eq!(allows, path.ends_with(bindings), "{}", path.display());
        }
    }
}

/// Each state that may follow another is drawn, and nothing else.
#[test]
fn the_drawing_of_the_vehicles_states_is_what_they_are() {
    let text = std::fs::read_to_string("../ARCHITECTURE.md").unwrap();
    let drawing = text.split("```").find(|block| block.contains("[*] --> connecting")).unwrap();
    let drawn: BTreeSet<(&str, &str)> = drawing
        .lines()
        .filter_map(|line| line.trim().split_once(':')?.0.split_once(" --> "))
        .collect();
    let listed = Phase::ALL
        .into_iter()
        .flat_map(|phase| phase.next().iter().map(move |next| (phase.name(), next.name())));
    assert_eq!(drawn, listed.collect());
}
