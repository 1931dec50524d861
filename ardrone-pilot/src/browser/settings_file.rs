//! The settings as the page shows and changes them: those of the file, which apply when the program is started with it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde_json::{Value, json};

use crate::settings::{Described, Settings, SettingsError, with_changes};
use crate::text_file::{self, BYTE_ORDER_MARK};
use crate::whole_file;

/// The `pilot.toml` that the page changes.
#[derive(Debug, Clone)]
pub struct SettingsFile {
    /// Its path. The file need not exist: it has the defaults then.
    pub path: PathBuf,
    /// Whether the program was started with it.
    pub is_used: bool,
    /// Whether a fleet names it, for all of its vehicles: then nothing in it may be one vehicle's.
    pub is_shared: bool,
    /// The settings that are in effect, those of the command line among them.
    pub in_effect: Settings,
}

/// One change at a time reads and writes: the pages of a fleet change one file, and of two changes at once one would be lost.
static CHANGES: Mutex<()> = Mutex::new(());

/// Why settings are not shown or not changed.
#[derive(Debug, thiserror::Error)]
pub(super) enum ChangeError {
    /// The request is no JSON object of sections with values.
    #[error("settings are changed as an object of sections with values: {0}")]
    Meaningless(String),
    /// The file is invalid, or would be with the values.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The settings cannot be written as TOML.
    #[error("settings cannot be written as TOML: {0}")]
    Written(#[from] toml::ser::Error),
    /// The file with this name cannot be read or written.
    #[error("{0}: {1}")]
    File(String, io::Error),
}

impl SettingsFile {
    fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// What was read of the file; nothing if there is none.
    fn read_or_empty<T: Default>(&self, read: io::Result<T>) -> Result<T, ChangeError> {
        match read {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(T::default()),
            read => read.map_err(|error| ChangeError::File(self.name(), error)),
        }
    }

    /// Every setting with its help, range and default, its value in the file, and the one in effect. A file that does not exist
    /// has the defaults.
    ///
    /// # Errors
    /// [`ChangeError`] if the file cannot be read, or is invalid.
    pub(super) fn json(&self) -> Result<Value, ChangeError> {
        let written =
            Settings::parse(&self.name(), &self.read_or_empty(text_file::read(&self.path))?)?
                .described()?;
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

    /// Writes other values, given as JSON such as `{"fence": {"radius_m": 4}}`, whole or not at all. They are in effect
    /// when the program is started with the file.
    ///
    /// # Errors
    /// [`ChangeError`] if they cannot be used, or the file cannot be written.
    pub(super) fn change(&self, text: &str) -> Result<(), ChangeError> {
        let meaningless = |error: serde_json::Error| ChangeError::Meaningless(error.to_string());
        let changes: toml::Table = serde_json::from_str(text).map_err(meaningless)?;
        let system = |error| ChangeError::File(self.name(), error);
        // It guards a file, which is whole whatever has panicked.
        let _one_at_a_time = CHANGES.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes = self.read_or_empty(text_file::read_bytes(&self.path))?;
        let text = std::str::from_utf8(&bytes).map_err(|_| {
            let why = "it is not UTF-8, and would not stay as it is";
            system(io::Error::new(io::ErrorKind::InvalidData, why))
        })?;
        let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        let mark = if text.len() < bytes.len() { BYTE_ORDER_MARK } else { "" };
        let changed = with_changes(&self.name(), text, &changes)?;
        if self.is_shared {
            Settings::parse(&self.name(), &changed)?.for_all(&self.name())?;
        }
        replace(&self.path, &[mark, &changed].concat()).map_err(system)
    }
}

/// Writes a file anew: what a link leads to. A link that leads nowhere is an error.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    let path = match fs::canonicalize(path) {
        Err(_) if !path.is_symlink() => path.to_owned(),
        found => found?,
    };
    whole_file::replace(&path, text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &Path) -> SettingsFile {
        let in_effect = Settings::default();
        SettingsFile { path: path.to_owned(), is_used: true, is_shared: false, in_effect }
    }

    #[test]
    fn what_is_one_vehicles_is_not_written_into_the_settings_of_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("all.toml");
        let file = |is_shared| SettingsFile { is_shared, ..file(&path) };
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

    #[test]
    fn what_cannot_be_written_again_as_it_was_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pilot.toml");
        let text = b"[fence]\nradius_m = 3 # Stra\xdfe\n";
        fs::write(&path, text).unwrap();
        let error = file(&path).change(r#"{"fence":{"radius_m":2}}"#).unwrap_err().to_string();
        assert!(error.contains("not UTF-8"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), text);
    }

    #[test]
    fn of_changes_at_once_none_is_lost() {
        let folder = tempfile::tempdir().unwrap();
        let file = file(&folder.path().join("pilot.toml"));
        let values = [("radius_m", 4.0), ("ceiling_m", 2.0), ("floor_m", 0.4)];
        for _ in 0..20 {
            fs::write(&file.path, "").unwrap();
            std::thread::scope(|scope| {
                for (name, value) in values {
                    let change = format!(r#"{{"fence":{{"{name}":{value}}}}}"#);
                    let file = &file;
                    scope.spawn(move || file.change(&change).unwrap());
                }
            });
            let text = fs::read_to_string(&file.path).unwrap();
            assert!(values.iter().all(|(name, _)| text.contains(name)), "{text}");
        }
    }

    /// A link stays one, and who may read the file may still; its first mark stays, too.
    #[cfg(unix)]
    #[test]
    fn a_file_stays_what_it_was() {
        use std::os::unix::fs::{PermissionsExt as _, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [target, link] = ["all.toml", "pilot.toml"].map(|name| folder.path().join(name));
        fs::write(&target, "\u{feff}[fence]\nradius_m = 3\n").unwrap();
        fs::set_permissions(&target, fs::Permissions::from_mode(0o600)).unwrap();
        symlink(&target, &link).unwrap();
        file(&link).change(r#"{"fence":{"radius_m":2}}"#).unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read_to_string(&target).unwrap(), "\u{feff}[fence]\nradius_m = 2\n");
        assert_eq!(fs::metadata(&target).unwrap().permissions().mode() & 0o777, 0o600);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "no draft is left");
        fs::remove_file(&target).unwrap();
        assert!(file(&link).change(r#"{"fence":{"radius_m":2}}"#).is_err());
        assert!(link.is_symlink() && !target.exists());
    }
}
