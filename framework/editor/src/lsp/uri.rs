//! Paths as `file:` addresses.

use std::path::{Path, PathBuf};

/// The path of a `file:` address; `None` for others.
pub fn path(uri: &str) -> Option<PathBuf> {
    let rest = uri.strip_prefix("file://")?;
    // A host may stand before the path; only the own one is meaningful.
    let rest = rest.strip_prefix("localhost").unwrap_or(rest);
    let bytes = rest.as_bytes();
    let mut plain = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let code = (bytes[at] == b'%')
            .then(|| rest.get(at + 1..at + 3))
            .flatten()
            .and_then(|code| u8::from_str_radix(code, 16).ok());
        plain.push(code.unwrap_or(bytes[at]));
        at += if code.is_some() { 3 } else { 1 };
    }
    let text = String::from_utf8(plain).ok()?;
    // `/C:/gears` is a drive of Windows.
    let drive = text.as_bytes().get(2) == Some(&b':') && text.as_bytes().get(1).is_some_and(u8::is_ascii_alphabetic);
    let text = if drive { text.get(1..)? } else { text.as_str() };
    Some(PathBuf::from(text))
}

/// The `file:` address of a path; a path that is already an address stays as it is.
pub fn uri(path: &Path) -> String {
    let text = path.to_string_lossy().replace('\\', "/");
    if text.contains("://") || text.starts_with("untitled:") {
        return text;
    }
    let mut uri = "file://".to_owned();
    if !text.starts_with('/') {
        uri.push('/');
    }
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~/".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_addresses_are_converted_both_ways() {
        for name in ["/home/a b/µ.yaml", "/x/100%/y#z?.yaml"] {
            assert_eq!(path(&uri(Path::new(name))).as_deref(), Some(Path::new(name)));
        }
        assert_eq!(
            path("file:///c%3A/gears/a.yaml"),
            Some(PathBuf::from("c:/gears/a.yaml"))
        );
        assert_eq!(uri(Path::new("c:/gears/a.yaml")), "file:///c%3A/gears/a.yaml");
        assert_eq!(path("untitled:Untitled-1"), None);
        assert_eq!(path("file:///a%zz"), Some(PathBuf::from("/a%zz")));
    }
}
