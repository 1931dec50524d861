//! Configuration keys with their types, units and ranges.
//!
//! [`Setting::config`] refuses what the drone would refuse, or take and misunderstand. Ranges and
//! defaults are those of Parrot's developer guide. Keys that are not here can be sent as a
//! [`Config`] of plain text.
//!
//! ```
//! use ardrone_link::settings::Setting;
//!
//! let config = Setting::AltitudeMaxM(2.5).config()?;
//! assert_eq!((config.key(), config.value()), ("control:altitude_max", "2500"));
//! assert!(Setting::EulerAngleMaxDeg(45.0).config().is_err());
//! # Ok::<(), ardrone_link::settings::SettingError>(())
//! ```

use crate::at::{Config, ConfigError};

/// Why a setting cannot be sent.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingError {
    /// The value is outside of the key's range.
    #[error("{key} takes {from} to {to}, not {value}")]
    Range {
        /// The key.
        key: &'static str,
        /// The value, in the unit of the setting.
        value: f64,
        /// The lowest that is allowed.
        from: f64,
        /// The highest that is allowed.
        to: f64,
    },
    /// The setting is one of those that [`NavdataMode`] chooses, which come first.
    #[error("{key} is chosen by the navdata mode, not by a setting")]
    Navdata {
        /// The key.
        key: &'static str,
    },
    /// The text cannot be sent.
    #[error(transparent)]
    Text(#[from] ConfigError),
}

/// Which configuration a key belongs to. With custom identities each but the first has its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// One for all.
    Common,
    /// One for each application.
    Application,
    /// One for each user.
    User,
    /// One for each session.
    Session,
}

/// A camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Camera {
    /// The one that looks ahead.
    Front,
    /// The one that looks down.
    Bottom,
}

/// What holds the drone in its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlyingMode {
    /// The ground as the bottom camera sees it.
    Free,
    /// A roundel on the ground.
    HoverOnRoundel,
    /// A roundel on the ground, and its direction.
    HoverOnOrientedRoundel,
}

/// The colours of the other drones' hulls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EnemyColors {
    /// Orange and green.
    Green,
    /// Orange and yellow.
    Yellow,
    /// Orange and blue.
    Blue,
}

/// What the cameras look for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detection {
    /// Nothing.
    None,
    /// What the selections of the cameras say.
    Selected,
    /// The black and white roundel with its direction.
    OrientedRoundel,
    /// Hulls and roundels by the newer algorithm.
    VisionV2,
}

/// Which options the drone sends, and how often.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum NavdataMode {
    /// Attitude, altitude, velocity and battery, 15 times a second.
    #[default]
    Demo,
    /// As [`NavdataMode::Demo`], with the options of these tags too, each below 28.
    DemoWith(Vec<u16>),
    /// Every option, 200 times a second.
    Full,
}

impl NavdataMode {
    /// Tag of [`crate::navdata::Demo`], without which nobody could fly.
    const DEMO_TAG: u16 = 0;

    /// The settings that choose it. They come before all others, since the first ends the bootstrap.
    pub fn settings(&self) -> Vec<Setting> {
        let mut settings = vec![Setting::NavdataDemo(*self != Self::Full)];
        if let Self::DemoWith(tags) = self {
            let tags = std::iter::once(Self::DEMO_TAG).chain(tags.iter().copied()).collect();
            settings.push(Setting::NavdataOptions(tags));
        }
        settings
    }
}

impl Setting {
    pub(crate) fn is_navdata_mode(&self) -> bool {
        matches!(self, Self::NavdataDemo(_) | Self::NavdataOptions(_))
    }
}

macro_rules! settings {
    ($($(#[$doc:meta])* $name:ident($ctype:ty) = $key:literal, $category:ident, $value:expr;)*) => {
        /// One key and its value.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        pub enum Setting {
            $($(#[$doc])* $name($ctype),)*
        }

        impl Setting {
            /// `section:name`
            pub fn key(&self) -> &'static str {
                match self {
                    $(Self::$name(_) => $key,)*
                }
            }

            /// Which configuration it belongs to.
            pub fn category(&self) -> Category {
                match self {
                    $(Self::$name(_) => Category::$category,)*
                }
            }

            /// What is sent.
            ///
            /// # Errors
            /// [`SettingError`] if the drone would refuse or misunderstand the value.
            pub fn config(&self) -> Result<Config, SettingError> {
                match self {
                    $(Self::$name(value) => {
                        let text: fn(&'static str, &$ctype) -> Result<String, SettingError> = $value;
                        Ok(Config::new($key, text($key, value)?)?)
                    })*
                }
            }
        }
    };
}

settings! {
    /// Whether only the demo set of options is sent, 15 times a second, or all of them, 200 times.
    /// It also ends the bootstrap, so it comes first.
    NavdataDemo(bool) = "general:navdata_demo", Common, |_, on| flag(*on);
    /// Tags of the options that are sent in demo mode too, each below 28.
    NavdataOptions(Vec<u16>) = "general:navdata_options", Application, |key, tags| mask(key, tags);
    /// Silence after which the drone lands by itself, 1 to 60; 2 by default.
    CommunicationWatchdogS(u32) = "general:com_watchdog", Common, |key, s| whole(key, *s, 1, 60);
    /// Whether the outdoor limits and the wind estimator are used. To be set before the limits.
    Outdoor(bool) = "control:outdoor", Common, |_, on| flag(*on);
    /// Whether the outdoor hull is on, which changes the control gains.
    FlightWithoutShell(bool) = "control:flight_without_shell", Common, |_, on| flag(*on);
    /// Ceiling, 0.5 to 100; 3 by default.
    AltitudeMaxM(f64) = "control:altitude_max", Common, |key, m| milli(key, *m, 0.5, 100.0);
    /// Floor, 0.05 to 1; 0.05 by default.
    AltitudeMinM(f64) = "control:altitude_min", Common, |key, m| milli(key, *m, 0.05, 1.0);
    /// Largest tilt, 0 to 30; 12 by default.
    EulerAngleMaxDeg(f64) = "control:euler_angle_max", User, |key, deg| degrees(key, *deg, 0.0, 30.0);
    /// Largest climb, 0.2 to 2; 0.7 by default.
    ClimbMaxMS(f64) = "control:control_vz_max", User, |key, m_s| milli(key, *m_s, 0.2, 2.0);
    /// Largest turn, 40 to 350; 100 by default.
    YawRateMaxDegS(f64) = "control:control_yaw", User, |key, deg| degrees(key, *deg, 40.0, 350.0);
    /// What the largest tilt becomes indoors.
    IndoorEulerAngleMaxDeg(f64) = "control:indoor_euler_angle_max", User, |key, deg| degrees(key, *deg, 0.0, 30.0);
    /// What the largest climb becomes indoors.
    IndoorClimbMaxMS(f64) = "control:indoor_control_vz_max", User, |key, m_s| milli(key, *m_s, 0.2, 2.0);
    /// What the largest turn becomes indoors.
    IndoorYawRateMaxDegS(f64) = "control:indoor_control_yaw", User, |key, deg| degrees(key, *deg, 40.0, 350.0);
    /// What the largest tilt becomes outdoors.
    OutdoorEulerAngleMaxDeg(f64) = "control:outdoor_euler_angle_max", User, |key, deg| degrees(key, *deg, 0.0, 30.0);
    /// What the largest climb becomes outdoors.
    OutdoorClimbMaxMS(f64) = "control:outdoor_control_vz_max", User, |key, m_s| milli(key, *m_s, 0.2, 2.0);
    /// What the largest turn becomes outdoors.
    OutdoorYawRateMaxDegS(f64) = "control:outdoor_control_yaw", User, |key, deg| degrees(key, *deg, 40.0, 350.0);
    /// What holds the drone in its place.
    FlyingMode(FlyingMode) = "control:flying_mode", Session, |_, mode| Ok(match mode {
        FlyingMode::Free => "0",
        FlyingMode::HoverOnRoundel => "1",
        FlyingMode::HoverOnOrientedRoundel => "2",
    }.to_owned());
    /// How far it may stray from a roundel, 0.1 to 5; 1 by default.
    HoveringRangeM(f64) = "control:hovering_range", Session, |key, m| milli(key, *m, 0.1, 5.0);
    /// With which camera the video is made.
    VideoChannel(Camera) = "video:video_channel", Session, |_, camera| Ok(match camera {
        Camera::Front => "0",
        Camera::Bottom => "1",
    }.to_owned());
    /// Pictures a second, 15 to 30. Needs custom identities.
    VideoFramesPerSecond(u32) = "video:codec_fps", Session, |key, fps| whole(key, *fps, 15, 30);
    /// 250 to 4000. Needs custom identities.
    VideoBitRateKbitS(u32) = "video:bitrate", Application, |key, rate| whole(key, *rate, 250, 4000);
    /// Whether a recording goes to a USB key.
    VideoOnUsb(bool) = "video:video_on_usb", Common, |_, on| flag(*on);
    /// What the cameras look for.
    DetectType(Detection) = "detect:detect_type", Session, |_, detection| Ok(match detection {
        Detection::None => "3",
        Detection::Selected => "10",
        Detection::OrientedRoundel => "12",
        Detection::VisionV2 => "13",
    }.to_owned());
    /// Bits of what the front camera looks for.
    DetectionsFront(u32) = "detect:detections_select_h", Session, |_, bits| Ok(bits.to_string());
    /// Bits of what the bottom camera looks for, 30 times a second.
    DetectionsBottom(u32) = "detect:detections_select_v", Session, |_, bits| Ok(bits.to_string());
    /// Bits of what the bottom camera looks for, in step with the hover.
    DetectionsBottomInStep(u32) = "detect:detections_select_v_hsync", Session, |_, bits| Ok(bits.to_string());
    /// The colours of the other drones' hulls.
    EnemyColors(EnemyColors) = "detect:enemy_colors", Common, |_, colors| Ok(match colors {
        EnemyColors::Green => "1",
        EnemyColors::Yellow => "2",
        EnemyColors::Blue => "3",
    }.to_owned());
    /// Whether the ultrasound uses 22.22 Hz and not 25 Hz: of two drones near each other one should.
    SlowUltrasound(bool) = "pic:ultrasound_freq", Common, |_, slow| {
        Ok(if *slow { "7" } else { "8" }.to_owned())
    };
    /// The network's name after the next start.
    NetworkName(String) = "network:ssid_single_player", Common, |_, name| Ok(name.clone());
    /// Where the pilot is, -90 to 90, north positive.
    LatitudeDeg(f64) = "gps:latitude", Session, |key, deg| number(key, *deg, -90.0, 90.0);
    /// Where the pilot is, -180 to 180, east positive.
    LongitudeDeg(f64) = "gps:longitude", Session, |key, deg| number(key, *deg, -180.0, 180.0);
    /// Where the pilot is, -500 to 9000 above the sea.
    ElevationM(f64) = "gps:altitude", Session, |key, m| number(key, *m, -500.0, 9000.0);
}

#[allow(clippy::unnecessary_wraps, reason = "one signature for all kinds of values")]
fn flag(on: bool) -> Result<String, SettingError> {
    Ok(if on { "TRUE" } else { "FALSE" }.to_owned())
}

/// A decimal point whatever the locale: a comma makes the drone forget its tilt.
fn number(key: &'static str, value: f64, from: f64, to: f64) -> Result<String, SettingError> {
    if (from..=to).contains(&value) {
        Ok(value.to_string())
    } else {
        Err(SettingError::Range { key, value, from, to })
    }
}

fn whole(key: &'static str, value: u32, from: u32, to: u32) -> Result<String, SettingError> {
    number(key, value.into(), from.into(), to.into())
}

/// The drone takes thousandths, as whole numbers.
fn milli(key: &'static str, value: f64, from: f64, to: f64) -> Result<String, SettingError> {
    number(key, value, from, to)?;
    Ok((value * 1000.0).round().to_string())
}

/// The drone takes radians.
fn degrees(key: &'static str, value: f64, from: f64, to: f64) -> Result<String, SettingError> {
    number(key, value, from, to)?;
    Ok(format!("{:.6}", value.to_radians()))
}

fn mask(key: &'static str, tags: &[u16]) -> Result<String, SettingError> {
    let mut bits = 0_u32;
    for tag in tags {
        whole(key, (*tag).into(), 0, 27)?;
        bits |= 1 << tag;
    }
    Ok(bits.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_sent_in_the_drones_units() {
        for (setting, key, value) in [
            (Setting::NavdataDemo(true), "general:navdata_demo", "TRUE"),
            (Setting::NavdataOptions(vec![0, 16]), "general:navdata_options", "65537"),
            (
                Setting::NavdataOptions(vec![0, 10, 16, 22, 26]),
                "general:navdata_options",
                "71369729",
            ),
            (Setting::AltitudeMaxM(2.999_6), "control:altitude_max", "3000"),
            (Setting::EulerAngleMaxDeg(12.0), "control:euler_angle_max", "0.209440"),
            (Setting::ClimbMaxMS(0.7), "control:control_vz_max", "700"),
            (Setting::YawRateMaxDegS(100.0), "control:control_yaw", "1.745329"),
            (Setting::VideoChannel(Camera::Bottom), "video:video_channel", "1"),
            (Setting::SlowUltrasound(false), "pic:ultrasound_freq", "8"),
            (Setting::LatitudeDeg(-33.5), "gps:latitude", "-33.5"),
        ] {
            let config = setting.config().unwrap();
            assert_eq!((config.key(), config.value()), (key, value));
            assert_eq!(setting.key(), key);
        }
        assert_eq!(Setting::Outdoor(false).category(), Category::Common);
        assert_eq!(Setting::ClimbMaxMS(1.0).category(), Category::User);
    }

    #[test]
    fn what_the_drone_would_misunderstand_cannot_be_built() {
        for setting in [
            Setting::AltitudeMaxM(0.2),
            Setting::AltitudeMaxM(2500.0),
            Setting::AltitudeMaxM(f64::NAN),
            Setting::EulerAngleMaxDeg(31.0),
            Setting::EulerAngleMaxDeg(-1.0),
            Setting::ClimbMaxMS(700.0),
            Setting::CommunicationWatchdogS(0),
            Setting::NavdataOptions(vec![28]),
            Setting::NetworkName("a\"b".to_owned()),
        ] {
            assert!(setting.config().is_err(), "{setting:?}");
        }
        let error = Setting::EulerAngleMaxDeg(45.0).config().unwrap_err();
        assert_eq!(error.to_string(), "control:euler_angle_max takes 0 to 30, not 45");
    }
}
