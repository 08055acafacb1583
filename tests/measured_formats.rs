//! Measured points, recorded cycles, spectra and motor maps as CSV, as workbooks and as MDF files: the same numbers, the same results.

use rust_xlsxwriter::{Format, Formula, Workbook};
use serde_json::Value;

use crate::common::study::{Ran, of_gearbox, run_files};

// Some of its blocks are for the tests of that crate.
#[allow(dead_code)]
#[path = "../framework/document/src/data/mdf/builder.rs"]
pub mod builder;

const GEARBOX: &str = "tests/cases/fine/input.yaml";

/// Torque, speed and loss with digits that need all of a double.
fn points() -> Vec<Vec<f64>> {
    let torques = [-10.0, -2.5, 0.1 + 0.2, 5.0, 12.345678901234567];
    let points = torques
        .iter()
        .flat_map(|torque| [500.0, 1500.0, 3000.0].map(|speed| (*torque, speed)));
    points
        .map(|(torque, speed)| vec![torque, speed, 3.0 + 0.011 * torque * torque + speed / 700.0])
        .collect()
}

const COLUMNS: [(&str, &str); 3] = [("torque", "Nm"), ("speed", "rpm"), ("loss", "W")];

fn csv(columns: &[(&str, &str)], rows: &[Vec<f64>]) -> Vec<u8> {
    let header: Vec<String> = columns.iter().map(|(name, unit)| format!("{name} [{unit}]")).collect();
    let line = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let lines: Vec<String> = [header.join(",")].into_iter().chain(rows.iter().map(line)).collect();
    (lines.join("\n") + "\n").into_bytes()
}

/// A workbook with the units in a row of their own, a second sheet, and the last number as a formula with its value.
fn xlsx(columns: &[(&str, &str)], rows: &[Vec<f64>]) -> Vec<u8> {
    let mut book = Workbook::new();
    let sheet = book.add_worksheet().set_name("rig data").unwrap();
    for (column, (name, unit)) in columns.iter().enumerate() {
        sheet.write(0, column as u16, *name).unwrap();
        sheet.write(1, column as u16, *unit).unwrap();
        for (i, row) in rows.iter().enumerate() {
            let (at, number) = (i as u32 + 2, row[column]);
            if i + 1 == rows.len() {
                let formula = Formula::new(format!("={number}")).set_result(number.to_string());
                sheet.write_formula(at, column as u16, formula).unwrap();
            } else {
                sheet.write(at, column as u16, number).unwrap();
            }
        }
    }
    book.add_worksheet()
        .set_name("notes")
        .unwrap()
        .write(0, 0, "who measured")
        .unwrap();
    book.save_to_buffer().unwrap()
}

fn run(rest: &str, files: &[(&str, Vec<u8>)]) -> Ran {
    let ran = run_files(&of_gearbox(GEARBOX, rest), files);
    assert!(ran.succeeded, "{}", ran.text);
    ran
}

/// A result without what names or hashes files, their lines and notes.
fn numbers(mut result: Value, without: &[&str]) -> Value {
    fn strip(value: &mut Value, without: &[&str]) {
        match value {
            Value::Object(map) => {
                map.retain(|key, _| !without.contains(&key.as_str()));
                map.values_mut().for_each(|value| strip(value, without));
            }
            Value::Array(list) => list.iter_mut().for_each(|value| strip(value, without)),
            _ => {}
        }
    }
    strip(&mut result, without);
    result
}

#[test]
fn csv_workbook_and_mdf_give_identical_results() {
    let files = [
        ("a.csv", csv(&COLUMNS, &points())),
        // The content decides, not the name.
        ("a.dat", xlsx(&COLUMNS, &points())),
        ("a.mf4", builder::simple(&COLUMNS, &points())),
    ];
    let study = "
measurements: { text: { file: a.csv }, book: { file: a.dat }, mdf: { file: a.mf4 } }
analyses:
  text: { type: compare, data: text, against: [own], quantity: loss, difference: percent }
  book: { type: compare, data: book, against: [own], quantity: loss, difference: percent }
  mdf:  { type: compare, data: mdf, against: [own], quantity: loss, difference: percent }
";
    let ran = run(study, &files);
    let of = |name: &str| {
        let result = ran.json(name);
        assert_eq!(
            result["comparisons"][0]["points"].as_array().unwrap().len(),
            points().len()
        );
        numbers(result["comparisons"].clone(), &["line", "file", "origin"])
    };
    assert_eq!(of("text"), of("book"));
    assert_eq!(of("text"), of("mdf"));
    assert!(
        ran.text
            .contains("sheet `rig data` is read; `sheet` chooses another: `notes`"),
        "{}",
        ran.text
    );
}

#[test]
fn recorded_cycles_and_spectra_give_identical_results() {
    let columns = [("time", "s"), ("torque", "Nm"), ("speed", "rpm")];
    let rows: Vec<Vec<f64>> = (0..30)
        .map(|i| {
            vec![
                f64::from(i) * 0.1,
                5.0 + (f64::from(i) * 0.7).sin(),
                1000.0 + f64::from(i),
            ]
        })
        .collect();
    let loads = [("torque", "Nm"), ("speed", "rpm"), ("share", "%")];
    let shares = vec![vec![3.0, 1000.0, 62.5], vec![8.0, 2000.0, 37.5]];
    let files = [
        ("a.csv", csv(&columns, &rows)),
        ("a.xlsx", xlsx(&columns, &rows)),
        ("a.mf4", builder::simple(&columns, &rows)),
        ("b.csv", csv(&loads, &shares)),
        ("b.xlsx", xlsx(&loads, &shares)),
        ("b.mf4", builder::simple(&loads, &shares)),
    ];
    let study = "
cycles:
  text: { file: a.csv }
  book: { file: a.xlsx, sheet: rig data }
  mdf: { file: a.mf4 }
  text_loads: { spectrum: { file: b.csv }, duration: 1 h }
  book_loads: { spectrum: { file: b.xlsx, sheet: rig data }, duration: 1 h }
  mdf_loads: { spectrum: { file: b.mf4 }, duration: 1 h }
analyses:
  text: { type: cycle, cycles: [text] }
  book: { type: cycle, cycles: [book] }
  mdf: { type: cycle, cycles: [mdf] }
  text_loads: { type: cycle, cycles: [text_loads] }
  book_loads: { type: cycle, cycles: [book_loads] }
  mdf_loads: { type: cycle, cycles: [mdf_loads] }
";
    let ran = run(study, &files);
    let of = |name: &str| {
        let mut result = numbers(
            ran.json(name),
            &["inputs", "name", "cycle", "analysis", "notes", "about", "warnings"],
        );
        result.as_object_mut().unwrap().remove("study");
        result
    };
    for kind in ["", "_loads"] {
        let text = of(&format!("text{kind}"));
        assert_eq!(text, of(&format!("book{kind}")));
        assert_eq!(text, of(&format!("mdf{kind}")));
    }
}

#[test]
fn faults_name_sheet_row_and_column() {
    let mut book = Workbook::new();
    let sheet = book.add_worksheet().set_name("Lauf 3").unwrap();
    for (column, header) in ["torque [Nm]", "speed [rpm]", "loss [W]", "at"].iter().enumerate() {
        sheet.write(2, column as u16, *header).unwrap();
    }
    let date = Format::new().set_num_format("yyyy-mm-dd hh:mm");
    for (row, torque) in [(4, "1"), (5, "x")] {
        sheet.write(row, 0, torque).unwrap();
        sheet.write(row, 1, 1000).unwrap();
        sheet
            .write_formula(row, 2, Formula::new("=1/0").set_result("#DIV/0!"))
            .unwrap();
        sheet.write_with_format(row, 3, 45_000.5, &date).unwrap();
    }
    let files = [("rig.xlsx", book.save_to_buffer().unwrap()), ("two.mf4", two_groups())];
    let refused = |rig: &str| {
        let study = format!(
            "measurements: {{ rig: {{ {rig} }} }}\nanalyses:\n  a: {{ type: compare, data: rig, against: [own], quantity: loss }}\n"
        );
        let ran = run_files(&of_gearbox(GEARBOX, &study), &files);
        assert!(!ran.succeeded, "{}", ran.text);
        ran.text
    };
    let text = refused("file: rig.xlsx");
    assert!(
        text.contains("rig.xlsx: sheet `Lauf 3`: line 5, column 3 `loss`: `"),
        "{text}"
    );
    assert!(
        text.contains("line 6, column 1 `torque`: `x` is not a number"),
        "{text}"
    );
    let text = refused("file: rig.xlsx, columns: { torque: at }, units: { torque: Nm }");
    assert!(
        text.contains("line 5, column 4 `at`: a date or time, stored as `45000.5`"),
        "{text}"
    );
    let text = refused("file: rig.xlsx, sheet: Lauf 2");
    assert!(
        text.contains("there is no sheet `Lauf 2`; there are: `Lauf 3`"),
        "{text}"
    );
    assert!(
        text.contains("measurements.rig.sheet") || text.contains("sheet: Lauf 2"),
        "{text}"
    );
    let text = refused("file: two.mf4");
    assert!(
        text.contains("several channel groups, each with its own raster: 1 `fast`"),
        "{text}"
    );
    let text = refused("file: two.mf4, group: slow, columns: { torque: T }");
    assert!(
        text.contains("two.mf4: channel group `slow`: there is no column `T`; there are: T_oil"),
        "{text}"
    );
    let text = refused("file: two.mf4, sheet: slow");
    assert!(text.contains("an MDF file has no `sheet`"), "{text}");
}

/// A file with two rasters.
fn two_groups() -> Vec<u8> {
    let mut file = builder::MdfBuilder::new();
    let fast = file.channels(&[builder::ChannelFields::float("T", "Nm", 0)]);
    let slow = file.channels(&[builder::ChannelFields::float("T_oil", "degC", 0)]);
    let data = file.block(*b"DT", &[], &[0; 16]);
    let [fast, slow] =
        [(fast, "fast"), (slow, "slow")].map(|(channels, name)| file.group(0, channels, name, (0, 2, 8, 0)));
    let slow = file.data_group(0, slow, data, 0);
    let fast = file.data_group(slow, fast, data, 0);
    file.finish(fast)
}

/// The workbook that `write: [xlsx]` makes is read again: its row of meanings has no numbers and is omitted.
#[test]
fn a_written_workbook_is_read_again() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("measured-workbook");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let grid = "grids: { field: { torque: [-5 Nm, 5 Nm, 10 Nm], speed: [1000 rpm, 2000 rpm] } }\n";
    let first = format!("{grid}analyses: {{ field: {{ type: map, grid: field, write: [xlsx] }} }}\n");
    std::fs::write(folder.join("study.yaml"), of_gearbox(GEARBOX, &first)).unwrap();
    let out = folder.join("out");
    let program = std::process::Command::new(env!("CARGO_BIN_EXE_gearloss"))
        .args([
            "run",
            folder.join("study.yaml").to_str().unwrap(),
            "-o",
            out.to_str().unwrap(),
        ])
        .output()
        .unwrap();
    assert!(program.status.success(), "{}", String::from_utf8_lossy(&program.stderr));
    let book = std::fs::read(out.join("field.xlsx")).unwrap();
    let second = "
measurements:
  book:
    { file: field.xlsx, sheet: field, faulty_rows: skip, columns: { torque: torque_nm, speed: speed_rpm, loss: loss_w } }
analyses:
  book: { type: compare, data: book, against: [own], quantity: loss, difference: percent }
";
    let ran = run(second, &[("field.xlsx", book)]);
    let result = ran.json("book");
    let points = result["comparisons"][0]["points"].as_array().unwrap();
    assert_eq!(points.len(), 6);
    for point in points {
        assert!(point["difference"].as_f64().unwrap().abs() < 1e-9, "{point}");
    }
}
