//! Files of results: each is written next to its final path, under a unique name.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, BufWriter};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use gearloss_studies::tasks::StorageError;

use super::folder::{cannot_write, temporary};

/// The result folder and the files written into it.
#[derive(Debug, Default)]
pub struct Files {
    pub folder: PathBuf,
    names: Names,
}

/// Names of files, shared with files that are being written.
type Names = Arc<Mutex<BTreeSet<String>>>;

impl Files {
    pub fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            names: Names::default(),
        }
    }

    /// Whether a file was written, or is being written.
    pub fn has(&self, name: &str) -> bool {
        locked(&self.names).contains(name)
    }
}

fn locked(names: &Names) -> std::sync::MutexGuard<'_, BTreeSet<String>> {
    names.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A file that is written next to its final path and moved there when complete; its name is reserved until then.
pub struct Place {
    name: String,
    names: Names,
    part: PathBuf,
    path: PathBuf,
}

impl Place {
    pub fn new(files: &Files, name: &str) -> Result<(Self, BufWriter<fs::File>), StorageError> {
        // Names of analyses, sets and products are joined with hyphens, which they may contain.
        if !locked(&files.names).insert(name.to_owned()) {
            return Err(StorageError::SameName(name.to_owned()));
        }
        let path = files.folder.join(name);
        let mut place = Self {
            name: name.to_owned(),
            names: Arc::clone(&files.names),
            part: PathBuf::new(),
            path,
        };
        match temporary(&place.path) {
            Ok((part, file)) => {
                place.part = part;
                Ok((place, BufWriter::new(file)))
            }
            Err(e) => Err(place.cannot_write(e)),
        }
    }

    pub fn cannot_write(&self, error: impl Into<io::Error>) -> StorageError {
        cannot_write(&self.path, error)
    }

    /// Moves the complete file to its final path. An existing link there is replaced, not followed.
    pub fn done(mut self, written: io::Result<()>) -> Result<(), StorageError> {
        let moved = written.and_then(|()| fs::rename(&self.part, &self.path));
        moved.map_err(|e| self.cannot_write(e))?;
        self.name.clear();
        Ok(())
    }
}

impl Drop for Place {
    /// Removes an incomplete file and releases its name.
    fn drop(&mut self) {
        if !self.name.is_empty() {
            let _ = fs::remove_file(&self.part);
            locked(&self.names).remove(&self.name);
        }
    }
}
