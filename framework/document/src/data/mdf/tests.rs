#![allow(clippy::unwrap_used)]

use super::builder::{ChannelFields, MdfBuilder, simple};
use super::*;
use crate::data::{TableForm, cells};

fn read(bytes: &[u8], group: Option<&str>) -> Table {
    table(bytes, group, &mut Vec::new()).unwrap()
}

fn refused(bytes: &[u8], group: Option<&str>) -> String {
    let wrong = table(bytes, group, &mut Vec::new()).err().unwrap();
    format!("{} | {}", wrong.message, wrong.help)
}

fn rows(table: &Table) -> Vec<Vec<&str>> {
    table
        .rows
        .iter()
        .map(|(_, cells)| cells.iter().map(String::as_str).collect())
        .collect()
}

#[test]
fn a_simple_file_is_a_table_with_units() {
    let bytes = simple(
        &[("t", "s"), ("T_in", "Nm"), ("n", "")],
        &[vec![0.0, 0.1, -5.0], vec![0.01, 1e-7, f64::NAN]],
    );
    let mut notes = Vec::new();
    let found = cells::table(&bytes, &TableForm::default(), &|_| true, &mut notes).unwrap();
    assert_eq!(found.names, ["t", "T_in", "n"]);
    assert_eq!(found.units, [Some("s".to_owned()), Some("Nm".to_owned()), None]);
    assert_eq!(rows(&found), [["0", "0.1", "-5"], ["0.01", "1e-7", "NaN"]]);
    assert_eq!((found.rows[0].0, found.header_line, notes.len()), (1, 0, 0));
    assert_eq!(found.part.as_deref(), Some("channel group 1"));
    assert!(
        cells::table(
            &bytes,
            &TableForm {
                sheet: Some("a".to_owned()),
                ..TableForm::default()
            },
            &|_| true,
            &mut notes
        )
        .is_err()
    );
}

/// All kinds of numbers in one record, in both orders of their bytes.
#[test]
fn integers_and_floats_of_all_lengths_are_read() {
    for big in [false, true] {
        let mut file = MdfBuilder::new();
        let mut record = Vec::new();
        let mut fields = Vec::new();
        let mut add = |name, data_type: u8, bits: u32, value: u64| {
            let length = bits as usize / 8;
            let mut bytes = value.to_le_bytes()[..length].to_vec();
            if big {
                bytes.reverse();
            }
            fields.push(ChannelFields {
                data_type: data_type + u8::from(big),
                byte: record.len() as u32,
                bits,
                ..ChannelFields::float(name, "", 0)
            });
            record.extend(bytes);
        };
        add("u8", 0, 8, 200);
        add("u16", 0, 16, 0xfffe);
        add("u24", 0, 24, 0x01_0203);
        add("u32", 0, 32, 4_000_000_000);
        add("u64", 0, 64, 1 << 52);
        add("i8", 2, 8, (-3_i64).cast_unsigned());
        add("i16", 2, 16, (-300_i64).cast_unsigned());
        add("i32", 2, 32, (-70_000_i64).cast_unsigned());
        add("i64", 2, 64, (-5_i64).cast_unsigned());
        add("f16", 4, 16, 0x3e00);
        add("f32", 4, 32, u64::from(0.1_f32.to_bits()));
        add("f64", 4, 64, (-0.1_f64).to_bits());
        let channels = file.channels(&fields);
        let length = record.len() as u32;
        let data = file.block(*b"DT", &[], &record);
        let group = file.group(0, channels, "", (0, 1, length, 0));
        let first = file.data_group(0, group, data, 0);
        let found = read(&file.finish(first), None);
        assert_eq!(
            rows(&found)[0],
            [
                "200",
                "65534",
                "66051",
                "4000000000",
                "4503599627370496",
                "-3",
                "-300",
                "-70000",
                "-5",
                "1.5",
                "0.10000000149011612",
                "-0.1"
            ]
        );
    }
}

#[test]
fn bits_conversions_and_validity_are_applied() {
    let mut file = MdfBuilder::new();
    let conversions = [
        file.conversion(0, &[], &[]),
        file.conversion(1, &[-40.0, 0.5], &[]),
        // 1 / x.
        file.conversion(2, &[0.0, 0.0, 1.0, 0.0, 1.0, 0.0], &[]),
        file.conversion(4, &[0.0, 10.0, 4.0, 30.0], &[]),
        file.conversion(5, &[0.0, 10.0, 4.0, 30.0], &[]),
    ];
    let (low, high) = (file.text("first"), file.text("second"));
    let texts = file.conversion(7, &[2.0, 3.0], &[low, high]);
    let formula = file.conversion(3, &[], &[low]);
    // Bits 3 to 5 of the second byte.
    let bits = |name, conversion| ChannelFields {
        data_type: 0,
        byte: 1,
        bit: 3,
        bits: 3,
        conversion,
        ..ChannelFields::float(name, "", 0)
    };
    let mut fields: Vec<_> = ["same", "linear", "rational", "line", "nearest"]
        .into_iter()
        .zip(conversions)
        .map(|(name, c)| bits(name, c))
        .collect();
    fields.push(bits("texts", texts));
    fields.push(bits("formula", formula));
    fields.push(ChannelFields {
        flags: (2, 1),
        ..bits("checked", 0)
    });
    fields.push(ChannelFields {
        kind: 3,
        bits: 0,
        conversion: fields[1].conversion,
        ..bits("time", 0)
    });
    fields.push(ChannelFields {
        data_type: 7,
        byte: 2,
        bit: 0,
        bits: 24,
        ..bits("text", 0)
    });
    let channels = file.channels(&fields);
    let data = file.block(*b"DT", &[], b"\xff\x10ab\0\x00\xff\x18abc\x02");
    let group = file.group(0, channels, "", (0, 2, 5, 1));
    let first = file.data_group(0, group, data, 0);
    let found = read(&file.finish(first), None);
    assert_eq!(
        found.names,
        [
            "same", "linear", "rational", "line", "nearest", "texts", "checked", "time", "text"
        ]
    );
    assert_eq!(
        rows(&found)[0],
        ["2", "-39", "0.5", "20", "10", "first", "2", "-40", "ab"]
    );
    assert_eq!(
        rows(&found)[1],
        [
            "3",
            "-38.5",
            "0.3333333333333333",
            "25",
            "30",
            "second",
            "",
            "-39.5",
            "abc"
        ]
    );
    assert_eq!(
        found.lacks("formula").split(';').next(),
        Some("`formula` cannot be read: a conversion by a formula")
    );
}

/// Two groups whose records are mixed, and the texts of a third.
#[test]
fn records_of_several_groups_are_sorted() {
    let mut file = MdfBuilder::new();
    let fast = file.channels(&[ChannelFields::float("t", "s", 0), ChannelFields::float("T", "Nm", 8)]);
    let slow = file.channels(&[ChannelFields::float("T_oil", "degC", 0)]);
    let mut data = Vec::new();
    for i in 0..4 {
        data.push(7);
        data.extend([f64::from(i), 10.0 * f64::from(i)].iter().flat_map(|x| x.to_le_bytes()));
        if i % 2 == 0 {
            data.push(9);
            data.extend((80.0 + f64::from(i)).to_le_bytes());
            data.extend([3, 2, 0, 0, 0, b'h', b'i']);
        }
    }
    let data = file.block(*b"DT", &[], &data);
    let texts = file.group(0, 0, "", (3, 0, 0, 0));
    let at = texts as usize + 24 + 48 + 16;
    file.0[at] = 1;
    let slow = file.group(texts, slow, "slow", (9, 2, 8, 0));
    let fast = file.group(slow, fast, "fast", (7, 4, 16, 0));
    let first = file.data_group(0, fast, data, 1);
    let bytes = file.finish(first);
    assert_eq!(rows(&read(&bytes, Some("slow"))), [["80"], ["82"]]);
    assert_eq!(rows(&read(&bytes, Some("1")))[3], ["3", "30"]);
    let several = refused(&bytes, None);
    assert!(
        several.contains("1 `fast` (4 samples of t, T); 2 `slow` (2 samples of T_oil) | choose one, `group:"),
        "{several}"
    );
    let unknown = refused(&bytes, Some("fats"));
    assert!(
        unknown.contains("there is no channel group `fats`") && unknown.contains("write `group: fast`"),
        "{unknown}"
    );
}

/// A list of packed blocks, as they are and column by column, gives the rows of one plain block.
#[test]
fn packed_blocks_are_unpacked() {
    let rows_in: Vec<[f64; 2]> = (0..1000)
        .map(|i| [f64::from(i) * 0.1, (f64::from(i) * 0.3).sin()])
        .collect();
    let bytes: Vec<u8> = rows_in.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let mut file = MdfBuilder::new();
    let fields = [ChannelFields::float("t", "s", 0), ChannelFields::float("T", "Nm", 8)];
    let channels = file.channels(&fields);
    let mut blocks = Vec::new();
    // Records may be divided between blocks, and the last of a transposed one is incomplete.
    for (i, piece) in bytes.chunks(5000).enumerate() {
        let method = u8::from(i % 2 == 1);
        let content = if method == 1 {
            let (columns, rows) = (16, piece.len() / 16);
            let mut turned = Vec::new();
            for column in 0..columns {
                turned.extend((0..rows).map(|row| piece[row * columns + column]));
            }
            turned.extend(&piece[rows * columns..]);
            turned
        } else {
            piece.to_vec()
        };
        let packed = miniz_oxide::deflate::compress_to_vec_zlib(&content, 6);
        let mut data = vec![b'D', b'T', method, 0];
        data.extend((16 * u32::from(method)).to_le_bytes());
        data.extend((content.len() as u64).to_le_bytes());
        data.extend((packed.len() as u64).to_le_bytes());
        data.extend(packed);
        blocks.push(file.block(*b"DZ", &[], &data));
    }
    let (head, tail) = blocks.split_at(2);
    let second = file.block(*b"DL", &[&[0], tail].concat(), &[0; 16]);
    let list = file.block(*b"DL", &[&[second], head].concat(), &[0; 16]);
    let data = file.block(*b"HL", &[list], &[0; 8]);
    let group = file.group(0, channels, "", (0, 1000, 16, 0));
    let first = file.data_group(0, group, data, 0);
    let found = read(&file.finish(first), None);
    let plain = simple(&[("t", "s"), ("T", "Nm")], &rows_in.map_rows());
    assert_eq!(found.rows, read(&plain, None).rows);
}

trait Rows {
    fn map_rows(&self) -> Vec<Vec<f64>>;
}

impl Rows for Vec<[f64; 2]> {
    fn map_rows(&self) -> Vec<Vec<f64>> {
        self.iter().map(|row| row.to_vec()).collect()
    }
}

#[test]
fn other_versions_and_damaged_files_are_refused() {
    let whole = simple(&[("t", "s"), ("T", "Nm")], &[vec![0.0, 1.0], vec![1.0, 2.0]]);
    let mut old = whole.clone();
    old[8..12].copy_from_slice(b"3.30");
    assert!(refused(&old, None).contains("of version `3.30`; version 4 (.mf4) is read"));
    let mut open = whole.clone();
    open[..8].copy_from_slice(b"UnFinMF ");
    assert!(refused(&open, None).contains("not finalized"));
    assert!(refused(&whole[..whole.len() - 40], None).contains("damaged"));
    assert!(refused(&whole[..12], None).contains("too short"));
    // A list of data groups that returns to itself.
    let mut circle = whole.clone();
    let at = u64::from_le_bytes(circle[88..96].try_into().unwrap()) as usize;
    let address = (at as u64).to_le_bytes();
    circle[at + 24..at + 32].copy_from_slice(&address);
    assert!(refused(&circle, None).contains("blocks"));
}

/// A generator of numbers that needs no crate (xorshift).
fn next(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

#[test]
fn changed_files_never_panic() {
    let plain = simple(&[("t", "s"), ("T", "Nm"), ("n", "rpm")], &vec![vec![1.0, 2.0, 3.0]; 20]);
    let mut state = 0x9e37_79b9_7f4a_7c15;
    for _ in 0..20_000 {
        let mut bytes = plain.clone();
        for _ in 0..=next(&mut state) % 6 {
            let at = 16 + next(&mut state) as usize % (bytes.len() - 16);
            bytes[at] = match next(&mut state) % 4 {
                0 => 0,
                1 => 0xff,
                2 => bytes[at] ^ (1 << (next(&mut state) % 8)),
                _ => next(&mut state) as u8,
            };
        }
        if next(&mut state).is_multiple_of(10) {
            bytes.truncate(64 + next(&mut state) as usize % (bytes.len() - 64));
        }
        let _ = table(&bytes, None, &mut Vec::new());
        let _ = table(&bytes, Some("1"), &mut Vec::new());
    }
}
