//! Numbers and tables as text.

pub use gearloss_studies::analyses::map::SHOWN;
pub use gearloss_studies::analyses::numbers::spread_over;

use std::fmt::Write as _;

pub use gearloss_studies::analyses::numbers::{beyond, figures, fixed, significant};

/// Text that grows line by line.
#[derive(Debug, Default)]
pub struct Lines(String);

impl Lines {
    /// Adds a line.
    pub fn line(&mut self, line: impl AsRef<str>) {
        self.0.push_str(line.as_ref());
        self.0.push('\n');
    }

    /// Adds a text as it is.
    pub fn text(&mut self, text: &str) {
        self.0.push_str(text);
    }

    /// The text.
    pub fn into_text(self) -> String {
        self.0
    }
}

/// A table of texts; columns of numbers are right-aligned.
pub struct TextTable {
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// A table with its header.
    pub fn new(head: &[&str]) -> Self {
        Self {
            rows: vec![head.iter().map(|h| (*h).to_owned()).collect()],
        }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// The table as text.
    pub fn render(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |i: usize| {
            self.rows
                .iter()
                .filter_map(|r| r.get(i))
                .map(|c| c.chars().count())
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        // Columns of numbers are right-aligned.
        let numeric = |i: usize| {
            self.rows
                .iter()
                .skip(1)
                .filter_map(|r| r.get(i))
                .all(|c| c.is_empty() || c == "-" || c.parse::<f64>().is_ok())
        };
        let right: Vec<bool> = (0..columns).map(numeric).collect();
        let mut text = String::new();
        for (n, row) in self.rows.iter().enumerate() {
            let mut line = String::new();
            for (i, cell) in row.iter().enumerate() {
                let gap = " ".repeat(widths[i] - cell.chars().count());
                let space = if i == 0 { "" } else { "  " };
                let _ = if right[i] {
                    write!(line, "{space}{gap}{cell}")
                } else {
                    write!(line, "{space}{cell}{gap}")
                };
            }
            text.push_str(line.trim_end());
            text.push('\n');
            if n == 0 {
                let total: usize = widths.iter().sum::<usize>() + 2 * widths.len().saturating_sub(1);
                text.push_str(&"-".repeat(total));
                text.push('\n');
            }
        }
        text
    }
}

/// A number with `digits` decimals; a dash if absent.
pub fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |x| fixed(x, digits))
}

/// Indices of at most [`SHOWN`] rows or columns, evenly spread, with both ends.
pub fn spread(count: usize) -> Vec<usize> {
    spread_over(count, SHOWN)
}

#[cfg(test)]
mod tests {
    use super::{fixed, number};

    #[test]
    fn huge_numbers_are_short() {
        assert_eq!(fixed(8000.0, 2), "8000.00");
        assert_eq!(fixed(-999_999_999.4, 0), "-999999999");
        assert_eq!(fixed(1e9, 2), "1.00000e9");
        assert_eq!(fixed(-12_345_678_901.0, 2), "-12.3457e9");
        assert_eq!(number(Some(9.999_999e299), 4), "1.00000e300");
        assert_eq!(fixed(f64::MAX, 1), "179.769e306");
        assert_eq!(fixed(f64::INFINITY, 1), "-");
    }
}
