//! `pilot.toml`: settings for flights that need other values than the defaults.
//!
//! [`DEFAULTS`] documents every setting. Missing settings keep their defaults; a file with an invalid one is
//! refused as a whole, with all reasons.

mod tags;

use std::ops::RangeInclusive;
use std::time::Duration;

use autopilot::plan::{FlightLimits, ZOrigin};
use autopilot::vehicle::{NavdataRate, VehicleConfig};
use estimator::EstimatorConfig;
use kinematics::DroneLimits;
use nalgebra::Vector2;
use pid::{CascadeConfig, Law, PidGains};
use serde::{Deserialize, Serialize};

pub use self::tags::GivenTag;
use self::tags::Tags;

/// The default `pilot.toml`, with comments.
pub const DEFAULTS: &str = include_str!("../pilot.toml");

/// Content of a `pilot.toml`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Settings {
    fence: Fence,
    drone: Drone,
    delays: Delays,
    airframe: Airframe,
    estimator: Estimator,
    tags: Tags,
    controller: Controller,
}

/// Why a `pilot.toml` cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SettingsError {
    /// Invalid TOML, unknown key or wrong type; with line and column.
    #[error("{path}: {message}")]
    Syntax {
        /// The file.
        path: String,
        /// The problem and its place.
        message: String,
    },
    /// Values out of range.
    #[error("{path}: {}", .reasons.join("; "))]
    Values {
        /// The file.
        path: String,
        /// One reason for each value.
        reasons: Vec<String>,
    },
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[allow(clippy::struct_field_names, reason = "the unit belongs to the name")]
struct Fence {
    floor_m: f64,
    ceiling_m: f64,
    radius_m: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Drone {
    tilt_max_deg: f64,
    climb_max_m_s: f64,
    turn_max_deg_s: f64,
    navdata: Navdata,
    read_back: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Navdata {
    Demo,
    Full,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[allow(clippy::struct_field_names, reason = "the unit belongs to the name")]
struct Delays {
    command_ms: u32,
    velocity_ms: u32,
    altitude_ms: u32,
    attitude_ms: u32,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Airframe {
    identify: bool,
    tilt_gain: f64,
    tilt_lag_s: f64,
    climb_gain: f64,
    drop_gain: f64,
    climb_lag_s: f64,
    thrust_gain: [f64; 2],
    drag_1_s: [f64; 2],
    turn_gain: f64,
    turn_lag_s: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Estimator {
    velocity_gain_1_s: f64,
    disturbance_gain_1_s2: f64,
    disturbance_max_m_s2: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Controller {
    #[serde(with = "law_name")]
    law: Law,
    speed_max_m_s: f64,
    acceleration_share: f64,
    jerk_max_m_s3: f64,
    climb_speed_max_m_s: f64,
    braking_share: f64,
    proportional_1_s2: f64,
    derivative_1_s: f64,
    integral_1_s3: f64,
    vertical_frequency_rad_s: f64,
    vertical_damping: f64,
    vertical_integral_1_s2: f64,
    turn_share: f64,
    yaw_1_deg: f64,
}

/// Serializes [`Law`] by its name.
mod law_name {
    use pid::Law;
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::Serializer;

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde wants it so")]
    pub(super) fn serialize<S: Serializer>(law: &Law, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(law.name())
    }

    pub(super) fn deserialize<'a, D: Deserializer<'a>>(from: D) -> Result<Law, D::Error> {
        let name = String::deserialize(from)?;
        let law = Law::ALL.into_iter().find(|law| law.name() == name);
        law.ok_or_else(|| Error::unknown_variant(&name, &["cascade", "tum"]))
    }
}

impl Default for Fence {
    fn default() -> Self {
        let FlightLimits { floor_m, ceiling_m, radius_m, .. } = FlightLimits::default();
        Self { floor_m, ceiling_m, radius_m }
    }
}

impl Default for Drone {
    fn default() -> Self {
        // Converted to degrees here, because converting back would not give exactly the same number.
        let DroneLimits { climb_m_s, turn_deg_s, .. } = DroneLimits::default();
        Self {
            tilt_max_deg: 12.0,
            climb_max_m_s: climb_m_s,
            turn_max_deg_s: turn_deg_s,
            navdata: Navdata::Demo,
            read_back: true,
        }
    }
}

impl Default for Delays {
    fn default() -> Self {
        let config = EstimatorConfig::default();
        let ms = |delay: Duration| u32::try_from(delay.as_millis()).unwrap_or(u32::MAX);
        Self {
            command_ms: ms(config.dead_time),
            velocity_ms: ms(config.velocity_delay),
            altitude_ms: ms(config.altitude_delay),
            attitude_ms: ms(config.attitude_delay),
        }
    }
}

impl Default for Airframe {
    fn default() -> Self {
        let EstimatorConfig { airframe, identify, .. } = EstimatorConfig::default();
        Self {
            identify,
            tilt_gain: airframe.tilt_gain,
            tilt_lag_s: airframe.tilt_lag_s,
            climb_gain: airframe.climb_gain,
            drop_gain: airframe.drop_gain,
            climb_lag_s: airframe.climb_lag_s,
            thrust_gain: airframe.thrust_gain.into(),
            drag_1_s: airframe.drag_1_s.into(),
            turn_gain: airframe.turn_gain,
            turn_lag_s: airframe.turn_lag_s,
        }
    }
}

impl Default for Estimator {
    fn default() -> Self {
        let config = EstimatorConfig::default();
        Self {
            velocity_gain_1_s: config.velocity_gain_1_s,
            disturbance_gain_1_s2: config.disturbance_gain_1_s2,
            disturbance_max_m_s2: config.disturbance_max_m_s2,
        }
    }
}

impl Default for Controller {
    fn default() -> Self {
        let config = CascadeConfig::default();
        Self {
            law: Law::default(),
            speed_max_m_s: config.speed_max_m_s,
            acceleration_share: config.acceleration_share,
            jerk_max_m_s3: config.jerk_max_m_s3,
            climb_speed_max_m_s: config.climb_speed_max_m_s,
            braking_share: config.braking_share,
            proportional_1_s2: config.horizontal.proportional,
            derivative_1_s: config.horizontal.derivative,
            integral_1_s3: config.horizontal.integral,
            vertical_frequency_rad_s: config.vertical_frequency_rad_s,
            vertical_damping: config.vertical_damping,
            vertical_integral_1_s2: config.vertical_integral_1_s2,
            turn_share: config.turn_share,
            yaw_1_deg: config.yaw.proportional,
        }
    }
}

impl Settings {
    /// Parses a `pilot.toml`; `path` is for messages.
    ///
    /// # Errors
    /// [`SettingsError`] with all reasons.
    pub fn parse(path: &str, text: &str) -> Result<Self, SettingsError> {
        let settings: Self = toml::from_str(text).map_err(|error| SettingsError::Syntax {
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

    /// Converts to TOML without comments.
    ///
    /// # Errors
    /// Never: tables of numbers, strings and arrays of numbers can be written as TOML.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }

    /// Selects another control law.
    pub fn set_law(&mut self, law: Law) {
        self.controller.law = law;
    }

    /// Uses roundels on the floor, and takes these for surveyed.
    ///
    /// # Errors
    /// [`SettingsError::Values`] if they do not fit together, or with those of the settings.
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

    /// The tags that are used and surveyed; nothing if tags are not used.
    pub fn surveyed_tags(&self) -> Option<Vec<GivenTag>> {
        self.tags.detect.then(|| self.tags.surveyed().collect())
    }

    /// The vehicle's configuration.
    pub fn pilot_config(&self, z_origin: ZOrigin) -> VehicleConfig {
        let Self { fence, drone, delays, airframe, estimator, tags, controller } = self;
        let limits = DroneLimits {
            tilt_rad: drone.tilt_max_deg.to_radians(),
            climb_m_s: drone.climb_max_m_s,
            turn_deg_s: drone.turn_max_deg_s,
        };
        let ms = |delay_ms: u32| Duration::from_millis(delay_ms.into());
        VehicleConfig {
            limits: FlightLimits {
                floor_m: fence.floor_m,
                ceiling_m: fence.ceiling_m,
                radius_m: fence.radius_m,
                z_origin,
            },
            navdata: match drone.navdata {
                Navdata::Demo => NavdataRate::Demo,
                Navdata::Full => NavdataRate::Full,
            },
            read_back: drone.read_back,
            law: controller.law,
            estimator: EstimatorConfig {
                limits,
                airframe: kinematics::Airframe {
                    tilt_gain: airframe.tilt_gain,
                    tilt_lag_s: airframe.tilt_lag_s,
                    climb_gain: airframe.climb_gain,
                    drop_gain: airframe.drop_gain,
                    climb_lag_s: airframe.climb_lag_s,
                    thrust_gain: Vector2::from(airframe.thrust_gain),
                    drag_1_s: Vector2::from(airframe.drag_1_s),
                    turn_gain: airframe.turn_gain,
                    turn_lag_s: airframe.turn_lag_s,
                },
                dead_time: ms(delays.command_ms),
                velocity_delay: ms(delays.velocity_ms),
                altitude_delay: ms(delays.altitude_ms),
                attitude_delay: ms(delays.attitude_ms),
                velocity_gain_1_s: estimator.velocity_gain_1_s,
                disturbance_gain_1_s2: estimator.disturbance_gain_1_s2,
                disturbance_max_m_s2: estimator.disturbance_max_m_s2,
                identify: airframe.identify,
                tags: tags.config(),
            },
            cascade: controller.cascade(),
        }
    }

    fn reasons_against(&self) -> Vec<String> {
        let Self { fence, drone, delays, airframe, estimator, tags, controller: c } = self;
        let mut reasons = Vec::new();
        for (name, value, range) in [
            ("fence.floor_m", fence.floor_m, 0.1..=3.0),
            ("fence.ceiling_m", fence.ceiling_m, 0.5..=100.0),
            ("fence.radius_m", fence.radius_m, 0.5..=200.0),
            ("drone.tilt_max_deg", drone.tilt_max_deg, 1.0..=25.0),
            ("drone.climb_max_m_s", drone.climb_max_m_s, 0.2..=2.0),
            ("drone.turn_max_deg_s", drone.turn_max_deg_s, 40.0..=350.0),
            ("delays.command_ms", delays.command_ms.into(), 0.0..=500.0),
            ("delays.velocity_ms", delays.velocity_ms.into(), 0.0..=300.0),
            ("delays.altitude_ms", delays.altitude_ms.into(), 0.0..=300.0),
            ("delays.attitude_ms", delays.attitude_ms.into(), 0.0..=300.0),
            ("airframe.tilt_gain", airframe.tilt_gain, GAIN),
            ("airframe.tilt_lag_s", airframe.tilt_lag_s, 0.01..=1.0),
            ("airframe.climb_gain", airframe.climb_gain, GAIN),
            ("airframe.drop_gain", airframe.drop_gain, GAIN),
            ("airframe.climb_lag_s", airframe.climb_lag_s, 0.05..=3.0),
            ("airframe.thrust_gain", airframe.thrust_gain[0], GAIN),
            ("airframe.thrust_gain", airframe.thrust_gain[1], GAIN),
            ("airframe.drag_1_s", airframe.drag_1_s[0], 0.0..=3.0),
            ("airframe.drag_1_s", airframe.drag_1_s[1], 0.0..=3.0),
            ("airframe.turn_gain", airframe.turn_gain, GAIN),
            ("airframe.turn_lag_s", airframe.turn_lag_s, 0.01..=1.0),
            ("estimator.velocity_gain_1_s", estimator.velocity_gain_1_s, 0.1..=100.0),
            ("estimator.disturbance_gain_1_s2", estimator.disturbance_gain_1_s2, 0.0..=50.0),
            ("estimator.disturbance_max_m_s2", estimator.disturbance_max_m_s2, 0.0..=3.0),
            ("controller.speed_max_m_s", c.speed_max_m_s, 0.1..=10.0),
            ("controller.acceleration_share", c.acceleration_share, 0.05..=1.0),
            ("controller.jerk_max_m_s3", c.jerk_max_m_s3, 0.5..=100.0),
            ("controller.climb_speed_max_m_s", c.climb_speed_max_m_s, 0.05..=2.0),
            ("controller.braking_share", c.braking_share, 0.1..=1.0),
            ("controller.proportional_1_s2", c.proportional_1_s2, 0.1..=20.0),
            ("controller.derivative_1_s", c.derivative_1_s, 0.0..=20.0),
            ("controller.integral_1_s3", c.integral_1_s3, 0.0..=5.0),
            ("controller.vertical_frequency_rad_s", c.vertical_frequency_rad_s, 0.1..=10.0),
            ("controller.vertical_damping", c.vertical_damping, 0.1..=3.0),
            ("controller.vertical_integral_1_s2", c.vertical_integral_1_s2, 0.0..=5.0),
            ("controller.turn_share", c.turn_share, 0.05..=1.0),
            ("controller.yaw_1_deg", c.yaw_1_deg, 0.001..=0.2),
        ] {
            reasons.extend(outside(name, value, &range));
        }
        reasons.extend(tags.reasons_against());
        if fence.floor_m >= fence.ceiling_m {
            reasons.push("fence.floor_m is not below fence.ceiling_m".to_owned());
        }
        reasons
    }
}

/// Range of gains that the estimator accepts.
const GAIN: RangeInclusive<f64> = 0.4..=2.5;

fn outside(name: &str, value: f64, range: &RangeInclusive<f64>) -> Option<String> {
    let (from, to) = (range.start(), range.end());
    // NaN is out of range too.
    (!range.contains(&value)).then(|| format!("{name} is {value}: it must lie in {from} to {to}"))
}

impl Controller {
    fn cascade(&self) -> CascadeConfig {
        CascadeConfig {
            speed_max_m_s: self.speed_max_m_s,
            acceleration_share: self.acceleration_share,
            jerk_max_m_s3: self.jerk_max_m_s3,
            climb_speed_max_m_s: self.climb_speed_max_m_s,
            braking_share: self.braking_share,
            horizontal: PidGains {
                proportional: self.proportional_1_s2,
                derivative: self.derivative_1_s,
                integral: self.integral_1_s3,
            },
            vertical_frequency_rad_s: self.vertical_frequency_rad_s,
            vertical_damping: self.vertical_damping,
            vertical_integral_1_s2: self.vertical_integral_1_s2,
            turn_share: self.turn_share,
            yaw: PidGains { proportional: self.yaw_1_deg, ..PidGains::default() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_documented_defaults_are_the_defaults() {
        let settings = Settings::parse("pilot.toml", DEFAULTS).unwrap();
        assert_eq!(settings, Settings::default());
        let config = settings.pilot_config(ZOrigin::Hover);
        assert_eq!(config, VehicleConfig::default());
        // Every setting must be documented in [`DEFAULTS`].
        for line in settings.to_toml().unwrap().lines().filter(|line| line.contains('=')) {
            let name = line.split(' ').next().unwrap();
            assert!(DEFAULTS.lines().any(|line| line.starts_with(name)), "{name}");
        }
    }

    #[test]
    fn what_is_effective_can_be_read_back() {
        let mut settings = Settings::parse("p", "[drone]\nclimb_max_m_s = 1.0").unwrap();
        settings.set_law(Law::Tum);
        assert_eq!(Settings::parse("p", &settings.to_toml().unwrap()).unwrap(), settings);
        let config = settings.pilot_config(ZOrigin::Floor);
        assert_eq!(config.law, Law::Tum);
        assert!((config.estimator.limits.climb_m_s - 1.0).abs() < 1e-12);
    }

    #[test]
    fn mistakes_are_reported_with_their_place() {
        for (text, said) in [
            ("[drone]\ntilt_max = 3", "line 2, column 1"),
            ("[drone]\ntilt_max_deg = \"much\"", "line 2, column 16"),
            ("[drone", "line 1"),
            ("[controller]\nlaw = \"other\"", "`cascade` or `tum`"),
        ] {
            let error = Settings::parse("my.toml", text).unwrap_err().to_string();
            assert!(error.starts_with("my.toml: ") && error.contains(said), "{error}");
        }
    }

    #[test]
    fn values_that_no_flight_can_have_are_refused_all_at_once() {
        let text = "[drone]\ntilt_max_deg = 90.0\n[fence]\nfloor_m = nan\n\
                    [airframe]\nthrust_gain = [1.0, 0.0]";
        let error = Settings::parse("my.toml", text).unwrap_err();
        let SettingsError::Values { reasons, .. } = error else { panic!("{error}") };
        assert_eq!(reasons.len(), 3, "{reasons:?}");
        assert!(reasons[1].contains("drone.tilt_max_deg is 90"), "{reasons:?}");
        let text = "[fence]\nfloor_m = 2.5\nceiling_m = 2.0";
        assert!(Settings::parse("my.toml", text).is_err());
    }
}
