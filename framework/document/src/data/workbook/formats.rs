//! Which formats of cells are those of dates and times.

use std::collections::BTreeMap;

use quick_xml::events::Event;

use super::{attribute, walk};
use crate::data::MeasuredFault;

/// Most formats of a workbook; spreadsheets allow 65 490.
const MOST: usize = 100_000;

/// For each format of cells, whether it shows a date or a time.
pub(super) fn dates(styles: &str) -> Result<Vec<bool>, MeasuredFault> {
    let mut custom: BTreeMap<u32, bool> = BTreeMap::new();
    let mut dates = Vec::new();
    let mut of_cells = false;
    walk(styles, |event| {
        match &event {
            Event::Start(element) => match element.local_name().into_inner() {
                "cellXfs" => of_cells = true,
                "numFmt" => {
                    let id = attribute(element, "numFmtId").and_then(|id| id.parse().ok());
                    let code = attribute(element, "formatCode");
                    custom.extend(id.zip(code.map(|code| shows_date(&code))));
                }
                "xf" if of_cells && dates.len() < MOST => {
                    let id = attribute(element, "numFmtId").and_then(|id| id.parse::<u32>().ok());
                    let id = id.unwrap_or(0);
                    dates.push(custom.get(&id).copied().unwrap_or_else(|| is_built_in(id)));
                }
                _ => {}
            },
            Event::End(element) if element.local_name().into_inner() == "cellXfs" => of_cells = false,
            _ => {}
        }
        Ok(())
    })?;
    Ok(dates)
}

/// Numbers of the formats of dates and times that are not written into the file.
fn is_built_in(id: u32) -> bool {
    matches!(id, 14..=22 | 27..=36 | 45..=47 | 50..=58)
}

/// True if a format code has a year, month, day, hour, minute or second outside quotes, escapes and brackets.
fn shows_date(code: &str) -> bool {
    let mut letters = code.chars();
    while let Some(letter) = letters.next() {
        match letter {
            // Only the format of positive numbers.
            ';' => return false,
            '"' => {
                letters.by_ref().find(|c| *c == '"');
            }
            '\\' | '_' | '*' => {
                letters.next();
            }
            '[' => {
                let inner: String = letters.by_ref().take_while(|c| *c != ']').collect();
                // Elapsed hours, minutes or seconds; other brackets are colours, conditions and languages.
                if !inner.is_empty() && inner.chars().all(|c| matches!(c.to_ascii_lowercase(), 'h' | 'm' | 's')) {
                    return true;
                }
            }
            _ if matches!(letter.to_ascii_lowercase(), 'y' | 'm' | 'd' | 'h' | 's') => return true,
            _ => {}
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_of_dates_are_recognised() {
        for code in [
            "yyyy\\-mm\\-dd",
            "[h]:mm:ss",
            "hh:mm",
            "[$-409]d/m/yy h:mm AM/PM;@",
            "mm:ss.0",
        ] {
            assert!(shows_date(code), "{code}");
        }
        for code in [
            "General",
            "0.00E+00",
            "#,##0.00\" days\"",
            "[Red]0.0",
            "0 \\m",
            "0.00_);[Red]\\(0.00\\)",
            "0;\\d",
        ] {
            assert!(!shows_date(code), "{code}");
        }
    }
}
