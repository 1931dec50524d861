//! Arguments of MAVLink.

use std::fmt;
use std::fs::File;
use std::io::Read as _;
use std::net::{SocketAddr, ToSocketAddrs as _};
use std::path::{Path, PathBuf};

use autopilot::vehicle::VehicleConfig;
use clap::{Args, ValueEnum};
use mavlink_vehicle::{Autopilot, Config, Key, KeyError, Origin};

use crate::mavlink::MOST_REMOTES;

/// Ground stations and programs listen there.
const USUAL_REMOTES: &str = "udp:127.0.0.1:14550,udp:127.0.0.1:14540";
/// Largest file of a key.
const LONGEST_KEY_BYTES: u64 = 4096;
/// The law's own limit may be beyond what the drone reaches.
const FASTEST_M_S: f64 = 2.2;

/// Arguments of a flight that concern MAVLink.
#[derive(Debug, Args)]
pub(super) struct MavlinkArguments {
    /// Be a MAVLink vehicle: speak to these ground stations and programs, and take their orders; without a value to
    /// udp:127.0.0.1:14550 and udp:127.0.0.1:14540
    #[arg(
        long,
        value_name = "udp:HOST:PORT,..",
        num_args = 0..=1,
        default_missing_value = USUAL_REMOTES,
        value_parser = remotes
    )]
    mavlink: Option<Remotes>,
    /// Show MAVLink's clients the flight, and refuse their orders
    #[arg(long, requires = "mavlink")]
    mavlink_view_only: bool,
    /// Whose autopilot to claim to be [default: generic]
    #[arg(long, value_name = "AUTOPILOT", requires = "mavlink")]
    mavlink_as: Option<Claim>,
    /// What the start of the flight is called on the globe: degrees, metres above the sea, degrees of the nose from north
    #[arg(
        long,
        value_name = "LAT,LON[,ALT[,HEADING]]",
        requires = "mavlink",
        allow_hyphen_values = true,
        value_parser = origin
    )]
    mavlink_origin: Option<Origin>,
    /// Claim to have a GPS, for which many programs wait
    #[arg(long, requires = "mavlink")]
    mavlink_pretend_gps: bool,
    /// Sign, and hear only who signs, with the key in this file: a pass-phrase, or 64 hexadecimal digits
    #[arg(long, value_name = "FILE", requires = "mavlink")]
    mavlink_key: Option<PathBuf>,
    /// Speak to other machines without a key: whoever reaches this one can fly the drone
    #[arg(long, requires = "mavlink")]
    mavlink_unsigned: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Claim {
    /// None that is known
    Generic,
    /// PX4, for QGroundControl's own buttons
    Px4,
}

/// The addresses of an argument.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Remotes(Vec<SocketAddr>);

/// Why MAVLink cannot be had as it is asked for.
#[derive(Debug, thiserror::Error)]
pub(super) enum MavlinkArgumentError {
    #[error(
        "udp:{0} is not on this machine, and whoever is in that network could fly the drone: give a key as \
         --mavlink-key FILE, or --mavlink-unsigned if everybody may"
    )]
    Unsigned(SocketAddr),
    #[error("cannot read the MAVLink key {path}")]
    ReadKey { path: String, source: std::io::Error },
    #[error("the MAVLink key {path} is not a text of at most {LONGEST_KEY_BYTES} bytes")]
    NoText { path: String },
    #[error("the MAVLink key {path}")]
    Key { path: String, source: KeyError },
}

impl MavlinkArgumentError {
    pub(super) fn exit_status(&self) -> u8 {
        match self {
            Self::Unsigned(_) => 2,
            Self::ReadKey { .. } | Self::NoText { .. } | Self::Key { .. } => 20,
        }
    }
}

/// MAVLink as it was asked for. Its `Display` is for people.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wanted {
    pub(super) remotes: Vec<SocketAddr>,
    pub(super) config: Config,
    /// Who can fly the drone, if that is more than this machine.
    pub(super) warning: Option<&'static str>,
}

impl MavlinkArguments {
    pub(super) fn is_given(&self) -> bool {
        self.mavlink.is_some()
    }

    /// What is asked for, if anything.
    pub(super) fn wanted(
        &self,
        vehicle: &VehicleConfig,
    ) -> Result<Option<Wanted>, MavlinkArgumentError> {
        let Some(Remotes(remotes)) = &self.mavlink else { return Ok(None) };
        let key = self.mavlink_key.as_deref().map(read_key).transpose()?;
        let elsewhere = remotes.iter().find(|remote| !remote.ip().is_loopback());
        let warning = match elsewhere {
            Some(remote) if key.is_none() => {
                if !self.mavlink_unsigned {
                    return Err(MavlinkArgumentError::Unsigned(*remote));
                }
                Some(if self.mavlink_view_only {
                    "MAVLink without signatures: whoever reaches this machine can watch the drone"
                } else {
                    "MAVLink without signatures: whoever reaches this machine can fly the drone"
                })
            }
            _ => None,
        };
        let config = Config {
            system: vehicle.system,
            autopilot: match self.mavlink_as {
                None | Some(Claim::Generic) => Autopilot::Generic,
                Some(Claim::Px4) => Autopilot::Px4,
            },
            origin: self.mavlink_origin.unwrap_or_default(),
            limits: vehicle.limits,
            max_speed_m_s: vehicle.cascade.speed_max_m_s.min(FASTEST_M_S),
            station: vehicle.station,
            view_only: self.mavlink_view_only,
            pretend_gps: self.mavlink_pretend_gps,
            key,
            ..Config::default()
        };
        Ok(Some(Wanted { remotes: remotes.clone(), config, warning }))
    }
}

impl fmt::Display for Wanted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("MAVLink: speaking to")?;
        for (index, remote) in self.remotes.iter().enumerate() {
            write!(f, "{} udp:{remote}", if index == 0 { "" } else { "," })?;
        }
        f.write_str(if self.config.view_only { "; view only" } else { "" })?;
        f.write_str(if self.config.key.is_some() { "; signed" } else { "" })
    }
}

/// Parses `udp:HOST:PORT` and more of them behind commas.
fn remotes(text: &str) -> Result<Remotes, String> {
    let mut remotes = Vec::new();
    for part in text.split(',') {
        let remote = remote(part.trim())?;
        if !remotes.contains(&remote) {
            remotes.push(remote);
        }
    }
    if remotes.len() > MOST_REMOTES {
        return Err(format!("at most {MOST_REMOTES} addresses can be spoken to"));
    }
    Ok(Remotes(remotes))
}

fn remote(text: &str) -> Result<SocketAddr, String> {
    let wanted = |why: &str| format!("{why}; expected udp:HOST:PORT, as udp:127.0.0.1:14550");
    let address = text.strip_prefix("udp:").ok_or_else(|| wanted(&format!("`{text}`")))?;
    let mut found =
        address.to_socket_addrs().map_err(|error| wanted(&format!("`{text}`: {error}")))?;
    let found = found
        .find(SocketAddr::is_ipv4)
        .ok_or_else(|| wanted(&format!("`{text}` has no IPv4 address")))?;
    let is_one = match found {
        SocketAddr::V4(address) => {
            let ip = address.ip();
            address.port() != 0 && !ip.is_unspecified() && !ip.is_broadcast() && !ip.is_multicast()
        }
        SocketAddr::V6(_) => false,
    };
    if is_one { Ok(found) } else { Err(wanted(&format!("nobody can be at `{text}`"))) }
}

/// Parses `LAT,LON[,ALT[,HEADING]]`.
fn origin(text: &str) -> Result<Origin, String> {
    let wanted = "expected LAT,LON[,ALT[,HEADING]], as 47.397742,8.545594,488,90";
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    let usual = Origin::default();
    let numbers = numbers.map_err(|error| format!("{error}; {wanted}"))?;
    let (latitude_deg, longitude_deg, altitude_m, heading_deg) = match *numbers {
        [latitude, longitude] => (latitude, longitude, usual.altitude_m, usual.heading_deg),
        [latitude, longitude, altitude] => (latitude, longitude, altitude, usual.heading_deg),
        [latitude, longitude, altitude, heading] => (latitude, longitude, altitude, heading),
        _ => return Err(wanted.to_owned()),
    };
    let origin = Origin { latitude_deg, longitude_deg, altitude_m, heading_deg };
    origin.checked().map_err(|error| error.to_string())
}

/// The key in a file. No error shows what the file holds.
fn read_key(path: &Path) -> Result<Key, MavlinkArgumentError> {
    let name = || path.display().to_string();
    let mut bytes = Vec::new();
    File::open(path)
        // One byte more than allowed, so that a longer file is noticed.
        .and_then(|file| file.take(LONGEST_KEY_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|source| MavlinkArgumentError::ReadKey { path: name(), source })?;
    let is_long = bytes.len() as u64 > LONGEST_KEY_BYTES;
    let text = String::from_utf8(bytes).ok().filter(|_| !is_long);
    let text = text.ok_or_else(|| MavlinkArgumentError::NoText { path: name() })?;
    let text = text.trim();
    let digits = text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let key = if digits { Key::from_hexadecimal(text) } else { Key::from_pass_phrase(text) };
    key.map_err(|source| MavlinkArgumentError::Key { path: name(), source })
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;

    #[derive(Debug, clap::Parser)]
    struct Line {
        #[command(flatten)]
        arguments: MavlinkArguments,
    }

    fn parsed(words: &[&str]) -> Result<MavlinkArguments, String> {
        let line = Line::try_parse_from(["pilot"].iter().chain(words));
        line.map(|line| line.arguments).map_err(|error| error.to_string())
    }

    fn wanted(words: &[&str]) -> Result<Wanted, MavlinkArgumentError> {
        Ok(parsed(words).unwrap().wanted(&VehicleConfig::default())?.unwrap())
    }

    #[test]
    fn it_speaks_to_where_stations_listen() {
        let nothing = parsed(&[]).unwrap();
        assert!(!nothing.is_given());
        assert_eq!(nothing.wanted(&VehicleConfig::default()).unwrap(), None);
        let usual = wanted(&["--mavlink"]).unwrap();
        let line = "MAVLink: speaking to udp:127.0.0.1:14550, udp:127.0.0.1:14540";
        assert_eq!((usual.to_string().as_str(), usual.warning), (line, None));
        let limits = VehicleConfig::default().limits;
        assert_eq!(usual.config, Config { limits, max_speed_m_s: 2.2, ..Config::default() });
        let two = wanted(&["--mavlink", "udp:127.0.0.1:1, udp:localhost:2,udp:127.0.0.1:1"]);
        let two = two.unwrap().remotes;
        assert_eq!(two, ["127.0.0.1:1", "127.0.0.1:2"].map(|text| text.parse().unwrap()));
    }

    #[test]
    fn what_is_no_address_is_said() {
        for text in [
            "",
            "127.0.0.1:14550",
            "udp:",
            "udp:127.0.0.1",
            "udp:127.0.0.1:0",
            "udp:127.0.0.1:99999",
            "udp:0.0.0.0:14550",
            "udp:224.0.0.1:14550",
            "udp:[::1]:14550",
            "tcp:127.0.0.1:5760",
            "udp:127.0.0.1:14550,",
            "udp:no such host:14550",
        ] {
            let error = parsed(&["--mavlink", text]).unwrap_err();
            assert!(error.contains("expected udp:HOST:PORT"), "{text}: {error}");
        }
        let many = (1..=5).map(|port| format!("udp:127.0.0.1:{port}")).collect::<Vec<_>>();
        assert!(parsed(&["--mavlink", &many.join(",")]).unwrap_err().contains("at most 4"));
    }

    #[test]
    fn its_options_need_it() {
        for words in [
            &["--mavlink-view-only"][..],
            &["--mavlink-as", "px4"],
            &["--mavlink-origin", "1,2"],
            &["--mavlink-pretend-gps"],
            &["--mavlink-key", "k"],
            &["--mavlink-unsigned"],
        ] {
            assert!(parsed(words).unwrap_err().contains("--mavlink "), "{words:?}");
            assert!(parsed(&[&["--mavlink"], words].concat()).is_ok(), "{words:?}");
        }
        let words = ["--mavlink", "--mavlink-as", "px4", "--mavlink-pretend-gps"];
        let px4 = wanted(&words).unwrap().config;
        assert_eq!((px4.autopilot, px4.pretend_gps), (Autopilot::Px4, true));
    }

    #[test]
    fn an_origin_is_a_place_on_earth() {
        let place = |text| parsed(&["--mavlink", "--mavlink-origin", text]);
        let origin = |text| place(text).unwrap().mavlink_origin.unwrap();
        let all = Origin {
            latitude_deg: -33.9,
            longitude_deg: -70.5,
            altitude_m: -10.0,
            heading_deg: -90.0,
        };
        assert_eq!(origin("-33.9,-70.5,-10,-90"), all);
        assert_eq!(origin("-33.9, -70.5,-10"), Origin { heading_deg: 0.0, ..all });
        let usual = Origin { altitude_m: 488.0, heading_deg: 0.0, ..all };
        assert_eq!(origin("-33.9,-70.5"), usual);
        for text in ["", "1", "1,2,3,4,5", "north,2", "1,,2"] {
            let error = place(text).unwrap_err();
            assert!(error.contains("expected LAT,LON"), "{text}: {error}");
        }
        for (text, why) in [("90,0", "latitude"), ("0,181", "longitude"), ("nan,0", "latitude")] {
            let error = place(text).unwrap_err();
            assert!(error.contains(why), "{text}: {error}");
        }
    }

    #[test]
    fn other_machines_need_a_key_or_a_word() {
        let elsewhere = ["--mavlink", "udp:127.0.0.1:1,udp:192.0.2.1:14550"];
        let refused = wanted(&elsewhere).unwrap_err();
        assert_eq!(refused.exit_status(), 2);
        for word in ["udp:192.0.2.1:14550", "--mavlink-key", "--mavlink-unsigned"] {
            assert!(refused.to_string().contains(word), "{refused}");
        }
        let unsigned = wanted(&[&elsewhere[..], &["--mavlink-unsigned"]].concat()).unwrap();
        assert!(unsigned.warning.unwrap().contains("can fly"));
        let view = ["--mavlink-unsigned", "--mavlink-view-only"];
        let view = wanted(&[&elsewhere[..], &view].concat()).unwrap();
        assert!(view.warning.unwrap().contains("can watch"));
        assert!(view.to_string().ends_with("udp:192.0.2.1:14550; view only"), "{view}");
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "open sesame\n").unwrap();
        let key = file.path().to_str().unwrap();
        let signed = wanted(&[&elsewhere[..], &["--mavlink-key", key]].concat()).unwrap();
        assert_eq!(signed.warning, None);
        assert!(signed.to_string().ends_with("; signed"), "{signed}");
    }

    #[test]
    fn a_key_is_a_phrase_or_digits() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let key = |content: &[u8]| {
            std::fs::write(file.path(), content).unwrap();
            read_key(file.path())
        };
        let phrase = Key::from_pass_phrase("open sesame").unwrap();
        assert_eq!(key(b" \topen sesame\r\n").unwrap(), phrase);
        let digits = "00112233445566778899aabbccddeeff".repeat(2);
        assert_eq!(
            key(digits.to_uppercase().as_bytes()).unwrap(),
            Key::from_hexadecimal(&digits).unwrap()
        );
        let short = &digits[1..];
        assert_eq!(key(short.as_bytes()).unwrap(), Key::from_pass_phrase(short).unwrap());
        let secret = b"\xffsecret".as_slice();
        for content in [b"".as_slice(), b"\n", secret, &b"secret".repeat(1000)] {
            let error = key(content).unwrap_err();
            let text = format!("{error} {error:?}");
            assert!(text.contains(file.path().to_str().unwrap()), "{text}");
            assert!(!text.contains("secret"), "{text}");
            assert_eq!(error.exit_status(), 20);
        }
        let error = read_key(Path::new("/nowhere/key")).unwrap_err();
        assert!(error.to_string().contains("/nowhere/key"));
        assert_eq!(error.exit_status(), 20);
    }
}
