//! The only module that opens files of users: regular files with a limited length.

use std::fs::{File, FileType};
use std::io::{Error, Read as _, Result};
use std::path::Path;

/// Maximum length of a description, study, input of `eval` or template of a report. \[byte\]
///
/// The tree of a text needs about fifty times its length.
pub const LONGEST_TEXT: u64 = 4 << 20;

/// Maximum length of a data file: measured points, series, tables, catalogues. \[byte\]
///
/// The cells of a table need up to twenty times the length of its text.
pub const LONGEST_DATA: u64 = 256 << 20;

/// Opens a file for reading. A link to a file is followed.
///
/// # Errors
/// Errors of the system, or if it is not a regular file: a device may be endless, and a pipe may block.
pub fn open_regular(path: &Path) -> Result<File> {
    // Before opening, because opening a pipe waits for its writer.
    regular(std::fs::metadata(path)?.file_type())?;
    let file = File::open(path)?;
    regular(file.metadata()?.file_type())?;
    Ok(file)
}

fn regular(kind: FileType) -> Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    let what = if kind.is_dir() {
        "a folder"
    } else {
        "a device or a pipe"
    };
    Err(Error::other(format!("it is {what}, not a file")))
}

/// The bytes of a regular file of at most `longest` bytes.
///
/// # Errors
/// As [`open_regular`], or if it is longer.
pub fn read_bytes(path: &Path, longest: u64) -> Result<Vec<u8>> {
    let file = open_regular(path)?;
    let told = file.metadata()?.len();
    let mut bytes = Vec::new();
    if told <= longest {
        // The reported length of a file may be wrong.
        file.take(longest + 1).read_to_end(&mut bytes)?;
    }
    let length = told.max(bytes.len() as u64);
    if length > longest {
        let [length, longest] = [length, longest].map(|bytes| bytes.div_ceil(1 << 20));
        let message = format!("it has {length} MB; at most {longest} MB are read");
        return Err(Error::other(message));
    }
    Ok(bytes)
}

/// The text of a regular file of at most `longest` bytes.
///
/// # Errors
/// As [`read_bytes`], or if it is not UTF-8.
pub fn read_text(path: &Path, longest: u64) -> Result<String> {
    let bytes = read_bytes(path, longest)?;
    String::from_utf8(bytes).map_err(|_| Error::new(std::io::ErrorKind::InvalidData, "it is not UTF-8 text"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn refused(path: impl AsRef<Path>) -> String {
        read_text(path.as_ref(), 16).unwrap_err().to_string()
    }

    #[test]
    fn only_regular_files_of_a_stated_length_are_read() {
        let folder = std::env::temp_dir().join(format!("gearloss-files-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("text");
        std::fs::write(&file, "sixteen letters.").unwrap();
        assert_eq!(read_text(&file, 16).unwrap(), "sixteen letters.");
        std::fs::write(&file, "seventeen letters").unwrap();
        assert_eq!(refused(&file), "it has 1 MB; at most 1 MB are read");
        std::fs::write(&file, [0xff]).unwrap();
        assert_eq!(refused(&file), "it is not UTF-8 text");
        assert_eq!(refused(&folder), "it is a folder, not a file");
        assert!(refused(folder.join("nowhere")).contains("No such file") || cfg!(windows));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn devices_without_end_are_refused() {
        assert_eq!(refused("/dev/zero"), "it is a device or a pipe, not a file");
    }

    /// A file that says it is empty, and is not.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_is_not_read_beyond_the_limit_whatever_it_says_of_its_length() {
        assert_eq!(std::fs::metadata("/proc/self/environ").unwrap().len(), 0);
        assert!(read_bytes(Path::new("/proc/self/environ"), 1 << 20).is_ok());
        assert!(read_bytes(Path::new("/proc/self/environ"), 1).is_err());
    }
}
