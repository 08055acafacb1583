//! From bytes to cells: text, workbook or MDF file, their header and units.

use super::encoding::decoded;
use super::form::{Decimal, Kind, Separator, TableForm};
use super::header::{self, IsName, MOST_LINES};
use super::numbers::{self, NumberStyle};
use super::{MeasuredFault, fault, foreign, mdf, workbook};
use crate::Unit;

pub use super::header::name_and_unit;
pub use super::table::{FoundColumn, Table, number};

/// Most columns of a text, as of a sheet.
const MOST_COLUMNS: usize = 16_384;
/// Most cells of a text.
const MOST_CELLS: usize = 20_000_000;

/// Reads the cells of a file and notes the detected format. The content decides what it is: a workbook, an MDF file, or else a text.
/// `is_name` knows the names of columns that are looked for, by which the header is found.
///
/// # Errors
/// The first error with its line.
pub fn table(
    bytes: &[u8],
    form: &TableForm,
    is_name: IsName<'_>,
    notes: &mut Vec<String>,
) -> Result<Table, MeasuredFault> {
    if let Some(wrong) = foreign::recognise(bytes) {
        return Err(wrong);
    }
    if workbook::is_workbook(bytes) {
        form.check(Kind::Workbook)?;
        of_workbook(bytes, form, is_name, notes)
    } else if mdf::is_mdf(bytes) {
        form.check(Kind::Mdf)?;
        let mut table = mdf::table(bytes, form.group.as_deref(), notes)?;
        header::keep_stated_lines(&mut table.rows, form);
        Ok(table)
    } else {
        form.check(Kind::Text)?;
        of_text(bytes, form, is_name, notes)
    }
}

/// The cells of a sheet. Rows that begin with `#` are comments, as in texts.
fn of_workbook(
    bytes: &[u8],
    form: &TableForm,
    is_name: IsName<'_>,
    notes: &mut Vec<String>,
) -> Result<Table, MeasuredFault> {
    // Of numbers that are stored as texts; others have a point in any language of the spreadsheet.
    let style = (form.decimal.is_some() || form.thousands.is_some()).then(|| NumberStyle {
        decimal: form.decimal.unwrap_or(match form.thousands {
            Some(super::Thousands::Point) => Decimal::Comma,
            _ => Decimal::Point,
        }),
        thousands: form.thousands,
    });
    let sheet = workbook::sheet(bytes, form.sheet.as_deref(), style, notes)?;
    let part = format!("sheet `{}`", sheet.name);
    let mut rows = sheet.rows;
    rows.retain(|(_, cells)| {
        !cells
            .iter()
            .find(|cell| !cell.is_empty())
            .is_some_and(|cell| cell.starts_with('#'))
    });
    let in_part = |wrong: MeasuredFault| MeasuredFault {
        message: format!("{part}: {}", wrong.message),
        ..wrong
    };
    let read = || {
        let place = match form.header_line {
            Some(line) => rows
                .iter()
                .position(|(row, _)| *row == line)
                .ok_or_else(|| no_header(line))?,
            None => header::find(&rows[..rows.len().min(MOST_LINES)], is_name)?,
        };
        if place > 0 && form.header_line.is_none() {
            notes.push(format!("header in row {}", rows[place].0));
        }
        rows.drain(..place);
        headed(rows, form, notes, "delete it, or give its column a header")
    };
    Ok(Table {
        part: Some(part.clone()),
        ..read().map_err(in_part)?
    })
}

fn no_header(line: u64) -> MeasuredFault {
    MeasuredFault::new(
        "header_line",
        format!("line {line} is empty, a comment or not in the file"),
        "state the line that has the names of the columns, counted from 1 on",
    )
}

/// A line of a text that is neither empty nor a comment.
struct Line<'a> {
    number: u64,
    /// Its first byte, and the first one after it.
    begin: usize,
    end: usize,
    text: &'a str,
}

fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut end = 0;
    (1..).zip(text.split_inclusive('\n')).map(move |(number, line)| {
        let begin = end;
        end += line.len();
        Line {
            number,
            begin,
            end,
            text: line.trim_end_matches(['\n', '\r']),
        }
    })
}

fn is_comment(line: &Line<'_>) -> bool {
    line.text.starts_with('#')
}

/// The separator of a header; a semicolon or tabulator has priority over commas, which may be decimal.
fn separator(header: &str, below: &[Line<'_>]) -> Separator {
    if header.contains(';') {
        Separator::Semicolon
    } else if header.contains('\t') {
        Separator::Tab
    } else if !header.contains(',') && is_separated_by_blanks(header, below) {
        Separator::Blank
    } else {
        Separator::Comma
    }
}

/// True if the lines below a header without separators are numbers between blanks, one for each of its names.
fn is_separated_by_blanks(header: &str, below: &[Line<'_>]) -> bool {
    let columns = between_blanks(header).len();
    let is_number = |cell: &str| cell.replace(',', ".").parse::<f64>().is_ok();
    let fits = |line: &Line<'_>| {
        let cells = between_blanks(line.text);
        cells.len() == columns && cells.iter().all(|cell| is_number(cell))
    };
    // The first of them may be a row of units.
    let has_units = below.first().is_some_and(|line| {
        let cells = between_blanks(line.text);
        cells.len() == columns && !cells.iter().any(|cell| is_number(cell) && cell != "1")
    });
    let below = &below[usize::from(has_units)..];
    columns > 1 && !below.is_empty() && below.iter().take(10).all(fits)
}

/// The cells of a line between blanks. Quotes hold a cell together, and brackets belong to the name before them. A `#` begins a comment.
fn between_blanks(line: &str) -> Vec<String> {
    let mut cells: Vec<String> = Vec::new();
    let mut rest = line.trim();
    while !rest.is_empty() && !rest.starts_with('#') {
        let quoted = rest.strip_prefix('"').and_then(|rest| rest.split_once('"'));
        let (cell, after) = quoted.unwrap_or_else(|| rest.split_once(char::is_whitespace).unwrap_or((rest, "")));
        let in_bracket = cells.last().is_some_and(|last| {
            [('[', ']'), ('(', ')')]
                .iter()
                .any(|(open, close)| last.contains(*open) && !last.contains(*close))
        });
        match cells.last_mut() {
            Some(last)
                if quoted.is_none() && (in_bracket || cell.starts_with(['[', '('])) && last.parse::<f64>().is_err() =>
            {
                last.push(' ');
                last.push_str(cell);
            }
            _ => cells.push(cell.to_owned()),
        }
        rest = after.trim_start();
    }
    cells
}

/// The cells of a single line, to find the header by its names.
fn split(line: &str, separator: Separator) -> Vec<String> {
    let sign = match separator {
        Separator::Blank => return between_blanks(line),
        Separator::Comma => ',',
        Separator::Semicolon => ';',
        Separator::Tab => '\t',
    };
    let mut in_quotes = false;
    let cells = line.split(|c: char| {
        in_quotes ^= c == '"';
        c == sign && !in_quotes
    });
    cells
        .map(|cell| cell.trim().trim_matches('"').trim().to_owned())
        .collect()
}

/// Where the header of a text is, its separator, and whether nothing but comments is before it.
fn locate<'a>(
    text: &'a str,
    form: &TableForm,
    is_name: IsName<'_>,
) -> Result<(Line<'a>, Separator, bool), MeasuredFault> {
    let mut found: Vec<Line<'a>> = lines(text)
        .filter(|line| !is_comment(line) && !line.text.trim().is_empty())
        .take(MOST_LINES)
        .collect();
    let stated = found.first().and_then(|line| header::stated_separator(line.text));
    if stated.is_some() {
        found.remove(0);
    }
    let stated = form.separator.or(stated);
    if let Some(number) = form.header_line {
        let mut rest = lines(text).skip_while(|line| line.number < number);
        let line = rest.next().filter(|line| !line.text.trim().is_empty());
        let line = line.ok_or_else(|| no_header(number))?;
        let below: Vec<Line<'_>> = rest.filter(|line| !line.text.trim().is_empty()).take(12).collect();
        let separator = stated.unwrap_or_else(|| separator(line.text.trim_start_matches('#'), &below));
        return Ok((line, separator, false));
    }
    if found.is_empty() {
        return Err(fault("the file is empty", "choose another file"));
    }
    let separators: Vec<Separator> = (0..found.len())
        .map(|i| stated.unwrap_or_else(|| separator(found[i].text, &found[i + 1..])))
        .collect();
    let cells: Vec<(u64, Vec<String>)> = found
        .iter()
        .zip(&separators)
        .map(|(line, separator)| (line.number, split(line.text, *separator)))
        .collect();
    let place = header::find(&cells, is_name)?;
    Ok((found.swap_remove(place), separators[place], place == 0))
}

/// Line of a record; its position includes the comments and empty lines before it.
fn line_of(text: &str, at: &csv::Position) -> u64 {
    let rest = usize::try_from(at.byte()).ok().and_then(|byte| text.get(byte..));
    let skipped = rest.unwrap_or_default().lines();
    at.line()
        + skipped
            .take_while(|line| line.is_empty() || line.starts_with('#'))
            .count() as u64
}

fn of_text(
    bytes: &[u8],
    form: &TableForm,
    is_name: IsName<'_>,
    notes: &mut Vec<String>,
) -> Result<Table, MeasuredFault> {
    let text = decoded(bytes, form.encoding, notes)?;
    let (head, separator, is_first) = locate(&text, form, is_name)?;
    if !is_first && form.header_line.is_none() {
        notes.push(format!("header in line {}", head.number));
    }
    if let Some(last) = form.last_line.filter(|last| *last <= head.number) {
        let message = format!("`last_line: {last}` is not after the header in line {}", head.number);
        return Err(MeasuredFault::new(
            "last_line",
            message,
            "count the lines from 1 on, comments included",
        ));
    }
    let sign = match separator {
        Separator::Comma => b',',
        Separator::Semicolon => b';',
        Separator::Tab => b'\t',
        Separator::Blank => b' ',
    };
    match separator {
        Separator::Comma => {}
        Separator::Blank => notes.push("cells separated by blanks".to_owned()),
        _ => notes.push(format!("cells separated by `{}`", char::from(sign).escape_default())),
    }
    // Before a line is divided: each cell takes more memory than its sign.
    let is_long =
        |line: &str| line.len() > MOST_COLUMNS && line.bytes().filter(|byte| *byte == sign).count() >= MOST_COLUMNS;
    if let Some((number, _)) = (1_u64..).zip(text.lines()).find(|(_, line)| is_long(line)) {
        return Err(fault(
            format!("line {number}: more than {MOST_COLUMNS} cells"),
            "export the columns that are used",
        ));
    }
    let mut rows: Vec<(u64, Vec<String>)> = Vec::new();
    let is_commented = is_comment(&head);
    let from = if is_commented {
        rows.push((head.number, split(head.text.trim_start_matches('#'), separator)));
        head.end
    } else {
        head.begin
    };
    let line_of_first = if is_commented { head.number + 1 } else { head.number };
    let body = &text[from..];
    let mut filled = 0;
    let mut push = |line: u64, cells: Vec<String>| {
        filled += cells.len();
        rows.push((line, cells));
        if filled > MOST_CELLS {
            return Err(fault(
                format!("line {line}: the file has more than {MOST_CELLS} cells"),
                "export the columns that are used, or read a part by `last_line`",
            ));
        }
        Ok(())
    };
    if separator == Separator::Blank {
        for line in lines(body).filter(|line| !is_comment(line) && !line.text.trim().is_empty()) {
            push(line_of_first + line.number - 1, between_blanks(line.text))?;
        }
    } else {
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(sign)
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .has_headers(false)
            .flexible(true)
            .from_reader(body.as_bytes());
        let mut record = csv::StringRecord::new();
        loop {
            let more = reader.read_record(&mut record);
            if !more.map_err(|e| fault(e.to_string(), "check quotes and separators"))? {
                break;
            }
            let line = record.position().map_or(0, |at| line_of(body, at)) + line_of_first - 1;
            if form.last_line.is_some_and(|last| line > last) {
                break;
            }
            if !record.iter().all(str::is_empty) {
                push(line, record.iter().map(str::to_owned).collect())?;
            }
        }
    }
    if text.contains(" #") || text.contains("\t#") || text.contains(",#") || text.contains(";#") {
        cut_comments(&mut rows);
    }
    let help = "if a decimal comma splits numbers, state `separator` or quote such cells";
    let headed = headed(rows, form, notes, help)?;
    Ok(Table {
        numbers: numbers::style(&headed.rows, (form, separator), notes)?,
        ..headed
    })
}

/// Removes comments after cells: what follows a `#` after a number or unit, or after the last cell.
fn cut_comments(rows: &mut [(u64, Vec<String>)]) {
    let Some(((_, header), rest)) = rows.split_first_mut() else {
        return;
    };
    let mark = |cell: &str| cell.find(" #").or_else(|| cell.find("\t#"));
    let width = header.len();
    for (_, cells) in rest.iter_mut() {
        cut_comment(cells, width);
    }
    // A `#` in a name, as in `Point #,torque [Nm]`, is no comment if the rows below go on behind it.
    let begin = header
        .iter()
        .position(|cell| mark(cell).is_some() || cell.starts_with("# "));
    if let Some(place) = begin {
        let before = mark(&header[place]).map(|at| header[place][..at].trim().to_owned());
        let width = place + usize::from(before.is_some());
        if width > 0 && rest.first().is_some_and(|(_, cells)| cells.len() <= width) {
            header.truncate(width);
            if let Some(before) = before {
                header[place] = before;
            }
        }
    }
    let width = header.len();
    for (_, cells) in rest {
        cut_comment(cells, width);
    }
}

fn cut_comment(cells: &mut Vec<String>, width: usize) {
    let is_number = |cell: &str| cell.is_empty() || cell.replace(',', ".").parse::<f64>().is_ok();
    let is_unit = |cell: &str| Unit::read(cell.trim_matches(['[', ']', '(', ')'])).is_some();
    for place in 0..cells.len() {
        let cell = &cells[place];
        if place > 0 && cell.starts_with('#') && (place >= width || cell.starts_with("# ")) {
            cells.truncate(place);
            return;
        }
        if let Some(at) = cell.find(" #").or_else(|| cell.find("\t#")) {
            let before = cell[..at].trim();
            if is_number(before) || (place + 1 >= width && is_unit(before)) {
                cells[place] = before.to_owned();
                cells.truncate(place + 1);
                return;
            }
        }
    }
}

/// Takes the header and a row of units from the rows. `too_long` is the help for a row with more cells than the header.
fn headed(
    mut rows: Vec<(u64, Vec<String>)>,
    form: &TableForm,
    notes: &mut Vec<String>,
    too_long: &str,
) -> Result<Table, MeasuredFault> {
    if rows.is_empty() {
        return Err(fault("the file is empty", "choose another file"));
    }
    let (header_line, header) = rows.remove(0);
    let (names, mut units): (Vec<String>, Vec<Option<String>>) = header.iter().map(|h| name_and_unit(h)).unzip();
    let mut unit_lines = vec![header_line; names.len()];
    header::take_units(&mut rows, (&mut units, &mut unit_lines), notes);
    header::keep_stated_lines(&mut rows, form);
    for (line, cells) in &rows {
        if cells.len() > names.len() {
            return Err(fault(
                format!("line {line}: {} cells, but the header has {}", cells.len(), names.len()),
                too_long,
            ));
        }
    }
    Ok(Table {
        part: None,
        unread: Vec::new(),
        numbers: NumberStyle::PLAIN,
        repeated: repeated(&rows, &header),
        names,
        units,
        unit_lines,
        header_line,
        rows,
    })
}

/// The line that repeats the header, and the last line of numbers before it.
fn repeated(rows: &[(u64, Vec<String>)], header: &[String]) -> Option<(u64, u64)> {
    let place = rows
        .iter()
        .position(|(_, cells)| cells.first() == header.first() && *cells == header)?;
    let is_number = |cell: &&String| cell.replace(',', ".").parse::<f64>().is_ok();
    let numbers = |cells: &[String]| cells.iter().filter(is_number).count();
    let most = rows[..place].iter().map(|(_, cells)| numbers(cells)).max().unwrap_or(0);
    let last = rows[..place]
        .iter()
        .rfind(|(_, cells)| numbers(cells) == most && most > 0);
    Some((rows[place].0, last.map_or(rows[place].0 - 1, |(line, _)| *line)))
}
