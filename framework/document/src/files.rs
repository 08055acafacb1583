//! The only module that opens files of users: regular files with a limited length.
//! A [`FileSource`] replaces the disk by texts in memory, an archive or a database.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::{File, FileType};
use std::io::{Error, ErrorKind, Read as _, Result};
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::did_you_mean;

/// Maximum length of a description, study, input of `eval` or template of a report. \[byte\]
///
/// The tree of a text needs about fifty times its length.
pub const LONGEST_TEXT: u64 = 4 << 20;

/// Maximum length of a data file: measured points, series, tables, catalogues. \[byte\]
///
/// The cells of a table need up to twenty times the length of its text.
pub const LONGEST_DATA: u64 = 256 << 20;

/// Where the files that documents name are read from. The readers of gearboxes and studies read through it only.
pub trait FileSource: fmt::Debug + Send + Sync {
    /// The bytes of a file of at most `longest` bytes. The path is that of the document's folder, joined with the name in the
    /// document.
    ///
    /// # Errors
    /// The reason why the file cannot be read, such as that there is none or that it is longer.
    fn read(&self, path: &Path, longest: u64) -> Result<Vec<u8>>;

    /// The text of a file of at most `longest` bytes.
    ///
    /// # Errors
    /// As [`FileSource::read`], or that it is no UTF-8.
    fn read_text(&self, path: &Path, longest: u64) -> Result<String> {
        text_from(self.read(path, longest)?)
    }

    /// The names of the files in a folder, not of those in folders below it, in order.
    ///
    /// # Errors
    /// The reason why the folder cannot be listed; without an own implementation, that it never can.
    fn list(&self, _folder: &Path) -> Result<Vec<String>> {
        Err(Error::new(ErrorKind::Unsupported, "folders cannot be listed here"))
    }
}

/// The names of the files in a folder of the system, in order; names that are no text are left out.
///
/// # Errors
/// Errors of the system.
pub fn list_folder(folder: &Path) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        if entry.path().is_file()
            && let Ok(name) = entry.file_name().into_string()
        {
            names.push(name);
        }
    }
    names.sort();
    Ok(names)
}

/// A [`FileSource`] that documents share.
pub type SharedSource = Arc<dyn FileSource>;

/// The files of the system: regular files of a stated length.
#[derive(Debug, Clone, Copy, Default)]
pub struct Disk;

impl Disk {
    /// The files of the system, to be shared.
    pub fn shared() -> SharedSource {
        Arc::new(Self)
    }
}

impl FileSource for Disk {
    fn read(&self, path: &Path, longest: u64) -> Result<Vec<u8>> {
        read_bytes(path, longest)
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        list_folder(folder)
    }
}

/// Files in memory, by path. Nothing else can be read.
///
/// ```
/// use std::path::Path;
/// use gearloss_document::files::{FileSource, InMemory};
///
/// let files = InMemory::new([("data/rig.csv", "torque,speed\n1,2\n")]);
/// assert!(files.read_text(Path::new("./data/rig.csv"), 1000).is_ok());
/// assert!(files.read_text(Path::new("/etc/hostname"), 1000).is_err());
/// ```
#[derive(Clone, Default)]
pub struct InMemory(BTreeMap<PathBuf, Vec<u8>>);

impl InMemory {
    /// Files with their content.
    pub fn new<P: AsRef<Path>, B: Into<Vec<u8>>>(files: impl IntoIterator<Item = (P, B)>) -> Self {
        let mut new = Self::default();
        for (path, content) in files {
            new.add(path, content);
        }
        new
    }

    /// The files, to be shared by documents.
    pub fn shared(self) -> SharedSource {
        Arc::new(self)
    }

    /// Adds a file, or replaces the one of that path.
    pub fn add(&mut self, path: impl AsRef<Path>, content: impl Into<Vec<u8>>) {
        self.0.insert(without_dots(path.as_ref()), content.into());
    }
}

/// Paths and lengths, because contents are long.
impl fmt::Debug for InMemory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map()
            .entries(self.0.iter().map(|(path, bytes)| (path, bytes.len())))
            .finish()
    }
}

impl FileSource for InMemory {
    fn read(&self, path: &Path, longest: u64) -> Result<Vec<u8>> {
        let bytes = self.0.get(&without_dots(path));
        let bytes = bytes.ok_or_else(|| {
            let files = self.list(folder_of(path)).unwrap_or_default();
            missing("there is no such file in memory", path, &files)
        })?;
        within(bytes.len() as u64, longest)?;
        Ok(bytes.clone())
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        let folder = without_dots(folder);
        let names = self.0.keys().filter(|path| path.parent() == Some(&folder));
        let names: Vec<String> = names
            .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
            .collect();
        if names.is_empty() {
            return Err(Error::new(ErrorKind::NotFound, "there is no such folder in memory"));
        }
        Ok(names)
    }
}

/// The files of another source, of which those that were read are kept: what a second process needs to read the same documents.
#[derive(Debug)]
pub struct Recorder {
    source: SharedSource,
    read: Mutex<InMemory>,
}

impl Recorder {
    /// Keeps what is read from a source.
    pub fn new(source: SharedSource) -> Self {
        Self {
            source,
            read: Mutex::default(),
        }
    }

    /// The files that were read so far, with their contents.
    pub fn files(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.0
            .iter()
            .map(|(path, bytes)| (path.clone(), bytes.clone()))
            .collect()
    }
}

impl FileSource for Recorder {
    fn read(&self, path: &Path, longest: u64) -> Result<Vec<u8>> {
        let bytes = self.source.read(path, longest)?;
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.add(path, bytes.as_slice());
        Ok(bytes)
    }

    fn list(&self, folder: &Path) -> Result<Vec<String>> {
        self.source.list(folder)
    }
}

/// A path without `.`, and without `..` where a folder is before it.
pub fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if plain.file_name().is_some() => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

/// Opens a file for reading. A link to a file is followed.
///
/// # Errors
/// Errors of the system, or if it is not a regular file: a device may be endless, and a pipe may block.
pub fn open_regular(path: &Path) -> Result<File> {
    let metadata = std::fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => match list_folder(folder_of(path)) {
            Ok(files) => missing("there is no such file", path, &files),
            Err(fault) if fault.kind() == ErrorKind::NotFound => {
                missing(&format!("there is no folder {}", folder_of(path).display()), path, &[])
            }
            Err(_) => missing("there is no such file", path, &[]),
        },
        _ => error,
    })?;
    // Before opening, because opening a pipe waits for its writer.
    regular(metadata.file_type())?;
    let file = File::open(path)?;
    regular(file.metadata()?.file_type())?;
    Ok(file)
}

/// The folder of a file.
fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    folder.unwrap_or(Path::new("."))
}

/// The reason why a file is not found, with the file of its folder that may be meant.
fn missing(reason: &str, path: &Path, files: &[String]) -> Error {
    let meant = path.file_name().and_then(|name| similar(name.to_str()?, files));
    let meant = meant.map_or_else(String::new, |meant| format!("; did you mean `{meant}`?"));
    Error::new(ErrorKind::NotFound, format!("{reason}{meant}"))
}

/// The file that may be meant by a name: of similar spelling, or with an extension that the name lacks.
fn similar<'a>(name: &str, files: &'a [String]) -> Option<&'a str> {
    let extended = files
        .iter()
        .find(|file| Path::new(file).file_stem().is_some_and(|stem| stem == name));
    let extended = extended.map(String::as_str);
    extended.or_else(|| did_you_mean(name, files.iter().map(String::as_str)))
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
    within(told.max(bytes.len() as u64), longest)?;
    Ok(bytes)
}

/// Refuses a file that is too long.
fn within(length: u64, longest: u64) -> Result<()> {
    if length <= longest {
        return Ok(());
    }
    let (size, unit) = if longest < 1 << 20 {
        (1 << 10, "kB")
    } else {
        (1 << 20, "MB")
    };
    let [length, longest] = [length, longest].map(|bytes| bytes.div_ceil(size));
    let message = format!("it has {length} {unit}; at most {longest} {unit} are read");
    Err(Error::other(message))
}

/// The text of a regular file of at most `longest` bytes.
///
/// # Errors
/// As [`read_bytes`], or if it is not UTF-8.
pub fn read_text(path: &Path, longest: u64) -> Result<String> {
    text_from(read_bytes(path, longest)?)
}

fn text_from(bytes: Vec<u8>) -> Result<String> {
    String::from_utf8(bytes).map_err(|_| Error::new(ErrorKind::InvalidData, "it is not UTF-8 text"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn recorded_files_can_be_read_without_their_source() {
        let source = InMemory::new([("gears/a.yaml", "a"), ("b.csv", "b")]).shared();
        let recorder = Recorder::new(source);
        assert!(recorder.read(Path::new("gears/../gears/a.yaml"), 9).is_ok());
        assert!(recorder.read(Path::new("c"), 9).is_err());
        let again = InMemory::new(recorder.files());
        assert_eq!(again.read(Path::new("gears/a.yaml"), 9).unwrap(), b"a");
        assert!(again.read(Path::new("b.csv"), 9).is_err(), "it was not read before");
    }

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
        assert_eq!(refused(&file), "it has 1 kB; at most 1 kB are read");
        std::fs::write(&file, [0xff]).unwrap();
        assert_eq!(refused(&file), "it is not UTF-8 text");
        assert_eq!(refused(&folder), "it is a folder, not a file");
        assert_eq!(refused(folder.join("nowhere")), "there is no such file");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn files_in_memory_are_found_by_any_spelling_of_their_path() {
        let files = InMemory::new([("./cases/../rig.csv", "a,b")]);
        assert_eq!(files.read_text(Path::new("rig.csv"), 16).unwrap(), "a,b");
        assert_eq!(files.read_text(Path::new("cases/./../rig.csv"), 16).unwrap(), "a,b");
        assert_eq!(
            files.read(Path::new("rig"), 16).unwrap_err().kind(),
            ErrorKind::NotFound
        );
        let long = files.read(Path::new("rig.csv"), 2).unwrap_err().to_string();
        assert_eq!(long, "it has 1 kB; at most 1 kB are read");
    }

    #[test]
    fn a_missing_file_names_the_one_that_may_be_meant() {
        let folder = std::env::temp_dir().join(format!("gearloss-similar-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let texts = [("gearbox.yaml", "a"), ("rig_2.csv", "b")];
        let memory = InMemory::new(texts);
        for (name, text) in texts {
            std::fs::write(folder.join(name), text).unwrap();
        }
        for (wrong, meant) in [
            ("gearbx.yaml", Some("gearbox.yaml")),
            ("gearbox.yml", Some("gearbox.yaml")),
            ("gearbox", Some("gearbox.yaml")),
            ("rig_3.csv", None),
            ("study.yaml", None),
        ] {
            let help = meant.map_or_else(String::new, |meant| format!("; did you mean `{meant}`?"));
            assert_eq!(refused(folder.join(wrong)), format!("there is no such file{help}"));
            let in_memory = memory.read(Path::new(wrong), 16).unwrap_err().to_string();
            assert_eq!(in_memory, format!("there is no such file in memory{help}"));
        }
        std::fs::remove_dir_all(&folder).unwrap();
        let without_folder = refused(folder.join("gearbox.yaml"));
        assert_eq!(without_folder, format!("there is no folder {}", folder.display()));
    }

    #[test]
    fn files_of_a_folder_are_listed_in_order_and_not_those_below() {
        let texts = [
            ("makers/b.csv", "b"),
            ("makers/a.csv", "a"),
            ("makers/old/c.csv", "c"),
            ("d.csv", "d"),
        ];
        let memory = Recorder::new(InMemory::new(texts).shared());
        let folder = std::env::temp_dir().join(format!("gearloss-list-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("makers/old")).unwrap();
        for (name, text) in texts {
            std::fs::write(folder.join(name), text).unwrap();
        }
        for listed in [memory.list(Path::new("./makers/")), Disk.list(&folder.join("makers/"))] {
            assert_eq!(listed.unwrap(), ["a.csv", "b.csv"]);
        }
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(memory.list(Path::new("nowhere")).is_err() && Disk.list(&folder).is_err());
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
