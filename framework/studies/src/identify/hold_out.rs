//! Held-out rows, and groups of rows for cross-validation.

use crate::codes;
use crate::measured::{Condition, Measured, Row};
use crate::study::{FoldsBy, FoldsEntry, HoldOutEntry, HoldOutRows};
use gearloss_framework::document::expression::ExpressionFault;
use gearloss_framework::document::{Diagnostic, did_you_mean};
use gearloss_numerics::inference::{Fold, folds, labelled_folds, random_folds};
use gearloss_numerics::sampling::Generator;

use super::Identification;

/// Cell texts for held-out rows, and for the others; lower case.
const HELD: [&str; 4] = ["1", "true", "yes", "x"];
const FITTED: [&str; 4] = ["", "0", "false", "no"];
/// Maximum number of groups by the texts of a column.
const GROUPS: usize = 20;
/// Default number of groups.
const COUNT: usize = 5;

/// Fitted and held-out rows of a measurement, each as a separate measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldOut {
    /// Fitted rows.
    pub fitted: Measured,
    /// Held-out rows, predicted after the fit.
    pub held_out: Measured,
    /// Their selection as text.
    pub words: String,
    /// Rows that are fitted because they lack a value that the condition uses.
    pub undecided: usize,
}

impl HoldOut {
    /// Chooses the rows.
    ///
    /// # Errors
    /// Errors of the selection, with their path below the analysis: none or several selections, an invalid condition, invalid cells, no
    /// held-out row, no fitted row.
    pub fn choose(entry: &HoldOutEntry, measured: &Measured) -> Result<Self, Diagnostic> {
        let rows = entry.rows();
        let place = |key: &str| match entry {
            HoldOutEntry::Where(_) => "hold_out".to_owned(),
            HoldOutEntry::Rows(_) => format!("hold_out.{key}"),
        };
        let ways = [
            rows.column.is_some(),
            rows.condition.is_some(),
            rows.every.is_some(),
            rows.random.is_some(),
        ];
        let count = ways.iter().filter(|way| **way).count();
        if count != 1 {
            let message = if count == 0 {
                "the selection of held-out rows is missing"
            } else {
                "there are several selections of held-out rows"
            };
            return Err(hold_out_error("hold_out", message)
                .help("write one of `column`, `where`, `every` and `random`, such as `hold_out: torque > 1000 Nm`"));
        }
        if rows.seed.is_some() && rows.random.is_none() {
            return Err(hold_out_error(place("seed"), "`seed` applies to random groups only")
                .help("delete `seed`, or write `random`"));
        }
        let (chosen, words) = choice(&rows, measured, &place)?;
        let of_kind = |held: bool| Measured {
            rows: measured
                .rows
                .iter()
                .zip(&chosen)
                .filter(|(_, kind)| **kind == Some(held) || (!held && kind.is_none()))
                .map(|(row, _)| row.clone())
                .collect(),
            ..measured.clone()
        };
        let found = Self {
            fitted: of_kind(false),
            held_out: of_kind(true),
            words,
            undecided: chosen.iter().filter(|kind| kind.is_none()).count(),
        };
        let all = measured.rows.len();
        if found.held_out.rows.is_empty() {
            return Err(
                hold_out_error("hold_out", format!("none of {all} rows is held out ({})", found.words))
                    .help("select rows of the data, or delete `hold_out`"),
            );
        }
        if found.fitted.rows.is_empty() {
            return Err(hold_out_error(
                "hold_out",
                format!("all {all} rows are held out, so there are no rows to fit"),
            )
            .help("hold out fewer rows"));
        }
        Ok(found)
    }

    /// Rejects a selection with fewer rows than needed for the parameters, `parameters` minus `others`: priors and means over cycles.
    ///
    /// # Errors
    /// If there are fewer.
    pub fn leaves_enough(&self, parameters: usize, others: usize) -> Result<(), Diagnostic> {
        let left = self.fitted.rows.len();
        if left + others >= parameters {
            return Ok(());
        }
        let message = format!("{left} rows remain for the fit of {parameters} parameters");
        Err(hold_out_error("hold_out", message).help("hold out fewer rows, or identify fewer parameters"))
    }
}

/// Whether each row is held out, absent if a value is missing; and the selection as text.
fn choice(
    rows: &HoldOutRows,
    measured: &Measured,
    place: &dyn Fn(&str) -> String,
) -> Result<(Vec<Option<bool>>, String), Diagnostic> {
    let count = measured.rows.len();
    if let Some(column) = &rows.column {
        let at = column_place(measured, column).map_err(|found| Diagnostic {
            path: place("column"),
            ..found
        })?;
        let held = |row: &Row| {
            let cell = row.cells.get(at).map_or_else(String::new, |cell| cell.to_lowercase());
            if HELD.contains(&cell.as_str()) {
                return Ok(Some(true));
            }
            if FITTED.contains(&cell.as_str()) {
                return Ok(Some(false));
            }
            let message = format!("line {}: `{cell}` in column `{column}` is neither yes nor no", row.line);
            Err(hold_out_error(place("column"), message)
                .help("write 1, true or yes in held-out rows, and 0, false, no or nothing in the others"))
        };
        let held = measured.rows.iter().map(held).collect::<Result<_, _>>()?;
        return Ok((held, format!("column `{column}`")));
    }
    if let Some(text) = &rows.condition {
        let wrong = |found: ExpressionFault| {
            hold_out_error(place("where"), format!("`{text}`, {found}")).help(found.help.unwrap_or_default())
        };
        let condition = Condition::parse(text).map_err(wrong)?;
        condition.check(measured).map_err(wrong)?;
        let held = measured.rows.iter().map(|row| condition.holds(measured, row)).collect();
        return Ok((held, condition.text().to_owned()));
    }
    if let Some(every) = rows.every {
        let every = every.max(1) as usize;
        let held = (1..=count).map(|number| Some(number % every == 0)).collect();
        return Ok((held, format!("one row in {every}")));
    }
    let share = rows.random.unwrap_or(0.0);
    let seed = rows.seed.unwrap_or(1);
    let mut order: Vec<usize> = (0..count).collect();
    Generator::new(u64::from(seed)).shuffle(&mut order);
    let most = (share * count as f64).round() as usize;
    let mut held = vec![Some(false); count];
    for row in order.into_iter().take(most) {
        held[row] = Some(true);
    }
    Ok((
        held,
        format!("{} % of the rows at random, seed {seed}", tidy_percent(share)),
    ))
}

fn tidy_percent(share: f64) -> String {
    let text = format!("{:.1}", 100.0 * share);
    text.trim_end_matches(".0").to_owned()
}

/// The index of a column, or the nearest name.
fn column_place(measured: &Measured, name: &str) -> Result<usize, Diagnostic> {
    measured.column(name).ok_or_else(|| {
        let headers: Vec<&str> = measured.columns.iter().map(|c| c.header.as_str()).collect();
        let help = match did_you_mean(name, headers.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the columns are {}", headers.join(", ")),
        };
        hold_out_error("", format!("the file has no column `{name}`")).help(help)
    })
}

/// Grouping of rows as text.
pub fn group_words(entry: &FoldsEntry) -> String {
    match entry {
        FoldsEntry::Torques(_) => "band of torque".to_owned(),
        FoldsEntry::By(by) => match by.by.as_str() {
            "sign" => "direction of power".to_owned(),
            "random" => "random group".to_owned(),
            "torque" | "speed" => format!("band of {}", by.by),
            "oil_temperature" => "band of oil temperature".to_owned(),
            column => format!("group of `{column}`"),
        },
    }
}

impl Identification<'_> {
    /// Groups of observations for cross-validation.
    ///
    /// # Errors
    /// If there are too few groups, or the data lack the grouping quantity, with the path below the analysis.
    pub fn groups(&self, entry: &FoldsEntry) -> Result<Vec<Fold>, Diagnostic> {
        let measured = self.measured();
        let rows: Vec<&Row> = self.observations.iter().map(|o| &measured.rows[o.row]).collect();
        let too_few = |path: &str, message: String| {
            hold_out_error(path, message).help("group by a quantity that varies, or write `folds: 0` for none")
        };
        let values = |quantity: &str| {
            rows.iter()
                .map(|row| measured.value(row, quantity))
                .collect::<Option<Vec<f64>>>()
        };
        let by = match entry {
            FoldsEntry::Torques(count) => {
                let torques = values("torque").unwrap_or_default();
                return folds(&torques, *count as usize).map_err(|message| too_few("folds", message));
            }
            FoldsEntry::By(by) => by,
        };
        let most = by.count.map_or(COUNT, |count| count as usize);
        let few = |message: String| too_few("folds.by", message);
        if by.seed.is_some() && by.by != "random" {
            return Err(hold_out_error("folds.seed", "`seed` applies to random groups only")
                .help("delete `seed`, or write `by: random`"));
        }
        let found = match by.by.as_str() {
            "random" => {
                let numbers: Vec<usize> = self.observations.iter().map(|o| o.row).collect();
                return random_folds(&numbers, most, u64::from(by.seed.unwrap_or(1))).map_err(few);
            }
            "sign" => {
                let sign = |row: &&Row| {
                    let value = |quantity: &str| measured.value(row, quantity).unwrap_or(0.0);
                    if value("torque") * value("speed") < 0.0 {
                        "power out"
                    } else {
                        "power in"
                    }
                    .to_owned()
                };
                rows.iter().map(sign).collect()
            }
            quantity if measured.holds(quantity) => {
                let Some(values) = values(quantity) else {
                    return Err(hold_out_error("folds.by", format!("some rows have no `{quantity}`"))
                        .help("group by another quantity, or omit these rows"));
                };
                return folds(&values, most).map_err(few);
            }
            name => texts(measured, &rows, name)?,
        };
        Self::labelled(by, found, most)
    }

    /// Groups of texts: bands if all are numbers, otherwise a group for each text.
    fn labelled(by: &FoldsBy, texts: Vec<String>, most: usize) -> Result<Vec<Fold>, Diagnostic> {
        let few = |message: String| {
            hold_out_error("folds.by", message).help("group by a quantity that varies, or write `folds: 0` for none")
        };
        let numbers: Option<Vec<f64>> = texts
            .iter()
            .map(|text| text.parse().ok().filter(|x: &f64| x.is_finite()))
            .collect();
        if let Some(numbers) = numbers {
            return folds(&numbers, most).map_err(few);
        }
        if by.count.is_some() {
            return Err(hold_out_error(
                "folds.count",
                format!("the number of groups of `{}` is given by its values", by.by),
            )
            .help("delete `count`"));
        }
        let name = |text: String| match (by.by.as_str(), text.as_str()) {
            ("sign", _) => text,
            (column, "") => format!("{column} blank"),
            (column, _) => format!("{column} {text}"),
        };
        let labels: Vec<String> = texts.into_iter().map(name).collect();
        let found = labelled_folds(&labels).map_err(few)?;
        if found.len() > GROUPS {
            let message = format!(
                "`{}` results in {} groups, each of which needs a fit",
                by.by,
                found.len()
            );
            return Err(
                hold_out_error("folds.by", message).help(format!("group by a column with at most {GROUPS} values"))
            );
        }
        Ok(found)
    }
}

/// Texts of a column, or of gears and names.
fn texts(measured: &Measured, rows: &[&Row], name: &str) -> Result<Vec<String>, Diagnostic> {
    let known = |text: &dyn Fn(&Row) -> Option<String>| -> Option<Vec<String>> {
        measured.rows.iter().any(|row| text(row).is_some()).then(|| {
            let texts = rows.iter().map(|row| text(row).unwrap_or_default());
            texts.collect()
        })
    };
    let found = match name {
        "gear" => known(&|row| row.gear.clone()),
        "name" => known(&|row| row.name.clone()),
        _ => None,
    };
    if let Some(found) = found {
        return Ok(found);
    }
    let at = column_place(measured, name).map_err(|found| {
        let words = "torque, speed, oil_temperature, sign, random";
        if words.split(", ").any(|word| word == name) {
            return hold_out_error("folds.by", format!("the data do not contain `{name}`")).help(format!(
                "state its column under `columns: {{ {name}: ... }}`, or group by another quantity"
            ));
        }
        let help = match did_you_mean(name, words.split(", ")) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!(
                "write one of {words}, or a column of the file: {}",
                found.help.unwrap_or_default()
            ),
        };
        hold_out_error("folds.by", found.message).help(help)
    })?;
    Ok(rows
        .iter()
        .map(|row| row.cells.get(at).cloned().unwrap_or_default())
        .collect())
}

/// A finding about held-out rows or folds.
fn hold_out_error(path: impl Into<String>, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(path, message).code(codes::HOLD_OUT)
}
