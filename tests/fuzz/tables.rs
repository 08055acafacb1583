//! Tables written at random in the ways of the trade: their numbers are read to the same values, or the file is refused. Tables that were
//! changed afterwards are read or refused, without a panic.
//!
//! 2000 tables; `TABLE_CASES=100000 TABLE_SEED=5 cargo test --release --test all fuzz::tables -- --nocapture` reads more or others, and
//! `TABLE_ONE=123` prints one.
#![allow(clippy::cast_possible_wrap)]

use std::f64::consts::PI;

use gearloss_framework::document::data::sheet::{Assigned, Sheet, Wanted};
use gearloss_framework::document::data::{DateOrder, Decimal, Encoding, Separator, TableForm, Thousands};
use rust_xlsxwriter::Workbook;

use super::random::Random;
use crate::measured_formats::builder::simple;

const WANTED: [Wanted; 4] = [
    ("time", "s"),
    ("torque", "Nm"),
    ("speed", "rpm"),
    ("oil_temperature", "degC"),
];

/// A spelling of a unit, with factor and offset to SI from definitions, not from the program.
type Spelling = (&'static str, f64, f64);

const FOOT_POUND: f64 = 0.3048 * 0.453_592_37 * 9.806_65;

/// Spellings that may be unknown are refused; none may be read as another unit.
const UNITS: [&[Spelling]; 4] = [
    &[
        ("s", 1.0, 0.0),
        ("s", 1.0, 0.0),
        ("ms", 1e-3, 0.0),
        ("min", 60.0, 0.0),
        ("h", 3600.0, 0.0),
    ],
    &[
        ("Nm", 1.0, 0.0),
        ("Nm", 1.0, 0.0),
        ("Nm", 1.0, 0.0),
        ("N m", 1.0, 0.0),
        ("kNm", 1e3, 0.0),
        ("Nmm", 1e-3, 0.0),
        ("mNm", 1e-3, 0.0),
        ("lbf ft", FOOT_POUND, 0.0),
        ("lb-ft", FOOT_POUND, 0.0),
        ("in lbf", FOOT_POUND / 12.0, 0.0),
        ("daNm", 10.0, 0.0),
    ],
    &[
        ("rpm", PI / 30.0, 0.0),
        ("rpm", PI / 30.0, 0.0),
        ("1/min", PI / 30.0, 0.0),
        ("min-1", PI / 30.0, 0.0),
        ("U/min", PI / 30.0, 0.0),
        ("RPM", PI / 30.0, 0.0),
        ("krpm", PI * 1e3 / 30.0, 0.0),
        ("Hz", 2.0 * PI, 0.0),
        ("rad/s", 1.0, 0.0),
    ],
    &[
        ("degC", 1.0, 0.0),
        ("\u{b0}C", 1.0, 0.0),
        ("C", 1.0, 0.0),
        ("K", 1.0, -273.15),
        ("degF", 5.0 / 9.0, -160.0 / 9.0),
    ],
];

/// A table as its writer would make it.
struct Written {
    bytes: Vec<u8>,
    form: TableForm,
    /// Rows in SI.
    rows: Vec<[f64; 4]>,
}

/// A number with some decimals, and its value.
fn number(random: &mut Random, most: usize) -> (i64, usize) {
    let decimals = random.below(5);
    let sign = if random.once_in(5) { -1 } else { 1 };
    (
        sign * random.below(most * 10_usize.pow(decimals as u32)) as i64,
        decimals,
    )
}

fn value((digits, decimals): (i64, usize)) -> f64 {
    digits as f64 / 10_f64.powi(decimals as i32)
}

/// A number as text: decimal sign, and the sign between groups.
fn text((digits, decimals): (i64, usize), decimal: char, groups: Option<char>) -> String {
    let scale = 10_i64.pow(decimals as u32);
    let whole = (digits.abs() / scale).to_string();
    let grouped = match groups {
        Some(sign) => {
            let mut parts: Vec<String> = Vec::new();
            let mut rest = whole.as_str();
            while rest.len() > 3 {
                let (head, tail) = rest.split_at(rest.len() - 3);
                parts.insert(0, tail.to_owned());
                rest = head;
            }
            parts.insert(0, rest.to_owned());
            parts.join(&sign.to_string())
        }
        None => whole,
    };
    let sign = if digits < 0 { "-" } else { "" };
    match decimals {
        0 => format!("{sign}{grouped}"),
        _ => format!("{sign}{grouped}{decimal}{:0decimals$}", digits.abs() % scale),
    }
}

/// Milliseconds after an instant as a date or a clock time, in one of several forms.
fn stamp(form: usize, milliseconds: i64) -> String {
    // From 27 November 2026, 23:59:50.
    let total = 86_390_000 + milliseconds;
    let (days, rest) = (total / 86_400_000, total % 86_400_000);
    let (hour, minute, second, milli) = (rest / 3_600_000, rest / 60_000 % 60, rest / 1000 % 60, rest % 1000);
    let day = 27 + days;
    let clock = format!("{hour:02}:{minute:02}:{second:02}");
    match form {
        0 => format!("2026-11-{day} {clock}.{milli:03}"),
        1 => format!("2026-11-{day}T{clock}.{milli:03}Z"),
        2 => format!("{day}.11.2026 {clock},{milli:03}"),
        3 => format!("11/{day}/2026 {clock}.{milli:03}"),
        4 => format!("2026-11-{day}T{clock}.{milli:03}+01:00"),
        _ => format!("{clock}.{milli:03}"),
    }
}

fn written(random: &mut Random) -> Written {
    let count = 1 + random.below(8);
    // Most are the usual ones, so that most tables are read.
    let units: [Spelling; 4] = UNITS.map(|list| if random.once_in(6) { *random.one(list) } else { list[0] });
    let mut milliseconds = 0;
    let mut rows: Vec<[(i64, usize); 4]> = Vec::new();
    for _ in 0..count {
        milliseconds += 1 + random.below(2000) as i64;
        rows.push([
            (milliseconds, 3),
            number(random, 3000),
            number(random, 20_000),
            (50 + random.below(30) as i64, 0),
        ]);
    }
    let mut form = TableForm::default();
    let si = |row: &[(i64, usize); 4]| -> [f64; 4] { std::array::from_fn(|i| value(row[i]) * units[i].1 + units[i].2) };
    let values: Vec<[f64; 4]> = rows.iter().map(si).collect();
    let names = WANTED.map(|(name, _)| name);
    match random.below(20) {
        0 => {
            let mut book = Workbook::new();
            let sheet = book.add_worksheet();
            let title = random.below(3) as u32;
            if title > 0 {
                sheet.write(0, 0, "Rig 3").unwrap();
            }
            for column in 0..4 {
                sheet.write(title, column as u16, names[column]).unwrap();
                sheet.write(title + 1, column as u16, units[column].0).unwrap();
                for (i, row) in rows.iter().enumerate() {
                    sheet
                        .write(title + 2 + i as u32, column as u16, value(row[column]))
                        .unwrap();
                }
            }
            return Written {
                bytes: book.save_to_buffer().unwrap(),
                form,
                rows: values,
            };
        }
        1 | 2 => {
            let columns: Vec<(&str, &str)> = names.iter().zip(&units).map(|(name, unit)| (*name, unit.0)).collect();
            let plain: Vec<Vec<f64>> = rows.iter().map(|row| row.iter().map(|n| value(*n)).collect()).collect();
            return Written {
                bytes: simple(&columns, &plain),
                form,
                rows: values,
            };
        }
        _ => {}
    }
    // Signs as programs and countries combine them.
    let (separator, sign, decimal, groups) = *random.one(&[
        (Separator::Comma, ',', '.', None),
        (Separator::Comma, ',', '.', None),
        (Separator::Comma, ',', '.', Some(',')),
        (Separator::Comma, ',', '.', Some(' ')),
        (Separator::Comma, ',', ',', None),
        (Separator::Semicolon, ';', ',', None),
        (Separator::Semicolon, ';', ',', Some('.')),
        (Separator::Semicolon, ';', ',', Some('\u{a0}')),
        (Separator::Semicolon, ';', '.', Some('\'')),
        (Separator::Semicolon, ';', '.', None),
        (Separator::Tab, '\t', '.', Some(',')),
        (Separator::Tab, '\t', ',', Some('.')),
        (Separator::Tab, '\t', '.', None),
        (Separator::Blank, ' ', '.', None),
        (Separator::Blank, ' ', ',', None),
    ]);
    let is_blank = separator == Separator::Blank;
    let dates = (!is_blank && random.once_in(3)).then(|| random.below(6));
    let mut values = values;
    if dates.is_some() {
        for (i, row) in values.iter_mut().enumerate() {
            row[0] = (rows[i][0].0 - rows[0][0].0) as f64 / 1000.0;
        }
    }
    let mut lines: Vec<String> = Vec::new();
    let cell = |cell: String| {
        if cell.contains(sign) {
            format!("\"{cell}\"")
        } else {
            cell
        }
    };
    for _ in 0..random.below(4) {
        lines.push(
            (*random.one(&[
                "# a comment",
                "",
                "Rig 3",
                "Date: 27.11.2026",
                "time 12",
                "a,b;c\td",
                "1500;2",
            ]))
            .to_owned(),
        );
    }
    if random.once_in(6) && !is_blank {
        lines.insert(0, format!("sep={sign}"));
    }
    let in_row = random.once_in(2);
    let heading = |i: usize| {
        if in_row || (i == 0 && dates.is_some()) {
            names[i].to_owned()
        } else {
            format!("{} [{}]", names[i], units[i].0)
        }
    };
    let join = |cells: Vec<String>| cells.join(&sign.to_string());
    lines.push(join((0..4).map(heading).collect()));
    if random.once_in(4) {
        form.header_line = Some(lines.len() as u64);
    }
    if in_row {
        let unit = |i: usize| {
            if i == 0 && dates.is_some() {
                "hh:mm:ss".to_owned()
            } else {
                units[i].0.replace(' ', if is_blank { "" } else { " " })
            }
        };
        lines.push(join((0..4).map(unit).collect()));
    }
    for row in &rows {
        let mut cells: Vec<String> = row.iter().map(|n| cell(text(*n, decimal, groups))).collect();
        if let Some(form) = dates {
            cells[0] = cell(stamp(form, row[0].0));
        }
        let comment = if random.once_in(6) { " # a note" } else { "" };
        lines.push(join(cells) + comment);
        if random.once_in(10) {
            lines.push(String::new());
        }
    }
    if random.once_in(3) {
        form.separator = Some(separator);
    }
    if random.once_in(3) {
        form.decimal = Some(if decimal == ',' { Decimal::Comma } else { Decimal::Point });
    }
    if random.once_in(3) {
        form.thousands = match groups {
            Some(',') => Some(Thousands::Comma),
            Some('.') => Some(Thousands::Point),
            _ => None,
        };
    }
    if dates == Some(3) && random.once_in(2) {
        form.date_order = Some(DateOrder::MonthFirst);
    }
    let text = lines.join(*random.one(&["\n", "\r\n"])) + "\n";
    let bytes: Vec<u8> = match random.below(6) {
        0 => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
        1 => format!("\u{feff}{text}")
            .encode_utf16()
            .flat_map(u16::to_be_bytes)
            .collect(),
        2 => format!("\u{feff}{text}").into_bytes(),
        3 => text.chars().map(|c| u32::from(c) as u8).collect(),
        4 => {
            form.encoding = Some(Encoding::Utf8);
            text.into_bytes()
        }
        _ => text.into_bytes(),
    };
    Written {
        bytes,
        form,
        rows: values,
    }
}

/// The rows in SI, or the first error.
fn read(bytes: &[u8], form: &TableForm) -> Result<Vec<[f64; 4]>, String> {
    let sheet = Sheet::open_series(bytes, form, &WANTED, Assigned::default(), "time")
        .map_err(|faults| format!("{}: {}", faults[0].message, faults[0].help))?;
    let row = |row: usize| -> Result<[f64; 4], String> {
        let mut values = [0.0; 4];
        for (column, value) in values.iter_mut().enumerate() {
            *value = sheet.number(row, column)?.ok_or("no such column")?;
        }
        Ok(values)
    };
    (0..sheet.table.rows.len()).map(row).collect()
}

fn given(key: &str) -> Option<u64> {
    std::env::var(key).ok()?.parse().ok()
}

#[test]
fn quantities_are_read_to_their_values_or_refused() {
    let seed = given("TABLE_SEED").unwrap_or(27);
    let (first, end) = match given("TABLE_ONE") {
        Some(number) => (number, number + 1),
        None => (0, given("TABLE_CASES").unwrap_or(2000)),
    };
    let (mut right, mut refused) = (0, std::collections::BTreeMap::<String, usize>::new());
    for number in first..end {
        let mut random = Random::from_seed(seed, number);
        let written = written(&mut random);
        if end == first + 1 {
            println!("{}\n{:?}", String::from_utf8_lossy(&written.bytes), written.form);
        }
        match read(&written.bytes, &written.form) {
            Ok(rows) => {
                right += 1;
                assert_eq!(rows.len(), written.rows.len(), "case {number} of seed {seed}: rows");
                for (found, expected) in rows.iter().flatten().zip(written.rows.iter().flatten()) {
                    let is_equal = (found - expected).abs() <= 1e-9 * expected.abs().max(1e-3);
                    assert!(is_equal, "case {number} of seed {seed}: {found} instead of {expected}");
                }
            }
            Err(why) => {
                let words: Vec<&str> = why
                    .split(|c: char| !c.is_alphabetic())
                    .filter(|word| word.len() > 2)
                    .collect();
                *refused.entry(words[..words.len().min(8)].join(" ")).or_default() += 1;
            }
        }
        // What was changed may have other numbers, but they are numbers.
        let mut changed = written.bytes;
        for _ in 0..=random.below(4) {
            let (place, byte) = (random.below(changed.len()), *random.one(b"0.,;:-\t\n\"# [e'\xb0\0\xff"));
            match random.below(3) {
                0 => changed[place] = byte,
                1 => changed.insert(place, byte),
                _ => drop(changed.remove(place)),
            }
        }
        if let Ok(rows) = read(&changed, &written.form) {
            assert!(
                rows.iter().flatten().all(|x| x.is_finite()),
                "case {number} of seed {seed}"
            );
        }
    }
    println!("{right} of {} tables are read", end - first);
    for (why, count) in &refused {
        println!("  {count}: {why}");
    }
    // A reader that refuses all would be right, too.
    assert!(
        2 * right > end - first || end == first + 1,
        "{right} of {} tables are read",
        end - first
    );
}
