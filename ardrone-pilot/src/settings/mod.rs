//! `pilot.toml`: settings for flights that need other values than the defaults.
//!
//! [`Settings::sample`] documents every setting. Missing settings keep their defaults. A file with an invalid one is refused as
//! a whole: at the first that cannot be read, otherwise with all that are out of range.

mod editor;
mod fence;
mod room;
mod section;
mod sections;
mod tags;
mod version;

use autopilot::plan::ZOrigin;
use autopilot::vehicle::{SurveyedTag, VehicleConfig, VehicleName};
use serde::{Deserialize, Serialize};

pub use self::editor::{Described, with_changes};
pub(crate) use self::fence::Fence;
use self::room::Room;
pub(crate) use self::room::SurveyedStart;
pub(crate) use self::section::UltrasoundFrequency;
use self::section::{Declared, Section};
use self::sections::{Airframe, Controller, Delays, Drone, Estimator, Station, Vehicle, Video};
pub use self::tags::GivenTag;
use self::tags::Tags;
pub(crate) use self::version::{Version, read_versioned};

/// The version of the format of `pilot.toml` that is read.
pub const VERSION: u32 = 1;

/// Content of a `pilot.toml`, each value in the unit that the file gives it in.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    version: Version<VERSION>,
    vehicle: Vehicle,
    fence: Fence,
    room: Room,
    drone: Drone,
    video: Video,
    station: Station,
    delays: Delays,
    airframe: Airframe,
    estimator: Estimator,
    tags: Tags,
    controller: Controller,
}

/// Why a `pilot.toml` cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SettingsError {
    /// Invalid TOML, another version of the format, an unknown key, or a value that cannot be read; in a file with line and
    /// column.
    #[error("{path}: {message}")]
    Syntax {
        /// The file, or what else the values come from.
        path: String,
        /// The problem and its place.
        message: String,
    },
    /// Values out of range, that do not fit together, or that each vehicle of a fleet has for itself.
    #[error("{path}: {}", .reasons.join("; "))]
    Values {
        /// The file, or what else the values come from.
        path: String,
        /// What is wrong, in a sentence for each value.
        reasons: Vec<String>,
    },
    /// What is to be changed is no section, no setting of one, or has a wrong type.
    #[error("settings are changed as sections with values: {0}")]
    Change(String),
}

/// The sample's first lines.
const HEADER: &str = "\
# How ardrone-pilot flies: every setting with its default. A file of your own needs only what it
# changes: `ardrone-pilot --config FILE`; `ardrone-pilot config --config FILE` shows the settings in effect.

";

/// The sections.
const DECLARED: [Declared; 11] = [
    Vehicle::DECLARED,
    Fence::DECLARED,
    Room::DECLARED,
    Drone::DECLARED,
    Video::DECLARED,
    Station::DECLARED,
    Delays::DECLARED,
    Airframe::DECLARED,
    Estimator::DECLARED,
    Tags::DECLARED,
    Controller::DECLARED,
];

impl Settings {
    /// Parses a `pilot.toml`; `path` is for messages.
    ///
    /// # Errors
    /// [`SettingsError::Syntax`] with the first place that cannot be read, otherwise [`SettingsError::Values`] with all
    /// reasons.
    pub fn parse(path: &str, text: &str) -> Result<Self, SettingsError> {
        let settings: Self =
            read_versioned::<_, VERSION>(text).map_err(|error| SettingsError::Syntax {
                path: path.to_owned(),
                message: error.to_string().trim_end().to_owned(),
            })?;
        let reasons = settings.reasons_against();
        if reasons.is_empty() {
            Ok(settings)
        } else {
            Err(SettingsError::Values { path: path.to_owned(), reasons })
        }
    }

    /// The default `pilot.toml`, with comments.
    ///
    /// # Errors
    /// As [`Settings::to_toml`].
    pub fn sample() -> Result<String, toml::ser::Error> {
        let mut text = HEADER.to_owned();
        let mut values = Declared::default().1;
        for line in Self::default().to_toml()?.lines() {
            if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
                let section = DECLARED.into_iter().find(|(section, _)| *section == name);
                values = section.map(|(_, values)| values).unwrap_or_default();
            } else if line.starts_with("version") {
                text += "# Version of this file's format, which may be left out.\n";
            } else if let Some((name, _)) = line.split_once(" = ") {
                let value = values.iter().find(|value| value.name == name);
                for comment in value.map(|value| value.comments).unwrap_or_default() {
                    text.extend(["#", comment, "\n"]);
                }
            }
            text.extend([line, "\n"]);
        }
        Ok(text)
    }

    /// Converts to TOML without comments.
    ///
    /// # Errors
    /// Never: tables of numbers, flags, strings and arrays of numbers can be written as TOML.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }

    /// Uses tags on the floor, and adds these to the surveyed ones.
    ///
    /// # Errors
    /// [`SettingsError::Values`] if they do not fit together, or with those of the settings. They are added nevertheless.
    pub fn use_tags(&mut self, surveyed: &[GivenTag]) -> Result<(), SettingsError> {
        self.tags.detect = true;
        for tag in surveyed {
            self.tags.add(tag);
        }
        let reasons = self.tags.reasons_against();
        if reasons.is_empty() {
            return Ok(());
        }
        Err(SettingsError::Values { path: "--tag".to_owned(), reasons })
    }

    /// The surveyed tags; `None` if tags are not used.
    pub fn surveyed_tags(&self) -> Option<Vec<SurveyedTag>> {
        self.tags.detect.then(|| self.tags.surveyed().map(SurveyedTag::from).collect())
    }

    /// Takes over what all vehicles of a fleet share: the section `[fence]`, and the least distance from other vehicles,
    /// across, in metres. `None` leaves a value as it is.
    ///
    /// # Errors
    /// [`SettingsError::Syntax`] if the fence cannot be read, [`SettingsError::Values`] if the settings are out of range then.
    pub(crate) fn share(
        &mut self,
        fence: Option<&toml::Table>,
        separation_m: Option<f64>,
    ) -> Result<(), SettingsError> {
        if let Some(fence) = fence {
            self.fence = self.fence.with(fence).map_err(|error| SettingsError::Syntax {
                path: "the fleet's [fence]".to_owned(),
                message: error.to_string().trim_end().to_owned(),
            })?;
        }
        self.room.separation_m = separation_m.unwrap_or(self.room.separation_m);
        let reasons = self.reasons_against();
        if reasons.is_empty() {
            return Ok(());
        }
        Err(SettingsError::Values { path: "the fleet".to_owned(), reasons })
    }

    /// Whether these, of the file at `path`, can be the settings of all vehicles of a fleet.
    ///
    /// # Errors
    /// [`SettingsError::Values`] with what each vehicle has for itself.
    pub(crate) fn for_all(&self, path: &str) -> Result<(), SettingsError> {
        let usual = Self::default();
        let own = [
            ("vehicle.name", self.vehicle.name != usual.vehicle.name),
            ("vehicle.system", self.vehicle.system != usual.vehicle.system),
            ("room.start", self.room.start != usual.room.start),
            ("room.peers", self.room.peers != usual.room.peers),
        ];
        let given = own.into_iter().filter(|(_, is_given)| *is_given);
        let reasons: Vec<String> = given
            .map(|(key, _)| format!("{key} is one vehicle's: the fleet has it for each"))
            .collect();
        if reasons.is_empty() {
            return Ok(());
        }
        Err(SettingsError::Values { path: path.to_owned(), reasons })
    }

    /// Takes over what is one vehicle's: its name, the number of its MAVLink system, where it starts, and the systems of
    /// the others.
    pub(crate) fn give(
        &mut self,
        name: VehicleName,
        system: u8,
        start: SurveyedStart,
        peers: Vec<u8>,
    ) {
        (self.vehicle.name, self.vehicle.system) = (name, system);
        (self.room.start, self.room.peers) = (start, peers);
    }

    /// Sets the frequency that the drone's ultrasound is asked for.
    pub(crate) fn set_ultrasound(&mut self, frequency: UltrasoundFrequency) {
        self.drone.ultrasound = frequency;
    }

    /// All sections but the tags, whose number varies.
    fn sections(&self) -> [&dyn Section<VehicleConfig>; 10] {
        let Self {
            version: _,
            vehicle,
            fence,
            room,
            drone,
            video,
            station,
            delays,
            airframe,
            estimator,
            tags: _,
            controller,
        } = self;
        [vehicle, fence, room, drone, video, station, delays, airframe, estimator, controller]
    }

    /// The vehicle's configuration with these settings; heights of plans are counted from `z_origin`.
    pub fn pilot_config(&self, z_origin: ZOrigin) -> VehicleConfig {
        let mut config = VehicleConfig::default();
        config.limits.z_origin = z_origin;
        for section in self.sections() {
            section.apply(&mut config);
        }
        config.estimator.tags = self.tags.config();
        config.limits.speed_max_m_s = config.cascade.speed_max_m_s;
        config
    }

    fn reasons_against(&self) -> Vec<String> {
        let mut reasons: Vec<String> =
            self.sections().iter().flat_map(|section| section.out_of_range()).collect();
        reasons.extend(self.tags.reasons_against());
        let Self { fence, .. } = self;
        if fence.floor_m >= fence.ceiling_m {
            reasons.push("fence.floor_m is not below fence.ceiling_m".to_owned());
        }
        let patience = self.pilot_config(ZOrigin::default()).station;
        if patience.hold_after >= patience.land_after {
            reasons.push("station.hold_after_ms is not below station.land_after_ms".to_owned());
        }
        reasons
    }
}

#[cfg(test)]
mod tests {
    use autopilot::vehicle::NavdataRate;

    use super::*;

    /// The file is there to be read and linked to; the declarations are what counts.
    #[test]
    fn the_documented_defaults_are_the_defaults() {
        let sample = Settings::sample().unwrap();
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/pilot.toml");
        if std::env::var_os("UPDATE_PILOT_TOML").is_some() {
            std::fs::write(path, &sample).unwrap();
        }
        let file = std::fs::read_to_string(path).unwrap();
        assert!(file == sample, "run the test with UPDATE_PILOT_TOML=1 and look at the difference");
        let settings = Settings::parse("pilot.toml", &sample).unwrap();
        assert_eq!(settings, Settings::default());
        assert_eq!(settings.pilot_config(ZOrigin::Hover), VehicleConfig::default());
    }

    /// Each setting reaches its own place: with all others at their defaults the configuration differs.
    #[test]
    fn no_setting_is_without_effect() {
        let default = Settings::default().pilot_config(ZOrigin::Hover);
        let table: toml::Table = toml::from_str(&Settings::default().to_toml().unwrap()).unwrap();
        let mut tried = 0;
        let is_tried = |section: &str| !["tags", "version"].contains(&section);
        for (section, values) in table.iter().filter(|(section, _)| is_tried(section)) {
            for (name, value) in values.as_table().unwrap() {
                let other = match value {
                    toml::Value::Float(number) => (number * 1.05).into(),
                    // A bit rate that is not asked for.
                    toml::Value::Integer(0) if name == "ultrasound" => 7.into(),
                    toml::Value::Integer(0) => 500.into(),
                    toml::Value::Integer(1) => 2.into(),
                    toml::Value::Integer(number) => (number - 1).into(),
                    toml::Value::Boolean(on) => (!on).into(),
                    toml::Value::Array(_) if name == "start" => vec![1.0, 2.0, 3.0].into(),
                    toml::Value::Array(_) if name == "peers" => vec![7].into(),
                    toml::Value::Array(_) => vec![0.9, 0.8].into(),
                    _ => toml::Value::from("full"),
                };
                let mut changed = table.clone();
                changed[section][name] = other;
                let text = toml::to_string(&changed).unwrap();
                let config = Settings::parse("p", &text).unwrap().pilot_config(ZOrigin::Hover);
                assert_ne!(config, default, "{section}.{name}");
                tried += 1;
            }
        }
        assert_eq!(tried, 48);
    }

    #[test]
    fn what_is_effective_can_be_read_back() {
        let text = "[drone]\nclimb_max_m_s = 1.0\nnavdata = \"full\"";
        let settings = Settings::parse("p", text).unwrap();
        assert_eq!(Settings::parse("p", &settings.to_toml().unwrap()).unwrap(), settings);
        let config = settings.pilot_config(ZOrigin::Floor);
        assert_eq!(config.navdata, NavdataRate::Full);
        assert!((config.estimator.limits.climb_m_s - 1.0).abs() < 1e-12);
    }

    #[test]
    fn mistakes_are_reported_with_their_place() {
        for (text, said) in [
            ("[drone]\ntilt_max = 3", "line 2, column 1"),
            ("[drone]\ntilt_max_deg = \"much\"", "line 2, column 16"),
            ("# mine\nversion = 2\n[drones]\nx = 1", "line 2, column 11"),
            ("version = 2", "version 2 of this file's format: this program reads version 1"),
            ("version = -1", "version -1 of"),
            ("version = 1.0", "line 1, column 11"),
            ("[drone", "line 1"),
            ("[airframe]\nthrust_gain = [0.8, 0.9, 7.0]", "3 numbers where two"),
            ("[airframe]\ndrag_1_s = [0.5]", "1 numbers"),
            ("[tags]\nfocal_units = [1072.0, 1452.0, \"x\"]", "line 2"),
            ("[drone]\nnavdata = \"other\"", "`demo` or `full`"),
        ] {
            let error = Settings::parse("my.toml", text).unwrap_err().to_string();
            assert!(error.starts_with("my.toml: ") && error.contains(said), "{error}");
        }
    }

    #[test]
    fn values_that_no_flight_can_have_are_refused_all_at_once() {
        let text = "[drone]\ntilt_max_deg = 90.0\n[fence]\nfloor_m = nan\n\
                    [airframe]\nthrust_gain = [1.0, 0.0]\n[video]\nbitrate_kbit_s = 100";
        let error = Settings::parse("my.toml", text).unwrap_err();
        let SettingsError::Values { reasons, .. } = error else { panic!("{error}") };
        assert_eq!(reasons.len(), 4, "{reasons:?}");
        assert!(reasons[1].contains("drone.tilt_max_deg is 90"), "{reasons:?}");
        assert!(reasons[2].contains("video.bitrate_kbit_s is 100"), "{reasons:?}");
        for text in [
            "[fence]\nfloor_m = 2.5\nceiling_m = 2.0",
            "[station]\nhold_after_ms = 5000\nland_after_ms = 4000",
            "[station]\nland_after_ms = 20001",
        ] {
            assert!(Settings::parse("my.toml", text).is_err(), "{text}");
        }
    }
}
