//! Texts that are not saved, kept for a page after a reload or a restart of the program.
//!
//! They are files that only the user may read. In the storage of the browser they would belong to the address of the page, and another user of the
//! computer may take its port once the program has ended.

use serde::{Deserialize, Serialize};

/// A text that is not saved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Draft {
    /// File.
    pub file: String,
    /// Text.
    pub text: String,
    /// Hash of the file on the disk from which the text was made; absent for a new file.
    pub hash: Option<String>,
    /// Text of that file, for a merge.
    pub base: String,
    /// When the text was kept. [ms since 1970]
    pub time: f64,
}

/// A draft that is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptDraft {
    /// Its name among the drafts.
    pub id: String,
    /// Tab of the browser that kept it.
    pub tab: String,
    /// What it is.
    pub draft: Draft,
}

#[cfg(not(target_family = "wasm"))]
pub use on_disk::{Drafts, state_folder};

#[cfg(not(target_family = "wasm"))]
mod on_disk {
    use std::fs::{self, DirBuilder, File, OpenOptions, TryLockError};
    use std::io::{self, Write as _};
    use std::path::{Path, PathBuf};
    use std::sync::{Mutex, PoisonError};

    use gearloss_framework::files::{LONGEST_TEXT, read_text};
    use gearloss_studies::engine::head::{fnv1a_64, hexadecimal};
    use serde::{Deserialize, Serialize};

    use super::{Draft, KeptDraft};
    use crate::answer::Fault;

    /// Maximum number of drafts of one program.
    const MOST: usize = 200;

    /// Maximum length of a draft: two texts, each of their characters written with up to six.
    const LONGEST: u64 = 12 * LONGEST_TEXT;

    /// Held by a program as long as it runs.
    const LOCK: &str = "lock";

    /// Drafts of one opened folder: a folder for each program that keeps some, with a file for each draft.
    #[derive(Debug)]
    pub struct Drafts {
        /// The opened folder.
        of: String,
        folder: PathBuf,
        /// Name of this program.
        program: String,
        /// Lock of this program; absent before its first draft.
        lock: Mutex<Option<Lock>>,
    }

    /// A lock file that is locked while this lives.
    #[derive(Debug)]
    struct Lock(File);

    impl Drop for Lock {
        fn drop(&mut self) {
            // Closing is not enough: a process that is being started still has a copy of the open file until its own program begins.
            let _ = self.0.unlock();
        }
    }

    /// A draft as a file.
    #[derive(Serialize, Deserialize)]
    struct Record {
        folder: String,
        tab: String,
        draft: Draft,
    }

    impl Drafts {
        /// Below the folder in which the user keeps the states of programs.
        pub fn new(state: &Path, root: &Path) -> Self {
            let of = root.to_string_lossy().into_owned();
            let since = std::time::UNIX_EPOCH.elapsed().unwrap_or_default().as_nanos();
            Self {
                folder: state.join("drafts").join(hexadecimal(fnv1a_64(of.as_bytes()))),
                of,
                program: hexadecimal(fnv1a_64(format!("{} {since}", std::process::id()).as_bytes())),
                lock: Mutex::default(),
            }
        }

        /// Keeps a draft instead of the one that the tab has kept of this file.
        pub fn keep(&self, tab: &str, draft: &Draft) -> Result<String, Fault> {
            if tab.is_empty() || tab.len() > 32 || !tab.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
                return Err(Fault::new("the tab has no name", "load the page again"));
            }
            let name = format!("{tab}-{}", hexadecimal(fnv1a_64(draft.file.as_bytes())));
            let record = Record {
                folder: self.of.clone(),
                tab: tab.to_owned(),
                draft: draft.clone(),
            };
            let written = self.write(&name, &serde_json::to_vec(&record).unwrap_or_default());
            written.map_err(|error| {
                let message = format!("the text of {} cannot be kept: {error}", draft.file);
                Fault::new(message, "save often")
            })?;
            Ok(format!("{}/{name}", self.program))
        }

        fn write(&self, name: &str, record: &[u8]) -> io::Result<()> {
            let folder = self.folder.join(&self.program);
            let mut lock = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
            if lock.is_none() || !folder.is_dir() {
                private_folder(&folder)?;
                let file = private(&folder.join(LOCK))?;
                // On a file system without locks, drafts of a running program are offered, too.
                let _ = file.try_lock();
                *lock = Some(Lock(file));
            }
            let path = folder.join(format!("{name}.json"));
            if !path.exists() && fs::read_dir(&folder)?.count() > MOST {
                return Err(io::Error::other(format!("there are {MOST} others")));
            }
            let part = folder.join(format!("{name}.part"));
            private(&part)?.write_all(record)?;
            fs::rename(part, path)
        }

        /// Forgets a draft.
        pub fn forget(&self, id: &str) -> Result<(), Fault> {
            let is_plain =
                |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'-');
            let Some((program, name)) = id
                .split_once('/')
                .filter(|(program, name)| is_plain(program) && is_plain(name))
            else {
                return Err(Fault::new("there is no such draft", "load the page again"));
            };
            match fs::remove_file(self.folder.join(program).join(format!("{name}.json"))) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    Err(Fault::new(format!("the draft cannot be removed: {error}"), "try again"))
                }
                _ => Ok(()),
            }
        }

        /// Drafts of this program, and of those that have ended.
        pub fn list(&self) -> Vec<KeptDraft> {
            let mut found = Vec::new();
            for entry in fs::read_dir(&self.folder).into_iter().flatten().flatten() {
                let (path, program) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
                let is_own = program == self.program;
                // Held until its drafts are read.
                let lock = File::open(path.join(LOCK)).ok().map(Lock);
                let is_running = lock
                    .as_ref()
                    .is_some_and(|Lock(file)| matches!(file.try_lock(), Err(TryLockError::WouldBlock)));
                if is_running && !is_own {
                    continue;
                }
                let before = found.len();
                for file in fs::read_dir(&path).into_iter().flatten().flatten() {
                    let name = file.file_name().to_string_lossy().into_owned();
                    let record = name.strip_suffix(".json").and_then(|name| {
                        let text = read_text(&file.path(), LONGEST).ok()?;
                        let record: Record = serde_json::from_str(&text).ok()?;
                        Some((name, record)).filter(|(_, record)| record.folder == self.of)
                    });
                    if let Some((name, Record { tab, draft, .. })) = record {
                        found.push(KeptDraft {
                            id: format!("{program}/{name}"),
                            tab,
                            draft,
                        });
                    }
                }
                if found.len() == before && !is_own {
                    // A program that has ended without drafts.
                    let _ = fs::remove_file(path.join(LOCK)).and_then(|()| fs::remove_dir(&path));
                }
            }
            found
        }
    }

    /// Where this user keeps the states of programs; `None` without a home.
    pub fn state_folder() -> Option<PathBuf> {
        let variable = |name: &str| {
            let path = std::env::var_os(name).map(PathBuf::from);
            path.filter(|path| path.is_absolute())
        };
        let state = match std::env::consts::OS {
            "windows" => variable("LOCALAPPDATA"),
            "macos" => std::env::home_dir().map(|home| home.join("Library/Application Support")),
            _ => variable("XDG_STATE_HOME").or_else(|| std::env::home_dir().map(|home| home.join(".local/state"))),
        };
        state
            .filter(|state| state.is_absolute())
            .map(|state| state.join("gearloss"))
    }

    /// A folder that only this user may enter.
    fn private_folder(path: &Path) -> io::Result<()> {
        let mut builder = DirBuilder::new();
        builder.recursive(true);
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
        builder.create(path)
    }

    /// A file that only this user may read, empty.
    fn private(path: &Path) -> io::Result<File> {
        let mut options = OpenOptions::new();
        options.write(true).create(true).truncate(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(path)
    }
}
