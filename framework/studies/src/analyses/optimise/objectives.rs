//! What a search minimises: mean losses of cycles, or the consumption of the vehicle over them.

use gearloss_framework::document::Diagnostic;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::drives::Drive;
use crate::analyses::common::duties::Duties;
use crate::analyses::common::limits_over_cycles::cycle;
use crate::analyses::{Planner, Stopped};
use crate::codes;

/// What is minimised over a cycle.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum ObjectiveEntry {
    /// The mean loss of the gearbox over a cycle, by the name of the cycle.
    Cycle(#[schemars(extend("x-refers-to" = "cycles"))] String),
    /// A quantity of a cycle.
    Quantity(QuantityEntry),
}

/// A quantity of a cycle that is minimised.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
pub struct QuantityEntry {
    /// The quantity.
    pub quantity: Minimised,
    /// Name of the cycle; default: every cycle.
    #[schemars(extend("x-refers-to" = "cycles"))]
    pub of: Option<String>,
}

/// A quantity that can be minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Minimised {
    /// The mean loss of the gearbox.
    MeanLoss,
    /// The consumption of the vehicle in kWh/100 km, with the losses of machine and battery; the vehicle needs a battery.
    Consumption,
}

impl Minimised {
    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::MeanLoss => "W",
            Self::Consumption => "kWh/100 km",
        }
    }

    /// Its name in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::MeanLoss => "mean loss",
            Self::Consumption => "consumption",
        }
    }
}

/// A quantity of one of the cycles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Objective {
    pub quantity: Minimised,
    /// Index of the cycle.
    pub cycle: usize,
}

impl Objective {
    /// The objectives of an analysis at a path; without any stated, the consumption over every cycle if a machine and a battery are
    /// described, otherwise the mean loss.
    pub fn all(
        cx: &Planner<'_>,
        entries: &[ObjectiveEntry],
        duties: &Duties<'_>,
        has_machine: bool,
    ) -> Result<Vec<Self>, Stopped> {
        let path = cx.path();
        let with_distance = |cycle: &usize| duties.has_consumption(*cycle);
        let count = duties.list.len();
        if entries.is_empty() {
            let quantity = if has_machine && (0..count).all(|cycle| with_distance(&cycle)) {
                Minimised::Consumption
            } else {
                Minimised::MeanLoss
            };
            return Ok((0..count).map(|cycle| Self { quantity, cycle }).collect());
        }
        let mut all = Vec::new();
        for (i, entry) in entries.iter().enumerate() {
            let at = format!("{path}.minimise.{i}");
            let (quantity, name, at_name) = match entry {
                ObjectiveEntry::Cycle(name) => (Minimised::MeanLoss, Some(name), at.clone()),
                ObjectiveEntry::Quantity(entry) => (entry.quantity, entry.of.as_ref(), format!("{at}.of")),
            };
            let cycles = match name {
                Some(name) => vec![cycle(cx, &at_name, name, duties)?],
                None => (0..count).collect(),
            };
            let unknown = cycles.iter().find(|cycle| !with_distance(cycle));
            if let (Minimised::Consumption, Some(unknown)) = (quantity, unknown) {
                let message = format!(
                    "the consumption over `{}` is unknown: it needs a vehicle with a battery, and a cycle with the speed of the vehicle",
                    duties.list[*unknown].name
                );
                let help = "state `battery: { energy: 60 kWh, efficiency: 0.95 }` of the vehicle, and the losses of its machine by \
                            `motor_map` or in the thermal network; or minimise the mean loss";
                let error = Diagnostic::error(&at, message).help(help).code(codes::OBJECTIVE);
                return Err(cx.found(vec![error]));
            }
            for cycle in cycles {
                let objective = Self { quantity, cycle };
                if all.contains(&objective) {
                    let name = &duties.list[cycle].name;
                    let message = format!("the {} over `{name}` is minimised twice", quantity.words());
                    return Err(cx.wrong(&at, message, "delete one of them"));
                }
                all.push(objective);
            }
        }
        Ok(all)
    }

    /// Its value of a driven design, in its unit.
    pub fn value(self, drive: &Drive) -> f64 {
        match self.quantity {
            Minimised::MeanLoss => drive.losses[self.cycle],
            Minimised::Consumption => {
                let consumption = drive.consumptions[self.cycle];
                consumption.map_or(f64::INFINITY, |consumption| consumption.consumption_kwh_per_100_km)
            }
        }
    }
}
