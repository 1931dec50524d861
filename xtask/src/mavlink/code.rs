//! The dialect's code, as it should be checked in.

use std::path::Path;
use std::process::Command;

use mavlink_bindgen::XmlDefinitions;

use super::MavlinkError;
use crate::files::{cannot, read, root, write};

/// Generates it.
pub(super) fn generate() -> Result<String, MavlinkError> {
    let work = tempfile::tempdir().map_err(cannot("use", &std::env::temp_dir()))?;
    let xml = root().join("mavlink-vehicle/dialect/pilot.xml");
    mavlink_bindgen::generate(XmlDefinitions::Files(vec![xml]), work.path())?;
    let path = work.path().join("pilot.rs");
    let text = without_features(&read(&path)?);
    write(&path, &text)?;
    // As `cargo fmt` does it, or the two would disagree.
    let done = Command::new("rustfmt")
        .args(["--edition", "2024", "--config-path"])
        .arg(root().join("rustfmt.toml"))
        .arg(&path)
        .output()
        .map_err(cannot("run", Path::new("rustfmt")))?;
    if !done.status.success() {
        let said = String::from_utf8_lossy(&done.stderr);
        return Err(MavlinkError::Format(said.lines().next().unwrap_or_default().to_owned()));
    }
    Ok(with_empty_masks(&read(&path)?))
}

/// Leaves out what is generated for features that the crate does not have; the compiler would warn of each.
fn without_features(tokens: &str) -> String {
    let mut kept = String::new();
    let mut rest = tokens;
    while let Some(at) = rest.find("# [cfg") {
        let (before, attribute) = rest.split_at(at);
        kept.push_str(before);
        let (attribute, behind) = attribute.split_at(end_of(attribute, ']'));
        // `cfg` stands before an item, which goes with it; `cfg_attr` is on its own.
        rest = if attribute.starts_with("# [cfg_attr") {
            behind
        } else {
            let last = if behind.trim_start().starts_with("use ") { ';' } else { '}' };
            behind.split_at(end_of(behind, last)).1
        };
    }
    kept + rest
}

/// The place behind the first such token that is outside of brackets, or that closes the outermost one.
fn end_of(tokens: &str, last: char) -> usize {
    let mut depth = 0_usize;
    for (at, token) in tokens.char_indices() {
        match token {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 && token == last {
            return at + 1;
        }
    }
    tokens.len()
}

/// The generator takes the first bit as default: a heartbeat would say "armed" if nothing else was said.
fn with_empty_masks(code: &str) -> String {
    let name = |line: &str| -> Option<String> {
        let line = line.strip_prefix("bitflags! {")?;
        let (_, name) = line.split_once(" pub struct ")?;
        name.split_once(" :").map(|(name, _)| name.to_owned())
    };
    let masks: Vec<String> =
        code.lines().filter_map(name).map(|name| format!("impl {name} {{")).collect();
    let mut of_mask = false;
    let mut changed = String::new();
    for line in code.lines() {
        let is_default = of_mask && line.starts_with("    pub const DEFAULT: Self =");
        changed.push_str(if is_default {
            "    pub const DEFAULT: Self = Self::empty();"
        } else {
            line
        });
        changed.push('\n');
        of_mask = masks.iter().any(|mask| mask == line);
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_belongs_to_features_is_left_out() {
        let tokens = "use a ; # [cfg (feature = \"x\")] use b :: { c } ; # [cfg_attr (feature = \"x\" , derive (B))] struct C { \
                      # [cfg (feature = \"x\")] fn d (e : [u8 ; 2]) -> F { g { } } } h";
        let kept = without_features(tokens);
        assert_eq!(kept.split_whitespace().collect::<Vec<_>>().join(" "), "use a ; struct C { } h");
    }

    #[test]
    fn masks_are_empty_unless_told_otherwise() {
        let code = "bitflags! { # [doc = \"d\"] pub struct A : u8 { const B = 1 ; } }\nimpl A {\n    \
                    pub const DEFAULT: Self = Self::B;\n}\nimpl C {\n    pub const DEFAULT: Self = Self::D;\n}\n";
        let changed = with_empty_masks(code);
        assert_eq!(changed, code.replace("Self::B", "Self::empty()"));
    }
}
