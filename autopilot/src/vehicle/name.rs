//! Names of vehicles.

use std::fmt;
use std::str::FromStr;

use arrayvec::ArrayString;
use serde::{Deserialize, Serialize};

/// Longest name, in bytes.
const LONGEST: usize = 16;

/// Name of a vehicle, by which those of a program are told apart: 1 to 16 letters a to z, digits and hyphens, with a letter
/// first, so that it can be a part of the name of a file.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct VehicleName(ArrayString<LONGEST>);

/// A text is no name of a vehicle.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{}` is no name of a vehicle: expected 1 to {LONGEST} letters a to z, digits and hyphens, with a letter first",
    .0.escape_debug()
)]
pub struct NoVehicleName(String);

impl VehicleName {
    /// The name as text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl Default for VehicleName {
    fn default() -> Self {
        Self(ArrayString::from("ardrone").expect("it is shorter than the longest"))
    }
}

impl FromStr for VehicleName {
    type Err = NoVehicleName;

    fn from_str(text: &str) -> Result<Self, NoVehicleName> {
        let may_follow = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let is_name =
            text.starts_with(|c: char| c.is_ascii_lowercase()) && text.chars().all(may_follow);
        ArrayString::from(text)
            .ok()
            .filter(|_| is_name)
            .map(Self)
            .ok_or_else(|| NoVehicleName(text.to_owned()))
    }
}

impl TryFrom<String> for VehicleName {
    type Error = NoVehicleName;

    fn try_from(text: String) -> Result<Self, NoVehicleName> {
        text.parse()
    }
}

impl From<VehicleName> for String {
    fn from(name: VehicleName) -> Self {
        name.as_str().to_owned()
    }
}

impl fmt::Display for VehicleName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl fmt::Debug for VehicleName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.as_str(), f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_can_be_a_part_of_the_name_of_a_file() {
        for name in ["a", "ardrone", "wing-2", "abcdefghijklmnop"] {
            assert_eq!(name.parse::<VehicleName>().unwrap().as_str(), name);
        }
        for text in ["", "2", "-a", "A", "a b", "a/b", "..", "a_b", "\u{e9}", "abcdefghijklmnopq"] {
            assert_eq!(text.parse::<VehicleName>(), Err(NoVehicleName(text.to_owned())), "{text}");
        }
        assert_eq!(VehicleName::default().as_str(), "ardrone");
    }
}
