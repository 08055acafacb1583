//! Varied quantities of a description: uncertain, unknown, swept.

use crate::codes;
use serde_json::Value;

use gearloss_framework::document::{Diagnostic, Dimension, Unit};
use gearloss_framework::language::Language;
use gearloss_framework::resolve::{Resolved, lookup, matches};
use gearloss_framework::table::clamped;

/// How a pattern with several matches changes them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Tie {
    /// All have the same value.
    #[default]
    Value,
    /// Each value is multiplied by a common factor; quantities without a value are unchanged.
    Factor,
}

/// A number of the resolved description, or several tied numbers, with unit and range of the schema.
#[derive(Debug, Clone)]
pub struct Varied {
    /// The pattern as written.
    pub pattern: String,
    /// Matched paths.
    pub paths: Vec<String>,
    /// Unit of values from the schema; a factor has none.
    pub unit: &'static Unit,
    /// Value of each in the description, in that unit; absent if not stated.
    pub base: Vec<Option<f64>>,
    /// Minimum and maximum allowed by the schema for all of them.
    pub range: [f64; 2],
    /// How several quantities change together.
    pub tie: Tie,
    /// Published values of coefficients of formulas.
    pub published: Vec<Option<f64>>,
    /// Rows along which several quantities move together; the value is that of the first.
    pub along: Option<Along>,
}

/// Rows along which quantities move together.
#[derive(Debug, Clone, PartialEq)]
pub struct Along {
    /// Values of the first quantity, ascending.
    first: Vec<f64>,
    /// Values of each path, by row.
    values: Vec<Vec<f64>>,
    /// Whether the nearest row is used, because a value is a whole number.
    nearest: bool,
}

impl Along {
    /// The value of a path by its number at a value of the first quantity.
    fn value(&self, path: usize, first: f64) -> f64 {
        if self.nearest {
            let distance = |i: &usize| (self.first[*i] - first).abs();
            let nearest = (0..self.first.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            return self.values[path][nearest.unwrap_or(0)];
        }
        clamped(&self.first, &self.values[path], first)
    }
}

impl Varied {
    /// Looks a pattern up in a resolved description.
    ///
    /// # Errors
    /// If it matches nothing, or something other than a number; with `Tie::Factor`, if no value is stated.
    pub fn new(language: &Language, resolved: &Resolved, pattern: &str, tie: Tie) -> Result<Self, Diagnostic> {
        let mut paths = matches(&resolved.value, pattern);
        if paths.is_empty() {
            return Err(gearloss_framework::resolve::no_match(&resolved.value, pattern));
        }
        // Models differ in their keys: only those with this key match.
        paths.retain(|path| language.has_place(&resolved.value, path));
        if paths.is_empty() {
            let key = pattern.rsplit('.').next().unwrap_or(pattern);
            return Err(varied_error(pattern, format!("nothing here has a key `{key}`"))
                .help("`gearloss check --resolved` prints every path"));
        }
        // A factor changes only those with a value.
        let has_value = |path: &String| lookup(&resolved.value, path).is_some_and(|value| !value.is_null());
        if tie == Tie::Factor && paths.iter().any(has_value) {
            paths.retain(has_value);
        }
        let mut varied = Self {
            pattern: pattern.to_owned(),
            paths: Vec::new(),
            unit: Unit::ONE,
            base: Vec::new(),
            range: [f64::NEG_INFINITY, f64::INFINITY],
            tie,
            published: Vec::new(),
            along: None,
        };
        for path in paths {
            let Some((unit, least, greatest)) = language.number_at(&resolved.value, &path) else {
                return Err(varied_error(pattern, format!("`{path}` is not a number"))
                    .help("use the path of a quantity; `gearloss check --resolved` prints every path"));
            };
            let base = lookup(&resolved.value, &path)
                .and_then(Value::as_f64)
                .map(|si| unit.from_si(si));
            match tie {
                Tie::Factor if base.is_none() => {
                    return Err(varied_error(pattern, format!("`{path}` has no value to multiply"))
                        .help("state it in the gearbox, or delete `tie: factor`"));
                }
                Tie::Factor => {}
                Tie::Value => {
                    varied.unit = unit;
                    varied.range = [varied.range[0].max(least), varied.range[1].min(greatest)];
                }
            }
            varied
                .published
                .push(language.published_coefficient(&resolved.value, &path));
            varied.paths.push(path);
            varied.base.push(base);
        }
        Ok(varied)
    }

    /// Several paths that move together along rows of values. The error is the key below the entry, what is wrong, and how to correct it.
    ///
    /// # Errors
    /// Paths that are no numbers, and rows that do not fit.
    pub fn along(
        language: &Language,
        resolved: &Resolved,
        paths: &[String],
        rows: &[Vec<Value>],
    ) -> Result<Self, (String, String, String)> {
        let wrong = |key: String, message: String, help: &str| Err((key, message, help.to_owned()));
        if paths.len() < 2 {
            return wrong(
                "paths".to_owned(),
                "there is only one path".to_owned(),
                "write `path` for it, or add the others",
            );
        }
        if rows.len() < 2 {
            let help = "write for example `values: [[24, 83], [30, 77]]`";
            return wrong("values".to_owned(), "two rows of values are needed".to_owned(), help);
        }
        let (mut all, mut columns, mut nearest) = (Vec::new(), Vec::new(), false);
        for (k, path) in paths.iter().enumerate() {
            let is_whole = language.is_whole_at(&resolved.value, path);
            nearest |= is_whole;
            let varied = if is_whole {
                Ok(Self::whole(resolved, path))
            } else {
                Self::new(language, resolved, path, Tie::Value)
            };
            let varied =
                varied.map_err(|error| (format!("paths.{k}"), error.message, error.help.unwrap_or_default()))?;
            if all
                .iter()
                .any(|other: &Self| other.paths.iter().any(|path| varied.paths.contains(path)))
            {
                return wrong(
                    format!("paths.{k}"),
                    format!("`{path}` is already in the list"),
                    "delete it",
                );
            }
            let mut column = Vec::new();
            for (i, row) in rows.iter().enumerate() {
                let at = format!("values.{i}");
                let Some(value) = row.get(k).filter(|_| row.len() == paths.len()) else {
                    let message = format!("a list of {} values is needed, one for each path", paths.len());
                    return wrong(at, message, "write for example `values: [[24, 83], [30, 77]]`");
                };
                let number = varied.quantity(value, false);
                let number = number
                    .map_err(|reason| (format!("{at}.{k}"), reason, "write a quantity of its path".to_owned()))?;
                let [least, greatest] = varied.range;
                if !(least..=greatest).contains(&number) || (is_whole && number.fract() != 0.0) {
                    let message = format!("{number} is no possible value of `{path}`");
                    return wrong(format!("{at}.{k}"), message, "correct it");
                }
                column.push(number);
            }
            all.push(varied);
            columns.push(column);
        }
        if columns[0].windows(2).all(|pair| pair[0] > pair[1]) {
            for column in &mut columns {
                column.reverse();
            }
        } else if !columns[0].windows(2).all(|pair| pair[0] < pair[1]) {
            let help = "sort the rows by their first value, which must not repeat";
            return wrong(
                "values".to_owned(),
                "the first values of the rows do not increase".to_owned(),
                help,
            );
        }
        let first = columns[0].clone();
        let mut merged = all[0].clone();
        let mut values = vec![columns[0].clone(); merged.paths.len()];
        for (varied, column) in all.iter().zip(&columns).skip(1) {
            values.extend(varied.paths.iter().map(|_| column.clone()));
            merged.paths.extend(varied.paths.iter().cloned());
            merged.base.extend(varied.base.iter().copied());
            merged.published.extend(varied.published.iter().copied());
        }
        merged.pattern = paths.join(", ");
        merged.range = [first[0], first[first.len() - 1]];
        merged.along = Some(Along { first, values, nearest });
        Ok(merged)
    }

    /// A whole number of a resolved description.
    fn whole(resolved: &Resolved, path: &str) -> Self {
        Self {
            pattern: path.to_owned(),
            paths: vec![path.to_owned()],
            unit: Unit::ONE,
            base: vec![lookup(&resolved.value, path).and_then(Value::as_f64)],
            range: [f64::NEG_INFINITY, f64::INFINITY],
            tie: Tie::Value,
            published: vec![None],
            along: None,
        }
    }

    /// The value of the description: of the first if several differ; one for a factor.
    pub fn start(&self) -> Option<f64> {
        match self.tie {
            Tie::Value => self.base.iter().flatten().next().copied(),
            Tie::Factor => Some(1.0),
        }
    }

    /// The published value, if it changes coefficients of formulas: of the first if several differ, one for a factor.
    pub fn published(&self) -> Option<f64> {
        let first = self.published.iter().flatten().next().copied();
        match self.tie {
            Tie::Value => first,
            Tie::Factor => first.map(|_| 1.0),
        }
    }

    /// The difference of a value from the source as text; absent if it changes no coefficient of a formula.
    pub fn changed_from_source(&self, value: f64) -> Option<String> {
        self.overrides(value)
            .zip(&self.published)
            .find_map(|((_, used), published)| {
                let (used, published) = (used.as_f64()?, (*published)?);
                (used != published).then(|| format!("{used} instead of the published {published}"))
            })
    }

    /// Overrides that set all of them to a value.
    pub fn overrides(&self, value: f64) -> impl Iterator<Item = (String, Value)> + '_ {
        self.paths
            .iter()
            .zip(&self.base)
            .enumerate()
            .map(move |(i, (path, base))| {
                let changed = match (&self.along, self.tie) {
                    (Some(along), _) => {
                        let changed = along.value(i, value);
                        // Whole numbers of a document are written as such.
                        if along.nearest && changed.fract() == 0.0 {
                            return (path.clone(), Value::from(changed as i64));
                        }
                        changed
                    }
                    (None, Tie::Value) => value,
                    (None, Tie::Factor) => value * base.unwrap_or(0.0),
                };
                (path.clone(), Value::from(changed))
            })
    }

    /// Reads a quantity of this kind from a study: a number in the unit of the path, or a text with a unit. \[unit of the path\]
    ///
    /// # Errors
    /// The error.
    pub fn quantity(&self, written: &Value, difference: bool) -> Result<f64, String> {
        let unit = if difference && self.unit.dimension == Dimension::Temperature {
            Unit::of_symbol("K").unwrap_or(self.unit)
        } else {
            self.unit
        };
        let number = match written {
            Value::Number(x) => x.as_f64().unwrap_or(f64::NAN),
            Value::String(text) if difference && text.trim_end().ends_with('%') => {
                // Of the value, or of one?
                return Err(format!(
                    "`{text}` is no difference: `percent` states a share of the value, a number without `%` a difference"
                ));
            }
            Value::String(text) => {
                let si = gearloss_framework::document::parse_quantity(text, unit).map_err(|fault| fault.message)?;
                unit.from_si(si)
            }
            _ => f64::NAN,
        };
        if number.is_finite() {
            Ok(number)
        } else {
            Err(format!("{written} is not a valid {}", unit.dimension.name()))
        }
    }

    /// A value with its unit.
    pub fn words(&self, value: f64) -> String {
        words(self.unit, value)
    }
}

/// A value with its unit.
pub(crate) fn words(unit: &Unit, value: f64) -> String {
    let digits = format!("{value:.6}");
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    if unit.dimension == Dimension::None {
        digits.to_owned()
    } else {
        format!("{digits} {}", unit.symbol)
    }
}

/// A finding about a varied quantity.
fn varied_error(path: impl Into<String>, message: impl Into<String>) -> Diagnostic {
    Diagnostic::error(path, message).code(codes::VARIED)
}
