//! Means over cycles as measurements.

use gearloss_framework::loss::Extent;
use serde_json::Value;

use crate::points::Note;

/// A measured or published mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Mean {
    /// Name.
    pub name: String,
    /// Provenance.
    pub source: Option<String>,
    /// Whether it is a ratio of losses instead of a loss in W.
    pub is_ratio: bool,
    /// Range of values that agree with it: equal ends for a value, an infinite one if the range is open. \[W or -\]
    pub range: [f64; 2],
    /// Standard deviation of the ends. \[W or -\]
    pub accuracy: f64,
}

impl Mean {
    /// Distance of a calculated value from the range, over the accuracy: negative below it, zero in it.
    pub fn residual(&self, calculated: f64) -> f64 {
        let [low, high] = self.range;
        (calculated - calculated.clamp(low, high)) / self.accuracy
    }
}

/// Calculated values of means.
#[derive(Debug, Clone, Default)]
pub struct CalculatedMeans {
    /// The values, in the order of the means. \[W or -\]
    pub values: Vec<f64>,
    /// Observed limits and quantities of the cycles that are driven without other values of the gearbox.
    pub seen: Vec<Extent>,
    /// Notes on the cycles that are driven with other values.
    pub notes: Vec<Note>,
}

/// Calculates means from overrides of the gearbox.
type Calculate<'a> = Box<dyn Fn(&[(String, Value)]) -> Result<CalculatedMeans, String> + Send + Sync + 'a>;

/// Means, and how they are calculated.
pub struct Means<'a> {
    /// The means.
    pub list: Vec<Mean>,
    calculate: Calculate<'a>,
}

impl Default for Means<'_> {
    fn default() -> Self {
        Self::new(Vec::new(), |_| Ok(CalculatedMeans::default()))
    }
}

impl<'a> Means<'a> {
    /// Means and a function that calculates them from overrides of the gearbox, in the same order.
    pub fn new(
        list: Vec<Mean>,
        calculate: impl Fn(&[(String, Value)]) -> Result<CalculatedMeans, String> + Send + Sync + 'a,
    ) -> Self {
        Self {
            list,
            calculate: Box::new(calculate),
        }
    }

    /// The calculated values.
    ///
    /// # Errors
    /// The mean without a value, and why.
    pub fn calculate(&self, overrides: &[(String, Value)]) -> Result<CalculatedMeans, String> {
        let calculated = (self.calculate)(overrides)?;
        match self.list.iter().zip(&calculated.values).find(|(_, x)| !x.is_finite()) {
            Some((mean, _)) => Err(format!(
                "`{}` has no value: the loss over which it is stated is zero",
                mean.name
            )),
            None => Ok(calculated),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Mean;

    #[test]
    fn only_what_is_outside_of_the_range_deviates() {
        let mean = |range| Mean {
            name: "wltc".to_owned(),
            source: None,
            is_ratio: false,
            range,
            accuracy: 2.0,
        };
        assert_eq!(mean([238.0, 238.0]).residual(234.0), -2.0);
        assert_eq!(mean([230.0, 240.0]).residual(234.0), 0.0);
        assert_eq!(mean([230.0, 240.0]).residual(243.0), 1.5);
        assert_eq!(mean([1.0, f64::INFINITY]).residual(7.0), 0.0);
        assert_eq!(mean([f64::NEG_INFINITY, 1.0]).residual(7.0), 3.0);
    }
}
