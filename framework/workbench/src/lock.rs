//! The lock of a folder while a file in it is saved, and what a save that was killed leaves.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Lock file. It exists during a save only; one that is not locked was left by a program that was killed.
const LOCK: &str = ".gearloss-save.lock";

/// Suffix of incomplete files.
const PART: &str = ".part";

/// How long a save waits for that of another program.
const PATIENCE: Duration = Duration::from_secs(5);

/// Time between two tries.
const PAUSE: Duration = Duration::from_millis(2);

/// A folder in which no other program of this kind saves.
pub struct SaveLock {
    path: PathBuf,
    /// False on a file system without locks. Then the look right before a file is replaced has to be enough.
    is_locked: bool,
    /// Unlocked when it is closed, even if the program is killed.
    _file: File,
}

impl SaveLock {
    /// Waits for the lock of a folder.
    ///
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another program holds it for long; if the folder is not writable.
    pub fn take(folder: &Path) -> io::Result<Self> {
        let path = folder.join(LOCK);
        let begun = Instant::now();
        loop {
            if fs::symlink_metadata(&path).is_ok_and(|data| !data.is_file()) {
                let message = format!("{LOCK} is a link or a folder; remove it");
                return Err(io::Error::new(ErrorKind::InvalidInput, message));
            }
            let opened = OpenOptions::new()
                .read(true)
                .write(true)
                .create(true)
                .truncate(false)
                .open(&path);
            let file = opened.or_else(|error| match error.kind() {
                // That of another user, which can be locked all the same.
                ErrorKind::PermissionDenied => File::open(&path).map_err(|_| error),
                _ => Err(error),
            })?;
            let locked = file.try_lock();
            if let Err(TryLockError::WouldBlock) = locked {
                if begun.elapsed() > PATIENCE {
                    let message = "another program is saving in this folder";
                    return Err(io::Error::new(ErrorKind::WouldBlock, message));
                }
                std::thread::sleep(PAUSE);
            } else if is_present(&file, &path) {
                // Otherwise the program that held the lock has removed the file since it was opened here.
                return Ok(Self {
                    path,
                    is_locked: locked.is_ok(),
                    _file: file,
                });
            }
        }
    }

    /// Removes incomplete files: nobody else is writing one.
    pub fn clean(&self) {
        if !self.is_locked {
            return;
        }
        for path in parts(self.path.parent().unwrap_or(Path::new("."))) {
            let _ = fs::remove_file(path);
        }
    }
}

impl Drop for SaveLock {
    fn drop(&mut self) {
        // Where files have no number, another program might lock the removed one: there it stays.
        if cfg!(unix) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Whether an open file is the one of a path.
#[cfg(unix)]
fn is_present(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let number = |data: fs::Metadata| (data.dev(), data.ino());
    let locked = file.metadata().map(number);
    locked.is_ok_and(|locked| fs::symlink_metadata(path).is_ok_and(|data| number(data) == locked))
}

/// Elsewhere the file is never removed.
#[cfg(not(unix))]
fn is_present(_: &File, _: &Path) -> bool {
    true
}

/// The incomplete file next to a file.
pub fn part_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}{PART}", std::process::id()))
}

/// Whether saves that were killed have left something in a folder.
pub fn has_left(folder: &Path) -> bool {
    (cfg!(unix) && folder.join(LOCK).is_file()) || parts(folder).next().is_some()
}

/// Incomplete files of a folder.
fn parts(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let parts = entries.filter(|entry| {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        is_file && entry.file_name().to_str().is_some_and(is_part)
    });
    parts.map(|entry| entry.path())
}

/// True for `.NAME.PROCESS.part` of a document; other files with that suffix belong to the user.
fn is_part(name: &str) -> bool {
    let inner = name.strip_prefix('.').and_then(|name| name.strip_suffix(PART));
    inner
        .and_then(|inner| inner.rsplit_once('.'))
        .is_some_and(|(name, process)| {
            let is_number = !process.is_empty() && process.bytes().all(|digit| digit.is_ascii_digit());
            is_number && crate::store::check_name(name).is_ok()
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn incomplete_files_are_those_of_documents() {
        assert!(is_part(".gearbox.yaml.4242.part") && is_part(".größe 2.csv.1.part"));
        for name in [
            "gearbox.yaml.1.part",
            ".gearbox.yaml.part",
            ".gearbox.yaml.x1.part",
            ".notes.txt.1.part",
            ".1.part",
            ".part",
        ] {
            assert!(!is_part(name), "{name}");
        }
        assert!(is_part(
            part_of(Path::new("a/gearbox.yaml"))
                .file_name()
                .and_then(|name| name.to_str())
                .unwrap_or_default()
        ));
    }
}
