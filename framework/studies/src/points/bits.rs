//! Lossless serialisation of solved pieces: numbers as 64 bits, little-endian.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use super::{Numbered, Piece, PointResult};
use gearloss_framework::flow::Status;
use gearloss_framework::loss::{Extent, MOST_TERMS, Undefined};
use gearloss_framework::thermal::Outcome;

/// Every status, in the order of its code.
const STATUSES: [Status; 9] = [
    Status::Drive,
    Status::Coast,
    Status::Split,
    Status::Dragged,
    Status::Standstill,
    Status::SelfLocking,
    Status::NoConvergence,
    Status::Undefined,
    Status::LossAboveInput,
];

/// Every outcome of a balance, in the order of its code.
const OUTCOMES: [Outcome; 6] = [
    Outcome::Converged,
    Outcome::AtDiscontinuity,
    Outcome::Several,
    Outcome::NoneBelowMaximum,
    Outcome::Undefined,
    Outcome::NoConvergence,
];

/// Points of a task as bytes.
#[derive(Debug, Clone, Default)]
pub struct Bits {
    bytes: Vec<u8>,
    /// End of each point in the bytes.
    ends: Vec<usize>,
}

impl Bits {
    /// Serialises points; a `make` function for [`super::solve_pieces`].
    pub fn from_points(points: &mut Numbered<'_>) -> Self {
        let mut bits = Self::default();
        for (_, point) in points {
            point.write_bits(&mut bits.bytes);
            bits.ends.push(bits.bytes.len());
        }
        bits
    }

    /// The bytes of some points.
    fn bytes_of_points(&self, own: Range<usize>) -> &[u8] {
        let ends = [own.start, own.end].map(|point| point.checked_sub(1).map_or(0, |last| self.ends[last]));
        &self.bytes[ends[0]..ends[1]]
    }
}

impl Piece<Bits> {
    /// Adds the piece to bytes.
    pub fn write_bits(&self, to: &mut Vec<u8>) {
        count(to, self.number);
        count(to, self.len());
        count(to, self.seen.len());
        for (task, own) in self.runs() {
            to.extend_from_slice(self.tasks[task].bytes_of_points(own));
        }
        for extent in &self.seen {
            numbers(to, &[extent.least, extent.greatest]);
            to.extend(extent.seen.to_le_bytes());
            to.extend(extent.outside.to_le_bytes());
            to.extend(extent.lost_outside.to_le_bytes());
        }
    }
}

impl Piece {
    /// Reads a piece from the front of bytes; absent if there is none.
    pub fn read_bits(from: &mut &[u8]) -> Option<Self> {
        let [number, points, seen] = [take_count(from)?, take_count(from)?, take_count(from)?];
        let points = (0..points).map(|_| PointResult::read_bits(from));
        let points = points.collect::<Option<_>>()?;
        let seen = (0..seen).map(|_| take_extent(from));
        Some(Self::new(number, points, seen.collect::<Option<_>>()?))
    }
}

impl PointResult {
    /// Adds the point to bytes.
    pub fn write_bits(&self, to: &mut Vec<u8>) {
        // Explicit pattern, so that a new field is not forgotten.
        let Self {
            torque,
            speed,
            torque_speed,
            reference_speed,
            output_speed,
            at_reference,
            oil,
            surface,
            balance,
            nodes,
            status,
            efficiency,
            loss,
            loss_torque,
            input,
            output,
            sums,
            parts,
            terms,
            outside,
            undefined,
            passes,
            evaluations,
        } = self;
        let code = |found: Option<usize>| found.and_then(|code| u8::try_from(code).ok()).unwrap_or(u8::MAX);
        to.push(code(STATUSES.iter().position(|s| s == status)));
        to.push(code(balance.and_then(|b| OUTCOMES.iter().position(|o| *o == b))));
        to.push(u8::from(*at_reference) | u8::from(*outside) << 1);
        numbers(to, &[*torque, *speed, *torque_speed, *reference_speed]);
        for value in [output_speed, oil, surface, efficiency, loss, loss_torque, input, output] {
            to.push(u8::from(value.is_some()));
            numbers(to, value.as_slice());
        }
        numbers(to, sums);
        for list in [nodes, parts] {
            count(to, list.len());
            numbers(to, list);
        }
        count(to, terms.len());
        for terms in terms {
            numbers(to, terms);
        }
        count(to, *passes);
        count(to, *evaluations);
        to.push(u8::from(undefined.is_some()));
        if let Some((part, reason)) = undefined {
            count(to, *part);
            numbers(to, &[reason.value]);
            count(to, reason.what.len());
            to.extend(reason.what.as_bytes());
        }
    }

    /// Reads a point from the front of bytes; absent if there is none.
    pub fn read_bits(from: &mut &[u8]) -> Option<Self> {
        let status = *STATUSES.get(usize::from(take_byte(from)?))?;
        let balance = OUTCOMES.get(usize::from(take_byte(from)?)).copied();
        let flags = take_byte(from)?;
        let [torque, speed, torque_speed, reference_speed] = take_numbers(from)?;
        let mut value = || -> Option<Option<f64>> {
            if take_byte(from)? == 0 {
                return Some(None);
            }
            take_number(from).map(Some)
        };
        let [output_speed, oil, surface, efficiency] = [value()?, value()?, value()?, value()?];
        let [loss, loss_torque, input, output] = [value()?, value()?, value()?, value()?];
        let sums = take_numbers(from)?;
        let nodes = take_list(from)?;
        let parts = take_list(from)?;
        let terms = take_count(from)?;
        let terms = (0..terms)
            .map(|_| take_numbers::<MOST_TERMS>(from))
            .collect::<Option<_>>()?;
        let [passes, evaluations] = [take_count(from)?, take_count(from)?];
        let undefined = match take_byte(from)? {
            0 => None,
            _ => Some((take_count(from)?, take_reason(from)?)),
        };
        Some(Self {
            torque,
            speed,
            torque_speed,
            reference_speed,
            output_speed,
            at_reference: flags & 1 != 0,
            oil,
            surface,
            balance,
            nodes,
            status,
            efficiency,
            loss,
            loss_torque,
            input,
            output,
            sums,
            parts,
            terms,
            outside: flags & 2 != 0,
            undefined,
            passes,
            evaluations,
        })
    }
}

fn count(to: &mut Vec<u8>, count: usize) {
    to.extend((count as u64).to_le_bytes());
}

fn numbers(to: &mut Vec<u8>, list: &[f64]) {
    for x in list {
        to.extend(x.to_le_bytes());
    }
}

fn take<const N: usize>(from: &mut &[u8]) -> Option<[u8; N]> {
    let (bytes, rest) = from.split_first_chunk::<N>()?;
    *from = rest;
    Some(*bytes)
}

fn take_byte(from: &mut &[u8]) -> Option<u8> {
    take::<1>(from).map(|[byte]| byte)
}

fn take_count(from: &mut &[u8]) -> Option<usize> {
    usize::try_from(u64::from_le_bytes(take(from)?)).ok()
}

fn take_number(from: &mut &[u8]) -> Option<f64> {
    take(from).map(f64::from_le_bytes)
}

fn take_numbers<const N: usize>(from: &mut &[u8]) -> Option<[f64; N]> {
    let mut list = [0.0; N];
    for x in &mut list {
        *x = take_number(from)?;
    }
    Some(list)
}

fn take_list(from: &mut &[u8]) -> Option<Vec<f64>> {
    let count = take_count(from)?;
    (0..count).map(|_| take_number(from)).collect()
}

fn take_extent(from: &mut &[u8]) -> Option<Extent> {
    let [least, greatest] = take_numbers(from)?;
    Some(Extent {
        least,
        greatest,
        seen: u32::from_le_bytes(take(from)?),
        outside: u32::from_le_bytes(take(from)?),
        lost_outside: i128::from_le_bytes(take(from)?),
    })
}

fn take_reason(from: &mut &[u8]) -> Option<Undefined> {
    let value = take_number(from)?;
    let length = take_count(from)?;
    let (text, rest) = from.split_at_checked(length)?;
    *from = rest;
    Some(Undefined {
        what: lasting(std::str::from_utf8(text).ok()?),
        value,
    })
}

/// A reason as a static text, because [`Undefined`] is copied for millions of points and therefore owns no text. Reasons are texts
/// of models, so that there are few; each is allocated once and never freed.
fn lasting(text: &str) -> &'static str {
    static KNOWN: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(same) = known.get(text) {
        return same;
    }
    let text: &'static str = Box::leak(text.to_owned().into_boxed_str());
    known.insert(text);
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn point(i: usize) -> PointResult {
        PointResult {
            torque: 0.1 + 0.2,
            speed: -0.0,
            torque_speed: 1.0 / 3.0,
            reference_speed: 1e-300,
            output_speed: i.is_multiple_of(2).then_some(7.0),
            at_reference: i.is_multiple_of(3),
            oil: Some(80.0),
            surface: None,
            balance: OUTCOMES.get(i).copied(),
            nodes: vec![20.0; i],
            status: STATUSES[i % STATUSES.len()],
            efficiency: (i != 2).then_some(0.98),
            loss: Some(12.5),
            loss_torque: None,
            input: Some(1.0),
            output: Some(f64::MIN_POSITIVE),
            sums: [1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            parts: vec![0.25; 3 * i],
            terms: vec![[1.5; MOST_TERMS]; i],
            outside: !i.is_multiple_of(2),
            undefined: (i == 2).then_some((
                4,
                Undefined {
                    what: "speed [rpm]",
                    value: -3.5,
                },
            )),
            passes: 3 * i,
            evaluations: i,
        }
    }

    fn piece() -> Piece {
        let seen = Extent {
            least: -1.0,
            greatest: 2.5,
            seen: 9,
            outside: 2,
            lost_outside: 3_000_000_001,
        };
        Piece::new(5, (0..9).map(point).collect(), vec![seen, Extent::EMPTY])
    }

    #[test]
    fn every_bit_comes_back() {
        let mut bytes = Vec::new();
        piece().made(0, &Bits::from_points).write_bits(&mut bytes);
        let mut from = &bytes[..];
        let read = Piece::read_bits(&mut from).unwrap();
        assert!(from.is_empty());
        assert_eq!(
            (read.number, read.points().collect::<Vec<_>>(), &read.seen),
            (5, piece().points().collect(), &piece().seen)
        );
        let mut again = Vec::new();
        read.made(0, &Bits::from_points).write_bits(&mut again);
        assert_eq!(bytes, again);
    }

    #[test]
    fn fewer_bytes_are_no_piece() {
        let mut bytes = Vec::new();
        piece().made(0, &Bits::from_points).write_bits(&mut bytes);
        for length in 0..bytes.len() {
            assert!(Piece::read_bits(&mut &bytes[..length]).is_none(), "{length} bytes");
        }
    }
}
