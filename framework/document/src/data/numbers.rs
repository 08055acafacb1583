//! Numbers with decimal signs and signs between groups of three digits.

use super::form::{Decimal, Separator, TableForm, Thousands};
use super::{MeasuredFault, fault};

/// Spaces and apostrophes between groups of digits.
pub const GROUP_SIGNS: [char; 7] = [' ', '\u{a0}', '\u{202f}', '\u{2009}', '\'', '\u{2019}', '\u{2007}'];

/// How the numbers of a table are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NumberStyle {
    /// The decimal sign.
    pub decimal: Decimal,
    /// The sign between groups of three digits besides spaces and apostrophes.
    pub thousands: Option<Thousands>,
}

impl NumberStyle {
    /// Decimal points and no thousands.
    pub const PLAIN: Self = Self {
        decimal: Decimal::Point,
        thousands: None,
    };

    /// A finite number.
    pub fn number(self, cell: &str) -> Option<f64> {
        let number = match self.decimal {
            Decimal::Point => cell.parse::<f64>().ok(),
            Decimal::Comma if cell.contains('.') => None,
            Decimal::Comma => cell.replace(',', ".").parse::<f64>().ok(),
        };
        // `1.500` with points between thousands is a number of another size with a decimal point.
        number.or_else(|| self.grouped(cell)).filter(|x| x.is_finite())
    }

    /// A number with groups of digits, or with the minus sign of typography.
    fn grouped(self, cell: &str) -> Option<f64> {
        if !cell.contains(|c: char| c.is_ascii_digit()) {
            return None;
        }
        let cell = cell.replace('\u{2212}', "-");
        let decimal = match self.decimal {
            Decimal::Point => '.',
            Decimal::Comma => ',',
        };
        let (whole, decimals) = cell.split_once(decimal).unwrap_or((&cell, "0"));
        let stated = match self.thousands {
            Some(Thousands::Comma) => Some(','),
            Some(Thousands::Point) => Some('.'),
            None => None,
        };
        let sign = GROUP_SIGNS.into_iter().chain(stated).find(|sign| whole.contains(*sign));
        let whole = match sign {
            Some(sign) if in_groups(whole, sign) => whole.replace(sign, ""),
            Some(_) => return None,
            None => whole.to_owned(),
        };
        format!("{whole}.{decimals}").parse().ok()
    }

    /// The cell with a decimal point and without groups, if it is a number that is not written so.
    pub fn plain(self, cell: &str) -> Option<String> {
        // Most cells: no letter of another alphabet, no space, no apostrophe.
        let has_groups = cell.bytes().any(|byte| matches!(byte, b' ' | b'\'' | 0x80..));
        if self == Self::PLAIN && !has_groups {
            return None;
        }
        let number = self.number(cell)?;
        Some(
            if self.decimal == Decimal::Comma && self.thousands.is_none() && !has_groups {
                cell.replace(',', ".")
            } else {
                written(number)
            },
        )
    }
}

/// True if a sign divides the digits of a number into groups of three.
pub fn in_groups(cell: &str, sign: char) -> bool {
    let mut groups = cell.split(sign);
    let first = groups.next().unwrap_or_default().trim_start_matches(['-', '+']);
    let digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    (1..=3).contains(&first.len())
        && first != "0"
        && digits(first)
        && groups.all(|group| group.len() == 3 && digits(group))
}

/// What a cell shows of the signs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shows {
    /// No number, or one without signs.
    Nothing,
    /// A decimal sign.
    Decimal(Decimal),
    /// A sign that may be of decimals or of thousands.
    Either(Decimal),
    /// A decimal sign and the other one between groups, or several signs between groups.
    Groups(Decimal),
}

fn shows(cell: &str) -> Shows {
    let bytes = cell.as_bytes();
    // Texts are most of what is no number; their first letter decides.
    if !bytes
        .first()
        .is_some_and(|b| matches!(b, b'0'..=b'9' | b'-' | b'+' | b'.' | b','))
    {
        return Shows::Nothing;
    }
    let (mut points, mut commas) = (0, 0);
    let (mut point, mut comma) = (0, 0);
    for (place, byte) in bytes.iter().enumerate() {
        match byte {
            b'.' => (points, point) = (points + 1, place),
            b',' => (commas, comma) = (commas + 1, place),
            b'0'..=b'9' | b'-' | b'+' | b'e' | b'E' => {}
            _ => return Shows::Nothing,
        }
    }
    let one = |sign: char, decimal: Decimal| {
        if in_groups(cell, sign) {
            Shows::Either(decimal)
        } else {
            Shows::Decimal(decimal)
        }
    };
    match (points, commas) {
        (0, 0) => Shows::Nothing,
        (1, 0) => one('.', Decimal::Point),
        (0, 1) => one(',', Decimal::Comma),
        (0, _) if in_groups(cell, ',') => Shows::Groups(Decimal::Point),
        (_, 0) if in_groups(cell, '.') => Shows::Groups(Decimal::Comma),
        (0, _) => Shows::Decimal(Decimal::Comma),
        // A date or a version.
        (_, 0) => Shows::Nothing,
        (1, _) if comma < point && in_groups(&cell[..point], ',') => Shows::Groups(Decimal::Point),
        (_, 1) if point < comma && in_groups(&cell[..comma], '.') => Shows::Groups(Decimal::Comma),
        _ => Shows::Nothing,
    }
}

/// The first lines on which cells show each possibility.
#[derive(Default)]
struct Seen {
    decimal: [Option<(u64, String)>; 2],
    either: [Option<(u64, String)>; 2],
    groups: [Option<(u64, String)>; 2],
}

fn index(decimal: Decimal) -> usize {
    usize::from(decimal == Decimal::Comma)
}

/// The style of the numbers of a table: stated, or shown by all of them together.
///
/// # Errors
/// If cells show different styles, or may have decimals or thousands.
pub(super) fn style(
    rows: &[(u64, Vec<String>)],
    (form, separator): (&TableForm, Separator),
    notes: &mut Vec<String>,
) -> Result<NumberStyle, MeasuredFault> {
    let of_decimal = |decimal: Decimal| match decimal {
        Decimal::Point => Thousands::Comma,
        Decimal::Comma => Thousands::Point,
    };
    if let Some(thousands) = form.thousands {
        let decimal = match thousands {
            Thousands::Comma => Decimal::Point,
            Thousands::Point => Decimal::Comma,
        };
        return Ok(NumberStyle {
            decimal,
            thousands: Some(thousands),
        });
    }
    let mut seen = Seen::default();
    for (line, cells) in rows {
        for cell in cells {
            let (list, decimal) = match shows(cell) {
                Shows::Nothing => continue,
                Shows::Decimal(decimal) => (&mut seen.decimal, decimal),
                Shows::Either(decimal) => (&mut seen.either, decimal),
                Shows::Groups(decimal) => (&mut seen.groups, decimal),
            };
            list[index(decimal)].get_or_insert_with(|| (*line, cell.clone()));
        }
    }
    let groups = |decimal: Decimal| seen.groups[index(decimal)].is_some();
    if let Some(decimal) = form.decimal {
        let thousands = groups(decimal).then(|| of_decimal(decimal));
        return Ok(NumberStyle { decimal, thousands });
    }
    let any = |decimal: Decimal| {
        seen.decimal[index(decimal)]
            .as_ref()
            .or(seen.either[index(decimal)].as_ref())
    };
    for (mark, other) in [(Decimal::Point, Decimal::Comma), (Decimal::Comma, Decimal::Point)] {
        if !groups(mark) {
            continue;
        }
        let against = seen.groups[index(other)]
            .as_ref()
            .or(seen.decimal[index(other)].as_ref());
        if let (Some((line, cell)), Some((at, against))) = (&seen.groups[index(mark)], against) {
            return Err(mixed((*line, cell), (*at, against)));
        }
        notes.push(match mark {
            Decimal::Point => "decimal point, thousands with commas".to_owned(),
            Decimal::Comma => "decimal comma, thousands with points".to_owned(),
        });
        return Ok(NumberStyle {
            decimal: mark,
            thousands: Some(of_decimal(mark)),
        });
    }
    match (any(Decimal::Comma), any(Decimal::Point)) {
        (Some((comma, _)), Some((point, _))) => Err(fault(
            format!("line {comma} has a decimal comma and line {point} a decimal point"),
            "state `decimal: comma` or `decimal: point`, with `thousands: point` or `thousands: comma` if the other sign divides thousands",
        )),
        (Some((line, cell)), None) => {
            if seen.decimal[index(Decimal::Comma)].is_none() {
                return Err(unclear(*line, cell));
            }
            notes.push("decimal comma".to_owned());
            Ok(NumberStyle {
                decimal: Decimal::Comma,
                thousands: None,
            })
        }
        // Where points divide thousands, commas are decimal signs and do not separate cells.
        (None, Some((line, cell)))
            if seen.decimal[index(Decimal::Point)].is_none()
                && matches!(separator, Separator::Semicolon | Separator::Tab) =>
        {
            Err(unclear(*line, cell))
        }
        (None, _) => Ok(NumberStyle::PLAIN),
    }
}

fn mixed((line, cell): (u64, &str), (at, other): (u64, &str)) -> MeasuredFault {
    fault(
        format!("line {line}: `{cell}` and line {at}: `{other}` have different decimal signs"),
        "correct the cells; `decimal` and `thousands` state the signs of the whole file",
    )
}

fn unclear(line: u64, cell: &str) -> MeasuredFault {
    let (sign, other) = if cell.contains(',') {
        ("comma", "point")
    } else {
        ("point", "comma")
    };
    fault(
        format!("line {line}: `{cell}` may have decimals or thousands, and no other number shows which"),
        format!(
            "state `decimal: {sign}` if the {sign} is the decimal sign, or `decimal: {other}` and `thousands: {sign}` if it divides thousands"
        ),
    )
}

/// A number as in a file with decimal points; reading it gives the same number.
pub(super) fn written(number: f64) -> String {
    if number.fract() == 0.0 && number.abs() < 9e15 {
        return (number as i64).to_string();
    }
    // Small and large numbers have an exponent.
    format!("{number:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_of_three_digits_are_read_and_nothing_else() {
        let style = |decimal, thousands| NumberStyle { decimal, thousands };
        for (style, cell, number) in [
            (NumberStyle::PLAIN, "1'500", Some(1500.0)),
            (NumberStyle::PLAIN, "1 500.25", Some(1500.25)),
            (NumberStyle::PLAIN, "-12\u{a0}345\u{a0}678", Some(-12_345_678.0)),
            (NumberStyle::PLAIN, "\u{2212}5", Some(-5.0)),
            (NumberStyle::PLAIN, "1 50", None),
            (NumberStyle::PLAIN, "1 500'000", None),
            (NumberStyle::PLAIN, "1,500", None),
            (NumberStyle::PLAIN, "0 500", None),
            (NumberStyle::PLAIN, "NaN", None),
            (style(Decimal::Comma, None), "1,5", Some(1.5)),
            (style(Decimal::Comma, None), "1.500", None),
            (style(Decimal::Comma, None), "1 500,5", Some(1500.5)),
            (style(Decimal::Comma, Some(Thousands::Point)), "1.500,5", Some(1500.5)),
            (style(Decimal::Comma, Some(Thousands::Point)), "1.500", Some(1500.0)),
            (style(Decimal::Comma, Some(Thousands::Point)), "1.5", None),
            (
                style(Decimal::Point, Some(Thousands::Comma)),
                "1,500,000.5",
                Some(1_500_000.5),
            ),
            (style(Decimal::Point, Some(Thousands::Comma)), "1,50", None),
        ] {
            assert_eq!(style.number(cell), number, "{cell}");
        }
    }
}
