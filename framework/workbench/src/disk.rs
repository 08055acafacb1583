//! A folder of the computer. Only what is in it is read and written for the page; what documents name is read as the command line reads
//! it.

use std::fs::{self, Permissions};
use std::io::{self, ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use gearloss_editor::folder;
use gearloss_framework::files::{FileSource, LONGEST_TEXT, SharedSource, read_bytes, read_text};

use crate::answer::Fault;
use crate::store::{Saved, Store, check_name, hash};

/// Maximum depth of the listed folders.
const DEEPEST: usize = 3;

/// A folder.
#[derive(Debug)]
pub struct Folder {
    root: PathBuf,
    first: Option<String>,
    /// Held while a file is saved.
    saving: Mutex<()>,
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
            });
        }
        let name = path.file_name().and_then(|name| name.to_str()).map(str::to_owned);
        let root = path.parent().map(Path::to_owned);
        Ok(Self {
            root: root.ok_or_else(|| io::Error::new(ErrorKind::NotFound, "it has no folder"))?,
            first: name,
            saving: Mutex::default(),
        })
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

    /// Written next to the file and moved there, so that it is never half a file.
    fn save(&self, file: &str, text: &str, known: Option<&str>) -> Result<Saved, Fault> {
        let path = self.path(file)?;
        if text.len() as u64 > LONGEST_TEXT {
            return Err(Fault::new(format!("{file} is too long"), "divide the document"));
        }
        // Two pages may save at the same time: one of them must see what the other has written.
        let _saving = self.saving.lock().unwrap_or_else(PoisonError::into_inner);
        let present = self.text(file)?;
        let now = present.as_deref().map(hash);
        // What is already there needs not be written.
        if present.as_deref() != Some(text) {
            if now.as_deref() != known {
                return Ok(Saved::Changed {
                    text: present,
                    hash: now,
                });
            }
            let written = replace(&path, text);
            written.map_err(|error| {
                Fault::new(
                    format!("cannot write {file}: {error}"),
                    "check the rights of the folder",
                )
            })?;
        }
        Ok(Saved::Saved(hash(text)))
    }

    fn source(&self) -> SharedSource {
        Arc::new(Below(self.root.clone()))
    }
}

/// Replaces a file by another with the same rights, or makes a new one.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    let rights = fs::metadata(path).ok().map(|data| data.permissions());
    if rights.as_ref().is_some_and(Permissions::readonly) {
        return Err(io::Error::new(ErrorKind::PermissionDenied, "the file is read-only"));
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let part = path.with_file_name(format!(".{name}.{}.part", std::process::id()));
    let mut file = fs::OpenOptions::new().write(true).create_new(true).open(&part)?;
    let written = file.write_all(text.as_bytes()).and_then(|()| file.sync_all());
    let kept = written.and_then(|()| rights.map_or(Ok(()), |rights| fs::set_permissions(&part, rights)));
    let moved = kept.and_then(|()| fs::rename(&part, path));
    if moved.is_err() {
        let _ = fs::remove_file(&part);
    }
    moved
}

/// Files relative to a folder.
#[derive(Debug)]
struct Below(PathBuf);

impl FileSource for Below {
    fn read(&self, path: &Path, longest: u64) -> io::Result<Vec<u8>> {
        read_bytes(&self.0.join(path), longest)
    }
}
