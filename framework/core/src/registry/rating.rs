//! Ratings in the registry.

use serde_json::{Map, Value};

use super::{Entry, Files, Registry, missing, twice};
use crate::document::Diagnostic;
use crate::loss::Step;
use crate::rating::{Figure, Rated};

/// A registered rating.
#[derive(Clone, Copy)]
pub struct RatingPlugin {
    /// Mechanism, name, source, parameters and evidence, as those of a model; it has no terms.
    pub entry: Entry,
    /// Quantities that it may return.
    pub figures: &'static [Figure],
    /// Evaluates it alone: resolved parameters, part and quantities of the context in SI.
    pub eval: fn(&Registry, &Files, &Self, &Value, &Value, &Map<String, Value>) -> Result<RatedAlone, Diagnostic>,
    /// Faults on a part, from the conformance suite.
    pub conform: fn(&Registry, &Files, &Self, &Value, &Value) -> Vec<String>,
}

inventory::collect!(RatingPlugin);

/// Result of a rating that is evaluated without a gearbox.
#[derive(Debug, Clone)]
pub struct RatedAlone {
    /// The quantities.
    pub rated: Rated,
    /// Every step, with the path of its model.
    pub steps: Vec<(String, Step)>,
}

impl RatedAlone {
    /// The value of a step in the unit of its source; the last one if it was taken several times.
    pub fn step(&self, symbol: &str) -> Option<f64> {
        super::evaluated::step(&self.steps, symbol)
    }
}

impl Registry {
    /// The same with ratings.
    ///
    /// # Errors
    /// If two ratings have the same name, or one is of an unknown mechanism; each error names modules and lines.
    pub(crate) fn with_ratings(
        mut self,
        ratings: impl IntoIterator<Item = RatingPlugin>,
    ) -> Result<Self, Vec<Diagnostic>> {
        self.ratings.extend(ratings);
        let place = |r: &RatingPlugin| {
            (
                r.entry.name,
                r.entry.origin.package,
                r.entry.origin.file,
                r.entry.origin.line,
            )
        };
        self.ratings.sort_by(|a, b| place(a).cmp(&place(b)));
        let mut found: Vec<Diagnostic> = self
            .ratings
            .windows(2)
            .filter(|pair| pair[0].entry.name == pair[1].entry.name)
            .map(|pair| twice("rating", pair[0].entry.name, pair[0].entry.origin, pair[1].entry.origin))
            .collect();
        for rating in &self.ratings {
            let entry = &rating.entry;
            if self.mechanism(entry.mechanism).is_none() {
                let message = format!(
                    "rating `{}` refers to the unknown mechanism `{}`",
                    entry.name, entry.mechanism
                );
                let error = Diagnostic::error("", message).code(crate::codes::REGISTRATION);
                found.push(
                    error
                        .note(format!("registered at {}", entry.origin))
                        .help("register the mechanism with `register_mechanism!` or `register_component!`"),
                );
            }
        }
        if found.is_empty() { Ok(self) } else { Err(found) }
    }

    /// All ratings, sorted by name.
    pub fn ratings(&self) -> &[RatingPlugin] {
        &self.ratings
    }

    /// The ratings of a mechanism, sorted by name.
    pub fn ratings_of<'a>(&'a self, mechanism: &'a str) -> impl Iterator<Item = &'a RatingPlugin> {
        self.ratings.iter().filter(move |r| r.entry.mechanism == mechanism)
    }

    /// A rating by its name.
    ///
    /// # Errors
    /// If there is none; the error lists those that exist, or a close match.
    pub fn rating_named(&self, name: &str) -> Result<&RatingPlugin, Diagnostic> {
        let known = self.ratings.iter().find(|r| r.entry.name == name);
        known.ok_or_else(|| {
            let names: Vec<&str> = self.ratings.iter().map(|r| r.entry.name).collect();
            missing(format!("no rating is called `{name}`"), name, &names)
        })
    }
}

/// Registers a rating: mechanism, name in documents, parameters, then its metadata. The doc comment of its parameters describes it. All
/// parameters have defaults, because ratings are on by default. Without `prepare` the parameters are the rating; with it,
/// `prepare(parameters, &mut Build)` builds the rating.
#[macro_export]
macro_rules! register_rating {
    ($M:ty, $name:literal, $Params:ty,
        source: $source:expr, $(part: $part:expr,)?
        evidence: [$($graded:expr),* $(,)?], $(checks: [$($check:expr),* $(,)?],)? figures: [$($figure:expr),+ $(,)?]
        $(, limits: [$($limit:expr),* $(,)?])? $(, prepare: $prepare:expr)? $(,)?) => {
        $crate::registry::submit! {
            $crate::registry::RatingPlugin {
                entry: $crate::registry::Entry {
                    mechanism: <$M as $crate::mechanism::Mechanism>::KEY, name: $name, source: $source, example: "{}",
                    part: $crate::register!(@part $($part)?), files: &[], evidence: &[$($graded),*],
                    limits: &[$($($limit),*)?], terms: &[], observed: &[], checks: &[$($($check),*)?],
                    scope: $crate::mechanism::gear_drag::Scope::Gear, geometry: true, plastics: true,
                    origin: $crate::origin!(),
                    schema: |generator| <$Params as $crate::schemars::JsonSchema>::json_schema(generator),
                    build: |value, cx| {
                        let params: $Params = cx.params(value)?;
                        let rating = $crate::register!(@model params, cx $(, $prepare)?);
                        let rating: ::std::sync::Arc<dyn $crate::rating::Rating<$M>> = ::std::sync::Arc::new(rating);
                        Ok(Box::new(rating))
                    },
                },
                figures: &[$($figure),+],
                eval: $crate::eval::rate::<$M>,
                conform: $crate::conformance::conform_rating::<$M>,
            }
        }
    };
}
