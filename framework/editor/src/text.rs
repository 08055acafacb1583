//! Places in a text: bytes, and lines with columns in UTF-8 and UTF-16 units, as editors count.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// The unit of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Encoding {
    /// Bytes.
    #[serde(rename = "utf-8")]
    Utf8,
    /// Two bytes, as in JavaScript; the default of the Language Server Protocol.
    #[default]
    #[serde(rename = "utf-16")]
    Utf16,
}

/// A place in a text. Lines and columns count from zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Position {
    /// Line.
    pub line: u32,
    /// Column in bytes.
    pub utf8: u32,
    /// Column in UTF-16 units.
    pub utf16: u32,
}

impl Position {
    /// The column in a unit.
    pub fn column(&self, encoding: Encoding) -> u32 {
        match encoding {
            Encoding::Utf8 => self.utf8,
            Encoding::Utf16 => self.utf16,
        }
    }
}

/// A range of a text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TextRange {
    /// First byte.
    pub from: usize,
    /// Byte after the last.
    pub to: usize,
    /// Place of the first byte.
    pub start: Position,
    /// Place after the last.
    pub end: Position,
}

/// The lines of a text. A line ends at `\n`, `\r\n` or `\r`.
#[derive(Debug, Clone)]
pub struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    /// The lines of a text.
    pub fn new(text: &str) -> Self {
        let bytes = text.as_bytes();
        let mut starts = vec![0];
        for (i, byte) in bytes.iter().enumerate() {
            let ends = match byte {
                b'\n' => true,
                b'\r' => bytes.get(i + 1) != Some(&b'\n'),
                _ => false,
            };
            if ends {
                starts.push(i + 1);
            }
        }
        Self { starts }
    }

    /// The place of a byte of their text; a byte inside a character, or beyond the end, counts as the character boundary before it.
    pub fn position(&self, text: &str, offset: usize) -> Position {
        let offset = floor(text, offset);
        let line = self.starts.partition_point(|start| *start <= offset).saturating_sub(1);
        let before = text.get(self.starts[line]..offset).unwrap_or_default();
        Position {
            line: line as u32,
            utf8: before.len() as u32,
            utf16: before.encode_utf16().count() as u32,
        }
    }

    /// A range of bytes of their text with its places.
    pub fn range(&self, text: &str, range: &Range<usize>) -> TextRange {
        let from = floor(text, range.start);
        let to = floor(text, range.end).max(from);
        TextRange {
            from,
            to,
            start: self.position(text, from),
            end: self.position(text, to),
        }
    }

    /// The byte at a line and column; a column beyond the end of its line is its end, a line beyond the last the end of the text.
    pub fn offset(&self, text: &str, line: u32, column: u32, encoding: Encoding) -> usize {
        let Some(start) = self.starts.get(line as usize).copied() else {
            return text.len();
        };
        let end = self.starts.get(line as usize + 1).copied().unwrap_or(text.len());
        let content = text.get(start..end).unwrap_or_default();
        let content = content.trim_end_matches(['\n', '\r']);
        let mut units = 0;
        for (at, character) in content.char_indices() {
            if units >= column as usize {
                return start + at;
            }
            units += match encoding {
                Encoding::Utf8 => character.len_utf8(),
                Encoding::Utf16 => character.len_utf16(),
            };
        }
        start + content.len()
    }
}

/// The character boundary at or before a byte.
pub fn floor(text: &str, mut offset: usize) -> usize {
    offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    offset
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_bytes_and_utf16_units() {
        let text = "a: 1\r\n# µ𝄞x\nend\rlast";
        let lines = Lines::new(text);
        let x = text.find('x').unwrap_or_default();
        let place = lines.position(text, x);
        assert_eq!((place.line, place.utf8, place.utf16), (1, 8, 5));
        assert_eq!(lines.offset(text, 1, 8, Encoding::Utf8), x);
        assert_eq!(lines.offset(text, 1, 5, Encoding::Utf16), x);
        assert_eq!(lines.position(text, text.len()).line, 3);
        assert_eq!(lines.offset(text, 0, 99, Encoding::Utf8), 4);
        assert_eq!(lines.offset(text, 9, 0, Encoding::Utf8), text.len());
        // Inside of a character: its start.
        assert_eq!(lines.position(text, x - 1).utf8, 4);
    }
}
