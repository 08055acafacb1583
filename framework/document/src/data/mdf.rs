//! The channels of a measurement in an MDF file of version 4 (ASAM MDF 4.0 to 4.2, `.mf4`) as columns.
//!
//! A channel group is a table: its channels have one raster. Groups are not combined, because that would need an interpolation that
//! nobody chose. Positions of fields are those of the standard; blocks are named in its words.

mod blocks;
mod channel;
mod conversion;
mod samples;

use super::numbers::{NumberStyle, written};
use super::table::Table;
use super::{MeasuredFault, fault};
use crate::did_you_mean;
use blocks::{Block, MdfFile};
use channel::{Channel, Value};

/// Most cells of a table: samples times channels.
const MOST_CELLS: u64 = 10_000_000;
/// Longest text of all cells. \[byte\]
const LONGEST_TEXTS: usize = 256 << 20;
/// Most groups and channels that a message lists.
const LISTED: usize = 8;

/// True if these bytes begin as an MDF file of any version.
pub fn is_mdf(bytes: &[u8]) -> bool {
    bytes.starts_with(b"MDF     ") || bytes.starts_with(b"UnFinMF ")
}

fn damaged(what: impl std::fmt::Display) -> MeasuredFault {
    fault(
        format!("the MDF file is damaged: {what}"),
        "copy it again, or open it in the program of the recorder and save it, or export it as CSV",
    )
}

fn limit(what: impl std::fmt::Display) -> MeasuredFault {
    fault(
        format!("the MDF file has {what}"),
        "export the channels that are used as CSV or as a smaller MDF file",
    )
}

/// A channel group.
struct Group<'a> {
    /// Number in the file, from one on.
    number: usize,
    name: String,
    samples: u64,
    parent: Block<'a>,
    block: Block<'a>,
}

/// Reads the channels of the group of this name or number. Without one there must be a single group with samples.
///
/// # Errors
/// If the file is of another version, not finalized, damaged or beyond limits, or if the group is unknown or not stated.
pub fn table(bytes: &[u8], wanted: Option<&str>, notes: &mut Vec<String>) -> Result<Table, MeasuredFault> {
    let file = MdfFile::from_bytes(bytes)?;
    let groups = groups(&file)?;
    let group = chosen(&file, &groups, wanted)?;
    let part = match group.name.as_str() {
        "" => format!("channel group {}", group.number),
        name => format!("channel group `{name}`"),
    };
    if wanted.is_none() && groups.len() > 1 {
        notes.push(format!("{part} is read, the only one with samples"));
    }
    let mut table = cells(&file, group)?;
    if !table.unread.is_empty() {
        let names: Vec<String> = table
            .unread
            .iter()
            .take(LISTED)
            .map(|(name, why)| format!("`{name}` ({why})"))
            .collect();
        let more = if table.unread.len() > LISTED { ", ..." } else { "" };
        notes.push(format!("channels that are not read: {}{more}", names.join(", ")));
    }
    table.part = Some(part);
    Ok(table)
}

/// All groups with channels, in the order of the file.
fn groups<'a>(file: &MdfFile<'a>) -> Result<Vec<Group<'a>>, MeasuredFault> {
    let mut groups = Vec::new();
    let header = file.block(64, *b"##HD")?;
    for data_group in file.list(header.link(0), *b"##DG")? {
        for block in file.list(data_group.link(1), *b"##CG")? {
            // The texts of another group's channels.
            if block.u16(16)? & 1 == 1 {
                continue;
            }
            groups.push(Group {
                number: groups.len() + 1,
                name: file.text(block.link(2))?,
                samples: block.u64(8)?,
                parent: data_group.clone(),
                block,
            });
        }
    }
    Ok(groups)
}

fn chosen<'g, 'a>(
    file: &MdfFile<'a>,
    groups: &'g [Group<'a>],
    wanted: Option<&str>,
) -> Result<&'g Group<'a>, MeasuredFault> {
    let list = || -> Result<String, MeasuredFault> {
        let mut lines = Vec::new();
        for group in groups.iter().filter(|group| group.samples > 0).take(LISTED) {
            let mut names = Vec::new();
            for block in file.list(group.block.link(1), *b"##CN")?.iter().take(LISTED) {
                names.push(file.text(block.link(2))?);
            }
            let name = if group.name.is_empty() {
                String::new()
            } else {
                format!(" `{}`", group.name)
            };
            lines.push(format!(
                "{}{name} ({} samples of {})",
                group.number,
                group.samples,
                names.join(", ")
            ));
        }
        Ok(lines.join("; "))
    };
    if let Some(wanted) = wanted {
        let named: Vec<&Group<'_>> = groups.iter().filter(|group| group.name == wanted).collect();
        let by_number = || groups.iter().find(|group| wanted.parse() == Ok(group.number));
        return match named.as_slice() {
            [one] => Ok(one),
            [] => by_number().ok_or_else(|| {
                let close = did_you_mean(wanted, groups.iter().map(|group| group.name.as_str()));
                let help = close.map_or("write the name or the number of one of them".to_owned(), |close| {
                    format!("write `group: {close}`")
                });
                let list = list().unwrap_or_default();
                MeasuredFault::new(
                    "group",
                    format!("there is no channel group `{wanted}`; there are: {list}"),
                    help,
                )
            }),
            _ => Err(MeasuredFault::new(
                "group",
                format!("{} channel groups have the name `{wanted}`: {}", named.len(), list()?),
                "write the number of one of them, in quotes",
            )),
        };
    }
    let mut with_samples = groups.iter().filter(|group| group.samples > 0);
    match (with_samples.next(), with_samples.next()) {
        (Some(group), None) => Ok(group),
        (None, _) => Err(fault("the MDF file has no samples", "choose another file")),
        _ => Err(MeasuredFault::new(
            "group",
            format!(
                "the MDF file has several channel groups, each with its own raster: {}",
                list()?
            ),
            "choose one, `group: \"1\"` or by its name; to combine rasters, resample them in another program",
        )),
    }
}

/// The samples of a group.
fn cells(file: &MdfFile<'_>, group: &Group<'_>) -> Result<Table, MeasuredFault> {
    let data_bytes = group.block.u32(24)? as usize;
    let mut channels: Vec<Channel> = Vec::new();
    let mut unread = Vec::new();
    for block in file.list(group.block.link(1), *b"##CN")? {
        let name = file.text(block.link(2))?;
        match Channel::read(file, &block, name.clone(), data_bytes)? {
            Ok(channel) => channels.push(channel),
            Err(why) => unread.push((name, why.to_owned())),
        }
    }
    if channels.is_empty() {
        let why = unread
            .first()
            .map_or(String::new(), |(name, why)| format!(": `{name}` is {why}"));
        return Err(fault(
            format!("no channel of the group can be read{why}"),
            "choose another group or file",
        ));
    }
    // Before anything is unpacked: a small file may state many.
    if group.samples.saturating_mul(channels.len() as u64) > MOST_CELLS {
        return Err(limit(format!(
            "{} samples of {} channels in one group; at most {MOST_CELLS} cells are read",
            group.samples,
            channels.len()
        )));
    }
    let records = samples::records(file, &group.parent, &group.block)?;
    let mut rows = Vec::with_capacity(records.len());
    let mut length = 0;
    for (index, record) in records.iter().enumerate() {
        let cell = |channel: &Channel| match channel.value(record, data_bytes, index as u64) {
            Value::Number(number) if number.is_finite() => written(number),
            Value::Number(number) => number.to_string(),
            Value::Text(text) => text,
            Value::Invalid => String::new(),
        };
        let cells: Vec<String> = channels.iter().map(cell).collect();
        length += cells.iter().map(String::len).sum::<usize>();
        if length > LONGEST_TEXTS {
            return Err(limit(format!("texts of more than {} MB", LONGEST_TEXTS >> 20)));
        }
        rows.push((index as u64 + 1, cells));
    }
    let (names, units): (Vec<_>, Vec<_>) = channels.into_iter().map(|channel| (channel.name, channel.unit)).unzip();
    Ok(Table {
        part: None,
        unit_lines: vec![0; names.len()],
        names,
        units,
        unread,
        header_line: 0,
        rows,
        numbers: NumberStyle::PLAIN,
        repeated: None,
    })
}

#[cfg(test)]
mod builder;
#[cfg(test)]
mod tests;
