//! The settings as the page shows and changes them: those of the file, which apply when the program is started with it.

use std::fs;
use std::io;
use std::path::PathBuf;

use serde_json::{Value, json};

use crate::settings::{Described, Settings, SettingsError, with_changes};
use crate::text_file;

/// The `pilot.toml` that the page changes.
#[derive(Debug, Clone)]
pub struct SettingsFile {
    /// Its path; it need not exist.
    pub path: PathBuf,
    /// Whether the program was started with it.
    pub is_used: bool,
    /// Whether a fleet names it, for all of its vehicles: then nothing in it may be one vehicle's.
    pub is_shared: bool,
    /// The settings that are in effect, of the command line too.
    pub in_effect: Settings,
}

/// Why settings are not shown or changed.
#[derive(Debug, thiserror::Error)]
pub(super) enum ChangeError {
    #[error("settings are changed as an object of sections with values: {0}")]
    Meaningless(String),
    #[error(transparent)]
    Settings(#[from] SettingsError),
    #[error("settings cannot be written as TOML: {0}")]
    Written(#[from] toml::ser::Error),
    #[error("{0}: {1}")]
    File(String, io::Error),
}

impl SettingsFile {
    fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The text of the file; nothing if there is none.
    fn text(&self) -> Result<String, ChangeError> {
        match text_file::read(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
            text => text.map_err(|error| ChangeError::File(self.name(), error)),
        }
    }

    /// Every setting with its value in the file and the one in effect.
    ///
    /// # Errors
    /// [`ChangeError`] if the file cannot be read.
    pub(super) fn json(&self) -> Result<Value, ChangeError> {
        let written = Settings::parse(&self.name(), &self.text()?)?.described()?;
        let in_effect = self.in_effect.described()?;
        let value = |described: &Described| {
            let same = |other: &&Described| {
                (&other.section, &other.name) == (&described.section, &described.name)
            };
            json!({
                "section": described.section,
                "name": described.name,
                "help": described.help,
                "range": described.range,
                "default": described.default,
                "value": described.value,
                "in_effect": in_effect.iter().find(same).map(|other| &other.value),
            })
        };
        Ok(json!({
            "file": self.name(),
            "is_used": self.is_used,
            "is_shared": self.is_shared,
            "settings": written.iter().map(value).collect::<Vec<_>>(),
        }))
    }

    /// Writes other values, `{"fence": {"radius_m": 4}}`, whole or not at all.
    ///
    /// # Errors
    /// [`ChangeError`] if they cannot be used, or the file cannot be written.
    pub(super) fn change(&self, text: &str) -> Result<(), ChangeError> {
        let meaningless = |error: serde_json::Error| ChangeError::Meaningless(error.to_string());
        let changes: toml::Table = serde_json::from_str(text).map_err(meaningless)?;
        let changed = with_changes(&self.name(), &self.text()?, &changes)?;
        if self.is_shared {
            Settings::parse(&self.name(), &changed)?.for_all(&self.name())?;
        }
        let system = |error| ChangeError::File(self.name(), error);
        let mut draft = self.path.clone().into_os_string();
        draft.push(".new");
        fs::write(&draft, changed).map_err(system)?;
        fs::rename(&draft, &self.path).map_err(system)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_one_vehicles_is_not_written_into_the_settings_of_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("all.toml");
        let file = |is_shared| {
            let in_effect = Settings::default();
            SettingsFile { path: path.clone(), is_used: true, is_shared, in_effect }
        };
        let own = r#"{"vehicle":{"name":"x","system":9},"room":{"start":[1,1,0],"peers":[2]}}"#;
        let error = file(true).change(own).unwrap_err().to_string();
        for key in ["vehicle.name", "vehicle.system", "room.start", "room.peers"] {
            assert!(error.contains(&format!("{key} is one vehicle's")), "{error}");
        }
        assert!(!path.exists(), "nothing is written");
        file(true).change(r#"{"fence":{"radius_m":2}}"#).unwrap();
        file(false).change(own).unwrap();
        assert!(fs::read_to_string(&path).unwrap().contains("name = \"x\""));
    }
}
