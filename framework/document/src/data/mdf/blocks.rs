//! The blocks of an MDF file: their links, fields and texts. Nothing is read beyond the file, and lists end.

use std::cell::Cell;

use super::{damaged, limit};
use crate::data::{MeasuredFault, fault};

/// Most blocks that are visited, and bytes of all texts that are looked through.
const MOST_BLOCKS: usize = 500_000;
const MOST_TEXT: usize = 64 << 20;
/// Longest name, unit or text of a value; the rest is cut off. \[byte\]
const LONGEST_TEXT: usize = 1000;
/// Length of the head of a block: id, length and number of links. \[byte\]
const HEAD: u64 = 24;

/// An MDF file in memory.
pub(super) struct MdfFile<'a> {
    bytes: &'a [u8],
    /// Blocks and bytes of texts that may still be read.
    blocks: Cell<usize>,
    text: Cell<usize>,
}

/// A block.
#[derive(Clone)]
pub(super) struct Block<'a> {
    pub id: [u8; 4],
    links: &'a [u8],
    /// What follows the links.
    pub data: &'a [u8],
}

impl Block<'_> {
    /// A link, zero if it is not set or the block has fewer.
    pub(super) fn link(&self, index: usize) -> u64 {
        self.links.chunks_exact(8).nth(index).map_or(0, number)
    }

    /// How many links it has.
    pub(super) fn links(&self) -> usize {
        self.links.len() / 8
    }

    fn field(&self, at: usize, length: usize) -> Result<&[u8], MeasuredFault> {
        let field = self.data.get(at..at.saturating_add(length));
        field.ok_or_else(|| damaged(format!("a block {} is too short", String::from_utf8_lossy(&self.id))))
    }

    pub(super) fn u8(&self, at: usize) -> Result<u8, MeasuredFault> {
        Ok(self.field(at, 1)?[0])
    }

    pub(super) fn u16(&self, at: usize) -> Result<u16, MeasuredFault> {
        Ok(number(self.field(at, 2)?) as u16)
    }

    pub(super) fn u32(&self, at: usize) -> Result<u32, MeasuredFault> {
        Ok(number(self.field(at, 4)?) as u32)
    }

    pub(super) fn u64(&self, at: usize) -> Result<u64, MeasuredFault> {
        Ok(number(self.field(at, 8)?))
    }

    pub(super) fn f64(&self, at: usize) -> Result<f64, MeasuredFault> {
        Ok(f64::from_bits(self.u64(at)?))
    }
}

/// An integer of up to eight bytes, the lowest first.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |sum, byte| (sum << 8) | u64::from(*byte))
}

impl<'a> MdfFile<'a> {
    /// Checks version and state of a file.
    pub(super) fn from_bytes(bytes: &'a [u8]) -> Result<Self, MeasuredFault> {
        let version = bytes
            .get(8..16)
            .map(|text| String::from_utf8_lossy(text).trim_matches(['\0', ' ']).to_owned());
        let version = version.ok_or_else(|| damaged("it is too short"))?;
        if !version.starts_with("4.") {
            return Err(fault(
                format!("an MDF file of version `{version}`; version 4 (.mf4) is read"),
                "save it as MDF 4, or export it as CSV",
            ));
        }
        if bytes.starts_with(b"UnFin") {
            return Err(fault(
                "the MDF file was not finalized: its recorder was interrupted",
                "open it in the program of the recorder and save it",
            ));
        }
        Ok(Self {
            bytes,
            blocks: Cell::new(MOST_BLOCKS),
            text: Cell::new(MOST_TEXT),
        })
    }

    /// The block at a position, of any kind.
    pub(super) fn any(&self, at: u64) -> Result<Block<'a>, MeasuredFault> {
        let left = self.blocks.get().checked_sub(1);
        self.blocks
            .set(left.ok_or_else(|| limit(format!("more than {MOST_BLOCKS} blocks")))?);
        let cut = || damaged(format!("no whole block at byte {at}"));
        let part = |from: u64, to: u64| -> Option<&'a [u8]> {
            self.bytes.get(usize::try_from(from).ok()?..usize::try_from(to).ok()?)
        };
        let head = part(at, at.saturating_add(HEAD)).ok_or_else(cut)?;
        let (length, links) = (number(&head[8..16]), number(&head[16..24]));
        let links_end = links
            .checked_mul(8)
            .and_then(|links| links.checked_add(HEAD))
            .filter(|end| *end <= length);
        let links_end = links_end.ok_or_else(cut)?;
        Ok(Block {
            id: [head[0], head[1], head[2], head[3]],
            links: part(at + HEAD, at.saturating_add(links_end)).ok_or_else(cut)?,
            data: part(at + links_end, at.saturating_add(length)).ok_or_else(cut)?,
        })
    }

    /// The block of a kind at a position.
    pub(super) fn block(&self, at: u64, id: [u8; 4]) -> Result<Block<'a>, MeasuredFault> {
        let block = self.any(at)?;
        if block.id == id {
            return Ok(block);
        }
        let [found, id] = [block.id, id].map(|id| String::from_utf8_lossy(&id).escape_default().to_string());
        Err(damaged(format!("`{found}` instead of a block `{id}` at byte {at}")))
    }

    /// The blocks of a list, whose first link is the next one.
    pub(super) fn list(&self, first: u64, id: [u8; 4]) -> Result<Vec<Block<'a>>, MeasuredFault> {
        let mut list = Vec::new();
        let mut at = first;
        // A list that returns to itself ends at the limit of blocks.
        while at != 0 {
            let block = self.block(at, id)?;
            at = block.link(0);
            list.push(block);
        }
        Ok(list)
    }

    /// The text of a block `TX`, or the element `TX` of a block `MD`; empty without a block.
    pub(super) fn text(&self, at: u64) -> Result<String, MeasuredFault> {
        if at == 0 {
            return Ok(String::new());
        }
        let block = self.any(at)?;
        let longest = match &block.id {
            b"##TX" => LONGEST_TEXT,
            b"##MD" => 100 * LONGEST_TEXT,
            _ => return Err(damaged(format!("no text at byte {at}"))),
        };
        let text = cut(block.data, longest);
        let left = self.text.get().checked_sub(text.len());
        self.text
            .set(left.ok_or_else(|| limit(format!("names and texts of more than {} MB", MOST_TEXT >> 20)))?);
        let text = if block.id == *b"##MD" { text_of_xml(&text) } else { text };
        Ok(text.trim().to_owned())
    }
}

/// Bytes up to the first zero as a text of limited length.
pub(super) fn cut(bytes: &[u8], longest: usize) -> String {
    let bytes = &bytes[..bytes.len().min(longest)];
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// The element `TX` of a comment in XML.
fn text_of_xml(xml: &str) -> String {
    let mut reader = quick_xml::Reader::from_str(xml);
    let (mut text, mut inside) = (String::new(), false);
    while let Ok(event) = reader.read_event() {
        match &event {
            quick_xml::events::Event::Start(element) if element.local_name().into_inner() == "TX" => inside = true,
            quick_xml::events::Event::End(_) if inside => break,
            quick_xml::events::Event::Eof => break,
            other if inside => super::super::workbook::append(other, &mut text),
            _ => {}
        }
    }
    text.chars().take(LONGEST_TEXT).collect()
}
