//! Files with texts that people write: plans and settings.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::Path;

/// Largest one, larger than any plan that can be flown.
const MOST_BYTES: u64 = 1 << 20;
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// Reads a text; one without an end, as `/dev/zero`, is an error. Invalid UTF-8 becomes replacement characters, which no
/// valid text contains. The mark with which some editors begin a text is none of it.
pub(crate) fn read(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, "it has more than 1 MiB"));
    }
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&bytes);
    Ok(String::from_utf8_lossy(text).into_owned())
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
