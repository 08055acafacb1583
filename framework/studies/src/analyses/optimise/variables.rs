//! Variables of a design: numbers in ranges, and choices.

use gearloss_framework::description::Ordered;
use gearloss_framework::resolve::lookup;
use gearloss_numerics::search::Gene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::analyses::common::ranges::Range;
use crate::analyses::{Built, Planner, Stopped};
use crate::study::{RangeEntry, Together, joined};
use crate::varied::{Tie, Varied};

/// A variable of a design: a number in a range, one of several values, or values of several paths that are chosen together.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct VariableEntry {
    /// Resolved path; with `*` all matches change together.
    #[schemars(extend("x-refers-to" = "path"))]
    pub path: Option<String>,
    /// Several paths instead of one, whose `values` are chosen together.
    #[serde(default)]
    #[schemars(extend("x-refers-to" = "path"))]
    pub paths: Vec<String>,
    /// How several quantities change together.
    #[serde(default)]
    pub tie: Tie,
    /// Half width of the range about the value of the gearbox, as a quantity of the path: `0.1 um`.
    pub plus_minus: Option<Value>,
    /// The same in percent of the value of the gearbox. [%]
    #[schemars(range(min = 1e-9, max = 1000.0))]
    pub percent: Option<f64>,
    /// Lower end of the range.
    pub from: Option<Value>,
    /// Upper end of the range.
    pub to: Option<Value>,
    /// Values to choose from, each as in a gearbox: numbers, designations, records of models; with `paths` each a list with a value for each
    /// path: `[[24, 83], [30, 77]]`. Not with a range.
    #[serde(default)]
    pub values: Vec<Value>,
    /// Designations of the shipped catalogue instead of values, for the path of a `designation`: those with these columns, such as
    /// `{ kind: deep_groove_ball, bore: 40 mm }`; `gearloss catalogue` lists them.
    #[serde(default)]
    pub catalogue: Ordered<Value>,
    /// Scale on which a number is searched.
    #[serde(default)]
    pub scale: Scale,
}

/// Scale of a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Equal differences count equally.
    #[default]
    Linear,
    /// Equal ratios count equally; both ends are positive.
    Log,
}

/// A variable as read.
pub struct Variable {
    /// Name in the study.
    pub name: String,
    /// Path as written, or several.
    pub path: String,
    kind: Kind,
}

enum Kind {
    Number {
        range: Box<Range>,
        log: bool,
    },
    Choice {
        varied: Together,
        /// The values of the description among them.
        present: Option<usize>,
        /// The values of the description in words.
        described: String,
    },
}

impl Variable {
    /// Whether it is one of several values.
    pub fn is_choice(&self) -> bool {
        matches!(self.kind, Kind::Choice { .. })
    }

    /// The variables of an analysis at a path.
    pub fn all(
        cx: &Planner<'_>,
        path: &str,
        entries: &Ordered<VariableEntry>,
        b: &Built<'_>,
    ) -> Result<Vec<Self>, Stopped> {
        let entries = entries.iter();
        entries
            .map(|(name, entry)| Self::new(cx, &format!("{path}.variables.{name}"), name, entry, b))
            .collect()
    }

    fn new(cx: &Planner<'_>, at: &str, name: &str, entry: &VariableEntry, b: &Built<'_>) -> Result<Self, Stopped> {
        let VariableEntry {
            plus_minus,
            percent,
            from,
            to,
            ..
        } = entry;
        let is_range = plus_minus.is_some() || percent.is_some() || from.is_some() || to.is_some();
        let values = match entry.catalogue.is_empty() {
            true => entry.values.clone(),
            false if entry.values.is_empty() => designations(cx, at, entry, b)?,
            false => {
                let message = "a variable has either `values` or a `catalogue`";
                return Err(cx.wrong(at, message, "delete one of them"));
            }
        };
        let varied = Together::new(entry.path.as_deref(), &entry.paths, &values);
        let varied = varied.map_err(|(key, message, help)| cx.wrong(&format!("{at}{key}"), message, &help))?;
        let path = varied.words();
        let kind = if values.is_empty() {
            let Some(own) = entry.path.clone().filter(|_| entry.paths.is_empty()) else {
                let message = "paths that move together need `values`";
                let help = "list the values of each: `values: [[24, 83], [30, 77]]`, or vary one path and let others follow it by \
                            `conditions.follows`";
                return Err(cx.wrong(at, message, help));
            };
            let range = RangeEntry {
                path: Some(own),
                paths: Vec::new(),
                values: Vec::new(),
                tie: entry.tie,
                plus_minus: plus_minus.clone(),
                percent: *percent,
                from: from.clone(),
                to: to.clone(),
            };
            let range = Range::new(cx, at, &range, b)?;
            range.inside(cx, at)?;
            let log = entry.scale == Scale::Log;
            if log && range.ends[0] <= 0.0 {
                let message = format!(
                    "{path}: a logarithmic scale needs positive ends, not {}",
                    range.varied.words(range.ends[0])
                );
                return Err(cx.wrong(at, message, "raise the lower end, or delete `scale: log`"));
            }
            Kind::Number {
                range: Box::new(range),
                log,
            }
        } else if is_range || entry.scale == Scale::Log {
            let message = "a variable has either `values` or a range";
            return Err(cx.wrong(at, message, "delete `values`, or the range and its scale"));
        } else if values.len() < 2 {
            let message = "there is only one value to choose";
            return Err(cx.wrong(
                &format!("{at}.values"),
                message,
                "add the values to choose from, the present one among them",
            ));
        } else {
            let quantity = |path: &str| Varied::new(cx.language, &b.resolved, path, Tie::Value).ok();
            let now = |path: &str| lookup(&b.resolved.value, path);
            let has = |path: &str, value: &Value| {
                let numbers = quantity(path).and_then(|of| of.start().zip(of.quantity(value, false).ok()));
                numbers.map_or(now(path) == Some(value), |(now, asked)| {
                    (now - asked).abs() <= 1e-12 * asked.abs()
                })
            };
            let words = |path: &String| {
                let number = quantity(path).and_then(|of| Some(of.words(of.start()?)));
                number.unwrap_or_else(|| now(path).map_or_else(|| "not stated".to_owned(), in_words))
            };
            Kind::Choice {
                present: varied.described(has),
                described: joined(varied.paths.iter().map(words)),
                varied,
            }
        };
        Ok(Self {
            name: name.to_owned(),
            path,
            kind,
        })
    }

    /// Its gene.
    pub fn gene(&self) -> Gene {
        match &self.kind {
            Kind::Number { .. } => Gene::Number,
            Kind::Choice { varied, .. } => Gene::Choice(varied.rows.len()),
        }
    }

    /// The gene of the description, or the nearest to it.
    pub fn present(&self) -> f64 {
        match &self.kind {
            Kind::Choice { present, .. } => present.unwrap_or(0) as f64,
            Kind::Number { range, log } => {
                let [low, high] = range.ends.map(|end| on_scale(end, *log));
                let start = range.varied.start().filter(|number| !log || *number > 0.0);
                start.map_or(0.5, |number| {
                    ((on_scale(number, *log) - low) / (high - low)).clamp(0.0, 1.0)
                })
            }
        }
    }

    /// The number of a gene, in the unit of the path, with four digits; absent for a choice.
    pub fn number(&self, gene: f64) -> Option<f64> {
        match &self.kind {
            Kind::Choice { .. } => None,
            Kind::Number { range, log } => {
                let [low, high] = range.ends;
                let number = if *log {
                    low * (high / low).powf(gene)
                } else {
                    range.value_at(gene)
                };
                Some(rounded(number).clamp(low, high))
            }
        }
    }

    /// Whether its choices depend on each other, so that some of them may be impossible.
    pub fn is_joint(&self) -> bool {
        matches!(&self.kind, Kind::Choice { varied, .. } if varied.paths.len() > 1)
    }

    /// Overrides of a gene.
    pub fn overrides(&self, gene: f64) -> Vec<(String, Value)> {
        match &self.kind {
            Kind::Number { range, .. } => range.varied.overrides(self.number(gene).unwrap_or_default()).collect(),
            Kind::Choice { varied, .. } => varied.overrides(gene as usize),
        }
    }

    /// Whether a gene is the value of the description, to a thousandth of the range.
    pub fn is_present(&self, gene: f64) -> bool {
        match &self.kind {
            Kind::Choice { present, .. } => present.is_some_and(|place| place as f64 == gene),
            Kind::Number { range, .. } => {
                let [now, asked] = [range.varied.start(), self.number(gene)];
                let [low, high] = range.ends;
                now.zip(asked)
                    .is_some_and(|(now, number)| (number - now).abs() <= 1e-3 * (high - low))
            }
        }
    }

    /// A gene in words.
    pub fn words(&self, gene: f64) -> String {
        match &self.kind {
            Kind::Number { range, .. } => range.varied.words(self.number(gene).unwrap_or_default()),
            Kind::Choice { varied, .. } => joined(varied.rows[gene as usize].iter().map(in_words)),
        }
    }

    /// The value of the description in words.
    pub fn present_words(&self) -> String {
        match &self.kind {
            Kind::Number { range, .. } => {
                let start = range.varied.start();
                start.map_or_else(|| "not stated".to_owned(), |number| range.varied.words(number))
            }
            Kind::Choice { described, .. } => described.clone(),
        }
    }
}

/// Designations of the catalogue of a path whose columns have given values.
fn designations(cx: &Planner<'_>, at: &str, entry: &VariableEntry, b: &Built<'_>) -> Result<Vec<Value>, Stopped> {
    let at = &format!("{at}.catalogue");
    let path = entry.path.as_deref().unwrap_or_default();
    let owner = path.strip_suffix(".designation");
    let table = owner.and_then(|owner| Some((owner, cx.language.catalogue(owner.split('.').next()?)?)));
    let Some((owner, table)) = table else {
        let message = format!("`{path}` has no catalogue");
        return Err(cx.wrong(
            at,
            message,
            "use the path of a designation, such as `bearings.B2.designation`",
        ));
    };
    let mut found: Vec<&String> = table.0.keys().collect();
    for (key, wanted) in entry.catalogue.iter() {
        // Numbers are compared in the unit of the key.
        let number = Varied::new(cx.language, &b.resolved, &format!("{owner}.{key}"), Tie::Value).ok();
        let value = |written: &Value| number.as_ref().and_then(|varied| varied.quantity(written, false).ok());
        found.retain(|designation| {
            let entry = table.0[*designation].values.iter().find(|(name, _)| name == key);
            entry.is_some_and(|(_, stated)| match (value(stated), value(wanted)) {
                (Some(number), Some(wanted)) => (number - wanted).abs() <= 1e-9 * wanted.abs(),
                _ => in_words(stated) == in_words(wanted),
            })
        });
        if found.is_empty() {
            let message = format!("no designation has `{key}: {}`", in_words(wanted));
            return Err(cx.wrong(
                &format!("{at}.{key}"),
                message,
                "`gearloss catalogue bearings` lists all with their columns",
            ));
        }
    }
    Ok(found
        .into_iter()
        .map(|designation| Value::from(designation.as_str()))
        .collect())
}

/// A number with four digits: more cannot be made, and are hard to read.
fn rounded(x: f64) -> f64 {
    if x == 0.0 {
        return x;
    }
    // As text, because a product with a power of ten has other last bits.
    format!("{x:.3e}").parse().unwrap_or(x)
}

fn on_scale(x: f64, log: bool) -> f64 {
    if log { x.ln() } else { x }
}

/// A value in words: a record by its type.
fn in_words(value: &Value) -> String {
    match (value, value.get("type")) {
        (_, Some(Value::String(name))) => name.clone(),
        (Value::String(text), _) => text.clone(),
        _ => value.to_string(),
    }
}
