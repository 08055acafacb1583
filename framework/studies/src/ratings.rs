//! Ratings of components as records.

use gearloss_framework::evaluate::{ComponentRating, Ratings, Solution};
use gearloss_framework::rating::RatedFigure;
use gearloss_framework::registry::Evidence;
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use crate::numbers::{beyond, figures};

/// One rating of one component at one point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RatedComponent {
    /// Path of the component.
    pub component: String,
    /// Key of its mechanism.
    pub mechanism: &'static str,
    /// Name of the rating.
    pub rating: &'static str,
    /// Lowest evidence grade of the rating.
    pub evidence: Evidence,
    /// Why there are no quantities; null if the rating is defined.
    pub undefined: Option<String>,
    /// Its quantities.
    pub quantities: Vec<RatedQuantity>,
    /// Formulas that are used outside their stated range, as sentences.
    pub outside_ranges: Vec<String>,
}

/// A quantity of a rating.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RatedQuantity {
    /// Symbol as in the source.
    pub symbol: &'static str,
    /// Name, as it stands in a sentence.
    pub meaning: &'static str,
    /// Unit of the value; `-` if there is none.
    pub unit: &'static str,
    /// Value in that unit.
    pub value: f64,
    /// Minimum that the value should have; null without one.
    pub least: Option<f64>,
    /// Maximum that the value should have; null without one.
    pub greatest: Option<f64>,
    /// True if the value is outside.
    pub outside: bool,
    /// True for an intermediate, which tables omit.
    #[serde(skip)]
    pub detail: bool,
}

impl RatedQuantity {
    fn new(rated: &RatedFigure) -> Self {
        let finite = |end: f64| end.is_finite().then_some(end);
        Self {
            symbol: rated.figure.symbol,
            meaning: rated.figure.meaning,
            unit: rated.figure.unit,
            value: rated.value,
            least: finite(rated.bound.least),
            greatest: finite(rated.bound.greatest),
            outside: rated.is_outside(),
            detail: rated.figure.detail,
        }
    }

    /// What is wrong with a value outside its bound: `below` or `above`, and the bound.
    pub fn fault(&self) -> Option<(&'static str, f64)> {
        match (self.least, self.greatest) {
            (Some(least), _) if self.value < least => Some(("below", least)),
            (_, Some(greatest)) if self.value > greatest => Some(("above", greatest)),
            _ => None,
        }
    }
}

impl RatedQuantity {
    /// How far the value is outside its bound; negative inside, minus infinity without a bound.
    pub fn excess(&self) -> f64 {
        let below = self.least.map_or(f64::NEG_INFINITY, |least| least - self.value);
        let above = self
            .greatest
            .map_or(f64::NEG_INFINITY, |greatest| self.value - greatest);
        below.max(above)
    }

    /// The value and its bound, as a sentence, if it is outside.
    pub fn sentence(&self) -> Option<String> {
        let (side, bound) = self.fault()?;
        let unit = if self.unit == "-" {
            String::new()
        } else {
            format!(" {}", self.unit)
        };
        let [value, bound] = [self.value, bound].map(|number| figures(number, DIGITS));
        Some(format!(
            "{} {} = {value}{unit} is {side} {bound}{unit}",
            self.meaning, self.symbol
        ))
    }
}

/// Digits of numbers in sentences.
const DIGITS: u32 = 4;

impl RatedComponent {
    fn new(transmission: &Transmission, rating: &ComponentRating) -> Self {
        let part = &transmission.parts()[rating.part];
        let entry = &rating.plugin.entry;
        let (rated, undefined) = match &rating.result {
            Ok(rated) => (rated.figures(), None),
            Err(reason) => (&[][..], Some(reason.to_string())),
        };
        let left = rating.left.iter().map(|(i, extent)| {
            let limit = &entry.limits[*i];
            let value = if extent.least < limit.least {
                extent.least
            } else {
                extent.greatest
            };
            format!(
                "{} {} = {} is {} ({})",
                limit.meaning,
                limit.name,
                figures(value, DIGITS),
                beyond(limit.least, limit.greatest),
                limit.origin
            )
        });
        Self {
            component: part.path.clone(),
            mechanism: part.mechanism,
            rating: entry.name,
            evidence: entry
                .evidence
                .iter()
                .map(|g| g.grade)
                .max()
                .unwrap_or(Evidence::Assumed),
            undefined,
            quantities: rated.iter().map(RatedQuantity::new).collect(),
            outside_ranges: left.collect(),
        }
    }
}

/// The ratings of all components at a solved point; those without any quantity are omitted.
pub fn rated(ratings: &Ratings, transmission: &Transmission, solution: &Solution<'_>) -> Vec<RatedComponent> {
    let all = ratings.at(solution);
    let records = all.iter().map(|rating| RatedComponent::new(transmission, rating));
    records
        .filter(|record| record.undefined.is_some() || !record.quantities.is_empty())
        .collect()
}
