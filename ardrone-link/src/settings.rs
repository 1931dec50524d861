//! Configuration keys with their types, units and ranges.
//!
//! [`Setting::config`] refuses values out of range. The ranges of the flight's limits are those that Parrot's developer
//! guide recommends; where it has none, as for the floor, they are chosen here. Defaults are those of a drone as it leaves
//! the factory. Other keys can be sent as a plain [`Config`].
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
    /// The value is out of the key's range.
    #[error("{key} takes {from} to {to}, not {value}")]
    Range {
        /// The key.
        key: &'static str,
        /// The value, in the unit of the setting; of a list the entry.
        value: f64,
        /// The lowest allowed value, in the same unit.
        from: f64,
        /// The highest allowed value, in the same unit.
        to: f64,
    },
    /// The setting belongs to [`NavdataMode`], whose settings come first.
    #[error("{key} is chosen by the navdata mode, not by a setting")]
    Navdata {
        /// The key.
        key: &'static str,
    },
    /// No network can have this name.
    #[error("{key} takes a name of 1 to {LONGEST_NETWORK_NAME} characters")]
    NetworkName {
        /// The key.
        key: &'static str,
    },
    /// The text cannot be carried by an AT command.
    #[error(transparent)]
    Text(#[from] ConfigError),
}

/// Characters of the longest name of a network, by IEEE 802.11.
const LONGEST_NETWORK_NAME: usize = 32;

/// Which of the drone's configurations a key belongs to. A client with an identity of its own has its own values in every
/// category but the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// Shared by all clients.
    Common,
    /// One for each application.
    Application,
    /// One for each user.
    User,
    /// One for each session.
    Session,
}

/// A camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Camera {
    /// The forward camera.
    Front,
    /// The downward camera.
    Bottom,
}

/// What the drone holds its position over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlyingMode {
    /// The ground texture seen by the bottom camera.
    Free,
    /// A roundel on the ground, which [`Setting::DetectType`] has to look for.
    HoverOnRoundel,
    /// The same, and the drone keeps its heading relative to the roundel.
    HoverOnOrientedRoundel,
}

/// Colours of the tags on the other drones' hulls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EnemyColors {
    /// Orange and green.
    Green,
    /// Orange and yellow.
    Yellow,
    /// Orange and blue.
    Blue,
}

/// What determines the bit rate of the video.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BitRateControl {
    /// It is [`Setting::VideoMaxBitRateKbitS`].
    Off,
    /// The drone adapts it to the link, up to [`Setting::VideoMaxBitRateKbitS`].
    Dynamic,
    /// It is [`Setting::VideoBitRateKbitS`], whatever the maximum.
    Manual,
}

/// What the cameras look for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detection {
    /// Nothing.
    None,
    /// As selected for each camera by [`Setting::DetectionsFront`], [`Setting::DetectionsBottom`] and
    /// [`Setting::DetectionsBottomInStep`].
    Selected,
    /// The black and white oriented roundel, with the bottom camera.
    OrientedRoundel,
    /// The second version of the tags on hulls, in front of the drone.
    VisionV2,
}

/// Navdata options that the drone sends, and their rate.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum NavdataMode {
    /// Attitude, altitude, velocity and battery, 15 times a second. Which other options come with them is left as it is.
    #[default]
    Demo,
    /// As [`NavdataMode::Demo`], with the options of these tags, each below 28, and no others.
    DemoWith(Vec<u16>),
    /// Every option, 200 times a second.
    Full,
}

impl NavdataMode {
    /// Tag of [`crate::navdata::Demo`], which every client needs.
    const DEMO_TAG: u16 = 0;

    /// The settings that select it. They come before all others, because the first ends the bootstrap mode.
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
        /// A configuration key and its value. A number is in the unit at the end of its name; [`Setting::config`] refuses one
        /// that is out of its range.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        pub enum Setting {
            $($(#[$doc])* $name($ctype),)*
        }

        impl Setting {
            /// The key: `section:name`.
            pub fn key(&self) -> &'static str {
                match self {
                    $(Self::$name(_) => $key,)*
                }
            }

            /// The category to which the key belongs.
            pub fn category(&self) -> Category {
                match self {
                    $(Self::$name(_) => Category::$category,)*
                }
            }

            /// The key and value to send. The drone takes limits in millimetres, radians and their rates.
            ///
            /// # Errors
            /// [`SettingError::Range`] if a number is out of its range, [`SettingError::NetworkName`] if no network can have
            /// the name, [`SettingError::Text`] if a text cannot be carried
            /// by an AT command.
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
    /// Whether only the demo set of options is sent, 15 times a second, or all of them, 200 times. It also
    /// ends the bootstrap mode, so it comes first.
    NavdataDemo(bool) = "general:navdata_demo", Common, |_, on| flag(*on);
    /// Tags of additional options in demo mode, each below 28.
    NavdataOptions(Vec<u16>) = "general:navdata_options", Application, |key, tags| mask(key, tags);
    /// Silence after which the drone lands by itself, 1 to 60 s; 2 s by default.
    CommunicationWatchdogS(u32) = "general:com_watchdog", Common, |key, s| whole(key, *s, 1, 60);
    /// Whether the outdoor limits and the wind estimator are used. Set it before the limits.
    Outdoor(bool) = "control:outdoor", Common, |_, on| flag(*on);
    /// Whether the outdoor hull is mounted, which changes the control gains.
    FlightWithoutShell(bool) = "control:flight_without_shell", Common, |_, on| flag(*on);
    /// Ceiling, 0.5 to 100 m; 3 m by default.
    AltitudeMaxM(f64) = "control:altitude_max", Common, |key, m| milli(key, *m, 0.5, 100.0);
    /// Floor, 0.05 to 1 m; 0.05 m by default.
    AltitudeMinM(f64) = "control:altitude_min", Common, |key, m| milli(key, *m, 0.05, 1.0);
    /// Maximum tilt, 0° to 30°; 12° by default.
    EulerAngleMaxDeg(f64) = "control:euler_angle_max", User, |key, deg| degrees(key, *deg, 0.0, 30.0);
    /// Maximum rate of climb, 0.2 to 2 m/s; 0.7 m/s by default.
    ClimbMaxMS(f64) = "control:control_vz_max", User, |key, m_s| milli(key, *m_s, 0.2, 2.0);
    /// Maximum yaw rate, 40 to 350 °/s; 100 °/s by default.
    YawRateMaxDegS(f64) = "control:control_yaw", User, |key, deg| degrees(key, *deg, 40.0, 350.0);
    /// Maximum tilt indoors, 0° to 30°.
    IndoorEulerAngleMaxDeg(f64) = "control:indoor_euler_angle_max", User, |key, deg| degrees(key, *deg, 0.0, 30.0);
    /// Maximum rate of climb indoors, 0.2 to 2 m/s.
    IndoorClimbMaxMS(f64) = "control:indoor_control_vz_max", User, |key, m_s| milli(key, *m_s, 0.2, 2.0);
    /// Maximum yaw rate indoors, 40 to 350 °/s.
    IndoorYawRateMaxDegS(f64) = "control:indoor_control_yaw", User, |key, deg| degrees(key, *deg, 40.0, 350.0);
    /// Maximum tilt outdoors, 0° to 30°.
    OutdoorEulerAngleMaxDeg(f64) = "control:outdoor_euler_angle_max", User, |key, deg| degrees(key, *deg, 0.0, 30.0);
    /// Maximum rate of climb outdoors, 0.2 to 2 m/s.
    OutdoorClimbMaxMS(f64) = "control:outdoor_control_vz_max", User, |key, m_s| milli(key, *m_s, 0.2, 2.0);
    /// Maximum yaw rate outdoors, 40 to 350 °/s.
    OutdoorYawRateMaxDegS(f64) = "control:outdoor_control_yaw", User, |key, deg| degrees(key, *deg, 40.0, 350.0);
    /// What the drone holds its position over.
    FlyingMode(FlyingMode) = "control:flying_mode", Session, |_, mode| Ok(match mode {
        FlyingMode::Free => "0",
        FlyingMode::HoverOnRoundel => "1",
        FlyingMode::HoverOnOrientedRoundel => "2",
    }.to_owned());
    /// Maximum distance from the roundel that the drone hovers over, 0.1 to 5 m; 1 m by default.
    HoveringRangeM(f64) = "control:hovering_range", Session, |key, m| milli(key, *m, 0.1, 5.0);
    /// Camera of the video stream.
    VideoChannel(Camera) = "video:video_channel", Session, |_, camera| Ok(match camera {
        Camera::Front => "0",
        Camera::Bottom => "1",
    }.to_owned());
    /// Video frames per second, 15 to 30. Needs custom identities.
    VideoFramesPerSecond(u32) = "video:codec_fps", Session, |key, fps| whole(key, *fps, 15, 30);
    /// What determines the bit rate of the video; off by default. Needs custom identities.
    VideoBitRateControl(BitRateControl) = "video:bitrate_ctrl_mode", Application, |_, control| Ok(match control {
        BitRateControl::Off => "0",
        BitRateControl::Dynamic => "1",
        BitRateControl::Manual => "2",
    }.to_owned());
    /// Highest bit rate of the video, unless it is controlled manually, 250 to 4000 kbit/s; 1000 kbit/s by default. Needs
    /// custom identities.
    VideoMaxBitRateKbitS(u32) = "video:max_bitrate", Session, |key, rate| whole(key, *rate, 250, 4000);
    /// Bit rate of the video if it is controlled manually, 250 to 4000 kbit/s; 1000 kbit/s by default. Needs custom
    /// identities.
    VideoBitRateKbitS(u32) = "video:bitrate", Application, |key, rate| whole(key, *rate, 250, 4000);
    /// Whether video is recorded to a USB key.
    VideoOnUsb(bool) = "video:video_on_usb", Common, |_, on| flag(*on);
    /// What the cameras look for; nothing by default.
    DetectType(Detection) = "detect:detect_type", Session, |_, detection| Ok(match detection {
        Detection::None => "3",
        Detection::Selected => "10",
        Detection::OrientedRoundel => "12",
        Detection::VisionV2 => "13",
    }.to_owned());
    /// Tags for the front camera, a bit mask: kind `k` is bit `k - 1`, the black and white oriented roundel bit 7. It counts
    /// with [`Detection::Selected`]. The same kind must not be selected for both cameras.
    DetectionsFront(u32) = "detect:detections_select_h", Session, |_, bits| Ok(bits.to_string());
    /// Tags for the bottom camera in each of its pictures, at 60 Hz, with the bits of [`Setting::DetectionsFront`].
    DetectionsBottom(u32) = "detect:detections_select_v", Session, |_, bits| Ok(bits.to_string());
    /// Tags for the bottom camera in step with the front camera, at 30 Hz, with the bits of [`Setting::DetectionsFront`]. Set
    /// this one or [`Setting::DetectionsBottom`], not both.
    DetectionsBottomInStep(u32) = "detect:detections_select_v_hsync", Session, |_, bits| Ok(bits.to_string());
    /// Colours of the tags on the other drones' hulls; orange and green by default.
    EnemyColors(EnemyColors) = "detect:enemy_colors", Common, |_, colors| Ok(match colors {
        EnemyColors::Green => "1",
        EnemyColors::Yellow => "2",
        EnemyColors::Blue => "3",
    }.to_owned());
    /// Whether the ultrasound uses 22.22 Hz instead of 25 Hz, so that two drones near each other do not
    /// interfere.
    SlowUltrasound(bool) = "pic:ultrasound_freq", Common, |_, slow| {
        Ok(if *slow { "7" } else { "8" }.to_owned())
    };
    /// Name of the drone's Wi-Fi network after its next start: 1 to 32 characters of printable ASCII without quotation marks.
    NetworkName(String) = "network:ssid_single_player", Common, |key, name| {
        (1..=LONGEST_NETWORK_NAME).contains(&name.len()).then(|| name.clone()).ok_or(SettingError::NetworkName { key })
    };
}

#[allow(clippy::unnecessary_wraps, reason = "one signature for all kinds of values")]
fn flag(on: bool) -> Result<String, SettingError> {
    Ok(if on { "TRUE" } else { "FALSE" }.to_owned())
}

/// Formats with a decimal point whatever the locale; a decimal comma would make the drone drop its tilt setting.
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

/// Formats as whole thousandths, which the drone expects.
fn milli(key: &'static str, value: f64, from: f64, to: f64) -> Result<String, SettingError> {
    number(key, value, from, to)?;
    Ok((value * 1000.0).round().to_string())
}

/// Formats in radians, which the drone expects.
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
            (Setting::VideoBitRateControl(BitRateControl::Manual), "video:bitrate_ctrl_mode", "2"),
            (Setting::VideoBitRateKbitS(250), "video:bitrate", "250"),
            (Setting::VideoMaxBitRateKbitS(4000), "video:max_bitrate", "4000"),
            (Setting::SlowUltrasound(false), "pic:ultrasound_freq", "8"),
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
            Setting::VideoBitRateKbitS(249),
            Setting::VideoMaxBitRateKbitS(4_000_000),
            Setting::NavdataOptions(vec![28]),
            Setting::NetworkName("a\"b".to_owned()),
            Setting::NetworkName("a".repeat(33)),
            Setting::NetworkName(String::new()),
        ] {
            assert!(setting.config().is_err(), "{setting:?}");
        }
        let error = Setting::EulerAngleMaxDeg(45.0).config().unwrap_err();
        assert_eq!(error.to_string(), "control:euler_angle_max takes 0 to 30, not 45");
    }
}
