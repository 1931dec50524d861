//! Who may know whom.

use std::collections::BTreeMap;

/// The packages of the workspace and what each may depend on.
const MAY_USE: [(&str, &[&str]); 9] = [
    ("diagnostic", &[]),
    ("translator", &["diagnostic"]),
    ("ardrone-link", &[]),
    ("estimator", &[]),
    ("pid", &[]),
    ("mock-drone", &["ardrone-link", "diagnostic"]),
    ("autopilot", &["ardrone-link", "diagnostic", "estimator", "mock-drone", "pid", "translator"]),
    ("system-tests", &["ardrone-link", "autopilot", "mock-drone"]),
    ("xtask", &["autopilot", "mock-drone", "system-tests", "translator"]),
];

#[test]
fn dependencies_point_one_way() {
    let mut found = BTreeMap::new();
    for (folder, name) in [
        ("diagnostic", "diagnostic"),
        ("translator", "translator"),
        ("ardrone-link", "ardrone-link"),
        ("estimator", "estimator"),
        ("pid", "pid"),
        ("mock-drone", "mock-drone"),
        ("autopilot", "autopilot"),
        ("tests", "system-tests"),
        ("xtask", "xtask"),
    ] {
        let manifest = std::fs::read_to_string(format!("../{folder}/Cargo.toml")).unwrap();
        let uses: Vec<String> = manifest
            .lines()
            .filter_map(|line| line.split(['.', ' ']).next())
            .filter(|word| MAY_USE.iter().any(|(package, _)| package == word))
            .map(str::to_owned)
            .collect();
        found.insert(name, uses);
    }
    for (name, allowed) in MAY_USE {
        for used in &found[name] {
            assert!(allowed.contains(&used.as_str()), "{name} uses {used}");
        }
    }
}

/// What the pilot says goes one way, on which foreign text is made harmless.
#[test]
fn standard_streams_are_written_to_in_one_file() {
    let mut folders = vec![std::path::PathBuf::from("../autopilot/src")];
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
    assert_eq!(writers, [std::path::Path::new("../autopilot/src/cli/terminal.rs")]);
}

/// `unsafe` stands in one file, the boundary to C.
#[test]
fn unsafe_code_is_in_one_file() {
    let forbidding = [
        "diagnostic/src/lib.rs",
        "translator/src/lib.rs",
        "translator/src/main.rs",
        "ardrone-link/src/lib.rs",
        "estimator/src/lib.rs",
        "pid/src/lib.rs",
        "mock-drone/src/lib.rs",
        "mock-drone/src/main.rs",
        "autopilot/src/main.rs",
        "tests/src/lib.rs",
    ];
    for file in forbidding {
        let text = std::fs::read_to_string(format!("../{file}")).unwrap();
        assert!(text.contains("#![forbid(unsafe_code)]"), "{file}");
    }
    let autopilot = std::fs::read_to_string("../autopilot/src/lib.rs").unwrap();
    assert!(autopilot.contains("#![deny(unsafe_code)]"));
}
