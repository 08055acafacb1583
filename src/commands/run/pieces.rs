//! Solved pieces in a file: points of a map that wait for their JSON, and the part of a shard.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use gearloss_framework::files::{LONGEST_DATA, open_regular};
use gearloss_studies::analysis::{Bits, Piece};

use super::folder::{cannot, own, temporary};
use crate::output::Failure;
use gearloss_studies::analyses::head::fnv1a_64;

/// Length and hash before the bytes of a piece.
const HEAD: usize = 16;

/// Where the bytes of a piece begin in their file.
pub type Place = u64;

/// A file of pieces, each behind its length and its hash, so that one that was cut off or changed is told from a whole one.
pub struct PieceFile {
    file: File,
    path: PathBuf,
    end: Place,
    bytes: Vec<u8>,
}

impl PieceFile {
    /// A file to go on with, with the numbers and places of its whole pieces; what follows the last of them is overwritten.
    pub fn reopen(path: PathBuf) -> io::Result<(Self, Vec<(usize, Place)>)> {
        own(&path)?;
        let mut options = OpenOptions::new();
        let file = options
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)?;
        let mut file = Self::at_start(file, path);
        let found = file.scan()?;
        file.file.set_len(file.end)?;
        Ok((file, found))
    }

    /// A file to read only, with the numbers and places of its whole pieces.
    pub fn read_only(path: PathBuf) -> io::Result<(Self, Vec<(usize, Place)>)> {
        let mut file = Self::at_start(open_regular(&path)?, path);
        let found = file.scan()?;
        Ok((file, found))
    }

    /// The piece at a place of a file.
    pub fn at_place(path: &Path, place: Place) -> io::Result<Piece> {
        Self::at_start(open_regular(path)?, path.to_owned()).piece(place)
    }

    fn at_start(file: File, path: PathBuf) -> Self {
        Self {
            file,
            path,
            end: 0,
            bytes: Vec::new(),
        }
    }

    fn scan(&mut self) -> io::Result<Vec<(usize, Place)>> {
        let mut found = Vec::new();
        while let Some(piece) = self.at(self.end)? {
            found.push((piece.number, self.end));
            self.end += (HEAD + self.bytes.len()) as u64;
        }
        Ok(found)
    }

    /// Adds a piece and tells its place.
    pub fn append(&mut self, piece: &Piece<Bits>) -> Result<Place, Failure> {
        self.bytes.clear();
        self.bytes.resize(HEAD, 0);
        piece.write_bits(&mut self.bytes);
        let (head, body) = self.bytes.split_at_mut(HEAD);
        head[..8].copy_from_slice(&(body.len() as u64).to_le_bytes());
        head[8..].copy_from_slice(&fnv1a_64(body).to_le_bytes());
        let place = self.end;
        let written = self.file.seek(SeekFrom::Start(place));
        let written = written.and_then(|_| self.file.write_all(&self.bytes));
        written.map_err(|e| cannot(&self.path, &e))?;
        self.end += self.bytes.len() as u64;
        Ok(place)
    }

    /// The piece at a place.
    pub fn piece(&mut self, place: Place) -> io::Result<Piece> {
        self.at(place)?
            .ok_or_else(|| io::Error::other(format!("{} was changed while it was read", self.path.display())))
    }

    /// The piece at a place; absent where no whole one begins there.
    fn at(&mut self, place: Place) -> io::Result<Option<Piece>> {
        let whole = self.file.metadata()?.len();
        let mut head = [0; HEAD];
        self.bytes.clear();
        if place + HEAD as u64 > whole {
            return Ok(None);
        }
        self.file.seek(SeekFrom::Start(place))?;
        self.file.read_exact(&mut head)?;
        let [length, hash] = [&head[..8], &head[8..]].map(|half| {
            let half: [u8; 8] = half.try_into().unwrap_or_default();
            u64::from_le_bytes(half)
        });
        if length > LONGEST_DATA.min(whole - place - HEAD as u64) {
            return Ok(None);
        }
        self.bytes.resize(length as usize, 0);
        self.file.read_exact(&mut self.bytes)?;
        if fnv1a_64(&self.bytes) != hash {
            return Ok(None);
        }
        let mut from = &self.bytes[..];
        Ok(Piece::read_bits(&mut from).filter(|_| from.is_empty()))
    }
}

/// Pieces that wait in a file of their own until they are written elsewhere; it goes with them.
pub struct Waiting(PieceFile);

impl Waiting {
    /// Pieces of what will stand at a path.
    pub fn new(path: &Path) -> Result<Self, Failure> {
        let (part, file) = temporary(path).map_err(|e| cannot(path, &e))?;
        Ok(Self(PieceFile::at_start(file, part)))
    }

    pub fn append(&mut self, piece: &Piece<Bits>) -> Result<Place, Failure> {
        self.0.append(piece)
    }

    pub fn piece(&mut self, place: Place) -> io::Result<Piece> {
        self.0.piece(place)
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0.path);
    }
}
