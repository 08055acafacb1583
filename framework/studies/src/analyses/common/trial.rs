//! A gearbox with one set and some changed values, rebuilt and solved on any thread.

use std::collections::BTreeSet;

use crate::points::{GridResult, OilTemperature, OnRig, PointResult, Points, Rows, SolvedRows, notes, run_grid};
use gearloss_framework::evaluate::Ratings;
use gearloss_framework::language::Language;
use gearloss_framework::loss::Extent;
use gearloss_framework::resolve::{lookup, matches};
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use serde_json::Value;

use crate::analyses::{Built, Engine, Planner};
use crate::study::Study;

/// Stated ranges that were left: path and quantity.
pub type Left = BTreeSet<(String, String)>;

/// Data for rebuilding.
pub struct Trial<'a> {
    language: &'a Language,
    study: &'a Study,
    variants: Variants<'a>,
}

impl<'a> Trial<'a> {
    /// For a gearbox with a set.
    pub fn new(cx: &Planner<'a>, built: &'a Built<'_>) -> Self {
        Self {
            language: cx.language,
            study: cx.study,
            variants: Variants::new(cx.language, built.gearbox, cx.study.choice(built.set())),
        }
    }

    /// The transmission with overrides, or its first error.
    pub fn build(&self, overrides: impl IntoIterator<Item = (String, Value)>) -> Result<Transmission, String> {
        let overrides: Vec<(String, Value)> = overrides.into_iter().collect();
        self.variants.build(&overrides).map_err(|findings| findings.first())
    }

    /// The values that follow others by a formula of the study with overrides: path and number in the unit of the path.
    pub fn followed(&self, overrides: &[(String, Value)]) -> Result<Vec<(String, Value)>, String> {
        if self.study.entry.conditions.follows.is_empty() {
            return Ok(Vec::new());
        }
        let resolved = self.variants.resolve(overrides).map_err(|findings| findings.first())?;
        let follows = self.study.entry.conditions.follows.ids();
        let paths = follows.flat_map(|target| matches(&resolved.value, target));
        let value = |path: String| {
            let value = lookup(&resolved.value, &path)?.clone();
            let unit = self.language.number_at(&resolved.value, &path);
            let number = unit.and_then(|(unit, ..)| Some(Value::from(unit.from_si(value.as_f64()?))));
            Some((path, number.unwrap_or(value)))
        };
        Ok(paths.filter_map(value).collect())
    }

    /// The same with the ratings of its components.
    pub fn build_rated(&self, overrides: Vec<(String, Value)>) -> Result<(Transmission, Ratings), String> {
        self.variants
            .build_rated(&overrides)
            .map_err(|findings| findings.first())
    }

    /// Solves all points. Their temperature follows the overrides unless given otherwise.
    pub fn solve(
        &self,
        engine: &Engine<'_>,
        transmission: &Transmission,
        points: &Points,
    ) -> Result<GridResult, String> {
        let points = Points {
            oil: OilTemperature::from_conditions(transmission, self.study.entry.conditions.oil_temperature),
            ..points.clone()
        };
        let solved = run_grid(transmission, &points, &|_| engine.should_continue());
        let solved = solved.map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?;
        solved.ok_or_else(|| "interrupted".to_owned())
    }

    /// Rows of a file with overrides.
    pub fn solved_rows(
        &self,
        engine: &Engine<'_>,
        rows: &Rows<'_>,
        overrides: &[(String, Value)],
        on: Option<OnRig<'_>>,
    ) -> Result<SolvedRows, String> {
        let built = rows
            .build(&self.variants, overrides)
            .map_err(|findings| findings.first())?;
        let solved = rows.solve(built, on, &|_| engine.should_continue());
        let solved = solved.map_err(|list| list.first().map_or_else(String::new, |d| d.message.clone()))?;
        solved.ok_or_else(|| "interrupted".to_owned())
    }
}

/// The stated ranges that a solved trial left.
pub fn left(transmission: &Transmission, seen: &[Extent]) -> impl Iterator<Item = (String, String)> {
    // Ranges that are kept need no words, which take longer than the points of a trial.
    let any = seen.iter().any(|seen| seen.outside > 0);
    let notes = any.then(|| {
        let outside = seen.iter().copied();
        let outside: Vec<Extent> = outside
            .map(|seen| if seen.outside > 0 { seen } else { Extent::EMPTY })
            .collect();
        notes(transmission, &outside)
    });
    notes.into_iter().flatten().map(|n| (n.path, n.name.to_owned()))
}

/// Why a point has no loss.
pub fn why(t: &Transmission, p: &PointResult) -> String {
    match (p.undefined, p.balance) {
        (Some((part, undefined)), _) => format!("{}: {undefined}", t.parts()[part].path),
        (None, Some(outcome)) => format!("balance: {}", outcome.name()),
        (None, None) => p.status.name().to_owned(),
    }
}
