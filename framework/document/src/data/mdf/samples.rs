//! The records of a channel group: data blocks in a row, packed or not, sorted or with the records of several groups.

use super::blocks::{Block, MdfFile};
use super::{damaged, limit};
use crate::data::MeasuredFault;

/// Longest data of a data group. \[byte\]
const LONGEST_DATA: usize = 128 << 20;

/// The records of a group: bytes of the channels, then of their validity.
pub(super) struct Records {
    data: Vec<u8>,
    /// Position of each record if they are not in a row.
    places: Option<Vec<usize>>,
    /// Length of a record, and of the record number before it. \[byte\]
    length: usize,
    before: usize,
    count: usize,
}

impl Records {
    pub(super) fn len(&self) -> usize {
        self.count
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &[u8]> {
        (0..self.count).map(move |index| {
            let at = self
                .places
                .as_ref()
                .map_or(index * (self.before + self.length), |places| places[index]);
            &self.data[at + self.before..at + self.before + self.length]
        })
    }
}

/// The records of a group.
pub(super) fn records(file: &MdfFile<'_>, data_group: &Block<'_>, group: &Block<'_>) -> Result<Records, MeasuredFault> {
    let before = usize::from(data_group.u8(0)?);
    if ![0, 1, 2, 4, 8].contains(&before) {
        return Err(damaged(format!("record numbers of {before} bytes")));
    }
    let length = length(group)?;
    let stated = group.u64(8)?;
    let groups = file.list(data_group.link(1), *b"##CG")?;
    let data = data(file, data_group.link(2))?;
    let places = if groups.len() > 1 {
        Some(places(&data, before, &groups, group.u64(0)?)?)
    } else {
        None
    };
    let found = match &places {
        Some(places) => places.len(),
        // Records without bytes have virtual channels only.
        None if before + length == 0 => usize::try_from(stated).unwrap_or(usize::MAX),
        None => data.len() / (before + length),
    };
    if (found as u64) < stated {
        return Err(damaged(format!(
            "it states {stated} samples and has the data of {found}"
        )));
    }
    Ok(Records {
        data,
        places,
        length,
        before,
        count: stated as usize,
    })
}

fn length(group: &Block<'_>) -> Result<usize, MeasuredFault> {
    Ok(group.u32(24)? as usize + group.u32(28)? as usize)
}

/// Where the records of one group are among those of others.
fn places(data: &[u8], before: usize, groups: &[Block<'_>], wanted: u64) -> Result<Vec<usize>, MeasuredFault> {
    if before == 0 {
        return Err(damaged("several channel groups without record numbers"));
    }
    let mut lengths = std::collections::BTreeMap::new();
    for group in groups {
        let has_texts = group.u16(16)? & 1 == 1;
        lengths.insert(group.u64(0)?, if has_texts { None } else { Some(length(group)?) });
    }
    let number = |bytes: &[u8]| {
        bytes
            .iter()
            .rev()
            .fold(0_u64, |sum, byte| (sum << 8) | u64::from(*byte))
    };
    let mut found = Vec::new();
    let mut at = 0;
    while at < data.len() {
        let id = data.get(at..at + before).map(number);
        let id = id.ok_or_else(|| damaged("the last record is incomplete"))?;
        let length = match lengths.get(&id) {
            Some(Some(length)) => *length,
            // A text, after its length.
            Some(None) => {
                let length = data.get(at + before..at + before + 4).map(number);
                length.ok_or_else(|| damaged("the last record is incomplete"))? as usize + 4
            }
            None => return Err(damaged(format!("a record has the number {id} of no channel group"))),
        };
        let end = at + before + length;
        if end > data.len() {
            return Err(damaged("the last record is incomplete"));
        }
        if id == wanted {
            found.push(at);
        }
        at = end;
    }
    Ok(found)
}

/// The data of a data group: one block, or a list of blocks.
fn data(file: &MdfFile<'_>, at: u64) -> Result<Vec<u8>, MeasuredFault> {
    let mut all = Vec::new();
    if at == 0 {
        return Ok(all);
    }
    let mut block = file.any(at)?;
    if block.id == *b"##HL" {
        let first = block.link(0);
        if first == 0 {
            return Ok(all);
        }
        block = file.any(first)?;
    }
    if block.id != *b"##DL" {
        append(&block, &mut all)?;
        return Ok(all);
    }
    loop {
        for index in 1..block.links() {
            let at = block.link(index);
            if at != 0 {
                append(&file.any(at)?, &mut all)?;
            }
        }
        match block.link(0) {
            0 => return Ok(all),
            next => block = file.block(next, *b"##DL")?,
        }
    }
}

/// Appends the bytes of a data block.
fn append(block: &Block<'_>, all: &mut Vec<u8>) -> Result<(), MeasuredFault> {
    let room = LONGEST_DATA - all.len();
    let too_long = || limit(format!("samples of more than {} MB in one group", LONGEST_DATA >> 20));
    match &block.id {
        b"##DT" => {
            if block.data.len() > room {
                return Err(too_long());
            }
            all.extend_from_slice(block.data);
        }
        b"##DZ" => {
            let (kind, method, columns) = ([block.u8(0)?, block.u8(1)?], block.u8(2)?, block.u32(4)? as usize);
            let length = usize::try_from(block.u64(8)?).unwrap_or(usize::MAX);
            if kind != *b"DT" || method > 1 {
                return Err(crate::data::fault(
                    format!("the samples of the MDF file are packed by a method that is not read (number {method})"),
                    "save it without compression, or with deflate",
                ));
            }
            if length > room {
                return Err(too_long());
            }
            let packed = usize::try_from(block.u64(16)?)
                .ok()
                .and_then(|end| block.data.get(24..24_usize.checked_add(end)?));
            let packed = packed.ok_or_else(|| damaged("a packed block is too short"))?;
            // One byte more than stated shows that there is more.
            let content = miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(packed, length.saturating_add(1));
            let content = content.map_err(|wrong| damaged(format!("samples cannot be unpacked: {wrong}")))?;
            if content.len() != length {
                return Err(damaged("the length of a packed block is wrong"));
            }
            if method == 0 {
                all.extend_from_slice(&content);
            } else {
                all.extend(transposed(&content, columns));
            }
        }
        id => {
            let id = String::from_utf8_lossy(id).escape_default().to_string();
            return Err(damaged(format!("samples in a block `{id}`, which is not read")));
        }
    }
    Ok(())
}

/// The records of bytes that were packed column by column. The remainder of an incomplete record is at the end.
fn transposed(bytes: &[u8], columns: usize) -> Vec<u8> {
    let rows = bytes.len().checked_div(columns).unwrap_or(0);
    let whole = rows * columns;
    let mut all = Vec::with_capacity(bytes.len());
    for row in 0..rows {
        all.extend((0..columns).map(|column| bytes[column * rows + row]));
    }
    all.extend_from_slice(&bytes[whole..]);
    all
}
