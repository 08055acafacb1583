//! Numbers and tables as text.

pub use gearloss_studies::analyses::map::SHOWN;
pub use gearloss_studies::numbers::spread_over;

use std::fmt::Write as _;

use gearloss_framework::resolve::OWN_MODELS;
use gearloss_studies::numbers::tidy;
use serde::Serialize;

pub use gearloss_studies::numbers::{beyond, figures, fixed, significant};

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
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct TextTable {
    /// Title; may be empty.
    title: String,
    /// Cells, the first row is the head.
    rows: Vec<Vec<String>>,
}

/// A table during construction: its rows, and the columns that are complete.
#[must_use]
pub struct TextTableOf<R> {
    rows: Vec<R>,
    table: TextTable,
}

impl<R> TextTableOf<R> {
    /// Adds a column: its name, which ends with its unit, and its cell in each row.
    pub fn column<C: Into<String>>(mut self, name: impl AsRef<str>, cell: impl Fn(&R) -> C) -> Self {
        let cells = self.rows.iter().map(|row| cell(row).into());
        let cells = std::iter::once(printed_head(name)).chain(cells);
        for (row, cell) in self.table.rows.iter_mut().zip(cells) {
            row.push(cell);
        }
        self
    }

    /// Adds the columns of each of several items, such as one column per share of the loss.
    pub fn each<I>(self, items: impl IntoIterator<Item = I>, columns: impl FnMut(Self, I) -> Self) -> Self {
        items.into_iter().fold(self, columns)
    }

    /// The table of all columns.
    pub fn finish(self) -> TextTable {
        self.table
    }
}

/// The name of a column with its unit as it is printed.
fn printed_head(name: impl AsRef<str>) -> String {
    let name = name.as_ref();
    match name.rsplit_once(' ') {
        Some((quantity, unit)) => format!("{quantity} {}", printed_unit(unit)),
        None => name.to_owned(),
    }
}

impl TextTable {
    /// A table with its header, whose names end with their units.
    pub fn new<S: AsRef<str>>(head: &[S]) -> Self {
        Self {
            title: String::new(),
            rows: vec![head.iter().map(printed_head).collect()],
        }
    }

    /// A table with its header and rows.
    pub fn filled<S: AsRef<str>>(head: &[S], rows: Vec<Vec<String>>) -> Self {
        let mut table = Self::new(head);
        table.rows.extend(rows);
        table
    }

    /// A table with a row for each of these, whose columns follow: `TextTable::of(nodes).column("node", |node| &node.name).finish()`.
    pub fn of<R>(rows: impl IntoIterator<Item = R>) -> TextTableOf<R> {
        let rows: Vec<R> = rows.into_iter().collect();
        let table = Self {
            title: String::new(),
            rows: vec![Vec::new(); rows.len() + 1],
        };
        TextTableOf { rows, table }
    }

    /// A quantity over a grid: a row for each torque in Nm, a column for each speed in rpm, and the cell by their indices.
    pub fn over_grid(torques: &[f64], speeds: &[f64], cell: impl Fn(usize, usize) -> String) -> Self {
        Self::of(spread(torques.len()))
            .column("torque Nm", |t| tidy(torques[*t]).to_string())
            .each(spread(speeds.len()), |table, s| {
                table.column(format!("{} rpm", fixed(speeds[s], 0)), |t| cell(*t, s))
            })
            .finish()
    }

    /// The table with a title.
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..self
        }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// The table as text, below its title.
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
        if !self.title.is_empty() {
            text = format!("{}\n", self.title);
        }
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

/// A number with three significant digits for a sentence; thousands are separated by narrow spaces.
pub fn short(x: f64) -> String {
    // Digits before the decimal point are all kept, but for powers of ten.
    let large = (1000.0..999_999.5).contains(&x.abs());
    let digits = if large { 6 } else { 3 };
    let x = if large { x.round() } else { x };
    spaced(&figures(x, digits))
}

/// A difference with its sign and three significant digits.
pub fn signed(x: f64) -> String {
    let sign = if x > 0.0 { "+" } else { "" };
    format!("{sign}{}", short(x))
}

/// The digits of a number in groups of three from ten thousand, as engineers write it.
pub fn spaced(number: &str) -> String {
    let (sign, rest) = number.strip_prefix('-').map_or(("", number), |rest| ("-", rest));
    let (whole, decimals) = rest.find('.').map_or((rest, ""), |at| rest.split_at(at));
    if whole.len() < 5 || !whole.bytes().all(|digit| digit.is_ascii_digit()) {
        return number.to_owned();
    }
    let first = whole.len() % 3;
    let mut groups: Vec<&str> = Vec::new();
    if first > 0 {
        groups.push(&whole[..first]);
    }
    groups.extend((first..whole.len()).step_by(3).map(|i| &whole[i..i + 3]));
    format!("{sign}{}{decimals}", groups.join("\u{202f}"))
}

/// A text with a capital letter at its start.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A unit as it is printed.
pub fn printed_unit(unit: &str) -> &str {
    match unit {
        "degC" => "°C",
        "um" => "µm",
        _ => unit,
    }
}

/// A sentence with the units behind its numbers as they are printed: `100 degC` becomes `100 °C`, `0.2 um` becomes `0.2 µm`.
pub fn with_printed_units(sentence: &str) -> String {
    let mut behind_number = false;
    let word = |word: &str| {
        let bare = word.trim_end_matches(|letter: char| !letter.is_alphanumeric());
        let printed = if behind_number {
            word.replacen(bare, printed_unit(bare), 1)
        } else {
            word.to_owned()
        };
        behind_number = bare.ends_with(|letter: char| letter.is_ascii_digit());
        printed
    };
    sentence.split_inclusive(' ').map(word).collect()
}

/// A unit behind a further number of a sentence, in which percentage points need no repetition.
pub fn again(unit: &str) -> String {
    if unit == "percentage points" {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// The name of a model set in front of its result; nothing if there are only the models of the gearbox.
pub fn of_set(set: &str, sets: usize) -> String {
    if set == OWN_MODELS && sets == 1 {
        String::new()
    } else {
        format!("with {} ", quoted_set(set))
    }
}

/// The name of a model set in a sentence.
pub fn quoted_set(set: &str) -> String {
    if set == OWN_MODELS {
        "the gearbox's own models".to_owned()
    } else {
        format!("`{set}`")
    }
}

/// The name of a model set in a label.
pub fn words_of_set(set: &str) -> String {
    if set == OWN_MODELS {
        format!("{set} models")
    } else {
        set.to_owned()
    }
}

/// A label with the name of its model set; alone if there is only one.
pub fn label_of_set(label: &str, set: &str, sets: usize) -> String {
    if sets > 1 {
        format!("{label}, {}", words_of_set(set))
    } else {
        label.to_owned()
    }
}

/// A remark in brackets; nothing if it is empty.
pub fn in_brackets(remark: &str) -> String {
    if remark.is_empty() {
        String::new()
    } else {
        format!(" ({remark})")
    }
}

/// The last key of a path.
pub fn last_key(path: &str) -> &str {
    path.rsplit('.').next().unwrap_or(path)
}

/// An operating point in words, torque in Nm, speed in rpm.
pub fn place(torque: f64, speed: f64) -> String {
    format!("{} Nm, {} rpm", short(torque), short(speed))
}

/// Two numbers as a range with the fewest decimals that distinguish them: at least `digits`, but none from four digits before the point
/// on, and as many as give the larger number two significant digits.
pub fn range(low: f64, high: f64, digits: usize) -> String {
    let largest = low.abs().max(high.abs());
    let two_figures = if (1e-6..10.0).contains(&largest) {
        (1.0 - largest.log10().floor()) as usize
    } else {
        0
    };
    let words = |more: usize| {
        [low, high].map(|x| {
            let least = if x.abs() < 999.5 { digits.max(two_figures) } else { 0 };
            spaced(&fixed(x, least + more))
        })
    };
    let distinct = (0..3).map(words).find(|[low, high]| low != high);
    let [low, high] = distinct.unwrap_or_else(|| words(0));
    if low == high { low } else { format!("{low} to {high}") }
}

/// Minimum and maximum with what they belong to.
pub fn extremes<T: Copy>(values: impl Iterator<Item = (f64, T)>) -> Option<[(f64, T); 2]> {
    values.fold(None, |ends, new| match ends {
        None => Some([new, new]),
        Some([low, high]) => Some([
            if new.0 < low.0 { new } else { low },
            if new.0 > high.0 { new } else { high },
        ]),
    })
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
    use super::{fixed, number, range, short, signed, with_printed_units};

    #[test]
    fn numbers_of_sentences_are_short() {
        assert_eq!(short(98.7654), "98.8");
        assert_eq!(short(-0.012_345), "-0.0123");
        assert_eq!(short(8000.4), "8000");
        assert_eq!(short(22_000.0), "22\u{202f}000");
        assert_eq!(short(-1_234_567.8), "-1.23e6");
        assert_eq!(signed(0.5), "+0.5");
        assert_eq!(range(98.1234, 98.1299, 1), "98.12 to 98.13");
        assert_eq!(range(50.0, 50.0, 1), "50.0");
        assert_eq!(range(18.41, 2658.93, 1), "18.4 to 2659");
        assert_eq!(range(0.0221, 0.3784, 0), "0.02 to 0.38");
        assert_eq!(range(12_000.2, 12_000.4, 0), "12\u{202f}000.2 to 12\u{202f}000.4");
    }

    #[test]
    fn units_behind_numbers_are_printed_as_engineers_write_them() {
        let text = "At 100 degC, 0.2 um: roughness in um, um zu";
        assert_eq!(with_printed_units(text), "At 100 °C, 0.2 µm: roughness in um, um zu");
    }

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
