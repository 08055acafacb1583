//! How a table is written: the keys that every entry with a file of numbers has.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::MeasuredFault;

/// Cell separator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Separator {
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// A tab character.
    Tab,
    /// Any number of spaces and tabs.
    Blank,
}

/// Decimal sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Decimal {
    /// `1.5`
    Point,
    /// `1,5`
    Comma,
}

/// Sign between groups of three digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Thousands {
    /// `1,500` is 1500.
    Comma,
    /// `1.500` is 1500.
    Point,
}

/// Encoding of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    /// UTF-8, with or without a byte order mark.
    Utf8,
    /// ISO 8859-1.
    Latin1,
    /// UTF-16 with a byte order mark, or else with the lower byte first.
    Utf16,
    /// UTF-16 with the lower byte first.
    Utf16Le,
    /// UTF-16 with the higher byte first.
    Utf16Be,
}

/// Order of day and month in dates such as 3/4/2026.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DateOrder {
    /// 3/4/2026 is in April.
    DayFirst,
    /// 3/4/2026 is in March.
    MonthFirst,
}

/// A mark that a file has in place of a missing value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum MissingMark {
    /// A number, such as -9999, as it is in the file. [-]
    Number(#[schemars(range(min = -1e300, max = 1e300))] f64),
    /// A text, such as `n/a`; an empty text for empty cells.
    Text(String),
}

/// How a table is written. What is not stated is detected if it is unambiguous.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TableForm {
    /// Sheet of a workbook (.xlsx); default: the first one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheet: Option<String>,
    /// Channel group of an MDF file (.mf4), by its name or its number from 1 on; needed if several have samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Line of the header, or row of the sheet, from 1 on; default: the line that has the names of the columns. [-]
    #[schemars(range(min = 1, max = 1_000_000_000))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub header_line: Option<u64>,
    /// First line of numbers that is read; default: the one after the header and the row of units. [-]
    #[schemars(range(min = 1, max = 1_000_000_000))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_line: Option<u64>,
    /// Last line that is read; default: the last one of the file. [-]
    #[schemars(range(min = 1, max = 1_000_000_000))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub last_line: Option<u64>,
    /// Cell separator; default: detected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub separator: Option<Separator>,
    /// Decimal sign; default: detected. In a workbook that of numbers stored as texts, a point unless stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub decimal: Option<Decimal>,
    /// Sign between groups of three digits; default: none, unless a number such as `1.500,5` has both signs. Apostrophes and spaces between
    /// groups are always read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thousands: Option<Thousands>,
    /// Encoding; default: that of the byte order mark, UTF-8, or Latin-1 if that fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub encoding: Option<Encoding>,
    /// Order of day and month in dates as 3/4/2026; needed if no date of the file shows it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date_order: Option<DateOrder>,
    /// Marks of missing values: `[-9999, "n/a"]`; an empty list states that numbers such as -9999 are values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<Vec<MissingMark>>,
}

impl TableForm {
    /// This form, completed by another.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        Self {
            sheet: self.sheet.clone().or_else(|| other.sheet.clone()),
            group: self.group.clone().or_else(|| other.group.clone()),
            header_line: self.header_line.or(other.header_line),
            first_line: self.first_line.or(other.first_line),
            last_line: self.last_line.or(other.last_line),
            separator: self.separator.or(other.separator),
            decimal: self.decimal.or(other.decimal),
            thousands: self.thousands.or(other.thousands),
            encoding: self.encoding.or(other.encoding),
            date_order: self.date_order.or(other.date_order),
            missing: self.missing.clone().or_else(|| other.missing.clone()),
        }
    }

    /// Rejects keys that a kind of file does not have, and lines in the wrong order.
    pub(super) fn check(&self, kind: Kind) -> Result<(), MeasuredFault> {
        let text = kind == Kind::Text;
        let mdf = kind == Kind::Mdf;
        let unused = [
            ("separator", self.separator.is_some() && !text),
            ("encoding", self.encoding.is_some() && !text),
            ("decimal", self.decimal.is_some() && mdf),
            ("thousands", self.thousands.is_some() && mdf),
            ("header_line", self.header_line.is_some() && mdf),
            ("sheet", self.sheet.is_some() && kind != Kind::Workbook),
            ("group", self.group.is_some() && !mdf),
        ];
        if let Some((key, _)) = unused.into_iter().find(|(_, stated)| *stated) {
            let what = match kind {
                Kind::Text => "a text file (CSV)",
                Kind::Workbook => "a workbook",
                Kind::Mdf => "an MDF file",
            };
            let message = format!("{what} has no `{key}`");
            return Err(MeasuredFault::new(key, message, format!("delete `{key}`")));
        }
        let same = matches!(
            (self.decimal, self.thousands),
            (Some(Decimal::Comma), Some(Thousands::Comma)) | (Some(Decimal::Point), Some(Thousands::Point))
        );
        if same {
            let message = "`decimal` and `thousands` have the same sign";
            return Err(MeasuredFault::new("thousands", message, "delete one of them"));
        }
        let lines = [
            ("header_line", self.header_line, "first_line", self.first_line),
            ("header_line", self.header_line, "last_line", self.last_line),
        ];
        for (key, line, later, after) in lines {
            if let (Some(line), Some(after)) = (line, after)
                && after <= line
            {
                let message = format!("`{later}: {after}` is not after `{key}: {line}`");
                return Err(MeasuredFault::new(
                    later,
                    message,
                    "count the lines from 1 on, comments included",
                ));
            }
        }
        if let (Some(first), Some(last)) = (self.first_line, self.last_line)
            && last < first
        {
            let message = format!("`last_line: {last}` is before `first_line: {first}`");
            return Err(MeasuredFault::new("last_line", message, "exchange them"));
        }
        Ok(())
    }

    /// True if a line of numbers is to be read.
    pub(super) fn has_line(&self, line: u64) -> bool {
        self.first_line.is_none_or(|first| line >= first) && self.last_line.is_none_or(|last| line <= last)
    }
}

/// Kind of a file by its content.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Text,
    Workbook,
    Mdf,
}
