//! Files of rigs, loggers and spreadsheets: where their header, units and times are.

use rust_xlsxwriter::{Format, Workbook};

use super::{Case, Said};
use crate::measured_formats::builder::{ChannelFields, MdfBuilder, simple};

/// Ideal but for an efficiency of 0.9: a loss of a tenth of the input power.
const FOLDER: &str = "recorded_tables";

/// A case with a study of one cycle or one measurement, `form` being its file and keys.
fn cycle(purpose: &str, form: &str) -> Case {
    let case = Case::new(FOLDER, purpose);
    write_cycle(&case, form);
    case
}

fn write_cycle(case: &Case, form: &str) {
    case.write(
        "study.yaml",
        format!(
            "gearloss: study/1\ngearboxes: {{ g: gearbox.yaml }}\ncycles:\n  d: {{ {form} }}\nanalyses:\n  c: {{ type: cycle, cycles: [d] }}\n"
        ),
    );
}

fn comparison(purpose: &str, form: &str) -> Case {
    let case = Case::new(FOLDER, purpose);
    write_comparison(&case, form);
    case
}

fn write_comparison(case: &Case, form: &str) {
    case.write(
        "study.yaml",
        format!(
            "gearloss: study/1\ngearboxes: {{ g: gearbox.yaml }}\nmeasurements:\n  rig: {{ {form} }}\nanalyses:\n  c: {{ type: compare, data: rig, against: [own], quantity: loss }}\n"
        ),
    );
}

/// The message of a run that must be refused.
fn refused(case: &Case) -> String {
    let told = |arguments: &[&str]| {
        let Said { code, text } = case.gearloss(arguments);
        assert_eq!(code, Some(2), "{text}");
        // Lines are broken for the terminal.
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let text = told(&["run", "study.yaml", "-o", "results"]);
    let checked = told(&["check", "study.yaml"]);
    assert!(text.contains(&checked), "`check` says {checked}, and `run` {text}");
    text
}

fn assert_refused(case: &Case, told: &[&str]) {
    let text = refused(case);
    for told in told {
        assert!(text.contains(told), "`{told}` is not in: {text}");
    }
}

/// Mean loss of the cycle. \[W\]
fn mean_loss(case: &Case) -> f64 {
    case.result("study.yaml", "c")["cycles"][0]["mean_loss_w"]
        .as_f64()
        .unwrap()
}

/// Differences of the points; absent where none is stated.
fn differences(case: &Case) -> Vec<Option<f64>> {
    let result = case.result("study.yaml", "c");
    let points = result["comparisons"][0]["points"].as_array();
    let points = points.unwrap_or_else(|| panic!("{result:#}"));
    points.iter().map(|point| point["difference"].as_f64()).collect()
}

fn assert_close(found: f64, expected: f64, most: f64) {
    assert!((found - expected).abs() <= most, "{found} instead of {expected}");
}

fn assert_differences(case: &Case, expected: &[f64]) {
    let found = differences(case);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert_close(found.unwrap(), *expected, 0.006);
    }
}

/// A tenth of the mean power of torques in Nm at 1000 rpm. \[W\]
fn tenth(torque: f64) -> f64 {
    0.1 * torque * 1000.0 * std::f64::consts::PI / 30.0
}

#[test]
fn a_name_that_occurs_twice_is_an_error_with_both_places() {
    // The second torque is that of the input; the first one is that of the output.
    let rig = "T [Nm];n_in [rpm];T [Nm];P [W]\n18,0;1000;10,0;104,72\n21,6;1000;12,0;125,66\n";
    let columns = |torque: &str| format!("file: rig.csv, columns: {{ torque: {torque}, speed: n_in, loss: P }}");
    let case = comparison("twice", &columns("T"));
    case.write("rig.csv", rig);
    assert_refused(
        &case,
        &[
            "rig.csv: line 1: `T` is the name of several columns: 1, 3",
            "`columns: { torque: \"T#1\"` or `\"T#2\" }`",
        ],
    );
    write_comparison(&case, &columns("\"T#2\""));
    assert_differences(&case, &[0.0, 0.0]);
    // The unit decides if it can be that of only one of them.
    case.write("rig.csv", rig.replacen("T [Nm]", "T [degC]", 1));
    write_comparison(&case, &columns("T"));
    assert_differences(&case, &[0.0, 0.0]);
}

#[test]
fn a_channel_that_occurs_twice_is_an_error_with_both_places() {
    let columns = [
        ("time", "s"),
        ("Speed_In", "rpm"),
        ("Speed_In", "rpm"),
        ("Torque_In", "Nm"),
    ];
    let rows: Vec<Vec<f64>> = (0..5).map(|i| vec![0.1 * f64::from(i), 2000.0, 1000.0, 10.0]).collect();
    let form = |speed: &str| format!("file: rig.mf4, columns: {{ speed: {speed}, torque: Torque_In }}");
    let case = cycle("channel-twice", &form("Speed_In"));
    case.write("rig.mf4", simple(&columns, &rows));
    assert_refused(
        &case,
        &["`Speed_In` is the name of several channels: 2, 3", "\"Speed_In#2\""],
    );
    write_cycle(&case, &form("\"Speed_In#2\""));
    assert_close(mean_loss(&case), tenth(10.0), 1e-9);
}

#[test]
fn an_unknown_unit_in_a_row_of_units_is_named_and_the_others_hold() {
    let case = comparison(
        "unit-row",
        "file: rig.csv, columns: { torque: T, speed: n_in, loss: P }",
    );
    let rig = |unit: &str| format!("T;n_in;P\nNm;{unit};W\n10,0;1000;104,72\n12,0;1000;125,66\n");
    case.write("rig.csv", rig("furlong"));
    let text = refused(&case);
    assert!(text.contains("line 2, column `n_in`: unknown unit `furlong`"), "{text}");
    assert!(
        !text.contains("has no unit") && !text.contains("not a number"),
        "{text}"
    );
    case.write("rig.csv", rig("min-1"));
    assert_differences(&case, &[0.0, 0.0]);
}

#[test]
fn a_header_below_the_preamble_of_a_logger_is_found_and_segments_are_chosen() {
    let form = |lines: &str| format!("file: logger.csv, columns: {{ torque: T_out, speed: n_engine }}{lines}");
    // The help of each message leads to the next one, and to the end.
    let case = cycle("logger", &form(""));
    assert_refused(
        &case,
        &[
            "line 40 repeats the header of line 10: the file has several segments",
            "`last_line: 34`",
            "`header_line: 40`",
        ],
    );
    write_cycle(&case, &form(", last_line: 34"));
    assert_refused(
        &case,
        &[
            "line 15: time 0 s is before the 3.8 s of line 13",
            "`first_line` and `last_line`",
        ],
    );
    write_cycle(&case, &form(", first_line: 15, last_line: 34"));
    // Trapezes of torque and speed between rows, each as the means of both.
    let mean: f64 = (0..19)
        .map(|i| (10.05 + 0.1 * f64::from(i)) * (650.5 + f64::from(i)) * std::f64::consts::PI / 30.0 * 0.1)
        .sum::<f64>()
        / 19.0;
    assert_close(mean_loss(&case), mean, 1e-6);
    write_cycle(&case, &form(", header_line: 40, first_line: 45"));
    assert_close(mean_loss(&case), mean, 1e-6);
    write_cycle(&case, &form(", header_line: 1"));
    assert_refused(&case, &["there is no column `T_out`; there are: Data logger file"]);
    write_cycle(&case, &form(", header_line: 99"));
    assert_refused(&case, &["line 99 is empty, a comment or not in the file"]);
}

#[test]
fn titles_and_a_stated_separator_come_before_the_header() {
    let case = comparison("titles", "file: rig.csv, columns: { torque: T, speed: n_in, loss: P }");
    for head in [
        "sep=;\n",
        "Test of the reducer\n\n",
        "Test 7, warm\nmeasured by: rig 3\n",
        "\u{feff}\"sep=;\"\r\n",
        "T\n",
    ] {
        case.write("rig.csv", format!("{head}T [Nm];n_in [rpm];P [W]\n10,0;1000;104,72\n"));
        assert_differences(&case, &[0.0]);
    }
    // Two headers with as many of the names.
    case.write(
        "rig.csv",
        "results\nT [Nm];n_in [rpm];x\n1;2;3\nT [Nm];y;P [W]\n10;1000;104\n",
    );
    assert_refused(
        &case,
        &[
            "lines 2, 4 may be the header, each with 2 of the names",
            "`header_line: 2`",
        ],
    );
}

#[test]
fn a_workbook_with_a_title_and_dates_is_read() {
    let mut book = Workbook::new();
    let sheet = book.add_worksheet();
    let date = Format::new().set_num_format("yyyy-mm-dd hh:mm:ss.000");
    sheet.write(0, 0, "Recording of the rig").unwrap();
    for (column, name) in ["timestamp", "torque [Nm]", "speed [rpm]"].iter().enumerate() {
        sheet.write(2, column as u16, *name).unwrap();
    }
    for row in 0..3_u32 {
        let days = 46_353.497_326_388_9 + f64::from(row) / 864_000.0;
        sheet.write_with_format(3 + row, 0, days, &date).unwrap();
        sheet.write(3 + row, 1, 10.0 + f64::from(row)).unwrap();
        sheet.write(3 + row, 2, 1000.0).unwrap();
    }
    let case = cycle("workbook", "file: rig.xlsx, columns: { time: timestamp }");
    case.write("rig.xlsx", book.save_to_buffer().unwrap());
    assert_close(mean_loss(&case), tenth(11.0), 1e-3);
}

#[test]
fn utf16_is_read_by_its_mark_or_as_stated() {
    let text =
        "T_ein [Nm]\tn_ein [rpm]\tT_aus [Nm]\tT_\u{d6}l [degC]\r\n10,0\t1000\t18,0\t60\r\n12,0\t1000\t21,6\t60\r\n";
    let form = "file: rig.csv, columns: { torque: T_ein, speed: n_ein, torque_out: T_aus, oil_temperature: T_\u{d6}l }";
    let low = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    let high = |text: &str| text.encode_utf16().flat_map(u16::to_be_bytes).collect::<Vec<u8>>();
    let marked = format!("\u{feff}{text}");
    let case = comparison("utf16", form);
    for (bytes, encoding) in [
        (low(&marked), ""),
        (high(&marked), ""),
        (low(text), ""),
        (low(&marked), ", encoding: utf16"),
        (high(&marked), ", encoding: utf16"),
        (low(text), ", encoding: utf16_le"),
        (high(text), ", encoding: utf16_be"),
        (marked.clone().into_bytes(), ""),
    ] {
        case.write("rig.csv", bytes);
        write_comparison(&case, &format!("{form}{encoding}"));
        assert_differences(&case, &[0.0, 0.0]);
    }
    case.write("rig.csv", low(&marked));
    write_comparison(&case, &format!("{form}, encoding: utf8"));
    assert_refused(&case, &["is not UTF-8", "write `encoding: utf16`"]);
}

#[test]
fn dates_and_clock_times_are_a_time_axis() {
    let form = "file: drive.csv, columns: { time: stamp }";
    let case = cycle("dates", form);
    let text = |head: &str, times: [&str; 3], separator: &str| {
        let rows: Vec<String> = (10..)
            .zip(times)
            .map(|(torque, time)| [time, &torque.to_string(), "1000"].join(separator))
            .collect();
        format!("{head}{}\n", rows.join("\n"))
    };
    let comma = "stamp,torque [Nm],speed [rpm]\n";
    let units = "stamp,torque,speed\nhh:mm:ss,Nm,rpm\n";
    for drive in [
        text(
            comma,
            [
                "2026-11-27 11:56:09.100",
                "2026-11-27 11:56:09.200",
                "2026-11-27 11:56:09.300",
            ],
            ",",
        ),
        text(
            comma,
            [
                "2026-12-31T23:59:59.9Z",
                "2027-01-01T00:00:00Z",
                "2027-01-01T01:00:00.1+01:00",
            ],
            ",",
        ),
        text(units, ["10:00:00.0", "10:00:00.1", "10:00:00.2"], ","),
        text(units, ["23:59:59.9", "0:00:00.0", "0:00:00.1"], ","),
        text(
            &comma.replace(',', ";"),
            [
                "27.11.2026 11:56:09,1",
                "27.11.2026 11:56:09,2",
                "27.11.2026 11:56:09,3",
            ],
            ";",
        ),
    ] {
        case.write("drive.csv", drive);
        assert_close(mean_loss(&case), tenth(11.0), 1e-6);
    }
    let days = text(comma, ["3/4/2026 0:00", "4/4/2026 0:00", "5/4/2026 0:00"], ",");
    case.write("drive.csv", days);
    assert_refused(
        &case,
        &[
            "line 2, column 1 `stamp`: `3` and `4` may be day and month",
            "`date_order: day_first`",
        ],
    );
    write_cycle(&case, &format!("{form}, date_order: day_first"));
    assert_eq!(case.result("study.yaml", "c")["cycles"][0]["duration_s"], 172_800.0);
    write_cycle(&case, &format!("{form}, units: {{ time: min }}"));
    case.write(
        "drive.csv",
        text(units, ["10:00:00.0", "10:00:00.1", "10:00:00.2"], ","),
    );
    assert_refused(
        &case,
        &[
            "has dates or clock times, which have no unit",
            "delete `time` from `units`",
        ],
    );
    write_cycle(&case, form);
    case.write("drive.csv", text(units, ["10:00", "10:01", "10:02"], ","));
    assert_refused(&case, &["hours and minutes, or minutes and seconds", "hh:mm:ss"]);
}

#[test]
fn comments_after_cells_and_points_at_standstill_do_not_count() {
    let columns = "columns: { speed: Input Speed, torque: Input Torque, loss_torque: Torque Loss }";
    let case = comparison("comments", &format!("file: commented.csv, {columns}"));
    let torques = |measured: f64, torque: f64| (0.1 * torque - measured) * 1000.0 * std::f64::consts::PI / 30.0;
    assert_differences(&case, &[torques(7.0, 50.0), torques(10.0, 100.0)]);
    write_comparison(&case, &format!("file: loss_map.csv, {columns}"));
    let result = case.result("study.yaml", "c");
    let found = differences(&case);
    assert_eq!(found[..3], [None; 3]);
    // At -100 Nm the power enters at the other port, whose loss is a tenth of its power.
    assert_close(found[3].unwrap(), 221.08, 0.01);
    assert_close(found[4].unwrap(), -628.32, 0.01);
    assert_close(found[6].unwrap(), 0.0, 1e-9);
    let eight: Vec<f64> = found.iter().flatten().copied().collect();
    let rms = (eight.iter().map(|x| x * x).sum::<f64>() / eight.len() as f64).sqrt();
    assert_eq!(eight.len(), 8);
    assert_close(
        result["comparisons"][0]["difference"]["rms"].as_f64().unwrap(),
        rms,
        1e-6,
    );
    assert!(
        result
            .to_string()
            .contains("3 points at standstill, where measurement and model have no loss"),
        "{result:#}"
    );
    // A number sign in a name is no comment.
    case.write(
        "commented.csv",
        "Point #,Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm]\n1,1000,50,7\nA # 2,1000,100,10\n",
    );
    write_comparison(&case, &format!("file: commented.csv, {columns}"));
    assert_differences(&case, &[torques(7.0, 50.0), torques(10.0, 100.0)]);
}

#[test]
fn a_file_separated_by_blanks_is_read() {
    let case = comparison("blanks", "file: rig.dat, columns: { torque: T, speed: n_in, loss: P }");
    for text in [
        "T [Nm]  n_in [rpm]   P [W]\n10.0   1000  104.72\n12.0   1000  125.66\n",
        "# rig 3\n T n_in P\n Nm rpm W\n 10,0 1000 104,72 # warm\n\n 12,0\t1000 125,66\n",
    ] {
        case.write("rig.dat", text);
        assert_differences(&case, &[0.0, 0.0]);
    }
    // A header that is a comment is stated.
    case.write("rig.dat", "# rig 3\n# T [Nm] n_in [rpm] P [W]\n10.0 1000 104.72\n");
    write_comparison(
        &case,
        "file: rig.dat, header_line: 2, columns: { torque: T, speed: n_in, loss: P }",
    );
    assert_differences(&case, &[0.0]);
}

#[test]
fn thousands_are_stated_or_refused() {
    let form = "file: rig.csv, columns: { torque: T, speed: \"n\", loss: P }";
    let case = comparison("thousands", form);
    let head = "T [Nm],n [rpm],P [W]\n";
    let loss = |speed: f64| format!("{}", tenth(5.0) * speed / 1000.0);
    let unclear = "may have decimals or thousands, and no other number shows which";
    for rows in ["5,\"1,500\",78\n", "5,2000,100\n5,\"1,500\",78\n"] {
        case.write("rig.csv", format!("{head}{rows}"));
        assert_refused(
            &case,
            &[
                "`1,500`",
                unclear,
                "`decimal: comma`",
                "`decimal: point` and `thousands: comma`",
            ],
        );
    }
    // The help, followed to the letter.
    case.write("rig.csv", format!("{head}5,\"1,500\",{}\n", loss(1500.0)));
    write_comparison(&case, &format!("{form}, decimal: point, thousands: comma"));
    assert_differences(&case, &[0.0]);
    case.write(
        "rig.csv",
        format!("{head}5,\"1,500\",\"{}\"\n", loss(1.5).replace('.', ",")),
    );
    write_comparison(&case, &format!("{form}, decimal: comma"));
    assert_differences(&case, &[0.0]);
    write_comparison(&case, form);
    // Both signs in one number, apostrophes and spaces decide.
    for (rows, speed) in [
        ("5;1.500,5;LOSS\n", 1500.5),
        ("5;1'500;LOSS\n", 1500.0),
        ("5;1 500;LOSS\n", 1500.0),
        ("5;1\u{a0}500,5;LOSS\n", 1500.5),
    ] {
        let rows = rows.replace("LOSS", &loss(speed).replace('.', ","));
        case.write("rig.csv", format!("{}{rows}", head.replace(',', ";")));
        assert_differences(&case, &[0.0]);
    }
    // Points between thousands, as in Germany.
    case.write("rig.csv", "T [Nm];n [rpm];P [W]\n5;900;47\n5;1.500;79\n");
    assert_refused(&case, &["`1.500`", unclear, "`decimal: comma` and `thousands: point`"]);
    // Three decimals are shown by numbers of four digits before them.
    case.write(
        "rig.csv",
        format!("T [Nm];n [rpm];P [W]\n5,000;1200,000;{:.3}\n", tenth(5.0) * 1.2).replace('.', ","),
    );
    assert_differences(&case, &[0.0]);
    // The same in points of an analysis of its own.
    case.write("points.csv", "name,torque [Nm],speed [rpm]\na,8,\"1,500\"\nb,8,2000\n");
    case.write(
        "study.yaml",
        "gearloss: study/1\ngearboxes: { g: gearbox.yaml }\nanalyses: { c: { type: operating_points, data: { file: points.csv } } }\n",
    );
    assert_refused(&case, &["`1,500`", unclear]);
}

#[test]
fn marks_of_missing_values_are_stated_or_refused() {
    let form = "file: rig.csv, columns: { torque: T, speed: \"n\", loss: P }";
    let case = comparison("missing", form);
    case.write(
        "rig.csv",
        format!("T [Nm],n [rpm],P [W]\n10,1000,{}\n10,1000,-9999\n", tenth(10.0)),
    );
    assert_refused(
        &case,
        &[
            "line 3, column 3 `P`: -9999 is a usual mark of a missing value",
            "`missing: [-9999]`",
            "`missing: []`",
        ],
    );
    write_comparison(&case, &format!("{form}, missing: []"));
    assert_differences(&case, &[0.0, tenth(10.0) + 9999.0]);
    write_comparison(&case, &format!("{form}, missing: [-9999]"));
    assert_refused(&case, &["line 3, column 3 `P`: empty", "`faulty_rows: skip`"]);
    write_comparison(&case, &format!("{form}, missing: [-9999], faulty_rows: skip"));
    assert_differences(&case, &[0.0]);
    case.write(
        "rig.csv",
        format!(
            "T [Nm],n [rpm],P [W]\n10,1000,{}\n10,1000,n/a\n10,1000,NaN\n",
            tenth(10.0)
        ),
    );
    write_comparison(&case, form);
    assert_refused(
        &case,
        &[
            "`n/a` is not a number",
            "`NaN` is not a number",
            "`missing: [-9999, \"n/a\"]`",
        ],
    );
    write_comparison(&case, &format!("{form}, missing: [\"n/a\", nan], faulty_rows: skip"));
    assert_differences(&case, &[0.0]);
    // A series goes on without the row.
    case.write(
        "drive.csv",
        "time [s],torque [Nm],speed [rpm]\n0,10,1000\n1,-999,1000\n2,10,1000\n3,10,1000\n",
    );
    write_cycle(&case, "file: drive.csv");
    assert_refused(
        &case,
        &["line 3, column 2 `torque`: -999 is a usual mark of a missing value"],
    );
    write_cycle(&case, "file: drive.csv, missing: [-999]");
    assert_close(mean_loss(&case), tenth(10.0), 1e-9);
    // A grid that goes on to such a number has values.
    case.write("rig.csv", "T [Nm],n [rpm],loss [W]\n-800,1000,900\n-999,1000,1000\n");
    write_comparison(&case, "file: rig.csv, columns: { torque: T, speed: \"n\" }");
    assert_eq!(differences(&case).len(), 2);
}

#[test]
fn files_of_other_kinds_are_named() {
    let case = comparison(
        "foreign",
        "file: rig.csv, columns: { torque: T, speed: \"n\", loss: P }",
    );
    for (bytes, told) in [
        (
            b"MATLAB 5.0 MAT-file, Platform: GLNXA64\0\0\0\0".as_slice(),
            "a MAT-file of MATLAB",
        ),
        (b"MATLAB 7.3 MAT-file, Platform: GLNXA64", "HDF5"),
        (b"\x89HDF\r\n\x1a\n\0\0\0\0", "an HDF5 file"),
        (b"TDSm\x0e\0\0\0", "a TDMS file of LabVIEW"),
        (b"{ \"T\": [1, 2] }", "a JSON file"),
        (b"[{\"T\": 1}]", "a JSON file"),
        (
            b"PK\x05\x06\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
            "an empty zip archive",
        ),
        (b"\x1f\x8b\x08\0", "packed by gzip"),
        (b"PAR1\x15\x04", "a Parquet file"),
        (b"%PDF-1.7", "a PDF document"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "(.xls)"),
        (b"ab\0\0cd\n", "no text"),
    ] {
        case.write("rig.csv", bytes);
        assert_refused(&case, &[told, "help:"]);
    }
}

#[test]
fn a_cycle_with_a_long_first_step_asks_for_units_and_for_the_gap() {
    let vehicle = "vehicles:\n  car: { mass: 1500 kg, coast_down: { a: 100 N, b: 0 N s/m, c: 0.4 N s2/m2 }, tyre_radius: 300 mm, regeneration: none, rotating_mass_factor: 1 }\n";
    let study = |keys: &str| {
        format!(
            "gearloss: study/1\ngearboxes: {{ g: gearbox.yaml }}\ncycles:\n  d: {{ file: cruise.csv, columns: {{ time: seconds, vehicle_speed: v, grade: grade }}{keys} }}\n{vehicle}analyses:\n  c: {{ type: cycle, cycles: [d] }}\n"
        )
    };
    let case = Case::new(FOLDER, "gap");
    case.write("study.yaml", study(""));
    assert_refused(
        &case,
        &[
            "column `seconds` has no unit",
            "column `v` has no unit",
            "column `grade` has no unit",
        ],
    );
    let units = ", units: { time: s, vehicle_speed: m/s, grade: \"-\" }";
    case.write("study.yaml", study(units));
    assert_refused(&case, &["line 3: a gap of 69.5 s, from 0 s to 69.5 s", "`gap: 69.5 s`"]);
    case.write("study.yaml", study(&format!("{units}, gap: 70 s")));
    let said = case.gearloss(&["run", "study.yaml", "-o", "results"]);
    assert_eq!(said.code, Some(0), "{}", said.text);
    let series = std::fs::read_to_string(case.path("results/c.csv")).unwrap();
    let mut rows = series.lines().filter(|line| !line.starts_with('#'));
    let place = |name: &str| {
        rows.clone()
            .next()
            .unwrap()
            .split(',')
            .position(|column| column == name)
    };
    let column = place("output_torque_nm")
        .or(place("torque_nm"))
        .unwrap_or_else(|| panic!("{series}"));
    rows.next();
    let torque: Vec<f64> = rows
        .take(2)
        .map(|row| row.split(',').nth(column).unwrap().parse().unwrap())
        .collect();
    // Output torque of the wheels over the ratio 2 and the efficiency 0.9, at the input.
    let input = |force: f64| force * 0.3 / 1.8;
    assert_close(torque[0].abs(), input(1500.0 / 69.5 + 100.0 + 0.4 * 0.25), 1e-3);
    assert_close(
        torque[1].abs(),
        input(1500.0 * 0.5 + 100.0 + 0.4 * 1.25 * 1.25 + 1500.0 * 9.80665 * 0.005),
        1e-1,
    );
}

/// Groups of several rasters, a table of values as conversion, and a spelling of a unit with spaces, as tools of calibration write.
#[test]
fn a_recording_of_a_calibration_tool_has_the_numbers_of_its_conversions() {
    let mut file = MdfBuilder::new();
    let table = file.conversion(4, &[0.0, 0.0, 100.0, 2000.0, 200.0, 3000.0], &[]);
    let samples: Vec<(u8, i32)> = (0..10).map(|i| (50 + i, 800 - 10 * i32::from(i))).collect();
    let channels = file.channels(&[
        ChannelFields {
            kind: 2,
            ..ChannelFields::float("time", "s", 0)
        },
        ChannelFields {
            data_type: 0,
            bits: 8,
            conversion: table,
            ..ChannelFields::float("n", "U/  min", 8)
        },
        ChannelFields {
            data_type: 2,
            bits: 32,
            ..ChannelFields::float("T", "", 9)
        },
    ]);
    let data: Vec<u8> = (0..10_u8)
        .zip(&samples)
        .flat_map(|(i, (speed, torque))| {
            let time = (0.1 * f64::from(i)).to_le_bytes();
            time.into_iter()
                .chain([*speed])
                .chain(torque.to_le_bytes())
                .collect::<Vec<u8>>()
        })
        .collect();
    let data = file.block(*b"DT", &[], &data);
    let group = file.group(0, channels, "", (0, 10, 13, 0));
    let second = file.data_group(0, group, data, 0);
    let slow = file.channels(&[ChannelFields {
        kind: 2,
        ..ChannelFields::float("time", "s", 0)
    }]);
    let slow_data = file.block(*b"DT", &[], &[0; 16]);
    let slow = file.group(0, slow, "", (0, 2, 8, 0));
    let first = file.data_group(second, slow, slow_data, 0);
    let form = |keys: &str| format!("file: tool.mf4, columns: {{ speed: \"n\", torque: T }}{keys}");
    let case = cycle("tool", &form(""));
    case.write("tool.mf4", file.finish(first));
    assert_refused(
        &case,
        &[
            "several channel groups",
            "1 (2 samples of time)",
            "2 (10 samples of time, n, T)",
        ],
    );
    write_cycle(&case, &form(", group: \"2\""));
    assert_refused(&case, &["column `T` has no unit"]);
    write_cycle(&case, &form(", group: \"2\", units: { torque: Nm, speed: rpm }"));
    let mean: f64 = (0..9)
        .map(|i| {
            let (speed, torque) = (20.0 * (50.5 + f64::from(i)), 795.0 - 10.0 * f64::from(i));
            0.1 * torque * speed * std::f64::consts::PI / 30.0
        })
        .sum::<f64>()
        / 9.0;
    assert_close(mean_loss(&case), mean, 1e-6);
}

#[test]
fn versions_of_mdf_files_are_read_or_refused_with_a_reason() {
    let columns = [("time", "s"), ("Torque_In", "N.m"), ("Speed_In", "1/min")];
    let rows: Vec<Vec<f64>> = (0..200)
        .map(|i| 0.1 * f64::from(i))
        .map(|t| vec![t, 10.0 + 0.5 * t, 1000.0 + 10.0 * t])
        .collect();
    let case = cycle(
        "versions",
        "file: rig.mf4, columns: { speed: Speed_In, torque: Torque_In }",
    );
    let whole = simple(&columns, &rows);
    // Means of torque and speed between rows.
    let power = |pair: &[Vec<f64>]| {
        let mean = |column: usize| f64::midpoint(pair[0][column], pair[1][column]);
        0.1 * mean(1) * mean(2) * std::f64::consts::PI / 30.0
    };
    let mean = rows.windows(2).map(power).sum::<f64>() / 199.0;
    assert_close(mean, 174.2, 0.1);
    for version in ["4.00", "4.10", "4.11", "4.20"] {
        let mut bytes = whole.clone();
        bytes[8..12].copy_from_slice(version.as_bytes());
        case.write("rig.mf4", bytes);
        assert_close(mean_loss(&case), mean, 1e-6);
    }
    let mut old = whole;
    old[8..12].copy_from_slice(b"3.30");
    case.write("rig.mf4", old);
    assert_refused(&case, &["an MDF file of version `3.30`", "save it as MDF 4"]);
}

#[test]
fn a_map_of_texts_without_end_and_a_line_of_commas_are_refused_quickly() {
    let case = cycle("limits", "file: rig.mf4, columns: { speed: \"n\", torque: T }");
    // Each channel refers to one text without an end.
    let mut file = MdfBuilder::new();
    let name = file.block(*b"TX", &[], &vec![b'a'; 8 << 20]);
    let mut next = 0;
    for _ in 0..8000 {
        let mut data = vec![0, 0, 4, 0];
        data.extend([0, 64, 0, 0].map(u32::to_le_bytes).concat());
        data.resize(72, 0);
        next = file.block(*b"CN", &[next, 0, name, 0, 0, 0, name, 0], &data);
    }
    let group = file.group(0, next, "", (0, 1, 8, 0));
    let samples = file.block(*b"DT", &[], &[0; 8]);
    let first = file.data_group(0, group, samples, 0);
    case.write("rig.mf4", file.finish(first));
    let start = std::time::Instant::now();
    refused(&case);
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
    write_cycle(&case, "file: rig.csv, columns: { speed: \"n\", torque: T }");
    case.write("rig.csv", format!("time,n,T{}\n", ",".repeat(50_000_000)));
    assert_refused(&case, &["line 1: more than 16384 cells"]);
}
