//! Locations of resources.

use alloc::vec::Vec;

/// The path of a `file:` URI; a text without a scheme is a path.
pub fn path_of(uri: &[u8]) -> Option<Vec<u8>> {
    let Some(rest) = uri.strip_prefix(b"file:") else {
        return Some(uri.to_vec());
    };
    // `file:///path`, `file://localhost/path`, `file:/path`.
    let rest = match rest.strip_prefix(b"//") {
        Some(rest) => &rest[rest.iter().position(|byte| *byte == b'/')?..],
        None => rest,
    };
    let digit = |byte: Option<&u8>| char::from(*byte?).to_digit(16);
    let (mut path, mut i) = (Vec::new(), 0);
    while let Some(byte) = rest.get(i) {
        let escape = digit(rest.get(i + 1)).zip(digit(rest.get(i + 2)));
        if let (b'%', Some((high, low))) = (byte, escape) {
            path.push((high * 16 + low) as u8);
            i += 3;
        } else {
            path.push(*byte);
            i += 1;
        }
    }
    // `/C:/folder` of Windows.
    if cfg!(windows) && path.get(2) == Some(&b':') {
        path.remove(0);
    }
    Some(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_spellings_of_a_local_file() {
        let path = |uri: &str| path_of(uri.as_bytes()).map(|path| String::from_utf8_lossy(&path).into_owned());
        for uri in ["file:///a/b%20c", "file:/a/b%20c", "file://localhost/a/b%20c", "/a/b c"] {
            assert_eq!(path(uri).as_deref(), Some("/a/b c"), "{uri}");
        }
        assert_eq!(path("file:///100%/%zz/%4").as_deref(), Some("/100%/%zz/%4"));
        assert_eq!(path("file:///%C3%A4").as_deref(), Some("/\u{e4}"));
        assert_eq!(path("file://host"), None);
    }
}
