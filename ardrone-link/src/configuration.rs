//! The configuration dump of the control port: `section:key = value` lines, terminated by NUL.

use std::collections::BTreeMap;

/// A drone's configuration as it reports it: keys (`section:name`), each with its value as text, in the drone's units.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Configuration {
    values: BTreeMap<String, String>,
}

impl Configuration {
    /// Parses a dump, which may be any text. A line without ` =` continues the value before it, as the drone prints matrices
    /// over several lines. Of a key that occurs twice the last value counts.
    pub fn parse(text: &str) -> Self {
        let mut values = BTreeMap::new();
        let mut last: Option<String> = None;
        for line in text.trim_end_matches('\0').lines() {
            if let Some((key, value)) = line.split_once(" = ").or_else(|| line.split_once(" =")) {
                let key = key.trim().to_owned();
                values.insert(key.clone(), value.trim().to_owned());
                last = Some(key);
            } else if let Some(value) = last.as_ref().and_then(|key| values.get_mut(key)) {
                value.push(' ');
                value.push_str(line.trim());
            }
        }
        Self { values }
    }

    /// The value of `key` (`section:name`) as the drone has printed it; `None` if it has not reported such a key.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.values.get(key).map(String::as_str)
    }

    /// Whether the drone reports `value` for `key`. Two numbers are compared as numbers, because the drone prints `0.2` as
    /// `2.0000000e-01`: they may differ by 1e-5, or by 1e-5 of `value` if its magnitude is above 1. All else is compared
    /// as text.
    pub fn has(&self, key: &str, value: &str) -> bool {
        let Some(reported) = self.get(key) else { return false };
        if reported == value {
            return true;
        }
        match (reported.parse::<f64>(), value.parse::<f64>()) {
            (Ok(reported), Ok(value)) => (reported - value).abs() <= 1e-5 * value.abs().max(1.0),
            _ => false,
        }
    }

    /// Keys and values, in the order of the keys.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> + Clone {
        self.values.iter().map(|(key, value)| (key.as_str(), value.as_str()))
    }

    /// Number of keys.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether nothing was reported.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn any_text_is_read(text in "\\PC*", lines in "([a-z:]{0,4} ?=? ?[a-z{}.]{0,4}\n){0,20}") {
            for dump in [text, lines] {
                let configuration = Configuration::parse(&dump);
                prop_assert!(configuration.len() <= dump.lines().count());
            }
        }
    }

    #[test]
    fn a_dump_is_read_with_its_odd_lines() {
        let dump = "general:num_version_soft = 2.4.8\ncontrol:euler_angle_max = 2.0943999e-01\n\
                    network:passkey = \ncontrol:accs_gains = { 9.8e-01 1.0\n 0.0 1.0\n 0.5 }\n\
                    control:outdoor = FALSE\n\0";
        let configuration = Configuration::parse(dump);
        assert_eq!(configuration.len(), 5);
        assert_eq!(configuration.get("network:passkey"), Some(""));
        assert_eq!(configuration.get("control:accs_gains"), Some("{ 9.8e-01 1.0 0.0 1.0 0.5 }"));
        assert!(configuration.has("control:euler_angle_max", "0.20944"));
        assert!(!configuration.has("control:euler_angle_max", "0.3"));
        assert!(configuration.has("control:outdoor", "FALSE"));
        assert!(!configuration.has("control:missing", "1"));
        let named = Configuration::parse("network:ssid_single_player = nan\n");
        assert!(named.has("network:ssid_single_player", "nan"), "a name, and no number");
    }
}
