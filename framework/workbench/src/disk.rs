//! A folder of the computer. Only what is in it is read and written for the page; what documents name is read as the command line reads
//! it.

use std::collections::BTreeSet;
use std::fs::{self, Permissions};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use gearloss_editor::folder;
use gearloss_framework::files::{FileSource, LONGEST_TEXT, SharedSource, list_folder, read_bytes, read_text};

use crate::answer::Fault;
use crate::drafts::{Draft, Drafts, KeptDraft};
use crate::lock::{SaveLock, part_of};
use crate::store::{Saved, Store, check_name, check_new_name, hash};

fn no_drafts() -> Fault {
    Fault::new(
        "this computer has no folder for texts that are not saved",
        "save often; to keep them, state a home folder (HOME)",
    )
}

/// Maximum depth of the listed folders.
const DEEPEST: usize = 3;

/// A folder.
#[derive(Debug)]
pub struct Folder {
    root: PathBuf,
    first: Option<String>,
    /// Held while a file is saved.
    saving: Mutex<()>,
    /// Texts that are not saved; absent if they are kept in the page only.
    drafts: Option<Drafts>,
}

impl Folder {
    /// A folder, or the folder of a file, which is then opened first.
    ///
    /// # Errors
    /// If there is no such file or folder.
    pub fn open(path: &Path) -> io::Result<Self> {
        let path = path.canonicalize()?;
        if path.is_dir() {
            let names = ["gearbox.yaml", "study.yaml"];
            let first = names.into_iter().find(|name| path.join(name).is_file());
            return Ok(Self {
                first: first.map(str::to_owned),
                root: path,
                saving: Mutex::default(),
                drafts: None,
            }
            .cleaned());
        }
        let name = path.file_name().and_then(|name| name.to_str()).map(str::to_owned);
        let root = path.parent().map(Path::to_owned);
        Ok(Self {
            root: root.ok_or_else(|| io::Error::new(ErrorKind::NotFound, "it has no folder"))?,
            first: name,
            saving: Mutex::default(),
            drafts: None,
        }
        .cleaned())
    }

    /// Removes what saves that were killed have left in the folders of the listed files.
    fn cleaned(self) -> Self {
        let folders = self.names().into_iter();
        let folders = folders.filter_map(|file| self.root.join(file).parent().map(Path::to_owned));
        let folders: BTreeSet<PathBuf> = folders.chain([self.root.clone()]).collect();
        for folder in folders.iter().filter(|folder| crate::lock::has_left(folder)) {
            if let Ok(lock) = SaveLock::take(folder) {
                lock.clean();
            }
        }
        self
    }

    /// Keeps texts that are not saved in a folder that only this user may read.
    pub fn with_drafts(mut self, state: Option<&Path>) -> Self {
        self.drafts = state.map(|state| Drafts::new(state, &self.root));
        self
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The path of a file, which must be inside of the folder after links are followed.
    fn path(&self, file: &str) -> Result<PathBuf, Fault> {
        check_name(file)?;
        let path = self.root.join(file);
        let folder = path.parent().unwrap_or(&self.root).canonicalize();
        let folder =
            folder.map_err(|error| Fault::new(format!("the folder of {file}: {error}"), "create the folder"))?;
        // A link may lead anywhere.
        let is_link = fs::symlink_metadata(&path).is_ok_and(|data| data.file_type().is_symlink());
        if !folder.starts_with(&self.root) || is_link {
            return Err(Fault::new(
                format!("`{file}` is a link, or in a linked folder"),
                "open the folder that it leads to with `gearloss open`",
            ));
        }
        Ok(path)
    }
}

impl Store for Folder {
    fn name(&self) -> String {
        let name = self.root.file_name().unwrap_or(self.root.as_os_str());
        name.to_string_lossy().into_owned()
    }

    fn first(&self) -> Option<String> {
        self.first.clone()
    }

    fn names(&self) -> Vec<String> {
        let relative = |path: PathBuf| {
            let parts = path.strip_prefix(&self.root).ok()?.components();
            let parts: Option<Vec<&str>> = parts.map(|part| part.as_os_str().to_str()).collect();
            Some(parts?.join("/"))
        };
        // Results of studies are many and nobody edits them.
        let is_result = |path: &PathBuf| path.with_file_name("report.html").exists();
        let files = folder::files(&self.root, DEEPEST).into_iter();
        let files = files.filter(|path| !is_result(path)).filter_map(relative);
        let mut files: Vec<String> = files.collect();
        files.sort();
        files
    }

    fn check(&self, file: &str) -> Result<(), Fault> {
        self.path(file).map(drop)
    }

    fn text(&self, file: &str) -> Result<Option<String>, Fault> {
        match read_text(&self.path(file)?, LONGEST_TEXT) {
            Ok(text) => Ok(Some(text)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(Fault::new(format!("cannot read {file}: {error}"), "check the file")),
        }
    }

    /// Written next to the file and moved there, so that it is never half a file. Other programs of this kind wait meanwhile.
    fn save(&self, file: &str, text: &str, known: Option<&str>) -> Result<Saved, Fault> {
        let path = self.path(file)?;
        if text.len() as u64 > LONGEST_TEXT {
            return Err(Fault::new(format!("{file} is too long"), "divide the document"));
        }
        // Two pages may save at the same time: one of them must see what the other has written.
        let _saving = self.saving.lock().unwrap_or_else(PoisonError::into_inner);
        let cannot_write = |error: io::Error| {
            let help = match error.kind() {
                ErrorKind::WouldBlock => "save again",
                _ => "check the rights of the folder",
            };
            Fault::new(format!("cannot write {file}: {error}"), help)
        };
        // What is already there needs not be written.
        if self.text(file)?.as_deref() == Some(text) {
            return Ok(Saved::Saved(hash(text)));
        }
        let lock = SaveLock::take(path.parent().unwrap_or(&self.root)).map_err(cannot_write)?;
        lock.clean();
        let present = self.text(file)?;
        let is_known = |text: &Option<String>| text.as_deref().map(hash).as_deref() == known;
        let changed = |text: Option<String>| {
            let hash = text.as_deref().map(hash);
            Ok(Saved::Changed { text, hash })
        };
        if !is_known(&present) {
            return changed(present);
        }
        if present.is_none() {
            check_new_name(file, &self.names())?;
        }
        // An editor takes no lock: the last look is right before the file is replaced.
        let replaced = replace(&path, text, || self.text(file).is_ok_and(|text| is_known(&text)));
        if replaced.map_err(cannot_write)? {
            return Ok(Saved::Saved(hash(text)));
        }
        changed(self.text(file)?)
    }

    fn keep(&self, tab: &str, draft: &Draft) -> Result<String, Fault> {
        check_name(&draft.file)?;
        let drafts = self.drafts.as_ref().ok_or_else(no_drafts)?;
        drafts.keep(tab, draft)
    }

    fn forget(&self, id: &str) -> Result<(), Fault> {
        self.drafts.as_ref().map_or(Ok(()), |drafts| drafts.forget(id))
    }

    fn drafts(&self) -> Vec<KeptDraft> {
        self.drafts.as_ref().map(Drafts::list).unwrap_or_default()
    }

    fn source(&self) -> SharedSource {
        Arc::new(Below(self.root.clone()))
    }
}

/// Replaces a file by another with the same rights, or makes a new one. False, and nothing is replaced, if the file is not `current` any
/// more when the new one is complete.
fn replace(path: &Path, text: &str, is_current: impl Fn() -> bool) -> io::Result<bool> {
    let rights = fs::metadata(path).ok().map(|data| data.permissions());
    if rights.as_ref().is_some_and(Permissions::readonly) {
        return Err(io::Error::new(ErrorKind::PermissionDenied, "the file is read-only"));
    }
    let part = part_of(path);
    let mut options = fs::OpenOptions::new();
    options.write(true).create_new(true);
    // What others may not read they may not read meanwhile.
    #[cfg(unix)]
    if rights.is_some() {
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    }
    let mut file = options.open(&part)?;
    let written = file.write_all(text.as_bytes()).and_then(|()| file.sync_all());
    let kept = written.and_then(|()| rights.map_or(Ok(()), |rights| fs::set_permissions(&part, rights)));
    let moved = kept.and_then(|()| {
        let is_current = is_current();
        if is_current {
            fs::rename(&part, path)?;
            sync_folder(path);
        }
        Ok(is_current)
    });
    if !matches!(moved, Ok(true)) {
        let _ = fs::remove_file(&part);
    }
    moved
}

/// Writes the names of a folder to the disk, so that a new file survives a power failure, too. Not every system can.
fn sync_folder(path: &Path) {
    if cfg!(unix)
        && let Some(folder) = path.parent()
    {
        let _ = fs::File::open(folder).and_then(|folder| folder.sync_all());
    }
}

/// Files relative to a folder.
#[derive(Debug)]
struct Below(PathBuf);

impl FileSource for Below {
    fn read(&self, path: &Path, longest: u64) -> io::Result<Vec<u8>> {
        read_bytes(&self.0.join(path), longest)
    }

    fn list(&self, folder: &Path) -> io::Result<Vec<String>> {
        list_folder(&self.0.join(folder))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// An editor that writes while a save is under way keeps its text.
    #[test]
    fn a_file_that_changes_before_it_is_replaced_stays() {
        let folder = std::env::temp_dir().join(format!("gearloss-replace-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("gearbox.yaml");
        fs::write(&path, "old\n").unwrap();
        let is_replaced = replace(&path, "new\n", || {
            fs::write(&path, "of the editor\n").unwrap();
            fs::read_to_string(&path).unwrap() == "old\n"
        });
        assert!(!is_replaced.unwrap());
        assert_eq!(fs::read_to_string(&path).unwrap(), "of the editor\n");
        assert!(replace(&path, "new\n", || true).unwrap());
        assert_eq!(fs::read_to_string(&path).unwrap(), "new\n");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "a temporary file is left");
        fs::remove_dir_all(folder).unwrap();
    }
}
