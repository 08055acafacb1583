#![allow(clippy::unwrap_used)]

use std::io::Write as _;

use super::*;
use crate::data::cells::table;
use crate::data::{Decimal, TableForm};

/// An archive of files.
fn archive(files: &[(&str, &str)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, content) in files {
        let method = rawzip::CompressionMethod::DEFLATE;
        let (mut entry, _) = writer.new_file(name).compression_method(method).start().unwrap();
        entry
            .write_all(&miniz_oxide::deflate::compress_to_vec(content.as_bytes(), 6))
            .unwrap();
        let descriptor = rawzip::DataDescriptorOutput::new(rawzip::crc32(content.as_bytes()), content.len() as u64);
        entry.finish(descriptor).unwrap();
    }
    writer.finish().unwrap();
    bytes
}

const RELATIONS: &str = r#"<Relationships><Relationship Id="a" Type="x/worksheet" Target="worksheets/one.xml"/>
    <Relationship Id="b" Type="x/worksheet" Target="/xl/two.xml"/><Relationship Id="c" Type="x/chartsheet" Target="chart.xml"/>
    <Relationship Id="d" Type="x/sharedStrings" Target="texts.xml"/><Relationship Id="e" Type="x/styles" Target="styles.xml"/></Relationships>"#;
const BOOK: &str = r#"<x:workbook xmlns:x="s" xmlns:r="o"><x:sheets><x:sheet name="Plot" r:id="c"/><x:sheet name="Old" state="hidden" r:id="b"/>
    <x:sheet name="Rig &amp; data" r:id="a"/></x:sheets></x:workbook>"#;
const TEXTS: &str = r"<sst><si><t>torque [Nm]</t></si><si><r><t>spe</t></r><r><t>ed [r&#112;m]</t></r><rPh><t>no</t></rPh></si><si><t>oil</t></si></sst>";
const STYLES: &str = r#"<styleSheet><numFmts><numFmt numFmtId="164" formatCode="hh:mm:ss"/></numFmts><cellStyleXfs><xf numFmtId="14"/></cellStyleXfs>
    <cellXfs><xf numFmtId="0"/><xf numFmtId="164"/><xf numFmtId="14"/></cellXfs></styleSheet>"#;

fn book(sheet: &str) -> Vec<u8> {
    let sheet = format!("<worksheet><sheetData>{sheet}</sheetData></worksheet>");
    archive(&[
        ("xl/workbook.xml", BOOK),
        ("xl/_rels/workbook.xml.rels", RELATIONS),
        ("xl/sharedstrings.xml", ""),
        ("xl/texts.xml", TEXTS),
        ("xl/styles.xml", STYLES),
        ("xl/worksheets/one.xml", &sheet),
        (
            "xl/two.xml",
            "<worksheet><sheetData><row><c><v>1</v></c></row></sheetData></worksheet>",
        ),
    ])
}

const HEADER: &str = r#"<row r="3"><c r="B3" t="s"><v>0</v></c><c r="C3" t="s"><v>1</v></c></row>"#;

fn read(sheet: &str) -> Result<SheetCells, MeasuredFault> {
    super::sheet(&book(sheet), None, None, &mut Vec::new())
}

#[test]
fn cells_of_all_kinds_are_read_with_the_rows_of_the_sheet() {
    let mut notes = Vec::new();
    let bytes = book(&format!(
        r#"<row r="1"/><row r="2"><c r="A2" t="inlineStr"><is><t># a comment</t></is></c></row>{HEADER}
        <row r="5"><c r="B5"><f>1+1</f><v>0.30000000000000004</v></c><c r="C5"><v>1E3</v></c><c r="D5" s="1"/></row>
        <row r="7"><c r="B7" t="e"><v>#N/A</v></c><c t="str"><f>A1</f><v>1,5</v></c></row>
        <row><c r="B8" t="b"><v>1</v></c><c r="C8" s="1"><v>0.5</v></c></row><row><c r="B9" t="d"><v>2024-01-31</v></c></row>"#
    ));
    let found = table(&bytes, &TableForm::default(), &|_| true, &mut notes).unwrap();
    assert_eq!(found.part.as_deref(), Some("sheet `Rig & data`"));
    assert!(
        notes[0].contains("sheet `Rig & data` is read; `sheet` chooses another: `Old`"),
        "{notes:?}"
    );
    assert_eq!(found.names, ["", "torque", "speed"]);
    assert_eq!(found.units[1..], [Some("Nm".to_owned()), Some("rpm".to_owned())]);
    let rows: Vec<(u64, Vec<&str>)> = found
        .rows
        .iter()
        .map(|(row, cells)| (*row, cells.iter().map(String::as_str).collect()))
        .collect();
    assert_eq!(rows[0], (5, vec!["", "0.30000000000000004", "1000"]));
    assert_eq!(rows[1], (7, vec!["", "error #N/A", "1,5"]));
    assert_eq!(rows[2], (8, vec!["", "TRUE", "date or time 0.5"]));
    assert_eq!(rows[3], (9, vec!["", "date or time 2024-01-31"]));
    let date = crate::data::cells::number(&found, (8, &found.rows[2].1), 2).unwrap_err();
    assert_eq!(
        date,
        "line 8, column 3 `speed`: a date or time, stored as `0.5`: give the cell the format of a number"
    );
    // Numbers that are stored as texts in the language of the writer.
    let comma = TableForm {
        decimal: Some(Decimal::Comma),
        ..TableForm::default()
    };
    assert_eq!(
        table(&bytes, &comma, &|_| true, &mut notes).unwrap().rows[1].1[2],
        "1.5"
    );
}

#[test]
fn a_sheet_is_chosen_by_its_name() {
    let mut notes = Vec::new();
    let found = super::sheet(&book(HEADER), Some("Old"), None, &mut notes).unwrap();
    assert_eq!((found.rows.len(), notes.len()), (1, 0));
    let wrong = super::sheet(&book(HEADER), Some("old"), None, &mut notes).unwrap_err();
    assert_eq!(wrong.message, "there is no sheet `old`; there are: `Old`, `Rig & data`");
    assert_eq!(wrong.help, "write `sheet: Old`");
    let form = TableForm {
        separator: Some(super::super::Separator::Tab),
        ..TableForm::default()
    };
    assert_eq!(
        table(&book(HEADER), &form, &|_| true, &mut notes)
            .err()
            .unwrap()
            .message,
        "a workbook has no `separator`"
    );
    let form = TableForm {
        sheet: Some("Old".to_owned()),
        ..TableForm::default()
    };
    assert_eq!(
        table(b"a,b\n1,2\n", &form, &|_| true, &mut notes)
            .err()
            .unwrap()
            .message,
        "a text file (CSV) has no `sheet`"
    );
}

#[test]
fn other_files_of_spreadsheets_are_named() {
    let refused = |bytes: &[u8]| super::sheet(bytes, None, None, &mut Vec::new()).unwrap_err().message;
    assert!(refused(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1 and so on").contains("(.xls)"));
    assert!(refused(&archive(&[("xl/workbook.bin", "")])).contains("(.xlsb)"));
    assert!(refused(&archive(&[("mimetype", ""), ("content.xml", "")])).contains("(.ods)"));
    assert!(refused(&archive(&[("a.csv", "")])).contains("a zip archive without a workbook"));
    let whole = book(HEADER);
    assert!(refused(&whole[..whole.len() / 2]).contains("cannot be unpacked"));
    assert!(read("<row></c>").unwrap_err().message.contains("damaged"));
    assert!(
        read("<row r=\"0\"/>")
            .unwrap_err()
            .message
            .contains("no place of a sheet")
    );
    assert!(
        read("<row><c r=\"XFE1\"/></row>")
            .unwrap_err()
            .message
            .contains("no place of a sheet")
    );
    assert!(
        read("<row><c r=\"ÄÖ1\"/></row>")
            .unwrap_err()
            .message
            .contains("no place of a sheet")
    );
}

/// What a small file says must not become much memory.
#[test]
fn small_files_do_not_become_large() {
    let wide = r#"<row><c r="XFD1"><v>1</v></c></row>"#.repeat(700);
    assert!(read(&wide).unwrap_err().message.contains("more than 10000000 cells"));
    let bomb = format!("{HEADER}{}", " ".repeat(300 << 20));
    assert!(
        read(&bomb)
            .unwrap_err()
            .message
            .contains("at most 256 MB and 200 times its size")
    );
    let long = format!("<sst><si><t>{}</t></si></sst>", "ab".repeat(30_000));
    let cells = "<c t=\"s\"><v>0</v></c>".repeat(5000);
    let bytes = archive(&[
        ("xl/workbook.xml", BOOK),
        ("xl/_rels/workbook.xml.rels", RELATIONS),
        ("xl/texts.xml", &long),
        (
            "xl/worksheets/one.xml",
            &format!("<worksheet><row>{cells}</row></worksheet>"),
        ),
    ]);
    let wrong = super::sheet(&bytes, None, None, &mut Vec::new()).unwrap_err();
    assert!(
        wrong.message.contains("the texts of the sheet have more than 256 MB"),
        "{}",
        wrong.message
    );
    let types = "<!DOCTYPE a [<!ENTITY b \"c\">]>";
    assert!(read(types).unwrap_err().message.contains("document type"));
}

#[test]
fn changed_files_never_panic() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let whole = book(HEADER);
    let sheet =
        format!("{HEADER}<row r=\"5\"><c r=\"B5\"><f>1+1</f><v>0.3</v></c><c r=\"C5\" s=\"2\"><v>1E3</v></c></row>");
    for round in 0..4000 {
        if round % 2 == 0 {
            let mut bytes = whole.clone();
            let at = next() as usize % bytes.len();
            bytes[at] = next() as u8;
            let _ = table(&bytes, &TableForm::default(), &|_| true, &mut Vec::new());
        } else {
            let mut text: Vec<char> = sheet.chars().collect();
            let (at, from) = (next() as usize % text.len(), next() as usize % text.len());
            text[at] = text[from];
            let _ = table(
                &book(&text.iter().collect::<String>()),
                &TableForm::default(),
                &|_| true,
                &mut Vec::new(),
            );
        }
    }
}
