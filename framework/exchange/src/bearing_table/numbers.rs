//! Numbers with decimal and thousands signs: how a whole file is written decides, because `19,500` alone may be either.

use gearloss_document::data::Decimal;

/// The signs of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Style {
    pub decimal: char,
    /// The sign between groups of three digits, if it is a point or a comma; spaces and apostrophes always are.
    pub thousands: Option<char>,
}

/// A cell of a column of numbers.
#[derive(Debug, PartialEq)]
pub(super) enum Cell {
    Blank,
    Number(f64),
    Wrong,
}

/// Spaces and apostrophes between digits.
const GROUPS: [char; 7] = [' ', '\u{a0}', '\u{202f}', '\u{2009}', '\'', '\u{2019}', '\u{2007}'];

fn without_groups(cell: &str) -> String {
    cell.chars().filter(|c| !GROUPS.contains(c)).collect()
}

fn is_blank(cell: &str) -> bool {
    matches!(
        cell,
        "" | "-" | "–" | "—" | "―" | "n/a" | "n.a." | "N/A" | "k. A." | "k.A." | "*"
    )
}

/// True if a sign divides the digits into groups of three.
fn in_groups(cell: &str, sign: char) -> bool {
    let mut groups = cell.split(sign);
    let first = groups.next().unwrap_or_default();
    let first = first.strip_prefix('-').unwrap_or(first);
    (1..=3).contains(&first.len())
        && first != "0"
        && groups.all(|group| group.len() == 3 && group.bytes().all(|b| b.is_ascii_digit()))
}

/// What a cell says of the decimal sign.
fn evidence(cell: &str) -> Evidence {
    let signs = |sign: char| cell.matches(sign).count();
    let last = |sign: char| cell.rfind(sign);
    match (signs('.'), signs(',')) {
        (0, 0) => Evidence::None,
        (0, 1) if in_groups(cell, ',') => Evidence::Either,
        (1, 0) if in_groups(cell, '.') => Evidence::Either,
        (0, 1) => Evidence::Decimal(','),
        // One point, or several commas, which divide thousands.
        (1, 0) | (0, _) => Evidence::Decimal('.'),
        (_, 0) => Evidence::Decimal(','),
        _ if last('.') > last(',') => Evidence::Decimal('.'),
        _ => Evidence::Decimal(','),
    }
}

enum Evidence {
    None,
    Either,
    Decimal(char),
}

impl Style {
    /// The style of all numbers of a file.
    pub(super) fn of_cells<'a>(
        cells: impl Iterator<Item = (u64, &'a str)>,
        stated: Option<Decimal>,
    ) -> Result<Self, String> {
        let mut decimal: Option<(char, u64, String)> = None;
        let mut either: Option<(u64, String)> = None;
        for (line, cell) in cells {
            let bare = without_groups(cell);
            if is_blank(cell) || !bare.chars().all(|c| c.is_ascii_digit() || matches!(c, '.' | ',' | '-')) {
                continue;
            }
            match evidence(&bare) {
                Evidence::None => {}
                Evidence::Either => {
                    either.get_or_insert((line, cell.to_owned()));
                }
                Evidence::Decimal(sign) => match &decimal {
                    Some((other, first, example)) if *other != sign && stated.is_none() => {
                        return Err(format!(
                            "`{example}` in line {first} and `{cell}` in line {line} have different decimal signs"
                        ));
                    }
                    Some(_) => {}
                    None => decimal = Some((sign, line, cell.to_owned())),
                },
            }
        }
        let sign = match (stated, &decimal, &either) {
            (Some(Decimal::Comma), ..) => ',',
            (Some(Decimal::Point), ..) | (None, None, None) => '.',
            (None, Some((sign, ..)), _) => *sign,
            (None, None, Some((line, cell))) => {
                return Err(format!(
                    "`{cell}` in line {line} may have decimals or thousands, and no other number shows which"
                ));
            }
        };
        Ok(Self {
            decimal: sign,
            thousands: either.is_some().then_some(if sign == ',' { '.' } else { ',' }),
        })
    }

    /// The number in a cell.
    pub(super) fn number(self, cell: &str) -> Cell {
        let cell = cell.trim();
        if is_blank(cell) {
            return Cell::Blank;
        }
        let bare = without_groups(cell);
        let other = if self.decimal == ',' { '.' } else { ',' };
        let (whole, decimals) = bare.split_once(self.decimal).unwrap_or((&bare, ""));
        if whole.contains(other) && !in_groups(whole, other) {
            return Cell::Wrong;
        }
        let whole = whole.replace(other, "");
        let text = if decimals.is_empty() {
            whole
        } else {
            format!("{whole}.{decimals}")
        };
        match text.parse::<f64>() {
            Ok(number) if number.is_finite() => Cell::Number(number),
            _ => Cell::Wrong,
        }
    }

    pub(super) fn words(self) -> String {
        let name = |sign| if sign == ',' { "comma" } else { "point" };
        let thousands = self
            .thousands
            .map_or(String::new(), |sign| format!(", thousands with {}s", name(sign)));
        format!("decimal {}{thousands}", name(self.decimal))
    }
}

/// Twelve digits: the conversion of a unit leaves no rounding error in the text.
pub(super) fn rounded(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}
