//! Zip archives with limits: nothing is unpacked beyond what its reader allows, whatever the archive says of itself.

use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};

/// Largest ratio of a content to its packed bytes. Texts reach about 20, tables of equal rows about 100.
pub const LARGEST_RATIO: u64 = 200;
/// Contents below this length may have any ratio. \[byte\]
const SMALL: u64 = 1 << 20;

/// Why an entry cannot be unpacked.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ArchiveFault {
    /// The archive or an entry is damaged.
    #[error("{0}")]
    Damaged(String),
    /// It has more entries than allowed.
    #[error("it has more than {0} entries")]
    Entries(usize),
    /// An entry is encrypted.
    #[error("it is encrypted")]
    Encrypted,
    /// An entry is packed by a method other than deflate.
    #[error("it is packed by another method than deflate")]
    Method,
    /// An entry is too long, or much longer than its packed bytes.
    #[error("it says that it unpacks from {packed} to {length} bytes; at most {} MB and {LARGEST_RATIO} times its size are read", longest >> 20)]
    Length {
        /// Packed length.
        packed: u64,
        /// Stated length.
        length: u64,
        /// Allowed length.
        longest: u64,
    },
}

/// A file in an archive.
#[derive(Debug, Clone, Copy)]
pub struct ArchiveEntry {
    /// True if a password is needed.
    pub encrypted: bool,
    /// Stated length. \[byte\]
    pub length: u64,
    packed: u64,
    method: CompressionMethod,
    place: ZipArchiveEntryWayfinder,
}

impl ArchiveEntry {
    /// True if it can be unpacked by its method.
    pub fn has_known_method(&self) -> bool {
        self.method == CompressionMethod::DEFLATE || self.method == CompressionMethod::STORE
    }
}

/// An archive in memory.
pub struct Archive<'a> {
    slice: ZipSliceArchive<&'a [u8]>,
    /// Names and entries of its files, without folders.
    pub entries: Vec<(String, ArchiveEntry)>,
}

impl<'a> Archive<'a> {
    /// Reads the list of files.
    ///
    /// # Errors
    /// If it is damaged, or has more than `most` entries.
    pub fn open(bytes: &'a [u8], most: usize) -> Result<Self, ArchiveFault> {
        let slice = ZipArchive::from_slice(bytes).map_err(damaged)?;
        let mut list = slice.entries();
        let mut entries = Vec::new();
        for count in 0.. {
            let Some(entry) = list.next_entry().map_err(damaged)? else {
                break;
            };
            if count == most {
                return Err(ArchiveFault::Entries(most));
            }
            if entry.is_dir() {
                continue;
            }
            let listed = ArchiveEntry {
                encrypted: entry.flags().is_encrypted(),
                length: entry.uncompressed_size_hint(),
                packed: entry.compressed_size_hint(),
                method: entry.compression_method(),
                place: entry.wayfinder(),
            };
            let name = String::from_utf8_lossy(entry.file_path().as_bytes()).into_owned();
            entries.push((name, listed));
        }
        Ok(Self { slice, entries })
    }

    /// The entry of a name; upper and lower case are equal, as on the systems of most writers.
    pub fn find(&self, name: &str) -> Option<ArchiveEntry> {
        let found = self.entries.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
        found.map(|(_, entry)| *entry)
    }

    /// The content of an entry of at most `longest` bytes.
    ///
    /// # Errors
    /// If it is damaged, encrypted, too long or packed by an unknown method.
    pub fn unpack(&self, entry: ArchiveEntry, longest: u64) -> Result<Vec<u8>, ArchiveFault> {
        let ArchiveEntry { length, packed, .. } = entry;
        if entry.encrypted {
            return Err(ArchiveFault::Encrypted);
        }
        if !entry.has_known_method() {
            return Err(ArchiveFault::Method);
        }
        if length > longest || (length > SMALL && length / LARGEST_RATIO > packed) {
            return Err(ArchiveFault::Length {
                packed,
                length,
                longest,
            });
        }
        let local = self.slice.get_entry(entry.place).map_err(damaged)?;
        let data = local.data();
        let content = if entry.method == CompressionMethod::STORE {
            data.get(..longest.min(data.len() as u64) as usize)
                .unwrap_or_default()
                .to_vec()
        } else {
            // One byte more than stated shows that there is more.
            miniz_oxide::inflate::decompress_to_vec_with_limit(data, length as usize + 1).map_err(damaged)?
        };
        if content.len() as u64 != length || rawzip::crc32(&content) != local.claim_verifier().crc {
            return Err(ArchiveFault::Damaged("length or checksum is wrong".to_owned()));
        }
        Ok(content)
    }
}

fn damaged(fault: impl std::fmt::Display) -> ArchiveFault {
    ArchiveFault::Damaged(fault.to_string())
}
