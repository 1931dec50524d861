//! The vehicles of a fleet, which of them are flown here, and what the programs that fly them must agree on.

use std::fmt::Write as _;

use autopilot::vehicle::{Start, VehicleName};
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// The beginning of the SHA-256 of what must agree: the fleet's name, and the names, numbers, places and headings of the starts
/// of all vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Digest(pub [u8; 8]);

/// Who is in a fleet.
#[derive(Debug, Clone, PartialEq)]
pub struct Roster {
    /// The fleet's name, a part of the keys.
    pub fleet: VehicleName,
    /// In the order of the file.
    pub vehicles: Vec<Entry>,
    /// What must agree.
    pub digest: Digest,
}

/// One vehicle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// Its name.
    pub name: VehicleName,
    /// The number of its MAVLink system.
    pub system: u8,
    /// Whether it is flown here.
    pub is_here: bool,
}

/// A vehicle is to be flown here that is not in the fleet.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no vehicle {vehicle} in this fleet: it has {}", .names.join(", "))]
pub struct UnknownVehicle {
    /// Its name.
    pub vehicle: VehicleName,
    /// The names of those that are.
    pub names: Vec<String>,
}

impl Roster {
    /// The fleet with its vehicles (name, MAVLink system, start), of which these are flown here; all, if none is named.
    ///
    /// # Errors
    /// [`UnknownVehicle`] if one of those is not in the fleet.
    pub fn new(
        fleet: VehicleName,
        vehicles: impl IntoIterator<Item = (VehicleName, u8, Start)>,
        here: &[VehicleName],
    ) -> Result<Self, UnknownVehicle> {
        let mut text = format!("{fleet}\n");
        let mut entries = Vec::new();
        for (name, system, start) in vehicles {
            let [right_mm, forward_mm] = [start.place_m.x, start.place_m.y].map(thousandths);
            // Writing to a string cannot fail.
            _ = writeln!(
                text,
                "{name} {system} {right_mm} {forward_mm} {}",
                thousandths(start.heading_deg)
            );
            entries.push(Entry { name, system, is_here: here.is_empty() || here.contains(&name) });
        }
        let is_unknown = |name: &&VehicleName| !entries.iter().any(|entry| entry.name == **name);
        if let Some(vehicle) = here.iter().find(is_unknown) {
            let names = entries.iter().map(|entry| entry.name.to_string()).collect();
            return Err(UnknownVehicle { vehicle: *vehicle, names });
        }
        let mut digest = [0; 8];
        digest.copy_from_slice(&Sha256::digest(text)[..8]);
        Ok(Self { fleet, vehicles: entries, digest: Digest(digest) })
    }

    /// A vehicle's place in the fleet.
    pub fn place(&self, name: VehicleName) -> Option<usize> {
        self.vehicles.iter().position(|entry| entry.name == name)
    }

    /// The places of those that are flown here, or elsewhere.
    pub fn places(&self, here: bool) -> impl Iterator<Item = usize> + '_ {
        let is_meant = move |(_, entry): &(usize, &Entry)| entry.is_here == here;
        self.vehicles.iter().enumerate().filter(is_meant).map(|(place, _)| place)
    }

    /// The key of a vehicle's state.
    pub fn state_key(&self, vehicle: &str) -> String {
        format!("ardrone/{}/{vehicle}/state", self.fleet)
    }

    /// The key of what one vehicle's agent says to another's.
    pub fn line_key(&self, from: &str, to: &str) -> String {
        format!("ardrone/{}/{from}/agent/{to}", self.fleet)
    }

    /// Whose state has this key.
    pub fn of_state_key(&self, key: &str) -> Option<VehicleName> {
        let mut parts = key.split('/');
        let vehicle = match (parts.next(), parts.next(), parts.next(), parts.next(), parts.next()) {
            (Some("ardrone"), Some(fleet), Some(vehicle), Some("state"), None)
                if fleet == self.fleet.as_str() =>
            {
                vehicle
            }
            _ => return None,
        };
        vehicle.parse().ok()
    }

    /// Whose line to whom has this key.
    pub fn of_line_key(&self, key: &str) -> Option<[VehicleName; 2]> {
        let parts: Vec<&str> = key.split('/').take(6).collect();
        let [root, fleet, from, agent, to] = *parts else { return None };
        let is_ours = root == "ardrone" && fleet == self.fleet.as_str() && agent == "agent";
        let names = is_ours.then_some([from, to])?;
        let [from, to] = names.map(|name| name.parse().ok());
        Some([from?, to?])
    }
}

/// Millimetres, or thousandths of a degree. A start is within 200 m.
#[expect(clippy::cast_possible_truncation, reason = "the settings limit it to some hundred metres")]
fn thousandths(number: f64) -> i64 {
    (number * 1000.0).round() as i64
}

impl TryFrom<String> for Digest {
    type Error = &'static str;

    fn try_from(text: String) -> Result<Self, Self::Error> {
        let is_plain = text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let number = u64::from_str_radix(&text, 16).ok().filter(|_| is_plain);
        number.map(|number| Self(number.to_be_bytes())).ok_or("a digest has 16 hexadecimal digits")
    }
}

impl From<Digest> for String {
    fn from(Digest(bytes): Digest) -> Self {
        format!("{:016x}", u64::from_be_bytes(bytes))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use nalgebra::Vector2;

    use super::*;

    fn start(x_m: f64, heading_deg: f64) -> Start {
        Start {
            place_m: Vector2::new(x_m, 0.0),
            heading_deg,
            uncertainty_m: 0.05,
            ..Start::default()
        }
    }

    pub(in crate::network) fn two(here: &[&str]) -> Roster {
        let vehicles = [("left", 1, start(-2.5, 0.0)), ("right", 2, start(2.5, 0.0))]
            .map(|(name, system, start)| (name.parse().unwrap(), system, start));
        let here: Vec<VehicleName> = here.iter().map(|name| name.parse().unwrap()).collect();
        Roster::new("two".parse().unwrap(), vehicles, &here).unwrap()
    }

    /// As anybody can compute it: `printf 'two\nleft 1 -2500 0 0\nright 2 2500 0 0\n' | sha256sum | cut -c -16`
    #[test]
    fn the_digest_is_of_what_must_agree_and_of_nothing_else() {
        let digest = |name: &str, fleet: &str, system, x_m, heading_deg| {
            let vehicles = [(name.parse().unwrap(), system, start(x_m, heading_deg))];
            Roster::new(fleet.parse().unwrap(), vehicles, &[]).unwrap().digest
        };
        let usual = digest("a", "f", 1, 0.5, 10.0);
        assert_eq!(usual, digest("a", "f", 1, 0.500_000_1, 10.0));
        for other in [
            digest("b", "f", 1, 0.5, 10.0),
            digest("a", "g", 1, 0.5, 10.0),
            digest("a", "f", 2, 0.5, 10.0),
            digest("a", "f", 1, 0.51, 10.0),
            digest("a", "f", 1, 0.5, 10.01),
        ] {
            assert_ne!(usual, other);
        }
        assert_eq!(two(&[]).digest, two(&["left"]).digest);
        assert_eq!(String::from(two(&[]).digest), "aa010c2e795a3b31");
    }

    #[test]
    fn keys_are_read_as_they_are_written_and_others_are_not() {
        let roster = two(&["left"]);
        assert_eq!(roster.state_key("left"), "ardrone/two/left/state");
        assert_eq!(roster.of_state_key("ardrone/two/left/state"), "left".parse().ok());
        let line = roster.line_key("right", "left");
        assert_eq!(line, "ardrone/two/right/agent/left");
        assert_eq!(roster.of_line_key(&line).map(|names| names.map(String::from)), {
            Some(["right".to_owned(), "left".to_owned()])
        });
        for key in [
            "",
            "/",
            "ardrone/two/left",
            "ardrone/two/left/state/",
            "ardrone/other/left/state",
            "ardrone/two/LEFT/state",
            "x/two/left/state",
            "ardrone/two/left/agent",
        ] {
            assert_eq!((roster.of_state_key(key), roster.of_line_key(key)), (None, None), "{key}");
        }
        assert_eq!(roster.of_line_key("ardrone/two/right/agent/left/x"), None);
    }

    #[test]
    fn who_is_flown_here_is_in_the_fleet() {
        assert_eq!(two(&[]).places(true).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(two(&["right"]).places(true).collect::<Vec<_>>(), [1]);
        assert_eq!(two(&["right"]).places(false).collect::<Vec<_>>(), [0]);
        let vehicles = [("left".parse().unwrap(), 1, start(0.0, 0.0))];
        let error = Roster::new("two".parse().unwrap(), vehicles, &["up".parse().unwrap()]);
        let said = error.unwrap_err().to_string();
        assert_eq!(said, "there is no vehicle up in this fleet: it has left");
    }
}
