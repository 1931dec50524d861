//! `FLEET.toml` as it is written.

use std::path::PathBuf;

use ardrone_link::{AT_PORT, CONTROL_PORT, DRONE_HOST, DroneAddress, NAVDATA_PORT, VIDEO_PORT};
use autopilot::vehicle::VehicleName;
use diagnostic::Span;
use serde::Deserialize;
use toml::Spanned;

use crate::settings::{Fence, SurveyedStart, UltrasoundFrequency, Version};

/// The version of the file of a fleet that is read.
pub(super) const VERSION: u32 = 1;

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Written {
    #[serde(rename = "version", default)]
    _version: Version<VERSION>,
    #[serde(default)]
    pub(super) fleet: Header,
    /// Read again with the settings; here for its errors with their places.
    #[serde(rename = "fence")]
    _fence: Option<Fence>,
    #[serde(default)]
    pub(super) vehicle: Vec<Vehicle>,
}

/// What all have in common.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Header {
    pub(super) name: Option<VehicleName>,
    pub(super) separation_m: Option<f64>,
    /// A `pilot.toml` for all.
    pub(super) config: Option<Spanned<PathBuf>>,
}

/// One vehicle.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Vehicle {
    pub(super) name: Spanned<VehicleName>,
    pub(super) start: Spanned<SurveyedStart>,
    pub(super) plan: Option<Spanned<PathBuf>>,
    /// The agent that gives its orders, in place of a plan.
    pub(super) agent: Option<Spanned<String>>,
    /// Of which the agent may ask: right, forward, height, heading.
    #[serde(default)]
    pub(super) places: Vec<Spanned<[f64; 4]>>,
    /// Charge of a simulated drone at the start, in percent.
    pub(super) mock_battery: Option<Spanned<f64>>,
    /// The number of its MAVLink system; otherwise its place in the file.
    pub(super) system: Option<u8>,
    #[serde(default)]
    pub(super) tags: bool,
    pub(super) ultrasound: Option<UltrasoundFrequency>,
    drone: Option<String>,
    at_port: Option<u16>,
    navdata_port: Option<u16>,
    control_port: Option<u16>,
    #[serde(default = "usual_video_port")]
    pub(super) video_port: u16,
}

fn usual_video_port() -> u16 {
    VIDEO_PORT
}

/// Where the value of a setting stands, or at least its section; what is not there is at the begin.
pub(super) fn place_of(text: &str, section: &str, name: &str) -> Span {
    let document = toml_edit::Document::parse(text).ok();
    let section = document.as_ref().and_then(|document| document.get(section));
    let value = section.and_then(|section| section.get(name)).or(section);
    value.and_then(toml_edit::Item::span).unwrap_or_default()
}

/// The name of a fleet that has none.
pub(super) fn usual_name() -> VehicleName {
    "fleet".parse().unwrap_or_default()
}

impl Vehicle {
    pub(super) fn address(&self) -> DroneAddress {
        DroneAddress {
            host: self.drone.clone().unwrap_or_else(|| DRONE_HOST.to_owned()),
            at_port: self.at_port.unwrap_or(AT_PORT),
            navdata_port: self.navdata_port.unwrap_or(NAVDATA_PORT),
            control_port: self.control_port.unwrap_or(CONTROL_PORT),
        }
    }

    /// The drone's number of the ultrasound's frequency.
    pub(super) fn ultrasound(&self) -> u8 {
        match self.ultrasound.map_or(0, u8::from) {
            // As after a start.
            0 => 8,
            number => number,
        }
    }
}
