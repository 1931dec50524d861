//! The drone's configuration: its keys, the values they accept, and the dump.

use std::collections::BTreeMap;

/// Type of a key's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Flag,
    Integer,
    Float,
    Text,
    /// Cannot be set.
    ReadOnly,
}

use Kind::{Flag, Float, Integer, ReadOnly, Text};

/// Keys of a drone in factory state that clients rely on.
const KEYS: [(&str, Kind, &str); 66] = [
    ("general:num_version_config", ReadOnly, "1"),
    ("general:num_version_mb", ReadOnly, "33"),
    ("general:num_version_soft", ReadOnly, "2.4.8"),
    ("general:drone_serial", ReadOnly, "PS721000AA0A000000"),
    ("general:soft_build_date", ReadOnly, "2013-06-12 11:50"),
    ("general:motor1_soft", ReadOnly, "1.43"),
    ("general:motor2_soft", ReadOnly, "1.43"),
    ("general:motor3_soft", ReadOnly, "1.43"),
    ("general:motor4_soft", ReadOnly, "1.43"),
    ("general:ardrone_name", Text, "Mock AR.Drone"),
    ("general:flying_time", ReadOnly, "0"),
    ("general:navdata_demo", Flag, "FALSE"),
    ("general:navdata_options", Integer, "65537"),
    ("general:com_watchdog", Integer, "2"),
    ("general:video_enable", Flag, "TRUE"),
    ("general:vision_enable", Flag, "TRUE"),
    ("general:vbat_min", ReadOnly, "9000"),
    ("control:accs_offset", ReadOnly, "{ -2.0952554e+03 2.0413781e+03 2.0569382e+03 }"),
    (
        "control:accs_gains",
        ReadOnly,
        "{ 9.8449361e-01 8.2256612e-03 -5.2026059e-03\n-8.2718220e-03 -9.9661934e-01 -9.6353702e-03\n\
         1.5720060e-02 3.7227492e-03 -9.8226988e-01 }",
    ),
    ("control:control_level", Integer, "0"),
    ("control:euler_angle_max", Float, "2.0943999e-01"),
    ("control:altitude_max", Integer, "3000"),
    ("control:altitude_min", Integer, "50"),
    ("control:control_iphone_tilt", Float, "3.4906584e-01"),
    ("control:control_vz_max", Float, "7.0000000e+02"),
    ("control:control_yaw", Float, "1.7453293e+00"),
    ("control:outdoor", Flag, "FALSE"),
    ("control:flight_without_shell", Flag, "FALSE"),
    ("control:autonomous_flight", Flag, "FALSE"),
    ("control:manual_trim", Flag, "FALSE"),
    ("control:indoor_euler_angle_max", Float, "2.0943999e-01"),
    ("control:indoor_control_vz_max", Float, "7.0000000e+02"),
    ("control:indoor_control_yaw", Float, "1.7453293e+00"),
    ("control:outdoor_euler_angle_max", Float, "3.4906584e-01"),
    ("control:outdoor_control_vz_max", Float, "1.0000000e+03"),
    ("control:outdoor_control_yaw", Float, "3.4906585e+00"),
    ("control:flying_mode", Integer, "0"),
    ("control:hovering_range", Integer, "1000"),
    ("control:flight_anim", Text, "0,0"),
    ("network:ssid_single_player", Text, "ardrone2_mock"),
    ("network:wifi_mode", Integer, "0"),
    ("network:owner_mac", Text, "00:00:00:00:00:00"),
    ("network:passkey", Text, ""),
    ("pic:ultrasound_freq", Integer, "8"),
    ("pic:pic_version", ReadOnly, "184877090"),
    ("video:codec_fps", Integer, "30"),
    ("video:video_codec", Integer, "129"),
    ("video:video_channel", Integer, "0"),
    ("video:bitrate", Integer, "1000"),
    ("video:max_bitrate", Integer, "1000"),
    ("video:bitrate_ctrl_mode", Integer, "0"),
    ("video:video_on_usb", Flag, "TRUE"),
    ("leds:leds_anim", Text, "0,0,0"),
    ("detect:enemy_colors", Integer, "1"),
    ("detect:detect_type", Integer, "3"),
    ("detect:detections_select_h", Integer, "0"),
    ("detect:detections_select_v", Integer, "0"),
    ("detect:detections_select_v_hsync", Integer, "0"),
    ("userbox:userbox_cmd", Text, "0"),
    ("gps:latitude", Float, "5.0000000000000000e+02"),
    ("gps:longitude", Float, "5.0000000000000000e+02"),
    ("gps:altitude", Float, "0.0000000000000000e+00"),
    ("custom:application_id", Text, "00000000"),
    ("custom:profile_id", Text, "00000000"),
    ("custom:session_id", Text, "00000000"),
    ("custom:application_desc", Text, "Default application configuration"),
];

/// Limits with an indoor and an outdoor set; the drone uses the active one.
const LIMITS: [&str; 3] = ["euler_angle_max", "control_vz_max", "control_yaw"];

/// Keys that the default configuration does not let be changed: they need identities of their own.
const CUSTOM: [&str; 5] = [
    "video:codec_fps",
    "video:video_codec",
    "video:bitrate",
    "video:max_bitrate",
    "video:bitrate_ctrl_mode",
];
const APPLICATION: &str = "custom:application_id";
const DEFAULT_ID: &str = "00000000";

/// The simulated drone's configuration: the value of each key, as text in the drone's units.
#[derive(Debug, Clone)]
pub(crate) struct ConfigurationStore {
    values: BTreeMap<&'static str, String>,
}

impl Default for ConfigurationStore {
    fn default() -> Self {
        Self { values: KEYS.iter().map(|(key, _, value)| (*key, (*value).to_owned())).collect() }
    }
}

impl ConfigurationStore {
    /// Sets a key like the firmware, which silently ignores unknown keys, unreadable values, read-only keys, and with the
    /// default application those that need one of their own. A limit in use and the one that is kept for indoors or outdoors
    /// follow each other; `control:outdoor` brings the other set into use.
    pub(crate) fn set(&mut self, key: &str, value: &str) {
        let Some((key, kind, _)) = KEYS.iter().find(|(known, ..)| *known == key) else { return };
        let valid = match kind {
            Flag => matches!(value, "TRUE" | "FALSE"),
            Integer => value.parse::<i64>().is_ok(),
            Float => value.parse::<f64>().is_ok_and(f64::is_finite),
            Text => true,
            ReadOnly => false,
        };
        if !valid || (CUSTOM.contains(key) && self.text(APPLICATION) == Some(DEFAULT_ID)) {
            return;
        }
        self.values.insert(key, value.to_owned());
        if *key == "control:outdoor" {
            for limit in LIMITS {
                self.copy_limit(&self.limit_set(limit), limit, true);
            }
        } else if let Some(limit) = LIMITS.iter().find(|limit| key.ends_with(*limit)) {
            let set = self.limit_set(limit);
            if *key == set {
                self.copy_limit(&set, limit, true);
            } else if *key == format!("control:{limit}") {
                self.copy_limit(&set, limit, false);
            }
        }
    }

    /// The key of a limit in the active set, indoor or outdoor.
    fn limit_set(&self, limit: &str) -> String {
        let place = if self.is_set("control:outdoor") { "outdoor" } else { "indoor" };
        format!("control:{place}_{limit}")
    }

    /// Copies a limit between its set and the active one.
    fn copy_limit(&mut self, set: &str, limit: &str, into_use: bool) {
        let used = format!("control:{limit}");
        let (from, to) = if into_use { (set, used.as_str()) } else { (used.as_str(), set) };
        let value = self.text(from).unwrap_or_default().to_owned();
        if let Some(target) = self.values.get_mut(to) {
            *target = value;
        }
    }

    /// The value of a key as text; `None` for an unknown key.
    pub(crate) fn text(&self, key: &str) -> Option<&str> {
        self.values.get(key).map(String::as_str)
    }

    /// Bit rate of the video, 250 to 4000 kbit/s. That the drone adapts it to its link is not modelled: it is the greatest
    /// then.
    #[cfg(feature = "video")]
    pub(crate) fn video_kbit_s(&self) -> u32 {
        const MANUAL: &str = "2";
        let is_manual = self.text("video:bitrate_ctrl_mode") == Some(MANUAL);
        let key = if is_manual { "video:bitrate" } else { "video:max_bitrate" };
        let rate = self.text(key).and_then(|value| value.parse::<u32>().ok());
        rate.unwrap_or_default().clamp(250, 4000)
    }

    /// Whether a flag is set; an unknown key is not.
    pub(crate) fn is_set(&self, key: &str) -> bool {
        self.text(key) == Some("TRUE")
    }

    /// A number in the drone's unit: millimetres, radians, and their rates. Keys of numbers only ever contain numbers; any
    /// other key is 0.
    pub(crate) fn number(&self, key: &str) -> f64 {
        self.text(key).and_then(|value| value.parse().ok()).unwrap_or(0.0)
    }

    /// The dump for the control port: each key with its value, a matrix over several lines, and a NUL at the end.
    pub(crate) fn dump(&self) -> String {
        let mut dump = String::new();
        for (key, ..) in KEYS {
            dump.extend([key, " = ", self.text(key).unwrap_or_default(), "\n"]);
        }
        dump.push('\0');
        dump
    }

    /// The list of identities for the control port, one of each kind, with a NUL at the end.
    pub(crate) fn identities(&self) -> String {
        let mut list = String::new();
        for (section, key) in [
            ("applis", "custom:application_id"),
            ("profiles", "custom:profile_id"),
            ("sessions", "custom:session_id"),
        ] {
            let id = self.text(key).unwrap_or_default();
            list.extend(["[", section, "]\n", id, ",by a client\r\n"]);
        }
        list.push('\0');
        list
    }
}

#[cfg(test)]
mod tests {
    use ardrone_link::configuration::Configuration;

    use super::*;

    #[test]
    fn what_the_firmware_would_ignore_is_ignored() {
        let mut store = ConfigurationStore::default();
        for (key, value) in [
            ("control:altitude_max", "high"),
            ("control:outdoor", "yes"),
            ("control:euler_angle_max", "NaN"),
            ("general:vbat_min", "1"),
            ("no:key", "1"),
        ] {
            store.set(key, value);
        }
        let dump = store.dump();
        assert_eq!(dump, ConfigurationStore::default().dump());
        assert!(dump.len() > 2000, "longer than one block of a network: {}", dump.len());
        let configuration = Configuration::parse(&dump);
        assert_eq!(configuration.len(), KEYS.len());
        let gains = configuration.get("control:accs_gains").unwrap();
        assert_eq!(gains.split_whitespace().count(), 11, "nine numbers in braces");
    }

    #[cfg(feature = "video")]
    #[test]
    fn the_video_has_the_rate_that_an_application_of_its_own_sets() {
        let mut store = ConfigurationStore::default();
        let mut rate = |key: &str, value: &str| {
            store.set(key, value);
            store.video_kbit_s()
        };
        assert_eq!(rate("video:bitrate_ctrl_mode", "2"), 1000);
        assert_eq!(rate("video:max_bitrate", "2000"), 1000, "the default configuration");
        assert_eq!(rate("custom:application_id", "00000003"), 1000);
        assert_eq!(rate("video:max_bitrate", "2000"), 2000);
        assert_eq!(rate("video:bitrate", "500"), 2000);
        assert_eq!(rate("video:bitrate_ctrl_mode", "2"), 500);
        assert_eq!(rate("video:bitrate", "9000"), 4000);
        assert_eq!(rate("video:bitrate_ctrl_mode", "1"), 2000);
    }

    #[test]
    fn limits_are_kept_for_indoors_and_outdoors() {
        let mut store = ConfigurationStore::default();
        store.set("control:euler_angle_max", "0.1");
        store.set("control:outdoor", "TRUE");
        assert_eq!(store.text("control:euler_angle_max"), Some("3.4906584e-01"));
        store.set("control:outdoor_euler_angle_max", "0.3");
        assert_eq!(store.text("control:euler_angle_max"), Some("0.3"));
        store.set("control:indoor_euler_angle_max", "0.15");
        assert_eq!(store.text("control:euler_angle_max"), Some("0.3"));
        store.set("control:outdoor", "FALSE");
        assert_eq!(store.text("control:euler_angle_max"), Some("0.15"));
        assert!((store.number("control:control_vz_max") - 700.0).abs() < 1e-9);
    }
}
