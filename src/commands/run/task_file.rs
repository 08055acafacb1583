//! Task results in a file, each with its length and hash, so that truncated or changed results are detected.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use gearloss_framework::files::{LONGEST_DATA, open_regular};
use gearloss_studies::engine::head::fnv1a_64;

use super::folder::is_regular;

/// Length and hash of a result before its place and its bytes.
const HEAD: usize = 16;

/// Part, stage and number of a task, which precede its bytes.
pub type Place = [usize; 3];

/// Length of a place.
const TASK: usize = 24;

/// The results of one analysis.
pub struct TaskFile {
    file: File,
    path: PathBuf,
    end: u64,
    /// Where the result of a task begins.
    places: BTreeMap<Place, u64>,
}

impl TaskFile {
    /// Opens a file for continuation; bytes after its last complete result are overwritten.
    pub fn reopen(path: &Path) -> io::Result<Self> {
        is_regular(path)?;
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false).open(path)?;
        let file = Self::scanned(file, path)?;
        file.file.set_len(file.end)?;
        Ok(file)
    }

    /// Opens a file for reading.
    pub fn read_only(path: &Path) -> io::Result<Self> {
        Self::scanned(open_regular(path)?, path)
    }

    fn scanned(file: File, path: &Path) -> io::Result<Self> {
        let mut reopened = Self {
            file,
            path: path.to_owned(),
            end: 0,
            places: BTreeMap::new(),
        };
        while let Some(bytes) = reopened.read_at(reopened.end)? {
            let place = [0, 8, 16].map(|from| little(&bytes[from..from + 8]) as usize);
            reopened.places.insert(place, reopened.end);
            reopened.end += (HEAD + bytes.len()) as u64;
        }
        Ok(reopened)
    }

    /// Number of results.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether it holds the result of a task.
    pub fn holds(&self, task: Place) -> bool {
        self.places.contains_key(&task)
    }

    /// Adds the result of a task.
    pub fn append(&mut self, task: Place, result: &[u8]) -> io::Result<()> {
        let mut bytes = vec![0; HEAD];
        bytes.extend(task.iter().flat_map(|number| (*number as u64).to_le_bytes()));
        bytes.extend_from_slice(result);
        let (head, body) = bytes.split_at_mut(HEAD);
        head[..8].copy_from_slice(&(body.len() as u64).to_le_bytes());
        head[8..].copy_from_slice(&fnv1a_64(body).to_le_bytes());
        self.file.seek(SeekFrom::Start(self.end))?;
        self.file.write_all(&bytes)?;
        self.places.insert(task, self.end);
        self.end += bytes.len() as u64;
        Ok(())
    }

    /// The result of a task that it holds.
    pub fn read(&mut self, task: Place) -> io::Result<Vec<u8>> {
        let place = self.places.get(&task).copied();
        let changed = || io::Error::other(format!("{} was changed while it was read", self.path.display()));
        let place = place.ok_or_else(changed)?;
        let bytes = self.read_at(place)?;
        let changed = || io::Error::other(format!("{} was changed while it was read", self.path.display()));
        Ok(bytes.ok_or_else(changed)?.split_off(TASK))
    }

    /// Task and result at an offset; absent if no complete result starts there.
    fn read_at(&mut self, place: u64) -> io::Result<Option<Vec<u8>>> {
        let whole = self.file.metadata()?.len();
        if place + (HEAD + TASK) as u64 > whole {
            return Ok(None);
        }
        let mut head = [0; HEAD];
        self.file.seek(SeekFrom::Start(place))?;
        self.file.read_exact(&mut head)?;
        let [length, hash] = [&head[..8], &head[8..]].map(little);
        if length < TASK as u64 || length > LONGEST_DATA.min(whole - place - HEAD as u64) {
            return Ok(None);
        }
        let mut bytes = vec![0; length as usize];
        self.file.read_exact(&mut bytes)?;
        Ok(Some(bytes).filter(|bytes| fnv1a_64(bytes) == hash))
    }
}

/// A little-endian number of eight bytes.
fn little(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(bytes.try_into().unwrap_or_default())
}
