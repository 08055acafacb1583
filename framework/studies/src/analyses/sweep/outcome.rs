//! The outcome of a sweep.

use gearloss_framework::description::Ordered;
use gearloss_framework::flow::Status;
use gearloss_framework::thermal;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::analyses::common::ranges::PublishedCoefficient;
use crate::analyses::{Head, Outcome};
use crate::distinct::distinct;
use crate::duty::Consumption;
use crate::limits::Limit;
use crate::limits::at_points::LimitColumn;
use crate::numbers::word;
use crate::points::{Note, UnitPoint};
use crate::table::Table;

/// Losses and efficiency at every value with each model set.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SweepOutcome {
    /// Provenance.
    #[serde(flatten)]
    pub head: Head,
    /// One for each model set at each value: the values of the second path outermost, the sets innermost. None over cycles.
    pub sweep: Vec<SweepOfValue>,
    /// The same for each cycle, innermost; none at points.
    pub cycles: Vec<CycleOfSweep>,
    /// Values that are left out because the gearbox cannot be built with them.
    pub left_out: Vec<CombinationLeftOut>,
    /// Limits of the study over cycles.
    #[serde(skip)]
    pub cycle_limits: Vec<LimitOfSweep>,
    /// Limits of the study at points.
    #[serde(skip)]
    pub limits: Vec<LimitColumn>,
    /// Paths that are coefficients of formulas.
    #[serde(skip)]
    pub published: Vec<PublishedCoefficient>,
    /// Notes of models over all values, for each set.
    #[serde(skip)]
    pub notes: Vec<NotesOfSet>,
}

/// Notes of models over all values with one set: one for each limit and observed quantity.
#[derive(Debug, Clone)]
pub struct NotesOfSet {
    /// Name of the set.
    pub model_set: String,
    /// The notes.
    pub notes: Vec<Note>,
}

/// Losses and efficiency with one model set at one value.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SweepOfValue {
    /// Name of the set.
    pub model_set: String,
    /// Gear state.
    pub gear: String,
    /// Varied path.
    pub path: String,
    /// The value as written in the study.
    pub value: Value,
    /// The second path and its value, if there are two.
    pub second: Option<SecondValue>,
    /// Names of the shares of the losses.
    pub shares: Vec<String>,
    /// The points: torques outermost.
    pub points: Vec<PointOfSweep>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// Indices of the value and of the second value in the study.
    #[serde(skip)]
    pub places: [usize; 2],
}

/// Mean losses and consumption over one cycle with one model set at one value.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CycleOfSweep {
    /// Name of the set.
    pub model_set: String,
    /// Gear state of cycles without one.
    pub gear: String,
    /// Varied path, or several.
    pub path: String,
    /// The value as written in the study.
    pub value: Value,
    /// The second path and its value, if there are two.
    pub second: Option<SecondValue>,
    /// Name of the cycle.
    pub cycle: String,
    /// Names of the shares of the losses.
    pub shares: Vec<String>,
    /// Mean loss of the gearbox. [W]
    pub mean_loss_w: f64,
    /// Mean losses in the order of the shares. [W]
    pub mean_losses_w: Vec<f64>,
    /// Energy of the vehicle; absent without a battery or without distance.
    pub consumption: Option<Consumption>,
    /// Limited quantities in the order and the units of the limits of the study; null where one is unknown.
    pub limited: Vec<Option<f64>>,
    /// Notes of models.
    pub notes: Vec<Note>,
    /// Indices of the value and of the second value in the study.
    #[serde(skip)]
    pub places: [usize; 2],
}

/// A combination of values that is left out.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct CombinationLeftOut {
    /// Paths and values.
    pub values: String,
    /// Why the gearbox cannot be built.
    pub reason: String,
}

/// A limit of the study over cycles.
#[derive(Debug, Clone)]
pub struct LimitOfSweep {
    /// Name in the study.
    pub limit: String,
    /// What is limited.
    pub words: String,
    /// Unit of its values.
    pub unit: &'static str,
}

impl LimitOfSweep {
    pub(super) fn new(limit: &Limit) -> Self {
        Self {
            limit: limit.name.clone(),
            words: limit.words.clone(),
            unit: limit.unit.symbol,
        }
    }
}

/// A second path and its value.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct SecondValue {
    /// The path.
    pub path: String,
    /// The value as written in the study.
    pub value: Value,
}

/// A solved point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PointOfSweep {
    /// Torque. [Nm]
    pub torque_nm: f64,
    /// Speed. [rpm]
    pub speed_rpm: f64,
    /// Oil temperature; absent if no balance was found. [degC]
    pub oil_temperature_degc: Option<f64>,
    /// Status of the heat balance; absent if the temperature is given.
    pub balance: Option<thermal::Outcome>,
    /// State of the transmission.
    pub status: Status,
    /// Output power over input power. [-]
    pub efficiency: Option<f64>,
    /// Loss. [W]
    pub loss_w: Option<f64>,
    /// Losses in the order of the shares. [W]
    pub losses_w: Option<Vec<f64>>,
    /// The drive unit; absent without machines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<UnitPoint>,
    /// Limited quantities, by the names of the limits; absent if the study has none at points.
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    pub limit_values: Ordered<Option<f64>>,
    /// True if one of them is beyond its limit.
    #[serde(skip)]
    pub beyond: bool,
    /// The speed without rounding, for headings. [rpm]
    #[serde(skip)]
    pub solved_speed_rpm: f64,
}

impl SweepOutcome {
    /// The points of one set, in the order of the values.
    pub fn values_of_set(&self, set: &str) -> impl Iterator<Item = &SweepOfValue> {
        self.sweep.iter().filter(move |value| value.model_set == set)
    }
}

impl NotesOfSet {
    /// The notes of each set, from all of its values: each with its set and its notes.
    pub(super) fn all<'n>(values: impl Iterator<Item = (&'n String, &'n Vec<Note>)> + Clone) -> Vec<Self> {
        let sets = distinct(values.clone().map(|(set, _)| set));
        let set = |set: &String| Self {
            model_set: set.clone(),
            notes: merged(
                values
                    .clone()
                    .filter(|(known, _)| *known == set)
                    .flat_map(|(_, notes)| notes),
            ),
        };
        sets.into_iter().map(set).collect()
    }
}

/// Notes of several transmissions that differ in some values, one for each limit and observed quantity.
fn merged<'n>(notes: impl Iterator<Item = &'n Note>) -> Vec<Note> {
    let mut all: Vec<Note> = Vec::new();
    for note in notes {
        let key = |note: &Note| (note.path.clone(), note.name, note.range);
        match all.iter_mut().find(|other| key(other) == key(note)) {
            Some(known) => {
                known.least = known.least.min(note.least);
                known.greatest = known.greatest.max(note.greatest);
                known.points += note.points;
                known.outside += note.outside;
            }
            None => all.push(note.clone()),
        }
    }
    all
}

impl SweepOutcome {
    /// The results over cycles.
    fn table_of_cycles(&self) -> Table {
        let first = self.cycles.first();
        let second = first.and_then(|value| value.second.as_ref());
        let shares = first.map_or(&[][..], |value| &value.shares);
        let with_path = "Value of the path as in the study";
        let has_consumption = self.cycles.iter().any(|value| value.consumption.is_some());
        Table::of(&self.head.analysis, &self.cycles)
            .text("model_set", "Model set", |value| &value.model_set)
            .text("gear", "Gear", |value| &value.gear)
            .each(first.map(|value| &value.path), |table, path| {
                table.text(path, with_path, |value| word(&value.value))
            })
            .each(second.map(|second| &second.path), |table, path| {
                table.text(path, with_path, |value| {
                    value
                        .second
                        .as_ref()
                        .map(|second| word(&second.value))
                        .unwrap_or_default()
                })
            })
            .text("cycle", "Duty cycle", |value| &value.cycle)
            .number("mean_loss_w", "W", "Mean loss of the gearbox", |value| {
                value.mean_loss_w
            })
            .each(shares.iter().enumerate(), |table, (i, share)| {
                let meaning = format!("Mean loss of {share}");
                table.number(format!("{share}_w"), "W", meaning, |value| value.mean_losses_w[i])
            })
            .each(
                Consumption::COLUMNS.iter().filter(|_| has_consumption),
                |table, column| {
                    table.number(column.name, column.unit, column.meaning, |value| {
                        value.consumption.as_ref().and_then(column.read)
                    })
                },
            )
            .each(self.cycle_limits.iter().enumerate(), |table, (i, limit)| {
                table.number(
                    format!("{}_limited", limit.limit),
                    limit.unit,
                    limit.words.clone(),
                    |value| value.limited.get(i).copied().flatten(),
                )
            })
            .finish()
    }
}

impl Outcome for SweepOutcome {
    fn head(&self) -> &Head {
        &self.head
    }

    fn tables(&self) -> Vec<Table> {
        if !self.cycles.is_empty() {
            return vec![self.table_of_cycles()];
        }
        let first = self.sweep.first();
        let second = first.and_then(|value| value.second.as_ref());
        let shares = first.map_or(&[][..], |value| &value.shares);
        let with_path = "Value of the path as in the study";
        let table = Table::of_each(&self.head.analysis, &self.sweep, |value| &value.points)
            .text("model_set", "Model set", |(value, _)| &value.model_set)
            .text("gear", "Gear", |(value, _)| &value.gear)
            .each(first.map(|value| &value.path), |table, path| {
                table.text(path, with_path, |(value, _)| word(&value.value))
            })
            .each(second.map(|second| &second.path), |table, path| {
                table.text(path, with_path, |(value, _)| {
                    value
                        .second
                        .as_ref()
                        .map(|second| word(&second.value))
                        .unwrap_or_default()
                })
            })
            .fields(
                "torque_nm speed_rpm oil_temperature_degc balance status efficiency loss_w",
                |(_, point)| point,
            )
            .each(shares.iter().enumerate(), |table, (i, share)| {
                table.number(format!("{share}_w"), "W", format!("Loss of {share}"), |(_, point)| {
                    point.losses_w.as_ref().map(|losses| losses[i])
                })
            });
        let table = UnitPoint::add_to(table, |(_, point)| point.unit.as_ref()).each(&self.limits, |table, limit| {
            table.number(limit.key(), limit.unit, limit.words.clone(), |(_, point)| {
                point.limit_values.get(&limit.name).copied().flatten()
            })
        });
        vec![table.finish()]
    }

    fn notes(&self) -> Vec<&Note> {
        self.notes.iter().flat_map(|of_set| &of_set.notes).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn note(path: &str, least: f64, greatest: f64, outside: u32) -> Note {
        Note {
            path: path.to_owned(),
            name: "n_dm",
            meaning: "speed factor",
            unit: "-",
            least,
            greatest,
            points: 3,
            outside,
            range: None,
            loss_share: None,
        }
    }

    #[test]
    fn notes_are_merged_by_limit_where_a_value_is_another_model() {
        // The first value has no model at the first place, so the places of the notes differ.
        let notes = [note("b", 1.0, 2.0, 0), note("a", 5.0, 6.0, 1), note("b", 0.0, 1.0, 2)];
        let merged = merged(notes.iter());
        let shown: Vec<_> = merged
            .iter()
            .map(|n| (n.path.as_str(), n.least, n.greatest, n.points, n.outside))
            .collect();
        assert_eq!(shown, [("b", 0.0, 2.0, 6, 2), ("a", 5.0, 6.0, 3, 1)]);
    }
}
