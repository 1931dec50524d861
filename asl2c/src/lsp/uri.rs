//! Paths of files as URIs and back.

use std::path::{Component, Path, PathBuf};

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

/// What is not escaped in a path.
const ESCAPED: &AsciiSet =
    &NON_ALPHANUMERIC.remove(b'/').remove(b'-').remove(b'.').remove(b'_').remove(b'~');

/// The path of a file; `None` if the URI is not that of a file.
pub(super) fn path_of(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file://")?;
    let (_host, path) = rest.split_at(rest.find('/')?);
    let path = percent_decode_str(path).decode_utf8().ok()?;
    // On Windows `/c:/x` is `c:/x`.
    let drive = path.as_bytes().get(2) == Some(&b':');
    let path = if drive && cfg!(windows) { &path[1..] } else { &path[..] };
    Some(plain(Path::new(path)))
}

/// The URI of a file.
pub(super) fn uri_of(path: &Path) -> String {
    let path = path.to_string_lossy().replace('\\', "/");
    let root = if path.starts_with('/') { "" } else { "/" };
    format!("file://{root}{}", utf8_percent_encode(&path, ESCAPED))
}

/// A path without `.` and `..`, as far as that is possible without the file system.
pub(super) fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if plain.file_name().is_some() => _ = plain.pop(),
            _ => plain.push(part),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_path_is_the_same_there_and_back() {
        for path in ["/a/b.asl", "/a b/ü%20.conf", "/a/#?.asl", "/日本/x.asl"] {
            let uri = uri_of(Path::new(path));
            assert!(uri.is_ascii() && !uri.contains([' ', '#', '?']), "{uri}");
            assert_eq!(path_of(&uri), Some(PathBuf::from(path)));
        }
        assert_eq!(path_of("file:///a/./b/../c%2easl"), Some(PathBuf::from("/a/c.asl")));
        assert_eq!(path_of("file://localhost/a"), Some(PathBuf::from("/a")));
        for other in ["untitled:Untitled-1", "file:", "file://host", "", "file:///%ff"] {
            assert_eq!(path_of(other), None, "{other}");
        }
    }
}
