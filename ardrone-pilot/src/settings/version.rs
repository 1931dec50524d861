//! The version of a file's format, which may be left out.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// `version = OURS`, which may be left out; any other is refused, because nothing else in such a file can be relied on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "i64", into = "u32")]
pub(crate) struct Version<const OURS: u32>;

/// Reads the text of a file whose field `version` is of this type. Another version is told before all else: the keys of such a
/// file may be unknown.
///
/// # Errors
/// The first place that cannot be read, with line and column.
pub(crate) fn read_versioned<T: DeserializeOwned, const OURS: u32>(
    text: &str,
) -> Result<T, toml::de::Error> {
    #[derive(Deserialize)]
    struct Head<const OURS: u32> {
        #[serde(rename = "version", default)]
        _version: Version<OURS>,
    }
    toml::from_str::<Head<OURS>>(text)?;
    toml::from_str(text)
}

impl<const OURS: u32> Default for Version<OURS> {
    fn default() -> Self {
        Self
    }
}

impl<const OURS: u32> TryFrom<i64> for Version<OURS> {
    type Error = String;

    fn try_from(version: i64) -> Result<Self, String> {
        if version == i64::from(OURS) {
            return Ok(Self);
        }
        Err(format!("version {version} of this file's format: this program reads version {OURS}"))
    }
}

impl<const OURS: u32> From<Version<OURS>> for u32 {
    fn from(_: Version<OURS>) -> Self {
        OURS
    }
}
