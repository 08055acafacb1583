//! Dates and clock times as a time axis: seconds from the first row.

use super::form::{DateOrder, Decimal};
use super::table::Table;
use super::workbook::DATE;
use super::{MeasuredFault, fault};

/// Seconds of a day.
const DAY: f64 = 86400.0;

/// What a cell says, before the order of day and month is known.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Stamp {
    date: Option<Date>,
    /// Seconds from midnight, or elapsed ones.
    seconds: f64,
    /// Seconds that the clock is ahead of UTC.
    ahead: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Date {
    /// Days from an origin.
    Days(i64),
    /// Two numbers, which are day and month or month and day, and the year.
    Either([i64; 2], i64),
}

/// True if a cell may be a date or a clock time.
fn is_stamp(cell: &str) -> bool {
    cell.starts_with(DATE)
        || (cell.starts_with(|c: char| c.is_ascii_digit())
            && (cell.contains(':')
                || ['-', '/', '.'].iter().any(|sign| cell.matches(*sign).count() == 2)
                    && cell.chars().take(8).all(|c| c.is_ascii_digit() || "-/.".contains(c))))
}

/// True if a unit is a pattern of dates or clock times: `hh:mm:ss`.
pub(super) fn is_pattern(unit: &str) -> bool {
    let lower = unit.to_ascii_lowercase();
    (lower.contains("mm") && (lower.contains("hh") || lower.contains("ss") || lower.contains("yy")))
        && lower.chars().all(|c| "hmsydtfz .:,-/0".contains(c))
}

impl Table {
    /// Replaces dates and clock times of a column by seconds from the first row; false if it has none.
    ///
    /// # Errors
    /// A cell that is none, or dates whose order of day and month is not known.
    pub fn take_times(
        &mut self,
        place: usize,
        order: Option<DateOrder>,
        notes: &mut Vec<String>,
    ) -> Result<bool, MeasuredFault> {
        let cells = || {
            self.rows.iter().enumerate().filter_map(|(row, (line, cells))| {
                let cell = cells.get(place).map(String::as_str).filter(|cell| !cell.is_empty())?;
                Some((row, *line, cell))
            })
        };
        let Some((_, first_line, first)) = cells().next().filter(|(.., cell)| is_stamp(cell)) else {
            return Ok(false);
        };
        let first = first.to_owned();
        let mut stamps = Vec::new();
        for (row, line, cell) in cells() {
            let stamp = stamp(cell)
                .map_err(|(why, help)| fault(format!("{}: `{cell}`{why}", self.describe(line, place)), help))?;
            stamps.push((row, line, stamp));
        }
        let at = |line: u64| self.describe(line, place);
        let of_first = stamps[0].2;
        if let Some((_, line, _)) = stamps.iter().find(|(.., s)| {
            s.date.is_some() != of_first.date.is_some() || s.ahead.is_some() != of_first.ahead.is_some()
        }) {
            return Err(fault(
                format!(
                    "{}: unlike line {first_line}, with or without a date or a time zone",
                    at(*line)
                ),
                "write all times in the same form",
            ));
        }
        let days =
            days(&stamps, order).map_err(|(line, message, help)| fault(format!("{}: {message}", at(line)), help))?;
        let mut seconds: Vec<f64> = Vec::with_capacity(stamps.len());
        for ((_, _, stamp), day) in stamps.iter().zip(&days) {
            let clock = stamp.seconds - stamp.ahead.unwrap_or(0.0) - (of_first.seconds - of_first.ahead.unwrap_or(0.0));
            // Clock times have no more than nine decimals; their differences have rounding errors beyond.
            seconds.push(((day - days[0]) as f64).mul_add(DAY, (clock * 1e9).round() / 1e9));
        }
        // Elapsed hours exceed a day, and a clock does not.
        let is_clock = of_first.date.is_none() && stamps.iter().all(|(.., s)| s.seconds < DAY);
        let mut later = 0.0;
        let mut midnights = Vec::new();
        for i in 0..seconds.len() {
            if is_clock && i > 0 && seconds[i] + later < seconds[i - 1] - DAY / 2.0 {
                later += DAY;
                midnights.push(stamps[i].1.to_string());
            }
            seconds[i] += later;
        }
        let first = first.trim_start_matches(DATE);
        notes.push(format!(
            "`{}` is in seconds from the first row, {first}",
            self.names[place]
        ));
        if !midnights.is_empty() {
            notes.push(format!("the clock passes midnight at line {}", midnights.join(", ")));
        }
        let decimal = self.numbers.decimal;
        for ((row, ..), seconds) in stamps.iter().zip(seconds) {
            let number = super::numbers::written(seconds);
            self.rows[*row].1[place] = match decimal {
                Decimal::Point => number,
                Decimal::Comma => number.replace('.', ","),
            };
        }
        self.units[place] = Some("s".to_owned());
        Ok(true)
    }
}

/// The day of each stamp; zero without a date.
fn days(stamps: &[(usize, u64, Stamp)], order: Option<DateOrder>) -> Result<Vec<i64>, (u64, String, String)> {
    let either = || {
        stamps.iter().filter_map(|(_, line, stamp)| match stamp.date {
            Some(Date::Either(numbers, year)) => Some((*line, numbers, year)),
            _ => None,
        })
    };
    let shown = |place: usize| either().any(|(_, numbers, _)| numbers[place] > 12);
    let order = order.or(match (shown(0), shown(1)) {
        (true, false) => Some(DateOrder::DayFirst),
        (false, true) => Some(DateOrder::MonthFirst),
        _ => None,
    });
    let first = either().next();
    // All on one day: whichever it is.
    let is_one_day = either().all(|(_, numbers, year)| first.is_some_and(|f| (f.1, f.2) == (numbers, year)));
    let day_of = |line: u64, [a, b]: [i64; 2], year: i64| {
        let [day, month] = match order {
            Some(DateOrder::DayFirst) => [a, b],
            Some(DateOrder::MonthFirst) => [b, a],
            None if is_one_day => return Ok(0),
            None => {
                return Err((
                    line,
                    format!("`{a}` and `{b}` may be day and month, or month and day"),
                    "state `date_order: day_first` or `date_order: month_first`".to_owned(),
                ));
            }
        };
        day_number(year, month, day).ok_or_else(|| {
            (
                line,
                format!("there is no day {day} of month {month}"),
                "correct the date, or `date_order`".to_owned(),
            )
        })
    };
    let day = |(_, line, stamp): &(usize, u64, Stamp)| match stamp.date {
        None => Ok(0),
        Some(Date::Days(days)) => Ok(days),
        Some(Date::Either(numbers, year)) => day_of(*line, numbers, year),
    };
    stamps.iter().map(day).collect()
}

/// Days from 1 March of the year 0 in the Gregorian calendar; absent if there is no such day.
fn day_number(year: i64, month: i64, day: i64) -> Option<i64> {
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let last = match month {
        2 if is_leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        1..=12 => 31,
        _ => return None,
    };
    if !(1..=last).contains(&day) {
        return None;
    }
    let (year, month) = if month > 2 {
        (year, month - 3)
    } else {
        (year - 1, month + 9)
    };
    Some(365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1)
}

/// Why a cell is no date or time, after its content, and the help.
type Why = (&'static str, &'static str);

const NO_STAMP: Why = (
    " is no date or clock time as in the first row",
    "write all times as `2026-11-27 11:56:09.1`, `27.11.2026 11:56:09`, `11:56:09` or in seconds",
);

fn stamp(cell: &str) -> Result<Stamp, Why> {
    if let Some(stored) = cell.strip_prefix(DATE) {
        return match stored.parse::<f64>() {
            // A number of days with the time of day as its fraction, which is exact to about a microsecond.
            Ok(days) if (0.0..4e6).contains(&days) => Ok(Stamp {
                date: (days >= 1.0).then_some(Date::Days(days as i64)),
                seconds: (days.fract() * DAY * 1e5).round() / 1e5,
                ahead: None,
            }),
            Ok(_) => Err(NO_STAMP),
            Err(_) => stamp(stored),
        };
    }
    let cell = cell.trim();
    let end = cell
        .find(|c: char| !(c.is_ascii_digit() || "-/.".contains(c)))
        .unwrap_or(cell.len());
    let (date, rest) = match cell.as_bytes().get(end) {
        // The first number of a clock time.
        Some(b':') => (None, cell),
        _ => (
            Some(date(&cell[..end])?),
            cell[end..].trim_start_matches(['T', 't', '_', ' ', ',']),
        ),
    };
    if rest.is_empty() {
        return Ok(Stamp {
            date,
            seconds: 0.0,
            ahead: None,
        });
    }
    let end = rest
        .find(|c: char| !(c.is_ascii_digit() || ":.,".contains(c)))
        .unwrap_or(rest.len());
    let (clock, zone) = (&rest[..end], rest[end..].trim());
    let parts: Vec<&str> = clock.split(':').collect();
    let whole = |text: &str| match text.len() {
        1..=4 => text.parse::<u32>().ok().map(f64::from),
        _ => None,
    };
    let (hours, minutes, seconds) = match parts[..] {
        [hours, minutes] if date.is_some() => (whole(hours), whole(minutes), Some(0.0)),
        [_, _] => {
            return Err((
                " may be hours and minutes, or minutes and seconds",
                "write times as hh:mm:ss",
            ));
        }
        [hours, minutes, seconds] => {
            let seconds = seconds.replace(',', ".");
            let is_plain = seconds.starts_with(|c: char| c.is_ascii_digit()) && seconds.matches('.').count() < 2;
            (
                whole(hours),
                whole(minutes),
                seconds.parse::<f64>().ok().filter(|_| is_plain),
            )
        }
        _ => return Err(NO_STAMP),
    };
    let (Some(mut hours), Some(minutes), Some(seconds)) = (hours, minutes, seconds) else {
        return Err(NO_STAMP);
    };
    let (half, zone) = match zone.get(..2).map(str::to_ascii_lowercase).as_deref() {
        Some("am") => (Some(0.0), zone[2..].trim()),
        Some("pm") => (Some(12.0), zone[2..].trim()),
        _ => (None, zone),
    };
    if let Some(half) = half {
        if !(1.0..=12.0).contains(&hours) {
            return Err(NO_STAMP);
        }
        hours = hours % 12.0 + half;
    }
    if minutes >= 60.0 || seconds >= 60.0 || (date.is_some() && hours >= 24.0) {
        return Err((" has more than 23 hours, 59 minutes or 60 seconds", "correct the time"));
    }
    Ok(Stamp {
        date,
        seconds: hours * 3600.0 + minutes * 60.0 + seconds,
        ahead: time_zone(zone)?,
    })
}

fn date(text: &str) -> Result<Date, Why> {
    let sign = text.chars().find(|c| !c.is_ascii_digit()).ok_or(NO_STAMP)?;
    let parts: Vec<&str> = text.split(sign).collect();
    let [a, b, c] = parts[..] else { return Err(NO_STAMP) };
    let numbers: Option<Vec<i64>> = [a, b, c]
        .iter()
        .map(|part| part.parse().ok().filter(|_| (1..=4).contains(&part.len())))
        .collect();
    let Some([x, y, z]) = numbers.as_deref() else {
        return Err(NO_STAMP);
    };
    let no_day = (" is no day of the calendar", "correct the date");
    match (a.len(), c.len(), sign) {
        (4, 1 | 2, _) => day_number(*x, *y, *z).map(Date::Days).ok_or(no_day),
        // With points the day is first.
        (1 | 2, 4, '.') => day_number(*z, *y, *x).map(Date::Days).ok_or(no_day),
        (1 | 2, 4, _) if *x > 12 && *y > 12 => Err(no_day),
        (1 | 2, 4, _) => Ok(Date::Either([*x, *y], *z)),
        _ => Err((" has no year of four digits", "write dates as 2026-11-27 or 27.11.2026")),
    }
}

/// Seconds ahead of UTC; absent if no zone is stated.
fn time_zone(zone: &str) -> Result<Option<f64>, Why> {
    if zone.is_empty() {
        return Ok(None);
    }
    if ["z", "utc", "gmt"].contains(&zone.to_ascii_lowercase().as_str()) {
        return Ok(Some(0.0));
    }
    let wrong = (
        " has a time zone that is not read",
        "write zones as `Z` or as a difference such as `+01:00`, or delete them",
    );
    let sign = match zone.as_bytes()[0] {
        b'+' => 1.0,
        b'-' => -1.0,
        _ => return Err(wrong),
    };
    let digits: String = zone[1..].chars().filter(|c| *c != ':').collect();
    if !(digits.len() == 2 || digits.len() == 4) || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return Err(wrong);
    }
    let number = |range: std::ops::Range<usize>| digits.get(range).and_then(|d| d.parse::<f64>().ok()).unwrap_or(0.0);
    let (hours, minutes) = (number(0..2), number(2..4));
    if hours > 14.0 || minutes > 59.0 {
        return Err(wrong);
    }
    Ok(Some(sign * (hours * 3600.0 + minutes * 60.0)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::TableForm;
    use super::super::cells::table;
    use super::*;

    fn times_in(cells: &[&str], order: Option<DateOrder>) -> Result<(Vec<String>, Vec<String>), String> {
        let lines: Vec<String> = cells.iter().map(|cell| format!("{cell};1\n")).collect();
        let text = format!("time;torque [Nm]\n{}", lines.concat());
        let mut notes = Vec::new();
        let mut table = table(text.as_bytes(), &TableForm::default(), &|_| true, &mut notes).unwrap();
        match table.take_times(0, order, &mut notes) {
            Ok(true) => Ok((
                table.rows.into_iter().map(|(_, mut cells)| cells.remove(0)).collect(),
                notes,
            )),
            Ok(false) => Err("none".to_owned()),
            Err(wrong) => Err(format!("{}: {}", wrong.message, wrong.help)),
        }
    }

    fn times(cells: &[&str]) -> Vec<String> {
        times_in(cells, None).unwrap().0
    }

    fn refused(cells: &[&str]) -> String {
        times_in(cells, None).unwrap_err()
    }

    #[test]
    fn dates_and_clocks_are_seconds_from_the_first_row() {
        assert_eq!(
            times(&[
                "2026-11-27 11:56:09.100",
                "2026-11-27T11:56:09.2",
                "2026-11-28 11:56:09,3"
            ]),
            ["0", "0.1", "86400.2"]
        );
        assert_eq!(times(&["28.02.2028 23:59:59", "29.02.2028 00:00:00"]), ["0", "1"]);
        assert_eq!(times(&["1/2/2026 3:59:59 PM", "1/2/2026 4:00:01 PM"]), ["0", "2"]);
        assert_eq!(times(&["12:00:00 AM", "12:00:00 PM"]), ["0", "43200"]);
        assert_eq!(
            times(&["2026-10-25T02:59:59+02:00", "2026-10-25T02:00:00+0100"]),
            ["0", "1"]
        );
        assert_eq!(times(&["2026-11-27T00:00:00Z", "2026-11-27T00:01:00Z"]), ["0", "60"]);
        assert_eq!(times(&["date or time 45990.5", "date or time 45991"]), ["0", "43200"]);
        assert_eq!(times(&["date or time 0.5", "date or time 0.50001"]), ["0", "0.864"]);
    }

    #[test]
    fn a_clock_passes_midnight_and_elapsed_hours_do_not() {
        let (seconds, notes) = times_in(&["23:59:59", "00:00:01", "00:00:02"], None).unwrap();
        assert_eq!(seconds, ["0", "2", "3"]);
        assert!(
            notes.iter().any(|note| note == "the clock passes midnight at line 3"),
            "{notes:?}"
        );
        assert_eq!(times(&["23:00:00", "24:00:00", "1:00:00"]), ["0", "3600", "-79200"]);
        // An hour back is no midnight.
        assert_eq!(times(&["12:00:00", "11:00:00"]), ["0", "-3600"]);
    }

    #[test]
    fn an_order_that_decides_is_stated() {
        let days = ["3/4/2026 10:00", "4/4/2026 10:00"];
        assert!(refused(&days).contains("line 2, column 1 `time`: `3` and `4` may be day and month"));
        assert_eq!(times_in(&days, Some(DateOrder::DayFirst)).unwrap().0, ["0", "86400"]);
        assert_eq!(
            times_in(&days, Some(DateOrder::MonthFirst)).unwrap().0,
            ["0", "2678400"]
        );
        // One of the dates shows it, or all are of one day.
        assert_eq!(times(&["12/1/2026 10:00", "13/1/2026 10:00"]), ["0", "86400"]);
        assert_eq!(times(&["3/4/2026 10:00", "3/4/2026 10:01"]), ["0", "60"]);
    }

    #[test]
    fn what_is_unclear_is_refused() {
        for (cells, told) in [
            (["10:00", "10:01"], "hours and minutes, or minutes and seconds"),
            (
                ["10:00:00", "x"],
                "line 3, column 1 `time`: `x` is no date or clock time",
            ),
            (["27.11.26 10:00:00", "27.11.26 10:00:01"], "no year of four digits"),
            (["2026-02-29 10:00:00", "2026-03-01 10:00:00"], "no day of the calendar"),
            (["2026-02-28 25:00:00", "2026-03-01 10:00:00"], "more than 23 hours"),
            (
                ["2026-02-28 10:00:00 CET", "2026-02-28 10:00:01 CET"],
                "time zone that is not read",
            ),
            (["2026-02-28 10:00:00", "10:00:01"], "unlike line 2"),
            (["10:61:00", "10:00:01"], "59 minutes"),
        ] {
            assert!(refused(&cells).contains(told), "{cells:?}: {}", refused(&cells));
        }
        assert_eq!(refused(&["1.5", "2.5"]), "none");
    }
}
