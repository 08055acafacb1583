//! A limit of a quantity, and how far a value is from it.

use gearloss_framework::document::{Dimension, Unit};
use gearloss_framework::resolve::meets;
use schemars::JsonSchema;
use serde::Serialize;

use crate::study::limits::{LimitedQuantity, Severity};

/// A limit with the value of the design or oil as described.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct LimitRecord {
    /// Name in the study.
    pub limit: String,
    /// What is limited.
    pub quantity: String,
    /// Unit of the values.
    pub unit: String,
    /// Least allowed value.
    pub least: Option<f64>,
    /// Greatest allowed value.
    pub most: Option<f64>,
    /// Value as described; null if it is unknown.
    pub present: Option<f64>,
    /// Whether it is kept as described.
    pub present_keeps_it: bool,
}

/// A limit as read.
#[derive(Debug, Clone)]
pub struct Limit {
    /// Name in the study.
    pub name: String,
    /// What is limited, in words.
    pub words: String,
    /// Its unit.
    pub unit: &'static Unit,
    /// Least and greatest allowed value, in the unit.
    pub bounds: [Option<f64>; 2],
    /// What follows if it is not kept.
    pub severity: Severity,
    pub(crate) quantity: LimitedQuantity,
    /// Name of the node; index of the cycle; index of the gear.
    pub(crate) of: Owner,
}

/// What a limited quantity belongs to.
#[derive(Debug, Clone)]
pub(crate) enum Owner {
    Node(String),
    Oil,
    Cycle(usize),
    AllCycles,
    /// A cycle that the analysis does not have.
    OtherCycle,
    /// The gearbox as a whole.
    Gearbox,
    /// Gearbox, machines and inverters.
    Unit,
    Gear(usize),
    /// Name of the rating and symbol of its quantity; pattern of the components.
    Rating {
        rating: &'static str,
        symbol: &'static str,
        components: String,
    },
}

impl Limit {
    /// Whether it needs the ratings of the components.
    pub fn is_rating(&self) -> bool {
        self.quantity == LimitedQuantity::Rating
    }

    /// The value closest to a bound, or farthest beyond one; NaN if there is none.
    pub(crate) fn worst(&self, values: impl Iterator<Item = f64>) -> f64 {
        let worst = values.min_by(|a, b| self.margin(*a).total_cmp(&self.margin(*b)));
        worst.unwrap_or(f64::NAN)
    }

    /// Distance of a value from the closest bound, negative beyond it.
    pub(super) fn margin(&self, value: f64) -> f64 {
        let [least, most] = self.bounds;
        let above = least.map_or(f64::INFINITY, |least| value - least);
        above.min(most.map_or(f64::INFINITY, |most| most - value))
    }

    /// Symbol of the limited quantity of a rating.
    pub(crate) fn symbol(&self) -> Option<&'static str> {
        match self.of {
            Owner::Rating { symbol, .. } => Some(symbol),
            _ => None,
        }
    }

    /// Whether it limits a rating of a component.
    pub(crate) fn rates(&self, name: &str, component: &str) -> bool {
        matches!(&self.of, Owner::Rating { rating, components, .. } if *rating == name && meets(components, component))
    }

    /// The limit with the value of the design or oil as described.
    pub fn record(&self, present: Option<f64>) -> LimitRecord {
        let present = present.filter(|x| x.is_finite());
        LimitRecord {
            limit: self.name.clone(),
            quantity: self.words.clone(),
            unit: self.unit.symbol.to_owned(),
            least: self.bounds[0],
            most: self.bounds[1],
            present,
            present_keeps_it: present.is_some_and(|value| self.violation(value) == 0.0),
        }
    }

    /// How far a value is beyond the limit, as a share of the bound, or of 10 K for temperatures; zero if the limit is kept.
    pub fn violation(&self, value: f64) -> f64 {
        let beyond = match self.bounds {
            [Some(least), _] if value < least => least - value,
            [_, Some(most)] if value > most => value - most,
            _ if value.is_nan() => f64::INFINITY,
            _ => return 0.0,
        };
        let scale = match self.unit.dimension {
            Dimension::Temperature => 10.0,
            _ => self
                .bounds
                .iter()
                .flatten()
                .fold(f64::MIN_POSITIVE, |sum, bound| sum.max(bound.abs())),
        };
        beyond / scale
    }
}
