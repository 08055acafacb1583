//! A maker's table of bearings as a catalogue for gearbox files.
//!
//! Columns are found by their headings, numbers by the way in which the whole file is written. Nothing is guessed: a unit that is
//! stated nowhere and a sign that may separate decimals or thousands are errors.

mod derived;
mod headings;
mod kind;
mod numbers;
mod plausible;

use std::collections::BTreeMap;

use gearloss_document::data::cells::{self, Table};
use gearloss_document::data::{Decimal, TableForm, without_brackets};
use gearloss_document::{Diagnostic, Unit, did_you_mean};
use gearloss_framework::resolve::CatalogueTable;

use crate::codes;
use headings::{KEYS, Key};
use numbers::{Cell, Style};

/// Most findings that are listed.
const MOST_FINDINGS: usize = 20;

/// How a table is read.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Columns by key: `c=Dyn. load rating [kN]`.
    pub columns: Vec<String>,
    /// Kind of all bearings, if no column has it.
    pub kind: Option<String>,
    /// How the table is written.
    pub form: TableForm,
}

/// A catalogue with the report of its import.
#[derive(Debug)]
pub struct Catalogue {
    /// The text of the catalogue, CSV.
    pub text: String,
    /// Number of its bearings.
    pub rows: usize,
    /// What was taken, what is missing.
    pub report: Vec<String>,
    /// Rows that were omitted and values that are implausible.
    pub warnings: Vec<Diagnostic>,
}

/// A column that is used.
struct Used {
    key: &'static Key,
    place: usize,
    header: String,
    /// Factor to the unit of the catalogue.
    factor: f64,
}

/// Reads a table. `name` is that of the file in messages, `shipped` is the catalogue that the sizes of known
/// designations are compared with.
///
/// # Errors
/// All columns without a unit, unknown keys, and cells that are no numbers.
pub fn import(
    bytes: &[u8],
    name: &str,
    options: &Options,
    shipped: Option<&CatalogueTable>,
) -> Result<Catalogue, Vec<Diagnostic>> {
    if let Some(wrong) = options
        .kind
        .as_deref()
        .filter(|stated| kind::all().all(|kind| kind != *stated))
    {
        let help = did_you_mean(wrong, kind::all()).map_or_else(
            || kind::all().collect::<Vec<_>>().join(", "),
            |close| format!("write `{close}`"),
        );
        return Err(vec![error(format!("--kind `{wrong}` is no kind of bearing"), &help)]);
    }
    let form = TableForm {
        // The sign is found below, together with that of thousands; in a workbook it is a point.
        decimal: Some(Decimal::Point),
        ..options.form.clone()
    };
    let mut notes = Vec::new();
    let stated = |header: &str| options.columns.iter().any(|text| text.contains(header));
    let is_name = |header: &str| headings::key(header).is_some() || stated(header);
    let mut table = cells::table(bytes, &form, &is_name, &mut notes)
        .map_err(|wrong| vec![error(format!("{name}: {}", wrong.message), &wrong.help)])?;
    take_units(&mut table);
    let name = &table.named(name);
    let (used, unused) = columns(&table, name, options)?;
    let style = style(&table, &used, name, options)?;
    let mut warnings = Vec::new();
    let rows = read_rows(&table, &used, style, name, options, &mut warnings)?;
    let mut rows = without_repeated(rows, name, &mut warnings);
    for row in &mut rows {
        derived::complete(row);
        plausible::check(row, name, shipped, &mut warnings);
    }
    let rows: Vec<Row> = rows.into_iter().filter(plausible::can_be_built).collect();
    if rows.is_empty() {
        let mut found = vec![error(
            format!("{name}: no row has a designation, a bore and a larger outside diameter"),
            "check the headings; `--columns \"bore=HEADER [mm]\"` assigns them",
        )];
        found.append(&mut warnings);
        return Err(limited(found));
    }
    let mut report = notes;
    if style.thousands.is_some() || style.decimal == ',' {
        report.push(style.words());
    }
    report.extend(report_columns(&used, &unused, &rows, options));
    Ok(Catalogue {
        text: written(&rows, &used, name),
        rows: rows.len(),
        report,
        warnings: limited(warnings),
    })
}

/// A bearing: its line, texts and numbers by key.
struct Row {
    line: u64,
    designation: String,
    kind: Option<String>,
    /// Keys that the table does not state, with what they were derived from.
    derived: BTreeMap<&'static str, &'static str>,
    texts: BTreeMap<&'static str, String>,
    numbers: BTreeMap<&'static str, f64>,
}

impl Row {
    fn number(&self, key: &str) -> Option<f64> {
        self.numbers.get(key).copied()
    }
}

fn error(message: impl Into<String>, help: &str) -> Diagnostic {
    Diagnostic::error("", message).code(codes::BEARING_TABLE).help(help)
}

fn limited(mut found: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let more = found.len().saturating_sub(MOST_FINDINGS);
    found.truncate(MOST_FINDINGS);
    if let (1.., Some(last)) = (more, found.last_mut()) {
        last.notes.push(format!("and {more} more findings"));
    }
    found
}

/// Takes a row of units with the spellings of makers, and units behind a heading without brackets.
fn take_units(table: &mut Table) {
    for (name, unit) in table.names.iter_mut().zip(&mut table.units) {
        if unit.is_none()
            && let Some((head, last)) = name.rsplit_once(' ')
            && let Some(key) = headings::key(head.trim_end_matches(','))
            && let (Some(unit_of_key), Some(found)) = (Unit::of_symbol(key.unit), headings::unit(last))
            // `C` of a load rating is no unit of a load.
            && found.dimension == unit_of_key.dimension
        {
            let (head, last) = (head.trim_end_matches(',').trim().to_owned(), last.to_owned());
            (*name, *unit) = (head, Some(last));
        }
    }
    let is_unit = |cell: &String| cell.is_empty() || headings::unit(cell).is_some() || cell == "-";
    let first = table.rows.first();
    if !first.is_some_and(|(_, cells)| {
        cells.iter().all(is_unit) && cells.iter().any(|cell| cell != "-" && headings::unit(cell).is_some())
    }) {
        return;
    }
    let (_, cells) = table.rows.remove(0);
    for (unit, cell) in table.units.iter_mut().zip(cells) {
        if !cell.is_empty() && cell != "-" {
            *unit = Some(cell);
        }
    }
}

/// The columns of keys, and the headings that are not used.
fn columns(table: &Table, name: &str, options: &Options) -> Result<(Vec<Used>, Vec<String>), Vec<Diagnostic>> {
    let mut found = Vec::new();
    let mut stated: BTreeMap<usize, (&'static Key, Option<String>)> = BTreeMap::new();
    for text in &options.columns {
        match stated_column(text, table) {
            Ok((place, key, unit)) => {
                stated.insert(place, (key, unit));
            }
            Err((message, help)) => found.push(error(message, &help)),
        }
    }
    let mut used: Vec<Used> = Vec::new();
    let mut unused = Vec::new();
    for (place, header) in table.names.iter().enumerate() {
        let by_heading = || {
            let key = headings::key(header)?;
            // A column that the user assigns to the key has precedence.
            (!stated.values().any(|(known, _)| known.name == key.name)).then_some((key, None))
        };
        let Some((key, unit)) = stated.get(&place).cloned().or_else(by_heading) else {
            unused.push(header.clone());
            continue;
        };
        // `C [mm]` of a tapered roller bearing is the width of its outer ring if another column is `C [kN]`.
        if !stated.contains_key(&place) && is_another_quantity(key, place, table) {
            let unit = table.units[place].as_deref().unwrap_or_default();
            unused.push(format!("{header} [{unit}]"));
            continue;
        }
        // Total width or height of a bearing instead of that of a ring: both are read.
        if used
            .iter()
            .any(|other| other.key.name == key.name && other.key.total == key.total)
        {
            unused.push(format!("{header} (a second column of `{}`)", key.name));
            continue;
        }
        let of_file = table.units[place].as_deref();
        if let (Some(option), Some(of_file)) = (&unit, of_file)
            && let (Some(a), Some(b)) = (Unit::read(option), Unit::read(without_brackets(of_file)))
            && a != b
        {
            let message = format!(
                "column `{header}` is in `{of_file}` according to the file, in `{option}` according to --columns"
            );
            let help = format!("write `--columns \"{}={header}\"`, or correct the file", key.name);
            found.push(error(format!("{name}: {}{message}", table.at_header()), &help));
            continue;
        }
        let unit = unit.or_else(|| of_file.map(str::to_owned));
        match factor(key, unit.as_deref(), header) {
            Ok(factor) => used.push(Used {
                key,
                place,
                header: header.clone(),
                factor,
            }),
            Err((message, help)) => found.push(error(format!("{name}: {}{message}", table.at_header()), &help)),
        }
    }
    for needed in ["designation", "bore", "outside"] {
        let is_there = used.iter().any(|column| column.key.name == needed);
        if !is_there && !found.iter().any(|fault| fault.message.contains(needed)) {
            found.push(error(
                format!(
                    "{name}: {}no heading is known as `{needed}`; there are: {}",
                    table.at_header(),
                    table.names.join(", ")
                ),
                &format!("assign one: `--columns \"{needed}=HEADING\"`"),
            ));
        }
    }
    if found.is_empty() {
        Ok((used, unused))
    } else {
        Err(limited(found))
    }
}

/// Whether the unit of a column is not one of its key, but that of another column of the same key is.
fn is_another_quantity(key: &Key, place: usize, table: &Table) -> bool {
    let fits = |place: usize| {
        let unit = table.units[place].as_deref().and_then(headings::unit);
        let due = Unit::of_symbol(key.unit);
        unit.zip(due).map(|(unit, due)| unit.dimension == due.dimension)
    };
    let mut others = (0..table.names.len()).filter(|other| *other != place);
    fits(place) == Some(false)
        && others.any(|other| {
            let of_key = headings::key(&table.names[other]).is_some_and(|known| known.name == key.name);
            of_key && fits(other) == Some(true)
        })
}

/// Place, key and unit of a column that an option states.
fn stated_column(text: &str, table: &Table) -> Result<(usize, &'static Key, Option<String>), (String, String)> {
    let Some((key, header)) = text.split_once('=') else {
        let help = "write KEY=HEADING, such as `--columns \"c=Dyn. load rating [kN]\"`";
        return Err((format!("--columns `{text}` has no `=`"), help.to_owned()));
    };
    let key = key.trim();
    let of_key = KEYS
        .iter()
        .find(|known| known.name == key && !known.total)
        .or_else(|| headings::key(key));
    let Some(of_key) = of_key else {
        let names: Vec<&str> = KEYS.iter().filter(|key| !key.total).map(|key| key.name).collect();
        let help = did_you_mean(key, names.iter().copied()).map_or_else(
            || format!("keys are {}", names.join(", ")),
            |close| format!("write `{close}`"),
        );
        return Err((format!("--columns: `{key}` is no key of a catalogue"), help));
    };
    let (header, unit) = cells::name_and_unit(header);
    let place = table.names.iter().position(|name| *name == header);
    let place = place.ok_or_else(|| {
        let close = did_you_mean(&header, table.names.iter().map(String::as_str));
        let help = close.map_or("choose one of them".to_owned(), |close| {
            format!("write `{key}={close}`")
        });
        (format!("--columns: {}", table.lacks(&header)), help)
    })?;
    Ok((place, of_key, unit))
}

/// Factor of a column to the unit of its key.
fn factor(key: &Key, unit: Option<&str>, header: &str) -> Result<f64, (String, String)> {
    if key.unit.is_empty() || key.unit == "-" {
        return Ok(1.0);
    }
    let Some(symbol) = unit else {
        return Err((
            format!("column `{header}` ({}) has no unit", key.name),
            format!(
                "state the unit that it has, such as `--columns \"{}={header} [{}]\"`",
                key.name, key.unit
            ),
        ));
    };
    let due = Unit::of_symbol(key.unit).unwrap_or(Unit::ONE);
    match Unit::read_as(without_brackets(symbol), due.dimension) {
        Ok(unit) => Ok(unit.factor / due.factor),
        Err(wrong) => Err((
            format!("column `{header}` ({}): {}", key.name, wrong.message),
            format!(
                "{}: state it by `--columns \"{}={header} [UNIT]\"`",
                wrong.help, key.name
            ),
        )),
    }
}

/// The signs of decimals and thousands of the file.
fn style(table: &Table, used: &[Used], name: &str, options: &Options) -> Result<Style, Vec<Diagnostic>> {
    let numeric: Vec<&Used> = used.iter().filter(|column| !column.key.unit.is_empty()).collect();
    let cells = table.rows.iter().flat_map(|(line, cells)| {
        numeric
            .iter()
            .filter_map(move |column| Some((*line, cells.get(column.place)?.as_str())))
    });
    Style::of_cells(cells, options.form.decimal).map_err(|message| {
        vec![error(
            format!("{name}: {message}"),
            "state the decimal sign: `--decimal comma` or `--decimal point`",
        )]
    })
}

fn read_rows(
    table: &Table,
    used: &[Used],
    style: Style,
    name: &str,
    options: &Options,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<Row>, Vec<Diagnostic>> {
    let mut found = Vec::new();
    let mut rows = Vec::new();
    let mut without = Vec::new();
    for (line, cells) in &table.rows {
        let mut row = Row {
            line: *line,
            designation: String::new(),
            kind: None,
            derived: BTreeMap::new(),
            texts: BTreeMap::new(),
            numbers: BTreeMap::new(),
        };
        let mut written = None;
        for column in used {
            let cell = cells.get(column.place).map_or("", String::as_str);
            let at = || format!("{name}: line {line}, column {} `{}`", column.place + 1, column.header);
            match column.key.name {
                "designation" => row.designation = cell.split_whitespace().collect::<Vec<_>>().join(" "),
                "kind" if !cell.is_empty() => written = Some((cell, at())),
                _ if column.key.unit.is_empty() => {
                    if !cell.is_empty() {
                        row.texts.insert(column.key.name, cell.to_owned());
                    }
                }
                key => match style.number(cell) {
                    Cell::Blank => {}
                    // The total width has precedence, in either order of the columns.
                    Cell::Number(_)
                        if !column.key.total
                            && used.iter().any(|other| other.key.total && other.key.name == key)
                            && row.numbers.contains_key(key) => {}
                    Cell::Number(number) => {
                        row.numbers.insert(key, numbers::rounded(number * column.factor));
                    }
                    Cell::Wrong => found.push(error(
                        format!("{}: `{cell}` is not a number", at()),
                        "correct the cell, or leave it blank",
                    )),
                },
            }
        }
        if row.designation.is_empty() {
            without.push(line.to_string());
            continue;
        }
        match written.map(|(cell, at)| (kind::from_words(cell), cell, at)) {
            Some((Some(kind), ..)) => row.kind = Some(kind.to_owned()),
            Some((None, cell, at)) => found.push(error(
                format!("{at}: `{cell}` is no known kind of bearing"),
                "write a kind of a gearbox file, such as deep_groove_ball; or state `--kind` and delete the column",
            )),
            None => row.kind.clone_from(&options.kind),
        }
        rows.push(row);
    }
    if !without.is_empty() {
        let lines = without.iter().take(8).cloned().collect::<Vec<_>>().join(", ");
        warnings.push(warning(
            format!(
                "{name}: {} rows without a designation are omitted: lines {lines}",
                without.len()
            ),
            "complete the designation if they are bearings",
        ));
    }
    if found.is_empty() {
        Ok(rows)
    } else {
        Err(limited(found))
    }
}

fn warning(message: String, help: &str) -> Diagnostic {
    Diagnostic::warning("", message)
        .code(codes::BEARING_IMPLAUSIBLE)
        .help(help)
}

/// The first row of each designation.
fn without_repeated(rows: Vec<Row>, name: &str, warnings: &mut Vec<Diagnostic>) -> Vec<Row> {
    let mut lines: BTreeMap<String, u64> = BTreeMap::new();
    let mut kept = Vec::new();
    for row in rows {
        if let Some(first) = lines.get(&row.designation) {
            warnings.push(warning(
                format!(
                    "{name}: line {}: `{}` is already in line {first}; this row is omitted",
                    row.line, row.designation
                ),
                "give each bearing a designation of its own",
            ));
        } else {
            lines.insert(row.designation.clone(), row.line);
            kept.push(row);
        }
    }
    kept
}

/// What was taken, what is not used, and what is missing for which purpose.
fn report_columns(used: &[Used], unused: &[String], rows: &[Row], options: &Options) -> Vec<String> {
    let mut lines = vec!["Taken:".to_owned()];
    let has = |row: &&Row, key: &str| match key {
        "designation" => true,
        "kind" => row.kind.is_some() && !row.derived.contains_key(key),
        _ => !row.derived.contains_key(key) && (row.numbers.contains_key(key) || row.texts.contains_key(key)),
    };
    for column in used {
        let count = rows.iter().filter(|row| has(row, column.key.name)).count();
        let unit = if column.key.unit.is_empty() {
            String::new()
        } else {
            format!(" [{}]", column.key.unit)
        };
        lines.push(format!(
            "- {}{unit} from `{}`: {count} of {} bearings",
            column.key.name,
            column.header,
            rows.len()
        ));
    }
    if let Some(kind) = options
        .kind
        .as_ref()
        .filter(|_| !used.iter().any(|column| column.key.name == "kind"))
    {
        lines.push(format!("- kind: {kind} for all, as stated"));
    }
    let mut derived: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for (key, from) in rows.iter().flat_map(|row| &row.derived) {
        *derived.entry((key, from)).or_default() += 1;
    }
    for ((key, from), count) in derived {
        lines.push(format!("- {key} from {from}: {count} of {} bearings", rows.len()));
    }
    if !unused.is_empty() {
        lines.push(format!("Not used: {}", unused.join(", ")));
    }
    let mut missing = Vec::new();
    let unknown: Vec<&str> = rows
        .iter()
        .filter(|row| row.kind.is_none())
        .map(|row| row.designation.as_str())
        .collect();
    if !unknown.is_empty() {
        let names = unknown.iter().take(8).copied().collect::<Vec<_>>().join(", ");
        let more = if unknown.len() > 8 { ", ..." } else { "" };
        missing.push(format!(
            "- kind of {} bearings ({names}{more}): state `--kind`, a column, or `kind` in the gearbox",
            unknown.len()
        ));
    }
    for key in KEYS.iter().filter(|key| !key.purpose.is_empty()) {
        let count = rows.iter().filter(|row| !row.numbers.contains_key(key.name)).count();
        if count > 0 {
            missing.push(format!("- {} of {count} bearings: {}", key.name, key.purpose));
        }
    }
    if !missing.is_empty() {
        lines.push("Missing:".to_owned());
        lines.extend(missing);
    }
    lines
}

/// Columns that are last in a catalogue: how far a row is trusted and where it is from.
const ORIGIN: [&str; 2] = ["confidence", "basis"];

/// The catalogue as CSV in the units of the shipped one.
fn written(rows: &[Row], used: &[Used], name: &str) -> String {
    let has = |key: &str| used.iter().any(|column| column.key.name == key);
    let derived = |key: &str| rows.iter().any(|row| row.derived.contains_key(key));
    let keys: Vec<&Key> = KEYS
        .iter()
        .filter(|key| !key.total && !ORIGIN.contains(&key.name))
        .filter(|key| {
            has(key.name) || derived(key.name) || (key.name == "kind" && rows.iter().any(|row| row.kind.is_some()))
        })
        .collect();
    let heading = |key: &&Key| {
        if key.unit.is_empty() {
            key.name.to_owned()
        } else {
            format!("{} [{}]", key.name, key.unit)
        }
    };
    let mut lines = vec![
        format!("# Imported from {name}"),
        keys.iter()
            .map(heading)
            .chain(ORIGIN.map(str::to_owned))
            .collect::<Vec<_>>()
            .join(","),
    ];
    for row in rows {
        let cell = |key: &&Key| match key.name {
            "designation" => row.designation.clone(),
            "kind" => row.kind.clone().unwrap_or_default(),
            key => match row.number(key) {
                Some(number) => number.to_string(),
                None => row.texts.get(key).cloned().unwrap_or_default(),
            },
        };
        let cells = keys.iter().map(cell).chain([
            row.texts
                .get("confidence")
                .cloned()
                .unwrap_or_else(|| "medium".to_owned()),
            row.texts
                .get("basis")
                .cloned()
                .unwrap_or_else(|| format!("{name}, line {}", row.line)),
        ]);
        lines.push(cells.map(quoted).collect::<Vec<_>>().join(","));
    }
    lines.join("\n") + "\n"
}

/// A cell, in quotes if it contains a sign of the format.
fn quoted(cell: String) -> String {
    if cell.contains([',', '"', '\n', '\r']) || cell.starts_with('#') {
        return format!("\"{}\"", cell.replace('"', "\"\""));
    }
    cell
}

#[cfg(test)]
mod tests;
