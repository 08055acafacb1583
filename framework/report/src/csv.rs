//! Tables as comma-separated values.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io;
use std::ops::Range;

use gearloss_framework::document::visible;
use gearloss_studies::table::{Table, Values};
use rayon::prelude::*;

/// A table that is written in batches of rows.
pub struct CsvTable<W: io::Write> {
    to: W,
}

/// Number of rows that one thread formats at a time.
const ROWS: usize = 1024;

impl<W: io::Write> CsvTable<W> {
    /// Writes the header line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn new(mut to: W, header: &Table) -> io::Result<Self> {
        let mut line = csv::Writer::from_writer(Vec::new());
        line.write_record(header.columns.iter().map(|column| inert(&column.name).into_owned()))?;
        to.write_all(&line.into_inner().map_err(csv::IntoInnerError::into_error)?)?;
        Ok(Self { to })
    }

    /// Adds rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn rows(&mut self, rows: &Table) -> io::Result<()> {
        let starts: Vec<usize> = (0..rows.len()).step_by(ROWS).collect();
        let lines = |start: &usize| lines(rows, *start..(start + ROWS).min(rows.len()));
        let all: Vec<io::Result<Vec<u8>>> = starts.par_iter().map(lines).collect();
        all.into_iter().try_for_each(|lines| self.to.write_all(&lines?))
    }

    /// Completes the table.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn finish(mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// Rows as lines: all digits of a number, an empty cell for a missing value.
fn lines(table: &Table, rows: Range<usize>) -> io::Result<Vec<u8>> {
    let mut lines = csv::Writer::from_writer(Vec::new());
    let mut digits = String::new();
    for row in rows {
        for column in &table.columns {
            match &column.values {
                Values::Numbers(numbers) => {
                    digits.clear();
                    if !numbers[row].is_nan() {
                        add_digits(numbers[row], &mut digits);
                    }
                    lines.write_field(&digits)?;
                }
                Values::Texts(texts) => lines.write_field(inert(texts.get(row).unwrap_or_default()).as_ref())?,
            }
        }
        lines.write_record(None::<&[u8]>)?;
    }
    lines.into_inner().map_err(csv::IntoInnerError::into_error)
}

/// Adds a number to a text: the fewest digits that are read as the same number, without an exponent. They are those of JSON; where two
/// numbers of so many digits are equally near, `Display` may have the other one.
fn add_digits(number: f64, text: &mut String) {
    let mut buffer = zmij::Buffer::new();
    // Small and large numbers have an exponent, integers `.0`.
    let digits = buffer.format(number);
    if digits.contains('e') {
        let _ = write!(text, "{number}");
    } else {
        text.push_str(digits.strip_suffix(".0").unwrap_or(digits));
    }
}

/// A text that no spreadsheet evaluates as a formula: texts that would begin a formula get an apostrophe in front, which marks a text in
/// spreadsheets. Numbers keep their sign; a sign alone, such as the unit `-`, is not a formula. Hidden characters are shown as escapes.
fn inert(text: &str) -> Cow<'_, str> {
    let is_formula = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    if !is_formula || text.len() == 1 || text.parse().is_ok_and(f64::is_finite) {
        visible(text)
    } else {
        Cow::Owned(format!("'{}", visible(text)))
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn texts_are_no_formulas_in_a_spreadsheet_and_numbers_keep_their_sign() {
        for harmless in ["-5.5", "+1e-3", "12", "", "-0", "-"] {
            assert_eq!(inert(harmless), harmless);
        }
        for text in ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@SUM(A1)", "\t=1", "-inf", "+NaN"] {
            assert_eq!(inert(text), format!("'{text}"));
        }
        assert_eq!(inert("\r=1"), r"'\u{d}=1");
        assert_eq!(inert("a=b"), "a=b");
        assert_eq!(inert("\u{1b}[2J\u{202e}"), r"\u{1b}[2J\u{202e}");
    }

    #[test]
    fn numbers_have_the_fewest_digits_that_give_them_back() {
        let powers = (-340..=308).map(|exponent| 10.0_f64.powi(exponent));
        let limits = [
            0.0,
            -0.0,
            f64::MIN_POSITIVE,
            f64::MAX,
            f64::INFINITY,
            0.1 + 0.2,
            2.0_f64.powi(53) + 2.0,
        ];
        // Any bits: one number in 2048 is no number.
        let any = (1..200_000_u64).map(|n| f64::from_bits(n.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        let results = (1..200_000).map(|n| f64::from(n) * 0.917 / 7.0);
        for number in powers.chain(limits).chain(any.filter(|x| !x.is_nan())).chain(results) {
            for number in [number, -number] {
                let mut text = String::new();
                add_digits(number, &mut text);
                assert_eq!(text.parse().map(f64::to_bits), Ok(number.to_bits()), "{text}");
                assert_eq!(text.len(), format!("{number}").len(), "{text} and {number}");
            }
        }
    }

    #[test]
    fn rows_are_lines_in_their_order_however_many_threads_make_them() {
        let table = Table::of("t", 0..3 * ROWS)
            .text("gear", "Gear", |_| "first")
            .number("loss_w", "W", "Loss", |i| (*i != 1).then_some(*i as f64 + 0.1))
            .finish();
        let mut bytes = Vec::new();
        let mut csv = CsvTable::new(&mut bytes, &table).expect("writing to a vector cannot fail");
        csv.rows(&table).expect("writing to a vector cannot fail");
        csv.finish().expect("writing to a vector cannot fail");
        let text = String::from_utf8(bytes).expect("text");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[..3], ["gear,loss_w", "first,0.1", "first,"]);
        assert_eq!(lines.last(), Some(&"first,3071.1"));
        assert_eq!(lines.len(), 3 * ROWS + 1);
    }
}
