//! Accuracies of measured quantities in percent of the reading, in percent of the full scale, and absolute.

use schemars::JsonSchema;
use serde::Deserialize;

use super::MeasuredFault;

/// Accuracies of measured quantities without an accuracy column. `stated_as` defines their meaning.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
pub struct AccuraciesEntry {
    /// Accuracy of the efficiency.
    pub efficiency: Option<EfficiencyAccuracyEntry>,
    /// Accuracy of the power loss.
    pub loss: Option<LossAccuracyEntry>,
    /// Accuracy of the loss torque.
    pub loss_torque: Option<LossTorqueAccuracyEntry>,
    /// Accuracy of the oil temperature.
    pub oil_temperature: Option<TemperatureAccuracyEntry>,
    /// Accuracy of the surface temperature.
    pub surface_temperature: Option<TemperatureAccuracyEntry>,
}

/// Accuracy of an efficiency: independent contributions, added as squares.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
pub struct EfficiencyAccuracyEntry {
    /// Accuracy in percent of the efficiency. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_reading: f64,
    /// Efficiency at full scale. [-]
    #[serde(default = "whole")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub full_scale: f64,
    /// Accuracy in percent of the full scale. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_full_scale: f64,
    /// Accuracy independent of the efficiency, as a fraction: 0.002 is 0.2 percentage points. [-]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub absolute: f64,
}

fn whole() -> f64 {
    1.0
}

/// Accuracy of a power loss: independent contributions, added as squares.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
pub struct LossAccuracyEntry {
    /// Accuracy in percent of the loss. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_reading: f64,
    /// Loss at full scale. [W]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub full_scale: f64,
    /// Accuracy in percent of the full scale. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_full_scale: f64,
    /// Accuracy independent of the loss. [W]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub absolute: f64,
}

/// Accuracy of a loss torque: independent contributions, added as squares.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
pub struct LossTorqueAccuracyEntry {
    /// Accuracy in percent of the loss torque. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_reading: f64,
    /// Torque at full scale. [Nm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub full_scale: f64,
    /// Accuracy in percent of the full scale. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_full_scale: f64,
    /// Accuracy independent of the loss torque. [Nm]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e9))]
    pub absolute: f64,
}

/// Accuracy of a temperature: independent contributions, added as squares.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
pub struct TemperatureAccuracyEntry {
    /// Accuracy in percent of the temperature in degC, as for thermocouples. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_reading: f64,
    /// Temperature span of the instrument. [K]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub full_scale: f64,
    /// Accuracy in percent of the full scale. [%]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 100.0))]
    pub percent_of_full_scale: f64,
    /// Accuracy independent of the temperature. [K]
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub absolute: f64,
}

/// The stated accuracy of one quantity; SI.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stated {
    quantity: &'static str,
    /// Fraction of the reading. \[-\]
    of_reading: f64,
    /// Root of the sum of the squares of the other contributions, in the unit of the quantity.
    fixed: f64,
}

/// Stated accuracies of quantities; SI.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Accuracies(Vec<Stated>);

impl Accuracies {
    /// Accuracies from an entry.
    ///
    /// # Errors
    /// If an accuracy is zero, or a percentage of the full scale has no full scale.
    pub fn new(entry: &AccuraciesEntry) -> Result<Self, Vec<MeasuredFault>> {
        let (mut stated, mut faults) = (Vec::new(), Vec::new());
        macro_rules! take {
            ($($quantity:ident),*) => {$(
                if let Some(a) = &entry.$quantity {
                    let quantity = stringify!($quantity);
                    let contributions = [a.percent_of_reading, a.full_scale, a.percent_of_full_scale, a.absolute];
                    match Stated::new(quantity, contributions) {
                        Ok(accuracy) => stated.push(accuracy),
                        Err(fault) => faults.push(fault),
                    }
                }
            )*};
        }
        take!(efficiency, loss, loss_torque, oil_temperature, surface_temperature);
        if faults.is_empty() {
            Ok(Self(stated))
        } else {
            Err(faults)
        }
    }

    /// Names of the quantities that have an accuracy.
    pub fn quantities(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|stated| stated.quantity)
    }

    /// Stated accuracy of a quantity at a reading; absent if not stated.
    pub fn stated(&self, quantity: &str, reading: f64) -> Option<f64> {
        let stated = self.0.iter().find(|stated| stated.quantity == quantity)?;
        Some((stated.of_reading * reading).hypot(stated.fixed))
    }
}

impl Stated {
    fn new(
        quantity: &'static str,
        [of_reading, full_scale, of_scale, absolute]: [f64; 4],
    ) -> Result<Self, MeasuredFault> {
        let wrong = |message: &str, help: &str| MeasuredFault::new(format!("accuracies.{quantity}"), message, help);
        if of_scale > 0.0 && full_scale <= 0.0 {
            let message = "a percentage of the full scale needs the full scale";
            return Err(wrong(message, "state `full_scale` with its unit"));
        }
        if of_reading <= 0.0 && of_scale <= 0.0 && absolute <= 0.0 {
            return Err(wrong(
                "an accuracy of zero",
                "state `percent_of_reading`, `percent_of_full_scale` or `absolute`",
            ));
        }
        Ok(Self {
            quantity,
            of_reading: 0.01 * of_reading,
            fixed: (0.01 * of_scale * full_scale).hypot(absolute),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn contributions_add_up_as_squares() {
        let entry = AccuraciesEntry {
            loss: Some(LossAccuracyEntry {
                percent_of_reading: 1.0,
                full_scale: 5000.0,
                percent_of_full_scale: 0.1,
                absolute: 2.0,
            }),
            ..AccuraciesEntry::default()
        };
        let accuracies = Accuracies::new(&entry).unwrap();
        let expected = (4.0_f64 * 4.0 + 5.0 * 5.0 + 2.0 * 2.0).sqrt();
        assert!((accuracies.stated("loss", 400.0).unwrap() - expected).abs() < 1e-12);
        assert_eq!(accuracies.stated("efficiency", 0.9), None);
    }

    #[test]
    fn accuracies_of_nothing_are_refused() {
        let refused = |loss: LossAccuracyEntry| {
            let entry = AccuraciesEntry {
                loss: Some(loss),
                ..AccuraciesEntry::default()
            };
            Accuracies::new(&entry).unwrap_err().remove(0).message
        };
        assert!(refused(LossAccuracyEntry::default()).contains("zero"));
        let without_scale = LossAccuracyEntry {
            percent_of_full_scale: 0.1,
            ..LossAccuracyEntry::default()
        };
        assert!(refused(without_scale).contains("needs the full scale"));
    }
}
