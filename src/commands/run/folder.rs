//! The folder of a run: locked by one run at a time, and identified as its own until the run is finished.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Seek as _, Write as _};
use std::path::{Path, PathBuf};

use gearloss_framework::files::{LONGEST_TEXT, read_text};
use gearloss_studies::tasks::StorageError;

use crate::output::Failure;

/// Lock file of a folder while a run writes into it. An unlocked one was left by an interrupted run.
pub const MARK: &str = "unfinished.run";

/// Suffix of incomplete files.
pub const PART: &str = "part";

/// A folder that is locked by this run.
pub struct Held {
    mark: PathBuf,
    /// Unlocked when it is closed, even if the run crashes.
    _file: File,
}

impl Held {
    /// Locks a folder, which is created if needed; returns whether an earlier run in it was interrupted.
    ///
    /// # Errors
    /// If another run writes into it, or if it is not writable.
    pub fn take(folder: &Path) -> Result<(Self, bool), Failure> {
        let mark = folder.join(MARK);
        fs::create_dir_all(folder).map_err(|e| cannot_write(folder, e))?;
        loop {
            let left = is_regular(&mark).map_err(|e| cannot_write(&mark, e))?;
            let opened = OpenOptions::new()
                .read(true)
                .write(true)
                .create(true)
                .truncate(false)
                .open(&mark);
            let mut file = opened.map_err(|e| cannot_write(&mark, e))?;
            let locked = file.try_lock();
            if let Err(TryLockError::WouldBlock) = locked {
                return Err(busy(folder, &mark));
            }
            let token = token();
            let marked = file.set_len(0).and_then(|()| file.rewind());
            let marked = marked.and_then(|()| file.write_all(token.as_bytes()));
            marked.map_err(|e| cannot_write(&mark, e))?;
            // The run that held the lock may have removed the file since it was opened here. A lock that prevents reading also prevents
            // removal.
            match read_text(&mark, LONGEST_TEXT) {
                Ok(text) if text != token => {}
                Err(e) if e.kind() == ErrorKind::NotFound => {}
                _ => {
                    // On a file system without locks the other run may still write, but into files with other names.
                    if left && locked.is_ok() {
                        clear(folder);
                    }
                    return Ok((Self { mark, _file: file }, left));
                }
            }
        }
    }

    /// Marks the run as finished.
    pub fn finish(self) {
        let _ = fs::remove_file(&self.mark);
    }
}

/// True if an earlier run was interrupted or another run is active.
pub fn is_unfinished(folder: &Path) -> bool {
    fs::symlink_metadata(folder.join(MARK)).is_ok_and(|data| data.is_file())
}

/// A text that is unique to this run.
fn token() -> String {
    let since = std::time::UNIX_EPOCH.elapsed().unwrap_or_default();
    format!(
        "process {}, begun {} ns after 1970\n",
        std::process::id(),
        since.as_nanos()
    )
}

fn busy(folder: &Path, mark: &Path) -> Failure {
    let text = read_text(mark, LONGEST_TEXT).unwrap_or_default();
    let process = text.split(',').next().filter(|words| words.starts_with("process "));
    Failure::input(
        format!(
            "another run writes into {}{}",
            folder.display(),
            process.map_or_else(String::new, |process| format!(": {process}"))
        ),
        "wait for it, or choose another folder with -o",
    )
}

/// The error that results cannot be written.
pub fn cannot_write(path: &Path, error: impl Into<io::Error>) -> StorageError {
    StorageError::Write {
        file: path.to_owned(),
        error: error.into(),
    }
}

/// Whether a regular file exists at the path, which may be overwritten.
///
/// # Errors
/// If something else exists there, such as a link.
pub fn is_regular(path: &Path) -> io::Result<bool> {
    match fs::symlink_metadata(path) {
        Ok(data) if data.is_file() => Ok(true),
        Ok(_) => Err(io::Error::other("a link or a folder has this name")),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(false),
        Err(e) => Err(e),
    }
}

/// A new temporary file next to its final path, with a name unique to this run.
pub fn temporary(path: &Path) -> io::Result<(PathBuf, File)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    for number in 0_u32.. {
        let part = path.with_file_name(format!("{name}.{}-{number}.{PART}", std::process::id()));
        // `create_new` never follows a link.
        match OpenOptions::new().read(true).write(true).create_new(true).open(&part) {
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
            made => return made.map(|file| (part, file)),
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

/// Removes incomplete files of an interrupted run; other files with that suffix belong to the user.
fn clear(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = entry.file_name();
        if name.to_str().is_some_and(is_temporary) && is_regular(&path).is_ok_and(|is| is) {
            let _ = fs::remove_file(path);
        }
    }
}

/// Whether [`temporary`] makes names like this: `NAME.PROCESS-NUMBER.part`.
fn is_temporary(name: &str) -> bool {
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    name.strip_suffix(&format!(".{PART}"))
        .and_then(|rest| rest.rsplit_once('.'))
        .and_then(|(_, run)| run.split_once('-'))
        .is_some_and(|(process, number)| is_number(process) && is_number(number))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("gearloss-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        folder
    }

    #[test]
    fn a_folder_is_held_by_one_run_and_known_when_it_was_broken_off() {
        let folder = folder("held");
        let (held, left) = Held::take(&folder).unwrap();
        assert!(!left && is_unfinished(&folder));
        let Err(Failure::Input(refused)) = Held::take(&folder) else {
            panic!("two runs hold one folder");
        };
        let reason = format!(
            "another run writes into {}: process {}",
            folder.display(),
            std::process::id()
        );
        assert!(refused.contains(&reason) || cfg!(windows), "{refused}");
        // Broken off: the lock is gone, the mark is not.
        let (part, _) = temporary(&folder.join("map.csv")).unwrap();
        drop(held);
        let (held, left) = Held::take(&folder).unwrap();
        assert!(left && !part.exists());
        held.finish();
        assert!(!is_unfinished(&folder));
        let (_, left) = Held::take(&folder).unwrap();
        assert!(!left);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn files_that_are_not_whole_never_share_a_name() {
        let folder = folder("parts");
        fs::create_dir_all(&folder).unwrap();
        let parts = [(); 3].map(|()| temporary(&folder.join("map.csv")).unwrap().0);
        assert!(parts[0] != parts[1] && parts[1] != parts[2] && parts[0] != parts[2]);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn an_interrupted_run_leaves_only_its_own_pieces_to_be_removed() {
        let folder = folder("pieces");
        fs::create_dir_all(&folder).unwrap();
        for name in [MARK, "thesis.part", "film.1-a.part", "map.csv.123-0.part"] {
            fs::write(folder.join(name), "").unwrap();
        }
        let (held, left) = Held::take(&folder).unwrap();
        assert!(left);
        held.finish();
        let mut names: Vec<_> = fs::read_dir(&folder).unwrap().map(|e| e.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["film.1-a.part", "thesis.part"]);
        fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed() {
        let folder = folder("links");
        let elsewhere = folder.join("elsewhere");
        fs::create_dir_all(&elsewhere).unwrap();
        fs::write(elsewhere.join("diary"), "dear").unwrap();
        std::os::unix::fs::symlink(elsewhere.join("diary"), folder.join(MARK)).unwrap();
        assert!(Held::take(&folder).is_err());
        assert_eq!(fs::read_to_string(elsewhere.join("diary")).unwrap(), "dear");
        fs::remove_dir_all(&folder).unwrap();
    }
}
