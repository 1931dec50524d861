//! Files with texts that people write: plans and settings.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// Largest one, larger than any plan that can be flown.
const MOST_BYTES: u64 = 1 << 20;
/// The mark with which some editors begin a text.
pub(crate) const BYTE_ORDER_MARK: &str = "\u{feff}";

/// Reads a text, without a [`BYTE_ORDER_MARK`]. Invalid UTF-8 becomes replacement characters.
pub(crate) fn read(path: &Path) -> io::Result<String> {
    let bytes = read_bytes(path)?;
    let text = bytes.strip_prefix(BYTE_ORDER_MARK.as_bytes()).unwrap_or(&bytes);
    Ok(String::from_utf8_lossy(text).into_owned())
}

/// Reads a text as it is stored; one without an end, as `/dev/zero`, is an error.
pub(crate) fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, "it has more than 1 MiB"));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn a_text_without_end_is_not_read() {
        let error = read(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
        assert!(read(Path::new("Cargo.toml")).unwrap().starts_with("[package]"));
    }

    #[test]
    fn a_text_may_begin_with_a_byte_order_mark() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "\u{feff}takeoff\n").unwrap();
        assert_eq!(read(file.path()).unwrap(), "takeoff\n");
    }
}
