//! The oil at measured points, as regimes: its viscosity, and how far it separates the surfaces.

use gearloss_framework::description::LubricantEntry;
use gearloss_framework::evaluate::Ratings;
use gearloss_framework::lubricant::Lubricant;
use gearloss_framework::prelude::Rated;
use gearloss_framework::transmission::Transmission;
use gearloss_framework::variants::Variants;
use serde_json::Value;

use super::super::Engine;
use super::{ValidationEntry, ValidationPlan};

/// Symbols of what separates surfaces, in ratings: the film ratio of flanks, the viscosity ratio of rolling bearings.
const SYMBOLS: [&str; 2] = ["lambda", "kappa"];

/// The oil at every point. The models of the gearbox give loads and film, so that the regimes of all judged models are the same.
#[derive(Debug, Clone, Default)]
pub struct Film {
    /// Kinematic viscosities; absent without an oil temperature, or with several lubricants. \[mm2/s\]
    pub viscosities: Option<Vec<f64>>,
    /// Least film ratio, or viscosity ratio, of the judged components, with its symbol; absent unless a rating gives it at every point. \[-\]
    pub ratios: Option<(&'static str, Vec<f64>)>,
}

impl Film {
    /// At the points of a plan; regimes that cannot be found are absent.
    pub(super) fn new(engine: &Engine<'_>, entry: &ValidationEntry, plan: &ValidationPlan<'_>) -> Self {
        Self::found(engine, entry, plan).unwrap_or_default()
    }

    fn found(engine: &Engine<'_>, entry: &ValidationEntry, plan: &ValidationPlan<'_>) -> Option<Self> {
        let gearbox = plan.base.gearbox;
        let rows = engine
            .study
            .rows(&plan.measured, &entry.bind, entry.gear.as_deref(), false);
        let variants = Variants::new(engine.language, gearbox, engine.study.choice(plan.base.set()));
        let resolved = rows.resolved(&variants).ok()?;
        let built = rows.build(&variants, &[]).ok()?;
        let ratings: Vec<Option<Ratings>> = resolved
            .iter()
            .zip(&built)
            .map(|(resolved, t)| gearbox.ratings(engine.language, resolved, t).ok())
            .collect();
        let oils: Vec<Option<Lubricant>> = resolved.iter().map(|resolved| oil(&resolved.value)).collect();
        let solved = rows.solve(built, None, &|_| true).ok()??;
        let of_row = |(place, _, point): &(usize, String, _)| {
            let point: &crate::points::PointResult = point;
            Some(oils[*place].as_ref()?.oil_at(point.oil?).nu * 1e6)
        };
        let viscosities: Option<Vec<f64>> = solved.rows.iter().map(of_row).collect();
        let of_symbol = |symbol: &'static str| {
            let of_row = |(place, gear, point): &(usize, String, _)| {
                let (t, ratings) = (&solved.transmissions[*place], ratings[*place].as_ref()?);
                rows.with_solution(t, gear, point, |solution| {
                    least(ratings, t, solution, &plan.judged, symbol)
                })?
            };
            let ratios: Option<Vec<f64>> = solved.rows.iter().map(of_row).collect();
            Some((symbol, ratios?))
        };
        Some(Self {
            viscosities,
            ratios: SYMBOLS.into_iter().find_map(of_symbol),
        })
    }
}

/// The only lubricant of a gearbox.
fn oil(resolved: &Value) -> Option<Lubricant> {
    let all = resolved.get("lubricants")?.as_object()?;
    let (_, only) = all.iter().next().filter(|_| all.len() == 1)?;
    let entry: LubricantEntry = serde_json::from_value(only.clone()).ok()?;
    Lubricant::new(&entry).ok()
}

/// The least value of a symbol in the ratings of some components.
fn least(
    ratings: &Ratings,
    t: &Transmission,
    solution: &gearloss_framework::evaluate::Solution<'_>,
    judged: &[String],
    symbol: &str,
) -> Option<f64> {
    let all = ratings.at(solution);
    let own = all
        .iter()
        .filter(|rating| judged.contains(&t.parts()[rating.part].path));
    let figures = own
        .filter_map(|rating| rating.result.as_ref().ok())
        .flat_map(Rated::figures);
    let values = figures
        .filter(|rated| rated.figure.symbol == symbol)
        .map(|rated| rated.value);
    values
        .filter(|value| value.is_finite() && *value > 0.0)
        .reduce(f64::min)
}
