//! Keys and values of AT*CONFIG.

use std::fmt;
use std::time::Duration;

use super::animation::{FlightAnimation, Hertz, LedAnimation};

/// A configuration key and its value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Config {
    key: String,
    value: String,
}

/// Why a configuration key or value cannot be sent.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// The key is not `section:name`.
    #[error("configuration key `{key}` is not of the form section:name")]
    Key {
        /// The key.
        key: String,
    },
    /// The key or the value contains a quotation mark, or a byte that is no printable ASCII.
    #[error("`{text}` contains a character that AT commands cannot carry")]
    Character {
        /// The text.
        text: String,
    },
    /// The text is longer than any value that the drone accepts.
    #[error("`{text}` is longer than {limit} bytes")]
    Length {
        /// The text.
        text: String,
        /// The maximum length in bytes.
        limit: usize,
    },
}

impl Config {
    const MAX_TEXT_BYTES: usize = 256;

    /// A setting of `key` (`section:name`) to `value`.
    ///
    /// # Errors
    /// [`ConfigError`] if either cannot be carried by an AT command.
    pub fn new(key: impl Into<String>, value: impl fmt::Display) -> Result<Self, ConfigError> {
        let (key, value) = (key.into(), value.to_string());
        let well_formed = key
            .split_once(':')
            .is_some_and(|(section, name)| !section.is_empty() && !name.is_empty());
        if !well_formed {
            return Err(ConfigError::Key { key });
        }
        for text in [&key, &value] {
            if text.bytes().any(|byte| byte == b'"' || !(b' '..=b'~').contains(&byte)) {
                return Err(ConfigError::Character { text: text.clone() });
            }
            if text.len() > Self::MAX_TEXT_BYTES {
                return Err(ConfigError::Length {
                    text: text.clone(),
                    limit: Self::MAX_TEXT_BYTES,
                });
            }
        }
        Ok(Self { key, value })
    }

    /// A setting whose text is known to be valid.
    pub(crate) fn plain(key: &'static str, value: String) -> Self {
        Self { key: key.to_owned(), value }
    }

    /// `section:name`
    pub fn key(&self) -> &str {
        &self.key
    }

    /// The value as text.
    pub fn value(&self) -> &str {
        &self.value
    }
}

impl Config {
    /// Starts a flight animation of this duration, which is sent in whole milliseconds.
    pub fn flight_animation(animation: FlightAnimation, duration: Duration) -> Self {
        let value = format!("{},{}", animation.number(), duration.as_millis());
        Self::plain("control:flight_anim", value)
    }

    /// Starts an LED animation with this frequency and duration, of which the whole seconds are sent.
    pub fn led_animation(animation: LedAnimation, frequency: Hertz, duration: Duration) -> Self {
        let bits = frequency.get().to_bits().cast_signed();
        let value = format!("{},{bits},{}", animation.number(), duration.as_secs());
        Self::plain("leds:leds_anim", value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The string that node-ar-drone sends for this setting.
    #[test]
    fn an_led_animation_is_encoded_as_other_clients_encode_it() {
        let frequency = Hertz::new(5.0).unwrap();
        let config =
            Config::led_animation(LedAnimation::RedSnake, frequency, Duration::from_secs(2));
        assert_eq!((config.key(), config.value()), ("leds:leds_anim", "9,1084227584,2"));
        let flip = FlightAnimation::FlipLeft;
        let config = Config::flight_animation(flip, flip.usual_duration());
        assert_eq!((config.key(), config.value()), ("control:flight_anim", "18,15"));
    }
}
