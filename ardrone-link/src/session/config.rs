//! Configuration of a session.

use std::time::Duration;

use crate::at::{Config, Identity};
use crate::settings::{NavdataMode, Setting, SettingError};

/// Configuration of a session.
#[derive(Debug, Clone)]
pub struct SessionConfig {
    /// Keys set one after the other when the drone is found, each acknowledged. The first must be
    /// `general:navdata_demo`, which ends the bootstrap mode; [`SessionConfig::new`] ensures this.
    pub settings: Vec<Config>,
    /// Custom configuration to be used. Keys outside the common category need one, except the limits and the
    /// cameras, which the default configuration contains too.
    pub identity: Option<Identity>,
    /// Whether the configuration is read back over the control port before the session is ready.
    pub read_back: bool,
    /// Silence after which navdata are requested again; 200 ms by default.
    pub wake_up_interval: Duration,
    /// Silence after which the link counts as lost; 2 s by default, which is also the drone's own limit.
    pub loss_timeout: Duration,
    /// Time in which the drone must have left the ground, after which a take-off order is withdrawn; 8 s by default.
    pub take_off_timeout: Duration,
}

impl Default for SessionConfig {
    fn default() -> Self {
        Self {
            settings: Vec::new(),
            identity: None,
            read_back: false,
            wake_up_interval: Duration::from_millis(200),
            loss_timeout: Duration::from_secs(2),
            take_off_timeout: Duration::from_secs(8),
        }
    }
}

impl SessionConfig {
    /// A configuration whose settings begin with those of [`NavdataMode`]; other fields have their defaults.
    ///
    /// # Errors
    /// [`SettingError`] if a value is out of range or a setting belongs to the [`NavdataMode`].
    pub fn new(navdata: &NavdataMode, settings: &[Setting]) -> Result<Self, SettingError> {
        if let Some(setting) = settings.iter().find(|setting| setting.is_navdata_mode()) {
            return Err(SettingError::Navdata { key: setting.key() });
        }
        let mode = navdata.settings();
        let settings = mode.iter().chain(settings).map(Setting::config);
        Ok(Self { settings: settings.collect::<Result<_, _>>()?, ..Self::default() })
    }
}
