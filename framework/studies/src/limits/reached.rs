//! What limits of a study reach in an analysis.

use schemars::JsonSchema;
use serde::Serialize;

use super::limit::Limit;
use crate::study::limits::Severity;

/// A limit of the study over all points or cycles of an analysis with one model set.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LimitReached {
    /// Name in the study.
    pub limit: String,
    /// Model set.
    pub model_set: String,
    /// What is limited.
    pub quantity: String,
    /// Unit of the values.
    pub unit: String,
    /// Least allowed value.
    pub least: Option<f64>,
    /// Greatest allowed value.
    pub most: Option<f64>,
    /// What follows if it is not kept.
    pub severity: Severity,
    /// Number of points, or of cycles, at which the quantity is known.
    pub points: usize,
    /// Number of points with a power flow, or of cycles, at which it is unknown.
    pub points_unknown: usize,
    /// Number of them at which the limit is not kept.
    pub beyond: usize,
    /// Value farthest beyond the limit, or closest to it; null if it is never known.
    pub worst: Option<f64>,
    /// Where that is.
    pub at: Place,
}

/// Where a value was found.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct Place {
    /// Path of the component, for a rating.
    pub component: Option<String>,
    /// Cycle; null at a point.
    pub cycle: Option<String>,
    /// Gear; null over a cycle.
    pub gear: Option<String>,
    /// Torque. [Nm]
    pub torque_nm: Option<f64>,
    /// Speed. [rpm]
    pub speed_rpm: Option<f64>,
    /// Oil temperature. [degC]
    pub oil_temperature_degc: Option<f64>,
}

/// What one limit reaches over points.
#[derive(Debug, Clone, Default)]
pub struct Reached {
    points: usize,
    unknown: usize,
    beyond: usize,
    worst: Option<(f64, Place)>,
}

impl Place {
    /// In an order that does not depend on the order of the points.
    fn order(&self) -> [f64; 3] {
        [self.torque_nm, self.speed_rpm, self.oil_temperature_degc].map(|x| x.unwrap_or(f64::NEG_INFINITY))
    }
}

impl Reached {
    /// Adds a value; one that is not finite is unknown.
    pub fn note(&mut self, limit: &Limit, value: f64, place: impl Fn() -> Place) {
        if !value.is_finite() {
            self.unknown += 1;
            return;
        }
        self.points += 1;
        self.beyond += usize::from(limit.violation(value) > 0.0);
        self.keep_worst(limit, value, &place);
    }

    /// Adds other points.
    pub fn merge(&mut self, limit: &Limit, other: Self) {
        self.points += other.points;
        self.unknown += other.unknown;
        self.beyond += other.beyond;
        if let Some((value, place)) = other.worst {
            self.keep_worst(limit, value, &|| place.clone());
        }
    }

    fn keep_worst(&mut self, limit: &Limit, value: f64, place: &dyn Fn() -> Place) {
        let is_worse = match &self.worst {
            None => true,
            Some((known, at)) => match limit.margin(value).total_cmp(&limit.margin(*known)) {
                std::cmp::Ordering::Less => true,
                std::cmp::Ordering::Equal => place().order() < at.order(),
                std::cmp::Ordering::Greater => false,
            },
        };
        if is_worse {
            self.worst = Some((value, place()));
        }
    }

    /// The record.
    pub fn record(self, limit: &Limit, model_set: &str) -> LimitReached {
        let (worst, at) = self
            .worst
            .map_or((None, Place::default()), |(value, at)| (Some(value), at));
        LimitReached {
            limit: limit.name.clone(),
            model_set: model_set.to_owned(),
            quantity: limit.words.clone(),
            unit: limit.unit.symbol.to_owned(),
            least: limit.bounds[0],
            most: limit.bounds[1],
            severity: limit.severity,
            points: self.points,
            points_unknown: self.unknown,
            beyond: self.beyond,
            worst,
            at,
        }
    }
}

impl LimitReached {
    /// Whether a value is beyond the limit.
    pub fn is_beyond(&self, value: f64) -> bool {
        self.least.is_some_and(|least| value < least) || self.most.is_some_and(|most| value > most)
    }

    /// Whether it is not kept: beyond its bounds somewhere, or nowhere known.
    pub fn is_broken(&self) -> bool {
        self.beyond > 0 || (self.points == 0 && self.points_unknown > 0)
    }
}
