//! The tables of an analysis as a workbook, for readers with a spreadsheet. Not in WebAssembly.

use rust_xlsxwriter::{
    Chart, ChartType, DocProperties, ExcelDateTime, Format, FormatAlign, Workbook, Worksheet, XlsxError,
};

use gearloss_framework::document::visible;
use gearloss_studies::table::{Column, Table, Values};

use crate::html::Section;

/// Maximum number of rows of a table: those of a sheet without its head.
pub const MOST_ROWS: usize = 1_048_576 - HEAD as usize;
/// A name that no sheet may have.
const RESERVED: &str = "history";
/// Rows above the numbers: names, units, meanings.
const HEAD: u32 = 3;
/// Maximum number of lines of the chart, and of the rows that they show.
const CHART: (usize, u32) = (4, 500);

/// Why there is no workbook.
#[derive(Debug, thiserror::Error)]
pub enum WorkbookError {
    /// A table has more rows than a sheet holds.
    #[error("the table `{name}` has more than {MOST_ROWS} rows, which a sheet of a workbook cannot hold")]
    TooLong {
        /// Name of the table.
        name: String,
    },
    /// The library cannot write it.
    #[error("the workbook cannot be written: {0}")]
    Written(#[from] XlsxError),
}

/// A workbook: the result with its key figures and notes, then a sheet for each table with names, units and meanings of its columns,
/// and a chart of the first table. Hidden characters of documents are shown as escapes.
///
/// # Errors
/// If a table is too long, or the library cannot write it.
pub fn workbook(section: &Section, tables: &[Table]) -> Result<Vec<u8>, WorkbookError> {
    let mut workbook = Workbook::new();
    // The time of writing would make equal results differ.
    let written = ExcelDateTime::from_ymd(2000, 1, 1)?;
    workbook.set_properties(&DocProperties::new().set_creation_datetime(&written));
    about(workbook.add_worksheet().set_name("result")?, section)?;
    let mut names = vec!["result".to_owned(), RESERVED.to_owned()];
    for (i, table) in tables.iter().enumerate() {
        if table.len() > MOST_ROWS {
            return Err(WorkbookError::TooLong {
                name: table.name.clone(),
            });
        }
        let name = sheet_name(&table.name, &names);
        names.push(name.to_lowercase());
        let sheet = workbook.add_worksheet().set_name(&name)?;
        write_table(sheet, table)?;
        if i == 0
            && let Some(chart) = chart(table, &name)
        {
            sheet.insert_chart(HEAD, table.columns.len() as u16 + 1, &chart)?;
        }
    }
    Ok(workbook.save_to_buffer()?)
}

/// Headline, key figures and notes.
fn about(sheet: &mut Worksheet, section: &Section) -> Result<(), XlsxError> {
    let bold = Format::new().set_bold();
    sheet.set_column_width(0, 40)?;
    sheet.set_column_width(1, 16)?;
    sheet.write_with_format(0, 0, visible(&section.title).as_ref(), &bold)?;
    sheet.write(1, 0, visible(&section.result()).as_ref())?;
    let mut row = 3;
    for figure in &section.key_figures {
        sheet.write(row, 0, visible(&figure.label).as_ref())?;
        // Digits are in groups.
        match figure.value.replace('\u{202f}', "").parse::<f64>() {
            Ok(number) => sheet.write(row, 1, number)?,
            Err(_) => sheet.write(row, 1, visible(&figure.value).as_ref())?,
        };
        sheet.write(row, 2, visible(&figure.unit).as_ref())?;
        sheet.write(row, 3, visible(&figure.detail).as_ref())?;
        row += 1;
    }
    let lists = [
        ("Limits that are not kept", &section.limits[..]),
        ("Careful", &section.careful[..]),
        ("Outside a stated range", &section.outside[..]),
    ];
    for (title, lines) in lists.into_iter().filter(|(_, lines)| !lines.is_empty()) {
        row += 1;
        sheet.write_with_format(row, 0, title, &bold)?;
        for line in lines {
            row += 1;
            sheet.write(row, 0, visible(line).as_ref())?;
        }
    }
    Ok(())
}

/// Names, units and meanings of the columns, then the rows. Missing values stay empty.
fn write_table(sheet: &mut Worksheet, table: &Table) -> Result<(), XlsxError> {
    let bold = Format::new().set_bold();
    let small = Format::new().set_italic().set_text_wrap().set_align(FormatAlign::Top);
    sheet.set_freeze_panes(HEAD, 0)?;
    for (i, column) in table.columns.iter().enumerate() {
        let at = i as u16;
        sheet.write_with_format(0, at, visible(&column.name).as_ref(), &bold)?;
        sheet.write(1, at, column.unit.as_ref())?;
        sheet.write_with_format(2, at, visible(&column.meaning).as_ref(), &small)?;
        sheet.set_column_width(at, column.name.len().max(10) as f64)?;
        match &column.values {
            Values::Numbers(numbers) => {
                for (row, number) in numbers.iter().enumerate().filter(|(_, number)| number.is_finite()) {
                    sheet.write(HEAD + row as u32, at, *number)?;
                }
            }
            Values::Texts(texts) => {
                for row in 0..table.len() {
                    // Written as text, so that no spreadsheet takes it for a formula.
                    sheet.write_string(
                        HEAD + row as u32,
                        at,
                        visible(texts.get(row).unwrap_or_default()).as_ref(),
                    )?;
                }
            }
        }
    }
    if !table.columns.is_empty() && !table.is_empty() {
        sheet.autofilter(2, 0, HEAD + table.len() as u32 - 1, table.columns.len() as u16 - 1)?;
    }
    Ok(())
}

/// The losses of the first table, or its other numbers, over its rows.
fn chart(table: &Table, sheet: &str) -> Option<Chart> {
    let numbers = |column: &&(usize, &Column)| column.1.numbers().is_some_and(|all| all.iter().any(|x| x.is_finite()));
    let all: Vec<(usize, &Column)> = table.columns.iter().enumerate().collect();
    let of = |unit: &str| {
        all.iter()
            .filter(numbers)
            .filter(|(_, column)| column.unit == unit)
            .copied()
            .collect()
    };
    let lists: [Vec<(usize, &Column)>; 3] = ["W", "-", "degC"].map(of);
    let shown = lists.into_iter().find(|list| !list.is_empty())?;
    if table.len() < 2 {
        return None;
    }
    let last = HEAD + (table.len() as u32).min(CHART.1) - 1;
    let mut chart = Chart::new(ChartType::Line);
    for (i, column) in shown.iter().take(CHART.0) {
        let at = *i as u16;
        let series = chart.add_series();
        series
            .set_values((sheet, HEAD, at, last, at))
            .set_name(column.name.as_str());
    }
    chart.title().set_name(&format!("{} by row", table.name));
    chart.x_axis().set_name("row of the table");
    chart.y_axis().set_name(&shown[0].1.unit.to_string());
    Some(chart)
}

/// A name of a sheet: at most 31 characters, none of those that are forbidden, different from the others without regard to case.
fn sheet_name(table: &str, used: &[String]) -> String {
    let clean: String = table
        .chars()
        .map(|c| if "[]:*?/\\'".contains(c) { '-' } else { c })
        .collect();
    let cut: String = clean.chars().take(27).collect();
    let whole = (clean.chars().count() <= 31).then_some(clean);
    let others = (2..).map(|number| format!("{cut}~{number}"));
    let mut names = whole.into_iter().chain(others);
    names
        .find(|name| !used.contains(&name.to_lowercase()))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn table(rows: usize) -> Table {
        Table::of("maps: all", 0..rows)
            .text("set", "Set", |_| "=1+1")
            .number("loss_w", "W", "Loss", |row| (*row != 1).then_some(*row as f64))
            .finish()
    }

    #[test]
    fn equal_results_are_equal_bytes_and_long_tables_are_refused() {
        let section = Section {
            outside: vec!["a note".to_owned()],
            ..Section::default()
        };
        let write = || workbook(&section, &[table(3)]).unwrap();
        let bytes = write();
        assert_eq!(bytes, write());
        // A workbook is a zip archive.
        assert!(bytes.starts_with(b"PK"));
        assert!(matches!(
            workbook(&section, &[table(MOST_ROWS + 1)]),
            Err(WorkbookError::TooLong { .. })
        ));
    }

    #[test]
    fn names_of_sheets_are_short_and_clean() {
        assert_eq!(sheet_name("a/b", &[]), "a-b");
        assert_eq!(sheet_name("Result", &["result".to_owned()]), "Result~2");
        let long = sheet_name(&"x".repeat(40), &[]);
        assert!(long.chars().count() <= 31 && long.ends_with("~2"), "{long}");
    }
}
