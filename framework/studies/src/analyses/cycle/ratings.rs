//! Ratings over a cycle: damages add up at the load, speed and temperature of each interval, extremes are kept.

use std::collections::BTreeMap;

use gearloss_framework::document::Diagnostic;
use gearloss_framework::evaluate::Ratings;
use gearloss_framework::rating::{Bound, Figure, Over, over_time};
use gearloss_framework::transmission::Transmission;
use schemars::JsonSchema;
use serde::Serialize;

use super::points::Points;
use crate::points::{Driven, Ride};

/// A quantity of a rating over a whole cycle.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RatedOverTime {
    /// Path of the component.
    pub component: String,
    /// Name of the rating.
    pub rating: &'static str,
    /// Symbol as in the source.
    pub symbol: &'static str,
    /// Name of the quantity, as it stands in a sentence.
    pub meaning: &'static str,
    /// Unit of the value; `-` if there is none.
    pub unit: &'static str,
    /// `minimum`, `maximum`, or `damage`: the life after Palmgren and Miner if the cycle is repeated.
    pub over_time: &'static str,
    /// Value in that unit.
    pub value: f64,
    /// Minimum that the value should have; null without one.
    pub least: Option<f64>,
    /// Maximum that the value should have; null without one.
    pub greatest: Option<f64>,
    /// True if the value is outside.
    pub outside: bool,
    /// Share of the time at which the value of the moment is outside. [-]
    pub outside_share: f64,
}

/// The values of one quantity of one component: of each interval with its duration.
struct Course {
    figure: Figure,
    bound: Bound,
    values: Vec<(usize, f64)>,
}

/// Rates all components at every interval of a simulated cycle. Intervals without a power flow do no damage.
///
/// # Errors
/// If a gear is unknown.
pub fn over_cycle(
    t: &Transmission,
    ratings: &Ratings,
    ride: &Ride<'_>,
    driven: &Driven,
) -> Result<Vec<RatedOverTime>, Vec<Diagnostic>> {
    let mut points = Points::new(t, ride.flow);
    // By component, rating and order of the quantity in it.
    let mut courses: BTreeMap<(usize, &'static str, usize), Course> = BTreeMap::new();
    for (i, at) in Points::of(t, driven).into_iter().enumerate() {
        points.solve(&at, |solution| {
            for rating in ratings.at(solution) {
                let Ok(rated) = &rating.result else { continue };
                for figure in rated.figures() {
                    let order = rating.plugin.figures.iter().position(|known| *known == figure.figure);
                    let key = (rating.part, rating.plugin.entry.name, order.unwrap_or(usize::MAX));
                    let course = courses.entry(key).or_insert_with(|| Course {
                        figure: figure.figure,
                        bound: figure.bound,
                        values: Vec::new(),
                    });
                    course.values.push((i, figure.value));
                }
            }
        })?;
    }
    let durations: Vec<f64> = driven.stretches.iter().map(|stretch| stretch.heats.duration).collect();
    let time: f64 = durations.iter().sum();
    let records = courses.into_iter().filter_map(|((part, rating, _), course)| {
        let is_outside = |value: f64| !(course.bound.least..=course.bound.greatest).contains(&value);
        let value = course.combined(&durations)?;
        let outside = course.values.iter().filter(|(_, value)| is_outside(*value));
        let outside = outside.fold(0.0, |sum, (i, _)| sum + durations[*i]);
        let finite = |end: f64| end.is_finite().then_some(end);
        Some(RatedOverTime {
            component: t.parts()[part].path.clone(),
            rating,
            symbol: course.figure.symbol,
            meaning: course.figure.meaning,
            unit: course.figure.unit,
            over_time: match course.figure.over {
                Over::Least => "minimum",
                Over::Greatest => "maximum",
                Over::Damage => "damage",
            },
            value,
            least: finite(course.bound.least),
            greatest: finite(course.bound.greatest),
            outside: is_outside(value),
            outside_share: if time > 0.0 { outside / time } else { 0.0 },
        })
    });
    Ok(records.collect())
}

impl Course {
    /// The value over the whole time.
    fn combined(&self, durations: &[f64]) -> Option<f64> {
        let mut values = vec![None; durations.len()];
        for (i, value) in &self.values {
            values[*i] = Some(*value);
        }
        over_time(self.figure.over, durations.iter().copied().zip(values))
    }
}
