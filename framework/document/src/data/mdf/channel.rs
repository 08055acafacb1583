//! A channel: where its value is in a record, and what it means.

use super::blocks::{Block, MdfFile, cut};
use super::conversion::Conversion;
use crate::data::MeasuredFault;

/// Longest text of a value. \[byte\]
const LONGEST_TEXT: usize = 1000;

/// A value of a channel.
pub(super) enum Value {
    Number(f64),
    Text(String),
    /// Marked as invalid by its recorder.
    Invalid,
}

#[derive(Clone, Copy)]
enum Kind {
    Unsigned,
    Signed,
    Float,
    Text,
    /// The number of the sample from zero on: no bytes.
    Index,
}

/// A channel of numbers or short texts.
pub(super) struct Channel {
    pub name: String,
    pub unit: Option<String>,
    kind: Kind,
    big_endian: bool,
    /// First byte, first bit in it, and number of bits.
    byte: usize,
    bit: u32,
    bits: u32,
    /// Bit of its validity, counted from the start of the record.
    invalid: Option<usize>,
    never_valid: bool,
    conversion: Conversion,
}

impl Channel {
    /// Reads a channel of a group whose records have `record` bytes; the inner error says why its values are not read.
    pub(super) fn read(
        file: &MdfFile<'_>,
        block: &Block<'_>,
        name: String,
        record: usize,
    ) -> Result<Result<Self, &'static str>, MeasuredFault> {
        let (kind, data_type) = (block.u8(0)?, block.u8(2)?);
        let (bit, byte, bits, flags) = (u32::from(block.u8(3)?), block.u32(4)?, block.u32(8)?, block.u32(12)?);
        if block.link(1) != 0 {
            return Ok(Err("a structure or an array"));
        }
        let big_endian = data_type % 2 == 1;
        let kind = match (kind, data_type) {
            (1 | 4 | 5, _) => return Ok(Err("values of variable length or of another file")),
            (3 | 6, _) => Kind::Index,
            (_, 0 | 1) => Kind::Unsigned,
            (_, 2 | 3) => Kind::Signed,
            (_, 4 | 5) => Kind::Float,
            (_, 6 | 7) => Kind::Text,
            _ => return Ok(Err("neither numbers nor texts of one byte per letter")),
        };
        let fits = match kind {
            Kind::Index => true,
            Kind::Unsigned | Kind::Signed => (1..=64).contains(&bits) && bit < 8,
            Kind::Float => [16, 32, 64].contains(&bits) && bit == 0,
            Kind::Text => bits % 8 == 0 && bit == 0,
        };
        if !fits {
            return Ok(Err("numbers of an unusual length"));
        }
        let end = (u64::from(bit) + u64::from(bits)).div_ceil(8) + u64::from(byte);
        if !matches!(kind, Kind::Index) && end > record as u64 {
            return Ok(Err("beyond the end of its record"));
        }
        let conversion = match Conversion::read(file, block.link(4))? {
            Ok(conversion) => conversion,
            Err(why) => return Ok(Err(why)),
        };
        let stated = file.text(block.link(6))?;
        let unit = if stated.is_empty() {
            conversion.unit.clone()
        } else {
            stated
        };
        Ok(Ok(Self {
            name,
            unit: (!unit.is_empty()).then_some(unit),
            kind,
            big_endian,
            byte: byte as usize,
            bit,
            bits,
            invalid: (flags & 2 == 2).then_some(block.u32(16)? as usize),
            never_valid: flags & 1 == 1,
            conversion,
        }))
    }

    /// The value in a record. `index` is the number of the sample from zero on, and
    /// `data` the number of bytes before those of the validity.
    pub(super) fn value(&self, record: &[u8], data: usize, index: u64) -> Value {
        let bit_is_set = |bit: usize| {
            record
                .get(data.saturating_add(bit / 8))
                .is_none_or(|byte| byte >> (bit % 8) & 1 == 1)
        };
        if self.never_valid || self.invalid.is_some_and(bit_is_set) {
            return Value::Invalid;
        }
        let length = match self.kind {
            Kind::Index => return self.conversion.value(index as f64),
            Kind::Text => self.bits as usize / 8,
            _ => (self.bit + self.bits).div_ceil(8) as usize,
        };
        let Some(bytes) = record.get(self.byte..self.byte.saturating_add(length)) else {
            return Value::Invalid;
        };
        if matches!(self.kind, Kind::Text) {
            return Value::Text(cut(bytes, LONGEST_TEXT).trim().to_owned());
        }
        let push = |sum: u128, byte: &u8| (sum << 8) | u128::from(*byte);
        let whole = if self.big_endian {
            bytes.iter().fold(0, push)
        } else {
            bytes.iter().rev().fold(0, push)
        };
        let number = (whole >> self.bit) as u64 & (u64::MAX >> (64 - self.bits));
        self.conversion.value(match (self.kind, self.bits) {
            (Kind::Signed, bits) => ((number << (64 - bits)).cast_signed() >> (64 - bits)) as f64,
            (Kind::Float, 16) => half(number as u16),
            (Kind::Float, 32) => f64::from(f32::from_bits(number as u32)),
            (Kind::Float, _) => f64::from_bits(number),
            _ => number as f64,
        })
    }
}

/// A number of 16 bits (IEEE 754 binary16).
fn half(bits: u16) -> f64 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f64::from(bits & 1023));
    let size = match exponent {
        0 => fraction * 2_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction / 1024.0) * 2_f64.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::half;

    #[test]
    fn halves_are_read() {
        for (bits, value) in [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65504.0),
            (0x0001, 2_f64.powi(-24)),
            (0x3555, 0.333251953125),
        ] {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7c00).is_infinite() && half(0x7e00).is_nan());
    }
}
